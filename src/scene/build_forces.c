// build_forces.c -- body forces of a scene: gravity, fields by expressions, loads on faces, forces of plugins.

#include "scene/build.h"

#include <stdio.h>
#include <string.h>

// ---------------------------------------------------------------------------------------------------------------------------------------
// fields

/// What the three components count by.
typedef enum measure { BY_BODY, BY_MASS, BY_VOLUME } measure;

typedef struct force_field
{
    pls_formula *force; ///< three components
    pls_formula *where; ///< null: everywhere
    measure by;
    double *density; ///< of each body of the scene, by number, for BY_VOLUME [kg/m^3]
    size_t bodies;
} force_field;

static pls_status add_field(const force_field *field, const pls_force_batch *batch, pls_formula_copy *force, pls_formula_copy *where)
{
    for (size_t k = 0; k < batch->count; ++k)
    {
        if (isinf(batch->mass[k])) continue;
        if (field->by == BY_VOLUME && batch->body[k] >= field->bodies)
            return pls_fail(PLS_INVALID_ARGUMENT, "a field by volume acts on body %u, which is not of the scene: its volume is not known",
                            batch->body[k]);
        double at[] = {batch->time,  batch->x[k],  batch->y[k],      batch->z[k],   batch->vx[k],
                       batch->vy[k], batch->vz[k], batch->radius[k], batch->mass[k]};
        double inside = 1.0, f[3];
        if (where) PLS_TRY(pls_formula_values(field->where, where, at, &inside));
        if (inside == 0.0) continue;
        PLS_TRY(pls_formula_values(field->force, force, at, f));
        const double factor = field->by == BY_BODY   ? 1.0
                              : field->by == BY_MASS ? batch->mass[k]
                                                     : batch->mass[k] / field->density[batch->body[k]];
        batch->force_x[k] += factor * f[0];
        batch->force_y[k] += factor * f[1];
        batch->force_z[k] += factor * f[2];
    }
    return PLS_OK;
}

static pls_status field_evaluate(void *context, const pls_force_batch *batch)
{
    const force_field *field = context;
    pls_formula_copy *force, *where = NULL;
    PLS_TRY(pls_formula_begin(field->force, &force));
    pls_status status = field->where ? pls_formula_begin(field->where, &where) : PLS_OK;
    if (status == PLS_OK) status = add_field(field, batch, force, where);
    pls_formula_end(field->force, force);
    if (where) pls_formula_end(field->where, where);
    return status;
}

static void field_destroy(void *context)
{
    force_field *field = context;
    if (!field) return;
    pls_formula_drop(field->force);
    pls_formula_drop(field->where);
    pls_release(&field->density);
    pls_release(&field);
}

static const pls_force_ops field_ops = {
    .api_version = PLS_API_VERSION,
    .name = "field",
    .meaning = "a field of forces given by expressions",
    .evaluate = field_evaluate,
    .destroy = field_destroy,
};

/// Densities of the materials of all bodies, by number.
static pls_status find_densities(const pls_builder *b, const pls_node *node, force_field *field)
{
    PLS_TRY(pls_allocate(&field->density, b->total, sizeof *field->density, "densities of bodies"));
    field->bodies = b->total;
    const char *only = pls_node_get(node, "bodies")->text;
    for (size_t entry = 0; entry < b->scene->body_count; ++entry)
    {
        double value;
        PLS_TRY(pls_build_density(b, entry, &value));
        const bool acts = strcmp(only, "all") == 0 || strcmp(only, b->scene->bodies[entry].name) == 0;
        if (acts && isnan(value) && !pls_scene_choice_shape(b->scene, &b->scene->bodies[entry], 0)->ops->unbounded)
            return pls_node_fail(pls_node_get(node, "density"), "give the material a density, or the field `force` or `acceleration`",
                                 "the body '%s' has no volume: its material has no density", b->scene->bodies[entry].name);
        for (size_t k = 0; k < b->points[entry].count; ++k) field->density[b->ids[b->first_body[entry] + k].index1 - 1] = value;
    }
    return PLS_OK;
}

static pls_status make_field(const pls_builder *b, const pls_node *node, force_field *field)
{
    static const char *const keys_of[] = {[BY_BODY] = "force", [BY_MASS] = "acceleration", [BY_VOLUME] = "density"};
    const pls_node *force = NULL, *where = pls_node_get(node, "where");
    for (measure by = BY_BODY; by <= BY_VOLUME; ++by)
        if (pls_node_get(node, keys_of[by])) field->by = by, force = pls_node_get(node, keys_of[by]);
    if (field->by == BY_VOLUME) PLS_TRY(find_densities(b, node, field));
    size_t count;
    unsigned uses = 0;
    const pls_key *keys = pls_schema_keys("field", &count);
    for (size_t k = 0; k < count; ++k) uses |= keys[k].uses;
    char numbers[3][32];
    const char *texts[3], *names[PLS_EXPRESSION_VARIABLES];
    for (size_t k = 0; k < 3; ++k) texts[k] = pls_build_component(force, k, numbers[k]);
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(b->scene, uses, NULL, names, &symbols));
    PLS_TRY(pls_formula_make(texts, 3, &symbols, &field->force));
    return where ? pls_formula_make(&where->text, 1, &symbols, &field->where) : PLS_OK;
}

/// The group a force acts on; null for all.
static pls_group_id group_of(const pls_builder *b, const pls_node *map)
{
    const char *name = pls_node_get(map, "bodies")->text;
    return strcmp(name, "all") == 0 ? (pls_group_id){0} : b->groups[pls_scene_find_body(b->scene, name)];
}

static pls_status build_field(const pls_builder *b, const pls_node *node)
{
    force_field *field;
    PLS_TRY(pls_allocate(&field, 1, sizeof *field, "a field of forces"));
    pls_status status = make_field(b, node, field);
    if (status != PLS_OK)
    {
        field_destroy(field);
        return status;
    }
    pls_force_def def = pls_default_force_def();
    def.ops = &field_ops;
    def.context = field;
    def.group = group_of(b, node);
    pls_force_id id;
    return pls_node_context(pls_world_add_force(b->world, &def, &id), node, "the force");
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// loads on faces

/// A traction, or a pressure: a force per area, shared by the bodies that were chosen at the start, by their masses.
typedef struct face_load
{
    pls_formula *value; ///< three components [Pa]
    double *area;       ///< of each body, by number [m^2]; 0: it was not chosen
    pls_body_id *body;  ///< likewise: another one may get the number
    size_t bodies;
    const pls_world *world;
} face_load;

static double area_of(const face_load *face, uint32_t number)
{
    pls_body_motion motion;
    if (number >= face->bodies || !(face->area[number] > 0.0)) return 0.0;
    return pls_body_get(face->world, face->body[number], &motion) == PLS_OK ? face->area[number] : 0.0;
}

static pls_status face_evaluate(void *context, const pls_force_batch *batch)
{
    const face_load *face = context;
    pls_formula_copy *copy;
    PLS_TRY(pls_formula_begin(face->value, &copy));
    pls_status status = PLS_OK;
    for (size_t k = 0; status == PLS_OK && k < batch->count; ++k)
    {
        const double area = area_of(face, batch->body[k]), at[] = {batch->time, batch->x[k], batch->y[k], batch->z[k]};
        double f[3];
        if (!(area > 0.0)) continue;
        status = pls_formula_values(face->value, copy, at, f);
        if (status != PLS_OK) break;
        batch->force_x[k] += area * f[0];
        batch->force_y[k] += area * f[1];
        batch->force_z[k] += area * f[2];
    }
    pls_formula_end(face->value, copy);
    return status;
}

static void face_destroy(void *context)
{
    face_load *face = context;
    if (!face) return;
    pls_formula_drop(face->value);
    pls_release(&face->area);
    pls_release(&face->body);
    pls_release(&face);
}

static const pls_force_ops face_ops = {.api_version = PLS_API_VERSION,
                                       .name = "face",
                                       .meaning = "a force per area on the bodies of a face",
                                       .evaluate = face_evaluate,
                                       .destroy = face_destroy};

/// Whether `where` chooses a body at the start.
static pls_status is_chosen(const pls_builder *b, const pls_node *node, pls_formula *where, size_t entry, size_t k, bool *chosen)
{
    const char *only = pls_node_get(node, "bodies")->text;
    const pls_vec3 x = b->points[entry].position[k];
    const double at[] = {0.0, x.x, x.y, x.z};
    double value = 1.0;
    *chosen = (strcmp(only, "all") == 0 || strcmp(only, b->scene->bodies[entry].name) == 0) &&
              !pls_scene_choice_shape(b->scene, &b->scene->bodies[entry], 0)->ops->unbounded;
    if (!*chosen || !where) return PLS_OK;
    PLS_TRY(pls_formula_once(where, at, &value));
    *chosen = value != 0.0;
    return PLS_OK;
}

static pls_status share_area(const pls_builder *b, const pls_node *node, pls_formula *where, face_load *face)
{
    double mass = 0.0;
    PLS_TRY(pls_allocate(&face->area, b->total, sizeof *face->area, "a load on a face"));
    PLS_TRY(pls_allocate(&face->body, b->total, sizeof *face->body, "a load on a face"));
    face->bodies = b->total;
    face->world = b->world;
    for (size_t entry = 0; entry < b->scene->body_count; ++entry)
        for (size_t k = 0; k < b->points[entry].count; ++k)
        {
            const pls_body_id id = b->ids[b->first_body[entry] + k];
            pls_body_motion motion;
            bool chosen;
            PLS_TRY(is_chosen(b, node, where, entry, k, &chosen));
            if (!chosen) continue;
            PLS_TRY(pls_body_get(b->world, id, &motion));
            face->area[id.index1 - 1] = motion.mass;
            face->body[id.index1 - 1] = id;
            mass += motion.mass;
        }
    if (!(mass > 0.0) || !isfinite(mass))
        return pls_node_fail(pls_node_get(node, "where") ? pls_node_get(node, "where") : node, "places are those of the start [m]",
                             "no body lies in the face");
    for (size_t n = 0; n < b->total; ++n) face->area[n] *= pls_scene_number(node, "area", 0.0) / mass;
    return PLS_OK;
}

/// Components of the force per area: a vector, or a pressure against the outward normal.
static pls_status make_value(const pls_node *node, const pls_symbols *symbols, pls_formula **formula)
{
    const pls_node *vector = pls_node_get(node, "value"), *normal = pls_node_get(node, "normal");
    char number[3][32], product[3][PLS_EXPRESSION_SIZE];
    const char *texts[3];
    for (size_t c = 0; !normal && c < 3; ++c) texts[c] = pls_build_component(vector, c, number[c]);
    if (normal)
    {
        const pls_vec3 n = pls_unit(pls_scene_vector(node, "normal"));
        const double component[3] = {n.x, n.y, n.z};
        for (size_t c = 0; c < 3; ++c)
        {
            char scale[32];
            const int size = snprintf(product[c], sizeof product[c], "(%s)*(%s)", pls_format_double(scale, -component[c]),
                                      pls_build_component(vector, 0, number[c]));
            if (size < 0 || (size_t)size >= sizeof product[c]) return pls_node_fail(vector, NULL, "the expression is too long");
            texts[c] = product[c];
        }
    }
    return pls_formula_make(texts, 3, symbols, formula);
}

static pls_status make_face(const pls_builder *b, const pls_node *node, face_load *face)
{
    const pls_node *where = pls_node_get(node, "where");
    const char *names[PLS_EXPRESSION_VARIABLES];
    pls_symbols symbols;
    pls_formula *choose = NULL;
    PLS_TRY(pls_scene_symbols(b->scene, PLS_USES_TIME | PLS_USES_PLACE, NULL, names, &symbols));
    PLS_TRY(make_value(node, &symbols, &face->value));
    if (where) PLS_TRY(pls_formula_make(&where->text, 1, &symbols, &choose));
    const pls_status status = share_area(b, node, choose, face);
    pls_formula_drop(choose);
    return status;
}

static pls_status build_face(const pls_builder *b, const pls_node *node)
{
    face_load *face;
    PLS_TRY(pls_allocate(&face, 1, sizeof *face, "a load on a face"));
    const pls_status status = make_face(b, node, face);
    if (status != PLS_OK)
    {
        face_destroy(face);
        return status;
    }
    pls_force_def def = pls_default_force_def();
    def.ops = &face_ops;
    def.context = face;
    pls_force_id id;
    return pls_node_context(pls_world_add_force(b->world, &def, &id), node, "the force");
}

// ---------------------------------------------------------------------------------------------------------------------------------------

static pls_status bind_force(const pls_builder *b, const pls_key *key, const pls_node *node, size_t place, void *id)
{
    (void)place;
    return pls_build_bind_force(b, *(const pls_force_id *)id, key, node);
}

static pls_status build_force_of_plugin(const pls_builder *b, const pls_node *entry)
{
    const pls_node *map;
    double values[PLS_MAX_VALUES];
    pls_force_id id;
    pls_force_def def = pls_default_force_def();
    def.ops = pls_scene_named_operations(&b->scene->force_ops, entry, &map);
    def.values = values;
    def.group = group_of(b, map);
    PLS_TRY(pls_build_initial_values(b, def.ops->parameters, map, values));
    PLS_TRY(pls_node_context(pls_world_add_force(b->world, &def, &id), map, "'%s'", def.ops->name));
    return pls_build_each_formula(b, def.ops->parameters, map, bind_force, &id);
}

pls_status pls_build_forces(const pls_builder *b)
{
    const pls_node *list = pls_node_get(b->scene->root, "forces");
    for (size_t k = 0; list && k < list->count; ++k)
    {
        const pls_node *entry = list->child[k], *field = pls_node_get(entry, "field"), *face = pls_node_get(entry, "traction");
        if (!face) face = pls_node_get(entry, "pressure");
        if (field)
            PLS_TRY(build_field(b, field));
        else if (face)
            PLS_TRY(build_face(b, face));
        else if (pls_node_get(entry, "gravity"))
            PLS_TRY(pls_node_context(pls_world_add_gravity(b->world, pls_scene_vector(entry, "gravity")), entry, "forces[%zu]", k));
        else
            PLS_TRY(build_force_of_plugin(b, entry)); // says itself where, as precisely as its numbers stand
    }
    return PLS_OK;
}
