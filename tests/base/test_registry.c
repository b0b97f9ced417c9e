// test_registry.c -- operations by name, and the nearest word.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/registry.h"
#include "support/failing_allocator.h"

#include <string.h>

static const int ops_a = 1, ops_b = 2;

static void what_is_added_is_found_in_order(void **state)
{
    (void)state;
    pls_registry registry = {.what = "contact law"};
    assert_null(pls_registry_find(&registry, "elastic"));
    assert_int_equal(pls_registry_add(&registry, "elastic", &ops_a), PLS_OK);
    assert_int_equal(pls_registry_add(&registry, "hertz", &ops_b), PLS_OK);
    assert_ptr_equal(pls_registry_find(&registry, "elastic"), &ops_a);
    assert_ptr_equal(pls_registry_find(&registry, "hertz"), &ops_b);
    assert_null(pls_registry_find(&registry, "Hertz"));
    assert_null(pls_registry_find(&registry, NULL));
    assert_int_equal(registry.count, 2);
    assert_string_equal(registry.entry[0].name, "elastic");
    assert_string_equal(registry.entry[1].name, "hertz");
    pls_registry_free(&registry);
    assert_int_equal(registry.count, 0);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_name_can_be_taken_only_once(void **state)
{
    (void)state;
    pls_registry registry = {.what = "contact law"};
    assert_int_equal(pls_registry_add(&registry, "elastic", &ops_a), PLS_OK);
    assert_int_equal(pls_registry_add(&registry, "elastic", &ops_b), PLS_DUPLICATE);
    assert_non_null(strstr(pls_last_message(), "contact law \"elastic\""));
    assert_ptr_equal(pls_registry_find(&registry, "elastic"), &ops_a);
    assert_int_equal(registry.count, 1);
    pls_registry_free(&registry);
}

static void an_entry_needs_a_name_and_operations(void **state)
{
    (void)state;
    pls_registry registry = {0};
    assert_int_equal(pls_registry_add(&registry, NULL, &ops_a), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_registry_add(&registry, "", &ops_a), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_registry_add(&registry, "x", NULL), PLS_INVALID_ARGUMENT);
    pls_registry_free(&registry);
}

static pls_status add_many(void *context)
{
    (void)context;
    static const char *const names[] = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
    pls_registry registry = {.what = "shape"};
    pls_status status = PLS_OK;
    for (size_t i = 0; i < sizeof names / sizeof *names && status == PLS_OK; ++i) status = pls_registry_add(&registry, names[i], &ops_a);
    pls_registry_free(&registry);
    return status;
}

static void every_failed_allocation_is_reported_and_leaks_nothing(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(add_many, NULL) > 0);
    failing_allocator_remove();
}

static const char *nearest(const char *word)
{
    static const char *const keys[] = {"density", "friction", "radius", "restitution", "position", "ks"};
    return pls_nearest_word(word, keys, sizeof keys / sizeof *keys);
}

static void a_misspelt_word_finds_its_neighbour(void **state)
{
    (void)state;
    assert_string_equal(nearest("density"), "density");
    assert_string_equal(nearest("densty"), "density");    // a letter missing
    assert_string_equal(nearest("ddensity"), "density");  // one too many
    assert_string_equal(nearest("dansity"), "density");   // another one
    assert_string_equal(nearest("dnesity"), "density");   // two neighbours swapped
    assert_string_equal(nearest("DENSITY"), "density");   // capitals
    assert_string_equal(nearest("Fricton"), "friction");  // both
    assert_string_equal(nearest("posiiton"), "position"); // nearer than friction
    assert_string_equal(nearest("restituion"), "restitution");
}

static void a_far_word_finds_nothing(void **state)
{
    (void)state;
    assert_null(nearest("temperature"));
    assert_null(nearest(""));
    assert_null(nearest("kn")); // one of two letters differs
    assert_null(pls_nearest_word("density", NULL, 0));
    char endless[200];
    memset(endless, 'd', sizeof endless - 1);
    endless[sizeof endless - 1] = '\0';
    assert_null(nearest(endless));
    const char *const long_key = endless;
    assert_null(pls_nearest_word("d", &long_key, 1));
}

/// The limit is a third of the letters: one edit among three letters is near, one among two is not; a swap counts as one edit.
static void near_means_a_third_of_the_letters(void **state)
{
    (void)state;
    const char *const three = "abc", *const two = "ab", *const six = "abcdef",
                      *const longest = "abcdefghijklmnopqrstuvwxyz0123456789abcdefghijklmnopqrstuvwxyz-";
    assert_string_equal(pls_nearest_word("abx", &three, 1), "abc");
    assert_string_equal(pls_nearest_word("acb", &three, 1), "abc");
    assert_null(pls_nearest_word("axx", &three, 1));
    assert_null(pls_nearest_word("ax", &two, 1));
    assert_string_equal(pls_nearest_word("badcef", &six, 1), "abcdef");
    assert_null(pls_nearest_word("badcfe", &six, 1));
    assert_string_equal(pls_nearest_word(longest, &longest, 1), longest); // 63 letters, the most there may be
}

static void the_first_of_equals_wins(void **state)
{
    (void)state;
    const char *const keys[] = {"abcx", "abcy", "abcz"};
    assert_string_equal(pls_nearest_word("abcd", keys, 3), "abcx");
    assert_string_equal(pls_nearest_word("abcz", keys, 3), "abcz");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_added_is_found_in_order),      cmocka_unit_test(a_name_can_be_taken_only_once),
        cmocka_unit_test(an_entry_needs_a_name_and_operations), cmocka_unit_test(every_failed_allocation_is_reported_and_leaks_nothing),
        cmocka_unit_test(a_misspelt_word_finds_its_neighbour),  cmocka_unit_test(a_far_word_finds_nothing),
        cmocka_unit_test(near_means_a_third_of_the_letters),    cmocka_unit_test(the_first_of_equals_wins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
