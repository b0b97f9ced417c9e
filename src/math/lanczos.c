// lanczos.c -- Lanczos iteration (Golub & Van Loan, Matrix Computations, section 10.1), without reorthogonalisation: what that costs is copies of eigenvalues
// that have converged, which do no harm to the largest.

#include "math/lanczos.h"

#include "base/alloc.h"
#include "base/parallel.h"

#include <math.h>
#include <stdbool.h>

enum { LEAST = 8, MOST = 60 };
static const double slow_growth = 5e-4; ///< relative growth of the eigenvalue in an iteration at which it stops

/// Is no eigenvalue of the tridiagonal matrix larger than x? Signs of the pivots of x - T.
static bool bounded_by(const double *diagonal, const double *beside, int n, double x)
{
    double pivot = x - diagonal[0];
    for (int k = 1; k < n && pivot > 0.0; ++k) pivot = x - diagonal[k] - beside[k - 1] * beside[k - 1] / pivot;
    return pivot > 0.0;
}

static double largest_of_tridiagonal(const double *diagonal, const double *beside, int n)
{
    double low = diagonal[0], high = diagonal[0];
    for (int k = 0; k < n; ++k)
    {
        double reach = (k > 0 ? fabs(beside[k - 1]) : 0.0) + (k + 1 < n ? fabs(beside[k]) : 0.0); // Gershgorin
        low = fmax(low, diagonal[k]), high = fmax(high, diagonal[k] + reach);
    }
    for (int halving = 0; halving < 100 && high - low > 1e-10 * fabs(high); ++halving)
    {
        double middle = 0.5 * (low + high);
        if (bounded_by(diagonal, beside, n, middle))
            high = middle;
        else
            low = middle;
    }
    return high;
}

/// By blocks, for accuracy.
static double product(const double *x, const double *y, size_t count)
{
    double total = 0.0;
    for (size_t b = 0; b < pls_block_count(count, PLS_BLOCK); ++b)
    {
        double sum = 0.0;
        for (size_t k = b * PLS_BLOCK; k < pls_block_end(b, PLS_BLOCK, count); ++k) sum += x[k] * y[k];
        total += sum;
    }
    return total;
}

/// y += s x
static void add_scaled(double *y, double s, const double *x, size_t count)
{
    for (size_t k = 0; k < count; ++k) y[k] += s * x[k];
}

static void scale(double *x, double s, size_t count)
{
    for (size_t k = 0; k < count; ++k) x[k] *= s;
}

pls_status pls_lanczos_largest(pls_operator *multiply, const void *context, size_t count, double *start, double *out)
{
    double *now = start, *before = NULL, *next = NULL, diagonal[MOST], beside[MOST];
    *out = 0.0;
    double length = sqrt(product(now, now, count));
    if (length == 0.0) return PLS_OK;
    pls_status status = pls_allocate(&before, count, sizeof *before, "Lanczos vectors"); // zeros
    if (status == PLS_OK) status = pls_allocate(&next, count, sizeof *next, "Lanczos vectors");
    double *mine[2] = {before, next};
    if (status == PLS_OK) scale(now, 1.0 / length, count);
    for (int k = 0; status == PLS_OK && k < MOST; ++k)
    {
        multiply(context, now, next);
        diagonal[k] = product(now, next, count);
        if (k > 0) add_scaled(next, -beside[k - 1], before, count);
        add_scaled(next, -diagonal[k], now, count);
        beside[k] = sqrt(product(next, next, count));
        double last = *out;
        *out = isfinite(diagonal[k]) && isfinite(beside[k]) ? largest_of_tridiagonal(diagonal, beside, k + 1) : NAN;
        bool settled = k + 1 >= LEAST && *out - last < slow_growth * fabs(*out);
        if (!(beside[k] > 1e-12 * fabs(*out)) || settled) break; // also: an invariant subspace is exhausted, or NaN
        scale(next, 1.0 / beside[k], count);
        double *spare = before;
        before = now, now = next, next = spare;
    }
    pls_release(&mine[0]);
    pls_release(&mine[1]);
    return status;
}
