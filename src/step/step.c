// step.c -- one time step, read from top to bottom.
//
//     half kick, drift -> driven bodies -> states -> neighbours (if stale) -> contacts and laws -> body forces, gather, half kick -> guards
//
// The order differs from the picture in which states come last: forces at t + dt need states at t + dt, and after the drift the midpoint rates of everything
// that states depend on are known (state_rk2.c).

#include "step/world.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "step/timestep.h"
#include "step/velocity_verlet.h"

#include <omp.h>
#include <sched.h>
#include <string.h>

enum {
    GUARD_STEPS = 64,    ///< steps between looks at overlaps and lost bodies
    STABLE_STEPS = 4096, ///< steps between looks at the stable step
    SERIAL_BLOCKS = 4,   ///< a loop of no more blocks is not worth waking other threads for
    POSE_BLOCK = 64,     ///< solid bodies whose poses are computed at a time
    READY_GROUPS = 32,   ///< groups of rows that are finished at a time, if so many are ready
    WAITING_GROUPS = 16, ///< groups that a thread takes at a time to finish what had to wait
    TAKEN_BLOCKS = 8,    ///< blocks of pairs that a thread takes at a time
    BODY_BLOCK = 256     ///< bodies per block: its rows stay in the second-level cache; at most PLS_FORCE_BATCH
};

static pls_status finish_block(pls_world *world, size_t first, size_t last, double dt, double time, bool go_on, pls_drift_report *report)
{
    double force[4 * BODY_BLOCK] __attribute__((aligned(64))), torque[4 * BODY_BLOCK] __attribute__((aligned(64)));
    double scratch[PLS_FORCE_SCRATCH] __attribute__((aligned(64)));
    const bool solid = world->solids.count > 0, forced = world->force_count > 0 || solid;
    if (world->force_count > 0)
        PLS_TRY(pls_body_forces(world, first, last, time, scratch, force, torque));
    else if (solid)
        memset(force, 0, (last - first) * 4 * sizeof *force), memset(torque, 0, (last - first) * 4 * sizeof *torque);
    if (solid) pls_solid_gather(&world->solids, first, last, force, torque);
    PLS_SIMD_SELECT(pls_verlet_finish)
    (&world->bodies, &world->list, first, last, dt, forced ? force : NULL, forced ? torque : NULL, go_on, report);
    return PLS_OK;
}

pls_contact_input pls_contact_input_of(const pls_world *world, double dt)
{
    const pls_bodies *bodies = &world->bodies;
    return (pls_contact_input){.place = bodies->place,
                               .spin = bodies->spin,
                               .load = bodies->load,
                               .before = bodies->before,
                               .orientation = bodies->orientation,
                               .domain = &world->domain,
                               .laws = &world->laws,
                               .large = bodies->count > PLS_LARGE_WORLD,
                               .vast = bodies->count > PLS_VAST_WORLD,
                               .growing = world->state_count > 0,
                               .dt = dt};
}

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

static pls_status begin_bodies(pls_world *world)
{
    pls_bodies *bodies = &world->bodies;
    pls_drift_report total = {0.0, 0.0};
#pragma omp parallel if (bodies->count > SERIAL_BLOCKS * BODY_BLOCK)
    {
        pls_drift_report mine = {0.0, 0.0}, part;
#pragma omp for schedule(static)
        for (size_t b = 0; b < pls_block_count(bodies->count, BODY_BLOCK); ++b)
        {
            PLS_SIMD_SELECT(pls_verlet_begin)(bodies, b * BODY_BLOCK, pls_block_end(b, BODY_BLOCK, bodies->count), world->dt, &part);
            add_report(&mine, &part);
        }
#pragma omp critical(pls_drift_report)
        add_report(&total, &mine);
    }
    return judge(world, &total, true);
}

// ---- contacts, forces, velocities --------------------------------------------------------------------------------------------------------------------------

/// What the threads of a sweep share.
typedef struct sweep
{
    pls_world *world;
    pls_contact_input input;
    double time;      ///< of the forces [s]
    bool go_on;       ///< each body begins its next step at once, while its rows are at hand
    int past_walls;   ///< threads that have done their contacts with walls; before all have, no body may be finished
    size_t looked_at; ///< groups of rows that somebody has taken to finish if they had to wait
    pls_drift_report total;
    pls_status worst;
    size_t failed_at; ///< first block of the thread that failed
    char message[512];
} sweep;

/// The part of one thread: blocks of pairs, and the groups of rows that begin with them.
typedef struct share
{
    int thread, threads;
    size_t first_block, last_block, first_group, last_group;
    pls_drift_report report;
    pls_narrow_counts counts;
    pls_status status;
} share;

static size_t group_of_block(const pls_pair_list *list, size_t block, size_t groups)
{
    return block < list->block_count ? pls_pair_lower_row(list, list->block[block].first) / PLS_ROW_GROUP : groups;
}

static share share_of(const pls_world *world, int thread, int threads)
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
                   .first_block = first,
                   .last_block = last,
                   .first_group = thread == 0 ? 0 : group_of_block(list, first, groups),
                   .last_group = thread == threads - 1 ? groups : group_of_block(list, last, groups)};
}

static void work_block(sweep *s, share *mine, size_t b)
{
    pls_world *world = s->world;
    const pls_pair_block *block = &world->list.block[b];
    PLS_SIMD_SELECT(pls_contact_block)(&world->list, &s->input, block, &world->work[mine->thread]);
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
    s->world->left[mine->thread].range = (uint64_t)mine->first_block << 32 | mine->last_block; // before others look
    __atomic_add_fetch(&s->past_walls, 1, __ATOMIC_RELEASE);
}

static void wait_for_walls(const sweep *s, const share *mine)
{
    for (int turn = 0; __atomic_load_n(&s->past_walls, __ATOMIC_ACQUIRE) < mine->threads; ++turn)
        if (turn > 1000) sched_yield(); // seldom: more threads than processors
}

/// Finish groups first .. last, which have no pairs in later blocks of this thread than are done, except those with pairs in blocks of other threads.
static void finish_ready(sweep *s, share *mine, size_t first, size_t last)
{
    const pls_pair_list *list = &s->world->list;
    for (size_t g = first; g < last; ++g)
    {
        bool none = list->group_first[g] == UINT32_MAX;
        list->group_waits[g] = !none && (list->group_first[g] < mine->first_block || list->group_last[g] >= mine->last_block);
    }
    for (size_t g = first; g < last;)
    {
        size_t end = g;
        while (end < last && !list->group_waits[end]) ++end;
        finish_groups(s, mine, g, end);
        for (g = end; g < last && list->group_waits[g]; ++g) continue;
    }
}

/// Take the next blocks of a share, its owner from the front, other threads from the back.
static bool take_blocks(pls_blocks_left *left, bool front, size_t *first, size_t *last)
{
    uint64_t old = __atomic_load_n(&left->range, __ATOMIC_RELAXED), new;
    do {
        uint64_t begin = old >> 32, end = old & UINT32_MAX, count = end - begin < TAKEN_BLOCKS ? end - begin : TAKEN_BLOCKS;
        if (count == 0) return false;
        *first = front ? begin : end - count;
        *last = *first + count;
        new = front ? *last << 32 | end : begin << 32 | *first;
    } while (!__atomic_compare_exchange_n(&left->range, &old, new, false, __ATOMIC_ACQ_REL, __ATOMIC_RELAXED));
    return true;
}

/// The thread's own blocks, as far as nobody helps, and its bodies as soon as their last contact is known.
static void sweep_share(sweep *s, share *mine)
{
    const pls_pair_list *list = &s->world->list;
    size_t reached = mine->first_group; // groups before this one were looked at while their forces were fresh
    size_t b, last;
    mine->last_block = mine->first_block; // as far as it has come
    while (take_blocks(&s->world->left[mine->thread], true, &b, &last))
    {
        for (; b < last; ++b) work_block(s, mine, b);
        mine->last_block = last;
        size_t ready = reached;
        while (ready < mine->last_group && list->group_last[ready] < last) ++ready;
        if (ready - reached < READY_GROUPS) continue;
        wait_for_walls(s, mine);
        finish_ready(s, mine, reached, ready);
        reached = ready;
    }
    wait_for_walls(s, mine);
    finish_ready(s, mine, reached, mine->last_group);
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
        for (uint32_t k = 0; k < head[0] + head[1]; ++k) __builtin_prefetch(list->slot + (size_t)head[PLS_NEAR_HEAD + k] * PLS_SLOT);
    }
}

/// Finish what had to wait for other threads, whoever's it was.
static void finish_waiting(sweep *s, share *mine)
{
    const uint8_t *waits = s->world->list.group_waits;
    const size_t groups = pls_block_count(s->world->bodies.count, PLS_ROW_GROUP);
    size_t first;
    while ((first = __atomic_fetch_add(&s->looked_at, WAITING_GROUPS, __ATOMIC_RELAXED)) < groups)
    {
        const size_t last = first + WAITING_GROUPS < groups ? first + WAITING_GROUPS : groups;
        for (size_t g = first; g < last; ++g)
            if (waits[g]) fetch_group(s->world, g);
        for (size_t g = first; g < last; ++g)
        {
            size_t end = g;
            while (end < last && waits[end]) ++end;
            finish_groups(s, mine, g, end);
            g = end;
        }
    }
}

/// Contacts of solids, all of them: they are few, and each costs far more than passing a body.
static void sweep_solids(sweep *s, share *mine)
{
    pls_solid_list *list = &s->world->solids;
#pragma omp for schedule(static)
    for (size_t b = 0; b < pls_block_count(list->row_count, POSE_BLOCK); ++b)
        pls_solid_pose(list, &s->input, &s->world->bodies, s->world->shape_of, b * POSE_BLOCK,
                       pls_block_end(b, POSE_BLOCK, list->row_count));
#pragma omp for schedule(dynamic, 1)
    for (size_t b = 0; b < list->block_count; ++b)
    {
        pls_solid_contacts(list, &s->input, &list->block[b], &s->world->work[mine->thread], &mine->counts);
        if (s->input.dt > 0.0 && mine->status == PLS_OK)
            mine->status = pls_find_parted_solids(s->world, &s->input, &list->block[b], &s->world->parted[mine->thread]);
    }
}

static void add_counts(pls_narrow_counts *total, const pls_narrow_counts *part)
{
    total->queries += part->queries, total->iterations += part->iterations, total->restarts += part->restarts;
    total->fallbacks += part->fallbacks, total->failures += part->failures;
}

/// Contacts, and forces and velocities of the end of the step: bodies are finished as soon as their last contact is known, while it is in the cache.
/// Whatever the order, each contact is computed from bodies that are not yet finished, and each body from all of its contacts.
static pls_status sweep_world(pls_world *world, double dt, double time, bool go_on)
{
    pls_bodies *bodies = &world->bodies;
    const pls_pair_list *list = &world->list;
    sweep s = {.world = world, .input = pls_contact_input_of(world, dt), .time = time, .go_on = go_on, .failed_at = SIZE_MAX};
    for (int t = 0; t < world->work_count; ++t) world->parted[t].count = 0; // a sweep that failed may have left some
#pragma omp parallel if (list->block_count > SERIAL_BLOCKS || world->solids.block_count > SERIAL_BLOCKS || \
                         bodies->count > SERIAL_BLOCKS * BODY_BLOCK)
    {
        share mine = share_of(world, omp_get_thread_num(), omp_get_num_threads());
        if (world->solids.count > 0) sweep_solids(&s, &mine);
        work_walls(&s, &mine);
        sweep_share(&s, &mine);
        help_others(&s, &mine);
#pragma omp barrier
        if (mine.threads > 1) finish_waiting(&s, &mine);
#pragma omp critical(pls_sweep)
        {
            add_report(&s.total, &mine.report);
            add_counts(&world->solids.counts, &mine.counts);
            if (mine.status != PLS_OK && mine.first_block <= s.failed_at) // of several failures that of the first thread
            {
                s.worst = mine.status;
                s.failed_at = mine.first_block;
                strncpy(s.message, pls_last_message(), sizeof s.message - 1); // messages belong to threads; bring it to ours
            }
        }
    }
    if (s.worst != PLS_OK) return pls_fail(s.worst, "%s", s.message);
    PLS_TRY(pls_book_parted(world));
    return judge(world, &s.total, go_on);
}

static pls_status check_step(pls_world *world)
{
    if (world->step % GUARD_STEPS == 0) PLS_TRY(pls_guard_step(world));
    bool due = world->step % STABLE_STEPS == 0 || (world->step % GUARD_STEPS == 0 && pls_stable_step_is_stale(world));
    return due ? pls_check_stable_step(world) : PLS_OK;
}

/// From the drift to the end of the step; `go_on` runs the next step's half kick and drift along.
static pls_status complete_step(pls_world *world, bool go_on)
{
    PLS_TRY(pls_special_drift(world));
    PLS_TRY(pls_states_advance(world));
    PLS_TRY(pls_states_apply(world));
    double time = (double)(world->step + 1) * world->dt;
    pls_domain_at(&world->domain, time);
    PLS_TRY(pls_neighbours_refresh(world));
    PLS_TRY(sweep_world(world, world->dt, time, go_on));
    if (!go_on) pls_special_finish(world);
    ++world->step;
    world->time = time;
    return go_on ? PLS_OK : check_step(world);
}

/// Half kick and drift.
static pls_status begin_step(pls_world *world)
{
    PLS_TRY(pls_special_before(world));
    pls_states_before(world);
    return begin_bodies(world);
}

pls_status pls_step(pls_world *world)
{
    PLS_TRY(pls_world_prepare(world));
    PLS_TRY(begin_step(world));
    return complete_step(world, false);
}

/// Steps may run into each other where nobody looks in between: no guard is due, and no body or state needs to be asked at the end of the step.
static bool may_go_on(const pls_world *world)
{
    return (world->step + 1) % GUARD_STEPS != 0 && world->special_count == 0 && world->state_count == 0 && world->binding_count == 0;
}

pls_status pls_world_run(pls_world *world, uint64_t steps)
{
    PLS_TRY(pls_world_prepare(world));
    bool begun = false;
    for (uint64_t k = 0; k < steps; ++k)
    {
        if (!begun) PLS_TRY(begin_step(world));
        begun = k + 1 < steps && may_go_on(world);
        PLS_TRY(complete_step(world, begun));
    }
    return PLS_OK;
}

// ---- the start -----------------------------------------------------------------------------------------------------------------------------------------

pls_status pls_measure_extent(pls_world *world)
{
    const pls_bodies *b = &world->bodies;
    double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t row = 0; row < b->count; ++row)
    {
        if (b->kind[row].flags & PLS_BODY_UNBOUNDED) continue;
        const double x[3] = {b->place[row].x, b->place[row].y, b->place[row].z};
        for (int a = 0; a < 3; ++a)
            lower[a] = fmin(lower[a], x[a] - b->place[row].radius), upper[a] = fmax(upper[a], x[a] + b->place[row].radius);
    }
    if (!(upper[0] >= lower[0])) return pls_fail(PLS_INVALID_ARGUMENT, "the world has no bounded body; there is nothing to simulate");
    world->centre = pls_vec(0.5 * (lower[0] + upper[0]), 0.5 * (lower[1] + upper[1]), 0.5 * (lower[2] + upper[2]));
    world->extent = pls_length(pls_vec(upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]));
    return PLS_OK;
}

static pls_status reserve_work(pls_world *world)
{
    int threads = pls_threads();
    if (threads <= world->work_count) return PLS_OK;
    pls_parted_free(world);
    pls_release(&world->work);
    pls_release(&world->left);
    world->work_count = 0;
    PLS_TRY(pls_allocate(&world->work, (size_t)threads, sizeof *world->work, "work space of threads"));
    PLS_TRY(pls_allocate(&world->parted, (size_t)threads, sizeof *world->parted, "work space of threads"));
    PLS_TRY(pls_allocate(&world->left, (size_t)threads, sizeof *world->left, "work space of threads"));
    world->work_count = threads;
    return PLS_OK;
}

pls_status pls_world_resume(pls_world *world)
{
    PLS_TRY(reserve_work(world));
    if (world->extent == 0.0) PLS_TRY(pls_measure_extent(world));
    pls_domain_at(&world->domain, world->time);
    world->prepared = false; // so that what states drive is set for now, not for the end of a step
    PLS_TRY(pls_states_apply(world));
    world->prepared = true;
    return PLS_OK;
}

/// Velocities of the end of a step that takes no time are those of now.
static void stand_still(pls_bodies *b)
{
    for (size_t row = 0; row < b->count; ++row)
    {
        pls_body_spin *s = &b->spin[row];
        s->lead_x = s->lead_y = b->place[row].lead_z = 0.0;
        s->end_x = s->wx, s->end_y = s->wy, s->end_z = s->wz;
    }
}

/// Before the start forces were as at the start.
static void remember_loads(pls_bodies *b)
{
    for (size_t row = 0; row < b->count; ++row)
    {
        const pls_body_load *l = &b->load[row];
        b->before[row] = (pls_body_before){(float)l->fx, (float)l->fy, (float)l->fz, 0.0f, (float)l->tx, (float)l->ty, (float)l->tz, 0.0f};
    }
}

pls_status pls_world_prepare(pls_world *world)
{
    if (world->prepared) return world->work_count >= pls_threads() ? PLS_OK : reserve_work(world);
    PLS_TRY(reserve_work(world));
    PLS_TRY(pls_measure_extent(world));
    pls_domain_at(&world->domain, world->time);
    PLS_TRY(pls_states_apply(world));
    PLS_TRY(pls_special_start(world));
    PLS_TRY(pls_neighbours_refresh(world));
    PLS_TRY(pls_choose_step(world));
    stand_still(&world->bodies);
    PLS_TRY(sweep_world(world, 0.0, world->time, false));
    PLS_TRY(pls_guard_overlap(world));
    remember_loads(&world->bodies);
    world->prepared = true;
    return pls_guard_finite(world);
}
