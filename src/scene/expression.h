// expression.h -- arithmetic in texts ("kn/2", "v*sin(2*pi*t)"), compiled once and evaluated many times.
//
// Numbers only: + - * / ^, comparisons, && ||, condition ? a : b, the functions of pls_expression_functions(), the constants pi and e.
// There is no assignment. Built on muparser's C interface; what that keeps in static buffers (messages, names) is never asked for.
#ifndef PLS_SCENE_EXPRESSION_H
#define PLS_SCENE_EXPRESSION_H

#include "base/alloc.h"

#include <stdbool.h>

enum {
    PLS_EXPRESSION_SIZE = 1000,   ///< longest text [bytes]
    PLS_EXPRESSION_VARIABLES = 64 ///< most variables; further names may only be constants
};

typedef struct pls_constant
{
    const char *name;
    double value;
} pls_constant;

/// The names an expression may use. Variables get a value at each evaluation, constants have one.
typedef struct pls_symbols
{
    const char *const *variables;
    size_t variable_count;
    const pls_constant *constants;
    size_t constant_count;
} pls_symbols;

/// Where and what to do, beside the message.
typedef struct pls_expression_error
{
    size_t offset; ///< bytes into the text
    char hint[320];
} pls_expression_error;

typedef struct pls_expression pls_expression;

/// EXPRESSION with a message ("unknown name 'knn'") when the text is wrong. `error` may be null.
pls_status pls_expression_compile(const char *text, const pls_symbols *symbols, pls_expression **expression, pls_expression_error *error);
void pls_expression_free(pls_expression *expression);
/// Whether the text mentions variable k.
bool pls_expression_uses(const pls_expression *expression, size_t k);
/// Value with `values` for the variables. NOT_A_NUMBER unless the result is finite. One thread at a time per expression.
pls_status pls_expression_evaluate(pls_expression *expression, const double *values, double *result);

/// Whether `name` is taken by a function, constant or variable of the language (x, t, pi, ...): such a name cannot be a variable of the
/// user.
bool pls_expression_reserved(const char *name);
/// Letters, digits and underscores, not beginning with a digit.
bool pls_expression_is_name(const char *name);
/// Names of all functions.
const char *const *pls_expression_functions(size_t *count);

// ---------------------------------------------------------------------------------------------------------------------------------------

/// A vector of expressions over the same symbols that several threads may evaluate at once: each takes a compiled copy from a pool.
typedef struct pls_formula pls_formula;

/// `texts` are copied; a null text is the number 0. The formula begins with one reference.
pls_status pls_formula_make(const char *const *texts, size_t count, const pls_symbols *symbols, pls_formula **formula);
pls_formula *pls_formula_share(pls_formula *formula);
/// Whether one of the expressions mentions variable k.
bool pls_formula_uses(pls_formula *formula, size_t k);
/// Drop one reference; the last one frees.
void pls_formula_drop(pls_formula *formula);

/// A compiled copy for this thread; give it back with pls_formula_end. Only the first use by as many threads allocates.
typedef struct pls_formula_copy pls_formula_copy;
pls_status pls_formula_begin(pls_formula *formula, pls_formula_copy **copy);
void pls_formula_end(pls_formula *formula, pls_formula_copy *copy);
/// All values for one set of variables. NOT_A_NUMBER names the expression that gave none.
pls_status pls_formula_values(const pls_formula *formula, pls_formula_copy *copy, const double *variables, double *values);
/// Begin, values, end.
pls_status pls_formula_once(pls_formula *formula, const double *variables, double *values);

#endif
