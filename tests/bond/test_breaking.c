// test_breaking.c -- bonds that break: when, for good, at both ends, with their energy booked; and what touches afterwards.
#include "support/lattice.h"
#include "support/snapshot.h"

#include "base/random.h"
#include "step/world.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static pls_bonds_figures figures_of(const lattice *b)
{
    pls_bonds_figures f;
    MUST(pls_world_bonds_figures(b->scene.world, b->bonds, &f));
    return f;
}

/// Two points, one bond.
static lattice make_pair(double critical_stretch, double dt)
{
    lattice_plan plan = lattice_default(3, 1);
    plan.count[0] = 2;
    plan.horizon = 1.5 * plan.spacing;
    plan.critical_stretch = critical_stretch;
    plan.law = "bond_based";
    plan.shear = 0.6 * plan.bulk;
    plan.dt = dt;
    return lattice_make(&plan);
}

static void set_speeds(lattice *b, double left, double right)
{
    MUST(pls_body_set_velocity(b->scene.world, b->body[0], pls_vec(left, 0, 0), pls_vec(0, 0, 0)));
    MUST(pls_body_set_velocity(b->scene.world, b->body[1], pls_vec(right, 0, 0), pls_vec(0, 0, 0)));
}

static double distance(const lattice *b)
{
    return verify_motion(b->scene.world, b->body[1]).position.x - verify_motion(b->scene.world, b->body[0]).position.x;
}

static void a_bond_breaks_at_its_critical_stretch(void **state)
{
    (void)state;
    lattice b = make_pair(0.02, 1e-4);
    set_speeds(&b, -0.5, 0.5);
    double before = distance(&b);
    for (int k = 0; k < 1000 && figures_of(&b).broken == 0; ++k)
    {
        before = distance(&b);
        MUST(pls_step(b.scene.world));
    }
    assert_true(before <= 1.02 * b.plan.spacing && distance(&b) > 1.02 * b.plan.spacing);
    assert_int_equal(figures_of(&b).broken, 2);
    assert_true(pls_world_bonds_damage(b.scene.world, b.bonds, b.body[0]) == 1.0 &&
                pls_world_bonds_damage(b.scene.world, b.bonds, b.body[1]) == 1.0);
    lattice_free(&b);
}

/// A bond pushes where points come nearer, and is all there is between them; where it is broken they touch as grains do.
static void points_touch_when_their_bond_is_broken_and_only_then(void **state)
{
    (void)state;
    lattice b = make_pair(INFINITY, 1e-4);
    set_speeds(&b, 0.1, -0.1);
    MUST(pls_world_run(b.scene.world, 50));
    assert_true(distance(&b) < b.plan.spacing - 1e-5);
    assert_int_equal(pls_world_contact_count(b.scene.world), 0);
    lattice_free(&b);

    b = make_pair(1e-3, 1e-4);
    set_speeds(&b, -0.5, 0.5);
    MUST(pls_world_run(b.scene.world, 10));
    assert_int_equal(figures_of(&b).broken, 2);
    set_speeds(&b, 0.5, -0.5);
    size_t steps = 0;
    while (pls_world_contact_count(b.scene.world) == 0 && ++steps < 1000) MUST(pls_step(b.scene.world));
    assert_true(distance(&b) < b.plan.spacing && distance(&b) > b.plan.spacing - 2e-4); // radii are half a spacing
    // From here on the spring of the contact alone: kn = 1 N/m between masses m, half a period after which they leave.
    const double m = verify_motion(b.scene.world, b.body[0]).mass, deepest = 1.0 * sqrt(0.5 * m / b.plan.contact_stiffness);
    double least = INFINITY;
    for (; pls_world_contact_count(b.scene.world) > 0 && steps < 100000; ++steps)
    {
        least = fmin(least, distance(&b));
        MUST(pls_step(b.scene.world));
    }
    assert_true(fabs((b.plan.spacing - least) / deepest - 1.0) < 1e-2);
    lattice_free(&b);
}

/// A block torn apart; a tenth of its bonds break.
static lattice make_torn(double dt)
{
    lattice_plan plan = lattice_default(3, 6);
    plan.count[0] = 12;
    plan.critical_stretch = 0.01;
    plan.contact_stiffness = 2.0;
    plan.dt = dt;
    lattice b = lattice_make(&plan);
    for (size_t p = 0; p < b.points; ++p)
    {
        pls_random random = pls_random_stream(7, (uint32_t)p, PLS_FOR_USER);
        const double x = pls_random_uniform(&random) - 0.5, y = pls_random_uniform(&random) - 0.5;
        const double pull = b.reference[p].x > 0.55 ? 0.06 : -0.06;
        MUST(pls_body_set_velocity(b.scene.world, b.body[p], pls_vec(pull + 0.01 * x, 0.01 * y, -0.02 * b.reference[p].x),
                                   pls_vec(0, 0, 0)));
    }
    return b;
}

/// What the book of energy is off by after 3 s, by the energy of the start.
static double book_error(double dt)
{
    lattice b = make_torn(dt);
    const double before = verify_total_energy(b.scene.world);
    const pls_vec3 momentum = verify_figures(b.scene.world).momentum;
    MUST(pls_world_run(b.scene.world, (uint64_t)(3.0 / dt + 0.5)));
    const pls_bonds_figures f = figures_of(&b);
    assert_true(f.broken > f.bonds / 50 && f.broken < f.bonds / 2);
    assert_true(f.energy_broken > 0.05 * before);
    assert_true(pls_length(pls_sub(verify_figures(b.scene.world).momentum, momentum)) < 1e-13);
    const double error = verify_total_energy(b.scene.world) / before - 1.0;
    lattice_free(&b);
    return error;
}

static void energy_of_broken_bonds_is_booked_to_second_order(void **state)
{
    (void)state;
    const double coarse = book_error(2e-3), fine = book_error(1e-3);
    assert_true(fabs(coarse) < 5e-4);
    assert_true(fabs(fine) < 0.35 * fabs(coarse));
}

/// A block that stretches ever more, its bonds (or beams) breaking one after the other.
static lattice make_stretching(bool beams)
{
    lattice_plan plan = lattice_default(3, 5);
    plan.count[0] = 10;
    plan.dt = beams ? 2e-4 : 2e-3;
    if (beams) plan.law = "beam", plan.horizon = 0.15;
    if (!beams) plan.critical_stretch = 0.012;
    lattice b = lattice_make(&plan);
    for (size_t p = 0; p < b.points; ++p)
    {
        pls_random random = pls_random_stream(9, (uint32_t)p, PLS_FOR_USER);
        const double x = pls_random_uniform(&random) - 0.5, y = pls_random_uniform(&random) - 0.5, rate = beams ? 3 : 0.06,
                     noise = beams ? 1 : 0.06;
        MUST(pls_body_set_velocity(b.scene.world, b.body[p], pls_vec(rate * (b.reference[p].x - 0.45) + noise * x, noise * y, 0),
                                   pls_vec(x, y, 0)));
    }
    return b;
}

static uint64_t torn_hash(bool beams, int threads, size_t steps, size_t snapshot_at)
{
    pls_set_threads(threads);
    lattice b = make_stretching(beams);
    if (snapshot_at > 0)
    {
        snapshot copy = {0};
        MUST(pls_world_run(b.scene.world, snapshot_at));
        const size_t broken = figures_of(&b).broken;
        assert_true(broken > 0);
        MUST(snapshot_take(b.scene.world, &copy));
        lattice_free(&b);
        b = make_stretching(beams);
        MUST(snapshot_put(b.scene.world, &copy));
        assert_int_equal(figures_of(&b).broken, broken);
        snapshot_free(&copy);
        steps -= snapshot_at;
    }
    const size_t before = figures_of(&b).broken;
    MUST(pls_world_run(b.scene.world, steps));
    assert_true(figures_of(&b).broken > before && figures_of(&b).broken < figures_of(&b).bonds);
    const uint64_t hash = verify_hash(b.scene.world);
    lattice_free(&b);
    pls_set_threads(1);
    return hash;
}

static void bits_are_equal_for_threads_and_restarts_while_bonds_break(void **state)
{
    (void)state;
    for (int beams = 0; beams < 2; ++beams)
    {
        const uint64_t one = torn_hash(beams, 1, 600, 0);
        for (int threads = 2; threads <= 4; ++threads) assert_int_equal(torn_hash(beams, threads, 600, 0), one);
        assert_int_equal(torn_hash(beams, 1, 600, 260), one);
        assert_int_equal(torn_hash(beams, 2, 600, 431), one);
    }
}

static void a_state_does_not_mend_bonds(void **state)
{
    (void)state;
    lattice b = make_torn(2e-3);
    snapshot copy = {0};
    MUST(snapshot_take(b.scene.world, &copy));
    MUST(pls_world_run(b.scene.world, 600));
    assert_int_equal(snapshot_put(b.scene.world, &copy), PLS_CORRUPT);
    assert_non_null(strstr(pls_last_message(), "cannot be mended"));
    snapshot_free(&copy);
    lattice_free(&b);
}

static void corrupt_states_are_refused(void **state)
{
    (void)state;
    lattice b = make_torn(2e-3);
    snapshot copy = {0};
    MUST(snapshot_take(b.scene.world, &copy));
    const uint64_t numbers = copy.header.rows[PLS_TABLE_NUMBERS], bodies = copy.header.rows[PLS_TABLE_BODIES];
    copy.header.rows[PLS_TABLE_NUMBERS] = copy.header.rows[PLS_TABLE_BODIES] = numbers - 1;
    assert_int_equal(snapshot_put(b.scene.world, &copy), PLS_CORRUPT);
    assert_non_null(strstr(pls_last_message(), "have a body"));
    copy.header.rows[PLS_TABLE_NUMBERS] = numbers, copy.header.rows[PLS_TABLE_BODIES] = bodies;
    MUST(snapshot_put(b.scene.world, &copy));
    *(uint8_t *)copy.data[PLS_TABLE_BONDS][0] = 1;
    assert_int_equal(snapshot_put(b.scene.world, &copy), PLS_CORRUPT);
    assert_non_null(strstr(pls_last_message(), "at one end only"));
    snapshot_free(&copy);
    lattice_free(&b);
}

static pls_vec3 folded(pls_vec3 X, const void *context)
{
    const double spacing = *(const double *)context;
    return pls_vec(X.x < 0.5 * spacing ? X.x + spacing : X.x, X.y, X.z);
}

/// Nothing but touch acts between points whose bond is broken, wherever they are.
static void points_of_a_broken_bond_may_coincide(void **state)
{
    (void)state;
    for (int solid = 0; solid < 2; ++solid)
    {
        lattice_plan plan = lattice_default(3, 3);
        plan.horizon = 1.5 * plan.spacing;
        if (solid == 0) plan.law = "bond_based", plan.shear = 0.6 * plan.bulk;
        lattice b = lattice_make(&plan);
        size_t cut;
        MUST(pls_world_cut_bonds(b.scene.world, b.bonds, pls_vec(0.05, -9, -9), pls_vec(0.05, 30, -9), pls_vec(0.05, -9, 30), &cut));
        lattice_deform(&b, folded, &b.plan.spacing);
        for (size_t p = 0; p < b.points; ++p) assert_true(pls_length(lattice_force(&b, p)) < 1e-9);
        lattice_free(&b);
    }
}

static void a_cut_takes_the_bonds_that_cross_it(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 6);
    lattice b = lattice_make(&plan);
    size_t expected = 0, cut;
    for (size_t p = 0; p < b.points; ++p)
        for (size_t q = 0; q < b.points; ++q)
            if (p != q && pls_length(pls_sub(b.reference[p], b.reference[q])) <= plan.horizon &&
                (b.reference[p].x < 0.25) != (b.reference[q].x < 0.25))
                ++expected;
    MUST(pls_world_cut_bonds(b.scene.world, b.bonds, pls_vec(0.25, -9, -9), pls_vec(0.25, 30, -9), pls_vec(0.25, -9, 30), &cut));
    assert_int_equal(cut, expected);
    MUST(pls_world_cut_bonds(b.scene.world, b.bonds, pls_vec(0.25, -9, -9), pls_vec(0.25, 30, -9), pls_vec(0.25, -9, 30), &cut));
    assert_int_equal(cut, 0);
    MUST(pls_world_run(b.scene.world, 20)); // neighbours across the cut lie at touching distance
    assert_true(verify_figures(b.scene.world).energy_kinetic < 1e-20);
    lattice_free(&b);

    plan = lattice_default(2, 9);
    b = lattice_make(&plan);
    expected = 0;
    for (size_t p = 0; p < b.points; ++p) // the segment from (-1, 0.45) to (0.42, 0.45)
        for (size_t q = 0; q < b.points; ++q)
        {
            const pls_vec3 x = b.reference[p], y = b.reference[q];
            if (p == q || pls_length(pls_sub(x, y)) > plan.horizon || (x.y < 0.45) == (y.y < 0.45)) continue;
            if (x.x + (y.x - x.x) * (0.45 - x.y) / (y.y - x.y) <= 0.42) ++expected;
        }
    MUST(pls_world_cut_bonds(b.scene.world, b.bonds, pls_vec(-1, 0.45, 0), pls_vec(0.42, 0.45, 0), pls_vec(0, 0, 0), &cut));
    assert_int_equal(cut, expected);
    lattice_free(&b);
}

static void a_body_that_leaves_takes_its_bonds_along(void **state)
{
    (void)state;
    lattice_plan plan = lattice_default(3, 5);
    lattice b = lattice_make(&plan);
    const size_t middle = lattice_at(&b, 2, 2, 2), bonds = figures_of(&b).bonds;
    MUST(pls_world_run(b.scene.world, 3));
    MUST(pls_world_remove_body(b.scene.world, b.body[middle]));
    const size_t broken = figures_of(&b).broken;
    assert_true(broken > 100 && broken < bonds / 8);
    MUST(pls_world_run(b.scene.world, 50));
    assert_int_equal(figures_of(&b).broken, broken);
    assert_true(verify_figures(b.scene.world).energy_kinetic < 1e-20);
    lattice_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bond_breaks_at_its_critical_stretch),
        cmocka_unit_test(points_touch_when_their_bond_is_broken_and_only_then),
        cmocka_unit_test(energy_of_broken_bonds_is_booked_to_second_order),
        cmocka_unit_test(bits_are_equal_for_threads_and_restarts_while_bonds_break),
        cmocka_unit_test(a_state_does_not_mend_bonds),
        cmocka_unit_test(corrupt_states_are_refused),
        cmocka_unit_test(points_of_a_broken_bond_may_coincide),
        cmocka_unit_test(a_cut_takes_the_bonds_that_cross_it),
        cmocka_unit_test(a_body_that_leaves_takes_its_bonds_along),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
