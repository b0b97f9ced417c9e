// The signed distance of superquadrics against a search over the whole surface, inside above all: there may be several nearest places, hardly different from each other.

#include "shape/builtin.h"

#include "base/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { MESHES = 80, WAYS = 12, TURNS = 60 };

static double norm(double x, double y, double p)
{
    double most = fmax(x, y);
    return most > 0.0 ? most * pow(pow(x / most, p) + pow(y / most, p), 1.0 / p) : 0.0;
}

/// Below 1 inside.
static double gauge(const pls_shape *shape, pls_vec3 X)
{
    const double *v = shape->values, z = shape->dimension == 2 ? 0.0 : fabs(X.z) / v[2];
    return norm(norm(fabs(X.x) / v[0], fabs(X.y) / v[1], 2.0 / v[4]), z, 2.0 / v[3]);
}

/// The point of the surface (first octant) at two angles of a ray, axes scaled to 1.
static pls_vec3 surface(const pls_shape *shape, double a, double b)
{
    const double *v = shape->values;
    pls_vec3 x = pls_vec(v[0] * cos(b) * cos(a), v[1] * cos(b) * sin(a), shape->dimension == 2 ? 0.0 : v[2] * sin(b));
    return pls_scale(x, 1.0 / gauge(shape, x));
}

/// Points of the surface on a net of angles.
typedef struct net
{
    const pls_shape *shape;
    int columns;
    pls_vec3 point[MESHES + 1][MESHES + 1];
} net;

static void make_net(const pls_shape *shape, net *n)
{
    n->shape = shape;
    n->columns = shape->dimension == 2 ? 1 : MESHES + 1;
    for (int i = 0; i <= MESHES; ++i)
        for (int j = 0; j < n->columns; ++j) n->point[i][j] = surface(shape, M_PI_2 * i / MESHES, M_PI_2 * j / MESHES);
}

static double right_angle(double angle) { return fmin(fmax(angle, 0.0), M_PI_2); }

/// The nearest point around (a, b), by ever smaller ways. In narrow valleys of the distance it comes close only.
static double refine(const net *n, pls_vec3 X, double a, double b)
{
    double least = pls_length(pls_sub(surface(n->shape, a, b), X));
    double way = M_PI_2 / MESHES;
    for (int turn = 0; turn < TURNS && way > 1e-8; ++turn)
    {
        bool moved = false;
        for (int w = 0; w < WAYS; ++w)
        {
            const double angle = 2.0 * M_PI * w / WAYS, a2 = right_angle(a + way * cos(angle)),
                         b2 = n->columns == 1 ? 0.0 : right_angle(b + way * sin(angle));
            const double distance = pls_length(pls_sub(surface(n->shape, a2, b2), X));
            if (distance < least) least = distance, a = a2, b = b2, moved = true;
        }
        if (!moved) way *= 0.4;
    }
    return least;
}

static bool is_least(const net *n, double (*distance)[MESHES + 1], int i, int j)
{
    for (int k = i > 0 ? i - 1 : 0; k <= i + 1 && k <= MESHES; ++k)
        for (int l = j > 0 ? j - 1 : 0; l <= j + 1 && l < n->columns; ++l)
            if (distance[k][l] < distance[i][j]) return false;
    return true;
}

/// From all local minima on the net that may lead to the least.
static double distance_to_surface(const net *n, pls_vec3 X)
{
    static double distance[MESHES + 1][MESHES + 1];
    double nearest = INFINITY, least = INFINITY;
    X = pls_vec(fabs(X.x), fabs(X.y), fabs(X.z));
    for (int i = 0; i <= MESHES; ++i)
        for (int j = 0; j < n->columns; ++j)
        {
            distance[i][j] = pls_length(pls_sub(n->point[i][j], X));
            nearest = fmin(nearest, distance[i][j]);
        }
    for (int i = 0; i <= MESHES; ++i)
        for (int j = 0; j < n->columns; ++j)
            if (distance[i][j] < nearest + 0.02 * n->shape->radius && is_least(n, distance, i, j))
                least = fmin(least, refine(n, X, M_PI_2 * i / MESHES, M_PI_2 * j / MESHES));
    return least;
}

/// No point of the surface is nearer than the SDF says, and one is as near: the foot lies on the surface.
static void compare(const net *n, pls_vec3 X)
{
    const pls_shape *s = n->shape;
    const double *v = s->values, phi = pls_shape_sdf(s, X), known = distance_to_surface(n, X);
    const double foot = gauge(s, pls_sub(X, pls_scale(pls_shape_gradient(s, X), phi)));
    if (fabs(phi) > known + 1e-10 * s->radius || fabs(foot - 1.0) > 1e-7 || (phi < 0.0) != (gauge(s, X) < 1.0))
        fail_msg(
            "half (%g %g %g), exponents %g, %g: the SDF at (%.9g, %.9g, %.9g) is %.12g, the surface is %.12g away; gauge of the foot %.9g",
            v[0], v[1], v[2], v[3], v[4], X.x, X.y, X.z, phi, known, foot);
}

static pls_shape *make(int dimension, const double values[6])
{
    pls_shape *shape = NULL;
    const pls_shape_input input = {.values = values, .value_count = 6};
    if (pls_shape_make(&pls_superquadric_shape, dimension, &input, "a superquadric", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

static pls_vec3 random_point(const pls_shape *s, double size, pls_random *random)
{
    double u[3];
    for (int k = 0; k < 3; ++k) u[k] = size * (2.0 * pls_random_uniform(random) - 1.0) * s->values[k];
    return pls_vec(u[0], u[1], s->dimension == 2 ? 0.0 : u[2]);
}

static void distance_is_that_of_the_nearest_point_of_the_surface(void **state)
{
    (void)state;
    enum { POINTS = 88 };
    static const double examples[][6] = {
        {0.6, 0.8, 1.0, 0.5, 0.7}, {0.6, 0.8, 1.0, 1.0, 1.0},  {0.8, 0.7, 0.6, 1.4, 0.6},  {0.8, 0.8, 0.8, 0.1, 0.1},
        {0.8, 1.0, 0.6, 1.9, 1.9}, {0.8, 1.0, 0.6, 0.1, 1.9},  {0.8, 1.0, 0.6, 1.9, 0.1},  {1.0, 0.1, 0.05, 0.5, 0.5},
        {0.2, 0.25, 1., 1.5, 1.2}, {1.0, 1.0, 0.05, 0.6, 0.4}, {1.0, 1.01, 0.98, 0.9, 1.}, {3e-4, 2e-4, 2e-4, 0.3, 0.8},
    };
    static net n;
    for (size_t e = 0; e < sizeof examples / sizeof *examples; ++e)
        for (int dimension = 2; dimension <= 3; ++dimension)
        {
            pls_shape *s = make(dimension, examples[e]);
            pls_random random = pls_random_stream(12, e, PLS_FOR_USER);
            make_net(s, &n);
            for (int k = 0; k < POINTS; ++k)
            {
                pls_vec3 X = random_point(s, k % 4 ? 1.0 : 1.5, &random);
                const double size = gauge(s, X);
                if (k % 4 == 1 && size > 1.0) X = pls_scale(X, 0.9 * pls_random_uniform(&random) / size); // deep inside
                if (k % 10 == 9) X.x = 0.0;
                if (k % 14 == 13) X.y = 0.0;
                if (k % 22 == 21) X = pls_scale(X, 1e-3);
                compare(&n, X);
            }
            pls_shape_free(s);
        }
}

/// Three places of the surface, or two close ones, compete.
static void the_nearest_of_places_that_hardly_differ_is_found(void **state)
{
    (void)state;
    static const struct
    {
        int dimension;
        double values[6];
        pls_vec3 X;
    } cases[] = {
        {3, {0.6, 0.8, 1.0, 0.5, 0.7}, {-0.064642, -0.275593, -0.486548}}, {2, {0.6, 0.8, 1.0, 0.5, 0.7}, {0.099527, -0.316116, 0.0}},
        {2, {1.0, 0.1, 0.05, 0.5, 0.5}, {0.942365, 0.013546, 0.0}},        {2, {1.0, 0.1, 0.05, 0.5, 0.5}, {0.937322, -0.006674, 0.0}},
        {3, {1.0, 0.1, 0.05, 0.5, 0.5}, {-0.970442, 0.022695, -0.00105}},  {3, {1.0, 0.1, 0.05, 0.5, 0.5}, {0.744333, -0.067976, 0.017593}},
        {3, {0.05, 1.0, 1.0, 0.6, 0.6}, {0.000973, 0.187488, 0.976381}},   {3, {1.0, 1.0, 0.05, 0.6, 0.4}, {0.975031, 0.030845, 0.000623}},
        {2, {1.0, 0.1, 0.2, 1.6, 0.3}, {-0.95584, 0.039148, 0.0}},         {3, {1.0, 0.1, 0.2, 0.2, 0.3}, {0.959203, -0.039806, 0.106169}},
    };
    static net n;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k)
    {
        pls_shape *s = make(cases[k].dimension, cases[k].values);
        make_net(s, &n);
        compare(&n, cases[k].X);
        pls_shape_free(s);
    }
}

/// 0 on the surface, convex (never below the plane of any other point) and with the gradient of differences; rounded it is the distance.
static void level_is_convex_and_zero_on_the_surface(void **state)
{
    (void)state;
    static const double examples[][6] = {{0.6, 0.8, 1.0, 0.5, 0.7},
                                         {0.8, 0.8, 0.8, 0.1, 0.1},
                                         {0.8, 1.0, 0.6, 1.9, 1.9},
                                         {0.8, 1.0, 0.6, 0.1, 1.9},
                                         {0.5, 0.4, 0.3, 0.7, 0.6, 0.1}};
    for (size_t e = 0; e < sizeof examples / sizeof *examples; ++e)
        for (int dimension = 2; dimension <= 3; ++dimension)
        {
            pls_shape *s = make(dimension, examples[e]);
            pls_random random = pls_random_stream(13, e, PLS_FOR_USER);
            const double rounding = examples[e][5], h = 1e-6;
            for (int k = 0; k < 200; ++k)
            {
                const pls_vec3 X = random_point(s, 1.7, &random), Y = random_point(s, 1.7, &random);
                pls_vec3 slope, ignored;
                const double level = s->ops->level(s, X, &slope);
                assert_true(s->ops->level(s, Y, &ignored) >= level + pls_dot(slope, pls_sub(Y, X)) - 1e-12);
                if (rounding > 0.0)
                    assert_true(fabs(level - pls_shape_sdf(s, X)) < 1e-14);
                else
                    assert_true(fabs(s->ops->level(s, pls_scale(X, 1.0 / gauge(s, X)), &ignored)) < 1e-14);
                const double differs =
                    s->ops->level(s, pls_add(X, pls_scale(Y, h)), &ignored) - s->ops->level(s, pls_sub(X, pls_scale(Y, h)), &ignored);
                assert_true(fabs(differs / (2.0 * h) - pls_dot(slope, Y)) < 1e-4 * (1.0 + pls_length(slope)));
            }
            pls_shape_free(s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distance_is_that_of_the_nearest_point_of_the_surface),
        cmocka_unit_test(the_nearest_of_places_that_hardly_differ_is_found),
        cmocka_unit_test(level_is_convex_and_zero_on_the_surface),
    };
    return cmocka_run_group_tests_name("superquadric", tests, NULL, NULL);
}
