// fma_emulated.h -- a b + c rounded once, for processors without such an instruction (x86-64 before 2013): the same bits as theirs.
//
// S. Boldo and G. Melquiond, "Emulation of FMA and correctly rounded sums: proved algorithms using rounding to odd", IEEE Trans. Computers 57 (2008) 462. The
// product is split exactly into p + low, and c + p + low is summed exactly but for the last digits, which are rounded to odd so that the last addition rounds as if
// it saw them all. Some 50 operations on two lanes; the C library's takes several times as long where it has to emulate too. Where the proof does not reach (numbers
// so large or products so small that splitting them is not exact, infinities, NaN) the C library is asked.
#ifndef PLS_MATH_FMA_EMULATED_H
#define PLS_MATH_FMA_EMULATED_H

#include <math.h>
#include <stdint.h>

typedef double pls_pair_ __attribute__((vector_size(16)));
typedef int64_t pls_pairi_ __attribute__((vector_size(16)));

static inline pls_pair_ pls_pair_set_(double a) { return (pls_pair_){a, a}; }
static inline pls_pairi_ pls_pair_size_(pls_pair_ a) { return (pls_pairi_)a & (pls_pairi_){INT64_MAX, INT64_MAX}; }

/// a + b = sum + rest, exactly (Knuth).
static inline pls_pair_ pls_sum_exactly_(pls_pair_ a, pls_pair_ b, pls_pair_ *rest)
{
    const pls_pair_ sum = a + b, there = sum - a;
    *rest = (a - (sum - there)) + (b - there);
    return sum;
}

/// a b = product + rest, exactly (Dekker, with Veltkamp's split).
static inline pls_pair_ pls_multiply_exactly_(pls_pair_ a, pls_pair_ b, pls_pair_ *rest)
{
    const pls_pair_ product = a * b, split = pls_pair_set_(134217729.0), ca = split * a, cb = split * b; // 2^27 + 1
    const pls_pair_ a_high = ca - (ca - a), b_high = cb - (cb - b), a_low = a - a_high, b_low = b - b_high;
    *rest = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    return product;
}

/// a + b, an inexact sum rounded to the neighbour whose last digit is odd.
static inline pls_pair_ pls_sum_to_odd_(pls_pair_ a, pls_pair_ b)
{
    pls_pair_ rest, sum = pls_sum_exactly_(a, b, &rest);
    const pls_pairi_ bits = (pls_pairi_)sum, one = {1, 1};
    const pls_pairi_ inexact = (pls_pairi_)(rest != 0.0), even = (pls_pairi_)((bits & one) == 0);
    const pls_pairi_ outward = (pls_pairi_)(((pls_pairi_)rest ^ bits) >= 0); // the true sum lies away from zero
    const pls_pairi_ step = (outward & one) | (~outward & -one);
    return (pls_pair_)(bits + (inexact & even & step));
}

static __attribute__((noinline, unused)) pls_pair_ pls_fma_emulated(pls_pair_ a, pls_pair_ b, pls_pair_ c)
{
    pls_pair_ low, left, rest, product = pls_multiply_exactly_(a, b, &low);
    // 2^-900 < |a b| or a b = 0 exactly, and all below 2^400.
    const pls_pairi_ most = (pls_pairi_)pls_pair_set_(0x1p400), least = (pls_pairi_)pls_pair_set_(0x1p-900);
    const pls_pairi_ zero = (pls_pairi_)(a == 0.0) | (pls_pairi_)(b == 0.0);
    const pls_pairi_ fits = (pls_pairi_)(pls_pair_size_(a) < most) & (pls_pairi_)(pls_pair_size_(b) < most) &
                            (pls_pairi_)(pls_pair_size_(c) < most) & (zero | (pls_pairi_)(pls_pair_size_(product) > least));
    if (!(fits[0] & fits[1])) return (pls_pair_){fma(a[0], b[0], c[0]), fma(a[1], b[1], c[1])};
    const pls_pair_ upper = pls_sum_exactly_(c, low, &left), high = pls_sum_exactly_(product, upper, &rest);
    const pls_pair_ result = high + pls_sum_to_odd_(left, rest);
    const pls_pairi_ gone = (pls_pairi_)(result == 0.0); // then the product was exact, and this zero has the right sign
    return (pls_pair_)((gone & (pls_pairi_)(product + c)) | (~gone & (pls_pairi_)result));
}

#endif
