// polyhedron.c -- the convex polyhedron, in 2D the polygon: the hull of points, or of the vertices of a mesh, rounded by a ball (disc) if wanted.
//
// phi(X) inside is the greatest height over a face's plane. Outside, the nearest point of a convex body is unique: if X is above a face and within its edges, that
// face has it; else an edge of a face seen from X has it. Faces whose plane is not nearer than what was found are passed over. With `rounding` the points are the
// centres of the ball, so the whole is larger by it, and phi less by it; it stays exact inside as well. In 2D the faces are edges of two vertices.

#include "shape/builtin.h"
#include "shape/mass_quadrature.h"
#include "shape/mesh.h"
#include "shape/polytope.h"
#include "shape/proximal.h"

#define POINTS                                                                                                                    \
    {                                                                                                                             \
        .name = "points", .unit = "m", .meaning = "points whose convex hull it is, or centres of the ball (disc) that rounds it", \
        .kind = PLS_PARAMETER_POINTS                                                                                              \
    }
#define ROUNDING                                                                                                                        \
    {                                                                                                                                   \
        .name = "rounding", .unit = "m", .meaning = "radius of a ball (disc) that rounds edges and corners; the whole is larger by it", \
        .initial = 0.0, .minimum = 0.0, .maximum = INFINITY                                                                             \
    }

static const pls_parameter solid_parameters[] = {
    POINTS,
    {.name = "path", .unit = "", .meaning = "mesh file (.obj, .stl, .ply) in place of points; its convex hull", .kind = PLS_PARAMETER_PATH},
    ROUNDING,
    {.name = NULL},
};
static const pls_parameter flat_parameters[] = {POINTS, ROUNDING, {.name = NULL}};

static pls_status prepare(const pls_shape_input *input, int dimension, void **data)
{
    pls_hull *hull = NULL;
    pls_mesh mesh = {0};
    if (input->path && input->point_count > 0)
        return pls_fail(PLS_INVALID_ARGUMENT, "a polyhedron has both points and a path to a mesh; give one of them");
    if (input->path) PLS_TRY(pls_mesh_read(input->path, &mesh));
    pls_status status = input->path ? pls_hull_make(mesh.vertex, mesh.vertex_count, dimension, &hull)
                                    : pls_hull_make(input->points, input->point_count, dimension, &hull);
    if (status != PLS_OK && input->path) status = pls_fail_context(status, "%s: ", input->path);
    pls_mesh_free(&mesh);
    *data = hull;
    return status;
}

static void release(void *data) { pls_hull_free(data); }

/// Does X project into face f, within all its edges?
static bool is_over_face(const pls_polytope *p, uint32_t f, pls_vec3 X)
{
    const uint32_t begin = p->face_start[f], end = p->face_start[f + 1];
    pls_vec3 a = p->vertex[p->face_vertex[end - 1]];
    if (end - begin == 2)
    {
        pls_vec3 e = pls_sub(p->vertex[p->face_vertex[begin]], a);
        double t = pls_dot(pls_sub(X, a), e);
        return t >= 0.0 && t <= pls_dot(e, e);
    }
    for (uint32_t k = begin; k < end; ++k)
    {
        pls_vec3 b = p->vertex[p->face_vertex[k]];
        if (pls_dot(pls_cross(pls_sub(b, a), pls_sub(X, a)), p->face_normal[f]) < 0.0) return false;
        a = b;
    }
    return true;
}

/// Distance from X to the edges of face f, if less than `best`; `away` points from the edge to X.
static void try_edges(const pls_polytope *p, uint32_t f, pls_vec3 X, double *best, pls_vec3 *away)
{
    const uint32_t begin = p->face_start[f], end = p->face_start[f + 1];
    pls_vec3 a = p->vertex[p->face_vertex[end - 1]];
    for (uint32_t k = begin; k < end; ++k)
    {
        pls_vec3 b = p->vertex[p->face_vertex[k]], e = pls_sub(b, a), d = pls_sub(X, a);
        double t = fmin(fmax(pls_dot(d, e) / pls_dot(e, e), 0.0), 1.0);
        d = pls_sub(d, pls_scale(e, t));
        double length = pls_length(d);
        if (length < *best) *best = length, *away = d;
        a = b;
    }
}

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
        if (height <= 0.0 || height >= best) continue; // no nearer than its plane
        if (is_over_face(p, f, X))
        {
            *gradient = p->face_normal[f];
            return height;
        }
        try_edges(p, f, X, &best, &away);
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

/// As from any SDF (see proximal.c), whose planes are faces here: exact after as many turns as faces matter, and a few.
static pls_vec3 proximal(const pls_shape *shape, pls_vec3 X, double step)
{
    enum { MOST_TURNS = 100 };
    pls_vec3 n = {0.0, 0.0, 0.0}, Y = X;
    pls_cut_model model = {.count = 0, .value = -INFINITY};
    for (int k = 0; k < MOST_TURNS; ++k)
    {
        double phi = distance(shape->data, Y, &n);
        if (!(phi - model.value > 1e-15 * shape->size)) break;
        if (!pls_cut_model_add(&model, (pls_cut){n, phi + pls_dot(n, pls_sub(X, Y))}, step)) break;
        Y = pls_sub(X, pls_scale(model.slope, step));
        if (k == 0 && phi >= step) break; // outside, and still so
    }
    return Y;
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
    const pls_vec3 more = pls_vec(r, r, shape->dimension == 2 ? 0.0 : r);
    *lower = pls_sub(hull->lower, more);
    *upper = pls_add(hull->upper, more);
}

static double bounding_radius(const pls_shape *shape)
{
    return (pls_hull_radius(shape->data, shape->mass.centre) + shape->values[0]) * (1.0 + 1e-15);
}

/// Integrals of 1, x, xx, ... over tetrahedra from `o` to the triangles of the faces (Tonon, J. Math. Stat. 1, 2005; Eberly, Polyhedral Mass Properties, 2002).
static void solid_mass(const pls_polytope *p, pls_vec3 o, pls_mass_properties *out)
{
    double volume = 0.0, xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
    pls_vec3 first = {0.0, 0.0, 0.0};
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        const uint32_t *corner = p->face_vertex + p->face_start[f], count = p->face_start[f + 1] - p->face_start[f];
        pls_vec3 a = pls_sub(p->vertex[corner[0]], o);
        for (uint32_t k = 1; k + 1 < count; ++k)
        {
            pls_vec3 b = pls_sub(p->vertex[corner[k]], o), c = pls_sub(p->vertex[corner[k + 1]], o), s = pls_add(a, pls_add(b, c));
            const double v = pls_dot(a, pls_cross(b, c)) / 6.0, w = v / 20.0;
            volume += v;
            first = pls_add(first, pls_scale(s, v / 4.0));
            xx += w * (s.x * s.x + a.x * a.x + b.x * b.x + c.x * c.x);
            yy += w * (s.y * s.y + a.y * a.y + b.y * b.y + c.y * c.y);
            zz += w * (s.z * s.z + a.z * a.z + b.z * b.z + c.z * c.z);
            xy += w * (s.x * s.y + a.x * a.y + b.x * b.y + c.x * c.y);
            xz += w * (s.x * s.z + a.x * a.z + b.x * b.z + c.x * c.z);
            yz += w * (s.y * s.z + a.y * a.z + b.y * b.z + c.y * c.z);
        }
    }
    pls_vec3 m = pls_scale(first, 1.0 / volume);
    xx -= volume * m.x * m.x, yy -= volume * m.y * m.y, zz -= volume * m.z * m.z;
    xy -= volume * m.x * m.y, xz -= volume * m.x * m.z, yz -= volume * m.y * m.z;
    *out = (pls_mass_properties){.volume = volume, .centre = pls_add(o, m), .inertia = {yy + zz, xx + zz, xx + yy, -xy, -xz, -yz}};
}

/// Integrals over triangles from `o` to the edges.
static void flat_mass(const pls_polytope *p, pls_vec3 o, pls_mass_properties *out)
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
    *out = (pls_mass_properties){.volume = area, .centre = pls_add(o, m), .inertia = {[2] = polar - area * pls_dot(m, m)}};
}

static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    const pls_hull *hull = shape->data;
    pls_vec3 middle = pls_scale(pls_add(hull->lower, hull->upper), 0.5);
    if (shape->values[0] > 0.0)
        return pls_mass_by_quadrature(shape, middle, (pls_hull_radius(hull, middle) + shape->values[0]) * (1.0 + 1e-9), out);
    if (shape->dimension == 2)
        flat_mass(&hull->body, middle, out);
    else
        solid_mass(&hull->body, middle, out);
    return PLS_OK;
}

#define ANSWERS                                                                                                               \
    .api_version = PLS_API_VERSION, .convex = true, .prepare = prepare, .release = release, .sdf = sdf, .gradient = gradient, \
    .support = support, .margin = margin, .polytope = polytope, .proximal = proximal, .bounding_radius = bounding_radius,     \
    .bounds = bounds, .mass_properties = mass_properties

const pls_shape_ops pls_polyhedron_shape = {
    .name = "polyhedron",
    .meaning = "a convex polyhedron: the hull of points or of a mesh",
    .parameters = solid_parameters,
    .in_3d = true,
    ANSWERS,
};

const pls_shape_ops pls_polygon_shape = {
    .name = "polygon",
    .meaning = "a convex polygon: the hull of points",
    .parameters = flat_parameters,
    .in_2d = true,
    ANSWERS,
};
