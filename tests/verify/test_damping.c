// test_damping.c -- local damping and adaptive relaxation: what they take, that they leave driven bodies alone, and where a world comes to rest.
#include "support/lattice.h"
#include "support/verify.h"

#include <particls/threads.h>

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>
#include <cmocka.h>

static const double stiffness = 40.0, push = 3.0; // of the field [N/m], [N]

static void spring(double time, pls_vec3 x, pls_vec3 v, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)time, (void)v, (void)body;
    *force = pls_vec(push - stiffness * x.x, -2.0 * stiffness * x.y, 0);
    *torque = pls_vec(0, 0, 0);
}
static double spring_energy(pls_vec3 x, double mass)
{
    (void)mass;
    return 0.5 * stiffness * (x.x * x.x + 2.0 * x.y * x.y) - push * x.x;
}
static const verify_field field = {spring, spring_energy};

static verify_scene open_scene(double local, bool relaxation, double dt)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    def.allow_unstable = true;
    def.coordination = 0;
    def.local_damping = local;
    def.relaxation = relaxation;
    const verify_value law[] = {{"kn", 100.0}, {NULL, 0.0}};
    return verify_open(&def, "elastic", law);
}

/// From turn to turn about the place of rest: outwards the force is larger by alpha, inwards smaller, so a swing ends at sqrt((1 - alpha)/(1 + alpha)) of where it began.
static void local_damping_shortens_each_swing(void **state)
{
    (void)state;
    const double alpha = 0.3, dt = 1e-4, rest = push / stiffness;
    verify_scene s = open_scene(alpha, false, dt);
    const pls_body_id ball = verify_ball(&s, 0.1, 2.0, pls_vec(rest + 1.0, 0, 0), pls_vec(0, 0, 0));
    verify_add_field(s.world, &field);
    double turn = 1.0, before = 0.0;
    for (int swings = 0; swings < 4;)
    {
        MUST(pls_step(s.world));
        const pls_body_motion m = verify_motion(s.world, ball);
        if (before != 0.0 && before * m.velocity.x < 0.0)
        {
            const double now = m.position.x - rest;
            assert_true(fabs(fabs(now / turn) / sqrt((1.0 - alpha) / (1.0 + alpha)) - 1.0) < 1e-4);
            turn = now;
            ++swings;
        }
        before = m.velocity.x;
    }
    verify_close(&s);
}

static double book_error(double local, bool relaxation, double dt)
{
    verify_scene s = open_scene(local, relaxation, dt);
    verify_ball(&s, 0.1, 2.0, pls_vec(1.0, 0.3, 0), pls_vec(0, 2, 0));
    verify_ball(&s, 0.1, 0.7, pls_vec(-1.0, -0.5, 0), pls_vec(1, 0, 0));
    verify_add_field(s.world, &field);
    const double before = verify_total_energy(s.world);
    MUST(pls_world_run(s.world, (uint64_t)(2.0 / dt + 0.5)));
    assert_true(verify_figures(s.world).energy_damped > 0.1 * fabs(before));
    const double error = verify_total_energy(s.world) / before - 1.0;
    verify_close(&s);
    return error;
}

static void what_is_taken_is_booked(void **state)
{
    (void)state;
    for (int relaxation = 0; relaxation < 2; ++relaxation)
    {
        const double local = relaxation ? 0.0 : 0.2, coarse = book_error(local, relaxation, 2e-3),
                     fine = book_error(local, relaxation, 1e-3);
        assert_true(fabs(coarse) < 2e-3 && fabs(fine) < 0.6 * fabs(coarse)); // signs turn within a step: between first and second order
    }
}

/// Two frequencies, a factor of 1.4 apart: at rest within a few periods of the slower one.
static void relaxation_finds_the_place_of_rest(void **state)
{
    (void)state;
    verify_scene s = open_scene(0.0, true, 2e-3);
    const pls_body_id ball = verify_ball(&s, 0.1, 2.0, pls_vec(1.0, 0.3, 0), pls_vec(0, 2, 0));
    verify_add_field(s.world, &field);
    const double period = 2.0 * 3.14159265358979323846 * sqrt(2.0 / stiffness);
    MUST(pls_world_run(s.world, (uint64_t)(5.0 * period / 2e-3)));
    const pls_body_motion m = verify_motion(s.world, ball);
    assert_true(fabs(m.position.x - push / stiffness) < 1e-6 && fabs(m.position.y) < 1e-6);
    verify_close(&s);
}

/// Axes that are driven, and what is fixed, are left alone; free ones of the same body are not.
static void driven_axes_are_left_alone(void **state)
{
    (void)state;
    for (int relaxation = 0; relaxation < 2; ++relaxation)
    {
        verify_scene s = open_scene(relaxation ? 0.0 : 0.5, relaxation, 1e-3);
        pls_body_def def = verify_ball_def(&s, 0.1, 2.0, pls_vec(1, 0.5, 0), pls_vec(0, 0, 0));
        def.motion.axes = PLS_AXIS_X | PLS_AXIS_RZ;
        def.motion.velocity = pls_vec(0.25, 0, 0);
        def.motion.angular_velocity = pls_vec(0, 0, 1.5);
        const pls_body_id partly = verify_add(&s, &def);
        def.position = pls_vec(0, 3, 0);
        def.motion.axes = PLS_AXIS_ALL;
        const pls_body_id wholly = verify_add(&s, &def);
        verify_add_field(s.world, &field);
        MUST(pls_world_run(s.world, 2000));
        pls_body_motion m = verify_motion(s.world, wholly);
        assert_true(fabs(m.position.x - 0.5) < 1e-12 && fabs(m.position.y - 3.0) < 1e-12 && fabs(m.angular_velocity.z - 1.5) < 1e-12);
        m = verify_motion(s.world, partly);
        assert_true(fabs(m.position.x - 1.5) < 1e-12 && fabs(m.velocity.x - 0.25) < 1e-12 && fabs(m.angular_velocity.z - 1.5) < 1e-12);
        assert_true(fabs(m.position.y) < 0.05);                                  // it would swing to 0.5
        assert_true(fabs(m.force.x - (push - stiffness * m.position.x)) < 1e-9); // what the drive works against
        verify_close(&s);
    }
}

/// Bits do not depend on threads, for bodies of all kinds.
static void bits_are_equal_for_threads(void **state)
{
    (void)state;
    for (int relaxation = 0; relaxation < 2; ++relaxation)
    {
        uint64_t hash[2];
        for (int n = 0; n < 2; ++n)
        {
            pls_set_threads(1 + 2 * n);
            verify_scene s = open_scene(relaxation ? 0.0 : 0.5, relaxation, 1e-3);
            const double half[4] = {0.1, 0.2, 0.3, 0.0};
            const pls_shape_id box = verify_add_shape(&s, "box", half, 4);
            for (int k = 0; k < 3000; ++k)
            {
                pls_body_def def = verify_body_def(&s, k % 3 ? s.ball : box, pls_vec(3.0 * (k % 15), 3.0 * (k / 15 % 15), 3.0 * (k / 225)));
                def.velocity = pls_vec(sin(k), cos(3.0 * k), 0);
                def.angular_velocity = pls_vec(cos(k), 1, sin(2.0 * k));
                verify_add(&s, &def);
            }
            verify_add_field(s.world, &field);
            MUST(pls_world_run(s.world, 40));
            hash[n] = verify_hash(s.world);
            verify_close(&s);
        }
        pls_set_threads(1);
        assert_int_equal(hash[0], hash[1]);
    }
}

static void impossible_damping_is_refused(void **state)
{
    (void)state;
    pls_world *world;
    pls_world_def def = pls_default_world_def(3);
    def.local_damping = 1.0;
    assert_int_equal(pls_world_create(&def, &world), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "local damping is 1"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(local_damping_shortens_each_swing),  cmocka_unit_test(what_is_taken_is_booked),
        cmocka_unit_test(relaxation_finds_the_place_of_rest), cmocka_unit_test(driven_axes_are_left_alone),
        cmocka_unit_test(bits_are_equal_for_threads),         cmocka_unit_test(impossible_damping_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
