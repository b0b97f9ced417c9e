// collection_series.c -- a collection as columns: which component of pls_collection goes where is said once, in `each_column`, which
// both names the columns and reads the values.

#include "observe/series.h"

#include "base/alloc.h"
#include "observe/sums.h"

#include <stdio.h>

/// Where columns go: names and units while the series is made, values while it runs. Both null: only counted.
typedef struct column_sink
{
    pls_series_column *columns;
    double *values;
    size_t count;
} column_sink;

/// Axis letters of components are appended to the name: ("sigma", "xz").
static void put(column_sink *sink, const char *name, const char *axes, const char *unit, double value)
{
    if (sink->columns)
    {
        pls_series_column *column = &sink->columns[sink->count];
        snprintf(column->name, sizeof column->name, "%s%s%s", name, axes[0] ? "_" : "", axes);
        snprintf(column->unit, sizeof column->unit, "%s", unit);
    }
    if (sink->values) sink->values[sink->count] = value;
    ++sink->count;
}

static const char axis_letters[] = "xyz";

static void put_tensor(column_sink *sink, const char *name, const char *unit, const double tensor[3][3], int dimension)
{
    for (int i = 0; i < dimension; ++i)
    {
        for (int j = 0; j < dimension; ++j)
        {
            put(sink, name, (char[3]){axis_letters[i], axis_letters[j], 0}, unit, tensor[i][j]);
        }
    }
}

static void put_tangent(column_sink *sink, const double tangent[3][3][3][3], int dimension)
{
    const int squared = dimension * dimension;
    for (int k = 0; k < squared * squared; ++k)
    {
        int a = k / (squared * dimension);
        int b = k / squared % dimension;
        int c = k / dimension % dimension;
        int d = k % dimension;
        const char axes[5] = {axis_letters[a], axis_letters[b], axis_letters[c], axis_letters[d], 0};
        put(sink, "D", axes, "Pa", tangent[a][b][c][d]);
    }
}

static void put_energies(column_sink *sink, const pls_collection *c, bool bonded)
{
    put(sink, "energy_kinetic", "", "J", c->energy_kinetic);
    put(sink, "energy_rotation", "", "J", c->energy_rotation);
    put(sink, "energy_normal", "", "J", c->energy_normal);
    put(sink, "energy_shear", "", "J", c->energy_shear);
    put(sink, "energy_potential", "", "J", c->energy_potential);
    put(sink, "energy_damped", "", "J", c->energy_damped);
    put(sink, "energy_slid", "", "J", c->energy_slid);
    if (bonded) put(sink, "energy_bonds", "", "J", c->energy_bonds);
    if (bonded) put(sink, "energy_broken", "", "J", c->energy_broken);
    double mechanical = c->energy_kinetic + c->energy_rotation + c->energy_normal + c->energy_shear + c->energy_potential;
    put(sink, "energy_total", "", "J", mechanical + c->energy_damped + c->energy_slid + c->energy_bonds + c->energy_broken);
}

static void put_momentum(column_sink *sink, const pls_collection *c, int dimension)
{
    const double linear[3] = {c->momentum.x, c->momentum.y, c->momentum.z};
    const double angular[3] = {c->angular_momentum.x, c->angular_momentum.y, c->angular_momentum.z};
    for (int axis = 0; axis < dimension; ++axis) put(sink, "momentum", (char[2]){axis_letters[axis], 0}, "kg m/s", linear[axis]);
    for (int axis = dimension == 3 ? 0 : 2; axis < 3; ++axis)
    {
        put(sink, "angular_momentum", (char[2]){axis_letters[axis], 0}, "kg m^2/s", angular[axis]);
    }
}

static void put_fragments(column_sink *sink, const pls_fragments *f, int dimension)
{
    const double momentum[3] = {f->momentum.x, f->momentum.y, f->momentum.z};
    put(sink, "fragments", "", "", (double)f->count);
    put(sink, "fragments_of_one", "", "", (double)f->single);
    put(sink, "fragment_mean", "", "kg", f->mean);
    put(sink, "fragment_largest", "", "kg", f->largest);
    put(sink, "fragment_second", "", "kg", f->second);
    put(sink, "fragment_largest_bodies", "", "", (double)f->bodies);
    for (int axis = 0; axis < dimension; ++axis)
        put(sink, "fragment_largest_momentum", (char[2]){axis_letters[axis], 0}, "kg m/s", momentum[axis]);
}

/// `bonded`: there are bonds in the world.
static void each_column(column_sink *sink, const pls_collection *c, unsigned quantities, int dimension, bool bonded)
{
    if (quantities & PLS_MEASURE_STRESS) put_tensor(sink, "sigma", "Pa", c->stress, dimension);
    if (quantities & PLS_MEASURE_TANGENT) put_tangent(sink, c->tangent, dimension);
    if (quantities & PLS_MEASURE_FABRIC) put_tensor(sink, "fabric", "", c->fabric, dimension);
    if (quantities & PLS_MEASURE_COORDINATION)
    {
        put(sink, "coordination", "", "", c->coordination);
        put(sink, "contacts", "", "", (double)c->contacts);
    }
    if (quantities & PLS_MEASURE_ENERGY) put_energies(sink, c, bonded);
    if (quantities & PLS_MEASURE_MOMENTUM) put_momentum(sink, c, dimension);
    if (quantities & PLS_MEASURE_POROSITY) put(sink, "porosity", "", "", c->porosity);
    if (quantities & PLS_MEASURE_MASS)
    {
        put(sink, "bodies", "", "", (double)c->bodies);
        put(sink, "mass", "", "kg", c->mass);
    }
    if (quantities & PLS_MEASURE_FRAGMENTS) put_fragments(sink, &c->fragments, dimension);
    put(sink, "volume", "", "m^3", c->volume);
}

static pls_status collection_values(void *context, pls_world *world, double *values)
{
    const pls_collection_def *def = context;
    pls_collection measured;
    PLS_TRY(pls_measure_collection(world, def, &measured));
    column_sink sink = {.values = values};
    each_column(&sink, &measured, def->quantities, pls_world_dimension(world), pls_world_has_bonds(world));
    return PLS_OK;
}

static void collection_destroy(void *context) { pls_release(&context); }

/// The names of the columns and a copy of the definition; `series` owns what was allocated, also when this fails.
static pls_status make_columns(const pls_collection_def *def, int dimension, bool bonded, pls_series *series)
{
    const pls_collection nothing = {0};
    column_sink count = {0};
    each_column(&count, &nothing, def->quantities, dimension, bonded);
    PLS_TRY(pls_allocate(&series->columns, count.count, sizeof *series->columns, "columns of a collection"));
    series->column_count = count.count;
    column_sink sink = {.columns = series->columns};
    each_column(&sink, &nothing, def->quantities, dimension, bonded);

    pls_collection_def *copy = NULL;
    PLS_TRY(pls_allocate(&copy, 1, sizeof *copy, "a collection"));
    *copy = *def;
    series->context = copy;
    series->values = collection_values;
    series->destroy = collection_destroy;
    return PLS_OK;
}

pls_status pls_series_collection(pls_world *world, const pls_collection_def *def, pls_series *series)
{
    *series = (pls_series){0};
    pls_selection selection;
    if ((def->quantities & PLS_MEASURE_FRAGMENTS) && !pls_world_has_bonds(world))
        return pls_fail(
            PLS_INVALID_ARGUMENT,
            "a collection of '%s' asks for fragments, but there are no bonds: leave 'fragments' out of its quantities, or give bonds",
            def->group[0] ? def->group : "all");
    PLS_TRY(pls_select(world, def, &selection)); // what is wrong with the definition is said now, not at the first look
    pls_status status = make_columns(def, pls_world_dimension(world), pls_world_has_bonds(world), series);
    if (status != PLS_OK) pls_series_free(series);
    return status;
}

void pls_series_free(pls_series *series)
{
    if (series->destroy) series->destroy(series->context);
    pls_release(&series->columns);
    *series = (pls_series){0};
}
