// test_solids.c -- boxes on planes and on each other; the cases are in cases_solids.c.
#include "verify/cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static void a_box_at_rest_on_a_plane_stays(void **state)
{
    (void)state;
    verify_check(case_box_at_rest);
}

static void a_box_that_is_dropped_comes_to_rest_flat_and_stays(void **state)
{
    (void)state;
    verify_check(case_box_comes_to_rest);
}

static void a_stack_of_ten_boxes_stays(void **state)
{
    (void)state;
    verify_check(case_stack);
}

static void a_box_on_a_slope_slides_from_atan_mu_on(void **state)
{
    (void)state;
    verify_check(case_box_on_slope);
}

static void a_box_rocks_on_its_face_as_a_damped_oscillator(void **state)
{
    (void)state;
    verify_check(case_rocking);
}

static void a_disc_spinning_on_its_face_stops_by_two_thirds_mu_m_g_r(void **state)
{
    (void)state;
    verify_check(case_spinning_on_face);
}

static void cylinder_capsule_and_compound_roll_down_a_slope(void **state)
{
    (void)state;
    verify_check(case_rolling_solids);
}

static void an_ellipsoid_settles_on_its_shortest_axis(void **state)
{
    (void)state;
    verify_check(case_ellipsoid_settles);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_at_rest_on_a_plane_stays),
        cmocka_unit_test(a_box_that_is_dropped_comes_to_rest_flat_and_stays),
        cmocka_unit_test(a_stack_of_ten_boxes_stays),
        cmocka_unit_test(a_box_on_a_slope_slides_from_atan_mu_on),
        cmocka_unit_test(a_box_rocks_on_its_face_as_a_damped_oscillator),
        cmocka_unit_test(a_disc_spinning_on_its_face_stops_by_two_thirds_mu_m_g_r),
        cmocka_unit_test(cylinder_capsule_and_compound_roll_down_a_slope),
        cmocka_unit_test(an_ellipsoid_settles_on_its_shortest_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
