// moduli.c -- isotropic elastic moduli.

#include "bond/moduli.h"

pls_status pls_moduli_of(const pls_bond_setting *setting, const char *law, pls_moduli *out)
{
    const double E = setting->material.young_modulus, nu = setting->material.poisson_ratio;
    if (isnan(E) || isnan(nu))
        return pls_fail(PLS_INVALID_ARGUMENT, "bond law '%s' needs young_modulus [Pa] and poisson_ratio of the material", law);
    if (!(E > 0.0) || !isfinite(E))
        return pls_fail(PLS_INVALID_ARGUMENT, "bond law '%s': young_modulus is %g Pa; it must be positive", law, E);
    if (!(nu > -1.0 && nu < 0.5))
        return pls_fail(PLS_INVALID_ARGUMENT, "bond law '%s': poisson_ratio is %g; it must lie between -1 and 0.5", law, nu);
    const double K = E / (3.0 * (1.0 - 2.0 * nu)), mu = E / (2.0 * (1.0 + nu));
    *out = (pls_moduli){
        .bulk = K, .shear = mu, .plane = setting->plane == PLS_PLANE_STRESS ? 9.0 * K * mu / (3.0 * K + 4.0 * mu) : K + mu / 3.0};
    return PLS_OK;
}
