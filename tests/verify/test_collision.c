// test_collision.c -- single impacts: contact time, energy, restitution, friction; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void two_spheres_collide_for_half_a_contact_period(void **state)
{
    (void)state;
    verify_check(case_contact_time);
}

static void an_elastic_collision_keeps_energy_to_second_order(void **state)
{
    (void)state;
    verify_check(case_elastic_energy);
}

static void a_viscoelastic_collision_has_the_analytic_restitution(void **state)
{
    (void)state;
    verify_check(case_restitution);
}

static void oblique_impact_on_a_plane_follows_the_stick_slip_solution(void **state)
{
    (void)state;
    verify_check(case_oblique_wall);
}

static void oblique_impact_of_unequal_spheres_follows_the_stick_slip_solution(void **state)
{
    (void)state;
    verify_check(case_oblique_pair);
}

static void oblique_impact_of_a_disc_follows_the_stick_slip_solution(void **state)
{
    (void)state;
    verify_check(case_oblique_disc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_spheres_collide_for_half_a_contact_period),
        cmocka_unit_test(an_elastic_collision_keeps_energy_to_second_order),
        cmocka_unit_test(a_viscoelastic_collision_has_the_analytic_restitution),
        cmocka_unit_test(oblique_impact_on_a_plane_follows_the_stick_slip_solution),
        cmocka_unit_test(oblique_impact_of_unequal_spheres_follows_the_stick_slip_solution),
        cmocka_unit_test(oblique_impact_of_a_disc_follows_the_stick_slip_solution),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
