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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(good_files_give_their_triangles),
                                       cmocka_unit_test(broken_files_are_told_with_their_line)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
