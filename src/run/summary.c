// summary.c -- summary.json: the result of a run for other programs. Numbers that do not exist (not a number, infinite, or not to be had after a failure)
// are null. But for the wall times it depends on the scene alone.

#include "run/run_state.h"

#include "base/atomic_file.h"
#include "base/clock.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static pls_status add_string(pls_text *json, const char *text)
{
    PLS_TRY(pls_text_append(json, "\"", 1));
    for (const unsigned char *c = (const unsigned char *)text; *c; ++c)
    {
        if (*c == '"' || *c == '\\')
            PLS_TRY(pls_text_print(json, "\\%c", *c));
        else if (*c < 0x20)
            PLS_TRY(pls_text_print(json, "\\u%04x", *c));
        else
            PLS_TRY(pls_text_append(json, (const char *)c, 1));
    }
    return pls_text_append(json, "\"", 1);
}

static pls_status add_number(pls_text *json, double value)
{
    char number[32];
    return pls_text_print(json, "%s", isfinite(value) ? pls_format_double(number, value) : "null");
}

static pls_status add_named_number(pls_text *json, const char *name, double value, const char *separator)
{
    PLS_TRY(add_string(json, name));
    PLS_TRY(pls_text_print(json, ": "));
    PLS_TRY(add_number(json, value));
    return pls_text_print(json, "%s", separator);
}

static pls_status add_named_vector(pls_text *json, const char *name, pls_vec3 value)
{
    PLS_TRY(pls_text_print(json, "  \"%s\": [", name));
    PLS_TRY(add_number(json, value.x));
    PLS_TRY(pls_text_print(json, ", "));
    PLS_TRY(add_number(json, value.y));
    PLS_TRY(pls_text_print(json, ", "));
    PLS_TRY(add_number(json, value.z));
    return pls_text_print(json, "],\n");
}

static pls_status add_head(pls_text *json, pls_run *run, pls_status outcome)
{
    PLS_TRY(pls_text_print(json, "{\n  \"particls\": \"%s\",\n  \"title\": ", PLS_VERSION_TEXT));
    const char *title = pls_scene_title(run->scene);
    PLS_TRY(add_string(json, title ? title : ""));
    PLS_TRY(pls_text_print(json, ",\n  \"scene_hash\": \"%016" PRIx64 "\",\n  \"finished\": %s,\n  \"why\": ", pls_scene_hash(run->scene),
                           outcome == PLS_OK ? "true" : "false"));
    PLS_TRY(add_string(json, outcome == PLS_OK ? "the end time is reached" : pls_last_message()));
    PLS_TRY(pls_text_print(json, ",\n  \"status\": \"%s\",\n  \"threads\": %d,\n", pls_status_name(outcome), pls_threads()));
    return PLS_OK;
}

static pls_status add_counts(pls_text *json, pls_run *run)
{
    pls_world *world = run->world;
    double bodies = (double)pls_world_body_count(world);
    double steps = (double)(pls_world_step_number(world) - run->first_step);
    double wall = pls_clock() - run->wall_start;
    const pls_bonds_figures bonds = pls_world_all_bonds(world);
    PLS_TRY(pls_text_print(
        json, "  \"bodies\": %zu,\n  \"contacts\": %zu,\n  \"bonds\": %zu,\n  \"bonds_broken\": %zu,\n  \"steps\": %" PRIu64 ",\n  ",
        pls_world_body_count(world), pls_world_contact_count(world), bonds.bonds / 2, bonds.broken / 2, pls_world_step_number(world)));
    PLS_TRY(add_named_number(json, "time", pls_world_time(world), ",\n  "));
    PLS_TRY(add_named_number(json, "dt", pls_world_dt(world), ",\n  "));
    PLS_TRY(add_named_number(json, "wall_s", wall, ",\n  "));
    PLS_TRY(add_named_number(json, "step_s", wall / steps, ",\n  "));
    return add_named_number(json, "particle_steps_per_s", bodies * steps / wall, ",\n");
}

static pls_status add_search(pls_text *json, const pls_run *run)
{
    const pls_narrow_counts c = pls_world_narrow_counts(run->world);
    return pls_text_print(json,
                          "  \"contact_search\": {\"queries\": %" PRIu64 ", \"iterations\": %" PRIu64 ", \"restarts\": %" PRIu64
                          ", \"fallbacks\": %" PRIu64 ", \"failures\": %" PRIu64 "},\n",
                          c.queries, c.iterations, c.restarts, c.fallbacks, c.failures);
}

/// After a step that failed, or before the first step since a checkpoint, some values may not be to be had; else that is a failure.
static pls_status is_known(const pls_run *run, pls_status outcome, pls_status status, bool *known)
{
    *known = status == PLS_OK && !run->broken;
    bool stepped = pls_world_step_number(run->world) > run->first_step || run->first_step == 0;
    return outcome == PLS_OK && stepped ? status : PLS_OK;
}

static pls_status add_figures(pls_text *json, pls_run *run, pls_status outcome)
{
    pls_world_figures f = {0};
    bool known;
    PLS_TRY(is_known(run, outcome, pls_world_get_figures(run->world, &f), &known));
    if (!known)
    {
        return pls_text_print(json, "  \"energies\": null,\n  \"momentum\": null,\n  \"angular_momentum\": null,\n");
    }
    PLS_TRY(pls_text_print(json, "  \"energies\": {"));
    PLS_TRY(add_named_number(json, "kinetic", f.energy_kinetic, ", "));
    PLS_TRY(add_named_number(json, "rotation", f.energy_rotation, ", "));
    PLS_TRY(add_named_number(json, "normal", f.energy_normal, ", "));
    PLS_TRY(add_named_number(json, "shear", f.energy_shear, ", "));
    PLS_TRY(add_named_number(json, "potential", f.energy_potential, ", "));
    PLS_TRY(add_named_number(json, "damped", f.energy_damped, ", "));
    PLS_TRY(add_named_number(json, "slid", f.energy_slid, ", "));
    PLS_TRY(add_named_number(json, "bonds", f.energy_bonds, ", "));
    PLS_TRY(add_named_number(json, "broken", f.energy_broken, "},\n"));
    PLS_TRY(add_named_vector(json, "momentum", f.momentum));
    return add_named_vector(json, "angular_momentum", f.angular_momentum);
}

/// Values of the observer at the last state, whether or not a look was due there.
static pls_status add_series(pls_text *json, const pls_run *run, pls_recorder_output *output, pls_status outcome)
{
    const pls_series *series = &output->series;
    bool known;
    PLS_TRY(is_known(run, outcome, series->values(series->context, run->world, output->values), &known));
    PLS_TRY(pls_text_print(json, "{"));
    for (size_t c = 0; c < series->column_count; ++c)
    {
        PLS_TRY(add_named_number(json, series->columns[c].name, known ? output->values[c] : NAN, c + 1 < series->column_count ? ", " : ""));
    }
    return pls_text_print(json, "}");
}

static pls_status add_observers(pls_text *json, pls_run *run, pls_status outcome)
{
    PLS_TRY(pls_text_print(json, "  \"observers\": {"));
    const char *separator = "";
    for (size_t k = 0; k < run->recorder.count; ++k)
    {
        pls_recorder_output *output = &run->recorder.output[k];
        bool series = pls_recorder_has_series(output);
        if (!series && output->def->kind != PLS_OBSERVE_FRAMES) continue;
        PLS_TRY(pls_text_print(json, "%s\n    ", separator));
        PLS_TRY(add_string(json, output->def->name));
        PLS_TRY(pls_text_print(json, ": "));
        if (series)
            PLS_TRY(add_series(json, run, output, outcome));
        else
            PLS_TRY(pls_text_print(json, "{\"frames\": %zu}", output->frames));
        separator = ",";
    }
    return pls_text_print(json, "%s},\n", *separator ? "\n  " : "");
}

static pls_status add_hash(pls_text *json, pls_run *run, pls_status outcome)
{
    uint64_t hash;
    bool known;
    PLS_TRY(is_known(run, outcome, pls_world_state_hash(run->world, &hash), &known));
    if (!known) return pls_text_print(json, "  \"state_hash\": null\n}\n");
    return pls_text_print(json, "  \"state_hash\": \"%016" PRIx64 "\"\n}\n", hash);
}

pls_status pls_run_write_summary(pls_run *run, pls_status outcome)
{
    char path[PLS_PATH_SIZE];
    pls_text json = {0};
    pls_status status = add_head(&json, run, outcome); // first of all: it quotes the last message
    if (status == PLS_OK) status = add_counts(&json, run);
    if (status == PLS_OK) status = add_search(&json, run);
    if (status == PLS_OK) status = add_figures(&json, run, outcome);
    if (status == PLS_OK) status = add_observers(&json, run, outcome);
    if (status == PLS_OK) status = add_hash(&json, run, outcome);
    if (status == PLS_OK) status = pls_run_path(path, run->directory.path, "summary.json");
    if (status == PLS_OK) status = pls_write_file(path, json.data, json.size);
    pls_text_free(&json);
    return status;
}

bool pls_run_summary_says_finished(const char *directory)
{
    char path[PLS_PATH_SIZE];
    char *text;
    size_t size;
    if (pls_run_path(path, directory, "summary.json") != PLS_OK || pls_read_file(path, &text, &size) != PLS_OK) return false;
    bool finished = strstr(text, "\n  \"finished\": true,\n") != NULL;
    pls_release(&text);
    return finished;
}
