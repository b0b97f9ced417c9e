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

static double sdf(const double *values, pls_vec3 X) { return pls_length(X) - values[0]; }

static double bounding_radius(const double *values) { return values[0]; }

static pls_status mass_properties(const double *values, int dimension, pls_mass_properties *out)
{
    double r = values[0];
    if (dimension == 2)
    {
        out->volume = M_PI * r * r;
        out->inertia = pls_vec(0.0, 0.0, 0.5 * out->volume * r * r);
    }
    else
    {
        out->volume = 4.0 / 3.0 * M_PI * r * r * r;
        double moment = 0.4 * out->volume * r * r;
        out->inertia = pls_vec(moment, moment, moment);
    }
    return PLS_OK;
}

const pls_shape_ops pls_sphere_shape = {
    .api_version = PLS_API_VERSION,
    .name = "sphere",
    .meaning = "a sphere; in 2D a disc",
    .parameters = parameters,
    .in_2d = true,
    .in_3d = true,
    .sdf = sdf,
    .bounding_radius = bounding_radius,
    .mass_properties = mass_properties,
};
