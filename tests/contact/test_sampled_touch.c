// Contact by pieces of surfaces: forces are gradients of the energy, faces that lie on each other give what plane faces give, which pairs go by pieces.

#include "contact/sampled_touch.h"
#include "contact/solid_list.h"
#include "contact/touch_area.h"
#include "contact/wall_touch.h"
#include "shape/builtin.h"
#include "shape/surface_sample.h"
#include "support/numbers.h"
#include "support/solids.h"
#include "support/two_bodies.h"
#include "support/values_alone.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

static pls_shape *make(const pls_shape_ops *ops, int dimension, const double *values, size_t count)
{
    return solids_make(ops, dimension, &(pls_shape_input){.values = values, .value_count = count});
}
#define MAKE(ops, dimension, ...) make(ops, dimension, NUMBERS(__VA_ARGS__))

/// All facets of a wall touched as one, from no side.
static pls_touch wall_touch(const pls_posed *a, const pls_posed *wall, pls_faces faces)
{
    pls_wall_sum sum = pls_wall_sum_of(a);
    const pls_touch none = {.delta = 0.0};
    for (uint32_t k = 0; k < wall->shape->part_count; ++k)
    {
        const pls_posed facet = pls_posed_part(wall, k);
        assert_false(pls_wall_has_sides(a, &facet));
        pls_wall_add(&sum, &facet, pls_shape_facet(facet.shape), 1.0, &none);
    }
    pls_touch out = none;
    const pls_narrow_options options = solids_options(faces, 1.0);
    pls_wall_touch(&sum, &options, &out);
    return out;
}

static pls_touch touch(const pls_posed *a, const pls_posed *b, pls_faces faces)
{
    assert_int_equal(pls_shape_need_sample(a->shape), PLS_OK);
    if (b->shape->part_count > 0) return wall_touch(a, b, faces);
    assert_true(pls_is_sampled_pair(a->shape, b->shape));
    assert_int_equal(pls_shape_need_sample(b->shape), PLS_OK);
    return solids_touch(a, b, faces, 1.0);
}

static double energy(const pls_touch *t) { return t->delta > 0.0 ? 0.5 * t->energy_delta * t->energy_delta : 0.0; }

/// Moved by `shift` and turned about its place by `turn`.
static pls_posed moved(const pls_posed *p, pls_vec3 shift, pls_vec3 axis, double turn)
{
    const pls_quat q = solids_turn(axis, turn);
    pls_posed m = *p;
    m.position = pls_add(p->position, shift);
    m.x = pls_rotate(q, p->x), m.y = pls_rotate(q, p->y), m.z = pls_rotate(q, p->z);
    return m;
}

/// Force and torque on B about its place against differences of the energy. Pieces come into touch with no force at all, so that energies are smooth once.
static void expect_gradient(const pls_posed *a, const pls_posed *b, pls_faces faces)
{
    const double h = 1e-6 * a->size;
    const pls_touch t = touch(a, b, faces);
    const pls_vec3 force = pls_scale(t.normal, t.delta);
    const pls_vec3 torque = pls_add(pls_cross(pls_sub(t.point, b->position), force), pls_scale(force, t.twist));
    const bool plane = a->shape->dimension == 2;
    for (int axis = 0; axis < 3; ++axis)
    {
        const pls_vec3 e = pls_vec(axis == 0, axis == 1, axis == 2), still = pls_vec(0.0, 0.0, 0.0);
        if (plane && axis == 2) assert_true(force.z == 0.0);
        if (plane && axis < 2) assert_true(pls_dot(torque, e) == 0.0);
        const pls_vec3 way = pls_scale(e, plane && axis == 2 ? 0.0 : h);
        const double turn = plane && axis < 2 ? 0.0 : h / a->size;
        pls_posed low = moved(b, pls_scale(way, -1.0), e, 0.0), high = moved(b, way, e, 0.0);
        pls_touch p = touch(a, &low, faces), q = touch(a, &high, faces);
        assert_true(fabs((energy(&p) - energy(&q)) / (2.0 * h) - pls_dot(force, e)) < 2e-5 * t.delta);
        low = moved(b, still, e, -turn), high = moved(b, still, e, turn);
        p = touch(a, &low, faces), q = touch(a, &high, faces);
        assert_true(fabs((energy(&p) - energy(&q)) / (2.0 * h / a->size) - pls_dot(torque, e)) < 2e-5 * t.delta * a->size);
    }
}

static void forces_are_gradients_of_the_energy(void **state)
{
    (void)state;
    solids_seed(71);
    pls_shape *ring = MAKE(&values_ring, 3, 0.3, 0.1), *box = solids_box(3, 0.2, 0.15, 0.1, 0.0),
              *egg = MAKE(&pls_ellipsoid_shape, 3, 0.3, 0.2, 0.15, 0.0), *floor = solids_plane(3), *drum = MAKE(&values_drum, 3, 0.2, 0.2);
    const pls_shape *partner[] = {ring, box, egg, drum, floor};
    int asked = 0;
    for (int round = 0; round < 600; ++round)
    {
        const pls_shape *other = partner[round % 5];
        const pls_posed a = pls_pose(ring, pls_vec(0.1, 0.2, 0.3), solids_turn(solids_direction(3), solids_uniform(0, 6)), 1.0);
        const double reach = other == floor ? 0.35 : 0.7 * (ring->radius + other->radius);
        const pls_vec3 place = pls_add(pls_vec(0.1, 0.2, 0.3), pls_scale(solids_direction(3), solids_uniform(0.5, 1.0) * reach));
        const pls_posed b = pls_pose(other, place, solids_turn(solids_direction(3), solids_uniform(0, 6)), 1.0);
        const pls_touch t = touch(&a, &b, PLS_FACES_MANIFOLD);
        if (!(t.depth > 0.002) || t.depth > 0.05) continue; // deeper than the middle of the tube the SDF has ridges
        expect_gradient(&a, &b, round & 1 ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD);
        ++asked;
    }
    print_message("%d touches\n", asked);
    assert_true(asked > 40);
    pls_shape_free(ring), pls_shape_free(box), pls_shape_free(egg), pls_shape_free(floor), pls_shape_free(drum);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void forces_in_the_plane_are_gradients_of_the_energy(void **state)
{
    (void)state;
    solids_seed(72);
    const pls_vec3 points[5] = {{0.3, 0, 0}, {0.1, 0.25, 0}, {-0.2, 0.2, 0}, {-0.25, -0.1, 0}, {0.1, -0.3, 0}};
    pls_shape *hook = MAKE(&values_corner, 2, 0.3), *plate = solids_hull(2, points, 5, 0.0), *floor = solids_plane(2);
    const pls_shape *partner[] = {hook, plate, floor};
    int asked = 0;
    for (int round = 0; round < 300; ++round)
    {
        const pls_shape *other = partner[round % 3];
        const pls_vec3 z = pls_vec(0.0, 0.0, 1.0), place = pls_vec(0.1, 0.2, 0.0);
        const pls_posed a = pls_pose(hook, place, solids_turn(z, solids_uniform(0, 6)), 1.0);
        const double reach = other == floor ? 0.35 : 0.8 * (hook->radius + other->radius);
        const pls_posed b = pls_pose(other, pls_add(place, pls_scale(solids_direction(2), solids_uniform(0.6, 1.0) * reach)),
                                     solids_turn(z, solids_uniform(0, 6)), 1.0);
        const pls_touch t = touch(&a, &b, PLS_FACES_MANIFOLD);
        if (!(t.depth > 0.005) || t.depth > 0.05) continue;
        // Distances have edges where depths under two faces are the same: differences over one of them tell nothing.
        expect_gradient(&a, &b, round & 1 ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD);
        ++asked;
    }
    print_message("%d touches\n", asked);
    assert_true(asked > 20);
    pls_shape_free(hook), pls_shape_free(plate), pls_shape_free(floor);
}

static pls_shape *wall_of(const char *path, double rounding)
{
    const double values[] = {rounding, 1.0}; // rounding, scale
    return solids_make(&pls_mesh_shape, 3, &(pls_shape_input){VALUES(values), .path = path});
}

/// Rings of several sizes on the edges of an octahedron of size 1 and on the rims of sheets, x and y from -1 to 1, thin and thick: whatever side of the sheet parts of them are on.
static void forces_on_walls_are_gradients_of_the_energy(void **state)
{
    (void)state;
    enum { WALLS = 3 };
    solids_seed(74);
    pls_shape *ring = MAKE(&values_ring, 3, 0.3, 0.1);
    pls_shape *wall[WALLS] = {wall_of(PLS_TEST_DATA "/octahedron.obj", 0.0), wall_of(PLS_TEST_DATA "/sheet.obj", 0.0),
                              wall_of(PLS_TEST_DATA "/sheet.obj", 0.04)};
    int asked[WALLS] = {0};
    for (int round = 0; round < 5000; ++round)
    {
        const int on = round % WALLS;
        const double turned = on == 0 ? 0.4 : 0.0, grown = solids_uniform(0.7, 1.3);
        const pls_posed b = pls_pose(wall[on], pls_vec(0, 0, 0), solids_turn(pls_vec(0, 0, 1), turned), on == 0 ? 0.9 : 1.0);
        const double x = solids_uniform(-1.1, 1.1), y = solids_uniform(-1.1, 1.1);
        const pls_vec3 near_sheet = pls_vec(round & 2 ? 1.0 + 0.3 * x : x, y, solids_uniform(-0.4, 0.4));
        const pls_vec3 place = on == 0 ? pls_scale(solids_direction(3), solids_uniform(0.6, 1.3)) : near_sheet;
        const pls_posed a = pls_pose(ring, place, solids_turn(solids_direction(3), solids_uniform(0, 6)), grown);
        const pls_touch t = touch(&a, &b, PLS_FACES_MANIFOLD);
        if (!(t.depth > 0.002) || t.depth > 0.08 * grown) continue; // deeper there is the middle of the tube
        expect_gradient(&a, &b, round & 4 ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD);
        ++asked[on];
    }
    print_message("%d touches of an octahedron, %d of a sheet, %d of a thick one\n", asked[0], asked[1], asked[2]);
    for (int k = 0; k < WALLS; ++k) assert_true(asked[k] > 40), pls_shape_free(wall[k]);
    pls_shape_free(ring);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// The three quarters of a square on a polyline with free ends.
static void forces_on_polylines_are_gradients_of_the_energy(void **state)
{
    (void)state;
    solids_seed(77);
    const pls_vec3 points[3] = {{-1, 0, 0}, {0.2, 0.1, 0}, {0.9, 0.8, 0}};
    const double values[] = {0.0, 0.0}; // rounding, closed
    pls_shape *hook = MAKE(&values_corner, 2, 0.3),
              *line = solids_make(&pls_polyline_shape, 2, &(pls_shape_input){VALUES(values), .points = points, .point_count = 3});
    int asked = 0;
    for (int round = 0; round < 3000; ++round)
    {
        const pls_vec3 z = pls_vec(0.0, 0.0, 1.0), place = pls_vec(solids_uniform(-1.3, 1.2), solids_uniform(-0.4, 1.2), 0.0);
        const pls_posed a = pls_pose(hook, place, solids_turn(z, solids_uniform(0, 6)), 1.0),
                        b = pls_pose(line, pls_vec(0, 0, 0), pls_quat_identity(), 1.0);
        const pls_touch t = touch(&a, &b, PLS_FACES_VOLUME);
        if (!(t.depth > 0.005) || t.depth > 0.05) continue;
        expect_gradient(&a, &b, round & 1 ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD);
        ++asked;
    }
    print_message("%d touches\n", asked);
    assert_true(asked > 40);
    pls_shape_free(hook), pls_shape_free(line);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// Superquadrics with flat ends and sides, by their distance on a lattice.
static void forces_of_box_like_superquadrics_are_gradients_of_the_energy(void **state)
{
    (void)state;
    solids_seed(75);
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape *die = MAKE(&pls_superquadric_shape, dimension, 0.3, 0.25, 0.2, 0.2, 0.3, 0.0),
                  *box = solids_box(dimension, 0.2, 0.15, 0.1, 0.0), *floor = solids_plane(dimension);
        const pls_shape *partner[] = {die, box, floor};
        int asked = 0;
        for (int round = 0; round < 1200; ++round)
        {
            const pls_shape *other = partner[round % 3];
            const pls_vec3 z = pls_vec(0, 0, 1),
                           axis[2] = {dimension == 2 ? z : solids_direction(3), dimension == 2 ? z : solids_direction(3)};
            const pls_posed a = pls_pose(die, pls_vec(0.1, 0.2, 0.0), solids_turn(axis[0], solids_uniform(0, 6)), 1.0);
            const double reach = other == floor ? 0.3 : 0.75 * (die->radius + other->radius);
            const pls_vec3 place =
                pls_add(pls_vec(0.1, 0.2, 0.0), pls_scale(solids_direction(dimension), solids_uniform(0.6, 1.0) * reach));
            const pls_posed b = pls_pose(other, place, solids_turn(axis[1], solids_uniform(0, 6)), 1.0);
            const pls_touch t = touch(&a, &b, PLS_FACES_MANIFOLD);
            if (!(t.depth > 0.001) || t.depth > 0.04) continue;
            expect_gradient(&a, &b, round & 1 ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD);
            ++asked;
        }
        print_message("%dD: %d touches\n", dimension, asked);
        assert_true(asked > 10);
        pls_shape_free(die), pls_shape_free(box), pls_shape_free(floor);
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

/// A box known by values on a half-space and on a box of plane faces, standing on a face: the depth, its area, its middle. Balls of radius s under the plate's surface touch the box's edges
/// from up to sqrt(2 s depth) beside it: of the depths of such a rim the mean is 2/3 of the depth, that of squares 8/15, of third powers 16/35. Half of the sums is the plate's. So the energy is
/// that of e = depth N/D, N = 1 + 16/35 R, D = 1 + 8/15 R, R the rim's part, which goes with the root of the depth; delta is e times its derivative. That is 1 - 4/21 R, to which each of n pieces
/// in the rim adds its part of R with a standard deviation of sqrt(1/5 - 2/9 + 1/13), so that their sum is uncertain by 1.23/sqrt(n) of what the rim makes: the mean of many places is asked.
static void a_face_on_a_face_is_as_deep_as_it_is(void **state)
{
    (void)state;
    enum { PLACES = 64 };
    pls_shape *box = MAKE(&values_box, 3, 0.5, 0.4, 0.3, 0.0), *floor = solids_plane(3), *plate = solids_box(3, 0.7, 0.7, 0.3, 0.0);
    solids_seed(76);
    for (int on = 0; on < 2; ++on)
        for (double depth = 1e-4; depth < 0.02; depth *= 10.0)
        {
            const pls_posed ground = on == 0 ? pls_pose(floor, pls_vec(0, 0, 0), pls_quat_identity(), 1.0)
                                             : pls_pose(plate, pls_vec(0.05, 0.1, -0.3), pls_quat_identity(), 1.0);
            double mean = 0.0;
            for (int k = 0; k < PLACES; ++k)
            {
                const double x = 0.1 + solids_uniform(-0.08, 0.08), y = 0.2 + solids_uniform(-0.08, 0.08);
                const pls_posed a = pls_pose(box, pls_vec(x, y, 0.3 - depth), box->principal, 1.0);
                const pls_touch t = touch(&a, &ground, PLS_FACES_MANIFOLD), v = touch(&a, &ground, PLS_FACES_VOLUME);
                const double width = sqrt(3.76 / (double)box->sample->count);
                mean += t.delta / depth / PLACES;
                assert_true(t.normal.z < -1.0 + 1e-4 && fabs(t.depth - depth) < 1e-9);
                assert_true(hypot(t.point.x - x, t.point.y - y) < width);
                // Along the rim of the face cells of the lattice are cut across.
                assert_true(fabs(v.delta / (0.8 * depth) - 1.0) < 0.05);
                assert_true(fabs(t.spread[0] / (0.25 / 3.0) - 1.0) < 3.0 * width && fabs(t.spread[1] / (0.16 / 3.0) - 1.0) < 3.0 * width);
            }
            const double rim = on == 0 ? 0.0 : 3.6 * sqrt(2.0 * plate->sample->largest_inner * depth), R = 0.5 * rim / 0.8;
            const double N = 1.0 + 16.0 / 35.0 * R, D = 1.0 + 8.0 / 15.0 * R, by_rim = N / D * (N / D - 4.0 / 105.0 * R / (D * D));
            const double pieces = PLACES * (on == 0 ? 1.0 : rim * (double)plate->sample->count / 7.28);
            // Sides dip by the depth, and count a little; so do balls near edges, less than as large. Three standard deviations of the rim.
            assert_true(fabs(mean - by_rim) < 3.0 * depth + 3.0 * 1.23 / sqrt(pieces) * (1.0 - by_rim) + 1e-6);
        }
    pls_shape_free(box), pls_shape_free(floor), pls_shape_free(plate);
}

/// Of a ring that dips into the floor ever so little, one piece touches, or two or three: its area has no moments to speak of, or sensible ones.
static void a_few_pieces_make_a_small_area(void **state)
{
    (void)state;
    pls_shape *ring = MAKE(&values_ring, 3, 0.3, 0.1), *floor = solids_plane(3);
    const pls_posed ground = pls_pose(floor, pls_vec(0, 0, 0), pls_quat_identity(), 1.0);
    int points = 0, areas = 0;
    solids_seed(73);
    for (int k = 0; k < 400; ++k)
    {
        const pls_posed a =
            pls_pose(ring, pls_vec(0.1, 0.2, 0.4 - solids_uniform(1e-5, 2e-3)), solids_turn(solids_direction(2), 0.5 * M_PI), 1.0);
        const pls_touch t = touch(&a, &ground, PLS_FACES_MANIFOLD);
        if (!(t.delta > 0.0)) continue;
        pls_vec3 corner[4];
        pls_touch_corners(&t, corner);
        for (int c = 0; c < 4; ++c) assert_true(pls_length(corner[c]) < 0.1);
        // At points friction, dashpots and the normal force meet; there is no couple to make up for it if they do not.
        assert_true(pls_length(pls_sub(t.middle, t.point)) < (pls_touch_is_point(&t) ? 1e-15 : 0.1));
        points += pls_touch_is_point(&t), areas += !pls_touch_is_point(&t);
        assert_true(pls_touch_is_point(&t) ? t.lever == 0.0 : t.lever < 0.1);
    }
    print_message("%d points, %d areas\n", points, areas);
    assert_true(points > 10 && areas > 10);
    pls_shape_free(ring), pls_shape_free(floor);
}

/// A ring that lies on the floor touches along its crest: as deep as it is, pushed in its middle, with the moments of a circle.
static void a_ring_lies_on_its_crest(void **state)
{
    (void)state;
    pls_shape *ring = MAKE(&values_ring, 3, 0.3, 0.1), *floor = solids_plane(3);
    const pls_posed ground = pls_pose(floor, pls_vec(0, 0, 0), pls_quat_identity(), 1.0);
    for (double depth = 2e-3; depth < 0.02; depth *= 2.0)
    {
        const pls_posed a = pls_pose(ring, pls_vec(0.1, 0.2, 0.1 - depth), pls_quat_identity(), 1.0);
        const pls_touch t = touch(&a, &ground, PLS_FACES_MANIFOLD);
        // Of a parabola across the line: integral of t^3 by that of t^2 is 6/7, and so is the slope of that by the depth.
        print_message("depth %g: delta %.4f of it, off its middle by %.2g, spread %.4f\n", depth, t.delta / depth,
                      hypot(t.point.x - 0.1, t.point.y - 0.2), t.spread[0] / 0.045);
        assert_true(fabs(t.delta / (36.0 / 49.0 * depth) - 1.0) < 0.03 && fabs(t.energy_delta / (6.0 / 7.0 * depth) - 1.0) < 0.03);
        assert_true(hypot(t.point.x - 0.1, t.point.y - 0.2) < 0.01 && fabs(t.spread[0] / 0.045 - 1.0) < 0.05);
    }
    pls_shape_free(ring), pls_shape_free(floor);
}

static two_bodies_contact find(const pls_posed *a, const pls_posed *b, void *user)
{
    (void)user;
    const pls_touch t = solids_touch(a, b, PLS_FACES_MANIFOLD, 1.0);
    return (two_bodies_contact){t.delta, t.energy_delta, t.twist, t.normal, t.point};
}

/// B comes at A on a random line, both turned and spinning at random, so hard that a central impact overlaps by 2 % of the size; 800 steps per contact.
static double change_of_energy(const pls_shape *sa, const pls_shape *sb)
{
    const double size = fmin(sa->radius, sb->radius), hardest = 0.02;
    const pls_vec3 line = solids_direction(3), origin = pls_vec(0.0, 0.0, 0.0), side = pls_cross(line, solids_direction(3));
    two_bodies pair = {.find = find};
    moving_body *a = &pair.body[0], *b = &pair.body[1];
    *a = two_bodies_make(sa, origin, solids_turn(solids_direction(3), solids_uniform(0.0, 6.0)));
    *b = two_bodies_make(sb, origin, solids_turn(solids_direction(3), solids_uniform(0.0, 6.0)));
    pls_posed at_a = moving_body_pose(a), at_b;
    pls_depth depth;
    double low = 0.0, high = sa->radius + sb->radius + size;
    for (int k = 0; k < 40; ++k)
    {
        const double middle = 0.5 * (low + high);
        b->x = pls_add(pls_scale(side, 0.25 * size), pls_scale(line, middle));
        at_b = moving_body_pose(b);
        depth = solids_depth(&at_a, &at_b, NULL);
        *(depth.delta > -0.005 * size ? &low : &high) = middle;
    }
    pair.stiffness = a->mass * b->mass / (a->mass + b->mass) / (hardest * hardest * size * size);
    a->v = line;
    for (int k = 0; k < 2; ++k)
        moving_body_set_spin(&pair.body[k], pls_scale(solids_direction(3), solids_uniform(0.0, 0.5) / pair.body[k].shape->radius));
    const double dt = M_PI / 800.0 * sqrt(two_bodies_effective_mass(&pair, depth.on_a, depth.normal) / pair.stiffness);
    two_bodies_begin(&pair);
    const double before = two_bodies_energy(&pair);
    for (int k = 0, touched = 0; k < 20000 && !(touched && pair.contact.delta < -0.01 * size); ++k)
        two_bodies_step(&pair, dt), touched |= pair.contact.delta > 0.0;
    return fabs(two_bodies_energy(&pair) / before - 1.0);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Edges meet edges and corners faces, of which pieces know only by and by, and a depth below an edge has a gradient that jumps.
static void collisions_of_sharp_edges_keep_their_energy(void **state)
{
    (void)state;
    enum { PAIRS = 7, COLLISIONS = 9 };
    solids_seed(74);
    pls_shape *box = MAKE(&values_box, 3, 0.5, 0.4, 0.3, 0.0), *brick = solids_box(3, 0.4, 0.35, 0.5, 0.0),
              *drum = MAKE(&values_drum, 3, 0.4, 0.5), *can = MAKE(&pls_cylinder_shape, 3, 0.4, 0.6, 0.0),
              *die = MAKE(&pls_superquadric_shape, 3, 0.5, 0.4, 0.3, 0.2, 0.3, 0.0);
    const pls_shape *pair[PAIRS][2] = {{box, box}, {box, brick}, {box, drum}, {can, can}, {die, die}, {die, brick}, {die, can}};
    for (int p = 0; p < PAIRS; ++p)
    {
        double change[COLLISIONS];
        for (int side = 0; side < 2; ++side) assert_int_equal(pls_shape_need_sample(pair[p][side]), PLS_OK);
        for (int k = 0; k < COLLISIONS; ++k) change[k] = change_of_energy(pair[p][0], pair[p][1]);
        qsort(change, COLLISIONS, sizeof *change, by_size);
        print_message("change of energy: median %.2g, worst %.2g\n", change[COLLISIONS / 2], change[COLLISIONS - 1]);
        assert_true(change[COLLISIONS / 2] < 1e-5 && change[COLLISIONS - 1] < 2e-3);
    }
    pls_shape_free(box), pls_shape_free(brick), pls_shape_free(drum), pls_shape_free(can), pls_shape_free(die);
}

static void pairs_are_what_their_shapes_make_them(void **state)
{
    (void)state;
    pls_shape *ring = MAKE(&values_ring, 3, 0.3, 0.1), *box = MAKE(&values_box, 3, 0.5, 0.4, 0.3, 0.0), *round = MAKE(&values_ball, 3, 0.4),
              *ball = MAKE(&pls_sphere_shape, 3, 0.4), *plain = solids_box(3, 0.2, 0.2, 0.2, 0.0), *floor = solids_plane(3),
              *egg = MAKE(&pls_ellipsoid_shape, 3, 0.3, 0.2, 0.1, 0.0), *can = MAKE(&pls_cylinder_shape, 3, 0.3, 0.4, 0.0),
              *die = MAKE(&pls_superquadric_shape, 3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.0),
              *bean = MAKE(&pls_superquadric_shape, 3, 0.3, 0.3, 0.3, 0.7, 0.7, 0.0),
              *card = MAKE(&pls_superquadric_shape, 3, 0.3, 0.3, 0.07, 0.3, 0.3, 0.0);
    assert_true(pls_is_sampled_pair(can, can) && pls_is_sampled_pair(can, ring));
    assert_false(pls_is_sampled_pair(can, plain) || pls_is_sampled_pair(can, floor) || pls_is_sampled_pair(can, egg));
    assert_true(pls_is_sampled_pair(ring, ring) && pls_is_sampled_pair(ring, floor) && pls_is_sampled_pair(plain, ring));
    assert_false(pls_is_sampled_pair(ring, ball)); // one call of the SDF
    assert_true(pls_is_sampled_pair(box, floor) && pls_is_sampled_pair(box, plain) && pls_is_sampled_pair(plain, box));
    assert_false(pls_is_sampled_pair(box, egg) || pls_is_sampled_pair(round, floor) || pls_is_sampled_pair(round, box));
    assert_true(pls_is_sampled_pair(die, die) && pls_is_sampled_pair(die, plain) && pls_is_sampled_pair(floor, die) &&
                pls_is_sampled_pair(die, can));
    assert_false(pls_is_sampled_pair(bean, bean) || pls_is_sampled_pair(bean, plain) || pls_is_sampled_pair(die, egg) ||
                 pls_is_sampled_pair(die, bean) || pls_is_sampled_pair(card, plain));
    assert_false(pls_is_sampled_pair(plain, plain) || pls_is_sampled_pair(plain, floor) || pls_is_sampled_pair(egg, egg));
    pls_shape_free(ring), pls_shape_free(box), pls_shape_free(round), pls_shape_free(ball), pls_shape_free(plain), pls_shape_free(floor),
        pls_shape_free(egg), pls_shape_free(can), pls_shape_free(die), pls_shape_free(bean), pls_shape_free(card);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_are_gradients_of_the_energy),
        cmocka_unit_test(forces_in_the_plane_are_gradients_of_the_energy),
        cmocka_unit_test(forces_on_walls_are_gradients_of_the_energy),
        cmocka_unit_test(forces_on_polylines_are_gradients_of_the_energy),
        cmocka_unit_test(forces_of_box_like_superquadrics_are_gradients_of_the_energy),
        cmocka_unit_test(a_face_on_a_face_is_as_deep_as_it_is),
        cmocka_unit_test(a_few_pieces_make_a_small_area),
        cmocka_unit_test(a_ring_lies_on_its_crest),
        cmocka_unit_test(collisions_of_sharp_edges_keep_their_energy),
        cmocka_unit_test(pairs_are_what_their_shapes_make_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
