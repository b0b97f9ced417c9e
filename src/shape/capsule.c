// capsule.c -- the capsule, in 2D the stadium: all points within `radius` of a segment on the x axis.
//
// The core is a polytope of two vertices without faces, the radius is the margin.

#include "shape/builtin.h"

#include "base/alloc.h"

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
     .meaning = "length of the segment, along x: the whole is longer by two radii",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = NULL},
};

typedef struct segment
{
    pls_vec3 end[2];
    uint32_t neighbour_start[3], neighbour[2];
    pls_polytope polytope;
} segment;

static double radius_of(const pls_shape *shape) { return shape->values[0]; }
static double half_of(const pls_shape *shape) { return 0.5 * shape->values[1]; }

static pls_status prepare(const pls_shape_input *input, int dimension, void **data)
{
    (void)dimension;
    segment *s = NULL;
    PLS_TRY(pls_allocate(&s, 1, sizeof *s, "a capsule"));
    for (uint32_t k = 0; k < 2; ++k)
    {
        s->end[k] = pls_vec((k == 0 ? -0.5 : 0.5) * input->values[1], 0.0, 0.0);
        s->neighbour_start[k] = k;
        s->neighbour[k] = 1 - k;
    }
    s->neighbour_start[2] = 2;
    s->polytope = (pls_polytope){.vertex = s->end, .vertex_count = 2, .neighbour_start = s->neighbour_start, .neighbour = s->neighbour};
    *data = s;
    return PLS_OK;
}

static void release(void *data) { pls_release(&data); }

static const pls_polytope *polytope(const pls_shape *shape) { return &((const segment *)shape->data)->polytope; }

static double margin(const pls_shape *shape) { return radius_of(shape); }

static pls_vec3 support(const pls_shape *shape, pls_vec3 n) { return pls_vec(copysign(half_of(shape), n.x), 0.0, 0.0); }

/// From the nearest point of the segment to X.
static pls_vec3 from_segment(const pls_shape *shape, pls_vec3 X)
{
    double h = half_of(shape);
    return pls_vec(X.x - fmin(fmax(X.x, -h), h), X.y, X.z);
}

static double sdf(const pls_shape *shape, pls_vec3 X) { return pls_length(from_segment(shape, X)) - radius_of(shape); }

static pls_vec3 gradient(const pls_shape *shape, pls_vec3 X)
{
    pls_vec3 d = from_segment(shape, X);
    double length = pls_length(d);
    return length > 0.0 ? pls_scale(d, 1.0 / length) : pls_vec(0.0, 1.0, 0.0);
}

/// phi is a distance less a constant: a step back, at most to the segment.
static pls_vec3 proximal(const pls_shape *shape, pls_vec3 X, double step)
{
    pls_vec3 d = from_segment(shape, X);
    double length = pls_length(d);
    return pls_sub(X, length > step ? pls_scale(d, step / length) : d);
}

static double bounding_radius(const pls_shape *shape) { return half_of(shape) + radius_of(shape); }

static void bounds(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper)
{
    double r = radius_of(shape);
    *upper = pls_vec(half_of(shape) + r, r, shape->dimension == 2 ? 0.0 : r);
    *lower = pls_scale(*upper, -1.0);
}

/// The straight part and a ball (2D: disc) cut in two, its halves apart.
static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    double r = radius_of(shape), h = half_of(shape);
    *out = (pls_mass_properties){0};
    if (shape->dimension == 2)
    {
        out->volume = 4.0 * r * h + M_PI * r * r;
        out->inertia[2] = 4.0 / 3.0 * r * h * (h * h + r * r) + pls_disc_apart(h, r) + 0.25 * M_PI * pow(r, 4.0);
        return PLS_OK;
    }
    double straight = 2.0 * h * M_PI * r * r;
    double xx = straight * h * h / 3.0 + pls_ball_apart(h, r), yy = 0.25 * straight * r * r + pls_ball_apart(0.0, r);
    out->volume = straight + 4.0 / 3.0 * M_PI * r * r * r;
    out->inertia[0] = 2.0 * yy;
    out->inertia[1] = out->inertia[2] = xx + yy;
    return PLS_OK;
}

const pls_shape_ops pls_capsule_shape = {
    .api_version = PLS_API_VERSION,
    .name = "capsule",
    .meaning = "a cylinder along x with half balls as ends; in 2D a stadium",
    .parameters = parameters,
    .in_2d = true,
    .in_3d = true,
    .convex = true,
    .prepare = prepare,
    .release = release,
    .sdf = sdf,
    .gradient = gradient,
    .support = support,
    .margin = margin,
    .polytope = polytope,
    .proximal = proximal,
    .bounding_radius = bounding_radius,
    .bounds = bounds,
    .mass_properties = mass_properties,
};
