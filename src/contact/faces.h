// faces.h -- contact of faces that lie on each other: laws of the whole overlap in place of its deepest point.
#ifndef PLS_CONTACT_FACES_H
#define PLS_CONTACT_FACES_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"

typedef struct pls_overlap_integrals pls_overlap_integrals;
typedef struct pls_prism pls_prism;

/// Most faces of a shape; one of more has none, here.
enum { PLS_MOST_FACES = 256 };

/// The contact by options->faces (VOLUME or MANIFOLD) of two shapes whose penetration depth is known. Half-spaces come as B; of pieces of walls wall_touch.h tells.
/// False if the pair has no faces to speak of, always for the same pairs of shapes: the point law stands, and nothing is written.
/// Faces have polyhedra, boxes, polygons and prisms of at most PLS_MOST_FACES faces, rounded ones only against half-spaces. For VOLUME on a
/// half-space also sphere, disc, ellipsoid and ellipse.
/// Gives the area of touch too (`spread`): that of the overlap, weighted by its thickness.
/// `record` (null: none) spares work if it is still that of the last step; the answer does not depend on it, but that without one there always is an energy.
/// `recorded`: there is a record of what touches, so that the next answer may come from it alone.
bool pls_faces_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                     pls_overlap_record *record, bool *recorded, pls_touch *out);

/// The same from a record of these two bodies alone, without their penetration depth, which is not given then (INFINITY; `reach` is). False: this record does not tell.
bool pls_faces_touch_again(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_overlap_record *record,
                           pls_touch *out);

/// Polyhedra, boxes, polygons and prisms of at most PLS_MOST_FACES faces, rounded or not.
bool pls_has_faces(const pls_shape *shape);

/// Integrals over what of a body with faces is behind a facet, about a point of its front: `origin`, near which and about which the prism is, is moved there. Of rounded bodies the core
/// counts. False: nothing is.
bool pls_faces_behind(const pls_posed *a, const pls_posed *facet, const pls_prism *prism, pls_vec3 *origin, pls_overlap_integrals *P);

#endif
