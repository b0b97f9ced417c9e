// cylinder_on_plane.c -- a cylinder on a half-space by the volume of the overlap: the laws of faces.c for a prism of infinitely many sides.
//
// Axes in the deepest point of the core (the cylinder less its rounding): z out of the lower end, x down the side, y across. How deep a point lies is linear in x and z,
//     D = depth + s x + c z,       s, c: sine and cosine of the axis with the plane's normal,
// and does not depend on y. At one y the cylinder is a rectangle of width 2 w, w = sqrt(R^2 - y^2), and what lies below the plane a polygon in it: its moments are closed forms.
// y = R sin(phi) takes away the root; between the phi at which the plane passes a corner of the rectangle the moments are smooth, and Gauss points integrate them to rounding.
// Lying on its side a cylinder has delta = 6/7 of its depth (faces.c: manifold), standing on its end all of it, on its rim 2/3.

#include "contact/cylinder_on_plane.h"

#include "contact/faces.h"
#include "math/gauss.h"
#include "shape/builtin.h"

/// Moments of what lies below the plane, and of the cut itself.
typedef struct moments
{
    double volume, x, z, xx, yy, zz, xz;
    double area, area_x, area_z;
} moments;

typedef struct cylinder
{
    double radius, length, s, c, depth;
} cylinder;

typedef struct corner
{
    double x, z;
} corner;

static double depth_at(const cylinder *q, corner p) { return q->depth + q->s * p.x + q->c * p.z; }

/// The polygon of the rectangle x_low .. x_high, -length .. 0, times `weight`.
static void add_strip(moments *m, const cylinder *q, double x_low, double x_high, double y, double weight)
{
    const corner rectangle[4] = {{x_high, 0.0}, {x_low, 0.0}, {x_low, -q->length}, {x_high, -q->length}};
    corner polygon[8], cut[8];
    int count = 0, cuts = 0;
    for (int k = 0; k < 4; ++k)
    {
        const corner p = rectangle[k], r = rectangle[(k + 1) % 4];
        const double at_p = depth_at(q, p), at_r = depth_at(q, r);
        if (at_p > 0.0) polygon[count++] = p;
        if ((at_p > 0.0) == (at_r > 0.0)) continue;
        const double share = at_p / (at_p - at_r);
        polygon[count++] = cut[cuts++] = (corner){p.x + share * (r.x - p.x), p.z + share * (r.z - p.z)};
    }
    for (int k = 2; k < count; ++k)
    {
        const corner a = polygon[0], b = polygon[k - 1], d = polygon[k];
        const double area = 0.5 * weight * fabs((b.x - a.x) * (d.z - a.z) - (b.z - a.z) * (d.x - a.x));
        const double x = a.x + b.x + d.x, z = a.z + b.z + d.z;
        m->volume += area;
        m->x += area * x / 3.0, m->z += area * z / 3.0;
        m->xx += area / 12.0 * (x * x + a.x * a.x + b.x * b.x + d.x * d.x);
        m->zz += area / 12.0 * (z * z + a.z * a.z + b.z * b.z + d.z * d.z);
        m->xz += area / 12.0 * (x * z + a.x * a.z + b.x * b.z + d.x * d.z);
        m->yy += area * y * y;
    }
    if (cuts < 2) return;
    const double length = weight * hypot(cut[1].x - cut[0].x, cut[1].z - cut[0].z);
    m->area += length;
    m->area_x += 0.5 * length * (cut[0].x + cut[1].x), m->area_z += 0.5 * length * (cut[0].z + cut[1].z);
}

/// phi in 0 .. pi/2 of 1 - cos(phi); outside of that the nearer end.
static double angle_of(double versine)
{
    if (!(versine > 0.0)) return 0.0;
    return versine >= 1.0 ? M_PI_2 : 2.0 * asin(sqrt(0.5 * versine));
}

static moments moments_of(const cylinder *q)
{
    const double R = q->radius, near_end = q->depth / (q->s * R), far_end = (q->depth - q->c * q->length) / (q->s * R);
    // Where the plane passes the lower and the upper corner of each end; beyond the first nothing is below.
    double end[5] = {0.0, angle_of(near_end), angle_of(far_end), angle_of(2.0 - near_end), angle_of(2.0 - far_end)};
    const double last = end[1];
    for (int k = 1; k < 5; ++k)
        for (int j = k; j > 0 && end[j] < end[j - 1]; --j)
        {
            const double swap = end[j];
            end[j] = end[j - 1], end[j - 1] = swap;
        }
    moments m = {0};
    for (int piece = 0; piece < 4; ++piece)
    {
        const double low = end[piece], high = fmin(end[piece + 1], last), middle = 0.5 * (low + high), half = 0.5 * (high - low);
        if (!(half > 0.0)) continue;
        for (int k = 0; k < 8; ++k)
        {
            const double phi = middle + (k % 2 ? half : -half) * pls_gauss_node[k / 2], versine = 2.0 * sin(0.5 * phi) * sin(0.5 * phi);
            const double weight = 2.0 * half * pls_gauss_weight[k / 2] * R * cos(phi); // both sides of the middle
            add_strip(&m, q, -R * (2.0 - versine), -R * versine, R * sin(phi), weight);
        }
    }
    return m;
}

/// Integrals of D and D^2, and of D x and D z.
typedef struct depths
{
    double one, two, x, z;
} depths;

static depths depths_of(const cylinder *q, const moments *m)
{
    depths d = {.one = q->depth * m->volume + q->s * m->x + q->c * m->z,
                .x = q->depth * m->x + q->s * m->xx + q->c * m->xz,
                .z = q->depth * m->z + q->s * m->xz + q->c * m->zz};
    d.two = q->depth * d.one + q->s * d.x + q->c * d.z;
    return d;
}

/// What is between a disc and a line has moments between.
static double lever_of(double small, double large)
{
    const double part = PLS_ARM_OF_LINE + (PLS_ARM_OF_DISC - PLS_ARM_OF_LINE) * small / large;
    return large > 0.0 ? part * sqrt(small + large) : 0.0;
}

bool pls_cylinder_on_plane(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                           pls_touch *out)
{
    if (a->shape->ops != &pls_cylinder_shape || !b->shape->ops->unbounded || options->faces == PLS_FACES_POINT) return false;
    const double margin = a->shape->margin * a->scale, R = a->shape->values[0] * a->scale - margin,
                 length = a->shape->values[1] * a->scale - 2.0 * margin;
    if (margin > R || 2.0 * margin > length)
        return false; // so thin a core is soon below the plane as a whole, and then nothing pushes back: the point stands
    const pls_vec3 up = pls_posed_gradient(b, b->position), z_axis = pls_dot(a->z, up) < 0.0 ? a->z : pls_scale(a->z, -1.0);
    // Of a cylinder that stands nothing but rounding is left of the side it leans to: any will do.
    const pls_vec3 lean = pls_sub(pls_scale(z_axis, pls_dot(z_axis, up)), up), any = pls_dot(a->x, up) > 0.0 ? pls_scale(a->x, -1.0) : a->x;
    const pls_vec3 x_axis = pls_length(lean) > 1e-8 ? pls_unit(lean) : any;
    const double s = fabs(pls_dot(x_axis, up)), c = -pls_dot(z_axis, up);
    const pls_vec3 start = pls_add(a->position, pls_add(pls_scale(x_axis, R), pls_scale(z_axis, 0.5 * length)));
    const cylinder q = {R, length, s, c, margin - pls_dot(up, pls_sub(start, b->position))};
    *out = (pls_touch){.delta = fmin(depth->delta, 0.0), .normal = pls_scale(up, -1.0), .depth = depth->delta};
    out->point = out->middle = pls_scale(pls_add(depth->on_a, depth->on_b), 0.5);
    if (!(q.depth > 0.0)) return true;
    const moments m = moments_of(&q);
    const depths d = depths_of(&q, &m);
    if (!(d.one > 0.0) || !(d.two > 0.0)) return true;

    double x = m.x / m.volume, z = m.z / m.volume; // where the force acts
    if (options->faces == PLS_FACES_VOLUME)
    {
        out->delta = m.volume / options->face_area;
        out->energy_delta = sqrt(2.0 * d.one / options->face_area);
        out->weight = m.area / options->face_area;
    }
    else
    {
        const double delta = 1.5 * d.two / d.one, slope = 3.0 - delta * m.volume / d.one;
        out->energy_delta = delta, out->delta = delta * slope;
        const double p = 0.5 * delta * m.volume / d.one, r = 0.5 * delta * delta * m.area / d.one;
        out->weight = fmax(9.0 - 18.0 * p + 12.0 * p * p - 2.0 * r, 0.0);
        x = (3.0 * d.x - delta * m.x) / (slope * d.one), z = (3.0 * d.z - delta * m.z) / (slope * d.one);
    }
    // In the plane: along `ahead` and y. Half way between the two surfaces.
    const pls_vec3 ahead = pls_sub(pls_scale(z_axis, s), pls_scale(x_axis, c)), across = pls_cross(z_axis, x_axis);
    const pls_vec3 base = pls_sub(start, pls_scale(up, pls_dot(up, pls_sub(start, out->point))));
    out->point = out->middle = pls_add(base, pls_scale(ahead, s * z - c * x));
    if (m.area > 0.0) out->middle = pls_add(base, pls_scale(ahead, (s * m.area_z - c * m.area_x) / m.area));
    const double mean_x = m.x / m.volume, mean_z = m.z / m.volume, yy = m.yy / m.volume;
    const double xx = m.xx / m.volume - mean_x * mean_x, zz = m.zz / m.volume - mean_z * mean_z, xz = m.xz / m.volume - mean_x * mean_z;
    const double tt = fmax(s * s * zz + c * c * xx - 2.0 * s * c * xz, 0.0);
    // Turning about its own axis, s of the turning about `ahead`, brings no part of a cylinder nearer: dashpots must not see that as rocking, or they would brake what rolls.
    const pls_vec3 t = ahead, y = across;
    const double rocks = c * c * yy;
    out->spread[0] = tt * t.x * t.x + rocks * y.x * y.x, out->spread[1] = tt * t.y * t.y + rocks * y.y * y.y;
    out->spread[2] = tt * t.z * t.z + rocks * y.z * y.z, out->spread[3] = tt * t.x * t.y + rocks * y.x * y.y;
    out->spread[4] = tt * t.x * t.z + rocks * y.x * y.z, out->spread[5] = tt * t.y * t.z + rocks * y.y * y.z;
    out->lever = lever_of(fmin(yy, tt), fmax(yy, tt));
    return true;
}
