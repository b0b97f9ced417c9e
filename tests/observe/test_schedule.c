// Schedules against integer arithmetic: with dt = a units and every = b units, look k belongs to step ceil(k b / a).

#include <particls/observe.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static pls_schedule every_seconds(double every) { return (pls_schedule){.every = every, .end = INFINITY}; }

static pls_schedule every_so_many_steps(uint64_t steps) { return (pls_schedule){.every_steps = steps, .end = INFINITY}; }

static bool due(const pls_schedule *schedule, uint64_t step, double dt) { return pls_schedule_due(schedule, step, (double)step * dt, dt); }

static int looks(const pls_schedule *schedule, uint64_t first, uint64_t last, double dt)
{
    int count = 0;
    for (uint64_t step = first; step <= last; ++step) count += due(schedule, step, dt);
    return count;
}

/// Whether a multiple of `every` lies in ((step - 1) dt, step dt], all in whole units.
static bool due_in_units(uint64_t step, uint64_t dt, uint64_t every)
{
    if (step == 0) return true;
    return step * dt / every > (step - 1) * dt / every;
}

static void expect_units(uint64_t first, uint64_t last, uint64_t dt, uint64_t every, double unit)
{
    pls_schedule schedule = every_seconds((double)every * unit);
    for (uint64_t step = first; step <= last; ++step)
    {
        assert_int_equal(due(&schedule, step, (double)dt * unit), due_in_units(step, dt, every));
    }
}

static void a_multiple_of_the_step_fires_exactly_at_its_multiples(void **state)
{
    (void)state;
    const double dt = 2.5e-5;
    pls_schedule coarse = every_seconds(0.01);
    pls_schedule middle = every_seconds(0.005);
    pls_schedule fine = every_seconds(0.000125);
    assert_int_equal(looks(&coarse, 0, 40000, dt), 101);
    assert_int_equal(looks(&middle, 0, 40000, dt), 201);
    assert_int_equal(looks(&fine, 0, 40000, dt), 8001);
    for (uint64_t step = 0; step <= 40000; ++step)
    {
        assert_int_equal(due(&coarse, step, dt), step % 400 == 0);
        assert_int_equal(due(&middle, step, dt), step % 200 == 0);
        assert_int_equal(due(&fine, step, dt), step % 5 == 0);
    }
}

static void any_pair_of_step_and_interval_agrees_with_integers(void **state)
{
    (void)state;
    const double units[] = {1e-6, 1e-3, 1e-9, 0.7e-5};
    for (size_t u = 0; u < 4; ++u)
    {
        for (uint64_t dt = 1; dt <= 24; ++dt)
        {
            for (uint64_t every = 1; every <= 60; ++every) expect_units(0, 700, dt, every, units[u]);
        }
    }
}

static void nothing_drifts_over_a_hundred_million_steps(void **state)
{
    (void)state;
    const uint64_t far = UINT64_C(100000000);
    expect_units(far - 100000, far, 25, 5000, 1e-6);
    expect_units(far - 100000, far, 25, 3333, 1e-6);
    expect_units(far - 100000, far, 7, 10, 1e-7);
    expect_units(far - 100000, far, 7, 1000003, 1e-9);
}

static void an_interval_shorter_than_the_step_fires_each_step(void **state)
{
    (void)state;
    const double shorter[] = {0.9e-3, 1e-3, 1e-4, 1e-12, 1e-300, 5e-324};
    for (size_t k = 0; k < 6; ++k)
    {
        pls_schedule schedule = every_seconds(shorter[k]);
        assert_int_equal(looks(&schedule, 0, 2000, 1e-3), 2001);
        assert_int_equal(looks(&schedule, 99999000, 100000000, 1e-3), 1001);
    }
}

static void the_interval_counts_from_the_start(void **state)
{
    (void)state;
    // start 0.35, every 0.2, dt 0.1: 0.35 -> step 4, 0.55 -> step 6, 0.75 -> step 8
    pls_schedule schedule = {.every = 0.2, .start = 0.35, .end = INFINITY};
    for (uint64_t step = 0; step <= 100; ++step) assert_int_equal(due(&schedule, step, 0.1), step >= 4 && step % 2 == 0);
    // a start on a step: 0.3 = step 3 although 3 * 0.1 > 0.3 in doubles
    schedule.start = 0.3;
    for (uint64_t step = 0; step <= 100; ++step) assert_int_equal(due(&schedule, step, 0.1), step >= 3 && step % 2 == 1);
    // a start before time zero: step 0, and then -0.25 + k 0.2: -0.05, 0.15 -> step 2, 0.35 -> 4
    schedule.start = -0.25;
    for (uint64_t step = 0; step <= 100; ++step) assert_int_equal(due(&schedule, step, 0.1), step % 2 == 0);
}

static void the_end_is_inclusive(void **state)
{
    (void)state;
    pls_schedule schedule = {.every = 0.1, .end = 0.7}; // 7 * 0.1 > 0.7 in doubles
    assert_int_equal(looks(&schedule, 0, 1000, 0.1), 8);
    assert_true(due(&schedule, 7, 0.1));
    schedule.end = 0.69999;
    assert_int_equal(looks(&schedule, 0, 1000, 0.1), 7);
    schedule.end = 0;
    assert_int_equal(looks(&schedule, 0, 1000, 0.1), 1);
    schedule = (pls_schedule){.every_steps = 3, .end = 0.6};
    assert_int_equal(looks(&schedule, 0, 1000, 0.1), 3);
    schedule = (pls_schedule){.every = 0.1, .start = 0.5, .end = 0.4};
    assert_int_equal(looks(&schedule, 0, 1000, 0.1), 0);
}

static void steps_count_from_the_first_step_at_or_after_the_start(void **state)
{
    (void)state;
    pls_schedule schedule = every_so_many_steps(7);
    for (uint64_t step = 0; step <= 1000; ++step) assert_int_equal(due(&schedule, step, 2.5e-5), step % 7 == 0);
    const uint64_t far = UINT64_C(100000000);
    for (uint64_t step = far - 1000; step <= far; ++step) assert_int_equal(due(&schedule, step, 2.5e-5), step % 7 == 0);

    schedule.start = 0.3; // step 3
    for (uint64_t step = 0; step <= 1000; ++step) assert_int_equal(due(&schedule, step, 0.1), step >= 3 && (step - 3) % 7 == 0);
    schedule.start = 0.31; // step 4
    for (uint64_t step = 0; step <= 1000; ++step) assert_int_equal(due(&schedule, step, 0.1), step >= 4 && (step - 4) % 7 == 0);
    schedule.start = 1e30;
    assert_int_equal(looks(&schedule, 0, 1000, 0.1), 0);
}

static void every_one_step_fires_each_step(void **state)
{
    (void)state;
    pls_schedule schedule = every_so_many_steps(1);
    assert_int_equal(looks(&schedule, 0, 5000, 1e-4), 5001);
}

static void without_an_interval_there_is_one_look_at_the_start(void **state)
{
    (void)state;
    pls_schedule schedule = every_seconds(0);
    assert_int_equal(looks(&schedule, 0, 1000, 0.1), 1);
    assert_true(due(&schedule, 0, 0.1));
    schedule.start = 0.45;
    assert_int_equal(looks(&schedule, 0, 1000, 0.1), 1);
    assert_true(due(&schedule, 5, 0.1));
}

static void a_step_length_that_changed_neither_misses_nor_doubles_a_look(void **state)
{
    (void)state;
    // 1,000 steps of 1e-3, then 4,000 of 2.5e-4 counted from there: 2 s in all, a look every 0.01 s
    pls_schedule schedule = every_seconds(0.01);
    int count = looks(&schedule, 0, 1000, 1e-3);
    for (uint64_t step = 1001; step <= 5000; ++step)
    {
        count += pls_schedule_due(&schedule, step, 1.0 + (double)(step - 1000) * 2.5e-4, 2.5e-4);
    }
    assert_int_equal(count, 201);
}

static void a_time_that_is_not_a_number_is_never_due(void **state)
{
    (void)state;
    pls_schedule schedule = every_seconds(0.1);
    assert_false(pls_schedule_due(&schedule, 5, NAN, 0.1));
    assert_false(pls_schedule_due(&schedule, 5, 0.5, NAN));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_multiple_of_the_step_fires_exactly_at_its_multiples),
        cmocka_unit_test(any_pair_of_step_and_interval_agrees_with_integers),
        cmocka_unit_test(nothing_drifts_over_a_hundred_million_steps),
        cmocka_unit_test(an_interval_shorter_than_the_step_fires_each_step),
        cmocka_unit_test(the_interval_counts_from_the_start),
        cmocka_unit_test(the_end_is_inclusive),
        cmocka_unit_test(steps_count_from_the_first_step_at_or_after_the_start),
        cmocka_unit_test(every_one_step_fires_each_step),
        cmocka_unit_test(without_an_interval_there_is_one_look_at_the_start),
        cmocka_unit_test(a_step_length_that_changed_neither_misses_nor_doubles_a_look),
        cmocka_unit_test(a_time_that_is_not_a_number_is_never_due),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
