// linear.c -- scalar answers of the linear laws, and the choice of their loop.

#include "law/linear.h"

void pls_linear_evaluate(const pls_law_batch *batch) { PLS_SIMD_SELECT(pls_linear_law)(batch); }

void pls_linear_constants(double *constants, double kn, double ks, double cn, double cs, double friction, bool may_pull)
{
    constants[PLS_LINEAR_KN] = kn;
    constants[PLS_LINEAR_KS] = ks;
    constants[PLS_LINEAR_CN] = cn;
    constants[PLS_LINEAR_CS] = cs;
    constants[PLS_LINEAR_MU] = friction;
    constants[PLS_LINEAR_INV_KS] = ks > 0.0 ? 1.0 / ks : 0.0;
    constants[PLS_LINEAR_FLOOR] = may_pull ? -INFINITY : 0.0;
}

void pls_linear_stiffness(const double *constants, const pls_contact_point *contact, pls_contact_stiffness *out)
{
    (void)contact;
    *out = (pls_contact_stiffness){constants[PLS_LINEAR_KN], constants[PLS_LINEAR_KS], constants[PLS_LINEAR_CN], constants[PLS_LINEAR_CS]};
}

void pls_linear_energy(const double *constants, const pls_contact_point *contact, double *normal, double *shear)
{
    *normal = 0.5 * constants[PLS_LINEAR_KN] * contact->delta * contact->delta;
    *shear = 0.5 * constants[PLS_LINEAR_KS] * contact->spring_squared;
}
