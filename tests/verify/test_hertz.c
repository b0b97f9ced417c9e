// test_hertz.c -- Hertz-Mindlin contact; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void static_hertz_force_is_four_thirds_of_the_known_product(void **state)
{
    (void)state;
    verify_check(case_hertz_force);
}

static void hertz_collision_takes_the_analytic_time(void **state)
{
    (void)state;
    verify_check(case_hertz_collision);
}

static void tangential_stiffness_is_mindlins(void **state)
{
    (void)state;
    verify_check(case_mindlin);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(static_hertz_force_is_four_thirds_of_the_known_product),
        cmocka_unit_test(hertz_collision_takes_the_analytic_time),
        cmocka_unit_test(tangential_stiffness_is_mindlins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
