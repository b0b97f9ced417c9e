// test_restart.c -- 2N steps give the same bits as N steps, a restart from what was saved, and N more; at ten different N, amid contacts.
#include "support/heap.h"
#include "support/snapshot.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static const int lengths[] = {1, 2, 3, 7, 20, 55, 101, 150, 233, 300};
enum {
    LENGTHS = sizeof lengths / sizeof *lengths,
    WARM_UP = 300 ///< steps until the spheres touch
};

/// The world after the warm-up, half of it followed by a change of bodies.
static heap open_warm(const heap_setup *setup)
{
    heap h = heap_open(*setup);
    MUST(pls_world_run(h.scene.world, WARM_UP / 2));
    heap_change_bodies(&h);
    MUST(pls_world_run(h.scene.world, WARM_UP / 2));
    return h;
}

static void compare_restarts(heap_setup setup)
{
    snapshot copies[LENGTHS] = {0};
    uint64_t hashes[LENGTHS];
    heap h = open_warm(&setup);
    assert_true(pls_world_contact_count(h.scene.world) > (size_t)setup.count / 10);
    // One undisturbed run passes all N and all 2N.
    int last = 2 * lengths[LENGTHS - 1];
    for (int step = 1; step <= last; ++step)
    {
        MUST(pls_step(h.scene.world));
        for (int k = 0; k < LENGTHS; ++k)
        {
            if (step == 2 * lengths[k]) hashes[k] = verify_hash(h.scene.world);
            if (step == lengths[k]) MUST(snapshot_take(h.scene.world, &copies[k]));
        }
    }
    heap_close(&h);
    for (int k = 0; k < LENGTHS; ++k)
    {
        heap fresh = heap_open(setup);
        MUST(snapshot_put(fresh.scene.world, &copies[k]));
        snapshot_free(&copies[k]);
        assert_int_equal(pls_world_step_number(fresh.scene.world), WARM_UP + lengths[k]);
        MUST(pls_world_run(fresh.scene.world, (uint64_t)lengths[k]));
        assert_int_equal(verify_hash(fresh.scene.world), hashes[k]);
        heap_close(&fresh);
    }
}

static void restart_at_ten_moments_changes_no_bit_in_3d(void **state)
{
    (void)state;
    compare_restarts(heap_default(3, 400));
}

static void restart_at_ten_moments_changes_no_bit_in_3d_periodic(void **state)
{
    (void)state;
    heap_setup setup = heap_default(3, 300);
    setup.periodic = true;
    compare_restarts(setup);
}

static void restart_at_ten_moments_changes_no_bit_in_2d(void **state)
{
    (void)state;
    compare_restarts(heap_default(2, 300));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restart_at_ten_moments_changes_no_bit_in_3d),
        cmocka_unit_test(restart_at_ten_moments_changes_no_bit_in_3d_periodic),
        cmocka_unit_test(restart_at_ten_moments_changes_no_bit_in_2d),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
