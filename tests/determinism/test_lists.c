// test_lists.c -- the skin of the pair list and the order of bodies in memory never change a result.
#include "support/heap.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

enum { LOOKS = 4, STEPS = 150 };

/// Hashes on the way; returns the skin at the end.
static double run(const heap_setup *setup, uint64_t *hashes)
{
    heap h = heap_open(*setup);
    for (int look = 0; look < LOOKS; ++look)
    {
        MUST(pls_world_run(h.scene.world, STEPS));
        hashes[look] = verify_hash(h.scene.world);
        if (look == 1) heap_change_bodies(&h);
    }
    heap_expect_contacts(&h);
    double skin = verify_figures(h.scene.world).skin;
    heap_close(&h);
    return skin;
}

static void compare_skins(heap_setup setup)
{
    uint64_t reference[LOOKS], hashes[LOOKS];
    double skin = run(&setup, reference);
    assert_true(skin > 0.0);
    const double factors[] = {0.1, 1.0, 3.0};
    for (int k = 0; k < 3; ++k)
    {
        setup.skin = factors[k] * skin;
        run(&setup, hashes);
        assert_memory_equal(hashes, reference, sizeof hashes);
    }
    if (!setup.dense) return;
    setup.skin = 0.8; // so wide that few of the listed pairs touch: those that do are then picked, not taken in whole vectors
    run(&setup, hashes);
    assert_memory_equal(hashes, reference, sizeof hashes);
}

static void compare_orders(heap_setup setup)
{
    uint64_t reference[LOOKS], hashes[LOOKS];
    run(&setup, reference);
    setup.reorder = !setup.reorder;
    run(&setup, hashes);
    assert_memory_equal(hashes, reference, sizeof hashes);
}

static heap_setup periodic(heap_setup setup)
{
    setup.periodic = true;
    return setup;
}

static void skin_of_a_tenth_and_of_thrice_changes_no_bit(void **state)
{
    (void)state;
    compare_skins(heap_default(3, 500));
    compare_skins(periodic(heap_default(3, 500)));
    compare_skins(heap_default(2, 400));
}

static void order_in_memory_changes_no_bit(void **state)
{
    (void)state;
    compare_orders(heap_default(3, 1500));
    compare_orders(periodic(heap_default(3, 1500)));
    compare_orders(periodic(heap_default(2, 600)));
}

static void skin_changes_no_bit_of_dense_heaps(void **state)
{
    (void)state;
    compare_skins(heap_dense(3, 1000, 1.0, false));
    compare_skins(heap_dense(3, 1000, 2.5, true));
    compare_skins(heap_dense(2, 1600, 1.0, false));
}

static void order_in_memory_changes_no_bit_of_dense_heaps(void **state)
{
    (void)state;
    compare_orders(heap_dense(3, 1728, 1.0, false));
    compare_orders(heap_dense(3, 1000, 1.0, true));
    compare_orders(heap_dense(3, 1000, 2.5, false));
    compare_orders(heap_dense(2, 1600, 2.5, true));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(skin_of_a_tenth_and_of_thrice_changes_no_bit),
        cmocka_unit_test(order_in_memory_changes_no_bit),
        cmocka_unit_test(skin_changes_no_bit_of_dense_heaps),
        cmocka_unit_test(order_in_memory_changes_no_bit_of_dense_heaps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
