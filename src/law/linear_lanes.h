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

typedef struct pls_linear_lanes
{
    pls_vd normal_force;   ///< [N]
    pls_vd shear_force[3]; ///< on i [N]
    pls_vd spring[3];      ///< after sliding [m]
    pls_vd damping_power;  ///< [W]
    pls_vd slip_work;      ///< [J]
} pls_linear_lanes;

/// v: slip velocity [m/s]; s: spring had it not slid [m].
static inline __attribute__((always_inline)) void pls_linear_answer(const pls_linear_values *law, pls_vd delta, pls_vd vn,
                                                                    const pls_vd v[3], const pls_vd s[3], pls_linear_lanes *out)
{
    const pls_vd tiny = pls_vd_set(1e-300);
    pls_vd spring_force = law->kn * delta, fn = pls_vd_max(spring_force + law->cn * vn, pls_vd_set(law->floor_force));
    pls_vd dash[3], trial[3]; // minus the forces
    for (int a = 0; a < 3; ++a)
    {
        dash[a] = law->cs * v[a];
        trial[a] = law->ks * s[a] + dash[a];
    }
    pls_vd cone = law->mu * pls_vd_max(fn, -fn);
    pls_vd shear = pls_vd_sqrt(trial[0] * trial[0] + trial[1] * trial[1] + trial[2] * trial[2]);
    const pls_vm slides = pls_vm_less(cone, shear);
    pls_vd factor = -(cone / pls_vd_max(pls_vd_max(shear, cone), tiny)); // exactly -1 where nothing slides
    pls_vd work = pls_vd_set(0.0), power = (fn - spring_force) * vn;
    for (int a = 0; a < 3; ++a)
    {
        pls_vd f = trial[a] * factor, left = pls_vd_choose(slides, (f + dash[a]) * law->minus_inv_ks, s[a]);
        work = work + (left + s[a] - law->dt * v[a]) * (s[a] - left);
        power = power + dash[a] * v[a];
        out->shear_force[a] = f;
        out->spring[a] = left;
    }
    out->normal_force = fn;
    out->damping_power = power;
    out->slip_work = law->half_ks * work;
}

#endif
