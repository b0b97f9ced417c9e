// sphere_contact.h -- contacts of spheres (discs) with each other and with half-spaces: from the pair list to forces in slots.
#ifndef PLS_CONTACT_SPHERE_CONTACT_H
#define PLS_CONTACT_SPHERE_CONTACT_H

#include "contact/pair_list.h"
#include "math/simd.h"

/// Arrays of one block of work, filled by the geometry, worked on by the law, read when forces are stored. One per thread.
typedef struct pls_contact_work
{
    // of sphere pairs: columns loaded from the rows of both bodies
    _Alignas(64) double velocity[3][PLS_CONTACT_BLOCK];                             ///< of i less j, mid-step [m/s]
    _Alignas(64) double lead[3][PLS_CONTACT_BLOCK];                                 ///< what leads to that of the end [m/s]
    _Alignas(64) double turn[3][PLS_CONTACT_BLOCK], turn_end[3][PLS_CONTACT_BLOCK]; ///< r_i w_i + r_j w_j, mid-step and end [m/s]
    _Alignas(64) double sum[3][PLS_CONTACT_BLOCK], sum_end[3][PLS_CONTACT_BLOCK];   ///< w_i + w_j [rad/s]
    _Alignas(64) double inv_distance[PLS_CONTACT_BLOCK],
        growth[PLS_CONTACT_BLOCK]; ///< of the centres [1/m]; of both radii in half a step [m]
    // of all pairs
    _Alignas(64) double normal[3][PLS_CONTACT_BLOCK]; ///< from i to j
    _Alignas(64) double delta[PLS_CONTACT_BLOCK];     ///< overlap [m]
    _Alignas(64) double lever[PLS_CONTACT_BLOCK]; ///< sphere pairs: delta/2; walls: distance of the contact point from the centre of i [m]
    _Alignas(64) double normal_velocity[PLS_CONTACT_BLOCK];
    _Alignas(64) double slip_velocity[3][PLS_CONTACT_BLOCK];
    _Alignas(64) double slip_step[3][PLS_CONTACT_BLOCK]; ///< tangential displacement in this step [m]
    _Alignas(64) double effective_radius[PLS_CONTACT_BLOCK];
    _Alignas(64) double effective_mass[PLS_CONTACT_BLOCK];
    _Alignas(64) double spring[3][PLS_CONTACT_BLOCK];
    _Alignas(64) double history[PLS_LAW_MAX_HISTORY][PLS_CONTACT_BLOCK];
    _Alignas(64) double normal_force[PLS_CONTACT_BLOCK];
    _Alignas(64) double shear_force[3][PLS_CONTACT_BLOCK];
    _Alignas(64) double damping_power[PLS_CONTACT_BLOCK];
    _Alignas(64) double slip_work[PLS_CONTACT_BLOCK];
    _Alignas(64) double point[3][PLS_CONTACT_BLOCK]; ///< walls: contact point from the wall's position [m]
    uint32_t active[PLS_CONTACT_BLOCK + 16];         ///< candidates that touch
    uint32_t fresh[PLS_CONTACT_BLOCK];               ///< places in `active` of contacts that began in this step
    size_t active_count, fresh_count;
} pls_contact_work;

/// What the loops read besides the pair list.
typedef struct pls_contact_input
{
    const pls_body_place *place;
    const pls_body_spin *spin;
    const pls_body_load *load;
    const pls_body_before *before;
    const pls_body_orientation *orientation;
    const pls_domain *domain;
    const pls_law_table *laws;
    bool large;   ///< bodies and contacts do not fit the near caches: fetch ahead
    bool growing; ///< radii may have changed in this step
    double dt;    ///< [s]; 0 at the start of a run: no time has passed, springs and dissipation stay
} pls_contact_input;

PLS_SIMD_DECLARE(void, pls_contact_block, pls_pair_list *list, const pls_contact_input *input, const pls_pair_block *block,
                 pls_contact_work *work);

/// For each set of lanes (a byte) their numbers, packed to the front.
extern const uint8_t pls_packed_lanes[256][8];

/// Outward normal of a half-space.
pls_vec3 pls_wall_normal(const pls_body_orientation *orientation, int dimension);

#endif
