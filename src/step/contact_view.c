// contact_view.c -- the touching contacts after the last step, rebuilt from the list and its slots.

#include "step/contact_view.h"

#include "base/alloc.h"
#include "step/world.h"

#include <stdlib.h>
#include <string.h>

static int by_numbers(const void *a, const void *b)
{
    const pls_contact_entry *p = a, *q = b;
    if (p->number_i != q->number_i) return p->number_i < q->number_i ? -1 : 1;
    if (p->number_j != q->number_j) return p->number_j < q->number_j ? -1 : 1;
    if (p->part_i != q->part_i) return p->part_i < q->part_i ? -1 : 1;
    if (p->part_j != q->part_j) return p->part_j < q->part_j ? -1 : 1;
    return p->image < q->image ? -1 : p->image > q->image;
}

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
    const pls_touch *touch = &list->touch[c];
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
                             .delta = touch->depth};
    e->branch = e->wall ? pls_scale(touch->normal, pls_dot(touch->normal, pls_sub(touch->point, x)) - 0.5 * touch->depth) : d;

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
    const pls_contact_input input = pls_contact_input_of(world, 0.0);
    point.delta = isfinite(touch->energy_delta) ? touch->energy_delta : pls_solid_touch_now(list, &input, c).energy_delta;
    law->ops->energy(law->constants, &point, &e->energy_normal, &e->energy_shear);
}

pls_status pls_contact_view_make(const pls_world *world, pls_contact_view *view)
{
    view->count = 0;
    if (!world->prepared)
        PLS_TRY(pls_world_prepare((pls_world *)world)); // worlds are never constant themselves, only those who look are bound
    if (world->memory_holds)
        return pls_fail(PLS_INVALID_ARGUMENT, "bodies or laws have changed since the last step; contacts are known again after the next");
    const pls_pair_list *list = &world->list;
    PLS_TRY(pls_reserve(&view->entry, &view->capacity, pls_pair_list_touching(list) + pls_solid_list_touching(&world->solids),
                        sizeof *view->entry, "the view of contacts"));
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        for (size_t c = section->first; c < section->first + section->count; ++c)
            if (pls_pair_touches(list, c)) fill_entry(world, section, c, &view->entry[view->count++]);
    }
    for (size_t c = 0; c < world->solids.count; ++c)
        if (world->solids.memory[c].touches == PLS_SOLID_TOUCHES) fill_solid(world, c, &view->entry[view->count++]);
    if (view->count > 1) qsort(view->entry, view->count, sizeof *view->entry, by_numbers);
    return PLS_OK;
}

void pls_contact_view_free(pls_contact_view *view)
{
    pls_release(&view->entry);
    memset(view, 0, sizeof *view);
}
