// elastic_plastic.c -- the linear peridynamic solid with von Mises yield and linear isotropic hardening (Silling et al. 2007, section 14; Mitchell 2011).
//
// Each bond remembers its plastic extension p, which has no dilatation, each point its equivalent plastic strain. With the linear solid's a and b
//
//     E/V = a theta^2 / (2 d) + b / (2 m) sum w beta V_j (e - p)^2
//
// The deviator e' = e - xi (sum g e / sum g xi), in a whole family e - theta xi / d, stores W = b / (2 m) sum w beta V_j (e' - p)^2, in a uniform deformation q^2 / (6 mu) with the equivalent stress q. Where q of the trial exceeds the yield
// stress Y it comes back radially: the strain grows by D = (q - Y) / (3 mu + H), p by the part 3 mu D / q of e' - p, and the step takes the mean tension times that, in a whole family V (Y + H D / 2) D.
//
// In the plane (strain) e' is the deviator of the plane: flow begins, and goes on, at a shear stress of Y / sqrt 3, von Mises' once the flow out of the plane has ceased.

#include "bond/elastic_plastic.h"

#include "bond/builtin.h"
#include "bond/moduli.h"

enum { YIELD, HARDENING };

static const pls_parameter parameters[] = {
    {.name = "yield_stress",
     .unit = "Pa",
     .meaning = "in tension",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "hardening",
     .unit = "Pa",
     .meaning = "by which the yield stress grows per equivalent plastic strain",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = NULL},
};

static pls_status linear(const double *values, const pls_bond_setting *setting, pls_bond_coefficients *out)
{
    if (setting->dimension == 2 && setting->plane == PLS_PLANE_STRESS)
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "bond law 'elastic_plastic' knows the plane strain only; take plane: strain, or three dimensions");
    return pls_linear_solid_bonds.linear(values, setting, out);
}

static pls_status prepare(const double *values, const pls_bond_setting *setting, double constants[PLS_BOND_MAX_CONSTANTS])
{
    pls_moduli m;
    pls_bond_coefficients law;
    PLS_TRY(pls_moduli_of(setting, "elastic_plastic", &m));
    PLS_TRY(linear(values, setting, &law));
    constants[PLS_PLASTIC_DILATION] = law.dilation;
    constants[PLS_PLASTIC_EXTENSION] = law.extension;
    constants[PLS_PLASTIC_SHEAR] = m.shear;
    constants[PLS_PLASTIC_YIELD] = values[YIELD];
    constants[PLS_PLASTIC_HARDENING] = values[HARDENING];
    return isfinite(values[YIELD] + values[HARDENING])
               ? PLS_OK
               : pls_fail(PLS_INVALID_ARGUMENT, "elastic_plastic: yield_stress and hardening must be finite");
}

static void pull(const pls_family_batch *batch) { PLS_SIMD_SELECT(pls_plastic_pull)(batch); }
static void advance(const pls_family_batch *batch) { PLS_SIMD_SELECT(pls_plastic_advance)(batch); }

const pls_bond_ops pls_elastic_plastic_bonds = {
    .api_version = PLS_API_VERSION,
    .name = "elastic_plastic",
    .meaning = "linear solid that flows at von Mises' yield stress, with linear hardening (state-based; Mitchell 2011)",
    .parameters = parameters,
    .linear = linear,
    .prepare = prepare,
    .pull = pull,
    .advance = advance,
    .memories = 1,
    .point_memories = PLS_PLASTIC_POINT_MEMORIES,
};
