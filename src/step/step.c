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
#include <string.h>

enum {
    GUARD_STEPS = 64,    ///< steps between looks at overlaps and lost bodies
    STABLE_STEPS = 4096, ///< steps between looks at the stable step
    SERIAL_BLOCKS = 4,   ///< a loop of no more blocks is not worth waking other threads for
    BODY_BLOCK = 256     ///< bodies per block: its rows stay in the second-level cache; at most PLS_FORCE_BATCH
};

static void find_contacts_and_forces(pls_world *world, double dt)
{
    pls_pair_list *list = &world->list;
    const pls_contact_input input = {.place = world->bodies.place,
                                     .spin = world->bodies.spin,
                                     .load = world->bodies.load,
                                     .before = world->bodies.before,
                                     .orientation = world->bodies.orientation,
                                     .domain = &world->domain,
                                     .laws = &world->laws,
                                     .large = world->bodies.count > PLS_LARGE_WORLD,
                                     .growing = world->state_count > 0,
                                     .dt = dt};
#pragma omp parallel for schedule(static) if (list->block_count > SERIAL_BLOCKS)
    for (size_t b = 0; b < list->block_count; ++b)
        PLS_SIMD_SELECT(pls_contact_block)(list, &input, &list->block[b], &world->work[omp_get_thread_num()]);
}

static pls_status finish_block(pls_world *world, size_t first, size_t last, double dt, double time, pls_drift_report *next)
{
    double force[4 * BODY_BLOCK] __attribute__((aligned(64))), torque[4 * BODY_BLOCK] __attribute__((aligned(64)));
    double scratch[PLS_FORCE_SCRATCH] __attribute__((aligned(64)));
    bool forced = world->force_count > 0;
    if (forced) PLS_TRY(pls_body_forces(world, first, last, time, scratch, force, torque));
    PLS_SIMD_SELECT(pls_verlet_finish)(&world->bodies, &world->list, first, last, dt, forced ? force : NULL, forced ? torque : NULL, next);
    return PLS_OK;
}

static void add_report(pls_drift_report *total, const pls_drift_report *part)
{
    if (part->largest_square > total->largest_square) total->largest_square = part->largest_square;
    total->poison += part->poison; // zeros, or NaN: no order to keep
}

static pls_status judge_drift(pls_world *world, const pls_drift_report *total)
{
    if (total->poison != 0.0 || isnan(total->poison)) PLS_TRY(pls_guard_finite(world));
    pls_neighbours_moved(world, total->largest_square);
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
    return judge_drift(world, &total);
}

/// Gather forces and finish velocities; `time` is the instant of the forces. With `go_on` each body begins its next step at once, while its rows
/// are at hand.
static pls_status finish_bodies(pls_world *world, double dt, double time, bool go_on)
{
    pls_bodies *bodies = &world->bodies;
    pls_drift_report total = {0.0, 0.0};
    pls_status worst = PLS_OK;
    char message[512] = "";
#pragma omp parallel if (bodies->count > SERIAL_BLOCKS * BODY_BLOCK)
    {
        pls_drift_report mine = {0.0, 0.0}, part = {0.0, 0.0};
#pragma omp for schedule(static)
        for (size_t b = 0; b < pls_block_count(bodies->count, BODY_BLOCK); ++b)
        {
            size_t first = b * BODY_BLOCK, last = pls_block_end(b, BODY_BLOCK, bodies->count);
            pls_status status = finish_block(world, first, last, dt, time, go_on ? &part : NULL);
            add_report(&mine, &part);
            if (status == PLS_OK) continue;
#pragma omp critical(pls_finish_failure)
            {
                worst = status;
                strncpy(message, pls_last_message(), sizeof message - 1); // messages belong to threads; bring it to ours
            }
        }
#pragma omp critical(pls_drift_report)
        add_report(&total, &mine);
    }
    if (worst != PLS_OK) return pls_fail(worst, "%s", message);
    return go_on ? judge_drift(world, &total) : PLS_OK;
}

static pls_status check_step(pls_world *world)
{
    if (world->step % GUARD_STEPS == 0) PLS_TRY(pls_guard_step(world));
    if (world->step % STABLE_STEPS == 0) PLS_TRY(pls_check_stable_step(world));
    return PLS_OK;
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
    find_contacts_and_forces(world, world->dt);
    PLS_TRY(pls_book_parted(world));
    PLS_TRY(finish_bodies(world, world->dt, time, go_on));
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
    pls_release(&world->work);
    world->work_count = 0;
    PLS_TRY(pls_allocate(&world->work, (size_t)threads, sizeof *world->work, "work space of threads"));
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
    find_contacts_and_forces(world, 0.0);
    PLS_TRY(pls_guard_overlap(world));
    PLS_TRY(finish_bodies(world, 0.0, world->time, false));
    remember_loads(&world->bodies);
    world->prepared = true;
    return pls_guard_finite(world);
}
