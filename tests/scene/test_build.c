// test_build.c -- from a scene to a world that moves as the scene says, against solutions written down by hand.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "scene/scene_file.h"
#include "support/failing_allocator.h"

#include <math.h>
#include <stdio.h>

typedef struct job
{
    pls_scene *scene;
    pls_world *world;
} job;

static job start(const char *text)
{
    job j = {must_load(text), NULL};
    j.world = must_build(j.scene);
    if (pls_world_prepare(j.world) != PLS_OK) fail_msg("%s", pls_last_message());
    return j;
}

static void run(const job *j, uint64_t steps)
{
    if (pls_world_run(j->world, steps) != PLS_OK) fail_msg("%s", pls_last_message());
}

static void stop(job *j)
{
    pls_world_destroy(j->world);
    pls_scene_free(j->scene);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.17g is not %.17g within %g", value, expected, tolerance);
}

static void bodies_are_numbered_in_the_order_of_entries(void **state)
{
    (void)state;
    job j =
        start(SCENE_HEAD "bodies:\n"
                         "  - {name: pack, shape: ball, material: grain, place: {points: [[0, 0, 0], [1, 0, 0], [2, 0, 0]]}, scale: 0.5}\n"
                         "  - {name: last, shape: ball, material: grain, position: [7, 8, 9]}\n" SCENE_LAW "time: {end: 1, dt: 1.0e-3}\n");
    assert_int_equal(pls_world_body_count(j.world), 4);
    assert_near(body_value(j.world, "position", 1, 0), 1.0, 0);
    assert_near(body_value(j.world, "position", 3, 2), 9.0, 0);
    assert_near(body_value(j.world, "scale", 0, 0), 0.5, 0);
    assert_near(body_value(j.world, "mass", 3, 0), 1000.0 * 4.0 / 3.0 * M_PI * 1e-3, 1e-12);
    assert_string_equal(pls_world_group_name(j.world, pls_world_find_group(j.world, "last")), "last");
    stop(&j);
}

static void a_mass_alone_gives_the_inertia_of_a_uniform_body(void **state)
{
    (void)state;
    job j = start("particls: 1\nmaterials: {grain: {}}\nshapes: {ball: {sphere: {radius: 0.1}}}\nbodies:\n"
                  "  - {name: a, shape: ball, material: grain, position: [0, 0, 0], mass: 3, scale: 2}\n" SCENE_LAW
                  "time: {end: 1, dt: 1.0e-3}\n");
    assert_near(body_value(j.world, "mass", 0, 0), 3.0, 0);
    assert_near(body_value(j.world, "inertia", 0, 0), 0.4 * 3.0 * 0.2 * 0.2, 1e-15);
    stop(&j);
    j = start("particls: 1\ndimension: 2\nmaterials: {grain: {}}\nshapes: {ball: {sphere: {radius: 0.1}}}\nbodies:\n"
              "  - {name: a, shape: ball, material: grain, position: [0, 0], mass: 3, scale: 2}\n" SCENE_LAW
              "time: {end: 1, dt: 1.0e-3}\n");
    assert_near(body_value(j.world, "inertia", 0, 2), 0.5 * 3.0 * 0.2 * 0.2, 1e-15);
    stop(&j);
}

static void normals_turn_the_plane_onto_them(void **state)
{
    (void)state;
    const double normals[][3] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {1, 2, -2}};
    for (size_t k = 0; k < 5; ++k)
    {
        char text[1024];
        snprintf(text, sizeof text,
                 SCENE_HEAD "bodies:\n  - {name: a, shape: ball, material: grain, position: [5, 5, 5]}\n"
                            "  - {name: w, shape: wall, material: grain, position: [0, 0, 0], normal: [%g, %g, %g]}\n" SCENE_LAW
                            "time: {end: 1, dt: 1.0e-3, allow_unstable: true}\nguard: {max_overlap: 1.0e6}\n",
                 normals[k][0], normals[k][1], normals[k][2]);
        job j = {must_load(text), NULL};
        j.world = must_build(j.scene);
        pls_quat q = {body_value(j.world, "orientation", 1, 0), body_value(j.world, "orientation", 1, 1),
                      body_value(j.world, "orientation", 1, 2), body_value(j.world, "orientation", 1, 3)};
        pls_vec3 n = pls_rotate(q, pls_vec(0, 0, 1)), expected = pls_unit(pls_vec(normals[k][0], normals[k][1], normals[k][2]));
        assert_near(pls_length(pls_sub(n, expected)), 0.0, 1e-15);
        stop(&j);
    }
}

static void a_displacement_is_followed_to_round_off(void **state)
{
    (void)state;
    job j = start(SCENE_HEAD "vars: {omega: 2*pi}\nbodies:\n"
                             "  - {name: a, shape: ball, material: grain, position: [0, 0, 5]}\n"
                             "  - {name: floor, shape: wall, material: grain, position: [0, 0, -1], normal: [0, 0, 1], "
                             "motion: {displacement: [0, 0, \"0.1*sin(omega*t)\"]}}\n" SCENE_LAW "time: {end: 1, dt: 1.0e-3}\n");
    run(&j, 137);
    assert_near(body_value(j.world, "position", 1, 2), -1.0 + 0.1 * sin(2 * M_PI * 0.137), 1e-13);
    stop(&j);
}

static void a_free_axis_obeys_forces_while_the_others_are_driven(void **state)
{
    (void)state;
    job j =
        start(SCENE_HEAD "bodies:\n"
                         "  - {name: a, shape: ball, material: grain, position: [0, 0, 0], motion: {velocity: [\"2*t\", free, 0], "
                         "angular_velocity: [0, 0, 3]}}\n" SCENE_LAW "forces:\n  - {gravity: [1, -10, 1]}\ntime: {end: 1, dt: 1.0e-3}\n");
    run(&j, 500);
    assert_near(body_value(j.world, "position", 0, 0), 0.25, 1e-12);
    assert_near(body_value(j.world, "position", 0, 1), -10 * 0.25 / 2, 1e-12);
    assert_near(body_value(j.world, "position", 0, 2), 0.0, 0);
    assert_near(body_value(j.world, "angular_velocity", 0, 2), 3.0, 0);
    assert_near(body_value(j.world, "orientation", 0, 3), sin(3 * 0.5 / 2), 1e-12);
    stop(&j);
}

static void fixed_bodies_stay_and_locked_axes_hold(void **state)
{
    (void)state;
    job j =
        start(SCENE_HEAD "bodies:\n"
                         "  - {name: a, shape: ball, material: grain, position: [0, 0, 0], fixed: true}\n"
                         "  - {name: b, shape: ball, material: grain, position: [1, 0, 0], velocity: [1, 0, 0], lock: [y, rx]}\n" SCENE_LAW
                         "forces:\n  - {gravity: [0, -10, -10]}\ntime: {end: 1, dt: 1.0e-3}\n");
    run(&j, 100);
    for (int c = 0; c < 3; ++c) assert_near(body_value(j.world, "position", 0, c), 0.0, 0);
    assert_near(body_value(j.world, "position", 1, 0), 1.1, 1e-12);
    assert_near(body_value(j.world, "position", 1, 1), 0.0, 0);
    assert_near(body_value(j.world, "position", 1, 2), -10 * 0.01 / 2, 1e-12);
    stop(&j);
}

static void initial_velocities_may_depend_on_the_place(void **state)
{
    (void)state;
    job j =
        start(SCENE_HEAD
              "vars: {omega: 3}\nbodies:\n"
              "  - {name: a, shape: ball, material: grain, velocity: [\"-omega*y\", \"omega*x\", 2], angular_velocity: [0, 0, \"x+y\"], "
              "place: {points: [[1, 2, 0], [3, 5, 0]]}}\n" SCENE_LAW "time: {end: 1, dt: 1.0e-3}\n");
    assert_near(body_value(j.world, "velocity", 1, 0), -15.0, 0);
    assert_near(body_value(j.world, "velocity", 1, 1), 9.0, 0);
    assert_near(body_value(j.world, "velocity", 1, 2), 2.0, 0);
    assert_near(body_value(j.world, "angular_velocity", 0, 2), 3.0, 0);
    stop(&j);
}

static void a_field_acts_where_and_on_whom_it_should(void **state)
{
    (void)state;
    job j = start(SCENE_HEAD "bodies:\n"
                             "  - {name: a, shape: ball, material: grain, place: {points: [[1, 0, 0], [-1, 0, 0]]}}\n"
                             "  - {name: b, shape: ball, material: grain, position: [2, 0, 0]}\n" SCENE_LAW "forces:\n"
                             "  - {field: {acceleration: [0, 6*t, 0], where: \"x > 0\", bodies: a}}\n"
                             "  - {field: {force: [0, 0, \"m*4\"], where: \"t >= 0\"}}\n"
                             "time: {end: 1, dt: 1.0e-3}\n");
    run(&j, 500);
    assert_near(body_value(j.world, "velocity", 0, 1), 3 * 0.25, 1e-9); // trapezoids of 6 t are exact
    assert_near(body_value(j.world, "velocity", 1, 1), 0.0, 0);
    assert_near(body_value(j.world, "velocity", 2, 1), 0.0, 0);
    for (size_t k = 0; k < 3; ++k) assert_near(body_value(j.world, "velocity", k, 2), 2.0, 1e-12);
    stop(&j);
}

static double state_value(const pls_world *world, const char *name)
{
    double value[PLS_STATE_MAX_COMPONENTS];
    assert_int_equal(pls_state_get(world, pls_world_find_state(world, name), value), PLS_OK);
    return value[0];
}

static void states_follow_their_rates(void **state)
{
    (void)state;
    job j = start(
        SCENE_HEAD
        "bodies:\n"
        "  - {name: a, shape: ball, material: grain, place: {points: [[0, 0, 0], [1, 0, 0]]}, velocity: [\"1 + x\", 0, 0]}\n" SCENE_LAW
        "states:\n"
        "  - {name: T, initial: 2, rate: \"-T\"}\n"
        "  - {name: total, rate: \"T + 0*s\"}\n"
        "  - {name: way, of: a, each: true, rate: \"vx + 0*way\"}\n"
        "  - {name: place, of: \"a[1]\", rate: \"x\"}\n"
        "time: {end: 1, dt: 1.0e-3}\n");
    run(&j, 1000);
    assert_near(state_value(j.world, "T"), 2 * exp(-1), 2e-7); // midpoint rule: error 2 e^-1 dt^2 / 6
    assert_near(state_value(j.world, "total"), 2 - 2 * exp(-1), 3e-7);
    assert_near(state_value(j.world, "way_0"), 1.0, 1e-12);
    assert_near(state_value(j.world, "way_1"), 2.0, 1e-12);
    assert_near(state_value(j.world, "place"), 1.0 + 2.0 / 2, 1e-9);
    stop(&j);
}

static void the_short_form_grows_a_radius_from_the_bodys_own(void **state)
{
    (void)state;
    job j = start("particls: 1\ndimension: 2\nmaterials: {grain: {density: 1}}\nshapes: {disc: {sphere: {radius: 2}}}\nbodies:\n"
                  "  - {name: pack, shape: disc, material: grain, place: {lattice: {count: [5, 5], spacing: 20}}, scale: 0.5}\n" SCENE_LAW
                  "states:\n  - {of: pack, index: middle, radius: {rate: \"1\"}}\n"
                  "time: {end: 3, dt: 1.0e-3}\n");
    run(&j, 500);
    assert_near(body_value(j.world, "radius", 12, 0), 1.5, 1e-12);
    assert_near(body_value(j.world, "scale", 12, 0), 0.75, 1e-12);
    assert_near(body_value(j.world, "radius", 11, 0), 1.0, 0);
    assert_near(state_value(j.world, "pack_radius"), 1.5, 1e-12);
    stop(&j);
}

static void values_over_time_and_states_hold_from_the_start(void **state)
{
    (void)state;
    // The density at t = 0 gives the mass; kn over a state gives the force of a contact held at a constant overlap of 0.01 m.
    job j = start("particls: 1\nmaterials: {grain: {density: \"1000*(1 + 0.1*T)\"}}\nshapes: {ball: {sphere: {radius: 0.1}}}\nbodies:\n"
                  "  - {name: a, shape: ball, material: grain, position: [0, 0, 0], fixed: true}\n"
                  "  - {name: b, shape: ball, material: grain, position: [0.19, 0, 0], mass: 1.0e15}\n"
                  "contact:\n  - {between: [grain, grain], law: elastic, kn: \"1000*T + t\"}\n"
                  "states:\n  - {name: T, initial: 1, rate: 2}\n"
                  "time: {end: 3, dt: 1.0e-3}\n");
    assert_near(body_value(j.world, "mass", 0, 0), 1100 * 4.0 / 3.0 * M_PI * 1e-3, 1e-12);
    assert_near(body_value(j.world, "force", 1, 0), 1000 * 0.01, 1e-9);
    run(&j, 250);
    assert_near(body_value(j.world, "force", 1, 0), (1000 * 1.5 + 0.25) * 0.01, 0.03); // a step early or late: 2 N/step
    stop(&j);
}

static void a_named_pair_wins_over_all(void **state)
{
    (void)state;
    job j = start("particls: 1\nmaterials: {a: {density: 1}, b: {density: 1}}\nshapes: {ball: {sphere: {radius: 0.1}}}\nbodies:\n"
                  "  - {name: one, shape: ball, material: a, position: [0, 0, 0]}\n"
                  "  - {name: two, shape: ball, material: b, position: [0.19, 0, 0]}\n"
                  "  - {name: three, shape: ball, material: b, position: [0.38, 0, 0]}\n"
                  "contact:\n"
                  "  - {between: [b, a], law: elastic, kn: 3000}\n"
                  "  - {between: all, law: elastic, kn: 1000}\n"
                  "time: {end: 3, dt: 1.0e-4}\n");
    assert_near(body_value(j.world, "force", 0, 0), -30.0, 1e-9);
    assert_near(body_value(j.world, "force", 2, 0), 10.0, 1e-9);
    stop(&j);
}

static void world_settings_reach_the_world(void **state)
{
    (void)state;
    job j = start("particls: 1\ndimension: 2\nthickness: 0.5\nmaterials: {a: {density: 2}}\nshapes: {disc: {sphere: {radius: 0.1}}}\n"
                  "domain: {periodic: [true, false], lower: [0, 0], upper: [1, 1], stretch_rate: [0.1, 0]}\n"
                  "bodies:\n  - {name: one, shape: disc, material: a, place: {points: [[0.05, 0.5], [0.86, 0.5]]}}\n" SCENE_LAW
                  "time: {end: 3, dt: 1.0e-4}\n");
    assert_int_equal(pls_world_dimension(j.world), 2);
    assert_near(pls_world_dt(j.world), 1e-4, 0);
    assert_near(body_value(j.world, "mass", 0, 0), 2 * M_PI * 0.01 * 0.5, 1e-15);
    assert_int_equal(pls_world_contact_count(j.world), 1); // across the periodic boundary
    stop(&j);
}

static pls_status build_job(void *context)
{
    pls_world *world;
    pls_status status = pls_scene_build(context, &world);
    if (status == PLS_OK) pls_world_destroy(world);
    return status;
}

static void building_survives_allocation_failures(void **state)
{
    (void)state;
    failing_allocator_install();
    pls_scene *scene = must_load(
        SCENE_HEAD "vars: {omega: 3}\nbodies:\n"
                   "  - {name: a, shape: ball, material: grain, velocity: [\"-omega*y\", 0, 2], place: {points: [[1, 2, 0], [3, 5, 0]]}}\n"
                   "  - {name: floor, shape: wall, material: grain, position: [0, 0, -1], normal: [0, 0, 1], "
                   "motion: {displacement: [0, 0, \"0.1*sin(omega*t)\"]}}\n"
                   "contact:\n  - {between: all, law: elastic, kn: \"1000*T + t\"}\n"
                   "forces:\n  - {gravity: [0, 0, -9.81]}\n  - {field: {acceleration: [0, 6*t, 0], where: \"x > 0\", bodies: a}}\n"
                   "states:\n  - {name: T, initial: 1, rate: 2}\n  - {name: way, of: a, each: true, rate: vx}\n"
                   "time: {end: 1, dt: 1.0e-3}\n");
    assert_true(assert_survives_allocation_failures(build_job, scene) > 50);
    pls_scene_free(scene);
    failing_allocator_remove();
}

// ---- continua ---------------------------------------------------------------------------------------------------------------------------------------------

#define PLATE                                                                                                 \
    "particls: 1\nmaterials: {solid: {density: 2000, young_modulus: 1.0e7, poisson_ratio: 0.25}}\n"           \
    "shapes: {plate: {box: {half: [0.5, 0.1, 0.1]}}, point: {sphere: {radius: 0.02}}}\n"                      \
    "bodies: [{name: plate, shape: point, material: solid, place: {fill: {region: plate, spacing: 0.05}}}]\n" \
    "contact: [{between: all, law: elastic, kn: 100}]\n"

/// Sum of a component of the forces on all bodies.
static double sum_of_forces(const pls_world *world, int component)
{
    double sum = 0.0;
    for (uint32_t n = 0; n < pls_world_body_count(world); ++n) sum += body_value(world, "force", n, component);
    return sum;
}

static void loads_on_faces_are_shared_by_mass(void **state)
{
    (void)state;
    job j = start(PLATE "forces:\n  - {traction: {value: [\"3*(1 + t)\", -2, \"x\"], area: 0.04, where: \"x > 0.45\"}}\n"
                        "  - {pressure: {value: 5, normal: [0, 2, 0], area: 0.2, where: \"y > 0.05\"}}\ntime: {end: 1, dt: 1.0e-4}\n");
    // The layer at x = 0.475 has 4 x 4 points; that at y = 0.075 has 20 x 4.
    assert_near(sum_of_forces(j.world, 0), 0.04 * 3.0, 1e-14);
    assert_near(sum_of_forces(j.world, 1), -0.04 * 2.0 - 0.2 * 5.0, 1e-14);
    assert_near(sum_of_forces(j.world, 2), 0.04 * 0.475, 1e-14);
    assert_near(body_value(j.world, "force", 19, 0), 0.04 * 3.0 / 16.0, 1e-15); // x fastest
    assert_near(body_value(j.world, "force", 18, 0), 0.0, 1e-13);               // but for contacts: neighbours touch to rounding
    run(&j, 100);
    assert_near(sum_of_forces(j.world, 0), 0.04 * 3.0 * 1.01, 1e-13);
    stop(&j);
}

static void fields_by_volume(void **state)
{
    (void)state;
    job j = start(PLATE "forces: [{field: {density: [\"10*x\", 0, 4], where: \"x > 0\"}}]\ntime: {end: 1, dt: 1.0e-4}\n");
    const double volume = 0.05 * 0.05 * 0.05;
    assert_near(body_value(j.world, "force", 19, 0), 10.0 * 0.475 * volume, 1e-16);
    assert_near(body_value(j.world, "force", 19, 2), 4.0 * volume, 1e-16);
    assert_near(body_value(j.world, "force", 0, 2), 0.0, 1e-13);
    stop(&j);
}

/// Heat by expressions: what is held, what is put in, what it starts from; a free plate grows.
static void heat_by_expressions(void **state)
{
    (void)state;
    job j =
        start("particls: 1\nvars: {temperature: 7}\nmaterials: {solid: {density: 2000, young_modulus: 1.0e7, poisson_ratio: 0.25}}\n"
              "shapes: {plate: {box: {half: [0.5, 0.1, 0.1]}}, point: {sphere: {radius: 0.02}}}\n"
              "bodies: [{name: plate, shape: point, material: solid, place: {fill: {region: plate, spacing: 0.05}}}]\n"
              "contact: [{between: all, law: elastic, kn: 100}]\n"
              "bonds:\n  - of: [plate]\n    law: linear_solid\n    horizon: 0.151\n    heat:\n      conductivity: 0\n      capacity: 500\n"
              "      expansion: 1.0e-5\n      initial: \"300 + x\"\n      source: \"x > 0 ? 1.0e6*(1 + 0*temperature) : 0\"\n"
              "      held: [{temperature: \"250 + t\", where: \"x < -0.4\"}]\ntime: {end: 1, dt: 1.0e-4}\n");
    run(&j, 100);
    assert_near(body_value(j.world, "temperature", 0, 0), 250.01, 1e-12);
    assert_near(body_value(j.world, "temperature", 5, 0), 300.0 - 0.225, 1e-12);
    assert_near(body_value(j.world, "temperature", 19, 0), 300.475 + 1e6 / (2000.0 * 500.0) * 0.01, 1e-10);
    assert_true(isnan(body_value(j.world, "plastic_strain", 0, 0)));
    assert_near(body_value(j.world, "fragment", 319, 0), 0.0, 0.0);
    stop(&j);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_numbered_in_the_order_of_entries),
        cmocka_unit_test(loads_on_faces_are_shared_by_mass),
        cmocka_unit_test(fields_by_volume),
        cmocka_unit_test(heat_by_expressions),
        cmocka_unit_test(a_mass_alone_gives_the_inertia_of_a_uniform_body),
        cmocka_unit_test(normals_turn_the_plane_onto_them),
        cmocka_unit_test(a_displacement_is_followed_to_round_off),
        cmocka_unit_test(a_free_axis_obeys_forces_while_the_others_are_driven),
        cmocka_unit_test(fixed_bodies_stay_and_locked_axes_hold),
        cmocka_unit_test(initial_velocities_may_depend_on_the_place),
        cmocka_unit_test(a_field_acts_where_and_on_whom_it_should),
        cmocka_unit_test(states_follow_their_rates),
        cmocka_unit_test(the_short_form_grows_a_radius_from_the_bodys_own),
        cmocka_unit_test(values_over_time_and_states_hold_from_the_start),
        cmocka_unit_test(a_named_pair_wins_over_all),
        cmocka_unit_test(world_settings_reach_the_world),
        cmocka_unit_test(building_survives_allocation_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
