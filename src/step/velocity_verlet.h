// velocity_verlet.h -- the two passes over bodies that make a step, before and after forces (velocity_verlet_simd.c says how).
#ifndef PLS_STEP_VELOCITY_VERLET_H
#define PLS_STEP_VELOCITY_VERLET_H

#include "contact/pair_list.h"
#include "math/simd.h"

/// What a pass found about the bodies of a block.
typedef struct pls_drift_report
{
    double largest_square; ///< bound on the largest squared displacement [m^2]; 0 when no step began
    double poison;         ///< 0, or NaN when a position or velocity is not finite
} pls_drift_report;

/// Half kick, drift, and the lead of velocities that laws will see, for rows first .. last.
PLS_SIMD_DECLARE(void, pls_verlet_begin, pls_bodies *bodies, size_t first, size_t last, double dt, pls_drift_report *report);

/// Forces of contacts gathered in order of partner numbers, added to the given body forces (arrays of 4 per row of the block, or null); second half kick;
/// dissipation booked; for rows first .. last. With `go_on` each row begins its next step at once, as pls_verlet_begin does, and displacements are reported;
/// its forces of now, which nobody asks for then, are not stored.
PLS_SIMD_DECLARE(void, pls_verlet_finish, pls_bodies *bodies, pls_pair_list *list, size_t first, size_t last, double dt,
                 const double *force, const double *torque, bool go_on, pls_drift_report *report);

#endif
