// elastic.c -- linear springs with Coulomb friction (P1 section 3.1, eq. 16-18).

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
    {.name = "friction", .unit = "", .meaning = "Coulomb friction coefficient", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = NULL},
};

static pls_status prepare(const double *values, const pls_material_values *a, const pls_material_values *b, double *constants)
{
    (void)a, (void)b;
    pls_linear_constants(constants, values[0], values[1], 0.0, 0.0, values[2], true);
    return PLS_OK;
}

const pls_law_ops pls_elastic_law = {
    .api_version = PLS_API_VERSION,
    .name = "elastic",
    .meaning = "linear normal and shear springs with Coulomb friction (P1 eq. 16-18)",
    .parameters = parameters,
    .prepare = prepare,
    .evaluate = pls_linear_evaluate,
    .stiffness = pls_linear_stiffness,
    .energy = pls_linear_energy,
};
