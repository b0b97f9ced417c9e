// sdf_only.c -- a shape given by its signed distance alone.

#include "support/sdf_only.h"

enum { LOW, HIGH, LENGTH };
#define LENGTH_OF_CONE(what)                                                                                     \
    {                                                                                                            \
        .name = what, .unit = "m", .meaning = what, .initial = PLS_REQUIRED, .minimum = 0.0, .maximum = INFINITY \
    }
static const pls_parameter parameters[] = {
    [LOW] = LENGTH_OF_CONE("low"), [HIGH] = LENGTH_OF_CONE("high"), [LENGTH] = LENGTH_OF_CONE("length"), {.name = NULL}};

/// Least distance from the balls, whose radii shrink along the axis.
static double sdf(const pls_shape *shape, pls_vec3 X)
{
    const double low = shape->values[LOW], length = shape->values[LENGTH];
    double axial = shape->dimension == 2 ? X.y : X.z, radial = shape->dimension == 2 ? fabs(X.x) : hypot(X.x, X.y);
    double slope = (low - shape->values[HIGH]) / length, along = axial - radial * slope / sqrt(1.0 - slope * slope);
    // The ball that is nearest: where the surface's normal, of slope `slope` to the radius, leads back to the axis.
    double t = fmin(fmax(along, 0.0), length);
    return hypot(radial, axial - t) - (low - slope * t);
}

const pls_shape_ops sdf_only_cone = {.api_version = PLS_API_VERSION,
                                     .name = "sdf-only cone",
                                     .meaning = "a cone between two balls",
                                     .parameters = parameters,
                                     .in_2d = true,
                                     .in_3d = true,
                                     .convex = true,
                                     .sdf = sdf};
