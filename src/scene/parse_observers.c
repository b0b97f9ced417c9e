// parse_observers.c -- states and observers.

#include "scene/scene_data.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---------------------------------------------------------------------------------------------------------------------------------------
// states

/// `of: pack[12]` into the entry and the index.
static pls_status parse_owner(pls_scene *scene, const pls_node *node, pls_scene_state *state)
{
    const pls_node *of = pls_node_get(node, "of"), *index = pls_node_get(node, "index");
    state->body = PLS_OF_WORLD;
    state->index = PLS_ONLY_BODY;
    if (strcmp(of->text, "world") == 0) return PLS_OK;
    pls_node name = *of;
    size_t size = strcspn(of->text, "[");
    PLS_TRY(pls_arena_print(&scene->arena, &name.text, "%.*s", (int)size, of->text));
    PLS_TRY(pls_scene_need_body(scene, &name, &state->body));
    if (index) state->index = index->numeric ? (long)index->number : PLS_MIDDLE_BODY;
    if (of->text[size] == '\0') return PLS_OK;
    const char *digits = of->text + size + 1;
    size_t count = strspn(digits, "0123456789");
    if (count == 0 || count > 9 || strcmp(digits + count, "]") != 0)
        return pls_node_fail(of, NULL, "'of' must be the name of a body entry, one of its bodies as \"pack[12]\", or world");
    if (index) return pls_node_fail(index, NULL, "the index is given twice");
    state->index = strtol(digits, NULL, 10);
    return PLS_OK;
}

/// What `radius`, `rate` and `target` say: where the rate stands and what follows the state.
static pls_status parse_target(const pls_scene *scene, pls_scene_state *state)
{
    const pls_node *node = state->node, *radius = pls_node_get(node, "radius"), *rate = pls_node_get(node, "rate"),
                   *target = pls_node_get(node, "target");
    if (radius && rate) return pls_node_fail(rate, "the rate stands within `radius`", "'radius' and 'rate' exclude each other");
    if (radius && strcmp(target->text, "none") != 0) return pls_node_fail(target, NULL, "'radius' and 'target' exclude each other");
    state->rate = radius ? pls_node_get(radius, "rate") : rate;
    state->initial = pls_node_get(radius ? radius : node, "initial");
    state->target = PLS_STATE_FREE;
    if (radius || strcmp(target->text, "radius") == 0)
        state->target = PLS_STATE_RADIUS;
    else if (strcmp(target->text, "scale") == 0)
        state->target = PLS_STATE_SCALE;
    if (state->target == PLS_STATE_FREE) return PLS_OK;

    const pls_node *at = radius ? radius : target;
    if (state->body == PLS_OF_WORLD)
        return pls_node_fail(at, "give `of: NAME`", "a state of the world has no body whose size could follow it");
    if (pls_scene_choice_shape(scene, &scene->bodies[state->body], 0)->ops->unbounded)
        return pls_node_fail(at, NULL, "the unbounded shape of '%s' has no size that could follow a state",
                             scene->bodies[state->body].name);
    if (state->initial && !(state->initial->number > 0.0))
        return pls_node_fail(state->initial, NULL, "the initial %s must be greater than 0",
                             state->target == PLS_STATE_RADIUS ? "radius" : "scale");
    return PLS_OK;
}

static pls_status parse_state(pls_scene *scene, const pls_node *node, size_t k)
{
    pls_scene_state *state = &scene->states[k];
    *state = (pls_scene_state){.node = node, .each = pls_scene_boolean(node, "each", false)};
    PLS_TRY(parse_owner(scene, node, state));
    PLS_TRY(parse_target(scene, state));
    if (!state->rate) return pls_node_fail(node, "rate: ds/dt, a number or an expression", "missing key 'rate' in states[%zu]", k);
    state->keep_density = strcmp(pls_node_get(node, "keep")->text, "density") == 0;
    if (state->each && state->body == PLS_OF_WORLD)
        return pls_node_fail(pls_node_key(node, "each"), "give `of: NAME`", "'each' has a meaning only for a body entry");
    if (state->each && pls_node_get(node, "index"))
        return pls_node_fail(pls_node_key(node, "index"), NULL, "'each' and 'index' exclude each other");

    const pls_node *name = pls_node_get(node, "name");
    if (!name && !pls_node_get(node, "radius"))
        return pls_node_fail(node, "name: name for expressions", "missing key 'name' in states[%zu]", k);
    state->name = name ? name->text : scene->state_names[k];
    if (!state->name) PLS_TRY(pls_arena_print(&scene->arena, &state->name, "%s_radius", scene->bodies[state->body].name));
    return PLS_OK;
}

pls_status pls_scene_parse_states(pls_scene *scene)
{
    const pls_node *list = pls_node_get(scene->root, "states");
    if (!list) return PLS_OK;
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->states, list->count, sizeof *scene->states, "states"));
    for (size_t k = 0; k < list->count; ++k) PLS_TRY(parse_state(scene, list->child[k], k));
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// observers

static pls_status parse_schedule(const pls_node *node, pls_schedule *schedule)
{
    const pls_node *every = pls_node_get(node, "every"), *steps = pls_node_get(node, "every_steps");
    if (every && steps)
        return pls_node_fail(pls_node_key(node, "every_steps"), "remove one of them", "'every' and 'every_steps' exclude each other");
    if (!every && !steps) return pls_node_fail(node, "for example  every: 0.01", "when? 'every' [s] or 'every_steps' is missing");
    *schedule = (pls_schedule){.every = every ? every->number : 0.0,
                               .every_steps = steps ? (uint64_t)steps->number : 0,
                               .start = pls_scene_number(node, "start", 0.0),
                               .end = pls_scene_number(node, "end", INFINITY)};
    if (schedule->end < schedule->start) return pls_node_fail(pls_node_get(node, "end"), NULL, "'end' lies before 'start'");
    return PLS_OK;
}

static pls_status check_group(const pls_scene *scene, const pls_node *group)
{
    int index;
    if (strcmp(group->text, "all") == 0) return PLS_OK;
    return pls_scene_need_body(scene, group, &index);
}

static pls_status parse_collection(const pls_scene *scene, const pls_node *node, pls_observer_def *def)
{
    static const struct
    {
        const char *name;
        unsigned bit;
    } kinds[] = {{"stress", PLS_MEASURE_STRESS},      {"tangent", PLS_MEASURE_TANGENT},
                 {"fabric", PLS_MEASURE_FABRIC},      {"coordination", PLS_MEASURE_COORDINATION},
                 {"energy", PLS_MEASURE_ENERGY},      {"momentum", PLS_MEASURE_MOMENTUM},
                 {"porosity", PLS_MEASURE_POROSITY},  {"mass", PLS_MEASURE_MASS},
                 {"fragments", PLS_MEASURE_FRAGMENTS}};
    pls_collection_def *collection = &def->collection;
    *collection = (pls_collection_def){.include_walls = pls_scene_boolean(node, "walls", true)};
    const pls_node *group = pls_node_get(node, "collection"), *quantities = pls_node_get(node, "quantities"),
                   *volume = pls_node_get(node, "volume");
    PLS_TRY(check_group(scene, group));
    snprintf(collection->group, sizeof collection->group, "%s", group->text);
    for (size_t k = 0; k < quantities->count; ++k)
    {
        for (size_t j = 0; j < sizeof kinds / sizeof *kinds; ++j)
        {
            if (strcmp(kinds[j].name, quantities->child[k]->text) == 0) collection->quantities |= kinds[j].bit;
        }
        if (strcmp(quantities->child[k]->text, "fragments") == 0 && !pls_node_get(scene->root, "bonds"))
            return pls_node_fail(quantities->child[k], "leave it out, or give `bonds`",
                                 "fragments are what bonds hold together, and there are no 'bonds'");
    }
    if (volume->kind == PLS_NODE_MAP)
    {
        const pls_node *box = pls_node_get(volume, "box");
        collection->volume_kind = PLS_VOLUME_BOX;
        collection->lower = pls_scene_vector(box, "lower");
        collection->upper = pls_scene_vector(box, "upper");
        bool empty = !(collection->lower.x < collection->upper.x && collection->lower.y < collection->upper.y);
        if (empty || (scene->dimension == 3 && !(collection->lower.z < collection->upper.z)))
            return pls_node_fail(pls_node_get(box, "upper"), NULL,
                                 "the box's upper corner must lie above its lower corner along every axis");
    }
    else if (volume->numeric)
    {
        collection->volume_kind = PLS_VOLUME_VALUE;
        collection->volume = volume->number;
    }
    else
        collection->volume_kind = strcmp(volume->text, "periodic") == 0 ? PLS_VOLUME_PERIODIC : PLS_VOLUME_BOUNDING_BOX;
    if (collection->volume_kind == PLS_VOLUME_PERIODIC && !pls_node_get(scene->root, "domain"))
        return pls_node_fail(volume, "give `domain`", "the volume of the periodic box is asked for, but there is no 'domain'");
    return PLS_OK;
}

/// Names of body fields, at most 16.
static pls_status parse_fields(const pls_node *list, const char *what, char names[16][PLS_NAME_SIZE], int *count)
{
    *count = 0;
    if (!list) return PLS_OK;
    if (list->count > 16) return pls_node_fail(list, NULL, "at most 16 %s can be given, not %zu", what, list->count);
    for (size_t k = 0; k < list->count; ++k)
    {
        const char *name = list->child[k]->text;
        if (!pls_field_find(PLS_TABLE_BODIES, name))
        {
            const char *candidates[64];
            size_t fields, known = 0;
            const pls_field *field = pls_fields(PLS_TABLE_BODIES, &fields);
            for (; known < fields && known < 64; ++known) candidates[known] = field[known].name;
            char hint[700];
            pls_scene_hint(hint, sizeof hint, name, "there are", candidates, known);
            return pls_node_fail(list->child[k], hint, "unknown body field '%.80s'", name);
        }
        snprintf(names[(*count)++], PLS_NAME_SIZE, "%s", name);
    }
    return PLS_OK;
}

/// An observer of a plugin.
static pls_status parse_own(const pls_scene *scene, const pls_node *node, pls_observer_def *def, const char **name)
{
    const pls_node *map;
    const pls_observer_ops *ops = pls_scene_named_operations(&scene->observer_ops, node, &map);
    const pls_node *group = pls_node_get(map, "bodies");
    *name = ops->name;
    PLS_TRY(check_group(scene, group));
    def->own = (pls_own_def){.ops = ops, .given = true};
    snprintf(def->own.group, sizeof def->own.group, "%s", group->text);
    pls_scene_parameters(ops->parameters, map, def->own.values);
    double constants[PLS_MAX_VALUES] = {0.0};
    if (!ops->prepare) return PLS_OK; // what the table cannot tell is said with its place in the scene
    return pls_node_context(ops->prepare(def->own.values, scene->dimension, constants), map, "'%s'", ops->name);
}

static pls_status parse_kind(const pls_scene *scene, const pls_node *node, pls_observer_def *def, const char **name)
{
    const pls_node *particle = pls_node_get(node, "particle"), *checkpoint = pls_node_get(node, "checkpoint");
    if (checkpoint)
    {
        def->kind = PLS_OBSERVE_CHECKPOINT;
        *name = "checkpoint";
        return parse_schedule(checkpoint, &def->schedule);
    }
    PLS_TRY(parse_schedule(node, &def->schedule));
    if (pls_node_get(node, "collection"))
    {
        def->kind = PLS_OBSERVE_COLLECTION;
        *name = "collection";
        return parse_collection(scene, node, def);
    }
    if (particle)
    {
        def->kind = PLS_OBSERVE_PARTICLE;
        *name = particle->text;
        PLS_TRY(check_group(scene, particle));
        snprintf(def->particle.group, sizeof def->particle.group, "%s", particle->text);
        return parse_fields(pls_node_get(node, "quantities"), "quantities", def->particle.quantities, &def->particle.quantity_count);
    }
    if (!pls_node_get(node, "frames"))
    {
        def->kind = PLS_OBSERVE_OWN;
        return parse_own(scene, node, def, name);
    }
    def->kind = PLS_OBSERVE_FRAMES;
    *name = "frames";
    def->frames.contacts = pls_scene_boolean(node, "contacts", false);
    return parse_fields(pls_node_get(node, "fields"), "fields", def->frames.fields, &def->frames.field_count);
}

static bool name_taken(const pls_scene *scene, const char *name)
{
    for (size_t k = 0; k < scene->observer_count; ++k)
    {
        if (strcmp(scene->observers[k].name, name) == 0) return true;
    }
    return false;
}

static pls_status take_given_name(const pls_scene *scene, const pls_node *node, pls_observer_def *def)
{
    const pls_node *given = pls_node_get(node, "name");
    if (!given) return PLS_OK;
    if (name_taken(scene, given->text))
        return pls_node_fail(given, "give one of them another name", "there is an observer '%s' already", given->text);
    snprintf(def->name, sizeof def->name, "%s", given->text);
    return PLS_OK;
}

/// The usual name, with _2, _3, ... behind it when it is taken.
static void make_name(const pls_scene *scene, const char *usual, pls_observer_def *def)
{
    char name[PLS_NAME_SIZE];
    snprintf(name, sizeof name, "%s", usual);
    for (int k = 2; name_taken(scene, name); ++k) snprintf(name, sizeof name, "%.51s_%d", usual, k);
    memcpy(def->name, name, sizeof name);
}

pls_status pls_scene_parse_observers(pls_scene *scene)
{
    const pls_node *list = pls_node_get(scene->root, "observe");
    if (!list) return PLS_OK;
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->observers, list->count, sizeof *scene->observers, "observers"));
    scene->observer_count = list->count;
    const char **usual;
    PLS_TRY(pls_arena_allocate(&scene->arena, &usual, list->count, sizeof *usual, "names of observers"));
    for (size_t k = 0; k < list->count; ++k)
    {
        PLS_TRY(parse_kind(scene, list->child[k], &scene->observers[k], &usual[k]));
        PLS_TRY(take_given_name(scene, list->child[k], &scene->observers[k]));
    }
    for (size_t k = 0; k < list->count; ++k)
    {
        pls_observer_def *def = &scene->observers[k];
        if (!*def->name) make_name(scene, usual[k], def);
    }
    return PLS_OK;
}
