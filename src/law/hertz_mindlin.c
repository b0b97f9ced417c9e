// hertz_mindlin.c -- Hertz's normal force, Mindlin's no-slip shear stiffness, damping of a given restitution.
//
//     Fn = 4/3 E* sqrt(R) delta^(3/2) + 2 sqrt(5/6) beta sqrt(Sn m) v_n,   Sn = 2 E* sqrt(R delta)          (Hertz 1882; Tsuji et al. 1992)
//     Fs = -kt s - 2 sqrt(5/6) beta sqrt(kt m) v_t,                        kt = 8 G* sqrt(R delta)          (Mindlin 1949)
//     beta = -ln e / sqrt(ln^2 e + pi^2): restitution e exactly, at any speed                               (Antypov & Elliott 2011)
//     1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b,   1/G* = 2(2 - nu_a)(1 + nu_a)/E_a + the same of b
//
// kt changes with delta. To create no energy the shear force is kept while the contact grows and the spring while it shrinks (Thornton et al. 2013); what
// this takes away is booked with the work of sliding.

#include "law/hertz_mindlin.h"

#include "law/builtin.h"

static const pls_parameter parameters[] = {
    {.name = "restitution",
     .unit = "",
     .meaning = "coefficient of normal restitution e",
     .initial = 1.0,
     .minimum = 0.0,
     .maximum = 1.0,
     .open_minimum = true},
    {.name = "friction", .unit = "", .meaning = "Coulomb friction coefficient", .initial = 0.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = "limit_damping",
     .unit = "",
     .meaning = "1: the dashpot may not pull separating grains together; 0: it may",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = 1.0},
    {.name = NULL},
};

static pls_status check_material(const pls_material_values *m)
{
    if (!(m->young_modulus > 0.0)) return pls_fail(PLS_INVALID_ARGUMENT, "a material has no young_modulus > 0 [Pa]; this law needs it");
    if (!(m->poisson_ratio > -1.0 && m->poisson_ratio <= 0.5))
        return pls_fail(PLS_INVALID_ARGUMENT, "a material has no poisson_ratio in (-1, 0.5]; this law needs it");
    return PLS_OK;
}

static pls_status prepare(const double *values, const pls_material_values *a, const pls_material_values *b, double *constants)
{
    PLS_TRY(check_material(a));
    PLS_TRY(check_material(b));
    double log_e = log(values[0]), beta = -log_e / sqrt(log_e * log_e + M_PI * M_PI);
    constants[PLS_HERTZ_E] = 1.0 / ((1.0 - a->poisson_ratio * a->poisson_ratio) / a->young_modulus +
                                    (1.0 - b->poisson_ratio * b->poisson_ratio) / b->young_modulus);
    constants[PLS_HERTZ_G] = 1.0 / (2.0 * (2.0 - a->poisson_ratio) * (1.0 + a->poisson_ratio) / a->young_modulus +
                                    2.0 * (2.0 - b->poisson_ratio) * (1.0 + b->poisson_ratio) / b->young_modulus);
    constants[PLS_HERTZ_DAMPING] = 2.0 * sqrt(5.0 / 6.0) * beta;
    constants[PLS_HERTZ_MU] = values[1];
    constants[PLS_HERTZ_FLOOR] = values[2] < 0.5 ? -INFINITY : 0.0;
    return PLS_OK;
}

static void evaluate(const pls_law_batch *batch) { PLS_SIMD_SELECT(pls_hertz_law)(batch); }

static void stiffness(const double *constants, const pls_contact_point *c, pls_contact_stiffness *out)
{
    double circle = sqrt(c->effective_radius * c->delta);
    out->kn = 2.0 * constants[PLS_HERTZ_E] * circle;
    out->kt = constants[PLS_HERTZ_MU] > 0.0 ? 8.0 * constants[PLS_HERTZ_G] * circle : 0.0;
    out->cn = constants[PLS_HERTZ_DAMPING] * sqrt(out->kn * c->effective_mass);
    out->ct = constants[PLS_HERTZ_DAMPING] * sqrt(out->kt * c->effective_mass);
}

static void energy(const double *constants, const pls_contact_point *c, double *normal, double *shear)
{
    double circle = sqrt(c->effective_radius * c->delta);
    *normal = 8.0 / 15.0 * constants[PLS_HERTZ_E] * circle * c->delta * c->delta;
    *shear = 4.0 * constants[PLS_HERTZ_G] * circle * c->spring_squared;
}

const pls_law_ops pls_hertz_mindlin_law = {
    .api_version = PLS_API_VERSION,
    .name = "hertz_mindlin",
    .meaning = "Hertz normal force, Mindlin shear stiffness, damping by restitution; E and nu from the materials",
    .parameters = parameters,
    .history = 1,
    .needs_effective = true,
    .prepare = prepare,
    .evaluate = evaluate,
    .stiffness = stiffness,
    .energy = energy,
};
