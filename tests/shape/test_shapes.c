// The built-in shapes against slow oracles: distances to surface points, differences, maxima over the surface, and what follows from the SDF alone.

#include "shape/builtin.h"
#include "shape/mass_quadrature.h"

#include "base/random.h"
#include "support/numbers.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

typedef struct example
{
    const pls_shape_ops *ops;
    int dimension;
    double values[6];
    const char *name;
} example;

static const example examples[] = {
    {&pls_box_shape, 3, {0.5, 0.7, 1.1, 0.0}, "box"},
    {&pls_box_shape, 3, {0.5, 0.7, 1.1, 0.2}, "rounded box"},
    {&pls_box_shape, 3, {2e-3, 5e-4, 8e-4, 2e-4}, "small box"},
    {&pls_box_shape, 2, {0.5, 0.7, 1.0, 0.0}, "rectangle"},
    {&pls_box_shape, 2, {1.5, 0.7, 1.0, 0.3}, "rounded rectangle"},
    {&pls_capsule_shape, 3, {0.4, 1.3}, "capsule"},
    {&pls_capsule_shape, 3, {4.0, 0.5}, "thick capsule"},
    {&pls_capsule_shape, 2, {0.4, 1.3}, "stadium"},
    {&pls_cylinder_shape, 3, {0.6, 1.5, 0.0}, "cylinder"},
    {&pls_cylinder_shape, 3, {0.9, 0.8, 0.25}, "rounded cylinder"},
    {&pls_ellipsoid_shape, 3, {0.5, 0.8, 1.3}, "ellipsoid"},
    {&pls_ellipsoid_shape, 3, {1.0, 1.0, 0.3}, "oblate"},
    {&pls_ellipsoid_shape, 3, {1e-3, 1e-3, 1e-3}, "ball"},
    {&pls_ellipsoid_shape, 2, {0.5, 1.7, 1.0}, "ellipse"},
    {&pls_superquadric_shape, 3, {0.6, 0.8, 1.0, 1.0, 1.0}, "superquadric 1 1"},
    {&pls_superquadric_shape, 3, {0.6, 0.8, 1.0, 0.5, 0.7}, "superquadric 0.5 0.7"},
    {&pls_superquadric_shape, 3, {0.8, 0.7, 0.6, 1.4, 0.6}, "superquadric 1.4 0.6"},
    {&pls_superquadric_shape, 3, {0.8, 0.8, 0.8, 0.1, 0.1}, "superquadric 0.1 0.1"},
    {&pls_superquadric_shape, 3, {0.8, 1.0, 0.6, 1.9, 1.9}, "superquadric 1.9 1.9"},
    {&pls_superquadric_shape, 3, {0.8, 1.0, 0.6, 0.1, 1.9}, "superquadric 0.1 1.9"},
    {&pls_superquadric_shape, 2, {0.6, 1.0, 1.0, 1.0, 0.4}, "superellipse 0.4"},
    {&pls_superquadric_shape, 2, {0.6, 1.0, 1.0, 1.0, 1.7}, "superellipse 1.7"},
};
enum { EXAMPLES = sizeof examples / sizeof *examples, SIDE = 48 };

static pls_shape *make_with(const pls_shape_ops *ops, const example *e)
{
    pls_shape *shape = NULL;
    pls_shape_input input = {VALUES(e->values)};
    if (pls_shape_make(ops, e->dimension, &input, e->name, &shape) != PLS_OK) fail_msg("%s: %s", e->name, pls_last_message());
    return shape;
}

static pls_shape *make(const example *e) { return make_with(e->ops, e); }

static pls_vec3 random_point(const pls_shape *shape, pls_random *random, double size)
{
    double u[3];
    for (int a = 0; a < 3; ++a) u[a] = 2.0 * size * (pls_random_uniform(random) - 0.5);
    return pls_vec(u[0], u[1], shape->dimension == 2 ? 0.0 : u[2]);
}

/// |x|_p of two non-negative numbers.
static double norm(double x, double y, double p)
{
    double most = fmax(x, y);
    return most > 0.0 ? most * pow(pow(x / most, p) + pow(y / most, p), 1.0 / p) : 0.0;
}

/// By the formula of the shape where there is one, independent of its SDF: below 1 inside.
static double gauge(const pls_shape *shape, pls_vec3 X)
{
    const double *v = shape->values, x = fabs(X.x) / v[0], y = fabs(X.y) / v[1], z = shape->dimension == 2 ? 0.0 : fabs(X.z) / v[2];
    if (shape->ops->gradient == pls_ellipsoid_shape.gradient) return sqrt(x * x + y * y + z * z);
    return norm(norm(x, y, 2.0 / v[4]), z, 2.0 / v[3]);
}

/// The surface on the ray through e; all shapes here hold the origin.
static pls_vec3 on_surface(const pls_shape *shape, pls_vec3 e)
{
    double lower = 0.0, upper = 2.0 * shape->radius;
    if (shape->ops->smooth) return pls_scale(e, 1.0 / gauge(shape, e));
    e = pls_unit(e);
    for (int k = 0; k < 60; ++k)
    {
        double middle = 0.5 * (lower + upper);
        if (pls_shape_sdf(shape, pls_scale(e, middle)) < 0.0)
            lower = middle;
        else
            upper = middle;
    }
    return pls_scale(e, lower);
}

typedef double (*wanted)(pls_vec3 x, pls_vec3 given);
static double distance(pls_vec3 x, pls_vec3 X) { return pls_length(pls_sub(x, X)); }
static double behind(pls_vec3 x, pls_vec3 n) { return -pls_dot(x, n); }

/// Ways to go from x: along the axes and between them (edges of boxes), around z (rims), and a few at random.
static pls_vec3 way_from(const pls_shape *shape, pls_vec3 x, int d, pls_random *random)
{
    pls_vec3 way = pls_vec(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1);
    if (d == 27 || d == 28) way = pls_scale(pls_vec(-x.y, x.x, 0.0), (d == 27 ? 1.0 : -1.0) / shape->radius);
    if (d == 29 || d == 30) way = pls_scale(pls_vec(shape->upper.x, d == 29 ? shape->upper.y : -shape->upper.y, 0.0), 1.0 / shape->radius);
    if (d > 30) way = random_point(shape, random, 1.0);
    if (shape->dimension == 2) way.z = 0.0;
    return way;
}

/// The least over the surface: the best few of a grid of directions, each refined by trying all around, over ever smaller ways.
static double least_on_surface(const pls_shape *shape, wanted f, pls_vec3 given)
{
    enum { FEW = 4, WAYS = 40 };
    const int rows = shape->dimension == 2 ? 1 : SIDE, columns = shape->dimension == 2 ? 16 * SIDE : 2 * SIDE;
    double best[FEW], least = INFINITY;
    pls_vec3 at[FEW] = {{0.0, 0.0, 0.0}};
    pls_random random = pls_random_stream(3, 0, PLS_FOR_USER);
    for (int k = 0; k < FEW; ++k) best[k] = INFINITY;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c)
        {
            double longitude = 2.0 * M_PI * (c + 0.3) / columns, latitude = M_PI * ((r + 0.5) / rows - 0.5), side = cos(latitude);
            pls_vec3 x =
                on_surface(shape, pls_vec(side * cos(longitude), side * sin(longitude), shape->dimension == 2 ? 0.0 : sin(latitude)));
            double value = f(x, given);
            int k = FEW;
            for (; k > 0 && value < best[k - 1]; --k)
                if (k < FEW) best[k] = best[k - 1], at[k] = at[k - 1];
            if (k < FEW) best[k] = value, at[k] = x;
        }
    for (int k = 0; k < FEW; ++k)
    {
        for (double length = 0.1 * shape->radius; length > 1e-9 * shape->radius;)
        {
            bool moved = false;
            for (int d = 0; d < WAYS; ++d)
            {
                pls_vec3 x = on_surface(shape, pls_add(at[k], pls_scale(way_from(shape, at[k], d, &random), length)));
                double value = f(x, given);
                if (value < best[k]) best[k] = value, at[k] = x, moved = true;
            }
            if (!moved) length *= 0.5;
        }
        least = fmin(least, best[k]);
    }
    return least;
}

static void sdf_against_surface(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        pls_shape *shape = make(&examples[e]);
        pls_random random = pls_random_stream(7, 0, PLS_FOR_USER);
        for (int k = 0; k < 16; ++k)
        {
            pls_vec3 X = random_point(shape, &random, (k & 1 ? 1.6 : 0.5) * shape->radius);
            if (k > 11) X.x = 0.0; // planes of symmetry
            if (k > 13) X.y = 0.0;
            double phi = pls_shape_sdf(shape, X), known = least_on_surface(shape, distance, X);
            if (shape->ops->smooth ? gauge(shape, X) < 1.0 : phi < 0.0) known = -known;
            if (fabs(phi - known) > 2e-7 * shape->radius)
                fail_msg("%s: sdf %.15g, oracle %.15g at (%g, %g, %g)", examples[e].name, phi, known, X.x, X.y, X.z);
        }
        pls_shape_free(shape);
    }
}

static void gradient_against_differences(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        pls_shape_ops bare = *examples[e].ops;
        bare.gradient = NULL;
        pls_shape *shape = make(&examples[e]), twin = *shape;
        twin.ops = &bare;
        pls_random random = pls_random_stream(8, 0, PLS_FOR_USER);
        int kinks = 0;
        for (int k = 0; k < 300; ++k)
        {
            pls_vec3 X = random_point(shape, &random, 1.3 * shape->radius), g = pls_shape_gradient(shape, X);
            double error = pls_length(pls_sub(g, pls_shape_gradient(&twin, X)));
            assert_true(fabs(pls_length(g) - 1.0) < 1e-12);
            if (pls_shape_sdf(shape, X) > 0.02 * shape->size && error > 1e-3)
                fail_msg("%s: gradient off by %g at (%g, %g, %g)", examples[e].name, error, X.x, X.y, X.z);
            kinks += error > 1e-5; // of the medial axis, or close to edges
        }
        if (kinks > 6) fail_msg("%s: %d gradients of 300 are not the differences of the sdf", examples[e].name, kinks);
        pls_shape_free(shape);
    }
}

static pls_shape_ops only_sdf(const pls_shape_ops *ops)
{
    return (pls_shape_ops){.api_version = ops->api_version,
                           .name = ops->name,
                           .parameters = ops->parameters,
                           .in_2d = ops->in_2d,
                           .in_3d = ops->in_3d,
                           .convex = ops->convex,
                           .prepare = ops->prepare,
                           .release = ops->release,
                           .sdf = ops->sdf,
                           .mass_properties = ops->mass_properties}; // the quadrature has a test of its own
}

static void support_against_surface(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        pls_shape_ops bare = only_sdf(examples[e].ops);
        pls_shape *shape = make(&examples[e]), *twin = make_with(&bare, &examples[e]);
        pls_random random = pls_random_stream(9, 0, PLS_FOR_USER);
        double off = 0.0;
        for (int k = 0; k < 12; ++k)
        {
            pls_vec3 n = pls_unit(random_point(shape, &random, 1.0)), s = pls_shape_support(shape, n);
            double h = pls_dot(s, n), known = -least_on_surface(shape, behind, n);
            if (fabs(pls_shape_sdf(shape, s)) > 1e-10 * shape->radius)
                fail_msg("%s: support point %.3g off the surface", examples[e].name, pls_shape_sdf(shape, s));
            if (fabs(h - known) > 2e-7 * shape->radius) fail_msg("%s: support %.12g, oracle %.12g", examples[e].name, h, known);
            off = fmax(off, fabs(h - pls_dot(pls_shape_support(twin, n), n)) / shape->radius);
        }
        if (off > 1e-7) fail_msg("%s: support from the SDF alone is off by %g of the radius", examples[e].name, off);
        assert_true(pls_length(pls_sub(shape->upper, twin->upper)) < 1e-6 * shape->radius);
        assert_true(pls_length(pls_sub(shape->lower, twin->lower)) < 1e-6 * shape->radius);
        if (fabs(shape->radius - twin->radius) > 1e-6 * shape->radius)
            fail_msg("%s: radius %.12g, from the SDF alone %.12g", examples[e].name, shape->radius, twin->radius);
        pls_shape_free(twin);
        pls_shape_free(shape);
    }
}

static void support_gradient_against_differences(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        if (!examples[e].ops->support_gradient) continue;
        pls_shape *shape = make(&examples[e]);
        pls_random random = pls_random_stream(10, 0, PLS_FOR_USER);
        for (int k = 0; k < 50; ++k)
        {
            pls_vec3 n = pls_unit(random_point(shape, &random, 1.0)), t = random_point(shape, &random, 1.0);
            double least = fmin(fmin(fabs(n.x), fabs(n.y)), shape->dimension == 2 ? 1.0 : fabs(n.z)), d[6], h = 1e-6;
            if (least < 0.05) continue;
            shape->ops->support_gradient(shape, n, d);
            pls_vec3 a = shape->ops->support(shape, pls_add(n, pls_scale(t, h))),
                     b = shape->ops->support(shape, pls_sub(n, pls_scale(t, h)));
            pls_vec3 difference = pls_scale(pls_sub(a, b), 0.5 / h);
            pls_vec3 known =
                pls_vec(d[0] * t.x + d[3] * t.y + d[4] * t.z, d[3] * t.x + d[1] * t.y + d[5] * t.z, d[4] * t.x + d[5] * t.y + d[2] * t.z);
            double error = pls_length(pls_sub(difference, known));
            if (error > 1e-6 * (pls_length(known) + shape->radius)) fail_msg("%s: support gradient off by %g", examples[e].name, error);
        }
        pls_shape_free(shape);
    }
}

/// The proximal map's value is not above that of any other point tried, and its place a minimum along many ways.
static void proximal_is_least(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        if (!examples[e].ops->proximal) continue;
        pls_shape *shape = make(&examples[e]);
        pls_random random = pls_random_stream(11, 0, PLS_FOR_USER);
        for (int k = 0; k < 400; ++k)
        {
            double step = shape->radius * (0.02 + pls_random_uniform(&random)), size = shape->radius;
            pls_vec3 X = random_point(shape, &random, 1.5 * size), Y = shape->ops->proximal(shape, X, step), d = pls_sub(Y, X);
            double value = pls_shape_sdf(shape, Y) + pls_dot(d, d) / (2.0 * step);
            for (int j = 0; j < 300; ++j)
            {
                pls_vec3 Z = pls_add(Y, random_point(shape, &random, size * pow(10.0, -(j % 6)))), f = pls_sub(Z, X);
                double other = pls_shape_sdf(shape, Z) + pls_dot(f, f) / (2.0 * step);
                if (other < value - 1e-13 * size) fail_msg("%s: proximal %.15g, elsewhere %.15g", examples[e].name, value, other);
            }
        }
        pls_shape_free(shape);
    }
}

/// Free of surface as the quadrature asks, and much cheaper than the distance: the gauge grows by at most |1/half| per way, for exponents up to 2.
static double free_way(const pls_shape *shape, pls_vec3 X)
{
    const double *v = shape->values;
    return (gauge(shape, X) - 1.0) / pls_length(pls_vec(1.0 / v[0], 1.0 / v[1], shape->dimension == 2 ? 0.0 : 1.0 / v[2]));
}

static void mass_against_quadrature(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        pls_shape_ops cheap = *examples[e].ops;
        if (examples[e].ops == &pls_superquadric_shape) cheap.sdf = free_way;
        pls_shape *shape = make(&examples[e]), twin = *shape;
        pls_mass_properties m;
        twin.ops = &cheap;
        assert_int_equal(pls_mass_by_quadrature(&twin, pls_vec(0.0, 0.0, 0.0), shape->radius * 1.01, &m), PLS_OK);
        const double *known = shape->mass.inertia, scale = fmax(fmax(known[0], known[1]), known[2]);
        double error = fabs(m.volume / shape->mass.volume - 1.0);
        for (int k = 0; k < 6; ++k)
            if (k == 2 || shape->dimension == 3) error = fmax(error, fabs(m.inertia[k] - known[k]) / scale); // 2D: only zz counts
        if (error > 1e-6 || pls_length(m.centre) > 1e-6 * shape->radius)
            fail_msg("%s: mass off by %g (estimated %g), volume %.12g, by quadrature %.12g", examples[e].name, error, m.error,
                     shape->mass.volume, m.volume);
        pls_shape_free(shape);
    }
}

/// Face normals, the sense of their corners, and neighbours along edges.
static void polytopes_are_closed(void **state)
{
    (void)state;
    for (int e = 0; e < EXAMPLES; ++e)
    {
        pls_shape *shape = make(&examples[e]);
        const pls_polytope *p = shape->polytope;
        for (uint32_t v = 0; p && v < p->vertex_count; ++v)
        {
            assert_true(fabs(pls_shape_sdf(shape, p->vertex[v]) + shape->margin) < 1e-14 * shape->radius);
            for (uint32_t k = p->neighbour_start[v]; k < p->neighbour_start[v + 1]; ++k) assert_int_not_equal(p->neighbour[k], v);
        }
        for (uint32_t f = 0; p && f < p->face_count; ++f)
        {
            const uint32_t *corner = p->face_vertex + p->face_start[f], corners = p->face_start[f + 1] - p->face_start[f];
            assert_int_equal(corners, shape->dimension == 2 ? 2 : 4);
            for (uint32_t k = 0; k < corners; ++k)
            {
                pls_vec3 a = p->vertex[corner[k]], b = p->vertex[corner[(k + 1) % corners]];
                pls_vec3 c = p->vertex[corner[(k + 2) % corners]], along = pls_sub(b, a);
                pls_vec3 turn = shape->dimension == 2 ? pls_cross(along, pls_vec(0, 0, 1)) : pls_cross(along, pls_sub(c, b));
                if (shape->dimension == 3 || k == 0) assert_true(pls_dot(turn, p->face_normal[f]) > 0.999999 * pls_length(turn));
                assert_true(fabs(pls_dot(a, p->face_normal[f]) -
                                 pls_dot(shape->ops->support(shape, p->face_normal[f]), p->face_normal[f])) < 1e-14);
                bool joined = false;
                for (uint32_t j = p->neighbour_start[corner[k]]; j < p->neighbour_start[corner[k] + 1]; ++j)
                    joined = joined || p->neighbour[j] == corner[(k + 1) % corners];
                assert_true(joined);
            }
        }
        pls_shape_free(shape);
    }
}

/// A point of the surface moved along its normal knows its distance: an ellipsoid's, to round-off.
static void ellipsoid_to_round_off(void **state)
{
    (void)state;
    static const double halves[4][3] = {{0.5, 0.8, 1.3}, {1.0, 1.0, 0.01}, {1.0, 1e-3, 0.999999}, {1.0, 1.0, 1.0}};
    for (int k = 0; k < 8; ++k)
    {
        example e = {&pls_ellipsoid_shape, k & 1 ? 2 : 3, {0}, "ellipsoid"};
        memcpy(e.values, halves[k / 2], sizeof halves[0]);
        pls_shape *shape = make(&e);
        double least = fmin(fmin(e.values[0], e.values[1]), k & 1 ? 1.0 : e.values[2]);
        pls_random random = pls_random_stream(12, 0, PLS_FOR_USER);
        for (int j = 0; j < 2000; ++j)
        {
            pls_vec3 n = pls_unit(random_point(shape, &random, 1.0)), s = shape->ops->support(shape, n);
            double inward = least * least; // the least radius of curvature is at least least^2 / most, most = 1 or a little more
            double d = j & 1 ? 3.0 * pls_random_uniform(&random) : -0.7 * inward * pls_random_uniform(&random);
            double phi = pls_shape_sdf(shape, pls_add(s, pls_scale(n, d)));
            if (fabs(phi - d) > 1e-14 * fmax(1.0, fabs(d))) fail_msg("ellipsoid %d: %.17g, known %.17g", k, phi, d);
        }
        pls_shape_free(shape);
    }
}

/// Thickened by a ball, a convex shape is all that lies within `rounding` of it: its distance is less by that, inside too, and its support points lie further out.
static void rounding_thickens_ellipsoids_and_superquadrics(void **state)
{
    (void)state;
    static const example cores[] = {{&pls_ellipsoid_shape, 3, {0.5, 0.8, 1.3}, "ellipsoid"},
                                    {&pls_ellipsoid_shape, 2, {0.5, 1.7, 1.0}, "ellipse"},
                                    {&pls_superquadric_shape, 2, {0.6, 1.0, 1.0, 1.0, 0.4}, "superellipse"}};
    for (int e = 0; e < 3; ++e)
    {
        const double r = 0.15;
        example thick = cores[e];
        thick.values[cores[e].ops == &pls_ellipsoid_shape ? 3 : 5] = r;
        pls_shape *core = make(&cores[e]), *shape = make(&thick);
        assert_true(shape->margin == r && core->margin == 0.0);
        assert_true(fabs(shape->radius - core->radius - r) < 1e-13);
        pls_random random = pls_random_stream(13, 0, PLS_FOR_USER);
        for (int k = 0; k < 200; ++k)
        {
            pls_vec3 X = random_point(shape, &random, 1.5 * shape->radius), n = pls_unit(random_point(shape, &random, 1.0));
            assert_true(fabs(pls_shape_sdf(shape, X) - (pls_shape_sdf(core, X) - r)) < 1e-14);
            pls_vec3 s = pls_shape_support(shape, n);
            assert_true(pls_length(pls_sub(s, pls_add(pls_shape_support(core, n), pls_scale(n, r)))) < 1e-14);
            assert_true(fabs(pls_shape_sdf(shape, s)) < 1e-12);
            assert_true(s.x <= shape->upper.x && s.y <= shape->upper.y && s.z <= shape->upper.z);
        }
        pls_shape_free(core);
        pls_shape_free(shape);
    }
}

/// Steiner's formula for thickened bodies; the ellipse's perimeter and the surface and mean width of the spheroid by Simpson's rule.
static void rounded_ellipsoids_have_steiners_volume(void **state)
{
    (void)state;
    enum { PANELS = 2000 };
    const double a = 0.5, c = 1.3, r = 0.15;
    double perimeter = 0.0, area = 0.0, width = 0.0;
    for (int k = 0; k <= PANELS; ++k)
    {
        const double w = (k == 0 || k == PANELS ? 1.0 : k & 1 ? 4.0 : 2.0) / 3.0 / PANELS, t = (double)k / PANELS;
        const double angle = 0.5 * M_PI * t, speed = hypot(a * sin(angle), c * cos(angle));
        perimeter += 4.0 * w * 0.5 * M_PI * speed;
        area +=
            2.0 * w * 0.5 * M_PI * 2.0 * M_PI * a * cos(angle) * hypot(c * cos(angle), a * sin(angle)); // rings of radius a cos, latitude
        width += w * hypot(a * sqrt(1.0 - t * t), c * t); // h over cos of the angle to the axis
    }
    const example flat = {&pls_ellipsoid_shape, 2, {a, c, 1.0, r}, "ellipse"}, solid = {&pls_ellipsoid_shape, 3, {a, a, c, r}, "spheroid"};
    pls_shape *shape = make(&flat);
    assert_true(fabs(shape->mass.volume / (M_PI * a * c + perimeter * r + M_PI * r * r) - 1.0) < 1e-7);
    pls_shape_free(shape);
    shape = make(&solid);
    const double known = 4.0 / 3.0 * M_PI * (a * a * c + r * r * r) + area * r + 4.0 * M_PI * width * r * r;
    if (fabs(shape->mass.volume / known - 1.0) > 1e-7) fail_msg("volume %.12g, Steiner's %.12g", shape->mass.volume, known);
    pls_shape_free(shape);
}

static void shapes_have_their_names_in_2d(void **state)
{
    (void)state;
    const double values[4] = {0.5, 0.3, 0.3, 0.0}, none[1] = {0.0};
    const struct
    {
        const pls_shape_ops *flat, *solid;
        const double *values;
        size_t count;
    } names[] = {{&pls_disc_shape, &pls_sphere_shape, COUNTED(values)},
                 {&pls_ellipse_shape, &pls_ellipsoid_shape, COUNTED(values)},
                 {&pls_half_plane_shape, &pls_plane_shape, COUNTED(none)}};
    for (int k = 0; k < 3; ++k)
    {
        const pls_shape_input input = {.values = names[k].values, .value_count = names[k].count};
        pls_shape *a = NULL, *b = NULL;
        assert_int_equal(pls_shape_make(names[k].flat, 2, &input, "x", &a), PLS_OK);
        assert_int_equal(pls_shape_make(names[k].solid, 2, &input, "x", &b), PLS_OK);
        assert_true(a->mass.volume == b->mass.volume && a->radius == b->radius);
        assert_true(pls_shape_sdf(a, pls_vec(0.9, 0.4, 0.0)) == pls_shape_sdf(b, pls_vec(0.9, 0.4, 0.0)));
        pls_shape_free(a);
        pls_shape_free(b);
        assert_int_equal(pls_shape_make(names[k].flat, 3, &input, "x", &a), PLS_INVALID_ARGUMENT);
    }
}

static void refuses_too_much_rounding(void **state)
{
    (void)state;
    static const example wrong[] = {{&pls_box_shape, 3, {1.0, 1.0, 0.2, 0.2}, "box"},
                                    {&pls_cylinder_shape, 3, {1.0, 0.5, 0.25}, "cylinder"}};
    for (int k = 0; k < 2; ++k)
    {
        pls_shape *shape = NULL;
        pls_shape_input input = {VALUES(wrong[k].values)};
        assert_int_equal(pls_shape_make(wrong[k].ops, 3, &input, "x", &shape), PLS_INVALID_ARGUMENT);
        assert_null(shape);
        assert_non_null(strstr(pls_last_message(), "rounding"));
    }
}

/// The array is as long as it says and no longer: the sanitizer sees a read beyond its end.
static void refuses_too_few_values(void **state)
{
    (void)state;
    const double half[3] = {0.5, 0.4, 0.3};
    pls_shape *shape = NULL;
    assert_int_equal(pls_shape_make(&pls_superquadric_shape, 3, &(pls_shape_input){VALUES(half)}, "shape 'stone'", &shape),
                     PLS_INVALID_ARGUMENT);
    assert_null(shape);
    assert_string_equal(pls_last_message(), "shape 'stone': a superquadric takes 6 values, in this order: half (3), epsilon1, epsilon2, "
                                            "rounding; `value_count` says that there are 3");
    assert_int_equal(pls_shape_make(&pls_box_shape, 3, &(pls_shape_input){.values = half}, "a box", &shape), PLS_INVALID_ARGUMENT);
    assert_string_equal(pls_last_message(),
                        "a box: a box takes 4 values, in this order: half (3), rounding; `value_count` says that there are 0");
    // None at all: the defaults, of which a required one is missing.
    assert_int_equal(pls_shape_make(&pls_box_shape, 3, &(pls_shape_input){0}, "a box", &shape), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "'half[0]'"));
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sdf_against_surface),
        cmocka_unit_test(gradient_against_differences),
        cmocka_unit_test(support_against_surface),
        cmocka_unit_test(support_gradient_against_differences),
        cmocka_unit_test(proximal_is_least),
        cmocka_unit_test(mass_against_quadrature),
        cmocka_unit_test(polytopes_are_closed),
        cmocka_unit_test(ellipsoid_to_round_off),
        cmocka_unit_test(rounding_thickens_ellipsoids_and_superquadrics),
        cmocka_unit_test(rounded_ellipsoids_have_steiners_volume),
        cmocka_unit_test(shapes_have_their_names_in_2d),
        cmocka_unit_test(refuses_too_much_rounding),
        cmocka_unit_test(refuses_too_few_values),
    };
    return cmocka_run_group_tests_name("shapes", tests, NULL, NULL);
}
