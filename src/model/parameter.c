// parameter.c -- tables of named numbers: places, defaults and range checks.
//
// A row with `components` = 3 takes three places in the array of values, so a place is the sum of the components of the rows before it. Rows
// that are no numbers (points, a path, shapes) have no components.

#include <particls/parameter.h>

#include <stdio.h>
#include <string.h>

static int row_components(const pls_parameter *row)
{
    if (row->kind != PLS_PARAMETER_NUMBER) return 0;
    return row->components > 1 ? row->components : 1;
}

int pls_parameter_values(const pls_parameter *table)
{
    int values = 0;
    for (const pls_parameter *row = table; row && row->name; ++row) values += row_components(row);
    return values;
}

/// The component of `row` that `name` names: "wind" is the first of a vector, "wind[1]" the second; -1 when it names something else.
static int named_component(const pls_parameter *row, const char *name)
{
    size_t size = strlen(row->name);
    if (row->kind != PLS_PARAMETER_NUMBER || strncmp(row->name, name, size) != 0) return -1;
    if (name[size] == '\0') return 0;
    bool indexed = name[size] == '[' && name[size + 1] >= '0' && name[size + 1] <= '2' && strcmp(name + size + 2, "]") == 0;
    int component = indexed ? name[size + 1] - '0' : -1;
    return row_components(row) > 1 ? component : -1;
}

int pls_parameter_find(const pls_parameter *table, const char *name)
{
    int place = 0;
    for (const pls_parameter *row = table; row && row->name && name; ++row)
    {
        int component = named_component(row, name);
        if (component >= 0) return place + component;
        place += row_components(row);
    }
    return -1;
}

void pls_parameters_default(const pls_parameter *table, double *values)
{
    for (const pls_parameter *row = table; row && row->name; ++row)
    {
        for (int c = 0; c < row_components(row); ++c) *values++ = row->initial;
    }
}

/// "greater than 0", "at least 0 and at most 1", ...
static void describe_range(const pls_parameter *row, char *text, size_t size)
{
    char lower[64] = "", upper[64] = "";
    if (isfinite(row->minimum)) snprintf(lower, sizeof lower, "%s %.15g", row->open_minimum ? "greater than" : "at least", row->minimum);
    if (isfinite(row->maximum)) snprintf(upper, sizeof upper, "at most %.15g", row->maximum);
    snprintf(text, size, "%s%s%s", lower, *lower && *upper ? " and " : "", upper);
}

static pls_status check_value(const pls_parameter *row, int component, double value, const char *owner)
{
    char name[96];
    if (row_components(row) > 1)
        snprintf(name, sizeof name, "%s[%d]", row->name, component);
    else
        snprintf(name, sizeof name, "%s", row->name);

    if (isnan(value) && isnan(row->initial))
        return pls_fail(PLS_INVALID_ARGUMENT, "%s: the parameter '%s' (%s) must be given", owner, name, row->meaning);
    const char *unit = row->unit ? row->unit : "";
    if (!isfinite(value)) return pls_fail(PLS_INVALID_ARGUMENT, "%s: '%s' must be a finite number, not %g", owner, name, value);
    bool below = row->open_minimum ? value <= row->minimum : value < row->minimum;
    if (!below && value <= row->maximum) return PLS_OK;
    char range[160];
    describe_range(row, range, sizeof range);
    return pls_fail(PLS_INVALID_ARGUMENT, "%s: '%s' must be %s%s%s, not %.15g", owner, name, range, *unit ? " " : "", unit, value);
}

pls_status pls_parameters_check(const pls_parameter *table, const double *values, const char *owner)
{
    for (const pls_parameter *row = table; row && row->name; ++row)
    {
        for (int c = 0; c < row_components(row); ++c) PLS_TRY(check_value(row, c, *values++, owner));
    }
    return PLS_OK;
}
