// families.h -- who is bonded to whom: for each point all points within the horizon, as they lie when the bonds are made.
//
// Points have an order of their own, along a space-filling curve through their reference positions and then by number, which never changes: sums over families follow it, whatever rows
// bodies have in memory. Families are padded to whole vectors of eight; padding repeats a partner, weighs nothing and is as good as broken.
#ifndef PLS_BOND_FAMILIES_H
#define PLS_BOND_FAMILIES_H

#include "model/domain.h"

#include <particls/status.h>
#include <stddef.h>
#include <stdint.h>

enum { PLS_BOND_VECTOR = 8 }; ///< bonds worked on at a time

/// A reference length that no bond has and no bond outgrows: of padding and of broken bonds [m].
#define PLS_NO_LENGTH 1e30

/// A point before it has a place in the order.
typedef struct pls_bond_point
{
    double x[3];     ///< reference position [m]
    double volume;   ///< [m^3], in 2D with the thickness
    double spacing;  ///< size of its cell, over which its volume fades at the horizon [m]; 0: does not fade
    uint32_t number; ///< of the body
    uint32_t generation;
} pls_bond_point;

/// An image of a point beyond a periodic face, which has points near it as partners.
typedef struct pls_bond_ghost
{
    uint32_t point;
    int16_t shift[3]; ///< it lies at X + shift * edge
} pls_bond_ghost;

/// Zero-initialise; `pls_families_free` releases.
typedef struct pls_families
{
    size_t count;          ///< points
    pls_bond_point *point; ///< in order
    size_t ghosts;
    pls_bond_ghost *ghost;
    uint32_t *start;   ///< per point and one more: first vector of its family
    uint32_t *size;    ///< bonds of each
    uint32_t *partner; ///< in order: a point, or behind them a ghost
    double *length;    ///< reference length xi [m]
    size_t bonds;      ///< of either direction, padding left out
} pls_families;

/// Families of `count` points. `point` is put in order and belongs to the families from here on, also when this fails.
/// INVALID_ARGUMENT: two points in one place; a point without partners; periodic edges shorter than two horizons. LIMIT_EXCEEDED: more than 2^32 vectors of bonds.
pls_status pls_families_make(pls_families *f, pls_bond_point *point, size_t count, double horizon, const pls_domain *domain);
void pls_families_free(pls_families *f);

/// The point a partner is, or is an image of.
static inline uint32_t pls_point_behind(const pls_families *f, uint32_t partner)
{
    return partner < f->count ? partner : f->ghost[partner - f->count].point;
}

/// Part of a partner's volume that counts at reference length xi: a cell of width `spacing` is cut by the horizon (THEORY 5).
static inline double pls_partial_volume(double xi, double horizon, double spacing)
{
    if (!(spacing > 0.0)) return 1.0;
    const double part = 0.5 + (horizon - xi) / spacing;
    return part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
}

#endif
