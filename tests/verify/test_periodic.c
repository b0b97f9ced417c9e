// test_periodic.c -- periodic boxes; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void a_collision_across_the_boundary_is_the_collision_in_open_space(void **state)
{
    (void)state;
    verify_check(case_periodic_collision);
}

static void a_periodic_box_keeps_momentum_to_round_off(void **state)
{
    (void)state;
    verify_check(case_periodic_momentum);
}

static void a_shrinking_box_presses_a_chain_as_computed(void **state)
{
    (void)state;
    verify_check(case_stretching_chain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_collision_across_the_boundary_is_the_collision_in_open_space),
        cmocka_unit_test(a_periodic_box_keeps_momentum_to_round_off),
        cmocka_unit_test(a_shrinking_box_presses_a_chain_as_computed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
