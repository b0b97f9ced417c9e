// test_threads.c -- the same bits on any number of threads.
#include "support/heap.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_3d_between_walls),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_3d_periodic),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_2d),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_dense_heaps_of_equal_spheres),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_dense_heaps_of_two_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
