// stretch.h -- a vector of bonds as their points lie now. For files that are compiled per instruction set.
//
// Rows of partners are loaded whole, 32 bytes each, and transposed; points lie along a space-filling curve, so that most rows are in the near caches.
#ifndef PLS_BOND_STRETCH_H
#define PLS_BOND_STRETCH_H

#include "bond/bond_set.h"

/// The partners' rows less the point's, and how long bonds are.
typedef struct pls_stretch
{
    pls_vd d[3], a, square, length, xi;
} pls_stretch;

static inline __attribute__((always_inline)) void pls_stretch_point(const pls_bond_set *set, size_t point, pls_vd x[3])
{
    for (int c = 0; c < 3; ++c) x[c] = pls_vd_set(set->row[point][c]);
}

/// Of the bonds from `slot` on, of a point at x.
static inline __attribute__((always_inline)) pls_stretch pls_stretch_now(const pls_bond_set *set, size_t slot, const pls_vd x[3])
{
    const uint32_t *partner = set->family.partner + slot;
    pls_v4 row[PLS_W];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane) row[lane] = pls_v4_load(set->row[partner[lane]]);
    pls_vd column[4];
    pls_columns4(row, column);
    pls_stretch b = {.a = column[3], .xi = pls_vd_load(set->family.length + slot)};
    for (int c = 0; c < 3; ++c) b.d[c] = column[c] - x[c];
    b.square = b.d[0] * b.d[0] + b.d[1] * b.d[1] + b.d[2] * b.d[2];
    b.length = pls_vd_sqrt(b.square);
    return b;
}

#endif
