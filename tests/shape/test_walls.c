// Walls of triangles and of segments against all their pieces, and meshes as grains: convex ones, and those that are not.

#include "shape/builtin.h"

#include "base/atomic_file.h"
#include "base/random.h"
#include "base/text.h"
#include "support/numbers.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 24 };

typedef struct triangles
{
    pls_vec3 corner[2 * SIDE * SIDE][3];
    size_t count;
} triangles;

static double hill(int i, int j) { return 0.3 * sin(0.5 * i) * cos(0.4 * j); }

/// A hilly sheet of 2 SIDE^2 triangles, as a file and as what the file says.
static void write_hills(const char *path, triangles *t)
{
    pls_text text = {0};
    t->count = 0;
    for (int j = 0; j <= SIDE; ++j)
        for (int i = 0; i <= SIDE; ++i)
            assert_int_equal(pls_text_print(&text, "v %.17g %.17g %.17g\n", 0.1 * i, 0.1 * j, hill(i, j)), PLS_OK);
    for (int j = 0; j < SIDE; ++j)
    {
        for (int i = 0; i < SIDE; ++i)
        {
            const int v = j * (SIDE + 1) + i + 1, up = v + SIDE + 1;
            assert_int_equal(pls_text_print(&text, "f %d %d %d\nf %d %d %d\n", v, v + 1, up + 1, v, up + 1, up), PLS_OK);
            const pls_vec3 a = {0.1 * i, 0.1 * j, hill(i, j)}, b = {0.1 * (i + 1), 0.1 * j, hill(i + 1, j)},
                           c = {0.1 * (i + 1), 0.1 * (j + 1), hill(i + 1, j + 1)}, d = {0.1 * i, 0.1 * (j + 1), hill(i, j + 1)};
            const pls_vec3 corners[2][3] = {{a, b, c}, {a, c, d}};
            memcpy(t->corner[t->count], corners, sizeof corners);
            t->count += 2;
        }
    }
    assert_int_equal(pls_write_file(path, text.data, text.size), PLS_OK);
    pls_text_free(&text);
}

static double to_segment(pls_vec3 a, pls_vec3 b, pls_vec3 X)
{
    pls_vec3 e = pls_sub(b, a);
    double t = pls_dot(pls_sub(X, a), e) / pls_dot(e, e);
    return pls_length(pls_sub(X, pls_add(a, pls_scale(e, t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t))));
}

/// By barycentric coordinates from the normal equations.
static double to_triangle(const pls_vec3 c[3], pls_vec3 X)
{
    pls_vec3 u = pls_sub(c[1], c[0]), v = pls_sub(c[2], c[0]), d = pls_sub(X, c[0]);
    double uu = pls_dot(u, u), uv = pls_dot(u, v), vv = pls_dot(v, v), ud = pls_dot(u, d), vd = pls_dot(v, d), det = uu * vv - uv * uv;
    double s = (vv * ud - uv * vd) / det, t = (uu * vd - uv * ud) / det;
    if (s >= 0.0 && t >= 0.0 && s + t <= 1.0) return pls_length(pls_sub(d, pls_add(pls_scale(u, s), pls_scale(v, t))));
    return fmin(to_segment(c[0], c[1], X), fmin(to_segment(c[1], c[2], X), to_segment(c[2], c[0], X)));
}

static pls_status make(const pls_shape_ops *ops, int dimension, const pls_shape_input *input, pls_shape **shape)
{
    return pls_shape_make(ops, dimension, input, "shape 'x'", shape);
}

static pls_vec3 random_point(pls_random *random, int dimension, pls_vec3 low, pls_vec3 up)
{
    double u[3];
    for (int a = 0; a < 3; ++a) u[a] = 2.0 * pls_random_uniform(random) - 0.5;
    return pls_vec(low.x + u[0] * (up.x - low.x), low.y + u[1] * (up.y - low.y), dimension == 2 ? 0.0 : low.z + u[2] * (up.z - low.z));
}

/// What contact asks of a piece: faces back to back, furthest corners, bounds, a distance less its margin.
static void check_pieces(const pls_shape *wall, double rounding)
{
    pls_random random = pls_random_stream(2, 0, PLS_FOR_USER);
    for (size_t k = 0; k < wall->part_count; ++k)
    {
        const pls_shape *s = wall->part[k].shape;
        const pls_polytope *p = s->polytope;
        assert_true(s->convex && s->margin == rounding && s->mass.volume == 0.0 && s->dimension == wall->dimension);
        assert_int_equal(p->vertex_count, wall->dimension);
        assert_int_equal(p->face_count, 2);
        assert_true(pls_length(pls_add(p->face_normal[0], p->face_normal[1])) == 0.0);
        for (uint32_t f = 0; f < 2; ++f)
        {
            const uint32_t *c = p->face_vertex + p->face_start[f];
            pls_vec3 along = pls_sub(p->vertex[c[1]], p->vertex[c[0]]);
            pls_vec3 n =
                wall->dimension == 3 ? pls_cross(along, pls_sub(p->vertex[c[2]], p->vertex[c[0]])) : pls_vec(along.y, -along.x, 0.0);
            assert_true(pls_length(pls_sub(pls_unit(n), p->face_normal[f])) < 1e-12);
        }
        for (uint32_t v = 0; v < p->vertex_count; ++v)
        {
            assert_true(fabs(pls_shape_sdf(s, p->vertex[v]) + rounding) < 1e-15 && pls_length(p->vertex[v]) + rounding <= s->radius);
            assert_int_equal(p->neighbour_start[v + 1] - p->neighbour_start[v], wall->dimension - 1);
            for (uint32_t j = p->neighbour_start[v]; j < p->neighbour_start[v + 1]; ++j) assert_true(p->neighbour[j] != v);
        }
        for (int j = 0; j < 5; ++j)
        {
            pls_vec3 n = pls_unit(random_point(&random, wall->dimension, pls_vec(-1, -1, -1), pls_vec(1, 1, 1)));
            double most = -INFINITY;
            for (uint32_t v = 0; v < p->vertex_count; ++v) most = fmax(most, pls_dot(p->vertex[v], n) + rounding);
            assert_true(fabs(pls_dot(pls_shape_support(s, n), n) - most) < 1e-15);
        }
    }
}

static void check_wall(const pls_shape *s)
{
    assert_true(s->ops->wall && !s->convex && s->mass.volume == 0.0 && isfinite(s->radius));
    assert_true(pls_length(s->moments) == 0.0 && pls_length(s->mass.centre) == 0.0 && s->principal.w == 1.0);
}

static void a_mesh_is_the_nearest_of_its_triangles(void **state)
{
    (void)state;
    static triangles t;
    write_hills("hills.obj", &t);
    for (int rounded = 0; rounded < 2; ++rounded)
    {
        const double values[2] = {rounded ? 0.05 : 0.0, 2.0};
        const pls_shape_input input = {VALUES(values), .path = "hills.obj"};
        pls_shape *s = NULL;
        if (make(&pls_mesh_shape, 3, &input, &s) != PLS_OK) fail_msg("%s", pls_last_message());
        check_wall(s);
        check_pieces(s, values[0]);
        assert_int_equal(s->part_count, t.count);
        pls_random random = pls_random_stream(1, 0, PLS_FOR_USER);
        double furthest = 0.0;
        for (size_t k = 0; k < t.count; ++k)
            for (int c = 0; c < 3; ++c) furthest = fmax(furthest, 2.0 * pls_length(t.corner[k][c]));
        assert_true(fabs(s->radius - furthest - values[0]) < 1e-12);
        for (int k = 0; k < 300; ++k)
        {
            pls_vec3 X = random_point(&random, 3, s->lower, s->upper), half = pls_scale(X, 0.5); // the file's coordinates count twice
            double least = INFINITY;
            for (size_t j = 0; j < t.count; ++j) least = fmin(least, 2.0 * to_triangle(t.corner[j], half));
            double phi = pls_shape_sdf(s, X);
            if (fabs(phi - (least - values[0])) > 1e-13) fail_msg("%g, oracle %g", phi, least - values[0]);
            pls_vec3 foot = pls_sub(X, pls_scale(pls_shape_gradient(s, X), phi));
            assert_true(fabs(pls_shape_sdf(s, foot)) < 1e-13);
        }
        pls_shape_free(s);
    }
}

static void triangles_near_a_point_are_few_and_all(void **state)
{
    (void)state;
    static triangles t;
    write_hills("hills.obj", &t);
    const double values[2] = {0.0, 1.0};
    const pls_shape_input input = {VALUES(values), .path = "hills.obj"};
    pls_shape *s = NULL;
    assert_int_equal(make(&pls_mesh_shape, 3, &input, &s), PLS_OK);
    pls_random random = pls_random_stream(3, 0, PLS_FOR_USER);
    for (int k = 0; k < 300; ++k)
    {
        uint32_t found[2 * SIDE * SIDE];
        pls_vec3 X = random_point(&random, 3, s->lower, s->upper);
        const double radius = 0.15;
        size_t count = pls_shape_parts_near(s, X, radius, found, 2 * SIDE * SIDE), next = 0, touching = 0;
        for (uint32_t p = 0; p < s->part_count; ++p)
        {
            bool listed = next < count && found[next] == p;
            next += listed;
            bool touches = pls_shape_sdf(s->part[p].shape, pls_sub(X, s->part[p].position)) < radius;
            touching += touches;
            if (touches) assert_true(listed);
        }
        assert_int_equal(next, count);
        assert_true(count <= 4 * touching + 20); // boxes of slanted triangles hold more than they do
    }
    pls_shape_free(s);
}

static void triangles_without_area_are_left_out(void **state)
{
    (void)state;
    static const char flat[] = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n",
                      both[] = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n";
    const double values[2] = {0.0, 1.0};
    pls_shape_input input = {VALUES(values), .path = "flat.obj"};
    pls_shape *s = NULL;
    assert_int_equal(pls_write_file("flat.obj", flat, strlen(flat)), PLS_OK);
    assert_int_equal(make(&pls_mesh_shape, 3, &input, &s), PLS_INVALID_ARGUMENT);
    assert_string_equal(pls_last_message(), "shape 'x': flat.obj: none of the 2 triangles has an area; save the mesh anew");
    assert_int_equal(pls_write_file("both.obj", both, strlen(both)), PLS_OK);
    input.path = "both.obj";
    assert_int_equal(make(&pls_mesh_shape, 3, &input, &s), PLS_OK);
    assert_int_equal(s->part_count, 1);
    pls_shape_free(s);
    input.path = NULL;
    assert_int_equal(make(&pls_mesh_shape, 3, &input, &s), PLS_INVALID_ARGUMENT);
    assert_int_equal(pls_memory_in_use(), 0);
}

// ---- 2D -----------------------------------------------------------------------------------------------------------------------------------------------------

static void a_polyline_is_the_nearest_of_its_segments(void **state)
{
    (void)state;
    enum { POINTS = 40 };
    pls_vec3 points[POINTS];
    for (int k = 0; k < POINTS; ++k)
    {
        double angle = 2.0 * M_PI * k / POINTS, r = 1.0 + 0.3 * sin(5.0 * angle);
        points[k] = pls_vec(3.0 + r * cos(angle), r * sin(angle), 0.0);
    }
    for (int closed = 0; closed < 2; ++closed)
    {
        const double values[2] = {closed ? 0.02 : 0.0, closed};
        const pls_shape_input input = {VALUES(values), .points = points, .point_count = POINTS};
        pls_shape *s = NULL;
        if (make(&pls_polyline_shape, 2, &input, &s) != PLS_OK) fail_msg("%s", pls_last_message());
        const int segments = closed ? POINTS : POINTS - 1;
        check_wall(s);
        check_pieces(s, values[0]);
        assert_int_equal(s->part_count, segments);
        pls_random random = pls_random_stream(1, 0, PLS_FOR_USER);
        for (int k = 0; k < 2000; ++k)
        {
            pls_vec3 X = random_point(&random, 2, s->lower, s->upper);
            double least = INFINITY;
            for (int j = 0; j < segments; ++j) least = fmin(least, to_segment(points[j], points[(j + 1) % POINTS], X));
            assert_true(fabs(pls_shape_sdf(s, X) - (least - values[0])) < 1e-14);
        }
        pls_shape_free(s);
    }
}

static void polylines_without_a_line_are_refused(void **state)
{
    (void)state;
    static const pls_vec3 points[3] = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    const double open[2] = {0.0, 0.0}, closed[2] = {0.0, 1.0}, half[2] = {0.0, 0.5};
    const struct
    {
        pls_shape_input input;
        const char *message;
    } wrong[] = {
        {{VALUES(open), .points = points, .point_count = 1}, "shape 'x': an open polyline needs at least 2 points, not 1"},
        {{VALUES(closed), .points = points, .point_count = 2}, "shape 'x': a closed polyline needs at least 3 points, not 2"},
        {{VALUES(half), .points = points, .point_count = 2}, "shape 'x': 'closed' of a polyline must be 0 or 1, not 0.5"},
        {{VALUES(open), .points = points, .point_count = 3},
         "shape 'x': points 2 and 3 of a polyline are the same, (1, 0) m; remove one of them"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k)
    {
        pls_shape *s = NULL;
        assert_int_equal(make(&pls_polyline_shape, 2, &wrong[k].input, &s), PLS_INVALID_ARGUMENT);
        assert_string_equal(pls_last_message(), wrong[k].message);
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

// ---- meshes as grains ---------------------------------------------------------------------------------------------------------------------------------------

#define CUBE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
static const char cube[] = CUBE "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
static const char box_without_lid[] = CUBE "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
/// The lid leads down to a point in the middle.
static const char dented[] =
    CUBE "v 0.5 0.5 0.8\nf 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 9\nf 6 7 9\nf 7 8 9\nf 8 5 9\n";

static pls_status make_grain(const char *content, double hull, pls_shape **shape)
{
    const double values[2] = {0.0, hull};
    const pls_shape_input input = {VALUES(values), .path = "grain.obj"};
    assert_int_equal(pls_write_file("grain.obj", content, strlen(content)), PLS_OK);
    return make(&pls_polyhedron_shape, 3, &input, shape);
}

static void only_convex_meshes_are_grains(void **state)
{
    (void)state;
    static const char what_else[] =
        "; take it as a wall of shape `mesh`, build the grain as a `compound` of convex pieces, or take the hull with  hull: 1";
    char expected[600];
    pls_shape *s = NULL;
    assert_int_equal(make_grain(cube, 0.0, &s), PLS_OK);
    assert_true(fabs(s->mass.volume - 1.0) < 1e-14);
    pls_shape_free(s);

    assert_int_equal(make_grain(dented, 0.0, &s), PLS_INVALID_ARGUMENT);
    // The fans of the five whole faces are triangles 1 to 10; half way from a corner to the dent the mesh is 0.1 below the lid, at the middle of the triangle 0.2 / 3.
    snprintf(expected, sizeof expected,
             "shape 'x': grain.obj: the mesh is not convex: triangle 11 lies 0.0666667 below the hull at (0.5, 0.166667, 0.933333)%s",
             what_else);
    assert_string_equal(pls_last_message(), expected);
    assert_int_equal(make_grain(dented, 1.0, &s), PLS_OK);
    assert_true(fabs(s->mass.volume - 1.0) < 1e-14); // the hull has no dent
    pls_shape_free(s);

    assert_int_equal(make_grain(box_without_lid, 0.0, &s), PLS_INVALID_ARGUMENT);
    snprintf(expected, sizeof expected, "shape 'x': grain.obj: the mesh is not closed: its triangles cover 83.33 %% of its hull%s",
             what_else);
    assert_string_equal(pls_last_message(), expected);
    assert_int_equal(make_grain(box_without_lid, 1.0, &s), PLS_OK);
    pls_shape_free(s);

    // The same files are walls as they are.
    const double values[2] = {0.0, 1.0};
    const pls_shape_input input = {VALUES(values), .path = "grain.obj"};
    assert_int_equal(make(&pls_mesh_shape, 3, &input, &s), PLS_OK);
    assert_int_equal(s->part_count, 10);
    pls_shape_free(s);
    const pls_shape_input nothing = {VALUES(values)};
    assert_int_equal(make(&pls_polyhedron_shape, 3, &nothing, &s), PLS_INVALID_ARGUMENT);
    assert_string_equal(pls_last_message(), "shape 'x': a polyhedron needs 'points', or the 'path' of a mesh file (.obj, .stl, .ply)");
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_is_the_nearest_of_its_triangles), cmocka_unit_test(triangles_near_a_point_are_few_and_all),
        cmocka_unit_test(triangles_without_area_are_left_out),    cmocka_unit_test(a_polyline_is_the_nearest_of_its_segments),
        cmocka_unit_test(polylines_without_a_line_are_refused),   cmocka_unit_test(only_convex_meshes_are_grains),
    };
    return cmocka_run_group_tests_name("walls", tests, NULL, NULL);
}
