// superquadric.c -- the superquadric (|x/a|^(2/e2) + |y/b|^(2/e2))^(e2/e1) + |z/c|^(2/e1) <= 1 (Barr, "Superquadrics and angle-preserving transformations", IEEE CG&A
// 1981), in 2D the superellipse |x/a|^(2/e2) + |y/b|^(2/e2) <= 1.
//
// It is the unit ball of a norm made of two p-norms, so convex for all exponents up to 2, and its support function is the dual norm: with X = a n_x, ... and
// P = 2 / (2 - e2), Q = 2 / (2 - e1),  h(n) = ||(||(X, Y)||_P, Z)||_Q, in closed form with its derivatives.
//
// The signed distance of a convex body is the maximum over unit normals n of F(n) = n . y - h(n), outside and inside. It is sought by Newton's method in the logarithms of
// the components of n (by symmetry y and n are taken positive), where all derivatives are smooth, even at the flat and the sharp places of the surface, where
// those of h or of the surface itself are infinite: with alpha = (X/k)^P, beta = 1 - alpha, gamma = (k/h)^Q, zeta = 1 - gamma the products n_i s_i and
// n_i n_j d s_i / d n_j are polynomials of these. Damping (Levenberg 1944) makes every step a rise. Outside there is one maximum. Inside there may be several, one
// for each nearby part of the surface, and some that lie close together or are hardly higher than what is between them: it is sought from all local maxima of a fine net of
// normals, in steps too short to jump from one to another. An error of n counts squared in the distance.

#include "shape/builtin.h"
#include "shape/mass_quadrature.h"

#include <string.h>

static const pls_parameter parameters[] = {
    {.name = "half",
     .unit = "m",
     .meaning = "half axes along x, y, z, in 2D along x, y; without the rounding",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true,
     .components = 3},
    {.name = "epsilon1",
     .unit = "",
     .meaning = "north-south exponent: 0.1 nearly square, 1 round, 1.9 nearly a bipyramid (2D: not used)",
     .initial = 1.0,
     .minimum = 0.1,
     .maximum = 1.9},
    {.name = "epsilon2",
     .unit = "",
     .meaning = "east-west exponent: 0.1 nearly square, 1 round, 1.9 nearly a rhombus",
     .initial = 1.0,
     .minimum = 0.1,
     .maximum = 1.9},
    {.name = "rounding",
     .unit = "m",
     .meaning = "radius of a ball (disc) by which it is thickened; the whole is larger by it",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = NULL},
};

enum { NORTH_SOUTH = 3, EAST_WEST = 4, ROUNDING = 5, MOST_STEPS = 100 };

double pls_superquadric_exponent(const pls_shape *s)
{
    return s->dimension == 2 ? s->values[EAST_WEST] : fmin(s->values[NORTH_SOUTH], s->values[EAST_WEST]);
}

double pls_superquadric_aspect(const pls_shape *s)
{
    const double *half = s->values, third = s->dimension == 2 ? half[0] : half[2];
    return fmax(half[0], fmax(half[1], third)) / fmin(half[0], fmin(half[1], third));
}

static double dual_exponent(double epsilon) { return 2.0 / (2.0 - epsilon); }

// ---- the support function in logarithms ---------------------------------------------------------------------------------------------------------------------

/// What is to be found: the largest F for a point y >= 0.
typedef struct search
{
    int count;                               ///< components of n: 2 or 3
    double y[3], half[3], log_half[3], P, Q; ///< Q = P of two equal numbers in 2D, where it does not matter
} search;

/// Where it is: log n, n of length 1, and there F, its gradient and Hessian with respect to log n.
typedef struct place
{
    double w[3], n[3], value, gradient[3], hessian[3][3];
} place;

static search search_of(const pls_shape *shape, pls_vec3 X)
{
    const double *v = shape->values;
    search s = {.count = shape->dimension, .y = {fabs(X.x), fabs(X.y), fabs(X.z)}, .half = {v[0], v[1], v[2]}};
    s.P = dual_exponent(v[EAST_WEST]);
    s.Q = dual_exponent(s.count == 2 ? v[EAST_WEST] : v[NORTH_SOUTH]);
    if (s.count == 2) s.half[2] = s.half[0], s.y[2] = 0.0;
    for (int k = 0; k < 3; ++k) s.log_half[k] = log(s.half[k]);
    return s;
}

/// || (A, B) ||_p from logarithms of A and B; `share` is the part of A^p in the sum.
static double log_norm(double a, double b, double p, double *share)
{
    const double most = fmax(a, b), least = fmin(a, b), less = exp(p * (least - most)), sum = 1.0 + less;
    *share = (a < b ? less : 1.0) / sum;
    return most + log(sum) / p;
}

/// h, n_i s_i and n_i n_j ds_i/dn_j.
static double support_products(const search *s, const double w[3], double product[3], double curve[3][3])
{
    double alpha, gamma = 1.0;
    double log_h = log_norm(s->log_half[0] + w[0], s->log_half[1] + w[1], s->P, &alpha), beta = 1.0 - alpha;
    if (s->count == 3) log_h = log_norm(log_h, s->log_half[2] + w[2], s->Q, &gamma);
    const double h = exp(log_h), zeta = 1.0 - gamma, part[3] = {gamma * alpha, gamma * beta, zeta};
    const double inner = (s->P - 1.0) * h * gamma * alpha * beta, outer = (s->Q - 1.0) * h * gamma * zeta, mix[3] = {alpha, beta, -1.0};
    for (int i = 0; i < 3; ++i)
    {
        product[i] = h * part[i];
        for (int j = 0; j < 3; ++j) curve[i][j] = outer * mix[i] * mix[j] + (i == 2 || j == 2 ? 0.0 : i == j ? inner : -inner);
    }
    return h;
}

static void look(const search *s, place *at)
{
    double product[3], curve[3][3], square = 0.0, most = at->w[0], d[3] = {0.0};
    for (int i = 1; i < s->count; ++i) most = fmax(most, at->w[i]);
    at->n[2] = 0.0;
    for (int i = 0; i < s->count; ++i)
    {
        at->n[i] = exp(at->w[i] - most);
        square += at->n[i] * at->n[i];
    }
    const double longer = 1.0 / sqrt(square), log_length = most + 0.5 * log(square);
    for (int i = 0; i < s->count; ++i)
    {
        at->w[i] -= log_length;
        at->n[i] *= longer;
    }
    at->value = -support_products(s, at->w, product, curve);
    for (int i = 0; i < s->count; ++i)
    {
        at->value += at->n[i] * s->y[i];
        d[i] = at->n[i] * s->y[i] - product[i];
    }
    const double F = at->value, *n = at->n;
    for (int i = 0; i < s->count; ++i) at->gradient[i] = d[i] - F * n[i] * n[i];
    for (int i = 0; i < s->count; ++i)
    {
        for (int j = 0; j < s->count; ++j)
            at->hessian[i][j] = 3.0 * F * n[i] * n[i] * n[j] * n[j] - curve[i][j] - d[i] * n[j] * n[j] - d[j] * n[i] * n[i];
        at->hessian[i][i] += at->gradient[i] - F * n[i] * n[i];
    }
}

// ---- the largest F ------------------------------------------------------------------------------------------------------------------------------------------

/// Solve (damping - Hessian) step = gradient by Cholesky's factors; false if the matrix is not positive definite.
static bool damped_step(const search *s, const place *at, double damping, double step[3])
{
    double L[3][3], z[3];
    for (int i = 0; i < s->count; ++i)
        for (int j = 0; j <= i; ++j)
        {
            double sum = (i == j ? damping : 0.0) - at->hessian[i][j];
            for (int k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
            if (i == j && !(sum > 0.0)) return false;
            L[i][j] = i == j ? sqrt(sum) : sum / L[j][j];
        }
    for (int i = 0; i < s->count; ++i)
    {
        z[i] = at->gradient[i];
        for (int k = 0; k < i; ++k) z[i] -= L[i][k] * z[k];
        z[i] /= L[i][i];
    }
    for (int i = s->count - 1; i >= 0; --i)
    {
        step[i] = z[i];
        for (int k = i + 1; k < s->count; ++k) step[i] -= L[k][i] * step[k];
        step[i] /= L[i][i];
    }
    return true;
}

/// To the maximum above `at`, by steps that change no logarithm by more than `longest`.
static void climb(const search *s, double longest, place *at)
{
    const double size = fmax(fmax(s->half[0], s->half[1]), s->half[2]);
    double damping = 1e-6 * size;
    look(s, at);
    for (int k = 0; k < MOST_STEPS; ++k)
    {
        double step[3], gain = 0.0, length = 0.0;
        if (!damped_step(s, at, damping, step))
        {
            damping *= 8.0;
            continue;
        }
        for (int i = 0; i < s->count; ++i) gain += step[i] * at->gradient[i], length = fmax(length, fabs(step[i]));
        if (gain < 1e-17 * size) return;
        place next = *at;
        for (int i = 0; i < s->count; ++i) next.w[i] += step[i] * fmin(1.0, longest / length);
        look(s, &next);
        bool better = next.value > at->value;
        if (!better && gain < 1e-14 * size) return; // round-off
        damping = better ? fmax(0.1 * damping, 1e-14 * size) : 8.0 * damping;
        if (better) *at = next;
    }
}

/// The gauge of y and the direction of its gradient, in logarithms: outside a start near the answer.
static double gauge_normal(const search *s, double w[3])
{
    double p = s->P / (s->P - 1.0), q = s->Q / (s->Q - 1.0), share, t[3];
    for (int i = 0; i < 3; ++i) t[i] = log(fmax(s->y[i], 1e-12 * s->half[i]) / s->half[i]);
    double inner = log_norm(t[0], t[1], p, &share), all = s->count == 3 ? log_norm(inner, t[2], q, &share) : inner;
    for (int i = 0; i < 2; ++i) w[i] = (p - 1.0) * (t[i] - inner) + (s->count == 3 ? (q - 1.0) * (inner - all) : 0.0) - s->log_half[i];
    w[2] = (q - 1.0) * (t[2] - all) - s->log_half[2];
    double most = fmax(fmax(w[0], w[1]), s->count == 3 ? w[2] : -INFINITY);
    for (int i = 0; i < 3; ++i) w[i] = fmax(w[i] - most, -7.0);
    return all;
}

// ---- the net of normals -------------------------------------------------------------------------------------------------------------------------------------
//
// With (X, Y, Z) = (a n_x, b n_y, c n_z), its meshes are ratios of X to Y and of their norm to Z, from the levels below: the sides and edges of shapes that are nearly
// polytopes then lie on its lines. n is scaled to h(n) = 1: F is (n . y - 1) / |n|, and costs no more than a square root.

enum { LEVELS = 25 };
static const double levels[LEVELS] = {-6.8, -5.2, -4.1, -3.2, -2.5, -1.9, -1.4, -1.0, -0.7, -0.45, -0.25, -0.1, 0.0,
                                      0.1,  0.25, 0.45, 0.7,  1.0,  1.4,  1.9,  2.5,  3.2,  4.1,   5.2,   6.8};

/// Logarithms of two numbers whose ratio is e^level and whose p-norm is 1.
static void on_unit_ball(double level, double p, double logs[2])
{
    double share, all = log_norm(level, 0.0, p, &share);
    logs[0] = level - all;
    logs[1] = -all;
}

/// Log n for the mesh of levels i and j.
static void normal_of_net(const search *s, int i, int j, double w[3])
{
    double flat[2], high[2] = {0.0, 0.0};
    on_unit_ball(levels[i], s->P, flat);
    if (s->count == 3) on_unit_ball(levels[j], s->Q, high);
    for (int k = 0; k < 2; ++k) w[k] = flat[k] + high[0] - s->log_half[k];
    w[2] = high[1] - s->log_half[2];
}

/// F on the net; in 2D it has one column.
static void cast_net(const search *s, double F[LEVELS][LEVELS])
{
    double along[LEVELS], square[LEVELS], side[LEVELS], top[LEVELS];
    for (int k = 0; k < LEVELS; ++k)
    {
        double logs[2];
        on_unit_ball(levels[k], s->P, logs);
        const double x = exp(logs[0]) / s->half[0], y = exp(logs[1]) / s->half[1];
        along[k] = x * s->y[0] + y * s->y[1];
        square[k] = x * x + y * y;
        if (s->count == 2) continue;
        on_unit_ball(levels[k], s->Q, logs);
        side[k] = exp(logs[0]);
        top[k] = exp(logs[1]) / s->half[2];
    }
    if (s->count == 2) side[0] = 1.0, top[0] = 0.0;
    for (int i = 0; i < LEVELS; ++i)
        for (int j = 0; j < (s->count == 2 ? 1 : LEVELS); ++j)
            F[i][j] = (side[j] * along[i] + top[j] * s->y[2] - 1.0) / sqrt(side[j] * side[j] * square[i] + top[j] * top[j]);
}

static bool is_summit(double (*F)[LEVELS], int columns, int i, int j)
{
    for (int k = i > 0 ? i - 1 : 0; k <= i + 1 && k < LEVELS; ++k)
        for (int l = j > 0 ? j - 1 : 0; l <= j + 1 && l < columns; ++l)
            if (F[k][l] > F[i][j]) return false;
    return true;
}

static place highest_inside(const search *s)
{
    const int columns = s->count == 2 ? 1 : LEVELS;
    double F[LEVELS][LEVELS];
    place best = {.value = -INFINITY};
    cast_net(s, F);
    for (int i = 0; i < LEVELS; ++i)
        for (int j = 0; j < columns; ++j)
        {
            if (!is_summit(F, columns, i, j)) continue;
            place other = {.value = 0.0};
            normal_of_net(s, i, j, other.w);
            climb(s, 1.0, &other);
            if (other.value > best.value) best = other;
        }
    return best;
}

static place find_normal(const pls_shape *shape, pls_vec3 X)
{
    const search s = search_of(shape, X);
    place start = {.value = 0.0};
    if (gauge_normal(&s, start.w) < 0.0) return highest_inside(&s);
    climb(&s, 3.0, &start);
    return start;
}

static double sdf(const pls_shape *shape, pls_vec3 X) { return find_normal(shape, X).value - shape->values[ROUNDING]; }

static double margin(const pls_shape *shape) { return shape->values[ROUNDING]; }

static pls_vec3 gradient(const pls_shape *shape, pls_vec3 X)
{
    place at = find_normal(shape, X);
    return pls_vec(copysign(at.n[0], X.x), copysign(at.n[1], X.y), copysign(at.n[2], X.z));
}

/// |x|_p of two non-negative numbers and its derivatives.
static double norm(double x, double y, double p, double slope[2])
{
    const double most = fmax(x, y), less = fmin(x, y);
    slope[0] = slope[1] = 0.0;
    if (most == 0.0) return 0.0;
    const double ratio = less / most, power = pow(ratio, p), sum = 1.0 + power, root = pow(sum, 1.0 / p);
    const int larger = x >= y ? 0 : 1;
    slope[larger] = root / sum;
    slope[1 - larger] = ratio > 0.0 ? power / ratio * root / sum : 0.0;
    return most * root;
}

/// The norm whose unit ball it is, less 1: in closed form. Of a rounded one there is only the distance.
static double level(const pls_shape *shape, pls_vec3 X, pls_vec3 *slope)
{
    const double *v = shape->values;
    if (v[ROUNDING] > 0.0)
    {
        place at = find_normal(shape, X);
        *slope = pls_vec(copysign(at.n[0], X.x), copysign(at.n[1], X.y), copysign(at.n[2], X.z));
        return at.value - v[ROUNDING];
    }
    double flat[2], high[2] = {1.0, 0.0}, all = norm(fabs(X.x) / v[0], fabs(X.y) / v[1], 2.0 / v[EAST_WEST], flat);
    if (shape->dimension == 3) all = norm(all, fabs(X.z) / v[2], 2.0 / v[NORTH_SOUTH], high);
    *slope = pls_vec(copysign(high[0] * flat[0] / v[0], X.x), copysign(high[0] * flat[1] / v[1], X.y),
                     shape->dimension == 3 ? copysign(high[1] / v[2], X.z) : 0.0);
    return all - 1.0;
}

// ---- support ------------------------------------------------------------------------------------------------------------------------------------------------

static double products_at(const pls_shape *shape, pls_vec3 n, double least, double size[3], double product[3], double curve[3][3])
{
    const double w[3] = {fabs(n.x), fabs(n.y), fabs(n.z)};
    double logs[3];
    const search s = search_of(shape, n);
    for (int i = 0; i < 3; ++i) size[i] = fmax(w[i], least), logs[i] = log(size[i]);
    return support_products(&s, logs, product, curve);
}

static pls_vec3 support(const pls_shape *shape, pls_vec3 n)
{
    double size[3], product[3], curve[3][3];
    products_at(shape, n, 1e-290, size, product, curve);
    return pls_vec(n.x != 0.0 ? copysign(product[0] / size[0], n.x) : 0.0, n.y != 0.0 ? copysign(product[1] / size[1], n.y) : 0.0,
                   n.z != 0.0 && shape->dimension == 3 ? copysign(product[2] / size[2], n.z) : 0.0);
}

/// Where a component of n is 0 the surface is flat (exponent below 1) and the derivative infinite: it is taken 1e-8 beside.
static void support_gradient(const pls_shape *shape, pls_vec3 n, double derivative[6])
{
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    const double sign[3] = {copysign(1.0, n.x), copysign(1.0, n.y), copysign(1.0, n.z)};
    double size[3], product[3], curve[3][3];
    products_at(shape, n, 1e-8, size, product, curve);
    for (int k = 0; k < 6; ++k)
    {
        int i = row[k], j = column[k];
        bool used = i < shape->dimension && j < shape->dimension;
        derivative[k] = used ? sign[i] * sign[j] * curve[i][j] / (size[i] * size[j]) : 0.0;
    }
}

/// The largest A x + B y with x^(1/e) + y^(1/e) = 1 (squares of coordinates): a dual norm, for e >= 1 the larger of both.
static double most_of(double A, double B, double e)
{
    double most = fmax(A, B), less = fmin(A, B);
    return e < 1.0 ? most * pow(1.0 + pow(less / most, 1.0 / (1.0 - e)), 1.0 - e) : most;
}

static double bounding_radius(const pls_shape *shape)
{
    const double *v = shape->values;
    double square = most_of(v[0] * v[0], v[1] * v[1], v[EAST_WEST]);
    if (shape->dimension == 3) square = most_of(square, v[2] * v[2], v[NORTH_SOUTH]);
    return (sqrt(square) + v[ROUNDING]) * (1.0 + 1e-14);
}

static void bounds(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper)
{
    const double *v = shape->values, r = v[ROUNDING];
    *upper = pls_vec(v[0] + r, v[1] + r, shape->dimension == 2 ? 0.0 : v[2] + r);
    *lower = pls_scale(*upper, -1.0);
}

// ---- mass ---------------------------------------------------------------------------------------------------------------------------------------------------

static double beta_function(double x, double y) { return exp(lgamma(x) + lgamma(y) - lgamma(x + y)); }

/// Integral of 1 or x^2 over the superellipse of half axes 1 (Dirichlet).
static double ellipse_moment(double epsilon, double power)
{
    double p = 0.5 * epsilon;
    return 4.0 * p * p * exp(lgamma((power + 1.0) * p) + lgamma(p) - lgamma((power + 2.0) * p + 1.0));
}

/// Closed form, see Jaklic, Leonardis and Solina, "Segmentation and recovery of superquadrics" (2000), chapter 2.
static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    const double *v = shape->values, a = v[0], b = v[1], c = v[2], e1 = v[NORTH_SOUTH], e2 = v[EAST_WEST];
    if (v[ROUNDING] > 0.0) return pls_mass_by_quadrature(shape, pls_vec(0.0, 0.0, 0.0), bounding_radius(shape) * (1.0 + 1e-9), out);
    *out = (pls_mass_properties){0};
    if (shape->dimension == 2)
    {
        out->volume = a * b * ellipse_moment(e2, 0.0);
        out->inertia[2] = a * b * (a * a + b * b) * ellipse_moment(e2, 2.0);
        return PLS_OK;
    }
    double scale = 2.0 * a * b * c * e1 * e2;
    double side = 0.25 * scale * beta_function(1.5 * e2, 0.5 * e2) * beta_function(0.5 * e1, 2.0 * e1 + 1.0);
    double xx = a * a * side, yy = b * b * side;
    double zz = c * c * scale * beta_function(0.5 * e2, 0.5 * e2 + 1.0) * beta_function(1.5 * e1, e1 + 1.0);
    out->volume = scale * beta_function(0.5 * e1 + 1.0, e1) * beta_function(0.5 * e2, 0.5 * e2);
    out->inertia[0] = yy + zz;
    out->inertia[1] = xx + zz;
    out->inertia[2] = xx + yy;
    return PLS_OK;
}

const pls_shape_ops pls_superquadric_shape = {
    .api_version = PLS_API_VERSION,
    .name = "superquadric",
    .meaning = "a superquadric, between box, ellipsoid and bipyramid; in 2D a superellipse",
    .parameters = parameters,
    .in_2d = true,
    .in_3d = true,
    .convex = true, // up to exponents of 2
    .smooth = true,
    .sdf = sdf,
    .gradient = gradient,
    .level = level,
    .support = support,
    .support_gradient = support_gradient,
    .margin = margin,
    .bounding_radius = bounding_radius,
    .bounds = bounds,
    .mass_properties = mass_properties,
};
