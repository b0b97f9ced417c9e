// test_arena.c -- many blocks, one lifetime.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/arena.h"
#include "support/failing_allocator.h"

#include <string.h>

static void blocks_are_zeroed_aligned_and_apart(void **state)
{
    (void)state;
    enum { BLOCKS = 2000 };
    static unsigned char *block[BLOCKS];
    static size_t size[BLOCKS];
    pls_arena arena = {0};
    for (size_t i = 0; i < BLOCKS; ++i)
    {
        size_t item = i % 3 == 0 ? 1 : i % 3 == 1 ? 24 : 64 + i % 200;
        size_t count = 1 + i * 7919 % 40;
        if (i % 500 == 499) count = 3000; // now and then more than a chunk
        size[i] = item * count;
        assert_int_equal(pls_arena_allocate(&arena, &block[i], count, item, "a test"), PLS_OK);
        assert_int_equal((uintptr_t)block[i] % (item >= 64 ? 64 : 16), 0);
        for (size_t k = 0; k < size[i]; ++k) assert_int_equal(block[i][k], 0);
        memset(block[i], (int)(i % 251) + 1, size[i]);
    }
    for (size_t i = 0; i < BLOCKS; ++i) // no later block has written over an earlier one
    {
        for (size_t k = 0; k < size[i]; ++k) assert_int_equal(block[i][k], i % 251 + 1);
    }
    pls_arena_clear(&arena);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_large_block_does_not_waste_the_open_chunk(void **state)
{
    (void)state;
    pls_arena arena = {0};
    char *small, *large;
    assert_int_equal(pls_arena_allocate(&arena, &small, 16, 1, "a test"), PLS_OK);
    assert_int_equal(pls_arena_allocate(&arena, &large, 1000000, 1, "a test"), PLS_OK);
    size_t held = pls_memory_in_use();
    assert_int_equal(pls_arena_allocate(&arena, &small, 16, 1, "a test"), PLS_OK);
    assert_int_equal(pls_memory_in_use(), held);
    pls_arena_clear(&arena);
}

static void an_arena_can_be_used_again_after_clearing(void **state)
{
    (void)state;
    pls_arena arena = {0};
    pls_arena_clear(&arena);
    for (int i = 0; i < 3; ++i)
    {
        const char *text;
        assert_int_equal(pls_arena_copy_text(&arena, &text, "again"), PLS_OK);
        assert_string_equal(text, "again");
        pls_arena_clear(&arena);
        assert_int_equal(pls_memory_in_use(), 0);
    }
}

static void zero_items_are_null_and_a_success(void **state)
{
    (void)state;
    pls_arena arena = {0};
    char here = 0;
    char *block = &here;
    assert_int_equal(pls_arena_allocate(&arena, &block, 0, 8, "a test"), PLS_OK);
    assert_null(block);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void texts_are_copied_and_formatted(void **state)
{
    (void)state;
    pls_arena arena = {0};
    const char *copy, *text, *empty;
    assert_int_equal(pls_arena_copy_text(&arena, &copy, "kn"), PLS_OK);
    assert_int_equal(pls_arena_print(&arena, &text, "%s = %d N/m", copy, 20), PLS_OK);
    assert_int_equal(pls_arena_print(&arena, &empty, "%s", ""), PLS_OK);
    assert_string_equal(text, "kn = 20 N/m");
    assert_string_equal(empty, "");
    pls_arena_clear(&arena);
}

static void a_size_that_overflows_is_out_of_memory(void **state)
{
    (void)state;
    pls_arena arena = {0};
    char *block;
    assert_int_equal(pls_arena_allocate(&arena, &block, SIZE_MAX / 4, 8, "a test"), PLS_OUT_OF_MEMORY);
    assert_null(block);
    assert_int_equal(pls_arena_allocate(&arena, &block, SIZE_MAX - 10, 1, "a test"), PLS_OUT_OF_MEMORY);
    assert_null(block);
    pls_arena_clear(&arena);
}

static pls_status fill(void *context)
{
    (void)context;
    pls_arena arena = {0};
    const char *text = NULL;
    double *numbers = NULL;
    pls_status status = pls_arena_copy_text(&arena, &text, "text");
    for (int i = 0; i < 5 && status == PLS_OK; ++i) status = pls_arena_allocate(&arena, &numbers, 1500, sizeof *numbers, "numbers");
    if (status == PLS_OK) status = pls_arena_allocate(&arena, &numbers, 100000, sizeof *numbers, "numbers");
    if (status == PLS_OK) status = pls_arena_print(&arena, &text, "%5000d", 1);
    pls_arena_clear(&arena);
    return status;
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(fill, NULL) >= 7);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_zeroed_aligned_and_apart),
        cmocka_unit_test(a_large_block_does_not_waste_the_open_chunk),
        cmocka_unit_test(an_arena_can_be_used_again_after_clearing),
        cmocka_unit_test(zero_items_are_null_and_a_success),
        cmocka_unit_test(texts_are_copied_and_formatted),
        cmocka_unit_test(a_size_that_overflows_is_out_of_memory),
        cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
