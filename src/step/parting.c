// parting.c -- contacts that end with a loaded spring.
//
// While a contact ends its normal force goes through zero, but with dashpots the cone is mu |Fn| of a force that pulls, and the spring must balance the tangential
// dashpot on it: the spring is still loaded when the grains part. What it holds is lost to motion, so it is booked as taken by sliding. So is what a wall held of a
// body that it lets go of.
//
// The last force acted for half a step after the last touching step, and its spring grew meanwhile by half of this step's tangential displacement: the energy of
// the spring with that is what is left. Few contacts end per step. They are booked in order of body numbers, so that sums do not depend on the list.

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

/// Tangential relative velocity in the middle of the step (what rows hold now) of two bodies that have just parted.
static pls_vec3 slip_of(const pls_world *world, const pls_pair_section *section, size_t c)
{
    const pls_bodies *b = &world->bodies;
    uint32_t i = world->list.row_i[c], j = world->list.row_j[c];
    const pls_body_place *p = &b->place[i], *q = &b->place[j];
    pls_vec3 n, d = pls_vec(q->x - p->x, q->y - p->y, q->z - p->z), v = pls_vec(p->vx - q->vx, p->vy - q->vy, p->vz - q->vz);
    if (section->wall)
        n = pls_scale(pls_wall_normal(&b->orientation[j], world->def.dimension), -1.0);
    else
    {
        const int16_t none[3] = {0}, *s = world->domain.any_periodic ? world->list.shift[c] : none;
        const double *edge = world->domain.edge, *rate = world->domain.edge_rate;
        d = pls_add(d, pls_vec(s[0] * edge[0], s[1] * edge[1], s[2] * edge[2]));
        v = pls_sub(v, pls_vec(s[0] * rate[0], s[1] * rate[1], s[2] * rate[2]));
        n = pls_unit(d);
    }
    pls_vec3 arm_i = pls_scale(n, p->radius), arm_j = pls_sub(arm_i, d);
    v = pls_add(v, pls_cross(pls_vec(b->spin[i].wx, b->spin[i].wy, b->spin[i].wz), arm_i));
    v = pls_sub(v, pls_cross(pls_vec(b->spin[j].wx, b->spin[j].wy, b->spin[j].wz), arm_j));
    return pls_sub(v, pls_scale(n, pls_dot(v, n)));
}

/// Overlap a contact still had when it ended: none, but at a wall that let go of a body.
static double overlap_left(const pls_world *world, const pls_pair_section *section, size_t c)
{
    if (!section->wall) return 0.0;
    const pls_bodies *b = &world->bodies;
    uint32_t i = world->list.row_i[c], j = world->list.row_j[c];
    const pls_body_place *p = &b->place[i], *q = &b->place[j];
    pls_vec3 n = pls_wall_normal(&b->orientation[j], world->def.dimension);
    return fmax(0.0, p->radius - pls_dot(n, pls_vec(p->x - q->x, p->y - q->y, p->z - q->z)));
}

static struct pls_parted parted_of(const pls_world *world, const pls_pair_section *section, size_t c)
{
    const pls_pair_list *list = &world->list;
    const pls_bodies *b = &world->bodies;
    const pls_law *law = &world->laws.law[section->law];
    double history[3 + PLS_LAW_MAX_HISTORY];
    pls_pair_history_read(list, section, c, history);
    uint32_t i = list->row_i[c], j = list->row_j[c];
    double ri = b->place[i].radius, rj = b->place[j].radius, inv_mass = b->load[i].inv_mass + b->load[j].inv_mass, normal, shear;
    pls_vec3 spring = pls_add(pls_vec(history[0], history[1], history[2]), pls_scale(slip_of(world, section, c), 0.5 * world->dt));
    const pls_contact_point point = {.delta = overlap_left(world, section, c),
                                     .effective_radius = section->wall ? ri : ri * rj / (ri + rj),
                                     .effective_mass = inv_mass > 0.0 ? 1.0 / inv_mass : INFINITY,
                                     .spring_squared = pls_dot(spring, spring),
                                     .history = history + 3};
    law->ops->energy(law->constants, &point, &normal, &shear);
    return (struct pls_parted){b->kind[i].number, b->kind[j].number, i, j, normal + shear};
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
        world->bodies.slid[world->parted[k].row_i] += 0.5 * world->parted[k].energy;
        world->bodies.slid[world->parted[k].row_j] += 0.5 * world->parted[k].energy;
    }
    return PLS_OK;
}
