// text.c -- letters of five by seven dots, for the colour bar.
//
// Drawn by hand, one byte a row, the left dot in bit 4. Neighbouring dots are joined by strokes with round ends, which are drawn from their distance, with soft edges: letters
// are smooth at any size. Enough for numbers, units and short titles; a picture needs no font on the machine it is drawn on. What has no
// letter here is drawn as a hollow box. Greek mu, the degree sign and the raised 2 and 3 are read as UTF-8.

#include "render/render.h"

#include <string.h>

enum { ROWS = 7, DOTS = 5 };
static const double half_stroke = 0.5; ///< of a stroke's width [dots]
static const double rim_width = 1.0, rim_opacity = 0.7;

typedef struct glyph
{
    const char *name;
    uint8_t row[ROWS];
} glyph;

static const glyph glyphs[] = {
    {" ", {0, 0, 0, 0, 0, 0, 0}},
    {"0", {14, 17, 19, 21, 25, 17, 14}},
    {"1", {4, 12, 4, 4, 4, 4, 14}},
    {"2", {14, 17, 1, 2, 4, 8, 31}},
    {"3", {31, 2, 4, 2, 1, 17, 14}},
    {"4", {2, 6, 10, 18, 31, 2, 2}},
    {"5", {31, 16, 30, 1, 1, 17, 14}},
    {"6", {6, 8, 16, 30, 17, 17, 14}},
    {"7", {31, 1, 2, 4, 8, 8, 8}},
    {"8", {14, 17, 17, 14, 17, 17, 14}},
    {"9", {14, 17, 17, 15, 1, 2, 12}},
    {"A", {14, 17, 17, 31, 17, 17, 17}},
    {"B", {30, 17, 17, 30, 17, 17, 30}},
    {"C", {14, 17, 16, 16, 16, 17, 14}},
    {"D", {28, 18, 17, 17, 17, 18, 28}},
    {"E", {31, 16, 16, 30, 16, 16, 31}},
    {"F", {31, 16, 16, 30, 16, 16, 16}},
    {"G", {14, 17, 16, 23, 17, 17, 15}},
    {"H", {17, 17, 17, 31, 17, 17, 17}},
    {"I", {14, 4, 4, 4, 4, 4, 14}},
    {"J", {7, 2, 2, 2, 2, 18, 12}},
    {"K", {17, 18, 20, 24, 20, 18, 17}},
    {"L", {16, 16, 16, 16, 16, 16, 31}},
    {"M", {17, 27, 21, 21, 17, 17, 17}},
    {"N", {17, 17, 25, 21, 19, 17, 17}},
    {"O", {14, 17, 17, 17, 17, 17, 14}},
    {"P", {30, 17, 17, 30, 16, 16, 16}},
    {"Q", {14, 17, 17, 17, 21, 18, 13}},
    {"R", {30, 17, 17, 30, 20, 18, 17}},
    {"S", {15, 16, 16, 14, 1, 1, 30}},
    {"T", {31, 4, 4, 4, 4, 4, 4}},
    {"U", {17, 17, 17, 17, 17, 17, 14}},
    {"V", {17, 17, 17, 17, 17, 10, 4}},
    {"W", {17, 17, 17, 21, 21, 21, 10}},
    {"X", {17, 17, 10, 4, 10, 17, 17}},
    {"Y", {17, 17, 17, 10, 4, 4, 4}},
    {"Z", {31, 1, 2, 4, 8, 16, 31}},
    {"a", {0, 0, 14, 1, 15, 17, 15}},
    {"b", {16, 16, 22, 25, 17, 17, 30}},
    {"c", {0, 0, 14, 16, 16, 17, 14}},
    {"d", {1, 1, 13, 19, 17, 17, 15}},
    {"e", {0, 0, 14, 17, 31, 16, 14}},
    {"f", {6, 9, 8, 28, 8, 8, 8}},
    {"g", {0, 0, 15, 17, 15, 1, 14}},
    {"h", {16, 16, 22, 25, 17, 17, 17}},
    {"i", {4, 0, 12, 4, 4, 4, 14}},
    {"j", {2, 0, 6, 2, 2, 18, 12}},
    {"k", {16, 16, 18, 20, 24, 20, 18}},
    {"l", {12, 4, 4, 4, 4, 4, 14}},
    {"m", {0, 0, 26, 21, 21, 17, 17}},
    {"n", {0, 0, 22, 25, 17, 17, 17}},
    {"o", {0, 0, 14, 17, 17, 17, 14}},
    {"p", {0, 0, 30, 17, 30, 16, 16}},
    {"q", {0, 0, 13, 19, 15, 1, 1}},
    {"r", {0, 0, 22, 25, 16, 16, 16}},
    {"s", {0, 0, 14, 16, 14, 1, 30}},
    {"t", {8, 8, 28, 8, 8, 9, 6}},
    {"u", {0, 0, 17, 17, 17, 19, 13}},
    {"v", {0, 0, 17, 17, 17, 10, 4}},
    {"w", {0, 0, 17, 17, 21, 21, 10}},
    {"x", {0, 0, 17, 10, 4, 10, 17}},
    {"y", {0, 0, 17, 17, 15, 1, 14}},
    {"z", {0, 0, 31, 2, 4, 8, 31}},
    {".", {0, 0, 0, 0, 0, 12, 12}},
    {",", {0, 0, 0, 0, 12, 4, 8}},
    {":", {0, 12, 12, 0, 12, 12, 0}},
    {"-", {0, 0, 0, 31, 0, 0, 0}},
    {"+", {0, 4, 4, 31, 4, 4, 0}},
    {"=", {0, 0, 31, 0, 31, 0, 0}},
    {"/", {0, 1, 2, 4, 8, 16, 0}},
    {"*", {0, 4, 21, 14, 21, 4, 0}},
    {"^", {4, 10, 17, 0, 0, 0, 0}},
    {"_", {0, 0, 0, 0, 0, 0, 31}},
    {"%", {24, 25, 2, 4, 8, 19, 3}},
    {"|", {4, 4, 4, 4, 4, 4, 4}},
    {"(", {2, 4, 8, 8, 8, 4, 2}},
    {")", {8, 4, 2, 2, 2, 4, 8}},
    {"[", {14, 8, 8, 8, 8, 8, 14}},
    {"]", {14, 2, 2, 2, 2, 2, 14}},
    {"<", {2, 4, 8, 16, 8, 4, 2}},
    {">", {8, 4, 2, 1, 2, 4, 8}},
    {"\xc2\xb0", {12, 18, 18, 12, 0, 0, 0}},
    {"\xc2\xb2", {12, 18, 4, 8, 30, 0, 0}},
    {"\xc2\xb3", {28, 2, 12, 2, 28, 0, 0}},
    {"\xc2\xb5", {0, 0, 17, 17, 19, 29, 16}},
    {"\xce\xbc", {0, 0, 17, 17, 19, 29, 16}},
};
static const glyph unknown = {"", {31, 17, 17, 17, 17, 17, 31}};

/// The glyph at `*text`, which moves on to the next one.
static const glyph *next_glyph(const char **text)
{
    for (size_t k = 0; k < sizeof glyphs / sizeof *glyphs; ++k)
    {
        size_t size = strlen(glyphs[k].name);
        if (strncmp(*text, glyphs[k].name, size) != 0) continue;
        *text += size;
        return &glyphs[k];
    }
    ++*text;
    while (((unsigned char)**text & 0xc0u) == 0x80u) ++*text; // the rest of a UTF-8 sequence
    return &unknown;
}

int pls_render_text_width(const char *text, int size)
{
    int width = 0;
    while (*text && next_glyph(&text)) width += PLS_GLYPH_WIDTH * size;
    return width;
}

/// A stroke between the centres of two dots, in dots.
typedef struct stroke
{
    double x0, y0, x1, y1;
} stroke;

enum { MOST_STROKES = 5 * ROWS * DOTS };

static bool has_dot(const glyph *g, int i, int j) { return i >= 0 && i < DOTS && j >= 0 && j < ROWS && (g->row[j] >> (DOTS - 1 - i) & 1); }

/// Every dot alone, and every two that touch; those that touch at a corner only where no third one goes around it.
static int make_strokes(const glyph *g, stroke strokes[MOST_STROKES])
{
    int count = 0;
    for (int dot = 0; dot < ROWS * DOTS; ++dot)
    {
        int i = dot % DOTS, j = dot / DOTS;
        if (!has_dot(g, i, j)) continue;
        const int di[4] = {0, 1, 0, 1}, dj[4] = {0, 0, 1, 1};
        for (int k = 0; k < 4; ++k)
        {
            bool corner = k == 3 && (has_dot(g, i + 1, j) || has_dot(g, i, j + 1));
            if (has_dot(g, i + di[k], j + dj[k]) && !corner) strokes[count++] = (stroke){i, j, i + di[k], j + dj[k]};
        }
        if (has_dot(g, i - 1, j + 1) && !has_dot(g, i - 1, j) && !has_dot(g, i, j + 1)) strokes[count++] = (stroke){i, j, i - 1, j + 1};
    }
    return count;
}

static double distance_to(const stroke *s, double x, double y)
{
    double dx = s->x1 - s->x0, dy = s->y1 - s->y0, square = dx * dx + dy * dy;
    double t = square > 0.0 ? fmin(fmax(((x - s->x0) * dx + (y - s->y0) * dy) / square, 0.0), 1.0) : 0.0;
    return hypot(x - s->x0 - t * dx, y - s->y0 - t * dy);
}

/// Lay a colour over a pixel.
static void blend(uint8_t pixel[4], const uint8_t rgb[3], double cover)
{
    double below = pixel[3] / 255.0 * (1.0 - cover), opacity = cover + below;
    if (!(cover > 0.0)) return;
    for (int c = 0; c < 3; ++c) pixel[c] = (uint8_t)lround((cover * rgb[c] + below * pixel[c]) / opacity);
    pixel[3] = (uint8_t)lround(255.0 * opacity);
}

static double cover_of(double distance, double half, int size) { return fmin(fmax(0.5 + (half - distance) * size, 0.0), 1.0); }

/// The letter itself, or the rim that goes under it.
static void draw_glyph(pls_render_picture *picture, const glyph *g, int left, int top, int size, double half, double opacity,
                       const uint8_t rgb[3])
{
    int rim = 1 + (int)ceil((half - half_stroke) * size);
    stroke strokes[MOST_STROKES];
    int count = make_strokes(g, strokes);
    for (int j = -rim; j < ROWS * size + rim; ++j)
    {
        for (int i = -rim; i < DOTS * size + rim; ++i)
        {
            int x = left + i, y = top + j;
            if (x < 0 || y < 0 || x >= picture->width || y >= picture->height) continue;
            double distance = INFINITY;
            for (int k = 0; k < count; ++k)
                distance = fmin(distance, distance_to(&strokes[k], (i + 0.5) / size - 0.5, (j + 0.5) / size - 0.5));
            uint8_t *pixel = &picture->rgba[4 * ((size_t)y * (size_t)picture->width + (size_t)x)];
            blend(pixel, rgb, opacity * cover_of(distance, half, size));
        }
    }
}

void pls_render_text(pls_render_picture *picture, int x, int y, int size, const uint8_t rgb[3], const uint8_t ground[4], const char *text)
{
    for (int layer = 0; layer < 2; ++layer)
    {
        bool rim = layer == 0;
        int left = x;
        for (const char *rest = text; *rest; left += PLS_GLYPH_WIDTH * size)
            draw_glyph(picture, next_glyph(&rest), left, y, size, rim ? half_stroke + rim_width : half_stroke,
                       rim ? rim_opacity * ground[3] / 255.0 : 1.0, rim ? ground : rgb);
    }
}
