// smooth_depth.h -- penetration depth of two smooth convex shapes.
#ifndef PLS_CONTACT_SMOOTH_DEPTH_H
#define PLS_CONTACT_SMOOTH_DEPTH_H

#include "contact/posed.h"

/// What a query of two shapes A and B tells.
typedef struct pls_overlap
{
    double delta;        ///< penetration depth, negative: distance [m]
    pls_vec3 normal;     ///< unit, from A to B
    pls_vec3 on_a, on_b; ///< on_a - on_b = delta normal [m]
    int iterations;
    bool converged;
} pls_overlap;

/// Newton's method on the sphere of normals, from `normal` (any unit vector when cold: the line of centres serves). Both shapes have `support` and
/// `support_gradient`, are convex and have curvature everywhere.
void pls_smooth_depth(const pls_posed *a, const pls_posed *b, pls_vec3 normal, pls_overlap *out);

/// Add e1.(H e1), e1.(H e2), e2.(H e2) to h, H the derivative of the support point along the unit vector n, margin included (its ball's support points turn with n) [m].
void pls_add_support_curvature(const pls_posed *p, pls_vec3 n, const pls_vec3 e[2], double h[3]);

/// Two unit vectors at right angles to n and each other; in 2D the first lies in the plane.
void pls_tangents(pls_vec3 n, int dimension, pls_vec3 e[2]);

#endif
