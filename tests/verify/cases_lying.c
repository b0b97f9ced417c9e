// cases_lying.c -- capsules and cylinders that lie along a line or stand on an end: rest, rocking, slopes, the energy book.
//
// With the deepest point alone the force jumps from one end to the other at every step: nothing comes to rest, and the energy book drifts without end.
#include "support/numbers.h"
#include "verify/cases.h"

static const double pi = 3.14159265358979323846;

static const double gravity = 10.0, kn = 1e4, radius = 0.2, length = 0.8;

enum lying { CAPSULE, CYLINDER, ROUNDED_CYLINDER, CAPSULE_ON_BOX, SOAP_ON_BOX, CYLINDER_ON_BOX, STANDING_ON_BOX, LYING };

static const char *name_of(enum lying kind)
{
    static const char *const name[LYING] = {"capsule",
                                            "cylinder",
                                            "rounded cylinder",
                                            "capsule on a box",
                                            "rounded box on a box",
                                            "cylinder on a box",
                                            "cylinder that stands on a box"};
    return name[kind];
}

/// A world with a floor at z = 0, and a body that lies along x or stands, its lowest point `gap` above, leaning by `tilt`, with a spin about y.
static verify_scene lay(enum lying kind, double gap, double tilt, double spin, double dt, const verify_value *values, pls_body_id *id)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    def.coordination = 2;
    verify_scene scene = verify_open(&def, "viscoelastic", values);
    const bool on_box = kind >= CAPSULE_ON_BOX, stands = kind == STANDING_ON_BOX;
    const bool along_z = kind == CYLINDER || kind == ROUNDED_CYLINDER || kind >= CYLINDER_ON_BOX; // the shape's own axis
    pls_shape_id shape;
    if (kind == CAPSULE || kind == CAPSULE_ON_BOX)
        shape = verify_add_shape(&scene, "capsule", NUMBERS(radius, length));
    else if (along_z)
        shape = verify_add_shape(&scene, "cylinder", NUMBERS(radius, length, kind == ROUNDED_CYLINDER ? 0.05 : 0.0));
    else
        shape = verify_add_shape(&scene, "box", NUMBERS(0.5 * length, radius, radius, 0.05));
    if (on_box)
    {
        pls_body_def box = verify_body_def(&scene, verify_add_shape(&scene, "box", NUMBERS(15.0, 1.0, 0.5, 0.0)), pls_vec(0, 0, -0.5));
        box.motion.axes = PLS_AXIS_ALL;
        verify_add(&scene, &box);
    }
    else
        verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    const double turn = tilt + (along_z && !stands ? 0.5 * pi : 0.0), lean = sin(fabs(tilt));
    const double height = stands ? 0.5 * length * cos(tilt) + radius * lean : radius + 0.5 * length * lean;
    pls_body_def body = verify_body_def(&scene, shape, pls_vec(0, 0, height + gap));
    body.orientation = (pls_quat){cos(0.5 * turn), 0.0, sin(0.5 * turn), 0.0};
    body.angular_velocity = pls_vec(0.0, spin, 0.0);
    *id = verify_add(&scene, &body);
    return scene;
}

/// Until what stands has stopped rocking, which dashpots brake less by far than the roll of what lies.
static int steps_to_rest(enum lying kind) { return kind == STANDING_ON_BOX ? 160000 : 40000; }

/// Let go with one end up, it comes to rest and stays, and the book closes.
static void settle(verify_sheet *sheet, enum lying kind)
{
    const verify_value damped[] = {{"kn", kn}, {"ks", 0.8 * kn}, {"cn", 5.0}, {"cs", 5.0}, {"friction", 0.3}, {NULL, 0.0}};
    const int settling = steps_to_rest(kind), steps = sheet->thorough ? 200000 : 10000;
    pls_body_id id;
    verify_scene scene = lay(kind, 1e-4, 0.02, 0.0, 1e-4, damped, &id);
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -gravity)));
    MUST(pls_world_prepare(scene.world));
    const double start = verify_total_energy(scene.world);
    MUST(pls_world_run(scene.world, (uint64_t)settling));
    const double book = verify_total_energy(scene.world);
    const pls_body_motion rests = verify_motion(scene.world, id);
    MUST(pls_world_run(scene.world, (uint64_t)steps));
    const pls_body_motion now = verify_motion(scene.world, id);
    sheet_below(sheet, verify_figures(scene.world).energy_kinetic / start, 1e-20, "%s: kinetic energy at rest, of all at the start",
                name_of(kind));
    sheet_below(sheet, pls_length(pls_sub(now.position, rests.position)), 1e-12, "%s: drift in %d steps [m]", name_of(kind), steps);
    sheet_below(sheet, book / start - 1.0, 1e-4, "%s: relative error of the energy book until it rests", name_of(kind));
    sheet_below(sheet, verify_total_energy(scene.world) / book - 1.0, 1e-12, "%s: and what comes to it at rest in %d steps", name_of(kind),
                steps);
    verify_close(&scene);
}

/// Largest relative error of the energy while it rocks from end to end and jumps, without damping and friction.
static double clatter_error(enum lying kind, double dt, int steps)
{
    const verify_value elastic[] = {{"kn", kn}, {"ks", 0.0}, {"cn", 0.0}, {"cs", 0.0}, {"friction", 0.0}, {NULL, 0.0}};
    enum { LOOKS = 100 };
    pls_body_id id;
    verify_scene scene = lay(kind, 1e-3, 0.02, 0.0, dt, elastic, &id);
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -gravity)));
    MUST(pls_world_prepare(scene.world));
    const double start = verify_total_energy(scene.world);
    double error = 0.0;
    for (int k = 0; k < LOOKS; ++k)
    {
        MUST(pls_world_run(scene.world, (uint64_t)(steps / LOOKS)));
        error = fmax(error, fabs(verify_total_energy(scene.world) / start - 1.0));
    }
    verify_close(&scene);
    return error;
}

static void clatter(verify_sheet *sheet, enum lying kind)
{
    enum { LEVELS = 3 };
    const int phases = sheet->thorough ? 8 : 3, steps = sheet->thorough ? 200000 : 10000;
    double dt[LEVELS], mean[LEVELS];
    for (int level = 0; level < LEVELS; ++level)
    {
        dt[level] = 1e-4 / (1 << level), mean[level] = 0.0;
        for (int k = 0; k < phases; ++k) // errors depend on where in a step touch begins
            mean[level] += clatter_error(kind, dt[level] * (1.0 + 0.003 * k), 5000 << level) / phases;
    }
    sheet_below(sheet, clatter_error(kind, dt[0], steps), 2e-4, "%s, no damping: relative error of the energy in %d steps", name_of(kind),
                steps);
    sheet_below(sheet, fmax(0.0, 2.0 - fitted_order(LEVELS, dt, mean)), 0.4,
                "%s, no damping: what the order in dt of the error in 0.5 s lacks of two", name_of(kind));
}

/// Pressed down by its weight a capsule has t = d + phi s along the line, delta = d + 2 phi^2 L^2/12/d: kn delta^2/2 has the stiffness kn L^2/3 against rocking.
static void rock(verify_sheet *sheet)
{
    const verify_value elastic[] = {{"kn", kn}, {"ks", 0.0}, {"cn", 0.0}, {"cs", 0.0}, {"friction", 0.0}, {NULL, 0.0}};
    const double straight = pi * radius * radius * length, ball = 4.0 / 3.0 * pi * pow(radius, 3), mass = straight + ball, h = 0.5 * length;
    const double moment = straight * (0.25 * radius * radius + h * h / 3.0) + ball * (0.4 * radius * radius + h * h + 0.75 * h * radius);
    const double depth = mass * gravity / kn, rate = sqrt(kn * length * length / 3.0 / moment), dt = 1e-5;
    pls_body_id id;
    verify_scene scene = lay(CAPSULE, -depth, 0.0, 1e-3 * depth / length * rate, dt, elastic, &id);
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -gravity)));
    enum { PERIODS = 10 };
    double first = 0.0, last = 0.0, spin = verify_motion(scene.world, id).angular_velocity.y;
    int passed = 0;
    for (int step = 1; passed <= PERIODS && step < 1000000; ++step)
    {
        MUST(pls_world_run(scene.world, 1));
        const double now = verify_motion(scene.world, id).angular_velocity.y;
        if (spin < 0.0 && now >= 0.0)
        {
            const double time = (step - 1 + spin / (spin - now)) * dt;
            *(passed == 0 ? &first : &last) = time;
            ++passed;
        }
        spin = now;
    }
    verify_close(&scene);
    sheet_relative(sheet, 2.0 * pi * PERIODS / (last - first), rate, 2e-5, "capsule rocks from end to end with sqrt(kn L^2/(3 I)) [rad/s]");
}

/// Its axis down a slope of tan(angle) = 0.98 mu it stays; at 1.02 mu it slides with g (sin - mu cos).
static void slide(verify_sheet *sheet, enum lying kind)
{
    const verify_value rough[] = {{"kn", kn}, {"ks", 0.8 * kn}, {"cn", 5.0}, {"cs", 5.0}, {"friction", 0.3}, {NULL, 0.0}};
    const double dt = 1e-4;
    const int steps = sheet->thorough ? 100000 : 20000;
    for (int k = 0; k < 2; ++k)
    {
        const double angle = atan((k ? 1.02 : 0.98) * 0.3);
        pls_body_id id;
        verify_scene scene = lay(kind, -1e-5, 0.0, 0.0, dt, rough, &id);
        MUST(pls_world_add_gravity(scene.world, pls_vec(gravity * sin(angle), 0, -gravity * cos(angle))));
        MUST(pls_world_run(scene.world,
                           (uint64_t)(k == 0 && kind == STANDING_ON_BOX ? steps_to_rest(kind) : steps))); // the box is 30 m long
        const pls_body_motion early = verify_motion(scene.world, id);
        MUST(pls_world_run(scene.world, (uint64_t)steps));
        const pls_body_motion late = verify_motion(scene.world, id);
        const double exact = gravity * (sin(angle) - 0.3 * cos(angle));
        if (k)
            sheet_relative(sheet, (late.velocity.x - early.velocity.x) / (steps * dt), exact, 1e-5,
                           "%s along a slope of 1.02 mu: it slides with g (sin - mu cos) [m/s^2]", name_of(kind));
        else
            sheet_below(sheet, late.position.x - early.position.x, 1e-9, "%s along a slope of 0.98 mu: it stays, moved in %d steps [m]",
                        name_of(kind), steps);
        sheet_below(sheet, late.position.y, 1e-9, "%s along a slope: it strays sideways by [m]", name_of(kind));
        verify_close(&scene);
    }
}

void case_lying(verify_sheet *sheet)
{
    for (enum lying kind = 0; kind < LYING; ++kind) settle(sheet, kind);
    for (enum lying kind = 0; kind < LYING; ++kind) clatter(sheet, kind);
    rock(sheet);
    for (enum lying kind = 0; kind < LYING; ++kind) slide(sheet, kind);
}
