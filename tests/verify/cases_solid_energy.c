// cases_solid_energy.c -- conservation among grains of all shapes: momenta of a free cloud, and the energy book with friction.
#include "verify/cases.h"

#include "base/random.h"
#include "support/grains.h"

static pls_vec3 random_vector(pls_random *random)
{
    const double x = pls_random_normal(random), y = pls_random_normal(random), z = pls_random_normal(random);
    return pls_vec(x, y, z);
}

static void use_faces(const verify_scene *scene, pls_faces faces) { verify_set_faces(scene, faces, faces == PLS_FACES_VOLUME ? 0.1 : 0.0); }

// ---- a cloud --------------------------------------------------------------------------------------------------------------------------------------------

/// 500 grains of ten shapes fly into each other, without walls or gravity.
static void fly(verify_sheet *sheet, pls_faces faces, const char *name)
{
    enum { COUNT = 500, SIDE = 8 };
    pls_world_def def = pls_default_world_def(3);
    def.dt = 2e-4;
    verify_scene scene =
        verify_open(&def, "viscoelastic",
                    (const verify_value[]){{"kn", 2000.0}, {"ks", 1500.0}, {"cn", 0.5}, {"cs", 0.3}, {"friction", 0.3}, {NULL, 0.0}});
    use_faces(&scene, faces);
    pls_shape_id shape[GRAIN_QUICK_KINDS];
    for (int k = 0; k < GRAIN_QUICK_KINDS; ++k) shape[k] = grain_shape(&scene, (enum grain_kind)k);
    for (int k = 0; k < COUNT; ++k)
    {
        pls_random random = pls_random_stream(7, (uint64_t)k, PLS_FOR_USER);
        pls_vec3 x = pls_vec(k % SIDE - 3.5, k / SIDE % SIDE - 3.5, k / (SIDE * SIDE) - 3.5);
        pls_body_def grain = grain_def(&scene, shape[k % GRAIN_QUICK_KINDS], (uint64_t)k, x);
        grain.velocity = pls_add(pls_add(pls_scale(x, -1.5), pls_vec(0, 0.4 * x.x, 0)), random_vector(&random));
        grain.angular_velocity = pls_scale(random_vector(&random), 2.0);
        verify_add(&scene, &grain);
    }
    MUST(pls_world_prepare(scene.world));
    const pls_world_figures start = verify_figures(scene.world);
    pls_world_figures now = start;
    double moved = 0.0, turned = 0.0;
    size_t most = 0;
    const int looks = 10, steps = sheet->thorough ? 10000 : 1000;
    for (int k = 0; k < looks; ++k)
    {
        MUST(pls_world_run(scene.world, (uint64_t)(steps / looks)));
        now = verify_figures(scene.world);
        moved = fmax(moved, pls_length(pls_sub(now.momentum, start.momentum)));
        turned = fmax(turned, pls_length(pls_sub(now.angular_momentum, start.angular_momentum)));
        most = now.touching > most ? now.touching : most;
    }
    verify_close(&scene);
    const double scale = COUNT * 0.1 * 4.0; // of about 0.1 kg at 4 m/s each, 4 m from the middle
    sheet_below(sheet, moved / scale, 1e-13, "%s: change of momentum in %d steps, of the sum of absolute values", name, steps);
    sheet_below(sheet, turned / (4.0 * scale), 1e-13, "%s: change of angular momentum in %d steps, of the same", name, steps);
    sheet_below(sheet, 1.0 / (double)most, 0.01, "%s: one over the most contacts at a time: the cloud does collide", name);
    sheet_below(sheet, now.energy_slid > 0.01 * start.energy_kinetic ? 0.0 : 1.0, 0.5,
                "%s: sliding took more than 1 %% of the energy (1: it did not)", name);
}

void case_solid_cloud(verify_sheet *sheet)
{
    fly(sheet, PLS_FACES_MANIFOLD, "faces: manifold");
    if (!sheet->thorough) return;
    fly(sheet, PLS_FACES_POINT, "faces: point");
    fly(sheet, PLS_FACES_VOLUME, "faces: volume");
}

// ---- the energy book of impacts -------------------------------------------------------------------------------------------------------------------------

typedef struct impact
{
    enum grain_kind a, b; ///< b GRAIN_KINDS: a plane
    pls_faces faces;
    const char *law;
} impact;

/// Relative error of the energy book after an impact of two grains with friction and dashpots; grazing ones among them.
static double impact_error(const impact *p, int number, double dt)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    def.coordination = 2;
    verify_scene scene =
        verify_open(&def, "viscoelastic",
                    (const verify_value[]){{"kn", 400.0}, {"ks", 300.0}, {"cn", 0.3}, {"cs", 0.2}, {"friction", 0.3}, {NULL, 0.0}});
    use_faces(&scene, p->faces);
    const bool plane = p->b == GRAIN_KINDS;
    pls_random random = pls_random_stream(5, (uint64_t)number, PLS_FOR_USER);
    pls_vec3 aside = random_vector(&random);
    aside = pls_scale(pls_unit(pls_vec(0.0, aside.y, aside.z)), 0.4 * pls_random_uniform(&random));
    const double far = plane ? 0.6 : 1.05;
    pls_body_def a = grain_def(&scene, grain_shape(&scene, p->a), (uint64_t)(2 * number), pls_vec(-far, 0, 0));
    a.position = pls_add(a.position, aside);
    a.velocity = pls_vec(1.0, 0.6 * pls_random_normal(&random), 0.6 * pls_random_normal(&random));
    a.angular_velocity = pls_scale(random_vector(&random), 2.0);
    verify_add(&scene, &a);
    if (plane)
        verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(-1, 0, 0));
    else
    {
        pls_body_def b = grain_def(&scene, grain_shape(&scene, p->b), (uint64_t)(2 * number + 1), pls_vec(0, 0, 0));
        b.angular_velocity = pls_scale(random_vector(&random), 2.0);
        verify_add(&scene, &b);
    }
    MUST(pls_world_prepare(scene.world));
    const double start = verify_total_energy(scene.world);
    bool touched = false;
    for (double t = 0.0; t < 3.0; t += 20.0 * dt)
    {
        MUST(pls_world_run(scene.world, 20));
        const bool touches = pls_world_contact_count(scene.world) > 0;
        if (touched && !touches) break;
        touched = touched || touches;
    }
    const double error = touched ? fabs(verify_total_energy(scene.world) / start - 1.0) : NAN;
    verify_close(&scene);
    return error;
}

void case_solid_book(verify_sheet *sheet)
{
    static const impact all[] = {
        {GRAIN_ELLIPSOID, GRAIN_ELLIPSOID, PLS_FACES_POINT, "point"}, {GRAIN_CAPSULE, GRAIN_CAPSULE, PLS_FACES_POINT, "point"},
        {GRAIN_SOAP, GRAIN_SOAP, PLS_FACES_POINT, "point"},           {GRAIN_SUPERQUADRIC, GRAIN_ELLIPSOID, PLS_FACES_POINT, "point"},
        {GRAIN_ELLIPSOID, GRAIN_KINDS, PLS_FACES_POINT, "point"},     {GRAIN_BOX, GRAIN_BOX, PLS_FACES_MANIFOLD, "manifold"},
        {GRAIN_STONE, GRAIN_BOX, PLS_FACES_MANIFOLD, "manifold"},     {GRAIN_STONE, GRAIN_STONE, PLS_FACES_VOLUME, "volume"},
        {GRAIN_BOX, GRAIN_KINDS, PLS_FACES_MANIFOLD, "manifold"},     {GRAIN_BOX, GRAIN_KINDS, PLS_FACES_VOLUME, "volume"},
    };
    enum { MOST = 5 };
    const int levels = sheet->thorough ? 5 : 3, impacts = sheet->thorough ? 40 : 6;
    for (size_t k = 0; k < sizeof all / sizeof *all; ++k)
    {
        double dt[MOST], mean[MOST];
        for (int level = 0; level < levels; ++level)
        {
            dt[level] = 1e-3 / (1 << level);
            mean[level] = 0.0;
            int met = 0;
            for (int j = 0; j < impacts; ++j)
            {
                const double error = impact_error(&all[k], j, dt[level] * (1.0 + 0.01 * j / impacts));
                if (isnan(error)) continue; // it missed
                mean[level] += error, ++met;
            }
            mean[level] /= met;
        }
        const char *other = all[k].b == GRAIN_KINDS ? "plane" : grain_name(all[k].b);
        sheet_below(sheet, mean[levels - 1], 1e-4 * pow(0.25, levels - 3), "%s on %s, %s: mean relative error, dt = %g s",
                    grain_name(all[k].a), other, all[k].law, dt[levels - 1]);
        // A kink at first touch makes errors depend on its phase; few impacts tell the order less well.
        sheet_below(sheet, fmax(0.0, 2.0 - fitted_order(levels, dt, mean)), sheet->thorough ? 0.3 : 0.5,
                    "%s on %s, %s: what the order in dt lacks of two", grain_name(all[k].a), other, all[k].law);
    }
}

// ---- a crowd that stays together ------------------------------------------------------------------------------------------------------------------------

static void trap_force(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)time, (void)velocity, (void)body, (void)torque;
    *force = pls_scale(position, -5.0);
}

static double trap_potential(pls_vec3 position, double mass)
{
    (void)mass;
    return 2.5 * pls_dot(position, position);
}

/// Grains of one kind, of all but the slow ones (GRAIN_QUICK_KINDS), and whether there are walls about them.
typedef struct crowd
{
    pls_faces faces;
    enum grain_kind kind;
    bool walls; ///< of a mesh
} crowd;

enum { CROWD = 50, SIDE = 4 }; ///< as many grains as five of each kind

/// Largest relative error of the energy book of grains that a field pulls together: they collide, press, roll and spin on each other and on walls.
static double crowd_error(const crowd *p, double dt, int steps, size_t *most)
{
    static const verify_field trap = {trap_force, trap_potential};
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene =
        verify_open(&def, "viscoelastic",
                    (const verify_value[]){{"kn", 2000.0}, {"ks", 1500.0}, {"cn", 0.5}, {"cs", 0.3}, {"friction", 0.3}, {NULL, 0.0}});
    use_faces(&scene, p->faces);
    verify_add_field(scene.world, &trap);
    if (p->walls)
    {
        pls_body_def room = verify_body_def(&scene, verify_add_mesh(&scene, PLS_TEST_DATA "/room.obj"), pls_vec(0, 0, 0));
        room.motion.axes = PLS_AXIS_ALL;
        verify_add(&scene, &room);
    }
    pls_shape_id shape[GRAIN_QUICK_KINDS];
    for (int k = 0; k < GRAIN_QUICK_KINDS; ++k) shape[k] = grain_shape(&scene, p->kind == GRAIN_QUICK_KINDS ? (enum grain_kind)k : p->kind);
    for (int k = 0; k < CROWD; ++k)
    {
        pls_random random = pls_random_stream(9, (uint64_t)k, PLS_FOR_USER);
        pls_vec3 x = pls_vec(k % SIDE - 1.5, k / SIDE % SIDE - 1.5, k / (SIDE * SIDE) - 1.0);
        pls_body_def grain = grain_def(&scene, shape[k % GRAIN_QUICK_KINDS], (uint64_t)k, x);
        grain.velocity = pls_add(pls_vec(0, 2.0 * x.x, 0), random_vector(&random));
        grain.angular_velocity = pls_scale(random_vector(&random), 2.0);
        verify_add(&scene, &grain);
    }
    MUST(pls_world_prepare(scene.world));
    const double start = verify_total_energy(scene.world);
    double error = 0.0;
    *most = 0;
    for (int k = 0; k < 50; ++k)
    {
        MUST(pls_world_run(scene.world, (uint64_t)(steps / 50)));
        const size_t touching = pls_world_contact_count(scene.world);
        error = fmax(error, fabs(verify_total_energy(scene.world) / start - 1.0));
        *most = touching > *most ? touching : *most;
    }
    verify_close(&scene);
    return error;
}

void case_solid_crowd(verify_sheet *sheet)
{
    const pls_faces faces[2] = {PLS_FACES_MANIFOLD, PLS_FACES_VOLUME};
    const char *const name[2] = {"manifold", "volume"};
    const int steps = sheet->thorough ? 100000 : 2500;
    for (int k = 0; k < 2; ++k)
    {
        size_t most;
        const crowd p = {faces[k], GRAIN_QUICK_KINDS, false};
        const double error = crowd_error(&p, 5e-5, steps, &most);
        sheet_below(sheet, error, 1e-4, "%d grains of all shapes, faces: %s: relative error of the energy book in %d steps", CROWD, name[k],
                    steps);
        sheet_below(sheet, 1.0 / (double)most, 1.0 / 20.0, "one over the most contacts at a time");
        enum { MOST = 4 };
        const int levels = sheet->thorough ? MOST : 3;
        double dt[MOST], errors[MOST];
        for (int level = 0; level < levels; ++level)
        {
            dt[level] = 2e-4 / (1 << level);
            errors[level] = crowd_error(&p, dt[level], 2500 << level, &most);
        }
        sheet_below(sheet, fmax(0.0, 2.0 - fitted_order(levels, dt, errors)), 0.25,
                    "faces: %s: what the order in dt of the error in 0.5 s lacks of two", name[k]);
    }
    if (!sheet->thorough) return;
    size_t most;
    const crowd within = {PLS_FACES_MANIFOLD, GRAIN_QUICK_KINDS, true};
    sheet_below(sheet, crowd_error(&within, 5e-5, steps, &most), 1e-4,
                "%d grains of all shapes within walls of a mesh, faces: manifold: relative error of the energy book in %d steps", CROWD,
                steps);
}
