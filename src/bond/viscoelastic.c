// viscoelastic.c -- the linear peridynamic solid whose shear stiffness relaxes: one Maxwell branch beside a spring (Mitchell 2011b).
//
// Each bond remembers the extension p of the branch's dashpot, which has no dilatation. With the linear solid's a and b and the part l of b that relaxes in the time tau
//
//     E/V = a theta^2 / (2 d) + b / (2 m) sum w beta V_j [(1 - l) e^2 + l (e - p)^2],      p' = (e' - p) / tau,   e' = e - xi (sum g e / sum g xi)
//
// p is advanced exactly for e' that grows evenly during the step.

#include "bond/viscoelastic.h"

#include "bond/builtin.h"

enum { PART, TIME };

static const pls_parameter parameters[] = {
    {.name = "relaxing_part",
     .unit = "",
     .meaning = "of the shear modulus, which is that of the first moment",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = 1.0},
    {.name = "relaxation_time",
     .unit = "s",
     .meaning = "in which stress of that part falls to 1/e",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = NULL},
};

static pls_status linear(const double *values, const pls_bond_setting *setting, pls_bond_coefficients *out)
{
    return pls_linear_solid_bonds.linear(values, setting, out);
}

static pls_status prepare(const double *values, const pls_bond_setting *setting, double constants[PLS_BOND_MAX_CONSTANTS])
{
    pls_bond_coefficients law;
    PLS_TRY(linear(values, setting, &law));
    constants[PLS_VISCOUS_DILATION] = law.dilation;
    constants[PLS_VISCOUS_EXTENSION] = law.extension;
    constants[PLS_VISCOUS_PART] = values[PART];
    constants[PLS_VISCOUS_TIME] = values[TIME];
    return PLS_OK;
}

static void pull(const pls_family_batch *batch) { PLS_SIMD_SELECT(pls_viscous_pull)(batch); }
static void advance(const pls_family_batch *batch) { PLS_SIMD_SELECT(pls_viscous_advance)(batch); }

const pls_bond_ops pls_viscoelastic_bonds = {
    .api_version = PLS_API_VERSION,
    .name = "viscoelastic_solid",
    .meaning = "linear solid part of whose shear stiffness relaxes: one Maxwell branch (state-based; Mitchell 2011b)",
    .parameters = parameters,
    .linear = linear,
    .prepare = prepare,
    .pull = pull,
    .advance = advance,
    .memories = PLS_VISCOUS_MEMORIES,
    .point_memories = 1, // even part of the extensions at the last step
};
