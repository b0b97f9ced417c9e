// prove_narrow.c -- the narrow phase against slow oracles in full: a table per dimension, a row per pair of shapes.
//
//     prove_narrow [pairs [trajectories [steps [every [searched [dimension]]]]]]        100000 200 400 1 1, both dimensions
//
// Exit status 1 when a depth is wrong, an answer is not finite or a solver failed.

#include "support/narrow_oracle.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBERS = 5 };

static void add(narrow_tally *to, const narrow_tally *t)
{
    to->checked += t->checked;
    to->searched += t->searched;
    to->depth = fmax(to->depth, t->depth);
    to->depth_relative = fmax(to->depth_relative, t->depth_relative);
    to->normal = fmax(to->normal, t->normal);
    to->points = fmax(to->points, t->points);
    to->above += t->above;
    to->wrong += t->wrong;
    to->not_finite += t->not_finite;
    to->counts.failures += t->counts.failures;
}

static uint64_t row(int dimension, int a, int b, const int numbers[NUMBERS])
{
    narrow_tally cold = {0}, warm = {0}, both = {0};
    narrow_random(dimension, a, b, numbers[0], numbers[4], 1, &cold);
    narrow_tumble(dimension, a, b, numbers[1], numbers[2], numbers[3], numbers[4], 2, &warm);
    add(&both, &cold), add(&both, &warm);
    printf("| %s - %s | %llu | %llu | %.1e | %.1e | %.1e | %.1e | %llu | %llu | %llu | %.2f | %llu | %llu | %.0f |\n",
           narrow_name(dimension, a), narrow_name(dimension, b), (unsigned long long)both.checked, (unsigned long long)both.searched,
           both.depth, both.depth_relative, both.normal, both.points, (unsigned long long)both.above,
           (unsigned long long)(both.wrong + both.not_finite), (unsigned long long)both.counts.failures,
           (double)warm.counts.iterations / (double)warm.counts.queries, (unsigned long long)warm.counts.restarts,
           (unsigned long long)warm.counts.fallbacks, warm.nanoseconds);
    fflush(stdout);
    return both.wrong + both.not_finite + both.counts.failures;
}

static uint64_t table(int dimension, const int numbers[NUMBERS])
{
    uint64_t bad = 0;
    printf(
        "\n%dD\n\n| pair | compared | searched | depth | of depth | normal | points | above | wrong | failures | iterations | restarts | "
        "fallbacks | ns |\n",
        dimension);
    printf("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (int b = 0; narrow_shape(dimension, b); ++b)
        for (int a = 0; a <= b; ++a)
        {
            if (!narrow_shape(dimension, b + 1) && a == b) continue; // plane on plane
            bad += row(dimension, a, b, numbers);
        }
    return bad;
}

int main(int argc, char **argv)
{
    int numbers[NUMBERS] = {100000, 200, 400, 1, 1};
    for (int k = 1; k < argc && k <= NUMBERS; ++k) numbers[k - 1] = atoi(argv[k]);
    const int only = argc > NUMBERS + 1 ? atoi(argv[NUMBERS + 1]) : 0;
    uint64_t bad = 0;
    for (int dimension = 3; dimension >= 2; --dimension)
        if (only == 0 || only == dimension) bad += table(dimension, numbers);
    narrow_free_shapes();
    return bad ? 1 : 0;
}
