// test_vtk_frames.c -- what frames hold: bodies in order of their numbers, contacts as lines, no walls.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "io/vtk.h"
#include "io/vtk_reader.h"

#include <particls/scene.h>

static void must(pls_status status)
{
    if (status != PLS_OK) print_error("%s\n", pls_last_message());
    assert_int_equal(status, PLS_OK);
}

static const double kn = 10000;
static const double overlap = 0.002;

// Two balls of radius 0.1 in contact by 2 mm across the periodic boundary at x = 0 (= 1), both also 1 mm deep in the floor; a third one is free.
static const char scene_text[] = "particls: 1\n"
                                 "materials: {grain: {density: 1000}}\n"
                                 "shapes: {ball: {sphere: {radius: 0.1}}, wall: {plane: {}}}\n"
                                 "domain: {periodic: [true, false, false], lower: [0, 0, 0], upper: [1, 1, 1]}\n"
                                 "bodies:\n"
                                 "  - {name: floor, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}\n"
                                 "  - {name: left, shape: ball, material: grain, position: [0.05, 0, 0.099]}\n"
                                 "  - {name: right, shape: ball, material: grain, position: [0.852, 0, 0.3]}\n"
                                 "  - {name: far, shape: ball, material: grain, position: [0.852, 0, 0.099]}\n"
                                 "contact: [{between: all, law: elastic, kn: 10000, ks: 0.001, friction: 0}]\n"
                                 "time: {end: 1, dt: 1.0e-5}\n";

static pls_world *touching_world(void)
{
    pls_scene *scene;
    pls_world *world;
    must(pls_write_file("touching.yaml", scene_text, strlen(scene_text)));
    must(pls_scene_load("touching.yaml", NULL, 0, &scene));
    must(pls_scene_build(scene, &world));
    must(pls_world_prepare(world));
    pls_scene_free(scene);
    return world;
}

static void expect_array(const char *text, size_t size, const char *name, const double *expected, size_t count)
{
    double found[32];
    assert_int_equal(read_vtk_array(text, size, name, found, sizeof found), count * sizeof(double));
    for (size_t k = 0; k < count; ++k)
    {
        if (!(fabs(found[k] - expected[k]) < 1e-9)) print_error("%s[%zu] is %.17g, expected %.17g\n", name, k, found[k], expected[k]);
        assert_true(fabs(found[k] - expected[k]) < 1e-9);
    }
}

static void bodies_are_points_in_order_and_walls_are_left_out(void **state)
{
    (void)state;
    pls_world *world = touching_world();
    pls_frames_def def = {.field_count = 1};
    strcpy(def.fields[0], "mass");
    must(pls_vtk_write_bodies("bodies.vtp", world, &def));
    char *text;
    size_t size;
    must(pls_read_file("bodies.vtp", &text, &size));
    uint32_t number[3];
    assert_int_equal(read_vtk_array(text, size, "number", number, sizeof number), sizeof number);
    for (uint32_t k = 0; k < 3; ++k) assert_int_equal(number[k], k + 1); // the wall has number 0
    expect_array(text, size, "position", (const double[]){0.05, 0, 0.099, 0.852, 0, 0.3, 0.852, 0, 0.099}, 9);
    expect_array(text, size, "radius", (const double[]){0.1, 0.1, 0.1}, 3);
    const double mass = 1000 * 4.0 / 3 * 3.14159265358979323846 * 0.001;
    expect_array(text, size, "mass", (const double[]){mass, mass, mass}, 3); // asked for
    double inertia[16];
    assert_int_equal(read_vtk_array(text, size, "inertia", inertia, sizeof inertia), -1); // not asked for
    pls_release(&text);
    pls_world_destroy(world);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void contacts_are_lines_across_the_boundary_with_their_forces(void **state)
{
    (void)state;
    pls_world *world = touching_world();
    must(pls_vtk_write_contacts("contacts.vtp", world));
    char *text;
    size_t size;
    must(pls_read_file("contacts.vtp", &text, &size));
    uint32_t i[3];
    uint32_t j[3];
    assert_int_equal(read_vtk_array(text, size, "body_i", i, sizeof i), sizeof i);
    assert_int_equal(read_vtk_array(text, size, "body_j", j, sizeof j), sizeof j);
    // Find the contact of the balls 1 and 3: 0.05 - (0.852 - 1) = 0.198 apart.
    size_t pair = 0;
    while (pair < 3 && !(i[pair] == 1 && j[pair] == 3)) ++pair;
    assert_true(pair < 3);
    double ends[18];
    double force[9];
    double delta[3];
    double normal_force[3];
    assert_int_equal(read_vtk_array(text, size, "position", ends, sizeof ends), sizeof ends);
    assert_int_equal(read_vtk_array(text, size, "force", force, sizeof force), sizeof force);
    assert_int_equal(read_vtk_array(text, size, "delta", delta, sizeof delta), sizeof delta);
    assert_int_equal(read_vtk_array(text, size, "normal_force", normal_force, sizeof normal_force), sizeof normal_force);
    assert_true(fabs(delta[pair] - overlap) < 1e-12);
    assert_true(fabs(normal_force[pair] - kn * overlap) < 1e-8);
    assert_true(fabs(force[3 * pair] - kn * overlap) < 1e-8); // the other ball is on the left of ball 1, which is pushed to the right
    assert_true(fabs(ends[6 * pair] - 0.05) < 1e-12);
    assert_true(fabs(ends[6 * pair + 3] - (0.05 - 0.198)) < 1e-12); // the near image, not the far one
    pls_release(&text);
    pls_world_destroy(world);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void an_unknown_field_is_told_with_a_suggestion(void **state)
{
    (void)state;
    pls_world *world = touching_world();
    pls_frames_def def = {.field_count = 1};
    strcpy(def.fields[0], "velocty");
    assert_int_equal(pls_vtk_write_bodies("bodies.vtp", world, &def), PLS_NOT_FOUND);
    assert_non_null(strstr(pls_last_message(), "did you mean 'velocity'?"));
    pls_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_points_in_order_and_walls_are_left_out),
        cmocka_unit_test(contacts_are_lines_across_the_boundary_with_their_forces),
        cmocka_unit_test(an_unknown_field_is_told_with_a_suggestion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
