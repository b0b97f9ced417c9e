// plugin.c -- shapes, laws, bonds, forces and observers by name: the built-in ones, then those of the scene's shared objects, all through the same door.
//
// What comes through the door is looked at before anything is built from it, so that a plugin that is no good is refused where the scene names it.
// A plugin stays loaded as long as its scene: the world uses its functions, so the world must be destroyed before the scene is freed.

#include "scene/scene_data.h"

#include "bond/builtin.h"
#include "observe/series.h"
#include "scene/schema.h"

#include <dlfcn.h>
#include <string.h>

/// What a plugin's function gets: the public host first, so that the pointer to it is one to this.
typedef struct host
{
    pls_plugin_host host;
    pls_scene *scene;
} host;

// ---------------------------------------------------------------------------------------------------------------------------------------
// is it any good?

/// Whether the name is a key of one of the sections "a|b", where it would be taken for that.
static bool is_key(const char *sections, const char *name)
{
    char section[64];
    for (size_t k = 0; sections && pls_schema_word(sections, k, section); ++k)
    {
        size_t count;
        const pls_key *keys = pls_schema_keys(section, &count);
        for (size_t j = 0; j < count; ++j)
        {
            if (strcmp(keys[j].name, name) == 0) return true;
        }
    }
    return false;
}

static bool is_between(const pls_parameter *p, double value)
{
    return (p->open_minimum ? value > p->minimum : value >= p->minimum) && value <= p->maximum;
}

/// One row of a table of parameters; `beside`: sections whose keys stand in the same map.
static pls_status check_parameter(const pls_parameter *table, const pls_parameter *p, const char *what, const char *name,
                                  const char *beside)
{
    if (!pls_expression_is_name(p->name) || strlen(p->name) >= PLS_NAME_SIZE)
        return pls_fail(PLS_PLUGIN,
                        "the %s '%s' has a parameter '%.80s'; names are letters, digits and '_', beginning with a letter, at most 63", what,
                        name, p->name);
    if (is_key(beside, p->name))
        return pls_fail(PLS_PLUGIN, "the %s '%s' has a parameter '%s', which is a key of scenes there: use another name", what, name,
                        p->name);
    for (const pls_parameter *before = table; before < p; ++before)
    {
        if (strcmp(before->name, p->name) == 0) return pls_fail(PLS_PLUGIN, "the %s '%s' has two parameters '%s'", what, name, p->name);
    }
    if (p->kind != PLS_PARAMETER_NUMBER) return PLS_OK;
    if (p->components != 0 && p->components != 1 && p->components != 3)
        return pls_fail(PLS_PLUGIN, "the parameter '%s' of the %s '%s' has %d components; a number has one, a vector three", p->name, what,
                        name, p->components);
    if (!(p->minimum <= p->maximum) || (!isnan(p->initial) && !is_between(p, p->initial)))
        return pls_fail(PLS_PLUGIN, "the parameter '%s' of the %s '%s' has the default %g, but values from %g to %g", p->name, what, name,
                        p->initial, p->minimum, p->maximum);
    return PLS_OK;
}

/// What all operations have in common.
static pls_status check_ops(uint32_t version, const char *name, const pls_parameter *parameters, const char *what, const char *beside)
{
    if (version != PLS_API_VERSION)
        return pls_fail(PLS_VERSION, "the %s '%s' is made for version %u of the plugin interface; this is version %d: compile it anew",
                        what, name ? name : "?", version, PLS_API_VERSION);
    if (!name || !*name || strlen(name) >= PLS_NAME_SIZE)
        return pls_fail(PLS_PLUGIN, "a %s has no name, or one of more than 63 characters", what);
    if (!pls_expression_is_name(name))
        return pls_fail(PLS_PLUGIN, "'%s' cannot be the name of a %s: letters, digits and '_', beginning with a letter", name, what);
    int rows = 0;
    for (const pls_parameter *p = parameters; p && p->name; ++p) ++rows;
    if (rows > PLS_MAX_PARAMETERS || pls_parameter_values(parameters) > PLS_MAX_VALUES)
        return pls_fail(PLS_PLUGIN, "the %s '%s' has %d parameters; at most %d are possible", what, name, rows, PLS_MAX_PARAMETERS);
    for (const pls_parameter *p = parameters; p && p->name; ++p) PLS_TRY(check_parameter(parameters, p, what, name, beside));
    return PLS_OK;
}

/// Forces and observers have numbers only, and names that no built-in force or observer and no key beside them has.
static pls_status check_entry(const char *what, const char *name, const pls_parameter *parameters, const char *list)
{
    size_t count;
    const pls_key *key = pls_schema_keys("scene", &count);
    while (strcmp(key->name, list) != 0) ++key;
    if (is_key(key->sub, name)) return pls_fail(PLS_DUPLICATE, "'%s' is a key of '%s' already: give the %s another name", name, list, what);
    for (const pls_parameter *p = parameters; p && p->name; ++p)
    {
        if (p->kind != PLS_PARAMETER_NUMBER)
            return pls_fail(PLS_PLUGIN, "the parameter '%s' of the %s '%s' is no number; only shapes take others", p->name, what, name);
    }
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// the five doors

static pls_status add_law(pls_plugin_host *door, const pls_law_ops *ops)
{
    pls_scene *scene = ((host *)door)->scene;
    if (!ops) return pls_fail(PLS_PLUGIN, "add_law was called with null");
    PLS_TRY(check_ops(ops->api_version, ops->name, ops->parameters, "contact law", "contact"));
    if (!ops->prepare || !ops->evaluate || !ops->stiffness || !ops->energy)
        return pls_fail(PLS_PLUGIN, "the contact law '%s' lacks one of prepare, evaluate, stiffness, energy", ops->name);
    if (ops->history < 0 || ops->history > PLS_LAW_MAX_HISTORY)
        return pls_fail(PLS_PLUGIN, "the contact law '%s' wants %d numbers per contact; at most %d are possible", ops->name, ops->history,
                        PLS_LAW_MAX_HISTORY);
    return pls_registry_add(&scene->law_ops, ops->name, ops);
}

static pls_status add_shape(pls_plugin_host *door, const pls_shape_ops *ops)
{
    pls_scene *scene = ((host *)door)->scene;
    if (!ops) return pls_fail(PLS_PLUGIN, "add_shape was called with null");
    PLS_TRY(check_ops(ops->api_version, ops->name, ops->parameters, "shape", NULL));
    if (!ops->sdf) return pls_fail(PLS_PLUGIN, "the shape '%s' lacks its sdf", ops->name);
    if (!ops->in_2d && !ops->in_3d) return pls_fail(PLS_PLUGIN, "the shape '%s' is for neither in_2d nor in_3d", ops->name);
    return pls_registry_add(&scene->shape_ops, ops->name, ops);
}

static pls_status add_force(pls_plugin_host *door, const pls_force_ops *ops)
{
    pls_scene *scene = ((host *)door)->scene;
    if (!ops) return pls_fail(PLS_PLUGIN, "add_force was called with null");
    PLS_TRY(check_ops(ops->api_version, ops->name, ops->parameters, "force", "plugin"));
    if (!ops->evaluate) return pls_fail(PLS_PLUGIN, "the force '%s' lacks its evaluate", ops->name);
    PLS_TRY(check_entry("force", ops->name, ops->parameters, "forces"));
    return pls_registry_add(&scene->force_ops, ops->name, ops);
}

static pls_status add_observer(pls_plugin_host *door, const pls_observer_ops *ops)
{
    pls_scene *scene = ((host *)door)->scene;
    if (!ops) return pls_fail(PLS_PLUGIN, "add_observer was called with null");
    PLS_TRY(check_ops(ops->api_version, ops->name, ops->parameters, "observer", "plugin"));
    PLS_TRY(pls_observer_ops_check(ops));
    PLS_TRY(check_entry("observer", ops->name, ops->parameters, "observe"));
    return pls_registry_add(&scene->observer_ops, ops->name, ops);
}

static pls_status add_bond(pls_plugin_host *door, const pls_bond_ops *ops)
{
    pls_scene *scene = ((host *)door)->scene;
    if (!ops) return pls_fail(PLS_PLUGIN, "add_bond was called with null");
    PLS_TRY(check_ops(ops->api_version, ops->name, ops->parameters, "bond law", "bond"));
    PLS_TRY(pls_bond_ops_check(ops));
    return pls_registry_add(&scene->bond_ops, ops->name, ops);
}

static host open_door(pls_scene *scene)
{
    return (host){{.api_version = PLS_API_VERSION,
                   .add_law = add_law,
                   .add_shape = add_shape,
                   .add_force = add_force,
                   .add_observer = add_observer,
                   .add_bond = add_bond},
                  scene};
}

pls_status pls_scene_load_builtins(pls_scene *scene)
{
    scene->shape_ops.what = "shape";
    scene->law_ops.what = "contact law";
    scene->bond_ops.what = "bond law";
    scene->force_ops.what = "force";
    scene->observer_ops.what = "observer";
    host door = open_door(scene);
    for (const pls_shape_ops *const *ops = pls_builtin_shapes(); *ops; ++ops) PLS_TRY(add_shape(&door.host, *ops));
    for (const pls_law_ops *const *ops = pls_builtin_laws(); *ops; ++ops) PLS_TRY(add_law(&door.host, *ops));
    for (const pls_bond_ops *const *ops = pls_builtin_bonds(); *ops; ++ops) PLS_TRY(add_bond(&door.host, *ops));
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// shared objects

pls_status pls_scene_load_plugin(pls_scene *scene, const pls_node *path)
{
    PLS_TRY(pls_reserve(&scene->plugins, &scene->plugin_capacity, scene->plugin_count + 1, sizeof *scene->plugins, "the list of plugins"));
    void *handle = dlopen(path->text, RTLD_NOW | RTLD_LOCAL);
    if (!handle)
        return pls_node_fail(path, "a plugin is a shared object, see docs/extending.md", "the plugin cannot be loaded: %s", dlerror());
    scene->plugins[scene->plugin_count++] = handle;

    const uint32_t *version = dlsym(handle, PLS_PLUGIN_API);
    if (!version)
        return pls_node_fail(path, "see docs/extending.md", "'%s' is no plugin: it does not export '%s'", path->text, PLS_PLUGIN_API);
    if (*version != PLS_API_VERSION)
        return pls_node_fail(path, "compile the plugin anew", "'%s' is made for version %u of the plugin interface; this is version %d",
                             path->text, *version, PLS_API_VERSION);
    pls_plugin_function *start = NULL;
    void *symbol = dlsym(handle, PLS_PLUGIN_FUNCTION);
    if (!symbol)
        return pls_node_fail(path, "see docs/extending.md", "'%s' is no plugin: it does not export '%s'", path->text, PLS_PLUGIN_FUNCTION);
    memcpy(&start, &symbol, sizeof start); // ISO C has no cast from object to function pointer
    host door = open_door(scene);
    pls_status status = start(&door.host);
    if (status != PLS_OK) return pls_node_fail(path, NULL, "the plugin '%s': %s", path->text, pls_last_message());
    return PLS_OK;
}

void pls_scene_unload_plugins(pls_scene *scene)
{
    while (scene->plugin_count > 0) dlclose(scene->plugins[--scene->plugin_count]);
    pls_release(&scene->plugins);
    scene->plugin_capacity = 0;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// finding what they brought

const pls_registry *pls_scene_operations_of(const pls_scene *scene, const char *section)
{
    if (strcmp(section, "force_plugin") == 0) return &scene->force_ops;
    if (strcmp(section, "observe_plugin") == 0) return &scene->observer_ops;
    return NULL;
}

const void *pls_scene_named_operations(const pls_registry *operations, const pls_node *entry, const pls_node **map)
{
    for (size_t k = 0; k < operations->count; ++k)
    {
        *map = pls_node_get(entry, operations->entry[k].name);
        if (*map) return operations->entry[k].ops;
    }
    return NULL;
}
