// cylinder_pair.h -- a cylinder on a cylinder: points, or areas and lines where one lies or stands on the other.
#ifndef PLS_CONTACT_CYLINDER_PAIR_H
#define PLS_CONTACT_CYLINDER_PAIR_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"

bool pls_is_cylinder_pair(const pls_shape *a, const pls_shape *b);

/// How much of the contact goes by pieces of the surfaces: 1 where the axes are parallel or at right angles to 3 degrees, 0 from 12 degrees on, smooth between. `slope`: by the
/// cosine of the angle of the axes; may be null.
double pls_cylinders_lie(const pls_posed *a, const pls_posed *b, double *slope);

/// The contact of two cylinders whose penetration depth is known and positive, by options->faces (VOLUME or MANIFOLD).
void pls_cylinders_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options, pls_touch *out);

#endif
