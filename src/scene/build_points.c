// build_points.c -- stiffness, toughness and heat of points of bonds, by expressions.

#include "scene/build.h"

#include <string.h>

/// What all of these may be written in; the reader of the scene has seen to it that each keeps to its own.
enum { USES = PLS_USES_TIME | PLS_USES_PLACE | PLS_USES_CHANCE | PLS_USES_TEMPERATURE };

/// In the order of pls_scene_symbols.
enum { TIME, X, CHANCE = X + 3, TEMPERATURE, VARIABLES };

/// The user of a set of bonds. Formulas that are not needed are null.
typedef struct points
{
    pls_formula *condition; ///< stiffness, toughness
    pls_formula *initial, *source;
    pls_formula *held; ///< of each entry whether, and at what
    size_t held_count;
} points;

static void drop(void *user)
{
    points *p = user;
    pls_formula_drop(p->condition);
    pls_formula_drop(p->initial);
    pls_formula_drop(p->source);
    pls_formula_drop(p->held);
    pls_release(&p);
}

static void take_variables(const pls_point_batch *batch, size_t k, double variables[VARIABLES])
{
    variables[TIME] = batch->time;
    for (int c = 0; c < 3; ++c) variables[X + c] = batch->place[c][k];
    variables[CHANCE] = batch->chance[k];
    variables[TEMPERATURE] = batch->temperature[k];
}

/// What to do with the values of point k.
typedef void value_action(const double *values, size_t k, void *context);

static pls_status each_point(pls_formula *formula, const pls_point_batch *batch, value_action *action, void *context)
{
    pls_formula_copy *copy;
    PLS_TRY(pls_formula_begin(formula, &copy));
    pls_status status = PLS_OK;
    for (size_t k = 0; status == PLS_OK && k < batch->count; ++k)
    {
        double variables[VARIABLES], values[PLS_MAX_VALUES];
        take_variables(batch, k, variables);
        status = pls_formula_values(formula, copy, variables, values);
        if (status == PLS_OK) action(values, k, context);
    }
    pls_formula_end(formula, copy);
    return status;
}

typedef struct two
{
    double *stiffness, *toughness;
} two;

static void put_two(const double *values, size_t k, void *context)
{
    const two *to = context;
    to->stiffness[k] = values[0];
    to->toughness[k] = values[1];
}

static pls_status ask_condition(void *user, const pls_point_batch *batch, double *stiffness, double *toughness)
{
    two to = {stiffness, toughness};
    return each_point(((points *)user)->condition, batch, put_two, &to);
}

static void put_one(const double *values, size_t k, void *context) { ((double *)context)[k] = values[0]; }

static pls_status ask_initial(void *user, const pls_point_batch *batch, double *values)
{
    return each_point(((points *)user)->initial, batch, put_one, values);
}

static pls_status ask_source(void *user, const pls_point_batch *batch, double *values)
{
    return each_point(((points *)user)->source, batch, put_one, values);
}

typedef struct holding
{
    size_t count;
    double *values;
} holding;

static void put_held(const double *values, size_t k, void *context)
{
    const holding *to = context;
    to->values[k] = NAN;
    for (size_t n = 0; n < to->count; ++n)
        if (values[2 * n] != 0.0) to->values[k] = values[2 * n + 1];
}

static pls_status ask_held(void *user, const pls_point_batch *batch, double *values)
{
    holding to = {((points *)user)->held_count, values};
    return each_point(((points *)user)->held, batch, put_held, &to);
}

static pls_status make(const pls_builder *b, const char *const *texts, size_t count, pls_formula **formula)
{
    const char *names[PLS_EXPRESSION_VARIABLES];
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(b->scene, USES, NULL, names, &symbols));
    return pls_formula_make(texts, count, &symbols, formula);
}

/// Whether a key says more than its default.
static bool says(const pls_node *map, const char *key, double initial)
{
    const pls_node *node = pls_node_get(map, key);
    return node && (node->formula || node->number != initial);
}

static pls_status make_condition(const pls_builder *b, const pls_node *bonds, points *p, pls_bonds_def *def)
{
    char number[2][32];
    const char *texts[2] = {"1", pls_build_component(pls_node_get(bonds, "toughness"), 0, number[1])};
    if (!says(bonds, "stiffness", 1.0) && !says(bonds, "toughness", 1.0)) return PLS_OK;
    if (pls_node_get(bonds, "stiffness"))
        texts[0] = pls_build_component(pls_node_get(bonds, "stiffness"), 0, number[0]); // of beams there is none
    PLS_TRY(make(b, texts, 2, &p->condition));
    if (pls_formula_uses(p->condition, TEMPERATURE) && !pls_node_get(bonds, "heat"))
        return pls_node_fail(bonds, "give the entry `heat`", "'stiffness' or 'toughness' names the temperature, but these bonds have none");
    def->condition = ask_condition;
    def->condition_changes = pls_formula_uses(p->condition, TIME) || pls_formula_uses(p->condition, TEMPERATURE);
    return PLS_OK;
}

static pls_status make_held(const pls_builder *b, const pls_node *list, points *p)
{
    char number[PLS_MAX_VALUES / 2][32];
    const char *texts[PLS_MAX_VALUES];
    if (list->count > PLS_MAX_VALUES / 2)
        return pls_node_fail(list, "one expression may hold several: x < 0 ? 300 : 400", "at most %d entries can hold temperatures",
                             PLS_MAX_VALUES / 2);
    for (size_t k = 0; k < list->count; ++k)
    {
        const pls_node *where = pls_node_get(list->child[k], "where");
        texts[2 * k] = where ? where->text : "1";
        texts[2 * k + 1] = pls_build_component(pls_node_get(list->child[k], "temperature"), 0, number[k]);
    }
    p->held_count = list->count;
    return make(b, texts, 2 * list->count, &p->held);
}

static pls_status make_heat(const pls_builder *b, const pls_node *heat, points *p, pls_bonds_def *def)
{
    const pls_node *held = pls_node_get(heat, "held"), *reference = pls_node_get(heat, "reference");
    char number[32];
    const char *text;
    def->heat.conductivity = pls_scene_number(heat, "conductivity", 0.0);
    def->heat.capacity = pls_scene_number(heat, "capacity", 0.0);
    def->heat.expansion = pls_scene_number(heat, "expansion", 0.0);
    if (reference && reference->numeric) def->heat.reference = reference->number;
    if (says(heat, "initial", 0.0))
    {
        text = pls_build_component(pls_node_get(heat, "initial"), 0, number);
        PLS_TRY(make(b, &text, 1, &p->initial));
        def->heat.initial = ask_initial;
    }
    if (says(heat, "source", 0.0))
    {
        text = pls_build_component(pls_node_get(heat, "source"), 0, number);
        PLS_TRY(make(b, &text, 1, &p->source));
        def->heat.source = ask_source;
    }
    if (!held || held->count == 0) return PLS_OK;
    PLS_TRY(make_held(b, held, p));
    def->heat.held = ask_held;
    return PLS_OK;
}

pls_status pls_build_points(const pls_builder *b, const pls_node *bonds, pls_bonds_def *def)
{
    const pls_node *heat = pls_node_get(bonds, "heat");
    points *p;
    PLS_TRY(pls_allocate(&p, 1, sizeof *p, "expressions of bonds"));
    pls_status status = make_condition(b, bonds, p, def);
    if (status == PLS_OK && heat) status = make_heat(b, heat, p, def);
    if (status != PLS_OK)
    {
        drop(p);
        return status;
    }
    def->seed = (uint64_t)pls_scene_number(bonds, "seed", 1.0);
    def->user = p;
    def->release = drop;
    return PLS_OK;
}
