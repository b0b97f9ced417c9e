// recorder.h -- what the observers of a run leave behind: series and frames, and how to cut them back to a checkpoint.
#ifndef PLS_RUN_RECORDER_H
#define PLS_RUN_RECORDER_H

#include "base/text.h"
#include "io/csv.h"
#include "observe/series.h"

/// One observer and its files.
typedef struct pls_recorder_output
{
    const pls_observer_def *def;
    pls_series series; ///< of an observer that has one
    double *values;    ///< room for a row: time, then the columns of `series`
    pls_csv csv;
    double *times; ///< of each frame written [s]
    size_t frames, frame_capacity;
} pls_recorder_output;

/// Zero-initialise; `pls_recorder_free` releases.
typedef struct pls_recorder
{
    const char *directory; ///< not owned
    pls_recorder_output *output;
    size_t count;
} pls_recorder;

/// Observers of the scene and of the caller; checks that their names are usable and unique. They must outlive the recorder.
pls_status pls_recorder_init(pls_recorder *recorder, const char *directory, pls_world *world, const pls_observer_def *scene,
                             size_t scene_count, const pls_observer_def *caller, size_t caller_count);
/// Begin all files anew.
pls_status pls_recorder_start(pls_recorder *recorder);
/// Cut all files back to what `run` (the text of a checkpoint) says and go on with them. CORRUPT when they are no longer what they were.
pls_status pls_recorder_resume(pls_recorder *recorder, const char *run);
/// True when an observer looks at this step.
bool pls_recorder_due(const pls_recorder *recorder, uint64_t step, double time, double dt);
/// Write what is due at this step.
pls_status pls_recorder_look(pls_recorder *recorder, pls_world *world);
/// Put all rows on the disk and add the lengths of series and the times of frames to `run`.
pls_status pls_recorder_describe(pls_recorder *recorder, pls_text *run);
void pls_recorder_free(pls_recorder *recorder);

/// Is it an observer with a series?
bool pls_recorder_has_series(const pls_recorder_output *output);

/// Find the first line of `run` that begins with the word `key`; what follows the word, or null. `*line` walks on from line to line: start with `run`.
const char *pls_run_text_find(const char **line, const char *key);

#endif
