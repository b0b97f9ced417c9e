// frame.c -- bodies of a world as columns, in order of their numbers; what is read back is in vtk_read.c.

#include "io/frame.h"

#include <stdio.h>
#include <string.h>

const char *const pls_frame_wall_fields[] = {"number", "group", "shape", "material", "position", "orientation", "scale", "velocity", NULL};

static bool is_unbounded(const pls_field_view *radius, uint32_t row)
{
    double r;
    memcpy(&r, (const char *)radius->data + row * radius->stride, sizeof r);
    return isinf(r);
}

static void sort_rows(pls_frame_rows *rows, const pls_field_view *radius, const uint32_t *row_of, size_t numbers)
{
    for (size_t number = 0; number < numbers; ++number)
    {
        uint32_t row = row_of[number];
        if (row == UINT32_MAX) continue;
        if (is_unbounded(radius, row))
            rows->wall[rows->wall_count++] = row;
        else
            rows->body[rows->body_count++] = row;
    }
}

pls_status pls_frame_rows_find(pls_frame_rows *rows, pls_world *world)
{
    *rows = (pls_frame_rows){0};
    pls_field_view radius;
    PLS_TRY(pls_world_body_field(world, "radius", &radius));
    size_t numbers;
    const uint32_t *row_of = pls_world_rows_by_number(world, &numbers);
    pls_status status = pls_allocate(&rows->body, numbers, sizeof *rows->body, "the rows of a frame");
    if (status == PLS_OK) status = pls_allocate(&rows->wall, numbers, sizeof *rows->wall, "the rows of a frame");
    if (status == PLS_OK) sort_rows(rows, &radius, row_of, numbers);
    if (status != PLS_OK) pls_frame_rows_free(rows);
    return status;
}

void pls_frame_rows_free(pls_frame_rows *rows)
{
    pls_release(&rows->body);
    pls_release(&rows->wall);
    *rows = (pls_frame_rows){0};
}

pls_status pls_frame_gather(pls_frame_column *column, const pls_world *world, const char *field, const uint32_t *row, size_t count)
{
    pls_field_view view;
    PLS_TRY(pls_world_body_field(world, field, &view));
    *column = (pls_frame_column){.type = view.type, .components = view.components, .rows = count};
    snprintf(column->name, sizeof column->name, "%s", field);
    size_t size = (size_t)view.components * pls_type_size(view.type);
    PLS_TRY(pls_allocate(&column->data, count, size, "a field of a frame"));
    for (size_t k = 0; k < count; ++k) memcpy((char *)column->data + k * size, (const char *)view.data + row[k] * view.stride, size);
    return PLS_OK;
}

/// Gather into a new column of the frame.
static pls_status take(pls_frame *frame, const pls_world *world, const char *prefix, const char *field, const uint32_t *row, size_t count)
{
    PLS_TRY(pls_reserve(&frame->column, &frame->capacity, frame->count + 1, sizeof *frame->column, "the fields of a frame"));
    pls_frame_column *column = &frame->column[frame->count];
    PLS_TRY(pls_frame_gather(column, world, field, row, count));
    ++frame->count;
    snprintf(column->name, sizeof column->name, "%s%s", prefix, field);
    return PLS_OK;
}

static pls_status take_all(pls_frame *frame, const pls_world *world, const pls_frame_rows *rows)
{
    size_t count;
    const pls_field *field = pls_fields(PLS_TABLE_BODIES, &count);
    for (size_t f = 0; f < count; ++f) PLS_TRY(take(frame, world, "", field[f].name, rows->body, rows->body_count));
    for (const char *const *name = pls_frame_wall_fields; *name; ++name)
        PLS_TRY(take(frame, world, PLS_WALL_PREFIX, *name, rows->wall, rows->wall_count));
    return PLS_OK;
}

pls_status pls_frame_take(pls_frame *frame, pls_world *world)
{
    *frame = (pls_frame){.time = pls_world_time(world)};
    pls_frame_rows rows;
    pls_status status = pls_frame_rows_find(&rows, world);
    if (status == PLS_OK) status = take_all(frame, world, &rows);
    pls_frame_rows_free(&rows);
    if (status != PLS_OK) pls_frame_free(frame);
    return status;
}

void pls_frame_free(pls_frame *frame)
{
    for (size_t k = 0; k < frame->count; ++k) pls_release(&frame->column[k].data);
    pls_release(&frame->column);
    *frame = (pls_frame){0};
}

const pls_frame_column *pls_frame_find(const pls_frame *frame, const char *name)
{
    for (size_t k = 0; k < frame->count; ++k)
    {
        if (strcmp(frame->column[k].name, name) == 0) return &frame->column[k];
    }
    return NULL;
}

double pls_frame_value(const pls_frame_column *column, size_t row, int component)
{
    size_t k = row * (size_t)column->components + (size_t)component;
    switch (column->type)
    {
        case PLS_F64: return ((const double *)column->data)[k];
        case PLS_F32: return (double)((const float *)column->data)[k];
        case PLS_U32: return ((const uint32_t *)column->data)[k];
        case PLS_U16: return ((const uint16_t *)column->data)[k];
        case PLS_U8: return ((const uint8_t *)column->data)[k];
    }
    return NAN;
}

pls_vec3 pls_frame_vector(const pls_frame_column *column, size_t row)
{
    return pls_vec(pls_frame_value(column, row, 0), pls_frame_value(column, row, 1), pls_frame_value(column, row, 2));
}
