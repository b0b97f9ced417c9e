// image.c -- how a point of a body looks, and the picture made of that.
//
// Each pixel follows from the stage alone, so threads cannot matter. Pixels whose neighbours show another body are drawn again with four rays.

#include "base/parallel.h"
#include "render/stage.h"

#include <string.h>

enum { MOST_SIZE = 16384, MOST_LAYERS = 16, SHADES = 8192 };

/// What it takes to make bytes of what rays bring.
typedef struct film
{
    const pls_stage *stage;
    uint8_t *shade; ///< sRGB of linear light
    uint32_t *what; ///< what is met first in each pixel, to find edges by
    uint8_t *rgba;
} film;

/// What a ray brings: light (premultiplied, linear), how much it was stopped, and what was met first, to find edges by.
typedef struct sample
{
    float light[3], opacity;
    uint32_t what;
} sample;
pls_render_options pls_render_defaults(void)
{
    return (pls_render_options){.width = 1280,
                                .height = 720,
                                .high = 1.0,
                                .background = {255, 255, 255, 255},
                                .plain = {160, 160, 160},
                                .light = {0.4, -0.5, 1.0},
                                .softness = 0.08,
                                .ambient = 0.4,
                                .shadows = true,
                                .smooth_edges = true,
                                .bar = true};
}

/// Flat shapes are drawn as if their edge were bevelled, so that neighbours stand apart.
static pls_vec3 bevel(const pls_stage_body *b, pls_vec3 p)
{
    pls_vec3 X = pls_stage_to_shape(b->item, p);
    X.z = 0.0;
    double width = 0.3 * (isfinite(b->item->shape->radius) ? b->item->shape->radius : 0.0);
    double depth = -pls_shape_sdf(b->item->shape, X), slope = width > 0.0 ? 1.0 - pls_stage_smooth(depth / width) : 0.0;
    pls_vec3 g = pls_stage_turn_out(b->item, pls_shape_gradient(b->item->shape, X));
    return pls_unit(pls_add(pls_scale(g, slope), pls_vec(0.0, 0.0, 1.0)));
}

/// Whether a point that was met is on the face that the cut leaves.
static bool on_cut(const pls_stage *s, const pls_stage_body *b, pls_vec3 p)
{
    if (!s->options->cut || (b->kind != PLS_STAGE_BALL && b->kind != PLS_STAGE_TRACED)) return false;
    return fabs(pls_dot(s->options->cut_normal, p) - s->options->cut_distance) < 1e-7 * b->radius;
}

static pls_vec3 normal_at(const pls_stage_body *b, pls_vec3 p)
{
    if (b->kind == PLS_STAGE_BALL) return pls_scale(pls_sub(p, b->centre), 1.0 / b->radius);
    if (b->kind == PLS_STAGE_PLANE || b->kind == PLS_STAGE_TRIANGLE) return b->normal;
    if (b->kind == PLS_STAGE_FLAT) return bevel(b, p);
    pls_vec3 g = pls_shape_gradient(b->item->shape, pls_stage_to_shape(b->item, p));
    double length = pls_length(g);
    return length > 0.0 ? pls_stage_turn_out(b->item, pls_scale(g, 1.0 / length)) : pls_vec(0.0, 0.0, 1.0);
}

/// Which of two sorts of squares of a plane a point is in.
static unsigned checker(const pls_stage *s, const pls_stage_body *b, pls_vec3 p)
{
    pls_vec3 n = b->normal, helper = fabs(n.x) < 0.6 ? pls_vec(1.0, 0.0, 0.0) : pls_vec(0.0, 1.0, 0.0);
    pls_vec3 u = pls_unit(pls_sub(helper, pls_scale(n, pls_dot(n, helper)))), v = pls_cross(n, u), d = pls_sub(p, s->middle);
    return (unsigned)((long)floor(pls_dot(d, u) / s->check) + (long)floor(pls_dot(d, v) / s->check)) & 1u;
}

/// A plane fades with the distance from the bodies, so that it has no horizon.
static double fade(const pls_stage *s, const pls_stage_body *b, pls_vec3 p)
{
    if (b->kind != PLS_STAGE_PLANE) return 1.0;
    return 1.0 - pls_stage_smooth((pls_length(pls_sub(p, s->middle)) / s->reach - 1.5) / 3.0);
}

/// Lambert's law, light from around, a little from the eye, and a gloss.
static void shade(const pls_stage *s, const pls_render_ray *ray, pls_stage_hit at, double weight, sample *out)
{
    const pls_stage_body *b = &s->bodies[at.body];
    pls_vec3 p = pls_add(ray->origin, pls_scale(ray->direction, at.t));
    pls_vec3 n = on_cut(s, b, p) ? s->options->cut_normal : normal_at(b, p);
    if (b->kind == PLS_STAGE_TRIANGLE && pls_dot(n, ray->direction) > 0.0) n = pls_scale(n, -1.0); // both sides are outside
    double facing = pls_dot(n, s->light), ambient = s->options->ambient, direct = 0.0, gloss = 0.0;
    if (facing > 0.0)
    {
        double visible = pls_stage_lit(s, pls_add(p, pls_scale(n, b->kind == PLS_STAGE_PLANE ? 0.0 : 1e-6 * b->radius)), at.body);
        double mirrored = 2.0 * facing * pls_dot(n, ray->direction) - pls_dot(s->light, ray->direction);
        double power = mirrored * mirrored * mirrored * mirrored;
        direct = visible * facing;
        if (mirrored < 0.0 && b->kind != PLS_STAGE_PLANE && b->kind != PLS_STAGE_FLAT)
            gloss = 0.06 * visible * power * power * power * power * power;
    }
    double around = ambient * (0.55 + 0.25 * pls_dot(n, s->view.up) + 0.2 * fabs(pls_dot(n, ray->direction)));
    double brightness = around + (1.0 - ambient) * direct * 1.15;
    if (b->kind == PLS_STAGE_PLANE && checker(s, b, p)) brightness *= 0.88;
    for (int c = 0; c < 3; ++c) out->light[c] += (float)(weight * (b->albedo[c] * brightness + gloss));
}

static sample look(const pls_stage *s, double x, double y, uint32_t tile)
{
    sample out = {.what = 0};
    pls_render_ray ray = pls_render_view_ray(&s->view, x, y);
    pls_stage_hit at = {-INFINITY, 0};
    for (int layer = 0; layer < MOST_LAYERS && out.opacity < 0.995f; ++layer)
    {
        at = pls_stage_next(s, &ray, tile, at);
        if (at.body == UINT32_MAX) break;
        const pls_stage_body *b = &s->bodies[at.body];
        pls_vec3 p = pls_add(ray.origin, pls_scale(ray.direction, at.t));
        if (layer == 0) out.what = (b->kind == PLS_STAGE_PLANE ? 2u * at.body + checker(s, b, p) : 2u * at.body) + 1u;
        double weight = (1.0 - (double)out.opacity) * (double)b->opacity * fade(s, b, p);
        if (weight > 0.0) shade(s, &ray, at, weight, &out);
        out.opacity += (float)weight;
    }
    return out;
}

/// Over the background, as bytes.
static void put(const film *f, const sample *in, uint8_t *pixel)
{
    const uint8_t *ground = f->stage->options->background;
    if (in->opacity <= 0.0f)
    {
        memcpy(pixel, ground, 4);
        return;
    }
    double behind = (1.0 - (double)in->opacity) * ground[3] / 255.0, opacity = fmin((double)in->opacity + behind, 1.0);
    for (int c = 0; c < 3; ++c)
    {
        double light = ((double)in->light[c] + (behind > 0.0 ? behind * pls_render_linear_from_srgb(ground[c]) : 0.0)) / opacity;
        pixel[c] = f->shade[(int)(fmin(fmax(light, 0.0), 1.0) * (SHADES - 1) + 0.5)];
    }
    pixel[3] = (uint8_t)(opacity * 255.0 + 0.5);
}

static pls_status make_shades(film *f)
{
    PLS_TRY(pls_allocate(&f->shade, SHADES, 1, "the shades of a picture"));
    for (int k = 0; k < SHADES; ++k)
    {
        double v = k / (double)(SHADES - 1);
        f->shade[k] = (uint8_t)lround(255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055));
    }
    return PLS_OK;
}

typedef struct tile_range
{
    int x0, y0, x1, y1;
} tile_range;

static tile_range range_of(const pls_stage *s, int tile)
{
    int x = tile % s->tiles.columns * PLS_STAGE_TILE, y = tile / s->tiles.columns * PLS_STAGE_TILE;
    return (tile_range){x, y, x + PLS_STAGE_TILE < s->view.width ? x + PLS_STAGE_TILE : s->view.width,
                        y + PLS_STAGE_TILE < s->view.height ? y + PLS_STAGE_TILE : s->view.height};
}

static void draw_tile(const film *f, int tile)
{
    const pls_stage *s = f->stage;
    tile_range r = range_of(s, tile);
    for (int y = r.y0; y < r.y1; ++y)
    {
        for (int x = r.x0; x < r.x1; ++x)
        {
            size_t k = (size_t)y * (size_t)s->view.width + (size_t)x;
            sample in = look(s, x + 0.5, y + 0.5, (uint32_t)tile);
            f->what[k] = in.what;
            put(f, &in, &f->rgba[4 * k]);
        }
    }
}

/// Whether a neighbour shows something else.
static bool on_edge(const pls_stage *s, const uint32_t *what, int x, int y)
{
    int w = s->view.width;
    const uint32_t *here = &what[(size_t)y * (size_t)w + (size_t)x];
    return (x > 0 && here[-1] != *here) || (x + 1 < w && here[1] != *here) || (y > 0 && here[-w] != *here) ||
           (y + 1 < s->view.height && here[w] != *here);
}

static sample look_four(const pls_stage *s, int x, int y, uint32_t tile)
{
    sample sum = {.what = 0};
    for (int k = 0; k < 4; ++k)
    {
        sample one = look(s, x + 0.25 + 0.5 * (k & 1), y + 0.25 + 0.5 * (k >> 1), tile);
        for (int c = 0; c < 3; ++c) sum.light[c] += 0.25f * one.light[c];
        sum.opacity += 0.25f * one.opacity;
    }
    return sum;
}

static void smooth_tile(const film *f, int tile)
{
    const pls_stage *s = f->stage;
    tile_range r = range_of(s, tile);
    for (int y = r.y0; y < r.y1; ++y)
    {
        for (int x = r.x0; x < r.x1; ++x)
        {
            if (!on_edge(s, f->what, x, y)) continue;
            sample in = look_four(s, x, y, (uint32_t)tile);
            put(f, &in, &f->rgba[4 * ((size_t)y * (size_t)s->view.width + (size_t)x)]);
        }
    }
}

static void draw(const film *f)
{
    const pls_stage *s = f->stage;
    int tiles = s->tiles.columns * s->tiles.rows, threads = s->options->threads > 0 ? s->options->threads : pls_threads();
#pragma omp parallel num_threads(threads)
    {
#pragma omp for schedule(dynamic, 4)
        for (int tile = 0; tile < tiles; ++tile) draw_tile(f, tile);
#pragma omp for schedule(dynamic, 4)
        for (int tile = 0; tile < tiles; ++tile)
        {
            if (s->options->smooth_edges) smooth_tile(f, tile);
        }
    }
    (void)threads;
}

static pls_status check_options(const pls_render_options *o)
{
    if (o->width < 1 || o->height < 1 || o->width > MOST_SIZE || o->height > MOST_SIZE)
        return pls_fail(PLS_INVALID_ARGUMENT, "cannot draw a picture of %d x %d pixels: give 1 to %d each", o->width, o->height, MOST_SIZE);
    if (!(o->high > o->low) || !isfinite(o->high - o->low))
        return pls_fail(PLS_INVALID_ARGUMENT, "the colours of a picture go from %g to %g: give a high end above the low one", o->low,
                        o->high);
    double light = pls_length(o->light);
    if (!(light > 0.0) || !isfinite(light))
        return pls_fail(PLS_INVALID_ARGUMENT, "the light of a picture comes from (%g, %g, %g): give a direction", o->light.x, o->light.y,
                        o->light.z);
    if (!(o->ambient >= 0.0 && o->ambient <= 1.0 && o->softness >= 0.0 && o->softness <= 10.0))
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "the light of a picture has an ambient part of %g and a softness of %g: give 0 to 1 and 0 to 10", o->ambient,
                        o->softness);
    if (o->cut && !(fabs(pls_length(o->cut_normal) - 1.0) < 1e-6 && isfinite(o->cut_distance)))
        return pls_fail(PLS_INVALID_ARGUMENT, "a picture is cut by the plane (%g, %g, %g) . x = %g: give a unit vector and a distance",
                        o->cut_normal.x, o->cut_normal.y, o->cut_normal.z, o->cut_distance);
    return PLS_OK;
}

pls_status pls_render_image(const pls_render_item *items, size_t count, const pls_render_camera *camera, const pls_render_options *options,
                            pls_render_picture *picture)
{
    *picture = (pls_render_picture){0};
    PLS_TRY(check_options(options));
    pls_stage s = {.options = options};
    PLS_TRY(pls_render_view_make(camera, options->width, options->height, &s.view));
    size_t pixels = (size_t)options->width * (size_t)options->height;
    film f = {.stage = &s};
    pls_status status = pls_stage_make(&s, items, count);
    if (status == PLS_OK) status = make_shades(&f);
    if (status == PLS_OK) status = pls_allocate(&f.what, pixels, sizeof *f.what, "a picture");
    if (status == PLS_OK) status = pls_allocate(&picture->rgba, pixels, 4, "a picture");
    if (status == PLS_OK)
    {
        f.rgba = picture->rgba;
        picture->width = options->width;
        picture->height = options->height;
        draw(&f);
        if (options->bar) pls_render_bar(picture, options);
        pls_render_caption(picture, options);
    }
    pls_release(&f.what);
    pls_release(&f.shade);
    pls_stage_free(&s);
    return status;
}
