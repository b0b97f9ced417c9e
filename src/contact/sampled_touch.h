// sampled_touch.h -- contact of surfaces that are known by their pieces alone: shapes that are not convex, flat places of shapes given by an SDF and of superquadrics, cylinders on each other.
#ifndef PLS_CONTACT_SAMPLED_TOUCH_H
#define PLS_CONTACT_SAMPLED_TOUCH_H

#include "contact/narrow_phase.h"
#include "contact/overlap.h"

/// Pairs whose contact is that of pieces, always the same pairs of shapes: of which one is not convex, or has flat places that only its SDF knows of, or is a box-like superquadric, while the other has some, too; two cylinders.
/// Not balls, whose distance from anything is one SDF call.
bool pls_is_sampled_pair(const pls_shape *a, const pls_shape *b);

/// The contact of such a pair by options->faces (VOLUME or MANIFOLD). `delta` where nothing overlaps: minus a bound of the distance. Half-spaces come as B, of pieces of walls
/// wall_touch.h tells.
void pls_sampled_touch(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_touch *out);

/// As pls_faces_behind, about `origin`, but returns how deep the deepest piece is, 0 for none [m].
double pls_sampled_behind(const pls_posed *a, const pls_posed *facet, const pls_prism *prism, pls_vec3 origin, pls_overlap_integrals *P);

/// Is it the facet whose pieces count, by their depths in A? Of bodies that are not convex.
bool pls_is_sheet_pair(const pls_shape *a, const pls_shape *facet);
/// The integrals of such a pair about `origin`; returns the largest depth of the facet in A, 0 for none [m].
double pls_sheet_in(const pls_posed *a, const pls_posed *facet, pls_vec3 origin, pls_overlap_integrals *P);
/// How deep a facet may be in such a body before it is past its middle, where the thickest part of that is, and is pushed on [m].
double pls_sheet_deepest(const pls_posed *a);

/// The area of touch of one piece of a body of that size is none.
void pls_sampled_area(double size, pls_touch *touch);

#endif
