// linear_simd.c -- the loop of the linear laws (elastic.c, viscoelastic.c); an elastic contact is one without dashpots.
//
//     normal        Fn = kn delta + cn v_n                                   (P1 eq. 16, 19)
//     shear         Fs = -ks s - cs v_t,   s' = v_t                          (P1 eq. 17, 20)
//     Coulomb       Fs <- mu |Fn| Fs/|Fs| where |Fs| > mu |Fn|, and s so that spring and dashpot together sit on the cone  (P1 eq. 18)
//
// Work taken by sliding in the step: mean spring force times the length cut from the spring. The spring force at the end of the step is ks s; at its start it
// was ks (s_trial - dt v_t) up to second order.

#include "law/linear.h"
#include "math/simd.h"

void PLS_SIMD(pls_linear_law)(const pls_law_batch *b)
{
    const double *constants = b->constants;
    const double kn = constants[PLS_LINEAR_KN], ks = constants[PLS_LINEAR_KS], cn = constants[PLS_LINEAR_CN], cs = constants[PLS_LINEAR_CS];
    const double mu = constants[PLS_LINEAR_MU], inv_ks = constants[PLS_LINEAR_INV_KS], floor_force = constants[PLS_LINEAR_FLOOR];
    const pls_vd zero = pls_vd_set(0.0), one = pls_vd_set(1.0);
    for (size_t k = 0; k < b->count; k += PLS_W)
    {
        pls_vd delta = pls_vd_load(b->delta + k), vn = pls_vd_load(b->normal_velocity + k);
        pls_vd vx = pls_vd_load(b->slip_velocity_x + k), vy = pls_vd_load(b->slip_velocity_y + k), vz = pls_vd_load(b->slip_velocity_z + k);
        pls_vd sx = pls_vd_load(b->spring_x + k), sy = pls_vd_load(b->spring_y + k), sz = pls_vd_load(b->spring_z + k);

        pls_vd fn = kn * delta + cn * vn;
        fn = pls_vd_pick((pls_vi)(fn < floor_force), pls_vd_set(floor_force), fn);
        pls_vd fx = -(ks * sx) - cs * vx, fy = -(ks * sy) - cs * vy, fz = -(ks * sz) - cs * vz;

        pls_vd cone = mu * pls_vd_pick((pls_vi)(fn < zero), -fn, fn);
        pls_vd shear = pls_vd_sqrt(fx * fx + fy * fy + fz * fz);
        pls_vi slides = (pls_vi)(shear > cone);
        pls_vd factor = pls_vd_pick(slides, cone / pls_vd_pick(slides, shear, one), one);
        fx = fx * factor, fy = fy * factor, fz = fz * factor;
        pls_vd nx = pls_vd_pick(slides, -(fx + cs * vx) * inv_ks, sx);
        pls_vd ny = pls_vd_pick(slides, -(fy + cs * vy) * inv_ks, sy);
        pls_vd nz = pls_vd_pick(slides, -(fz + cs * vz) * inv_ks, sz);

        pls_vd work = (nx + sx - b->dt * vx) * (sx - nx) + (ny + sy - b->dt * vy) * (sy - ny) + (nz + sz - b->dt * vz) * (sz - nz);
        pls_vd damping = (fn - kn * delta) * vn + cs * (vx * vx + vy * vy + vz * vz);
        pls_vd_store(b->normal_force + k, fn);
        pls_vd_store(b->shear_force_x + k, fx);
        pls_vd_store(b->shear_force_y + k, fy);
        pls_vd_store(b->shear_force_z + k, fz);
        pls_vd_store(b->spring_x + k, nx);
        pls_vd_store(b->spring_y + k, ny);
        pls_vd_store(b->spring_z + k, nz);
        pls_vd_store(b->damping_power + k, damping);
        pls_vd_store(b->slip_work + k, (0.5 * ks) * work);
    }
}
