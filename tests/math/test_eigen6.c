// Eigenvalues of small symmetric matrices against spectra known from theory.

#include "math/eigen6.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;

static void expect_values(const double *a, int n, const double *expected, double error)
{
    double values[PLS_EIGEN_MAX];
    pls_symmetric_eigenvalues(a, n, values);
    for (int i = 0; i < n; ++i) assert_true(fabs(values[i] - expected[i]) <= error);
    assert_true(fabs(pls_largest_eigenvalue(a, n) - expected[n - 1]) <= error);
}

/// a = Q diag(values) Q^T with Q the product of two reflections I - 2 u u^T / u^T u.
static void with_spectrum(const double *values, int n, double *a)
{
    double q[PLS_EIGEN_MAX][PLS_EIGEN_MAX] = {{0}};
    for (int i = 0; i < n; ++i) q[i][i] = 1;
    for (int reflection = 0; reflection < 2; ++reflection)
    {
        double u[PLS_EIGEN_MAX];
        double square = 0;
        for (int i = 0; i < n; ++i)
        {
            u[i] = sin(1.0 + 2.3 * i + 0.7 * reflection) + 0.2;
            square += u[i] * u[i];
        }
        for (int row = 0; row < n; ++row)
        {
            double along = 0;
            for (int i = 0; i < n; ++i) along += q[row][i] * u[i];
            for (int i = 0; i < n; ++i) q[row][i] -= 2 * along * u[i] / square;
        }
    }
    for (int i = 0; i < n; ++i)
    {
        for (int j = 0; j < n; ++j)
        {
            a[i * n + j] = 0;
            for (int k = 0; k < n; ++k) a[i * n + j] += q[i][k] * values[k] * q[j][k];
        }
    }
}

static void a_single_number_is_its_own_eigenvalue(void **state)
{
    (void)state;
    double a = -3.5;
    assert_true(pls_largest_eigenvalue(&a, 1) == -3.5);
}

static void a_2x2_matrix_has_the_roots_of_its_quadratic(void **state)
{
    (void)state;
    // trace 3, determinant -2: (3 +- sqrt(17)) / 2
    const double a[4] = {1, 2, 2, 2};
    const double expected[2] = {(3 - sqrt(17.0)) / 2, (3 + sqrt(17.0)) / 2};
    expect_values(a, 2, expected, 8 * DBL_EPSILON);
}

static void a_diagonal_matrix_is_sorted(void **state)
{
    (void)state;
    const double a[9] = {5, 0, 0, 0, -7, 0, 0, 0, 2};
    const double expected[3] = {-7, 2, 5};
    expect_values(a, 3, expected, 0);
}

static void the_chain_of_springs_has_its_textbook_spectrum(void **state)
{
    (void)state;
    // fixed ends: 2 - 2 cos(k pi / (n + 1))
    for (int n = 1; n <= PLS_EIGEN_MAX; ++n)
    {
        double a[PLS_EIGEN_MAX * PLS_EIGEN_MAX] = {0};
        double expected[PLS_EIGEN_MAX];
        for (int i = 0; i < n; ++i)
        {
            a[i * n + i] = 2;
            if (i > 0) a[i * n + i - 1] = -1;
            if (i < n - 1) a[i * n + i + 1] = -1;
            expected[i] = 2 - 2 * cos((i + 1) * pi / (n + 1));
        }
        expect_values(a, n, expected, 32 * DBL_EPSILON);
    }
}

static void a_matrix_of_ones_has_one_eigenvalue_n_and_zeros(void **state)
{
    (void)state;
    for (int n = 1; n <= PLS_EIGEN_MAX; ++n)
    {
        double a[PLS_EIGEN_MAX * PLS_EIGEN_MAX];
        double expected[PLS_EIGEN_MAX] = {0};
        for (int i = 0; i < n * n; ++i) a[i] = 1;
        expected[n - 1] = n;
        expect_values(a, n, expected, 64 * DBL_EPSILON);
    }
}

static void multiple_negative_and_zero_eigenvalues_come_back_from_a_turned_matrix(void **state)
{
    (void)state;
    const double spectra[4][6] = {{1, 2, 3, 4, 5, 6}, {-6, -5, -4, -3, -2, -1}, {-1, 0, 0, 7, 7, 7}, {2, 2, 2, 2, 2, 2}};
    for (int k = 0; k < 4; ++k)
    {
        double a[36];
        with_spectrum(spectra[k], 6, a);
        expect_values(a, 6, spectra[k], 64 * DBL_EPSILON);
    }
}

static void very_large_and_very_small_matrices_keep_their_digits(void **state)
{
    (void)state;
    const double factor[4] = {1e300, 1e-300, 1e150, 1e-170};
    for (int k = 0; k < 4; ++k)
    {
        const double f = factor[k];
        const double a[4] = {2 * f, f, f, 2 * f};
        const double expected[2] = {f, 3 * f};
        expect_values(a, 2, expected, 8 * DBL_EPSILON * f);
    }
}

static void translation_and_rotation_of_very_different_stiffness_are_both_right(void **state)
{
    (void)state;
    const double spectrum[6] = {1, 2, 3, 1e9, 2e9, 3e9};
    double a[36];
    with_spectrum(spectrum, 6, a);
    expect_values(a, 6, spectrum, 64 * DBL_EPSILON * 3e9);
}

static void only_the_upper_triangle_is_read_and_the_matrix_is_left_alone(void **state)
{
    (void)state;
    const double a[4] = {2, 1, 99, 2};
    assert_true(fabs(pls_largest_eigenvalue(a, 2) - 3) <= 8 * DBL_EPSILON);
    assert_true(a[1] == 1 && a[2] == 99);
}

static void what_is_not_finite_or_not_of_a_served_order_gives_nan(void **state)
{
    (void)state;
    const double with_nan[4] = {1, NAN, NAN, 1};
    const double with_infinity[4] = {1, 0, 0, INFINITY};
    const double large[13 * 13] = {0};
    assert_true(isnan(pls_largest_eigenvalue(with_nan, 2)));
    assert_true(isnan(pls_largest_eigenvalue(with_infinity, 2)));
    assert_true(isnan(pls_largest_eigenvalue(large, 13)));
    assert_true(isnan(pls_largest_eigenvalue(large, 0)));
    double values[2] = {0, 0};
    pls_symmetric_eigenvalues(with_nan, 2, values);
    assert_true(isnan(values[0]) && isnan(values[1]));
    assert_true(pls_largest_eigenvalue(large, 12) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_single_number_is_its_own_eigenvalue),
        cmocka_unit_test(a_2x2_matrix_has_the_roots_of_its_quadratic),
        cmocka_unit_test(a_diagonal_matrix_is_sorted),
        cmocka_unit_test(the_chain_of_springs_has_its_textbook_spectrum),
        cmocka_unit_test(a_matrix_of_ones_has_one_eigenvalue_n_and_zeros),
        cmocka_unit_test(multiple_negative_and_zero_eigenvalues_come_back_from_a_turned_matrix),
        cmocka_unit_test(very_large_and_very_small_matrices_keep_their_digits),
        cmocka_unit_test(translation_and_rotation_of_very_different_stiffness_are_both_right),
        cmocka_unit_test(only_the_upper_triangle_is_read_and_the_matrix_is_left_alone),
        cmocka_unit_test(what_is_not_finite_or_not_of_a_served_order_gives_nan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
