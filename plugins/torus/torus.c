// torus.c -- a ring: the points within r of a circle of radius R in the x-y plane.
//
//     phi(X) = |(sqrt(x^2 + y^2) - R, z)| - r
//
// The signed distance is all that is said. The shape is not convex, and its centre of mass lies outside of it; volume 2 pi^2 R r^2, moments, bounds and contacts
// are found by the program; for a ring with R = 3 r to better than 1e-6.

#include <particls/plugin.h>

static const pls_parameter parameters[] = {
    {.name = "ring_radius",
     .unit = "m",
     .meaning = "R, from the centre to the middle of the tube",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "tube_radius",
     .unit = "m",
     .meaning = "r, smaller than R",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = NULL},
};
enum { RING, TUBE };

static pls_status prepare(const pls_shape_input *input, int dimension, void **data)
{
    (void)dimension;
    *data = NULL;
    if (input->values[TUBE] < input->values[RING]) return PLS_OK;
    return pls_fail(PLS_INVALID_ARGUMENT,
                    "torus: tube_radius is %g m, ring_radius %g m; a ring needs a tube that is thinner than the ring is wide",
                    input->values[TUBE], input->values[RING]);
}

static double sdf(const pls_shape *shape, pls_vec3 X)
{
    double across = sqrt(X.x * X.x + X.y * X.y) - shape->values[RING];
    return sqrt(across * across + X.z * X.z) - shape->values[TUBE];
}

static const pls_shape_ops torus = {
    .api_version = PLS_API_VERSION,
    .name = "torus",
    .meaning = "a ring: the points within tube_radius of a circle of ring_radius in the x-y plane",
    .parameters = parameters,
    .in_3d = true,
    .prepare = prepare,
    .sdf = sdf,
};

const uint32_t particls_plugin_api = PLS_API_VERSION;
pls_status particls_plugin(pls_plugin_host *host);
pls_status particls_plugin(pls_plugin_host *host) { return host->add_shape(host, &torus); }
