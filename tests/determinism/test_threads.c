// test_threads.c -- the same bits on any number of threads.
#include "support/heap.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

enum { LOOKS = 4, STEPS = 100 };

static void run_on(int threads, const heap_setup *setup, uint64_t *hashes, size_t *contacts)
{
    MUST(pls_set_threads(threads));
    heap h = heap_open(*setup);
    for (int look = 0; look < LOOKS; ++look)
    {
        MUST(pls_world_run(h.scene.world, STEPS));
        hashes[look] = verify_hash(h.scene.world);
        if (look == 1) heap_change_bodies(&h);
    }
    *contacts = pls_world_contact_count(h.scene.world);
    heap_close(&h);
}

static void compare_threads(heap_setup setup)
{
    uint64_t reference[LOOKS], hashes[LOOKS];
    size_t contacts;
    run_on(1, &setup, reference, &contacts);
    assert_true(contacts > (size_t)setup.count / 10);
    for (int threads = 2; threads <= 4; ++threads)
    {
        run_on(threads, &setup, hashes, &contacts);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_3d_between_walls),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_3d_periodic),
        cmocka_unit_test(hash_is_equal_on_1_to_4_threads_in_2d),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
