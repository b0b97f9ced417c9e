// test_guard.c -- what stops a run: numbers that are not finite, in the step in which they appear; overlaps too large and bodies lost, at the next look; a step that has
// become too large.

#include <particls/particls.h>

#include "support/numbers.h"
#include "support/values_alone.h"
#include "support/verify.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

/// A force that is NaN from the third evaluation on: the first belongs to the start, each further one to a step.
static pls_status turning_sour(void *context, const pls_force_batch *batch)
{
    int *calls = context;
    ++*calls;
    for (size_t k = 0; k < batch->count; ++k) batch->force_x[k] += *calls >= 3 ? (double)NAN : 0.0;
    return PLS_OK;
}

static const pls_force_ops sour = {
    .api_version = PLS_API_VERSION, .name = "sour", .meaning = "a force that is not a number after a while", .evaluate = turning_sour};

/// Spheres of radius 1 m and density 1, with the elastic law kn = 1 N/m, in a row with distance 1.99 m; the ends of a row of three are fixed.
static pls_world *row_of_spheres(int count, double dt, pls_material_id *grain)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    pls_world *world;
    assert_int_equal(pls_world_create(&def, &world), PLS_OK);
    const double radius[1] = {1.0}, law[3] = {1.0, 1.0, 0.5};
    pls_shape_id ball;
    assert_int_equal(pls_world_add_shape(world, "ball", pls_builtin_shapes()[0], COUNTED(radius), &ball), PLS_OK);
    pls_material_def material = pls_default_material_def();
    strcpy(material.name, "grain");
    material.values.density = 1.0;
    assert_int_equal(pls_world_add_material(world, &material, grain), PLS_OK);
    assert_int_equal(pls_world_set_law(world, *grain, *grain, pls_builtin_laws()[0], law), PLS_OK);
    for (int k = 0; k < count; ++k)
    {
        pls_body_def body = pls_default_body_def();
        body.shape = ball;
        body.material = *grain;
        body.position = pls_vec(1.99 * k, 0.0, 0.0);
        if (count == 3 && k != 1) body.motion.axes = PLS_AXIS_ALL;
        pls_body_id id;
        assert_int_equal(pls_world_add_body(world, &body, &id), PLS_OK);
    }
    return world;
}

static void the_step_that_makes_a_velocity_not_a_number_is_refused(void **state)
{
    (void)state;
    static int calls;
    calls = 0;
    pls_material_id grain;
    pls_world *world = row_of_spheres(1, 1e-3, &grain);
    pls_force_def force = pls_default_force_def();
    force.ops = &sour;
    force.context = &calls;
    pls_force_id id;
    assert_int_equal(pls_world_add_force(world, &force, &id), PLS_OK);
    assert_int_equal(pls_step(world), PLS_OK);
    assert_int_equal(pls_step(world), PLS_NOT_A_NUMBER);
    assert_non_null(strstr(pls_last_message(), "nan"));
    pls_world_destroy(world);
}

/// 1 N/m, and a million times that from t = 1 s on.
static pls_status stiffens(void *context, double time, const double *states, double *value)
{
    (void)context;
    (void)states;
    *value = time < 1.0 ? 1.0 : 1e6;
    return PLS_OK;
}

/// A sphere at rest between two that are fixed: w^2 = 2 kn/m, m = 4/3 pi kg, the limit 2/w is 2.9 s with 1 N/m and 2.9 ms with 1e6 N/m.
static void a_law_that_stiffens_is_noticed_within_64_steps(void **state)
{
    (void)state;
    pls_material_id grain;
    pls_world *world = row_of_spheres(3, 0.01, &grain);
    assert_int_equal(pls_world_bind_law_parameter(world, grain, grain, "kn", stiffens, NULL, NULL), PLS_OK);
    pls_status status = PLS_OK;
    int steps = 0;
    for (; steps < 400 && status == PLS_OK; ++steps) status = pls_step(world);
    assert_int_equal(status, PLS_UNSTABLE_STEP);
    assert_in_range(steps, 100, 164);
    pls_world_destroy(world);
}

static const pls_shape_ops *builtin_shape(const char *name)
{
    const pls_shape_ops *const *ops = pls_builtin_shapes();
    while (*ops && strcmp((*ops)->name, name) != 0) ++ops;
    assert_non_null(*ops);
    return *ops;
}

/// Away from the start along x at 1 m/s.
static pls_status leaves(void *context, double time, pls_vec3 *velocity, pls_vec3 *angular_velocity)
{
    (void)context, (void)time;
    *velocity = pls_vec(1.0, 0.0, 0.0);
    *angular_velocity = pls_vec(0.0, 0.0, 0.0);
    return PLS_OK;
}

/// A gate may be drawn through a wall: neither can be moved, so that they need no law and no overlap of theirs stops the run. A free body there still needs a law.
static void what_no_force_can_move_passes_through_its_like(void **state)
{
    (void)state;
    const double half_and_rounding[4] = {0.5, 0.5, 0.5, 0.0}, lets_go[1] = {0.0};
    for (int other = 0; other < 3; ++other) // a fixed box, a plane, and a free box
    {
        pls_material_id grain, steel;
        pls_world *world = row_of_spheres(0, 1e-3, &grain);
        pls_material_def material = pls_default_material_def();
        strcpy(material.name, "steel");
        material.values.density = 1.0;
        assert_int_equal(pls_world_add_material(world, &material, &steel), PLS_OK);
        pls_shape_id box, wall;
        assert_int_equal(pls_world_add_shape(world, "box", builtin_shape("box"), COUNTED(half_and_rounding), &box), PLS_OK);
        assert_int_equal(pls_world_add_shape(world, "wall", builtin_shape("plane"), COUNTED(lets_go), &wall), PLS_OK);
        pls_body_def gate = pls_default_body_def(), still = pls_default_body_def();
        pls_body_id id;
        gate.shape = box;
        gate.material = steel;
        gate.motion.axes = PLS_AXIS_ALL;
        gate.motion.function = leaves;
        assert_int_equal(pls_world_add_body(world, &gate, &id), PLS_OK);
        still.shape = other == 1 ? wall : box;
        still.material = steel;
        still.position = pls_vec(1.5, 0.0, 0.0);
        if (other == 0) still.motion.axes = PLS_AXIS_ALL;
        assert_int_equal(pls_world_add_body(world, &still, &id), PLS_OK);
        pls_status status = PLS_OK;
        for (int step = 0; step < 1500 && status == PLS_OK; ++step) status = pls_step(world);
        assert_int_equal(status, other == 2 ? PLS_NOT_FOUND : PLS_OK);
        pls_world_destroy(world);
    }
}

/// Two spheres that touch: the contacts they may still get refuse a step that is stable with the one they have, and the message says so. A step that is too large for that one
/// too is refused without a word about others.
static void a_refused_step_tells_of_contacts_still_to_come(void **state)
{
    (void)state;
    pls_material_id grain;
    pls_step_estimate estimate;
    pls_world *world = row_of_spheres(2, 1e-3, &grain);
    assert_int_equal(pls_world_stable_step(world, &estimate), PLS_OK);
    pls_world_destroy(world);
    world = row_of_spheres(2, 2.0 * estimate.dt, &grain);
    assert_int_equal(pls_world_prepare(world), PLS_UNSTABLE_STEP);
    assert_non_null(strstr(pls_last_message(), "Contacts still to come set it, 12 per body"));
    assert_non_null(strstr(pls_last_message(), "time.coordination"));
    pls_world_destroy(world);
    world = row_of_spheres(2, 10.0 * estimate.dt, &grain);
    assert_int_equal(pls_world_prepare(world), PLS_UNSTABLE_STEP);
    assert_null(strstr(pls_last_message(), "coordination"));
    pls_world_destroy(world);
}

/// Steps until the world stops with `expected`, in one go or one by one.
static uint64_t step_that_fails(pls_world *world, bool at_once, pls_status expected)
{
    enum { MOST = 20000 };
    pls_status status = PLS_OK;
    if (at_once) status = pls_world_run(world, MOST);
    for (int k = 0; !at_once && k < MOST && status == PLS_OK; ++k) status = pls_step(world);
    assert_int_equal(status, expected);
    return pls_world_step_number(world);
}

/// A sphere of radius 1 m carried along x at `speed` from `x`, and a free one at the origin.
static pls_world *carried_and_free(double x, double speed, double max_overlap)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-3;
    def.max_overlap = max_overlap;
    const verify_value weak[] = {{"kn", 1e-6}, {"ks", 1e-6}, {"cn", 0.0}, {"cs", 0.0}, {"friction", 0.0}, {NULL, 0.0}};
    verify_scene s = verify_open(&def, "viscoelastic", weak);
    verify_ball(&s, 1.0, 1.0, pls_vec(0.0, 0.0, 0.0), pls_vec(0.0, 0.0, 0.0));
    pls_body_def carried = verify_ball_def(&s, 1.0, 1.0, pls_vec(x, 0.0, 0.0), pls_vec(0.0, 0.0, 0.0));
    carried.motion = (pls_motion_def){.axes = PLS_AXIS_ALL, .velocity = pls_vec(speed, 0.0, 0.0)};
    verify_add(&s, &carried);
    return s.world;
}

/// Looks that cannot find anything are left out, but none that would: the first of those every 64 steps behind the step in which the overlap passes its bound.
static void an_overlap_that_grows_slowly_stops_the_run_at_the_next_look(void **state)
{
    (void)state;
    for (int at_once = 0; at_once < 2; ++at_once)
    {
        pls_world *world = carried_and_free(2.5, -1.0, 0.5); // the overlap is t - 0.5, 0.5 in step 1000
        assert_int_equal(step_that_fails(world, at_once != 0, PLS_RUNAWAY_OVERLAP), 1024);
        pls_world_destroy(world);
    }
}

static void an_overlap_made_by_a_new_body_is_seen_at_the_next_look(void **state)
{
    (void)state;
    pls_world *world = carried_and_free(1.9, 0.0, 0.5);
    assert_int_equal(pls_world_run(world, 100), PLS_OK);
    pls_body_def body = pls_default_body_def();
    body.shape = (pls_shape_id){1}, body.material = (pls_material_id){1};
    body.position = pls_vec(0.6, 1.0, 0.0);
    pls_body_id id;
    assert_int_equal(pls_world_add_body(world, &body, &id), PLS_OK);
    assert_int_equal(step_that_fails(world, true, PLS_RUNAWAY_OVERLAP), 128);
    pls_world_destroy(world);
}

/// A ring that falls flat on a sheet: its contact holds the half of its tube, 0.1 m; what falls harder is told of before it is through. Fifty steps are the tube's radius.
static void a_wall_that_comes_past_the_middle_of_a_ring_stops_the_run(void **state)
{
    (void)state;
    const double speed[2] = {0.2, 2.0};
    for (int hard = 0; hard < 2; ++hard)
    {
        pls_world_def def = pls_default_world_def(3);
        def.dt = 1e-3;
        const verify_value weak[] = {{"kn", 1.0}, {"ks", 0.0}, {"friction", 0.0}, {NULL, 0.0}};
        verify_scene s = verify_open(&def, "elastic", weak);
        const double values[] = {0.3, 0.1};
        pls_body_def ring =
            verify_body_def(&s, verify_use_shape(&s, &values_ring, &(pls_shape_input){VALUES(values)}), pls_vec(0.1, 0.2, 0.3));
        ring.velocity = pls_vec(0.0, 0.0, -speed[hard]);
        verify_add(&s, &ring);
        pls_body_def wall = verify_body_def(&s, verify_add_mesh(&s, PLS_TEST_DATA "/sheet.obj"), pls_vec(0, 0, 0));
        wall.motion.axes = PLS_AXIS_ALL;
        verify_add(&s, &wall);
        if (hard)
        {
            step_that_fails(s.world, true, PLS_RUNAWAY_OVERLAP);
            assert_non_null(strstr(pls_last_message(), "has come past the middle of body 0"));
        }
        else
            assert_int_equal(pls_world_run(s.world, 3000), PLS_OK);
        verify_close(&s);
    }
}

static void a_body_that_flies_away_stops_the_run_at_the_next_look(void **state)
{
    (void)state;
    for (int at_once = 0; at_once < 2; ++at_once)
    {
        pls_world *world =
            carried_and_free(10.0, 1000.0, 1.0); // 5 m + 1 m per step from the middle; 1000 sizes sqrt(12^2 + 2^2 + 2^2) m in step 12325
        assert_int_equal(step_that_fails(world, at_once != 0, PLS_LOST_BODY), 12352);
        pls_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_step_that_makes_a_velocity_not_a_number_is_refused),
        cmocka_unit_test(a_law_that_stiffens_is_noticed_within_64_steps),
        cmocka_unit_test(what_no_force_can_move_passes_through_its_like),
        cmocka_unit_test(a_refused_step_tells_of_contacts_still_to_come),
        cmocka_unit_test(an_overlap_that_grows_slowly_stops_the_run_at_the_next_look),
        cmocka_unit_test(an_overlap_made_by_a_new_body_is_seen_at_the_next_look),
        cmocka_unit_test(a_wall_that_comes_past_the_middle_of_a_ring_stops_the_run),
        cmocka_unit_test(a_body_that_flies_away_stops_the_run_at_the_next_look),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
