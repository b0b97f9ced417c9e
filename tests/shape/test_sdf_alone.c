// A shape that gives nothing but its SDF: what is measured of it against closed forms, and which SDFs are refused.

#include <particls/shape.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const pls_parameter none[] = {{.name = NULL}};
static const pls_shape_input no_input = {.values = NULL};

static pls_shape_ops alone(double (*sdf)(const pls_shape *, pls_vec3))
{
    return (pls_shape_ops){.api_version = PLS_API_VERSION, .name = "mine", .parameters = none, .in_2d = true, .in_3d = true, .sdf = sdf};
}

static pls_shape *make(const pls_shape_ops *ops, int dimension)
{
    pls_shape *shape = NULL;
    if (pls_shape_make(ops, dimension, &no_input, "shape 'mine'", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

static void expect_near(double value, double known, double error) { assert_true(fabs(value - known) <= error * fabs(known)); }

// ---- good ones ----------------------------------------------------------------------------------------------------------------------------------------------

static double ball_off_centre(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return pls_length(pls_sub(X, pls_vec(0.3, -2.0, 0.0))) - 0.7;
}

static void a_ball_off_the_centre(void **state)
{
    (void)state;
    pls_shape_ops ops = alone(ball_off_centre);
    ops.convex = true;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape *shape = make(&ops, dimension);
        double volume = dimension == 2 ? M_PI * 0.49 : 4.0 / 3.0 * M_PI * 0.343, moment = (dimension == 2 ? 0.5 : 0.4) * volume * 0.49;
        expect_near(shape->mass.volume, volume, 1e-7);
        assert_true(pls_length(pls_sub(shape->mass.centre, pls_vec(0.3, -2.0, 0.0))) < 1e-7);
        expect_near(shape->moments.z, moment, 1e-6);
        if (dimension == 3) expect_near(shape->moments.x, moment, 1e-6);
        expect_near(shape->radius, 0.7, 1e-6);
        assert_true(fabs(shape->lower.x + 0.4) < 1e-7 && fabs(shape->upper.y + 1.3) < 1e-7);
        pls_vec3 n = pls_unit(pls_vec(1.0, 2.0, dimension == 3 ? -1.0 : 0.0)), p = pls_shape_support(shape, n);
        assert_true(pls_length(pls_sub(p, pls_add(shape->mass.centre, pls_scale(n, 0.7)))) < 1e-6);
        pls_shape_free(shape);
    }
}

/// A box with half edges 0.5, 0.3, 0.2, turned about z by 30 degrees: its principal axes are not the frame's.
static double turned_box(const pls_shape *shape, pls_vec3 X)
{
    const double c = sqrt(0.75), s = 0.5;
    pls_vec3 d = pls_vec(fabs(c * X.x + s * X.y) - 0.5, fabs(-s * X.x + c * X.y) - 0.3, shape->dimension == 2 ? -1.0 : fabs(X.z) - 0.2);
    double outside = pls_length(pls_vec(fmax(d.x, 0.0), fmax(d.y, 0.0), fmax(d.z, 0.0)));
    return outside + fmin(fmax(d.x, fmax(d.y, d.z)), 0.0);
}

static void a_box_that_is_turned(void **state)
{
    (void)state;
    pls_shape_ops ops = alone(turned_box);
    ops.convex = true;
    pls_shape *shape = make(&ops, 3);
    const double volume = 8.0 * 0.5 * 0.3 * 0.2;
    expect_near(shape->mass.volume, volume, 1e-6);
    assert_true(shape->mass.error < 1e-6 && pls_length(shape->mass.centre) < 1e-7);
    const double error = 2.0 * shape->mass.error * volume * (0.25 + 0.09 + 0.04); // it is told relative to the volume and the size
    assert_true(fabs(shape->moments.x - volume / 3.0 * (0.09 + 0.04)) < error);
    assert_true(fabs(shape->moments.y - volume / 3.0 * (0.25 + 0.04)) < error);
    assert_true(fabs(shape->moments.z - volume / 3.0 * (0.25 + 0.09)) < error);
    pls_vec3 along = pls_rotate(shape->principal, pls_vec(1.0, 0.0, 0.0)); // the long edge
    assert_true(pls_length(pls_sub(along, pls_vec(sqrt(0.75), 0.5, 0.0))) < 1e-5);
    expect_near(shape->radius, sqrt(0.25 + 0.09 + 0.04), 1e-6);
    pls_vec3 corner = pls_shape_support(shape, pls_unit(pls_vec(sqrt(0.75) * 1.0 - 0.5 * 0.8, 0.5 + sqrt(0.75) * 0.8, 0.9)));
    assert_true(pls_length(pls_sub(corner, pls_vec(sqrt(0.75) * 0.5 - 0.5 * 0.3, 0.5 * 0.5 + sqrt(0.75) * 0.3, 0.2))) < 1e-6);
    pls_shape_free(shape);
}

/// A ring of radius 1 about z, 0.25 thick: not convex, and its centre is outside of it.
static double torus(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    double q = hypot(X.x, X.y) - 1.0;
    return hypot(q, X.z) - 0.25;
}

static void a_torus(void **state)
{
    (void)state;
    const pls_shape_ops ops = alone(torus);
    pls_shape *shape = make(&ops, 3);
    const double volume = 2.0 * M_PI * M_PI * 0.0625;
    expect_near(shape->mass.volume, volume, 1e-6);
    expect_near(shape->moments.z, volume * (1.0 + 0.75 * 0.0625), 1e-6);
    expect_near(shape->moments.x, volume * (0.5 + 0.625 * 0.0625), 1e-6);
    expect_near(shape->radius, 1.25, 1e-6);
    // Its top is a ring, as near to the points of the axis above it all around.
    expect_near(shape->upper.x, 1.25, 1e-5);
    expect_near(shape->lower.y, -1.25, 1e-5);
    expect_near(shape->upper.z, 0.25, 1e-5);
    expect_near(shape->lower.z, -0.25, 1e-5);
    assert_true(shape->upper.z >= 0.25 && shape->lower.x <= -1.25);
    expect_near(pls_shape_support(shape, pls_vec(0.0, 0.0, 1.0)).z, 0.25, 1e-6);
    pls_shape_free(shape);
}

/// A disc of radius 0.5, and one of radius 0.1 that reaches further up by a little, but far from the axis.
static double disc_and_outlier(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return fmin(pls_length(X) - 0.5, pls_length(pls_sub(X, pls_vec(2.0, 0.41, 0.0))) - 0.1);
}

static void the_highest_place_counts(void **state)
{
    (void)state;
    const pls_shape_ops ops = alone(disc_and_outlier);
    pls_shape *shape = make(&ops, 2);
    expect_near(shape->upper.y, 0.51, 1e-5);
    assert_true(shape->upper.y >= 0.51);
    expect_near(shape->upper.x, 2.1, 1e-5);
    expect_near(shape->lower.x, -0.5, 1e-5);
    pls_shape_free(shape);
}

static double denser_upwards(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return 1.0 + (X.y + 2.0);
}

static void a_density_that_varies(void **state)
{
    (void)state;
    pls_shape_ops ops = alone(ball_off_centre);
    ops.density = denser_upwards;
    pls_shape *shape = make(&ops, 3);
    const double volume = 4.0 / 3.0 * M_PI * 0.343, second = 0.2 * volume * 0.49; // int y^2 about the ball's centre
    expect_near(shape->mass.volume, volume, 1e-6);
    expect_near(shape->mass.centre.y + 2.0, second / volume, 1e-5);
    pls_shape_free(shape);
}

// ---- lies ---------------------------------------------------------------------------------------------------------------------------------------------------

/// Refused for this reason, and with the point and the value that show it.
static void expect_refused(double (*sdf)(const pls_shape *, pls_vec3), bool convex, const char *because, const char *where)
{
    pls_shape_ops ops = alone(sdf);
    ops.convex = convex;
    pls_shape *shape = NULL;
    if (pls_shape_make(&ops, 3, &no_input, "shape 'mine'", &shape) != PLS_INVALID_ARGUMENT) fail_msg("accepted: %s", because);
    assert_null(shape);
    const char *message = pls_last_message();
    if (!strstr(message, because)) fail_msg("'%s' is not in: %s", because, message);
    if (!strstr(message, where)) fail_msg("'%s' is not in: %s", where, message);
    const char *name = strstr(message, "shape 'mine'");
    assert_non_null(name);
    if (strstr(name + 1, "shape 'mine'")) fail_msg("named twice: %s", message);
}

#define LIE(name, value)                                   \
    static double name(const pls_shape *shape, pls_vec3 X) \
    {                                                      \
        (void)shape;                                       \
        const double r = pls_length(X);                    \
        (void)r;                                           \
        return value;                                      \
    }

LIE(twice_too_steep, r < 1.0 ? 2.0 * (r - 1.0) : r - 1.0)
LIE(twice_too_steep_all_over, 2.0 * (r - 0.1))
LIE(squared, r *r - 1.0)
LIE(squared_small, r *r - 0.01)
LIE(stretched_ball, pls_length(pls_vec(X.x, X.y, 2.0 * X.z)) - 0.3)

static void slopes_above_one(void **state)
{
    (void)state;
    static const char *const because = "is steeper than a distance can be: from (";
    expect_refused(twice_too_steep, true, because, " times the way");
    expect_refused(twice_too_steep_all_over, true, because, " m, by 2 times the way");
    expect_refused(squared, true, because, " times the way");
    expect_refused(squared_small, true, because, " times the way");
    expect_refused(stretched_ball, true, because, " times the way");
}

LIE(half_the_distance, r < 3.0 ? 0.5 * (r - 1.0) : r - 2.0)
LIE(half_the_distance_all_over, 0.5 * (r - 0.1))
LIE(pseudo_ellipsoid, (pls_length(pls_vec(X.x / 0.1, X.y / 0.06, X.z / 0.03)) - 1.0) * 0.03)
LIE(nearly_a_ball, (pls_length(pls_vec(X.x / 0.1, X.y / 0.1, X.z / 0.098)) - 1.0) * 0.098)
LIE(constant, 0.3)

static void slopes_below_one(void **state)
{
    (void)state;
    static const char *const because = "is no true distance outside: at (", *const value = " m, it still says ";
    expect_refused(half_the_distance, true, because, value);
    expect_refused(half_the_distance_all_over, true, because, value);
    expect_refused(pseudo_ellipsoid, true, because, value);
    expect_refused(nearly_a_ball, true, because, value);
    expect_refused(constant, false, because, " m it says 0.3 m");
}

LIE(not_a_number, X.x > 0.5 && X.x < 0.6 ? NAN : r - 1.0)
LIE(not_a_number_at_the_origin, r - 0.1 + 0.0 / r)
LIE(infinite_at_the_origin, r > 0.0 ? r - 0.1 : INFINITY)
LIE(infinitely_deep, r > 0.0 ? r - 0.1 : -INFINITY)
LIE(a_logarithm, 0.1 * log(r / 0.1))

static void values_that_are_not_finite(void **state)
{
    (void)state;
    static const char *const because = "must be finite everywhere";
    expect_refused(not_a_number, true, because, "nan at (0.5");
    expect_refused(not_a_number_at_the_origin, true, because, "nan at (0, 0, 0) m");
    expect_refused(infinite_at_the_origin, true, because, "is inf at (0, 0, 0) m");
    expect_refused(infinitely_deep, true, because, "is -inf at (0, 0, 0) m");
    expect_refused(a_logarithm, true, because, "is -inf at (0, 0, 0) m");
}

LIE(ball_plus_a_length, r + 0.1)
LIE(nothing, r + 1.0)
LIE(shell_without_an_inside, fabs(r - 0.1))
LIE(wrong_sign, 0.1 - r)
LIE(wrong_sign_off_centre, 0.1 - pls_length(pls_sub(X, pls_vec(1.0, 2.0, 0.0))))
LIE(ring_plus_a_length, hypot(hypot(X.x, X.y) - 0.3, X.z) + 0.1)
LIE(inside_all_over, -0.2)

static void signs(void **state)
{
    (void)state;
    expect_refused(ball_plus_a_length, true, "is nowhere negative: the least value found is ", "is 0.1 m, at (0, 0, 0) m");
    expect_refused(nothing, false, "is nowhere negative: the least value found is ", "is 1 m, at (0, 0, 0) m");
    expect_refused(ring_plus_a_length, false, "is nowhere negative: the least value found is ", "is 0.1 m, at (");
    expect_refused(shell_without_an_inside, false, "is nowhere negative: the least value found is ", " m, at (");
    expect_refused(wrong_sign, true, "is negative in all directions far away, where it must be positive: ", " m at (");
    expect_refused(wrong_sign_off_centre, true, "is negative in all directions far away, where it must be positive: ", " m at (");
    expect_refused(inside_all_over, true, "is negative in all directions far away, where it must be positive: ", "-0.2 m at (");
}

LIE(slab, fabs(X.z) - 0.5)
LIE(rod_without_ends, hypot(X.x, X.y) - 0.1)

static void shapes_without_an_end(void **state)
{
    (void)state;
    expect_refused(slab, true, "has no end: at (", " m its SDF is -0.5 m");
    expect_refused(rod_without_ends, true, "has no end: at (", " m its SDF is -0.1 m");
}

LIE(step_inside, r - 0.1 + (X.x > 0.03 ? 0.02 : 0.0))
LIE(step_of_a_part, pls_length(pls_sub(X, pls_vec(0.04, 0.03, 0.0))) < 0.03 ? r - 0.12 : r - 0.1)
LIE(step_outside, r > 0.13 ? r - 0.1 : r > 0.12 ? r - 0.12 : r - 0.1)
LIE(small_step, r - 0.1 + (X.y + X.z > 0.013 ? 1e-4 : 0.0))

static void jumps(void **state)
{
    (void)state;
    static const char *const because = "jumps: from (", *const value = " m apart, it changes from ";
    expect_refused(step_inside, true, because, value);
    expect_refused(step_of_a_part, true, because, value);
    expect_refused(step_outside, false, because, value);
    expect_refused(small_step, false, because, value);
}

LIE(two_balls, fmin(pls_length(pls_sub(X, pls_vec(0.1, 0.0, 0.0))), pls_length(pls_add(X, pls_vec(0.1, 0.0, 0.0)))) - 0.1)
LIE(two_balls_that_overlap, fmin(pls_length(pls_sub(X, pls_vec(0.03, 0.0, 0.0))), pls_length(pls_add(X, pls_vec(0.03, 0.0, 0.0)))) - 0.1)
LIE(fat_ring, hypot(hypot(X.x, X.y) - 0.1, X.z) - 0.0999)

static void sets_that_are_not_convex(void **state)
{
    (void)state;
    static const char *const because = "is said to be convex, but its SDF is not: ", *const value = " m half way between (";
    expect_refused(two_balls, true, because, value);
    expect_refused(two_balls_that_overlap, true, because, value);
    expect_refused(fat_ring, true, because, value);
    expect_refused(torus, true, because, value);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_off_the_centre),
        cmocka_unit_test(a_box_that_is_turned),
        cmocka_unit_test(a_torus),
        cmocka_unit_test(the_highest_place_counts),
        cmocka_unit_test(a_density_that_varies),
        cmocka_unit_test(slopes_above_one),
        cmocka_unit_test(slopes_below_one),
        cmocka_unit_test(values_that_are_not_finite),
        cmocka_unit_test(signs),
        cmocka_unit_test(shapes_without_an_end),
        cmocka_unit_test(jumps),
        cmocka_unit_test(sets_that_are_not_convex),
    };
    return cmocka_run_group_tests_name("sdf alone", tests, NULL, NULL);
}
