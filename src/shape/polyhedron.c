// polyhedron.c -- the convex polyhedron, in 2D the polygon, and the prism over a polygon: the hull of points, or a convex mesh, rounded by a ball (disc) if wanted.
//
// phi(X) inside is the greatest height over a face's plane. Outside, the nearest point of a convex body is unique: if X is above a face and within its edges, that
// face has it; else an edge of a face seen from X has it. Faces whose plane is not nearer than what was found are passed over. With `rounding` the points are the
// centres of the ball, so the whole is larger by it, and phi less by it; it stays exact inside as well. In 2D the faces are edges of two vertices.

#include "shape/builtin.h"
#include "shape/mass_quadrature.h"
#include "shape/mesh.h"
#include "shape/polytope.h"
#include "shape/proximal.h"

#include "base/alloc.h"

static const char of_points[] = "points whose convex hull it is, or centres of the ball (disc) that rounds it";

#define ROUNDING                                                                                                                        \
    {                                                                                                                                   \
        .name = "rounding", .unit = "m", .meaning = "radius of a ball (disc) that rounds edges and corners; the whole is larger by it", \
        .initial = 0.0, .minimum = 0.0, .maximum = INFINITY                                                                             \
    }

static const pls_parameter solid_parameters[] = {
    {.name = "points", .unit = "m", .meaning = of_points, .kind = PLS_PARAMETER_POINTS},
    {.name = "path",
     .unit = "",
     .meaning = "mesh file (.obj, .stl, .ply) of a convex polyhedron, in place of points",
     .kind = PLS_PARAMETER_PATH},
    ROUNDING,
    {.name = "hull",
     .unit = "",
     .meaning = "1: take the convex hull of a mesh that is not convex, or not closed; 0: refuse it",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = 1.0},
    {.name = NULL},
};
static const pls_parameter flat_parameters[] = {
    {.name = "points", .unit = "m", .meaning = of_points, .initial = PLS_REQUIRED, .kind = PLS_PARAMETER_POINTS},
    ROUNDING,
    {.name = NULL},
};
static const pls_parameter prism_parameters[] = {
    {.name = "points",
     .unit = "m",
     .meaning = "points of the x-y plane whose convex hull is its base, or centres of the disc that rounds it",
     .initial = PLS_REQUIRED,
     .kind = PLS_PARAMETER_FLAT_POINTS},
    ROUNDING,
    {.name = "height",
     .unit = "m",
     .meaning = "height along z, from -height/2 to height/2, without the rounding",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = NULL},
};

enum { ROUNDED = 0, HULL = 1, HEIGHT = 1 }; ///< places of the values

// ---- making ---------------------------------------------------------------------------------------------------------------------------------------------------

static const double bulge = 1e-5;     ///< of the size: how far below the hull a triangle of a convex mesh may lie (files hold floats)
static const double open_part = 1e-4; ///< of the hull's area: what a closed mesh may lack

/// How deep X lies below the surface of the hull.
static double depth_in(const pls_hull *hull, pls_vec3 X)
{
    double least = INFINITY;
    for (uint32_t f = 0; f < hull->body.face_count; ++f) least = fmin(least, hull->offset[f] - pls_dot(hull->body.face_normal[f], X));
    return least;
}

static double area_of_hull(const pls_polytope *p)
{
    double area = 0.0;
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        pls_vec3 sum = {0.0, 0.0, 0.0}, a = p->vertex[p->face_vertex[p->face_start[f]]];
        for (uint32_t k = p->face_start[f] + 1; k + 1 < p->face_start[f + 1]; ++k)
            sum = pls_add(sum, pls_cross(pls_sub(p->vertex[p->face_vertex[k]], a), pls_sub(p->vertex[p->face_vertex[k + 1]], a)));
        area += 0.5 * pls_length(sum);
    }
    return area;
}

/// A mesh is convex if all of it lies on the surface of its hull, and covers it.
static pls_status check_convex(const pls_mesh *mesh, const pls_hull *hull)
{
    static const char what_else[] =
        "take it as a wall of shape `mesh`, build the grain as a `compound` of convex pieces, or take the hull with  hull: 1";
    const double size = pls_length(pls_sub(hull->upper, hull->lower));
    double area = 0.0;
    for (size_t t = 0; t < mesh->triangle_count; ++t)
    {
        pls_vec3 a = mesh->vertex[mesh->triangle[t][0]], b = mesh->vertex[mesh->triangle[t][1]], c = mesh->vertex[mesh->triangle[t][2]];
        const pls_vec3 look[4] = {pls_scale(pls_add(a, pls_add(b, c)), 1.0 / 3.0), pls_scale(pls_add(a, b), 0.5),
                                  pls_scale(pls_add(b, c), 0.5), pls_scale(pls_add(c, a), 0.5)};
        area += 0.5 * pls_length(pls_cross(pls_sub(b, a), pls_sub(c, a)));
        for (int k = 0; k < 4; ++k)
        {
            double depth = depth_in(hull, look[k]);
            if (depth > bulge * size)
                return pls_fail(PLS_INVALID_ARGUMENT, "the mesh is not convex: triangle %zu lies %g below the hull at (%g, %g, %g); %s",
                                t + 1, depth, look[k].x, look[k].y, look[k].z, what_else);
        }
    }
    double whole = area_of_hull(&hull->body);
    if (area < (1.0 - open_part) * whole)
        return pls_fail(PLS_INVALID_ARGUMENT, "the mesh is not closed: its triangles cover %.4g %% of its hull; %s", 100.0 * area / whole,
                        what_else);
    return PLS_OK;
}

static pls_status hull_of_mesh(const pls_shape_input *input, int dimension, pls_hull **hull)
{
    pls_mesh mesh = {0};
    PLS_TRY(pls_mesh_read(input->path, &mesh));
    pls_status status = pls_hull_make(mesh.vertex, mesh.vertex_count, dimension, hull);
    if (status == PLS_OK && input->values[HULL] == 0.0) status = check_convex(&mesh, *hull);
    if (status != PLS_OK)
    {
        pls_hull_free(*hull);
        *hull = NULL;
        status = pls_fail_context(status, "%s: ", input->path);
    }
    pls_mesh_free(&mesh);
    return status;
}

static pls_status prepare_solid(const pls_shape_input *input, int dimension, void **data)
{
    pls_hull *hull = NULL;
    if (input->path && input->point_count > 0)
        return pls_fail(PLS_INVALID_ARGUMENT, "a polyhedron has both points and a path to a mesh; give one of them");
    if (!input->path && input->point_count == 0)
        return pls_fail(PLS_INVALID_ARGUMENT, "a polyhedron needs 'points', or the 'path' of a mesh file (.obj, .stl, .ply)");
    if (input->path)
        PLS_TRY(hull_of_mesh(input, dimension, &hull));
    else
        PLS_TRY(pls_hull_make(input->points, input->point_count, dimension, &hull));
    *data = hull;
    return PLS_OK;
}

static pls_status prepare_flat(const pls_shape_input *input, int dimension, void **data)
{
    pls_hull *hull = NULL;
    PLS_TRY(pls_hull_make(input->points, input->point_count, dimension, &hull));
    *data = hull;
    return PLS_OK;
}

/// The points below and above. Points inside of the base are left out by the hull.
static pls_status prepare_prism(const pls_shape_input *input, int dimension, void **data)
{
    const size_t count = input->point_count;
    pls_vec3 *points = NULL;
    pls_hull *hull = NULL;
    if (count < 3) return pls_fail(PLS_INVALID_ARGUMENT, "the base of a prism needs at least 3 points, not %zu", count);
    PLS_TRY(pls_allocate(&points, 2 * count, sizeof *points, "points of a prism"));
    for (size_t k = 0; k < 2 * count; ++k)
    {
        points[k] = input->points[k / 2];
        points[k].z = (k & 1 ? 0.5 : -0.5) * input->values[HEIGHT];
    }
    pls_status status = pls_hull_make(points, 2 * count, dimension, &hull);
    pls_release(&points);
    *data = hull;
    return status;
}

static void release(void *data) { pls_hull_free(data); }

// ---- distance -------------------------------------------------------------------------------------------------------------------------------------------------

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
    return distance(shape->data, X, &unused) - shape->values[ROUNDED];
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

static double margin(const pls_shape *shape) { return shape->values[ROUNDED]; }

static const pls_polytope *polytope(const pls_shape *shape)
{
    const pls_hull *hull = shape->data;
    return &hull->body;
}

static void bounds(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper)
{
    const pls_hull *hull = shape->data;
    const double r = shape->values[ROUNDED];
    const pls_vec3 more = pls_vec(r, r, shape->dimension == 2 ? 0.0 : r);
    *lower = pls_sub(hull->lower, more);
    *upper = pls_add(hull->upper, more);
}

static double bounding_radius(const pls_shape *shape)
{
    return (pls_hull_radius(shape->data, shape->mass.centre) + shape->values[ROUNDED]) * (1.0 + 1e-15);
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
    if (shape->values[ROUNDED] > 0.0)
        return pls_mass_by_quadrature(shape, middle, (pls_hull_radius(hull, middle) + shape->values[ROUNDED]) * (1.0 + 1e-9), out);
    if (shape->dimension == 2)
        flat_mass(&hull->body, middle, out);
    else
        solid_mass(&hull->body, middle, out);
    return PLS_OK;
}

#define ANSWERS                                                                                                                 \
    .api_version = PLS_API_VERSION, .convex = true, .release = release, .sdf = sdf, .gradient = gradient, .proximal = proximal, \
    .support = support, .margin = margin, .polytope = polytope, .bounding_radius = bounding_radius, .bounds = bounds,           \
    .mass_properties = mass_properties

const pls_shape_ops pls_polyhedron_shape = {
    .name = "polyhedron",
    .meaning = "a convex polyhedron: the hull of points, or a convex mesh",
    .parameters = solid_parameters,
    .in_3d = true,
    .prepare = prepare_solid,
    ANSWERS,
};

const pls_shape_ops pls_polygon_shape = {
    .name = "polygon",
    .meaning = "a convex polygon: the hull of points",
    .parameters = flat_parameters,
    .in_2d = true,
    .prepare = prepare_flat,
    ANSWERS,
};

const pls_shape_ops pls_prism_shape = {
    .name = "prism",
    .meaning = "a convex polygon extruded along z",
    .parameters = prism_parameters,
    .in_3d = true,
    .prepare = prepare_prism,
    ANSWERS,
};
