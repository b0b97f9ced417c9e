// test_force_states.c -- laws of families that remember: against plasticity and viscosity of the continuum on families that are isotropic, and in blocks that flow, relax and break.
#include "support/lattice.h"
#include "support/snapshot.h"

#include "base/random.h"
#include "bond/builtin.h"
#include "step/world.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const double pi = 3.14159265358979323846;

// ---- one family ----------------------------------------------------------------------------------------------------------------------------------------

/// Bonds to the corners of an icosahedron (2D: a hexagon): sums over them of up to four components of unit vectors are those over all directions, so that the law has its moduli exactly. Two of the sixteen
/// (eight) lanes fill up.
enum { LANES = 16 };

typedef struct family
{
    int dimension;
    size_t count; ///< bonds
    pls_vec3 unit[LANES];
    double constants[PLS_BOND_MAX_CONSTANTS];
    const pls_bond_ops *ops;
    double volume, weighted, stiffness, energy, spent;
    _Alignas(64) double reference[LANES], extension[LANES], weight[LANES],
        correction[LANES], tension[LANES], memory[PLS_BOND_MAX_MEMORY][LANES];
    double *memories[PLS_BOND_MAX_MEMORY], of_point[PLS_BOND_MAX_MEMORY];
} family;

static const double bulk = 3.0, shear = 1.3; // K, mu [Pa]

static family make_family(const pls_bond_ops *ops, int dimension, const double *values)
{
    const double golden = 0.5 * (1.0 + sqrt(5.0));
    const pls_vec3 corner[12] = {{0, 1, golden},  {0, -1, golden},  {0, 1, -golden}, {0, -1, -golden}, {1, golden, 0},  {-1, golden, 0},
                                 {1, -golden, 0}, {-1, -golden, 0}, {golden, 0, 1},  {golden, 0, -1},  {-golden, 0, 1}, {-golden, 0, -1}};
    family f = {.dimension = dimension, .count = dimension == 3 ? 12 : 6, .ops = ops, .volume = 0.7, .stiffness = 1.0};
    const pls_bond_setting setting = {.dimension = dimension,
                                      .plane = PLS_PLANE_STRAIN,
                                      .material = {.density = 1.0,
                                                   .young_modulus = 9.0 * bulk * shear / (3.0 * bulk + shear),
                                                   .poisson_ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))}};
    MUST(ops->prepare(values, &setting, f.constants));
    for (size_t k = 0; k < LANES; ++k)
    {
        const bool bond = k < f.count;
        f.unit[k] = !bond            ? pls_vec(1, 0, 0)
                    : dimension == 3 ? pls_unit(corner[k])
                                     : pls_vec(cos(pi / 3.0 * (double)k), sin(pi / 3.0 * (double)k), 0);
        f.reference[k] = 0.25;
        f.weight[k] = bond ? 0.04 : 0.0;
        f.correction[k] = 1.0;
        f.weighted += f.weight[k] * f.reference[k] / f.volume;
    }
    return f;
}

/// Extensions of a strain xx yy zz xy xz yz, a step of length dt, and the law's answer.
static void strain_family(family *f, const double strain[6], double dt)
{
    for (size_t k = 0; k < f->count; ++k)
    {
        const pls_vec3 n = f->unit[k];
        f->extension[k] = f->reference[k] * (strain[0] * n.x * n.x + strain[1] * n.y * n.y + strain[2] * n.z * n.z +
                                             2.0 * (strain[3] * n.x * n.y + strain[4] * n.x * n.z + strain[5] * n.y * n.z));
    }
    for (int k = 0; k < f->ops->memories; ++k) f->memories[k] = f->memory[k];
    f->spent = 0.0;
    const pls_family_batch batch = {.count = f->dimension == 3 ? 16 : 8,
                                    .dimension = f->dimension,
                                    .constants = f->constants,
                                    .volume = f->volume,
                                    .weighted = f->weighted,
                                    .reference = f->reference,
                                    .extension = f->extension,
                                    .weight = f->weight,
                                    .correction = f->correction,
                                    .memory = f->memories,
                                    .point_memory = f->of_point,
                                    .stiffness = f->stiffness,
                                    .step = dt,
                                    .tension = f->tension,
                                    .energy = &f->energy,
                                    .spent = &f->spent};
    if (dt > 0.0) f->ops->advance(&batch);
    f->ops->pull(&batch);
}

/// The stress that does the family's work: derivative of the energy by strain, per volume. xx yy zz xy xz yz.
static void stress_of(const family *f, double stress[6])
{
    memset(stress, 0, 6 * sizeof *stress);
    for (size_t k = 0; k < f->count; ++k)
    {
        const pls_vec3 n = f->unit[k];
        const double t = f->tension[k] * f->reference[k] / f->volume,
                     products[6] = {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
        for (int c = 0; c < 6; ++c) stress[c] += t * products[c];
    }
}

// ---- plasticity ------------------------------------------------------------------------------------------------------------------------------------------

/// Prandtl-Reuss with von Mises' yield and linear hardening, by tensors (radial return, Wilkins 1964; Simo and Hughes 1998, box 3.1).
typedef struct flow
{
    double plastic[6], grown, spent; ///< plastic strain; equivalent; work per volume
} flow;

static double square_of(const double s[6])
{
    double sum = 0.0;
    for (int c = 0; c < 6; ++c) sum += (c < 3 ? 1.0 : 2.0) * s[c] * s[c];
    return sum;
}

static void flow_step(flow *f, const double strain[6], double yield, double hardening, double stress[6])
{
    const double third = (strain[0] + strain[1] + strain[2]) / 3.0;
    double s[6];
    for (int c = 0; c < 6; ++c) s[c] = 2.0 * shear * (strain[c] - (c < 3 ? third : 0.0) - f->plastic[c]);
    const double q = sqrt(1.5 * square_of(s)), now = yield + hardening * f->grown;
    if (q > now)
    {
        const double grown = (q - now) / (3.0 * shear + hardening);
        for (int c = 0; c < 6; ++c)
        {
            f->plastic[c] += 1.5 * grown * s[c] / q;
            s[c] *= 1.0 - 3.0 * shear * grown / q;
        }
        f->grown += grown;
        f->spent += (now + 0.5 * hardening * grown) * grown;
    }
    for (int c = 0; c < 6; ++c) stress[c] = s[c] + (c < 3 ? 3.0 * bulk * third : 0.0);
}

/// A path that turns: tension, then torsion, then back, with all components.
static void path(int step, double strain[6])
{
    const double t = 0.01 * step;
    const double at[6] = {0.02 * sin(2.0 * t), -0.004 * t, 0.003 * t * t, 0.015 * sin(3.1 * t), 0.008 * t, -0.01 * sin(1.3 * t)};
    memcpy(strain, at, sizeof at);
}

static void flow_is_that_of_von_mises(void **state)
{
    (void)state;
    const double values[2] = {0.012, 0.2};
    family f = make_family(&pls_elastic_plastic_bonds, 3, values);
    flow oracle = {{0}, 0, 0};
    double spent = 0.0;
    for (int step = 0; step < 200; ++step)
    {
        double strain[6], expected[6], stress[6];
        path(step, strain);
        flow_step(&oracle, strain, values[0], values[1], expected);
        strain_family(&f, strain, 1e-3);
        stress_of(&f, stress);
        for (int c = 0; c < 6; ++c) assert_true(fabs(stress[c] - expected[c]) < 1e-13);
        spent += f.spent;
        assert_true(fabs(f.of_point[0] - oracle.grown) < 1e-13);
        assert_true(fabs(spent - f.volume * oracle.spent) < 1e-14);
    }
    assert_true(oracle.grown > 0.02); // it flowed
}

/// Asking again changes nothing: a restart computes what the run did.
static void asking_again_says_the_same(void **state)
{
    (void)state;
    const double values[2] = {0.012, 0.0};
    family f = make_family(&pls_elastic_plastic_bonds, 3, values);
    for (int step = 0; step < 150; ++step)
    {
        double strain[6];
        path(step, strain);
        strain_family(&f, strain, 1e-3);
        const family before = f;
        strain_family(&f, strain, 0.0);
        assert_memory_equal(before.tension, f.tension, sizeof f.tension);
        assert_true(before.energy == f.energy);
    }
}

/// In the plane: a shear flows at Y / sqrt 3, a dilation never.
static void flow_in_the_plane(void **state)
{
    (void)state;
    const double values[2] = {0.02, 0.0};
    family f = make_family(&pls_elastic_plastic_bonds, 2, values);
    double stress[6];
    for (int step = 1; step <= 100; ++step)
    {
        const double gamma = 2e-4 * step;
        strain_family(&f, (const double[6]){0.001 * step, 0.001 * step, 0, 0.5 * gamma, 0, 0}, 1e-3);
        stress_of(&f, stress);
        assert_true(fabs(stress[3] - fmin(shear * gamma, values[0] / sqrt(3.0))) < 1e-13);
        assert_true(fabs(stress[0] - 2.0 * (bulk + shear / 3.0) * 0.001 * step) < 1e-13);
    }
}

/// Softer points flow at the same stress, which is what the law says times their stiffness.
static void softer_points_flow_at_the_same_stress(void **state)
{
    (void)state;
    const double values[2] = {0.02, 0.0};
    family f = make_family(&pls_elastic_plastic_bonds, 2, values);
    double stress[6];
    f.stiffness = 0.25;
    strain_family(&f, (const double[6]){0, 0, 0, 0.5, 0, 0}, 1e-3);
    stress_of(&f, stress);
    assert_true(fabs(f.stiffness * stress[3] - values[0] / sqrt(3.0)) < 1e-13);
}

// ---- viscosity ---------------------------------------------------------------------------------------------------------------------------------------------

/// A shear that grows evenly for a time T, then stays: the branch's stress is l mu rate tau (1 - exp(-T/tau)) at its end, and falls from there. Exact for any step.
static void stress_relaxes_as_in_a_maxwell_branch(void **state)
{
    (void)state;
    const double values[2] = {0.4, 0.3}, rate = 0.02, step = 0.05, end = 0.5;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        family f = make_family(&pls_viscoelastic_bonds, dimension, values);
        double stress[6], spent = 0.0, work = 0.0, before = 0.0;
        for (int n = 1; n <= 40; ++n)
        {
            const double t = step * n, gamma = rate * fmin(t, end), grown = rate * values[1];
            const double branch =
                t <= end + 1e-9 ? grown * (1.0 - exp(-t / values[1])) : grown * (1.0 - exp(-end / values[1])) * exp(-(t - end) / values[1]);
            strain_family(&f, (const double[6]){0.001, -0.003, 0, 0.5 * gamma, 0, 0}, step);
            stress_of(&f, stress);
            assert_true(fabs(stress[3] - shear * ((1.0 - values[0]) * gamma + values[0] * branch)) < 1e-13);
            spent += f.spent;
            work += 0.5 * (stress[3] + before) * rate * (t <= end + 1e-9 ? step : 0.0) * f.volume;
            before = stress[3];
        }
        assert_true(spent > 0.0 && work > spent);
    }
}

/// What is neither stored nor spent of the work done, by it.
static double viscous_book(int steps)
{
    const double values[2] = {0.7, 0.2};
    family f = make_family(&pls_viscoelastic_bonds, 3, values);
    double spent = 0.0, work = 0.0, before[6] = {0}, was[6] = {0};
    for (int n = 1; n <= steps; ++n)
    {
        const double t = (double)n / steps;
        double stress[6];
        const double strain[6] = {0.02 * sin(5.0 * t), 0.01 * t, -0.003 * t * t, 0.005 * t, 0.0, 0.004 * sin(7.0 * t)};
        strain_family(&f, strain, 1.0 / steps);
        stress_of(&f, stress);
        for (int c = 0; c < 6; ++c) work += (c < 3 ? 0.5 : 1.0) * (stress[c] + before[c]) * (strain[c] - was[c]) * f.volume;
        memcpy(before, stress, sizeof before);
        memcpy(was, strain, sizeof was);
        spent += f.spent;
    }
    return (f.energy + spent - work) / work;
}

static void work_is_stored_or_spent(void **state)
{
    (void)state;
    assert_true(fabs(viscous_book(20)) < 1e-13); // by the trapezoidal rule of work: at any step
}

// ---- blocks ------------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 bent(pls_vec3 X, const void *context)
{
    (void)context;
    return pls_vec(X.x + 0.05 * X.y * X.z, X.y - 0.03 * X.x * X.x, X.z + 0.04 * X.x * X.y);
}

/// What neither flows nor relaxes is the linear solid: against the slow oracle.
static void without_flow_they_are_the_linear_solid(void **state)
{
    (void)state;
    static const struct
    {
        const char *law;
        double values[2];
    } laws[] = {{"elastic_plastic", {1e6, 0}}, {"viscoelastic_solid", {0, 1}}};
    for (size_t n = 0; n < 2; ++n)
        for (int dimension = 2; dimension <= 3; ++dimension)
        {
            lattice_plan plan = lattice_default(dimension, 6);
            plan.law = laws[n].law;
            memcpy(plan.values, laws[n].values, sizeof plan.values);
            lattice b = lattice_make(&plan);
            pls_vec3 *x = calloc(b.points, sizeof *x), *force = calloc(b.points, sizeof *force);
            double *energy = calloc(b.points, sizeof *energy);
            for (size_t p = 0; p < b.points; ++p) x[p] = bent(b.reference[p], NULL);
            lattice_oracle(&b, x, force, energy);
            lattice_deform(&b, bent, NULL);
            for (size_t p = 0; p < b.points; ++p)
            {
                assert_true(pls_length(pls_sub(lattice_force(&b, p), force[p])) < 1e-12);
                assert_true(fabs(lattice_energy(&b, p) - energy[p]) < 1e-14);
            }
            free(x), free(force), free(energy);
            lattice_free(&b);
        }
}

/// Corrections of surfaces are those of the linear solid, whose shares have single precision.
static void surfaces_are_corrected_alike(void **state)
{
    (void)state;
    for (int correction = PLS_CORRECTION_VOLUME; correction <= PLS_CORRECTION_ENERGY; ++correction)
    {
        pls_vec3 force[2][216];
        for (int law = 0; law < 2; ++law)
        {
            lattice_plan plan = lattice_default(3, 6);
            plan.law = law ? "elastic_plastic" : "linear_solid";
            plan.values[0] = 1e6;
            plan.correction = (pls_correction)correction;
            lattice b = lattice_make(&plan);
            lattice_deform(&b, bent, NULL);
            for (size_t p = 0; p < b.points; ++p) force[law][p] = lattice_force(&b, p);
            lattice_free(&b);
        }
        double largest = 0.0, off = 0.0;
        for (size_t p = 0; p < 216; ++p)
        {
            largest = fmax(largest, pls_length(force[0][p]));
            off = fmax(off, pls_length(pls_sub(force[0][p], force[1][p])));
        }
        assert_true(off < 1e-6 * largest);
    }
}

static const char *const laws[] = {"elastic_plastic", "viscoelastic_solid"};

/// A block in violent motion that flows (or relaxes), its bonds breaking.
static lattice make_moving(int law, double dt, double critical_stretch, pls_correction correction)
{
    lattice_plan plan = lattice_default(3, 5);
    plan.count[0] = 10;
    plan.dt = dt;
    plan.law = laws[law];
    plan.correction = correction;
    plan.critical_stretch = critical_stretch;
    plan.values[0] = law == 0 ? 0.05 : 0.6;
    plan.values[1] = law == 0 ? 0.5 : 0.3;
    lattice b = lattice_make(&plan);
    for (size_t p = 0; p < b.points; ++p)
    {
        pls_random random = pls_random_stream(9, (uint32_t)p, PLS_FOR_USER);
        const double x = pls_random_uniform(&random) - 0.5, y = pls_random_uniform(&random) - 0.5;
        MUST(pls_body_set_velocity(b.scene.world, b.body[p],
                                   pls_vec(0.06 * (b.reference[p].x - 0.45) + 0.02 * x, 0.06 * b.reference[p].z + 0.02 * y, 0),
                                   pls_vec(0, 0, 0)));
    }
    return b;
}

/// As made, with either correction, or with a crack halfway through.
enum { WHOLE, BY_VOLUME, BY_ENERGY, CRACKED, KINDS };

static double book_error(int law, double dt, int kind)
{
    lattice b = make_moving(law, dt, INFINITY,
                            kind == BY_VOLUME   ? PLS_CORRECTION_VOLUME
                            : kind == BY_ENERGY ? PLS_CORRECTION_ENERGY
                                                : PLS_CORRECTION_NONE);
    size_t cut;
    if (kind == CRACKED)
        MUST(pls_world_cut_bonds(b.scene.world, b.bonds, pls_vec(0.45, -9, 0.15), pls_vec(0.45, 9, 0.15), pls_vec(0.45, 0, 9), &cut));
    const double before = verify_total_energy(b.scene.world);
    const pls_world_figures first = verify_figures(b.scene.world);
    MUST(pls_world_run(b.scene.world, (uint64_t)(2.0 / dt + 0.5)));
    const pls_world_figures last = verify_figures(b.scene.world);
    assert_true(last.energy_damped > 0.05 * before);
    assert_true(pls_length(pls_sub(last.momentum, first.momentum)) < 1e-14);
    assert_true(pls_length(pls_sub(last.angular_momentum, first.angular_momentum)) < 1e-13);
    const double error = verify_total_energy(b.scene.world) / before - 1.0;
    lattice_free(&b);
    return error;
}

static void energy_that_flows_or_relaxes_is_booked_to_second_order(void **state)
{
    (void)state;
    for (int law = 0; law < 2; ++law)
        for (int kind = 0; kind < KINDS; ++kind)
        {
            const double coarse = book_error(law, 2e-3, kind), fine = book_error(law, 1e-3, kind);
            if (!(fabs(coarse) < 1e-3 && (fabs(fine) < 0.35 * fabs(coarse) || fabs(fine) < 2e-6)))
                fail_msg("%s, kind %d: %g, then %g", laws[law], kind, coarse, fine);
        }
}

static uint64_t moved_hash(int law, int threads, size_t steps, size_t snapshot_at)
{
    pls_set_threads(threads);
    lattice b = make_moving(law, 2e-3, law == 0 ? 0.008 : 0.012, PLS_CORRECTION_NONE);
    if (snapshot_at > 0)
    {
        snapshot copy = {0};
        MUST(pls_world_run(b.scene.world, snapshot_at));
        MUST(snapshot_take(b.scene.world, &copy));
        lattice_free(&b);
        b = make_moving(law, 2e-3, law == 0 ? 0.008 : 0.012, PLS_CORRECTION_NONE);
        MUST(snapshot_put(b.scene.world, &copy));
        snapshot_free(&copy);
        steps -= snapshot_at;
    }
    MUST(pls_world_run(b.scene.world, steps));
    pls_bonds_figures f;
    MUST(pls_world_bonds_figures(b.scene.world, b.bonds, &f));
    if (!(f.broken > 0 && f.broken < f.bonds)) fail_msg("law %d: %zu of %zu are broken", law, f.broken, f.bonds);
    const uint64_t hash = verify_hash(b.scene.world);
    lattice_free(&b);
    pls_set_threads(1);
    return hash;
}

static void bits_are_equal_for_threads_and_restarts(void **state)
{
    (void)state;
    for (int law = 0; law < 2; ++law)
    {
        const uint64_t one = moved_hash(law, 1, 500, 0);
        for (int threads = 2; threads <= 4; ++threads) assert_int_equal(moved_hash(law, threads, 500, 0), one);
        assert_int_equal(moved_hash(law, 1, 500, 210), one);
        assert_int_equal(moved_hash(law, 2, 500, 333), one);
    }
}

// ---- laws that are no good -----------------------------------------------------------------------------------------------------------------------------------

static void refused(pls_bond_ops ops, const char *why)
{
    assert_int_equal(pls_bond_ops_check(&ops), PLS_INVALID_ARGUMENT);
    if (!strstr(pls_last_message(), why)) print_error("%s\n", pls_last_message());
    assert_non_null(strstr(pls_last_message(), why));
}

static void laws_that_are_no_good_are_refused(void **state)
{
    (void)state;
    pls_bond_ops good = pls_elastic_plastic_bonds, ops = good;
    MUST(pls_bond_ops_check(&good));
    ops.linear = NULL, refused(ops, "neither `linear` nor `pair`");
    ops = good, ops.prepare = NULL, refused(ops, "lacks `prepare`");
    ops = good, ops.pairwise = true, refused(ops, "pairwise");
    ops = good, ops.pull = NULL, refused(ops, "lacks `pull`");
    ops = good, ops.advance = NULL, refused(ops, "lacks `advance`");
    ops = good, ops.memories = PLS_BOND_MAX_MEMORY + 1, refused(ops, "at most");
    ops = good, ops.pair = pls_beam_bonds.pair, refused(ops, "be one of them");
    ops = pls_beam_bonds, ops.stiffness = NULL, refused(ops, "lacks `prepare` or `stiffness`");

    lattice_plan plan = lattice_default(2, 4);
    lattice b = lattice_make(&plan);
    pls_bonds_def def = pls_default_bonds_def();
    const double values[2] = {1.0, 0.0};
    pls_bonds_id id;
    strcpy(def.name, "more");
    def.ops = &pls_elastic_plastic_bonds;
    def.horizon = plan.horizon;
    def.values = values;
    def.plane = PLS_PLANE_STRESS;
    assert_int_equal(pls_world_add_bonds(b.scene.world, &def, &id), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "plane strain only"));
    lattice_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flow_is_that_of_von_mises),
        cmocka_unit_test(asking_again_says_the_same),
        cmocka_unit_test(flow_in_the_plane),
        cmocka_unit_test(softer_points_flow_at_the_same_stress),
        cmocka_unit_test(stress_relaxes_as_in_a_maxwell_branch),
        cmocka_unit_test(work_is_stored_or_spent),
        cmocka_unit_test(without_flow_they_are_the_linear_solid),
        cmocka_unit_test(surfaces_are_corrected_alike),
        cmocka_unit_test(energy_that_flows_or_relaxes_is_booked_to_second_order),
        cmocka_unit_test(bits_are_equal_for_threads_and_restarts),
        cmocka_unit_test(laws_that_are_no_good_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
