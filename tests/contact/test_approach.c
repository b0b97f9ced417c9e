// test_approach.c -- how much of the skin is used up: never less than all pairs that are not listed say, one by one; nothing where bodies move together.

#include "base/alloc.h"
#include "base/random.h"
#include "contact/approach.h"
#include "support/verify.h"

#include <math.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

enum { BODIES = 400, CROWDS = 60 };

static const double edge = 10.0, skin = 0.2;

/// Balls in a box over a half-space, and what a list made of them would keep.
typedef struct crowd
{
    pls_bodies bodies;
    pls_domain domain;
    pls_pair_list list;
    pls_random random;
    double then[BODIES + 1][3], radius_then[BODIES + 1], reference[BODIES + 1][3]; ///< the last one is the half-space
} crowd;

static double uniform(crowd *c, double low, double high) { return low + (high - low) * pls_random_uniform(&c->random); }

static void crowd_open(crowd *c, uint32_t seed, int dimension, bool periodic, double largest)
{
    *c = (crowd){.domain = {.dimension = dimension, .any_periodic = periodic}, .list = {.skin = skin}};
    c->random = pls_random_stream(7, seed, PLS_FOR_USER);
    c->domain.periodic[0] = c->domain.periodic[1] = periodic;
    for (int a = 0; a < 3; ++a) c->domain.edge[a] = c->domain.periodic[a] ? edge : 0.0;
    for (int k = 0; k <= BODIES; ++k)
    {
        uint32_t row;
        MUST(pls_bodies_add(&c->bodies, &row));
        const bool wall = k == BODIES;
        pls_body_place *p = &c->bodies.place[row];
        p->x = wall ? 0.0 : uniform(c, 0.0, edge), p->y = wall ? 0.0 : uniform(c, 0.0, edge);
        p->z = wall || dimension == 2 ? 0.0 : uniform(c, 0.3, edge);
        p->radius = wall ? INFINITY : uniform(c, 0.1, largest);
        c->bodies.kind[row].flags = wall ? PLS_BODY_UNBOUNDED : 0;
        c->bodies.orientation[row] = (pls_body_orientation){.w = 1.0};
        c->then[k][0] = p->x, c->then[k][1] = p->y, c->then[k][2] = p->z;
        c->radius_then[k] = p->radius;
    }
    memcpy(c->reference, c->then, sizeof c->then);
    c->list.reference = c->reference;
    c->list.reference_radius = c->radius_then;
}

static void move(crowd *c, int k, double x, double y, double z)
{
    pls_body_place *p = &c->bodies.place[k];
    p->x += x, p->y += y, p->z += c->domain.dimension == 3 ? z : 0.0;
}

static double approach_of(crowd *c)
{
    double approach = NAN;
    MUST(pls_pair_list_approach(&c->list, &c->bodies, &c->domain, &approach));
    return approach;
}

static double gap_between(const crowd *c, const double x[3], const double y[3])
{
    double square = 0.0;
    for (int a = 0; a < 3; ++a)
    {
        double d = y[a] - x[a];
        if (c->domain.periodic[a]) d -= edge * rint(d / edge);
        square += d * d;
    }
    return sqrt(square);
}

/// The narrowest gap now of all pairs that had one wider than the skin, one by one.
static double narrowest_unlisted(const crowd *c)
{
    double least = INFINITY;
    const pls_body_place *wall = &c->bodies.place[BODIES];
    for (int i = 0; i < BODIES; ++i)
    {
        const pls_body_place *p = &c->bodies.place[i];
        const double now[3] = {p->x, p->y, p->z};
        for (int j = i + 1; j < BODIES; ++j)
        {
            const pls_body_place *q = &c->bodies.place[j];
            const double other[3] = {q->x, q->y, q->z};
            if (gap_between(c, c->then[i], c->then[j]) - c->radius_then[i] - c->radius_then[j] < skin) continue;
            least = fmin(least, gap_between(c, now, other) - p->radius - q->radius);
        }
        const bool flat = c->domain.dimension == 2; // the half-space's normal is y then, else z
        if (c->then[i][flat ? 1 : 2] - c->radius_then[i] >= skin) least = fmin(least, (flat ? p->y - wall->y : p->z - wall->z) - p->radius);
    }
    return least;
}

static void crowd_close(crowd *c)
{
    pls_bodies_free(&c->bodies);
    pls_release(&c->list.moved);
}

static void no_gap_is_narrower_than_what_is_left_of_the_skin(void **state)
{
    (void)state;
    int tight = 0;
    for (uint32_t seed = 0; seed < CROWDS; ++seed)
    {
        crowd c;
        crowd_open(&c, seed, seed % 3 == 2 ? 2 : 3, seed % 2 == 1, seed % 5 == 0 ? 1.0 : 0.15);
        const double shear = uniform(&c, 0.0, 0.1), noise = uniform(&c, 0.0, 0.06), growth = seed % 4 == 3 ? 0.01 : 0.0;
        for (int k = 0; k < BODIES; ++k)
        {
            const double height = c.then[k][1];
            move(&c, k, 3.0 + shear * (c.domain.periodic[1] ? sin(6.283185307179586 * height / edge) : height), uniform(&c, -noise, noise),
                 uniform(&c, -noise, noise));
            c.bodies.place[k].radius += uniform(&c, 0.0, growth);
        }
        move(&c, BODIES, 5.0, 0.5 * noise, noise);
        if (seed % 7 == 6) move(&c, 0, uniform(&c, -30.0, 30.0), 2.0, 0.0); // one jumps
        const double approach = approach_of(&c), least = narrowest_unlisted(&c);
        if (approach < skin) assert_true(least >= skin - approach - 1e-12);
        tight += approach < skin;
        crowd_close(&c);
    }
    assert_true(tight > CROWDS / 4); // or nothing was said
}

static void bodies_that_move_together_use_up_nothing(void **state)
{
    (void)state;
    for (int periodic = 0; periodic < 2; ++periodic)
    {
        crowd c;
        crowd_open(&c, 1, 3, periodic != 0, 0.3);
        for (int k = 0; k <= BODIES; ++k) move(&c, k, 100.0, -70.0, 30.0);
        assert_true(approach_of(&c) < 1e-12);
        crowd_close(&c);
    }
}

static void what_slides_past_far_away_uses_up_nothing(void **state)
{
    (void)state;
    crowd c;
    crowd_open(&c, 2, 3, false, 1.0);
    for (int k = 0; k < BODIES; ++k)
        if (c.then[k][0] > 0.5 * edge) move(&c, k, 6.0, 20.0, 0.0);
    assert_true(approach_of(&c) < 1e-12);
    crowd_close(&c);
}

static void a_half_space_uses_up_what_it_comes_nearer_to_those_it_did_not_list(void **state)
{
    (void)state;
    crowd c;
    crowd_open(&c, 3, 3, false, 0.15);
    for (int k = 0; k < BODIES; ++k) move(&c, k, 0.0, 0.0, 20.0 - c.then[k][2]), c.then[k][2] = c.reference[k][2] = 20.0;
    for (int k = 0; k < BODIES; ++k) c.bodies.place[k].radius = c.radius_then[k] = 0.125;
    move(&c, BODIES, 0.0, 0.0, 19.0); // far from all
    assert_true(approach_of(&c) == 0.0);
    move(&c, BODIES, 0.0, 0.0, 0.75); // a gap of 0.125 is left
    assert_true(fabs(approach_of(&c) - (skin - 0.125)) < 1e-12);
    for (int k = 0; k < BODIES; ++k) c.reference[k][2] = 0.2; // as if all had been near: they are listed
    for (int k = 0; k < BODIES; ++k) assert_true(c.bodies.place[k].z == 20.0);
    assert_true(approach_of(&c) == 0.0);
    crowd_close(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_gap_is_narrower_than_what_is_left_of_the_skin),
        cmocka_unit_test(bodies_that_move_together_use_up_nothing),
        cmocka_unit_test(what_slides_past_far_away_uses_up_nothing),
        cmocka_unit_test(a_half_space_uses_up_what_it_comes_nearer_to_those_it_did_not_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
