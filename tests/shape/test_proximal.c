// Proximal maps of the built-in shapes: closed forms against the one from the SDF alone, and both against the condition of the minimum.

#include "base/random.h"
#include "shape/builtin.h"
#include "shape/proximal.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

enum { POINTS = 1500, HULL_POINTS = 24 };

typedef struct example
{
    const char *name;
    const pls_shape_ops *ops;
    int dimension;
    double values[6];
    int hull_points;
    bool curved; ///< phi is so on both sides of its ridge: planes cannot meet it
} example;

static const example examples[] = {
    {"sphere", &pls_sphere_shape, 3, {0.7}, 0, false},
    {"disc", &pls_sphere_shape, 2, {0.7}, 0, false},
    {"plane", &pls_plane_shape, 3, {0.0}, 0, false},
    {"line", &pls_plane_shape, 2, {0.0}, 0, false},
    {"box", &pls_box_shape, 3, {0.5, 0.7, 1.1, 0.0}, 0, false},
    {"rounded box", &pls_box_shape, 3, {0.5, 0.7, 1.1, 0.2}, 0, false},
    {"rectangle", &pls_box_shape, 2, {0.5, 0.7, 1.0, 0.1}, 0, false},
    {"capsule", &pls_capsule_shape, 3, {0.4, 1.3}, 0, false},
    {"stadium", &pls_capsule_shape, 2, {0.4, 1.3}, 0, false},
    {"cylinder", &pls_cylinder_shape, 3, {0.6, 1.5, 0.0}, 0, false},
    {"rounded cylinder", &pls_cylinder_shape, 3, {0.9, 0.8, 0.25}, 0, false},
    {"ellipsoid", &pls_ellipsoid_shape, 3, {0.5, 0.8, 1.3}, 0, true},
    {"rounded ellipsoid", &pls_ellipsoid_shape, 3, {0.5, 0.8, 1.3, 0.2}, 0, true},
    {"oblate", &pls_ellipsoid_shape, 3, {1.0, 1.0, 0.3}, 0, true},
    {"prolate", &pls_ellipsoid_shape, 3, {0.4, 0.4, 1.0}, 0, true},
    {"ellipse", &pls_ellipsoid_shape, 2, {0.5, 1.7, 1.0}, 0, true},
    {"polyhedron", &pls_polyhedron_shape, 3, {0.0}, HULL_POINTS, false},
    {"rounded polyhedron", &pls_polyhedron_shape, 3, {0.2}, 8, false},
    {"polygon", &pls_polygon_shape, 2, {0.0}, 7, false},
};
enum { EXAMPLES = sizeof examples / sizeof *examples };

static pls_shape *make(const example *e)
{
    pls_vec3 points[HULL_POINTS];
    pls_random random = pls_random_stream(5, 0, PLS_FOR_USER);
    for (int k = 0; k < e->hull_points; ++k)
    {
        double x = pls_random_normal(&random), y = pls_random_normal(&random), z = e->dimension == 2 ? 0.0 : pls_random_normal(&random);
        points[k] = pls_unit(pls_vec(x, y, z));
    }
    pls_shape *shape = NULL;
    const pls_shape_input input = {VALUES(e->values), .points = points, .point_count = (size_t)e->hull_points};
    if (pls_shape_make(e->ops, e->dimension, &input, e->name, &shape) != PLS_OK) fail_msg("%s: %s", e->name, pls_last_message());
    return shape;
}

static pls_vec3 random_point(int dimension, double size, pls_random *random)
{
    double u[3];
    for (int a = 0; a < 3; ++a) u[a] = 2.0 * size * (pls_random_uniform(random) - 0.5);
    return pls_vec(u[0], u[1], dimension == 2 ? 0.0 : u[2]);
}

static void closed_forms_against_the_sdf_alone(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        pls_shape *shape = make(&examples[e]);
        pls_random random = pls_random_stream(11, (uint32_t)e, PLS_FOR_USER);
        const double size = isfinite(shape->radius) ? shape->radius : 1.0;
        double worst = 0.0;
        assert_non_null(shape->ops->proximal);
        for (int k = 0; k < POINTS; ++k)
        {
            double step = size * (k % 3 == 0 ? 0.1 : 0.01 + pls_random_uniform(&random));
            pls_vec3 X = random_point(shape->dimension, 1.5 * size, &random);
            pls_vec3 Y = shape->ops->proximal(shape, X, step), Z = pls_proximal_from_sdf(shape, X, step);
            worst = fmax(worst, pls_length(pls_sub(Y, Z)) / size);
        }
        // The worst of curved ones is the prolate's ridge, a line at which surfaces meet from all around.
        if (worst > (examples[e].curved ? 1e-5 : 1e-12)) fail_msg("%s: %.3g apart", examples[e].name, worst);
        pls_shape_free(shape);
    }
}

/// Optimality, from values of the SDF at other points only: for all Z, phi(Z) >= phi(Y) + (X - Y).(Z - Y) / step.
static void proximal_from_sdf_is_least(void **state)
{
    (void)state;
    static const example more[] = {
        {"superquadric", &pls_superquadric_shape, 3, {0.6, 0.8, 1.0, 0.5, 0.7}, 0, false},
        {"superquadric", &pls_superquadric_shape, 3, {0.8, 0.7, 0.6, 1.4, 0.6}, 0, false},
        {"superellipse", &pls_superquadric_shape, 2, {0.6, 1.0, 1.0, 1.0, 0.4}, 0, false},
    };
    for (int e = 0; e < EXAMPLES + 3; ++e)
    {
        const example *which = e < EXAMPLES ? &examples[e] : &more[e - EXAMPLES];
        pls_shape *shape = make(which);
        pls_random random = pls_random_stream(12, (uint32_t)e, PLS_FOR_USER);
        const double size = isfinite(shape->radius) ? shape->radius : 1.0;
        for (int k = 0; k < POINTS / 10; ++k)
        {
            double step = size * (0.01 + 0.3 * pls_random_uniform(&random));
            pls_vec3 X = random_point(shape->dimension, 1.5 * size, &random);
            // Deep inside of a superquadric its SDF may miss the nearest of several places: from outside then, and not as far.
            if (e >= EXAMPLES) step *= 0.3;
            if (e >= EXAMPLES && pls_shape_sdf(shape, X) < 0.0) continue;
            pls_vec3 Y = pls_proximal_from_sdf(shape, X, step);
            double phi = pls_shape_sdf(shape, Y);
            for (int j = 0; j < 60; ++j)
            {
                pls_vec3 d = random_point(shape->dimension, size * pow(10.0, -(j % 6)), &random);
                double lack = phi + pls_dot(pls_sub(X, Y), d) / step - pls_shape_sdf(shape, pls_add(Y, d));
                if (lack > 1e-7 * pls_length(d) + 1e-13 * size) fail_msg("%s: not least by %.3g at %.3g", which->name, lack, pls_length(d));
            }
        }
        pls_shape_free(shape);
    }
}

/// A gradient by differences is off by about the difference at ridges.
static void a_shape_without_gradient(void **state)
{
    (void)state;
    pls_shape_ops bare = pls_box_shape;
    bare.gradient = NULL;
    bare.proximal = NULL;
    const example e = {"bare box", &bare, 3, {0.5, 0.7, 1.1, 0.0}, 0, false};
    pls_shape *shape = make(&e);
    pls_random random = pls_random_stream(13, 0, PLS_FOR_USER);
    for (int k = 0; k < POINTS; ++k)
    {
        double step = 0.01 + pls_random_uniform(&random);
        pls_vec3 X = random_point(3, 2.0, &random), Y = pls_shape_proximal(shape, X, step);
        assert_true(pls_length(pls_sub(Y, pls_box_shape.proximal(shape, X, step))) < 1e-5);
    }
    pls_shape_free(shape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_forms_against_the_sdf_alone),
        cmocka_unit_test(proximal_from_sdf_is_least),
        cmocka_unit_test(a_shape_without_gradient),
    };
    return cmocka_run_group_tests_name("proximal", tests, NULL, NULL);
}
