// own_series.c -- a series whose columns and values come from a user's functions.
//
// The functions keep nothing. What they remember from look to look is an array of this series, which the run writes to checkpoints; only `update` changes it,
// so that the values of now can be asked for any number of times.

#include "observe/series.h"

#include "base/alloc.h"
#include "observe/group.h"

#include <stdio.h>
#include <string.h>

typedef struct own_series
{
    const pls_observer_ops *ops;
    pls_group_id group;
    int dimension;
    double constants[PLS_MAX_VALUES];
    double memory[PLS_OBSERVER_MAX_MEMORY];
    double *row; ///< of all columns, in 2D too
} own_series;

static const char name_letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789.-";

static size_t count_columns(const pls_observer_ops *ops)
{
    size_t count = 0;
    while (ops->columns[count].name) ++count;
    return count;
}

static pls_status check_column(const pls_observer_ops *ops, size_t k)
{
    const pls_observer_column *column = &ops->columns[k];
    size_t size = strlen(column->name);
    if (size == 0 || size >= sizeof((pls_series_column *)0)->name || strspn(column->name, name_letters) != size)
        return pls_fail(PLS_PLUGIN, "the observer '%s' has a column '%.80s': names are letters, digits, '_', '.' and '-', at most 95",
                        ops->name, column->name);
    if (column->unit && (strlen(column->unit) >= sizeof((pls_series_column *)0)->unit || strpbrk(column->unit, ",\"[]\r\n")))
        return pls_fail(PLS_PLUGIN, "the observer '%s' has a column '%s' in '%.40s', which cannot be a unit", ops->name, column->name,
                        column->unit);
    for (size_t j = 0; j < k; ++j)
        if (strcmp(ops->columns[j].name, column->name) == 0)
            return pls_fail(PLS_PLUGIN, "the observer '%s' has two columns '%s'", ops->name, column->name);
    if (strcmp(column->name, "time") == 0)
        return pls_fail(PLS_PLUGIN, "the observer '%s' has a column 'time'; every series has that by itself", ops->name);
    return PLS_OK;
}

pls_status pls_observer_ops_check(const pls_observer_ops *ops)
{
    if (ops->api_version != PLS_API_VERSION)
        return pls_fail(PLS_VERSION,
                        "the observer '%s' is made for version %u of the plugin interface; this is version %d: compile it anew",
                        ops->name ? ops->name : "?", ops->api_version, PLS_API_VERSION);
    if (!ops->name || !ops->look || !ops->columns || !ops->columns[0].name)
        return pls_fail(PLS_PLUGIN, "the observer '%s' lacks one of name, look, columns", ops->name ? ops->name : "?");
    if (ops->memory < 0 || ops->memory > PLS_OBSERVER_MAX_MEMORY)
        return pls_fail(PLS_PLUGIN, "the observer '%s' wants to remember %d numbers; at most %d are possible", ops->name, ops->memory,
                        PLS_OBSERVER_MAX_MEMORY);
    if ((ops->memory > 0) != (ops->update != NULL))
        return pls_fail(PLS_PLUGIN, "the observer '%s' %s", ops->name,
                        ops->update ? "has update, but no memory that it could bring up to date"
                                    : "has memory, but no update that would fill it");
    for (size_t k = 0; ops->columns[k].name; ++k) PLS_TRY(check_column(ops, k));
    return PLS_OK;
}

static pls_observer_view view_of(const own_series *own, const pls_world *world)
{
    return (pls_observer_view){.world = world, .constants = own->constants, .group = own->group, .dimension = own->dimension};
}

static pls_status own_update(void *context, pls_world *world)
{
    own_series *own = context;
    pls_observer_view view = view_of(own, world);
    return own->ops->update(&view, own->memory);
}

static pls_status own_values(void *context, pls_world *world, double *values)
{
    own_series *own = context;
    pls_observer_view view = view_of(own, world);
    double memory[PLS_OBSERVER_MAX_MEMORY]; // a copy: what is not to be changed cannot be
    memcpy(memory, own->memory, sizeof memory);
    size_t count = count_columns(own->ops);
    for (size_t k = 0; k < count; ++k) own->row[k] = NAN; // what is not filled shows
    PLS_TRY(own->ops->look(&view, memory, own->row));
    for (size_t k = 0; k < count; ++k)
        if (own->dimension == 3 || !own->ops->columns[k].only_3d) *values++ = own->row[k];
    return PLS_OK;
}

static void own_destroy(void *context)
{
    own_series *own = context;
    if (own) pls_release(&own->row);
    pls_release(&own);
}

static pls_status prepare(const pls_own_def *def, own_series *own)
{
    double values[PLS_MAX_VALUES] = {0.0};
    char owner[PLS_NAME_SIZE + 16];
    if (pls_parameter_values(own->ops->parameters) > PLS_MAX_VALUES)
        return pls_fail(PLS_LIMIT_EXCEEDED, "it has more than %d values", PLS_MAX_VALUES);
    if (def->given)
        memcpy(values, def->values, sizeof values);
    else
        pls_parameters_default(own->ops->parameters, values);
    snprintf(owner, sizeof owner, "observer '%.63s'", own->ops->name);
    PLS_TRY(pls_parameters_check(own->ops->parameters, values, owner));
    if (own->ops->prepare) return own->ops->prepare(values, own->dimension, own->constants);
    memcpy(own->constants, values, sizeof values);
    return PLS_OK;
}

static pls_status make_columns(const own_series *own, pls_series *series)
{
    size_t count = count_columns(own->ops);
    PLS_TRY(pls_allocate(&series->columns, count, sizeof *series->columns, "columns of an observer"));
    for (size_t k = 0; k < count; ++k)
    {
        const pls_observer_column *column = &own->ops->columns[k];
        if (own->dimension == 2 && column->only_3d) continue;
        pls_series_column *made = &series->columns[series->column_count++];
        snprintf(made->name, sizeof made->name, "%s", column->name);
        snprintf(made->unit, sizeof made->unit, "%s", column->unit ? column->unit : "");
    }
    return PLS_OK;
}

static pls_status make_own(pls_world *world, const pls_own_def *def, pls_series *series)
{
    own_series *own = NULL;
    PLS_TRY(pls_allocate(&own, 1, sizeof *own, "an observer"));
    *own = (own_series){.ops = def->ops, .dimension = pls_world_dimension(world)};
    series->context = own;
    series->destroy = own_destroy;
    series->values = own_values;
    series->update = own->ops->update ? own_update : NULL;
    series->memory = own->memory;
    series->memory_count = (size_t)own->ops->memory;
    PLS_TRY(pls_allocate(&own->row, count_columns(own->ops), sizeof *own->row, "a row of an observer"));
    PLS_TRY(pls_find_observed_group(world, def->group, &own->group.index1));
    PLS_TRY(prepare(def, own));
    return make_columns(own, series);
}

pls_status pls_series_own(pls_world *world, const pls_own_def *def, pls_series *series)
{
    *series = (pls_series){0};
    if (!def->ops) return pls_fail(PLS_INVALID_ARGUMENT, "it has no operations");
    PLS_TRY(pls_observer_ops_check(def->ops));
    pls_status status = make_own(world, def, series);
    if (status != PLS_OK) pls_series_free(series);
    return status;
}
