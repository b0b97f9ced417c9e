// lines.h -- contact along lines: capsules that lie on something, and rounded bodies on each other's faces.
#ifndef PLS_CONTACT_LINES_H
#define PLS_CONTACT_LINES_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"

/// The contact of two shapes that touch along straight lines, in place of their deepest point; their penetration depth is known. Half-spaces come as B.
/// False if the pair has no such lines, always for the same pairs of shapes: nothing is written. Lines have capsules on half-spaces, polytopes, triangles and segments of
/// walls, and each other, and polyhedra, boxes and polygons of which one is rounded, on each other.
bool pls_lines_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, pls_touch *out);

#endif
