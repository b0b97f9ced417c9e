// build_bodies.c -- bodies of each entry: orientation, velocities, mass and prescribed motion.

#include "scene/build.h"

#include <string.h>

/// What the bodies of an entry have in common.
typedef struct entry_plan
{
    const pls_scene_body *body;
    pls_body_def def;       ///< with all that is the same for each body
    pls_formula *velocity;  ///< initial velocities over x, y, z; null when constant
    pls_formula *motion;    ///< prescribed motion over t; null when constant
    const pls_node *driven; ///< the motion section, null if there is none
    double density;         ///< of the material at the start, times the thickness; NaN if not given
} entry_plan;

// ---------------------------------------------------------------------------------------------------------------------------------------
// orientation

/// Shortest turn of the unit vector `from` onto `to`; half a turn about `spare` when they are opposite.
static pls_quat turn_onto(pls_vec3 from, pls_vec3 to, pls_vec3 spare)
{
    double w = 1.0 + pls_dot(from, to);
    if (w < 1e-12) return (pls_quat){0.0, spare.x, spare.y, spare.z};
    pls_vec3 v = pls_cross(from, to);
    return pls_quat_unit((pls_quat){w, v.x, v.y, v.z});
}

static pls_quat read_orientation(const pls_scene *scene, const pls_node *body)
{
    if (!pls_node_get(body, "normal")) return pls_scene_turn(scene, body);
    const pls_vec3 x = pls_vec(1, 0, 0), y = pls_vec(0, 1, 0), z = pls_vec(0, 0, 1), normal = pls_unit(pls_scene_vector(body, "normal"));
    return scene->dimension == 2 ? turn_onto(y, normal, z) : turn_onto(z, normal, x);
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// motion

static bool is_free(const pls_node *vector, size_t k)
{
    const pls_node *node = vector->kind == PLS_NODE_SCALAR ? vector : vector->child[k];
    return strcmp(node->text, "free") == 0;
}

static unsigned locked_axes(const pls_node *lock)
{
    static const char *const names[] = {"x", "y", "z", "rx", "ry", "rz"};
    unsigned axes = 0;
    for (size_t k = 0; lock && k < lock->count; ++k)
    {
        for (unsigned j = 0; j < 6; ++j)
        {
            if (strcmp(names[j], lock->child[k]->text) == 0) axes |= 1U << j;
        }
    }
    return axes;
}

/// Axes that a motion section prescribes: all but those marked `free`.
static unsigned driven_axes(const pls_scene *scene, const pls_node *motion)
{
    unsigned axes = PLS_AXIS_ALL;
    const pls_node *path = pls_node_get(motion, "velocity"), *spin = pls_node_get(motion, "angular_velocity");
    if (!path) path = pls_node_get(motion, "displacement");
    for (size_t k = 0; path && k < path->count; ++k)
    {
        if (is_free(path, k)) axes &= ~(1U << k);
    }
    if (spin && scene->dimension == 2 && is_free(spin, 0)) axes &= ~(unsigned)PLS_AXIS_RZ;
    for (size_t k = 0; spin && k < spin->count; ++k)
    {
        if (is_free(spin, k)) axes &= ~(8U << k);
    }
    return axes;
}

static pls_status plan_motion(const pls_builder *b, entry_plan *plan)
{
    const pls_node *node = plan->body->node;
    bool unbounded = pls_scene_choice_shape(b->scene, plan->body, 0)->ops->unbounded;
    pls_motion_def *motion = &plan->def.motion;
    plan->driven = pls_node_get(node, "motion");
    motion->axes = locked_axes(pls_node_get(node, "lock"));
    if (!plan->driven)
    {
        if (unbounded || pls_scene_boolean(node, "fixed", false)) motion->axes = PLS_AXIS_ALL;
        return PLS_OK;
    }
    motion->axes |= driven_axes(b->scene, plan->driven);
    motion->velocity = pls_scene_vector(plan->driven, "velocity");
    motion->angular_velocity = pls_scene_spin(plan->driven, "angular_velocity");
    motion->about = pls_node_get(plan->driven, "about") != NULL;
    motion->centre = pls_scene_vector(plan->driven, "about");
    bool varies = pls_scene_varies(pls_node_get(plan->driven, "velocity")) ||
                  pls_scene_varies(pls_node_get(plan->driven, "angular_velocity")) || pls_node_get(plan->driven, "displacement");
    if (!varies || motion->axes == 0) return PLS_OK; // with every axis free there is nothing to ask
    return pls_build_motion_formula(b, plan->driven, &plan->motion);
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// one entry

/// Initial velocities that depend on the place: six expressions over x, y, z.
static pls_status plan_velocity(const pls_builder *b, entry_plan *plan)
{
    const pls_node *velocity = pls_node_get(plan->body->node, "velocity"), *spin = pls_node_get(plan->body->node, "angular_velocity");
    plan->def.velocity = pls_scene_vector(plan->body->node, "velocity");
    plan->def.angular_velocity = pls_scene_spin(plan->body->node, "angular_velocity");
    if (!pls_scene_varies(velocity) && !pls_scene_varies(spin)) return PLS_OK;
    char numbers[6][32];
    const char *texts[6], *names[PLS_EXPRESSION_VARIABLES];
    for (size_t k = 0; k < 3; ++k)
    {
        bool flat = b->scene->dimension == 2;
        texts[k] = pls_build_component(velocity, k, numbers[k]);
        texts[3 + k] = flat ? (k == 2 ? pls_build_component(spin, 0, numbers[5]) : NULL) : pls_build_component(spin, k, numbers[3 + k]);
    }
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(b->scene, PLS_USES_PLACE, NULL, names, &symbols));
    return pls_formula_make(texts, 6, &symbols, &plan->velocity);
}

static pls_status initial_velocity(const entry_plan *plan, const pls_points *points, size_t k, pls_body_def *def)
{
    if (plan->velocity)
    {
        double at[3] = {def->position.x, def->position.y, def->position.z}, v[6];
        PLS_TRY(pls_formula_once(plan->velocity, at, v));
        def->velocity = pls_vec(v[0], v[1], v[2]);
        def->angular_velocity = pls_vec(v[3], v[4], v[5]);
    }
    if (points->velocity) def->velocity = points->velocity[k];
    if (points->angular_velocity) def->angular_velocity = points->angular_velocity[k];
    return PLS_OK;
}

/// With a mass but no moments of inertia the body is as if its density were uniform: I = m (I1 / V1) s^2 with the shape's own V1, I1.
static void uniform_inertia(const pls_shape *shape, pls_body_def *def)
{
    if (isnan(def->mass) || !isnan(def->inertia.z)) return;
    def->inertia = pls_scale(shape->moments, def->mass / shape->mass.volume * def->scale * def->scale);
}

static pls_status add_body(pls_builder *b, const entry_plan *plan, const pls_points *points, size_t k, pls_body_id *id)
{
    const pls_scene_shape *shape = pls_points_shape(b->scene, plan->body, points, k);
    pls_body_def def = plan->def;
    def.shape = b->shapes[shape - b->scene->shapes];
    def.position = points->position[k];
    if (points->scale) def.scale = points->scale[k];
    if (points->orientation) def.orientation = points->orientation[k];
    if (points->volume && isnan(def.mass)) def.mass = plan->density * points->volume[k];
    def.orientation =
        pls_quat_multiply(def.orientation, shape->made->principal); // scenes turn the shape's own frame, worlds its principal axes
    PLS_TRY(initial_velocity(plan, points, k, &def));
    uniform_inertia(shape->made, &def);
    if (plan->motion) PLS_TRY(pls_build_motion_context(b, plan->driven, plan->motion, &def.motion));
    return pls_world_add_body(b->world, &def, id);
}

pls_status pls_build_density(const pls_builder *b, size_t entry, double *density)
{
    size_t count;
    const pls_key *key = pls_schema_keys("material", &count);
    while (strcmp(key->name, "density") != 0) ++key;
    const pls_node *node = pls_node_get(b->scene->materials[b->scene->bodies[entry].material].node, key->name);
    *density = NAN;
    return node ? pls_build_initial_value(b, key, node, density) : PLS_OK;
}

/// Per area in 2D.
static pls_status plan_density(const pls_builder *b, entry_plan *plan)
{
    PLS_TRY(pls_build_density(b, (size_t)(plan->body - b->scene->bodies), &plan->density));
    if (b->scene->dimension == 2) plan->density *= b->scene->thickness;
    return PLS_OK;
}

static pls_status plan_entry(const pls_builder *b, entry_plan *plan)
{
    const pls_node *node = plan->body->node;
    plan->def = pls_default_body_def();
    plan->def.material = b->materials[plan->body->material];
    plan->def.orientation = read_orientation(b->scene, node);
    plan->def.scale = pls_scene_number(node, "scale", 1.0);
    plan->def.mass = pls_scene_number(node, "mass", NAN);
    if (pls_node_get(node, "inertia")) plan->def.inertia = pls_scene_spin(node, "inertia");
    PLS_TRY(plan_density(b, plan));
    PLS_TRY(plan_motion(b, plan));
    return plan_velocity(b, plan);
}

static pls_status add_entry(pls_builder *b, size_t k)
{
    entry_plan plan = {.body = &b->scene->bodies[k]};
    const pls_points *points = &b->points[k];
    pls_status status = plan_entry(b, &plan);
    if (status == PLS_OK) status = pls_world_add_group(b->world, plan.body->name, &b->groups[k]);
    plan.def.group = b->groups[k];
    for (size_t j = 0; status == PLS_OK && j < points->count; ++j)
    {
        status = add_body(b, &plan, points, j, &b->ids[b->first_body[k] + j]);
        if (status != PLS_OK && points->count > 1) status = pls_fail_context(status, "its body %zu: ", j);
    }
    pls_formula_drop(plan.velocity);
    pls_formula_drop(plan.motion);
    return pls_node_context(status, plan.body->node, "body '%s'", plan.body->name);
}

pls_status pls_build_bodies(pls_builder *b)
{
    PLS_TRY(pls_allocate(&b->ids, b->total, sizeof *b->ids, "ids of bodies"));
    PLS_TRY(pls_world_reserve_bodies(b->world, b->total));
    for (size_t k = 0; k < b->scene->body_count; ++k) PLS_TRY(add_entry(b, k));
    return PLS_OK;
}

pls_status pls_build_state_body(const pls_builder *b, const pls_scene_state *state, size_t copy, size_t *index)
{
    size_t count = b->points[state->body].count;
    const pls_node *of = pls_node_get(state->node, "of");
    const char *name = b->scene->bodies[state->body].name;
    if (!state->each && state->index == PLS_ONLY_BODY && count > 1)
        return pls_node_fail(of, "say which:  index: 0,  index: middle  or  each: true", "'%s' holds %zu bodies", name, count);
    *index = state->each ? copy : state->index == PLS_ONLY_BODY ? 0 : state->index == PLS_MIDDLE_BODY ? count / 2 : (size_t)state->index;
    if (*index < count) return PLS_OK;
    const pls_node *at = pls_node_get(state->node, "index") ? pls_node_get(state->node, "index") : of;
    return pls_node_fail(at, "bodies are numbered from 0", "'%s' holds %zu bod%s; there is no body %zu", name, count,
                         count == 1 ? "y" : "ies", *index);
}
