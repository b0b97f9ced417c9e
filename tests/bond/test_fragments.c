// test_fragments.c -- what bonds hold together: counted, weighed, followed, against what was cut.
#include "support/lattice.h"

#include <particls/observe.h>

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

/// A bar of 10 x 4 x 2 points at distance 1, each bonded to its 6 nearest.
static lattice bar(void)
{
    lattice_plan plan = lattice_default(3, 2);
    plan.count[0] = 10, plan.count[1] = 4;
    plan.horizon = 1.2 * plan.spacing;
    return lattice_make(&plan);
}

static pls_fragments fragments_of(const lattice *b)
{
    pls_collection_def def = pls_default_collection_def();
    def.quantities = PLS_MEASURE_FRAGMENTS;
    pls_collection measured;
    MUST(pls_measure_collection(b->scene.world, &def, &measured));
    return measured.fragments;
}

/// A crack across x = `x` spacings, from y = `low` to `high` spacings and through all of z.
static void cut_across(lattice *b, double x, double low, double high)
{
    const double s = b->plan.spacing, far = 100.0 * s;
    const pls_vec3 corner[4] = {{x * s, low * s, -far}, {x * s, high * s, -far}, {x * s, high * s, far}, {x * s, low * s, far}};
    size_t cut;
    MUST(pls_world_cut_bonds(b->scene.world, b->bonds, corner[0], corner[1], corner[2], &cut));
    MUST(pls_world_cut_bonds(b->scene.world, b->bonds, corner[0], corner[2], corner[3], &cut));
}

static void cracks_part_a_bar_when_they_go_all_the_way(void **state)
{
    (void)state;
    lattice b = bar();
    const double point = verify_motion(b.scene.world, b.body[0]).mass;
    pls_fragments f = fragments_of(&b);
    assert_true(f.count == 1 && f.single == 0 && f.bodies == 80 && f.second == 0.0);
    assert_true(fabs(f.largest / (80 * point) - 1.0) < 1e-12 && fabs(f.mean / f.largest - 1.0) < 1e-12);
    cut_across(&b, 2.5, -1.0, 2.5); // a row of points is left across
    assert_int_equal(fragments_of(&b).count, 1);
    cut_across(&b, 2.5, 2.2, 4.0);
    f = fragments_of(&b);
    assert_true(f.count == 2 && f.single == 0 && f.bodies == 56);
    assert_true(fabs(f.largest / (56 * point) - 1.0) < 1e-12 && fabs(f.second / (24 * point) - 1.0) < 1e-12);
    assert_true(fabs(f.mean / (40 * point) - 1.0) < 1e-12);
    lattice_free(&b);
}

static void the_largest_is_followed(void **state)
{
    (void)state;
    lattice b = bar();
    cut_across(&b, 6.5, -1.0, 4.0);
    for (size_t k = 0; k < b.points; ++k)
        MUST(pls_body_set_velocity(b.scene.world, b.body[k], pls_vec(b.reference[k].x > 6.5 * b.plan.spacing ? 3.0 : -2.0, 0.5, 0.0),
                                   pls_vec(0, 0, 0)));
    const pls_fragments f = fragments_of(&b);
    assert_true(f.count == 2 && f.bodies == 56);
    assert_true(fabs(f.momentum.x / (-2.0 * f.largest) - 1.0) < 1e-12 && fabs(f.momentum.y / (0.5 * f.largest) - 1.0) < 1e-12);
    lattice_free(&b);
}

/// What a body that leaves held is parted.
static void fragments_of_one_are_counted(void **state)
{
    (void)state;
    lattice b = bar();
    cut_across(&b, 0.5, -1.0, 4.0);
    cut_across(&b, 1.5, -1.0, 4.0);
    assert_int_equal(fragments_of(&b).count, 3);
    for (size_t j = 1; j < 4; ++j)
        for (size_t k = 0; k < 2; ++k) MUST(pls_world_remove_body(b.scene.world, b.body[lattice_at(&b, 0, j, k)]));
    MUST(pls_world_remove_body(b.scene.world, b.body[lattice_at(&b, 0, 0, 1)]));
    const pls_fragments f = fragments_of(&b);
    assert_true(f.count == 3 && f.single == 1 && f.bodies == 64);
    lattice_free(&b);
}

static void grains_without_bonds_are_none(void **state)
{
    (void)state;
    lattice b = bar();
    verify_ball(&b.scene, 1.0, 1.0, pls_vec(50.0, 0.0, 0.0), pls_vec(0.0, 0.0, 0.0));
    assert_int_equal(fragments_of(&b).count, 1);
    lattice_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cracks_part_a_bar_when_they_go_all_the_way),
        cmocka_unit_test(the_largest_is_followed),
        cmocka_unit_test(fragments_of_one_are_counted),
        cmocka_unit_test(grains_without_bonds_are_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
