// light.c -- how much of the light reaches a point.
//
// Shadows are soft by how close a ray to the light passes a body, over how far it has gone, instead of by many rays.

#include "render/stage.h"

enum { NEAREST_STEPS = 3 }; ///< towards the point of a ray that is nearest to a convex shape

static const double level_enough = 0.01; ///< slope of the distance along the ray at which it is the least, but for its square

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

/// Distance and slope in one.
static double shadow_descent(const shadow_ray *r, double t, double *slope)
{
    pls_vec3 gradient;
    double phi = pls_stage_distance(r->shape, pls_add(r->O, pls_scale(r->D, t / r->scale)), &gradient);
    *slope = pls_dot(gradient, r->D);
    return r->scale * phi;
}

/// What passes at a distance phi after the way t.
static double pass_at(const shadow_ray *r, double t, double phi)
{
    double wide = fmin(r->softness * t, r->widest);
    return phi < r->eps ? 0.0 : phi < wide ? phi / wide : 1.0;
}

/// What passes, where that is clear without distances: nothing or all. Else -1, and `from` is where the level still falls. Each plane that a level set touches leaves the shape behind it: the ray goes from plane to plane
/// as it does to a body that is seen, and where it misses, it comes no closer than to where the last two planes cross.
static double pass_clearly(const shadow_ray *r, double *from)
{
    double t = r->from, last_t = t, last = 0.0, last_rate = 0.0; // the last plane: distance at last_t, and its rate
    if (!r->shape->ops->level) return -1.0;
    for (int k = 0; k < PLS_STAGE_MOST_STEPS && t <= r->to; ++k)
    {
        pls_vec3 slope;
        const double level = pls_stage_level(r->shape, pls_add(r->O, pls_scale(r->D, t / r->scale)), &slope);
        const double length = pls_length(slope), distance = r->scale * level / length, rate = pls_dot(slope, r->D) / length;
        if (distance < 0.0) return 0.0;
        if (rate >= 0.0)
        {
            // last + last_rate (x - last_t) = distance + rate (x - t), where last_rate < 0
            const double fall = rate - last_rate,
                         x = k > 0 && fall > 0.0 ? (last - last_rate * last_t - distance + rate * t) / fall : r->from;
            *from = last_t;
            return distance + rate * (fmax(x, r->from) - t) > fmin(r->widest, r->softness * r->to) ? 1.0 : -1.0;
        }
        last_t = t, last = distance, last_rate = rate;
        t -= distance / rate;
    }
    return -1.0;
}

/// Distances from a convex shape fall and rise along the ray: Newton's method from plane to plane until they rise, then the least one between by regula falsi of the slopes.
static double pass_convex(const shadow_ray *r)
{
    double low = r->from, slope_low = 0.0, t = r->from;
    const double clear = pass_clearly(r, &t);
    if (clear >= 0.0) return clear;
    for (int k = 0; k < PLS_STAGE_MOST_STEPS && t <= r->to; ++k)
    {
        double slope, phi = shadow_descent(r, t, &slope);
        if (phi < r->eps) return 0.0;
        if (slope >= 0.0 && slope_low == 0.0 && t > r->from) // distances rise before levels do: from the beginning
        {
            t = r->from;
            continue;
        }
        if (slope >= 0.0)
        {
            double high = t, slope_high = slope;
            for (int n = 0; n < NEAREST_STEPS && slope_low < 0.0 && slope_high > 0.0; ++n)
            {
                t = low - slope_low * (high - low) / (slope_high - slope_low);
                phi = shadow_descent(r, t, &slope);
                if (fabs(slope) < level_enough) break;
                *(slope < 0.0 ? &low : &high) = t;
                *(slope < 0.0 ? &slope_low : &slope_high) = slope;
            }
            return pass_at(r, t, phi);
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
    for (double t = r->from, k = 0; t <= r->to && k < PLS_STAGE_MOST_STEPS / 2 && pass > 0.0; ++k)
    {
        double phi = shadow_distance(r, t);
        pass = fmin(pass, pass_at(r, t, phi));
        t += phi;
    }
    return pass;
}

/// What a traced body lets through to the point p.
static double pass_traced(const pls_stage *s, const pls_stage_body *b, pls_vec3 p)
{
    const pls_shape *shape = b->item->shape;
    double from, to, scale = b->item->scale;
    if (!pls_stage_within(&(pls_render_ray){p, s->light}, b->centre, pls_stage_shadow_radius(s, b), &from, &to)) return 1.0;
    shadow_ray r = {.shape = shape, .scale = scale, .softness = s->options->softness, .widest = pls_stage_widest_penumbra * b->radius};
    r.eps = 10.0 * pls_stage_touch * b->radius;
    r.O = pls_stage_to_shape(b->item, p);
    r.D = pls_stage_turn_in(b->item, s->light);
    double begin = fmax(from, 2e-3 * b->radius) / scale, end = to / scale, penumbra = fmin(r.softness * to, r.widest) / scale;
    if (!pls_stage_within_box(r.O, r.D, shape->lower, shape->upper, penumbra, &begin, &end)) return 1.0;
    r.from = begin * scale;
    r.to = end * scale;
    return pls_stage_smooth(shape->convex ? pass_convex(&r) : pass_any(&r));
}

/// What a ball lets through.
static double pass_ball(const pls_stage *s, const pls_stage_body *b, pls_vec3 p)
{
    pls_vec3 v = pls_sub(b->centre, p);
    double t = pls_dot(v, s->light);
    if (t <= 0.0) return 1.0;
    pls_vec3 beside = pls_sub(v, pls_scale(s->light, t));
    double wide = fmin(s->options->softness * t, pls_stage_widest_penumbra * b->radius), away = pls_dot(beside, beside),
           reach = b->radius + wide;
    if (away >= reach * reach) return 1.0;
    double gap = sqrt(away) - b->radius;
    return gap <= 0.0 ? 0.0 : pls_stage_smooth(gap / wide);
}

/// What a triangle lets through. Its shadow is sharp: those of neighbours then join without a seam.
static double pass_triangle(const pls_stage *s, const pls_stage_body *b, pls_vec3 p)
{
    double t;
    return pls_stage_meet_triangle(b, &(pls_render_ray){p, s->light}, 2e-3 * b->radius, &t) ? 0.0 : 1.0;
}

static double pass_body(const pls_stage *s, const pls_stage_body *b, pls_vec3 p)
{
    switch (b->kind)
    {
        case PLS_STAGE_BALL: return pass_ball(s, b, p);
        case PLS_STAGE_TRIANGLE: return pass_triangle(s, b, p);
        default: return pass_traced(s, b, p);
    }
}

double pls_stage_lit(const pls_stage *s, pls_vec3 p, uint32_t self)
{
    if (!s->columns.start) return 1.0;
    double x = (pls_dot(p, s->light_x) - s->corner_x) / s->side, y = (pls_dot(p, s->light_y) - s->corner_y) / s->side;
    if (!(x >= 0.0 && y >= 0.0 && x < s->columns.columns && y < s->columns.rows)) return 1.0;
    size_t cell = (size_t)y * (size_t)s->columns.columns + (size_t)x;
    double height = pls_dot(p, s->light), pass = 1.0, first, last;
    pls_stage_keep(s, &(pls_render_ray){p, s->light}, &first, &last);
    for (uint32_t n = s->columns.start[cell]; n < s->columns.start[cell + 1] && pass > 0.01; ++n)
    {
        uint32_t k = s->columns.body[n];
        const pls_stage_body *b = &s->bodies[k];
        if (pls_dot(b->centre, s->light) + b->radius <= height) break;
        if (pls_dot(pls_sub(b->centre, p), s->light) > last) continue; // cut away, if not to its last bit
        if (k == self && (b->kind == PLS_STAGE_BALL || b->item->shape->convex)) continue;
        pass *= 1.0 - (double)b->opacity * (1.0 - pass_body(s, b, p));
    }
    return pass;
}
