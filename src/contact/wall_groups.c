// wall_groups.c -- facets under one body that make one contact.
//
// Facets of one patch do (they are level to 15 degrees), and so do the two beside a ridge, where the body lies over an edge of the wall as over that of a box. What is in a
// valley touches both of its slopes, each by itself, like a ball in a groove.
//
// Which candidates have to do with the contact: those that the body passes through, and those it is about as near to as it is deep in others: of what is behind such a facet
// (nearer to it than to its neighbours) it may have a part, although it does not reach the facet itself. And those that touched at the last step: a body that turns about a rim may
// still have a part behind it when it no longer reaches through.

#include "contact/wall_groups.h"

#include "contact/wall_touch.h"

static const double nearness = 2.0;         ///< of the deepest depth: gap up to which a facet may matter
static const double holds = PLS_NARROW_FAR; ///< of the body's size: gap up to which a facet that touched does

typedef struct facets
{
    size_t count;
    uint32_t candidate[PLS_FEW_CANDIDATES];
    uint32_t group[PLS_FEW_CANDIDATES]; ///< place of another one of the same group, of the first one its own
    pls_facet_view seen[PLS_FEW_CANDIDATES];
    double push[PLS_FEW_CANDIDATES]; ///< component of the least push that parts them along the facet's normal; 0: not known
    bool any[PLS_FEW_CANDIDATES];    ///< something is behind it
} facets;

static const pls_facet *facet_of(const pls_solid_list *list, size_t c)
{
    const pls_shape *wall = list->posed[list->pair[c].row_j].shape;
    return pls_shape_facet(wall->part[list->memory[c].part_j].shape);
}

static bool of_one_image(const pls_solid_memory *p, const pls_solid_memory *q) { return p->image == q->image; }

/// How a facet lies to its neighbours. In a periodic box a wall's free sides may be those of its own image: one wall goes on there.
static pls_facet seams_of(const pls_solid_list *list, const pls_contact_input *in, const facets *f, size_t k, const pls_posed *facet)
{
    const size_t c = f->candidate[k];
    pls_facet seams = *facet_of(list, c);
    if (!in->domain->any_periodic) return seams;
    for (size_t j = 0; j < f->count; ++j)
    {
        const pls_solid_memory *other = &list->memory[f->candidate[j]];
        if (of_one_image(&list->memory[c], other)) continue;
        pls_solid_parts p;
        pls_solid_parts_of(list, in, f->candidate[j], &p);
        pls_facet_join_posed(facet, &seams, p.b);
    }
    return seams;
}

static void find_facets(const pls_solid_list *list, const pls_contact_input *in, size_t first, size_t last, facets *f)
{
    double gap = 0.0;
    f->count = 0;
    for (size_t c = first; c < last; ++c)
        if (list->pair[c].on_wall) gap = fmax(gap, nearness * list->touch[c].delta);
    for (size_t c = first; c < last; ++c)
    {
        const double still = list->memory[c].front != 0.0 ? holds * list->posed[list->pair[c].row_i].size : 0.0;
        if (!list->pair[c].on_wall || !(list->touch[c].delta > -fmax(gap, still))) continue;
        const size_t k = f->count++;
        f->candidate[k] = (uint32_t)c, f->group[k] = (uint32_t)k, f->any[k] = false;
    }
    for (size_t k = 0; k < f->count; ++k)
    {
        pls_solid_parts p;
        pls_solid_parts_of(list, in, f->candidate[k], &p);
        const pls_facet seams = seams_of(list, in, f, k, p.b);
        f->seen[k] = pls_facet_seen_from(p.b, &seams, pls_posed_world(p.a, p.a->shape->mass.centre));
        const pls_touch *touch = &list->touch[f->candidate[k]];
        const bool known = touch->delta > 0.0 && !pls_wall_needs_no_depth(p.a, p.b);
        f->push[k] = known ? -pls_dot(touch->normal, pls_posed_turn(p.b, seams.normal)) : 0.0;
    }
}

static uint32_t first_of(facets *f, uint32_t k)
{
    while (f->group[k] != k) k = f->group[k] = f->group[f->group[k]];
    return k;
}

/// Do two facets make one contact? Of the side of a ridge from which the body looks the nearer one tells.
static bool are_one(const pls_solid_list *list, const pls_contact_input *in, const facets *f, size_t i, size_t j)
{
    const size_t c = f->candidate[i], d = f->candidate[j];
    const pls_solid_memory *own = &list->memory[c], *other = &list->memory[d];
    const double front = f->seen[f->seen[i].distance <= f->seen[j].distance ? i : j].front;
    if (own->part_i != other->part_i) return false;
    pls_facet facet = *facet_of(list, c);
    if (of_one_image(own, other))
    {
        const pls_facet *beyond = facet_of(list, d);
        if (beyond->patch == facet.patch) return true;
        for (int k = 0; k < 3; ++k)
            if (facet.neighbour[k] == beyond->number && facet.bend[k] * front > 0.0) return true;
        return false;
    }
    pls_solid_parts p, q;
    pls_solid_parts_of(list, in, c, &p), pls_solid_parts_of(list, in, d, &q);
    const int k = pls_facet_join_posed(p.b, &facet, q.b);
    return k >= 0 && (facet.level[k] || facet.bend[k] * front > 0.0);
}

static void find_groups(const pls_solid_list *list, const pls_contact_input *in, facets *f)
{
    for (size_t i = 0; i < f->count; ++i)
        for (size_t j = 0; j < i; ++j)
        {
            const uint32_t a = first_of(f, (uint32_t)i), b = first_of(f, (uint32_t)j);
            if (a != b && are_one(list, in, f, i, j)) f->group[a > b ? a : b] = a > b ? b : a;
        }
}

/// From which side a body is at a group: as when it came, however far it goes through. At first on the side to which the facet that it meets most squarely pushes it: who comes to
/// a rim may have most of itself on the other side. What knows of no push is where it looks from at the nearest facet.
static double front_of(const pls_solid_list *list, facets *f, uint32_t group)
{
    double least = INFINITY, most = 0.0, known = 0.0, seen = 1.0, pushed = 0.0;
    for (size_t k = group; k < f->count; ++k)
    {
        if (first_of(f, (uint32_t)k) != group) continue;
        const pls_solid_memory *memory = &list->memory[f->candidate[k]];
        if (memory->front != 0.0 && (known == 0.0 || memory->touches == PLS_SOLID_TOUCHES)) known = memory->front;
        if (fabs(f->push[k]) > most) most = fabs(f->push[k]), pushed = f->push[k] < 0.0 ? -1.0 : 1.0;
        if (f->seen[k].distance < least) least = f->seen[k].distance, seen = f->seen[k].front;
    }
    if (known != 0.0) return known;
    return pushed != 0.0 ? pushed : seen;
}

/// The candidate that acts: the one that did, so that its spring goes on.
static size_t leader_of(const pls_solid_list *list, facets *f, uint32_t group)
{
    size_t leader = SIZE_MAX;
    for (size_t k = group; k < f->count; ++k)
    {
        if (!f->any[k] || first_of(f, (uint32_t)k) != group) continue;
        const size_t c = f->candidate[k];
        if (list->memory[c].touches == PLS_SOLID_TOUCHES) return c;
        if (leader == SIZE_MAX) leader = c;
    }
    return leader;
}

/// What the body was on the side of it forgets as soon as it no longer touches.
static void forget_fronts(pls_solid_list *list, size_t first, size_t last, const uint8_t *next)
{
    for (size_t c = first; c < last; ++c)
        if (next[c - first] == PLS_SOLID_APART) list->memory[c].front = 0.0;
}

static void touch_group(pls_solid_list *list, const pls_contact_input *in, facets *f, uint32_t group, size_t first, uint8_t *next)
{
    const double front = front_of(list, f, group);
    const pls_narrow_options *options = &in->laws->law[list->pair[f->candidate[group]].law].narrow;
    pls_wall_sum sum = {.facets = 0};
    pls_posed body; // the sum refers to it
    for (size_t k = group; k < f->count; ++k)
    {
        if (first_of(f, (uint32_t)k) != group) continue;
        const size_t c = f->candidate[k];
        pls_solid_parts p;
        pls_solid_parts_of(list, in, c, &p);
        if (!sum.a) body = *p.a, sum = pls_wall_sum_of(&body);
        const pls_facet seams = seams_of(list, in, f, k, p.b);
        f->any[k] = pls_wall_add(&sum, p.b, &seams, front, &list->touch[c]);
    }
    pls_touch touch;
    if (!pls_wall_touch(&sum, options, &touch)) return;
    const size_t leader = leader_of(list, f, group);
    for (size_t k = group; k < f->count; ++k)
    {
        if (!f->any[k] || first_of(f, (uint32_t)k) != group) continue;
        next[f->candidate[k] - first] = PLS_SOLID_SHADED;
        list->memory[f->candidate[k]].front = front;
    }
    next[leader - first] = PLS_SOLID_TOUCHES;
    list->touch[leader] = touch;
}

void pls_wall_groups(pls_solid_list *list, const pls_contact_input *input, size_t first, size_t last, uint8_t *next)
{
    bool any = false;
    for (size_t c = first; c < last; ++c)
    {
        if (!list->pair[c].on_wall) continue;
        next[c - first] = PLS_SOLID_APART;
        any = true;
    }
    if (!any) return;
    facets f;
    find_facets(list, input, first, last, &f);
    find_groups(list, input, &f);
    for (uint32_t k = 0; k < f.count; ++k)
        if (f.group[k] == k) touch_group(list, input, &f, k, first, next);
    forget_fronts(list, first, last, next);
}
