// cylinder.c -- the cylinder along z, its rims rounded by a ball if wanted.
//
// In the half-plane of radius and height a cylinder is a rectangle, so its distance is that of a rectangle (see box.c). A rounded cylinder is the set of points
// within `rounding` of a smaller one, the core; radius and length are those of the whole.

#include "shape/builtin.h"

static const pls_parameter parameters[] = {
    {.name = "radius",
     .unit = "m",
     .meaning = "radius",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "length",
     .unit = "m",
     .meaning = "length along z, rounding included",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "rounding",
     .unit = "m",
     .meaning = "radius of the ball that rounds the rims, less than radius and half the length",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = NULL},
};

static double rounding_of(const pls_shape *shape) { return shape->values[2]; }
static double core_radius(const pls_shape *shape) { return shape->values[0] - shape->values[2]; }
static double core_half(const pls_shape *shape) { return 0.5 * shape->values[1] - shape->values[2]; }

static pls_status prepare(const pls_shape_input *input, int dimension, void **data)
{
    (void)dimension;
    *data = NULL;
    const double *v = input->values;
    if (v[2] < v[0] && v[2] < 0.5 * v[1]) return PLS_OK;
    return pls_fail(PLS_INVALID_ARGUMENT,
                    "a cylinder's 'rounding' must be less than its radius, %g m, and half its length, %g m; %g m is not: make it smaller",
                    v[0], 0.5 * v[1], v[2]);
}

static double margin(const pls_shape *shape) { return rounding_of(shape); }

/// Away from the axis; (1, 0) on it.
static pls_vec3 away(pls_vec3 X)
{
    double length = hypot(X.x, X.y);
    return length > 0.0 ? pls_vec(X.x / length, X.y / length, 0.0) : pls_vec(1.0, 0.0, 0.0);
}

static pls_vec3 support(const pls_shape *shape, pls_vec3 n)
{
    // Straight up the whole end is as far; its centre is the point in the middle.
    pls_vec3 side = n.x != 0.0 || n.y != 0.0 ? pls_scale(away(n), core_radius(shape)) : pls_vec(0.0, 0.0, 0.0);
    return pls_vec(side.x, side.y, copysign(core_half(shape), n.z));
}

static double sdf(const pls_shape *shape, pls_vec3 X)
{
    double p = sqrt(X.x * X.x + X.y * X.y) - core_radius(shape), q = fabs(X.z) - core_half(shape);
    return (p > 0.0 && q > 0.0 ? sqrt(p * p + q * q) : fmax(p, q)) - rounding_of(shape);
}

static pls_vec3 gradient(const pls_shape *shape, pls_vec3 X)
{
    double p = sqrt(X.x * X.x + X.y * X.y) - core_radius(shape), q = fabs(X.z) - core_half(shape), radial = p > q, axial = !(p > q);
    if (p > 0.0 && q > 0.0) radial = p / sqrt(p * p + q * q), axial = q / sqrt(p * p + q * q);
    pls_vec3 side = pls_scale(away(X), radial);
    return pls_vec(side.x, side.y, copysign(axial, X.z));
}

/// As for the rectangle of radius and height, see box.c: what is cut off radius and height sums to `step`.
static pls_vec3 proximal(const pls_shape *shape, pls_vec3 X, double step)
{
    double r = core_radius(shape), h = core_half(shape), d = hypot(X.x, X.y), p = d - r, q = fabs(X.z) - h;
    if (hypot(fmax(p, 0.0), fmax(q, 0.0)) >= step) return pls_sub(X, pls_scale(gradient(shape, X), step));
    double m = fmax(fmax(p, q) - step, 0.5 * (p + q - step)); // one of them cut, or both
    m = fmin(fmax(m, -fmin(r, h)), 0.0);
    pls_vec3 side = pls_scale(away(X), fmin(d, r + m));
    return pls_vec(side.x, side.y, copysign(fmin(fabs(X.z), h + m), X.z));
}

static double bounding_radius(const pls_shape *shape) { return hypot(core_radius(shape), core_half(shape)) + rounding_of(shape); }

static void bounds(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper)
{
    *upper = pls_vec(shape->values[0], shape->values[0], 0.5 * shape->values[1]);
    *lower = pls_scale(*upper, -1.0);
}

/// Discs of radius p + s(u), s^2 = r^2 - u^2, at heights h + u above the middle and below, and the straight part between: the integrals over u of u^j s^k are
/// beta functions.
static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    const double p = core_radius(shape), h = core_half(shape), r = rounding_of(shape), R = p + r;
    const double s0 = r, s1 = M_PI / 4 * r * r, s2 = 2.0 / 3.0 * pow(r, 3), s3 = 3.0 * M_PI / 16 * pow(r, 4), s4 = 8.0 / 15.0 * pow(r, 5);
    const double us0 = r * r / 2, us1 = pow(r, 3) / 3, us2 = pow(r, 4) / 4;
    const double uus0 = pow(r, 3) / 3, uus1 = M_PI / 16 * pow(r, 4), uus2 = 2.0 / 15.0 * pow(r, 5);
    double cap = p * p * s0 + 2.0 * p * s1 + s2;
    double cap_u = p * p * us0 + 2.0 * p * us1 + us2;
    double cap_uu = p * p * uus0 + 2.0 * p * uus1 + uus2;
    double zz = 2.0 * M_PI * (R * R * h * h * h / 3.0 + h * h * cap + 2.0 * h * cap_u + cap_uu);
    double xx = 0.5 * M_PI * (h * pow(R, 4) + pow(p, 4) * s0 + 4.0 * pow(p, 3) * s1 + 6.0 * p * p * s2 + 4.0 * p * s3 + s4);
    *out = (pls_mass_properties){.volume = 2.0 * M_PI * (R * R * h + cap)};
    out->inertia[0] = out->inertia[1] = xx + zz;
    out->inertia[2] = 2.0 * xx;
    return PLS_OK;
}

const pls_shape_ops pls_cylinder_shape = {
    .api_version = PLS_API_VERSION,
    .name = "cylinder",
    .meaning = "a cylinder along z; its rims may be rounded",
    .parameters = parameters,
    .in_3d = true,
    .convex = true,
    .prepare = prepare,
    .sdf = sdf,
    .gradient = gradient,
    .support = support,
    .margin = margin,
    .proximal = proximal,
    .bounding_radius = bounding_radius,
    .bounds = bounds,
    .mass_properties = mass_properties,
};
