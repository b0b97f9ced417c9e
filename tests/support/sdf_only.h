// sdf_only.h -- a shape of which nothing is told but its signed distance, as a plugin's may be.
#ifndef PLS_TESTS_SUPPORT_SDF_ONLY_H
#define PLS_TESTS_SUPPORT_SDF_ONLY_H

#include <particls/shape.h>

/// A cone between two balls, convex: {radius of the ball at the origin, radius of the other, smaller one, distance of the other along z (2D: y)}.
extern const pls_shape_ops sdf_only_cone;

#endif
