// plugin.c -- shapes and laws by name: the built-in ones, then those of the scene's shared objects, all through the same door.
//
// A plugin stays loaded as long as its scene: the world uses its functions, so the world must be destroyed before the scene is freed.

#include "scene/scene_data.h"

#include <dlfcn.h>
#include <string.h>

/// What a plugin's function gets: the public host first, so that the pointer to it is one to this.
typedef struct host
{
    pls_plugin_host host;
    pls_scene *scene;
} host;

static pls_status check_ops(uint32_t version, const char *name, const pls_parameter *parameters, const char *what)
{
    if (version != PLS_API_VERSION)
        return pls_fail(PLS_VERSION, "the %s '%s' is made for version %u of the plugin interface; this is version %d: compile it anew",
                        what, name ? name : "?", version, PLS_API_VERSION);
    if (!name || !*name || strlen(name) >= PLS_NAME_SIZE)
        return pls_fail(PLS_PLUGIN, "a %s has no name, or one of more than 63 characters", what);
    int rows = 0;
    for (const pls_parameter *p = parameters; p && p->name; ++p) ++rows;
    if (rows > PLS_MAX_PARAMETERS || pls_parameter_values(parameters) > 3 * PLS_MAX_PARAMETERS)
        return pls_fail(PLS_PLUGIN, "the %s '%s' has %d parameters; at most %d are possible", what, name, rows, PLS_MAX_PARAMETERS);
    return PLS_OK;
}

static pls_status add_law(pls_plugin_host *door, const pls_law_ops *ops)
{
    pls_scene *scene = ((host *)door)->scene;
    if (!ops) return pls_fail(PLS_PLUGIN, "add_law was called with null");
    PLS_TRY(check_ops(ops->api_version, ops->name, ops->parameters, "contact law"));
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
    PLS_TRY(check_ops(ops->api_version, ops->name, ops->parameters, "shape"));
    if (!ops->sdf) return pls_fail(PLS_PLUGIN, "the shape '%s' lacks its sdf", ops->name);
    return pls_registry_add(&scene->shape_ops, ops->name, ops);
}

static host open_door(pls_scene *scene)
{
    return (host){{.api_version = PLS_API_VERSION, .add_law = add_law, .add_shape = add_shape}, scene};
}

pls_status pls_scene_load_builtins(pls_scene *scene)
{
    scene->shape_ops.what = "shape";
    scene->law_ops.what = "contact law";
    host door = open_door(scene);
    for (const pls_shape_ops *const *ops = pls_builtin_shapes(); *ops; ++ops) PLS_TRY(add_shape(&door.host, *ops));
    for (const pls_law_ops *const *ops = pls_builtin_laws(); *ops; ++ops) PLS_TRY(add_law(&door.host, *ops));
    return PLS_OK;
}

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
