// P1 eq. 14 by ADMM against a search over the surfaces, for all pairs of shapes; in gaps, and warm.

#include "contact/admm.h"

#include "base/random.h"
#include "shape/builtin.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { POSES = 4, DIRECTIONS = 250, HULL_POINTS = 20, AROUND = 12 };

typedef struct example
{
    const char *name;
    const pls_shape_ops *ops;
    int dimension;
    double values[6];
    int hull_points;
} example;

static const example examples[] = {
    {"sphere", &pls_sphere_shape, 3, {0.7}, 0},
    {"plane", &pls_plane_shape, 3, {0.0}, 0},
    {"box", &pls_box_shape, 3, {0.5, 0.7, 0.9, 0.0}, 0},
    {"rounded box", &pls_box_shape, 3, {0.5, 0.7, 0.9, 0.2}, 0},
    {"capsule", &pls_capsule_shape, 3, {0.4, 1.3}, 0},
    {"cylinder", &pls_cylinder_shape, 3, {0.6, 1.5, 0.0}, 0},
    {"ellipsoid", &pls_ellipsoid_shape, 3, {0.5, 0.7, 0.9}, 0},
    {"superquadric", &pls_superquadric_shape, 3, {0.6, 0.8, 0.9, 0.6, 0.7}, 0},
    {"polyhedron", &pls_polyhedron_shape, 3, {0.0}, HULL_POINTS},
    {"disc", &pls_sphere_shape, 2, {0.7}, 0},
    {"line", &pls_plane_shape, 2, {0.0}, 0},
    {"rectangle", &pls_box_shape, 2, {0.5, 0.7, 1.0, 0.0}, 0},
    {"stadium", &pls_capsule_shape, 2, {0.4, 1.3}, 0},
    {"ellipse", &pls_ellipsoid_shape, 2, {0.5, 0.9, 1.0}, 0},
    {"superellipse", &pls_superquadric_shape, 2, {0.6, 1.0, 1.0, 1.0, 0.6}, 0},
    {"polygon", &pls_polygon_shape, 2, {0.0}, 7},
};
enum { EXAMPLES = sizeof examples / sizeof *examples };

static pls_shape *shapes[EXAMPLES];

static int make_shapes(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        pls_vec3 points[HULL_POINTS];
        pls_random random = pls_random_stream(5, (uint32_t)e, PLS_FOR_USER);
        for (int k = 0; k < examples[e].hull_points; ++k)
        {
            double x = pls_random_normal(&random), y = pls_random_normal(&random), z = pls_random_normal(&random);
            points[k] = pls_scale(pls_unit(pls_vec(x, y, examples[e].dimension == 2 ? 0.0 : z)), 0.8);
        }
        const pls_shape_input input = {VALUES(examples[e].values), .points = points, .point_count = (size_t)examples[e].hull_points};
        if (pls_shape_make(examples[e].ops, examples[e].dimension, &input, examples[e].name, &shapes[e]) != PLS_OK) return -1;
    }
    return 0;
}

static int free_shapes(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e) pls_shape_free(shapes[e]);
    return 0;
}

// ---- poses ------------------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 random_vector(pls_random *random, int dimension)
{
    double x = pls_random_normal(random), y = pls_random_normal(random), z = pls_random_normal(random);
    return pls_vec(x, y, dimension == 2 ? 0.0 : z);
}

static pls_quat random_turn(pls_random *random, int dimension)
{
    double q[4];
    for (int k = 0; k < 4; ++k) q[k] = pls_random_normal(random);
    return pls_quat_unit(dimension == 2 ? (pls_quat){q[0], 0.0, 0.0, q[1]} : (pls_quat){q[0], q[1], q[2], q[3]});
}

static double size_of(const pls_posed *a, const pls_posed *b) { return fmin(a->size, b->size); }

/// Move B along a random line until the solver's delta is `part` of the size: just a choice of poses.
static void place(const pls_shape *sa, const pls_shape *sb, pls_random *random, double part, pls_posed *a, pls_posed *b)
{
    const int dimension = sa->dimension;
    pls_vec3 home = pls_vec(0.3, -0.2, dimension == 2 ? 0.0 : 0.1), e = pls_unit(random_vector(random, dimension));
    *a = pls_pose(sa, home, random_turn(random, dimension), 1.3);
    *b = pls_pose(sb, home, random_turn(random, dimension), 0.8);
    // Out of a half-space, along its normal; a random line may never leave it.
    if (sa->ops->unbounded) e = pls_posed_gradient(a, home);
    if (sb->ops->unbounded) e = pls_scale(pls_posed_gradient(b, home), -1.0);
    pls_vec3 start = b->position;
    double low = 0.0, high = 4.0;
    for (int k = 0; k < 16; ++k)
    {
        double middle = 0.5 * (low + high), state[PLS_ADMM_STATE] = {0.0};
        pls_overlap o;
        b->position = pls_add(start, pls_scale(e, middle));
        pls_admm_depth(a, b, 1e-3, state, &o);
        if (!o.converged || o.delta > part * size_of(a, b))
            low = middle;
        else
            high = middle;
    }
}

// ---- the slow solution ------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 foot(const pls_posed *p, pls_vec3 X) { return pls_sub(X, pls_scale(pls_posed_gradient(p, X), pls_posed_sdf(p, X))); }

/// The least SDF of `field` over the surface of `set`: many points, then the surroundings of the best at ever smaller distances. Points of the surface
/// are feet of others: of far ones in all directions, then of neighbours.
static double search(const pls_posed *set, const pls_posed *field, pls_vec3 *x)
{
    const bool bounded = isfinite(set->size);
    const int dimension = set->shape->dimension;
    const pls_vec3 middle = bounded ? pls_posed_world(set, set->shape->mass.centre) : pls_posed_world(field, field->shape->mass.centre);
    const double far = 2.0 * (bounded ? set->size : field->size);
    double best = INFINITY, step = dimension == 2 ? 2.0 * M_PI / DIRECTIONS : 4.0 / sqrt((double)DIRECTIONS);
    pls_random random = pls_random_stream(7, 0, PLS_FOR_USER);
    for (int k = 0; k < DIRECTIONS; ++k)
    {
        double z = dimension == 2 ? 0.0 : 1.0 - (2.0 * k + 1.0) / DIRECTIONS, angle = dimension == 2 ? step * k : 2.399963229728653 * k;
        pls_vec3 d = pls_vec(sqrt(1.0 - z * z) * cos(angle), sqrt(1.0 - z * z) * sin(angle), z),
                 p = foot(set, pls_add(middle, pls_scale(d, far)));
        double f = pls_posed_sdf(field, p);
        if (f < best) best = f, *x = p;
    }
    for (int failed = 0; step > 1e-9;)
    {
        bool better = false;
        for (int k = 0; k < AROUND; ++k)
        {
            pls_vec3 p = foot(set, pls_add(*x, pls_scale(pls_unit(random_vector(&random, dimension)), step)));
            double f = pls_posed_sdf(field, p);
            if (f < best) best = f, *x = p, better = true;
        }
        if (better)
            failed = 0;
        else if (++failed == 3)
            step *= 0.5, failed = 0;
    }
    return best;
}

// ---- tests --------------------------------------------------------------------------------------------------------------------------------------------------------

/// On both surfaces, normal and points as they should be, and no sampled point of either surface any deeper than the solution.
static void expect_solution(const char *name, const char *other, const pls_posed *a, const pls_posed *b, const pls_overlap *o,
                            double tolerance)
{
    const double size = size_of(a, b);
    pls_vec3 x1 = {0.0, 0.0, 0.0}, x2 = x1, left = pls_sub(pls_sub(o->on_a, o->on_b), pls_scale(o->normal, o->delta));
    double first = search(a, b, &x1), second = search(b, a, &x2);
    double more1 = pls_posed_sdf(b, o->on_a) - first, more2 = pls_posed_sdf(a, o->on_b) - second;
    double most1 = 2.0 * tolerance * (size + pls_length(pls_sub(o->on_a, x1))),
           most2 = 2.0 * tolerance * (size + pls_length(pls_sub(o->on_b, x2)));
    if (!o->converged) fail_msg("%s - %s: not converged at %g", name, other, o->delta);
    if (fabs(pls_posed_sdf(a, o->on_a)) > tolerance * size || fabs(pls_posed_sdf(b, o->on_b)) > tolerance * size)
        fail_msg("%s - %s: off the surfaces", name, other);
    assert_true(pls_length(left) < 1e-14 && fabs(pls_length(o->normal) - 1.0) < 1e-14);
    if (more1 > most1 || more2 > most2) fail_msg("%s - %s: %.3g and %.3g above the least, at %g", name, other, more1, more2, o->delta);
    // The search may stop short in a valley between kinks.
    if (tolerance < 1e-6 && fmin(more1, more2) < -1e-3 * size) fail_msg("%s - %s: search %.3g, %.3g off", name, other, more1, more2);
    if (o->delta > 0.0 ? pls_posed_sdf(b, o->on_a) > most1 : first < -most1)
        fail_msg("%s - %s: delta %g, the least %g", name, other, o->delta, first);
    // In a gap the solution is the distance, whose least is known from both sides.
    if (o->delta < 0.0) assert_true(fmin(first, second) + o->delta > -8.0 * tolerance * size && first + o->delta < 1e-3 * size);
}

static void all_pairs_against_a_search(void **state)
{
    (void)state;
    for (int i = 0; i < EXAMPLES; ++i)
        for (int j = i; j < EXAMPLES; ++j)
        {
            if (examples[i].dimension != examples[j].dimension || (shapes[i]->ops->unbounded && shapes[j]->ops->unbounded)) continue;
            pls_random random = pls_random_stream((uint64_t)(100 * i + j), 0, PLS_FOR_USER);
            for (int k = 0; k < POSES; ++k)
            {
                const double tolerance = k == 1 ? 1e-3 : 1e-9;
                double cold[PLS_ADMM_STATE] = {0.0};
                pls_posed a, b;
                pls_overlap o;
                place(shapes[i], shapes[j], &random, 0.05 * (k - 1.5), &a, &b);
                pls_admm_depth(&a, &b, tolerance, cold, &o);
                expect_solution(examples[i].name, examples[j].name, &a, &b, &o, tolerance);
            }
        }
}

static const pls_shape *named(const char *name)
{
    for (int e = 0; e < EXAMPLES; ++e)
        if (strcmp(examples[e].name, name) == 0) return shapes[e];
    fail_msg("no shape %s", name);
    return NULL;
}

/// Where both surfaces are smooth, eq. 14 is the penetration depth: the foot of either point is the other.
static void smooth_pairs_have_the_penetration_depth(void **state)
{
    (void)state;
    static const char *pairs[][2] = {
        {"sphere", "ellipsoid"}, {"ellipsoid", "ellipsoid"}, {"disc", "ellipse"}, {"ellipse", "ellipse"}, {"sphere", "sphere"}};
    for (int p = 0; p < 5; ++p)
    {
        pls_random random = pls_random_stream((uint64_t)p, 3, PLS_FOR_USER);
        for (int k = 0; k < 40; ++k)
        {
            pls_posed a, b;
            place(named(pairs[p][0]), named(pairs[p][1]), &random, -0.05 + 0.1 * k / 40, &a, &b);
            double cold[PLS_ADMM_STATE] = {0.0}, size = size_of(&a, &b);
            pls_overlap o, depth;
            pls_admm_depth(&a, &b, 1e-10, cold, &o);
            pls_smooth_depth(&a, &b, pls_unit(pls_sub(b.position, a.position)), &depth);
            assert_true(o.converged && depth.converged && fabs(o.delta - depth.delta) < 1e-9 * size);
            assert_true(pls_length(pls_sub(o.on_a, depth.on_a)) < 1e-8 * size && pls_length(pls_sub(o.on_b, depth.on_b)) < 1e-8 * size);
        }
    }
}

/// Corner of a square in the side of another, turned by 45 degrees, by hand: the corner is deepest at t; the side's deepest point is the foot of the
/// corner, as both of the corner's sides are equally far there, t sin 45.
static void a_corner_in_a_side(void **state)
{
    (void)state;
    const double half[6] = {0.5, 0.5, 0.5, 0.0}, t = 0.02;
    pls_shape *square = NULL;
    const pls_shape_input input = {VALUES(half)};
    assert_int_equal(pls_shape_make(&pls_box_shape, 2, &input, "square", &square), PLS_OK);
    const double eighth = M_PI / 8.0;
    pls_posed a = pls_pose(square, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0);
    pls_posed b = pls_pose(square, pls_vec(0.1, 0.5 + sqrt(0.5) - t, 0.0), (pls_quat){cos(eighth), 0.0, 0.0, sin(eighth)}, 1.0);
    double state_of[PLS_ADMM_STATE] = {0.0};
    pls_overlap o;
    pls_admm_depth(&a, &b, 1e-12, state_of, &o);
    assert_true(o.converged && fabs(o.delta - t) < 1e-11);
    assert_true(pls_length(pls_sub(o.on_b, pls_vec(0.1, 0.5 - t, 0.0))) < 1e-11 &&
                pls_length(pls_sub(o.on_a, pls_vec(0.1, 0.5, 0.0))) < 1e-11);
    pls_shape_free(square);
}

/// Flush faces: any point of the common patch solves eq. 14, and the pair found has the depth between them. The same for a box on a plane, and while sliding.
static void parallel_faces_give_opposite_points(void **state)
{
    (void)state;
    const pls_shape *box = named("box"), *plane = named("plane");
    double sliding[PLS_ADMM_STATE] = {0.0}, on_plane[PLS_ADMM_STATE] = {0.0};
    for (int k = 0; k < 20; ++k)
    {
        pls_posed a = pls_pose(box, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0), b = a, floor = a;
        b.position = pls_vec(0.3 + 0.01 * k, -0.4, 1.79);
        floor = pls_pose(plane, pls_vec(0.0, 0.0, -0.89), pls_quat_identity(), 1.0);
        pls_overlap o;
        pls_admm_depth(&a, &b, 1e-8, sliding, &o);
        assert_true(o.converged && fabs(o.delta - 0.01) < 1e-12 && pls_length(pls_sub(o.normal, pls_vec(0.0, 0.0, 1.0))) < 1e-12);
        pls_admm_depth(&floor, &a, 1e-8, on_plane, &o);
        assert_true(o.converged && fabs(o.delta + 0.01 - 0.02) < 1e-12 && o.normal.z > 1.0 - 1e-12);
        a.position.x += 0.01;
    }
}

/// Bodies that turn and slide by: warm is what cold is, in fewer iterations.
static void warm_along_a_path(void **state)
{
    (void)state;
    static const char *pairs[][2] = {{"ellipsoid", "box"}, {"polyhedron", "cylinder"}, {"sphere", "superquadric"}, {"polygon", "ellipse"}};
    for (int p = 0; p < 4; ++p)
    {
        pls_random random = pls_random_stream((uint64_t)p, 4, PLS_FOR_USER);
        pls_posed a, b;
        place(named(pairs[p][0]), named(pairs[p][1]), &random, 0.03, &a, &b);
        const int dimension = a.shape->dimension;
        const double tolerance = p == 2 ? 1e-9 : 1e-10; // a superquadric's gradients have errors of about 1e-9
        const pls_vec3 along = pls_scale(pls_unit(pls_cross(pls_sub(b.position, a.position), pls_vec(0.1, 0.2, 1.0))), 2e-4);
        const pls_quat turn = pls_quat_unit((pls_quat){1.0, dimension == 2 ? 0.0 : 1e-4, dimension == 2 ? 0.0 : -5e-5, 2e-4});
        double warm[PLS_ADMM_STATE] = {0.0};
        int iterations[2] = {0, 0};
        for (int k = 0; k < 60; ++k)
        {
            double cold[PLS_ADMM_STATE] = {0.0};
            pls_overlap w, c;
            pls_admm_depth(&a, &b, tolerance, warm, &w);
            pls_admm_depth(&a, &b, tolerance, cold, &c);
            // phi to the tolerance is a point to its square root, where the least is a smooth one.
            assert_true(w.converged && c.converged && fabs(pls_posed_sdf(&b, w.on_a) - pls_posed_sdf(&b, c.on_a)) < 4.0 * tolerance);
            assert_true(fabs(pls_posed_sdf(&a, w.on_b) - pls_posed_sdf(&a, c.on_b)) < 4.0 * tolerance);
            assert_true(pls_length(pls_sub(w.on_a, c.on_a)) < sqrt(tolerance) && fabs(w.delta - c.delta) < sqrt(tolerance));
            iterations[0] += c.iterations, iterations[1] += w.iterations;
            b.position = pls_add(b.position, along);
            b.x = pls_rotate(turn, b.x), b.y = pls_rotate(turn, b.y), b.z = pls_rotate(turn, b.z);
        }
        if (!(iterations[1] < iterations[0])) fail_msg("%s - %s: warm %d, cold %d", pairs[p][0], pairs[p][1], iterations[1], iterations[0]);
    }
}

/// A disc dips into a piece of a wall: depth is measured to the disc's surface.
static void pieces_of_walls(void **state)
{
    (void)state;
    const pls_vec3 ends[2] = {{-1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}};
    const pls_shape_input input = {.points = ends, .point_count = 2};
    pls_shape *wall = NULL;
    if (pls_shape_make(&pls_polyline_shape, 2, &input, "wall", &wall) != PLS_OK) fail_msg("%s", pls_last_message());
    assert_int_equal(wall->part_count, 1);
    pls_posed piece = pls_pose(wall->part[0].shape, wall->part[0].position, wall->part[0].orientation, 1.0);
    for (int k = 0; k < 20; ++k)
    {
        const double depth = 0.031 - 0.003 * k;
        pls_posed disc = pls_pose(named("disc"), pls_vec(0.2 + 0.05 * k, 0.7 - depth, 0.0), pls_quat_identity(), 1.0);
        double cold[PLS_ADMM_STATE] = {0.0};
        pls_overlap o;
        pls_admm_depth(&disc, &piece, 1e-10, cold, &o);
        assert_true(o.converged && fabs(o.delta - depth) < 1e-10 && fabs(o.normal.y + 1.0) < 1e-6);
        pls_admm_depth(&piece, &disc, 1e-10, cold, &o); // a state of something else is a poor start, no more
        assert_true(o.converged && fabs(o.delta - depth) < 1e-10 && fabs(o.normal.y - 1.0) < 1e-6);
    }
    pls_shape_free(wall);
}

static void says_when_there_is_no_solution(void **state)
{
    (void)state;
    // A ball that holds the centre of a smaller one: no least of the small one's SDF on the large one's surface is that of eq. 14.
    const pls_shape *ball = named("sphere");
    pls_posed a = pls_pose(ball, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0),
              b = pls_pose(ball, pls_vec(0.3, 0.0, 0.0), pls_quat_identity(), 0.3);
    double first[PLS_ADMM_STATE] = {0.0}, second[PLS_ADMM_STATE] = {0.0};
    pls_overlap o;
    pls_admm_depth(&a, &b, 1e-8, first, &o);
    assert_false(o.converged);
    // Less than round-off.
    a = pls_pose(named("ellipsoid"), pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0);
    b = pls_pose(named("superquadric"), pls_vec(1.0, 0.3, 0.2), pls_quat_identity(), 1.0);
    pls_admm_depth(&a, &b, 1e-17, second, &o);
    assert_true(!o.converged && o.iterations == PLS_ADMM_MOST);
    pls_admm_depth(&a, &b, 1e-6, second, &o); // what was reached is kept
    assert_true(o.converged && o.iterations == 1);
}

/// The deepest points are corners, far along the faces from where the search for them starts.
static void nearly_parallel_faces(void **state)
{
    (void)state;
    const pls_shape *box = named("box");
    for (int k = 1; k <= 6; ++k)
    {
        const double tilt = pow(10.0, -k);
        pls_posed a = pls_pose(box, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0);
        pls_posed b = pls_pose(box, pls_vec(0.1, 0.2, 1.79 + 0.5 * tilt), pls_quat_unit((pls_quat){1.0, 0.4 * tilt, 0.3 * tilt, 0.0}), 1.0);
        double cold[PLS_ADMM_STATE] = {0.0};
        pls_overlap o;
        pls_admm_depth(&a, &b, 1e-9, cold, &o);
        expect_solution("box", "tilted box", &a, &b, &o, 1e-9);
        assert_true(o.iterations < 150 + 60 * k);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_pairs_against_a_search),
        cmocka_unit_test(smooth_pairs_have_the_penetration_depth),
        cmocka_unit_test(a_corner_in_a_side),
        cmocka_unit_test(parallel_faces_give_opposite_points),
        cmocka_unit_test(pieces_of_walls),
        cmocka_unit_test(warm_along_a_path),
        cmocka_unit_test(nearly_parallel_faces),
        cmocka_unit_test(says_when_there_is_no_solution),
    };
    return cmocka_run_group_tests_name("admm", tests, make_shapes, free_shapes);
}
