// horizon.h -- the edge of the part of a surface of triangles that is taken away: what a growing polytope is closed along.
#ifndef PLS_CONTACT_HORIZON_H
#define PLS_CONTACT_HORIZON_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { PLS_HORIZON_EDGES = 1024, PLS_HORIZON_CORNERS = 512 };

/// Directed edges of the triangles taken away that are not between two of them. Start with count 0.
typedef struct pls_horizon
{
    int count;
    uint16_t from[PLS_HORIZON_EDGES], to[PLS_HORIZON_EDGES];
} pls_horizon;

/// An edge that is met both ways lies inside and goes. What there is no room for is left out: then there is no loop.
static inline void pls_horizon_add(pls_horizon *h, uint16_t from, uint16_t to)
{
    for (int k = 0; k < h->count; ++k)
        if (h->from[k] == to && h->to[k] == from)
        {
            --h->count;
            h->from[k] = h->from[h->count], h->to[k] = h->to[h->count];
            return;
        }
    if (h->count == PLS_HORIZON_EDGES) return;
    h->from[h->count] = from, h->to[h->count] = to;
    ++h->count;
}

/// One closed line, each corner (a number below PLS_HORIZON_CORNERS) once: else the surface has lost its shape.
static inline bool pls_horizon_is_loop(const pls_horizon *h)
{
    uint16_t next[PLS_HORIZON_CORNERS];
    bool used[PLS_HORIZON_CORNERS];
    if (h->count < 3) return false;
    memset(used, 0, sizeof used);
    for (int k = 0; k < h->count; ++k)
    {
        if (used[h->from[k]]) return false;
        used[h->from[k]] = true, next[h->from[k]] = h->to[k];
    }
    uint16_t at = h->from[0];
    for (int k = 1; k <= h->count; ++k)
    {
        if (!used[at]) return false;
        at = next[at];
        if (at == h->from[0]) return k == h->count;
    }
    return false;
}

#endif
