// hertz_mindlin_simd.c -- the loop of hertz_mindlin.c.

#include "law/hertz_mindlin.h"

void PLS_SIMD(pls_hertz_law)(const pls_law_batch *b)
{
    const double *constants = b->constants;
    const double e_star = constants[PLS_HERTZ_E], g_star = constants[PLS_HERTZ_G], damping = constants[PLS_HERTZ_DAMPING];
    const double mu = constants[PLS_HERTZ_MU], floor_force = constants[PLS_HERTZ_FLOOR];
    const pls_vd zero = pls_vd_set(0.0), one = pls_vd_set(1.0);
    double *before = b->history[0]; // overlap one step ago
    for (size_t k = 0; k < b->count; k += PLS_W)
    {
        pls_vd delta = pls_vd_load(b->delta + k), vn = pls_vd_load(b->normal_velocity + k);
        pls_vd vx = pls_vd_load(b->slip_velocity_x + k), vy = pls_vd_load(b->slip_velocity_y + k), vz = pls_vd_load(b->slip_velocity_z + k);
        pls_vd sx = pls_vd_load(b->spring_x + k), sy = pls_vd_load(b->spring_y + k), sz = pls_vd_load(b->spring_z + k);
        pls_vd radius = pls_vd_load(b->effective_radius + k), mass = pls_vd_load(b->effective_mass + k);
        pls_vd old = pls_vd_load(before + k);
        delta = pls_vd_pick((pls_vi)(delta < zero), zero, delta);

        pls_vd contact = pls_vd_sqrt(radius * delta), contact_old = pls_vd_sqrt(radius * old); // radius of the contact circle
        pls_vd stiffness = 2.0 * e_star * contact;                                             // dFn/d(delta)
        pls_vd spring_force = (2.0 / 3.0) * stiffness * delta;                                 // 4/3 E* sqrt(R) delta^1.5
        pls_vd fn = spring_force + damping * pls_vd_sqrt(stiffness * mass) * vn;
        fn = pls_vd_pick((pls_vi)(fn < floor_force), pls_vd_set(floor_force), fn);

        // Growing contact: the shear force stays, so the spring shrinks; shrinking contact: the spring stays, so the force falls. Neither creates energy.
        pls_vd kt = 8.0 * g_star * contact, kt_old = 8.0 * g_star * contact_old;
        pls_vi grows = (pls_vi)(kt > kt_old);
        pls_vd keep = pls_vd_pick(grows, kt_old / pls_vd_pick(grows, kt, one), one);
        pls_vd half = pls_vd_set(0.5 * b->dt);
        pls_vd mx = sx - half * vx, my = sy - half * vy, mz = sz - half * vz;
        pls_vd change = pls_vd_pick(grows, kt_old * (one - keep), kt_old - kt);
        pls_vd work = 0.5 * change * (mx * mx + my * my + mz * mz);
        sx = sx * keep, sy = sy * keep, sz = sz * keep;

        pls_vd ct = damping * pls_vd_sqrt(kt * mass);
        pls_vd fx = -(kt * sx) - ct * vx, fy = -(kt * sy) - ct * vy, fz = -(kt * sz) - ct * vz;
        pls_vd cone = mu * pls_vd_pick((pls_vi)(fn < zero), -fn, fn);
        pls_vd shear = pls_vd_sqrt(fx * fx + fy * fy + fz * fz);
        pls_vi slides = (pls_vi)(shear > cone);
        pls_vd factor = pls_vd_pick(slides, cone / pls_vd_pick(slides, shear, one), one);
        fx = fx * factor, fy = fy * factor, fz = fz * factor;
        pls_vi stiff = (pls_vi)(kt > zero);
        pls_vd inv_kt = pls_vd_pick(stiff, one / pls_vd_pick(stiff, kt, one), zero);
        pls_vd nx = pls_vd_pick(slides, -(fx + ct * vx) * inv_kt, sx);
        pls_vd ny = pls_vd_pick(slides, -(fy + ct * vy) * inv_kt, sy);
        pls_vd nz = pls_vd_pick(slides, -(fz + ct * vz) * inv_kt, sz);
        work = work +
               0.5 * kt * ((nx + sx - b->dt * vx) * (sx - nx) + (ny + sy - b->dt * vy) * (sy - ny) + (nz + sz - b->dt * vz) * (sz - nz));

        pls_vd_store(b->normal_force + k, fn);
        pls_vd_store(b->shear_force_x + k, fx);
        pls_vd_store(b->shear_force_y + k, fy);
        pls_vd_store(b->shear_force_z + k, fz);
        pls_vd_store(b->spring_x + k, nx);
        pls_vd_store(b->spring_y + k, ny);
        pls_vd_store(b->spring_z + k, nz);
        pls_vd_store(before + k, delta);
        pls_vd_store(b->damping_power + k, (fn - spring_force) * vn + ct * (vx * vx + vy * vy + vz * vz));
        pls_vd_store(b->slip_work + k, work);
    }
}
