// stokes_drag.c -- the drag of a viscous fluid on small slow spheres.
//
//     F = -6 pi eta r (v - u),   T = -8 pi eta r^3 omega                 Stokes 1851, Kirchhoff 1876
//
// eta is the viscosity, u the velocity of the fluid, which does not turn; r the bounding radius, so for other shapes than spheres this is an estimate from above.
// Holds for Reynolds numbers rho |v - u| 2 r / eta well below one. A sphere falls at last with m g / (6 pi eta r), reached as 1 - exp(-t/tau), tau = m / (6 pi eta r).
// The step must stay well below tau; the program's estimate of the stable step knows of contacts only.

#include <particls/plugin.h>

static const pls_parameter parameters[] = {
    {.name = "viscosity", .unit = "Pa s", .meaning = "eta of the fluid", .initial = PLS_REQUIRED, .minimum = 0.0, .maximum = INFINITY},
    {.name = "flow",
     .unit = "m/s",
     .meaning = "velocity u of the fluid",
     .initial = 0.0,
     .minimum = -INFINITY,
     .maximum = INFINITY,
     .components = 3},
    {.name = NULL},
};

enum { SLIDING, TURNING, UX, UY, UZ }; // constants

static pls_status prepare(const double *values, int dimension, double *constants)
{
    static const double pi = 3.14159265358979323846;
    (void)dimension;
    constants[SLIDING] = 6.0 * pi * values[0];
    constants[TURNING] = 8.0 * pi * values[0];
    for (int a = 0; a < 3; ++a) constants[UX + a] = values[1 + a];
    return PLS_OK;
}

static pls_status evaluate(void *context, const pls_force_batch *b)
{
    (void)context;
    const double ux = b->constants[UX], uy = b->constants[UY], uz = b->constants[UZ];
    for (size_t k = 0; k < b->count; ++k)
    {
        double r = b->radius[k], slow = b->constants[SLIDING] * r, brake = b->constants[TURNING] * r * r * r;
        if (isinf(r)) continue; // walls
        b->force_x[k] -= slow * (b->vx[k] - ux);
        b->force_y[k] -= slow * (b->vy[k] - uy);
        b->force_z[k] -= slow * (b->vz[k] - uz);
        b->torque_x[k] -= brake * b->wx[k];
        b->torque_y[k] -= brake * b->wy[k];
        b->torque_z[k] -= brake * b->wz[k];
    }
    return PLS_OK;
}

static const pls_force_ops stokes_drag = {
    .api_version = PLS_API_VERSION,
    .name = "stokes_drag",
    .meaning = "drag of a viscous fluid on small slow spheres",
    .parameters = parameters,
    .prepare = prepare,
    .evaluate = evaluate,
};

const uint32_t particls_plugin_api = PLS_API_VERSION;
pls_status particls_plugin(pls_plugin_host *host);
pls_status particls_plugin(pls_plugin_host *host) { return host->add_force(host, &stokes_drag); }
