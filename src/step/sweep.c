// sweep.c -- contacts, and forces and velocities of the end of a step, in one sweep over the pair list: bodies are finished as soon as their last contact is
// known, while it is in the cache. Whatever the order, each contact is computed from bodies that are not yet finished, and each body from all of its contacts.
//
// Threads have a share of the list each, and help where others are late. They wait for each other twice per step, with solids four times, with bonds twice or three times more:
//
//     positions of points | their dilatations | forces of bonds | poses of solids | contacts of solids | walls, own blocks of pairs and the bodies that are done with, blocks of others | bodies with pairs in several shares | is there a next step to go on with?
//
// and stay together for all steps that run into each other: waking a team costs as much as the work of some hundred bodies.

#include "step/sweep.h"

#include "base/barrier.h"
#include "base/parallel.h"
#include "contact/sweep_plan.h"
#include "step/bonds.h"
#include "step/velocity_verlet.h"

#include <omp.h>
#include <string.h>

enum {
    SERIAL_BLOCKS = 4,  ///< a loop of no more blocks is not worth waking other threads for
    POSE_BLOCK = 64,    ///< solid bodies whose poses are computed at a time
    WAITING_GROUPS = 4, ///< groups that a thread takes at a time to finish what had to wait
    BODY_BLOCK = 256    ///< bodies per block: its rows stay in the second-level cache; at most PLS_FORCE_BATCH
};

static void add_report(pls_drift_report *total, const pls_drift_report *part)
{
    if (part->largest_square > total->largest_square) total->largest_square = part->largest_square;
    total->poison += part->poison; // zeros, or NaN: no order to keep
}

/// Stop where something is not finite; `moved`: the report is that of a drift.
static pls_status judge(pls_world *world, const pls_drift_report *total, bool moved)
{
    if (total->poison != 0.0 || isnan(total->poison)) PLS_TRY(pls_guard_finite(world));
    if (moved) pls_neighbours_moved(world, total->largest_square);
    return PLS_OK;
}

// ---- the beginning of a step ---------------------------------------------------------------------------------------------------------------------------

static void begin_block(pls_world *world, size_t b, pls_drift_report *total)
{
    pls_bodies *bodies = &world->bodies;
    pls_drift_report part;
    PLS_SIMD_SELECT(pls_verlet_begin)(bodies, b * BODY_BLOCK, pls_block_end(b, BODY_BLOCK, bodies->count), world->dt, &part);
    add_report(total, &part);
}

/// Small worlds do without a team, and so in sweeps: even one of a single thread has to be made, and waits at the end of its loops by calls of the system. Nor may their loops be those
/// of a team, or they would be shared out to the team that a caller may have.
static bool needs_team(size_t blocks) { return blocks > SERIAL_BLOCKS; }

pls_status pls_begin_bodies(pls_world *world)
{
    const size_t blocks = pls_block_count(world->bodies.count, BODY_BLOCK);
    pls_drift_report total = {0.0, 0.0};
    if (needs_team(blocks))
#pragma omp parallel
    {
        pls_drift_report mine = {0.0, 0.0};
#pragma omp for schedule(static)
        for (size_t b = 0; b < blocks; ++b) begin_block(world, b, &mine);
#pragma omp critical(pls_drift_report)
        add_report(&total, &mine);
    }
    else
        for (size_t b = 0; b < blocks; ++b) begin_block(world, b, &total);
    return judge(world, &total, true);
}

// ---- bodies, contacts --------------------------------------------------------------------------------------------------------------------------------------

static pls_status finish_block(pls_world *world, size_t first, size_t last, double dt, double time, bool go_on, pls_drift_report *report)
{
    double force[4 * BODY_BLOCK] __attribute__((aligned(64))), torque[4 * BODY_BLOCK] __attribute__((aligned(64)));
    double scratch[PLS_FORCE_SCRATCH] __attribute__((aligned(64)));
    const bool solid = world->solids.count > 0, bonded = world->bond_count > 0, forced = world->force_count > 0 || solid || bonded;
    if (world->force_count > 0)
        PLS_TRY(pls_body_forces(world, first, last, time, scratch, force, torque));
    else if (forced)
        memset(force, 0, (last - first) * 4 * sizeof *force), memset(torque, 0, (last - first) * 4 * sizeof *torque);
    for (size_t k = 0; k < world->bond_count; ++k) pls_bond_gather(&world->bond[k], &world->bodies, first, last, force, torque);
    if (solid) pls_solid_gather(&world->solids, first, last, force, torque);
    PLS_SIMD_SELECT(pls_verlet_finish)
    (&world->bodies, &world->list, first, last, dt, forced ? force : NULL, forced ? torque : NULL, go_on, report);
    return PLS_OK;
}

/// What the threads of a sweep share.
typedef struct sweep
{
    pls_world *world;
    pls_contact_input input;
    void (*contact_block)(pls_pair_list *list, const pls_contact_input *input, const pls_pair_block *block, pls_contact_work *work);
    double time;        ///< of the forces [s]
    uint64_t end;       ///< step that the caller wants to stop at
    bool go_on;         ///< each body begins its next step at once, while its rows are at hand
    bool again;         ///< the next step is swept too
    size_t next_solids; ///< block of contacts of solids that nobody has taken
    pls_barrier bonds_placed, bonds_dilated, bonds_known;
    pls_barrier solids_posed, solids_known;
    pls_barrier walls_known; ///< before all threads have done their contacts with walls, no body may be finished
    pls_barrier contacts_known, step_done;
    _Alignas(64) pls_drift_report total;
    pls_status worst;
    size_t failed_at; ///< first block of the thread that failed
    char message[512];
} sweep;

/// The part of one thread: blocks of pairs, and the groups of rows that begin with them.
typedef struct share
{
    int thread, threads;
    unsigned round; ///< sweeps of this team before
    size_t first_block, last_block, first_group, last_group;
    size_t waiting; ///< groups put aside to be finished when all contacts are known
    pls_drift_report report;
    pls_narrow_counts counts;
    pls_status status;
} share;

static size_t group_of_block(const pls_pair_list *list, size_t block, size_t groups)
{
    return block < list->block_count ? pls_pair_lower_row(list, list->block[block].first) / PLS_ROW_GROUP : groups;
}

static share share_of(const pls_world *world, int thread, int threads, unsigned round)
{
    const pls_pair_list *list = &world->list;
    size_t groups = pls_block_count(world->bodies.count, PLS_ROW_GROUP), pairs = list->block_count - list->wall_blocks;
    // The last thread also gathers for the walls, whose rows are the last: a third of a pair's work per candidate.
    size_t all = pairs + (list->count - list->wall_first) / (3 * PLS_CONTACT_BLOCK);
    size_t first = all * (size_t)thread / (size_t)threads, last = all * ((size_t)thread + 1) / (size_t)threads;
    first = list->wall_blocks + (first < pairs ? first : pairs);
    last = list->wall_blocks + (last < pairs ? last : pairs);
    return (share){.thread = thread,
                   .threads = threads,
                   .round = round,
                   .first_block = first,
                   .last_block = last,
                   .first_group = thread == 0 ? 0 : group_of_block(list, first, groups),
                   .last_group = thread == threads - 1 ? groups : group_of_block(list, last, groups)};
}

/// Fetch into the second-level cache what the end of the step needs of the rows that the next block begins with, besides what the block itself fetches: columns of which a line lasts for
/// many bodies. The processor does not see that they go on, and the starts of rows are asked for at once. (Inlined always: a function that does nothing but fetch does nothing, as the compiler
/// sees it, and its calls are left out.)
static inline __attribute__((always_inline)) void fetch_columns(const pls_world *world, const pls_pair_block *block)
{
    enum { ROWS = 24, STARTS_AHEAD = 64, A_LINE = 8 };
    const pls_bodies *bodies = &world->bodies;
    const pls_pair_list *list = &world->list;
    const size_t row = pls_pair_lower_row(list, block->first + PLS_CONTACT_BLOCK);
    for (size_t r = row; r < row + ROWS + A_LINE; r += A_LINE)
    {
        __builtin_prefetch(&bodies->damped[r], 0, 2);
        __builtin_prefetch(&bodies->damping_power[r], 0, 2);
        __builtin_prefetch(&bodies->slid[r], 0, 2);
    }
    for (size_t r = row + STARTS_AHEAD; r < row + STARTS_AHEAD + 4 * A_LINE; r += 2 * A_LINE)
    {
        __builtin_prefetch(&list->pairs.start[r]);
        __builtin_prefetch(&list->walls.start[r]);
    }
    if (row + ROWS >= bodies->count) return;
    for (const uint32_t *head = pls_near_row(list, row), *end = pls_near_row(list, row + ROWS); head < end; head += 2 * A_LINE)
        __builtin_prefetch(head, 0, 2);
}

static void work_block(sweep *s, share *mine, size_t b)
{
    pls_world *world = s->world;
    const pls_pair_block *block = &world->list.block[b];
    if (s->input.vast && b >= world->list.wall_blocks) fetch_columns(world, block);
    s->contact_block(&world->list, &s->input, block, &world->work[mine->thread]);
    if (s->input.dt > 0.0 && mine->status == PLS_OK) mine->status = pls_find_parted(world, block, &world->parted[mine->thread]);
}

static void finish_groups(sweep *s, share *mine, size_t first, size_t last)
{
    size_t end = last * PLS_ROW_GROUP < s->world->bodies.count ? last * PLS_ROW_GROUP : s->world->bodies.count;
    for (size_t row = first * PLS_ROW_GROUP; row < end && mine->status == PLS_OK; row += BODY_BLOCK)
    {
        pls_drift_report part = {0.0, 0.0};
        size_t stop = row + BODY_BLOCK < end ? row + BODY_BLOCK : end;
        mine->status = finish_block(s->world, row, stop, s->input.dt, s->time, s->go_on, &part);
        add_report(&mine->report, &part);
    }
}

/// Contacts with walls, by the thread that has the bodies' rows (and so their cache lines): where it has the first of the block.
static void work_walls(sweep *s, share *mine)
{
    const pls_pair_list *list = &s->world->list;
    for (size_t b = 0; b < list->wall_blocks; ++b)
    {
        size_t group = list->row_i[list->block[b].first] / PLS_ROW_GROUP;
        if (mine->first_group <= group && group < mine->last_group) work_block(s, mine, b);
    }
    pls_share_left *left = &s->world->left[mine->thread]; // before others look
    left->blocks = (uint64_t)mine->first_block << 32 | mine->last_block;
    left->first_group = mine->first_group;
    left->taken = 0;
    if (pls_barrier_arrive(&s->walls_known, mine->threads)) pls_barrier_open(&s->walls_known);
}

/// Whether a group of rows has pairs in blocks that this thread has not done.
static bool must_wait(const pls_pair_list *list, const share *mine, size_t group)
{
    const uint32_t first = list->group_first[group], last = list->group_last[group];
    return first != UINT32_MAX && (first < mine->first_block || last >= mine->last_block);
}

/// Finish groups first .. last, which have no pairs in later blocks of this thread than are done; put those aside that have some in blocks of others.
static void finish_ready(sweep *s, share *mine, size_t first, size_t last)
{
    const pls_pair_list *list = &s->world->list;
    if (mine->threads == 1)
    {
        finish_groups(s, mine, first, last);
        return;
    }
    for (size_t g = first; g < last;)
    {
        size_t end = g;
        while (end < last && !must_wait(list, mine, end)) ++end;
        finish_groups(s, mine, g, end);
        for (g = end; g < last && must_wait(list, mine, g); ++g) list->group_waiting[mine->first_group + mine->waiting++] = (uint32_t)g;
    }
}

/// Take the next blocks of a share, its owner from the front, other threads from the back.
static bool take_blocks(pls_share_left *left, bool front, size_t *first, size_t *last)
{
    uint64_t old = __atomic_load_n(&left->blocks, __ATOMIC_RELAXED), new;
    do {
        uint64_t begin = old >> 32, end = old & UINT32_MAX, count = end - begin < PLS_TAKEN_BLOCKS ? end - begin : PLS_TAKEN_BLOCKS;
        if (count == 0) return false;
        *first = front ? begin : end - count;
        *last = *first + count;
        new = front ? *last << 32 | end : begin << 32 | *first;
    } while (!__atomic_compare_exchange_n(&left->blocks, &old, new, false, __ATOMIC_ACQ_REL, __ATOMIC_RELAXED));
    return true;
}

/// The thread's own blocks, as far as nobody helps, and its bodies as soon as their last contact is known.
static void sweep_share(sweep *s, share *mine)
{
    const pls_pair_list *list = &s->world->list;
    size_t reached = mine->first_group; // groups before this one were looked at while their forces were fresh
    size_t ready = reached;             // groups before this one have no pairs left in this share
    size_t b, last;
    mine->last_block = mine->first_block; // as far as it has come
    while (take_blocks(&s->world->left[mine->thread], true, &b, &last))
    {
        for (; b < last; ++b) work_block(s, mine, b);
        mine->last_block = last;
        ready = pls_ready_groups(list, ready, mine->last_group, last);
        // Looked at again eight blocks later, out of the near caches until then.
        if (ready + PLS_READY_GROUPS < mine->last_group) __builtin_prefetch(&list->group_last[ready + PLS_READY_GROUPS]);
        if (ready - reached < PLS_READY_GROUPS) continue;
        pls_barrier_wait(&s->walls_known, mine->round);
        finish_ready(s, mine, reached, ready);
        reached = ready;
    }
    pls_barrier_wait(&s->walls_known, mine->round);
    finish_ready(s, mine, reached, mine->last_group);
    s->world->left[mine->thread].waiting = mine->waiting;
}

/// Blocks that others have not come to: processors are seldom equally quick, as they may have other work.
static void help_others(sweep *s, share *mine)
{
    size_t b, last;
    for (int t = 1; t < mine->threads; ++t)
        while (take_blocks(&s->world->left[(mine->thread + t) % mine->threads], false, &b, &last))
            for (; b < last; ++b) work_block(s, mine, b);
}

/// Fetch into the cache what the rows of a group will gather, from the cache of another thread.
static void fetch_group(const pls_world *world, size_t group)
{
    const pls_pair_list *list = &world->list;
    for (size_t row = group * PLS_ROW_GROUP; row < (group + 1) * PLS_ROW_GROUP && row < world->bodies.count; ++row)
    {
        const uint32_t *head = pls_near_row(list, row);
        __builtin_prefetch(&world->bodies.place[row]);
        __builtin_prefetch(&world->bodies.spin[row]);
        __builtin_prefetch(&world->bodies.load[row]);
        if (head[0] == PLS_NEAR_STALE) continue;
        for (uint32_t k = 0; k < head[0] + head[1]; ++k) __builtin_prefetch(list->live + (size_t)head[PLS_NEAR_HEAD + k] * PLS_SLOT);
    }
}

/// Take groups of a share that wait, and have fetched what they gather. Returns how many.
static size_t take_waiting(const pls_world *world, pls_share_left *left, const uint32_t **group)
{
    const size_t first = __atomic_fetch_add(&left->taken, WAITING_GROUPS, __ATOMIC_RELAXED);
    if (first >= left->waiting) return 0;
    const size_t count = left->waiting - first < WAITING_GROUPS ? left->waiting - first : WAITING_GROUPS;
    *group = world->list.group_waiting + left->first_group + first;
    for (size_t k = 0; k < count; ++k) fetch_group(world, (*group)[k]);
    return count;
}

/// Finish what had to wait for other threads, the thread's own first; the next groups are fetched while these are worked on.
static void finish_waiting(sweep *s, share *mine)
{
    for (int t = 0; t < mine->threads; ++t)
    {
        pls_share_left *left = &s->world->left[(mine->thread + t) % mine->threads];
        const uint32_t *group, *next;
        for (size_t count = take_waiting(s->world, left, &group), coming; count > 0; count = coming, group = next)
        {
            coming = take_waiting(s->world, left, &next);
            for (size_t k = 0, end; k < count; k = end)
            {
                for (end = k + 1; end < count && group[end] == group[end - 1] + 1;) ++end;
                finish_groups(s, mine, group[k], group[end - 1] + 1);
            }
        }
    }
}

static void pose_solids(sweep *s, size_t b)
{
    pls_solid_list *list = &s->world->solids;
    pls_solid_pose(list, &s->input, &s->world->bodies, s->world->shape_of, b * POSE_BLOCK, pls_block_end(b, POSE_BLOCK, list->row_count));
}

static void work_solids(sweep *s, share *mine, size_t b)
{
    pls_solid_list *list = &s->world->solids;
    pls_solid_contacts(list, &s->input, &list->block[b], &s->world->work[mine->thread], &mine->counts);
    if (s->input.dt > 0.0 && mine->status == PLS_OK)
        mine->status = pls_find_parted_solids(s->world, &s->input, &list->block[b], &s->world->parted[mine->thread]);
}

/// Contacts of solids, all of them: they are few, and each costs far more than passing a body.
static void sweep_solids(sweep *s, share *mine)
{
    const pls_solid_list *list = &s->world->solids;
    const size_t poses = pls_block_count(list->row_count, POSE_BLOCK), thread = (size_t)mine->thread, threads = (size_t)mine->threads;
    for (size_t b = poses * thread / threads; b < poses * (thread + 1) / threads; ++b) pose_solids(s, b);
    pls_barrier_pass(&s->solids_posed, mine->threads, mine->round);
    for (size_t b; (b = __atomic_fetch_add(&s->next_solids, 1, __ATOMIC_RELAXED)) < list->block_count;) work_solids(s, mine, b);
    pls_barrier_pass(&s->solids_known, mine->threads, mine->round);
}

/// Wait for all threads, the last of which looks after the whole.
static void meet(sweep *s, pls_barrier *barrier, const share *mine, void (*whole)(pls_world *world))
{
    if (pls_barrier_arrive(barrier, mine->threads))
    {
        whole(s->world);
        pls_barrier_open(barrier);
    }
    else
        pls_barrier_wait(barrier, mine->round);
}

/// Forces of all bonds, before any body is finished.
static void sweep_bonds(sweep *s, share *mine)
{
    mine->status = pls_bonds_place(s->world, s->input.dt, mine->thread, mine->threads);
    meet(s, &s->bonds_placed, mine, pls_bonds_placed);
    if (pls_bonds_dilate_at_all(s->world))
    {
        if (mine->status == PLS_OK) mine->status = pls_bonds_dilate(s->world, s->input.dt, mine->thread, mine->threads);
        meet(s, &s->bonds_dilated, mine, pls_bonds_dilated);
    }
    pls_bonds_act(s->world, mine->thread, mine->threads);
    meet(s, &s->bonds_known, mine, pls_bonds_acted);
}

static void add_counts(pls_narrow_counts *total, const pls_narrow_counts *part)
{
    total->queries += part->queries, total->iterations += part->iterations, total->restarts += part->restarts;
    total->fallbacks += part->fallbacks, total->failures += part->failures;
}

// ---- the whole ------------------------------------------------------------------------------------------------------------------------------------------

/// Whether somebody has to look at the world at the end of the step that is about to be swept. Its drift is done, so it is known whether the guard can find anything.
static bool is_looked_at(const pls_world *world)
{
    const uint64_t after = world->step + 1;
    return after % PLS_GUARD_STEPS == 0 && (after % PLS_STABLE_STEPS == 0 || pls_guard_is_due(world));
}

/// Steps may run into each other where nobody looks in between, and no body or state needs to be asked at the end of the step.
static bool may_go_on(const pls_world *world, uint64_t end)
{
    return world->step + 1 < end && !is_looked_at(world) && world->special_count == 0 && world->state_count == 0 &&
           world->binding_count == 0 && !pls_damps(world);
}

/// Add up what a thread found; threads come one at a time.
static void collect(sweep *s, share *mine)
{
    add_report(&s->total, &mine->report);
    add_counts(&s->world->solids.counts, &mine->counts);
    if (mine->status != PLS_OK && mine->first_block <= s->failed_at) // of several failures that of the first thread
    {
        s->worst = mine->status;
        s->failed_at = mine->first_block;
        strncpy(s->message, pls_last_message(), sizeof s->message - 1); // messages belong to threads; bring it to the caller's
    }
}

/// Whether contacts can be looked at after the step that is about to be swept.
static void note_kept(sweep *s)
{
    s->input.kept = !s->go_on;
    s->world->list.gone = s->world->list.alone && !s->input.kept;
}

static pls_status book_sweep(sweep *s)
{
    PLS_TRY(pls_book_parted(s->world));
    return judge(s->world, &s->total, s->go_on);
}

/// Book the step, and begin the sweep of the next one if it has begun and the list still holds. By one thread.
static void close_sweep(sweep *s)
{
    pls_world *world = s->world;
    s->again = false;
    if (s->worst != PLS_OK) return;
    s->worst = book_sweep(s);
    if (s->worst != PLS_OK) strncpy(s->message, pls_last_message(), sizeof s->message - 1);
    if (s->worst != PLS_OK || !s->go_on) return;
    ++world->step;
    world->time = s->time;
    s->again = pls_neighbours_hold(world);
    if (!s->again) return;
    s->time = (double)(world->step + 1) * world->dt;
    pls_domain_at(&world->domain, s->time);
    s->go_on = may_go_on(world, s->end);
    note_kept(s);
    s->next_solids = 0;
    s->total = (pls_drift_report){0.0, 0.0};
}

/// The part of one thread in all steps of a sweep.
static void take_part(sweep *s, int thread, int threads)
{
    for (unsigned round = 0; round == 0 || s->again; ++round)
    {
        share mine = share_of(s->world, thread, threads, round);
        if (s->world->bond_count > 0) sweep_bonds(s, &mine);
        if (s->world->solids.count > 0) sweep_solids(s, &mine);
        work_walls(s, &mine);
        sweep_share(s, &mine);
        help_others(s, &mine);
        pls_barrier_pass(&s->contacts_known, threads, round);
        if (threads > 1) finish_waiting(s, &mine);
#pragma omp critical(pls_sweep)
        collect(s, &mine);
        if (pls_barrier_arrive(&s->step_done, threads))
        {
            close_sweep(s);
            pls_barrier_open(&s->step_done);
        }
        else
            pls_barrier_wait(&s->step_done, round);
    }
}

pls_status pls_sweep(pls_world *world, double dt, uint64_t end, bool *begun)
{
    const pls_pair_list *list = &world->list;
    sweep s = {.world = world, .input = pls_contact_input_of(world, dt), .end = end, .failed_at = SIZE_MAX};
    s.contact_block = PLS_SIMD_SELECT(pls_contact_block);
    s.time = dt > 0.0 ? (double)(world->step + 1) * dt : world->time;
    s.go_on = may_go_on(world, end);
    note_kept(&s);
    for (int t = 0; t < world->work_count; ++t) world->parted[t].count = 0; // a sweep that failed may have left some
    pls_barrier_init(&s.bonds_placed);
    pls_barrier_init(&s.bonds_dilated);
    pls_barrier_init(&s.bonds_known);
    pls_barrier_init(&s.solids_posed);
    pls_barrier_init(&s.solids_known);
    pls_barrier_init(&s.walls_known);
    pls_barrier_init(&s.contacts_known);
    pls_barrier_init(&s.step_done);
    const bool large = needs_team(list->block_count) || needs_team(world->solids.block_count) ||
                       needs_team(pls_block_count(world->bodies.count, BODY_BLOCK)) ||
                       needs_team(pls_block_count(pls_bonds_points(world), PLS_BOND_BLOCK));
    if (large && !list->alone)
    {
#pragma omp parallel
        take_part(&s, omp_get_thread_num(), omp_get_num_threads());
    }
    else
        take_part(&s, 0, 1);
    pls_barrier_destroy(&s.bonds_placed);
    pls_barrier_destroy(&s.bonds_dilated);
    pls_barrier_destroy(&s.bonds_known);
    pls_barrier_destroy(&s.solids_posed);
    pls_barrier_destroy(&s.solids_known);
    pls_barrier_destroy(&s.walls_known);
    pls_barrier_destroy(&s.contacts_known);
    pls_barrier_destroy(&s.step_done);
    *begun = s.go_on;
    return s.worst == PLS_OK ? PLS_OK : pls_fail(s.worst, "%s", s.message);
}
