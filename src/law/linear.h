// linear.h -- what the two linear laws share: constants, loop, and the answers to scalar questions.
#ifndef PLS_LAW_LINEAR_H
#define PLS_LAW_LINEAR_H

#include "math/simd.h"

#include <particls/law.h>

enum {
    PLS_LINEAR_KN,     ///< normal stiffness [N/m]
    PLS_LINEAR_KS,     ///< shear stiffness [N/m]
    PLS_LINEAR_CN,     ///< normal damping [N s/m]
    PLS_LINEAR_CS,     ///< shear damping [N s/m]
    PLS_LINEAR_MU,     ///< Coulomb friction
    PLS_LINEAR_INV_KS, ///< 1/ks, 0 when ks is 0
    PLS_LINEAR_FLOOR   ///< smallest normal force [N]: 0 where damping may not pull, else minus infinity
};

PLS_SIMD_DECLARE(void, pls_linear_law, const pls_law_batch *batch);

/// The loop for this machine.
void pls_linear_evaluate(const pls_law_batch *batch);
void pls_linear_constants(double *constants, double kn, double ks, double cn, double cs, double friction, bool may_pull);
void pls_linear_stiffness(const double *constants, const pls_contact_point *contact, pls_contact_stiffness *out);
void pls_linear_energy(const double *constants, const pls_contact_point *contact, double *normal, double *shear);

#endif
