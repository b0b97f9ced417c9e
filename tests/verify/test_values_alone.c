// test_values_alone.c -- bodies known by their signed distance alone; the case is in cases_values_alone.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void what_is_known_by_its_distance_alone_falls_and_comes_to_rest(void **state)
{
    (void)state;
    verify_check(case_values_alone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_known_by_its_distance_alone_falls_and_comes_to_rest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
