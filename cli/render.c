// render.c -- particls render: pictures of scenes, runs, frames and checkpoints.
//
// First all moments that are asked for are looked through, to find one range of colours and one camera for them; then each is drawn. One picture is a series of one.

#include "render.h"

#include "base/clock.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const double field_of_view = 0.5; ///< from the lower to the upper edge [rad]

/// The work at hand.
typedef struct studio
{
    render_arguments *a;
    pls_gallery gallery;
    size_t first, last; ///< moments to be drawn
    pls_paint paint;
    bool painted; ///< `paint` is chosen
    pls_render_camera camera;
    pls_frame frame; ///< of moment `loaded`
    size_t loaded;   ///< SIZE_MAX: none
    pls_render_item *items;
    size_t item_count;
    char caption[64];
} studio;

static void unload(studio *s)
{
    pls_frame_free(&s->frame);
    pls_release(&s->items);
    s->loaded = SIZE_MAX;
}

/// The bodies at moment k, with their values; kept until another is asked for.
static pls_status load(studio *s, size_t k)
{
    if (s->loaded == k) return PLS_OK;
    unload(s);
    PLS_TRY(pls_gallery_load(&s->gallery, k, &s->frame));
    if (!s->painted) PLS_TRY(pls_paint_choose(&s->paint, &s->gallery, &s->frame, s->a->colour));
    s->painted = true;
    PLS_TRY(pls_gallery_items(&s->gallery, &s->frame, &s->a->look, &s->items, &s->item_count));
    s->loaded = k;
    return pls_paint_apply(&s->paint, &s->frame, s->items);
}

// ---- the look ---------------------------------------------------------------------------------------------------------------------------

static bool is_flat(const studio *s) { return pls_gallery_dimension(&s->gallery) == 2; }

static void set_view(studio *s)
{
    render_arguments *a = s->a;
    if (is_flat(s)) // there is one side to look at
        render_look_from(a, pls_vec(0.0, 0.0, 1.0));
    else if (pls_length(a->direction) == 0.0)
        render_look_from(a, (pls_vec3)RENDER_ISO);
}

/// Light from above the eye, a little to the left: three sides of a box then have three shades.
static void set_light(studio *s)
{
    pls_vec3 forward = pls_unit(pls_sub(s->camera.target, s->camera.eye)), right = pls_unit(pls_cross(forward, s->camera.up));
    pls_vec3 up = pls_cross(right, forward);
    s->a->picture.light = pls_sub(pls_sub(pls_scale(up, 0.55), pls_scale(right, 0.15)), pls_scale(forward, 0.8));
}

/// What the bar says; its range follows from the values.
static void set_bar(studio *s)
{
    pls_render_options *o = &s->a->picture;
    o->bar = s->paint.field[0] && !s->a->no_bar;
    o->title = s->paint.title;
    o->unit = s->paint.unit;
    o->labels = s->paint.categorical ? s->paint.label : NULL;
    if (s->paint.categorical) o->colours = PLS_RENDER_CATEGORICAL;
    o->low = s->paint.low;
    o->high = s->paint.high;
}

static void set_range(studio *s)
{
    render_arguments *a = s->a;
    if (a->has_range && !s->paint.categorical)
    {
        s->paint.low = a->low;
        s->paint.high = a->high;
    }
    else
        pls_paint_settle(&s->paint);
    a->picture.low = s->paint.low;
    a->picture.high = s->paint.high;
    if (!a->has_map || s->paint.categorical) a->picture.colours = pls_paint_map(&s->paint);
}

static void set_camera(studio *s, const pls_render_framing *framing)
{
    render_arguments *a = s->a;
    s->camera = a->has_camera ? a->camera : pls_render_framing_end(framing);
    if (a->has_camera) s->camera.field_of_view = field_of_view;
    s->camera.field_of_view = 2.0 * atan(tan(0.5 * s->camera.field_of_view) / a->zoom);
    s->camera.height /= a->zoom;
}

/// Look through all moments for the range and for a camera that shows them.
static pls_status survey(studio *s)
{
    set_view(s);
    PLS_TRY(load(s, s->first));
    set_bar(s);
    double angle = is_flat(s) || s->a->orthographic ? 0.0 : field_of_view;
    pls_render_framing framing = pls_render_framing_start(s->a->direction, s->a->up, angle, &s->a->picture);
    for (size_t k = s->first; k <= s->last; ++k)
    {
        PLS_TRY(load(s, k));
        pls_paint_see(&s->paint, s->items, s->item_count);
        pls_render_framing_add(&framing, s->items, s->item_count);
    }
    set_range(s);
    set_camera(s, &framing);
    set_light(s);
    return PLS_OK;
}

// ---- pictures ---------------------------------------------------------------------------------------------------------------------------

static pls_status draw(studio *s, size_t k, pls_render_picture *picture)
{
    PLS_TRY(load(s, k));
    snprintf(s->caption, sizeof s->caption, "t = %.6g s", s->frame.time);
    bool start = s->gallery.moment[k].kind == PLS_MOMENT_START;
    s->a->picture.caption = start || s->a->no_bar ? NULL : s->caption;
    return pls_render_image(s->items, s->item_count, &s->camera, &s->a->picture, picture);
}

/// "3 of 20" on a terminal.
static void tell_progress(const studio *s, size_t k)
{
    if (s->a->quiet || s->first == s->last || isatty(STDOUT_FILENO) != 1) return;
    printf("\r\033[Kpicture %zu of %zu", k - s->first + 1, s->last - s->first + 1);
    if (k == s->last) printf("\r\033[K");
    fflush(stdout);
}

/// "out.png" -> "out_000003.png"
static void number_path(char path[RENDER_PATH_SIZE], const char *output, size_t number)
{
    snprintf(path, RENDER_PATH_SIZE, "%.*s_%06zu.png", (int)(strlen(output) - strlen(".png")), output, number);
}

static pls_status write_pictures(studio *s)
{
    pls_status status = PLS_OK;
    for (size_t k = s->first; k <= s->last && status == PLS_OK; ++k)
    {
        char path[RENDER_PATH_SIZE];
        snprintf(path, sizeof path, "%s", s->a->output);
        if (s->a->series == RENDER_EACH) number_path(path, s->a->output, k);
        pls_render_picture picture = {0};
        tell_progress(s, k);
        status = draw(s, k, &picture);
        if (status == PLS_OK) status = pls_png_write(path, &picture);
        pls_render_picture_free(&picture);
    }
    return status;
}

static pls_status write_animation(studio *s)
{
    pls_apng film = {0};
    PLS_TRY(pls_apng_open(&film, s->a->output, (uint16_t)lround(1000.0 / s->a->fps), 0));
    pls_status status = PLS_OK;
    for (size_t k = s->first; k <= s->last && status == PLS_OK; ++k)
    {
        pls_render_picture picture = {0};
        tell_progress(s, k);
        status = draw(s, k, &picture);
        if (status == PLS_OK) status = pls_apng_add(&film, &picture);
        pls_render_picture_free(&picture);
    }
    if (status == PLS_OK) status = pls_apng_close(&film);
    pls_apng_abandon(&film);
    return status;
}

// ---- which moments ------------------------------------------------------------------------------------------------------------------------

static pls_status fail_frame(const studio *s)
{
    return pls_fail(PLS_NOT_FOUND, "there is no frame %ld: \"%s\" holds %zu, from 0 to %zu", s->a->frame, s->a->path, s->gallery.count,
                    s->gallery.count - 1);
}

static pls_status choose_moments(studio *s)
{
    const render_arguments *a = s->a;
    size_t count = s->gallery.count;
    bool all = a->series != RENDER_ONE;
    s->first = all ? 0 : count - 1;
    s->last = count - 1;
    if (!isnan(a->time)) s->first = s->last = pls_gallery_nearest(&s->gallery, a->time);
    if (!a->has_frame) return PLS_OK;
    long number = a->frame < 0 ? (long)count + a->frame : a->frame;
    if (number < 0 || (size_t)number >= count) return fail_frame(s);
    s->first = s->last = (size_t)number;
    return PLS_OK;
}

static void tell_result(const studio *s, double wall)
{
    const render_arguments *a = s->a;
    if (a->quiet) return;
    size_t pictures = s->last - s->first + 1, bodies = 0;
    char path[RENDER_PATH_SIZE], time[32];
    for (size_t k = 0; k < s->item_count; ++k) bodies += s->items[k].opacity > 0.0f && !s->items[k].shape->ops->unbounded;
    snprintf(path, sizeof path, "%s", a->output);
    if (a->series == RENDER_EACH) number_path(path, a->output, s->first);
    printf("%s%s: ", path, a->series == RENDER_EACH ? " ..." : "");
    if (pictures > 1) printf("%zu pictures, ", pictures);
    printf("%d x %d, %zu bodies, t = %.6g s", a->picture.width, a->picture.height, bodies, s->frame.time);
    if (s->paint.field[0] && !s->paint.categorical)
        printf(", %s %.4g to %.4g %s", s->paint.title, s->paint.low, s->paint.high, s->paint.unit);
    printf(" (%s)\n", cli_duration(time, wall));
}

static pls_status carry_out(studio *s)
{
    double start = pls_clock();
    PLS_TRY(pls_gallery_open(&s->gallery, s->a->path, &s->a->gallery));
    PLS_TRY(choose_moments(s));
    PLS_TRY(survey(s));
    PLS_TRY(s->a->series == RENDER_ANIMATION ? write_animation(s) : write_pictures(s));
    tell_result(s, pls_clock() - start);
    return PLS_OK;
}

// ---- the verb -----------------------------------------------------------------------------------------------------------------------------

/// "runs/pack.run/" -> "pack.png"
static void default_output(char output[RENDER_PATH_SIZE], const char *path)
{
    size_t end = strlen(path);
    while (end > 1 && path[end - 1] == '/') --end;
    size_t begin = end;
    while (begin > 0 && path[begin - 1] != '/') --begin;
    size_t length = end - begin;
    for (size_t k = end; k > begin + 1; --k)
    {
        if (path[k - 1] != '.') continue;
        if (k > begin + 2 || path[begin] != '.') length = k - 1 - begin; // "..", "." are no names with a suffix
        break;
    }
    bool dots = strspn(path + begin, ".") >= length;
    snprintf(output, RENDER_PATH_SIZE, "%.*s.png", dots ? 7 : (int)(length < 200 ? length : 200), dots ? "picture" : path + begin);
}

static bool is_png(const char *name)
{
    size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".png") == 0;
}

static int check_arguments(const render_arguments *a)
{
    if (!is_png(a->output)) return cli_wrong_usage(&cli_render, "--output takes the name of a PNG file, FILE.png, not '%s'", a->output);
    if (strlen(a->output) > RENDER_PATH_SIZE - 32) return cli_wrong_usage(&cli_render, "the name of the picture is too long");
    int choices = a->has_frame + !isnan(a->time) + (a->series != RENDER_ONE);
    if (choices > 1) return cli_wrong_usage(&cli_render, "give one of --frame, --time, --animate and --each");
    return CLI_DONE;
}

static int render(render_arguments *a)
{
    char output[RENDER_PATH_SIZE];
    default_output(output, a->path);
    if (!a->output) a->output = output;
    a->gallery.overrides = a->overrides;
    a->look.hide = a->hide;
    a->gallery.forces = a->colour && (strncmp(a->colour, "force", 5) == 0 || strncmp(a->colour, "torque", 6) == 0);
    int code = check_arguments(a);
    if (code != CLI_DONE) return code;
    studio s = {.a = a, .loaded = SIZE_MAX};
    pls_status status = carry_out(&s);
    unload(&s);
    pls_paint_free(&s.paint);
    pls_gallery_free(&s.gallery);
    return status == PLS_OK ? CLI_DONE : cli_failed(cli_code_of(status));
}

static int run(int argc, char **argv)
{
    render_arguments a = {.picture = pls_render_defaults(), .look = {.wall_opacity = 0.35f}, .time = NAN, .fps = 10.0, .zoom = 1.0};
    const uint8_t plain[3] = {126, 158, 186};
    memcpy(a.picture.plain, plain, sizeof plain);
    const char *value;
    int option;
    while ((option = cli_next_option(&cli_render, argc, argv, &value)) != CLI_NO_MORE)
    {
        if (option == CLI_HELP) return CLI_DONE;
        if (option == CLI_WRONG || !render_read_option(&a, option, value)) return CLI_USAGE;
    }
    a.path = cli_only_argument(&cli_render, argc, argv, "run directory, frame, checkpoint or scene");
    return a.path ? render(&a) : CLI_USAGE;
}

const cli_verb cli_render = {
    .name = "render",
    .arguments = "DIR|FILE",
    .summary = "draw a run, a frame, a checkpoint or a scene",
    .about =
        "Draws a PNG picture of a run directory (its last frame, or its last checkpoint where there are no frames), of one frame (.vtp) "
        "or\n"
        "checkpoint (.h5) of a run directory, or of a scene (.yaml) before its first step. Every shape is drawn from its signed distance.",
    .example = "  particls render scene.run -o picture.png --colour velocity\n"
               "  particls render scene.run -o movie.png --animate --fps 20",
    .options = render_options,
    .function = run,
};
