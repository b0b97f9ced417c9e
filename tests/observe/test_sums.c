// Sums over hand-made bodies and contacts whose totals can be written down.

#include "observe/sums.h"

#include "step/world.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const double round_off = 1e-14;

static void expect_near(double value, double expected, double scale)
{
    if (!(fabs(value - expected) <= round_off * scale)) print_message("%.17g, expected %.17g\n", value, expected);
    assert_true(fabs(value - expected) <= round_off * scale);
}

/// Bodies and a space, in a world that is otherwise empty: no forces, no shapes.
typedef struct setting
{
    pls_world world;
    pls_bodies bodies;
    pls_domain domain;
    pls_selection selection;
} setting;

static void begin(setting *s, int dimension)
{
    memset(s, 0, sizeof *s);
    s->domain.dimension = dimension;
    s->domain.thickness = 1;
    s->selection.around = (pls_surroundings){.world = &s->world, .bodies = &s->bodies, .domain = &s->domain};
    s->selection.include_walls = true;
}

static uint32_t add(setting *s, pls_vec3 position, double radius, double mass, uint32_t group)
{
    uint32_t row;
    assert_int_equal(pls_bodies_add(&s->bodies, &row), PLS_OK);
    s->bodies.place[row] = (pls_body_place){.x = position.x, .y = position.y, .z = position.z, .radius = radius};
    s->bodies.orientation[row].w = 1;
    s->bodies.mass[row].mass = mass;
    s->bodies.kind[row].group = group;
    if (isinf(radius)) s->bodies.kind[row].flags = PLS_BODY_UNBOUNDED;
    return row;
}

static pls_body_sums body_sums(setting *s)
{
    pls_body_sums sums;
    assert_int_equal(pls_sum_bodies(&s->selection, false, &sums), PLS_OK);
    return sums;
}

static pls_contact_sums contact_sums(setting *s, pls_contact_entry *entry, size_t count)
{
    pls_contact_view view = {.entry = entry, .count = count, .capacity = count};
    pls_contact_sums sums;
    assert_int_equal(pls_sum_contacts(&s->selection, &view, true, &sums), PLS_OK);
    return sums;
}

static pls_contact_entry contact_between(const setting *s, uint32_t i, uint32_t j)
{
    return (pls_contact_entry){
        .number_i = s->bodies.kind[i].number,
        .number_j = s->bodies.kind[j].number,
        .row_i = i,
        .row_j = j,
        .wall = isinf(s->bodies.place[j].radius) != 0,
    };
}

static void a_turned_spinning_body_has_the_energy_and_momentum_of_its_principal_axes(void **state)
{
    (void)state;
    setting s;
    begin(&s, 3);
    uint32_t row = add(&s, pls_vec(1, 2, 3), 0.5, 4, 0);
    s.bodies.place[row].vx = 5;
    s.bodies.place[row].vy = -1;
    s.bodies.mass[row].ix = 2;
    s.bodies.mass[row].iy = 3;
    s.bodies.mass[row].iz = 7;
    // a quarter turn about z takes the grain's x axis to y: spin about world y is spin about the grain's x
    s.bodies.orientation[row] = (pls_body_orientation){sqrt(0.5), 0, 0, sqrt(0.5)};
    s.bodies.spin[row].wy = 6;
    pls_body_sums sums = body_sums(&s);
    expect_near(sums.kinetic, 0.5 * 4 * 26, 52);
    expect_near(sums.rotation, 0.5 * 2 * 36, 36);
    expect_near(sums.momentum[0], 20, 20);
    expect_near(sums.momentum[1], -4, 20);
    expect_near(sums.momentum[2], 0, 20);
    // X x p + I w = (1, 2, 3) x (20, -4, 0) + (0, 12, 0) = (12, 60, -44) + (0, 12, 0)
    expect_near(sums.angular_momentum[0], 12, 72);
    expect_near(sums.angular_momentum[1], 72, 72);
    expect_near(sums.angular_momentum[2], -44, 72);
    pls_bodies_free(&s.bodies);
}

static void walls_count_neither_as_bodies_nor_in_the_bounding_box(void **state)
{
    (void)state;
    setting s;
    begin(&s, 3);
    add(&s, pls_vec(0, 0, 0), INFINITY, INFINITY, 0);
    add(&s, pls_vec(1, 2, 3), 0.5, 1, 0);
    add(&s, pls_vec(4, 2, 1), 0.25, 1, 0);
    pls_body_sums sums = body_sums(&s);
    expect_near(sums.bounded, 2, 1);
    const double lower[3] = {0.5, 1.5, 0.75};
    const double upper[3] = {4.25, 2.5, 3.5};
    for (int axis = 0; axis < 3; ++axis)
    {
        expect_near(sums.lower[axis], lower[axis], 1);
        expect_near(sums.upper[axis], upper[axis], 1);
    }
    pls_bodies_free(&s.bodies);
}

static void dissipation_is_shared_by_groups_without_loss(void **state)
{
    (void)state;
    setting s;
    begin(&s, 3);
    for (uint32_t k = 0; k < 10; ++k)
    {
        uint32_t row = add(&s, pls_vec(k, 0, 0), k == 3 ? (double)INFINITY : 0.5, 1, 1 + k % 2);
        s.bodies.damped[row] = k;
        s.bodies.slid[row] = 100 * k;
    }
    double damped = 0;
    double slid = 0;
    for (uint32_t group = 1; group <= 2; ++group)
    {
        s.selection.group = group;
        pls_body_sums sums = body_sums(&s);
        damped += sums.damped;
        slid += sums.slid;
    }
    expect_near(damped, 45, 45);
    expect_near(slid, 4500, 4500);
    pls_bodies_free(&s.bodies);
}

static void a_pressed_pair_has_negative_normal_stress_and_a_known_tangent(void **state)
{
    (void)state;
    setting s;
    begin(&s, 3);
    uint32_t i = add(&s, pls_vec(0, 0, 0), 0.5, 1, 0);
    uint32_t j = add(&s, pls_vec(0, 0.9, 0), 0.5, 1, 0);
    pls_contact_entry entry = contact_between(&s, i, j);
    entry.normal = pls_vec(0, 1, 0);
    entry.branch = pls_vec(0, 0.9, 0);
    entry.force = pls_vec(0.3, -2, 0); // away from j, and dragged along x
    entry.stiffness = (pls_contact_stiffness){.kn = 20, .kt = 5};
    pls_contact_sums sums = contact_sums(&s, &entry, 1);
    expect_near(sums.stress[4], -1.8, 1);
    expect_near(sums.stress[3], 0.27, 1); // d_y F_x
    expect_near(sums.stress[1], 0, 1);
    expect_near(sums.fabric[4], 1, 1);
    expect_near(sums.ends, 2, 1);
    for (int k = 0; k < 81; ++k)
    {
        int a = k / 27;
        int b = k / 9 % 3;
        int c = k / 3 % 3;
        int d = k % 3;
        // only y-branches; normal y y y y, tangents x and z: x y x y, z y z y
        double expected = b == 1 && d == 1 && a == c ? 0.81 * (a == 1 ? 20 : 5) : 0;
        expect_near(sums.tangent[k], expected, 20);
    }
    pls_bodies_free(&s.bodies);
}

static void the_tangent_is_the_sum_over_an_explicit_pair_of_tangents(void **state)
{
    (void)state;
    setting s;
    begin(&s, 3);
    uint32_t i = add(&s, pls_vec(0, 0, 0), 0.5, 1, 0);
    uint32_t j = add(&s, pls_vec(1, 0, 0), 0.5, 1, 0);
    pls_contact_entry entry = contact_between(&s, i, j);
    const double n[3] = {2.0 / 3, -1.0 / 3, 2.0 / 3};
    const double t1[3] = {1.0 / 3, -2.0 / 3, -2.0 / 3};
    const double t2[3] = {2.0 / 3, 2.0 / 3, -1.0 / 3};
    const double branch[3] = {0.4, -0.3, 0.6}; // not along n, as between grains that are no spheres
    entry.normal = pls_vec(n[0], n[1], n[2]);
    entry.branch = pls_vec(branch[0], branch[1], branch[2]);
    entry.stiffness = (pls_contact_stiffness){.kn = 3, .kt = 2};
    pls_contact_sums sums = contact_sums(&s, &entry, 1);
    for (int k = 0; k < 81; ++k)
    {
        int a = k / 27;
        int c = k / 3 % 3;
        double expected = (3 * n[a] * n[c] + 2 * t1[a] * t1[c] + 2 * t2[a] * t2[c]) * branch[k / 9 % 3] * branch[k % 3];
        expect_near(sums.tangent[k], expected, 1);
    }
    pls_bodies_free(&s.bodies);
}

static void in_the_plane_there_is_one_tangent(void **state)
{
    (void)state;
    setting s;
    begin(&s, 2);
    uint32_t i = add(&s, pls_vec(0, 0, 0), 0.5, 1, 0);
    uint32_t j = add(&s, pls_vec(0.9, 0, 0), 0.5, 1, 0);
    pls_contact_entry entry = contact_between(&s, i, j);
    entry.normal = pls_vec(1, 0, 0);
    entry.branch = pls_vec(0.9, 0, 0);
    entry.stiffness = (pls_contact_stiffness){.kn = 20, .kt = 5};
    pls_contact_sums sums = contact_sums(&s, &entry, 1);
    for (int k = 0; k < 81; ++k)
    {
        double expected = k == 0 ? 0.81 * 20 : k == 30 ? 0.81 * 5 : 0; // x x x x and y x y x
        expect_near(sums.tangent[k], expected, 20);
    }
    pls_bodies_free(&s.bodies);
}

static void pairs_count_twice_and_walls_once_in_the_coordination(void **state)
{
    (void)state;
    setting s;
    begin(&s, 3);
    uint32_t wall = add(&s, pls_vec(0, 0, 0), INFINITY, INFINITY, 2);
    uint32_t a = add(&s, pls_vec(0, 0, 0.5), 0.5, 1, 1);
    uint32_t b = add(&s, pls_vec(0, 0, 1.5), 0.5, 1, 1);
    uint32_t c = add(&s, pls_vec(0, 0, 2.5), 0.5, 1, 3);
    pls_contact_entry entry[3] = {contact_between(&s, a, wall), contact_between(&s, a, b), contact_between(&s, b, c)};
    for (int k = 0; k < 3; ++k)
    {
        entry[k].energy_normal = 8;
        entry[k].energy_shear = 2;
    }
    pls_contact_sums all = contact_sums(&s, entry, 3);
    expect_near(all.contacts, 3, 1);
    expect_near(all.ends, 5, 1);
    expect_near(all.normal, 24, 1);
    expect_near(all.shear, 6, 1);

    s.selection.group = 1; // a and b: two ends each; the contact with c is none of the group's own
    pls_contact_sums own = contact_sums(&s, entry, 3);
    expect_near(own.contacts, 2, 1);
    expect_near(own.ends, 4, 1);
    expect_near(own.normal, 4 + 8 + 4, 1); // half of a contact's energy for each body

    s.selection.include_walls = false;
    expect_near(contact_sums(&s, entry, 3).contacts, 1, 1);
    expect_near(contact_sums(&s, entry, 3).ends, 4, 1);
    pls_bodies_free(&s.bodies);
}

static void a_box_holds_bodies_by_their_centre_and_contacts_by_their_point(void **state)
{
    (void)state;
    setting s;
    begin(&s, 3);
    uint32_t a = add(&s, pls_vec(0.9, 0.5, 0.5), 0.5, 1, 0);
    uint32_t b = add(&s, pls_vec(1.8, 0.5, 0.5), 0.5, 1, 0);
    s.selection.box = true;
    s.selection.upper = pls_vec(1, 1, 1);
    pls_contact_entry entry = contact_between(&s, a, b);
    entry.point = pls_vec(1.35, 0.5, 0.5);
    expect_near(body_sums(&s).bounded, 1, 1);
    expect_near(contact_sums(&s, &entry, 1).contacts, 0, 1);
    expect_near(contact_sums(&s, &entry, 1).ends, 1, 1);
    entry.point.x = 0.95;
    expect_near(contact_sums(&s, &entry, 1).contacts, 1, 1);
    pls_bodies_free(&s.bodies);
}

static void a_box_sees_periodic_images(void **state)
{
    (void)state;
    setting s;
    begin(&s, 3);
    s.domain.periodic[0] = s.domain.any_periodic = true;
    s.domain.edge[0] = 10;
    s.selection.box = true;
    s.selection.lower = pls_vec(8, 0, 0);
    s.selection.upper = pls_vec(12, 1, 1);
    const double x[5] = {1.5, 2.5, 9, 21.9, -8.5}; // images at 11.5, 12.5, 9, 11.9, 11.5
    for (int k = 0; k < 5; ++k) add(&s, pls_vec(x[k], 0.5, 0.5), 0.5, 1, 0);
    expect_near(body_sums(&s).bounded, 4, 1);
    pls_bodies_free(&s.bodies);
}

static void neither_threads_nor_the_order_in_memory_change_a_bit(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    setting s;
    begin(&s, 3);
    pls_contact_entry *entry = calloc(COUNT, sizeof *entry);
    uint32_t *old_row = calloc(COUNT, sizeof *old_row);
    assert_non_null(entry);
    assert_non_null(old_row);
    for (uint32_t k = 0; k < COUNT; ++k)
    {
        uint32_t row = add(&s, pls_vec(sin(k), cos(3.0 * k), sin(5.0 * k)), 0.1, 1 + 0.1 * sin(7.0 * k), 0);
        s.bodies.place[row].vx = sin(11.0 * k);
        s.bodies.place[row].vz = cos(13.0 * k);
        old_row[k] = (uint32_t)((k * UINT64_C(1237)) % COUNT);
    }
    for (uint32_t k = 0; k < COUNT; ++k)
    {
        entry[k] = contact_between(&s, k, (k + 1) % COUNT);
        entry[k].force = pls_vec(sin(k), cos(k), sin(2.0 * k));
        entry[k].branch = pls_vec(cos(k), sin(k), cos(2.0 * k));
    }
    assert_int_equal(pls_set_threads(1), PLS_OK);
    pls_body_sums bodies_before = body_sums(&s);
    pls_contact_sums contacts_before = contact_sums(&s, entry, COUNT);

    assert_int_equal(pls_set_threads(4), PLS_OK);
    assert_int_equal(pls_bodies_reorder(&s.bodies, old_row), PLS_OK);
    for (uint32_t k = 0; k < COUNT; ++k)
    {
        entry[k].row_i = s.bodies.row_of[entry[k].number_i];
        entry[k].row_j = s.bodies.row_of[entry[k].number_j];
    }
    pls_body_sums bodies_after = body_sums(&s);
    pls_contact_sums contacts_after = contact_sums(&s, entry, COUNT);
    assert_memory_equal(&bodies_before, &bodies_after, sizeof bodies_before);
    assert_memory_equal(&contacts_before, &contacts_after, sizeof contacts_before);
    free(old_row);
    free(entry);
    pls_bodies_free(&s.bodies);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turned_spinning_body_has_the_energy_and_momentum_of_its_principal_axes),
        cmocka_unit_test(walls_count_neither_as_bodies_nor_in_the_bounding_box),
        cmocka_unit_test(dissipation_is_shared_by_groups_without_loss),
        cmocka_unit_test(a_pressed_pair_has_negative_normal_stress_and_a_known_tangent),
        cmocka_unit_test(the_tangent_is_the_sum_over_an_explicit_pair_of_tangents),
        cmocka_unit_test(in_the_plane_there_is_one_tangent),
        cmocka_unit_test(pairs_count_twice_and_walls_once_in_the_coordination),
        cmocka_unit_test(a_box_holds_bodies_by_their_centre_and_contacts_by_their_point),
        cmocka_unit_test(a_box_sees_periodic_images),
        cmocka_unit_test(neither_threads_nor_the_order_in_memory_change_a_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
