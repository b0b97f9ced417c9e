// test_energy.c -- friction and the energy book; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void oblique_impacts_with_sliding_keep_the_energy_book_to_second_order(void **state)
{
    (void)state;
    verify_check(case_book_oblique);
}

static void pressed_grazing_rolling_and_spinning_contacts_keep_the_energy_book(void **state)
{
    (void)state;
    verify_check(case_book_pressed);
}

static void a_rolling_sphere_accelerates_at_five_sevenths_of_the_slope(void **state)
{
    (void)state;
    verify_check(case_rolling);
}

static void a_sliding_sphere_rolls_at_five_sevenths_of_its_speed(void **state)
{
    (void)state;
    verify_check(case_sliding_to_rolling);
}

static void a_collapsing_cloud_keeps_both_momenta_to_round_off_and_its_energy_book(void **state)
{
    (void)state;
    verify_check(case_cloud);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(oblique_impacts_with_sliding_keep_the_energy_book_to_second_order),
        cmocka_unit_test(pressed_grazing_rolling_and_spinning_contacts_keep_the_energy_book),
        cmocka_unit_test(a_rolling_sphere_accelerates_at_five_sevenths_of_the_slope),
        cmocka_unit_test(a_sliding_sphere_rolls_at_five_sevenths_of_its_speed),
        cmocka_unit_test(a_collapsing_cloud_keeps_both_momenta_to_round_off_and_its_energy_book),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
