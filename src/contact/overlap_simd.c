// overlap_simd.c -- integrals over the overlap P of two bodies, from the polygons that bound it.
//
// No polytope is built. The depth d under the faces of a body is continuous, d = min_f d_f with d_f = offset - n_f.x, and linear in the cell of points nearest to f. By
// the divergence theorem, with nu the outward normal of P:
//
//     integral of grad d dV       = integral of d nu dS             x cross grad d: d x cross nu             likewise d^2
//     (D + 1) integral of d dV    = integral of d (x - p).nu dS     if all faces go through p, so that d is homogeneous about it (D: dimension)
//     (D + 2) integral of d^2 dV  = integral of d^2 (x - p).nu dS
//     D, D + 1, D + 2 integrals of 1, x, x (x) x dV = integrals of (1, x, x (x) x) x.nu dS
//
// On a body's own faces d vanishes, so what pushes by the depth in B are the faces of A in B, and the other way round. Cells matter where a polygon is split by which face of the
// other body is nearest (mostly one), and for the energy where faces do not all meet in one corner. There
//
//     integral of d^m dV = 1/(m+1) [ - integral of n_f.nu d^(m+1) dS + sum over pairs f, g of |n_f - n_g| integral over S_fg of d^(m+1) dS ],
//
// with S_fg the part of the plane d_f = d_g in P where both are least: two cells meet there. Mostly all terms are positive.
//
// Polygons are cut one by one, so they need not close exactly: a corner on a plane may be in for one and out for another, by slivers as wide as rounding errors, in which the d of
// one body is as small. Faces of both bodies in one plane would count twice or not at all in the volume: where outlines are cut, B is larger by `blur`. And an S_fg in the plane of a face belongs
// to P or not as the points of that face are nearest to g or to f: both is asked a `blur` inside.
//
// Polygons are split into triangles, over which the integrals of products of linear functions have closed forms; these go through the vector unit four at a time. Lanes are
// added up in one order for all instruction sets.

#include "contact/overlap.h"

#include <string.h>

enum {
    POLYGON = 4 * PLS_MOST_FACES, ///< most corners: of a face of 256, cut by 256 planes and 255 neighbours, and some to spare
    BATCH = 64,                   ///< triangles
    CODED = 64,                   ///< planes in the bits of a word
};

typedef struct polygon
{
    int count;
    pls_v4 x[POLYGON + 2]; ///< x, y, z; clip() writes up to two beyond the last
} polygon;

/// Triangles by rows.
typedef struct batch
{
    int count;
    pls_v4 corner[3][BATCH];                            ///< x, y, z, depth
    pls_v4 plane[BATCH];                                ///< normal, offset
    double opposed[BATCH] __attribute__((aligned(32))); ///< minus the product of normal and that of the face from which depth counts
} batch;

/// Integrals over the triangles; index 0: with d, 1: with d^2.
typedef struct sums
{
    pls_v4 surface, volume, first[3], second[6], area[3], area_moment[3];
    pls_v4 force[2], force_y[2], force_z[2], torque[2], torque_y[2], torque_z[2];
    pls_v4 cone[2];    ///< times offset
    pls_v4 opposed[2]; ///< d^2 and d^3 times `opposed`
} sums;

typedef struct work
{
    polygon one, two, piece, spare;
    pls_v4 waiting
        [2 *
         POLYGON]; ///< parts of a polygon that are to be split further; they lie side by side, so that all have together no more corners
    batch batch;
    double depth[POLYGON];
    double plane[4][PLS_MOST_FACES]
        __attribute__((aligned(32))); ///< of the other body by columns, the last one several times: normals, offsets
    double at_middle[PLS_MOST_FACES] __attribute__((aligned(32)));
    uint64_t cuts[PLS_MOST_CORNERS], beyond[PLS_MOST_CORNERS]; ///< of a corner: planes of the other body that it may lie, and lies, beyond
    double round;                                              ///< 1; in the plane 0, where z does not count for distances
    bool seen_a[PLS_MOST_FACES], seen_b[PLS_MOST_FACES];       ///< faces that have a part in P, or are nearest to a part of the surface
} work;

// ---- lanes ----------------------------------------------------------------------------------------------------------------------------------------------

static inline double sum(pls_v4 a) { return (a[0] + a[1]) + (a[2] + a[3]); }

/// Bit k set where lane k of a is less than that of b.
static inline unsigned less(pls_v4 a, pls_v4 b)
{
#if defined(__AVX2__)
    return (unsigned)_mm256_movemask_pd(_mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LT_OQ));
#else
    const pls_v4i m = a < b;
    return (unsigned)((m[0] & 1) | (m[1] & 2) | (m[2] & 4) | (m[3] & 8));
#endif
}

static inline pls_v4 row_of(pls_vec3 a, double last) { return (pls_v4){a.x, a.y, a.z, last}; }

static inline void transpose(const pls_v4 *row, pls_v4 column[4])
{
    const pls_v4 a = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6), b = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
    const pls_v4 c = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6), d = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
    column[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), column[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    column[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7), column[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

// ---- polygons -------------------------------------------------------------------------------------------------------------------------------------------

static inline void add_corner(polygon *p, pls_vec3 a) { p->x[p->count++] = row_of(a, 0.0); }

static inline double depth_of(const polygon *p, int k, const pls_half_space *h)
{
    const pls_v4 x = p->x[k];
    return h->offset - (h->normal.x * x[0] + h->normal.y * x[1] + h->normal.z * x[2]);
}

/// Squared distance of the furthest corner from the origin.
static double extent_of(const polygon *p, double round)
{
    double most = 0.0;
    for (int k = 0; k < p->count; ++k)
    {
        const pls_v4 x = p->x[k];
        const double square = x[0] * x[0] + x[1] * x[1] + round * (x[2] * x[2]);
        most = square > most ? square : most;
    }
    return most;
}

static void take_outline(const pls_near_body *s, int f, bool flat, polygon *p)
{
    p->count = 0;
    const uint32_t *at = s->face[f].outline;
    if (flat) // the side of a slab
    {
        const pls_vec3 a = s->corner[at[0]], b = s->corner[at[1]];
        add_corner(p, pls_vec(a.x, a.y, -0.5)), add_corner(p, pls_vec(b.x, b.y, -0.5));
        add_corner(p, pls_vec(b.x, b.y, 0.5)), add_corner(p, pls_vec(a.x, a.y, 0.5));
    }
    else
        for (int k = 0; k < s->face[f].corners; ++k) add_corner(p, s->corner[at[k]]);
}

/// Of a plane all that is within `reach` of the origin; empty if it is further away.
static void take_square(const pls_half_space *h, double reach, bool flat, polygon *p)
{
    const pls_vec3 n = h->normal, middle = pls_scale(n, h->offset);
    p->count = 0;
    if (fabs(h->offset) > reach) return;
    const pls_vec3 up = flat ? pls_vec(0.0, 0.0, 0.5)
                             : pls_scale(pls_unit(fabs(n.x) < fabs(n.y) ? pls_vec(0.0, n.z, -n.y) : pls_vec(-n.z, 0.0, n.x)), reach);
    const pls_vec3 side = pls_scale(pls_cross(up, n), flat ? 2.0 * reach : 1.0);
    for (int k = 0; k < 4; ++k)
    {
        const pls_vec3 along = pls_scale(side, k == 1 || k == 2 ? 1.0 : -1.0), across = pls_scale(up, k < 2 ? -1.0 : 1.0);
        add_corner(p, pls_add(middle, pls_add(along, across)));
    }
}

/// Depths of the corners; how many are in.
static inline int take_depths(const polygon *p, const pls_half_space *h, double *depth)
{
    int kept = 0;
    for (int k = 0; k < p->count; ++k)
    {
        const double d = depth_of(p, k, h);
        depth[k] = d;
        kept += d >= 0.0;
    }
    return kept;
}

/// What lies in the half-space. Returns `p` if all does, else `to`.
static polygon *clip(work *w, polygon *p, const pls_half_space *h, polygon *to)
{
    double *depth = w->depth;
    const int count = p->count, kept = take_depths(p, h, depth);
    if (kept == count) return p;
    to->count = 0;
    if (kept == 0) return to;
    // Nothing foretells branches here: corners are written and count if they should.
    pls_v4 *x = to->x, *const end = to->x + POLYGON, before = p->x[count - 1];
    double depth_before = depth[count - 1];
    int in_before = depth_before >= 0.0;
    for (int k = 0; k < count && x < end; ++k)
    {
        const pls_v4 now = p->x[k];
        const double d = depth[k];
        const int in = d >= 0.0;
        *x = before + (now - before) * (depth_before / (depth_before - d));
        x += in ^ in_before;
        *x = now;
        x += in;
        before = now, depth_before = d, in_before = in;
    }
    to->count = (int)(x - to->x);
    return to;
}

static inline polygon *other_of(work *w, const polygon *p) { return p == &w->one ? &w->two : &w->one; }

/// Of the planes whose bits are set, and those without bit, the first from f on.
static inline int next_plane(uint64_t cuts, int f)
{
    if (f >= CODED) return f;
    const uint64_t rest = cuts >> f;
    return rest ? f + __builtin_ctzll(rest) : CODED;
}

/// Cut `p` by those planes of the body whose bits are set, and those without bit. They are moved outwards by `blur`, for an outline of B's in a plane with normal `own` that plane.
static polygon *clip_by_body(work *w, polygon *p, const pls_near_body *s, uint64_t cuts, const pls_vec3 *own, double blur)
{
    double extent = INFINITY;
    for (int f = next_plane(cuts, 0); f < s->planes && p->count > 0;)
    {
        const int next = next_plane(cuts, f + 1);
        pls_half_space h = s->face[f].plane;
        const double least = h.offset - fabs(blur);
        f = next;
        if (least > 0.0 && least * least > extent) continue; // beyond all corners
        h.offset += own ? -blur * pls_dot(h.normal, *own) : blur;
        polygon *left = clip(w, p, &h, other_of(w, p));
        if (left == p) continue;
        p = left;
        if (next < s->planes) extent = extent_of(p, w->round);
    }
    return p;
}

static inline pls_v4 depths_of_point(const work *w, int f, double x, double y, double z)
{
    return pls_v4_load(&w->plane[3][f]) -
           (pls_v4_load(&w->plane[0][f]) * x + pls_v4_load(&w->plane[1][f]) * y + pls_v4_load(&w->plane[2][f]) * z);
}

/// Planes of `other`, and those of them beyond which the corners of `s` lie.
static void take_planes(work *w, const pls_near_body *s, const pls_near_body *other, double blur)
{
    const int count = other->planes, coded = count < CODED ? count : CODED;
    for (int f = 0; f < ((count + 3) & ~3); ++f)
    {
        const pls_half_space *h = &other->face[f < count ? f : count - 1].plane;
        w->plane[0][f] = h->normal.x, w->plane[1][f] = h->normal.y, w->plane[2][f] = h->normal.z, w->plane[3][f] = h->offset;
    }
    const pls_v4 in = pls_v4_set(blur), out = pls_v4_set(-blur);
    for (int c = 0; c < s->corners; ++c)
    {
        const pls_vec3 x = s->corner[s->used[c]];
        uint64_t cuts = 0, beyond = 0;
        for (int f = 0; f < coded; f += 4)
        {
            const pls_v4 d = depths_of_point(w, f, x.x, x.y, x.z);
            cuts |= (uint64_t)less(d, in) << f;
            beyond |= (uint64_t)less(d, out) << f;
        }
        w->cuts[s->used[c]] = cuts, w->beyond[s->used[c]] = beyond;
    }
}

// ---- triangles ----------------------------------------------------------------------------------------------------------------------------------------------

static void integrate(batch *b, sums *s)
{
    while (b->count & 3) // lanes without a triangle
    {
        const int k = b->count++;
        b->corner[0][k] = b->corner[1][k] = b->corner[2][k] = b->plane[k] = (pls_v4){0, 0, 0, 0};
        b->opposed[k] = 0.0;
    }
    for (int k = 0; k < b->count; k += 4)
    {
        pls_v4 column[4][4];
        for (int c = 0; c < 3; ++c) transpose(&b->corner[c][k], column[c]);
        transpose(&b->plane[k], column[3]);
        const pls_v4 ax = column[0][0], ay = column[0][1], az = column[0][2], p = column[0][3];
        const pls_v4 bx = column[1][0], by = column[1][1], bz = column[1][2], q = column[1][3];
        const pls_v4 cx = column[2][0], cy = column[2][1], cz = column[2][2], r = column[2][3];
        const pls_v4 nx = column[3][0], ny = column[3][1], nz = column[3][2], offset = column[3][3];
        const pls_v4 opposed = pls_v4_load(&b->opposed[k]);
        const pls_v4 ux = bx - ax, uy = by - ay, uz = bz - az, vx = cx - ax, vy = cy - ay, vz = cz - az;
        const pls_v4 area = 0.5 * (nx * (uy * vz - uz * vy) + ny * (uz * vx - ux * vz) + nz * (ux * vy - uy * vx));
        const pls_v4 third = area * (1.0 / 3.0), twelfth = area * (1.0 / 12.0), sixtieth = area * (1.0 / 60.0);

        // Moments of the triangle.
        const pls_v4 sx = ax + bx + cx, sy = ay + by + cy, sz = az + bz + cz;
        const pls_v4 mx = third * sx, my = third * sy, mz = third * sz, share = offset * twelfth;
        s->surface += area;
        s->volume += offset * area;
        s->first[0] += offset * mx, s->first[1] += offset * my, s->first[2] += offset * mz;
        s->second[0] += share * (sx * sx + ax * ax + bx * bx + cx * cx);
        s->second[1] += share * (sy * sy + ay * ay + by * by + cy * cy);
        s->second[2] += share * (sz * sz + az * az + bz * bz + cz * cz);
        s->second[3] += share * (sx * sy + ax * ay + bx * by + cx * cy);
        s->second[4] += share * (sx * sz + ax * az + bx * bz + cx * cz);
        s->second[5] += share * (sy * sz + ay * az + by * bz + cy * cz);
        s->area[0] += nx * area, s->area[1] += ny * area, s->area[2] += nz * area;
        s->area_moment[0] += my * nz - mz * ny, s->area_moment[1] += mz * nx - mx * nz, s->area_moment[2] += mx * ny - my * nx;

        // Integral of d^m times the barycentric coordinates: a polynomial in d at the corners.
        const pls_v4 d = p + q + r, dd = d * d, squares = p * p + q * q + r * r, cubes = p * p * p + q * q * q + r * r * r;
        const pls_v4 once = third * d, twice = twelfth * (dd + squares), thrice = sixtieth * (d * (dd + 3.0 * squares) + 2.0 * cubes);
        const pls_v4 of_a[2] = {twelfth * (d + p), sixtieth * (dd + squares + 2.0 * p * (d + p))};
        const pls_v4 of_b[2] = {twelfth * (d + q), sixtieth * (dd + squares + 2.0 * q * (d + q))};
        const pls_v4 of_c[2] = {twelfth * (d + r), sixtieth * (dd + squares + 2.0 * r * (d + r))};
        const pls_v4 whole[2] = {once, twice};
        for (int m = 0; m < 2; ++m)
        {
            const pls_v4 x = of_a[m] * ax + of_b[m] * bx + of_c[m] * cx, y = of_a[m] * ay + of_b[m] * by + of_c[m] * cy,
                         z = of_a[m] * az + of_b[m] * bz + of_c[m] * cz;
            s->force[m] += nx * whole[m], s->force_y[m] += ny * whole[m], s->force_z[m] += nz * whole[m];
            s->torque[m] += y * nz - z * ny, s->torque_y[m] += z * nx - x * nz, s->torque_z[m] += x * ny - y * nx;
            s->cone[m] += offset * whole[m];
        }
        s->opposed[0] += opposed * twice, s->opposed[1] += opposed * thrice;
    }
    b->count = 0;
}

/// A polygon in the plane `lies`, with the depth from the face `from`.
static void add_polygon(work *w, const polygon *p, const pls_half_space *lies, const pls_half_space *from, double opposed, sums *s)
{
    batch *b = &w->batch;
    const pls_v4 plane = row_of(lies->normal, lies->offset);
    pls_v4 first = p->x[0], last = p->x[1];
    first[3] = depth_of(p, 0, from), last[3] = depth_of(p, 1, from);
    for (int k = 2; k < p->count; ++k)
    {
        if (b->count == BATCH) integrate(b, s);
        const int t = b->count++;
        pls_v4 next = p->x[k];
        next[3] = depth_of(p, k, from);
        b->corner[0][t] = first, b->corner[1][t] = last, b->corner[2][t] = next;
        b->plane[t] = plane;
        b->opposed[t] = opposed;
        last = next;
    }
}

// ---- faces of one body in the other -------------------------------------------------------------------------------------------------------------------------

/// Where face f is nearer than g.
static pls_half_space nearer(const pls_near_body *s, int f, int g)
{
    return (pls_half_space){pls_sub(s->face[g].plane.normal, s->face[f].plane.normal), s->face[g].plane.offset - s->face[f].plane.offset};
}

static double opposed(const pls_half_space *f, const pls_half_space *g) { return -pls_dot(f->normal, g->normal); }

/// Both parts of a polygon, of which some corners are in and some are not; `depth` as taken. Returns the number of corners of `out`.
static int part(const polygon *p, const double *depth, polygon *in, pls_v4 *out)
{
    pls_v4 *x = in->x, *y = out, before = p->x[p->count - 1];
    double depth_before = depth[p->count - 1];
    int in_before = depth_before >= 0.0;
    for (int k = 0; k < p->count; ++k)
    {
        const pls_v4 now = p->x[k];
        const double d = depth[k];
        const int is_in = d >= 0.0, crosses = is_in ^ in_before;
        *x = *y = before + (now - before) * (depth_before / (depth_before - d));
        x += crosses, y += crosses;
        *x = *y = now;
        x += is_in, y += 1 - is_in;
        before = now, depth_before = d, in_before = is_in;
    }
    in->count = (int)(x - in->x);
    return (int)(y - out);
}

/// Faces of s that some point of the polygon may be nearest to, first that to which its middle is.
static int faces_about(work *w, const polygon *p, const pls_near_body *s, int *list)
{
    pls_v4 middle = p->x[0];
    for (int k = 1; k < p->count; ++k) middle += p->x[k];
    middle *= pls_v4_set(1.0 / p->count);
    double reach = 0.0; // squared
    for (int k = 0; k < p->count; ++k)
    {
        const pls_v4 x = p->x[k] - middle;
        const double square = x[0] * x[0] + x[1] * x[1] + w->round * (x[2] * x[2]);
        reach = square > reach ? square : reach;
    }
    for (int f = 0; f < s->faces; f += 4) pls_v4_store(&w->at_middle[f], depths_of_point(w, f, middle[0], middle[1], middle[2]));
    int nearest = 0;
    double least = w->at_middle[0];
    for (int f = 1; f < s->faces; ++f)
    {
        const bool less_deep = w->at_middle[f] < least;
        least = less_deep ? w->at_middle[f] : least, nearest = less_deep ? f : nearest;
    }
    // Away from the middle the difference of two depths changes by |n_f - n_g| per length.
    int count = 1;
    list[0] = nearest;
    const pls_v4 x = pls_v4_set(w->plane[0][nearest]), y = pls_v4_set(w->plane[1][nearest]), z = pls_v4_set(w->plane[2][nearest]);
    for (int f = 0; f < s->faces; f += 4)
    {
        const pls_v4 u = pls_v4_load(&w->plane[0][f]) - x, v = pls_v4_load(&w->plane[1][f]) - y, t = pls_v4_load(&w->plane[2][f]) - z;
        const pls_v4 more = pls_v4_load(&w->at_middle[f]) - least;
        unsigned may = less(more * more, (u * u + v * v + t * t) * reach);
        for (; may; may &= may - 1)
        {
            const int g = f + __builtin_ctz(may);
            if (g != nearest && g < s->faces) list[count++] = g;
        }
    }
    return count;
}

/// A part of P's surface, split by which face of s is nearest to the points just inside.
static void add_split(work *w, polygon *p, const pls_half_space *lies, const pls_near_body *s, double blur, bool *seen, sums *sum)
{
    struct
    {
        int start, nearest, next;
    } wait[PLS_MOST_FACES];
    int list[PLS_MOST_FACES];
    const int count = faces_about(w, p, s, list);
    int waiting = 0, top = 0, nearest = list[0], next = 1;
    for (;;)
    {
        for (; next < count; ++next)
        {
            pls_half_space h = nearer(s, nearest, list[next]);
            h.offset += blur * pls_dot(h.normal, lies->normal);
            const int kept = take_depths(p, &h, w->depth), corners = p->count;
            if (kept == corners) continue;
            if (kept > 0 && top + 2 * corners < 2 * POLYGON && 2 * corners < POLYGON)
            {
                polygon *left = p == &w->piece ? &w->spare : &w->piece;
                wait[waiting].start = top, wait[waiting].nearest = list[next], wait[waiting].next = next + 1;
                ++waiting;
                top += part(p, w->depth, left, w->waiting + top);
                p = left;
            }
            else
                nearest = list[next];
        }
        seen[nearest] = true;
        add_polygon(w, p, lies, &s->face[nearest].plane, opposed(lies, &s->face[nearest].plane), sum);
        if (waiting == 0) return;
        --waiting;
        p = &w->piece;
        p->count = top - wait[waiting].start;
        top = wait[waiting].start, nearest = wait[waiting].nearest, next = wait[waiting].next;
        for (int k = 0; k < p->count; ++k) p->x[k] = w->waiting[top + k];
    }
}

/// Faces of `own` in `other`.
static void add_faces(work *w, const pls_near_body *own, const pls_near_body *other, bool own_is_b, double blur, bool *own_seen, bool *seen,
                      sums *sum)
{
    take_planes(w, own, other, blur);
    for (int f = 0; f < own->faces; ++f)
    {
        const pls_near_face *face = &own->face[f];
        if (!face->enters) continue;
        uint64_t cuts = 0, beyond = ~(uint64_t)0;
        for (int k = 0; k < face->corners; ++k) cuts |= w->cuts[face->outline[k]], beyond &= w->beyond[face->outline[k]];
        if (beyond) continue;
        take_outline(own, f, w->round == 0.0, &w->one);
        polygon *p = clip_by_body(w, &w->one, other, cuts, own_is_b ? &face->plane.normal : NULL, blur);
        if (p->count == 0) continue;
        own_seen[f] = true;
        add_split(w, p, &face->plane, other, blur, seen, sum);
    }
}

/// Sides of the prism behind a facet, in `a`. Those that are faces have no depth, but a share in the volume.
static void add_sides(work *w, const pls_near_body *facet, const pls_near_body *a, double blur, sums *sum)
{
    for (int f = 1; f < facet->planes; ++f)
    {
        const pls_half_space *side = &facet->face[f].plane;
        take_square(side, facet->reach, w->round == 0.0, &w->one);
        polygon *p = &w->one;
        for (int g = 0; g < facet->planes && p->count > 0; ++g)
            if (g != f) p = clip(w, p, &facet->face[g].plane, other_of(w, p));
        if (p->count > 0) p = clip_by_body(w, p, a, ~(uint64_t)0, &side->normal, blur);
        if (p->count == 0) continue;
        if (f < facet->faces)
            add_polygon(w, p, side, side, 0.0, sum);
        else
            add_split(w, p, side, facet, 0.0, w->seen_b, sum);
    }
}

// ---- energies -----------------------------------------------------------------------------------------------------------------------------------------------

static bool has_corner(const pls_near_body *s, int f, uint32_t corner)
{
    for (int k = 0; k < s->face[f].corners; ++k)
        if (s->face[f].outline[k] == corner) return true;
    return false;
}

/// A point that the planes of all faces of the list go through; for one or two faces that next to the origin.
static bool common_point(const pls_near_body *s, const int *list, int count, pls_vec3 *point)
{
    *point = pls_scale(s->face[list[0]].plane.normal, s->face[list[0]].plane.offset);
    if (count == 1) return true;
    int found = 0;
    pls_vec3 corner[2] = {{0, 0, 0}};
    for (int k = 0; k < s->face[list[0]].corners && found < 2; ++k)
    {
        const uint32_t c = s->face[list[0]].outline[k];
        int i = 1;
        while (i < count && has_corner(s, list[i], c)) ++i;
        if (i == count) corner[found++] = s->corner[c];
    }
    *point = corner[0];
    if (found == 2)
    {
        const pls_vec3 along = pls_sub(corner[1], corner[0]);
        *point = pls_sub(*point, pls_scale(along, pls_dot(*point, along) / pls_dot(along, along)));
    }
    return found > 0;
}

/// Integrals of d^2 and d^3 over where two cells meet, times the difference of their normals.
static void add_seams(work *w, const pls_near_body *s, const int *list, int count, const pls_near_body *other, double blur, double seam[2])
{
    sums sum_of;
    memset(&sum_of, 0, sizeof sum_of);
    const double reach = s->reach < other->reach ? s->reach : other->reach;
    for (int i = 0; i < count; ++i)
        for (int j = i + 1; j < count; ++j)
        {
            pls_half_space h = nearer(s, list[i], list[j]);
            const double length = pls_length(h.normal);
            if (!(length > 0.0)) continue;
            h = (pls_half_space){pls_scale(h.normal, 1.0 / length), h.offset / length};
            take_square(&h, reach, w->round == 0.0, &w->one);
            polygon *p = &w->one;
            if (p->count > 0) p = clip(w, p, &s->face[list[i]].plane, other_of(w, p));
            for (int k = 0; k < count && p->count > 0; ++k)
            {
                if (k == i || k == j) continue;
                const pls_half_space g = nearer(s, list[i], list[k]);
                p = clip(w, p, &g, other_of(w, p));
            }
            for (int f = s->faces; f < s->planes && p->count > 0; ++f) p = clip(w, p, &s->face[f].plane, other_of(w, p)); // of a prism
            if (p->count > 0) p = clip_by_body(w, p, other, ~(uint64_t)0, NULL, -blur);
            if (p->count > 0) add_polygon(w, p, &h, &s->face[list[i]].plane, length, &sum_of);
        }
    integrate(&w->batch, &sum_of);
    for (int m = 0; m < 2; ++m) seam[m] = sum(sum_of.opposed[m]);
}

static pls_vec3 force_of(const sums *s, int m) { return pls_vec(sum(s->force[m]), sum(s->force_y[m]), sum(s->force_z[m])); }
static pls_vec3 torque_of(const sums *s, int m) { return pls_vec(sum(s->torque[m]), sum(s->torque_y[m]), sum(s->torque_z[m])); }

/// What the depth under the faces of s gives, by integrals over the surface of P, `closed`, and over the other body's part of it, `pushing`; `sign`: s is pushed (1) or pushes (-1).
static void add_pushes(work *w, const pls_near_body *s, const bool *seen, const pls_near_body *other, const sums *closed,
                       const sums *pushing, int dimension, double blur, double share, double sign, pls_overlap_integrals *out)
{
    int list[PLS_MOST_FACES], count = 0;
    for (int f = 0; f < s->faces; ++f)
        if (seen[f]) list[count++] = f;
    if (count == 0) return;
    pls_vec3 point;
    const bool cone = common_point(s, list, count, &point);
    double seam[2] = {0.0, 0.0};
    if (!cone) add_seams(w, s, list, count, other, blur, seam);
    for (int m = 0; m < 2; ++m)
    {
        pls_push *p = m == 0 ? &out->by_depth : &out->by_its_square;
        const double energy = cone ? (sum(closed->cone[m]) - pls_dot(point, force_of(closed, m))) / (dimension + 1 + m)
                                   : (sum(closed->opposed[m]) + seam[m]) / (2 + m);
        p->energy += share * energy;
        p->force = pls_add(p->force, pls_scale(force_of(pushing, m), sign * share));
        p->torque = pls_add(p->torque, pls_scale(torque_of(pushing, m), sign * share));
    }
}

// ---- the call -----------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 vec_of(const pls_v4 v[3], double scale) { return pls_scale(pls_vec(sum(v[0]), sum(v[1]), sum(v[2])), scale); }

static void add_moments(const sums *s, int dimension, pls_overlap_integrals *out)
{
    out->surface += sum(s->surface);
    out->volume += sum(s->volume) / dimension;
    out->first = pls_add(out->first, vec_of(s->first, 1.0 / (dimension + 1)));
    for (int k = 0; k < 6; ++k) out->second[k] += sum(s->second[k]) / (dimension + 2);
}

void PLS_SIMD(pls_overlap_integrate)(const pls_near_body *a, const pls_near_body *b, int dimension, double blur, pls_overlap_integrals *out)
{
    work w;
    w.batch.count = 0;
    w.round = dimension == 2 ? 0.0 : 1.0;
    memset(w.seen_a, 0, (size_t)a->faces * sizeof *w.seen_a);
    memset(w.seen_b, 0, (size_t)b->faces * sizeof *w.seen_b);
    const bool wall = !b->face[0].outline;
    const double share = wall ? 1.0 : 0.5;
    *out = (pls_overlap_integrals){0};

    sums in_b, closed;
    memset(&in_b, 0, sizeof in_b);
    add_faces(&w, a, b, false, wall && b->planes == 1 ? 0.0 : blur, w.seen_a, w.seen_b, &in_b);
    integrate(&w.batch, &in_b);
    out->area = vec_of(in_b.area, 1.0), out->area_moment = vec_of(in_b.area_moment, 1.0);
    closed =
        in_b; // the front of a wall lies at no depth and, as seen from an origin on it, has no share in the volume; the sides of a prism do
    if (wall && b->planes > 1)
    {
        add_sides(&w, b, a, blur, &closed);
        integrate(&w.batch, &closed);
    }
    add_moments(&closed, dimension, out);
    if (wall)
    {
        add_pushes(&w, b, w.seen_b, a, &closed, &in_b, dimension, blur, share, 1.0, out);
        return;
    }
    sums in_a;
    memset(&in_a, 0, sizeof in_a);
    add_faces(&w, b, a, true, blur, w.seen_b, w.seen_a, &in_a);
    integrate(&w.batch, &in_a);
    add_moments(&in_a, dimension, out);
    add_pushes(&w, b, w.seen_b, a, &in_b, &in_b, dimension, blur, share, 1.0, out);
    add_pushes(&w, a, w.seen_a, b, &in_a, &in_a, dimension, blur, share, -1.0, out);
}

void PLS_SIMD(pls_overlap_seams)(const pls_near_body *s, const int *list, int count, const pls_near_body *other, int dimension, double blur,
                                 double seam[2])
{
    work w;
    w.batch.count = 0;
    w.round = dimension == 2 ? 0.0 : 1.0;
    add_seams(&w, s, list, count, other, blur, seam);
}
