// Pieces of surfaces: on the surface, of its area, in balls that hold them; which surfaces have flat places.

#include "shape/builtin.h"
#include "shape/surface_sample.h"
#include "support/numbers.h"
#include "support/values_alone.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

typedef struct example
{
    const pls_shape_ops *ops;
    int dimension;
    double values[4];
    double area;           ///< exact [m^2], [m]; 0: not asked
    double edges;          ///< length of its edges, across which cells cut [m]; 2D: number of corners
    double flat, flat_tol; ///< share
} example;

#define TURN (2.0 * M_PI)
static const example examples[] = {
    {&values_ball, 3, {0.7}, 2.0 * TURN * 0.49, 0.0, 0.0, 0.0},
    {&values_ring, 3, {1.0, 0.25}, TURN *TURN * 0.25, 0.0, 0.0, 0.1}, // along its crests it is as flat as a ruler
    {&values_box, 3, {0.5, 0.4, 0.3, 0.0}, 8.0 * (0.2 + 0.15 + 0.12), 8.0 * 1.2, 1.0, 0.25},
    {&values_box, 3, {0.5, 0.4, 0.3, 0.05}, 0.0, 0.0, 0.9, 0.25},
    {&values_drum, 3, {0.4, 0.5}, TURN * 0.4 * (1.0 + 0.4), 2.0 * TURN * 0.4, 1.0, 0.25},
    {&values_ball, 2, {0.7}, TURN * 0.7, 0.0, 0.0, 0.0},
    {&values_box, 2, {0.5, 0.3, 0.0, 0.0}, 3.2, 4.0, 1.0, 0.2},
    {&values_corner, 2, {0.5}, 4.0, 6.0, 1.0, 0.2},
    {&pls_capsule_shape, 3, {0.3, 0.8}, TURN * 0.3 * (0.8 + 0.6), 0.0, 0.8 / 1.4, 0.1},
};

static void pieces_make_up_the_surface(void **state)
{
    (void)state;
    for (size_t e = 0; e < sizeof examples / sizeof *examples; ++e)
    {
        const example *x = &examples[e];
        pls_shape *shape = NULL;
        const pls_shape_input input = {.values = x->values, .value_count = 4};
        if (pls_shape_make(x->ops, x->dimension, &input, "x", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
        pls_surface_sample *s;
        assert_int_equal(pls_surface_sample_make(shape, x->dimension == 2 ? 600 : 4000, &s), PLS_OK);
        double area = 0.0, off = 0.0, turned = 0.0;
        pls_vec3 closed = pls_vec(0.0, 0.0, 0.0);
        for (size_t k = 0; k < s->count; ++k)
        {
            const pls_surface_piece *p = &s->piece[k];
            area += p->area, closed = pls_add(closed, pls_scale(p->n, p->area));
            off = fmax(off, fabs(pls_shape_sdf(shape, p->x)));
            turned = fmax(turned, fabs(pls_length(p->n) - 1.0));
        }
        print_message("%s %dD: %zu pieces, area %.6g (%.6g), flat %.3f, normals add up to %.2g\n", x->ops->name, x->dimension, s->count,
                      area, x->area, s->flat, pls_length(closed) / area);
        assert_true(s->count > (x->dimension == 2 ? 300 : 3000) && s->count < (x->dimension == 2 ? 900 : 5500));
        // Of a cell that is cut across at 45 degrees 2 - sqrt(2) of its width is lost.
        const double width = x->dimension == 2 ? area / (double)s->count : sqrt(area / (double)s->count),
                     lost = 0.6 * 1.5 * width * x->edges;
        if (x->area > 0.0) assert_true(fabs(area - x->area) < 0.005 * x->area + lost);
        assert_true(off < 1e-7 * shape->size && turned < 1e-9);
        assert_true(pls_length(closed) < 1e-3 * area + 0.2 * lost);
        assert_true(fabs(s->flat - x->flat) <= x->flat_tol);
        pls_surface_sample_free(s);
        pls_shape_free(shape);
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

static void balls_hold_their_pieces_and_a_walk_meets_all(void **state)
{
    (void)state;
    pls_shape *shape = NULL;
    const double values[2] = {1.0, 0.25};
    const pls_shape_input input = {.values = values, .value_count = 2};
    assert_int_equal(pls_shape_make(&values_ring, 3, &input, "x", &shape), PLS_OK);
    const pls_surface_sample *s = shape->sample; // not convex: it has one from the start
    assert_non_null(s);
    size_t met = 0;
    for (uint32_t b = 0; b < s->balls; ++b)
    {
        const pls_surface_ball *ball = &s->ball[b];
        for (uint32_t k = ball->first; k < ball->last; ++k)
            assert_true(pls_length(pls_sub(s->piece[k].x, ball->centre)) <= ball->radius * (1.0 + 1e-12));
        assert_true(ball->next > b && ball->next <= s->balls);
        if (!ball->leaf) continue;
        assert_int_equal(ball->first, met); // leaves come in order
        met = ball->last;
        assert_int_equal(ball->next, b + 1);
    }
    assert_int_equal(met, s->count);
    assert_int_equal(s->ball[0].next, s->balls);
    pls_shape_free(shape);
}

/// Half as large as fits: half the distance from an edge of 90 degrees, half the radius of what is round. A corner piece knows itself as the union of two rectangles, whose seam is no edge.
static void inner_balls_are_half_as_large_as_fits(void **state)
{
    (void)state;
    const double box[4] = {0.5, 0.4, 0.3, 0.0}, ring[2] = {0.3, 0.1}, hook[1] = {0.5};
    const pls_shape_input input[3] = {
        {.values = box, .value_count = 4}, {.values = ring, .value_count = 2}, {.values = hook, .value_count = 1}};
    const pls_shape_ops *const ops[3] = {&values_box, &values_ring, &values_corner};
    for (int e = 0; e < 3; ++e)
    {
        pls_shape *shape = NULL;
        assert_int_equal(pls_shape_make(ops[e], e == 2 ? 2 : 3, &input[e], "x", &shape), PLS_OK);
        const pls_surface_sample *s = shape->sample;
        for (size_t k = 0; k < s->count; ++k)
        {
            const pls_surface_piece *p = &s->piece[k];
            const pls_vec3 x = p->x;
            const double gap[3] = {0.5 - fabs(x.x), 0.4 - fabs(x.y), 0.3 - fabs(x.z)};
            const double least = fmin(gap[0], fmin(gap[1], gap[2])), most = fmax(gap[0], fmax(gap[1], gap[2]));
            const double edge = gap[0] + gap[1] + gap[2] - least - most; // the other two are those to edges
            assert_true(p->inner_radius <= s->largest_inner && fabs(pls_length(pls_sub(x, p->inner)) - p->inner_radius) < 1e-9);
            if (e == 0 && edge > 0.01) assert_true(fabs(p->inner_radius / fmin(0.5 * edge, s->largest_inner) - 1.0) < 0.01);
            if (e == 1) assert_true(fabs(p->inner_radius / 0.05 - 1.0) < 0.01);
            if (e == 2 && x.x < -0.499 && fabs(x.y) < 0.25) assert_true(p->inner_radius > 0.2 * shape->size - 1e-9);
        }
        pls_shape_free(shape);
    }
}

static void a_shape_that_no_lattice_meets_is_refused(void **state)
{
    (void)state;
    pls_shape *shape = NULL;
    const double values[2] = {1.0, 1e-4};
    const pls_shape_input input = {.values = values, .value_count = 2};
    pls_status status = pls_shape_make(&values_ring, 3, &input, "shape 'wire'", &shape);
    print_message("%s\n", status == PLS_OK ? "made" : pls_last_message());
    if (status == PLS_OK) assert_true(shape->sample->count > 100);
    pls_shape_free(shape);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pieces_make_up_the_surface),
        cmocka_unit_test(balls_hold_their_pieces_and_a_walk_meets_all),
        cmocka_unit_test(inner_balls_are_half_as_large_as_fits),
        cmocka_unit_test(a_shape_that_no_lattice_meets_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
