// contact_rates.c -- contacts as the stable step sees them.

#include "step/contact_rates.h"

#include "contact/touch_area.h"

static const double typical_overlap =
    0.01; ///< of the radius: where a law whose stiffness vanishes at zero overlap is asked before grains touch

double pls_smallest_moment(const pls_body_mass *m, int dimension) { return dimension == 2 ? m->iz : fmin(m->ix, fmin(m->iy, m->iz)); }

pls_contact_rate pls_contact_rate_of(const pls_world *world, size_t c)
{
    const pls_pair_list *list = &world->list;
    const pls_bodies *b = &world->bodies;
    const pls_pair_section *section = list->section;
    while (c < section->first || c >= section->first + section->count) ++section;
    pls_contact_rate t = {.i = list->row_i[c], .j = list->row_j[c]};
    const pls_body_place *p = &b->place[t.i], *q = &b->place[t.j];
    double d[3] = {q->x - p->x, q->y - p->y, q->z - p->z}, delta, radius, lever_j = 0.0;
    if (section->wall)
    {
        t.n = pls_scale(pls_wall_normal(&b->orientation[t.j], world->def.dimension), -1.0);
        delta = p->radius - (t.n.x * d[0] + t.n.y * d[1] + t.n.z * d[2]);
        radius = p->radius;
    }
    else
    {
        for (int a = 0; world->domain.any_periodic && a < 3; ++a) d[a] += list->shift[c][a] * world->domain.edge[a];
        double distance = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        t.n = pls_vec(d[0] / distance, d[1] / distance, d[2] / distance);
        delta = p->radius + q->radius - distance;
        radius = p->radius * q->radius / (p->radius + q->radius);
        lever_j = q->radius - 0.5 * delta;
    }
    t.arm_i = pls_scale(t.n, p->radius - 0.5 * delta);
    t.arm_j = pls_scale(t.n, -lever_j);
    t.held = section->wall || b->load[t.j].inv_mass == 0.0;
    const pls_law *law = &world->laws.law[section->law];
    const double zeros[PLS_LAW_MAX_HISTORY] = {0};
    pls_contact_point point = {.delta = fmax(delta, 0.0),
                               .effective_radius = radius,
                               .effective_mass = 1.0 / (b->load[t.i].inv_mass + b->load[t.j].inv_mass),
                               .history = zeros};
    law->ops->stiffness(law->constants, &point, &t.k);
    return t;
}

/// At the contact point.
static pls_contact_rate solid_rate(const pls_world *world, size_t c)
{
    const pls_solid_list *list = &world->solids;
    const pls_solid_pair *pair = &list->pair[c];
    const pls_touch *touch = &list->touch[c];
    const pls_bodies *b = &world->bodies;
    const pls_body_place *p = &b->place[pair->row_i], *q = &b->place[pair->row_j];
    const double *edge = world->domain.edge, zeros[PLS_LAW_MAX_HISTORY] = {0};
    pls_contact_rate t = {.i = pair->row_i, .j = pair->row_j, .n = touch->normal};
    t.arm_i = pls_sub(touch->point, pls_vec(p->x, p->y, p->z));
    t.arm_j =
        pls_sub(touch->point, pls_vec(q->x + pair->shift[0] * edge[0], q->y + pair->shift[1] * edge[1], q->z + pair->shift[2] * edge[2]));
    t.held = b->load[t.j].inv_mass == 0.0;
    const pls_law *law = &world->laws.law[pair->law];
    pls_contact_point point = {.delta = fmax(touch->delta, 0.0),
                               .effective_radius = pls_solid_effective_radius(list, c),
                               .effective_mass = 1.0 / (b->load[t.i].inv_mass + b->load[t.j].inv_mass),
                               .history = zeros};
    law->ops->stiffness(law->constants, &point, &t.k);
    t.k.kn *= touch->weight;
    return t;
}

/// Flat faces resist rocking like kn spread over the area with volume, four times as much with manifold (the third moment of a tilted overlap over its second: delta grows by
/// 2 phi^2 S/delta). So corners are set twice as wide.
int pls_solid_rates_of(const pls_world *world, size_t c, pls_contact_rate rates[PLS_SOLID_RATES])
{
    const pls_touch *touch = &world->solids.touch[c];
    const pls_contact_rate whole = solid_rate(world, c);
    rates[0] = whole;
    if (pls_touch_is_point(touch)) return 1;
    pls_vec3 corner[PLS_SOLID_RATES];
    pls_touch_corners(touch, corner);
    for (int k = 0; k < PLS_SOLID_RATES; ++k)
    {
        const pls_vec3 out = pls_scale(corner[k], 2.0);
        rates[k] = whole;
        rates[k].arm_i = pls_add(whole.arm_i, out), rates[k].arm_j = pls_add(whole.arm_j, out);
        rates[k].k.kn *= 0.25, rates[k].k.kt *= 0.25, rates[k].k.cn *= 0.25, rates[k].k.ct *= 0.25;
    }
    return PLS_SOLID_RATES;
}

void pls_root_inverse_inertia(const pls_world *world, uint32_t row, double out[6])
{
    const pls_body_mass *m = &world->bodies.mass[row];
    const pls_body_orientation *o = &world->bodies.orientation[row];
    for (int k = 0; k < 6; ++k) out[k] = 0.0;
    if (world->def.dimension == 2)
    {
        out[2] = 1.0 / sqrt(m->iz);
        return;
    }
    const double root[3] = {1.0 / sqrt(m->ix), 1.0 / sqrt(m->iy), 1.0 / sqrt(m->iz)};
    for (int a = 0; a < 3; ++a)
    {
        pls_vec3 e = pls_rotate((pls_quat){o->w, o->x, o->y, o->z}, pls_vec(a == 0, a == 1, a == 2));
        out[0] += root[a] * e.x * e.x, out[1] += root[a] * e.y * e.y, out[2] += root[a] * e.z * e.z;
        out[3] += root[a] * e.x * e.y, out[4] += root[a] * e.x * e.z, out[5] += root[a] * e.y * e.z;
    }
}

/// The stiffest contact a body's material can have with its like or another.
static bool typical_contact(const pls_world *world, uint32_t row, pls_contact_stiffness *out)
{
    const pls_bodies *b = &world->bodies;
    bool any = false;
    *out = (pls_contact_stiffness){0};
    double radius = b->place[row].radius;
    for (size_t m = 0; m < world->laws.material_count; ++m)
    {
        uint16_t index = pls_law_table_find(&world->laws, b->kind[row].material, (uint16_t)m);
        if (index == PLS_NO_LAW) continue;
        const pls_law *law = &world->laws.law[index];
        const double zeros[PLS_LAW_MAX_HISTORY] = {0};
        pls_contact_point point = {.delta = typical_overlap * radius,
                                   .effective_radius = 0.5 * radius,
                                   .effective_mass = 0.5 * b->mass[row].mass,
                                   .history = zeros};
        pls_contact_stiffness k;
        law->ops->stiffness(law->constants, &point, &k);
        out->kn = fmax(out->kn, k.kn), out->kt = fmax(out->kt, k.kt), out->cn = fmax(out->cn, k.cn), out->ct = fmax(out->ct, k.ct);
        any = true;
    }
    return any;
}

void pls_add_missing_contacts(const pls_world *world, uint32_t row, int coordination, pls_body_rates *rates)
{
    int missing = coordination - rates->contacts;
    pls_contact_stiffness k;
    if (missing <= 0 || !typical_contact(world, row, &k)) return;
    const pls_bodies *b = &world->bodies;
    int d = world->def.dimension;
    double radius = b->place[row].radius, weight = 2.0 * missing;
    double per_mass = weight / (d * b->mass[row].mass),
           per_inertia = weight * radius * radius / pls_smallest_moment(&b->mass[row], d) * (d == 2 ? 1.0 : 2.0 / 3.0);
    for (int a = 0; a < d; ++a)
    {
        rates->stiffness[7 * a] += per_mass * (k.kn + (d - 1) * k.kt);
        rates->damping[7 * a] += per_mass * (k.cn + (d - 1) * k.ct);
    }
    for (int a = d == 2 ? 5 : 3; a < 6; ++a)
    {
        // Normals of a ball go through its centre; those of other shapes pass it by.
        bool solid = (b->kind[row].flags & PLS_BODY_SOLID) != 0;
        rates->stiffness[7 * a] += per_inertia * (k.kt + (solid ? 0.5 * k.kn : 0.0));
        rates->damping[7 * a] += per_inertia * (k.ct + (solid ? 0.5 * k.cn : 0.0));
    }
    rates->contacts += missing;
}
