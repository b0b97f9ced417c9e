// P1 eq. 14 by ADMM against a search over the surfaces, for all pairs of shapes; in gaps, and warm.

#include "contact/admm.h"

#include "base/random.h"
#include "shape/builtin.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { POSES = 8, DIRECTIONS = 1500, HULL_POINTS = 20, AROUND = 20 };

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
        const pls_shape_input input = {.values = examples[e].values, .points = points, .point_count = (size_t)examples[e].hull_points};
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
    for (int k = 0; k < 30; ++k)
    {
        double middle = 0.5 * (low + high), state[PLS_ADMM_STATE] = {0.0};
        pls_overlap o;
        b->position = pls_add(start, pls_scale(e, middle));
        pls_admm_depth(a, b, 1e-4, state, &o);
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
        pls_vec3 d = pls_vec(sqrt(1.0 - z * z) * cos(angle), sqrt(1.0 - z * z) * sin(angle), z), p = foot(set, pls_add(middle, pls_scale(d, far)));
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
static void expect_solution(const char *names[2], const pls_posed *a, const pls_posed *b, const pls_overlap *o, double error)
{
    const double size = size_of(a, b);
    pls_vec3 x1 = {0.0, 0.0, 0.0}, x2 = x1, left = pls_sub(pls_sub(o->on_a, o->on_b), pls_scale(o->normal, o->delta));
    double first = search(a, b, &x1), second = search(b, a, &x2);
    double more1 = pls_posed_sdf(b, o->on_a) - first, more2 = pls_posed_sdf(a, o->on_b) - second;
    if (!o->converged) {print_message("%s - %s: not converged, delta %g\n", names[0], names[1], o->delta);return;}
    if (fabs(pls_posed_sdf(a, o->on_a)) > error * size || fabs(pls_posed_sdf(b, o->on_b)) > error * size)
        fail_msg("%s - %s: off the surfaces", names[0], names[1]);
    assert_true(pls_length(left) < 1e-14 && fabs(pls_length(o->normal) - 1.0) < 1e-14);
    if (more1 > error * size || more2 > error * size)
        print_message("%s - %s: %.3g and %.3g above the search, delta %g\n", names[0], names[1], more1, more2, o->delta);
    // The search may stop short of a valley between kinks.
    if (more1 < -1e-4 * size || more2 < -1e-4 * size) print_message("%s - %s: search off by %.3g, %.3g\n", names[0], names[1], more1, more2);
    assert_true((o->delta > 0.0) == (first < 0.0) || fabs(first) < error * size);
    if (o->delta < 0.0 && fabs(o->delta + first) > 1e-4 * size) fail_msg("%s - %s: gap of %g, is %g", names[0], names[1], o->delta, first);
}

static void all_pairs_against_a_search(void **state)
{
    (void)state;
    for (int i = 0; i < EXAMPLES; ++i)
        for (int j = i; j < EXAMPLES; ++j)
        {
            if (examples[i].dimension != examples[j].dimension || (shapes[i]->ops->unbounded && shapes[j]->ops->unbounded)) continue;
            pls_random random = pls_random_stream((uint64_t)(100 * i + j), 0, PLS_FOR_USER);
            const char *names[2] = {examples[i].name, examples[j].name};
            for (int k = 0; k < POSES; ++k)
            {
                pls_posed a, b;
                place(shapes[i], shapes[j], &random, -0.05 + 0.1 * (k + 0.5) / POSES, &a, &b);
                double cold[PLS_ADMM_STATE] = {0.0};
                pls_overlap o;
                pls_admm_depth(&a, &b, 1e-9, cold, &o);
                expect_solution(names, &a, &b, &o, 1e-7);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_pairs_against_a_search),
    };
    return cmocka_run_group_tests_name("admm", tests, make_shapes, free_shapes);
}
