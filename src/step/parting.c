// parting.c -- contacts that end with a loaded tangential spring.
//
// While a contact ends its normal force goes through zero, but with dashpots the cone is mu |Fn| of a force that pulls, and the spring must balance the tangential
// dashpot on it: the spring is still loaded when the grains part. What it holds is lost to motion, so it is booked as taken by sliding.
//
// The stored spring is half a step ahead of the last touching step (sphere_contact_simd.c), and so is the last half kick its force has given: the energy of the
// stored spring is what is left. Few contacts end per step. They are booked in order of body numbers, so that sums do not depend on the list.

#include "step/world.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

struct pls_parted
{
    uint32_t number_i, number_j, row_i, row_j;
    double energy; ///< [J]
};

static int by_numbers(const void *a, const void *b)
{
    const struct pls_parted *p = a, *q = b;
    if (p->number_i != q->number_i) return p->number_i < q->number_i ? -1 : 1;
    return p->number_j < q->number_j ? -1 : p->number_j > q->number_j;
}

static struct pls_parted parted_of(const pls_world *world, const pls_pair_section *section, size_t c)
{
    const pls_pair_list *list = &world->list;
    const pls_bodies *b = &world->bodies;
    const pls_law *law = &world->laws.law[section->law];
    const double *history = list->history + section->history + (c - section->first) * (size_t)section->stride;
    uint32_t i = list->row_i[c], j = list->row_j[c];
    double ri = b->place[i].radius, rj = b->place[j].radius, inv_mass = b->place[i].inv_mass + b->place[j].inv_mass, normal, shear;
    const pls_contact_point point = {.delta = 0.0,
                                     .effective_radius = section->wall ? ri : ri * rj / (ri + rj),
                                     .effective_mass = inv_mass > 0.0 ? 1.0 / inv_mass : INFINITY,
                                     .spring_squared = history[0] * history[0] + history[1] * history[1] + history[2] * history[2],
                                     .history = history + 3};
    law->ops->energy(law->constants, &point, &normal, &shear);
    return (struct pls_parted){b->kind[i].number, b->kind[j].number, i, j, shear};
}

static size_t count_ended(const pls_pair_list *list)
{
    size_t count = 0, bytes = list->count / 8, k = 0;
    for (; k + 8 <= bytes; k += 8)
    {
        uint64_t eight;
        memcpy(&eight, list->ended + k, sizeof eight);
        if (eight) count += (size_t)__builtin_popcountll(eight);
    }
    for (; k < bytes; ++k) count += (size_t)__builtin_popcount(list->ended[k]);
    return count;
}

pls_status pls_book_parted(pls_world *world)
{
    const pls_pair_list *list = &world->list;
    size_t count = count_ended(list), found = 0;
    if (count == 0) return PLS_OK;
    PLS_TRY(pls_reserve(&world->parted, &world->parted_capacity, count, sizeof *world->parted, "contacts that ended"));
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        for (size_t byte = section->first / 8; byte < (section->first + section->count + 7) / 8; ++byte)
            for (unsigned ended = list->ended[byte]; ended; ended &= ended - 1)
                world->parted[found++] = parted_of(world, section, byte * 8 + (size_t)__builtin_ctz(ended));
    }
    if (found > 1) qsort(world->parted, found, sizeof *world->parted, by_numbers);
    for (size_t k = 0; k < found; ++k)
    {
        world->bodies.energy_slid[world->parted[k].row_i] += 0.5 * world->parted[k].energy;
        world->bodies.energy_slid[world->parted[k].row_j] += 0.5 * world->parted[k].energy;
    }
    return PLS_OK;
}
