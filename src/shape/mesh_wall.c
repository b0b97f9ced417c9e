// mesh_wall.c -- walls of flat pieces: in 3D a mesh of triangles from a file, in 2D a polyline.
//
// A wall is a surface, open or closed, without an inside: phi(X) is the distance from the nearest piece, less a radius `rounding` by which the pieces may be thickened.
// Grains touch it from both sides. Each piece is a part: a convex polytope of three (2D: two) vertices with two faces back to back, in a frame whose origin is its middle.
// Walls have no mass: their bodies are fixed or driven, and their frame is that of the file (of the points).

#include "shape/builtin.h"
#include "shape/mesh.h"
#include "shape/part_tree.h"
#include "shape/wall_facets.h"

#include "base/alloc.h"

#include <string.h>

#define ROUNDING                                                                                                                   \
    {                                                                                                                              \
        .name = "rounding", .unit = "m", .meaning = "radius of a ball (disc) that thickens the wall on all sides", .initial = 0.0, \
        .minimum = 0.0, .maximum = INFINITY                                                                                        \
    }

static const pls_parameter mesh_parameters[] = {
    {.name = "path", .unit = "", .meaning = "mesh file (.obj, .stl, .ply)", .initial = PLS_REQUIRED, .kind = PLS_PARAMETER_PATH},
    ROUNDING,
    {.name = "scale",
     .unit = "",
     .meaning = "multiplies the coordinates of the file: 0.001 for one in millimetres",
     .initial = 1.0,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = NULL},
};

static const pls_parameter line_parameters[] = {
    {.name = "points", .unit = "m", .meaning = "corners, one after the other", .initial = PLS_REQUIRED, .kind = PLS_PARAMETER_POINTS},
    ROUNDING,
    {.name = "closed", .unit = "", .meaning = "1: the last point is joined to the first", .initial = 0.0, .minimum = 0.0, .maximum = 1.0},
    {.name = NULL},
};

enum { ROUNDED = 0, SCALE = 1, CLOSED = 1 }; ///< places of the values
static const double thinnest = 1e-12;        ///< of its longest edge: height below which a triangle is left out

/// A triangle, or a segment.
typedef struct piece
{
    pls_shape shape;
    pls_polytope polytope;
    pls_vec3 vertex[3], normal[2];
    double values[1]; ///< rounding
    pls_facet facet;
} piece;

typedef struct wall
{
    piece *piece;
    pls_shape_part *part;
    size_t count;
} wall;

// ---- one piece ------------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 nearest_on_edge(pls_vec3 a, pls_vec3 b, pls_vec3 X)
{
    pls_vec3 e = pls_sub(b, a);
    double t = fmin(fmax(pls_dot(pls_sub(X, a), e) / pls_dot(e, e), 0.0), 1.0);
    return pls_add(a, pls_scale(e, t));
}

static pls_vec3 nearest_on_triangle(const piece *p, pls_vec3 X)
{
    const pls_vec3 *v = p->vertex;
    pls_vec3 best = v[0];
    double least = INFINITY;
    bool over = true;
    for (int k = 0; k < 3; ++k)
    {
        pls_vec3 a = v[k], b = v[(k + 1) % 3];
        if (pls_dot(pls_cross(pls_sub(b, a), pls_sub(X, a)), p->normal[0]) >= 0.0) continue; // on the inner side of this edge
        over = false;
        pls_vec3 x = nearest_on_edge(a, b, X);
        double distance = pls_length(pls_sub(X, x));
        if (distance < least) least = distance, best = x;
    }
    return over ? pls_sub(X, pls_scale(p->normal[0], pls_dot(pls_sub(X, v[0]), p->normal[0]))) : best;
}

/// From the nearest point of the piece to X.
static pls_vec3 away(const pls_shape *shape, pls_vec3 X)
{
    const piece *p = shape->data;
    pls_vec3 x = shape->dimension == 3 ? nearest_on_triangle(p, X) : nearest_on_edge(p->vertex[0], p->vertex[1], X);
    return pls_sub(X, x);
}

static double piece_sdf(const pls_shape *shape, pls_vec3 X) { return pls_length(away(shape, X)) - shape->values[ROUNDED]; }

/// On the piece itself either normal would do.
static pls_vec3 piece_gradient(const pls_shape *shape, pls_vec3 X)
{
    pls_vec3 d = away(shape, X);
    double length = pls_length(d);
    return length > 0.0 ? pls_scale(d, 1.0 / length) : ((const piece *)shape->data)->normal[0];
}

static pls_vec3 piece_support(const pls_shape *shape, pls_vec3 n)
{
    const piece *p = shape->data;
    int best = 0;
    for (int k = 1; k < shape->dimension; ++k)
        if (pls_dot(p->vertex[k], n) > pls_dot(p->vertex[best], n)) best = k;
    return p->vertex[best];
}

/// phi is a distance less a constant: a step back, at most to the piece.
static pls_vec3 piece_proximal(const pls_shape *shape, pls_vec3 X, double step)
{
    pls_vec3 d = away(shape, X);
    double length = pls_length(d);
    return pls_sub(X, length > step ? pls_scale(d, step / length) : d);
}

static double piece_margin(const pls_shape *shape) { return shape->values[ROUNDED]; }
static const pls_polytope *piece_polytope(const pls_shape *shape) { return &((const piece *)shape->data)->polytope; }

static const pls_parameter no_parameters[] = {{.name = NULL}};

#define PIECE                                                                                                    \
    .api_version = PLS_API_VERSION, .parameters = no_parameters, .wall = true, .convex = true, .sdf = piece_sdf, \
    .gradient = piece_gradient, .support = piece_support, .margin = piece_margin, .polytope = piece_polytope, .proximal = piece_proximal

static const pls_shape_ops triangle_ops = {.name = "triangle", .meaning = "a piece of a mesh", .in_3d = true, PIECE};
static const pls_shape_ops segment_ops = {.name = "segment", .meaning = "a piece of a polyline", .in_2d = true, PIECE};

/// Faces back to back: in 3D two triangles, in 2D two edges, the first one's normal on the right hand side of the way from vertex 0 to vertex 1.
static void fill_polytope(piece *p, int dimension)
{
    static const uint32_t three[3] = {0, 3, 6}, triangles[6] = {0, 1, 2, 0, 2, 1}, ring_start[4] = {0, 2, 4, 6},
                          ring[6] = {1, 2, 0, 2, 0, 1};
    static const uint32_t two[3] = {0, 2, 4}, edges[4] = {0, 1, 1, 0}, pair_start[3] = {0, 1, 2}, pair[2] = {1, 0};
    const bool flat = dimension == 2;
    p->polytope = (pls_polytope){.vertex = p->vertex,
                                 .vertex_count = (uint32_t)dimension,
                                 .face_start = flat ? two : three,
                                 .face_vertex = flat ? edges : triangles,
                                 .face_normal = p->normal,
                                 .face_count = 2,
                                 .neighbour_start = flat ? pair_start : ring_start,
                                 .neighbour = flat ? pair : ring};
}

static void fill_shape(piece *p, int dimension, double rounding)
{
    pls_vec3 low = p->vertex[0], up = p->vertex[0];
    const pls_vec3 more = pls_vec(rounding, rounding, dimension == 3 ? rounding : 0.0);
    double radius = 0.0;
    for (int k = 0; k < dimension; ++k)
    {
        const pls_vec3 v = p->vertex[k];
        low = pls_vec(fmin(low.x, v.x), fmin(low.y, v.y), fmin(low.z, v.z));
        up = pls_vec(fmax(up.x, v.x), fmax(up.y, v.y), fmax(up.z, v.z));
        radius = fmax(radius, pls_length(v));
    }
    p->values[ROUNDED] = rounding;
    radius = (radius + rounding) * (1.0 + 1e-15);
    p->shape = (pls_shape){.ops = dimension == 3 ? &triangle_ops : &segment_ops,
                           .users = 1,
                           .dimension = dimension,
                           .values = p->values,
                           .data = p,
                           .size = radius,
                           .convex = true,
                           .margin = rounding,
                           .polytope = &p->polytope,
                           .radius = radius,
                           .lower = pls_sub(low, more),
                           .upper = pls_add(up, more),
                           .principal = pls_quat_identity()};
}

/// Without area (length): nothing is between the corners.
static bool is_nothing(const pls_vec3 *corner, int dimension)
{
    const pls_vec3 along = pls_sub(corner[1], corner[0]);
    const double length = pls_length(along);
    if (dimension == 2) return !(length > 0.0);
    const pls_vec3 other = pls_sub(corner[2], corner[0]);
    const double longest = fmax(length, fmax(pls_length(other), pls_length(pls_sub(other, along))));
    return !(pls_length(pls_cross(along, other)) > thinnest * longest * longest);
}

/// A piece between `corner`s; its facet is known.
static void make_piece(const pls_vec3 *corner, int dimension, double rounding, piece *p, pls_shape_part *part)
{
    pls_vec3 middle = {0.0, 0.0, 0.0};
    for (int k = 0; k < dimension; ++k) middle = pls_add(middle, pls_scale(corner[k], 1.0 / dimension));
    for (int k = 0; k < dimension; ++k) p->vertex[k] = pls_sub(corner[k], middle);
    p->normal[0] = p->facet.normal;
    p->normal[1] = pls_scale(p->normal[0], -1.0);
    fill_polytope(p, dimension);
    fill_shape(p, dimension, rounding);
    *part = (pls_shape_part){.shape = &p->shape, .position = middle, .orientation = pls_quat_identity(), .scale = 1.0};
}

const pls_facet *pls_shape_facet(const pls_shape *shape)
{
    return shape->ops == &triangle_ops || shape->ops == &segment_ops ? &((const piece *)shape->data)->facet : NULL;
}

// ---- the wall -------------------------------------------------------------------------------------------------------------------------------------------------

static void release(void *data)
{
    wall *w = data;
    pls_release(&w->piece);
    pls_release(&w->part);
    pls_release(&w);
}

static pls_status allocate(size_t most, wall **out)
{
    wall *w = NULL;
    PLS_TRY(pls_allocate(&w, 1, sizeof *w, "a wall"));
    pls_status status = pls_allocate(&w->piece, most, sizeof *w->piece, "pieces of a wall");
    if (status == PLS_OK) status = pls_allocate(&w->part, most, sizeof *w->part, "pieces of a wall");
    if (status == PLS_OK)
        *out = w;
    else
        release(w);
    return status;
}

/// Pieces between corners, D each; those without area (length) add nothing to the edges of their neighbours and are left out.
static pls_status from_corners(pls_vec3 (*corner)[3], size_t count, int dimension, double rounding, wall **out)
{
    wall *w = NULL;
    pls_facet *facet = NULL;
    size_t left = 0;
    for (size_t k = 0; k < count; ++k)
        if (!is_nothing(corner[k], dimension)) memmove(corner[left++], corner[k], sizeof *corner);
    if (left == 0)
        return pls_fail(PLS_INVALID_ARGUMENT, "none of the %zu pieces of the wall has %s", count, dimension == 3 ? "an area" : "a length");
    PLS_TRY(pls_wall_unique(corner, &left, dimension)); // meshes with two sides have each triangle twice
    pls_status status = pls_allocate(&facet, left, sizeof *facet, "pieces of a wall");
    if (status == PLS_OK) status = pls_wall_facets(corner, left, dimension, facet);
    if (status == PLS_OK) status = allocate(left, &w);
    for (size_t k = 0; status == PLS_OK && k < left; ++k)
    {
        w->piece[k].facet = facet[k];
        make_piece(corner[k], dimension, rounding, &w->piece[k], &w->part[k]);
    }
    if (status == PLS_OK) w->count = left, *out = w;
    pls_release(&facet);
    return status;
}

/// Scanned meshes often have triangles without area.
static pls_status from_mesh(const pls_shape_input *input, const pls_mesh *mesh, wall **out)
{
    pls_vec3(*corner)[3] = NULL;
    PLS_TRY(pls_allocate(&corner, mesh->triangle_count, sizeof *corner, "triangles of a mesh"));
    for (size_t t = 0; t < mesh->triangle_count; ++t)
        for (int c = 0; c < 3; ++c) corner[t][c] = pls_scale(mesh->vertex[mesh->triangle[t][c]], input->values[SCALE]);
    pls_status status = from_corners(corner, mesh->triangle_count, 3, input->values[ROUNDED], out);
    if (status == PLS_INVALID_ARGUMENT)
        status = pls_fail(PLS_INVALID_ARGUMENT, "%s: none of the %zu triangles has an area; save the mesh anew", input->path,
                          mesh->triangle_count);
    pls_release(&corner);
    return status;
}

static pls_status prepare_mesh(const pls_shape_input *input, int dimension, void **data)
{
    (void)dimension;
    pls_mesh mesh = {0};
    wall *w = NULL;
    if (!input->path) return pls_fail(PLS_INVALID_ARGUMENT, "a mesh needs the 'path' of a file (.obj, .stl, .ply)");
    PLS_TRY(pls_mesh_read(input->path, &mesh));
    pls_status status = from_mesh(input, &mesh, &w);
    pls_mesh_free(&mesh);
    if (status == PLS_OK) *data = w;
    return status;
}

static pls_status check_points(const pls_shape_input *input)
{
    const bool closed = input->values[CLOSED] != 0.0;
    const size_t count = input->point_count, least = closed ? 3 : 2;
    if (input->values[CLOSED] != 0.0 && input->values[CLOSED] != 1.0)
        return pls_fail(PLS_INVALID_ARGUMENT, "'closed' of a polyline must be 0 or 1, not %g", input->values[CLOSED]);
    if (count < least)
        return pls_fail(PLS_INVALID_ARGUMENT, "a%s polyline needs at least %zu points, not %zu", closed ? " closed" : "n open", least,
                        count);
    for (size_t k = 0; k < count; ++k)
    {
        const pls_vec3 x = input->points[k], next = input->points[(k + 1) % count];
        if (!isfinite(x.x) || !isfinite(x.y) || x.z != 0.0)
            return pls_fail(PLS_INVALID_ARGUMENT, "point %zu of a polyline is (%g, %g, %g) m; it must be finite and lie in the x-y plane",
                            k + 1, x.x, x.y, x.z);
        if ((closed || k + 1 < count) && x.x == next.x && x.y == next.y)
            return pls_fail(PLS_INVALID_ARGUMENT, "points %zu and %zu of a polyline are the same, (%g, %g) m; remove one of them", k + 1,
                            (k + 1) % count + 1, x.x, x.y);
    }
    return PLS_OK;
}

static pls_status prepare_line(const pls_shape_input *input, int dimension, void **data)
{
    wall *w = NULL;
    pls_vec3(*corner)[3] = NULL;
    PLS_TRY(check_points(input));
    const size_t count = input->values[CLOSED] != 0.0 ? input->point_count : input->point_count - 1;
    PLS_TRY(pls_allocate(&corner, count, sizeof *corner, "pieces of a polyline"));
    for (size_t k = 0; k < count; ++k) corner[k][0] = input->points[k], corner[k][1] = input->points[(k + 1) % input->point_count];
    const pls_status status = from_corners(corner, count, dimension, input->values[ROUNDED], &w);
    pls_release(&corner);
    if (status == PLS_OK) *data = w;
    return status;
}

/// From the middle of a piece along `way`, as far as no other piece is nearer: behind a wall of some thickness to the middle of it.
static double reach_along(const pls_shape *shape, pls_vec3 middle, pls_vec3 way, double size, double margin)
{
    enum { HALVINGS = 6 };
    const double same = 1e-6, first = 1e-2, most = 4.0 * shape->radius;
    double low = 0.0, high = first * size;
    for (; high < most; low = high, high *= 2.0)
        if (pls_union_sdf(shape, pls_add(middle, pls_scale(way, high))) + margin < high * (1.0 - same)) break;
    if (!(high < most)) return INFINITY;
    for (int k = 0; k < HALVINGS; ++k)
    {
        const double s = 0.5 * (low + high), distance = pls_union_sdf(shape, pls_add(middle, pls_scale(way, s))) + margin;
        *(distance < s * (1.0 - same) ? &high : &low) = s;
    }
    return low;
}

/// The most of that from its middle and from beside the middles of its sides.
static double reach_behind(const pls_shape *shape, const pls_shape_part *part, int side)
{
    const piece *p = part->shape->data;
    const pls_vec3 way = pls_scale(p->facet.normal, side ? 1.0 : -1.0);
    const double size = part->shape->radius, margin = part->shape->margin, beside = 0.98;
    double most = reach_along(shape, part->position, way, size, margin);
    for (int k = 0; k < part->shape->dimension && isfinite(most); ++k)
    {
        const pls_vec3 middle = pls_scale(pls_add(p->vertex[k], p->vertex[(k + 1) % part->shape->dimension]), 0.5 * beside);
        most = fmax(most, reach_along(shape, pls_add(part->position, middle), way, size, margin));
    }
    return most;
}

void pls_wall_find_reach(pls_shape *shape)
{
    enum {
        MANY = 256
    }; // pieces whose boxes are about one place, as in a fan of thousands: distances take long there, and are not asked for
    for (size_t k = 0; k < shape->part_count; ++k)
    {
        const pls_shape_part *part = &shape->part[k];
        if (!pls_shape_facet(part->shape)) return;
        pls_facet *facet = &((piece *)part->shape->data)->facet;
        const bool many = pls_shape_parts_near(shape, part->position, 0.0, NULL, 0) > MANY;
        for (int side = 0; side < 2; ++side) facet->reach[side] = many ? INFINITY : reach_behind(shape, part, side);
    }
}

static const pls_shape_part *parts(const pls_shape *shape, size_t *count)
{
    const wall *w = shape->data;
    *count = w->count;
    return w->part;
}

/// The boxes of the pieces are the smallest.
static void bounds(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper) { pls_part_tree_box(shape->tree, lower, upper); }

#define ANSWERS                                                                                                             \
    .api_version = PLS_API_VERSION, .wall = true, .release = release, .sdf = pls_union_sdf, .gradient = pls_union_gradient, \
    .bounds = bounds, .parts = parts

const pls_shape_ops pls_mesh_shape = {
    .name = "mesh",
    .meaning = "a wall of triangles from a mesh file; not a grain: its bodies are fixed or driven",
    .parameters = mesh_parameters,
    .in_3d = true,
    .prepare = prepare_mesh,
    ANSWERS,
};

const pls_shape_ops pls_polyline_shape = {
    .name = "polyline",
    .meaning = "a wall of straight pieces; not a grain: its bodies are fixed or driven",
    .parameters = line_parameters,
    .in_2d = true,
    .prepare = prepare_line,
    ANSWERS,
};
