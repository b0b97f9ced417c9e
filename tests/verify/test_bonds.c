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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_have_the_exact_dispersion_of_the_lattice),
        cmocka_unit_test(shear_stores_the_sum_over_the_lattice),
        cmocka_unit_test(a_bar_in_tension_has_its_modulus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
