// simd.h -- portable vectors with the same bits on every width.
//
// Files named *_simd.c are compiled once per instruction set (PLS_ISA = v2, v3, v4 for the x86-64 levels; generic elsewhere); PLS_SIMD(f) gives each copy of a
// function its own name and PLS_SIMD_SELECT picks one at run time. Lanes never mix: a contact or body is computed by the same IEEE operations in the same
// order on any width (no contraction, no approximate reciprocals, no sums across lanes), so the choice never changes a result (DESIGN contract 4).
#ifndef PLS_MATH_SIMD_H
#define PLS_MATH_SIMD_H

#include <math.h>
#include <stdint.h>

#define PLS_JOIN_(a, b) a##_##b
#define PLS_JOIN(a, b)  PLS_JOIN_(a, b)

#if defined(PLS_ISA)
#define PLS_SIMD(name) PLS_JOIN(name, PLS_ISA)
#endif

/// Instruction set in use: 0 = baseline, 1 = AVX2, 2 = AVX-512. The environment variable PARTICLS_ISA (v2, v3, v4) lowers it, for tests.
int pls_isa_level(void);
const char *pls_isa_name(void);

#if defined(PLS_ISA_ONLY_GENERIC)
#define PLS_SIMD_DECLARE(result, name, ...) result name##_generic(__VA_ARGS__)
#define PLS_SIMD_SELECT(name)               (name##_generic)
#else
#define PLS_SIMD_DECLARE(result, name, ...) \
    result name##_v2(__VA_ARGS__);          \
    result name##_v3(__VA_ARGS__);          \
    result name##_v4(__VA_ARGS__)
#define PLS_SIMD_SELECT(name) (pls_isa_level() == 2 ? name##_v4 : pls_isa_level() == 1 ? name##_v3 : name##_v2)
#endif

// ---- vectors of the width of the instruction set being compiled for --------------------------------------------------------------------------------

#if defined(PLS_ISA)

#if defined(__AVX512F__)
#define PLS_W 8
#elif defined(__AVX2__)
#define PLS_W 4
#else
#define PLS_W 2
#endif

#if PLS_W == 2 && defined(__SSE2__) && !defined(__FMA__)
#include "math/fma_emulated.h"
#endif

typedef double pls_vd __attribute__((vector_size(8 * PLS_W)));  ///< PLS_W doubles
typedef int64_t pls_vi __attribute__((vector_size(8 * PLS_W))); ///< masks and bit patterns of pls_vd
typedef double pls_v4 __attribute__((vector_size(32)));         ///< half a body row: three components and one more
typedef int64_t pls_v4i __attribute__((vector_size(32)));

static inline pls_vd pls_vd_load(const double *p) { return *(const pls_vd *)p; }
static inline void pls_vd_store(double *p, pls_vd a) { *(pls_vd *)p = a; }
static inline pls_v4 pls_v4_load(const double *p) { return *(const pls_v4 *)p; }
static inline void pls_v4_store(double *p, pls_v4 a) { *(pls_v4 *)p = a; }
/// In all lanes. `a - 0` is a for every a, so that compilers drop the difference; `0 + a` would have to be computed: it turns -0 into +0.
static inline pls_vd pls_vd_set(double a) { return a - (pls_vd){0}; }
static inline pls_v4 pls_v4_set(double a) { return (pls_v4){a, a, a, a}; }
/// mask ? a : b, mask all ones or all zeros per lane.
static inline pls_vd pls_vd_pick(pls_vi mask, pls_vd a, pls_vd b) { return (pls_vd)((mask & (pls_vi)a) | (~mask & (pls_vi)b)); }
static inline pls_v4 pls_v4_pick(pls_v4i mask, pls_v4 a, pls_v4 b) { return (pls_v4)((mask & (pls_v4i)a) | (~mask & (pls_v4i)b)); }

#if defined(__AVX512F__)
#include <immintrin.h>
static inline pls_vd pls_vd_sqrt(pls_vd a) { return (pls_vd)_mm512_sqrt_pd((__m512d)a); }
/// Bit k set where lane k of a is smaller than lane k of b.
static inline unsigned pls_vd_less(pls_vd a, pls_vd b) { return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ); }
#elif defined(__AVX2__)
#include <immintrin.h>
static inline pls_vd pls_vd_sqrt(pls_vd a) { return (pls_vd)_mm256_sqrt_pd((__m256d)a); }
static inline unsigned pls_vd_less(pls_vd a, pls_vd b)
{
    return (unsigned)_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LT_OQ));
}
#elif defined(__SSE2__)
#include <emmintrin.h>
static inline pls_vd pls_vd_sqrt(pls_vd a) { return (pls_vd)_mm_sqrt_pd((__m128d)a); }
static inline unsigned pls_vd_less(pls_vd a, pls_vd b) { return (unsigned)_mm_movemask_pd(_mm_cmplt_pd((__m128d)a, (__m128d)b)); }
#else
static inline pls_vd pls_vd_sqrt(pls_vd a)
{
    for (int k = 0; k < PLS_W; ++k) a[k] = sqrt(a[k]);
    return a;
}
static inline unsigned pls_vd_less(pls_vd a, pls_vd b)
{
    unsigned bits = 0;
    for (int k = 0; k < PLS_W; ++k) bits |= (unsigned)(a[k] < b[k]) << k;
    return bits;
}
#endif

/// a b + c, rounded once. Asked for by name, since compilers that contract as they please give other bits on each instruction set. Processors without such an
/// instruction (x86-64-v2) emulate it: the same bits, slowly.
static inline pls_vd pls_vd_fma(pls_vd a, pls_vd b, pls_vd c)
{
#if defined(__AVX512F__)
    return (pls_vd)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined(__AVX2__)
    return (pls_vd)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#elif defined(__SSE2__) && !defined(__FMA__)
    return pls_fma_emulated(a, b, c);
#else
    pls_vd out = c;
    for (int k = 0; k < PLS_W; ++k) out[k] = fma(a[k], b[k], c[k]);
    return out;
#endif
}
/// c - a b, rounded once.
static inline pls_vd pls_vd_less_product(pls_vd a, pls_vd b, pls_vd c) { return pls_vd_fma(-a, b, c); }
/// a b - c, rounded once.
static inline pls_vd pls_vd_product_less(pls_vd a, pls_vd b, pls_vd c) { return pls_vd_fma(a, b, -c); }

/// x . y of three columns each.
static inline __attribute__((always_inline)) pls_vd pls_vd_dot(const pls_vd x[3], const pls_vd y[3])
{
    return pls_vd_fma(x[2], y[2], pls_vd_fma(x[1], y[1], x[0] * y[0]));
}
/// (y cross z) + c, component a of three columns each.
static inline __attribute__((always_inline)) pls_vd pls_vd_cross_plus(const pls_vd y[3], const pls_vd z[3], int a, pls_vd c)
{
    const int b = (a + 1) % 3, d = (a + 2) % 3;
    return pls_vd_fma(y[b], z[d], pls_vd_less_product(y[d], z[b], c));
}
/// y cross z, component a.
static inline __attribute__((always_inline)) pls_vd pls_vd_cross(const pls_vd y[3], const pls_vd z[3], int a)
{
    const int b = (a + 1) % 3, d = (a + 2) % 3;
    return pls_vd_product_less(y[b], z[d], y[d] * z[b]);
}

/// a > b ? a : b
static inline pls_vd pls_vd_max(pls_vd a, pls_vd b)
{
#if defined(__AVX512F__)
    return (pls_vd)_mm512_max_pd((__m512d)a, (__m512d)b);
#elif defined(__AVX2__)
    return (pls_vd)_mm256_max_pd((__m256d)a, (__m256d)b);
#elif defined(__SSE2__)
    return (pls_vd)_mm_max_pd((__m128d)a, (__m128d)b);
#else
    return pls_vd_pick((pls_vi)(a > b), a, b);
#endif
}

/// a < b ? a : b
static inline pls_vd pls_vd_min(pls_vd a, pls_vd b)
{
#if defined(__AVX512F__)
    return (pls_vd)_mm512_min_pd((__m512d)a, (__m512d)b);
#elif defined(__AVX2__)
    return (pls_vd)_mm256_min_pd((__m256d)a, (__m256d)b);
#elif defined(__SSE2__)
    return (pls_vd)_mm_min_pd((__m128d)a, (__m128d)b);
#else
    return pls_vd_pick((pls_vi)(a < b), a, b);
#endif
}

/// Which lanes: bits of a mask register, or lanes all ones or all zeros.
#if defined(__AVX512F__)
typedef __mmask8 pls_vm;
#else
typedef pls_vi pls_vm;
#endif

/// Lanes where a is smaller than b.
static inline pls_vm pls_vm_less(pls_vd a, pls_vd b)
{
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
#else
    return (pls_vm)(a < b);
#endif
}

/// Lane k where bit k is set.
static inline pls_vm pls_vm_of(unsigned bits)
{
#if defined(__AVX512F__)
    return (pls_vm)bits;
#elif PLS_W == 4
    const pls_vi lane = {1, 2, 4, 8};
    return (pls_vm)((((pls_vi){0} + (int64_t)bits) & lane) == lane);
#else
    const pls_vi lane = {1, 2};
    return (pls_vm)((((pls_vi){0} + (int64_t)bits) & lane) == lane);
#endif
}

/// a in the lanes of m, b in the others.
static inline pls_vd pls_vd_choose(pls_vm m, pls_vd a, pls_vd b)
{
#if defined(__AVX512F__)
    return (pls_vd)_mm512_mask_blend_pd(m, (__m512d)b, (__m512d)a);
#elif defined(__AVX2__)
    return (pls_vd)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)m);
#else
    return pls_vd_pick(m, a, b);
#endif
}

/// Store the lanes of m, leave the others.
static inline void pls_vd_store_where(pls_vm m, double *p, pls_vd a)
{
#if defined(__AVX512F__)
    _mm512_mask_store_pd(p, m, (__m512d)a);
#else
    pls_vd_store(p, pls_vd_choose(m, a, pls_vd_load(p)));
#endif
}

// ---- rows of eight doubles, a cache line: one register, or two halves (compilers keep vectors wider than registers in memory) -------------------------

#if PLS_W == 8
typedef double pls_row __attribute__((vector_size(64)));
typedef int64_t pls_rowi_ __attribute__((vector_size(64)));
typedef float pls_rowf_ __attribute__((vector_size(32)));
static inline pls_row pls_row_join(pls_v4 low, pls_v4 high) { return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7); }
static inline pls_row pls_row_load(const double *p) { return *(const pls_row *)p; }
static inline void pls_row_store(double *p, pls_row a) { *(pls_row *)p = a; }
static inline pls_row pls_row_add(pls_row a, pls_row b) { return a + b; }
static inline pls_row pls_row_subtract(pls_row a, pls_row b) { return a - b; }
static inline pls_row pls_row_scale(pls_row a, pls_v4 low, pls_v4 high) { return a * pls_row_join(low, high); }
/// Bits of a that are set in the mask are flipped.
static inline pls_row pls_row_flip(pls_row a, pls_v4i low, pls_v4i high)
{
    return (pls_row)((pls_rowi_)a ^ __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7));
}
/// mask ? a : b
static inline pls_row pls_row_pick(pls_v4i low, pls_v4i high, pls_row a, pls_row b)
{
    pls_rowi_ mask = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    return (pls_row)(((pls_rowi_)a & mask) | ((pls_rowi_)b & ~mask));
}
static inline pls_row pls_row_of_floats(const float *p) { return __builtin_convertvector(*(const pls_rowf_ *)p, pls_row); }
static inline void pls_row_to_floats(float *p, pls_row a) { *(pls_rowf_ *)p = __builtin_convertvector(a, pls_rowf_); }
#else
typedef struct pls_row
{
    pls_v4 low, high;
} pls_row;
typedef float pls_rowf_ __attribute__((vector_size(16)));
static inline pls_row pls_row_join(pls_v4 low, pls_v4 high) { return (pls_row){low, high}; }
static inline pls_row pls_row_load(const double *p) { return (pls_row){pls_v4_load(p), pls_v4_load(p + 4)}; }
static inline void pls_row_store(double *p, pls_row a)
{
    pls_v4_store(p, a.low);
    pls_v4_store(p + 4, a.high);
}
static inline pls_row pls_row_add(pls_row a, pls_row b) { return (pls_row){a.low + b.low, a.high + b.high}; }
static inline pls_row pls_row_subtract(pls_row a, pls_row b) { return (pls_row){a.low - b.low, a.high - b.high}; }
static inline pls_row pls_row_scale(pls_row a, pls_v4 low, pls_v4 high) { return (pls_row){a.low * low, a.high * high}; }
static inline pls_row pls_row_flip(pls_row a, pls_v4i low, pls_v4i high)
{
    return (pls_row){(pls_v4)((pls_v4i)a.low ^ low), (pls_v4)((pls_v4i)a.high ^ high)};
}
static inline pls_row pls_row_pick(pls_v4i low, pls_v4i high, pls_row a, pls_row b)
{
    return (pls_row){pls_v4_pick(low, a.low, b.low), pls_v4_pick(high, a.high, b.high)};
}
static inline pls_row pls_row_of_floats(const float *p)
{
    return (pls_row){__builtin_convertvector(*(const pls_rowf_ *)p, pls_v4), __builtin_convertvector(*(const pls_rowf_ *)(p + 4), pls_v4)};
}
static inline void pls_row_to_floats(float *p, pls_row a)
{
    *(pls_rowf_ *)p = __builtin_convertvector(a.low, pls_rowf_);
    *(pls_rowf_ *)(p + 4) = __builtin_convertvector(a.high, pls_rowf_);
}
#endif

// Transposes. Rows are eight (or four) doubles in memory, one per contact; columns are vectors over PLS_W contacts.

#if PLS_W == 8
// Pairs of rows are interleaved, then quarters of vectors picked twice: instructions that every processor has fast (general permutations are not).
static inline pls_vd pls_even_quarters_(pls_vd a, pls_vd b) { return __builtin_shufflevector(a, b, 0, 1, 4, 5, 8, 9, 12, 13); }
static inline pls_vd pls_odd_quarters_(pls_vd a, pls_vd b) { return __builtin_shufflevector(a, b, 2, 3, 6, 7, 10, 11, 14, 15); }

static inline __attribute__((always_inline)) void pls_transpose8_(pls_vd r[8])
{
    pls_vd a[8], b[8];
    for (int k = 0; k < 4; ++k)
    {
        a[k] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        a[4 + k] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (int k = 0; k < 4; ++k)
    {
        b[2 * k] = pls_even_quarters_(a[2 * k], a[2 * k + 1]);
        b[2 * k + 1] = pls_odd_quarters_(a[2 * k], a[2 * k + 1]);
    }
    for (int odd = 0; odd < 2; ++odd)
        for (int c = 0; c < 2; ++c)
        {
            r[2 * c + odd] = pls_even_quarters_(b[4 * odd + c], b[4 * odd + 2 + c]);
            r[4 + 2 * c + odd] = pls_odd_quarters_(b[4 * odd + c], b[4 * odd + 2 + c]);
        }
}
#endif

/// 4 x 4 transpose of four rows of four.
static inline void pls_transpose4_(pls_v4 r[4])
{
    pls_v4 a = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), b = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
    pls_v4 c = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), d = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    r[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    r[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    r[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/// PLS_W rows of four (in registers) to four columns.
static inline __attribute__((always_inline)) void pls_columns4(const pls_v4 *row, pls_vd column[4])
{
#if PLS_W == 8
    pls_vd p[4];
    for (int k = 0; k < 4; ++k) p[k] = __builtin_shufflevector(row[k], row[k + 4], 0, 1, 2, 3, 4, 5, 6, 7);
    pls_vd a = __builtin_shufflevector(p[0], p[1], 0, 8, 2, 10, 4, 12, 6, 14),
           b = __builtin_shufflevector(p[0], p[1], 1, 9, 3, 11, 5, 13, 7, 15);
    pls_vd c = __builtin_shufflevector(p[2], p[3], 0, 8, 2, 10, 4, 12, 6, 14),
           d = __builtin_shufflevector(p[2], p[3], 1, 9, 3, 11, 5, 13, 7, 15);
    column[0] = __builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13);
    column[1] = __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13);
    column[2] = __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15);
    column[3] = __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15);
#elif PLS_W == 4
    pls_v4 t[4] = {row[0], row[1], row[2], row[3]};
    pls_transpose4_(t);
    for (int k = 0; k < 4; ++k) column[k] = (pls_vd)t[k];
#else
    for (int k = 0; k < 4; ++k) column[k] = (pls_vd){row[0][k], row[1][k]};
#endif
}

/// Four columns to PLS_W rows of four, row k stored at `row[k]` for k < count.
static inline __attribute__((always_inline)) void pls_rows4(const pls_vd column[4], double *const *row, int count)
{
#if PLS_W == 8
    pls_vd a = __builtin_shufflevector(column[0], column[1], 0, 8, 2, 10, 4, 12, 6, 14);
    pls_vd b = __builtin_shufflevector(column[0], column[1], 1, 9, 3, 11, 5, 13, 7, 15);
    pls_vd c = __builtin_shufflevector(column[2], column[3], 0, 8, 2, 10, 4, 12, 6, 14);
    pls_vd d = __builtin_shufflevector(column[2], column[3], 1, 9, 3, 11, 5, 13, 7, 15);
    pls_vd p[4] = {__builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13), __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13),
                   __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15), __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15)};
    if (count == PLS_W)
    {
#pragma GCC unroll 4
        for (int k = 0; k < 4; ++k)
        {
            pls_v4_store(row[k], __builtin_shufflevector(p[k], p[k], 0, 1, 2, 3));
            pls_v4_store(row[k + 4], __builtin_shufflevector(p[k], p[k], 4, 5, 6, 7));
        }
        return;
    }
    for (int k = 0; k < 4 && k < count; ++k) pls_v4_store(row[k], __builtin_shufflevector(p[k], p[k], 0, 1, 2, 3));
    for (int k = 4; k < count; ++k) pls_v4_store(row[k], __builtin_shufflevector(p[k - 4], p[k - 4], 4, 5, 6, 7));
#elif PLS_W == 4
    pls_v4 t[4] = {(pls_v4)column[0], (pls_v4)column[1], (pls_v4)column[2], (pls_v4)column[3]};
    pls_transpose4_(t);
    for (int k = 0; k < count; ++k) pls_v4_store(row[k], t[k]);
#else
    for (int k = 0; k < count; ++k) pls_v4_store(row[k], (pls_v4){column[0][k], column[1][k], column[2][k], column[3][k]});
#endif
}

/// PLS_W rows of eight to eight columns.
static inline __attribute__((always_inline)) void pls_columns8(const pls_row *row, pls_vd column[8])
{
#if PLS_W == 8
    for (int k = 0; k < 8; ++k) column[k] = row[k];
    pls_transpose8_(column);
#else
    pls_v4 low[PLS_W], high[PLS_W];
    for (int k = 0; k < PLS_W; ++k) low[k] = row[k].low, high[k] = row[k].high;
    pls_columns4(low, column);
    pls_columns4(high, column + 4);
#endif
}

/// The fourth and the eighth column of PLS_W rows of eight.
static inline __attribute__((always_inline)) void pls_last_columns(const pls_row *row, pls_vd *fourth, pls_vd *eighth)
{
#if PLS_W == 8
    pls_vd a[4];
    for (int k = 0; k < 4; ++k) a[k] = __builtin_shufflevector(row[2 * k], row[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    const pls_vd low = pls_odd_quarters_(a[0], a[1]), high = pls_odd_quarters_(a[2], a[3]);
    *fourth = pls_even_quarters_(low, high);
    *eighth = pls_odd_quarters_(low, high);
#else
    for (int k = 0; k < PLS_W; ++k) (*fourth)[k] = row[k].low[3], (*eighth)[k] = row[k].high[3];
#endif
}

/// Eight columns to PLS_W rows of eight, row k stored at `row[k]` for k < count.
static inline __attribute__((always_inline)) void pls_rows8(const pls_vd column[8], double *const *row, int count)
{
#if PLS_W == 8
    pls_vd t[8];
    for (int k = 0; k < 8; ++k) t[k] = column[k];
    pls_transpose8_(t);
    if (count == PLS_W)
    {
#pragma GCC unroll 8
        for (int k = 0; k < PLS_W; ++k) pls_vd_store(row[k], t[k]);
        return;
    }
    for (int k = 0; k < count; ++k) pls_vd_store(row[k], t[k]);
#else
    double *high[PLS_W];
    for (int k = 0; k < PLS_W; ++k) high[k] = row[k] + 4;
    pls_rows4(column, row, count);
    pls_rows4(column + 4, high, count);
#endif
}

#endif // PLS_ISA
#endif
