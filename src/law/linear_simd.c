// linear_simd.c -- the loop of the linear laws (elastic.c, viscoelastic.c); an elastic contact is one without dashpots.

#include "law/linear_lanes.h"

/// Where there is no spring the cone cuts the dashpot: what that adds to its power [W].
static pls_vd cut_of_dashpot(const pls_linear_values *law, pls_vd factor, const pls_vd v[3], const pls_vd shear[3])
{
    const pls_vd taken = shear[0] * v[0] + shear[1] * v[1] + shear[2] * v[2], whole = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    return pls_vd_choose(pls_vm_less(pls_vd_set(-1.0), factor), -taken - law->cs * whole, pls_vd_set(0.0));
}

void PLS_SIMD(pls_linear_law)(const pls_law_batch *b)
{
    const pls_linear_values law = pls_linear_take(b->constants, b->dt);
    for (size_t k = 0; k < b->count; k += PLS_W)
    {
        const pls_vd v[3] = {pls_vd_load(b->slip_velocity_x + k), pls_vd_load(b->slip_velocity_y + k), pls_vd_load(b->slip_velocity_z + k)};
        pls_vd s[3] = {pls_vd_load(b->spring_x + k), pls_vd_load(b->spring_y + k), pls_vd_load(b->spring_z + k)};
        pls_linear_trial t;
        pls_linear_try(&law, pls_vd_load(b->delta + k), pls_vd_load(b->normal_velocity + k), v, s, &t);
        const pls_vd factor = pls_linear_factor(t.shear_square, t.cone),
                     work = pls_linear_settle(&law, factor, t.shear_square, v, t.shear, s);
        if (law.ks == 0.0) t.damping_power = t.damping_power + cut_of_dashpot(&law, factor, v, t.shear);
        pls_vd_store(b->slip_work + k, work);
        pls_vd_store(b->normal_force + k, t.normal_force);
        pls_vd_store(b->shear_force_x + k, t.shear[0]);
        pls_vd_store(b->shear_force_y + k, t.shear[1]);
        pls_vd_store(b->shear_force_z + k, t.shear[2]);
        pls_vd_store(b->spring_x + k, s[0]);
        pls_vd_store(b->spring_y + k, s[1]);
        pls_vd_store(b->spring_z + k, s[2]);
        pls_vd_store(b->damping_power + k, t.damping_power);
    }
}
