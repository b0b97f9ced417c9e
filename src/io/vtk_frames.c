// vtk_frames.c -- what a frame holds: bodies as points with fields from the field table, contacts as lines.

#include "base/registry.h"
#include "step/contact_view.h"
#include "io/vtk.h"

#include <string.h>

/// Memory rows of the bodies in a frame, in order of their numbers.
typedef struct body_rows
{
    uint32_t *row;
    size_t count;
} body_rows;

static bool is_unbounded(const pls_field_view *radius, uint32_t row)
{
    double r;
    memcpy(&r, (const char *)radius->data + row * radius->stride, sizeof r);
    return isinf(r);
}

static pls_status find_rows(pls_world *world, body_rows *rows)
{
    *rows = (body_rows){0};
    pls_field_view radius;
    PLS_TRY(pls_world_body_field(world, "radius", &radius));
    size_t numbers;
    const uint32_t *row_of = pls_world_rows_by_number(world, &numbers);
    PLS_TRY(pls_allocate(&rows->row, numbers, sizeof *rows->row, "the rows of a frame"));
    for (size_t number = 0; number < numbers; ++number)
    {
        uint32_t row = row_of[number];
        if (row != UINT32_MAX && !is_unbounded(&radius, row)) rows->row[rows->count++] = row;
    }
    return PLS_OK;
}

/// Gather one field in order of numbers and add it.
static pls_status add_field(pls_vtk *vtk, pls_vtk_section section, pls_world *world, const body_rows *rows, const char *name)
{
    pls_field_view view;
    PLS_TRY(pls_world_body_field(world, name, &view));
    size_t size = (size_t)view.components * pls_type_size(view.type);
    char *packed = NULL;
    PLS_TRY(pls_allocate(&packed, rows->count, size, "a field of a frame"));
    for (size_t k = 0; k < rows->count; ++k) memcpy(packed + k * size, (const char *)view.data + rows->row[k] * view.stride, size);
    pls_status status = pls_vtk_add(vtk, section, name, view.type, view.components, rows->count, packed);
    pls_release(&packed);
    return status;
}

static bool is_requested(const pls_frames_def *def, const char *name)
{
    for (int k = 0; k < def->field_count; ++k)
    {
        if (strcmp(def->fields[k], name) == 0) return true;
    }
    return false;
}

/// The points themselves carry the position.
static bool is_position(const char *name) { return strcmp(name, "position") == 0; }

static pls_status check_requested(const pls_frames_def *def)
{
    for (int k = 0; k < def->field_count; ++k)
    {
        if (pls_field_find(PLS_TABLE_BODIES, def->fields[k])) continue;
        size_t count;
        const pls_field *field = pls_fields(PLS_TABLE_BODIES, &count);
        const char *names[64];
        size_t known = count < 64 ? count : 64;
        for (size_t f = 0; f < known; ++f) names[f] = field[f].name;
        const char *near = pls_nearest_word(def->fields[k], names, known);
        return pls_fail(PLS_NOT_FOUND,
                        "frames ask for the field '%s', which bodies do not have%s%s%s; the fields are listed in docs/fields.md",
                        def->fields[k], near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "");
    }
    return PLS_OK;
}

static pls_status fill_bodies(pls_vtk *vtk, pls_world *world, const pls_frames_def *def, const body_rows *rows)
{
    PLS_TRY(add_field(vtk, PLS_VTK_POINTS, world, rows, "position"));
    size_t count;
    const pls_field *field = pls_fields(PLS_TABLE_BODIES, &count);
    for (size_t f = 0; f < count; ++f)
    {
        if (is_position(field[f].name)) continue;
        if (!(field[f].flags & PLS_FIELD_FRAME) && !is_requested(def, field[f].name)) continue;
        PLS_TRY(add_field(vtk, PLS_VTK_POINT_DATA, world, rows, field[f].name));
    }
    return pls_vtk_add_vertices(vtk, rows->count);
}

pls_status pls_vtk_write_bodies(const char *path, pls_world *world, const pls_frames_def *def)
{
    PLS_TRY(check_requested(def));
    pls_vtk vtk = {0};
    body_rows rows = {0};
    pls_status status = find_rows(world, &rows);
    if (status == PLS_OK) status = fill_bodies(&vtk, world, def, &rows);
    if (status == PLS_OK) status = pls_vtk_write(&vtk, path, pls_world_time(world));
    pls_release(&rows.row);
    pls_vtk_free(&vtk);
    return status;
}

/// Columns of the contacts, filled from the view.
typedef struct contact_columns
{
    pls_vec3 *ends; ///< two per contact
    pls_vec3 *force;
    double *delta, *normal_force;
    uint32_t *body_i, *body_j;
} contact_columns;

static pls_status allocate_columns(contact_columns *c, size_t count)
{
    PLS_TRY(pls_allocate(&c->ends, 2 * count, sizeof *c->ends, "the contacts of a frame"));
    PLS_TRY(pls_allocate(&c->force, count, sizeof *c->force, "the contacts of a frame"));
    PLS_TRY(pls_allocate(&c->delta, count, sizeof *c->delta, "the contacts of a frame"));
    PLS_TRY(pls_allocate(&c->normal_force, count, sizeof *c->normal_force, "the contacts of a frame"));
    PLS_TRY(pls_allocate(&c->body_i, count, sizeof *c->body_i, "the contacts of a frame"));
    return pls_allocate(&c->body_j, count, sizeof *c->body_j, "the contacts of a frame");
}

static pls_status fill_columns(contact_columns *c, pls_world *world, const pls_contact_view *view)
{
    pls_field_view position;
    PLS_TRY(pls_world_body_field(world, "position", &position));
    for (size_t k = 0; k < view->count; ++k)
    {
        const pls_contact_entry *e = &view->entry[k];
        memcpy(&c->ends[2 * k], (const char *)position.data + e->row_i * position.stride, sizeof(pls_vec3));
        c->ends[2 * k + 1] = pls_add(c->ends[2 * k], e->branch);
        c->force[k] = e->force;
        c->delta[k] = e->delta;
        c->normal_force[k] = -pls_dot(e->force, e->normal); // the normal points away from i: repulsion is positive
        c->body_i[k] = e->number_i;
        c->body_j[k] = e->number_j;
    }
    return PLS_OK;
}

static pls_status add_columns(pls_vtk *vtk, const contact_columns *c, size_t count)
{
    PLS_TRY(pls_vtk_add(vtk, PLS_VTK_POINTS, "position", PLS_F64, 3, 2 * count, c->ends));
    PLS_TRY(pls_vtk_add_lines(vtk, count));
    PLS_TRY(pls_vtk_add(vtk, PLS_VTK_CELL_DATA, "body_i", PLS_U32, 1, count, c->body_i));
    PLS_TRY(pls_vtk_add(vtk, PLS_VTK_CELL_DATA, "body_j", PLS_U32, 1, count, c->body_j));
    PLS_TRY(pls_vtk_add(vtk, PLS_VTK_CELL_DATA, "delta", PLS_F64, 1, count, c->delta));
    PLS_TRY(pls_vtk_add(vtk, PLS_VTK_CELL_DATA, "force", PLS_F64, 3, count, c->force));
    return pls_vtk_add(vtk, PLS_VTK_CELL_DATA, "normal_force", PLS_F64, 1, count, c->normal_force);
}

pls_status pls_vtk_write_contacts(const char *path, pls_world *world)
{
    pls_vtk vtk = {0};
    pls_contact_view view = {0};
    contact_columns columns = {0};
    pls_status status = pls_contact_view_make(world, &view);
    if (status == PLS_OK) status = allocate_columns(&columns, view.count);
    if (status == PLS_OK) status = fill_columns(&columns, world, &view);
    if (status == PLS_OK) status = add_columns(&vtk, &columns, view.count);
    if (status == PLS_OK) status = pls_vtk_write(&vtk, path, pls_world_time(world));
    pls_release(&columns.ends);
    pls_release(&columns.force);
    pls_release(&columns.delta);
    pls_release(&columns.normal_force);
    pls_release(&columns.body_i);
    pls_release(&columns.body_j);
    pls_contact_view_free(&view);
    pls_vtk_free(&vtk);
    return status;
}
