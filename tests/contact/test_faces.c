// Laws of faces: volumes and energies against closed forms and Monte Carlo on the SDFs, forces against the gradient of the energy, and what collisions keep of it.

#include "contact/faces.h"
#include "contact/touch_area.h"
#include "shape/builtin.h"
#include "support/near.h"
#include "support/solids.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { ROUNDED, SCALE, CLOSED = 1 }; // numbers of a mesh and of a polyline

static pls_touch touch_of(const pls_posed *a, const pls_posed *b, pls_faces faces, double area)
{
    const pls_narrow_options options = solids_options(faces, area);
    const pls_depth depth = solids_depth(a, b, NULL);
    pls_touch t = {0};
    assert_true(solids_faces_touch(a, b, &depth, &options, NULL, &t));
    return t;
}

static pls_posed at(const pls_shape *shape, pls_vec3 x, pls_quat q) { return pls_pose(shape, x, q, 1.0); }

/// How deep the lowest point lies.
static double depth_below(const pls_posed *p, const pls_posed *plane) { return solids_depth(p, plane, NULL).delta; }

// ---- known overlaps -----------------------------------------------------------------------------------------------------------------------------------------

/// Flat: V = 4 h_x h_y d, energy delta = sqrt(V d / A0). On an edge: a prism whose section is a right-angled triangle. On a corner: a tetrahedron.
static void a_box_on_a_plane_displaces_what_is_below(void **state)
{
    (void)state;
    pls_shape *b = solids_box(3, 0.5, 0.3, 0.4, 0.0), *ground = solids_plane(3);
    const pls_posed below = at(ground, pls_vec(0, 0, 0), pls_quat_identity());
    const double A0 = 0.7, d = 0.01;
    pls_posed p = at(b, pls_vec(2.0, 1.0, 0.4 - d), solids_turn(pls_vec(0, 0, 1), 0.4));
    pls_touch t = touch_of(&p, &below, PLS_FACES_VOLUME, A0);
    assert_near(t.delta, 0.6 * d / A0, 1e-15);
    assert_near(t.weight, 0.6 / A0, 1e-12);
    assert_near(t.energy_delta, d * sqrt(0.6 / A0), 1e-14);
    assert_near(t.depth, d, 1e-14);
    assert_vec_near(t.normal, pls_vec(0, 0, -1), 1e-13);
    assert_vec_near(t.point, pls_vec(2.0, 1.0, -0.5 * d), 1e-12);
    t = touch_of(&p, &below, PLS_FACES_MANIFOLD, 0.0);
    assert_near(t.delta, d, 1e-14);
    assert_near(t.weight, 1.0, 1e-12);
    assert_vec_near(t.point, pls_vec(2.0, 1.0, -0.5 * d), 1e-11);

    for (double angle = 0.05; angle < 1.5; angle += 0.2) // edge at x = -0.5, z = -0.4 turned down to depth d
    {
        const double c = cos(angle), s = sin(angle), up = d / s, side = d / c; // legs of the triangle along the bottom (x) and the side (z)
        if (up > 1.0) continue;
        p = at(b, pls_vec(0.0, 0.0, 0.0), solids_turn(pls_vec(0, 1, 0), -angle));
        const pls_vec3 edge = pls_sub(pls_posed_world(&p, pls_vec(-0.5, 0, -0.4)), pls_vec(0, 0, -d));
        p = at(b, pls_scale(edge, -1.0), solids_turn(pls_vec(0, 1, 0), -angle));
        t = touch_of(&p, &below, PLS_FACES_VOLUME, A0);
        const double area = 0.5 * up * side;
        assert_near(t.delta, 0.6 * area / A0, 1e-13);
        assert_near(t.weight, 0.6 * hypot(up, side) / A0, 1e-9);
        assert_near(t.energy_delta, sqrt(2.0 * 0.6 * area * d / 3.0 / A0), 1e-12);
        assert_near(t.point.z, -d / 3.0, 1e-12);
        assert_near(t.point.x, (up * c - side * s) / 3.0, 1e-12);
        t = touch_of(&p, &below, PLS_FACES_MANIFOLD, 0.0);
        assert_near(t.energy_delta, 3.0 / 4.0 * d, 1e-12);
        assert_near(t.delta, 9.0 / 16.0 * d, 1e-11);
        assert_near(t.point.x, 0.0, 1e-9); // at the edge
    }
    pls_shape_free(b);
    pls_shape_free(ground);
}

static void a_tetrahedrons_corner_in_a_plane_and_in_a_box(void **state)
{
    (void)state;
    const pls_vec3 corner[4] = {{0.7, 0, 0.9}, {-0.3, 0.5, 0.9}, {-0.4, -0.6, 0.9}, {0.1, 0.05, -0.1}};
    pls_shape *t = solids_hull(3, corner, 4, 0.0), *ground = solids_plane(3), *slab = solids_box(3, 2.0, 2.0, 1.0, 0.0);
    const double part = 0.05,
                 volume =
                     fabs(pls_dot(pls_sub(corner[0], corner[3]), pls_cross(pls_sub(corner[1], corner[3]), pls_sub(corner[2], corner[3])))) /
                     6.0;
    const pls_quat q = t->principal; // so that the shape's axes are the world's
    const pls_vec3 lift = pls_vec(0, 0, 0.1 - part);
    const pls_posed p = at(t, pls_add(t->mass.centre, lift), q);
    const pls_posed below = at(ground, pls_vec(0, 0, 0), pls_quat_identity());
    pls_touch touch = touch_of(&p, &below, PLS_FACES_VOLUME, 1.0);
    assert_near(touch.delta, volume * part * part * part, 1e-15);
    assert_near(touch.energy_delta, sqrt(2.0 * touch.delta * part / 4.0), 1e-12); // centroid at a quarter of the height
    const pls_posed block = at(slab, pls_vec(0, 0, -1.0), pls_quat_identity());
    touch = touch_of(&p, &below, PLS_FACES_MANIFOLD, 1.0);
    assert_near(touch.energy_delta, 0.6 * part, 1e-12);
    assert_near(touch.delta, 0.36 * part, 1e-11);
    assert_vec_near(pls_sub(touch.point, pls_add(corner[3], lift)), pls_vec(0, 0, touch.point.z - corner[3].z - lift.z), 1e-9);
    // The box's own share of force and energy are half of the plane's; the tetrahedron's is left to Monte Carlo.
    touch = touch_of(&p, &block, PLS_FACES_VOLUME, 1.0);
    assert_true(touch.delta > 0.5 * volume * part * part * part && touch.delta < volume * part * part * part);
    pls_shape_free(t), pls_shape_free(ground), pls_shape_free(slab);
}

/// A small box on a large one. What is deeper than s in the small one is (a - 2s)(b - 2s)(d - s), in the large one a b (d - s).
static void a_box_in_the_middle_of_a_larger_one(void **state)
{
    (void)state;
    pls_shape *small = solids_box(3, 0.3, 0.2, 0.5, 0.0), *large = solids_box(3, 1.0, 1.0, 1.0, 0.0);
    const double d = 0.02, a = 0.6, b = 0.4;
    const pls_posed p = at(large, pls_vec(0, 0, -1.0), pls_quat_identity()),
                    q = at(small, pls_vec(0.1, -0.2, 0.5 - d), solids_turn(pls_vec(0, 0, 1), 0.3));
    pls_touch t = touch_of(&p, &q, PLS_FACES_VOLUME, 1.0);
    const double V = a * b * d, flat = 0.5 * a * b * d * d;
    const double rim = flat - (a + b) * pow(d, 3.0) / 3.0 + pow(d, 4.0) / 3.0; // integral over s from 0 to d
    assert_near(t.energy_delta, sqrt(flat + rim), 1e-14);
    // Of the small box's cells the bottom's pushes up: its area at depth s is (a - 2s)(b - 2s), the sides' cancel.
    const double up = a * b * d - (a + b) * d * d + 4.0 / 3.0 * pow(d, 3.0);
    assert_near(t.delta, 0.5 * (V + up), 1e-15);
    assert_vec_near(t.normal, pls_vec(0, 0, 1), 1e-12);
    assert_vec_near(pls_sub(t.point, q.position), pls_vec(0, 0, t.point.z - q.position.z), 1e-12);
    t = touch_of(&p, &q, PLS_FACES_MANIFOLD, 0.0);
    // Integrals of d^2: a b d^3/3 of the large box, of the small one that of 2 s times what is deeper than s.
    const double of_large = a * b * pow(d, 3.0) / 3.0, of_small = of_large - (a + b) * pow(d, 4.0) / 3.0 + 0.4 * pow(d, 5.0);
    assert_near(t.energy_delta, 1.5 * (of_large + of_small) / (flat + rim), 1e-13);
    pls_shape_free(small), pls_shape_free(large);
}

static void caps_of_spheres_and_ellipsoids(void **state)
{
    (void)state;
    const double radius[4] = {0.5}, half[4] = {0.5, 0.3, 0.7}; // the rest: no rounding
    const struct
    {
        const pls_shape_ops *ops;
        int dimension;
        const double *values;
        size_t count;
    } cases[] = {{&pls_sphere_shape, 3, COUNTED(radius)},
                 {&pls_ellipsoid_shape, 3, COUNTED(half)},
                 {&pls_sphere_shape, 2, COUNTED(radius)},
                 {&pls_ellipsoid_shape, 2, COUNTED(half)}};
    for (size_t k = 0; k < 4; ++k)
        for (double d = 1e-4; d < 0.3; d *= 4.0)
        {
            const int dimension = cases[k].dimension;
            pls_shape *s = solids_make(cases[k].ops, dimension,
                                       &(pls_shape_input){.values = cases[k].values, .value_count = cases[k].count}),
                      *ground = solids_plane(dimension);
            const pls_vec3 up = dimension == 2 ? pls_vec(0, 1, 0) : pls_vec(0, 0, 1);
            pls_posed p = at(s, pls_vec(0, 0, 0), solids_turn(dimension == 2 ? pls_vec(0, 0, 1) : pls_unit(pls_vec(1, 2, 3)), 0.7));
            const double R = -pls_dot(up, pls_posed_support(&p, pls_scale(up, -1.0)));
            p.position = pls_scale(up, R - d);
            const pls_posed below = at(ground, pls_vec(0, 0, 0), pls_quat_identity());
            const pls_touch t = touch_of(&p, &below, PLS_FACES_VOLUME, 1.0);
            // Sections of the body: the unit ball's at the same part of the height, stretched. Simpson's rule over sqrt(depth) for the disc.
            const double stretch =
                s->ops == &pls_sphere_shape ? pow(0.5, dimension) / R : (dimension == 3 ? 0.5 * 0.3 * 0.7 : 0.5 * 0.3) / R;
            double V = 0, W = 0;
            const int steps = 2000;
            for (int i = 0; i <= steps; ++i)
            {
                const double u = (double)i / steps, depth = d * u * u, c = 1.0 - depth / R; // `depth` above the lowest point
                const double section = stretch * (dimension == 3 ? M_PI * (1 - c * c) : 2.0 * sqrt((1 - c) * (1 + c)));
                const double w = (i == 0 || i == steps ? 1.0 : i & 1 ? 4.0 : 2.0) / (3.0 * steps) * 2.0 * d * u * section;
                V += w, W += w * (d - depth);
            }
            assert_near(t.delta / V, 1.0, 1e-8);
            assert_near(t.energy_delta / sqrt(2 * W), 1.0, 1e-8);
            assert_near(t.depth, d, 1e-12);
            pls_posed deeper = p;
            deeper.position = pls_scale(up, R - d - 1e-4 * d);
            const pls_touch more = touch_of(&deeper, &below, PLS_FACES_VOLUME, 1.0);
            assert_near((more.delta - t.delta) / (1e-4 * d) / t.weight, 1.0, 1e-3);
            assert_near(pls_dot(t.point, up), -W / V, 1e-8 * d + 1e-12);
            const pls_depth depth = solids_depth(&p, &below, NULL);
            const pls_narrow_options manifold = solids_options(PLS_FACES_MANIFOLD, 1.0);
            pls_touch none;
            assert_false(solids_faces_touch(&p, &below, &depth, &manifold, NULL, &none));
            pls_shape_free(s), pls_shape_free(ground);
        }
}

// ---- walls of facets ----------------------------------------------------------------------------------------------------------------------------------------

/// A floor of pieces, wherever its seams are, also with a rounding, which lifts it.
static void facets_of_a_floor_add_up_to_a_plane(void **state)
{
    (void)state;
    solids_seed(5);
    FILE *f = fopen("floor.obj", "w");
    assert_non_null(f);
    fputs("v -3 -3 0\nv 3 -2.5 0\nv 2.8 3 0\nv -2.9 3.1 0\nv 0.05 -0.02 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n", f);
    assert_int_equal(fclose(f), 0);
    for (int round = 0; round < 20; ++round)
    {
        const int dimension = round % 4 == 3 ? 2 : 3;
        const double lift = round & 1 ? 0.1 : 0.0, mesh_values[] = {[SCALE] = 1.0, [ROUNDED] = lift},
                     line_values[] = {[ROUNDED] = lift, [CLOSED] = 0.0};
        const pls_vec3 line[3] = {{-3, 0, 0}, {0.1, 0, 0}, {3, 0, 0}};
        pls_shape *ground = solids_plane(dimension);
        pls_shape *floor =
            dimension == 3 ? solids_make(&pls_mesh_shape, 3, &(pls_shape_input){VALUES(mesh_values), .path = "floor.obj"})
                           : solids_make(&pls_polyline_shape, 2, &(pls_shape_input){VALUES(line_values), .points = line, .point_count = 3});
        pls_shape *s = dimension == 2 ? solids_stone(2, 7, 0.0) : round & 2 ? solids_stone(3, 16, 0.05) : solids_box(3, 0.5, 0.3, 0.4, 0.1);
        const pls_posed below = at(ground, dimension == 2 ? pls_vec(0, lift, 0) : pls_vec(0, 0, lift), pls_quat_identity());
        pls_posed p = at(s, pls_vec(0, 0, 0), solids_turn(dimension == 2 ? pls_vec(0, 0, 1) : solids_direction(3), solids_uniform(0, 6)));
        const double height = depth_below(&p, &below);
        p.position = pls_add(p.position, dimension == 2 ? pls_vec(solids_uniform(-0.2, 0.2), height - 0.05, 0)
                                                        : pls_vec(solids_uniform(-0.2, 0.2), 0.0, height - 0.05));
        pls_vec3 F = {0, 0, 0}, T = F, F0 = F, T0 = F;
        double U = 0.0, U0 = 0.0;
        solids_add_wrench(&p, &below, &F0, &T0, &U0);
        size_t count = 0;
        const pls_shape_part *part = floor->ops->parts(floor, &count);
        assert_int_equal(count, dimension == 2 ? 2 : 4);
        for (size_t k = 0; k < count; ++k)
        {
            const pls_posed piece = at(part[k].shape, part[k].position, part[k].orientation);
            solids_add_wrench(&p, &piece, &F, &T, &U);
        }
        assert_near(pls_length(F0), pls_length(F), 1e-15);
        assert_true(pls_length(F0) > 1e-4);
        assert_vec_near(F, F0, 1e-12);
        assert_vec_near(T, T0, 1e-12);
        assert_near(U, U0, 1e-13);
        pls_shape_free(s), pls_shape_free(floor), pls_shape_free(ground);
    }
}

/// For the same shapes always: what has no faces is left to the point law.
static void pairs_without_faces_are_left_alone(void **state)
{
    (void)state;
    const double radius[4] = {0.5}, capsule[4] = {0.2, 0.5};
    static pls_vec3 many[400];
    for (int k = 0; k < 400; ++k) many[k] = pls_scale(solids_direction(3), 0.5);
    pls_shape *s[] = {solids_make(&pls_sphere_shape, 3, &(pls_shape_input){VALUES(radius)}),
                      solids_make(&pls_capsule_shape, 3, &(pls_shape_input){VALUES(capsule)}), solids_box(3, 0.5, 0.5, 0.5, 0.1),
                      solids_hull(3, many, 400, 0.0)};
    pls_shape *b = solids_box(3, 0.5, 0.5, 0.5, 0.0);
    assert_true(s[3]->polytope->face_count > PLS_MOST_FACES);
    for (int k = 0; k < 4; ++k)
        for (pls_faces faces = PLS_FACES_POINT; faces <= PLS_FACES_VOLUME; ++faces)
        {
            const pls_posed p = at(s[k], pls_vec(0, 0, 0), pls_quat_identity()), q = at(b, pls_vec(0.1, 0, 0.9), pls_quat_identity());
            const pls_depth depth = solids_depth(&p, &q, NULL);
            const pls_narrow_options options = solids_options(faces, 1.0);
            pls_touch t;
            assert_false(solids_faces_touch(&p, &q, &depth, &options, NULL, &t));
        }
    for (int k = 0; k < 4; ++k) pls_shape_free(s[k]);
    pls_shape_free(b);
}

// ---- Monte Carlo --------------------------------------------------------------------------------------------------------------------------------------------

typedef struct sampled
{
    double V, W, Q;         ///< integrals of 1, of d and of d^2
    pls_vec3 force, torque; ///< about the origin
} sampled;

static void common_block(const pls_posed *a, const pls_posed *b, pls_vec3 *low, pls_vec3 *high)
{
    const pls_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double l[3] = {0}, h[3] = {0};
    for (int k = 0; k < a->shape->dimension; ++k)
    {
        const pls_vec3 minus = pls_scale(axis[k], -1.0);
        l[k] = fmax(pls_dot(axis[k], pls_posed_support(a, minus)), pls_dot(axis[k], pls_posed_support(b, minus)));
        h[k] = fmin(pls_dot(axis[k], pls_posed_support(a, axis[k])), pls_dot(axis[k], pls_posed_support(b, axis[k])));
    }
    *low = pls_vec(l[0], l[1], l[2]), *high = pls_vec(h[0], h[1], h[2]);
}

/// One random point in each of m^dimension cells of a block; then `low` and `high` are about what overlaps.
static sampled sample(const pls_posed *a, const pls_posed *b, int m, pls_vec3 *low, pls_vec3 *high)
{
    const int dimension = a->shape->dimension, layers = dimension == 3 ? m : 1;
    const pls_vec3 size = pls_sub(*high, *low);
    const double cell = size.x / m * size.y / m * (dimension == 3 ? size.z / m : 1.0);
    sampled s = {0};
    pls_vec3 l = *high, h = *low;
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j)
            for (int k = 0; k < layers; ++k)
            {
                pls_vec3 x = pls_vec(low->x + size.x * (i + solids_uniform(0, 1)) / m, low->y + size.y * (j + solids_uniform(0, 1)) / m,
                                     dimension == 3 ? low->z + size.z * (k + solids_uniform(0, 1)) / m : 0.0);
                const double da = -pls_posed_sdf(a, x);
                if (da < 0.0) continue;
                const double db = -pls_posed_sdf(b, x);
                if (db < 0.0) continue;
                l = pls_vec(fmin(l.x, x.x), fmin(l.y, x.y), fmin(l.z, x.z)), h = pls_vec(fmax(h.x, x.x), fmax(h.y, x.y), fmax(h.z, x.z));
                s.V += cell, s.W += 0.5 * cell * (da + db), s.Q += 0.5 * cell * (da * da + db * db);
                const pls_vec3 f = pls_scale(pls_sub(pls_posed_gradient(a, x), pls_posed_gradient(b, x)), 0.5 * cell);
                s.force = pls_add(s.force, f), s.torque = pls_add(s.torque, pls_cross(x, f));
            }
    const pls_vec3 margin = pls_scale(size, 4.0 / m); // thin ends may have been missed
    *low = pls_sub(l, margin), *high = pls_add(h, margin);
    return s;
}

/// A touches B by `depth`, somewhere.
static void place(const pls_shape *a, const pls_shape *b, double depth, pls_posed *p, pls_posed *q)
{
    const int dimension = a->dimension;
    *p = at(a, pls_vec(0, 0, 0), solids_turn(dimension == 2 ? pls_vec(0, 0, 1) : solids_direction(3), solids_uniform(0, 6)));
    const pls_quat turn = solids_turn(dimension == 2 ? pls_vec(0, 0, 1) : solids_direction(3), solids_uniform(0, 6));
    const pls_vec3 n = solids_direction(dimension);
    double low = 0.0, high = 4.0;
    for (int k = 0; k < 60; ++k)
    {
        const double middle = 0.5 * (low + high);
        *q = at(b, pls_scale(n, middle), turn);
        if (solids_depth(p, q, NULL).delta > depth)
            low = middle;
        else
            high = middle;
    }
}

static void random_pairs_agree_with_monte_carlo(void **state)
{
    (void)state;
    solids_seed(7);
    for (int round = 0; round < 12; ++round)
    {
        const int dimension = round % 3 == 2 ? 2 : 3;
        pls_shape *a = round & 1 ? solids_box(dimension, 0.5, 0.4, 0.6, 0.0) : solids_stone(dimension, 20, 0.0),
                  *b = solids_stone(dimension, 12, 0.0);
        pls_posed p, q;
        place(a, b, solids_uniform(0.03, 0.2), &p, &q);
        pls_vec3 low, high;
        common_block(&p, &q, &low, &high);
        sample(&p, &q, dimension == 3 ? 40 : 200, &low, &high);
        const sampled s = sample(&p, &q, dimension == 3 ? 80 : 800, &low, &high);
        const pls_touch v = touch_of(&p, &q, PLS_FACES_VOLUME, 1.0), m = touch_of(&p, &q, PLS_FACES_MANIFOLD, 1.0);
        assert_near(v.energy_delta / sqrt(2 * s.W), 1.0, 5e-3);
        assert_near(m.energy_delta / (1.5 * s.Q / s.W), 1.0, 5e-3);
        const double F = pls_length(s.force);
        assert_near(v.delta / F, 1.0, 5e-3);
        assert_vec_near(v.normal, pls_scale(s.force, 1 / F), 1e-2);
        const pls_vec3 rest = pls_sub(s.torque, pls_add(pls_cross(v.point, s.force), pls_scale(s.force, v.twist)));
        assert_near(pls_length(rest) / F, 0.0, 2e-3);
        pls_shape_free(a), pls_shape_free(b);
    }
}

// ---- the gradient -------------------------------------------------------------------------------------------------------------------------------------------

static double energy_of(const pls_posed *p, const pls_posed *q, pls_faces faces)
{
    const double e = touch_of(p, q, faces, 1.0).energy_delta;
    return 0.5 * e * e;
}

/// Moves B.
static pls_posed moved(const pls_posed *q, pls_vec3 shift, pls_vec3 about, pls_vec3 axis, double angle)
{
    pls_posed m = *q;
    const pls_quat r = solids_turn(axis, angle);
    m.position = pls_add(pls_add(about, pls_rotate(r, pls_sub(q->position, about))), shift);
    m.x = pls_rotate(r, q->x), m.y = pls_rotate(r, q->y), m.z = pls_rotate(r, q->z);
    return m;
}

/// Force on B against -dU/dx, couple about the point against -dU/d(angle), by central differences.
static double gradient_error(const pls_posed *p, const pls_posed *q, pls_faces faces)
{
    const pls_touch t = touch_of(p, q, faces, 1.0);
    const pls_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, none = {0, 0, 0};
    const double h = 1e-5 * t.depth, turn = 1e-5 * t.depth;
    double f[3], g[3];
    for (int k = 0; k < 3; ++k)
    {
        pls_posed more = moved(q, pls_scale(axis[k], h), t.point, axis[k], 0), less = moved(q, pls_scale(axis[k], -h), t.point, axis[k], 0);
        const bool flat = p->shape->dimension == 2;
        f[k] = flat && k == 2 ? 0.0 : -(energy_of(p, &more, faces) - energy_of(p, &less, faces)) / (2 * h);
        more = moved(q, none, t.point, axis[k], turn), less = moved(q, none, t.point, axis[k], -turn);
        g[k] = flat && k < 2 ? 0.0 : -(energy_of(p, &more, faces) - energy_of(p, &less, faces)) / (2 * turn);
    }
    const pls_vec3 F = pls_vec(f[0], f[1], f[2]), G = pls_vec(g[0], g[1], g[2]);
    const pls_vec3 rest = pls_sub(G, pls_scale(t.normal, t.delta * t.twist));
    return fmax(pls_length(pls_sub(F, pls_scale(t.normal, t.delta))), pls_length(rest)) / t.delta;
}

static void forces_are_the_gradient_of_the_energy(void **state)
{
    (void)state;
    solids_seed(11);
    const pls_faces laws[2] = {PLS_FACES_VOLUME, PLS_FACES_MANIFOLD};
    for (int law = 0; law < 2; ++law)
        for (int kind = 0; kind < 6; ++kind)
        {
            double worst = 0.0;
            for (int round = 0; round < 20; ++round)
            {
                const int dimension = kind == 4 || kind == 5 ? 2 : 3;
                pls_shape *a =
                    kind == 0 || kind == 2 || kind == 4 ? solids_box(dimension, 0.5, 0.4, 0.6, 0.0) : solids_stone(dimension, 24, 0.0);
                pls_shape *b = kind == 3   ? solids_plane(3)
                               : kind == 0 ? solids_box(3, 0.6, 0.3, 0.4, 0.0)
                                           : solids_stone(dimension, 16, 0.0);
                pls_posed p, q;
                place(a, b, pow(10.0, solids_uniform(-3.5, -1.5)), &p, &q);
                worst = fmax(worst, gradient_error(&p, &q, laws[law]));
                pls_shape_free(a), pls_shape_free(b);
            }
            assert_near(worst, 0.0, 1e-6);
        }
}

// ---- the area of touch ----------------------------------------------------------------------------------------------------------------------------------

static double moment(const pls_touch *t, pls_vec3 e)
{
    const double *s = t->spread;
    return s[0] * e.x * e.x + s[1] * e.y * e.y + s[2] * e.z * e.z + 2.0 * (s[3] * e.x * e.y + s[4] * e.x * e.z + s[5] * e.y * e.z);
}

/// A rectangle of edges a, b has moments a^2/12, b^2/12 along its edges; the corners of its spread have them too.
static void the_area_of_touch_has_the_moments_of_the_face(void **state)
{
    (void)state;
    pls_shape *b = solids_box(3, 0.5, 0.3, 0.4, 0.0), *ground = solids_plane(3), *flat = solids_box(2, 0.5, 0.3, 1.0, 0.0),
              *line = solids_plane(2);
    const pls_quat turn = solids_turn(pls_vec(0, 0, 1), 0.4), lean = solids_turn(pls_unit(pls_vec(1, 2, 0)), 0.7);
    const pls_posed slope = at(ground, pls_vec(0, 0, 0), lean);
    const pls_posed p = at(b, pls_rotate(lean, pls_vec(2.0, 1.0, 0.399)), pls_quat_multiply(lean, turn));
    const pls_vec3 edge[2] = {pls_rotate(lean, pls_rotate(turn, pls_vec(1, 0, 0))), pls_rotate(lean, pls_rotate(turn, pls_vec(0, 1, 0)))};
    for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
    {
        const pls_touch t = touch_of(&p, &slope, faces, 1.0);
        assert_near(moment(&t, edge[0]), 1.0 / 12.0, 1e-11);
        assert_near(moment(&t, edge[1]), 0.36 / 12.0, 1e-11);
        assert_near(t.lever, sqrt(8.0 / 9.0 * 1.36 / 12.0), 1e-11);
        pls_vec3 corner[4];
        pls_touch_corners(&t, corner);
        for (int k = 0; k < 2; ++k)
        {
            double sum = 0.0, mixed = 0.0;
            for (int c = 0; c < 4; ++c)
                sum += 0.25 * pow(pls_dot(corner[c], edge[k]), 2.0),
                    mixed += 0.25 * pls_dot(corner[c], edge[0]) * pls_dot(corner[c], edge[1]);
            assert_near(sum, k == 0 ? 1.0 / 12.0 : 0.36 / 12.0, 1e-11);
            assert_near(mixed, 0.0, 1e-11);
            assert_near(pls_dot(corner[k], t.normal), 0.0, 1e-12);
        }
    }
    const pls_posed q = at(flat, pls_vec(0.3, 0.299, 0), pls_quat_identity()), below = at(line, pls_vec(0, 0, 0), pls_quat_identity());
    const pls_touch t = touch_of(&q, &below, PLS_FACES_MANIFOLD, 0.0);
    assert_near(t.spread[0], 1.0 / 12.0, 1e-12);
    assert_true(t.lever == 0.0 && t.spread[2] == 0.0 && t.spread[4] == 0.0 && t.spread[5] == 0.0);
    pls_shape_free(b), pls_shape_free(ground), pls_shape_free(flat), pls_shape_free(line);
}

/// A disc pressed evenly resists turning like mu N at 2/3 of its radius, a square of edge a at (sqrt 2 + asinh 1)/6 a.
static void the_lever_is_the_mean_distance_of_discs_and_squares(void **state)
{
    (void)state;
    enum { SIDES = 100 };
    pls_vec3 points[2 * SIDES];
    for (int k = 0; k < 2 * SIDES; ++k)
        points[k] = pls_vec(0.5 * cos(2.0 * M_PI * k / SIDES), 0.5 * sin(2.0 * M_PI * k / SIDES), k < SIDES ? -0.2 : 0.2);
    pls_shape *disc = solids_hull(3, points, 2 * SIDES, 0.0), *square = solids_box(3, 0.5, 0.5, 0.2, 0.0), *ground = solids_plane(3);
    const pls_posed below = at(ground, pls_vec(0, 0, 0), pls_quat_identity());
    pls_posed p = at(disc, pls_vec(0, 0, 0.199), disc->principal);
    pls_touch t = touch_of(&p, &below, PLS_FACES_MANIFOLD, 0.0);
    assert_near(t.lever, 0.5 * 2.0 / 3.0, 1e-3);
    p = at(square, pls_vec(0, 0, 0.199), pls_quat_identity());
    t = touch_of(&p, &below, PLS_FACES_MANIFOLD, 0.0);
    assert_near(t.lever / ((sqrt(2.0) + asinh(1.0)) / 6.0), 1.0, 7e-3);
    pls_shape_free(disc), pls_shape_free(square), pls_shape_free(ground);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_on_a_plane_displaces_what_is_below),
        cmocka_unit_test(a_tetrahedrons_corner_in_a_plane_and_in_a_box),
        cmocka_unit_test(a_box_in_the_middle_of_a_larger_one),
        cmocka_unit_test(caps_of_spheres_and_ellipsoids),
        cmocka_unit_test(facets_of_a_floor_add_up_to_a_plane),
        cmocka_unit_test(pairs_without_faces_are_left_alone),
        cmocka_unit_test(random_pairs_agree_with_monte_carlo),
        cmocka_unit_test(forces_are_the_gradient_of_the_energy),
        cmocka_unit_test(the_area_of_touch_has_the_moments_of_the_face),
        cmocka_unit_test(the_lever_is_the_mean_distance_of_discs_and_squares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
