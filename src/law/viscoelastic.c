// viscoelastic.c -- linear springs and dashpots with Coulomb friction (P1 section 3.2, eq. 16-20; normal and tangential parts damped apart).

#include "law/builtin.h"
#include "law/linear.h"

static const pls_parameter parameters[] = {
    {.name = "kn",
     .unit = "N/m",
     .meaning = "normal stiffness",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "ks", .unit = "N/m", .meaning = "shear stiffness", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "cn", .unit = "N s/m", .meaning = "normal damping", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "cs", .unit = "N s/m", .meaning = "shear damping", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "friction", .unit = "", .meaning = "Coulomb friction coefficient", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "limit_damping",
     .unit = "",
     .meaning = "1: the dashpot may not pull separating grains together; 0: it may, as in P1",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = 1.0},
    {.name = NULL},
};

static pls_status prepare(const double *values, const pls_material_values *a, const pls_material_values *b, double *constants)
{
    (void)a, (void)b;
    pls_linear_constants(constants, values[0], values[1], values[2], values[3], values[4], values[5] < 0.5);
    return PLS_OK;
}

const pls_law_ops pls_viscoelastic_law = {
    .api_version = PLS_API_VERSION,
    .name = "viscoelastic",
    .meaning = "linear springs and dashpots with Coulomb friction (P1 eq. 16-20)",
    .parameters = parameters,
    .prepare = prepare,
    .evaluate = pls_linear_evaluate,
    .stiffness = pls_linear_stiffness,
    .energy = pls_linear_energy,
};
