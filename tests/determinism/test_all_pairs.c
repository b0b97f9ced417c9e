// test_all_pairs.c -- the contacts found are exactly the overlapping pairs of a brute-force search over all pairs, step after step.
//
// Spheres pass through each other almost freely, so that contacts come and go all the time and the list is rebuilt often.
#include "support/verify.h"

#include "base/random.h"
#include "step/contact_view.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <cmocka.h>

typedef struct gas
{
    int dimension, count;
    double size_ratio, edge;
    bool periodic;
} gas;

static verify_scene open_gas(const gas *g, pls_body_id *ids)
{
    pls_world_def def = pls_default_world_def(g->dimension);
    double smallest = 1.0 / g->size_ratio;
    def.dt = 0.05 * smallest;
    def.max_overlap = INFINITY;
    def.allow_unstable = true;
    for (int k = 0; k < g->dimension; ++k) def.periodic[k] = g->periodic;
    def.upper = pls_vec(g->edge, g->edge, g->edge);
    verify_scene scene = verify_open(&def, "elastic", (const verify_value[]){{"kn", 1e-12}, {"ks", 0.0}, {"friction", 0.0}, {NULL, 0.0}});
    for (int k = 0; k < g->count; ++k)
    {
        pls_random random = pls_random_stream(5, (uint64_t)k, PLS_FOR_USER);
        double r = k < 3 ? 1.0 : smallest * pow(g->size_ratio, pow(pls_random_uniform(&random), 3.0)); // mostly small, some large
        pls_vec3 x =
            pls_vec(g->edge * pls_random_uniform(&random), g->edge * pls_random_uniform(&random), g->edge * pls_random_uniform(&random));
        pls_vec3 v = pls_vec(pls_random_normal(&random), pls_random_normal(&random), pls_random_normal(&random));
        if (g->dimension == 2) x.z = v.z = 0.0;
        ids[k] = verify_ball(&scene, r, 1.0, x, v);
    }
    return scene;
}

static double overlap(const gas *g, const pls_body_motion *a, const pls_body_motion *b)
{
    pls_vec3 d = pls_sub(b->position, a->position);
    if (g->periodic) d = pls_vec(remainder(d.x, g->edge), remainder(d.y, g->edge), g->dimension == 3 ? remainder(d.z, g->edge) : 0.0);
    return a->radius + b->radius - pls_length(d);
}

/// Touching pairs are in the view with their overlap, and no others; returns their number.
static size_t compare(const gas *g, verify_scene *scene, const pls_body_id *ids, pls_body_motion *motions)
{
    pls_contact_view view = {0};
    size_t next = 0, touching = 0;
    MUST(pls_contact_view_make(scene->world, &view));
    for (int k = 0; k < g->count; ++k) motions[k] = verify_motion(scene->world, ids[k]);
    for (int i = 0; i < g->count; ++i)
        for (int j = i + 1; j < g->count; ++j)
        {
            double delta = overlap(g, &motions[i], &motions[j]);
            uint32_t a = ids[i].index1 - 1, b = ids[j].index1 - 1;
            bool listed = next < view.count && view.entry[next].number_i == a && view.entry[next].number_j == b;
            if (fabs(delta) > 1e-12) assert_int_equal(listed, delta > 0.0);
            if (!listed) continue;
            assert_true(fabs(view.entry[next].delta - delta) < 1e-12);
            ++next;
            ++touching;
        }
    assert_int_equal(next, view.count);
    pls_contact_view_free(&view);
    return touching;
}

static void check_gas(gas g)
{
    pls_body_id *ids = calloc((size_t)g.count, sizeof *ids);
    pls_body_motion *motions = calloc((size_t)g.count, sizeof *motions);
    assert_non_null(ids);
    assert_non_null(motions);
    verify_scene scene = open_gas(&g, ids);
    MUST(pls_world_prepare(scene.world));
    size_t touching = compare(&g, &scene, ids, motions);
    for (int k = 0; k < 12; ++k)
    {
        MUST(pls_world_run(scene.world, 9));
        touching += compare(&g, &scene, ids, motions);
    }
    assert_true(touching > 100);
    verify_close(&scene);
    free(ids);
    free(motions);
}

static void check_ratios(int dimension, bool periodic)
{
    const double ratios[] = {1.0, 10.0, 100.0};
    for (int k = 0; k < 3; ++k)
        check_gas((gas){dimension, k == 0 ? 400 : 900, ratios[k], k == 0 ? (dimension == 3 ? 14.0 : 40.0) : 9.0, periodic});
}

static void all_overlapping_pairs_are_found_in_3d_open(void **state)
{
    (void)state;
    check_ratios(3, false);
}

static void all_overlapping_pairs_are_found_in_3d_periodic(void **state)
{
    (void)state;
    check_ratios(3, true);
}

static void all_overlapping_pairs_are_found_in_2d_open(void **state)
{
    (void)state;
    check_ratios(2, false);
}

static void all_overlapping_pairs_are_found_in_2d_periodic(void **state)
{
    (void)state;
    check_ratios(2, true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_overlapping_pairs_are_found_in_3d_open),
        cmocka_unit_test(all_overlapping_pairs_are_found_in_3d_periodic),
        cmocka_unit_test(all_overlapping_pairs_are_found_in_2d_open),
        cmocka_unit_test(all_overlapping_pairs_are_found_in_2d_periodic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
