// resolve.c -- the tree against the schema.
//
// One walk checks every key, type and range, turns expressions over `vars` into numbers, puts defaults in and brings keys into the order of
// the table. What remains as text where a number may stand is a formula of the run (over t, x, states, ...), compiled here once to see that
// it is right.

#include "scene/resolve.h"

#include "scene/scene_data.h"
#include "scene/schema.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static pls_status resolve_section(pls_resolver *r, pls_node *node, const char *section, const char *label);

// ---------------------------------------------------------------------------------------------------------------------------------------
// one number

static pls_status check_range(const pls_key *key, const pls_node *node, const char *label)
{
    double value = node->number;
    bool open = key->flags & PLS_KEY_OPEN_MINIMUM;
    bool infinite = isinf(value) && !(key->flags & PLS_KEY_INFINITE);
    if (infinite || isnan(value)) return pls_node_fail(node, key->meaning, "'%s' in %s must be a finite number", key->name, label);
    if ((open ? value > key->minimum : value >= key->minimum) && value <= key->maximum) return PLS_OK;
    char range[128], number[32];
    pls_schema_range(key, range);
    return pls_node_fail(node, key->meaning, "'%s' in %s must be %s%s%s, not %s", key->name, label, range, *key->unit ? " " : "", key->unit,
                         pls_format_double(number, value));
}

static void set_number(pls_node *node, double value)
{
    node->numeric = true;
    node->quoted = false;
    node->number = value;
}

static bool parse_number(const pls_node *node, double *value)
{
    const char *text = node->text;
    bool minus = *text == '-';
    if (strcmp(text + minus, ".inf") == 0)
    {
        *value = minus ? -INFINITY : INFINITY;
        return true;
    }
    if (strcmp(text, ".nan") == 0)
    {
        *value = NAN;
        return true;
    }
    return pls_parse_double(text, value) != 0;
}

static pls_status wrong_type(const pls_key *key, const pls_node *node, const char *label, const char *wanted)
{
    return pls_node_fail(node, key->meaning, "'%s' in %s must be %s, not %s", key->name, label, wanted, pls_node_describe(node));
}

/// Where a word may stand in place of a number, say which.
static void add_words(const pls_key *key, char *hint, size_t size)
{
    char word[64];
    for (size_t k = 0; key->words && pls_schema_word(key->words, k, word); ++k)
    {
        size_t used = strlen(hint);
        snprintf(hint + used, size - used, "%s%s", k ? ", " : used ? "  or one of: " : "one of: ", word);
    }
}

/// An expression: a number when it uses constants only, else a formula of the run.
static pls_status resolve_expression(pls_resolver *r, const pls_key *key, pls_node *node, const char *label, bool always_formula)
{
    const char *names[PLS_EXPRESSION_VARIABLES];
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(r->scene, key->uses, r->own_name, names, &symbols));
    pls_expression *expression;
    pls_expression_error error;
    pls_status status = pls_expression_compile(node->text, &symbols, &expression, &error);
    if (status == PLS_EXPRESSION) add_words(key, error.hint, sizeof error.hint);
    if (status == PLS_EXPRESSION)
        return pls_node_fail_at(node, error.offset, error.hint, "'%s' in %s: %s", key->name, label, pls_last_message());
    PLS_TRY(status);
    bool varies = always_formula;
    for (size_t k = 0; k < symbols.variable_count; ++k) varies = varies || pls_expression_uses(expression, k);
    double zeros[PLS_EXPRESSION_VARIABLES] = {0}, value = 0.0;
    if (!varies) status = pls_expression_evaluate(expression, zeros, &value);
    pls_expression_free(expression);
    if (status != PLS_OK) return pls_node_fail(node, NULL, "'%s' in %s: %s", key->name, label, pls_last_message());
    node->formula = varies;
    if (varies)
    {
        node->quoted = true;
        return PLS_OK;
    }
    set_number(node, value);
    return PLS_OK;
}

static bool is_boolean_text(const pls_node *node)
{
    return !node->quoted && (strcmp(node->text, "true") == 0 || strcmp(node->text, "false") == 0);
}

static pls_status resolve_number(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    if (key->sub && node->kind == PLS_NODE_MAP) return resolve_section(r, node, key->sub, label);
    if (node->kind == PLS_NODE_SCALAR && pls_schema_has_word(key->words, node->text)) return PLS_OK;
    if (node->kind != PLS_NODE_SCALAR || pls_node_is_null(node) || is_boolean_text(node))
        return wrong_type(key, node, label, key->uses ? "a number or an expression" : "a number");
    double value;
    if (parse_number(node, &value))
        set_number(node, value);
    else
        PLS_TRY(resolve_expression(r, key, node, label, false));
    return node->formula ? PLS_OK : check_range(key, node, label);
}

static pls_status resolve_integer(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    if (node->kind == PLS_NODE_SCALAR && pls_schema_has_word(key->words, node->text)) return PLS_OK;
    if (node->kind != PLS_NODE_SCALAR || pls_node_is_null(node) || is_boolean_text(node)) return wrong_type(key, node, label, "an integer");
    PLS_TRY(resolve_number(r, key, node, label));
    char number[32];
    if (node->number != floor(node->number) || fabs(node->number) > 9007199254740992.0)
        return pls_node_fail(node, key->meaning, "'%s' in %s must be an integer, not %s", key->name, label,
                             pls_format_double(number, node->number));
    return PLS_OK;
}

static pls_status resolve_boolean(const pls_key *key, const pls_node *node, const char *label)
{
    if (node->kind == PLS_NODE_SCALAR && is_boolean_text(node)) return PLS_OK;
    return wrong_type(key, node, label, "true or false");
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// texts

static pls_status resolve_text(const pls_key *key, const pls_node *node, const char *label)
{
    if (node->kind != PLS_NODE_SCALAR || pls_node_is_null(node)) return wrong_type(key, node, label, "a text");
    return PLS_OK;
}

static pls_status resolve_name(const pls_key *key, const pls_node *node, const char *label)
{
    PLS_TRY(resolve_text(key, node, label));
    return pls_resolve_name(node, strncmp(key->section, "observe", 7) == 0 ? "observer" : key->section);
}

pls_status pls_resolve_name(const pls_node *node, const char *what)
{
    size_t size = strlen(node->text);
    const char *good = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789.-";
    bool letter = size > 0 && strchr(good, node->text[0]) < strchr(good, '0');
    if (letter && size < PLS_NAME_SIZE && strspn(node->text, good) == size) return PLS_OK;
    return pls_node_fail(node, "letters, digits, '_', '-' and '.', beginning with a letter; at most 63 characters",
                         "'%.80s' cannot be the name of a %s", node->text, what);
}

static size_t split_words(const char *words, char list[16][64], const char *pointers[16])
{
    size_t count = 0;
    while (count < 16 && pls_schema_word(words, count, list[count])) pointers[count] = list[count], ++count;
    return count;
}

static pls_status resolve_word(const pls_key *key, const pls_node *node, const char *label)
{
    PLS_TRY(resolve_text(key, node, label));
    if (pls_schema_has_word(key->words, node->text)) return PLS_OK;
    char list[16][64], hint[512];
    const char *pointers[16];
    size_t count = split_words(key->words, list, pointers);
    pls_scene_hint(hint, sizeof hint, node->text, "possible", pointers, count);
    return pls_node_fail(node, hint, "'%s' in %s cannot be '%s'", key->name, label, node->text);
}

/// An input file: its absolute path takes the place of the text.
static pls_status resolve_path(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    PLS_TRY(resolve_text(key, node, label));
    const char *path = node->text;
    if (path[0] != '/') PLS_TRY(pls_arena_print(&r->scene->arena, &path, "%s/%s", r->scene->folder, node->text));
    char *real = realpath(path, NULL);
    if (!real) return pls_node_fail(node, "paths are relative to the folder of the scene", "there is no file '%s'", node->text);
    pls_status status = pls_arena_copy_text(&r->scene->arena, &node->text, real);
    free(real);
    PLS_TRY(status);
    node->quoted = true;
    node->path = true;
    return pls_scene_add_input(r->scene, node->text);
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// lists

static pls_status check_list(const pls_key *key, const pls_node *node, const char *label, const char *wanted, size_t length)
{
    if (node->kind != PLS_NODE_LIST) return wrong_type(key, node, label, wanted);
    if (length && node->count != length)
        return pls_node_fail(node, key->meaning, "'%s' in %s must be %s, not of %zu", key->name, label, wanted, node->count);
    if (node->count == 0 && !(key->flags & PLS_KEY_MAY_BE_EMPTY))
        return pls_node_fail(node, key->meaning, "'%s' in %s is an empty list", key->name, label);
    return PLS_OK;
}

static pls_status resolve_numbers(pls_resolver *r, const pls_key *key, pls_node *node, const char *label, size_t length)
{
    char wanted[48];
    snprintf(wanted, sizeof wanted, "a list of %zu numbers", length);
    PLS_TRY(check_list(key, node, label, wanted, length));
    for (size_t k = 0; k < node->count; ++k) PLS_TRY(resolve_number(r, key, node->child[k], label));
    return PLS_OK;
}

static pls_status resolve_counts(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    PLS_TRY(check_list(key, node, label, r->scene->dimension == 2 ? "a list of 2 integers" : "a list of 3 integers",
                       (size_t)r->scene->dimension));
    for (size_t k = 0; k < node->count; ++k) PLS_TRY(resolve_integer(r, key, node->child[k], label));
    return PLS_OK;
}

static pls_status resolve_range(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    PLS_TRY(resolve_numbers(r, key, node, label, 2));
    if (node->child[0]->number < node->child[1]->number) return PLS_OK;
    return pls_node_fail(node, NULL, "'%s' in %s: the second number must be greater than the first", key->name, label);
}

static pls_status resolve_flags(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    PLS_TRY(check_list(key, node, label, r->scene->dimension == 2 ? "a list of 2 booleans" : "a list of 3 booleans",
                       (size_t)r->scene->dimension));
    for (size_t k = 0; k < node->count; ++k) PLS_TRY(resolve_boolean(key, node->child[k], label));
    return PLS_OK;
}

static pls_status resolve_orientation(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    if (node->kind == PLS_NODE_SCALAR && pls_schema_has_word(key->words, node->text)) return PLS_OK;
    if (node->kind == PLS_NODE_MAP) return resolve_section(r, node, key->sub, label);
    if (r->scene->dimension == 2) return resolve_number(r, key, node, label);
    return resolve_numbers(r, key, node, label, 4);
}

static pls_status resolve_texts(const pls_key *key, pls_node *node, const char *label)
{
    if (node->kind == PLS_NODE_SCALAR && pls_schema_has_word(key->words, node->text)) return PLS_OK;
    PLS_TRY(check_list(key, node, label, "a list of names", 0));
    bool words = key->type == PLS_KEY_WORDS;
    for (size_t k = 0; k < node->count; ++k)
    {
        PLS_TRY(words ? resolve_word(key, node->child[k], label) : resolve_text(key, node->child[k], label));
        for (size_t j = 0; j < k && words; ++j)
        {
            if (strcmp(node->child[j]->text, node->child[k]->text) == 0)
                return pls_node_fail(node->child[k], NULL, "'%s' is listed twice in '%s' of %s", node->child[k]->text, key->name, label);
        }
    }
    return PLS_OK;
}

static pls_status resolve_mix(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    const bool map = node->kind == PLS_NODE_MAP;
    if (node->kind == PLS_NODE_SCALAR) return resolve_text(key, node, label);
    if (node->count == 0) return pls_node_fail(node, key->meaning, "'%s' in %s is empty", key->name, label);
    for (size_t k = 0; k < node->count; ++k)
    {
        PLS_TRY(map ? resolve_number(r, key, node->child[k], label) : resolve_text(key, node->child[k], label));
        for (size_t j = 0; j < k && !map; ++j)
        {
            if (strcmp(node->child[j]->text, node->child[k]->text) == 0)
                return pls_node_fail(node->child[k], "give fractions:  {ball: 2, stone: 1}", "'%s' is listed twice in '%s' of %s",
                                     node->child[k]->text, key->name, label);
        }
    }
    return PLS_OK;
}

static pls_status resolve_lists_of_numbers(pls_resolver *r, const pls_key *key, pls_node *node, const char *label, size_t length)
{
    PLS_TRY(check_list(key, node, label, "a list of lists of numbers", 0));
    for (size_t k = 0; k < node->count; ++k) PLS_TRY(resolve_numbers(r, key, node->child[k], label, length));
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// maps

static pls_status unknown_key(const pls_node *name, const pls_key *keys, size_t count, const char *label)
{
    const char *candidates[PLS_MAX_KEYS];
    for (size_t k = 0; k < count; ++k) candidates[k] = keys[k].name;
    char hint[900];
    pls_scene_hint(hint, sizeof hint, name->text, "keys here", candidates, count);
    return pls_node_fail(name, hint, "unknown key '%.80s' in %s", name->text, label);
}

/// The default of a key as a node, with the place of the map it is missing from.
static pls_status default_node(pls_resolver *r, const pls_key *key, const pls_node *map, pls_node **node)
{
    pls_arena *arena = &r->scene->arena;
    int dimension = r->scene->dimension;
    bool section = key->type == PLS_KEY_SECTION, words = key->type == PLS_KEY_WORDS || key->type == PLS_KEY_NAMES;
    size_t repeat = key->type == PLS_KEY_VECTOR3 ? 3 : key->type == PLS_KEY_VECTOR ? (size_t)dimension : 0;
    PLS_TRY(pls_node_new(arena, section ? PLS_NODE_MAP : repeat || words ? PLS_NODE_LIST : PLS_NODE_SCALAR, map, node));
    (*node)->quoted = key->type == PLS_KEY_TEXT; // an empty text is not "nothing"
    if (section) return PLS_OK;
    if (!repeat && !words) return pls_arena_copy_text(arena, &(*node)->text, key->initial);
    const char *at = key->initial;
    for (size_t k = 0; repeat ? k < repeat : *at != '\0'; ++k)
    {
        pls_node *child;
        PLS_TRY(pls_node_new(arena, PLS_NODE_SCALAR, map, &child));
        size_t size = strcspn(at, " ");
        PLS_TRY(pls_arena_print(arena, &child->text, "%.*s", (int)size, at));
        PLS_TRY(pls_node_append(arena, *node, NULL, child));
        if (!repeat) at += size + strspn(at + size, " ");
    }
    return PLS_OK;
}

static pls_status missing_key(const pls_node *map, const pls_key *key, const char *label)
{
    char hint[400];
    snprintf(hint, sizeof hint, "%s%s%s%s: %s", key->name, *key->unit ? " [" : "", key->unit, *key->unit ? "]" : "", key->meaning);
    return pls_node_fail(map, hint, "missing key '%s' in %s", key->name, label);
}

static pls_status resolve_value(pls_resolver *r, const pls_key *key, pls_node *node, const char *label);

pls_status pls_resolve_map(pls_resolver *r, pls_node *node, const pls_key *keys, size_t count, const char *label)
{
    pls_arena *arena = &r->scene->arena;
    if (node->kind == PLS_NODE_SCALAR && pls_node_is_null(node)) node->kind = PLS_NODE_MAP; // "plane:" is "plane: {}"
    if (node->kind != PLS_NODE_MAP)
        return pls_node_fail(node, NULL, "%s must be a map (key: value), not %s", label, pls_node_describe(node));
    for (size_t k = 0; k < node->count; ++k)
    {
        bool known = false;
        for (size_t j = 0; j < count && !known; ++j) known = strcmp(keys[j].name, node->key[k]->text) == 0;
        if (!known) return unknown_key(node->key[k], keys, count, label);
    }
    pls_node sorted = *node;
    sorted.count = 0;
    for (size_t j = 0; j < count; ++j)
    {
        const pls_key *key = &keys[j];
        pls_node *value = pls_node_get(node, key->name), *name = NULL;
        bool flat = key->flags & PLS_KEY_ONLY_2D && r->scene->dimension != 2;
        if (value && flat)
            return pls_node_fail(pls_node_key(node, key->name), NULL, "'%s' in %s has a meaning only with dimension: 2", key->name, label);
        if (!value && (flat || (!key->initial && !(key->flags & PLS_KEY_REQUIRED)))) continue;
        if (!value && key->flags & PLS_KEY_REQUIRED) return missing_key(node, key, label);
        if (!value) PLS_TRY(default_node(r, key, node, &value));
        PLS_TRY(resolve_value(r, key, value, label));
        PLS_TRY(pls_node_new(arena, PLS_NODE_SCALAR, value, &name));
        const pls_node *written = pls_node_key(node, key->name);
        if (written)
            *name = *written;
        else
            name->text = key->name;
        PLS_TRY(pls_node_append(arena, &sorted, name, value));
    }
    *node = sorted;
    return PLS_OK;
}

static pls_status resolve_section(pls_resolver *r, pls_node *node, const char *section, const char *label)
{
    size_t count;
    const pls_key *keys = pls_schema_keys(section, &count);
    return pls_resolve_map(r, node, keys, count, label);
}

static pls_status resolve_choice(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    size_t count;
    const pls_key *keys = pls_schema_keys(key->sub, &count);
    PLS_TRY(pls_resolve_map(r, node, keys, count, label));
    if (node->count == 1) return PLS_OK;
    const char *candidates[PLS_MAX_KEYS];
    for (size_t k = 0; k < count; ++k) candidates[k] = keys[k].name;
    char hint[300];
    pls_scene_hint(hint, sizeof hint, "", "keys here", candidates, count);
    return pls_node_fail(node, hint, "%s must have exactly one key, not %zu", label, node->count);
}

static pls_status resolve_named(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    if (node->kind != PLS_NODE_MAP) return wrong_type(key, node, label, "a map of names");
    if (node->count == 0) return pls_node_fail(node, key->meaning, "'%s' in %s is empty", key->name, label);
    for (size_t k = 0; k < node->count; ++k)
    {
        PLS_TRY(pls_resolve_name(node->key[k], key->sub));
        const char *inner;
        PLS_TRY(pls_arena_print(&r->scene->arena, &inner, "%s '%s'", key->sub, node->key[k]->text));
        PLS_TRY(resolve_section(r, node->child[k], key->sub, inner));
    }
    return PLS_OK;
}

enum { MOST_KINDS = 64 }; ///< of entries of a list that messages compare with; more would not be read

/// Keys that say that an entry is of a section: the section's first, or the names of plugins' operations. Appended to `names`.
static void telling_keys(const pls_resolver *r, const char *section, const char *names[MOST_KINDS], size_t *count)
{
    const pls_registry *operations = pls_scene_operations_of(r->scene, section);
    size_t keys;
    if (!operations && *count < MOST_KINDS) names[(*count)++] = pls_schema_keys(section, &keys)->name;
    for (size_t k = 0; operations && k < operations->count && *count < MOST_KINDS; ++k) names[(*count)++] = operations->entry[k].name;
}

/// Which of "a|b|c" an entry is: the section that one of its keys tells of.
static pls_status choose_section(const pls_resolver *r, const pls_key *key, const pls_node *entry, const char *label, char section[64])
{
    if (!strchr(key->sub, '|') || entry->kind != PLS_NODE_MAP)
    {
        pls_schema_word(key->sub, 0, section);
        return PLS_OK;
    }
    const char *known[MOST_KINDS];
    size_t kinds = 0, told = 0;
    for (size_t k = 0; pls_schema_word(key->sub, k, section); ++k)
    {
        telling_keys(r, section, known, &kinds);
        for (; told < kinds; ++told)
        {
            if (pls_node_get(entry, known[told])) return PLS_OK;
        }
    }
    char hint[600];
    const char *word = "";
    for (size_t k = 0; k < entry->count && !*word; ++k)
    {
        if (pls_nearest_word(entry->key[k]->text, known, kinds)) word = entry->key[k]->text;
    }
    pls_scene_hint(hint, sizeof hint, word, "one of these keys says what it is", known, kinds);
    return pls_node_fail(entry, hint, "cannot tell what %s is", label);
}

static pls_status resolve_list(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    PLS_TRY(check_list(key, node, label, "a list", 0));
    for (size_t k = 0; k < node->count; ++k)
    {
        pls_node *entry = node->child[k];
        const pls_node *name = pls_node_get(entry, "name");
        char section[64];
        const char *inner;
        bool named = name && name->kind == PLS_NODE_SCALAR && *name->text;
        if (named)
            PLS_TRY(pls_arena_print(&r->scene->arena, &inner, "%s[%zu] '%.64s'", key->name, k, name->text));
        else
            PLS_TRY(pls_arena_print(&r->scene->arena, &inner, "%s[%zu]", key->name, k));
        PLS_TRY(choose_section(r, key, entry, inner, section));
        if (strcmp(section, "contact") == 0)
            PLS_TRY(pls_resolve_contact(r, entry, inner));
        else if (strcmp(section, "bond") == 0)
            PLS_TRY(pls_resolve_bond(r, entry, inner));
        else if (strcmp(section, "state") == 0)
            PLS_TRY(pls_resolve_state(r, entry, inner));
        else if (strcmp(section, "force_plugin") == 0)
            PLS_TRY(pls_resolve_force_of_plugin(r, entry, inner));
        else if (strcmp(section, "observe_plugin") == 0)
            PLS_TRY(pls_resolve_observer_of_plugin(r, entry, inner));
        else
            PLS_TRY(resolve_section(r, entry, section, inner));
    }
    return PLS_OK;
}

static pls_status resolve_inner(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    const char *inner;
    bool top = strcmp(key->section, "scene") == 0;
    PLS_TRY(pls_arena_print(&r->scene->arena, &inner, "'%s'%s%s", key->name, top ? "" : " of ", top ? "" : label));
    if (key->type == PLS_KEY_CHOICE) return resolve_choice(r, key, node, inner);
    return resolve_section(r, node, key->sub, inner);
}

static pls_status resolve_value(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    size_t dimension = (size_t)r->scene->dimension;
    switch (key->type)
    {
        case PLS_KEY_NUMBER: return resolve_number(r, key, node, label);
        case PLS_KEY_INTEGER: return resolve_integer(r, key, node, label);
        case PLS_KEY_BOOLEAN: return resolve_boolean(key, node, label);
        case PLS_KEY_TEXT: return resolve_text(key, node, label);
        case PLS_KEY_NAME: return resolve_name(key, node, label);
        case PLS_KEY_WORD: return resolve_word(key, node, label);
        case PLS_KEY_PATH: return resolve_path(r, key, node, label);
        case PLS_KEY_CONDITION: PLS_TRY(resolve_text(key, node, label)); return resolve_expression(r, key, node, label, true);
        case PLS_KEY_VECTOR: return resolve_numbers(r, key, node, label, dimension);
        case PLS_KEY_VECTOR3: return resolve_numbers(r, key, node, label, 3);
        case PLS_KEY_SPIN: return dimension == 2 ? resolve_number(r, key, node, label) : resolve_numbers(r, key, node, label, 3);
        case PLS_KEY_RANGE: return resolve_range(r, key, node, label);
        case PLS_KEY_COUNTS: return resolve_counts(r, key, node, label);
        case PLS_KEY_FLAGS: return resolve_flags(r, key, node, label);
        case PLS_KEY_ORIENTATION: return resolve_orientation(r, key, node, label);
        case PLS_KEY_POINTS: return resolve_lists_of_numbers(r, key, node, label, dimension);
        case PLS_KEY_PAIRS: return resolve_lists_of_numbers(r, key, node, label, 2);
        case PLS_KEY_MIX: return resolve_mix(r, key, node, label);
        case PLS_KEY_NAMES:
        case PLS_KEY_WORDS: return resolve_texts(key, node, label);
        case PLS_KEY_PATHS: return PLS_OK; // resolved before, with the plugins
        case PLS_KEY_SECTION:
        case PLS_KEY_CHOICE: return resolve_inner(r, key, node, label);
        case PLS_KEY_NAMED: return resolve_named(r, key, node, label);
        case PLS_KEY_LIST: return resolve_list(r, key, node, label);
        case PLS_KEY_VARIABLES: return PLS_OK; // resolved before everything else
        case PLS_KEY_PLUGIN: return PLS_OK;    // resolved before, with the table of its operations
        case PLS_KEY_SHAPES: return pls_resolve_shapes(r, key, node, label);
    }
    return PLS_OK;
}

pls_status pls_resolve_key(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    return resolve_value(r, key, node, label);
}

pls_status pls_resolve_paths(pls_resolver *r, const pls_key *key, pls_node *node, const char *label)
{
    PLS_TRY(check_list(key, node, label, "a list of paths", 0));
    for (size_t k = 0; k < node->count; ++k) PLS_TRY(resolve_path(r, key, node->child[k], label));
    return PLS_OK;
}
