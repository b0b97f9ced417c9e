// sphere_contact.h -- contacts of spheres (discs) with each other and with half-spaces: from the pair list to forces in slots.
#ifndef PLS_CONTACT_SPHERE_CONTACT_H
#define PLS_CONTACT_SPHERE_CONTACT_H

#include "contact/pair_list.h"
#include "math/simd.h"

/// Doubles from one array of the work space to the next. Half as much again as a block needs, so that what a conveyor uses of each, the first half kilobyte, is spread
/// over all sets of the first-level cache; with powers of two all lay in half of them.
enum { PLS_WORK_STRIDE = PLS_CONTACT_BLOCK + 64 };

/// Arrays of one block of work, filled by the geometry, worked on by the law, read when forces are stored. One per thread.
typedef struct pls_contact_work
{
    // Some places are used twice, so that all of this stays in the first-level cache.
    _Alignas(64) double normal[3][PLS_WORK_STRIDE];        ///< from i to j; first X_j - X_i [m]
    _Alignas(64) double delta[PLS_WORK_STRIDE];            ///< overlap; first r_i + r_j [m]
    _Alignas(64) double slip_velocity[3][PLS_WORK_STRIDE]; ///< at the end of the step; first that of the centres, j less i [m/s]
    _Alignas(64) double normal_velocity[PLS_WORK_STRIDE];  ///< [m/s]
    _Alignas(64) double spring[3][PLS_WORK_STRIDE];        ///< [m]
    _Alignas(64) double normal_force[PLS_WORK_STRIDE];     ///< [N]
    _Alignas(64) double shear_force[3][PLS_WORK_STRIDE];   ///< [N]
    _Alignas(64) double damping_power[PLS_WORK_STRIDE];    ///< [W]
    _Alignas(64) double slip_work[PLS_WORK_STRIDE];        ///< [J]
    // of whole vectors
    _Alignas(64) double square[PLS_WORK_STRIDE]; ///< of the trial shear force [N^2]
    _Alignas(64) double cone[PLS_WORK_STRIDE];   ///< largest shear force [N]; then what the trial is multiplied by
    // of sphere pairs
    _Alignas(64) double distance[PLS_WORK_STRIDE];     ///< of the centres [m]
    _Alignas(64) double inv_distance[PLS_WORK_STRIDE]; ///< [1/m]
    _Alignas(64) double velocity[3][PLS_WORK_STRIDE];  ///< of the centres, j less i, mid-step [m/s]
    _Alignas(64) double spin[3][PLS_WORK_STRIDE];      ///< w_i + w_j, mid-step [rad/s]
    _Alignas(64) double spin_end[3][PLS_WORK_STRIDE];  ///< w_i + w_j at the end of the step [rad/s]
    _Alignas(64) double skew[3][PLS_WORK_STRIDE];      ///< (r_i - r_j)/2 (w_i - w_j), mid-step [m/s]
    _Alignas(64) double skew_end[3][PLS_WORK_STRIDE];  ///< the same at the end of the step
    _Alignas(64) double growth[PLS_WORK_STRIDE];       ///< of both radii in half a step [m]
    // of walls
    _Alignas(64) double lever[PLS_WORK_STRIDE];    ///< distance of the contact point from the centre of i [m]
    _Alignas(64) double point[3][PLS_WORK_STRIDE]; ///< contact point from the wall's position [m]
    // for laws that ask
    _Alignas(64) double effective_radius[PLS_WORK_STRIDE];
    _Alignas(64) double effective_mass[PLS_WORK_STRIDE];
    _Alignas(64) double history[PLS_LAW_MAX_HISTORY][PLS_WORK_STRIDE];
    uint32_t active[PLS_CONTACT_BLOCK + 16]; ///< candidates that were picked because they touch
    size_t active_count;
    uint8_t now[PLS_CONTACT_BLOCK / 8];   ///< bit k % 8 of byte k / 8: candidate k of a block of whole vectors touches
    uint8_t fresh[PLS_CONTACT_BLOCK / 8]; ///< bit k % 8 of byte k / 8: contact k of the arrays began in this step
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
    bool vast;    ///< nor the last one
    bool growing; ///< radii may have changed in this step
    bool kept;    ///< contacts may be looked at after this step
    double dt;    ///< [s]; 0 at the start of a run: no time has passed, springs and dissipation stay
} pls_contact_input;

PLS_SIMD_DECLARE(void, pls_contact_block, pls_pair_list *list, const pls_contact_input *input, const pls_pair_block *block,
                 pls_contact_work *work);

/// Ask a law, through its door, about the first `count` (a multiple of 8) contacts of the work space.
void pls_contact_law(const pls_law *law, double dt, size_t count, pls_contact_work *work);

/// For each set of lanes (a byte) their numbers, packed to the front.
extern const uint8_t pls_packed_lanes[256][8];

/// Outward normal of a half-space.
pls_vec3 pls_wall_normal(const pls_body_orientation *orientation, int dimension);

#endif
