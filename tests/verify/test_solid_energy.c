// test_solid_energy.c -- conservation among grains of all shapes; the cases are in cases_solid_energy.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void a_free_cloud_of_all_shapes_keeps_both_momenta_to_round_off(void **state)
{
    (void)state;
    verify_check(case_solid_cloud);
}

static void impacts_of_all_shapes_with_friction_keep_the_energy_book_to_second_order(void **state)
{
    (void)state;
    verify_check(case_solid_book);
}

static void a_crowd_of_all_shapes_keeps_its_energy_book(void **state)
{
    (void)state;
    verify_check(case_solid_crowd);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_free_cloud_of_all_shapes_keeps_both_momenta_to_round_off),
        cmocka_unit_test(impacts_of_all_shapes_with_friction_keep_the_energy_book_to_second_order),
        cmocka_unit_test(a_crowd_of_all_shapes_keeps_its_energy_book),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
