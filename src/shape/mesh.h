// mesh.h -- triangle meshes from files: Wavefront OBJ, STL (text and binary), PLY (text and binary, little endian).
//
// Polygons become fans of triangles from their first corner. Normals, colours and textures in a file are passed over: which side of a triangle is outside, the
// order of its corners tells. Every reader fails with CORRUPT and a message that begins with "file:line" (binary: the file and the number of the element).
#ifndef PLS_SHAPE_MESH_H
#define PLS_SHAPE_MESH_H

#include <particls/status.h>
#include <particls/types.h>

typedef struct pls_mesh
{
    pls_vec3 *vertex;
    size_t vertex_count, vertex_capacity;
    uint32_t (*triangle)[3];
    size_t triangle_count, triangle_capacity;
} pls_mesh;

/// Read by the ending of the name: .obj, .stl, .ply. INVALID_ARGUMENT for another one, NOT_FOUND, IO, CORRUPT. `pls_mesh_free` releases.
pls_status pls_mesh_read(const char *path, pls_mesh *out);
void pls_mesh_free(pls_mesh *mesh);

// For the readers: the content of a file and where in it they are.

typedef struct pls_mesh_text
{
    const char *path;
    char *at, *end;
    int line;
} pls_mesh_text;

/// Add to `mesh` what the text holds.
pls_status pls_mesh_parse_obj(pls_mesh_text *text, pls_mesh *mesh);
pls_status pls_mesh_parse_stl(pls_mesh_text *text, pls_mesh *mesh);
pls_status pls_mesh_parse_ply(pls_mesh_text *text, pls_mesh *mesh);

/// Next line with something on it, without its end; null at the end of the file. Cuts the text.
char *pls_mesh_line(pls_mesh_text *text);
/// Next word of a line, null when there is none. Cuts the line.
char *pls_mesh_word(char **line);
/// The next word of a line as a finite number.
pls_status pls_mesh_number(const pls_mesh_text *text, char **line, const char *what, double *value);
pls_status pls_mesh_add_vertex(pls_mesh *mesh, pls_vec3 x);
pls_status pls_mesh_add_polygon(pls_mesh *mesh, const uint32_t *corner, size_t corners);

#endif
