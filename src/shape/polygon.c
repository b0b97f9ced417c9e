// polygon.c -- the convex polygon of 2D: the hull of points, rounded by a disc if wanted.
//
// As polyhedron.c, with edges for faces. With `rounding` the points are the centres of the disc, so the whole is larger by it.

#include "shape/polytope.h"

#include "shape/mass_quadrature.h"

extern const pls_shape_ops pls_polygon_shape;

static const pls_parameter parameters[] = {
    {.name = "points",
     .unit = "m",
     .meaning = "points whose convex hull the polygon is, or centres of the disc that rounds it",
     .kind = PLS_PARAMETER_POINTS},
    {.name = "rounding",
     .unit = "m",
     .meaning = "radius of a ball that rounds edges and corners; the whole is larger by it",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = NULL},
};

static pls_status prepare(const pls_shape_input *input, int dimension, void **data)
{
    pls_hull *hull = NULL;
    PLS_TRY(pls_hull_make(input->points, input->point_count, dimension, &hull));
    *data = hull;
    return PLS_OK;
}

static void release(void *data) { pls_hull_free(data); }

/// Signed distance of the core, and its gradient.
static double distance(const pls_hull *hull, pls_vec3 X, pls_vec3 *gradient)
{
    const pls_polytope *p = &hull->body;
    double most = -INFINITY, best = INFINITY;
    pls_vec3 away = {0.0, 0.0, 0.0};
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        double height = pls_dot(p->face_normal[f], X) - hull->offset[f];
        if (height > most) most = height, *gradient = p->face_normal[f];
        if (height <= 0.0 || height >= best) continue; // no nearer than its line
        pls_vec3 a = p->vertex[p->face_vertex[2 * f]], e = pls_sub(p->vertex[p->face_vertex[2 * f + 1]], a), d = pls_sub(X, a);
        double t = pls_dot(d, e) / pls_dot(e, e);
        if (t >= 0.0 && t <= 1.0)
        {
            *gradient = p->face_normal[f];
            return height;
        }
        d = pls_sub(d, pls_scale(e, fmin(fmax(t, 0.0), 1.0)));
        double length = pls_length(d);
        if (length < best) best = length, away = d;
    }
    if (most <= 0.0 || !(best > 0.0)) return fmin(most, best);
    *gradient = pls_scale(away, 1.0 / best);
    return best;
}

static double sdf(const pls_shape *shape, pls_vec3 X)
{
    pls_vec3 unused = {0.0, 0.0, 0.0};
    return distance(shape->data, X, &unused) - shape->values[0];
}

static pls_vec3 gradient(const pls_shape *shape, pls_vec3 X)
{
    pls_vec3 n = {0.0, 0.0, 0.0};
    distance(shape->data, X, &n);
    return n;
}

static pls_vec3 support(const pls_shape *shape, pls_vec3 n) { return pls_hull_support(shape->data, n); }

static double margin(const pls_shape *shape) { return shape->values[0]; }

static const pls_polytope *polytope(const pls_shape *shape)
{
    const pls_hull *hull = shape->data;
    return &hull->body;
}

static void bounds(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper)
{
    const pls_hull *hull = shape->data;
    const double r = shape->values[0];
    *lower = pls_sub(hull->lower, pls_vec(r, r, 0.0));
    *upper = pls_add(hull->upper, pls_vec(r, r, 0.0));
}

static double bounding_radius(const pls_shape *shape)
{
    return (pls_hull_radius(shape->data, shape->mass.centre) + shape->values[0]) * (1.0 + 1e-15);
}

/// Integrals over triangles from `o` to the edges.
static void exact_mass(const pls_polytope *p, pls_vec3 o, pls_mass_properties *out)
{
    double area = 0.0, polar = 0.0;
    pls_vec3 first = {0.0, 0.0, 0.0};
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        pls_vec3 a = pls_sub(p->vertex[p->face_vertex[2 * f]], o), b = pls_sub(p->vertex[p->face_vertex[2 * f + 1]], o), s = pls_add(a, b);
        const double v = 0.5 * (a.x * b.y - a.y * b.x);
        area += v;
        first = pls_add(first, pls_scale(s, v / 3.0));
        polar += v / 12.0 * (pls_dot(s, s) + pls_dot(a, a) + pls_dot(b, b));
    }
    pls_vec3 m = pls_scale(first, 1.0 / area);
    out->volume = area;
    out->centre = pls_add(o, m);
    out->inertia[2] = polar - area * pls_dot(m, m);
}

static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    const pls_hull *hull = shape->data;
    pls_vec3 middle = pls_scale(pls_add(hull->lower, hull->upper), 0.5);
    if (shape->values[0] > 0.0)
        return pls_mass_by_quadrature(shape, middle, (pls_hull_radius(hull, middle) + shape->values[0]) * (1.0 + 1e-9), out);
    *out = (pls_mass_properties){0};
    exact_mass(&hull->body, middle, out);
    return PLS_OK;
}

const pls_shape_ops pls_polygon_shape = {
    .api_version = PLS_API_VERSION,
    .name = "polygon",
    .meaning = "a convex polygon: the hull of points",
    .parameters = parameters,
    .in_2d = true,
    .convex = true,
    .prepare = prepare,
    .release = release,
    .sdf = sdf,
    .gradient = gradient,
    .support = support,
    .margin = margin,
    .polytope = polytope,
    .bounding_radius = bounding_radius,
    .bounds = bounds,
    .mass_properties = mass_properties,
};
