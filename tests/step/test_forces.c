// test_forces.c -- body forces of a C program: parameters, groups, changes in time, and what is refused. The body is free, so its force is all that acts.

#include <particls/memory.h>
#include <particls/world.h>

#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static const pls_parameter push_parameters[] = {
    {.name = "strength", .unit = "N", .meaning = "force", .initial = PLS_REQUIRED, .maximum = INFINITY},
    {.name = "along",
     .unit = "",
     .meaning = "direction, of any length",
     .initial = 1.0,
     .minimum = -INFINITY,
     .maximum = INFINITY,
     .components = 3},
    {.name = NULL},
};

/// Constants: the force, by components.
static pls_status push_prepare(const double *values, int dimension, double *constants)
{
    pls_vec3 along = pls_vec(values[1], values[2], dimension == 3 ? values[3] : 0.0);
    if (!(pls_length(along) > 0.0)) return pls_fail(PLS_INVALID_ARGUMENT, "push: `along` has no direction");
    along = pls_scale(pls_unit(along), values[0]);
    constants[0] = along.x, constants[1] = along.y, constants[2] = along.z;
    return PLS_OK;
}

static pls_status push_evaluate(void *context, const pls_force_batch *batch)
{
    (void)context;
    for (size_t k = 0; k < batch->count; ++k)
    {
        batch->force_x[k] += batch->constants[0];
        batch->force_y[k] += batch->constants[1];
        batch->force_z[k] += batch->constants[2];
    }
    return PLS_OK;
}

static double push_potential(void *context, const pls_force_body *body)
{
    (void)context;
    return -pls_dot(pls_vec(body->constants[0], body->constants[1], body->constants[2]), body->position);
}

static int destroyed;
static void push_destroy(void *context)
{
    if (context) ++destroyed;
}

static const pls_force_ops push = {
    .api_version = PLS_API_VERSION,
    .name = "push",
    .meaning = "a constant force",
    .parameters = push_parameters,
    .prepare = push_prepare,
    .evaluate = push_evaluate,
    .potential = push_potential,
    .destroy = push_destroy,
};

enum { COUNT = 700 }; // more than two blocks of bodies
static pls_body_id ids[COUNT];

/// Balls of mass 1 kg far from each other, every third of them of the group "third".
static pls_world *balls(pls_group_id *third)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-3;
    pls_world *world;
    assert_int_equal(pls_world_create(&def, &world), PLS_OK);
    const double radius[1] = {0.1};
    pls_shape_id ball;
    assert_int_equal(pls_world_add_shape(world, "ball", pls_builtin_shapes()[0], COUNTED(radius), &ball), PLS_OK);
    pls_material_def material = pls_default_material_def();
    strcpy(material.name, "grain");
    material.values.density = 1.0;
    pls_material_id grain;
    assert_int_equal(pls_world_add_material(world, &material, &grain), PLS_OK);
    assert_int_equal(pls_world_add_group(world, "third", third), PLS_OK);
    for (int k = 0; k < COUNT; ++k)
    {
        pls_body_def body = pls_default_body_def();
        body.shape = ball;
        body.material = grain;
        body.mass = 1.0;
        if (k % 3 == 0) body.group = *third;
        body.position = pls_vec(k, 0.0, 0.0);
        assert_int_equal(pls_world_add_body(world, &body, &ids[k]), PLS_OK);
    }
    return world;
}

static pls_vec3 force_on(const pls_world *world, uint32_t number)
{
    pls_body_motion motion;
    assert_int_equal(pls_body_get(world, ids[number], &motion), PLS_OK);
    return motion.force;
}

static void expect_force(const pls_world *world, uint32_t number, double x, double y)
{
    pls_vec3 f = force_on(world, number);
    if (fabs(f.x - x) > 1e-14 || fabs(f.y - y) > 1e-14 || f.z != 0.0)
        fail_msg("body %u: (%g, %g, %g) N, not (%g, %g, 0) N", number, f.x, f.y, f.z, x, y);
}

static void a_force_acts_on_the_bodies_of_its_group_only(void **state)
{
    (void)state;
    pls_group_id third;
    pls_world *world = balls(&third);
    const double values[] = {10.0, 3.0, 4.0, 0.0};
    pls_force_def def = pls_default_force_def();
    def.ops = &push;
    def.values = values;
    def.group = third;
    pls_force_id id;
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_OK);
    assert_int_equal(pls_step(world), PLS_OK);
    for (uint32_t k = 0; k < COUNT; ++k) expect_force(world, k, k % 3 ? 0.0 : 6.0, k % 3 ? 0.0 : 8.0);

    // Potential energy of those alone: sum of -6 x over x = 0, 3, 6, ..., 699 after a step of 1 ms from rest, x += a dt^2 / 2.
    pls_world_figures figures;
    assert_int_equal(pls_world_get_figures(world, &figures), PLS_OK);
    double moved = 0.5 * 6.0 * 1e-6, raised = 0.5 * 8.0 * 1e-6, count = 234.0;
    double energy = -6.0 * (3.0 * (count - 1.0) * count / 2.0 + count * moved) - 8.0 * count * raised;
    assert_true(fabs(figures.energy_potential - energy) < 1e-12 * fabs(energy));
    pls_world_destroy(world);
}

static void parameters_change_one_by_one_and_components_have_names(void **state)
{
    (void)state;
    pls_group_id third;
    pls_world *world = balls(&third);
    const double values[] = {10.0, 3.0, 4.0, 0.0};
    pls_force_def def = pls_default_force_def();
    def.ops = &push;
    def.values = values;
    pls_force_id id;
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_OK);
    assert_int_equal(pls_world_set_force_parameter(world, id, "along[0]", -3.0), PLS_OK);
    assert_int_equal(pls_world_set_force_parameter(world, id, "strength", 5.0), PLS_OK);
    assert_int_equal(pls_step(world), PLS_OK);
    expect_force(world, 1, -3.0, 4.0);

    // What is refused leaves everything as it was.
    assert_int_equal(pls_world_set_force_parameter(world, id, "strength", -1.0), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "force 'push': 'strength' must be at least 0 N, not -1"));
    assert_int_equal(pls_world_set_force_parameter(world, id, "along[3]", 1.0), PLS_NOT_FOUND);
    assert_int_equal(pls_world_set_force_parameter(world, id, "strength[0]", 1.0), PLS_NOT_FOUND);
    assert_int_equal(pls_world_set_force_parameter(world, (pls_force_id){2}, "strength", 1.0), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_world_set_force_parameter(world, id, "along", 0.0), PLS_OK);
    assert_int_equal(pls_world_set_force_parameter(world, id, "along[1]", 0.0), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "`along` has no direction"));
    assert_int_equal(pls_step(world), PLS_OK);
    expect_force(world, 1, 0.0, 5.0);
    pls_world_destroy(world);
}

static pls_status rising(void *context, double time, const double *states, double *value)
{
    (void)context, (void)states;
    *value = 2.0 * time;
    return PLS_OK;
}

static void a_parameter_follows_time(void **state)
{
    (void)state;
    pls_group_id third;
    pls_world *world = balls(&third);
    const double values[] = {0.0, 1.0, 0.0, 0.0};
    pls_force_def def = pls_default_force_def();
    def.ops = &push;
    def.values = values;
    pls_force_id id;
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_OK);
    assert_int_equal(pls_world_bind_force_parameter(world, id, "weight", rising, NULL, NULL), PLS_NOT_FOUND);
    assert_int_equal(pls_world_bind_force_parameter(world, id, "strength", rising, NULL, NULL), PLS_OK);
    assert_int_equal(pls_world_run(world, 500), PLS_OK);
    expect_force(world, 1, 1.0, 0.0);
    pls_body_motion motion;
    assert_int_equal(pls_body_get(world, ids[1], &motion), PLS_OK);
    assert_true(fabs(motion.velocity.x - 0.25) < 1e-12); // t^2 by the trapezoidal rule, exact for a force linear in time
    pls_world_destroy(world);
}

static void forces_that_are_no_good_are_refused_and_their_context_is_released(void **state)
{
    (void)state;
    pls_group_id third;
    pls_world *world = balls(&third);
    pls_force_id id;
    pls_force_def def = pls_default_force_def();
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "needs its operations"));

    destroyed = 0;
    def.ops = &push;
    def.context = &destroyed;
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "force 'push': the parameter 'strength' (force) must be given"));
    assert_int_equal(destroyed, 1);

    pls_force_ops other = push;
    def.ops = &other;
    other.evaluate = NULL;
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "force 'push' needs evaluate"));
    other.api_version = PLS_API_VERSION - 1;
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_VERSION);
    def.ops = &push;
    def.group.index1 = 7;
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_INVALID_ARGUMENT);
    def.cookie = 0;
    assert_int_equal(pls_world_add_force(world, &def, &id), PLS_INVALID_ARGUMENT);
    assert_int_equal(destroyed, 5);
    assert_int_equal(id.index1, 0);
    pls_world_destroy(world);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void bodies_come_in_order_of_their_numbers(void **state)
{
    (void)state;
    pls_group_id third;
    pls_world *world = balls(&third);
    assert_int_equal(pls_world_remove_body(world, ids[0]), PLS_OK);
    assert_int_equal(pls_world_remove_body(world, ids[4]), PLS_OK);
    uint32_t expected = 1, count = 0;
    for (pls_body_id id = pls_world_next_body(world, (pls_group_id){0}, (pls_body_id){0}); id.index1;
         id = pls_world_next_body(world, (pls_group_id){0}, id))
    {
        if (expected == 4) ++expected;
        assert_int_equal(id.index1 - 1, expected++);
        ++count;
    }
    assert_int_equal(count, COUNT - 2);
    count = 0;
    for (pls_body_id id = pls_world_next_body(world, third, (pls_body_id){0}); id.index1;
         id = pls_world_next_body(world, third, id), ++count)
        assert_int_equal((id.index1 - 1) % 3, 0);
    assert_int_equal(count, 233);
    pls_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_force_acts_on_the_bodies_of_its_group_only),
        cmocka_unit_test(parameters_change_one_by_one_and_components_have_names),
        cmocka_unit_test(a_parameter_follows_time),
        cmocka_unit_test(forces_that_are_no_good_are_refused_and_their_context_is_released),
        cmocka_unit_test(bodies_come_in_order_of_their_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
