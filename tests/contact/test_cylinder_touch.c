// A cylinder on half-spaces, walls and bodies of plane faces: closed integrals, a prism of many sides, wide faces as half-spaces, and edges and corners by counting points.

#include "contact/touch_area.h"
#include "shape/builtin.h"
#include "support/near.h"
#include "support/solids.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

static const double area = 0.3;

static pls_touch touch_by(const pls_posed *a, const pls_posed *b, pls_faces faces) { return solids_touch(a, b, faces, area); }

static pls_posed at(const pls_shape *shape, pls_vec3 x, pls_quat q) { return pls_pose(shape, x, q, 1.0); }

static pls_posed ground_of(const pls_shape *plane) { return at(plane, pls_vec(0, 0, 0), pls_quat_identity()); }

static void assert_same(const pls_touch *t, const pls_touch *u, double depth, double tolerance)
{
    assert_near(t->delta / u->delta, 1.0, tolerance);
    assert_near(t->energy_delta / u->energy_delta, 1.0, tolerance);
    assert_near(t->weight / u->weight, 1.0, tolerance / depth);
    assert_vec_near(t->normal, u->normal, tolerance);
    assert_vec_near(t->point, u->point, tolerance);
    assert_vec_near(t->middle, u->middle, tolerance);
    assert_near(t->twist, u->twist, tolerance);
    assert_near(t->lever, u->lever, tolerance);
    for (int k = 0; k < 6; ++k) assert_near(t->spread[k], u->spread[k], tolerance);
}

/// Height of the origin at which a body just touches the ground.
static double depth_below_origin(const pls_posed *p, const pls_posed *ground)
{
    return p->position.z + solids_depth(p, ground, NULL).delta;
}

/// Lying: V = L times the circular segment. Standing: a disc. Both with the known place, spread, and lever.
static void a_cylinder_lies_and_stands(void **state)
{
    (void)state;
    const double R = 0.3, L = 0.8, depth = 2e-3, A0 = 0.3, c = depth / R;
    pls_shape *s[2] = {solids_cylinder(R, L, 0.0), solids_cylinder(R, L, 0.1)}, *plane = solids_plane(3);
    const pls_posed q = ground_of(plane);
    for (int k = 0; k < 2; ++k) // of a rounded one the core
    {
        const double core = R - 0.1 * k, straight = L - 0.2 * k, deep = depth / core;
        const pls_posed lies = at(s[k], pls_vec(0.1, 0.2, R - depth), solids_turn(pls_vec(0, 1, 0), M_PI_2));
        const pls_touch v = touch_by(&lies, &q, PLS_FACES_VOLUME), m = touch_by(&lies, &q, PLS_FACES_MANIFOLD);
        const double angle = acos(1.0 - deep), segment = core * core * (angle - (1.0 - deep) * sin(angle));
        assert_near(v.delta / (segment * straight / A0), 1.0, 1e-9);
        assert_near(v.weight / (2.0 * core * sin(angle) * straight / A0), 1.0, 1e-6);
        assert_near(m.energy_delta / depth, 6.0 / 7.0, c);
        assert_vec_near(m.point, pls_vec(0.1, 0.2, -0.5 * depth), 1e-12);
        assert_vec_near(m.middle, m.point, 1e-12);
        assert_near(m.spread[0], straight * straight / 12.0, 1e-12);
        assert_near(m.lever, straight / 4.0, 0.02 * straight);
        const pls_posed stands = at(s[k], pls_vec(0.1, 0.2, 0.5 * L - depth), solids_turn(pls_vec(0, 0, 1), 0.3));
        const pls_touch w = touch_by(&stands, &q, PLS_FACES_VOLUME), n = touch_by(&stands, &q, PLS_FACES_MANIFOLD);
        assert_near(w.delta / (M_PI * core * core * depth / A0), 1.0, 1e-12);
        assert_near(n.delta / depth, 1.0, 1e-12);
        assert_near(n.weight, 1.0, 1e-10);
        assert_vec_near(n.point, pls_vec(0.1, 0.2, -0.5 * depth), 1e-10);
        assert_near(n.spread[0], 0.25 * core * core, 1e-10);
        assert_near(n.lever, 2.0 / 3.0 * core, 1e-10);
        const pls_posed leans = at(s[k], pls_vec(0, 0, 0), solids_turn(pls_vec(0, 1, 0), 0.7));
        pls_posed on_rim = leans;
        on_rim.position.z = depth_below_origin(&leans, &q) - 1e-6;
        assert_near(touch_by(&on_rim, &q, PLS_FACES_MANIFOLD).energy_delta / 1e-6, 2.0 / 3.0, 1e-4);
    }
    pls_shape_free(s[0]), pls_shape_free(s[1]), pls_shape_free(plane);
}

static double moment(const pls_touch *t, pls_vec3 e)
{
    const double *s = t->spread;
    return s[0] * e.x * e.x + s[1] * e.y * e.y + s[2] * e.z * e.z + 2.0 * (s[3] * e.x * e.y + s[4] * e.x * e.z + s[5] * e.y * e.z);
}

/// The laws of faces of a prism of 120 sides, whose circle has the cylinder's area.
static void a_cylinder_is_a_prism_of_many_sides(void **state)
{
    (void)state;
    enum { SIDES = 120 };
    const double R = 0.3, L = 0.8, step = 2.0 * M_PI / SIDES, outer = R * sqrt(step / sin(step));
    pls_vec3 corner[2 * SIDES];
    for (int k = 0; k < 2 * SIDES; ++k)
        corner[k] = pls_vec(outer * cos(k / 2 * step), outer * sin(k / 2 * step), k % 2 ? -0.5 * L : 0.5 * L);
    pls_shape *round = solids_cylinder(R, L, 0.0), *prism = solids_hull(3, corner, 2 * SIDES, 0.0), *plane = solids_plane(3);
    const pls_posed q = ground_of(plane);
    for (int k = 0; k <= 16; ++k)
    {
        const double lean = k * M_PI / 16.0, deep = 0.03;
        const pls_quat turn = pls_quat_multiply(solids_turn(pls_vec(0.6, 0.8, 0), lean), solids_turn(pls_vec(0, 0, 1), 0.2));
        pls_posed p = at(round, pls_vec(0.1, 0.2, 0), turn), o = at(prism, pls_vec(0.1, 0.2, 0), turn);
        p.position.z = o.position.z = depth_below_origin(&p, &q) - deep;
        for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
        {
            const pls_touch t = touch_by(&p, &q, faces), u = touch_by(&o, &q, faces);
            assert_near(t.delta / u.delta, 1.0, 1e-2);
            assert_near(t.energy_delta / u.energy_delta, 1.0, 5e-3);
            assert_near(t.weight / u.weight, 1.0, 2e-2);
            assert_vec_near(pls_vec(t.point.x, t.point.y, 0), pls_vec(u.point.x, u.point.y, 0), 2e-3);
            assert_vec_near(pls_vec(t.middle.x, t.middle.y, 0), pls_vec(u.middle.x, u.middle.y, 0), 2e-3);
            // Of what a cylinder does about its own axis dashpots see nothing: across the lean its moment counts by the cosine's square.
            const double share[2] = {1.0, cos(lean) * cos(lean)};
            const pls_vec3 across[2] = {{0.8, -0.6, 0}, {0.6, 0.8, 0}};
            for (int c = 0; c < 2; ++c) assert_near(moment(&t, across[c]), share[c] * moment(&u, across[c]), 1e-3);
        }
    }
    pls_shape_free(round), pls_shape_free(prism), pls_shape_free(plane);
}

/// Standing, lying, on its rim and between, on one wide face of a box in place of a half-space; and the box on the cylinder.
static void a_wide_face_is_a_half_space(void **state)
{
    (void)state;
    solids_seed(3);
    pls_shape *can = solids_cylinder(0.3, 0.8, 0.0), *slab = solids_box(3, 2.0, 2.5, 0.5, 0.0), *plane = solids_plane(3);
    const pls_posed ground = ground_of(plane), box = at(slab, pls_vec(0.1, 0.2, -0.5), solids_turn(pls_vec(0, 0, 1), 0.3));
    for (int round = 0; round < 60; ++round)
    {
        static const double lean[4] = {0.0, M_PI_2, 1e-9, 1e-3};
        const double angle = round % 5 < 4 ? lean[round % 5] : solids_uniform(0.0, M_PI), deep = pow(10.0, solids_uniform(-5.0, -1.0));
        const pls_vec3 axis = pls_unit(pls_vec(solids_uniform(-1, 1), solids_uniform(-1, 1), 0));
        const pls_quat turn = pls_quat_multiply(solids_turn(axis, angle), solids_turn(pls_vec(0, 0, 1), solids_uniform(0, 6)));
        pls_posed p = at(can, pls_vec(solids_uniform(-0.2, 0.2), 0.1, 0), turn);
        p.position.z = depth_below_origin(&p, &ground) - deep;
        for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
        {
            const pls_touch t = touch_by(&p, &ground, faces), u = touch_by(&p, &box, faces);
            pls_touch back = touch_by(&box, &p, faces);
            back.normal = pls_scale(back.normal, -1.0);
            assert_same(&u, &t, deep, 1e-9);
            assert_same(&back, &t, deep, 1e-9);
        }
    }
    pls_shape_free(can), pls_shape_free(slab), pls_shape_free(plane);
}

/// A floor of pieces, wherever its seams are, also under a rounded cylinder.
static void facets_of_a_floor_add_up_to_a_plane(void **state)
{
    (void)state;
    solids_seed(5);
    FILE *f = fopen("cylinder_floor.obj", "w");
    assert_non_null(f);
    fputs("v -3 -3 0\nv 3 -2.5 0\nv 2.8 3 0\nv -2.9 3.1 0\nv 0.05 -0.02 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n", f);
    assert_int_equal(fclose(f), 0);
    const double values[] = {0.0, 1.0};
    pls_shape *plane = solids_plane(3),
              *floor = solids_make(
                  &pls_mesh_shape, 3,
                  &(pls_shape_input){.values = values, .value_count = sizeof values / sizeof *values, .path = "cylinder_floor.obj"});
    const pls_posed ground = ground_of(plane);
    for (int round = 0; round < 20; ++round)
    {
        pls_shape *can = solids_cylinder(0.3, 0.8, round & 4 ? 0.05 : 0.0);
        const double angle = round % 4 == 0 ? 0.0 : round % 4 == 1 ? M_PI_2 : solids_uniform(0, 6);
        pls_posed p =
            at(can, pls_vec(solids_uniform(-0.2, 0.2), 0.0, 0.0), solids_turn(pls_unit(pls_vec(1, solids_uniform(-1, 1), 0)), angle));
        p.position.z = depth_below_origin(&p, &ground) - 0.02;
        pls_vec3 F = {0, 0, 0}, T = F, F0 = F, T0 = F;
        double U = 0.0, U0 = 0.0;
        solids_add_wrench(&p, &ground, &F0, &T0, &U0);
        size_t count = 0;
        const pls_shape_part *part = floor->ops->parts(floor, &count);
        assert_int_equal(count, 4);
        for (size_t k = 0; k < count; ++k)
        {
            const pls_posed piece = at(part[k].shape, part[k].position, part[k].orientation);
            solids_add_wrench(&p, &piece, &F, &T, &U);
        }
        assert_true(pls_length(F0) > 1e-6);
        assert_vec_near(F, F0, 1e-11);
        assert_vec_near(T, T0, 1e-11);
        assert_near(U, U0, 1e-12);
        pls_shape_free(can);
    }
    pls_shape_free(floor), pls_shape_free(plane);
}

/// Integrals of d and d^2, d the depth in b, over the points of a grid in the cylinder.
static void count_points(const pls_posed *a, const pls_posed *b, double radius, double half, double integral[2])
{
    enum { SIDE = 150 };
    integral[0] = integral[1] = 0.0;
    for (int k = 0; k < SIDE * SIDE * SIDE; ++k)
    {
        const double x = radius * (2.0 * (k % SIDE + 0.5) / SIDE - 1.0), y = radius * (2.0 * (k / SIDE % SIDE + 0.5) / SIDE - 1.0),
                     z = half * (2.0 * (k / (SIDE * SIDE) + 0.5) / SIDE - 1.0);
        if (x * x + y * y >= radius * radius) continue;
        const double d = -pls_posed_sdf(b, pls_posed_world(a, pls_vec(x, y, z)));
        if (d > 0.0) integral[0] += d, integral[1] += d * d;
    }
    const double cell = 8.0 * radius * radius * half / ((double)SIDE * SIDE * SIDE);
    integral[0] *= cell, integral[1] *= cell;
}

/// Energies of overlaps with edges and corners, a can over the rim of a slab, and stones of many faces.
static void energies_are_those_of_the_points_of_the_overlap(void **state)
{
    (void)state;
    solids_seed(8);
    const double radius = 0.3, half = 0.4;
    double worst = 0.0;
    for (int round = 0; round < 15; ++round)
    {
        pls_shape *can = solids_cylinder(radius, 2.0 * half, 0.0);
        pls_shape *other = round % 3 == 2 ? solids_stone(3, 14, 0.0) : solids_box(3, 0.5, 0.35, 0.4, 0.0);
        const pls_vec3 n = round % 3 == 0 ? pls_vec(0, 0, 1) : solids_direction(3);
        const pls_vec3 aside = round % 3 == 0 ? pls_vec(solids_uniform(-0.6, 0.6), solids_uniform(-0.5, 0.5), 0) : pls_vec(0, 0, 0);
        const pls_posed a = at(can, aside, round % 3 == 0 ? solids_turn(pls_vec(1, 0, 0), solids_uniform(0, 0.1)) : pls_quat_identity());
        pls_posed b = at(other, pls_vec(0, 0, 0), solids_turn(solids_direction(3), round % 3 == 0 ? 0.0 : solids_uniform(0, 6)));
        double low = -3.0, high = 0.0; // along n: just apart, and deep
        for (int k = 0; k < 60; ++k)
        {
            const double middle = 0.5 * (low + high);
            b.position = pls_scale(n, middle);
            *(solids_depth(&a, &b, NULL).delta > 0.1 ? &high : &low) = middle;
        }
        double integral[2];
        count_points(&a, &b, radius, half, integral);
        const pls_touch v = touch_by(&a, &b, PLS_FACES_VOLUME), m = touch_by(&a, &b, PLS_FACES_MANIFOLD);
        assert_true(v.depth > 0.09);
        const double energy = 0.5 * v.energy_delta * v.energy_delta * area;
        worst = fmax(worst, fmax(fabs(energy / integral[0] - 1.0), fabs(m.energy_delta / (1.5 * integral[1] / integral[0]) - 1.0)));
        pls_shape_free(can), pls_shape_free(other);
    }
    print_message("  off by %.1e at most\n", worst);
    assert_near(worst, 0.0, 1e-2);
}

/// A pyramid whose top, where many faces meet, stands in a cylinder's end or side: forces are the gradient of the energy, and the top is one place, not one per three faces.
static void a_top_of_many_faces(void **state)
{
    (void)state;
    enum { SIDES = 24 };
    pls_vec3 corner[SIDES + 1];
    for (int k = 0; k < SIDES; ++k) corner[k] = pls_vec(0.5 * cos(2.0 * M_PI * k / SIDES), 0.5 * sin(2.0 * M_PI * k / SIDES), -0.3);
    corner[SIDES] = pls_vec(0.0, 0.0, 0.2);
    pls_shape *can = solids_cylinder(0.3, 0.8, 0.0), *pyramid = solids_hull(3, corner, SIDES + 1, 0.0);
    assert_true(pyramid->polytope->face_count == SIDES + 1);
    for (int lying = 0; lying < 2; ++lying)
    {
        const double deep = 0.02, up = 0.2 + (lying ? 0.3 : 0.4) - deep, h = 1e-5 * deep;
        const pls_quat turn = lying ? solids_turn(pls_vec(0, 1, 0), M_PI_2) : solids_turn(pls_vec(1, 0, 0), 0.05);
        const pls_posed q = at(pyramid, pls_vec(0, 0, 0), pls_quat_identity());
        for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
        {
            double energy[2];
            for (int k = 0; k < 2; ++k)
            {
                const pls_posed p = at(can, pls_vec(0.01, 0.02, up + (k ? h : -h)), turn);
                energy[k] = 0.5 * pow(touch_by(&p, &q, faces).energy_delta, 2);
            }
            const pls_posed p = at(can, pls_vec(0.01, 0.02, up), turn);
            const pls_touch t = touch_by(&p, &q, faces);
            assert_true(t.delta > 0.0 && t.depth > 0.5 * deep);
            assert_near(-t.delta * t.normal.z / ((energy[0] - energy[1]) / (2.0 * h)), 1.0, 1e-6);
        }
    }
    pls_shape_free(can), pls_shape_free(pyramid);
}

/// Rounded cylinders and rounded boxes touch at a point, and all do when that is what is asked for.
static void other_pairs_are_left_alone(void **state)
{
    (void)state;
    pls_shape *can = solids_cylinder(0.3, 0.8, 0.0), *round = solids_cylinder(0.3, 0.8, 0.1), *box = solids_box(3, 1.0, 1.0, 0.5, 0.0),
              *soap = solids_box(3, 1.0, 1.0, 0.5, 0.1);
    const pls_shape *pair[][2] = {{round, box}, {can, soap}, {can, can}, {can, box}};
    for (int k = 0; k < 4; ++k)
    {
        const pls_posed p = at(pair[k][0], pls_vec(0, 0, 0.5 + 0.4 - 1e-3), pls_quat_identity()),
                        q = at(pair[k][1], pls_vec(0, 0, k == 2 ? 0.1 : 0.0), pls_quat_identity());
        const pls_touch t = touch_by(&p, &q, k >= 2 ? PLS_FACES_POINT : PLS_FACES_MANIFOLD);
        assert_near(t.delta, 1e-3, 1e-9);
        assert_true(pls_touch_is_point(&t));
    }
    pls_shape_free(can), pls_shape_free(round), pls_shape_free(box), pls_shape_free(soap);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cylinder_lies_and_stands),
        cmocka_unit_test(a_cylinder_is_a_prism_of_many_sides),
        cmocka_unit_test(a_wide_face_is_a_half_space),
        cmocka_unit_test(facets_of_a_floor_add_up_to_a_plane),
        cmocka_unit_test(energies_are_those_of_the_points_of_the_overlap),
        cmocka_unit_test(a_top_of_many_faces),
        cmocka_unit_test(other_pairs_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
