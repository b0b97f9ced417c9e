// contact_rates.h -- contacts as the stable step sees them: stiffness and damping between two bodies, and contacts still to come.
#ifndef PLS_STEP_CONTACT_RATES_H
#define PLS_STEP_CONTACT_RATES_H

#include "step/world.h"

/// A contact as the estimate sees it.
typedef struct pls_contact_rate
{
    uint32_t i, j;         ///< rows
    bool held;             ///< no force moves j
    pls_vec3 n;            ///< from i to j
    pls_vec3 arm_i, arm_j; ///< contact point from the centres [m]
    pls_contact_stiffness k;
} pls_contact_rate;

/// What contacts add to one body: M^-1/2 A M^-1/2 for stiffness [1/s^2] and damping [1/s], six by six.
typedef struct pls_body_rates
{
    double stiffness[36], damping[36];
    int contacts;
} pls_body_rates;

pls_contact_rate pls_contact_rate_of(const pls_world *world, size_t candidate);
enum { PLS_SOLID_RATES = 4 };
/// The same of a candidate of solids that touches: one, or four that have a quarter each and resist rocking and turning as its area of touch does. Returns how many.
int pls_solid_rates_of(const pls_world *world, size_t candidate, pls_contact_rate rates[PLS_SOLID_RATES]);

/// Root of the inverse tensor of inertia of a body, world frame: xx, yy, zz, xy, xz, yz [1/sqrt(kg m^2)]; 2D: only zz.
void pls_root_inverse_inertia(const pls_world *world, uint32_t row, double out[6]);
static inline pls_vec3 pls_symmetric_multiply(const double a[6], pls_vec3 x)
{
    return pls_vec(a[0] * x.x + a[3] * x.y + a[4] * x.z, a[3] * x.x + a[1] * x.y + a[5] * x.z, a[4] * x.x + a[5] * x.y + a[2] * x.z);
}

/// The moment of inertia that resists least [kg m^2].
double pls_smallest_moment(const pls_body_mass *mass, int dimension);

/// Add the contacts that a body lacks to the assumed coordination, spread evenly over directions.
void pls_add_missing_contacts(const pls_world *world, uint32_t row, int coordination, pls_body_rates *rates);

#endif
