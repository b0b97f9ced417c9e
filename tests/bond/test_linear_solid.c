// test_linear_solid.c -- the linear peridynamic solid against its formulas, exact states of strain, and LAMMPS.
#include "support/lattice.h"

#include "base/random.h"
#include "step/world.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

static pls_vec3 wavy(pls_vec3 X, const void *context)
{
    (void)context;
    return pls_vec(X.x + 0.01 * sin(3.0 * X.y + X.x), 1.02 * X.y - 0.02 * X.x + 0.01 * X.x * X.z, X.z + 0.015 * X.z * cos(4.0 * X.x));
}

static pls_vec3 wavy_plane(pls_vec3 X, const void *context)
{
    (void)context;
    return pls_vec(X.x + 0.01 * sin(3.0 * X.y + X.x), 1.02 * X.y - 0.02 * X.x + 0.01 * X.x * X.y, 0.0);
}

/// Forces may be off by what a float leaves of B_i + B_j: 2^-24 of it.
static void compare_with_oracle(const lattice_plan *plan)
{
    lattice b = lattice_make(plan);
    pls_vec3 *x = calloc(b.points, sizeof *x), *force = calloc(b.points, sizeof *force);
    double *energy = calloc(b.points, sizeof *energy), largest = 0.0, worst = 0.0, theirs = 0.0, ours = 0.0;
    lattice_deform(&b, plan->dimension == 3 ? wavy : wavy_plane, NULL);
    for (size_t p = 0; p < b.points; ++p) x[p] = verify_motion(b.scene.world, b.body[p]).position;
    lattice_oracle(&b, x, force, energy);
    for (size_t p = 0; p < b.points; ++p)
    {
        largest = fmax(largest, pls_length(force[p]));
        worst = fmax(worst, pls_length(pls_sub(force[p], lattice_force(&b, p))));
        theirs += energy[p], ours += lattice_energy(&b, p); // bonds share theirs in another way, so that points differ near surfaces
    }
    assert_true(largest > 0.0);
    if (fabs(ours / theirs - 1.0) > 1e-8) fail_msg("%dD: energies differ by %g", plan->dimension, ours / theirs - 1.0);
    if (worst > 0x1p-24 * largest) fail_msg("forces differ by %g of the largest", worst / largest);
    free(x), free(force), free(energy);
    lattice_free(&b);
}

static void forces_and_energies_are_those_of_the_formulas(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
        for (int w = PLS_INFLUENCE_ONE; w <= PLS_INFLUENCE_GAUSSIAN; ++w)
            for (int plane = 0; plane < (dimension == 2 ? 2 : 1); ++plane)
            {
                lattice_plan plan = lattice_default(dimension, dimension == 2 ? 17 : 8);
                plan.influence = (pls_influence)w;
                plan.plane = (pls_plane)plane;
                plan.thickness = 0.3;
                plan.count[0] += 2;
                compare_with_oracle(&plan);
            }
}

static pls_vec3 affine(pls_vec3 X, const void *context)
{
    const double *F = context;
    return pls_vec(F[0] * X.x + F[1] * X.y, F[2] * X.x + F[3] * X.y, F[4] * X.z);
}

static void uniform_dilation_stores_half_k_theta_squared(void **state)
{
    (void)state;
    const double s = 1e-3, F[5] = {1.0 + s, 0.0, 0.0, 1.0 + s, 1.0 + s};
    for (int w = PLS_INFLUENCE_ONE; w <= PLS_INFLUENCE_GAUSSIAN; ++w)
    {
        lattice_plan plan = lattice_default(3, 15);
        plan.influence = (pls_influence)w;
        lattice b = lattice_make(&plan);
        lattice_deform(&b, affine, F);
        const size_t middle = lattice_at(&b, 7, 7, 7);
        const double W = lattice_energy(&b, middle) / lattice_volume(&b);
        assert_true(fabs(W / (4.5 * plan.bulk * s * s) - 1.0) < 1e-10);
        assert_true(pls_length(lattice_force(&b, middle)) < 1e-11 * plan.bulk * s * plan.spacing * plan.spacing);
        lattice_free(&b);
    }
    for (int plane = 0; plane < 2; ++plane)
    {
        lattice_plan plan = lattice_default(2, 15);
        plan.plane = (pls_plane)plane;
        lattice b = lattice_make(&plan);
        lattice_deform(&b, affine, F);
        const double K = plan.bulk, mu = plan.shear, k2 = plane == PLS_PLANE_STRESS ? 9.0 * K * mu / (3.0 * K + 4.0 * mu) : K + mu / 3.0;
        const double W = lattice_energy(&b, lattice_at(&b, 7, 7, 0)) / lattice_volume(&b);
        assert_true(fabs(W / (2.0 * k2 * s * s) - 1.0) < 1e-10);
        lattice_free(&b);
    }
}

static void a_turned_block_feels_nothing(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 8);
    lattice b = lattice_make(&plan);
    const double c = cos(0.7), s = sin(0.7), F[5] = {c, -s, s, c, 1.0};
    lattice_deform(&b, affine, F);
    for (size_t p = 0; p < b.points; ++p) assert_true(pls_length(lattice_force(&b, p)) < 1e-12 * plan.bulk * plan.spacing * plan.spacing);
    lattice_free(&b);
}

static void a_periodic_block_has_no_surface(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 7);
    plan.periodic = true;
    lattice b = lattice_make(&plan);
    pls_bonds_figures f;
    MUST(pls_world_bonds_figures(b.scene.world, b.bonds, &f));
    assert_int_equal(f.bonds, 343 * 122); // partners within 3 spacings on a cubic lattice
    lattice_deform(&b, affine, (const double[5]){1.0, 0.0, 0.0, 1.0, 1.0});
    for (size_t p = 0; p < b.points; ++p) assert_true(pls_length(lattice_force(&b, p)) < 1e-12 * plan.bulk * plan.spacing * plan.spacing);
    // One point moved: the others pull it back as they would in a large block.
    lattice_plan open = lattice_default(3, 15);
    lattice large = lattice_make(&open);
    pls_vec3 *x = calloc(large.points, sizeof *x), *force = calloc(large.points, sizeof *force);
    for (size_t p = 0; p < large.points; ++p) x[p] = large.reference[p];
    const size_t middle = lattice_at(&large, 7, 7, 7), corner = lattice_at(&b, 0, 0, 0);
    x[middle] = pls_add(x[middle], pls_vec(1e-3, 2e-3, -1e-3));
    lattice_oracle(&large, x, force, NULL);
    pls_body_place *place = &b.scene.world->bodies.place[pls_body_row(b.scene.world, b.body[corner])];
    place->x += 1e-3, place->y += 2e-3, place->z -= 1e-3;
    lattice moved = b;
    moved.reference = malloc(b.points * sizeof *moved.reference);
    for (size_t p = 0; p < b.points; ++p) moved.reference[p] = b.reference[p];
    moved.reference[corner] = pls_vec(1e-3, 2e-3, -1e-3);
    lattice_deform(&moved, affine, (const double[5]){1.0, 0.0, 0.0, 1.0, 1.0});
    assert_true(pls_length(pls_sub(lattice_force(&moved, corner), force[middle])) < 1e-8 * pls_length(force[middle]));
    free(moved.reference), free(x), free(force);
    lattice_free(&large);
    lattice_free(&b);
}

// The block of tests/data/lps_block_lammps.csv: 9 x 7 x 5 points, K = 10 Pa, mu = 4 Pa, 100 steps of 1e-4 s.
static void a_block_moves_as_in_lammps(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 5);
    plan.count[0] = 9, plan.count[1] = 7;
    plan.spacing = 0.008, plan.horizon = 3.015 * 0.008, plan.density = 1.0, plan.dt = 1e-4, plan.contact_stiffness = 1e-9;
    lattice b = lattice_make(&plan);
    double *row = calloc(9 * b.points, sizeof *row), worst = 0.0, largest = 0.0;
    FILE *file = fopen(PLS_TEST_DATA "/lps_block_lammps.csv", "r");
    char line[400];
    assert_non_null(file);
    assert_non_null(fgets(line, sizeof line, file));
    for (size_t p = 0; p < b.points; ++p)
    {
        double *v = row + 9 * p;
        assert_non_null(fgets(line, sizeof line, file));
        assert_int_equal(sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3, v + 4, v + 5, v + 6, v + 7, v + 8), 9);
        assert_true(pls_length(pls_sub(pls_vec(v[0], v[1], v[2]), b.reference[p])) < 1e-12);
        MUST(pls_body_set_velocity(b.scene.world, b.body[p], pls_vec(v[3], v[4], v[5]), pls_vec(0, 0, 0)));
    }
    fclose(file);
    MUST(pls_world_run(b.scene.world, 100));
    for (size_t p = 0; p < b.points; ++p)
    {
        const pls_vec3 theirs = pls_sub(pls_vec(row[9 * p + 6], row[9 * p + 7], row[9 * p + 8]), b.reference[p]);
        const pls_vec3 ours = pls_sub(verify_motion(b.scene.world, b.body[p]).position, b.reference[p]);
        largest = fmax(largest, pls_length(theirs));
        worst = fmax(worst, pls_length(pls_sub(ours, theirs)));
    }
    if (worst > 1e-5 * largest) fail_msg("displacements differ by %g of the largest", worst / largest);
    print_message("displacements differ from LAMMPS by %.2g of the largest\n", worst / largest);
    free(row);
    lattice_free(&b);
}

static void momenta_are_kept_and_energy_is_bounded(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 6);
    plan.dt = 2e-3;
    lattice b = lattice_make(&plan);
    for (size_t p = 0; p < b.points; ++p)
    {
        pls_random random = pls_random_stream(5, (uint32_t)p, PLS_FOR_USER);
        const double x = pls_random_uniform(&random), y = pls_random_uniform(&random), z = pls_random_uniform(&random);
        MUST(pls_body_set_velocity(b.scene.world, b.body[p], pls_vec(0.02 * (x - 0.5), 0.02 * (y - 0.5), 0.02 * (z - 0.5)),
                                   pls_vec(0, 0, 0)));
    }
    const pls_world_figures before = verify_figures(b.scene.world);
    MUST(pls_world_run(b.scene.world, 5000));
    const pls_world_figures after = verify_figures(b.scene.world);
    pls_bonds_figures bonds;
    MUST(pls_world_bonds_figures(b.scene.world, b.bonds, &bonds));
    assert_true(bonds.energy > 0.2 * before.energy_kinetic);
    assert_true(fabs(after.energy_kinetic + bonds.energy - before.energy_kinetic) < 1e-3 * before.energy_kinetic);
    const double scale = sqrt(2.0 * before.energy_kinetic * (double)b.points * plan.density * lattice_volume(&b));
    assert_true(pls_length(pls_sub(after.momentum, before.momentum)) < 1e-13 * scale);
    assert_true(pls_length(pls_sub(after.angular_momentum, before.angular_momentum)) < 1e-13 * scale);
    lattice_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_and_energies_are_those_of_the_formulas),
        cmocka_unit_test(uniform_dilation_stores_half_k_theta_squared),
        cmocka_unit_test(a_turned_block_feels_nothing),
        cmocka_unit_test(a_periodic_block_has_no_surface),
        cmocka_unit_test(a_block_moves_as_in_lammps),
        cmocka_unit_test(momenta_are_kept_and_energy_is_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
