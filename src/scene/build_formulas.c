// build_formulas.c -- functions that the world calls during a run, made of the scene's expressions, and their contexts.
//
// Each context holds a reference to a formula (a pool of compiled copies, formula.c), so the world may call from any thread. The order of
// the variables is that of pls_scene_symbols. A context is freed by the world through its `destroy`.

#include "scene/build.h"

#include <stdio.h>
#include <string.h>

const char *pls_build_component(const pls_node *vector, size_t k, char number[32])
{
    if (!vector) return NULL;
    const pls_node *node = vector->kind == PLS_NODE_LIST ? (k < vector->count ? vector->child[k] : NULL) : k == 0 ? vector : NULL;
    if (!node) return NULL;
    if (node->numeric) return pls_format_double(number, node->number);
    return node->formula ? node->text : NULL;
}

/// Places of the states that expressions can name, in the order of pls_scene_symbols.
static size_t state_places(const pls_builder *b, size_t places[PLS_EXPRESSION_VARIABLES])
{
    size_t count = 0;
    for (size_t k = 0; k < b->scene->state_count && count < PLS_EXPRESSION_VARIABLES; ++k)
    {
        if (b->scene->state_names[k]) places[count++] = b->first_state[k];
    }
    return count;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// values over t and states

typedef struct timely
{
    pls_formula *formula;
    size_t state_count;
    size_t place[PLS_EXPRESSION_VARIABLES];
    char name[PLS_NAME_SIZE];
    double minimum, maximum;
    bool open;
    char range[128]; ///< in words
} timely;

static pls_status timely_value(void *context, double time, const double *states, double *value)
{
    const timely *f = context;
    double variables[PLS_EXPRESSION_VARIABLES + 1] = {time};
    for (size_t k = 0; k < f->state_count; ++k) variables[1 + k] = states[f->place[k]];
    PLS_TRY(pls_formula_once(f->formula, variables, value));
    if ((f->open ? *value > f->minimum : *value >= f->minimum) && *value <= f->maximum) return PLS_OK;
    return pls_fail(PLS_EXPRESSION, "'%s' is %g at t = %g s, but must be %s", f->name, *value, time, f->range);
}

static void timely_destroy(void *context)
{
    timely *f = context;
    if (f) pls_formula_drop(f->formula);
    pls_release(&f);
}

static pls_status make_timely(const pls_builder *b, const pls_key *key, const pls_node *node, timely **context)
{
    const char *names[PLS_EXPRESSION_VARIABLES];
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(b->scene, PLS_USES_TIME | PLS_USES_STATES, NULL, names, &symbols));
    PLS_TRY(pls_allocate(context, 1, sizeof **context, "a formula"));
    timely *f = *context;
    f->state_count = state_places(b, f->place);
    f->minimum = key->minimum;
    f->maximum = key->maximum;
    f->open = key->flags & PLS_KEY_OPEN_MINIMUM;
    snprintf(f->name, sizeof f->name, "%s", key->name);
    pls_schema_range(key, f->range);
    pls_status status = pls_formula_make(&node->text, 1, &symbols, &f->formula);
    if (status == PLS_OK) return PLS_OK;
    timely_destroy(f);
    *context = NULL;
    return status;
}

pls_status pls_build_initial_value(const pls_builder *b, const pls_key *key, const pls_node *node, double *value)
{
    *value = node->number;
    if (!node->formula) return PLS_OK;
    timely *f;
    PLS_TRY(make_timely(b, key, node, &f));
    pls_status status = timely_value(f, 0.0, b->initial_states, value);
    timely_destroy(f);
    return pls_node_context(status, node, "the expression");
}

pls_status pls_build_bind_material(const pls_builder *b, pls_material_id material, const pls_key *key, const pls_node *node)
{
    timely *f;
    PLS_TRY(make_timely(b, key, node, &f));
    return pls_node_context(pls_world_bind_material_value(b->world, material, key->name, timely_value, f, timely_destroy), node, "'%s'",
                            key->name);
}

pls_status pls_build_bind_law(const pls_builder *b, pls_material_id i, pls_material_id j, const pls_key *key, const pls_node *node)
{
    timely *f;
    PLS_TRY(make_timely(b, key, node, &f));
    return pls_node_context(pls_world_bind_law_parameter(b->world, i, j, key->name, timely_value, f, timely_destroy), node, "'%s'",
                            key->name);
}

pls_status pls_build_bind_force(const pls_builder *b, pls_force_id force, const pls_key *key, const pls_node *node)
{
    timely *f;
    PLS_TRY(make_timely(b, key, node, &f));
    return pls_node_context(pls_world_bind_force_parameter(b->world, force, key->name, timely_value, f, timely_destroy), node, "'%s'",
                            key->name);
}

pls_status pls_build_each_formula(const pls_builder *b, const pls_parameter *table, const pls_node *map, pls_build_action *action,
                                  void *context)
{
    size_t place = 0;
    for (const pls_parameter *row = table; row && row->name; ++row)
    {
        if (row->kind != PLS_PARAMETER_NUMBER) continue;
        const pls_node *node = pls_node_get(map, row->name);
        bool vector = node->kind == PLS_NODE_LIST;
        for (size_t c = 0; c < (vector ? node->count : 1); ++c)
        {
            const pls_node *number = vector ? node->child[c] : node;
            if (!number->formula) continue;
            char initial[32], name[PLS_NAME_SIZE + 8];
            pls_key key = pls_schema_parameter(row, 0, initial);
            snprintf(name, sizeof name, vector ? "%s[%zu]" : "%s", row->name, c);
            key.name = name;
            PLS_TRY(action(b, &key, number, place + c, context));
        }
        place += vector ? 3 : 1;
    }
    return PLS_OK;
}

static pls_status take_initial(const pls_builder *b, const pls_key *key, const pls_node *node, size_t place, void *values)
{
    return pls_build_initial_value(b, key, node, (double *)values + place);
}

pls_status pls_build_initial_values(const pls_builder *b, const pls_parameter *table, const pls_node *map, double *values)
{
    pls_scene_parameters(table, map, values);
    return pls_build_each_formula(b, table, map, take_initial, values);
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// motion

typedef struct driven
{
    pls_formula *formula;   ///< three translations, three rotations
    bool displacement;      ///< the translations are a path, not a velocity
    const pls_world *world; ///< for its time step
    double end;             ///< of the run [s]
} driven;

/// Velocity from a path: the central difference over one step. Positions follow by the midpoint rule, so with it the body lies on the path
/// after every step.
static pls_status path_velocity(const driven *d, double time, double *v)
{
    double dt = pls_world_dt(d->world), before[6], after[6];
    if (!(dt > 0.0)) dt = 1e-9 * d->end; // not yet chosen: only the velocity at the start is asked for
    double from = fmax(time - dt / 2.0, 0.0), to = time + dt / 2.0;
    PLS_TRY(pls_formula_once(d->formula, &from, before));
    PLS_TRY(pls_formula_once(d->formula, &to, after));
    for (size_t k = 0; k < 3; ++k) v[k] = (after[k] - before[k]) / (to - from);
    return PLS_OK;
}

static pls_status driven_velocity(void *context, double time, pls_vec3 *velocity, pls_vec3 *angular_velocity)
{
    const driven *d = context;
    double v[6];
    PLS_TRY(pls_formula_once(d->formula, &time, v));
    if (d->displacement) PLS_TRY(path_velocity(d, time, v));
    *velocity = pls_vec(v[0], v[1], v[2]);
    *angular_velocity = pls_vec(v[3], v[4], v[5]);
    return PLS_OK;
}

static void driven_destroy(void *context)
{
    driven *d = context;
    if (d) pls_formula_drop(d->formula);
    pls_release(&d);
}

pls_status pls_build_motion_formula(const pls_builder *b, const pls_node *motion, pls_formula **formula)
{
    const pls_node *path = pls_node_get(motion, "displacement"), *spin = pls_node_get(motion, "angular_velocity");
    if (!path) path = pls_node_get(motion, "velocity");
    bool flat = b->scene->dimension == 2;
    char numbers[6][32];
    const char *texts[6], *names[PLS_EXPRESSION_VARIABLES];
    for (size_t k = 0; k < 3; ++k)
    {
        texts[k] = pls_build_component(path, k, numbers[k]);
        texts[3 + k] = flat ? (k == 2 ? pls_build_component(spin, 0, numbers[5]) : NULL) : pls_build_component(spin, k, numbers[3 + k]);
    }
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(b->scene, PLS_USES_TIME, NULL, names, &symbols));
    return pls_formula_make(texts, 6, &symbols, formula);
}

pls_status pls_build_motion_context(const pls_builder *b, const pls_node *motion, pls_formula *formula, pls_motion_def *def)
{
    driven *d;
    PLS_TRY(pls_allocate(&d, 1, sizeof *d, "a prescribed motion"));
    *d = (driven){pls_formula_share(formula), pls_node_get(motion, "displacement") != NULL, b->world, b->scene->end};
    def->function = driven_velocity;
    def->destroy = driven_destroy;
    def->context = d;
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// states

typedef struct rate_function
{
    pls_formula *formula;
    bool own; ///< the state's own name is a variable too, beside s
    size_t state_count;
    size_t place[PLS_EXPRESSION_VARIABLES];
} rate_function;

static pls_status state_rate(void *context, const pls_state_point *at, const double *values, double *rate)
{
    const rate_function *f = context;
    double variables[PLS_EXPRESSION_VARIABLES + 12] = {at->time,       at->position.x, at->position.y, at->position.z, at->velocity.x,
                                                       at->velocity.y, at->velocity.z, at->radius,     values[0]};
    size_t count = 9;
    if (f->own) variables[count++] = values[0];
    for (size_t k = 0; k < f->state_count; ++k) variables[count++] = at->all[f->place[k]];
    return pls_formula_once(f->formula, variables, rate);
}

static void rate_destroy(void *context)
{
    rate_function *f = context;
    if (f) pls_formula_drop(f->formula);
    pls_release(&f);
}

static pls_status make_rate(const pls_builder *b, const pls_scene_state *state, pls_formula **formula)
{
    size_t count;
    const pls_key *key = pls_schema_keys("state_radius", &count); // its first row is the rate
    const char *names[PLS_EXPRESSION_VARIABLES];
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(b->scene, key->uses, state->each ? state->name : NULL, names, &symbols));
    char number[32];
    const char *text = pls_build_component(state->rate, 0, number);
    return pls_formula_make(&text, 1, &symbols, formula);
}

static pls_status add_state(const pls_builder *b, size_t k, size_t copy, pls_formula *formula)
{
    const pls_scene_state *state = &b->scene->states[k];
    pls_state_def def = pls_default_state_def();
    if (state->each)
        snprintf(def.name, sizeof def.name, "%.52s_%zu", state->name, copy);
    else
        snprintf(def.name, sizeof def.name, "%s", state->name);
    if (state->body != PLS_OF_WORLD)
    {
        size_t index;
        PLS_TRY(pls_build_state_body(b, state, copy, &index));
        def.body = b->ids[b->first_body[state->body] + index];
    }
    def.components = 1;
    def.initial[0] = b->initial_states[b->first_state[k] + copy];
    def.target = state->target;
    def.keep_density = state->keep_density;
    rate_function *f;
    PLS_TRY(pls_allocate(&f, 1, sizeof *f, "a state's rate"));
    f->formula = pls_formula_share(formula);
    f->own = state->each;
    f->state_count = state_places(b, f->place);
    def.rate = state_rate;
    def.destroy = rate_destroy;
    def.context = f;
    pls_state_id id;
    return pls_world_add_state(b->world, &def, &id);
}

pls_status pls_build_states(const pls_builder *b)
{
    for (size_t k = 0; k < b->scene->state_count; ++k)
    {
        const pls_scene_state *state = &b->scene->states[k];
        pls_formula *formula;
        PLS_TRY(make_rate(b, state, &formula));
        pls_status status = PLS_OK;
        for (size_t copy = 0; status == PLS_OK && copy < b->state_counts[k]; ++copy) status = add_state(b, k, copy, formula);
        pls_formula_drop(formula);
        PLS_TRY(pls_node_context(status, state->node, "state '%s'", state->name));
    }
    return PLS_OK;
}
