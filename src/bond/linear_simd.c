// linear_simd.c -- the two loops over families, eight bonds at a time (bond_set.h says what they compute).
//
// Rows of partners are loaded whole, 32 bytes each, and transposed; points lie along a space-filling curve, so that most rows are in the near caches. Extensions are computed in both loops:
// storing them would cost more than the root. Eight sums run side by side on any width and are added up in one order.

#include "bond/bond_set.h"
#include "bond/lanes.h"

#include <float.h>

enum {
    PARTS = PLS_BOND_VECTOR / PLS_W,
    AHEAD = 256 ///< bonds by which streams are fetched ahead: the processor's own fetching stops at each page of four kilobytes
};

/// Streams pass once per loop, from memory, and should not push rows out of the caches. (What is fetched need not be there.)
static inline __attribute__((always_inline)) void fetch_streams(const pls_bond_set *set, size_t slot, int share)
{
    __builtin_prefetch(set->family.length + slot + AHEAD, 0, 0);
    __builtin_prefetch(set->weight + slot + AHEAD, 0, 0);
    if (slot % 16 == 0) __builtin_prefetch(set->family.partner + slot + AHEAD, 0, 0);
    if (share && slot % 16 == 0) __builtin_prefetch(set->share + slot + AHEAD, 0, 0);
}

typedef float floats __attribute__((vector_size(4 * PLS_W), aligned(4)));

/// A vector of bonds: the partners' rows less the point's, and how long they are.
typedef struct bonds
{
    pls_vd d[3], a, square, length, xi;
} bonds;

static inline __attribute__((always_inline)) bonds load(const pls_bond_set *set, size_t slot, const pls_vd x[3])
{
    const uint32_t *partner = set->family.partner + slot;
    pls_v4 row[PLS_W];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane) row[lane] = pls_v4_load(set->row[partner[lane]]);
    pls_vd column[4];
    pls_columns4(row, column);
    bonds b = {.a = column[3], .xi = pls_vd_load(set->family.length + slot)};
    for (int c = 0; c < 3; ++c) b.d[c] = column[c] - x[c];
    b.square = b.d[0] * b.d[0] + b.d[1] * b.d[1] + b.d[2] * b.d[2];
    b.length = pls_vd_sqrt(b.square);
    return b;
}

static inline __attribute__((always_inline)) void place_of(const pls_bond_set *set, size_t point, pls_vd x[3])
{
    for (int c = 0; c < 3; ++c) x[c] = pls_vd_set(set->row[point][c]);
}

void PLS_SIMD(pls_bond_dilate)(pls_bond_set *set, size_t first, size_t last)
{
    const uint32_t *start = set->family.start;
    for (size_t p = first; p < last; ++p)
    {
        pls_vd x[3], sum[PARTS] = {0};
        place_of(set, p, x);
        for (size_t slot = (size_t)start[p] * PLS_BOND_VECTOR; slot < (size_t)start[p + 1] * PLS_BOND_VECTOR; slot += PLS_BOND_VECTOR)
        {
            fetch_streams(set, slot, 0);
#pragma GCC unroll 4
            for (size_t k = 0; k < PARTS; ++k)
            {
                const bonds b = load(set, slot + k * PLS_W, x);
                sum[k] = sum[k] + pls_vd_load(set->weight + slot + k * PLS_W) * (b.length - b.xi);
            }
        }
        set->spread[p] = set->dilation[p] * pls_lanes_sum(sum); // rows are being read by other threads
    }
}

bool PLS_SIMD(pls_bond_act)(pls_bond_set *set, size_t first, size_t last)
{
    const uint32_t *start = set->family.start;
    const double stretch = set->stretch, twice = set->twice;
    bool any = false;
    for (size_t p = first; p < last; ++p)
    {
        pls_vd x[3], sum[3][PARTS] = {0}, a = pls_vd_set(set->row[p][3]);
        unsigned overlong = 0;
        place_of(set, p, x);
        for (size_t slot = (size_t)start[p] * PLS_BOND_VECTOR; slot < (size_t)start[p + 1] * PLS_BOND_VECTOR; slot += PLS_BOND_VECTOR)
        {
            fetch_streams(set, slot, 1);
#pragma GCC unroll 4
            for (size_t k = 0; k < PARTS; ++k)
            {
                const size_t at = slot + k * PLS_W;
                const bonds b = load(set, at, x);
                const pls_vd e = b.length - b.xi, share = __builtin_convertvector(*(const floats *)(set->share + at), pls_vd);
                // 1/(xi l) as l/(xi l^2), so that the division need not wait for the root; points of a broken bond may coincide.
                const pls_vd factor = pls_vd_load(set->weight + at) * ((a + b.a) * b.xi + (twice * e) * share) *
                                      (b.length * (1.0 / (b.xi * b.square + DBL_MIN)));
                overlong |= pls_vd_less(stretch * b.xi, e);
                for (int c = 0; c < 3; ++c) sum[c][k] = sum[c][k] + factor * b.d[c];
            }
        }
        for (int c = 0; c < 3; ++c) set->force[p][c] = pls_lanes_sum(sum[c]);
        if (overlong) set->overlong[p] = 1, any = true;
    }
    return any;
}
