// condition.c -- conditions of points asked of the user, and heat: conduction as in Bobaru and Duangpanya (2010), with the weights of the mechanical families.
//
//     rho c V_i T_i' = sum_j G_ij (T_j - T_i) + V_i source,      G_ij = k d w beta V_i V_j (1/m_i + 1/m_j)
//
// which for full families is k laplace T. T advances by T(t + h) = T(t) + h (3/2 T'(t) - 1/2 T'(t - h)).

#include "bond/condition.h"

#include "base/alloc.h"
#include "base/random.h"

#include <math.h>
#include <string.h>

enum { BATCH = 32 };
static const double no_temperature = 1e12; ///< [K]: hotter than anything that is simulated

void pls_conditions_free(pls_conditions *c)
{
    pls_release(&c->row);
    pls_release(&c->chance);
    pls_release(&c->warmth);
    pls_release(&c->conduction);
    pls_release(&c->capacity);
    pls_release(&c->expansion);
    pls_release(&c->reference);
    if (c->release) c->release(c->user);
    memset(c, 0, sizeof *c);
}

size_t pls_conditions_bytes(const pls_conditions *c, const pls_families *family)
{
    if (!c->row) return 0;
    const size_t per_heat = sizeof *c->warmth + sizeof *c->capacity + sizeof *c->expansion + sizeof *c->reference;
    return (family->count + family->ghosts) * sizeof *c->row + family->count * (sizeof *c->chance + (c->warmth ? per_heat : 0)) +
           (c->conduction ? (size_t)family->start[family->count] * PLS_BOND_VECTOR * sizeof *c->conduction : 0);
}

/// Points first .. first + count, as the user sees them.
typedef struct batch
{
    double place[3][BATCH], temperature[BATCH];
    pls_point_batch points;
} batch;

static void fill(const pls_conditions *c, const pls_families *family, size_t first, size_t count, double time, batch *b)
{
    for (size_t k = 0; k < count; ++k)
    {
        for (int a = 0; a < 3; ++a) b->place[a][k] = family->point[first + k].x[a];
        b->temperature[k] = c->warmth ? c->warmth[first + k][PLS_HEAT_TEMPERATURE] : 0.0;
    }
    b->points = (pls_point_batch){.count = count,
                                  .time = time,
                                  .place = {b->place[0], b->place[1], b->place[2]},
                                  .chance = c->chance + first,
                                  .temperature = b->temperature};
}

static pls_status wrong(const pls_families *family, size_t p, const char *what, double value, const char *must)
{
    const pls_bond_point *point = &family->point[p];
    return pls_fail(PLS_INVALID_ARGUMENT, "the %s of body %u, bonded at (%g, %g, %g) m, is %g; it must be %s", what, point->number,
                    point->x[0], point->x[1], point->x[2], value, must);
}

static pls_status ask_condition(pls_conditions *c, const pls_families *family, size_t first, size_t count, double time)
{
    batch b;
    double stiffness[BATCH], toughness[BATCH];
    fill(c, family, first, count, time, &b);
    PLS_TRY(c->function(c->user, &b.points, stiffness, toughness));
    for (size_t k = 0; k < count; ++k)
    {
        if (!(stiffness[k] > 0.0) || !isfinite(stiffness[k])) return wrong(family, first + k, "stiffness", stiffness[k], "positive");
        if (!(toughness[k] > 0.0) || isnan(toughness[k])) return wrong(family, first + k, "toughness", toughness[k], "positive");
        c->row[first + k][PLS_CONDITION_STIFFNESS] = stiffness[k];
        c->row[first + k][PLS_CONDITION_TOUGHNESS] = toughness[k];
    }
    return PLS_OK;
}

/// Values of the user for a batch; only NaN where `or_free` may be no number.
static pls_status ask_values(const pls_conditions *c, const pls_families *family, pls_point_value *function, size_t first, size_t count,
                             double time, bool or_free, const char *what, double *values)
{
    batch b;
    fill(c, family, first, count, time, &b);
    PLS_TRY(function(c->user, &b.points, values));
    for (size_t k = 0; k < count; ++k)
        if (!isfinite(values[k]) && !(or_free && isnan(values[k]))) return wrong(family, first + k, what, values[k], "a number");
    return PLS_OK;
}

static pls_status hold(pls_conditions *c, const pls_families *family, size_t first, size_t count, double time)
{
    double value[BATCH];
    PLS_TRY(ask_values(c, family, c->heat.held, first, count, time, true, "temperature held", value));
    for (size_t k = 0; k < count; ++k)
        if (!isnan(value[k])) c->warmth[first + k][PLS_HEAT_TEMPERATURE] = value[k];
    return PLS_OK;
}

static void expand(pls_conditions *c, size_t p)
{
    c->row[p][PLS_CONDITION_STRAIN] = c->expansion[p] * (c->warmth[p][PLS_HEAT_TEMPERATURE] - c->reference[p]);
}

pls_status pls_conditions_take(pls_conditions *c, const pls_families *family, size_t first, size_t last, double time, double dt)
{
    for (size_t begin = first; begin < last; begin += BATCH)
    {
        const size_t count = last - begin < BATCH ? last - begin : BATCH;
        for (size_t p = begin; c->warmth && p < begin + count; ++p)
        {
            double *w = c->warmth[p];
            w[PLS_HEAT_TEMPERATURE] += dt * (1.5 * w[PLS_HEAT_RATE] - 0.5 * w[PLS_HEAT_BEFORE]);
            if (!(fabs(w[PLS_HEAT_TEMPERATURE]) < no_temperature))
                return pls_fail(PLS_UNSTABLE_STEP,
                                "the temperature of body %u is %g K at t = %g s: the time step of %g s is too long for what is conducted "
                                "and put in there; take a smaller dt",
                                family->point[p].number, w[PLS_HEAT_TEMPERATURE], time, dt);
        }
        if (c->warmth && c->heat.held) PLS_TRY(hold(c, family, begin, count, time));
        for (size_t p = begin; c->warmth && p < begin + count; ++p) expand(c, p);
        if (c->function && c->changes) PLS_TRY(ask_condition(c, family, begin, count, time));
    }
    return PLS_OK;
}

void pls_conditions_taken(pls_conditions *c, const pls_families *family)
{
    if (c->known && !c->changes && !c->warmth) return;
    c->known = true;
    double stiffest = 0.0;
    for (size_t p = 0; p < family->count; ++p) stiffest = fmax(stiffest, c->row[p][PLS_CONDITION_STIFFNESS]);
    c->stiffest = stiffest;
    for (size_t g = 0; g < family->ghosts; ++g) memcpy(c->row[family->count + g], c->row[family->ghost[g].point], sizeof c->row[0]);
}

pls_status pls_conditions_conduct(pls_conditions *c, const pls_families *family, size_t first, size_t last, double time, double dt)
{
    for (size_t begin = first; begin < last; begin += BATCH)
    {
        const size_t count = last - begin < BATCH ? last - begin : BATCH;
        double source[BATCH] = {0};
        if (c->heat.source) PLS_TRY(ask_values(c, family, c->heat.source, begin, count, time, false, "source of heat", source));
        for (size_t p = begin; p < begin + count; ++p)
        {
            const size_t slot = (size_t)family->start[p] * PLS_BOND_VECTOR;
            const double own = c->warmth[p][PLS_HEAT_TEMPERATURE];
            double power = family->point[p].volume * source[p - begin];
            for (size_t k = 0; k < family->size[p]; ++k)
                power +=
                    c->conduction[slot + k] * (c->warmth[pls_point_behind(family, family->partner[slot + k])][PLS_HEAT_TEMPERATURE] - own);
            double *w = c->warmth[p];
            const double rate = power / c->capacity[p];
            w[PLS_HEAT_BEFORE] = dt > 0.0 ? w[PLS_HEAT_RATE] : rate;
            w[PLS_HEAT_RATE] = rate;
        }
    }
    return PLS_OK;
}

// ---- making ----------------------------------------------------------------------------------------------------------------------------------------------

static pls_status check_heat(const pls_bonds_def *def)
{
    const pls_heat_def *h = &def->heat;
    if (!(h->conductivity >= 0.0) || !isfinite(h->conductivity))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the conductivity is %g W/(m K); it must not be negative", def->name,
                        h->conductivity);
    if (!(h->capacity > 0.0) || !isfinite(h->capacity))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the heat capacity is %g J/(kg K); it must be positive", def->name, h->capacity);
    if (!isfinite(h->expansion))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the thermal expansion is %g 1/K", def->name, h->expansion);
    return PLS_OK;
}

/// By how much a source falls per kelvin at the start, by the heat capacity: it cools as conduction does.
static pls_status find_loss(pls_conditions *c, const pls_families *family, double time)
{
    double fastest = 0.0;
    for (size_t p = 0; c->heat.source && p < family->count; p += BATCH)
    {
        const size_t count = family->count - p < BATCH ? family->count - p : BATCH;
        double now[BATCH], warmer[BATCH], own[BATCH];
        PLS_TRY(ask_values(c, family, c->heat.source, p, count, time, false, "source of heat", now));
        for (size_t k = 0; k < count; ++k) own[k] = c->warmth[p + k][PLS_HEAT_TEMPERATURE], c->warmth[p + k][PLS_HEAT_TEMPERATURE] += 1.0;
        const pls_status status = ask_values(c, family, c->heat.source, p, count, time, false, "source of heat", warmer);
        for (size_t k = 0; k < count; ++k)
        {
            c->warmth[p + k][PLS_HEAT_TEMPERATURE] = own[k];
            fastest = fmax(fastest, (now[k] - warmer[k]) * family->point[p + k].volume / c->capacity[p + k]);
        }
        PLS_TRY(status);
    }
    c->fastest += fastest;
    return PLS_OK;
}

static pls_status make_heat(pls_conditions *c, const pls_bonds_def *def, const pls_families *family, const pls_heat_material *material,
                            const uint16_t *material_of, double time)
{
    PLS_TRY(check_heat(def));
    c->heat = def->heat;
    PLS_TRY(pls_allocate(&c->warmth, family->count, sizeof *c->warmth, "heat of points"));
    PLS_TRY(pls_allocate(&c->capacity, family->count, sizeof *c->capacity, "heat of points"));
    PLS_TRY(pls_allocate(&c->expansion, family->count, sizeof *c->expansion, "heat of points"));
    PLS_TRY(pls_allocate(&c->reference, family->count, sizeof *c->reference, "heat of points"));
    for (size_t p = 0; p < family->count; ++p)
    {
        const size_t slot = (size_t)family->start[p] * PLS_BOND_VECTOR;
        const pls_heat_material *m = &material[material_of[family->point[p].number]];
        double sum = 0.0;
        for (size_t k = 0; k < family->size[p]; ++k) sum += c->conduction[slot + k] *= def->heat.conductivity;
        c->capacity[p] = m->density * family->point[p].volume * def->heat.capacity;
        c->expansion[p] = def->heat.expansion == 0.0 ? 0.0 : m->expansion * def->heat.expansion;
        if (isnan(c->expansion[p]))
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "the thermal expansion in plane strain needs the poisson_ratio of the material of body %u",
                            family->point[p].number);
        c->fastest = fmax(c->fastest, 2.0 * sum / c->capacity[p]);
    }
    for (size_t p = 0; p < family->count; p += BATCH)
    {
        const size_t count = family->count - p < BATCH ? family->count - p : BATCH;
        double value[BATCH] = {0}; // temperatures
        if (def->heat.initial) PLS_TRY(ask_values(c, family, def->heat.initial, p, count, time, false, "temperature at the start", value));
        for (size_t k = 0; k < count; ++k)
        {
            c->warmth[p + k][PLS_HEAT_TEMPERATURE] = value[k];
            c->reference[p + k] = isnan(def->heat.reference) ? value[k] : def->heat.reference;
        }
    }
    return find_loss(c, family, time);
}

static pls_status make(pls_conditions *c, const pls_bonds_def *def, const pls_families *family, const pls_heat_material *material,
                       const uint16_t *material_of, double time)
{
    PLS_TRY(pls_allocate(&c->row, family->count + family->ghosts, sizeof *c->row, "conditions of points"));
    PLS_TRY(pls_allocate(&c->chance, family->count, sizeof *c->chance, "conditions of points"));
    for (size_t p = 0; p < family->count; ++p)
    {
        pls_random random = pls_random_stream(def->seed, family->point[p].number, PLS_FOR_TOUGHNESS);
        const double drawn = pls_random_uniform(&random); // in [0, 1)
        c->chance[p] = drawn > 0.0 ? drawn : 0x1p-54;
        c->row[p][PLS_CONDITION_STIFFNESS] = c->row[p][PLS_CONDITION_TOUGHNESS] = 1.0;
    }
    if (!isnan(def->heat.conductivity)) PLS_TRY(make_heat(c, def, family, material, material_of, time));
    for (size_t p = 0; c->function && p < family->count; p += BATCH)
        PLS_TRY(ask_condition(c, family, p, family->count - p < BATCH ? family->count - p : BATCH, time));
    PLS_TRY(pls_conditions_take(c, family, 0, family->count, time, 0.0));
    pls_conditions_taken(c, family);
    return PLS_OK;
}

pls_status pls_conditions_make(pls_conditions *c, const pls_bonds_def *def, const pls_families *family, double *conduction,
                               const pls_heat_material *material, const uint16_t *material_of, double time)
{
    *c = (pls_conditions){.function = def->condition,
                          .changes = def->condition_changes,
                          .stiffest = 1.0,
                          .conduction = conduction,
                          .user = def->user,
                          .release = def->release};
    if (!def->condition && isnan(def->heat.conductivity)) return PLS_OK;
    const pls_status status = make(c, def, family, material, material_of, time);
    if (status != PLS_OK) pls_conditions_free(c);
    return status == PLS_OK ? PLS_OK : pls_fail_context(status, "bonds '%s': ", def->name);
}
