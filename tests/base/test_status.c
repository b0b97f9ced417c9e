// test_status.c -- codes, texts and the message of each thread.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <particls/status.h>

#include <pthread.h>
#include <string.h>

static void every_status_has_a_name_and_a_text(void **state)
{
    (void)state;
    for (int status = 0; status < PLS_STATUS_COUNT; ++status)
    {
        assert_true(strlen(pls_status_name((pls_status)status)) > 0);
        assert_true(strlen(pls_status_text((pls_status)status)) > 0);
    }
    assert_int_equal(PLS_OK, 0);
    assert_string_equal(pls_status_name(PLS_OUT_OF_MEMORY), "OUT_OF_MEMORY");
    assert_string_equal(pls_status_text(PLS_OUT_OF_MEMORY), "out of memory");
}

static void an_unknown_status_still_has_a_name_and_a_text(void **state)
{
    (void)state;
    assert_string_equal(pls_status_name((pls_status)9999), "UNKNOWN");
    assert_string_equal(pls_status_text((pls_status)9999), "unknown status");
    assert_non_null(pls_status_text((pls_status)-1));
    assert_non_null(pls_status_name(PLS_STATUS_COUNT));
}

static void a_failure_returns_its_code_and_leaves_its_message(void **state)
{
    (void)state;
    assert_int_equal(pls_fail(PLS_USER, "my law: kn is %d", -3), PLS_USER);
    assert_string_equal(pls_last_message(), "my law: kn is -3");
}

static void context_comes_in_front_of_the_message(void **state)
{
    (void)state;
    pls_status status = pls_fail(PLS_IO, "no such file");
    assert_int_equal(pls_fail_context(status, "while reading %s: ", "x.csv"), PLS_IO);
    assert_string_equal(pls_last_message(), "while reading x.csv: no such file");
}

static void context_of_a_success_changes_nothing(void **state)
{
    (void)state;
    pls_fail(PLS_IO, "old");
    assert_int_equal(pls_fail_context(PLS_OK, "new: "), PLS_OK);
    assert_string_equal(pls_last_message(), "old");
}

static void a_message_may_quote_the_previous_one(void **state)
{
    (void)state;
    pls_fail(PLS_IO, "inner");
    pls_fail(PLS_USER, "outer <%s>", pls_last_message());
    assert_string_equal(pls_last_message(), "outer <inner>");
    pls_fail_context(PLS_USER, "[%s] ", pls_last_message());
    assert_string_equal(pls_last_message(), "[outer <inner>] outer <inner>");
}

static void a_message_is_cut_at_2000_characters(void **state)
{
    (void)state;
    char text[5000];
    memset(text, 'x', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    pls_fail(PLS_IO, "%s", text);
    assert_int_equal(strlen(pls_last_message()), 2000);
    for (int i = 0; i < 3; ++i)
    {
        pls_fail_context(PLS_IO, "front%d ", i);
        assert_int_equal(strlen(pls_last_message()), 2000);
    }
    assert_memory_equal(pls_last_message(), "front2 front1 front0 xxx", 24);
    pls_fail_context(PLS_IO, "%s", text);
    assert_int_equal(strlen(pls_last_message()), 2000);
}

static void a_cut_does_not_split_a_character(void **state)
{
    (void)state;
    char text[3001]; // one letter and 1,500 times e acute, two bytes each: byte 2,000 is the first of a pair's second half
    text[0] = 'x';
    for (size_t i = 1; i + 1 < sizeof text; i += 2) memcpy(text + i, "\xC3\xA9", 2);
    text[sizeof text - 2] = '\0';
    pls_fail(PLS_IO, "%s", text);
    assert_int_equal(strlen(pls_last_message()), 1999);
    assert_int_equal((unsigned char)pls_last_message()[1998], 0xA9);
}

static void *fail_elsewhere(void *seen)
{
    strcpy(seen, pls_last_message());
    pls_fail(PLS_IO, "theirs");
    return NULL;
}

static void each_thread_has_its_own_message(void **state)
{
    (void)state;
    char seen[4096] = "not run";
    pls_fail(PLS_IO, "mine");
    pthread_t thread;
    assert_int_equal(pthread_create(&thread, NULL, fail_elsewhere, seen), 0);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_string_equal(seen, "");
    assert_string_equal(pls_last_message(), "mine");
}

static pls_status try_twice(int *reached)
{
    PLS_TRY(PLS_OK);
    *reached = 1;
    PLS_TRY(pls_fail(PLS_SCENE, "stop"));
    *reached = 2;
    return PLS_OK;
}

static void try_returns_the_first_failure(void **state)
{
    (void)state;
    int reached = 0;
    assert_int_equal(try_twice(&reached), PLS_SCENE);
    assert_int_equal(reached, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_status_has_a_name_and_a_text),
        cmocka_unit_test(an_unknown_status_still_has_a_name_and_a_text),
        cmocka_unit_test(a_failure_returns_its_code_and_leaves_its_message),
        cmocka_unit_test(context_comes_in_front_of_the_message),
        cmocka_unit_test(context_of_a_success_changes_nothing),
        cmocka_unit_test(a_message_may_quote_the_previous_one),
        cmocka_unit_test(a_message_is_cut_at_2000_characters),
        cmocka_unit_test(a_cut_does_not_split_a_character),
        cmocka_unit_test(each_thread_has_its_own_message),
        cmocka_unit_test(try_returns_the_first_failure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
