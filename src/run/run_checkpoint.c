// run_checkpoint.c -- the checkpoints of a run in progress.
//
// Lines of a checkpoint's run text that belong to the run itself (recorder.c adds the others):
//     end 1                    the run is to go to this time [s]
//     scheduled_before 1000    step of the scheduled checkpoint before this one, if there was one

#include "run/run_state.h"

#include "base/atomic_file.h"
#include "base/clock.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool pls_run_has_checkpoint_schedule(const pls_run *run)
{
    for (size_t k = 0; k < run->recorder.count; ++k)
    {
        if (run->recorder.output[k].def->kind == PLS_OBSERVE_CHECKPOINT) return true;
    }
    return false;
}

bool pls_run_checkpoint_due(const pls_run *run, uint64_t step, double time, double dt)
{
    if (step == 0) return true;
    for (size_t k = 0; k < run->recorder.count; ++k)
    {
        const pls_observer_def *def = run->recorder.output[k].def;
        if (def->kind == PLS_OBSERVE_CHECKPOINT && pls_schedule_due(&def->schedule, step, time, dt)) return true;
    }
    return false;
}

static pls_status describe(pls_run *run, pls_text *text)
{
    char number[32];
    PLS_TRY(pls_text_print(text, "end %s\n", pls_format_double(number, run->end)));
    uint64_t before = run->scheduled[run->scheduled[0] == pls_world_step_number(run->world)];
    if (before != PLS_NO_STEP) PLS_TRY(pls_text_print(text, "scheduled_before %" PRIu64 "\n", before));
    return pls_recorder_describe(&run->recorder, text);
}

static void note_scheduled(pls_run *run, uint64_t step)
{
    if (run->scheduled[0] == step) return;
    run->scheduled[1] = run->scheduled[0];
    run->scheduled[0] = step;
}

pls_status pls_run_save(pls_run *run, bool scheduled)
{
    uint64_t step = pls_world_step_number(run->world);
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(path, run->directory.path, "checkpoint"));
    PLS_TRY(pls_make_directory(path));
    PLS_TRY(pls_checkpoint_path(path, run->directory.path, step));
    pls_text text = {0};
    pls_status status = describe(run, &text);
    if (status == PLS_OK) status = pls_checkpoint_write(path, run->world, pls_scene_hash(run->scene), text.data);
    pls_text_free(&text);
    PLS_TRY(status);
    if (scheduled) note_scheduled(run, step);
    run->saved_step = step;
    run->wall_saved = pls_clock();
    PLS_TRY(pls_checkpoint_prune(run->directory.path, 2, run->scheduled));
    pls_run_event(run, "checkpoint written at t = %.6g s", pls_world_time(run->world));
    return PLS_OK;
}

pls_status pls_run_keep_scheduled(pls_run *run) { return pls_checkpoint_prune(run->directory.path, 0, run->scheduled); }

double pls_run_end_of(const pls_checkpoint *checkpoint, const pls_scene *scene)
{
    const char *line = checkpoint->run;
    const char *entry = pls_run_text_find(&line, "end");
    char number[32] = "";
    if (entry) snprintf(number, sizeof number, "%.*s", (int)strcspn(entry, "\n"), entry);
    double end;
    return pls_parse_double(number, &end) ? end : pls_scene_end_time(scene);
}

void pls_run_recall_checkpoints(pls_run *run, const pls_checkpoint *checkpoint, bool last)
{
    const pls_persist_header *header = &checkpoint->header;
    const char *line = checkpoint->run;
    const char *entry = pls_run_text_find(&line, "scheduled_before");
    run->scheduled[0] = entry ? strtoull(entry, NULL, 10) : PLS_NO_STEP;
    run->scheduled[1] = PLS_NO_STEP;
    if (last || pls_run_checkpoint_due(run, header->step, header->time, header->dt)) note_scheduled(run, header->step);
    run->saved_step = header->step;
}
