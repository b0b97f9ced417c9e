// wall_groups.c -- facets under one body that make one contact.
//
// Facets of one patch do (they are level to 15 degrees), and so do the two beside a ridge, where the body lies over an edge of the wall as over that of a box. What is in a
// valley touches both of its slopes, each by itself, like a ball in a groove. Facets that a body meets from different sides do not: the top of a plate and its bottom.
//
// To bodies that are not convex, which have no side, only facets of one patch are one: always the same ones, so that energies are the same on all ways.
//
// Which candidates have to do with the contact: those that the body passes through; those it is nearer to than some times as deep as it is in others, since of what is behind such a facet
// it may have a part although it does not reach the facet itself (beside a ridge, and beyond the bottom of a valley, where the plane of the one slope goes on behind the other: at a bend b
// as far as depth/tan(b)); and those that touched at the last step: a body that turns about a rim may still have a part behind it when it no longer reaches through.

#include "contact/wall_groups.h"

#include "contact/sampled_touch.h"
#include "contact/wall_touch.h"

static const double nearness = 12.0; ///< of the deepest depth: gap up to which a facet may matter; valleys of 5 degrees
static const double holds =
    PLS_NARROW_FAR; ///< of the body's size: gap up to which a facet that touched does; of a part of a compound no more than of that part
static const double opposes = -0.95; ///< cosine of a push and a front that contradict each other

enum { MOST = 16384, SLOTS = 4 * MOST, NONE = UINT16_MAX };

/// What facets are looked up by.
enum by { NUMBER, PATCH, SHEET };

/// A table from numbers of facets, patches, or sheets to places.
typedef struct table
{
    size_t mask;           ///< slots in use less one; a power of two, so that few facets take little time
    uint16_t place[SLOTS]; ///< NONE: nothing
} table;

typedef struct facets
{
    size_t count;
    bool by_pieces; ///< of the body's surface, or of facets: nothing is known of depths
    bool sides;     ///< the body is on one side of a facet
    uint32_t candidate[MOST];
    uint16_t group[MOST]; ///< place of another one of the same group, of the first one its own
    double front[MOST];   ///< the side on which the body is; 0: it has nothing to do with it
    bool any[MOST];       ///< something is behind it
    bool by_push[MOST];   ///< at a rim: the least push tells of the side, not where the middle is
    pls_facet_view seen[MOST];
    double push[MOST]; ///< component along the normal of the least push that parts body and facet
    table table[3];
} facets;

static const pls_facet *facet_of(const pls_solid_list *list, size_t c)
{
    const pls_shape *wall = list->posed[list->pair[c].row_j].shape;
    return pls_shape_facet(wall->part[list->memory[c].part_j].shape);
}

static bool of_one_image(const pls_solid_memory *p, const pls_solid_memory *q) { return p->image == q->image; }
static bool of_one_pair(const pls_solid_memory *p, const pls_solid_memory *q) { return p->part_i == q->part_i && of_one_image(p, q); }

// ---- tables -------------------------------------------------------------------------------------------------------------------------------------------------

static void clear(table *t, size_t count)
{
    size_t slots = 8;
    while (slots < 4 * count) slots *= 2;
    t->mask = slots - 1;
    for (size_t s = 0; s < slots; ++s) t->place[s] = NONE;
}

static size_t hash_of(const pls_solid_memory *memory, uint32_t number)
{
    uint64_t key = (uint64_t)number << 32 ^ (uint64_t)memory->part_i << 16 ^ memory->image;
    key = (key ^ key >> 31) * 0x9e3779b97f4a7c15u;
    return (size_t)(key ^ key >> 32);
}

static uint32_t number_by(const pls_facet *facet, enum by by)
{
    return by == NUMBER ? facet->number : by == PATCH ? facet->patch : facet->sheet;
}

/// Is facet j one of that number, under the same part as facet k; of a patch, met from the same side?
static bool is_it(const pls_solid_list *list, const facets *f, size_t j, size_t k, uint32_t number, enum by by)
{
    if (number_by(facet_of(list, f->candidate[j]), by) != number) return false;
    return of_one_pair(&list->memory[f->candidate[j]], &list->memory[f->candidate[k]]) && (by != PATCH || f->front[j] == f->front[k]);
}

/// The place of such a facet; NONE: there is none. `*slot`: where it is, or would be.
static uint16_t find(const pls_solid_list *list, const facets *f, size_t k, uint32_t number, enum by by, size_t *slot)
{
    const table *t = &f->table[by];
    size_t s = hash_of(&list->memory[f->candidate[k]], number) & t->mask;
    while (t->place[s] != NONE && !is_it(list, f, t->place[s], k, number, by)) s = (s + 1) & t->mask;
    *slot = s;
    return t->place[s];
}

// ---- facets -------------------------------------------------------------------------------------------------------------------------------------------------

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

static void look(const pls_solid_list *list, const pls_contact_input *in, facets *f, size_t k)
{
    pls_solid_parts p;
    pls_solid_parts_of(list, in, f->candidate[k], &p);
    const pls_facet seams = seams_of(list, in, f, k, p.b);
    f->seen[k] = pls_facet_seen_from(p.b, &seams, pls_posed_world(p.a, p.a->shape->mass.centre));
    f->by_pieces = pls_wall_needs_no_depth(p.a, p.b);
    f->sides = pls_wall_has_sides(p.a, p.b);
    f->by_push[k] = list->touch[f->candidate[k]].delta > 0.0 && f->seen[k].at_rim && !f->by_pieces;
    f->push[k] = f->by_pieces ? 0.0 : -pls_dot(list->touch[f->candidate[k]].normal, pls_posed_turn(p.b, seams.normal));
}

/// Does facet k know better than facet j on which side of their sheet the body is? Who touched before does, then the nearest of those that it passes through: only there do the normals at
/// sides and corners tell.
static bool knows_better(const pls_solid_list *list, const facets *f, size_t k, size_t j)
{
    const size_t c[2] = {f->candidate[k], f->candidate[j]};
    int rank[2];
    for (int i = 0; i < 2; ++i)
    {
        const pls_solid_memory *memory = &list->memory[c[i]];
        rank[i] = memory->front != 0.0 ? (memory->touches == PLS_SOLID_TOUCHES ? 3 : 2) : list->touch[c[i]].delta > 0.0 ? 1 : 0;
    }
    if (rank[0] != rank[1]) return rank[0] > rank[1];
    if (f->by_push[k] && f->by_push[j]) return fabs(f->push[k]) > fabs(f->push[j]);
    return f->seen[k].distance < f->seen[j].distance;
}

/// The side on which the body came, however far it goes through. At first, where its middle is; at a rim, to where the least push goes, as most of who comes there may be on the other side.
static double front_by(const pls_solid_list *list, const facets *f, size_t k)
{
    const size_t c = f->candidate[k];
    if (list->memory[c].front != 0.0) return list->memory[c].front;
    if (f->by_push[k]) return f->push[k] < 0.0 ? -1.0 : 1.0;
    return f->seen[k].front;
}

static void find_fronts(const pls_solid_list *list, facets *f)
{
    if (!f->sides)
    {
        for (size_t k = 0; k < f->count; ++k) f->front[k] = PLS_WALL_TOUCHED;
        return;
    }
    for (uint16_t k = 0; k < f->count; ++k)
    {
        size_t slot;
        const uint16_t best = find(list, f, k, facet_of(list, f->candidate[k])->sheet, SHEET, &slot);
        if (best == NONE || knows_better(list, f, k, best)) f->table[SHEET].place[slot] = k;
    }
    for (size_t k = 0; k < f->count; ++k)
    {
        size_t slot;
        const size_t c = f->candidate[k];
        const double front = front_by(list, f, find(list, f, k, facet_of(list, c)->sheet, SHEET, &slot));
        // The bottom of a plate that a body lies on.
        f->front[k] = list->memory[c].front == 0.0 && f->push[k] * front < opposes ? 0.0 : front;
    }
}

/// Is a facet one that the body touches or touched, or as near to as `gap`?
static bool matters(const pls_solid_list *list, size_t c, double gap)
{
    const double still = list->memory[c].front != 0.0 ? holds * list->posed[list->pair[c].row_i].size : 0.0;
    return list->pair[c].on_wall && list->touch[c].delta > -fmax(gap, still);
}

static void find_facets(const pls_solid_list *list, const pls_contact_input *in, size_t first, size_t last, facets *f)
{
    double gap = 0.0;
    size_t all = 0;
    f->count = 0, f->sides = true;
    for (size_t c = first; c < last; ++c)
        if (list->pair[c].on_wall) gap = fmax(gap, nearness * list->touch[c].delta);
    for (size_t c = first; c < last; ++c) all += matters(list, c, gap);
    if (all > MOST) gap = 0.0; // of so many those that are only near may be left out
    for (size_t c = first; c < last && f->count < MOST; ++c)
    {
        if (!matters(list, c, gap)) continue;
        const size_t k = f->count++;
        f->candidate[k] = (uint32_t)c, f->group[k] = (uint16_t)k, f->any[k] = false;
    }
    for (int t = 0; t < 3; ++t) clear(&f->table[t], f->count);
    for (size_t k = 0; k < f->count; ++k)
    {
        size_t slot;
        look(list, in, f, k);
        find(list, f, k, facet_of(list, f->candidate[k])->number, NUMBER, &slot);
        f->table[NUMBER].place[slot] = (uint16_t)k;
    }
    find_fronts(list, f);
}

// ---- groups -------------------------------------------------------------------------------------------------------------------------------------------------

static uint16_t first_of(facets *f, uint16_t k)
{
    while (f->group[k] != k) k = f->group[k] = f->group[f->group[k]];
    return k;
}

static void join(facets *f, uint16_t i, uint16_t j)
{
    const uint16_t a = first_of(f, i), b = first_of(f, j);
    if (f->front[i] == f->front[j] && f->front[i] != 0.0) f->group[a > b ? a : b] = a > b ? b : a;
}

static void join_patch(const pls_solid_list *list, facets *f, uint16_t k)
{
    size_t slot;
    const uint16_t other = find(list, f, k, facet_of(list, f->candidate[k])->patch, PATCH, &slot);
    if (other == NONE)
        f->table[PATCH].place[slot] = k;
    else
        join(f, k, other);
}

static void join_ridges(const pls_solid_list *list, facets *f, uint16_t k)
{
    const pls_facet *facet = facet_of(list, f->candidate[k]);
    for (int side = 0; side < 3; ++side)
    {
        size_t slot;
        if (facet->leans[side] || !(facet->bend[side] * f->front[k] > 0.0)) continue;
        const uint16_t other = find(list, f, k, facet->neighbour[side], NUMBER, &slot);
        if (other != NONE) join(f, k, other);
    }
}

/// Over the seams of a periodic wall and its images.
static void join_images(const pls_solid_list *list, const pls_contact_input *in, facets *f, uint16_t k)
{
    const pls_solid_memory *own = &list->memory[f->candidate[k]];
    for (uint16_t j = 0; j < k; ++j)
    {
        const pls_solid_memory *other = &list->memory[f->candidate[j]];
        if (own->part_i != other->part_i || of_one_image(own, other)) continue;
        pls_solid_parts p, q;
        pls_solid_parts_of(list, in, f->candidate[k], &p), pls_solid_parts_of(list, in, f->candidate[j], &q);
        pls_facet facet = *facet_of(list, f->candidate[k]);
        const int side = pls_facet_join_posed(p.b, &facet, q.b);
        if (side >= 0 && (facet.level[side] || (f->sides && facet.bend[side] * f->front[k] > 0.0))) join(f, k, j);
    }
}

static void find_groups(const pls_solid_list *list, const pls_contact_input *in, facets *f)
{
    for (uint16_t k = 0; k < f->count; ++k)
    {
        join_patch(list, f, k);
        if (f->sides) join_ridges(list, f, k);
        if (in->domain->any_periodic) join_images(list, in, f, k);
    }
}

/// Does the body pass through a facet, did it, or does it pass through one beside?
static bool is_met(const pls_solid_list *list, const facets *f, uint16_t k)
{
    const size_t c = f->candidate[k];
    if (list->touch[c].delta > 0.0 || list->memory[c].front != 0.0) return true;
    const pls_facet *facet = facet_of(list, c);
    for (int side = 0; side < list->posed[list->pair[c].row_j].shape->dimension; ++side)
    {
        size_t slot;
        const uint16_t other = find(list, f, k, facet->neighbour[side], NUMBER, &slot);
        if (other != NONE && list->touch[f->candidate[other]].delta > 0.0) return true;
    }
    return false;
}

/// The candidate that acts: the one that did, so that its spring goes on, or one that was in its shade.
static size_t leader_of(const pls_solid_list *list, facets *f, uint16_t group)
{
    size_t leader = SIZE_MAX;
    uint32_t was = PLS_SOLID_APART;
    for (uint16_t k = group; k < f->count; ++k)
    {
        if (!f->any[k] || first_of(f, k) != group) continue;
        const size_t c = f->candidate[k];
        const uint32_t now = list->memory[c].touches;
        if (now == PLS_SOLID_TOUCHES) return c;
        if (leader == SIZE_MAX || (was == PLS_SOLID_APART && now == PLS_SOLID_SHADED)) leader = c, was = now;
    }
    return leader;
}

/// What is behind the facets of a group; where that has no force to speak of, the deepest point.
static bool sum_up(pls_solid_list *list, const pls_contact_input *in, facets *f, uint16_t group, pls_touch *touch)
{
    const pls_narrow_options *options = &in->laws->law[list->pair[f->candidate[group]].law].narrow;
    pls_wall_sum sum = {.facets = 0};
    pls_posed body; // the sum refers to it
    const pls_touch *deepest = NULL;
    for (uint16_t k = group; k < f->count; ++k)
    {
        if (first_of(f, k) != group) continue;
        const size_t c = f->candidate[k];
        pls_solid_parts p;
        pls_solid_parts_of(list, in, c, &p);
        if (!sum.a) body = *p.a, sum = pls_wall_sum_of(&body);
        const pls_facet seams = seams_of(list, in, f, k, p.b);
        f->any[k] = pls_wall_add(&sum, p.b, &seams, f->front[k], &list->touch[c]);
        if (f->any[k] && (!deepest || list->touch[c].delta > deepest->delta)) deepest = &list->touch[c];
    }
    if (pls_wall_touch(&sum, options, touch)) return true;
    if (!deepest || !(deepest->delta > 0.0) || !pls_wall_has_point(&body)) return false;
    *touch = *deepest;
    return true;
}

/// Of a body that is on no side.
static double how_far(const pls_solid_list *list, const pls_contact_input *in, size_t c, double depth)
{
    if (list->memory[c].front == PLS_WALL_PASSED) return PLS_WALL_PASSED;
    pls_solid_parts p;
    pls_solid_parts_of(list, in, c, &p);
    return depth > pls_sheet_deepest(p.a) ? PLS_WALL_PASSED : PLS_WALL_TOUCHED;
}

static void touch_group(pls_solid_list *list, const pls_contact_input *in, facets *f, uint16_t group, size_t first, uint8_t *next)
{
    bool met = false;
    for (uint16_t k = group; k < f->count && !met; ++k) met = first_of(f, k) == group && is_met(list, f, k);
    pls_touch touch;
    if (!met || !sum_up(list, in, f, group, &touch)) return;
    const size_t leader = leader_of(list, f, group);
    for (uint16_t k = group; k < f->count; ++k)
    {
        if (!f->any[k] || first_of(f, k) != group) continue;
        next[f->candidate[k] - first] = PLS_SOLID_SHADED;
        list->memory[f->candidate[k]].front = f->sides ? f->front[k] : how_far(list, in, f->candidate[k], touch.depth);
    }
    next[leader - first] = PLS_SOLID_TOUCHES;
    list->touch[leader] = touch;
}

/// On which side of it the body was a facet forgets as soon as it no longer touches.
static void forget_fronts(pls_solid_list *list, size_t first, size_t last, const uint8_t *next)
{
    for (size_t c = first; c < last; ++c)
        if (next[c - first] == PLS_SOLID_APART) list->memory[c].front = 0.0;
}

/// Candidates of one part of a body.
static void group_part(pls_solid_list *list, const pls_contact_input *in, size_t first, size_t last, uint8_t *next)
{
    bool any = false, near = false;
    for (size_t c = first; c < last; ++c)
    {
        if (!list->pair[c].on_wall) continue;
        next[c - first] = PLS_SOLID_APART;
        any = true, near = near || list->touch[c].delta > 0.0 || list->memory[c].front != 0.0;
    }
    if (!any) return;
    if (near)
    {
        facets f;
        find_facets(list, in, first, last, &f);
        find_groups(list, in, &f);
        for (uint16_t k = 0; k < f.count; ++k)
            if (f.group[k] == k && f.front[k] != 0.0) touch_group(list, in, &f, k, first, next);
    }
    forget_fronts(list, first, last, next);
}

void pls_wall_groups(pls_solid_list *list, const pls_contact_input *input, size_t first, size_t last, uint8_t *next)
{
    for (size_t from = first, to; from < last; from = to)
    {
        for (to = from + 1; to < last && list->memory[to].part_i == list->memory[from].part_i;) ++to;
        group_part(list, input, from, to, next + (from - first));
    }
}
