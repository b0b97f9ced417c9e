// broad_phase.c -- time of the broad phase alone, for bodies of one size or of a power law of sizes.
//
// Sizes: equal volume in equal intervals of log r (number density ~ r^-4), taken at even quantiles, the largest at the given ratio to the smallest, r = 1.
// Places: random in a cube that the bodies would fill to 60 %; they overlap, which a broad phase does not mind. Rows follow the Morton curve, as in a world.
//
// Prints one line of JSON: the median of repeated calls.

#include "contact/broad_phase.h"

#include "base/alloc.h"
#include "base/clock.h"
#include "base/random.h"
#include "base/sort.h"

#include <particls/threads.h>

#include <stdio.h>
#include <stdlib.h>

static const double fill = 0.6;   ///< volume of bodies over volume of the cube
static const double gap = 0.18;   ///< of the smallest radius: a usual Verlet skin
static const double enough = 0.5; ///< time to measure for [s]
enum { LEAST_CALLS = 5, MOST_CALLS = 1000 };

static double radius_of(size_t k, size_t count, double ratio)
{
    if (k + 1 == count) return ratio;
    double share = ((double)k + 0.5) / (double)count;
    return 1.0 / cbrt(1.0 - share * (1.0 - 1.0 / (ratio * ratio * ratio)));
}

static pls_vec3 place_of(size_t k, double edge)
{
    pls_random random = pls_random_stream(1, k, PLS_FOR_POSITION);
    double x = pls_random_uniform(&random), y = pls_random_uniform(&random), z = pls_random_uniform(&random);
    return pls_vec(edge * x, edge * y, edge * z);
}

static pls_status fill_rows(pls_bodies *bodies, size_t count, double ratio, double edge, uint64_t *key, uint32_t *order)
{
    const double lower[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < count; ++k)
    {
        pls_vec3 x = place_of(k, edge);
        const double position[3] = {x.x, x.y, x.z};
        key[k] = pls_morton_key(position, lower, 2.0);
        order[k] = (uint32_t)k;
    }
    PLS_TRY(pls_radix_sort_u64(key, order, count));
    PLS_TRY(pls_bodies_reserve(bodies, count));
    for (size_t m = 0; m < count; ++m)
    {
        uint32_t row;
        PLS_TRY(pls_bodies_add(bodies, &row));
        pls_vec3 x = place_of(order[m], edge);
        bodies->place[row] = (pls_body_place){.x = x.x, .y = x.y, .z = x.z, .radius = radius_of(order[m], count, ratio)};
        bodies->load[row].inv_mass = 1.0;
    }
    return PLS_OK;
}

static pls_status make_bodies(pls_bodies *bodies, size_t count, double ratio)
{
    double cubes = 0.0;
    for (size_t k = 0; k < count; ++k) cubes += pow(radius_of(k, count, ratio), 3.0);
    double edge = cbrt(4.0 / 3.0 * acos(-1.0) * cubes / fill);
    uint64_t *key = NULL;
    uint32_t *order = NULL;
    pls_status status = pls_allocate(&key, count, sizeof *key, "Morton keys");
    if (status == PLS_OK) status = pls_allocate(&order, count, sizeof *order, "the order of bodies");
    if (status == PLS_OK) status = fill_rows(bodies, count, ratio, edge, key, order);
    pls_release(&order);
    pls_release(&key);
    return status;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static pls_status measure(const pls_bodies *bodies, pls_near_pairs *pairs, double ratio)
{
    const pls_domain domain = {.dimension = 3, .thickness = 1.0};
    double seconds[MOST_CALLS], total = 0.0;
    size_t calls = 0;
    PLS_TRY(pls_broad_phase(bodies, &domain, gap, pairs)); // the first call also gets the memory for the pairs
    while (calls < MOST_CALLS && (calls < LEAST_CALLS || total < enough))
    {
        double start = pls_clock();
        PLS_TRY(pls_broad_phase(bodies, &domain, gap, pairs));
        seconds[calls] = pls_clock() - start;
        total += seconds[calls++];
    }
    qsort(seconds, calls, sizeof *seconds, by_value);
    double median = seconds[calls / 2], count = (double)bodies->count;
    printf("{\"bodies\": %zu, \"size_ratio\": %g, \"threads\": %d, \"calls\": %zu, \"wall_s\": %.9f, \"pairs\": %zu, \"ns_per_body\": "
           "%.2f, \"ns_per_pair\": ",
           bodies->count, ratio, pls_threads(), calls, median, pairs->count, 1e9 * median / count);
    if (pairs->count > 0)
        printf("%.2f}\n", 1e9 * median / (double)pairs->count);
    else
        printf("null}\n");
    return PLS_OK;
}

int main(int argc, char **argv)
{
    double count = argc > 1 ? atof(argv[1]) : 0.0, ratio = argc > 2 ? atof(argv[2]) : 0.0;
    if (argc != 3 || !(count >= 1.0 && count <= 1e8) || !(ratio >= 1.0 && ratio <= 1e6))
    {
        fprintf(stderr,
                "usage: broad_phase BODIES SIZE_RATIO\n  BODIES 1 to 1e8, SIZE_RATIO (largest over smallest) 1 to 1e6; one thread\n");
        return 2;
    }
    pls_bodies bodies = {0};
    pls_near_pairs pairs = {0};
    pls_status status = pls_set_threads(1);
    if (status == PLS_OK) status = make_bodies(&bodies, (size_t)count, ratio);
    if (status == PLS_OK) status = measure(&bodies, &pairs, ratio);
    if (status != PLS_OK) fprintf(stderr, "broad_phase: %s\n", pls_last_message());
    pls_near_pairs_free(&pairs);
    pls_bodies_free(&bodies);
    return status == PLS_OK ? 0 : 1;
}
