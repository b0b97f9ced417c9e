// render_options.c -- the options of particls render.

#include "render.h"

#include "base/registry.h"
#include "base/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    OUTPUT,
    COLOUR,
    RANGE,
    MAP,
    SIZE,
    VIEW,
    CAMERA,
    ZOOM,
    ORTHOGRAPHIC,
    WALLS,
    HIDE,
    SECTION,
    BACKGROUND,
    NO_BAR,
    NO_SHADOWS,
    TIME,
    FRAME,
    FRAMES,
    ANIMATE,
    EACH,
    FPS,
    SET,
    THREADS,
    QUIET
};

const cli_option render_options[] = {
    [OUTPUT] = {"output", 'o', "FILE", "the picture, FILE.png (default: the name of what is drawn, in the current folder)"},
    [COLOUR] = {"colour", 'c', "FIELD",
                "what colours tell: velocity, velocity.z, force, radius, group, number, spin, energy, ... any field, or none"},
    [RANGE] = {"range", 'r', "LOW:HIGH", "values at the ends of the colours (default: the smallest and the largest)"},
    [MAP] = {"map", 'm', "NAME", "viridis, magma, coolwarm or grey (default: coolwarm for values of both signs, else viridis)"},
    [SIZE] = {"size", 0, "WxH", "width and height in pixels (default: 1280x720)"},
    [VIEW] = {"view", 'v', "SIDE",
              "where the eye is: iso, x, -x, y, -y, z, -z (default: iso; 2D: z), or a direction a,b,c from the middle"},
    [CAMERA] = {"camera", 0, "EYE:TARGET", "x,y,z:x,y,z in metres, in place of --view; a third point after ':' is the direction upwards"},
    [ZOOM] = {"zoom", 'z', "FACTOR", "enlarge (default: 1, everything is in the picture)"},
    [ORTHOGRAPHIC] = {"orthographic", 0, NULL, "no perspective: equal lengths are equal everywhere (2D: always)"},
    [WALLS] = {"walls", 'w', "HOW", "none, transparent or solid (default: transparent); planes are drawn where they face the eye"},
    [HIDE] = {"hide", 0, "ENTRY", "leave out the bodies of an entry of the scene; may be repeated"},
    [SECTION] = {"section", 0, "A,B,C,D", "cut away what lies beyond the plane a x + b y + c z = d [m]"},
    [BACKGROUND] = {"background", 'b', "COLOUR", "white, black, none (see-through) or #rrggbb (default: white)"},
    [NO_BAR] = {"no-bar", 0, NULL, "neither colour bar nor time"},
    [NO_SHADOWS] = {"no-shadows", 0, NULL, "no shadows"},
    [TIME] = {"time", 0, "T", "the frame nearest to this time [s] (default: the last)"},
    [FRAME] = {"frame", 'n', "N", "the frame of this number, from 0; -1 is the last, -2 the one before"},
    [FRAMES] = {"frames", 0, "NAME", "the frames observer, where a scene has several"},
    [ANIMATE] = {"animate", 'a', NULL, "all frames as an animated PNG, with one camera and one range"},
    [EACH] = {"each", 'e', NULL, "all frames as FILE_000000.png, FILE_000001.png, ..."},
    [FPS] = {"fps", 0, "N", "frames per second of an animation (default: 10)"},
    [SET] = {"set", 's', "PATH=VALUE", "change a value of a scene, as in particls run; may be repeated"},
    [THREADS] = {"threads", 't', "N", "threads to use (default: all processors); pictures do not depend on it"},
    [QUIET] = {"quiet", 'q', NULL, "print nothing but errors"},
    {0},
};

// ---- pieces of values -------------------------------------------------------------------------------------------------------------------

/// `count` finite numbers with `separator` between them, and nothing else.
static bool read_numbers(const char *text, char separator, double *out, int count)
{
    for (int k = 0; k < count; ++k)
    {
        char number[64];
        const char *end = k + 1 < count ? strchr(text, separator) : text + strlen(text);
        if (!end || end - text >= (long)sizeof number) return false;
        snprintf(number, sizeof number, "%.*s", (int)(end - text), text);
        if (!pls_parse_double(number, &out[k]) || !isfinite(out[k])) return false;
        text = *end ? end + 1 : end;
    }
    return true;
}

static bool read_vector(const char *text, pls_vec3 *out)
{
    double v[3];
    if (!read_numbers(text, ',', v, 3)) return false;
    *out = pls_vec(v[0], v[1], v[2]);
    return true;
}

/// The place of a word in a list, or -1 after telling.
static int read_word(const char *option, const char *value, const char *const *words, size_t count)
{
    for (size_t k = 0; k < count; ++k)
    {
        if (strcmp(value, words[k]) == 0) return (int)k;
    }
    char list[200] = "";
    for (size_t k = 0; k < count; ++k)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", k == 0 ? "" : k + 1 < count ? ", " : " or ", words[k]);
    const char *near = pls_nearest_word(value, words, count);
    cli_wrong_usage(&cli_render, "%s takes %s, not '%s'%s%s%s", option, list, value, near ? "; did you mean '" : "", near ? near : "",
                    near ? "'?" : "");
    return -1;
}

static bool wrong(const char *format, const char *value)
{
    char text[400];
    snprintf(text, sizeof text, format, value);
    cli_wrong_usage(&cli_render, "%s", text);
    return false;
}

// ---- options ----------------------------------------------------------------------------------------------------------------------------

static bool read_range(render_arguments *a, const char *value)
{
    double v[2];
    if (!read_numbers(value, ':', v, 2) || !(v[1] > v[0]))
        return wrong("--range takes LOW:HIGH, such as 0:2.5, with LOW below HIGH, not '%s'", value);
    a->low = v[0];
    a->high = v[1];
    return a->has_range = true;
}

static bool read_map(render_arguments *a, const char *value)
{
    static const char *const names[] = {"viridis", "magma", "coolwarm", "grey"};
    static const pls_render_colours maps[] = {PLS_RENDER_VIRIDIS, PLS_RENDER_MAGMA, PLS_RENDER_COOLWARM, PLS_RENDER_GREY};
    int k = read_word("--map", value, names, sizeof names / sizeof *names);
    if (k >= 0) a->picture.colours = maps[k];
    return a->has_map = k >= 0;
}

static bool read_size(render_arguments *a, const char *value)
{
    double v[2];
    if (!read_numbers(value, 'x', v, 2) || v[0] != floor(v[0]) || v[1] != floor(v[1]) || fmin(v[0], v[1]) < 1.0 ||
        fmax(v[0], v[1]) > 16384.0)
        return wrong("--size takes WIDTHxHEIGHT in pixels, such as 1280x720, 16384 at most, not '%s'", value);
    a->picture.width = (int)v[0];
    a->picture.height = (int)v[1];
    return true;
}

void render_look_from(render_arguments *a, pls_vec3 side)
{
    a->direction = pls_scale(pls_unit(side), -1.0);
    bool along_z = fabs(a->direction.z) > 0.999;
    a->up = along_z ? pls_vec(0.0, 1.0, 0.0) : pls_vec(0.0, 0.0, 1.0);
}

static bool read_view(render_arguments *a, const char *value)
{
    static const struct
    {
        const char *name;
        pls_vec3 side;
    } sides[] = {{"iso", RENDER_ISO}, {"x", {1, 0, 0}}, {"-x", {-1, 0, 0}}, {"y", {0, 1, 0}},
                 {"-y", {0, -1, 0}},  {"z", {0, 0, 1}}, {"-z", {0, 0, -1}}};
    pls_vec3 side = {0};
    for (size_t k = 0; k < sizeof sides / sizeof *sides; ++k)
    {
        if (strcmp(value, sides[k].name) == 0) side = sides[k].side;
    }
    if (pls_length(side) == 0.0 && !(read_vector(value, &side) && pls_length(side) > 0.0))
        return wrong("--view takes iso, x, -x, y, -y, z, -z or a direction such as 1,-2,0.5, not '%s'", value);
    render_look_from(a, side);
    return true;
}

static bool read_camera(render_arguments *a, const char *value)
{
    char text[3][200];
    int parts = 0;
    for (const char *rest = value; rest && parts < 3; ++parts)
    {
        size_t length = strcspn(rest, ":");
        snprintf(text[parts], sizeof text[parts], "%.*s", (int)length, rest);
        rest = rest[length] ? rest + length + 1 : NULL;
    }
    a->camera.up = pls_vec(0.0, 0.0, 1.0);
    if (parts < 2 || !read_vector(text[0], &a->camera.eye) || !read_vector(text[1], &a->camera.target) ||
        (parts == 3 && !read_vector(text[2], &a->camera.up)))
        return wrong("--camera takes EYE:TARGET or EYE:TARGET:UP, such as 3,-4,2:0,0,0.5, not '%s'", value);
    pls_vec3 look = pls_sub(a->camera.target, a->camera.eye);
    if (parts == 2 && pls_length(pls_cross(look, a->camera.up)) < 1e-6 * pls_length(look)) a->camera.up = pls_vec(0.0, 1.0, 0.0);
    return a->has_camera = true;
}

static bool read_walls(render_arguments *a, const char *value)
{
    static const char *const names[] = {"none", "transparent", "solid"};
    static const float opacity[] = {0.0f, 0.35f, 1.0f};
    int k = read_word("--walls", value, names, 3);
    if (k >= 0) a->look.wall_opacity = opacity[k];
    return k >= 0;
}

static bool read_section(render_arguments *a, const char *value)
{
    double v[4];
    double length = read_numbers(value, ',', v, 4) ? pls_length(pls_vec(v[0], v[1], v[2])) : 0.0;
    if (!(length > 0.0)) return wrong("--section takes A,B,C,D of a plane a x + b y + c z = d, such as 0,-1,0,-0.4, not '%s'", value);
    a->picture.cut = true;
    a->picture.cut_normal = pls_scale(pls_vec(v[0], v[1], v[2]), 1.0 / length);
    a->picture.cut_distance = v[3] / length;
    return true;
}

static bool read_background(render_arguments *a, const char *value)
{
    uint8_t *b = a->picture.background;
    unsigned rgb;
    char *end;
    if (strcmp(value, "none") == 0)
        memcpy(b, (const uint8_t[4]){255, 255, 255, 0}, 4);
    else if (strcmp(value, "white") == 0)
        memset(b, 255, 4);
    else if (strcmp(value, "black") == 0)
        memcpy(b, (const uint8_t[4]){0, 0, 0, 255}, 4);
    else if (value[0] == '#' && strlen(value) == 7 && (rgb = (unsigned)strtoul(value + 1, &end, 16), !*end))
        memcpy(b, (const uint8_t[4]){(uint8_t)(rgb >> 16), (uint8_t)(rgb >> 8 & 255), (uint8_t)(rgb & 255), 255}, 4);
    else
        return wrong("--background takes white, black, none or #rrggbb, not '%s'", value);
    return true;
}

static bool read_positive(const char *format, const char *value, double most, double *out)
{
    if (pls_parse_double(value, out) && *out > 0.0 && *out <= most) return true;
    return wrong(format, value);
}

static bool read_frame(render_arguments *a, const char *value)
{
    char *end;
    a->frame = strtol(value, &end, 10);
    if (end == value || *end) return wrong("--frame takes a whole number, not '%s'", value);
    return a->has_frame = true;
}

static bool add_word(const char **words, size_t *count, const char *value, const char *option)
{
    if (*count == RENDER_MOST_WORDS)
    {
        cli_wrong_usage(&cli_render, "%s may be given %d times at most", option, RENDER_MOST_WORDS);
        return false;
    }
    words[(*count)++] = value;
    return true;
}

static bool add_override(render_arguments *a, const char *value)
{
    if (!strchr(value, '=')) return wrong("--set takes PATH=VALUE, such as vars.kn=30, not '%s'", value);
    return add_word(a->overrides, &a->gallery.override_count, value, "--set");
}

static bool choose_series(render_arguments *a, render_series series)
{
    if (a->series != RENDER_ONE && a->series != series) return wrong("give one of --animate and --each%s", "");
    a->series = series;
    return true;
}

bool render_read_option(render_arguments *a, int option, const char *value)
{
    switch (option)
    {
        case OUTPUT: a->output = value; return true;
        case COLOUR: a->colour = value; return true;
        case RANGE: return read_range(a, value);
        case MAP: return read_map(a, value);
        case SIZE: return read_size(a, value);
        case VIEW: return read_view(a, value);
        case CAMERA: return read_camera(a, value);
        case ZOOM: return read_positive("--zoom takes a factor above 0 and up to 1000, not '%s'", value, 1000.0, &a->zoom);
        case ORTHOGRAPHIC: return a->orthographic = true;
        case WALLS: return read_walls(a, value);
        case HIDE: return add_word(a->hide, &a->look.hide_count, value, "--hide");
        case SECTION: return read_section(a, value);
        case BACKGROUND: return read_background(a, value);
        case NO_BAR: return a->no_bar = true;
        case NO_SHADOWS: a->picture.shadows = false; return true;
        case TIME: return cli_read_time(&cli_render, "--time", value, &a->time);
        case FRAME: return read_frame(a, value);
        case FRAMES: a->gallery.frames = value; return true;
        case ANIMATE: return choose_series(a, RENDER_ANIMATION);
        case EACH: return choose_series(a, RENDER_EACH);
        case FPS: return read_positive("--fps takes frames per second, above 0 and up to 100, not '%s'", value, 100.0, &a->fps);
        case SET: return add_override(a, value);
        case THREADS: return cli_set_threads(&cli_render, value);
        case QUIET: return a->quiet = true;
        default: return false;
    }
}
