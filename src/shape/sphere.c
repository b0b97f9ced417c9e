// sphere.c -- the sphere, in 2D the disc: phi(X) = |X| - R  (P1 eq. 25)

#include "shape/builtin.h"

static const pls_parameter parameters[] = {
    {.name = "radius",
     .unit = "m",
     .meaning = "radius",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = NULL},
};

static double sdf(const pls_shape *shape, pls_vec3 X) { return pls_length(X) - shape->values[0]; }

static pls_vec3 gradient(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    double length = pls_length(X);
    return length > 0.0 ? pls_scale(X, 1.0 / length) : pls_vec(1.0, 0.0, 0.0);
}

/// A step towards the centre, at most to it.
static pls_vec3 proximal(const pls_shape *shape, pls_vec3 X, double step)
{
    (void)shape;
    double length = pls_length(X);
    return pls_scale(X, length > step ? 1.0 - step / length : 0.0);
}

// A point with a margin.
static double margin(const pls_shape *shape) { return shape->values[0]; }

static pls_vec3 support(const pls_shape *shape, pls_vec3 n)
{
    (void)shape;
    (void)n;
    return pls_vec(0.0, 0.0, 0.0);
}

static void support_gradient(const pls_shape *shape, pls_vec3 n, double derivative[6])
{
    (void)shape;
    (void)n;
    for (int k = 0; k < 6; ++k) derivative[k] = 0.0;
}

static const pls_polytope *polytope(const pls_shape *shape)
{
    static const pls_vec3 centre = {0.0, 0.0, 0.0};
    static const pls_polytope point = {.vertex = &centre, .vertex_count = 1};
    (void)shape;
    return &point;
}

static double bounding_radius(const pls_shape *shape) { return shape->values[0]; }

static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    double r = shape->values[0];
    *out = (pls_mass_properties){.volume = shape->dimension == 2 ? M_PI * r * r : 4.0 / 3.0 * M_PI * r * r * r};
    double moment = (shape->dimension == 2 ? 0.5 : 0.4) * out->volume * r * r;
    out->inertia[2] = moment;
    if (shape->dimension == 3) out->inertia[0] = out->inertia[1] = moment;
    return PLS_OK;
}

#define ANSWERS                                                                                                                 \
    .api_version = PLS_API_VERSION, .parameters = parameters, .convex = true, .smooth = true, .sdf = sdf, .gradient = gradient, \
    .proximal = proximal, .support = support, .support_gradient = support_gradient, .margin = margin, .polytope = polytope,     \
    .bounding_radius = bounding_radius, .mass_properties = mass_properties

const pls_shape_ops pls_sphere_shape = {
    .name = "sphere",
    .meaning = "a sphere; in 2D a disc",
    .in_2d = true,
    .in_3d = true,
    ANSWERS,
};

const pls_shape_ops pls_disc_shape = {
    .name = "disc",
    .meaning = "a disc: a sphere in 2D",
    .in_2d = true,
    ANSWERS,
};
