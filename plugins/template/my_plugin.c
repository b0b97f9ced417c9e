// my_plugin.c -- a contact law, a shape, a body force, an observer and a bond law of one's own; copy this file, delete what you do not need and change the rest.
//
//     cc $(particls plugin --cflags) -Wall -Wextra my_plugin.c -o my_plugin.so
//     particls info my_plugin.so
//
// and in a scene, whose folder the path is relative to:
//
//     plugins: [./my_plugin.so]
//     shapes: {bean: {my_shape: {length: 0.2, radius: 0.05}}}
//     contact:
//       - {between: [grain, grain], law: my_law, kn: 1000, ks: 500, friction: 0.3}
//     forces:
//       - {my_force: {stiffness: 20, centre: [0, 0, 1], bodies: pack}}
//     observe:
//       - {my_observer: {faster: 0.5}, every: 0.01}
//     bonds:
//       - {of: [plate], law: my_bond, horizon: 0.03, tension: 0.2}
//
// The program keeps everything, the functions nothing: they are called from several threads, and a run must go on after a restart as if it had never stopped.
// So no global variables that change, no static ones within functions, no random numbers, no clock.

#include <particls/plugin.h>

// ---- 1. a contact law ----------------------------------------------------------------------------------------------------------------
//
// As it stands this is the law `elastic`:
//
//     normal      Fn = kn delta                                       (P1 eq. 16)
//     shear       Fs = -ks s,  s' = v_t                               (P1 eq. 17)
//     Coulomb     Fs <- mu Fn Fs/|Fs|  where |Fs| > mu Fn             (P1 eq. 18)

// 1.1 What the user may say beside `law: my_law`. The program checks ranges, prints the table in its reference and completes misspelt names.
//    A parameter without `initial` would default to 0; PLS_REQUIRED makes it compulsory. The table ends with a null name.
static const pls_parameter law_parameters[] = {
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

// 1.2 Names for the constants that the law works with, at most PLS_LAW_MAX_CONSTANTS.
enum {
    KN,     // [N/m]
    KS,     // [N/m]
    MU,     // friction
    INV_KS, // 1/ks, 0 without shear stiffness [m/N]
};

// 1.3 From parameters (in the order of the table) and the values of the two materials to constants. Called at the start and whenever a parameter changes
//    in time. What is wrong here is reported with the place in the scene: return pls_fail(PLS_INVALID_ARGUMENT, "my_law: ...").
static pls_status law_prepare(const double *values, const pls_material_values *a, const pls_material_values *b, double *constants)
{
    (void)a, (void)b; // for laws that need density, young_modulus or poisson_ratio
    constants[KN] = values[0];
    constants[KS] = values[1];
    constants[MU] = values[2];
    constants[INV_KS] = values[1] > 0.0 ? 1.0 / values[1] : 0.0;
    return PLS_OK;
}

// 1.4 The law, for a batch of touching contacts of this pair of materials. Called from several threads at once, so it keeps nothing of its own: what must live
//    from step to step is the tangential spring and `history`. One loop without `if` around writes is turned into vector code by the compiler.
//    All outputs must be set.
static void law_evaluate(const pls_law_batch *batch)
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

// 1.5 Tangent stiffness and damping at a contact: the stable time step and the tangent operator are computed from them, so they must not be too small.
static void law_stiffness(const double *constants, const pls_contact_point *contact, pls_contact_stiffness *out)
{
    (void)contact; // for laws whose stiffness depends on the overlap
    *out = (pls_contact_stiffness){.kn = constants[KN], .kt = constants[KS], .cn = 0.0, .ct = 0.0};
}

// 1.6 Energy stored in the contact: it enters the energy book, whose total must stay constant.
static void law_energy(const double *constants, const pls_contact_point *contact, double *normal, double *shear)
{
    *normal = 0.5 * constants[KN] * contact->delta * contact->delta;
    *shear = 0.5 * constants[KS] * contact->spring_squared;
}

static const pls_law_ops my_law = {
    .api_version = PLS_API_VERSION,
    .name = "my_law", // 1.7 the name in the scene
    .meaning = "linear springs with friction, the law of the template",
    .parameters = law_parameters,
    .prepare = law_prepare,
    .evaluate = law_evaluate,
    .stiffness = law_stiffness,
    .energy = law_energy,
    // .history = 1          numbers kept per contact: batch->history[0][k], zero when a contact begins
    // .needs_effective      true to have effective_radius and effective_mass filled in
};

// ---- 2. a shape ----------------------------------------------------------------------------------------------------------------------
//
// As it stands, the points within `radius` of a segment of `length` along x: in 3D a capsule, in 2D a stadium.

// 2.1 What the user may say: `{my_shape: {length: 0.2, radius: 0.05}}`.
static const pls_parameter shape_parameters[] = {
    {.name = "length", .unit = "m", .meaning = "of the segment", .initial = PLS_REQUIRED, .minimum = 0.0, .maximum = INFINITY},
    {.name = "radius",
     .unit = "m",
     .meaning = "of its rounding",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = NULL},
};

// 2.2 The signed distance in the shape's own frame, negative inside. It must be the true distance outside; the program tries that before it starts. In 2D X.z = 0.
//     Volume, centre of mass, moments, bounds, contacts and pictures follow from it. A function of its own for each of them is faster or exact:
//     see pls_shape_ops in <particls/shape.h>.
static double shape_sdf(const pls_shape *shape, pls_vec3 X)
{
    double half = 0.5 * shape->values[0], radius = shape->values[1]; // in the order of the table
    double along = fmin(fmax(X.x, -half), half);
    return pls_length(pls_vec(X.x - along, X.y, X.z)) - radius;
}

static const pls_shape_ops my_shape = {
    .api_version = PLS_API_VERSION,
    .name = "my_shape",
    .meaning = "the points within a radius of a segment along x, the shape of the template",
    .parameters = shape_parameters,
    .in_2d = true,
    .in_3d = true,
    .convex = true, // 2.3 only if it is so with any numbers: contact is faster and surer then
    .sdf = shape_sdf,
    // .prepare              to check what the table cannot: return pls_fail(PLS_INVALID_ARGUMENT, "my_shape: ...")
    // .gradient, .support, .mass_properties, ...
};

// ---- 3. a body force -----------------------------------------------------------------------------------------------------------------
//
// As it stands, a spring between each body's centre of mass and a fixed point: F = -k (x - c), with the energy k |x - c|^2 / 2.

// 3.1 What the user may say: `{my_force: {stiffness: 20, centre: [0, 0, 1]}}`. A row with three components is a vector. In a scene a number may be an expression
//     over t and states ("20*(1 + sin(t))"). The key `bodies` beside them, which picks the bodies, is the program's.
static const pls_parameter force_parameters[] = {
    {.name = "stiffness", .unit = "N/m", .meaning = "k of the spring", .initial = PLS_REQUIRED, .minimum = 0.0, .maximum = INFINITY},
    {.name = "centre",
     .unit = "m",
     .meaning = "c, where the spring is fixed",
     .initial = 0.0,
     .minimum = -INFINITY,
     .maximum = INFINITY,
     .components = 3},
    {.name = NULL},
};
enum { K, CX, CY, CZ }; // 3.2 places in the array of values; the constants are the same as long as there is no `prepare`

// 3.3 Add to the forces and torques of a batch of bodies. Velocities are those at the same time as positions. Walls have infinite mass; what is added to them is dropped.
static pls_status force_evaluate(void *context, const pls_force_batch *batch)
{
    (void)context; // for C programs that add a force themselves
    const double k = batch->constants[K], cx = batch->constants[CX], cy = batch->constants[CY], cz = batch->constants[CZ];
    for (size_t b = 0; b < batch->count; ++b)
    {
        batch->force_x[b] -= k * (batch->x[b] - cx);
        batch->force_y[b] -= k * (batch->y[b] - cy);
        batch->force_z[b] -= k * (batch->z[b] - cz);
    }
    return PLS_OK;
}

// 3.4 Energy of one body, for the energy book. Leave it out if there is none.
static double force_potential(void *context, const pls_force_body *body)
{
    (void)context;
    const double *c = body->constants;
    pls_vec3 d = pls_sub(body->position, pls_vec(c[CX], c[CY], c[CZ]));
    return 0.5 * c[K] * pls_dot(d, d);
}

static const pls_force_ops my_force = {
    .api_version = PLS_API_VERSION,
    .name = "my_force",
    .meaning = "a spring from each body to a fixed point, the force of the template",
    .parameters = force_parameters,
    .evaluate = force_evaluate,
    .potential = force_potential,
    // .prepare              as that of a law, from values to constants
};

// ---- 4. an observer ------------------------------------------------------------------------------------------------------------------
//
// As it stands: how many bodies are faster than a limit, their mean speed, and the largest speed that was ever seen.

// 4.1 What the user may say: `{my_observer: {faster: 0.5}, every: 0.01}`. The keys `every`, `every_steps`, `start`, `end`, `name` and, in the map, `bodies` are the program's.
static const pls_parameter observer_parameters[] = {
    {.name = "faster", .unit = "m/s", .meaning = "only bodies faster than this", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = NULL},
};

// 4.2 Columns of series/my_observer.csv, behind the time. `only_3d = true` leaves one out of scenes in 2D. The table ends with a null name.
static const pls_observer_column columns[] = {
    {.name = "bodies", .unit = "", .meaning = "bodies that are faster than the limit"},
    {.name = "speed", .unit = "m/s", .meaning = "their mean speed"},
    {.name = "largest_speed", .unit = "m/s", .meaning = "of all looks so far"},
    {.name = NULL},
};

// 4.3 The world is there to be read: all functions of <particls/world.h> and <particls/observe.h> that take a `const pls_world *`. Bodies in order of their numbers,
//     so that sums have the same bits however the bodies lie in memory.
static pls_status speeds(const pls_observer_view *view, double *count, double *sum, double *largest)
{
    *count = *sum = *largest = 0.0;
    pls_body_id id = pls_world_next_body(view->world, view->group, (pls_body_id){0});
    for (; id.index1; id = pls_world_next_body(view->world, view->group, id))
    {
        pls_body_motion motion;
        PLS_TRY(pls_body_get(view->world, id, &motion));
        double speed = pls_length(motion.velocity);
        if (isinf(motion.mass) || !(speed > view->constants[0])) continue; // walls
        *count += 1.0;
        *sum += speed;
        *largest = fmax(*largest, speed);
    }
    return PLS_OK;
}

// 4.4 What is remembered from look to look: here one number, the largest speed. All zero before the first look; kept in checkpoints. Only this function changes it.
static pls_status observer_update(const pls_observer_view *view, double *memory)
{
    double count, sum, largest;
    PLS_TRY(speeds(view, &count, &sum, &largest));
    memory[0] = fmax(memory[0], largest);
    return PLS_OK;
}

// 4.5 One row, in the order of the columns. What is not set is NaN in the series.
static pls_status observer_look(const pls_observer_view *view, const double *memory, double *row)
{
    double count, sum, largest;
    PLS_TRY(speeds(view, &count, &sum, &largest));
    row[0] = count;
    row[1] = count > 0.0 ? sum / count : 0.0;
    row[2] = memory[0];
    return PLS_OK;
}

static const pls_observer_ops my_observer = {
    .api_version = PLS_API_VERSION,
    .name = "my_observer",
    .meaning = "how many bodies are fast, and how fast, the observer of the template",
    .parameters = observer_parameters,
    .columns = columns,
    .memory = 1, // 4.6 and `update`; leave out both if nothing is remembered
    .update = observer_update,
    .look = observer_look,
};

// ---- 5. a bond law ---------------------------------------------------------------------------------------------------------------------
//
// As it stands, independent springs between points of a continuum that are softer where they are stretched: masonry, ice full of cracks.
//
//     E_i = V_i b / (2 m_i) sum w beta V_j s e^2,     s = tension where e > 0, else 1

// 5.1 What the user may say beside `law: my_bond`; `horizon`, `influence`, `fracture_energy` and the like are the program's.
static const pls_parameter bond_parameters[] = {
    {.name = "tension",
     .unit = "",
     .meaning = "stiffness where stretched, by that where compressed",
     .initial = 0.5,
     .minimum = 0.0,
     .maximum = 1.0,
     .open_minimum = true},
    {.name = NULL},
};
enum { EXTENSION, TENSION }; // 5.2 constants, at most PLS_BOND_MAX_CONSTANTS

// 5.3 Coefficients of the law where it is stiffest: the stable step and the critical stretch follow from them. These are those of `bond_based`.
static pls_status bond_linear(const double *values, const pls_bond_setting *setting, pls_bond_coefficients *out)
{
    (void)values;
    const double E = setting->material.young_modulus, by_plane = setting->plane == PLS_PLANE_STRESS ? 3.0 : 3.2;
    if (!(E > 0.0)) return pls_fail(PLS_INVALID_ARGUMENT, "my_bond: the material needs a young_modulus [Pa]");
    *out = (pls_bond_coefficients){.dilation = 0.0, .extension = (setting->dimension == 3 ? 6.0 : by_plane) * E};
    return PLS_OK;
}

// 5.4 From parameters and material to constants.
static pls_status bond_prepare(const double *values, const pls_bond_setting *setting, double constants[PLS_BOND_MAX_CONSTANTS])
{
    pls_bond_coefficients law = {0.0, 0.0};
    PLS_TRY(bond_linear(values, setting, &law));
    constants[EXTENSION] = law.extension;
    constants[TENSION] = values[0];
    return PLS_OK;
}

// 5.5 The law: energy of a point's family and its derivatives by the extensions of its bonds. It is asked whenever forces or energies are; what it says must follow from extensions and memory alone.
static void bond_pull(const pls_family_batch *batch)
{
    const double b = batch->constants[EXTENSION] / batch->weighted, tension = batch->constants[TENSION];
    double energy = 0.0;
    for (size_t k = 0; k < batch->count; ++k)
    {
        const double e = batch->extension[k],
                     stiffness = b * batch->correction[k] * batch->weight[k] / batch->reference[k] * (e > 0.0 ? tension : 1.0);
        batch->tension[k] = stiffness * e;
        energy += 0.5 * stiffness * e * e;
    }
    *batch->energy = energy;
}

static const pls_bond_ops my_bond = {
    .api_version = PLS_API_VERSION,
    .name = "my_bond",
    .meaning = "springs that are softer in tension, the bond law of the template",
    .parameters = bond_parameters,
    .linear = bond_linear,
    .prepare = bond_prepare,
    .pull = bond_pull,
    // .memories, .advance   5.6 numbers kept per bond, and what brings them to the end of a step: flow, creep, fatigue
    // .pair, .stiffness     in place of linear and pull: bonds that turn with two bodies, as beams
};

// ---- 6. what the program looks for in the shared object --------------------------------------------------------------------------------

const uint32_t particls_plugin_api = PLS_API_VERSION;
pls_status particls_plugin(pls_plugin_host *host);
pls_status particls_plugin(pls_plugin_host *host)
{
    PLS_TRY(host->add_law(host, &my_law));
    PLS_TRY(host->add_shape(host, &my_shape));
    PLS_TRY(host->add_force(host, &my_force));
    PLS_TRY(host->add_bond(host, &my_bond));
    return host->add_observer(host, &my_observer);
}
