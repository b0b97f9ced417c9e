// linear_lanes.h -- the linear laws on one vector of contacts: for their own loop and for the contact loop, which takes them in passing.
//
//     normal        Fn = kn delta + cn v_n                                   (P1 eq. 16, 19)
//     shear         Fs = -ks s - cs v_t,   s' = v_t                          (P1 eq. 17, 20)
//     Coulomb       Fs <- mu |Fn| Fs/|Fs| where |Fs| > mu |Fn|, and s so that spring and dashpot together sit on the cone  (P1 eq. 18)
//
// Work taken by sliding in the step: mean spring force times the length cut from the spring. The spring force at the end of the step is ks s; at its start it
// was ks (s_trial - dt v_t) up to second order.
#ifndef PLS_LAW_LINEAR_LANES_H
#define PLS_LAW_LINEAR_LANES_H

#include "law/linear.h"
#include "math/simd.h"

/// The constants by value, so that compilers keep them in registers.
typedef struct pls_linear_values
{
    double kn, ks, cn, cs, mu, minus_inv_ks, floor_force, half_ks, dt;
} pls_linear_values;

static inline pls_linear_values pls_linear_take(const double *constants, double dt)
{
    return (pls_linear_values){constants[PLS_LINEAR_KN],    constants[PLS_LINEAR_KS],       constants[PLS_LINEAR_CN],
                               constants[PLS_LINEAR_CS],    constants[PLS_LINEAR_MU],       -constants[PLS_LINEAR_INV_KS],
                               constants[PLS_LINEAR_FLOOR], 0.5 * constants[PLS_LINEAR_KS], dt};
}

/// The contacts had they not slid.
typedef struct pls_linear_trial
{
    pls_vd shear[3];      ///< minus the force on i [N]
    pls_vd shear_square;  ///< [N^2]
    pls_vd cone;          ///< largest shear force, or minus it [N]
    pls_vd normal_force;  ///< [N]
    pls_vd damping_power; ///< [W]
} pls_linear_trial;

/// v: slip velocity [m/s]; s: spring [m].
static inline __attribute__((always_inline)) void pls_linear_try(const pls_linear_values *law, pls_vd delta, pls_vd vn, const pls_vd v[3],
                                                                 const pls_vd s[3], pls_linear_trial *out)
{
    pls_vd spring_force = law->kn * delta, dash[3];
    out->normal_force = pls_vd_max(spring_force + law->cn * vn, pls_vd_set(law->floor_force));
    out->cone = law->mu * out->normal_force;
    for (int a = 0; a < 3; ++a)
    {
        dash[a] = law->cs * v[a];
        out->shear[a] = law->ks * s[a] + dash[a];
    }
    out->shear_square = out->shear[0] * out->shear[0] + out->shear[1] * out->shear[1] + out->shear[2] * out->shear[2];
    out->damping_power = (out->normal_force - spring_force) * vn + (dash[0] * v[0] + dash[1] * v[1] + dash[2] * v[2]);
}

/// What the trial is multiplied by: -1 where nothing slides. The root and the division take long and hardly any units.
static inline __attribute__((always_inline)) pls_vd pls_linear_factor(pls_vd shear_square, pls_vd cone)
{
    const pls_vm slides = pls_vm_less(cone * cone, shear_square);
    return pls_vd_choose(slides, pls_vd_min(cone, -cone) / pls_vd_sqrt(shear_square), pls_vd_set(-1.0));
}

/// Shear force on i from the trial, the spring that is left, and the work of sliding [J].
static inline __attribute__((always_inline)) pls_vd pls_linear_settle(const pls_linear_values *law, pls_vd factor, const pls_vd v[3],
                                                                      pls_vd shear[3], pls_vd s[3])
{
    const pls_vm slides = pls_vm_less(pls_vd_set(-1.0), factor);
    pls_vd work[3];
    for (int a = 0; a < 3; ++a)
    {
        shear[a] = shear[a] * factor;
        pls_vd left = pls_vd_choose(slides, (shear[a] + law->cs * v[a]) * law->minus_inv_ks, s[a]);
        work[a] = (left + s[a] - law->dt * v[a]) * (s[a] - left);
        s[a] = left;
    }
    return law->half_ks * (work[0] + work[1] + work[2]);
}

#endif
