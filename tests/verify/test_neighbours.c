// test_neighbours.c -- the pair list where its upkeep is hard: narrow periodic boxes, one sphere with thousands of neighbours, contacts that open wider than the
// skin in one step, driven bodies that jump. Nothing of it may show in a result.
#include "support/heap.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static const verify_value stiff[] = {{"kn", 1000.0}, {"ks", 600.0}, {"cn", 0.3}, {"cs", 0.2}, {"friction", 0.5}, {NULL, 0.0}};
static const verify_value elastic[] = {{"kn", 1000.0}, {"ks", 0.0}, {"cn", 0.0}, {"cs", 0.0}, {"friction", 0.0}, {NULL, 0.0}};

// ---- narrow periodic boxes --------------------------------------------------------------------------------------------------------------------------

/// Two spheres of radius 1 in a box periodic along x, nearly as narrow as it may be; they meet across its border.
static verify_scene narrow_box(double edge, double rate, double skin)
{
    pls_world_def def = pls_default_world_def(3);
    def.periodic[0] = true;
    def.upper = pls_vec(edge, edge, edge);
    def.stretch_rate = pls_vec(rate, 0.0, 0.0);
    def.dt = 1e-3;
    def.skin = skin;
    verify_scene s = verify_open(&def, "viscoelastic", stiff);
    verify_ball(&s, 1.0, 1.0, pls_vec(0.2, 0.0, 0.0), pls_vec(-1.0, 0.0, 0.0));
    verify_ball(&s, 1.0, 1.0, pls_vec(edge - 1.85, 0.3, 0.0), pls_vec(1.0, 0.0, 0.0));
    return s;
}

static uint64_t hash_of_narrow_box(double rate, double skin)
{
    verify_scene s = narrow_box(4.2, rate, skin);
    MUST(pls_world_run(s.world, 80));
    assert_int_equal(verify_figures(s.world).touching, 1);
    MUST(pls_world_run(s.world, 120));
    assert_true(verify_figures(s.world).skin <= 0.1); // (edge - 4 radii) / 2
    uint64_t hash = verify_hash(s.world);
    verify_close(&s);
    return hash;
}

static void a_skin_fits_itself_into_a_narrow_periodic_box(void **state)
{
    (void)state;
    uint64_t expected = hash_of_narrow_box(0.0, 1e-3);
    assert_true(hash_of_narrow_box(0.0, 0.0) == expected);
    assert_true(hash_of_narrow_box(0.0, 5.0) == expected);
}

static void a_skin_shrinks_with_its_periodic_box(void **state)
{
    (void)state;
    const double rate = -0.2; // from 4.2 to 4.032
    uint64_t expected = hash_of_narrow_box(rate, 1e-3);
    assert_true(hash_of_narrow_box(rate, 0.0) == expected);
    assert_true(hash_of_narrow_box(rate, 0.09) == expected);
}

static void a_periodic_box_of_two_diameters_is_wide_enough_and_a_narrower_one_is_refused(void **state)
{
    (void)state;
    verify_scene s = narrow_box(4.0, 0.0, 0.0);
    MUST(pls_world_run(s.world, 50));
    verify_close(&s);
    s = narrow_box(3.99, 0.0, 0.0);
    assert_int_equal(pls_world_prepare(s.world), PLS_LIMIT_EXCEEDED);
    verify_close(&s);
}

// ---- one large sphere among many small ones ---------------------------------------------------------------------------------------------------------

enum { SMALL = 20000, FEW_STEPS = 4 };

/// Small spheres lie all over a large one, on a spiral of equal areas, and slide around it; their numbers are in another order than their places.
static uint64_t hash_of_crowd(bool large_first, double skin)
{
    const double radius = 0.01, overlap = 1e-4, spin = 0.5, kn = 1000.0;
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-4;
    def.allow_unstable = true;
    def.skin = skin;
    verify_scene s = verify_open(&def, "viscoelastic", stiff);
    pls_body_def large = verify_ball_def(&s, 1.0, 1e6, pls_vec(0.0, 0.0, 0.0), pls_vec(0.0, 0.0, 0.0));
    if (large_first) verify_add(&s, &large);
    pls_body_id some = {0};
    double height = 0.0, distance = 1.0 + radius - overlap;
    for (int k = 0; k < SMALL; ++k)
    {
        int place = (int)((long long)k * 7919 % SMALL);
        double z = 1.0 - (2.0 * place + 1.0) / SMALL, ring = sqrt(1.0 - z * z), turn = 2.399963229728653 * place;
        pls_vec3 n = pls_vec(ring * cos(turn), ring * sin(turn), z);
        pls_body_id id = verify_ball(&s, radius, 1.0, pls_scale(n, distance), pls_vec(-spin * n.y, spin * n.x, 0.0));
        if (k == SMALL / 3) some = id, height = z;
    }
    if (!large_first) verify_add(&s, &large);
    MUST(pls_world_prepare(s.world));
    assert_int_equal(verify_figures(s.world).touching, SMALL);
    assert_true(fabs(verify_motion(s.world, some).force.z - kn * overlap * height) < 1e-9);
    MUST(pls_world_run(s.world, FEW_STEPS));
    assert_int_equal(verify_figures(s.world).touching, SMALL);
    uint64_t hash = verify_hash(s.world);
    verify_close(&s);
    return hash;
}

static void a_large_sphere_keeps_all_its_contacts_with_small_ones(void **state)
{
    (void)state;
    for (int first = 0; first < 2; ++first) assert_true(hash_of_crowd(first != 0, 1e-9) == hash_of_crowd(first != 0, 5e-3));
}

// ---- contacts that open wider than the skin ---------------------------------------------------------------------------------------------------------

typedef struct outcome
{
    uint64_t hash;
    double energy;
} outcome;

/// A sphere hits another and, or, a wall with friction and leaves again.
static outcome graze(double skin, bool wall, bool periodic)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-3;
    def.skin = skin;
    def.periodic[0] = periodic;
    def.upper = pls_vec(8.0, 8.0, 8.0);
    verify_scene s = verify_open(&def, "viscoelastic", stiff);
    verify_ball(&s, 1.0, 1.0, pls_vec(0.1, 0.0, 1.01), pls_vec(-1.0, 0.9, wall ? -1.0 : 0.0));
    if (wall)
        verify_wall(&s, pls_vec(0.0, 0.0, 0.0), pls_vec(0.0, 0.0, 1.0));
    else
        verify_ball(&s, 1.0, 1.0, pls_vec(periodic ? 6.05 : -1.95, 0.2, 1.0), pls_vec(1.0, -0.4, 0.0));
    bool touched = false;
    for (int k = 0; k < 400; ++k)
    {
        MUST(pls_step(s.world));
        touched = touched || verify_figures(s.world).touching == 1;
    }
    assert_true(touched);
    assert_int_equal(verify_figures(s.world).touching, 0);
    outcome end = {verify_hash(s.world), verify_total_energy(s.world)};
    verify_close(&s);
    return end;
}

static void a_contact_that_opens_wider_than_the_skin_ends_like_any_other(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k)
    {
        outcome thin = graze(1e-9, k == 1, k == 2), thick = graze(0.5, k == 1, k == 2);
        assert_true(thin.energy == thick.energy);
        assert_true(thin.hash == thick.hash);
    }
}

static outcome heap_outcome(heap_setup setup, double skin)
{
    setup.skin = skin;
    heap h = heap_open(setup);
    MUST(pls_world_run(h.scene.world, 300));
    outcome end = {verify_hash(h.scene.world), verify_total_energy(h.scene.world)};
    heap_close(&h);
    return end;
}

static void a_vanishing_skin_changes_no_bit_of_a_heap(void **state)
{
    (void)state;
    for (int periodic = 0; periodic < 2; ++periodic)
    {
        heap_setup setup = heap_default(3, 200);
        setup.periodic = periodic != 0;
        outcome thin = heap_outcome(setup, 1e-9), own = heap_outcome(setup, 0.0);
        assert_true(thin.energy == own.energy);
        assert_true(thin.hash == own.hash);
    }
}

// ---- driven bodies that jump ------------------------------------------------------------------------------------------------------------------------

static const double jump_dt = 1e-3, jump_length = 8.5;

/// Still but in the middle of the tenth step, in which the body goes `jump_length` along x.
static pls_status jump(void *context, double time, pls_vec3 *velocity, pls_vec3 *angular_velocity)
{
    (void)context;
    bool now = fabs(time / jump_dt - 9.5) < 0.25;
    *velocity = pls_vec(now ? jump_length / jump_dt : 0.0, 0.0, 0.0);
    *angular_velocity = pls_vec(0.0, 0.0, 0.0);
    return PLS_OK;
}

static void jump_at(bool plane)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = jump_dt;
    def.skin = 0.5;
    verify_scene s = verify_open(&def, "viscoelastic", elastic);
    pls_body_def body = verify_ball_def(&s, 1.0, 1.0, pls_vec(0.0, 0.0, 0.0), pls_vec(0.0, 0.0, 0.0));
    if (plane)
    {
        body.shape = s.wall;
        body.position = pls_vec(1.0, 0.0, 0.0);
        body.orientation = (pls_quat){sqrt(0.5), 0.0, sqrt(0.5), 0.0}; // z turned to x
    }
    body.motion = (pls_motion_def){.axes = PLS_AXIS_ALL, .function = jump};
    verify_add(&s, &body);
    pls_body_id hit = verify_ball(&s, 1.0, 1.0, pls_vec(10.0, 0.0, 0.0), pls_vec(0.0, 0.0, 0.0));
    MUST(pls_world_run(s.world, 9));
    assert_int_equal(verify_figures(s.world).touching, 0);
    MUST(pls_step(s.world));
    assert_int_equal(verify_figures(s.world).touching, 1);
    assert_true(fabs(verify_motion(s.world, hit).force.x - 1000.0 * 0.5) < 1e-6); // kn times the overlap 0 + 8.5 + 2 - 10
    verify_close(&s);
}

static void a_driven_sphere_that_jumps_meets_what_is_there(void **state)
{
    (void)state;
    jump_at(false);
}

static void a_driven_plane_that_jumps_meets_what_is_there(void **state)
{
    (void)state;
    jump_at(true);
}

// ---- bodies that move together ------------------------------------------------------------------------------------------------------------------------

/// A row of balls that fly one behind the other, along a plane that they do not come near to, needs one list; a ball that comes the other way another one.
static void who_moves_together_keeps_the_list(void **state)
{
    (void)state;
    for (int meets = 0; meets < 2; ++meets)
    {
        pls_world_def def = pls_default_world_def(3);
        def.dt = 1e-3;
        def.skin = 0.5;
        verify_scene s = verify_open(&def, "viscoelastic", elastic);
        for (int k = 0; k < 10; ++k) verify_ball(&s, 1.0, 1.0, pls_vec(3.0 * k, 0.0, 5.0), pls_vec(2.0, 0.0, 0.0));
        verify_wall(&s, pls_vec(0.0, 0.0, 0.0), pls_vec(0.0, 0.0, 1.0));
        if (meets) verify_ball(&s, 1.0, 1.0, pls_vec(40.0, 0.0, 5.0), pls_vec(-2.0, 0.0, 0.0));
        MUST(pls_world_run(s.world, 2780)); // a gap of 11 m closes with 4 m/s; a contact lasts for 70 ms
        assert_true(meets ? verify_figures(s.world).list_builds > 1 : verify_figures(s.world).list_builds == 1);
        assert_int_equal(verify_figures(s.world).touching, meets);
        verify_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_skin_fits_itself_into_a_narrow_periodic_box),
        cmocka_unit_test(a_skin_shrinks_with_its_periodic_box),
        cmocka_unit_test(a_periodic_box_of_two_diameters_is_wide_enough_and_a_narrower_one_is_refused),
        cmocka_unit_test(a_large_sphere_keeps_all_its_contacts_with_small_ones),
        cmocka_unit_test(a_contact_that_opens_wider_than_the_skin_ends_like_any_other),
        cmocka_unit_test(a_vanishing_skin_changes_no_bit_of_a_heap),
        cmocka_unit_test(a_driven_sphere_that_jumps_meets_what_is_there),
        cmocka_unit_test(a_driven_plane_that_jumps_meets_what_is_there),
        cmocka_unit_test(who_moves_together_keeps_the_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
