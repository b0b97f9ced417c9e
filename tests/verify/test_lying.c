// test_lying.c -- capsules and cylinders that lie along a line; the case is in cases_lying.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void what_lies_along_a_line_rests_rocks_and_slides_as_theory_says(void **state)
{
    (void)state;
    verify_check(case_lying);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_lies_along_a_line_rests_rocks_and_slides_as_theory_says)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
