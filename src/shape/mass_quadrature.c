// mass_quadrature.c -- mass, centre of mass and moments of anything given by an SDF.
//
// A cube about the shape is divided into eight (2D: a square into four) again and again. What lies deeper inside or further outside than its half diagonal is
// settled by one value of phi; what the surface passes through is measured along columns (column_quadrature.c), twice, and where the two differ most is divided
// first. Nothing but the SDF is used, and no property but that it is no steeper than a distance: neither convexity nor smoothness. Smooth parts, plane faces and
// edges need few cubes, corners some ten divisions. Convex shapes without sharp edges are seen from inside instead, through squares that are divided in the same way
// (star_quadrature.c): that takes a tenth of the calls.

#include "shape/mass_quadrature.h"

#include "base/alloc.h"
#include "shape/star_quadrature.h"

#include <string.h>

enum {
    MOST_CELLS = 60000, ///< after which the error is what it is
    FIRST = 3,          ///< divisions before any measuring
    APPROACHES = 6,     ///< to the surface
    NO_FACE = -1
};
static const double target = 5e-7; ///< relative error aimed at

/// A cube, or a square of directions if `face` is not NO_FACE (star_quadrature.h).
typedef struct cell
{
    double centre[3], half;
    int face;
    double sum[PLS_MOMENTS];
    double error;
} cell;

/// Cells that may be divided further, as a heap with the worst first, and what is settled.
typedef struct tree
{
    pls_column_frame frame;
    cell *heap;
    size_t count;
    double settled[PLS_MOMENTS];
    double volume, size; ///< of the whole, and its radius of gyration: units of errors
} tree;

// ---- the worst first: a heap ---------------------------------------------------------------------------------------------------------------------------

static void sink(cell *heap, size_t count, size_t k)
{
    for (size_t child; (child = 2 * k + 1) < count; k = child)
    {
        if (child + 1 < count && heap[child + 1].error > heap[child].error) ++child;
        if (heap[k].error >= heap[child].error) return;
        cell other = heap[k];
        heap[k] = heap[child];
        heap[child] = other;
    }
}

static void rise(cell *heap, size_t k)
{
    for (; k > 0 && heap[(k - 1) / 2].error < heap[k].error; k = (k - 1) / 2)
    {
        cell other = heap[k];
        heap[k] = heap[(k - 1) / 2];
        heap[(k - 1) / 2] = other;
    }
}

// ---- cells --------------------------------------------------------------------------------------------------------------------------------------------------

/// Moments of a whole cube (square) of uniform density.
static void full_cell(const cell *c, int dimension, double sum[PLS_MOMENTS])
{
    double edge = 2.0 * c->half, volume = dimension == 2 ? edge * edge : edge * edge * edge, own = c->half * c->half / 3.0;
    const double *x = c->centre;
    sum[0] = volume;
    for (int a = 0; a < 3; ++a)
    {
        sum[1 + a] = volume * x[a];
        sum[4 + a] = a < dimension ? volume * (x[a] * x[a] + own) : 0.0;
    }
    sum[7] = volume * x[0] * x[1], sum[8] = volume * x[0] * x[2], sum[9] = volume * x[1] * x[2];
}

static int split(const cell *c, int dimension, cell part[8])
{
    const int ways = c->face == NO_FACE ? dimension : 2, parts = 1 << ways;
    for (int k = 0; k < parts; ++k)
    {
        part[k] = (cell){.half = 0.5 * c->half, .face = c->face};
        for (int a = 0; a < ways; ++a) part[k].centre[a] = c->centre[a] + (k >> a & 1 ? part[k].half : -part[k].half);
    }
    return parts;
}

/// By one value of phi, if it is far enough from the surface.
static bool is_settled(const tree *t, cell *c)
{
    const pls_shape *shape = t->frame.shape;
    if (c->face != NO_FACE) return false;
    double phi = pls_column_phi(&t->frame, c->centre), diagonal = sqrt((double)shape->dimension) * c->half;
    memset(c->sum, 0, sizeof c->sum);
    if (fabs(phi) <= diagonal || (phi < 0.0 && t->frame.uneven)) return false;
    if (phi < 0.0) full_cell(c, shape->dimension, c->sum);
    return true;
}

static void add_to(double sum[PLS_MOMENTS], const double other[PLS_MOMENTS])
{
    for (int k = 0; k < PLS_MOMENTS; ++k) sum[k] += other[k];
}

/// By how much the surface enters a cell whose columns all saw nothing of it: at a corner or in the middle of a side it may pass between them. Towards the surface and
/// back into the cell, in turn, comes to where it enters most.
static double overlooked(const tree *t, const cell *c)
{
    const pls_column_frame *f = &t->frame;
    const int dimension = f->shape->dimension;
    double x[3] = {c->centre[0], c->centre[1], c->centre[2]}, most = 0.0, sign = c->sum[0] == 0.0 ? 1.0 : -1.0;
    for (int k = 0; k < APPROACHES; ++k)
    {
        double g[3], phi = pls_column_phi(f, x);
        most = fmax(most, -sign * phi);
        pls_column_gradient(f, x, g);
        double aim = phi + sign * 0.1 * c->half; // a little beyond the surface
        for (int a = 0; a < dimension; ++a) x[a] = fmin(fmax(x[a] - aim * g[a], c->centre[a] - c->half), c->centre[a] + c->half);
    }
    return most;
}

/// The largest of the differences of two sets of moments about `centre`, relative to the volume and the size of the whole.
static double difference(const tree *t, const double *a, const double *b, const double centre[3])
{
    double d[PLS_MOMENTS];
    for (int k = 0; k < PLS_MOMENTS; ++k) d[k] = a[k] - b[k];
    const double far[3] = {fabs(centre[0]) + t->size, fabs(centre[1]) + t->size, fabs(centre[2]) + t->size};
    double reach = fmax(far[0], fmax(far[1], far[2])), worst = fabs(d[0]) * reach * reach / (t->size * t->size);
    for (int k = 1; k < 4; ++k) worst = fmax(worst, fabs(d[k]) * reach / (t->size * t->size));
    for (int k = 4; k < PLS_MOMENTS; ++k) worst = fmax(worst, fabs(d[k]) / (t->size * t->size));
    return worst / t->volume;
}

static void measure(const tree *t, cell *c)
{
    double again[PLS_MOMENTS], volume = pow(2.0 * c->half, t->frame.shape->dimension);
    if (c->face != NO_FACE)
    {
        const double origin[3] = {0.0, 0.0, 0.0};
        pls_star_moments(&t->frame, c->face, c->centre, c->half, c->sum, again);
        c->error = difference(t, c->sum, again, origin);
        return;
    }
    pls_column_moments(&t->frame, c->centre, c->half, c->sum, again);
    c->error = difference(t, c->sum, again, c->centre);
    bool empty = c->sum[0] == 0.0, full = !t->frame.uneven && fabs(c->sum[0] - volume) <= 1e-12 * volume;
    if (!empty && !full) return;
    const double missed[PLS_MOMENTS] = {overlooked(t, c) * volume / c->half}, nothing[PLS_MOMENTS] = {0.0};
    c->error += difference(t, missed, nothing, c->centre);
}

static void push(tree *t, const cell *c)
{
    t->heap[t->count++] = *c;
    rise(t->heap, t->count - 1);
}

/// Divide a cell that is measured; gives the sum of the parts' errors. Where the parts say something else than the whole by more than all of them admit, some of the
/// surface was overlooked, by the whole or by a part: half of that is added to their errors.
static double divide(tree *t, const cell *whole)
{
    cell part[8];
    const int parts = split(whole, t->frame.shape->dimension, part);
    double together[PLS_MOMENTS] = {0.0}, error = 0.0;
    int open = 0;
    for (int k = 0; k < parts; ++k)
    {
        const bool settled = is_settled(t, &part[k]);
        if (!settled) measure(t, &part[k]);
        add_to(together, part[k].sum);
        if (settled)
            add_to(t->settled, part[k].sum);
        else
            error += part[k].error, part[open++] = part[k];
    }
    const double origin[3] = {0.0, 0.0, 0.0}, *about = whole->face == NO_FACE ? whole->centre : origin;
    const double overlooked_by = fmax(0.0, 0.5 * (difference(t, together, whole->sum, about) - whole->error - error));
    for (int k = 0; k < open; ++k)
    {
        part[k].error += overlooked_by / open;
        push(t, &part[k]);
    }
    return open > 0 ? error + overlooked_by : 0.0;
}

/// Divide `c` `times` times unmeasured, then measure and divide once more what is not settled.
static void plant(tree *t, const cell *c, int times)
{
    cell part[8];
    const int parts = split(c, t->frame.shape->dimension, part);
    for (int k = 0; k < parts; ++k)
    {
        if (is_settled(t, &part[k]))
            add_to(t->settled, part[k].sum);
        else if (times > 1)
            plant(t, &part[k], times - 1);
        else
        {
            measure(t, &part[k]);
            divide(t, &part[k]);
        }
    }
}

static double total(tree *t, double sum[PLS_MOMENTS])
{
    double error = 0.0;
    memcpy(sum, t->settled, sizeof t->settled);
    for (size_t c = 0; c < t->count; ++c)
    {
        error += t->heap[c].error;
        add_to(sum, t->heap[c].sum);
    }
    t->volume = fmax(fabs(sum[0]), 1e-300);
    double square = (sum[4] + sum[5] + sum[6] - (sum[1] * sum[1] + sum[2] * sum[2] + sum[3] * sum[3]) / t->volume) / t->volume;
    t->size = square > 0.0 ? sqrt(square) : t->frame.reach;
    return error;
}

/// Divide the worst; by how much the error changes.
static double divide_worst(tree *t)
{
    const cell worst = t->heap[0];
    t->heap[0] = t->heap[--t->count];
    sink(t->heap, t->count, 0);
    return divide(t, &worst) - worst.error;
}

// ---- all together ---------------------------------------------------------------------------------------------------------------------------------------------

/// Better seen from the origin: convex shapes without sharp edges.
static bool is_star(const tree *t)
{
    const pls_shape *shape = t->frame.shape;
    const double origin[3] = {0.0, 0.0, 0.0};
    if (shape->dimension == 2 || !shape->convex || t->frame.uneven || !(shape->ops->smooth || shape->margin > 0.0)) return false;
    return pls_column_phi(&t->frame, origin) < -0.01 * t->frame.reach;
}

/// Unit of errors, until they are known better: those of a ball that fills the reach.
static double refine(tree *t, double sum[PLS_MOMENTS])
{
    const cell all = {.half = t->frame.reach, .face = NO_FACE};
    t->size = t->frame.reach, t->volume = pow(t->frame.reach, t->frame.shape->dimension);
    if (is_star(t))
        for (int face = 0; face < 6; ++face)
        {
            cell side = {.half = 1.0, .face = face};
            measure(t, &side);
            divide(t, &side);
        }
    else
        plant(t, &all, FIRST);
    double error = total(t, sum);
    const pls_density_fault *fault = t->frame.uneven; // after which nothing counts any more
    for (size_t turn = 1; !(fault && fault->found) && t->count > 0 && t->count + 8 < MOST_CELLS && error > target; ++turn)
    {
        error += divide_worst(t);
        if (turn % 64 == 0 || error <= target) error = total(t, sum); // anew: differences leave round-off
    }
    return total(t, sum);
}

/// Moments of the turned frame about its origin, as those of the shape about the centre of mass.
static void tell(const tree *t, const double m[PLS_MOMENTS], pls_mass_properties *out)
{
    const pls_vec3 *e = t->frame.axis;
    const double c[3] = {m[1] / m[0], m[2] / m[0], m[3] / m[0]};
    double second[3][3], own[3][3] = {{0.0}};
    static const int place[3][3] = {{4, 7, 8}, {7, 5, 9}, {8, 9, 6}};
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) second[a][b] = m[place[a][b]] - m[0] * c[a] * c[b];
    out->volume = m[0];
    out->centre = t->frame.origin;
    for (int a = 0; a < 3; ++a) out->centre = pls_add(out->centre, pls_scale(e[a], c[a]));
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
        {
            const double p[3] = {e[a].x, e[a].y, e[a].z}, q[3] = {e[b].x, e[b].y, e[b].z};
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) own[i][j] += second[a][b] * p[i] * q[j];
        }
    out->inertia[2] = own[0][0] + own[1][1];
    if (t->frame.shape->dimension == 2) return;
    out->inertia[0] = own[1][1] + own[2][2];
    out->inertia[1] = own[0][0] + own[2][2];
    out->inertia[3] = -own[0][1];
    out->inertia[4] = -own[0][2];
    out->inertia[5] = -own[1][2];
}

/// A density that varies evenly is least at an end, where the points of the quadrature come close but do not lie.
static void try_ends(const pls_column_frame *frame)
{
    for (int k = 0; k < 27; ++k)
    {
        const pls_vec3 e = pls_vec(k % 3 - 1, k / 3 % 3 - 1, frame->shape->dimension == 3 ? k / 9 - 1 : 0);
        if (pls_dot(e, e) > 0.0) pls_column_density(frame, pls_shape_support(frame->shape, pls_unit(e)));
    }
}

static pls_status no_density(const pls_density_fault *fault)
{
    return pls_fail(PLS_INVALID_ARGUMENT,
                    "the density is %g times the material's at (%g, %g, %g) m; it must be positive and finite all over the shape",
                    fault->value, fault->at.x, fault->at.y, fault->at.z);
}

static pls_status by_quadrature(const pls_shape *shape, pls_density_fault *uneven, pls_vec3 origin, double reach, pls_mass_properties *out)
{
    // About (1, 1, 1) by 60 degrees all axes would have components of 1/3 and 2/3 along all others; a little off, so that nothing coincides.
    const pls_quat turn =
        shape->dimension == 2 ? (pls_quat){cos(0.29), 0.0, 0.0, sin(0.29)} : pls_quat_unit((pls_quat){0.866, 0.263, 0.291, 0.312});
    tree t = {.frame = {.shape = shape, .origin = origin, .reach = 1.001 * reach, .uneven = uneven}};
    double m[PLS_MOMENTS];
    *out = (pls_mass_properties){0};
    t.frame.axis[0] = pls_rotate(turn, pls_vec(1.0, 0.0, 0.0));
    t.frame.axis[1] = pls_rotate(turn, pls_vec(0.0, 1.0, 0.0));
    t.frame.axis[2] = pls_rotate(turn, pls_vec(0.0, 0.0, 1.0));
    if (uneven) try_ends(&t.frame);
    if (uneven && uneven->found) return no_density(uneven);
    PLS_TRY(pls_allocate(&t.heap, MOST_CELLS, sizeof *t.heap, "cells of the mass quadrature"));
    out->error = refine(&t, m);
    pls_release(&t.heap);
    if (uneven && uneven->found) return no_density(uneven);
    if (!(m[0] > 0.0)) return pls_fail(PLS_INVALID_ARGUMENT, "the shape has no volume: its SDF is negative nowhere");
    tell(&t, m, out);
    return PLS_OK;
}

pls_status pls_mass_by_quadrature(const pls_shape *shape, pls_vec3 origin, double reach, pls_mass_properties *out)
{
    return by_quadrature(shape, NULL, origin, reach, out);
}

pls_status pls_uneven_mass_by_quadrature(const pls_shape *shape, pls_vec3 origin, double reach, pls_mass_properties *out)
{
    pls_density_fault fault = {.found = false};
    return by_quadrature(shape, &fault, origin, reach, out);
}
