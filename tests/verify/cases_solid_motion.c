// cases_solid_motion.c -- bodies that roll, settle and tumble: cylinder, capsule, a compound, ellipsoid, and a box about its middle axis.
#include "verify/cases.h"
#include "support/numbers.h"

static const double pi = 3.14159265358979323846;

// ---- rolling --------------------------------------------------------------------------------------------------------------------------------------------

static const double radius = 0.5, length = 0.8;

/// Moment of inertia about the axis over m r^2.
static double capsule_moment(void)
{
    const double tube = pi * radius * radius * length, balls = 4.0 / 3.0 * pi * radius * radius * radius;
    return (0.5 * tube + 0.4 * balls) / (tube + balls);
}

typedef struct roller
{
    const char *name;
    double moment; ///< over m r^2
    double volume; ///< [m^3]
    double sinks;  ///< by this times m g/kn: less for more places of touch; a cylinder's side pushes with kn (6/7)^2 of its depth
    pls_quat turn; ///< that lays its axis along y
} roller;

static pls_shape_id add_roller(const verify_scene *scene, int which)
{
    if (which == 0) return verify_add_shape(scene, "cylinder", NUMBERS(radius, length, 0.0));
    if (which == 1) return verify_add_shape(scene, "capsule", NUMBERS(radius, length));
    return verify_add_dumbbell(scene, radius, 3.0 * radius);
}

void case_rolling_solids(verify_sheet *sheet)
{
    const double half_turn = sqrt(0.5), g = 10.0, slope = 0.3, kn = 1e6, dt = 1e-4;
    const double ball = 4.0 / 3.0 * pi * radius * radius * radius, tube = pi * radius * radius * length;
    const pls_quat from_z = {half_turn, -half_turn, 0.0, 0.0}, from_x = {half_turn, 0.0, 0.0, half_turn};
    const roller all[3] = {{"cylinder", 0.5, tube, 49.0 / 36.0, from_z},
                           {"capsule", capsule_moment(), tube + ball, 1.0, from_x},
                           {"compound of two spheres", 0.4, 2.0 * ball, 0.5, from_x}};
    const int steps = sheet->thorough ? 100000 : 10000;
    for (int k = 0; k < 3; ++k)
    {
        pls_world_def def = pls_default_world_def(3);
        def.dt = dt;
        def.coordination = 2;
        verify_scene scene =
            verify_open(&def, "viscoelastic",
                        (const verify_value[]){{"kn", kn}, {"ks", kn}, {"cn", 200.0}, {"cs", 50.0}, {"friction", 0.4}, {NULL, 0.0}});
        verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
        MUST(pls_world_add_gravity(scene.world, pls_vec(g * sin(slope), 0, -g * cos(slope))));
        const double overlap = all[k].volume * g * cos(slope) / kn * all[k].sinks, lever = 1.0 - 0.5 * overlap / radius;
        pls_body_def body = verify_body_def(&scene, add_roller(&scene, k), pls_vec(0, 0, radius - overlap));
        body.orientation = all[k].turn;
        pls_body_id id = verify_add(&scene, &body);
        MUST(pls_world_run(scene.world, 10000));
        const double early = verify_motion(scene.world, id).velocity.x;
        MUST(pls_world_run(scene.world, (uint64_t)steps));
        const pls_body_motion m = verify_motion(scene.world, id);
        const double acceleration = (m.velocity.x - early) / (dt * steps), ideal = g * sin(slope) / (1.0 + all[k].moment);
        sheet_relative(sheet, acceleration, g * sin(slope) / (1.0 + all[k].moment / (lever * lever)), 1e-9,
                       "%s: acceleration down a slope of 0.3 rad, lever r - delta/2 [m/s^2]", all[k].name);
        sheet_relative(sheet, acceleration, ideal, 1e-4, "%s: acceleration, %.4g g sin(alpha) [m/s^2]", all[k].name,
                       1.0 / (1.0 + all[k].moment));
        const double astray =
            fabs(m.position.y / m.position.x) + (fabs(m.angular_velocity.x) + fabs(m.angular_velocity.z)) / m.angular_velocity.y;
        sheet_below(sheet, astray, 1e-9, "%s: it rolls straight, goes and turns astray by, of its way and spin", all[k].name);
        verify_close(&scene);
    }
}

// ---- an ellipsoid finds its minimum ---------------------------------------------------------------------------------------------------------------------

static void drag_force(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)time, (void)position, (void)body, (void)torque;
    *force = pls_scale(velocity, -2.0);
}

/// Damped by drag and by friction that is a dashpot alone (ks = 0): the contact point slips wherever the body rocks. 2D: an ellipse. What is left is a spin about the vertical, which a
/// contact at a point does not resist.
void case_ellipsoid_settles(verify_sheet *sheet)
{
    const pls_vec3 half = {0.6, 0.5, 0.3};
    for (int dimension = 3; dimension >= 2; --dimension)
    {
        static const verify_field drag = {drag_force, NULL};
        const double g = 10.0, kn = 1e5, dt = 4e-4;
        const double least = dimension == 3 ? half.z : half.y,
                     mass = dimension == 3 ? 4.0 / 3.0 * pi * half.x * half.y * half.z : pi * half.x * half.y;
        const pls_vec3 up = dimension == 3 ? pls_vec(0, 0, 1) : pls_vec(0, 1, 0);
        pls_world_def def = pls_default_world_def(dimension);
        def.dt = dt;
        def.coordination = 1;
        verify_scene scene =
            verify_open(&def, "viscoelastic",
                        (const verify_value[]){{"kn", kn}, {"ks", 0.0}, {"cn", 100.0}, {"cs", 10.0}, {"friction", 10.0}, {NULL, 0.0}});
        verify_wall(&scene, pls_vec(0, 0, 0), up);
        MUST(pls_world_add_gravity(scene.world, pls_scale(up, -g)));
        pls_body_def body =
            verify_body_def(&scene, verify_add_shape(&scene, "ellipsoid", NUMBERS(half.x, half.y, half.z, 0.0)), pls_scale(up, 0.7));
        body.orientation = pls_quat_unit(dimension == 3 ? (pls_quat){1.0, 0.2, 0.25, 0.1} : (pls_quat){1.0, 0.0, 0.0, 0.3});
        pls_body_id id = verify_add(&scene, &body);
        verify_add_field(scene.world, &drag);
        MUST(pls_world_run(scene.world, sheet->thorough ? 400000 : 80000));
        const pls_body_motion m = verify_motion(scene.world, id);
        const pls_vec3 axis = pls_rotate(m.orientation, up);
        sheet_below(sheet, pls_length(pls_cross(axis, up)), 1e-6, "%dD: angle of the shortest axis with the vertical [rad]", dimension);
        sheet_absolute(sheet, pls_dot(m.position, up), least - mass * g / kn, 1e-9, "%dD: height, half axis - m g/kn [m]", dimension);
        sheet_below(sheet,
                    pls_length(m.velocity) + pls_length(pls_sub(m.angular_velocity, pls_scale(up, pls_dot(m.angular_velocity, up)))) +
                        (dimension == 2 ? fabs(m.angular_velocity.z) : 0.0),
                    1e-6, "%dD: it rests, but for spin about the vertical [m/s], [rad/s]", dimension);
        verify_close(&scene);
    }
}
