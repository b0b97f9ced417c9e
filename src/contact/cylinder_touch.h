// cylinder_touch.h -- a cylinder on half-spaces, walls, and bodies of plane faces: lying on its side, standing on its end, on its rim between.
#ifndef PLS_CONTACT_CYLINDER_TOUCH_H
#define PLS_CONTACT_CYLINDER_TOUCH_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"

/// The contact by options->faces (VOLUME or MANIFOLD) of a cylinder and a half-space, a triangle of a wall, or a body of plane faces, whose penetration depth is known; half-spaces
/// and triangles come as B. Rounded cylinders only against walls, and with rounding of at most half their radius and a quarter of their length; bodies of plane faces only if they
/// are not rounded and have at most 64 faces. False for other pairs, always for the same ones: the point law stands, and nothing is written.
bool pls_cylinder_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options, pls_touch *out);

#endif
