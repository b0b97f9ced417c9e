// gallery.c -- from a path to the moments that can be drawn, and from a moment to its bodies. See gallery.h.

#include "run/gallery.h"

#include "base/registry.h"
#include "io/checkpoint.h"
#include "run/checkpoint_store.h"
#include "run/run_directory.h"
#include "scene/scene_data.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool has_suffix(const char *name, const char *suffix)
{
    size_t length = strlen(name), end = strlen(suffix);
    return length > end && strcmp(name + length - end, suffix) == 0;
}

static pls_status add_moment(pls_gallery *gallery, pls_moment_kind kind, const char *path, double time)
{
    PLS_TRY(pls_reserve(&gallery->moment, &gallery->capacity, gallery->count + 1, sizeof *gallery->moment, "the moments of a run"));
    pls_moment *moment = &gallery->moment[gallery->count];
    *moment = (pls_moment){.kind = kind, .time = time};
    PLS_TRY(pls_copy_text(&moment->path, path, "a file name"));
    ++gallery->count;
    return PLS_OK;
}

// ---- run directories --------------------------------------------------------------------------------------------------------------------

static pls_status load_used_scene(pls_gallery *gallery, const char *directory)
{
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(path, directory, "scene.used.yaml"));
    if (!pls_file_exists(path))
        return pls_fail(PLS_NOT_FOUND,
                        "\"%s\" is no run directory: there is no scene.used.yaml in it, which tells the shapes of bodies; give a run "
                        "directory, or a file of one where it was written",
                        directory);
    return pls_scene_load(path, NULL, 0, &gallery->scene);
}

/// Collections of frames; those of contacts hold no bodies.
typedef struct collections
{
    char **name;
    size_t count, capacity;
} collections;

static pls_status add_collection(void *context, const char *path, const char *name)
{
    (void)path;
    collections *list = context;
    if (!has_suffix(name, ".pvd") || has_suffix(name, ".contacts.pvd")) return PLS_OK;
    PLS_TRY(pls_reserve(&list->name, &list->capacity, list->count + 1, sizeof *list->name, "a list of files"));
    PLS_TRY(pls_copy_text(&list->name[list->count], name, "a file name"));
    list->name[list->count][strlen(name) - strlen(".pvd")] = '\0';
    ++list->count;
    return PLS_OK;
}

static int compare_names(const void *a, const void *b) { return strcmp(*(char *const *)a, *(char *const *)b); }

static void list_names(char *text, size_t size, const collections *list)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t k = 0; k < list->count && used < size; ++k)
        used += (size_t)snprintf(text + used, size - used, "%s%s", k ? ", " : "", list->name[k]);
}

/// The collection meant; null: there are none and none was asked for.
static pls_status choose_collection(const collections *list, const char *directory, const char *wanted, const char **name)
{
    char names[400];
    list_names(names, sizeof names, list);
    *name = !wanted && list->count == 1 ? list->name[0] : NULL;
    for (size_t k = 0; wanted && k < list->count; ++k)
    {
        if (strcmp(list->name[k], wanted) == 0) *name = list->name[k];
    }
    if (*name || (!wanted && list->count == 0)) return PLS_OK;
    if (!wanted) return pls_fail(PLS_INVALID_ARGUMENT, "\"%s\" holds several series of frames; say which one: %s", directory, names);
    return pls_fail(PLS_NOT_FOUND, "\"%s\" holds no frames named '%s'; there are: %s", directory, wanted, list->count ? names : "none");
}

/// `<DataSet timestep="0.05" ... file="pack_000001.vtp"/>`
static pls_status add_frame(pls_gallery *gallery, const char *directory, const char *element)
{
    static const char time_key[] = " timestep=\"", file_key[] = " file=\"";
    char number[32], file[PLS_PATH_SIZE], path[PLS_PATH_SIZE];
    double time;
    const char *t = strstr(element, time_key), *f = strstr(element, file_key);
    if (!t || !f) return pls_fail(PLS_CORRUPT, "a list of frames in \"%s/frames\" is damaged: run again or resume", directory);
    t += strlen(time_key);
    f += strlen(file_key);
    snprintf(number, sizeof number, "%.*s", (int)strcspn(t, "\""), t);
    snprintf(file, sizeof file, "%.*s", (int)strcspn(f, "\""), f);
    if (!pls_parse_double(number, &time))
        return pls_fail(PLS_CORRUPT, "a list of frames in \"%s/frames\" is damaged: run again or resume", directory);
    PLS_TRY(pls_run_path(path, directory, "frames/%s", file));
    return add_moment(gallery, PLS_MOMENT_FRAME, path, time);
}

static pls_status add_frames(pls_gallery *gallery, const char *directory, const char *name)
{
    char path[PLS_PATH_SIZE];
    char *text;
    size_t size;
    PLS_TRY(pls_run_path(path, directory, "frames/%s.pvd", name));
    PLS_TRY(pls_read_file(path, &text, &size));
    pls_status status = PLS_OK;
    for (const char *element = text; status == PLS_OK && (element = strstr(element, "<DataSet ")); ++element)
        status = add_frame(gallery, directory, element);
    pls_release(&text);
    return status;
}

static pls_status find_frames(pls_gallery *gallery, const char *directory)
{
    collections list = {0};
    const char *name = NULL;
    pls_status status = pls_run_each_file(directory, "frames", add_collection, &list);
    if (list.count > 1) qsort(list.name, list.count, sizeof *list.name, compare_names);
    if (status == PLS_OK) status = choose_collection(&list, directory, gallery->def.frames, &name);
    if (status == PLS_OK && name) status = add_frames(gallery, directory, name);
    for (size_t k = 0; k < list.count; ++k) pls_release(&list.name[k]);
    pls_release(&list.name);
    return status;
}

static pls_status add_checkpoint(pls_gallery *gallery, const char *path)
{
    pls_checkpoint checkpoint = {0};
    PLS_TRY(pls_checkpoint_open(&checkpoint, path));
    pls_status status = add_moment(gallery, PLS_MOMENT_CHECKPOINT, path, checkpoint.header.time);
    pls_checkpoint_close(&checkpoint);
    return status;
}

static pls_status find_checkpoints(pls_gallery *gallery, const char *directory)
{
    pls_checkpoint_list list = {0};
    PLS_TRY(pls_checkpoint_list_make(&list, directory));
    pls_status status = PLS_OK;
    for (size_t k = list.count; k > 0 && status == PLS_OK; --k) // newest first
    {
        char path[PLS_PATH_SIZE];
        status = pls_checkpoint_path(path, directory, list.step[k - 1]);
        if (status == PLS_OK) status = add_checkpoint(gallery, path);
    }
    pls_checkpoint_list_free(&list);
    return status;
}

static pls_status open_directory(pls_gallery *gallery, const char *directory)
{
    PLS_TRY(load_used_scene(gallery, directory));
    PLS_TRY(find_frames(gallery, directory));
    if (gallery->count == 0) PLS_TRY(find_checkpoints(gallery, directory));
    if (gallery->count > 0) return PLS_OK;
    return pls_fail(
        PLS_NOT_FOUND,
        "there are neither frames nor checkpoints in \"%s\"; let the scene write frames (observe: [{frames: vtk, every: 0.1}]), "
        "or draw the scene itself",
        directory);
}

// ---- files ------------------------------------------------------------------------------------------------------------------------------

/// Frames and checkpoints lie in a folder of their run directory.
static pls_status open_file(pls_gallery *gallery, pls_moment_kind kind, const char *path)
{
    char directory[PLS_PATH_SIZE];
    const char *slash = strrchr(path, '/');
    snprintf(directory, sizeof directory, "%.*s/..", slash ? (int)(slash - path) : 1, slash ? path : ".");
    PLS_TRY(load_used_scene(gallery, directory));
    return kind == PLS_MOMENT_CHECKPOINT ? add_checkpoint(gallery, path) : add_moment(gallery, kind, path, NAN);
}

static pls_status open_scene(pls_gallery *gallery, const char *path)
{
    PLS_TRY(pls_scene_load(path, gallery->def.overrides, gallery->def.override_count, &gallery->scene));
    return add_moment(gallery, PLS_MOMENT_START, "", 0.0);
}

static pls_status open_path(pls_gallery *gallery, const char *path)
{
    struct stat there;
    if (stat(path, &there) != 0) return pls_fail(PLS_NOT_FOUND, "cannot look at \"%s\": %s", path, strerror(errno));
    bool scene = has_suffix(path, ".yaml") || has_suffix(path, ".yml");
    if (!scene && gallery->def.override_count > 0)
        return pls_fail(PLS_INVALID_ARGUMENT, "values can be changed in a scene, not in \"%s\", which has been run", path);
    if (S_ISDIR(there.st_mode)) return open_directory(gallery, path);
    if (scene) return open_scene(gallery, path);
    if (has_suffix(path, ".vtp")) return open_file(gallery, PLS_MOMENT_FRAME, path);
    if (has_suffix(path, ".h5")) return open_file(gallery, PLS_MOMENT_CHECKPOINT, path);
    return pls_fail(PLS_INVALID_ARGUMENT, "\"%s\" is no run directory, frame (.vtp), checkpoint (.h5) or scene (.yaml): give one of these",
                    path);
}

pls_status pls_gallery_open(pls_gallery *gallery, const char *path, const pls_gallery_def *def)
{
    *gallery = (pls_gallery){.def = *def};
    pls_status status = open_path(gallery, path);
    if (status != PLS_OK) pls_gallery_free(gallery);
    return status;
}

void pls_gallery_free(pls_gallery *gallery)
{
    for (size_t k = 0; k < gallery->count; ++k) pls_release(&gallery->moment[k].path);
    pls_release(&gallery->moment);
    pls_scene_free(gallery->scene);
    *gallery = (pls_gallery){0};
}

size_t pls_gallery_nearest(const pls_gallery *gallery, double time)
{
    size_t best = 0;
    for (size_t k = 1; k < gallery->count; ++k)
    {
        if (fabs(gallery->moment[k].time - time) < fabs(gallery->moment[best].time - time)) best = k;
    }
    return best;
}

int pls_gallery_dimension(const pls_gallery *gallery) { return gallery->scene->dimension; }

// ---- moments ----------------------------------------------------------------------------------------------------------------------------

static pls_status restore(const pls_gallery *gallery, const char *path, pls_world *world)
{
    pls_checkpoint checkpoint = {0};
    PLS_TRY(pls_checkpoint_open(&checkpoint, path));
    pls_status status = PLS_OK;
    if (checkpoint.scene_hash != pls_scene_hash(gallery->scene))
        status =
            pls_fail(PLS_CORRUPT, "\"%s\" was not written for the scene.used.yaml of its run directory: one of them was changed", path);
    if (status == PLS_OK) status = pls_checkpoint_restore(&checkpoint, world);
    pls_checkpoint_close(&checkpoint);
    return status;
}

static pls_status load_world(const pls_gallery *gallery, const pls_moment *moment, pls_frame *frame)
{
    pls_world *world;
    PLS_TRY(pls_scene_build(gallery->scene, &world));
    pls_status status = PLS_OK;
    if (moment->kind == PLS_MOMENT_CHECKPOINT) status = restore(gallery, moment->path, world);
    if (moment->kind == PLS_MOMENT_START && gallery->def.forces) status = pls_world_prepare(world);
    if (status == PLS_OK) status = pls_frame_take(frame, world);
    pls_world_destroy(world);
    return status;
}

pls_status pls_gallery_load(const pls_gallery *gallery, size_t k, pls_frame *frame)
{
    const pls_moment *moment = &gallery->moment[k];
    return moment->kind == PLS_MOMENT_FRAME ? pls_frame_read(frame, moment->path) : load_world(gallery, moment, frame);
}
