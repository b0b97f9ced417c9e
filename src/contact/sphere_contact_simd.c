// sphere_contact_simd.c -- the hot loop: one block of candidates at a time, as short loops over arrays that stay in the first-level cache:
//
//     filter   which candidates touch (positions and radii only), and which of them touch for the first time
//     load     rows of both bodies to columns over contacts; normal and overlap
//     frame    relative velocities at the contact point, the spring carried into the contact frame of now
//     law      forces from overlap, velocity and spring (the user's door)
//     store    force and n x shear into the contact's own slot, spring back to its history
//
// Body rows are loaded whole and transposed in registers. Everything is lane by lane, so the width does not show in the bits.
//
// Contact point (P1 section 3.1): c = (x1 + x2)/2, so the lever arms are (r_i - delta/2) n and -(r_j - delta/2) n, and the relative velocity is
// v_i - v_j + (l_i w_i + l_j w_j) x n at this one point. On request (`lever_at_surface`) velocities are those of the surface points x1 and x2, levers r_i
// and r_j, as in P1 eq. 15b and LAMMPS; torques between grains then still act at c, so that angular momentum is kept, but a pair turning as one rigid body
// slips by |w| delta and work and torque do not match.
//
// The spring. s' = v_t is integrated by the midpoint rule: s += dt u_t, with u the velocities of the middle of the step, which Verlet has exactly, and normal and
// levers of the middle, half a step back. (The velocity that dashpots see would do for the order, but lags: it feeds energy to springs of undamped contacts, step
// after step.) The old spring is carried along with the contact frame: projected on the new tangent plane with its length kept and turned about n by the
// angle of the pair's mean spin; the new piece by half of it. A contact that begins within the step has had min(dt, delta/v_n) of it.

#include "contact/sphere_contact.h"

#include <string.h>

enum { FETCH_AHEAD = 48 }; ///< candidates; within PLS_PAIR_REACH

static inline pls_v4 flip_first_three(pls_v4 a) { return (pls_v4)((pls_v4i)a ^ (pls_v4i){INT64_MIN, INT64_MIN, INT64_MIN, 0}); }

/// X_j - X_i, r_i + r_j | u_i - u_j, lead_z of i less j, from two rows.
static inline pls_v8 pair_row(const pls_body_place *i, const pls_body_place *j)
{
    const int64_t minus = INT64_MIN;
    const pls_v8i of_i = {minus, minus, minus, 0, 0, 0, 0, 0}, of_j = {0, 0, 0, 0, minus, minus, minus, minus};
    return (pls_v8)((pls_v8i)pls_v8_load(&j->x) ^ of_j) + (pls_v8)((pls_v8i)pls_v8_load(&i->x) ^ of_i);
}

/// w_i + w_j in the middle, lead_x of i less j | the same sum at the end, lead_y of i less j.
static inline pls_v8 sum_row(pls_v8 i, pls_v8 j)
{
    const pls_v8i of_j = {0, 0, 0, INT64_MIN, 0, 0, 0, INT64_MIN};
    return i + (pls_v8)((pls_v8i)j ^ of_j);
}

static inline pls_v4 image_shift(const pls_pair_list *list, size_t c, pls_v4 edge)
{
    const int16_t *s = list->shift[c];
    return (pls_v4){s[0], s[1], s[2], 0.0} * edge;
}

// ---- filter -------------------------------------------------------------------------------------------------------------------------------------------

/// Note the touching lanes of candidates c .. c + 7 and clear the history of those that begin.
static inline void note_touching(pls_pair_list *list, const pls_pair_section *section, size_t c, unsigned now, pls_contact_work *work)
{
    unsigned before = list->touch[c >> 3], fresh = now & ~before, changed = now ^ before;
    list->touch[c >> 3] = (uint8_t)now;
    list->ended[c >> 3] = (uint8_t)(before & ~now);
    for (; changed && !section->wall; changed &= changed - 1) // seldom
    {
        size_t m = c + (size_t)__builtin_ctz(changed);
        __atomic_store_n(&list->near_stale[list->row_i[m]], 1, __ATOMIC_RELAXED); // two threads may say the same
        __atomic_store_n(&list->near_stale[list->row_j[m]], 1, __ATOMIC_RELAXED);
    }
    while (fresh) // seldom
    {
        unsigned lane = (unsigned)__builtin_ctz(fresh);
        fresh &= fresh - 1;
        work->fresh[work->fresh_count++] = (uint32_t)(work->active_count + (size_t)__builtin_popcount(now & ((1u << lane) - 1)));
        double *history = list->history + section->history + (c + lane - section->first) * (size_t)section->stride;
        memset(history, 0, (size_t)section->stride * sizeof *history);
    }
    // No branch on which lanes touch: all eight places are written, the next batch overwrites what is too many.
    uint32_t *active = work->active + work->active_count;
    const uint8_t *lane = pls_packed_lanes[now];
    for (int k = 0; k < 8; ++k) active[k] = (uint32_t)c + lane[k];
    work->active_count += (size_t)__builtin_popcount(now);
}

/// Fetch into the cache what the next block will need of the candidates that touched at the last step; nearly all of them still do.
static inline void fetch_ahead(const pls_pair_list *list, const pls_contact_input *in, const pls_pair_block *block)
{
    if (block == list->block + list->block_count) return;
    const pls_pair_section *section = &list->section[block->section];
    const size_t stride = (size_t)section->stride;
    const double *history = list->history + section->history - section->first * stride;
    for (size_t c = block->first; c < block->first + block->count; c += 8)
    {
        unsigned touching = list->touch[c >> 3];
        const uint8_t *lane = pls_packed_lanes[touching];
        for (int k = __builtin_popcount(touching) - 1; k >= 0; --k)
        {
            size_t m = c + lane[k];
            __builtin_prefetch(history + m * stride, 1);
            __builtin_prefetch(section->wall ? pls_wall_slot(list, m) : list->slot + m * PLS_SLOT, 1);
            __builtin_prefetch(&in->spin[list->row_j[m]]);
        }
    }
}

static inline unsigned valid_lanes(const pls_pair_block *block, size_t k)
{
    return block->count - k >= 8 ? 0xffu : (1u << (block->count - k)) - 1;
}

static inline __attribute__((always_inline)) void filter_pairs(pls_pair_list *list, const pls_contact_input *in,
                                                               const pls_pair_section *section, const pls_pair_block *block,
                                                               pls_contact_work *work, int periodic)
{
    const pls_v4 edge = {in->domain->edge[0], in->domain->edge[1], in->domain->edge[2], 0.0};
    for (size_t k = 0; k < block->count; k += 8)
    {
        size_t c = block->first + k;
        unsigned now = 0;
        for (int lane = 0; in->large && lane < 8; ++lane) __builtin_prefetch(&in->place[list->row_j[c + FETCH_AHEAD + (size_t)lane]]);
        for (int half = 0; half < 8; half += PLS_W)
        {
            pls_v4 row[PLS_W];
#pragma GCC unroll 8
            for (int lane = 0; lane < PLS_W; ++lane)
            {
                size_t m = c + (size_t)(half + lane);
                row[lane] = pls_v4_load(&in->place[list->row_j[m]].x) + flip_first_three(pls_v4_load(&in->place[list->row_i[m]].x));
                if (periodic) row[lane] += image_shift(list, m, edge);
            }
            pls_vd d[4];
            pls_columns4(row, d);
            now |= pls_vd_less(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], d[3] * d[3]) << half;
        }
        note_touching(list, section, c, now & valid_lanes(block, k), work);
    }
}

// ---- load -------------------------------------------------------------------------------------------------------------------------------------------------

typedef struct frame
{
    pls_vd n[3], delta;
    pls_vd v[3];      ///< relative velocity at the contact point at the end of the step
    pls_vd u[3];      ///< tangential velocity in the middle of the step
    pls_vd spin;      ///< mean spin about n, in the middle
    pls_vd spring[3]; ///< as stored
} frame;

/// Normal and tangential velocity, and the spring in the frame of now, as it would be had it not slid.
static inline __attribute__((always_inline)) void set_frame(pls_contact_work *work, size_t k, const frame *f, const pls_contact_input *in)
{
    const pls_vd zero = pls_vd_set(0.0), one = pls_vd_set(1.0);
    pls_vd vn = f->v[0] * f->n[0] + f->v[1] * f->n[1] + f->v[2] * f->n[2];
    pls_vd un = f->u[0] * f->n[0] + f->u[1] * f->n[1] + f->u[2] * f->n[2]; // small: the frame has turned since

    // Projected on the tangent plane the spring loses sn of its length; |s|/|t| = sqrt(1 + e), e = sn^2/|t|^2, tiny: the plane turns little in a step.
    pls_vd t[3];
    const pls_vd *s = f->spring;
    pls_vd sn = s[0] * f->n[0] + s[1] * f->n[1] + s[2] * f->n[2];
    for (int a = 0; a < 3; ++a) t[a] = s[a] - sn * f->n[a];
    pls_vd part = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    pls_vi some = (pls_vi)(part > zero);
    pls_vd e = sn * sn / pls_vd_pick(some, part, one);
    e = pls_vd_pick((pls_vi)(e > one), one, e);
    pls_vd keep = one + e * (0.5 - 0.125 * e);

    // The turn of the frame: sine and cosine as series; a contact turns by far less than a radian in a step.
    pls_vd a = in->dt * f->spin, square = a * a;
    pls_vd cosine = keep * (one - square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0))));
    pls_vd sine = keep * (a * (one - square * (1.0 / 6.0 - square * (1.0 / 120.0 - square * (1.0 / 5040.0)))));
    pls_vd turned[3] = {cosine * t[0] + sine * (f->n[1] * t[2] - f->n[2] * t[1]), cosine * t[1] + sine * (f->n[2] * t[0] - f->n[0] * t[2]),
                        cosine * t[2] + sine * (f->n[0] * t[1] - f->n[1] * t[0])};
    pls_vd step[3], ahead = 0.5 * a;
    for (int c = 0; c < 3; ++c) step[c] = in->dt * (f->u[c] - un * f->n[c]);
    pls_vd half_turn[3] = {ahead * (f->n[1] * step[2] - f->n[2] * step[1]), ahead * (f->n[2] * step[0] - f->n[0] * step[2]),
                           ahead * (f->n[0] * step[1] - f->n[1] * step[0])};
    for (int c = 0; c < 3; ++c)
    {
        pls_vd_store(&work->normal[c][k], f->n[c]);
        pls_vd_store(&work->slip_velocity[c][k], f->v[c] - vn * f->n[c]);
        pls_vd_store(&work->slip_step[c][k], step[c]);
        pls_vd_store(&work->spring[c][k], turned[c] + (step[c] + half_turn[c]));
    }
    pls_vd_store(&work->delta[k], f->delta);
    pls_vd_store(&work->normal_velocity[k], vn);
}

/// v + w x n for three columns each.
static inline void add_cross(pls_vd out[3], const pls_vd v[3], const pls_vd w[3], const pls_vd n[3])
{
    out[0] = v[0] + (w[1] * n[2] - w[2] * n[1]);
    out[1] = v[1] + (w[2] * n[0] - w[0] * n[2]);
    out[2] = v[2] + (w[0] * n[1] - w[1] * n[0]);
}

/// Rows of both bodies to columns over contacts, normals and overlaps.
static inline __attribute__((always_inline)) void load_pairs(const pls_pair_list *list, const pls_contact_input *in,
                                                             const pls_pair_section *section, pls_contact_work *work, int periodic,
                                                             int growing)
{
    const pls_v4 edge = {in->domain->edge[0], in->domain->edge[1], in->domain->edge[2], 0.0};
    const pls_v4 edge_rate = {in->domain->edge_rate[0], in->domain->edge_rate[1], in->domain->edge_rate[2], 0.0};
    const size_t stride = (size_t)section->stride;
    const double *history = list->history + section->history - section->first * stride; // of candidate 0
    for (size_t k = 0; k < work->active_count; k += PLS_W)
    {
        pls_v8 place[PLS_W], turn[PLS_W], sum[PLS_W];
        pls_v4 spring[PLS_W];
        pls_vd growth = pls_vd_set(0.0); // of both radii, half a step's
#pragma GCC unroll 8
        for (int lane = 0; lane < PLS_W; ++lane)
        {
            size_t c = work->active[k + (size_t)lane];
            uint32_t i = list->row_i[c], j = list->row_j[c];
            pls_v8 wi = pls_v8_load(&in->spin[i].wx), wj = pls_v8_load(&in->spin[j].wx);
            place[lane] = pair_row(&in->place[i], &in->place[j]);
            if (periodic) place[lane] += pls_v8_join(image_shift(list, c, edge), -image_shift(list, c, edge_rate));
            sum[lane] = sum_row(wi, wj);
            turn[lane] = in->place[i].radius * wi + in->place[j].radius * wj;
            if (growing)
            {
                double gi = in->before[i].growth, gj = in->before[j].growth; // levers of mid-step
                pls_v4 less = gi * pls_v8_low(wi) + gj * pls_v8_low(wj);
                turn[lane] -= pls_v8_join(less, pls_v4_set(0.0));
                growth[lane] = gi + gj;
            }
            spring[lane] = pls_v4_load(history + c * stride);
        }
        pls_vd d[8], w[8], q[8], s[4];
        pls_columns8(place, d);
        pls_columns8(turn, w); // r_i w_i + r_j w_j, in the middle (0..2) and at the end (4..6)
        pls_columns8(sum, q);  // w_i + w_j likewise, the lead in 3 and 7
        pls_columns4(spring, s);
        pls_vd distance = pls_vd_sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), inv = 1.0 / distance;
        for (int a = 0; a < 3; ++a)
        {
            pls_vd_store(&work->normal[a][k], d[a] * inv);
            pls_vd_store(&work->velocity[a][k], d[4 + a]);
            pls_vd_store(&work->turn[a][k], w[a]);
            pls_vd_store(&work->turn_end[a][k], w[4 + a]);
            pls_vd_store(&work->sum[a][k], q[a]);
            pls_vd_store(&work->sum_end[a][k], q[4 + a]);
            pls_vd_store(&work->spring[a][k], s[a]);
        }
        pls_vd_store(&work->lead[0][k], q[3]);
        pls_vd_store(&work->lead[1][k], q[7]);
        pls_vd_store(&work->lead[2][k], d[7]);
        pls_vd_store(&work->delta[k], d[3] - distance);
        pls_vd_store(&work->inv_distance[k], inv);
        if (growing) pls_vd_store(&work->growth[k], growth);
    }
}

/// Contact frames of the loaded pairs. Apart from loading, so that the long chains of one vector overlap with those of the next.
static inline __attribute__((always_inline)) void frame_pairs(const pls_contact_input *in, const pls_pair_section *section,
                                                              pls_contact_work *work, int growing)
{
    const double inward =
        in->laws->law[section->law].lever_at_surface ? 0.0 : 1.0; // is the overlap's half taken off the levers of velocities?
    for (size_t k = 0; k < work->active_count; k += PLS_W)
    {
        frame f;
        pls_vd rate[3], end[3], levers[3], sum[3];
        f.delta = pls_vd_load(&work->delta[k]);
        pls_vd half = 0.5 * f.delta, cut = inward * half;
        for (int a = 0; a < 3; ++a)
        {
            f.n[a] = pls_vd_load(&work->normal[a][k]);
            f.spring[a] = pls_vd_load(&work->spring[a][k]);
            rate[a] = pls_vd_load(&work->velocity[a][k]);
            sum[a] = pls_vd_load(&work->sum[a][k]);
            end[a] = rate[a] + pls_vd_load(&work->lead[a][k]);
            levers[a] = pls_vd_load(&work->turn_end[a][k]) - cut * pls_vd_load(&work->sum_end[a][k]); // l_i w_i + l_j w_j
        }
        add_cross(f.v, end, levers, f.n);

        // Half a step back: n, delta and levers as they were, from the relative velocity of the centres (minus `rate`) and the growth of radii.
        pls_vd approach = rate[0] * f.n[0] + rate[1] * f.n[1] + rate[2] * f.n[2],
               back = (0.5 * in->dt) * pls_vd_load(&work->inv_distance[k]);
        pls_vd grown = growing ? 0.5 * pls_vd_load(&work->growth[k]) : pls_vd_set(0.0), middle[3], old_levers[3], u[3];
        pls_vd old_cut = cut - inward * (0.25 * in->dt * approach + grown);
        for (int a = 0; a < 3; ++a)
        {
            middle[a] = f.n[a] + back * (rate[a] - approach * f.n[a]);
            old_levers[a] = pls_vd_load(&work->turn[a][k]) - old_cut * sum[a];
        }
        add_cross(u, rate, old_levers, middle);
        pls_vd along = u[0] * middle[0] + u[1] * middle[1] + u[2] * middle[2];
        for (int a = 0; a < 3; ++a) f.u[a] = u[a] - along * middle[a];
        f.spin = 0.5 * (sum[0] * f.n[0] + sum[1] * f.n[1] + sum[2] * f.n[2]);
        set_frame(work, k, &f, in);
        pls_vd_store(&work->lever[k], half);
    }
}

static void load_effective(const pls_pair_list *list, const pls_contact_input *in, pls_contact_work *work)
{
    for (size_t k = 0; k < (work->active_count + 7) / 8 * 8; ++k)
    {
        uint32_t i = list->row_i[work->active[k]], j = list->row_j[work->active[k]];
        double ri = in->place[i].radius, rj = in->place[j].radius;
        work->effective_mass[k] = 1.0 / (in->load[i].inv_mass + in->load[j].inv_mass);
        work->effective_radius[k] = ri * rj / (ri + rj);
    }
}

// ---- store ------------------------------------------------------------------------------------------------------------------------------------------------

static inline int lanes_left(const pls_contact_work *work, size_t k)
{
    return work->active_count - k < PLS_W ? (int)(work->active_count - k) : PLS_W;
}

/// Spring and the law's own numbers back to the history.
static inline void store_history(pls_pair_list *list, const pls_pair_section *section, pls_contact_work *work, size_t k, int kept)
{
    pls_vd column[4] = {pls_vd_load(&work->spring[0][k]), pls_vd_load(&work->spring[1][k]), pls_vd_load(&work->spring[2][k]),
                        kept > 0 ? pls_vd_load(&work->history[0][k]) : pls_vd_set(0.0)};
    double *row[PLS_W];
    int lanes = lanes_left(work, k);
    const size_t stride = (size_t)section->stride;
    double *history = list->history + section->history - section->first * stride; // of candidate 0
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane) row[lane] = history + work->active[k + (size_t)lane] * stride;
    pls_rows4(column, row, lanes);
    for (int h = 1; h < kept; ++h)
        for (int lane = 0; lane < lanes; ++lane) row[lane][3 + h] = work->history[h][k + (size_t)lane];
}

static inline void store_pairs(pls_pair_list *list, const pls_pair_section *section, pls_contact_work *work, int kept)
{
    for (size_t k = 0; k < work->active_count; k += PLS_W)
    {
        pls_vd n[3], ft[3], fn = pls_vd_load(&work->normal_force[k]), column[8];
        for (int a = 0; a < 3; ++a)
        {
            n[a] = pls_vd_load(&work->normal[a][k]);
            ft[a] = pls_vd_load(&work->shear_force[a][k]);
            column[a] = ft[a] - fn * n[a];
        }
        column[3] = pls_vd_load(&work->lever[k]);
        column[4] = n[1] * ft[2] - n[2] * ft[1];
        column[5] = n[2] * ft[0] - n[0] * ft[2];
        column[6] = n[0] * ft[1] - n[1] * ft[0];
        column[7] = pls_vd_pack(pls_vd_load(&work->damping_power[k]), pls_vd_load(&work->slip_work[k]));
        double *row[PLS_W];
#pragma GCC unroll 8
        for (int lane = 0; lane < PLS_W; ++lane) row[lane] = list->slot + (size_t)work->active[k + (size_t)lane] * PLS_SLOT;
        pls_rows8(column, row, lanes_left(work, k));
        store_history(list, section, work, k, kept);
    }
}

// ---- walls ------------------------------------------------------------------------------------------------------------------------------------------------

/// A half-space: outward normal N through a point, moving as a rigid body. n = -N, overlap r - N.(x - X).
typedef struct wall_frame
{
    double normal[3], position[3], inv_mass;
    double velocity[2][3], spin[2][3]; ///< in the middle and at the end of the step
} wall_frame;

static wall_frame wall_of(const pls_contact_input *in, uint32_t row)
{
    const pls_body_place *p = &in->place[row];
    const pls_body_spin *w = &in->spin[row];
    pls_vec3 n = pls_wall_normal(&in->orientation[row], in->domain->dimension);
    return (wall_frame){.normal = {n.x, n.y, n.z},
                        .position = {p->x, p->y, p->z},
                        .inv_mass = in->load[row].inv_mass,
                        .velocity = {{p->vx, p->vy, p->vz}, {p->vx + w->lead_x, p->vy + w->lead_y, p->vz + p->lead_z}},
                        .spin = {{w->wx, w->wy, w->wz}, {w->end_x, w->end_y, w->end_z}}};
}

static void filter_walls(pls_pair_list *list, const pls_contact_input *in, const pls_pair_section *section, const pls_pair_block *block,
                         pls_contact_work *work, const wall_frame *wall)
{
    const double behind = -section->depth;
    for (size_t k = 0; k < block->count; k += 8)
    {
        size_t c = block->first + k;
        unsigned now = 0;
        for (int half = 0; half < 8; half += PLS_W)
        {
            pls_v4 row[PLS_W];
            for (int lane = 0; lane < PLS_W; ++lane) row[lane] = pls_v4_load(&in->place[list->row_i[c + (size_t)(half + lane)]].x);
            pls_vd d[4];
            pls_columns4(row, d);
            pls_vd height = wall->normal[0] * (d[0] - wall->position[0]) + wall->normal[1] * (d[1] - wall->position[1]) +
                            wall->normal[2] * (d[2] - wall->position[2]);
            now |= (pls_vd_less(height, d[3]) & pls_vd_less(pls_vd_set(behind), height)) << half;
        }
        note_touching(list, section, c, now & valid_lanes(block, k), work);
    }
}

static void load_walls(const pls_pair_list *list, const pls_contact_input *in, const pls_pair_section *section, pls_contact_work *work,
                       const wall_frame *wall)
{
    const double inward = in->laws->law[section->law].lever_at_surface ? 0.0 : 1.0;
    for (size_t k = 0; k < work->active_count; k += PLS_W)
    {
        pls_v8 place[PLS_W], turn[PLS_W];
        pls_v4 spring[PLS_W];
        pls_vd growth, inv_mass;
        for (int lane = 0; lane < PLS_W; ++lane)
        {
            size_t c = work->active[k + (size_t)lane];
            uint32_t i = list->row_i[c];
            place[lane] = pls_v8_load(&in->place[i].x);
            turn[lane] = pls_v8_load(&in->spin[i].wx);
            growth[lane] = in->before[i].growth;
            inv_mass[lane] = in->load[i].inv_mass;
            spring[lane] = pls_v4_load(list->history + section->history + (c - section->first) * (size_t)section->stride);
        }
        pls_vd d[8], w[8], s[4], x[3], arm[3], height = pls_vd_set(0.0);
        pls_columns8(place, d);
        pls_columns8(turn, w);
        pls_columns4(spring, s);
        for (int a = 0; a < 3; ++a)
        {
            x[a] = d[a] - wall->position[a];
            height = height + wall->normal[a] * x[a];
        }
        frame f;
        for (int a = 0; a < 3; ++a) f.n[a] = pls_vd_set(-wall->normal[a]), f.spring[a] = s[a];
        f.delta = d[3] - height;
        pls_vd lever = d[3] - (0.5 * inward) * f.delta;
        for (int a = 0; a < 3; ++a)
        {
            arm[a] = x[a] + lever * f.n[a]; // contact point from the wall's position
            pls_vd_store(&work->point[a][k], arm[a]);
        }
        const double *ww = wall->spin[0], *end = wall->spin[1];
        const pls_vd v_end[3] = {d[4] + w[3], d[5] + w[7], d[6] + d[7]};
        for (int a = 0; a < 3; ++a)
        {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            f.v[a] =
                v_end[a] + lever * (w[4 + b] * f.n[c] - w[4 + c] * f.n[b]) - (wall->velocity[1][a] + (end[b] * arm[c] - end[c] * arm[b]));
        }

        // Half a step back.
        double n[3];
        for (int a = 0; a < 3; ++a)
            n[a] = -wall->normal[a] +
                   0.5 * in->dt * (ww[(a + 1) % 3] * wall->normal[(a + 2) % 3] - ww[(a + 2) % 3] * wall->normal[(a + 1) % 3]);
        pls_vd old_x[3], old_arm[3], u[3];
        for (int a = 0; a < 3; ++a) old_x[a] = x[a] - (0.5 * in->dt) * (d[4 + a] - wall->velocity[0][a]);
        pls_vd old_radius = d[3] - growth;
        pls_vd old_lever = old_radius - (0.5 * inward) * (old_radius + (n[0] * old_x[0] + n[1] * old_x[1] + n[2] * old_x[2]));
        for (int a = 0; a < 3; ++a) old_arm[a] = old_x[a] + old_lever * n[a];
        for (int a = 0; a < 3; ++a)
        {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            u[a] = d[4 + a] + old_lever * (w[b] * n[c] - w[c] * n[b]) - (wall->velocity[0][a] + (ww[b] * old_arm[c] - ww[c] * old_arm[b]));
        }
        pls_vd along = u[0] * n[0] + u[1] * n[1] + u[2] * n[2];
        for (int a = 0; a < 3; ++a) f.u[a] = u[a] - along * n[a];
        f.spin = 0.5 * ((w[0] + ww[0]) * f.n[0] + (w[1] + ww[1]) * f.n[1] + (w[2] + ww[2]) * f.n[2]);
        set_frame(work, k, &f, in);
        pls_vd_store(&work->lever[k], lever);
        pls_vd_store(&work->effective_mass[k], 1.0 / (inv_mass + wall->inv_mass));
        pls_vd_store(&work->effective_radius[k], d[3]);
    }
}

static void store_walls(pls_pair_list *list, const pls_pair_section *section, pls_contact_work *work, int kept)
{
    for (size_t k = 0; k < work->active_count; k += PLS_W)
    {
        pls_vd n[3], ft[3], f[3], arm[3], fn = pls_vd_load(&work->normal_force[k]), lever = pls_vd_load(&work->lever[k]), first[8],
                                          second[8];
        for (int a = 0; a < 3; ++a)
        {
            n[a] = pls_vd_load(&work->normal[a][k]);
            ft[a] = pls_vd_load(&work->shear_force[a][k]);
            arm[a] = pls_vd_load(&work->point[a][k]);
            f[a] = ft[a] - fn * n[a];
        }
        for (int a = 0; a < 3; ++a)
        {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            first[a] = f[a];
            first[4 + a] = lever * (n[b] * ft[c] - n[c] * ft[b]); // (c - X_i) x F
            second[a] = arm[c] * f[b] - arm[b] * f[c];            // (c - X_j) x (-F)
            second[4 + a] = pls_vd_set(0.0);
        }
        first[3] = pls_vd_load(&work->damping_power[k]);
        first[7] = pls_vd_load(&work->slip_work[k]);
        second[3] = second[7] = pls_vd_set(0.0);
        double *row[PLS_W], *next[PLS_W];
        for (int lane = 0; lane < PLS_W; ++lane)
        {
            row[lane] = pls_wall_slot(list, work->active[k + (size_t)lane]);
            next[lane] = row[lane] + 8;
        }
        pls_rows8(first, row, lanes_left(work, k));
        pls_rows8(second, next, lanes_left(work, k));
        store_history(list, section, work, k, kept);
    }
}

// ---- the block --------------------------------------------------------------------------------------------------------------------------------------------

/// A contact that began in this step: its spring has had the time since touch only.
static void begin_springs(pls_contact_work *work, const pls_contact_input *in)
{
    for (size_t m = 0; m < work->fresh_count; ++m)
    {
        size_t k = work->fresh[m];
        double approach = work->normal_velocity[k] * in->dt; // of the whole step
        double part = approach > work->delta[k] ? work->delta[k] / approach : 1.0;
        for (int a = 0; a < 3; ++a) work->spring[a][k] = part * work->slip_step[a][k];
    }
}

static void load_law_history(const pls_pair_list *list, const pls_pair_section *section, pls_contact_work *work, int kept)
{
    for (size_t k = 0; k < (work->active_count + 7) / 8 * 8; ++k)
    {
        const double *row = list->history + section->history + (work->active[k] - section->first) * (size_t)section->stride;
        for (int h = 0; h < kept; ++h) work->history[h][k] = row[3 + h];
    }
}

static void apply_law(const pls_law *law, const pls_contact_input *in, pls_contact_work *work)
{
    pls_law_batch batch = {
        .count = (work->active_count + 7) / 8 * 8,
        .dt = in->dt,
        .constants = law->constants,
        .delta = work->delta,
        .normal_velocity = work->normal_velocity,
        .slip_velocity_x = work->slip_velocity[0],
        .slip_velocity_y = work->slip_velocity[1],
        .slip_velocity_z = work->slip_velocity[2],
        .effective_radius = work->effective_radius,
        .effective_mass = work->effective_mass,
        .spring_x = work->spring[0],
        .spring_y = work->spring[1],
        .spring_z = work->spring[2],
        .normal_force = work->normal_force,
        .shear_force_x = work->shear_force[0],
        .shear_force_y = work->shear_force[1],
        .shear_force_z = work->shear_force[2],
        .damping_power = work->damping_power,
        .slip_work = work->slip_work,
    };
    for (int h = 0; h < PLS_LAW_MAX_HISTORY; ++h) batch.history[h] = work->history[h];
    law->ops->evaluate(&batch);
}

void PLS_SIMD(pls_contact_block)(pls_pair_list *list, const pls_contact_input *in, const pls_pair_block *block, pls_contact_work *work)
{
    const pls_pair_section *section = &list->section[block->section];
    const pls_law *law = &in->laws->law[section->law];
    int kept = law->ops->history;
    wall_frame wall = {0};
    work->active_count = work->fresh_count = 0;
    if (in->large) fetch_ahead(list, in, block + 1);
    if (section->wall)
    {
        wall = wall_of(in, section->wall_row);
        filter_walls(list, in, section, block, work, &wall);
    }
    else if (in->domain->any_periodic)
        filter_pairs(list, in, section, block, work, 1);
    else
        filter_pairs(list, in, section, block, work, 0);
    if (work->active_count == 0) return;
    for (size_t k = work->active_count; k % 8 != 0; ++k)
        work->active[k] = work->active[work->active_count - 1]; // padding repeats a contact

    if (section->wall)
        load_walls(list, in, section, work, &wall);
    else
    {
        if (in->domain->any_periodic)
            load_pairs(list, in, section, work, 1, in->growing);
        else if (in->growing)
            load_pairs(list, in, section, work, 0, 1);
        else
            load_pairs(list, in, section, work, 0, 0);
        if (in->growing)
            frame_pairs(in, section, work, 1);
        else
            frame_pairs(in, section, work, 0);
        if (law->ops->needs_effective) load_effective(list, in, work);
    }
    if (kept > 0) load_law_history(list, section, work, kept);
    begin_springs(work, in);
    apply_law(law, in, work);
    if (section->wall)
        store_walls(list, section, work, kept);
    else
        store_pairs(list, section, work, kept);
}
