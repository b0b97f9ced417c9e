// run_state.h -- a run in progress, shared by the files of this folder.
#ifndef PLS_RUN_RUN_STATE_H
#define PLS_RUN_RUN_STATE_H

#include "run/checkpoint_store.h"
#include "run/recorder.h"

#include <particls/run.h>

/// Zero-initialise; `pls_run_free` releases.
typedef struct pls_run
{
    const pls_run_def *def; ///< not owned
    pls_scene *scene;       ///< not owned
    pls_run_directory directory;
    pls_world *world;
    pls_recorder recorder;
    double end;                                 ///< [s]
    uint64_t scheduled[2];                      ///< steps of the newest scheduled checkpoint and of the one before, PLS_NO_STEP: none
    uint64_t saved_step;                        ///< of the newest checkpoint
    bool broken;                                ///< a step failed within, so that nothing that is known of the world belongs to one moment
    uint64_t first_step;                        ///< where this process began
    double wall_start, wall_report, wall_saved; ///< pls_clock() at the first step, the last report and the last checkpoint [s]
} pls_run;

/// INVALID_ARGUMENT when the definition is not one.
pls_status pls_run_check_def(const pls_run_def *def);
void pls_run_free(pls_run *run);

/// Make the world, in place of an earlier one.
pls_status pls_run_build(pls_run *run);
/// Make the recorder on the world.
pls_status pls_run_watch(pls_run *run);

/// Step to the end and leave the summary, whatever happens on the way. `from_start`: with the first look and the first checkpoint.
pls_status pls_run_carry_out(pls_run *run, bool from_start);

/// Has the run come to its end? A pure function of the state, so that a resumed run ends at the same step.
bool pls_run_reached(double time, double dt, double end);

/// Tell the caller of something.
void pls_run_event(pls_run *run, const char *format, ...) __attribute__((format(printf, 2, 3)));

/// Write a checkpoint of this step; `scheduled` as checkpoint_store.h says.
pls_status pls_run_save(pls_run *run, bool scheduled);
/// Does the scene's schedule ask for a checkpoint at this step?
bool pls_run_checkpoint_due(const pls_run *run, uint64_t step, double time, double dt);
/// Are there schedules of checkpoints at all?
bool pls_run_has_checkpoint_schedule(const pls_run *run);
/// Keep only the last two scheduled checkpoints.
pls_status pls_run_keep_scheduled(pls_run *run);
/// The time [s] that the checkpoint's run was to go to.
double pls_run_end_of(const pls_checkpoint *checkpoint, const pls_scene *scene);
/// Take over which checkpoints were written; `last`: this is that of the end, else the recorder must be there.
void pls_run_recall_checkpoints(pls_run *run, const pls_checkpoint *checkpoint, bool last);

/// Write summary.json. `outcome` is how stepping ended.
pls_status pls_run_write_summary(pls_run *run, pls_status outcome);
/// Does DIR hold the summary of a finished run?
bool pls_run_summary_says_finished(const char *directory);

#endif
