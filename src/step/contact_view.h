// contact_view.h -- the touching contacts after the last step, in order of ids, for whoever looks at them: observers, checkpoints, frames.
#ifndef PLS_STEP_CONTACT_VIEW_H
#define PLS_STEP_CONTACT_VIEW_H

#include <particls/world.h>

/// One touching contact. i is the body with the lower persistent number unless j is unbounded: a wall is always j.
typedef struct pls_contact_entry
{
    uint32_t number_i, number_j; ///< persistent numbers
    uint32_t row_i, row_j;       ///< memory rows
    uint32_t part_i, part_j;     ///< parts of compounds and meshes, else 0
    uint32_t image;              ///< of a wall of pieces in a periodic box, else 0
    bool wall;                   ///< j is unbounded
    pls_vec3 normal;             ///< from i to j
    pls_vec3 branch;             ///< d_c = X_j - X_i across periodic images; for a wall: foot point on the wall - X_i [m]
    pls_vec3 point;              ///< contact point c [m]
    pls_vec3 force;              ///< on i [N]
    double delta;                ///< overlap [m]
    pls_contact_stiffness stiffness;
    double energy_normal, energy_shear; ///< stored [J]
} pls_contact_entry;

/// Zero-initialise; `pls_contact_view_free` releases.
typedef struct pls_contact_view
{
    pls_contact_entry *entry; ///< in order of (number_i, number_j), then of parts
    size_t count, capacity;
} pls_contact_view;

pls_status pls_contact_view_make(const pls_world *world, pls_contact_view *view);
void pls_contact_view_free(pls_contact_view *view);

#endif
