// test_text.c -- growing texts, and numbers as text.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/text.h"
#include "support/failing_allocator.h"

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void a_text_grows_and_is_always_terminated(void **state)
{
    (void)state;
    pls_text text = {0};
    assert_int_equal(pls_text_print(&text, "%s,%d", "a", 7), PLS_OK);
    assert_string_equal(text.data, "a,7");
    assert_int_equal(pls_text_append(&text, "xyz", 2), PLS_OK);
    assert_string_equal(text.data, "a,7xy");
    assert_int_equal(pls_text_append(&text, NULL, 0), PLS_OK);
    assert_int_equal(text.size, 5);
    for (int i = 0; i < 1000; ++i) assert_int_equal(pls_text_print(&text, "%04d", i), PLS_OK);
    assert_int_equal(text.size, 4005);
    assert_int_equal(strlen(text.data), 4005);
    assert_string_equal(text.data + 4001, "0999");
    pls_text_free(&text);
    assert_null(text.data);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_text_may_hold_zero_bytes(void **state)
{
    (void)state;
    pls_text text = {0};
    assert_int_equal(pls_text_append(&text, "a\0b", 3), PLS_OK);
    assert_int_equal(text.size, 3);
    assert_memory_equal(text.data, "a\0b", 4);
    assert_int_equal(pls_text_append(&text, "a", SIZE_MAX), PLS_OUT_OF_MEMORY);
    pls_text_free(&text);
}

static pls_status write_text(void *context)
{
    (void)context;
    pls_text text = {0};
    pls_status status = pls_text_print(&text, "%d", 1);
    if (status == PLS_OK) status = pls_text_append(&text, "0123456789", 10);
    if (status == PLS_OK) status = pls_text_print(&text, "%100d", 1);
    pls_text_free(&text);
    return status;
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_int_equal(assert_survives_allocation_failures(write_text, NULL), 3);
    failing_allocator_remove();
}

static const struct
{
    double value;
    const char *text;
} known_numbers[] = {
    {0, "0"},
    {-0.0, "-0"},
    {1, "1"},
    {-2.5, "-2.5"},
    {0.1, "0.1"},
    {0.1 + 0.2, "0.30000000000000004"},
    {1e-5, "1e-05"},
    {100000, "100000"},
    {1e22, "1e+22"},
    {123456789012345680.0, "1.2345678901234568e+17"},
    {0.0188888, "0.0188888"},
    {5e-324, "5e-324"}, // the smallest number above zero
    {DBL_MIN, "2.2250738585072014e-308"},
    {DBL_MAX, "1.7976931348623157e+308"},
    {INFINITY, "inf"},
    {-INFINITY, "-inf"},
    {NAN, "nan"},
};

static void numbers_are_written_with_as_few_digits_as_needed(void **state)
{
    (void)state;
    char buffer[32];
    for (size_t i = 0; i < sizeof known_numbers / sizeof *known_numbers; ++i)
    {
        assert_string_equal(pls_format_double(buffer, known_numbers[i].value), known_numbers[i].text);
    }
    assert_string_equal(pls_format_double(buffer, -NAN), "nan");
}

static void every_number_reads_back_bit_for_bit(void **state)
{
    (void)state;
    uint64_t bits = UINT64_C(88172645463325252);
    for (int i = 0; i < 200000; ++i)
    {
        bits ^= bits << 13; // Marsaglia's xorshift64
        bits ^= bits >> 7;
        bits ^= bits << 17;
        uint64_t pattern = i % 10 == 0 ? bits & UINT64_C(0x800FFFFFFFFFFFFF) : bits; // every tenth one subnormal
        double value, again;
        memcpy(&value, &pattern, sizeof value);
        if (!isfinite(value)) continue;
        char buffer[32];
        pls_format_double(buffer, value);
        assert_true(strlen(buffer) < 32);
        assert_true(pls_parse_double(buffer, &again));
        assert_memory_equal(&again, &value, sizeof value);
    }
}

static void numbers_are_read_from_the_whole_text(void **state)
{
    (void)state;
    static const struct
    {
        const char *text;
        double value;
    } good[] = {{"1e5", 1e5}, {"+3", 3},     {"-.5", -0.5},     {"2.", 2},          {"1E-3", 0.001},
                {"007", 7},   {"1e-999", 0}, {"inf", INFINITY}, {"+inf", INFINITY}, {"-inf", -INFINITY}};
    for (size_t i = 0; i < sizeof good / sizeof *good; ++i)
    {
        double value = -77;
        assert_true(pls_parse_double(good[i].text, &value));
        assert_true(value == good[i].value);
    }
    double value = 0;
    assert_true(pls_parse_double("nan", &value));
    assert_true(isnan(value));
}

static void what_is_not_exactly_a_number_is_refused(void **state)
{
    (void)state;
    static const char *const bad[] = {"",       " 1",    "1 ",     "1x",    "0x10", "0x1p3", "1,5",  "1e",  "e5",       ".",
                                      "+",      "-",     "--1",    "1.2.3", "1e5.", "1-",    "1e+",  "\t1", "infinity", "INF",
                                      "nan(1)", "1e999", "-1e999", "kn",    "1\n",  "+-1",   "inf ", "- 1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
    {
        double value = -77;
        if (pls_parse_double(bad[i], &value)) fail_msg("\"%s\" was read as %g", bad[i], value);
        assert_true(value == -77);
    }
}

static void a_locale_with_a_decimal_comma_changes_nothing(void **state)
{
    (void)state;
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE",       "fr_FR.UTF-8",
                                        "fr_FR.utf8",  "fr_FR",      "ru_RU.UTF-8", "sv_SE.UTF-8"};
    const char *set = NULL;
    for (size_t i = 0; i < sizeof names / sizeof *names && !set; ++i) set = setlocale(LC_ALL, names[i]);
    if (!set)
    {
        print_message("no locale with a decimal comma is installed here\n");
        skip();
    }
    char buffer[32];
    snprintf(buffer, sizeof buffer, "%g", 1.5);
    assert_string_equal(buffer, "1,5"); // the locale is what it claims to be
    double value = 0;
    assert_string_equal(pls_format_double(buffer, 1.5), "1.5");
    assert_true(pls_parse_double("1.5", &value));
    assert_true(value == 1.5);
    assert_false(pls_parse_double("1,5", &value));
    snprintf(buffer, sizeof buffer, "%g", 1.5);
    assert_string_equal(buffer, "1,5"); // and it is back in force
    setlocale(LC_ALL, "C");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_text_grows_and_is_always_terminated),
        cmocka_unit_test(a_text_may_hold_zero_bytes),
        cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
        cmocka_unit_test(numbers_are_written_with_as_few_digits_as_needed),
        cmocka_unit_test(every_number_reads_back_bit_for_bit),
        cmocka_unit_test(numbers_are_read_from_the_whole_text),
        cmocka_unit_test(what_is_not_exactly_a_number_is_refused),
        cmocka_unit_test(a_locale_with_a_decimal_comma_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
