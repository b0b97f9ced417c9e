// test_density.c -- shapes whose density varies in space, by a field from outside: mass, centre, inertia, principal frame and bounding sphere against closed forms.

#include "shape/builtin.h"
#include "support/numbers.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const double bar =
    2e-6; ///< of the quadrature, whose error is told as 5e-7 or less: of the volume, the radius of gyration, the trace

/// The field 1 + g.X.
static double linear(void *context, pls_vec3 X) { return 1.0 + pls_dot(*(const pls_vec3 *)context, X); }

static pls_status make(const pls_shape_ops *ops, int dimension, pls_shape_input input, pls_vec3 gradient, pls_shape **shape)
{
    const pls_density_field density = {linear, &gradient};
    input.density = &density;
    return pls_shape_make(ops, dimension, &input, "shape 'x'", shape);
}

static pls_shape *must_make(const pls_shape_ops *ops, int dimension, pls_shape_input input, pls_vec3 gradient)
{
    pls_shape *shape;
    if (make(ops, dimension, input, gradient, &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

/// `second`: of mass about the origin, xx, yy, zz, xy, xz, yz.
static void expect_mass(const pls_shape *shape, double mass, pls_vec3 centre, const double second[6])
{
    const pls_mass_properties *m = &shape->mass;
    const double *c = (const double[3]){centre.x, centre.y, centre.z};
    double about[6]; // the centre
    for (int k = 0; k < 3; ++k) about[k] = second[k] - mass * c[k] * c[k];
    about[3] = second[3] - mass * c[0] * c[1], about[4] = second[4] - mass * c[0] * c[2], about[5] = second[5] - mass * c[1] * c[2];
    const double trace = about[0] + about[1] + about[2], size = sqrt(trace / mass);
    const double known[6] = {about[1] + about[2], about[0] + about[2], about[0] + about[1], -about[3], -about[4], -about[5]};
    double worst = fmax(fabs(m->volume / mass - 1.0), pls_length(pls_sub(m->centre, centre)) / size);
    for (int k = shape->dimension == 2 ? 2 : 0; k < (shape->dimension == 2 ? 3 : 6); ++k)
        worst = fmax(worst, fabs(m->inertia[k] - known[k]) / trace);
    if (!(worst <= bar)) fail_msg("%s in %dD: error %.3g", shape->ops->name, shape->dimension, worst);
    assert_true(shape->uneven && m->error < bar);
}

static void balls_that_are_heavier_on_one_side(void **state)
{
    (void)state;
    const double R = 0.1, a = 5.0, V = 4.0 / 3.0 * M_PI * R * R * R, I = 0.2 * V * R * R, A = M_PI * R * R, J = 0.25 * A * R * R;
    const pls_shape_input input = {NUMBERS(R), .points = NULL};
    pls_shape *ball = must_make(&pls_sphere_shape, 3, input, pls_vec(0.0, 0.0, a)),
              *disc = must_make(&pls_disc_shape, 2, input, pls_vec(0.0, a, 0.0));
    // Its first moment is a int z^2; what is odd in z adds nothing to the second.
    expect_mass(ball, V, pls_vec(0.0, 0.0, a * R * R / 5.0), (const double[6]){I, I, I});
    expect_mass(disc, A, pls_vec(0.0, a * R * R / 4.0, 0.0), (const double[6]){J, J});
    // It fills what it did, and reaches further from its centre of mass.
    assert_true(fabs(ball->volume / V - 1.0) < 1e-14 && fabs(disc->volume / A - 1.0) < 1e-14);
    assert_true(fabs(ball->radius - (R + a * R * R / 5.0)) < 1e-6 * R && fabs(disc->radius - (R + a * R * R / 4.0)) < 1e-6 * R);
    assert_false(pls_shape_is_ball(ball) || pls_shape_is_ball(disc));
    pls_shape_free(ball);
    pls_shape_free(disc);
}

static void a_box_turns_its_principal_axes(void **state)
{
    (void)state;
    const double h[3] = {0.3, 0.2, 0.1}, V = 8.0 * h[0] * h[1] * h[2], a = 2.0, b = 1.5;
    const pls_shape_input input = {NUMBERS(h[0], h[1], h[2], 0.0), .points = NULL};
    pls_shape *box = must_make(&pls_box_shape, 3, input, pls_vec(a, b, 0.0));
    const double xx = V * h[0] * h[0] / 3.0, yy = V * h[1] * h[1] / 3.0, zz = V * h[2] * h[2] / 3.0;
    const pls_vec3 c = pls_vec(a * h[0] * h[0] / 3.0, b * h[1] * h[1] / 3.0, 0.0);
    expect_mass(box, V, c, (const double[6]){xx, yy, zz});
    // In the x-y plane the axes turn by half of atan(2 Sxy / (Sxx - Syy)), S being about the centre.
    const double Sxx = xx - V * c.x * c.x, Syy = yy - V * c.y * c.y, Sxy = -V * c.x * c.y, angle = 0.5 * atan2(2.0 * Sxy, Sxx - Syy);
    const pls_vec3 along = pls_rotate(box->principal, pls_vec(1.0, 0.0, 0.0));
    assert_true(fabs(fabs(along.x * cos(angle) + along.y * sin(angle)) - 1.0) < 1e-9);
    pls_shape_free(box);
}

static void a_tetrahedron(void **state)
{
    (void)state;
    static const pls_vec3 corner[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const pls_shape_input input = {NUMBERS(0.0, 0.0), .points = corner, .point_count = 4};
    pls_shape *shape = must_make(&pls_polyhedron_shape, 3, input, pls_vec(1.0, 0.0, 0.0));
    // int x^i y^j z^k = i! j! k! / (i + j + k + 3)!
    const double mass = 1.0 / 6.0 + 1.0 / 24.0, x = 1.0 / 24.0 + 2.0 / 120.0, y = 1.0 / 24.0 + 1.0 / 120.0;
    const double xx = 2.0 / 120.0 + 6.0 / 720.0, yy = 2.0 / 120.0 + 2.0 / 720.0, xy = 1.0 / 120.0 + 2.0 / 720.0,
                 yz = 1.0 / 120.0 + 1.0 / 720.0;
    expect_mass(shape, mass, pls_vec(x / mass, y / mass, y / mass), (const double[6]){xx, yy, yy, xy, xy, yz});
    pls_shape_free(shape);
}

static void a_compound_has_a_field_over_all_its_parts(void **state)
{
    (void)state;
    const double R = 0.1, d = 0.12, a = 3.0, V = 4.0 / 3.0 * M_PI * R * R * R;
    const pls_shape_input round = {NUMBERS(R), .points = NULL};
    pls_shape *ball;
    assert_int_equal(pls_shape_make(&pls_sphere_shape, 3, &round, "shape 'x'", &ball), PLS_OK);
    const pls_shape_part parts[2] = {{ball, pls_vec(d, 0.0, 0.0), pls_quat_identity(), 1.0},
                                     {ball, pls_vec(-d, 0.0, 0.0), pls_quat_identity(), 1.0}};
    const pls_shape_input input = {.parts = parts, .part_count = 2};
    pls_shape *pair = must_make(&pls_compound_shape, 3, input, pls_vec(a, 0.0, 0.0));
    const double xx = 2.0 * V * (d * d + R * R / 5.0), yy = 2.0 * V * R * R / 5.0;
    expect_mass(pair, 2.0 * V, pls_vec(a * xx / (2.0 * V), 0.0, 0.0), (const double[6]){xx, yy, yy});
    assert_true(fabs(pair->volume / (2.0 * V) - 1.0) < 1e-14);
    pls_shape_free(pair);
    // As a part it is refused: only one field is asked.
    pls_shape *uneven = must_make(&pls_sphere_shape, 3, round, pls_vec(a, 0.0, 0.0)), *whole;
    const pls_shape_part part = {uneven, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0};
    assert_int_equal(pls_shape_make(&pls_compound_shape, 3, &(pls_shape_input){.parts = &part, .part_count = 1}, "shape 'y'", &whole),
                     PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "shape 'y': part 1 of a compound has a density of its own"));
    pls_shape_free(uneven);
    pls_shape_free(ball);
    assert_int_equal(pls_memory_in_use(), 0);
}

static double undefined_beyond(void *context, pls_vec3 X)
{
    (void)context;
    return sqrt(0.05 - X.x);
}

/// Wherever the density is none: deep inside, or at one end only.
static void densities_that_are_none_are_refused(void **state)
{
    (void)state;
    const pls_shape_input ball = {NUMBERS(0.1), .points = NULL}, box = {NUMBERS(0.1, 0.1, 0.1, 0.0), .points = NULL};
    pls_shape *shape;
    assert_int_equal(make(&pls_sphere_shape, 3, ball, pls_vec(0.0, 0.0, -10.001), &shape), PLS_INVALID_ARGUMENT); // below 0 at the top
    assert_non_null(strstr(pls_last_message(), "shape 'x': the density is -0.0001 times the material's at (0, 0, 0.1) m"));
    assert_int_equal(make(&pls_box_shape, 3, box, pls_vec(3.4, 3.4, 3.4), &shape), PLS_INVALID_ARGUMENT); // at a corner
    assert_non_null(strstr(pls_last_message(), "shape 'x': the density is -0.02 times the material's at (-0.1, -0.1, -0.1) m"));
    const pls_density_field field = {undefined_beyond, NULL};
    const pls_shape_input undefined = {NUMBERS(0.1), .density = &field};
    assert_int_equal(pls_shape_make(&pls_disc_shape, 2, &undefined, "shape 'x'", &shape), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "nan times the material's at ("));
    assert_int_equal(make(&pls_plane_shape, 3, (pls_shape_input){0}, pls_vec(0.0, 0.0, 1.0), &shape), PLS_INVALID_ARGUMENT);
    assert_string_equal(pls_last_message(), "shape 'x': a plane has no mass, and so no density");
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_that_are_heavier_on_one_side),
        cmocka_unit_test(a_box_turns_its_principal_axes),
        cmocka_unit_test(a_tetrahedron),
        cmocka_unit_test(a_compound_has_a_field_over_all_its_parts),
        cmocka_unit_test(densities_that_are_none_are_refused),
    };
    return cmocka_run_group_tests_name("density", tests, NULL, NULL);
}
