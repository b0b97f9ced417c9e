// step.c -- one time step, read from top to bottom.
//
//     half kick, drift -> driven bodies -> states -> neighbours (if stale) -> contacts and laws -> body forces, gather, half kick -> damping -> guards
//
// The order differs from the picture in which states come last: forces at t + dt need states at t + dt, and after the drift the midpoint rates of everything
// that states depend on are known (state_rk2.c).

#include "step/world.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "step/sweep.h"
#include "step/timestep.h"

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

static pls_status check_step(pls_world *world)
{
    if (world->step % PLS_GUARD_STEPS == 0) PLS_TRY(pls_guard_step(world));
    bool due = world->step % PLS_STABLE_STEPS == 0 || (world->step % PLS_GUARD_STEPS == 0 && pls_stable_step_is_stale(world));
    return due ? pls_check_stable_step(world) : PLS_OK;
}

/// From the drift to the end of the step; `begun`: the next step's half kick and drift are done along. Steps that run into each other are done at once, up to
/// step `end`.
static pls_status complete_steps(pls_world *world, uint64_t end, bool *begun)
{
    PLS_TRY(pls_special_drift(world));
    PLS_TRY(pls_states_advance(world));
    PLS_TRY(pls_states_apply(world));
    pls_domain_at(&world->domain, (double)(world->step + 1) * world->dt);
    PLS_TRY(pls_neighbours_refresh(world));
    PLS_TRY(pls_sweep(world, world->dt, end, begun));
    if (*begun) return PLS_OK;
    pls_damp_locally(world);
    pls_special_finish(world);
    PLS_TRY(pls_relax(world));
    ++world->step;
    world->time = (double)world->step * world->dt;
    return check_step(world);
}

/// Half kick and drift.
static pls_status begin_step(pls_world *world)
{
    PLS_TRY(pls_relax_before(world));
    PLS_TRY(pls_special_before(world));
    pls_states_before(world);
    return pls_begin_bodies(world);
}

pls_status pls_step(pls_world *world)
{
    PLS_TRY(pls_world_prepare(world));
    PLS_TRY(begin_step(world));
    bool begun;
    return complete_steps(world, world->step + 1, &begun);
}

pls_status pls_world_run(pls_world *world, uint64_t steps)
{
    PLS_TRY(pls_world_prepare(world));
    const uint64_t end = world->step + steps;
    for (bool begun = false; world->step < end;)
    {
        if (!begun) PLS_TRY(begin_step(world));
        PLS_TRY(complete_steps(world, end, &begun));
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
    world->overlap_due = world->lost_due = 0.0;
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
    if (world->step == 0) PLS_TRY(pls_solid_walls_fit(&world->solids, &world->domain)); // later in the guard's steps, restarted or not
    PLS_TRY(pls_choose_step(world));
    stand_still(&world->bodies);
    bool begun;
    PLS_TRY(pls_sweep(world, 0.0, world->step, &begun));
    PLS_TRY(pls_guard_overlap(world));
    remember_loads(&world->bodies);
    world->prepared = true;
    return pls_guard_finite(world);
}
