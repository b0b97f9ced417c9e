// sdf_depth.h -- penetration depth of two shapes that give nothing but their SDFs.
#ifndef PLS_CONTACT_SDF_DEPTH_H
#define PLS_CONTACT_SDF_DEPTH_H

#include "contact/smooth_depth.h"

/// What is kept of a pair between steps: in the frame of A.
typedef struct pls_sdf_state
{
    pls_vec3 x;        ///< the point
    double inverse[6]; ///< of the second derivative: xx, yy, zz, xy, xz, yz; all 0: nothing known [m]
} pls_sdf_state;

/// Minimise phi_A + phi_B over one point by BFGS: a convex problem for convex shapes, the same in gap and overlap. Quick for smooth shapes; where an SDF has edges
/// inside it may stall, and says so by `converged`. `state` is where to start and is brought up to date; `x` of it is not used when `inverse` is 0: then from `middle`.
void pls_sdf_depth_bfgs(const pls_posed *a, const pls_posed *b, pls_vec3 middle, pls_sdf_state *state, int most, pls_overlap *out);

/// The same on the two shapes pushed apart, so that only distances outside are used, the normal turning until it is that along which they are pushed: for any convex
/// shapes with true outer distances. Exact to round-off of values. From `normal`, `delta` and `middle`, a point between the witness points; `state` as above.
/// The minimum of the overlap found need not be the least of all.
void pls_sdf_depth_pushed(const pls_posed *a, const pls_posed *b, pls_vec3 normal, double delta, pls_vec3 middle, pls_sdf_state *state,
                          pls_overlap *out);

#endif
