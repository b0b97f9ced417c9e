// used.c -- the resolved tree as YAML text: scene.used.yaml, and what the scene's hash is taken of.
//
// Top-level keys and the entries of lists and maps of names stand on lines of their own, what is within them in flow style. Numbers are
// written with the fewest digits that read back to the same bits, so the text loads to the same scene.

#include "scene/scene_data.h"

#include "base/atomic_file.h"
#include "base/hash.h"

#include <string.h>

enum { WRAP = 100 }; ///< a list of lists goes on in a new line after so many characters

typedef struct printer
{
    pls_text *text;
    bool for_hash;
    size_t line_start;
} printer;

static pls_status print_quoted(printer *p, const char *text)
{
    PLS_TRY(pls_text_append(p->text, "\"", 1));
    for (const char *c = text; *c; ++c)
    {
        const char *escape = *c == '"' ? "\\\"" : *c == '\\' ? "\\\\" : *c == '\n' ? "\\n" : *c == '\r' ? "\\r" : *c == '\t' ? "\\t" : NULL;
        PLS_TRY(escape ? pls_text_append(p->text, escape, 2) : pls_text_append(p->text, c, 1));
    }
    return pls_text_append(p->text, "\"", 1);
}

/// Whether the text can stand without quotes and still be read as a text.
static bool is_plain(const char *text)
{
    double number;
    if (!*text || pls_parse_double(text, &number) || strcmp(text, "null") == 0) return false;
    return strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789") == strlen(text) && (*text < '0' || *text > '9');
}

/// For the hash a file counts with its name and contents, wherever it lies. A plugin counts with its name: compiled anew it is still the
/// same scene.
static pls_status print_file(printer *p, const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    size_t size = strlen(name);
    if (size > 3 && strcmp(name + size - 3, ".so") == 0) return print_quoted(p, name);
    char *data;
    size_t bytes;
    PLS_TRY(pls_read_file(path, &data, &bytes));
    uint64_t hash = pls_hash(PLS_HASH_START, data, bytes);
    pls_release(&data);
    return pls_text_print(p->text, "%s:%016llx", name, (unsigned long long)hash);
}

static pls_status print_scalar(printer *p, const pls_node *node)
{
    char number[32];
    if (node->numeric && isinf(node->number)) return pls_text_print(p->text, node->number < 0 ? "-.inf" : ".inf");
    if (node->numeric) return pls_text_print(p->text, "%s", pls_format_double(number, node->number));
    if (node->path && p->for_hash) return print_file(p, node->text);
    bool word = !node->formula && is_plain(node->text);
    return word ? pls_text_print(p->text, "%s", node->text) : print_quoted(p, node->text);
}

static pls_status print_flow(printer *p, const pls_node *node)
{
    if (node->kind == PLS_NODE_SCALAR) return print_scalar(p, node);
    bool map = node->kind == PLS_NODE_MAP;
    PLS_TRY(pls_text_append(p->text, map ? "{" : "[", 1));
    for (size_t k = 0; k < node->count; ++k)
    {
        if (k) PLS_TRY(pls_text_append(p->text, ", ", 2));
        if (p->text->size - p->line_start > WRAP && node->child[k]->kind != PLS_NODE_SCALAR)
        {
            PLS_TRY(pls_text_append(p->text, "\n      ", 7));
            p->line_start = p->text->size;
        }
        if (map) PLS_TRY(pls_text_print(p->text, "%s: ", node->key[k]->text));
        PLS_TRY(print_flow(p, node->child[k]));
    }
    return pls_text_append(p->text, map ? "}" : "]", 1);
}

static bool holds_collections(const pls_node *node)
{
    for (size_t k = 0; k < node->count; ++k)
    {
        if (node->child[k]->kind != PLS_NODE_SCALAR) return true;
    }
    return false;
}

static pls_status print_top(printer *p, const char *key, const pls_node *node)
{
    p->line_start = p->text->size;
    if (node->kind == PLS_NODE_SCALAR || !holds_collections(node))
    {
        PLS_TRY(pls_text_print(p->text, "%s: ", key));
        PLS_TRY(print_flow(p, node));
        return pls_text_append(p->text, "\n", 1);
    }
    PLS_TRY(pls_text_print(p->text, "%s:\n", key));
    for (size_t k = 0; k < node->count; ++k)
    {
        p->line_start = p->text->size;
        if (node->kind == PLS_NODE_MAP)
            PLS_TRY(pls_text_print(p->text, "  %s: ", node->key[k]->text));
        else
            PLS_TRY(pls_text_append(p->text, "  - ", 4));
        PLS_TRY(print_flow(p, node->child[k]));
        PLS_TRY(pls_text_append(p->text, "\n", 1));
    }
    return PLS_OK;
}

pls_status pls_scene_print(const pls_scene *scene, bool for_hash, pls_text *text)
{
    printer p = {.text = text, .for_hash = for_hash};
    for (size_t k = 0; k < scene->root->count; ++k) PLS_TRY(print_top(&p, scene->root->key[k]->text, scene->root->child[k]));
    return PLS_OK;
}

pls_status pls_scene_used_text(const pls_scene *scene, char **text)
{
    *text = NULL;
    pls_text printed = {0};
    pls_status status = pls_scene_print(scene, false, &printed);
    if (status == PLS_OK)
        *text = printed.data;
    else
        pls_text_free(&printed);
    return status;
}

void pls_scene_free_text(char *text) { pls_release(&text); }
