// contact_rates.h -- contacts as the stable step sees them: stiffness and damping between two bodies, and contacts still to come.
#ifndef PLS_STEP_CONTACT_RATES_H
#define PLS_STEP_CONTACT_RATES_H

#include "step/world.h"

/// A contact as the estimate sees it.
typedef struct pls_contact_rate
{
    uint32_t i, j;           ///< rows
    bool held;               ///< no force moves j
    pls_vec3 n;              ///< from i to j
    double lever_i, lever_j; ///< contact point from the centres [m]
    pls_contact_stiffness k;
} pls_contact_rate;

/// What contacts add to one body: M^-1/2 A M^-1/2 for stiffness [1/s^2] and damping [1/s], six by six.
typedef struct pls_body_rates
{
    double stiffness[36], damping[36];
    int contacts;
} pls_body_rates;

pls_contact_rate pls_contact_rate_of(const pls_world *world, size_t candidate);

/// The moment of inertia that resists least [kg m^2].
double pls_smallest_moment(const pls_body_mass *mass, int dimension);

/// Add the contacts that a body lacks to the assumed coordination, spread evenly over directions.
void pls_add_missing_contacts(const pls_world *world, uint32_t row, int coordination, pls_body_rates *rates);

#endif
