// cases_order.c -- second order in dt of everything that is integrated, together: bodies, tangential springs, states, and the energy book.
//
// Contacts are pressed so that they neither open nor slide: the problem is then smooth and the order of the integrator shows. Orders come from the
// differences of runs with dt, dt/2, dt/4 (Richardson), so no reference solution is needed.
#include "verify/cases.h"

enum { POSITION, VELOCITY, SPIN, STATE, QUANTITIES };
static const char *const quantity_names[QUANTITIES] = {"position", "velocity", "spin", "states"};

enum { COMPONENTS = 6 };
typedef struct order_result
{
    double value[QUANTITIES][COMPONENTS];
} order_result;

typedef order_result order_run(double dt, int steps);

static void put_vector(double *out, pls_vec3 v) { out[0] = v.x, out[1] = v.y, out[2] = v.z; }

static void compare_steps(verify_sheet *sheet, order_run *run, double duration, int first_steps, bool spins)
{
    enum { LEVELS = 5 };
    int levels = sheet->thorough ? LEVELS : 3;
    order_result result[LEVELS];
    for (int k = 0; k < levels; ++k) result[k] = run(duration / (first_steps << k), first_steps << k);
    for (int q = 0; q < QUANTITIES; ++q)
    {
        if (q == SPIN && !spins) continue;
        for (int k = 2; k < levels; ++k)
        {
            double order = richardson_order(COMPONENTS, result[k - 2].value[q], result[k - 1].value[q], result[k].value[q]);
            sheet_absolute(sheet, order, 2.0, 0.1, "order of %s, dt = T/%d, T/%d, T/%d", quantity_names[q], first_steps << (k - 2),
                           first_steps << (k - 1), first_steps << k);
        }
    }
}

// ---- states ----

static pls_status follow_velocity(void *context, const pls_state_point *at, const double *values, double *rate)
{
    (void)context;
    rate[0] = -(values[0] - 1.0) + 0.1 * at->velocity.x + 0.05 * at->position.y;
    return PLS_OK;
}

static pls_status follow_first_state(void *context, const pls_state_point *at, const double *values, double *rate)
{
    (void)context;
    rate[0] = cos(3.0 * at->time) - values[0] * values[0] + at->all[0];
    return PLS_OK;
}

static pls_status stiffness_of_state(void *context, double time, const double *states, double *value)
{
    (void)context;
    (void)time;
    *value = 400.0 * (1.0 + 0.2 * states[1]);
    return PLS_OK;
}

typedef struct order_states
{
    pls_state_id scale, world;
} order_states;

/// The first drives the scale of `body`, the second the stiffness kn of the only law.
static order_states add_states(const verify_scene *scene, pls_body_id body)
{
    order_states states;
    pls_state_def def = pls_default_state_def();
    def = (pls_state_def){.name = "size", .body = body, .components = 1, .initial = {1.0}, .target = PLS_STATE_SCALE, .cookie = def.cookie};
    def.keep_density = scene->dimension == 2; // discs grow, spheres swell: mass changes or only inertia
    def.rate = follow_velocity;
    MUST(pls_world_add_state(scene->world, &def, &states.scale));
    def = (pls_state_def){.name = "warmth", .components = 1, .initial = {0.5}, .target = PLS_STATE_FREE, .cookie = def.cookie};
    def.rate = follow_first_state;
    MUST(pls_world_add_state(scene->world, &def, &states.world));
    MUST(pls_world_bind_law_parameter(scene->world, scene->grain, scene->grain, "kn", stiffness_of_state, NULL, NULL));
    return states;
}

static void get_states(const verify_scene *scene, order_states states, double *out)
{
    MUST(pls_state_get(scene->world, states.scale, &out[0]));
    MUST(pls_state_get(scene->world, states.world, &out[1]));
}

static const verify_value sticking[] = {{"kn", 400.0}, {"ks", 300.0}, {"cn", 4.0}, {"cs", 3.0}, {"friction", 100.0}, {NULL, 0.0}};

// ---- sphere on a plane ----

static void push_sideways(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)position;
    (void)velocity;
    (void)body;
    *force = pls_vec(3.0 * sin(3.0 * time), 2.0 * cos(2.0 * time), 0.0);
    *torque = pls_vec(0.0, 0.3 * time, 0.5 * cos(time));
}

static order_result run_sphere_on_plane(double dt, int steps)
{
    static const verify_field push = {push_sideways, NULL};
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(&def, "viscoelastic", sticking);
    pls_body_def ball = verify_ball_def(&scene, 1.0, 1.0, pls_vec(0, 0, 0.97), pls_vec(0.1, 0, 0.05));
    ball.angular_velocity = pls_vec(0.5, -0.3, 2.0);
    pls_body_id id = verify_add(&scene, &ball);
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -10.0)));
    verify_add_field(scene.world, &push);
    order_states states = add_states(&scene, id);
    MUST(pls_world_run(scene.world, (uint64_t)steps));
    order_result r = {0};
    pls_body_motion m = verify_motion(scene.world, id);
    put_vector(r.value[POSITION], m.position);
    put_vector(r.value[VELOCITY], m.velocity);
    put_vector(r.value[SPIN], m.angular_velocity);
    get_states(&scene, states, r.value[STATE]);
    verify_close(&scene);
    return r;
}

void case_order_sphere_on_plane(verify_sheet *sheet) { compare_steps(sheet, run_sphere_on_plane, 1.0, 400, true); }

// ---- two spheres pressed together ----

static void press_along_x(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)velocity;
    double sign = body == 0 ? 1.0 : -1.0;
    *force = pls_vec(-12.0 * position.x, sign * 2.0 * sin(4.0 * time) - 5.0 * position.y, sign * cos(3.0 * time) - 5.0 * position.z);
    *torque = pls_vec(0.4 * cos(2.0 * time), 0.0, sign * 0.2 * sin(time));
}

static order_result run_two_spheres(double dt, int steps)
{
    static const verify_field press = {press_along_x, NULL};
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(&def, "viscoelastic", sticking);
    pls_body_def one = verify_ball_def(&scene, 1.0, 1.0, pls_vec(-0.98, 0, 0), pls_vec(0, 0.1, 0));
    pls_body_def two = verify_ball_def(&scene, 1.2, 2.0, pls_vec(1.17, 0, 0), pls_vec(0, 0, -0.1));
    one.angular_velocity = pls_vec(1.0, 0.2, -0.3);
    two.angular_velocity = pls_vec(-0.5, 0.3, 0.1);
    pls_body_id a = verify_add(&scene, &one), b = verify_add(&scene, &two);
    verify_add_field(scene.world, &press);
    order_states states = add_states(&scene, a);
    MUST(pls_world_run(scene.world, (uint64_t)steps));
    order_result r = {0};
    pls_body_motion m = verify_motion(scene.world, a), n = verify_motion(scene.world, b);
    put_vector(r.value[POSITION], m.position);
    put_vector(r.value[POSITION] + 3, n.position);
    put_vector(r.value[VELOCITY], m.velocity);
    put_vector(r.value[VELOCITY] + 3, n.velocity);
    put_vector(r.value[SPIN], m.angular_velocity);
    put_vector(r.value[SPIN] + 3, n.angular_velocity);
    get_states(&scene, states, r.value[STATE]);
    verify_close(&scene);
    return r;
}

void case_order_two_spheres(verify_sheet *sheet) { compare_steps(sheet, run_two_spheres, 1.0, 400, true); }

// ---- 2D ----

static void push_disc(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)position;
    (void)velocity;
    (void)body;
    *force = pls_vec(3.0 * sin(3.0 * time), 0.0, 0.0);
    *torque = pls_vec(0.0, 0.0, 0.5 * cos(2.0 * time));
}

static order_result run_disc(double dt, int steps)
{
    static const verify_field push = {push_disc, NULL};
    pls_world_def def = pls_default_world_def(2);
    def.dt = dt;
    verify_scene scene = verify_open(&def, "viscoelastic", sticking);
    pls_body_def disc = verify_ball_def(&scene, 1.0, 1.0, pls_vec(0, 0.97, 0), pls_vec(0.1, 0.05, 0));
    disc.angular_velocity = pls_vec(0, 0, 1.0);
    pls_body_id id = verify_add(&scene, &disc);
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 1, 0));
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, -10.0, 0)));
    verify_add_field(scene.world, &push);
    order_states states = add_states(&scene, id);
    MUST(pls_world_run(scene.world, (uint64_t)steps));
    order_result r = {0};
    pls_body_motion m = verify_motion(scene.world, id);
    put_vector(r.value[POSITION], m.position);
    put_vector(r.value[VELOCITY], m.velocity);
    put_vector(r.value[SPIN], m.angular_velocity);
    get_states(&scene, states, r.value[STATE]);
    verify_close(&scene);
    return r;
}

void case_order_disc(verify_sheet *sheet) { compare_steps(sheet, run_disc, 1.0, 800, true); }

// ---- the energy book ----

/// Largest error of kinetic + stored + potential + dissipated over one second, looked at 50 times.
static double energy_error(double dt, int steps)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(&def, "viscoelastic", sticking);
    pls_body_def ball = verify_ball_def(&scene, 1.0, 1.0, pls_vec(0, 0, 0.97), pls_vec(0.4, 0, 0.05));
    ball.angular_velocity = pls_vec(0.5, -0.3, 2.0);
    verify_add(&scene, &ball);
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    MUST(pls_world_add_gravity(scene.world, pls_vec(0.5, 0, -10.0)));
    MUST(pls_world_prepare(scene.world));
    double start = verify_total_energy(scene.world), error = 0.0;
    for (int k = 0; k < 50; ++k)
    {
        MUST(pls_world_run(scene.world, (uint64_t)(steps / 50)));
        error = fmax(error, fabs(verify_total_energy(scene.world) - start));
    }
    verify_close(&scene);
    return error;
}

void case_order_energy(verify_sheet *sheet)
{
    double dt[6], error[6];
    int levels = sheet->thorough ? 6 : 4;
    for (int k = 0; k < levels; ++k)
    {
        dt[k] = 1.0 / (400 << k);
        error[k] = energy_error(dt[k], 400 << k);
        sheet_point(sheet, "largest error of the energy book [J]", dt[k], error[k], NAN);
    }
    sheet_absolute(sheet, fitted_order(levels, dt, error), 2.0, 0.1, "order of the largest error of the energy book in 1 s");
}
