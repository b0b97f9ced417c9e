// linear_simd.c -- the loop of the linear laws (elastic.c, viscoelastic.c); an elastic contact is one without dashpots.

#include "law/linear_lanes.h"

void PLS_SIMD(pls_linear_law)(const pls_law_batch *b)
{
    const pls_linear_values law = pls_linear_take(b->constants, b->dt);
    for (size_t k = 0; k < b->count; k += PLS_W)
    {
        const pls_vd v[3] = {pls_vd_load(b->slip_velocity_x + k), pls_vd_load(b->slip_velocity_y + k), pls_vd_load(b->slip_velocity_z + k)};
        const pls_vd s[3] = {pls_vd_load(b->spring_x + k), pls_vd_load(b->spring_y + k), pls_vd_load(b->spring_z + k)};
        pls_linear_lanes out;
        pls_linear_answer(&law, pls_vd_load(b->delta + k), pls_vd_load(b->normal_velocity + k), v, s, &out);
        pls_vd_store(b->normal_force + k, out.normal_force);
        pls_vd_store(b->shear_force_x + k, out.shear_force[0]);
        pls_vd_store(b->shear_force_y + k, out.shear_force[1]);
        pls_vd_store(b->shear_force_z + k, out.shear_force[2]);
        pls_vd_store(b->spring_x + k, out.spring[0]);
        pls_vd_store(b->spring_y + k, out.spring[1]);
        pls_vd_store(b->spring_z + k, out.spring[2]);
        pls_vd_store(b->damping_power + k, out.damping_power);
        pls_vd_store(b->slip_work + k, out.slip_work);
    }
}
