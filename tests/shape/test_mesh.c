// test_mesh.c -- triangle meshes from files, good and broken.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/atomic_file.h"
#include "shape/mesh.h"

#include <string.h>

static pls_status read_as(const char *path, const char *content, pls_mesh *mesh)
{
    assert_int_equal(pls_write_file(path, content, strlen(content)), PLS_OK);
    return pls_mesh_read(path, mesh);
}

static void good_files_give_their_triangles(void **state)
{
    (void)state;
    pls_mesh m;
    assert_int_equal(read_as("a.obj", "# x\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1/1 2//3 -2 4\n", &m), PLS_OK);
    assert_int_equal(m.vertex_count, 4);
    assert_int_equal(m.triangle_count, 2);
    assert_int_equal(m.triangle[1][1], 2);
    pls_mesh_free(&m);
    assert_int_equal(
        read_as("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n",
                &m),
        PLS_OK);
    assert_int_equal(m.triangle_count, 1);
    pls_mesh_free(&m);
    assert_int_equal(read_as("a.ply",
                             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face "
                             "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n",
                             &m),
                     PLS_OK);
    assert_true(m.vertex[2].z == 0.5);
    pls_mesh_free(&m);
}

static void broken_files_are_told_with_their_line(void **state)
{
    (void)state;
    static const char *const broken[][3] = {
        {"b.obj", "v 0 0\n", "b.obj:1: z of a vertex is missing; write a number"},
        {"b.obj", "v 0 0 x\n", "b.obj:1: 'x' as z of a vertex is not a finite number"},
        {"b.obj", "v 0 0 0\nf 1 2 3\n", "b.obj:2: a face has vertex 2, but there are 1 before it; vertices count from 1"},
        {"b.obj", "v 0 0 0\nf 1 1\n", "b.obj:2: a face of 2 corners; it needs 3"},
        {"b.obj", "v 0 0 0\n", "b.obj: there are no faces in the file; save the mesh with its faces"},
        {"b.stl", "solid\nfoo\n", "b.stl:2: 'foo' is no word of STL; the file is damaged or of another format"},
        {"b.stl", "solid\nendfacet\n", "b.stl:2: a facet of 0 vertices; it needs 3"},
        {"b.stl", "solid\n", "b.stl:1: the file ends before 'endsolid'; it is cut off: copy or save it anew"},
        {"b.ply", "plx\n", NULL},
        {"b.ply", "ply\nformat ascii 1.0\n", "b.ply:2: the header has no line 'end_header'; the file is cut off"},
        {"b.ply", "ply\nfoo\n", "b.ply:2: 'foo' is no word of a PLY header"},
    };
    for (size_t k = 0; k < sizeof broken / sizeof *broken; ++k)
    {
        pls_mesh m;
        assert_int_equal(read_as(broken[k][0], broken[k][1], &m), PLS_CORRUPT);
        if (broken[k][2]) assert_string_equal(pls_last_message(), broken[k][2]);
    }
}

// ---- binary files -------------------------------------------------------------------------------------------------------------------------------------------

/// A file put together byte by byte.
typedef struct bytes
{
    char data[1024];
    size_t size;
} bytes;

static void put(bytes *b, const void *data, size_t size)
{
    assert_true(b->size + size <= sizeof b->data);
    memcpy(b->data + b->size, data, size);
    b->size += size;
}

static void put_floats(bytes *b, const float *values, size_t count) { put(b, values, count * sizeof *values); }

/// Two triangles of a square at x = 0.1, in floats; the header begins with "solid", as those of some programs do.
static bytes binary_stl(uint32_t says)
{
    bytes b = {.size = 0};
    char header[80] = "solid by a program that should not write this";
    const float facets[2][12] = {{1, 0, 0, 0.1f, 0, 0, 0.1f, 1, 0, 0.1f, 1, 1}, {1, 0, 0, 0.1f, 0, 0, 0.1f, 1, 1, 0.1f, -0.0f, 1}};
    const uint16_t attribute = 7;
    put(&b, header, sizeof header);
    put(&b, &says, sizeof says);
    for (int t = 0; t < 2; ++t)
    {
        put_floats(&b, facets[t], 12);
        put(&b, &attribute, sizeof attribute);
    }
    return b;
}

static pls_status read_bytes(const char *path, const bytes *b, pls_mesh *mesh)
{
    assert_int_equal(pls_write_file(path, b->data, b->size), PLS_OK);
    return pls_mesh_read(path, mesh);
}

static void binary_stl_joins_equal_corners(void **state)
{
    (void)state;
    pls_mesh m;
    bytes b = binary_stl(2);
    assert_int_equal(read_bytes("b.STL", &b, &m), PLS_OK); // endings in any case
    assert_int_equal(m.triangle_count, 2);
    assert_int_equal(m.vertex_count, 4); // 0 and -0 are one place
    assert_int_equal(m.triangle[1][0], m.triangle[0][0]);
    assert_int_equal(m.triangle[1][1], m.triangle[0][2]);
    assert_true(m.vertex[1].x == (double)0.1f && m.vertex[1].y == 1.0);
    pls_mesh_free(&m);

    b = binary_stl(3); // one triangle more than there is
    assert_int_equal(read_bytes("b.stl", &b, &m), PLS_CORRUPT);
    b = binary_stl(2);
    b.size -= 1;
    b.data[0] = 'x';
    assert_int_equal(read_bytes("b.stl", &b, &m), PLS_CORRUPT);
    assert_string_equal(
        pls_last_message(),
        "b.stl: the file is no STL: it does not begin with 'solid', and a binary one of 2 triangles has 184 bytes, not 183");
    b = binary_stl(2);
    const float nowhere = NAN;
    memcpy(b.data + 84 + 12, &nowhere, sizeof nowhere);
    assert_int_equal(read_bytes("b.stl", &b, &m), PLS_CORRUPT);
    assert_string_equal(pls_last_message(), "b.stl: corner 1 of triangle 1 is (nan, 0, 0); coordinates must be finite: save the mesh anew");
}

/// Vertices with a colour between the coordinates, faces before them, a quadrangle and a triangle, and an element that is not asked for.
static bytes binary_ply(void)
{
    bytes b = {.size = 0};
    static const char header[] =
        "ply\nformat binary_little_endian 1.0\ncomment x\nelement face 2\nproperty uchar flags\n"
        "property list uchar ushort vertex_index\nelement other 1\nproperty list uint double junk\n"
        "element vertex 4\nproperty double x\nproperty uchar red\nproperty float y\nproperty short z\nend_header\n";
    const uint8_t flags = 9, four = 4, three = 3, red = 200;
    const uint16_t square[4] = {0, 1, 2, 3}, corner[3] = {0, 2, 3};
    const uint32_t two = 2;
    const double junk[2] = {NAN, 1e300}, x[4] = {0.1, 1.1, 1.1, 0.1};
    const float y[4] = {0.0f, 0.0f, 0.5f, 0.5f};
    const int16_t z[4] = {-3, -3, -3, 5};
    put(&b, header, sizeof header - 1);
    put(&b, &flags, 1), put(&b, &four, 1), put(&b, square, sizeof square);
    put(&b, &flags, 1), put(&b, &three, 1), put(&b, corner, sizeof corner);
    put(&b, &two, sizeof two), put(&b, junk, sizeof junk);
    for (int v = 0; v < 4; ++v) put(&b, &x[v], sizeof *x), put(&b, &red, 1), put(&b, &y[v], sizeof *y), put(&b, &z[v], sizeof *z);
    return b;
}

static void binary_ply_is_read_by_its_header(void **state)
{
    (void)state;
    pls_mesh m;
    bytes b = binary_ply();
    if (read_bytes("b.ply", &b, &m) != PLS_OK) fail_msg("%s", pls_last_message());
    assert_int_equal(m.vertex_count, 4);
    assert_int_equal(m.triangle_count, 3);
    assert_true(m.vertex[2].x == 1.1 && m.vertex[2].y == 0.5 && m.vertex[2].z == -3.0 && m.vertex[3].z == 5.0);
    const uint32_t known[3][3] = {{0, 1, 2}, {0, 2, 3}, {0, 2, 3}};
    assert_memory_equal(m.triangle, known, sizeof known);
    pls_mesh_free(&m);

    const size_t whole = b.size;
    b.size -= 1;
    assert_int_equal(read_bytes("b.ply", &b, &m), PLS_CORRUPT);
    assert_string_equal(pls_last_message(), "b.ply: vertex 4: the file ends here; it is cut off: copy or save it anew");
    b.size = whole;
    const size_t place = whole - 4 * 15 - 20 - 2; // the last corner of the faces, before the junk and the vertices
    const uint16_t far = 4;
    memcpy(b.data + place, &far, sizeof far);
    assert_int_equal(read_bytes("b.ply", &b, &m), PLS_CORRUPT);
    assert_string_equal(pls_last_message(), "b.ply: a face has vertex 4, but there are only 4; they count from 0");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_files_give_their_triangles), cmocka_unit_test(broken_files_are_told_with_their_line),
        cmocka_unit_test(binary_stl_joins_equal_corners), cmocka_unit_test(binary_ply_is_read_by_its_header)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
