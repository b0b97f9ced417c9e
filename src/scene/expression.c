// expression.c -- the expression language on top of muparser.
//
// A scan of our own comes first. It finds the names (so that messages can say what is unknown and suggest what was meant), tells which
// variables are used, and refuses what muparser would take but a scene must not: assignment, strings, several results. muparser then only
// judges grammar; its error code and position are asked for, not its texts, which live in a static buffer.

#include "scene/expression.h"

#include "base/registry.h"
#include "base/text.h"

#include <math.h>
#include <muParserDLL.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { NAME_SIZE = 64 };

struct pls_expression
{
    muParserHandle_t parser;
    char *text;
    size_t variable_count;
    bool uses[PLS_EXPRESSION_VARIABLES];
    double values[PLS_EXPRESSION_VARIABLES]; ///< muparser reads the variables here
};

static const char *const functions[] = {"abs",  "acos", "acosh", "asin",  "asinh", "atan", "atan2", "atanh", "avg", "ceil",
                                        "cos",  "cosh", "exp",   "floor", "ln",    "log",  "log10", "log2",  "max", "min",
                                        "rint", "sign", "sin",   "sinh",  "sqrt",  "sum",  "tan",   "tanh"};
enum { FUNCTION_COUNT = sizeof functions / sizeof *functions };
static const char *const reserved[] = {"pi", "e", "t", "x", "y", "z", "vx", "vy", "vz", "r", "m", "s", "free", "auto", "all", "world"};
static const double PI = 3.14159265358979323846, EULER = 2.71828182845904523536;

/// muparser makes its tables of operators and messages on first use; compiling is rare, so one lock spares us the question whether that is
/// safe.
static pthread_mutex_t compile_lock = PTHREAD_MUTEX_INITIALIZER;

const char *const *pls_expression_functions(size_t *count)
{
    *count = FUNCTION_COUNT;
    return functions;
}

static bool is_function(const char *name)
{
    for (size_t k = 0; k < FUNCTION_COUNT; ++k)
    {
        if (strcmp(functions[k], name) == 0) return true;
    }
    return false;
}

bool pls_expression_reserved(const char *name)
{
    for (size_t k = 0; k < sizeof reserved / sizeof *reserved; ++k)
    {
        if (strcmp(reserved[k], name) == 0) return true;
    }
    return is_function(name);
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
static bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool pls_expression_is_name(const char *name)
{
    if (!is_letter(*name)) return false;
    for (; *name; ++name)
    {
        if (!is_letter(*name) && !is_digit(*name)) return false;
    }
    return true;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// the scan

typedef struct scan
{
    const char *text;
    const pls_symbols *symbols;
    pls_expression *expression;
    pls_expression_error *error;
    int depth; ///< open parentheses
} scan;

static pls_status refuse(scan *s, const char *at, const char *hint, const char *message)
{
    s->error->offset = (size_t)(at - s->text);
    snprintf(s->error->hint, sizeof s->error->hint, "%s", hint);
    return pls_fail(PLS_EXPRESSION, "%s in the expression \"%s\"", message, s->text);
}

/// "did you mean 'kn'?  (names here: kn, v, t)"
static void suggest_name(scan *s, const char *name, bool function)
{
    const char *candidates[PLS_EXPRESSION_VARIABLES + FUNCTION_COUNT + 256];
    size_t count = 0;
    const pls_symbols *symbols = s->symbols;
    if (function)
    {
        for (size_t k = 0; k < FUNCTION_COUNT; ++k) candidates[count++] = functions[k];
    }
    else
    {
        for (size_t k = 0; k < symbols->variable_count; ++k) candidates[count++] = symbols->variables[k];
        for (size_t k = 0; k < symbols->constant_count && count < 250; ++k) candidates[count++] = symbols->constants[k].name;
        candidates[count++] = "pi";
        candidates[count++] = "e";
    }
    const char *nearest = pls_nearest_word(name, candidates, count);
    char *hint = s->error->hint;
    size_t size = sizeof s->error->hint, used = 0;
    if (nearest) used += (size_t)snprintf(hint, size, "did you mean '%s'?  ", nearest);
    used += (size_t)snprintf(hint + used, size - used, "(%s here: ", function ? "functions" : "names");
    for (size_t k = 0; k < count; ++k)
    {
        if (used + strlen(candidates[k]) + 8 > size)
        {
            used += (size_t)snprintf(hint + used, size - used, ", ...");
            break;
        }
        used += (size_t)snprintf(hint + used, size - used, "%s%s", k ? ", " : "", candidates[k]);
    }
    if (used + 1 < size) snprintf(hint + used, size - used, ")");
}

static bool known_constant(const pls_symbols *symbols, const char *name)
{
    if (strcmp(name, "pi") == 0 || strcmp(name, "e") == 0) return true;
    for (size_t k = 0; k < symbols->constant_count; ++k)
    {
        if (strcmp(symbols->constants[k].name, name) == 0) return true;
    }
    return false;
}

static pls_status scan_name(scan *s, const char **at)
{
    const char *begin = *at, *end = begin;
    while (is_letter(*end) || is_digit(*end)) ++end;
    *at = end;
    char name[NAME_SIZE], message[NAME_SIZE + 64];
    size_t size = (size_t)(end - begin);
    if (size >= sizeof name) return refuse(s, begin, "", "a name of more than 63 characters");
    memcpy(name, begin, size);
    name[size] = '\0';

    while (*end == ' ') ++end;
    bool function = *end == '(';
    if (function && is_function(name)) return PLS_OK;
    if (!function)
    {
        if (is_function(name))
        {
            snprintf(message, sizeof message, "the function '%s' has no arguments", name);
            snprintf(s->error->hint, sizeof s->error->hint, "write %s(...)", name);
            s->error->offset = (size_t)(begin - s->text);
            return pls_fail(PLS_EXPRESSION, "%s in the expression \"%s\"", message, s->text);
        }
        for (size_t k = 0; k < s->symbols->variable_count; ++k)
        {
            if (strcmp(s->symbols->variables[k], name) != 0) continue;
            s->expression->uses[k] = true;
            return PLS_OK;
        }
        if (known_constant(s->symbols, name)) return PLS_OK;
    }
    suggest_name(s, name, function);
    s->error->offset = (size_t)(begin - s->text);
    return pls_fail(PLS_EXPRESSION, "unknown %s '%s' in the expression \"%s\"", function ? "function" : "name", name, s->text);
}

static pls_status scan_number(scan *s, const char **at)
{
    const char *c = *at;
    while (is_digit(*c) || *c == '.') ++c;
    if (*c == 'e' || *c == 'E')
    {
        const char *exponent = c + 1;
        if (*exponent == '+' || *exponent == '-') ++exponent;
        if (is_digit(*exponent))
        {
            c = exponent;
            while (is_digit(*c)) ++c;
        }
    }
    char number[512];
    double value;
    snprintf(number, sizeof number, "%.*s", (int)(c - *at), *at);
    if (!pls_parse_double(number, &value)) return refuse(s, *at, "", "a number that is misspelt or too large");
    if (is_letter(*c)) return refuse(s, c, "write the operator, as in 2*x", "a name directly behind a number");
    *at = c;
    return PLS_OK;
}

static pls_status scan_text(scan *s)
{
    for (const char *c = s->text; *c;)
    {
        bool comparison = (c[0] == '=' || c[0] == '<' || c[0] == '>' || c[0] == '!') && c[1] == '=';
        if (comparison)
        {
            c += 2;
            continue;
        }
        if (is_letter(*c))
        {
            PLS_TRY(scan_name(s, &c));
            continue;
        }
        if (is_digit(*c) || (*c == '.' && is_digit(c[1])))
        {
            PLS_TRY(scan_number(s, &c));
            continue;
        }
        if (*c == '=') return refuse(s, c, "compare with ==; a value is given by its own key", "assignment '=' is not allowed");
        if (*c == '"' || *c == '\'') return refuse(s, c, "", "a text is not allowed");
        if (*c == ',' && s->depth == 0)
            return refuse(s, c, "a list of numbers is written as [1, 2]; the decimal sign is a point", "a second result");
        if (!strchr(" \t\n+-*/^()<>?:&|,", *c)) return refuse(s, c, "", "an unknown character");
        if (*c == '(') ++s->depth;
        if (*c == ')') --s->depth;
        if (s->depth < 0) return refuse(s, c, "", "a ')' without '('");
        ++c;
    }
    if (s->depth > 0) return refuse(s, s->text + strlen(s->text), "", "a missing ')'");
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// muparser

/// What muparser's error codes (EErrorCodes in muParserDef.h) mean in our words.
static const char *describe_code(int code)
{
    switch (code)
    {
        case 0: return "a misplaced operator";
        case 2: return "an unfinished expression";
        case 3: return "a misplaced ','";
        case 5: return "a misplaced number";
        case 6: return "a misplaced name";
        case 7: return "a misplaced parenthesis";
        case 11: return "a missing parenthesis";
        case 12: return "a misplaced function";
        case 14: return "too many arguments";
        case 15: return "too few arguments";
        case 25: return "nothing";
        case 32: return "a misplaced '?'";
        case 33: return "a '?' without ':'";
        case 34: return "a misplaced ':'";
        default: return "something that cannot be understood";
    }
}

static bool is_variable(const pls_symbols *symbols, const char *name)
{
    for (size_t k = 0; k < symbols->variable_count; ++k)
        if (strcmp(symbols->variables[k], name) == 0) return true;
    return false;
}

static void define_symbols(pls_expression *expression, const pls_symbols *symbols)
{
    muParserHandle_t parser = expression->parser;
    mupDefineConst(parser, "pi", PI);
    mupDefineConst(parser, "e", EULER);
    mupDefineFun1(parser, "floor", floor, 1);
    mupDefineFun1(parser, "ceil", ceil, 1);
    for (size_t k = 0; k < symbols->constant_count; ++k) // a variable hides a constant of its name
        if (!is_variable(symbols, symbols->constants[k].name))
            mupDefineConst(parser, symbols->constants[k].name, symbols->constants[k].value);
    for (size_t k = 0; k < symbols->variable_count; ++k) mupDefineVar(parser, symbols->variables[k], &expression->values[k]);
}

static pls_status compile_text(pls_expression *expression, const pls_symbols *symbols, pls_expression_error *error)
{
    expression->parser = mupCreate(muBASETYPE_FLOAT);
    if (!expression->parser) return pls_fail(PLS_OUT_OF_MEMORY, "no memory for the expression \"%s\"", expression->text);
    define_symbols(expression, symbols);
    mupSetExpr(expression->parser, expression->text);
    if (!mupError(expression->parser)) (void)mupEval(expression->parser); // the first evaluation compiles
    if (!mupError(expression->parser)) return PLS_OK;
    int code = mupGetErrorCode(expression->parser), position = mupGetErrorPos(expression->parser);
    size_t size = strlen(expression->text);
    error->offset = position < 0 ? 0 : (size_t)position < size ? (size_t)position : size;
    return pls_fail(PLS_EXPRESSION, "%s in the expression \"%s\"", describe_code(code), expression->text);
}

pls_status pls_expression_compile(const char *text, const pls_symbols *symbols, pls_expression **expression, pls_expression_error *error)
{
    pls_expression_error ignored;
    if (!error) error = &ignored;
    *error = (pls_expression_error){0};
    *expression = NULL;
    if (strlen(text) > PLS_EXPRESSION_SIZE)
        return pls_fail(PLS_EXPRESSION, "an expression of more than %d characters", PLS_EXPRESSION_SIZE);
    if (text[strspn(text, " \t\n")] == '\0') return pls_fail(PLS_EXPRESSION, "an empty expression where a number is needed");
    if (symbols->variable_count > PLS_EXPRESSION_VARIABLES)
        return pls_fail(PLS_LIMIT_EXCEEDED, "an expression may use at most %d variables and states, not %zu", PLS_EXPRESSION_VARIABLES,
                        symbols->variable_count);

    pls_expression *made;
    PLS_TRY(pls_allocate(&made, 1, sizeof *made, "an expression"));
    made->variable_count = symbols->variable_count;
    for (size_t k = 0; k < PLS_EXPRESSION_VARIABLES; ++k) made->values[k] = 1.0;
    scan s = {.text = text, .symbols = symbols, .expression = made, .error = error};
    pls_status status = scan_text(&s);
    if (status == PLS_OK) status = pls_copy_text(&made->text, text, "an expression");
    if (status == PLS_OK)
    {
        pthread_mutex_lock(&compile_lock);
        status = compile_text(made, symbols, error);
        pthread_mutex_unlock(&compile_lock);
    }
    if (status == PLS_OK)
        *expression = made;
    else
        pls_expression_free(made);
    return status;
}

void pls_expression_free(pls_expression *expression)
{
    if (!expression) return;
    if (expression->parser) mupRelease(expression->parser);
    pls_release(&expression->text);
    pls_release(&expression);
}

bool pls_expression_uses(const pls_expression *expression, size_t k) { return k < expression->variable_count && expression->uses[k]; }

pls_status pls_expression_evaluate(pls_expression *expression, const double *values, double *result)
{
    if (expression->variable_count) memcpy(expression->values, values, expression->variable_count * sizeof *values);
    *result = mupEval(expression->parser);
    if (mupError(expression->parser))
    {
        mupErrorReset(expression->parser);
        return pls_fail(PLS_EXPRESSION, "the expression \"%s\" cannot be evaluated", expression->text);
    }
    if (isfinite(*result)) return PLS_OK;
    const char *what = isnan(*result) ? "not a number" : "infinite";
    return pls_fail(PLS_NOT_A_NUMBER, "the expression \"%s\" is %s; divide by no zero, take roots and logarithms of positive numbers only",
                    expression->text, what);
}
