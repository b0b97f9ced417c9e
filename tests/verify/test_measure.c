// test_measure.c -- homogenised measures with closed forms; the cases are in cases_*.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void stress_of_a_two_sphere_column_is_force_times_branch(void **state)
{
    (void)state;
    verify_check(case_column_stress);
}

static void tangent_operator_of_one_contact_is_exact(void **state)
{
    (void)state;
    verify_check(case_single_contact_tangent);
}

static void tangent_operator_of_a_face_centred_cubic_packing_is_exact(void **state)
{
    (void)state;
    verify_check(case_fcc_tangent);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stress_of_a_two_sphere_column_is_force_times_branch),
        cmocka_unit_test(tangent_operator_of_one_contact_is_exact),
        cmocka_unit_test(tangent_operator_of_a_face_centred_cubic_packing_is_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
