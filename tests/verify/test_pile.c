// test_pile.c -- grains of all kinds come to rest; the case is in cases_pile.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void a_pile_of_all_kinds_comes_to_rest(void **state)
{
    (void)state;
    verify_check(case_pile);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_pile_of_all_kinds_comes_to_rest)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
