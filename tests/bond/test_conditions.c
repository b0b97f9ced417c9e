// test_conditions.c -- what varies from point to point and in time: stiffness, toughness, heat; and bonds that break by energy.
#include "support/lattice.h"
#include "support/snapshot.h"

#include "step/world.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const double pi = 3.14159265358979323846;

// ---- heat ------------------------------------------------------------------------------------------------------------------------------------------------

static const double conductivity = 0.7, capacity = 3.0; // [W/(m K)], [J/(kg K)]

/// Waves of the temperature in a box that repeats, or whatever a test asks for.
static double length_of_wave;
static pls_status wave(void *context, const pls_point_batch *points, double *values)
{
    (void)context;
    for (size_t k = 0; k < points->count; ++k) values[k] = 300.0 + cos(2.0 * pi * points->place[0][k] / length_of_wave);
    return PLS_OK;
}

static lattice make_warm(lattice_plan plan, pls_point_value *initial)
{
    plan.heat = (pls_heat_def){.conductivity = conductivity, .capacity = capacity, .reference = NAN, .initial = initial};
    return lattice_make(&plan);
}

static double temperature(const lattice *b, size_t p) { return pls_world_bonds_temperature(b->scene.world, b->bonds, b->body[p]); }

/// The slowest wave decays at the rate of the lattice's own sum, which tends to k (2 pi/L)^2/(rho c).
static double decay_error(double dt, double *exact, double *continuum)
{
    lattice_plan plan = lattice_default(3, 7);
    plan.count[0] = 12;
    plan.periodic = true;
    plan.dt = dt;
    length_of_wave = plan.spacing * 12.0;
    lattice b = make_warm(plan, wave);
    const double k = 2.0 * pi / length_of_wave, end = 0.3;
    double m = 0.0, sum = 0.0;
    for (int x = -3; x <= 3; ++x)
        for (int y = -3; y <= 3; ++y)
            for (int z = -3; z <= 3; ++z)
            {
                const double xi = plan.spacing * sqrt((double)(x * x + y * y + z * z));
                if (!(xi > 0.0 && xi <= plan.horizon)) continue;
                const double w = plan.horizon / xi * fmin(1.0, 0.5 + (plan.horizon - xi) / plan.spacing);
                m += w * xi * xi;
                sum += w * (1.0 - cos(k * plan.spacing * x));
            }
    *exact = 6.0 * conductivity * sum / m / (plan.density * capacity);
    *continuum = conductivity * k * k / (plan.density * capacity);
    MUST(pls_world_run(b.scene.world, (uint64_t)(end / dt + 0.5)));
    const double error = (temperature(&b, 0) - 300.0) / exp(-*exact * end) - 1.0;
    lattice_free(&b);
    return error;
}

static void waves_of_temperature_decay_as_fourier_says(void **state)
{
    (void)state;
    double exact, continuum;
    const double coarse = decay_error(6e-3, &exact, &continuum), fine = decay_error(3e-3, &exact, &continuum);
    assert_true(fabs(exact / continuum - 1.0) < 0.08); // twelve points per wave, a quarter of them in the horizon
    assert_true(fabs(coarse) < 2e-3 && fabs(fine) < 0.35 * fabs(coarse));
}

/// A bar between two temperatures: a straight line; heat that flows is kept to round-off where nothing is held.
static pls_status ends(void *context, const pls_point_batch *points, double *values)
{
    (void)context;
    for (size_t k = 0; k < points->count; ++k)
        values[k] = points->place[0][k] < 0.25 ? 10.0 : points->place[0][k] > 1.65 ? 24.0 : NAN; // of twenty layers the outer three
    return PLS_OK;
}

static void heat_flows_down_and_is_kept(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 4);
    plan.count[0] = 20;
    plan.dt = 2e-3;
    length_of_wave = 1.0;
    lattice b = make_warm(plan, wave);
    double before = 0.0, after = 0.0;
    for (size_t p = 0; p < b.points; ++p) before += temperature(&b, p);
    MUST(pls_world_run(b.scene.world, 200));
    for (size_t p = 0; p < b.points; ++p) after += temperature(&b, p);
    assert_true(fabs(after / before - 1.0) < 1e-13);
    lattice_free(&b);

    plan.heat = (pls_heat_def){.conductivity = 2.0, .capacity = 1.0, .reference = NAN, .held = ends};
    b = lattice_make(&plan);
    MUST(pls_world_run(b.scene.world, 6000)); // fifteen times L^2/(pi^2 k/(rho c))
    double middle[20] = {0};
    for (size_t p = 0; p < b.points; ++p) middle[p % 20] += temperature(&b, p) / 16.0;
    const double slope = (middle[12] - middle[7]) / 5.0; // inside, whole families along x
    for (size_t i = 5; i < 15; ++i) assert_true(fabs(middle[i] - (17.0 + ((double)i - 9.5) * slope)) < 1e-3 * 14.0);
    assert_true(fabs(slope / (14.0 / 15.0) - 1.0) < 0.03); // the ends are held through three layers, half a layer in between
    lattice_free(&b);
}

static pls_status warm_side(void *context, const pls_point_batch *points, double *values)
{
    (void)context;
    for (size_t k = 0; k < points->count; ++k) values[k] = points->place[0][k] < 0.45 ? 1.0 : 0.0;
    return PLS_OK;
}

/// No heat crosses a crack.
static void cracks_insulate(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 4);
    plan.count[0] = 10;
    plan.dt = 2e-3;
    lattice b = make_warm(plan, warm_side);
    size_t cut;
    MUST(pls_world_cut_bonds(b.scene.world, b.bonds, pls_vec(0.45, -9, -9), pls_vec(0.45, 30, -9), pls_vec(0.45, -9, 30), &cut));
    assert_true(cut > 0);
    MUST(pls_world_run(b.scene.world, 500));
    for (size_t p = 0; p < b.points; ++p) assert_true(fabs(temperature(&b, p) - (b.reference[p].x < 0.45 ? 1.0 : 0.0)) < 1e-12);
    lattice_free(&b);
}

static pls_status hot(void *context, const pls_point_batch *points, double *values)
{
    (void)context;
    for (size_t k = 0; k < points->count; ++k) values[k] = 50.0;
    return PLS_OK;
}

static pls_vec3 scaled(pls_vec3 X, const void *context) { return pls_scale(X, *(const double *)context); }

/// A body that is free and evenly warm grows by alpha (T - T0) and has no stress; in plane strain by (1 + nu) times that. Whatever the law.
static void a_free_body_grows_without_stress(void **state)
{
    (void)state;
    static const char *const laws[] = {"linear_solid", "elastic_plastic"};
    for (size_t law = 0; law < 2; ++law)
        for (int kind = 0; kind < 3; ++kind)
        {
            lattice_plan plan = lattice_default(kind == 0 ? 3 : 2, 6);
            plan.plane = kind == 2 ? PLS_PLANE_STRESS : PLS_PLANE_STRAIN;
            if (kind == 2 && law == 1) continue;
            plan.law = laws[law];
            plan.values[0] = 1e6;
            plan.heat = (pls_heat_def){.conductivity = 0.0, .capacity = 1.0, .reference = 20.0, .expansion = 1e-4, .initial = hot};
            lattice b = lattice_make(&plan);
            const double nu = (3.0 * plan.bulk - 2.0 * plan.shear) / (2.0 * (3.0 * plan.bulk + plan.shear));
            const double factor = 1.0 + (kind == 1 ? 1.0 + nu : 1.0) * 1e-4 * 30.0, none = 1.0;
            lattice_deform(&b, scaled, &factor);
            for (size_t p = 0; p < b.points; ++p) assert_true(pls_length(lattice_force(&b, p)) < 1e-13 && lattice_energy(&b, p) < 1e-18);
            lattice_deform(&b, scaled, &none);
            double largest = 0.0;
            for (size_t p = 0; p < b.points; ++p) largest = fmax(largest, pls_length(lattice_force(&b, p)));
            assert_true(largest > 1e-4);
            lattice_free(&b);
        }
}

static pls_status cooled(void *context, const pls_point_batch *points, double *values)
{
    const double *rate = context;
    for (size_t k = 0; k < points->count; ++k) values[k] = *rate * (1.0 - points->temperature[k]);
    return PLS_OK;
}

/// Heat limits the step though nothing can move, by conduction and by what is put in; what gets out of hand all the same stops the run.
static void heat_has_a_stable_step_of_its_own(void **state)
{
    (void)state;
    static double rate = 3000.0; // [W/(m^3 K)]: 500/s with rho c = 6 J/(m^3 K)
    for (int source = 0; source < 2; ++source)
    {
        lattice_plan plan = lattice_default(3, 4);
        plan.dt = 0.01;
        plan.fixed = true;
        plan.user = &rate;
        plan.heat = (pls_heat_def){
            .conductivity = source ? 0.0 : 30.0, .capacity = capacity, .reference = NAN, .initial = hot, .source = source ? cooled : NULL};
        lattice b = lattice_make(&plan);
        assert_int_equal(pls_world_prepare(b.scene.world), PLS_UNSTABLE_STEP);
        assert_non_null(strstr(pls_last_message(), "of heat in bonds 'block'"));
        lattice_free(&b);
        plan.unstable = true;
        b = lattice_make(&plan);
        pls_status status = PLS_OK;
        for (int k = 0; k < 200 && status == PLS_OK; ++k) status = pls_step(b.scene.world);
        assert_int_equal(source ? status : PLS_UNSTABLE_STEP, PLS_UNSTABLE_STEP);
        lattice_free(&b);
    }
}

// ---- stiffness and toughness -----------------------------------------------------------------------------------------------------------------------------

/// Half of the points, along x, are three times as stiff and half as tough.
static pls_status halves(void *context, const pls_point_batch *points, double *stiffness, double *toughness)
{
    (void)context;
    for (size_t k = 0; k < points->count; ++k)
    {
        const bool second = points->place[0][k] > 0.45;
        stiffness[k] = second ? 3.0 : 1.0;
        toughness[k] = second ? 0.5 : 1.0;
    }
    return PLS_OK;
}

static pls_vec3 bent(pls_vec3 X, const void *context)
{
    (void)context;
    return pls_vec(X.x + 0.05 * X.y * X.z, X.y - 0.03 * X.x * X.x, X.z + 0.04 * X.x * X.y);
}

/// What a stiffer half of the same shape stores: points whose families lie in it have three times the energy and force.
static void stiffness_counts_times_the_moduli(void **state)
{
    (void)state;
    static const char *const laws[] = {"linear_solid", "viscoelastic_solid"};
    for (size_t law = 0; law < 2; ++law)
    {
        double energy[2][250];
        pls_vec3 force[2][250];
        for (int varies = 0; varies < 2; ++varies)
        {
            lattice_plan plan = lattice_default(3, 5);
            plan.count[0] = 10;
            plan.law = laws[law];
            plan.values[1] = 1.0;
            if (varies) plan.condition = halves;
            lattice b = lattice_make(&plan);
            lattice_deform(&b, bent, NULL);
            for (size_t p = 0; p < b.points; ++p) energy[varies][p] = lattice_energy(&b, p), force[varies][p] = lattice_force(&b, p);
            lattice_free(&b);
        }
        for (size_t p = 0; p < 250; ++p)
        {
            const size_t i = p % 10;
            const double times = i < 2 ? 1.0 : i > 7 ? 3.0 : 0.0; // forces know the dilatation of partners too: families of families
            if (times == 0.0) continue;
            assert_true(fabs(energy[1][p] - times * energy[0][p]) < 1e-12 * (1.0 + energy[0][p]));
            if (i < 1 || i > 8) assert_true(pls_length(pls_sub(force[1][p], pls_scale(force[0][p], times))) < 1e-12);
        }
    }
}

/// Forces are the gradient of the energy where stiffness and temperature vary, so that motion keeps it.
static double varied_book(double dt)
{
    lattice_plan plan = lattice_default(3, 5);
    plan.count[0] = 10;
    plan.dt = dt;
    plan.condition = halves;
    plan.heat = (pls_heat_def){.conductivity = 0.0, .capacity = 1.0, .reference = 0.0, .expansion = 0.01, .initial = warm_side};
    lattice b = lattice_make(&plan);
    const double before = verify_total_energy(b.scene.world);
    MUST(pls_world_run(b.scene.world, (uint64_t)(1.5 / dt + 0.5)));
    const double error = verify_total_energy(b.scene.world) / before - 1.0;
    assert_true(verify_figures(b.scene.world).energy_kinetic > 1e-3 * before);
    assert_true(pls_length(verify_figures(b.scene.world).momentum) < 1e-15);
    lattice_free(&b);
    return error;
}

static void energy_is_kept_where_points_differ(void **state)
{
    (void)state;
    const double coarse = varied_book(2e-3), fine = varied_book(1e-3);
    assert_true(fabs(coarse) < 1e-3 && fabs(fine) < 0.35 * fabs(coarse));
}

static pls_bonds_figures figures_of(const lattice *b)
{
    pls_bonds_figures f;
    MUST(pls_world_bonds_figures(b->scene.world, b->bonds, &f));
    return f;
}

static pls_status tough_or_not(void *context, const pls_point_batch *points, double *stiffness, double *toughness)
{
    const double *value = context;
    for (size_t k = 0; k < points->count; ++k) stiffness[k] = 1.0, toughness[k] = value[points->place[0][k] > 0.05];
    return PLS_OK;
}

static double distance_at_break(lattice_plan plan)
{
    lattice b = lattice_make(&plan);
    MUST(pls_body_set_velocity(b.scene.world, b.body[0], pls_vec(-0.5, 0, 0), pls_vec(0, 0, 0)));
    MUST(pls_body_set_velocity(b.scene.world, b.body[1], pls_vec(0.5, 0, 0), pls_vec(0, 0, 0)));
    double distance = 0.0;
    for (int k = 0; k < 10000 && figures_of(&b).broken == 0; ++k)
    {
        MUST(pls_step(b.scene.world));
        distance = verify_motion(b.scene.world, b.body[1]).position.x - verify_motion(b.scene.world, b.body[0]).position.x;
    }
    assert_int_equal(figures_of(&b).broken, 2);
    lattice_free(&b);
    return distance;
}

/// A bond withstands the mean of what its two points do: of a stretch, and of beams the strength.
static void toughness_counts_as_the_mean_of_both_points(void **state)
{
    (void)state;
    static double toughness[2] = {0.4, 1.2};
    static const char *const laws[] = {"bond_based", "linear_solid", "elastic_plastic", "beam", "beam"};
    for (size_t law = 0; law < 5; ++law)
    {
        lattice_plan plan = lattice_default(3, 1);
        plan.count[0] = 2;
        plan.horizon = 1.5 * plan.spacing;
        plan.law = laws[law];
        plan.values[0] = 1e6;
        plan.shear = 0.6 * plan.bulk;
        plan.dt = 2e-5;
        plan.critical_stretch = 0.02;
        plan.condition = tough_or_not;
        plan.user = toughness;
        double expected = 0.8 * 0.02;
        if (law == 4) // strength is a tenth of the bulk modulus, E = 1.5 K at nu = 1/4: see lattice.c
            plan.critical_stretch = INFINITY, expected = 0.8 * 0.1 / 1.5;
        const double stretch = distance_at_break(plan) / plan.spacing - 1.0;
        assert_true(stretch > expected && stretch < expected + 1.5 * 2e-5 / plan.spacing);
    }
}

// ---- energy ----------------------------------------------------------------------------------------------------------------------------------------------

/// Two points store w_c V V beta where their bond breaks; critical energies of all bonds across a plane of a lattice come to G per area.
static void bonds_break_by_energy(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 1);
    plan.count[0] = 2;
    plan.horizon = 1.5 * plan.spacing;
    plan.law = "bond_based";
    plan.shear = 0.6 * plan.bulk;
    plan.dt = 2e-5;
    plan.fracture = PLS_FRACTURE_ENERGY;
    plan.fracture_energy = 0.004;
    const double V = pow(plan.spacing, 3), critical = 4.0 * plan.fracture_energy / (V * plan.spacing) * V * V; // S: one partner
    // Alone, a family has m = w beta V xi^2: its energy is 9 K V e^2/(2 xi^2), and the bond's that of both.
    const double expected = sqrt(critical / (9.0 * plan.bulk * V)), stretch = distance_at_break(plan) / plan.spacing - 1.0;
    assert_true(stretch > expected && stretch < expected + 1.5 * 2e-5 / plan.spacing);

    // Of a lattice: critical energies of all bonds across a plane (100), by its area, and that of a continuum.
    const double spacing = 0.1;
    for (int reach = 3; reach <= 8; reach += 5)
    {
        const double delta = (reach + 0.015) * spacing;
        double across = 0.0, moment = 0.0;
        for (int x = -reach; x <= reach; ++x)
            for (int y = -reach; y <= reach; ++y)
                for (int z = -reach; z <= reach; ++z)
                {
                    const double xi = spacing * sqrt((double)(x * x + y * y + z * z));
                    if (!(xi > 0.0 && xi <= delta)) continue;
                    const double part = fmin(1.0, 0.5 + (delta - xi) / spacing);
                    moment += part * xi * pow(spacing, 3);
                    if (x > 0) across += x * part * pow(spacing, 4);
                }
        assert_true(fabs(across * 4.0 / moment - 1.0) < (reach == 3 ? 0.03 : 0.005));
        assert_true(fabs(moment / (pi * pow(delta, 4)) - 1.0) < 0.7 / reach);
    }
}

/// Energy is booked when bonds break by it, too.
static double torn_error(double dt, size_t *broken)
{
    lattice_plan plan = lattice_default(3, 5);
    plan.count[0] = 10;
    plan.dt = dt;
    plan.fracture = PLS_FRACTURE_ENERGY;
    plan.fracture_energy = 2e-4;
    plan.condition = halves;
    lattice b = lattice_make(&plan);
    for (size_t p = 0; p < b.points; ++p)
        MUST(pls_body_set_velocity(b.scene.world, b.body[p], pls_vec(0.12 * (b.reference[p].x - 0.45), 0.02 * b.reference[p].z, 0),
                                   pls_vec(0, 0, 0)));
    const double before = verify_total_energy(b.scene.world);
    MUST(pls_world_run(b.scene.world, (uint64_t)(1.0 / dt + 0.5)));
    *broken = figures_of(&b).broken;
    const double error = verify_total_energy(b.scene.world) / before - 1.0;
    assert_true(*broken < figures_of(&b).bonds);
    lattice_free(&b);
    return error;
}

static void energy_of_such_bonds_is_booked(void **state)
{
    (void)state;
    size_t broken[2];
    const double coarse = torn_error(2e-3, &broken[0]), fine = torn_error(1e-3, &broken[1]);
    assert_true(broken[0] > 50 && broken[1] > 50);
    assert_true(fabs(coarse) < 2e-3 && fabs(fine) < fmax(0.4 * fabs(coarse), 1e-5));
}

// ---- bits ------------------------------------------------------------------------------------------------------------------------------------------------

/// Softer and weaker where it is warm, and by chance.
static pls_status by_temperature(void *context, const pls_point_batch *points, double *stiffness, double *toughness)
{
    (void)context;
    for (size_t k = 0; k < points->count; ++k)
    {
        stiffness[k] = 1.0 - 0.5 * points->temperature[k];
        toughness[k] = (1.0 - 0.3 * points->temperature[k]) * pow(-log(points->chance[k]), 0.2);
    }
    return PLS_OK;
}

static lattice make_cooling(void)
{
    lattice_plan plan = lattice_default(3, 5);
    plan.count[0] = 10;
    plan.dt = 2e-3;
    plan.critical_stretch = 0.02;
    plan.condition = by_temperature;
    plan.condition_changes = true;
    plan.heat = (pls_heat_def){.conductivity = 2.0, .capacity = 1.0, .reference = 0.0, .expansion = 0.03, .initial = warm_side};
    return lattice_make(&plan);
}

static uint64_t cooled_hash(int threads, size_t steps, size_t snapshot_at)
{
    pls_set_threads(threads);
    lattice b = make_cooling();
    if (snapshot_at > 0)
    {
        snapshot copy = {0};
        MUST(pls_world_run(b.scene.world, snapshot_at));
        MUST(snapshot_take(b.scene.world, &copy));
        lattice_free(&b);
        b = make_cooling();
        MUST(snapshot_put(b.scene.world, &copy));
        snapshot_free(&copy);
        steps -= snapshot_at;
    }
    MUST(pls_world_run(b.scene.world, steps));
    assert_true(figures_of(&b).broken > 0 && figures_of(&b).broken < figures_of(&b).bonds);
    const uint64_t hash = verify_hash(b.scene.world);
    lattice_free(&b);
    pls_set_threads(1);
    return hash;
}

static void bits_are_equal_for_threads_and_restarts(void **state)
{
    (void)state;
    const uint64_t one = cooled_hash(1, 300, 0);
    for (int threads = 2; threads <= 4; ++threads) assert_int_equal(cooled_hash(threads, 300, 0), one);
    assert_int_equal(cooled_hash(1, 300, 120), one);
    assert_int_equal(cooled_hash(3, 300, 221), one);
}

// ---- chance ------------------------------------------------------------------------------------------------------------------------------------------------

static double drawn[1000];
static size_t drawn_count;

static pls_status note_chance(void *context, const pls_point_batch *points, double *stiffness, double *toughness)
{
    (void)context;
    for (size_t k = 0; k < points->count; ++k)
    {
        drawn[drawn_count++] = points->chance[k];
        stiffness[k] = toughness[k] = 1.0;
    }
    return PLS_OK;
}

static int by_size(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

/// Uniform (Kolmogorov's distance at the level of one in a thousand), the same in every run.
static void chance_is_uniform_and_repeats(void **state)
{
    (void)state;
    double first[1000];
    for (int run = 0; run < 2; ++run)
    {
        lattice_plan plan = lattice_default(3, 10);
        plan.condition = note_chance;
        drawn_count = 0;
        lattice b = lattice_make(&plan);
        assert_int_equal(drawn_count, 1000);
        if (run == 0) memcpy(first, drawn, sizeof first);
        lattice_free(&b);
    }
    assert_memory_equal(first, drawn, sizeof first);
    qsort(drawn, 1000, sizeof *drawn, by_size);
    double distance = 0.0;
    for (size_t k = 0; k < 1000; ++k) distance = fmax(distance, fabs(drawn[k] - ((double)k + 0.5) / 1000.0));
    assert_true(distance < 1.95 / sqrt(1000.0) && drawn[0] > 0.0 && drawn[999] < 1.0);
}

// ---- what is refused -------------------------------------------------------------------------------------------------------------------------------------

static int released;
static void count_release(void *user)
{
    (void)user;
    ++released;
}

static pls_status soft_by_mistake(void *context, const pls_point_batch *points, double *stiffness, double *toughness)
{
    (void)context;
    for (size_t k = 0; k < points->count; ++k) stiffness[k] = points->place[0][k] - 0.15, toughness[k] = 1.0;
    return PLS_OK;
}

static void refused(pls_bonds_def def, const char *why)
{
    lattice_plan plan = lattice_default(3, 4);
    lattice b = lattice_make(&plan);
    pls_bonds_id id;
    released = 0;
    strcpy(def.name, "more");
    def.release = count_release;
    def.horizon = plan.horizon;
    assert_true(pls_world_add_bonds(b.scene.world, &def, &id) != PLS_OK);
    if (!strstr(pls_last_message(), why)) print_error("%s\n", pls_last_message());
    assert_non_null(strstr(pls_last_message(), why));
    assert_int_equal(released, 1);
    lattice_free(&b);
}

/// The same bonds under another name.
static void twice(pls_bonds_def def, const char *why)
{
    lattice_plan plan = lattice_default(3, 4);
    lattice b = lattice_make(&plan);
    pls_bonds_id id;
    strcpy(def.name, "more");
    def.horizon = plan.horizon;
    MUST(pls_world_add_bonds(b.scene.world, &def, &id));
    strcpy(def.name, "again");
    assert_int_equal(pls_world_add_bonds(b.scene.world, &def, &id), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), why));
    lattice_free(&b);
}

static void what_is_wrong_is_said(void **state)
{
    (void)state;
    pls_bonds_def good = pls_default_bonds_def(), def;
    good.ops = pls_builtin_bonds()[0];
    def = good, def.heat = (pls_heat_def){.conductivity = -1.0, .capacity = 1.0}, refused(def, "the conductivity is -1");
    def = good, def.heat = (pls_heat_def){.conductivity = 1.0, .capacity = 0.0}, refused(def, "the heat capacity is 0");
    def = good, def.condition = soft_by_mistake, refused(def, "the stiffness of body");
    def = good, def.fracture = PLS_FRACTURE_ENERGY, refused(def, "have no fracture energy");
    const double plastic[2] = {1.0, 0.0};
    def = good, def.ops = pls_builtin_bonds()[2], def.values = plastic, def.fracture = PLS_FRACTURE_ENERGY, def.fracture_energy = 1.0;
    refused(def, "do not break by energy");
    def = good, def.heat = (pls_heat_def){.conductivity = 1.0, .capacity = 1.0}, twice(def, "has a temperature in bonds 'more' already");
    def = good, def.name[0] = '\0', def.ops = NULL, refused(def, "need a law");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_of_temperature_decay_as_fourier_says),
        cmocka_unit_test(heat_flows_down_and_is_kept),
        cmocka_unit_test(cracks_insulate),
        cmocka_unit_test(a_free_body_grows_without_stress),
        cmocka_unit_test(heat_has_a_stable_step_of_its_own),
        cmocka_unit_test(stiffness_counts_times_the_moduli),
        cmocka_unit_test(energy_is_kept_where_points_differ),
        cmocka_unit_test(toughness_counts_as_the_mean_of_both_points),
        cmocka_unit_test(bonds_break_by_energy),
        cmocka_unit_test(energy_of_such_bonds_is_booked),
        cmocka_unit_test(bits_are_equal_for_threads_and_restarts),
        cmocka_unit_test(chance_is_uniform_and_repeats),
        cmocka_unit_test(what_is_wrong_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
