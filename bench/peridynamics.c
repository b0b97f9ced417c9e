// peridynamics.c -- the job the speed of bonds is measured with: a cube of a linear peridynamic solid that is being pulled apart, as in bench/peers/peridynamics.lammps.in.
//
// Cubic lattice, horizon 3.015 spacings, influence 1/xi, velocities along x growing with x. The contact law that pairs of broken bonds would have costs its look at near pairs, as it would in a
// user's run. Prints one line of JSON; only the stepping is timed, in time of the processors.

#include <particls/threads.h>
#include <particls/world.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const double spacing = 0.008;                          ///< [m]
static const double horizon = 3.015;                          ///< spacings
static const double density = 1.0;                            ///< [kg/m^3]
static const double bulk_modulus = 10.0, shear_modulus = 4.0; ///< [Pa]
static const double speed = 0.01;                             ///< of the ends [m/s]
static const double time_step = 1e-4;                         ///< [s]

typedef struct options
{
    size_t side, steps;
    const char *law;
} options;

static bool read_options(int argc, char **argv, options *o)
{
    for (int k = 1; k < argc; k += 2)
    {
        char *rest = NULL;
        size_t value = k + 1 < argc ? strtoul(argv[k + 1], &rest, 10) : 0;
        bool whole = rest && *rest == '\0' && value >= 1 && value <= 10000000;
        if (strcmp(argv[k], "--side") == 0 && whole && value <= 400)
            o->side = value;
        else if (strcmp(argv[k], "--steps") == 0 && whole)
            o->steps = value;
        else if (strcmp(argv[k], "--law") == 0 && k + 1 < argc)
            o->law = argv[k + 1];
        else
        {
            fprintf(stderr,
                    "peridynamics: cannot use '%s%s%s'\nusage: peridynamics [--side N] [--steps N] [--law NAME]\n"
                    "  --side N    points along each edge of the cube (40)\n"
                    "  --steps N   steps that are timed (100)\n"
                    "  --law NAME  linear_solid, bond_based or beam (of nearest neighbours)\n",
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

static pls_status add_points(pls_world *world, const options *o, pls_shape_id ball, pls_material_id solid)
{
    PLS_TRY(pls_world_reserve_bodies(world, o->side * o->side * o->side));
    const double length = spacing * (double)o->side;
    for (size_t k = 0; k < o->side * o->side * o->side; ++k)
    {
        pls_body_def def = pls_default_body_def();
        pls_body_id id;
        def.shape = ball, def.material = solid;
        def.mass = density * spacing * spacing * spacing;
        def.position =
            pls_vec(spacing * (double)(k % o->side), spacing * (double)(k / o->side % o->side), spacing * (double)(k / o->side / o->side));
        def.velocity.x = speed * (2.0 * def.position.x / length - 1.0);
        PLS_TRY(pls_world_add_body(world, &def, &id));
    }
    return PLS_OK;
}

static pls_status build(const options *o, pls_world **world)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = time_step;
    def.coordination = 0;
    PLS_TRY(pls_world_create(&def, world));
    pls_shape_id ball;
    const double radius = 0.5 * spacing;
    PLS_TRY(pls_world_add_shape(*world, "point", find_shape("sphere"), &radius, 1, &ball));
    pls_material_def material = pls_default_material_def();
    pls_material_id solid;
    snprintf(material.name, sizeof material.name, "solid");
    const double K = bulk_modulus, mu = o->law && strcmp(o->law, "bond_based") == 0 ? 0.6 * K : shear_modulus;
    material.values = (pls_material_values){
        .density = density, .young_modulus = 9.0 * K * mu / (3.0 * K + mu), .poisson_ratio = (3.0 * K - 2.0 * mu) / (2.0 * (3.0 * K + mu))};
    PLS_TRY(pls_world_add_material(*world, &material, &solid));
    const pls_law_ops *const *law = pls_builtin_laws();
    while (*law && strcmp((*law)->name, "elastic") != 0) ++law;
    if (!*law) return pls_fail(PLS_NOT_FOUND, "there is no law 'elastic'");
    double values[PLS_MAX_VALUES] = {0};
    pls_parameters_default((*law)->parameters, values);
    values[pls_parameter_find((*law)->parameters, "kn")] = bulk_modulus * spacing;
    PLS_TRY(pls_world_set_law(*world, solid, solid, *law, values));
    PLS_TRY(add_points(*world, o, ball, solid));
    pls_bonds_def bonds = pls_default_bonds_def();
    pls_bonds_id id;
    snprintf(bonds.name, sizeof bonds.name, "cube");
    const pls_bond_ops *const *ops = pls_builtin_bonds();
    while (*ops && strcmp((*ops)->name, o->law) != 0) ++ops;
    if (!*ops) return pls_fail(PLS_NOT_FOUND, "there is no bond law '%s'", o->law);
    const double section[] = {0.4 * spacing, 0.0, 0.0}; // a beam's radius and strengths
    bonds.ops = *ops;
    bonds.horizon = ((*ops)->pair ? 1.1 : horizon) * spacing;
    bonds.values = (*ops)->pair ? section : NULL;
    bonds.spacing = spacing;
    return pls_world_add_bonds(*world, &bonds, &id);
}

static double processor_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static double wall_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static pls_status measure(const options *o, pls_world *world)
{
    PLS_TRY(pls_world_run(world, 5)); // caches, clocks
    const double began = processor_seconds(), wall = wall_seconds();
    PLS_TRY(pls_world_run(world, o->steps));
    const double cpu = processor_seconds() - began, took = wall_seconds() - wall;
    uint64_t hash;
    pls_bonds_figures figures;
    pls_world_figures whole;
    PLS_TRY(pls_world_state_hash(world, &hash));
    PLS_TRY(pls_world_bonds_figures(world, pls_world_find_bonds(world, "cube"), &figures));
    PLS_TRY(pls_world_get_figures(world, &whole));
    printf("{\"points\": %zu, \"bonds\": %zu, \"law\": \"%s\", \"steps\": %zu, \"threads\": %d, \"cpu_s\": %.6f, \"wall_s\": %.6f, "
           "\"step_ms\": %.4f, "
           "\"bonds_per_s\": %.0f, \"bytes_per_bond\": %.2f, \"list_builds\": %" PRIu64
           ", \"energy\": %.9g, \"kinetic_energy\": %.9g, \"state_hash\": \"%016" PRIx64 "\"}\n",
           figures.points, figures.bonds, o->law, o->steps, pls_threads(), cpu, took, 1e3 * took / (double)o->steps,
           (double)figures.bonds * (double)o->steps / took, (double)figures.bytes / (double)figures.bonds, whole.list_builds,
           figures.energy, whole.energy_kinetic, hash);
    return PLS_OK;
}

int main(int argc, char **argv)
{
    options o = {.side = 40, .steps = 100, .law = "linear_solid"};
    if (!read_options(argc, argv, &o)) return 2;
    if (!getenv("OMP_NUM_THREADS")) pls_set_threads(1);
    pls_world *world = NULL;
    pls_status status = build(&o, &world);
    if (status == PLS_OK) status = measure(&o, world);
    if (status != PLS_OK) fprintf(stderr, "peridynamics: %s\n", pls_last_message());
    pls_world_destroy(world);
    return status == PLS_OK ? 0 : 1;
}
