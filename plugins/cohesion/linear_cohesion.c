// linear_cohesion.c -- springs and dashpots with a constant cohesive force while grains touch.
//
//     normal      Fn = kn delta + cn v_n - f0
//     shear       Fs = -ks s - cs v_t,  s' = v_t
//     Coulomb     |Fs| <= mu |Fn + f0|        friction is that of the repulsive part, so that cohesion holds grains without lubricating them
//
// f0 acts from the first touch to the last, delta > 0, on the way in as on the way out: without dashpots the force has the potential 1/2 kn delta^2 - f0 delta, and no
// energy is made or lost. Grains rest at delta = f0/kn; a quasi-static pull parts them at the force f0, and it takes the energy f0^2/(2 kn).
// The force jumps by f0 at the first touch, so energy is kept to first order in dt there, not to second.
// f0 must not be large against what keeps overlaps small: f0/kn well below the radius.

#include <particls/plugin.h>

static const pls_parameter parameters[] = {
    {.name = "kn",
     .unit = "N/m",
     .meaning = "normal stiffness",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "ks", .unit = "N/m", .meaning = "shear stiffness", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "cn", .unit = "N s/m", .meaning = "normal damping", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "cs", .unit = "N s/m", .meaning = "shear damping", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "friction", .unit = "", .meaning = "Coulomb friction coefficient", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "cohesion",
     .unit = "N",
     .meaning = "force f0 that holds touching grains together",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = NULL},
};

enum { KN, KS, CN, CS, MU, F0, INV_KS };

static pls_status prepare(const double *values, const pls_material_values *a, const pls_material_values *b, double *constants)
{
    (void)a, (void)b;
    for (int k = KN; k <= F0; ++k) constants[k] = values[k]; // same order
    constants[INV_KS] = values[KS] > 0.0 ? 1.0 / values[KS] : 0.0;
    return PLS_OK;
}

static void evaluate(const pls_law_batch *batch)
{
    const double *c = batch->constants;
    const double kn = c[KN], ks = c[KS], cn = c[CN], cs = c[CS], mu = c[MU], cohesion = c[F0], inv_ks = c[INV_KS];
    for (size_t k = 0; k < batch->count; ++k)
    {
        double vn = batch->normal_velocity[k];
        double vx = batch->slip_velocity_x[k], vy = batch->slip_velocity_y[k], vz = batch->slip_velocity_z[k];
        double sx = batch->spring_x[k], sy = batch->spring_y[k], sz = batch->spring_z[k];

        double repulsion = kn * batch->delta[k] + cn * vn;
        double fx = -(ks * sx) - cs * vx, fy = -(ks * sy) - cs * vy, fz = -(ks * sz) - cs * vz;

        double cone = mu * fabs(repulsion), shear = sqrt(fx * fx + fy * fy + fz * fz);
        double factor = shear > cone ? cone / shear : 1.0;
        fx *= factor, fy *= factor, fz *= factor;
        // Where it slides, spring and dashpot together carry what friction allows.
        double nx = shear > cone ? -(fx + cs * vx) * inv_ks : sx, ny = shear > cone ? -(fy + cs * vy) * inv_ks : sy,
               nz = shear > cone ? -(fz + cs * vz) * inv_ks : sz;

        batch->normal_force[k] = repulsion - cohesion;
        batch->shear_force_x[k] = fx;
        batch->shear_force_y[k] = fy;
        batch->shear_force_z[k] = fz;
        batch->spring_x[k] = nx;
        batch->spring_y[k] = ny;
        batch->spring_z[k] = nz;
        batch->damping_power[k] = cn * vn * vn + cs * (vx * vx + vy * vy + vz * vz);
        batch->slip_work[k] =
            0.5 * ks *
            ((nx + sx - batch->dt * vx) * (sx - nx) + (ny + sy - batch->dt * vy) * (sy - ny) + (nz + sz - batch->dt * vz) * (sz - nz));
    }
}

static void stiffness(const double *constants, const pls_contact_point *contact, pls_contact_stiffness *out)
{
    (void)contact;
    *out = (pls_contact_stiffness){.kn = constants[KN], .kt = constants[KS], .cn = constants[CN], .ct = constants[CS]};
}

/// Negative in a grain pair at rest: that much is needed to part it.
static void energy(const double *constants, const pls_contact_point *contact, double *normal, double *shear)
{
    *normal = (0.5 * constants[KN] * contact->delta - constants[F0]) * contact->delta;
    *shear = 0.5 * constants[KS] * contact->spring_squared;
}

static const pls_law_ops linear_cohesion = {
    .api_version = PLS_API_VERSION,
    .name = "linear_cohesion",
    .meaning = "linear springs and dashpots, friction, and a constant cohesive force while touching",
    .parameters = parameters,
    .prepare = prepare,
    .evaluate = evaluate,
    .stiffness = stiffness,
    .energy = energy,
};

const uint32_t particls_plugin_api = PLS_API_VERSION;
pls_status particls_plugin(pls_plugin_host *host);
pls_status particls_plugin(pls_plugin_host *host) { return host->add_law(host, &linear_cohesion); }
