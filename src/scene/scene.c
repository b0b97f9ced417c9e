// scene.c -- from a file to a scene: read, override, resolve, look names up, hash.

#include "base/hash.h"
#include "scene/scene_data.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Absolute path of the folder that paths in the scene are relative to.
static pls_status find_folder(pls_scene *scene, const char *path)
{
    char *real = realpath(path, NULL);
    if (!real) return pls_fail(PLS_NOT_FOUND, "%s: there is no such scene file", path);
    char *slash = strrchr(real, '/');
    if (slash) *slash = '\0';
    pls_status status = pls_arena_copy_text(&scene->arena, &scene->folder, real);
    free(real);
    return status;
}

static pls_status hash_scene(pls_scene *scene)
{
    pls_text text = {0};
    pls_status status = pls_scene_print(scene, true, &text);
    if (status == PLS_OK) scene->hash = pls_hash(PLS_HASH_START, text.data, text.size);
    pls_text_free(&text);
    return status;
}

static pls_status load_scene(pls_scene *scene, const char *path, const char *const *overrides, size_t override_count)
{
    scene->thickness = 1.0;
    PLS_TRY(pls_source_read(&scene->arena, path, &scene->source));
    PLS_TRY(find_folder(scene, path));
    PLS_TRY(pls_scene_load_builtins(scene));
    PLS_TRY(pls_yaml_read(&scene->arena, &scene->source, &scene->root));
    for (size_t k = 0; k < override_count; ++k) PLS_TRY(pls_scene_override(scene, overrides[k]));
    PLS_TRY(pls_scene_resolve(scene));
    PLS_TRY(pls_scene_parse_materials(scene));
    PLS_TRY(pls_scene_parse_shapes(scene));
    PLS_TRY(pls_scene_parse_domain(scene));
    PLS_TRY(pls_scene_parse_bodies(scene));
    PLS_TRY(pls_scene_parse_contacts(scene));
    PLS_TRY(pls_scene_parse_bonds(scene));
    PLS_TRY(pls_scene_parse_forces(scene));
    PLS_TRY(pls_scene_parse_states(scene));
    PLS_TRY(pls_scene_parse_observers(scene));
    scene->end = pls_scene_number(pls_node_get(scene->root, "time"), "end", 0.0);
    return hash_scene(scene);
}

pls_status pls_scene_load(const char *path, const char *const *overrides, size_t override_count, pls_scene **scene)
{
    *scene = NULL;
    pls_scene *made;
    PLS_TRY(pls_allocate(&made, 1, sizeof *made, "a scene"));
    pls_status status = load_scene(made, path, overrides, override_count);
    if (status == PLS_OK)
        *scene = made;
    else
        pls_scene_free(made);
    return status;
}

void pls_scene_free(pls_scene *scene)
{
    if (!scene) return;
    for (size_t k = 0; k < scene->shape_count; ++k) pls_shape_free(scene->shapes[k].made);
    pls_scene_unload_plugins(scene);
    pls_registry_free(&scene->shape_ops);
    pls_registry_free(&scene->law_ops);
    pls_registry_free(&scene->bond_ops);
    pls_registry_free(&scene->force_ops);
    pls_registry_free(&scene->observer_ops);
    pls_release(&scene->inputs);
    pls_arena_clear(&scene->arena);
    pls_release(&scene);
}

const pls_observer_def *pls_scene_observers(const pls_scene *scene, size_t *count)
{
    *count = scene->observer_count;
    return scene->observers;
}

size_t pls_scene_shape_count(const pls_scene *scene) { return scene->shape_count; }

const pls_shape *pls_scene_get_shape(const pls_scene *scene, size_t k, const char **name)
{
    if (k >= scene->shape_count) return NULL;
    if (name) *name = scene->shapes[k].name;
    return scene->shapes[k].made;
}

double pls_scene_end_time(const pls_scene *scene) { return scene->end; }
const char *pls_scene_title(const pls_scene *scene) { return pls_scene_string(scene->root, "title", ""); }
const char *pls_scene_path(const pls_scene *scene) { return scene->source.name; }
uint64_t pls_scene_hash(const pls_scene *scene) { return scene->hash; }
size_t pls_scene_input_count(const pls_scene *scene) { return scene->input_count; }
const char *pls_scene_input(const pls_scene *scene, size_t k) { return k < scene->input_count ? scene->inputs[k] : NULL; }

pls_status pls_scene_add_input(pls_scene *scene, const char *path)
{
    PLS_TRY(pls_reserve(&scene->inputs, &scene->input_capacity, scene->input_count + 1, sizeof *scene->inputs, "the list of input files"));
    scene->inputs[scene->input_count++] = path;
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// reading resolved nodes

double pls_scene_number(const pls_node *map, const char *key, double fallback)
{
    const pls_node *node = pls_node_get(map, key);
    return node && node->numeric ? node->number : fallback;
}

bool pls_scene_boolean(const pls_node *map, const char *key, bool fallback)
{
    const pls_node *node = pls_node_get(map, key);
    return node ? strcmp(node->text, "true") == 0 : fallback;
}

const char *pls_scene_string(const pls_node *map, const char *key, const char *fallback)
{
    const pls_node *node = pls_node_get(map, key);
    return node ? node->text : fallback;
}

pls_vec3 pls_scene_vector(const pls_node *map, const char *key)
{
    const pls_node *node = pls_node_get(map, key);
    double value[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; node && k < node->count && k < 3; ++k) value[k] = node->child[k]->numeric ? node->child[k]->number : 0.0;
    return pls_vec(value[0], value[1], value[2]);
}

pls_vec3 pls_scene_spin(const pls_node *map, const char *key)
{
    const pls_node *node = pls_node_get(map, key);
    if (node && node->kind == PLS_NODE_SCALAR) return pls_vec(0.0, 0.0, node->numeric ? node->number : 0.0);
    return pls_scene_vector(map, key);
}

static pls_quat turn_about(pls_vec3 axis, double angle)
{
    double s = sin(angle / 2.0);
    pls_vec3 a = pls_unit(axis);
    return (pls_quat){cos(angle / 2.0), a.x * s, a.y * s, a.z * s};
}

pls_quat pls_scene_turn(const pls_scene *scene, const pls_node *map)
{
    const pls_node *turn = pls_node_get(map, "orientation");
    const pls_vec3 z = pls_vec(0.0, 0.0, 1.0);
    if (!turn || (turn->kind == PLS_NODE_SCALAR && !turn->numeric)) return pls_quat_identity();
    if (turn->kind == PLS_NODE_SCALAR) return turn_about(z, turn->number);
    if (turn->kind == PLS_NODE_MAP)
    {
        bool given = pls_node_get(turn, "axis") && scene->dimension == 3;
        return turn_about(given ? pls_scene_vector(turn, "axis") : z, pls_scene_number(turn, "angle", 0.0));
    }
    pls_quat q = {turn->child[0]->number, turn->child[1]->number, turn->child[2]->number, turn->child[3]->number};
    return pls_quat_unit(q);
}

bool pls_scene_varies(const pls_node *vector)
{
    if (!vector) return false;
    if (vector->kind == PLS_NODE_SCALAR) return vector->formula;
    for (size_t k = 0; k < vector->count; ++k)
    {
        if (vector->child[k]->formula) return true;
    }
    return false;
}

void pls_scene_hint(char *hint, size_t size, const char *word, const char *what, const char *const *candidates, size_t count)
{
    const char *nearest = *word ? pls_nearest_word(word, candidates, count) : NULL;
    size_t used = 0;
    hint[0] = '\0';
    if (nearest) used += (size_t)snprintf(hint, size, "did you mean '%s'?  ", nearest);
    used += (size_t)snprintf(hint + used, size - used, "(%s: %s", what, count ? "" : "none");
    for (size_t k = 0; k < count; ++k)
    {
        if (used + strlen(candidates[k]) + 12 > size)
        {
            used += (size_t)snprintf(hint + used, size - used, ", ...");
            break;
        }
        used += (size_t)snprintf(hint + used, size - used, "%s%s", k ? ", " : "", candidates[k]);
    }
    snprintf(hint + used, size - used, ")");
}
