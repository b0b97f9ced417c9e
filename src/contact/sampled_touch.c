// sampled_touch.c -- overlaps as sums over pieces of surfaces (surface_sample.h), each as deep as the other body's SDF says.
//
// With d the depth of a piece of A in B, a its area, and the same the other way round,
//
//     W = 1/2 [ sum over A of a d_B^2 / 2 + sum over B of a d_A^2 / 2 ],       Q likewise with d^3 / 3,
//
// for half-spaces, and for walls of pieces where A is convex, the sums over A alone, whole. For parallel faces these are the integrals of t^2/2 and t^3/3 over the area of touch, t its local overlap, which the laws of faces.c are
// about, and so the laws are the same here. Forces are exact gradients of the sums (a piece is pushed by a d along the other body's gradient), so no energy is won or lost however
// coarse the pieces: what is off is how stiff a contact is from place to place.
//
// In walls the depth of a piece is that of its point. In bodies it is that of its inner ball (surface_sample.h), of radius s about c: d = s - phi(c). For parallel faces both are the same. But
//
// * below an edge the gradient of the depth of points jumps from one face's to the next one's, and the force with it, for each piece that passes: an error of the first order in the step,
//   which few pieces do not average out (1e-4 of the energy of a collision of 800 steps). Centres of balls are outside, where phi is the distance and has a smooth gradient;
// * a corner that comes down between the points of a face meets none of them until it is as deep as they are apart. With balls all pieces within sqrt(2 s d) know of it, from a depth of
//   h^2 / 8 s on, at a spacing h: smoother, and evener.
//
// Beside an edge of B pieces of A count as far out, too: a rim that for small overlaps is small.
// Balls whose centres come below the surface fade before they do, if they are small: near edges, where there are larger ones beside. The largest ones hold for good, others by the square of their
// part of these, so that something pushes back at any depth.
//
// Superquadrics with flat ends or sides, whose distance takes microseconds, are asked by a field of it (distance_field.h): its gradient is that of its values, so all of this holds.
//
// Walls of triangles or segments have no inside, and a body that is not convex may be on both sides of one at once: a ring on the rim of a sheet. There the pieces are those of the wall, cut in
// a way that does not depend on where the body is, and d is their depth in the body, d = -phi (of walls thickened by r, r - phi): no side to be known, nor any edge or rim to go round.
//
// Any number of places where two bodies touch make one contact: a force on a line and a couple. Friction and dashpots take them for one area, whose moments are those of all.

#include "contact/sampled_touch.h"

#include "contact/facet.h"
#include "contact/overlap_laws.h"
#include "shape/builtin.h"
#include "shape/distance_field.h"
#include "shape/surface_sample.h"

#include <string.h>

static const double point_like = 1e-10; ///< of the size squared: moments of no area
static const double flat_places = 0.05; ///< share of the surface that makes a shape one with flat places
static const double box_like = 0.5;     ///< lesser exponent of a superquadric below which it has flat places
static const double thinnest_box = 4.0; ///< longest by shortest half axis of these
static const double sheet_cell = 2.0;   ///< longest edge of pieces of walls, of the spacing of the body's own: about as large

// ---- which pairs ----------------------------------------------------------------------------------------------------------------------------------------

static bool is_concave(const pls_shape *s) { return !s->convex && s->sample; }
static bool is_ball(const pls_shape *s) { return s->polytope && s->polytope->vertex_count == 1; }
static bool is_flat_by_values(const pls_shape *s) { return s->convex && !s->ops->support && s->sample && s->sample->flat > flat_places; }

/// Of superquadrics those with flat ends or sides, if they are not so thin that a field of their distance would take too many values.
static bool is_box_like(const pls_shape *s)
{
    return s->ops == &pls_superquadric_shape && pls_superquadric_exponent(s) < box_like && pls_superquadric_aspect(s) < thinnest_box;
}

static bool is_cylinder(const pls_shape *s) { return s->ops == &pls_cylinder_shape; }

static bool goes_by_pieces(const pls_shape *s) { return is_flat_by_values(s) || is_box_like(s); }

static bool has_flat_places(const pls_shape *s) { return s->ops->unbounded || s->polytope || is_cylinder(s) || goes_by_pieces(s); }

bool pls_is_sampled_pair(const pls_shape *a, const pls_shape *b)
{
    if (is_ball(a) || is_ball(b)) return false;
    if (is_concave(a) || is_concave(b)) return true;
    if (is_cylinder(a) && is_cylinder(b)) return true; // ends on ends, sides on sides: no closed forms, but a quick SDF
    return (goes_by_pieces(a) || goes_by_pieces(b)) && has_flat_places(a) && has_flat_places(b);
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
    if (h->prism.planes == 0)
    {
        const pls_shape *s = h->body->shape;
        return (s->field ? pls_distance_field_at(s->field, X, NULL) : pls_shape_sdf(s, X)) * h->body->scale;
    }
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
    if (h->prism.planes == 0)
    {
        const pls_shape *s = h->body->shape;
        pls_vec3 g;
        if (s->field)
            pls_distance_field_at(s->field, X, &g);
        else
            g = pls_shape_gradient(s, X);
        return pls_posed_turn(h->body, g);
    }
    least_depth(&h->prism, 0, h->prism.faces, X, &which);
    return h->prism.plane[which].normal;
}

static void add_push(pls_push *p, double energy, pls_vec3 x, pls_vec3 force)
{
    p->energy += energy;
    p->force = pls_add(p->force, force);
    p->torque = pls_add(p->torque, pls_cross(x, force));
}

/// Integrals over d of what a piece weighs, by its area.
typedef struct weights
{
    double by_depth, by_its_square; ///< d and d^2
    double W, Q;                    ///< their integrals
} weights;

static weights plain_weights(double d) { return (weights){d, d * d, 0.5 * d * d, d * d * d / 3.0}; }

/// Of a ball of radius r that is d deep: from half of r to all of it, where its centre is below the surface, they fade to the part that holds. With x = 2 d/r - 1 what has faded
/// is x^2 (3 - 2 x), and its integrals over d are those of polynomials.
static weights fading_weights(double d, double r, double holds)
{
    weights w = plain_weights(d);
    const double half = 0.5 * r, beyond = d - half;
    if (!(beyond > 0.0)) return w;
    const double x = fmin(beyond / half, 1.0), square = x * x, cube = square * x, fades = 1.0 - holds,
                 faded = fades * square * (3.0 - 2.0 * x);
    // Integrals of f, f x and f x^2 over x from 0, f = 3 x^2 - 2 x^3; from x = 1 on f is 1.
    const double f0 = cube - 0.5 * cube * x, f1 = cube * x * (0.75 - 0.4 * x), f2 = cube * square * (0.6 - x / 3.0);
    const double end = fmin(d, r), W = half * half * (f0 + f1), Q = half * half * half * (f0 + 2.0 * f1 + f2);
    w.W -= fades * (W + 0.5 * (d * d - end * end)), w.Q -= fades * (Q + (d * d * d - end * end * end) / 3.0);
    w.by_depth *= 1.0 - faded, w.by_its_square *= 1.0 - faded;
    return w;
}

/// A piece at x with outward normal n of depth d, which is pushed at `at`; `up` the outward gradient of the body it lies in.
typedef struct touching_piece
{
    pls_vec3 x, n, at, up;
    double area, d;
    weights w;
} touching_piece;

/// `sign`: 1 for pieces of A, -1 of B.
static void add_piece(sums *s, const touching_piece *f, double sign)
{
    pls_overlap_integrals *P = &s->P;
    const pls_vec3 x = f->x, push = pls_scale(f->up, -sign * f->area);
    add_push(&P->by_depth, f->area * f->w.W, f->at, pls_scale(push, f->w.by_depth));
    add_push(&P->by_its_square, f->area * f->w.Q, f->at, pls_scale(push, f->w.by_its_square));
    const double share = f->area * f->w.by_depth;
    P->surface += f->area, P->volume += share;
    P->first = pls_add(P->first, pls_scale(x, share));
    const double second[6] = {x.x * x.x, x.y * x.y, x.z * x.z, x.x * x.y, x.x * x.z, x.y * x.z};
    for (int k = 0; k < 6; ++k) P->second[k] += share * second[k];
    P->area = pls_add(P->area, pls_scale(f->n, sign * f->area));
    P->area_moment = pls_add(P->area_moment, pls_scale(x, f->area)); // pieces face many ways: their middle is that of their places
    s->deepest = fmax(s->deepest, f->d);
}

/// Pieces of `own` in what `h` holds.
static void add_pieces(sums *s, const pls_posed *own, const holder *h, pls_vec3 origin, double share, double sign)
{
    const pls_surface_sample *sample = own->shape->sample;
    const double to_length = own->scale, to_area = share * (own->shape->dimension == 2 ? own->scale : own->scale * own->scale);
    const bool front = h->prism.planes > 0 || h->body->shape->ops->unbounded;
    const pls_distance_field *field = front ? NULL : h->body->shape->field;
    const double slope = field ? PLS_FIELD_SLOPE : 1.0, most = field ? pls_distance_field_reach(field) * h->body->scale : INFINITY;
    const double largest = fmin(sample->largest_inner * to_length, most);
    const frame inside = to_holder(h, own, origin), world = about_origin(own, origin);
    for (uint32_t b = 0; b < sample->balls;)
    {
        const pls_surface_ball *ball = &sample->ball[b];
        const double gap = distance_to(h, placed(&inside, ball->centre)) - slope * ball->radius * to_length;
        if (gap > 0.0 && gap < s->nearest) s->nearest = gap;
        b = gap > 0.0 ? ball->next : b + 1;
        if (gap > 0.0 || !ball->leaf) continue;
        for (uint32_t k = ball->first; k < ball->last; ++k)
        {
            const pls_surface_piece *p = &sample->piece[k];
            const double whole = p->inner_radius * to_length, radius = front ? 0.0 : fmin(whole, most);
            // Where fields end balls are smaller.
            const pls_vec3 own_at = front             ? p->x
                                    : radius == whole ? p->inner
                                                      : pls_add(p->x, pls_scale(pls_sub(p->inner, p->x), radius / whole));
            const pls_vec3 X = placed(&inside, own_at);
            const double d = depth_in(h, X) + radius;
            if (d > 0.0 && (front || radius > 0.0))
            {
                const double part = radius / largest;
                const touching_piece f = {.x = placed(&world, p->x),
                                          .n = pls_posed_turn(own, p->n),
                                          .at = placed(&world, own_at),
                                          .up = gradient_in(h, X),
                                          .area = p->area * to_area,
                                          .d = d,
                                          .w = front ? plain_weights(d) : fading_weights(d, radius, part * part)};
                add_piece(s, &f, sign);
            }
            else if (-d < s->nearest && d < 0.0)
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
    if (all > point_like * size * size) return;
    memset(t->spread, 0, sizeof t->spread);
    t->lever = 0.0, t->middle = t->point;
}

void pls_sampled_touch(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_touch *out)
{
    sums s = {.P = {.scattered = true}, .deepest = 0.0, .nearest = INFINITY};
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
        pls_sampled_area(a->size, out);
        out->point = pls_add(origin, out->point), out->middle = pls_add(origin, out->middle);
    }
    else
        pls_overlap_none(&none, out);
    out->depth = out->reach = s.deepest > 0.0 ? s.deepest : none.delta;
}

// ---- walls --------------------------------------------------------------------------------------------------------------------------------------------------

bool pls_is_sheet_pair(const pls_shape *a, const pls_shape *facet) { return is_concave(a) && pls_is_facet(facet); }

/// A facet in its own frame, the body it may lie in, and what it adds up to. Cells are halved in the frame of the facet, so that they are the same however the body lies.
typedef struct sheet
{
    sums s;
    const pls_posed *body, *facet;
    frame inside;            ///< from the facet's frame to the body's
    pls_vec3 origin, normal; ///< in the world
    double cell;             ///< longest edge of cells, in the facet's lengths
    double to_body;          ///< the body's lengths by the facet's
    double margin;           ///< of the wall, in the body's lengths
    bool flat;
} sheet;

/// The middle of a triangle or segment that is small enough counts for all of it. `X`: that in the body's frame; `d`: its depth there.
static void add_cell(sheet *h, pls_vec3 X, double size, double d)
{
    const pls_posed *own = h->body;
    const double length = h->facet->scale, depth = d * own->scale;
    const pls_vec3 x = pls_sub(pls_posed_world(own, X), h->origin), up = pls_posed_turn(own, pls_shape_gradient(own->shape, X));
    const touching_piece f = {.x = x,
                              .n = pls_scale(h->normal, pls_dot(h->normal, up) > 0.0 ? -1.0 : 1.0),
                              .at = x,
                              .up = up,
                              .area = size * (h->flat ? length : length * length),
                              .d = depth,
                              .w = plain_weights(depth)};
    add_piece(&h->s, &f, -1.0);
}

/// Halves triangles and segments at their longest edge until they are small, but for those that lie outside.
static void cut_facet(sheet *h, const pls_vec3 *v, int corners)
{
    const pls_shape *shape = h->body->shape;
    pls_vec3 middle = pls_vec(0.0, 0.0, 0.0);
    double radius = 0.0, longest = -1.0;
    int edge = 0;
    for (int k = 0; k < corners; ++k) middle = pls_add(middle, pls_scale(v[k], 1.0 / corners));
    for (int k = 0; k < corners; ++k)
    {
        const double length = pls_length(pls_sub(v[(k + 1) % corners], v[k]));
        radius = fmax(radius, pls_length(pls_sub(v[k], middle)));
        if (length > longest) longest = length, edge = k;
    }
    const pls_vec3 X = placed(&h->inside, middle);
    const double own_radius = radius * h->to_body;
    if (pls_length(pls_sub(X, shape->mass.centre)) > shape->radius + own_radius + h->margin) return;
    const double d = h->margin - pls_shape_sdf(shape, X);
    if (d < -own_radius) return;
    if (longest <= h->cell)
    {
        const double size = corners == 2 ? longest : 0.5 * pls_length(pls_cross(pls_sub(v[1], v[0]), pls_sub(v[2], v[0])));
        if (d > 0.0) add_cell(h, X, size, d);
        return;
    }
    const int end = (edge + 1) % corners;
    const pls_vec3 half = pls_scale(pls_add(v[edge], v[end]), 0.5);
    for (int side = 0; side < 2; ++side)
    {
        pls_vec3 part[3];
        for (int k = 0; k < corners; ++k) part[k] = v[k];
        part[side == 0 ? end : edge] = half;
        cut_facet(h, part, corners);
    }
}

double pls_sheet_deepest(const pls_posed *a)
{
    const pls_surface_sample *sample = a->shape->sample;
    // Inner balls are half as large as fit. No middle of a cell need come nearer to theirs than cells are apart.
    return fmax(2.0 * sample->largest_inner - sample->spacing, sample->largest_inner) * a->scale;
}

double pls_sheet_in(const pls_posed *a, const pls_posed *facet, pls_vec3 origin, pls_overlap_integrals *P)
{
    const int corners = facet->shape->dimension;
    const double to_body = facet->scale / a->scale;
    const holder body = {.body = a};
    sheet h = {.s = {.P = {.scattered = true}, .nearest = INFINITY},
               .body = a,
               .facet = facet,
               .inside = to_holder(&body, facet, origin),
               .origin = origin,
               .normal = pls_posed_turn(facet, pls_shape_facet(facet->shape)->normal),
               .cell = fmin(sheet_cell * a->shape->sample->spacing, 2.0 * a->shape->sample->largest_inner) /
                       to_body, // at most half as wide as it is thick

               .to_body = to_body,
               .margin = facet->shape->margin * to_body,
               .flat = corners == 2};
    cut_facet(&h, facet->shape->polytope->vertex, corners);
    *P = h.s.P;
    return h.s.deepest;
}

double pls_sampled_behind(const pls_posed *a, const pls_posed *facet, const pls_prism *prism, pls_vec3 origin, pls_overlap_integrals *P)
{
    sums s = {.P = {.scattered = true}, .deepest = 0.0, .nearest = INFINITY};
    const holder h = {facet, *prism};
    add_pieces(&s, a, &h, origin, 1.0, 1.0);
    *P = s.P;
    return s.deepest;
}
