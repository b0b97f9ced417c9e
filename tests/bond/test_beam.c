// test_beam.c -- beams: the Euler-Bernoulli element for small motions, an energy for large ones, and structures with known answers.
#include "support/verify.h"

#include "base/random.h"
#include "bond/bond_set.h"
#include "step/bonds.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

static const double pi = 3.14159265358979323846;
static const double radius = 0.01, young = 1e8, poisson = 0.25; ///< of all beams [m], [Pa]

static const pls_bond_ops *beam_law(void)
{
    const pls_bond_ops *const *law = pls_builtin_bonds();
    while (*law && strcmp((*law)->name, "beam") != 0) ++law;
    assert_non_null(*law);
    return *law;
}

static double bending(void) { return young * pi * pow(radius, 4) / 4.0; }
static double axial(void) { return young * pi * radius * radius; }
static double torsion(void) { return young / (2.0 * (1.0 + poisson)) * pi * pow(radius, 4) / 2.0; }

static verify_scene open_scene(int dimension, double dt)
{
    pls_world_def def = pls_default_world_def(dimension);
    def.dt = dt;
    def.coordination = 0;
    const verify_value law[] = {{"kn", 1.0}, {NULL, 0.0}};
    verify_scene scene = verify_open(&def, "elastic", law);
    MUST(pls_world_set_material_value(scene.world, scene.grain, "young_modulus", young));
    MUST(pls_world_set_material_value(scene.world, scene.grain, "poisson_ratio", poisson));
    return scene;
}

/// Beams of strengths (0: they hold) between all bodies within the horizon.
static pls_bonds_id join(const verify_scene *scene, double horizon, double tensile, double shear)
{
    pls_bonds_def def = pls_default_bonds_def();
    pls_bonds_id id;
    const double values[] = {radius, tensile, shear};
    snprintf(def.name, sizeof def.name, "beams");
    def.ops = beam_law();
    def.values = values;
    def.horizon = horizon;
    MUST(pls_world_add_bonds(scene->world, &def, &id));
    return id;
}

static void place(pls_world *world, pls_body_id id, pls_vec3 x, pls_quat q)
{
    const uint32_t row = pls_body_row(world, id);
    pls_body_place *p = &world->bodies.place[row];
    p->x = x.x, p->y = x.y, p->z = x.z;
    world->bodies.orientation[row] = (pls_body_orientation){q.w, q.x, q.y, q.z};
}

static void act(pls_world *world)
{
    MUST(pls_bonds_place(world, 0.0, 0, 1));
    pls_bonds_placed(world);
    pls_bonds_act(world, 0, 1);
}

static pls_vec3 force_on(const pls_world *world, pls_body_id id)
{
    const double *f = world->bond[0].force[world->bond[0].point_of[id.index1 - 1]];
    return pls_vec(f[0], f[1], f[2]);
}

static pls_vec3 torque_on(const pls_world *world, pls_body_id id)
{
    const double *t = world->bond[0].torque[world->bond[0].point_of[id.index1 - 1]];
    return pls_vec(t[0], t[1], t[2]);
}

static pls_quat about(pls_vec3 axis, double angle)
{
    const pls_vec3 n = pls_scale(pls_unit(axis), sin(angle / 2.0));
    return (pls_quat){cos(angle / 2.0), n.x, n.y, n.z};
}

static void near_vec(pls_vec3 a, pls_vec3 b, double tolerance)
{
    if (pls_length(pls_sub(a, b)) > tolerance) fail_msg("(%g, %g, %g) instead of (%g, %g, %g)", a.x, a.y, a.z, b.x, b.y, b.z);
}

/// The element's stiffness, column by column: THEORY 6 with the chord turned by the displacements.
static void small_motions_meet_the_beam_element(void **state)
{
    (void)state;
    const double l = 0.5, tiny = 1e-6, EI = bending();
    verify_scene scene = open_scene(3, 1e-6);
    const pls_vec3 ax = pls_unit(pls_vec(2, -1, 0.5)), ay = pls_unit(pls_cross(ax, pls_vec(0, 0.3, 1))), az = pls_cross(ax, ay);
    const pls_vec3 xa = pls_vec(0.1, 0.2, -0.3), xb = pls_add(xa, pls_scale(ax, l));
    const pls_quat one = pls_quat_identity();
    pls_body_id a = verify_ball(&scene, 0.05, 1.0, xa, pls_vec(0, 0, 0)), b = verify_ball(&scene, 0.05, 2.0, xb, pls_vec(0, 0, 0));
    join(&scene, 0.6, 0.0, 0.0);
    pls_world *w = scene.world;

    act(w);
    near_vec(force_on(w, a), pls_vec(0, 0, 0), 1e-12 * axial());
    near_vec(torque_on(w, b), pls_vec(0, 0, 0), 1e-12 * EI);

    place(w, b, pls_add(xb, pls_scale(ax, tiny)), one), act(w); // stretched
    near_vec(force_on(w, a), pls_scale(ax, axial() * tiny / l), 1e-4 * axial() * tiny / l);
    near_vec(torque_on(w, a), pls_vec(0, 0, 0), 1e-3 * EI * tiny / l);

    place(w, b, pls_add(xb, pls_scale(ay, tiny)), one), act(w); // across: 12 EI/l^3 and 6 EI/l^2
    near_vec(force_on(w, a), pls_scale(ay, 12.0 * EI * tiny / pow(l, 3)), 2e-2 * EI * tiny / pow(l, 3));
    near_vec(torque_on(w, a), pls_scale(az, 6.0 * EI * tiny / pow(l, 2)), 1e-4 * 6.0 * EI * tiny / pow(l, 2));
    near_vec(torque_on(w, b), pls_scale(az, 6.0 * EI * tiny / pow(l, 2)), 1e-4 * 6.0 * EI * tiny / pow(l, 2));

    place(w, b, xb, about(az, tiny)), act(w); // bent at one end: 4 EI/l, 2 EI/l, 6 EI/l^2
    near_vec(torque_on(w, b), pls_scale(az, -4.0 * EI * tiny / l), 1e-4 * 4.0 * EI * tiny / l);
    near_vec(torque_on(w, a), pls_scale(az, -2.0 * EI * tiny / l), 1e-4 * 4.0 * EI * tiny / l);
    near_vec(force_on(w, b), pls_scale(ay, 6.0 * EI * tiny / pow(l, 2)), 1e-4 * 6.0 * EI * tiny / pow(l, 2));
    near_vec(force_on(w, a), pls_scale(force_on(w, b), -1.0), 0.0);

    place(w, b, xb, about(ax, tiny)), act(w); // twisted: GJ/l
    near_vec(torque_on(w, b), pls_scale(ax, -torsion() * tiny / l), 1e-4 * torsion() * tiny / l);
    near_vec(torque_on(w, a), pls_scale(ax, torsion() * tiny / l), 1e-4 * torsion() * tiny / l);
    verify_close(&scene);
}

/// Nine bodies joined all with all, clamped, twisted and bent; then the whole turned: forces turn with it. Numbered the other way about they are the same.
static void forces_turn_with_the_whole_whatever_the_numbers(void **state)
{
    (void)state;
    enum { COUNT = 9 };
    pls_vec3 force[3][COUNT], torque[3][COUNT];
    const pls_quat whole = about(pls_vec(1, 2, -1), 1.9), none = pls_quat_identity();
    for (int run = 0; run < 3; ++run)
    {
        verify_scene scene = open_scene(3, 1e-6);
        pls_body_id id[COUNT];
        pls_vec3 X[COUNT];
        for (int k = 0; k < COUNT; ++k) X[k] = pls_vec(0.1 * (k % 3) + 0.01 * k, 0.1 * (k / 3) - 0.003 * k * k, 0.02 * (k % 4));
        for (int n = 0; n < COUNT; ++n)
        {
            const int k = run == 2 ? COUNT - 1 - n : n;
            id[k] = verify_ball(&scene, 0.01, 1.0, X[k], pls_vec(0, 0, 0));
        }
        join(&scene, 0.25, 0.0, 0.0);
        const pls_quat turn = run == 1 ? whole : none;
        for (int moved = 0; moved < 2; ++moved) // turned alone: nothing; bent besides: forces
        {
            for (int k = 0; k < COUNT; ++k)
            {
                const pls_vec3 u = moved ? pls_vec(0.01 * sin(3.0 * k), 0.02 * cos(k), 0.01 * sin(k * k)) : pls_vec(0, 0, 0);
                const pls_quat q = moved ? about(pls_vec(sin(k), cos(2.0 * k), 0.5), 0.3 * sin(5.0 * k)) : none;
                place(scene.world, id[k], pls_rotate(turn, pls_add(X[k], u)), pls_quat_multiply(turn, q));
            }
            act(scene.world);
            for (int k = 0; k < COUNT && !moved; ++k)
            {
                near_vec(force_on(scene.world, id[k]), pls_vec(0, 0, 0), 1e-10 * axial());
                near_vec(torque_on(scene.world, id[k]), pls_vec(0, 0, 0), 1e-10 * axial() * 0.1);
            }
        }
        for (int k = 0; k < COUNT; ++k)
        {
            force[run][k] = pls_rotate_back(turn, force_on(scene.world, id[k]));
            torque[run][k] = pls_rotate_back(turn, torque_on(scene.world, id[k]));
            near_vec(force[run][k], force[0][k], 1e-11 * axial());
            near_vec(torque[run][k], torque[0][k], 1e-11 * axial() * 0.1);
        }
        assert_true(pls_length(force[run][0]) > 1e-3 * axial());
        verify_close(&scene);
    }
}

/// Energy and momenta of a tumbling cluster that bends and twists by large angles.
static void a_tumbling_cluster_keeps_energy_and_momenta(void **state)
{
    (void)state;
    verify_scene scene = open_scene(3, 1e-5);
    for (int k = 0; k < 12; ++k)
    {
        pls_random random = pls_random_stream(3, (uint64_t)k, PLS_FOR_USER);
        const double a = pls_random_uniform(&random) - 0.5, b = pls_random_uniform(&random) - 0.5, c = pls_random_uniform(&random) - 0.5;
        pls_body_def def = verify_ball_def(&scene, 0.04, 0.1, pls_vec(0.1 * (k % 3), 0.1 * (k / 3 % 2), 0.1 * (k / 6)),
                                           pls_vec(4.0 * a, 4.0 * b, 4.0 * c));
        def.angular_velocity = pls_vec(60.0 * b, 60.0 * c, 60.0 * a);
        verify_add(&scene, &def);
    }
    join(&scene, 0.15, 0.0, 0.0);
    const double before = verify_total_energy(scene.world);
    const pls_world_figures start = verify_figures(scene.world);
    double stored = 0.0, worst = 0.0;
    for (int k = 0; k < 100; ++k)
    {
        MUST(pls_world_run(scene.world, 1000));
        stored = fmax(stored, verify_figures(scene.world).energy_bonds);
        worst = fmax(worst, fabs(verify_total_energy(scene.world) / before - 1.0));
    }
    const pls_world_figures end = verify_figures(scene.world);
    assert_true(stored > 0.1 * before);
    if (worst > 1e-3) fail_msg("energy changed by %g of it", worst);
    near_vec(end.momentum, start.momentum, 1e-12);
    near_vec(end.angular_momentum, start.angular_momentum, 1e-12);
    verify_close(&scene);
}

// ---- a cantilever ------------------------------------------------------------------------------------------------------------------------------------------------

enum { POINTS = 11 };

static verify_scene open_relaxing(double dt)
{
    pls_world_def def = pls_default_world_def(2);
    def.dt = dt;
    def.coordination = 0;
    def.relaxation = true;
    const verify_value law[] = {{"kn", 1.0}, {NULL, 0.0}};
    verify_scene scene = verify_open(&def, "elastic", law);
    MUST(pls_world_set_material_value(scene.world, scene.grain, "young_modulus", young));
    MUST(pls_world_set_material_value(scene.world, scene.grain, "poisson_ratio", poisson));
    return scene;
}

/// Eleven points of 1 kg in all, halved at the ends, on 1 m, under an acceleration across: the tip goes to the sum over point loads, m a x^2 (3 L - x)/(6 EI).
static void a_cantilever_bends_as_under_its_point_loads(void **state)
{
    (void)state;
    const double a = -2e-3; // the deflection is 3e-4 of the length: what is not linear is of 1e-7
    verify_scene scene = open_relaxing(1e-4);
    double expected = 0.0;
    pls_body_id tip = {0, 0};
    for (int k = 0; k < POINTS; ++k)
    {
        const double x = 0.1 * k, mass = k == 0 || k == POINTS - 1 ? 0.05 : 0.1;
        pls_body_def def = verify_ball_def(&scene, 0.04, mass, pls_vec(x, 0, 0), pls_vec(0, 0, 0));
        if (k == 0) def.motion.axes = PLS_AXIS_ALL;
        tip = verify_add(&scene, &def);
        expected += mass * a * x * x * (3.0 - x) / (6.0 * bending());
    }
    join(&scene, 0.15, 0.0, 0.0);
    MUST(pls_world_add_gravity(scene.world, pls_vec(0, a, 0)));
    MUST(pls_world_run(scene.world, 125000));
    const double found = verify_motion(scene.world, tip).position.y;
    if (!(fabs(found / expected - 1.0) < 1e-6))
        fail_msg("the tip is at %.9g m, the loads say %.9g m (%g off)", found, expected, found / expected - 1.0);
    assert_true(fabs(expected / (a / (8.0 * bending())) - 1.0033) < 1e-3); // 0.33 % from the evenly spread load
    verify_close(&scene);
}

// ---- large deflections -------------------------------------------------------------------------------------------------------------------------------------

/// The elastica: EI theta'' = -P cos(theta), theta(0) = 0, theta'(L) = 0, by shooting with Runge-Kutta. Deflection of the end by the length, for a load P L^2/EI.
static double elastica(double load)
{
    enum { STEPS = 2000 };
    double low = 0.0, high = load; // of the curvature at the clamp
    double y = 0.0;
    for (int pass = 0; pass < 80; ++pass)
    {
        const double start = 0.5 * (low + high), h = 1.0 / STEPS;
        double angle = 0.0, curvature = start;
        y = 0.0;
        for (int k = 0; k < STEPS; ++k)
        {
            const double a1 = curvature, c1 = -load * cos(angle), a2 = curvature + 0.5 * h * c1, c2 = -load * cos(angle + 0.5 * h * a1);
            const double a3 = curvature + 0.5 * h * c2, c3 = -load * cos(angle + 0.5 * h * a2), a4 = curvature + h * c3,
                         c4 = -load * cos(angle + h * a3);
            y += h / 6.0 * (sin(angle) + 4.0 * sin(angle + 0.5 * h * a2) + sin(angle + h * a3));
            angle += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
            curvature += h / 6.0 * (c1 + 2.0 * c2 + 2.0 * c3 + c4);
        }
        if (curvature > 0.0)
            high = start;
        else
            low = start;
    }
    return y;
}

static double end_load;
static uint32_t end_body;
static void load_the_end(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque)
{
    (void)time, (void)position, (void)velocity, (void)torque;
    *force = pls_vec(0, body == end_body ? -end_load : 0.0, 0);
}

/// Points on 1 m along x, the first one clamped, of this mass each.
static pls_body_id make_cantilever(const verify_scene *scene, size_t points, double mass)
{
    pls_body_id tip = {0, 0};
    const double l = 1.0 / (double)(points - 1);
    for (size_t k = 0; k < points; ++k)
    {
        pls_body_def def =
            verify_ball_def(scene, 0.4 * l, k == 0 || k == points - 1 ? 0.5 * mass : mass, pls_vec(l * (double)k, 0, 0), pls_vec(0, 0, 0));
        if (k == 0) def.motion.axes = PLS_AXIS_ALL;
        tip = verify_add(scene, &def);
    }
    join(scene, 1.2 * l, 0.0, 0.0);
    return tip;
}

/// A small load, P L^3/(3 EI), and loads that bend the beam to half of its length and further.
static void the_end_follows_the_elastica(void **state)
{
    (void)state;
    assert_true(fabs(elastica(1.0) - 0.30172) < 1e-4); // Bisshopp and Drucker 1945, Mattiasson 1981
    assert_true(fabs(elastica(2.0) - 0.49346) < 1e-4);
    const double loads[] = {0.01, 2.0, 2.1, 5.0}, tolerance[] = {1e-3, 0.01, 0.01, 0.01};
    for (size_t n = 0; n < 4; ++n)
    {
        verify_scene scene = open_relaxing(1e-4);
        const pls_body_id tip = make_cantilever(&scene, 21, 0.05);
        const verify_field field = {load_the_end, NULL};
        end_load = loads[n] * bending();
        end_body = tip.index1 - 1;
        verify_add_field(scene.world, &field);
        MUST(pls_world_run(scene.world, 40000)); // 4 s, twice the slowest period
        const double found = -verify_motion(scene.world, tip).position.y, expected = n == 0 ? loads[0] / 3.0 : elastica(loads[n]);
        if (!(fabs(found / expected - 1.0) < tolerance[n])) fail_msg("load %g: the end is at %g, not %g", loads[n], found, expected);
        assert_true(verify_figures(scene.world).energy_kinetic < 1e-6);
        verify_close(&scene);
    }
}

/// Shape of a mode of a cantilever (Rayleigh; beta L of the modes).
static double mode_shape(double beta, double x)
{
    const double c = (cosh(beta) + cos(beta)) / (sinh(beta) + sin(beta));
    return cosh(beta * x) - cos(beta * x) - c * (sinh(beta * x) - sin(beta * x));
}

/// The first three frequencies, (beta L)^2 sqrt(EI/(M L^3)), from the time in which the velocity in the shape of each mode falls to zero.
static void a_cantilever_has_its_natural_frequencies(void **state)
{
    (void)state;
    enum { COUNT = 61 };
    const double betas[] = {1.8751040687, 4.6940911330, 7.8547574382}, mass = 1.0 / (COUNT - 1);
    for (int mode = 0; mode < 3; ++mode)
    {
        const double expected = betas[mode] * betas[mode] * sqrt(bending()), dt = fmin(2e-5, 0.5 * pi / expected / 500.0);
        verify_scene scene = open_scene(2, dt);
        const pls_body_id tip = make_cantilever(&scene, COUNT, mass);
        pls_body_id id[COUNT];
        for (uint32_t k = 0; k < COUNT; ++k)
        {
            id[k] = (pls_body_id){tip.index1 - (COUNT - 1) + k, tip.generation};
            const double x = (double)k / (COUNT - 1), h = 1e-5;
            const double slope = (mode_shape(betas[mode], x + h) - mode_shape(betas[mode], x - h)) / (2.0 * h);
            if (k > 0)
                MUST(pls_body_set_velocity(scene.world, id[k], pls_vec(0, 1e-4 * mode_shape(betas[mode], x), 0),
                                           pls_vec(0, 0, 1e-4 * slope)));
        }
        double before = 0.0, now = INFINITY;
        while (now > 0.0 && pls_world_step_number(scene.world) < 1000000)
        {
            MUST(pls_step(scene.world));
            before = now;
            now = 0.0;
            for (uint32_t k = 1; k < COUNT; ++k)
                now += (k == COUNT - 1 ? 0.5 : 1.0) * mode_shape(betas[mode], (double)k / (COUNT - 1)) *
                       verify_motion(scene.world, id[k]).velocity.y;
        }
        const double found = 0.5 * pi / (pls_world_time(scene.world) - dt * now / (now - before));
        if (!(fabs(found / expected - 1.0) < 0.01)) fail_msg("mode %d: %g instead of %g 1/s", mode + 1, found, expected);
        verify_close(&scene);
    }
}

// ---- strength ----------------------------------------------------------------------------------------------------------------------------------------------------

/// Pull, bend, shear or twist a beam slowly, until it breaks; how far.
static double displacement_at_break(pls_vec3 along, pls_vec3 turn, double tensile, double shear, double step)
{
    verify_scene scene = open_scene(3, 1e-6);
    pls_body_id a = verify_ball(&scene, 0.05, 1.0, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    pls_body_id b = verify_ball(&scene, 0.05, 1.0, pls_vec(0.2, 0, 0), pls_vec(0, 0, 0));
    pls_bonds_id id = join(&scene, 0.3, tensile, shear);
    double u = 0.0;
    pls_bonds_figures f = {0};
    for (int k = 1; f.broken == 0 && k < 100000; ++k)
    {
        u = step * k;
        place(scene.world, b, pls_add(pls_vec(0.2, 0, 0), pls_scale(along, u)),
              pls_length(turn) > 0.0 ? about(turn, u) : pls_quat_identity());
        act(scene.world);
        pls_bonds_acted(scene.world);
        MUST(pls_world_bonds_figures(scene.world, id, &f));
    }
    assert_int_equal(f.broken, 2);
    assert_true(f.energy_broken > 0.0);
    (void)a;
    verify_close(&scene);
    return u;
}

static void a_beam_breaks_at_its_strength(void **state)
{
    (void)state;
    const double l = 0.2, A = pi * radius * radius, J = pi * pow(radius, 4) / 2.0, strength = 1e5;
    // sigma = E u/l
    assert_true(fabs(displacement_at_break(pls_vec(1, 0, 0), pls_vec(0, 0, 0), strength, 0.0, 1e-6) / (strength * l / young) - 1.0) < 0.01);
    // Turned at one end, M = 4 EI a/l: sigma = M r/I = 4 E r a/l
    assert_true(
        fabs(displacement_at_break(pls_vec(0, 0, 0), pls_vec(0, 0, 1), strength, 0.0, 1e-5) / (strength * l / (4.0 * young * radius)) -
             1.0) < 0.01);
    // Twisted, T = GJ a/l: tau = T r/J
    const double G = torsion() / J;
    assert_true(fabs(displacement_at_break(pls_vec(0, 0, 0), pls_vec(1, 0, 0), 0.0, strength, 1e-5) / (strength * l / (G * radius)) - 1.0) <
                0.01);
    // Sheared, F = 12 EI u/l^3: tau = F/A
    assert_true(
        fabs(displacement_at_break(pls_vec(0, 1, 0), pls_vec(0, 0, 0), 0.0, 1e3, 1e-6) / (1e3 * A * pow(l, 3) / (12.0 * bending())) - 1.0) <
        0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_motions_meet_the_beam_element),
        cmocka_unit_test(forces_turn_with_the_whole_whatever_the_numbers),
        cmocka_unit_test(a_tumbling_cluster_keeps_energy_and_momenta),
        cmocka_unit_test(a_cantilever_bends_as_under_its_point_loads),
        cmocka_unit_test(the_end_follows_the_elastica),
        cmocka_unit_test(a_cantilever_has_its_natural_frequencies),
        cmocka_unit_test(a_beam_breaks_at_its_strength),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
