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
    pls_skin_tuner t = {.skin = 1.0};
    for (int k = 0; k < PLS_SKIN_CHOICES; ++k) t.balls[k] = k <= last ? many : few;
    return t;
}

/// Two lists that take `list_seconds` each and live `lived` steps of `step_seconds`, none of whose pairs touches; the skin then.
static double after_two_lists(pls_skin_tuner *t, double list_seconds, double step_seconds, uint64_t lived, bool worn_out)
{
    const pls_pair_list list = {.listed = 8000};
    const pls_solid_list solids = {.count = 0};
    double now = 100.0;
    uint64_t step = t->ready_step;
    for (int k = 0; k < 2; ++k)
    {
        const double began = now;
        now += list_seconds;
        pls_skin_listed(t, step, began, now);
        step += lived;
        now += step_seconds * (double)lived;
        pls_skin_choose(t, &list, &solids, BODIES, 1.0, worn_out, step, now);
    }
    return t->skin;
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
    assert_near(after_two_lists(&t, 1.0, 1.0, 1000, true), 0.85 * 0.85 * 0.85 * 0.85, 1e-12); // the largest without it
}

static void dear_lists_get_larger_skins(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 50, true), 1.25, 1e-12);
}

static void lists_that_cost_little_keep_their_skin(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 5000, true), 1.0, 0.0);
}

/// A lattice whose second shell lies between 0.85 and 1: a skin that has crossed it comes back at once and stays for a while, though lists cost something.
static void what_was_too_large_is_not_tried_again_soon(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(8000.0, 0, 0.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 100, true), 0.85, 1e-12);
    for (int k = 0; k < 16; ++k)
    {
        t.balls[0] = 0.0; // all of them are outside now
        assert_near(after_two_lists(&t, 20.0, 1.0, 100, true), 0.85, 1e-12);
    }
    assert_near(after_two_lists(&t, 20.0, 1.0, 100, true), 0.85 * 1.25, 1e-12);
}

/// A machine that turns three times slower between one list and the next changes nothing.
static void slow_hours_do_not_count(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 1000, true), 1.0, 0.0); // 2 % of lists: not worth a change
    assert_near(after_two_lists(&t, 60.0, 1.0, 1000, true), 1.0, 0.0);
    assert_near(after_two_lists(&t, 20.0, 3.0, 1000, true), 1.0, 0.0);
    // What is slow for good is noticed by and by.
    for (int k = 0; k < 20; ++k) (void)after_two_lists(&t, 60.0, 1.0, 1000, true);
    assert_true(t.skin > 1.0);
}

static void lists_that_were_thrown_away_tell_nothing(void **state)
{
    (void)state;
    pls_skin_tuner t = surveyed(100.0, PLS_SKIN_CHOICES, 0.0);
    assert_near(after_two_lists(&t, 20.0, 1.0, 2, false), 1.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pairs_within_smaller_skins_are_counted),
        cmocka_unit_test(the_first_skin_is_a_part_of_the_radius),
        cmocka_unit_test(a_shell_of_neighbours_is_left_out_where_lists_cost_little),
        cmocka_unit_test(dear_lists_get_larger_skins),
        cmocka_unit_test(lists_that_cost_little_keep_their_skin),
        cmocka_unit_test(what_was_too_large_is_not_tried_again_soon),
        cmocka_unit_test(slow_hours_do_not_count),
        cmocka_unit_test(lists_that_were_thrown_away_tell_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
