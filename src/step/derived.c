// derived.c -- see derived.h.

#include "step/derived.h"

#include "base/alloc.h"
#include "bond/builtin.h"
#include "bond/elastic_plastic.h"
#include "step/bonds.h"

#include <string.h>

void pls_derived_free(pls_derived *derived)
{
    pls_release(&derived->fragment);
    pls_release(&derived->by_number);
    pls_release(&derived->temperature);
    pls_release(&derived->plastic_strain);
}

static pls_status find_fragments(const pls_world *world, pls_derived *d, const void **data)
{
    const pls_bodies *b = &world->bodies;
    PLS_TRY(pls_reserve(&d->fragment, &d->fragments, b->count, sizeof *d->fragment, "fragments of bodies"));
    PLS_TRY(pls_reserve(&d->by_number, &d->numbers, b->numbers, sizeof *d->by_number, "fragments of bodies"));
    pls_bonds_fragments(world, d->by_number);
    for (size_t row = 0; row < b->count; ++row)
    {
        const uint32_t number = b->kind[row].number;
        d->fragment[row] = d->by_number[number] == PLS_NO_FRAGMENT ? number : d->by_number[number];
    }
    *data = d->fragment;
    return PLS_OK;
}

/// What a set knows of one of its points.
typedef bool point_value(const pls_bond_set *set, uint32_t point, double *value);

static bool temperature_of(const pls_bond_set *set, uint32_t point, double *value)
{
    if (set->conditions.warmth) *value = set->conditions.warmth[point][PLS_HEAT_TEMPERATURE];
    return set->conditions.warmth != NULL;
}

static bool plastic_strain_of(const pls_bond_set *set, uint32_t point, double *value)
{
    const bool flows = set->states.ops == &pls_elastic_plastic_bonds;
    if (flows) *value = set->states.of_point[point][PLS_PLASTIC_STRAIN];
    return flows;
}

static pls_status find_values(const pls_world *world, point_value *function, double **value, size_t *capacity, const void **data)
{
    const pls_bodies *b = &world->bodies;
    PLS_TRY(pls_reserve(value, capacity, b->count, sizeof **value, "a field of bodies"));
    for (size_t row = 0; row < b->count; ++row)
    {
        const uint32_t number = b->kind[row].number;
        (*value)[row] = NAN;
        for (size_t s = 0; s < world->bond_count; ++s)
        {
            const pls_bond_set *set = &world->bond[s];
            const uint32_t point = number < set->numbers ? set->point_of[number] : PLS_NO_POINT;
            if (point != PLS_NO_POINT && function(set, point, &(*value)[row])) break;
        }
    }
    *data = *value;
    return PLS_OK;
}

pls_status pls_derive_field(const pls_world *world, const pls_field *field, pls_field_view *view)
{
    pls_derived *d = world->derived;
    *view = (pls_field_view){.stride = (size_t)field->components * pls_type_size(field->type),
                             .count = world->bodies.count,
                             .type = field->type,
                             .components = field->components};
    if (strcmp(field->name, "fragment") == 0) return find_fragments(world, d, &view->data);
    if (strcmp(field->name, "temperature") == 0) return find_values(world, temperature_of, &d->temperature, &d->temperatures, &view->data);
    if (strcmp(field->name, "plastic_strain") != 0) return pls_fail(PLS_NOT_FOUND, "nobody finds the field '%s'", field->name);
    return find_values(world, plastic_strain_of, &d->plastic_strain, &d->strains, &view->data);
}
