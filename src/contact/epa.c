// epa.c -- depth of two overlapping convex sets by a polytope that grows inside their Minkowski difference M.
//
// Van den Bergen, "Proximity queries and penetration depth computation on 3D game objects", Game Developers Conference 2001. The face whose
// plane is nearest to the origin is pushed outwards by the support point along its normal until it cannot be. Distances of planes are signed, so
// that the first polytope need not hold the origin. Planes are lower bounds of the depth, F along their normals are upper bounds: the least upper
// bound is kept, and is what a polytope that has lost its shape to rounding falls back on.

#include "contact/convex.h"
#include "contact/horizon.h"

#include <float.h>
#include <stdint.h>

static const double rounding = 5e-17; // of coordinates, by the sizes

enum { MOST_POINTS = 400, MOST_FACES = 2 * MOST_POINTS };

typedef struct face
{
    pls_vec3 n; ///< outward, unit
    double d;   ///< of the plane from the origin, signed [m]
    uint16_t at[3];
    bool closed; ///< not to be looked behind
} face;

/// The growing polytope; in 2D `face` holds edges of two points.
typedef struct hull
{
    const pls_convex *a, *b;
    double scale;
    pls_support_pair point[MOST_POINTS];
    face faces[MOST_FACES];
    int points, face_count;
    int support_calls;
    double best; ///< least F so far
    pls_vec3 best_normal;
} hull;

/// Support point along n; remembers the least F.
static pls_support_pair ask(hull *h, pls_vec3 n)
{
    pls_support_pair p = pls_support_of(h->a, h->b, pls_vec(0.0, 0.0, 0.0), n);
    double F = pls_dot(p.w, n);
    ++h->support_calls;
    if (F < h->best) h->best = F, h->best_normal = n;
    return p;
}

static pls_vec3 any_orthogonal(pls_vec3 d)
{
    double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    pls_vec3 e = x <= y && x <= z ? pls_vec(1.0, 0.0, 0.0) : y <= z ? pls_vec(0.0, 1.0, 0.0) : pls_vec(0.0, 0.0, 1.0);
    return pls_unit(pls_cross(d, e));
}

/// How far p is from the point, line or plane through what `h` has.
static double independence(const hull *h, pls_vec3 w)
{
    pls_vec3 d = pls_sub(w, h->point[0].w);
    if (h->points == 1) return pls_length(d);
    pls_vec3 e = pls_unit(pls_sub(h->point[1].w, h->point[0].w));
    if (h->points == 2) return pls_length(pls_cross(d, e));
    return fabs(pls_dot(d, pls_unit(pls_cross(e, pls_sub(h->point[2].w, h->point[0].w)))));
}

/// Add the first of the pairs that makes one dimension more; `n` are directions to ask in, both ways.
static bool extend(hull *h, const pls_vec3 *n, int count)
{
    pls_support_pair best = {.stored = -1};
    double furthest = 1e-12 * h->scale;
    for (int k = 0; k < 2 * count; ++k)
    {
        pls_support_pair p = ask(h, pls_scale(n[k / 2], k % 2 ? -1.0 : 1.0));
        double far = independence(h, p.w);
        if (far > furthest) furthest = far, best = p;
    }
    if (furthest <= 1e-12 * h->scale) return false;
    h->point[h->points++] = best;
    return true;
}

/// Independent points of GJK's simplex, then more until there is a volume. False: M is flat, and F of the last direction asked is zero.
static bool first_points(hull *h, const pls_simplex *s)
{
    int dimension = h->a->dimension;
    const pls_vec3 axes[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    for (int k = 0; k < s->count && h->points <= dimension; ++k)
        if (h->points == 0 || independence(h, s->point[k].w) > 1e-6 * h->scale) h->point[h->points++] = s->point[k];
    if (h->points == 0) h->point[h->points++] = ask(h, axes[0]);
    if (h->points == 1 && !extend(h, axes, dimension)) return false;
    if (h->points == 2)
    {
        pls_vec3 along = pls_unit(pls_sub(h->point[1].w, h->point[0].w)), n[2];
        n[0] = dimension == 2 ? pls_vec(-along.y, along.x, 0.0) : any_orthogonal(along);
        n[1] = pls_cross(along, n[0]);
        if (!extend(h, n, dimension - 1)) return false;
    }
    if (h->points == 3 && dimension == 3)
    {
        pls_vec3 n = pls_unit(pls_cross(pls_sub(h->point[1].w, h->point[0].w), pls_sub(h->point[2].w, h->point[0].w)));
        if (!extend(h, &n, 1)) return false;
    }
    return true;
}

/// False: no room. Faces without area get no normal, and are never chosen nor seen.
static bool add_face(hull *h, int i, int j, int k)
{
    if (h->face_count == MOST_FACES) return false;
    face *f = &h->faces[h->face_count++];
    f->at[0] = (uint16_t)i, f->at[1] = (uint16_t)j, f->at[2] = (uint16_t)k;
    pls_vec3 p = h->point[i].w, u = pls_sub(h->point[j].w, p), v = pls_sub(h->point[k].w, p);
    pls_vec3 n = h->a->dimension == 2 ? pls_vec(u.y, -u.x, 0.0) : pls_cross(u, v);
    double length = pls_length(n), least = h->a->dimension == 2 ? 1e-15 * h->scale : 1e-14 * pls_length(u) * pls_length(v);
    f->n = pls_vec(0.0, 0.0, 0.0), f->d = DBL_MAX, f->closed = true;
    if (!(length > least)) return true;
    f->n = pls_scale(n, 1.0 / length);
    f->d = pls_dot(f->n, p), f->closed = false;
    return true;
}

/// Triangle or tetrahedron, outsides out.
static void first_faces(hull *h)
{
    pls_vec3 p = h->point[0].w, u = pls_sub(h->point[1].w, p), v = pls_sub(h->point[2].w, p);
    bool plane = h->a->dimension == 2;
    double side = plane ? u.x * v.y - u.y * v.x : -pls_dot(pls_cross(u, v), pls_sub(h->point[3].w, p));
    if (side < 0.0)
    {
        pls_support_pair swap = h->point[1];
        h->point[1] = h->point[2], h->point[2] = swap;
    }
    if (plane)
    {
        for (int k = 0; k < 3; ++k) add_face(h, k, (k + 1) % 3, (k + 1) % 3);
        return;
    }
    add_face(h, 0, 1, 2), add_face(h, 0, 3, 1), add_face(h, 1, 3, 2), add_face(h, 2, 3, 0);
}

static bool are_neighbours(const face *f, const face *g)
{
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (f->at[i] == g->at[(j + 1) % 3] && f->at[(i + 1) % 3] == g->at[j]) return true;
    return false;
}

/// Faces that see p, of those that hang together with `chosen`, which is one. A point that only grazes more faces sees them too if `least` is negative.
static int find_visible(const hull *h, pls_vec3 p, int chosen, double least, bool *visible)
{
    int list[MOST_FACES], count = 0;
    for (int k = 0; k < h->face_count; ++k) visible[k] = false;
    list[count++] = chosen, visible[chosen] = true;
    for (int at = 0; at < count; ++at)
        for (int k = 0; k < h->face_count; ++k)
            if (!visible[k] && pls_dot(h->faces[k].n, p) - h->faces[k].d > least * h->scale &&
                are_neighbours(&h->faces[list[at]], &h->faces[k]))
                list[count++] = k, visible[k] = true;
    return count;
}

/// Put the point into the polytope in place of the faces it sees. False: no room, or the polytope has lost its shape to rounding.
static bool grow(hull *h, pls_support_pair p, int chosen)
{
    static const double least[3] = {1e-14, -1e-13,
                                    1e-11}; // which faces in a plane with the point are seen: some choice leaves one closed line
    bool visible[MOST_FACES];
    pls_horizon edges;
    if (h->points == MOST_POINTS) return false;
    uint16_t number = (uint16_t)h->points;
    for (int attempt = 0;; ++attempt)
    {
        if (attempt == 3) return false;
        find_visible(h, p.w, chosen, least[attempt], visible);
        edges.count = 0;
        for (int k = 0; k < h->face_count; ++k)
            for (int c = 0; visible[k] && c < 3; ++c) pls_horizon_add(&edges, h->faces[k].at[c], h->faces[k].at[(c + 1) % 3]);
        if (pls_horizon_is_loop(&edges)) break;
    }
    h->point[h->points++] = p;
    int kept = 0;
    for (int k = 0; k < h->face_count; ++k)
        if (!visible[k]) h->faces[kept++] = h->faces[k];
    h->face_count = kept;
    for (int k = 0; k < edges.count; ++k)
        if (!add_face(h, edges.from[k], edges.to[k], number)) return false;
    return true;
}

/// In the plane: of the chain of edges that see the point only the ends stay.
static bool grow_in_plane(hull *h, pls_support_pair p, int chosen)
{
    if (h->points == MOST_POINTS) return false;
    int number = h->points++, first = h->faces[chosen].at[0], last = h->faces[chosen].at[1];
    h->point[number] = p;
    h->faces[chosen] = h->faces[--h->face_count];
    for (bool more = true; more;)
    {
        more = false;
        for (int k = 0; k < h->face_count && !more; ++k)
        {
            const face *f = &h->faces[k];
            if (f->at[1] != first && f->at[0] != last) continue;
            if (!(pls_dot(f->n, p.w) - f->d > 1e-14 * h->scale)) continue;
            if (f->at[1] == first)
                first = f->at[0];
            else
                last = f->at[1];
            h->faces[k] = h->faces[--h->face_count];
            more = true;
        }
    }
    return first != last && add_face(h, first, number, number) && add_face(h, number, last, last);
}

static bool put_in(hull *h, pls_support_pair p, int chosen)
{
    return h->a->dimension == 2 ? grow_in_plane(h, p, chosen) : grow(h, p, chosen);
}

static int nearest_face(const hull *h)
{
    int best = -1;
    for (int k = 0; k < h->face_count; ++k)
        if (!h->faces[k].closed && (best < 0 || h->faces[k].d < h->faces[best].d)) best = k;
    return best;
}

/// A face as simplex, weights of its point nearest to `foot`; gives how far that is.
static double weigh(const hull *h, const face *f, pls_vec3 foot, pls_simplex *s)
{
    bool inside;
    pls_simplex t = {.count = h->a->dimension};
    for (int k = 0; k < t.count; ++k) t.point[k] = h->point[f->at[k]], t.point[k].w = pls_sub(t.point[k].w, foot);
    double far = pls_length(pls_simplex_nearest(&t, 3, &inside));
    for (int k = 0; k < t.count; ++k) t.point[k].w = pls_sub(t.point[k].a, t.point[k].b);
    *s = t;
    return far;
}

/// Of several faces in the plane that was found the one under the origin.
static void pick_witness(const hull *h, pls_vec3 n, double d, pls_simplex *s)
{
    double least = DBL_MAX;
    pls_simplex t;
    for (int k = 0; k < h->face_count; ++k)
    {
        const face *f = &h->faces[k];
        if (f->d == DBL_MAX || f->d > d + 1e-9 * h->scale || pls_dot(f->n, n) < 1.0 - 1e-6) continue;
        double far = weigh(h, f, pls_scale(n, d), &t);
        if (far < least) least = far, *s = t;
        if (far <= 1e-14 * h->scale) return;
    }
}

/// M without volume: F is zero both ways along a normal of it, and any of its points near the origin are witnesses.
static pls_depth depth_of_flat(hull *h, pls_simplex *s)
{
    pls_vec3 n = pls_vec(1.0, 0.0, 0.0);
    if (h->points > 1)
    {
        pls_vec3 u = pls_unit(pls_sub(h->point[1].w, h->point[0].w));
        n = h->a->dimension == 2 ? pls_vec(-u.y, u.x, 0.0) : any_orthogonal(u);
        if (h->points > 2) n = pls_unit(pls_cross(u, pls_sub(h->point[2].w, h->point[0].w)));
    }
    pls_support_pair p = ask(h, n);
    if (s->count == 0 || s->count > 3) s->count = 1, s->point[0] = p, s->weight[0] = 1.0;
    return (pls_depth){.delta = pls_dot(p.w, n), .normal = n, .support_calls = h->support_calls, .converged = true};
}

static void start(hull *h, const pls_convex *a, const pls_convex *b)
{
    h->a = a, h->b = b, h->scale = a->size + b->size;
    h->points = h->face_count = h->support_calls = 0;
    h->best = DBL_MAX, h->best_normal = pls_vec(1.0, 0.0, 0.0);
}

pls_depth pls_epa(const pls_convex *a, const pls_convex *b, double tolerance, pls_simplex *s)
{
    hull h;
    start(&h, a, b);
    if (!first_points(&h, s)) return depth_of_flat(&h, s);
    first_faces(&h);
    pls_depth out = {.converged = false};
    pls_support_pair p = h.point[0];
    for (int chosen; (chosen = nearest_face(&h)) >= 0;)
    {
        face f = h.faces[chosen];
        ++out.iterations;
        p = ask(&h, f.n);
        out.normal = f.n, out.delta = pls_dot(p.w, f.n);
        if (out.delta - f.d <= tolerance)
        {
            out.converged = true;
            break;
        }
        if (!put_in(&h, p, chosen)) break;
    }
    if (h.best < out.delta || !out.converged) out.normal = h.best_normal, out.delta = h.best;
    // Of round sets the last digits may be left open when there is no more room.
    int nearest = nearest_face(&h);
    if (!(a->polytope && b->polytope) && nearest >= 0)
        out.converged = out.converged || out.delta - h.faces[nearest].d <= PLS_LEFT_OPEN * h.scale;
    s->count = 1, s->point[0] = p, s->weight[0] = 1.0;
    pick_witness(&h, out.normal, out.delta, s);
    out.support_calls = h.support_calls;
    return out;
}

/// How far inside the face the origin's foot on its plane lies, from the nearest side; negative: outside.
static double inside_by(const hull *h, const face *f)
{
    const int corners = h->a->dimension;
    const pls_vec3 foot = pls_scale(f->n, f->d);
    double least = DBL_MAX;
    for (int k = 0; k < corners; ++k)
    {
        const pls_vec3 p = h->point[f->at[k]].w, along = pls_unit(pls_sub(h->point[f->at[(k + 1) % corners]].w, p));
        least = fmin(least, pls_dot(corners == 2 ? along : pls_cross(f->n, along), pls_sub(foot, p)));
    }
    return least;
}

/// Error of a face's normal, by round-off of its corners [rad].
static double blur(const hull *h, const face *f)
{
    const pls_vec3 p = h->point[f->at[0]].w, q = h->point[f->at[1]].w, r = h->point[f->at[2]].w;
    const pls_vec3 u = pls_sub(q, p), v = pls_sub(r, p), w = pls_sub(r, q);
    const double longest = sqrt(fmax(fmax(pls_dot(u, u), pls_dot(v, v)), pls_dot(w, w)));
    const double height = h->a->dimension == 2 ? longest : pls_length(pls_cross(u, v)) / longest;
    return rounding * h->scale / height;
}

// The polytope bounds F from below. Where that bound, as a function of the direction, is locally least, it is by a face that the origin's foot lies in: all other faces lead to one of these.
// So the directions in which F may be less than at `known` lie about such faces, and about the known minimum itself. The one over that is closed as soon as the bound is no less all around, `cap` from
// its normal: within 2 cap of a local minimum F is at least delta cos(2 cap), as M holds its point delta n.
bool pls_epa_less(const pls_convex *a, const pls_convex *b, double tolerance, const pls_exact_depth *exact, pls_depth *known)
{
    const double cap = 5e-4; // [rad]
    const double enough = known->delta - tolerance;
    hull h;
    start(&h, a, b);
    pls_simplex none = {.count = 0};
    known->converged = known->local = false;
    if (!first_points(&h, &none)) return false;
    first_faces(&h);
    int chosen;
    while ((chosen = nearest_face(&h)) >= 0)
    {
        const face f = h.faces[chosen];
        if (f.d >= enough) break; // and all others
        const double error = blur(&h, &f), inside = inside_by(&h, &f);
        h.faces[chosen].closed = true;
        if (f.d > 0.0 && inside < -(error + DBL_EPSILON) * h.scale) continue;
        ++known->iterations;
        const pls_support_pair p = ask(&h, f.n);
        pls_depth there = {.delta = pls_dot(p.w, f.n), .normal = f.n};
        const double open = there.delta - f.d;
        const bool known_one = pls_length(pls_sub(f.n, known->normal)) <= cap;
        if (known_one && (open <= fmax(tolerance, error * h.scale) || f.d * cos(cap) + inside * sin(cap) >= enough)) continue;
        if (!known_one && there.delta >= enough && open <= error * h.scale) // too thin for a point to be put in
        {
            if (!exact || !exact->near(exact->self, f.n, &there)) known->local = true;
            if (there.delta >= enough) continue;
        }
        if (!known_one && there.delta < enough)
        {
            known->delta = there.delta, known->normal = there.normal;
            known->support_calls += h.support_calls;
            return true;
        }
        if (!put_in(&h, p, chosen)) break;
    }
    // When there is no more room: how much less it might be.
    double left = chosen < 0 ? 0.0 : known->delta - h.faces[chosen].d;
    known->converged = left <= PLS_LEFT_OPEN * h.scale;
    known->support_calls += h.support_calls;
    return false;
}
