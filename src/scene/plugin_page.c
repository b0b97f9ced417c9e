// plugin_page.c -- what a plugin brings, as a page like that of scenes: the tables it was loaded with, and nothing it says elsewhere.

#include "scene/scene_data.h"
#include "scene/schema.h"

#include <string.h>

static const pls_source no_source = {.name = "plugin", .has_lines = false};

static pls_status page_columns(pls_text *out, const pls_observer_ops *ops)
{
    PLS_TRY(pls_text_print(out, "| column | unit | meaning |\n|---|---|---|\n"));
    for (const pls_observer_column *column = ops->columns; column->name; ++column)
        PLS_TRY(pls_text_print(out, "| `%s` | %s | %s%s |\n", column->name, column->unit ? column->unit : "",
                               column->meaning ? column->meaning : "", column->only_3d ? "; not in 2D" : ""));
    return pls_text_print(out, "\n");
}

/// What the plugin added to the scene's registries, which held `laws`, `bonds` and `shapes` before.
static pls_status write_page(const pls_scene *scene, size_t laws, size_t bonds, size_t shapes, pls_text *out)
{
    if (scene->law_ops.count > laws)
        PLS_TRY(pls_text_print(out, "## Contact laws\n\n`contact: [{between: [a, b], law: LAW, parameters}]`\n\n"));
    for (size_t k = laws; k < scene->law_ops.count; ++k)
    {
        const pls_law_ops *ops = scene->law_ops.entry[k].ops;
        PLS_TRY(pls_page_parameters(out, ops->name, ops->meaning, ops->parameters, PLS_OF_LAW));
    }
    if (scene->bond_ops.count > bonds)
        PLS_TRY(pls_text_print(out, "## Bond laws\n\n`bonds: [{of: [ENTRY], law: LAW, horizon: ..., parameters}]`\n\n"));
    for (size_t k = bonds; k < scene->bond_ops.count; ++k)
    {
        const pls_bond_ops *ops = scene->bond_ops.entry[k].ops;
        PLS_TRY(pls_page_parameters(out, ops->name, ops->meaning, ops->parameters, PLS_OF_BOND));
    }
    if (scene->shape_ops.count > shapes) PLS_TRY(pls_text_print(out, "## Shapes\n\n`shapes: {NAME: {SHAPE: {parameters}}}`\n\n"));
    for (size_t k = shapes; k < scene->shape_ops.count; ++k)
    {
        const pls_shape_ops *ops = scene->shape_ops.entry[k].ops;
        PLS_TRY(pls_page_parameters(out, ops->name, ops->meaning, ops->parameters, PLS_OF_SHAPE));
    }
    if (scene->force_ops.count > 0) PLS_TRY(pls_text_print(out, "## Forces\n\n`forces: [{FORCE: {parameters, bodies: ENTRY}}]`\n\n"));
    for (size_t k = 0; k < scene->force_ops.count; ++k)
    {
        const pls_force_ops *ops = scene->force_ops.entry[k].ops;
        PLS_TRY(pls_page_parameters(out, ops->name, ops->meaning, ops->parameters, PLS_OF_FORCE));
    }
    if (scene->observer_ops.count > 0)
        PLS_TRY(pls_text_print(out, "## Observers\n\n`observe: [{OBSERVER: {parameters, bodies: ENTRY}, every: SECONDS}]`\n\n"));
    for (size_t k = 0; k < scene->observer_ops.count; ++k)
    {
        const pls_observer_ops *ops = scene->observer_ops.entry[k].ops;
        PLS_TRY(pls_page_parameters(out, ops->name, ops->meaning, ops->parameters, PLS_OF_OBSERVER));
        PLS_TRY(page_columns(out, ops));
    }
    return PLS_OK;
}

/// Load the plugin into a scene of its own that has nothing else.
static pls_status describe(pls_scene *scene, const char *path, pls_text *out)
{
    // dlopen looks for a name without a slash among the libraries of the system.
    pls_node node = {.kind = PLS_NODE_SCALAR, .source = &no_source, .text = path};
    if (!strchr(path, '/')) PLS_TRY(pls_arena_print(&scene->arena, &node.text, "./%s", path));
    PLS_TRY(pls_scene_load_builtins(scene));
    const size_t laws = scene->law_ops.count, bonds = scene->bond_ops.count, shapes = scene->shape_ops.count;
    PLS_TRY(pls_scene_load_plugin(scene, &node));
    PLS_TRY(pls_text_print(out, "# %s\n\nVersion %d of the plugin interface.\n\n", path, PLS_API_VERSION));
    return write_page(scene, laws, bonds, shapes, out);
}

pls_status pls_plugin_reference(const char *path, char **text)
{
    *text = NULL;
    pls_scene *scene;
    pls_text out = {0};
    PLS_TRY(pls_allocate(&scene, 1, sizeof *scene, "a scene"));
    pls_status status = describe(scene, path, &out);
    pls_scene_free(scene);
    if (status == PLS_OK)
        *text = out.data;
    else
        pls_text_free(&out);
    return status;
}
