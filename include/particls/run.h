/// @file run.h
/// Runs: a scene carried out into a run directory, safe against being killed at any instant.
///
///     DIR/scene.used.yaml   every value in force            DIR/series/NAME.csv   one per series observer, flushed per row
///     DIR/summary.json      machine-readable result         DIR/frames/NAME_000012.vtp, NAME.pvd
///     DIR/checkpoint/000001000.h5 (the last two)
#ifndef PARTICLS_RUN_H
#define PARTICLS_RUN_H

#include <particls/scene.h>
#include <particls/threads.h>

#ifdef __cplusplus
extern "C" {
#endif

/// How far a run is, for progress.
typedef struct pls_progress
{
    double time, end;     ///< [s]
    uint64_t step, steps; ///< done, expected in all
    double wall;          ///< since this process began stepping [s]
    double remaining;     ///< estimate [s]
    size_t bodies, contacts;
    const char *event; ///< null, or a line worth telling ("checkpoint written at t = 0.25 s")
} pls_progress;

/// Copy `pls_default_run_def()` and change what you need.
typedef struct pls_run_def
{
    const char *directory;                                         ///< run directory; made if missing
    bool overwrite;                                                ///< replace the results of an earlier run there; else it is an error
    double until;                                                  ///< end time in place of the scene's, NaN: the scene's
    void (*progress)(void *context, const pls_progress *progress); ///< may be null; called a few times a second
    void *context;
    const volatile int *interrupt;     ///< set it from a signal handler: a checkpoint is written and the run ends with INTERRUPTED
    const pls_observer_def *observers; ///< further observers (kind PLS_OBSERVE_USER and others), may be null
    size_t observer_count;
    uint32_t cookie;
} pls_run_def;

pls_run_def pls_default_run_def(void);

/// Carry out a scene from its start.
pls_status pls_run_scene(pls_scene *scene, const pls_run_def *def);
/// Go on from the newest good checkpoint of `def->directory`, or from the start when there is none yet. Series and frames are cut back to the checkpoint,
/// so that the results are those of a run that was never disturbed. A finished run is left as it is unless `until` asks for more.
pls_status pls_run_resume(const pls_run_def *def);

#ifdef __cplusplus
}
#endif
#endif
