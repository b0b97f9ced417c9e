// family_sums.h -- sums over a family as its law sees it, the same bits on any width of vectors. For files that are compiled per instruction set.
#ifndef PLS_BOND_FAMILY_SUMS_H
#define PLS_BOND_FAMILY_SUMS_H

#include "bond/lanes.h"

#include <particls/bond.h>

enum { PLS_FAMILY_PARTS = PLS_BOND_VECTOR / PLS_W };

/// theta = d / (m V) sum g e
static inline __attribute__((always_inline)) double pls_family_dilatation(const pls_family_batch *b)
{
    pls_vd sum[PLS_FAMILY_PARTS] = {0};
    for (size_t k = 0; k < b->count; k += PLS_BOND_VECTOR)
        for (size_t part = 0; part < PLS_FAMILY_PARTS; ++part)
        {
            const size_t at = k + part * PLS_W;
            sum[part] = sum[part] + pls_vd_load(b->weight + at) * pls_vd_load(b->extension + at);
        }
    return (double)b->dimension / (b->weighted * b->volume) * pls_lanes_sum(sum);
}

/// The evenly stretched part of the extensions by the reference length: sum g e / sum g xi of the family as it is, which for a whole one is theta / d. What is left of a dilation is nothing, however many bonds are
/// broken.
static inline __attribute__((always_inline)) double pls_family_mean(const pls_family_batch *b)
{
    pls_vd extension[PLS_FAMILY_PARTS] = {0}, reference[PLS_FAMILY_PARTS] = {0};
    for (size_t k = 0; k < b->count; k += PLS_BOND_VECTOR)
        for (size_t part = 0; part < PLS_FAMILY_PARTS; ++part)
        {
            const size_t at = k + part * PLS_W;
            const pls_vd g = pls_vd_load(b->weight + at);
            extension[part] = extension[part] + g * pls_vd_load(b->extension + at);
            reference[part] = reference[part] + g * pls_vd_load(b->reference + at);
        }
    const double whole = pls_lanes_sum(reference);
    return whole > 0.0 ? pls_lanes_sum(extension) / whole : 0.0;
}

/// c g / xi: times b / m the stiffness of PLS_W bonds against extension.
static inline __attribute__((always_inline)) pls_vd pls_family_stiffness(const pls_family_batch *b, size_t at)
{
    return pls_vd_load(b->correction + at) * pls_vd_load(b->weight + at) / pls_vd_load(b->reference + at);
}

/// e less the even part
static inline __attribute__((always_inline)) pls_vd pls_family_deviator(const pls_family_batch *b, size_t at, double mean)
{
    return pls_vd_load(b->extension + at) - mean * pls_vd_load(b->reference + at);
}

#endif
