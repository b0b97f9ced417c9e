// linear_simd.c -- the two loops over families, eight bonds at a time (bond_set.h says what they compute).
//
// Extensions are computed in both loops: storing them would cost more than the root. Eight sums run side by side on any width and are added up in one order.

#include "bond/lanes.h"
#include "bond/stretch.h"

#include <float.h>

enum {
    PARTS = PLS_BOND_VECTOR / PLS_W,
    AHEAD = 256 ///< bonds by which streams are fetched ahead: the processor's own fetching stops at each page of four kilobytes
};

/// Streams pass once per loop, from memory, and should not push rows out of the caches. (What is fetched need not be there.)
static inline __attribute__((always_inline)) void fetch_streams(const pls_bond_set *set, size_t slot, int share)
{
    __builtin_prefetch(set->family.length + slot + AHEAD, 0, 0);
    __builtin_prefetch(set->weight + slot + AHEAD, 0, 0);
    if (slot % 16 == 0) __builtin_prefetch(set->family.partner + slot + AHEAD, 0, 0);
    if (share && slot % 16 == 0) __builtin_prefetch(set->share + slot + AHEAD, 0, 0);
}

typedef float floats __attribute__((vector_size(4 * PLS_W), aligned(4)));

/// Conditions of a vector of bonds: means of their two points. Without rows nothing varies.
typedef struct varied
{
    pls_vd strain, stiffness, toughness;
} varied;

static inline __attribute__((always_inline)) varied vary(const pls_bond_set *set, size_t point, size_t slot)
{
    const double(*rows)[PLS_CONDITION_NUMBERS] = (const double(*)[PLS_CONDITION_NUMBERS])set->conditions.row;
    if (!rows) return (varied){pls_vd_set(0.0), pls_vd_set(1.0), pls_vd_set(1.0)};
    pls_v4 row[PLS_W];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane) row[lane] = pls_v4_load(rows[set->family.partner[slot + (size_t)lane]]);
    pls_vd column[4];
    pls_columns4(row, column);
    return (varied){0.5 * (column[PLS_CONDITION_STRAIN] + rows[point][PLS_CONDITION_STRAIN]),
                    0.5 * (column[PLS_CONDITION_STIFFNESS] + rows[point][PLS_CONDITION_STIFFNESS]),
                    0.5 * (column[PLS_CONDITION_TOUGHNESS] + rows[point][PLS_CONDITION_TOUGHNESS])};
}

static inline __attribute__((always_inline)) void dilate(pls_bond_set *set, size_t first, size_t last, bool varies)
{
    const uint32_t *start = set->family.start;
    for (size_t p = first; p < last; ++p)
    {
        pls_vd x[3], sum[PARTS] = {0};
        pls_stretch_point(set, p, x);
        for (size_t slot = (size_t)start[p] * PLS_BOND_VECTOR; slot < (size_t)start[p + 1] * PLS_BOND_VECTOR; slot += PLS_BOND_VECTOR)
        {
            fetch_streams(set, slot, 0);
#pragma GCC unroll 4
            for (size_t k = 0; k < PARTS; ++k)
            {
                const size_t at = slot + k * PLS_W;
                const pls_stretch b = pls_stretch_now(set, at, x);
                pls_vd e = b.length - b.xi;
                if (varies) e = e - b.xi * vary(set, p, at).strain;
                sum[k] = sum[k] + pls_vd_load(set->weight + at) * e;
            }
        }
        const double stiffness = varies && set->conditions.row ? set->conditions.row[p][PLS_CONDITION_STIFFNESS] : 1.0;
        set->spread[p] = stiffness * (set->dilation[p] * pls_lanes_sum(sum)); // rows are being read by other threads
    }
}

void PLS_SIMD(pls_bond_dilate)(pls_bond_set *set, size_t first, size_t last) { dilate(set, first, last, false); }
void PLS_SIMD(pls_bond_dilate_varied)(pls_bond_set *set, size_t first, size_t last) { dilate(set, first, last, true); }

static inline __attribute__((always_inline)) bool act(pls_bond_set *set, size_t first, size_t last, bool varies)
{
    const uint32_t *start = set->family.start;
    const double stretch = set->stretch, twice = set->twice;
    bool any = false;
    for (size_t p = first; p < last; ++p)
    {
        pls_vd x[3], sum[3][PARTS] = {0}, a = pls_vd_set(set->row[p][3]);
        unsigned overlong = 0;
        pls_stretch_point(set, p, x);
        for (size_t slot = (size_t)start[p] * PLS_BOND_VECTOR; slot < (size_t)start[p + 1] * PLS_BOND_VECTOR; slot += PLS_BOND_VECTOR)
        {
            fetch_streams(set, slot, 1);
#pragma GCC unroll 4
            for (size_t k = 0; k < PARTS; ++k)
            {
                const size_t at = slot + k * PLS_W;
                const pls_stretch b = pls_stretch_now(set, at, x);
                pls_vd e = b.length - b.xi, share = __builtin_convertvector(*(const floats *)(set->share + at), pls_vd);
                varied v;
                if (varies) v = vary(set, p, at), e = e - b.xi * v.strain, share = share * v.stiffness;
                const pls_vd pull = (a + b.a) * b.xi + (twice * e) * share;
                // 1/(xi l) as l/(xi l^2), so that the division need not wait for the root; points of a broken bond may coincide.
                const pls_vd factor = pls_vd_load(set->weight + at) * pull * (b.length * (1.0 / (b.xi * b.square + DBL_MIN)));
                if (!varies)
                    overlong |= pls_vd_less(stretch * b.xi, e);
                else if (!set->limit)
                    overlong |= pls_vd_less(stretch * v.toughness * b.xi, e);
                else // where it is stretched
                    overlong |= pls_vd_less(v.toughness * pls_vd_load(set->limit + at), 0.5 * pull * e) & pls_vd_less(pls_vd_set(0.0), e);
                for (int c = 0; c < 3; ++c) sum[c][k] = sum[c][k] + factor * b.d[c];
            }
        }
        for (int c = 0; c < 3; ++c) set->force[p][c] = pls_lanes_sum(sum[c]);
        if (overlong) set->overlong[p] = 1, any = true;
    }
    return any;
}

bool PLS_SIMD(pls_bond_act)(pls_bond_set *set, size_t first, size_t last) { return act(set, first, last, false); }
bool PLS_SIMD(pls_bond_act_varied)(pls_bond_set *set, size_t first, size_t last) { return act(set, first, last, true); }
