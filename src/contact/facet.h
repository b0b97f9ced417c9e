// facet.h -- triangles and segments of walls: as bodies of plane faces the fronts of endless prisms.
#ifndef PLS_CONTACT_FACET_H
#define PLS_CONTACT_FACET_H

#include "contact/overlap.h"
#include "contact/posed.h"
#include "shape/wall_facets.h"

static inline bool pls_is_facet(const pls_shape *s) { return pls_shape_facet(s) != NULL; }

/// A facet as seen from a point.
typedef struct pls_facet_view
{
    double distance; ///< squared [m^2]
    double front;    ///< 1: the point is on the side of the facet's normal; -1: on the other one
    bool at_rim;     ///< the nearest point is on a free side
} pls_facet_view;

/// Where the nearest point of the facet is one of its sides or corners, the facets around it decide together on which side of the wall the point is.
/// `seams`: how the facet lies to its neighbours.
pls_facet_view pls_facet_seen_from(const pls_posed *facet, const pls_facet *seams, pls_vec3 X);

/// Is a free side of one facet at the same place as one of another? Then they are joined there in `seams`, which are those of the first one, and the side is returned; else -1.
int pls_facet_join_posed(const pls_posed *facet, pls_facet *seams, const pls_posed *other);

/// Does a seam, as seen from the front, turn towards it, and more than within a patch?
static inline bool pls_seam_is_valley(const pls_facet *f, int k, double front) { return !f->level[k] && f->bend[k] * front < 0.0; }

/// The front, its opposite in the middle of the wall's thickness, and for each of three sides a plane, a bevel and that of a corner.
enum { PLS_PRISM_PLANES = 2 + 3 * 3 };

/// What is behind a facet.
struct pls_prism
{
    int faces;                              ///< those that depth counts from: the front, free sides, and bevels
    int planes;                             ///< all; the rest halve the angle to the facet beyond, and the thickness of the wall
    pls_half_space plane[PLS_PRISM_PLANES]; ///< outwards
};

/// About `origin`, the front raised by `margin` beside that of the facet. Behind a facet is what is nearer to it than to its neighbours; in a valley all that is behind its plane, so
/// that a body comes in by the front only. Near a free side depth counts from there, too: it grows from zero wherever a body comes from. Raised faces meet in bevels, inside of the
/// round edges that the facets have with that margin: who overlaps the one overlaps the other.
pls_prism pls_facet_prism(const pls_posed *facet, const pls_facet *seams, pls_vec3 origin, double front, double margin);

#endif
