// force_states_simd.c -- extensions of a family before its law is asked, and forces once all tensions are known.

#include "bond/lanes.h"
#include "bond/stretch.h"

#include <float.h>

enum { PARTS = PLS_BOND_VECTOR / PLS_W };

void PLS_SIMD(pls_states_stretch)(const pls_bond_set *set, size_t point)
{
    const uint32_t *start = set->family.start;
    const pls_vd most = pls_vd_set(0.5 * PLS_NO_LENGTH), none = pls_vd_set(0.0);
    const double(*rows)[PLS_CONDITION_NUMBERS] = (const double(*)[PLS_CONDITION_NUMBERS])set->conditions.row;
    pls_vd x[3];
    pls_stretch_point(set, point, x);
    for (size_t at = (size_t)start[point] * PLS_BOND_VECTOR; at < (size_t)start[point + 1] * PLS_BOND_VECTOR; at += PLS_W)
    {
        const pls_stretch b = pls_stretch_now(set, at, x);
        const pls_vd xi = pls_vd_load(set->states.reference + at);
        pls_vd e = b.length - xi;
        if (rows)
        {
            pls_vd strain;
            for (int lane = 0; lane < PLS_W; ++lane) strain[lane] = rows[set->family.partner[at + (size_t)lane]][PLS_CONDITION_STRAIN];
            e = e - xi * (0.5 * (strain + rows[point][PLS_CONDITION_STRAIN]));
        }
        pls_vd_store(set->states.extension + at, pls_vd_choose(pls_vm_less(b.xi, most), e, none));
    }
}

/// Mean of the points of PLS_W bonds.
static inline __attribute__((always_inline)) pls_vd toughness_of(const pls_bond_set *set, size_t point, size_t slot)
{
    const double(*rows)[PLS_CONDITION_NUMBERS] = (const double(*)[PLS_CONDITION_NUMBERS])set->conditions.row;
    if (!rows) return pls_vd_set(1.0);
    pls_vd other;
    for (int lane = 0; lane < PLS_W; ++lane) other[lane] = rows[set->family.partner[slot + (size_t)lane]][PLS_CONDITION_TOUGHNESS];
    return 0.5 * (other + rows[point][PLS_CONDITION_TOUGHNESS]);
}

bool PLS_SIMD(pls_states_act)(pls_bond_set *set, size_t first, size_t last)
{
    const pls_families *f = &set->family;
    const pls_force_states *states = &set->states;
    const pls_vd most = pls_vd_set(0.5 * PLS_NO_LENGTH), none = pls_vd_set(0.0);
    bool any = false;
    for (size_t p = first; p < last; ++p)
    {
        pls_vd x[3], sum[3][PARTS] = {0};
        unsigned overlong = 0;
        pls_stretch_point(set, p, x);
        for (size_t slot = (size_t)f->start[p] * PLS_BOND_VECTOR; slot < (size_t)f->start[p + 1] * PLS_BOND_VECTOR; slot += PLS_BOND_VECTOR)
        {
            double other[PLS_BOND_VECTOR] __attribute__((aligned(64)));
            for (size_t k = 0; k < PLS_BOND_VECTOR; ++k)
                other[k] =
                    states->tension[(size_t)f->start[pls_point_behind(f, f->partner[slot + k])] * PLS_BOND_VECTOR + states->back[slot + k]];
#pragma GCC unroll 4
            for (size_t k = 0; k < PARTS; ++k)
            {
                const size_t at = slot + k * PLS_W;
                const pls_stretch b = pls_stretch_now(set, at, x);
                const pls_vm held = pls_vm_less(b.xi, most);
                const pls_vd pull = pls_vd_load(states->tension + at) + pls_vd_load(other + k * PLS_W);
                const pls_vd factor = pls_vd_choose(held, pull * (b.length * (1.0 / (b.square + DBL_MIN))), none);
                overlong |= pls_vd_less(set->stretch * toughness_of(set, p, at) * b.xi, pls_vd_load(states->extension + at));
                for (int c = 0; c < 3; ++c) sum[c][k] = sum[c][k] + factor * b.d[c];
            }
        }
        for (int c = 0; c < 3; ++c) set->force[p][c] = pls_lanes_sum(sum[c]);
        if (overlong) set->overlong[p] = 1, any = true;
    }
    return any;
}
