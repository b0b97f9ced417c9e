// Volume of grains cut by a box, against caps, wedges and octants in closed form.

#include "observe/solid_volume.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;
static const double promised = 1e-3; // of the whole volume

static double ball_distance(const pls_shape *shape, pls_vec3 X) { return pls_length(X) - shape->values[0]; }

static double disc_distance(const pls_shape *shape, pls_vec3 X) { return hypot(X.x, X.y) - shape->values[0]; }

/// A cuboid of half edges `values` (P1 eq. 26).
static double cuboid_distance(const pls_shape *shape, pls_vec3 X)
{
    const double *values = shape->values;
    pls_vec3 d = pls_vec(fabs(X.x) - values[0], fabs(X.y) - values[1], fabs(X.z) - values[2]);
    double outside = pls_length(pls_vec(fmax(d.x, 0), fmax(d.y, 0), fmax(d.z, 0)));
    return outside + fmin(fmax(d.x, fmax(d.y, d.z)), 0);
}

static const pls_shape_ops ball_ops = {.sdf = ball_distance};
static const pls_shape_ops disc_ops = {.sdf = disc_distance};
static const pls_shape_ops cuboid_ops = {.sdf = cuboid_distance};
#define AS_IT_IS .principal = {1, 0, 0, 0}
static const pls_shape unit_ball = {.ops = &ball_ops, .values = (const double[]){1}, AS_IT_IS},
                       unit_disc = {.ops = &disc_ops, .values = (const double[]){1}, AS_IT_IS};
static const pls_shape cuboid = {.ops = &cuboid_ops, .values = (const double[]){0.5, 0.4, 0.3}, AS_IT_IS};

static pls_solid ball(pls_vec3 position, double radius)
{
    return (pls_solid){.shape = &unit_ball,
                       .dimension = 3,
                       .position = position,
                       .orientation = pls_quat_identity(),
                       .scale = radius,
                       .radius = radius,
                       .volume = 4.0 / 3.0 * pi * radius * radius * radius};
}

static pls_solid disc(pls_vec3 position, double radius)
{
    pls_solid solid = ball(position, radius);
    solid.shape = &unit_disc;
    solid.dimension = 2;
    solid.volume = pi * radius * radius;
    return solid;
}

static void expect_part(const pls_solid *solid, pls_vec3 lower, pls_vec3 upper, double expected)
{
    double error = pls_solid_volume_in_box(solid, lower, upper) - expected;
    assert_true(fabs(error) <= promised * solid->volume);
}

static void a_ball_inside_counts_whole_and_one_outside_not_at_all(void **state)
{
    (void)state;
    pls_solid solid = ball(pls_vec(0.1, 0.2, 0.3), 0.5);
    assert_true(pls_solid_volume_in_box(&solid, pls_vec(-1, -1, -1), pls_vec(1, 1, 1)) == solid.volume);
    assert_true(pls_solid_volume_in_box(&solid, pls_vec(0.6, -1, -1), pls_vec(2, 1, 1)) == 0);
    // the corner of this box lies within the ball's bounding cube, but outside the ball
    pls_vec3 corner = pls_add(solid.position, pls_vec(0.45, 0.45, 0.45));
    assert_true(pls_solid_volume_in_box(&solid, corner, pls_vec(2, 2, 2)) == 0);
}

static void one_face_leaves_a_cap(void **state)
{
    (void)state;
    const double radius = 0.7;
    pls_solid solid = ball(pls_vec(0.3, -0.2, 0.9), radius);
    for (int k = 0; k <= 20; ++k)
    {
        double height = 2 * radius * k / 20; // pi h^2 (3 R - h) / 3
        double cap = pi * height * height * (3 * radius - height) / 3;
        expect_part(&solid, pls_vec(-9, -9, -9), pls_vec(9, 9, 0.9 - radius + height), cap);
        expect_part(&solid, pls_vec(0.3 + radius - height, -9, -9), pls_vec(9, 9, 9), cap);
    }
}

static void edges_and_corners_through_the_centre_leave_quarters_and_octants(void **state)
{
    (void)state;
    pls_solid solid = ball(pls_vec(1, 2, 3), 0.25);
    expect_part(&solid, pls_vec(1, 2, 0), pls_vec(9, 9, 9), solid.volume / 4);
    expect_part(&solid, pls_vec(1, 2, 3), pls_vec(9, 9, 9), solid.volume / 8);
    expect_part(&solid, pls_vec(-9, -9, -9), pls_vec(1, 2, 3), solid.volume / 8);
}

static void a_box_inside_the_ball_is_full(void **state)
{
    (void)state;
    pls_solid solid = ball(pls_vec(0, 0, 0), 1);
    expect_part(&solid, pls_vec(-0.5, -0.2, -0.1), pls_vec(0.4, 0.3, 0.6), 0.9 * 0.5 * 0.7);
    // a slab |z| < a holds 2 pi a (1 - a^2 / 3)
    expect_part(&solid, pls_vec(-9, -9, -0.3), pls_vec(9, 9, 0.3), 2 * pi * 0.3 * (1 - 0.03));
}

static void the_parts_of_a_divided_space_add_up(void **state)
{
    (void)state;
    pls_solid solid = ball(pls_vec(0.11, -0.07, 0.23), 0.6);
    double sum = 0;
    for (int k = 0; k < 8; ++k)
    {
        pls_vec3 lower = pls_vec(k & 1 ? 0 : -9, k & 2 ? 0 : -9, k & 4 ? 0 : -9);
        pls_vec3 upper = pls_vec(k & 1 ? 9 : 0, k & 2 ? 9 : 0, k & 4 ? 9 : 0);
        sum += pls_solid_volume_in_box(&solid, lower, upper);
    }
    assert_true(fabs(sum - solid.volume) <= promised * solid.volume);
}

static void a_disc_is_cut_as_an_area(void **state)
{
    (void)state;
    const double radius = 2;
    pls_solid solid = disc(pls_vec(5, 6, 0), radius);
    for (int k = 0; k <= 20; ++k)
    {
        double a = radius * (k / 10.0 - 1); // the segment beyond x = a: R^2 acos(a / R) - a sqrt(R^2 - a^2)
        double segment = radius * radius * acos(a / radius) - a * sqrt(radius * radius - a * a);
        expect_part(&solid, pls_vec(5 + a, -99, 0), pls_vec(99, 99, 0), segment);
    }
    expect_part(&solid, pls_vec(5, 6, 0), pls_vec(99, 99, 0), solid.volume / 4);
}

static void any_shape_is_cut_in_its_own_frame(void **state)
{
    (void)state;
    pls_solid solid = {.shape = &cuboid,
                       .dimension = 3,
                       .position = pls_vec(1, 1, 1),
                       .orientation = pls_quat_identity(),
                       .scale = 2,
                       .radius = 2 * sqrt(0.5 * 0.5 + 0.4 * 0.4 + 0.3 * 0.3),
                       .volume = 8 * 8 * 0.5 * 0.4 * 0.3};
    expect_part(&solid, pls_vec(1.3, -9, -9), pls_vec(9, 9, 9), 0.7 * 1.6 * 1.2);
    // a quarter turn about z: the long edge lies along y
    solid.orientation = (pls_quat){sqrt(0.5), 0, 0, sqrt(0.5)};
    expect_part(&solid, pls_vec(-9, 1.3, -9), pls_vec(9, 9, 9), 0.7 * 1.6 * 1.2);
    // any plane through the centre halves it
    solid.orientation = pls_quat_unit((pls_quat){0.9, 0.2, -0.3, 0.4});
    expect_part(&solid, pls_vec(-9, 1, -9), pls_vec(9, 9, 9), solid.volume / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_inside_counts_whole_and_one_outside_not_at_all),
        cmocka_unit_test(one_face_leaves_a_cap),
        cmocka_unit_test(edges_and_corners_through_the_centre_leave_quarters_and_octants),
        cmocka_unit_test(a_box_inside_the_ball_is_full),
        cmocka_unit_test(the_parts_of_a_divided_space_add_up),
        cmocka_unit_test(a_disc_is_cut_as_an_area),
        cmocka_unit_test(any_shape_is_cut_in_its_own_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
