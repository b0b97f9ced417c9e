// velocity_verlet_simd.c -- velocity Verlet for bodies (P1 section 4.2.2), one body at a time, a row of four numbers per instruction.
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

static const pls_v4i first_three = {-1, -1, -1, 0};

static inline pls_v4 only_first_three(pls_v4 a) { return (pls_v4)((pls_v4i)a & first_three); }

static inline void turn(pls_body_orientation *orientation, pls_v4 w, double half)
{
    double x = half * w[0], y = half * w[1], z = half * w[2];
    double qw = orientation->w, qx = orientation->x, qy = orientation->y, qz = orientation->z;
    pls_v4 q = {qw - x * qx - y * qy - z * qz, qx + x * qw + y * qz - z * qy, qy - x * qz + y * qw + z * qx, qz + x * qy - y * qx + z * qw};
    // 1/|q| from |q|^2 = 1 + e; a body turns little in a step, so the series is exact to round-off nearly always.
    double e = (q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]) - 1.0;
    double scale = e < 1e-4 && e > -1e-4 ? 1.0 - e * (0.5 - e * (0.375 - e * 0.3125)) : 1.0 / sqrt(1.0 + e);
    pls_v4_store(&orientation->w, pls_v4_set(scale) * q);
}

typedef struct drift_sums
{
    pls_v4 largest; ///< squared components of displacements
    pls_v4 poison;
} drift_sums;

static inline __attribute__((always_inline)) void begin_row(pls_bodies *bodies, size_t row, double dt, drift_sums *sums)
{
    const double half = 0.5 * dt, quarter = 0.25 * dt;
    pls_body_place *p = &bodies->place[row];
    pls_body_spin *s = &bodies->spin[row];
    const pls_body_load *now = &bodies->load[row];
    pls_f8 *before = (pls_f8 *)&bodies->before[row];
    pls_v4 x = pls_v4_load(&p->x), v = pls_v4_load(&p->vx), w = pls_v4_load(&s->wx);
    pls_v4 f = pls_v4_load(&now->fx), t = pls_v4_load(&now->tx);
    pls_v8 old = __builtin_convertvector(*before, pls_v8);
    pls_v4 a = only_first_three(f * now->inv_mass), b = only_first_three(t * now->inv_inertia);
    pls_v4 a_last = only_first_three(pls_v8_low(old) * now->inv_mass), b_last = only_first_three(pls_v8_high(old) * now->inv_inertia);
    *before = __builtin_convertvector(pls_v8_join(only_first_three(f), only_first_three(t)), pls_f8);

    pls_v4 u = v + half * a, uw = w + half * b;
    pls_v4 step = only_first_three(dt * u), lead = quarter * (a + a_last), end = uw + quarter * (b + b_last);
    u[3] = lead[2];
    uw[3] = lead[0];
    end[3] = lead[1];
    pls_v4_store(&p->x, x + step);
    pls_v4_store(&p->vx, u);
    pls_v4_store(&s->wx, uw);
    pls_v4_store(&s->end_x, end);
    turn(&bodies->orientation[row], uw, half);

    pls_v4 square = step * step;
    sums->largest = pls_v4_pick((pls_v4i)(sums->largest > square), sums->largest, square);
    sums->poison += square * 0.0 + only_first_three(uw) * 0.0;
}

static inline void report_drift(const drift_sums *sums, pls_drift_report *report)
{
    report->largest_square = sums->largest[0] + sums->largest[1] + sums->largest[2];
    report->poison = sums->poison[0] + sums->poison[1] + sums->poison[2];
}

void PLS_SIMD(pls_verlet_begin)(pls_bodies *bodies, size_t first, size_t last, double dt, pls_drift_report *report)
{
    drift_sums sums = {pls_v4_set(0.0), pls_v4_set(0.0)};
    for (size_t row = first; row < last; ++row) begin_row(bodies, row, dt, &sums);
    report_drift(&sums, report);
}

typedef struct gathered
{
    pls_v4 force, torque;
    pls_v2 booked; ///< power taken by dashpots, work taken by sliding
} gathered;

/// List the touching entries of a row anew.
static __attribute__((noinline)) void list_touching(pls_pair_list *list, size_t row)
{
    uint32_t count = 0, *to = list->near_entry + list->pairs.start[row];
    for (uint32_t k = list->pairs.start[row]; k < list->pairs.start[row + 1]; ++k)
        if (pls_pair_touches(list, list->pairs.entry[k] >> 1)) to[count++] = list->pairs.entry[k];
    list->near_count[row] = count;
    list->near_stale[row] = 0;
}

static inline void add_pair(const pls_pair_list *list, uint32_t entry, double radius, gathered *g)
{
    const double *slot = list->slot + (size_t)(entry >> 1) * PLS_SLOT;
    const int64_t sign = (int64_t)((uint64_t)entry << 63);
    pls_v4 low = pls_v4_load(slot), high = pls_v4_load(slot + 4);
    g->force += (pls_v4)((pls_v4i)low ^ (pls_v4i){sign, sign, sign, sign});
    g->torque += (radius - low[3]) * only_first_three(high);
    g->booked += __builtin_convertvector(*(const pls_f2 *)(slot + 7), pls_v2);
}

enum {
    ROWS_AHEAD = 8,   ///< rows whose forces are fetched into the cache before they are summed; within PLS_ROW_REACH
    ENTRIES_AHEAD = 8 ///< entries fetched of such a row; what lies behind its touching ones does no harm
};

static inline void fetch_slots(const pls_pair_list *list, size_t row)
{
    const uint32_t *entry = list->near_entry + list->pairs.start[row];
    for (int k = 0; k < ENTRIES_AHEAD; ++k) __builtin_prefetch(list->slot + (size_t)(entry[k] >> 1) * PLS_SLOT);
}

static inline void gather_pairs(pls_pair_list *list, size_t row, double radius, gathered *g)
{
    if (list->near_stale[row]) list_touching(list, row);
    const uint32_t *entry = list->near_entry + list->pairs.start[row], *end = entry + list->near_count[row];
    for (; entry < end; ++entry) add_pair(list, *entry, radius, g);
}

static inline void gather_walls(const pls_pair_list *list, size_t row, gathered *g)
{
    for (uint32_t k = list->walls.start[row]; k < list->walls.start[row + 1]; ++k)
    {
        uint32_t entry = list->walls.entry[k];
        if (!pls_pair_touches(list, entry >> 1)) continue;
        const double *slot = pls_wall_slot(list, entry >> 1);
        pls_v4 force = pls_v4_load(slot);
        if (entry & 1)
        {
            g->force -= force;
            g->torque += pls_v4_load(slot + 8);
        }
        else
        {
            g->force += force;
            g->torque += pls_v4_load(slot + 4);
        }
        g->booked += (pls_v2){slot[3], slot[7]};
    }
}

static inline void finish_row(pls_bodies *bodies, size_t row, double dt, const gathered *g)
{
    const double half = 0.5 * dt;
    pls_body_place *p = &bodies->place[row];
    pls_body_spin *s = &bodies->spin[row];
    pls_body_load *load = &bodies->load[row];
    pls_body_energy *energy = &bodies->energy[row];
    pls_v4 f = only_first_three(g->force), t = only_first_three(g->torque);
    pls_v4_store(&p->vx, pls_v4_load(&p->vx) + half * (f * load->inv_mass));
    pls_v4_store(&s->wx, pls_v4_load(&s->wx) + half * (t * load->inv_inertia));
    f[3] = load->inv_mass;
    t[3] = load->inv_inertia;
    pls_v4_store(&load->fx, f);
    pls_v4_store(&load->tx, t);

    double power = 0.5 * g->booked[0]; // half of each contact's dissipation to either body
    energy->damped += half * (energy->power + power);
    energy->power = power;
    energy->slid += 0.5 * g->booked[1];
}

void PLS_SIMD(pls_verlet_finish)(pls_bodies *bodies, pls_pair_list *list, size_t first, size_t last, double dt, const double *force,
                                 const double *torque, pls_drift_report *next)
{
    drift_sums sums = {pls_v4_set(0.0), pls_v4_set(0.0)};
    const bool large = bodies->count > PLS_LARGE_WORLD;
    for (size_t row = first; row < last; ++row)
    {
        gathered g = {pls_v4_set(0.0), pls_v4_set(0.0), {0.0, 0.0}};
        if (force)
        {
            g.force = pls_v4_load(force + 4 * (row - first));
            g.torque = pls_v4_load(torque + 4 * (row - first));
        }
        if (large) fetch_slots(list, row + ROWS_AHEAD);
        gather_pairs(list, row, bodies->place[row].radius, &g);
        gather_walls(list, row, &g);
        finish_row(bodies, row, dt, &g);
        if (next) begin_row(bodies, row, dt, &sums);
    }
    if (next) report_drift(&sums, next);
}
