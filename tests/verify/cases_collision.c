// cases_collision.c -- single impacts with closed solutions: contact time, energy, restitution, and friction by stick and slip.
//
// Impacts start at many phases of the time grid, because the law has a kink (with a dashpot a jump) at first touch whose error depends on where
// within a step it falls.
#include "verify/cases.h"

static const double pi = 3.14159265358979323846;

enum { PHASES = 20 };

static double phase_of(int k) { return (k + 0.5) / PHASES; }

/// Time step of phase k: about `duration`/`steps`, but never a whole fraction of it, so that the end of contact falls at any part of a step too.
static double step_of(double duration, int steps, int k)
{
    double golden = 0.61803398874989485 * (k + 1);
    return duration / (steps + golden - floor(golden));
}

// ---- head-on ----

typedef struct head_on
{
    double contact_time; ///< between the zero crossings of the overlap, which lie in free flight and so are exact [s]
    double restitution;  ///< speed ratio
} head_on;

typedef struct head_on_setup
{
    int dimension;
    double mass_1, mass_2, kn, cn, dt;
    double phase; ///< part of a step between the start and first touch
} head_on_setup;

static head_on collide_head_on(const head_on_setup *p)
{
    double m_eff = p->mass_1 * p->mass_2 / (p->mass_1 + p->mass_2), omega = sqrt(p->kn / m_eff), speed = 1e-2 * omega;
    double gap = (1.0 + p->phase) * speed * p->dt;
    pls_world_def def = pls_default_world_def(p->dimension);
    def.dt = p->dt;
    const verify_value damped[] = {{"kn", p->kn}, {"ks", p->kn}, {"cn", p->cn}, {"cs", 0.0}, {"friction", 0.5}, {NULL, 0.0}};
    const verify_value elastic[] = {{"kn", p->kn}, {"ks", p->kn}, {"friction", 0.5}, {NULL, 0.0}};
    verify_scene scene = p->cn > 0.0 ? verify_open(&def, "viscoelastic", damped) : verify_open(&def, "elastic", elastic);
    pls_body_id first = verify_ball(&scene, 1.0, p->mass_1, pls_vec(-1.0 - gap, 0, 0), pls_vec(speed, 0, 0));
    pls_body_id second = verify_ball(&scene, 1.0, p->mass_2, pls_vec(1.0, 0, 0), pls_vec(0, 0, 0));
    do MUST(pls_step(scene.world));
    while (pls_world_contact_count(scene.world) == 0);
    do MUST(pls_step(scene.world));
    while (pls_world_contact_count(scene.world) > 0);
    MUST(pls_step(scene.world)); // now in free flight
    pls_body_motion a = verify_motion(scene.world, first), b = verify_motion(scene.world, second);
    double speed_after = b.velocity.x - a.velocity.x, gap_after = b.position.x - a.position.x - 2.0;
    head_on result = {pls_world_time(scene.world) - gap_after / speed_after - gap / speed, speed_after / speed};
    verify_close(&scene);
    return result;
}

void case_contact_time(verify_sheet *sheet)
{
    const struct
    {
        int dimension;
        double mass_2;
    } pairs[] = {{3, 1.0}, {3, 5.0}, {2, 2.0}};
    for (int k = 0; k < 3; ++k)
    {
        double m_eff = pairs[k].mass_2 / (1.0 + pairs[k].mass_2), exact = pi * sqrt(m_eff / 1e4), worst = exact;
        for (int j = 0; j < PHASES; ++j)
        {
            head_on_setup p = {pairs[k].dimension, 1.0, pairs[k].mass_2, 1e4, 0.0, step_of(exact, 1000, j), phase_of(j)};
            double measured = collide_head_on(&p).contact_time;
            if (fabs(measured - exact) > fabs(worst - exact)) worst = measured;
        }
        sheet_relative(sheet, worst, exact, 1e-5, "%dD, mass ratio %g, dt = tc/1000, worst of %d phases [s]", pairs[k].dimension,
                       pairs[k].mass_2, PHASES);
    }
}

void case_elastic_energy(verify_sheet *sheet)
{
    double exact = pi * sqrt(0.5 / 1e4), steps[5], mean[5];
    int levels = sheet->thorough ? 5 : 3;
    for (int level = 0; level < levels; ++level)
    {
        double worst = 0.0, sum = 0.0;
        steps[level] = 250 << level;
        for (int j = 0; j < PHASES; ++j)
        {
            head_on_setup p = {3, 1.0, 1.0, 1e4, 0.0, step_of(exact, (int)steps[level], j), phase_of(j)};
            double e = collide_head_on(&p).restitution, change = fabs(e * e - 1.0);
            worst = fmax(worst, change);
            sum += change;
        }
        mean[level] = sum / PHASES;
        sheet_point(sheet, "mean energy change", 1.0 / steps[level], mean[level], NAN);
        if (steps[level] == 1000) sheet_below(sheet, worst, 5e-6, "relative energy change, dt = tc/1000, worst of %d phases", PHASES);
    }
    for (int level = 0; level < levels; ++level) steps[level] = 1.0 / steps[level];
    sheet_absolute(sheet, fitted_order(levels, steps, mean), 2.0, 0.1, "order in dt of the mean energy change");
}

/// Mean and worst restitution of all phases at about `steps` steps per contact. The dashpot's force begins and ends with a jump: a single impact is off by up
/// to 2 z w dt, at random; the mean of all phases is not.
static void restitution(double zeta, int steps, int ends, double exact, double *mean, double *worst)
{
    double kn = 1e4, m_eff = 0.5, duration = pi / (sqrt(kn / m_eff) * sqrt(1.0 - zeta * zeta));
    *mean = 0.0;
    *worst = exact;
    for (int j = 0; j < PHASES * ends; ++j) // every phase of the start with `ends` phases of the end
    {
        double dt = duration / (steps + (j / PHASES + 0.5) / ends);
        head_on_setup p = {3, 1.0, 1.0, kn, 2.0 * zeta * sqrt(kn * m_eff), dt, phase_of(j % PHASES)};
        double e = collide_head_on(&p).restitution;
        *mean += e / (PHASES * ends);
        if (fabs(e - exact) > fabs(*worst - exact)) *worst = e;
    }
}

void case_restitution(verify_sheet *sheet)
{
    const double ratios[] = {0.05, 0.1, 0.3};
    for (int k = 0; k < 3; ++k)
    {
        double zeta = ratios[k], exact = exp(-pi * zeta / sqrt(1.0 - zeta * zeta)), mean, worst;
        int steps = sheet->thorough ? 2000 : 1000;
        restitution(zeta, steps, sheet->thorough ? PHASES : 2, exact, &mean, &worst);
        sheet_relative(sheet, mean, exact, 1e-4, "z = %g, dt = tc/%d, mean of all phases", zeta, steps);
        if (sheet->thorough) sheet_relative(sheet, worst, exact, 1e-3, "z = %g, dt = tc/%d, worst phase", zeta, steps);
    }
}

// ---- oblique: linear springs with Coulomb friction, solved phase by phase ----
//
// While the bodies touch, Fn = kn v_n/w sin(w t). The slip velocity u of the contact point obeys m_t u' = -ks s with 1/m_t the sum over bodies of
// 1/m + r^2/I, where
//     stick   s' = u                               (an oscillator),       until ks |s| = mu Fn
//     slip    s = sign mu Fn/ks                    (a known force),       until sign u = mu Fn'/ks, when the spring could hold
// Lever arms are taken as r; the simulated ones are r - delta/2, so impacts are so gentle that delta/r = 1e-7: that
// also keeps the normal from turning when the tangential speed is large.

typedef struct impact
{
    double kn, ks, mu, m_eff, m_t, v_n;
} impact;

static double normal_force(const impact *p, double t)
{
    double omega = sqrt(p->kn / p->m_eff);
    return p->kn * p->v_n / omega * sin(omega * t);
}

static double normal_force_rate(const impact *p, double t) { return p->kn * p->v_n * cos(sqrt(p->kn / p->m_eff) * t); }

/// Stick or slip from time t0 on, state (s, u) there.
typedef struct phase
{
    bool slips;
    double t0, s0, u0, sign;
} phase;

static void state_in_phase(const impact *p, const phase *f, double t, double *s, double *u)
{
    if (f->slips)
    {
        double omega = sqrt(p->kn / p->m_eff), impulse = p->m_eff * p->v_n * (cos(omega * f->t0) - cos(omega * t));
        *s = f->sign * p->mu * normal_force(p, t) / p->ks;
        *u = f->u0 - f->sign * p->mu * impulse / p->m_t;
        return;
    }
    double omega = sqrt(p->ks / p->m_t), angle = omega * (t - f->t0);
    *s = f->s0 * cos(angle) + f->u0 / omega * sin(angle);
    *u = f->u0 * cos(angle) - f->s0 * omega * sin(angle);
}

/// Positive while the phase lasts.
static double phase_holds(const impact *p, const phase *f, double t)
{
    double s, u;
    state_in_phase(p, f, t, &s, &u);
    return f->slips ? f->sign * u - p->mu * normal_force_rate(p, t) / p->ks : p->mu * normal_force(p, t) - p->ks * fabs(s);
}

/// End of the phase, at most `end`.
static double phase_end(const impact *p, const phase *f, double end)
{
    enum { SAMPLES = 20000 };
    double h = end / SAMPLES;
    for (double t = f->t0 + h; t < end; t += h)
    {
        if (phase_holds(p, f, t) > 0.0) continue;
        double low = t - h, high = t;
        for (int k = 0; k < 80; ++k)
        {
            double middle = 0.5 * (low + high);
            *(phase_holds(p, f, middle) > 0.0 ? &low : &high) = middle;
        }
        return low;
    }
    return end;
}

/// Slip velocity at the end of contact; it began with u_0.
static double slip_after(const impact *p, double u_0)
{
    double end = pi * sqrt(p->m_eff / p->kn);
    phase f = {fabs(u_0) > p->mu * p->kn * p->v_n / p->ks, 0.0, 0.0, u_0, u_0 < 0.0 ? -1.0 : 1.0};
    for (int k = 0; k < 100; ++k)
    {
        double t = phase_end(p, &f, end), s, u;
        state_in_phase(p, &f, t, &s, &u);
        if (t >= end) return u;
        f = (phase){!f.slips, t, s, u, s < 0.0 ? -1.0 : 1.0};
    }
    return NAN;
}

/// One body of an impact. Mass infinite: the plane.
typedef struct impact_body
{
    double mass, inertia, radius;
} impact_body;

typedef struct oblique_result
{
    double tangential[2], spin[2], normal[2]; ///< velocities of each body along the tangent and the normal; spin [rad/s]
} oblique_result;

/// Body 0 comes down (-normal) with v_n and with `tangential` velocity and `spin`, body 1 rests. Normal is z (2D: y), tangent is x.
typedef struct oblique_setup
{
    int dimension;
    bool plane;
    impact_body body[2];
    double kn, ks, mu, v_n, tangential, spin, dt, phase;
} oblique_setup;

static impact impact_of(const oblique_setup *p)
{
    double normal = 0.0, slip = 0.0;
    for (int k = 0; k < (p->plane ? 1 : 2); ++k)
    {
        const impact_body *b = &p->body[k];
        normal += 1.0 / b->mass;
        slip += 1.0 / b->mass + b->radius * b->radius / b->inertia;
    }
    return (impact){p->kn, p->ks, p->mu, 1.0 / normal, 1.0 / slip, p->v_n};
}

static oblique_result solve_oblique(const oblique_setup *p)
{
    impact i = impact_of(p);
    // The spin axis is chosen so that a positive spin moves body 0's contact point along +x.
    double u_0 = p->tangential + p->spin * p->body[0].radius, impulse = i.m_t * (slip_after(&i, u_0) - u_0);
    oblique_result r = {{p->tangential + impulse / p->body[0].mass, 0.0},
                        {p->spin + impulse * p->body[0].radius / p->body[0].inertia, 0.0},
                        {-p->v_n + 2.0 * i.m_eff * p->v_n / p->body[0].mass, 0.0}};
    if (!p->plane)
    {
        r.tangential[1] = -impulse / p->body[1].mass;
        r.spin[1] = impulse * p->body[1].radius / p->body[1].inertia; // seen from body 1 the point lies on the other side
        r.normal[1] = -2.0 * i.m_eff * p->v_n / p->body[1].mass;
    }
    return r;
}

static oblique_result simulate_oblique(const oblique_setup *p)
{
    bool flat = p->dimension == 2;
    pls_vec3 n = flat ? pls_vec(0, 1, 0) : pls_vec(0, 0, 1), x = pls_vec(1, 0, 0);
    // w x (-r n) = spin r x:  with n = z, w = -spin y;  with n = y, w = spin z.
    pls_vec3 axis = flat ? pls_vec(0, 0, 1) : pls_vec(0, -1, 0);
    pls_world_def def = pls_default_world_def(p->dimension);
    def.dt = p->dt;
    verify_scene scene =
        verify_open(&def, "elastic", (const verify_value[]){{"kn", p->kn}, {"ks", p->ks}, {"friction", p->mu}, {NULL, 0.0}});
    double gap = (1.0 + p->phase) * p->v_n * p->dt;
    pls_body_id id[2];
    pls_body_def ball = verify_ball_def(&scene, p->body[0].radius, p->body[0].mass, pls_scale(n, p->body[0].radius + gap),
                                        pls_add(pls_scale(n, -p->v_n), pls_scale(x, p->tangential)));
    ball.angular_velocity = pls_scale(axis, p->spin);
    id[0] = verify_add(&scene, &ball);
    // Body 1 lies where body 0 will be at first touch.
    if (p->plane)
        id[1] = verify_wall(&scene, pls_vec(0, 0, 0), n);
    else
        id[1] = verify_ball(&scene, p->body[1].radius, p->body[1].mass,
                            pls_add(pls_scale(n, -p->body[1].radius), pls_scale(x, gap / p->v_n * p->tangential)), pls_vec(0, 0, 0));
    do MUST(pls_step(scene.world));
    while (pls_world_contact_count(scene.world) == 0);
    do MUST(pls_step(scene.world));
    while (pls_world_contact_count(scene.world) > 0);
    oblique_result r;
    for (int k = 0; k < 2; ++k)
    {
        pls_body_motion m = verify_motion(scene.world, id[k]);
        r.tangential[k] = pls_dot(m.velocity, x);
        r.normal[k] = pls_dot(m.velocity, n);
        r.spin[k] = pls_dot(m.angular_velocity, axis);
    }
    verify_close(&scene);
    return r;
}

/// Largest error of all velocities, surface velocities for spins, relative to the impact speed.
static double oblique_error(const oblique_setup *p, const oblique_result *a, const oblique_result *b)
{
    double error = 0.0;
    for (int k = 0; k < (p->plane ? 1 : 2); ++k)
    {
        error = fmax(error, fabs(a->tangential[k] - b->tangential[k]));
        error = fmax(error, fabs(a->normal[k] - b->normal[k]));
        error = fmax(error, fabs(a->spin[k] - b->spin[k]) * p->body[k].radius);
    }
    return error / hypot(p->v_n, p->tangential);
}

static void compare_angles(verify_sheet *sheet, oblique_setup p)
{
    double omega = sqrt(p.kn / impact_of(&p).m_eff), duration = pi / omega;
    const double coarse[] = {5, 20, 35, 50, 65, 80};
    int angles = sheet->thorough ? 43 : 6, phases = sheet->thorough ? 10 : 2;
    p.v_n = 1e-7 * p.body[0].radius * omega;
    for (int spinning = 0; spinning < 2; ++spinning)
        for (int k = 0; k < angles; ++k)
        {
            double angle = sheet->thorough ? 1.0 + 2.0 * k : coarse[k], worst = 0.0, mean_tangential = 0.0;
            p.tangential = p.v_n * tan(angle * pi / 180.0);
            p.spin = spinning ? -1.5 * p.v_n / p.body[0].radius : 0.0;
            oblique_result exact = solve_oblique(&p);
            for (int j = 0; j < phases; ++j)
            {
                p.phase = (j + 0.5) / phases;
                p.dt = step_of(duration, 1000, j);
                oblique_result measured = simulate_oblique(&p);
                worst = fmax(worst, oblique_error(&p, &measured, &exact));
                mean_tangential += measured.tangential[0] / phases;
            }
            if (!spinning) sheet_point(sheet, "tangential rebound / v_n", angle, mean_tangential / p.v_n, exact.tangential[0] / p.v_n);
            if (!sheet->thorough || k % 6 == 0)
                sheet_below(sheet, worst, 2e-5, "%g degrees%s, dt = tc/1000: velocities and spins, of the impact speed", angle,
                            spinning ? ", spinning" : "");
        }
}

void case_oblique_wall(verify_sheet *sheet)
{
    compare_angles(sheet, (oblique_setup){.dimension = 3, .plane = true, .body = {{1.0, 0.4, 1.0}, {0}}, .kn = 1e4, .ks = 7e3, .mu = 0.3});
}

void case_oblique_pair(verify_sheet *sheet)
{
    compare_angles(
        sheet,
        (oblique_setup){.dimension = 3, .body = {{1.0, 0.4, 1.0}, {5.0, 0.4 * 5.0 * 1.5 * 1.5, 1.5}}, .kn = 1e4, .ks = 8e3, .mu = 0.25});
}

void case_oblique_disc(verify_sheet *sheet)
{
    compare_angles(sheet, (oblique_setup){.dimension = 2, .plane = true, .body = {{2.0, 1.0, 1.0}, {0}}, .kn = 1e4, .ks = 5e3, .mu = 0.4});
}
