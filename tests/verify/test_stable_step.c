// test_stable_step.c -- the estimate of the stable step; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void the_estimate_is_that_of_a_spring_and_dashpot_for_one_contact(void **state)
{
    (void)state;
    verify_check(case_step_estimate_pair);
}

static void the_estimate_is_safe_for_packings_and_not_below_a_third_of_the_limit(void **state)
{
    (void)state;
    verify_check(case_step_estimate_packing);
}

static void a_step_limited_by_the_dashpot_is_refused_by_name(void **state)
{
    (void)state;
    verify_check(case_step_refused);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_estimate_is_that_of_a_spring_and_dashpot_for_one_contact),
        cmocka_unit_test(the_estimate_is_safe_for_packings_and_not_below_a_third_of_the_limit),
        cmocka_unit_test(a_step_limited_by_the_dashpot_is_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
