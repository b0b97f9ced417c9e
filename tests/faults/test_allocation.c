// test_allocation.c -- every allocation of a complete small run may fail: each time the call returns OUT_OF_MEMORY, nothing leaks, nothing crashes.
#include "step/contact_view.h"
#include "support/snapshot.h"

#include <particls/observe.h>

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

#include "support/failing_allocator.h"
#include "support/numbers.h"

static void parameter_values(const pls_parameter *table, const char *const *names, const double *given, double *values)
{
    pls_parameters_default(table, values);
    for (int k = 0; names[k]; ++k) values[pls_parameter_find(table, names[k])] = given[k];
}

static const pls_shape_ops *shape_named(const char *name)
{
    for (const pls_shape_ops *const *ops = pls_builtin_shapes(); *ops; ++ops)
        if (strcmp((*ops)->name, name) == 0) return *ops;
    return NULL;
}

static const pls_law_ops *law_named(const char *name)
{
    for (const pls_law_ops *const *ops = pls_builtin_laws(); *ops; ++ops)
        if (strcmp((*ops)->name, name) == 0) return *ops;
    return NULL;
}

static pls_status rate_of_growth(void *context, const pls_state_point *at, const double *values, double *rate)
{
    (void)context;
    (void)at;
    rate[0] = 0.1 * values[0];
    return PLS_OK;
}

static pls_status stiffness(void *context, double time, const double *states, double *value)
{
    (void)context;
    *value = 1000.0 + time * states[0];
    return PLS_OK;
}

static pls_status add_bodies(pls_world *world, pls_shape_id ball, pls_shape_id wall, pls_material_id grain, pls_body_id *first)
{
    pls_body_def def = pls_default_body_def();
    def.material = grain;
    def.shape = ball;
    for (int k = 0; k < 27; ++k)
    {
        pls_body_id id;
        def.position = pls_vec(0.95 * (k % 3), 0.95 * (k / 3 % 3), 0.5 + 0.95 * (k / 9));
        def.velocity = pls_vec(0.3 * (k % 2), 0.2 * (k % 5), -1.0);
        PLS_TRY(pls_world_add_body(world, &def, &id));
        if (k == 0) *first = id;
    }
    def = pls_default_body_def();
    def.material = grain;
    def.shape = wall;
    def.motion.axes = PLS_AXIS_ALL;
    pls_body_id id;
    return pls_world_add_body(world, &def, &id);
}

static pls_status build(pls_world *world)
{
    double values[PLS_MAX_PARAMETERS] = {0};
    pls_shape_id ball, wall;
    pls_material_id grain;
    pls_group_id group;
    pls_body_id first = {0};
    const pls_shape_ops *sphere = shape_named("sphere"), *plane = shape_named("plane");
    const pls_law_ops *law = law_named("viscoelastic");
    parameter_values(sphere->parameters, (const char *const[]){"radius", NULL}, (const double[]){0.5}, values);
    PLS_TRY(pls_world_add_shape(world, "ball", sphere, COUNTED(values), &ball));
    pls_parameters_default(plane->parameters, values);
    PLS_TRY(pls_world_add_shape(world, "wall", plane, COUNTED(values), &wall));
    pls_material_def material = pls_default_material_def();
    strcpy(material.name, "grain");
    material.values.density = 1.0;
    PLS_TRY(pls_world_add_material(world, &material, &grain));
    PLS_TRY(pls_world_add_group(world, "pack", &group));
    parameter_values(law->parameters, (const char *const[]){"kn", "ks", "cn", "cs", "friction", NULL},
                     (const double[]){1000, 700, 0.5, 0.3, 0.3}, values);
    PLS_TRY(pls_world_set_law(world, grain, grain, law, values));
    PLS_TRY(pls_world_reserve_bodies(world, 10));
    PLS_TRY(add_bodies(world, ball, wall, grain, &first));
    PLS_TRY(pls_world_add_gravity(world, pls_vec(0, 0, -10)));
    pls_state_def state = pls_default_state_def();
    pls_state_id state_id;
    strcpy(state.name, "size");
    state.body = first;
    state.components = 1;
    state.initial[0] = 1.0;
    state.target = PLS_STATE_SCALE;
    state.rate = rate_of_growth;
    PLS_TRY(pls_world_add_state(world, &state, &state_id));
    return pls_world_bind_law_parameter(world, grain, grain, "kn", stiffness, NULL, NULL);
}

static pls_world_def definition(bool periodic)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 5e-4;
    def.skin = 0.02; // lists are made anew every few steps
    def.periodic[0] = periodic;
    def.upper = pls_vec(4, 4, 4);
    return def;
}

static pls_status look(pls_world *world)
{
    pls_collection_def def = pls_default_collection_def();
    pls_collection collection;
    pls_contact_view view = {0};
    pls_world_figures figures;
    pls_step_estimate estimate;
    uint64_t hash;
    def.quantities = PLS_MEASURE_STRESS | PLS_MEASURE_TANGENT | PLS_MEASURE_FABRIC | PLS_MEASURE_COORDINATION | PLS_MEASURE_ENERGY |
                     PLS_MEASURE_MOMENTUM | PLS_MEASURE_POROSITY | PLS_MEASURE_MASS;
    PLS_TRY(pls_measure_collection(world, &def, &collection));
    PLS_TRY(pls_world_get_figures(world, &figures));
    PLS_TRY(pls_world_stable_step(world, &estimate));
    PLS_TRY(pls_world_state_hash(world, &hash));
    pls_status status = pls_contact_view_make(world, &view);
    pls_contact_view_free(&view);
    return status;
}

static pls_status work(pls_world *world)
{
    PLS_TRY(build(world));
    PLS_TRY(pls_world_prepare(world));
    PLS_TRY(pls_world_run(world, 80));
    return look(world);
}

static pls_status whole_run(void *context)
{
    const pls_world_def *def = context;
    pls_world *world = NULL;
    PLS_TRY(pls_world_create(def, &world));
    pls_status status = work(world);
    pls_world_destroy(world);
    return status;
}

static pls_status save_and_restore(pls_world *from, const pls_world_def *def, snapshot *copy)
{
    pls_world *to = NULL;
    PLS_TRY(snapshot_take(from, copy));
    PLS_TRY(pls_world_create(def, &to));
    pls_status status = build(to);
    if (status == PLS_OK) status = snapshot_put(to, copy);
    if (status == PLS_OK) status = pls_world_run(to, 20);
    pls_world_destroy(to);
    return status;
}

static pls_status restart_run(void *context)
{
    const pls_world_def *def = context;
    snapshot copy = {0};
    pls_world *world = NULL;
    PLS_TRY(pls_world_create(def, &world));
    pls_status status = work(world);
    if (status == PLS_OK) status = save_and_restore(world, def, &copy);
    snapshot_free(&copy);
    pls_world_destroy(world);
    return status;
}

static int count_failures(pls_status (*job)(void *), bool periodic)
{
    pls_world_def def = definition(periodic);
    failing_allocator_install();
    size_t allocations = assert_survives_allocation_failures(job, &def);
    failing_allocator_remove();
    return (int)allocations;
}

static void every_allocation_of_a_run_may_fail(void **state)
{
    (void)state;
    assert_true(count_failures(whole_run, false) > 20);
    assert_true(count_failures(whole_run, true) > 20);
}

static void every_allocation_of_a_restart_may_fail(void **state)
{
    (void)state;
    assert_true(count_failures(restart_run, false) > 40);
}

static void a_step_that_keeps_its_list_allocates_nothing(void **state)
{
    (void)state;
    pls_world_def def = definition(false);
    pls_world *world = NULL;
    pls_world_figures before, after;
    int kept = 0;
    failing_allocator_install();
    assert_int_equal(pls_world_create(&def, &world), PLS_OK);
    assert_int_equal(work(world), PLS_OK);
    assert_int_equal(pls_world_run(world, 2000), PLS_OK);
    for (int k = 0; k < 100; ++k)
    {
        assert_int_equal(pls_world_get_figures(world, &before), PLS_OK);
        failing_allocator_arm(0);
        assert_int_equal(pls_step(world), PLS_OK);
        size_t calls = failing_allocator_calls();
        assert_int_equal(pls_world_get_figures(world, &after), PLS_OK);
        if (after.list_builds != before.list_builds) continue;
        assert_int_equal(calls, 0);
        ++kept;
    }
    assert_true(kept > 20);
    pls_world_destroy(world);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_allocation_of_a_run_may_fail),
        cmocka_unit_test(every_allocation_of_a_restart_may_fail),
        cmocka_unit_test(a_step_that_keeps_its_list_allocates_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
