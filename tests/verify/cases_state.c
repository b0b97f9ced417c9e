// cases_state.c -- state objects: a growing radius, and the midpoint rule on an equation with a known solution.
#include "verify/cases.h"

static const double pi = 3.14159265358979323846;
static const verify_value plain_law[] = {{"kn", 1e3}, {"ks", 1e3}, {"friction", 0.3}, {NULL, 0.0}};

static pls_status constant_rate(void *context, const pls_state_point *at, const double *values, double *rate)
{
    (void)context;
    (void)at;
    (void)values;
    rate[0] = 1.0;
    return PLS_OK;
}

void case_dilating(verify_sheet *sheet)
{
    for (int keep_density = 0; keep_density < 2; ++keep_density)
    {
        double rho = 1.0, r0 = 0.5, t = 2.0;
        pls_world_def def = pls_default_world_def(3);
        def.dt = 1.0 / 1024.0;
        verify_scene scene = verify_open(&def, "elastic", plain_law);
        pls_body_def ball = pls_default_body_def();
        ball.shape = scene.ball;
        ball.material = scene.grain;
        ball.scale = r0;
        ball.angular_velocity = pls_vec(0, 0, 3.0);
        pls_body_id id = verify_add(&scene, &ball);
        pls_state_def state = pls_default_state_def();
        state.name[0] = 'r';
        state.body = id;
        state.components = 1;
        state.initial[0] = r0;
        state.target = PLS_STATE_RADIUS;
        state.keep_density = keep_density == 1;
        state.rate = constant_rate;
        pls_state_id radius;
        double value;
        MUST(pls_world_add_state(scene.world, &state, &radius));
        MUST(pls_world_run(scene.world, 2048));
        MUST(pls_state_get(scene.world, radius, &value));
        pls_body_motion m = verify_motion(scene.world, id);
        verify_close(&scene);
        const char *kept = keep_density ? "density kept" : "mass kept";
        double held = keep_density ? r0 + t : r0, mass = rho * 4.0 / 3.0 * pi * held * held * held;
        sheet_absolute(sheet, value, r0 + t, 1e-13, "%s: state after 2 s at rate 1 m/s [m]", kept);
        sheet_absolute(sheet, m.radius, r0 + t, 1e-13, "%s: radius [m]", kept);
        sheet_relative(sheet, m.mass, mass, 1e-13, "%s: mass [kg]", kept);
    }
}

static pls_status logistic_rate(void *context, const pls_state_point *at, const double *values, double *rate)
{
    (void)context;
    rate[0] = 2.0 * values[0] * (1.0 - values[0] / 3.0);
    rate[1] = -values[1] * at->time;
    return PLS_OK;
}

void case_logistic(verify_sheet *sheet)
{
    double dt[6], error[6], driven[6], last = 0.0;
    int levels = sheet->thorough ? 6 : 4;
    for (int k = 0; k < levels; ++k)
    {
        pls_world_def def = pls_default_world_def(3);
        dt[k] = def.dt = 0.02 / (1 << k);
        def.allow_unstable = true; // there is no contact
        verify_scene scene = verify_open(&def, "elastic", plain_law);
        verify_ball(&scene, 1.0, 1.0, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
        pls_state_def state = pls_default_state_def();
        state.name[0] = 's';
        state.components = 2;
        state.initial[0] = 0.1;
        state.initial[1] = 1.0;
        state.rate = logistic_rate;
        pls_state_id id;
        double value[2];
        MUST(pls_world_add_state(scene.world, &state, &id));
        MUST(pls_world_run(scene.world, (uint64_t)(100 << k)));
        MUST(pls_state_get(scene.world, id, value));
        verify_close(&scene);
        last = 3.0 / (1.0 + (3.0 / 0.1 - 1.0) * exp(-4.0)); // s' = 2 s (1 - s/3) from 0.1, at t = 2
        error[k] = fabs(value[0] - last);
        driven[k] = fabs(value[1] - exp(-2.0)); // s' = -s t
        sheet_point(sheet, "error of logistic growth", dt[k], error[k], NAN);
    }
    sheet_absolute(sheet, fitted_order(levels, dt, error), 2.0, 0.05, "order for s' = 2 s (1 - s/3)");
    sheet_absolute(sheet, fitted_order(levels, dt, driven), 2.0, 0.05, "order for s' = -s t");
    sheet_below(sheet, error[levels - 1] / last, 2e-5, "relative error at dt = %g s", dt[levels - 1]);
}
