// cylinder_touch.c -- a cylinder A on what has plane faces, B, by the volume of the overlap: the laws of faces.c, for which a cylinder would be a prism of infinitely many sides.
//
// Depth counts from B's faces alone, as at walls: with d the depth of a point below the nearest face of B, energies are integrals of d and d^2 over the overlap, and what pushes B are
// integrals of d nu and d^2 nu over A's surface in B (overlap_simd.c), nu its outward normal.
//
// Axes about a point on A's side, turned to B: x outwards, z along the axis, y across. At one y the cylinder is a rectangle of the width 2 sqrt(R^2 - y^2), and what lies in it
// nearest to one face of B, that face's cell, is a polygon: its moments, and those of its edges on A's surface, are closed forms. With y = R sin(phi), u = tan(phi/2) all of it is rational in
// u, but for where the outline gets another form: at corners of the cells and where their edges and planes pass A's ends and side. Between those Gauss points integrate to rounding.
//
// Lying on its side on a plane a cylinder has delta = 6/7 of its depth (faces.c: MANIFOLD), standing on its end all of it, on its rim 2/3.

#include "contact/cylinder_touch.h"

#include "contact/facet.h"
#include "contact/overlap_laws.h"
#include "contact/touch_area.h"
#include "math/gauss.h"
#include "shape/builtin.h"

#include <string.h>

enum {
    FACES = 64,          ///< most of a body
    CORNERS = 2 * FACES, ///< room for a polygon: it has four corners, and one more for each face that cuts it
    PLACES = 16 * FACES, ///< most where the outline changes: of the cells of so many faces never as many meet A
};

/// Of A's radius: that much beside the overlap a corner may still be one of it. One too many is no harm.
static const double spare = 1e-7;

/// Of u: places nearer to each other are one; what lies between has no volume.
static const double one_place = 1e-13;

/// Longest piece for one set of Gauss points: of the rational functions of u about 1e-15 is left.
static const double longest_piece = 0.5;

typedef struct cylinder
{
    double radius, low, high; ///< z of the ends
    int faces, planes;        ///< of B: those that depth counts from; all
    pls_half_space plane[FACES];
    int places;
    double place[PLACES]; ///< u
} cylinder;

static double depth_at(const pls_half_space *h, pls_vec3 x) { return h->offset - pls_dot(h->normal, x); }

// ---- where the outline changes ------------------------------------------------------------------------------------------------------------------------------

/// Where many faces meet, all threes of them meet in the same corner.
static void add_place(cylinder *q, double u)
{
    int k = q->places;
    while (k > 0 && q->place[k - 1] > u) --k;
    const bool known = (k > 0 && u - q->place[k - 1] < one_place) || (k < q->places && q->place[k] - u < one_place);
    if (known || q->places == PLACES) return;
    for (int j = q->places++; j > k; --j) q->place[j] = q->place[j - 1];
    q->place[k] = u;
}

/// If it is a point of the overlap; one as near to two or more faces is on the border of their cells only if no other one is nearer than `among`, one of them.
static void add_point(cylinder *q, pls_vec3 x, const pls_half_space *among)
{
    const double R = q->radius, some = spare * R, away = x.x + R;
    if (!(x.z > q->low - some && x.z < q->high + some && away * away + x.y * x.y < (R + some) * (R + some))) return;
    const double level = among ? fmax(depth_at(among, x), 0.0) : 0.0;
    for (int k = 0; k < q->planes; ++k)
        if (depth_at(&q->plane[k], x) < (k < q->faces ? level : 0.0) - some) return;
    const double sine = fmax(fmin(x.y / R, 1.0), -1.0);
    add_place(q, sine / (1.0 + sqrt((1.0 - sine) * (1.0 + sine))));
}

/// Where a plane passes the rims.
static void add_rims(cylinder *q, const pls_half_space *h, const pls_half_space *among)
{
    const double R = q->radius, a = R * h->normal.x, b = R * h->normal.y, most = sqrt(a * a + b * b);
    if (!(most > 0.0)) return;
    const double rest = a > 0.0 ? b * b / (most + a) : most - a;
    for (int end = 0; end < 2; ++end)
    {
        const double z = end ? q->high : q->low, versine = (rest - h->offset + h->normal.z * z) / most;
        if (!(versine >= 0.0 && versine <= 2.0)) continue;
        const double c = 1.0 - versine, s = sqrt(versine * (2.0 - versine));
        for (int side = -1; side <= 1; side += 2)
            add_point(q, pls_vec(R * ((a * c - side * b * s) / most - 1.0), R * (b * c + side * a * s) / most, z), among);
    }
}

/// Where the line of two planes passes A's surface.
static void add_line(cylinder *q, const pls_half_space *h, const pls_half_space *k, const pls_half_space *among)
{
    const pls_vec3 along = pls_cross(h->normal, k->normal);
    const double square = pls_dot(along, along);
    if (!(square > 0.0)) return;
    const pls_vec3 start = pls_scale(
        pls_add(pls_scale(pls_cross(k->normal, along), h->offset), pls_scale(pls_cross(along, h->normal), k->offset)), 1.0 / square);
    if (along.z != 0.0)
        for (int end = 0; end < 2; ++end)
            add_point(q, pls_add(start, pls_scale(along, ((end ? q->high : q->low) - start.z) / along.z)), among);
    const double x = start.x + q->radius, a = along.x * along.x + along.y * along.y, b = x * along.x + start.y * along.y,
                 c = x * x + start.y * start.y - q->radius * q->radius, root = b * b - a * c;
    if (!(a > 0.0) || !(root >= 0.0)) return;
    for (int side = -1; side <= 1; side += 2) add_point(q, pls_add(start, pls_scale(along, (side * sqrt(root) - b) / a)), among);
}

/// Where three planes meet.
static void add_corner(cylinder *q, const pls_half_space *h, const pls_half_space *k, const pls_half_space *l, const pls_half_space *among)
{
    const pls_vec3 kl = pls_cross(k->normal, l->normal), lh = pls_cross(l->normal, h->normal), hk = pls_cross(h->normal, k->normal);
    const double all = pls_dot(h->normal, kl);
    if (all == 0.0) return;
    const pls_vec3 x = pls_add(pls_add(pls_scale(kl, h->offset), pls_scale(lh, k->offset)), pls_scale(hk, l->offset));
    add_point(q, pls_scale(x, 1.0 / all), among);
}

/// The plane in which two faces are as near; within it f is nearer.
static pls_half_space between(const pls_half_space *f, const pls_half_space *g)
{
    return (pls_half_space){pls_sub(f->normal, g->normal), f->offset - g->offset};
}

static void find_places(cylinder *q)
{
    const pls_half_space *plane = q->plane;
    q->places = 0;
    for (int k = -1; k <= 1; ++k) add_place(q, k);
    for (int f = 0; f < q->planes; ++f)
    {
        add_rims(q, &plane[f], NULL);
        for (int g = f + 1; g < q->planes; ++g)
        {
            add_line(q, &plane[f], &plane[g], NULL);
            for (int h = g + 1; h < q->planes; ++h) add_corner(q, &plane[f], &plane[g], &plane[h], NULL);
        }
    }
    for (int f = 0; f < q->faces; ++f)
        for (int g = f + 1; g < q->faces; ++g)
        {
            const pls_half_space fg = between(&plane[f], &plane[g]);
            add_rims(q, &fg, &plane[f]);
            for (int h = g + 1; h < q->faces; ++h)
            {
                const pls_half_space fh = between(&plane[f], &plane[h]);
                add_line(q, &fg, &fh, &plane[f]);
                for (int k = h + 1; k < q->faces; ++k)
                {
                    const pls_half_space fk = between(&plane[f], &plane[k]);
                    add_corner(q, &fg, &fh, &fk, &plane[f]);
                }
            }
        }
}

// ---- slices ---------------------------------------------------------------------------------------------------------------------------------------------------

/// Of a polygon, and on which side of the rectangle the edge from here to the next one is: outer, upper, inner, lower; or INSIDE.
typedef struct corner
{
    double x, z;
    int side;
} corner;

enum { OUTER, UPPER, INNER, LOWER, INSIDE };

/// Depth in the slice.
typedef struct slope
{
    double start, x, z;
} slope;

static double value_at(const slope *s, const corner *p) { return s->start + s->x * p->x + s->z * p->z; }

/// What of the polygon has values above 0; at 0 is in if `border`.
static int clip(const corner *p, int count, const slope *s, bool border, corner *out)
{
    int left = 0;
    if (count == 0) return 0;
    const corner *now = &p[count - 1];
    double at_now = value_at(s, now);
    bool in_now = at_now > 0.0 || (border && at_now == 0.0);
    for (int k = 0; k < count && left < CORNERS - 1; ++k) // rounding errors of corners on the line may add some, never so many
    {
        const corner *next = &p[k];
        const double at_next = value_at(s, next);
        const bool in_next = at_next > 0.0 || (border && at_next == 0.0);
        if (in_next != in_now)
        {
            const double share = at_now / (at_now - at_next);
            out[left++] = (corner){now->x + share * (next->x - now->x), now->z + share * (next->z - now->z), in_next ? now->side : INSIDE};
        }
        if (in_next) out[left++] = *next;
        now = next, at_now = at_next, in_now = in_next;
    }
    return left;
}

/// The slice at y = R sine, of which d(phi) is `turn`.
typedef struct slice
{
    double sine, cosine, y, turn;
} slice;

/// Moments of a polygon of the cell whose depth is `s`.
static void add_polygon(const cylinder *q, const corner *p, int count, const slope *s, const slice *at, pls_overlap_integrals *P)
{
    const double thick = q->radius * at->cosine * at->turn, y = at->y;
    const double first = value_at(s, &p[0]);
    for (int k = 2; k < count; ++k)
    {
        const corner a = p[0], b = p[k - 1], c = p[k];
        const double db = value_at(s, &b), dc = value_at(s, &c), d = first + db + dc, dd = first * first + db * db + dc * dc;
        const double volume = 0.5 * thick * ((b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x));
        const double x = a.x + b.x + c.x, z = a.z + b.z + c.z, third = volume / 3.0, twelfth = volume / 12.0;
        P->volume += volume;
        P->by_depth.energy += third * d, P->by_its_square.energy += twelfth * (d * d + dd);
        P->first.x += third * x, P->first.y += volume * y, P->first.z += third * z;
        P->second[0] += twelfth * (x * x + a.x * a.x + b.x * b.x + c.x * c.x);
        P->second[1] += volume * y * y;
        P->second[2] += twelfth * (z * z + a.z * a.z + b.z * b.z + c.z * c.z);
        P->second[3] += third * x * y;
        P->second[4] += twelfth * (x * z + a.x * a.z + b.x * b.z + c.x * c.z);
        P->second[5] += third * z * y;
    }
}

/// With `moment`, the integral of d x, and `whole`, that of d.
static void add_push(pls_push *push, pls_vec3 normal, double whole, pls_vec3 moment)
{
    push->force = pls_add(push->force, pls_scale(normal, whole));
    push->torque = pls_add(push->torque, pls_cross(moment, normal));
}

/// The strip of A's surface along the edge from a to b.
static void add_strip(const cylinder *q, const corner *a, const corner *b, const slope *s, const slice *at, pls_overlap_integrals *P)
{
    const bool end = a->side == UPPER || a->side == LOWER;
    const double sign = a->side == UPPER || a->side == OUTER ? 1.0 : -1.0, width = q->radius * at->turn * (end ? at->cosine : 1.0);
    const pls_vec3 normal = end ? pls_vec(0.0, 0.0, sign) : pls_vec(sign * at->cosine, at->sine, 0.0);
    const double area = width * (fabs(b->x - a->x) + fabs(b->z - a->z)), p = value_at(s, a), r = value_at(s, b);
    const pls_vec3 x = pls_vec(a->x, at->y, a->z), y = pls_vec(b->x, at->y, b->z);
    P->surface += 2.0 * area; // B's is about as large
    P->area = pls_add(P->area, pls_scale(normal, area));
    P->area_moment = pls_add(P->area_moment, pls_cross(pls_scale(pls_add(x, y), 0.5 * area), normal));
    add_push(&P->by_depth, normal, 0.5 * area * (p + r),
             pls_add(pls_scale(x, area * (2.0 * p + r) / 6.0), pls_scale(y, area * (p + 2.0 * r) / 6.0)));
    const double pp = p * p, pr = p * r, rr = r * r;
    add_push(&P->by_its_square, normal, area * (pp + pr + rr) / 3.0,
             pls_add(pls_scale(x, area * (3.0 * pp + 2.0 * pr + rr) / 12.0), pls_scale(y, area * (pp + 2.0 * pr + 3.0 * rr) / 12.0)));
}

static void add_slice(const cylinder *q, const slice *at, double versine, pls_overlap_integrals *P)
{
    const double outer = -q->radius * versine, inner = q->radius * (versine - 2.0);
    const corner rectangle[4] = {{outer, q->low, OUTER}, {outer, q->high, UPPER}, {inner, q->high, INNER}, {inner, q->low, LOWER}};
    slope s[FACES];
    for (int k = 0; k < q->planes; ++k)
        s[k] = (slope){q->plane[k].offset - q->plane[k].normal.y * at->y, -q->plane[k].normal.x, -q->plane[k].normal.z};
    for (int f = 0; f < q->faces; ++f)
    {
        corner polygon[2][CORNERS];
        int now = 0, count = clip(rectangle, 4, &s[f], false, polygon[now]);
        for (int g = 0; g < q->planes && count > 0; ++g)
        {
            if (g == f) continue;
            const slope nearer = {s[g].start - s[f].start, s[g].x - s[f].x, s[g].z - s[f].z};
            count = clip(polygon[now], count, g < q->faces ? &nearer : &s[g], f < g, polygon[!now]);
            now = !now;
        }
        if (count < 3) continue;
        const corner *p = polygon[now];
        add_polygon(q, p, count, &s[f], at, P);
        for (int k = 0; k < count; ++k)
            if (p[k].side != INSIDE) add_strip(q, &p[k], &p[(k + 1) % count], &s[f], at, P);
    }
}

static void integrate(const cylinder *q, pls_overlap_integrals *P)
{
    *P = (pls_overlap_integrals){0};
    for (int k = 0; k + 1 < q->places; ++k)
    {
        const double low = q->place[k], length = q->place[k + 1] - low;
        const int pieces = (int)ceil(length / longest_piece);
        const double half = 0.5 * length / pieces;
        if (!(length > 0.0)) continue;
        for (int j = 0; j < 8 * pieces; ++j)
        {
            const int node = j % 8;
            const double u = low + half * (2 * (j / 8) + 1 + (node % 2 ? 1 : -1) * pls_gauss_node[node / 2]), by = 1.0 / (1.0 + u * u);
            const double versine = 2.0 * u * u * by, sine = 2.0 * u * by;
            const slice at = {sine, (1.0 - u * u) * by, q->radius * sine, 2.0 * half * pls_gauss_weight[node / 2] * by};
            add_slice(q, &at, versine, P);
        }
    }
}

// ---- the pair -------------------------------------------------------------------------------------------------------------------------------------------------

static bool has_faces(const pls_shape *s)
{
    return s->convex && s->polytope && s->polytope->face_count > 2 && s->polytope->face_count <= FACES && s->margin == 0.0;
}

/// Planes about a's position, in the world.
static int planes_of_body(const pls_posed *a, const pls_posed *b, double depth, double radius, double half_length,
                          pls_half_space plane[FACES])
{
    const pls_polytope *t = b->shape->polytope;
    int count = 0;
    for (uint32_t f = 0; f < t->face_count; ++f)
    {
        const pls_vec3 n = pls_posed_turn(b, t->face_normal[f]);
        const double offset = pls_dot(n, pls_sub(pls_posed_world(b, t->vertex[t->face_vertex[t->face_start[f]]]), a->position));
        const double along = pls_dot(n, a->z), across = sqrt(fmax(1.0 - along * along, 0.0)),
                     reach = radius * across + half_length * fabs(along);
        // Moved by the depth A leaves B, so that no point of the overlap is deeper in B.
        if (offset - reach > depth * (1.0 + 1e-6) + 1e-9 * radius) continue;
        plane[count++] = (pls_half_space){n, offset};
    }
    return count;
}

/// What is between a disc and a line has moments between.
static double lever_of(double small, double large)
{
    const double part = PLS_ARM_OF_LINE + (PLS_ARM_OF_DISC - PLS_ARM_OF_LINE) * small / large;
    return large > 0.0 ? part * sqrt(small + large) : 0.0;
}

/// Spread in the plane of touch and lever. Turning about its own axis brings no part of a cylinder nearer: dashpots must not see that as rocking, or they would brake what
/// rolls. Of turning about `ahead`, the axis' direction in the plane of touch, the cosine of axis and normal is left, by which what lies across counts.
void pls_cylinder_area(pls_vec3 axis, pls_touch *t)
{
    const pls_vec3 n = t->normal, level = pls_sub(axis, pls_scale(n, pls_dot(axis, n)));
    const pls_vec3 any = fabs(n.x) < 0.5 ? pls_vec(1.0, 0.0, 0.0) : pls_vec(0.0, 1.0, 0.0);
    const pls_vec3 ahead = pls_length(level) > 1e-8 ? pls_unit(level) : pls_unit(pls_sub(any, pls_scale(n, pls_dot(any, n))));
    const pls_vec3 across = pls_cross(n, ahead), of_ahead = pls_second_along(t->spread, ahead),
                   of_across = pls_second_along(t->spread, across);
    const double cosine = fabs(pls_dot(axis, n)), aa = fmax(pls_dot(ahead, of_ahead), 0.0), cc = fmax(pls_dot(across, of_across), 0.0);
    const double ac = pls_dot(across, of_ahead), mean = 0.5 * (aa + cc), apart = sqrt(0.25 * (aa - cc) * (aa - cc) + ac * ac);
    t->lever = lever_of(fmax(mean - apart, 0.0), mean + apart);
    const double s[3] = {aa, cosine * cosine * cc, cosine * ac};
    const double a[3] = {ahead.x, ahead.y, ahead.z}, c[3] = {across.x, across.y, across.z};
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int k = 0; k < 6; ++k)
    {
        const int i = row[k], j = column[k];
        t->spread[k] = s[0] * a[i] * a[j] + s[1] * c[i] * c[j] + s[2] * (a[i] * c[j] + c[i] * a[j]);
    }
}

static pls_vec3 turned(const pls_vec3 e[3], pls_vec3 x)
{
    return pls_add(pls_add(pls_scale(e[0], x.x), pls_scale(e[1], x.y)), pls_scale(e[2], x.z));
}

/// From axes of which e are the columns.
static void turn_integrals(const pls_vec3 e[3], pls_overlap_integrals *P)
{
    double *s = P->second;
    const pls_vec3 row[3] = {{s[0], s[3], s[4]}, {s[3], s[1], s[5]}, {s[4], s[5], s[2]}};
    pls_vec3 half[3];
    for (int k = 0; k < 3; ++k) half[k] = turned(e, row[k]);
    double out[6] = {0.0};
    for (int k = 0; k < 3; ++k)
    {
        out[0] += e[k].x * half[k].x, out[1] += e[k].y * half[k].y, out[2] += e[k].z * half[k].z;
        out[3] += e[k].x * half[k].y, out[4] += e[k].x * half[k].z, out[5] += e[k].y * half[k].z;
    }
    for (int k = 0; k < 6; ++k) s[k] = out[k];
    pls_vec3 *const vectors[] = {
        &P->first, &P->area, &P->area_moment, &P->by_depth.force, &P->by_depth.torque, &P->by_its_square.force, &P->by_its_square.torque};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; ++k) *vectors[k] = turned(e, *vectors[k]);
}

/// The core of a cylinder.
typedef struct core
{
    double margin, radius, half;
} core;

static core core_of(const pls_posed *a)
{
    const double margin = a->shape->margin * a->scale;
    return (core){margin, a->shape->values[0] * a->scale - margin, 0.5 * a->shape->values[1] * a->scale - margin};
}

/// So thin a core is soon below a wall as a whole, and then nothing pushes back.
static bool is_thin(core c) { return c.margin > c.radius || c.margin > c.half; }

/// Integrals over what of A is in q, whose planes are about A's position in the world; about the point of A's side next to `on_a` towards `towards`, which goes to `origin`.
static void overlap_of(cylinder *q, const pls_posed *a, core c, pls_vec3 towards, pls_vec3 on_a, pls_vec3 *origin, pls_overlap_integrals *P)
{
    const pls_vec3 lean = pls_sub(towards, pls_scale(a->z, pls_dot(a->z, towards)));
    pls_vec3 e[3] = {pls_length(lean) > 1e-8 ? pls_unit(lean) : a->x, {0.0, 0.0, 0.0}, a->z}; // of a cylinder that stands any side will do
    e[1] = pls_cross(e[2], e[0]);
    const double along = fmax(fmin(pls_dot(a->z, pls_sub(on_a, a->position)), c.half), -c.half);
    const pls_vec3 start = pls_add(pls_scale(e[0], c.radius), pls_scale(e[2], along));
    for (int k = 0; k < q->planes; ++k)
    {
        const pls_vec3 n = q->plane[k].normal;
        q->plane[k] =
            (pls_half_space){pls_vec(pls_dot(n, e[0]), pls_dot(n, e[1]), pls_dot(n, e[2])), q->plane[k].offset - pls_dot(n, start)};
    }
    q->radius = c.radius, q->low = -c.half - along, q->high = c.half - along;
    find_places(q);
    integrate(q, P);
    turn_integrals(e, P);
    *origin = pls_add(a->position, start);
}

/// Points move to half the depth, as those of other contacts: where they are in between does not matter to the normal force, but friction has its lever there.
static void move_to_middle(double below, double depth, pls_touch *t)
{
    const pls_vec3 deeper = pls_scale(t->normal, 0.5 * depth - below);
    t->point = pls_add(t->point, deeper), t->middle = pls_add(t->middle, deeper);
}

/// A is the cylinder.
static bool cylinder_on(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options, pls_touch *out)
{
    const bool ground = b->shape->ops->unbounded;
    const core c = core_of(a);
    if (!ground && (c.margin > 0.0 || !has_faces(b->shape))) return false;
    if (is_thin(c)) return false;
    cylinder q = {.faces = 1, .planes = 1};
    pls_half_space plane[FACES];
    pls_vec3 towards = depth->normal, origin = a->position;
    if (ground)
    {
        const pls_vec3 up = pls_posed_gradient(b, b->position);
        q.plane[0] = (pls_half_space){up, pls_dot(up, pls_sub(b->position, a->position)) + c.margin};
        towards = pls_scale(up, -1.0);
    }
    else
        q.faces = q.planes = planes_of_body(a, b, depth->delta, c.radius, c.half, q.plane);
    memcpy(plane, q.plane, (size_t)q.planes * sizeof *plane);

    pls_overlap_integrals P;
    overlap_of(&q, a, c, towards, depth->on_a, &origin, &P);
    pls_touch t = {.delta = 0.0};
    if (depth->delta <= 0.0 || !pls_overlap_touch(&P, options, PLS_OVERLAP_BLUR * a->size, false, &t))
        pls_overlap_none(depth, &t);
    else
    {
        t.point = pls_add(t.point, origin), t.middle = pls_add(t.middle, origin);
        pls_cylinder_area(a->z, &t);
        double below = INFINITY;
        for (int k = 0; k < q.faces; ++k) below = fmin(below, depth_at(&plane[k], pls_sub(t.point, a->position)));
        move_to_middle(below - c.margin, depth->delta, &t);
    }
    t.depth = t.reach = depth->delta;
    *out = t;
    return true;
}

bool pls_cylinder_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options, pls_touch *out)
{
    if (options->faces == PLS_FACES_POINT) return false;
    if (a->shape->ops == &pls_cylinder_shape) return cylinder_on(a, b, depth, options, out);
    if (b->shape->ops != &pls_cylinder_shape) return false;
    pls_depth other = *depth;
    other.normal = pls_scale(depth->normal, -1.0);
    other.on_a = depth->on_b, other.on_b = depth->on_a;
    if (!cylinder_on(b, a, &other, options, out)) return false;
    out->normal = pls_scale(out->normal, -1.0);
    return true;
}

bool pls_is_thick_cylinder(const pls_posed *a) { return a->shape->ops == &pls_cylinder_shape && !is_thin(core_of(a)); }

bool pls_cylinder_behind(const pls_posed *a, const pls_prism *prism, pls_vec3 *origin, pls_overlap_integrals *P)
{
    const core c = core_of(a);
    const pls_vec3 shift = pls_sub(a->position, *origin);
    cylinder q = {.faces = prism->faces, .planes = prism->planes};
    for (int k = 0; k < q.planes; ++k)
        q.plane[k] = (pls_half_space){prism->plane[k].normal, prism->plane[k].offset - pls_dot(prism->plane[k].normal, shift)};
    overlap_of(&q, a, c, pls_scale(prism->plane[0].normal, -1.0), *origin, origin, P);
    return P->volume > 0.0;
}
