// test_shapes.c -- shapes of plugins, given by their signed distance alone, are accepted and measured: against the formulas of a solid ring, which is not convex,
// and of the template's capsule and stadium.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"
#include "scene/scene_data.h"
#include "scene/scene_file.h"

#include <stdio.h>

static pls_scene *ring(double R, double r)
{
    char text[1024];
    snprintf(text, sizeof text,
             "particls: 1\nplugins: [\"%s/torus.so\"]\nmaterials: {grain: {density: 1000}}\n"
             "shapes: {ring: {torus: {ring_radius: %.17g, tube_radius: %.17g}}}\n"
             "bodies:\n  - {name: a, shape: ring, material: grain, position: [0, 0, 0]}\ntime: {end: 1, dt: 1.0e-3}\n",
             PLS_PLUGIN_DIR, R, r);
    return must_load(text);
}

static void expect_near(double value, double known, double error)
{
    if (!(fabs(value - known) <= error * fabs(known))) fail_msg("%.12g, not %.12g: relative error %g", value, known, value / known - 1.0);
}

static void a_ring_is_measured(void **state)
{
    (void)state;
    static const double sizes[][2] = {{0.3, 0.1}, {0.05, 0.045}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k)
    {
        const double R = sizes[k][0], r = sizes[k][1], volume = 2.0 * M_PI * M_PI * R * r * r;
        pls_scene *scene = ring(R, r);
        const pls_shape *shape = scene->shapes[0].made;
        assert_false(shape->convex);
        expect_near(shape->mass.volume, volume, 1e-6);
        expect_near(shape->moments.z, volume * (R * R + 0.75 * r * r), 1e-6);
        expect_near(shape->moments.x, volume * (0.5 * R * R + 0.625 * r * r), 1e-6);
        expect_near(shape->moments.y, shape->moments.x, 1e-6);
        assert_true(pls_length(shape->mass.centre) < 1e-6 * R);
        expect_near(shape->radius, R + r, 1e-6);
        assert_true(pls_length(pls_sub(shape->upper, pls_vec(R + r, R + r, r))) < 2e-5 * R && shape->upper.x >= R + r &&
                    shape->upper.z >= r);
        assert_true(pls_length(pls_sub(shape->lower, pls_vec(-R - r, -R - r, -r))) < 2e-5 * R && shape->lower.x <= -R - r &&
                    shape->lower.z <= -r);
        pls_scene_free(scene);
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

static void points_outside_have_their_foot_on_the_ring(void **state)
{
    (void)state;
    const double R = 0.3, r = 0.1;
    pls_scene *scene = ring(R, r);
    const pls_shape *shape = scene->shapes[0].made;
    pls_random random = pls_random_stream(7, 0, PLS_FOR_USER);
    for (int k = 0; k < 1000; ++k)
    {
        pls_vec3 X = pls_vec(pls_random_uniform(&random) - 0.5, pls_random_uniform(&random) - 0.5, pls_random_uniform(&random) - 0.5);
        // The nearest point of the tube's middle, and from there r towards X.
        pls_vec3 middle = pls_scale(pls_unit(pls_vec(X.x, X.y, 0.0)), R),
                 foot = pls_add(middle, pls_scale(pls_unit(pls_sub(X, middle)), r));
        double distance = pls_length(pls_sub(X, middle)) - r;
        assert_true(fabs(pls_shape_sdf(shape, X) - distance) < 1e-14);
        if (distance > 0.0) assert_true(pls_length(pls_sub(pls_shape_nearest(shape, X), foot)) < 1e-8);
    }
    pls_scene_free(scene);
}

static void the_shape_of_the_template_is_a_capsule_and_in_the_plane_a_stadium(void **state)
{
    (void)state;
    const double L = 0.2, r = 0.05, cylinder = M_PI * r * r * L, ball = 4.0 / 3.0 * M_PI * r * r * r;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        char text[1024];
        snprintf(text, sizeof text,
                 "particls: 1\ndimension: %d\nplugins: [\"%s/template.so\"]\nmaterials: {grain: {density: 1000}}\n"
                 "shapes: {bean: {my_shape: {length: 0.2, radius: 0.05}}}\n"
                 "bodies:\n  - {name: a, shape: bean, material: grain, position: [0, 0%s]}\ntime: {end: 1, dt: 1.0e-3}\n",
                 dimension, PLS_PLUGIN_DIR, dimension == 3 ? ", 0" : "");
        pls_scene *scene = must_load(text);
        const pls_shape *shape = scene->shapes[0].made;
        assert_true(shape->convex);
        expect_near(shape->radius, 0.5 * L + r, 1e-6);
        expect_near(shape->mass.volume, dimension == 3 ? cylinder + ball : 2.0 * r * L + M_PI * r * r, 1e-6);
        // About the long axis: m r^2 / 2 of the cylinder and 2/5 m r^2 of the ball.
        if (dimension == 3) expect_near(shape->moments.x, 0.5 * cylinder * r * r + 0.4 * ball * r * r, 1e-6);
        pls_scene_free(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ring_is_measured),
        cmocka_unit_test(the_shape_of_the_template_is_a_capsule_and_in_the_plane_a_stadium),
        cmocka_unit_test(points_outside_have_their_foot_on_the_ring),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
