// sphere_contact_simd.c -- the hot loop: one block of candidates at a time, as short loops over arrays that stay in the first-level cache.
//
// Two ways to the same bits. Where at least a quarter of a block touched at the last step and the law is linear, whole vectors of the list are worked on, in parts that
// hand their results on in arrays (pairs of spheres: as on a conveyor, see `work_whole`; walls: part after part):
//
//     load     rows of both bodies to columns over candidates
//     measure  distance, normal, overlap, and which touch
//     carry    relative velocities at the contact point; the spring carried into the contact frame of now
//     try      the law, had nothing slid
//     factor   what the trial is multiplied by to lie in the cone: a root and a division
//     settle   sliding; the spring back to its history where the pair touches, force and torque into the candidate's own slot
//
// Else touching candidates are picked first and any law asked through its door:
//
//     filter   which candidates touch (positions and radii only), and which of them touch for the first time
//     load, measure, carry   as above
//     law      forces from overlap, velocity and spring (the user's door)
//     store    as above
//
// Body rows are loaded whole and transposed in registers. Everything is lane by lane, so neither width nor way shows in the bits.
//
// Contact point (P1 section 3.1): c = (x1 + x2)/2, at d/2 + (r_i - r_j)/2 from X_i and d/2 - (r_i - r_j)/2 from X_j, so the relative velocity at this one
// point is v_i - v_j + (d/2 (w_i + w_j) + (r_i - r_j)/2 (w_i - w_j)) x n, and the torques are (1 +- (r_i - r_j)/d) d/2 n x F. On request
// (`lever_at_surface`) velocities are those of the surface points x1 and x2, (r_i + r_j)/2 in place of d/2, as in P1 eq. 15b and LAMMPS; torques between
// grains then still act at c, so that angular momentum is kept, but a pair turning as one rigid body slips by |w| delta and work and torque do not match.
//
// The spring. s' = v_t is integrated by the midpoint rule: s += dt u_t, with u the velocities of the middle of the step, which Verlet has exactly, and normal and
// levers of the middle, half a step back. (The velocity that dashpots see would do for the order, but lags: it feeds energy to springs of undamped contacts, step
// after step.) The old spring is carried along with the contact frame: projected on the new tangent plane with its length kept and turned about n by the
// angle of the pair's mean spin; the new piece by half of it. A contact that begins within the step has had min(dt, delta/v_n) of it.

#include "contact/sphere_contact.h"
#include "law/linear_lanes.h"

#include <string.h>

enum {
    FETCH_AHEAD = 48,                    ///< candidates of sparse blocks and walls; within PLS_PAIR_REACH
    LISTS_AHEAD = 4 * PLS_CONTACT_BLOCK, ///< candidates by which the list itself is fetched ahead in vast worlds
    WHOLE_FROM = 4,                      ///< sixteenths of a block that must have touched at the last step for whole vectors to be quicker
};

static inline pls_v4 flip_first_three(pls_v4 a) { return (pls_v4)((pls_v4i)a ^ (pls_v4i){INT64_MIN, INT64_MIN, INT64_MIN, 0}); }

/// Signs to flip.
static const pls_v4i none = {0, 0, 0, 0}, fourth = {0, 0, 0, INT64_MIN};

/// X_j - X_i, r_i + r_j | u_j - u_i, lead_z of j less i, from two rows.
static inline pls_row pair_row(const pls_body_place *i, const pls_body_place *j, int plain)
{
    if (plain) return pls_row_subtract(pls_row_load(&j->x), pls_row_load(&i->x)); // no radii needed
    return pls_row_subtract(pls_row_load(&j->x), pls_row_flip(pls_row_load(&i->x), fourth, none));
}

/// w_i + w_j in the middle, lead_x of j less i | the same sum at the end, lead_y of j less i.
static inline pls_row sum_row(const pls_body_spin *i, const pls_body_spin *j)
{
    return pls_row_add(pls_row_load(&j->wx), pls_row_flip(pls_row_load(&i->wx), fourth, fourth));
}

/// (r_i - r_j)/2 (w_i - w_j), in the middle and at the end.
static inline pls_row skew_row(const pls_contact_input *in, uint32_t i, uint32_t j)
{
    double end = 0.5 * (in->place[i].radius - in->place[j].radius), middle = end;
    if (in->growing) middle = end - 0.5 * ((double)in->before[i].growth - (double)in->before[j].growth);
    return pls_row_scale(pls_row_subtract(pls_row_load(&in->spin[i].wx), pls_row_load(&in->spin[j].wx)), pls_v4_set(middle),
                         pls_v4_set(end));
}

static inline pls_v4 image_shift(const pls_pair_list *list, size_t c, pls_v4 edge)
{
    const int16_t *s = list->shift[c];
    return (pls_v4){s[0], s[1], s[2], 0.0} * edge;
}

static inline unsigned valid_lanes(const pls_pair_block *block, size_t k)
{
    return block->count - k >= 8 ? 0xffu : (1u << (block->count - k)) - 1;
}

// ---- which touch ----------------------------------------------------------------------------------------------------------------------------------------

/// Contacts begin or end, seldom: rows that list touching contacts are stale, and what begins remembers nothing.
static __attribute__((noinline)) void note_change(pls_pair_list *list, const pls_pair_section *section, size_t c, unsigned changed,
                                                  unsigned fresh)
{
    for (; changed && !section->wall; changed &= changed - 1)
    {
        size_t m = c + (size_t)__builtin_ctz(changed);
        __atomic_store_n(pls_near_row(list, list->row_i[m]), PLS_NEAR_STALE, __ATOMIC_RELAXED); // two threads may say the same
        __atomic_store_n(pls_near_row(list, list->row_j[m]), PLS_NEAR_STALE, __ATOMIC_RELAXED);
    }
    for (; fresh; fresh &= fresh - 1)
    {
        double *history = pls_pair_history(list, section, c + (size_t)__builtin_ctz(fresh));
        for (int h = 0; h < section->numbers; ++h) history[8 * h] = 0.0;
    }
}

/// Note that of candidates c .. c + 7 those of `now` touch; returns those that did not touch before.
static inline __attribute__((always_inline)) unsigned note_touching(pls_pair_list *list, const pls_pair_section *section, size_t c,
                                                                    unsigned now)
{
    unsigned before = list->touch[c >> 3];
    if (now == before && list->ended[c >> 3] == 0)
        return 0; // and write nothing: blocks of another thread may have their bytes in the same cache line
    list->touch[c >> 3] = (uint8_t)now;
    list->ended[c >> 3] = (uint8_t)(before & ~now);
    if (now != before) note_change(list, section, c, now ^ before, now & ~before);
    return now & ~before;
}

/// Pick the touching lanes of candidates c .. c + 7.
static inline void pick_touching(pls_pair_list *list, const pls_pair_section *section, size_t c, unsigned now, pls_contact_work *work)
{
    for (unsigned fresh = note_touching(list, section, c, now); fresh; fresh &= fresh - 1) // seldom
    {
        unsigned lane = (unsigned)__builtin_ctz(fresh);
        size_t k = work->active_count + (size_t)__builtin_popcount(now & ((1u << lane) - 1));
        work->fresh[k >> 3] = (uint8_t)(work->fresh[k >> 3] | 1u << (k & 7));
    }
    // No branch on which lanes touch: all eight places are written, the next eight overwrite what is too many.
    uint32_t *active = work->active + work->active_count;
    const uint8_t *lane = pls_packed_lanes[now];
    for (int k = 0; k < 8; ++k) active[k] = (uint32_t)c + lane[k];
    work->active_count += (size_t)__builtin_popcount(now);
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
            now |= pls_vd_less(pls_vd_dot(d, d), d[3] * d[3]) << half;
        }
        pick_touching(list, section, c, now & valid_lanes(block, k) & pls_pair_free_lanes(list, c), work);
    }
}

// ---- load -------------------------------------------------------------------------------------------------------------------------------------------------

// What a block of whole vectors needs is fetched into the cache by the block before it in the list, a little in each turn of its longest loops, so that the memory works while
// the processor computes. Asked for at once, when a block is loaded, the same lines keep the loads of that loop waiting: 18 % of a step at 300,000 bodies. (Springs and slots are asked for there too, to be written: in small worlds, where nobody
// fetched them before, and in vast ones, where some have gone again.)

/// Springs and slots of candidates c .. ; `now`: they are about to be written.
static inline __attribute__((always_inline)) void fetch_slots(const pls_pair_list *list, const pls_pair_section *section, size_t c, int now)
{
    const double *history = pls_pair_history(list, section, c), *slot = list->live + pls_live_slot(list, c) * PLS_SLOT;
    for (int a = 0; a < 3; ++a) now ? __builtin_prefetch(history + 8 * a, 1) : __builtin_prefetch(history + 8 * a);
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane)
        now ? __builtin_prefetch(slot + lane * PLS_SLOT, 1) : __builtin_prefetch(slot + lane * PLS_SLOT);
}

/// A turn's part of the bodies that the next block needs.
static inline __attribute__((always_inline)) void fetch_bodies(const pls_contact_input *in, const uint32_t *row, size_t count)
{
    for (size_t k = 0; k < count; ++k)
    {
        __builtin_prefetch(&in->place[row[k]]);
        __builtin_prefetch(&in->spin[row[k]]);
    }
}

/// What the end of the step needs of the lower bodies of candidates c .. , into the second-level cache.
static inline __attribute__((always_inline)) void fetch_ends(const pls_pair_list *list, const pls_contact_input *in, size_t c)
{
    for (size_t k = c; k < c + 8; k += 4)
    {
        uint32_t lower = pls_pair_lower_row(list, k);
        __builtin_prefetch(&in->load[lower], 0, 2);
        __builtin_prefetch(&in->before[lower], 0, 2);
        __builtin_prefetch(&in->orientation[lower], 0, 2);
    }
}

/// The list itself passes once, in a dozen of streams of which some come to a line per block: too slow to be noticed by the processor, and each line that is missing when what it tells
/// is to be fetched holds up all. A turn's part, and what comes once per block. (What is fetched need not be there.)
static inline __attribute__((always_inline)) void fetch_rows_of_list(const pls_pair_list *list, size_t c)
{
    __builtin_prefetch(&list->row_i[c + LISTS_AHEAD]);
    __builtin_prefetch(&list->row_j[c + LISTS_AHEAD]);
}
static inline __attribute__((always_inline)) void fetch_list(const pls_pair_list *list, const pls_pair_block *block, const uint32_t *coming)
{
    const size_t number = (size_t)(block - list->block);
    __builtin_prefetch(&list->place[(block->first + LISTS_AHEAD) / 8]);
    __builtin_prefetch(&list->touch[(block->first + 2 * LISTS_AHEAD) / 8]);
    __builtin_prefetch(&list->ended[(block->first + 2 * LISTS_AHEAD) / 8]);
    __builtin_prefetch(&list->block[number + 8]);
    __builtin_prefetch(&list->fetch_start[number + 16]);
    for (size_t k = 64; k < 128; k += 16) __builtin_prefetch(coming + k);
}

/// Rows of both bodies to columns over contacts: of candidates k .. of the block (`whole`), or of the picked contacts k .. ; to place m of the arrays.
/// `plain`: no periodic box, equal radii that stay.
static inline __attribute__((always_inline)) void load_lanes(const pls_pair_list *list, const pls_contact_input *in, size_t first, size_t k,
                                                             size_t m, pls_contact_work *work, int whole, int plain)
{
    const int periodic = !plain && in->domain->any_periodic, growing = !plain && in->growing, skewed = !plain && !list->equal_radii;
    const pls_v4 edge = {in->domain->edge[0], in->domain->edge[1], in->domain->edge[2], 0.0};
    const pls_v4 edge_rate = {in->domain->edge_rate[0], in->domain->edge_rate[1], in->domain->edge_rate[2], 0.0};
    pls_row place[PLS_W], sum[PLS_W], skew[PLS_W];
    pls_vd growth = pls_vd_set(0.0);
#pragma GCC unroll 8
    for (int lane = 0; lane < PLS_W; ++lane)
    {
        size_t c = whole ? first + k + (size_t)lane : work->active[k + (size_t)lane];
        uint32_t i = list->row_i[c], j = list->row_j[c];
        place[lane] = pair_row(&in->place[i], &in->place[j], plain);
        if (periodic) place[lane] = pls_row_add(place[lane], pls_row_join(image_shift(list, c, edge), image_shift(list, c, edge_rate)));
        sum[lane] = sum_row(&in->spin[i], &in->spin[j]);
        if (skewed) skew[lane] = skew_row(in, i, j);
        if (growing) growth[lane] = (double)in->before[i].growth + (double)in->before[j].growth;
    }
    pls_vd d[8], q[8];
    pls_columns8(place, d);
    pls_columns8(sum, q);
    for (int a = 0; a < 3; ++a)
    {
        pls_vd_store(&work->normal[a][m], d[a]);
        pls_vd_store(&work->velocity[a][m], d[4 + a]);
        pls_vd_store(&work->spin[a][m], q[a]);
        pls_vd_store(&work->spin_end[a][m], q[4 + a]);
    }
    if (!plain) pls_vd_store(&work->delta[m], d[3]);
    pls_vd_store(&work->slip_velocity[0][m], d[4] + q[3]);
    pls_vd_store(&work->slip_velocity[1][m], d[5] + q[7]);
    pls_vd_store(&work->slip_velocity[2][m], d[6] + d[7]);
    if (growing) pls_vd_store(&work->growth[m], growth);
    if (skewed)
    {
        pls_vd w[8];
        pls_columns8(skew, w);
        for (int a = 0; a < 3; ++a)
        {
            pls_vd_store(&work->skew[a][m], w[a]);
            pls_vd_store(&work->skew_end[a][m], w[4 + a]);
        }
    }
}

/// Distance, normal and overlap; returns which overlap.
static inline __attribute__((always_inline)) unsigned measure_lanes(pls_contact_work *work, size_t m, double both_radii, int plain)
{
    const pls_vd d[3] = {pls_vd_load(&work->normal[0][m]), pls_vd_load(&work->normal[1][m]), pls_vd_load(&work->normal[2][m])};
    pls_vd radii = plain ? pls_vd_set(both_radii) : pls_vd_load(&work->delta[m]), square = pls_vd_dot(d, d), distance = pls_vd_sqrt(square),
           inv = 1.0 / distance;
    for (int a = 0; a < 3; ++a) pls_vd_store(&work->normal[a][m], d[a] * inv);
    pls_vd_store(&work->delta[m], radii - distance);
    pls_vd_store(&work->distance[m], distance);
    pls_vd_store(&work->inv_distance[m], inv);
    return pls_vd_less(square, radii * radii);
}

// ---- frame ------------------------------------------------------------------------------------------------------------------------------------------------

/// 1 where velocities are those of the surface points, 0 where they are those of the contact point.
static inline double surface_of(const pls_law *law) { return law->lever_at_surface ? 1.0 : 0.0; }

/// Cosine and sine of the angle by which a contact turns in a step, far less than a radian: series.
static inline __attribute__((always_inline)) void turn_of(pls_vd angle, pls_vd *cosine, pls_vd *sine)
{
    const pls_vd square = angle * angle, one = pls_vd_set(1.0);
    *cosine = pls_vd_less_product(square, pls_vd_less_product(square, pls_vd_set(1.0 / 24.0), pls_vd_set(0.5)), one);
    *sine = angle * pls_vd_less_product(square, pls_vd_less_product(square, pls_vd_set(1.0 / 120.0), pls_vd_set(1.0 / 6.0)), one);
}

/// Carry a spring along with the contact frame, whose normal comes to n from n - 2 tilt in the step while the frame turns by `angle` about it, and add the step's
/// displacement. The rotation that takes the old normal to n takes s, at right angles to the old one, to s - (s . n) (n - tilt) up to fourth order.
static inline __attribute__((always_inline)) void carry_spring(pls_vd spring[3], const pls_vd n[3], const pls_vd tilt[3], pls_vd angle,
                                                               const pls_vd step[3])
{
    pls_vd turning[3], t[3], sn = pls_vd_dot(spring, n), ahead = 0.5 * angle, cosine, sine;
    turn_of(angle, &cosine, &sine);
    for (int a = 0; a < 3; ++a)
    {
        t[a] = pls_vd_less_product(sn, n[a] - tilt[a], spring[a]);
        turning[a] = pls_vd_fma(sine, t[a], ahead * step[a]);
    }
    for (int a = 0; a < 3; ++a) spring[a] = pls_vd_cross_plus(n, turning, a, pls_vd_fma(cosine, t[a], step[a]));
}

/// A contact that began in this step: its spring has had the time since touch only. Seldom.
static inline void begin_springs(const pls_contact_work *work, size_t k, double dt, unsigned fresh, const pls_vd step[3], pls_vd spring[3])
{
    pls_vd delta = pls_vd_load(&work->delta[k]), approach = pls_vd_load(&work->normal_velocity[k]) * dt; // of the whole step
    pls_vd since = pls_vd_pick((pls_vi)(approach > delta), delta / approach, pls_vd_set(1.0));
    for (int a = 0; a < 3; ++a) spring[a] = pls_vd_choose(pls_vm_of(fresh), since * step[a], spring[a]);
}

static inline unsigned fresh_lanes(const pls_contact_work *work, size_t k)
{
    return ((unsigned)work->fresh[k >> 3] >> (k & 7)) & ((1u << PLS_W) - 1);
}

/// Velocities at the contact point at the end of the step, and springs as they would be now had they not slid. Stored ones are in the list's history (`whole`)
/// or in `spring` already.
///
/// With q = u_j - u_i and k = dt/(2 d), half a step back the normal was n - k q_t and the distance d (1 - k q_n). The midpoint's tangential velocity, taken along
/// with the frame's tilt to now, is (L sum + k (L sum . n) q_t) x n - (1 + k q_n) q_t up to second order in k q, L and sum of the middle. The tilt of the whole
/// step is that from n - p_t (1 + p_n), p = dt/d q; it takes the spring s, at right angles to the old normal, to s_t + e q_t, e = (s . n) k (1 + 2 k q_n), up to
/// fourth order. The frame has turned about n by a = dt/2 sum . n, and the step's displacement by half of it. All together, with G = dt L sum, f = k G . n and
/// D = dt (1 + k q_n):
///
///     s <- [s cos a + (e cos a + f a/2 - D) q + G a/2]_t + n x [s sin a + (e sin a - f - D a/2) q - G]
static inline __attribute__((always_inline)) void carry_lanes(const pls_pair_list *list, const pls_contact_input *in, double surface,
                                                              const double *spring, size_t stride, unsigned fresh, size_t m,
                                                              pls_contact_work *work, int plain)
{
    const int growing = !plain && in->growing, skewed = !plain && !list->equal_radii;
    const double dt = in->dt, half_dt = 0.5 * dt;
    pls_vd n[3], end[3], arm[3], q[3], sum[3], s[3], distance = pls_vd_load(&work->distance[m]);
    for (int a = 0; a < 3; ++a)
    {
        n[a] = pls_vd_load(&work->normal[a][m]);
        end[a] = pls_vd_load(&work->slip_velocity[a][m]);
        q[a] = pls_vd_load(&work->velocity[a][m]);
        sum[a] = pls_vd_load(&work->spin[a][m]);
        s[a] = pls_vd_load(spring + (size_t)a * stride);
    }
    pls_vd qn = pls_vd_dot(q, n), spin = pls_vd_dot(sum, n), sn = pls_vd_dot(s, n), en = pls_vd_dot(end, n);
    pls_vd ratio = half_dt * pls_vd_load(&work->inv_distance[m]), less = ratio * qn;
    pls_vd lever = 0.5 * distance, reach = half_dt * pls_vd_less_product(pls_vd_set(half_dt), qn, distance);
    if (surface != 0.0)
    {
        lever = 0.5 * (distance + pls_vd_load(&work->delta[m]));
        reach = dt * lever;
        if (growing) reach = reach - half_dt * pls_vd_load(&work->growth[m]);
    }

    for (int a = 0; a < 3; ++a)
    {
        arm[a] = lever * pls_vd_load(&work->spin_end[a][m]);
        if (skewed) arm[a] = arm[a] + pls_vd_load(&work->skew_end[a][m]);
    }
    for (int a = 0; a < 3; ++a) pls_vd_store(&work->slip_velocity[a][m], pls_vd_fma(en, n[a], pls_vd_cross_plus(arm, n, a, -end[a])));
    pls_vd_store(&work->normal_velocity[m], -en);

    pls_vd angle = half_dt * spin, half = (0.5 * half_dt) * spin, cosine, sine;
    turn_of(angle, &cosine, &sine);
    pls_vd drift = pls_vd_fma(pls_vd_set(dt), less, pls_vd_set(dt)), lean = sn * pls_vd_fma(ratio + ratio, less, ratio);
    pls_vd turning[3], g[3];
    for (int a = 0; a < 3; ++a)
    {
        g[a] = reach * sum[a];
        if (skewed) g[a] = pls_vd_fma(pls_vd_set(dt), pls_vd_load(&work->skew[a][m]), g[a]);
    }
    pls_vd gn = skewed ? pls_vd_dot(g, n) : reach * spin, lift = ratio * gn;
    pls_vd along = pls_vd_fma(lean, cosine, pls_vd_product_less(lift, half, drift)),
           across = pls_vd_product_less(lean, sine, pls_vd_fma(drift, half, lift));
    pls_vd normal = pls_vd_fma(cosine, sn, pls_vd_fma(along, qn, half * gn));
    for (int a = 0; a < 3; ++a) turning[a] = pls_vd_fma(sine, s[a], pls_vd_product_less(across, q[a], g[a]));
    for (int a = 0; a < 3; ++a)
        s[a] = pls_vd_cross_plus(n, turning, a,
                                 pls_vd_fma(cosine, s[a], pls_vd_fma(along, q[a], pls_vd_product_less(half, g[a], normal * n[a]))));
    if (fresh) begin_springs(work, m, dt, fresh, s, s);
    for (int a = 0; a < 3; ++a) pls_vd_store(&work->spring[a][m], s[a]);
}

// ---- law ------------------------------------------------------------------------------------------------------------------------------------------------

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

/// Springs and the law's own numbers of the picked contacts.
static void load_history(const pls_pair_list *list, const pls_pair_section *section, pls_contact_work *work)
{
    for (size_t k = 0; k < (work->active_count + 7) / 8 * 8; ++k)
    {
        const double *history = pls_pair_history(list, section, work->active[k]);
        for (int a = 0; a < 3; ++a) work->spring[a][k] = history[8 * a];
        for (int h = 3; h < section->numbers; ++h) work->history[h - 3][k] = history[8 * h];
    }
}

static void store_history(const pls_pair_list *list, const pls_pair_section *section, const pls_contact_work *work)
{
    for (size_t k = 0; k < work->active_count; ++k)
    {
        double *history = pls_pair_history(list, section, work->active[k]);
        for (int a = 0; a < 3; ++a) history[8 * a] = work->spring[a][k];
        for (int h = 3; h < section->numbers; ++h) history[8 * h] = work->history[h - 3][k];
    }
}

// ---- store ------------------------------------------------------------------------------------------------------------------------------------------------

static inline int lanes_left(const pls_contact_work *work, size_t k)
{
    return work->active_count - k < PLS_W ? (int)(work->active_count - k) : PLS_W;
}

/// Force on i, power, d/2 n x F and work of contacts k .. into `row`s, their slots. What lies in the slots of candidates that do not touch is never read.
static inline __attribute__((always_inline)) void store_lanes(const pls_contact_work *work, size_t k, const pls_vd shear[3],
                                                              pls_vd slip_work, double *const *row, int lanes)
{
    pls_vd n[3], lever[3], column[8], half = 0.5 * pls_vd_load(&work->distance[k]), normal = pls_vd_load(&work->normal_force[k]);
    for (int a = 0; a < 3; ++a) n[a] = pls_vd_load(&work->normal[a][k]), lever[a] = half * n[a];
    for (int a = 0; a < 3; ++a)
    {
        column[a] = pls_vd_less_product(normal, n[a], shear[a]);
        column[4 + a] = pls_vd_cross(lever, shear, a);
    }
    column[3] = pls_vd_load(&work->damping_power[k]);
    column[7] = slip_work;
    pls_rows8(column, row, lanes);
}

/// Forces of candidates c .. c + count, within eight, stay to be looked at after the step.
static void keep_slots(const pls_pair_list *list, size_t c, size_t count)
{
    memcpy(list->slot + c * PLS_SLOT, list->live + pls_live_slot(list, c) * PLS_SLOT, count * PLS_SLOT * sizeof *list->slot);
}

static inline void store_skew(const pls_pair_list *list, const pls_contact_input *in, size_t c, double inv_distance)
{
    list->skew[pls_live_slot(list, c)] = (in->place[list->row_i[c]].radius - in->place[list->row_j[c]].radius) * inv_distance;
}

/// The linear law on place m of the arrays, first part: forces had nothing slid.
static inline __attribute__((always_inline)) void try_lanes(const pls_linear_values *law, pls_contact_work *work, size_t m)
{
    pls_linear_trial t;
    pls_vd v[3], s[3];
    for (int a = 0; a < 3; ++a)
    {
        v[a] = pls_vd_load(&work->slip_velocity[a][m]);
        s[a] = pls_vd_load(&work->spring[a][m]);
    }
    pls_linear_try(law, pls_vd_load(&work->delta[m]), pls_vd_load(&work->normal_velocity[m]), v, s, &t);
    for (int a = 0; a < 3; ++a) pls_vd_store(&work->shear_force[a][m], t.shear[a]);
    pls_vd_store(&work->normal_force[m], t.normal_force);
    pls_vd_store(&work->damping_power[m], t.damping_power);
    pls_vd_store(&work->square[m], t.shear_square);
    pls_vd_store(&work->cone[m], t.cone);
}

static inline __attribute__((always_inline)) void factor_lanes(pls_contact_work *work, size_t m)
{
    pls_vd_store(&work->cone[m], pls_linear_factor(pls_vd_load(&work->square[m]), pls_vd_load(&work->cone[m])));
}

/// Last part: sliding; springs of lanes that touch go back to their history. Gives the shear force on i, returns the work of sliding.
static inline __attribute__((always_inline)) pls_vd settle_lanes(const pls_linear_values *law, pls_vm touching, double *history, size_t m,
                                                                 const pls_contact_work *work, pls_vd shear[3])
{
    pls_vd v[3], spring[3];
    for (int a = 0; a < 3; ++a)
    {
        v[a] = pls_vd_load(&work->slip_velocity[a][m]);
        spring[a] = pls_vd_load(&work->spring[a][m]);
        shear[a] = pls_vd_load(&work->shear_force[a][m]);
    }
    pls_vd slip_work = pls_linear_settle(law, pls_vd_load(&work->cone[m]), pls_vd_load(&work->square[m]), v, shear, spring);
    for (int a = 0; a < 3; ++a) pls_vd_store_where(touching, history + 8 * a, spring[a]);
    return slip_work;
}

/// What any law answered for the picked contacts.
static void store_pairs(const pls_pair_list *list, const pls_contact_input *in, const pls_contact_work *work)
{
    for (size_t k = 0; k < work->active_count; k += PLS_W)
    {
        const int lanes = lanes_left(work, k);
        double *row[PLS_W];
        for (int lane = 0; lane < PLS_W; ++lane) row[lane] = list->live + pls_live_slot(list, work->active[k + (size_t)lane]) * PLS_SLOT;
        pls_vd shear[3];
        for (int a = 0; a < 3; ++a) shear[a] = pls_vd_load(&work->shear_force[a][k]);
        store_lanes(work, k, shear, pls_vd_load(&work->slip_work[k]), row, lanes);
        for (int lane = 0; !list->equal_radii && lane < lanes; ++lane)
            store_skew(list, in, work->active[k + (size_t)lane], work->inv_distance[k + (size_t)lane]);
        for (int lane = 0; in->kept && list->alone && lane < lanes; ++lane) keep_slots(list, work->active[k + (size_t)lane], 1);
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

/// Which of candidates k .. k + 7 of the block touch.
static inline __attribute__((always_inline)) unsigned walls_touching(const pls_pair_list *list, const pls_contact_input *in,
                                                                     const pls_pair_section *section, const pls_pair_block *block, size_t k,
                                                                     const wall_frame *wall)
{
    const size_t c = block->first + k;
    const double behind = -section->depth;
    unsigned now = 0;
    for (int lane = 0; in->large && lane < 8; ++lane) // bodies at a wall lie far apart in memory
    {
        uint32_t row = list->row_i[c + FETCH_AHEAD + (size_t)lane];
        __builtin_prefetch(&in->place[row]);
        __builtin_prefetch(&in->spin[row]);
        __builtin_prefetch(&in->load[row]);
        __builtin_prefetch(&in->before[row]);
    }
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
    return now & valid_lanes(block, k);
}

/// Candidates first + k .. (`whole`) or picked contacts k .. , as far as the law; `old`: their springs.
static inline __attribute__((always_inline)) void frame_walls(const pls_pair_list *list, const pls_contact_input *in,
                                                              const pls_pair_section *section, const wall_frame *wall, size_t first,
                                                              size_t k, const double *old, size_t stride, int whole, pls_contact_work *work)
{
    const double inward = in->laws->law[section->law].lever_at_surface ? 0.0 : 1.0;
    pls_row place[PLS_W], turn[PLS_W];
    pls_vd growth, inv_mass;
    for (int lane = 0; lane < PLS_W; ++lane)
    {
        size_t c = whole ? first + k + (size_t)lane : work->active[k + (size_t)lane];
        uint32_t i = list->row_i[c];
        place[lane] = pls_row_load(&in->place[i].x);
        turn[lane] = pls_row_load(&in->spin[i].wx);
        growth[lane] = in->before[i].growth;
        inv_mass[lane] = in->load[i].inv_mass;
    }
    pls_vd d[8], w[8], x[3], arm[3], height = pls_vd_set(0.0);
    pls_columns8(place, d);
    pls_columns8(turn, w);
    for (int a = 0; a < 3; ++a)
    {
        x[a] = d[a] - wall->position[a];
        height = height + wall->normal[a] * x[a];
    }
    pls_vd now[3], v[3], delta = d[3] - height, lever = d[3] - (0.5 * inward) * delta;
    for (int a = 0; a < 3; ++a) now[a] = pls_vd_set(-wall->normal[a]);
    for (int a = 0; a < 3; ++a)
    {
        arm[a] = x[a] + lever * now[a]; // contact point from the wall's position
        pls_vd_store(&work->point[a][k], arm[a]);
    }
    const double *ww = wall->spin[0], *end = wall->spin[1];
    const pls_vd v_end[3] = {d[4] + w[3], d[5] + w[7], d[6] + d[7]};
    for (int a = 0; a < 3; ++a)
    {
        int b = (a + 1) % 3, c = (a + 2) % 3;
        v[a] = v_end[a] + lever * (w[4 + b] * now[c] - w[4 + c] * now[b]) - (wall->velocity[1][a] + (end[b] * arm[c] - end[c] * arm[b]));
    }

    // Half a step back.
    double n[3];
    for (int a = 0; a < 3; ++a)
        n[a] =
            -wall->normal[a] + 0.5 * in->dt * (ww[(a + 1) % 3] * wall->normal[(a + 2) % 3] - ww[(a + 2) % 3] * wall->normal[(a + 1) % 3]);
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
    pls_vd vn = pls_vd_dot(v, now), along = u[0] * n[0] + u[1] * n[1] + u[2] * n[2];
    for (int a = 0; a < 3; ++a) u[a] = u[a] - along * n[a];
    pls_vd un = pls_vd_dot(u, now); // small: the frame has turned since
    pls_vd step[3], spring[3], tilt[3];
    for (int a = 0; a < 3; ++a)
    {
        step[a] = in->dt * (u[a] - un * now[a]);
        tilt[a] = now[a] - n[a];
        spring[a] = pls_vd_load(old + (size_t)a * stride);
        pls_vd_store(&work->normal[a][k], now[a]);
        pls_vd_store(&work->slip_velocity[a][k], v[a] - vn * now[a]);
    }
    pls_vd_store(&work->delta[k], delta);
    pls_vd_store(&work->normal_velocity[k], vn);
    carry_spring(spring, now, tilt, (0.5 * in->dt) * ((w[0] + ww[0]) * now[0] + (w[1] + ww[1]) * now[1] + (w[2] + ww[2]) * now[2]), step);
    if (fresh_lanes(work, k)) begin_springs(work, k, in->dt, fresh_lanes(work, k), step, spring);
    for (int a = 0; a < 3; ++a) pls_vd_store(&work->spring[a][k], spring[a]);
    pls_vd_store(&work->lever[k], lever);
    if (whole) return; // the linear law does not ask
    pls_vd_store(&work->effective_mass[k], 1.0 / (inv_mass + wall->inv_mass));
    pls_vd_store(&work->effective_radius[k], d[3]);
}

/// Force, power, torque and work for the body and for the wall into the slots of `candidate`s.
static inline __attribute__((always_inline)) void store_walls(const pls_pair_list *list, const pls_contact_work *work, size_t k,
                                                              const pls_vd shear[3], pls_vd slip_work, const size_t candidate[PLS_W],
                                                              int lanes)
{
    pls_vd n[3], f[3], arm[3], fn = pls_vd_load(&work->normal_force[k]), lever = pls_vd_load(&work->lever[k]), first[8], second[8];
    for (int a = 0; a < 3; ++a)
    {
        n[a] = pls_vd_load(&work->normal[a][k]);
        arm[a] = pls_vd_load(&work->point[a][k]);
        f[a] = shear[a] - fn * n[a];
    }
    for (int a = 0; a < 3; ++a)
    {
        int b = (a + 1) % 3, c = (a + 2) % 3;
        first[a] = f[a];
        first[4 + a] = lever * (n[b] * shear[c] - n[c] * shear[b]); // (c - X_i) x F
        second[a] = -f[a];
        second[4 + a] = arm[c] * f[b] - arm[b] * f[c]; // (c - X_j) x (-F)
    }
    first[3] = second[3] = pls_vd_load(&work->damping_power[k]);
    first[7] = second[7] = slip_work;
    double *row[PLS_W], *next[PLS_W];
    for (int lane = 0; lane < PLS_W; ++lane)
    {
        row[lane] = pls_wall_slot(list, candidate[lane]);
        next[lane] = row[lane] + 8;
    }
    pls_rows8(first, row, lanes);
    pls_rows8(second, next, lanes);
}

/// All candidates of a block of walls, the linear law. Walls are few, so plain loops do.
static void work_whole_walls(pls_pair_list *list, const pls_contact_input *in, const pls_pair_section *section, const pls_pair_block *block,
                             pls_contact_work *work)
{
    const wall_frame wall = wall_of(in, section->wall_row);
    const pls_linear_values law = pls_linear_take(in->laws->law[section->law].constants, in->dt);
    for (size_t k = 0; k < block->count; k += 8)
    {
        unsigned now = walls_touching(list, in, section, block, k, &wall);
        work->now[k >> 3] = (uint8_t)now;
        work->fresh[k >> 3] = (uint8_t)note_touching(list, section, block->first + k, now);
    }
    const size_t count = (block->count + 7) / 8 * 8;
    for (size_t k = 0; k < count; k += PLS_W)
    {
        frame_walls(list, in, section, &wall, block->first, k, pls_pair_history(list, section, block->first + k), 8, 1, work);
        try_lanes(&law, work, k);
    }
    for (size_t k = 0; k < count; k += PLS_W) factor_lanes(work, k);
    for (size_t k = 0; k < count; k += PLS_W)
    {
        size_t candidate[PLS_W];
        for (size_t lane = 0; lane < PLS_W; ++lane) candidate[lane] = block->first + k + lane;
        pls_vd shear[3];
        pls_vd slip_work = settle_lanes(&law, pls_vm_of((unsigned)work->now[k >> 3] >> (k & 7)),
                                        pls_pair_history(list, section, block->first + k), k, work, shear);
        store_walls(list, work, k, shear, slip_work, candidate, PLS_W);
    }
}

// ---- the block --------------------------------------------------------------------------------------------------------------------------------------------

/// Contacts of one block, the touching ones picked first, any law.
static void work_picked(pls_pair_list *list, const pls_contact_input *in, const pls_pair_section *section, const pls_pair_block *block,
                        pls_contact_work *work)
{
    const pls_law *law = &in->laws->law[section->law];
    const double surface = surface_of(law);
    wall_frame wall = {0};
    work->active_count = 0;
    memset(work->fresh, 0, sizeof work->fresh);
    if (section->wall)
    {
        wall = wall_of(in, section->wall_row);
        for (size_t k = 0; k < block->count; k += 8)
            pick_touching(list, section, block->first + k, walls_touching(list, in, section, block, k, &wall), work);
    }
    else if (in->domain->any_periodic)
        filter_pairs(list, in, section, block, work, 1);
    else
        filter_pairs(list, in, section, block, work, 0);
    if (work->active_count == 0) return;
    for (size_t k = work->active_count; k % 8 != 0; ++k)
        work->active[k] = work->active[work->active_count - 1]; // padding repeats a contact

    load_history(list, section, work);
    if (section->wall)
        for (size_t k = 0; k < work->active_count; k += PLS_W)
            frame_walls(list, in, section, &wall, 0, k, &work->spring[0][k], PLS_WORK_STRIDE, 0, work);
    else
    {
        for (size_t k = 0; k < work->active_count; k += PLS_W) load_lanes(list, in, 0, k, k, work, 0, 0);
        for (size_t k = 0; k < work->active_count; k += PLS_W) measure_lanes(work, k, 0.0, 0);
        for (size_t k = 0; k < work->active_count; k += PLS_W)
            carry_lanes(list, in, surface, &work->spring[0][k], PLS_WORK_STRIDE, fresh_lanes(work, k), k, work, 0);
        if (law->ops->needs_effective) load_effective(list, in, work);
    }
    pls_contact_law(law, in->dt, (work->active_count + 7) / 8 * 8, work);
    if (section->wall)
        for (size_t k = 0; k < work->active_count; k += PLS_W)
        {
            size_t candidate[PLS_W];
            pls_vd shear[3];
            for (size_t lane = 0; lane < PLS_W; ++lane) candidate[lane] = work->active[k + lane];
            for (int a = 0; a < 3; ++a) shear[a] = pls_vd_load(&work->shear_force[a][k]);
            store_walls(list, work, k, shear, pls_vd_load(&work->slip_work[k]), candidate, lanes_left(work, k));
        }
    else
        store_pairs(list, in, work);
    store_history(list, section, work);
}

/// All candidates of the block, the linear law: as on a conveyor, each eight one place further in each turn. So neighbouring instructions belong to different
/// contacts and do not wait for each other, the units for shuffles, products and roots are busy at the same time, and what is passed on stays in a small ring.
static inline __attribute__((always_inline)) void work_whole(pls_pair_list *list, const pls_contact_input *in,
                                                             const pls_pair_section *section, const pls_pair_block *block,
                                                             pls_contact_work *work, int plain)
{
    enum { MEASURE = 8, CARRY = 16, TRY = 24, FACTOR = 32, SETTLE = 40, RING = 64 };
    const double surface = surface_of(&in->laws->law[section->law]);
    const pls_linear_values law = pls_linear_take(in->laws->law[section->law].constants, in->dt);
    const size_t first = block->first, count = (block->count + 7) / 8 * 8, onwards = 8 * (size_t)section->numbers;
    const double both_radii = 2.0 * in->place[list->row_i[first]].radius;
    // Copies that no store of a byte can change, as far as compilers know.
    const pls_pair_list pairs = *list;
    const pls_contact_input input = *in;
    const size_t next = (size_t)(block - pairs.block) + 1, turns = PLS_CONTACT_BLOCK / 8;
    const uint32_t *coming = pairs.fetch_row + pairs.fetch_start[next];
    const size_t per_turn = input.large ? (pairs.fetch_start[next + 1] - pairs.fetch_start[next] + turns - 1) / turns : 0;
    double *old = pls_pair_history(&pairs, section, first), *kept = old;
    if (input.vast) fetch_list(&pairs, block, coming);
    for (size_t turn = 0; turn < count + SETTLE; turn += 8)
    {
        size_t k = turn, m = k % RING;
        if (k < count)
        {
#pragma GCC unroll 2
            for (size_t v = 0; v < 8; v += PLS_W)
            {
                if (input.vast || !input.large) fetch_slots(&pairs, section, first + k + v, 1);
                load_lanes(&pairs, &input, first, k + v, m + v, work, 1, plain);
            }
        }
        k = turn - MEASURE, m = k % RING;
        if (k < count)
        {
            unsigned now = 0;
#pragma GCC unroll 2
            for (size_t v = 0; v < 8; v += PLS_W) now |= measure_lanes(work, m + v, both_radii, plain) << v;
            if (k + 8 > block->count) now &= valid_lanes(block, k);
            now &= pls_pair_free_lanes(&pairs, first + k);
            work->now[k >> 3] = (uint8_t)now;
            work->fresh[k >> 3] = (uint8_t)note_touching(list, section, first + k, now);
        }
        k = turn - CARRY, m = k % RING;
        if (k < count)
        {
            fetch_bodies(&input, coming, per_turn);
            coming += per_turn;
            if (input.vast)
            {
                fetch_ends(&pairs, &input, first + k + PLS_CONTACT_BLOCK);
                fetch_rows_of_list(&pairs, first + k);
            }
#pragma GCC unroll 2
            for (size_t v = 0; v < 8; v += PLS_W)
            {
                carry_lanes(&pairs, &input, surface, old + v, 8, fresh_lanes(work, k + v), m + v, work, plain);
            }
            old += onwards;
        }
        k = turn - TRY, m = k % RING;
        if (k < count)
        {
#pragma GCC unroll 2
            for (size_t v = 0; v < 8; v += PLS_W) try_lanes(&law, work, m + v);
        }
        k = turn - FACTOR, m = k % RING;
        if (k < count)
        {
#pragma GCC unroll 2
            for (size_t v = 0; v < 8; v += PLS_W) factor_lanes(work, m + v);
        }
        k = turn - SETTLE, m = k % RING;
        if (k < count)
        {
#pragma GCC unroll 2
            for (size_t v = 0; v < 8; v += PLS_W)
            {
                if (input.large) fetch_slots(&pairs, section, first + k + v + PLS_CONTACT_BLOCK, 0);
                double *row[PLS_W], *slot = pairs.live + pls_live_slot(&pairs, first + k) * PLS_SLOT;
                pls_vd shear[3];
                pls_vd slip_work = settle_lanes(&law, pls_vm_of((unsigned)work->now[k >> 3] >> v), kept + v, m + v, work, shear);
                for (size_t lane = 0; lane < PLS_W; ++lane) row[lane] = slot + (v + lane) * PLS_SLOT;
                store_lanes(work, m + v, shear, slip_work, row, PLS_W);
                for (size_t lane = v; !plain && !pairs.equal_radii && lane < v + PLS_W; ++lane)
                    store_skew(&pairs, &input, first + k + lane, work->inv_distance[m + lane]);
            }
            kept += onwards;
            if (input.kept && pairs.alone) keep_slots(&pairs, first + k, 8);
        }
    }
}

/// Did so many of the block's candidates touch at the last step that picking them does not pay?
static bool whole_pays(const pls_pair_list *list, const pls_pair_block *block)
{
    size_t touching = 0, bytes = (block->count + 7) / 8;
    const uint8_t *touch = list->touch + (block->first >> 3);
    unsigned long long eight;
    for (; bytes >= 8; bytes -= 8, touch += 8)
    {
        memcpy(&eight, touch, sizeof eight);
        touching += (size_t)__builtin_popcountll(eight);
    }
    for (; bytes > 0; --bytes, ++touch) touching += (size_t)__builtin_popcount(*touch);
    return 16 * touching >= WHOLE_FROM * (size_t)block->count;
}

void PLS_SIMD(pls_contact_block)(pls_pair_list *list, const pls_contact_input *in, const pls_pair_block *block, pls_contact_work *work)
{
    const pls_pair_section *section = &list->section[block->section];
    const pls_law *law = &in->laws->law[section->law];
    const bool springs = law->ops->evaluate == pls_linear_evaluate && law->constants[PLS_LINEAR_KS] > 0.0;
    if (!springs || !whole_pays(list, block))
        work_picked(list, in, section, block, work);
    else if (section->wall)
        work_whole_walls(list, in, section, block, work);
    else if (in->domain->any_periodic || in->growing || !list->equal_radii)
        work_whole(list, in, section, block, work, 0);
    else
        work_whole(list, in, section, block, work, 1);
}
