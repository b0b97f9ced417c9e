// Fields of distances: as near to the distance as splines of their spacing are, smooth, no steeper than they say, a lower bound further out.

#include "shape/distance_field.h"
#include "shape/builtin.h"
#include "support/numbers.h"
#include "support/solids.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static pls_shape *superquadric(int dimension, double e1, double e2)
{
    const double values[] = {0.5, 0.4, 0.25, e1, e2, 0.0};
    return solids_make(&pls_superquadric_shape, dimension, &(pls_shape_input){VALUES(values)});
}

static pls_distance_field *field_of(const pls_shape *shape)
{
    pls_distance_field *field;
    assert_int_equal(pls_distance_field_make(shape, &field), PLS_OK);
    return field;
}

static double third(const pls_shape *shape, double z) { return shape->dimension == 2 ? 0.0 : z; }

/// Values between nodes are means of the distance over what lies within 1.5 spacings: off by its curvature, and at ridges of the distance, deep inside, by a spacing at most.
static void fields_are_near_to_the_distance(void **state)
{
    (void)state;
    const double exponents[3][2] = {{0.2, 0.2}, {0.3, 1.0}, {1.0, 0.4}}, spacing = 0.5 / 24;
    solids_seed(7);
    for (int dimension = 2; dimension <= 3; ++dimension)
        for (int e = 0; e < 3; ++e)
        {
            pls_shape *shape = superquadric(dimension, exponents[e][0], exponents[e][1]);
            pls_distance_field *field = field_of(shape);
            double worst_near = 0.0, mean = 0.0;
            int near = 0;
            for (int k = 0; k < 2000; ++k)
            {
                const pls_vec3 X =
                    pls_vec(solids_uniform(-0.57, 0.57), solids_uniform(-0.47, 0.47), third(shape, solids_uniform(-0.32, 0.32)));
                const double exact = pls_shape_sdf(shape, X), d = pls_distance_field_at(field, X, NULL);
                assert_true(fabs(d - exact) < spacing);
                if (exact < -0.02 || exact > 0.06) continue;
                worst_near = fmax(worst_near, fabs(d - exact)), mean += fabs(d - exact), ++near;
            }
            print_message("%dD, %g %g: error near the surface %.2g at worst, %.2g in the mean\n", dimension, exponents[e][0],
                          exponents[e][1], worst_near, mean / near);
            assert_true(near > 200 && worst_near < 0.25 * spacing && mean / near < 0.03 * spacing);
            pls_distance_field_free(field), pls_shape_free(shape);
        }
    assert_int_equal(pls_memory_in_use(), 0);
}

/// Above the middle of a flat end the distance is linear, and so is the field.
static void over_flat_places_they_are_the_distance(void **state)
{
    (void)state;
    for (double half = 0.25; half > 0.12; half *= 0.5) // as 2 and 4 to 1
    {
        const double values[] = {0.5, 0.4, half, 0.2, 0.2, 0.0};
        pls_shape *shape = solids_make(&pls_superquadric_shape, 3, &(pls_shape_input){VALUES(values)});
        pls_distance_field *field = field_of(shape);
        for (double x = -0.1; x < 0.11; x += 0.05)
            for (double d = -0.01; d < 0.05; d += 0.01)
            {
                pls_vec3 g;
                assert_true(fabs(pls_distance_field_at(field, pls_vec(x, 0.08, half + d), &g) - d) < 2e-7);
                assert_true(pls_length(pls_sub(g, pls_vec(0, 0, 1))) < 1e-4);
            }
        pls_distance_field_free(field), pls_shape_free(shape);
    }
}

static void gradients_are_those_of_the_values(void **state)
{
    (void)state;
    solids_seed(8);
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape *shape = superquadric(dimension, 0.2, 0.3);
        pls_distance_field *field = field_of(shape);
        double steepest = 0.0;
        for (int k = 0; k < 3000; ++k)
        {
            const pls_vec3 X = pls_vec(solids_uniform(-0.57, 0.57), solids_uniform(-0.47, 0.47), third(shape, solids_uniform(-0.32, 0.32)));
            const double h = 1e-6;
            pls_vec3 g;
            pls_distance_field_at(field, X, &g);
            steepest = fmax(steepest, pls_length(g));
            for (int a = 0; a < dimension; ++a)
            {
                const pls_vec3 e = pls_scale(pls_vec(a == 0, a == 1, a == 2), h);
                const double slope =
                    (pls_distance_field_at(field, pls_add(X, e), NULL) - pls_distance_field_at(field, pls_sub(X, e), NULL)) / (2 * h);
                assert_true(fabs(slope - (a == 0 ? g.x : a == 1 ? g.y : g.z)) < 2e-4); // second derivatives jump
            }
            const pls_vec3 mirrored = pls_vec(-X.x, X.y, -X.z);
            assert_true(pls_distance_field_at(field, mirrored, NULL) == pls_distance_field_at(field, X, NULL));
        }
        print_message("%dD: steepest %.4f\n", dimension, steepest);
        assert_true(steepest < PLS_FIELD_SLOPE);
        pls_distance_field_free(field), pls_shape_free(shape);
    }
}

static void further_out_they_are_lower_bounds(void **state)
{
    (void)state;
    pls_shape *shape = superquadric(3, 0.2, 1.0);
    pls_distance_field *field = field_of(shape);
    const double reach = pls_distance_field_reach(field);
    solids_seed(9);
    for (int k = 0; k < 500; ++k)
    {
        const pls_vec3 X = pls_scale(solids_direction(3), solids_uniform(0.6, 3.0));
        const double d = pls_distance_field_at(field, X, NULL), exact = pls_shape_sdf(shape, X);
        if (fabs(X.x) < 0.5 + reach && fabs(X.y) < 0.4 + reach && fabs(X.z) < 0.25 + reach) continue;
        assert_true(d >= reach && d <= exact + 1e-12);
    }
    pls_distance_field_free(field), pls_shape_free(shape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_are_near_to_the_distance),
        cmocka_unit_test(over_flat_places_they_are_the_distance),
        cmocka_unit_test(gradients_are_those_of_the_values),
        cmocka_unit_test(further_out_they_are_lower_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
