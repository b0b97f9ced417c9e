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
    double kn, ks, cn, cs, mu, inv_ks, twice_inv_ks, floor_force;
    double slide; ///< 2 cs/ks + dt; without a spring 0
} pls_linear_values;

static inline pls_linear_values pls_linear_take(const double *constants, double dt)
{
    const double ks = constants[PLS_LINEAR_KS], cs = constants[PLS_LINEAR_CS], inv_ks = constants[PLS_LINEAR_INV_KS];
    return (pls_linear_values){.kn = constants[PLS_LINEAR_KN],
                               .ks = ks,
                               .cn = constants[PLS_LINEAR_CN],
                               .cs = cs,
                               .mu = constants[PLS_LINEAR_MU],
                               .inv_ks = inv_ks,
                               .twice_inv_ks = 2.0 * inv_ks,
                               .floor_force = constants[PLS_LINEAR_FLOOR],
                               .slide = ks > 0.0 ? 2.0 * cs * inv_ks + dt : 0.0};
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
    out->normal_force = pls_vd_max(pls_vd_fma(pls_vd_set(law->cn), vn, spring_force), pls_vd_set(law->floor_force));
    out->cone = law->mu * out->normal_force;
    for (int a = 0; a < 3; ++a)
    {
        dash[a] = law->cs * v[a];
        out->shear[a] = pls_vd_fma(pls_vd_set(law->ks), s[a], dash[a]);
    }
    out->shear_square = pls_vd_dot(out->shear, out->shear);
    out->damping_power = pls_vd_fma(out->normal_force - spring_force, vn, pls_vd_dot(dash, v));
}

/// What the trial is multiplied by: -1 where nothing slides. The root and the division take long and hardly any units.
static inline __attribute__((always_inline)) pls_vd pls_linear_factor(pls_vd shear_square, pls_vd cone)
{
    const pls_vm slides = pls_vm_less(cone * cone, shear_square);
    return pls_vd_choose(slides, pls_vd_min(cone, -cone) / pls_vd_sqrt(shear_square), pls_vd_set(-1.0));
}

/// Shear force on i from the trial t (with its square), the spring that is left, and the work of sliding [J].
///
/// A share h of the trial is cut off (none, exactly, where nothing slides), and with it h/ks t of the spring. In terms of the trial ks s + cs v the work
/// ks/2 (s_left + s - dt v) . (s - s_left) is h/2 ((2 - h)/ks t . t - (2 cs/ks + dt) v . t).
static inline __attribute__((always_inline)) pls_vd pls_linear_settle(const pls_linear_values *law, pls_vd factor, pls_vd square,
                                                                      const pls_vd v[3], pls_vd shear[3], pls_vd s[3])
{
    const pls_vd cut = 1.0 + factor, shorter = cut * law->inv_ks, vt = law->slide * pls_vd_dot(v, shear);
    const pls_vd work =
        (0.5 * cut) * pls_vd_product_less(square, pls_vd_less_product(cut, pls_vd_set(law->inv_ks), pls_vd_set(law->twice_inv_ks)), vt);
    for (int a = 0; a < 3; ++a)
    {
        s[a] = pls_vd_less_product(shorter, shear[a], s[a]);
        shear[a] = shear[a] * factor;
    }
    return work;
}

#endif
