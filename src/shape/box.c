// box.c -- the box, in 2D the rectangle, with edges rounded by a ball if wanted.
//
// A rounded box is the set of points within `rounding` of a smaller box, the core, so its distance is the core's less the rounding, outside and inside. The core is
// a polytope: contact works on eight corners and adds the rounding as a margin. The half edges are those of the whole.

#include "shape/builtin.h"

#include "base/alloc.h"

static const pls_parameter parameters[] = {
    {.name = "half",
     .unit = "m",
     .meaning = "half edges along x, y, z, in 2D along x, y; rounding included",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true,
     .components = 3},
    {.name = "rounding",
     .unit = "m",
     .meaning = "radius of the ball that rounds edges and corners, less than the least half edge",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = INFINITY},
    {.name = NULL},
};

enum { ROUNDING = 3 };

typedef struct box
{
    double half[3]; ///< of the core
    pls_vec3 vertex[8], normal[6];
    uint32_t face_start[7], face_vertex[24], neighbour_start[9], neighbour[24];
    pls_polytope polytope;
} box;

static const box *box_of(const pls_shape *shape) { return shape->data; }

// ---- the polytope -----------------------------------------------------------------------------------------------------------------------------------------

/// Vertex v lies on the sides of x, y, z that its bits tell; its neighbours differ in one bit.
static void fill_vertices(box *b, int dimension)
{
    const uint32_t count = dimension == 2 ? 4 : 8;
    uint32_t links = 0;
    for (uint32_t v = 0; v < count; ++v)
    {
        b->vertex[v] = pls_vec(v & 1 ? b->half[0] : -b->half[0], v & 2 ? b->half[1] : -b->half[1], v & 4 ? b->half[2] : -b->half[2]);
        if (dimension == 2) b->vertex[v].z = 0.0;
        b->neighbour_start[v] = links;
        for (int a = 0; a < dimension; ++a) b->neighbour[links++] = v ^ (1u << a);
    }
    b->neighbour_start[count] = links;
    b->polytope = (pls_polytope){.vertex = b->vertex,
                                 .vertex_count = count,
                                 .face_start = b->face_start,
                                 .face_vertex = b->face_vertex,
                                 .face_normal = b->normal,
                                 .face_count = 2 * (uint32_t)dimension,
                                 .neighbour_start = b->neighbour_start,
                                 .neighbour = b->neighbour};
}

/// Faces 2a and 2a + 1 look down and up axis a. Seen from above, going from axis a + 1 to axis a + 2 turns to the left.
static void fill_faces(box *b, int dimension)
{
    static const uint32_t around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const uint32_t corners = dimension == 2 ? 2 : 4;
    for (uint32_t f = 0; f < b->polytope.face_count; ++f)
    {
        const uint32_t a = f / 2, up = f & 1, d = (uint32_t)dimension, next = (a + 1) % d, last = (a + 2) % d;
        double n[3] = {0.0, 0.0, 0.0};
        n[a] = up ? 1.0 : -1.0;
        b->normal[f] = pls_vec(n[0], n[1], n[2]);
        b->face_start[f] = f * corners;
        for (uint32_t k = 0; k < corners; ++k)
        {
            // 2D: counter-clockwise about the whole, up along y on the right side (x = +) and to the left along the top (y = +).
            const uint32_t side = dimension == 2 ? k ^ (up ^ (a == 0)) : 0, *step = around[up ? k : 3 - k % 4];
            b->face_vertex[f * corners + k] = up << a | (dimension == 2 ? side << next : step[0] << next | step[1] << last);
        }
    }
    b->face_start[b->polytope.face_count] = b->polytope.face_count * corners;
}

static pls_status prepare(const pls_shape_input *input, int dimension, void **data)
{
    box *b = NULL;
    double rounding = input->values[ROUNDING];
    for (int a = 0; a < dimension; ++a)
        if (!(rounding < input->values[a]))
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "a box's 'rounding' must be less than its half edges, %g m is not less than half[%d], %g m: make it smaller",
                            rounding, a, input->values[a]);
    PLS_TRY(pls_allocate(&b, 1, sizeof *b, "a box"));
    for (int a = 0; a < dimension; ++a) b->half[a] = input->values[a] - rounding;
    fill_vertices(b, dimension);
    fill_faces(b, dimension);
    *data = b;
    return PLS_OK;
}

static void release(void *data) { pls_release(&data); }

static const pls_polytope *polytope(const pls_shape *shape) { return &box_of(shape)->polytope; }

static double margin(const pls_shape *shape) { return shape->values[ROUNDING]; }

static pls_vec3 support(const pls_shape *shape, pls_vec3 n)
{
    const double *h = box_of(shape)->half;
    return pls_vec(copysign(h[0], n.x), copysign(h[1], n.y), copysign(h[2], n.z)); // 2D: h[2] = 0
}

// ---- distance -----------------------------------------------------------------------------------------------------------------------------------------------

/// How far beyond each pair of the core's sides; the place of the largest.
static int beyond(const pls_shape *shape, pls_vec3 X, double q[3])
{
    const double *h = box_of(shape)->half;
    int most = 0;
    q[0] = fabs(X.x) - h[0];
    q[1] = fabs(X.y) - h[1];
    q[2] = shape->dimension == 2 ? -INFINITY : fabs(X.z) - h[2];
    for (int a = 1; a < 3; ++a)
        if (q[a] > q[most]) most = a;
    return most;
}

static double outside(const double q[3]) { return pls_length(pls_vec(fmax(q[0], 0.0), fmax(q[1], 0.0), fmax(q[2], 0.0))); }

static double sdf(const pls_shape *shape, pls_vec3 X)
{
    double q[3], rounding = shape->values[ROUNDING];
    int most = beyond(shape, X, q);
    return (q[most] > 0.0 ? outside(q) : q[most]) - rounding;
}

static pls_vec3 gradient(const pls_shape *shape, pls_vec3 X)
{
    double q[3], g[3] = {0.0, 0.0, 0.0};
    int most = beyond(shape, X, q);
    double length = outside(q);
    if (length > 0.0)
        for (int a = 0; a < 3; ++a) g[a] = fmax(q[a], 0.0) / length;
    else
        g[most] = 1.0;
    return pls_vec(copysign(g[0], X.x), copysign(g[1], X.y), copysign(g[2], X.z));
}

/// Beyond a step from the core, the step back. Else the answer lies in the core, where phi = max q =: m, so each coordinate is cut at its half edge + m; at the
/// best m what is cut off sums to `step` (d/dm = 0), unless m = 0 or a coordinate is cut to nothing. The sum is piecewise linear in m.
static pls_vec3 proximal(const pls_shape *shape, pls_vec3 X, double step)
{
    const double *h = box_of(shape)->half;
    double q[3], least = INFINITY, m = 0.0;
    int most = beyond(shape, X, q);
    if (q[most] > 0.0 && outside(q) >= step) return pls_sub(X, pls_scale(gradient(shape, X), step));
    for (int a = 0; a < shape->dimension; ++a) least = fmin(least, h[a]);
    m = q[most] - step; // not above the solution; Newton from there, exact once the cut coordinates are known
    for (int k = 0; k < 4; ++k)
    {
        double sum = 0.0, cut = 0.0;
        for (int a = 0; a < shape->dimension; ++a)
            if (q[a] > m) sum += q[a], cut += 1.0;
        if (cut > 0.0) m = fmax(m, (sum - step) / cut);
    }
    m = fmin(fmax(m, -least), 0.0);
    double cut[3] = {fmax(h[0] + m, 0.0), fmax(h[1] + m, 0.0), fmax(h[2] + m, 0.0)};
    return pls_vec(fmin(fmax(X.x, -cut[0]), cut[0]), fmin(fmax(X.y, -cut[1]), cut[1]), fmin(fmax(X.z, -cut[2]), cut[2]));
}

// ---- size and mass ------------------------------------------------------------------------------------------------------------------------------------------

static double bounding_radius(const pls_shape *shape)
{
    const double *h = box_of(shape)->half;
    return pls_length(pls_vec(h[0], h[1], h[2])) + shape->values[ROUNDING];
}

static void bounds(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper)
{
    const double *v = shape->values;
    *upper = pls_vec(v[0], v[1], shape->dimension == 2 ? 0.0 : v[2]);
    *lower = pls_scale(*upper, -1.0);
}

/// Integral of x^2 over what lies on the faces, edges and corners of the core and in it, a being its half edge along x.
static double second_moment(double a, double b, double c, double r)
{
    double shell = (pow(a + r, 3.0) - pow(a, 3.0)) / 3.0, square = a * a / 3.0;
    double faces = 8.0 * (b * c * shell + (a * b * c + a * c * r + a * b * r) * square);
    double edges = 2.0 * (a * M_PI * r * r * square + (b + c) * pls_disc_apart(a, r));
    return faces + edges + pls_ball_apart(a, r);
}

static double second_moment_2d(double a, double b, double r)
{
    double shell = (pow(a + r, 3.0) - pow(a, 3.0)) / 3.0;
    return 4.0 * (b * shell + a * (b + r) * a * a / 3.0) + pls_disc_apart(a, r);
}

static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    const double *h = box_of(shape)->half, r = shape->values[ROUNDING], a = h[0], b = h[1], c = h[2];
    *out = (pls_mass_properties){0};
    if (shape->dimension == 2)
    {
        out->volume = 4.0 * (a * b + (a + b) * r) + M_PI * r * r;
        out->inertia[2] = second_moment_2d(a, b, r) + second_moment_2d(b, a, r);
        return PLS_OK;
    }
    double xx = second_moment(a, b, c, r), yy = second_moment(b, c, a, r), zz = second_moment(c, a, b, r);
    out->volume =
        8.0 * (a * b * c + (a * b + b * c + c * a) * r) + 2.0 * M_PI * r * r * (a + b + c) + 4.0 / 3.0 * M_PI * r * r * r; // Steiner
    out->inertia[0] = yy + zz;
    out->inertia[1] = xx + zz;
    out->inertia[2] = xx + yy;
    return PLS_OK;
}

const pls_shape_ops pls_box_shape = {
    .api_version = PLS_API_VERSION,
    .name = "box",
    .meaning = "a box, in 2D a rectangle; its edges may be rounded",
    .parameters = parameters,
    .in_2d = true,
    .in_3d = true,
    .convex = true,
    .prepare = prepare,
    .release = release,
    .sdf = sdf,
    .gradient = gradient,
    .support = support,
    .margin = margin,
    .polytope = polytope,
    .proximal = proximal,
    .bounding_radius = bounding_radius,
    .bounds = bounds,
    .mass_properties = mass_properties,
};
