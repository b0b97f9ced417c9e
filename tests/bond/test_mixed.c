// test_mixed.c -- rigid grains of any shape against points of a continuum, and bodies that hold both: forces balance to round-off, energy is kept.
#include "support/lattice.h"
#include "support/verify.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static lattice make_block(double dt, double critical_stretch)
{
    lattice_plan plan = lattice_default(3, 8);
    plan.count[2] = 3;
    plan.dt = dt;
    plan.contact_stiffness = 2.0;
    plan.critical_stretch = critical_stretch;
    return lattice_make(&plan);
}

/// A grain above the middle of the block that comes down onto it.
static pls_body_id add_grain(lattice *b, const char *shape, double speed)
{
    const double ball[] = {0.15}, box[] = {0.12, 0.15, 0.1, 0.0}, can[] = {0.12, 0.2, 0.0};
    const bool is_box = strcmp(shape, "box") == 0, is_can = strcmp(shape, "cylinder") == 0;
    const pls_shape_id id = verify_add_shape(&b->scene, shape, is_box ? box : is_can ? can : ball, is_box ? 4 : is_can ? 3 : 1);
    pls_body_def def = verify_body_def(&b->scene, id, pls_vec(0.37, 0.33, 0.2 + 0.05 + 0.22));
    def.orientation = pls_quat_unit((pls_quat){1.0, 0.3, -0.2, 0.1});
    def.velocity = pls_vec(0.1 * speed, 0, -speed);
    def.mass = 0.03;
    def.inertia = pls_vec(2e-4, 3e-4, 2.5e-4);
    return verify_add(&b->scene, &def);
}

static pls_vec3 sum_of_forces(const lattice *b, pls_body_id grain, double *largest)
{
    const pls_vec3 on_grain = verify_motion(b->scene.world, grain).force;
    pls_vec3 sum = on_grain;
    for (size_t p = 0; p < b->points; ++p) sum = pls_add(sum, verify_motion(b->scene.world, b->body[p]).force);
    *largest = fmax(*largest, pls_length(on_grain));
    return sum;
}

static void forces_balance_to_round_off(void **state)
{
    (void)state;
    static const char *const shapes[] = {"sphere", "box", "cylinder"};
    for (size_t n = 0; n < 3; ++n)
    {
        lattice b = make_block(1e-3, 0.02);
        const pls_body_id grain = add_grain(&b, shapes[n], 0.5);
        const pls_world_figures before = verify_figures(b.scene.world);
        double largest = 0.0;
        for (int k = 0; k < 1200; ++k)
        {
            MUST(pls_step(b.scene.world));
            const pls_vec3 sum = sum_of_forces(&b, grain, &largest);
            assert_true(pls_length(sum) < 1e-13 * fmax(largest, 1.0));
        }
        const pls_world_figures after = verify_figures(b.scene.world);
        pls_bonds_figures bonds;
        MUST(pls_world_bonds_figures(b.scene.world, b.bonds, &bonds));
        assert_true(largest > 0.01 && bonds.broken > 0 && bonds.broken < bonds.bonds); // it hits, and breaks some
        assert_true(pls_length(pls_sub(after.momentum, before.momentum)) < 1e-14);
        assert_true(pls_length(pls_sub(after.angular_momentum, before.angular_momentum)) < 1e-13);
        lattice_free(&b);
    }
}

static double book_error(double dt, const char *shape)
{
    lattice b = make_block(dt, INFINITY);
    add_grain(&b, shape, 0.3);
    const double before = verify_total_energy(b.scene.world);
    MUST(pls_world_run(b.scene.world, (uint64_t)(1.6 / dt + 0.5)));
    const double error = verify_total_energy(b.scene.world) / before - 1.0;
    assert_true(verify_figures(b.scene.world).energy_bonds > 1e-3 * before);
    lattice_free(&b);
    return error;
}

static void energy_is_kept_in_an_impact(void **state)
{
    (void)state;
    static const char *const shapes[] = {"sphere", "box"};
    for (size_t n = 0; n < 2; ++n)
    {
        const double coarse = book_error(2e-3, shapes[n]), fine = book_error(1e-3, shapes[n]);
        if (!(fabs(coarse) < 2e-3 && fabs(fine) < fmax(0.4 * fabs(coarse), 1e-5))) fail_msg("%s: %g, then %g", shapes[n], coarse, fine);
    }
}

/// Points of a continuum of which some are also ends of beams that hold boxes: one body, both kinds of bonds, and contacts beside.
static void a_body_may_hold_both(void **state)
{
    (void)state;
    lattice b = make_block(2e-4, INFINITY);
    const double half[] = {0.05, 0.05, 0.05, 0.0}, values[] = {0.03, 0.0, 0.0};
    const pls_shape_id box = verify_add_shape(&b.scene, "box", half, 4);
    pls_group_id group;
    MUST(pls_world_add_group(b.scene.world, "chain", &group));
    for (int k = 0; k < 4; ++k) // a chain of boxes that begins in the middle of the upper layer
    {
        pls_body_def def = verify_body_def(&b.scene, box, pls_vec(0.3 + 0.01 * k, 0.3, 0.2 + 0.13 * (k + 1)));
        def.group = group;
        def.velocity = pls_vec(0.2, 0.05 * k, 0);
        def.mass = 0.003;
        verify_add(&b.scene, &def);
    }
    pls_bonds_def def = pls_default_bonds_def();
    pls_bonds_id id;
    strcpy(def.name, "beams");
    const pls_bond_ops *const *law = pls_builtin_bonds();
    while (strcmp((*law)->name, "beam") != 0) ++law;
    def.ops = *law;
    def.values = values;
    def.horizon = 0.14;
    MUST(pls_world_add_bonds(b.scene.world, &def, &id)); // all with all within reach: points, too
    const pls_world_figures before = verify_figures(b.scene.world);
    const double energy = verify_total_energy(b.scene.world);
    MUST(pls_world_run(b.scene.world, 4000));
    const pls_world_figures after = verify_figures(b.scene.world);
    assert_true(pls_length(pls_sub(after.momentum, before.momentum)) < 1e-14);
    assert_true(pls_length(pls_sub(after.angular_momentum, before.angular_momentum)) < 1e-13);
    assert_true(fabs(verify_total_energy(b.scene.world) / energy - 1.0) < 1e-3);
    pls_bonds_figures solid, beams;
    MUST(pls_world_bonds_figures(b.scene.world, b.bonds, &solid));
    MUST(pls_world_bonds_figures(b.scene.world, id, &beams));
    assert_true(solid.energy > 1e-6 * energy && beams.energy > 1e-6 * energy);
    lattice_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_balance_to_round_off),
        cmocka_unit_test(energy_is_kept_in_an_impact),
        cmocka_unit_test(a_body_may_hold_both),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
