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

typedef struct pls_linear_lanes
{
    pls_vd normal_force;   ///< [N]
    pls_vd shear_force[3]; ///< on i [N]
    pls_vd spring[3];      ///< after sliding [m]
    pls_vd damping_power;  ///< [W]
    pls_vd slip_work;      ///< [J]
} pls_linear_lanes;

/// v: slip velocity [m/s]; s: spring had it not slid [m].
static inline __attribute__((always_inline)) void pls_linear_answer(const double *constants, double dt, pls_vd delta, pls_vd vn,
                                                                    const pls_vd v[3], const pls_vd s[3], pls_linear_lanes *out)
{
    const double kn = constants[PLS_LINEAR_KN], ks = constants[PLS_LINEAR_KS], cn = constants[PLS_LINEAR_CN], cs = constants[PLS_LINEAR_CS];
    const double mu = constants[PLS_LINEAR_MU], inv_ks = constants[PLS_LINEAR_INV_KS], floor_force = constants[PLS_LINEAR_FLOOR];
    const pls_vd zero = pls_vd_set(0.0), tiny = pls_vd_set(1e-300);
    pls_vd spring_force = kn * delta, fn = pls_vd_max(spring_force + cn * vn, pls_vd_set(floor_force));
    pls_vd dash[3], f[3];
    for (int a = 0; a < 3; ++a)
    {
        dash[a] = cs * v[a];
        f[a] = -(ks * s[a]) - dash[a];
    }
    pls_vd cone = mu * pls_vd_max(fn, -fn);
    pls_vd shear = pls_vd_sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    pls_vi slides = (pls_vi)(shear > cone);
    pls_vd factor = cone / pls_vd_max(pls_vd_max(shear, cone), tiny); // exactly 1 where nothing slides
    pls_vd work = zero, power = (fn - spring_force) * vn;
    for (int a = 0; a < 3; ++a)
    {
        f[a] = f[a] * factor;
        pls_vd left = pls_vd_pick(slides, -(f[a] + dash[a]) * inv_ks, s[a]);
        work = work + (left + s[a] - dt * v[a]) * (s[a] - left);
        power = power + dash[a] * v[a];
        out->shear_force[a] = f[a];
        out->spring[a] = left;
    }
    out->normal_force = fn;
    out->damping_power = power;
    out->slip_work = (0.5 * ks) * work;
}

#endif
