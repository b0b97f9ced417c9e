// override.c -- `--set path=value`: change one value of the tree before it is resolved.
//
// Path: keys joined by points, [k] for an entry of a list, by number or by its name ("bodies[top].motion.velocity"). The value is YAML. A
// key that the file does not hold is added, and resolving refuses it if the schema does not know it; under vars, materials and shapes,
// whose keys are the user's own names, it must be there already.

#include "scene/scene_data.h"

#include <stdlib.h>
#include <string.h>

typedef struct override
{
    pls_scene *scene;
    const pls_source *source;
    const char *at; ///< rest of the path
    const char *end;
} override;

static pls_status fail_path(const override *o, const char *message, const char *part, const pls_node *node)
{
    char hint[600] = "";
    if (node && node->kind == PLS_NODE_MAP)
    {
        const char *candidates[128];
        size_t count = 0;
        for (; count < node->count && count < 128; ++count) candidates[count] = node->key[count]->text;
        pls_scene_hint(hint, sizeof hint, part, "keys here", candidates, count);
    }
    return pls_source_fail(o->source, 1, 1, hint, message, part);
}

/// "[3]" or "[top]": the entry.
static pls_status enter_list(override *o, pls_node *list, pls_node ***slot)
{
    const char *close = memchr(o->at, ']', (size_t)(o->end - o->at));
    if (!close) return fail_path(o, "'[' without ']' in the path", "", NULL);
    const char *name;
    PLS_TRY(pls_arena_print(&o->scene->arena, &name, "%.*s", (int)(close - o->at - 1), o->at + 1));
    o->at = close + 1;
    if (list->kind != PLS_NODE_LIST) return fail_path(o, "[%s] does not fit: this is not a list", name, NULL);
    size_t size = strlen(name), index;
    if (size > 0 && size < 10 && strspn(name, "0123456789") == size)
        index = (size_t)strtoul(name, NULL, 10);
    else
    {
        for (index = 0; index < list->count; ++index)
        {
            const pls_node *own = pls_node_get(list->child[index], "name");
            if (own && own->kind == PLS_NODE_SCALAR && strcmp(own->text, name) == 0) break;
        }
    }
    if (index >= list->count)
        return pls_source_fail(o->source, 1, 1, NULL, "there is no entry [%s]: the list has %zu, numbered from 0", name, list->count);
    *slot = &list->child[index];
    return PLS_OK;
}

static pls_status enter_map(override *o, pls_node *map, bool own_names, pls_node ***slot)
{
    size_t size = strcspn(o->at, ".[=");
    const char *name;
    PLS_TRY(pls_arena_print(&o->scene->arena, &name, "%.*s", (int)size, o->at));
    o->at += size;
    if (size == 0) return fail_path(o, "a path is written as key.key[0].key, then = and the value", "", NULL);
    if (map->kind == PLS_NODE_SCALAR && pls_node_is_null(map)) map->kind = PLS_NODE_MAP;
    if (map->kind != PLS_NODE_MAP) return fail_path(o, "'%s' does not fit: this is not a map", name, NULL);
    for (size_t k = 0; k < map->count; ++k)
    {
        if (strcmp(map->key[k]->text, name) != 0) continue;
        *slot = &map->child[k];
        return PLS_OK;
    }
    if (own_names) return fail_path(o, "there is no '%s' to override", name, map);
    pls_node place = {.source = o->source, .line = 1, .column = 1}, *key, *value;
    PLS_TRY(pls_node_new(&o->scene->arena, PLS_NODE_SCALAR, &place, &key));
    PLS_TRY(pls_node_new(&o->scene->arena, PLS_NODE_SCALAR, &place, &value));
    key->text = name;
    PLS_TRY(pls_node_append(&o->scene->arena, map, key, value));
    *slot = &map->child[map->count - 1];
    return PLS_OK;
}

static pls_status walk_path(override *o, pls_node ***slot)
{
    pls_node *node = o->scene->root;
    bool own_names = false, top = true;
    while (o->at < o->end)
    {
        bool list = *o->at == '[';
        if (*o->at == '.') ++o->at;
        const char *part = o->at;
        PLS_TRY(list ? enter_list(o, node, slot) : enter_map(o, node, own_names, slot));
        size_t size = (size_t)(o->at - part);
        own_names = top && ((size == 4 && !strncmp(part, "vars", 4)) || (size == 9 && !strncmp(part, "materials", 9)) ||
                            (size == 6 && !strncmp(part, "shapes", 6)));
        top = false;
        node = **slot;
    }
    return PLS_OK;
}

pls_status pls_scene_override(pls_scene *scene, const char *text)
{
    const char *equals = strchr(text, '=');
    pls_source *source;
    PLS_TRY(pls_arena_allocate(&scene->arena, &source, 1, sizeof *source, "an override"));
    PLS_TRY(pls_arena_print(&scene->arena, &source->name, "--set %s", text));
    if (!equals || equals == text)
        return pls_source_fail(source, 1, 1, "for example  --set time.end=2", "an override is written as path=value");
    PLS_TRY(pls_arena_copy_text(&scene->arena, &source->text, equals + 1));
    source->size = strlen(source->text);

    override o = {.scene = scene, .source = source, .at = text, .end = equals};
    pls_node **slot = &scene->root, *value;
    PLS_TRY(pls_yaml_read(&scene->arena, source, &value));
    PLS_TRY(walk_path(&o, &slot));
    *slot = value;
    return PLS_OK;
}
