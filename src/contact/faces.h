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
bool pls_faces_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                     pls_overlap_record *record, pls_touch *out);

/// A triangle or segment of a wall: two faces back to back.
static inline bool pls_is_facet(const pls_shape *s)
{
    return s->convex && s->polytope && s->polytope->face_count == 2 && s->polytope->vertex_count == (uint32_t)s->dimension;
}

/// Mean distance from the middle over the radius of gyration, of a disc and of a line that are evenly pressed.
#define PLS_ARM_OF_DISC 0.94280904158206336
#define PLS_ARM_OF_LINE 0.86602540378443865

/// X moved along the normal into the plane of touch, that of the normal force.
static inline pls_vec3 pls_in_plane_of_touch(const pls_touch *t, pls_vec3 X)
{
    const pls_vec3 apart = pls_sub(X, t->point);
    return pls_add(t->point, pls_sub(apart, pls_scale(t->normal, pls_dot(apart, t->normal))));
}

/// Where two bodies touch over an area, force and point alone do not tell how they rub and damp when they turn on each other: these do.
/// @{

static inline bool pls_touch_is_point(const pls_touch *t) { return t->spread[0] == 0.0 && t->spread[1] == 0.0 && t->spread[2] == 0.0; }
/// Four points, a quarter of the area each, that have its second moments: from `touch->point`, opposite ones in turn.
void pls_touch_corners(const pls_touch *touch, pls_vec3 corner[4]);
/// @}

#endif
