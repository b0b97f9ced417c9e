// compression.c -- the job the speed of spheres is measured with: uniaxial compression of a hexagonal packing (P1 section 5.3).
//
// Starts open, as the example does (the plate meets the packing at t = 0.19 s), or pressed: shrunk by a fraction with its box around it, so that every
// contact exists from the first step and a few hundred steps tell the speed. The plate moves at 0.35 heights per second.
//
// Prints one line of JSON; only the stepping is timed. With --lammps-data it writes the same packing for LAMMPS instead and prints the variables of
// peers/compression.lammps.in, so that both programs have one source of the geometry.

#include <particls/memory.h>
#include <particls/threads.h>
#include <particls/world.h>

#include "base/clock.h"
#include "math/simd.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double radius = 0.85 / 45.0; ///< [m]
static const double time_step = 2.5e-5;   ///< [s]
static const double density = 1.0;        ///< [kg/m^3]
static const double plate_rate = 0.35;    ///< plate speed over height [1/s]

typedef struct options
{
    double bodies;  ///< at least so many spheres
    double pressed; ///< fraction the packing is shrunk by, 0: open start
    double end;     ///< [s], used when `steps` is 0
    double steps;
    double threads;
    const char *lammps_data; ///< null: run
} options;

typedef struct packing
{
    size_t count[3]; ///< along x, y, z
    double shrink;   ///< factor of all positions
    double side[3];  ///< of the box [m]
} packing;

static const char usage[] =
    "usage: compression [--bodies N] [--pressed FRACTION] [--end SECONDS | --steps N] [--threads N] [--lammps-data FILE]\n"
    "  --bodies N          at least N spheres, 1 to 1e8 (16500: 22 x 25 x 30 as in the example)\n"
    "  --pressed FRACTION  start with the packing shrunk by this, 0 to 0.1 (0: the example's open start)\n"
    "  --end SECONDS       simulated time (0.5), or\n"
    "  --steps N           number of steps\n"
    "  --threads N         threads (1)\n"
    "  --lammps-data FILE  write the packing for LAMMPS, print the variables of its deck, run nothing\n"
    "The environment variable PARTICLS_ISA (v2, v3, v4) lowers the instruction set.\n";

static bool read_number(const char *text, double minimum, double maximum, bool whole, double *value)
{
    char *rest;
    errno = 0;
    *value = strtod(text, &rest);
    return errno == 0 && rest != text && *rest == '\0' && *value >= minimum && *value <= maximum && (!whole || *value == floor(*value));
}

static bool read_options(int argc, char **argv, options *o)
{
    const struct
    {
        const char *name;
        double *value;
        double minimum, maximum;
        bool whole;
    } known[] = {
        {"--bodies", &o->bodies, 1.0, 1e8, true}, {"--pressed", &o->pressed, 0.0, 0.1, false},   {"--end", &o->end, time_step, 1e6, false},
        {"--steps", &o->steps, 1.0, 1e12, true},  {"--threads", &o->threads, 1.0, 4096.0, true},
    };
    for (int k = 1; k < argc; k += 2)
    {
        bool good = false;
        if (k + 1 < argc && strcmp(argv[k], "--lammps-data") == 0) o->lammps_data = argv[k + 1], good = true;
        for (size_t m = 0; k + 1 < argc && m < sizeof known / sizeof *known; ++m)
            if (strcmp(argv[k], known[m].name) == 0)
                good = read_number(argv[k + 1], known[m].minimum, known[m].maximum, known[m].whole, known[m].value);
        if (good) continue;
        fprintf(stderr, "compression: cannot use '%s%s%s'\n%s", argv[k], k + 1 < argc ? " " : "", k + 1 < argc ? argv[k + 1] : "", usage);
        return false;
    }
    if (o->steps == 0.0) o->steps = fmax(1.0, round(o->end / time_step));
    return true;
}

static packing make_packing(const options *o)
{
    // Counts in the example's proportions.
    packing p = {.shrink = 1.0 - o->pressed};
    double factor = cbrt(o->bodies / 16500.0);
    p.count[0] = (size_t)ceil(22.0 * factor - 1e-9);
    p.count[1] = (size_t)ceil(25.0 * factor - 1e-9);
    p.count[2] = (size_t)ceil(o->bodies / (double)(p.count[0] * p.count[1]));
    double nx = (double)p.count[0], ny = (double)p.count[1], nz = (double)p.count[2];
    const double fit[3] = {radius * (2.0 * nx + 1.0), radius * (2.0 + sqrt(3.0) * (ny - 1.0 + 1.0 / 3.0)),
                           radius * (2.0 + 2.0 * sqrt(6.0) / 3.0 * (nz - 1.0))};
    const double open[3] = {0.85, 0.85 * ny / 25.0, 1.0 * nz / 30.0}; // the example's box
    for (int a = 0; a < 3; ++a) p.side[a] = o->pressed > 0.0 || a == 0 ? fit[a] * p.shrink : fmax(fit[a], open[a]);
    return p;
}

static size_t sphere_count(const packing *p) { return p->count[0] * p->count[1] * p->count[2]; }

static pls_vec3 sphere_position(const packing *p, size_t n)
{
    size_t i = n % p->count[0], j = n / p->count[0] % p->count[1], k = n / (p->count[0] * p->count[1]);
    double x = radius * (2.0 * (double)i + (double)((j + k) % 2)) + radius;
    double y = radius * sqrt(3.0) * ((double)j + (double)(k % 2) / 3.0) + radius;
    double z = radius * 2.0 * sqrt(6.0) / 3.0 * (double)k + radius;
    return pls_scale(pls_vec(x, y, z), p->shrink);
}

static int write_lammps_data(const packing *p, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file)
    {
        fprintf(stderr, "compression: cannot write %s: %s\n", path, strerror(errno));
        return 1;
    }
    // Spheres pushed a little beyond a wall must not leave LAMMPS's box.
    fprintf(file, "hexagonal packing\n\n%zu atoms\n1 atom types\n", sphere_count(p));
    for (int a = 0; a < 3; ++a) fprintf(file, "%.17g %.17g %clo %chi\n", -5.0 * radius, p->side[a] + 5.0 * radius, "xyz"[a], "xyz"[a]);
    fprintf(file, "\nAtoms # sphere\n\n");
    for (size_t n = 0; n < sphere_count(p); ++n)
    {
        pls_vec3 x = sphere_position(p, n);
        fprintf(file, "%zu 1 %.17g %.17g %.17g %.17g %.17g\n", n + 1, 2.0 * radius, density, x.x, x.y, x.z);
    }
    bool failed = ferror(file) != 0;
    if (fclose(file) != 0 || failed)
    {
        fprintf(stderr, "compression: writing %s failed: %s\n", path, strerror(errno));
        return 1;
    }
    printf("-var width %.17g -var depth %.17g -var height %.17g -var speed %.17g -var dt %.17g\n", p->side[0], p->side[1], p->side[2],
           plate_rate * p->side[2], time_step);
    return 0;
}

static const pls_law_ops *find_law(const char *name)
{
    const pls_law_ops *const *law = pls_builtin_laws();
    while (*law && strcmp((*law)->name, name) != 0) ++law;
    return *law;
}

static const pls_shape_ops *find_shape(const char *name)
{
    const pls_shape_ops *const *shape = pls_builtin_shapes();
    while (*shape && strcmp((*shape)->name, name) != 0) ++shape;
    return *shape;
}

static pls_status set_law(pls_world *world, pls_material_id material)
{
    static const struct
    {
        const char *name;
        double value;
    } given[] = {{"kn", 20.0}, {"ks", 10.0}, {"cn", 0.08}, {"cs", 0.04}, {"friction", 0.3}};
    const pls_law_ops *law = find_law("viscoelastic");
    if (!law) return pls_fail(PLS_NOT_FOUND, "there is no law 'viscoelastic'");
    double values[PLS_MAX_PARAMETERS] = {0};
    pls_parameters_default(law->parameters, values);
    for (size_t k = 0; k < sizeof given / sizeof *given; ++k)
    {
        int place = pls_parameter_find(law->parameters, given[k].name);
        if (place < 0) return pls_fail(PLS_NOT_FOUND, "the law has no parameter '%s'", given[k].name);
        values[place] = given[k].value;
    }
    return pls_world_set_law(world, material, material, law, values);
}

static pls_status add_walls(pls_world *world, const packing *p, pls_material_id material)
{
    const pls_shape_ops *plane = find_shape("plane");
    if (!plane) return pls_fail(PLS_NOT_FOUND, "there is no shape 'plane'");
    pls_body_def wall = pls_default_body_def();
    const double half = sqrt(0.5);
    const struct
    {
        pls_vec3 position;
        pls_quat orientation; ///< turns z into the inward normal
    } sides[6] = {
        {{0, 0, 0}, {half, 0, half, 0}},  {{p->side[0], 0, 0}, {half, 0, -half, 0}},
        {{0, 0, 0}, {half, -half, 0, 0}}, {{0, p->side[1], 0}, {half, half, 0, 0}},
        {{0, 0, 0}, {1, 0, 0, 0}},        {{0, 0, p->side[2]}, {0, 1, 0, 0}},
    };
    PLS_TRY(pls_world_add_shape(world, "wall", plane, NULL, 0, &wall.shape));
    wall.material = material;
    wall.motion.axes = PLS_AXIS_ALL;
    for (int k = 0; k < 6; ++k)
    {
        pls_body_id id;
        wall.position = sides[k].position;
        wall.orientation = sides[k].orientation;
        wall.motion.velocity = pls_vec(0.0, 0.0, k == 5 ? -plate_rate * p->side[2] : 0.0);
        PLS_TRY(pls_world_add_body(world, &wall, &id));
    }
    return PLS_OK;
}

static pls_status build(const packing *p, pls_world **world)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = time_step;
    PLS_TRY(pls_world_create(&def, world));
    pls_material_def material = pls_default_material_def();
    snprintf(material.name, sizeof material.name, "grain");
    material.values.density = density;
    pls_body_def ball = pls_default_body_def();
    PLS_TRY(pls_world_add_material(*world, &material, &ball.material));
    PLS_TRY(set_law(*world, ball.material));
    const pls_shape_ops *sphere = find_shape("sphere");
    if (!sphere) return pls_fail(PLS_NOT_FOUND, "there is no shape 'sphere'");
    PLS_TRY(pls_world_add_shape(*world, "ball", sphere, &radius, 1, &ball.shape));
    PLS_TRY(pls_world_reserve_bodies(*world, sphere_count(p) + 6));
    for (size_t n = 0; n < sphere_count(p); ++n)
    {
        pls_body_id id;
        ball.position = sphere_position(p, n);
        PLS_TRY(pls_world_add_body(*world, &ball, &id));
    }
    return add_walls(*world, p, ball.material);
}

static pls_status measure(const options *o, const packing *p, pls_world **world)
{
    PLS_TRY(pls_set_threads((int)o->threads));
    pls_memory_reset_peak();
    double begin = pls_clock();
    PLS_TRY(build(p, world));
    PLS_TRY(pls_world_prepare(*world));
    double start = pls_clock();
    PLS_TRY(pls_world_run(*world, (uint64_t)o->steps));
    double wall = pls_clock() - start;
    size_t peak = pls_memory_peak(); // before the figures below take memory of their own
    pls_world_figures f;
    uint64_t hash;
    PLS_TRY(pls_world_get_figures(*world, &f));
    PLS_TRY(pls_world_state_hash(*world, &hash));
    double spheres = (double)sphere_count(p);
    printf("{\"bodies\": %zu, \"counts\": [%zu, %zu, %zu], \"pressed\": %g, \"steps\": %.0f, \"threads\": %d, \"isa\": \"%s\", ",
           sphere_count(p), p->count[0], p->count[1], p->count[2], o->pressed, o->steps, pls_threads(), pls_isa_name());
    printf("\"setup_s\": %.6f, \"wall_s\": %.6f, \"particle_steps_per_s\": %.0f, ", start - begin, wall, spheres * o->steps / wall);
    printf("\"touching\": %zu, \"listed\": %zu, ", f.touching, f.listed);
    printf("\"bytes_per_body\": %.1f, \"bytes_per_contact\": ", (double)f.body_bytes / (double)f.bodies);
    if (f.touching > 0)
        printf("%.1f, ", (double)f.contact_bytes / (double)f.touching);
    else
        printf("null, ");
    printf("\"peak_bytes\": %zu, \"skin\": %.6g, \"list_builds\": %" PRIu64 ", \"kinetic_energy\": %.9g, \"state_hash\": \"%016" PRIx64
           "\"}\n",
           peak, f.skin, f.list_builds, f.energy_kinetic, hash);
    return PLS_OK;
}

int main(int argc, char **argv)
{
    options o = {.bodies = 16500.0, .end = 0.5, .threads = 1.0};
    if (!read_options(argc, argv, &o)) return 2;
    packing p = make_packing(&o);
    if (o.lammps_data) return write_lammps_data(&p, o.lammps_data);
    pls_world *world = NULL;
    pls_status status = measure(&o, &p, &world);
    if (status != PLS_OK) fprintf(stderr, "compression: %s\n", pls_last_message());
    pls_world_destroy(world);
    return status == PLS_OK ? 0 : 1;
}
