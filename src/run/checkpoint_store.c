// checkpoint_store.c -- see checkpoint_store.h.

#include "run/checkpoint_store.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static pls_status add_checkpoint(void *context, const char *path, const char *name)
{
    (void)path;
    pls_checkpoint_list *list = context;
    size_t digits = strspn(name, "0123456789");
    if (digits < 9 || digits > 19 || strcmp(name + digits, ".h5") != 0) return PLS_OK;
    PLS_TRY(pls_reserve(&list->step, &list->capacity, list->count + 1, sizeof *list->step, "the list of checkpoints"));
    list->step[list->count++] = strtoull(name, NULL, 10);
    return PLS_OK;
}

static int compare_newest_first(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a;
    uint64_t y = *(const uint64_t *)b;
    return (x < y) - (x > y);
}

pls_status pls_checkpoint_list_make(pls_checkpoint_list *list, const char *directory)
{
    pls_status status = pls_run_each_file(directory, "checkpoint", add_checkpoint, list);
    if (list->count > 1) qsort(list->step, list->count, sizeof *list->step, compare_newest_first);
    if (status != PLS_OK) pls_checkpoint_list_free(list);
    return status;
}

void pls_checkpoint_list_free(pls_checkpoint_list *list)
{
    pls_release(&list->step);
    *list = (pls_checkpoint_list){0};
}

pls_status pls_checkpoint_path(char path[PLS_PATH_SIZE], const char *directory, uint64_t step)
{
    return pls_run_path(path, directory, "checkpoint/%09" PRIu64 ".h5", step);
}

pls_status pls_checkpoint_set_aside(const char *directory, uint64_t step)
{
    char path[PLS_PATH_SIZE];
    char aside[PLS_PATH_SIZE];
    PLS_TRY(pls_checkpoint_path(path, directory, step));
    PLS_TRY(pls_run_path(aside, directory, "checkpoint/%09" PRIu64 ".h5.set-aside", step));
    if (rename(path, aside) == 0) return PLS_OK;
    return pls_fail(PLS_IO, "cannot rename \"%s\": %s", path, strerror(errno));
}

pls_status pls_checkpoint_prune(const char *directory, size_t newest, const uint64_t keep[2])
{
    pls_checkpoint_list list = {0};
    PLS_TRY(pls_checkpoint_list_make(&list, directory));
    pls_status status = PLS_OK;
    for (size_t k = newest; k < list.count && status == PLS_OK; ++k)
    {
        if (list.step[k] == keep[0] || list.step[k] == keep[1]) continue;
        char path[PLS_PATH_SIZE];
        status = pls_checkpoint_path(path, directory, list.step[k]);
        if (status == PLS_OK) status = pls_run_remove(path);
    }
    pls_checkpoint_list_free(&list);
    return status;
}
