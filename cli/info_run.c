// info_run.c -- particls info on a run directory.

#include "info.h"

#include "base/alloc.h"
#include "base/atomic_file.h"
#include "run/run_state.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Sorted names of the files of a folder with one suffix.
typedef struct file_list
{
    const char *suffix;
    char **path;
    size_t count, capacity;
} file_list;

static pls_status add_file(void *context, const char *path, const char *name)
{
    file_list *list = context;
    if (!info_has_suffix(name, list->suffix)) return PLS_OK;
    PLS_TRY(pls_reserve(&list->path, &list->capacity, list->count + 1, sizeof *list->path, "a list of files"));
    PLS_TRY(pls_copy_text(&list->path[list->count], path, "a file name"));
    ++list->count;
    return PLS_OK;
}

static int compare_names(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

static bool list_files(file_list *list, const char *directory, const char *folder)
{
    if (pls_run_each_file(directory, folder, add_file, list) != PLS_OK) return false;
    if (list->count > 1) qsort(list->path, list->count, sizeof *list->path, compare_names);
    return true;
}

static void free_files(file_list *list)
{
    for (size_t k = 0; k < list->count; ++k) pls_release(&list->path[k]);
    pls_release(&list->path);
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static void print_series(const char *directory)
{
    file_list list = {.suffix = ".csv"};
    if (!list_files(&list, directory, "series")) cli_failed(CLI_FAILED);
    printf("series             %9zu\n", list.count);
    for (size_t k = 0; k < list.count; ++k)
    {
        info_series series;
        if (info_read_series(list.path[k], &series))
            printf("  %-24s %7zu rows: %s\n", base_name(list.path[k]), series.rows, series.first);
        else
            cli_failed(CLI_FAILED);
    }
    free_files(&list);
}

static size_t count_text(const char *text, const char *word)
{
    size_t count = 0;
    while ((text = strstr(text, word)))
    {
        ++count;
        text += strlen(word);
    }
    return count;
}

static void print_frames(const char *directory)
{
    file_list list = {.suffix = ".pvd"};
    if (!list_files(&list, directory, "frames")) cli_failed(CLI_FAILED);
    printf("frame collections  %9zu\n", list.count);
    for (size_t k = 0; k < list.count; ++k)
    {
        char *text;
        size_t size;
        if (pls_read_file(list.path[k], &text, &size) != PLS_OK)
        {
            cli_failed(CLI_FAILED);
            continue;
        }
        printf("  %-24s %7zu frames\n", base_name(list.path[k]), count_text(text, "<DataSet "));
        pls_release(&text);
    }
    free_files(&list);
}

/// The newest good checkpoint.
typedef struct newest
{
    double time; ///< [s], NaN when there is none
    bool at_end; ///< of what was asked for
} newest;

/// Newest first.
static void print_checkpoints(const char *directory, const pls_scene *scene, newest *good)
{
    pls_checkpoint_list list = {0};
    *good = (newest){.time = NAN};
    if (pls_checkpoint_list_make(&list, directory) != PLS_OK) cli_failed(CLI_FAILED);
    printf("checkpoints        %9zu\n", list.count);
    for (size_t k = 0; k < list.count; ++k)
    {
        char path[PLS_PATH_SIZE];
        pls_checkpoint checkpoint = {0};
        if (pls_checkpoint_path(path, directory, list.step[k]) != PLS_OK || pls_checkpoint_open(&checkpoint, path) != PLS_OK)
        {
            printf("  step %-18" PRIu64 " %s\n", list.step[k], pls_last_message());
            continue;
        }
        printf("  %-24s t = %.9g s, good\n", base_name(path), checkpoint.header.time);
        if (isnan(good->time))
        {
            double end = pls_run_end_of(&checkpoint, scene);
            *good = (newest){checkpoint.header.time, pls_run_reached(checkpoint.header.time, checkpoint.header.dt, end)};
        }
        pls_checkpoint_close(&checkpoint);
    }
    pls_checkpoint_list_free(&list);
}

static int describe(const char *directory, const pls_scene *scene)
{
    const char *title = pls_scene_title(scene);
    newest good;
    printf("run directory      %s\n", directory);
    if (title && *title) printf("title              %s\n", title);
    print_series(directory);
    print_frames(directory);
    print_checkpoints(directory, scene, &good);
    if (!isnan(good.time)) printf("saved up to        t = %.9g s\n", good.time);
    bool finished = good.at_end && pls_run_summary_says_finished(directory);
    printf("state              %s\n", finished ? "finished" : "not finished: particls resume goes on");
    return CLI_DONE;
}

int info_describe_run(const char *directory)
{
    char path[PLS_PATH_SIZE];
    pls_scene *scene = NULL;
    if (pls_run_path(path, directory, "scene.used.yaml") != PLS_OK) return cli_failed(CLI_USAGE);
    if (!pls_file_exists(path))
    {
        fprintf(stderr, "particls: \"%s\" is no run directory: there is no scene.used.yaml in it\n", directory);
        return CLI_USAGE;
    }
    if (pls_scene_load(path, NULL, 0, &scene) != PLS_OK) return cli_failed(CLI_FAILED);
    int code = describe(directory, scene);
    pls_scene_free(scene);
    return code;
}
