// random_pack.c -- loose random packings by random sequential addition.
//
// Bodies are placed one after the other at random places; a place where the body would come closer than `gap` to an earlier one is drawn
// again. The large ones go first, because small ones still find room between them. Numbers are drawn per body (stream keyed by the body's
// number), so a body's radius and tries depend on the seed alone, not on how often others tried.
//
// Earlier bodies lie in grids, one level per factor of two in size: a level's cells are as wide as its largest sphere plus the gap. A new
// body is no larger than any earlier one, so on each level its neighbours lie in the 3 x 3 x 3 cells around it, and a cell holds only few
// bodies of its own level. Cells are found through a hash table, so a large box costs nothing. All in all the work is linear in the bodies
// for any ratio of sizes.

#include "base/random.h"
#include "base/sort.h"
#include "scene/generators.h"

#include <string.h>

enum { MAX_LEVELS = 64 };
static const uint32_t NONE = UINT32_MAX;

// ---------------------------------------------------------------------------------------------------------------------------------------
// radii

typedef enum distribution_kind { ONE_RADIUS, UNIFORM, LOGNORMAL, POWER, TABLE } distribution_kind;

typedef struct distribution
{
    distribution_kind kind;
    double least, most;             ///< [m]
    double median, sigma, exponent; ///< LOGNORMAL, POWER
    const pls_node *table;
    double table_sum;
} distribution;

static distribution read_distribution(const pls_node *radius)
{
    if (radius->numeric) return (distribution){.least = radius->number, .most = radius->number};
    const char *kind = radius->key[0]->text;
    const pls_node *inner = radius->child[0];
    distribution d = {.least = pls_scene_number(inner, "min", 0.0), .most = pls_scene_number(inner, "max", 0.0)};
    if (strcmp(kind, "uniform") == 0)
        return (distribution){.kind = UNIFORM, .least = inner->child[0]->number, .most = inner->child[1]->number};
    if (strcmp(kind, "lognormal") == 0)
    {
        d.kind = LOGNORMAL;
        d.median = pls_scene_number(inner, "median", 0.0);
        d.sigma = pls_scene_number(inner, "sigma", 0.0);
        return d;
    }
    if (strcmp(kind, "power") == 0)
    {
        d.kind = POWER;
        d.exponent = pls_scene_number(inner, "exponent", 0.0);
        return d;
    }
    d.kind = TABLE;
    d.table = inner;
    for (size_t k = 0; k < inner->count; ++k) d.table_sum += inner->child[k]->child[1]->number;
    return d;
}

/// Inverse of the distribution function of a density ~ r^p: r = (a + u (b - a))^(1/(p+1)) with a, b = min, max to the power p + 1.
static double draw_power(const distribution *d, double u)
{
    double p = d->exponent + 1.0;
    if (fabs(p) < 1e-12) return d->least * pow(d->most / d->least, u);
    double ratio = pow(d->most / d->least, p);
    return d->least * pow(1.0 + u * (ratio - 1.0), 1.0 / p);
}

static double draw_table(const distribution *d, double u)
{
    double sum = 0.0;
    size_t last = d->table->count - 1;
    for (size_t k = 0; k < last; ++k)
    {
        sum += d->table->child[k]->child[1]->number;
        if (u * d->table_sum < sum) return d->table->child[k]->child[0]->number;
    }
    return d->table->child[last]->child[0]->number;
}

static double draw_radius(const distribution *d, uint64_t seed, uint64_t body)
{
    pls_random random = pls_random_stream(seed, body, PLS_FOR_SIZE);
    switch (d->kind)
    {
        case ONE_RADIUS: return d->least;
        case UNIFORM: return d->least + (d->most - d->least) * pls_random_uniform(&random);
        case POWER: return draw_power(d, pls_random_uniform(&random));
        case TABLE: return draw_table(d, pls_random_uniform(&random));
        case LOGNORMAL: break;
    }
    // The median lies between the cuts, but they may be so narrow that drawing again and again takes too long: then the last draw is
    // clamped.
    double r = d->median;
    for (int k = 0; k < 1000; ++k)
    {
        r = d->median * exp(d->sigma * pls_random_normal(&random));
        if (r >= d->least && r <= d->most) return r;
    }
    return r < d->least ? d->least : d->most;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// cells

typedef struct packing
{
    pls_vec3 lower, upper;
    double gap, largest;
    int dimension, levels;
    double cell[MAX_LEVELS];
    uint64_t used[MAX_LEVELS]; ///< bodies on each level
    const double *radius;
    const pls_vec3 *position;
    uint32_t *bucket; ///< first body of each bucket
    uint32_t *next;   ///< next body of the same bucket
    uint64_t mask;    ///< buckets - 1
} packing;

/// Level l holds radii in (largest / 2^(l+1), largest / 2^l].
static int level_of(const packing *p, double radius)
{
    int level = 0;
    for (double r = p->largest / 2.0; radius <= r && level < MAX_LEVELS - 1; r /= 2.0) ++level;
    return level;
}

static void cell_of(const packing *p, int level, pls_vec3 x, int64_t cell[3])
{
    double width = p->cell[level];
    cell[0] = (int64_t)floor((x.x - p->lower.x) / width);
    cell[1] = (int64_t)floor((x.y - p->lower.y) / width);
    cell[2] = p->dimension == 3 ? (int64_t)floor((x.z - p->lower.z) / width) : 0;
}

static uint64_t bucket_of(const packing *p, int level, const int64_t cell[3])
{
    uint64_t h = (uint64_t)level;
    for (int k = 0; k < 3; ++k)
    {
        h = (h ^ (uint64_t)cell[k]) * UINT64_C(0x9E3779B97F4A7C15); // golden ratio, spreads neighbouring cells
        h ^= h >> 29;
    }
    return h & p->mask;
}

static bool touches(const packing *p, uint32_t other, pls_vec3 x, double radius)
{
    pls_vec3 d = pls_sub(p->position[other], x);
    double reach = p->radius[other] + radius + p->gap;
    return pls_dot(d, d) < reach * reach;
}

static bool is_free(const packing *p, pls_vec3 x, double radius)
{
    for (int level = 0; level < p->levels; ++level)
    {
        if (p->used[level] == 0) continue;
        int64_t centre[3], cell[3];
        cell_of(p, level, x, centre);
        int depth = p->dimension == 3 ? 1 : 0;
        for (int k = -depth; k <= depth; ++k)
        {
            for (int ji = 0; ji < 9; ++ji)
            {
                cell[0] = centre[0] + ji % 3 - 1;
                cell[1] = centre[1] + ji / 3 - 1;
                cell[2] = centre[2] + k;
                for (uint32_t b = p->bucket[bucket_of(p, level, cell)]; b != NONE; b = p->next[b])
                {
                    if (touches(p, b, x, radius)) return false;
                }
            }
        }
    }
    return true;
}

static void insert(packing *p, uint32_t body)
{
    int64_t cell[3];
    int level = level_of(p, p->radius[body]);
    cell_of(p, level, p->position[body], cell);
    uint64_t bucket = bucket_of(p, level, cell);
    p->next[body] = p->bucket[bucket];
    p->bucket[bucket] = body;
    ++p->used[level];
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// packing

static pls_vec3 draw_place(const packing *p, pls_random *random, double radius)
{
    pls_vec3 u = {0};
    u.x = pls_random_uniform(random);
    u.y = pls_random_uniform(random);
    u.z = p->dimension == 3 ? pls_random_uniform(random) : 0.0;
    pls_vec3 room = pls_sub(pls_sub(p->upper, p->lower), pls_vec(2 * radius, 2 * radius, 2 * radius));
    pls_vec3 x = pls_vec(p->lower.x + radius + u.x * room.x, p->lower.y + radius + u.y * room.y, 0.0);
    if (p->dimension == 3) x.z = p->lower.z + radius + u.z * room.z;
    return x;
}

/// Bodies in order of falling radius, equal ones in order of their numbers. Positive doubles sort like their bits.
static pls_status sort_by_radius(const double *radius, size_t count, uint32_t *order)
{
    uint64_t *keys;
    PLS_TRY(pls_allocate(&keys, count, sizeof *keys, "a sort of radii"));
    for (size_t k = 0; k < count; ++k)
    {
        memcpy(&keys[k], &radius[k], sizeof *keys);
        keys[k] = ~keys[k];
        order[k] = (uint32_t)k;
    }
    pls_status status = pls_radix_sort_u64(keys, order, count);
    pls_release(&keys);
    return status;
}

static pls_status fail_full(const pls_node *section, const packing *p, size_t placed, size_t count, const uint32_t *order,
                            uint32_t attempts)
{
    double solid = 0.0;
    bool flat = p->dimension == 2;
    for (size_t k = 0; k < placed; ++k)
    {
        double r = p->radius[order[k]];
        solid += flat ? M_PI * r * r : 4.0 / 3.0 * M_PI * r * r * r;
    }
    pls_vec3 edge = pls_sub(p->upper, p->lower);
    double box = edge.x * edge.y * (flat ? 1.0 : edge.z);
    return pls_node_fail(section, "take fewer or smaller bodies, a larger box, or more `attempts`",
                         "only %zu of %zu bodies fitted into the box, which is then %.1f %% full (%u places tried for the next one)",
                         placed, count, 100.0 * solid / box, attempts);
}

static pls_status place_all(packing *p, const pls_node *section, uint64_t seed, const uint32_t *order, pls_points *points)
{
    uint32_t attempts = (uint32_t)pls_scene_number(section, "attempts", 1.0);
    for (size_t k = 0; k < points->count; ++k)
    {
        uint32_t body = order[k], tries = 0;
        pls_random random = pls_random_stream(seed, body, PLS_FOR_POSITION);
        double radius = p->radius[body];
        bool found = false;
        while (!found && tries++ < attempts)
        {
            points->position[body] = draw_place(p, &random, radius);
            found = is_free(p, points->position[body], radius);
        }
        if (!found) return fail_full(section, p, k, points->count, order, attempts);
        insert(p, body);
    }
    return PLS_OK;
}

static pls_status check_room(const packing *p, const pls_node *section)
{
    pls_vec3 edge = pls_sub(p->upper, p->lower);
    double least = fmin(edge.x, edge.y);
    if (p->dimension == 3) least = fmin(least, edge.z);
    if (2.0 * p->largest <= least) return PLS_OK;
    return pls_node_fail(pls_node_get(section, "box"), NULL, "a body of radius %g m does not fit into a box of width %g m", p->largest,
                         least);
}

static pls_status pack(packing *p, const pls_node *section, uint64_t seed, uint32_t *order, pls_points *points)
{
    size_t buckets = 64;
    while (buckets < 2 * points->count) buckets *= 2;
    p->mask = buckets - 1;
    PLS_TRY(pls_allocate(&p->bucket, buckets, sizeof *p->bucket, "cells of a random packing"));
    PLS_TRY(pls_allocate(&p->next, points->count, sizeof *p->next, "cells of a random packing"));
    memset(p->bucket, 0xFF, buckets * sizeof *p->bucket);
    PLS_TRY(sort_by_radius(p->radius, points->count, order));
    p->largest = p->radius[order[0]];
    PLS_TRY(check_room(p, section));
    p->levels = level_of(p, p->radius[order[points->count - 1]]) + 1;
    for (int level = 0; level < p->levels; ++level) p->cell[level] = 2.0 * p->largest / ldexp(1.0, level) + p->gap;
    return place_all(p, section, seed, order, points);
}

/// Bounding radii and scales of all bodies: as the distribution says, or as the shapes have them.
static void draw_sizes(const pls_scene *scene, const pls_scene_body *body, const pls_node *given, uint64_t seed, double *radii,
                       pls_points *points)
{
    const double scale = pls_scene_number(body->node, "scale", 1.0);
    distribution d = {.kind = ONE_RADIUS};
    if (given) d = read_distribution(given);
    for (size_t k = 0; k < points->count; ++k)
    {
        const double own = pls_points_radius(scene, body, k);
        radii[k] = given ? draw_radius(&d, seed, k) : own * scale;
        points->scale[k] = given ? radii[k] / own : scale;
    }
}

pls_status pls_points_random(const pls_scene *scene, const pls_scene_body *body, const pls_node *section, pls_points *points)
{
    const pls_node *box = pls_node_get(section, "box");
    uint64_t seed = (uint64_t)pls_scene_number(section, "seed", 1.0);
    points->count = (size_t)pls_scene_number(section, "count", 0.0);
    PLS_TRY(pls_allocate(&points->position, points->count, sizeof *points->position, "places of bodies"));
    PLS_TRY(pls_allocate(&points->scale, points->count, sizeof *points->scale, "sizes of bodies"));
    double *radii;
    uint32_t *order = NULL;
    PLS_TRY(pls_allocate(&radii, points->count, sizeof *radii, "radii of bodies"));
    draw_sizes(scene, body, pls_node_get(section, "radius"), seed, radii, points);
    packing p = {.lower = pls_scene_vector(box, "lower"),
                 .upper = pls_scene_vector(box, "upper"),
                 .gap = pls_scene_number(section, "gap", 0.0),
                 .dimension = scene->dimension,
                 .radius = radii,
                 .position = points->position};
    pls_status status = pls_allocate(&order, points->count, sizeof *order, "an order of bodies");
    if (status == PLS_OK) status = pack(&p, section, seed, order, points);
    pls_release(&order);
    pls_release(&p.bucket);
    pls_release(&p.next);
    pls_release(&radii);
    return status;
}
