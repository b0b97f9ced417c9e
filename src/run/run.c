// run.c -- carrying out a scene: look, save, step, until the end.
//
// The order within a step is what makes resuming exact: first all observers look, then the checkpoint notes how long their files are.

#include "run/run_state.h"

#include "base/atomic_file.h"
#include "base/clock.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/// Marks a definition made by pls_default_run_def().
static const uint32_t run_def_cookie = 0x52554e31;

/// Progress is told this often [s].
static const double report_interval = 0.2;

/// Without a schedule in the scene a checkpoint is written this often [s]; also the most work that is lost when the machine stops.
static const double save_interval = 60;

/// Wall time between looks at the interrupt flag and the clock, about [s].
static const double look_interval = 0.05;

/// The end is reached when less than this fraction of a step is missing: multiples of dt and the end time differ by round-off.
static const double end_tolerance = 1e-6;

pls_run_def pls_default_run_def(void) { return (pls_run_def){.until = NAN, .cookie = run_def_cookie}; }

pls_status pls_run_check_def(const pls_run_def *def)
{
    if (!def || def->cookie != run_def_cookie)
        return pls_fail(PLS_INVALID_ARGUMENT, "the run definition was not made by pls_default_run_def()");
    if (!def->directory || !*def->directory) return pls_fail(PLS_INVALID_ARGUMENT, "a run needs the name of its directory");
    if (isinf(def->until) || def->until < 0)
        return pls_fail(PLS_INVALID_ARGUMENT, "the end time is %g s; it must be a number that is not negative", def->until);
    if (def->observer_count > 0 && !def->observers)
        return pls_fail(PLS_INVALID_ARGUMENT, "there are %zu further observers, but no list of them", def->observer_count);
    return PLS_OK;
}

void pls_run_free(pls_run *run)
{
    pls_recorder_free(&run->recorder);
    pls_world_destroy(run->world);
    pls_run_directory_close(&run->directory);
    *run = (pls_run){0};
}

bool pls_run_reached(double time, double dt, double end) { return time >= end - end_tolerance * dt; }

// ---- telling -------------------------------------------------------------------------------------------------------

static void tell(pls_run *run, const char *event)
{
    if (!run->def->progress) return;
    pls_progress progress = {.end = run->end, .event = event};
    double now = pls_clock();
    run->wall_report = now;
    if (run->world)
    {
        progress.time = pls_world_time(run->world);
        progress.step = pls_world_step_number(run->world);
        double dt = pls_world_dt(run->world);
        double left = dt > 0 && run->end > progress.time ? ceil((run->end - progress.time) / dt - end_tolerance) : 0;
        progress.steps = progress.step + (uint64_t)fmin(left, 1e18);
        progress.bodies = pls_world_body_count(run->world);
        progress.contacts = pls_world_contact_count(run->world);
        double done = (double)(progress.step - run->first_step);
        progress.wall = run->wall_start > 0 ? now - run->wall_start : 0;
        progress.remaining = done > 0 ? progress.wall / done * left : 0;
    }
    run->def->progress(run->def->context, &progress);
}

void pls_run_event(pls_run *run, const char *format, ...)
{
    char event[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(event, sizeof event, format, arguments);
    va_end(arguments);
    tell(run, event);
}

// ---- making --------------------------------------------------------------------------------------------------------

pls_status pls_run_build(pls_run *run)
{
    pls_recorder_free(&run->recorder);
    pls_world_destroy(run->world);
    run->world = NULL;
    return pls_scene_build(run->scene, &run->world);
}

pls_status pls_run_watch(pls_run *run)
{
    size_t count;
    const pls_observer_def *observers = pls_scene_observers(run->scene, &count);
    return pls_recorder_init(&run->recorder, run->def->directory, run->world, observers, count, run->def->observers,
                             run->def->observer_count);
}

static pls_status write_used_scene(const pls_run *run)
{
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(path, run->directory.path, "scene.used.yaml"));
    char *text;
    PLS_TRY(pls_scene_used_text(run->scene, &text));
    pls_status status = pls_write_file(path, text, strlen(text));
    pls_scene_free_text(text);
    return status;
}

/// The world is made before the folder is touched: a wrong scene leaves nothing behind.
static pls_status make_run(pls_run *run)
{
    if (!run->def->overwrite) PLS_TRY(pls_run_directory_check_free(run->def->directory));
    PLS_TRY(pls_run_build(run));
    PLS_TRY(pls_world_prepare(run->world));
    PLS_TRY(pls_run_watch(run));
    PLS_TRY(pls_run_directory_open(&run->directory, run->def->directory, true));
    if (!run->def->overwrite) PLS_TRY(pls_run_directory_check_free(run->def->directory)); // now under the lock
    PLS_TRY(pls_run_directory_clear(&run->directory, true));
    return write_used_scene(run);
}

// ---- stepping ------------------------------------------------------------------------------------------------------

static bool is_interrupted(const pls_run *run) { return run->def->interrupt && *run->def->interrupt; }

static pls_status stop_interrupted(pls_run *run)
{
    if (run->saved_step != pls_world_step_number(run->world)) PLS_TRY(pls_run_save(run, false));
    return pls_fail(PLS_INTERRUPTED, "interrupted at t = %.6g s, a checkpoint is written; go on with: particls resume %s",
                    pls_world_time(run->world), run->def->directory);
}

static bool is_at_end(const pls_run *run) { return pls_run_reached(pls_world_time(run->world), pls_world_dt(run->world), run->end); }

/// The last checkpoint is written by finish().
static pls_status save_if_due(pls_run *run)
{
    pls_world *world = run->world;
    if (is_at_end(run)) return PLS_OK;
    if (pls_run_checkpoint_due(run, pls_world_step_number(world), pls_world_time(world), pls_world_dt(world)))
        return pls_run_save(run, true);
    bool wait_is_over = pls_clock() - run->wall_saved > save_interval;
    return wait_is_over && !pls_run_has_checkpoint_schedule(run) ? pls_run_save(run, false) : PLS_OK;
}

static pls_status begin(pls_run *run)
{
    PLS_TRY(pls_recorder_start(&run->recorder));
    PLS_TRY(pls_recorder_look(&run->recorder, run->world));
    return pls_run_save(run, true);
}

/// Steps until somebody looks: an observer, a checkpoint or the end; at most as many as pass in `look_interval`.
static uint64_t steps_until_look(const pls_run *run, double step_wall)
{
    uint64_t step = pls_world_step_number(run->world),
             most = step_wall > 0.0 ? (uint64_t)fmin(fmax(look_interval / step_wall, 1.0), 64.0) : 1;
    double dt = pls_world_dt(run->world);
    uint64_t k = 1;
    for (; k < most; ++k)
    {
        double time = (double)(step + k) * dt;
        if (pls_run_reached(time, dt, run->end) || pls_recorder_due(&run->recorder, step + k, time, dt) ||
            pls_run_checkpoint_due(run, step + k, time, dt))
            break;
    }
    return k;
}

static pls_status step_to_end(pls_run *run)
{
    double step_wall = 0.0;
    while (!is_at_end(run))
    {
        if (is_interrupted(run)) return stop_interrupted(run);
        double start = pls_clock();
        uint64_t steps = steps_until_look(run, step_wall);
        const pls_status stepped = pls_world_run(run->world, steps);
        run->broken = stepped != PLS_OK;
        PLS_TRY(stepped);
        step_wall = (pls_clock() - start) / (double)steps;
        PLS_TRY(pls_recorder_look(&run->recorder, run->world));
        PLS_TRY(save_if_due(run));
        if (pls_clock() - run->wall_report > report_interval) tell(run, NULL);
    }
    return PLS_OK;
}

/// The summary comes before the checkpoint: a run whose last checkpoint is there is complete, and one that was killed before it steps to the end again.
static pls_status finish(pls_run *run)
{
    PLS_TRY(pls_run_write_summary(run, PLS_OK));
    PLS_TRY(pls_run_save(run, true));
    return pls_run_keep_scheduled(run);
}

pls_status pls_run_carry_out(pls_run *run, bool from_start)
{
    run->first_step = pls_world_step_number(run->world);
    run->wall_start = run->wall_saved = pls_clock();
    tell(run, NULL);
    pls_status outcome = from_start ? begin(run) : PLS_OK;
    if (outcome == PLS_OK) outcome = step_to_end(run);
    if (outcome == PLS_OK) outcome = finish(run);
    if (outcome != PLS_OK)
    {
        char reason[2048];
        snprintf(reason, sizeof reason, "%s", pls_last_message());
        pls_run_write_summary(run, outcome); // should that fail too, the first failure is the one to tell
        return pls_fail(outcome, "%s", reason);
    }
    tell(run, NULL);
    return PLS_OK;
}

pls_status pls_run_scene(pls_scene *scene, const pls_run_def *def)
{
    PLS_TRY(pls_run_check_def(def));
    pls_run run = {.def = def, .scene = scene, .scheduled = {PLS_NO_STEP, PLS_NO_STEP}, .saved_step = PLS_NO_STEP};
    run.end = isnan(def->until) ? pls_scene_end_time(scene) : def->until;
    pls_status status = make_run(&run);
    if (status == PLS_OK) status = pls_run_carry_out(&run, true);
    pls_run_free(&run);
    return status;
}
