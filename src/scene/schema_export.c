// schema_export.c -- the schema table as JSON Schema, for editors, and as the reference page of the documentation.

#include "scene/expression.h"
#include "scene/schema.h"

#include "base/text.h"

#include <particls/bond.h>
#include <particls/scene.h>

#include <string.h>

// ---------------------------------------------------------------------------------------------------------------------------------------
// JSON Schema (draft 2020-12)

static pls_status json_string(pls_text *out, const char *text)
{
    PLS_TRY(pls_text_append(out, "\"", 1));
    for (const char *c = text; *c; ++c)
    {
        if (*c == '"' || *c == '\\') PLS_TRY(pls_text_append(out, "\\", 1));
        PLS_TRY(pls_text_append(out, c, 1));
    }
    return pls_text_append(out, "\"", 1);
}

static pls_status json_words(pls_text *out, const char *words)
{
    char word[64];
    PLS_TRY(pls_text_print(out, "["));
    for (size_t k = 0; pls_schema_word(words, k, word); ++k)
    {
        if (k) PLS_TRY(pls_text_print(out, ", "));
        PLS_TRY(json_string(out, word));
    }
    return pls_text_print(out, "]");
}

/// A number within its range, or a text: an expression, or one of the words.
static pls_status json_number(pls_text *out, const pls_key *key, bool integer)
{
    char number[32];
    PLS_TRY(pls_text_print(out, "{\"anyOf\": [{\"type\": \"%s\"", integer ? "integer" : "number"));
    bool open = key->flags & PLS_KEY_OPEN_MINIMUM;
    if (isfinite(key->minimum))
        PLS_TRY(pls_text_print(out, ", \"%s\": %s", open ? "exclusiveMinimum" : "minimum", pls_format_double(number, key->minimum)));
    if (isfinite(key->maximum)) PLS_TRY(pls_text_print(out, ", \"maximum\": %s", pls_format_double(number, key->maximum)));
    PLS_TRY(pls_text_print(out, "}, {\"type\": \"string\"}"));
    if (key->sub && key->type == PLS_KEY_NUMBER) PLS_TRY(pls_text_print(out, ", {\"$ref\": \"#/$defs/%s\"}", key->sub));
    return pls_text_print(out, "]}");
}

static pls_status json_list(pls_text *out, const pls_key *key, bool integer, int least, int most)
{
    PLS_TRY(pls_text_print(out, "{\"type\": \"array\", \"minItems\": %d, \"maxItems\": %d, \"items\": ", least, most));
    PLS_TRY(json_number(out, key, integer));
    return pls_text_print(out, "}");
}

static pls_status json_sections(pls_text *out, const pls_key *key)
{
    char section[64];
    PLS_TRY(
        pls_text_print(out, "{\"type\": \"array\", \"minItems\": %d, \"items\": {\"anyOf\": [", key->flags & PLS_KEY_MAY_BE_EMPTY ? 0 : 1));
    for (size_t k = 0; pls_schema_word(key->sub, k, section); ++k)
        PLS_TRY(pls_text_print(out, "%s{\"$ref\": \"#/$defs/%s\"}", k ? ", " : "", section));
    return pls_text_print(out, "]}}");
}

static pls_status json_type(pls_text *out, const pls_key *key)
{
    switch (key->type)
    {
        case PLS_KEY_NUMBER: return json_number(out, key, false);
        case PLS_KEY_INTEGER: return json_number(out, key, true);
        case PLS_KEY_BOOLEAN: return pls_text_print(out, "{\"type\": \"boolean\"}");
        case PLS_KEY_TEXT:
        case PLS_KEY_NAME:
        case PLS_KEY_PATH:
        case PLS_KEY_CONDITION: return pls_text_print(out, "{\"type\": [\"string\", \"number\"]}");
        case PLS_KEY_WORD:
            PLS_TRY(pls_text_print(out, "{\"enum\": "));
            PLS_TRY(json_words(out, key->words));
            return pls_text_print(out, "}");
        case PLS_KEY_VECTOR: return json_list(out, key, false, 2, 3);
        case PLS_KEY_COUNTS: return json_list(out, key, true, 2, 3);
        case PLS_KEY_VECTOR3: return json_list(out, key, false, 3, 3);
        case PLS_KEY_RANGE: return json_list(out, key, false, 2, 2);
        case PLS_KEY_SPIN:
            PLS_TRY(pls_text_print(out, "{\"anyOf\": ["));
            PLS_TRY(json_number(out, key, false));
            PLS_TRY(pls_text_print(out, ", "));
            PLS_TRY(json_list(out, key, false, 3, 3));
            return pls_text_print(out, "]}");
        case PLS_KEY_ORIENTATION:
            PLS_TRY(pls_text_print(out, "{\"anyOf\": [{\"$ref\": \"#/$defs/%s\"}, ", key->sub));
            PLS_TRY(json_number(out, key, false));
            PLS_TRY(pls_text_print(out, ", "));
            PLS_TRY(json_list(out, key, false, 4, 4));
            if (key->words) PLS_TRY(pls_text_print(out, ", {\"enum\": "));
            if (key->words) PLS_TRY(json_words(out, key->words));
            return pls_text_print(out, "%s]}", key->words ? "}" : "");
        case PLS_KEY_FLAGS:
            return pls_text_print(out, "{\"type\": \"array\", \"minItems\": 2, \"maxItems\": 3, \"items\": {\"type\": \"boolean\"}}");
        case PLS_KEY_POINTS:
        case PLS_KEY_PAIRS:
            PLS_TRY(pls_text_print(out, "{\"type\": \"array\", \"minItems\": 1, \"items\": "));
            PLS_TRY(json_list(out, key, false, 2, key->type == PLS_KEY_PAIRS ? 2 : 3));
            return pls_text_print(out, "}");
        case PLS_KEY_MIX:
            PLS_TRY(pls_text_print(out, "{\"anyOf\": [{\"type\": \"string\"}, {\"type\": \"array\", \"minItems\": 1, \"items\": {\"type\": "
                                        "\"string\"}}, {\"type\": \"object\", \"minProperties\": 1, \"additionalProperties\": "));
            PLS_TRY(json_number(out, key, false));
            return pls_text_print(out, "}]}");
        case PLS_KEY_NAMES:
            PLS_TRY(pls_text_print(out, "{\"anyOf\": [{\"type\": \"array\", \"items\": {\"type\": \"string\"}}"));
            if (key->words) PLS_TRY(pls_text_print(out, ", {\"enum\": "));
            if (key->words) PLS_TRY(json_words(out, key->words));
            return pls_text_print(out, "%s]}", key->words ? "}" : "");
        case PLS_KEY_WORDS:
            PLS_TRY(pls_text_print(out, "{\"type\": \"array\", \"minItems\": 1, \"items\": {\"enum\": "));
            PLS_TRY(json_words(out, key->words));
            return pls_text_print(out, "}}");
        case PLS_KEY_PATHS: return pls_text_print(out, "{\"type\": \"array\", \"items\": {\"type\": \"string\"}}");
        case PLS_KEY_SECTION: return pls_text_print(out, "{\"$ref\": \"#/$defs/%s\"}", key->sub);
        case PLS_KEY_CHOICE:
            return pls_text_print(out, "{\"allOf\": [{\"$ref\": \"#/$defs/%s\"}, {\"minProperties\": 1, \"maxProperties\": 1}]}", key->sub);
        case PLS_KEY_NAMED:
            return pls_text_print(out, "{\"type\": \"object\", \"minProperties\": 1, \"additionalProperties\": {\"$ref\": \"#/$defs/%s\"}}",
                                  key->sub);
        case PLS_KEY_LIST: return json_sections(out, key);
        case PLS_KEY_PLUGIN: break; // json_plugin
        case PLS_KEY_VARIABLES:
            return pls_text_print(out,
                                  "{\"type\": [\"object\", \"null\"], \"additionalProperties\": {\"type\": [\"number\", \"string\"]}}");
        case PLS_KEY_SHAPES:
            return pls_text_print(out,
                                  "{\"type\": \"object\", \"minProperties\": 1, \"additionalProperties\": {\"$ref\": \"#/$defs/shape\"}}");
    }
    return PLS_OK;
}

/// "name": {"description": "...", "allOf": [type]} -- so that the description stands beside a reference too.
static pls_status json_key(pls_text *out, const pls_key *key, bool first)
{
    PLS_TRY(pls_text_print(out, "%s\n        ", first ? "" : ","));
    PLS_TRY(json_string(out, key->name));
    PLS_TRY(pls_text_print(out, ": {\"description\": "));
    pls_text words = {0};
    pls_status status = pls_text_print(&words, "%s%s%s%s%s%s", key->meaning, *key->unit ? " [" : "", key->unit, *key->unit ? "]" : "",
                                       key->initial && *key->initial ? "; default " : "", key->initial ? key->initial : "");
    if (status == PLS_OK) status = json_string(out, words.data);
    pls_text_free(&words);
    PLS_TRY(status);
    PLS_TRY(pls_text_print(out, ", \"allOf\": ["));
    PLS_TRY(json_type(out, key));
    return pls_text_print(out, "]}");
}

static pls_status json_required(pls_text *out, const pls_key *keys, size_t count)
{
    bool any = false;
    for (size_t k = 0; k < count; ++k)
    {
        if (!(keys[k].flags & PLS_KEY_REQUIRED)) continue;
        PLS_TRY(pls_text_print(out, "%s", any ? ", " : ", \"required\": ["));
        PLS_TRY(json_string(out, keys[k].name));
        any = true;
    }
    return any ? pls_text_print(out, "]") : PLS_OK;
}

/// Properties of a map. A closed map knows no other keys.
static pls_status json_map(pls_text *out, const pls_key *keys, size_t count, bool closed)
{
    PLS_TRY(pls_text_print(out, "\"properties\": {"));
    for (size_t k = 0; k < count; ++k) PLS_TRY(json_key(out, &keys[k], k == 0));
    PLS_TRY(pls_text_print(out, "}"));
    PLS_TRY(json_required(out, keys, count));
    return pls_text_print(out, closed ? ", \"additionalProperties\": false" : "");
}

/// Rows of a table of parameters; `initial` holds their defaults' texts.
static size_t parameter_keys(const pls_parameter *table, pls_table_owner owner, pls_key keys[PLS_MAX_KEYS], char initial[PLS_MAX_KEYS][32])
{
    size_t count = 0;
    for (; table && table->name && count < PLS_MAX_KEYS; ++table, ++count)
        keys[count] = pls_schema_parameter_of(owner, table, initial[count]);
    return count;
}

/// The map of a shape holds nothing else, that of a contact law does.
static pls_status json_parameters(pls_text *out, const pls_parameter *table, pls_table_owner owner)
{
    pls_key keys[PLS_MAX_KEYS];
    char initial[PLS_MAX_KEYS][32];
    size_t count = parameter_keys(table, owner, keys, initial);
    return json_map(out, keys, count, owner == PLS_OF_SHAPE);
}

static pls_status json_shape(pls_text *out)
{
    size_t beside;
    const pls_key *keys = pls_schema_keys("any_shape", &beside);
    PLS_TRY(pls_text_print(out, ",\n    \"shape\": {\"type\": \"object\", \"minProperties\": 1, \"maxProperties\": %zu, \"properties\": {",
                           1 + beside));
    for (const pls_shape_ops *const *ops = pls_builtin_shapes(); *ops; ++ops)
    {
        PLS_TRY(pls_text_print(out, "%s\n      ", ops == pls_builtin_shapes() ? "" : ","));
        PLS_TRY(json_string(out, (*ops)->name));
        PLS_TRY(pls_text_print(out, ": {\"type\": [\"object\", \"null\"], \"description\": "));
        PLS_TRY(json_string(out, (*ops)->meaning));
        PLS_TRY(pls_text_print(out, ", "));
        PLS_TRY(json_parameters(out, (*ops)->parameters, PLS_OF_SHAPE));
        PLS_TRY(pls_text_print(out, "}"));
    }
    for (size_t k = 0; k < beside; ++k) PLS_TRY(json_key(out, &keys[k], false));
    return pls_text_print(out, "}}");
}

static pls_status json_law(pls_text *out, const char *name, const char *meaning, const pls_parameter *parameters, pls_table_owner owner,
                           bool first)
{
    PLS_TRY(pls_text_print(out, "%s\n      {\"if\": {\"properties\": {\"law\": {\"const\": ", first ? "" : ","));
    PLS_TRY(json_string(out, name));
    PLS_TRY(pls_text_print(out, "}}}, \"then\": {\"description\": "));
    PLS_TRY(json_string(out, meaning));
    PLS_TRY(pls_text_print(out, ", "));
    PLS_TRY(json_parameters(out, parameters, owner));
    return pls_text_print(out, "}}");
}

/// An entry with a law is open, because its other keys are the parameters of the law, which may come from a plugin; those of built-in laws are
/// described.
static pls_status json_laws(pls_text *out, bool of_bonds)
{
    PLS_TRY(pls_text_print(out, ", \"allOf\": ["));
    for (const pls_law_ops *const *ops = pls_builtin_laws(); !of_bonds && *ops; ++ops)
        PLS_TRY(json_law(out, (*ops)->name, (*ops)->meaning, (*ops)->parameters, PLS_OF_LAW, ops == pls_builtin_laws()));
    for (const pls_bond_ops *const *ops = pls_builtin_bonds(); of_bonds && *ops; ++ops)
        PLS_TRY(json_law(out, (*ops)->name, (*ops)->meaning, (*ops)->parameters, PLS_OF_BOND, ops == pls_builtin_bonds()));
    return pls_text_print(out, "]");
}

/// First keys of the other sections that stand in the same list: "a|b|c" of the list, without `section`.
static pls_status json_not_others(pls_text *out, const char *list, const char *section)
{
    char word[64];
    size_t count;
    PLS_TRY(pls_text_print(out, "\"not\": {\"anyOf\": ["));
    bool any = false;
    for (size_t k = 0; pls_schema_word(list, k, word); ++k)
    {
        if (strcmp(word, section) == 0) continue;
        PLS_TRY(pls_text_print(out, "%s{\"required\": [", any ? ", " : ""));
        PLS_TRY(json_string(out, pls_schema_keys(word, &count)->name));
        PLS_TRY(pls_text_print(out, "]}"));
        any = true;
    }
    return pls_text_print(out, "]}");
}

/// A force or observer of a plugin: one further key, whose name and contents only the plugin knows, beside the rows of the section.
static pls_status json_plugin(pls_text *out, const char *section, const pls_key *keys, size_t count)
{
    size_t all;
    const pls_key *list = pls_schema_keys("scene", &all);
    while (!list->sub || !strstr(list->sub, section)) ++list;
    PLS_TRY(json_map(out, keys + 1, count - 1, false)); // without the row NAME, the first
    PLS_TRY(pls_text_print(out, ", \"minProperties\": 1, "));
    PLS_TRY(json_not_others(out, list->sub, section));
    return pls_text_print(out, ", \"additionalProperties\": {\"type\": [\"object\", \"null\"]}");
}

static pls_status write_json(pls_text *out)
{
    PLS_TRY(pls_text_print(out, "{\n  \"$schema\": \"https://json-schema.org/draft/2020-12/schema\",\n  \"title\": \"particls scene\",\n"
                                "  \"$ref\": \"#/$defs/scene\",\n  \"$defs\": {"));
    size_t sections, count;
    const pls_section *section = pls_schema_sections(&sections);
    for (size_t k = 0; k < sections; ++k)
    {
        const pls_key *keys = pls_schema_keys(section[k].name, &count);
        const bool bond = strcmp(section[k].name, "bond") == 0, law = bond || strcmp(section[k].name, "contact") == 0;
        bool nothing = true, plugin = count > 0 && keys->type == PLS_KEY_PLUGIN;
        for (size_t j = 0; j < count; ++j) nothing = nothing && !(keys[j].flags & PLS_KEY_REQUIRED);
        PLS_TRY(pls_text_print(out, "%s\n    ", k ? "," : ""));
        PLS_TRY(json_string(out, section[k].name));
        PLS_TRY(pls_text_print(out, ": {\"type\": %s, \"description\": ", nothing ? "[\"object\", \"null\"]" : "\"object\""));
        PLS_TRY(json_string(out, section[k].meaning));
        PLS_TRY(pls_text_print(out, ", "));
        PLS_TRY(plugin ? json_plugin(out, section[k].name, keys, count) : json_map(out, keys, count, !law));
        if (law) PLS_TRY(json_laws(out, bond));
        PLS_TRY(pls_text_print(out, "}"));
    }
    PLS_TRY(json_shape(out));
    return pls_text_print(out, "\n  }\n}\n");
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// the reference page

static const char *type_text(pls_key_type type)
{
    switch (type)
    {
        case PLS_KEY_NUMBER: return "number";
        case PLS_KEY_INTEGER: return "integer";
        case PLS_KEY_BOOLEAN: return "true or false";
        case PLS_KEY_TEXT: return "text";
        case PLS_KEY_NAME: return "name";
        case PLS_KEY_WORD: return "one of";
        case PLS_KEY_PATH: return "path";
        case PLS_KEY_CONDITION: return "condition";
        case PLS_KEY_VECTOR: return "vector";
        case PLS_KEY_VECTOR3: return "3 numbers";
        case PLS_KEY_SPIN: return "3 numbers, 2D: 1";
        case PLS_KEY_RANGE: return "2 numbers";
        case PLS_KEY_COUNTS: return "vector of integers";
        case PLS_KEY_FLAGS: return "list of booleans";
        case PLS_KEY_ORIENTATION: return "orientation";
        case PLS_KEY_POINTS: return "list of vectors";
        case PLS_KEY_PAIRS: return "list of pairs";
        case PLS_KEY_MIX: return "name, list of names or map of numbers";
        case PLS_KEY_NAMES: return "list of names";
        case PLS_KEY_WORDS: return "list of";
        case PLS_KEY_PATHS: return "list of paths";
        case PLS_KEY_SECTION: return "map";
        case PLS_KEY_CHOICE: return "map of one key";
        case PLS_KEY_NAMED: return "map of names";
        case PLS_KEY_LIST: return "list of maps";
        case PLS_KEY_PLUGIN: return "map";
        case PLS_KEY_VARIABLES: return "map of numbers";
        case PLS_KEY_SHAPES: return "map of shapes";
    }
    return "";
}

static pls_status page_type(pls_text *out, const pls_key *key)
{
    PLS_TRY(pls_text_print(out, "%s", type_text(key->type)));
    bool listed = key->type == PLS_KEY_WORD || key->type == PLS_KEY_WORDS;
    char word[64];
    for (size_t k = 0; key->words && pls_schema_word(key->words, k, word); ++k)
        PLS_TRY(pls_text_print(out, "%s`%s`", k ? ", " : listed ? " " : " or ", word));
    for (size_t k = 0; key->sub && pls_schema_word(key->sub, k, word); ++k)
        PLS_TRY(pls_text_print(out, "%s[%s](#%s)", k ? ", " : ": ", word, word));
    return PLS_OK;
}

static pls_status page_range(pls_text *out, const pls_key *key)
{
    char least[32], most[32];
    pls_format_double(least, key->minimum);
    pls_format_double(most, key->maximum);
    const char *relation = key->flags & PLS_KEY_OPEN_MINIMUM ? ">" : ">=";
    if (isfinite(key->minimum)) PLS_TRY(pls_text_print(out, "%s %s", relation, least));
    if (isfinite(key->maximum)) PLS_TRY(pls_text_print(out, "%s<= %s", isfinite(key->minimum) ? ", " : "", most));
    return PLS_OK;
}

static pls_status page_variables(pls_text *out, unsigned uses)
{
    static const struct
    {
        unsigned bit;
        const char *names;
    } all[] = {{PLS_USES_TIME, "t"},        {PLS_USES_PLACE, "x y z"},   {PLS_USES_VELOCITY, "vx vy vz"},
               {PLS_USES_RADIUS, "r"},      {PLS_USES_MASS, "m"},        {PLS_USES_OWN, "s"},
               {PLS_USES_STATES, "states"}, {PLS_USES_CHANCE, "chance"}, {PLS_USES_TEMPERATURE, "temperature"}};
    bool any = false;
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k)
    {
        if (!(uses & all[k].bit)) continue;
        PLS_TRY(pls_text_print(out, "%s%s", any ? " " : "", all[k].names));
        any = true;
    }
    return PLS_OK;
}

static pls_status page_keys(pls_text *out, const pls_key *keys, size_t count)
{
    if (count == 0) return pls_text_print(out, "No parameters.\n\n");
    PLS_TRY(pls_text_print(out, "| key | type | unit | default | range | may use | meaning |\n|---|---|---|---|---|---|---|\n"));
    for (size_t k = 0; k < count; ++k)
    {
        const pls_key *key = &keys[k];
        PLS_TRY(pls_text_print(out, "| `%s` | ", key->name));
        PLS_TRY(page_type(out, key));
        const char *initial = key->flags & PLS_KEY_REQUIRED ? "**required**" : key->initial ? key->initial : "";
        PLS_TRY(pls_text_print(out, " | %s | %s | ", key->unit, initial));
        PLS_TRY(page_range(out, key));
        PLS_TRY(pls_text_print(out, " | "));
        PLS_TRY(page_variables(out, key->uses));
        PLS_TRY(pls_text_print(out, " | %s |\n", key->meaning));
    }
    return pls_text_print(out, "\n");
}

pls_status pls_page_parameters(pls_text *out, const char *name, const char *meaning, const pls_parameter *table, pls_table_owner owner)
{
    pls_key keys[PLS_MAX_KEYS];
    char initial[PLS_MAX_KEYS][32];
    size_t count = parameter_keys(table, owner, keys, initial);
    PLS_TRY(pls_text_print(out, "### %s\n\n%s.\n\n", name, meaning ? meaning : ""));
    return page_keys(out, keys, count);
}

static pls_status page_head(pls_text *out)
{
    PLS_TRY(pls_text_print(
        out,
        "# Scene reference\n\n"
        "This page is made by the program from the table that its reader uses (`src/scene/schema.c`).\n\n"
        "A scene is a YAML file. Units are SI. A vector is a list of as many numbers as the scene has dimensions. Paths are relative to "
        "the folder of the\n"
        "scene. Unknown keys are errors. `particls run scene.yaml --set time.end=2 --set bodies[top].scale=2` changes values from the "
        "command line.\n\n"
        "## Expressions\n\n"
        "Wherever a number may stand, a text may stand that computes it from `vars`, `pi` and `e`: `kn: \"kn/2\"`. Some keys may also use "
        "the variables of the\n"
        "column *may use*; they are then evaluated during the run:\n\n"
        "| variable | meaning |\n|---|---|\n"
        "| `t` | time [s] |\n| `x y z` | centre of the body [m] |\n| `vx vy vz` | its velocity [m/s] |\n| `r` | its bounding radius [m] |\n"
        "| `m` | its mass [kg] |\n| `s` | the state itself |\n| states | the value of any state by its name |\n"
        "| `chance` | a number in (0, 1) that each body draws for itself; hides a name of `vars` |\n"
        "| `temperature` | of the body in its bonds; hides a name of `vars` |\n\n"
        "Operators: `+ - * / ^`, `< <= > >= == !=`, `&&`, `||`, `condition ? a : b`. `log` is the natural logarithm. Functions:"));
    size_t count;
    const char *const *functions = pls_expression_functions(&count);
    for (size_t k = 0; k < count; ++k) PLS_TRY(pls_text_print(out, "%s`%s`", k ? ", " : " ", functions[k]));
    return pls_text_print(out, ".\nThe result must be a finite number.\n\n");
}

static pls_status write_page(pls_text *out)
{
    PLS_TRY(page_head(out));
    size_t sections, count;
    const pls_section *section = pls_schema_sections(&sections);
    for (size_t k = 0; k < sections; ++k)
    {
        PLS_TRY(pls_text_print(out, "## %s\n\n`%s`: %s\n\n", section[k].name, section[k].path, section[k].meaning));
        const pls_key *keys = pls_schema_keys(section[k].name, &count);
        PLS_TRY(page_keys(out, keys, count));
    }
    PLS_TRY(pls_text_print(out, "## Shapes\n\n`shapes: {NAME: {SHAPE: {parameters}}}`\n\n"));
    for (const pls_shape_ops *const *ops = pls_builtin_shapes(); *ops; ++ops)
        PLS_TRY(pls_page_parameters(out, (*ops)->name, (*ops)->meaning, (*ops)->parameters, PLS_OF_SHAPE));
    PLS_TRY(pls_text_print(out, "## Contact laws\n\n`contact: [{between: [a, b], law: LAW, parameters}]`\n\n"));
    for (const pls_law_ops *const *ops = pls_builtin_laws(); *ops; ++ops)
        PLS_TRY(pls_page_parameters(out, (*ops)->name, (*ops)->meaning, (*ops)->parameters, PLS_OF_LAW));
    PLS_TRY(pls_text_print(out, "## Bond laws\n\n`bonds: [{of: [a, b], law: LAW, parameters}]`\n\n"));
    for (const pls_bond_ops *const *ops = pls_builtin_bonds(); *ops; ++ops)
        PLS_TRY(pls_page_parameters(out, (*ops)->name, (*ops)->meaning, (*ops)->parameters, PLS_OF_BOND));
    return PLS_OK;
}

static pls_status give_text(pls_status (*write)(pls_text *), char **text)
{
    *text = NULL;
    pls_text out = {0};
    pls_status status = write(&out);
    if (status == PLS_OK)
        *text = out.data;
    else
        pls_text_free(&out);
    return status;
}

pls_status pls_scene_json_schema(char **text) { return give_text(write_json, text); }
pls_status pls_scene_reference(char **text) { return give_text(write_page, text); }
