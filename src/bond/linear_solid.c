// linear_solid.c -- the linear peridynamic solid (Silling et al. 2007; P1 eq. 32-35, whose slips THEORY 5 corrects).
//
//     3D  t = (w / m) [(3 K - 5 mu) theta xi + 15 mu e]         2D  t = (w / m) [(2 k2 - 4 mu) theta xi + 8 mu e]

#include "bond/builtin.h"
#include "bond/moduli.h"

static const pls_parameter parameters[] = {{.name = NULL}};

static pls_status linear(const double *values, const pls_bond_setting *setting, pls_bond_coefficients *out)
{
    (void)values;
    pls_moduli m;
    PLS_TRY(pls_moduli_of(setting, "linear_solid", &m));
    if (setting->dimension == 3)
        *out = (pls_bond_coefficients){.dilation = 3.0 * m.bulk - 5.0 * m.shear, .extension = 15.0 * m.shear};
    else
        *out = (pls_bond_coefficients){.dilation = 2.0 * m.plane - 4.0 * m.shear, .extension = 8.0 * m.shear};
    return PLS_OK;
}

const pls_bond_ops pls_linear_solid_bonds = {
    .api_version = PLS_API_VERSION,
    .name = "linear_solid",
    .meaning = "linear peridynamic solid: any Poisson's ratio (state-based; Silling et al. 2007)",
    .parameters = parameters,
    .linear = linear,
};
