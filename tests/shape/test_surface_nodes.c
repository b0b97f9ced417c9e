// Surface nodes: on the surface, all over it, evenly.

#include "shape/builtin.h"

#include "base/random.h"
#include "support/numbers.h"
#include "support/values_alone.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 600 };

static pls_shape *make(const pls_shape_ops *ops, int dimension, const double *values, size_t count)
{
    pls_shape *shape = NULL;
    const pls_shape_input input = {.values = values, .value_count = count};
    if (pls_shape_make(ops, dimension, &input, "x", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

/// A point of the surface by its own formula, evenly over its area (arc).
typedef pls_vec3 (*drawing)(pls_random *random);

static pls_vec3 on_sphere(pls_random *random)
{
    double z = 2.0 * pls_random_uniform(random) - 1.0, a = 2.0 * M_PI * pls_random_uniform(random), s = sqrt(1.0 - z * z);
    return pls_vec(s * cos(a), s * sin(a), z);
}

static pls_vec3 on_torus(pls_random *random)
{
    for (;;) // the area around the tube goes with the distance from the axis
    {
        double a = 2.0 * M_PI * pls_random_uniform(random), b = 2.0 * M_PI * pls_random_uniform(random), r = 1.0 + 0.25 * cos(b);
        if (1.25 * pls_random_uniform(random) < r) return pls_vec(r * cos(a), r * sin(a), 0.25 * sin(b));
    }
}

static pls_vec3 on_square(pls_random *random)
{
    double along = 2.0 * pls_random_uniform(random) - 1.0, side = pls_random_uniform(random) < 0.5 ? -1.0 : 1.0;
    return pls_random_uniform(random) < 0.5 ? pls_vec(along, side, 0.0) : pls_vec(side, along, 0.0);
}

static void check(const pls_shape *shape, double area, drawing draw)
{
    static pls_vec3 node[MOST], again[MOST];
    for (size_t count = 100; count <= MOST; count *= 6)
    {
        // Cells of a regular pattern would be so wide: squares, in 2D arcs.
        const double usual = shape->dimension == 2 ? area / (double)count : sqrt(area / (double)count);
        assert_int_equal(pls_shape_surface_nodes(shape, count, node), PLS_OK);
        assert_int_equal(pls_shape_surface_nodes(shape, count, again), PLS_OK);
        assert_memory_equal(node, again, count * sizeof *node);
        double closest = INFINITY, widest = 0.0;
        for (size_t k = 0; k < count; ++k)
        {
            assert_true(fabs(pls_shape_sdf(shape, node[k])) < 1e-12);
            for (size_t j = 0; j < k; ++j) closest = fmin(closest, pls_length(pls_sub(node[j], node[k])));
        }
        pls_random random = pls_random_stream(4, 0, PLS_FOR_USER);
        for (int k = 0; k < 2000; ++k)
        {
            pls_vec3 X = draw(&random);
            double nearest = INFINITY;
            for (size_t j = 0; j < count; ++j) nearest = fmin(nearest, pls_length(pls_sub(X, node[j])));
            widest = fmax(widest, nearest);
        }
        // A random choice has nodes closer than 0.05 and gaps wider than 1.4 of the usual distance.
        if (closest < 0.55 * usual || widest > 1.05 * usual)
            fail_msg("%s, %zu nodes: closest %g, widest gap %g of the usual distance", shape->ops->name, count, closest / usual,
                     widest / usual);
    }
}

static void nodes_are_spread_evenly(void **state)
{
    (void)state;
    const double ball[1] = {1.0}, square[4] = {1.0, 1.0, 1.0, 0.0};
    pls_shape *shape = make(&pls_sphere_shape, 3, COUNTED(ball));
    check(shape, 4.0 * M_PI, on_sphere);
    pls_shape_free(shape);
    shape = make(&values_ring, 3, NUMBERS(1.0, 0.25));
    check(shape, 4.0 * M_PI * M_PI * 0.25, on_torus);
    pls_shape_free(shape);
    shape = make(&pls_box_shape, 2, COUNTED(square));
    check(shape, 8.0, on_square);
    pls_shape_free(shape);
}

static void what_has_no_end_has_no_nodes(void **state)
{
    (void)state;
    const double values[1] = {0.0};
    pls_vec3 node[1];
    pls_shape *plane = make(&pls_plane_shape, 3, COUNTED(values));
    assert_int_equal(pls_shape_surface_nodes(plane, 1, node), PLS_INVALID_ARGUMENT);
    pls_shape_free(plane);
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(nodes_are_spread_evenly), cmocka_unit_test(what_has_no_end_has_no_nodes)};
    return cmocka_run_group_tests_name("surface nodes", tests, NULL, NULL);
}
