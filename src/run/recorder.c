// recorder.c -- see recorder.h.
//
// The text of a run, kept in its checkpoints, has a line per fact:
//     series 1234 stress       the file series/stress.csv has 1234 bytes
//     memory 2 mine            what the observer "mine" remembers, as the bits of the two numbers that follow
//     number 3ff0000000000000
//     number 0000000000000000
//     frames 2 pack            two frames of "pack" are written, at the times of the two lines that follow
//     frame 0
//     frame 0.05

#include "run/recorder.h"

#include "io/vtk.h"
#include "run/run_directory.h"

#include "base/atomic_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Added to an observer's name for the files of its contacts.
static const char contacts_suffix[] = ".contacts";

bool pls_recorder_has_series(const pls_recorder_output *output)
{
    pls_observer_kind kind = output->def->kind;
    return kind == PLS_OBSERVE_PARTICLE || kind == PLS_OBSERVE_COLLECTION || kind == PLS_OBSERVE_OWN;
}

static bool has_frames(const pls_recorder_output *output) { return output->def->kind == PLS_OBSERVE_FRAMES; }

static bool writes_files(const pls_recorder_output *output) { return pls_recorder_has_series(output) || has_frames(output); }

// ---- making --------------------------------------------------------------------------------------------------------

/// Names become names of files.
static pls_status check_name(const pls_recorder *recorder, size_t k)
{
    const pls_recorder_output *output = &recorder->output[k];
    const char *name = output->def->name;
    if (!writes_files(output)) return PLS_OK;
    if (!name[0] || name[0] == '.' || strpbrk(name, "/\n"))
    {
        return pls_fail(PLS_INVALID_ARGUMENT, "'%s' cannot name an observer, because it names its files: use letters, digits, '_' and '-'",
                        name);
    }
    for (size_t other = 0; other < recorder->count; ++other)
    {
        const char *taken = recorder->output[other].def->name;
        size_t length = strlen(name);
        bool same = other < k && strcmp(taken, name) == 0 && writes_files(&recorder->output[other]);
        bool contacts = has_frames(output) && output->def->frames.contacts && strncmp(taken, name, length) == 0 &&
                        strcmp(taken + length, contacts_suffix) == 0;
        if (same || contacts)
            return pls_fail(PLS_DUPLICATE, "two observers would write the files of '%s': give one of them another name", taken);
    }
    return PLS_OK;
}

static pls_status make_series(pls_recorder_output *output, pls_world *world)
{
    if (output->def->kind == PLS_OBSERVE_PARTICLE)
        PLS_TRY(pls_series_particle(world, &output->def->particle, &output->series));
    else if (output->def->kind == PLS_OBSERVE_OWN)
        PLS_TRY(pls_series_own(world, &output->def->own, &output->series));
    else
        PLS_TRY(pls_series_collection(world, &output->def->collection, &output->series));
    return pls_allocate(&output->values, output->series.column_count + 1, sizeof(double), "a row of a series");
}

static pls_status init_output(pls_recorder *recorder, size_t k, pls_world *world)
{
    pls_recorder_output *output = &recorder->output[k];
    if (output->def->kind == PLS_OBSERVE_USER && !output->def->function)
    {
        return pls_fail(PLS_INVALID_ARGUMENT, "the observer '%s' has no function to call", output->def->name);
    }
    PLS_TRY(check_name(recorder, k));
    if (!pls_recorder_has_series(output)) return PLS_OK;
    return pls_fail_context(make_series(output, world), "observer '%s': ", output->def->name);
}

pls_status pls_recorder_init(pls_recorder *recorder, const char *directory, pls_world *world, const pls_observer_def *scene,
                             size_t scene_count, const pls_observer_def *caller, size_t caller_count)
{
    *recorder = (pls_recorder){.directory = directory};
    PLS_TRY(pls_allocate(&recorder->output, scene_count + caller_count, sizeof *recorder->output, "the observers of the run"));
    recorder->count = scene_count + caller_count;
    for (size_t k = 0; k < recorder->count; ++k) recorder->output[k].def = k < scene_count ? &scene[k] : &caller[k - scene_count];
    pls_status status = PLS_OK;
    for (size_t k = 0; k < recorder->count && status == PLS_OK; ++k) status = init_output(recorder, k, world);
    if (status != PLS_OK) pls_recorder_free(recorder);
    return status;
}

void pls_recorder_free(pls_recorder *recorder)
{
    for (size_t k = 0; k < recorder->count; ++k)
    {
        pls_recorder_output *output = &recorder->output[k];
        pls_csv_close(&output->csv);
        pls_series_free(&output->series);
        pls_release(&output->values);
        pls_release(&output->times);
    }
    pls_release(&recorder->output);
    *recorder = (pls_recorder){0};
}

// ---- files ---------------------------------------------------------------------------------------------------------

/// Create (`size` 0) or cut back and go on with a series.
static pls_status open_series(const pls_recorder *recorder, pls_recorder_output *output, uint64_t size)
{
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(path, recorder->directory, "series/%s.csv", output->def->name));
    size_t count = output->series.column_count + 1;
    pls_csv_column *columns = NULL;
    PLS_TRY(pls_allocate(&columns, count, sizeof *columns, "the columns of a series"));
    columns[0] = (pls_csv_column){"time", "s"};
    for (size_t c = 1; c < count; ++c)
        columns[c] = (pls_csv_column){output->series.columns[c - 1].name, output->series.columns[c - 1].unit};
    pls_status status =
        size == 0 ? pls_csv_create(&output->csv, path, columns, count) : pls_csv_reopen(&output->csv, path, size, columns, count);
    pls_release(&columns);
    return status;
}

static pls_status make_folder(const pls_recorder *recorder, const char *folder)
{
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_run_path(path, recorder->directory, "%s", folder));
    return pls_make_directory(path);
}

pls_status pls_recorder_start(pls_recorder *recorder)
{
    for (size_t k = 0; k < recorder->count; ++k)
    {
        pls_recorder_output *output = &recorder->output[k];
        if (pls_recorder_has_series(output))
        {
            PLS_TRY(make_folder(recorder, "series"));
            PLS_TRY(open_series(recorder, output, 0));
        }
        if (has_frames(output)) PLS_TRY(make_folder(recorder, "frames"));
    }
    return PLS_OK;
}

static pls_status write_collection(const pls_recorder *recorder, const pls_recorder_output *output, const char *suffix)
{
    char path[PLS_PATH_SIZE];
    char name[PLS_NAME_SIZE + sizeof contacts_suffix];
    snprintf(name, sizeof name, "%s%s", output->def->name, suffix);
    PLS_TRY(pls_run_path(path, recorder->directory, "frames/%s.pvd", name));
    return output->frames > 0 ? pls_vtk_write_collection(path, name, output->times, output->frames) : pls_run_remove(path);
}

/// The collections name only frames that are there: a frame is written first, then named.
static pls_status write_frame(pls_recorder *recorder, pls_recorder_output *output, pls_world *world)
{
    const pls_frames_def *frames = &output->def->frames;
    char path[PLS_PATH_SIZE];
    PLS_TRY(pls_reserve(&output->times, &output->frame_capacity, output->frames + 1, sizeof *output->times, "the times of frames"));
    PLS_TRY(pls_run_path(path, recorder->directory, "frames/%s_%06zu.vtp", output->def->name, output->frames));
    PLS_TRY(pls_vtk_write_bodies(path, world, frames));
    if (frames->contacts)
    {
        PLS_TRY(pls_run_path(path, recorder->directory, "frames/%s%s_%06zu.vtp", output->def->name, contacts_suffix, output->frames));
        PLS_TRY(pls_vtk_write_contacts(path, world));
    }
    output->times[output->frames++] = pls_world_time(world);
    PLS_TRY(write_collection(recorder, output, ""));
    return frames->contacts ? write_collection(recorder, output, contacts_suffix) : PLS_OK;
}

static pls_status write_row(pls_recorder_output *output, pls_world *world)
{
    if (output->series.update) PLS_TRY(output->series.update(output->series.context, world));
    output->values[0] = pls_world_time(world);
    PLS_TRY(output->series.values(output->series.context, world, output->values + 1));
    return pls_csv_row(&output->csv, output->values, output->series.column_count + 1);
}

static pls_status look(pls_recorder *recorder, pls_recorder_output *output, pls_world *world)
{
    switch (output->def->kind)
    {
        case PLS_OBSERVE_PARTICLE:
        case PLS_OBSERVE_COLLECTION:
        case PLS_OBSERVE_OWN: return write_row(output, world);
        case PLS_OBSERVE_FRAMES: return write_frame(recorder, output, world);
        case PLS_OBSERVE_USER: return output->def->function(output->def->context, world);
        case PLS_OBSERVE_CHECKPOINT: break; // the run itself writes checkpoints, after all others have looked
    }
    return PLS_OK;
}

bool pls_recorder_due(const pls_recorder *recorder, uint64_t step, double time, double dt)
{
    for (size_t k = 0; k < recorder->count; ++k)
        if (pls_schedule_due(&recorder->output[k].def->schedule, step, time, dt)) return true;
    return false;
}

pls_status pls_recorder_look(pls_recorder *recorder, pls_world *world)
{
    uint64_t step = pls_world_step_number(world);
    double time = pls_world_time(world);
    double dt = pls_world_dt(world);
    for (size_t k = 0; k < recorder->count; ++k)
    {
        pls_recorder_output *output = &recorder->output[k];
        if (!pls_schedule_due(&output->def->schedule, step, time, dt)) continue;
        PLS_TRY(pls_fail_context(look(recorder, output, world), "observer '%s': ", output->def->name));
    }
    return PLS_OK;
}

// ---- noting and going on -------------------------------------------------------------------------------------------

static pls_status describe_memory(const pls_recorder_output *output, pls_text *run)
{
    const pls_series *series = &output->series;
    if (series->memory_count == 0) return PLS_OK;
    PLS_TRY(pls_text_print(run, "memory %zu %s\n", series->memory_count, output->def->name));
    for (size_t k = 0; k < series->memory_count; ++k)
    {
        uint64_t bits; // exact, also for what is not a number
        memcpy(&bits, &series->memory[k], sizeof bits);
        PLS_TRY(pls_text_print(run, "number %016" PRIx64 "\n", bits));
    }
    return PLS_OK;
}

pls_status pls_recorder_describe(pls_recorder *recorder, pls_text *run)
{
    for (size_t k = 0; k < recorder->count; ++k)
    {
        pls_recorder_output *output = &recorder->output[k];
        if (pls_recorder_has_series(output))
        {
            PLS_TRY(pls_csv_sync(&output->csv));
            PLS_TRY(pls_text_print(run, "series %" PRIu64 " %s\n", output->csv.size, output->def->name));
            PLS_TRY(describe_memory(output, run));
        }
        if (!has_frames(output)) continue;
        PLS_TRY(pls_text_print(run, "frames %zu %s\n", output->frames, output->def->name));
        for (size_t f = 0; f < output->frames; ++f)
        {
            char number[32];
            PLS_TRY(pls_text_print(run, "frame %s\n", pls_format_double(number, output->times[f])));
        }
    }
    return PLS_OK;
}

const char *pls_run_text_find(const char **line, const char *key)
{
    size_t length = strlen(key);
    while (**line)
    {
        const char *start = *line;
        const char *end = strchr(start, '\n');
        *line = end ? end + 1 : start + strlen(start);
        if (strncmp(start, key, length) == 0 && start[length] == ' ') return start + length + 1;
    }
    return NULL;
}

/// The number of "`key` number name"; `*line` ends behind that line.
static pls_status find_entry(const char **line, const char *key, const char *name, uint64_t *number)
{
    const char *entry;
    while ((entry = pls_run_text_find(line, key)))
    {
        char *end;
        *number = strtoull(entry, &end, 10);
        size_t length = strlen(name);
        if (*end == ' ' && strncmp(end + 1, name, length) == 0 && end[1 + length] == '\n') return PLS_OK;
    }
    return pls_fail(PLS_INVALID_ARGUMENT, "the run was started without the observer '%s': resume it with the observers it had", name);
}

static size_t count_lines(const char *run, const char *key)
{
    size_t count = 0;
    while (pls_run_text_find(&run, key)) ++count;
    return count;
}

/// A run whose further observers are forgotten would go on without their series; better to say so.
static pls_status check_count(const pls_recorder *recorder, const char *run)
{
    size_t series = 0;
    size_t frames = 0;
    for (size_t k = 0; k < recorder->count; ++k)
    {
        series += pls_recorder_has_series(&recorder->output[k]);
        frames += has_frames(&recorder->output[k]);
    }
    if (count_lines(run, "series") == series && count_lines(run, "frames") == frames) return PLS_OK;
    return pls_fail(PLS_INVALID_ARGUMENT,
                    "the run was started with observers that are not given now: resume it from the program that started it");
}

/// Number of the frame called `name` of the collection `collection`, or -1 when it is none.
static long frame_number(const char *name, const char *collection)
{
    size_t length = strlen(collection);
    if (strncmp(name, collection, length) != 0 || name[length] != '_') return -1;
    const char *digits = name + length + 1;
    size_t count = strspn(digits, "0123456789");
    return count >= 6 && strcmp(digits + count, ".vtp") == 0 ? strtol(digits, NULL, 10) : -1;
}

static pls_status remove_later_frame(void *context, const char *path, const char *name)
{
    const pls_recorder_output *output = context;
    char contacts[PLS_NAME_SIZE + sizeof contacts_suffix];
    snprintf(contacts, sizeof contacts, "%s%s", output->def->name, contacts_suffix);
    long number = frame_number(name, output->def->name);
    if (number < 0 && output->def->frames.contacts) number = frame_number(name, contacts);
    return number >= 0 && (size_t)number >= output->frames ? pls_run_remove(path) : PLS_OK;
}

static pls_status resume_frames(pls_recorder *recorder, pls_recorder_output *output, const char *run)
{
    uint64_t count = 0;
    PLS_TRY(find_entry(&run, "frames", output->def->name, &count));
    PLS_TRY(pls_reserve(&output->times, &output->frame_capacity, count, sizeof *output->times, "the times of frames"));
    for (output->frames = 0; output->frames < count; ++output->frames)
    {
        const char *entry = pls_run_text_find(&run, "frame");
        char number[32] = "";
        if (entry) snprintf(number, sizeof number, "%.*s", (int)strcspn(entry, "\n"), entry);
        if (!pls_parse_double(number, &output->times[output->frames]))
            return pls_fail(PLS_CORRUPT, "the times of the frames of '%s' are not in the checkpoint", output->def->name);
    }
    PLS_TRY(pls_run_each_file(recorder->directory, "frames", remove_later_frame, output));
    PLS_TRY(write_collection(recorder, output, ""));
    return output->def->frames.contacts ? write_collection(recorder, output, contacts_suffix) : PLS_OK;
}

static pls_status resume_memory(pls_recorder_output *output, const char *run)
{
    pls_series *series = &output->series;
    if (series->memory_count == 0) return PLS_OK;
    uint64_t count = 0;
    PLS_TRY(find_entry(&run, "memory", output->def->name, &count));
    for (size_t k = 0; k < series->memory_count; ++k)
    {
        const char *entry = count == series->memory_count ? pls_run_text_find(&run, "number") : NULL;
        char *end = NULL;
        uint64_t bits = entry ? strtoull(entry, &end, 16) : 0;
        if (!entry || *end != '\n')
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "the observer '%s' remembers %zu numbers, but %" PRIu64
                            " when the run was started: resume it with the plugin it had",
                            output->def->name, series->memory_count, count);
        memcpy(&series->memory[k], &bits, sizeof bits);
    }
    return PLS_OK;
}

pls_status pls_recorder_resume(pls_recorder *recorder, const char *run)
{
    PLS_TRY(check_count(recorder, run));
    for (size_t k = 0; k < recorder->count; ++k)
    {
        pls_recorder_output *output = &recorder->output[k];
        if (pls_recorder_has_series(output))
        {
            const char *line = run;
            uint64_t size = 0;
            PLS_TRY(find_entry(&line, "series", output->def->name, &size));
            PLS_TRY(open_series(recorder, output, size));
            PLS_TRY(resume_memory(output, run));
        }
        if (has_frames(output)) PLS_TRY(resume_frames(recorder, output, run));
    }
    return PLS_OK;
}
