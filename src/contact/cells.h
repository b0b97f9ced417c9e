// cells.h -- space cut into equal cells, about twice as many as there are bodies at most.
//
// The cells form a box of bounded size that wraps around where bodies reach further: a position far away shares a cell with others, so a body that flies away
// harms nobody. Along periodic axes the cells divide the box evenly.
#ifndef PLS_CONTACT_CELLS_H
#define PLS_CONTACT_CELLS_H

#include "model/domain.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct pls_cells
{
    double lower[3], inv_width[3];
    int64_t along[3]; ///< cells along each axis
    bool around[3];   ///< the first cell is the neighbour of the last one
    size_t count;
} pls_cells;

/// Cells at least as wide as `width` over lower .. upper; along periodic axes over the period.
pls_cells pls_cells_make(const pls_domain *domain, const double lower[3], const double upper[3], double width, size_t bodies);

static inline int64_t pls_wrap_cell(int64_t c, int64_t n)
{
    if (c >= 0 && c < n) return c;
    int64_t r = c % n;
    return r < 0 ? r + n : r;
}

/// Which cell along an axis; not wrapped. x: within the box along periodic axes.
static inline int64_t pls_cell_along(const pls_cells *cells, int axis, double x)
{
    double place = floor((x - cells->lower[axis]) * cells->inv_width[axis]);
    if (!(place > -1e15 && place < 1e15)) place = 0.0;
    return (int64_t)place;
}

/// Position within the box and the image it came from.
static inline double pls_wrap_position(const pls_domain *domain, int axis, double x, int16_t *image)
{
    if (!domain->periodic[axis])
    {
        *image = 0;
        return x;
    }
    double turns = floor((x - domain->lower[axis]) / domain->edge[axis]);
    if (turns > 16000.0) turns = 16000.0;
    if (turns < -16000.0) turns = -16000.0;
    *image = (int16_t)turns;
    return x - turns * domain->edge[axis];
}

#endif
