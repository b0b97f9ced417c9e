// test_bond_set.c -- sets of bonds: laws of independent springs, what is refused and why, figures, stable steps.
#include "support/lattice.h"

#include "bond/influence.h"
#include "step/world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const double pi = 3.14159265358979323846;

static pls_vec3 dilated(pls_vec3 X, const void *context) { return pls_scale(X, 1.0 + *(const double *)context); }

/// f = c e / xi with one c for all bonds, which inside stores what the bulk modulus says. In a continuum it is 18 K / (pi delta^4); a lattice of three spacings has an eighth less to divide by.
static void independent_springs_have_the_bulk_modulus_inside(void **state)
{
    (void)state;
    const double s = 1e-4;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        lattice_plan plan = lattice_default(dimension, 11);
        plan.law = "bond_based", plan.shear = 0.6 * plan.bulk;
        lattice b = lattice_make(&plan);
        lattice_deform(&b, dilated, &s);
        const double V = lattice_volume(&b), k2 = plan.bulk + plan.shear / 3.0;
        const size_t middle = lattice_at(&b, 5, 5, dimension == 3 ? 5 : 0);
        double sum = 0.0; // of xi V, partial volumes
        for (size_t q = 0; q < b.points; ++q)
        {
            const double xi = pls_length(pls_sub(b.reference[q], b.reference[middle])), part = 0.5 + (plan.horizon - xi) / plan.spacing;
            if (q != middle && xi <= plan.horizon) sum += xi * V * fmin(part, 1.0);
        }
        const double W = lattice_energy(&b, middle) / V, exact = dimension == 3 ? 4.5 * plan.bulk * s * s : 2.0 * k2 * s * s;
        assert_true(fabs(W / exact - 1.0) < 1e-10);
        const double c = 4.0 * W / (s * s * sum); // W = sum of c s^2 xi V / 4
        const double continuum = dimension == 3 ? 18.0 * plan.bulk / (pi * pow(plan.horizon, 4)) : 12.0 * k2 / (pi * pow(plan.horizon, 3));
        assert_true(c > continuum && c < 1.25 * continuum);
        lattice_free(&b);
    }
}

static pls_vec3 stretched(pls_vec3 X, const void *context) { return pls_vec(X.x * (1.0 + *(const double *)context), X.y, X.z); }

/// Energy of a cube stretched along x, by that of the continuum, (K + 4 mu/3) s^2/2 per volume.
static double cube_energy(const char *law, pls_correction correction)
{
    const double s = 1e-4;
    lattice_plan plan = lattice_default(3, 12);
    plan.law = law, plan.correction = correction;
    if (strcmp(law, "bond_based") == 0) plan.shear = 0.6 * plan.bulk;
    lattice b = lattice_make(&plan);
    lattice_deform(&b, stretched, &s);
    double sum = 0.0;
    for (size_t p = 0; p < b.points; ++p) sum += lattice_energy(&b, p);
    const double inside = lattice_energy(&b, lattice_at(&b, 6, 6, 6)) * (double)b.points;
    lattice_free(&b);
    return sum / inside;
}

/// Most points of such a cube lie near a surface.
static void corrections_give_surfaces_the_energy_of_the_inside(void **state)
{
    (void)state;
    assert_true(fabs(cube_energy("bond_based", PLS_CORRECTION_NONE) - 1.0) > 0.1);
    assert_true(fabs(cube_energy("bond_based", PLS_CORRECTION_VOLUME) - 1.0) < 0.08);
    assert_true(fabs(cube_energy("bond_based", PLS_CORRECTION_ENERGY) - 1.0) < 0.02);
    assert_true(fabs(cube_energy("linear_solid", PLS_CORRECTION_ENERGY) - 1.0) < 0.02);
    assert_true(fabs(cube_energy("linear_solid", PLS_CORRECTION_ENERGY) - 1.0) <
                fabs(cube_energy("linear_solid", PLS_CORRECTION_NONE) - 1.0));
}

/// A correction makes up for what families lack, and for nothing else: neither for materials nor for volumes.
static void corrections_leave_materials_and_volumes_what_they_are(void **state)
{
    (void)state;
    const double s = 1e-4;
    const char *const laws[] = {"bond_based", "linear_solid"};
    for (int law = 0; law < 2; ++law)
    {
        lattice_plan plan = lattice_default(3, 10);
        plan.count[0] = 24, plan.law = laws[law], plan.correction = PLS_CORRECTION_ENERGY;
        if (law == 0) plan.shear = 0.6 * plan.bulk;
        lattice alike = lattice_make(&plan);
        plan.stiffer = 10.0;
        lattice layered = lattice_make(&plan);
        plan.stiffer = 0.0, plan.lighter = 0.5;
        lattice half = lattice_make(&plan);
        lattice *const all[] = {&alike, &layered, &half};
        for (int k = 0; k < 3; ++k) lattice_deform(all[k], stretched, &s);
        double whole = 0.0, light = 0.0;
        for (size_t p = 0; p < alike.points; ++p)
        {
            const size_t i = p % plan.count[0];
            whole += i > 0 ? lattice_energy(&alike, p) : 0.5 * lattice_energy(&alike, p);
            light += lattice_energy(&half, p);
            if (i > 8 && i < 15) continue; // families of both materials
            assert_true(fabs(lattice_energy(&layered, p) / ((i < 12 ? 1.0 : 10.0) * lattice_energy(&alike, p)) - 1.0) < 1e-6);
        }
        assert_true(fabs(light / whole - 1.0) < 0.01);
        for (int k = 0; k < 3; ++k) lattice_free(all[k]);
    }
}

static void critical_stretches_are_those_of_the_literature(void **state)
{
    (void)state;
    const double K = 3.0, G = 0.2, delta = 0.7;
    pls_bonds_def def = pls_default_bonds_def();
    def.horizon = delta;
    assert_true(fabs(pls_critical_stretch(&def, 3, K, G) / sqrt(5.0 * G / (9.0 * K * delta)) - 1.0) < 1e-9);
    assert_true(fabs(pls_critical_stretch(&def, 2, K, G) / sqrt(pi * G / (3.0 * K * delta)) - 1.0) < 1e-9);
    def.influence = PLS_INFLUENCE_ONE;
    assert_true(fabs(pls_critical_stretch(&def, 3, K, G) / sqrt(8.0 * G / (15.0 * K * delta)) - 1.0) < 1e-9);
    assert_true(fabs(pls_critical_stretch(&def, 2, K, G) / sqrt(5.0 * pi * G / (16.0 * K * delta)) - 1.0) < 1e-9);
}

/// The largest eigenvalue of a chain-like solid is what a step must obey: just below it is stable, well above it is not.
static double grown(double dt_part)
{
    lattice_plan plan = lattice_default(3, 6);
    lattice b = lattice_make(&plan);
    pls_step_estimate e;
    MUST(pls_world_stable_step(b.scene.world, &e));
    lattice_free(&b);
    plan.dt = dt_part * e.dt;
    b = lattice_make(&plan);
    for (size_t p = 0; p < b.points; ++p)
        MUST(pls_body_set_velocity(b.scene.world, b.body[p], pls_vec(1e-6 * (double)(p * 7919 % 13), 0, 1e-6 * (double)(p * 104729 % 11)),
                                   pls_vec(0, 0, 0)));
    b.scene.world->def.allow_unstable = true;
    pls_bonds_figures before, after;
    MUST(pls_world_run(b.scene.world, 5));
    MUST(pls_world_bonds_figures(b.scene.world, b.bonds, &before));
    const pls_status status = pls_world_run(b.scene.world, 400);
    MUST(pls_world_bonds_figures(b.scene.world, b.bonds, &after));
    lattice_free(&b);
    if (status == PLS_LOST_BODY) return INFINITY;
    return status == PLS_OK ? after.energy / before.energy : NAN;
}

static void the_stable_step_is_the_limit(void **state)
{
    (void)state;
    assert_true(grown(0.98) < 50.0);
    assert_true(grown(1.06) > 1e6); // three hundredths are the margin of the iteration
}

// ---- what is refused -----------------------------------------------------------------------------------------------------------------------------------------

static void expect(const pls_world *world, const pls_bonds_def *def, pls_status status, const char *words)
{
    pls_bonds_id id;
    if (pls_world_add_bonds((pls_world *)world, def, &id) != status) fail_msg("not refused, or otherwise: %s", words);
    assert_int_equal(id.index1, 0);
    if (!strstr(pls_last_message(), words)) fail_msg("'%s' is not in: %s", words, pls_last_message());
}

static void wrong_sets_are_refused_with_the_reason(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 4);
    lattice b = lattice_make(&plan);
    const pls_bond_ops *const *laws = pls_builtin_bonds();
    pls_bonds_def good = pls_default_bonds_def(), def;
    snprintf(good.name, sizeof good.name, "other");
    good.ops = laws[0];
    good.horizon = 0.3015;

    expect(b.scene.world, &(pls_bonds_def){.horizon = 1.0}, PLS_INVALID_ARGUMENT, "pls_default_bonds_def");
    def = good, def.name[0] = '\0', expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "needs a name");
    def = good, snprintf(def.name, sizeof def.name, "block"), expect(b.scene.world, &def, PLS_DUPLICATE, "already");
    def = good, def.ops = NULL, expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "need a law");
    def = good, def.horizon = -1.0, expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "horizon is -1 m");
    def = good, def.horizon = 0.05, expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "no other point within the horizon");
    assert_non_null(strstr(pls_last_message(), "0.1 m away"));
    def = good, def.critical_stretch = -0.1, expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "critical stretch is -0.1");
    def = good, def.influence = PLS_INFLUENCE_FUNCTION, expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "none is given");
    def = good, def.group = &(pls_group_id){7}, def.group_count = 1, expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "does not exist");
    MUST(pls_world_set_material_value(b.scene.world, b.scene.grain, "poisson_ratio", 0.3));
    def = good, def.ops = laws[1], expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "Poisson's ratio 1/4");
    MUST(pls_world_set_material_value(b.scene.world, b.scene.grain, "poisson_ratio", 0.7));
    def = good, expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "between -1 and 0.5");
    MUST(pls_world_set_material_value(b.scene.world, b.scene.grain, "poisson_ratio", 0.3));
    MUST(pls_world_set_material_value(b.scene.world, b.scene.grain, "young_modulus", -2.0));
    expect(b.scene.world, &good, PLS_INVALID_ARGUMENT, "must be positive");
    MUST(pls_world_set_material_value(b.scene.world, b.scene.grain, "young_modulus", 2.0));
    pls_body_def twin = verify_body_def(&b.scene, b.scene.ball, b.reference[5]);
    twin.mass = 1.0;
    verify_add(&b.scene, &twin);
    expect(b.scene.world, &good, PLS_INVALID_ARGUMENT, "lie in one place");
    lattice_free(&b);

    plan.periodic = true, plan.count[0] = plan.count[1] = plan.count[2] = 7;
    b = lattice_make(&plan);
    def = good, def.horizon = 0.36, expect(b.scene.world, &def, PLS_INVALID_ARGUMENT, "less than two horizons");
    lattice_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(independent_springs_have_the_bulk_modulus_inside),
        cmocka_unit_test(corrections_give_surfaces_the_energy_of_the_inside),
        cmocka_unit_test(corrections_leave_materials_and_volumes_what_they_are),
        cmocka_unit_test(critical_stretches_are_those_of_the_literature),
        cmocka_unit_test(the_stable_step_is_the_limit),
        cmocka_unit_test(wrong_sets_are_refused_with_the_reason),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
