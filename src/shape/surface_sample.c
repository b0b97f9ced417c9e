// surface_sample.c -- cells of a lattice that the surface goes through, cut into tetrahedra (2D: triangles), on whose edges the SDF changes sign.
//
// In a tetrahedron the SDF is taken to be linear, so that the surface there is a triangle or a quadrangle; those of a cell make up one piece, at a random place of it, whose area is off by the
// square of the spacing (at edges of the body, which are cut across, by the spacing), and which is brought down to the surface itself. Values are kept for two layers of the lattice at a time.
//
// Inner balls are as large as lets their surface, looked at in some directions, stay inside. Depths inside would tell the same where they are true, but those of a union of parts are not.

#include "shape/surface_sample.h"

#include "base/alloc.h"
#include "base/random.h"
#include "shape/builtin.h"
#include "shape/distance_field.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum {
    PIECES = 12000,
    PIECES_OF_QUICK = 3000, ///< of cylinders and superquadrics, as these come by the thousand
    PIECES_2D = 1500,
    FIRST_SIDE = 24, ///< cells along the longest edge of the bounds when nothing is known
    MOST_SIDE = 160,
    TRIES = 4,
    LEAF = 12 ///< pieces in the smallest balls
};
static const double off_grid = 0.3819660112501051; ///< of a cell: bounds are places where surfaces like to lie
static const double little_bend = 0.1;             ///< curvature by that of a ball of the shape's size
static const double largest_inner = 0.2;           ///< radius of inner balls, of the shape's size
static const double inner_part =
    0.5; ///< of the ball that just fits: so it touches nothing but its piece, and no direction is missed by as much
static const double sticks_out = 1e-3; ///< of its radius: what a ball that fits may do, as surfaces and their normals are not exact

// ---- cells ----------------------------------------------------------------------------------------------------------------------------------------------

/// Corners of cells by bits: x 1, y 2, z 4. All tetrahedra have the diagonal from 0 to 7, the triangles that from 0 to 3.
static const uint8_t tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};
static const uint8_t triangles[2][3] = {{0, 1, 3}, {0, 2, 3}};

typedef struct lattice
{
    const pls_shape *shape;
    pls_vec3 start;
    double spacing;
    int side[3]; ///< cells
} lattice;

typedef struct pieces
{
    pls_surface_piece *entry;
    size_t count, capacity;
    double spacing; ///< of the lattice
} pieces;

static pls_vec3 corner_of(const lattice *g, int i, int j, int k)
{
    return pls_vec(g->start.x + i * g->spacing, g->start.y + j * g->spacing, g->shape->dimension == 2 ? 0.0 : g->start.z + k * g->spacing);
}

static lattice lay(const pls_shape *shape, double spacing)
{
    lattice g = {.shape = shape, .spacing = spacing};
    const pls_vec3 edge = pls_sub(shape->upper, shape->lower);
    const double length[3] = {edge.x, edge.y, edge.z};
    for (int a = 0; a < 3; ++a) g.side[a] = (int)ceil(length[a] / spacing + 2.0 * off_grid) + 1;
    if (shape->dimension == 2) g.side[2] = 1;
    const double before = (off_grid + 0.5) * spacing;
    g.start = pls_sub(shape->lower, pls_vec(before, before, before));
    return g;
}

static pls_vec3 crossing(pls_vec3 p, pls_vec3 q, double at_p, double at_q)
{
    return pls_add(p, pls_scale(pls_sub(q, p), at_p / (at_p - at_q)));
}

/// What a cell has of the surface, and a point of that drawn at random: middles lie in rows, and would meet a face that is aligned with the lattice all at once.
typedef struct cell_sum
{
    pls_random random;
    double area;
    pls_vec3 point, outward; ///< outward: integral of the normal
} cell_sum;

/// `outward`: normal times area, either way round; `out`: to the outside.
static void add_part(cell_sum *sum, pls_vec3 point, pls_vec3 outward, pls_vec3 out)
{
    const double area = pls_length(outward);
    sum->area += area;
    if (pls_random_uniform(&sum->random) * sum->area < area) sum->point = point;
    sum->outward = pls_add(sum->outward, pls_scale(outward, pls_dot(outward, out) < 0.0 ? -1.0 : 1.0));
}

static void add_segment(cell_sum *sum, pls_vec3 a, pls_vec3 b, pls_vec3 out)
{
    const pls_vec3 along = pls_sub(b, a);
    add_part(sum, pls_add(a, pls_scale(along, pls_random_uniform(&sum->random))), pls_vec(along.y, -along.x, 0.0), out);
}

static void add_triangle(cell_sum *sum, pls_vec3 a, pls_vec3 b, pls_vec3 c, pls_vec3 out)
{
    const pls_vec3 u = pls_sub(b, a), v = pls_sub(c, a);
    double s = pls_random_uniform(&sum->random), t = pls_random_uniform(&sum->random);
    if (s + t > 1.0) s = 1.0 - s, t = 1.0 - t;
    add_part(sum, pls_add(a, pls_add(pls_scale(u, s), pls_scale(v, t))), pls_scale(pls_cross(u, v), 0.5), out);
}

/// The surface in a simplex of `corners` corners.
static void cut_simplex(const uint8_t *simplex, int corners, const pls_vec3 *X, const double *phi, cell_sum *sum)
{
    uint8_t in[4], out[4];
    int ins = 0, outs = 0;
    for (int k = 0; k < corners; ++k)
        if (phi[simplex[k]] < 0.0)
            in[ins++] = simplex[k];
        else
            out[outs++] = simplex[k];
    if (ins == 0 || outs == 0) return;
    pls_vec3 at[4], outside = pls_vec(0.0, 0.0, 0.0);
    int count = 0;
    for (int i = 0; i < ins; ++i)
        for (int o = 0; o < outs; ++o)
        {
            at[count++] = crossing(X[in[i]], X[out[o]], phi[in[i]], phi[out[o]]);
            outside = pls_add(outside, pls_sub(X[out[o]], X[in[i]]));
        }
    if (corners == 3)
    {
        add_segment(sum, at[0], at[1], outside);
        return;
    }
    add_triangle(sum, at[0], at[1], at[2], outside);
    if (count == 4) add_triangle(sum, at[1], at[2], at[3], outside); // 0 1 3 2 go round
}

/// `number`: of the cell.
static pls_status add_cell(const lattice *g, uint64_t number, const pls_vec3 *X, const double *phi, pieces *out)
{
    cell_sum sum = {.random = pls_random_stream(1, number, PLS_FOR_POSITION)};
    if (g->shape->dimension == 2)
        for (int t = 0; t < 2; ++t) cut_simplex(triangles[t], 3, X, phi, &sum);
    else
        for (int t = 0; t < 6; ++t) cut_simplex(tetrahedra[t], 4, X, phi, &sum);
    const double straight = pls_length(sum.outward);
    if (!(straight > 0.0)) return PLS_OK;
    PLS_TRY(pls_reserve(&out->entry, &out->capacity, out->count + 1, sizeof *out->entry, "pieces of a surface"));
    // Down to the surface from outside, where the SDF is a true distance.
    const pls_vec3 n = pls_scale(sum.outward, 1.0 / straight);
    const pls_vec3 x = pls_shape_nearest(g->shape, pls_add(sum.point, pls_scale(n, 0.5 * g->spacing)));
    out->entry[out->count++] = (pls_surface_piece){.x = x, .n = n, .area = sum.area};
    return PLS_OK;
}

/// Values of layer k of the lattice's corners.
static void fill_layer(const lattice *g, int k, double *phi)
{
    for (int j = 0; j <= g->side[1]; ++j)
        for (int i = 0; i <= g->side[0]; ++i)
            phi[(size_t)j * (size_t)(g->side[0] + 1) + (size_t)i] = pls_shape_sdf(g->shape, corner_of(g, i, j, k));
}

static pls_status cut_layer(const lattice *g, int k, const double *below, const double *above, pieces *out)
{
    const int corners = g->shape->dimension == 2 ? 4 : 8;
    const size_t row = (size_t)(g->side[0] + 1);
    for (int j = 0; j < g->side[1]; ++j)
        for (int i = 0; i < g->side[0]; ++i)
        {
            pls_vec3 X[8];
            double phi[8];
            int in = 0;
            for (int c = 0; c < corners; ++c)
            {
                phi[c] = (c & 4 ? above : below)[(size_t)(j + (c >> 1 & 1)) * row + (size_t)(i + (c & 1))];
                in += phi[c] < 0.0;
            }
            if (in == 0 || in == corners) continue;
            for (int c = 0; c < corners; ++c) X[c] = corner_of(g, i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
            PLS_TRY(add_cell(g, ((uint64_t)k * (uint64_t)g->side[1] + (uint64_t)j) * (uint64_t)g->side[0] + (uint64_t)i, X, phi, out));
        }
    return PLS_OK;
}

static pls_status cut_cells(const lattice *g, pieces *out)
{
    const size_t layer = (size_t)(g->side[0] + 1) * (size_t)(g->side[1] + 1);
    double *phi = NULL;
    out->count = 0, out->spacing = g->spacing;
    PLS_TRY(pls_allocate(&phi, 2 * layer, sizeof *phi, "pieces of a surface"));
    pls_status status = PLS_OK;
    fill_layer(g, 0, phi);
    for (int k = 0; k < g->side[2] && status == PLS_OK; ++k)
    {
        double *below = phi + (k & 1 ? layer : 0), *above = phi + (k & 1 ? 0 : layer);
        if (g->shape->dimension == 3) fill_layer(g, k + 1, above);
        status = cut_layer(g, k, below, above, out);
    }
    pls_release(&phi);
    return status;
}

/// Until there are about as many as wanted: their number goes with the inverse square (2D: the inverse) of the spacing.
static pls_status find_pieces(const pls_shape *shape, size_t count, pieces *out)
{
    const pls_vec3 edge = pls_sub(shape->upper, shape->lower);
    const double longest = fmax(edge.x, fmax(edge.y, shape->dimension == 2 ? 0.0 : edge.z));
    double cells = FIRST_SIDE;
    for (int k = 0; k < TRIES; ++k)
    {
        const lattice g = lay(shape, longest / cells);
        PLS_TRY(cut_cells(&g, out));
        const double ratio = (double)count / (double)(out->count > 0 ? out->count : 1);
        if (ratio > 0.8 && ratio < 1.25) return PLS_OK;
        if (cells >= MOST_SIDE && ratio > 1.0) break;
        cells = fmin(cells * (shape->dimension == 2 ? ratio : sqrt(ratio)), MOST_SIDE);
        cells = fmax(cells, 4.0);
    }
    if (out->count > 0) return PLS_OK;
    return pls_fail(PLS_LIMIT_EXCEEDED,
                    "the surface of a '%s' goes through no cell of a lattice with %d along its longest edge: it is too thin",
                    shape->ops->name, (int)cells);
}

// ---- balls ----------------------------------------------------------------------------------------------------------------------------------------------

#define COMPARE(axis)                                                                                 \
    static int by_##axis(const void *a, const void *b)                                                \
    {                                                                                                 \
        const pls_vec3 p = ((const pls_surface_piece *)a)->x, q = ((const pls_surface_piece *)b)->x;  \
        const double d = p.axis - q.axis;                                                             \
        if (d != 0.0) return d < 0.0 ? -1 : 1;                                                        \
        const double e = (p.x - q.x) != 0.0 ? p.x - q.x : (p.y - q.y) != 0.0 ? p.y - q.y : p.z - q.z; \
        return e < 0.0 ? -1 : e > 0.0;                                                                \
    }
COMPARE(x)
COMPARE(y)
COMPARE(z)
#undef COMPARE

/// The ball about the pieces first .. last, and those within, halves of it along its longest edge.
static void add_balls(pls_surface_sample *s, uint32_t first, uint32_t last)
{
    static int (*const compare[3])(const void *, const void *) = {by_x, by_y, by_z};
    pls_surface_ball *ball = &s->ball[s->balls++];
    pls_vec3 low = s->piece[first].x, high = low;
    for (uint32_t k = first + 1; k < last; ++k)
    {
        const pls_vec3 x = s->piece[k].x;
        low = pls_vec(fmin(low.x, x.x), fmin(low.y, x.y), fmin(low.z, x.z));
        high = pls_vec(fmax(high.x, x.x), fmax(high.y, x.y), fmax(high.z, x.z));
    }
    *ball = (pls_surface_ball){.centre = pls_scale(pls_add(low, high), 0.5), .first = first, .last = last, .leaf = last - first <= LEAF};
    for (uint32_t k = first; k < last; ++k)
    {
        const pls_surface_piece *p = &s->piece[k];
        ball->radius = fmax(ball->radius, pls_length(pls_sub(p->inner, ball->centre)) + p->inner_radius);
    }
    if (!ball->leaf)
    {
        const pls_vec3 edge = pls_sub(high, low);
        const int axis = edge.x >= edge.y && edge.x >= edge.z ? 0 : edge.y >= edge.z ? 1 : 2;
        qsort(s->piece + first, last - first, sizeof *s->piece, compare[axis]);
        const uint32_t middle = first + (last - first) / 2;
        add_balls(s, first, middle);
        add_balls(s, middle, last);
    }
    ball->next = (uint32_t)s->balls;
}

// ---- flat places ----------------------------------------------------------------------------------------------------------------------------------------

/// Least curvature, by its size, of the surface at the pieces of a ball: normals change by S u over u along the surface; S by least squares.
static double least_bend(const pls_surface_sample *s, const pls_surface_ball *ball, bool flat)
{
    pls_vec3 n = pls_vec(0.0, 0.0, 0.0), middle = n;
    for (uint32_t k = ball->first; k < ball->last; ++k)
        n = pls_add(n, s->piece[k].n), middle = pls_add(middle, pls_scale(s->piece[k].x, 1.0 / (ball->last - ball->first)));
    if (!(pls_length(n) > 0.5 * (ball->last - ball->first))) return INFINITY; // an edge
    n = pls_unit(n);
    const pls_vec3 side =
        flat ? pls_vec(-n.y, n.x, 0.0) : pls_unit(fabs(n.x) < 0.7 ? pls_cross(n, pls_vec(1, 0, 0)) : pls_cross(n, pls_vec(0, 1, 0)));
    const pls_vec3 up = pls_cross(n, side);
    double uu = 0, uv = 0, vv = 0, nu_u = 0, nu_v = 0, nv_u = 0, nv_v = 0;
    for (uint32_t k = ball->first; k < ball->last; ++k)
    {
        const pls_vec3 x = pls_sub(s->piece[k].x, middle), normal = s->piece[k].n;
        const double u = pls_dot(x, side), v = flat ? 0.0 : pls_dot(x, up), a = pls_dot(normal, side), b = pls_dot(normal, up);
        uu += u * u, uv += u * v, vv += v * v;
        nu_u += a * u, nu_v += a * v, nv_u += b * u, nv_v += b * v;
    }
    if (flat) return uu > 0.0 ? fabs(nu_u / uu) : INFINITY;
    const double det = uu * vv - uv * uv;
    if (!(det > 1e-6 * uu * vv)) return INFINITY;
    const double sxx = (nu_u * vv - nu_v * uv) / det, syy = (nv_v * uu - nv_u * uv) / det;
    const double sxy = 0.5 * ((nu_v * uu - nu_u * uv) + (nv_u * vv - nv_v * uv)) / det;
    const double mean = 0.5 * (sxx + syy), half = sqrt(0.25 * (sxx - syy) * (sxx - syy) + sxy * sxy);
    return fmin(fabs(mean - half), fabs(mean + half));
}

static double flat_share(const pls_surface_sample *s, const pls_shape *shape)
{
    double all = 0.0, flat = 0.0;
    for (size_t b = 0; b < s->balls; ++b)
    {
        if (!s->ball[b].leaf) continue;
        double area = 0.0;
        for (uint32_t k = s->ball[b].first; k < s->ball[b].last; ++k) area += s->piece[k].area;
        all += area;
        if (least_bend(s, &s->ball[b], shape->dimension == 2) * shape->size < little_bend) flat += area;
    }
    return flat / all;
}

// ---- inner balls ----------------------------------------------------------------------------------------------------------------------------------------

/// Does the ball that touches the surface at x, n its normal there, lie in the shape? It does if its centre is as deep; if not, and depths are true, it sticks out where the surface is nearest.
static bool fits(const pls_shape *shape, pls_vec3 x, pls_vec3 n, double radius)
{
    const pls_vec3 centre = pls_sub(x, pls_scale(n, radius));
    const double out = sticks_out * radius;
    if (-pls_shape_sdf(shape, centre) >= radius - out) return true;
    const pls_vec3 g = pls_shape_gradient(shape, centre);
    if (pls_length(g) > 0.5 && pls_shape_sdf(shape, pls_add(centre, pls_scale(pls_unit(g), radius))) > out) return false;
    const bool flat = shape->dimension == 2;
    for (int k = 0; k < 27; ++k)
    {
        const pls_vec3 d = pls_vec(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        if ((flat && d.z != 0.0) || pls_dot(d, d) == 0.0) continue;
        if (pls_shape_sdf(shape, pls_add(centre, pls_scale(pls_unit(d), radius))) > out) return false;
    }
    return true;
}

/// By halving.
static double largest_ball(const pls_shape *shape, pls_vec3 x, pls_vec3 n, double most)
{
    enum { HALVINGS = 12 };
    double low = 0.0, high = most;
    if (fits(shape, x, n, high)) return high;
    for (int k = 0; k < HALVINGS; ++k)
    {
        const double middle = 0.5 * (low + high);
        *(fits(shape, x, n, middle) ? &low : &high) = middle;
    }
    return low;
}

static void find_inner(const pls_shape *shape, pls_surface_sample *s)
{
    const double most = largest_inner / inner_part * shape->size, aside = sticks_out * shape->size;
    for (size_t k = 0; k < s->count; ++k)
    {
        pls_surface_piece *p = &s->piece[k];
        // The cell's normal is that of its triangles. On an edge there is none, nor a ball.
        const pls_vec3 g = pls_shape_gradient(shape, pls_add(p->x, pls_scale(p->n, aside)));
        const pls_vec3 n = pls_length(g) > 0.5 ? pls_unit(g) : p->n;
        p->inner_radius = inner_part * largest_ball(shape, p->x, n, most);
        p->inner = pls_sub(p->x, pls_scale(n, p->inner_radius));
        s->largest_inner = fmax(s->largest_inner, p->inner_radius);
    }
}

// ---- the whole ------------------------------------------------------------------------------------------------------------------------------------------

static pls_status make(const pls_shape *shape, size_t count, pls_surface_sample *s)
{
    pieces found = {0};
    pls_status status = find_pieces(shape, count, &found);
    s->piece = found.entry, s->count = found.count, s->spacing = found.spacing;
    PLS_TRY(status);
    PLS_TRY(pls_allocate(&s->ball, 2 * s->count, sizeof *s->ball, "pieces of a surface"));
    find_inner(shape, s);
    add_balls(s, 0, (uint32_t)s->count);
    s->flat = flat_share(s, shape);
    return PLS_OK;
}

pls_status pls_surface_sample_make(const pls_shape *shape, size_t count, pls_surface_sample **out)
{
    *out = NULL;
    pls_surface_sample *s = NULL;
    PLS_TRY(pls_allocate(&s, 1, sizeof *s, "pieces of a surface"));
    pls_status status = make(shape, count, s);
    if (status == PLS_OK)
        *out = s;
    else
        pls_surface_sample_free(s);
    return status;
}

static size_t count_for(const pls_shape *shape)
{
    const bool quick = shape->ops == &pls_cylinder_shape || shape->ops == &pls_superquadric_shape;
    return shape->dimension == 2 ? PIECES_2D : quick ? PIECES_OF_QUICK : PIECES;
}

pls_status pls_shape_need_sample(const pls_shape *shape)
{
    if (shape->sample || shape->ops->unbounded || shape->part_count > 0 || !(shape->mass.volume > 0.0)) return PLS_OK;
    pls_surface_sample *made;
    pls_distance_field *field = NULL;
    PLS_TRY(pls_surface_sample_make(shape, count_for(shape), &made));
    const pls_status status = shape->ops == &pls_superquadric_shape ? pls_distance_field_make(shape, &field) : PLS_OK;
    if (status != PLS_OK)
    {
        pls_surface_sample_free(made);
        return status;
    }
    memcpy((char *)(uintptr_t)shape + offsetof(pls_shape, sample), &made, sizeof made); // kept with the shape, though it does not change it
    memcpy((char *)(uintptr_t)shape + offsetof(pls_shape, field), &field, sizeof field);
    return PLS_OK;
}

void pls_surface_sample_free(pls_surface_sample *sample)
{
    if (!sample) return;
    pls_release(&sample->piece);
    pls_release(&sample->ball);
    pls_release(&sample);
}
