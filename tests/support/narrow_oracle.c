#include "support/narrow_oracle.h"

#include "base/random.h"
#include "shape/builtin.h"
#include "support/numbers.h"
#include "support/values_alone.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static const double most_overlap = 0.1; ///< of the smaller bounding radius: 5 % of the size
static const double least_overlap = 2e-6;
static const double rounding = 4e-15; ///< of the size: ten roundings of coordinates that are up to four sizes away from zero

// ---- shapes -------------------------------------------------------------------------------------------------------------------------------------------------------

enum form { POINTS, CYLINDER, ELLIPSOID, SUPERQUADRIC, CONE, PLANE };

typedef struct shape_row
{
    const char *name;
    const pls_shape_ops *ops;
    enum form form;
    double values[6];
    int points; ///< random ones on an ellipsoid, for polyhedra
} shape_row;

static const shape_row rows_3d[NARROW_SHAPES_3D] = {
    {"sphere", &pls_sphere_shape, POINTS, {0.7}, 0},
    {"box", &pls_box_shape, POINTS, {0.6, 0.4, 0.5}, 0},
    {"rounded box", &pls_box_shape, POINTS, {0.5, 0.6, 0.4, 0.1}, 0},
    {"capsule", &pls_capsule_shape, POINTS, {0.3, 0.9}, 0},
    {"cylinder", &pls_cylinder_shape, CYLINDER, {0.5, 0.9}, 0},
    {"ellipsoid", &pls_ellipsoid_shape, ELLIPSOID, {0.7, 0.5, 0.4}, 0},
    {"superquadric", &pls_superquadric_shape, SUPERQUADRIC, {0.6, 0.5, 0.45, 0.5, 0.7}, 0},
    {"polyhedron 32", &pls_polyhedron_shape, POINTS, {0.0}, 32},
    {"polyhedron 128", &pls_polyhedron_shape, POINTS, {0.0}, 128},
    {"prism", &pls_prism_shape, POINTS, {0.0, 0.7}, 7},
    {"rounded polyhedron 32", &pls_polyhedron_shape, POINTS, {0.1}, 32},
    {"rounded cylinder", &pls_cylinder_shape, CYLINDER, {0.5, 0.9, 0.1}, 0},
    {"rounded ellipsoid", &pls_ellipsoid_shape, ELLIPSOID, {0.6, 0.4, 0.3, 0.1}, 0},
    {"sdf-only cone", &values_cone, CONE, {0.5, 0.25, 0.8}, 0},
    {"plane", &pls_plane_shape, PLANE, {0.0}, 0},
};
static const shape_row rows_2d[NARROW_SHAPES_2D] = {
    {"disc", &pls_sphere_shape, POINTS, {0.6}, 0},
    {"box", &pls_box_shape, POINTS, {0.6, 0.4, 1.0}, 0},
    {"polygon 12", &pls_polygon_shape, POINTS, {0.0}, 12},
    {"capsule", &pls_capsule_shape, POINTS, {0.3, 0.9}, 0},
    {"ellipse", &pls_ellipsoid_shape, ELLIPSOID, {0.7, 0.4, 1.0}, 0},
    {"superellipse", &pls_superquadric_shape, SUPERQUADRIC, {0.6, 0.45, 1.0, 1.0, 0.6}, 0},
    {"rounded polygon 12", &pls_polygon_shape, POINTS, {0.1}, 12},
    {"sdf-only cone", &values_cone, CONE, {0.5, 0.25, 0.8}, 0},
    {"plane", &pls_plane_shape, PLANE, {0.0}, 0},
};

static pls_shape *made[2][NARROW_MOST_SHAPES];

static const shape_row *row_of(int dimension, int number)
{
    if (number >= (dimension == 2 ? NARROW_SHAPES_2D : NARROW_SHAPES_3D)) return NULL;
    return dimension == 2 ? &rows_2d[number] : &rows_3d[number];
}

const char *narrow_name(int dimension, int number) { return row_of(dimension, number)->name; }

static pls_vec3 random_unit(pls_random *random, int dimension)
{
    pls_vec3 v;
    do {
        v.x = pls_random_normal(random), v.y = pls_random_normal(random), v.z = pls_random_normal(random);
        if (dimension == 2) v.z = 0.0;
    } while (!(pls_dot(v, v) > 1e-6));
    return pls_unit(v);
}

const pls_shape *narrow_shape(int dimension, int number)
{
    const shape_row *row = row_of(dimension, number);
    if (!row) return NULL;
    pls_shape **shape = &made[dimension - 2][number];
    if (*shape) return *shape;
    pls_vec3 points[128];
    pls_random random = pls_random_stream(7, (uint64_t)row->points, PLS_FOR_USER);
    for (int k = 0; k < row->points; ++k)
    {
        pls_vec3 n = random_unit(&random, dimension);
        points[k] = pls_vec(0.7 * n.x, 0.55 * n.y, dimension == 2 ? 0.0 : 0.5 * n.z);
    }
    const pls_shape_input input = {VALUES(row->values), .points = points, .point_count = (size_t)row->points};
    if (pls_shape_make(row->ops, dimension, &input, row->name, shape) != PLS_OK)
    {
        fprintf(stderr, "%s\n", pls_last_message());
        abort();
    }
    return *shape;
}

void narrow_free_shapes(void)
{
    for (int d = 0; d < 2; ++d)
        for (int k = 0; k < NARROW_MOST_SHAPES; ++k) pls_shape_free(made[d][k]), made[d][k] = NULL;
}

static bool is_polytope(int dimension, int number)
{
    return row_of(dimension, number)->form == POINTS || row_of(dimension, number)->form == PLANE;
}

double narrow_allowed(int dimension, int a, int b) { return is_polytope(dimension, a) && is_polytope(dimension, b) ? 1e-8 : 1e-6; }

// ---- support functions of the oracle ---------------------------------------------------------------------------------------------------------------------------

typedef struct body
{
    const shape_row *row;
    const pls_shape *shape;
    pls_posed pose;
    pls_vec3 vertex[128]; ///< in the world
    double margin;        ///< scaled
} body;

static void set_pose(body *s, pls_posed pose)
{
    s->pose = pose;
    s->margin = s->shape->margin * pose.scale;
    if (s->row->form == POINTS)
        for (uint32_t k = 0; k < s->shape->polytope->vertex_count; ++k)
            s->vertex[k] = pls_posed_world(&pose, s->shape->polytope->vertex[k]);
}

/// Least of the norm |u| v of two components with exponents P: (u^P + v^P)^(1/P), and its two derivatives.
static double dual_norm(double u, double v, double P, double *du, double *dv)
{
    double most = fmax(u, v);
    *du = *dv = 0.0;
    if (most == 0.0) return 0.0;
    double h = most * pow(pow(u / most, P) + pow(v / most, P), 1.0 / P);
    *du = pow(u / h, P - 1.0), *dv = pow(v / h, P - 1.0);
    return h;
}

/// Without the margin.
static pls_vec3 core_support(const body *s, pls_vec3 n)
{
    const double *v = s->row->values;
    const bool flat = s->shape->dimension == 2;
    switch (s->row->form)
    {
        case CYLINDER:
        {
            double side = hypot(n.x, n.y);
            const double r = v[0] - v[2], h = 0.5 * v[1] - v[2];
            return pls_vec(side > 0.0 ? r * n.x / side : 0.0, side > 0.0 ? r * n.y / side : 0.0, copysign(h, n.z));
        }
        case ELLIPSOID:
        {
            pls_vec3 m = pls_vec(v[0] * n.x, v[1] * n.y, flat ? 0.0 : v[2] * n.z);
            double h = pls_length(m);
            return pls_vec(v[0] * m.x / h, v[1] * m.y / h, flat ? 0.0 : v[2] * m.z / h);
        }
        case SUPERQUADRIC:
        {
            double du, dv, dh, dw, h = dual_norm(v[0] * fabs(n.x), v[1] * fabs(n.y), 2.0 / (2.0 - v[4]), &du, &dv);
            dual_norm(h, v[2] * fabs(n.z), 2.0 / (2.0 - v[3]), &dh, &dw);
            return pls_vec(copysign(v[0] * dh * du, n.x), copysign(v[1] * dh * dv, n.y), copysign(v[2] * dw, n.z));
        }
        case CONE:
        {
            double axial = flat ? n.y : n.z, high = v[2] * axial + v[1] > v[0] ? 1.0 : 0.0;
            pls_vec3 p = pls_scale(n, high == 1.0 ? v[1] : v[0]);
            if (flat)
                p.y += high * v[2];
            else
                p.z += high * v[2];
            return p;
        }
        default: return pls_vec(0.0, 0.0, 0.0);
    }
}

static pls_vec3 own_support(const body *s, pls_vec3 n) { return pls_add(core_support(s, n), pls_scale(n, s->shape->margin)); }

/// The point of the body furthest along the unit vector n, in the world.
static pls_vec3 support(const body *s, pls_vec3 n)
{
    if (s->row->form != POINTS) return pls_posed_world(&s->pose, own_support(s, pls_posed_turn_back(&s->pose, n)));
    uint32_t best = 0;
    double most = -INFINITY;
    for (uint32_t k = 0; k < s->shape->polytope->vertex_count; ++k)
    {
        double along = pls_dot(s->vertex[k], n);
        if (along > most) most = along, best = k;
    }
    return pls_add(s->vertex[best], pls_scale(n, s->margin));
}

static double F_of(const body *a, const body *b, pls_vec3 n)
{
    if (b->row->form == PLANE) // finite along one direction only
    {
        pls_vec3 up = b->shape->dimension == 2 ? b->pose.y : b->pose.z, s = support(a, pls_scale(up, -1.0));
        return pls_dot(up, pls_sub(b->pose.position, s));
    }
    return pls_dot(n, pls_sub(support(a, n), support(b, pls_scale(n, -1.0))));
}

// ---- separating axes --------------------------------------------------------------------------------------------------------------------------------------------

static void try_normal(const body *a, const body *b, pls_vec3 n, double *least) { *least = fmin(*least, F_of(a, b, n)); }

typedef struct edge
{
    pls_vec3 along, f, g; ///< in the world; normals of the two faces
} edge;

enum { MOST_EDGES = 400 };

/// Edges of a polytope with the faces on both sides.
static int edges_of(const body *s, edge *out)
{
    const pls_polytope *p = s->shape->polytope;
    int count = 0;
    for (uint32_t f = 0; f < p->face_count; ++f)
        for (uint32_t k = p->face_start[f]; k < p->face_start[f + 1]; ++k)
        {
            uint32_t i = p->face_vertex[k], j = p->face_vertex[k + 1 < p->face_start[f + 1] ? k + 1 : p->face_start[f]];
            if (i > j) continue;
            for (uint32_t g = 0; g < p->face_count; ++g)
            {
                if (g == f) continue;
                bool has_i = false, has_j = false;
                for (uint32_t m = p->face_start[g]; m < p->face_start[g + 1]; ++m)
                    has_i |= p->face_vertex[m] == i, has_j |= p->face_vertex[m] == j;
                if (!has_i || !has_j) continue;
                out[count++] = (edge){pls_sub(s->vertex[j], s->vertex[i]), pls_posed_turn(&s->pose, p->face_normal[f]),
                                      pls_posed_turn(&s->pose, p->face_normal[g])};
                if (count == MOST_EDGES) abort();
            }
        }
    return count;
}

/// Does the plane through the origin with normal m part the normals of the edge's faces? With slack, so that touching ones count.
static bool straddles(const edge *e, pls_vec3 m, double size) { return pls_dot(e->f, m) * pls_dot(e->g, m) < 1e-9 * size * size; }

static void try_edges(const body *a, const body *b, double *least)
{
    static _Thread_local edge ea[MOST_EDGES], eb[MOST_EDGES];
    const int na = edges_of(a, ea), nb = edges_of(b, eb);
    for (int i = 0; i < na; ++i)
        for (int j = 0; j < nb; ++j)
        {
            // A normal of both edges lies on the arcs of normals of both: each arc crosses the other's great circle.
            if (!straddles(&ea[i], eb[j].along, 1.0) || !straddles(&eb[j], ea[i].along, 1.0)) continue;
            pls_vec3 n = pls_cross(ea[i].along, eb[j].along);
            if (!(pls_length(n) > 1e-9 * pls_length(ea[i].along) * pls_length(eb[j].along))) continue;
            n = pls_unit(n);
            try_normal(a, b, n, least);
            try_normal(a, b, pls_scale(n, -1.0), least);
        }
}

static void try_faces(const body *of, const body *a, const body *b, double sign, double *least)
{
    const pls_polytope *p = of->shape->polytope;
    for (uint32_t f = 0; f < p->face_count; ++f) try_normal(a, b, pls_scale(pls_posed_turn(&of->pose, p->face_normal[f]), sign), least);
}

/// Cores that overlap: exact.
static double by_axes(const body *a, const body *b)
{
    double least = INFINITY;
    try_faces(a, a, b, 1.0, &least);
    try_faces(b, a, b, -1.0, &least);
    if (a->shape->dimension == 3) try_edges(a, b, &least);
    return least;
}

// ---- bounds over all directions --------------------------------------------------------------------------------------------------------------------------------

/// A direction and the support point of the Minkowski difference along it, p.n = F(n); p bounds F from below all over, F(m) >= p.m.
typedef struct sample
{
    pls_vec3 n, p;
} sample;

/// All directions between the corners: in 2D an arc (two of them), in 3D a spherical triangle.
typedef struct cone
{
    sample corner[3];
} cone;

static sample sample_of(const body *a, const body *b, pls_vec3 n)
{
    n = pls_unit(n);
    return (sample){n, pls_sub(support(a, n), support(b, pls_scale(n, -1.0)))};
}

static double least_along(const cone *c, pls_vec3 p, int corners)
{
    double low = INFINITY;
    for (int k = 0; k < corners; ++k) low = fmin(low, pls_dot(p, c->corner[k].n));
    return low;
}

/// The bound that the mixture of three points gives whose plane has its foot inside of them.
static double by_three(const cone *c, pls_vec3 p, pls_vec3 q, pls_vec3 r)
{
    const pls_vec3 u = pls_sub(q, p), v = pls_sub(r, p), n = pls_cross(u, v);
    const double square = pls_dot(n, n);
    if (!(square > 0.0)) return -INFINITY;
    const pls_vec3 w = pls_sub(pls_scale(n, pls_dot(p, n) / square), p);
    const double second = pls_dot(pls_cross(w, v), n) / square, third = pls_dot(pls_cross(u, w), n) / square;
    if (!(second >= 0.0 && third >= 0.0 && second + third <= 1.0)) return -INFINITY;
    return least_along(c, pls_add(p, pls_add(pls_scale(u, second), pls_scale(v, third))), 3);
}

/// A bound of F from below over the cone: the best that mixtures of its corners' points and of `known`, another point of the Minkowski difference, give. For m = sum of
/// l_k n_k, |m| = 1, the sum of l is at least 1, so a point whose products with all corners are positive bounds F by the least of them.
static double bound_of(const cone *c, pls_vec3 known, int corners)
{
    pls_vec3 p[4] = {known};
    double best = -INFINITY;
    for (int k = 0; k < corners; ++k) p[k + 1] = c->corner[k].p;
    for (int i = 0; i <= corners; ++i) best = fmax(best, least_along(c, p[i], corners));
    for (int i = 0; i <= corners; ++i)
        for (int j = 0; j < i; ++j)
        {
            // Along p_i + t (p_j - p_i) the products with two corners are equal at one t.
            const pls_vec3 u = pls_sub(p[j], p[i]);
            for (int k = 0; k < corners; ++k)
            {
                const pls_vec3 apart = pls_sub(c->corner[k].n, c->corner[(k + 1) % corners].n);
                const double t = -pls_dot(p[i], apart) / pls_dot(u, apart);
                if (t > 0.0 && t < 1.0) best = fmax(best, least_along(c, pls_add(p[i], pls_scale(u, t)), corners));
            }
        }
    for (int k = 0; k < 4 && corners == 3; ++k) best = fmax(best, by_three(c, p[k], p[(k + 1) % 4], p[(k + 2) % 4]));
    return best;
}

/// Halve the cone's longest side.
static void halve(const body *a, const body *b, const cone *c, int corners, cone half[2])
{
    int longest = 0;
    double most = 0.0;
    for (int k = 0; k < corners; ++k)
    {
        const pls_vec3 side = pls_sub(c->corner[k].n, c->corner[(k + 1) % corners].n); // cosines of less than 1e-8 rad would all be 1
        if (pls_dot(side, side) > most) most = pls_dot(side, side), longest = k;
    }
    const int other = (longest + 1) % corners;
    const sample middle = sample_of(a, b, pls_add(c->corner[longest].n, c->corner[other].n));
    half[0] = half[1] = *c;
    half[0].corner[longest] = half[1].corner[other] = middle;
}

/// A proof of the depth from below, by branch and bound: every direction lies in a cone over which F is bounded by no less than `upper` - `slack`, or a direction of less F
/// is found. `known`: the difference of two points of the bodies, which as a point of their Minkowski difference spares looking closely at what is around the answer.
/// Returns the bound of the least F.
static double by_bounding(const body *a, const body *b, pls_vec3 known, double upper, double slack)
{
    enum { STACK = 256, MOST = 200000 };
    const int corners = a->shape->dimension;
    cone stack[STACK];
    int count = 0;
    double low = upper;
    static const pls_vec3 axis[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    for (int k = 0; k < 1 << corners; ++k)
    {
        for (int d = 0; d < corners; ++d) stack[count].corner[d] = sample_of(a, b, pls_scale(axis[d], k >> d & 1 ? 1.0 : -1.0));
        ++count;
    }
    for (int turn = 0; count > 0; ++turn)
    {
        const cone c = stack[--count];
        for (int k = 0; k < corners; ++k) low = fmin(low, pls_dot(c.corner[k].n, c.corner[k].p));
        if (low < upper - slack) break; // less was found
        const double bound = bound_of(&c, known, corners);
        if (bound >= upper - slack || turn >= MOST || count + 2 > STACK) // what could not be proved shows as the bound that is left
            low = fmin(low, bound);
        else
            halve(a, b, &c, corners, &stack[count]), count += 2;
    }
    return low;
}

/// Golden section over t from -reach to reach of F along n + t e, or, if there is another direction f, of the least F along n + t e + u f over u.
static double least_of_strip(const body *a, const body *b, pls_vec3 n, pls_vec3 e, const pls_vec3 *f, double reach, pls_vec3 *best)
{
    enum { SECTIONS = 45 };
    const double golden = 0.5 * (sqrt(5.0) - 1.0);
    double low = -reach, high = reach, least = INFINITY, value[2] = {0.0, 0.0};
    for (int k = 0; k < SECTIONS; ++k)
    {
        const double at[2] = {high - golden * (high - low), low + golden * (high - low)};
        for (int m = 0; m < 2; ++m)
        {
            pls_vec3 there = pls_add(n, pls_scale(e, at[m]));
            if (k > 0 && !isnan(value[m])) continue; // known from the last section
            value[m] = f ? least_of_strip(a, b, there, *f, NULL, reach, &there) : F_of(a, b, there = pls_unit(there));
            if (value[m] < least) least = value[m], *best = there;
        }
        if (value[0] < value[1])
            high = at[1], value[1] = value[0], value[0] = NAN;
        else
            low = at[0], value[0] = value[1], value[1] = NAN;
    }
    return least;
}

/// From above: the least F near n, by golden sections within golden sections, as F has kinks (a support point jumps from end to end of a straight line), where an error of the normal
/// counts in first order. F is convex, and so is its least over one of two coordinates as a function of the other.
static double least_nearby(const body *a, const body *b, pls_vec3 *n)
{
    static const double reach = 1e-5; // by far more than normals are wrong
    const pls_vec3 c = *n, off = fabs(c.z) < 0.7 ? pls_vec(0.0, 0.0, 1.0) : pls_vec(1.0, 0.0, 0.0);
    const pls_vec3 u = pls_unit(pls_cross(off, c)), v = pls_cross(c, u);
    return least_of_strip(a, b, c, u, a->shape->dimension == 2 ? NULL : &v, reach, n);
}

// ---- comparison -------------------------------------------------------------------------------------------------------------------------------------------------

static void worst(double *of, double value)
{
    if (value > *of) *of = value;
}

/// A ball about a witness point that lies in the other body bounds F from below, all over.
static double bound_of_balls(const body *a, const body *b, pls_vec3 on_a, pls_vec3 on_b)
{
    return fmax(-pls_posed_sdf(&a->pose, on_b), -pls_posed_sdf(&b->pose, on_a));
}

/// Bounds from both sides; `search`: the oracle's own lower one also where a ball proves it.
static void compare(const body *a, const body *b, const pls_touch *t, double allowed, bool search, narrow_tally *tally)
{
    const double size = fmin(a->pose.size, b->pose.size), delta = t->delta;
    ++tally->checked;
    if (!isfinite(delta) || !isfinite(t->normal.x + t->normal.y + t->normal.z) || !isfinite(t->point.x + t->point.y + t->point.z))
    {
        ++tally->not_finite;
        return;
    }
    const double most = allowed * fabs(delta) / size + rounding, enough = 0.1 * most;
    pls_vec3 n = t->normal, half = pls_scale(n, 0.5 * delta), on_a = pls_add(t->point, half), on_b = pls_sub(t->point, half);
    double points = fmax(fabs(pls_posed_sdf(&a->pose, on_a)), fabs(pls_posed_sdf(&b->pose, on_b))) / size;
    double error = fmax(fabs(delta - F_of(a, b, n)) / size, fabs(pls_length(n) - 1.0));
    if (error > enough && delta < F_of(a, b, n)) // is there less nearby?
    {
        error = fabs(least_nearby(a, b, &n) - delta) / size;
        worst(&tally->normal, pls_length(pls_sub(n, t->normal)));
    }
    worst(&tally->points, points);
    const bool apart = delta < a->margin + b->margin; // cores apart: then the bounds prove it
    const bool polytopes = a->row->form == POINTS && b->row->form == POINTS;
    const double left_open = (delta - bound_of_balls(a, b, on_a, on_b)) / size;
    if (!apart && b->row->form != PLANE && !search && left_open < enough)
        error = fmax(error, left_open);
    else if (!apart && b->row->form != PLANE)
    {
        ++tally->searched;
        const pls_vec3 known = pls_sub(on_a, on_b); // of the Minkowski difference but for what the points are off by
        const double least = polytopes ? by_axes(a, b) : by_bounding(a, b, known, delta, enough * size) - 2.0 * points * size;
        error = fmax(error, (delta - least) / size);
    }
    worst(&tally->depth, error);
    if (fabs(delta) > 1e-6 * size) worst(&tally->depth_relative, error * size / fabs(delta));
    if (error > most || points > 1e-6 * fabs(delta) / size + rounding)
    {
        if (getenv("NARROW_VERBOSE") && tally->wrong < 5)
            fprintf(stderr, "wrong: %s - %s: depth %.9g of the size, error %.3g, points %.3g, %s\n", a->row->name, b->row->name,
                    delta / size, error, points,
                    apart                ? "apart"
                    : left_open < enough ? "ball"
                                         : "searched");
        ++tally->wrong;
    }
}

static pls_quat random_turn(pls_random *random, int dimension)
{
    if (dimension == 2)
    {
        double half = M_PI * pls_random_uniform(random);
        return (pls_quat){cos(half), 0.0, 0.0, sin(half)};
    }
    double q[4];
    for (int k = 0; k < 4; ++k) q[k] = pls_random_normal(random);
    return pls_quat_unit((pls_quat){q[0], q[1], q[2], q[3]});
}

static body make_body(int dimension, int number)
{
    return (body){.row = row_of(dimension, number), .shape = narrow_shape(dimension, number)};
}

static void query(const body *a, const body *b, pls_pair_state *state, pls_touch *t, pls_narrow_counts *counts)
{
    const pls_narrow_options options = {.solver = PLS_SOLVER_DEPTH, .faces = PLS_FACES_POINT};
    pls_narrow_phase(&a->pose, &b->pose, &options, state, t, counts);
}

/// Poses as the world makes them, of a size of its own.
static pls_posed any_pose(const body *s, pls_random *random)
{
    const int dimension = s->shape->dimension;
    const bool plane = s->row->form == PLANE;
    pls_vec3 at = pls_vec(pls_random_uniform(random), pls_random_uniform(random), dimension == 2 ? 0.0 : pls_random_uniform(random));
    double scale = plane ? 1.0 : 0.7 + 0.7 * pls_random_uniform(random);
    return pls_pose(s->shape, at, random_turn(random, dimension), scale);
}

static pls_posed moved(pls_posed p, pls_vec3 by)
{
    p.position = pls_add(p.position, by);
    return p;
}

/// Bring B in along e until it overlaps by `target`, nearly: a move changes the overlap by no more than its length, so it never goes deeper. What it comes to is measured anew.
static void approach(const body *a, body *b, pls_vec3 e, double target)
{
    pls_narrow_counts ignored = {0};
    pls_vec3 home = pls_sub(pls_posed_world(&a->pose, a->shape->mass.centre), pls_posed_world(&b->pose, b->shape->mass.centre));
    const pls_posed start = moved(b->pose, home);
    double distance = 1.01 * (a->pose.size + b->pose.size);
    for (int k = 0; k < 60; ++k)
    {
        pls_pair_state state = {{0}};
        pls_touch t;
        set_pose(b, moved(start, pls_scale(e, distance)));
        query(a, b, &state, &t, &ignored);
        double left = target - t.delta;
        if (left <= 0.01 * fabs(target)) break;
        distance -= left;
    }
}

/// Put B's point furthest along -n at A's furthest along n, overlapping by `target`.
static void face(const body *a, body *b, pls_vec3 n, double target)
{
    pls_vec3 by;
    if (b->row->form == PLANE)
    {
        pls_vec3 up = b->shape->dimension == 2 ? b->pose.y : b->pose.z, s = support(a, pls_scale(up, -1.0));
        by = pls_scale(up, pls_dot(up, pls_sub(s, b->pose.position)) + target);
    }
    else
        by = pls_sub(pls_sub(support(a, n), pls_scale(n, target)), support(b, pls_scale(n, -1.0)));
    set_pose(b, moved(b->pose, by));
}

void narrow_once(int dimension, int ka, int kb, const pls_posed pose[2], narrow_tally *tally)
{
    static _Thread_local body a, b;
    pls_posed at[2] = {pose[0], pose[1]};
    a = make_body(dimension, ka), b = make_body(dimension, kb);
    at[0].shape = a.shape, at[0].size = a.shape->radius * at[0].scale;
    at[1].shape = b.shape, at[1].size = b.shape->radius * at[1].scale;
    set_pose(&a, at[0]), set_pose(&b, at[1]);
    pls_pair_state state = {{0}};
    pls_touch t;
    query(&a, &b, &state, &t, &tally->counts);
    compare(&a, &b, &t, narrow_allowed(dimension, ka, kb), true, tally);
}

void narrow_random(int dimension, int ka, int kb, int pairs, int searched, uint64_t seed, narrow_tally *tally)
{
    pls_random random = pls_random_stream(seed, (uint64_t)(100 * ka + kb), PLS_FOR_USER);
    static _Thread_local body a, b;
    a = make_body(dimension, ka), b = make_body(dimension, kb);
    for (int k = 0; k < pairs; ++k)
    {
        set_pose(&a, any_pose(&a, &random));
        set_pose(&b, any_pose(&b, &random));
        double size = fmin(a.pose.size, b.pose.size), part = least_overlap * pow(most_overlap / least_overlap, pls_random_uniform(&random));
        double target = (k & 1 ? part : -part) * size;
        pls_vec3 n = random_unit(&random, dimension);
        if (b.row->form == PLANE || k & 2)
            face(&a, &b, n, target);
        else
            approach(&a, &b, n, target);
        pls_pair_state state = {{0}};
        pls_touch t;
        query(&a, &b, &state, &t, &tally->counts);
        compare(&a, &b, &t, narrow_allowed(dimension, ka, kb), k / 2 % searched == 0, tally);
    }
}

static pls_quat turn_by(pls_vec3 w, pls_quat q)
{
    return pls_quat_unit(pls_quat_multiply((pls_quat){1.0, 0.5 * w.x, 0.5 * w.y, 0.5 * w.z}, q));
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

enum { MOST_TUMBLE = 1000 };

/// Both turn, B glides about A, and its distance follows a wave of overlap that the answer of the step before steers.
static void make_trajectory(int dimension, int steps, pls_random *random, body *a, body *b, pls_posed (*poses)[2])
{
    const bool plane = b->row->form == PLANE;
    pls_quat qa = random_turn(random, dimension), qb = random_turn(random, dimension);
    double rate = 0.002 + 0.02 * pls_random_uniform(random), scale_a = 0.7 + 0.7 * pls_random_uniform(random),
           scale_b = plane ? 1.0 : 0.7 + 0.7 * pls_random_uniform(random), period = 50.0 + 300.0 * pls_random_uniform(random);
    pls_vec3 axis = dimension == 2 ? pls_vec(0.0, 0.0, 1.0) : random_unit(random, 3);
    pls_vec3 wa = pls_scale(axis, rate * pls_random_uniform(random)), e = random_unit(random, dimension);
    axis = dimension == 2 ? pls_vec(0.0, 0.0, 1.0) : random_unit(random, 3);
    pls_vec3 wb = pls_scale(axis, rate * pls_random_uniform(random)), drift = pls_scale(random_unit(random, dimension), 0.3 * rate);
    pls_narrow_counts ignored = {0};
    pls_pair_state state = {{0}};
    pls_vec3 ca = pls_vec(0.0, 0.0, 0.0), cb;
    set_pose(a, pls_pose(a->shape, ca, qa, scale_a));
    set_pose(b, pls_pose(b->shape, ca, qb, scale_b));
    const double size = fmin(a->pose.size, b->pose.size);
    if (plane)
        face(a, b, e, -most_overlap * size);
    else
        approach(a, b, e, -most_overlap * size);
    cb = plane ? b->pose.position : pls_posed_world(&b->pose, b->shape->mass.centre);
    for (int k = 0; k < steps; ++k)
    {
        poses[k][0] = a->pose, poses[k][1] = b->pose;
        pls_touch t;
        query(a, b, &state, &t, &ignored);
        double target = -most_overlap * size * cos(2.0 * M_PI * k / period) * 0.95;
        double correction = fmin(fmax(t.delta - target, -0.05 * size), 0.05 * size);
        cb = pls_add(cb, pls_scale(t.normal, correction));
        cb = pls_add(cb, pls_scale(drift, size));
        qa = turn_by(wa, qa), qb = turn_by(wb, qb);
        set_pose(a, pls_pose(a->shape, ca, qa, scale_a));
        set_pose(b, pls_pose(b->shape, cb, qb, scale_b));
    }
}

void narrow_tumble(int dimension, int ka, int kb, int trajectories, int steps, int every, int searched, uint64_t seed, narrow_tally *tally)
{
    static _Thread_local pls_posed poses[MOST_TUMBLE][2];
    static _Thread_local body a, b;
    pls_random random = pls_random_stream(seed, (uint64_t)(100 * ka + kb), PLS_FOR_USER);
    double spent = 0.0;
    if (steps > MOST_TUMBLE) steps = MOST_TUMBLE;
    a = make_body(dimension, ka), b = make_body(dimension, kb);
    for (int k = 0; k < trajectories; ++k)
    {
        make_trajectory(dimension, steps, &random, &a, &b, poses);
        const pls_narrow_options options = {.solver = PLS_SOLVER_DEPTH, .faces = PLS_FACES_POINT};
        pls_touch answer[MOST_TUMBLE];
        pls_pair_state state = {{0}};
        double start = seconds();
        for (int m = 0; m < steps; ++m) pls_narrow_phase(&poses[m][0], &poses[m][1], &options, &state, &answer[m], &tally->counts);
        spent += seconds() - start;
        for (int m = k % every; m < steps; m += every)
        {
            set_pose(&a, poses[m][0]), set_pose(&b, poses[m][1]);
            compare(&a, &b, &answer[m], narrow_allowed(dimension, ka, kb), m / every % searched == 0, tally);
        }
    }
    tally->nanoseconds = 1e9 * spent / ((double)trajectories * steps);
}
