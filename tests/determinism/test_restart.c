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
    heap_expect_contacts(&h);
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

static void restart_at_ten_moments_changes_no_bit_of_dense_heaps_of_equal_spheres(void **state)
{
    (void)state;
    compare_restarts(heap_dense(3, 1000, 1.0, false));
    compare_restarts(heap_dense(3, 1000, 1.0, true));
}

static void restart_at_ten_moments_changes_no_bit_of_dense_heaps_of_two_sizes(void **state)
{
    (void)state;
    compare_restarts(heap_dense(3, 1000, 2.5, false));
    compare_restarts(heap_dense(2, 1600, 2.5, true));
}

static void ids_given_after_a_restart_are_those_of_an_undisturbed_run(void **state)
{
    (void)state;
    heap_setup setup = heap_default(3, 100);
    heap h = heap_open(setup);
    pls_vec3 high = pls_vec(2, 2, 9), higher = pls_vec(2, 2, 11), still = pls_vec(0, 0, 0);
    // The largest number and one amid the others are given twice each and are free in the end.
    pls_body_id last = verify_ball(&h.scene, 0.4, 0.3, high, still), middle = h.middle;
    assert_int_equal(last.index1, pls_world_body_count(h.scene.world));
    MUST(pls_world_run(h.scene.world, 20));
    MUST(pls_world_remove_body(h.scene.world, last));
    last = verify_ball(&h.scene, 0.4, 0.3, high, still);
    MUST(pls_world_remove_body(h.scene.world, middle));
    middle = verify_ball(&h.scene, 0.4, 0.3, higher, still);
    MUST(pls_world_remove_body(h.scene.world, last));
    MUST(pls_world_remove_body(h.scene.world, middle));
    snapshot copy = {0};
    MUST(snapshot_take(h.scene.world, &copy));
    heap fresh = heap_open(setup);
    MUST(snapshot_put(fresh.scene.world, &copy));
    snapshot_free(&copy);
    heap *both[] = {&h, &fresh};
    for (int k = 0; k < 2; ++k)
    {
        pls_body_id first = verify_ball(&both[k]->scene, 0.4, 0.3, high, still);
        pls_body_id second = verify_ball(&both[k]->scene, 0.4, 0.3, higher, still);
        assert_int_equal(first.index1, middle.index1); // the smallest free number
        assert_int_equal(first.generation, 3);
        assert_int_equal(second.index1, last.index1);
        assert_int_equal(second.generation, 3);
        pls_body_motion motion;
        assert_int_equal(pls_body_get(both[k]->scene.world, last, &motion), PLS_STALE_ID);
        MUST(pls_world_run(both[k]->scene.world, 50));
    }
    assert_int_equal(verify_hash(fresh.scene.world), verify_hash(h.scene.world));
    heap_close(&h);
    heap_close(&fresh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(restart_at_ten_moments_changes_no_bit_in_3d),
        cmocka_unit_test(restart_at_ten_moments_changes_no_bit_in_3d_periodic),
        cmocka_unit_test(restart_at_ten_moments_changes_no_bit_in_2d),
        cmocka_unit_test(restart_at_ten_moments_changes_no_bit_of_dense_heaps_of_equal_spheres),
        cmocka_unit_test(restart_at_ten_moments_changes_no_bit_of_dense_heaps_of_two_sizes),
        cmocka_unit_test(ids_given_after_a_restart_are_those_of_an_undisturbed_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
