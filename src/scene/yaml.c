// yaml.c -- YAML text to nodes, through libfyaml's events, which know the line and column of everything.
//
// Only what a scene needs: one document of maps, lists and scalars; anchors are copied where they are used (within a limit, so that nested
// aliases cannot blow up); tags, further documents, duplicate keys and keys that are not plain text are refused.

#include "scene/node.h"

#include "base/atomic_file.h"

#include <libfyaml.h>
#include <string.h>
#include <sys/stat.h>

enum {
    MAX_FILE_BYTES = 64 << 20,
    MAX_NODES = 8 << 20,
    MAX_DEPTH = 60, ///< nested lists and maps; libfyaml guarantees 64
    MAX_MAP_KEYS = 4096
};

typedef struct anchor
{
    const char *name;
    pls_node *node;
} anchor;

typedef struct reader
{
    pls_arena *arena;
    const pls_source *source;
    struct fy_parser *parser;
    struct fy_diag *diag;
    anchor *anchors;
    size_t anchor_count, anchor_capacity;
    size_t nodes;
} reader;

// ---------------------------------------------------------------------------------------------------------------------------------------
// text

/// Bytes of the UTF-8 character at `at`, 0 when it is none.
static size_t utf8_size(const unsigned char *at, size_t left)
{
    static const unsigned smallest[5] = {0, 0, 0x80, 0x800, 0x10000};
    size_t size = at[0] < 0x80 ? 1 : (at[0] & 0xE0U) == 0xC0 ? 2 : (at[0] & 0xF0U) == 0xE0 ? 3 : (at[0] & 0xF8U) == 0xF0 ? 4 : 0;
    if (size == 0 || size > left) return 0;
    if (size == 1) return 1;
    unsigned code = at[0] & (0x7FU >> size);
    for (size_t k = 1; k < size; ++k)
    {
        if ((at[k] & 0xC0U) != 0x80U) return 0;
        code = code << 6 | (at[k] & 0x3FU);
    }
    bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    return code < smallest[size] || code > 0x10FFFF || surrogate ? 0 : size;
}

static pls_status check_text(const pls_source *source)
{
    int line = 1, column = 1;
    for (size_t k = 0; k < source->size;)
    {
        const unsigned char *at = (const unsigned char *)source->text + k;
        size_t size = utf8_size(at, source->size - k);
        bool control = *at < 0x20 && *at != '\t' && *at != '\n' && *at != '\r';
        if (size == 0 || control || *at == 0x7F)
            return pls_fail(PLS_SCENE, "%s:%d:%d: not a text file: byte 0x%02x is %s\n  a scene is YAML text in UTF-8", source->name, line,
                            column, *at, size ? "a control character" : "not UTF-8");
        k += size;
        ++column;
        if (*at != '\n') continue;
        ++line;
        column = 1;
    }
    return PLS_OK;
}

pls_status pls_source_read(pls_arena *arena, const char *path, pls_source *source)
{
    struct stat info;
    if (stat(path, &info) != 0) return pls_fail(PLS_NOT_FOUND, "%s: there is no such scene file", path);
    if (!S_ISREG(info.st_mode)) return pls_fail(PLS_INVALID_ARGUMENT, "%s: not a regular file; give the scene's YAML file", path);
    if (info.st_size > MAX_FILE_BYTES)
        return pls_fail(PLS_LIMIT_EXCEEDED, "%s: %lld bytes are too many for a scene (at most 64 MiB); put bodies into a CSV file", path,
                        (long long)info.st_size);
    char *text;
    size_t size;
    PLS_TRY(pls_read_file(path, &text, &size));
    char *kept = NULL;
    pls_status status = pls_arena_allocate(arena, &kept, size + 1, 1, "the scene's text");
    if (status == PLS_OK) memcpy(kept, text, size);
    pls_release(&text);
    if (status != PLS_OK) return status;
    size_t skip = size >= 3 && memcmp(kept, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0; // byte order mark
    *source = (pls_source){.text = kept + skip, .size = size - skip, .has_lines = true};
    PLS_TRY(pls_arena_copy_text(arena, &source->name, path));
    return check_text(source);
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// events to nodes

static bool indented_by_tab(const pls_source *source, int line)
{
    const char *at = source->text;
    for (int k = 1; k < line && at; ++k)
    {
        at = strchr(at, '\n');
        if (at) ++at;
    }
    while (at && *at == ' ') ++at;
    return at && *at == '\t';
}

/// The parser stopped: say where and why.
static pls_status syntax_error(reader *r)
{
    void *state = NULL;
    const struct fy_diag_error *error = r->diag ? fy_diag_errors_iterate(r->diag, &state) : NULL;
    if (!error) return pls_fail(PLS_SCENE, "%s: not valid YAML", r->source->name);
    int line = error->line < 1 ? 1 : error->line, column = error->column < 1 ? 1 : error->column;
    const char *hint = indented_by_tab(r->source, line) ? "YAML is indented with spaces, not with tabs" : NULL;
    return pls_source_fail(r->source, line, column, hint, "not valid YAML: %s", error->msg);
}

static pls_status next_event(reader *r, struct fy_event **event)
{
    *event = fy_parser_parse(r->parser);
    return *event ? PLS_OK : syntax_error(r);
}

static pls_status copy_token(reader *r, struct fy_token *token, const char **text)
{
    size_t size = 0;
    const char *data = token ? fy_token_get_text(token, &size) : NULL;
    if (!data)
    {
        *text = "";
        return PLS_OK;
    }
    char *copy = NULL;
    PLS_TRY(pls_arena_allocate(r->arena, &copy, size + 1, 1, "a scene text"));
    memcpy(copy, data, size);
    *text = copy;
    return PLS_OK;
}

static pls_status new_node(reader *r, pls_node_kind kind, int line, int column, pls_node **node)
{
    if (++r->nodes > MAX_NODES)
        return pls_fail(PLS_LIMIT_EXCEEDED, "%s: more than %d values; put bodies into a CSV file", r->source->name, MAX_NODES);
    PLS_TRY(pls_arena_allocate(r->arena, node, 1, sizeof **node, "a scene node"));
    **node = (pls_node){.kind = kind, .text = "", .source = r->source, .line = line, .column = column};
    return PLS_OK;
}

static pls_status copy_node(reader *r, const pls_node *from, pls_node **copy)
{
    PLS_TRY(new_node(r, from->kind, from->line, from->column, copy));
    **copy = *from;
    (*copy)->count = 0;
    for (size_t k = 0; k < from->count; ++k)
    {
        pls_node *child;
        PLS_TRY(copy_node(r, from->child[k], &child));
        PLS_TRY(pls_node_append(r->arena, *copy, from->kind == PLS_NODE_MAP ? from->key[k] : NULL, child));
    }
    return PLS_OK;
}

static pls_status read_alias(reader *r, struct fy_token *token, pls_node *at, pls_node **node)
{
    const char *name;
    PLS_TRY(copy_token(r, token, &name));
    for (size_t k = r->anchor_count; k-- > 0;)
    {
        if (strcmp(r->anchors[k].name, name) == 0) return copy_node(r, r->anchors[k].node, node);
    }
    return pls_node_fail(at, NULL, "there is no anchor '&%s' before this place", name);
}

static pls_status keep_anchor(reader *r, struct fy_token *token, pls_node *node)
{
    if (!token) return PLS_OK;
    PLS_TRY(pls_reserve(&r->anchors, &r->anchor_capacity, r->anchor_count + 1, sizeof *r->anchors, "the scene's anchors"));
    PLS_TRY(copy_token(r, token, &r->anchors[r->anchor_count].name));
    r->anchors[r->anchor_count++].node = node;
    return PLS_OK;
}

static pls_status read_node(reader *r, struct fy_event *event, int depth, pls_node **node);

static pls_status check_key(const pls_node *map, const pls_node *key)
{
    if (key->kind != PLS_NODE_SCALAR) return pls_node_fail(key, NULL, "a key must be a text, not %s", pls_node_describe(key));
    if (map->count >= MAX_MAP_KEYS) return pls_node_fail(key, NULL, "more than %d keys in one map", MAX_MAP_KEYS);
    const pls_node *first = pls_node_key(map, key->text);
    if (first)
        return pls_node_fail(key, "each key may be given once; remove one of the two", "duplicate key '%s', first given in line %d",
                             key->text, first->line);
    return PLS_OK;
}

static pls_status read_map(reader *r, pls_node *map, int depth)
{
    for (;;)
    {
        struct fy_event *event;
        PLS_TRY(next_event(r, &event));
        bool end = event->type == FYET_MAPPING_END;
        pls_node *key = NULL, *value = NULL;
        pls_status status = end ? PLS_OK : read_node(r, event, depth, &key);
        fy_parser_event_free(r->parser, event);
        if (end || status != PLS_OK) return status;
        PLS_TRY(check_key(map, key));
        PLS_TRY(next_event(r, &event));
        status = read_node(r, event, depth, &value);
        fy_parser_event_free(r->parser, event);
        PLS_TRY(status);
        if (value->line == 0) value->line = key->line, value->column = key->column; // nothing is written there
        PLS_TRY(pls_node_append(r->arena, map, key, value));
    }
}

static pls_status read_list(reader *r, pls_node *list, int depth)
{
    for (;;)
    {
        struct fy_event *event;
        PLS_TRY(next_event(r, &event));
        bool end = event->type == FYET_SEQUENCE_END;
        pls_node *item = NULL;
        pls_status status = end ? PLS_OK : read_node(r, event, depth, &item);
        fy_parser_event_free(r->parser, event);
        if (end || status != PLS_OK) return status;
        if (item->line == 0) item->line = list->line, item->column = list->column;
        PLS_TRY(pls_node_append(r->arena, list, NULL, item));
    }
}

static pls_status read_scalar(reader *r, struct fy_token *token, pls_node *node)
{
    PLS_TRY(copy_token(r, token, &node->text));
    enum fy_scalar_style style = token ? fy_token_scalar_style(token) : FYSS_PLAIN;
    node->quoted = style != FYSS_PLAIN && style != FYSS_ANY;
    node->exact = style != FYSS_LITERAL && style != FYSS_FOLDED && !strpbrk(node->text, "\n\\\"'");
    return PLS_OK;
}

static pls_status read_node(reader *r, struct fy_event *event, int depth, pls_node **node)
{
    const struct fy_mark *mark = fy_event_start_mark(event);
    int line = mark ? mark->line + 1 : 0, column = mark ? mark->column + 1 : 0;
    struct fy_token *tag = NULL, *name = NULL;
    pls_node_kind kind = PLS_NODE_SCALAR;
    if (event->type == FYET_SCALAR)
        tag = event->scalar.tag, name = event->scalar.anchor;
    else if (event->type == FYET_MAPPING_START)
        kind = PLS_NODE_MAP, tag = event->mapping_start.tag, name = event->mapping_start.anchor;
    else if (event->type == FYET_SEQUENCE_START)
        kind = PLS_NODE_LIST, tag = event->sequence_start.tag, name = event->sequence_start.anchor;

    PLS_TRY(new_node(r, kind, line, column, node));
    if (event->type == FYET_ALIAS) return read_alias(r, event->alias.anchor, *node, node);
    if (tag) return pls_node_fail(*node, "remove the tag", "tags (!...) have no meaning in a scene");
    if (depth >= MAX_DEPTH) return pls_node_fail(*node, NULL, "nested more than %d deep", MAX_DEPTH);
    if (kind == PLS_NODE_SCALAR) PLS_TRY(read_scalar(r, event->scalar.value, *node));
    if (kind == PLS_NODE_MAP) PLS_TRY(read_map(r, *node, depth + 1));
    if (kind == PLS_NODE_LIST) PLS_TRY(read_list(r, *node, depth + 1));
    return keep_anchor(r, name, *node);
}

/// Stream and document events around the one root node.
static pls_status read_stream(reader *r, pls_node **root)
{
    *root = NULL;
    for (;;)
    {
        struct fy_event *event;
        PLS_TRY(next_event(r, &event));
        bool end = event->type == FYET_STREAM_END;
        bool content = event->type == FYET_SCALAR || event->type == FYET_ALIAS || event->type == FYET_MAPPING_START ||
                       event->type == FYET_SEQUENCE_START;
        const struct fy_mark *mark = fy_event_start_mark(event);
        int line = mark ? mark->line + 1 : 1;
        pls_status status = PLS_OK;
        if (content && *root)
            status = pls_source_fail(r->source, line, 1, NULL, "a scene is one YAML document; a second one begins here");
        else if (content)
            status = read_node(r, event, 0, root);
        fy_parser_event_free(r->parser, event);
        if (status != PLS_OK || end) return status;
    }
}

pls_status pls_yaml_read(pls_arena *arena, const pls_source *source, pls_node **root)
{
    reader r = {.arena = arena, .source = source};
    struct fy_diag_cfg diag_cfg;
    fy_diag_cfg_default(&diag_cfg);
    diag_cfg.fp = NULL;
    r.diag = fy_diag_create(&diag_cfg);
    if (r.diag) fy_diag_set_collect_errors(r.diag, true);
    struct fy_parse_cfg cfg = {
        .flags = FYPCF_QUIET | FYPCF_COLLECT_DIAG | FYPCF_JSON_NONE | FYPCF_DISABLE_MMAP_OPT | FYPCF_ALLOW_DUPLICATE_KEYS, .diag = r.diag};
    r.parser = fy_parser_create(&cfg);
    pls_status status = PLS_OK;
    if (!r.diag || !r.parser || fy_parser_set_string(r.parser, source->text, source->size) != 0)
        status = pls_fail(PLS_OUT_OF_MEMORY, "%s: no memory for the YAML reader", source->name);
    if (status == PLS_OK) status = read_stream(&r, root);
    if (status == PLS_OK && !*root) status = pls_fail(PLS_SCENE, "%s: the file is empty\n  a scene begins with  particls: 1", source->name);
    if (r.parser) fy_parser_destroy(r.parser);
    if (r.diag) fy_diag_destroy(r.diag);
    pls_release(&r.anchors);
    return status;
}
