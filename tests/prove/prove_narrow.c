// prove_narrow.c -- the narrow phase against slow oracles in full: a table per dimension, a row per pair of shapes.
//
//     prove_narrow [pairs [trajectories [steps [every]]]]        100000 200 400 1
//
// Exit status 1 when a depth is wrong, an answer is not finite or a solver failed.

#include "support/narrow_oracle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add(narrow_tally *to, const narrow_tally *t)
{
    to->checked += t->checked;
    to->depth = fmax(to->depth, t->depth);
    to->depth_relative = fmax(to->depth_relative, t->depth_relative);
    to->normal = fmax(to->normal, t->normal);
    to->points = fmax(to->points, t->points);
    to->wrong += t->wrong;
    to->not_finite += t->not_finite;
    to->counts.failures += t->counts.failures;
}

static uint64_t row(int dimension, int a, int b, const int numbers[4])
{
    narrow_tally cold = {0}, warm = {0}, both = {0};
    narrow_random(dimension, a, b, numbers[0], 1, &cold);
    narrow_tumble(dimension, a, b, numbers[1], numbers[2], numbers[3], 2, &warm);
    add(&both, &cold), add(&both, &warm);
    printf("| %s - %s | %llu | %.1e | %.1e | %.1e | %.1e | %llu | %llu | %.2f | %llu | %llu | %.0f |\n", narrow_name(dimension, a),
           narrow_name(dimension, b), (unsigned long long)both.checked, both.depth, both.depth_relative, both.normal, both.points,
           (unsigned long long)(both.wrong + both.not_finite), (unsigned long long)both.counts.failures,
           (double)warm.counts.iterations / (double)warm.counts.queries, (unsigned long long)warm.counts.restarts,
           (unsigned long long)warm.counts.fallbacks, warm.nanoseconds);
    fflush(stdout);
    return both.wrong + both.not_finite + both.counts.failures;
}

static uint64_t table(int dimension, const int numbers[4], const char *only)
{
    uint64_t bad = 0;
    printf(
        "\n%dD\n\n| pair | compared | depth | of depth | normal | points | wrong | failures | iterations | restarts | fallbacks | ns |\n",
        dimension);
    printf("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (int b = 0; narrow_shape(dimension, b); ++b)
        for (int a = 0; a <= b; ++a)
        {
            if (!narrow_shape(dimension, b + 1) && a == b) continue; // plane on plane
            if (only && !strstr(narrow_name(dimension, a), only) && !strstr(narrow_name(dimension, b), only)) continue;
            bad += row(dimension, a, b, numbers);
        }
    return bad;
}

int main(int argc, char **argv)
{
    int numbers[4] = {100000, 200, 400, 1};
    for (int k = 1; k < argc && k <= 4; ++k) numbers[k - 1] = atoi(argv[k]);
    const char *only = argc > 5 ? argv[5] : NULL;
    uint64_t bad = table(3, numbers, only) + table(2, numbers, only);
    narrow_free_shapes();
    return bad ? 1 : 0;
}
