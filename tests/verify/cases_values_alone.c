// cases_values_alone.c -- bodies of which only the signed distance is known: rings that fall on each other, boxes that stand on each other, rings and brackets on rims of walls.
//
// Contact goes by pieces of their surfaces. However coarse these are, no energy may be won.
#include "support/numbers.h"
#include "support/values_alone.h"
#include "verify/cases.h"

enum { RINGS = 3, BOXES = 2 };
static const double gravity = 10.0, kn = 300.0;

static const verify_value damped[] = {{"kn", kn}, {"ks", 0.5 * kn}, {"cn", 2.0}, {"cs", 1.0}, {"friction", 0.5}, {NULL, 0.0}};
static const verify_value stiff[] = {{"kn", 3e3}, {"ks", 2e3}, {"cn", 10.0}, {"cs", 10.0}, {"friction", 0.5}, {NULL, 0.0}};
static const verify_value elastic[] = {{"kn", kn}, {"ks", 0.0}, {"cn", 0.0}, {"cs", 0.0}, {"friction", 0.0}, {NULL, 0.0}};
// So stiff that no corner goes into a wall by half of a grain's thickness, where the run would stop.
static const verify_value elastic_on_walls[] = {{"kn", 3.0 * kn}, {"ks", 0.0}, {"cn", 0.0}, {"cs", 0.0}, {"friction", 0.0}, {NULL, 0.0}};

static verify_scene open_on_floor(double dt, const verify_value *values)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    def.coordination = 4;
    verify_scene scene = verify_open(&def, "viscoelastic", values);
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -gravity)));
    return scene;
}

static pls_shape_id add_values(const verify_scene *scene, const pls_shape_ops *ops, const double *values, size_t count)
{
    pls_shape_id id;
    MUST(pls_world_add_shape(scene->world, ops->name, ops, values, count, &id));
    return id;
}

/// Three rings above each other, aslant.
static verify_scene drop_rings(double dt, const verify_value *values)
{
    verify_scene scene = open_on_floor(dt, values);
    const pls_shape_id ring = add_values(&scene, &values_ring, NUMBERS(0.3, 0.1));
    const double lean[RINGS] = {0.3, 0.7, 1.0}, side[RINGS] = {0.0, 0.1, -0.1}, height[RINGS] = {0.35, 0.9, 1.5};
    for (int k = 0; k < RINGS; ++k)
    {
        pls_body_def body = verify_body_def(&scene, ring, pls_vec(side[k], 0.02 * k, height[k]));
        body.orientation = (pls_quat){cos(0.5 * lean[k]), 0.8 * sin(0.5 * lean[k]), 0.6 * sin(0.5 * lean[k]), 0.0};
        verify_add(&scene, &body);
    }
    MUST(pls_world_prepare(scene.world));
    return scene;
}

static double largest_book_error(verify_scene *scene, int looks, int steps)
{
    const double start = verify_total_energy(scene->world);
    double error = 0.0;
    for (int k = 0; k < looks; ++k)
    {
        MUST(pls_world_run(scene->world, (uint64_t)steps));
        error = fmax(error, fabs(verify_total_energy(scene->world) / start - 1.0));
    }
    return error;
}

static void rings(verify_sheet *sheet)
{
    const int scale = sheet->thorough ? 4 : 1;
    const double dt = 2e-4 / scale;
    verify_scene scene = drop_rings(dt, damped);
    sheet_below(sheet, largest_book_error(&scene, 120, 200 * scale), 1e-3 / scale,
                "three rings fall and come to rest: error of the energy book at dt = %g s", dt);
    if (sheet->thorough) MUST(pls_world_run(scene.world, 200000)); // the last to stop is a ring that rolls on its rim
    sheet_below(sheet, verify_figures(scene.world).energy_kinetic / verify_total_energy(scene.world), 1e-8,
                "three rings: kinetic energy in the end, of all");
    verify_close(&scene);

    scene = drop_rings(dt, elastic);
    sheet_below(sheet, largest_book_error(&scene, 50, 100 * scale), 2e-3 / scale,
                "three rings, no damping: relative error of the energy in 1 s at dt = %g s", dt);
    verify_close(&scene);
}

/// A stack that is let go a little above the floor.
static void boxes(verify_sheet *sheet)
{
    const double half[3] = {0.25, 0.2, 0.15}, gap = 2e-3;
    verify_scene scene = open_on_floor(1e-4, stiff);
    const pls_shape_id box = add_values(&scene, &values_box, NUMBERS(half[0], half[1], half[2], 0.0));
    pls_body_id id[BOXES];
    for (int k = 0; k < BOXES; ++k)
    {
        pls_body_def body = verify_body_def(&scene, box, pls_vec(0.004 * k, -0.003 * k, (2 * k + 1) * half[2] + (k + 1) * gap));
        body.orientation = (pls_quat){cos(0.002 * k), 0.0, 0.0, sin(0.002 * k)};
        id[k] = verify_add(&scene, &body);
    }
    MUST(pls_world_prepare(scene.world));
    sheet_below(sheet, largest_book_error(&scene, 40, 500), 1e-4, "two boxes come to rest on each other: error of the energy book");
    const pls_body_motion rests = verify_motion(scene.world, id[BOXES - 1]);
    MUST(pls_world_run(scene.world, sheet->thorough ? 100000 : 5000));
    const pls_body_motion now = verify_motion(scene.world, id[BOXES - 1]);
    sheet_below(sheet, pls_length(now.angular_velocity), 1e-8, "two boxes: spin of the topmost at rest [rad/s]");
    sheet_below(sheet, pls_length(pls_sub(now.position, rests.position)) / half[0], 1e-6, "two boxes: its drift at rest, of its size");
    verify_close(&scene);
}

/// Rings and brackets fall on the rim of a sheet that stands on a floor, both of triangles: some have parts of them on both sides of it.
static verify_scene drop_on_fin(double dt, const verify_value *values)
{
    enum { GRAINS = 4 };
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    def.coordination = 4;
    verify_scene scene = verify_open(&def, "viscoelastic", values);
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -gravity)));
    pls_body_def wall = verify_body_def(&scene, verify_add_mesh(&scene, PLS_TEST_DATA "/fin.obj"), pls_vec(0, 0, 0));
    wall.motion.axes = PLS_AXIS_ALL;
    verify_add(&scene, &wall);
    const pls_shape_id shape[2] = {add_values(&scene, &values_ring, NUMBERS(0.25, 0.08)),
                                   add_values(&scene, &values_bracket, NUMBERS(0.25, 0.15))};
    const double side[GRAINS] = {0.05, 0.12, -0.1, 0.02}, along[GRAINS] = {-0.9, -0.2, 0.45, 1.1}, lean[GRAINS] = {1.3, 0.9, 0.4, 2.2};
    for (int k = 0; k < GRAINS; ++k)
    {
        pls_body_def body = verify_body_def(&scene, shape[k % 2], pls_vec(side[k], along[k], 1.95));
        body.orientation = (pls_quat){cos(0.5 * lean[k]), 0.8 * sin(0.5 * lean[k]), 0.6 * sin(0.5 * lean[k]), 0.0};
        verify_add(&scene, &body);
    }
    MUST(pls_world_prepare(scene.world));
    return scene;
}

static void fin(verify_sheet *sheet)
{
    const int scale = sheet->thorough ? 2 : 1;
    const double dt = 2e-4 / scale;
    verify_scene scene = drop_on_fin(dt, damped);
    sheet_below(sheet, largest_book_error(&scene, sheet->thorough ? 120 : 20, 200 * scale), 1e-3,
                "rings and brackets fall on the rim of a sheet and come to rest: error of the energy book at dt = %g s", dt);
    if (sheet->thorough)
    {
        MUST(pls_world_run(scene.world, 20000));
        sheet_below(sheet, verify_figures(scene.world).energy_kinetic / verify_total_energy(scene.world), 1e-8,
                    "rings and brackets on a sheet: kinetic energy in the end, of all");
    }
    verify_close(&scene);

    scene = drop_on_fin(dt, elastic_on_walls);
    sheet_below(sheet, largest_book_error(&scene, sheet->thorough ? 50 : 20, 100 * scale), 1e-2,
                "rings and brackets on a sheet, no damping: relative error of the energy at dt = %g s", dt);
    verify_close(&scene);
}

void case_values_alone(verify_sheet *sheet)
{
    rings(sheet);
    boxes(sheet);
    fin(sheet);
}
