// links_simd.c -- how links look now, a batch at a time: positions and orientations of partners by rows, what is fixed in the bodies turned into the world; then the law, then sums.

#include "bond/bond_set.h"
#include "bond/lanes.h"

enum {
    PARTS = PLS_BOND_VECTOR / PLS_W,
    VECTORS = PLS_LAW_BATCH / PLS_BOND_VECTOR ///< vectors of bonds per batch
};

/// q v q*, of columns.
static inline __attribute__((always_inline)) void turn(const pls_vd q[4], const pls_vd v[3], pls_vd out[3])
{
    pls_vd t[3];
    for (int a = 0; a < 3; ++a)
    {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        t[a] = 2.0 * (q[1 + b] * v[c] - q[1 + c] * v[b]);
    }
    for (int a = 0; a < 3; ++a)
    {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        out[a] = v[a] + (q[0] * t[a] + (q[1 + b] * t[c] - q[1 + c] * t[b]));
    }
}

/// Columns k .. of the work space for PLS_W bonds from `slot` on, seen from `own`.
static inline __attribute__((always_inline)) void look(const pls_bond_set *set, size_t own, size_t slot, size_t k, pls_link_work *work)
{
    const pls_links *links = &set->links;
    pls_row row[PLS_W];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane) row[lane] = pls_row_load(links->pose[set->family.partner[slot + (size_t)lane]]);
    pls_vd pose[8], mine[8], d[3];
    pls_columns8(row, pose);
    for (int c = 0; c < 8; ++c) mine[c] = pls_vd_set(links->pose[own][c]);
    for (int c = 0; c < 3; ++c) d[c] = pose[c] - mine[c];
    const pls_vd length = pls_vd_sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), inverse = 1.0 / length;
    pls_vd_store(&work->length[k], length);
    const pls_vd reference = pls_vd_load(set->family.length + slot);
    pls_vd_store(&work->reference[k], pls_vd_max(reference, -reference)); // negative: about to break
    for (int c = 0; c < 3; ++c) pls_vd_store(&work->unit[c][k], d[c] * inverse);
    const double *fixed = links->fixed + slot / PLS_BOND_VECTOR * PLS_BOND_VECTOR * PLS_LINK_NUMBERS + slot % PLS_BOND_VECTOR;
#pragma GCC unroll 4
    for (int which = 0; which < 4; ++which)
    {
        pls_vd v[3], out[3];
        for (int c = 0; c < 3; ++c) v[c] = pls_vd_load(fixed + 8 * (3 * which + c));
        turn(which % 2 == 0 ? mine + 4 : pose + 4, v, out);
        for (int c = 0; c < 3; ++c) pls_vd_store(which < 2 ? &work->along[which][c][k] : &work->across[which - 2][c][k], out[c]);
    }
}

/// Of what bonds can carry, a critical stretch counts like a strength; tougher bonds carry less of it.
static void toughen(const pls_bond_set *set, size_t own, size_t slot, size_t k, pls_link_work *work)
{
    const double(*rows)[PLS_CONDITION_NUMBERS] = (const double(*)[PLS_CONDITION_NUMBERS])set->conditions.row;
    for (size_t lane = 0; lane < PLS_BOND_VECTOR; ++lane)
        work->load[k + lane] = fmax(work->load[k + lane], (work->length[k + lane] / work->reference[k + lane] - 1.0) / set->stretch);
    for (size_t lane = 0; rows && lane < PLS_BOND_VECTOR; ++lane)
        work->load[k + lane] /=
            0.5 * (rows[own][PLS_CONDITION_TOUGHNESS] + rows[set->family.partner[slot + lane]][PLS_CONDITION_TOUGHNESS]);
}

void PLS_SIMD(pls_link_family)(const pls_bond_set *set, size_t point, size_t vector, size_t vectors, pls_link_work *work)
{
    for (size_t v = 0; v < vectors; ++v)
#pragma GCC unroll 4
        for (size_t part = 0; part < PARTS; ++part)
            look(set, point, (vector + v) * PLS_BOND_VECTOR + part * PLS_W, v * PLS_BOND_VECTOR + part * PLS_W, work);
    pls_links_ask(&set->links, vectors * PLS_BOND_VECTOR, work);
    for (size_t v = 0; v < vectors; ++v) toughen(set, point, (vector + v) * PLS_BOND_VECTOR, v * PLS_BOND_VECTOR, work);
}

/// Sums of a point while its family is passed.
typedef struct sums
{
    pls_vd part[6][PARTS];
    unsigned overlong;
} sums;

/// Bonds that hold count.
static inline __attribute__((always_inline)) void add(const pls_link_work *work, size_t k, sums *s)
{
    const pls_vd none = pls_vd_set(0.0), most = pls_vd_set(0.5 * PLS_NO_LENGTH), one = pls_vd_set(1.0);
#pragma GCC unroll 4
    for (size_t part = 0; part < PARTS; ++part)
    {
        const size_t at = k + part * PLS_W;
        const pls_vd reference = pls_vd_load(&work->reference[at]), load = pls_vd_load(&work->load[at]);
        const pls_vm held = pls_vm_less(reference, most);
        for (int c = 0; c < 3; ++c)
        {
            s->part[c][part] = s->part[c][part] + pls_vd_choose(held, pls_vd_load(&work->force[c][at]), none);
            s->part[3 + c][part] = s->part[3 + c][part] + pls_vd_choose(held, pls_vd_load(&work->torque[c][at]), none);
        }
        s->overlong |= ~pls_vd_less(pls_vd_choose(held, load, none), one) & ((1u << PLS_W) - 1);
    }
}

bool PLS_SIMD(pls_link_act)(pls_bond_set *set, size_t first, size_t last)
{
    const uint32_t *start = set->family.start;
    pls_link_work work;
    bool any = false;
    size_t p = first, vector = start[first]; // of the sums
    sums s = {0};
    for (size_t begin = start[first]; begin < start[last]; begin += VECTORS)
    {
        const size_t end = begin + VECTORS < start[last] ? begin + VECTORS : start[last];
        for (size_t v = begin, owner = p; v < end; ++v)
        {
            while (v >= start[owner + 1]) ++owner;
            for (size_t part = 0; part < PARTS; ++part)
                look(set, owner, v * PLS_BOND_VECTOR + part * PLS_W, (v - begin) * PLS_BOND_VECTOR + part * PLS_W, &work);
        }
        pls_links_ask(&set->links, (end - begin) * PLS_BOND_VECTOR, &work);
        for (; vector < end; ++vector)
        {
            toughen(set, p, vector * PLS_BOND_VECTOR, (vector - begin) * PLS_BOND_VECTOR, &work);
            add(&work, (vector - begin) * PLS_BOND_VECTOR, &s);
            if (vector + 1 < start[p + 1]) continue;
            for (int c = 0; c < 3; ++c) set->force[p][c] = pls_lanes_sum(s.part[c]), set->torque[p][c] = pls_lanes_sum(s.part[3 + c]);
            if (s.overlong) set->overlong[p] = 1, any = true;
            s = (sums){0};
            ++p;
        }
    }
    return any;
}
