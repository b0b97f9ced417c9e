// admm.h -- the contact of two convex shapes as P1 has it: eq. 14 by ADMM.
#ifndef PLS_CONTACT_ADMM_H
#define PLS_CONTACT_ADMM_H

#include "contact/smooth_depth.h"

enum {
    PLS_ADMM_STATE = 24, ///< doubles a pair remembers
    PLS_ADMM_MOST = 1000 ///< iterations, then `converged` is false
};

/// P1 eq. 14: `on_a` is the point of A that lies deepest in B, `on_b` that of B deepest in A, xi = on_b - on_a. Overlapping, delta = |xi| and normal = -xi / |xi|: not the
/// penetration depth where corners or edges overlap. In a gap the closest points, delta = -|xi|.
///
/// Iterates until they change by less than `tolerance` times the size, the smaller bounding radius. phi at a point is then above the least by at most
/// 2 tolerance (size + D), D the distance of the point from the true one: little, but on nearly parallel faces D is not. Points no further apart than tolerance times size have no direction: the
/// normal is then that of the multipliers, the surfaces' own. `converged` is false if that was not reached, or if one shape has swallowed the other's deepest point, where
/// eq. 14 has no solution of this kind. `iterations` are those of the slower of the two problems. `state` is brought up to date, in body frames; all zero: cold.
void pls_admm_depth(const pls_posed *a, const pls_posed *b, double tolerance, double *state, pls_overlap *out);

#endif
