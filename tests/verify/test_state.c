// test_state.c -- state objects; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void a_growing_radius_is_exact_and_keeps_mass_or_density(void **state)
{
    (void)state;
    verify_check(case_dilating);
}

static void states_are_advanced_at_second_order(void **state)
{
    (void)state;
    verify_check(case_logistic);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_growing_radius_is_exact_and_keeps_mass_or_density),
        cmocka_unit_test(states_are_advanced_at_second_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
