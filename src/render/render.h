// render.h -- pictures of bodies: rays against shapes, colour bars, PNG files and animations.
//
// A picture needs no window system and no graphics card, and is the same pixels on every machine of one kind, for any number of threads. Balls and planes are met in
// closed form; every other shape by sphere tracing its SDF, so that a user's shape is drawn without a line more. Rays do not walk a tree: all rays of a picture leave
// from one eye, and all rays of shadows run along one direction, so both are sorted once into a grid of columns (accelerate.c).
#ifndef PLS_RENDER_RENDER_H
#define PLS_RENDER_RENDER_H

#include "base/atomic_file.h"

#include <particls/shape.h>

/// A body to be drawn. Position and orientation are of the body's frame (centre of mass, principal axes).
typedef struct pls_render_item
{
    const pls_shape *shape;
    pls_vec3 position; ///< [m]
    pls_quat orientation;
    double scale;
    double radius; ///< of the bounding sphere [m]; 0: of the shape times `scale`
    double value;  ///< what the colour tells; NaN: the plain colour
    float opacity; ///< 0 to 1
} pls_render_item;

typedef struct pls_render_camera
{
    pls_vec3 eye, target; ///< [m]
    pls_vec3 up;
    double field_of_view; ///< from the lower to the upper edge [rad]; 0: orthographic
    double height;        ///< what an orthographic picture shows from the lower to the upper edge [m]
} pls_render_camera;

typedef enum pls_render_colours {
    PLS_RENDER_VIRIDIS,     ///< perceptually uniform
    PLS_RENDER_MAGMA,       ///< the same from black to light yellow
    PLS_RENDER_COOLWARM,    ///< blue, grey in the middle, red: for values of both signs
    PLS_RENDER_GREY,        ///< from dark to light
    PLS_RENDER_CATEGORICAL, ///< the value rounded to an integer picks one of eight colours
} pls_render_colours;

typedef struct pls_render_options
{
    int width, height; ///< [pixels]
    pls_render_colours colours;
    double low, high;      ///< values at the ends of the colour bar
    uint8_t background[4]; ///< sRGB and opacity
    uint8_t plain[3];      ///< of bodies without a value, sRGB
    pls_vec3 light;        ///< direction towards the light
    double softness;       ///< of shadows: tangent of the light's half width, 0: sharp
    double ambient;        ///< part of the light that comes from everywhere, 0 to 1
    bool shadows;
    bool smooth_edges;         ///< 2 x 2 rays in pixels where bodies meet
    bool bar;                  ///< draw the colour bar
    int threads;               ///< 0: as many as `pls_threads` says
    const char *title;         ///< of the bar; null: none
    const char *unit;          ///< of the value; null or "": none
    const char *const *labels; ///< names of the categories `low` to `high`; null: their numbers
    const char *caption;       ///< in the lower left corner; null: none
    bool cut;                  ///< leave out what lies beyond the plane cut_normal . x = cut_distance; planes stay whole
    pls_vec3 cut_normal;       ///< unit, towards what is left out
    double cut_distance;       ///< [m]
} pls_render_options;

/// Rows from top to bottom, four bytes a pixel: sRGB and opacity, not premultiplied.
typedef struct pls_render_picture
{
    uint8_t *rgba;
    int width, height;
} pls_render_picture;

/// 1280 x 720, viridis from 0 to 1, white, light from above, soft shadows, smooth edges, with a bar.
pls_render_options pls_render_defaults(void);

/// Draw. End with `pls_render_picture_free`. INVALID_ARGUMENT for sizes, ranges, cameras and items that cannot be drawn.
pls_status pls_render_image(const pls_render_item *items, size_t count, const pls_render_camera *camera, const pls_render_options *options,
                            pls_render_picture *picture);
void pls_render_picture_free(pls_render_picture *picture);

/// How far pictures must reach to show what was added: first the look, then any number of bodies, of any number of moments. To be made by pls_render_framing_start.
typedef struct pls_render_framing
{
    pls_vec3 forward, right, up;
    double field_of_view, aspect;                            ///< 0: orthographic; width over height
    double left_part, right_part, height_part;               ///< of half the picture that bodies may fill: a border and the bar stay free
    double left_end, right_end, low_end, high_end, near_end; ///< the bodies' silhouettes so far, and how far they reach backwards
    bool any;
} pls_render_framing;

/// Look along `direction`; in 2D (0, 0, -1), with `up` (0, 1, 0) and field_of_view 0. Of `options`, size and bar matter.
pls_render_framing pls_render_framing_start(pls_vec3 direction, pls_vec3 up, double field_of_view, const pls_render_options *options);
/// Bounded, visible items count, and the corners of a box of planes.
void pls_render_framing_add(pls_render_framing *framing, const pls_render_item *items, size_t count);
/// The nearest camera that shows all.
pls_render_camera pls_render_framing_end(const pls_render_framing *framing);
/// All three for one picture.
pls_render_camera pls_render_fit(const pls_render_item *items, size_t count, pls_vec3 direction, pls_vec3 up, double field_of_view,
                                 const pls_render_options *options);

/// The outward normal of an unbounded item, and a point on it [m].
void pls_render_plane_of(const pls_render_item *item, pls_vec3 *normal, pls_vec3 *point);

// ---- files ----------------------------------------------------------------------------------------------------------------------------

/// Write atomically; errors as in base/atomic_file.h.
pls_status pls_png_write(const char *path, const pls_render_picture *picture);
pls_status pls_png_read(const char *path, pls_render_picture *picture);

/// An animation being written (animated PNG: a PNG whose first picture every viewer shows). Zero-initialise.
typedef struct pls_apng
{
    pls_atomic_file file;
    int width, height;
    uint32_t frames, sequence;
    uint16_t delay; ///< [ms]
    uint32_t plays;
    long counts_at; ///< where in the file the number of frames stands [bytes]
} pls_apng;

/// `delay`: of each frame [ms]; `plays`: how often, 0: for ever. All frames have one size, that of the first.
pls_status pls_apng_open(pls_apng *apng, const char *path, uint16_t delay, uint32_t plays);
pls_status pls_apng_add(pls_apng *apng, const pls_render_picture *picture);
/// Put the file in place; INVALID_ARGUMENT (and no file) without any frame.
pls_status pls_apng_close(pls_apng *apng);
/// Leave no file. Does nothing when none is open.
void pls_apng_abandon(pls_apng *apng);

// ---- colours and text -----------------------------------------------------------------------------------------------------------------

/// sRGB, 0 to 255, of a value between `low` and `high`.
void pls_render_colour(pls_render_colours colours, double value, double low, double high, uint8_t rgb[3]);
double pls_render_linear_from_srgb(uint8_t byte);
/// The bar at the right edge, with ticks, title and unit.
void pls_render_bar(pls_render_picture *picture, const pls_render_options *options);
/// The caption in the lower left corner.
void pls_render_caption(pls_render_picture *picture, const pls_render_options *options);
/// The width at the right edge that the bar, its numbers and its title need [pixels].
int pls_render_bar_strip(const pls_render_options *options);
/// Where the bar is: left, top, right, bottom (right and bottom exclusive) [pixels].
void pls_render_bar_place(const pls_render_options *options, int place[4]);

enum { PLS_GLYPH_WIDTH = 6, PLS_GLYPH_HEIGHT = 8 }; ///< with the gap between glyphs and lines [pixels at size 1]
int pls_render_text_width(const char *text, int size);
/// With a rim of the colour `ground` (sRGB and opacity) around the letters, so that they can be read on anything.
void pls_render_text(pls_render_picture *picture, int x, int y, int size, const uint8_t rgb[3], const uint8_t ground[4], const char *text);

// ---- rays -----------------------------------------------------------------------------------------------------------------------------

typedef struct pls_render_ray
{
    pls_vec3 origin, direction; ///< direction: unit
} pls_render_ray;

typedef struct pls_render_view
{
    pls_vec3 eye, right, up, forward;
    double half_width, half_height; ///< of the picture at distance 1; orthographic: [m]
    int width, height;              ///< [pixels]
    bool orthographic;
} pls_render_view;

/// INVALID_ARGUMENT when the camera looks nowhere.
pls_status pls_render_view_make(const pls_render_camera *camera, int width, int height, pls_render_view *view);
/// Through the point (x, y) of the picture, in pixels from the upper left corner.
pls_render_ray pls_render_view_ray(const pls_render_view *view, double x, double y);
/// The pixels that a sphere may cover, as left, top, right, bottom (inclusive); false: none.
bool pls_render_view_extent(const pls_render_view *view, pls_vec3 centre, double radius, int extent[4]);
/// A lower bound of the way along any ray to the sphere [m].
double pls_render_view_depth(const pls_render_view *view, pls_vec3 centre, double radius);

/// Columns of a grid, each with the bodies that reach into it, the nearest first.
typedef struct pls_render_grid
{
    int columns, rows;
    uint32_t *start; ///< columns * rows + 1
    uint32_t *body;
} pls_render_grid;

/// What a body covers: cells from (x0, y0) to (x1, y1), inclusive; x1 < x0: nothing.
typedef struct pls_render_extent
{
    int x0, y0, x1, y1;
    double depth; ///< sorts
} pls_render_extent;

pls_status pls_render_grid_make(pls_render_grid *grid, int columns, int rows, const pls_render_extent *extent, size_t count);
void pls_render_grid_free(pls_render_grid *grid);

#endif
