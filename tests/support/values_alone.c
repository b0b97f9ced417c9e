// values_alone.c -- see values_alone.h.
#include "support/values_alone.h"

#include <particls/plugin.h>

#define NUMBER(key)                                                                                           \
    {                                                                                                         \
        .name = key, .unit = "m", .meaning = "", .initial = PLS_REQUIRED, .minimum = 0.0, .maximum = INFINITY \
    }

static double larger(double a, double b) { return a > b ? a : b; }

/// Of a point outside of a box or rectangle by these much beyond its faces, inside where all are negative.
static double beyond(double x, double y, double z)
{
    const double a = larger(x, 0.0), b = larger(y, 0.0), c = larger(z, 0.0);
    return sqrt(a * a + b * b + c * c) + fmin(larger(x, larger(y, z)), 0.0);
}

static double ring(const pls_shape *s, pls_vec3 X)
{
    const double across = sqrt(X.x * X.x + X.y * X.y) - s->values[0];
    return sqrt(across * across + X.z * X.z) - s->values[1];
}

static double box(const pls_shape *s, pls_vec3 X)
{
    const double *half = s->values, r = half[3], z = s->dimension == 2 ? -INFINITY : fabs(X.z) - half[2] + r;
    return beyond(fabs(X.x) - half[0] + r, fabs(X.y) - half[1] + r, z) - r;
}

static double drum(const pls_shape *s, pls_vec3 X)
{
    return beyond(sqrt(X.x * X.x + X.y * X.y) - s->values[0], fabs(X.z) - s->values[1], -INFINITY);
}

static double ball(const pls_shape *s, pls_vec3 X) { return pls_length(X) - s->values[0]; }

/// The union of two rectangles, whose distance outside is the lesser.
static double corner(const pls_shape *s, pls_vec3 X)
{
    const double a = s->values[0];
    const double left = beyond(fabs(X.x + 0.5 * a) - 0.5 * a, fabs(X.y) - a, -INFINITY);
    const double below = beyond(fabs(X.x) - a, fabs(X.y + 0.5 * a) - 0.5 * a, -INFINITY);
    return fmin(left, below);
}

static double bracket(const pls_shape *s, pls_vec3 X) { return beyond(corner(s, X), fabs(X.z) - s->values[1], -INFINITY); }

/// Least distance from the balls, whose radii shrink along the axis.
static double cone(const pls_shape *shape, pls_vec3 X)
{
    const double low = shape->values[0], length = shape->values[2];
    double axial = shape->dimension == 2 ? X.y : X.z, radial = shape->dimension == 2 ? fabs(X.x) : hypot(X.x, X.y);
    double slope = (low - shape->values[1]) / length, along = axial - radial * slope / sqrt(1.0 - slope * slope);
    // The ball that is nearest: where the surface's normal, of slope `slope` to the radius, leads back to the axis.
    double t = fmin(fmax(along, 0.0), length);
    return hypot(radial, axial - t) - (low - slope * t);
}

static const pls_parameter ring_numbers[] = {NUMBER("ring"), NUMBER("tube"), {.name = NULL}};
static const pls_parameter box_numbers[] = {NUMBER("x"), NUMBER("y"), NUMBER("z"), NUMBER("rounding"), {.name = NULL}};
static const pls_parameter drum_numbers[] = {NUMBER("radius"), NUMBER("half_length"), {.name = NULL}};
static const pls_parameter cone_numbers[] = {NUMBER("low"), NUMBER("high"), NUMBER("length"), {.name = NULL}};
static const pls_parameter radius[] = {NUMBER("radius"), {.name = NULL}};
static const pls_parameter edge[] = {NUMBER("a"), {.name = NULL}};
static const pls_parameter bracket_numbers[] = {NUMBER("a"), NUMBER("half_width"), {.name = NULL}};

const pls_shape_ops values_ring = {
    .api_version = PLS_API_VERSION, .name = "values_ring", .parameters = ring_numbers, .in_3d = true, .sdf = ring};
const pls_shape_ops values_box = {.api_version = PLS_API_VERSION,
                                  .name = "values_box",
                                  .parameters = box_numbers,
                                  .in_2d = true,
                                  .in_3d = true,
                                  .convex = true,
                                  .sdf = box};
const pls_shape_ops values_drum = {
    .api_version = PLS_API_VERSION, .name = "values_drum", .parameters = drum_numbers, .in_3d = true, .convex = true, .sdf = drum};
const pls_shape_ops values_ball = {
    .api_version = PLS_API_VERSION, .name = "values_ball", .parameters = radius, .in_2d = true, .in_3d = true, .convex = true, .sdf = ball};
const pls_shape_ops values_corner = {
    .api_version = PLS_API_VERSION, .name = "values_corner", .parameters = edge, .in_2d = true, .sdf = corner};
const pls_shape_ops values_bracket = {
    .api_version = PLS_API_VERSION, .name = "values_bracket", .parameters = bracket_numbers, .in_3d = true, .sdf = bracket};
const pls_shape_ops values_cone = {.api_version = PLS_API_VERSION,
                                   .name = "sdf-only cone",
                                   .parameters = cone_numbers,
                                   .in_2d = true,
                                   .in_3d = true,
                                   .convex = true,
                                   .sdf = cone};
