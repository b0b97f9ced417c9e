// Sine and cosine of small angles, and angles by them, against the C library's: within two last digits, on both sides of where the series end.

#include "math/small_turn.h"

#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void compare(double angle)
{
    double sine, cosine;
    pls_small_turn(angle, &sine, &cosine);
    if (!(fabs(sine - sin(angle)) <= DBL_EPSILON * fabs(sin(angle))) || !(fabs(cosine - cos(angle)) <= DBL_EPSILON))
        fail_msg("at %a: %a, %a, not %a, %a", angle, sine, cosine, sin(angle), cos(angle));
    if (!(angle > 0.0 && angle < 3.14)) return;
    sine = sin(angle), cosine = cos(angle);
    const double expected = atan2(sine, cosine) / sine, ratio = pls_angle_by_sine(sine, cosine);
    if (!(fabs(ratio - expected) <= DBL_EPSILON * expected)) fail_msg("at %a: %a, not %a", angle, ratio, expected);
}

static void test_angles(void **unused)
{
    (void)unused;
    for (int k = 0; k <= 2000000; ++k)
    {
        const double angle = 0.04 * k / 2000000;
        compare(angle), compare(-angle);
    }
    for (double angle = 1e-300; angle < 4.0; angle *= 1.01) compare(angle), compare(-angle);
    compare(0.0);
    assert_true(pls_angle_by_sine(0.0, 1.0) == 1.0);
}

static void test_not_a_number(void **unused)
{
    (void)unused;
    double sine, cosine;
    pls_small_turn(NAN, &sine, &cosine);
    assert_true(isnan(sine) && isnan(cosine) && isnan(pls_angle_by_sine(NAN, 1.0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_angles), cmocka_unit_test(test_not_a_number)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
