// test_csv.c -- series files: whole rows, numbers that read back, cut back to a length.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/atomic_file.h"
#include "io/csv.h"
#include "support/failing_allocator.h"

#include <float.h>
#include <math.h>
#include <signal.h>
#include <string.h>
#include <sys/resource.h>

static const pls_csv_column columns[] = {{"time", "s"}, {"sigma_zz", "Pa"}, {"contacts", ""}};
static const char path[] = "series.csv";

static void expect_content(const char *expected)
{
    char *text;
    size_t size;
    assert_int_equal(pls_read_file(path, &text, &size), PLS_OK);
    assert_string_equal(text, expected);
    pls_release(&text);
}

static void must_create(pls_csv *csv) { assert_int_equal(pls_csv_create(csv, path, columns, 3), PLS_OK); }

static void must_write(pls_csv *csv, double a, double b, double c) { assert_int_equal(pls_csv_row(csv, (double[]){a, b, c}, 3), PLS_OK); }

static void the_first_line_names_columns_with_units(void **state)
{
    (void)state;
    pls_csv csv = {0};
    must_create(&csv);
    expect_content("time [s],sigma_zz [Pa],contacts\n");
    pls_csv_close(&csv);
    const pls_csv_column odd[] = {{"a,b", "m"}, {"say \"so\"", ""}};
    assert_int_equal(pls_csv_create(&csv, path, odd, 2), PLS_OK);
    expect_content("\"a,b [m]\",\"say \"\"so\"\"\"\n");
    pls_csv_close(&csv);
}

static void rows_are_in_the_file_at_once_and_shortest(void **state)
{
    (void)state;
    pls_csv csv = {0};
    must_create(&csv);
    must_write(&csv, 0.1, -1e-300, 3);
    must_write(&csv, NAN, INFINITY, -0.0);
    expect_content("time [s],sigma_zz [Pa],contacts\n0.1,-1e-300,3\nnan,inf,-0\n"); // the file is still open
    assert_int_equal(csv.size, strlen("time [s],sigma_zz [Pa],contacts\n0.1,-1e-300,3\nnan,inf,-0\n"));
    pls_csv_close(&csv);
}

static void numbers_read_back_as_the_same_double(void **state)
{
    (void)state;
    const double values[] = {0.1, 1.0 / 3, DBL_MAX, DBL_MIN, 4.9e-324, 123456789.123456789, -2.5e-8};
    for (size_t k = 0; k < sizeof values / sizeof values[0]; ++k)
    {
        pls_csv csv = {0};
        must_create(&csv);
        must_write(&csv, values[k], 0, 0);
        pls_csv_close(&csv);
        char *text;
        size_t size;
        assert_int_equal(pls_read_file(path, &text, &size), PLS_OK);
        double back = strtod(strchr(text, '\n') + 1, NULL);
        assert_memory_equal(&back, &values[k], sizeof back);
        pls_release(&text);
    }
}

static void a_file_cut_back_and_continued_equals_an_undisturbed_one(void **state)
{
    (void)state;
    pls_csv csv = {0};
    must_create(&csv);
    must_write(&csv, 1, 2, 3);
    uint64_t checkpoint = csv.size;
    must_write(&csv, 4, 5, 6);
    must_write(&csv, 7, 8, 9);
    pls_csv_close(&csv);
    assert_int_equal(pls_csv_reopen(&csv, path, checkpoint, columns, 3), PLS_OK);
    expect_content("time [s],sigma_zz [Pa],contacts\n1,2,3\n");
    must_write(&csv, 4, 5, 6);
    assert_int_equal(pls_csv_sync(&csv), PLS_OK);
    expect_content("time [s],sigma_zz [Pa],contacts\n1,2,3\n4,5,6\n");
    pls_csv_close(&csv);
}

static void a_file_that_is_not_what_it_was_is_corrupt(void **state)
{
    (void)state;
    pls_csv csv = {0};
    must_create(&csv);
    must_write(&csv, 1, 2, 3);
    uint64_t size = csv.size;
    pls_csv_close(&csv);
    assert_int_equal(pls_csv_reopen(&csv, path, size + 1, columns, 3), PLS_CORRUPT);      // shorter than it was
    assert_int_equal(pls_csv_reopen(&csv, path, size - 1, columns, 3), PLS_CORRUPT);      // not the end of a line
    assert_int_equal(pls_csv_reopen(&csv, path, size, columns, 2), PLS_CORRUPT);          // other columns
    assert_int_equal(pls_csv_reopen(&csv, "missing.csv", size, columns, 3), PLS_CORRUPT); // gone
    assert_non_null(strstr(pls_last_message(), "missing.csv"));
    expect_content("time [s],sigma_zz [Pa],contacts\n1,2,3\n"); // and nothing was cut
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_full_disk_leaves_whole_rows_and_says_so(void **state)
{
    (void)state;
    pls_csv csv = {0};
    must_create(&csv);
    must_write(&csv, 1, 2, 3);
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    struct rlimit small = {csv.size + 5, before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    pls_status status = pls_csv_row(&csv, (double[]){0.123456, 2, 3}, 3);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(status, PLS_DISK_FULL);
    assert_non_null(strstr(pls_last_message(), path));
    expect_content("time [s],sigma_zz [Pa],contacts\n1,2,3\n");
    must_write(&csv, 4, 5, 6); // room again
    expect_content("time [s],sigma_zz [Pa],contacts\n1,2,3\n4,5,6\n");
    pls_csv_close(&csv);
}

static void a_folder_or_a_missing_one_is_told(void **state)
{
    (void)state;
    pls_csv csv = {0};
    assert_int_equal(pls_csv_create(&csv, ".", columns, 3), PLS_IO);
    assert_int_equal(pls_csv_create(&csv, "no/such/folder.csv", columns, 3), PLS_IO);
    assert_non_null(strstr(pls_last_message(), "no/such/folder.csv"));
    assert_int_equal(pls_memory_in_use(), 0);
}

static pls_status write_and_reopen(void *context)
{
    (void)context;
    pls_csv csv = {0};
    pls_status status = pls_csv_create(&csv, path, columns, 3);
    if (status == PLS_OK) status = pls_csv_row(&csv, (double[]){1, 2, 3}, 3);
    uint64_t size = csv.size;
    pls_csv_close(&csv);
    if (status == PLS_OK) status = pls_csv_reopen(&csv, path, size, columns, 3);
    pls_csv_close(&csv);
    return status;
}

static void every_failing_allocation_is_an_error(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(write_and_reopen, NULL) > 3);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_line_names_columns_with_units),
        cmocka_unit_test(rows_are_in_the_file_at_once_and_shortest),
        cmocka_unit_test(numbers_read_back_as_the_same_double),
        cmocka_unit_test(a_file_cut_back_and_continued_equals_an_undisturbed_one),
        cmocka_unit_test(a_file_that_is_not_what_it_was_is_corrupt),
        cmocka_unit_test(a_full_disk_leaves_whole_rows_and_says_so),
        cmocka_unit_test(a_folder_or_a_missing_one_is_told),
        cmocka_unit_test(every_failing_allocation_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
