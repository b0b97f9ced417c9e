// beam_simd.c -- the loop of the beam (beam.c has the formulas). The own body is i.

#include "bond/beam.h"

static inline __attribute__((always_inline)) void load(const double *const column[3], size_t k, pls_vd out[3])
{
    for (int c = 0; c < 3; ++c) out[c] = pls_vd_load(column[c] + k);
}

static inline __attribute__((always_inline)) pls_vd dot(const pls_vd a[3], const pls_vd b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline __attribute__((always_inline)) void cross(const pls_vd a[3], const pls_vd b[3], pls_vd out[3])
{
    for (int c = 0; c < 3; ++c)
    {
        const int u = (c + 1) % 3, v = (c + 2) % 3;
        out[c] = a[u] * b[v] - a[v] * b[u];
    }
}

/// The part of a along the unit vector e, and the length of the rest.
static inline __attribute__((always_inline)) pls_vd split(const pls_vd a[3], const pls_vd e[3], pls_vd *rest)
{
    const pls_vd along = dot(a, e);
    pls_vd across[3];
    for (int c = 0; c < 3; ++c) across[c] = a[c] - along * e[c];
    *rest = pls_vd_sqrt(dot(across, across));
    return along;
}

static inline __attribute__((always_inline)) pls_vd absolute(pls_vd a) { return pls_vd_max(a, -a); }

void PLS_SIMD(pls_beam_pair)(const pls_pair_batch *batch)
{
    const double *constants = batch->constants, EA = constants[PLS_BEAM_EA], EI = constants[PLS_BEAM_EI], GJ = constants[PLS_BEAM_GJ];
    for (size_t k = 0; k < batch->count; k += PLS_W)
    {
        const pls_vd a = pls_vd_load(batch->reference + k), l = pls_vd_load(batch->length + k), per = 1.0 / a, one = pls_vd_set(1.0);
        const pls_vd b2 = 12.0 * EI * per, b3 = -(2.0 * EI + 0.5 * GJ) * per, b4 = 2.0 * GJ * per, stretch = l - a;
        pls_vd e[3], ni[3], nj[3], mi[3], mj[3], ki[3], kj[3], d[3], nn[3], ne[3], je[3], mm[3], kk[3], force[3], torque[3], other[3];
        load(batch->unit, k, e);
        load(batch->along[0], k, ni), load(batch->along[1], k, nj);
        load(batch->across[0], k, mi), load(batch->across[1], k, mj);
        cross(ni, mi, ki);
        cross(mj, nj, kj); // -(nj x mj): as k_i when the bond was made
        for (int c = 0; c < 3; ++c) d[c] = nj[c] - ni[c];
        const pls_vd along = dot(d, e), axial = EA * per * stretch, across = 0.5 * b2 / l;
        for (int c = 0; c < 3; ++c) force[c] = axial * e[c] + across * (d[c] - along * e[c]); // -F_j
        cross(ni, nj, nn);
        cross(ni, e, ne), cross(nj, e, je);
        cross(mi, mj, mm), cross(ki, kj, kk);
        for (int c = 0; c < 3; ++c)
        {
            const pls_vd twist = 0.25 * b4 * (mm[c] + kk[c]) - b3 * nn[c];
            torque[c] = twist + 0.5 * b2 * ne[c];
            other[c] = -twist - 0.5 * b2 * je[c]; // T_j
            pls_vd_store(batch->force[c] + k, force[c]);
            pls_vd_store(batch->torque[c] + k, torque[c]);
        }
        // Zero when it is straight: b2/2 (d.e + 2) + b3 (n.n + 1) - b4/4 (m.m + k.k - 2)
        pls_vd energy = 0.5 * axial * stretch + 0.5 * b2 * (along + 2.0) + b3 * (dot(ni, nj) + one);
        energy = energy - 0.25 * b4 * (dot(mi, mj) + dot(ki, kj) - 2.0);
        pls_vd_store(batch->energy + k, energy);
        pls_vd bend_i, bend_j, shear;
        const pls_vd twist_i = split(torque, e, &bend_i), twist_j = split(other, e, &bend_j);
        split(force, e, &shear);
        const pls_vd tension = constants[PLS_BEAM_TENSILE] * axial + constants[PLS_BEAM_BEND] * pls_vd_max(bend_i, bend_j);
        const pls_vd sheared =
            constants[PLS_BEAM_SHEAR] * shear + constants[PLS_BEAM_TWIST] * pls_vd_max(absolute(twist_i), absolute(twist_j));
        pls_vd_store(batch->load + k, pls_vd_max(tension, sheared));
    }
}
