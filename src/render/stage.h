// stage.h -- a picture's bodies ready for rays: what the files of the tracer share.
//
//     stage.c  bodies from items, parts in place of wholes, sorted into the two grids
//     meet.c   where a ray meets a body
//     light.c  how much of the light reaches a point
//     image.c  colours of pixels
#ifndef PLS_RENDER_STAGE_H
#define PLS_RENDER_STAGE_H

#include "render/render.h"

enum {
    PLS_STAGE_TILE = 16,       ///< side of the squares of pixels that share a list of bodies
    PLS_STAGE_MOST_STEPS = 200 ///< of a ray towards one body
};
static const double pls_stage_touch = 1e-5;          ///< of the radius: nearer is on the surface
static const double pls_stage_widest_penumbra = 0.5; ///< of the radius: wider ones would fill the columns of the light

typedef enum pls_stage_kind {
    PLS_STAGE_BALL,
    PLS_STAGE_TRACED,
    PLS_STAGE_TRIANGLE, ///< without thickness, of a mesh
    PLS_STAGE_PLANE,
    PLS_STAGE_FLAT, ///< a 2D shape, in the plane z = its position's
} pls_stage_kind;

typedef struct pls_stage_body
{
    pls_vec3 centre; ///< of the ball or bounding sphere; a point of the plane
    double radius;
    pls_stage_kind kind;
    float albedo[3]; ///< linear
    float opacity;
    pls_vec3 normal;    ///< of a plane or triangle
    pls_vec3 corner[3]; ///< of a triangle
    double line;        ///< half the width of the line that a flat wall without thickness is drawn as [m]
    const pls_render_item *item;
} pls_stage_body;

typedef struct pls_stage
{
    const pls_render_options *options;
    pls_render_view view;
    pls_render_item *parts; ///< of items that have some, as items
    size_t part_count;
    pls_stage_body *bodies; ///< the bounded ones first, then planes
    size_t bounded, count;
    pls_render_grid tiles, columns;
    pls_vec3 light, light_x, light_y; ///< towards the light, and across
    double corner_x, corner_y, side;  ///< of the grid across the light
    double reach;                     ///< of all bounded bodies from their middle [m]
    pls_vec3 middle;
    double check; ///< side of a plane's squares [m]
} pls_stage;

typedef struct pls_stage_hit
{
    double t;
    uint32_t body; ///< UINT32_MAX: none
} pls_stage_hit;

/// Bodies, grids and light; to be ended with pls_stage_free, also after a failure. `options` and `view` are set before.
pls_status pls_stage_make(pls_stage *s, const pls_render_item *items, size_t count);
void pls_stage_free(pls_stage *s);
/// How far from its centre a body may dim the light: radius and penumbra.
double pls_stage_shadow_radius(const pls_stage *s, const pls_stage_body *b);

/// The first body behind `after`.
pls_stage_hit pls_stage_next(const pls_stage *s, const pls_render_ray *ray, uint32_t tile, pls_stage_hit after);
/// Between which t a ray is within a sphere; false: never.
bool pls_stage_within(const pls_render_ray *ray, pls_vec3 centre, double radius, double *from, double *to);
/// Narrow a way down to what lies within a box that is thickened by `grow`; false: nothing.
bool pls_stage_within_box(pls_vec3 O, pls_vec3 D, pls_vec3 lower, pls_vec3 upper, double grow, double *from, double *to);
/// Distance of a point from a shape and its gradient, at the cost of one of them.
double pls_stage_distance(const pls_shape *shape, pls_vec3 X, pls_vec3 *gradient);
/// A function whose zero is the surface of a convex shape, for rays: the cheapest there is, and its gradient.
double pls_stage_level(const pls_shape *shape, pls_vec3 X, pls_vec3 *slope);
/// The part of a ray that lies on the side of the cut that is kept.
void pls_stage_keep(const pls_stage *s, const pls_render_ray *ray, double *from, double *to);
/// From `first` on.
bool pls_stage_meet_triangle(const pls_stage_body *b, const pls_render_ray *ray, double first, double *t);

/// How much of the light reaches the point p of body `self`, 0 to 1.
double pls_stage_lit(const pls_stage *s, pls_vec3 p, uint32_t self);

static inline double pls_stage_smooth(double x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x); }

/// From the world's axes to the shape's, and back; and a point to the shape's frame and lengths.
static inline pls_vec3 pls_stage_turn_in(const pls_render_item *item, pls_vec3 v)
{
    return pls_rotate(item->shape->principal, pls_rotate_back(item->orientation, v));
}

static inline pls_vec3 pls_stage_turn_out(const pls_render_item *item, pls_vec3 v)
{
    return pls_rotate(item->orientation, pls_rotate_back(item->shape->principal, v));
}

static inline pls_vec3 pls_stage_to_shape(const pls_render_item *item, pls_vec3 p)
{
    pls_vec3 X = pls_rotate_back(item->orientation, pls_sub(p, item->position));
    return pls_shape_from_body(item->shape, pls_scale(X, 1.0 / item->scale));
}

#endif
