// my_law.c -- a contact law of one's own; copy this file and change it.
//
//     cc $(particls plugin --cflags) -Wall -Wextra my_law.c -o my_law.so
//
// and in a scene, whose folder the path is relative to:
//
//     plugins: [./my_law.so]
//     contact:
//       - {between: [grain, grain], law: my_law, kn: 1000, ks: 500, friction: 0.3}
//
// As it stands this is the law `elastic`:
//
//     normal      Fn = kn delta                                       (P1 eq. 16)
//     shear       Fs = -ks s,  s' = v_t                               (P1 eq. 17)
//     Coulomb     Fs <- mu Fn Fs/|Fs|  where |Fs| > mu Fn             (P1 eq. 18)

#include <particls/plugin.h>

// 1. What the user may say beside `law: my_law`. The program checks ranges, prints the table in its reference and completes misspelt names.
//    A parameter without `initial` would default to 0; PLS_REQUIRED makes it compulsory. The table ends with a null name.
static const pls_parameter parameters[] = {
    {.name = "kn",
     .unit = "N/m",
     .meaning = "normal stiffness",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "ks", .unit = "N/m", .meaning = "shear stiffness", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "friction", .unit = "", .meaning = "Coulomb friction coefficient", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = NULL},
};

// 2. Names for the constants that the law works with, at most PLS_LAW_MAX_CONSTANTS.
enum {
    KN,     // [N/m]
    KS,     // [N/m]
    MU,     // friction
    INV_KS, // 1/ks, 0 without shear stiffness [m/N]
};

// 3. From parameters (in the order of the table) and the values of the two materials to constants. Called at the start and whenever a parameter changes
//    in time. What is wrong here is reported with the place in the scene: return pls_fail(PLS_INVALID_ARGUMENT, "my_law: ...").
static pls_status prepare(const double *values, const pls_material_values *a, const pls_material_values *b, double *constants)
{
    (void)a, (void)b; // for laws that need density, young_modulus or poisson_ratio
    constants[KN] = values[0];
    constants[KS] = values[1];
    constants[MU] = values[2];
    constants[INV_KS] = values[1] > 0.0 ? 1.0 / values[1] : 0.0;
    return PLS_OK;
}

// 4. The law, for a batch of touching contacts of this pair of materials. Called from several threads at once, so it keeps nothing of its own: what must live
//    from step to step is the tangential spring and `history`. One loop without `if` around writes is turned into vector code by the compiler.
//    All outputs must be set.
static void evaluate(const pls_law_batch *batch)
{
    const double *constants = batch->constants;
    const double kn = constants[KN], ks = constants[KS], mu = constants[MU], inv_ks = constants[INV_KS];
    for (size_t k = 0; k < batch->count; ++k)
    {
        double vx = batch->slip_velocity_x[k], vy = batch->slip_velocity_y[k], vz = batch->slip_velocity_z[k];
        double sx = batch->spring_x[k], sy = batch->spring_y[k], sz = batch->spring_z[k];

        double fn = kn * batch->delta[k];
        double fx = -(ks * sx), fy = -(ks * sy), fz = -(ks * sz);

        double cone = mu * fn, shear = sqrt(fx * fx + fy * fy + fz * fz);
        double factor = shear > cone ? cone / shear : 1.0;
        fx *= factor, fy *= factor, fz *= factor;

        // Where it slides, the spring becomes as long as the force allows.
        double nx = shear > cone ? -fx * inv_ks : sx, ny = shear > cone ? -fy * inv_ks : sy, nz = shear > cone ? -fz * inv_ks : sz;

        batch->normal_force[k] = fn;
        batch->shear_force_x[k] = fx;
        batch->shear_force_y[k] = fy;
        batch->shear_force_z[k] = fz;
        batch->spring_x[k] = nx;
        batch->spring_y[k] = ny;
        batch->spring_z[k] = nz;
        batch->damping_power[k] = 0.0;
        // Mean spring force of the step times the length cut from the spring: second order in dt, so that the energy book closes.
        batch->slip_work[k] =
            0.5 * ks *
            ((nx + sx - batch->dt * vx) * (sx - nx) + (ny + sy - batch->dt * vy) * (sy - ny) + (nz + sz - batch->dt * vz) * (sz - nz));
    }
}

// 5. Tangent stiffness and damping at a contact: the stable time step and the tangent operator are computed from them, so they must not be too small.
static void stiffness(const double *constants, const pls_contact_point *contact, pls_contact_stiffness *out)
{
    (void)contact; // for laws whose stiffness depends on the overlap
    *out = (pls_contact_stiffness){.kn = constants[KN], .kt = constants[KS], .cn = 0.0, .ct = 0.0};
}

// 6. Energy stored in the contact: it enters the energy book, whose total must stay constant.
static void energy(const double *constants, const pls_contact_point *contact, double *normal, double *shear)
{
    *normal = 0.5 * constants[KN] * contact->delta * contact->delta;
    *shear = 0.5 * constants[KS] * contact->spring_squared;
}

static const pls_law_ops my_law = {
    .api_version = PLS_API_VERSION,
    .name = "my_law", // 7. the name in the scene
    .meaning = "linear springs with friction, the template of a plugin",
    .parameters = parameters,
    .prepare = prepare,
    .evaluate = evaluate,
    .stiffness = stiffness,
    .energy = energy,
    // .history = 1          numbers kept per contact: batch->history[0][k], zero when a contact begins
    // .needs_effective      true to have effective_radius and effective_mass filled in
};

// 8. What the program looks for in the shared object.
const uint32_t particls_plugin_api = PLS_API_VERSION;
pls_status particls_plugin(pls_plugin_host *host);
pls_status particls_plugin(pls_plugin_host *host) { return host->add_law(host, &my_law); }
