// test_sort.c -- the radix sort against qsort, its stability, and the prefix sum.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/alloc.h"
#include "base/sort.h"
#include "support/failing_allocator.h"

typedef struct pair
{
    uint64_t key;
    uint32_t value;
} pair;

/// Values are the places before sorting, so equal keys must come out with ascending values.
static int compare_pairs(const void *left, const void *right)
{
    const pair *a = left, *b = right;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return a->value < b->value ? -1 : a->value > b->value;
}

/// Marsaglia's xorshift64: random numbers that do not come from the library.
static uint64_t next_random(uint64_t *x)
{
    *x ^= *x << 13;
    *x ^= *x >> 7;
    *x ^= *x << 17;
    return *x;
}

static void assert_sorts_like_qsort(size_t count, uint64_t mask, uint64_t *seed)
{
    pair *expected;
    uint64_t *keys;
    uint32_t *narrow_keys, *values, *narrow_values;
    assert_int_equal(pls_allocate(&expected, count + 1, sizeof *expected, "pairs"), PLS_OK);
    assert_int_equal(pls_allocate(&keys, count + 1, sizeof *keys, "keys"), PLS_OK);
    assert_int_equal(pls_allocate(&values, count + 1, sizeof *values, "values"), PLS_OK);
    assert_int_equal(pls_allocate(&narrow_keys, count + 1, sizeof *narrow_keys, "keys"), PLS_OK);
    assert_int_equal(pls_allocate(&narrow_values, count + 1, sizeof *narrow_values, "values"), PLS_OK);
    for (size_t i = 0; i < count; ++i)
    {
        keys[i] = next_random(seed) & mask;
        narrow_keys[i] = (uint32_t)keys[i];
        values[i] = narrow_values[i] = (uint32_t)i;
        expected[i] = (pair){keys[i], (uint32_t)i};
    }
    keys[count] = narrow_keys[count] = values[count] = narrow_values[count] = 12345; // must stay

    qsort(expected, count, sizeof *expected, compare_pairs);
    assert_int_equal(pls_radix_sort_u64(keys, values, count), PLS_OK);
    for (size_t i = 0; i < count; ++i)
    {
        assert_true(keys[i] == expected[i].key);
        assert_int_equal(values[i], expected[i].value);
    }
    for (size_t i = 0; i < count; ++i) expected[i] = (pair){narrow_keys[i], (uint32_t)i};
    qsort(expected, count, sizeof *expected, compare_pairs);
    assert_int_equal(pls_radix_sort_u32(narrow_keys, narrow_values, count), PLS_OK);
    for (size_t i = 0; i < count; ++i)
    {
        assert_true(narrow_keys[i] == expected[i].key);
        assert_int_equal(narrow_values[i], expected[i].value);
    }
    assert_true(keys[count] == 12345 && narrow_keys[count] == 12345 && values[count] == 12345 && narrow_values[count] == 12345);
    pls_release(&expected);
    pls_release(&keys);
    pls_release(&values);
    pls_release(&narrow_keys);
    pls_release(&narrow_values);
}

static void it_sorts_like_a_stable_qsort(void **state)
{
    (void)state;
    // All bits, few distinct keys, low digit only, one middle digit, the ends with constant digits between, all keys equal.
    static const uint64_t masks[] = {UINT64_MAX, 7, 0xFF, 0xFF0000, UINT64_C(0xFF000000000000FF), 0, UINT64_C(0x0F0F0F0F0F0F0F0F)};
    uint64_t seed = UINT64_C(88172645463325252);
    for (size_t m = 0; m < sizeof masks / sizeof *masks; ++m)
    {
        for (size_t count = 0; count <= 5; ++count) assert_sorts_like_qsort(count, masks[m], &seed);
        for (int repeat = 0; repeat < 20; ++repeat) assert_sorts_like_qsort(next_random(&seed) % 3000, masks[m], &seed);
    }
    assert_sorts_like_qsort(100000, UINT64_MAX, &seed);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void nothing_is_sorted_without_pointers(void **state)
{
    (void)state;
    assert_int_equal(pls_radix_sort_u64(NULL, NULL, 0), PLS_OK);
    assert_int_equal(pls_radix_sort_u32(NULL, NULL, 0), PLS_OK);
}

static void a_prefix_sum_ends_with_the_total(void **state)
{
    (void)state;
    uint32_t counts[] = {3, 0, 5, 1, 777};
    assert_int_equal(pls_prefix_sum_u32(counts, 4), PLS_OK);
    const uint32_t expected[] = {0, 3, 3, 8, 9};
    assert_memory_equal(counts, expected, sizeof expected);

    uint32_t none[] = {42};
    assert_int_equal(pls_prefix_sum_u32(none, 0), PLS_OK);
    assert_int_equal(none[0], 0);
}

static void a_total_beyond_32_bits_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    uint32_t fits[] = {UINT32_MAX - 1, 1, 0};
    assert_int_equal(pls_prefix_sum_u32(fits, 2), PLS_OK);
    assert_true(fits[2] == UINT32_MAX);
    uint32_t too_many[] = {UINT32_MAX, 1, 9};
    assert_int_equal(pls_prefix_sum_u32(too_many, 2), PLS_LIMIT_EXCEEDED);
    assert_true(too_many[0] == UINT32_MAX && too_many[1] == 1 && too_many[2] == 9);
}

static pls_status sort_three(void *context)
{
    (void)context;
    uint64_t keys[] = {3, 1, 2};
    uint32_t narrow_keys[] = {3, 1, 2}, values[] = {0, 1, 2};
    PLS_TRY(pls_radix_sort_u64(keys, values, 3));
    return pls_radix_sort_u32(narrow_keys, values, 3);
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(sort_three, NULL) >= 2);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_sorts_like_a_stable_qsort),
        cmocka_unit_test(nothing_is_sorted_without_pointers),
        cmocka_unit_test(a_prefix_sum_ends_with_the_total),
        cmocka_unit_test(a_total_beyond_32_bits_is_refused_and_changes_nothing),
        cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
