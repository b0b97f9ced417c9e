// cells.c -- how many cells space is cut into.

#include "contact/cells.h"

pls_cells pls_cells_make(const pls_domain *domain, const double lower[3], const double upper[3], double width, size_t bodies)
{
    pls_cells cells = {.count = 1};
    double limit = 2.0 * (double)bodies + 64.0, size[3];
    width *= 1.0 + 1e-9; // rounding must not make a cell too narrow
    for (int a = 0; a < 3; ++a)
    {
        const bool periodic = domain->periodic[a];
        double extent = periodic ? domain->edge[a] : upper[a] - lower[a];
        double needed = floor(extent / width) + (periodic ? 0.0 : 1.0);
        size[a] = needed < 1.0 ? 1.0 : needed;
        cells.lower[a] = periodic ? domain->lower[a] : lower[a];
        cells.inv_width[a] = periodic ? size[a] / extent : 1.0 / width;
        cells.around[a] = periodic;
    }
    // Too many cells for the bodies: coarsen periodic axes evenly, wrap the others (at least 3 cells, so that a cell's two neighbours differ).
    while (size[0] * size[1] * size[2] > limit)
    {
        int longest = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
        if (size[longest] <= 4.0) break;
        size[longest] = ceil(size[longest] / 2.0);
        cells.around[longest] = true;
        if (domain->periodic[longest]) cells.inv_width[longest] = size[longest] / domain->edge[longest];
    }
    for (int a = 0; a < 3; ++a)
    {
        cells.along[a] = (int64_t)size[a];
        cells.count *= (size_t)cells.along[a];
    }
    return cells;
}
