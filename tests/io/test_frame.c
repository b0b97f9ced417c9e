// test_frame.c -- frames read back: the bits that were written, walls apart, and damage is found wherever it is.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/atomic_file.h"
#include "io/frame.h"
#include "io/vtk.h"
#include "io/vtk_reader.h"

#include <particls/scene.h>

static void must(pls_status status)
{
    if (status != PLS_OK) print_error("%s\n", pls_last_message());
    assert_int_equal(status, PLS_OK);
}

enum { BALLS = 5000 }; // several blocks of 32 kB in each array of vectors

// A floor that is numbered between the two groups of balls.
static const char scene_text[] =
    "particls: 1\n"
    "materials: {grain: {density: 1000}}\n"
    "shapes: {small: {sphere: {radius: 0.1}}, wall: {plane: {}}, large: {sphere: {radius: 0.2}}}\n"
    "bodies:\n"
    "  - {name: pack, shape: small, material: grain, velocity: [\"x\", \"-y\", \"sin(z)\"], place: {lattice: {count: [10, 20, 20]}}}\n"
    "  - {name: floor, shape: wall, material: grain, position: [1, 2, -0.5], normal: [0, 0, 1]}\n"
    "  - {name: more, shape: large, material: grain, scale: 0.5, place: {lattice: {count: [10, 10, 10], corner: [10, 0, 0]}}}\n"
    "contact: [{between: all, law: elastic, kn: 10000}]\n"
    "time: {end: 1, dt: 1.0e-5}\n";

static pls_world *make_world(void)
{
    pls_scene *scene;
    pls_world *world;
    must(pls_write_file("scene.yaml", scene_text, strlen(scene_text)));
    must(pls_scene_load("scene.yaml", NULL, 0, &scene));
    must(pls_scene_build(scene, &world));
    pls_scene_free(scene);
    return world;
}

static void same_column(const pls_frame *frame, const char *text, size_t size, const char *name, size_t rows)
{
    static char expected[BALLS * 4 * sizeof(double)];
    const pls_frame_column *column = pls_frame_find(frame, name);
    assert_non_null(column);
    assert_int_equal(column->rows, rows);
    long bytes = read_vtk_array(text, size, name, expected, sizeof expected);
    assert_int_equal(bytes, rows * (size_t)column->components * pls_type_size(column->type));
    assert_memory_equal(column->data, expected, (size_t)bytes);
}

/// Against the reader of the tests, which was written from the description of the format.
static void what_was_written_is_read(void **state)
{
    (void)state;
    pls_world *world = make_world();
    pls_frames_def def = {.field_count = 1};
    strcpy(def.fields[0], "mass");
    must(pls_vtk_write_bodies("bodies.vtp", world, &def));
    char *text;
    size_t size;
    must(pls_read_file("bodies.vtp", &text, &size));
    pls_frame frame;
    must(pls_frame_read(&frame, "bodies.vtp"));
    assert_true(frame.time == 0.0);
    static const char *const fields[] = {"number", "group", "shape", "position", "velocity", "radius", "scale", "orientation", "mass"};
    for (size_t k = 0; k < sizeof fields / sizeof *fields; ++k) same_column(&frame, text, size, fields[k], BALLS);
    static const char *const walls[] = {"wall_number", "wall_shape", "wall_position", "wall_orientation", "wall_group"};
    for (size_t k = 0; k < sizeof walls / sizeof *walls; ++k) same_column(&frame, text, size, walls[k], 1);
    assert_null(pls_frame_find(&frame, "inertia")); // not asked for
    assert_true(pls_frame_value(pls_frame_find(&frame, "wall_number"), 0, 0) == 4000.0);
    pls_vec3 p = pls_frame_vector(pls_frame_find(&frame, "wall_position"), 0);
    assert_true(p.x == 1.0 && p.y == 2.0 && p.z == -0.5);
    const pls_frame_column *number = pls_frame_find(&frame, "number"), *scale = pls_frame_find(&frame, "scale");
    for (size_t k = 0; k < BALLS; ++k)
    {
        assert_true(pls_frame_value(number, k, 0) == (double)(k < 4000 ? k : k + 1)); // the floor has the number between
        assert_true(pls_frame_value(scale, k, 0) == (k < 4000 ? 1.0 : 0.5));
    }
    pls_frame_free(&frame);
    pls_release(&text);
    pls_world_destroy(world);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// Taken from the world, a frame has all fields, those of files among them, with the same bits.
static void a_world_gives_the_same_frame(void **state)
{
    (void)state;
    pls_world *world = make_world();
    pls_frame taken, read;
    must(pls_vtk_write_bodies("bodies.vtp", world, &(pls_frames_def){0}));
    must(pls_frame_read(&read, "bodies.vtp"));
    must(pls_frame_take(&taken, world));
    size_t compared = 0;
    for (size_t k = 0; k < read.count; ++k)
    {
        const pls_frame_column *a = &read.column[k], *b = pls_frame_find(&taken, a->name);
        assert_non_null(b);
        assert_true(a->type == b->type && a->components == b->components && a->rows == b->rows);
        assert_memory_equal(a->data, b->data, a->rows * (size_t)a->components * pls_type_size(a->type));
        ++compared;
    }
    assert_true(compared > 10);
    assert_non_null(pls_frame_find(&taken, "inertia"));
    pls_frame_free(&taken);
    pls_frame_free(&read);
    pls_world_destroy(world);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void refuse(const char *text, size_t size, const char *words)
{
    pls_frame frame;
    must(pls_write_file("bad.vtp", text, size));
    assert_int_equal(pls_frame_read(&frame, "bad.vtp"), PLS_CORRUPT);
    if (!strstr(pls_last_message(), words)) print_error("%s\n", pls_last_message());
    assert_non_null(strstr(pls_last_message(), words));
    assert_int_equal(frame.count, 0);
}

/// Cut anywhere, or with any byte of an array's sizes or data changed, it is refused and never read out of bounds (asan looks on).
static void damage_is_found(void **state)
{
    (void)state;
    pls_world *world = make_world();
    must(pls_vtk_write_bodies("bodies.vtp", world, &(pls_frames_def){0}));
    pls_world_destroy(world);
    char *text;
    size_t size;
    must(pls_read_file("bodies.vtp", &text, &size));
    size_t arrays = (size_t)(strstr(text, "<AppendedData") - text);
    size_t start = arrays + strlen("<AppendedData encoding=\"raw\">\n_");
    for (size_t length = arrays; length < size; length += size / 23) refuse(text, length, "bad.vtp");
    refuse(text, size - 1, "cut off");
    for (size_t k = 0; k < 24; ++k) // the sizes in front of the first array
    {
        char saved = text[start + k];
        text[start + k] = (char)(saved ^ 0x55);
        refuse(text, size, "bad.vtp");
        text[start + k] = saved;
    }
    text[start + 200] = (char)(text[start + 200] ^ 1); // zlib's own sum finds it
    refuse(text, size, "damaged");
    refuse("nothing", 7, "no appended section");
    pls_release(&text);
    pls_frame frame;
    assert_int_equal(pls_frame_read(&frame, "not_there.vtp"), PLS_NOT_FOUND);
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_written_is_read),
        cmocka_unit_test(a_world_gives_the_same_frame),
        cmocka_unit_test(damage_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
