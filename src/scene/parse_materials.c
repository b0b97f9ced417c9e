// parse_materials.c -- materials, shapes, the domain and contacts: lists with names looked up, and the checks that concern several keys.

#include "scene/scene_data.h"
#include "scene/schema.h"

#include <stdio.h>
#include <string.h>

// ---------------------------------------------------------------------------------------------------------------------------------------
// names

int pls_scene_find_material(const pls_scene *scene, const char *name)
{
    for (size_t k = 0; k < scene->material_count; ++k)
    {
        if (strcmp(scene->materials[k].name, name) == 0) return (int)k;
    }
    return -1;
}

int pls_scene_find_shape(const pls_scene *scene, const char *name)
{
    for (size_t k = 0; k < scene->shape_count; ++k)
    {
        if (strcmp(scene->shapes[k].name, name) == 0) return (int)k;
    }
    return -1;
}

int pls_scene_find_body(const pls_scene *scene, const char *name)
{
    for (size_t k = 0; k < scene->body_count; ++k)
    {
        if (strcmp(scene->bodies[k].name, name) == 0) return (int)k;
    }
    return -1;
}

enum { MANY = 64 };

static pls_status unknown_name(const pls_node *node, const char *what, const char *const *names, size_t count)
{
    char list[64], hint[600];
    strcpy(list, "the scene has");
    pls_scene_hint(hint, sizeof hint, node->text, list, names, count);
    return pls_node_fail(node, hint, "unknown %s '%.80s'", what, node->text);
}

pls_status pls_scene_need_material(const pls_scene *scene, const pls_node *node, int *index)
{
    *index = pls_scene_find_material(scene, node->text);
    if (*index >= 0) return PLS_OK;
    const char *names[MANY];
    size_t count = 0;
    for (; count < scene->material_count && count < MANY; ++count) names[count] = scene->materials[count].name;
    return unknown_name(node, "material", names, count);
}

pls_status pls_scene_need_shape(const pls_scene *scene, const pls_node *node, int *index)
{
    *index = pls_scene_find_shape(scene, node->text);
    if (*index >= 0) return PLS_OK;
    const char *names[MANY];
    size_t count = 0;
    for (; count < scene->shape_count && count < MANY; ++count) names[count] = scene->shapes[count].name;
    return unknown_name(node, "shape", names, count);
}

pls_status pls_scene_need_body(const pls_scene *scene, const pls_node *node, int *index)
{
    *index = pls_scene_find_body(scene, node->text);
    if (*index >= 0) return PLS_OK;
    const char *names[MANY];
    size_t count = 0;
    for (; count < scene->body_count && count < MANY; ++count) names[count] = scene->bodies[count].name;
    return unknown_name(node, "body entry", names, count);
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// materials and shapes

pls_status pls_scene_parse_materials(pls_scene *scene)
{
    const pls_node *map = pls_node_get(scene->root, "materials");
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->materials, map->count, sizeof *scene->materials, "materials"));
    for (size_t k = 0; k < map->count; ++k) scene->materials[k] = (pls_scene_material){map->key[k]->text, map->child[k]};
    scene->material_count = map->count;
    return PLS_OK;
}

void pls_scene_parameters(const pls_parameter *table, const pls_node *map, double *values)
{
    for (; table && table->name; ++table)
    {
        const pls_node *node = pls_node_get(map, table->name);
        if (node && node->kind == PLS_NODE_LIST)
        {
            for (size_t c = 0; c < 3; ++c) *values++ = node->child[c]->number;
        }
        else
            *values++ = node && node->numeric ? node->number : NAN;
    }
}

static pls_status make_shape(const pls_scene *scene, pls_scene_shape *shape)
{
    double values[3 * PLS_MAX_PARAMETERS];
    char owner[PLS_NAME_SIZE + 16];
    pls_scene_parameters(shape->ops->parameters, shape->node->child[0], values);
    snprintf(owner, sizeof owner, "shape '%s'", shape->name);
    const pls_shape_input input = {.values = values};
    return pls_node_context(pls_shape_make(shape->ops, scene->dimension, &input, owner, &shape->made), shape->node, "shape '%s'",
                            shape->name);
}

pls_status pls_scene_parse_shapes(pls_scene *scene)
{
    const pls_node *map = pls_node_get(scene->root, "shapes");
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->shapes, map->count, sizeof *scene->shapes, "shapes"));
    for (size_t k = 0; k < map->count; ++k)
    {
        pls_scene_shape *shape = &scene->shapes[k];
        *shape = (pls_scene_shape){.name = map->key[k]->text, .node = map->child[k]};
        shape->ops = pls_registry_find(&scene->shape_ops, map->child[k]->key[0]->text);
        PLS_TRY(make_shape(scene, shape));
        scene->shape_count = k + 1; // what is there is freed with the scene
    }
    return PLS_OK;
}

pls_status pls_scene_parse_domain(pls_scene *scene)
{
    const pls_node *domain = pls_node_get(scene->root, "domain");
    if (!domain) return PLS_OK;
    const pls_node *periodic = pls_node_get(domain, "periodic"), *lower = pls_node_get(domain, "lower"),
                   *upper = pls_node_get(domain, "upper");
    for (size_t axis = 0; axis < periodic->count; ++axis)
    {
        if (strcmp(periodic->child[axis]->text, "true") != 0) continue;
        if (!(lower->child[axis]->number < upper->child[axis]->number))
            return pls_node_fail(upper->child[axis], NULL,
                                 "the domain's upper corner must lie above its lower corner along the periodic axis %c", "xyz"[axis]);
    }
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// contacts

static pls_status parse_contact(pls_scene *scene, const pls_node *node, pls_scene_contact *contact)
{
    *contact = (pls_scene_contact){.node = node, .a = PLS_ALL_MATERIALS, .b = PLS_ALL_MATERIALS};
    const pls_node *between = pls_node_get(node, "between");
    contact->ops = pls_registry_find(&scene->law_ops, pls_node_get(node, "law")->text);
    if (between->kind == PLS_NODE_SCALAR) return PLS_OK;
    if (between->count != 2)
        return pls_node_fail(between, "for example  between: [grain, wall]", "'between' must name two materials, not %zu", between->count);
    PLS_TRY(pls_scene_need_material(scene, between->child[0], &contact->a));
    return pls_scene_need_material(scene, between->child[1], &contact->b);
}

pls_status pls_scene_parse_contacts(pls_scene *scene)
{
    const pls_node *list = pls_node_get(scene->root, "contact");
    if (!list) return PLS_OK;
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->contacts, list->count, sizeof *scene->contacts, "contact laws"));
    for (size_t k = 0; k < list->count; ++k)
    {
        pls_scene_contact *contact = &scene->contacts[k];
        PLS_TRY(parse_contact(scene, list->child[k], contact));
        for (size_t j = 0; j < k; ++j)
        {
            const pls_scene_contact *earlier = &scene->contacts[j];
            bool same = (earlier->a == contact->a && earlier->b == contact->b) || (earlier->a == contact->b && earlier->b == contact->a);
            if (same)
                return pls_node_fail(pls_node_get(contact->node, "between"), "remove one of the two",
                                     "the law for this pair is given twice, first in line %d", earlier->node->line);
        }
        ++scene->contact_count;
    }
    return PLS_OK;
}
