// polyhedra.c -- the job the speed of polyhedra is measured with: grains of 28 corners falling into a box, with the volume law.
//
// Grains of one shape, turned at random, start on a lattice where they just do not touch, fall for 0.8 s and are timed then. With --state the heap is
// written as the corners of each grain in the world, from which peers/polyhedra.yade.py makes the same grains at the same places: one source of the geometry.
//
// Prints one line of JSON; only the stepping after the fall is timed, in time of the processor.

#include <particls/threads.h>
#include <particls/world.h>

#include "base/random.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { CORNERS = 28 };
static const double spacing = 1.0;          ///< of the lattice: the longest diameter [m]
static const double density = 2600.0;       ///< [kg/m^3]
static const double gravity = 9.81;         ///< [m/s^2]
static const double volume_stiffness = 1e9; ///< force over volume of the overlap [N/m^3]
static const double face_area = 0.05;       ///< of the volume law [m^2]; only its ratio to kn matters
static const double friction = 0.5;
static const double damping = 4e4;    ///< [N s/m]
static const double time_step = 5e-5; ///< [s]
static const double fall = 0.8;       ///< [s]

typedef struct options
{
    size_t bodies, steps;
    bool point;        ///< the point law, of the same stiffness where the faces in touch measure `face_area`
    const char *state; ///< null: not written
} options;

/// A box of n x n columns, as high as wide or a little higher.
typedef struct heap
{
    size_t wide, count;
    bool point;
    pls_vec3 corner[CORNERS];
    pls_shape *shape;
    pls_world *world;
} heap;

static bool read_options(int argc, char **argv, options *o)
{
    for (int k = 1; k < argc; k += 2)
    {
        char *rest = NULL;
        size_t value = k + 1 < argc ? strtoul(argv[k + 1], &rest, 10) : 0;
        bool whole = rest && *rest == '\0' && value >= 1 && value <= 10000000;
        if (strcmp(argv[k], "--bodies") == 0 && whole)
            o->bodies = value;
        else if (strcmp(argv[k], "--steps") == 0 && whole)
            o->steps = value;
        else if (strcmp(argv[k], "--state") == 0 && k + 1 < argc)
            o->state = argv[k + 1];
        else if (strcmp(argv[k], "--faces") == 0 && k + 1 < argc &&
                 (strcmp(argv[k + 1], "point") == 0 || strcmp(argv[k + 1], "volume") == 0))
            o->point = strcmp(argv[k + 1], "point") == 0;
        else
        {
            fprintf(stderr,
                    "polyhedra: cannot use '%s%s%s'\nusage: polyhedra [--bodies N] [--steps N] [--faces volume|point] [--state FILE]\n"
                    "  --bodies N    grains (4000)\n"
                    "  --steps N     steps that are timed, after the fall (400)\n"
                    "  --faces LAW   volume (as Yade's) or point (the penetration depth)\n"
                    "  --state FILE  write the corners of the grains as they lie before those steps\n",
                    argv[k], k + 1 < argc ? " " : "", k + 1 < argc ? argv[k + 1] : "");
            return false;
        }
    }
    return true;
}

static const pls_shape_ops *find_shape(const char *name)
{
    const pls_shape_ops *const *shape = pls_builtin_shapes();
    while (*shape && strcmp((*shape)->name, name) != 0) ++shape;
    return *shape;
}

static pls_status make_grain(heap *h)
{
    const pls_shape_ops *polyhedron = find_shape("polyhedron");
    if (!polyhedron) return pls_fail(PLS_NOT_FOUND, "there is no shape 'polyhedron'");
    for (int k = 0; k < CORNERS; ++k) // on an ellipsoid, by the golden angle
    {
        double z = 1.0 - (2.0 * k + 1.0) / CORNERS, r = sqrt(1.0 - z * z), angle = 2.399963229728653 * k;
        h->corner[k] = pls_vec(0.5 * r * cos(angle), 0.45 * r * sin(angle), 0.4 * z);
    }
    return pls_shape_make(polyhedron, 3, &(pls_shape_input){.points = h->corner, .point_count = CORNERS}, "grain", &h->shape);
}

static pls_status set_law(pls_world *world, pls_material_id material, bool point)
{
    const pls_law_ops *const *law = pls_builtin_laws();
    while (*law && strcmp((*law)->name, "viscoelastic") != 0) ++law;
    if (!*law) return pls_fail(PLS_NOT_FOUND, "there is no law 'viscoelastic'");
    const double kn = volume_stiffness * face_area;
    const struct
    {
        const char *name;
        double value;
    } given[] = {{"kn", kn}, {"ks", 0.5 * kn}, {"cn", damping}, {"cs", 0.5 * damping}, {"friction", friction}};
    double values[PLS_MAX_PARAMETERS] = {0};
    pls_parameters_default((*law)->parameters, values);
    for (size_t k = 0; k < sizeof given / sizeof *given; ++k)
    {
        int place = pls_parameter_find((*law)->parameters, given[k].name);
        if (place < 0) return pls_fail(PLS_NOT_FOUND, "the law has no parameter '%s'", given[k].name);
        values[place] = given[k].value;
    }
    PLS_TRY(pls_world_set_law(world, material, material, *law, values));
    pls_narrow_options narrow = pls_default_narrow_options();
    narrow.faces = point ? PLS_FACES_POINT : PLS_FACES_VOLUME;
    narrow.face_area = face_area;
    return pls_world_set_narrow_options(world, material, material, &narrow);
}

static pls_status add_walls(const heap *h, pls_material_id material)
{
    const pls_shape_ops *plane = find_shape("plane");
    if (!plane) return pls_fail(PLS_NOT_FOUND, "there is no shape 'plane'");
    pls_body_def wall = pls_default_body_def();
    const double half = sqrt(0.5), side = spacing * (double)h->wide;
    const struct
    {
        pls_vec3 position;
        pls_quat orientation; ///< turns z into the inward normal
    } sides[5] = {{{0, 0, 0}, {half, 0, half, 0}},
                  {{side, 0, 0}, {half, 0, -half, 0}},
                  {{0, 0, 0}, {half, -half, 0, 0}},
                  {{0, side, 0}, {half, half, 0, 0}},
                  {{0, 0, 0}, {1, 0, 0, 0}}};
    PLS_TRY(pls_world_add_shape(h->world, "wall", plane, NULL, 0, &wall.shape));
    wall.material = material;
    wall.motion.axes = PLS_AXIS_ALL;
    for (int k = 0; k < 5; ++k)
    {
        pls_body_id id;
        wall.position = sides[k].position;
        wall.orientation = sides[k].orientation;
        PLS_TRY(pls_world_add_body(h->world, &wall, &id));
    }
    return PLS_OK;
}

static pls_status build(heap *h)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = time_step;
    PLS_TRY(make_grain(h));
    PLS_TRY(pls_world_create(&def, &h->world));
    pls_material_def material = pls_default_material_def();
    snprintf(material.name, sizeof material.name, "grain");
    material.values.density = density;
    pls_body_def grain = pls_default_body_def();
    PLS_TRY(pls_world_add_material(h->world, &material, &grain.material));
    PLS_TRY(set_law(h->world, grain.material, h->point));
    PLS_TRY(pls_world_use_shape(h->world, "grain", h->shape, &grain.shape));
    PLS_TRY(pls_world_add_gravity(h->world, pls_vec(0.0, 0.0, -gravity)));
    PLS_TRY(pls_world_reserve_bodies(h->world, h->count + 5));
    for (size_t n = 0; n < h->count; ++n)
    {
        pls_random random = pls_random_stream(3, n, PLS_FOR_USER);
        double q[4];
        for (int k = 0; k < 4; ++k) q[k] = pls_random_normal(&random);
        pls_body_id id;
        grain.orientation = pls_quat_unit((pls_quat){q[0], q[1], q[2], q[3]});
        grain.position = pls_scale(
            pls_vec((double)(n % h->wide) + 0.5, (double)(n / h->wide % h->wide) + 0.5, (double)(n / (h->wide * h->wide)) + 0.5), spacing);
        PLS_TRY(pls_world_add_body(h->world, &grain, &id));
    }
    return add_walls(h, grain.material);
}

/// Side of the box, stiffness, friction and step; then a line of corners for each grain.
static pls_status write_state(const heap *h, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file) return pls_fail(PLS_IO, "cannot write %s: %s", path, strerror(errno));
    fprintf(file, "%.17g %.17g %.17g %.17g %.17g %.17g\n", spacing * (double)h->wide, volume_stiffness, friction, density, gravity,
            time_step);
    pls_body_id id = pls_world_next_body(h->world, (pls_group_id){0}, (pls_body_id){0});
    for (size_t n = 0; n < h->count; ++n, id = pls_world_next_body(h->world, (pls_group_id){0}, id))
    {
        pls_body_motion m;
        PLS_TRY(pls_body_get(h->world, id, &m));
        for (int k = 0; k < CORNERS; ++k)
        {
            pls_vec3 own = pls_rotate(pls_quat_conjugate(h->shape->principal), pls_sub(h->corner[k], h->shape->mass.centre));
            pls_vec3 x = pls_add(m.position, pls_rotate(m.orientation, own));
            fprintf(file, "%.17g %.17g %.17g%c", x.x, x.y, x.z, k + 1 == CORNERS ? '\n' : ' ');
        }
    }
    bool failed = ferror(file) != 0;
    if (fclose(file) != 0 || failed) return pls_fail(PLS_IO, "writing %s failed: %s", path, strerror(errno));
    return PLS_OK;
}

/// Of the processor, so that others on the machine do not count: one thread only [s].
static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static pls_status measure(const options *o, heap *h)
{
    PLS_TRY(pls_set_threads(1));
    PLS_TRY(build(h));
    PLS_TRY(pls_world_prepare(h->world));
    PLS_TRY(pls_world_run(h->world, (uint64_t)round(fall / time_step)));
    if (o->state) PLS_TRY(write_state(h, o->state));
    double start = now();
    PLS_TRY(pls_world_run(h->world, o->steps));
    double spent = now() - start;
    pls_world_figures f;
    uint64_t hash;
    PLS_TRY(pls_world_get_figures(h->world, &f));
    PLS_TRY(pls_world_state_hash(h->world, &hash));
    printf("{\"bodies\": %zu, \"corners\": %d, \"faces\": \"%s\", \"steps\": %zu, \"threads\": 1, \"cpu_s\": %.6f, "
           "\"particle_steps_per_s\": %.0f, "
           "\"touching\": %zu, \"listed\": %zu, \"kinetic_energy\": %.6g, \"state_hash\": \"%016" PRIx64 "\"}\n",
           h->count, CORNERS, h->point ? "point" : "volume", o->steps, spent, (double)(h->count * o->steps) / spent, f.touching, f.listed,
           f.energy_kinetic, hash);
    return PLS_OK;
}

int main(int argc, char **argv)
{
    options o = {.bodies = 4000, .steps = 400};
    if (!read_options(argc, argv, &o)) return 2;
    heap h = {.count = o.bodies, .wide = 1, .point = o.point};
    while ((h.wide + 1) * (h.wide + 1) * (h.wide + 1) <= o.bodies) ++h.wide;
    pls_status status = measure(&o, &h);
    if (status != PLS_OK) fprintf(stderr, "polyhedra: %s\n", pls_last_message());
    pls_world_destroy(h.world);
    pls_shape_free(h.shape);
    return status == PLS_OK ? 0 : 1;
}
