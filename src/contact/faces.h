// faces.h -- contact of faces that lie on each other: laws of the whole overlap in place of its deepest point.
#ifndef PLS_CONTACT_FACES_H
#define PLS_CONTACT_FACES_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"

/// Most faces of a shape; one of more has none, here.
enum { PLS_MOST_FACES = 256 };

/// The contact by options->faces (VOLUME or MANIFOLD) of two shapes whose penetration depth is known. Half-spaces, triangles and segments of walls come as B.
/// False if the pair has no faces to speak of, always for the same pairs of shapes: the point law stands, and nothing is written.
/// Faces have polyhedra, boxes, polygons and prisms of at most PLS_MOST_FACES faces, rounded ones only against walls: half-spaces, triangles, segments. For VOLUME on a
/// half-space also sphere, disc, ellipsoid and ellipse.
/// Gives the area of touch too (`spread`): that of the overlap, weighted by its thickness.
/// `record` (null: none) spares work if it is still that of the last step; the answer does not depend on it, but that without one there always is an energy.
/// `recorded`: there is a record of what touches, so that the next answer may come from it alone.
bool pls_faces_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                     pls_overlap_record *record, bool *recorded, pls_touch *out);

/// The same from a record of these two bodies alone, without their penetration depth, which is not given then (INFINITY; `reach` is). False: this record does not tell.
bool pls_faces_touch_again(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_overlap_record *record,
                           pls_touch *out);

#endif
