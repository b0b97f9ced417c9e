// ellipsoid.c -- the ellipsoid, in 2D the ellipse, by its true distance; thickened by a ball if wanted.
//
// The foot x of a point y obeys x_i = e_i^2 y_i / (t + e_i^2) for a number t > -e_min^2, and lies on the surface: one equation for t (Eberly, "Distance from a point
// to an ellipse, an ellipsoid, or a hyperellipsoid", Geometric Tools 2013). With u = 1 + t / e_min^2 the equation is |p(u)| = 1, p_i = (e_i y_i / e_min^2) / (u + r_i - 1),
// r_i = (e_i / e_min)^2. As in trust region methods (More and Sorensen 1983), 1 / |p| - 1 is increasing and concave in u, so Newton's method from below the root
// rises to it without a step too far. On the medial axis (u = 0) the missing coordinate comes from the surface. The distance is n . y - h(n), h the support function and n
// the normal at the foot: of all n this is the largest, so errors of n count squared.

#include "shape/builtin.h"
#include "shape/mass_quadrature.h"

static const pls_parameter parameters[] = {
    {.name = "half",
     .unit = "m",
     .meaning = "half axes along x, y, z, in 2D along x, y; without the rounding",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true,
     .components = 3},
    {.name = "rounding",
     .unit = "m",
     .meaning = "radius of a ball (disc) by which it is thickened; the whole is larger by it",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = NULL},
};

enum { ROUNDING = 3 };
enum { NEWTON_STEPS = 200 }; ///< far more than ever taken: some 5, near the medial axis up to 60

static double least_axis(const pls_shape *shape)
{
    const double *e = shape->values;
    return fmin(fmin(e[0], e[1]), shape->dimension == 2 ? INFINITY : e[2]);
}

/// |p(u)| and minus its derivative.
static double length_of_p(const double w[3], const double beyond[3], double u, double *slope)
{
    double square = 0.0, change = 0.0;
    for (int i = 0; i < 3; ++i)
    {
        if (w[i] == 0.0) continue;
        double p = w[i] / (u + beyond[i]);
        square += p * p;
        change += p * p / (u + beyond[i]);
    }
    double length = sqrt(square);
    *slope = length > 0.0 ? change / length : 0.0;
    return length;
}

/// The root u of |p| = 1; 0 on the medial axis.
static double find_u(const double w[3], const double beyond[3])
{
    double u = 0.0, slope;
    for (int i = 0; i < 3; ++i) u = fmax(u, w[i] - beyond[i]); // no |p_i| is above 1 at the root
    if (u == 0.0 && length_of_p(w, beyond, u, &slope) <= 1.0) return 0.0;
    for (int k = 0; k < NEWTON_STEPS; ++k)
    {
        double length = length_of_p(w, beyond, u, &slope), next = u + (length - 1.0) * length / slope;
        if (!(next > u * (1.0 + 1e-16))) break;
        u = next;
    }
    return u;
}

/// The outward normal at the foot of X.
static pls_vec3 gradient(const pls_shape *shape, pls_vec3 X)
{
    const double *e = shape->values, least = least_axis(shape), y[3] = {X.x, X.y, X.z};
    double w[3] = {0.0, 0.0, 0.0}, beyond[3] = {0.0, 0.0, 0.0}, n[3] = {0.0, 0.0, 0.0}, left = 1.0;
    int flat = -1;
    for (int i = 0; i < shape->dimension; ++i)
    {
        w[i] = e[i] * fabs(y[i]) / (least * least);
        beyond[i] = (e[i] - least) * (e[i] + least) / (least * least);
        if (e[i] == least) flat = i;
    }
    double u = find_u(w, beyond);
    for (int i = 0; i < shape->dimension; ++i)
    {
        if (w[i] == 0.0) continue;
        n[i] = w[i] / (u + beyond[i]); // of length 1: the foot is e_i n_i
        left -= n[i] * n[i];
        n[i] = copysign(n[i] / e[i], y[i]);
    }
    if (u == 0.0) n[flat] = copysign(sqrt(fmax(left, 0.0)) / e[flat], y[flat]);
    return pls_unit(pls_scale(pls_vec(n[0], n[1], n[2]), least));
}

static double support_function(const pls_shape *shape, pls_vec3 n)
{
    const double *e = shape->values;
    return pls_length(pls_vec(e[0] * n.x, e[1] * n.y, shape->dimension == 2 ? 0.0 : e[2] * n.z));
}

static double sdf(const pls_shape *shape, pls_vec3 X)
{
    pls_vec3 n = gradient(shape, X);
    return pls_dot(n, X) - support_function(shape, n) - shape->values[ROUNDING];
}

static double margin(const pls_shape *shape) { return shape->values[ROUNDING]; }

static pls_vec3 support(const pls_shape *shape, pls_vec3 n)
{
    const double *e = shape->values, h = support_function(shape, n);
    return pls_vec(e[0] * e[0] * n.x / h, e[1] * e[1] * n.y / h, shape->dimension == 2 ? 0.0 : e[2] * e[2] * n.z / h);
}

static void support_gradient(const pls_shape *shape, pls_vec3 n, double derivative[6])
{
    const double *e = shape->values, h = support_function(shape, n);
    pls_vec3 s = support(shape, n);
    derivative[0] = (e[0] * e[0] - s.x * s.x) / h;
    derivative[1] = (e[1] * e[1] - s.y * s.y) / h;
    derivative[2] = shape->dimension == 2 ? 0.0 : (e[2] * e[2] - s.z * s.z) / h;
    derivative[3] = -s.x * s.y / h;
    derivative[4] = -s.x * s.z / h;
    derivative[5] = -s.y * s.z / h;
}

static double bounding_radius(const pls_shape *shape)
{
    const double *e = shape->values;
    return fmax(fmax(e[0], e[1]), shape->dimension == 2 ? 0.0 : e[2]) + e[ROUNDING];
}

static void bounds(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper)
{
    const double *e = shape->values, r = e[ROUNDING];
    *upper = pls_vec(e[0] + r, e[1] + r, shape->dimension == 2 ? 0.0 : e[2] + r);
    *lower = pls_scale(*upper, -1.0);
}

/// A step back along the gradient, unless that crosses the ridge of phi: the middle plane of the least half axis c, where phi = -c s and
/// s^2 = 1 - sum of y_i^2 / (e_i^2 - c^2) over the others. On it y_i = x_i / (1 + step c / ((e_i^2 - c^2) s)): one increasing equation for s.
static pls_vec3 proximal(const pls_shape *shape, pls_vec3 X, double step)
{
    const double *e = shape->values, c = least_axis(shape), x[3] = {X.x, X.y, X.z};
    pls_vec3 n = gradient(shape, X), Y = pls_sub(X, pls_scale(n, step));
    double phi = sdf(shape, X) + e[ROUNDING], y[3] = {0.0, 0.0, 0.0}, low = 0.0, high = 1.0;
    if (phi >= step || sdf(shape, Y) + e[ROUNDING] - (phi - step) < 1e-13 * bounding_radius(shape)) return Y;
    for (int k = 0; k < 200 && high - low > 0.0; ++k)
    {
        double s = 0.5 * (low + high), square = s * s;
        for (int i = 0; i < shape->dimension; ++i)
        {
            double w = (e[i] - c) * (e[i] + c);
            y[i] = w > 0.0 ? x[i] * s * w / (s * w + step * c) : 0.0;
            if (w > 0.0) square += y[i] * y[i] / w;
        }
        if (s == low || s == high) break;
        if (square < 1.0)
            low = s;
        else
            high = s;
    }
    return pls_vec(y[0], y[1], y[2]);
}

static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    const double *e = shape->values, xx = e[0] * e[0], yy = e[1] * e[1], zz = e[2] * e[2];
    const bool flat = shape->dimension == 2;
    if (e[ROUNDING] > 0.0) return pls_mass_by_quadrature(shape, pls_vec(0.0, 0.0, 0.0), bounding_radius(shape) * (1.0 + 1e-9), out);
    *out = (pls_mass_properties){.volume = flat ? M_PI * e[0] * e[1] : 4.0 / 3.0 * M_PI * e[0] * e[1] * e[2]};
    out->inertia[2] = out->volume * (xx + yy) / (flat ? 4.0 : 5.0);
    if (flat) return PLS_OK;
    out->inertia[0] = 0.2 * out->volume * (yy + zz);
    out->inertia[1] = 0.2 * out->volume * (xx + zz);
    return PLS_OK;
}

#define ANSWERS                                                                                                                           \
    .api_version = PLS_API_VERSION, .parameters = parameters, .convex = true, .smooth = true, .sdf = sdf, .gradient = gradient,           \
    .proximal = proximal, .support = support, .support_gradient = support_gradient, .margin = margin, .bounding_radius = bounding_radius, \
    .bounds = bounds, .mass_properties = mass_properties

const pls_shape_ops pls_ellipsoid_shape = {
    .name = "ellipsoid",
    .meaning = "an ellipsoid; in 2D an ellipse",
    .in_2d = true,
    .in_3d = true,
    ANSWERS,
};

const pls_shape_ops pls_ellipse_shape = {
    .name = "ellipse",
    .meaning = "an ellipse: an ellipsoid in 2D",
    .in_2d = true,
    ANSWERS,
};
