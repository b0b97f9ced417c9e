// test_order.c -- the integrator is of second order, all parts together; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void sphere_stuck_on_a_plane_with_coupled_states_is_second_order(void **state)
{
    (void)state;
    verify_check(case_order_sphere_on_plane);
}

static void two_spheres_pressed_together_with_coupled_states_are_second_order(void **state)
{
    (void)state;
    verify_check(case_order_two_spheres);
}

static void disc_stuck_on_a_line_with_coupled_states_is_second_order(void **state)
{
    (void)state;
    verify_check(case_order_disc);
}

static void the_energy_book_is_second_order(void **state)
{
    (void)state;
    verify_check(case_order_energy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sphere_stuck_on_a_plane_with_coupled_states_is_second_order),
        cmocka_unit_test(two_spheres_pressed_together_with_coupled_states_are_second_order),
        cmocka_unit_test(disc_stuck_on_a_line_with_coupled_states_is_second_order),
        cmocka_unit_test(the_energy_book_is_second_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
