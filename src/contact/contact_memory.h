// contact_memory.h -- how making a pair list uses what contacts remember.
#ifndef PLS_CONTACT_CONTACT_MEMORY_H
#define PLS_CONTACT_CONTACT_MEMORY_H

#include "contact/pair_list.h"

/// Which image along an edge lies nearest, for a difference of positions d [m].
static inline int16_t pls_nearest_image(double d, double edge)
{
    return edge > 0.0 ? (int16_t)fmax(fmin(-rint(d / edge), 32000.0), -32000.0) : 0;
}

enum { PLS_LONG_ROW = 64 }; ///< entries of one body above which they are sorted by digits

/// Pairs remembered that may lie further apart than the skin: 2^32 a + b, ascending. Nearly always there are none.
typedef struct pls_kept_pairs
{
    uint64_t *sphere; ///< a: lower row, b: upper row
    size_t sphere_count, sphere_capacity;
    uint64_t *wall; ///< a: row of the wall, b: of the body
    size_t wall_count, wall_capacity;
} pls_kept_pairs;

/// Remembered pairs that the broad phase may have left out. Zero-initialise; `pls_kept_pairs_free` releases.
pls_status pls_find_kept(pls_kept_pairs *kept, const pls_bodies *bodies, const pls_domain *domain, double skin,
                         const pls_contact_memory *memory);
void pls_kept_pairs_free(pls_kept_pairs *kept);
bool pls_is_kept_at_wall(const pls_kept_pairs *kept, uint32_t wall, size_t row);
/// Merge kept pairs of spheres into the near pairs, whose order is the same, where they are missing.
pls_status pls_add_kept(pls_near_pairs *near, const pls_kept_pairs *kept, const pls_bodies *bodies, const pls_domain *domain);
/// Give the candidates of a list what is remembered of them; those touch.
pls_status pls_contact_memory_put_back(pls_pair_list *list, const pls_bodies *bodies, const pls_contact_memory *memory);

#endif
