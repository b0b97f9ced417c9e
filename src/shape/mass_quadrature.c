// mass_quadrature.c -- mass, centre of mass and moments of anything given by an SDF, by quadrature along rays.
//
// In polar coordinates about a point the moments of a shape are integrals over directions of what lies on a ray: the pieces of it where phi < 0, in closed form
// for a uniform density. Pieces are found by sphere tracing (|phi| is free of surface) and a root finder, so neither convexity nor any other property is used.
// Directions: spherical triangles, beginning with those of an icosahedron (2D: arcs), each by a rule of fifth degree, the worst halved until the sum of the
// estimated errors is small: smooth shapes take a few thousand rays, edges of polyhedra some 1e5.

#include "shape/mass_quadrature.h"

#include "base/alloc.h"

#include <string.h>

enum {
    MOMENTS = 10,       ///< 1, x, y, z, xx, yy, zz, xy, xz, yz
    MOST_CELLS = 80000, ///< after which the error is what it is
    MOST_PIECES = 64    ///< of a ray inside the shape
};
static const double target = 2e-8;      ///< relative error aimed at
static const double sharpness = 1e-12;  ///< of crossings, of the size
static const double relaxation = 1.8;   ///< of the steps along a ray
static const double smooth_gain = 64.0; ///< by which the error of a smooth cell shrinks when it is halved

typedef struct ray_source
{
    const pls_shape *shape;
    pls_vec3 origin;
    double reach; ///< the shape ends before this
} ray_source;

static double phi_at(const ray_source *s, pls_vec3 e, double t)
{
    return s->shape->ops->sdf(s->shape, pls_add(s->origin, pls_scale(e, t)));
}

/// Where phi changes sign between a and b (Ridders' method).
static double crossing(const ray_source *s, pls_vec3 e, double a, double fa, double b, double fb)
{
    double x = b;
    for (int k = 0; k < 60 && fabs(b - a) > sharpness * s->reach; ++k)
    {
        double m = 0.5 * (a + b), fm = phi_at(s, e, m), root = sqrt(fm * fm - fa * fb);
        if (root == 0.0) return m;
        x = m + (m - a) * ((fa >= fb ? 1.0 : -1.0) * fm / root);
        double fx = phi_at(s, e, x);
        if (fabs(fx) <= 0.01 * sharpness * s->reach) return x;
        if ((fm < 0.0) != (fx < 0.0))
        {
            if (m < x)
                a = m, fa = fm, b = x, fb = fx;
            else
                a = x, fa = fx, b = m, fb = fm;
        }
        else if ((fa < 0.0) != (fx < 0.0))
            b = x, fb = fx;
        else
            a = x, fa = fx;
    }
    return x;
}

static double power_integral(double a, double b, int power) { return (pow(b, power + 1) - pow(a, power + 1)) / (power + 1); }

/// Add the piece a .. b of a ray: integrals of t^(d - 1), t^d, t^(d + 1) times the density.
static void add_piece(const ray_source *s, pls_vec3 e, double a, double b, double line[3])
{
    static const double node[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    static const double weight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    const int first = s->shape->dimension - 1;
    if (!s->shape->ops->density)
    {
        for (int p = 0; p < 3; ++p) line[p] += power_integral(a, b, first + p);
        return;
    }
    double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    for (int k = 0; k < 8; ++k)
    {
        double t = middle + (k & 1 ? half : -half) * node[k / 2];
        double density = s->shape->ops->density(s->shape, pls_add(s->origin, pls_scale(e, t))) * weight[k / 2] * half;
        for (int p = 0; p < 3; ++p) line[p] += density * pow(t, first + p);
    }
}

/// What lies on a ray.
static void ray_moments(const ray_source *s, pls_vec3 e, double out[MOMENTS])
{
    const double least = 1e-7 * s->reach;
    double line[3] = {0.0, 0.0, 0.0}, t = 0.0, phi = phi_at(s, e, 0.0), begun = 0.0;
    bool inside = phi < 0.0;
    while (t < s->reach)
    {
        // Within |phi| there is no surface, so of two points less than the sum of theirs apart none lies between unless the sign changes: look further than |phi|,
        // and go back to it where that leaves a gap (over-relaxation, Keinert et al. 2014).
        double step = fmax(relaxation * fabs(phi), least), value = phi_at(s, e, t + step);
        if ((value < 0.0) == inside && step > fabs(phi) + fabs(value) && step > least)
        {
            step = fmax(fabs(phi), least);
            value = phi_at(s, e, t + step);
        }
        if ((value < 0.0) != inside)
        {
            double at = crossing(s, e, t, phi, t + step, value);
            if (inside) add_piece(s, e, begun, at, line);
            if (inside && s->shape->convex) break;
            inside = !inside;
            begun = at;
        }
        t += step;
        phi = value;
    }
    if (inside && t >= s->reach) add_piece(s, e, begun, s->reach, line);
    const double x[3] = {e.x, e.y, e.z};
    out[0] = line[0];
    for (int a = 0; a < 3; ++a)
    {
        out[1 + a] = line[1] * x[a];
        out[4 + a] = line[2] * x[a] * x[a];
    }
    out[7] = line[2] * x[0] * x[1];
    out[8] = line[2] * x[0] * x[2];
    out[9] = line[2] * x[1] * x[2];
}

// ---- cells of directions ----------------------------------------------------------------------------------------------------------------------------------

/// A triangle of points on the unit sphere; 2D: an arc from corner[0] to corner[1].
typedef struct cell
{
    pls_vec3 corner[3];
    double sum[MOMENTS];
    double error;
} cell;

static void add_ray(const ray_source *s, pls_vec3 x, double weight, double sum[MOMENTS])
{
    double m[MOMENTS];
    ray_moments(s, pls_unit(x), m);
    for (int k = 0; k < MOMENTS; ++k) sum[k] += weight * m[k];
}

/// Radon's rule of fifth degree on the plane triangle; its elements seen from the centre are h / |x|^3 of their areas, h the distance of the plane.
static void measure_triangle(const ray_source *s, cell *c)
{
    const double root = sqrt(15.0), a = (6.0 - root) / 21.0, b = (6.0 + root) / 21.0, wa = (155.0 - root) / 1200.0,
                 wb = (155.0 + root) / 1200.0;
    const double place[7][3] = {{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0},
                                {a, a, 1.0 - 2.0 * a},
                                {a, 1.0 - 2.0 * a, a},
                                {1.0 - 2.0 * a, a, a},
                                {b, b, 1.0 - 2.0 * b},
                                {b, 1.0 - 2.0 * b, b},
                                {1.0 - 2.0 * b, b, b}};
    const double weight[7] = {0.225, wa, wa, wa, wb, wb, wb};
    pls_vec3 cross = pls_cross(pls_sub(c->corner[1], c->corner[0]), pls_sub(c->corner[2], c->corner[0]));
    double twice = pls_dot(cross, c->corner[0]); // twice the area times the distance of the plane
    memset(c->sum, 0, sizeof c->sum);
    for (int k = 0; k < 7; ++k)
    {
        pls_vec3 x = pls_add(pls_add(pls_scale(c->corner[0], place[k][0]), pls_scale(c->corner[1], place[k][1])),
                             pls_scale(c->corner[2], place[k][2]));
        double r = pls_length(x);
        add_ray(s, x, weight[k] * 0.5 * twice / (r * r * r), c->sum);
    }
}

/// Gauss's rule of fifth degree in the angle.
static void measure_arc(const ray_source *s, cell *c)
{
    double from = atan2(c->corner[0].y, c->corner[0].x), width = c->corner[2].x; // corner[2].x holds the arc's angle
    memset(c->sum, 0, sizeof c->sum);
    const double node[3] = {0.5 - sqrt(0.15), 0.5, 0.5 + sqrt(0.15)}, weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    for (int k = 0; k < 3; ++k)
    {
        double angle = from + width * node[k];
        add_ray(s, pls_vec(cos(angle), sin(angle), 0.0), weight[k] * width, c->sum);
    }
}

static void measure(const ray_source *s, cell *c)
{
    if (s->shape->dimension == 2)
        measure_arc(s, c);
    else
        measure_triangle(s, c);
}

static int split(const ray_source *s, const cell *c, cell part[4])
{
    if (s->shape->dimension == 2)
    {
        double half = 0.5 * c->corner[2].x, from = atan2(c->corner[0].y, c->corner[0].x);
        for (int k = 0; k < 2; ++k)
            part[k] = (cell){.corner = {pls_vec(cos(from + k * half), sin(from + k * half), 0.0), {0}, {half, 0, 0}}};
        return 2;
    }
    const pls_vec3 *p = c->corner;
    pls_vec3 m[3];
    for (int k = 0; k < 3; ++k) m[k] = pls_unit(pls_add(p[k], p[(k + 1) % 3]));
    part[0] = (cell){.corner = {p[0], m[0], m[2]}};
    part[1] = (cell){.corner = {m[0], p[1], m[1]}};
    part[2] = (cell){.corner = {m[2], m[1], p[2]}};
    part[3] = (cell){.corner = {m[0], m[1], m[2]}};
    return 4;
}

/// How much two sums differ, relative to the volume and the size.
static double difference(const double *a, const double *b, double volume, double size)
{
    double worst = fabs(a[0] - b[0]);
    for (int k = 1; k < MOMENTS; ++k) worst = fmax(worst, fabs(a[k] - b[k]) / (k < 4 ? size : size * size));
    return worst / volume;
}

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

static size_t first_cells(const ray_source *s, cell *heap)
{
    if (s->shape->dimension == 2)
    {
        for (int k = 0; k < 8; ++k) heap[k] = (cell){.corner = {pls_vec(cos(M_PI / 4 * k), sin(M_PI / 4 * k), 0.0), {0}, {M_PI / 4, 0, 0}}};
        return 8;
    }
    // An octahedron, each face in four: edges along the axes, where those of many shapes are.
    size_t count = 0;
    for (int k = 0; k < 8; ++k)
    {
        pls_vec3 x = pls_vec(k & 1 ? -1 : 1, 0, 0), y = pls_vec(0, k & 2 ? -1 : 1, 0), z = pls_vec(0, 0, k & 4 ? -1 : 1);
        bool odd = ((k & 1) + (k >> 1 & 1) + (k >> 2 & 1)) % 2 == 1;
        cell face = {.corner = {x, odd ? z : y, odd ? y : z}};
        count += (size_t)split(s, &face, heap + count);
    }
    return count;
}

static double total(const cell *heap, size_t count, double sum[MOMENTS])
{
    double error = 0.0;
    for (int k = 0; k < MOMENTS; ++k) sum[k] = 0.0;
    for (size_t c = 0; c < count; ++c)
    {
        error += heap[c].error;
        for (int k = 0; k < MOMENTS; ++k) sum[k] += heap[c].sum[k];
    }
    return error;
}

/// Halve cells until the estimated errors sum to little.
static double refine(const ray_source *s, cell *heap, size_t *count, double size, double sum[MOMENTS])
{
    for (size_t c = 0; c < *count; ++c) measure(s, &heap[c]), heap[c].error = 1.0 / (double)*count;
    double error = total(heap, *count, sum), volume = fabs(sum[0]);
    while (*count + 4 < MOST_CELLS && error > target)
    {
        cell worst = heap[0], part[4];
        int parts = split(s, &worst, part);
        double together[MOMENTS] = {0};
        for (int k = 0; k < parts; ++k)
        {
            measure(s, &part[k]);
            for (int m = 0; m < MOMENTS; ++m) together[m] += part[k].sum[m];
        }
        // The parts err by far less than they differ from the whole, at edges by an eighth. They may also be alike because both miss an edge that cuts off
        // a corner, so no estimate falls faster than those of smooth integrands do.
        double left = fmax(difference(together, worst.sum, fmax(volume, 1e-300), size) / 8.0, worst.error / smooth_gain);
        error += left - worst.error;
        for (int k = 0; k < parts; ++k) part[k].error = left / parts;
        heap[0] = part[0];
        sink(heap, *count, 0);
        for (int k = 1; k < parts; ++k)
        {
            heap[(*count)++] = part[k];
            rise(heap, *count - 1);
        }
        if (*count % 1024 < 4) error = total(heap, *count, sum), volume = fabs(sum[0]); // anew: differences leave round-off
    }
    return total(heap, *count, sum);
}

pls_status pls_mass_by_quadrature(const pls_shape *shape, pls_vec3 origin, double reach, pls_mass_properties *out)
{
    cell *heap = NULL;
    double m[MOMENTS];
    *out = (pls_mass_properties){0};
    PLS_TRY(pls_allocate(&heap, MOST_CELLS, sizeof *heap, "cells of the mass quadrature"));
    ray_source source = {shape, origin, reach};
    size_t count = first_cells(&source, heap);
    double error = refine(&source, heap, &count, reach, m);
    pls_release(&heap);
    if (!(m[0] > 0.0)) return pls_fail(PLS_INVALID_ARGUMENT, "the shape has no volume: its SDF is negative nowhere");
    pls_vec3 c = pls_vec(m[1] / m[0], m[2] / m[0], m[3] / m[0]);
    out->volume = m[0];
    out->centre = pls_add(origin, c);
    const double xx = m[4] - m[0] * c.x * c.x, yy = m[5] - m[0] * c.y * c.y, zz = m[6] - m[0] * c.z * c.z;
    out->inertia[2] = xx + yy;
    out->error = error;
    if (shape->dimension == 2) return PLS_OK;
    out->inertia[0] = yy + zz;
    out->inertia[1] = xx + zz;
    out->inertia[3] = -(m[7] - m[0] * c.x * c.y);
    out->inertia[4] = -(m[8] - m[0] * c.x * c.z);
    out->inertia[5] = -(m[9] - m[0] * c.y * c.z);
    return PLS_OK;
}
