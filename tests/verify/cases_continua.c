// cases_continua.c -- peridynamic bodies against continuum mechanics and experiments: a hole, orders of convergence, cracks, energy over many steps.
#include "verify/cases.h"

#include "step/world.h"
#include "support/lattice.h"

#include <particls/scene.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// ---- a hole --------------------------------------------------------------------------------------------------------------------------------------------

/// A square of 8 radii around a hole of radius 1, in plane stress, pulled along x. Its rim is held where Kirsch's solution of the infinite plate is; all begins there, too, and comes to rest.
typedef struct plate
{
    verify_scene scene;
    pls_bonds_id bonds;
    size_t points, capacity;
    pls_vec3 *reference;
    pls_body_id *body;
    double spacing;
} plate;

static const double half_width = 4.0, young = 1.0, poisson = 0.3, pull = 1e-3; // [m], [Pa], [Pa]

static pls_vec3 kirsch(pls_vec3 X)
{
    const double mu = young / (2.0 * (1.0 + poisson)), kappa = (3.0 - poisson) / (1.0 + poisson), r = hypot(X.x, X.y), a = atan2(X.y, X.x);
    const double c = pull / (8.0 * mu), near = 1.0 / r, cube = near * near * near;
    return pls_vec(
        X.x + c * (r * (kappa + 1.0) * cos(a) + 2.0 * near * ((1.0 + kappa) * cos(a) + cos(3.0 * a)) - 2.0 * cube * cos(3.0 * a)),
        X.y + c * (r * (kappa - 3.0) * sin(a) + 2.0 * near * ((1.0 - kappa) * sin(a) + sin(3.0 * a)) - 2.0 * cube * sin(3.0 * a)), 0.0);
}

static void add_points(plate *p, pls_shape_id disc)
{
    const int across = (int)(2.0 * half_width / p->spacing + 0.5);
    p->capacity = (size_t)across * (size_t)across;
    p->reference = calloc(p->capacity, sizeof *p->reference);
    p->body = calloc(p->capacity, sizeof *p->body);
    for (int j = 0; j < across; ++j)
        for (int i = 0; i < across; ++i)
        {
            const pls_vec3 X = pls_vec(((double)i + 0.5) * p->spacing - half_width, ((double)j + 0.5) * p->spacing - half_width, 0.0);
            if (hypot(X.x, X.y) < 1.0) continue;
            const bool rim = fmax(fabs(X.x), fabs(X.y)) > half_width - 3.0 * p->spacing;
            pls_body_def def = verify_body_def(&p->scene, disc, X);
            def.mass = p->spacing * p->spacing;
            if (rim) def.motion.axes = PLS_AXIS_ALL;
            p->reference[p->points] = X;
            MUST(pls_world_add_body(p->scene.world, &def, &p->body[p->points++]));
        }
}

static plate make_plate(double spacing)
{
    plate p = {.spacing = spacing};
    pls_world_def def = pls_default_world_def(2);
    def.relaxation = true;
    def.coordination = 0;
    const verify_value law[] = {{"kn", 1e-6}, {NULL, 0.0}};
    p.scene = verify_open(&def, "elastic", law);
    MUST(pls_world_set_material_value(p.scene.world, p.scene.grain, "young_modulus", young));
    MUST(pls_world_set_material_value(p.scene.world, p.scene.grain, "poisson_ratio", poisson));
    const double radius = 0.5 * spacing;
    add_points(&p, verify_add_shape(&p.scene, "disc", &radius, 1));
    pls_bonds_def bonds = pls_default_bonds_def();
    snprintf(bonds.name, sizeof bonds.name, "plate");
    bonds.ops = pls_builtin_bonds()[0];
    bonds.horizon = 3.015 * spacing;
    bonds.plane = PLS_PLANE_STRESS; // no correction: what makes families of the hole's edge stiffer would add an error of its own
    MUST(pls_world_add_bonds(p.scene.world, &bonds, &p.bonds));
    for (size_t n = 0; n < p.points; ++n)
    {
        const pls_vec3 x = kirsch(p.reference[n]);
        pls_body_place *place = &p.scene.world->bodies.place[pls_body_row(p.scene.world, p.body[n])];
        place->x = x.x, place->y = x.y;
    }
    return p;
}

static void free_plate(plate *p)
{
    free(p->reference);
    free(p->body);
    verify_close(&p->scene);
}

/// Stress along x at points beside the ligament x = 0, y > 0: Hooke's law of the least-squares strain of all points within 2.1 spacings. A mean over so many points is as exact as the field is linear there.
static double stress_at(const plate *p, size_t at)
{
    double xx = 0.0, xy = 0.0, yy = 0.0, g[4] = {0};
    const pls_vec3 own = verify_motion(p->scene.world, p->body[at]).position;
    for (size_t n = 0; n < p->points; ++n)
    {
        const pls_vec3 d = pls_sub(p->reference[n], p->reference[at]);
        if (n == at || pls_length(d) > 2.1 * p->spacing) continue;
        const pls_vec3 u = pls_sub(pls_sub(verify_motion(p->scene.world, p->body[n]).position, own), d);
        xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
        g[0] += u.x * d.x, g[1] += u.x * d.y, g[2] += u.y * d.x, g[3] += u.y * d.y;
    }
    const double det = xx * yy - xy * xy, exx = (g[0] * yy - g[1] * xy) / det, eyy = (g[3] * xx - g[2] * xy) / det;
    return young / (1.0 - poisson * poisson) * (exx + poisson * eyy);
}

/// Fit of s0 + s2/y^2 + s4/y^4 to the stress over the ligament, from three spacings above the hole to three radii, and its value at the hole: there families are whole, nearer they are not.
static double concentration(const plate *p)
{
    double m[3][4] = {{0}};
    for (size_t n = 0; n < p->points; ++n)
    {
        const pls_vec3 X = p->reference[n];
        if (fabs(X.x) > p->spacing || X.y < 1.0 + 3.0 * p->spacing || X.y > 2.5) continue;
        const double s = stress_at(p, n) / pull, q = 1.0 / (X.y * X.y), f[4] = {1.0, q, q * q, s};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 4; ++j) m[i][j] += f[i] * f[j];
    }
    for (int i = 0; i < 3; ++i) // Gauss
        for (int k = i + 1; k < 3; ++k)
            for (int j = 3; j >= i; --j) m[k][j] -= m[k][i] / m[i][i] * m[i][j];
    double s[3];
    for (int i = 2; i >= 0; --i)
    {
        s[i] = m[i][3];
        for (int j = i + 1; j < 3; ++j) s[i] -= m[i][j] * s[j];
        s[i] /= m[i][i];
    }
    return s[0] + s[1] + s[2];
}

/// The stress of the point nearest to the hole above it, and where that is.
static double nearest_stress(const plate *p, double *y)
{
    size_t best = 0;
    *y = INFINITY;
    for (size_t n = 0; n < p->points; ++n)
        if (p->reference[n].x > 0.0 && p->reference[n].x < p->spacing && p->reference[n].y > 0.0 && p->reference[n].y < *y)
            best = n, *y = p->reference[n].y;
    return stress_at(p, best) / pull;
}

void case_hole(verify_sheet *sheet)
{
    const double per_radius[] = {8.0, 16.0, 32.0};
    double off[3];
    const int count = sheet->thorough ? 3 : 1;
    for (int k = 0; k < count; ++k)
    {
        plate p = make_plate(1.0 / per_radius[k]);
        MUST(pls_world_run(p.scene.world, (uint64_t)(120.0 * per_radius[k])));
        const double found = concentration(&p);
        double y;
        const double nearest = nearest_stress(&p, &y), theory = 1.0 + 0.5 / (y * y) + 1.5 / (y * y * y * y);
        off[k] = fabs(found / 3.0 - 1.0);
        sheet_relative(sheet, found, 3.0, k == 2 ? 0.05 : 0.2, "a hole of %g spacings in radius: stress concentration (Kirsch)",
                       per_radius[k]);
        sheet_relative(sheet, nearest, theory, 0.25, "the same, at its nearest point above the hole, as it is");
        sheet_point(sheet, "hole", per_radius[k], found, 3.0);
        free_plate(&p);
    }
    if (count == 3) sheet_below(sheet, off[2] / off[0], 0.5, "error of the finest by that of the coarsest");
}

// ---- orders --------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 sheared(pls_vec3 X, const void *context) { return pls_vec(X.x + *(const double *)context * X.y, X.y, X.z); }

/// Time in which a standing wave along x falls from its greatest velocity to none, as a frequency.
static double wave_rate(const lattice_plan *plan, double k)
{
    lattice b = lattice_make(plan);
    for (size_t n = 0; n < b.points; ++n)
        MUST(pls_body_set_velocity(b.scene.world, b.body[n], pls_vec(1e-5 * cos(k * b.reference[n].x), 0, 0), pls_vec(0, 0, 0)));
    double before = 0.0, now = INFINITY;
    while (now > 0.0 && pls_world_step_number(b.scene.world) < 100000)
    {
        before = now;
        now = 0.0;
        MUST(pls_step(b.scene.world));
        for (size_t n = 0; n < b.points; ++n) now += verify_motion(b.scene.world, b.body[n]).velocity.x * cos(k * b.reference[n].x);
    }
    const double quarter = pls_world_time(b.scene.world) - plan->dt * now / (now - before);
    lattice_free(&b);
    return 0.5 * pi / quarter;
}

/// m-convergence: more points in the same horizon. The lattice's shells come into it irregularly, so that the order is one of many sizes. delta-convergence: a smaller horizon of as many points.
void case_bond_orders(verify_sheet *sheet)
{
    const size_t reaches[2][4] = {{3, 5}, {3, 4, 5, 6}};
    const double gamma = 1e-4;
    double ratio[4], off[4];
    const int count = sheet->thorough ? 4 : 2;
    for (int n = 0; n < count; ++n)
    {
        const size_t reach = reaches[sheet->thorough][n]; // families of the middle and of its partners are whole
        lattice_plan plan = lattice_default(3, 4 * reach + 1);
        plan.spacing = 0.3 / (double)reach;
        plan.horizon = 0.3 * (1.0 + 0.005);
        lattice b = lattice_make(&plan);
        lattice_deform(&b, sheared, &gamma);
        ratio[n] = (double)reach;
        off[n] = fabs(lattice_energy(&b, lattice_at(&b, 2 * reach, 2 * reach, 2 * reach)) / lattice_volume(&b) /
                          (0.5 * plan.shear * gamma * gamma) -
                      1.0);
        sheet_point(sheet, "m-convergence", ratio[n], off[n], NAN);
        lattice_free(&b);
    }
    const double order = -fitted_order(count, ratio, off);
    sheet_absolute(sheet, order, 2.0, 1.0, "m-convergence: order of the energy of a shear, horizons of %g to %g spacings", ratio[0],
                   ratio[count - 1]);

    double spacing[3], slow[3];
    for (int n = 0; n < 3; ++n)
    {
        const size_t points = (size_t)8 << n;
        lattice_plan plan = lattice_default(3, 7);
        plan.periodic = true;
        plan.count[0] = points;
        const double k = 2.0 * pi / (plan.spacing * (double)points);
        // The classical speed of the lattice's own long waves; the wave's length in horizons is all that matters.
        const double local = k * sqrt((plan.bulk + 4.0 / 3.0 * plan.shear) / plan.density);
        plan.dt = 0.5 * pi / local / 400.0;
        spacing[n] = 1.0 / (double)points;
        slow[n] = wave_rate(&plan, k) / local;
        sheet_point(sheet, "delta-convergence", spacing[n], slow[n], 1.0);
    }
    const double richardson = log2((slow[1] - slow[0]) / (slow[2] - slow[1]));
    sheet_absolute(sheet, richardson, 2.0, 0.3, "delta-convergence: order of the speed of a wave of 8, 16, 32 spacings");
}

// ---- energy --------------------------------------------------------------------------------------------------------------------------------------------

/// A block that swings, none of its bonds breaking, over 1e5 steps.
void case_bond_energy(verify_sheet *sheet)
{
    static const char *const laws[] = {"linear_solid", "bond_based", "elastic_plastic", "viscoelastic_solid"};
    const uint64_t steps = sheet->thorough ? 100000 : 4000;
    for (int n = 0; n < 4; ++n)
    {
        lattice_plan plan = lattice_default(3, 5);
        plan.count[0] = 8;
        plan.law = laws[n];
        plan.shear = 0.6 * plan.bulk; // nu = 1/4
        plan.values[0] = n == 2 ? 0.02 : 0.5;
        plan.values[1] = n == 2 ? 0.5 : 0.2;
        plan.dt = 2e-3;
        lattice b = lattice_make(&plan);
        for (size_t p = 0; p < b.points; ++p)
            MUST(pls_body_set_velocity(
                b.scene.world, b.body[p],
                pls_vec(0.03 * sin(5.0 * b.reference[p].y), 0.03 * b.reference[p].x, 0.02 * cos(9.0 * b.reference[p].x)),
                pls_vec(0, 0, 0)));
        const double energy = verify_total_energy(b.scene.world);
        const pls_world_figures first = verify_figures(b.scene.world);
        double worst = 0.0;
        for (int look = 0; look < 20; ++look)
        {
            MUST(pls_world_run(b.scene.world, steps / 20));
            worst = fmax(worst, fabs(verify_total_energy(b.scene.world) / energy - 1.0));
        }
        const pls_world_figures last = verify_figures(b.scene.world);
        sheet_below(sheet, worst, 1e-3, "%s, %llu steps: error of the energy", laws[n], (unsigned long long)steps);
        sheet_below(sheet,
                    pls_length(pls_sub(last.momentum, first.momentum)) /
                        (first.energy_kinetic > 0.0 ? sqrt(2.0 * first.energy_kinetic * 0.4) : 1.0),
                    1e-12, "%s: error of the momentum, by that of the motion", laws[n]);
        sheet_below(sheet, pls_length(pls_sub(last.angular_momentum, first.angular_momentum)), 1e-12,
                    "%s: error of the angular momentum [kg m^2/s]", laws[n]);
        lattice_free(&b);
    }
}

// ---- cracks --------------------------------------------------------------------------------------------------------------------------------------------

/// An example, with changes, ready to run.
typedef struct example
{
    pls_scene *scene;
    pls_world *world;
} example;

static example open_example(const char *name, const char *const *changes, size_t count)
{
    char path[512];
    example e;
    snprintf(path, sizeof path, "%s/examples/%s/scene.yaml", PLS_SOURCE_DIR, name);
    MUST(pls_scene_load(path, changes, count, &e.scene));
    MUST(pls_scene_build(e.scene, &e.world));
    MUST(pls_world_prepare(e.world));
    return e;
}

static void close_example(example *e)
{
    pls_world_destroy(e->world);
    pls_scene_free(e->scene);
}

static void run_to(example *e, double time)
{
    MUST(pls_world_run(e->world, (uint64_t)ceil((time - pls_world_time(e->world)) / pls_world_dt(e->world))));
}

/// Do something with each body of a group and its damage.
typedef void damaged(pls_vec3 x, double damage, void *context);
static void each_damaged(const example *e, const char *group, damaged *action, void *context)
{
    pls_field_view damage;
    size_t numbers;
    MUST(pls_world_body_field(e->world, "damage", &damage));
    const uint32_t *row_of = pls_world_rows_by_number(e->world, &numbers);
    const pls_group_id id = pls_world_find_group(e->world, group);
    for (pls_body_id body = pls_world_next_body(e->world, id, (pls_body_id){0}); body.index1;
         body = pls_world_next_body(e->world, id, body))
        action(verify_motion(e->world, body).position, pls_field_value(&damage, row_of[body.index1 - 1], 0), context);
}

/// Moments of the damage beyond a notch, above (side 1) or below.
typedef struct line
{
    double side, weight, x, y, xx, xy, yy, highest;
} line;

static void add_to_line(pls_vec3 x, double damage, void *context)
{
    line *l = context;
    const double y = l->side * x.y;
    if (damage < 0.3 || x.x < 0.05 || y < 0.027) return;
    l->weight += damage;
    l->x += damage * x.x, l->y += damage * y, l->xx += damage * x.x * x.x, l->xy += damage * x.x * y, l->yy += damage * y * y;
    l->highest = fmax(l->highest, y);
}

/// Kalthoff and Winkler: the line of largest moment through the damage of either crack.
void case_kalthoff(verify_sheet *sheet)
{
    static const char *const spacings[] = {"vars.dx=0.2/300", "vars.dx=0.2/400"};
    for (int n = 0; n < (sheet->thorough ? 2 : 1); ++n)
    {
        example e = open_example("kalthoff-winkler", &spacings[n], 1);
        run_to(&e, 8.5e-5);
        for (int side = -1; side <= 1; side += 2)
        {
            line l = {.side = side};
            each_damaged(&e, "plate", add_to_line, &l);
            const double x = l.x / l.weight, y = l.y / l.weight, xx = l.xx / l.weight - x * x, xy = l.xy / l.weight - x * y,
                         yy = l.yy / l.weight - y * y;
            const double angle = 0.5 * atan2(2.0 * xy, xx - yy) * 180.0 / pi;
            sheet_absolute(sheet, angle < 0.0 ? angle + 180.0 : angle, 68.0, 5.0,
                           "%s, %s crack: angle against the notch [degrees] (Kalthoff and Winkler 1988)", spacings[n],
                           side < 0 ? "lower" : "upper");
            sheet_below(sheet, 0.1 - l.highest, 0.02, "%s: what is left of the plate above it [m]", spacings[n]);
        }
        close_example(&e);
    }
}

/// Furthest damage to the right: in all, and of either half by itself.
typedef struct tips
{
    double tip, upper, lower;
} tips;

static void find_tips(pls_vec3 x, double damage, void *context)
{
    tips *t = context;
    if (damage < 0.35) return;
    t->tip = fmax(t->tip, x.x);
    if (x.y > 0.003) t->upper = fmax(t->upper, x.x);
    if (x.y < -0.003) t->lower = fmax(t->lower, x.x);
}

/// Soda-lime glass under 2 MPa: the crack branches, and is nowhere faster than waves on its faces.
void case_branching(verify_sheet *sheet)
{
    const double E = 72e9, nu = 0.22, density = 2440.0,
                 rayleigh = (0.862 + 1.14 * nu) / (1.0 + nu) * sqrt(E / (2.0 * (1.0 + nu)) / density);
    example e = open_example("branching", NULL, 0);
    double before = 0.05, fastest = 0.0;
    const double look = 2e-6; // 4 mm at 2 km/s: eight points
    tips t = {0};
    for (double time = look; time < 4.5e-5; time += look)
    {
        t = (tips){0.05, 0.0, 0.0};
        run_to(&e, time);
        each_damaged(&e, "plate", find_tips, &t);
        fastest = fmax(fastest, (t.tip - before) / look);
        sheet_point(sheet, "branching", time, (t.tip - before) / look, rayleigh);
        before = t.tip;
    }
    sheet_below(sheet, fastest, rayleigh, "soda-lime glass, 2 MPa: the fastest the crack is [m/s], below Rayleigh's speed");
    sheet_absolute(sheet, t.upper, 0.09, 0.01, "the upper branch ends at x [m], near the right edge at 0.1 m");
    sheet_absolute(sheet, t.lower, t.upper, 0.004, "the lower branch ends at x [m]");
    close_example(&e);
}
