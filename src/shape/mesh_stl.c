// mesh_stl.c -- STL, text and binary.
//
// A binary file has 80 bytes of anything (often "solid ..." too), the number of triangles n, and 50 bytes each; so a file of 84 + 50 n bytes is binary and any
// other one text. Triangles stand alone in the file: corners at exactly the same place become one vertex, by a hash table.

#include "shape/mesh.h"

#include "base/alloc.h"
#include "base/hash.h"

#include <string.h>

typedef struct welder
{
    uint32_t *slot; ///< vertex + 1, 0: free
    size_t slots;   ///< a power of 2
} welder;

static size_t find_slot(const welder *w, const pls_mesh *mesh, pls_vec3 x)
{
    size_t k = (size_t)pls_hash(PLS_HASH_START, &x, sizeof x);
    for (k ^= k >> 29;; ++k)
    {
        k &= w->slots - 1;
        if (w->slot[k] == 0) return k;
        pls_vec3 there = mesh->vertex[w->slot[k] - 1];
        if (there.x == x.x && there.y == x.y && there.z == x.z) return k;
    }
}

static pls_status grow(welder *w, const pls_mesh *mesh)
{
    pls_release(&w->slot);
    w->slots = w->slots ? 2 * w->slots : 1024;
    PLS_TRY(pls_allocate(&w->slot, w->slots, sizeof *w->slot, "vertices of a mesh"));
    for (size_t v = 0; v < mesh->vertex_count; ++v) w->slot[find_slot(w, mesh, mesh->vertex[v])] = (uint32_t)v + 1;
    return PLS_OK;
}

/// The vertex at x, an old one if there is one.
static pls_status weld(welder *w, pls_mesh *mesh, pls_vec3 x, uint32_t *vertex)
{
    x = pls_add(x, pls_vec(0.0, 0.0, 0.0)); // -0 becomes 0
    if (2 * mesh->vertex_count >= w->slots) PLS_TRY(grow(w, mesh));
    size_t k = find_slot(w, mesh, x);
    if (w->slot[k] == 0)
    {
        PLS_TRY(pls_mesh_add_vertex(mesh, x));
        w->slot[k] = (uint32_t)mesh->vertex_count;
    }
    *vertex = w->slot[k] - 1;
    return PLS_OK;
}

static pls_status read_binary(const pls_mesh_text *text, uint32_t count, pls_mesh *mesh, welder *w)
{
    for (uint32_t t = 0; t < count; ++t)
    {
        float number[12];
        uint32_t corner[3];
        memcpy(number, text->at + 84 + 50 * (size_t)t, sizeof number);
        for (int c = 0; c < 3; ++c)
        {
            const float *x = number + 3 + 3 * c;
            if (!isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2]))
                return pls_fail(PLS_CORRUPT, "%s: corner %d of triangle %u is (%g, %g, %g); coordinates must be finite: save the mesh anew",
                                text->path, c + 1, t + 1, (double)x[0], (double)x[1], (double)x[2]);
            PLS_TRY(weld(w, mesh, pls_vec((double)x[0], (double)x[1], (double)x[2]), &corner[c]));
        }
        PLS_TRY(pls_mesh_add_polygon(mesh, corner, 3));
    }
    return PLS_OK;
}

/// "vertex x y z" lines between "outer loop" and "endloop"; other lines of the format say nothing about the shape.
static pls_status read_text(pls_mesh_text *text, pls_mesh *mesh, welder *w)
{
    uint32_t corner[3];
    int corners = 0;
    bool ended = false;
    for (char *line; (line = pls_mesh_line(text));)
    {
        const char *word = pls_mesh_word(&line);
        if (strcmp(word, "vertex") == 0)
        {
            pls_vec3 x;
            if (corners == 3)
                return pls_fail(PLS_CORRUPT, "%s:%d: a facet of more than 3 vertices; STL has triangles only", text->path, text->line);
            PLS_TRY(pls_mesh_number(text, &line, "x of a vertex", &x.x));
            PLS_TRY(pls_mesh_number(text, &line, "y of a vertex", &x.y));
            PLS_TRY(pls_mesh_number(text, &line, "z of a vertex", &x.z));
            PLS_TRY(weld(w, mesh, x, &corner[corners++]));
        }
        else if (strcmp(word, "endfacet") == 0)
        {
            if (corners != 3) return pls_fail(PLS_CORRUPT, "%s:%d: a facet of %d vertices; it needs 3", text->path, text->line, corners);
            PLS_TRY(pls_mesh_add_polygon(mesh, corner, 3));
            corners = 0;
        }
        else if (strcmp(word, "endsolid") == 0)
            ended = true;
        else if (strcmp(word, "solid") != 0 && strcmp(word, "facet") != 0 && strcmp(word, "outer") != 0 && strcmp(word, "endloop") != 0)
            return pls_fail(PLS_CORRUPT, "%s:%d: '%.40s' is no word of STL; the file is damaged or of another format", text->path,
                            text->line, word);
    }
    if (ended && corners == 0) return PLS_OK;
    return pls_fail(PLS_CORRUPT, "%s:%d: the file ends before 'endsolid'; it is cut off: copy or save it anew", text->path, text->line);
}

pls_status pls_mesh_parse_stl(pls_mesh_text *text, pls_mesh *mesh)
{
    const size_t size = (size_t)(text->end - text->at);
    uint32_t count = 0;
    if (size >= 84) memcpy(&count, text->at + 80, sizeof count);
    const bool binary = size >= 84 && size == 84 + 50 * (size_t)count;
    if (!binary && (size < 5 || memcmp(text->at, "solid", 5) != 0))
        return pls_fail(PLS_CORRUPT,
                        "%s: the file is no STL: it does not begin with 'solid', and a binary one of %u triangles has %zu bytes, not %zu",
                        text->path, count, 84 + 50 * (size_t)count, size);
    welder w = {0};
    pls_status status = binary ? read_binary(text, count, mesh, &w) : read_text(text, mesh, &w);
    pls_release(&w.slot);
    return status;
}
