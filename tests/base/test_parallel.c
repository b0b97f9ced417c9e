// test_parallel.c -- blocks, threads, and sums that do not depend on them.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/alloc.h"
#include "base/parallel.h"

#include <math.h>
#include <string.h>

static void blocks_cover_the_range_once(void **state)
{
    (void)state;
    for (size_t count = 0; count < 40; ++count)
    {
        size_t covered = 0;
        for (size_t block = 0; block < pls_block_count(count, 8); ++block)
        {
            assert_int_equal(covered, block * 8);
            assert_true(pls_block_end(block, 8, count) > covered);
            covered = pls_block_end(block, 8, count);
        }
        assert_int_equal(covered, count);
    }
}

static void the_number_of_threads_is_what_was_set(void **state)
{
    (void)state;
    assert_true(pls_threads() >= 1);
    assert_int_equal(pls_set_threads(3), PLS_OK);
    assert_int_equal(pls_threads(), 3);
    assert_int_equal(pls_set_threads(0), PLS_OK);
    assert_true(pls_threads() >= 1);
}

static void an_absurd_number_of_threads_is_refused(void **state)
{
    (void)state;
    assert_int_equal(pls_set_threads(2), PLS_OK);
    assert_int_equal(pls_set_threads(-1), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_set_threads(4097), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_threads(), 2);
}

static void a_sum_has_the_same_bits_on_any_number_of_threads(void **state)
{
    (void)state;
    // Over 512 blocks of 1,024, so that more than one round is summed; terms of both signs over many magnitudes, so that order matters.
    const size_t sizes[] = {0, 1, 1023, 1024, 1025, 5000, 600 * 1024 + 77};
    size_t largest = 600 * 1024 + 77;
    double *values;
    assert_int_equal(pls_allocate(&values, largest * 2, sizeof *values, "values"), PLS_OK);
    for (size_t i = 0; i < largest * 2; ++i) values[i] = sin((double)i) * exp(10 * cos(0.37 * (double)i));
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; ++s)
    {
        for (size_t stride = 1; stride <= 2; ++stride)
        {
            double expected = 0; // the definition: plain sums within blocks, added in order
            for (size_t begin = 0; begin < sizes[s]; begin += 1024)
            {
                double block = 0;
                for (size_t i = begin; i < begin + 1024 && i < sizes[s]; ++i) block += values[i * stride];
                expected += block;
            }
            for (int threads = 1; threads <= 7; ++threads)
            {
                assert_int_equal(pls_set_threads(threads), PLS_OK);
                double sum = pls_sum(values, sizes[s], stride);
                assert_memory_equal(&sum, &expected, sizeof sum);
            }
        }
    }
    pls_release(&values);
    assert_int_equal(pls_set_threads(0), PLS_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_cover_the_range_once),
        cmocka_unit_test(the_number_of_threads_is_what_was_set),
        cmocka_unit_test(an_absurd_number_of_threads_is_refused),
        cmocka_unit_test(a_sum_has_the_same_bits_on_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
