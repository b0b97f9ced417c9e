// The largest eigenvalue of large operators against spectra known from theory.

#include "math/lanczos.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { MANY = 5000 };
static const double pi = 3.14159265358979323846;

/// A start with a part in every direction.
static void start_anywhere(double *x, size_t count)
{
    for (size_t k = 0; k < count; ++k) x[k] = sin(1.0 + 12.9898 * (double)(k * k % 1009)) + 0.1;
}

static size_t count_of(const void *context) { return *(const size_t *)context; }

/// Second differences with fixed ends: eigenvalues 2 - 2 cos(pi m / (n + 1)).
static void string_of_springs(const void *context, const double *x, double *y)
{
    size_t n = count_of(context);
    for (size_t k = 0; k < n; ++k) y[k] = 2.0 * x[k] - (k > 0 ? x[k - 1] : 0.0) - (k + 1 < n ? x[k + 1] : 0.0);
}

static void largest_of_a_string(void **state)
{
    (void)state;
    static double x[MANY];
    for (size_t n = 1; n <= MANY; n = 3 * n + 1)
    {
        double largest, known = 2.0 - 2.0 * cos(pi * (double)n / (double)(n + 1));
        start_anywhere(x, n);
        assert_int_equal(pls_lanczos_largest(string_of_springs, &n, n, x, &largest), PLS_OK);
        assert_true(largest <= known * (1.0 + 1e-9));
        assert_true(largest >= known * 0.99);                     // the densest end of a spectrum there is: the slowest case
        if (n <= 8) assert_true(largest >= known * (1.0 - 1e-9)); // as many iterations as eigenvalues
    }
}

/// One large eigenvalue far above the rest: 7 at index 123, others up to 1.
static void one_above(const void *context, const double *x, double *y)
{
    for (size_t k = 0; k < count_of(context); ++k) y[k] = k == 123 ? 7.0 * x[k] : x[k] * (double)k / (double)count_of(context);
}

static void largest_that_stands_out(void **state)
{
    (void)state;
    static double x[MANY];
    size_t n = MANY;
    double largest;
    start_anywhere(x, n);
    assert_int_equal(pls_lanczos_largest(one_above, &n, n, x, &largest), PLS_OK);
    assert_true(fabs(largest - 7.0) < 1e-3);
}

static void nothing(const void *context, const double *x, double *y)
{
    for (size_t k = 0; k < count_of(context); ++k) y[k] = 0.0 * x[k];
}

/// Softening springs alone: no eigenvalue is positive.
static void all_negative(const void *context, const double *x, double *y)
{
    for (size_t k = 0; k < count_of(context); ++k) y[k] = -(1.0 + (double)k) * x[k];
}

static void not_finite(const void *context, const double *x, double *y)
{
    for (size_t k = 0; k < count_of(context); ++k) y[k] = k == 3 ? NAN : x[k];
}

static void zero_negative_and_nan(void **state)
{
    (void)state;
    double x[10], largest;
    size_t n = 10;
    start_anywhere(x, n);
    assert_int_equal(pls_lanczos_largest(nothing, &n, n, x, &largest), PLS_OK);
    assert_true(largest == 0.0);
    for (size_t few = 1; few <= n; few += 9)
    {
        start_anywhere(x, few);
        assert_int_equal(pls_lanczos_largest(all_negative, &few, few, x, &largest), PLS_OK);
        assert_true(largest <= -1.0 + 1e-6 && largest >= -1.5);
    }
    start_anywhere(x, n);
    assert_int_equal(pls_lanczos_largest(not_finite, &n, n, x, &largest), PLS_OK);
    assert_true(isnan(largest));
    for (size_t k = 0; k < n; ++k) x[k] = 0.0;
    assert_int_equal(pls_lanczos_largest(string_of_springs, &n, n, x, &largest), PLS_OK);
    assert_true(largest == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(largest_of_a_string),
        cmocka_unit_test(largest_that_stands_out),
        cmocka_unit_test(zero_negative_and_nan),
    };
    return cmocka_run_group_tests_name("lanczos", tests, NULL, NULL);
}
