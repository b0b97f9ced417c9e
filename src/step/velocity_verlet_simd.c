// velocity_verlet_simd.c -- velocity Verlet for bodies (P1 section 4.2.2), a vector of bodies at a time.
//
//     begin    u = v + dt/2 a(t)        x += dt u        q <- rotation by dt u_w        lead = dt/4 (a(t) + a(t - dt))
//     finish   a = F/m                  v = u + dt/2 a
//
// In between rows hold u, the velocity of the middle of the step: what tangential springs integrate. Dashpots and body forces see the velocity of the end, u + lead.
// Second order needs an estimate of the acceleration there; the last one alone would do, but halves the step at which dashpots stay stable. The mean of the last two
// keeps the order and has the limit of the plain leapfrog, (2/w)(sqrt(1 + z^2) - z), for all damping ratios z (docs/theory.md).
//
// Rotation: q <- (1, dt/2 w) q / |...|, the Cayley form of the exponential map: a rotation about w by 2 atan(|w| dt / 2), second order, unit by construction.
// (P1 eq. 23 as printed lacks the old orientation.) Bodies with three different moments are advanced apart (rigid_rotation.c).

#include "step/velocity_verlet.h"

enum { SLOTS_AHEAD = 16 }; ///< how many rows ahead the slots of a row are fetched

static const pls_v4i three = {-1, -1, -1, 0}; ///< mask of the first three

// ---- a vector of bodies ---------------------------------------------------------------------------------------------------------------------------------

/// Rows first .. first + count, count <= PLS_W; what is beyond repeats the first and is not stored.
typedef struct group
{
    pls_bodies *bodies;
    size_t first;
    int count;
    pls_vd place[8]; ///< x y z r | v, lead_z
    pls_vd spin[8];  ///< w, lead_x | w of the end, lead_y
    pls_vd load[8];  ///< F, 1/m | T, 1/I
} group;

static inline size_t row_of(const group *g, int lane) { return g->first + (size_t)(lane < g->count ? lane : 0); }

static inline __attribute__((always_inline)) void load_motion(group *g)
{
    pls_row place[PLS_W];
    pls_v4 spin[PLS_W];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane)
    {
        place[lane] = pls_row_load(&g->bodies->place[row_of(g, lane)].x);
        spin[lane] = pls_v4_load(&g->bodies->spin[row_of(g, lane)].wx);
    }
    pls_columns8(place, g->place);
    pls_columns4(spin, g->spin);
}

/// Positions and velocities back; with `within` the spins of the end and the leads too.
static inline __attribute__((always_inline)) void store_motion(const group *g, int within)
{
    double *place[PLS_W], *spin[PLS_W];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane)
    {
        place[lane] = &g->bodies->place[row_of(g, lane)].x;
        spin[lane] = &g->bodies->spin[row_of(g, lane)].wx;
    }
    pls_rows8(g->place, place, g->count);
    if (within)
        pls_rows8(g->spin, spin, g->count);
    else
        pls_rows4(g->spin, spin, g->count);
}

static inline pls_vd column_load(const group *g, const double *column)
{
    if (g->count == PLS_W) return pls_vd_load(column + g->first);
    pls_vd out = pls_vd_set(0.0);
    for (int lane = 0; lane < g->count; ++lane) out[lane] = column[g->first + (size_t)lane];
    return out;
}

static inline void column_store(const group *g, double *column, pls_vd a)
{
    if (g->count == PLS_W)
        pls_vd_store(column + g->first, a);
    else
        for (int lane = 0; lane < g->count; ++lane) column[g->first + (size_t)lane] = a[lane];
}

// ---- the beginning of a step ---------------------------------------------------------------------------------------------------------------------------

typedef struct drift_sums
{
    pls_vd largest[3]; ///< squared components of velocities [m2/s2]
    pls_vd poison;
} drift_sums;

static inline void report_drift(const drift_sums *sums, double dt, pls_drift_report *report)
{
    *report = (pls_drift_report){0.0, 0.0};
    for (int a = 0; a < 3; ++a)
    {
        double largest = 0.0;
        for (int lane = 0; lane < PLS_W; ++lane) largest = sums->largest[a][lane] > largest ? sums->largest[a][lane] : largest;
        report->largest_square += dt * dt * largest;
    }
    for (int lane = 0; lane < PLS_W; ++lane) report->poison += sums->poison[lane]; // zeros, or NaN: no order to keep
}

/// q <- (1, dt/2 w) q, of length one.
static inline __attribute__((always_inline)) void turn(const group *g, const pls_vd w[3], double half)
{
    pls_v4 row[PLS_W];
    double *out[PLS_W];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane)
    {
        out[lane] = &g->bodies->orientation[row_of(g, lane)].w;
        row[lane] = pls_v4_load(out[lane]);
    }
    pls_vd o[4], q[4], x = half * w[0], y = half * w[1], z = half * w[2];
    pls_columns4(row, o);
    q[0] = pls_vd_less_product(z, o[3], pls_vd_less_product(y, o[2], pls_vd_less_product(x, o[1], o[0])));
    q[1] = pls_vd_less_product(z, o[2], pls_vd_fma(y, o[3], pls_vd_fma(x, o[0], o[1])));
    q[2] = pls_vd_fma(z, o[1], pls_vd_fma(y, o[0], pls_vd_less_product(x, o[3], o[2])));
    q[3] = pls_vd_fma(z, o[0], pls_vd_less_product(y, o[1], pls_vd_fma(x, o[2], o[3])));
    // 1/|q| from |q|^2 = 1 + e; a body turns little in a step, so the series is exact to round-off nearly always.
    const pls_vd little = pls_vd_set(1e-4);
    pls_vd e = pls_vd_fma(q[3], q[3], pls_vd_fma(q[2], q[2], pls_vd_fma(q[1], q[1], pls_vd_product_less(q[0], q[0], pls_vd_set(1.0)))));
    pls_vd scale = pls_vd_less_product(e, pls_vd_set(0.3125), pls_vd_set(0.375));
    scale = pls_vd_less_product(e, pls_vd_less_product(e, scale, pls_vd_set(0.5)), pls_vd_set(1.0));
    unsigned small = pls_vd_less(e, little) & pls_vd_less(-little, e);
    if (small != (1u << PLS_W) - 1) scale = pls_vd_choose(pls_vm_of(small), scale, 1.0 / pls_vd_sqrt(1.0 + e));
    for (int c = 0; c < 4; ++c) q[c] = scale * q[c];
    pls_rows4(q, out, g->count);
}

/// From forces and velocities of now; remembers the forces, which are `load` by rows. Orientations are left to `turn`.
static inline __attribute__((always_inline)) void begin(group *g, const pls_row load[PLS_W], double dt, drift_sums *sums)
{
    const double half = 0.5 * dt, quarter = 0.25 * dt;
    const pls_vd zero = pls_vd_set(0.0);
    pls_row last[PLS_W];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane) last[lane] = pls_row_of_floats(&g->bodies->before[row_of(g, lane)].fx);
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane)
        if (lane < g->count)
            pls_row_to_floats(&g->bodies->before[row_of(g, lane)].fx,
                              pls_row_pick(three, three, load[lane], pls_row_join(pls_v4_set(0.0), pls_v4_set(0.0))));
    pls_vd old[8], lead[3], u[3], uw[3];
    pls_columns8(last, old);
    for (int a = 0; a < 3; ++a)
    {
        pls_vd acceleration = g->load[a] * g->load[3], angular = g->load[4 + a] * g->load[7];
        lead[a] = quarter * pls_vd_fma(old[a], g->load[3], acceleration);
        u[a] = pls_vd_fma(pls_vd_set(half), acceleration, g->place[4 + a]);
        uw[a] = pls_vd_fma(pls_vd_set(half), angular, g->spin[a]);
        g->spin[4 + a] = pls_vd_fma(pls_vd_set(quarter), pls_vd_fma(old[4 + a], g->load[7], angular), uw[a]);
        pls_vd square = u[a] * u[a];
        g->place[a] = pls_vd_fma(pls_vd_set(dt), u[a], g->place[a]);
        g->place[4 + a] = u[a];
        g->spin[a] = uw[a];
        sums->largest[a] = pls_vd_max(square, sums->largest[a]);
        sums->poison = pls_vd_fma(uw[a], zero, pls_vd_fma(square, zero, sums->poison));
    }
    g->spin[3] = lead[0];
    g->spin[7] = lead[1];
    g->place[7] = lead[2];
}

void PLS_SIMD(pls_verlet_begin)(pls_bodies *bodies, size_t first, size_t last, double dt, pls_drift_report *report)
{
    drift_sums sums = {0};
    for (size_t row = first; row < last; row += PLS_W)
    {
        group g = {.bodies = bodies, .first = row, .count = last - row < PLS_W ? (int)(last - row) : PLS_W};
        load_motion(&g);
        pls_row load[PLS_W];
        for (int lane = 0; lane < PLS_W; ++lane) load[lane] = pls_row_load(&bodies->load[row_of(&g, lane)].fx);
        pls_columns8(load, g.load);
        begin(&g, load, dt, &sums);
        turn(&g, g.spin, 0.5 * dt);
        store_motion(&g, 1);
    }
    report_drift(&sums, dt, report);
}

// ---- the end of a step ----------------------------------------------------------------------------------------------------------------------------------

/// List the candidates of a row that touch anew.
static __attribute__((noinline)) void list_touching(pls_pair_list *list, size_t row)
{
    uint32_t *head = pls_near_row(list, row), *to = head + PLS_NEAR_HEAD, *from = to;
    const uint32_t *entry = list->pairs.entry, first = list->pairs.start[row], last = list->pairs.start[row + 1];
    for (unsigned side = 2; side-- > 0; from = to) // partners with lower numbers come first: the body is j there
    {
        for (uint32_t k = first; k < last; ++k)
            if ((entry[k] & 1) == side && pls_pair_touches(list, entry[k] >> 1)) *to++ = (uint32_t)pls_live_slot(list, entry[k] >> 1);
        while ((to - from) % PLS_NEAR_STRIDE != 0) *to++ = (uint32_t)pls_zero_slot(list);
        head[1 - side] = (uint32_t)(to - from);
    }
}

static inline pls_row slot_of(const pls_pair_list *list, uint32_t number) { return pls_row_load(list->live + (size_t)number * PLS_SLOT); }

/// The same with the torque about the centre of i (side 1) or j (side -1).
static inline pls_row skewed_slot_of(const pls_pair_list *list, uint32_t number, double side)
{
    double lever = 1.0 + side * list->skew[number];
    return pls_row_scale(slot_of(list, number), pls_v4_set(1.0), (pls_v4){lever, lever, lever, 1.0});
}

/// Force, power of dashpots, torque, work of sliders: what the contacts of a body come to, in order of the partners' numbers.
static inline __attribute__((always_inline)) pls_row gather_pairs(pls_pair_list *list, size_t row, int skewed)
{
    const uint32_t *head = pls_near_row(list, row), *entry = head + PLS_NEAR_HEAD;
    if (head[0] == PLS_NEAR_STALE) list_touching(list, row);
    pls_row sum = pls_row_join(pls_v4_set(0.0), pls_v4_set(0.0));
    const uint32_t *end = entry + head[0];
    for (; entry < end; entry += PLS_NEAR_STRIDE)
#pragma GCC unroll 3
        for (int k = 0; k < PLS_NEAR_STRIDE; ++k)
            sum = pls_row_add(sum, skewed ? skewed_slot_of(list, entry[k], -1.0) : slot_of(list, entry[k]));
    sum = pls_row_flip(sum, (pls_v4i){INT64_MIN, INT64_MIN, INT64_MIN, 0}, (pls_v4i){0, 0, 0, 0});
    for (end += head[1]; entry < end; entry += PLS_NEAR_STRIDE)
#pragma GCC unroll 3
        for (int k = 0; k < PLS_NEAR_STRIDE; ++k)
            sum = pls_row_add(sum, skewed ? skewed_slot_of(list, entry[k], 1.0) : slot_of(list, entry[k]));
    return sum;
}

/// Fetch into the cache the slots a row will gather: some were written long ago, when the sweep passed its partners' rows.
static inline void fetch_slots(const pls_pair_list *list, size_t row)
{
    const uint32_t *head = pls_near_row(list, row), *entry = head + PLS_NEAR_HEAD;
    if (head[0] == PLS_NEAR_STALE) return;
    for (const uint32_t *end = entry + head[0] + head[1]; entry < end; entry += PLS_NEAR_STRIDE)
#pragma GCC unroll 3
        for (int k = 0; k < PLS_NEAR_STRIDE; ++k) __builtin_prefetch(list->live + (size_t)entry[k] * PLS_SLOT);
}

static inline pls_row gather_walls(const pls_pair_list *list, size_t row, pls_row sum)
{
    for (uint32_t k = list->walls.start[row]; k < list->walls.start[row + 1]; ++k)
    {
        uint32_t entry = list->walls.entry[k];
        if (pls_pair_touches(list, entry >> 1)) sum = pls_row_add(sum, pls_row_load(pls_wall_slot(list, entry >> 1) + (entry & 1) * 8));
    }
    return sum;
}

/// Velocities of the end from the sums of the contacts' slots and body forces, which with the masses are `load`; what contacts took is booked, half to either body. Forces are
/// stored where somebody may ask for them: if the step does not go on, else `begin` remembers them.
static inline __attribute__((always_inline)) void finish(group *g, const pls_row sum[PLS_W], double dt, bool go_on, pls_row load[PLS_W])
{
    const double half = 0.5 * dt;
    pls_bodies *b = g->bodies;
    pls_vd total[8];
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane)
    {
        double *row = &b->load[row_of(g, lane)].fx;
        load[lane] = pls_row_pick(three, three, sum[lane], pls_row_load(row));
        if (!go_on && lane < g->count) pls_row_store(row, load[lane]);
    }
    pls_columns8(sum, total);
    pls_last_columns(load, &g->load[3], &g->load[7]);
    for (int a = 0; a < 3; ++a)
    {
        g->load[a] = total[a], g->load[4 + a] = total[4 + a];
        g->place[4 + a] = pls_vd_fma(pls_vd_set(half), g->load[a] * g->load[3], g->place[4 + a]);
        g->spin[a] = pls_vd_fma(pls_vd_set(half), g->load[4 + a] * g->load[7], g->spin[a]);
    }
    const pls_vd power = 0.5 * total[3], last_power = column_load(g, b->damping_power), damped = column_load(g, b->damped),
                 slid = column_load(g, b->slid);
    column_store(g, b->damped, pls_vd_fma(pls_vd_set(half), last_power + power, damped));
    column_store(g, b->damping_power, power);
    column_store(g, b->slid, pls_vd_fma(pls_vd_set(0.5), total[7], slid));
}

static inline __attribute__((always_inline)) void finish_rows(pls_bodies *bodies, pls_pair_list *list, size_t first, size_t last, double dt,
                                                              const double *force, const double *torque, int skewed, bool go_on,
                                                              pls_drift_report *report)
{
    const bool fetch = bodies->count > PLS_VAST_WORLD; // elsewhere they have not gone far
    drift_sums sums = {0};
    group behind = {.count = 0}; // its orientations are turned a group later, while the slots of the next are on their way
    for (size_t row = first; row < last; row += PLS_W)
    {
        group g = {.bodies = bodies, .first = row, .count = last - row < PLS_W ? (int)(last - row) : PLS_W};
        pls_row sum[PLS_W];
        const bool walls = list->walls.start[row] != list->walls.start[row + (size_t)g.count]; // most vectors of bodies lie inside
        for (int lane = 0; lane < PLS_W; ++lane)
        {
            size_t k = row_of(&g, lane);
            if (fetch && row + SLOTS_AHEAD + PLS_W <= last) fetch_slots(list, row + SLOTS_AHEAD + (size_t)lane);
            sum[lane] = gather_pairs(list, k, skewed);
            if (walls) sum[lane] = gather_walls(list, k, sum[lane]);
            if (force)
                sum[lane] =
                    pls_row_add(sum[lane], pls_row_join(pls_v4_load(force + 4 * (k - first)), pls_v4_load(torque + 4 * (k - first))));
        }
        if (behind.count > 0) turn(&behind, behind.spin, 0.5 * dt);
        load_motion(&g);
        pls_row load[PLS_W];
        finish(&g, sum, dt, go_on, load);
        if (go_on)
        {
            begin(&g, load, dt, &sums);
            behind.bodies = bodies, behind.first = row, behind.count = g.count; // only what `turn` asks for: whole, it would be copied
            for (int a = 0; a < 3; ++a) behind.spin[a] = g.spin[a];
        }
        else
            for (int a = 0; a < 3; ++a) sums.poison = sums.poison + (g.place[4 + a] * 0.0 + g.spin[a] * 0.0);
        store_motion(&g, go_on);
    }
    if (behind.count > 0) turn(&behind, behind.spin, 0.5 * dt);
    report_drift(&sums, dt, report);
}

void PLS_SIMD(pls_verlet_finish)(pls_bodies *bodies, pls_pair_list *list, size_t first, size_t last, double dt, const double *force,
                                 const double *torque, bool go_on, pls_drift_report *report)
{
    if (list->equal_radii)
        finish_rows(bodies, list, first, last, dt, force, torque, 0, go_on, report);
    else
        finish_rows(bodies, list, first, last, dt, force, torque, 1, go_on, report);
}
