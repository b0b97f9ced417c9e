// cases_pile.c -- grains of all built-in kinds fall into a pen, each on the others, and come to rest.
//
// By the default law, faces: manifold. Cylinders lie on planes, on bodies with faces and on each other; on round bodies they touch at points, and one of them is in the pile. The pen
// is so narrow that none is left to roll over the floor, which nothing stops. Besides, cans and superquadrics with flat ends that stand on each other: at points these would tremble and
// gain energy, a tenth of what was released in ten seconds.
#include "support/grains.h"
#include "support/numbers.h"
#include "verify/cases.h"

static const double gravity = 10.0;

enum { STACKED = 3, GRAINS = GRAIN_CYLINDER + 1 }; // those before the cylinder, and a longer one of its kind

/// Two layers of four grains and one more. Some are pressed against each other or a wall a little, by 1e-4 of what they fall through.
static pls_vec3 place_of(int k)
{
    const double side = 0.4;
    return k < 8 ? pls_vec(k & 1 ? side : -side, k & 2 ? side : -side, 0.6 + 1.05 * (k >> 2)) : pls_vec(0.0, 0.0, 2.8);
}

static double kinetic(const pls_world_figures *f) { return f->energy_kinetic + f->energy_rotation; }

/// Let go a little above each other, aslant. `name`: of what is stacked; `shape`, `values`, `count`: as verify_add_shape takes them; `half` its height; `soon`: what may move still in a test, of the energy released.
static void stack(verify_sheet *sheet, const char *name, const char *shape, const double *values, size_t count, double half, double soon)
{
    const verify_value law[] = {{"kn", 3e3}, {"ks", 2e3}, {"cn", 10.0}, {"cs", 10.0}, {"friction", 0.5}, {NULL, 0.0}};
    const double gap = 5e-3;
    const int falls = 30000, rests = sheet->thorough ? 100000 : 5000;
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-4;
    def.coordination = 4; // of contacts; that of areas and points is less than that of balls
    verify_scene scene = verify_open(&def, "viscoelastic", law);
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -gravity)));
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    const pls_shape_id id = verify_add_shape(&scene, shape, values, count);
    for (int k = 0; k < STACKED; ++k)
    {
        pls_body_def body = verify_body_def(&scene, id, pls_vec(0.02 * k, -0.01 * k * k, (2 * k + 1) * half + (k + 1) * gap));
        body.orientation = pls_quat_unit((pls_quat){1.0, 0.005 * (k - 1), 0.003, 0.004});
        verify_add(&scene, &body);
    }
    MUST(pls_world_prepare(scene.world));
    const pls_world_figures start = verify_figures(scene.world);
    const double all = verify_total_energy(scene.world);
    MUST(pls_world_run(scene.world, (uint64_t)falls));
    const pls_world_figures rest = verify_figures(scene.world);
    const double book = verify_total_energy(scene.world), released = start.energy_potential - rest.energy_potential;
    MUST(pls_world_run(scene.world, (uint64_t)rests));
    const pls_world_figures end = verify_figures(scene.world);
    sheet_below(sheet, fabs(book / all - 1.0), 1e-4, "three %s come to rest on each other: error of the energy book", name);
    sheet_below(sheet, kinetic(&end) / released, sheet->thorough ? 1e-12 : soon, "three %s: kinetic energy at rest, of the energy released",
                name);
    sheet_below(sheet, fabs(verify_total_energy(scene.world) - book) / released, 1e-9,
                "three %s: what comes to the energy book at rest in %d steps", name, rests);
    verify_close(&scene);
}

static void grains(verify_sheet *sheet)
{
    const verify_value law[] = {{"kn", 2e3}, {"ks", 6e2}, {"cn", 5.0}, {"cs", 0.8}, {"friction", 0.5}, {NULL, 0.0}};
    const double dt = 5e-5, half = 0.85;
    const int falls = 120000, rests = sheet->thorough ? 400000 : 20000;
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(&def, "viscoelastic", law);
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -gravity)));
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    for (int side = -1; side <= 1; side += 2)
    {
        verify_wall(&scene, pls_vec(side * half, 0, 0), pls_vec(-side, 0, 0));
        verify_wall(&scene, pls_vec(0, side * half, 0), pls_vec(0, -side, 0));
    }
    for (int k = 0; k < GRAINS; ++k)
    {
        const pls_shape_id shape =
            k < GRAIN_CYLINDER ? grain_shape(&scene, (enum grain_kind)k) : verify_add_shape(&scene, "cylinder", NUMBERS(0.25, 0.55, 0.0));
        const pls_body_def body = grain_def(&scene, shape, (uint64_t)k, place_of(k));
        verify_add(&scene, &body);
    }
    MUST(pls_world_prepare(scene.world));
    const pls_world_figures start = verify_figures(scene.world);
    const double all = verify_total_energy(scene.world);
    MUST(pls_world_run(scene.world, (uint64_t)falls));
    const pls_world_figures rest = verify_figures(scene.world);
    const double book = verify_total_energy(scene.world), released = start.energy_potential - rest.energy_potential;
    MUST(pls_world_run(scene.world, (uint64_t)rests));
    const pls_world_figures end = verify_figures(scene.world);
    sheet_below(sheet, kinetic(&rest) / released, 1e-6,
                "nine grains of all kinds in a pen: kinetic energy after %g s, of the potential energy released", falls * dt);
    sheet_below(sheet, kinetic(&end) / released, 1e-6, "and after %g s", (falls + rests) * dt);
    sheet_below(sheet, (book - all) / released, 1e-4, "error of the energy book until they rest, of the energy released");
    sheet_below(sheet, (verify_total_energy(scene.world) - book) / released, 1e-9, "and what comes to it at rest in %d steps", rests);
    verify_close(&scene);
}

void case_pile(verify_sheet *sheet)
{
    stack(sheet, "cans", "cylinder", NUMBERS(0.25, 0.24, 0.0), 0.12, 1e-12);
    stack(sheet, "box-like superquadrics", "superquadric", NUMBERS(0.25, 0.22, 0.12, 0.2, 0.2, 0.0), 0.12, 1e-6);
    if (sheet->thorough) stack(sheet, "flat-ended superquadrics", "superquadric", NUMBERS(0.25, 0.22, 0.12, 0.2, 1.0, 0.0), 0.12, 1e-6);
    grains(sheet);
}
