// prove_narrow.c -- the narrow phase against slow oracles in full: a table per dimension, a row per pair of shapes.
//
//     prove_narrow [pairs [trajectories [steps [every [searched [dimension [seed]]]]]]]        100000 200 400 5 11 0 1; dimension 0: both
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
    to->wrong += t->wrong;
    to->not_finite += t->not_finite;
    to->counts.failures += t->counts.failures;
}

typedef struct result
{
    int a, b;
    narrow_tally warm, both;
} result;

static void measure(int dimension, const int numbers[NUMBERS], uint64_t seed, result *r)
{
    narrow_random(dimension, r->a, r->b, numbers[0], numbers[4], seed, &r->both);
    narrow_tumble(dimension, r->a, r->b, numbers[1], numbers[2], numbers[3], numbers[4], seed + 1, &r->warm);
    add(&r->both, &r->warm);
}

static uint64_t print(int dimension, const result *r)
{
    const narrow_tally *t = &r->both, *w = &r->warm;
    const uint64_t wrong = t->wrong + t->not_finite;
    printf("| %s - %s | %llu | %llu | %.1e | %.1e | %.1e | %.1e | %llu | %llu | %.2f | %llu | %llu | %.0f |\n",
           narrow_name(dimension, r->a), narrow_name(dimension, r->b), (unsigned long long)t->checked, (unsigned long long)t->searched,
           t->depth, t->depth_relative, t->normal, t->points, (unsigned long long)wrong, (unsigned long long)t->counts.failures,
           (double)w->counts.iterations / (double)w->counts.queries, (unsigned long long)w->counts.restarts,
           (unsigned long long)w->counts.fallbacks, w->nanoseconds);
    return wrong + t->counts.failures;
}

static uint64_t table(int dimension, const int numbers[NUMBERS], uint64_t seed)
{
    static result results[NARROW_MOST_SHAPES * (NARROW_MOST_SHAPES + 1) / 2];
    int count = 0;
    uint64_t bad = 0;
    for (int b = 0; narrow_shape(dimension, b); ++b) // makes the shapes, too
        for (int a = 0; a <= b; ++a)
            if (narrow_shape(dimension, b + 1) || a != b) results[count++] = (result){.a = a, .b = b}; // but plane on plane
#pragma omp parallel for schedule(dynamic)
    for (int k = count - 1; k >= 0; --k) measure(dimension, numbers, seed, &results[k]); // the slow ones first
    printf("\n%dD\n\n| pair | compared | searched | depth | of depth | normal | points | wrong | failures | iterations | restarts | "
           "fallbacks | ns |\n",
           dimension);
    printf("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (int k = 0; k < count; ++k) bad += print(dimension, &results[k]);
    return bad;
}

int main(int argc, char **argv)
{
    int numbers[NUMBERS] = {100000, 200, 400, 5, 11};
    for (int k = 1; k < argc && k <= NUMBERS; ++k) numbers[k - 1] = atoi(argv[k]);
    const int only = argc > NUMBERS + 1 ? atoi(argv[NUMBERS + 1]) : 0;
    const uint64_t seed = argc > NUMBERS + 2 ? strtoull(argv[NUMBERS + 2], NULL, 10) : 1;
    uint64_t bad = 0;
    for (int dimension = 3; dimension >= 2; --dimension)
        if (only == 0 || only == dimension) bad += table(dimension, numbers, seed);
    narrow_free_shapes();
    return bad ? 1 : 0;
}
