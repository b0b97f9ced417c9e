// cylinder_touch.h -- a cylinder on half-spaces, walls, and bodies of plane faces: lying on its side, standing on its end, on its rim between.
#ifndef PLS_CONTACT_CYLINDER_TOUCH_H
#define PLS_CONTACT_CYLINDER_TOUCH_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"
#include "contact/overlap.h"

/// The contact by options->faces (VOLUME or MANIFOLD) of a cylinder and a half-space or a body of plane faces, whose penetration depth is known; half-spaces come as B, of pieces of
/// walls wall_touch.h tells. Rounded cylinders only against walls, and with rounding of at most half their radius and a quarter of their length; bodies of plane faces only if they
/// are not rounded and have at most 64 faces. False for other pairs, always for the same ones: the point law stands, and nothing is written.
bool pls_cylinder_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options, pls_touch *out);

/// A cylinder that is not rounded by more than that.
bool pls_is_thick_cylinder(const pls_posed *a);

/// As pls_faces_behind: `origin`, about which the prism is and which is near A's point next to the facet, is moved to where the integrals are about.
bool pls_cylinder_behind(const pls_posed *a, const pls_prism *prism, pls_vec3 *origin, pls_overlap_integrals *P);

/// Spread and lever, which are those of all the overlap, become those of what touches a cylinder with that axis.
void pls_cylinder_area(pls_vec3 axis, pls_touch *touch);

#endif
