// sampled_touch.c -- overlaps as sums over pieces of surfaces (surface_sample.h), each as deep as the other body's SDF says.
//
// With d(x) the depth of a piece of A in B, a its area, and the same the other way round,
//
//     W = 1/2 [ sum over A of a d_B^2 / 2 + sum over B of a d_A^2 / 2 ],       Q likewise with d^3 / 3,
//
// for walls the sums over A alone, whole. For parallel faces these are the integrals of t^2/2 and t^3/3 over the area of touch, t its local overlap, which the laws of faces.c are
// about, and so the laws are the same here. Forces are exact gradients of the sums (a piece is pushed by a d along the other body's gradient), so no energy is won or lost however
// coarse the pieces: what is off, by the spacing of pieces, is how stiff a contact is from place to place.
//
// Any number of places where two bodies touch make one contact: a force on a line and a couple. Friction and dashpots take them for one area, whose moments are those of all.

#include "contact/sampled_touch.h"

#include "contact/facet.h"
#include "contact/overlap_laws.h"
#include "shape/builtin.h"
#include "shape/surface_sample.h"

#include <string.h>

static const double point_like = 1e-10; ///< of the size squared: moments of no area
static const double flat_places = 0.05; ///< share of the surface that makes a shape one with flat places

// ---- which pairs ----------------------------------------------------------------------------------------------------------------------------------------

static bool is_concave(const pls_shape *s) { return !s->convex && s->sample; }
static bool is_ball(const pls_shape *s) { return s->polytope && s->polytope->vertex_count == 1; }
static bool is_flat_by_values(const pls_shape *s) { return s->convex && !s->ops->support && s->sample && s->sample->flat > flat_places; }

static bool has_flat_places(const pls_shape *s)
{
    return s->ops->unbounded || s->polytope || s->ops == &pls_cylinder_shape || is_flat_by_values(s);
}

bool pls_is_sampled_pair(const pls_shape *a, const pls_shape *b)
{
    if (is_ball(a) || is_ball(b)) return false;
    if (is_concave(a) || is_concave(b)) return true;
    return (is_flat_by_values(a) || is_flat_by_values(b)) && has_flat_places(a) && has_flat_places(b);
}

// ---- sums -----------------------------------------------------------------------------------------------------------------------------------------------

typedef struct sums
{
    pls_overlap_integrals P;
    double deepest, nearest; ///< of all pieces; a bound of the distance
} sums;

/// The body that pieces may lie in, by its SDF in its own frame, or the prism behind a facet, about the origin of the sums.
typedef struct holder
{
    const pls_posed *body;
    pls_prism prism; ///< of no planes: by the SDF
} holder;

/// Takes points of a shape's frame to another one.
typedef struct frame
{
    pls_vec3 start, x, y, z;
} frame;

static inline pls_vec3 placed(const frame *f, pls_vec3 X)
{
    return pls_add(f->start, pls_add(pls_add(pls_scale(f->x, X.x), pls_scale(f->y, X.y)), pls_scale(f->z, X.z)));
}

static frame about_origin(const pls_posed *own, pls_vec3 origin)
{
    return (frame){pls_sub(own->position, origin), pls_scale(own->x, own->scale), pls_scale(own->y, own->scale),
                   pls_scale(own->z, own->scale)};
}

/// From the frame of a shape to that which the holder works in.
static frame to_holder(const holder *h, const pls_posed *own, pls_vec3 origin)
{
    if (h->prism.planes > 0) return about_origin(own, origin);
    const double ratio = own->scale / h->body->scale;
    return (frame){pls_posed_own(h->body, own->position), pls_scale(pls_posed_turn_back(h->body, own->x), ratio),
                   pls_scale(pls_posed_turn_back(h->body, own->y), ratio), pls_scale(pls_posed_turn_back(h->body, own->z), ratio)};
}

/// The least of the depths below planes first .. last of a prism, and which it is.
static inline double least_depth(const pls_prism *p, int first, int last, pls_vec3 X, int *which)
{
    double least = INFINITY;
    for (int k = first; k < last; ++k)
    {
        const double d = p->plane[k].offset - pls_dot(p->plane[k].normal, X);
        if (d < least) least = d, *which = k;
    }
    return least;
}

/// Signed distance [m]; of prisms that from the furthest of their planes.
static inline double distance_to(const holder *h, pls_vec3 X)
{
    int which;
    if (h->prism.planes == 0) return pls_shape_sdf(h->body->shape, X) * h->body->scale;
    return -least_depth(&h->prism, 0, h->prism.planes, X, &which);
}

/// Depth below the surface [m], of a prism below its faces; not positive outside.
static inline double depth_in(const holder *h, pls_vec3 X)
{
    int which;
    const double d = distance_to(h, X);
    return d >= 0.0 || h->prism.planes == 0 ? -d : least_depth(&h->prism, 0, h->prism.faces, X, &which);
}

/// Gradient of the distance, in the world.
static pls_vec3 gradient_in(const holder *h, pls_vec3 X)
{
    int which = 0;
    if (h->prism.planes == 0) return pls_posed_turn(h->body, pls_shape_gradient(h->body->shape, X));
    least_depth(&h->prism, 0, h->prism.faces, X, &which);
    return h->prism.plane[which].normal;
}

static void add_push(pls_push *p, double energy, pls_vec3 x, pls_vec3 force)
{
    p->energy += energy;
    p->force = pls_add(p->force, force);
    p->torque = pls_add(p->torque, pls_cross(x, force));
}

/// A piece at x with outward normal n of depth d; `up` the outward gradient of the body it lies in. `sign`: 1 for pieces of A, -1 of B.
static void add_piece(sums *s, pls_vec3 x, pls_vec3 n, double area, double d, pls_vec3 up, double sign)
{
    pls_overlap_integrals *P = &s->P;
    add_push(&P->by_depth, 0.5 * area * d * d, x, pls_scale(up, -sign * area * d));
    add_push(&P->by_its_square, area * d * d * d / 3.0, x, pls_scale(up, -sign * area * d * d));
    const double share = area * d;
    P->surface += area, P->volume += share;
    P->first = pls_add(P->first, pls_scale(x, share));
    const double second[6] = {x.x * x.x, x.y * x.y, x.z * x.z, x.x * x.y, x.x * x.z, x.y * x.z};
    for (int k = 0; k < 6; ++k) P->second[k] += share * second[k];
    const pls_vec3 face = pls_scale(n, sign * area);
    P->area = pls_add(P->area, face);
    P->area_moment = pls_add(P->area_moment, pls_cross(x, face));
    s->deepest = fmax(s->deepest, d);
}

/// Pieces of `own` in what `h` holds.
static void add_pieces(sums *s, const pls_posed *own, const holder *h, pls_vec3 origin, double share, double sign)
{
    const pls_surface_sample *sample = own->shape->sample;
    const double to_length = own->scale, to_area = share * (own->shape->dimension == 2 ? own->scale : own->scale * own->scale);
    const frame inside = to_holder(h, own, origin), world = about_origin(own, origin);
    for (uint32_t b = 0; b < sample->balls;)
    {
        const pls_surface_ball *ball = &sample->ball[b];
        const double gap = distance_to(h, placed(&inside, ball->centre)) - ball->radius * to_length;
        if (gap > 0.0 && gap < s->nearest) s->nearest = gap;
        b = gap > 0.0 ? ball->next : b + 1;
        if (gap > 0.0 || !ball->leaf) continue;
        for (uint32_t k = ball->first; k < ball->last; ++k)
        {
            const pls_surface_piece *p = &sample->piece[k];
            const pls_vec3 X = placed(&inside, p->x);
            const double d = depth_in(h, X);
            if (d > 0.0)
                add_piece(s, placed(&world, p->x), pls_posed_turn(own, p->n), p->area * to_area, d, gradient_in(h, X), sign);
            else if (-d < s->nearest)
                s->nearest = -d;
        }
    }
}

// ---- the call -------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 origin_of(const pls_posed *a) { return pls_posed_world(a, a->shape->mass.centre); }

void pls_sampled_area(double size, pls_touch *t)
{
    // One piece is a point; what its moments differ by from none are rounding errors.
    const double all = t->spread[0] + t->spread[1] + t->spread[2];
    if (!(all > point_like * size * size)) memset(t->spread, 0, sizeof t->spread), t->lever = 0.0;
}

void pls_sampled_touch(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_touch *out)
{
    sums s = {.deepest = 0.0, .nearest = INFINITY};
    const pls_vec3 origin = origin_of(a);
    const bool both = a->shape->sample && b->shape->sample;
    if (a->shape->sample)
    {
        const holder h = {.body = b};
        add_pieces(&s, a, &h, origin, both ? 0.5 : 1.0, 1.0);
    }
    if (b->shape->sample)
    {
        const holder h = {.body = a};
        add_pieces(&s, b, &h, origin, both ? 0.5 : 1.0, -1.0);
    }
    const double blur = PLS_OVERLAP_BLUR * a->size;
    const pls_depth none = {.delta = -fmin(s.nearest, a->size), .normal = pls_vec(0.0, 0.0, 1.0), .on_a = origin, .on_b = origin};
    if (s.deepest > 0.0 && pls_overlap_touch(&s.P, options, blur, a->shape->dimension == 2, out))
    {
        out->point = pls_add(origin, out->point), out->middle = pls_add(origin, out->middle);
        pls_sampled_area(a->size, out);
    }
    else
        pls_overlap_none(&none, out);
    out->depth = out->reach = s.deepest > 0.0 ? s.deepest : none.delta;
}

double pls_sampled_behind(const pls_posed *a, const pls_posed *facet, const pls_prism *prism, pls_vec3 origin, pls_overlap_integrals *P)
{
    sums s = {.deepest = 0.0, .nearest = INFINITY};
    const holder h = {facet, *prism};
    add_pieces(&s, a, &h, origin, 1.0, 1.0);
    *P = s.P;
    return s.deepest;
}
