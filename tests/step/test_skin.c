// test_skin.c -- the skin of least work: pairs within smaller skins, and which skin is chosen for given pairs, lives of lists and times.

#include "step/skin_tuner.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { BODIES = 1000 };

#define assert_near(value, expected, tolerance) assert_true(fabs((value) - (expected)) <= (tolerance))

/// A tuner with skin 1 whose choices hold so many pairs of balls: `many` down to choice `last`, `few` in smaller ones.
static pls_skin_tuner surveyed(double many, int last, double few)
{
    pls_skin_tuner t = {.skin = 1.0, .radius = 1.0};
    for (int k = 0; k < PLS_SKIN_CHOICES; ++k) t.balls[k] = k <= last ? many : few;
    return t;
}

/// What there is when a list ends: so many pairs listed, the first `touching` of which touch, and candidates of other shapes, none of which does.
typedef struct lists
{
    size_t listed, touching, solids;
} lists;

/// A list that takes `list_seconds` and lives `lived` steps of `step_seconds` each; the skin of the next.
static double next_skin(pls_skin_tuner *t, const lists *in, double list_seconds, double step_seconds, uint64_t lived)
{
    static pls_solid_memory apart[100];
    uint8_t touch[2000] = {0};
    for (size_t k = 0; k < in->touching; ++k) touch[k / 8] = (uint8_t)(touch[k / 8] | 1u << k % 8);
    const pls_pair_list list = {.listed = in->listed, .count = sizeof touch * 8, .touch = touch};
    const pls_solid_list solids = {.count = in->solids, .memory = apart};
    const double began = t->ready, ready = began + list_seconds;
    const uint64_t step = t->ready_step;
    pls_skin_listed(t, step, began, ready);
    pls_skin_choose(t, &list, &solids, BODIES, 1.0, true, step + lived, ready + step_seconds * (double)lived);
    return t->skin;
}

static double after_two_lists(pls_skin_tuner *t, double list_seconds, double step_seconds, uint64_t lived)
{
    const lists in = {.listed = 8000};
    (void)next_skin(t, &in, list_seconds, step_seconds, lived);
    return next_skin(t, &in, list_seconds, step_seconds, lived);
}

static void pairs_within_smaller_skins_are_counted(void **state)
{
    (void)state;
    // From a ball of radius 1 at the origin, balls of radius 0.5 with gaps of -0.1, 0.5, 0.8, 0.9; the last one's image, 10 further, has 0.6. One body is no ball.
    pls_body_place place[6] = {{.radius = 1.0},           {.x = 1.4, .radius = 0.5}, {.y = 2.0, .radius = 0.5}, {.z = -2.3, .radius = 0.5},
                               {.x = 2.4, .radius = 0.5}, {.y = -7.9, .radius = 0.5}};
    pls_body_kind kind[6] = {{.flags = 0}};
    kind[2].flags = PLS_BODY_SOLID;
    const pls_bodies bodies = {.place = place, .kind = kind, .count = 6};
    const pls_domain domain = {.edge = {10.0, 10.0, 10.0}};
    pls_near_pair pair[5] = {{0, 1, {0}, 0}, {0, 2, {0}, 0}, {0, 3, {0}, 0}, {0, 4, {0}, 0}, {0, 5, {0, 1, 0}, 0}};
    const pls_near_pairs near = {.pair = pair, .count = 5};
    pls_skin_tuner t = {.skin = 1.0};
    pls_skin_survey(&t, &bodies, &domain, &near);
    // Choices: 1, 0.85, 0.7225, 0.614, 0.522, 0.444 ...
    const double balls[PLS_SKIN_CHOICES] = {4.0, 3.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
    const double solids[PLS_SKIN_CHOICES] = {1.0, 1.0, 1.0, 1.0, 1.0};
    for (int k = 0; k < PLS_SKIN_CHOICES; ++k)
    {
        assert_near(t.balls[k], balls[k], 0.0);
        assert_near(t.solids[k], solids[k], 0.0);
    }
}

static void the_first_skin_is_a_part_of_the_radius(void **state)
{
    (void)state;
    const pls_pair_list list = {.listed = 0};
    const pls_solid_list solids = {.count = 0};
    pls_skin_tuner t = {.skin = 0.0};
    pls_skin_choose(&t, &list, &solids, BODIES, 0.5, false, 0, 0.0);
    assert_near(t.skin, 0.15, 1e-15);
}

static void a_shell_of_neighbours_is_left_out_where_lists_cost_little(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(8000.0, 3, 6000.0);
    assert_near(after_two_lists(&t, 1.0, 1.0, 1000), 0.85 * 0.85 * 0.85 * 0.85, 1e-12); // the largest without it
}

static void dear_lists_get_larger_skins(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 50), 1.25, 1e-12);
}

static void lists_that_cost_little_keep_their_skin(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 5000), 1.0, 0.0);
}

/// 100 idle pairs more are 30 units of work where those that touch are picked, but 100 where whole vectors are worked on. What needs to be done are 3000 units and those that touch;
/// lists take 1 % of it all, with the smaller skin 18 % more of that; and a change has to gain 1 %.
static void idle_pairs_count_more_among_pairs_that_touch(void **state)
{
    (void)state;
    const lists sparse = {.listed = 4100, .touching = 0}, dense = {.listed = 4100, .touching = 4000};
    pls_skin_tuner t = surveyed(4100.0, 0, 4000.0);
    (void)next_skin(&t, &sparse, 10.0, 1.0, 1000);
    assert_near(next_skin(&t, &sparse, 10.0, 1.0, 1000), 1.0, 0.0);
    t = surveyed(4100.0, 0, 4000.0);
    (void)next_skin(&t, &dense, 10.0, 1.0, 1000);
    assert_near(next_skin(&t, &dense, 10.0, 1.0, 1000), 0.85, 1e-12);
}

/// Of 100 candidates a half is further away than 0.85: 500 units of 3000.
static void idle_pairs_of_other_shapes_count_by_their_candidates(void **state)
{
    (void)state;
    const lists in = {.listed = 0, .solids = 100};
    pls_skin_tuner t = surveyed(0.0, 0, 0.0);
    for (int k = 0; k < PLS_SKIN_CHOICES; ++k) t.solids[k] = k == 0 ? 8.0 : 4.0; // pairs of bodies
    (void)next_skin(&t, &in, 1.0, 1.0, 1000);
    assert_near(next_skin(&t, &in, 1.0, 1.0, 1000), 0.85, 1e-12);
}

/// A lattice whose second shell lies just outside: it is entered once in a while, noticed by the first list, and each time it takes twice as long until it is tried again.
static void what_was_too_large_is_tried_again_ever_later(void **state)
{
    (void)state;
    const lists in = {.listed = 8000};
    pls_skin_tuner t = surveyed(0.0, 0, 0.0);
    size_t waited[4] = {0};
    for (int k = 0; k < 4; ++k)
    {
        while (next_skin(&t, &in, 20.0, 1.0, 100) <= 1.0) ++waited[k];
        assert_near(t.skin, 1.25, 1e-12);
        t.balls[0] = 8000.0; // and none in the next smaller choice
        assert_near(next_skin(&t, &in, 20.0, 1.0, 125), 1.25 * 0.85, 1e-12);
        t.balls[0] = 0.0;
        t.skin = 1.0;
    }
    assert_int_equal(waited[0], 1);
    assert_int_equal(waited[1], 2 * 16 + 1);
    assert_int_equal(waited[2], 2 * 32 + 1);
    assert_int_equal(waited[3], 2 * 64 + 1);
}

/// A machine that turns three times slower while lists are made or between them changes nothing: with what a list costs then, 6 % and 0.7 %, another skin would pay.
static void slow_hours_do_not_count(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(200.0, 0, 50.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 1000), 1.0, 0.0);
    assert_near(after_two_lists(&t, 60.0, 1.0, 1000), 1.0, 0.0);
    assert_near(after_two_lists(&t, 20.0, 3.0, 1000), 1.0, 0.0);
    pls_skin_tuner slow = surveyed(200.0, 0, 50.0), quick = slow;
    assert_near(after_two_lists(&slow, 60.0, 1.0, 1000), 1.25, 1e-12);
    assert_near(after_two_lists(&quick, 20.0, 3.0, 1000), 0.85, 1e-12);
}

/// What is slow for good is believed by and by.
static void slow_machines_are_believed(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 1000), 1.0, 0.0);
    for (int k = 0; k < 20; ++k) (void)after_two_lists(&t, 60.0, 1.0, 1000);
    assert_true(t.skin > 1.0);
}

/// Grains a thousand times smaller than the one body there was: the skin must not stay, or all pairs would be listed, in a list that never wears out.
static void another_world_begins_anew(void **state)
{
    (void)state;
    const pls_pair_list list = {.listed = 0};
    const pls_solid_list solids = {.count = 0};
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    pls_skin_listed(&t, 0, 0.0, 1e-5);
    pls_skin_choose(&t, &list, &solids, BODIES, 1e-3, false, 0, 1.0);
    assert_near(t.skin, 0.3e-3, 1e-18);
    assert_near(t.list_seconds, 0.0, 0.0);
    // The same bodies, listed for more threads, keep theirs.
    t.skin = 0.5e-3;
    pls_skin_choose(&t, &list, &solids, BODIES, 1e-3, false, 0, 1.0);
    assert_near(t.skin, 0.5e-3, 0.0);
}

static void skins_stay_within_bounds(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    for (int k = 0; k < 50; ++k) (void)after_two_lists(&t, 20.0, 1.0, 2);
    assert_near(t.skin, 1.5, 0.0); // of the radius
    for (int k = 0; k < 50; ++k)
    {
        for (int c = 0; c < PLS_SKIN_CHOICES; ++c) t.balls[c] = 8000.0 / (c + 1);
        (void)after_two_lists(&t, 1e-3, 1.0, 1000);
    }
    assert_near(t.skin, 0.02, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_within_smaller_skins_are_counted),
        cmocka_unit_test(the_first_skin_is_a_part_of_the_radius),
        cmocka_unit_test(a_shell_of_neighbours_is_left_out_where_lists_cost_little),
        cmocka_unit_test(dear_lists_get_larger_skins),
        cmocka_unit_test(lists_that_cost_little_keep_their_skin),
        cmocka_unit_test(idle_pairs_count_more_among_pairs_that_touch),
        cmocka_unit_test(idle_pairs_of_other_shapes_count_by_their_candidates),
        cmocka_unit_test(what_was_too_large_is_tried_again_ever_later),
        cmocka_unit_test(slow_hours_do_not_count),
        cmocka_unit_test(slow_machines_are_believed),
        cmocka_unit_test(another_world_begins_anew),
        cmocka_unit_test(skins_stay_within_bounds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
