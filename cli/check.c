// check.c -- particls check: build a scene, say what it is and how long it will take, write nothing.

#include "cli.h"

#include "base/alloc.h"
#include "base/clock.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

enum { SET, THREADS, NO_TIMING };

static const cli_option options[] = {
    [SET] = {"set", 's', "PATH=VALUE", "change a value of the scene, as in particls run; may be repeated"},
    [THREADS] = {"threads", 't', "N", "threads to use (default: all processors)"},
    [NO_TIMING] = {"no-timing", 'n', NULL, "do not run the few steps from which the time is estimated"},
    {0},
};

enum { MAX_OVERRIDES = 256, TIMED_STEPS = 50 };

static const double most_timing = 3; ///< wall time spent on timing [s]

/// What shapes are, so that a wrong unit or a wrong file shows: volumes and sizes at scale 1.
static void print_shapes(const pls_scene *scene)
{
    const size_t count = pls_scene_shape_count(scene);
    printf("shapes             %9zu\n", count);
    for (size_t k = 0; k < count; ++k)
    {
        const char *name = "";
        const pls_shape *shape = pls_scene_get_shape(scene, k, &name);
        printf("  %-16s %s", name, shape->ops->name);
        if (shape->part_count > 0) printf(" of %zu part%s", shape->part_count, shape->part_count == 1 ? "" : "s");
        if (!shape->ops->unbounded) printf(", radius %.6g m", shape->radius);
        if (!shape->ops->unbounded && !shape->ops->wall)
            printf(", %s %.6g m^%d", shape->dimension == 2 ? "area" : "volume", shape->volume, shape->dimension);
        if (shape->mass.error > 0.0) printf(" (measured, to a part of %.1g)", shape->mass.error);
        printf("\n");
    }
}

/// Radii and number of the bodies of one entry.
typedef struct entry
{
    size_t count, unbounded;
    double smallest, largest; ///< radius [m]
} entry;

static void count_body(entry *e, double radius)
{
    ++e->count;
    if (isinf(radius))
    {
        ++e->unbounded;
        return;
    }
    if (e->largest == 0 || radius < e->smallest) e->smallest = radius;
    if (radius > e->largest) e->largest = radius;
}

static void print_entry(const char *name, const entry *e)
{
    printf("  %-16s %9zu", name, e->count);
    if (e->unbounded == e->count)
        printf("   unbounded\n");
    else if (e->smallest < e->largest)
        printf("   radius %.6g to %.6g m\n", e->smallest, e->largest);
    else
        printf("   radius %.6g m\n", e->largest);
}

static pls_status print_bodies(const pls_world *world)
{
    pls_field_view group;
    pls_field_view radius;
    PLS_TRY(pls_world_body_field(world, "group", &group));
    PLS_TRY(pls_world_body_field(world, "radius", &radius));
    uint32_t groups = 1;
    for (size_t k = 0; k < group.count; ++k)
    {
        uint32_t id;
        memcpy(&id, (const char *)group.data + k * group.stride, sizeof id);
        if (id + 1 > groups) groups = id + 1;
    }
    entry *entries = NULL;
    PLS_TRY(pls_allocate(&entries, groups, sizeof *entries, "a table of entries"));
    for (size_t k = 0; k < group.count; ++k)
    {
        uint32_t id;
        double r;
        memcpy(&id, (const char *)group.data + k * group.stride, sizeof id);
        memcpy(&r, (const char *)radius.data + k * radius.stride, sizeof r);
        count_body(&entries[id], r);
    }
    printf("bodies             %9zu\n", pls_world_body_count(world));
    for (uint32_t id = 0; id < groups; ++id)
    {
        const char *name = id > 0 ? pls_world_group_name(world, (pls_group_id){id}) : "(unnamed)";
        if (entries[id].count > 0) print_entry(name ? name : "?", &entries[id]);
    }
    pls_release(&entries);
    return PLS_OK;
}

static pls_status print_memory(pls_world *world)
{
    pls_world_figures figures;
    PLS_TRY(pls_world_get_figures(world, &figures));
    char total[32];
    printf("contacts           %9zu touching, %zu pairs listed\n", figures.touching, figures.listed);
    if (figures.bonds > 0)
        printf("bonds              %9zu, of which %zu are broken, %.1f bytes each way\n", figures.bonds, figures.bonds_broken,
               0.5 * (double)figures.bond_bytes / (double)figures.bonds);
    printf("memory             %s", cli_bytes(total, (double)pls_memory_in_use()));
    if (figures.bodies > 0) printf(", %.0f bytes per body", (double)figures.body_bytes / (double)figures.bodies);
    if (figures.listed > 0) printf(", %.0f bytes per pair", (double)figures.contact_bytes / (double)figures.listed);
    printf("\n");
    return PLS_OK;
}

static double steps_to_end(const pls_world *world, double end)
{
    return fmax(ceil((end - pls_world_time(world)) / pls_world_dt(world) - 1e-6), 0);
}

static pls_status print_step(pls_world *world, double end)
{
    pls_step_estimate estimate;
    PLS_TRY(pls_world_stable_step(world, &estimate));
    printf("time step          %.6g s\n", pls_world_dt(world));
    if (isinf(estimate.dt))
        printf("stable step        nothing limits it\n");
    else
    {
        printf("stable step        %.6g s, limited by the %s at body %u with %d contacts (M^-1 K %.4g 1/s^2, M^-1 C %.4g 1/s)\n",
               estimate.dt,
               estimate.damping_limits                     ? "dashpots"
               : estimate.bonds > 0.5 * estimate.stiffness ? "bonds"
                                                           : "springs",
               estimate.body, estimate.contacts, estimate.stiffness, estimate.damping);
        if (pls_world_dt(world) > estimate.dt)
            printf("                   That is a bound from single bodies; the step passes the finer test of the whole, or allow_unstable "
                   "is set\n");
    }
    printf("steps              %.0f to t = %.6g s\n", steps_to_end(world, end), end);
    return PLS_OK;
}

static pls_status print_timing(pls_world *world, double end)
{
    double steps = steps_to_end(world, end);
    double begin = pls_clock();
    double wall = 0;
    int done = 0;
    while (done < TIMED_STEPS && done < steps && (done == 0 || wall < most_timing))
    {
        PLS_TRY(pls_step(world));
        ++done;
        wall = pls_clock() - begin;
    }
    if (done == 0 || wall <= 0) return PLS_OK;
    char text[32];
    printf("estimated time     %s with %d thread%s (%.3g M particle-steps/s, from the first %d steps; more contacts take longer)\n",
           cli_duration(text, wall / done * steps), pls_threads(), pls_threads() == 1 ? "" : "s",
           1e-6 * (double)pls_world_body_count(world) * done / wall, done);
    return PLS_OK;
}

static void print_observers(const pls_scene *scene)
{
    static const char *const kinds[] = {"particle", "collection", "frames", "checkpoint", "user"};
    size_t count;
    const pls_observer_def *observer = pls_scene_observers(scene, &count);
    printf("observers          %9zu\n", count);
    for (size_t k = 0; k < count; ++k)
    {
        const pls_schedule *schedule = &observer[k].schedule;
        printf("  %-16s %s", observer[k].name, kinds[observer[k].kind]);
        if (schedule->every_steps > 0)
            printf(" every %llu steps\n", (unsigned long long)schedule->every_steps);
        else if (schedule->every > 0)
            printf(" every %.6g s\n", schedule->every);
        else
            printf("\n");
    }
}

/// A wrong scene may show anywhere up to the first step; a step that fails is a failure of the run.
static int describe(pls_scene *scene, pls_world *world, bool timing)
{
    double end = pls_scene_end_time(scene);
    const char *title = pls_scene_title(scene);
    printf("scene              %s\n", pls_scene_path(scene));
    if (title && *title) printf("title              %s\n", title);
    print_shapes(scene);
    if (print_bodies(world) != PLS_OK || print_memory(world) != PLS_OK || print_step(world, end) != PLS_OK) return cli_failed(CLI_FAILED);
    print_observers(scene);
    if (timing && print_timing(world, end) != PLS_OK) return cli_failed(CLI_FAILED);
    return CLI_DONE;
}

static int check(const char *path, const char *const *overrides, size_t override_count, bool timing)
{
    pls_scene *scene = NULL;
    pls_world *world = NULL;
    int code = CLI_USAGE;
    if (pls_scene_load(path, overrides, override_count, &scene) != PLS_OK) return cli_failed(CLI_USAGE);
    if (pls_scene_build(scene, &world) != PLS_OK || pls_world_prepare(world) != PLS_OK)
        cli_failed(CLI_USAGE);
    else
        code = describe(scene, world, timing);
    pls_world_destroy(world);
    pls_scene_free(scene);
    return code;
}

static int run(int argc, char **argv)
{
    const char *overrides[MAX_OVERRIDES];
    size_t override_count = 0;
    bool timing = true;
    const char *value;
    int option;
    while ((option = cli_next_option(&cli_check, argc, argv, &value)) != CLI_NO_MORE)
    {
        if (option == CLI_HELP) return CLI_DONE;
        if (option == CLI_WRONG) return CLI_USAGE;
        if (option == THREADS && !cli_set_threads(&cli_check, value)) return CLI_USAGE;
        if (option == NO_TIMING) timing = false;
        if (option != SET) continue;
        if (!strchr(value, '=')) return cli_wrong_usage(&cli_check, "--set takes PATH=VALUE, such as vars.kn=30, not '%s'", value);
        if (override_count == MAX_OVERRIDES) return cli_wrong_usage(&cli_check, "--set may be given %d times at most", MAX_OVERRIDES);
        overrides[override_count++] = value;
    }
    const char *path = cli_only_argument(&cli_check, argc, argv, "scene file");
    return path ? check(path, overrides, override_count, timing) : CLI_USAGE;
}

const cli_verb cli_check = {
    .name = "check",
    .arguments = "SCENE",
    .summary = "check a scene and say how long it will take",
    .about = "Reads and builds the scene and reports shapes, bodies, contacts, memory, the time step against the largest stable one, and "
             "an estimate\n"
             "of the time the run will take, from a few steps. Writes nothing.",
    .example = "  particls check examples/two-spheres/scene.yaml",
    .options = options,
    .function = run,
};
