// mesh_obj.c -- Wavefront OBJ, and what all readers of meshes share.
//
// Of an OBJ file the lines "v x y z" and "f a b c ..." are read; corners may be written a/t/n, and count from the last vertex when negative. All else (textures,
// groups, materials) says nothing about the shape.

#include "shape/mesh.h"

#include "base/atomic_file.h"
#include "base/text.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_CORNERS = 4096 }; ///< of a polygon

// ---- shared ---------------------------------------------------------------------------------------------------------------------------------------------------

char *pls_mesh_line(pls_mesh_text *text)
{
    while (text->at < text->end)
    {
        char *line = text->at, *end = memchr(line, '\n', (size_t)(text->end - line));
        ++text->line;
        if (end) *end = '\0';
        text->at = end ? end + 1 : text->end;
        line += strspn(line, " \t\r");
        if (*line) return line;
    }
    return NULL;
}

char *pls_mesh_word(char **line)
{
    char *word = *line + strspn(*line, " \t\r");
    if (!*word) return NULL;
    char *end = word + strcspn(word, " \t\r");
    *line = *end ? end + 1 : end;
    *end = '\0';
    return word;
}

pls_status pls_mesh_number(const pls_mesh_text *text, char **line, const char *what, double *value)
{
    const char *word = pls_mesh_word(line);
    if (!word) return pls_fail(PLS_CORRUPT, "%s:%d: %s is missing; write a number", text->path, text->line, what);
    if (pls_parse_double(word, value) && isfinite(*value)) return PLS_OK;
    return pls_fail(PLS_CORRUPT, "%s:%d: '%.40s' as %s is not a finite number", text->path, text->line, word, what);
}

pls_status pls_mesh_add_vertex(pls_mesh *mesh, pls_vec3 x)
{
    if (mesh->vertex_count >= UINT32_MAX) return pls_fail(PLS_LIMIT_EXCEEDED, "a mesh has more than %u vertices", UINT32_MAX);
    PLS_TRY(pls_reserve(&mesh->vertex, &mesh->vertex_capacity, mesh->vertex_count + 1, sizeof *mesh->vertex, "vertices of a mesh"));
    mesh->vertex[mesh->vertex_count++] = x;
    return PLS_OK;
}

pls_status pls_mesh_add_polygon(pls_mesh *mesh, const uint32_t *corner, size_t corners)
{
    for (size_t k = 1; k + 1 < corners; ++k)
    {
        PLS_TRY(pls_reserve(&mesh->triangle, &mesh->triangle_capacity, mesh->triangle_count + 1, sizeof *mesh->triangle,
                            "triangles of a mesh"));
        uint32_t *t = mesh->triangle[mesh->triangle_count++];
        t[0] = corner[0], t[1] = corner[k], t[2] = corner[k + 1];
    }
    return PLS_OK;
}

void pls_mesh_free(pls_mesh *mesh)
{
    pls_release(&mesh->vertex);
    pls_release(&mesh->triangle);
    *mesh = (pls_mesh){0};
}

pls_status pls_mesh_read(const char *path, pls_mesh *out)
{
    static const struct
    {
        const char *ending;
        pls_status (*parse)(pls_mesh_text *, pls_mesh *);
    } kinds[] = {{".obj", pls_mesh_parse_obj}, {".stl", pls_mesh_parse_stl}, {".ply", pls_mesh_parse_ply}};
    *out = (pls_mesh){0};
    const char *ending = strrchr(path, '.');
    size_t k = 0;
    while (k < 3 && !(ending && strcasecmp(ending, kinds[k].ending) == 0)) ++k;
    if (k == 3) return pls_fail(PLS_INVALID_ARGUMENT, "\"%s\" is no mesh file that can be read; it must end with .obj, .stl or .ply", path);
    char *content = NULL;
    size_t size = 0;
    PLS_TRY(pls_read_file(path, &content, &size));
    pls_mesh_text text = {.path = path, .at = content, .end = content + size};
    pls_status status = kinds[k].parse(&text, out);
    if (status == PLS_OK && out->triangle_count == 0)
        status = pls_fail(PLS_CORRUPT, "%s: there are no faces in the file; save the mesh with its faces", path);
    pls_release(&content);
    if (status != PLS_OK) pls_mesh_free(out);
    return status;
}

// ---- OBJ ------------------------------------------------------------------------------------------------------------------------------------------------------

static pls_status read_vertex(const pls_mesh_text *text, char *line, pls_mesh *mesh)
{
    pls_vec3 x;
    PLS_TRY(pls_mesh_number(text, &line, "x of a vertex", &x.x));
    PLS_TRY(pls_mesh_number(text, &line, "y of a vertex", &x.y));
    PLS_TRY(pls_mesh_number(text, &line, "z of a vertex", &x.z));
    return pls_mesh_add_vertex(mesh, x);
}

/// "7", "7/1/2", "-1//3": the vertex before the first slash.
static pls_status read_corner(const pls_mesh_text *text, const char *word, const pls_mesh *mesh, uint32_t *corner)
{
    char *end = NULL;
    errno = 0;
    long long number = strtoll(word, &end, 10);
    if (errno || end == word || (*end && *end != '/'))
        return pls_fail(PLS_CORRUPT, "%s:%d: '%.40s' is no corner of a face; write the number of a vertex, or vertex/texture/normal",
                        text->path, text->line, word);
    const long long count = (long long)mesh->vertex_count, index = number < 0 ? count + number : number - 1;
    if (number == 0 || index < 0 || index >= count)
        return pls_fail(PLS_CORRUPT, "%s:%d: a face has vertex %lld, but there are %lld before it; vertices count from 1", text->path,
                        text->line, number, count);
    *corner = (uint32_t)index;
    return PLS_OK;
}

static pls_status read_face(const pls_mesh_text *text, char *line, pls_mesh *mesh)
{
    uint32_t corner[MOST_CORNERS];
    size_t corners = 0;
    for (const char *word; (word = pls_mesh_word(&line)) && *word != '#'; ++corners)
    {
        if (corners == MOST_CORNERS)
            return pls_fail(PLS_LIMIT_EXCEEDED, "%s:%d: a face of more than %d corners; divide it", text->path, text->line, MOST_CORNERS);
        PLS_TRY(read_corner(text, word, mesh, &corner[corners]));
    }
    if (corners < 3) return pls_fail(PLS_CORRUPT, "%s:%d: a face of %zu corners; it needs 3", text->path, text->line, corners);
    return pls_mesh_add_polygon(mesh, corner, corners);
}

pls_status pls_mesh_parse_obj(pls_mesh_text *text, pls_mesh *mesh)
{
    for (char *line; (line = pls_mesh_line(text));)
    {
        size_t length = strlen(line);
        if (*line != '#' && line[length - 1] == '\\')
            return pls_fail(PLS_CORRUPT, "%s:%d: a line that goes on in the next one cannot be read; write it as one", text->path,
                            text->line);
        const char *word = pls_mesh_word(&line);
        if (strcmp(word, "v") == 0)
            PLS_TRY(read_vertex(text, line, mesh));
        else if (strcmp(word, "f") == 0)
            PLS_TRY(read_face(text, line, mesh));
    }
    return PLS_OK;
}
