// links.h -- bonds that turn with the two bodies they join: what is fixed in either body, and how they look now.
//
// A bond is evaluated from both of its ends, by the same operations, so that each point only gathers: forces at the two ends are opposite to the bit (but across periodic faces), torques balance to round-off.
#ifndef PLS_BOND_LINKS_H
#define PLS_BOND_LINKS_H

#include "bond/families.h"
#include "model/bodies.h"

#include <particls/bond.h>

/// What is fixed in the bodies, in their own frames: components of eight bonds at a time, of the vectors along (own, other) and across (own, other).
enum { PLS_LINK_NUMBERS = 12 };

/// Zero-initialise; `pls_links_free` releases.
typedef struct pls_links
{
    const pls_bond_ops *ops; ///< null: there are none
    double constants[PLS_BOND_MAX_CONSTANTS];
    double *fixed;     ///< PLS_LINK_NUMBERS columns of eight per vector of bonds
    double (*pose)[8]; ///< per point and ghost: x y z 0, orientation w x y z
} pls_links;

/// Columns of a batch. On the stack of whoever evaluates.
typedef struct pls_link_work
{
    _Alignas(64) double reference[PLS_LAW_BATCH], length[PLS_LAW_BATCH], unit[3][PLS_LAW_BATCH];
    _Alignas(64) double along[2][3][PLS_LAW_BATCH], across[2][3][PLS_LAW_BATCH];
    _Alignas(64) double force[3][PLS_LAW_BATCH], torque[3][PLS_LAW_BATCH], energy[PLS_LAW_BATCH], load[PLS_LAW_BATCH];
} pls_link_work;

pls_status pls_links_make(pls_links *links, const pls_families *family, const pls_bodies *bodies, const pls_domain *domain);
void pls_links_free(pls_links *links);
size_t pls_links_bytes(const pls_links *links, const pls_families *family);
/// Poses of points first .. last from the bodies; those of ghosts from those of their points.
void pls_links_take_poses(pls_links *links, const pls_families *family, const pls_bodies *bodies, size_t first, size_t last);
void pls_links_take_ghosts(pls_links *links, const pls_families *family, const pls_domain *domain);
/// Move a point's pose on by its velocities for a time.
void pls_links_advance(pls_links *links, const pls_families *family, const pls_bodies *bodies, double time);
/// Ask the law about the first `count` (a multiple of 8) bonds of the work space.
void pls_links_ask(const pls_links *links, size_t count, pls_link_work *work);

#endif
