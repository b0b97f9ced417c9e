// test_expression.c -- the expression language: values, what it refuses, threads, allocation failures.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "scene/expression.h"
#include "support/failing_allocator.h"

#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

static const char *const variables[] = {"t", "x"};
static const pls_constant constants[] = {{"kn", 20.0}, {"e1", 7.0}};
static const pls_symbols symbols = {variables, 2, constants, 2};

/// Value at t = 2, x = -3.
static double value_of(const char *text)
{
    pls_expression *expression;
    const double at[] = {2.0, -3.0};
    double result;
    if (pls_expression_compile(text, &symbols, &expression, NULL) != PLS_OK) fail_msg("%s", pls_last_message());
    assert_int_equal(pls_expression_evaluate(expression, at, &result), PLS_OK);
    pls_expression_free(expression);
    return result;
}

static void arithmetic_follows_the_usual_rules(void **state)
{
    (void)state;
    const struct
    {
        const char *text;
        double value;
    } cases[] = {{"1 + 2*3", 7},       {"-2^2", -4},         {"2^3^2", 512},          {"(1+2)*3", 9},
                 {"kn/2", 10},         {"t*x", -6},          {"abs(x)", 3},           {"max(1, t, x)", 2},
                 {"min(1, t, x)", -3}, {"t > 1 ? 5 : 6", 5}, {"t == 2 && x != 2", 1}, {"t <= 1 || x >= 0", 0},
                 {"2*e1 + 1e1", 24},   {".5", 0.5},          {"1e-3", 1e-3},          {"floor(-1.5)", -2},
                 {"ceil(1.2)", 2},     {"t>1?x>0?1:2:3", 2}, {"rint(1.6)", 2},        {"sign(x)", -1},
                 {"avg(1, 2, 3)", 2},  {"sum(1, 2, 3)", 6}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) assert_true(value_of(cases[k].text) == cases[k].value);
}

static void functions_are_those_of_the_c_library(void **state)
{
    (void)state;
    assert_true(value_of("sin(2*pi/8)") == sin(2 * M_PI / 8));
    assert_true(value_of("exp(1) - e") < 1e-15);
    assert_true(value_of("log(kn)") == log(20.0));
    assert_true(value_of("ln(kn)") == log(20.0));
    assert_true(value_of("log10(kn)") == log10(20.0));
    assert_true(value_of("atan2(1, x)") == atan2(1, -3));
    assert_true(value_of("sqrt(t)") == sqrt(2.0));
}

static void every_listed_function_can_be_called(void **state)
{
    (void)state;
    size_t count;
    const char *const *names = pls_expression_functions(&count);
    for (size_t k = 0; k < count; ++k)
    {
        char text[64];
        snprintf(text, sizeof text, "%s(%s)", names[k],
                 strcmp(names[k], "atan2") == 0   ? "0.5, 1"
                 : strcmp(names[k], "acosh") == 0 ? "1.5"
                                                  : "0.5");
        (void)value_of(text);
        assert_true(pls_expression_reserved(names[k]));
    }
}

static void wrong_texts_are_refused_at_the_right_place(void **state)
{
    (void)state;
    const struct
    {
        const char *text;
        size_t offset;
        const char *part;
    } cases[] = {{"1 + kn2", 4, "unknown name 'kn2'"},
                 {"2*sine(1)", 2, "unknown function 'sine'"},
                 {"x = 3", 2, "assignment"},
                 {"1, 2", 1, "second result"},
                 {"\"a\"", 0, "text"},
                 {"(1", 2, "missing ')'"},
                 {"1)", 1, "without '('"},
                 {"2x", 1, "behind a number"},
                 {"1 $ 2", 2, "unknown character"},
                 {"x +", 3, "unfinished"},
                 {"x x", 2, "misplaced name"},
                 {"sin", 0, "no arguments"},
                 {"1e999", 0, "too large"},
                 {"1.2.3", 0, "misspelt"},
                 {"x += 2", 3, "assignment"},
                 {"", 0, "empty"},
                 {"  ", 0, "empty"},
                 {"0x10", 1, "behind a number"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k)
    {
        pls_expression *expression;
        pls_expression_error error;
        assert_int_equal(pls_expression_compile(cases[k].text, &symbols, &expression, &error), PLS_EXPRESSION);
        assert_null(expression);
        if (!strstr(pls_last_message(), cases[k].part)) fail_msg("%s: %s", cases[k].text, pls_last_message());
        assert_int_equal(error.offset, cases[k].offset);
    }
    assert_int_equal(pls_memory_in_use(), 0);
}

static void results_that_are_not_finite_are_errors(void **state)
{
    (void)state;
    const char *texts[] = {"1/(t-2)", "sqrt(x)", "log(0*t)", "x^0.5"};
    for (size_t k = 0; k < 4; ++k)
    {
        pls_expression *expression;
        const double at[] = {2.0, -3.0};
        double result;
        assert_int_equal(pls_expression_compile(texts[k], &symbols, &expression, NULL), PLS_OK);
        assert_int_equal(pls_expression_evaluate(expression, at, &result), PLS_NOT_A_NUMBER);
        pls_expression_free(expression);
    }
}

static void used_variables_are_known(void **state)
{
    (void)state;
    pls_expression *expression;
    assert_int_equal(pls_expression_compile("kn*x + sin(x)", &symbols, &expression, NULL), PLS_OK);
    assert_false(pls_expression_uses(expression, 0));
    assert_true(pls_expression_uses(expression, 1));
    assert_false(pls_expression_uses(expression, 2));
    pls_expression_free(expression);
}

static void long_texts_cannot_overrun_anything(void **state)
{
    (void)state;
    char text[4001];
    pls_expression *expression;
    memset(text, '(', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    assert_int_equal(pls_expression_compile(text, &symbols, &expression, NULL), PLS_EXPRESSION);
    text[900] = '\0';
    assert_int_equal(pls_expression_compile(text, &symbols, &expression, NULL), PLS_EXPRESSION);
    memset(text, 'a', 900);
    assert_int_equal(pls_expression_compile(text, &symbols, &expression, NULL), PLS_EXPRESSION);
    memset(text, '-', 900);
    text[900] = '1', text[901] = '\0';
    (void)pls_expression_compile(text, &symbols, &expression, NULL);
    pls_expression_free(expression);
}

static void the_decimal_sign_is_a_point_in_every_locale(void **state)
{
    (void)state;
    if (!setlocale(LC_NUMERIC, "de_DE.UTF-8")) skip();
    assert_true(value_of("0.5 + 0.25") == 0.75);
    setlocale(LC_NUMERIC, "C");
}

// ---------------------------------------------------------------------------------------------------------------------------------------

static void *evaluate_many(void *context)
{
    pls_formula *formula = context;
    for (int k = 0; k < 2000; ++k)
    {
        double at[] = {(double)k, 1.0}, values[3];
        if (pls_formula_once(formula, at, values) != PLS_OK) return formula;
        if (values[0] != 2.0 * k + 1.0 || values[1] != 0.0 || values[2] != 4.0) return formula;
    }
    return NULL;
}

static void a_formula_serves_several_threads_at_once(void **state)
{
    (void)state;
    const char *texts[] = {"2*t + x", NULL, "4"};
    pls_formula *formula;
    pthread_t threads[4];
    assert_int_equal(pls_formula_make(texts, 3, &symbols, &formula), PLS_OK);
    for (int k = 0; k < 4; ++k) assert_int_equal(pthread_create(&threads[k], NULL, evaluate_many, formula), 0);
    for (int k = 0; k < 4; ++k)
    {
        void *failed;
        assert_int_equal(pthread_join(threads[k], &failed), 0);
        assert_null(failed);
    }
    pls_formula_drop(pls_formula_share(formula));
    pls_formula_drop(formula);
    assert_int_equal(pls_memory_in_use(), 0);
}

static pls_status make_formula(void *context)
{
    (void)context;
    const char *texts[] = {"2*t + x", NULL, "4"};
    pls_formula *formula;
    double at[] = {1.0, 2.0}, values[3];
    PLS_TRY(pls_formula_make(texts, 3, &symbols, &formula));
    pls_status status = pls_formula_once(formula, at, values);
    pls_formula_drop(formula);
    return status;
}

static void a_formula_survives_allocation_failures(void **state)
{
    (void)state;
    failing_allocator_install();
    assert_true(assert_survives_allocation_failures(make_formula, NULL) > 10);
    failing_allocator_remove();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arithmetic_follows_the_usual_rules),       cmocka_unit_test(functions_are_those_of_the_c_library),
        cmocka_unit_test(every_listed_function_can_be_called),      cmocka_unit_test(wrong_texts_are_refused_at_the_right_place),
        cmocka_unit_test(results_that_are_not_finite_are_errors),   cmocka_unit_test(used_variables_are_known),
        cmocka_unit_test(long_texts_cannot_overrun_anything),       cmocka_unit_test(the_decimal_sign_is_a_point_in_every_locale),
        cmocka_unit_test(a_formula_serves_several_threads_at_once), cmocka_unit_test(a_formula_survives_allocation_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
