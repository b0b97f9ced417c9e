// vtk_frames.c -- what a frame holds: bodies as points with fields from the field table, contacts as lines.

#include "base/registry.h"
#include "step/contact_view.h"
#include "io/frame.h"
#include "io/vtk.h"

#include <stdio.h>
#include <string.h>

/// Gather one field in order of numbers and add it under the name `prefix` field.
static pls_status add_field(pls_vtk *vtk, pls_vtk_section section, pls_world *world, const uint32_t *row, size_t count, const char *prefix,
                            const char *field)
{
    pls_frame_column column = {0};
    char name[2 * PLS_NAME_SIZE];
    PLS_TRY(pls_frame_gather(&column, world, field, row, count));
    snprintf(name, sizeof name, "%s%s", prefix, field);
    pls_status status = pls_vtk_add(vtk, section, name, column.type, column.components, count, column.data);
    pls_release(&column.data);
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

static pls_status fill_bodies(pls_vtk *vtk, pls_world *world, const pls_frames_def *def, const pls_frame_rows *rows)
{
    PLS_TRY(add_field(vtk, PLS_VTK_POINTS, world, rows->body, rows->body_count, "", "position"));
    size_t count;
    const pls_field *field = pls_fields(PLS_TABLE_BODIES, &count);
    for (size_t f = 0; f < count; ++f)
    {
        if (is_position(field[f].name)) continue;
        const unsigned usual = pls_world_has_bonds(world) ? PLS_FIELD_FRAME | PLS_FIELD_BONDED : PLS_FIELD_FRAME;
        if (!(field[f].flags & usual) && !is_requested(def, field[f].name)) continue;
        PLS_TRY(add_field(vtk, PLS_VTK_POINT_DATA, world, rows->body, rows->body_count, "", field[f].name));
    }
    for (const char *const *name = pls_frame_wall_fields; rows->wall_count > 0 && *name; ++name)
        PLS_TRY(add_field(vtk, PLS_VTK_FIELD_DATA, world, rows->wall, rows->wall_count, PLS_WALL_PREFIX, *name));
    return pls_vtk_add_vertices(vtk, rows->body_count);
}

pls_status pls_vtk_write_bodies(const char *path, pls_world *world, const pls_frames_def *def)
{
    PLS_TRY(check_requested(def));
    pls_vtk vtk = {0};
    pls_frame_rows rows = {0};
    pls_status status = pls_frame_rows_find(&rows, world);
    if (status == PLS_OK) status = fill_bodies(&vtk, world, def, &rows);
    if (status == PLS_OK) status = pls_vtk_write(&vtk, path, pls_world_time(world));
    pls_frame_rows_free(&rows);
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
