// cylinder_on_plane.h -- a cylinder on a half-space: lying on its side, standing on its end, and on its rim between.
#ifndef PLS_CONTACT_CYLINDER_ON_PLANE_H
#define PLS_CONTACT_CYLINDER_ON_PLANE_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"

/// The contact by options->faces (VOLUME or MANIFOLD) of a cylinder A, rounded or not, and a half-space B, whose penetration depth is known. False for other pairs.
bool pls_cylinder_on_plane(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                           pls_touch *out);

#endif
