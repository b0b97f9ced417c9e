// cases_step.c -- the estimate of the stable step: exact for one spring-dashpot, on the safe side but not far from the truth for packings.
#include "verify/cases.h"

#include "base/random.h"

#include <string.h>

static pls_step_estimate estimate_of_pair(double kn, double cn, double *w, double *z)
{
    pls_world_def def = pls_default_world_def(3);
    pls_step_estimate estimate;
    def.coordination = 1;
    def.dt = 1e-6;
    verify_scene scene = verify_open(
        &def, "viscoelastic", (const verify_value[]){{"kn", kn}, {"ks", 0.0}, {"cn", cn}, {"cs", 0.0}, {"friction", 0.0}, {NULL, 0.0}});
    verify_ball(&scene, 1.0, 2.0, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    verify_ball(&scene, 1.0, 2.0, pls_vec(1.999, 0, 0), pls_vec(0, 0, 0));
    MUST(pls_world_prepare(scene.world));
    MUST(pls_world_stable_step(scene.world, &estimate));
    verify_close(&scene);
    *w = sqrt(kn / 1.0); // m_eff = 1
    *z = cn / (2.0 * sqrt(kn * 1.0));
    return estimate;
}

void case_step_estimate_pair(verify_sheet *sheet)
{
    const double damping[] = {0.0, 20.0, 200.0, 2000.0};
    for (int k = 0; k < 4; ++k)
    {
        double w, z;
        pls_step_estimate e = estimate_of_pair(1e4, damping[k], &w, &z);
        sheet_relative(sheet, e.dt, 2.0 / w * (sqrt(1.0 + z * z) - z), 0.03, "z = %g: (2/w)(sqrt(1 + z^2) - z) [s]", z);
        sheet_absolute(sheet, e.damping_limits ? 1.0 : 0.0, z > 1.0 ? 1.0 : 0.0, z == 1.0 ? 1.0 : 0.0,
                       "z = %g: the dashpot sets the limit (1: yes)", z);
    }
}

// ---- packings ----

typedef struct packing
{
    const char *name;
    int dimension;
    double kn, ks, cn, cs;
} packing;

/// Periodic close packing, overlapping so little (1e-6) that its prestress does not let rows of spheres buckle: face-centred cubic in 3D (12 contacts), triangular in 2D (6), disturbed by small random velocities.
static verify_scene open_packing(const packing *p, double dt)
{
    enum { CELLS = 4 };
    static const double fcc[4][3] = {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}, triangular[2][3] = {{0, 0, 0}, {0.5, 0.5, 0}};
    const double tight = 1.0 - 1e-6;
    bool flat = p->dimension == 2;
    double a = flat ? 2.0 * tight : 2.0 * sqrt(2.0) * tight;
    pls_vec3 cell = flat ? pls_vec(a, a * sqrt(3.0), 0) : pls_vec(a, a, a);
    pls_world_def def = pls_default_world_def(p->dimension);
    def.dt = dt;
    def.allow_unstable = true;
    def.periodic[0] = def.periodic[1] = true;
    def.periodic[2] = !flat;
    def.upper = pls_scale(cell, CELLS);
    verify_scene scene =
        verify_open(&def, "viscoelastic",
                    (const verify_value[]){{"kn", p->kn}, {"ks", p->ks}, {"cn", p->cn}, {"cs", p->cs}, {"friction", 1000.0}, {NULL, 0.0}});
    uint64_t number = 0;
    for (int x = 0; x < CELLS; ++x)
        for (int y = 0; y < CELLS; ++y)
            for (int z = 0; z < (flat ? 1 : CELLS); ++z)
                for (int b = 0; b < (flat ? 2 : 4); ++b)
                {
                    const double *s = flat ? triangular[b] : fcc[b];
                    pls_random random = pls_random_stream(1, number++, PLS_FOR_USER);
                    pls_vec3 v = pls_vec(pls_random_normal(&random), pls_random_normal(&random), pls_random_normal(&random));
                    pls_vec3 w = pls_vec(pls_random_normal(&random), pls_random_normal(&random), pls_random_normal(&random));
                    pls_body_def ball = verify_ball_def(
                        &scene, 1.0, 1.0, pls_vec((x + s[0] + 0.1) * cell.x, (y + s[1] + 0.1) * cell.y, (z + s[2] + 0.1) * cell.z),
                        pls_scale(v, 1e-9));
                    if (flat) ball.position.z = ball.velocity.z = 0.0, w.x = w.y = 0.0;
                    ball.angular_velocity = pls_scale(w, 1e-9);
                    verify_add(&scene, &ball);
                }
    return scene;
}

static double kinetic(pls_world *world)
{
    pls_world_figures f = verify_figures(world);
    return f.energy_kinetic + f.energy_rotation;
}

/// True when the disturbance grows a hundredfold in energy within the steps.
static bool grows(const packing *p, double dt, int steps)
{
    verify_scene scene = open_packing(p, dt);
    MUST(pls_world_prepare(scene.world));
    double start = kinetic(scene.world);
    bool grown = false;
    for (int k = 0; k < steps / 50 && !grown; ++k)
        grown = pls_world_run(scene.world, 50) != PLS_OK || !(kinetic(scene.world) < 100.0 * start); // flying apart also stops the run
    verify_close(&scene);
    return grown;
}

void case_step_estimate_packing(verify_sheet *sheet)
{
    const packing packings[] = {
        {"face-centred cubic, springs", 3, 1000.0, 600.0, 0.0, 0.0},
        {"face-centred cubic, over-damped", 3, 1000.0, 600.0, 150.0, 75.0},
        {"triangular, springs", 2, 1000.0, 600.0, 0.0, 0.0},
        {"triangular, over-damped", 2, 1000.0, 600.0, 150.0, 75.0},
    };
    int steps = sheet->thorough ? 4000 : 1000, halvings = sheet->thorough ? 10 : 6;
    for (int k = 0; k < 4; ++k)
    {
        pls_step_estimate estimate;
        verify_scene scene = open_packing(&packings[k], 1e-6);
        MUST(pls_world_prepare(scene.world));
        MUST(pls_world_stable_step(scene.world, &estimate));
        verify_close(&scene);
        double low = 0.5 * estimate.dt, high = 8.0 * estimate.dt;
        for (int j = 0; j < halvings; ++j)
        {
            double middle = sqrt(low * high);
            *(grows(&packings[k], middle, steps) ? &high : &low) = middle;
        }
        double share = estimate.dt / low;
        sheet_absolute(sheet, share, 2.0 / 3.0, 1.0 / 3.0 + 1e-9, "%s: estimate over the true limit, between 1/3 and 1", packings[k].name);
        sheet_below(sheet, grows(&packings[k], estimate.dt, steps) ? 1.0 : 0.0, 0.5, "%s: the estimate itself is unstable (1: yes)",
                    packings[k].name);
    }
}

void case_step_refused(verify_sheet *sheet)
{
    // The uniaxial compression of P1 section 5.3: over-damped (z = 2.4), so the dashpots and not the springs set the step.
    const double steps[] = {1e-4, 2.5e-5};
    for (int k = 0; k < 3; ++k)
    {
        pls_world_def def = pls_default_world_def(3);
        def.dt = steps[k == 1 ? 1 : 0];
        def.allow_unstable = k == 2;
        verify_scene scene =
            verify_open(&def, "viscoelastic",
                        (const verify_value[]){{"kn", 20}, {"ks", 10}, {"cn", 0.08}, {"cs", 0.04}, {"friction", 0.3}, {NULL, 0.0}});
        double r = 0.0188888, mass = 4.0 / 3.0 * 3.14159265358979323846 * r * r * r;
        for (int j = 0; j < 8; ++j)
            verify_ball(&scene, r, mass, pls_vec(2.0 * r * (j % 2), 2.0 * r * (j / 2 % 2), 2.0 * r * (j / 4)), pls_vec(0, 0, 0));
        pls_status status = pls_world_prepare(scene.world);
        bool names = status != PLS_OK && strstr(pls_last_message(), "dashpot") != NULL;
        verify_close(&scene);
        sheet_absolute(sheet, (double)status, k == 0 ? (double)PLS_UNSTABLE_STEP : (double)PLS_OK, 0.0,
                       "P1 5.3 at dt = %g s%s: status code", def.dt, k == 2 ? ", allow_unstable" : "");
        if (k == 0) sheet_absolute(sheet, names ? 1.0 : 0.0, 1.0, 0.0, "the message names the dashpot (1: yes)");
    }
}
