// Columns of collections and tracked bodies: names, units, values, and what happens when bodies come and go.

#include "observe/series.h"
#include "observe/lab.h"

#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static size_t column_of(const pls_series *series, const char *name)
{
    for (size_t k = 0; k < series->column_count; ++k)
    {
        if (strcmp(series->columns[k].name, name) == 0) return k;
    }
    print_message("no column %s\n", name);
    fail();
    return 0;
}

static void a_collection_series_has_all_components_under_their_names(void **state)
{
    (void)state;
    lab l = make_column();
    pls_collection_def def = pls_default_collection_def();
    def.volume_kind = PLS_VOLUME_VALUE;
    def.volume = 1.94;
    pls_series series;
    done(pls_series_collection(l.world, &def, &series));
    assert_int_equal(series.column_count, 9 + 81 + 9 + 2 + 8 + 6 + 1 + 2 + 1);
    assert_string_equal(series.columns[0].name, "sigma_xx");
    assert_string_equal(series.columns[0].unit, "Pa");
    assert_string_equal(series.columns[8].name, "sigma_zz");
    assert_string_equal(series.columns[9].name, "D_xxxx");
    assert_string_equal(series.columns[9 + 81].name, "fabric_xx");
    double *values = calloc(series.column_count, sizeof *values);
    done(series.values(series.context, l.world, values));
    const double energy = 1.5 * kn * column_overlap * column_overlap;
    expect_near(values[column_of(&series, "sigma_zz")], -kn * column_overlap, 1e-10);
    expect_near(values[column_of(&series, "D_xzxz")], ks * (2 * 0.48 * 0.48 + 0.98 * 0.98) / 1.94, 1e-9);
    expect_near(values[column_of(&series, "fabric_zz")], 1, 1e-15);
    expect_near(values[column_of(&series, "coordination")], 2, 0);
    expect_near(values[column_of(&series, "contacts")], 3, 0);
    expect_near(values[column_of(&series, "energy_normal")], energy, 1e-12);
    expect_near(values[column_of(&series, "energy_total")], energy, 1e-12);
    expect_near(values[column_of(&series, "momentum_z")], 0, 0);
    expect_near(values[column_of(&series, "angular_momentum_x")], 0, 0);
    expect_near(values[column_of(&series, "bodies")], 2, 0);
    expect_near(values[column_of(&series, "mass")], 2 * 1000 * pi / 6, 1e-9);
    expect_near(values[column_of(&series, "volume")], 1.94, 0);
    free(values);
    pls_series_free(&series);
    pls_world_destroy(l.world);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void a_collection_series_in_2d_leaves_out_what_does_not_exist(void **state)
{
    (void)state;
    pls_world_def world_def = pls_default_world_def(2);
    world_def.dt = 1e-4;
    lab l = make_lab(&world_def, 0.5, 1000);
    add_ball(&l, "", pls_vec(0, 0, 0), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    pls_collection_def def = pls_default_collection_def();
    pls_series series;
    done(pls_series_collection(l.world, &def, &series));
    assert_int_equal(series.column_count, 4 + 16 + 4 + 2 + 8 + 3 + 1 + 2 + 1);
    const char *const names[5] = {"sigma_xx", "sigma_xy", "sigma_yx", "sigma_yy", "D_xxxx"};
    for (size_t k = 0; k < 5; ++k) assert_string_equal(series.columns[k].name, names[k]);
    column_of(&series, "angular_momentum_z");
    pls_series_free(&series);
    pls_world_destroy(l.world);
}

static pls_particle_def track(const char *group, const char *first, const char *second)
{
    pls_particle_def def = {.quantity_count = 2};
    strcpy(def.group, group);
    strcpy(def.quantities[0], first);
    strcpy(def.quantities[1], second);
    return def;
}

static void one_tracked_body_has_plain_columns(void **state)
{
    (void)state;
    lab l = make_column();
    pls_particle_def def = track("top", "position", "force");
    pls_series series;
    done(pls_series_particle(l.world, &def, &series));
    assert_int_equal(series.column_count, 6);
    assert_string_equal(series.columns[0].name, "position_x");
    assert_string_equal(series.columns[0].unit, "m");
    assert_string_equal(series.columns[5].name, "force_z");
    assert_string_equal(series.columns[5].unit, "N");
    double values[6];
    done(series.values(series.context, l.world, values));
    expect_near(values[2], 4 * column_radius - COLUMN_GAPS * column_overlap, 1e-15);
    expect_near(values[5], kn * column_overlap, 1e-10); // the ball presses the plate upwards
    pls_series_free(&series);
    pls_world_destroy(l.world);
    assert_int_equal(pls_memory_in_use(), 0);
}

static void several_tracked_bodies_are_numbered_within_their_group(void **state)
{
    (void)state;
    lab l = make_column();
    pls_particle_def def = track("pack", "radius", "orientation");
    pls_series series;
    done(pls_series_particle(l.world, &def, &series));
    const char *const names[10] = {"0.radius", "0.orientation_w", "0.orientation_x", "0.orientation_y", "0.orientation_z",
                                   "1.radius", "1.orientation_w", "1.orientation_x", "1.orientation_y", "1.orientation_z"};
    assert_int_equal(series.column_count, 10);
    for (size_t k = 0; k < 10; ++k) assert_string_equal(series.columns[k].name, names[k]);
    double values[10];
    done(series.values(series.context, l.world, values));
    expect_near(values[0], column_radius, 0);
    expect_near(values[6], 1, 0);
    pls_series_free(&series);

    strcpy(def.group, "all"); // of all entries, in the order in which they were added
    done(pls_series_particle(l.world, &def, &series));
    assert_int_equal(series.column_count, 5 * pls_world_body_count(l.world));
    pls_series_free(&series);
    pls_world_destroy(l.world);
}

static void a_removed_body_leaves_nan_also_when_its_number_is_given_again(void **state)
{
    (void)state;
    pls_world_def world_def = pls_default_world_def(3);
    world_def.dt = 1e-4;
    lab l = make_lab(&world_def, 0.5, 1000);
    pls_body_id first = add_ball(&l, "pack", pls_vec(0, 0, 0), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    add_ball(&l, "pack", pls_vec(5, 6, 7), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    pls_particle_def def = track("pack", "position", "scale");
    pls_series series;
    double values[8];
    done(pls_series_particle(l.world, &def, &series));
    done(pls_world_remove_body(l.world, first));
    for (int k = 0; k < 2; ++k)
    {
        done(series.values(series.context, l.world, values));
        for (int c = 0; c < 4; ++c) assert_true(isnan(values[c]));
        expect_near(values[4], 5, 0);
        expect_near(values[7], 1, 0);
        add_ball(&l, "pack", pls_vec(9, 9, 9), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    }
    pls_series_free(&series);
    pls_world_destroy(l.world);
}

static void an_unknown_group_or_quantity_is_named_with_what_there_is(void **state)
{
    (void)state;
    lab l = make_column();
    pls_series series;
    pls_particle_def def = track("topp", "position", "force");
    assert_int_equal(pls_series_particle(l.world, &def, &series), PLS_NOT_FOUND);
    assert_string_equal(pls_last_message(), "there is no group 'topp' (did you mean 'top'?); there are bottom, pack, top");
    def = track("top", "positon", "force");
    assert_int_equal(pls_series_particle(l.world, &def, &series), PLS_NOT_FOUND);
    const char *start = "bodies have no quantity 'positon' (did you mean 'position'?); there are ";
    assert_memory_equal(pls_last_message(), start, strlen(start));
    pls_collection_def collection = pls_default_collection_def();
    collection.volume_kind = PLS_VOLUME_BOX; // of no extent
    assert_int_equal(pls_series_collection(l.world, &collection, &series), PLS_INVALID_ARGUMENT);
    def.quantity_count = 0;
    assert_int_equal(pls_series_particle(l.world, &def, &series), PLS_INVALID_ARGUMENT);
    pls_world_destroy(l.world);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// Allocations that may still succeed; negative: all.
static int allocations_left = -1;

static void *limited_allocate(void *context, size_t size, size_t alignment)
{
    (void)context;
    if (allocations_left == 0) return NULL;
    if (allocations_left > 0) --allocations_left;
    return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

static void limited_release(void *context, void *block, size_t size)
{
    (void)context;
    (void)size;
    free(block);
}

static pls_status make_and_read(pls_world *world, bool particle, double *values)
{
    pls_series series;
    pls_particle_def tracked = track("pack", "position", "force");
    pls_collection_def def = pls_default_collection_def();
    PLS_TRY(particle ? pls_series_particle(world, &tracked, &series) : pls_series_collection(world, &def, &series));
    pls_status status = series.values(series.context, world, values);
    pls_series_free(&series);
    return status;
}

static void memory_that_runs_out_anywhere_is_reported_and_nothing_leaks(void **state)
{
    (void)state;
    const pls_allocator limited = {.allocate = limited_allocate, .release = limited_release};
    done(pls_set_allocator(&limited));
    lab l = make_column();
    const size_t before = pls_memory_in_use();
    double values[256];
    for (int particle = 0; particle < 2; ++particle)
    {
        int failures = 0;
        pls_status status = PLS_OUT_OF_MEMORY;
        while (status != PLS_OK)
        {
            allocations_left = failures;
            status = make_and_read(l.world, particle == 1, values);
            allocations_left = -1;
            if (status != PLS_OK) assert_int_equal(status, PLS_OUT_OF_MEMORY);
            assert_int_equal(pls_memory_in_use(), before);
            failures += status != PLS_OK;
        }
        assert_true(failures >= 3); // particle: observer, bodies, columns; collection: more
    }
    pls_world_destroy(l.world);
    done(pls_set_allocator(NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_collection_series_has_all_components_under_their_names),
        cmocka_unit_test(a_collection_series_in_2d_leaves_out_what_does_not_exist),
        cmocka_unit_test(one_tracked_body_has_plain_columns),
        cmocka_unit_test(several_tracked_bodies_are_numbered_within_their_group),
        cmocka_unit_test(a_removed_body_leaves_nan_also_when_its_number_is_given_again),
        cmocka_unit_test(an_unknown_group_or_quantity_is_named_with_what_there_is),
        cmocka_unit_test(memory_that_runs_out_anywhere_is_reported_and_nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
