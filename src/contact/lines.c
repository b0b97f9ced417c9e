// lines.c -- contact along lines: a force that is the gradient of an energy.
//
// A capsule that lies on a floor is deepest at one of its ends; which one changes with the least tilt, and with it the force jumps from end to end: such a capsule never comes to
// rest, and gains energy. So do rounded boxes with an edge along a face. The law here goes by all of the line. The cores (bodies less their margins r_A, r_B) are apart where bodies
// touch no deeper than they are rounded, and a point x of an edge of core A overlaps B by t(x) = r_A + r_B - dist(x, core B). With integrals over the edges of the cores
//
//     energy kn delta^2/2,   delta = integral t^3 ds / integral t^2 ds,
//
// a smooth maximum of t as that over areas in faces.c: the depth where lines are parallel to what they lie on, 3/4 of it where one end touches, 6/7 where lines cross. The
// distance from a convex set has a continuous gradient, so the force has no jumps, and the edges are bodies' own, so it is the gradient of the energy:
//
//     d(delta) = integral w dt ds,   w = (3 t^2 - 2 delta t) / integral t^2 ds.
//
// Which edges: a capsule's own line, or both of two capsules; of two polytopes those of both, since faces that lie on each other have an outline made of both. That there is
// nothing between edges is no loss: where polytopes touch, edges do.
//
// The distance is smooth within each region of points that are nearest to one face, edge or corner. These are bounded by planes, so that an edge is cut to the regions
// it passes through; in each Gauss points integrate, exactly over faces. A point on the border of two regions counts once: both ask the same number for its sign.

#include "contact/lines.h"

#include "contact/overlap_laws.h"
#include "math/gauss.h"

#include <string.h>

static const double parallel = 1e-12; ///< sine of the angle below which a line keeps its distance from an edge

/// Integrals over lines; `force` and `torque` are what pushes B.
typedef struct push
{
    pls_vec3 force, torque;
} push;

typedef struct sums
{
    double power[4];  ///< of t^k
    push by_t, by_t2; ///< of t and t^2 times the gradient of t
    pls_vec3 even;    ///< of x
    pls_vec3 first;   ///< of t x
    double second[6]; ///< of t x x
} sums;

/// An edge x(s) = start + s along of one body, in metres in the frame of the other, whose core is `against`.
typedef struct line
{
    const pls_posed *against;
    const pls_polytope *core;
    double reach;      ///< both margins
    double own_margin; ///< of the body whose edge it is
    double sign;       ///< what pushes B: -1 away from `against`, if that is B
    pls_vec3 origin;   ///< of what is summed, in the world
    pls_vec3 start, along;
} line;

/// Of s.
typedef struct range
{
    double low, high;
} range;

/// What a part of a line is nearest to.
typedef struct feature
{
    int freedom; ///< 2: a face, 1: an edge, 0: a corner
    pls_vec3 point, direction;
} feature;

// ---- planes -------------------------------------------------------------------------------------------------------------------------------------------------

/// Keep where (x - point).normal <= 0; on the plane itself if `border`.
static void keep_below(range *r, const line *l, pls_vec3 normal, pls_vec3 point, bool border)
{
    const double height = pls_dot(pls_sub(l->start, point), normal), slope = pls_dot(l->along, normal);
    if (slope > 0.0)
        r->high = fmin(r->high, -height / slope);
    else if (slope < 0.0)
        r->low = fmax(r->low, -height / slope);
    else if (!(border ? height <= 0.0 : height < 0.0))
        r->high = -INFINITY;
}

static void keep_above(range *r, const line *l, pls_vec3 normal, pls_vec3 point, bool border)
{
    keep_below(r, l, pls_scale(normal, -1.0), point, border);
}

static bool is_empty(range r) { return !(r.high > r.low); }

static pls_vec3 corner_of(const line *l, uint32_t v) { return pls_scale(l->core->vertex[v], l->against->scale); }

// ---- sums ---------------------------------------------------------------------------------------------------------------------------------------------------

static void add_point(sums *sum, const line *l, const feature *f, double s, double weight)
{
    const pls_vec3 x = pls_add(l->start, pls_scale(l->along, s)), from = pls_sub(x, f->point);
    pls_vec3 away = f->direction;
    double distance = pls_dot(from, away);
    if (f->freedom < 2)
    {
        const pls_vec3 d = f->freedom == 1 ? pls_sub(from, pls_scale(f->direction, pls_dot(from, f->direction))) : from;
        distance = pls_length(d);
        if (!(distance > 0.0)) return; // of cores that touch in one point
        away = pls_scale(d, 1.0 / distance);
    }
    const double t = l->reach - distance;
    if (!(t > 0.0)) return;
    // In the middle between the two surfaces.
    const double inwards = 0.5 * (l->own_margin - (l->reach - l->own_margin) + distance);
    const pls_vec3 world = pls_add(l->against->position, pls_posed_turn(l->against, pls_sub(x, pls_scale(away, inwards))));
    const pls_vec3 at = pls_sub(world, l->origin), pushes = pls_scale(pls_posed_turn(l->against, away), l->sign);
    const pls_vec3 turns = pls_cross(at, pushes);
    const double second[6] = {at.x * at.x, at.y * at.y, at.z * at.z, at.x * at.y, at.x * at.z, at.y * at.z};
    double power = weight;
    for (int k = 0; k < 4; ++k, power *= t) sum->power[k] += power;
    sum->by_t.force = pls_add(sum->by_t.force, pls_scale(pushes, weight * t));
    sum->by_t.torque = pls_add(sum->by_t.torque, pls_scale(turns, weight * t));
    sum->by_t2.force = pls_add(sum->by_t2.force, pls_scale(pushes, weight * t * t));
    sum->by_t2.torque = pls_add(sum->by_t2.torque, pls_scale(turns, weight * t * t));
    sum->even = pls_add(sum->even, pls_scale(at, weight));
    sum->first = pls_add(sum->first, pls_scale(at, weight * t));
    for (int k = 0; k < 6; ++k) sum->second[k] += weight * t * second[k];
}

/// Keep where the feature is nearer than `reach`.
static void keep_near(range *r, const line *l, const feature *f)
{
    if (f->freedom == 2)
    {
        keep_below(r, l, f->direction, pls_add(f->point, pls_scale(f->direction, l->reach)), true);
        return;
    }
    pls_vec3 from = pls_sub(l->start, f->point), along = l->along;
    if (f->freedom == 1)
    {
        from = pls_sub(from, pls_scale(f->direction, pls_dot(from, f->direction)));
        along = pls_sub(along, pls_scale(f->direction, pls_dot(along, f->direction)));
    }
    const double a = pls_dot(along, along), b = pls_dot(from, along), most = l->reach * l->reach;
    if (!(a > parallel * parallel * pls_dot(l->along, l->along)))
    {
        if (!(pls_dot(from, from) < most)) r->high = -INFINITY;
        return;
    }
    const double middle = -b / a;
    const pls_vec3 nearest = pls_add(from, pls_scale(along, middle));
    const double half = sqrt(fmax(most - pls_dot(nearest, nearest), 0.0) / a);
    r->low = fmax(r->low, middle - half), r->high = fmin(r->high, middle + half);
}

/// The part of a line that is nearest to one feature. Gauss-Legendre: three points are exact for faces (t^2 x is cubic), of round ones the overlap is a small part.
static void add_part(sums *sum, const line *l, const feature *f, range r)
{
    static const double few[2] = {0.0, 0.77459666924148338}, few_weight[2] = {8.0 / 9.0, 5.0 / 9.0};
    keep_near(&r, l, f);
    if (is_empty(r)) return;
    const double middle = 0.5 * (r.low + r.high), half = 0.5 * (r.high - r.low), metres = half * pls_length(l->along);
    const bool flat = f->freedom == 2;
    for (int k = flat ? 1 : 0; k < (flat ? 2 : 4); ++k)
        for (int side = -1; side <= 1; side += 2)
            add_point(sum, l, f, middle + side * half * (flat ? few[k] : pls_gauss_node[k]),
                      metres * (flat ? few_weight[k] : pls_gauss_weight[k]));
    if (flat) add_point(sum, l, f, middle, metres * few_weight[0]);
}

// ---- regions ------------------------------------------------------------------------------------------------------------------------------------------------

static uint32_t corners_of(const pls_polytope *p, uint32_t face) { return p->face_start[face + 1] - p->face_start[face]; }
static uint32_t corner_at(const pls_polytope *p, uint32_t face, uint32_t k)
{
    return p->face_vertex[p->face_start[face] + k % corners_of(p, face)];
}

/// Out of a face through its edge from corner k to k + 1.
static pls_vec3 side_of(const line *l, uint32_t face, uint32_t k)
{
    const pls_vec3 p = corner_of(l, corner_at(l->core, face, k)), q = corner_of(l, corner_at(l->core, face, k + 1));
    return pls_cross(pls_sub(q, p), l->core->face_normal[face]);
}

static void keep_between(range *r, const line *l, pls_vec3 p, pls_vec3 q)
{
    keep_above(r, l, pls_sub(q, p), p, true);
    keep_above(r, l, pls_sub(p, q), q, true);
}

static void over_face(sums *sum, const line *l, uint32_t face, range r)
{
    const pls_polytope *c = l->core;
    const feature f = {2, corner_of(l, corner_at(c, face, 0)), c->face_normal[face]};
    keep_above(&r, l, f.direction, f.point, true);
    if (corners_of(c, face) == 2) // 2D
        keep_between(&r, l, f.point, corner_of(l, corner_at(c, face, 1)));
    else
        for (uint32_t k = 0; k < corners_of(c, face) && !is_empty(r); ++k)
            keep_below(&r, l, side_of(l, face, k), corner_of(l, corner_at(c, face, k)), true);
    if (!is_empty(r)) add_part(sum, l, &f, r);
}

/// Inside of the core, nearest to `face`.
static void under_face(sums *sum, const line *l, uint32_t face, range r)
{
    const pls_polytope *c = l->core;
    const feature f = {2, corner_of(l, corner_at(c, face, 0)), c->face_normal[face]};
    keep_below(&r, l, f.direction, f.point, false);
    for (uint32_t g = 0; g < c->face_count && !is_empty(r); ++g)
    {
        if (g == face) continue;
        const pls_vec3 normal = c->face_normal[g], point = corner_of(l, corner_at(c, g, 0)), turn = pls_sub(normal, f.direction);
        keep_below(&r, l, normal, point, false);
        // Heights over g less those over `face` are linear in x: zero at `start` moved along.
        const double height = pls_dot(pls_sub(l->start, point), normal) - pls_dot(pls_sub(l->start, f.point), f.direction);
        const double slope = pls_dot(l->along, turn);
        if (slope > 0.0)
            r.high = fmin(r.high, -height / slope);
        else if (slope < 0.0)
            r.low = fmax(r.low, -height / slope);
        else if (!(g < face ? height < 0.0 : height <= 0.0))
            r.high = -INFINITY;
    }
    if (!is_empty(r)) add_part(sum, l, &f, r);
}

/// The face on the other side of the edge from corner k of `face`, and that edge's place in it.
static bool other_face(const pls_polytope *c, uint32_t face, uint32_t k, uint32_t *other, uint32_t *place)
{
    const uint32_t p = corner_at(c, face, k), q = corner_at(c, face, k + 1);
    for (uint32_t g = 0; g < c->face_count; ++g)
        for (uint32_t j = 0; j < corners_of(c, g); ++j)
            if (g != face && corner_at(c, g, j) == q && corner_at(c, g, j + 1) == p)
            {
                *other = g, *place = j;
                return true;
            }
    return false;
}

static void over_edge(sums *sum, const line *l, uint32_t face, uint32_t k, uint32_t other, uint32_t place, range r)
{
    const pls_polytope *c = l->core;
    const pls_vec3 p = corner_of(l, corner_at(c, face, k)), q = corner_of(l, corner_at(c, face, k + 1));
    keep_above(&r, l, side_of(l, face, k), p, false);
    keep_above(&r, l, side_of(l, other, place), q, false);
    keep_between(&r, l, p, q);
    if (is_empty(r)) return;
    const feature f = {1, p, pls_unit(pls_sub(q, p))};
    add_part(sum, l, &f, r);
}

static void over_corner(sums *sum, const line *l, uint32_t v, range r)
{
    const pls_polytope *c = l->core;
    const feature f = {0, corner_of(l, v), {0.0, 0.0, 0.0}};
    const bool listed = c->neighbour_start != NULL;
    const uint32_t first = listed ? c->neighbour_start[v] : 0, last = listed ? c->neighbour_start[v + 1] : c->vertex_count;
    for (uint32_t k = first; k < last && !is_empty(r); ++k)
    {
        const uint32_t w = listed ? c->neighbour[k] : k;
        if (w != v) keep_below(&r, l, pls_sub(corner_of(l, w), f.point), f.point, false);
    }
    if (!is_empty(r)) add_part(sum, l, &f, r);
}

static void over_polytope(sums *sum, const line *l)
{
    enum { MOST = PLS_MOST_FACES };
    const pls_polytope *c = l->core;
    range r = {0.0, 1.0};
    for (uint32_t f = 0; f < c->face_count && !is_empty(r); ++f) // nearer to it than the margins reach
    {
        const pls_vec3 n = c->face_normal[f];
        keep_below(&r, l, n, pls_add(corner_of(l, corner_at(c, f, 0)), pls_scale(n, l->reach)), true);
    }
    if (is_empty(r)) return;
    // Only what belongs to a face that some of the line is over can be nearest, unless all of it is inside.
    bool over[MOST], done[2 * MOST] = {false}, inside = true;
    for (uint32_t f = 0; f < c->face_count; ++f)
    {
        range above = r;
        keep_above(&above, l, c->face_normal[f], corner_of(l, corner_at(c, f, 0)), true);
        over[f] = !is_empty(above);
    }
    for (uint32_t f = 0; f < c->face_count; ++f)
    {
        range below = r;
        keep_below(&below, l, c->face_normal[f], corner_of(l, corner_at(c, f, 0)), false);
        inside = inside && !is_empty(below);
    }
    for (uint32_t f = 0; f < c->face_count; ++f)
    {
        if (inside) under_face(sum, l, f, r);
        if (!over[f]) continue;
        over_face(sum, l, f, r);
        for (uint32_t k = 0; k < corners_of(c, f); ++k)
        {
            uint32_t other, place;
            if (corners_of(c, f) > 2 && other_face(c, f, k, &other, &place) && !(over[other] && other < f))
                over_edge(sum, l, f, k, other, place, r);
            const uint32_t v = corner_at(c, f, k);
            if (!done[v]) over_corner(sum, l, v, r);
            done[v] = true;
        }
    }
}

static void over_segment(sums *sum, const line *l)
{
    const pls_vec3 p = corner_of(l, 0), q = corner_of(l, 1);
    const feature f = {1, p, pls_unit(pls_sub(q, p))};
    range r = {0.0, 1.0};
    keep_between(&r, l, p, q);
    if (!is_empty(r)) add_part(sum, l, &f, r);
    for (uint32_t v = 0; v < 2; ++v) over_corner(sum, l, v, (range){0.0, 1.0});
}

// ---- bodies -------------------------------------------------------------------------------------------------------------------------------------------------

static double margin_of(const pls_posed *p) { return p->shape->margin * p->scale; }

static bool is_segment(const pls_shape *s)
{
    return s->convex && s->polytope && s->polytope->vertex_count == 2 && s->polytope->face_count == 0 &&
           pls_length(pls_sub(s->polytope->vertex[1], s->polytope->vertex[0])) > 0.0;
}

static bool has_edges(const pls_shape *s)
{
    return s->convex && s->polytope && s->polytope->face_count > 1 && s->polytope->face_count <= PLS_MOST_FACES &&
           s->polytope->vertex_count <= 2 * PLS_MOST_FACES;
}

static void add_edge(sums *sum, line *l, const pls_posed *own, pls_vec3 p, pls_vec3 q)
{
    const pls_posed *other = l->against;
    const pls_vec3 start = pls_sub(pls_posed_world(own, p), other->position);
    l->start = pls_posed_turn_back(other, start);
    l->along = pls_posed_turn_back(other, pls_scale(pls_posed_turn(own, pls_sub(q, p)), own->scale));
    if (other->shape->ops->unbounded)
    {
        const feature ground = {2, {0.0, 0.0, 0.0}, pls_shape_gradient(other->shape, pls_vec(0.0, 0.0, 0.0))};
        add_part(sum, l, &ground, (range){0.0, 1.0});
    }
    else if (is_segment(other->shape))
        over_segment(sum, l);
    else
        over_polytope(sum, l);
}

/// `n` from `own` to `other`.
static void add_edges(sums *sum, const pls_posed *own, const pls_posed *other, pls_vec3 n, pls_vec3 origin, double sign)
{
    const pls_polytope *p = own->shape->polytope;
    line l = {.against = other,
              .core = other->shape->polytope,
              .reach = margin_of(own) + margin_of(other),
              .own_margin = margin_of(own),
              .sign = sign,
              .origin = origin};
    if (p->face_count == 0)
    {
        add_edge(sum, &l, own, p->vertex[0], p->vertex[1]);
        return;
    }
    // Edges below all of the other body are far from it.
    bool near[2 * PLS_MOST_FACES];
    const double lowest = pls_dot(n, pls_posed_support(other, pls_scale(n, -1.0))) - margin_of(own);
    for (uint32_t v = 0; v < p->vertex_count; ++v) near[v] = pls_dot(n, pls_posed_world(own, p->vertex[v])) > lowest;
    for (uint32_t f = 0; f < p->face_count; ++f)
        for (uint32_t k = 0; k < corners_of(p, f); ++k)
        {
            const uint32_t v = corner_at(p, f, k), w = corner_at(p, f, k + 1);
            const bool once = corners_of(p, f) == 2 ? k == 0 : v < w;
            if (once && (near[v] || near[w])) add_edge(sum, &l, own, p->vertex[v], p->vertex[w]);
        }
}

// ---- the law ------------------------------------------------------------------------------------------------------------------------------------------------

/// As of an overlap whose thickness is t: the law is MANIFOLD of faces.c.
static pls_overlap_integrals integrals_of(const sums *sum)
{
    const double *W = sum->power;
    pls_overlap_integrals P = {.volume = W[1],
                               .surface = W[0],
                               .first = sum->first,
                               .scattered = true,
                               .line = true,
                               .area_moment = sum->even,
                               .by_depth = {W[2] / 2.0, sum->by_t.force, sum->by_t.torque},
                               .by_its_square = {W[3] / 3.0, sum->by_t2.force, sum->by_t2.torque}};
    memcpy(P.second, sum->second, sizeof P.second);
    return P;
}

bool pls_line_law(pls_overlap_integrals *P, double size, bool flat, pls_touch *out)
{
    const pls_narrow_options manifold = {.faces = PLS_FACES_MANIFOLD};
    pls_touch t = *out;
    if (!pls_overlap_touch(P, &manifold, PLS_OVERLAP_BLUR * size, flat, &t)) return false;
    // Cores nearly in each other: pushes from all sides cancel, and what is left of them would act far away. The point stands.
    if (!(pls_length(pls_sub(t.point, pls_scale(P->first, 1.0 / P->volume))) < size)) return false;
    if (flat) t.twist = 0.0;
    *out = t;
    return true;
}

bool pls_lines_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, pls_touch *out)
{
    const bool line_a = is_segment(a->shape), line_b = is_segment(b->shape), ground = b->shape->ops->unbounded;
    const bool known_a = line_a || has_edges(a->shape), known_b = line_b || has_edges(b->shape) || ground;
    if (!known_a || !known_b || (ground && !line_a)) return false;
    if (!(a->shape->margin > 0.0) && !(b->shape->margin > 0.0)) return false;
    const pls_vec3 origin = pls_scale(pls_add(depth->on_a, depth->on_b), 0.5);
    sums sum = {0};
    if (line_a || !line_b) add_edges(&sum, a, b, depth->normal, origin, -1.0);
    if (!ground && (line_b || !line_a)) add_edges(&sum, b, a, pls_scale(depth->normal, -1.0), origin, 1.0);
    out->depth = out->reach = depth->delta;
    pls_overlap_integrals P = integrals_of(&sum);
    if (!(sum.power[3] > 0.0))
        out->delta = fmin(depth->delta, 0.0);
    else if (pls_line_law(&P, fmin(a->size, b->size), a->shape->dimension == 2, out))
        out->point = pls_add(origin, out->point), out->middle = pls_add(origin, out->middle);
    return true;
}

bool pls_has_line(const pls_shape *shape) { return is_segment(shape) && shape->margin > 0.0; }

bool pls_line_on(const pls_posed *a, const pls_posed *facet, pls_vec3 origin, pls_overlap_integrals *P)
{
    sums sum = {0};
    add_edges(&sum, a, facet, pls_vec(0.0, 0.0, 0.0), origin, -1.0);
    *P = integrals_of(&sum);
    return sum.power[3] > 0.0;
}
