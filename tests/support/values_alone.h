// values_alone.h -- shapes of which nothing is said but their signed distance.
#ifndef PLS_TESTS_SUPPORT_VALUES_ALONE_H
#define PLS_TESTS_SUPPORT_VALUES_ALONE_H

#include <particls/shape.h>

/// A ring about z: the points within `tube` of a circle of radius `ring`. Numbers: ring, tube.
extern const pls_shape_ops values_ring;
/// Half edges along x, y and z (2D: two of them count), rounding. Convex.
extern const pls_shape_ops values_box;
/// A cylinder about z. Numbers: radius, half length. Convex.
extern const pls_shape_ops values_drum;
/// A ball (2D: disc). Numbers: radius. Convex.
extern const pls_shape_ops values_ball;
/// A cone between two balls, convex: {radius of the ball at the origin, radius of the other, smaller one, distance of the other along z (2D: y)}.
extern const pls_shape_ops values_cone;
/// 2D: three quarters of a square about the origin, of edge 2 a, the first quadrant missing. Numbers: a.
extern const pls_shape_ops values_corner;
/// The same in 3D, of some width along z. Numbers: a, half width.
extern const pls_shape_ops values_bracket;

#endif
