// particle.c -- tracked bodies: any field of the body table, for each body of a group, as columns.
//
// The bodies are chosen when the series is made, in order of their numbers; a body that is removed later leaves NaN in its columns.

#include "observe/series.h"

#include "base/alloc.h"
#include "observe/group.h"

#include <stdio.h>
#include <string.h>

enum { MOST_QUANTITIES = sizeof(((pls_particle_def *)0)->quantities) / PLS_NAME_SIZE, LIST_SIZE = 600, MOST_FIELDS = 64 };

/// A tracked body: its number, and which of the bodies that have borne the number.
typedef struct tracked_body
{
    uint32_t number, generation;
} tracked_body;

typedef struct particle_series
{
    const pls_field *quantity[MOST_QUANTITIES];
    size_t quantity_count;
    tracked_body *body;
    size_t body_count;
} particle_series;

static pls_status particle_values(void *context, pls_world *world, double *values)
{
    const particle_series *series = context;
    size_t numbers;
    const uint32_t *row_of = pls_world_rows_by_number(world, &numbers);
    pls_field_view generation;
    pls_field_view view[MOST_QUANTITIES];
    PLS_TRY(pls_world_body_field(world, "generation", &generation));
    for (size_t q = 0; q < series->quantity_count; ++q) PLS_TRY(pls_world_body_field(world, series->quantity[q]->name, &view[q]));

    for (size_t b = 0; b < series->body_count; ++b)
    {
        const tracked_body *body = &series->body[b];
        uint32_t row = body->number < numbers ? row_of[body->number] : UINT32_MAX;
        bool there = row != UINT32_MAX && pls_field_value(&generation, row, 0) == (double)body->generation;
        for (size_t q = 0; q < series->quantity_count; ++q)
        {
            for (int c = 0; c < view[q].components; ++c) *values++ = there ? pls_field_value(&view[q], row, c) : NAN;
        }
    }
    return PLS_OK;
}

static void particle_destroy(void *context)
{
    particle_series *series = context;
    pls_release(&series->body);
    pls_release(&series);
}

static pls_status find_quantity(const char *name, const pls_field **field)
{
    *field = pls_field_find(PLS_TABLE_BODIES, name);
    if (*field) return PLS_OK;
    const char *names[MOST_FIELDS];
    size_t count;
    const pls_field *fields = pls_fields(PLS_TABLE_BODIES, &count);
    if (count > MOST_FIELDS) count = MOST_FIELDS;
    for (size_t k = 0; k < count; ++k) names[k] = fields[k].name;
    char list[LIST_SIZE];
    pls_describe_names(list, sizeof list, name, names, count);
    return pls_fail(PLS_NOT_FOUND, "bodies have no quantity '%s'%s", name, list);
}

static pls_status find_bodies(pls_world *world, const char *name, particle_series *series)
{
    uint32_t group;
    size_t numbers;
    pls_field_view group_of;
    pls_field_view generation;
    PLS_TRY(pls_find_observed_group(world, name, &group));
    PLS_TRY(pls_world_body_field(world, "group", &group_of));
    PLS_TRY(pls_world_body_field(world, "generation", &generation));
    const uint32_t *row_of = pls_world_rows_by_number(world, &numbers);
    PLS_TRY(pls_allocate(&series->body, pls_world_body_count(world), sizeof *series->body, "tracked bodies"));
    for (size_t number = 0; number < numbers; ++number)
    {
        uint32_t row = row_of[number];
        if (row == UINT32_MAX || (group != 0 && pls_field_value(&group_of, row, 0) != (double)group)) continue;
        series->body[series->body_count++] = (tracked_body){(uint32_t)number, (uint32_t)pls_field_value(&generation, row, 0)};
    }
    if (series->body_count == 0) return pls_fail(PLS_NOT_FOUND, "the group '%s' has no bodies to track", name);
    return PLS_OK;
}

/// x y z of a vector, w x y z of a quaternion, a number's place in anything else.
static void component_name(char name[16], const pls_field *field, int c)
{
    name[0] = '\0';
    if (field->components == 1) return;
    if (field->components == 3)
        snprintf(name, 16, "_%c", "xyz"[c]);
    else if (field->components == 4)
        snprintf(name, 16, "_%c", "wxyz"[c]);
    else
        snprintf(name, 16, "_%d", c);
}

static void name_columns(const particle_series *series, pls_series_column *column)
{
    for (size_t b = 0; b < series->body_count; ++b)
    {
        for (size_t q = 0; q < series->quantity_count; ++q)
        {
            const pls_field *field = series->quantity[q];
            for (int c = 0; c < field->components; ++c, ++column)
            {
                char body[32] = "";
                char axis[16];
                if (series->body_count > 1) snprintf(body, sizeof body, "%zu.", b);
                component_name(axis, field, c);
                snprintf(column->name, sizeof column->name, "%s%s%s", body, field->name, axis);
                snprintf(column->unit, sizeof column->unit, "%s", field->unit);
            }
        }
    }
}

static pls_status make_columns(pls_world *world, const pls_particle_def *def, particle_series *particles, pls_series *series)
{
    if (def->quantity_count < 1 || def->quantity_count > MOST_QUANTITIES)
    {
        return pls_fail(PLS_INVALID_ARGUMENT, "a particle observer takes 1 to %d quantities, not %d", (int)MOST_QUANTITIES,
                        def->quantity_count);
    }
    size_t per_body = 0;
    for (int q = 0; q < def->quantity_count; ++q)
    {
        PLS_TRY(find_quantity(def->quantities[q], &particles->quantity[q]));
        per_body += (size_t)particles->quantity[q]->components;
    }
    particles->quantity_count = (size_t)def->quantity_count;
    PLS_TRY(find_bodies(world, def->group, particles));
    PLS_TRY(pls_allocate(&series->columns, particles->body_count * per_body, sizeof *series->columns, "columns of tracked bodies"));
    series->column_count = particles->body_count * per_body;
    name_columns(particles, series->columns);
    return PLS_OK;
}

pls_status pls_series_particle(pls_world *world, const pls_particle_def *def, pls_series *series)
{
    *series = (pls_series){0};
    particle_series *particles = NULL;
    PLS_TRY(pls_allocate(&particles, 1, sizeof *particles, "a particle observer"));
    series->values = particle_values;
    series->destroy = particle_destroy;
    series->context = particles;
    pls_status status = make_columns(world, def, particles, series);
    if (status != PLS_OK) pls_series_free(series);
    return status;
}
