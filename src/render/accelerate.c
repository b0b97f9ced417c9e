// accelerate.c -- bodies sorted into the columns of a grid.
//
// All rays of a picture come from the eye, so tiles of the picture are the columns; all rays to the light are parallel, so a grid across them is. A ray then reads one
// list, sorted by depth, and stops at the first body that cannot be nearer than what it has met. Bodies are sorted once and dealt out in that order, so that no list is
// sorted by itself; the order depends on nothing but depths and numbers.

#include "render/render.h"

#include "base/sort.h"

#include <string.h>

/// Bits that sort like the number.
static uint64_t sortable(double depth)
{
    uint64_t bits;
    memcpy(&bits, &depth, sizeof bits);
    return bits >> 63 ? ~bits : bits | (uint64_t)1 << 63;
}

static pls_status sort_by_depth(const pls_render_extent *extent, size_t count, uint32_t **order)
{
    uint64_t *key = NULL;
    pls_status status = pls_allocate(&key, count, sizeof *key, "the depths of a picture");
    if (status == PLS_OK) status = pls_allocate(order, count, sizeof **order, "the order of a picture");
    for (size_t k = 0; status == PLS_OK && k < count; ++k)
    {
        key[k] = sortable(extent[k].depth);
        (*order)[k] = (uint32_t)k;
    }
    if (status == PLS_OK) status = pls_radix_sort_u64(key, *order, count);
    pls_release(&key);
    return status;
}

static void count_cells(pls_render_grid *grid, const pls_render_extent *extent, size_t count)
{
    for (size_t k = 0; k < count; ++k)
    {
        for (int y = extent[k].y0; extent[k].x0 <= extent[k].x1 && y <= extent[k].y1; ++y)
        {
            for (int x = extent[k].x0; x <= extent[k].x1; ++x) grid->start[y * grid->columns + x]++;
        }
    }
}

/// Deal the bodies out; `start` of each cell moves to its end, which is the next one's start.
static void deal(pls_render_grid *grid, const pls_render_extent *extent, const uint32_t *order, size_t count)
{
    for (size_t k = 0; k < count; ++k)
    {
        const pls_render_extent *e = &extent[order[k]];
        for (int y = e->y0; e->x0 <= e->x1 && y <= e->y1; ++y)
        {
            for (int x = e->x0; x <= e->x1; ++x) grid->body[grid->start[y * grid->columns + x]++] = order[k];
        }
    }
    size_t cells = (size_t)grid->columns * (size_t)grid->rows;
    memmove(grid->start + 1, grid->start, cells * sizeof *grid->start);
    grid->start[0] = 0;
}

pls_status pls_render_grid_make(pls_render_grid *grid, int columns, int rows, const pls_render_extent *extent, size_t count)
{
    *grid = (pls_render_grid){.columns = columns, .rows = rows};
    size_t cells = (size_t)columns * (size_t)rows;
    uint32_t *order = NULL;
    pls_status status = pls_allocate(&grid->start, cells + 1, sizeof *grid->start, "the grid of a picture");
    if (status == PLS_OK) count_cells(grid, extent, count);
    if (status == PLS_OK) status = pls_prefix_sum_u32(grid->start, cells);
    if (status == PLS_OK) status = pls_allocate(&grid->body, grid->start[cells], sizeof *grid->body, "the grid of a picture");
    if (status == PLS_OK) status = sort_by_depth(extent, count, &order);
    if (status == PLS_OK) deal(grid, extent, order, count);
    pls_release(&order);
    if (status != PLS_OK) pls_render_grid_free(grid);
    return status;
}

void pls_render_grid_free(pls_render_grid *grid)
{
    pls_release(&grid->start);
    pls_release(&grid->body);
    *grid = (pls_render_grid){0};
}
