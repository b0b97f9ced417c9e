// test_own.c -- observers of one's own in a C program: columns by dimension, defaults, memory, and what is refused.

#include "observe/series.h"
#include "support/numbers.h"

#include <particls/memory.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const pls_parameter parameters[] = {
    {.name = "factor", .unit = "", .meaning = "of the time", .initial = 3.0, .minimum = 0.0, .maximum = INFINITY},
    {.name = NULL},
};

static const pls_observer_column columns[] = {
    {.name = "scaled", .unit = "s", .meaning = "factor times time"},
    {.name = "height", .unit = "m", .meaning = "of nothing", .only_3d = true},
    {.name = "unset", .meaning = "is never filled"},
    {.name = "looks", .meaning = "so far"},
    {.name = NULL},
};

static pls_status update(const pls_observer_view *view, double *memory)
{
    (void)view;
    memory[0] += 1.0;
    return PLS_OK;
}

static pls_status look(const pls_observer_view *view, const double *memory, double *row)
{
    row[0] = view->constants[0] * pls_world_time(view->world);
    row[1] = 7.0;
    row[3] = memory[0];
    return PLS_OK;
}

static const pls_observer_ops clock_ops = {
    .api_version = PLS_API_VERSION,
    .name = "clock",
    .meaning = "time, scaled",
    .parameters = parameters,
    .columns = columns,
    .memory = 1,
    .update = update,
    .look = look,
};

/// A world with one free ball and a group "pack".
static pls_world *world_with_a_ball(int dimension)
{
    pls_world_def def = pls_default_world_def(dimension);
    def.dt = 0.125;
    pls_world *world;
    assert_int_equal(pls_world_create(&def, &world), PLS_OK);
    const double radius[1] = {1.0};
    pls_shape_id ball;
    assert_int_equal(pls_world_add_shape(world, "ball", pls_builtin_shapes()[0], COUNTED(radius), &ball), PLS_OK);
    pls_material_def material = pls_default_material_def();
    strcpy(material.name, "grain");
    material.values.density = 1.0;
    pls_body_def body = pls_default_body_def();
    assert_int_equal(pls_world_add_material(world, &material, &body.material), PLS_OK);
    assert_int_equal(pls_world_add_group(world, "pack", &body.group), PLS_OK);
    body.shape = ball;
    pls_body_id id;
    assert_int_equal(pls_world_add_body(world, &body, &id), PLS_OK);
    return world;
}

static void columns_fit_the_dimension_and_what_is_not_filled_is_not_a_number(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        pls_world *world = world_with_a_ball(dimension);
        pls_own_def def = {.ops = &clock_ops};
        pls_series series;
        assert_int_equal(pls_series_own(world, &def, &series), PLS_OK);
        const size_t flat = dimension == 2 ? 1 : 0;
        assert_int_equal(series.column_count, 4 - flat);
        assert_string_equal(series.columns[1].name, flat ? "unset" : "height");
        double values[4];
        assert_int_equal(pls_world_run(world, 2), PLS_OK);
        assert_int_equal(series.update(series.context, world), PLS_OK);
        assert_int_equal(series.values(series.context, world, values), PLS_OK);
        assert_int_equal(series.values(series.context, world, values), PLS_OK); // asking again changes nothing
        assert_true(values[0] == 0.75);
        if (!flat) assert_true(values[1] == 7.0);
        assert_true(isnan(values[2 - flat]));
        assert_true(values[3 - flat] == 1.0 && series.memory[0] == 1.0 && series.memory_count == 1);
        pls_series_free(&series);
        pls_world_destroy(world);
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

static void wrong_definitions_are_refused(void **state)
{
    (void)state;
    pls_world *world = world_with_a_ball(3);
    pls_series series;
    pls_own_def def = {.ops = NULL};
    assert_int_equal(pls_series_own(world, &def, &series), PLS_INVALID_ARGUMENT);
    def = (pls_own_def){.ops = &clock_ops, .given = true, .values = {-1.0}};
    assert_int_equal(pls_series_own(world, &def, &series), PLS_INVALID_ARGUMENT);
    assert_non_null(strstr(pls_last_message(), "observer 'clock': 'factor' must be at least 0, not -1"));
    def = (pls_own_def){.ops = &clock_ops, .group = "pakc"};
    assert_int_equal(pls_series_own(world, &def, &series), PLS_NOT_FOUND);
    assert_non_null(strstr(pls_last_message(), "did you mean 'pack'?"));
    pls_observer_ops old = clock_ops;
    old.api_version = 1;
    def = (pls_own_def){.ops = &old};
    assert_int_equal(pls_series_own(world, &def, &series), PLS_VERSION);
    pls_world_destroy(world);
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(columns_fit_the_dimension_and_what_is_not_filled_is_not_a_number),
        cmocka_unit_test(wrong_definitions_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
