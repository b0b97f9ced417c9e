// progress.h -- running with progress, Ctrl-C and the closing words: what `run` and `resume` share.
#ifndef PLS_CLI_PROGRESS_H
#define PLS_CLI_PROGRESS_H

#include "cli.h"

typedef struct cli_progress
{
    bool quiet;
    bool terminal;  ///< the standard output is one
    bool line_open; ///< the rewriting line is on the screen
    bool begun;     ///< stepping has begun
    uint64_t first_step;
    double last_plain; ///< wall time of the last plain line [s]
    pls_progress last;
} cli_progress;

/// Fill in what `def` needs for progress and Ctrl-C (first: a checkpoint and a clean end; second: killed).
void cli_progress_start(cli_progress *progress, pls_run_def *def, bool quiet);
/// Closing words; returns the exit code for `status`.
int cli_progress_end(cli_progress *progress, pls_status status, const char *directory);

#endif
