// formula.c -- vectors of expressions for many threads.
//
// muparser reads variables from fixed addresses, so one compiled expression serves one thread. A formula keeps a pool of compiled copies: a
// thread takes one, evaluates a batch, gives it back. The lock is held for a few instructions per batch.

#include "scene/expression.h"

#include "base/text.h"

#include <pthread.h>
#include <string.h>

struct pls_formula_copy
{
    pls_formula_copy *next;      ///< in the pool
    pls_expression **expression; ///< null where the text is a plain number
};

struct pls_formula
{
    pthread_mutex_t lock;
    pls_formula_copy *pool;
    size_t references;
    size_t count;
    char **text;
    double *number; ///< value of texts that are plain numbers
    bool *is_number;
    char **names;          ///< own copies of all names: of the variables
    char **constant_names; ///< and of the constants
    pls_constant *constants;
    pls_symbols symbols; ///< made of these
};

static void free_copy(pls_formula_copy *copy, size_t count)
{
    if (!copy) return;
    for (size_t k = 0; k < count && copy->expression; ++k) pls_expression_free(copy->expression[k]);
    pls_release(&copy->expression);
    pls_release(&copy);
}

static void free_formula(pls_formula *formula)
{
    while (formula->pool)
    {
        pls_formula_copy *copy = formula->pool;
        formula->pool = copy->next;
        free_copy(copy, formula->count);
    }
    for (size_t k = 0; k < formula->count && formula->text; ++k) pls_release(&formula->text[k]);
    for (size_t k = 0; k < formula->symbols.variable_count; ++k) pls_release(&formula->names[k]);
    for (size_t k = 0; k < formula->symbols.constant_count; ++k) pls_release(&formula->constant_names[k]);
    pls_release(&formula->names);
    pls_release(&formula->constant_names);
    pls_release(&formula->constants);
    pls_release(&formula->text);
    pls_release(&formula->number);
    pls_release(&formula->is_number);
    pthread_mutex_destroy(&formula->lock);
    pls_release(&formula);
}

static pls_status copy_symbols(pls_formula *formula, const pls_symbols *from)
{
    pls_symbols *to = &formula->symbols;
    PLS_TRY(pls_allocate(&formula->names, from->variable_count, sizeof(char *), "expression names"));
    to->variables = (const char *const *)formula->names;
    to->variable_count = from->variable_count;
    for (size_t k = 0; k < from->variable_count; ++k) PLS_TRY(pls_copy_text(&formula->names[k], from->variables[k], "an expression name"));
    PLS_TRY(pls_allocate(&formula->constants, from->constant_count, sizeof *formula->constants, "expression constants"));
    PLS_TRY(pls_allocate(&formula->constant_names, from->constant_count, sizeof(char *), "expression constants"));
    to->constants = formula->constants;
    to->constant_count = from->constant_count;
    for (size_t k = 0; k < from->constant_count; ++k)
    {
        PLS_TRY(pls_copy_text(&formula->constant_names[k], from->constants[k].name, "an expression name"));
        formula->constants[k] = (pls_constant){formula->constant_names[k], from->constants[k].value};
    }
    return PLS_OK;
}

static pls_status copy_texts(pls_formula *formula, const char *const *texts, size_t count)
{
    PLS_TRY(pls_allocate(&formula->text, count, sizeof *formula->text, "expressions"));
    formula->count = count;
    PLS_TRY(pls_allocate(&formula->number, count, sizeof *formula->number, "expressions"));
    PLS_TRY(pls_allocate(&formula->is_number, count, sizeof *formula->is_number, "expressions"));
    for (size_t k = 0; k < count; ++k)
    {
        const char *text = texts[k] ? texts[k] : "0";
        PLS_TRY(pls_copy_text(&formula->text[k], text, "an expression"));
        formula->is_number[k] = pls_parse_double(text, &formula->number[k]) != 0;
    }
    return PLS_OK;
}

pls_status pls_formula_make(const char *const *texts, size_t count, const pls_symbols *symbols, pls_formula **formula)
{
    *formula = NULL;
    pls_formula *made;
    PLS_TRY(pls_allocate(&made, 1, sizeof *made, "a formula"));
    if (pthread_mutex_init(&made->lock, NULL) != 0)
    {
        pls_release(&made);
        return pls_fail(PLS_OUT_OF_MEMORY, "no lock for a formula");
    }
    made->references = 1;
    pls_status status = copy_texts(made, texts, count);
    if (status == PLS_OK) status = copy_symbols(made, symbols);
    pls_formula_copy *copy = NULL;
    if (status == PLS_OK) status = pls_formula_begin(made, &copy); // wrong texts fail here, not in the run
    if (status == PLS_OK) pls_formula_end(made, copy);
    if (status == PLS_OK)
        *formula = made;
    else
        free_formula(made);
    return status;
}

pls_formula *pls_formula_share(pls_formula *formula)
{
    pthread_mutex_lock(&formula->lock);
    ++formula->references;
    pthread_mutex_unlock(&formula->lock);
    return formula;
}

void pls_formula_drop(pls_formula *formula)
{
    if (!formula) return;
    pthread_mutex_lock(&formula->lock);
    bool last = --formula->references == 0;
    pthread_mutex_unlock(&formula->lock);
    if (last) free_formula(formula);
}

bool pls_formula_uses(pls_formula *formula, size_t k)
{
    pls_formula_copy *copy;
    if (pls_formula_begin(formula, &copy) != PLS_OK) return true;
    bool used = false;
    for (size_t n = 0; n < formula->count; ++n) used = used || (copy->expression[n] && pls_expression_uses(copy->expression[n], k));
    pls_formula_end(formula, copy);
    return used;
}

static pls_status compile_copy(pls_formula *formula, pls_formula_copy *copy)
{
    PLS_TRY(pls_allocate(&copy->expression, formula->count, sizeof(pls_expression *), "compiled expressions"));
    for (size_t k = 0; k < formula->count; ++k)
    {
        if (formula->is_number[k]) continue;
        PLS_TRY(pls_expression_compile(formula->text[k], &formula->symbols, &copy->expression[k], NULL));
    }
    return PLS_OK;
}

pls_status pls_formula_begin(pls_formula *formula, pls_formula_copy **copy)
{
    pthread_mutex_lock(&formula->lock);
    *copy = formula->pool;
    if (*copy) formula->pool = (*copy)->next;
    pthread_mutex_unlock(&formula->lock);
    if (*copy) return PLS_OK;

    PLS_TRY(pls_allocate(copy, 1, sizeof **copy, "a compiled formula"));
    pls_status status = compile_copy(formula, *copy);
    if (status == PLS_OK) return PLS_OK;
    free_copy(*copy, formula->count);
    *copy = NULL;
    return status;
}

void pls_formula_end(pls_formula *formula, pls_formula_copy *copy)
{
    pthread_mutex_lock(&formula->lock);
    copy->next = formula->pool;
    formula->pool = copy;
    pthread_mutex_unlock(&formula->lock);
}

pls_status pls_formula_values(const pls_formula *formula, pls_formula_copy *copy, const double *variables, double *values)
{
    for (size_t k = 0; k < formula->count; ++k)
    {
        if (formula->is_number[k])
            values[k] = formula->number[k];
        else
            PLS_TRY(pls_expression_evaluate(copy->expression[k], variables, &values[k]));
    }
    return PLS_OK;
}

pls_status pls_formula_once(pls_formula *formula, const double *variables, double *values)
{
    pls_formula_copy *copy;
    PLS_TRY(pls_formula_begin(formula, &copy));
    pls_status status = pls_formula_values(formula, copy, variables, values);
    pls_formula_end(formula, copy);
    return status;
}
