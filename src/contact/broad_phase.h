// broad_phase.h -- all pairs of bounded bodies nearer than a given gap, in time linear in bodies and pairs for any spread of sizes.
#ifndef PLS_CONTACT_BROAD_PHASE_H
#define PLS_CONTACT_BROAD_PHASE_H

#include "model/bodies.h"
#include "model/domain.h"

typedef struct pls_near_pair
{
    uint32_t owner, partner; ///< rows; the owner has the lower number
    int16_t shift[3];        ///< the partner's image lies at X + shift * edge
    int16_t spare;
} pls_near_pair;

/// Zero-initialise; `pls_near_pairs_free` releases.
typedef struct pls_near_pairs
{
    pls_near_pair *pair; ///< in order of the lower of the two rows, then of the other
    size_t count, capacity;
} pls_near_pairs;

/// Whether a force between two bodies may matter: not where neither can be moved by one (fixed, driven along all axes, walls).
static inline bool pls_pair_matters(const pls_bodies *bodies, uint32_t a, uint32_t b)
{
    return bodies->load[a].inv_mass != 0.0 || bodies->load[b].inv_mass != 0.0;
}

/// Pairs with |X_j - X_i| < r_i + r_j + gap that matter. LIMIT_EXCEEDED where a periodic edge is shorter than 4 r_max + 2 gap.
pls_status pls_broad_phase(const pls_bodies *bodies, const pls_domain *domain, double gap, pls_near_pairs *pairs);
void pls_near_pairs_free(pls_near_pairs *pairs);

/// Key of a position along a space-filling (Morton) curve with 21 bits per axis; `cell` is the length of a step [m].
uint64_t pls_morton_key(const double position[3], const double lower[3], double cell);

#endif
