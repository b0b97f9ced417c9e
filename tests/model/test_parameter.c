// test_parameter.c -- tables of named numbers.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <particls/parameter.h>
#include <string.h>

static const pls_parameter table[] = {
    {.name = "kn",
     .unit = "N/m",
     .meaning = "normal stiffness",
     .initial = PLS_REQUIRED,
     .minimum = 0.0,
     .maximum = INFINITY,
     .open_minimum = true},
    {.name = "half_size", .unit = "m", .meaning = "half edges", .initial = 1.0, .minimum = 0.0, .maximum = 10.0, .components = 3},
    {.name = "friction", .unit = "", .meaning = "Coulomb", .initial = 0.25, .minimum = 0.0, .maximum = 1.0},
    {.name = NULL},
};

static void a_vector_takes_three_places(void **state)
{
    (void)state;
    assert_int_equal(pls_parameter_values(table), 5);
    assert_int_equal(pls_parameter_find(table, "kn"), 0);
    assert_int_equal(pls_parameter_find(table, "half_size"), 1);
    assert_int_equal(pls_parameter_find(table, "friction"), 4);
    assert_int_equal(pls_parameter_find(table, "frictio"), -1);
}

static void no_table_has_no_values(void **state)
{
    (void)state;
    assert_int_equal(pls_parameter_values(NULL), 0);
    assert_int_equal(pls_parameter_find(NULL, "kn"), -1);
    assert_int_equal(pls_parameters_check(NULL, NULL, "nothing"), PLS_OK);
}

static void defaults_fill_vectors_and_leave_required_values_open(void **state)
{
    (void)state;
    double values[5] = {0};
    pls_parameters_default(table, values);
    assert_true(isnan(values[0]));
    for (int k = 1; k < 4; ++k) assert_true(values[k] == 1.0);
    assert_true(values[4] == 0.25);
}

static void values_within_their_ranges_pass(void **state)
{
    (void)state;
    const double least[5] = {1e-300, 0.0, 0.0, 0.0, 0.0}, most[5] = {1e300, 10.0, 10.0, 10.0, 1.0};
    assert_int_equal(pls_parameters_check(table, least, "law 'x'"), PLS_OK);
    assert_int_equal(pls_parameters_check(table, most, "law 'x'"), PLS_OK);
}

static void assert_refused(const double values[5], const char *message)
{
    assert_int_equal(pls_parameters_check(table, values, "law 'x'"), PLS_INVALID_ARGUMENT);
    assert_string_equal(pls_last_message(), message);
}

static void messages_name_the_parameter_the_value_and_the_range(void **state)
{
    (void)state;
    assert_refused((double[]){0.0, 1, 1, 1, 0}, "law 'x': 'kn' must be greater than 0 N/m, not 0");
    assert_refused((double[]){NAN, 1, 1, 1, 0}, "law 'x': the parameter 'kn' (normal stiffness) must be given");
    assert_refused((double[]){INFINITY, 1, 1, 1, 0}, "law 'x': 'kn' must be a finite number, not inf");
    assert_refused((double[]){1, 1, 1, -2, 0}, "law 'x': 'half_size[2]' must be at least 0 and at most 10 m, not -2");
    assert_refused((double[]){1, 1, NAN, 1, 0}, "law 'x': 'half_size[1]' must be a finite number, not nan");
    assert_refused((double[]){1, 1, 1, 1, 1.5}, "law 'x': 'friction' must be at least 0 and at most 1, not 1.5");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_vector_takes_three_places),
        cmocka_unit_test(no_table_has_no_values),
        cmocka_unit_test(defaults_fill_vectors_and_leave_required_values_open),
        cmocka_unit_test(values_within_their_ranges_pass),
        cmocka_unit_test(messages_name_the_parameter_the_value_and_the_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
