// test_generators.c -- where generators put bodies, against geometry and statistics worked out by hand.

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

typedef struct generated
{
    pls_scene *scene;
    pls_points points;
} generated;

/// A scene with one entry of balls of radius 0.1 placed so.
static pls_status generate(int dimension, const char *place, generated *g)
{
    char text[2048];
    snprintf(text, sizeof text, SCENE_HEAD "dimension: %d\nbodies:\n  - {name: pack, shape: ball, material: grain, %s}\ntime: {end: 1}\n",
             dimension, place);
    PLS_TRY(load_text(text, NULL, &g->scene));
    pls_status status = pls_points_make(g->scene, &g->scene->bodies[0], &g->points);
    if (status != PLS_OK) pls_scene_free(g->scene);
    return status;
}

static generated must_generate(int dimension, const char *place)
{
    generated g;
    if (generate(dimension, place, &g) != PLS_OK) fail_msg("%s", pls_last_message());
    return g;
}

static void release(generated *g)
{
    pls_points_free(&g->points);
    pls_scene_free(g->scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void bounds(const generated *g, pls_vec3 *lower, pls_vec3 *upper)
{
    *lower = *upper = g->points.position[0];
    for (size_t k = 0; k < g->points.count; ++k)
    {
        pls_vec3 p = g->points.position[k];
        *lower = pls_vec(fmin(lower->x, p.x), fmin(lower->y, p.y), fmin(lower->z, p.z));
        *upper = pls_vec(fmax(upper->x, p.x), fmax(upper->y, p.y), fmax(upper->z, p.z));
    }
}

static void assert_place(pls_vec3 p, double x, double y, double z)
{
    assert_true(fabs(p.x - x) < 1e-14 && fabs(p.y - y) < 1e-14 && fabs(p.z - z) < 1e-14);
}

static double distance(const generated *g, size_t a, size_t b) { return pls_length(pls_sub(g->points.position[a], g->points.position[b])); }

static double radius_of(const generated *g, size_t k) { return 0.1 * (g->points.scale ? g->points.scale[k] : 1.0); }

// ---------------------------------------------------------------------------------------------------------------------------------------

static void the_pack_of_the_compression_example_holds_16500_spheres_within_its_bounds(void **state)
{
    (void)state;
    generated g = must_generate(3, "place: {hex_pack: {count: [22, 25, 30], corner: [1, 2, 3]}}");
    assert_int_equal(g.points.count, 16500);
    pls_vec3 lower, upper;
    bounds(&g, &lower, &upper);
    const double R = 0.1;
    assert_place(lower, 1 + R, 2 + R, 3 + R);
    assert_place(upper, 1 + R + R * 43, 2 + R + R * sqrt(3) * (24 + 1.0 / 3), 3 + R + R * 2 * sqrt(6) / 3 * 29);
    release(&g);
}

static void hex_packed_bodies_are_numbered_along_x_then_y_then_z(void **state)
{
    (void)state;
    generated g = must_generate(3, "place: {hex_pack: {count: [2, 2, 2], spacing: 2}}");
    const double row = sqrt(3), layer = 2 * sqrt(6) / 3;
    assert_place(g.points.position[0], 1, 1, 1);
    assert_place(g.points.position[1], 3, 1, 1);
    assert_place(g.points.position[2], 2, 1 + row, 1);
    assert_place(g.points.position[4], 2, 1 + row / 3, 1 + layer);
    assert_place(g.points.position[6], 1, 1 + row * 4 / 3, 1 + layer); // j + k even: not shifted
    release(&g);
}

static void a_sphere_within_a_hex_pack_has_twelve_neighbours_at_its_diameter(void **state)
{
    (void)state;
    generated g = must_generate(3, "scale: 0.5, place: {hex_pack: {count: [5, 5, 5]}}");
    size_t middle = 2 + 5 * (2 + 5 * 2), touching = 0;
    for (size_t k = 0; k < g.points.count; ++k)
    {
        if (k == middle) continue;
        double d = distance(&g, middle, k);
        assert_true(d > 0.1 - 1e-15);
        touching += d < 0.1 + 1e-12;
    }
    assert_int_equal(touching, 12);
    release(&g);
}

static void in_2d_the_hex_pack_is_the_triangular_lattice(void **state)
{
    (void)state;
    generated g = must_generate(2, "place: {hex_pack: {count: [5, 5], corner: [-1, -1]}}");
    assert_int_equal(g.points.count, 25);
    assert_place(g.points.position[0], -0.9, -0.9, 0);
    assert_place(g.points.position[5], -0.8, -0.9 + 0.1 * sqrt(3), 0);
    size_t touching = 0;
    for (size_t k = 0; k < 25; ++k) touching += k != 12 && distance(&g, 12, k) < 0.2 + 1e-12;
    assert_int_equal(touching, 6);
    release(&g);
}

static void a_lattice_fills_boxes_of_its_spacing(void **state)
{
    (void)state;
    generated g = must_generate(3, "place: {lattice: {count: [2, 3, 4], spacing: 0.5, corner: [1, 0, 0]}}");
    assert_int_equal(g.points.count, 24);
    assert_place(g.points.position[0], 1.25, 0.25, 0.25);
    assert_place(g.points.position[1], 1.75, 0.25, 0.25);
    assert_place(g.points.position[2], 1.25, 0.75, 0.25);
    assert_place(g.points.position[23], 1.75, 1.25, 1.75);
    release(&g);
    g = must_generate(2, "place: {lattice: {count: [2, 3]}}");
    assert_place(g.points.position[5], 0.3, 0.5, 0);
    release(&g);
}

// ---------------------------------------------------------------------------------------------------------------------------------------

/// Brute force over all pairs; also that every body lies in the box lower..upper as a whole.
static void assert_no_overlap(const generated *g, double gap, pls_vec3 lower, pls_vec3 upper)
{
    for (size_t a = 0; a < g->points.count; ++a)
    {
        pls_vec3 p = g->points.position[a];
        double r = radius_of(g, a) * (1 - 1e-12);
        assert_true(p.x - r >= lower.x && p.y - r >= lower.y && p.x + r <= upper.x && p.y + r <= upper.y);
        if (g->scene->dimension == 3)
            assert_true(p.z - r >= lower.z && p.z + r <= upper.z);
        else
            assert_true(p.z == 0.0);
        for (size_t b = 0; b < a; ++b)
        {
            if (distance(g, a, b) < (radius_of(g, a) + radius_of(g, b) + gap) * (1 - 1e-12)) fail_msg("bodies %zu and %zu overlap", a, b);
        }
    }
}

static void random_packings_have_no_overlap(void **state)
{
    (void)state;
    generated g = must_generate(3, "place: {random: {count: 500, box: {lower: [-1, 0, 1], upper: [1, 2, 3.2]}}}");
    assert_no_overlap(&g, 0.0, pls_vec(-1, 0, 1), pls_vec(1, 2, 3.2));
    release(&g);
    g = must_generate(2, "place: {random: {count: 400, gap: 0.01, box: {lower: [0, 0], upper: [6, 6]}, radius: {uniform: [0.05, 0.15]}}}");
    assert_no_overlap(&g, 0.01, pls_vec(0, 0, 0), pls_vec(6, 6, 0));
    release(&g);
}

static void sizes_of_one_to_a_hundred_are_packed_without_overlap(void **state)
{
    (void)state;
    generated g = must_generate(3, "place: {random: {count: 8000, box: {lower: [0, 0, 0], upper: [20, 20, 20]}, "
                                   "radius: {power: {min: 0.02, max: 2, exponent: -2.5}}}}");
    assert_no_overlap(&g, 0.0, pls_vec(0, 0, 0), pls_vec(20, 20, 20));
    double least = INFINITY, most = 0;
    for (size_t k = 0; k < g.points.count; ++k) least = fmin(least, radius_of(&g, k)), most = fmax(most, radius_of(&g, k));
    assert_true(most / least > 50);
    release(&g);
}

static void a_random_packing_depends_on_its_seed_and_on_nothing_else(void **state)
{
    (void)state;
    generated a =
        must_generate(3, "place: {random: {count: 200, box: {lower: [0, 0, 0], upper: [3, 3, 3]}, radius: {uniform: [0.05, 0.1]}}}");
    generated b = must_generate(
        3, "place: {random: {seed: 1, count: 200, box: {lower: [0, 0, 0], upper: [3, 3, 3]}, radius: {uniform: [0.05, 0.1]}}}");
    generated c = must_generate(
        3, "place: {random: {seed: 2, count: 200, box: {lower: [0, 0, 0], upper: [3, 3, 3]}, radius: {uniform: [0.05, 0.1]}}}");
    assert_memory_equal(a.points.position, b.points.position, 200 * sizeof(pls_vec3));
    assert_memory_equal(a.points.scale, b.points.scale, 200 * sizeof(double));
    size_t same = 0;
    for (size_t k = 0; k < 200; ++k) same += a.points.scale[k] == c.points.scale[k] || a.points.position[k].x == c.points.position[k].x;
    assert_int_equal(same, 0);
    generated d =
        must_generate(3, "place: {random: {count: 50, box: {lower: [0, 0, 0], upper: [3, 3, 3]}, radius: {uniform: [0.05, 0.1]}}}");
    assert_memory_equal(a.points.scale, d.points.scale, 50 * sizeof(double)); // a body's size does not depend on how many there are
    pls_points_free(&a.points), pls_scene_free(a.scene);
    pls_points_free(&b.points), pls_scene_free(b.scene);
    pls_points_free(&c.points), pls_scene_free(c.scene);
    release(&d);
}

static void a_full_box_is_reported_with_how_many_fitted(void **state)
{
    (void)state;
    generated g;
    assert_int_equal(generate(2, "place: {random: {count: 10000, attempts: 500, box: {lower: [0, 0], upper: [2, 2]}}}", &g), PLS_SCENE);
    size_t fitted = 0, wanted = 0;
    const char *part = strstr(pls_last_message(), "only ");
    assert_non_null(part);
    assert_int_equal(sscanf(part, "only %zu of %zu bodies fitted", &fitted, &wanted), 2);
    assert_int_equal(wanted, 10000);
    // Random sequential addition of discs jams at an area fraction of 0.547 (in an unbounded plane): 70 discs of radius 0.1 on 4 m^2.
    assert_in_range(fitted, 45, 70);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// Mean of f(r) over a packing of many small bodies in a large box.
static double mean(const generated *g, double (*f)(double))
{
    double sum = 0;
    for (size_t k = 0; k < g->points.count; ++k) sum += f(radius_of(g, k));
    return sum / (double)g->points.count;
}

static double identity(double r) { return r; }
static double square(double r) { return r * r; }

#define MANY "place: {random: {count: 20000, box: {lower: [0, 0, 0], upper: [1000, 1000, 1000]}, radius: "

static void uniform_radii_have_the_moments_of_their_distribution(void **state)
{
    (void)state;
    generated g = must_generate(3, MANY "{uniform: [1, 3]}}}");
    // mean 2, variance 4/12; of 20000 draws the mean has the standard error sqrt(1/3/20000) = 0.0041
    assert_true(fabs(mean(&g, identity) - 2.0) < 4 * 0.0041);
    assert_true(fabs(mean(&g, square) - (4 + 1.0 / 3)) < 0.07); // var(r^2) = 242/5 - (13/3)^2 = 29.6/... : standard error 0.0166
    release(&g);
}

static void lognormal_radii_have_the_moments_of_their_distribution(void **state)
{
    (void)state;
    generated g = must_generate(3, MANY "{lognormal: {median: 2, sigma: 0.25, min: 0.01, max: 100}}}}");
    assert_true(fabs(mean(&g, log) - log(2)) < 4 * 0.25 / sqrt(20000));
    assert_true(fabs(mean(&g, identity) - 2 * exp(0.25 * 0.25 / 2)) < 4 * 0.52 / sqrt(20000));
    release(&g);
    g = must_generate(3, MANY "{lognormal: {median: 2, sigma: 2, min: 1.5, max: 2.5}}}}");
    for (size_t k = 0; k < g.points.count; ++k) assert_true(radius_of(&g, k) >= 1.5 && radius_of(&g, k) <= 2.5);
    release(&g);
}

static void power_law_radii_have_the_mean_of_their_distribution(void **state)
{
    (void)state;
    generated g = must_generate(3, MANY "{power: {min: 1, max: 4, exponent: -3}}}}");
    // density 2 r^-3 / (1 - 1/16): mean = 2 (1 - 1/4) / (15/16) = 1.6, E r^2 = 2 ln 4 / (15/16)
    double variance = 2 * log(4) * 16 / 15 - 1.6 * 1.6;
    assert_true(fabs(mean(&g, identity) - 1.6) < 4 * sqrt(variance / 20000));
    release(&g);
    g = must_generate(3, MANY "{power: {min: 1, max: 4, exponent: -1}}}}");
    assert_true(fabs(mean(&g, log) - log(4) / 2) < 4 * log(4) / sqrt(12.0 * 20000)); // ln r is uniform
    release(&g);
}

static void table_radii_come_in_their_fractions(void **state)
{
    (void)state;
    generated g = must_generate(3, MANY "{table: [[1, 3], [2, 0], [4, 1]]}}}");
    size_t small = 0, large = 0;
    for (size_t k = 0; k < g.points.count; ++k)
    {
        small += fabs(radius_of(&g, k) - 1) < 1e-12;
        large += fabs(radius_of(&g, k) - 4) < 1e-12;
    }
    assert_int_equal(small + large, 20000);
    assert_true(fabs((double)small / 20000 - 0.75) < 4 * sqrt(0.75 * 0.25 / 20000));
    release(&g);
}

// ---------------------------------------------------------------------------------------------------------------------------------------

static void tables_give_places_sizes_velocities_and_orientations(void **state)
{
    (void)state;
    const char table[] =
        "# made by hand\r\nqw, x, y, z, radius, vx, wz, qz\r\n\r\n2, 1, 2, 3, 0.2, 4, 5, 0\r\n0, -1, -2, -3, 0.05, 0, 0, -3";
    assert_int_equal(pls_write_file("bodies.csv", table, strlen(table)), PLS_OK);
    generated g = must_generate(3, "place: {csv: {file: bodies.csv}}");
    assert_int_equal(g.points.count, 2);
    assert_place(g.points.position[1], -1, -2, -3);
    assert_true(g.points.scale[0] == 2.0 && g.points.scale[1] == 0.5);
    assert_true(g.points.velocity[0].x == 4 && g.points.velocity[0].y == 0);
    assert_true(g.points.angular_velocity[0].z == 5);
    assert_true(g.points.orientation[0].w == 1 && g.points.orientation[1].z == -1);
    release(&g);
}

static void listed_points_are_taken_as_they_are(void **state)
{
    (void)state;
    generated g = must_generate(2, "place: {points: [[1, 2], [\"2*pi\", 4]]}");
    assert_int_equal(g.points.count, 2);
    assert_place(g.points.position[1], 2 * M_PI, 4, 0);
    release(&g);
}

static pls_status generate_job(void *context)
{
    generated *g = context;
    pls_status status = pls_points_make(g->scene, &g->scene->bodies[0], &g->points);
    pls_points_free(&g->points);
    return status;
}

static void generators_survive_allocation_failures(void **state)
{
    (void)state;
    const char table[] = "x,y,z,radius,vx,wx,qw\n1,2,3,0.2,4,5,1\n";
    assert_int_equal(pls_write_file("bodies.csv", table, strlen(table)), PLS_OK);
    const char *places[] = {"place: {random: {count: 50, box: {lower: [0, 0, 0], upper: [3, 3, 3]}}}", "place: {csv: {file: bodies.csv}}",
                            "place: {hex_pack: {count: [2, 2, 2]}}"};
    failing_allocator_install();
    for (size_t k = 0; k < 3; ++k)
    {
        generated g = must_generate(3, places[k]);
        pls_points_free(&g.points);
        assert_true(assert_survives_allocation_failures(generate_job, &g) > 0);
        pls_scene_free(g.scene);
    }
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_pack_of_the_compression_example_holds_16500_spheres_within_its_bounds),
        cmocka_unit_test(hex_packed_bodies_are_numbered_along_x_then_y_then_z),
        cmocka_unit_test(a_sphere_within_a_hex_pack_has_twelve_neighbours_at_its_diameter),
        cmocka_unit_test(in_2d_the_hex_pack_is_the_triangular_lattice),
        cmocka_unit_test(a_lattice_fills_boxes_of_its_spacing),
        cmocka_unit_test(random_packings_have_no_overlap),
        cmocka_unit_test(sizes_of_one_to_a_hundred_are_packed_without_overlap),
        cmocka_unit_test(a_random_packing_depends_on_its_seed_and_on_nothing_else),
        cmocka_unit_test(a_full_box_is_reported_with_how_many_fitted),
        cmocka_unit_test(uniform_radii_have_the_moments_of_their_distribution),
        cmocka_unit_test(lognormal_radii_have_the_moments_of_their_distribution),
        cmocka_unit_test(power_law_radii_have_the_mean_of_their_distribution),
        cmocka_unit_test(table_radii_come_in_their_fractions),
        cmocka_unit_test(tables_give_places_sizes_velocities_and_orientations),
        cmocka_unit_test(listed_points_are_taken_as_they_are),
        cmocka_unit_test(generators_survive_allocation_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
