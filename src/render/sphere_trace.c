// sphere_trace.c -- where rays meet bodies, how much light falls there, and the picture made of that.
//
// A shape that is the union of parts (compound, mesh) is drawn as its parts. Balls, triangles, planes and flat shapes are met in closed form. All else by sphere tracing (Hart, Sphere tracing, The Visual Computer 12, 1996) with steps longer than the
// distance, taken back where two unbounding spheres do not touch (Keinert et al., Enhanced sphere tracing, STAG 2014), and regula falsi in the last step. Shadows are
// soft by how close a ray to the light passes, over how far it has gone, instead of by many rays. Each pixel follows from the scene alone, so threads cannot matter.
// Bodies that let light through are met one after the other, ordered by distance and number.

#include "base/parallel.h"
#include "render/render.h"

#include <string.h>

enum {
    TILE = 16,
    MOST_SIZE = 16384,
    MOST_STEPS = 200,
    MOST_HALVINGS = 40,
    NEAREST_STEPS = 3,
    MOST_LAYERS = 16,
    MOST_COLUMNS = 512,
    SHADES = 8192
};
static const double relaxation = 1.3;      ///< step over distance
static const double touch = 1e-5;          ///< of the radius: nearer is on the surface
static const double thin_line = 2.5e-3;    ///< half the width of a line, of the reach of all bodies
static const double widest_penumbra = 0.5; ///< of the radius: wider ones would fill the columns of the light

typedef enum body_kind {
    BALL,
    TRACED,
    TRIANGLE, ///< without thickness, of a mesh
    PLANE,
    FLAT, ///< a 2D shape, in the plane z = its position's
} body_kind;

typedef struct body
{
    pls_vec3 centre; ///< of the ball or bounding sphere; a point of the plane
    double radius;
    body_kind kind;
    float albedo[3]; ///< linear
    float opacity;
    pls_vec3 normal;    ///< of a plane or triangle
    pls_vec3 corner[3]; ///< of a triangle
    double line;        ///< half the width of the line that a flat wall without thickness is drawn as [m]
    const pls_render_item *item;
} body;

typedef struct scene
{
    const pls_render_options *options;
    pls_render_view view;
    pls_render_item *parts; ///< of items that have some, as items
    size_t part_count;
    body *bodies; ///< the bounded ones first, then planes
    size_t bounded, count;
    pls_render_grid tiles, columns;
    pls_vec3 light, light_x, light_y; ///< towards the light, and across
    double corner_x, corner_y, side;  ///< of the grid across the light
    double reach;                     ///< of all bounded bodies from their middle [m]
    pls_vec3 middle;
    double check; ///< side of a plane's squares [m]
    uint8_t *shade;
} scene;

typedef struct hit
{
    double t;
    uint32_t body; ///< UINT32_MAX: none
} hit;

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

// ---- bodies ---------------------------------------------------------------------------------------------------------------------------

static pls_vec3 turn_to_shape(const pls_render_item *item, pls_vec3 v)
{
    return pls_rotate(item->shape->principal, pls_rotate_back(item->orientation, v));
}

static pls_vec3 turn_to_world(const pls_render_item *item, pls_vec3 v)
{
    return pls_rotate(item->orientation, pls_rotate_back(item->shape->principal, v));
}

static pls_vec3 to_shape(const pls_render_item *item, pls_vec3 p)
{
    pls_vec3 X = pls_rotate_back(item->orientation, pls_sub(p, item->position));
    return pls_shape_from_body(item->shape, pls_scale(X, 1.0 / item->scale));
}

static bool is_ball(const pls_shape *shape)
{
    return shape->dimension == 3 && shape->margin > 0.0 && shape->polytope && shape->polytope->vertex_count == 1;
}

/// The half-space phi <= 0 of an SDF that is linear.
void pls_render_plane_of(const pls_render_item *item, pls_vec3 *normal, pls_vec3 *point)
{
    pls_vec3 X = to_shape(item, item->position);
    *normal = turn_to_world(item, pls_unit(pls_shape_gradient(item->shape, X)));
    *point = pls_sub(item->position, pls_scale(*normal, item->scale * pls_shape_sdf(item->shape, X)));
}

static void set_ball(body *b)
{
    const pls_shape *shape = b->item->shape;
    pls_vec3 from_centre = pls_sub(shape->polytope->vertex[0], shape->mass.centre);
    b->centre = pls_add(b->item->position, pls_scale(turn_to_world(b->item, from_centre), b->item->scale));
    b->radius = shape->margin * b->item->scale;
}

static bool is_triangle(const pls_shape *shape)
{
    return shape->dimension == 3 && shape->margin == 0.0 && shape->polytope && shape->polytope->vertex_count == 3;
}

static void set_triangle(body *b)
{
    const pls_render_item *item = b->item;
    for (int k = 0; k < 3; ++k)
    {
        pls_vec3 from_centre = pls_sub(item->shape->polytope->vertex[k], item->shape->mass.centre);
        b->corner[k] = pls_add(item->position, pls_scale(turn_to_world(item, from_centre), item->scale));
    }
    b->normal = pls_unit(pls_cross(pls_sub(b->corner[1], b->corner[0]), pls_sub(b->corner[2], b->corner[0])));
}

static body_kind kind_of(const pls_shape *shape)
{
    if (shape->dimension == 2) return FLAT;
    return shape->ops->unbounded ? PLANE : is_ball(shape) ? BALL : is_triangle(shape) ? TRIANGLE : TRACED;
}

static void set_body(body *b, const pls_render_item *item, const pls_render_options *options)
{
    static const uint8_t wall[3] = {215, 215, 215}, flat_wall[3] = {130, 130, 130};
    *b = (body){.centre = item->position, .item = item, .opacity = fminf(fmaxf(item->opacity, 0.0f), 1.0f)};
    b->radius = item->radius > 0.0 ? item->radius : item->shape->radius * item->scale;
    uint8_t rgb[3];
    if (isnan(item->value))
        memcpy(rgb, options->plain, sizeof rgb);
    else
        pls_render_colour(options->colours, item->value, options->low, options->high, rgb);
    if (item->shape->ops->unbounded || item->shape->ops->wall) memcpy(rgb, item->shape->dimension == 2 ? flat_wall : wall, sizeof rgb);
    for (int c = 0; c < 3; ++c) b->albedo[c] = (float)pls_render_linear_from_srgb(rgb[c]);
    b->kind = kind_of(item->shape);
    if (b->kind == PLANE) pls_render_plane_of(item, &b->normal, &b->centre);
    if (b->kind == BALL) set_ball(b);
    if (b->kind == TRIANGLE) set_triangle(b);
}

static pls_status check_item(const pls_render_item *item, size_t k)
{
    double sum = item->position.x + item->position.y + item->position.z + item->radius + item->orientation.w + item->orientation.x +
                 item->orientation.y + item->orientation.z;
    if (item->shape && isfinite(sum) && item->scale > 0.0 && isfinite(item->scale) && !isnan(item->opacity)) return PLS_OK;
    return pls_fail(
        PLS_INVALID_ARGUMENT,
        "item %zu of the picture cannot be drawn: shape %s, position (%g, %g, %g) m, scale %g, opacity %g; all must be finite and "
        "scale more than 0",
        k, item->shape ? "given" : "missing", item->position.x, item->position.y, item->position.z, item->scale, (double)item->opacity);
}

/// A part as an item of its own: from its frame to that of the whole, to that of the body, to the world.
static pls_render_item item_of_part(const pls_render_item *item, const pls_shape_part *part)
{
    const pls_shape *whole = item->shape;
    pls_render_item one = *item;
    one.shape = part->shape;
    one.scale = item->scale * part->scale;
    one.radius = 0.0;
    pls_vec3 from_centre = pls_sub(pls_part_to_whole(part, part->shape->mass.centre), whole->mass.centre);
    one.position = pls_add(item->position, pls_scale(turn_to_world(item, from_centre), item->scale));
    pls_quat to_body =
        pls_quat_multiply(pls_quat_conjugate(whole->principal), pls_quat_multiply(part->orientation, part->shape->principal));
    one.orientation = pls_quat_multiply(item->orientation, to_body);
    return one;
}

static pls_status make_parts(scene *s, const pls_render_item *items, size_t count)
{
    size_t total = 0;
    for (size_t k = 0; k < count; ++k) total += items[k].shape->part_count;
    if (total >= UINT32_MAX / 4)
        return pls_fail(PLS_LIMIT_EXCEEDED, "a picture of %zu parts of bodies is too large: leave some out", total);
    PLS_TRY(pls_allocate(&s->parts, total, sizeof *s->parts, "the bodies of a picture"));
    for (size_t k = 0; k < count; ++k)
    {
        const pls_shape *shape = items[k].shape;
        for (size_t p = 0; p < shape->part_count; ++p) s->parts[s->part_count++] = item_of_part(&items[k], &shape->part[p]);
    }
    return PLS_OK;
}

/// Those of the items that are bounded, or those that are not; parts in place of wholes.
static void add_bodies(scene *s, const pls_render_item *items, size_t count, bool unbounded)
{
    size_t next_part = 0;
    for (size_t k = 0; k < count; ++k)
    {
        size_t parts = items[k].shape->part_count, first = next_part;
        next_part += parts;
        if (items[k].shape->ops->unbounded != unbounded) continue;
        if (parts == 0) set_body(&s->bodies[s->count++], &items[k], s->options);
        for (size_t p = 0; p < parts; ++p) set_body(&s->bodies[s->count++], &s->parts[first + p], s->options);
    }
}

static pls_status make_bodies(scene *s, const pls_render_item *items, size_t count)
{
    if (count >= UINT32_MAX / 4) return pls_fail(PLS_LIMIT_EXCEEDED, "a picture of %zu bodies is too large: leave some out", count);
    for (size_t k = 0; k < count; ++k) PLS_TRY(check_item(&items[k], k));
    PLS_TRY(make_parts(s, items, count));
    PLS_TRY(pls_allocate(&s->bodies, count + s->part_count, sizeof *s->bodies, "the bodies of a picture"));
    add_bodies(s, items, count, false);
    s->bounded = s->count;
    add_bodies(s, items, count, true);
    return PLS_OK;
}

// ---- the two grids --------------------------------------------------------------------------------------------------------------------

static pls_status make_tiles(scene *s, pls_render_extent *extent)
{
    for (size_t k = 0; k < s->bounded; ++k)
    {
        int e[4];
        const body *b = &s->bodies[k];
        extent[k] = (pls_render_extent){.x1 = -1};
        if (b->opacity <= 0.0f || !pls_render_view_extent(&s->view, b->centre, b->radius, e)) continue;
        extent[k] =
            (pls_render_extent){e[0] / TILE, e[1] / TILE, e[2] / TILE, e[3] / TILE, pls_render_view_depth(&s->view, b->centre, b->radius)};
    }
    return pls_render_grid_make(&s->tiles, (s->view.width + TILE - 1) / TILE, (s->view.height + TILE - 1) / TILE, extent, s->bounded);
}

static void measure(scene *s)
{
    pls_vec3 lower = pls_vec(INFINITY, INFINITY, INFINITY), upper = pls_scale(lower, -1.0);
    bool any = false;
    for (size_t k = 0; k < s->bounded; ++k)
    {
        if (s->bodies[k].opacity <= 0.0f) continue;
        any = true;
        pls_vec3 p = s->bodies[k].centre;
        double r = s->bodies[k].radius;
        lower = pls_vec(fmin(lower.x, p.x - r), fmin(lower.y, p.y - r), fmin(lower.z, p.z - r));
        upper = pls_vec(fmax(upper.x, p.x + r), fmax(upper.y, p.y + r), fmax(upper.z, p.z + r));
    }
    s->middle = any ? pls_scale(pls_add(lower, upper), 0.5) : pls_vec(0.0, 0.0, 0.0);
    s->reach = any ? 0.5 * pls_length(pls_sub(upper, lower)) : 1.0;
    double raw = 0.2 * s->reach, power = pow(10.0, floor(log10(raw)));
    for (size_t k = 0; k < s->bounded; ++k)
    {
        if (s->bodies[k].kind == FLAT && s->bodies[k].item->shape->ops->wall) s->bodies[k].line = thin_line * s->reach;
    }
    s->check = raw < 2.0 * power ? power : raw < 5.0 * power ? 2.0 * power : 5.0 * power;
}

/// How far from its centre a body may dim the light: radius and penumbra.
static double shadow_radius(const scene *s, const body *b)
{
    if (b->kind == TRIANGLE) return b->radius;
    return b->radius + fmin(widest_penumbra * b->radius, 2.0 * s->reach * s->options->softness);
}

static int cell_of(double place, double corner, double side, int cells)
{
    double c = floor((place - corner) / side);
    return c < 0.0 ? 0 : c >= cells ? cells - 1 : (int)c;
}

/// Columns along the light, as wide as a radius on average; the body that is highest comes first.
static pls_status make_columns(scene *s, pls_render_extent *extent)
{
    double lower[2] = {INFINITY, INFINITY}, upper[2] = {-INFINITY, -INFINITY}, mean = 0.0;
    for (size_t k = 0; k < s->bounded; ++k)
    {
        const body *b = &s->bodies[k];
        double r = shadow_radius(s, b), x = pls_dot(b->centre, s->light_x), y = pls_dot(b->centre, s->light_y);
        mean += b->radius / (double)s->bounded;
        lower[0] = fmin(lower[0], x - r), upper[0] = fmax(upper[0], x + r);
        lower[1] = fmin(lower[1], y - r), upper[1] = fmax(upper[1], y + r);
    }
    if (s->bounded == 0 || !s->options->shadows) return PLS_OK;
    s->corner_x = lower[0];
    s->corner_y = lower[1];
    s->side = fmax(mean, fmax(upper[0] - lower[0], upper[1] - lower[1]) / MOST_COLUMNS);
    int columns = (int)((upper[0] - lower[0]) / s->side) + 1, rows = (int)((upper[1] - lower[1]) / s->side) + 1;
    for (size_t k = 0; k < s->bounded; ++k)
    {
        const body *b = &s->bodies[k];
        double r = shadow_radius(s, b), x = pls_dot(b->centre, s->light_x), y = pls_dot(b->centre, s->light_y);
        extent[k] = (pls_render_extent){cell_of(x - r, lower[0], s->side, columns), cell_of(y - r, lower[1], s->side, rows),
                                        cell_of(x + r, lower[0], s->side, columns), cell_of(y + r, lower[1], s->side, rows),
                                        -(pls_dot(b->centre, s->light) + b->radius)};
        if (b->opacity <= 0.0f || b->kind == FLAT) extent[k].x1 = extent[k].x0 - 1;
    }
    return pls_render_grid_make(&s->columns, columns, rows, extent, s->bounded);
}

// ---- where a ray meets a body -------------------------------------------------------------------------------------------------------------

/// Between which t a ray is within a sphere; false: never.
static bool within(const pls_render_ray *ray, pls_vec3 centre, double radius, double *from, double *to)
{
    pls_vec3 c = pls_sub(centre, ray->origin);
    double along = pls_dot(c, ray->direction);
    pls_vec3 beside = pls_sub(c, pls_scale(ray->direction, along)); // not |c|^2 - along^2: far away that cancels
    double left = radius * radius - pls_dot(beside, beside);
    if (left < 0.0) return false;
    double half = sqrt(left);
    *from = along - half;
    *to = along + half;
    return true;
}

/// Narrow a way down to what lies within a box that is thickened by `grow`; false: nothing.
static bool within_box(pls_vec3 O, pls_vec3 D, pls_vec3 lower, pls_vec3 upper, double grow, double *from, double *to)
{
    const double o[3] = {O.x, O.y, O.z}, d[3] = {D.x, D.y, D.z};
    const double low[3] = {lower.x, lower.y, lower.z}, high[3] = {upper.x, upper.y, upper.z};
    for (int k = 0; k < 3; ++k)
    {
        double a = low[k] - grow - o[k], b = high[k] + grow - o[k];
        if (d[k] == 0.0)
        {
            if (a > 0.0 || b < 0.0) return false;
            continue;
        }
        double in = (d[k] > 0.0 ? a : b) / d[k], out = (d[k] > 0.0 ? b : a) / d[k];
        *from = in > *from ? in : *from;
        *to = out < *to ? out : *to;
    }
    return *from <= *to;
}

/// Where phi = 0 between a point outside and one inside: regula falsi, the Illinois way (Dowell & Jarratt, BIT 11, 1971).
static double surface_between(const pls_shape *shape, pls_vec3 O, pls_vec3 D, double outside, double phi_out, double inside, double phi_in)
{
    double eps = touch * shape->radius;
    for (int k = 0; k < MOST_HALVINGS && inside - outside > 1e-3 * eps; ++k)
    {
        double t = outside + (inside - outside) * phi_out / (phi_out - phi_in), phi = pls_shape_sdf(shape, pls_add(O, pls_scale(D, t)));
        if (fabs(phi) < 0.01 * eps) return t;
        if (phi > 0.0)
        {
            outside = t;
            phi_out = phi;
            phi_in *= 0.5;
        }
        else
        {
            inside = t;
            phi_in = phi;
            phi_out *= 0.5;
        }
    }
    return outside;
}

/// What is left of a ray behind all faces of a convex polytope.
static bool meet_polytope(const pls_polytope *p, pls_vec3 O, pls_vec3 D, double from, double to, double *t_hit)
{
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        pls_vec3 n = p->face_normal[f];
        double above = pls_dot(n, pls_sub(O, p->vertex[p->face_vertex[p->face_start[f]]])), rise = pls_dot(n, D);
        if (rise == 0.0 && above > 0.0) return false;
        if (rise < 0.0) from = fmax(from, -above / rise);
        if (rise > 0.0) to = fmin(to, -above / rise);
        if (from > to) return false;
    }
    *t_hit = from;
    return true;
}

/// A convex shape lies behind the plane through its nearest point: the ray goes on to that plane, which is Newton's method, from outside all the way. Where the plane turns away the
/// ray has missed. All in the shape's frame, where lengths are those of the world over `scale`.
static bool trace_convex(const pls_shape *shape, pls_vec3 O, pls_vec3 D, double from, double to, double *t_hit)
{
    if (shape->margin == 0.0 && shape->polytope && shape->polytope->face_count > 3)
        return meet_polytope(shape->polytope, O, D, from, to, t_hit);
    double eps = touch * shape->radius, t = from;
    for (int k = 0; k < MOST_STEPS && t <= to; ++k)
    {
        pls_vec3 X = pls_add(O, pls_scale(D, t));
        double phi = pls_shape_sdf(shape, X);
        *t_hit = t;
        if (phi < eps) return true;
        double away = pls_dot(pls_shape_gradient(shape, X), D);
        if (away >= 0.0) return false;
        t -= phi / away;
    }
    return false;
}

/// The same for any shape.
static bool trace_shape(const pls_shape *shape, pls_vec3 O, pls_vec3 D, double from, double to, double *t_hit)
{
    double eps = touch * shape->radius, t = from, last = 0.0, step = 0.0, omega = relaxation;
    for (int k = 0; k < MOST_STEPS && t <= to; ++k)
    {
        double phi = pls_shape_sdf(shape, pls_add(O, pls_scale(D, t)));
        if (omega > 1.0 && step > 0.0 && fabs(phi) + last < step) // the spheres do not touch: something may lie between
        {
            t -= step - last;
            step = 0.0;
            omega = 1.0;
            continue;
        }
        if (phi < eps)
        {
            *t_hit = phi < 0.0 && step > 0.0 ? surface_between(shape, O, D, t - step, last, t, phi) : t;
            return true;
        }
        last = phi;
        step = omega * phi;
        t += step;
    }
    return false;
}

/// From `first` on, and before `limit`.
static bool hit_traced(const body *b, const pls_render_ray *ray, double first, double limit, double *t)
{
    const pls_shape *shape = b->item->shape;
    double from, to, scale = b->item->scale;
    if (!within(ray, b->centre, b->radius * (1.0 + 1e-9), &from, &to) || to <= fmax(first, 0.0)) return false;
    from = fmax(from, first);
    if (from > limit) return false;
    pls_vec3 O = to_shape(b->item, pls_add(ray->origin, pls_scale(ray->direction, from))), D = turn_to_shape(b->item, ray->direction);
    double begin = 0.0, end = (fmin(to, limit) - from) / scale;
    if (!within_box(O, D, shape->lower, shape->upper, 1e-6 * shape->radius, &begin, &end)) return false;
    if (!(shape->convex ? trace_convex : trace_shape)(shape, O, D, begin, end, t)) return false;
    *t = from + *t * scale;
    return true;
}

static bool hit_flat(const body *b, const pls_render_ray *ray, double *t)
{
    *t = (b->item->position.z - ray->origin.z) / ray->direction.z;
    if (!isfinite(*t)) return false;
    pls_vec3 X = to_shape(b->item, pls_add(ray->origin, pls_scale(ray->direction, *t)));
    X.z = 0.0;
    return pls_shape_sdf(b->item->shape, X) * b->item->scale <= b->line;
}

/// Moeller & Trumbore, Fast, minimum storage ray-triangle intersection, J. Graphics Tools 2(1), 1997; edges are wide by round-off, so that neighbours leave no gap.
static bool hit_triangle(const body *b, const pls_render_ray *ray, double first, double *t)
{
    pls_vec3 u = pls_sub(b->corner[1], b->corner[0]), v = pls_sub(b->corner[2], b->corner[0]), p = pls_cross(ray->direction, v);
    double det = pls_dot(u, p);
    if (det == 0.0) return false;
    pls_vec3 from = pls_sub(ray->origin, b->corner[0]), q = pls_cross(from, u);
    double x = pls_dot(from, p) / det, y = pls_dot(ray->direction, q) / det;
    if (!(x >= -1e-9 && y >= -1e-9 && x + y <= 1.0 + 1e-9)) return false;
    *t = pls_dot(v, q) / det;
    return *t >= first;
}

/// Only from its front: walls between the eye and what they hold are not drawn. Planes end where they enter one another: those of a box are its sides.
static bool hit_plane(const scene *s, const body *b, const pls_render_ray *ray, double *t)
{
    double towards = pls_dot(b->normal, ray->direction);
    if (towards >= 0.0) return false;
    *t = pls_dot(b->normal, pls_sub(b->centre, ray->origin)) / towards;
    pls_vec3 p = pls_add(ray->origin, pls_scale(ray->direction, *t));
    for (size_t k = s->bounded; k < s->count; ++k)
    {
        const body *other = &s->bodies[k];
        if (other != b && other->kind == PLANE && other->opacity > 0.0f &&
            pls_dot(other->normal, pls_sub(p, other->centre)) < -1e-9 * s->reach)
            return false;
    }
    return true;
}

/// The part of a ray that lies on the side of the cut that is kept.
static void keep_side(const scene *s, const pls_render_ray *ray, double *from, double *to)
{
    *from = -INFINITY;
    *to = INFINITY;
    if (!s->options->cut) return;
    double towards = pls_dot(s->options->cut_normal, ray->direction);
    double left = s->options->cut_distance - pls_dot(s->options->cut_normal, ray->origin);
    if (towards > 0.0) *to = left / towards;
    if (towards < 0.0) *from = left / towards;
    if (towards == 0.0 && left < 0.0) *to = -INFINITY;
}

static bool hit_ball(const body *b, const pls_render_ray *ray, double first, double *t)
{
    double to;
    if (!within(ray, b->centre, b->radius, t, &to) || to < first) return false;
    *t = fmax(*t, first);
    return true;
}

/// Before `limit`, if that is easy to say.
static bool hit_body(const scene *s, const body *b, const pls_render_ray *ray, double limit, double *t)
{
    double first, last;
    keep_side(s, ray, &first, &last);
    switch (b->kind)
    {
        case BALL: return hit_ball(b, ray, first, t) && *t <= last;
        case TRIANGLE: return hit_triangle(b, ray, first, t) && *t <= last;
        case PLANE: return hit_plane(s, b, ray, t);
        case FLAT: return hit_flat(b, ray, t) && *t >= first && *t <= last;
        default: return hit_traced(b, ray, first, limit, t) && *t <= last;
    }
}

static bool before(hit a, hit b) { return a.t < b.t || (a.t == b.t && a.body < b.body); }

static void try_body(const scene *s, const pls_render_ray *ray, uint32_t k, hit after, hit *best)
{
    hit found = {.body = k};
    if (!hit_body(s, &s->bodies[k], ray, best->t, &found.t)) return;
    if (!s->view.orthographic && found.t <= 0.0) return;
    if (before(after, found) && before(found, *best)) *best = found;
}

/// The first body behind `after`.
static hit next_hit(const scene *s, const pls_render_ray *ray, uint32_t tile, hit after)
{
    hit best = {INFINITY, UINT32_MAX};
    for (size_t k = s->bounded; k < s->count; ++k)
    {
        if (s->bodies[k].opacity > 0.0f) try_body(s, ray, (uint32_t)k, after, &best);
    }
    for (uint32_t n = s->tiles.start[tile]; n < s->tiles.start[tile + 1]; ++n)
    {
        const body *b = &s->bodies[s->tiles.body[n]];
        if (pls_render_view_depth(&s->view, b->centre, b->radius) > best.t) break;
        try_body(s, ray, s->tiles.body[n], after, &best);
    }
    return best;
}

// ---- light --------------------------------------------------------------------------------------------------------------------------------

static double smooth(double x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x); }

/// A ray to the light beside a body, in the body's frame. Lengths are those of the world.
typedef struct shadow_ray
{
    const pls_shape *shape;
    double scale, softness, widest, eps;
    pls_vec3 O, D;
    double from, to;
} shadow_ray;

static double shadow_distance(const shadow_ray *r, double t)
{
    return r->scale * pls_shape_sdf(r->shape, pls_add(r->O, pls_scale(r->D, t / r->scale)));
}

static double shadow_slope(const shadow_ray *r, double t)
{
    return pls_dot(pls_shape_gradient(r->shape, pls_add(r->O, pls_scale(r->D, t / r->scale))), r->D);
}

/// What passes at a distance phi after the way t.
static double pass_at(const shadow_ray *r, double t, double phi)
{
    double wide = fmin(r->softness * t, r->widest);
    return phi < r->eps ? 0.0 : phi < wide ? phi / wide : 1.0;
}

/// Distances from a convex shape fall and rise along the ray: Newton's method from plane to plane until they rise, then the least one between by regula falsi of the slopes.
static double pass_convex(const shadow_ray *r)
{
    double low = r->from, slope_low = 0.0, t = r->from;
    for (int k = 0; k < MOST_STEPS && t <= r->to; ++k)
    {
        double phi = shadow_distance(r, t), slope;
        if (phi < r->eps) return 0.0;
        if ((slope = shadow_slope(r, t)) >= 0.0)
        {
            double high = t, slope_high = slope;
            for (int n = 0; n < NEAREST_STEPS && slope_low < 0.0 && slope_high > 0.0; ++n)
            {
                t = low - slope_low * (high - low) / (slope_high - slope_low);
                slope = shadow_slope(r, t);
                *(slope < 0.0 ? &low : &high) = t;
                *(slope < 0.0 ? &slope_low : &slope_high) = slope;
            }
            return pass_at(r, t, shadow_distance(r, t));
        }
        if (t == r->to) return pass_at(r, t, phi);
        low = t;
        slope_low = slope;
        t = fmin(t - phi / slope, r->to);
    }
    return 1.0;
}

static double pass_any(const shadow_ray *r)
{
    double pass = 1.0;
    for (double t = r->from, k = 0; t <= r->to && k < MOST_STEPS / 2 && pass > 0.0; ++k)
    {
        double phi = shadow_distance(r, t);
        pass = fmin(pass, pass_at(r, t, phi));
        t += phi;
    }
    return pass;
}

/// What a traced body lets through to the point p.
static double pass_traced(const scene *s, const body *b, pls_vec3 p)
{
    const pls_shape *shape = b->item->shape;
    double from, to, scale = b->item->scale;
    if (!within(&(pls_render_ray){p, s->light}, b->centre, shadow_radius(s, b), &from, &to)) return 1.0;
    shadow_ray r = {.shape = shape, .scale = scale, .softness = s->options->softness, .widest = widest_penumbra * b->radius};
    r.eps = 10.0 * touch * b->radius;
    r.O = to_shape(b->item, p);
    r.D = turn_to_shape(b->item, s->light);
    double begin = fmax(from, 2e-3 * b->radius) / scale, end = to / scale, penumbra = fmin(r.softness * to, r.widest) / scale;
    if (!within_box(r.O, r.D, shape->lower, shape->upper, penumbra, &begin, &end)) return 1.0;
    r.from = begin * scale;
    r.to = end * scale;
    return smooth(shape->convex ? pass_convex(&r) : pass_any(&r));
}

/// What a ball lets through.
static double pass_ball(const scene *s, const body *b, pls_vec3 p)
{
    pls_vec3 v = pls_sub(b->centre, p);
    double t = pls_dot(v, s->light);
    if (t <= 0.0) return 1.0;
    pls_vec3 beside = pls_sub(v, pls_scale(s->light, t));
    double wide = fmin(s->options->softness * t, widest_penumbra * b->radius), away = pls_dot(beside, beside), reach = b->radius + wide;
    if (away >= reach * reach) return 1.0;
    double gap = sqrt(away) - b->radius;
    return gap <= 0.0 ? 0.0 : smooth(gap / wide);
}

/// What a triangle lets through. Its shadow is sharp: those of neighbours then join without a seam.
static double pass_triangle(const scene *s, const body *b, pls_vec3 p)
{
    double t;
    return hit_triangle(b, &(pls_render_ray){p, s->light}, 2e-3 * b->radius, &t) ? 0.0 : 1.0;
}

static double pass_body(const scene *s, const body *b, pls_vec3 p)
{
    switch (b->kind)
    {
        case BALL: return pass_ball(s, b, p);
        case TRIANGLE: return pass_triangle(s, b, p);
        default: return pass_traced(s, b, p);
    }
}

/// How much of the light reaches the point p of body `self`, 0 to 1.
static double lit(const scene *s, pls_vec3 p, uint32_t self)
{
    if (!s->columns.start) return 1.0;
    double x = (pls_dot(p, s->light_x) - s->corner_x) / s->side, y = (pls_dot(p, s->light_y) - s->corner_y) / s->side;
    if (!(x >= 0.0 && y >= 0.0 && x < s->columns.columns && y < s->columns.rows)) return 1.0;
    size_t cell = (size_t)y * (size_t)s->columns.columns + (size_t)x;
    double height = pls_dot(p, s->light), pass = 1.0, first, last;
    keep_side(s, &(pls_render_ray){p, s->light}, &first, &last);
    for (uint32_t n = s->columns.start[cell]; n < s->columns.start[cell + 1] && pass > 0.01; ++n)
    {
        uint32_t k = s->columns.body[n];
        const body *b = &s->bodies[k];
        if (pls_dot(b->centre, s->light) + b->radius <= height) break;
        if (pls_dot(pls_sub(b->centre, p), s->light) > last) continue; // cut away, if not to its last bit
        if (k == self && (b->kind == BALL || b->item->shape->convex)) continue;
        pass *= 1.0 - (double)b->opacity * (1.0 - pass_body(s, b, p));
    }
    return pass;
}

/// Flat shapes are drawn as if their edge were bevelled, so that neighbours stand apart.
static pls_vec3 bevel(const body *b, pls_vec3 p)
{
    pls_vec3 X = to_shape(b->item, p);
    X.z = 0.0;
    double width = 0.3 * (isfinite(b->item->shape->radius) ? b->item->shape->radius : 0.0);
    double depth = -pls_shape_sdf(b->item->shape, X), slope = width > 0.0 ? 1.0 - smooth(depth / width) : 0.0;
    pls_vec3 g = turn_to_world(b->item, pls_shape_gradient(b->item->shape, X));
    return pls_unit(pls_add(pls_scale(g, slope), pls_vec(0.0, 0.0, 1.0)));
}

/// Whether a point that was met is on the face that the cut leaves.
static bool on_cut(const scene *s, const body *b, pls_vec3 p)
{
    if (!s->options->cut || (b->kind != BALL && b->kind != TRACED)) return false;
    return fabs(pls_dot(s->options->cut_normal, p) - s->options->cut_distance) < 1e-7 * b->radius;
}

static pls_vec3 normal_at(const body *b, pls_vec3 p)
{
    if (b->kind == BALL) return pls_scale(pls_sub(p, b->centre), 1.0 / b->radius);
    if (b->kind == PLANE || b->kind == TRIANGLE) return b->normal;
    if (b->kind == FLAT) return bevel(b, p);
    pls_vec3 g = pls_shape_gradient(b->item->shape, to_shape(b->item, p));
    double length = pls_length(g);
    return length > 0.0 ? turn_to_world(b->item, pls_scale(g, 1.0 / length)) : pls_vec(0.0, 0.0, 1.0);
}

/// Which of two sorts of squares of a plane a point is in.
static unsigned checker(const scene *s, const body *b, pls_vec3 p)
{
    pls_vec3 n = b->normal, helper = fabs(n.x) < 0.6 ? pls_vec(1.0, 0.0, 0.0) : pls_vec(0.0, 1.0, 0.0);
    pls_vec3 u = pls_unit(pls_sub(helper, pls_scale(n, pls_dot(n, helper)))), v = pls_cross(n, u), d = pls_sub(p, s->middle);
    return (unsigned)((long)floor(pls_dot(d, u) / s->check) + (long)floor(pls_dot(d, v) / s->check)) & 1u;
}

/// A plane fades with the distance from the bodies, so that it has no horizon.
static double fade(const scene *s, const body *b, pls_vec3 p)
{
    if (b->kind != PLANE) return 1.0;
    return 1.0 - smooth((pls_length(pls_sub(p, s->middle)) / s->reach - 1.5) / 3.0);
}

/// Lambert's law, light from around, a little from the eye, and a gloss.
static void shade(const scene *s, const pls_render_ray *ray, hit at, double weight, sample *out)
{
    const body *b = &s->bodies[at.body];
    pls_vec3 p = pls_add(ray->origin, pls_scale(ray->direction, at.t));
    pls_vec3 n = on_cut(s, b, p) ? s->options->cut_normal : normal_at(b, p);
    if (b->kind == TRIANGLE && pls_dot(n, ray->direction) > 0.0) n = pls_scale(n, -1.0); // both sides are outside
    double facing = pls_dot(n, s->light), ambient = s->options->ambient, direct = 0.0, gloss = 0.0;
    if (facing > 0.0)
    {
        double visible = lit(s, pls_add(p, pls_scale(n, b->kind == PLANE ? 0.0 : 1e-6 * b->radius)), at.body);
        double mirrored = 2.0 * facing * pls_dot(n, ray->direction) - pls_dot(s->light, ray->direction);
        double power = mirrored * mirrored * mirrored * mirrored;
        direct = visible * facing;
        if (mirrored < 0.0 && b->kind != PLANE && b->kind != FLAT) gloss = 0.06 * visible * power * power * power * power * power;
    }
    double around = ambient * (0.55 + 0.25 * pls_dot(n, s->view.up) + 0.2 * fabs(pls_dot(n, ray->direction)));
    double brightness = around + (1.0 - ambient) * direct * 1.15;
    if (b->kind == PLANE && checker(s, b, p)) brightness *= 0.88;
    for (int c = 0; c < 3; ++c) out->light[c] += (float)(weight * (b->albedo[c] * brightness + gloss));
}

static sample look(const scene *s, double x, double y, uint32_t tile)
{
    sample out = {.what = 0};
    pls_render_ray ray = pls_render_view_ray(&s->view, x, y);
    hit at = {-INFINITY, 0};
    for (int layer = 0; layer < MOST_LAYERS && out.opacity < 0.995f; ++layer)
    {
        at = next_hit(s, &ray, tile, at);
        if (at.body == UINT32_MAX) break;
        const body *b = &s->bodies[at.body];
        pls_vec3 p = pls_add(ray.origin, pls_scale(ray.direction, at.t));
        if (layer == 0) out.what = (b->kind == PLANE ? 2u * at.body + checker(s, b, p) : 2u * at.body) + 1u;
        double weight = (1.0 - (double)out.opacity) * (double)b->opacity * fade(s, b, p);
        if (weight > 0.0) shade(s, &ray, at, weight, &out);
        out.opacity += (float)weight;
    }
    return out;
}

// ---- the picture ------------------------------------------------------------------------------------------------------------------------

/// Over the background, as bytes.
static void put(const scene *s, const sample *in, uint8_t *pixel)
{
    const uint8_t *ground = s->options->background;
    if (in->opacity <= 0.0f)
    {
        memcpy(pixel, ground, 4);
        return;
    }
    double behind = (1.0 - (double)in->opacity) * ground[3] / 255.0, opacity = fmin((double)in->opacity + behind, 1.0);
    for (int c = 0; c < 3; ++c)
    {
        double light = ((double)in->light[c] + (behind > 0.0 ? behind * pls_render_linear_from_srgb(ground[c]) : 0.0)) / opacity;
        pixel[c] = s->shade[(int)(fmin(fmax(light, 0.0), 1.0) * (SHADES - 1) + 0.5)];
    }
    pixel[3] = (uint8_t)(opacity * 255.0 + 0.5);
}

static pls_status make_shades(scene *s)
{
    PLS_TRY(pls_allocate(&s->shade, SHADES, 1, "the shades of a picture"));
    for (int k = 0; k < SHADES; ++k)
    {
        double v = k / (double)(SHADES - 1);
        s->shade[k] = (uint8_t)lround(255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1.0 / 2.4) - 0.055));
    }
    return PLS_OK;
}

typedef struct tile_range
{
    int x0, y0, x1, y1;
} tile_range;

static tile_range range_of(const scene *s, int tile)
{
    int x = tile % s->tiles.columns * TILE, y = tile / s->tiles.columns * TILE;
    return (tile_range){x, y, x + TILE < s->view.width ? x + TILE : s->view.width, y + TILE < s->view.height ? y + TILE : s->view.height};
}

static void draw_tile(const scene *s, int tile, uint32_t *what, uint8_t *rgba)
{
    tile_range r = range_of(s, tile);
    for (int y = r.y0; y < r.y1; ++y)
    {
        for (int x = r.x0; x < r.x1; ++x)
        {
            size_t k = (size_t)y * (size_t)s->view.width + (size_t)x;
            sample in = look(s, x + 0.5, y + 0.5, (uint32_t)tile);
            what[k] = in.what;
            put(s, &in, &rgba[4 * k]);
        }
    }
}

/// Whether a neighbour shows something else.
static bool on_edge(const scene *s, const uint32_t *what, int x, int y)
{
    int w = s->view.width;
    const uint32_t *here = &what[(size_t)y * (size_t)w + (size_t)x];
    return (x > 0 && here[-1] != *here) || (x + 1 < w && here[1] != *here) || (y > 0 && here[-w] != *here) ||
           (y + 1 < s->view.height && here[w] != *here);
}

static sample look_four(const scene *s, int x, int y, uint32_t tile)
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

static void smooth_tile(const scene *s, int tile, const uint32_t *what, uint8_t *rgba)
{
    tile_range r = range_of(s, tile);
    for (int y = r.y0; y < r.y1; ++y)
    {
        for (int x = r.x0; x < r.x1; ++x)
        {
            if (!on_edge(s, what, x, y)) continue;
            sample in = look_four(s, x, y, (uint32_t)tile);
            put(s, &in, &rgba[4 * ((size_t)y * (size_t)s->view.width + (size_t)x)]);
        }
    }
}

static void draw(const scene *s, uint32_t *what, uint8_t *rgba)
{
    int tiles = s->tiles.columns * s->tiles.rows, threads = s->options->threads > 0 ? s->options->threads : pls_threads();
#pragma omp parallel num_threads(threads)
    {
#pragma omp for schedule(dynamic, 4)
        for (int tile = 0; tile < tiles; ++tile) draw_tile(s, tile, what, rgba);
#pragma omp for schedule(dynamic, 4)
        for (int tile = 0; tile < tiles; ++tile)
        {
            if (s->options->smooth_edges) smooth_tile(s, tile, what, rgba);
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

static void set_light(scene *s)
{
    s->light = pls_unit(s->options->light);
    pls_vec3 helper = fabs(s->light.x) < 0.6 ? pls_vec(1.0, 0.0, 0.0) : pls_vec(0.0, 1.0, 0.0);
    s->light_x = pls_unit(pls_cross(helper, s->light));
    s->light_y = pls_cross(s->light, s->light_x);
}

static pls_status make_grids(scene *s)
{
    pls_render_extent *extent = NULL;
    PLS_TRY(pls_allocate(&extent, s->bounded, sizeof *extent, "the bodies of a picture"));
    pls_status status = make_tiles(s, extent);
    if (status == PLS_OK) status = make_columns(s, extent);
    pls_release(&extent);
    return status;
}

static pls_status make_scene(scene *s, const pls_render_item *items, size_t count)
{
    PLS_TRY(make_bodies(s, items, count));
    measure(s);
    set_light(s);
    PLS_TRY(make_shades(s));
    return make_grids(s);
}

static void free_scene(scene *s)
{
    pls_release(&s->parts);
    pls_release(&s->bodies);
    pls_release(&s->shade);
    pls_render_grid_free(&s->tiles);
    pls_render_grid_free(&s->columns);
}

pls_status pls_render_image(const pls_render_item *items, size_t count, const pls_render_camera *camera, const pls_render_options *options,
                            pls_render_picture *picture)
{
    *picture = (pls_render_picture){0};
    PLS_TRY(check_options(options));
    scene s = {.options = options};
    PLS_TRY(pls_render_view_make(camera, options->width, options->height, &s.view));
    size_t pixels = (size_t)options->width * (size_t)options->height;
    uint32_t *what = NULL;
    pls_status status = make_scene(&s, items, count);
    if (status == PLS_OK) status = pls_allocate(&what, pixels, sizeof *what, "a picture");
    if (status == PLS_OK) status = pls_allocate(&picture->rgba, pixels, 4, "a picture");
    if (status == PLS_OK)
    {
        picture->width = options->width;
        picture->height = options->height;
        draw(&s, what, picture->rgba);
        if (options->bar) pls_render_bar(picture, options);
        pls_render_caption(picture, options);
    }
    pls_release(&what);
    free_scene(&s);
    return status;
}
