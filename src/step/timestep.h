// timestep.h -- the stable time step.
#ifndef PLS_STEP_TIMESTEP_H
#define PLS_STEP_TIMESTEP_H

#include "step/world.h"

/// Choose dt, or check the one given, for the start of a run.
pls_status pls_choose_step(pls_world *world);
/// Have parameters that follow time or states changed the laws much since dt was last checked?
bool pls_stable_step_is_stale(const pls_world *world);
/// Check dt against the contacts of now.
pls_status pls_check_stable_step(pls_world *world);

#endif
