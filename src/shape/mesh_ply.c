// mesh_ply.c -- PLY (Turk, Stanford 1994), text and binary little endian.
//
// The header tells what a file holds: elements, each with properties that are numbers or lists of numbers. Used are x, y, z of the element 'vertex' and the list
// 'vertex_indices' (or 'vertex_index') of 'face'; all else is read over.

#include "shape/mesh.h"

#include "base/alloc.h"

#include <stdio.h>
#include <string.h>

enum { MOST_ELEMENTS = 16, MOST_PROPERTIES = 64, MOST_CORNERS = 4096 };

typedef enum role { ROLE_NONE, ROLE_X, ROLE_Y, ROLE_Z, ROLE_CORNERS } role;

typedef struct property
{
    int type, count_type; ///< places in `types`; count_type -1: a number
    role role;
} property;

typedef struct element
{
    char name[32];
    double count;
    int properties;
    property property[MOST_PROPERTIES];
} element;

typedef struct ply
{
    pls_mesh_text *text;
    bool binary;
    int elements;
    element element[MOST_ELEMENTS];
    char *row;     ///< rest of the line, in text
    double number; ///< of the row being read
} ply;

static const struct
{
    const char *name, *other;
    int size;
} types[] = {{"char", "int8", 1}, {"uchar", "uint8", 1}, {"short", "int16", 2},   {"ushort", "uint16", 2},
             {"int", "int32", 4}, {"uint", "uint32", 4}, {"float", "float32", 4}, {"double", "float64", 8}};

static double decode(int type, const char *at)
{
    union
    {
        int8_t c;
        uint8_t uc;
        int16_t s;
        uint16_t us;
        int32_t i;
        uint32_t u;
        float f;
        double d;
    } v = {0};
    memcpy(&v, at, (size_t)types[type].size);
    switch (type)
    {
        case 0: return v.c;
        case 1: return v.uc;
        case 2: return v.s;
        case 3: return v.us;
        case 4: return v.i;
        case 5: return v.u;
        case 6: return (double)v.f;
        default: return v.d;
    }
}

// ---- header ---------------------------------------------------------------------------------------------------------------------------------------------------

static pls_status fail_header(const ply *p, const char *what)
{
    return pls_fail(PLS_CORRUPT, "%s:%d: %s", p->text->path, p->text->line, what);
}

static pls_status read_type(const ply *p, char **line, int *type)
{
    const char *word = pls_mesh_word(line);
    for (int k = 0; word && k < 8; ++k)
    {
        *type = k;
        if (strcmp(word, types[k].name) == 0 || strcmp(word, types[k].other) == 0) return PLS_OK;
    }
    return pls_fail(PLS_CORRUPT, "%s:%d: '%.40s' is no type of PLY; there are char, uchar, short, ushort, int, uint, float, double",
                    p->text->path, p->text->line, word ? word : "");
}

static pls_status read_format(ply *p, char *line)
{
    const char *word = pls_mesh_word(&line);
    p->binary = word && strcmp(word, "binary_little_endian") == 0;
    if (p->binary || (word && strcmp(word, "ascii") == 0)) return PLS_OK;
    return pls_fail(PLS_CORRUPT, "%s:%d: the format '%.40s' cannot be read; save the mesh as ascii or binary_little_endian", p->text->path,
                    p->text->line, word ? word : "");
}

static pls_status read_element(ply *p, char *line)
{
    if (p->elements == MOST_ELEMENTS) return fail_header(p, "more than 16 elements; leave out what is not needed");
    element *e = &p->element[p->elements++];
    const char *word = pls_mesh_word(&line);
    if (!word) return fail_header(p, "an element without a name; write 'element vertex 8'");
    snprintf(e->name, sizeof e->name, "%.31s", word);
    PLS_TRY(pls_mesh_number(p->text, &line, "the number of an element", &e->count));
    if (e->count < 0.0 || e->count > UINT32_MAX || e->count != floor(e->count))
        return fail_header(p, "the number of an element must be whole, at least 0 and below 2^32");
    return PLS_OK;
}

static pls_status read_property(ply *p, char *line)
{
    if (p->elements == 0) return fail_header(p, "a property before any element");
    element *e = &p->element[p->elements - 1];
    if (e->properties == MOST_PROPERTIES) return fail_header(p, "an element of more than 64 properties; leave out what is not needed");
    property *q = &e->property[e->properties++];
    *q = (property){.count_type = -1};
    const char *rest = line + strspn(line, " \t");
    if (strncmp(rest, "list", 4) == 0)
    {
        pls_mesh_word(&line);
        PLS_TRY(read_type(p, &line, &q->count_type));
    }
    PLS_TRY(read_type(p, &line, &q->type));
    const char *name = pls_mesh_word(&line);
    if (!name) return fail_header(p, "a property without a name");
    const bool list = q->count_type >= 0;
    if (strcmp(e->name, "vertex") == 0 && !list && strlen(name) == 1 && strchr("xyz", *name)) q->role = (role)(ROLE_X + (*name - 'x'));
    if (strcmp(e->name, "face") == 0 && list && (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
        q->role = ROLE_CORNERS;
    return PLS_OK;
}

static pls_status check_header(const ply *p)
{
    int seen[5] = {0};
    for (int e = 0; e < p->elements; ++e)
    {
        if (p->element[e].properties == 0 && p->element[e].count > 0.0) return fail_header(p, "an element without properties");
        for (int q = 0; q < p->element[e].properties; ++q) ++seen[p->element[e].property[q].role];
    }
    if (seen[ROLE_X] != 1 || seen[ROLE_Y] != 1 || seen[ROLE_Z] != 1)
        return fail_header(p, "the element 'vertex' needs the properties x, y and z, each once");
    if (seen[ROLE_CORNERS] != 1) return fail_header(p, "the element 'face' needs one list 'vertex_indices'; save the mesh with its faces");
    return PLS_OK;
}

static pls_status read_header(ply *p)
{
    bool format = false;
    for (char *line; (line = pls_mesh_line(p->text));)
    {
        const char *word = pls_mesh_word(&line);
        if (strcmp(word, "format") == 0)
        {
            PLS_TRY(read_format(p, line));
            format = true;
        }
        else if (strcmp(word, "element") == 0)
            PLS_TRY(read_element(p, line));
        else if (strcmp(word, "property") == 0)
            PLS_TRY(read_property(p, line));
        else if (strcmp(word, "end_header") == 0)
            return format ? check_header(p) : fail_header(p, "the header has no line 'format ascii 1.0'");
        else if (strcmp(word, "comment") != 0 && strcmp(word, "obj_info") != 0)
            return pls_fail(PLS_CORRUPT, "%s:%d: '%.40s' is no word of a PLY header", p->text->path, p->text->line, word);
    }
    return fail_header(p, "the header has no line 'end_header'; the file is cut off");
}

// ---- content --------------------------------------------------------------------------------------------------------------------------------------------------

static pls_status fail_row(const ply *p, const element *e, const char *what)
{
    if (!p->binary) return pls_fail(PLS_CORRUPT, "%s:%d: %s", p->text->path, p->text->line, what);
    return pls_fail(PLS_CORRUPT, "%s: %s %.0f: %s", p->text->path, e->name, p->number + 1.0, what);
}

static pls_status read_value(ply *p, const element *e, int type, double *value)
{
    if (!p->binary) return pls_mesh_number(p->text, &p->row, "a property", value);
    const ptrdiff_t size = types[type].size;
    if (p->text->end - p->text->at < size) return fail_row(p, e, "the file ends here; it is cut off: copy or save it anew");
    *value = decode(type, p->text->at);
    p->text->at += size;
    return PLS_OK;
}

static pls_status read_list(ply *p, const element *e, const property *q, uint32_t corner[MOST_CORNERS], size_t *corners)
{
    double count = 0.0, value = 0.0;
    PLS_TRY(read_value(p, e, q->count_type, &count));
    if (!(count >= 0.0) || count != floor(count)) return fail_row(p, e, "the length of a list must be a whole number, at least 0");
    const bool used = q->role == ROLE_CORNERS;
    if (used && count > MOST_CORNERS) return fail_row(p, e, "a face of more than 4096 corners; divide it");
    if (used && count < 3.0) return fail_row(p, e, "a face of fewer than 3 corners");
    for (double k = 0.0; k < count; ++k)
    {
        PLS_TRY(read_value(p, e, q->type, &value));
        if (!used) continue;
        if (!(value >= 0.0 && value < UINT32_MAX && value == floor(value)))
            return fail_row(p, e, "a corner must be the number of a vertex, from 0");
        corner[(*corners)++] = (uint32_t)value;
    }
    return PLS_OK;
}

static pls_status read_row(ply *p, const element *e, pls_mesh *mesh)
{
    uint32_t corner[MOST_CORNERS];
    size_t corners = 0;
    double x[5] = {0};
    if (!p->binary && !(p->row = pls_mesh_line(p->text)))
        return fail_row(p, e, "the file ends before all elements are told; it is cut off");
    for (int k = 0; k < e->properties; ++k)
    {
        const property *q = &e->property[k];
        if (q->count_type >= 0)
            PLS_TRY(read_list(p, e, q, corner, &corners));
        else
            PLS_TRY(read_value(p, e, q->type, &x[q->role]));
    }
    if (!isfinite(x[ROLE_X]) || !isfinite(x[ROLE_Y]) || !isfinite(x[ROLE_Z])) return fail_row(p, e, "coordinates must be finite numbers");
    if (strcmp(e->name, "vertex") == 0) return pls_mesh_add_vertex(mesh, pls_vec(x[ROLE_X], x[ROLE_Y], x[ROLE_Z]));
    return corners > 0 ? pls_mesh_add_polygon(mesh, corner, corners) : PLS_OK;
}

/// Faces may stand before the vertices, so their corners are checked in the end.
static pls_status check_corners(const ply *p, const pls_mesh *mesh)
{
    for (size_t t = 0; t < mesh->triangle_count; ++t)
    {
        for (int c = 0; c < 3; ++c)
        {
            if (mesh->triangle[t][c] >= mesh->vertex_count)
                return pls_fail(PLS_CORRUPT, "%s: a face has vertex %u, but there are only %zu; they count from 0", p->text->path,
                                mesh->triangle[t][c], mesh->vertex_count);
        }
    }
    return PLS_OK;
}

static pls_status read_all(ply *p, pls_mesh *mesh)
{
    PLS_TRY(read_header(p));
    for (int k = 0; k < p->elements; ++k)
    {
        for (p->number = 0.0; p->number < p->element[k].count; ++p->number) PLS_TRY(read_row(p, &p->element[k], mesh));
    }
    return check_corners(p, mesh);
}

pls_status pls_mesh_parse_ply(pls_mesh_text *text, pls_mesh *mesh)
{
    const char *first = pls_mesh_line(text);
    if (!first || strncmp(first, "ply", 3) != 0)
        return pls_fail(PLS_CORRUPT, "%s:1: the file is no PLY: its first line is not 'ply'", text->path);
    ply *p = NULL;
    PLS_TRY(pls_allocate(&p, 1, sizeof *p, "the header of a mesh"));
    p->text = text;
    pls_status status = read_all(p, mesh);
    pls_release(&p);
    return status;
}
