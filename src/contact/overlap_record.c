// overlap_record.c -- the topology of an overlap, found by cutting the faces of each body by the planes and cells of the other.
//
// Each side of a polygon knows which condition it comes from, and each corner which two sides meet there: that names it. The coordinates serve to decide what is cut and are
// forgotten then. Orders go by the numbers of faces and vertices alone, so that sums come out the same wherever the bodies came from.

#include "contact/overlap_record.h"

#include <string.h>

enum { MOST_SPOTS = 2 * PLS_RECORD_PLANES + 8 };

/// What a side of a piece lies on.
enum side_kind {
    OUTLINE, ///< of the face; `id`: number of the side
    SURFACE, ///< the plane of the other body that is nearest
    SEAM     ///< where plane `id` of the other body becomes the nearest
};

typedef struct spot
{
    pls_vec3 x;
    uint8_t kind, id; ///< of the side that begins here
} spot;

typedef struct piece
{
    int count;
    spot at[MOST_SPOTS];
} piece;

/// A corner by name, the same from all pieces that have it: kind and body, then numbers of vertices and faces.
typedef uint64_t corner_name;

typedef struct finding
{
    const pls_record_bodies *bodies;
    pls_overlap_record *record;
    pls_half_space plane[2][PLS_RECORD_PLANES];
    uint64_t seen[2]; ///< places of planes that have a piece or are nearest to one
    uint64_t open;    ///< of the sides of pieces so far those without counterpart, as a sum without carry of their hashes
    int corners;
    corner_name name[PLS_RECORD_CORNERS];
} finding;

// ---- faces and vertices ---------------------------------------------------------------------------------------------------------------------------------

static const pls_polytope *polytope_of(const finding *w, int body) { return w->bodies->body[body]->shape->polytope; }

static const uint32_t *outline_of(const finding *w, int body, int place, int *corners)
{
    const pls_polytope *t = polytope_of(w, body);
    const uint8_t face = w->record->plane[body][place];
    *corners = (int)(t->face_start[face + 1] - t->face_start[face]);
    return t->face_vertex + t->face_start[face];
}

static bool is_wall(const finding *w, int body) { return body == 1 && w->bodies->wall; }

/// Faces that have a vertex of `high`.
static void take_planes(finding *w, int body)
{
    pls_overlap_record *r = w->record;
    const int faces = is_wall(w, body) ? 1 : (int)polytope_of(w, body)->face_count;
    for (int f = 0; f < faces; ++f)
    {
        r->plane[body][r->planes[body]] = (uint8_t)f;
        bool near = is_wall(w, body);
        int corners = 0;
        const uint32_t *outline = near ? NULL : outline_of(w, body, r->planes[body], &corners);
        for (int k = 0; k < corners; ++k) near = near || (r->high[body] >> outline[k] & 1);
        if (near) w->plane[body][r->planes[body]++] = pls_record_plane(w->bodies, body, f);
    }
}

static double depth_under(const pls_half_space *h, pls_vec3 x) { return h->offset - pls_dot(h->normal, x); }

/// Positive where plane g is nearer than h.
static pls_half_space nearer(const pls_half_space *g, const pls_half_space *h)
{
    return (pls_half_space){pls_sub(h->normal, g->normal), h->offset - g->offset};
}

// ---- pieces ---------------------------------------------------------------------------------------------------------------------------------------------

static void take_outline(const finding *w, int body, int place, piece *p)
{
    const uint32_t *outline = outline_of(w, body, place, &p->count);
    for (int k = 0; k < p->count; ++k)
        p->at[k] = (spot){.x = pls_record_vertex(w->bodies, body, (int)outline[k]), .kind = OUTLINE, .id = (uint8_t)k};
}

/// Keep what lies in the half-space; the new side is one of `kind` and `id`. False if nothing is left.
static bool cut(piece *p, const pls_half_space *h, uint8_t kind, uint8_t id)
{
    double depth[MOST_SPOTS];
    int kept = 0;
    for (int k = 0; k < p->count; ++k)
    {
        depth[k] = depth_under(h, p->at[k].x);
        kept += depth[k] >= 0.0;
    }
    if (kept == p->count) return true;
    if (kept == 0 || p->count + 1 >= MOST_SPOTS) return false;
    const piece whole = *p;
    p->count = 0;
    for (int k = 0; k < whole.count; ++k)
    {
        const int next = k + 1 < whole.count ? k + 1 : 0;
        const bool in = depth[k] >= 0.0;
        const spot *here = &whole.at[k];
        if (in) p->at[p->count++] = *here;
        if (in == (depth[next] >= 0.0)) continue;
        const double share = depth[k] / (depth[k] - depth[next]);
        p->at[p->count++] = (spot){.x = pls_add(here->x, pls_scale(pls_sub(whole.at[next].x, here->x), share)),
                                   .kind = in ? kind : here->kind,
                                   .id = in ? id : here->id};
    }
    return true;
}

/// The part of a face in the other body. False if there is none.
static bool cut_by_body(const finding *w, int other, piece *p)
{
    for (int h = 0; h < w->record->planes[other]; ++h)
    {
        bool any = false;
        for (int k = 0; k < p->count; ++k) any = any || depth_under(&w->plane[other][h], p->at[k].x) >= 0.0;
        if (!any) return false;
    }
    for (int h = 0; h < w->record->planes[other]; ++h)
        if (!cut(p, &w->plane[other][h], SURFACE, 0)) return false;
    return true;
}

/// Places of the planes that some point of a polygon may be nearest to.
static uint64_t planes_about(const finding *w, int other, const piece *p)
{
    pls_vec3 middle = pls_vec(0.0, 0.0, 0.0);
    for (int k = 0; k < p->count; ++k) middle = pls_add(middle, pls_scale(p->at[k].x, 1.0 / p->count));
    double reach = 0.0; // squared
    for (int k = 0; k < p->count; ++k)
    {
        const pls_vec3 x = pls_sub(p->at[k].x, middle);
        reach = fmax(reach, pls_dot(x, x));
    }
    const int planes = w->record->planes[other];
    int nearest = 0;
    for (int h = 1; h < planes; ++h)
        if (depth_under(&w->plane[other][h], middle) < depth_under(&w->plane[other][nearest], middle)) nearest = h;
    uint64_t list = 0;
    for (int h = 0; h < planes; ++h)
    {
        // Away from the middle the difference of two depths changes by that of normals per length.
        const pls_half_space more = nearer(&w->plane[other][nearest], &w->plane[other][h]);
        const double least = depth_under(&more, middle);
        if (!(least * least > pls_dot(more.normal, more.normal) * reach)) list |= (uint64_t)1 << h;
    }
    return list;
}

// ---- names ----------------------------------------------------------------------------------------------------------------------------------------------

static uint64_t name_of(uint64_t kind, uint64_t body, const int id[4])
{
    return kind << 40 | body << 32 | (uint64_t)id[0] << 24 | (uint64_t)id[1] << 16 | (uint64_t)id[2] << 8 | (uint64_t)id[3];
}

static void order(int *a, int *b)
{
    const int less = *a < *b ? *a : *b, more = *a < *b ? *b : *a;
    *a = less, *b = more;
}

/// Bits so mixed that sums without carry of a few names do not vanish by chance.
static uint64_t mixed(uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/// The vertices that two faces of a body share; false unless there are two.
static bool shared_edge(const finding *w, int body, int f, int g, int vertex[2])
{
    int first, second, found = 0;
    const uint32_t *a = outline_of(w, body, f, &first), *b = outline_of(w, body, g, &second);
    for (int i = 0; i < first; ++i)
        for (int j = 0; j < second; ++j)
            if (a[i] == b[j] && found++ < 2) vertex[found - 1] = (int)a[i];
    if (found != 2) return false;
    order(&vertex[0], &vertex[1]);
    return true;
}

/// What corner k of the piece of face f nearest to g is made of: vertices by number, planes by place. Returns its kind, or -1 if it is none that a record knows.
static int corner_of(const finding *w, int *body, int f, int g, const piece *p, int k, int id[4])
{
    const spot *in = &p->at[k ? k - 1 : p->count - 1], *out = &p->at[k];
    if (in->kind > out->kind) // sides in order of kind
    {
        const spot *swap = in;
        in = out, out = swap;
    }
    int corners;
    const uint32_t *outline = outline_of(w, *body, f, &corners);
    id[0] = id[1] = id[2] = id[3] = 0;
    if (in->kind == OUTLINE && out->kind == OUTLINE)
    {
        id[0] = (int)outline[p->at[k].id], id[1] = g;
        return (in->id + 1) % corners == out->id ? PLS_CORNER_VERTEX : -1;
    }
    if (in->kind == OUTLINE)
    {
        id[0] = (int)outline[in->id], id[1] = (int)outline[(in->id + 1) % corners], id[2] = g, id[3] = out->id;
        order(&id[0], &id[1]);
        if (out->kind == SEAM) order(&id[2], &id[3]);
        if (out->kind == SURFACE) id[3] = 0;
        return out->kind == SEAM ? PLS_CORNER_LEAVE : PLS_CORNER_CROSS;
    }
    if (in->kind == SURFACE && out->kind == SEAM) // an edge of the other body
    {
        *body = 1 - *body;
        id[2] = f;
        return !is_wall(w, *body) && shared_edge(w, *body, g, out->id, id) ? PLS_CORNER_CROSS : -1;
    }
    if (in->kind != SEAM) return -1;
    id[0] = f, id[1] = g, id[2] = in->id, id[3] = out->id;
    order(&id[1], &id[2]), order(&id[2], &id[3]), order(&id[1], &id[2]);
    return PLS_CORNER_MEET;
}

/// How many of the numbers that name a corner are vertices; the rest are planes, of the other body but for the first of `meet`.
static int vertices_of(int kind) { return kind == PLS_CORNER_VERTEX ? 1 : kind == PLS_CORNER_MEET ? 0 : 2; }
static int planes_of(int kind) { return kind == PLS_CORNER_MEET ? 4 : kind == PLS_CORNER_LEAVE ? 2 : 1; }

/// Faces in place of places, so that names do not depend on which faces are near.
static corner_name full_name(const finding *w, int kind, int body, const int id[4])
{
    const int vertices = vertices_of(kind);
    int number[4] = {id[0], id[1], id[2], id[3]};
    for (int k = vertices; k < vertices + planes_of(kind); ++k)
        number[k] = w->record->plane[kind == PLS_CORNER_MEET && k == 0 ? body : 1 - body][id[k]];
    return name_of((uint64_t)kind, (uint64_t)body, number);
}

/// The number of the corner, a new one if need be; -1 if there is no room.
static int number_of(finding *w, corner_name name)
{
    for (int k = 0; k < w->corners; ++k)
        if (w->name[k] == name) return k;
    if (w->corners == PLS_RECORD_CORNERS) return -1;
    w->name[w->corners] = name;
    return w->corners++;
}

/// The side that begins at corner k. Each side is one of two pieces, but on walls.
static void meet_side(finding *w, int body, int f, int g, const spot *s)
{
    int corners;
    const uint32_t *outline = outline_of(w, body, f, &corners);
    int id[4] = {f, g, 0, 0};
    if (s->kind == OUTLINE)
    {
        id[2] = (int)outline[s->id], id[3] = (int)outline[(s->id + 1) % corners];
        order(&id[2], &id[3]);
        id[0] = 0;
    }
    else if (s->kind == SEAM)
    {
        id[2] = s->id;
        order(&id[1], &id[2]);
    }
    else if (is_wall(w, 1 - body))
        return;
    else if (body == 1)
        id[0] = g, id[1] = f;
    w->open ^= mixed(name_of(s->kind, s->kind == SURFACE ? 0 : (uint64_t)body, id));
}

/// Triangles from the corner whose name is least.
static bool add_piece(finding *w, int body, int f, int g, const piece *p)
{
    pls_overlap_record *r = w->record;
    int number[MOST_SPOTS], first = 0;
    for (int k = 0; k < p->count; ++k)
    {
        int of = body, id[4];
        const int kind = corner_of(w, &of, f, g, p, k, id);
        if (kind < 0) return false;
        number[k] = number_of(w, full_name(w, kind, of, id));
        if (number[k] < 0) return false;
        if (w->name[number[k]] < w->name[number[first]]) first = k;
        meet_side(w, body, f, g, &p->at[k]);
    }
    const int before = pls_record_first_triangle(r, body) + r->triangles[body];
    if (p->count < 3 || before + p->count - 2 > PLS_RECORD_TRIANGLES) return false;
    for (int k = 2; k < p->count; ++k)
    {
        uint8_t *to = r->triangle[before + k - 2];
        to[0] = (uint8_t)number[first], to[1] = (uint8_t)number[(first + k - 1) % p->count],
        to[2] = (uint8_t)number[(first + k) % p->count];
        to[3] = (uint8_t)(body * PLS_RECORD_PLANES + f);
        r->from[before + k - 2] = (uint8_t)((1 - body) * PLS_RECORD_PLANES + g);
    }
    r->triangles[body] = (uint8_t)(r->triangles[body] + p->count - 2);
    w->seen[body] |= (uint64_t)1 << f, w->seen[1 - body] |= (uint64_t)1 << g;
    return true;
}

static bool add_faces(finding *w, int body)
{
    const int other = 1 - body;
    piece outline, p;
    for (int f = 0; f < w->record->planes[body]; ++f)
    {
        take_outline(w, body, f, &outline);
        p = outline;
        if (!cut_by_body(w, other, &p)) continue;
        const uint64_t list = planes_about(w, other, &p);
        for (uint64_t g = list; g; g &= g - 1)
        {
            const int at = __builtin_ctzll(g);
            p = outline;
            bool any = cut(&p, &w->plane[other][at], SURFACE, 0);
            for (uint64_t h = list & ~((uint64_t)1 << at); h && any; h &= h - 1)
            {
                const int next = __builtin_ctzll(h);
                const pls_half_space here = nearer(&w->plane[other][at], &w->plane[other][next]);
                any = cut(&p, &here, SEAM, (uint8_t)next);
            }
            if (any && !add_piece(w, body, f, at, &p)) return false;
        }
    }
    return true;
}

// ---- the record -----------------------------------------------------------------------------------------------------------------------------------------

/// A vertex gets a row; -1 if there is no room.
static int row_of_vertex(pls_overlap_record *r, int body, int vertex)
{
    const int first = body ? r->vertices[0] : 0;
    for (int k = first; k < first + r->vertices[body]; ++k)
        if (r->vertex[k] == vertex) return k;
    if (r->vertices[0] + r->vertices[1] == PLS_RECORD_VERTICES) return -1;
    r->vertex[first + r->vertices[body]] = (uint8_t)vertex;
    return first + r->vertices[body]++;
}

static int place_of_face(const pls_overlap_record *r, int body, int face)
{
    int k = 0;
    while (r->plane[body][k] != face) ++k;
    return body * PLS_RECORD_PLANES + k;
}

/// Corners in order of their names, which is that of kinds, and triangles by where they are then.
static void write_corners(finding *w)
{
    pls_overlap_record *r = w->record;
    uint8_t place[PLS_RECORD_CORNERS];
    for (int k = 0; k < w->corners; ++k)
    {
        int rank = 0;
        for (int j = 0; j < w->corners; ++j) rank += w->name[j] < w->name[k];
        const int kind = (int)(w->name[k] >> 40), body = (int)(w->name[k] >> 32 & 1), vertices = vertices_of(kind);
        for (int v = 0; v < vertices + planes_of(kind); ++v)
        {
            const int id = (int)(w->name[k] >> (24 - 8 * v) & 255);
            const int of = kind == PLS_CORNER_MEET && v == 0 ? body : 1 - body;
            r->corner[rank][v] = (uint8_t)(v < vertices ? row_of_vertex(r, body, id) : place_of_face(r, of, id));
        }
        place[k] = (uint8_t)rank;
        ++r->corners[kind];
    }
    for (int body = 0; body < 2; ++body)
    {
        uint8_t(*triangle)[4] = r->triangle + pls_record_first_triangle(r, body);
        for (int k = 0; k < r->triangles[body]; ++k)
            for (int v = 0; v < 3; ++v) triangle[k][v] = place[triangle[k][v]];
    }
}

/// Vertices that all planes seen of a body have, two at most.
static int common_vertices(const finding *w, int body, int vertex[2])
{
    int corners, found = 0;
    const uint32_t *first = outline_of(w, body, __builtin_ctzll(w->seen[body]), &corners);
    for (int k = 0; k < corners && found < 2; ++k)
    {
        bool all = true;
        for (uint64_t rest = w->seen[body]; rest && all; rest &= rest - 1)
        {
            int count;
            const uint32_t *outline = outline_of(w, body, __builtin_ctzll(rest), &count);
            bool has = false;
            for (int i = 0; i < count; ++i) has = has || outline[i] == first[k];
            all = has;
        }
        if (all) vertex[found++] = (int)first[k];
    }
    return found;
}

static bool write_apex(finding *w, int body)
{
    pls_overlap_record *r = w->record;
    pls_record_apex *apex = &r->apex[body];
    for (uint64_t rest = w->seen[body]; rest; rest &= rest - 1) r->seen[body] |= (uint64_t)1 << r->plane[body][__builtin_ctzll(rest)];
    if ((w->seen[body] & (w->seen[body] - 1)) == 0)
    {
        apex->at[0] = (uint8_t)(body * PLS_RECORD_PLANES + __builtin_ctzll(w->seen[body]));
        return true;
    }
    int vertex[2] = {0, 0};
    const int common = common_vertices(w, body, vertex);
    apex->kind = common == 0 ? PLS_NO_APEX : common == 1 ? PLS_APEX_VERTEX : PLS_APEX_ON_EDGE;
    for (int k = 0; k < common; ++k)
    {
        const int row = row_of_vertex(r, body, vertex[k]);
        if (row < 0) return false;
        apex->at[k] = (uint8_t)row;
    }
    return true;
}

/// Those that corners and the apex are made of; all of A come before those of B.
static bool write_vertices(finding *w, int body)
{
    for (int k = 0; k < w->corners; ++k)
    {
        if ((int)(w->name[k] >> 32 & 1) != body) continue;
        for (int v = 0; v < vertices_of((int)(w->name[k] >> 40)); ++v)
            if (row_of_vertex(w->record, body, (int)(w->name[k] >> (24 - 8 * v) & 255)) < 0) return false;
    }
    return (w->bodies->wall && body == 0) || write_apex(w, body); // under the faces of what lies on a wall no depth counts
}

/// Plane by place, of A or of B, a wall's where it is.
static pls_half_space plane_at(const pls_record_bodies *c, const pls_overlap_record *r, int place)
{
    const int body = place >= PLS_RECORD_PLANES;
    if (body == 1 && c->wall) return (pls_half_space){c->front, pls_dot(c->front, c->start[1])};
    return pls_record_plane(c, body, r->plane[body][place - body * PLS_RECORD_PLANES]);
}

static pls_vec3 vertex_at(const pls_record_bodies *c, const pls_overlap_record *r, int row)
{
    return pls_record_vertex(c, row >= r->vertices[0], r->vertex[row]);
}

/// The first corner: a vertex or where an edge goes through a plane, as no two bodies overlap without.
pls_vec3 pls_record_origin(const pls_record_bodies *c, const pls_overlap_record *r)
{
    const uint8_t *of = r->corner[0];
    pls_vec3 x = vertex_at(c, r, of[0]);
    if (r->corners[PLS_CORNER_VERTEX] == 0)
    {
        const pls_half_space plane = plane_at(c, r, of[2]);
        const pls_vec3 end = vertex_at(c, r, of[1]);
        const double p = depth_under(&plane, x), q = depth_under(&plane, end);
        x = pls_add(x, pls_scale(pls_sub(end, x), (p < 0.0) != (q < 0.0) ? p / (p - q) : NAN)); // no corner: no origin
    }
    if (!c->wall) return x;
    const pls_half_space front = plane_at(c, r, PLS_RECORD_PLANES);
    return pls_add(x, pls_scale(c->front, depth_under(&front, x)));
}

bool pls_overlap_find(const pls_record_bodies *bodies, const uint64_t high[2], pls_overlap_record *out)
{
    finding w = {.bodies = bodies, .record = out};
    memset(out, 0, sizeof *out);
    out->high[0] = high[0], out->high[1] = high[1];
    take_planes(&w, 0), take_planes(&w, 1);
    if (!add_faces(&w, 0) || (!bodies->wall && !add_faces(&w, 1))) return false;
    if (w.open != 0 || w.corners == 0) return false;
    if (!write_vertices(&w, 0) || !write_vertices(&w, 1)) return false;
    write_corners(&w);
    out->known = 1;
    return true;
}
