// parting.c -- contacts that end with a loaded spring.
//
// While a contact ends its normal force goes through zero, but with dashpots the cone is mu |Fn| of a force that pulls, and the spring must balance the tangential
// dashpot on it: the spring is still loaded when the grains part. What it holds is lost to motion, so it is booked as taken by sliding. So is what a wall held of a
// body that it lets go of.
//
// The last force acted for half a step after the last touching step, and its spring grew meanwhile by half of this step's tangential displacement: the energy of
// the spring with that is what is left. Few contacts end per step. Each block of contacts is looked at while its bodies still have the velocities of mid-step; what
// was found is booked at the end of the step, in order of body numbers, so that sums do not depend on the list.

#include "step/world.h"

#include "base/alloc.h"
#include "base/sort.h"

#include <string.h>

enum { FEW_PARTED = 32 }; ///< contacts that are sorted one by one

static uint64_t key_of(const struct pls_parted *p) { return (uint64_t)p->number_i << 32 | p->number_j; }

static bool comes_before(const struct pls_parted *p, const struct pls_parted *q)
{
    if (key_of(p) != key_of(q)) return key_of(p) < key_of(q);
    if (p->part_i != q->part_i) return p->part_i < q->part_i;
    if (p->part_j != q->part_j) return p->part_j < q->part_j;
    return p->image < q->image;
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
    return (struct pls_parted){.row_i = i, .row_j = j, .energy = normal + shear};
}

static unsigned long long any_ended(const uint8_t *bytes, size_t count)
{
    unsigned long long any = 0, eight;
    for (size_t k = 0; k + 8 <= count; k += 8)
    {
        memcpy(&eight, bytes + k, sizeof eight);
        any |= eight;
    }
    for (size_t k = count / 8 * 8; k < count; ++k) any |= bytes[k];
    return any;
}

pls_status pls_find_parted(const pls_world *world, const pls_pair_block *block, pls_parted_list *found)
{
    const pls_pair_list *list = &world->list;
    const pls_pair_section *section = &list->section[block->section];
    size_t first = block->first / 8, last = (block->first + block->count + 7) / 8;
    if (!any_ended(list->ended + first, last - first)) return PLS_OK;
    PLS_TRY(pls_reserve(&found->entry, &found->capacity, found->count + block->count, sizeof *found->entry, "contacts that ended"));
    for (size_t byte = first; byte < last; ++byte)
        for (unsigned ended = list->ended[byte]; ended; ended &= ended - 1)
            found->entry[found->count++] = parted_of(world, section, byte * 8 + (size_t)__builtin_ctz(ended));
    return PLS_OK;
}

pls_status pls_find_parted_solids(const pls_world *world, const pls_contact_input *input, const pls_solid_block *block,
                                  pls_parted_list *found)
{
    const pls_solid_list *list = &world->solids;
    for (size_t c = block->first; c < block->last; ++c)
    {
        const pls_solid_pair *pair = &list->pair[c];
        const pls_solid_memory *memory = &list->memory[c];
        if (!pair->ended) continue;
        PLS_TRY(pls_reserve(&found->entry, &found->capacity, found->count + 1, sizeof *found->entry, "contacts that ended"));
        const pls_law *law = &world->laws.law[pair->law];
        const pls_vec3 spring = pls_solid_last_spring(list, input, c);
        const pls_contact_point point = {.effective_radius = pls_solid_effective_radius(list, c),
                                         .effective_mass = 1.0 / (input->load[pair->row_i].inv_mass + input->load[pair->row_j].inv_mass),
                                         .spring_squared = pls_dot(spring, spring),
                                         .history = memory->history};
        double normal, shear;
        law->ops->energy(law->constants, &point, &normal, &shear);
        found->entry[found->count++] = (struct pls_parted){.part_i = memory->part_i,
                                                           .part_j = memory->part_j,
                                                           .image = memory->image,
                                                           .row_i = pair->row_i,
                                                           .row_j = pair->row_j,
                                                           .energy = normal + shear};
    }
    return PLS_OK;
}

/// Bring all that parted into the list of the first thread.
static pls_status bring_together(pls_world *world, size_t count)
{
    pls_parted_list *all = &world->parted[0];
    PLS_TRY(pls_reserve(&all->entry, &all->capacity, count, sizeof *all->entry, "contacts that ended"));
    for (int t = 1; t < world->work_count; ++t)
    {
        if (world->parted[t].count > 0)
            memcpy(all->entry + all->count, world->parted[t].entry, world->parted[t].count * sizeof *all->entry);
        all->count += world->parted[t].count;
        world->parted[t].count = 0;
    }
    return PLS_OK;
}

/// The order in which they are booked. Their numbers, cold memory, are asked for in one go here.
static void order_parted(const pls_bodies *bodies, const pls_parted_list *all, const pls_parted_order *sorted)
{
    uint64_t *key = sorted->key;
    uint32_t *order = sorted->place;
    for (size_t k = 0; k < all->count; ++k)
    {
        struct pls_parted *p = &all->entry[k];
        p->number_i = bodies->kind[p->row_i].number, p->number_j = bodies->kind[p->row_j].number;
        key[k] = key_of(p);
        order[k] = (uint32_t)k;
    }
    if (all->count > FEW_PARTED) pls_radix_sort_u64_in(key, order, all->count, sorted->scratch);
    for (size_t k = 1; k < all->count; ++k) // few, or in order but for several parts of two bodies
    {
        const uint32_t moving = order[k];
        size_t m = k;
        for (; m > 0 && comes_before(&all->entry[moving], &all->entry[order[m - 1]]); --m) order[m] = order[m - 1];
        order[m] = moving;
    }
}

pls_status pls_book_parted(pls_world *world)
{
    size_t count = 0;
    for (int t = 0; t < world->work_count; ++t) count += world->parted[t].count;
    if (count == 0) return PLS_OK;
    PLS_TRY(bring_together(world, count));
    pls_parted_list *all = &world->parted[0];
    pls_parted_order *sorted = &world->parted_order;
    if (count > sorted->capacity)
    {
        const size_t grown = count + count / 2;
        PLS_TRY(pls_reallocate(&sorted->key, sorted->capacity, grown, sizeof *sorted->key, "contacts that ended"));
        PLS_TRY(pls_reallocate(&sorted->place, sorted->capacity, grown, sizeof *sorted->place, "contacts that ended"));
        PLS_TRY(pls_reallocate(&sorted->scratch, sorted->capacity, grown, PLS_SORT_SCRATCH, "contacts that ended"));
        sorted->capacity = grown;
    }
    order_parted(&world->bodies, all, sorted);
    for (size_t k = 0; k < count; ++k)
    {
        const struct pls_parted *p = &all->entry[sorted->place[k]];
        world->bodies.slid[p->row_i] += 0.5 * p->energy;
        world->bodies.slid[p->row_j] += 0.5 * p->energy;
    }
    all->count = 0;
    return PLS_OK;
}

void pls_parted_free(pls_world *world)
{
    for (int t = 0; world->parted && t < world->work_count; ++t) pls_release(&world->parted[t].entry);
    pls_release(&world->parted);
    pls_release(&world->parted_order.key);
    pls_release(&world->parted_order.place);
    pls_release(&world->parted_order.scratch);
    world->parted_order.capacity = 0;
}
