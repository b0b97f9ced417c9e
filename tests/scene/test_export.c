// test_export.c -- the schema as JSON Schema and as the reference page.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/text.h"
#include "scene/node.h"
#include "scene/schema.h"
#include "support/failing_allocator.h"

#include <particls/scene.h>
#include <stdio.h>
#include <string.h>

/// A reader of JSON as RFC 8259 has it, which only says whether the text is right: moves `*at` behind one value.
static bool skip_value(const char **at);

static void skip_blanks(const char **at) { *at += strspn(*at, " \t\r\n"); }

static bool skip_string(const char **at)
{
    if (*(*at)++ != '"') return false;
    for (; **at != '"'; ++*at)
    {
        if ((unsigned char)**at < 0x20) return false;
        if (**at == '\\' && !strchr("\"\\/bfnrt", *++*at)) return false;
    }
    ++*at;
    return true;
}

static bool skip_members(const char **at, char end)
{
    ++*at;
    skip_blanks(at);
    if (**at == end) return ++*at, true;
    for (;;)
    {
        skip_blanks(at);
        if (end == '}')
        {
            if (!skip_string(at)) return false;
            skip_blanks(at);
            if (*(*at)++ != ':') return false;
        }
        if (!skip_value(at)) return false;
        skip_blanks(at);
        if (**at == end) return ++*at, true;
        if (*(*at)++ != ',') return false;
    }
}

static bool skip_value(const char **at)
{
    static const char *const words[] = {"true", "false", "null"};
    skip_blanks(at);
    if (**at == '{') return skip_members(at, '}');
    if (**at == '[') return skip_members(at, ']');
    if (**at == '"') return skip_string(at);
    for (size_t k = 0; k < 3; ++k)
    {
        if (strncmp(*at, words[k], strlen(words[k])) == 0) return *at += strlen(words[k]), true;
    }
    size_t size = strspn(*at, "-+.0123456789eE");
    char number[64];
    double value;
    snprintf(number, sizeof number, "%.*s", (int)size, *at);
    *at += size;
    return size > 0 && pls_parse_double(number, &value);
}

static void the_json_schema_is_json(void **state)
{
    (void)state;
    char *text;
    assert_int_equal(pls_scene_json_schema(&text), PLS_OK);
    const char *at = text;
    assert_true(skip_value(&at));
    assert_string_equal(at, "\n");
    pls_scene_free_text(text);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// The node at a path of keys, separated by blanks.
static pls_node *find(pls_node *node, const char *path)
{
    char key[64];
    for (int used = 0; node && sscanf(path, "%63s%n", key, &used) == 1; path += used) node = pls_node_get(node, key);
    return node;
}

static void the_json_schema_knows_ranges_and_required_keys(void **state)
{
    (void)state;
    char *text;
    pls_arena arena = {0};
    pls_node *root;
    assert_int_equal(pls_scene_json_schema(&text), PLS_OK);
    pls_source source = {"schema.json", text, strlen(text), true};
    assert_int_equal(pls_yaml_read(&arena, &source, &root), PLS_OK);
    const pls_node *radius = find(root, "$defs shape properties sphere properties radius allOf")->child[0];
    assert_string_equal(find(find((pls_node *)(uintptr_t)radius, "anyOf")->child[0], "exclusiveMinimum")->text, "0");
    assert_string_equal(find(root, "$defs time required")->child[0]->text, "end");
    assert_string_equal(find(root, "$defs time additionalProperties")->text, "false");
    assert_non_null(find(root, "$defs contact properties law"));
    pls_arena_clear(&arena);
    pls_scene_free_text(text);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void every_key_is_in_the_schema_and_on_the_page(void **state)
{
    (void)state;
    char *json, *page, part[128];
    assert_int_equal(pls_scene_json_schema(&json), PLS_OK);
    assert_int_equal(pls_scene_reference(&page), PLS_OK);
    size_t sections, count;
    const pls_section *section = pls_schema_sections(&sections);
    for (size_t k = 0; k < sections; ++k)
    {
        snprintf(part, sizeof part, "\n## %s\n", section[k].name);
        const char *at = strstr(page, part);
        assert_non_null(at);
        const pls_key *keys = pls_schema_keys(section[k].name, &count);
        assert_true(count > 0);
        for (size_t j = 0; j < count; ++j)
        {
            snprintf(part, sizeof part, "| `%s` | ", keys[j].name);
            assert_non_null(strstr(at, part));
            if (keys[j].type == PLS_KEY_PLUGIN) continue; // any name
            snprintf(part, sizeof part, "\"%s\": {\"description\": ", keys[j].name);
            assert_non_null(strstr(json, part));
        }
    }
    for (const pls_law_ops *const *law = pls_builtin_laws(); *law; ++law)
    {
        snprintf(part, sizeof part, "\n### %s\n", (*law)->name);
        assert_non_null(strstr(page, part));
    }
    pls_scene_free_text(json);
    pls_scene_free_text(page);
}

static void sections_named_by_keys_exist(void **state)
{
    (void)state;
    size_t sections, count, inner;
    const pls_section *section = pls_schema_sections(&sections);
    for (size_t k = 0; k < sections; ++k)
    {
        const pls_key *keys = pls_schema_keys(section[k].name, &count);
        for (size_t j = 0; j < count; ++j)
        {
            char word[64];
            assert_true(strlen(keys[j].meaning) > 0);
            assert_true(keys[j].minimum <= keys[j].maximum);
            for (size_t n = 0; keys[j].sub && pls_schema_word(keys[j].sub, n, word); ++n)
            {
                (void)pls_schema_keys(word, &inner);
                assert_true(inner > 0);
            }
        }
    }
}

static pls_status export_job(void *context)
{
    (void)context;
    char *text;
    PLS_TRY(pls_scene_json_schema(&text));
    pls_scene_free_text(text);
    PLS_TRY(pls_scene_reference(&text));
    pls_scene_free_text(text);
    return PLS_OK;
}

static void exporting_survives_allocation_failures(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(export_job, NULL) > 10);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_json_schema_is_json),
        cmocka_unit_test(the_json_schema_knows_ranges_and_required_keys),
        cmocka_unit_test(every_key_is_in_the_schema_and_on_the_page),
        cmocka_unit_test(sections_named_by_keys_exist),
        cmocka_unit_test(exporting_survives_allocation_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
