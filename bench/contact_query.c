// contact_query.c -- what one contact query costs, for a pair of shapes: ours, warm and cold; libccd's GJK/EPA and MPR; and the deepest of n surface nodes.
//
// Pairs of bodies about 1 m in size tumble, B rolling and sliding over A by a thousandth of the size per step, and stay in touch by up to 2 % of the size, as grains of
// a packing do. All poses are made first, so that every method answers the same questions and only answering is timed. Depths are compared on the way: a method
// that finds something else has not answered.
//
// Prints one line of JSON. libccd (Debian: libccd-dev) is used if CMake found it. Its tolerance of depth is set to 1e-6 m; ours have no tolerance to choose.

#include <particls/shape.h>

#include "base/alloc.h"
#include "base/random.h"
#include "contact/narrow_phase.h"
#include "contact/overlap_record.h"
#include "shape/builtin.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef PLS_BENCH_CCD
#include <ccd/ccd.h>
#endif

enum { MOST_NODES = 2000 };
static const double motion = 1e-3; // of the size, per step
static const double deepest = 0.02;

// ---- the shapes -------------------------------------------------------------------------------------------------------------------------------------------------

static const pls_parameter none[] = {{.name = NULL}};

/// A box with rounded edges as a user may give it: values alone.
static double rounded_box(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    pls_vec3 d = pls_vec(fabs(X.x) - 0.4, fabs(X.y) - 0.3, fabs(X.z) - 0.2);
    double out = sqrt(pow(fmax(d.x, 0.0), 2) + pow(fmax(d.y, 0.0), 2) + pow(fmax(d.z, 0.0), 2));
    return out + fmin(fmax(d.x, fmax(d.y, d.z)), 0.0) - 0.1;
}

static const pls_shape_ops sdf_alone = {
    .api_version = PLS_API_VERSION, .name = "sdf", .parameters = none, .in_3d = true, .convex = true, .sdf = rounded_box};

typedef struct entry
{
    const char *name;
    const pls_shape_ops *ops;
    double values[8];
    int points; ///< of a hull
    int dimension;
} entry;

static const entry entries[] = {
    {"sphere", &pls_sphere_shape, {0.5}, 0, 3},
    {"box", &pls_box_shape, {0.5, 0.4, 0.3, 0.0}, 0, 3},
    {"capsule", &pls_capsule_shape, {0.25, 0.5}, 0, 3},
    {"cylinder", &pls_cylinder_shape, {0.4, 0.8, 0.0}, 0, 3},
    {"ellipsoid", &pls_ellipsoid_shape, {0.5, 0.4, 0.3}, 0, 3},
    {"superquadric", &pls_superquadric_shape, {0.5, 0.4, 0.3, 0.7, 0.6}, 0, 3},
    {"rounded-box", &pls_box_shape, {0.5, 0.4, 0.3, 0.1}, 0, 3},
    {"rounded-polyhedron", &pls_polyhedron_shape, {0.1}, 32, 3},
    {"prism", &pls_prism_shape, {0.0, 0.6}, 6, 3},
    {"polyhedron32", &pls_polyhedron_shape, {0.0}, 32, 3},
    {"polyhedron128", &pls_polyhedron_shape, {0.0}, 128, 3},
    {"sdf", &sdf_alone, {0.0}, 0, 3},
    {"plane", &pls_plane_shape, {0.0}, 0, 3},
    {"disc", &pls_disc_shape, {0.5}, 0, 2},
    {"rectangle", &pls_box_shape, {0.5, 0.35, 1.0, 0.0}, 0, 2},
    {"rounded-rectangle", &pls_box_shape, {0.5, 0.35, 1.0, 0.1}, 0, 2},
    {"stadium", &pls_capsule_shape, {0.25, 0.5}, 0, 2},
    {"ellipse", &pls_ellipse_shape, {0.5, 0.35, 1.0}, 0, 2},
    {"superellipse", &pls_superquadric_shape, {0.5, 0.4, 1.0, 1.0, 0.6}, 0, 2},
    {"polygon", &pls_polygon_shape, {0.0}, 8, 2},
    {"half-plane", &pls_half_plane_shape, {0.0}, 0, 2},
};

static void stop(const char *message)
{
    fprintf(stderr, "contact_query: %s\n", message);
    exit(1);
}

static pls_shape *make_shape(const char *name)
{
    for (size_t k = 0; k < sizeof entries / sizeof *entries; ++k)
    {
        const entry *e = &entries[k];
        if (strcmp(e->name, name) != 0) continue;
        pls_vec3 point[128];
        const bool flat = e->dimension == 2 || e->ops == &pls_prism_shape;
        for (int p = 0; p < e->points; ++p) // on an ellipse, or on an ellipsoid by the golden angle, so that all are corners
        {
            if (flat)
            {
                const double angle = 2.0 * M_PI * p / e->points;
                point[p] = pls_vec(0.5 * cos(angle), 0.4 * sin(angle), 0.0);
                continue;
            }
            double z = 1.0 - (2.0 * p + 1.0) / e->points, r = sqrt(1.0 - z * z), angle = 2.399963229728653 * p;
            point[p] = pls_vec(0.5 * r * cos(angle), 0.4 * r * sin(angle), 0.35 * z);
        }
        pls_shape_input input = {
            .values = e->values, .value_count = sizeof e->values / sizeof *e->values, .points = point, .point_count = (size_t)e->points};
        pls_shape *shape = NULL;
        if (pls_shape_make(e->ops, e->dimension, &input, name, &shape) != PLS_OK) stop(pls_last_message());
        return shape;
    }
    fprintf(stderr, "usage: contact_query SHAPE SHAPE [PAIRS [STEPS]]   (shapes:");
    for (size_t k = 0; k < sizeof entries / sizeof *entries; ++k) fprintf(stderr, " %s", entries[k].name);
    fprintf(stderr, "; a plane comes last, in 2D a half-plane; both of one dimension)\n");
    exit(2);
}

// ---- the poses --------------------------------------------------------------------------------------------------------------------------------------------------

/// Poses of all pairs in all steps, [step * pairs + pair].
typedef struct job
{
    const pls_shape *a, *b;
    size_t pairs, steps;
    pls_posed *pose_a, *pose_b;
    double *depth; ///< by the narrow phase, warm
} job;

static const pls_narrow_options options = {.solver = PLS_SOLVER_DEPTH, .faces = PLS_FACES_POINT};

static pls_vec3 random_unit(pls_random *random, int dimension)
{
    double x = pls_random_normal(random), y = pls_random_normal(random), z = pls_random_normal(random);
    return pls_unit(pls_vec(x, y, dimension == 2 ? 0.0 : z));
}

/// In 2D only about z.
static pls_vec3 random_axis(pls_random *random, int dimension)
{
    const pls_vec3 axis = random_unit(random, 3);
    return dimension == 2 ? pls_vec(0.0, 0.0, axis.z < 0.0 ? -1.0 : 1.0) : axis;
}

static pls_quat turn_by(pls_quat q, pls_vec3 axis, double angle)
{
    double s = sin(0.5 * angle);
    return pls_quat_unit(pls_quat_multiply((pls_quat){cos(0.5 * angle), axis.x * s, axis.y * s, axis.z * s}, q));
}

static pls_posed pose(const pls_shape *shape, pls_vec3 x, pls_quat q)
{
    pls_posed p = pls_pose(shape, x, q, 1.0);
    if (shape->ops->unbounded) p.position = x;
    return p;
}

static double size_of(const job *j) { return j->b->ops->unbounded ? j->a->radius : fmin(j->a->radius, j->b->radius); }

/// Tumble one pair. B is moved along the last normal to the depth wanted, which goes up and down between 0 and 2 %.
static void tumble(job *j, size_t pair, pls_narrow_counts *counts)
{
    pls_random random = pls_random_stream(7, pair, PLS_FOR_USER);
    const bool wall = j->b->ops->unbounded;
    const double size = 2.0 * size_of(j), phase = 2.0 * M_PI * pls_random_uniform(&random);
    const int d = j->a->dimension;
    pls_vec3 e = random_unit(&random, d), spin_a = random_axis(&random, d), spin_b = random_axis(&random, d),
             slide = random_unit(&random, d);
    pls_quat qa = turn_by(pls_quat_identity(), random_axis(&random, d), 2.0 * M_PI * pls_random_uniform(&random));
    pls_quat qb = turn_by(pls_quat_identity(), random_axis(&random, d), 2.0 * M_PI * pls_random_uniform(&random));
    pls_vec3 xa = pls_vec(0.0, 0.0, 0.0), xb = pls_scale(e, wall ? -j->a->radius : 0.99 * (j->a->radius + j->b->radius));
    pls_pair_state state = {{0}};
    pls_touch touch = {.delta = 0.0};
    for (size_t step = 0; step < j->steps; ++step)
    {
        double wanted = size * deepest * (0.5 + 0.5 * sin(phase + 0.1 * (double)step));
        if (step > 0)
        {
            qa = turn_by(qa, spin_a, 0.5 * motion);
            if (!wall) qb = turn_by(qb, spin_b, 0.5 * motion);
            pls_vec3 across = pls_sub(slide, pls_scale(touch.normal, pls_dot(slide, touch.normal)));
            xb = pls_add(xb, pls_scale(across, 0.5 * motion * size));
        }
        const int turns = step == 0 ? 60 : 2;
        for (int k = 0; k <= turns; ++k)
        {
            pls_posed a = pose(j->a, xa, qa), b = pose(j->b, xb, qb);
            if (step == 0) memset(&state, 0, sizeof state);
            pls_narrow_phase(&a, &b, &options, &state, &touch, counts);
            j->pose_a[step * j->pairs + pair] = a, j->pose_b[step * j->pairs + pair] = b;
            j->depth[step * j->pairs + pair] = touch.depth;
            if (k < turns) xb = pls_add(xb, pls_scale(touch.normal, touch.depth - wanted));
            if (k < turns && fabs(touch.depth - wanted) < 1e-3 * size) k = turns - 1;
        }
    }
}

// ---- the methods ------------------------------------------------------------------------------------------------------------------------------------------------

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/// What a method took for a query, how many pairs it saw touching, and how far it was from our depths, in sizes.
typedef struct result
{
    double ns, worst, mean;
    size_t touching, missed; ///< missed: we say it overlaps by more than 1e-4 of the size, the method says no
    double below;            ///< the most by which the overlap along the method's normal is less than our depth: it should be none
} result;

static void compare(const job *j, size_t k, bool touching, double depth, result *r)
{
    const double size = 2.0 * size_of(j);
    if (!touching)
    {
        r->missed += j->depth[k] > 1e-4 * size;
        return;
    }
    double off = fabs(depth - j->depth[k]) / size;
    ++r->touching;
    r->mean += off;
    r->worst = fmax(r->worst, off);
}

/// The step's own question: states are kept, the first step is not timed.
static result time_warm(const job *j, pls_narrow_counts *counts)
{
    result r = {.ns = 0.0};
    pls_pair_state *state = NULL;
    pls_narrow_counts first = {0};
    if (pls_allocate(&state, j->pairs, sizeof *state, "states") != PLS_OK) stop(pls_last_message());
    double begin = 0.0, sum = 0.0;
    for (size_t step = 0; step < j->steps; ++step)
    {
        if (step == 1) begin = now();
        for (size_t p = 0; p < j->pairs; ++p)
        {
            const size_t k = step * j->pairs + p;
            pls_touch touch;
            pls_narrow_phase(&j->pose_a[k], &j->pose_b[k], &options, &state[p], &touch, step == 0 ? &first : counts);
            sum += touch.delta;
            r.touching += touch.delta > 0.0;
        }
    }
    r.ns = 1e9 * (now() - begin) / (double)(j->pairs * (j->steps - 1));
    if (!isfinite(sum)) stop("a depth is not a number");
    pls_release(&state);
    return r;
}

/// The default law, as a step asks: contacts that go on by their record, where that tells.
static double time_manifold(const job *j)
{
    const pls_narrow_options manifold = {.solver = PLS_SOLVER_DEPTH, .faces = PLS_FACES_MANIFOLD};
    pls_pair_state *state = NULL;
    pls_overlap_record *record = NULL;
    pls_narrow_counts counts = {0};
    if (pls_allocate(&state, j->pairs, sizeof *state, "states") != PLS_OK ||
        pls_allocate(&record, j->pairs, sizeof *record, "records") != PLS_OK)
        stop(pls_last_message());
    double begin = 0.0, sum = 0.0;
    for (size_t step = 0; step < j->steps; ++step)
    {
        if (step == 1) begin = now();
        for (size_t p = 0; p < j->pairs; ++p)
        {
            const pls_posed *a = &j->pose_a[step * j->pairs + p], *b = &j->pose_b[step * j->pairs + p];
            pls_touch touch;
            if (step == 0 || !pls_narrow_phase_again(a, b, &manifold, &record[p], &touch, &counts))
                pls_narrow_phase_from(a, b, &manifold, &state[p], &record[p], &touch, &counts);
            sum += touch.delta;
        }
    }
    const double ns = 1e9 * (now() - begin) / (double)(j->pairs * (j->steps - 1));
    if (!isfinite(sum)) stop("an overlap is not a number");
    pls_release(&state), pls_release(&record);
    return ns;
}

static result time_cold(const job *j)
{
    result r = {.ns = 0.0};
    pls_narrow_counts counts = {0};
    double begin = now();
    for (size_t k = 0; k < j->pairs * j->steps; k += 7)
    {
        pls_pair_state state = {{0}};
        pls_touch touch;
        pls_narrow_phase(&j->pose_a[k], &j->pose_b[k], &options, &state, &touch, &counts);
        compare(j, k, touch.depth > 0.0, touch.depth, &r);
    }
    r.ns = 1e9 * (now() - begin) / ((double)(j->pairs * j->steps + 6) / 7.0);
    r.mean /= fmax(1.0, (double)r.touching);
    return r;
}

#ifdef PLS_BENCH_CCD
static void ccd_support(const void *self, const ccd_vec3_t *d, ccd_vec3_t *out)
{
    const double length = sqrt(d->v[0] * d->v[0] + d->v[1] * d->v[1] + d->v[2] * d->v[2]);
    pls_vec3 p = pls_posed_support(self, pls_scale(pls_vec(d->v[0], d->v[1], d->v[2]), 1.0 / length));
    out->v[0] = p.x, out->v[1] = p.y, out->v[2] = p.z;
}

static void ccd_centre(const void *self, ccd_vec3_t *out)
{
    const pls_posed *p = self;
    out->v[0] = p->position.x, out->v[1] = p->position.y, out->v[2] = p->position.z;
}

typedef int penetration(const void *, const void *, const ccd_t *, ccd_real_t *, ccd_vec3_t *, ccd_vec3_t *);

/// Overlap along n: the depth is the least of all.
static double overlap_along(const pls_posed *a, const pls_posed *b, pls_vec3 n)
{
    return pls_dot(n, pls_sub(pls_posed_support(a, n), pls_posed_support(b, pls_scale(n, -1.0))));
}

static result time_ccd(const job *j, penetration *find)
{
    result r = {.ns = 0.0};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccd_support;
    ccd.center1 = ccd.center2 = ccd_centre;
    ccd.max_iterations = 500;
    ccd.epa_tolerance = ccd.mpr_tolerance = 1e-6;
    const size_t all = j->pairs * j->steps;
    ccd_vec3_t *direction = NULL, place;
    if (pls_allocate(&direction, all, sizeof *direction, "directions") != PLS_OK) stop(pls_last_message());
    double begin = now();
    for (size_t k = j->pairs; k < all; ++k)
    {
        ccd_real_t depth = 0.0;
        int touching = find(&j->pose_a[k], &j->pose_b[k], &ccd, &depth, &direction[k], &place);
        compare(j, k, touching == 0, depth, &r);
    }
    r.ns = 1e9 * (now() - begin) / (double)(all - j->pairs);
    r.mean /= fmax(1.0, (double)r.touching);
    for (size_t k = j->pairs; k < all; ++k)
    {
        pls_vec3 n = pls_vec(direction[k].v[0], direction[k].v[1], direction[k].v[2]);
        if (!(pls_dot(n, n) > 0.25)) continue; // it saw no overlap
        r.below = fmax(r.below, (j->depth[k] - overlap_along(&j->pose_a[k], &j->pose_b[k], pls_unit(n))) / (2.0 * size_of(j)));
    }
    pls_release(&direction);
    return r;
}
#endif

/// P1's rival: B's SDF at n nodes of A's surface, the deepest of them is the contact. A sparse share of the queries.
static result time_nodes(const job *j, const pls_vec3 *node, size_t n)
{
    result r = {.ns = 0.0};
    size_t asked = 0, stride = 1 + j->pairs * j->steps * n / 500000;
    double begin = now();
    for (size_t k = 0; k < j->pairs * j->steps; k += stride)
    {
        const pls_posed *a = &j->pose_a[k], *b = &j->pose_b[k];
        double least = INFINITY;
        for (size_t i = 0; i < n; ++i) least = fmin(least, pls_posed_sdf(b, pls_posed_world(a, node[i])));
        compare(j, k, least < 0.0, -least, &r);
        ++asked;
    }
    r.ns = 1e9 * (now() - begin) / (double)asked;
    r.mean /= fmax(1.0, (double)r.touching);
    return r;
}

// ---- the line -------------------------------------------------------------------------------------------------------------------------------------------------------

static void print_result(const char *name, const result *r)
{
    printf(", \"%s_ns\": %.1f, \"%s_worst\": %.3g, \"%s_mean\": %.3g, \"%s_missed\": %zu", name, r->ns, name, r->worst, name, r->mean, name,
           r->missed);
}

static void measure_nodes(const job *j)
{
    static const size_t counts[3] = {100, 500, MOST_NODES};
    static pls_vec3 node[MOST_NODES];
    if (j->a->ops != j->b->ops || j->a->dimension == 2 || strcmp(j->b->ops->name, "superquadric") == 0)
        return; // the others, and 15 us per value, tell nothing new
    for (int c = 0; c < 3; ++c)
    {
        char name[32];
        if (pls_shape_surface_nodes(j->a, counts[c], node) != PLS_OK) stop(pls_last_message());
        result r = time_nodes(j, node, counts[c]);
        snprintf(name, sizeof name, "nodes_%zu", counts[c]);
        print_result(name, &r);
    }
}

static size_t number(int argc, char **argv, int at, size_t otherwise, size_t least)
{
    if (argc <= at) return otherwise;
    char *end;
    unsigned long value = strtoul(argv[at], &end, 10);
    if (*end || value < least || value > 100000)
    {
        fprintf(stderr, "usage: contact_query SHAPE SHAPE [PAIRS [STEPS]]; '%s' is no number of at least %zu\n", argv[at], least);
        exit(2);
    }
    return value;
}

int main(int argc, char **argv)
{
    if (argc < 3 || argc > 5) make_shape(""); // tells the usage
    pls_shape *a = make_shape(argv[1]), *b = make_shape(argv[2]);
    if (a->ops->unbounded || a->dimension != b->dimension) make_shape("");
    job j = {.a = a, .b = b, .pairs = number(argc, argv, 3, 500, 1), .steps = number(argc, argv, 4, 100, 2)};
    const size_t all = j.pairs * j.steps;
    if (pls_allocate(&j.pose_a, all, sizeof *j.pose_a, "poses") != PLS_OK ||
        pls_allocate(&j.pose_b, all, sizeof *j.pose_b, "poses") != PLS_OK ||
        pls_allocate(&j.depth, all, sizeof *j.depth, "depths") != PLS_OK)
        stop(pls_last_message());
    pls_narrow_counts making = {0}, counts = {0};
    for (size_t p = 0; p < j.pairs; ++p) tumble(&j, p, &making);
    result warm = time_warm(&j, &counts), cold = time_cold(&j);
    const double manifold = time_manifold(&j);
    printf("{\"a\": \"%s\", \"b\": \"%s\", \"pairs\": %zu, \"steps\": %zu, \"touching\": %.3f, \"iterations\": %.3f, \"restarts\": %llu, "
           "\"fallbacks\": %llu, "
           "\"failures\": %llu, \"warm_ns\": %.1f, \"manifold_ns\": %.1f",
           argv[1], argv[2], j.pairs, j.steps, (double)warm.touching / (double)all, (double)counts.iterations / (double)counts.queries,
           (unsigned long long)counts.restarts, (unsigned long long)counts.fallbacks, (unsigned long long)counts.failures, warm.ns,
           manifold);
    print_result("cold", &cold);
#ifdef PLS_BENCH_CCD
    if (!b->ops->unbounded && a->dimension == 3)
    {
        result epa = time_ccd(&j, ccdGJKPenetration), mpr = time_ccd(&j, ccdMPRPenetration);
        print_result("gjk_epa", &epa);
        print_result("mpr", &mpr);
        printf(", \"ours_above\": %.3g", fmax(epa.below, mpr.below));
    }
#endif
    measure_nodes(&j);
    printf("}\n");
    pls_release(&j.pose_a), pls_release(&j.pose_b), pls_release(&j.depth);
    pls_shape_free(a), pls_shape_free(b);
    return 0;
}
