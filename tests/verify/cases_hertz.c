// cases_hertz.c -- Hertz-Mindlin contact from E and nu of the materials (Johnson, Contact Mechanics, sections 4.2, 7.2 and 11.4).
#include "verify/cases.h"

#include "step/contact_view.h"

#include <string.h>

static const double pi = 3.14159265358979323846;

typedef struct elastic_material
{
    double young, poisson;
} elastic_material;

static double effective_young(elastic_material a, elastic_material b)
{
    return 1.0 / ((1.0 - a.poisson * a.poisson) / a.young + (1.0 - b.poisson * b.poisson) / b.young);
}

static double effective_shear(elastic_material a, elastic_material b)
{
    double shear_a = a.young / (2.0 * (1.0 + a.poisson)), shear_b = b.young / (2.0 * (1.0 + b.poisson));
    return 1.0 / ((2.0 - a.poisson) / shear_a + (2.0 - b.poisson) / shear_b);
}

static const elastic_material soft = {1e6, 0.3}, hard = {5e6, 0.2};

/// A scene with a second material; `grain` is soft, `*other` hard, both densities 1.
static verify_scene open_hertz(double dt, double restitution, pls_material_id *other)
{
    const verify_value values[] = {{"friction", 0.5}, {"restitution", restitution}, {NULL, 0.0}};
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(&def, NULL, NULL);
    MUST(pls_world_set_material_value(scene.world, scene.grain, "young_modulus", soft.young));
    MUST(pls_world_set_material_value(scene.world, scene.grain, "poisson_ratio", soft.poisson));
    pls_material_def material = pls_default_material_def();
    strcpy(material.name, "hard");
    material.values = (pls_material_values){1.0, hard.young, hard.poisson};
    MUST(pls_world_add_material(scene.world, &material, other));
    verify_set_law(scene.world, scene.grain, scene.grain, "hertz_mindlin", values);
    verify_set_law(scene.world, scene.grain, *other, "hertz_mindlin", values);
    return scene;
}

void case_hertz_force(verify_sheet *sheet)
{
    pls_material_id other;
    for (int k = 0; k < 3; ++k)
    {
        double overlap = 1e-4 * pow(10.0, k), r1 = 0.5, r2 = 0.8;
        verify_scene scene = open_hertz(1e-6, 1.0, &other);
        pls_body_id id = verify_ball(&scene, r1, 1.0, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
        pls_body_def ball = verify_ball_def(&scene, r2, 2.0, pls_vec(r1 + r2 - overlap, 0, 0), pls_vec(0, 0, 0));
        ball.material = other;
        verify_add(&scene, &ball);
        MUST(pls_world_prepare(scene.world));
        double radius = r1 * r2 / (r1 + r2), exact = -4.0 / 3.0 * effective_young(soft, hard) * sqrt(radius) * pow(overlap, 1.5);
        sheet_relative(sheet, verify_motion(scene.world, id).force.x, exact, 1e-11,
                       "two materials, two radii, overlap %g m: 4/3 E* sqrt(R) delta^1.5 [N]", overlap);
        double stored = verify_figures(scene.world).energy_normal;
        sheet_relative(sheet, stored, -0.4 * exact * overlap, 1e-11, "energy stored at overlap %g m: 2/5 F delta [J]", overlap);
        verify_close(&scene);
    }
    // On a plane, settled under its weight.
    double radius = 1.0, weight = 50.0, exact = pow(weight * 0.75 / (effective_young(soft, soft) * sqrt(radius)), 2.0 / 3.0);
    verify_scene scene = open_hertz(2e-5, 1.0, &other);
    pls_body_id id = verify_ball(&scene, radius, 1.0, pls_vec(0, 0, radius - exact), pls_vec(0, 0, 0));
    verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -weight)));
    MUST(pls_world_run(scene.world, 2000));
    sheet_relative(sheet, radius - verify_motion(scene.world, id).position.z, exact, 1e-10, "static overlap on a plane under 50 N [m]");
    verify_close(&scene);
}

/// Hertz impact of mass m_eff, radius R, speed v: largest overlap.
static double hertz_depth(double m_eff, double radius, double young, double v)
{
    return pow(15.0 / 16.0 * m_eff * v * v / (young * sqrt(radius)), 0.4);
}

typedef struct hertz_impact
{
    double duration, depth, speed_after;
} hertz_impact;

/// Two equal spheres of the soft material, radius 0.5 and mass 1, meet at speed v.
static hertz_impact simulate_hertz(double v, double dt, double phase, double restitution)
{
    pls_material_id other;
    hertz_impact result = {0};
    double r = 0.5, gap = (1.0 + phase) * v * dt;
    verify_scene scene = open_hertz(dt, restitution, &other);
    pls_body_id a = verify_ball(&scene, r, 1.0, pls_vec(0, 0, 0), pls_vec(v, 0, 0));
    pls_body_id b = verify_ball(&scene, r, 1.0, pls_vec(2.0 * r + gap, 0, 0), pls_vec(0, 0, 0));
    pls_body_motion m = {0}, n = {0};
    bool touched = false;
    for (long step = 0; step < 1000000; ++step)
    {
        MUST(pls_step(scene.world));
        bool touches = pls_world_contact_count(scene.world) > 0;
        m = verify_motion(scene.world, a), n = verify_motion(scene.world, b);
        result.depth = fmax(result.depth, 2.0 * r - (n.position.x - m.position.x));
        if (touched && !touches) break;
        touched = touched || touches;
    }
    result.speed_after = n.velocity.x - m.velocity.x;
    result.duration = pls_world_time(scene.world) - (n.position.x - m.position.x - 2.0 * r) / result.speed_after - gap / v;
    verify_close(&scene);
    return result;
}

void case_hertz_collision(verify_sheet *sheet)
{
    double radius = 0.25, m_eff = 0.5, young = effective_young(soft, soft);
    // 2 times the integral of (1 - x^2.5)^-1/2 over 0..1, by the Gamma function.
    double constant = 2.0 * 0.4 * tgamma(0.4) * sqrt(pi) / tgamma(0.9);
    for (int k = 0; k < 3; ++k)
    {
        double v = 0.01 * pow(10.0, k), depth = hertz_depth(m_eff, radius, young, v), duration = constant * depth / v;
        hertz_impact impact = simulate_hertz(v, duration / (sheet->thorough ? 20000 : 2000), 0.5, 1.0);
        sheet_relative(sheet, impact.duration, duration, 1e-5, "v = %g m/s: collision time 2.943 delta_max/v [s]", v);
        sheet_relative(sheet, impact.duration, 2.87 * pow(m_eff * m_eff / (radius * young * young * v), 0.2), 2e-3,
                       "v = %g m/s: collision time 2.87 (m^2/(R E*^2 v))^(1/5) [s]", v);
        sheet_relative(sheet, impact.depth, depth, 1e-5, "v = %g m/s: largest overlap [m]", v);
        sheet_relative(sheet, impact.speed_after, v, 1e-5, "v = %g m/s: speed after [m/s]", v);
    }
    for (int k = 0; k < 2; ++k)
    {
        double v = k == 0 ? 0.01 : 1.0, duration = constant * hertz_depth(m_eff, radius, young, v) / v;
        sheet_relative(sheet, simulate_hertz(v, duration / 2000, 0.5, 0.6).speed_after / v, 0.6, 1e-4,
                       "v = %g m/s: restitution e at any speed (Antypov and Elliott 2011)", v);
    }
}

void case_mindlin(verify_sheet *sheet)
{
    // Two spheres at a fixed overlap, one moved sideways by a distance far below sliding. The other may turn about the normal, because forces between two
    // bodies that nothing can move are not looked for.
    pls_material_id other;
    double r1 = 0.5, r2 = 0.8, radius = r1 * r2 / (r1 + r2), overlap = 1e-3, shift = 1e-9, dt = 1e-6;
    double exact = 8.0 * effective_shear(soft, hard) * sqrt(radius * overlap);
    verify_scene scene = open_hertz(dt, 1.0, &other);
    pls_body_def ball = verify_ball_def(&scene, r1, 1.0, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    ball.motion.axes = PLS_AXIS_ALL;
    ball.motion.velocity = pls_vec(0, shift / (100.0 * dt), 0);
    pls_body_id id = verify_add(&scene, &ball);
    ball = verify_ball_def(&scene, r2, 1.0, pls_vec(r1 + r2 - overlap, 0, 0), pls_vec(0, 0, 0));
    ball.material = other;
    ball.motion.axes = PLS_AXIS_ALL & ~(unsigned)PLS_AXIS_RX;
    verify_add(&scene, &ball);
    MUST(pls_world_run(scene.world, 100));
    // Moving sideways by s also tilts the normal by s/d, which turns a part of the normal force towards the way it came from.
    pls_body_motion m = verify_motion(scene.world, id);
    double tilted = fabs(m.force.x) / (r1 + r2 - overlap);
    sheet_relative(sheet, -m.force.y / shift + tilted, exact, 1e-6, "force over displacement: 8 G* sqrt(R delta) [N/m]");
    pls_contact_view view = {0};
    MUST(pls_contact_view_make(scene.world, &view));
    sheet_absolute(sheet, (double)view.count, 1.0, 0.0, "contacts");
    if (view.count == 1)
    {
        sheet_relative(sheet, view.entry[0].stiffness.kt, exact, 1e-6, "reported tangential stiffness [N/m]");
        sheet_relative(sheet, view.entry[0].stiffness.kn, 2.0 * effective_young(soft, hard) * sqrt(radius * overlap), 1e-6,
                       "reported normal stiffness 2 E* sqrt(R delta) [N/m]");
    }
    pls_contact_view_free(&view);
    verify_close(&scene);
}
