// info.c -- particls info: what a run directory, a checkpoint, a frame or a series holds.

#include "info.h"

#include "base/atomic_file.h"

#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const cli_option options[] = {
    {0},
};

bool info_has_suffix(const char *name, const char *suffix)
{
    size_t length = strlen(name);
    size_t end = strlen(suffix);
    return length > end && strcmp(name + length - end, suffix) == 0;
}

/// Attribute `name="..."` behind `from`, cut to `size`; false when there is none.
static bool find_attribute(const char *from, const char *name, char *value, size_t size)
{
    char key[64];
    snprintf(key, sizeof key, " %s=\"", name);
    const char *found = strstr(from, key);
    if (!found) return false;
    found += strlen(key);
    snprintf(value, size, "%.*s", (int)strcspn(found, "\""), found);
    return true;
}

/// The XML of a frame ends where the arrays begin; those are not looked at.
static int describe_frame(const char *path)
{
    char *text;
    size_t size;
    if (pls_read_file(path, &text, &size) != PLS_OK) return cli_failed(CLI_FAILED);
    char *data = strstr(text, "<AppendedData");
    if (data) *data = '\0';
    char points[32];
    char lines[32];
    if (!data || !find_attribute(text, "NumberOfPoints", points, sizeof points) ||
        !find_attribute(text, "NumberOfLines", lines, sizeof lines))
    {
        fprintf(stderr, "particls: \"%s\" is no frame written by particls\n", path);
        pls_release(&text);
        return CLI_FAILED;
    }
    printf("frame              %s\npoints             %s\nlines              %s\n", path, points, lines);
    const char *time = strstr(text, "Name=\"TimeValue\"");
    time = time ? strchr(time, '>') : NULL;
    if (time) printf("time               %.*s s\n", (int)strcspn(time + 1, "<"), time + 1);
    for (char *array = text; (array = strstr(array, "<DataArray ")); ++array)
    {
        char name[96];
        char type[32];
        char components[16];
        char *end = strchr(array, '>');
        if (end) *end = '\0'; // look at this element only
        if (find_attribute(array, "Name", name, sizeof name) && find_attribute(array, "type", type, sizeof type) &&
            find_attribute(array, "NumberOfComponents", components, sizeof components))
        {
            printf("  %-20s %s x %s\n", name, type, components);
        }
        if (end) *end = '>';
    }
    pls_release(&text);
    return CLI_DONE;
}

static int describe_series(const char *path)
{
    info_series series;
    if (!info_read_series(path, &series)) return cli_failed(CLI_FAILED);
    printf("series             %s\nrows               %zu\nfirst line         %s\nlast line          %s\n", path, series.rows, series.first,
           series.last);
    return CLI_DONE;
}

static int describe_plugin(const char *path)
{
    char *text;
    if (pls_plugin_reference(path, &text) != PLS_OK) return cli_failed(CLI_FAILED);
    bool written = fputs(text, stdout) >= 0 && fflush(stdout) == 0;
    pls_scene_free_text(text);
    return written ? CLI_DONE : CLI_FAILED;
}

static void copy_line(char line[INFO_LINE_SIZE], const char *start)
{
    size_t length = strcspn(start, "\n");
    snprintf(line, INFO_LINE_SIZE, "%.*s%s", (int)(length < INFO_LINE_SIZE - 8 ? length : INFO_LINE_SIZE - 8), start,
             length < INFO_LINE_SIZE - 8 ? "" : "...");
}

bool info_read_series(const char *path, info_series *series)
{
    char *text;
    size_t size;
    *series = (info_series){0};
    if (pls_read_file(path, &text, &size) != PLS_OK) return false;
    copy_line(series->first, text);
    const char *last = text;
    for (const char *line = text; *line; ++series->rows)
    {
        last = line;
        const char *end = strchr(line, '\n');
        line = end ? end + 1 : line + strlen(line);
    }
    if (series->rows > 0) --series->rows; // the first line holds names
    if (series->rows > 0) copy_line(series->last, last);
    pls_release(&text);
    return true;
}

static bool is_checkpoint(const char *path)
{
    static const char title[] = "particls checkpoint";
    char head[sizeof title] = "";
    FILE *stream = fopen(path, "rb");
    if (!stream) return false;
    size_t got = fread(head, 1, sizeof title - 1, stream);
    fclose(stream);
    return got == sizeof title - 1 && memcmp(head, title, got) == 0;
}

static int describe_path(const char *path)
{
    struct stat there;
    if (stat(path, &there) != 0)
    {
        fprintf(stderr, "particls: cannot look at \"%s\": %s\n", path, strerror(errno));
        return CLI_USAGE;
    }
    if (S_ISDIR(there.st_mode)) return info_describe_run(path);
    if (is_checkpoint(path) || info_has_suffix(path, ".h5")) return info_describe_checkpoint(path);
    if (info_has_suffix(path, ".vtp")) return describe_frame(path);
    if (info_has_suffix(path, ".csv")) return describe_series(path);
    if (info_has_suffix(path, ".so")) return describe_plugin(path);
    if (info_has_suffix(path, ".yaml") || info_has_suffix(path, ".yml"))
    {
        fprintf(stderr, "particls: \"%s\" looks like a scene: particls check %s tells about it\n", path, path);
        return CLI_USAGE;
    }
    fprintf(stderr, "particls: \"%s\" is no run directory, checkpoint (.h5), frame (.vtp), series (.csv) or plugin (.so)\n", path);
    return CLI_USAGE;
}

static int run(int argc, char **argv)
{
    const char *value;
    int option;
    while ((option = cli_next_option(&cli_info, argc, argv, &value)) != CLI_NO_MORE)
    {
        if (option == CLI_HELP) return CLI_DONE;
        if (option == CLI_WRONG) return CLI_USAGE;
    }
    const char *path = cli_only_argument(&cli_info, argc, argv, "file or directory");
    return path ? describe_path(path) : CLI_USAGE;
}

const cli_verb cli_info = {
    .name = "info",
    .arguments = "FILE|DIR",
    .summary = "say what a run directory, checkpoint, frame, series or plugin holds",
    .about = "Tells about a run directory (how far it is, its series, frames and checkpoints), a checkpoint (.h5: its fields with "
             "smallest, largest\n"
             "and mean value, and whether it is undamaged), a frame (.vtp), a series (.csv) or a plugin (.so: the laws, shapes,\n"
             "forces and observers it brings, with their parameters).",
    .example = "  particls info scene.run",
    .options = options,
    .function = run,
};
