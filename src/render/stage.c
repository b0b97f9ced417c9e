// stage.c -- the bodies of a picture: from items to what rays meet, and the two grids they are sorted into. See stage.h.
//
// A shape that is the union of parts (compound, mesh) is drawn as its parts, which are simpler and lie in fewer lists than the whole.

#include "render/stage.h"

#include <string.h>

enum { MOST_COLUMNS = 512 };
static const double thin_line = 2.5e-3; ///< half the width of a line, of the reach of all bodies

static bool is_ball(const pls_shape *shape)
{
    return shape->dimension == 3 && shape->margin > 0.0 && shape->polytope && shape->polytope->vertex_count == 1;
}

/// The half-space phi <= 0 of an SDF that is linear.
void pls_render_plane_of(const pls_render_item *item, pls_vec3 *normal, pls_vec3 *point)
{
    pls_vec3 X = pls_stage_to_shape(item, item->position);
    *normal = pls_stage_turn_out(item, pls_unit(pls_shape_gradient(item->shape, X)));
    *point = pls_sub(item->position, pls_scale(*normal, item->scale * pls_shape_sdf(item->shape, X)));
}

static void set_ball(pls_stage_body *b)
{
    const pls_shape *shape = b->item->shape;
    pls_vec3 from_centre = pls_sub(shape->polytope->vertex[0], shape->mass.centre);
    b->centre = pls_add(b->item->position, pls_scale(pls_stage_turn_out(b->item, from_centre), b->item->scale));
    b->radius = shape->margin * b->item->scale;
}

static bool is_triangle(const pls_shape *shape)
{
    return shape->dimension == 3 && shape->margin == 0.0 && shape->polytope && shape->polytope->vertex_count == 3;
}

static void set_triangle(pls_stage_body *b)
{
    const pls_render_item *item = b->item;
    for (int k = 0; k < 3; ++k)
    {
        pls_vec3 from_centre = pls_sub(item->shape->polytope->vertex[k], item->shape->mass.centre);
        b->corner[k] = pls_add(item->position, pls_scale(pls_stage_turn_out(item, from_centre), item->scale));
    }
    b->normal = pls_unit(pls_cross(pls_sub(b->corner[1], b->corner[0]), pls_sub(b->corner[2], b->corner[0])));
}

static pls_stage_kind kind_of(const pls_shape *shape)
{
    if (shape->dimension == 2) return PLS_STAGE_FLAT;
    return shape->ops->unbounded ? PLS_STAGE_PLANE
           : is_ball(shape)      ? PLS_STAGE_BALL
           : is_triangle(shape)  ? PLS_STAGE_TRIANGLE
                                 : PLS_STAGE_TRACED;
}

static void set_body(pls_stage_body *b, const pls_render_item *item, const pls_render_options *options)
{
    static const uint8_t wall[3] = {215, 215, 215}, flat_wall[3] = {130, 130, 130};
    *b = (pls_stage_body){.centre = item->position, .item = item, .opacity = fminf(fmaxf(item->opacity, 0.0f), 1.0f)};
    b->radius = item->radius > 0.0 ? item->radius : item->shape->radius * item->scale;
    uint8_t rgb[3];
    if (isnan(item->value))
        memcpy(rgb, options->plain, sizeof rgb);
    else
        pls_render_colour(options->colours, item->value, options->low, options->high, rgb);
    if (item->shape->ops->unbounded || item->shape->ops->wall) memcpy(rgb, item->shape->dimension == 2 ? flat_wall : wall, sizeof rgb);
    for (int c = 0; c < 3; ++c) b->albedo[c] = (float)pls_render_linear_from_srgb(rgb[c]);
    b->kind = kind_of(item->shape);
    if (b->kind == PLS_STAGE_PLANE) pls_render_plane_of(item, &b->normal, &b->centre);
    if (b->kind == PLS_STAGE_BALL) set_ball(b);
    if (b->kind == PLS_STAGE_TRIANGLE) set_triangle(b);
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
    one.position = pls_add(item->position, pls_scale(pls_stage_turn_out(item, from_centre), item->scale));
    pls_quat to_body =
        pls_quat_multiply(pls_quat_conjugate(whole->principal), pls_quat_multiply(part->orientation, part->shape->principal));
    one.orientation = pls_quat_multiply(item->orientation, to_body);
    return one;
}

static pls_status make_parts(pls_stage *s, const pls_render_item *items, size_t count)
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
static void add_bodies(pls_stage *s, const pls_render_item *items, size_t count, bool unbounded)
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

static pls_status make_bodies(pls_stage *s, const pls_render_item *items, size_t count)
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

static pls_status make_tiles(pls_stage *s, pls_render_extent *extent)
{
    for (size_t k = 0; k < s->bounded; ++k)
    {
        int e[4];
        const pls_stage_body *b = &s->bodies[k];
        extent[k] = (pls_render_extent){.x1 = -1};
        if (b->opacity <= 0.0f || !pls_render_view_extent(&s->view, b->centre, b->radius, e)) continue;
        extent[k] = (pls_render_extent){e[0] / PLS_STAGE_TILE, e[1] / PLS_STAGE_TILE, e[2] / PLS_STAGE_TILE, e[3] / PLS_STAGE_TILE,
                                        pls_render_view_depth(&s->view, b->centre, b->radius)};
    }
    return pls_render_grid_make(&s->tiles, (s->view.width + PLS_STAGE_TILE - 1) / PLS_STAGE_TILE,
                                (s->view.height + PLS_STAGE_TILE - 1) / PLS_STAGE_TILE, extent, s->bounded);
}

static void measure(pls_stage *s)
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
        if (s->bodies[k].kind == PLS_STAGE_FLAT && s->bodies[k].item->shape->ops->wall) s->bodies[k].line = thin_line * s->reach;
    }
    s->check = raw < 2.0 * power ? power : raw < 5.0 * power ? 2.0 * power : 5.0 * power;
}

double pls_stage_shadow_radius(const pls_stage *s, const pls_stage_body *b)
{
    if (b->kind == PLS_STAGE_TRIANGLE) return b->radius;
    return b->radius + fmin(pls_stage_widest_penumbra * b->radius, 2.0 * s->reach * s->options->softness);
}

static int cell_of(double place, double corner, double side, int cells)
{
    double c = floor((place - corner) / side);
    return c < 0.0 ? 0 : c >= cells ? cells - 1 : (int)c;
}

/// Columns along the light, as wide as a radius on average; the body that is highest comes first.
static pls_status make_columns(pls_stage *s, pls_render_extent *extent)
{
    double lower[2] = {INFINITY, INFINITY}, upper[2] = {-INFINITY, -INFINITY}, mean = 0.0;
    for (size_t k = 0; k < s->bounded; ++k)
    {
        const pls_stage_body *b = &s->bodies[k];
        double r = pls_stage_shadow_radius(s, b), x = pls_dot(b->centre, s->light_x), y = pls_dot(b->centre, s->light_y);
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
        const pls_stage_body *b = &s->bodies[k];
        double r = pls_stage_shadow_radius(s, b), x = pls_dot(b->centre, s->light_x), y = pls_dot(b->centre, s->light_y);
        extent[k] = (pls_render_extent){cell_of(x - r, lower[0], s->side, columns), cell_of(y - r, lower[1], s->side, rows),
                                        cell_of(x + r, lower[0], s->side, columns), cell_of(y + r, lower[1], s->side, rows),
                                        -(pls_dot(b->centre, s->light) + b->radius)};
        if (b->opacity <= 0.0f || b->kind == PLS_STAGE_FLAT) extent[k].x1 = extent[k].x0 - 1;
    }
    return pls_render_grid_make(&s->columns, columns, rows, extent, s->bounded);
}

static void set_light(pls_stage *s)
{
    s->light = pls_unit(s->options->light);
    pls_vec3 helper = fabs(s->light.x) < 0.6 ? pls_vec(1.0, 0.0, 0.0) : pls_vec(0.0, 1.0, 0.0);
    s->light_x = pls_unit(pls_cross(helper, s->light));
    s->light_y = pls_cross(s->light, s->light_x);
}

static pls_status make_grids(pls_stage *s)
{
    pls_render_extent *extent = NULL;
    PLS_TRY(pls_allocate(&extent, s->bounded, sizeof *extent, "the bodies of a picture"));
    pls_status status = make_tiles(s, extent);
    if (status == PLS_OK) status = make_columns(s, extent);
    pls_release(&extent);
    return status;
}

pls_status pls_stage_make(pls_stage *s, const pls_render_item *items, size_t count)
{
    PLS_TRY(make_bodies(s, items, count));
    measure(s);
    set_light(s);
    return make_grids(s);
}

void pls_stage_free(pls_stage *s)
{
    pls_release(&s->parts);
    pls_release(&s->bodies);
    pls_render_grid_free(&s->tiles);
    pls_render_grid_free(&s->columns);
}
