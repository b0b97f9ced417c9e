// test_alloc.c -- checked allocation, its counters and its replaceable source.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/alloc.h"
#include "support/failing_allocator.h"

#include <pthread.h>
#include <string.h>

static int all_zero(const void *block, size_t size)
{
    const unsigned char *bytes = block;
    for (size_t i = 0; i < size; ++i)
    {
        if (bytes[i] != 0) return 0;
    }
    return 1;
}

static void blocks_are_zeroed_and_aligned_to_64_bytes(void **state)
{
    (void)state;
    for (size_t count = 1; count < 300; count += 7)
    {
        double *block;
        assert_int_equal(pls_allocate(&block, count, sizeof *block, "a test"), PLS_OK);
        assert_int_equal((uintptr_t)block % 64, 0);
        assert_true(all_zero(block, count * sizeof *block));
        memset(block, 0xA5, count * sizeof *block); // the next block may get this memory
        pls_release(&block);
        assert_null(block);
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

static void zero_items_are_null_and_a_success(void **state)
{
    (void)state;
    int here = 0;
    int *block = &here;
    assert_int_equal(pls_allocate(&block, 0, sizeof *block, "a test"), PLS_OK);
    assert_null(block);
    pls_release(&block);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void the_counters_know_what_is_held_and_its_peak(void **state)
{
    (void)state;
    pls_memory_reset_peak();
    char *small, *large;
    assert_int_equal(pls_allocate(&small, 1000, 1, "a test"), PLS_OK);
    size_t with_small = pls_memory_in_use();
    assert_in_range(with_small, 1000, 1000 + 128);
    assert_int_equal(pls_allocate(&large, 100000, 1, "a test"), PLS_OK);
    size_t with_both = pls_memory_in_use();
    assert_in_range(with_both, 101000, 101000 + 256);
    pls_release(&large);
    assert_int_equal(pls_memory_in_use(), with_small);
    assert_int_equal(pls_memory_peak(), with_both);
    pls_memory_reset_peak();
    assert_int_equal(pls_memory_peak(), with_small);
    pls_release(&small);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_size_that_overflows_is_out_of_memory(void **state)
{
    (void)state;
    int here = 0;
    int *block = &here;
    assert_int_equal(pls_allocate(&block, SIZE_MAX / 2, 8, "the pair list"), PLS_OUT_OF_MEMORY);
    assert_null(block);
    assert_non_null(strstr(pls_last_message(), "the pair list"));
    assert_int_equal(pls_allocate(&block, SIZE_MAX - 20, 1, "the pair list"), PLS_OUT_OF_MEMORY); // only the header overflows
    assert_null(block);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void the_message_says_how_much_and_for_what(void **state)
{
    (void)state;
    failing_allocator_install();
    static const struct
    {
        size_t bytes;
        const char *message;
    } cases[] = {
        {1, "cannot allocate 1 bytes for the pair list"},
        {1023, "cannot allocate 1023 bytes for the pair list"},
        {1024, "cannot allocate 1.0 KiB for the pair list"},
        {12897485, "cannot allocate 12.3 MiB for the pair list"}, // 12.3 * 2^20 = 12,897,484.8
        {(size_t)5 << 40, "cannot allocate 5.0 TiB for the pair list"},
        {((size_t)1 << 30) - 1, "cannot allocate 1023.9 MiB for the pair list"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
    {
        char *block;
        failing_allocator_arm(1);
        assert_int_equal(pls_allocate(&block, cases[i].bytes, 1, "the pair list"), PLS_OUT_OF_MEMORY);
        assert_string_equal(pls_last_message(), cases[i].message);
    }
    failing_allocator_remove();
}

static void reallocation_keeps_contents_and_zeroes_what_is_new(void **state)
{
    (void)state;
    uint32_t *block = NULL;
    size_t count = 0;
    static const size_t sizes[] = {5, 17, 3, 40, 40, 1, 500, 0, 9};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; ++s)
    {
        size_t next = sizes[s];
        assert_int_equal(pls_reallocate(&block, count, next, sizeof *block, "a test"), PLS_OK);
        if (next == 0) assert_null(block);
        for (size_t i = 0; i < next; ++i) assert_int_equal(block[i], i < count ? 1000 + i : 0);
        for (size_t i = 0; i < next; ++i) block[i] = (uint32_t)(1000 + i);
        count = next;
    }
    pls_release(&block);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_failed_growth_changes_nothing(void **state)
{
    (void)state;
    failing_allocator_install();
    uint32_t *block = NULL;
    size_t capacity = 0;
    assert_int_equal(pls_reserve(&block, &capacity, 10, sizeof *block, "a test"), PLS_OK);
    for (uint32_t i = 0; i < 10; ++i) block[i] = i;
    uint32_t *before = block;
    size_t capacity_before = capacity;

    failing_allocator_arm(1);
    assert_int_equal(pls_reserve(&block, &capacity, 1000, sizeof *block, "a test"), PLS_OUT_OF_MEMORY);
    failing_allocator_arm(1);
    assert_int_equal(pls_reallocate(&block, 10, 1000, sizeof *block, "a test"), PLS_OUT_OF_MEMORY);
    assert_int_equal(pls_reserve(&block, &capacity, SIZE_MAX, sizeof *block, "a test"), PLS_OUT_OF_MEMORY);
    assert_ptr_equal(block, before);
    assert_int_equal(capacity, capacity_before);
    for (uint32_t i = 0; i < 10; ++i) assert_int_equal(block[i], i);
    pls_release(&block);
    failing_allocator_remove();
}

static void reserved_capacity_grows_by_half_at_least(void **state)
{
    (void)state;
    failing_allocator_install();
    char *block = NULL;
    size_t capacity = 0;
    for (size_t needed = 1; needed <= 100000; ++needed)
    {
        assert_int_equal(pls_reserve(&block, &capacity, needed, 1, "a test"), PLS_OK);
        assert_true(capacity >= needed);
    }
    assert_true(failing_allocator_calls() < 40); // log(1e5) / log(1.5) = 28.4, and a few steps of one while capacity is 1
    pls_release(&block);
    failing_allocator_remove();
}

static void a_copied_text_is_equal_and_elsewhere(void **state)
{
    (void)state;
    const char text[] = "granular";
    char *copy;
    assert_int_equal(pls_copy_text(&copy, text, "a test"), PLS_OK);
    assert_string_equal(copy, text);
    assert_ptr_not_equal(copy, text);
    pls_release(&copy);
    assert_int_equal(pls_copy_text(&copy, "", "a test"), PLS_OK);
    assert_string_equal(copy, "");
    pls_release(&copy);
}

static void the_allocator_stays_while_blocks_are_in_use(void **state)
{
    (void)state;
    char *block;
    assert_int_equal(pls_allocate(&block, 1, 1, "a test"), PLS_OK);
    assert_int_equal(pls_set_allocator(NULL), PLS_INVALID_ARGUMENT);
    pls_release(&block);
    assert_int_equal(pls_set_allocator(NULL), PLS_OK);
    pls_allocator half = {failing_allocator_allocate, NULL, NULL};
    assert_int_equal(pls_set_allocator(&half), PLS_INVALID_ARGUMENT);
}

typedef struct ledger
{
    size_t allocated, released;
} ledger;

static void *ledger_allocate(void *context, size_t size, size_t alignment)
{
    ((ledger *)context)->allocated += size;
    return aligned_alloc(alignment, size);
}

static void ledger_release(void *context, void *block, size_t size)
{
    ((ledger *)context)->released += size;
    free(block);
}

static void the_allocator_gets_back_the_sizes_it_gave(void **state)
{
    (void)state;
    ledger sums = {0, 0};
    pls_allocator allocator = {ledger_allocate, ledger_release, &sums};
    assert_int_equal(pls_set_allocator(&allocator), PLS_OK);
    char *block;
    assert_int_equal(pls_allocate(&block, 777, 3, "a test"), PLS_OK);
    assert_int_equal(sums.allocated, pls_memory_in_use());
    assert_int_equal(pls_reallocate(&block, 777, 1000, 3, "a test"), PLS_OK);
    pls_release(&block);
    assert_int_equal(sums.allocated, sums.released);
    assert_int_equal(pls_set_allocator(NULL), PLS_OK);
}

static void *allocate_and_release(void *unused)
{
    for (size_t i = 1; i < 2000; ++i)
    {
        char *block;
        if (pls_allocate(&block, i, 1, "a test") == PLS_OK) pls_release(&block);
    }
    return unused;
}

static void the_counters_add_up_over_threads(void **state)
{
    (void)state;
    pthread_t threads[4];
    for (int i = 0; i < 4; ++i) assert_int_equal(pthread_create(&threads[i], NULL, allocate_and_release, NULL), 0);
    for (int i = 0; i < 4; ++i) assert_int_equal(pthread_join(threads[i], NULL), 0);
    assert_int_equal(pls_memory_in_use(), 0);
}

static pls_status use_each_function(void *context)
{
    (void)context;
    double *numbers = NULL;
    char *text = NULL;
    size_t capacity = 0;
    pls_status status = pls_allocate(&numbers, 8, sizeof *numbers, "numbers");
    if (status == PLS_OK) status = pls_reallocate(&numbers, 8, 90, sizeof *numbers, "numbers");
    if (status == PLS_OK) status = pls_copy_text(&text, "text", "a text");
    pls_release(&text);
    if (status == PLS_OK) status = pls_reserve(&text, &capacity, 100, 1, "a text");
    pls_release(&text);
    pls_release(&numbers);
    return status;
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_int_equal(assert_survives_allocation_failures(use_each_function, NULL), 4);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_zeroed_and_aligned_to_64_bytes),
        cmocka_unit_test(zero_items_are_null_and_a_success),
        cmocka_unit_test(the_counters_know_what_is_held_and_its_peak),
        cmocka_unit_test(a_size_that_overflows_is_out_of_memory),
        cmocka_unit_test(the_message_says_how_much_and_for_what),
        cmocka_unit_test(reallocation_keeps_contents_and_zeroes_what_is_new),
        cmocka_unit_test(a_failed_growth_changes_nothing),
        cmocka_unit_test(reserved_capacity_grows_by_half_at_least),
        cmocka_unit_test(a_copied_text_is_equal_and_elsewhere),
        cmocka_unit_test(the_allocator_stays_while_blocks_are_in_use),
        cmocka_unit_test(the_allocator_gets_back_the_sizes_it_gave),
        cmocka_unit_test(the_counters_add_up_over_threads),
        cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
