// force_states.c -- room for force states, and what they remember.

#include "bond/force_states.h"

#include "base/alloc.h"

#include <string.h>

static size_t slots_of(const pls_families *family) { return (size_t)family->start[family->count] * PLS_BOND_VECTOR; }

void pls_force_states_free(pls_force_states *states)
{
    pls_release(&states->constants);
    pls_release(&states->material);
    pls_release(&states->weighted);
    pls_release(&states->reference);
    pls_release(&states->correction);
    pls_release(&states->extension);
    pls_release(&states->tension);
    pls_release(&states->back);
    for (int k = 0; k < PLS_BOND_MAX_MEMORY; ++k) pls_release(&states->memory[k]);
    pls_release(&states->of_point);
    pls_release(&states->spent);
    memset(states, 0, sizeof *states);
}

pls_status pls_force_states_make(pls_force_states *states, const pls_bond_ops *ops, const pls_families *family, size_t materials)
{
    const size_t slots = slots_of(family);
    states->ops = ops;
    PLS_TRY(pls_allocate(&states->constants, materials, sizeof *states->constants, "points of bonds"));
    PLS_TRY(pls_allocate(&states->material, family->count, sizeof *states->material, "points of bonds"));
    PLS_TRY(pls_allocate(&states->weighted, family->count, sizeof *states->weighted, "points of bonds"));
    PLS_TRY(pls_allocate(&states->of_point, family->count, sizeof *states->of_point, "points of bonds"));
    PLS_TRY(pls_allocate(&states->spent, family->count, sizeof *states->spent, "points of bonds"));
    PLS_TRY(pls_allocate(&states->reference, slots, sizeof *states->reference, "bonds"));
    PLS_TRY(pls_allocate(&states->correction, slots, sizeof *states->correction, "bonds"));
    PLS_TRY(pls_allocate(&states->extension, slots, sizeof *states->extension, "bonds"));
    PLS_TRY(pls_allocate(&states->tension, slots, sizeof *states->tension, "bonds"));
    PLS_TRY(pls_allocate(&states->back, slots, sizeof *states->back, "bonds"));
    for (int k = 0; k < ops->memories; ++k) PLS_TRY(pls_allocate(&states->memory[k], slots, sizeof *states->memory[k], "bonds"));
    return PLS_OK;
}

size_t pls_force_states_bytes(const pls_force_states *states, const pls_families *family)
{
    if (!states->ops) return 0;
    const size_t per_bond = (4 + (size_t)states->ops->memories) * sizeof(double) + sizeof *states->back;
    return slots_of(family) * per_bond +
           family->count * (sizeof *states->material + sizeof *states->weighted + sizeof *states->of_point + sizeof *states->spent);
}

size_t pls_force_states_remembered(const pls_force_states *states, const pls_families *family)
{
    return states->ops ? family->bonds * (size_t)states->ops->memories + family->count * (size_t)states->ops->point_memories : 0;
}

/// What is remembered, one number after the other.
typedef void number_action(double *number, void *context);

static void each_number(const pls_force_states *states, const pls_families *family, number_action *action, void *context)
{
    for (int m = 0; m < states->ops->memories; ++m)
        for (size_t p = 0; p < family->count; ++p)
            for (size_t slot = (size_t)family->start[p] * PLS_BOND_VECTOR, k = 0; k < family->size[p]; ++k)
                action(&states->memory[m][slot + k], context);
    for (size_t p = 0; p < family->count; ++p)
        for (int m = 0; m < states->ops->point_memories; ++m) action(&states->of_point[p][m], context);
}

static void read_number(double *number, void *context)
{
    double **to = context;
    *(*to)++ = *number;
}

static void write_number(double *number, void *context)
{
    const double **from = context;
    *number = *(*from)++;
}

void pls_force_states_read(const pls_force_states *states, const pls_families *family, double *out)
{
    if (states->ops) each_number(states, family, read_number, &out);
}

void pls_force_states_write(pls_force_states *states, const pls_families *family, const double *in)
{
    if (states->ops) each_number(states, family, write_number, &in);
}
