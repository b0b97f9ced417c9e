// linear_simd.c -- the loop of the linear laws (elastic.c, viscoelastic.c); an elastic contact is one without dashpots.

#include "law/linear_lanes.h"

void PLS_SIMD(pls_linear_law)(const pls_law_batch *b)
{
    const pls_linear_values law = pls_linear_take(b->constants, b->dt);
    for (size_t k = 0; k < b->count; k += PLS_W)
    {
        const pls_vd v[3] = {pls_vd_load(b->slip_velocity_x + k), pls_vd_load(b->slip_velocity_y + k), pls_vd_load(b->slip_velocity_z + k)};
        pls_vd s[3] = {pls_vd_load(b->spring_x + k), pls_vd_load(b->spring_y + k), pls_vd_load(b->spring_z + k)};
        pls_linear_trial t;
        pls_linear_try(&law, pls_vd_load(b->delta + k), pls_vd_load(b->normal_velocity + k), v, s, &t);
        pls_vd_store(b->slip_work + k, pls_linear_settle(&law, pls_linear_factor(t.shear_square, t.cone), v, t.shear, s));
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
