// test_vtk.c -- frames: arrays read back bit for bit, files are well-formed and atomic.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "io/vtk.h"
#include "io/vtk_reader.h"
#include "support/failing_allocator.h"

#include <signal.h>
#include <stdio.h>
#include <sys/resource.h>

enum {
    COUNT = 20000 ///< points: several blocks of 32 kB
};

static double points[COUNT][3];
static uint16_t material[COUNT];

static void fill_arrays(void)
{
    for (int k = 0; k < COUNT; ++k)
    {
        for (int c = 0; c < 3; ++c) points[k][c] = 1.0 / (1 + k + 3 * c);
        material[k] = (uint16_t)(k * 7);
    }
}

static void must(pls_status status)
{
    if (status != PLS_OK) print_error("%s\n", pls_last_message());
    assert_int_equal(status, PLS_OK);
}

static void arrays_of_many_blocks_read_back_bit_for_bit(void **state)
{
    (void)state;
    fill_arrays();
    pls_vtk vtk = {0};
    must(pls_vtk_add(&vtk, PLS_VTK_POINTS, "position", PLS_F64, 3, COUNT, points));
    must(pls_vtk_add(&vtk, PLS_VTK_POINT_DATA, "material", PLS_U16, 1, COUNT, material));
    must(pls_vtk_add_vertices(&vtk, COUNT));
    must(pls_vtk_write(&vtk, "many.vtp", 0.25));
    pls_vtk_free(&vtk);

    char *text;
    size_t size;
    static double back[COUNT][3];
    static uint16_t material_back[COUNT];
    static int64_t index[COUNT];
    must(pls_read_file("many.vtp", &text, &size));
    assert_int_equal(read_vtk_array(text, size, "position", back, sizeof back), sizeof points);
    assert_memory_equal(back, points, sizeof points);
    assert_int_equal(read_vtk_array(text, size, "material", material_back, sizeof material_back), sizeof material);
    assert_memory_equal(material_back, material, sizeof material);
    assert_int_equal(read_vtk_array(text, size, "connectivity", index, sizeof index), sizeof index);
    for (int k = 0; k < COUNT; ++k) assert_int_equal(index[k], k);
    assert_int_equal(read_vtk_array(text, size, "offsets", index, sizeof index), sizeof index);
    for (int k = 0; k < COUNT; ++k) assert_int_equal(index[k], k + 1);
    assert_non_null(strstr(text, "<Piece NumberOfPoints=\"20000\" NumberOfVerts=\"20000\" NumberOfLines=\"0\""));
    assert_non_null(strstr(text, "Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0.25<"));
    pls_release(&text);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void lines_join_pairs_of_points(void **state)
{
    (void)state;
    fill_arrays();
    pls_vtk vtk = {0};
    must(pls_vtk_add(&vtk, PLS_VTK_POINTS, "position", PLS_F64, 3, 6, points));
    must(pls_vtk_add_lines(&vtk, 3));
    must(pls_vtk_write(&vtk, "lines.vtp", 0));
    pls_vtk_free(&vtk);
    char *text;
    size_t size;
    int64_t index[6];
    must(pls_read_file("lines.vtp", &text, &size));
    assert_int_equal(read_vtk_array(text, size, "connectivity", index, sizeof index), sizeof index);
    for (int k = 0; k < 6; ++k) assert_int_equal(index[k], k);
    assert_int_equal(read_vtk_array(text, size, "offsets", index, sizeof index), 3 * sizeof index[0]);
    for (int k = 0; k < 3; ++k) assert_int_equal(index[k], 2 * k + 2);
    pls_release(&text);
}

static void a_frame_without_points_is_a_frame(void **state)
{
    (void)state;
    pls_vtk vtk = {0};
    must(pls_vtk_add(&vtk, PLS_VTK_POINTS, "position", PLS_F64, 3, 0, NULL));
    must(pls_vtk_add_vertices(&vtk, 0));
    must(pls_vtk_write(&vtk, "none.vtp", 0));
    pls_vtk_free(&vtk);
    char *text;
    size_t size;
    char nothing[1];
    must(pls_read_file("none.vtp", &text, &size));
    assert_int_equal(read_vtk_array(text, size, "position", nothing, 0), 0);
    pls_release(&text);
}

static void names_are_escaped(void **state)
{
    (void)state;
    pls_vtk vtk = {0};
    must(pls_vtk_add(&vtk, PLS_VTK_POINT_DATA, "a<b & \"c\"", PLS_F64, 1, 1, points));
    assert_non_null(strstr(vtk.xml[PLS_VTK_POINT_DATA].data, "Name=\"a&lt;b &amp; &quot;c&quot;\""));
    pls_vtk_free(&vtk);
}

static void a_collection_names_each_frame_with_its_time(void **state)
{
    (void)state;
    must(pls_vtk_write_collection("pack.pvd", "pack", (const double[]){0, 0.1}, 2));
    char *text;
    size_t size;
    must(pls_read_file("pack.pvd", &text, &size));
    assert_string_equal(text, "<?xml version=\"1.0\"?>\n"
                              "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
                              "  <Collection>\n"
                              "    <DataSet timestep=\"0\" part=\"0\" file=\"pack_000000.vtp\"/>\n"
                              "    <DataSet timestep=\"0.1\" part=\"0\" file=\"pack_000001.vtp\"/>\n"
                              "  </Collection>\n"
                              "</VTKFile>\n");
    pls_release(&text);
}

static pls_status write_frame(void *context)
{
    pls_vtk vtk = {0};
    pls_status status = pls_vtk_add(&vtk, PLS_VTK_POINTS, "position", PLS_F64, 3, COUNT, points);
    if (status == PLS_OK) status = pls_vtk_add_vertices(&vtk, COUNT);
    if (status == PLS_OK) status = pls_vtk_write(&vtk, context, 0);
    pls_vtk_free(&vtk);
    return status;
}

static void a_full_disk_leaves_the_old_frame(void **state)
{
    (void)state;
    char path[] = "full.vtp";
    must(pls_write_file(path, "old", 3));
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    struct rlimit small = {1000, before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    pls_status status = write_frame(path);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(status, PLS_DISK_FULL);
    assert_false(pls_file_exists("full.vtp.tmp"));
    char *text;
    size_t size;
    must(pls_read_file(path, &text, &size));
    assert_string_equal(text, "old");
    pls_release(&text);
}

static void every_failing_allocation_is_an_error(void **state)
{
    (void)state;
    char path[] = "failing.vtp";
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(write_frame, path) > 5);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_of_many_blocks_read_back_bit_for_bit), cmocka_unit_test(lines_join_pairs_of_points),
        cmocka_unit_test(a_frame_without_points_is_a_frame),           cmocka_unit_test(names_are_escaped),
        cmocka_unit_test(a_collection_names_each_frame_with_its_time), cmocka_unit_test(a_full_disk_leaves_the_old_frame),
        cmocka_unit_test(every_failing_allocation_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
