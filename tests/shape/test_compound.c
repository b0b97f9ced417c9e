// Compounds and their parts against closed forms, a second shape that is the same, and brute force over the parts.

#include "shape/builtin.h"

#include "base/random.h"
#include "support/numbers.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static pls_shape *make(const pls_shape_ops *ops, int dimension, const double *values, size_t count)
{
    pls_shape *shape = NULL;
    const pls_shape_input input = {.values = values, .value_count = count};
    if (pls_shape_make(ops, dimension, &input, "shape 'x'", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

/// Takes hold of the parts' shapes from the caller.
static pls_shape *join(int dimension, const pls_shape_part *parts, size_t count)
{
    pls_shape *whole = NULL;
    const pls_shape_input input = {.parts = parts, .part_count = count};
    if (pls_shape_make(&pls_compound_shape, dimension, &input, "shape 'x'", &whole) != PLS_OK) fail_msg("%s", pls_last_message());
    return whole;
}

static pls_shape_part at(const pls_shape *shape, double x, double y, double z)
{
    return (pls_shape_part){.shape = shape, .position = {x, y, z}, .orientation = {1.0, 0.0, 0.0, 0.0}, .scale = 1.0};
}

static pls_quat turn(double x, double y, double z, double angle)
{
    pls_vec3 a = pls_scale(pls_unit(pls_vec(x, y, z)), sin(0.5 * angle));
    return (pls_quat){cos(0.5 * angle), a.x, a.y, a.z};
}

static void assert_near(double value, double known, double error)
{
    if (!(fabs(value - known) <= error)) fail_msg("%.15g is not %.15g, off by %g", value, known, value - known);
}

static pls_vec3 random_point(pls_random *random, int dimension, double size)
{
    double u[3];
    for (int a = 0; a < 3; ++a) u[a] = 2.0 * size * (pls_random_uniform(random) - 0.5);
    return pls_vec(u[0], u[1], dimension == 2 ? 0.0 : u[2]);
}

// ---- two boxes are one --------------------------------------------------------------------------------------------------------------------------------------

static void flush_boxes_are_one_box(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        const double left[4] = {0.3, 0.2, 0.4, 0.0}, right[4] = {0.1, 0.2, 0.4, 0.0}, both[4] = {0.4, 0.2, 0.4, 0.0};
        pls_shape *a = make(&pls_box_shape, dimension, COUNTED(left)), *b = make(&pls_box_shape, dimension, COUNTED(right)),
                  *one = make(&pls_box_shape, dimension, COUNTED(both));
        const pls_shape_part parts[2] = {at(a, -0.1, 0.0, 0.0), at(b, 0.3, 0.0, 0.0)};
        pls_shape *pair = join(dimension, parts, 2);
        assert_int_equal(pair->part_count, 2);
        assert_false(pair->convex);
        assert_near(pair->mass.volume, one->mass.volume, 1e-15);
        assert_true(pls_length(pair->mass.centre) < 1e-15);
        assert_true(pls_length(pls_sub(pair->moments, one->moments)) < 1e-15);
        assert_near(pair->radius, one->radius, 1e-12);
        assert_true(pls_length(pls_sub(pair->upper, one->upper)) < 1e-14 && pls_length(pls_sub(pair->lower, one->lower)) < 1e-14);
        pls_random random = pls_random_stream(1, 0, PLS_FOR_USER);
        for (int k = 0; k < 2000; ++k)
        {
            pls_vec3 X = random_point(&random, dimension, 1.0);
            double phi = pls_shape_sdf(one, X), mine = pls_shape_sdf(pair, X);
            if (phi > 0.0)
                assert_near(mine, phi, 1e-15);
            else
                assert_true(mine <= 1e-16 && mine >= phi - 1e-15); // inside: less deep near the seam
        }
        pls_shape_free(a);
        pls_shape_free(b); // the pair keeps them
        assert_true(pls_shape_sdf(pair, pls_vec(0.0, 0.0, 0.0)) < 0.0);
        pls_shape_free(one);
        pls_shape_free(pair);
    }
}

// ---- mass ---------------------------------------------------------------------------------------------------------------------------------------------------

/// Moments 1, x, y, z, xx, yy, zz, xy, xz, yz of a posed box, exact by Gauss's rule of two points per edge.
static void add_box(const pls_shape_part *part, int dimension, double sum[10])
{
    const double *half = part->shape->values, g = 1.0 / sqrt(3.0);
    const int points = dimension == 2 ? 4 : 8;
    const double weight = half[0] * half[1] * (dimension == 2 ? 1.0 : half[2]) * pow(part->scale, dimension);
    for (int k = 0; k < points; ++k)
    {
        pls_vec3 x = pls_vec(k & 1 ? half[0] * g : -half[0] * g, k & 2 ? half[1] * g : -half[1] * g, 0.0);
        if (dimension == 3) x.z = k & 4 ? half[2] * g : -half[2] * g;
        x = pls_add(part->position, pls_scale(pls_rotate(part->orientation, x), part->scale));
        const double term[10] = {1.0, x.x, x.y, x.z, x.x * x.x, x.y * x.y, x.z * x.z, x.x * x.y, x.x * x.z, x.y * x.z};
        for (int m = 0; m < 10; ++m) sum[m] += weight * term[m];
    }
}

/// Parts that are turned, scaled and apart are added up by Steiner's rule.
static void parts_apart_are_added_up(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        const double half[2][4] = {{0.3, 0.2, 0.25, 0.0}, {0.1, 0.3, 0.15, 0.0}};
        pls_shape *a = make(&pls_box_shape, dimension, COUNTED(half[0])), *b = make(&pls_box_shape, dimension, COUNTED(half[1]));
        pls_shape_part parts[2] = {at(a, 0.1, 0.2, 0.0), at(b, 0.8, -0.3, dimension == 2 ? 0.0 : 0.4)};
        parts[0].orientation = dimension == 2 ? turn(0, 0, 1, 0.7) : turn(1, 2, -1, 0.7);
        parts[1].scale = 1.2;
        pls_shape *whole = join(dimension, parts, 2);
        double m[10] = {0.0};
        for (int k = 0; k < 2; ++k) add_box(&parts[k], dimension, m);
        const pls_mass_properties *known = &whole->mass;
        assert_near(known->volume, m[0], 1e-15);
        pls_vec3 c = pls_scale(pls_vec(m[1], m[2], m[3]), 1.0 / m[0]);
        assert_true(pls_length(pls_sub(known->centre, c)) < 1e-15);
        const double xx = m[4] - m[0] * c.x * c.x, yy = m[5] - m[0] * c.y * c.y, zz = m[6] - m[0] * c.z * c.z;
        assert_near(known->inertia[2], xx + yy, 1e-15);
        if (dimension == 3)
        {
            assert_near(known->inertia[0], yy + zz, 1e-15);
            assert_near(known->inertia[1], xx + zz, 1e-15);
            assert_near(known->inertia[3], -(m[7] - m[0] * c.x * c.y), 1e-15);
            assert_near(known->inertia[4], -(m[8] - m[0] * c.x * c.z), 1e-15);
            assert_near(known->inertia[5], -(m[9] - m[0] * c.y * c.z), 1e-15);
        }
        assert_true(known->error == 0.0); // closed forms
        pls_shape_free(a);
        pls_shape_free(b);
        pls_shape_free(whole);
    }
}

/// Two discs of radius 1 whose centres are d apart share the lens 2 acos(d/2) - d/2 sqrt(4 - d^2).
static void overlaps_count_once(void **state)
{
    (void)state;
    const double radius[1] = {1.0}, d = 1.1;
    pls_shape *disc = make(&pls_disc_shape, 2, COUNTED(radius));
    const pls_shape_part parts[2] = {at(disc, 0.0, 0.0, 0.0), at(disc, d, 0.0, 0.0)};
    pls_shape *pair = join(2, parts, 2);
    assert_near(pair->mass.volume, 2.0 * M_PI - (2.0 * acos(0.5 * d) - 0.5 * d * sqrt(4.0 - d * d)), 1e-6);
    assert_near(pair->mass.centre.x, 0.5 * d, 1e-6);
    pls_shape_free(disc);
    pls_shape_free(pair);
    // Balls: the lens is pi (4 + d) (2 - d)^2 / 12.
    pls_shape *ball = make(&pls_sphere_shape, 3, COUNTED(radius));
    const pls_shape_part balls[2] = {at(ball, 0.0, 0.0, 0.0), at(ball, d, 0.0, 0.0)};
    pair = join(3, balls, 2);
    assert_near(pair->mass.volume, 8.0 / 3.0 * M_PI - M_PI * (4.0 + d) * (2.0 - d) * (2.0 - d) / 12.0, 1e-5);
    assert_near(pair->mass.centre.x, 0.5 * d, 1e-5);
    pls_shape_free(ball);
    pls_shape_free(pair);
}

// ---- many parts ---------------------------------------------------------------------------------------------------------------------------------------------

enum { MANY = 60 };

/// In place of the quadrature, which is not what is tried here and takes long for so many parts.
static pls_status any_mass(const pls_shape *shape, pls_mass_properties *out)
{
    (void)shape;
    *out = (pls_mass_properties){.volume = 1.0, .inertia = {1.0, 1.0, 1.0}};
    return PLS_OK;
}

static pls_shape *make_many(int dimension, pls_shape_part parts[MANY])
{
    static pls_shape_ops ops;
    const double half[4] = {0.2, 0.1, 0.15, 0.02}, ball[1] = {0.15};
    pls_shape *box = make(&pls_box_shape, dimension, COUNTED(half)), *round = make(&pls_sphere_shape, dimension, COUNTED(ball)),
              *whole = NULL;
    pls_random random = pls_random_stream(2, 0, PLS_FOR_USER);
    for (int k = 0; k < MANY; ++k)
    {
        pls_vec3 axis = dimension == 2 ? pls_vec(0, 0, 1) : pls_unit(random_point(&random, 3, 1.0));
        parts[k] = (pls_shape_part){.shape = k % 3 ? box : round,
                                    .position = random_point(&random, dimension, 2.0),
                                    .orientation = turn(axis.x, axis.y, axis.z, 6.0 * pls_random_uniform(&random)),
                                    .scale = 0.5 + pls_random_uniform(&random)};
    }
    ops = pls_compound_shape;
    ops.mass_properties = any_mass;
    const pls_shape_input input = {.parts = parts, .part_count = MANY};
    if (pls_shape_make(&ops, dimension, &input, "shape 'x'", &whole) != PLS_OK) fail_msg("%s", pls_last_message());
    pls_shape_free(box); // the whole keeps them
    pls_shape_free(round);
    return whole;
}

static double least_of(const pls_shape_part *parts, size_t count, pls_vec3 X)
{
    double least = INFINITY;
    for (size_t k = 0; k < count; ++k)
        least = fmin(least, parts[k].scale * pls_shape_sdf(parts[k].shape, pls_part_from_whole(&parts[k], X)));
    return least;
}

static void distances_are_the_least_of_all_parts(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape_part parts[MANY];
        pls_shape *whole = make_many(dimension, parts);
        pls_random random = pls_random_stream(3, 0, PLS_FOR_USER);
        for (int k = 0; k < 3000; ++k)
        {
            pls_vec3 X = random_point(&random, dimension, k % 2 ? 2.5 : 20.0), g = pls_shape_gradient(whole, X);
            double phi = pls_shape_sdf(whole, X), h = 1e-6;
            assert_near(phi, least_of(parts, MANY, X), 1e-13);
            double ahead = least_of(parts, MANY, pls_add(X, pls_scale(g, h))), behind = least_of(parts, MANY, pls_sub(X, pls_scale(g, h)));
            if (phi > 0.0) assert_true(behind < phi && ahead > phi - 1e-12); // downhill is where the nearest part is
        }
        pls_shape_free(whole);
    }
}

static void supports_and_bounds_hold_all_parts(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape_part parts[MANY];
        pls_shape *whole = make_many(dimension, parts);
        pls_random random = pls_random_stream(4, 0, PLS_FOR_USER);
        double furthest = 0.0;
        for (int k = 0; k < 3000; ++k)
        {
            pls_vec3 n = pls_unit(random_point(&random, dimension, 1.0)), s = pls_shape_support(whole, n);
            double most = -INFINITY;
            for (int j = 0; j < MANY; ++j)
            {
                pls_vec3 x = pls_part_to_whole(&parts[j], pls_shape_support(parts[j].shape, pls_rotate_back(parts[j].orientation, n)));
                most = fmax(most, pls_dot(x, n));
                furthest = fmax(furthest, pls_length(pls_sub(x, whole->mass.centre)));
            }
            assert_near(pls_dot(s, n), most, 1e-14);
            assert_true(s.x <= whole->upper.x + 1e-12 && s.y <= whole->upper.y + 1e-12 && s.z <= whole->upper.z + 1e-12);
            assert_true(s.x >= whole->lower.x - 1e-12 && s.y >= whole->lower.y - 1e-12 && s.z >= whole->lower.z - 1e-12);
        }
        assert_true(whole->radius >= furthest);
        assert_true(whole->radius < 1.01 * furthest); // and is little more than needed: many directions came close to the furthest corner
        pls_shape_free(whole);
    }
}

/// Squared distance of X from the box about a part, by its corners and faces: an independent sum.
static double distance_from_box(const pls_shape_part *part, pls_vec3 X)
{
    pls_vec3 low = {INFINITY, INFINITY, INFINITY}, up = {-INFINITY, -INFINITY, -INFINITY};
    for (int k = 0; k < 8; ++k)
    {
        pls_vec3 l = part->shape->lower, u = part->shape->upper,
                 x = pls_part_to_whole(part, pls_vec(k & 1 ? u.x : l.x, k & 2 ? u.y : l.y, k & 4 ? u.z : l.z));
        low = pls_vec(fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z));
        up = pls_vec(fmax(up.x, x.x), fmax(up.y, x.y), fmax(up.z, x.z));
    }
    pls_vec3 d = pls_vec(fmax(fmax(low.x - X.x, X.x - up.x), 0.0), fmax(fmax(low.y - X.y, X.y - up.y), 0.0),
                         fmax(fmax(low.z - X.z, X.z - up.z), 0.0));
    return pls_length(d);
}

static void parts_near_a_point_are_found_in_rising_order(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape_part parts[MANY];
        pls_shape *whole = make_many(dimension, parts);
        pls_random random = pls_random_stream(5, 0, PLS_FOR_USER);
        for (int k = 0; k < 1000; ++k)
        {
            pls_vec3 X = random_point(&random, dimension, 3.0);
            double radius = 2.0 * pls_random_uniform(&random);
            uint32_t found[MANY], few[2] = {UINT32_MAX, UINT32_MAX};
            size_t count = pls_shape_parts_near(whole, X, radius, found, MANY), again = pls_shape_parts_near(whole, X, radius, few, 2),
                   next = 0;
            assert_int_equal(count, again);
            for (size_t j = 0; j < 2; ++j) assert_int_equal(few[j], j < count ? found[j] : UINT32_MAX);
            for (uint32_t p = 0; p < whole->part_count; ++p)
            {
                const pls_shape_part *part = &whole->part[p];
                bool listed = next < count && found[next] == p;
                next += listed;
                // All whose surface comes so near are there, and none whose box does not.
                if (part->scale * pls_shape_sdf(part->shape, pls_part_from_whole(part, X)) < radius) assert_true(listed);
                if (distance_from_box(part, X) > radius + 1e-12) assert_false(listed);
            }
            assert_int_equal(next, count); // rising
        }
        assert_int_equal(pls_shape_parts_near(whole, pls_vec(0, 0, 0), -1.0, NULL, 0), 0);
        pls_shape_free(whole);
    }
}

static void compounds_of_compounds_have_the_innermost_parts(void **state)
{
    (void)state;
    const double ball[1] = {0.2};
    pls_shape *sphere = make(&pls_sphere_shape, 3, COUNTED(ball));
    const pls_shape_part two[2] = {at(sphere, 0.5, 0.0, 0.0), at(sphere, -0.5, 0.0, 0.0)};
    pls_shape *inner = join(3, two, 2);
    pls_shape_part outer[2] = {at(inner, 0.0, 2.0, 0.0), at(sphere, 0.0, 0.0, 1.0)};
    outer[0].orientation = turn(0, 0, 1, M_PI / 2);
    outer[0].scale = 2.0;
    pls_shape *whole = join(3, outer, 2);
    pls_shape_free(sphere);
    pls_shape_free(inner);
    assert_int_equal(whole->part_count, 3);
    const pls_vec3 known[3] = {{0.0, 3.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}; // balls of radius 0.4, 0.4, 0.2
    for (int k = 0; k < 3; ++k)
    {
        pls_vec3 X = pls_add(known[k], pls_vec(0.7, 0.0, 0.0));
        assert_near(pls_shape_sdf(whole, X), 0.7 - (k < 2 ? 0.4 : 0.2), 1e-15);
    }
    const double big = 4.0 / 3.0 * M_PI * 0.064, small = 4.0 / 3.0 * M_PI * 0.008;
    assert_near(whole->mass.volume, 2.0 * big + small, 1e-15);
    assert_near(whole->mass.centre.y, 4.0 * big / (2.0 * big + small), 1e-14);
    pls_shape_free(whole);
}

static void refuse(const pls_shape_part *part, size_t count, const char *message)
{
    pls_shape *shape = NULL;
    const pls_shape_input input = {.parts = part, .part_count = count};
    assert_int_equal(pls_shape_make(&pls_compound_shape, 3, &input, "x", &shape), PLS_INVALID_ARGUMENT);
    assert_null(shape);
    assert_string_equal(pls_last_message(), message);
}

static double everywhere(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    (void)X;
    return 2.0;
}

static void parts_that_no_grain_has_are_refused(void **state)
{
    (void)state;
    const double ball[1] = {0.2}, none[1] = {0.0};
    pls_shape *sphere = make(&pls_sphere_shape, 3, COUNTED(ball)), *disc = make(&pls_disc_shape, 2, COUNTED(ball)),
              *plane = make(&pls_plane_shape, 3, COUNTED(none));
    pls_shape_ops uneven = pls_sphere_shape;
    uneven.density = everywhere;
    pls_shape *dense = make(&uneven, 3, COUNTED(ball));
    pls_shape_part part = at(sphere, 0, 0, 0);
    refuse(NULL, 0, "x: a compound needs at least one part");
    part.scale = 0.0;
    refuse(&part, 1, "x: part 1 of a compound has scale 0; it must be positive");
    part = at(sphere, NAN, 0, 0);
    refuse(&part, 1, "x: part 1 of a compound has no finite position or no orientation of length one");
    part = at(disc, 0, 0, 0);
    refuse(&part, 1, "x: part 1 of a compound is made for 2D, the compound for 3D");
    part = at(plane, 0, 0, 0);
    refuse(&part, 1, "x: part 1 of a compound is a plane, which has no mass; take shapes that grains may have");
    part = at(dense, 0, 0, 0);
    refuse(&part, 1,
           "x: part 1 of a compound has a density of its own, which varies in space; the parts of a compound are all of its material");
    pls_shape_free(sphere);
    pls_shape_free(disc);
    pls_shape_free(plane);
    pls_shape_free(dense);
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flush_boxes_are_one_box),
        cmocka_unit_test(parts_apart_are_added_up),
        cmocka_unit_test(overlaps_count_once),
        cmocka_unit_test(distances_are_the_least_of_all_parts),
        cmocka_unit_test(supports_and_bounds_hold_all_parts),
        cmocka_unit_test(parts_near_a_point_are_found_in_rising_order),
        cmocka_unit_test(compounds_of_compounds_have_the_innermost_parts),
        cmocka_unit_test(parts_that_no_grain_has_are_refused),
    };
    return cmocka_run_group_tests_name("compound", tests, NULL, NULL);
}
