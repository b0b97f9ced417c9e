// resume.c -- particls resume: go on with a run.

#include "progress.h"

enum { UNTIL, THREADS, QUIET };

static const cli_option options[] = {
    [UNTIL] = {"until", 'u', "T", "end at this time [s] (default: the end the run had)"},
    [THREADS] = {"threads", 't', "N", "threads to use (default: all processors); results do not depend on it"},
    [QUIET] = {"quiet", 'q', NULL, "print nothing but errors"},
    {0},
};

static int run(int argc, char **argv)
{
    pls_run_def def = pls_default_run_def();
    bool quiet = false;
    const char *value;
    int option;
    while ((option = cli_next_option(&cli_resume, argc, argv, &value)) != CLI_NO_MORE)
    {
        if (option == CLI_HELP) return CLI_DONE;
        if (option == CLI_WRONG) return CLI_USAGE;
        if (option == UNTIL && !cli_read_time(&cli_resume, "--until", value, &def.until)) return CLI_USAGE;
        if (option == THREADS && !cli_set_threads(&cli_resume, value)) return CLI_USAGE;
        if (option == QUIET) quiet = true;
    }
    def.directory = cli_only_argument(&cli_resume, argc, argv, "run directory");
    if (!def.directory) return CLI_USAGE;
    cli_progress progress;
    cli_progress_start(&progress, &def, quiet);
    return cli_progress_end(&progress, pls_run_resume(&def), def.directory);
}

const cli_verb cli_resume = {
    .name = "resume",
    .arguments = "DIR",
    .summary = "go on with a run that was stopped or killed",
    .about = "Goes on from the newest good checkpoint of the run directory, or from the start when there is none. Series and frames are\n"
             "cut back to the checkpoint first: the results are those of a run that was never stopped.",
    .example = "  particls resume scene.run --until 3",
    .options = options,
    .function = run,
};
