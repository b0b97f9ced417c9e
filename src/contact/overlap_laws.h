// overlap_laws.h -- what two bodies make of the integrals over their overlap: the laws VOLUME and MANIFOLD of faces.c.
#ifndef PLS_CONTACT_OVERLAP_LAWS_H
#define PLS_CONTACT_OVERLAP_LAWS_H

#include "contact/convex.h"
#include "contact/overlap.h"

/// Of a body's size: faces this near to each other may count as one plane; rounding does not reach it.
#define PLS_OVERLAP_BLUR 2e-15

/// The touch by options->faces (VOLUME or MANIFOLD) and its area, about the origin and in the axes of the integrals; `depth` is left as it is. `flat`: in 2D. What is thinner
/// than rounding errors, `blur`, is none [m]. False if nothing overlaps, or less than numbers tell.
bool pls_overlap_touch(pls_overlap_integrals *P, const pls_narrow_options *options, double blur, bool flat, pls_touch *out);

/// A wrench as a force on a line, at its point nearest to `middle`, and a couple about it: `twist` by the force.
void pls_put_on_line(const pls_push *push, pls_vec3 middle, pls_vec3 *point, double *twist);

/// For bodies whose penetration depth is known but of which nothing, or less than numbers tell, overlaps.
void pls_overlap_none(const pls_depth *depth, pls_touch *out);

#endif
