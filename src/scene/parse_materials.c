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
        if (table->kind != PLS_PARAMETER_NUMBER) continue;
        if (node && node->kind == PLS_NODE_LIST)
        {
            // The third component that a vector has no place for in 2D is 0 or, where that is out of range, any number within: it is not used.
            bool zero = table->open_minimum ? table->minimum < 0.0 : table->minimum <= 0.0;
            double rest = zero && table->maximum >= 0.0 ? 0.0 : node->child[node->count - 1]->number;
            for (size_t c = 0; c < 3; ++c) *values++ = c < node->count ? node->child[c]->number : rest;
        }
        else
            *values++ = node && node->numeric ? node->number : NAN;
    }
}

/// A density given by an expression.
typedef struct density_formula
{
    pls_formula *formula;
    pls_formula_copy *copy; ///< of the one thread that makes the shape
} density_formula;

/// What a shape is made from besides its numbers, while it is made.
typedef struct shape_input
{
    density_formula factor;
    pls_density_field density;
    pls_shape_input input;
    double values[3 * PLS_MAX_PARAMETERS];
    pls_vec3 *points;
    pls_shape_part *parts;
} shape_input;

static pls_status make_shape(pls_scene *scene, size_t k);

static pls_status take_points(const pls_node *list, shape_input *in)
{
    PLS_TRY(pls_allocate(&in->points, list->count, sizeof *in->points, "points of a shape"));
    for (size_t k = 0; k < list->count; ++k)
    {
        const pls_node *point = list->child[k];
        in->points[k] = pls_vec(point->child[0]->number, point->child[1]->number, point->count > 2 ? point->child[2]->number : 0.0);
    }
    in->input.points = in->points;
    in->input.point_count = list->count;
    return PLS_OK;
}

/// A shape that is a part is made first, wherever it stands.
static pls_status take_part(pls_scene *scene, const pls_node *node, pls_shape_part *part)
{
    const pls_node *name = pls_node_get(node, "shape");
    int index;
    PLS_TRY(pls_scene_need_shape(scene, name, &index));
    PLS_TRY(pls_scene_check_turn(scene, node));
    if (scene->shapes[index].begun && !scene->shapes[index].made)
        return pls_node_fail(name, NULL, "the shape '%s' would be a part of itself", name->text);
    if (scene->shapes[index].ops->unbounded || scene->shapes[index].ops->wall)
        return pls_node_fail(name, "parts are shapes that a grain may have", "the %s '%s' has no mass and cannot be a part of a compound",
                             scene->shapes[index].ops->name, name->text);
    PLS_TRY(make_shape(scene, (size_t)index));
    *part = (pls_shape_part){.shape = scene->shapes[index].made,
                             .position = pls_scene_vector(node, "position"),
                             .orientation = pls_scene_turn(scene, node),
                             .scale = pls_scene_number(node, "scale", 1.0)};
    return PLS_OK;
}

static pls_status take_parts(pls_scene *scene, const pls_node *list, shape_input *in)
{
    PLS_TRY(pls_allocate(&in->parts, list->count, sizeof *in->parts, "parts of a shape"));
    for (size_t k = 0; k < list->count; ++k) PLS_TRY(take_part(scene, list->child[k], &in->parts[k]));
    in->input.parts = in->parts;
    in->input.part_count = list->count;
    return PLS_OK;
}

/// Where the expression has no value it is NaN, which the shape refuses with the place.
static double factor_at(void *context, pls_vec3 X)
{
    const density_formula *f = context;
    const double place[3] = {X.x, X.y, X.z};
    double value;
    return pls_formula_values(f->formula, f->copy, place, &value) == PLS_OK ? value : NAN;
}

static pls_status take_density(const pls_scene *scene, const pls_node *node, shape_input *in)
{
    char number[32];
    const char *names[PLS_EXPRESSION_VARIABLES], *text = node->numeric ? pls_format_double(number, node->number) : node->text;
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(scene, PLS_USES_PLACE, NULL, names, &symbols));
    PLS_TRY(pls_formula_make(&text, 1, &symbols, &in->factor.formula));
    PLS_TRY(pls_formula_begin(in->factor.formula, &in->factor.copy));
    in->density = (pls_density_field){factor_at, &in->factor};
    in->input.density = &in->density;
    return PLS_OK;
}

static void release_input(shape_input *in)
{
    if (in->factor.copy) pls_formula_end(in->factor.formula, in->factor.copy);
    pls_formula_drop(in->factor.formula);
    pls_release(&in->points);
    pls_release(&in->parts);
}

static pls_status fill_input(pls_scene *scene, const pls_scene_shape *shape, shape_input *in)
{
    const pls_node *map = shape->node->child[0];
    pls_scene_parameters(shape->ops->parameters, map, in->values);
    in->input.values = in->values;
    in->input.value_count = (size_t)pls_parameter_values(shape->ops->parameters);
    for (const pls_parameter *row = shape->ops->parameters; row && row->name; ++row)
    {
        const pls_node *node = pls_node_get(map, row->name);
        if (!node) continue;
        if (row->kind == PLS_PARAMETER_PATH) in->input.path = node->text;
        if (row->kind == PLS_PARAMETER_POINTS || row->kind == PLS_PARAMETER_FLAT_POINTS) PLS_TRY(take_points(node, in));
        if (row->kind == PLS_PARAMETER_SHAPES) PLS_TRY(take_parts(scene, node, in));
    }
    const pls_node *factor = pls_node_get(shape->node, "density_factor");
    return factor ? take_density(scene, factor, in) : PLS_OK;
}

/// What the last message is about: the row whose file it names or whose name it quotes, else the shape as a whole.
static const pls_node *blamed(const pls_scene_shape *shape, const pls_shape_input *input)
{
    const pls_node *map = shape->node->child[0];
    for (const pls_parameter *row = shape->ops->parameters; row && row->name; ++row)
    {
        const pls_node *node = pls_node_get(map, row->name);
        char quoted[PLS_NAME_SIZE + 8];
        snprintf(quoted, sizeof quoted, "'%s'", row->name);
        const char *told = row->kind == PLS_PARAMETER_PATH && input->path ? input->path : quoted;
        if (node && strstr(pls_last_message(), told)) return node;
    }
    return input->density && strstr(pls_last_message(), "density") ? pls_node_get(shape->node, "density_factor") : shape->node;
}

static pls_status make_shape(pls_scene *scene, size_t k)
{
    pls_scene_shape *shape = &scene->shapes[k];
    if (shape->made) return PLS_OK;
    shape->begun = true;
    shape_input in = {.input = {.values = NULL}};
    char owner[PLS_NAME_SIZE + 16];
    snprintf(owner, sizeof owner, "shape '%s'", shape->name);
    pls_status status = fill_input(scene, shape, &in);
    if (status == PLS_OK)
    {
        status = pls_shape_make(shape->ops, scene->dimension, &in.input, owner, &shape->made);
        status = pls_node_context(status, blamed(shape, &in.input), "%s", ""); // the message names the shape
    }
    release_input(&in);
    return status;
}

pls_status pls_scene_parse_shapes(pls_scene *scene)
{
    const pls_node *map = pls_node_get(scene->root, "shapes");
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->shapes, map->count, sizeof *scene->shapes, "shapes"));
    for (size_t k = 0; k < map->count; ++k)
    {
        scene->shapes[k] = (pls_scene_shape){
            .name = map->key[k]->text, .node = map->child[k], .ops = pls_registry_find(&scene->shape_ops, map->child[k]->key[0]->text)};
    }
    scene->shape_count = map->count; // what is there is freed with the scene
    for (size_t k = 0; k < map->count; ++k) PLS_TRY(make_shape(scene, k));
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
