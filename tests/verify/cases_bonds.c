// cases_bonds.c -- bonds: waves against the exact dispersion of the lattice, shear against its own sum, a bar in tension.
#include "verify/cases.h"

#include "support/lattice.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// ---- waves -----------------------------------------------------------------------------------------------------------------------------------------------------

/// w V with the partial volume, at reference length xi, of influence delta / xi.
static double weight_at(const lattice_plan *plan, double xi)
{
    const double part = 0.5 + (plan->horizon - xi) / plan->spacing;
    return plan->horizon / xi * pow(plan->spacing, 3) * fmin(part, 1.0);
}

/// rho omega^2 of a plane wave along k with polarisation p (an eigenvector): THEORY 5, the sum over a whole family of the cubic lattice.
static double exact_rate(const lattice_plan *plan, pls_vec3 k, pls_vec3 p)
{
    const int reach = (int)(plan->horizon / plan->spacing);
    double m = 0.0, direct = 0.0, b = 0.0;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            for (int z = -reach; z <= reach; ++z)
            {
                const pls_vec3 xi = pls_scale(pls_vec(x, y, z), plan->spacing);
                const double length = pls_length(xi);
                if (!(length > 0.0 && length <= plan->horizon)) continue;
                const double w = weight_at(plan, length), along = pls_dot(xi, p) / length;
                m += w * length * length;
                direct += w * along * along * (1.0 - cos(pls_dot(k, xi)));
                b += w * length * along * sin(pls_dot(k, xi));
            }
    return 30.0 * plan->shear / m * direct + (9.0 * plan->bulk - 15.0 * plan->shear) / (m * m) * b * b;
}

/// Frequency of a standing wave, from the time its amplitude takes to cross zero for the first time.
static double measured_rate(const lattice_plan *plan, pls_vec3 k, pls_vec3 p)
{
    lattice b = lattice_make(plan);
    const double speed = 1e-4;
    for (size_t n = 0; n < b.points; ++n)
        MUST(pls_body_set_velocity(b.scene.world, b.body[n], pls_scale(p, speed * cos(pls_dot(k, b.reference[n]))), pls_vec(0, 0, 0)));
    // Velocity from its greatest value to zero: a quarter of a period.
    double before = 0.0, now = INFINITY, time = 0.0;
    while (now > 0.0 && pls_world_step_number(b.scene.world) < 100000)
    {
        before = now;
        MUST(pls_step(b.scene.world));
        time = pls_world_time(b.scene.world);
        now = 0.0;
        for (size_t n = 0; n < b.points; ++n)
            now += pls_dot(verify_motion(b.scene.world, b.body[n]).velocity, p) * cos(pls_dot(k, b.reference[n]));
    }
    const double quarter = time - plan->dt * now / (now - before);
    lattice_free(&b);
    return 0.5 * pi / quarter;
}

void case_bond_dispersion(verify_sheet *sheet)
{
    static const struct
    {
        const char *name;
        int direction[3], across[3];
    } waves[] = {{"[100]", {1, 0, 0}, {0, 1, 0}}, {"[110]", {1, 1, 0}, {1, -1, 0}}, {"[111]", {1, 1, 1}, {1, -1, 0}}};
    const size_t lengths[] = {24, 12, 8};
    const int count = sheet->thorough ? 3 : 1;
    for (size_t d = 0; d < 3; ++d)
        for (int n = 0; n < count; ++n)
        {
            const size_t length = lengths[sheet->thorough ? n : 2];
            lattice_plan plan = lattice_default(3, 7);
            const pls_vec3 unit = pls_vec(waves[d].direction[0], waves[d].direction[1], waves[d].direction[2]);
            const pls_vec3 k = pls_scale(unit, 2.0 * pi / (plan.spacing * (double)length));
            plan.periodic = true;
            for (int a = 0; a < 3; ++a)
                if (waves[d].direction[a]) plan.count[a] = length;
            for (int across = 0; across < 2; ++across)
            {
                const int *along = across ? waves[d].across : waves[d].direction;
                const pls_vec3 p = pls_unit(pls_vec(along[0], along[1], along[2]));
                const double exact = sqrt(exact_rate(&plan, k, p) / plan.density);
                plan.dt = 0.5 * pi / exact / 400.0;
                sheet_relative(sheet, measured_rate(&plan, k, p), exact, 1e-3, "%s, %zu points per wave, %s: angular frequency [1/s]",
                               waves[d].name, length, across ? "transverse" : "longitudinal");
            }
        }
}

// ---- shear -----------------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 sheared(pls_vec3 X, const void *context) { return pls_vec(X.x + *(const double *)context * X.y, X.y, X.z); }

/// Energy of a point inside under a simple shear, summed from extensions.
static double shear_sum(const lattice_plan *plan, double gamma)
{
    const int reach = (int)(plan->horizon / plan->spacing + 1e-9);
    double m = 0.0, spread = 0.0, square = 0.0;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            for (int z = -reach; z <= reach; ++z)
            {
                const pls_vec3 xi = pls_scale(pls_vec(x, y, z), plan->spacing);
                const double length = pls_length(xi);
                if (!(length > 0.0 && length <= plan->horizon)) continue;
                const double e = pls_length(pls_vec(xi.x + gamma * xi.y, xi.y, xi.z)) - length, w = weight_at(plan, length);
                m += w * length * length;
                spread += w * length * e;
                square += w * e * e;
            }
    const double theta = 3.0 / m * spread;
    return 0.5 * ((3.0 * plan->bulk - 5.0 * plan->shear) / 3.0 * theta * theta + 15.0 * plan->shear / m * square);
}

void case_bond_shear(verify_sheet *sheet)
{
    const double ratios[] = {2.015, 3.015, 4.015, 6.015}, gamma = 1e-3;
    double last = 0.0;
    for (int n = 0; n < (sheet->thorough ? 4 : 2); ++n)
    {
        const size_t reach = (size_t)ratios[n], side = 4 * reach + 1; // the families of the middle one's partners are whole, too
        lattice_plan plan = lattice_default(3, side);
        plan.horizon = ratios[n] * plan.spacing;
        lattice b = lattice_make(&plan);
        lattice_deform(&b, sheared, &gamma);
        const size_t middle = lattice_at(&b, 2 * reach, 2 * reach, 2 * reach);
        const double inside = lattice_energy(&b, middle) / lattice_volume(&b), sum = shear_sum(&plan, gamma);
        sheet_relative(sheet, inside, sum, 1e-10, "horizon of %.3f spacings: energy of shear against the lattice's own sum [J/m^3]",
                       ratios[n]);
        last = sum / (0.5 * plan.shear * gamma * gamma);
        sheet_point(sheet, "shear", ratios[n], last, 1.0);
        lattice_free(&b);
    }
    sheet_relative(sheet, last, 1.0, sheet->thorough ? 0.02 : 0.07, "the sum of the largest, by mu gamma^2/2");
}

// ---- a bar -----------------------------------------------------------------------------------------------------------------------------------------------------

static struct
{
    double left, right, push, rate, mass; ///< ends [m], acceleration of the end layers [m/s^2], damping [1/s]
} pull;

static void pull_ends(double time, pls_vec3 x, pls_vec3 v, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)time, (void)body, (void)torque;
    const double a = x.x < pull.left ? -pull.push : x.x > pull.right ? pull.push : 0.0;
    *force = pls_scale(pls_vec(a - pull.rate * v.x, -pull.rate * v.y, -pull.rate * v.z), pull.mass);
}

/// Young's modulus of a bar of 40 x n x n points, pulled at its ends, from the strain of its middle half.
static double bar_modulus(size_t across, pls_correction correction, double ratio)
{
    lattice_plan plan = lattice_default(3, across);
    plan.count[0] = 40;
    plan.horizon = ratio * plan.spacing;
    plan.correction = correction;
    const double E = 9.0 * plan.bulk * plan.shear / (3.0 * plan.bulk + plan.shear), length = plan.spacing * 40.0,
                 speed = sqrt(E / plan.density);
    plan.dt = 0.25 * plan.spacing / sqrt((plan.bulk + 4.0 / 3.0 * plan.shear) / plan.density);
    lattice b = lattice_make(&plan);
    const verify_field field = {pull_ends, NULL};
    const double strain = 1e-4, layers = 3.0;
    pull.left = plan.spacing * (layers - 0.5), pull.right = plan.spacing * (40.0 - layers - 0.5);
    pull.push = strain * E / (layers * plan.spacing * plan.density); // the force of three layers is E A strain
    pull.rate = pi * speed / length;                                 // half of what is critical for the slowest mode
    pull.mass = plan.density * lattice_volume(&b);
    verify_add_field(b.scene.world, &field);
    MUST(pls_world_run(b.scene.world, (uint64_t)(20.0 / pull.rate / plan.dt)));
    double stretched[2] = {0.0, 0.0}; // mean displacement of the sections at a quarter and at three quarters
    for (size_t j = 0; j < across; ++j)
        for (size_t k = 0; k < across; ++k)
            for (size_t s = 0; s < 2; ++s)
            {
                const size_t n = lattice_at(&b, 10 + 20 * s - s, j, k);
                stretched[s] += (verify_motion(b.scene.world, b.body[n]).position.x - b.reference[n].x) / (double)(across * across);
            }
    const double found = (stretched[1] - stretched[0]) / (19.0 * plan.spacing);
    lattice_free(&b);
    return strain / found;
}

void case_bond_bar(verify_sheet *sheet)
{
    static const char *const names[] = {"no correction", "volume", "energy"};
    const double ratios[] = {2.015, 3.015, 4.015};
    const size_t across = 10; // some points have whole families
    for (int n = sheet->thorough ? 0 : 2; n < 3; ++n)
        for (int c = sheet->thorough ? 0 : PLS_CORRECTION_ENERGY; c < 3; ++c)
        {
            const double E = bar_modulus(across, (pls_correction)c, ratios[n]);
            sheet_relative(sheet, E, 1.0, c == PLS_CORRECTION_ENERGY && n == 2 ? 0.02 : 0.2,
                           "bar of 40 x %zu x %zu points, horizon of %.3f spacings, %s: F l/(E A) by its extension", across, across,
                           ratios[n], names[c]);
        }
}
