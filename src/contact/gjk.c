// gjk.c -- distance of two convex sets: Gilbert, Johnson & Keerthi, IEEE J. Robotics Automation 4 (1988) 193.
//
// The nearest point of a simplex is found by signed volumes (Montanari, Petrinic & Barbieri, ACM Trans. Graphics 36 (2017) 30): down from the
// volume to the faces on whose outer side the origin lies, the nearest of which is taken. Simplices that are nearly flat are never said to hold the
// origin: a flat one that did would make a false overlap, as happens once in many trajectories of polytopes with parallel faces.

#include "contact/convex.h"

#include <float.h>

enum { MOST_ITERATIONS = 200 };
static const double flat = 1e-10;     // volume by edge^3, area by edge^2
static const double rounding = 1e-15; // error of distances of polytopes, by size
static const double smooth = 1e-12;   // of others, which are approached only

pls_support_pair pls_support_of(const pls_convex *a, const pls_convex *b, pls_vec3 shift, pls_vec3 n)
{
    pls_support_pair p = {.a = a->support(a->self, n), .b = b->support(b->self, pls_scale(n, -1.0)), .stored = -1};
    p.w = pls_sub(pls_sub(p.a, p.b), shift);
    return p;
}

/// Nearest point of a face of a simplex: which vertices, their weights, where.
typedef struct nearest
{
    int count;
    int index[3];
    double weight[3];
    pls_vec3 v;
} nearest;

static nearest nearer(nearest p, nearest q) { return pls_dot(q.v, q.v) < pls_dot(p.v, p.v) ? q : p; }

static nearest of_point(const pls_simplex *s, int i) { return (nearest){.count = 1, .index = {i}, .weight = {1.0}, .v = s->point[i].w}; }

static nearest of_segment(const pls_simplex *s, int i, int j)
{
    pls_vec3 p = s->point[i].w, q = s->point[j].w, d = pls_sub(q, p);
    double forward = -pls_dot(p, d), back = pls_dot(q, d); // both from the near end, so that neither weight is 1 less nearly 1
    if (!(forward > 0.0)) return of_point(s, i);
    if (!(back > 0.0)) return of_point(s, j);
    double t = forward / (forward + back), u = back / (forward + back);
    pls_vec3 v = t < u ? pls_add(p, pls_scale(d, t)) : pls_sub(q, pls_scale(d, u));
    return (nearest){.count = 2, .index = {i, j}, .weight = {u, t}, .v = v};
}

static double square_of_longest_edge(const pls_vec3 *p, int count)
{
    double longest = 0.0;
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < i; ++j)
        {
            pls_vec3 d = pls_sub(p[i], p[j]);
            longest = fmax(longest, pls_dot(d, d));
        }
    return longest;
}

static nearest of_triangle(const pls_simplex *s, int i, int j, int k)
{
    int at[3] = {i, j, k};
    pls_vec3 p[3] = {s->point[i].w, s->point[j].w, s->point[k].w};
    pls_vec3 n = pls_cross(pls_sub(p[1], p[0]), pls_sub(p[2], p[0]));
    double n2 = pls_dot(n, n), edge2 = square_of_longest_edge(p, 3);
    bool thin = !(n2 > flat * flat * edge2 * edge2);
    double weight[3] = {-1.0, -1.0, -1.0};
    pls_vec3 v = pls_vec(0.0, 0.0, 0.0);
    if (!thin)
    {
        v = pls_scale(n, pls_dot(n, p[0]) / n2);
        for (int c = 0; c < 3; ++c) // areas seen from the projection, not from the origin: exact also for small triangles
            weight[c] = pls_dot(n, pls_cross(pls_sub(p[(c + 1) % 3], v), pls_sub(p[(c + 2) % 3], v))) / n2;
        if (weight[0] >= 0.0 && weight[1] >= 0.0 && weight[2] >= 0.0)
        {
            double sum = weight[0] + weight[1] + weight[2];
            return (nearest){3, {i, j, k}, {weight[0] / sum, weight[1] / sum, weight[2] / sum}, v};
        }
    }
    nearest best = {.count = 0, .v = {DBL_MAX, 0.0, 0.0}};
    for (int c = 0; c < 3; ++c)
        if (!(weight[c] >= 0.0)) best = nearer(best, of_segment(s, at[(c + 1) % 3], at[(c + 2) % 3]));
    return best.count ? best : of_point(s, i);
}

/// The volume: does it hold the origin? If not, the nearest of the faces that have the origin on their outer side.
static nearest of_tetrahedron(const pls_simplex *s, bool *inside)
{
    static const int face[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}; // last: the opposite vertex
    pls_vec3 p[4] = {s->point[0].w, s->point[1].w, s->point[2].w, s->point[3].w};
    double volume = pls_dot(pls_sub(p[1], p[0]), pls_cross(pls_sub(p[2], p[0]), pls_sub(p[3], p[0])));
    double edge2 = square_of_longest_edge(p, 4);
    bool thin = !(fabs(volume) > flat * edge2 * sqrt(edge2));
    nearest best = {.count = 0, .v = {DBL_MAX, 0.0, 0.0}};
    for (int f = 0; f < 4; ++f)
    {
        const int *at = face[f];
        pls_vec3 n = pls_cross(pls_sub(p[at[1]], p[at[0]]), pls_sub(p[at[2]], p[at[0]]));
        double origin = -pls_dot(n, p[at[0]]), opposite = pls_dot(n, pls_sub(p[at[3]], p[at[0]]));
        if (thin || origin * opposite < 0.0) best = nearer(best, of_triangle(s, at[0], at[1], at[2]));
    }
    *inside = best.count == 0 && !thin;
    return best.count ? best : of_triangle(s, 0, 1, 2);
}

/// In the plane a triangle is the volume.
static nearest of_flat_triangle(const pls_simplex *s, bool *inside)
{
    nearest best = of_triangle(s, 0, 1, 2);
    *inside = best.count == 3;
    return best;
}

pls_vec3 pls_simplex_nearest(pls_simplex *s, int dimension, bool *inside)
{
    nearest best;
    *inside = false;
    if (s->count == 1)
        best = of_point(s, 0);
    else if (s->count == 2)
        best = of_segment(s, 0, 1);
    else if (s->count == 3)
        best = dimension == 2 ? of_flat_triangle(s, inside) : of_triangle(s, 0, 1, 2);
    else
        best = of_tetrahedron(s, inside);
    if (*inside) return pls_vec(0.0, 0.0, 0.0);
    pls_simplex old = *s;
    s->count = best.count;
    for (int k = 0; k < best.count; ++k) s->point[k] = old.point[best.index[k]], s->weight[k] = best.weight[k];
    return best.v;
}

static bool is_known(const pls_simplex *s, pls_vec3 w, double scale)
{
    for (int k = 0; k < s->count; ++k)
        if (pls_length(pls_sub(s->point[k].w, w)) <= 1e-14 * scale) return true;
    return false;
}

static void start(const pls_convex *a, const pls_convex *b, pls_vec3 shift, pls_simplex *s, pls_gap *gap)
{
    for (int k = 0; k < s->count; ++k) s->point[k].w = pls_sub(pls_sub(s->point[k].a, s->point[k].b), shift);
    if (s->count > 0) return;
    pls_vec3 n = pls_sub(pls_add(b->centre, shift), a->centre);
    if (!(pls_dot(n, n) > 0.0)) n = pls_vec(1.0, 0.0, 0.0);
    s->point[0] = pls_support_of(a, b, shift, n);
    s->count = 1;
    ++gap->support_calls;
}

pls_gap pls_gjk(const pls_convex *a, const pls_convex *b, pls_vec3 shift, pls_simplex *s)
{
    pls_gap gap = {.distance = DBL_MAX};
    double scale = a->size + b->size, tolerance = (a->polytope && b->polytope ? rounding : smooth) * scale;
    pls_simplex last;
    start(a, b, shift, s, &gap);
    last = *s;
    while (gap.iterations < MOST_ITERATIONS)
    {
        ++gap.iterations;
        bool inside;
        pls_vec3 v = pls_simplex_nearest(s, a->dimension, &inside);
        double distance = pls_length(v);
        if (inside || distance <= PLS_TOUCHING * scale)
        {
            gap.overlap = gap.converged = true;
            gap.v = v, gap.distance = 0.0;
            return gap;
        }
        if (!(distance < gap.distance)) // no nearer: as good as rounding allows
        {
            *s = last;
            gap.converged = distance <= gap.distance * (1.0 + 1e-9);
            return gap;
        }
        gap.v = v, gap.distance = distance, last = *s;
        pls_support_pair p = pls_support_of(a, b, shift, pls_scale(v, -1.0 / distance));
        ++gap.support_calls;
        // M lies beyond the plane through p.w: no point of it is nearer than that.
        gap.open = distance - pls_dot(v, p.w) / distance;
        if (gap.open <= tolerance || is_known(s, p.w, scale))
        {
            gap.converged = true;
            return gap;
        }
        s->point[s->count++] = p;
    }
    *s = last;
    return gap;
}
