// cases_energy.c -- friction and its energy book: what kinetic, stored and dissipated energy add up to, and rolling with known answers.
#include "verify/cases.h"

#include "base/random.h"

static const double pi = 3.14159265358979323846;

// ---- oblique viscoelastic impacts that slide ----

/// Relative error of the energy book after an impact of two spheres with friction; `lateral`: offset of the centres along y.
static double impact_error(double dt, double phase, double slope, double lateral, double spin)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(
        &def, "viscoelastic", (const verify_value[]){{"kn", 1e4}, {"ks", 7e3}, {"cn", 10.0}, {"cs", 6.0}, {"friction", 0.3}, {NULL, 0.0}});
    double speed = 1.0, distance = sqrt(4.0 - lateral * lateral), gap = (1.0 + phase) * speed * dt;
    pls_body_def one = verify_ball_def(&scene, 1.0, 1.0, pls_vec(-distance - gap, lateral, 0), pls_vec(speed, 0, slope * speed));
    one.angular_velocity = pls_vec(spin, -spin, 0.5 * spin);
    verify_add(&scene, &one);
    verify_ball(&scene, 1.0, 1.5, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    MUST(pls_world_prepare(scene.world));
    double start = verify_total_energy(scene.world);
    bool touched = false;
    for (int k = 0; k < 1000000; ++k)
    {
        MUST(pls_step(scene.world));
        bool touches = pls_world_contact_count(scene.world) > 0;
        if (touched && !touches) break;
        touched = touched || touches;
    }
    double error = touched ? fabs(verify_total_energy(scene.world) / start - 1.0) : NAN;
    verify_close(&scene);
    return error;
}

void case_book_oblique(verify_sheet *sheet)
{
    const struct
    {
        const char *name;
        double slope, lateral, spin;
    } impacts[] = {
        {"sliding", 1.5, 0.0, 0.0}, {"sticking, then sliding", 0.3, 0.0, 0.0}, {"grazing", 0.5, 1.9, 0.0}, {"spinning", 0.5, 0.3, 3.0}};
    double duration = pi * sqrt(0.6 / 1e4);
    int levels = sheet->thorough ? 5 : 3, phases = sheet->thorough ? 40 : 12;
    for (int k = 0; k < 4; ++k)
    {
        double dt[5], mean[5];
        for (int level = 0; level < levels; ++level)
        {
            dt[level] = duration / (250 << level);
            mean[level] = 0.0;
            for (int j = 0; j < phases; ++j)
                mean[level] += impact_error(dt[level] * (1.0 + 0.01 * j / phases), (j + 0.5) / phases, impacts[k].slope, impacts[k].lateral,
                                            impacts[k].spin) /
                               phases;
            if (k == 0) sheet_point(sheet, "mean error of the energy book, sliding impact", dt[level] / duration, mean[level], NAN);
            if (level == 2) sheet_below(sheet, mean[level], 5e-6, "%s: mean relative error, dt = tc/1000", impacts[k].name);
        }
        sheet_absolute(sheet, fitted_order(levels, dt, mean), 2.0, 0.2, "%s: order in dt of the mean error", impacts[k].name);
    }
}

// ---- contacts under lasting pressure ----

// Two bodies are pulled towards the plane x = 0 and so against each other; the stronger pull towards the x axis keeps the pair from tipping over.
static void trap_force(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)time;
    (void)velocity;
    (void)body;
    (void)torque;
    *force = pls_vec(-20.0 * position.x, -60.0 * position.y, -60.0 * position.z);
}

static double trap_potential(pls_vec3 position, double mass)
{
    (void)mass;
    return 10.0 * position.x * position.x + 30.0 * (position.y * position.y + position.z * position.z);
}

typedef struct pressed
{
    const char *name;
    double friction, ks;
    bool dashpots;
    pls_vec3 velocity, spin_1, spin_2;
} pressed;

/// Largest error of the book in 4 s, relative to the energy at the start.
static double pressed_error(const pressed *p, int steps)
{
    static const verify_field trap = {trap_force, trap_potential};
    pls_world_def def = pls_default_world_def(3);
    def.dt = 4.0 / steps;
    const verify_value damped[] = {{"kn", 2000.0}, {"ks", p->ks}, {"cn", 3.0}, {"cs", 2.0}, {"friction", p->friction}, {NULL, 0.0}};
    const verify_value elastic[] = {{"kn", 2000.0}, {"ks", p->ks}, {"friction", p->friction}, {NULL, 0.0}};
    verify_scene scene = p->dashpots ? verify_open(&def, "viscoelastic", damped) : verify_open(&def, "elastic", elastic);
    pls_body_def one = verify_ball_def(&scene, 1.0, 1.0, pls_vec(-0.995, 0, 0), p->velocity);
    pls_body_def two = verify_ball_def(&scene, 1.0, 1.0, pls_vec(0.995, 0, 0), pls_scale(p->velocity, -1.0));
    one.angular_velocity = p->spin_1;
    two.angular_velocity = p->spin_2;
    verify_add(&scene, &one);
    verify_add(&scene, &two);
    verify_add_field(scene.world, &trap);
    MUST(pls_world_prepare(scene.world));
    double start = verify_total_energy(scene.world), error = 0.0;
    for (int k = 0; k < 40; ++k)
    {
        MUST(pls_world_run(scene.world, (uint64_t)(steps / 40)));
        error = fmax(error, fabs(verify_total_energy(scene.world) / start - 1.0));
    }
    verify_close(&scene);
    return error;
}

void case_book_pressed(verify_sheet *sheet)
{
    const pressed all[] = {
        {"grazing: sliding to and fro", 0.2, 1500.0, true, {0, 0.5, 0.2}, {0, 0, 0}, {0, 0, 0}},
        {"rolling on each other", 0.5, 1500.0, false, {0, 0, 0}, {0, 0, 1.0}, {0, 0, -1.0}},
        {"spinning together about the normal, spring loaded", 5.0, 1500.0, false, {0, 0.05, 0}, {3.0, 0, 0}, {3.0, 0, 0}},
        {"spinning against each other about the normal, spring loaded", 5.0, 1500.0, true, {0, 0.05, 0}, {3.0, 0, 0.2}, {-2.0, 0.1, 0}},
        {"grazing, sliding on a dashpot without a spring", 0.01, 0.0, true, {0, 0.5, 0.2}, {0, 0, 0}, {0, 0, 0}},
    };
    int levels = sheet->thorough ? 5 : 3;
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k)
    {
        double dt[5], error[5];
        for (int level = 0; level < levels; ++level)
        {
            dt[level] = 1.0 / (2000 << level);
            error[level] = pressed_error(&all[k], 2000 << level);
        }
        sheet_below(sheet, error[levels - 1], 2e-5, "%s: largest relative error, dt = 4 s/%d", all[k].name, 2000 << (levels - 1));
        sheet_below(sheet, fmax(0.0, 2.0 - fitted_order(levels, dt, error)), 0.2, "%s: what the order in dt lacks of two", all[k].name);
    }
}

// ---- rolling ----

static const verify_value rolling_law[] = {{"kn", 1e6}, {"ks", 1e6}, {"cn", 200.0}, {"cs", 20.0}, {"friction", 0.4}, {NULL, 0.0}};

/// Sphere (2D: disc) of radius 1 and mass 1 at rest under its weight `weight` on the plane with normal `up`.
static pls_body_id rest_on_plane(const verify_scene *scene, double weight, pls_vec3 up, pls_vec3 velocity, double *lever)
{
    double overlap = weight / 1e6;
    *lever = 1.0 - overlap / 2.0; // the contact point lies in the middle of the overlap
    pls_body_id id = verify_ball(scene, 1.0, 1.0, pls_scale(up, 1.0 - overlap), velocity);
    verify_wall(scene, pls_vec(0, 0, 0), up);
    return id;
}

void case_rolling(verify_sheet *sheet)
{
    for (int dimension = 3; dimension >= 2; --dimension)
    {
        double slope = 0.3, g = 10.0, lever, dt = 1e-4, inertia = dimension == 3 ? 0.4 : 0.5;
        pls_vec3 up = dimension == 3 ? pls_vec(0, 0, 1) : pls_vec(0, 1, 0);
        pls_world_def def = pls_default_world_def(dimension);
        def.dt = dt;
        verify_scene scene = verify_open(&def, "viscoelastic", rolling_law);
        pls_body_id id = rest_on_plane(&scene, g * cos(slope), up, pls_vec(0, 0, 0), &lever);
        MUST(pls_world_add_gravity(scene.world, pls_add(pls_vec(g * sin(slope), 0, 0), pls_scale(up, -g * cos(slope)))));
        MUST(pls_world_run(scene.world, 10000));
        double early = verify_motion(scene.world, id).velocity.x;
        MUST(pls_world_run(scene.world, sheet->thorough ? 100000 : 10000));
        pls_body_motion m = verify_motion(scene.world, id);
        double acceleration = (m.velocity.x - early) / (dt * (sheet->thorough ? 100000 : 10000));
        double exact = g * sin(slope) / (1.0 + inertia / (lever * lever));
        sheet_relative(sheet, acceleration, exact, 1e-9, "%s: acceleration down a slope of 0.3 rad, lever r - delta/2 [m/s^2]",
                       dimension == 3 ? "sphere" : "disc");
        sheet_relative(sheet, acceleration, g * sin(slope) * (dimension == 3 ? 5.0 / 7.0 : 2.0 / 3.0), 1e-5,
                       "%s: acceleration, %s g sin(alpha) [m/s^2]", dimension == 3 ? "sphere" : "disc", dimension == 3 ? "5/7" : "2/3");
        verify_close(&scene);
    }
}

void case_sliding_to_rolling(verify_sheet *sheet)
{
    double g = 10.0, lever, v0 = 2.0, mu = 0.4, dt = 1e-5, rolls = NAN, before = v0;
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(&def, "viscoelastic", rolling_law);
    pls_body_id id = rest_on_plane(&scene, g, pls_vec(0, 0, 1), pls_vec(v0, 0, 0), &lever);
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -g)));
    for (int k = 1; k <= 100000; ++k)
    {
        MUST(pls_step(scene.world));
        pls_body_motion m = verify_motion(scene.world, id);
        double slip = m.velocity.x - lever * m.angular_velocity.y;
        if (isnan(rolls) && slip <= 0.0) rolls = dt * (k - slip / (slip - before));
        before = slip;
        if (k % 200 == 0) sheet_point(sheet, "speed [m/s]", dt * k, m.velocity.x, fmax(v0 - mu * g * dt * k, 5.0 / 7.0 * v0));
    }
    pls_world_figures f = verify_figures(scene.world);
    pls_body_motion m = verify_motion(scene.world, id);
    verify_close(&scene);
    double share = lever * lever / 0.4; // m l^2/I
    sheet_relative(sheet, rolls, 2.0 * v0 / (7.0 * mu * g), 1e-4, "time until the slip velocity vanishes, 2 v0/(7 mu g) [s]");
    sheet_relative(sheet, m.velocity.x, v0 * share / (1.0 + share), 1e-9, "final speed, angular momentum about the contact point [m/s]");
    sheet_relative(sheet, m.velocity.x, 5.0 / 7.0 * v0, 1e-5, "final speed, 5/7 v0 [m/s]");
    sheet_relative(sheet, f.energy_slid + f.energy_damped, v0 * v0 / 7.0, 1e-4, "energy taken by friction, m v0^2/7 [J]");
}

// ---- a cloud ----

void case_cloud(verify_sheet *sheet)
{
    enum { COUNT = 500, SIDE = 8 };
    pls_world_def def = pls_default_world_def(3);
    def.dt = 5e-5;
    verify_scene scene =
        verify_open(&def, "elastic", (const verify_value[]){{"kn", 2000.0}, {"ks", 1500.0}, {"friction", 0.3}, {NULL, 0.0}});
    double turned = 0.0, moved = 0.0; // scales of the two momenta: sums of absolute values
    for (int k = 0; k < COUNT; ++k)
    {
        pls_random random = pls_random_stream(7, (uint64_t)k, PLS_FOR_USER);
        double radius = 0.16 * pow(3.0, pls_random_uniform(&random)), mass = 4.0 / 3.0 * pi * radius * radius * radius;
        pls_vec3 x = pls_vec(k % SIDE - 3.5, k / SIDE % SIDE - 3.5, k / (SIDE * SIDE) - 3.5), v = pls_scale(x, -1.5);
        v = pls_add(v, pls_vec(pls_random_normal(&random), pls_random_normal(&random) + 0.4 * x.x, pls_random_normal(&random)));
        pls_body_def ball = verify_ball_def(&scene, radius, mass, x, v);
        ball.angular_velocity = pls_vec(pls_random_normal(&random), pls_random_normal(&random), pls_random_normal(&random));
        moved += mass * pls_length(v);
        turned += mass * pls_length(v) * pls_length(x);
        verify_add(&scene, &ball);
    }
    MUST(pls_world_prepare(scene.world));
    pls_world_figures start = verify_figures(scene.world), now;
    double energy = verify_total_energy(scene.world), momentum_error = 0.0, angular_error = 0.0, energy_error = 0.0;
    size_t most = 0;
    int looks = sheet->thorough ? 100 : 20, steps = sheet->thorough ? 100000 : 10000;
    for (int k = 0; k < looks; ++k)
    {
        MUST(pls_world_run(scene.world, (uint64_t)(steps / looks)));
        now = verify_figures(scene.world);
        double book = verify_total_energy(scene.world) / energy - 1.0;
        momentum_error = fmax(momentum_error, pls_length(pls_sub(now.momentum, start.momentum)) / moved);
        angular_error = fmax(angular_error, pls_length(pls_sub(now.angular_momentum, start.angular_momentum)) / turned);
        energy_error = fmax(energy_error, fabs(book));
        most = now.touching > most ? now.touching : most;
        sheet_point(sheet, "relative error of the energy book", pls_world_time(scene.world), book, 0.0);
    }
    verify_close(&scene);
    sheet_below(sheet, momentum_error, 1e-12, "relative change of momentum in %d steps", steps);
    sheet_below(sheet, angular_error, 1e-12, "relative change of angular momentum in %d steps", steps);
    sheet_below(sheet, energy_error, 1e-4, "relative error of kinetic + stored + dissipated energy in %d steps", steps);
    sheet_below(sheet, 1.0 / (double)most, 0.01, "one over the most contacts at a time: the cloud does collide");
    sheet_below(sheet, now.energy_slid > 0.01 * energy ? 0.0 : 1.0, 0.5, "sliding took more than 1 %% of the energy (1: it did not)");
}
