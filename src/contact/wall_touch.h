// wall_touch.h -- bodies on walls of pieces: the pieces that a body lies over make one contact.
#ifndef PLS_CONTACT_WALL_TOUCH_H
#define PLS_CONTACT_WALL_TOUCH_H

#include "contact/facet.h"
#include "contact/narrow_phase.h"

/// Does a shape touch this facet by more than a point? Always the same answer for the same two: polytopes, cylinders, capsules and what is known by pieces of its surface do.
bool pls_is_wall_pair(const pls_posed *a, const pls_posed *facet, const pls_narrow_options *options);

/// Of such a pair no penetration depth is asked for: it goes by pieces of the body's surface, or of the facet.
bool pls_wall_needs_no_depth(const pls_posed *a, const pls_posed *facet);

/// Of such a pair does it matter on which side of the wall the body is? Not to bodies that are not convex.
bool pls_wall_has_sides(const pls_posed *a, const pls_posed *facet);

/// May the deepest point stand for what such a body's integrals do not tell? That of a capsule whose axis passes through the wall.
bool pls_wall_has_point(const pls_posed *a);

/// One body on some facets of a wall.
typedef struct pls_wall_sum
{
    const pls_posed *a;
    pls_vec3 origin; ///< of the integrals
    pls_overlap_integrals P;
    double depth;         ///< the largest penetration depth of the facets so far [m]
    double size;          ///< of the largest body so far [m]
    pls_half_space front; ///< of the facet that has it, about the origin
    int facets;           ///< that something is behind
    int kind;             ///< of the pair (wall_touch.c)
} pls_wall_sum;

pls_wall_sum pls_wall_sum_of(const pls_posed *a);
/// What is behind one more facet, whose depth or gap is `depth` (its `delta`, `normal` and `point`), as seen from its `front`; `seams`: how it lies to its neighbours. Returns whether
/// anything is.
bool pls_wall_add(pls_wall_sum *sum, const pls_posed *facet, const pls_facet *seams, double front, const pls_touch *depth);
/// The contact by options->faces. False: nothing touches; then nothing is written but `delta`, 0.
bool pls_wall_touch(pls_wall_sum *sum, const pls_narrow_options *options, pls_touch *out);

#endif
