// beam.c -- the cohesive Euler-Bernoulli beam between two bodies (P1 section 5.5; Andre et al. 2012), for rotations of any size.
//
// Either body has a unit vector n that pointed to the other when the bond was made, and one, m, across the bond; e points from i to j, and k = n x m on either side (turned over at j).
//
//     U = EA/(2a) (l - a)^2 + b2/2 (n_j - n_i) . e + b3 n_i . n_j - b4/4 (m_i . m_j + k_i . k_j) + const,      b2 = 12 EI/a,  b3 = -(2 EI + GJ/2)/a,  b4 = 2 GJ/a
//
// (Kuzkin and Asonov 2012). For small turns that is the energy of the beam, whose end forces are those of THEORY 6; for large ones it stays an energy, the same whatever end is called i,
// and forces and torques are its derivatives:
//
//     F_j = -EA/a (l - a) e - b2/(2l) [d - (d . e) e],  d = n_j - n_i;    T_i = -n_i x (b3 n_j - b2/2 e) + b4/4 (m_i x m_j + k_i x k_j)
//
// so that momenta are kept to round-off.

#include "bond/beam.h"
#include "bond/builtin.h"
#include "bond/moduli.h"

static const double pi = 3.14159265358979323846;

enum { RADIUS, TENSILE, SHEAR };

static const pls_parameter parameters[] = {
    {.name = "radius",
     .unit = "m",
     .meaning = "radius of the round section",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "tensile_strength",
     .unit = "Pa",
     .meaning = "breaks where the largest tension, of stretching and bending, reaches it; 0: it never does",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = "shear_strength",
     .unit = "Pa",
     .meaning = "breaks where the largest shear stress, of shear and torsion, reaches it; 0: it never does",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = NULL},
};

static pls_status prepare(const double *values, const pls_bond_setting *setting, double constants[PLS_BOND_MAX_CONSTANTS])
{
    pls_moduli m;
    PLS_TRY(pls_moduli_of(setting, "beam", &m));
    const double r = values[RADIUS], A = pi * r * r, I = 0.25 * A * r * r, J = 2.0 * I;
    constants[PLS_BEAM_EA] = setting->material.young_modulus * A;
    constants[PLS_BEAM_EI] = setting->material.young_modulus * I;
    constants[PLS_BEAM_GJ] = m.shear * J;
    constants[PLS_BEAM_TENSILE] = values[TENSILE] > 0.0 ? 1.0 / (A * values[TENSILE]) : 0.0;
    constants[PLS_BEAM_BEND] = values[TENSILE] > 0.0 ? r / (I * values[TENSILE]) : 0.0;
    constants[PLS_BEAM_SHEAR] = values[SHEAR] > 0.0 ? 1.0 / (A * values[SHEAR]) : 0.0;
    constants[PLS_BEAM_TWIST] = values[SHEAR] > 0.0 ? r / (J * values[SHEAR]) : 0.0;
    return PLS_OK;
}

static void pair(const pls_pair_batch *batch) { PLS_SIMD_SELECT(pls_beam_pair)(batch); }

static void stiffness(const double *constants, double length, pls_pair_stiffness *out)
{
    *out = (pls_pair_stiffness){
        .axial = constants[PLS_BEAM_EA] / length, .bending = constants[PLS_BEAM_EI] / length, .torsion = constants[PLS_BEAM_GJ] / length};
}

const pls_bond_ops pls_beam_bonds = {
    .api_version = PLS_API_VERSION,
    .name = "beam",
    .meaning = "cohesive Euler-Bernoulli beams, which stretch, bend and twist (P1 section 5.5; Andre et al. 2012)",
    .parameters = parameters,
    .prepare = prepare,
    .pair = pair,
    .stiffness = stiffness,
};
