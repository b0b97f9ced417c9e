// test_solid_restart.c -- a pile of grains of all shapes, saved in the middle of settling and put back into a fresh world, goes on with the same bits.
#include "support/grains.h"
#include "support/snapshot.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

/// Grains of all shapes dropped into a box; `faces` of all contacts.
static verify_scene open_pile(int dimension, pls_faces faces)
{
    enum { COUNT = 2 * GRAIN_QUICK_KINDS + 1, CONE = 9 }; // two of each kind and a cone among them
    pls_world_def def = pls_default_world_def(dimension);
    def.dt = 2.5e-4;
    verify_scene scene =
        verify_open(&def, "viscoelastic",
                    (const verify_value[]){{"kn", 2000.0}, {"ks", 1500.0}, {"cn", 3.0}, {"cs", 2.0}, {"friction", 0.5}, {NULL, 0.0}});
    verify_set_faces(&scene, faces, faces == PLS_FACES_VOLUME ? 0.1 : 0.0);
    const pls_vec3 up = dimension == 3 ? pls_vec(0, 0, 1) : pls_vec(0, 1, 0);
    verify_wall(&scene, pls_vec(0, 0, 0), up);
    verify_wall(&scene, pls_vec(-0.45, 0, 0), pls_vec(1, 0, 0));
    verify_wall(&scene, pls_vec(2.55, 0, 0), pls_vec(-1, 0, 0));
    if (dimension == 3) verify_wall(&scene, pls_vec(0, -0.45, 0), pls_vec(0, 1, 0));
    if (dimension == 3) verify_wall(&scene, pls_vec(0, 1.15, 0), pls_vec(0, -1, 0));
    pls_shape_id shape[GRAIN_KINDS];
    for (int k = 0; k < GRAIN_KINDS; ++k) shape[k] = grain_shape(&scene, (enum grain_kind)k);
    for (int k = 0; k < COUNT; ++k)
    {
        const double across = 0.7 * (k % 4), along = dimension == 3 ? 0.7 * (k / 4 % 2) : 0.0;
        const pls_vec3 low = pls_vec(across, along, 0);
        const double height = 0.4 + 0.7 * (dimension == 3 ? k / 8 : k / 4);
        pls_body_def grain =
            grain_def(&scene, shape[k == CONE ? GRAIN_CONE : k % GRAIN_QUICK_KINDS], (uint64_t)k, pls_add(low, pls_scale(up, height)));
        grain.velocity = pls_scale(up, -2.0);
        verify_add(&scene, &grain);
    }
    MUST(pls_world_add_gravity(scene.world, pls_scale(up, -10.0)));
    return scene;
}

static void compare(int dimension, pls_faces faces)
{
    static const int lengths[] = {1, 20, 150};
    enum { LENGTHS = sizeof lengths / sizeof *lengths, WARM_UP = 1500 };
    snapshot copies[LENGTHS] = {0};
    uint64_t hashes[LENGTHS];
    verify_scene scene = open_pile(dimension, faces);
    MUST(pls_world_run(scene.world, WARM_UP));
    assert_true(pls_world_contact_count(scene.world) > 12);
    for (int step = 1; step <= 2 * lengths[LENGTHS - 1]; ++step)
    {
        MUST(pls_step(scene.world));
        for (int k = 0; k < LENGTHS; ++k)
        {
            if (step == 2 * lengths[k]) hashes[k] = verify_hash(scene.world);
            if (step == lengths[k]) MUST(snapshot_take(scene.world, &copies[k]));
        }
    }
    verify_close(&scene);
    for (int k = 0; k < LENGTHS; ++k)
    {
        verify_scene fresh = open_pile(dimension, faces);
        MUST(snapshot_put(fresh.world, &copies[k]));
        snapshot_free(&copies[k]);
        MUST(pls_world_run(fresh.world, (uint64_t)lengths[k]));
        assert_int_equal(verify_hash(fresh.world), hashes[k]);
        verify_close(&fresh);
    }
}

static void restart_changes_no_bit_of_a_pile_of_all_shapes_touching_at_points(void **state)
{
    (void)state;
    compare(3, PLS_FACES_POINT);
}

static void restart_changes_no_bit_of_a_pile_of_all_shapes_touching_with_faces(void **state)
{
    (void)state;
    compare(3, PLS_FACES_MANIFOLD);
    compare(3, PLS_FACES_VOLUME);
}

static void restart_changes_no_bit_of_a_pile_of_all_shapes_in_2d(void **state)
{
    (void)state;
    compare(2, PLS_FACES_MANIFOLD);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restart_changes_no_bit_of_a_pile_of_all_shapes_touching_at_points),
        cmocka_unit_test(restart_changes_no_bit_of_a_pile_of_all_shapes_touching_with_faces),
        cmocka_unit_test(restart_changes_no_bit_of_a_pile_of_all_shapes_in_2d),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
