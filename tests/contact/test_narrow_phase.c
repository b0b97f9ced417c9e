// Every pair of shapes against slow oracles, on random poses and along tumbling trajectories, in short (`make prove`: in full), and what pairs do at their limits.

#include "support/values_alone.h"
#include "support/narrow_oracle.h"

#include "shape/builtin.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const pls_narrow_options by_depth = {.solver = PLS_SOLVER_DEPTH, .faces = PLS_FACES_POINT};

static bool is_slow(const char *name) { return strstr(name, "sdf-only") || strstr(name, "superquadric"); }

/// Pairs that need many SDF calls per query get fewer of them.
static void every_pair(int dimension)
{
    for (int b = 0; narrow_shape(dimension, b); ++b)
        for (int a = 0; a <= b; ++a)
        {
            const bool plane = !narrow_shape(dimension, b + 1);
            if (plane && a == b) continue;
            const bool slow = is_slow(narrow_name(dimension, a)) || is_slow(narrow_name(dimension, b));
            narrow_tally t = {0};
            narrow_random(dimension, a, b, slow ? 20 : 100, 1, 3, &t);
            narrow_tumble(dimension, a, b, 2, slow ? 60 : 200, slow ? 6 : 10, 1, 4, &t);
            if (t.wrong || t.not_finite || t.counts.failures)
                fail_msg("%s - %s in %dD: %llu of %llu wrong, by up to %.2e, %llu not finite, %llu failures", narrow_name(dimension, a),
                         narrow_name(dimension, b), dimension, (unsigned long long)t.wrong, (unsigned long long)t.checked, t.depth,
                         (unsigned long long)t.not_finite, (unsigned long long)t.counts.failures);
            assert_true(t.points < 2e-6);
        }
    narrow_free_shapes();
}

static void every_pair_in_space(void **state) { (void)state, every_pair(3); }
static void every_pair_in_the_plane(void **state) { (void)state, every_pair(2); }

static pls_shape *make(const pls_shape_ops *ops, int dimension, const double *values, size_t count)
{
    pls_shape *shape = NULL;
    const pls_shape_input input = {.values = values, .value_count = count};
    if (pls_shape_make(ops, dimension, &input, "a shape", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

static pls_touch ask(const pls_posed *a, const pls_posed *b, pls_pair_state *state)
{
    pls_narrow_counts counts = {0};
    pls_touch t;
    pls_narrow_phase(a, b, &by_depth, state, &t, &counts);
    return t;
}

static void expect_finite(const pls_touch *t)
{
    const double all[] = {t->delta, t->normal.x, t->normal.y, t->normal.z, t->point.x, t->point.y, t->point.z};
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k) assert_true(isfinite(all[k]));
    assert_true(fabs(pls_length(t->normal) - 1.0) < 1e-12);
}

/// One body in the middle of the other, turned alike: no direction is preferred, gradients vanish, simplices are flat.
static void bodies_with_one_centre(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
        for (int a = 0; narrow_shape(dimension, a + 1); ++a)
            for (int b = a; narrow_shape(dimension, b + 1); ++b)
            {
                const pls_vec3 at = pls_vec(0.1, 0.2, dimension == 2 ? 0.0 : 0.3);
                const pls_posed pa = pls_pose(narrow_shape(dimension, a), at, pls_quat_identity(), 1.0),
                                pb = pls_pose(narrow_shape(dimension, b), at, pls_quat_identity(), 0.5);
                pls_pair_state memory = {{0}};
                for (int k = 0; k < 3; ++k)
                {
                    pls_touch t = ask(&pa, &pb, &memory);
                    expect_finite(&t);
                    assert_true(t.delta > 0.0 && t.delta < 2.0 * (pa.size + pb.size));
                }
            }
    narrow_free_shapes();
}

/// Cubes: face on face, edge on edge, corner on corner, a shift along the face; depths known.
static void cubes_aligned(void **state)
{
    (void)state;
    const double half[4] = {0.5, 0.5, 0.5, 0.0};
    const struct
    {
        pls_vec3 at;
        double delta;
    } known[] = {{{1.0, 0.0, 0.0}, 0.0},      {{0.99, 0.0, 0.0}, 0.01},        {{1.01, 0.0, 0.0}, -0.01},  {{0.99, 0.3, -0.2}, 0.01},
                 {{1.0, 1.0, 0.0}, 0.0},      {{1.0, 1.0, 1.0}, 0.0},          {{0.99, 0.98, 0.97}, 0.01}, {{1.03, 1.04, 0.0}, -0.05},
                 {{0.98, 0.999, 0.0}, 0.001}, {{1.0 - 1e-13, 0.0, 0.0}, 1e-13}};
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_shape *cube = make(&pls_box_shape, dimension, COUNTED(half));
        pls_pair_state memory = {{0}};
        for (int k = 0; k < 2 * (int)(sizeof known / sizeof *known); ++k) // cold, then from each other's memory
        {
            pls_vec3 at = known[k / 2].at;
            double delta = known[k / 2].delta;
            if (dimension == 2 && at.z != 0.0) continue;
            const pls_posed a = pls_pose(cube, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0),
                            b = pls_pose(cube, at, pls_quat_identity(), 1.0);
            pls_pair_state cold = {{0}};
            pls_touch t = ask(&a, &b, k % 2 ? &memory : &cold);
            expect_finite(&t);
            assert_true(fabs(t.delta - delta) < 1e-12);
        }
        pls_shape_free(cube);
    }
}

static void spheres_at_the_same_place(void **state)
{
    (void)state;
    const double one = 1.0, other = 0.4;
    pls_shape *a = make(&pls_sphere_shape, 3, &one, 1), *b = make(&pls_sphere_shape, 3, &other, 1);
    const pls_posed pa = pls_pose(a, pls_vec(1.0, 2.0, 3.0), pls_quat_identity(), 1.0),
                    pb = pls_pose(b, pls_vec(1.0, 2.0, 3.0), pls_quat_identity(), 1.0);
    pls_pair_state memory = {{0}};
    pls_touch t = ask(&pa, &pb, &memory);
    expect_finite(&t);
    assert_true(fabs(t.delta - 1.4) < 1e-15);
    pls_shape_free(a);
    pls_shape_free(b);
}

/// The answer depends on state and poses only: after a copy of the state the same bits, and a pair far apart leaves it alone.
static void the_same_bits_from_the_same_state(void **state)
{
    (void)state;
    for (int a = 0; narrow_shape(3, a + 1); ++a)
    {
        const pls_shape *box = narrow_shape(3, 1), *other = narrow_shape(3, a);
        pls_pair_state memory = {{0}};
        for (int k = 0; k < 12; ++k)
        {
            pls_quat turn = pls_quat_unit((pls_quat){1.0, 0.01 * k, 0.02 * k, -0.03 * k});
            const pls_posed pa = pls_pose(box, pls_vec(0.0, 0.0, 0.0), turn, 1.0),
                            pb = pls_pose(other, pls_vec(0.0, 0.1, 1.1 - 0.01 * k), turn, 1.0);
            pls_pair_state copy = memory;
            pls_touch t = ask(&pa, &pb, &memory), again = ask(&pa, &pb, &copy);
            assert_memory_equal(&t, &again, sizeof t);
            assert_memory_equal(&memory, &copy, sizeof memory);
        }
    }
    narrow_free_shapes();
}

// ---- not convex -----------------------------------------------------------------------------------------------------------------------------------------------------

static const double ring = 1.0, tube = 0.25;

/// Spheres anywhere: exact. Ellipsoids and tori lying on a torus: known by symmetry.
static void a_torus(void **state)
{
    (void)state;
    const double radius = 0.3, half[4] = {0.3, 0.2, 0.15, 0.0}; // no rounding
    const double sizes[2] = {ring, tube};
    pls_shape *donut = make(&values_ring, 3, COUNTED(sizes)), *ball = make(&pls_sphere_shape, 3, &radius, 1),
              *egg = make(&pls_ellipsoid_shape, 3, COUNTED(half));
    const pls_posed lying = pls_pose(donut, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0);
    for (int k = 0; k < 40; ++k)
    {
        pls_vec3 c = pls_vec(0.05 * k - 1.0, 0.3 + 0.02 * k, 0.5 - 0.01 * k);
        const pls_posed b = pls_pose(ball, c, pls_quat_identity(), 1.0);
        pls_pair_state memory = {{0}};
        pls_touch t = ask(&lying, &b, &memory);
        expect_finite(&t);
        assert_true(fabs(t.delta - (radius - pls_shape_sdf(donut, pls_posed_own(&lying, c)))) <
                    1e-12); // its centre of mass is known by quadrature
    }
    pls_pair_state memory = {{0}}, other = {{0}};
    for (int k = 0; k < 40; ++k)
    {
        double depth = 0.02 - 0.001 * k;
        // The egg's short axis is z: it lies on top of the tube, whose crest is round along x only.
        const pls_posed b = pls_pose(egg, pls_vec(ring, 0.0, tube + half[2] - depth), pls_quat_identity(), 1.0);
        pls_touch t = ask(&lying, &b, &memory);
        assert_true(fabs(t.delta - depth) < 1e-6 && t.normal.z > 1.0 - 1e-6);
        // The other donut stands upright, its tube touching the crest from above.
        const double turn = sqrt(0.5);
        const pls_posed c = pls_pose(donut, pls_vec(ring, 0.0, tube + ring + tube - depth), (pls_quat){turn, 0.0, turn, 0.0}, 1.0);
        t = ask(&lying, &c, &other);
        expect_finite(&t);
        assert_true(fabs(t.delta - depth) < 1e-6);
    }
    pls_shape_free(donut);
    pls_shape_free(ball);
    pls_shape_free(egg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_pair_in_space),
        cmocka_unit_test(every_pair_in_the_plane),
        cmocka_unit_test(bodies_with_one_centre),
        cmocka_unit_test(cubes_aligned),
        cmocka_unit_test(spheres_at_the_same_place),
        cmocka_unit_test(the_same_bits_from_the_same_state),
        cmocka_unit_test(a_torus),
    };
    return cmocka_run_group_tests_name("narrow_phase", tests, NULL, NULL);
}
