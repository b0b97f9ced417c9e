// test_bonds.c -- peridynamic solids with known answers; the cases are in cases_bonds.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void waves_have_the_exact_dispersion_of_the_lattice(void **state)
{
    (void)state;
    verify_check(case_bond_dispersion);
}

static void shear_stores_the_sum_over_the_lattice(void **state)
{
    (void)state;
    verify_check(case_bond_shear);
}

static void a_bar_in_tension_has_its_modulus(void **state)
{
    (void)state;
    verify_check(case_bond_bar);
}

static void a_hole_concentrates_stress_three_times(void **state)
{
    (void)state;
    verify_check(case_hole);
}

static void finer_solids_converge(void **state)
{
    (void)state;
    verify_check(case_bond_orders);
}

static void solids_keep_energy_and_momenta(void **state)
{
    (void)state;
    verify_check(case_bond_energy);
}

static void a_crack_branches_below_the_speed_of_surface_waves(void **state)
{
    (void)state;
    verify_check(case_branching);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_have_the_exact_dispersion_of_the_lattice),
        cmocka_unit_test(shear_stores_the_sum_over_the_lattice),
        cmocka_unit_test(a_bar_in_tension_has_its_modulus),
        cmocka_unit_test(a_hole_concentrates_stress_three_times),
        cmocka_unit_test(finer_solids_converge),
        cmocka_unit_test(solids_keep_energy_and_momenta),
        cmocka_unit_test(a_crack_branches_below_the_speed_of_surface_waves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
