// run_directory.c -- see run_directory.h.

#include "run/run_directory.h"

#include "base/atomic_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/// Which files of which folder a run writes.
static const struct
{
    const char *folder;
    const char *suffix;
} written[] = {{"series", ".csv"},           {"frames", ".vtp"}, {"frames", ".pvd"}, {"checkpoint", ".h5"},
               {"checkpoint", ".set-aside"}, {"series", ".tmp"}, {"frames", ".tmp"}, {"checkpoint", ".tmp"}};

/// Files of the run directory itself.
static const char *const own_files[] = {"summary.json", "summary.json.tmp", "scene.used.yaml.tmp"};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

pls_status pls_run_path(char path[PLS_PATH_SIZE], const char *directory, const char *format, ...)
{
    char name[PLS_PATH_SIZE];
    va_list arguments;
    va_start(arguments, format);
    int name_length = vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    if (name_length >= 0 && name_length < PLS_PATH_SIZE)
    {
        int length = snprintf(path, PLS_PATH_SIZE, "%s/%s", directory, name);
        if (length >= 0 && length < PLS_PATH_SIZE) return PLS_OK;
    }
    return pls_fail(PLS_LIMIT_EXCEEDED, "the path of the run directory \"%.200s...\" is too long: choose a shorter one", directory);
}

static bool has_suffix(const char *name, const char *suffix)
{
    size_t length = strlen(name);
    size_t end = strlen(suffix);
    return length > end && strcmp(name + length - end, suffix) == 0;
}

pls_status pls_run_each_file(const char *directory, const char *folder,
                             pls_status (*function)(void *context, const char *path, const char *name), void *context)
{
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(path, directory, "%s", folder));
    DIR *stream = opendir(path);
    if (!stream)
    {
        if (errno == ENOENT) return PLS_OK;
        return pls_fail(PLS_IO, "cannot list \"%s\": %s", path, strerror(errno));
    }
    pls_status status = PLS_OK;
    struct dirent *entry;
    while (status == PLS_OK && (entry = readdir(stream)))
    {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) continue;
        status = pls_run_path(path, directory, "%s/%s", folder, entry->d_name);
        if (status == PLS_OK) status = function(context, path, entry->d_name);
    }
    closedir(stream);
    return status;
}

pls_status pls_run_remove(const char *path)
{
    if (unlink(path) == 0 || errno == ENOENT) return PLS_OK;
    return pls_fail(PLS_IO, "cannot remove \"%s\": %s", path, strerror(errno));
}

static pls_status note_run_file(void *context, const char *path, const char *name)
{
    (void)path;
    for (size_t k = 0; k < COUNT(written); ++k)
    {
        if (has_suffix(name, written[k].suffix)) *(bool *)context = true;
    }
    return PLS_OK;
}

pls_status pls_run_directory_check_free(const char *path)
{
    static const char *const folders[] = {"series", "frames", "checkpoint"};
    static const char *const files[] = {"scene.used.yaml", "summary.json"};
    bool found = false;
    char name[PLS_PATH_SIZE];
    if (!pls_file_exists(path)) return PLS_OK;
    for (size_t k = 0; k < COUNT(files); ++k)
    {
        PLS_TRY(pls_run_path(name, path, "%s", files[k]));
        found = found || pls_file_exists(name);
    }
    for (size_t k = 0; k < COUNT(folders); ++k) PLS_TRY(pls_run_each_file(path, folders[k], note_run_file, &found));
    if (!found) return PLS_OK;
    return pls_fail(PLS_DUPLICATE,
                    "\"%s\" holds a run already; go on with it (particls resume), choose another folder (-o), or replace it (--overwrite)",
                    path);
}

static pls_status take_lock(pls_run_directory *directory)
{
    char name[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(name, directory->path, ".lock"));
    directory->lock = open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (directory->lock < 0) return pls_fail(PLS_IO, "cannot write into the run directory \"%s\": %s", directory->path, strerror(errno));
    if (flock(directory->lock, LOCK_EX | LOCK_NB) == 0) return PLS_OK;
    if (errno == EWOULDBLOCK)
        return pls_fail(PLS_DUPLICATE, "another process runs in \"%s\" now: wait for it, stop it, or choose another folder (-o)",
                        directory->path);
    return PLS_OK; // some network file systems know no locks; a lock is a courtesy, not a need
}

pls_status pls_run_directory_open(pls_run_directory *directory, const char *path, bool make)
{
    *directory = (pls_run_directory){.lock = -1};
    if (!path || !*path) return pls_fail(PLS_INVALID_ARGUMENT, "a run needs the name of its directory");
    struct stat there;
    if (!make && stat(path, &there) != 0) return pls_fail(PLS_NOT_FOUND, "there is no run directory \"%s\": %s", path, strerror(errno));
    if (!make && !S_ISDIR(there.st_mode)) return pls_fail(PLS_NOT_FOUND, "\"%s\" is a file, not a run directory", path);
    if (make) PLS_TRY(pls_make_directory(path));
    PLS_TRY(pls_copy_text(&directory->path, path, "a file name"));
    pls_status status = take_lock(directory);
    if (status != PLS_OK) pls_run_directory_close(directory);
    return status;
}

void pls_run_directory_close(pls_run_directory *directory)
{
    if (directory->path && directory->lock >= 0) close(directory->lock);
    pls_release(&directory->path);
    *directory = (pls_run_directory){.lock = -1};
}

static pls_status remove_with_suffix(void *context, const char *path, const char *name)
{
    return has_suffix(name, (const char *)context) ? pls_run_remove(path) : PLS_OK;
}

pls_status pls_run_directory_clear(const pls_run_directory *directory, bool scene_too)
{
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(path, directory->path, "scene.used.yaml"));
    if (scene_too) PLS_TRY(pls_run_remove(path));
    for (size_t k = 0; k < COUNT(own_files); ++k)
    {
        PLS_TRY(pls_run_path(path, directory->path, "%s", own_files[k]));
        PLS_TRY(pls_run_remove(path));
    }
    for (size_t k = 0; k < COUNT(written); ++k)
    {
        char suffix[16];
        snprintf(suffix, sizeof suffix, "%s", written[k].suffix);
        PLS_TRY(pls_run_each_file(directory->path, written[k].folder, remove_with_suffix, suffix));
    }
    return PLS_OK;
}

pls_status pls_run_directory_remove_temporaries(const pls_run_directory *directory)
{
    static const char *const folders[] = {"series", "frames", "checkpoint"};
    char path[PLS_PATH_SIZE];
    for (size_t k = 0; k < COUNT(own_files); ++k)
    {
        if (!has_suffix(own_files[k], ".tmp")) continue;
        PLS_TRY(pls_run_path(path, directory->path, "%s", own_files[k]));
        PLS_TRY(pls_run_remove(path));
    }
    char suffix[] = ".tmp";
    for (size_t k = 0; k < COUNT(folders); ++k) PLS_TRY(pls_run_each_file(directory->path, folders[k], remove_with_suffix, suffix));
    return PLS_OK;
}
