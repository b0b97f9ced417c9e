// broad_phase.c -- a stack of grids, one per size class.
//
// A body of reach e = radius + gap/2 belongs to level floor(log2(e_max / e)), whose cells are as wide as the largest diameter of the level. It is tested against
// the bodies of its own level and of all coarser levels in the 3^d cells around it: whoever is nearer than e_i + e_j <= the coarser level's cell is there. Every
// body looks at a bounded number of cells per level, so the cost is linear in bodies for any spread of sizes: a large body never visits its many small
// neighbours' cells, they visit its own.
//
// Cells of a level are bounded in number (cells.h), so memory is linear too; bodies that share a cell from far away cost a distance test and nothing else.
//
// The pairs come out in an order fixed by rows and numbers, whatever the number of threads: each block of bodies fills a buffer of its own.

#include "contact/broad_phase.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "base/sort.h"
#include "contact/cells.h"

#include <string.h>

enum {
    MAX_LEVELS = 32,
    LOOK_BLOCK = 512, ///< bodies per block of the search
    LONG_ROW = 64     ///< pairs of one body above which they are sorted by digits
};

typedef struct packed_body
{
    double x[3]; ///< wrapped into the box along periodic axes
    double reach;
    uint32_t row, number;
} packed_body;

typedef struct grid_level
{
    size_t bodies;
    pls_cells cells;
    size_t cell_start; ///< first entry in `starts`
} grid_level;

typedef struct grids
{
    const pls_bodies *bodies;
    const pls_domain *domain;
    double lower[3], upper[3];
    double reach_max;
    int level_count;
    grid_level level[MAX_LEVELS];
    uint32_t *starts;    ///< per level one offset more than it has cells, into `body`
    packed_body *body;   ///< by level, then cell
    uint32_t *cell_of;   ///< place in `starts` of each row's cell
    uint8_t *level_of;   ///< level of each row; MAX_LEVELS for unbounded bodies
    int16_t (*image)[3]; ///< periodic image each row lies in
    size_t bounded;
} grids;

void pls_near_pairs_free(pls_near_pairs *pairs)
{
    pls_release(&pairs->pair);
    memset(pairs, 0, sizeof *pairs);
}

static uint64_t spread_bits(uint64_t v)
{
    v &= 0x1fffff;
    v = (v | v << 32) & UINT64_C(0x1f00000000ffff);
    v = (v | v << 16) & UINT64_C(0x1f0000ff0000ff);
    v = (v | v << 8) & UINT64_C(0x100f00f00f00f00f);
    v = (v | v << 4) & UINT64_C(0x10c30c30c30c30c3);
    v = (v | v << 2) & UINT64_C(0x1249249249249249);
    return v;
}

uint64_t pls_morton_key(const double position[3], const double lower[3], double cell)
{
    uint64_t key = 0;
    for (int a = 0; a < 3; ++a)
    {
        double place = (position[a] - lower[a]) / cell;
        uint64_t step = place > 0.0 ? place < 2097151.0 ? (uint64_t)place : 2097151u : 0u;
        key |= spread_bits(step) << a;
    }
    return key;
}

static pls_status measure(grids *g)
{
    const pls_bodies *bodies = g->bodies;
    double smallest = INFINITY;
    for (int a = 0; a < 3; ++a) g->lower[a] = INFINITY, g->upper[a] = -INFINITY;
    g->reach_max = 0.0;
    for (size_t row = 0; row < bodies->count; ++row)
    {
        const pls_body_place *p = &bodies->place[row];
        if (bodies->kind[row].flags & PLS_BODY_UNBOUNDED) continue;
        const double x[3] = {p->x, p->y, p->z};
        for (int a = 0; a < 3; ++a)
        {
            if (x[a] < g->lower[a]) g->lower[a] = x[a];
            if (x[a] > g->upper[a]) g->upper[a] = x[a];
        }
        if (p->radius > g->reach_max) g->reach_max = p->radius;
        if (p->radius < smallest) smallest = p->radius;
        ++g->bounded;
    }
    return PLS_OK;
}

static pls_status assign_levels(grids *g, double gap)
{
    const pls_bodies *bodies = g->bodies;
    g->reach_max += 0.5 * gap;
    for (int a = 0; a < 3; ++a)
        if (g->domain->periodic[a] && g->domain->edge[a] < 4.0 * g->reach_max)
            return pls_fail(PLS_LIMIT_EXCEEDED,
                            "the periodic box is %g m wide along %c; it must be at least %g m: two largest diameters plus the skin, so "
                            "that a body never meets two images "
                            "of another. Make the box wider or that axis not periodic",
                            g->domain->edge[a], "xyz"[a], 4.0 * g -> reach_max);
    for (size_t row = 0; row < bodies->count; ++row)
    {
        if (bodies->kind[row].flags & PLS_BODY_UNBOUNDED)
        {
            g->level_of[row] = MAX_LEVELS;
            continue;
        }
        double ratio = g->reach_max / (bodies->place[row].radius + 0.5 * gap);
        int k = ilogb(ratio);
        if (k < 0) k = 0;
        if (k >= MAX_LEVELS) k = MAX_LEVELS - 1;
        g->level_of[row] = (uint8_t)k;
        ++g->level[k].bodies;
        if (k >= g->level_count) g->level_count = k + 1;
    }
    return PLS_OK;
}

static pls_status fill_cells(grids *g, double gap)
{
    const pls_bodies *bodies = g->bodies;
    size_t starts = 0;
    for (int k = 0; k < g->level_count; ++k)
    {
        const double width = 2.0 * g->reach_max / (double)(UINT64_C(1) << k);
        g->level[k].cells = pls_cells_make(g->domain, g->lower, g->upper, width, g->level[k].bodies);
        g->level[k].cell_start = starts;
        starts += g->level[k].cells.count + 1;
    }
    PLS_TRY(pls_allocate(&g->starts, starts + 1, sizeof *g->starts, "the cells of the broad phase"));
    for (size_t row = 0; row < bodies->count; ++row)
    {
        if (g->level_of[row] == MAX_LEVELS) continue;
        const grid_level *level = &g->level[g->level_of[row]];
        const pls_cells *cells = &level->cells;
        const double x[3] = {bodies->place[row].x, bodies->place[row].y, bodies->place[row].z};
        size_t cell = 0;
        for (int a = 2; a >= 0; --a)
        {
            int16_t image;
            double w = pls_wrap_position(g->domain, a, x[a], &image);
            if (g->image) g->image[row][a] = image;
            cell = cell * (size_t)cells->along[a] + (size_t)pls_wrap_cell(pls_cell_along(cells, a, w), cells->along[a]);
        }
        g->cell_of[row] = (uint32_t)(level->cell_start + cell);
        ++g->starts[g->cell_of[row] + 1];
    }
    for (size_t k = 1; k <= starts; ++k) g->starts[k] += g->starts[k - 1];
    // Place bodies; `starts` of a cell moves to its end, which is the start of the next, and is set back below.
    for (size_t row = 0; row < bodies->count; ++row)
    {
        if (g->level_of[row] == MAX_LEVELS) continue;
        packed_body *b = &g->body[g->starts[g->cell_of[row]]++];
        const double x[3] = {bodies->place[row].x, bodies->place[row].y, bodies->place[row].z};
        for (int a = 0; a < 3; ++a)
        {
            int16_t image;
            b->x[a] = pls_wrap_position(g->domain, a, x[a], &image);
        }
        b->reach = bodies->place[row].radius + 0.5 * gap;
        b->row = (uint32_t)row;
        b->number = bodies->kind[row].number;
    }
    memmove(g->starts + 1, g->starts, starts * sizeof *g->starts);
    g->starts[0] = 0;
    return PLS_OK;
}

typedef struct look_buffer
{
    pls_near_pair *pair;
    size_t count, capacity;
} look_buffer;

static pls_status emit(const grids *g, look_buffer *out, const packed_body *a, const packed_body *b, const int16_t step[3])
{
    // `step`: b's image lies at its wrapped position + step * edge. Positions themselves are not wrapped, so the images they lie in count too.
    if (!pls_pair_matters(g->bodies, a->row, b->row)) return PLS_OK;
    if (out->count == out->capacity) PLS_TRY(pls_reserve(&out->pair, &out->capacity, out->count + 1024, sizeof *out->pair, "near pairs"));
    bool swap = b->number < a->number;
    pls_near_pair *pair = &out->pair[out->count++];
    pair->owner = swap ? b->row : a->row;
    pair->partner = swap ? a->row : b->row;
    pair->spare = 0;
    for (int k = 0; k < 3; ++k)
    {
        int shift = g->image ? step[k] + g->image[a->row][k] - g->image[b->row][k] : 0;
        pair->shift[k] = (int16_t)(swap ? -shift : shift);
    }
    return PLS_OK;
}

/// Test `a` against the bodies of one level around it. Of its own level it takes partners of higher number, so that each pair comes once.
static pls_status look_around(const grids *g, look_buffer *out, const packed_body *a, int k, bool own)
{
    const grid_level *level = &g->level[k];
    const pls_cells *cells = &level->cells;
    if (level->bodies == 0) return PLS_OK;
    int64_t centre[3], from[3], to[3];
    for (int c = 0; c < 3; ++c)
    {
        centre[c] = pls_cell_along(cells, c, a->x[c]);
        bool narrow = cells->along[c] < 3; // fewer cells than neighbours: visit each once
        from[c] = narrow ? 0 : centre[c] - 1;
        to[c] = narrow ? cells->along[c] - 1 : centre[c] + 1;
    }
    const double *edge = g->domain->edge;
    for (int64_t z = from[2]; z <= to[2]; ++z)
        for (int64_t y = from[1]; y <= to[1]; ++y)
        {
            size_t base = level->cell_start + ((size_t)pls_wrap_cell(z, cells->along[2]) * (size_t)cells->along[1] +
                                               (size_t)pls_wrap_cell(y, cells->along[1])) *
                                                  (size_t)cells->along[0];
            for (int64_t x = from[0]; x <= to[0]; ++x)
            {
                size_t cell = base + (size_t)pls_wrap_cell(x, cells->along[0]);
                for (uint32_t m = g->starts[cell]; m < g->starts[cell + 1]; ++m)
                {
                    const packed_body *b = &g->body[m];
                    double d[3], square = 0.0, range = a->reach + b->reach;
                    int16_t step[3] = {0, 0, 0};
                    for (int c = 0; c < 3; ++c)
                    {
                        d[c] = b->x[c] - a->x[c];
                        if (edge[c] > 0.0) // nearest image; the box is wider than two ranges, so there is one only
                        {
                            if (d[c] > 0.5 * edge[c])
                                d[c] -= edge[c], step[c] = -1;
                            else if (d[c] < -0.5 * edge[c])
                                d[c] += edge[c], step[c] = 1;
                        }
                        square += d[c] * d[c];
                    }
                    if (square >= range * range || a->row == b->row) continue;
                    if (own && b->number < a->number) continue;
                    PLS_TRY(emit(g, out, a, b, step));
                }
            }
        }
    return PLS_OK;
}

static pls_status look_block(const grids *g, size_t block, look_buffer *out)
{
    for (size_t m = block * LOOK_BLOCK; m < pls_block_end(block, LOOK_BLOCK, g->bounded); ++m)
    {
        const packed_body *a = &g->body[m];
        int own = g->level_of[a->row];
        for (int k = 0; k <= own; ++k) PLS_TRY(look_around(g, out, a, k, k == own));
    }
    return PLS_OK;
}

static uint32_t lower_row(const pls_near_pair *pair) { return pair->owner < pair->partner ? pair->owner : pair->partner; }
static uint32_t upper_row(const pls_near_pair *pair) { return pair->owner < pair->partner ? pair->partner : pair->owner; }

/// Many pairs of one body, far larger than its neighbours.
static pls_status order_long_row(pls_near_pair *p, size_t n)
{
    uint32_t *keys = NULL, *from = NULL;
    pls_near_pair *copy = NULL;
    pls_status status = pls_allocate(&keys, n, sizeof *keys, "ordering near pairs");
    if (status == PLS_OK) status = pls_allocate(&from, n, sizeof *from, "ordering near pairs");
    if (status == PLS_OK) status = pls_allocate(&copy, n, sizeof *copy, "ordering near pairs");
    for (size_t k = 0; status == PLS_OK && k < n; ++k)
    {
        keys[k] = upper_row(&p[k]);
        from[k] = (uint32_t)k;
        copy[k] = p[k];
    }
    if (status == PLS_OK) status = pls_radix_sort_u32(keys, from, n);
    for (size_t k = 0; status == PLS_OK && k < n; ++k) p[k] = copy[from[k]];
    pls_release(&keys);
    pls_release(&from);
    pls_release(&copy);
    return status;
}

static pls_status order_row(pls_near_pair *p, size_t n)
{
    if (n > LONG_ROW) return order_long_row(p, n);
    for (size_t k = 1; k < n; ++k) // nearly in order
    {
        pls_near_pair moving = p[k];
        uint32_t key = upper_row(&moving);
        size_t m = k;
        for (; m > 0 && upper_row(&p[m - 1]) > key; --m) p[m] = p[m - 1];
        p[m] = moving;
    }
    return PLS_OK;
}

/// Bring the blocks' pairs into order of the lower row, then of the other.
static pls_status order_pairs(const grids *g, const look_buffer *buffer, size_t blocks, pls_near_pairs *pairs)
{
    size_t total = 0, rows = g->bodies->count;
    for (size_t b = 0; b < blocks; ++b) total += buffer[b].count;
    if (total >= UINT32_MAX / 2)
        return pls_fail(PLS_LIMIT_EXCEEDED, "%zu near pairs are more than the %u the pair list can hold", total, UINT32_MAX / 2);
    PLS_TRY(pls_reserve(&pairs->pair, &pairs->capacity, total, sizeof *pairs->pair, "near pairs"));
    uint32_t *start = NULL;
    PLS_TRY(pls_allocate(&start, rows + 2, sizeof *start, "ordering near pairs"));
    for (size_t b = 0; b < blocks; ++b)
        for (size_t k = 0; k < buffer[b].count; ++k) ++start[lower_row(&buffer[b].pair[k]) + 2];
    for (size_t row = 2; row < rows + 2; ++row) start[row] += start[row - 1];
    for (size_t b = 0; b < blocks; ++b)
        for (size_t k = 0; k < buffer[b].count; ++k) pairs->pair[start[lower_row(&buffer[b].pair[k]) + 1]++] = buffer[b].pair[k];
    pls_status worst = PLS_OK;
#pragma omp parallel for schedule(static)
    for (size_t row = 0; row < rows; ++row)
    {
        pls_status status = order_row(pairs->pair + start[row], start[row + 1] - start[row]);
        if (status != PLS_OK)
        {
#pragma omp critical(pls_broad_phase_failure)
            worst = status;
        }
    }
    pls_release(&start);
    if (worst != PLS_OK) return pls_fail(worst, "no memory to order the near pairs");
    pairs->count = total;
    return PLS_OK;
}

static pls_status search(grids *g, double gap, look_buffer *buffer, size_t blocks)
{
    PLS_TRY(fill_cells(g, gap));
    pls_status worst = PLS_OK;
#pragma omp parallel for schedule(dynamic, 1)
    for (size_t b = 0; b < blocks; ++b)
    {
        pls_status status = look_block(g, b, &buffer[b]);
        if (status != PLS_OK)
        {
#pragma omp critical(pls_broad_phase_failure)
            worst = status;
        }
    }
    if (worst != PLS_OK) return pls_fail(worst, "the broad phase found no memory for its pairs");
    return PLS_OK;
}

pls_status pls_broad_phase(const pls_bodies *bodies, const pls_domain *domain, double gap, pls_near_pairs *pairs)
{
    grids g = {.bodies = bodies, .domain = domain};
    pairs->count = 0;
    PLS_TRY(measure(&g));
    if (g.bounded < 2) return PLS_OK;
    size_t blocks = pls_block_count(g.bounded, LOOK_BLOCK);
    look_buffer *buffer = NULL;
    pls_status status = pls_allocate(&g.level_of, bodies->count, sizeof *g.level_of, "levels of bodies");
    if (status == PLS_OK) status = pls_allocate(&g.cell_of, bodies->count, sizeof *g.cell_of, "cells of bodies");
    if (status == PLS_OK) status = pls_allocate(&g.body, g.bounded, sizeof *g.body, "bodies in order of cells");
    if (status == PLS_OK && domain->any_periodic) status = pls_allocate(&g.image, bodies->count, sizeof *g.image, "images of bodies");
    if (status == PLS_OK) status = assign_levels(&g, gap);
    if (status == PLS_OK) status = pls_allocate(&buffer, blocks, sizeof *buffer, "buffers of the broad phase");
    if (status == PLS_OK) status = search(&g, gap, buffer, blocks);
    // The grid is done with; release it first, the ordered pairs need room.
    pls_release(&g.body);
    pls_release(&g.starts);
    pls_release(&g.cell_of);
    if (status == PLS_OK) status = order_pairs(&g, buffer, blocks, pairs);
    for (size_t b = 0; buffer && b < blocks; ++b) pls_release(&buffer[b].pair);
    pls_release(&buffer);
    pls_release(&g.level_of);
    pls_release(&g.image);
    return status;
}
