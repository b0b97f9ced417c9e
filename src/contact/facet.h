// facet.h -- triangles and segments of walls: as bodies of plane faces the fronts of endless prisms.
#ifndef PLS_CONTACT_FACET_H
#define PLS_CONTACT_FACET_H

#include "contact/overlap.h"

/// A triangle or segment of a wall: two faces back to back.
static inline bool pls_is_facet(const pls_shape *s)
{
    return s->convex && s->polytope && s->polytope->face_count == 2 && s->polytope->vertex_count == (uint32_t)s->dimension;
}

/// The prism behind a facet, about `origin`: its front, towards `centre`, its margin before the facet; then the sides. Returns the number of planes.
int pls_facet_prism(const pls_posed *facet, pls_vec3 origin, pls_vec3 centre, pls_half_space plane[4]);

#endif
