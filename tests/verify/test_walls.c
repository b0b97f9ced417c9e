// test_walls.c -- edges of walls of triangles; the case is in cases_walls.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void flights_against_edges_keep_their_energy(void **state)
{
    (void)state;
    verify_check(case_wall_edges);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(flights_against_edges_keep_their_energy)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
