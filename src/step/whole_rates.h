// whole_rates.h -- the largest eigenvalues of stiffness and damping of all contacts together.
#ifndef PLS_STEP_WHOLE_RATES_H
#define PLS_STEP_WHOLE_RATES_H

#include "step/contact_rates.h"

/// Largest eigenvalues of M^-1 K [1/s^2] and M^-1 C [1/s], a margin of 3 % included. Each body has at least `coordination` contacts.
/// Reproducible within the tolerance of the iteration (the order of bodies in memory shows in it): good for refusing a step, not for choosing one.
pls_status pls_whole_rates(const pls_world *world, int coordination, double *stiffness, double *damping);

#endif
