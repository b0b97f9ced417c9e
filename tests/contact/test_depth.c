// Penetration depth by Newton's method, by BFGS and on shapes pushed apart, against a search over directions.

#include "contact/sdf_depth.h"
#include "contact/smooth_depth.h"

#include "base/random.h"
#include "shape/builtin.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { PAIRS = 300, DIRECTIONS = 4000 };

static double overlap_along(const pls_posed *a, const pls_posed *b, pls_vec3 n)
{
    return pls_dot(n, pls_sub(pls_posed_support(a, n), pls_posed_support(b, pls_scale(n, -1.0))));
}

/// The least overlap over all directions: many of them, then the neighbourhood of the best in ever smaller rings.
static double search(const pls_posed *a, const pls_posed *b, pls_vec3 *normal)
{
    const int dimension = a->shape->dimension;
    double best = INFINITY, step = dimension == 2 ? 2.0 * M_PI / DIRECTIONS : 4.0 / sqrt((double)DIRECTIONS);
    for (int k = 0; k < DIRECTIONS; ++k)
    {
        double z = dimension == 2 ? 0.0 : 1.0 - (2.0 * k + 1.0) / DIRECTIONS, angle = dimension == 2 ? step * k : 2.399963229728653 * k;
        pls_vec3 n = pls_vec(sqrt(1.0 - z * z) * cos(angle), sqrt(1.0 - z * z) * sin(angle), z);
        double f = overlap_along(a, b, n);
        if (f < best) best = f, *normal = n;
    }
    while (step > 1e-9)
    {
        bool better = false;
        pls_vec3 centre = *normal, off = fabs(centre.z) < 0.7 ? pls_vec(0.0, 0.0, 1.0) : pls_vec(1.0, 0.0, 0.0);
        pls_vec3 u = pls_unit(pls_cross(off, centre)), v = pls_cross(centre, u);
        for (int k = 0; k < 12; ++k)
        {
            double c = cos(M_PI / 6 * k), s = dimension == 2 ? 0.0 : sin(M_PI / 6 * k);
            pls_vec3 n = pls_unit(pls_add(centre, pls_scale(pls_add(pls_scale(u, c), pls_scale(v, s)), step)));
            double f = overlap_along(a, b, n);
            if (f < best) best = f, *normal = n, better = true;
        }
        if (!better) step *= 0.5;
    }
    return best;
}

static pls_vec3 random_vector(pls_random *random, int dimension)
{
    double x = pls_random_normal(random), y = pls_random_normal(random), z = pls_random_normal(random);
    return pls_vec(x, y, dimension == 2 ? 0.0 : z);
}

static pls_quat random_turn(pls_random *random, int dimension)
{
    if (dimension == 2)
    {
        double half = M_PI * pls_random_uniform(random);
        return (pls_quat){cos(half), 0.0, 0.0, sin(half)};
    }
    double q[4];
    for (int k = 0; k < 4; ++k) q[k] = pls_random_normal(random);
    return pls_quat_unit((pls_quat){q[0], q[1], q[2], q[3]});
}

/// B turned at random and moved along a random line until it overlaps A by `part` of the size, along that line.
static void place(const pls_shape *sa, const pls_shape *sb, pls_random *random, double part, pls_posed *a, pls_posed *b)
{
    pls_vec3 e = pls_unit(random_vector(random, sa->dimension));
    *a = pls_pose(sa, pls_vec(0.3, -0.2, sa->dimension == 2 ? 0.0 : 0.1), random_turn(random, sa->dimension), 1.3);
    *b = pls_pose(sb, pls_vec(0.3, -0.2, sa->dimension == 2 ? 0.0 : 0.1), random_turn(random, sa->dimension), 0.8);
    pls_vec3 normal;
    double low = 0.0, high = 2.0 * (a->size + b->size); // of the way at which they come to that overlap
    pls_vec3 home = b->position;
    for (int k = 0; k < 40; ++k)
    {
        double middle = 0.5 * (low + high);
        b->position = pls_add(home, pls_scale(e, middle));
        pls_overlap o;
        pls_smooth_depth(a, b, e, &o);
        normal = o.normal;
        if (o.delta > part * fmin(a->size, b->size))
            low = middle;
        else
            high = middle;
    }
    (void)normal;
}

static void expect_points(const pls_posed *a, const pls_posed *b, const pls_overlap *o, double error)
{
    double size = fmin(a->size, b->size);
    assert_true(fabs(pls_posed_sdf(a, o->on_a)) < error * size && fabs(pls_posed_sdf(b, o->on_b)) < error * size);
    pls_vec3 left = pls_sub(pls_sub(o->on_a, o->on_b), pls_scale(o->normal, o->delta));
    assert_true(pls_length(left) < error * size);
}

typedef struct counts
{
    int newton, bfgs, pushed; ///< that did not converge
    double worst[3];          ///< error of the depth, of the size
} counts;

static counts compare(const pls_shape *sa, const pls_shape *sb, uint64_t seed, bool bfgs)
{
    pls_random random = pls_random_stream(seed, 0, PLS_FOR_USER);
    counts c = {0};
    for (int k = 0; k < PAIRS; ++k)
    {
        pls_posed a, b;
        place(sa, sb, &random, -0.05 + 0.1 * k / PAIRS, &a, &b);
        pls_vec3 normal = {0}, line = pls_unit(pls_sub(b.position, a.position));
        double known = search(&a, &b, &normal), size = fmin(a.size, b.size);
        pls_overlap o;
        pls_smooth_depth(&a, &b, line, &o);
        c.newton += !o.converged;
        c.worst[0] = fmax(c.worst[0], fabs(o.delta - known) / size);
        expect_points(&a, &b, &o, 1e-7);
        assert_true(pls_length(pls_sub(o.normal, normal)) < 1e-4);
        pls_overlap p;
        pls_sdf_state fresh = {{0}, {0}};
        pls_sdf_depth_pushed(&a, &b, line, 0.0, pls_scale(pls_add(o.on_a, o.on_b), 0.5), &fresh, &p);
        c.pushed += !p.converged;
        expect_points(&a, &b, &p, 1e-7);
        c.worst[2] = fmax(c.worst[2], fabs(p.delta - known) / size);
        if (!bfgs) continue;
        pls_sdf_state state = {{0}, {0}};
        pls_sdf_depth_bfgs(&a, &b, pls_scale(pls_add(o.on_a, o.on_b), 0.5), &state, 60, &p);
        c.bfgs += !p.converged;
        if (p.converged) c.worst[1] = fmax(c.worst[1], fabs(p.delta - known) / size);
    }
    return c;
}

static pls_shape *make(const pls_shape_ops *ops, int dimension, const double *values, size_t count)
{
    pls_shape *shape = NULL;
    const pls_shape_input input = {.values = values, .value_count = count};
    assert_int_equal(pls_shape_make(ops, dimension, &input, "a shape", &shape), PLS_OK);
    return shape;
}

static void spheres_in_closed_form(void **state)
{
    (void)state;
    const double one = 1.0, other = 0.4;
    pls_shape *a = make(&pls_sphere_shape, 3, &one, 1), *b = make(&pls_sphere_shape, 3, &other, 1);
    pls_posed pa = pls_pose(a, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0);
    for (int k = 1; k < 30; ++k)
    {
        pls_vec3 at = pls_vec(0.05 * k, 0.03 * k, -0.02 * k), turned = pls_unit(pls_vec(1.0, 2.0, 3.0));
        pls_posed pb = pls_pose(b, at, pls_quat_identity(), 1.0);
        pls_overlap o;
        pls_smooth_depth(&pa, &pb, turned, &o);
        assert_true(o.converged && fabs(o.delta - (1.4 - pls_length(at))) < 1e-12);
        assert_true(pls_length(pls_sub(o.normal, pls_unit(at))) < 1e-9);
    }
    pls_shape_free(a);
    pls_shape_free(b);
}

static void ellipsoids_against_a_search(void **state)
{
    (void)state;
    const double first[4] = {1.0, 0.7, 0.5}, second[4] = {0.6, 1.1, 0.8}, radius = 0.7;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape *a = make(&pls_ellipsoid_shape, dimension, COUNTED(first)), *b = make(&pls_ellipsoid_shape, dimension, COUNTED(second)),
                  *c = make(&pls_sphere_shape, dimension, &radius, 1);
        const pls_shape *pair[3][2] = {{a, b}, {a, c}, {c, b}};
        for (int k = 0; k < 3; ++k)
        {
            counts n = compare(pair[k][0], pair[k][1], (uint64_t)(10 * dimension + k), true);
            assert_int_equal(n.newton, 0);
            assert_int_equal(n.bfgs, 0);
            assert_int_equal(n.pushed, 0);
            assert_true(n.worst[0] < 1e-9 && n.worst[1] < 1e-7 && n.worst[2] < 1e-9);
        }
        pls_shape_free(a);
        pls_shape_free(b);
        pls_shape_free(c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_in_closed_form),
        cmocka_unit_test(ellipsoids_against_a_search),
    };
    return cmocka_run_group_tests_name("depth", tests, NULL, NULL);
}
