// eigen6.c -- cyclic Jacobi rotations (Golub & Van Loan, Matrix Computations, section 8.5).
//
// Jacobi because it is short, needs no special cases (multiple, zero or negative eigenvalues), converges quadratically and takes the same
// path for the same input. At n = 6 some five sweeps of fifteen rotations do.

#include "math/eigen6.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

/// More sweeps than any matrix of this size needs (about 3 to 7); a bound so that the loop ends whatever happens.
enum { MAX_SWEEPS = 40 };

typedef double matrix[PLS_EIGEN_MAX][PLS_EIGEN_MAX];

/// Copy both triangles from the upper one, divided by the largest entry, so that squares can neither overflow nor vanish.
/// Returns that entry, NaN if one is not finite.
static double copy_scaled(const double *a, int n, matrix m)
{
    double largest = 0;
    for (int i = 0; i < n; ++i)
    {
        for (int j = i; j < n; ++j)
        {
            double value = a[i * n + j];
            if (!isfinite(value)) return NAN;
            largest = fmax(largest, fabs(value));
        }
    }
    for (int i = 0; i < n; ++i)
    {
        for (int j = i; j < n; ++j) m[i][j] = m[j][i] = largest > 0 ? a[i * n + j] / largest : 0;
    }
    return largest;
}

/// Turn the p-q plane so that m[p][q] becomes zero.
static void rotate(matrix m, int n, int p, int q)
{
    double off = m[p][q];
    if (off == 0) return;
    double theta = (m[q][q] - m[p][p]) / (2 * off);
    double t =
        copysign(1, theta) / (fabs(theta) + hypot(theta, 1)); // the smaller root of t^2 + 2 t theta = 1: the turn is at most 45 degrees
    double c = 1 / sqrt(t * t + 1);
    double s = t * c;
    m[p][p] -= t * off;
    m[q][q] += t * off;
    m[p][q] = m[q][p] = 0;
    for (int k = 0; k < n; ++k)
    {
        if (k == p || k == q) continue;
        double kp = m[k][p];
        double kq = m[k][q];
        m[k][p] = m[p][k] = c * kp - s * kq;
        m[k][q] = m[q][k] = s * kp + c * kq;
    }
}

/// The largest entry of `m` is 1 at the start, so entries below round-off / n cannot move an eigenvalue by more than round-off.
static bool is_diagonal(matrix m, int n)
{
    double sum = 0;
    for (int i = 0; i < n; ++i)
    {
        for (int j = i + 1; j < n; ++j) sum += fabs(m[i][j]);
    }
    return sum <= DBL_EPSILON / PLS_EIGEN_MAX;
}

static void sort_ascending(double *values, int n)
{
    for (int i = 1; i < n; ++i)
    {
        double value = values[i];
        int k = i;
        for (; k > 0 && values[k - 1] > value; --k) values[k] = values[k - 1];
        values[k] = value;
    }
}

void pls_symmetric_eigenvalues(const double *a, int n, double *values)
{
    if (n < 1 || n > PLS_EIGEN_MAX)
    {
        values[0] = NAN;
        return;
    }
    matrix m;
    double scale = copy_scaled(a, n, m);
    if (isnan(scale))
    {
        for (int i = 0; i < n; ++i) values[i] = NAN;
        return;
    }
    for (int sweep = 0; sweep < MAX_SWEEPS && !is_diagonal(m, n); ++sweep)
    {
        for (int p = 0; p < n; ++p)
        {
            for (int q = p + 1; q < n; ++q) rotate(m, n, p, q);
        }
    }
    for (int i = 0; i < n; ++i) values[i] = scale * m[i][i];
    sort_ascending(values, n);
}

double pls_largest_eigenvalue(const double *a, int n)
{
    double values[PLS_EIGEN_MAX];
    pls_symmetric_eigenvalues(a, n, values);
    return n >= 1 && n <= PLS_EIGEN_MAX ? values[n - 1] : NAN;
}
