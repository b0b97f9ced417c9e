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

static void expect_refused(double (*sdf)(const pls_shape *, pls_vec3), bool convex, const char *because)
{
    pls_shape_ops ops = alone(sdf);
    ops.convex = convex;
    pls_shape *shape = NULL;
    assert_int_equal(pls_shape_make(&ops, 3, &no_input, "shape 'mine'", &shape), PLS_INVALID_ARGUMENT);
    assert_null(shape);
    if (!strstr(pls_last_message(), because)) fail_msg("'%s' is not in: %s", because, pls_last_message());
}

static double twice_too_steep(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return pls_length(X) < 1.0 ? 2.0 * (pls_length(X) - 1.0) : pls_length(X) - 1.0;
}

static double squared(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return pls_dot(X, X) - 1.0;
}

static double half_the_distance(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return pls_length(X) < 3.0 ? 0.5 * (pls_length(X) - 1.0) : pls_length(X) - 2.0;
}

static double not_a_number(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return X.x > 0.5 && X.x < 0.6 ? NAN : pls_length(X) - 1.0;
}

static double nothing(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return pls_length(X) + 1.0;
}

static double slab(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return fabs(X.z) - 0.5;
}

static void sdfs_that_lie(void **state)
{
    (void)state;
    expect_refused(twice_too_steep, true, "steeper than a distance can be");
    expect_refused(squared, true, "mine");
    expect_refused(half_the_distance, true, "no true distance outside");
    expect_refused(not_a_number, true, "must be finite everywhere");
    expect_refused(nothing, false, "mine");
    expect_refused(slab, true, "has no end");
    expect_refused(torus, true, "at its centre of mass, (");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ball_off_the_centre),    cmocka_unit_test(a_box_that_is_turned),  cmocka_unit_test(a_torus),
        cmocka_unit_test(the_highest_place_counts), cmocka_unit_test(a_density_that_varies), cmocka_unit_test(sdfs_that_lie),
    };
    return cmocka_run_group_tests_name("sdf alone", tests, NULL, NULL);
}
