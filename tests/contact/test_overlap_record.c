// Records of overlaps: what is found from one that was kept is, bit for bit, what is found from scratch, on any instruction set.

#include "contact/faces.h"
#include "contact/overlap_record.h"
#include "shape/builtin.h"
#include "support/solids.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { STEPS = 400 };

typedef struct tally
{
    int touching, recorded, alone,
        changed; ///< steps; those with a record; with one that told all; that end with another one than they began with
} tally;

static pls_shape *random_shape(void)
{
    if (solids_uniform(0, 1) < 0.3) return solids_box(3, solids_uniform(0.2, 0.6), solids_uniform(0.2, 0.6), solids_uniform(0.2, 0.6), 0.0);
    return solids_stone(3, 6 + (int)solids_uniform(0, 24), 0.0);
}

/// What is left out where a record answers alone.
static void blank(pls_touch *t) { t->depth = t->reach = t->energy_delta = 0.0; }

/// The touch with the record, without, and by the record of the last step alone if that tells; all the same.
static bool ask(const pls_posed *a, const pls_posed *b, pls_faces faces, pls_overlap_record *record, int round, int step, tally *t)
{
    const pls_depth d = solids_depth(a, b, NULL);
    const pls_narrow_options options = solids_options(faces, 1.0);
    pls_touch warm, cold, alone;
    bool recorded, again;
    pls_overlap_record last = *record;
    memset(&warm, 0, sizeof warm), memset(&cold, 0, sizeof cold), memset(&alone, 0, sizeof alone);
    const bool told = pls_faces_touch_again(a, b, &options, &last, &alone);
    assert_true(pls_faces_touch(a, b, &d, &options, record, &recorded, &warm) && pls_faces_touch(a, b, &d, &options, NULL, &again, &cold));
    assert_int_equal(recorded, again);
    if (isinf(warm.energy_delta)) warm.energy_delta = cold.energy_delta; // was not asked for
    if (memcmp(&warm, &cold, sizeof warm) != 0)
        fail_msg("round %d, step %d: a record changes the overlap %.17g to %.17g", round, step, cold.delta, warm.delta);
    if (told)
    {
        assert_true(recorded);
        assert_true(isinf(alone.depth) && alone.reach >= d.delta * (1.0 - 1e-9));
        blank(&alone), blank(&warm);
        if (memcmp(&warm, &alone, sizeof warm) != 0)
            fail_msg("round %d, step %d: a record alone changes the overlap %.17g to %.17g", round, step, warm.delta, alone.delta);
    }
    t->touching += warm.delta > 0.0;
    t->recorded += recorded;
    t->alone += told;
    return warm.delta > 0.0;
}

/// B moves through A's rim and turns; now and then the record is lost.
static void tumble(const pls_posed *a, const pls_shape *shape, pls_faces faces, double pace, int round, tally *t)
{
    const pls_vec3 axis = solids_direction(3), away = solids_direction(3), along = solids_direction(3);
    const double gap = a->size + shape->radius, spin = solids_uniform(0.0, 8.0);
    pls_overlap_record record;
    memset(&record, 0, sizeof record);
    for (int step = 0; step < STEPS; ++step)
    {
        const double time = pace * step / STEPS;
        const double apart = gap * (0.95 - 0.35 * sin(M_PI * time));
        const pls_vec3 place = pls_add(pls_scale(away, apart), pls_scale(along, 0.2 * gap * time));
        const pls_posed b = pls_pose(shape, place, solids_turn(axis, spin * time), 1.0);
        pls_overlap_record before = record;
        if (step % 97 == 96) memset(&record, 0, sizeof record);
        if (!ask(a, &b, faces, &record, round, step, t)) continue;
        before.normal = record.normal;
        t->changed += memcmp(&before, &record, sizeof record) != 0;
    }
}

static void polyhedra_that_tumble_do_not_feel_records(void **state)
{
    (void)state;
    solids_seed(31);
    tally t = {0};
    for (int round = 0; round < 120; ++round)
    {
        pls_shape *s = random_shape(), *other = random_shape();
        const pls_posed a = pls_pose(s, pls_vec(0.1, 0.2, 0.3), solids_turn(solids_direction(3), solids_uniform(0, 6)), 1.0);
        tumble(&a, other, round & 1 ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD, round % 3 ? 1.0 : 0.1, round, &t);
        pls_shape_free(s), pls_shape_free(other);
    }
    print_message("%d touching, %d recorded, %d by the record alone, %d changed\n", t.touching, t.recorded, t.alone, t.changed);
    assert_true(t.touching > 10000 && t.recorded > 0.75 * t.touching && t.changed > 0.05 * t.touching && t.changed < 0.5 * t.touching);
    assert_true(t.alone > 0.5 * t.touching);
}

static void polyhedra_on_a_half_space_do_not_feel_records(void **state)
{
    (void)state;
    solids_seed(32);
    pls_shape *floor = solids_plane(3);
    tally t = {0};
    for (int round = 0; round < 40; ++round)
    {
        pls_shape *s = round % 4 ? random_shape() : solids_stone(3, 20, 0.05);
        const pls_posed wall = pls_pose(floor, pls_vec(0.1, 0.2, 0.3), solids_turn(solids_direction(3), 1.0), 1.0);
        const pls_vec3 n = pls_posed_gradient(&wall, wall.position), axis = solids_direction(3);
        pls_overlap_record record;
        memset(&record, 0, sizeof record);
        for (int step = 0; step < STEPS; ++step)
        {
            const double time = (double)step / STEPS, height = s->radius * (0.9 - 0.5 * sin(M_PI * time));
            const pls_posed a = pls_pose(s, pls_add(wall.position, pls_scale(n, height)), solids_turn(axis, 3.0 * time), 1.0);
            ask(&a, &wall, round & 1 ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD, &record, round, step, &t);
        }
        pls_shape_free(s);
    }
    pls_shape_free(floor);
    assert_true(t.touching > 5000 && t.recorded > 0.9 * t.touching && t.alone > 0.5 * t.touching);
}

/// A plate wholly below the top of a block, whose bottom is flat, or round and so of more corners than a record holds: what lies below does not matter, and neither does the way
/// it is found. Either body first.
static void a_plate_within_a_block_is_found_alike(void **state)
{
    (void)state;
    pls_vec3 points[4 + 100] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (int k = 0; k < 100; ++k)
    {
        const double height = -0.5 - 0.5 * k / 99.0, angle = 2.4 * k, radius = 1.45 * sqrt(1.0 - 0.9 * (k / 99.0) * (k / 99.0));
        points[4 + k] = pls_vec(radius * cos(angle), radius * sin(angle), height);
    }
    pls_shape *round_block = solids_hull(3, points, 104, 0.0);
    pls_vec3 corners[8];
    for (int k = 0; k < 8; ++k) corners[k] = pls_vec(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 0 : -1);
    pls_shape *block = solids_hull(3, corners, 8, 0.0), *plate = solids_box(3, 0.3, 0.2, 0.02, 0.0);
    assert_true(pls_has_record(block) && !pls_has_record(round_block));
    for (int order = 0; order < 2; ++order)
        for (int faces = 0; faces < 2; ++faces)
        {
            pls_touch touch[2];
            memset(touch, 0, sizeof touch);
            for (int k = 0; k < 2; ++k)
            {
                const pls_shape *s = k ? round_block : block;
                const pls_quat tilt = solids_turn(pls_vec(0.6, 0.8, 0.0), 0.05);
                const pls_posed b = pls_pose(s, s->mass.centre, s->principal, 1.0);
                const pls_posed p = pls_pose(plate, pls_vec(0.01, 0.02, -0.06), pls_quat_multiply(tilt, plate->principal), 1.0);
                const pls_posed *first = order ? &p : &b, *second = order ? &b : &p;
                const pls_depth d = solids_depth(first, second, NULL);
                const pls_narrow_options options = solids_options(faces ? PLS_FACES_VOLUME : PLS_FACES_MANIFOLD, 1.0);
                pls_overlap_record record;
                memset(&record, 0, sizeof record);
                assert_true(solids_faces_touch(first, second, &d, &options, &record, &touch[k]));
            }
            print_message("delta %.15g %.15g, normal z %.15g %.15g\n", touch[0].delta, touch[1].delta, touch[0].normal.z,
                          touch[1].normal.z);
            assert_true(fabs(touch[0].delta - touch[1].delta) < 1e-9 * touch[1].delta);
            assert_true(pls_length(pls_sub(touch[0].normal, touch[1].normal)) < 1e-9);
            assert_true(pls_length(pls_sub(touch[0].point, touch[1].point)) < 1e-9);
        }
    pls_shape_free(round_block), pls_shape_free(block), pls_shape_free(plate);
}

#if !defined(PLS_ISA_ONLY_GENERIC)
/// Records of one instruction set and integrals of another.
static void instruction_sets_give_the_same_bits(void **state)
{
    (void)state;
    solids_seed(33);
    int asked = 0;
    for (int round = 0; round < 400; ++round)
    {
        pls_shape *s = random_shape(), *t = random_shape();
        const pls_vec3 n = solids_direction(3);
        const pls_posed a = pls_pose(s, pls_vec(0, 0, 0), solids_turn(solids_direction(3), 2.0), 1.0);
        const pls_posed b = pls_pose(t, pls_scale(n, 0.75 * (s->radius + t->radius)), solids_turn(solids_direction(3), 4.0), 1.0);
        const pls_depth d = solids_depth(&a, &b, NULL);
        const pls_narrow_options options = solids_options(PLS_FACES_VOLUME, 1.0);
        pls_overlap_record record;
        memset(&record, 0, sizeof record);
        pls_touch touch;
        assert_true(solids_faces_touch(&a, &b, &d, &options, &record, &touch));
        if (record.known)
        {
            const pls_vec3 origin = pls_scale(pls_add(d.on_a, d.on_b), 0.5);
            const pls_record_bodies bodies = {
                .body = {&a, &b}, .start = {pls_sub(a.position, origin), pls_sub(b.position, origin)}, .margin = 1e-9};
            pls_overlap_integrals P[3];
            memset(P, 0, sizeof P);
            const int level = pls_isa_level();
            assert_true(pls_overlap_recall_v2(&bodies, &record, true, &P[0]));
            if (level > 0) assert_true(pls_overlap_recall_v3(&bodies, &record, true, &P[1]));
            if (level > 0) assert_memory_equal(&P[0], &P[1], sizeof *P);
            if (level > 1) assert_true(pls_overlap_recall_v4(&bodies, &record, true, &P[2]));
            if (level > 1) assert_memory_equal(&P[0], &P[2], sizeof *P);
            ++asked;
        }
        pls_shape_free(s), pls_shape_free(t);
    }
    assert_true(asked > 50);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polyhedra_that_tumble_do_not_feel_records),
        cmocka_unit_test(polyhedra_on_a_half_space_do_not_feel_records),
        cmocka_unit_test(a_plate_within_a_block_is_found_alike),
#if !defined(PLS_ISA_ONLY_GENERIC)
        cmocka_unit_test(instruction_sets_give_the_same_bits),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
