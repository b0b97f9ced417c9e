// lanes.h -- eight sums side by side, added up in an order that no width of vectors changes. For files that are compiled per instruction set.
#ifndef PLS_BOND_LANES_H
#define PLS_BOND_LANES_H

#include "bond/families.h"
#include "math/simd.h"

static inline __attribute__((always_inline)) double pls_lanes_sum(const pls_vd part[PLS_BOND_VECTOR / PLS_W])
{
    double lane[PLS_BOND_VECTOR] __attribute__((aligned(64)));
    for (int k = 0; k < PLS_BOND_VECTOR / PLS_W; ++k) pls_vd_store(lane + k * PLS_W, part[k]);
    return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

#endif
