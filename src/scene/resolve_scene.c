// resolve_scene.c -- the order in which a scene is resolved, and the maps whose keys depend on their contents: vars, shapes, contact laws,
// forces and observers of plugins, states.
//
// The version, the dimension, vars, plugins and the names of states come first, because everything else is read with them.

#include "scene/resolve.h"
#include "scene/scene_data.h"

#include <stdio.h>
#include <string.h>

pls_status pls_scene_symbols(const pls_scene *scene, unsigned uses, const char *own, const char **names, pls_symbols *symbols)
{
    size_t count = 0;
    if (uses & PLS_USES_TIME) names[count++] = "t";
    if (uses & PLS_USES_PLACE) names[count++] = "x", names[count++] = "y", names[count++] = "z";
    if (uses & PLS_USES_VELOCITY) names[count++] = "vx", names[count++] = "vy", names[count++] = "vz";
    if (uses & PLS_USES_RADIUS) names[count++] = "r";
    if (uses & PLS_USES_MASS) names[count++] = "m";
    if (uses & PLS_USES_OWN) names[count++] = "s";
    if (uses & PLS_USES_OWN && own) names[count++] = own;
    if (uses & PLS_USES_CHANCE) names[count++] = "chance";
    if (uses & PLS_USES_TEMPERATURE) names[count++] = "temperature";
    for (size_t k = 0; uses & PLS_USES_STATES && k < scene->state_count; ++k)
    {
        if (!scene->state_names[k]) continue;
        if (count == PLS_EXPRESSION_VARIABLES)
            return pls_fail(PLS_LIMIT_EXCEEDED, "%s: more than %d states that expressions can name", scene->source.name,
                            PLS_EXPRESSION_VARIABLES - 12);
        names[count++] = scene->state_names[k];
    }
    *symbols = (pls_symbols){names, count, scene->vars, scene->var_count};
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// what comes first

static const pls_key *find_key(const char *section, const char *name)
{
    size_t count;
    const pls_key *keys = pls_schema_keys(section, &count);
    while (strcmp(keys->name, name) != 0) ++keys;
    return keys;
}

static pls_status resolve_head(pls_resolver *r, pls_node *root)
{
    if (root->kind != PLS_NODE_MAP)
        return pls_node_fail(root, "a scene begins with  particls: 1", "a scene must be a map (key: value), not %s",
                             pls_node_describe(root));
    pls_node *version = pls_node_get(root, "particls");
    for (size_t k = 0; !version && k < root->count; ++k)
    {
        static const char *const wanted[] = {"particls"};
        if (pls_nearest_word(root->key[k]->text, wanted, 1))
            return pls_node_fail(root->key[k], "did you mean 'particls'?", "unknown key '%.80s' in the scene", root->key[k]->text);
    }
    if (!version)
        return pls_node_fail(root, "a scene begins with  particls: 1",
                             "missing key 'particls' in the scene: the version of the scene language");
    if (version->kind != PLS_NODE_SCALAR || strcmp(version->text, "1") != 0)
        return pls_node_fail(version, "write  particls: 1", "this program reads version 1 of the scene language, not %s",
                             version->kind == PLS_NODE_SCALAR ? version->text : pls_node_describe(version));
    r->scene->dimension = 3;
    pls_node *dimension = pls_node_get(root, "dimension");
    if (!dimension) return PLS_OK;
    PLS_TRY(pls_resolve_key(r, find_key("scene", "dimension"), dimension, "the scene"));
    r->scene->dimension = (int)dimension->number;
    return PLS_OK;
}

static pls_status resolve_vars(pls_resolver *r, pls_node *vars)
{
    if (!vars || pls_node_is_null(vars)) return PLS_OK;
    if (vars->kind != PLS_NODE_MAP)
        return pls_node_fail(vars, "for example  vars: {kn: 20, ks: \"kn/2\"}", "'vars' must be a map of names, not %s",
                             pls_node_describe(vars));
    pls_scene *scene = r->scene;
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->vars, vars->count, sizeof *scene->vars, "the scene's vars"));
    for (size_t k = 0; k < vars->count; ++k)
    {
        const pls_node *name = vars->key[k];
        if (!pls_expression_is_name(name->text) || strlen(name->text) >= PLS_NAME_SIZE)
            return pls_node_fail(name, "letters, digits and '_', beginning with a letter; at most 63 characters",
                                 "'%.80s' cannot be the name of a variable", name->text);
        if (pls_expression_reserved(name->text))
            return pls_node_fail(name, "choose another name", "'%s' has a meaning of its own in expressions and cannot be a variable",
                                 name->text);
        pls_key key = {.section = "vars",
                       .name = name->text,
                       .type = PLS_KEY_NUMBER,
                       .unit = "",
                       .minimum = -INFINITY,
                       .maximum = INFINITY,
                       .meaning = "a number or an expression over earlier vars"};
        PLS_TRY(pls_resolve_key(r, &key, vars->child[k], "'vars'"));
        scene->vars[scene->var_count++] = (pls_constant){name->text, vars->child[k]->number};
    }
    return PLS_OK;
}

static pls_status resolve_plugins(pls_resolver *r, pls_node *plugins)
{
    if (!plugins) return PLS_OK;
    PLS_TRY(pls_resolve_paths(r, find_key("scene", "plugins"), plugins, "the scene"));
    for (size_t k = 0; k < plugins->count; ++k) PLS_TRY(pls_scene_load_plugin(r->scene, plugins->child[k]));
    return PLS_OK;
}

/// Name of a states entry as written, or made from `of` for the short form. Null when it has none or is no text: resolving complains later.
static pls_status state_name(pls_resolver *r, const pls_node *entry, const pls_node **at, const char **name)
{
    const pls_node *given = pls_node_get(entry, "name"), *of = pls_node_get(entry, "of");
    *name = NULL;
    *at = given;
    if (given && given->kind == PLS_NODE_SCALAR) *name = given->text;
    if (given || !pls_node_get(entry, "radius") || !of || of->kind != PLS_NODE_SCALAR) return PLS_OK;
    *at = of;
    // "pack[12]" gives pack_12_radius; what cannot stand in a name becomes an underscore.
    char *made;
    size_t used = 0;
    PLS_TRY(pls_arena_allocate(&r->scene->arena, &made, strlen(of->text) + sizeof "_radius", 1, "the name of a state"));
    for (const char *c = of->text; *c; ++c)
    {
        if (*c != ']') made[used++] = (char)(*c == '[' || *c == '-' || *c == '.' ? '_' : *c);
    }
    memcpy(made + used, "_radius", sizeof "_radius");
    *name = made;
    return PLS_OK;
}

static pls_status check_state_name(const pls_scene *scene, const pls_node *at, const char *name)
{
    if (!pls_expression_is_name(name) || strlen(name) >= PLS_NAME_SIZE - 11)
        return pls_node_fail(at, "letters, digits and '_', beginning with a letter; at most 52 characters",
                             "'%.80s' cannot be the name of a state", name);
    if (pls_expression_reserved(name))
        return pls_node_fail(at, "choose another name", "'%s' has a meaning of its own in expressions and cannot be a state", name);
    for (size_t k = 0; k < scene->var_count; ++k)
    {
        if (strcmp(scene->vars[k].name, name) == 0)
            return pls_node_fail(at, "choose another name", "there is a variable '%s' in 'vars' already", name);
    }
    for (size_t k = 0; k < scene->state_count; ++k)
    {
        if (scene->state_names[k] && strcmp(scene->state_names[k], name) == 0)
            return pls_node_fail(at, "give one of them another name", "there is a state '%s' already", name);
    }
    return PLS_OK;
}

static pls_status collect_state_names(pls_resolver *r, const pls_node *states)
{
    if (!states || states->kind != PLS_NODE_LIST) return PLS_OK;
    pls_scene *scene = r->scene;
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->state_names, states->count, sizeof *scene->state_names, "names of states"));
    for (size_t k = 0; k < states->count; ++k)
    {
        const pls_node *at, *each = pls_node_get(states->child[k], "each");
        const char *name;
        PLS_TRY(state_name(r, states->child[k], &at, &name));
        if (name) PLS_TRY(check_state_name(scene, at, name));
        bool all = each && each->kind == PLS_NODE_SCALAR && strcmp(each->text, "true") == 0;
        scene->state_names[scene->state_count++] = all ? NULL : name;
    }
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// maps whose keys depend on their contents

static pls_status parameter_keys(pls_resolver *r, const pls_parameter *table, pls_table_owner owner, pls_key *keys, size_t *count)
{
    for (; table && table->name && *count < PLS_MAX_KEYS; ++table)
    {
        char *initial;
        PLS_TRY(pls_arena_allocate(&r->scene->arena, &initial, 32, 1, "a default"));
        keys[(*count)++] = pls_schema_parameter_of(owner, table, initial);
    }
    return PLS_OK;
}

/// The entry of a registry for a name in the scene.
static pls_status find_ops(const pls_registry *registry, const pls_node *name, const void **ops)
{
    *ops = pls_registry_find(registry, name->text);
    if (*ops) return PLS_OK;
    const char *candidates[256];
    size_t count = 0;
    for (; count < registry->count && count < 256; ++count) candidates[count] = registry->entry[count].name;
    char hint[600];
    pls_scene_hint(hint, sizeof hint, name->text, "there are", candidates, count);
    return pls_node_fail(name, hint, "unknown %s '%.80s'", registry->what, name->text);
}

static pls_status wrong_dimension(const pls_resolver *r, const pls_node *name, const char *label)
{
    const int dimension = r->scene->dimension;
    const pls_registry *all = &r->scene->shape_ops;
    const char *candidates[256];
    char hint[600], what[32];
    size_t count = 0;
    for (size_t k = 0; k < all->count && count < 256; ++k)
    {
        const pls_shape_ops *ops = all->entry[k].ops;
        if (dimension == 2 ? ops->in_2d : ops->in_3d) candidates[count++] = ops->name;
    }
    snprintf(what, sizeof what, "in %dD there are", dimension);
    pls_scene_hint(hint, sizeof hint, "", what, candidates, count);
    return pls_node_fail(name, hint, "%s: a %s cannot be used in %dD", label, name->text, dimension);
}

/// The kind of a shape comes first, what stands beside it after. Fails unless there is one kind.
static pls_status split_shape(pls_resolver *r, pls_node *node, const char *label)
{
    pls_node sorted = *node;
    size_t kinds = 0, count;
    const pls_key *beside = pls_schema_keys("any_shape", &count);
    sorted.count = 0;
    for (int late = 0; late < 2; ++late)
        for (size_t k = 0; node->kind == PLS_NODE_MAP && k < node->count; ++k)
        {
            bool known = false;
            for (size_t j = 0; j < count; ++j) known = known || strcmp(node->key[k]->text, beside[j].name) == 0;
            kinds += !known && !late;
            if (known == late) PLS_TRY(pls_node_append(&r->scene->arena, &sorted, node->key[k], node->child[k]));
        }
    if (kinds != 1)
        return pls_node_fail(node, "for example  {sphere: {radius: 0.1}}",
                             "%s must be a map with one kind of shape, and beside it at most 'density_factor'", label);
    for (size_t j = 0; j < count; ++j)
    {
        pls_node *value = pls_node_get(&sorted, beside[j].name);
        if (value) PLS_TRY(pls_resolve_key(r, &beside[j], value, label));
    }
    *node = sorted;
    return PLS_OK;
}

static pls_status resolve_shape(pls_resolver *r, const pls_node *name, pls_node *node)
{
    const char *label;
    PLS_TRY(pls_resolve_name(name, "shape"));
    PLS_TRY(pls_arena_print(&r->scene->arena, &label, "shape '%s'", name->text));
    PLS_TRY(split_shape(r, node, label));
    const void *found;
    PLS_TRY(find_ops(&r->scene->shape_ops, node->key[0], &found));
    const pls_shape_ops *ops = found;
    if (r->scene->dimension == 2 ? !ops->in_2d : !ops->in_3d) return wrong_dimension(r, node->key[0], label);
    pls_key keys[PLS_MAX_KEYS];
    size_t count = 0;
    PLS_TRY(parameter_keys(r, ops->parameters, PLS_OF_SHAPE, keys, &count));
    return pls_resolve_map(r, node->child[0], keys, count, label);
}

pls_status pls_resolve_shapes(pls_resolver *r, const pls_key *key, pls_node *map, const char *label)
{
    if (map->kind != PLS_NODE_MAP || map->count == 0)
        return pls_node_fail(map, "for example  shapes: {ball: {sphere: {radius: 0.1}}}", "'%s' in %s must be a map of names", key->name,
                             label);
    for (size_t k = 0; k < map->count; ++k) PLS_TRY(resolve_shape(r, map->key[k], map->child[k]));
    return PLS_OK;
}

/// An entry whose key `law` names operations of a registry: the rows of the section and the parameters of the law.
typedef struct law_section
{
    const char *section;
    const pls_registry *laws;
    const pls_parameter *(*parameters)(const void *ops);
    const char *(*left_out)(const void *ops); ///< rows of the section that the law has no use for, "a|b|c"; may be null
    pls_table_owner owner;
} law_section;

static pls_status resolve_with_law(pls_resolver *r, const law_section *how, pls_node *entry, const char *label)
{
    size_t fixed;
    const pls_key *rows = pls_schema_keys(how->section, &fixed);
    pls_key keys[PLS_MAX_KEYS];
    const pls_node *law = pls_node_get(entry, "law");
    const char *inner = label;
    const void *ops = NULL;
    size_t count = 0;
    if (law && law->kind == PLS_NODE_SCALAR) PLS_TRY(find_ops(how->laws, law, &ops));
    if (!law && entry->kind == PLS_NODE_MAP)
    {
        char hint[64];
        snprintf(hint, sizeof hint, "law: name of a %s", how->laws->what);
        return pls_node_fail(entry, hint, "missing key 'law' in %s", label);
    }
    const char *without = ops && how->left_out ? how->left_out(ops) : NULL;
    for (size_t k = 0; k < fixed; ++k)
        if (!pls_schema_has_word(without, rows[k].name)) keys[count++] = rows[k];
    if (!ops) return pls_resolve_map(r, entry, keys, count, label);
    PLS_TRY(parameter_keys(r, how->parameters(ops), how->owner, keys, &count));
    PLS_TRY(pls_arena_print(&r->scene->arena, &inner, "%s (law %s)", label, law->text));
    return pls_resolve_map(r, entry, keys, count, inner);
}

static const pls_parameter *contact_parameters(const void *ops) { return ((const pls_law_ops *)ops)->parameters; }

pls_status pls_resolve_contact(pls_resolver *r, pls_node *entry, const char *label)
{
    const law_section how = {.section = "contact", .laws = &r->scene->law_ops, .parameters = contact_parameters, .owner = PLS_OF_LAW};
    return resolve_with_law(r, &how, entry, label);
}

static const pls_parameter *bond_parameters(const void *ops) { return ((const pls_bond_ops *)ops)->parameters; }

/// Bonds that know nothing of each other weigh nothing.
static const char *no_families(const void *ops)
{
    return ((const pls_bond_ops *)ops)->pair ? "influence|spacing|correction|plane|fracture_energy|criterion|stiffness|heat" : NULL;
}

pls_status pls_resolve_bond(pls_resolver *r, pls_node *entry, const char *label)
{
    const law_section how = {
        .section = "bond", .laws = &r->scene->bond_ops, .parameters = bond_parameters, .left_out = no_families, .owner = PLS_OF_BOND};
    return resolve_with_law(r, &how, entry, label);
}

/// An entry that names operations of a plugin: first the map of its numbers, then the entry itself, whose row NAME stands for that map.
static pls_status resolve_of_plugin(pls_resolver *r, const char *section, const char *name, const char *meaning, const pls_parameter *table,
                                    pls_table_owner owner, pls_node *entry, const char *label)
{
    pls_key keys[PLS_MAX_KEYS];
    size_t count;
    const char *inner;
    const pls_key *rows = pls_schema_keys(section, &count); // the first is NAME
    size_t beside;
    const pls_key *shared = pls_schema_keys(rows->sub, &beside);
    memcpy(keys, shared, beside * sizeof *keys);
    PLS_TRY(parameter_keys(r, table, owner, keys, &beside));
    PLS_TRY(pls_arena_print(&r->scene->arena, &inner, "'%s' of %s", name, label));
    PLS_TRY(pls_resolve_map(r, pls_node_get(entry, name), keys, beside, inner));

    memcpy(keys, rows, count * sizeof *keys);
    keys->name = name;
    keys->meaning = meaning ? meaning : "";
    return pls_resolve_map(r, entry, keys, count, label);
}

pls_status pls_resolve_force_of_plugin(pls_resolver *r, pls_node *entry, const char *label)
{
    const pls_node *map;
    const pls_force_ops *ops = pls_scene_named_operations(&r->scene->force_ops, entry, &map);
    return resolve_of_plugin(r, "force_plugin", ops->name, ops->meaning, ops->parameters, PLS_OF_FORCE, entry, label);
}

pls_status pls_resolve_observer_of_plugin(pls_resolver *r, pls_node *entry, const char *label)
{
    const pls_node *map;
    const pls_observer_ops *ops = pls_scene_named_operations(&r->scene->observer_ops, entry, &map);
    return resolve_of_plugin(r, "observe_plugin", ops->name, ops->meaning, ops->parameters, PLS_OF_OBSERVER, entry, label);
}

pls_status pls_resolve_state(pls_resolver *r, pls_node *entry, const char *label)
{
    const pls_node *each = pls_node_get(entry, "each"), *at;
    r->own_name = NULL;
    bool all = each && each->kind == PLS_NODE_SCALAR && strcmp(each->text, "true") == 0;
    if (all) PLS_TRY(state_name(r, entry, &at, &r->own_name));
    size_t count;
    const pls_key *keys = pls_schema_keys("state", &count);
    pls_status status = pls_resolve_map(r, entry, keys, count, label);
    r->own_name = NULL;
    return status;
}

pls_status pls_scene_resolve(pls_scene *scene)
{
    pls_resolver r = {.scene = scene};
    pls_node *root = scene->root;
    PLS_TRY(resolve_head(&r, root));
    PLS_TRY(resolve_vars(&r, pls_node_get(root, "vars")));
    PLS_TRY(resolve_plugins(&r, pls_node_get(root, "plugins")));
    PLS_TRY(collect_state_names(&r, pls_node_get(root, "states")));
    size_t count;
    const pls_key *keys = pls_schema_keys("scene", &count);
    PLS_TRY(pls_resolve_map(&r, root, keys, count, "the scene"));
    if (scene->dimension == 2) scene->thickness = pls_node_get(root, "thickness")->number;
    return PLS_OK;
}
