// test_polytope.c -- hulls, polyhedra and polygons against brute force.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/random.h"
#include "shape/mass_quadrature.h"
#include "shape/builtin.h"
#include "shape/polytope.h"
#include "support/numbers.h"

#include <string.h>

enum { MOST = 500 };
static pls_vec3 cloud[MOST];

static pls_vec3 random_vector(pls_random *r, int dimension)
{
    double x = pls_random_normal(r), y = pls_random_normal(r), z = pls_random_normal(r);
    return pls_vec(x, y, dimension == 3 ? z : 0.0);
}

/// `on_ball`: all of them are vertices; else few.
static void make_cloud(uint64_t seed, size_t count, int dimension, bool on_ball)
{
    pls_random r = pls_random_stream(seed, count, PLS_FOR_USER);
    for (size_t k = 0; k < count; ++k)
    {
        cloud[k] = random_vector(&r, dimension);
        if (on_ball) cloud[k] = pls_unit(cloud[k]);
        cloud[k] = pls_add(pls_vec(3.0, -2.0, 0.0), pls_vec(cloud[k].x, 0.7 * cloud[k].y, 0.5 * cloud[k].z));
    }
}

static uint32_t directed(const pls_polytope *p, uint32_t from, uint32_t to)
{
    uint32_t times = 0;
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        uint32_t begin = p->face_start[f], count = p->face_start[f + 1] - begin;
        for (uint32_t k = 0; k < count; ++k) times += p->face_vertex[begin + k] == from && p->face_vertex[begin + (k + 1) % count] == to;
    }
    return times;
}

/// Points within all planes, closed, Euler, normals of unit length, neighbours are the edges.
static void check_hull(const pls_hull *hull, const pls_vec3 *points, size_t count)
{
    const pls_polytope *p = &hull->body;
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        assert_true(fabs(pls_length(p->face_normal[f]) - 1.0) < 1e-14);
        for (size_t k = 0; k < count; ++k) assert_true(pls_dot(points[k], p->face_normal[f]) - hull->offset[f] < 1e-10);
        for (uint32_t k = p->face_start[f]; k < p->face_start[f + 1]; ++k)
            assert_true(fabs(pls_dot(p->vertex[p->face_vertex[k]], p->face_normal[f]) - hull->offset[f]) < 1e-10);
    }
    uint32_t edges = p->face_start[p->face_count] / 2;
    assert_int_equal((int)(p->vertex_count + p->face_count) - (int)edges, 2);
    assert_int_equal(p->neighbour_start[p->vertex_count], 2 * edges);
    for (uint32_t v = 0; v < p->vertex_count; ++v)
    {
        for (uint32_t k = p->neighbour_start[v]; k < p->neighbour_start[v + 1]; ++k)
        {
            assert_int_equal(directed(p, v, p->neighbour[k]), 1);
            assert_int_equal(directed(p, p->neighbour[k], v), 1);
        }
    }
}

static void a_grid_of_points_gives_a_cube(void **state)
{
    (void)state;
    size_t count = 0;
    for (int k = 0; k < 125; ++k) cloud[count++] = pls_vec(k % 5 * 0.1, k / 5 % 5 * 0.1, k / 25 * 0.1);
    pls_hull *hull;
    assert_int_equal(pls_hull_make(cloud, count, 3, &hull), PLS_OK);
    assert_int_equal(hull->body.vertex_count, 8);
    assert_int_equal(hull->body.face_count, 6);
    check_hull(hull, cloud, count);
    pls_hull_free(hull);
}

static void hulls_of_random_points_are_closed_and_convex(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 40; ++seed)
    {
        size_t count = seed == 0 ? 4 : 20 + (size_t)seed * 12;
        make_cloud(seed, count, 3, seed & 1);
        pls_hull *hull;
        assert_int_equal(pls_hull_make(cloud, count, 3, &hull), PLS_OK);
        if (seed & 1) assert_int_equal(hull->body.vertex_count, count);
        check_hull(hull, cloud, count);
        pls_hull_free(hull);
    }
}

static pls_shape *make(const pls_shape_ops *ops, int dimension, size_t count, double rounding)
{
    pls_shape *shape = NULL;
    const double values[2] = {rounding, 0.0}; // a polyhedron's second: the hull of a mesh is not asked for
    pls_shape_input input = {VALUES(values), .points = cloud, .point_count = count};
    pls_status status = pls_shape_make(ops, dimension, &input, "shape 'stone'", &shape);
    if (status != PLS_OK) print_error("%s\n", pls_last_message());
    assert_int_equal(status, PLS_OK);
    return shape;
}

/// Distance to the triangle by trying its plane, its three edges as segments: the plane counts if barycentric coordinates are positive.
static double to_triangle(pls_vec3 X, pls_vec3 a, pls_vec3 b, pls_vec3 c)
{
    pls_vec3 t[3] = {a, b, c}, n = pls_cross(pls_sub(b, a), pls_sub(c, a));
    double best = INFINITY;
    int inside = 0;
    for (int k = 0; k < 3; ++k)
    {
        pls_vec3 e = pls_sub(t[(k + 1) % 3], t[k]), d = pls_sub(X, t[k]);
        double s = fmin(fmax(pls_dot(d, e) / pls_dot(e, e), 0.0), 1.0);
        best = fmin(best, pls_length(pls_sub(d, pls_scale(e, s))));
        inside += pls_dot(pls_cross(e, d), n) >= 0.0;
    }
    return inside == 3 ? fabs(pls_dot(pls_sub(X, a), pls_unit(n))) : best;
}

/// All triangles of all faces, and the sign from all planes: knows nothing of regions.
static double oracle(const pls_polytope *p, pls_vec3 X)
{
    double best = INFINITY;
    bool inside = true;
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        const uint32_t *v = p->face_vertex + p->face_start[f];
        uint32_t count = p->face_start[f + 1] - p->face_start[f];
        inside &= pls_dot(pls_sub(X, p->vertex[v[0]]), p->face_normal[f]) < 0.0;
        for (uint32_t k = 1; k + 1 < count; ++k) best = fmin(best, to_triangle(X, p->vertex[v[0]], p->vertex[v[k]], p->vertex[v[k + 1]]));
    }
    return inside ? -best : best;
}

static void distances_are_those_to_all_triangles(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed < 9; ++seed)
    {
        double rounding = seed & 2 ? 0.05 : 0.0;
        make_cloud(seed, 10 + (size_t)seed * 12, 3, true);
        pls_shape *s = make(&pls_polyhedron_shape, 3, 10 + (size_t)seed * 12, rounding);
        pls_random r = pls_random_stream(seed, 77, PLS_FOR_USER);
        for (int k = 0; k < 2000; ++k)
        {
            pls_vec3 X = pls_add(pls_vec(3.0, -2.0, 0.0), pls_scale(random_vector(&r, 3), k & 1 ? 0.3 : 1.0));
            double phi = pls_shape_sdf(s, X);
            assert_true(fabs(phi - (oracle(s->polytope, X) - rounding)) < 1e-13);
            pls_vec3 g = pls_shape_gradient(s, X);
            assert_true(fabs(pls_length(g) - 1.0) < 1e-12);
            assert_true(fabs(pls_shape_sdf(s, pls_sub(X, pls_scale(g, phi)))) < 1e-12);
        }
        pls_shape_free(s);
    }
}

static void the_support_point_is_the_best_of_all(void **state)
{
    (void)state;
    for (int d = 2; d <= 3; ++d)
    {
        for (uint64_t seed = 1; seed < 12; ++seed)
        {
            size_t count = 10 + (size_t)seed * 40;
            pls_random r = pls_random_stream(seed, 5, PLS_FOR_USER);
            make_cloud(seed, count, d, true);
            pls_hull *hull;
            assert_int_equal(pls_hull_make(cloud, count, d, &hull), PLS_OK);
            for (int k = 0; k < 1000; ++k)
            {
                pls_vec3 n = pls_unit(random_vector(&r, d));
                double most = -INFINITY;
                for (size_t v = 0; v < count; ++v) most = fmax(most, pls_dot(cloud[v], n));
                assert_true(fabs(pls_dot(pls_hull_support(hull, n), n) - most) < 1e-14);
            }
            pls_hull_free(hull);
        }
    }
}

static void assert_masses_agree(const pls_shape *s)
{
    pls_mass_properties m;
    pls_vec3 middle = pls_scale(pls_add(s->lower, s->upper), 0.5);
    double reach = pls_length(pls_sub(s->upper, s->lower));
    assert_int_equal(pls_mass_by_quadrature(s, middle, reach, &m), PLS_OK);
    assert_true(fabs(m.volume / s->mass.volume - 1.0) < 1e-6);
    assert_true(pls_length(pls_sub(m.centre, s->mass.centre)) < 1e-6 * reach);
    // The quadrature tells its error relative to the volume and the reach.
    assert_true(m.error < 1e-6);
    for (int k = 0; k < 6; ++k) assert_true(fabs(m.inertia[k] - s->mass.inertia[k]) < 2.0 * m.error * m.volume * reach * reach);
}

static void masses_are_those_of_the_quadrature(void **state)
{
    (void)state;
    make_cloud(3, 20, 3, true);
    pls_shape *s = make(&pls_polyhedron_shape, 3, 20, 0.0);
    assert_masses_agree(s);
    pls_shape_free(s);
    make_cloud(3, 12, 2, true);
    s = make(&pls_polygon_shape, 2, 12, 0.0);
    assert_masses_agree(s);
    pls_shape_free(s);
}

static void a_box_has_its_mass_and_a_rounded_one_steiners(void **state)
{
    (void)state;
    const double a = 1.0, b = 2.0, c = 3.0, r = 0.25;
    for (int k = 0; k < 8; ++k) cloud[k] = pls_vec(k & 1 ? a : 0.0, k & 2 ? b : 0.0, k & 4 ? c : 0.0);
    pls_shape *s = make(&pls_polyhedron_shape, 3, 8, 0.0);
    assert_true(fabs(s->mass.volume - a * b * c) < 1e-14);
    assert_true(fabs(s->mass.inertia[0] - a * b * c * (b * b + c * c) / 12.0) < 1e-13);
    assert_true(pls_length(pls_sub(s->mass.centre, pls_vec(0.5, 1.0, 1.5))) < 1e-14);
    pls_shape_free(s);
    s = make(&pls_polyhedron_shape, 3, 8, r);
    double steiner = a * b * c + 2.0 * r * (a * b + b * c + c * a) + M_PI * r * r * (a + b + c) + 4.0 / 3.0 * M_PI * r * r * r;
    assert_true(fabs(s->mass.volume / steiner - 1.0) < 1e-6);
    pls_shape_free(s);
}

static void polygons_are_counterclockwise_and_exact(void **state)
{
    (void)state;
    for (int k = 0; k < 25; ++k) cloud[k] = pls_vec(k % 5 * 0.5, k / 5 * 0.25, 0.0);
    pls_shape *s = make(&pls_polygon_shape, 2, 25, 0.0);
    assert_int_equal(s->polytope->vertex_count, 4);
    assert_true(fabs(s->mass.volume - 2.0) < 1e-15);
    assert_true(fabs(s->mass.inertia[2] - 2.0 * 5.0 / 12.0) < 1e-14);
    assert_true(fabs(pls_shape_sdf(s, pls_vec(5.0, 5.0, 0.0)) - 5.0) < 1e-14);
    assert_true(fabs(pls_shape_sdf(s, pls_vec(1.0, 0.4, 0.0)) + 0.4) < 1e-15);
    pls_shape_free(s);
}

/// A prism is its base times its height; beside it the polyhedron of the same corners, and Steiner's volume when rounded.
static void prisms_are_bases_times_heights(void **state)
{
    (void)state;
    enum { SIDES = 7 };
    pls_vec3 base[SIDES + 1], corner[2 * SIDES];
    const double height = 0.4;
    double area = 0.0, perimeter = 0.0;
    for (int k = 0; k < SIDES; ++k)
    {
        double angle = 2.0 * M_PI * k / SIDES + 0.1 * sin(3.0 * k);
        base[k] = pls_vec(0.7 * cos(angle), 0.5 * sin(angle) + 0.1, 0.0);
        corner[2 * k] = pls_vec(base[k].x, base[k].y, -0.5 * height);
        corner[2 * k + 1] = pls_vec(base[k].x, base[k].y, 0.5 * height);
    }
    base[SIDES] = pls_vec(0.1, 0.1, 0.0); // inside
    for (int k = 0; k < SIDES; ++k)
    {
        pls_vec3 a = base[k], b = base[(k + 1) % SIDES];
        area += 0.5 * (a.x * b.y - a.y * b.x);
        perimeter += pls_length(pls_sub(b, a));
    }
    double values[2] = {0.0, height};
    const pls_shape_input input = {VALUES(values), .points = base, .point_count = SIDES + 1};
    const pls_shape_input solid = {.points = corner, .point_count = 2 * SIDES};
    pls_shape *prism = NULL, *same = NULL;
    assert_int_equal(pls_shape_make(&pls_prism_shape, 3, &input, "x", &prism), PLS_OK);
    assert_int_equal(pls_shape_make(&pls_polyhedron_shape, 3, &solid, "x", &same), PLS_OK);
    assert_int_equal(prism->polytope->face_count, SIDES + 2);
    assert_int_equal(prism->polytope->vertex_count, 2 * SIDES);
    assert_true(fabs(prism->mass.volume - area * height) < 1e-15);
    assert_true(fabs(prism->mass.centre.z) < 1e-15 && fabs(prism->upper.z - 0.5 * height) < 1e-15);
    for (int k = 0; k < 500; ++k)
    {
        pls_vec3 X = pls_vec(sin(1.7 * k), cos(2.3 * k), sin(0.9 * k + 1.0));
        assert_true(fabs(pls_shape_sdf(prism, X) - pls_shape_sdf(same, X)) < 1e-14);
    }
    pls_shape_free(prism);
    pls_shape_free(same);
    const double r = values[0] = 0.05;
    assert_int_equal(pls_shape_make(&pls_prism_shape, 3, &input, "x", &prism), PLS_OK);
    // Half the sum of edge length times outer angle: right angles at top and bottom, 2 pi over all upright edges.
    const double known = area * height + (2.0 * area + perimeter * height) * r + (0.5 * M_PI * perimeter + M_PI * height) * r * r +
                         4.0 / 3.0 * M_PI * r * r * r;
    assert_true(fabs(prism->mass.volume / known - 1.0) < 1e-6);
    assert_true(fabs(prism->upper.z - 0.5 * height - r) < 1e-15);
    pls_shape_free(prism);
    const pls_shape_input flat = {VALUES(values), .points = base, .point_count = 2};
    assert_int_equal(pls_shape_make(&pls_prism_shape, 3, &flat, "x", &prism), PLS_INVALID_ARGUMENT);
    assert_string_equal(pls_last_message(), "x: the base of a prism needs at least 3 points, not 2");
}

static void assert_refused(size_t count, int dimension, const char *message)
{
    pls_hull *hull;
    assert_int_equal(pls_hull_make(cloud, count, dimension, &hull), PLS_INVALID_ARGUMENT);
    assert_null(hull);
    assert_string_equal(pls_last_message(), message);
}

static void points_without_a_volume_are_refused(void **state)
{
    (void)state;
    make_cloud(1, 20, 2, false);
    assert_refused(3, 3, "a polyhedron needs at least 4 points, not 3");
    assert_refused(2, 2, "a polygon needs at least 3 points, not 2");
    assert_refused(20, 3, "the 20 points lie in a plane; give points that span a volume");
    cloud[1] = pls_vec(1.0, NAN, 0.0);
    assert_refused(20, 3, "point 2 of a polyhedron is (1, nan, 0) m; coordinates must be finite numbers");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grid_of_points_gives_a_cube),           cmocka_unit_test(hulls_of_random_points_are_closed_and_convex),
        cmocka_unit_test(distances_are_those_to_all_triangles),    cmocka_unit_test(the_support_point_is_the_best_of_all),
        cmocka_unit_test(masses_are_those_of_the_quadrature),      cmocka_unit_test(a_box_has_its_mass_and_a_rounded_one_steiners),
        cmocka_unit_test(polygons_are_counterclockwise_and_exact), cmocka_unit_test(points_without_a_volume_are_refused),
        cmocka_unit_test(prisms_are_bases_times_heights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
