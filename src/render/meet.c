// meet.c -- where a ray meets a body.
//
// Balls, triangles, planes, polytopes and flat shapes are met in closed form, other convex shapes by Newton's method. All else by sphere tracing (Hart, Sphere tracing, The
// Visual Computer 12, 1996) with steps longer than the distance, taken back where two unbounding spheres do not touch (Keinert et al., Enhanced sphere tracing, STAG
// 2014), and regula falsi in the last step. Bodies that let light through are met one after the other, ordered by distance and number.

#include "render/stage.h"

enum { MOST_HALVINGS = 40 };
static const double relaxation = 1.3; ///< step over distance

bool pls_stage_within(const pls_render_ray *ray, pls_vec3 centre, double radius, double *from, double *to)
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

bool pls_stage_within_box(pls_vec3 O, pls_vec3 D, pls_vec3 lower, pls_vec3 upper, double grow, double *from, double *to)
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
    double eps = pls_stage_touch * shape->radius;
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

double pls_stage_distance(const pls_shape *shape, pls_vec3 X, pls_vec3 *gradient)
{
    *gradient = pls_shape_gradient(shape, X);
    if (!shape->convex || !shape->ops->gradient || !shape->ops->support) return pls_shape_sdf(shape, X);
    return pls_dot(*gradient, pls_sub(X, pls_shape_support(shape, *gradient))); // the plane of the nearest point is that far away
}

double pls_stage_level(const pls_shape *shape, pls_vec3 X, pls_vec3 *slope)
{
    return shape->ops->level ? shape->ops->level(shape, X, slope) : pls_stage_distance(shape, X, slope);
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

/// A convex shape lies behind the plane through its nearest point, or where the linear part of another convex function is 0: the ray goes on to that plane, which is Newton's
/// method, from outside all the way. Where the plane turns away the ray has missed. All in the shape's frame, where lengths are those of the world over `scale`.
static bool trace_convex(const pls_shape *shape, pls_vec3 O, pls_vec3 D, double from, double to, double *t_hit)
{
    if (shape->margin == 0.0 && shape->polytope && shape->polytope->face_count > 3)
        return meet_polytope(shape->polytope, O, D, from, to, t_hit);
    double eps = pls_stage_touch * shape->radius, t = from;
    for (int k = 0; k < PLS_STAGE_MOST_STEPS && t <= to; ++k)
    {
        pls_vec3 X = pls_add(O, pls_scale(D, t));
        pls_vec3 slope;
        double level = pls_stage_level(shape, X, &slope);
        *t_hit = t;
        if (level < eps * pls_length(slope)) return true;
        double away = pls_dot(slope, D);
        if (away >= 0.0) return false;
        t -= level / away;
    }
    return false;
}

/// The same for any shape.
static bool trace_shape(const pls_shape *shape, pls_vec3 O, pls_vec3 D, double from, double to, double *t_hit)
{
    double eps = pls_stage_touch * shape->radius, t = from, last = 0.0, step = 0.0, omega = relaxation;
    for (int k = 0; k < PLS_STAGE_MOST_STEPS && t <= to; ++k)
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
static bool hit_traced(const pls_stage_body *b, const pls_render_ray *ray, double first, double limit, double *t)
{
    const pls_shape *shape = b->item->shape;
    double from, to, scale = b->item->scale;
    if (!pls_stage_within(ray, b->centre, b->radius * (1.0 + 1e-9), &from, &to) || to <= fmax(first, 0.0)) return false;
    from = fmax(from, first);
    if (from > limit) return false;
    pls_vec3 O = pls_stage_to_shape(b->item, pls_add(ray->origin, pls_scale(ray->direction, from))),
             D = pls_stage_turn_in(b->item, ray->direction);
    double begin = 0.0, end = (fmin(to, limit) - from) / scale;
    if (!pls_stage_within_box(O, D, shape->lower, shape->upper, 1e-6 * shape->radius, &begin, &end)) return false;
    if (!(shape->convex ? trace_convex : trace_shape)(shape, O, D, begin, end, t)) return false;
    *t = from + *t * scale;
    return true;
}

static bool hit_flat(const pls_stage_body *b, const pls_render_ray *ray, double *t)
{
    *t = (b->item->position.z - ray->origin.z) / ray->direction.z;
    if (!isfinite(*t)) return false;
    pls_vec3 X = pls_stage_to_shape(b->item, pls_add(ray->origin, pls_scale(ray->direction, *t)));
    X.z = 0.0;
    return pls_shape_sdf(b->item->shape, X) * b->item->scale <= b->line;
}

/// Moeller & Trumbore, Fast, minimum storage ray-triangle intersection, J. Graphics Tools 2(1), 1997; edges are wide by round-off, so that neighbours leave no gap.
bool pls_stage_meet_triangle(const pls_stage_body *b, const pls_render_ray *ray, double first, double *t)
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
static bool hit_plane(const pls_stage *s, const pls_stage_body *b, const pls_render_ray *ray, double *t)
{
    double towards = pls_dot(b->normal, ray->direction);
    if (towards >= 0.0) return false;
    *t = pls_dot(b->normal, pls_sub(b->centre, ray->origin)) / towards;
    pls_vec3 p = pls_add(ray->origin, pls_scale(ray->direction, *t));
    for (size_t k = s->bounded; k < s->count; ++k)
    {
        const pls_stage_body *other = &s->bodies[k];
        if (other != b && other->kind == PLS_STAGE_PLANE && other->opacity > 0.0f &&
            pls_dot(other->normal, pls_sub(p, other->centre)) < -1e-9 * s->reach)
            return false;
    }
    return true;
}

void pls_stage_keep(const pls_stage *s, const pls_render_ray *ray, double *from, double *to)
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

static bool hit_ball(const pls_stage_body *b, const pls_render_ray *ray, double first, double *t)
{
    double to;
    if (!pls_stage_within(ray, b->centre, b->radius, t, &to) || to < first) return false;
    *t = fmax(*t, first);
    return true;
}

/// Before `limit`, if that is easy to say.
static bool hit_body(const pls_stage *s, const pls_stage_body *b, const pls_render_ray *ray, double limit, double *t)
{
    double first, last;
    pls_stage_keep(s, ray, &first, &last);
    switch (b->kind)
    {
        case PLS_STAGE_BALL: return hit_ball(b, ray, first, t) && *t <= last;
        case PLS_STAGE_TRIANGLE: return pls_stage_meet_triangle(b, ray, first, t) && *t <= last;
        case PLS_STAGE_PLANE: return hit_plane(s, b, ray, t);
        case PLS_STAGE_FLAT: return hit_flat(b, ray, t) && *t >= first && *t <= last;
        default: return hit_traced(b, ray, first, limit, t) && *t <= last;
    }
}

static bool before(pls_stage_hit a, pls_stage_hit b) { return a.t < b.t || (a.t == b.t && a.body < b.body); }

static void try_body(const pls_stage *s, const pls_render_ray *ray, uint32_t k, pls_stage_hit after, pls_stage_hit *best)
{
    pls_stage_hit found = {.body = k};
    if (!hit_body(s, &s->bodies[k], ray, best->t, &found.t)) return;
    if (!s->view.orthographic && found.t <= 0.0) return;
    if (before(after, found) && before(found, *best)) *best = found;
}

pls_stage_hit pls_stage_next(const pls_stage *s, const pls_render_ray *ray, uint32_t tile, pls_stage_hit after)
{
    pls_stage_hit best = {INFINITY, UINT32_MAX};
    for (size_t k = s->bounded; k < s->count; ++k)
    {
        if (s->bodies[k].opacity > 0.0f) try_body(s, ray, (uint32_t)k, after, &best);
    }
    for (uint32_t n = s->tiles.start[tile]; n < s->tiles.start[tile + 1]; ++n)
    {
        const pls_stage_body *b = &s->bodies[s->tiles.body[n]];
        if (pls_render_view_depth(&s->view, b->centre, b->radius) > best.t) break;
        try_body(s, ray, s->tiles.body[n], after, &best);
    }
    return best;
}
