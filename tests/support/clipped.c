// clipped.c -- cutting convex polytopes by planes, slowly.

#include "support/clipped.h"

#include <string.h>

static int vertex_of(int edge) { return edge >> 2; }

/// Edges that leave the same vertex.
static int clockwise(int edge) { return (edge & 3) == 0 ? edge + 2 : edge - 1; }

/// The edge that follows along the face on the left.
static int next_along(const pls_clipped *c, int edge) { return clockwise(c->twin[edge]); }

void pls_clipped_block(pls_clipped *c, pls_vec3 centre, const pls_vec3 axis[3], const double half[3], uint8_t label)
{
    c->count = 8;
    c->full = false;
    for (int v = 0; v < 8; ++v)
    {
        pls_vec3 x = centre;
        int minus = 0;
        for (int a = 0; a < 3; ++a)
        {
            x = pls_add(x, pls_scale(axis[a], v >> a & 1 ? half[a] : -half[a]));
            minus += !(v >> a & 1);
        }
        c->x[v] = x;
        // At +++ the edges along 0, 1, 2 come counterclockwise, at its neighbours clockwise: there 1 and 2 change places.
        for (int a = 0; a < 3; ++a)
        {
            const int here = minus & 1 && a > 0 ? 3 - a : a, there = minus & 1 || a == 0 ? a : 3 - a;
            c->twin[4 * v + here] = (uint16_t)(4 * (v ^ (1 << a)) + there);
            c->label[4 * v + here] = label;
        }
    }
}

void pls_clipped_copy(pls_clipped *to, const pls_clipped *from)
{
    const size_t count = (size_t)from->count;
    to->count = from->count;
    to->full = from->full;
    memcpy(to->x, from->x, count * sizeof *to->x);
    memcpy(to->twin, from->twin, 4 * count * sizeof *to->twin);
    memcpy(to->label, from->label, 4 * count * sizeof *to->label);
}

/// A vertex on each edge that leaves the half-space: `out_end[w - old]` is that edge seen from its lost end, whose twin becomes the new vertex too.
static bool add_vertices(pls_clipped *c, const double *depth, uint8_t label, uint16_t *out_end)
{
    const int old = c->count;
    for (int v = 0; v < old; ++v)
    {
        if (!(depth[v] >= 0.0)) continue;
        for (int e = 4 * v; e < 4 * v + 3; ++e)
        {
            const int t = c->twin[e], u = vertex_of(t);
            if (u >= old || depth[u] >= 0.0) continue;
            if (c->count == PLS_CLIPPED_VERTICES) return false;
            const int w = c->count++;
            c->x[w] = pls_add(c->x[v], pls_scale(pls_sub(c->x[u], c->x[v]), depth[v] / (depth[v] - depth[u])));
            c->label[4 * w] = c->label[t];
            c->label[4 * w + 1] = label;
            c->label[4 * w + 2] = c->label[e];
            c->twin[4 * w] = (uint16_t)e;
            c->twin[e] = c->twin[t] = (uint16_t)(4 * w);
            out_end[w - old] = (uint16_t)t;
        }
    }
    return true;
}

/// Edges of the new face: along each face that was cut, from where it leaves the half-space to where it comes back.
static void join_vertices(pls_clipped *c, int old, const uint16_t *out_end)
{
    for (int w = old; w < c->count; ++w)
    {
        int e = clockwise(out_end[w - old]);
        while (vertex_of(c->twin[e]) < old) e = next_along(c, e);
        const int other = vertex_of(c->twin[e]);
        c->twin[4 * w + 2] = (uint16_t)(4 * other + 1);
        c->twin[4 * other + 1] = (uint16_t)(4 * w + 2);
    }
}

static void drop_vertices(pls_clipped *c, int old, const double *depth)
{
    uint16_t place[PLS_CLIPPED_VERTICES];
    int count = 0;
    for (int v = 0; v < c->count; ++v)
    {
        if (v < old && !(depth[v] >= 0.0)) continue;
        place[v] = (uint16_t)count;
        c->x[count] = c->x[v];
        for (int k = 0; k < 3; ++k)
        {
            c->twin[4 * count + k] = c->twin[4 * v + k];
            c->label[4 * count + k] = c->label[4 * v + k];
        }
        ++count;
    }
    c->count = count;
    for (int v = 0; v < count; ++v)
        for (int e = 4 * v; e < 4 * v + 3; ++e) c->twin[e] = (uint16_t)(4 * place[vertex_of(c->twin[e])] + (c->twin[e] & 3));
}

void pls_clip(pls_clipped *c, const pls_half_space *h, uint8_t label)
{
    double depth[PLS_CLIPPED_VERTICES];
    uint16_t out_end[PLS_CLIPPED_VERTICES];
    const int old = c->count;
    int kept = 0;
    for (int v = 0; v < old; ++v)
    {
        depth[v] = h->offset - pls_dot(h->normal, c->x[v]);
        kept += depth[v] >= 0.0;
    }
    if (kept == old) return;
    if (kept == 0 || !add_vertices(c, depth, label, out_end))
    {
        c->full = c->full || kept > 0;
        c->count = 0;
        return;
    }
    join_vertices(c, old, out_end);
    drop_vertices(c, old, depth);
}

/// Of the tetrahedron between the origin and three points: v/20 (sum of x (x) x + S (x) S), S their sum.
static void add_second(double second[6], pls_vec3 x, double weight)
{
    const pls_vec3 w = pls_scale(x, weight);
    second[0] += w.x * x.x, second[1] += w.y * x.y, second[2] += w.z * x.z;
    second[3] += w.x * x.y, second[4] += w.x * x.z, second[5] += w.y * x.z;
}

/// Triangles from one corner of the face, tetrahedra from there to a vertex of the polytope, as thin as it is itself: from further away they would cancel, and leave noise in slivers.
static void add_face(const pls_clipped *c, int start, uint8_t *seen, pls_clipped_measure *m)
{
    const pls_vec3 apex = c->x[0], p = pls_sub(c->x[vertex_of(start)], apex);
    const uint8_t label = c->label[start];
    int e = next_along(c, start);
    seen[start] = 1;
    for (pls_vec3 a = pls_sub(c->x[vertex_of(e)], apex); e != start;)
    {
        seen[e] = 1;
        e = next_along(c, e);
        const pls_vec3 b = pls_sub(c->x[vertex_of(e)], apex), s = pls_scale(pls_cross(pls_sub(a, p), pls_sub(b, p)), 0.5);
        const pls_vec3 sum = pls_add(p, pls_add(a, b));
        const double v = pls_dot(p, s) / 3.0;
        m->volume += v;
        m->first = pls_add(m->first, pls_scale(sum, 0.25 * v));
        add_second(m->second, p, 0.05 * v), add_second(m->second, a, 0.05 * v), add_second(m->second, b, 0.05 * v);
        add_second(m->second, sum, 0.05 * v);
        m->area[label] = pls_add(m->area[label], s);
        m->area_moment[label] = pls_add(m->area_moment[label], pls_scale(pls_cross(sum, s), 1.0 / 3.0));
        a = b;
    }
}

/// Moments about the apex to those about the origin.
static void move_moments(pls_vec3 x, pls_clipped_measure *m)
{
    const double V = m->volume;
    const pls_vec3 f = m->first;
    double *s = m->second;
    s[0] += x.x * (2.0 * f.x + V * x.x), s[1] += x.y * (2.0 * f.y + V * x.y), s[2] += x.z * (2.0 * f.z + V * x.z);
    s[3] += x.x * f.y + x.y * f.x + V * x.x * x.y;
    s[4] += x.x * f.z + x.z * f.x + V * x.x * x.z;
    s[5] += x.y * f.z + x.z * f.y + V * x.y * x.z;
    m->first = pls_add(f, pls_scale(x, V));
    for (int k = 0; k < PLS_CLIPPED_LABELS; ++k) m->area_moment[k] = pls_add(m->area_moment[k], pls_cross(x, m->area[k]));
}

void pls_clipped_measure_of(const pls_clipped *c, pls_clipped_measure *out)
{
    uint8_t seen[4 * PLS_CLIPPED_VERTICES];
    memset(seen, 0, 4 * (size_t)c->count);
    *out = (pls_clipped_measure){0};
    for (int v = 0; v < c->count; ++v)
        for (int e = 4 * v; e < 4 * v + 3; ++e)
            if (!seen[e]) add_face(c, e, seen, out);
    if (c->count > 0) move_moments(c->x[0], out);
}
