// csv_points.c -- bodies from a table: a header line with the names of the columns, then one line per body.

#include "base/atomic_file.h"
#include "scene/generators.h"

#include <stdio.h>
#include <string.h>

typedef enum column {
    COLUMN_X,
    COLUMN_Y,
    COLUMN_Z,
    COLUMN_RADIUS,
    COLUMN_SCALE,
    COLUMN_VX,
    COLUMN_VY,
    COLUMN_VZ,
    COLUMN_WX,
    COLUMN_WY,
    COLUMN_WZ,
    COLUMN_QW,
    COLUMN_QX,
    COLUMN_QY,
    COLUMN_QZ,
    COLUMN_VOLUME,
    COLUMN_COUNT
} column;

static const char *const names[COLUMN_COUNT] = {"x",  "y",  "z",  "radius", "scale", "vx", "vy", "vz",
                                                "wx", "wy", "wz", "qw",     "qx",    "qy", "qz", "volume"};

typedef struct table
{
    const char *path;
    const pls_scene *scene;
    const pls_scene_body *body;
    int dimension;
    char *at; ///< rest of the text
    int line;
    int columns;
    column kind[COLUMN_COUNT]; ///< of each column of the file
    bool has[COLUMN_COUNT];
} table;

/// Next line that is not empty and no comment (#), or null. Cuts the text.
static char *next_line(table *t)
{
    while (*t->at)
    {
        char *line = t->at, *end = strchr(line, '\n');
        ++t->line;
        if (end) *end = '\0';
        t->at = end ? end + 1 : line + strlen(line);
        size_t size = strlen(line);
        if (size > 0 && line[size - 1] == '\r') line[size - 1] = '\0';
        line += strspn(line, " \t");
        if (*line && *line != '#') return line;
    }
    return NULL;
}

/// Cut the next field of a line, without the blanks around it; null after the last one.
static char *next_field(char **line)
{
    if (!*line) return NULL;
    char *field = *line, *comma = strchr(field, ',');
    if (comma) *comma = '\0';
    *line = comma ? comma + 1 : NULL;
    field += strspn(field, " \t");
    size_t size = strlen(field);
    while (size > 0 && (field[size - 1] == ' ' || field[size - 1] == '\t')) field[--size] = '\0';
    return field;
}

static pls_status add_column(table *t, const char *field)
{
    int k = 0;
    while (k < COLUMN_COUNT && strcmp(names[k], field) != 0) ++k;
    if (k == COLUMN_COUNT)
    {
        char hint[300];
        pls_scene_hint(hint, sizeof hint, field, "columns", names, COLUMN_COUNT);
        return pls_fail(PLS_SCENE, "%s:%d: unknown column '%.64s'\n  %s", t->path, t->line, field, hint);
    }
    if (t->has[k]) return pls_fail(PLS_SCENE, "%s:%d: the column '%s' is there twice", t->path, t->line, field);
    bool flat = t->dimension == 2;
    bool only_3d = k == COLUMN_Z || k == COLUMN_VZ || k == COLUMN_WX || k == COLUMN_WY || k == COLUMN_QX || k == COLUMN_QY;
    if (flat && only_3d) return pls_fail(PLS_SCENE, "%s:%d: the column '%s' has no meaning with dimension: 2", t->path, t->line, field);
    t->has[k] = true;
    t->kind[t->columns++] = (column)k;
    return PLS_OK;
}

static pls_status read_header(table *t)
{
    char *line = next_line(t), *field;
    if (!line) return pls_fail(PLS_SCENE, "%s: the table is empty; its first line names the columns: x,y,z,radius", t->path);
    while ((field = next_field(&line))) PLS_TRY(add_column(t, field));
    for (int k = COLUMN_X; k <= (t->dimension == 3 ? COLUMN_Z : COLUMN_Y); ++k)
    {
        if (!t->has[k]) return pls_fail(PLS_SCENE, "%s:%d: the column '%s' is missing", t->path, t->line, names[k]);
    }
    if (t->has[COLUMN_RADIUS] && t->has[COLUMN_SCALE])
        return pls_fail(PLS_SCENE, "%s:%d: the columns 'radius' and 'scale' exclude each other", t->path, t->line);
    return PLS_OK;
}

static pls_status read_row(const table *t, char *line, double values[COLUMN_COUNT])
{
    memset(values, 0, COLUMN_COUNT * sizeof *values);
    int fields = 1;
    for (const char *c = line; *c; ++c) fields += *c == ',';
    if (fields != t->columns) return pls_fail(PLS_SCENE, "%s:%d: %d values in a table of %d columns", t->path, t->line, fields, t->columns);
    for (int k = 0; k < t->columns; ++k)
    {
        const char *field = next_field(&line);
        const char *name = names[t->kind[k]];
        double *value = &values[t->kind[k]];
        if (!pls_parse_double(field, value) || !isfinite(*value))
            return pls_fail(PLS_SCENE, "%s:%d: '%.64s' in column '%s' is not a number", t->path, t->line, field, name);
        bool size = t->kind[k] == COLUMN_RADIUS || t->kind[k] == COLUMN_SCALE || t->kind[k] == COLUMN_VOLUME;
        if (size && !(*value > 0.0))
            return pls_fail(PLS_SCENE, "%s:%d: '%s' must be greater than 0, not %s", t->path, t->line, name, field);
    }
    return PLS_OK;
}

static pls_status allocate_rows(const table *t, pls_points *points, size_t rows)
{
    points->count = rows;
    bool size = t->has[COLUMN_RADIUS] || t->has[COLUMN_SCALE];
    bool velocity = t->has[COLUMN_VX] || t->has[COLUMN_VY] || t->has[COLUMN_VZ],
         spin = t->has[COLUMN_WX] || t->has[COLUMN_WY] || t->has[COLUMN_WZ];
    bool turn = t->has[COLUMN_QW] || t->has[COLUMN_QX] || t->has[COLUMN_QY] || t->has[COLUMN_QZ];
    PLS_TRY(pls_allocate(&points->position, rows, sizeof *points->position, "places of bodies"));
    if (size) PLS_TRY(pls_allocate(&points->scale, rows, sizeof *points->scale, "sizes of bodies"));
    if (t->has[COLUMN_VOLUME]) PLS_TRY(pls_allocate(&points->volume, rows, sizeof *points->volume, "volumes of points"));
    if (velocity) PLS_TRY(pls_allocate(&points->velocity, rows, sizeof *points->velocity, "velocities of bodies"));
    if (spin) PLS_TRY(pls_allocate(&points->angular_velocity, rows, sizeof *points->angular_velocity, "velocities of bodies"));
    if (turn) PLS_TRY(pls_allocate(&points->orientation, rows, sizeof *points->orientation, "orientations of bodies"));
    return PLS_OK;
}

static pls_status keep_row(const table *t, const double *v, pls_points *points, size_t row)
{
    const double scale = pls_scene_number(t->body->node, "scale", 1.0);
    points->position[row] = pls_vec(v[COLUMN_X], v[COLUMN_Y], v[COLUMN_Z]);
    if (points->scale)
        points->scale[row] = t->has[COLUMN_RADIUS] ? v[COLUMN_RADIUS] / pls_points_radius(t->scene, t->body, row) : v[COLUMN_SCALE] * scale;
    if (points->velocity) points->velocity[row] = pls_vec(v[COLUMN_VX], v[COLUMN_VY], v[COLUMN_VZ]);
    if (points->angular_velocity) points->angular_velocity[row] = pls_vec(v[COLUMN_WX], v[COLUMN_WY], v[COLUMN_WZ]);
    if (points->volume) points->volume[row] = v[COLUMN_VOLUME];
    if (!points->orientation) return PLS_OK;
    pls_quat q = {v[COLUMN_QW], v[COLUMN_QX], v[COLUMN_QY], v[COLUMN_QZ]};
    if (!(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z > 0.0))
        return pls_fail(PLS_SCENE, "%s:%d: the quaternion is zero", t->path, t->line);
    points->orientation[row] = pls_quat_unit(q);
    return PLS_OK;
}

static pls_status read_table(table *t, pls_points *points)
{
    PLS_TRY(read_header(t));
    size_t rows = 0;
    for (const char *c = t->at; *c; ++c) rows += *c == '\n' || c[1] == '\0';
    PLS_TRY(allocate_rows(t, points, rows));
    points->count = 0;
    for (char *line = next_line(t); line; line = next_line(t))
    {
        double values[COLUMN_COUNT];
        PLS_TRY(read_row(t, line, values));
        PLS_TRY(keep_row(t, values, points, points->count));
        ++points->count;
    }
    if (points->count == 0) return pls_fail(PLS_SCENE, "%s: the table holds no bodies", t->path);
    return PLS_OK;
}

pls_status pls_points_csv(const pls_scene *scene, const pls_scene_body *body, const pls_node *csv, pls_points *points)
{
    const pls_node *file = pls_node_get(csv, "file");
    table t = {.path = file->text, .scene = scene, .body = body, .dimension = scene->dimension};
    char *text;
    size_t size;
    pls_status status = pls_read_file(file->text, &text, &size);
    if (status != PLS_OK) return pls_node_context(status, file, "the table");
    t.at = text;
    status = memchr(text, '\0', size) ? pls_fail(PLS_SCENE, "%s: not a text file", t.path) : read_table(&t, points);
    pls_release(&text);
    return status;
}
