// Features that touch, against closed forms, from normals that are a little off; and along paths on which features change, against a search without memory.

#include "contact/feature_depth.h"

#include "contact/narrow_phase.h"
#include "shape/builtin.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static pls_shape *make(const pls_shape_ops *ops, int dimension, const double *values, size_t count)
{
    pls_shape *shape = NULL;
    const pls_shape_input input = {.values = values, .value_count = count};
    if (pls_shape_make(ops, dimension, &input, "a shape", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

static pls_quat turn_about(pls_vec3 axis, double angle)
{
    const pls_vec3 a = pls_scale(pls_unit(axis), sin(0.5 * angle));
    return (pls_quat){cos(0.5 * angle), a.x, a.y, a.z};
}

static double gap_between(pls_vec3 a, pls_vec3 b) { return pls_length(pls_sub(a, b)); }

/// A pair that touches with known features: from `start`, a little off, both ways round.
static void expect(const pls_posed *a, const pls_posed *b, pls_vec3 start, double delta, pls_vec3 normal)
{
    for (int swapped = 0; swapped < 2; ++swapped)
    {
        const double sign = swapped ? -1.0 : 1.0;
        double memory[PLS_FEATURE_MEMORY] = {0.0};
        for (int again = 0; again < 2; ++again) // then with what it remembers
        {
            pls_depth d;
            assert_true(
                pls_feature_depth(swapped ? b : a, swapped ? a : b, pls_scale(pls_unit(start), sign), PLS_FEATURES_LAST_STEP, memory, &d));
            assert_true(fabs(d.delta - delta) < 1e-12);
            assert_true(gap_between(d.normal, pls_scale(normal, sign)) < 1e-9);
            assert_true(gap_between(pls_sub(d.on_a, d.on_b), pls_scale(d.normal, d.delta)) < 1e-10);
            assert_true(fabs(pls_posed_sdf(swapped ? b : a, d.on_a)) < 1e-10 && fabs(pls_posed_sdf(swapped ? a : b, d.on_b)) < 1e-10);
        }
    }
}

/// A ball as an ellipsoid: over the middle of a face, beside an edge, beside a corner of a box. Distances of points from boxes.
static void ball_at_face_edge_and_corner(void **state)
{
    (void)state;
    for (int rounded = 0; rounded < 2; ++rounded)
    {
        pls_shape *box = make(&pls_box_shape, 3, NUMBERS(0.5, 0.4, 0.3, rounded ? 0.05 : 0.0)),
                  *ball = make(&pls_ellipsoid_shape, 3, NUMBERS(0.2, 0.2, 0.2, 0.0));
        const pls_quat none = pls_quat_identity();
        const double r = rounded ? 0.05 : 0.0;
        const pls_vec3 centre[3] = {{0.1, -0.1, 0.48}, {0.61, 0.1, 0.43}, {0.6, 0.49, 0.41}};
        for (int k = 0; k < 3; ++k)
        {
            const pls_vec3 c = centre[k];
            const pls_vec3 out = pls_vec(fmax(0.0, c.x - (0.5 - r)), fmax(0.0, c.y - (0.4 - r)), fmax(0.0, c.z - (0.3 - r)));
            const pls_posed a = pls_pose(box, pls_vec(0.0, 0.0, 0.0), none, 1.0), b = pls_pose(ball, c, none, 1.0);
            expect(&a, &b, pls_add(pls_unit(out), pls_vec(0.01, -0.01, 0.01)), 0.2 + r - pls_length(out), pls_unit(out));
        }
        pls_shape_free(box), pls_shape_free(ball);
    }
}

/// Skew lines: the distance of the axes less the radii. Capsules have edges alone.
static void sides_of_cylinders(void **state)
{
    (void)state;
    pls_shape *can = make(&pls_cylinder_shape, 3, NUMBERS(0.2, 1.0, 0.0)), *pill = make(&pls_capsule_shape, 3, NUMBERS(0.1, 0.8));
    const pls_shape *second[2] = {can, pill};
    const double radius[2] = {0.2, 0.1};
    for (int k = 0; k < 2; ++k)
    {
        const pls_quat q = turn_about(pls_vec(0.0, 1.0, 0.0), 1.1);
        const double apart = 0.2 + radius[k] - 0.01;
        const pls_posed a = pls_pose(can, pls_vec(0.0, 0.0, 0.1), pls_quat_identity(), 1.0),
                        b = pls_pose(second[k], pls_vec(0.1, apart, 0.0), q, 1.0);
        expect(&a, &b, pls_vec(0.01, 1.0, 0.01), 0.01, pls_vec(0.0, 1.0, 0.0));
    }
    pls_shape_free(can), pls_shape_free(pill);
}

/// A tilted cylinder stands on a face with its rim: its lowest point is half length cos + radius sin below its centre.
static void rim_on_face(void **state)
{
    (void)state;
    pls_shape *can = make(&pls_cylinder_shape, 3, NUMBERS(0.2, 0.6, 0.0)), *box = make(&pls_box_shape, 3, NUMBERS(1.0, 1.0, 0.5, 0.0));
    const double tilt = 0.4, below = 0.3 * cos(tilt) + 0.2 * sin(tilt);
    const pls_posed a = pls_pose(box, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0),
                    b = pls_pose(can, pls_vec(0.1, 0.2, 0.5 + below - 0.003), turn_about(pls_vec(1.0, 2.0, 0.0), tilt), 1.0);
    expect(&a, &b, pls_vec(0.005, 0.0, 1.0), 0.003, pls_vec(0.0, 0.0, 1.0));
    pls_shape_free(can), pls_shape_free(box);
}

/// An edge (a capsule) all but along the end of a cylinder goes over its rim. From the point of the rim and the edge's direction: the normal is at right angles to the edge and to the rim.
static void edge_along_an_end(void **state)
{
    (void)state;
    pls_shape *can = make(&pls_cylinder_shape, 3, NUMBERS(0.5, 0.6, 0.0)), *pill = make(&pls_capsule_shape, 3, NUMBERS(0.1, 3.0));
    const double tilts[3] = {1e-3, 2e-5, 2e-7}, at = 0.7, direction = 0.2;
    for (int k = 0; k < 6; ++k)
    {
        const double tilt = tilts[k / 2], delta = k % 2 ? -2e-6 : 2e-6;
        const pls_vec3 rim = pls_vec(0.5 * cos(at), 0.5 * sin(at), 0.3), tangent = pls_vec(-sin(at), cos(at), 0.0);
        const pls_vec3 edge =
            pls_vec(cos(tilt) * cos(direction), cos(tilt) * sin(direction), -sin(tilt)); // down towards -z outwards of the rim
        const pls_vec3 n = pls_unit(pls_cross(edge, tangent)), axis = pls_vec(1.0, 0.0, 0.0);
        const pls_vec3 turning = pls_cross(axis, edge);
        const pls_quat q = turn_about(turning, atan2(pls_length(turning), pls_dot(axis, edge)));
        const pls_posed a = pls_pose(can, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0),
                        b = pls_pose(pill, pls_add(rim, pls_scale(n, 0.1 - delta)), q, 1.0);
        double memory[PLS_FEATURE_MEMORY] = {0.0};
        pls_depth d;
        assert_true(pls_feature_depth(&a, &b, pls_unit(pls_add(n, pls_vec(1e-7, -1e-7, 0.0))), PLS_FEATURES_NOW, memory, &d));
        assert_true(fabs(d.delta - delta) < 1e-13);
        assert_true(gap_between(d.normal, n) < 1e-9);
        assert_true(gap_between(d.on_a, rim) < 1e-9);
        assert_true(gap_between(pls_sub(d.on_a, d.on_b), pls_scale(d.normal, d.delta)) < 1e-14);
    }
    pls_shape_free(can), pls_shape_free(pill);
}

/// In the plane: a disc as an ellipse at a side and at a corner of a rectangle.
static void in_the_plane(void **state)
{
    (void)state;
    pls_shape *box = make(&pls_box_shape, 2, NUMBERS(0.5, 0.4, 0.1, 0.0)),
              *disc = make(&pls_ellipsoid_shape, 2, NUMBERS(0.2, 0.2, 0.2, 0.0));
    const pls_posed a = pls_pose(box, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0),
                    over = pls_pose(disc, pls_vec(0.1, 0.59, 0.0), pls_quat_identity(), 1.0),
                    beside = pls_pose(disc, pls_vec(0.6, 0.5, 0.0), pls_quat_identity(), 1.0);
    expect(&a, &over, pls_vec(0.005, 1.0, 0.0), 0.01, pls_vec(0.0, 1.0, 0.0));
    expect(&a, &beside, pls_vec(1.0, 0.98, 0.0), 0.2 - sqrt(0.02), pls_unit(pls_vec(1.0, 1.0, 0.0)));
    pls_shape_free(box), pls_shape_free(disc);
}

/// Features unlike those of now are no answer: a face along a face, an edge along a face.
static void what_is_no_point_is_refused(void **state)
{
    (void)state;
    pls_shape *box = make(&pls_box_shape, 3, NUMBERS(0.5, 0.4, 0.3, 0.0)), *can = make(&pls_cylinder_shape, 3, NUMBERS(0.2, 0.6, 0.0));
    double memory[PLS_FEATURE_MEMORY] = {0.0};
    pls_depth d;
    const pls_posed a = pls_pose(box, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0),
                    b = pls_pose(can, pls_vec(0.0, 0.0, 0.59), pls_quat_identity(), 1.0);
    assert_false(pls_feature_depth(&a, &b, pls_vec(0.0, 0.0, 1.0), PLS_FEATURES_LAST_STEP, memory, &d));
    for (int k = 0; k < PLS_FEATURE_MEMORY; ++k) assert_true(memory[k] == 0.0);
    pls_shape_free(box), pls_shape_free(can);
}

/// A box tumbles over an ellipsoid: faces, edges and corners in turn. The same as from nothing, and in far fewer iterations.
static void features_change_along_a_path(void **state)
{
    (void)state;
    enum { STEPS = 4000 };
    pls_shape *box = make(&pls_box_shape, 3, NUMBERS(0.5, 0.4, 0.3, 0.0)),
              *egg = make(&pls_ellipsoid_shape, 3, NUMBERS(0.6, 0.4, 0.3, 0.0));
    const pls_narrow_options options = {.solver = PLS_SOLVER_DEPTH, .faces = PLS_FACES_POINT};
    pls_pair_state warm = {{0.0}};
    pls_narrow_counts warm_counts = {0}, cold_counts = {0};
    int touching = 0;
    for (int k = 0; k < STEPS; ++k)
    {
        const double t = 10.0 * k / STEPS;
        const pls_vec3 up = pls_vec(0.0, 0.0, 1.0);
        const pls_posed a = pls_pose(box, pls_vec(0.0, 0.0, 0.0), turn_about(pls_vec(sin(0.7 * t), 1.0, 0.3), t), 1.0);
        pls_posed b = pls_pose(egg, pls_vec(0.1 * sin(t), 0.1, 0.0), turn_about(pls_vec(1.0, cos(t), 0.2), -0.8 * t), 1.0);
        b.position.z += pls_posed_support(&a, up).z - pls_posed_support(&b, pls_scale(up, -1.0)).z -
                        0.01 * (1.0 + sin(3.0 * t)); // overlaps of 0.02 at most
        pls_touch now, again;
        pls_pair_state cold = {{0.0}};
        pls_narrow_phase(&a, &b, &options, &warm, &now, &warm_counts);
        if (k % 10) continue;
        pls_narrow_phase(&a, &b, &options, &cold, &again, &cold_counts);
        if (again.delta < -PLS_NARROW_FAR * 0.3) continue;
        assert_true(fabs(now.delta - again.delta) < 1e-8);
        touching += again.delta > 0.0;
    }
    assert_true(touching > STEPS / 100);
    assert_int_equal(warm_counts.failures + cold_counts.failures, 0);
    assert_true(warm_counts.iterations < 4 * warm_counts.queries && cold_counts.iterations > 12 * cold_counts.queries);
    pls_shape_free(box), pls_shape_free(egg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ball_at_face_edge_and_corner),
        cmocka_unit_test(sides_of_cylinders),
        cmocka_unit_test(rim_on_face),
        cmocka_unit_test(edge_along_an_end),
        cmocka_unit_test(in_the_plane),
        cmocka_unit_test(what_is_no_point_is_refused),
        cmocka_unit_test(features_change_along_a_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
