// test_threads.c -- the same bits on any number of threads.
#include "support/heap.h"
#include "support/numbers.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

enum { LOOKS = 4, STEPS = 100 };

static void run_on(int threads, const heap_setup *setup, uint64_t *hashes)
{
    MUST(pls_set_threads(threads));
    heap h = heap_open(*setup);
    for (int look = 0; look < LOOKS; ++look)
    {
        MUST(pls_world_run(h.scene.world, STEPS));
        hashes[look] = verify_hash(h.scene.world);
        if (look == 1) heap_change_bodies(&h);
    }
    heap_expect_contacts(&h);
    heap_close(&h);
}

static void compare_threads(heap_setup setup)
{
    uint64_t reference[LOOKS], hashes[LOOKS];
    run_on(1, &setup, reference);
    for (int threads = 2; threads <= 4; ++threads)
    {
        run_on(threads, &setup, hashes);
        assert_memory_equal(hashes, reference, sizeof hashes);
    }
    MUST(pls_set_threads(0));
}

static void hash_is_equal_on_1_to_4_threads_in_3d_between_walls(void **state)
{
    (void)state;
    compare_threads(heap_default(3, 2500));
}

static void hash_is_equal_on_1_to_4_threads_in_3d_periodic(void **state)
{
    (void)state;
    heap_setup setup = heap_default(3, 1500);
    setup.periodic = true;
    compare_threads(setup);
}

static void hash_is_equal_on_1_to_4_threads_in_2d(void **state)
{
    (void)state;
    heap_setup setup = heap_default(2, 1200);
    compare_threads(setup);
    setup.periodic = true;
    compare_threads(setup);
}

static void hash_is_equal_on_1_to_4_threads_in_dense_heaps_of_equal_spheres(void **state)
{
    (void)state;
    compare_threads(heap_dense(3, 1728, 1.0, false));
    compare_threads(heap_dense(3, 1728, 1.0, true));
    compare_threads(heap_dense(2, 1600, 1.0, false));
}

static void hash_is_equal_on_1_to_4_threads_in_dense_heaps_of_two_sizes(void **state)
{
    (void)state;
    compare_threads(heap_dense(3, 1728, 2.5, false));
    compare_threads(heap_dense(3, 1000, 2.5, true));
    compare_threads(heap_dense(2, 1600, 2.5, false));
}

/// A brick that falls on a floor.
static verify_scene brick_open(void)
{
    const verify_value rough[] = {{"kn", 1e4}, {"ks", 8e3}, {"cn", 5.0}, {"cs", 5.0}, {"friction", 0.3}, {NULL, 0.0}};
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-4;
    def.coordination = 2;
    verify_scene scene = verify_open(&def, "viscoelastic", rough);
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    pls_body_def body = verify_body_def(&scene, verify_add_shape(&scene, "box", NUMBERS(0.3, 0.2, 0.1, 0.0)), pls_vec(0, 0, 0.11));
    body.velocity = pls_vec(0.1, 0.2, -1.0);
    verify_add(&scene, &body);
    return scene;
}

/// Small worlds, one for each thread of a team of the caller's, as in a study of parameters: each goes its way as it does alone.
static void worlds_in_a_team_of_the_caller_go_their_own_ways(void **state)
{
    (void)state;
    enum { WORLDS = 3 };
    uint64_t alone[2];
    for (int round = 0; round < 2; ++round)
    {
        heap h[WORLDS];
        verify_scene brick[WORLDS];
        pls_status status[2 * WORLDS];
        const int worlds = round == 0 ? 1 : WORLDS;
        for (int k = 0; k < worlds; ++k)
        {
            h[k] = heap_open(heap_default(3, 60)), brick[k] = brick_open();
            MUST(pls_world_prepare(h[k].scene.world));
            MUST(pls_world_prepare(brick[k].world));
        }
#pragma omp parallel for schedule(static, 1) num_threads(WORLDS) if (round > 0)
        for (int k = 0; k < worlds; ++k)
        {
            status[2 * k] = pls_world_run(h[k].scene.world, 5 * STEPS);
            status[2 * k + 1] = pls_world_run(brick[k].world, 5 * STEPS);
        }
        for (int k = 0; k < worlds; ++k)
        {
            MUST(status[2 * k]);
            MUST(status[2 * k + 1]);
            const uint64_t hash[2] = {verify_hash(h[k].scene.world), verify_hash(brick[k].world)};
            if (round == 0) alone[0] = hash[0], alone[1] = hash[1];
            assert_memory_equal(hash, alone, sizeof hash);
            heap_close(&h[k]);
            verify_close(&brick[k]);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_3d_between_walls),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_3d_periodic),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_2d),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_dense_heaps_of_equal_spheres),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_dense_heaps_of_two_sizes),
        cmocka_unit_test(worlds_in_a_team_of_the_caller_go_their_own_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
