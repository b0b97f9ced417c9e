// test_rotation.c -- free rotation of an asymmetric body; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void free_rotation_follows_jacobi_at_second_order(void **state)
{
    (void)state;
    verify_check(case_free_rotation);
}

static void free_rotation_keeps_angular_momentum_to_round_off_and_energy_without_drift(void **state)
{
    (void)state;
    verify_check(case_free_rotation_drift);
}

static void flips_about_the_intermediate_axis_have_the_elliptic_period(void **state)
{
    (void)state;
    verify_check(case_intermediate_axis);
}

static void a_box_thrown_about_its_middle_axis_flips_as_jacobi_says(void **state)
{
    (void)state;
    verify_check(case_box_top);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_rotation_follows_jacobi_at_second_order),
        cmocka_unit_test(free_rotation_keeps_angular_momentum_to_round_off_and_energy_without_drift),
        cmocka_unit_test(flips_about_the_intermediate_axis_have_the_elliptic_period),
        cmocka_unit_test(a_box_thrown_about_its_middle_axis_flips_as_jacobi_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
