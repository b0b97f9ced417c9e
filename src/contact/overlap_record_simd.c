// overlap_record_simd.c -- the overlap of two polyhedra from a record of its topology: corners, whether they fit, integrals.
//
// Integrals are those of overlap_simd.c, over the same triangles but for their order. Eight go at once, whatever the width of vectors.

#include "contact/overlap_record.h"

#include <string.h>

enum { BOTH = 2 * PLS_RECORD_PLANES, LANES = 8, PARTS = LANES / PLS_W };

/// Of lengths and of determinants of unit vectors: crossings flatter than this are not known well enough for a record.
static const double flat = 1e-5;

typedef struct scene
{
    double normal[3][BOTH] __attribute__((aligned(64)));
    double offset[BOTH] __attribute__((aligned(64)));
    pls_v4 row[BOTH];                   ///< planes by rows: normal, offset
    pls_v4 vertex[PLS_RECORD_VERTICES]; ///< x, y, z, 1
    pls_v4 corner[PLS_RECORD_CORNERS];  ///< x, y, z, depth in the other body
} scene;

static inline pls_v4 row_of(pls_vec3 a, double last) { return (pls_v4){a.x, a.y, a.z, last}; }

// ---- heights --------------------------------------------------------------------------------------------------------------------------------------------

/// PLS_W points to columns.
static inline void take_columns(const pls_vec3 *v, pls_vd column[3])
{
#if PLS_W == 8
    pls_vd r[3];
    memcpy(r, v, sizeof r);
    const pls_vd a = __builtin_shufflevector(r[0], r[1], 0, 3, 6, 9, 12, 15, 0, 0);
    const pls_vd b = __builtin_shufflevector(r[0], r[1], 1, 4, 7, 10, 13, 0, 0, 0);
    const pls_vd c = __builtin_shufflevector(r[0], r[1], 2, 5, 8, 11, 14, 0, 0, 0);
    column[0] = __builtin_shufflevector(a, r[2], 0, 1, 2, 3, 4, 5, 10, 13);
    column[1] = __builtin_shufflevector(b, r[2], 0, 1, 2, 3, 4, 8, 11, 14);
    column[2] = __builtin_shufflevector(c, r[2], 0, 1, 2, 3, 4, 9, 12, 15);
#else
    for (int k = 0; k < PLS_W; ++k) column[0][k] = v[k].x, column[1][k] = v[k].y, column[2][k] = v[k].z;
#endif
}

double PLS_SIMD(pls_overlap_heights)(const pls_polytope *polytope, pls_vec3 own, double start, double *height)
{
    const uint32_t vertices = polytope->vertex_count, whole = vertices / PLS_W * PLS_W;
    pls_vd highest = pls_vd_set(-INFINITY);
    for (uint32_t v = 0; v < whole; v += PLS_W)
    {
        pls_vd x[3];
        take_columns(polytope->vertex + v, x);
        const pls_vd h = start + (x[0] * own.x + x[1] * own.y + x[2] * own.z);
        highest = pls_vd_max(h, highest);
        memcpy(height + v, &h, sizeof h);
    }
    double most = -INFINITY;
    for (uint32_t v = whole; v < vertices; ++v)
    {
        height[v] = start + pls_dot(polytope->vertex[v], own);
        most = height[v] > most ? height[v] : most;
    }
    for (uint32_t v = vertices; v & (LANES - 1); ++v) height[v] = -INFINITY;
    for (int k = 0; k < PLS_W; ++k) most = highest[k] > most ? highest[k] : most;
    return most;
}

uint64_t PLS_SIMD(pls_overlap_high)(const double *height, uint32_t vertices, double lowest)
{
    uint64_t low = 0;
    for (uint32_t v = 0; v < vertices; v += PLS_W)
    {
        pls_vd h;
        memcpy(&h, height + v, sizeof h);
        low |= (uint64_t)pls_vd_less(h, pls_vd_set(lowest)) << v;
    }
    return ~low & (vertices < 64 ? ((uint64_t)1 << vertices) - 1 : ~(uint64_t)0);
}

// ---- planes and vertices --------------------------------------------------------------------------------------------------------------------------------

/// Axes of a body by rows, of which the last number is that of `last` along the axis.
typedef struct axes
{
    pls_v4 x, y, z;
} axes;

static inline axes axes_of(const pls_posed *p, double scale, pls_vec3 last)
{
    return (axes){row_of(pls_scale(p->x, scale), pls_dot(p->x, last)), row_of(pls_scale(p->y, scale), pls_dot(p->y, last)),
                  row_of(pls_scale(p->z, scale), pls_dot(p->z, last))};
}

static inline pls_v4 turned(const axes *e, pls_vec3 own)
{
    return e->x * pls_v4_set(own.x) + e->y * pls_v4_set(own.y) + e->z * pls_v4_set(own.z);
}

static void place_planes(const pls_record_bodies *c, const pls_overlap_record *r, int body, scene *s)
{
    const int first = body * PLS_RECORD_PLANES, last = first + r->planes[body], end = (last + LANES - 1) & ~(LANES - 1);
    if (body == 1 && c->wall)
        s->row[first] = row_of(c->front, 0.0);
    else
    {
        const pls_posed *p = c->body[body];
        const pls_polytope *t = p->shape->polytope;
        const axes e = axes_of(p, 1.0, c->start[body]);
        for (int k = first; k < last; ++k)
        {
            const int face = r->plane[body][k - first];
            const pls_vec3 own = t->face_normal[face];
            s->row[k] =
                turned(&e, own) + row_of(pls_vec(0.0, 0.0, 0.0), p->scale * pls_dot(own, t->vertex[t->face_vertex[t->face_start[face]]]));
        }
    }
    for (int k = last; k < end; ++k) s->row[k] = row_of(pls_vec(0.0, 0.0, 0.0), INFINITY);
    for (int k = first; k < end; k += PLS_W)
    {
        pls_vd column[4];
        pls_columns4(s->row + k, column);
        for (int a = 0; a < 3; ++a) pls_vd_store(&s->normal[a][k], column[a]);
        pls_vd_store(&s->offset[k], column[3]);
    }
}

static void place_vertices(const pls_record_bodies *c, const pls_overlap_record *r, scene *s)
{
    for (int body = 0, k = 0; body < 2; ++body)
    {
        const int last = k + r->vertices[body];
        if (k == last) continue;
        const pls_posed *p = c->body[body];
        const pls_v4 start = row_of(c->start[body], 1.0);
        const axes e = axes_of(p, p->scale, pls_vec(0.0, 0.0, 0.0));
        for (; k < last; ++k) s->vertex[k] = start + turned(&e, p->shape->polytope->vertex[r->vertex[k]]);
    }
}

// ---- corners --------------------------------------------------------------------------------------------------------------------------------------------

/// Depth of a point under a plane, given by rows.
static inline double under(pls_v4 plane, pls_v4 x) { return plane[3] - (plane[0] * x[0] + plane[1] * x[1] + plane[2] * x[2]); }

/// Where the edge between two vertices goes through a plane. False if it does not, clearly.
static inline bool cross(pls_v4 u, pls_v4 v, pls_v4 plane, double margin, pls_v4 *x)
{
    const double p = under(plane, u), q = under(plane, v), all = p - q;
    *x = u + (v - u) * pls_v4_set(p / all);
    const double least = fabs(p) < fabs(q) ? fabs(p) : fabs(q);
    return (p < 0.0) != (q < 0.0) && least > margin && fabs(all) > flat * (fabs(v[0] - u[0]) + fabs(v[1] - u[1]) + fabs(v[2] - u[2]));
}

static inline pls_vec3 normal_of(pls_v4 a) { return pls_vec(a[0], a[1], a[2]); }

/// Where three planes meet. False if they hardly do.
static inline bool meet(pls_v4 a, pls_v4 b, pls_v4 c, pls_v4 *x)
{
    const pls_vec3 p = normal_of(a), q = normal_of(b), r = normal_of(c);
    const pls_vec3 qr = pls_cross(q, r), rp = pls_cross(r, p), pq = pls_cross(p, q);
    const double volume = pls_dot(p, qr);
    const pls_vec3 sum = pls_add(pls_add(pls_scale(qr, a[3]), pls_scale(rp, b[3])), pls_scale(pq, c[3]));
    *x = row_of(pls_scale(sum, 1.0 / volume), 0.0);
    return fabs(volume) > flat;
}

/// Bit k: the depth under plane first + k is not greater than `than`.
static inline uint64_t not_deeper(const scene *s, int first, int count, pls_v4 x, double than)
{
    uint64_t bits = 0;
    for (int k = 0; k < count; k += PLS_W)
    {
        const int at = first + k;
        pls_vd d = pls_vd_load(&s->offset[at]);
        for (int a = 0; a < 3; ++a) d = pls_vd_less_product(pls_vd_load(&s->normal[a][at]), pls_vd_set(x[a]), d);
        bits |= (uint64_t)pls_vd_less(d, pls_vd_set(than)) << k;
    }
    return bits;
}

static inline uint64_t bit_of(uint8_t plane) { return (uint64_t)1 << (plane & (PLS_RECORD_PLANES - 1)); }

/// Is all of the body that has plane g deeper at x than `depth`, but for the planes of `ties`?
static inline bool is_least(const scene *s, const pls_overlap_record *r, uint8_t g, uint64_t ties, pls_v4 x, double depth)
{
    const int body = g >= PLS_RECORD_PLANES;
    return (not_deeper(s, body * PLS_RECORD_PLANES, r->planes[body], x, depth) & ~ties) == 0;
}

/// Each corner, its depth, and whether it fulfils what it should.
static bool place_corners(const pls_record_bodies *c, const pls_overlap_record *r, scene *s)
{
    const double margin = c->margin;
    bool fits = true;
    int k = 0, end = r->corners[PLS_CORNER_VERTEX];
    for (; k < end; ++k)
    {
        const uint8_t *of = r->corner[k];
        pls_v4 x = s->vertex[of[0]];
        const double depth = under(s->row[of[1]], x);
        fits &= depth > margin && is_least(s, r, of[1], bit_of(of[1]), x, depth + margin);
        x[3] = depth;
        s->corner[k] = x;
    }
    for (end += r->corners[PLS_CORNER_CROSS]; k < end; ++k)
    {
        const uint8_t *of = r->corner[k];
        pls_v4 x;
        fits &= cross(s->vertex[of[0]], s->vertex[of[1]], s->row[of[2]], margin, &x);
        fits &= is_least(s, r, of[2], bit_of(of[2]), x, margin);
        x[3] = 0.0;
        s->corner[k] = x;
    }
    for (end += r->corners[PLS_CORNER_LEAVE]; k < end; ++k)
    {
        const uint8_t *of = r->corner[k];
        pls_v4 x;
        fits &= cross(s->vertex[of[0]], s->vertex[of[1]], s->row[of[3]] - s->row[of[2]], margin, &x);
        const double depth = under(s->row[of[2]], x);
        fits &= depth > margin && is_least(s, r, of[2], bit_of(of[2]) | bit_of(of[3]), x, depth + margin);
        x[3] = depth;
        s->corner[k] = x;
    }
    for (end += r->corners[PLS_CORNER_MEET]; k < end; ++k)
    {
        const uint8_t *of = r->corner[k];
        pls_v4 x;
        fits &= meet(s->row[of[0]], s->row[of[2]] - s->row[of[1]], s->row[of[3]] - s->row[of[1]], &x);
        const double depth = under(s->row[of[1]], x);
        fits &= depth > margin && is_least(s, r, of[1], bit_of(of[1]) | bit_of(of[2]) | bit_of(of[3]), x, depth + margin);
        fits &= is_least(s, r, of[0], bit_of(of[0]), x, margin);
        x[3] = depth;
        s->corner[k] = x;
    }
    return fits;
}

// ---- triangles ------------------------------------------------------------------------------------------------------------------------------------------

/// Integrals over the surface of one body; FORCE to CONE by the depth, and the same once more by its square.
enum {
    SURFACE,
    VOLUME,
    FIRST,
    SECOND = FIRST + 3,
    AREA = SECOND + 6,
    MOMENT = AREA + 3,
    FORCE = MOMENT + 3,
    TORQUE = FORCE + 3,
    CONE = TORQUE + 3,
    SQUARES = CONE + 1,
    SUMS = SQUARES + 7,
    ROOM = 32
};

typedef struct sums
{
    pls_vd of[PARTS][ROOM];
} sums;

/// The first term or a further one of a sum.
static inline __attribute__((always_inline)) void put(pls_vd *of, int k, bool first, pls_vd term) { of[k] = first ? term : of[k] + term; }

static inline __attribute__((always_inline)) void put_product(pls_vd *of, int k, bool first, pls_vd x, pls_vd y)
{
    of[k] = first ? x * y : pls_vd_fma(x, y, of[k]);
}

/// u a + v b + w c.
static inline __attribute__((always_inline)) pls_vd in_all(pls_vd u, pls_vd a, pls_vd v, pls_vd b, pls_vd w, pls_vd c)
{
    return pls_vd_fma(w, c, pls_vd_fma(v, b, u * a));
}

static inline __attribute__((always_inline)) void add_wrench(pls_vd *of, bool first, const pls_vd n[3], pls_vd offset, pls_vd whole,
                                                             const pls_vd lever[3])
{
    for (int a = 0; a < 3; ++a)
    {
        put_product(of, a, first, n[a], whole);
        put(of, 3 + a, first, pls_vd_cross(lever, n, a));
    }
    put_product(of, 6, first, offset, whole);
}

/// PLS_W triangles. Returns bits of those that lie the wrong way round.
static inline __attribute__((always_inline)) unsigned integrate(const scene *s, const uint8_t (*triangle)[4], bool squares, bool first,
                                                                pls_vd *of)
{
    pls_vd a[4], b[4], c[4], plane[4];
    pls_v4 row[4][PLS_W];
    for (int k = 0; k < PLS_W; ++k)
    {
        for (int v = 0; v < 3; ++v) row[v][k] = s->corner[triangle[k][v]];
        row[3][k] = s->row[triangle[k][3]];
    }
    pls_columns4(row[0], a), pls_columns4(row[1], b), pls_columns4(row[2], c), pls_columns4(row[3], plane);
    const pls_vd *n = plane, offset = plane[3], p = a[3], q = b[3], r = c[3];
    const pls_vd e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, g[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    const pls_vd twice_area[3] = {pls_vd_cross(e, g, 0), pls_vd_cross(e, g, 1), pls_vd_cross(e, g, 2)};
    const pls_vd area = 0.5 * pls_vd_dot(n, twice_area);
    const pls_vd third = area * (1.0 / 3.0), twelfth = area * (1.0 / 12.0), sixtieth = area * (1.0 / 60.0);
    const pls_vd share = offset * twelfth;
    pls_vd sum[3], m[3];
    for (int k = 0; k < 3; ++k) sum[k] = a[k] + b[k] + c[k], m[k] = third * sum[k];
    put(of, SURFACE, first, area);
    put_product(of, VOLUME, first, offset, area);
    for (int k = 0; k < 3; ++k)
    {
        const int i = k == 2 ? 1 : 0, j = k == 0 ? 1 : 2; // xy, xz, yz
        put_product(of, FIRST + k, first, offset, m[k]);
        put_product(of, SECOND + k, first, share, pls_vd_fma(sum[k], sum[k], in_all(a[k], a[k], b[k], b[k], c[k], c[k])));
        put_product(of, SECOND + 3 + k, first, share, pls_vd_fma(sum[i], sum[j], in_all(a[i], a[j], b[i], b[j], c[i], c[j])));
        put_product(of, AREA + k, first, n[k], area);
        put(of, MOMENT + k, first, pls_vd_cross(m, n, k));
    }

    const pls_vd d = p + q + r, once = third * d;
    const pls_vd u = twelfth * (d + p), v = twelfth * (d + q), w = twelfth * (d + r);
    const pls_vd lever[3] = {in_all(u, a[0], v, b[0], w, c[0]), in_all(u, a[1], v, b[1], w, c[1]), in_all(u, a[2], v, b[2], w, c[2])};
    add_wrench(of + FORCE, first, n, offset, once, lever);
    if (squares)
    {
        const pls_vd dd = pls_vd_fma(d, d, in_all(p, p, q, q, r, r)), twice = twelfth * dd;
        const pls_vd f = sixtieth * pls_vd_fma(p + p, d + p, dd), h = sixtieth * pls_vd_fma(q + q, d + q, dd),
                     l = sixtieth * pls_vd_fma(r + r, d + r, dd);
        const pls_vd further[3] = {in_all(f, a[0], h, b[0], l, c[0]), in_all(f, a[1], h, b[1], l, c[1]), in_all(f, a[2], h, b[2], l, c[2])};
        add_wrench(of + SQUARES, first, n, offset, twice, further);
    }
    return pls_vd_less(area, pls_vd_set(0.0));
}

/// Lanes are added up in one order for all widths.
static inline void add_lanes(const sums *s, int count, double *total)
{
#if PLS_W == LANES
    for (int k = 0; k < count; k += LANES)
    {
        pls_vd r[LANES];
        for (int i = 0; i < LANES; ++i) r[i] = s->of[0][k + i];
        pls_transpose8_(r);
        pls_vd_store(total + k, ((r[0] + r[1]) + (r[2] + r[3])) + ((r[4] + r[5]) + (r[6] + r[7])));
    }
#else
    for (int k = 0; k < count; ++k)
    {
        double r[LANES];
        for (int i = 0; i < LANES; ++i) r[i] = s->of[i / PLS_W][k][i % PLS_W];
        total[k] = ((r[0] + r[1]) + (r[2] + r[3])) + ((r[4] + r[5]) + (r[6] + r[7]));
    }
#endif
}

static inline __attribute__((always_inline)) unsigned integrate_eight(const scene *s, const uint8_t (*triangle)[4], bool squares,
                                                                      bool first, sums *sum)
{
    unsigned wrong = 0;
    for (int part = 0; part < PARTS; ++part) wrong |= integrate(s, triangle + part * PLS_W, squares, first, sum->of[part]);
    return wrong;
}

/// All triangles of one surface. False if some lie the wrong way round.
static inline __attribute__((always_inline)) bool integrate_all(const scene *s, const uint8_t (*triangle)[4], int count, bool squares,
                                                                double *total)
{
    sums sum;
    for (int part = 0; part < PARTS; ++part) sum.of[part][ROOM - 1] = pls_vd_set(0.0); // the last eight are added up whole
    if (count == 0)                                                                    // all of the body lies in the other one, or nothing
    {
        memset(total, 0, ROOM * sizeof *total);
        return true;
    }
    unsigned wrong = integrate_eight(s, triangle, squares, true, &sum);
    for (int k = LANES; k < count; k += LANES) wrong |= integrate_eight(s, triangle + k, squares, false, &sum);
    add_lanes(&sum, squares ? SUMS : SQUARES, total);
    return wrong == 0;
}

// ---- the call -------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 vec_at(const double *a) { return pls_vec(a[0], a[1], a[2]); }

/// Integrals of d^2 and d^3 over one surface times minus the product of normals there and of the face from which depth counts: twice and three times the energies, without seams.
static void without_apex(const scene *s, const pls_overlap_record *r, int first, int count, double opposed[2])
{
    opposed[0] = opposed[1] = 0.0;
    for (int k = first; k < first + count; ++k)
    {
        const pls_v4 a = s->corner[r->triangle[k][0]], b = s->corner[r->triangle[k][1]], c = s->corner[r->triangle[k][2]];
        const pls_vec3 twice = pls_cross(pls_sub(normal_of(b), normal_of(a)), pls_sub(normal_of(c), normal_of(a)));
        const double p = a[3], q = b[3], t = c[3], d = p + q + t, squares = p * p + q * q + t * t;
        const double weight = -0.5 * pls_dot(normal_of(s->row[r->from[k]]), twice);
        opposed[0] += weight / 12.0 * (d * d + squares);
        opposed[1] += weight / 60.0 * (d * (d * d + 3.0 * squares) + 2.0 * (p * p * p + q * q * q + t * t * t));
    }
}

static pls_vec3 apex_of(const pls_overlap_record *r, int body, const scene *s)
{
    const pls_record_apex *apex = &r->apex[body];
    if (apex->kind == PLS_APEX_ON_PLANE)
    {
        const pls_v4 plane = s->row[apex->at[0]];
        return pls_scale(normal_of(plane), plane[3]);
    }
    const pls_vec3 point = normal_of(s->vertex[apex->at[0]]);
    if (apex->kind == PLS_APEX_VERTEX) return point;
    const pls_vec3 along = pls_sub(normal_of(s->vertex[apex->at[1]]), point);
    return pls_sub(point, pls_scale(along, pls_dot(point, along) / pls_dot(along, along)));
}

/// `total` from FORCE or SQUARES on.
static double energy_about(const double *total, pls_vec3 apex, int power)
{
    return (total[CONE - FORCE] - pls_dot(apex, vec_at(total))) / (3 + power);
}

/// `sign`: the body whose depth counts is pushed (1) or pushes (-1).
static void add_push(const double *total, double energy, double share, double sign, pls_push *p)
{
    const pls_vec3 force = vec_at(total);
    p->energy += share * energy;
    p->force = pls_add(p->force, pls_scale(force, sign * share));
    p->torque = pls_add(p->torque, pls_scale(vec_at(total + TORQUE - FORCE), sign * share));
}

/// Of the depth in the other body, and of its square.
static void take_energies(const scene *s, const pls_overlap_record *r, int own, bool squares, const double *total, double energy[2])
{
    if (r->apex[1 - own].kind == PLS_NO_APEX)
    {
        double opposed[2];
        without_apex(s, r, pls_record_first_triangle(r, own), r->triangles[own], opposed);
        energy[0] = opposed[0] / 2.0, energy[1] = opposed[1] / 3.0;
        return;
    }
    const pls_vec3 apex = apex_of(r, 1 - own, s);
    energy[0] = energy_about(total + FORCE, apex, 1), energy[1] = squares ? energy_about(total + SQUARES, apex, 2) : 0.0;
}

static void add_totals(const double *total, pls_overlap_integrals *out)
{
    out->surface += total[SURFACE];
    out->volume += total[VOLUME] / 3.0;
    out->first = pls_add(out->first, pls_scale(vec_at(total + FIRST), 0.25));
    for (int k = 0; k < 6; ++k) out->second[k] += total[SECOND + k] / 5.0;
}

bool PLS_SIMD(pls_overlap_recall)(const pls_record_bodies *bodies, const pls_overlap_record *record, bool squares,
                                  pls_overlap_integrals *out)
{
    scene s;
    place_vertices(bodies, record, &s);
    place_planes(bodies, record, 0, &s), place_planes(bodies, record, 1, &s);
    if (!place_corners(bodies, record, &s)) return false;
    *out = (pls_overlap_integrals){0};
    const double share = bodies->wall ? 1.0 : 0.5;
    for (int own = 0; own < (bodies->wall ? 1 : 2); ++own)
    {
        const int other = 1 - own, count = record->triangles[own];
        const uint8_t(*triangle)[4] = record->triangle + pls_record_first_triangle(record, own);
        double total[ROOM] __attribute__((aligned(64)));
        if (!(squares ? integrate_all(&s, triangle, count, true, total) : integrate_all(&s, triangle, count, false, total))) return false;
        if (own == 0) out->area = vec_at(total + AREA), out->area_moment = vec_at(total + MOMENT);
        add_totals(total, out);
        double energy[2];
        take_energies(&s, record, own, squares, total, energy);
        add_push(total + FORCE, energy[0], share, other ? 1.0 : -1.0, &out->by_depth);
        if (squares) add_push(total + SQUARES, energy[1], share, other ? 1.0 : -1.0, &out->by_its_square);
    }
    return true;
}
