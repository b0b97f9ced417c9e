// colour.c -- colours that tell values, and the bar that tells the colours.
//
// Viridis (Smith & van der Walt, A better default colormap for Matplotlib, SciPy 2015; in the public domain by CC0): equal steps of the value look equally large, in grey
// and to most colour-blind eyes too; magma is by the same authors. Coolwarm is Moreland's diverging map (Diverging color maps for scientific visualization, ISVC 2009).
// Nine colours of each, straight lines between them. Categories: the eight colours of Okabe & Ito, Color universal design (2008).

#include "render/render.h"

#include <stdio.h>
#include <string.h>

enum {
    ANCHORS = 9,
    CATEGORIES = 8,
    MOST_CATEGORIES = 16, ///< in a bar; more have colours but no names
    MOST_TICKS = 12,
    LABEL_SIZE = 25,
    TITLE_SIZE = 160
};

typedef const uint8_t anchors[ANCHORS][3];

static anchors viridis = {{68, 1, 84},    {71, 45, 123}, {59, 82, 139},  {44, 114, 142}, {33, 145, 140},
                          {40, 174, 128}, {94, 201, 98}, {173, 220, 48}, {253, 231, 37}};
static anchors magma = {{0, 0, 4},      {28, 16, 68},   {79, 18, 123},   {129, 37, 129}, {181, 54, 122},
                        {229, 80, 100}, {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
static anchors coolwarm = {{59, 76, 192},   {98, 130, 234},  {141, 176, 254}, {184, 208, 249}, {221, 221, 221},
                           {245, 196, 173}, {244, 154, 123}, {222, 96, 77},   {180, 4, 38}};
static anchors grey = {{40, 40, 40},    {66, 66, 66},    {91, 91, 91},    {117, 117, 117}, {142, 142, 142},
                       {168, 168, 168}, {193, 193, 193}, {219, 219, 219}, {244, 244, 244}};
static const uint8_t categories[CATEGORIES][3] = {{230, 159, 0}, {86, 180, 233}, {0, 158, 115},   {240, 228, 66},
                                                  {0, 114, 178}, {213, 94, 0},   {204, 121, 167}, {90, 90, 90}};

static void between(const anchors map, double t, uint8_t rgb[3])
{
    t = fmin(fmax(t, 0.0), 1.0) * (ANCHORS - 1);
    int k = t < ANCHORS - 2 ? (int)t : ANCHORS - 2;
    for (int c = 0; c < 3; ++c) rgb[c] = (uint8_t)lround(map[k][c] + (t - k) * (map[k + 1][c] - map[k][c]));
}

void pls_render_colour(pls_render_colours colours, double value, double low, double high, uint8_t rgb[3])
{
    double part = high > low ? (value - low) / (high - low) : 0.5;
    switch (colours)
    {
        case PLS_RENDER_VIRIDIS: between(viridis, part, rgb); break;
        case PLS_RENDER_MAGMA: between(magma, part, rgb); break;
        case PLS_RENDER_COOLWARM: between(coolwarm, part, rgb); break;
        case PLS_RENDER_GREY: between(grey, part, rgb); break;
        case PLS_RENDER_CATEGORICAL:
            memcpy(rgb, categories[(int)fmod(fmod(round(fmin(fmax(value, -1e9), 1e9)), CATEGORIES) + CATEGORIES, CATEGORIES)], 3);
            break;
    }
}

double pls_render_linear_from_srgb(uint8_t byte) // IEC 61966-2-1
{
    double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

// ---- the bar --------------------------------------------------------------------------------------------------------------------------

static int text_size(const pls_render_options *options) { return options->height >= 1000 ? 3 : options->height >= 420 ? 2 : 1; }

static int category_count(const pls_render_options *options)
{
    return (int)fmin(round(options->high) - round(options->low) + 1.0, MOST_CATEGORIES);
}

static void category_label(const pls_render_options *options, int k, char label[LABEL_SIZE])
{
    if (options->labels)
        snprintf(label, LABEL_SIZE, "%s", options->labels[k]);
    else
        snprintf(label, LABEL_SIZE, "%.0f", round(options->low) + k);
}

/// Letters beside the bar.
static int label_letters(const pls_render_options *options)
{
    int most = 8;
    for (int k = 0; options->colours == PLS_RENDER_CATEGORICAL && options->labels && k < category_count(options); ++k)
    {
        int letters = (int)strlen(options->labels[k]);
        if (letters > most) most = letters < LABEL_SIZE - 1 ? letters : LABEL_SIZE - 1;
    }
    return most;
}

static void title_text(const pls_render_options *options, char text[TITLE_SIZE])
{
    bool unit = options->unit && *options->unit;
    snprintf(text, TITLE_SIZE, "%s%s%s%s", options->title ? options->title : "", unit ? " [" : "", unit ? options->unit : "",
             unit ? "]" : "");
}

int pls_render_bar_strip(const pls_render_options *options)
{
    char title[TITLE_SIZE];
    title_text(options, title);
    int size = text_size(options), letters = size * (PLS_GLYPH_WIDTH * (label_letters(options) + 1) + 16);
    int titled = pls_render_text_width(title, size) + 8 * size;
    return letters > titled ? letters : titled;
}

void pls_render_bar_place(const pls_render_options *options, int place[4])
{
    int size = text_size(options);
    place[0] = options->width - size * (PLS_GLYPH_WIDTH * (label_letters(options) + 1) + 16);
    place[2] = place[0] + 8 * size;
    place[1] = options->height / 8 + PLS_GLYPH_HEIGHT * size;
    place[3] = options->height - options->height / 8;
}

static void set_pixel(pls_render_picture *picture, int x, int y, const uint8_t rgb[3])
{
    if (x < 0 || y < 0 || x >= picture->width || y >= picture->height) return;
    uint8_t *pixel = &picture->rgba[4 * ((size_t)y * (size_t)picture->width + (size_t)x)];
    memcpy(pixel, rgb, 3);
    pixel[3] = 255;
}

/// Black or white, whatever the background is not; on a background that lets through, grey.
static void ink(const pls_render_options *options, uint8_t rgb[3])
{
    const uint8_t *b = options->background;
    int shade = b[3] < 128 ? 110 : 2 * b[0] + 5 * b[1] + b[2] > 8 * 128 ? 30 : 235;
    memset(rgb, shade, 3);
}

/// A distance between ticks of 1, 2 or 5 times a power of ten that makes four to ten of them.
static double tick_step(double range)
{
    double raw = range / 5.0, power = pow(10.0, floor(log10(raw))), part = raw / power;
    return (part < 1.5 ? 1.0 : part < 3.5 ? 2.0 : part < 7.5 ? 5.0 : 10.0) * power;
}

static void tick(pls_render_picture *picture, const pls_render_options *options, const int place[4], double fraction, const uint8_t rgb[3],
                 const char *label)
{
    int size = text_size(options), y = place[3] - 1 - (int)lround(fraction * (place[3] - 1 - place[1]));
    for (int x = place[2]; x < place[2] + 2 * size; ++x) set_pixel(picture, x, y, rgb);
    pls_render_text(picture, place[2] + 4 * size, y - 3 * size, size, rgb, options->background, label);
}

static void value_ticks(pls_render_picture *picture, const pls_render_options *options, const int place[4], const uint8_t rgb[3])
{
    double range = options->high - options->low, step = tick_step(range), first = ceil(options->low / step - 1e-9);
    for (int k = 0; k < MOST_TICKS; ++k)
    {
        double value = (first + k) * step, fraction = (value - options->low) / range;
        if (fraction > 1.0 + 1e-9) break;
        char label[32];
        snprintf(label, sizeof label, "%.6g", fabs(value) < 1e-9 * step ? 0.0 : value);
        tick(picture, options, place, fmin(fmax(fraction, 0.0), 1.0), rgb, label);
    }
}

/// One tick in the middle of each category's field.
static void category_ticks(pls_render_picture *picture, const pls_render_options *options, const int place[4], const uint8_t rgb[3])
{
    int count = category_count(options);
    for (int k = 0; k < count; ++k)
    {
        char label[LABEL_SIZE];
        category_label(options, k, label);
        tick(picture, options, place, (k + 0.5) / count, rgb, label);
    }
}

static double bar_value(const pls_render_options *options, double fraction)
{
    if (options->colours != PLS_RENDER_CATEGORICAL) return options->low + fraction * (options->high - options->low);
    int count = category_count(options);
    return round(options->low) + fmin(floor(fraction * count), count - 1.0);
}

static void bar_title(pls_render_picture *picture, const pls_render_options *options, const int place[4], const uint8_t rgb[3])
{
    char text[TITLE_SIZE];
    title_text(options, text);
    int size = text_size(options), right = options->width - 4 * size, x = place[0];
    if (x + pls_render_text_width(text, size) > right) x = right - pls_render_text_width(text, size);
    pls_render_text(picture, x > 0 ? x : 0, place[1] - 2 * PLS_GLYPH_HEIGHT * size, size, rgb, options->background, text);
}

void pls_render_caption(pls_render_picture *picture, const pls_render_options *options)
{
    if (!options->caption) return;
    uint8_t rgb[3];
    ink(options, rgb);
    int size = text_size(options);
    pls_render_text(picture, 5 * size, options->height - (PLS_GLYPH_HEIGHT + 4) * size, size, rgb, options->background, options->caption);
}

void pls_render_bar(pls_render_picture *picture, const pls_render_options *options)
{
    int place[4];
    pls_render_bar_place(options, place);
    if (place[0] < 0 || place[3] - place[1] < 8) return; // too small a picture to be read
    uint8_t rgb[3];
    for (int y = place[1]; y < place[3]; ++y)
    {
        double value = bar_value(options, (place[3] - 1 - y) / (double)(place[3] - 1 - place[1]));
        pls_render_colour(options->colours, value, options->low, options->high, rgb);
        for (int x = place[0]; x < place[2]; ++x) set_pixel(picture, x, y, rgb);
    }
    ink(options, rgb);
    if (options->colours == PLS_RENDER_CATEGORICAL)
        category_ticks(picture, options, place, rgb);
    else
        value_ticks(picture, options, place, rgb);
    bar_title(picture, options, place, rgb);
}
