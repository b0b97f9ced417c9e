// Collections of real worlds, against statics, kinetics and geometry.

#include "observe/lab.h"

static const double pi = 3.14159265358979323846;

static void a_column_under_a_known_force_has_the_stress_force_over_area(void **state)
{
    (void)state;
    lab l = make_column();
    const double force = kn * column_overlap;
    const double height = 4 * column_radius - COLUMN_GAPS * column_overlap;
    const double area = 1.7;
    pls_collection_def def = pls_default_collection_def();
    def.volume_kind = PLS_VOLUME_VALUE;
    def.volume = area * height;
    pls_collection c;
    done(pls_measure_collection(l.world, &def, &c));
    expect_near(c.stress[2][2], -force / area, 1e-12 * force);
    for (int k = 0; k < 8; ++k) expect_near(c.stress[k / 3][k % 3], 0, 1e-12 * force);
    expect_near(c.fabric[2][2], 1, 1e-15);
    assert_int_equal(c.contacts, 3);
    expect_near(c.coordination, 2, 0);
    expect_near(c.energy_normal, 3 * 0.5 * kn * column_overlap * column_overlap, 1e-12);
    expect_near(c.energy_shear, 0, 0);

    // D_zzzz = kn sum d^2 / V, D_xzxz = kt sum d^2 / V, branches R - delta, 2 R - delta, R - delta
    const double d1 = column_radius - column_overlap;
    const double d2 = 2 * column_radius - column_overlap;
    const double squares = 2 * d1 * d1 + d2 * d2;
    expect_near(c.tangent[2][2][2][2], kn * squares / def.volume, 1e-10 * kn);
    expect_near(c.tangent[0][2][0][2], ks * squares / def.volume, 1e-10 * kn);
    expect_near(c.tangent[1][2][1][2], ks * squares / def.volume, 1e-10 * kn);
    expect_near(c.tangent[0][0][0][0], 0, 1e-10 * kn);

    def.include_walls = false; // the pair alone
    done(pls_measure_collection(l.world, &def, &c));
    expect_near(c.stress[2][2], -force * d2 / def.volume, 1e-12 * force);
    assert_int_equal(c.contacts, 1);
    expect_near(c.coordination, 2, 0);
    pls_world_destroy(l.world);
}

static void the_bounding_box_holds_the_balls_and_not_the_walls(void **state)
{
    (void)state;
    lab l = make_column();
    pls_collection_def def = pls_default_collection_def();
    pls_collection c;
    done(pls_measure_collection(l.world, &def, &c));
    const double edge = 2 * column_radius;
    const double tall = 4 * column_radius - column_overlap;
    expect_near(c.volume, edge * edge * tall, 1e-12);
    expect_near(c.porosity, 1 - 2 * pi / 6 / (edge * edge * tall), 1e-12);
    pls_world_destroy(l.world);
}

static void the_column_stays_in_equilibrium_and_so_does_its_stress(void **state)
{
    (void)state;
    lab l = make_column();
    pls_collection_def def = pls_default_collection_def();
    def.volume_kind = PLS_VOLUME_VALUE;
    def.volume = 4 * column_radius - COLUMN_GAPS * column_overlap;
    done(pls_world_run(l.world, 100));
    pls_collection c;
    done(pls_measure_collection(l.world, &def, &c));
    expect_near(c.stress[2][2], -kn * column_overlap, 1e-9);
    expect_near(c.energy_kinetic, 0, 1e-20);
    pls_world_destroy(l.world);
}

static void a_flying_spinning_ball_has_its_textbook_energy_and_momentum(void **state)
{
    (void)state;
    pls_world_def world_def = pls_default_world_def(3);
    world_def.dt = 1e-3;
    lab l = make_lab(&world_def, 0.2, 3);
    add_ball(&l, "", pls_vec(1, 2, 3), pls_vec(3, 4, 12), pls_vec(1, -2, 2));
    done(pls_world_add_gravity(l.world, pls_vec(0, 0, -9.81)));
    pls_collection_def def = pls_default_collection_def();
    pls_collection c;
    done(pls_world_prepare(l.world));
    done(pls_measure_collection(l.world, &def, &c));
    const double mass = 3 * 4.0 / 3 * pi * 0.008;
    const double inertia = 0.4 * mass * 0.04;
    assert_int_equal(c.bodies, 1);
    expect_near(c.mass, mass, 1e-15);
    expect_near(c.energy_kinetic, 0.5 * mass * 169, 1e-13);
    expect_near(c.energy_rotation, 0.5 * inertia * 9, 1e-15);
    expect_near(c.energy_potential, mass * 9.81 * 3, 1e-13);
    expect_near(c.momentum.x, 3 * mass, 1e-14);
    expect_near(c.momentum.y, 4 * mass, 1e-14);
    expect_near(c.momentum.z, 12 * mass, 1e-14);
    // (1, 2, 3) x (3, 4, 12) = (12, -3, -2)
    expect_near(c.angular_momentum.x, 12 * mass + inertia, 1e-13);
    expect_near(c.angular_momentum.y, -3 * mass - 2 * inertia, 1e-13);
    expect_near(c.angular_momentum.z, -2 * mass + 2 * inertia, 1e-13);
    assert_int_equal(c.contacts, 0);
    expect_near(c.stress[0][0], 0, 0);
    expect_near(c.fabric[0][0], 0, 0);
    pls_world_destroy(l.world);
}

static pls_world_def periodic_def(double edge)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-4;
    for (int axis = 0; axis < 3; ++axis) def.periodic[axis] = true;
    def.upper = pls_vec(edge, edge, edge);
    return def;
}

static lab make_lattice(int count)
{
    pls_world_def def = periodic_def(count);
    lab l = make_lab(&def, 0.4999, 1000);
    for (int k = 0; k < count * count * count; ++k)
    {
        pls_vec3 position = pls_vec(k % count + 0.25, k / count % count + 0.25, k / count / count + 0.25);
        add_ball(&l, "lattice", position, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    }
    done(pls_world_prepare(l.world));
    return l;
}

static void a_periodic_cubic_lattice_has_the_porosity_one_minus_pi_over_six(void **state)
{
    (void)state;
    lab l = make_lattice(4);
    const double expected = 1 - pi / 6 * 0.9998 * 0.9998 * 0.9998;
    pls_collection_def def = pls_default_collection_def();
    def.volume_kind = PLS_VOLUME_PERIODIC;
    pls_collection c;
    done(pls_measure_collection(l.world, &def, &c));
    expect_near(c.volume, 64, 1e-12);
    expect_near(c.porosity, expected, 1e-12);

    // so has any box whose edges are whole numbers of cells, wherever it lies: also across the periodic faces
    def.volume_kind = PLS_VOLUME_BOX;
    const pls_vec3 corner[4] = {{0.25, 0.25, 0.25}, {0.9, 0.1, 0.4}, {2.6, 3.1, 2.9}, {-0.3, 0.7, 3.3}};
    for (int k = 0; k < 4; ++k)
    {
        def.lower = corner[k];
        def.upper = pls_add(corner[k], pls_vec(2, 1, 3));
        done(pls_measure_collection(l.world, &def, &c));
        expect_near(c.volume, 6, 1e-12);
        assert_int_equal(c.bodies, 6); // of 64, those with their centre inside
        expect_near(c.mass, 6 * 1000 * 4 * pi / 3 * 0.4999 * 0.4999 * 0.4999, 1e-9);
        expect_near(c.porosity, expected, 1e-3);
    }
    pls_world_destroy(l.world);
}

static void a_compressed_periodic_chain_has_force_times_length_over_volume(void **state)
{
    (void)state;
    pls_world_def world_def = periodic_def(3 * 0.98);
    world_def.periodic[1] = world_def.periodic[2] = false;
    lab l = make_lab(&world_def, 0.5, 1000);
    for (int k = 0; k < 3; ++k) add_ball(&l, "", pls_vec(0.1 + 0.98 * k, 0, 0), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    done(pls_world_prepare(l.world));
    pls_collection_def def = pls_default_collection_def();
    def.volume_kind = PLS_VOLUME_PERIODIC;
    pls_collection c;
    done(pls_measure_collection(l.world, &def, &c));
    // three contacts of overlap 0.02 in a period of 2.94, one of them across the periodic face; other edges 1 (bounding box): sigma = -F
    expect_near(c.volume, 2.94, 1e-12);
    assert_int_equal(c.contacts, 3);
    expect_near(c.coordination, 2, 0);
    expect_near(c.stress[0][0], -kn * 0.02, 1e-10);
    pls_world_destroy(l.world);
}

static void in_2d_volumes_hold_the_thickness(void **state)
{
    (void)state;
    pls_world_def world_def = pls_default_world_def(2);
    world_def.dt = 1e-4;
    world_def.thickness = 0.1;
    lab l = make_lab(&world_def, 0.5, 1000);
    add_ball(&l, "", pls_vec(0, 0, 0), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    add_ball(&l, "", pls_vec(0.98, 0, 0), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    done(pls_world_prepare(l.world));
    pls_collection_def def = pls_default_collection_def();
    pls_collection c;
    done(pls_measure_collection(l.world, &def, &c));
    expect_near(c.volume, 1.98 * 1 * 0.1, 1e-13);
    expect_near(c.stress[0][0], -kn * 0.02 * 0.98 / 0.198, 1e-9);
    expect_near(c.porosity, 1 - 2 * pi / 4 / 1.98, 1e-12);
    expect_near(c.tangent[0][0][0][0], kn * 0.98 * 0.98 / 0.198, 1e-8);
    expect_near(c.tangent[1][0][1][0], ks * 0.98 * 0.98 / 0.198, 1e-8);
    expect_near(c.tangent[2][0][2][0], 0, 0);
    pls_world_destroy(l.world);
}

static void groups_share_the_energies_of_the_world_without_loss(void **state)
{
    (void)state;
    pls_world_def world_def = pls_default_world_def(3);
    world_def.dt = 1e-4;
    lab l = make_lab(&world_def, 0.5, 1000);
    add_wall(&l, "floor", pls_vec(0, 0, 0), pls_quat_identity());
    add_ball(&l, "low", pls_vec(0, 0, 0.5), pls_vec(0.5, 0, 0), pls_vec(0, 3, 0));
    add_ball(&l, "high", pls_vec(0.1, 0, 1.499), pls_vec(-1, 0.2, -0.5), pls_vec(1, 0, 2));
    done(pls_world_add_gravity(l.world, pls_vec(0, 0, -9.81)));
    done(pls_world_run(l.world, 300));

    pls_world_figures figures;
    done(pls_world_get_figures(l.world, &figures));
    const char *const names[3] = {"floor", "low", "high"};
    pls_collection sum = {0};
    for (int k = 0; k < 3; ++k)
    {
        pls_collection_def def = pls_default_collection_def();
        pls_collection c;
        strcpy(def.group, names[k]);
        done(pls_measure_collection(l.world, &def, &c));
        sum.energy_kinetic += c.energy_kinetic;
        sum.energy_rotation += c.energy_rotation;
        sum.energy_potential += c.energy_potential;
        sum.energy_normal += c.energy_normal;
        sum.energy_shear += c.energy_shear;
        sum.energy_damped += c.energy_damped;
        sum.energy_slid += c.energy_slid;
        sum.momentum = pls_add(sum.momentum, c.momentum);
        sum.angular_momentum = pls_add(sum.angular_momentum, c.angular_momentum);
    }
    assert_true(figures.energy_slid > 0 && figures.energy_normal > 0 && figures.energy_shear > 0);
    expect_near(sum.energy_kinetic, figures.energy_kinetic, 1e-10 * figures.energy_kinetic);
    expect_near(sum.energy_rotation, figures.energy_rotation, 1e-10 * figures.energy_rotation);
    expect_near(sum.energy_potential, figures.energy_potential, 1e-10 * fabs(figures.energy_potential));
    expect_near(sum.energy_normal, figures.energy_normal, 1e-10 * figures.energy_normal);
    expect_near(sum.energy_shear, figures.energy_shear, 1e-10 * figures.energy_shear);
    expect_near(sum.energy_damped, figures.energy_damped, 0);
    expect_near(sum.energy_slid, figures.energy_slid, 1e-10 * figures.energy_slid);
    expect_near(pls_length(pls_sub(sum.momentum, figures.momentum)), 0, 1e-10 * pls_length(figures.momentum));
    expect_near(pls_length(pls_sub(sum.angular_momentum, figures.angular_momentum)), 0, 1e-10 * pls_length(figures.angular_momentum));
    pls_world_destroy(l.world);
}

static void what_makes_no_sense_is_refused_with_its_reason(void **state)
{
    (void)state;
    lab l = make_column();
    pls_collection c;
    pls_collection_def def = pls_default_collection_def();
    strcpy(def.group, "pakc");
    assert_int_equal(pls_measure_collection(l.world, &def, &c), PLS_NOT_FOUND);
    assert_string_equal(pls_last_message(), "there is no group 'pakc' (did you mean 'pack'?); there are bottom, pack, top");
    def = pls_default_collection_def();
    def.volume_kind = PLS_VOLUME_VALUE;
    assert_int_equal(pls_measure_collection(l.world, &def, &c), PLS_INVALID_ARGUMENT);
    def.volume_kind = PLS_VOLUME_PERIODIC;
    assert_int_equal(pls_measure_collection(l.world, &def, &c), PLS_INVALID_ARGUMENT);
    def.volume_kind = PLS_VOLUME_BOX;
    assert_int_equal(pls_measure_collection(l.world, &def, &c), PLS_INVALID_ARGUMENT);
    pls_world_destroy(l.world);
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_column_under_a_known_force_has_the_stress_force_over_area),
        cmocka_unit_test(the_bounding_box_holds_the_balls_and_not_the_walls),
        cmocka_unit_test(the_column_stays_in_equilibrium_and_so_does_its_stress),
        cmocka_unit_test(a_flying_spinning_ball_has_its_textbook_energy_and_momentum),
        cmocka_unit_test(a_periodic_cubic_lattice_has_the_porosity_one_minus_pi_over_six),
        cmocka_unit_test(a_compressed_periodic_chain_has_force_times_length_over_volume),
        cmocka_unit_test(in_2d_volumes_hold_the_thickness),
        cmocka_unit_test(groups_share_the_energies_of_the_world_without_loss),
        cmocka_unit_test(what_makes_no_sense_is_refused_with_its_reason),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
