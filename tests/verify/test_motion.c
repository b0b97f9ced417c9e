// test_motion.c -- free fall, bouncing and prescribed motion; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void free_fall_is_exact(void **state)
{
    (void)state;
    verify_check(case_free_fall);
}

static void a_bouncing_sphere_returns_to_its_height_in_the_analytic_time(void **state)
{
    (void)state;
    verify_check(case_bouncing);
}

static void driven_bodies_move_exactly_as_prescribed(void **state)
{
    (void)state;
    verify_check(case_driven);
}

static void locked_axes_stay_and_free_axes_obey_forces(void **state)
{
    (void)state;
    verify_check(case_locks);
}

static void motion_by_a_function_is_second_order(void **state)
{
    (void)state;
    verify_check(case_motion_function);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_fall_is_exact),
        cmocka_unit_test(a_bouncing_sphere_returns_to_its_height_in_the_analytic_time),
        cmocka_unit_test(driven_bodies_move_exactly_as_prescribed),
        cmocka_unit_test(locked_axes_stay_and_free_axes_obey_forces),
        cmocka_unit_test(motion_by_a_function_is_second_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
