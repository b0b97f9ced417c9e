// lines.h -- contact along lines: capsules that lie on something, and rounded bodies on each other's faces.
#ifndef PLS_CONTACT_LINES_H
#define PLS_CONTACT_LINES_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"
#include "contact/overlap.h"

/// The contact of two shapes that touch along straight lines, in place of their deepest point; their penetration depth is known. Half-spaces come as B, of pieces of walls
/// wall_touch.h tells. False if the pair has no such lines, always for the same pairs of shapes: nothing is written. Lines have capsules on half-spaces, polytopes, and each other,
/// and polyhedra, boxes and polygons of which one is rounded, on each other.
bool pls_lines_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, pls_touch *out);

/// A capsule or stadium.
bool pls_has_line(const pls_shape *shape);

/// Integrals over a capsule's line as far as it touches a facet, about `origin` [m for m^2, and so on]: `volume` is that of the overlap t, `by_depth` and `by_its_square` have t^2/2 and
/// t^3/3. False: nothing touches.
bool pls_line_on(const pls_posed *a, const pls_posed *facet, pls_vec3 origin, pls_overlap_integrals *P);

/// What such integrals make of a touch, about their origin; `size` of the smaller body. False: less than numbers tell, or pushes that cancel; then nothing is written.
bool pls_line_law(pls_overlap_integrals *P, double size, bool flat, pls_touch *out);

#endif
