// law_table.c -- materials and the one table of laws per pair of materials.

#include "law/law_table.h"

#include "base/alloc.h"

#include <stdio.h>
#include <string.h>

pls_status pls_law_table_add_material(pls_law_table *table, const char *name, const pls_material_values *values, uint16_t *index)
{
    size_t count = table->material_count;
    if (count + 1 >= PLS_NO_LAW) return pls_fail(PLS_LIMIT_EXCEEDED, "a world holds at most %d materials", PLS_NO_LAW - 1);
    PLS_TRY(pls_reserve(&table->material, &table->material_capacity, count + 1, sizeof *table->material, "materials"));
    uint16_t *grown = NULL;
    PLS_TRY(pls_allocate(&grown, (count + 1) * (count + 1), sizeof *grown, "the table of laws"));
    for (size_t a = 0; a <= count; ++a)
        for (size_t b = 0; b <= count; ++b)
            grown[a * (count + 1) + b] = a < count && b < count ? table->of_pair[a * count + b] : PLS_NO_LAW;
    pls_release(&table->of_pair);
    table->of_pair = grown;
    snprintf(table->material[count].name, sizeof table->material[count].name, "%s", name);
    table->material[count].values = *values;
    *index = (uint16_t)count;
    table->material_count = count + 1;
    return PLS_OK;
}

pls_status pls_law_table_prepare(pls_law_table *table, uint16_t index)
{
    pls_law *law = &table->law[index];
    const pls_material *a = &table->material[law->material[0]], *b = &table->material[law->material[1]];
    double constants[PLS_LAW_MAX_CONSTANTS] = {0};
    char owner[3 * PLS_NAME_SIZE];
    snprintf(owner, sizeof owner, "law '%s' between '%s' and '%s'", law->ops->name, a->name, b->name);
    PLS_TRY(pls_parameters_check(law->ops->parameters, law->values, owner));
    pls_status status = law->ops->prepare(law->values, &a->values, &b->values, constants);
    if (status != PLS_OK) return pls_fail_context(status, "%s: ", owner);
    memcpy(law->constants, constants, sizeof constants);
    return PLS_OK;
}

pls_status pls_law_table_prepare_material(pls_law_table *table, uint16_t material)
{
    for (size_t k = 0; k < table->law_count; ++k)
        if (table->law[k].material[0] == material || table->law[k].material[1] == material)
            PLS_TRY(pls_law_table_prepare(table, (uint16_t)k));
    return PLS_OK;
}

pls_status pls_law_table_set(pls_law_table *table, uint16_t a, uint16_t b, const pls_law_ops *ops, const double *values, uint16_t *index)
{
    if (a >= table->material_count || b >= table->material_count) return pls_fail(PLS_INVALID_ARGUMENT, "a law's material does not exist");
    if (!ops || !ops->prepare || !ops->evaluate || !ops->stiffness || !ops->energy || !ops->parameters)
        return pls_fail(PLS_INVALID_ARGUMENT, "contact law '%s' lacks one of parameters, prepare, evaluate, stiffness, energy",
                        ops ? ops->name : "");
    if (ops->api_version != PLS_API_VERSION)
        return pls_fail(PLS_VERSION, "contact law '%s' is made for API %u, this library has %d: compile it anew", ops->name,
                        ops->api_version, PLS_API_VERSION);
    if (ops->history < 0 || ops->history > PLS_LAW_MAX_HISTORY || pls_parameter_values(ops->parameters) > PLS_MAX_PARAMETERS)
        return pls_fail(PLS_INVALID_ARGUMENT, "contact law '%s' wants %d history numbers and %d parameters; at most %d and %d are there",
                        ops->name, ops->history, pls_parameter_values(ops->parameters), PLS_LAW_MAX_HISTORY, PLS_MAX_PARAMETERS);
    uint16_t place = pls_law_table_find(table, a, b);
    bool is_new = place == PLS_NO_LAW;
    if (is_new)
    {
        if (table->law_count + 1 >= PLS_NO_LAW) return pls_fail(PLS_LIMIT_EXCEEDED, "a world holds at most %d laws", PLS_NO_LAW - 1);
        PLS_TRY(pls_reserve(&table->law, &table->law_capacity, table->law_count + 1, sizeof *table->law, "contact laws"));
        place = (uint16_t)table->law_count;
    }
    pls_law before = table->law[place], *law = &table->law[place];
    *law = (pls_law){.ops = ops,
                     .material = {a, b},
                     .lever_at_surface = !is_new && before.lever_at_surface,
                     .narrow = is_new ? pls_default_narrow_options() : before.narrow};
    if (values)
        memcpy(law->values, values, (size_t)pls_parameter_values(ops->parameters) * sizeof *values);
    else
        pls_parameters_default(ops->parameters, law->values);
    pls_status status = pls_law_table_prepare(table, place);
    if (status != PLS_OK)
    {
        *law = before;
        return status;
    }
    if (is_new) ++table->law_count;
    table->of_pair[(size_t)a * table->material_count + b] = place;
    table->of_pair[(size_t)b * table->material_count + a] = place;
    *index = place;
    return PLS_OK;
}

void pls_law_table_free(pls_law_table *table)
{
    pls_release(&table->material);
    pls_release(&table->law);
    pls_release(&table->of_pair);
    memset(table, 0, sizeof *table);
}
