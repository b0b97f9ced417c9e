// bond_based.c -- bonds as springs that know nothing of each other (prototype microelastic brittle, Silling and Askari 2005).
//
//     3D  t = (w / m) 9 K e,   nu = 1/4            2D  t = (w / m) 4 k2 e,   nu = 1/4 (strain), 1/3 (stress)
//
// with m of the fullest family of the body; in a continuum, where m = pi delta^4 (2 pi h delta^3 / 3), and with w = delta / xi these are f = c e / xi, c = 18 K / (pi delta^4) (12 k2 / (pi h delta^3)).

#include "bond/builtin.h"
#include "bond/moduli.h"

static const double close_to = 1e-3; ///< of Poisson's ratio

static const pls_parameter parameters[] = {{.name = NULL}};

static pls_status linear(const double *values, const pls_bond_setting *setting, pls_bond_coefficients *out)
{
    (void)values;
    pls_moduli m;
    PLS_TRY(pls_moduli_of(setting, "bond_based", &m));
    const bool stress = setting->dimension == 2 && setting->plane == PLS_PLANE_STRESS;
    const double nu = setting->material.poisson_ratio, own = stress ? 1.0 / 3.0 : 0.25;
    if (!(fabs(nu - own) <= close_to))
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "bond law 'bond_based' has Poisson's ratio %s%s; the material has %g. Take that, or law linear_solid",
                        stress ? "1/3" : "1/4",
                        setting->dimension == 3 ? ""
                        : stress                ? " in plane stress"
                                                : " in plane strain",
                        nu);
    *out = (pls_bond_coefficients){.dilation = 0.0, .extension = setting->dimension == 3 ? 9.0 * m.bulk : 4.0 * m.plane};
    return PLS_OK;
}

const pls_bond_ops pls_bond_based_bonds = {
    .api_version = PLS_API_VERSION,
    .name = "bond_based",
    .meaning = "independent springs: Poisson's ratio 1/4 (1/3 in plane stress) (PMB; Silling and Askari 2005)",
    .parameters = parameters,
    .pairwise = true,
    .linear = linear,
};
