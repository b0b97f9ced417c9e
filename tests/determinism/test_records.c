// test_records.c -- what is remembered of overlaps for speed alone never shows: not in any bit of what a checkpoint holds, nor when bodies are replaced.
#include "base/random.h"
#include "support/snapshot.h"
#include "support/verify.h"

#include <setjmp.h>
#include <stdarg.h>
#include <cmocka.h>

static const double pi = 3.14159265358979323846;

static pls_shape_id add_stone(const verify_scene *scene, pls_random *random, int corners)
{
    enum { MOST = 64 };
    pls_vec3 point[MOST];
    for (int k = 0; k < corners; ++k)
    {
        const pls_vec3 n = pls_unit(pls_vec(pls_random_normal(random), pls_random_normal(random), pls_random_normal(random)));
        point[k] = pls_vec(0.42 * n.x, 0.38 * n.y, 0.34 * n.z);
    }
    return verify_add_hull(scene, point, (size_t)corners);
}

static pls_quat any_turn(pls_random *random)
{
    double q[4];
    for (int k = 0; k < 4; ++k) q[k] = pls_random_normal(random);
    return pls_quat_unit((pls_quat){q[0], q[1], q[2], q[3]});
}

static verify_scene open_with(pls_faces faces)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-3;
    const verify_value values[] = {{"kn", 100.0}, {"ks", 75.0}, {"cn", 0.3}, {"cs", 0.2}, {"friction", 0.5}, {NULL, 0.0}};
    verify_scene scene = verify_open(&def, "viscoelastic", values);
    verify_set_faces(&scene, faces, faces == PLS_FACES_VOLUME ? 0.1 : 0.0);
    return scene;
}

// ---- in and out -----------------------------------------------------------------------------------------------------------------------------------------

/// Down by a part of the size and up again each second: through overlaps so deep that there is no record of them, and back.
static pls_status swing(void *context, double time, pls_vec3 *v, pls_vec3 *w)
{
    const double *depth = context;
    *v = pls_vec(0, 0, -*depth * pi * sin(2.0 * pi * time));
    *w = pls_vec(0, 0, 0);
    return PLS_OK;
}

static verify_scene open_swing(pls_faces faces, int corners, uint64_t seed, double *depth)
{
    verify_scene scene = open_with(faces);
    pls_random random = pls_random_stream(seed, 5, PLS_FOR_USER);
    for (int k = 0; k < 2; ++k)
    {
        pls_body_def grain = verify_body_def(&scene, add_stone(&scene, &random, corners), pls_vec(0.05 * k, 0.03 * k, 0.7 * k));
        grain.orientation = any_turn(&random);
        if (k == 1) grain.motion = (pls_motion_def){.axes = PLS_AXIS_ALL, .function = swing, .context = depth};
        verify_add(&scene, &grain);
    }
    return scene;
}

/// The one world keeps its records, the other is saved and put back, and so loses them, at each step.
static void a_world_that_loses_its_records_at_each_step_holds_the_same(void **state)
{
    (void)state;
    static const struct
    {
        pls_faces faces;
        int corners;
        uint64_t seed;
        double depth;
    } swings[] = {{PLS_FACES_VOLUME, 34, 3, 0.22}, {PLS_FACES_VOLUME, 26, 33, 0.3}, {PLS_FACES_MANIFOLD, 30, 8, 0.3}};
    for (size_t s = 0; s < sizeof swings / sizeof *swings; ++s)
    {
        double depth = swings[s].depth;
        verify_scene kept = open_swing(swings[s].faces, swings[s].corners, swings[s].seed, &depth),
                     lost = open_swing(swings[s].faces, swings[s].corners, swings[s].seed, &depth);
        int touching = 0;
        for (int step = 0; step < 1000; ++step)
        {
            MUST(pls_step(kept.world));
            MUST(pls_step(lost.world));
            const pls_narrow_counts a = pls_world_narrow_counts(kept.world), b = pls_world_narrow_counts(lost.world);
            assert_memory_equal(&a, &b, sizeof a);
            const size_t contacts = pls_world_contact_count(kept.world);
            touching += contacts > 0;
            snapshot copy = {0};
            MUST(snapshot_take(lost.world, &copy));
            MUST(snapshot_put(lost.world, &copy));
            snapshot_free(&copy);
            if (contacts > 0) assert_true(verify_hash(kept.world) == verify_hash(lost.world));
        }
        assert_true(touching > 200);
        verify_close(&kept), verify_close(&lost);
    }
}

// ---- another body under the same number -----------------------------------------------------------------------------------------------------------------

/// A stone that lies on another one is taken out, and one of fewer corners put in its place, which gets its number.
static void a_body_with_the_number_of_another_has_no_records(void **state)
{
    (void)state;
    uint64_t hash[2];
    for (int saved = 0; saved < 2; ++saved)
    {
        verify_scene scene = open_with(PLS_FACES_VOLUME);
        pls_random random = pls_random_stream(9, 1, PLS_FOR_USER);
        const pls_shape_id many = add_stone(&scene, &random, 33), few = add_stone(&scene, &random, 5);
        pls_body_def low = verify_body_def(&scene, many, pls_vec(0, 0, 0)), high = verify_body_def(&scene, many, pls_vec(0.05, 0.03, 0.5));
        high.orientation = any_turn(&random);
        const pls_body_id id = verify_add(&scene, &low);
        verify_add(&scene, &high);
        MUST(pls_world_run(scene.world, 3));
        assert_true(pls_world_contact_count(scene.world) == 1);
        MUST(pls_world_remove_body(scene.world, id));
        low.shape = few;
        const pls_body_id next = verify_add(&scene, &low);
        assert_int_equal(next.index1, id.index1);
        if (saved)
        {
            snapshot copy = {0};
            MUST(snapshot_take(scene.world, &copy));
            MUST(snapshot_put(scene.world, &copy));
            snapshot_free(&copy);
        }
        MUST(pls_world_run(scene.world, 3));
        hash[saved] = verify_hash(scene.world);
        verify_close(&scene);
    }
    assert_true(hash[0] == hash[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_world_that_loses_its_records_at_each_step_holds_the_same),
        cmocka_unit_test(a_body_with_the_number_of_another_has_no_records),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
