// run.c -- particls run: carry out a scene.

#include "progress.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

enum { OUTPUT, SET, THREADS, UNTIL, OVERWRITE, QUIET };

static const cli_option options[] = {
    [OUTPUT] = {"output", 'o', "DIR", "run directory (default: the scene's name with .run, in the current folder)"},
    [SET] = {"set", 's', "PATH=VALUE", "change a value of the scene, such as vars.kn=30 or time.end=2; may be repeated"},
    [THREADS] = {"threads", 't', "N", "threads to use (default: all processors); results do not depend on it"},
    [UNTIL] = {"until", 'u', "T", "end at this time [s] (default: time.end of the scene)"},
    [OVERWRITE] = {"overwrite", 0, NULL, "replace the results of an earlier run in DIR"},
    [QUIET] = {"quiet", 'q', NULL, "print nothing but errors"},
    {0},
};

enum { MAX_OVERRIDES = 256, PATH_SIZE = 4096 };

typedef struct arguments
{
    const char *scene;
    const char *output;
    const char *overrides[MAX_OVERRIDES + 1]; ///< one more for --until
    size_t override_count;
    char until[64]; ///< as an override: so it stands in scene.used.yaml, and a resumed run keeps it
    bool overwrite, quiet;
} arguments;

static int read_option(arguments *a, int option, const char *value)
{
    double until;
    switch (option)
    {
        case OUTPUT: a->output = value; break;
        case SET:
            if (!strchr(value, '=')) return cli_wrong_usage(&cli_run, "--set takes PATH=VALUE, such as vars.kn=30, not '%s'", value);
            if (a->override_count == MAX_OVERRIDES) return cli_wrong_usage(&cli_run, "--set may be given %d times at most", MAX_OVERRIDES);
            a->overrides[a->override_count++] = value;
            break;
        case THREADS: return cli_set_threads(&cli_run, value) ? CLI_DONE : CLI_USAGE;
        case UNTIL:
            if (!cli_read_time(&cli_run, "--until", value, &until)) return CLI_USAGE;
            snprintf(a->until, sizeof a->until, "time.end=%.17g", until);
            break;
        case OVERWRITE: a->overwrite = true; break;
        case QUIET: a->quiet = true; break;
        default: return CLI_USAGE;
    }
    return CLI_DONE;
}

/// "a/b/scene.yaml" -> "scene.run"
static void default_output(char output[PATH_SIZE], const char *scene)
{
    const char *slash = strrchr(scene, '/');
    const char *name = slash ? slash + 1 : scene;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    snprintf(output, PATH_SIZE, "%.*s.run", (int)(length < 200 ? length : 200), name);
}

static int carry_out(arguments *a)
{
    char output[PATH_SIZE];
    default_output(output, a->scene);
    if (!a->output) a->output = output;
    if (a->until[0]) a->overrides[a->override_count++] = a->until;
    pls_scene *scene = NULL;
    if (pls_scene_load(a->scene, a->overrides, a->override_count, &scene) != PLS_OK) return cli_failed(CLI_USAGE);
    pls_run_def def = pls_default_run_def();
    def.directory = a->output;
    def.overwrite = a->overwrite;
    cli_progress progress;
    cli_progress_start(&progress, &def, a->quiet);
    pls_status status = pls_run_scene(scene, &def);
    pls_scene_free(scene);
    return cli_progress_end(&progress, status, a->output);
}

static int run(int argc, char **argv)
{
    arguments a = {0};
    const char *value;
    int option;
    while ((option = cli_next_option(&cli_run, argc, argv, &value)) != CLI_NO_MORE)
    {
        if (option == CLI_HELP) return CLI_DONE;
        if (option == CLI_WRONG || read_option(&a, option, value) != CLI_DONE) return CLI_USAGE;
    }
    a.scene = cli_only_argument(&cli_run, argc, argv, "scene file");
    return a.scene ? carry_out(&a) : CLI_USAGE;
}

const cli_verb cli_run = {
    .name = "run",
    .arguments = "SCENE",
    .summary = "carry out a scene into a run directory",
    .about = "Carries out the scene file and writes series, frames, checkpoints and a summary into the run directory.\n"
             "Ctrl-C writes a checkpoint and ends; particls resume goes on. Pressed twice, it ends at once.",
    .example = "  particls run examples/two-spheres/scene.yaml -o out --set time.end=2 --threads 2",
    .options = options,
    .function = run,
};
