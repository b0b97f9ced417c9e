// contact_view.c -- the touching contacts after the last step, rebuilt from the list and its slots.

#include "step/contact_view.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "base/sort.h"
#include "step/world.h"

#include <string.h>

static void fill_entry(const pls_world *world, const pls_pair_section *section, size_t c, pls_contact_entry *e)
{
    const pls_pair_list *list = &world->list;
    const pls_bodies *b = &world->bodies;
    uint32_t i = list->row_i[c], j = list->row_j[c];
    const pls_body_place *p = &b->place[i], *q = &b->place[j];
    *e = (pls_contact_entry){.number_i = b->kind[i].number, .number_j = b->kind[j].number, .row_i = i, .row_j = j, .wall = section->wall};
    pls_vec3 x = pls_vec(p->x, p->y, p->z), d = pls_sub(pls_vec(q->x, q->y, q->z), x);
    const double *slot = list->slot + c * PLS_SLOT;
    double effective_radius = p->radius;
    if (section->wall)
    {
        slot = pls_wall_slot(list, c);
        e->normal = pls_scale(pls_wall_normal(&b->orientation[j], world->def.dimension), -1.0);
        double height = pls_dot(e->normal, d);
        e->delta = p->radius - height;
        e->branch = pls_scale(e->normal, height);
    }
    else
    {
        if (world->domain.any_periodic)
        {
            const int16_t *s = list->shift[c];
            d = pls_add(d, pls_vec(s[0] * world->domain.edge[0], s[1] * world->domain.edge[1], s[2] * world->domain.edge[2]));
        }
        double distance = pls_length(d);
        e->normal = pls_scale(d, 1.0 / distance);
        e->delta = p->radius + q->radius - distance;
        e->branch = d;
        effective_radius = p->radius * q->radius / (p->radius + q->radius);
    }
    e->point = pls_add(x, pls_scale(e->normal, p->radius - 0.5 * e->delta));
    e->force = pls_vec(slot[0], slot[1], slot[2]);

    const pls_law *law = &world->laws.law[section->law];
    double history[3 + PLS_LAW_MAX_HISTORY];
    pls_pair_history_read(list, section, c, history);
    double mass_sum = b->load[i].inv_mass + b->load[j].inv_mass;
    pls_contact_point point = {.delta = fmax(e->delta, 0.0),
                               .effective_radius = effective_radius,
                               .effective_mass = mass_sum > 0.0 ? 1.0 / mass_sum : INFINITY,
                               .spring_squared = history[0] * history[0] + history[1] * history[1] + history[2] * history[2],
                               .history = history + 3};
    law->ops->stiffness(law->constants, &point, &e->stiffness);
    law->ops->energy(law->constants, &point, &e->energy_normal, &e->energy_shear);
}

static void fill_solid(const pls_world *world, size_t c, pls_contact_entry *e)
{
    const pls_solid_list *list = &world->solids;
    const pls_solid_pair *pair = &list->pair[c];
    const pls_solid_memory *memory = &list->memory[c];
    const pls_contact_input input = pls_contact_input_of(world, 0.0);
    const pls_touch *touch = &list->touch[c];
    pls_touch whole = *touch; // with what nobody has asked for so far
    if (!isfinite(touch->energy_delta) || !isfinite(touch->depth)) whole = pls_solid_touch_now(list, &input, c);
    const pls_bodies *b = &world->bodies;
    const pls_body_place *p = &b->place[pair->row_i], *q = &b->place[pair->row_j];
    const double *slot = list->slot + c * PLS_SOLID_SLOT, *edge = world->domain.edge;
    pls_vec3 x = pls_vec(p->x, p->y, p->z), d = pls_sub(pls_vec(q->x, q->y, q->z), x);
    d = pls_add(d, pls_vec(pair->shift[0] * edge[0], pair->shift[1] * edge[1], pair->shift[2] * edge[2]));
    *e = (pls_contact_entry){.number_i = memory->number_i,
                             .number_j = memory->number_j,
                             .part_i = memory->part_i,
                             .part_j = memory->part_j,
                             .image = memory->image,
                             .row_i = pair->row_i,
                             .row_j = pair->row_j,
                             .wall = (b->kind[pair->row_j].flags & PLS_BODY_UNBOUNDED) != 0,
                             .normal = touch->normal,
                             .point = touch->point,
                             .force = pls_vec(slot[0], slot[1], slot[2]),
                             .delta = whole.depth};
    e->branch = e->wall ? pls_scale(touch->normal, pls_dot(touch->normal, pls_sub(touch->point, x)) - 0.5 * whole.depth) : d;

    const pls_law *law = &world->laws.law[pair->law];
    double mass_sum = b->load[pair->row_i].inv_mass + b->load[pair->row_j].inv_mass;
    pls_contact_point point = {.delta = touch->delta,
                               .effective_radius = pls_solid_effective_radius(list, c),
                               .effective_mass = mass_sum > 0.0 ? 1.0 / mass_sum : INFINITY,
                               .spring_squared = memory->spring[0] * memory->spring[0] + memory->spring[1] * memory->spring[1] +
                                                 memory->spring[2] * memory->spring[2],
                               .history = memory->history};
    law->ops->stiffness(law->constants, &point, &e->stiffness);
    e->stiffness.kn *= touch->weight; // of the approach; dashpots see that itself
    point.delta = isfinite(touch->energy_delta) ? touch->energy_delta : whole.energy_delta;
    law->ops->energy(law->constants, &point, &e->energy_normal, &e->energy_shear);
}

/// Touching candidates in the order of the view: those of the pair list by number, those of solids behind them.
typedef struct view_order
{
    uint64_t *key; ///< numbers of the two bodies
    uint32_t *candidate;
    size_t count;
} view_order;

static void order_free(view_order *order)
{
    pls_release(&order->key);
    pls_release(&order->candidate);
}

static void add_key(view_order *order, uint32_t number_i, uint32_t number_j, size_t candidate)
{
    order->key[order->count] = (uint64_t)number_i << 32 | number_j;
    order->candidate[order->count++] = (uint32_t)candidate;
}

static void collect(const pls_world *world, view_order *order)
{
    const pls_pair_list *list = &world->list;
    const pls_body_kind *kind = world->bodies.kind;
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        for (size_t c = section->first; c < section->first + section->count; ++c)
            if (pls_pair_touches(list, c)) add_key(order, kind[list->row_i[c]].number, kind[list->row_j[c]].number, c);
    }
    for (size_t c = 0; c < world->solids.count; ++c)
    {
        const pls_solid_memory *memory = &world->solids.memory[c];
        if (memory->touches == PLS_SOLID_TOUCHES) add_key(order, memory->number_i, memory->number_j, list->count + c);
    }
}

static bool part_comes_before(const pls_solid_memory *p, const pls_solid_memory *q)
{
    if (p->part_i != q->part_i) return p->part_i < q->part_i;
    if (p->part_j != q->part_j) return p->part_j < q->part_j;
    return p->image < q->image;
}

/// Two solids may touch in several parts.
static void order_parts(const pls_world *world, view_order *order)
{
    const pls_solid_memory *memory = world->solids.memory;
    const size_t solids = world->list.count;
    for (size_t k = 1; k < order->count; ++k)
    {
        const uint32_t moving = order->candidate[k];
        size_t m = k;
        while (m > 0 && order->key[m - 1] == order->key[k] &&
               part_comes_before(&memory[moving - solids], &memory[order->candidate[m - 1] - solids]))
        {
            order->candidate[m] = order->candidate[m - 1];
            --m;
        }
        order->candidate[m] = moving;
    }
}

/// Sorted before they are filled in: entries are long.
static pls_status order_make(const pls_world *world, size_t count, view_order *order)
{
    PLS_TRY(pls_allocate(&order->key, count, sizeof *order->key, "the order of contacts"));
    PLS_TRY(pls_allocate(&order->candidate, count, sizeof *order->candidate, "the order of contacts"));
    collect(world, order);
    PLS_TRY(pls_radix_sort_u64(order->key, order->candidate, order->count));
    order_parts(world, order);
    return PLS_OK;
}

static const pls_pair_section *section_of(const pls_pair_list *list, size_t c)
{
    const pls_pair_section *section = list->section;
    while (c < section->first || c >= section->first + section->count) ++section;
    return section;
}

static void fill(const pls_world *world, const view_order *order, pls_contact_entry *entry)
{
    const pls_pair_list *list = &world->list;
#pragma omp parallel for schedule(static) if (order->count > PLS_BLOCK)
    for (size_t k = 0; k < order->count; ++k)
    {
        const size_t c = order->candidate[k];
        if (c < list->count)
            fill_entry(world, section_of(list, c), c, &entry[k]);
        else
            fill_solid(world, c - list->count, &entry[k]);
    }
}

pls_status pls_contact_view_make(const pls_world *world, pls_contact_view *view)
{
    view->count = 0;
    if (!world->prepared)
        PLS_TRY(pls_world_prepare((pls_world *)world)); // worlds are never constant themselves, only those who look are bound
    if (world->memory_holds)
        return pls_fail(PLS_INVALID_ARGUMENT, "bodies or laws have changed since the last step; contacts are known again after the next");
    if (world->list.gone)
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "the last step did not end, so forces of contacts are not known; they are again after the next step");
    const size_t count = pls_pair_list_touching(&world->list) + pls_solid_list_touching(&world->solids);
    view_order order = {0};
    pls_status status = order_make(world, count, &order);
    if (status == PLS_OK) status = pls_reserve(&view->entry, &view->capacity, count, sizeof *view->entry, "the view of contacts");
    if (status == PLS_OK)
    {
        fill(world, &order, view->entry);
        view->count = order.count;
    }
    order_free(&order);
    return status;
}

void pls_contact_view_free(pls_contact_view *view)
{
    pls_release(&view->entry);
    memset(view, 0, sizeof *view);
}
