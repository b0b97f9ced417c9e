// Shapes in scenes: what they are made from, mixes and orientations drawn at random, and the bodies that come of them, against closed forms and statistics.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "scene/generators.h"
#include "scene/scene_file.h"
#include "support/failing_allocator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#define HEAD "particls: 1\nmaterials: {grain: {density: 1000}}\n"
#define TAIL "contact: [{between: all, law: elastic, kn: 1000}]\ntime: {end: 1, dt: 1.0e-4}\n"

static void assert_near(double value, double known, double error)
{
    if (!(fabs(value - known) <= error)) fail_msg("%.15g is not %.15g, off by %g", value, known, value - known);
}

static const pls_shape *shape_of(const pls_scene *scene, const char *name)
{
    int k = pls_scene_find_shape(scene, name);
    assert_true(k >= 0);
    return scene->shapes[k].made;
}

static const char tetrahedron[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

// ---- what shapes are made from --------------------------------------------------------------------------------------------------------------------------------

static void points_files_and_parts_are_read(void **state)
{
    (void)state;
    assert_int_equal(pls_write_file("tet.obj", tetrahedron, strlen(tetrahedron)), PLS_OK);
    pls_scene *scene = must_load(
        HEAD "vars: {a: 2}\nshapes:\n"
             "  pair: {compound: {parts: [{shape: rod, position: [0, 3, 0], orientation: {axis: [0, 0, 2], angle: \"pi/2\"}, scale: "
             "\"a\"}, {shape: corner}]}}\n" // before its parts
             "  corner: {polyhedron: {points: [[0, 0, 0], [\"a\", 0, 0], [0, \"a\", 0], [0, 0, \"a\"]]}}\n"
             "  file: {polyhedron: {path: ./tet.obj}}\n"
             "  rod: {box: {half: [0.5, 0.1, 0.1]}}\n"
             "  bar: {prism: {points: [[0, 0], [1, 0], [0, 1]], height: 0.5}}\n"
             "  chute: {mesh: {path: tet.obj, scale: 10}}\n"
             "bodies:\n  - {shape: rod, material: grain, position: [0, 0, 0]}\n" TAIL);
    assert_near(shape_of(scene, "corner")->mass.volume, 8.0 / 6.0, 1e-15);
    assert_near(shape_of(scene, "file")->mass.volume, 1.0 / 6.0, 1e-15);
    assert_near(shape_of(scene, "bar")->mass.volume, 0.25, 1e-15);
    assert_near(shape_of(scene, "chute")->upper.x, 10.0, 1e-12);
    const pls_shape *pair = shape_of(scene, "pair");
    assert_near(pair->mass.volume, 8.0 / 6.0 + 8.0 * 0.04, 1e-14);
    assert_near(pair->upper.y, 4.0, 1e-14); // the rod stands along y: 3 + 2 * 0.5
    assert_near(pair->lower.x, -0.2, 1e-14);
    assert_int_equal(pls_scene_input_count(scene), 2);
    pls_scene_free(scene);
    scene = must_load(HEAD "dimension: 2\nshapes:\n"
                           "  brick: {box: {half: [0.5, 0.1], rounding: 0.05}}\n"
                           "  tri: {polygon: {points: [[0, 0], [1, 0], [0, 1]]}}\n"
                           "  egg: {ellipse: {half: [0.5, 0.2]}}\n"
                           "  both: {compound: {parts: [{shape: tri}, {shape: tri, position: [3, 0], orientation: 1.5}]}}\n"
                           "  floor: {polyline: {points: [[0, 0], [1, 0], [1, 1]], closed: 1}}\n"
                           "  half: {half_plane: {}}\n"
                           "bodies:\n  - {shape: floor, material: grain, position: [0, 0], fixed: true}\n" TAIL);
    assert_near(shape_of(scene, "tri")->mass.volume, 0.5, 1e-15);
    assert_near(shape_of(scene, "both")->mass.volume, 1.0, 1e-15);
    assert_near(shape_of(scene, "egg")->mass.volume, M_PI * 0.1, 1e-15);
    assert_near(shape_of(scene, "brick")->upper.x, 0.5, 1e-15);
    assert_int_equal(shape_of(scene, "floor")->part_count, 3);
    pls_scene_free(scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// What is written down of a run can be run anywhere: files keep their places, and the hash sees their contents, not where they lie.
static void used_scenes_find_their_files(void **state)
{
    (void)state;
    static const char text[] = HEAD "shapes:\n  stone: {polyhedron: {path: tet.obj}}\n  ball: {sphere: {radius: 0.1}}\n"
                                    "  two: {compound: {parts: [{shape: ball}, {shape: ball, position: [1, 0, 0]}]}}\n"
                                    "bodies:\n  - {shape: {stone: 2, two: 1}, material: grain, orientation: random, seed: 5, "
                                    "place: {lattice: {count: [2, 2, 2]}}}\n" TAIL;
    assert_int_equal(pls_write_file("tet.obj", tetrahedron, strlen(tetrahedron)), PLS_OK);
    pls_scene *scene = must_load(text), *again = NULL;
    const uint64_t hash = pls_scene_hash(scene);
    char *used = NULL;
    assert_int_equal(pls_scene_used_text(scene, &used), PLS_OK);
    mkdir("elsewhere", 0755);
    assert_int_equal(pls_write_file("elsewhere/used.yaml", used, strlen(used)), PLS_OK);
    pls_scene_free_text(used);
    if (pls_scene_load("elsewhere/used.yaml", NULL, 0, &again) != PLS_OK) fail_msg("%s", pls_last_message());
    assert_true(pls_scene_hash(again) == hash);
    pls_scene_free(again);
    pls_scene_free(scene);
    static const char other[] = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    assert_int_equal(pls_write_file("tet.obj", other, strlen(other)), PLS_OK);
    scene = must_load(text);
    assert_true(pls_scene_hash(scene) != hash);
    pls_scene_free(scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

// ---- drawn at random ------------------------------------------------------------------------------------------------------------------------------------------

typedef struct generated
{
    pls_scene *scene;
    pls_points points;
} generated;

/// Balls of 0.1 and of 0.2, and rods that reach to sqrt(0.11) = 0.33.
static generated generate(int dimension, const char *entry)
{
    char text[2048];
    generated g;
    snprintf(text, sizeof text,
             HEAD "dimension: %d\nshapes: {small: {sphere: {radius: 0.1}}, big: {sphere: {radius: 0.2}}, rod: {box: {half: %s}}}\n"
                  "bodies:\n  - {material: grain, %s}\ntime: {end: 1}\n",
             dimension, dimension == 2 ? "[0.3, 0.1]" : "[0.3, 0.1, 0.1]", entry);
    g.scene = must_load(text);
    if (pls_points_make(g.scene, &g.scene->bodies[0], &g.points) != PLS_OK) fail_msg("%s", pls_last_message());
    return g;
}

static void release(generated *g)
{
    pls_points_free(&g->points);
    pls_scene_free(g->scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

static size_t count_of(const generated *g, const char *name)
{
    size_t count = 0;
    for (size_t k = 0; k < g->points.count; ++k)
        count += strcmp(pls_points_shape(g->scene, &g->scene->bodies[0], &g->points, k)->name, name) == 0;
    return count;
}

static double radius_of(const generated *g, size_t k)
{
    return pls_points_shape(g->scene, &g->scene->bodies[0], &g->points, k)->made->radius * (g->points.scale ? g->points.scale[k] : 1.0);
}

static void mixes_have_their_proportions(void **state)
{
    (void)state;
    const double n = 27000.0;
    generated g = generate(3, "shape: {small: 3, big: 1, rod: 2}, place: {lattice: {count: [30, 30, 30]}}");
    const struct
    {
        const char *name;
        double part;
    } wanted[] = {{"small", 0.5}, {"big", 1.0 / 6.0}, {"rod", 1.0 / 3.0}};
    for (int k = 0; k < 3; ++k)
        assert_near((double)count_of(&g, wanted[k].name) / n, wanted[k].part, 4.0 * sqrt(wanted[k].part * (1.0 - wanted[k].part) / n));
    // Neighbours in number know nothing of each other.
    double same = 0.0, expected = 0.25 + 1.0 / 36.0 + 1.0 / 9.0;
    for (size_t k = 1; k < g.points.count; ++k) same += g.points.choice[k] == g.points.choice[k - 1];
    assert_near(same / n, expected, 4.0 * sqrt(expected * (1.0 - expected) / n));
    // Neighbours in space are as far apart as the largest need: rods reach to sqrt(0.11).
    assert_near(g.points.position[1].x - g.points.position[0].x, 2.0 * sqrt(0.11), 1e-14);
    release(&g);
    g = generate(3, "shape: [small, big], place: {lattice: {count: [30, 30, 30], spacing: 7}}");
    assert_near((double)count_of(&g, "big") / n, 0.5, 4.0 * sqrt(0.25 / n));
    assert_near(g.points.position[1].x - g.points.position[0].x, 7.0, 1e-14);
    release(&g);
}

static void mixes_are_packed_without_overlap(void **state)
{
    (void)state;
    for (int sized = 0; sized < 2; ++sized)
    {
        generated g =
            generate(3, sized ? "shape: [small, big, rod], orientation: random, place: {random: {count: 600, radius: {uniform: [0.1, "
                                "0.3]}, box: {lower: [0, 0, 0], upper: [6, 6, 6]}}}"
                              : "shape: [small, big, rod], scale: 1.1, orientation: random, place: {random: {count: 600, box: {lower: "
                                "[0, 0, 0], upper: [6, 6, 6]}}}");
        double least = INFINITY, most = 0.0;
        for (size_t a = 0; a < g.points.count; ++a)
        {
            pls_vec3 p = g.points.position[a];
            const double r = radius_of(&g, a);
            least = fmin(least, r), most = fmax(most, r);
            assert_true(fmin(p.x, fmin(p.y, p.z)) >= r * (1.0 - 1e-12) && fmax(p.x, fmax(p.y, p.z)) <= 6.0 - r * (1.0 - 1e-12));
            for (size_t b = 0; b < a; ++b)
                assert_true(pls_length(pls_sub(p, g.points.position[b])) >= (r + radius_of(&g, b)) * (1.0 - 1e-12));
        }
        if (sized) assert_true(least >= 0.1 - 1e-12 && least < 0.11 && most <= 0.3 + 1e-12 && most > 0.29);
        if (!sized) assert_true(fabs(least - 0.11) < 1e-12 && fabs(most - 1.1 * sqrt(0.11)) < 1e-12);
        release(&g);
    }
}

/// Uniform over all rotations: the angle has the density (1 - cos a) / pi, the axis is as likely anywhere, and so is the image of any direction.
static void random_orientations_are_uniform(void **state)
{
    (void)state;
    const double n = 27000.0;
    generated g = generate(3, "shape: rod, orientation: random, place: {lattice: {count: [30, 30, 30]}}");
    double first[3] = {0}, second[3] = {0}, below[3] = {0};
    for (size_t k = 0; k < g.points.count; ++k)
    {
        pls_quat q = g.points.orientation[k];
        assert_near(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1.0, 1e-14);
        const pls_vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int a = 0; a < 3; ++a)
        {
            double z = pls_rotate(q, axes[a]).z; // uniform in [-1, 1] (Archimedes)
            first[a] += z / n, second[a] += z * z / n;
        }
        double angle = 2.0 * acos(fmin(fabs(q.w), 1.0));
        for (int a = 0; a < 3; ++a) below[a] += angle < 0.25 * M_PI * (a + 1) ? 1.0 / n : 0.0;
    }
    for (int a = 0; a < 3; ++a)
    {
        assert_near(first[a], 0.0, 4.0 * sqrt(1.0 / 3.0 / n));
        assert_near(second[a], 1.0 / 3.0, 4.0 * sqrt(4.0 / 45.0 / n));
        double limit = 0.25 * M_PI * (a + 1), part = (limit - sin(limit)) / M_PI;
        assert_near(below[a], part, 4.0 * sqrt(part * (1.0 - part) / n));
    }
    release(&g);
    g = generate(2, "shape: rod, orientation: random, place: {lattice: {count: [100, 100]}}");
    double cosine = 0.0, twice = 0.0;
    for (size_t k = 0; k < g.points.count; ++k)
    {
        pls_vec3 e = pls_rotate(g.points.orientation[k], pls_vec(1, 0, 0));
        assert_true(e.z == 0.0);
        cosine += e.x / 1e4, twice += (e.x * e.x - e.y * e.y) / 1e4;
    }
    assert_near(cosine, 0.0, 4.0 * sqrt(0.5 / 1e4));
    assert_near(twice, 0.0, 4.0 * sqrt(0.5 / 1e4));
    release(&g);
}

static void draws_depend_on_the_seed_and_on_nothing_else(void **state)
{
    (void)state;
    generated a = generate(3, "shape: [small, big], orientation: random, place: {lattice: {count: [10, 10, 10]}}");
    generated b = generate(3, "shape: [small, big], orientation: random, place: {hex_pack: {count: [10, 10, 2]}}");
    generated c = generate(3, "shape: [small, big], orientation: random, seed: 2, place: {lattice: {count: [10, 10, 10]}}");
    generated d =
        generate(3, "shape: [small, big], orientation: random, place: {random: {count: 100, seed: 2, box: {lower: [0, 0, 0], upper: "
                    "[9, 9, 9]}}}");
    assert_memory_equal(a.points.choice, b.points.choice, 200 * sizeof *a.points.choice);
    assert_memory_equal(a.points.orientation, b.points.orientation, 200 * sizeof(pls_quat));
    assert_memory_not_equal(a.points.choice, c.points.choice, 200 * sizeof *a.points.choice);
    assert_memory_not_equal(a.points.orientation, c.points.orientation, sizeof(pls_quat));
    assert_memory_equal(c.points.choice, d.points.choice, 100 * sizeof *a.points.choice); // the packing's seed serves
    pls_points_free(&a.points), pls_scene_free(a.scene);
    pls_points_free(&b.points), pls_scene_free(b.scene);
    pls_points_free(&c.points), pls_scene_free(c.scene);
    release(&d);
}

// ---- bodies ---------------------------------------------------------------------------------------------------------------------------------------------------

static pls_quat orientation_of(const pls_world *world, size_t body)
{
    return (pls_quat){body_value(world, "orientation", body, 0), body_value(world, "orientation", body, 1),
                      body_value(world, "orientation", body, 2), body_value(world, "orientation", body, 3)};
}

/// A dumbbell along (1, 1, 0) of its own frame, off its origin: two balls of radius 0.1, whose centres are 0.4 sqrt(2) apart.
static void bodies_have_the_mass_and_the_frame_of_their_shape(void **state)
{
    (void)state;
    pls_scene *scene =
        must_load(HEAD "shapes:\n  ball: {sphere: {radius: 0.1}}\n"
                       "  bell: {compound: {parts: [{shape: ball, position: [1, 0, 0]}, {shape: ball, position: [1.4, 0.4, 0]}]}}\n"
                       "bodies:\n"
                       "  - {name: one, shape: bell, material: grain, position: [0, 0, 0]}\n"
                       "  - {name: two, shape: bell, material: grain, position: [5, 6, 7], scale: 3, "
                       "orientation: {axis: [0, 0, 1], angle: \"pi/4\"}}\n" TAIL);
    pls_world *world = must_build(scene);
    const double ball = 4.0 / 3.0 * M_PI * 1e-3, d = 0.2 * sqrt(2.0), along = 2.0 * 0.4 * ball * 0.01, across = along + 2.0 * ball * d * d;
    for (size_t body = 0; body < 2; ++body)
    {
        const double s = body == 0 ? 1.0 : 3.0, density = 1000.0;
        assert_near(body_value(world, "mass", body, 0), density * 2.0 * ball * s * s * s, 1e-12 * s * s * s);
        assert_near(body_value(world, "radius", body, 0), s * (d + 0.1), 1e-12);
        assert_near(body_value(world, "position", body, 0), body == 0 ? 0.0 : 5.0, 0.0); // of the centre of mass
        int least = 0;
        double moments[3];
        for (int c = 0; c < 3; ++c)
        {
            moments[c] = body_value(world, "inertia", body, c);
            if (moments[c] < moments[least]) least = c;
        }
        for (int c = 0; c < 3; ++c) assert_near(moments[c], density * pow(s, 5) * (c == least ? along : across), 1e-12 * pow(s, 5));
        // The axis of the least moment lies along (1, 1, 0), turned with the second body onto y.
        pls_vec3 axis = pls_rotate(orientation_of(world, body), pls_vec(least == 0, least == 1, least == 2));
        pls_vec3 known = body == 0 ? pls_vec(sqrt(0.5), sqrt(0.5), 0.0) : pls_vec(0.0, 1.0, 0.0);
        assert_near(fabs(pls_dot(axis, known)), 1.0, 1e-14);
    }
    // Anisotropic, so that torques turn it about its own axes.
    pls_field_view flags;
    assert_int_equal(pls_world_body_field(world, "flags", &flags), PLS_OK);
    assert_int_equal(((const uint32_t *)flags.data)[0] & 8, 8);
    pls_world_destroy(world);
    pls_scene_free(scene);

    scene = must_load(HEAD "dimension: 2\nthickness: 0.5\nshapes: {brick: {box: {half: [0.3, 0.1]}}}\n"
                           "bodies:\n  - {shape: brick, material: grain, position: [0, 0], scale: 2, orientation: 0.3}\n" TAIL);
    world = must_build(scene);
    const double mass = 1000.0 * 0.5 * 4.0 * 0.03 * 4.0;
    assert_near(body_value(world, "mass", 0, 0), mass, 1e-12);
    assert_near(body_value(world, "inertia", 0, 2), mass * 4.0 * (0.09 + 0.01) / 3.0, 1e-12);
    assert_near(body_value(world, "radius", 0, 0), 2.0 * sqrt(0.1), 1e-14);
    assert_near(body_value(world, "orientation", 0, 3), sin(0.15), 1e-15);
    assert_int_equal(pls_world_body_field(world, "flags", &flags), PLS_OK);
    assert_int_equal(((const uint32_t *)flags.data)[0] & 8, 0); // about one axis only
    pls_world_destroy(world);
    pls_scene_free(scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void bodies_of_a_mix_have_the_mass_of_their_own_shape(void **state)
{
    (void)state;
    pls_scene *scene = must_load(HEAD "shapes: {ball: {sphere: {radius: 0.1}}, rod: {box: {half: [0.3, 0.1, 0.1]}}}\n"
                                      "bodies:\n  - {shape: [ball, rod], material: grain, place: {lattice: {count: [4, 4, 4]}}}\n" TAIL);
    pls_world *world = must_build(scene);
    size_t rods = 0;
    for (size_t k = 0; k < 64; ++k)
    {
        bool rod = body_value(world, "radius", k, 0) > 0.2;
        rods += rod;
        assert_near(body_value(world, "mass", k, 0), rod ? 24.0 : 4.0 / 3.0 * M_PI, 1e-12);
    }
    assert_in_range(rods, 16, 48); // 32, four standard deviations of 4
    pls_world_destroy(world);
    pls_scene_free(scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

static pls_status load_and_place(void *context)
{
    (void)context;
    pls_scene *scene = NULL;
    pls_points points = {0};
    PLS_TRY(pls_scene_load("test_scene.yaml", NULL, 0, &scene));
    pls_status status = pls_points_make(scene, &scene->bodies[0], &points);
    pls_points_free(&points);
    pls_scene_free(scene);
    return status;
}

static void shapes_survive_allocation_failures(void **state)
{
    (void)state;
    static const char text[] =
        HEAD "shapes:\n  corner: {polyhedron: {points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}}\n"
             "  pair: {compound: {parts: [{shape: corner}, {shape: corner, position: [2, 0, 0]}]}}\n"
             "  chute: {mesh: {path: tet.obj}}\n"
             "bodies:\n  - {shape: [pair, corner], orientation: random, material: grain, place: {lattice: {count: [2, 2, 2]}}}\n" TAIL;
    assert_int_equal(pls_write_file("tet.obj", tetrahedron, strlen(tetrahedron)), PLS_OK);
    assert_int_equal(pls_write_file("test_scene.yaml", text, strlen(text)), PLS_OK);
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(load_and_place, NULL) > 0);
    failing_allocator_remove();
}

// ---- densities ------------------------------------------------------------------------------------------------------------------------------------------------

/// A ball with its centre of mass c = 0.01 m below its middle, on a floor without friction: N = m g lifts it back, so that it rocks with w^2 = g c / (I / m) and
/// I / m = 2/5 R^2 - c^2, but for amplitude^2 / 16. After a quarter of the period it stands upright.
static void a_ball_that_is_heavier_below_rocks(void **state)
{
    (void)state;
    const double R = 0.1, c = 0.01, g = 9.81, tilt = 0.05, w = sqrt(g * c / (0.4 * R * R - c * c)), quarter = 0.5 * M_PI / w;
    char text[1024];
    snprintf(text, sizeof text,
             "particls: 1\nvars: {a: 0.01}\nmaterials: {grain: {density: 1000}}\n"
             "shapes:\n  ball: {density_factor: \"1 - 5*a/0.1^2*z\", sphere: {radius: 0.1}}\n  wall: {plane: {}}\n"
             "bodies:\n  - {name: ball, shape: ball, material: grain, position: [0, 0, %.17g], orientation: {axis: [1, 0, 0], angle: %g}}\n"
             "  - {name: floor, shape: wall, material: grain, position: [0, 0, 0], normal: [0, 0, 1]}\n"
             "forces: [{gravity: [0, 0, -9.81]}]\n"
             "contact: [{between: all, law: elastic, kn: 1.0e+6}]\ntime: {end: 1, dt: 1.0e-4}\n",
             R - c * cos(tilt) - 4.0 / 3.0 * M_PI * 1000.0 * R * R * R * g / 1e6, tilt);
    pls_scene *scene = must_load(text);
    pls_world *world = must_build(scene);
    assert_near(body_value(world, "mass", 0, 0), 4.0 / 3.0 * M_PI * 1000.0 * R * R * R, 1e-5);
    assert_int_equal(pls_world_prepare(world), PLS_OK);
    assert_near(2.0 * asin(body_value(world, "orientation", 0, 1)), tilt, 1e-6);
    double before = tilt, angle = tilt, time = 0.0;
    while (angle > 0.0 && time < 1.0)
    {
        assert_int_equal(pls_step(world), PLS_OK);
        before = angle, angle = 2.0 * asin(body_value(world, "orientation", 0, 1)), time += 1e-4;
    }
    time -= 1e-4 * angle / (angle - before);
    assert_near(time / quarter, 1.0, 1e-3);
    pls_world_destroy(world);
    pls_scene_free(scene);
}

/// The field is part of the scene: it stands in what is written of it, loads to the same, and another field is another scene.
static void densities_are_part_of_the_scene(void **state)
{
    (void)state;
    static const char text[] =
        HEAD "vars: {a: 3}\nshapes: {ball: {sphere: {radius: 0.1}, density_factor: \"1 + a*z\"}, even: {sphere: {radius: 0.1}}}\n"
             "bodies:\n  - {shape: ball, material: grain, position: [0, 0, 0]}\n" TAIL;
    pls_scene *scene = must_load(text), *again = NULL;
    const uint64_t hash = pls_scene_hash(scene);
    char *used = NULL;
    assert_int_equal(pls_scene_used_text(scene, &used), PLS_OK);
    assert_non_null(strstr(used, "ball: {sphere: {radius: 0.1}, density_factor: \"1 + a*z\"}"));
    assert_int_equal(pls_write_file("density.yaml", used, strlen(used)), PLS_OK);
    pls_scene_free_text(used);
    assert_near(shape_of(scene, "ball")->mass.centre.z, 3.0 * 0.01 / 5.0, 1e-7);
    if (pls_scene_load("density.yaml", NULL, 0, &again) != PLS_OK) fail_msg("%s", pls_last_message());
    assert_true(pls_scene_hash(again) == hash);
    assert_memory_equal(&shape_of(again, "ball")->mass, &shape_of(scene, "ball")->mass, sizeof(pls_mass_properties));
    pls_scene_free(again);
    pls_scene_free(scene);
    const char *sets[] = {"shapes.ball.density_factor=1 + 4*z", "shapes.even.density_factor=1 + 4*z"};
    for (int k = 0; k < 2; ++k)
    {
        if (load_text(text, sets[k], &again) != PLS_OK) fail_msg("%s", pls_last_message());
        assert_true(pls_scene_hash(again) != hash);
        assert_near(shape_of(again, k ? "even" : "ball")->mass.centre.z, 4.0 * 0.01 / 5.0, 1e-7);
        pls_scene_free(again);
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_files_and_parts_are_read),
        cmocka_unit_test(used_scenes_find_their_files),
        cmocka_unit_test(mixes_have_their_proportions),
        cmocka_unit_test(mixes_are_packed_without_overlap),
        cmocka_unit_test(random_orientations_are_uniform),
        cmocka_unit_test(draws_depend_on_the_seed_and_on_nothing_else),
        cmocka_unit_test(bodies_have_the_mass_and_the_frame_of_their_shape),
        cmocka_unit_test(bodies_of_a_mix_have_the_mass_of_their_own_shape),
        cmocka_unit_test(shapes_survive_allocation_failures),
        cmocka_unit_test(a_ball_that_is_heavier_below_rocks),
        cmocka_unit_test(densities_are_part_of_the_scene),
    };
    return cmocka_run_group_tests_name("shapes in scenes", tests, NULL, NULL);
}
