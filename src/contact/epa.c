// epa.c -- depth of two overlapping convex sets by a polytope that grows inside their Minkowski difference M.
//
// Van den Bergen, "Proximity queries and penetration depth computation on 3D game objects", Game Developers Conference 2001. The face whose
// plane is nearest to the origin is pushed outwards by the support point along its normal until it cannot be. Distances of planes are signed, so
// that the first polytope need not hold the origin. Planes are lower bounds of the depth, F along their normals are upper bounds: the least upper
// bound is kept, and is what a polytope that has lost its shape to rounding falls back on.

#include "contact/convex.h"

#include <float.h>
#include <stdint.h>

enum { MOST_POINTS = 192, MOST_FACES = 2 * MOST_POINTS, MOST_EDGES = 3 * MOST_FACES };

typedef struct face
{
    pls_vec3 n; ///< outward, unit
    double d;   ///< of the plane from the origin, signed [m]
    uint16_t at[3];
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
    f->n = pls_vec(0.0, 0.0, 0.0), f->d = DBL_MAX;
    if (!(length > least)) return true;
    f->n = pls_scale(n, 1.0 / length);
    f->d = pls_dot(f->n, p);
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

/// An edge seen from both its sides is gone; from one: horizon.
static void toggle_edge(uint16_t (*edge)[2], int *count, uint16_t i, uint16_t j)
{
    for (int k = 0; k < *count; ++k)
        if (edge[k][0] == j && edge[k][1] == i)
        {
            --*count;
            edge[k][0] = edge[*count][0], edge[k][1] = edge[*count][1];
            return;
        }
    edge[*count][0] = i, edge[*count][1] = j;
    ++*count;
}

/// Put the point into the polytope in place of the faces it sees. False: no room, or it sees none.
static bool grow(hull *h, pls_support_pair p, int chosen)
{
    static const double least = 1e-14;
    uint16_t edge[MOST_EDGES][2];
    int edges = 0;
    if (h->points == MOST_POINTS) return false;
    int number = h->points++;
    h->point[number] = p;
    for (int k = h->face_count; k-- > 0;)
    {
        face *f = &h->faces[k];
        if (k != chosen && !(pls_dot(f->n, p.w) - f->d > least * h->scale)) continue;
        if (h->a->dimension == 2)
            toggle_edge(edge, &edges, f->at[0], f->at[0]), edge[edges - 1][1] = f->at[1];
        else
            for (int c = 0; c < 3; ++c) toggle_edge(edge, &edges, f->at[c], f->at[(c + 1) % 3]);
        h->faces[k] = h->faces[--h->face_count];
    }
    if (h->a->dimension == 2)
    {
        // Of a chain of edges seen only its ends stay: the start that is no edge's end, and the end that is no edge's start.
        for (int k = 0; k < edges; ++k)
        {
            bool starts = true, ends = true;
            for (int m = 0; m < edges; ++m)
            {
                if (edge[m][1] == edge[k][0]) starts = false;
                if (edge[m][0] == edge[k][1]) ends = false;
            }
            if (starts && !add_face(h, edge[k][0], number, number)) return false;
            if (ends && !add_face(h, number, edge[k][1], edge[k][1])) return false;
        }
        return edges > 0;
    }
    for (int k = 0; k < edges; ++k)
        if (!add_face(h, edge[k][0], edge[k][1], number)) return false;
    return edges > 0;
}

static int nearest_face(const hull *h)
{
    int best = -1;
    for (int k = 0; k < h->face_count; ++k)
        if (h->faces[k].d < DBL_MAX && (best < 0 || h->faces[k].d < h->faces[best].d)) best = k;
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

pls_depth pls_epa(const pls_convex *a, const pls_convex *b, double tolerance, pls_simplex *s)
{
    hull h;
    h.a = a, h.b = b, h.scale = a->size + b->size;
    h.points = h.face_count = h.support_calls = 0;
    h.best = DBL_MAX, h.best_normal = pls_vec(1.0, 0.0, 0.0);
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
        if (!grow(&h, p, chosen)) break;
    }
    if (h.best < out.delta || !out.converged) out.normal = h.best_normal, out.delta = h.best;
    s->count = 1, s->point[0] = p, s->weight[0] = 1.0;
    pick_witness(&h, out.normal, out.delta, s);
    out.support_calls = h.support_calls;
    return out;
}
