// test_csr.c -- compressed sparse rows.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/csr.h"
#include "support/failing_allocator.h"

static void entries_of_a_row_keep_the_order_of_the_input(void **state)
{
    (void)state;
    const uint32_t row_of[] = {2, 0, 2, 4, 0, 2};
    const uint32_t entry_of[] = {70, 71, 60, 73, 50, 99};
    pls_csr csr = {0};
    assert_int_equal(pls_csr_build(&csr, 5, row_of, entry_of, 6), PLS_OK);
    const uint32_t start[] = {0, 2, 2, 5, 5, 6};
    const uint32_t entry[] = {71, 50, 70, 60, 99, 73};
    assert_int_equal(csr.rows, 5);
    assert_memory_equal(csr.start, start, sizeof start);
    assert_memory_equal(csr.entry, entry, sizeof entry);
    pls_csr_free(&csr);
    assert_null(csr.start);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_list_of_nothing_is_well_formed(void **state)
{
    (void)state;
    pls_csr csr = {0};
    assert_int_equal(pls_csr_build(&csr, 0, NULL, NULL, 0), PLS_OK);
    assert_int_equal(csr.start[0], 0);
    assert_int_equal(pls_csr_build(&csr, 3, NULL, NULL, 0), PLS_OK);
    for (int row = 0; row <= 3; ++row) assert_int_equal(csr.start[row], 0);
    pls_csr_free(&csr);
    pls_csr_free(&csr);
}

static void a_rebuild_reuses_the_memory(void **state)
{
    (void)state;
    const uint32_t row_of[] = {1, 1, 0, 1};
    const uint32_t entry_of[] = {4, 5, 6, 7};
    pls_csr csr = {0};
    assert_int_equal(pls_csr_build(&csr, 2, row_of, entry_of, 4), PLS_OK);
    failing_allocator_arm(0);
    for (uint32_t rows = 2; rows > 1; --rows) assert_int_equal(pls_csr_build(&csr, rows, row_of, entry_of, 3), PLS_OK);
    assert_int_equal(failing_allocator_calls(), 0);
    assert_int_equal(csr.start[2], 3);
    assert_int_equal(csr.entry[0], 6);
    pls_csr_free(&csr);
}

static void a_row_out_of_range_is_refused_and_leaves_an_empty_list(void **state)
{
    (void)state;
    const uint32_t row_of[] = {0, 3};
    const uint32_t entry_of[] = {1, 2};
    pls_csr csr = {0};
    assert_int_equal(pls_csr_build(&csr, 3, row_of, entry_of, 2), PLS_INVALID_ARGUMENT);
    assert_int_equal(csr.rows, 0);
    assert_int_equal(csr.start[0], 0);
    assert_int_equal(pls_csr_build(&csr, 0, row_of, entry_of, 1), PLS_INVALID_ARGUMENT);
    pls_csr_free(&csr);
}

static pls_status build(void *context)
{
    (void)context;
    uint32_t row_of[100], entry_of[100];
    for (uint32_t i = 0; i < 100; ++i)
    {
        row_of[i] = i * 37 % 10;
        entry_of[i] = i;
    }
    pls_csr csr = {0};
    pls_status status = pls_csr_build(&csr, 10, row_of, entry_of, 10);
    if (status == PLS_OK) status = pls_csr_build(&csr, 50, row_of, entry_of, 100);
    pls_csr_free(&csr);
    return status;
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
    (void)state;
    assert_int_equal(assert_survives_allocation_failures(build, NULL), 4);
}

static int install(void **state)
{
    (void)state;
    failing_allocator_install();
    return 0;
}

static int uninstall(void **state)
{
    (void)state;
    failing_allocator_remove();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(entries_of_a_row_keep_the_order_of_the_input),
        cmocka_unit_test(a_list_of_nothing_is_well_formed),
        cmocka_unit_test(a_rebuild_reuses_the_memory),
        cmocka_unit_test(a_row_out_of_range_is_refused_and_leaves_an_empty_list),
        cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
    };
    return cmocka_run_group_tests(tests, install, uninstall);
}
