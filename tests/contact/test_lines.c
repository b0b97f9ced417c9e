// Contact along lines: closed integrals; of lines and of cylinders: forces against the gradient of the energy, no jumps.

#include "contact/lines.h"
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

static pls_touch touch_by(const pls_posed *a, const pls_posed *b, pls_faces faces) { return solids_touch(a, b, faces, 0.3); }

static pls_touch touch_of(const pls_posed *a, const pls_posed *b) { return touch_by(a, b, PLS_FACES_MANIFOLD); }

static pls_posed at(const pls_shape *shape, pls_vec3 x, pls_quat q) { return pls_pose(shape, x, q, 1.0); }

static pls_shape *capsule(int dimension, double radius, double length)
{
    const double values[] = {radius, length};
    return solids_make(&pls_capsule_shape, dimension, &(pls_shape_input){.values = values, .value_count = sizeof values / sizeof *values});
}

static pls_posed ground_of(const pls_shape *plane) { return at(plane, pls_vec(0, 0, 0), pls_quat_identity()); }

// ---- the gradient -------------------------------------------------------------------------------------------------------------------------------------------

static double energy_of(const pls_posed *p, const pls_posed *q, pls_faces faces)
{
    const double e = touch_by(p, q, faces).energy_delta;
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
    const pls_touch t = touch_by(p, q, faces);
    const pls_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, none = {0, 0, 0};
    const double h = 1e-5 * t.depth;
    double f[3], g[3];
    for (int k = 0; k < 3; ++k)
    {
        pls_posed more = moved(q, pls_scale(axis[k], h), t.point, axis[k], 0), less = moved(q, pls_scale(axis[k], -h), t.point, axis[k], 0);
        const bool flat = p->shape->dimension == 2;
        f[k] = flat && k == 2 ? 0.0 : -(energy_of(p, &more, faces) - energy_of(p, &less, faces)) / (2 * h);
        more = moved(q, none, t.point, axis[k], h), less = moved(q, none, t.point, axis[k], -h);
        g[k] = flat && k < 2 ? 0.0 : -(energy_of(p, &more, faces) - energy_of(p, &less, faces)) / (2 * h);
    }
    const pls_vec3 F = pls_vec(f[0], f[1], f[2]), G = pls_vec(g[0], g[1], g[2]);
    const pls_vec3 rest = pls_sub(G, pls_scale(t.normal, t.delta * t.twist));
    return fmax(pls_length(pls_sub(F, pls_scale(t.normal, t.delta))), pls_length(rest)) / t.delta;
}

enum {
    CYLINDER,
    ROUNDED_CYLINDER,
    PLANE,
    BOX,
    STONE,
    CAPSULES,
    SOAPS,
    SOAP_BOX,
    SOAP_STONE,
    FLAT_BOX,
    FLAT_CAPSULES,
    FLAT_SOAPS,
    CYLINDER_BOX,
    BOX_CYLINDER,
    CYLINDER_STONE,
    KINDS
};

static bool has_cylinder(int kind) { return kind <= ROUNDED_CYLINDER || kind >= CYLINDER_BOX; }

static pls_shape *first_of(int kind)
{
    const int dimension = kind >= FLAT_BOX && kind <= FLAT_SOAPS ? 2 : 3;
    if (kind == SOAPS || kind == SOAP_BOX || kind == SOAP_STONE || kind == FLAT_SOAPS) return solids_box(dimension, 0.5, 0.4, 0.6, 0.1);
    if (kind == BOX_CYLINDER) return solids_box(3, 0.6, 0.3, 0.4, 0.0);
    if (has_cylinder(kind)) return solids_cylinder(0.3, 0.8, kind == ROUNDED_CYLINDER ? 0.1 : 0.0);
    return capsule(dimension, 0.2, 0.7);
}

static pls_shape *second_of(int kind)
{
    switch (kind)
    {
        case CYLINDER:
        case ROUNDED_CYLINDER:
        case PLANE: return solids_plane(3);
        case BOX_CYLINDER: return solids_cylinder(0.3, 0.8, 0.0);
        case CYLINDER_BOX:
        case BOX:
        case SOAP_BOX: return solids_box(3, 0.6, 0.3, 0.4, 0.0);
        case CYLINDER_STONE:
        case STONE:
        case SOAP_STONE: return solids_stone(3, 16, 0.0);
        case CAPSULES: return capsule(3, 0.15, 0.5);
        case FLAT_BOX: return solids_box(2, 0.6, 0.3, 1.0, 0.0);
        case FLAT_CAPSULES: return capsule(2, 0.15, 0.5);
        default: return solids_box(kind == FLAT_SOAPS ? 2 : 3, 0.4, 0.5, 0.3, 0.05);
    }
}

/// A at the origin, B turned at random, `depth` deep along a random line.
static void place(const pls_shape *a, const pls_shape *b, double depth, pls_posed *p, pls_posed *q)
{
    const int dimension = a->dimension;
    const pls_vec3 z = pls_vec(0, 0, 1), n = b->ops->unbounded ? pls_vec(0, 0, -1) : solids_direction(dimension);
    const pls_quat turn_a = solids_turn(dimension == 2 ? z : solids_direction(3), solids_uniform(0, 6));
    const pls_quat turn_b =
        b->ops->unbounded ? pls_quat_identity() : solids_turn(dimension == 2 ? z : solids_direction(3), solids_uniform(0, 6));
    double low = 0.0, high = 4.0;
    *p = at(a, pls_vec(0, 0, 0), turn_a);
    for (int k = 0; k < 60; ++k)
    {
        const double middle = 0.5 * (low + high);
        *q = at(b, pls_scale(n, middle), turn_b);
        *(solids_depth(p, q, NULL).delta > depth ? &low : &high) = middle;
    }
}

static void forces_are_the_gradient_of_the_energy(void **state)
{
    (void)state;
    solids_seed(11);
    for (int kind = 0; kind < KINDS; ++kind)
    {
        double worst = 0.0;
        for (int round = 0; round < 40; ++round)
        {
            pls_shape *a = first_of(kind), *b = second_of(kind);
            pls_posed p, q;
            place(a, b, pow(10.0, solids_uniform(-3.5, -1.5)), &p, &q);
            worst = fmax(worst, gradient_error(&p, &q, PLS_FACES_MANIFOLD));
            if (has_cylinder(kind)) worst = fmax(worst, gradient_error(&p, &q, PLS_FACES_VOLUME));
            pls_shape_free(a), pls_shape_free(b);
        }
        print_message("  pair %d: off by %.1e of the force\n", kind, worst);
        assert_near(worst, 0.0, 2e-6);
    }
}

// ---- known answers ----------------------------------------------------------------------------------------------------------------------------------------

/// With t from t_1 to t_2 along the line delta = 3/4 (t_2^4 - t_1^4)/(t_2^3 - t_1^3); on one end 3/4 of the depth, and the force there, at the very end.
static void a_capsule_on_a_plane(void **state)
{
    (void)state;
    const double r = 0.2, L = 0.7, depth = 3e-3;
    pls_shape *c = capsule(3, r, L), *plane = solids_plane(3);
    const pls_posed q = ground_of(plane);
    const double angle[4] = {0.0, 1e-9, 2e-3, 0.3};
    for (int k = 0; k < 4; ++k)
    {
        const double drop = L * sin(angle[k]), low = fmax(depth - drop, 0.0);
        const pls_posed p = at(c, pls_vec(0.1, 0.2, r - depth + 0.5 * drop), solids_turn(pls_vec(0, 1, 0), angle[k])); // +x down
        const pls_touch t = touch_of(&p, &q);
        const double end = 0.1 + 0.5 * L * cos(angle[k]);
        const double exact = angle[k] < 1e-6 ? depth - 0.5 * drop : 0.75 * (pow(depth, 4) - pow(low, 4)) / (pow(depth, 3) - pow(low, 3));
        assert_near(t.depth, depth, 1e-15);
        assert_near(t.energy_delta, exact, 1e-12);
        assert_vec_near(t.normal, pls_vec(0, 0, -1), 1e-14);
        assert_near(t.point.y, 0.2, 1e-14);
        if (k == 0)
        {
            assert_near(t.delta, depth, 1e-15);
            assert_near(t.weight, 1.0, 1e-12);
            assert_vec_near(t.point, pls_vec(0.1, 0.2, -0.5 * depth), 1e-12);
            assert_vec_near(t.middle, t.point, 1e-12);
            assert_near(t.spread[0], L * L / 12.0, 1e-12); // of a line, whose points are L/4 from its middle
            assert_near(t.lever, L / 4.0, 1e-12);
        }
        if (k == 3)
        {
            assert_near(t.delta, 9.0 / 16.0 * depth, 1e-14);
            assert_near(t.weight, 9.0 / 16.0, 1e-10);
            assert_near(t.point.x, end, 1e-11);
            assert_near(t.middle.x, end - 0.5 * depth / tan(angle[k]), 1e-3 * depth);
        }
    }
    pls_shape_free(c), pls_shape_free(plane);
}

/// Lying flat along what they lie on bodies know their depth (rounded boxes to a part in 10^5: edges that rise from the corners count too); where lines cross, 6/7 of it.
static void lines_that_lie_on_lines_and_faces(void **state)
{
    (void)state;
    const double depth = 1e-5, r = 0.2;
    const pls_quat none = pls_quat_identity(), across = solids_turn(pls_vec(0, 0, 1), M_PI_2);
    pls_shape *a = capsule(3, r, 0.7), *b = capsule(3, r, 0.5), *box = solids_box(3, 0.5, 0.5, 0.5, 0.0);
    pls_shape *soap = solids_box(3, 0.5, 0.4, 0.3, 0.1), *flat = capsule(2, r, 0.7), *square = solids_box(2, 0.5, 0.5, 1.0, 0.0);
    const struct
    {
        const pls_shape *upper, *lower;
        pls_quat turn;
        double height, of_depth, tolerance;
    } all[] = {
        {a, a, none, 2 * r, 1.0, 1e-6},           {a, b, across, 2 * r, 6.0 / 7.0, 1e-4}, {a, box, none, 0.5 + r, 1.0, 1e-6},
        {soap, box, across, 0.8, 1.0, 1e-5},      {soap, soap, none, 0.6, 1.0, 1e-5},     {flat, flat, none, 2 * r, 1.0, 1e-6},
        {flat, square, none, 0.5 + r, 1.0, 1e-6},
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k)
    {
        const bool flatland = all[k].upper->dimension == 2;
        const double h = all[k].height - depth;
        const pls_posed p = at(all[k].lower, pls_vec(0, 0, 0), none);
        const pls_posed q = at(all[k].upper, flatland ? pls_vec(0, h, 0) : pls_vec(0, 0, h), all[k].turn);
        const pls_touch t = touch_of(&p, &q), back = touch_of(&q, &p);
        assert_near(t.energy_delta / depth, all[k].of_depth, all[k].tolerance + 1e-3 * (all[k].of_depth < 1.0));
        assert_vec_near(t.normal, flatland ? pls_vec(0, 1, 0) : pls_vec(0, 0, 1), 1e-9);
        assert_near(back.energy_delta, t.energy_delta, 1e-12 * depth);
        assert_vec_near(back.normal, pls_scale(t.normal, -1.0), 1e-9);
        assert_near(t.point.x, 0.0, 1e-6);
    }
    pls_shape_free(a), pls_shape_free(b), pls_shape_free(box), pls_shape_free(soap), pls_shape_free(flat), pls_shape_free(square);
}

// ---- continuity ---------------------------------------------------------------------------------------------------------------------------------------------

/// Largest change of force and torque from one of `steps` to the next while a body that lies on another tilts from end to end, by the largest force.
static double largest_jump(const pls_shape *a, const pls_shape *b, double height, pls_vec3 about, pls_quat lying, int steps)
{
    const pls_posed q = ground_of(b);
    pls_vec3 last_force = {0, 0, 0}, last_torque = {0, 0, 0};
    double jump = 0.0, most = 0.0;
    for (int k = 0; k <= steps; ++k)
    {
        const pls_posed p =
            at(a, pls_vec(0.05, 0.02, height), pls_quat_multiply(solids_turn(about, 0.02 * ((double)k / steps - 0.5)), lying));
        const pls_touch t = touch_of(&p, &q);
        const pls_vec3 f = pls_scale(t.normal, fmax(t.delta, 0.0)), g = pls_add(pls_cross(t.point, f), pls_scale(f, t.twist));
        most = fmax(most, pls_length(f));
        if (k > 0) jump = fmax(jump, pls_length(pls_sub(f, last_force)) + pls_length(pls_sub(g, last_torque)));
        last_force = f, last_torque = g;
    }
    assert_true(most > 0.0);
    return jump / most;
}

/// Halved steps halve the changes: there are no jumps.
static void forces_do_not_jump_from_end_to_end(void **state)
{
    (void)state;
    pls_shape *s[] = {capsule(3, 0.2, 0.7), solids_cylinder(0.2, 0.7, 0.0), solids_box(3, 0.4, 0.3, 0.2, 0.05)};
    pls_shape *on[] = {solids_plane(3), solids_box(3, 1.0, 1.0, 1.0, 0.0)};
    const pls_quat lying = solids_turn(pls_vec(0, 1, 0), M_PI_2), none = pls_quat_identity();
    const pls_vec3 about = pls_unit(pls_vec(0.1, 1, 0));
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 2; ++j)
        {
            const double height = (j == 1) + 0.2 - 1e-3;
            const double coarse = largest_jump(s[k], on[j], height, about, k == 1 ? lying : none, 2000);
            const double fine = largest_jump(s[k], on[j], height, about, k == 1 ? lying : none, 8000);
            print_message("  body %d on %d: %.1e of the largest force at 2000 steps, %.1e at 8000\n", k, j, coarse, fine);
            assert_true(fine < 0.3 * coarse);
            assert_true(coarse < 2e-2);
        }
    for (int k = 0; k < 3; ++k) pls_shape_free(s[k]);
    for (int k = 0; k < 2; ++k) pls_shape_free(on[k]);
}

/// Where nothing lies along a line the point stands, and everywhere with PLS_FACES_POINT.
static void other_pairs_are_left_alone(void **state)
{
    (void)state;
    const double radius[] = {0.3}, axes[] = {0.3, 0.4, 0.5, 0.0};
    pls_shape *c = capsule(3, 0.2, 0.7), *soap = solids_box(3, 0.4, 0.3, 0.2, 0.05);
    pls_shape *ball = solids_make(&pls_sphere_shape, 3, &(pls_shape_input){.values = radius, .value_count = 1});
    pls_shape *egg = solids_make(&pls_ellipsoid_shape, 3, &(pls_shape_input){.values = axes, .value_count = 4});
    const pls_shape *pair[][2] = {{ball, c}, {soap, ball}, {egg, c}, {soap, egg}};
    for (size_t k = 0; k < sizeof pair / sizeof *pair; ++k)
    {
        pls_posed p, q;
        place(pair[k][0], pair[k][1], 1e-3, &p, &q);
        const pls_touch t = touch_of(&p, &q);
        assert_near(t.delta, t.depth, 0.0);
        assert_true(t.spread[0] == 0.0 && t.lever == 0.0);
    }
    pls_posed p, q;
    place(c, soap, 1e-3, &p, &q);
    assert_true(touch_by(&p, &q, PLS_FACES_POINT).delta == touch_by(&p, &q, PLS_FACES_POINT).depth);
    assert_true(touch_of(&p, &q).delta < touch_of(&p, &q).depth);
    pls_shape_free(c), pls_shape_free(soap), pls_shape_free(ball), pls_shape_free(egg);
}

/// Deeper than the rounding the cores overlap; then t goes by the nearest face from inside. Only where that changes the force may have kinks.
static void deep_overlaps_are_gradients_too(void **state)
{
    (void)state;
    solids_seed(5);
    double worst = 0.0;
    for (int round = 0; round < 40; ++round)
    {
        pls_shape *a = round % 2 ? capsule(3, 0.02, 0.7) : solids_box(3, 0.5, 0.4, 0.6, 0.01), *b = solids_box(3, 0.6, 0.3, 0.4, 0.0);
        pls_posed p, q;
        place(a, b, 0.05, &p, &q);
        worst = fmax(worst, gradient_error(&p, &q, PLS_FACES_MANIFOLD));
        pls_shape_free(a), pls_shape_free(b);
    }
    print_message("  off by %.1e of the force\n", worst);
    assert_near(worst, 0.0, 1e-4);
}

/// Where axes nearly cross next to nothing is left of a line's force, which with its couple would act far away: the deepest point stands.
static void nothing_acts_far_away(void **state)
{
    (void)state;
    pls_shape *c = capsule(2, 0.1, 0.5), *wire = capsule(2, 0.001, 2.0);
    const pls_posed a = at(c, pls_vec(0, 0, 0), pls_quat_identity());
    int points = 0;
    for (int k = 0; k < 600; ++k)
    {
        const double angle = 0.1 * (1 + k % 31), off = 0.1 * (k % 7 - 3), aside = 0.0001 * k;
        const pls_posed b = at(wire, pls_vec(aside, off, 0.0), (pls_quat){cos(0.5 * angle), 0.0, 0.0, sin(0.5 * angle)});
        const pls_touch t = touch_of(&a, &b), p = touch_by(&a, &b, PLS_FACES_POINT);
        assert_true(isfinite(t.delta) && isfinite(t.weight) && pls_length(t.point) < 1.0);
        points += t.delta > 0.0 && t.delta == p.delta;
    }
    if (points == 0 || points > 500) fail_msg("%d of 600 at a point", points);
    pls_shape_free(c), pls_shape_free(wire);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_acts_far_away),
        cmocka_unit_test(a_capsule_on_a_plane),
        cmocka_unit_test(lines_that_lie_on_lines_and_faces),
        cmocka_unit_test(forces_are_the_gradient_of_the_energy),
        cmocka_unit_test(deep_overlaps_are_gradients_too),
        cmocka_unit_test(forces_do_not_jump_from_end_to_end),
        cmocka_unit_test(other_pairs_are_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
