// contact_methods.c -- the penetration depth and P1's eq. 14 on the same pairs of shapes: how far they differ, what ADMM costs, and what both do to energy.
//
//     contact_methods DIR [COLLISIONS [WORD]]     writes tables and numbers for docs/contact-detection.md to DIR; 100 collisions of each pair by default;
//                                                 with a word only of pairs in whose names it is
//
// Exit status 1 when energy is not kept by default.

#include "contact/admm.h"
#include "contact/narrow_phase.h"
#include "contact/sampled_touch.h"
#include "contact/solid_list.h"

#include "base/random.h"
#include "shape/builtin.h"
#include "shape/surface_sample.h"
#include "support/numbers.h"
#include "support/values_alone.h"
#include "support/two_bodies.h"
#include "support/verify.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS_PER_CONTACT = 800, POSES = 300, TRAJECTORIES = 20, STEPS = 60, HULL_POINTS = 32, TOLERANCES = 3, MOST_COLLISIONS = 1000 };

static const double tolerances[TOLERANCES] = {1e-3, 1e-6, 1e-8};
static const double depth_tolerance = 1e-8;                      ///< of ADMM where depths and directions are compared
static const double step_of_path = 1e-4;                         ///< of the size and in radians: what a body does in a step of a simulation
static const double hardest = 0.02;                              ///< overlap of a central impact, of the size
static const double median_allowed = 1e-5, worst_allowed = 2e-3; ///< change of energy by default

// ---- shapes ---------------------------------------------------------------------------------------------------------------------------------------------------

typedef struct example
{
    const char *name;
    const pls_shape_ops *ops;
    int dimension;
    double values[6];
    int hull_points;
} example;

/// Half-spaces come last of their dimension: they are B.
enum {
    SPHERE,
    BOX,
    ROUNDED_BOX,
    CAPSULE,
    CYLINDER,
    ELLIPSOID,
    SUPERQUADRIC,
    POLYHEDRON,
    PRISM,
    COMPOUND,
    SDF_ONLY,
    PLANE,
    DISC,
    RECTANGLE,
    FLAT_CAPSULE,
    ELLIPSE,
    POLYGON,
    HALF_PLANE,
    EXAMPLES
};

static const example examples[EXAMPLES] = {
    [SPHERE] = {"sphere", &pls_sphere_shape, 3, {0.7}, 0},
    [BOX] = {"box", &pls_box_shape, 3, {0.5, 0.6, 0.8, 0.0}, 0},
    [ROUNDED_BOX] = {"rounded box", &pls_box_shape, 3, {0.5, 0.6, 0.8, 0.1}, 0},
    [CAPSULE] = {"capsule", &pls_capsule_shape, 3, {0.4, 1.2}, 0},
    [CYLINDER] = {"cylinder", &pls_cylinder_shape, 3, {0.5, 1.4, 0.0}, 0},
    [ELLIPSOID] = {"ellipsoid", &pls_ellipsoid_shape, 3, {0.5, 0.7, 0.9}, 0},
    [SUPERQUADRIC] = {"superquadric", &pls_superquadric_shape, 3, {0.6, 0.7, 0.8, 0.7, 0.7}, 0},
    [POLYHEDRON] = {"polyhedron", &pls_polyhedron_shape, 3, {0.0}, HULL_POINTS},
    [PRISM] = {"prism", &pls_prism_shape, 3, {[1] = 1.2}, 7},
    [COMPOUND] = {"compound", &pls_compound_shape, 3, {0.0}, 0},
    [SDF_ONLY] = {"SDF only", &values_cone, 3, {0.6, 0.3, 0.8}, 0},
    [PLANE] = {"plane", &pls_plane_shape, 3, {0.0}, 0},
    [DISC] = {"disc", &pls_disc_shape, 2, {0.7}, 0},
    [RECTANGLE] = {"rectangle", &pls_box_shape, 2, {0.5, 0.7, 1.0, 0.0}, 0},
    [FLAT_CAPSULE] = {"2D capsule", &pls_capsule_shape, 2, {0.4, 1.2}, 0},
    [ELLIPSE] = {"ellipse", &pls_ellipse_shape, 2, {0.5, 0.9, 1.0}, 0},
    [POLYGON] = {"polygon", &pls_polygon_shape, 2, {0.0}, 8},
    [HALF_PLANE] = {"half-plane", &pls_half_plane_shape, 2, {0.0}, 0},
};

/// Pairs of which depths, directions and iterations are told; the energy is of all pairs.
static const int chosen[][2] = {
    {SPHERE, SPHERE},
    {SPHERE, ELLIPSOID},
    {ELLIPSOID, ELLIPSOID},
    {ELLIPSOID, SUPERQUADRIC},
    {SUPERQUADRIC, SUPERQUADRIC},
    {SPHERE, BOX},
    {BOX, ELLIPSOID},
    {ELLIPSOID, POLYHEDRON},
    {CAPSULE, CAPSULE},
    {BOX, CAPSULE},
    {ROUNDED_BOX, ROUNDED_BOX},
    {CYLINDER, CYLINDER},
    {BOX, CYLINDER},
    {BOX, BOX},
    {BOX, POLYHEDRON},
    {POLYHEDRON, POLYHEDRON},
    {ELLIPSOID, PLANE},
    {BOX, PLANE},
    {POLYHEDRON, PLANE},
    {DISC, RECTANGLE},
    {ELLIPSE, ELLIPSE},
    {RECTANGLE, RECTANGLE},
    {POLYGON, POLYGON},
};
enum { CHOSEN = sizeof chosen / sizeof *chosen, MOST_PAIRS = EXAMPLES * EXAMPLES / 2, PAIR_NAME = 64 };

static void name_pair(int a, int b, char name[PAIR_NAME]) { snprintf(name, PAIR_NAME, "%s - %s", examples[a].name, examples[b].name); }

/// All in whose names the word is, but half-spaces on each other; the first shape's pairs first. Returns how many.
static int list_pairs(const char *word, int pairs[MOST_PAIRS][2])
{
    int count = 0;
    for (int a = 0; a < EXAMPLES; ++a)
        for (int b = a; b < EXAMPLES; ++b)
        {
            if (examples[a].dimension != examples[b].dimension || examples[a].ops->unbounded) continue;
            char name[PAIR_NAME];
            name_pair(a, b, name);
            if (strstr(name, word)) pairs[count][0] = a, pairs[count++][1] = b;
        }
    return count;
}

/// Two boxes and a ball, an angle piece with a knob.
static pls_status make_compound(const example *e, pls_shape **out)
{
    static const double half[2][4] = {{0.6, 0.25, 0.3, 0.0}, {0.2, 0.5, 0.25, 0.0}}, radius = 0.3;
    static const pls_vec3 middle[3] = {{0.0, 0.0, 0.0}, {-0.45, 0.5, 0.0}, {0.55, 0.1, 0.1}};
    pls_shape_part parts[3] = {0};
    pls_shape *part[3] = {NULL};
    pls_status status = PLS_OK;
    for (int k = 0; k < 3 && status == PLS_OK; ++k)
    {
        const pls_shape_input box = {VALUES(half[k % 2])}, ball = {.values = &radius, .value_count = 1};
        status = pls_shape_make(k < 2 ? &pls_box_shape : &pls_sphere_shape, 3, k < 2 ? &box : &ball, "part", &part[k]);
        parts[k] = (pls_shape_part){part[k], middle[k], pls_quat_identity(), 1.0};
    }
    if (status == PLS_OK)
        status = pls_shape_make(e->ops, 3, &(pls_shape_input){VALUES(e->values), .parts = parts, .part_count = 3}, e->name, out);
    for (int k = 0; k < 3; ++k) pls_shape_free(part[k]);
    return status;
}

static pls_shape *make(const example *e)
{
    pls_vec3 points[HULL_POINTS];
    pls_random random = pls_random_stream(17, 0, PLS_FOR_USER);
    const bool flat = e->dimension == 2 || e->ops == &pls_prism_shape;
    for (int k = 0; k < e->hull_points; ++k)
    {
        double x = pls_random_normal(&random), y = pls_random_normal(&random), z = pls_random_normal(&random);
        points[k] = pls_scale(pls_unit(pls_vec(x, y, flat ? 0.0 : z)), 0.8);
    }
    pls_shape *shape = NULL;
    const pls_shape_input input = {VALUES(e->values), .points = points, .point_count = (size_t)e->hull_points};
    const pls_status status =
        e->ops == &pls_compound_shape ? make_compound(e, &shape) : pls_shape_make(e->ops, e->dimension, &input, e->name, &shape);
    if (status != PLS_OK) fprintf(stderr, "contact_methods: %s\n", pls_last_message());
    return shape;
}

// ---- both methods -----------------------------------------------------------------------------------------------------------------------------------------------

/// What a method remembers of a pair.
typedef struct memory
{
    pls_narrow_options options;
    pls_pair_state state;
    int unsolved;                    ///< queries that did not converge; those of eq. 14 count as in a simulation, by the penetration depth
    long done_in[PLS_ADMM_MOST + 1]; ///< queries of overlapping bodies, by iterations of ADMM
} memory;

/// What collisions are told apart by: the default, which goes by all of a face or a line; the deepest point alone; P1's.
enum method { DEFAULT, DEEPEST, EQUATION_14, METHODS };

static memory memory_of(enum method method)
{
    memory m = {.options = pls_default_narrow_options()};
    m.options.faces = method == DEFAULT ? PLS_FACES_MANIFOLD : PLS_FACES_POINT;
    m.options.solver = method == EQUATION_14 ? PLS_SOLVER_ADMM : PLS_SOLVER_DEPTH;
    m.options.tolerance = depth_tolerance;
    return m;
}

static two_bodies_contact find(const pls_posed *a, const pls_posed *b, void *user)
{
    memory *m = user;
    pls_narrow_counts counts = {0};
    pls_touch touch;
    pls_narrow_phase(a, b, &m->options, &m->state, &touch, &counts);
    const bool admm = m->options.solver == PLS_SOLVER_ADMM;
    m->unsolved += counts.failures > 0 || (admm && counts.fallbacks > 0);
    if (admm && touch.delta > 0.0) ++m->done_in[counts.iterations < PLS_ADMM_MOST ? counts.iterations : PLS_ADMM_MOST];
    return (two_bodies_contact){touch.delta, touch.energy_delta, touch.twist, touch.normal, touch.point};
}

/// Of shapes made of parts that of the two deepest.
static two_bodies_contact depth_cold(const pls_posed *a, const pls_posed *b)
{
    two_bodies_contact deepest = {.delta = -INFINITY};
    for (uint32_t i = 0; i < pls_part_count(a->shape); ++i)
        for (uint32_t j = 0; j < pls_part_count(b->shape); ++j)
        {
            memory m = memory_of(DEEPEST);
            const pls_posed part_a = pls_posed_part(a, i), part_b = pls_posed_part(b, j);
            const two_bodies_contact c = find(&part_a, &part_b, &m);
            if (c.delta > deepest.delta) deepest = c;
        }
    return deepest;
}

// ---- poses --------------------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 random_direction(pls_random *random, int dimension)
{
    double x = pls_random_normal(random), y = pls_random_normal(random), z = pls_random_normal(random);
    return pls_unit(pls_vec(x, y, dimension == 2 ? 0.0 : z));
}

static pls_quat random_turn(pls_random *random, int dimension)
{
    double q[4];
    for (int k = 0; k < 4; ++k) q[k] = pls_random_normal(random);
    return pls_quat_unit(dimension == 2 ? (pls_quat){q[0], 0.0, 0.0, q[1]} : (pls_quat){q[0], q[1], q[2], q[3]});
}

static double size_of(const moving_body *a, const moving_body *b) { return fmin(a->shape->radius, b->shape->radius); }

static double depth_now(const moving_body *a, const moving_body *b)
{
    pls_posed pa = moving_body_pose(a), pb = moving_body_pose(b);
    return depth_cold(&pa, &pb).delta;
}

/// A at the origin, turned at random, and B on a random line, off the centre by up to `aside` of the size, where the depth is `part` of the size. A plane is B.
static void place(const pls_shape *sa, const pls_shape *sb, double aside, double part, pls_random *random, moving_body *a, moving_body *b,
                  pls_vec3 *line)
{
    const int dimension = sa->dimension;
    pls_vec3 e = random_direction(random, dimension), side = random_direction(random, dimension);
    pls_quat qa = random_turn(random, dimension), qb = random_turn(random, dimension);
    *a = two_bodies_make(sa, pls_vec(0.0, 0.0, 0.0), qa);
    *b = two_bodies_make(sb, pls_vec(0.0, 0.0, 0.0), qb);
    if (sb->ops->unbounded) e = pls_rotate(qb, dimension == 2 ? pls_vec(0.0, -1.0, 0.0) : pls_vec(0.0, 0.0, -1.0));
    const double size = size_of(a, b);
    double low = 0.0, high = 2.0 * (sa->radius + (isfinite(sb->radius) ? sb->radius : 0.0));
    pls_vec3 off = pls_scale(pls_sub(side, pls_scale(e, pls_dot(side, e))), aside * size * pls_random_uniform(random));
    for (int k = 0; k < 50; ++k)
    {
        double middle = 0.5 * (low + high);
        b->x = pls_add(off, pls_scale(e, middle));
        *(depth_now(a, b) > part * size ? &low : &high) = middle;
    }
    *line = e;
}

// ---- statistics ---------------------------------------------------------------------------------------------------------------------------------------------------

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/// Sorts.
static double quantile(double *values, int count, double part)
{
    if (count == 0) return NAN;
    qsort(values, (size_t)count, sizeof *values, by_size);
    int k = (int)(part * count);
    return values[k < count ? k : count - 1];
}

static int quantile_of_counts(const long *count, double part)
{
    long all = 0, sum = 0;
    int k = 0;
    for (int i = 0; i <= PLS_ADMM_MOST; ++i) all += count[i];
    while (k < PLS_ADMM_MOST && (sum += count[k]) <= (long)(part * (double)all)) ++k;
    return k;
}

// ---- what is measured of a pair -------------------------------------------------------------------------------------------------------------------------------------

typedef struct figures
{
    char name[PAIR_NAME];
    double ratio[2], angle[2]; ///< median, 95th percentile
    int unsolved;              ///< of POSES
    double cold[TOLERANCES][2], warm[TOLERANCES][2];
    double few[TOLERANCES];          ///< part of warm queries done in 1 or 2 iterations
    long done_in[PLS_ADMM_MOST + 1]; ///< queries in collisions, to depth_tolerance
    double energy[METHODS][2];       ///< median and largest change
    int lost[METHODS];               ///< queries without a converged answer
    int collisions;                  ///< of the energy
    int thrown;                      ///< of these, not ended
} figures;

static void compare_depths(const pls_shape *sa, const pls_shape *sb, uint64_t stream, figures *f)
{
    pls_random random = pls_random_stream(1, stream, PLS_FOR_USER);
    double ratio[POSES], angle[POSES];
    int count = 0;
    for (int k = 0; k < POSES; ++k)
    {
        const double part = pow(10.0, -3.0 + 1.7 * pls_random_uniform(&random)); // 0.1 to 5 % of the size
        moving_body a, b;
        pls_vec3 line;
        place(sa, sb, 0.5, part, &random, &a, &b, &line);
        pls_posed pa = moving_body_pose(&a), pb = moving_body_pose(&b);
        two_bodies_contact depth = depth_cold(&pa, &pb);
        double cold[PLS_ADMM_STATE] = {0.0};
        pls_overlap o;
        pls_admm_depth(&pa, &pb, depth_tolerance, cold, &o);
        f->unsolved += !o.converged;
        if (!o.converged) continue;
        ratio[count] = o.delta / depth.delta;
        angle[count++] = atan2(pls_length(pls_cross(o.normal, depth.normal)), pls_dot(o.normal, depth.normal)) * 180.0 / M_PI;
    }
    for (int q = 0; q < 2; ++q)
    {
        f->ratio[q] = quantile(ratio, count, q ? 0.95 : 0.5);
        f->angle[q] = quantile(angle, count, q ? 0.95 : 0.5);
    }
}

/// B passes A in small steps, turning.
static void count_iterations(const pls_shape *sa, const pls_shape *sb, uint64_t stream, figures *f)
{
    for (int t = 0; t < TOLERANCES; ++t)
    {
        pls_random random = pls_random_stream(2, stream, PLS_FOR_USER);
        double cold[TRAJECTORIES], warm[TRAJECTORIES * STEPS];
        int count = 0, few = 0;
        for (int p = 0; p < TRAJECTORIES; ++p)
        {
            moving_body a, b;
            pls_vec3 line, along = random_direction(&random, sa->dimension);
            pls_vec3 w = sa->dimension == 2 ? pls_vec(0.0, 0.0, 1.0) : random_direction(&random, 3);
            place(sa, sb, 0.5, 0.02 * pls_random_uniform(&random), &random, &a, &b, &line);
            const double half = 0.5 * step_of_path;
            const pls_quat turn = {cos(half), sin(half) * w.x, sin(half) * w.y, sin(half) * w.z};
            double state[PLS_ADMM_STATE] = {0.0};
            for (int k = 0; k <= STEPS; ++k)
            {
                pls_overlap o;
                pls_posed pa = moving_body_pose(&a), pb = moving_body_pose(&b);
                pls_admm_depth(&pa, &pb, tolerances[t], state, &o);
                if (k == 0) cold[p] = o.iterations;
                if (k > 0) warm[count++] = o.iterations, few += o.iterations <= 2;
                a.x = pls_add(a.x, pls_scale(along, step_of_path * size_of(&a, &b)));
                a.q = pls_quat_unit(pls_quat_multiply(turn, a.q));
            }
        }
        f->few[t] = (double)few / count;
        for (int q = 0; q < 2; ++q)
        {
            f->cold[t][q] = quantile(cold, TRAJECTORIES, q ? 0.95 : 0.5);
            f->warm[t][q] = quantile(warm, count, q ? 0.95 : 0.5);
        }
    }
}

/// B comes at A with speed 1, both with spins that carry their surfaces at up to half of it; off the centre by up to a quarter of the size. `dt` is the step.
static void set_out(const pls_shape *sa, const pls_shape *sb, double steps, pls_random *random, two_bodies *pair, double *dt)
{
    moving_body *a = &pair->body[0], *b = &pair->body[1];
    pls_vec3 line;
    place(sa, sb, 0.25, -0.005, random, a, b, &line);
    const double size = size_of(a, b), mass = b->fixed ? a->mass : a->mass * b->mass / (a->mass + b->mass);
    pair->stiffness = mass / (hardest * hardest * size * size);
    a->v = line;
    for (int k = 0; k < 2; ++k)
    {
        moving_body *body = &pair->body[k];
        if (body->fixed) continue;
        pls_vec3 w = sa->dimension == 2 ? pls_vec(0.0, 0.0, pls_random_uniform(random) - 0.5) : random_direction(random, 3);
        w = pls_scale(w, (sa->dimension == 2 ? 1.0 : 0.5 * pls_random_uniform(random)) / body->shape->radius);
        moving_body_set_spin(body, w);
    }
    const pls_posed pa = moving_body_pose(a), pb = moving_body_pose(b);
    const two_bodies_contact nearest = depth_cold(&pa, &pb);
    // A push aside of the centres moves less mass, so such contacts are shorter.
    *dt = M_PI * sqrt(two_bodies_effective_mass(pair, nearest.point, nearest.normal) / pair->stiffness) / steps;
}

enum { LONGEST = 40 }; ///< a collision, in contacts

/// Relative change of energy when they have parted; NaN if they have not.
static double collide_two(two_bodies *pair, memory *m, double dt, int steps)
{
    const double size = size_of(&pair->body[0], &pair->body[1]);
    pair->find = find, pair->user = m;
    two_bodies_begin(pair);
    const double before = two_bodies_energy(pair);
    bool touched = false;
    for (int k = 0; k < LONGEST * steps; ++k)
    {
        two_bodies_step(pair, dt);
        touched |= pair->contact.delta > 0.0;
        if (touched && pair->contact.delta < -0.01 * size) return two_bodies_energy(pair) / before - 1.0;
    }
    return touched ? NAN : 0.0;
}

/// Shapes count who keeps them, and that one at a time.
static verify_scene open_world(const two_bodies *pair, const memory *m, double dt)
{
    verify_scene scene;
#pragma omp critical(keepers)
    {
        pls_world_def def = pls_default_world_def(pair->body[0].shape->dimension);
        def.dt = dt, def.allow_unstable = true;
        scene = verify_open(&def, "elastic", (const verify_value[]){{"kn", pair->stiffness}, {NULL, 0.0}});
        MUST(pls_world_set_narrow_options(scene.world, scene.grain, scene.grain, &m->options));
        for (int k = 0; k < 2; ++k)
        {
            const moving_body *body = &pair->body[k];
            pls_shape_id shape;
            MUST(pls_world_use_shape(scene.world, k == 0 ? "A" : "B", (pls_shape *)(uintptr_t)body->shape, &shape));
            pls_body_def grain = verify_body_def(&scene, shape, body->x);
            grain.orientation = body->q;
            grain.velocity = body->v;
            grain.angular_velocity = body->fixed ? pls_vec(0.0, 0.0, 0.0) : moving_body_spin(body);
            if (body->fixed) grain.motion.axes = PLS_AXIS_ALL;
            verify_add(&scene, &grain);
        }
    }
    MUST(pls_world_prepare(scene.world));
    return scene;
}

static void close_world(verify_scene *scene)
{
#pragma omp critical(keepers)
    verify_close(scene);
}

/// As `collide_two`, of shapes made of parts, by the library's step: which of their contacts act is decided there.
static double collide_in_world(const two_bodies *pair, memory *m, double dt, int steps)
{
    verify_scene scene = open_world(pair, m, dt);
    const double before = verify_total_energy(scene.world);
    bool touched = false;
    int apart = 0; // steps since they touched
    for (int k = 0; k < LONGEST * steps && !(touched && apart > steps / 4); ++k)
    {
        MUST(pls_step(scene.world));
        const bool touches = pls_world_contact_count(scene.world) > 0;
        touched |= touches, apart = touches ? 0 : apart + 1;
    }
    const double change = verify_total_energy(scene.world) / before - 1.0;
    const pls_narrow_counts counts = pls_world_narrow_counts(scene.world);
    m->unsolved += (int)(counts.failures + (m->options.solver == PLS_SOLVER_ADMM ? counts.fallbacks : 0));
    close_world(&scene);
    return !touched ? 0.0 : apart > steps / 4 ? change : NAN;
}

static double collide(const pls_shape *sa, const pls_shape *sb, memory *m, int steps, pls_random *random)
{
    two_bodies pair = {0};
    double dt;
    set_out(sa, sb, steps, random, &pair, &dt);
    return sa->part_count || sb->part_count ? collide_in_world(&pair, m, dt, steps) : collide_two(&pair, m, dt, steps);
}

static void measure_energy(const pls_shape *sa, const pls_shape *sb, uint64_t stream, figures *f)
{
    double change[MOST_COLLISIONS];
    for (int method = 0; method < METHODS; ++method)
    {
        int count = 0;
        for (int k = 0; k < f->collisions; ++k)
        {
            pls_random random = pls_random_stream(3, 1000 * stream + (uint64_t)k, PLS_FOR_USER); // the same collisions
            memory m = memory_of((enum method)method);
            double c = fabs(collide(sa, sb, &m, STEPS_PER_CONTACT, &random));
            f->lost[method] += m.unsolved;
            for (int i = 0; i <= PLS_ADMM_MOST; ++i) f->done_in[i] += m.done_in[i];
            f->thrown += isnan(c);
            if (!isnan(c)) change[count++] = c;
        }
        f->energy[method][0] = quantile(change, count, 0.5);
        f->energy[method][1] = quantile(change, count, 1.0);
    }
}

// ---- nearly parallel faces ---------------------------------------------------------------------------------------------------------------------------------------------

/// A box on a box, aside, tilted about an axis that is not that of an edge.
static void write_tilts(FILE *out, const pls_shape *box)
{
    fprintf(out, "| tilt [rad] | iterations to 1e-3 | to 1e-6 | to 1e-8 | depth ratio | points apart, along the face "
                 "|\n|---:|---:|---:|---:|---:|---:|\n");
    for (int k = 1; k <= 6; ++k)
    {
        const double tilt = pow(10.0, -k), height = 1.6 - 0.008;
        pls_posed a = pls_pose(box, pls_vec(0.0, 0.0, 0.0), pls_quat_identity(), 1.0);
        pls_posed b =
            pls_pose(box, pls_vec(0.12, -0.17, height + 0.6 * tilt), pls_quat_unit((pls_quat){1.0, 0.4 * tilt, 0.3 * tilt, 0.0}), 1.0);
        two_bodies_contact depth = depth_cold(&a, &b);
        pls_overlap o;
        fprintf(out, "| %.0e ", tilt);
        for (int t = 0; t < TOLERANCES; ++t)
        {
            double cold[PLS_ADMM_STATE] = {0.0};
            pls_admm_depth(&a, &b, tolerances[t], cold, &o);
            fprintf(out, o.converged ? "| %d " : "| not in %d ", o.iterations);
        }
        pls_vec3 apart = pls_sub(o.on_a, o.on_b);
        double along = pls_length(pls_sub(apart, pls_scale(depth.normal, pls_dot(apart, depth.normal))));
        fprintf(out, "| %.3f | %.3f |\n", o.delta / depth.delta, along / box->radius);
    }
}

// ---- steps of time --------------------------------------------------------------------------------------------------------------------------------------------

/// Of the deepest point and of the default, on a face that lands nearly flat.
static void write_steps(FILE *out, const pls_shape *box, const pls_shape *plane, int collisions)
{
    fprintf(out, "| steps per contact | deepest point: median | 95 %% | worst | default: median | 95 %% | worst "
                 "|\n|---:|---:|---:|---:|---:|---:|---:|\n");
    for (int steps = STEPS_PER_CONTACT / 2; steps <= 4 * STEPS_PER_CONTACT; steps *= 2)
    {
        fprintf(out, "| %d ", steps);
        for (int method = DEEPEST; method >= DEFAULT; --method)
        {
            double change[MOST_COLLISIONS];
            int count = 0;
            for (int k = 0; k < collisions; ++k)
            {
                pls_random random = pls_random_stream(4, (uint64_t)k, PLS_FOR_USER);
                memory m = memory_of((enum method)method);
                double c = fabs(collide(box, plane, &m, steps, &random));
                if (!isnan(c)) change[count++] = c;
            }
            fprintf(out, "| %.1e | %.1e | %.1e ", quantile(change, count, 0.5), quantile(change, count, 0.95),
                    quantile(change, count, 1.0));
        }
        fprintf(out, "|\n");
    }
}

// ---- pages -------------------------------------------------------------------------------------------------------------------------------------------------------------

static FILE *open_in(const char *folder, const char *name)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file) fprintf(stderr, "contact_methods: cannot write %s\n", path);
    return file;
}

static void write_depths(FILE *out, const figures *const *f)
{
    fprintf(out, "| pair | \\|xi\\| / depth: median | 95 %% | angle between directions: median | 95 %% | not solved "
                 "|\n|---|---:|---:|---:|---:|---:|\n");
    for (int p = 0; p < CHOSEN; ++p)
        if (f[p])
            fprintf(out, "| %s | %.4f | %.3f | %.2f | %.1f | %d of %d |\n", f[p]->name, f[p]->ratio[0], f[p]->ratio[1], f[p]->angle[0],
                    f[p]->angle[1], f[p]->unsolved, POSES);
}

static void write_iterations(FILE *out, const figures *const *f)
{
    fprintf(
        out,
        "| pair | cold, to 1e-3 | 1e-6 | 1e-8 | warm, to 1e-3 | 1e-6 | 1e-8 | warm, in 1-2: 1e-3 | 1e-6 | 1e-8 | in collisions: 1e-8 |\n"
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (int p = 0; p < CHOSEN; ++p)
    {
        if (!f[p]) continue;
        fprintf(out, "| %s ", f[p]->name);
        for (int t = 0; t < TOLERANCES; ++t) fprintf(out, "| %.0f (%.0f) ", f[p]->cold[t][0], f[p]->cold[t][1]);
        for (int t = 0; t < TOLERANCES; ++t) fprintf(out, "| %.0f (%.0f) ", f[p]->warm[t][0], f[p]->warm[t][1]);
        for (int t = 0; t < TOLERANCES; ++t) fprintf(out, "| %.0f %% ", 100.0 * f[p]->few[t]);
        fprintf(out, "| %d (%d) |\n", quantile_of_counts(f[p]->done_in, 0.5), quantile_of_counts(f[p]->done_in, 0.95));
    }
}

static bool keeps_energy(const figures *f) { return f->energy[DEFAULT][0] <= median_allowed && f->energy[DEFAULT][1] <= worst_allowed; }

static bool write_energies(FILE *out, FILE *curve, const figures *f, int pairs)
{
    bool kept = true;
    fprintf(out, "| pair | collisions | default: median | worst | | deepest point: median | worst | eq. 14: median | worst "
                 "| not solved, not ended |\n|---|---:|---:|---:|---|---:|---:|---:|---:|---|\n");
    for (int p = 0; p < pairs; ++p)
    {
        const bool good = keeps_energy(&f[p]);
        const figures *g = &f[p];
        kept = kept && good;
        fprintf(out, "| %s | %d | %.1e | %.1e | %s | %.1e | %.1e | %.1e | %.1e | %d + %d queries, %d collisions |\n", g->name,
                g->collisions, g->energy[DEFAULT][0], g->energy[DEFAULT][1], good ? "yes" : "**no**", g->energy[DEEPEST][0],
                g->energy[DEEPEST][1], g->energy[EQUATION_14][0], g->energy[EQUATION_14][1], g->lost[DEFAULT] + g->lost[DEEPEST],
                g->lost[EQUATION_14], g->thrown);
        fprintf(curve, "\"%s\"", g->name);
        for (int method = 0; method < METHODS; ++method) fprintf(curve, "\t%.3e\t%.3e", g->energy[method][0], g->energy[method][1]);
        fprintf(curve, "\n");
    }
    return kept;
}

/// For the text of the page: shell assignments.
static void write_numbers(FILE *out, const figures *f, int pairs, int collisions)
{
    int outside = 0;
    for (int p = 0; p < pairs; ++p) outside += !keeps_energy(&f[p]);
    fprintf(out, "poses=%d collisions=%d pairs=%d outside=%d\n", POSES, collisions, pairs, outside);
    for (int p = 0; p < pairs; ++p)
    {
        char key[64];
        int n = 0;
        for (const char *c = f[p].name; *c; ++c)
            if ((*c >= 'a' && *c <= 'z'))
                key[n++] = *c;
            else if (n > 0 && key[n - 1] != '_')
                key[n++] = '_';
        key[n] = 0;
        fprintf(out,
                "%s_ratio='%.2f' %s_angle='%.0f' %s_angle_far='%.0f' %s_depth_median='%.0e' %s_depth_worst='%.0e' %s_median='%.2g' "
                "%s_worst='%.2g'\n",
                key, f[p].ratio[0], key, f[p].angle[0], key, f[p].angle[1], key, f[p].energy[DEEPEST][0], key, f[p].energy[DEEPEST][1], key,
                100.0 * f[p].energy[EQUATION_14][0], key, 100.0 * f[p].energy[EQUATION_14][1]);
    }
}

static bool is_chosen(const int pair[2], int k) { return chosen[k][0] == pair[0] && chosen[k][1] == pair[1]; }

static void measure(pls_shape *const *shapes, const int pair[2], int collisions, figures *f)
{
    const pls_shape *a = shapes[pair[0]], *b = shapes[pair[1]];
    const uint64_t stream = (uint64_t)(EXAMPLES * pair[0] + pair[1]);
    name_pair(pair[0], pair[1], f->name);
    for (int k = 0; k < CHOSEN; ++k)
        if (is_chosen(pair, k)) compare_depths(a, b, stream, f), count_iterations(a, b, stream, f);
    f->collisions = collisions;
    measure_energy(a, b, stream, f);
    fprintf(stderr, "%s\n", f->name);
}

int main(int argc, char **argv)
{
    const int collisions = argc > 2 ? atoi(argv[2]) : 100;
    if (argc < 2 || collisions < 1 || collisions > MOST_COLLISIONS)
    {
        fprintf(stderr, "usage: contact_methods DIR [COLLISIONS [WORD]]\n");
        return 2;
    }
    pls_shape *shapes[EXAMPLES];
    for (int e = 0; e < EXAMPLES; ++e)
        if (!(shapes[e] = make(&examples[e]))) return 2;
    static figures all[MOST_PAIRS];
    const figures *some[CHOSEN] = {NULL};
    int pairs[MOST_PAIRS][2];
    const int count = list_pairs(argc > 3 ? argv[3] : "", pairs);
    for (int p = 0; p < count; ++p)
        for (int k = 0; k < CHOSEN; ++k)
            if (is_chosen(pairs[p], k)) some[k] = &all[p];
    for (int p = 0; p < count; ++p) // as the library does before a pair can touch
    {
        const pls_shape *a = shapes[pairs[p][0]], *b = shapes[pairs[p][1]];
        if (pls_is_sampled_pair(a, b) && (pls_shape_need_sample(a) != PLS_OK || pls_shape_need_sample(b) != PLS_OK)) return 2;
    }
#pragma omp parallel for schedule(dynamic)
    for (int p = 0; p < count; ++p) measure(shapes, pairs[p], collisions, &all[p]);

    FILE *depths = open_in(argv[1], "depths.md"), *iterations = open_in(argv[1], "iterations.md"), *tilts = open_in(argv[1], "tilts.md"),
         *energies = open_in(argv[1], "energies.md"), *curve = open_in(argv[1], "energies.tsv"), *numbers = open_in(argv[1], "numbers"),
         *steps = open_in(argv[1], "steps.md");
    if (!depths || !iterations || !tilts || !energies || !curve || !numbers || !steps) return 2;
    write_depths(depths, some);
    write_iterations(iterations, some);
    write_tilts(tilts, shapes[BOX]);
    write_steps(steps, shapes[BOX], shapes[PLANE], collisions);
    write_numbers(numbers, all, count, collisions);
    const bool kept = write_energies(energies, curve, all, count);
    for (int e = 0; e < EXAMPLES; ++e) pls_shape_free(shapes[e]);
    const int errors =
        fclose(depths) + fclose(iterations) + fclose(tilts) + fclose(energies) + fclose(curve) + fclose(numbers) + fclose(steps);
    return errors ? 2 : kept ? 0 : 1;
}
