// polytope_depth.c -- distance and depth of two convex polytopes that were near each other in the step before.
//
// All in A's frame and by numbers of vertices: a corner of the Minkowski difference M = A - B is a vertex of A less one of B, wherever the bodies are.
//
// Apart: GJK from the corners that were nearest last time; mostly they still are, which one support point shows.
//
// Overlapping: a closed surface of triangles between corners of M, about the origin, the nearest of whose planes touches M (the polytope that EPA ends with). When the
// bodies have moved its corners move along; as long as all its planes have the origin on their inner side, what it encloses still lies in M, and the ball about the origin
// up to the nearest plane lies in that. If the support point along that plane's normal is no further, this is the depth, the least of all, for two support points and a
// few planes. If it is further, the surface is pushed out to it as in EPA and asked again. So depths are proved in every step, by a surface that is only seldom made anew.
//
// In the plane the surface is a closed line, its faces are edges of two corners.
//
// Support points are found by walking uphill from vertex to vertex, from those last asked for.

#include "contact/polytope_depth.h"

#include "contact/horizon.h"

#include <float.h>
#include <string.h>

enum {
    MOST_CORNERS = 72, ///< of a surface while it grows
    MOST_FACES = 2 * MOST_CORNERS,
    KEPT_CORNERS = 14, ///< of a surface that is remembered: larger ones are made anew
    KEPT_FACES = 2 * KEPT_CORNERS - 4,
    MOST_VERTICES = 32767,
    MOST_TURNS = 64 ///< of GJK
};
/// Places in the memory.
enum { CORNERS = 0, FACES = 1, CORNER = 2, FACE = CORNER + KEPT_CORNERS, FACES_PER_NUMBER = 4 };
_Static_assert(FACE + (KEPT_FACES + FACES_PER_NUMBER - 1) / FACES_PER_NUMBER <= PLS_POLYTOPE_MEMORY, "the memory is too small");

static const double rounding = 1e-15; ///< of distances, by size
static const double exact = 1e-13;    ///< by which the support point may be beyond the nearest plane

typedef struct corner
{
    pls_vec3 w;
    uint32_t a, b; ///< vertices
} corner;

typedef struct face
{
    pls_vec3 n;    ///< outward, unit
    double d;      ///< of the plane from the origin; infinite for faces without area
    uint8_t at[3]; ///< in 2D two
} face;

/// M, in A's frame and units of A's shape.
typedef struct difference
{
    const pls_polytope *a, *b;
    pls_vec3 x, y, z, origin; ///< B's frame in A's: columns with B's scale by A's
    double size;
    int dimension;           ///< as many corners has a face
    uint32_t near_a, near_b; ///< where to look next
    int calls, turns;
    int corner_count, face_count;
    corner corners[MOST_CORNERS];
    face faces[MOST_FACES];
} difference;

// ---- corners ----------------------------------------------------------------------------------------------------------------------------------------------------

static uint32_t uphill(const pls_polytope *p, pls_vec3 n, uint32_t at)
{
    double most = pls_dot(p->vertex[at], n);
    if (!p->neighbour_start)
    {
        for (uint32_t v = 0; v < p->vertex_count; ++v)
        {
            double along = pls_dot(p->vertex[v], n);
            if (along > most) most = along, at = v;
        }
        return at;
    }
    for (uint32_t from = p->vertex_count; from != at;)
    {
        from = at;
        for (uint32_t k = p->neighbour_start[from]; k < p->neighbour_start[from + 1]; ++k)
        {
            double along = pls_dot(p->vertex[p->neighbour[k]], n);
            if (along > most) most = along, at = p->neighbour[k];
        }
    }
    return at;
}

static pls_vec3 vertex_of_b(const difference *m, uint32_t b)
{
    pls_vec3 v = m->b->vertex[b];
    return pls_add(m->origin, pls_add(pls_add(pls_scale(m->x, v.x), pls_scale(m->y, v.y)), pls_scale(m->z, v.z)));
}

static corner corner_of(const difference *m, uint32_t a, uint32_t b)
{
    return (corner){.w = pls_sub(m->a->vertex[a], vertex_of_b(m, b)), .a = a, .b = b};
}

static corner support(difference *m, pls_vec3 n)
{
    m->near_a = uphill(m->a, n, m->near_a);
    m->near_b = uphill(m->b, pls_vec(-pls_dot(m->x, n), -pls_dot(m->y, n), -pls_dot(m->z, n)), m->near_b);
    ++m->calls;
    return corner_of(m, m->near_a, m->near_b);
}

static void place(const pls_posed *a, const pls_posed *b, difference *m)
{
    const double ratio = b->scale / a->scale;
    m->a = a->shape->polytope, m->b = b->shape->polytope;
    m->x = pls_scale(pls_posed_turn_back(a, b->x), ratio);
    m->y = pls_scale(pls_posed_turn_back(a, b->y), ratio);
    m->z = pls_scale(pls_posed_turn_back(a, b->z), ratio);
    m->origin = pls_posed_own(a, b->position);
    m->size = 2.0 * (a->size + b->size) / a->scale;
    m->dimension = a->shape->dimension;
    m->near_a = m->near_b = 0;
    m->calls = m->turns = 0;
    m->corner_count = m->face_count = 0;
}

// ---- apart ------------------------------------------------------------------------------------------------------------------------------------------------------

/// A simplex of GJK keeps the numbers of vertices in `stored`.
static pls_support_pair pair_of(corner c) { return (pls_support_pair){.w = c.w, .stored = (int)(c.a << 16 | c.b)}; }
static uint32_t a_of(const pls_support_pair *p) { return (uint32_t)p->stored >> 16; }
static uint32_t b_of(const pls_support_pair *p) { return (uint32_t)p->stored & 0xffffu; }

static bool has_corner(const pls_simplex *s, int stored)
{
    for (int k = 0; k < s->count; ++k)
        if (s->point[k].stored == stored) return true;
    return false;
}

enum verdict { APART, AROUND, UNSURE };

/// Nearest point of M from the corners in `s`. AROUND: the four (2D: three) in `s` hold the origin.
static enum verdict gjk(difference *m, pls_simplex *s, pls_vec3 *nearest)
{
    double least = DBL_MAX;
    if (s->count == 0) s->point[s->count++] = pair_of(corner_of(m, 0, 0));
    while (m->turns++ < MOST_TURNS)
    {
        bool inside;
        pls_vec3 v = pls_simplex_nearest(s, m->dimension, &inside);
        if (inside) return AROUND;
        double square = pls_dot(v, v), distance = sqrt(square);
        if (distance <= PLS_TOUCHING * m->size || !(distance < least)) return UNSURE;
        least = distance;
        *nearest = v;
        m->near_a = a_of(&s->point[0]), m->near_b = b_of(&s->point[0]);
        pls_support_pair p = pair_of(support(m, pls_scale(v, -1.0)));
        if (square - pls_dot(v, p.w) <= rounding * m->size * distance || has_corner(s, p.stored)) return APART;
        s->point[s->count++] = p;
    }
    return UNSURE;
}

// ---- overlapping --------------------------------------------------------------------------------------------------------------------------------------------------

static void find_plane(const difference *m, face *f)
{
    pls_vec3 p = m->corners[f->at[0]].w, u = pls_sub(m->corners[f->at[1]].w, p), n = pls_vec(u.y, -u.x, 0.0);
    if (m->dimension == 3) n = pls_cross(u, pls_sub(m->corners[f->at[2]].w, p));
    double length = pls_length(n), least = 1e-14 * m->size * (m->dimension == 3 ? m->size : 1.0);
    f->d = DBL_MAX;
    if (!(length > least)) return;
    f->n = pls_scale(n, 1.0 / length);
    f->d = pls_dot(f->n, p);
}

/// Is the origin on the inner side of all faces, and which is the nearest? -1: no.
static int nearest_face(const difference *m)
{
    int best = -1;
    double least = DBL_MAX;
    for (int k = 0; k < m->face_count; ++k)
        if (m->faces[k].d < least) least = m->faces[k].d, best = k;
    return least > 0.0 ? best : -1;
}

static bool add_face(difference *m, uint8_t i, uint8_t j, uint8_t k)
{
    if (m->face_count == MOST_FACES) return false;
    face *f = &m->faces[m->face_count++];
    f->at[0] = i, f->at[1] = j, f->at[2] = k;
    find_plane(m, f);
    return f->d > 0.0;
}

/// The corners of GJK as first surface.
static bool first_surface(difference *m, const pls_simplex *s)
{
    m->corner_count = s->count, m->face_count = 0;
    for (int k = 0; k < s->count; ++k) m->corners[k] = (corner){.w = s->point[k].w, .a = a_of(&s->point[k]), .b = b_of(&s->point[k])};
    pls_vec3 p = m->corners[0].w, u = pls_sub(m->corners[1].w, p), v = pls_sub(m->corners[2].w, p);
    pls_vec3 inward = m->dimension == 3 ? pls_sub(m->corners[3].w, p) : pls_vec(0.0, 0.0, -1.0);
    uint8_t i = 1, j = 2;
    if (pls_dot(pls_cross(u, v), inward) > 0.0) i = 2, j = 1;
    if (m->dimension == 2) return add_face(m, 0, i, 0) && add_face(m, i, j, 0) && add_face(m, j, 0, 0);
    return add_face(m, 0, i, j) && add_face(m, 0, 3, i) && add_face(m, i, 3, j) && add_face(m, j, 3, 0);
}

/// In the plane: of the edges that see the corner, which hang together, only the ends stay.
static bool grow_in_plane(difference *m, corner c, int chosen)
{
    if (m->corner_count == MOST_CORNERS) return false;
    uint8_t number = (uint8_t)m->corner_count, first = m->faces[chosen].at[0], last = m->faces[chosen].at[1];
    m->corners[m->corner_count++] = c;
    m->faces[chosen] = m->faces[--m->face_count];
    for (int k = 0; k < m->face_count;)
    {
        const face f = m->faces[k];
        const bool joins = f.at[1] == first || f.at[0] == last;
        if (!joins || !(pls_dot(f.n, c.w) > f.d + rounding * m->size))
        {
            ++k;
            continue;
        }
        if (f.at[1] == first)
            first = f.at[0];
        else
            last = f.at[1];
        m->faces[k] = m->faces[--m->face_count];
        k = 0; // others may join now
    }
    return first != last && add_face(m, first, number, 0) && add_face(m, number, last, 0);
}

/// Put a corner into the surface in place of the faces it sees.
static bool grow(difference *m, corner c, int chosen)
{
    if (m->dimension == 2) return grow_in_plane(m, c, chosen);
    pls_horizon h;
    h.count = 0;
    if (m->corner_count == MOST_CORNERS) return false;
    uint8_t number = (uint8_t)m->corner_count;
    for (int k = m->face_count; k-- > 0;)
    {
        const face f = m->faces[k];
        if (k != chosen && !(pls_dot(f.n, c.w) > f.d + rounding * m->size)) continue;
        for (int e = 0; e < 3; ++e) pls_horizon_add(&h, f.at[e], f.at[e == 2 ? 0 : e + 1]);
        m->faces[k] = m->faces[--m->face_count];
    }
    if (!pls_horizon_is_loop(&h)) return false;
    m->corners[m->corner_count++] = c;
    for (int k = 0; k < h.count; ++k)
        if (!add_face(m, (uint8_t)h.from[k], (uint8_t)h.to[k], number)) return false;
    return true;
}

static bool is_corner_of(const difference *m, const face *f, const corner *c)
{
    for (int k = 0; k < m->dimension; ++k)
        if (m->corners[f->at[k]].a == c->a && m->corners[f->at[k]].b == c->b) return true;
    return false;
}

/// Grow the surface until its nearest plane touches M. Gives that face; -1: lost.
static int touch(difference *m)
{
    for (int nearest; (nearest = nearest_face(m)) >= 0;)
    {
        const face *f = &m->faces[nearest];
        ++m->turns;
        m->near_a = m->corners[f->at[0]].a, m->near_b = m->corners[f->at[0]].b;
        corner c = support(m, f->n);
        if (pls_dot(c.w, f->n) - f->d <= exact * m->size || is_corner_of(m, f, &c)) return nearest;
        if (!grow(m, c, nearest)) return -1;
    }
    return -1;
}

/// Weights of the origin's foot in the plane of a face.
static void weigh(const difference *m, const face *f, double weight[3])
{
    pls_vec3 foot = pls_scale(f->n, f->d), p[3];
    double sum = 0.0;
    for (int k = 0; k < m->dimension; ++k) p[k] = pls_sub(m->corners[f->at[k]].w, foot);
    if (m->dimension == 2)
    {
        pls_vec3 e = pls_sub(p[1], p[0]);
        weight[0] = pls_dot(p[1], e), weight[1] = -pls_dot(p[0], e), weight[2] = 0.0;
    }
    else
        for (int k = 0; k < 3; ++k) weight[k] = pls_dot(f->n, pls_cross(p[(k + 1) % 3], p[(k + 2) % 3]));
    for (int k = 0; k < 3; ++k) sum += weight[k];
    for (int k = 0; k < 3; ++k) weight[k] /= sum;
}

static double least_of(const double weight[3]) { return fmin(fmin(weight[0], weight[1]), weight[2]); } // 2D: the third is 0

/// Of the faces in the plane found (those of a polygon) the one below the origin.
static int face_below(const difference *m, int nearest, double weight[3])
{
    const face *f = &m->faces[nearest];
    weigh(m, f, weight);
    if (least_of(weight) >= 0.0) return nearest;
    int best = nearest;
    double other[3];
    for (int k = 0; k < m->face_count; ++k)
    {
        const face *g = &m->faces[k];
        if (!(g->d <= f->d + 1e-9 * m->size) || pls_dot(g->n, f->n) < 1.0 - 1e-9) continue;
        weigh(m, g, other);
        if (least_of(other) > least_of(weight)) memcpy(weight, other, sizeof other), best = k;
    }
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) weight[k] = fmax(weight[k], 0.0), sum += weight[k];
    for (int k = 0; k < 3; ++k) weight[k] /= sum;
    return best;
}

// ---- memory -----------------------------------------------------------------------------------------------------------------------------------------------------

static double packed(uint32_t a, uint32_t b) { return (double)a * 65536.0 + (double)b; }

/// Two numbers below 65536 from one; false: no such numbers of vertices.
static bool unpack(const difference *m, double number, uint32_t *a, uint32_t *b)
{
    if (!(number >= 0.0 && number < 65536.0 * 65536.0)) return false;
    uint32_t n = (uint32_t)number;
    *a = n >> 16, *b = n & 0xffffu;
    return *a < m->a->vertex_count && *b < m->b->vertex_count;
}

static bool recall_simplex(const difference *m, const double *memory, pls_simplex *s)
{
    s->count = 0;
    for (int k = 0; k < (int)memory[CORNERS] && k < 3; ++k)
    {
        uint32_t a, b;
        if (!unpack(m, memory[CORNER + k], &a, &b)) return false;
        s->point[s->count++] = pair_of(corner_of(m, a, b));
    }
    return s->count > 0;
}

static void remember_simplex(const pls_simplex *s, double *memory)
{
    memset(memory, 0, PLS_POLYTOPE_MEMORY * sizeof *memory);
    memory[CORNERS] = s->count;
    for (int k = 0; k < s->count; ++k) memory[CORNER + k] = packed(a_of(&s->point[k]), b_of(&s->point[k]));
}

/// Of a closed surface with so many corners.
static int faces_of(const difference *m, int corners) { return m->dimension == 2 ? corners : 2 * corners - 4; }

static bool recall_surface(difference *m, const double *memory)
{
    m->corner_count = (int)memory[CORNERS], m->face_count = (int)memory[FACES];
    const int faces = m->face_count;
    m->face_count = 0; // until all is read
    if (m->corner_count <= m->dimension || m->corner_count > KEPT_CORNERS || faces != faces_of(m, m->corner_count)) return false;
    for (int k = 0; k < m->corner_count; ++k)
    {
        uint32_t a, b;
        if (!unpack(m, memory[CORNER + k], &a, &b)) return false;
        m->corners[k] = corner_of(m, a, b);
    }
    for (int k = 0; k < faces; k += FACES_PER_NUMBER)
    {
        uint64_t bits = (uint64_t)memory[FACE + k / FACES_PER_NUMBER];
        for (int f = k; f < k + FACES_PER_NUMBER && f < faces; ++f)
        {
            for (int c = 0; c < 3; ++c, bits >>= 4)
            {
                m->faces[f].at[c] = (uint8_t)(bits & 15u);
                if (m->faces[f].at[c] >= m->corner_count) return false;
            }
            find_plane(m, &m->faces[f]);
        }
    }
    m->face_count = faces;
    return true;
}

/// Corners that are still in use, renumbered. A surface with too many is not kept, only the face found.
static void remember_surface(const difference *m, int found, double *memory)
{
    uint8_t number[MOST_CORNERS];
    int used = 0;
    memset(memory, 0, PLS_POLYTOPE_MEMORY * sizeof *memory);
    memset(number, 255, sizeof number);
    for (int f = 0; f < m->face_count; ++f)
        for (int c = 0; c < m->dimension; ++c)
        {
            uint8_t at = m->faces[f].at[c];
            if (number[at] == 255) number[at] = (uint8_t)used++;
        }
    if (used > KEPT_CORNERS)
    {
        memory[CORNERS] = m->dimension;
        for (int c = 0; c < m->dimension; ++c)
        {
            const corner *p = &m->corners[m->faces[found].at[c]];
            memory[CORNER + c] = packed(p->a, p->b);
        }
        return;
    }
    memory[CORNERS] = used, memory[FACES] = m->face_count;
    for (int k = 0; k < m->corner_count; ++k)
        if (number[k] < 255) memory[CORNER + number[k]] = packed(m->corners[k].a, m->corners[k].b);
    for (int k = 0; k < m->face_count; k += FACES_PER_NUMBER)
    {
        uint64_t bits = 0;
        for (int f = k; f < k + FACES_PER_NUMBER && f < m->face_count; ++f)
            for (int c = 0; c < m->dimension; ++c) bits |= (uint64_t)number[m->faces[f].at[c]] << (12 * (f - k) + 4 * c);
        memory[FACE + k / FACES_PER_NUMBER] = (double)bits;
    }
}

// ---- the answer -------------------------------------------------------------------------------------------------------------------------------------------------

/// In the world, margins added: `on_a` the witness of A's core in A's frame, n the normal there.
static void finish(const pls_posed *a, const pls_posed *b, const difference *m, pls_vec3 on_a, pls_vec3 n, double delta, pls_depth *out)
{
    double margin_a = a->shape->margin * a->scale, margin_b = b->shape->margin * b->scale;
    out->normal = pls_posed_turn(a, n);
    out->delta = delta * a->scale;
    pls_vec3 core = pls_posed_world(a, on_a);
    out->on_a = pls_add(core, pls_scale(out->normal, margin_a));
    out->on_b = pls_sub(core, pls_scale(out->normal, out->delta + margin_b));
    out->delta += margin_a + margin_b;
    out->iterations = m->turns, out->support_calls = m->calls;
    out->converged = true, out->local = false;
}

static void finish_apart(const pls_posed *a, const pls_posed *b, const difference *m, const pls_simplex *s, pls_vec3 v, pls_depth *out)
{
    pls_vec3 on_a = pls_vec(0.0, 0.0, 0.0);
    double distance = pls_length(v);
    pls_vec3 n = pls_scale(v, -1.0 / distance);
    if (m->dimension == 2 && s->count == 2) // across the edge: of a short v the direction would not be as exact
    {
        pls_vec3 e = pls_unit(pls_sub(s->point[1].w, s->point[0].w));
        n = pls_vec(e.y, -e.x, 0.0);
        if (pls_dot(n, v) > 0.0) n = pls_scale(n, -1.0);
        distance = -pls_dot(n, s->point[0].w);
    }
    for (int k = 0; k < s->count; ++k) on_a = pls_add(on_a, pls_scale(m->a->vertex[a_of(&s->point[k])], s->weight[k]));
    finish(a, b, m, on_a, n, -distance, out);
}

static void finish_overlap(const pls_posed *a, const pls_posed *b, const difference *m, int nearest, pls_depth *out)
{
    double weight[3];
    const face *f = &m->faces[nearest], *below = &m->faces[face_below(m, nearest, weight)];
    pls_vec3 on_a = pls_vec(0.0, 0.0, 0.0);
    for (int k = 0; k < m->dimension; ++k) on_a = pls_add(on_a, pls_scale(m->a->vertex[m->corners[below->at[k]].a], weight[k]));
    finish(a, b, m, on_a, f->n, f->d, out);
}

/// From a simplex: apart, or a surface from the four corners that hold the origin.
static bool from_simplex(const pls_posed *a, const pls_posed *b, difference *m, pls_simplex *s, double *memory, pls_depth *out)
{
    pls_vec3 v = pls_vec(0.0, 0.0, 0.0);
    enum verdict verdict = gjk(m, s, &v);
    if (verdict == APART)
    {
        remember_simplex(s, memory);
        finish_apart(a, b, m, s, v, out);
        return true;
    }
    int nearest = verdict == AROUND && first_surface(m, s) ? touch(m) : -1;
    if (nearest < 0) return false;
    remember_surface(m, nearest, memory);
    finish_overlap(a, b, m, nearest, out);
    return true;
}

/// The surface of the last step, its corners where they are now. False: the origin is not inside any more, or it lost its shape.
static bool from_surface(const pls_posed *a, const pls_posed *b, difference *m, double *memory, pls_depth *out)
{
    if (!recall_surface(m, memory)) return false;
    const int corners = m->corner_count;
    int nearest = touch(m);
    if (nearest < 0) return false;
    if (m->corner_count != corners) remember_surface(m, nearest, memory);
    finish_overlap(a, b, m, nearest, out);
    return true;
}

/// The face of a lost surface that the origin is furthest beyond: where the bodies came apart.
static void outermost(const difference *m, pls_simplex *s)
{
    const face *best = &m->faces[0];
    for (int k = 1; k < m->face_count; ++k)
        if (m->faces[k].d < best->d) best = &m->faces[k];
    for (int c = 0; c < m->dimension; ++c) s->point[c] = pair_of(m->corners[best->at[c]]);
    s->count = m->dimension;
}

bool pls_polytope_depth(const pls_posed *a, const pls_posed *b, double memory[PLS_POLYTOPE_MEMORY], pls_depth *out)
{
    difference m;
    pls_simplex s;
    place(a, b, &m);
    s.count = 0;
    if (m.a->vertex_count <= MOST_VERTICES && m.b->vertex_count <= MOST_VERTICES)
    {
        if (memory[FACES] > 0.0 && from_surface(a, b, &m, memory, out)) return true;
        if (m.face_count > 0)
            outermost(&m, &s);
        else if (memory[CORNERS] > 0.0)
            recall_simplex(&m, memory, &s);
        if (from_simplex(a, b, &m, &s, memory, out)) return true;
    }
    memset(memory, 0, PLS_POLYTOPE_MEMORY * sizeof *memory);
    return false;
}
