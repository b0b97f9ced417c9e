// cases_motion.c -- free fall, bouncing, and bodies whose motion is prescribed.
#include "verify/cases.h"

static const double pi = 3.14159265358979323846;
static const verify_value plain_law[] = {{"kn", 1e5}, {"ks", 1e5}, {"friction", 0.3}, {NULL, 0.0}};

void case_free_fall(verify_sheet *sheet)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 0.01;
    def.allow_unstable = true; // there is no contact
    verify_scene scene = verify_open(&def, "elastic", plain_law);
    pls_body_id id = verify_ball(&scene, 0.5, 2.0, pls_vec(1, 2, 3), pls_vec(0.5, -0.25, 4));
    pls_vec3 g = pls_vec(0.1, -9.81, -1.5);
    MUST(pls_world_add_gravity(scene.world, g));
    MUST(pls_world_run(scene.world, 1000));
    pls_body_motion m = verify_motion(scene.world, id);
    double t = 10.0;
    verify_close(&scene);
    sheet_relative(sheet, m.position.x, 1 + 0.5 * t + g.x * t * t / 2, 1e-12, "x after 10 s at dt = 0.01 s [m]");
    sheet_relative(sheet, m.position.y, 2 - 0.25 * t + g.y * t * t / 2, 1e-12, "y [m]");
    sheet_relative(sheet, m.position.z, 3 + 4 * t + g.z * t * t / 2, 1e-12, "z [m]");
    sheet_relative(sheet, m.velocity.y, -0.25 + g.y * t, 1e-12, "velocity y [m/s]");
}

void case_bouncing(verify_sheet *sheet)
{
    double g = 10.0, height = 0.5, kn = 1e6, dt = sheet->thorough ? 5e-6 : 2e-5;
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(&def, "elastic", (const verify_value[]){{"kn", kn}, {"ks", 1e5}, {"friction", 0.3}, {NULL, 0.0}});
    pls_body_id id = verify_ball(&scene, 1.0, 1.0, pls_vec(0, 0, 1.0 + height), pls_vec(0, 0, 0));
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -g)));
    // In contact the overlap obeys delta'' = g - w^2 delta from delta = 0 with speed v: half a period and the two arcs beyond it.
    double v = sqrt(2.0 * g * height), omega = sqrt(kn), period = 2.0 * v / g + (pi + 2.0 * atan(g / (omega * v))) / omega;
    double before = 0.0, apex_time = 0.0, apex_height = 0.0;
    int apexes = 0, wanted = sheet->thorough ? 10 : 4;
    while (apexes < wanted && pls_world_time(scene.world) < 20.0)
    {
        MUST(pls_step(scene.world));
        pls_body_motion m = verify_motion(scene.world, id);
        if (before > 0.0 && m.velocity.z <= 0.0 && m.position.z > 1.0)
        {
            ++apexes;
            apex_time = pls_world_time(scene.world) + m.velocity.z / g;
            apex_height = m.position.z - 1.0 + m.velocity.z * m.velocity.z / (2.0 * g);
        }
        before = m.velocity.z;
    }
    verify_close(&scene);
    sheet_relative(sheet, apex_time / wanted, period, 2e-5, "time between apexes, mean of %d [s]", wanted);
    sheet_relative(sheet, apex_height, height, 2e-4, "height of apex %d [m]", wanted);
}

void case_driven(verify_sheet *sheet)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 0.001;
    verify_scene scene = verify_open(&def, "elastic", plain_law);
    pls_body_def ball = verify_ball_def(&scene, 1.0, 1.0, pls_vec(1, 2, 3), pls_vec(0, 0, 0));
    ball.motion.axes = PLS_AXIS_ALL;
    ball.motion.velocity = pls_vec(0.3, -0.2, 0.1);
    pls_body_id mover = verify_add(&scene, &ball);
    ball.position = pls_vec(10, 0, 0);
    ball.motion = (pls_motion_def){.axes = PLS_AXIS_ALL, .angular_velocity = {0.0, 0.0, 1.5}};
    pls_body_id spinner = verify_add(&scene, &ball);
    ball.position = pls_vec(2, -10, 0);
    ball.motion = (pls_motion_def){.axes = PLS_AXIS_ALL, .angular_velocity = {0.0, 0.0, 0.5}, .about = true, .centre = {0, -10, 0}};
    pls_body_id orbiter = verify_add(&scene, &ball);
    pls_body_id wall = verify_wall(&scene, pls_vec(0, 0, -50), pls_vec(0, 0, 1));
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -9.81)));
    MUST(pls_world_run(scene.world, 2000));
    pls_body_motion m = verify_motion(scene.world, mover), s = verify_motion(scene.world, spinner), o = verify_motion(scene.world, orbiter),
                    w = verify_motion(scene.world, wall);
    verify_close(&scene);
    sheet_below(sheet, pls_length(pls_sub(m.position, pls_vec(1.6, 1.6, 3.2))), 1e-12,
                "constant velocity under gravity: position after 2 s [m]");
    sheet_below(sheet, pls_length(pls_sub(m.velocity, pls_vec(0.3, -0.2, 0.1))), 0.0, "constant velocity: velocity [m/s]");
    sheet_relative(sheet, 2.0 * atan2(s.orientation.z, s.orientation.w), 3.0, 1e-11, "constant spin: angle after 2 s [rad]");
    sheet_below(sheet, pls_length(pls_sub(s.position, pls_vec(10, 0, 0))), 0.0, "constant spin: the centre stays [m]");
    sheet_below(sheet, pls_length(pls_sub(o.position, pls_vec(2 * cos(1.0), -10 + 2 * sin(1.0), 0))), 1e-6,
                "rotation about a point: position after 1 rad [m]");
    sheet_relative(sheet, 2.0 * atan2(o.orientation.z, o.orientation.w), 1.0, 1e-11, "rotation about a point: angle [rad]");
    sheet_relative(sheet, hypot(o.position.x, o.position.y + 10.0), 2.0, 1e-11, "rotation about a point: distance from it [m]");
    sheet_below(sheet, pls_length(pls_sub(w.position, pls_vec(0, 0, -50))), 0.0, "fixed plane: moved by [m]");
}

void case_locks(verify_sheet *sheet)
{
    // A ball that may fall but not leave its vertical line nor turn about y, pushed by a slope-like gravity and by the plane's friction.
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-3;
    verify_scene scene = verify_open(&def, "elastic", plain_law);
    pls_body_def ball = verify_ball_def(&scene, 1.0, 1.0, pls_vec(1, 2, 100), pls_vec(0, 0.5, 0));
    ball.motion.axes = PLS_AXIS_X | PLS_AXIS_RY;
    ball.motion.angular_velocity = pls_vec(0, 0.25, 0);
    ball.angular_velocity = pls_vec(0.5, 0, 0);
    pls_body_id id = verify_add(&scene, &ball);
    MUST(pls_world_add_gravity(scene.world, pls_vec(3.0, 1.0, -2.0)));
    MUST(pls_world_run(scene.world, 1000));
    pls_body_motion m = verify_motion(scene.world, id);
    verify_close(&scene);
    sheet_below(sheet, fabs(m.position.x - 1.0), 0.0, "locked x: moved by [m]");
    sheet_below(sheet, fabs(m.velocity.x), 0.0, "locked x: velocity [m/s]");
    sheet_relative(sheet, m.position.y, 2 + 0.5 + 0.5, 1e-12, "free y falls [m]");
    sheet_relative(sheet, m.position.z, 100 - 1.0, 1e-12, "free z falls [m]");
    sheet_absolute(sheet, m.angular_velocity.y, 0.25, 0.0, "driven spin about y [rad/s]");
}

static pls_status swing(void *context, double time, pls_vec3 *velocity, pls_vec3 *angular_velocity)
{
    (void)context;
    *velocity = pls_vec(cos(3.0 * time), exp(-time), 0.0);
    *angular_velocity = pls_vec(0.0, 0.0, cos(2.0 * time));
    return PLS_OK;
}

void case_motion_function(verify_sheet *sheet)
{
    double dt[5], place[5], turn[5];
    int levels = sheet->thorough ? 5 : 3;
    for (int k = 0; k < levels; ++k)
    {
        pls_world_def def = pls_default_world_def(3);
        dt[k] = def.dt = 0.01 / (1 << k);
        def.allow_unstable = true; // there is no contact
        verify_scene scene = verify_open(&def, "elastic", plain_law);
        pls_body_def ball = verify_ball_def(&scene, 1.0, 1.0, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
        ball.motion = (pls_motion_def){.axes = PLS_AXIS_ALL, .function = swing};
        pls_body_id id = verify_add(&scene, &ball);
        MUST(pls_world_run(scene.world, (uint64_t)(200 << k)));
        pls_body_motion m = verify_motion(scene.world, id);
        verify_close(&scene);
        place[k] = pls_length(pls_sub(m.position, pls_vec(sin(6.0) / 3.0, 1.0 - exp(-2.0), 0)));
        turn[k] = fabs(2.0 * atan2(m.orientation.z, m.orientation.w) - sin(4.0) / 2.0);
        if (k == 0) sheet_below(sheet, pls_length(pls_sub(m.velocity, pls_vec(cos(6.0), exp(-2.0), 0))), 1e-12, "velocity after 2 s [m/s]");
    }
    sheet_absolute(sheet, fitted_order(levels, dt, place), 2.0, 0.1, "order of the position");
    sheet_absolute(sheet, fitted_order(levels, dt, turn), 2.0, 0.1, "order of the orientation");
}
