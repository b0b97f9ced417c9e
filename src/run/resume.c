// resume.c -- going on with a run from its newest good checkpoint.
//
// A checkpoint is good when its bytes are what was written, the scene is the same, and the series are at least as long as they were. If it is not, the
// next older one is tried. Only when one was found are the others set aside: nothing is lost by trying.

#include "run/run_state.h"

#include "base/atomic_file.h"

static pls_status load_scene(const char *directory, pls_scene **scene)
{
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(path, directory, "scene.used.yaml"));
    if (!pls_file_exists(path))
    {
        return pls_fail(PLS_NOT_FOUND, "no run has begun in \"%s\" (there is no scene.used.yaml in it): start it with particls run",
                        directory);
    }
    return pls_scene_load(path, NULL, 0, scene);
}

/// True when there is nothing to do: the checkpoint is that of the end, and the summary is there.
static bool is_finished(pls_run *run, const pls_checkpoint *checkpoint)
{
    return pls_run_reached(checkpoint->header.time, checkpoint->header.dt, run->end) && pls_run_summary_says_finished(run->directory.path);
}

static pls_status restore(pls_run *run, const pls_checkpoint *checkpoint)
{
    if (checkpoint->scene_hash != pls_scene_hash(run->scene))
    {
        return pls_fail(PLS_CORRUPT, "\"%s/scene.used.yaml\" is not the scene \"%s\" was written for: one of them was changed",
                        run->directory.path, checkpoint->path);
    }
    PLS_TRY(pls_run_build(run));
    PLS_TRY(pls_checkpoint_restore(checkpoint, run->world));
    PLS_TRY(pls_run_watch(run));
    PLS_TRY(pls_recorder_resume(&run->recorder, checkpoint->run));
    pls_run_recall_checkpoints(run, checkpoint, false);
    return PLS_OK;
}

static pls_status try_checkpoint(pls_run *run, uint64_t step, bool *finished)
{
    char path[PLS_PATH_SIZE];
    pls_checkpoint checkpoint = {0};
    PLS_TRY(pls_checkpoint_path(path, run->directory.path, step));
    PLS_TRY(pls_checkpoint_open(&checkpoint, path));
    run->end = isnan(run->def->until) ? pls_run_end_of(&checkpoint, run->scene) : run->def->until;
    *finished = is_finished(run, &checkpoint);
    pls_status status = PLS_OK;
    if (*finished)
        pls_run_recall_checkpoints(run, &checkpoint, true);
    else
        status = restore(run, &checkpoint);
    pls_checkpoint_close(&checkpoint);
    return status;
}

/// Restore the newest good checkpoint; `*tried` counts those passed over.
static pls_status restore_newest(pls_run *run, const pls_checkpoint_list *list, size_t *tried, bool *finished)
{
    pls_status status = PLS_OK;
    for (*tried = 0; *tried < list->count; ++*tried)
    {
        status = try_checkpoint(run, list->step[*tried], finished);
        if (status != PLS_CORRUPT) return status;
        if (*tried + 1 < list->count) pls_run_event(run, "%s; trying the checkpoint before it", pls_last_message());
    }
    return pls_fail_context(
        status, "no checkpoint of \"%s\" can be used; start again with particls run --overwrite. The oldest: ", run->directory.path);
}

static pls_status go_on(pls_run *run, const pls_checkpoint_list *list)
{
    size_t tried = 0;
    bool finished = false;
    PLS_TRY(restore_newest(run, list, &tried, &finished));
    for (size_t k = 0; k < tried; ++k) PLS_TRY(pls_checkpoint_set_aside(run->directory.path, list->step[k]));
    if (finished)
    {
        pls_run_event(run, "the run in \"%s\" has finished at t = %.6g s; ask for a later end (--until) to go on", run->directory.path,
                      run->end);
        return pls_run_keep_scheduled(run); // in case it was killed just before that
    }
    pls_run_event(run, "going on from the checkpoint at t = %.6g s (step %llu)", pls_world_time(run->world),
                  (unsigned long long)pls_world_step_number(run->world));
    return pls_run_carry_out(run, false);
}

static pls_status start_over(pls_run *run)
{
    run->end = isnan(run->def->until) ? pls_scene_end_time(run->scene) : run->def->until;
    PLS_TRY(pls_run_build(run));
    PLS_TRY(pls_world_prepare(run->world));
    PLS_TRY(pls_run_watch(run));
    PLS_TRY(pls_run_directory_clear(&run->directory, false));
    pls_run_event(run, "no checkpoint had been written yet: starting from the beginning");
    return pls_run_carry_out(run, true);
}

static pls_status resume(pls_run *run)
{
    PLS_TRY(pls_run_directory_remove_temporaries(&run->directory));
    pls_checkpoint_list list = {0};
    PLS_TRY(pls_checkpoint_list_make(&list, run->directory.path));
    pls_status status = list.count > 0 ? go_on(run, &list) : start_over(run);
    pls_checkpoint_list_free(&list);
    return status;
}

pls_status pls_run_resume(const pls_run_def *def)
{
    PLS_TRY(pls_run_check_def(def));
    pls_run run = {.def = def, .scheduled = {PLS_NO_STEP, PLS_NO_STEP}, .saved_step = PLS_NO_STEP};
    pls_scene *scene = NULL;
    pls_status status = pls_run_directory_open(&run.directory, def->directory, false);
    if (status == PLS_OK) status = load_scene(def->directory, &scene);
    run.scene = scene;
    if (status == PLS_OK) status = resume(&run);
    pls_run_free(&run);
    pls_scene_free(scene);
    return status;
}
