// sweep.h -- the bodies' part of steps: half kick and drift; contacts, forces and velocities of the end.
#ifndef PLS_STEP_SWEEP_H
#define PLS_STEP_SWEEP_H

#include "step/world.h"

enum {
    PLS_GUARD_STEPS = 64,   ///< steps between looks at overlaps and lost bodies, at least: looks that cannot find anything are left out
    PLS_STABLE_STEPS = 4096 ///< steps between looks at the stable step; a multiple of the former
};

/// Half kick and drift of all bodies.
pls_status pls_begin_bodies(pls_world *world);

/// Contacts, and forces and velocities of the end of the step. Where steps may run into each other, bodies begin the next step at once, and further steps are swept
/// up to step `end` while the pair list holds. `begun` tells whether the step to come has begun; where it has not, the last step swept is not counted yet.
/// dt: 0 at the start of a run.
pls_status pls_sweep(pls_world *world, double dt, uint64_t end, bool *begun);

#endif
