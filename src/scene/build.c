// build.c -- the order in which a world is built.
//
// Places of bodies come first: they tell how many states there are and with what they begin. With those the values of materials and laws at
// t = 0 are known; then bodies, forces and states. What depends on time is bound last.

#include "scene/build.h"

#include "shape/builtin.h"

#include <string.h>

// ---------------------------------------------------------------------------------------------------------------------------------------
// the world itself

static pls_status create_world(pls_builder *b)
{
    const pls_scene *scene = b->scene;
    const pls_node *root = scene->root, *time = pls_node_get(root, "time"), *domain = pls_node_get(root, "domain");
    pls_world_def def = pls_default_world_def(scene->dimension);
    def.thickness = scene->thickness;
    const pls_node *periodic = pls_node_get(domain, "periodic");
    for (size_t k = 0; periodic && k < periodic->count; ++k) def.periodic[k] = strcmp(periodic->child[k]->text, "true") == 0;
    if (domain)
    {
        def.lower = pls_scene_vector(domain, "lower");
        def.upper = pls_scene_vector(domain, "upper");
        def.stretch_rate = pls_scene_vector(domain, "stretch_rate");
    }
    def.dt = pls_scene_number(time, "dt", 0.0);
    def.safety = pls_scene_number(time, "safety", def.safety);
    def.allow_unstable = pls_scene_boolean(time, "allow_unstable", false);
    def.local_damping = pls_scene_number(time, "local_damping", 0.0);
    def.relaxation = strcmp(pls_scene_string(time, "relaxation", "none"), "adaptive") == 0;
    def.coordination = (int)pls_scene_number(time, "coordination", def.coordination);
    const pls_node *neighbours = pls_node_get(root, "neighbours");
    def.skin = pls_scene_number(neighbours, "skin", 0.0);
    def.reorder = pls_scene_boolean(neighbours, "reorder", true);
    def.max_overlap = pls_scene_number(pls_node_get(root, "guard"), "max_overlap", def.max_overlap);
    return pls_node_context(pls_world_create(&def, &b->world), root, "the world");
}

static pls_status add_shapes(pls_builder *b)
{
    for (size_t k = 0; k < b->scene->shape_count; ++k)
    {
        const pls_scene_shape *shape = &b->scene->shapes[k];
        pls_status status = pls_world_use_shape(b->world, shape->name, shape->made, &b->shapes[k]);
        PLS_TRY(pls_node_context(status, shape->node, "shape '%s'", shape->name));
    }
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// materials and laws

static pls_status add_material(pls_builder *b, size_t k)
{
    const pls_scene_material *material = &b->scene->materials[k];
    pls_material_def def = pls_default_material_def();
    memcpy(def.name, material->name, strlen(material->name) + 1);
    double *values[] = {&def.values.density, &def.values.young_modulus, &def.values.poisson_ratio};
    size_t count;
    const pls_key *keys = pls_schema_keys("material", &count);
    for (size_t j = 0; j < count; ++j)
    {
        const pls_node *node = pls_node_get(material->node, keys[j].name);
        if (node) PLS_TRY(pls_build_initial_value(b, &keys[j], node, values[j]));
    }
    pls_status status = pls_world_add_material(b->world, &def, &b->materials[k]);
    return pls_node_context(status, material->node, "material '%s'", material->name);
}

static pls_status bind_material(pls_builder *b, size_t k)
{
    size_t count;
    const pls_key *keys = pls_schema_keys("material", &count);
    for (size_t j = 0; j < count; ++j)
    {
        const pls_node *node = pls_node_get(b->scene->materials[k].node, keys[j].name);
        if (node && node->formula) PLS_TRY(pls_build_bind_material(b, b->materials[k], &keys[j], node));
    }
    return PLS_OK;
}

/// The entry that speaks for a pair: one that names it, else `all`, else none.
static const pls_scene_contact *find_contact(const pls_scene *scene, int i, int j)
{
    const pls_scene_contact *common = NULL;
    for (size_t k = 0; k < scene->contact_count; ++k)
    {
        const pls_scene_contact *contact = &scene->contacts[k];
        if (contact->a == PLS_ALL_MATERIALS) common = contact;
        if ((contact->a == i && contact->b == j) || (contact->a == j && contact->b == i)) return contact;
    }
    return common;
}

static pls_status set_narrow_options(pls_builder *b, const pls_scene_contact *contact, size_t i, size_t j)
{
    pls_narrow_options options = pls_default_narrow_options();
    const char *faces = pls_node_get(contact->node, "faces")->text;
    options.solver = strcmp(pls_node_get(contact->node, "solver")->text, "admm") == 0 ? PLS_SOLVER_ADMM : PLS_SOLVER_DEPTH;
    if (strcmp(faces, "point") == 0 || (strcmp(faces, "auto") == 0 && options.solver == PLS_SOLVER_ADMM))
        options.faces = PLS_FACES_POINT;
    else
        options.faces = strcmp(faces, "volume") == 0 ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD;
    options.face_area = pls_scene_number(contact->node, "face_area", 0.0);
    options.tolerance = pls_scene_number(contact->node, "tolerance", options.tolerance);
    return pls_world_set_narrow_options(b->world, b->materials[i], b->materials[j], &options);
}

static pls_status set_law(pls_builder *b, const pls_scene_contact *contact, size_t i, size_t j)
{
    double values[PLS_MAX_VALUES];
    PLS_TRY(pls_build_initial_values(b, contact->ops->parameters, contact->node, values));
    pls_status status = pls_world_set_law(b->world, b->materials[i], b->materials[j], contact->ops, values);
    bool at_surface = strcmp(pls_node_get(contact->node, "lever")->text, "surface") == 0;
    if (status == PLS_OK) status = pls_world_set_lever_at_surface(b->world, b->materials[i], b->materials[j], at_surface);
    if (status == PLS_OK) status = set_narrow_options(b, contact, i, j);
    return pls_node_context(status, contact->node, "contact");
}

/// Whether the entries may touch each other at all: one of them moves, and they are not one and the same body.
static bool may_meet(const pls_builder *b, size_t p, size_t q)
{
    const size_t entry[2] = {p, q};
    int still = 0;
    for (int e = 0; e < 2; ++e)
    {
        const pls_scene_body *body = &b->scene->bodies[entry[e]];
        const pls_shape_ops *ops = pls_scene_choice_shape(b->scene, body, 0)->ops;
        still += ops->unbounded || ops->wall || pls_scene_boolean(body->node, "fixed", false);
    }
    return still < 2 && (p != q || b->points[p].count > 1);
}

static pls_status check_convex(const pls_builder *b, const pls_scene_contact *contact, size_t i, size_t j, size_t entry)
{
    const pls_scene_body *body = &b->scene->bodies[entry];
    for (size_t c = 0; c < body->choices; ++c)
    {
        const pls_scene_shape *shape = pls_scene_choice_shape(b->scene, body, c);
        if (!pls_shape_concave_part(shape->made)) continue;
        return pls_node_fail(pls_node_get(contact->node, "solver"),
                             "give the pair an entry of its own with  solver: depth, or make the shape a compound of convex ones",
                             "'solver: admm' is for convex shapes, but between '%s' and '%s' the shape '%s' (%s) of the bodies '%s' is not",
                             b->scene->materials[i].name, b->scene->materials[j].name, shape->name, shape->ops->name, body->name);
    }
    return PLS_OK;
}

/// Before the run, which would fail only when the first such bodies come close.
static pls_status check_solver(pls_builder *b, const pls_scene_contact *contact, size_t i, size_t j)
{
    const pls_scene *scene = b->scene;
    if (strcmp(pls_node_get(contact->node, "solver")->text, "admm") != 0) return PLS_OK;
    for (size_t p = 0; p < scene->body_count; ++p)
        for (size_t q = 0; q < scene->body_count; ++q)
        {
            if (scene->bodies[p].material != (int)i || scene->bodies[q].material != (int)j || !may_meet(b, p, q)) continue;
            PLS_TRY(check_convex(b, contact, i, j, p));
            PLS_TRY(check_convex(b, contact, i, j, q));
        }
    return PLS_OK;
}

static pls_status bind_parameter(const pls_builder *b, const pls_key *key, const pls_node *node, size_t place, void *pair)
{
    (void)place;
    const size_t *material = pair;
    return pls_build_bind_law(b, b->materials[material[0]], b->materials[material[1]], key, node);
}

static pls_status bind_law(pls_builder *b, const pls_scene_contact *contact, size_t i, size_t j)
{
    size_t pair[] = {i, j};
    return pls_build_each_formula(b, contact->ops->parameters, contact->node, bind_parameter, pair);
}

static pls_status for_each_pair(pls_builder *b, pls_status (*action)(pls_builder *, const pls_scene_contact *, size_t, size_t))
{
    for (size_t i = 0; i < b->scene->material_count; ++i)
    {
        for (size_t j = i; j < b->scene->material_count; ++j)
        {
            const pls_scene_contact *contact = find_contact(b->scene, (int)i, (int)j);
            if (contact) PLS_TRY(action(b, contact, i, j));
        }
    }
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// what is known before the world

static pls_status place_bodies(pls_builder *b)
{
    for (size_t k = 0; k < b->scene->body_count; ++k)
    {
        PLS_TRY(pls_points_make(b->scene, &b->scene->bodies[k], &b->points[k]));
        b->first_body[k] = b->total;
        b->total += b->points[k].count;
    }
    return PLS_OK;
}

/// Scale of a body at the start.
static double body_scale(const pls_builder *b, size_t entry, size_t index)
{
    const pls_points *points = &b->points[entry];
    return points->scale ? points->scale[index] : pls_scene_number(b->scene->bodies[entry].node, "scale", 1.0);
}

static pls_status initial_state(const pls_builder *b, const pls_scene_state *state, size_t copy, double *value)
{
    *value = state->initial ? state->initial->number : 0.0;
    if (state->body == PLS_OF_WORLD) return PLS_OK;
    size_t index;
    PLS_TRY(pls_build_state_body(b, state, copy, &index));
    if (state->initial || state->target == PLS_STATE_FREE) return PLS_OK;
    double scale = body_scale(b, (size_t)state->body, index);
    double radius = pls_points_shape(b->scene, &b->scene->bodies[state->body], &b->points[state->body], index)->made->radius;
    *value = state->target == PLS_STATE_RADIUS ? scale * radius : scale;
    return PLS_OK;
}

static pls_status count_states(pls_builder *b)
{
    const pls_scene *scene = b->scene;
    size_t list = scene->state_count;
    PLS_TRY(pls_allocate(&b->first_state, list, sizeof *b->first_state, "states"));
    PLS_TRY(pls_allocate(&b->state_counts, list, sizeof *b->state_counts, "states"));
    for (size_t k = 0; k < list; ++k)
    {
        b->first_state[k] = b->total_states;
        b->state_counts[k] = scene->states[k].each ? b->points[scene->states[k].body].count : 1;
        b->total_states += b->state_counts[k];
    }
    PLS_TRY(pls_allocate(&b->initial_states, b->total_states, sizeof *b->initial_states, "states"));
    for (size_t k = 0; k < list; ++k)
    {
        for (size_t copy = 0; copy < b->state_counts[k]; ++copy)
            PLS_TRY(initial_state(b, &scene->states[k], copy, &b->initial_states[b->first_state[k] + copy]));
    }
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------

static pls_status allocate_lists(pls_builder *b)
{
    const pls_scene *scene = b->scene;
    PLS_TRY(pls_allocate(&b->points, scene->body_count, sizeof *b->points, "places of bodies"));
    PLS_TRY(pls_allocate(&b->first_body, scene->body_count, sizeof *b->first_body, "body entries"));
    PLS_TRY(pls_allocate(&b->materials, scene->material_count, sizeof *b->materials, "materials"));
    PLS_TRY(pls_allocate(&b->shapes, scene->shape_count, sizeof *b->shapes, "shapes"));
    return pls_allocate(&b->groups, scene->body_count, sizeof *b->groups, "groups");
}

static pls_status build_all(pls_builder *b)
{
    PLS_TRY(allocate_lists(b));
    PLS_TRY(place_bodies(b));
    PLS_TRY(count_states(b));
    PLS_TRY(create_world(b));
    PLS_TRY(add_shapes(b));
    for (size_t k = 0; k < b->scene->material_count; ++k) PLS_TRY(add_material(b, k));
    PLS_TRY(for_each_pair(b, check_solver));
    PLS_TRY(for_each_pair(b, set_law));
    PLS_TRY(pls_build_bodies(b));
    PLS_TRY(pls_build_bonds(b));
    PLS_TRY(pls_build_forces(b));
    PLS_TRY(pls_build_states(b));
    for (size_t k = 0; k < b->scene->material_count; ++k) PLS_TRY(bind_material(b, k));
    return for_each_pair(b, bind_law);
}

pls_status pls_scene_build(pls_scene *scene, pls_world **world)
{
    pls_builder b = {.scene = scene};
    *world = NULL;
    pls_status status = build_all(&b);
    for (size_t k = 0; b.points && k < scene->body_count; ++k) pls_points_free(&b.points[k]);
    pls_release(&b.points);
    pls_release(&b.first_body);
    pls_release(&b.ids);
    pls_release(&b.first_state);
    pls_release(&b.state_counts);
    pls_release(&b.initial_states);
    pls_release(&b.materials);
    pls_release(&b.shapes);
    pls_release(&b.groups);
    if (status == PLS_OK)
        *world = b.world;
    else
        pls_world_destroy(b.world);
    return status;
}
