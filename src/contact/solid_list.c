// solid_list.c -- making the list of candidates with solid bodies.
//
// Steps: pairs of bodies from the broad phase and against walls -> pairs of parts -> pairs that touched at the last step wherever they are now (so that their end is
// seen and booked) -> order -> records put back by key -> gather rows.

#include "contact/solid_list.h"

#include "base/alloc.h"
#include "base/sort.h"
#include "contact/contact_memory.h"
#include "contact/overlap_record.h"
#include "contact/sampled_touch.h"
#include "contact/sphere_contact.h"
#include "shape/surface_sample.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

// ---- records ------------------------------------------------------------------------------------------------------------------------------------------------

pls_status pls_solid_records_reserve(pls_solid_records *records, size_t count)
{
    return pls_reserve(&records->entry, &records->capacity, count, sizeof *records->entry, "what contacts of solids remember");
}

void pls_solid_records_free(pls_solid_records *records)
{
    pls_release(&records->entry);
    memset(records, 0, sizeof *records);
}

static int compare_u32(uint32_t a, uint32_t b) { return a < b ? -1 : a > b; }

/// The numbers that a candidate is known by stand first, also where other things are kept by them.
enum { KEY = 5 };
_Static_assert(offsetof(pls_solid_memory, number_i) == 0 && offsetof(pls_solid_memory, image) == (KEY - 1) * sizeof(uint32_t),
               "keys are the first numbers");

static int by_key(const void *a, const void *b)
{
    uint32_t p[KEY], q[KEY];
    memcpy(p, a, sizeof p), memcpy(q, b, sizeof q);
    int order = 0;
    for (int k = 0; k < KEY && order == 0; ++k) order = compare_u32(p[k], q[k]);
    return order;
}

void pls_solid_records_sort(pls_solid_records *records)
{
    if (records->count > 1) qsort(records->entry, records->count, sizeof *records->entry, by_key);
}

pls_status pls_solid_list_remember(const pls_solid_list *list, pls_solid_records *records)
{
    size_t alive = 0;
    for (size_t c = 0; c < list->count; ++c) alive += list->pair[c].tracked;
    records->count = 0;
    PLS_TRY(pls_solid_records_reserve(records, alive));
    for (size_t c = 0; c < list->count; ++c)
        if (list->pair[c].tracked) records->entry[records->count++] = list->memory[c];
    return PLS_OK;
}

size_t pls_solid_list_touching(const pls_solid_list *list)
{
    size_t touching = 0;
    for (size_t c = 0; c < list->count; ++c) touching += list->memory[c].touches == PLS_SOLID_TOUCHES;
    return touching;
}

// ---- parts ----------------------------------------------------------------------------------------------------------------------------------------------------

pls_posed pls_posed_part(const pls_posed *whole, uint32_t part)
{
    if (whole->shape->part_count == 0) return *whole;
    const pls_shape_part *p = &whole->shape->part[part];
    const double scale = whole->scale * p->scale;
    return (pls_posed){.shape = p->shape,
                       .scale = scale,
                       .size = p->shape->radius * scale,
                       .position = pls_posed_world(whole, p->position),
                       .x = pls_posed_turn(whole, pls_rotate(p->orientation, pls_vec(1.0, 0.0, 0.0))),
                       .y = pls_posed_turn(whole, pls_rotate(p->orientation, pls_vec(0.0, 1.0, 0.0))),
                       .z = pls_posed_turn(whole, pls_rotate(p->orientation, pls_vec(0.0, 0.0, 1.0)))};
}

// ---- candidates -------------------------------------------------------------------------------------------------------------------------------------------

static const pls_shape *shape_of_part(const pls_shape *whole, uint32_t part) { return whole->part_count ? whole->part[part].shape : whole; }

static pls_status missing_law(const pls_solid_source *s, uint32_t i, uint32_t j)
{
    const pls_bodies *b = s->bodies;
    const char *first = s->laws->material[b->kind[i].material].name, *second = s->laws->material[b->kind[j].material].name;
    return pls_fail(PLS_NOT_FOUND,
                    "bodies %u and %u come close, but no contact law is given between their materials '%s' and '%s'. Add one: contact: "
                    "[{between: [%s, %s], law: ...}]",
                    b->kind[i].number, b->kind[j].number, first, second, first, second);
}

/// ADMM is for convex shapes; the depth in its place would be another model than was asked for.
static pls_status check_solver(const pls_solid_source *s, const pls_law *law, uint32_t i, uint32_t j, uint32_t part_i, uint32_t part_j)
{
    if (law->narrow.solver != PLS_SOLVER_ADMM) return PLS_OK;
    const pls_bodies *b = s->bodies;
    const bool first = !shape_of_part(s->shape[b->kind[i].shape], part_i)->convex;
    if (!first && shape_of_part(s->shape[b->kind[j].shape], part_j)->convex) return PLS_OK;
    const pls_body_kind *bad = &b->kind[first ? i : j];
    const char *a = s->laws->material[b->kind[i].material].name, *c = s->laws->material[b->kind[j].material].name;
    return pls_fail(
        PLS_INVALID_ARGUMENT,
        "bodies %u and %u come close, and solver admm is set for their materials '%s' and '%s', but the shape of body %u (%s) is "
        "not convex. Set solver depth for this pair, or make the shape a compound of convex ones",
        b->kind[i].number, b->kind[j].number, a, c, bad->number, s->shape[bad->shape]->ops->name);
}

static pls_status room_for(pls_solid_list *list, size_t count)
{
    if (count <= list->capacity) return PLS_OK;
    if (count >= UINT32_MAX / 2) return pls_fail(PLS_LIMIT_EXCEEDED, "%zu pairs of parts are more than the list can hold", count);
    size_t capacity = list->capacity, wanted = count + count / 2 + 64;
    PLS_TRY(pls_reallocate(&list->pair, capacity, wanted, sizeof *list->pair, "pairs of solids"));
    PLS_TRY(pls_reallocate(&list->memory, capacity, wanted, sizeof *list->memory, "pairs of solids"));
    PLS_TRY(pls_reallocate(&list->touch, capacity, wanted, sizeof *list->touch, "pairs of solids"));
    PLS_TRY(pls_reallocate(&list->next, capacity, wanted, sizeof *list->next, "pairs of solids"));
    PLS_TRY(pls_reallocate(&list->record, capacity, wanted, sizeof *list->record, "pairs of solids"));
    PLS_TRY(pls_reallocate(&list->slot, capacity * PLS_SOLID_SLOT, wanted * PLS_SOLID_SLOT, sizeof *list->slot, "pairs of solids"));
    list->capacity = wanted;
    return PLS_OK;
}

/// Half-spaces may let go of bodies; a parameter of theirs says so.
static bool lets_go(const pls_shape *shape)
{
    int place = shape->ops->unbounded && shape->part_count == 0 ? pls_parameter_find(shape->ops->parameters, "lets_go") : -1;
    return place >= 0 && shape->values[place] > 0.5;
}

/// Contacts that go by pieces of surfaces need those of both.
static pls_status sample_parts(const pls_law *law, const pls_shape *a, const pls_shape *b)
{
    if (law->narrow.faces == PLS_FACES_POINT || !pls_is_sampled_pair(a, b)) return PLS_OK;
    PLS_TRY(pls_shape_need_sample(a));
    return pls_shape_need_sample(b);
}

static pls_status add_candidate(pls_solid_list *list, const pls_solid_source *s, const pls_near_pair *pair, uint32_t part_i,
                                uint32_t part_j)
{
    const pls_body_kind *i = &s->bodies->kind[pair->owner], *j = &s->bodies->kind[pair->partner];
    uint16_t law = pls_law_table_find(s->laws, i->material, j->material);
    if (law == PLS_NO_LAW) return missing_law(s, pair->owner, pair->partner);
    PLS_TRY(check_solver(s, &s->laws->law[law], pair->owner, pair->partner, part_i, part_j));
    PLS_TRY(sample_parts(&s->laws->law[law], shape_of_part(s->shape[i->shape], part_i), shape_of_part(s->shape[j->shape], part_j)));
    PLS_TRY(room_for(list, list->count + 1));
    size_t c = list->count++;
    list->pair[c] = (pls_solid_pair){.row_i = pair->owner, .row_j = pair->partner, .law = law, .lets_go = lets_go(s->shape[j->shape])};
    memcpy(list->pair[c].shift, pair->shift, sizeof pair->shift);
    memset(&list->memory[c], 0, sizeof list->memory[c]);
    list->memory[c].number_i = i->number, list->memory[c].number_j = j->number;
    list->memory[c].part_i = part_i, list->memory[c].part_j = part_j;
    if (j->flags & PLS_BODY_UNBOUNDED) list->memory[c].image = pls_image_key(pair->shift);
    return PLS_OK;
}

static pls_posed posed_body(const pls_solid_source *s, uint32_t row)
{
    const pls_body_place *p = &s->bodies->place[row];
    const pls_body_orientation *q = &s->bodies->orientation[row];
    return pls_pose(s->shape[s->bodies->kind[row].shape], pls_vec(p->x, p->y, p->z), (pls_quat){q->w, q->x, q->y, q->z},
                    s->bodies->scale[row]);
}

/// All pairs of parts of two bounded bodies: parts turn with their bodies, so none is left out.
static pls_status add_parts(pls_solid_list *list, const pls_solid_source *s, const pls_near_pair *pair)
{
    const pls_bodies *b = s->bodies;
    uint32_t count_i = pls_part_count(s->shape[b->kind[pair->owner].shape]),
             count_j = pls_part_count(s->shape[b->kind[pair->partner].shape]);
    for (uint32_t p = 0; p < count_i; ++p)
        for (uint32_t q = 0; q < count_j; ++q) PLS_TRY(add_candidate(list, s, pair, p, q));
    return PLS_OK;
}

// ---- walls ----------------------------------------------------------------------------------------------------------------------------------------------------

typedef struct part_numbers
{
    uint32_t *part;
    size_t count, capacity;
} part_numbers;

static pls_status parts_near(const pls_posed *wall, pls_vec3 X, double radius, part_numbers *found)
{
    pls_vec3 own = pls_posed_own(wall, X);
    double reach = radius / wall->scale;
    size_t needed = pls_shape_parts_near(wall->shape, own, reach, found->part, found->capacity);
    if (needed > found->capacity)
    {
        PLS_TRY(pls_reserve(&found->part, &found->capacity, needed, sizeof *found->part, "parts of a wall"));
        needed = pls_shape_parts_near(wall->shape, own, reach, found->part, found->capacity);
    }
    found->count = needed;
    return PLS_OK;
}

/// A box along the axes of the world.
typedef struct world_box
{
    double lower[3], upper[3];
} world_box;

static world_box box_of_wall(const pls_posed *wall)
{
    const pls_vec3 low = wall->shape->lower, up = wall->shape->upper;
    world_box box = {.lower = {INFINITY, INFINITY, INFINITY}, .upper = {-INFINITY, -INFINITY, -INFINITY}};
    for (int k = 0; k < 8; ++k)
    {
        const pls_vec3 corner = pls_posed_world(wall, pls_vec(k & 1 ? up.x : low.x, k & 2 ? up.y : low.y, k & 4 ? up.z : low.z));
        const double x[3] = {corner.x, corner.y, corner.z};
        for (int a = 0; a < 3; ++a) box.lower[a] = fmin(box.lower[a], x[a]), box.upper[a] = fmax(box.upper[a], x[a]);
    }
    return box;
}

/// What the corners of its pieces reach over; `margins` of the pieces may lie on those of images.
static void measure_wall(pls_solid_list *list, const pls_solid_source *s, uint32_t wall, const pls_posed *posed)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    if (!s->domain->any_periodic || (s->bodies->kind[wall].flags & PLS_BODY_SPECIAL)) return;
    for (uint32_t k = 0; k < posed->shape->part_count; ++k)
    {
        const pls_shape_part *part = &posed->shape->part[k];
        const pls_polytope *piece = part->shape->polytope;
        for (uint32_t v = 0; v < piece->vertex_count; ++v)
        {
            const pls_vec3 X = pls_posed_world(posed, pls_part_to_whole(part, piece->vertex[v]));
            const double x[3] = {X.x, X.y, X.z};
            for (int a = 0; a < 3; ++a) low[a] = fmin(low[a], x[a]), high[a] = fmax(high[a], x[a]);
        }
    }
    for (int a = 0; a < 3; ++a)
        if (high[a] - low[a] > list->wall_length[a])
            list->wall_length[a] = high[a] - low[a], list->longest_wall[a] = s->bodies->kind[wall].number;
}

pls_status pls_solid_walls_fit(const pls_solid_list *list, const pls_domain *domain)
{
    const double fits = 1.0 + 1e-9;
    for (int a = 0; a < domain->dimension; ++a)
        if (domain->periodic[a] && list->wall_length[a] > domain->edge[a] * fits)
            return pls_fail(
                PLS_INVALID_ARGUMENT,
                "the wall of pieces that is body %u is %g m long along %c, where the box repeats after %g m: it would lie on its "
                "own image. Cut it to one period",
                list->longest_wall[a], list->wall_length[a], "xyz"[a], domain -> edge[a]);
    return PLS_OK;
}

/// Images of the wall along one axis that may come within `radius` of x; all of them 0 where space does not repeat.
static void images_near(const pls_domain *domain, const world_box *box, int axis, double x, double radius, int image[2])
{
    const double edge = domain->edge[axis], reach = radius * (1.0 + 1e-9);
    image[0] = image[1] = 0;
    if (!domain->periodic[axis]) return;
    image[0] = (int)fmax(INT16_MIN, ceil((x - reach - box->upper[axis]) / edge));
    image[1] = (int)fmin(INT16_MAX, floor((x + reach - box->lower[axis]) / edge));
}

/// About a body's centre of mass, what lies within the bounding spheres of its parts, and a little more: to solids facets matter that they are only near to (wall_groups.c).
static double reach_at_walls(const pls_shape *shape, double scale)
{
    double reach = shape->part_count ? 0.0 : shape->radius;
    for (size_t k = 0; k < shape->part_count; ++k)
    {
        const pls_shape_part *part = &shape->part[k];
        const pls_vec3 centre = pls_part_to_whole(part, part->shape->mass.centre);
        reach = fmax(reach, pls_length(pls_sub(centre, shape->mass.centre)) + part->scale * part->shape->radius);
    }
    return reach * scale * (1.0 + PLS_NARROW_FAR);
}

/// Candidates of one body with the pieces of a wall and of its images.
static pls_status pieces_near(pls_solid_list *list, const pls_solid_source *s, uint32_t wall, const pls_posed *posed, const world_box *box,
                              uint32_t row, part_numbers *found)
{
    const pls_body_place *p = &s->bodies->place[row];
    const bool solid = (s->bodies->kind[row].flags & PLS_BODY_SOLID) != 0;
    const double own = solid ? reach_at_walls(s->shape[s->bodies->kind[row].shape], s->bodies->scale[row]) : p->radius;
    const double x[3] = {p->x, p->y, p->z}, radius = own + s->gap, *edge = s->domain->edge;
    const uint32_t parts = pls_part_count(s->shape[s->bodies->kind[row].shape]);
    int image[3][2];
    for (int a = 0; a < 3; ++a) images_near(s->domain, box, a, x[a], radius, image[a]);
    for (int i = image[0][0]; i <= image[0][1]; ++i)
        for (int j = image[1][0]; j <= image[1][1]; ++j)
            for (int k = image[2][0]; k <= image[2][1]; ++k)
            {
                const pls_near_pair pair = {.owner = row, .partner = wall, .shift = {(int16_t)i, (int16_t)j, (int16_t)k}};
                pls_vec3 X = pls_vec(x[0], x[1], x[2]); // as the wall itself sees it
                if (s->domain->any_periodic) X = pls_sub(X, pls_vec(i * edge[0], j * edge[1], k * edge[2]));
                PLS_TRY(parts_near(posed, X, radius, found));
                for (uint32_t part = 0; part < parts; ++part)
                    for (size_t m = 0; m < found->count; ++m) PLS_TRY(add_candidate(list, s, &pair, part, found->part[m]));
            }
    return PLS_OK;
}

/// Bodies near a wall of pieces.
static pls_status one_wall(pls_solid_list *list, const pls_solid_source *s, uint32_t wall, part_numbers *found)
{
    const pls_bodies *b = s->bodies;
    const pls_posed posed = posed_body(s, wall);
    const world_box box = box_of_wall(&posed);
    measure_wall(list, s, wall, &posed);
    for (uint32_t row = 0; row < b->count; ++row)
    {
        if ((b->kind[row].flags & PLS_BODY_UNBOUNDED) || !pls_pair_matters(b, row, wall)) continue;
        PLS_TRY(pieces_near(list, s, wall, &posed, &box, row, found));
    }
    return PLS_OK;
}

/// Bodies near a half-space. One that turns sweeps far points quickly: every body is in its list then.
static pls_status one_half_space(pls_solid_list *list, const pls_solid_source *s, uint32_t wall)
{
    const pls_bodies *b = s->bodies;
    const pls_body_place *w = &b->place[wall];
    const pls_vec3 n = pls_wall_normal(&b->orientation[wall], s->domain->dimension);
    const double gap = pls_wall_sweeps(b, wall) ? INFINITY : s->gap;
    for (uint32_t row = 0; row < b->count; ++row)
    {
        const pls_body_place *p = &b->place[row];
        if ((b->kind[row].flags & PLS_BODY_UNBOUNDED) || !(b->kind[row].flags & PLS_BODY_SOLID)) continue;
        if (!pls_pair_matters(b, row, wall)) continue;
        const pls_near_pair pair = {.owner = row, .partner = wall};
        const double height = n.x * (p->x - w->x) + n.y * (p->y - w->y) + n.z * (p->z - w->z);
        if (!(height < p->radius + gap)) continue;
        const uint32_t parts = pls_part_count(s->shape[b->kind[row].shape]);
        for (uint32_t k = 0; k < parts; ++k) PLS_TRY(add_candidate(list, s, &pair, k, 0));
    }
    return PLS_OK;
}

static pls_status add_walls(pls_solid_list *list, const pls_solid_source *s)
{
    part_numbers found = {0};
    pls_status status = PLS_OK;
    for (int a = 0; a < 3; ++a) list->wall_length[a] = 0.0;
    for (uint32_t number = 0; status == PLS_OK && number < s->bodies->numbers; ++number)
    {
        uint32_t row = s->bodies->row_of[number];
        if (row == PLS_NO_ROW || !(s->bodies->kind[row].flags & PLS_BODY_UNBOUNDED)) continue;
        const bool pieces = (s->bodies->kind[row].flags & PLS_BODY_SOLID) != 0;
        status = pieces ? one_wall(list, s, row, &found) : one_half_space(list, s, row);
    }
    pls_release(&found.part);
    return status;
}

// ---- records put back -------------------------------------------------------------------------------------------------------------------------------------

/// The record of a key among sorted ones, or null.
static const pls_solid_memory *find_record(const pls_solid_records *records, const pls_solid_memory *key)
{
    return records->count ? bsearch(key, records->entry, records->count, sizeof *records->entry, by_key) : NULL;
}

/// The image of a wall that a record means: of those with its key the one nearest to `here`.
static int16_t image_of_key(uint32_t key, int axis, int16_t here)
{
    const int there = (int)(key >> (2 - axis) * PLS_IMAGE_BITS & (PLS_IMAGES - 1));
    int further = (there - here) & (PLS_IMAGES - 1);
    if (further >= PLS_IMAGES / 2) further -= PLS_IMAGES;
    return (int16_t)(here + further);
}

/// Candidates of pairs that touched but have left the gap within a step. `listed`: the candidates so far, sorted by key.
static pls_status add_kept(pls_solid_list *list, const pls_solid_source *s, const pls_solid_records *records,
                           const pls_solid_records *listed)
{
    const pls_bodies *b = s->bodies;
    for (size_t k = 0; k < records->count; ++k)
    {
        const pls_solid_memory *record = &records->entry[k];
        if (record->touches == PLS_SOLID_APART || find_record(listed, record)) continue;
        pls_near_pair pair = {.owner = b->row_of[record->number_i], .partner = b->row_of[record->number_j]};
        if (pair.owner == PLS_NO_ROW || pair.partner == PLS_NO_ROW || !pls_pair_matters(b, pair.owner, pair.partner)) continue;
        const pls_body_place *p = &b->place[pair.owner], *q = &b->place[pair.partner];
        const double d[3] = {q->x - p->x, q->y - p->y, q->z - p->z};
        const unsigned flags = b->kind[pair.partner].flags;
        for (int a = 0; a < 3; ++a)
        {
            const int16_t nearest = pls_nearest_image(d[a], s->domain->edge[a]);
            pair.shift[a] = !(flags & PLS_BODY_UNBOUNDED) ? nearest : flags & PLS_BODY_SOLID ? image_of_key(record->image, a, nearest) : 0;
        }
        PLS_TRY(add_candidate(list, s, &pair, record->part_i, record->part_j));
    }
    return PLS_OK;
}

static pls_status find_kept(pls_solid_list *list, const pls_solid_source *s, const pls_solid_records *records)
{
    bool any = false;
    for (size_t k = 0; k < records->count; ++k) any = any || records->entry[k].touches != PLS_SOLID_APART;
    if (!any) return PLS_OK;
    pls_solid_records listed = {0};
    pls_status status = pls_solid_records_reserve(&listed, list->count);
    if (status == PLS_OK)
    {
        if (list->count > 0) memcpy(listed.entry, list->memory, list->count * sizeof *listed.entry);
        listed.count = list->count;
        pls_solid_records_sort(&listed);
        status = add_kept(list, s, records, &listed);
    }
    pls_solid_records_free(&listed);
    return status;
}

static void put_back(pls_solid_list *list, const pls_solid_records *records)
{
    for (size_t c = 0; c < list->count; ++c)
    {
        const pls_solid_memory *record = find_record(records, &list->memory[c]);
        if (!record) continue;
        list->memory[c] = *record;
        list->pair[c].tracked = 1;
    }
}

// ---- overlaps put back ------------------------------------------------------------------------------------------------------------------------------------

/// What is known of an overlap is dear to find (`pls_overlap_find`), and holds or is seen not to whatever list it stands in.
typedef struct kept_overlap
{
    uint32_t key[KEY];
    pls_overlap_record record;
} kept_overlap;

typedef struct kept_overlaps
{
    kept_overlap *entry; ///< in order of keys
    size_t count;
} kept_overlaps;

/// Of the list that is about to be replaced, `count` candidates long.
static pls_status take_overlaps(const pls_solid_list *list, size_t count, kept_overlaps *kept)
{
    size_t known = 0;
    for (size_t c = 0; c < count; ++c) known += list->record[c].known;
    if (known == 0) return PLS_OK;
    PLS_TRY(pls_allocate(&kept->entry, known, sizeof *kept->entry, "overlaps of solids"));
    for (size_t c = 0; c < count; ++c)
    {
        if (!list->record[c].known) continue;
        kept_overlap *entry = &kept->entry[kept->count++];
        memcpy(entry->key, &list->memory[c], sizeof entry->key);
        entry->record = list->record[c];
    }
    qsort(kept->entry, kept->count, sizeof *kept->entry, by_key);
    return PLS_OK;
}

static void put_back_overlaps(pls_solid_list *list, const kept_overlaps *kept)
{
    for (size_t c = 0; c < list->count; ++c)
    {
        const kept_overlap *entry = kept->count ? bsearch(&list->memory[c], kept->entry, kept->count, sizeof *kept->entry, by_key) : NULL;
        if (entry)
            list->record[c] = entry->record;
        else
            list->record[c].known = 0;
    }
}

// ---- order ----------------------------------------------------------------------------------------------------------------------------------------------------

/// Candidates as they were found, to be sorted.
typedef struct found_pair
{
    uint32_t lower, upper, part_i, part_j, image;
    pls_solid_pair pair;
    uint32_t number_i, number_j;
} found_pair;

static int by_rows(const void *a, const void *b)
{
    const found_pair *p = a, *q = b;
    int order = compare_u32(p->lower, q->lower);
    if (order == 0) order = compare_u32(p->upper, q->upper);
    if (order == 0) order = compare_u32(p->part_i, q->part_i);
    if (order == 0) order = compare_u32(p->part_j, q->part_j);
    return order ? order : compare_u32(p->image, q->image);
}

static pls_status order_candidates(pls_solid_list *list)
{
    found_pair *found = NULL;
    PLS_TRY(pls_allocate(&found, list->count, sizeof *found, "ordering pairs of solids"));
    for (size_t c = 0; c < list->count; ++c)
    {
        const pls_solid_pair *p = &list->pair[c];
        const pls_solid_memory *m = &list->memory[c];
        found[c] = (found_pair){.lower = p->row_i < p->row_j ? p->row_i : p->row_j,
                                .upper = p->row_i < p->row_j ? p->row_j : p->row_i,
                                .part_i = m->part_i,
                                .part_j = m->part_j,
                                .image = m->image,
                                .pair = *p,
                                .number_i = m->number_i,
                                .number_j = m->number_j};
    }
    if (list->count > 1) qsort(found, list->count, sizeof *found, by_rows);
    for (size_t c = 0; c < list->count; ++c)
    {
        list->pair[c] = found[c].pair;
        memset(&list->memory[c], 0, sizeof list->memory[c]);
        list->memory[c].number_i = found[c].number_i, list->memory[c].number_j = found[c].number_j;
        list->memory[c].part_i = found[c].part_i, list->memory[c].part_j = found[c].part_j;
        list->memory[c].image = found[c].image;
    }
    pls_release(&found);
    return PLS_OK;
}

static bool same_bodies(const pls_solid_list *list, size_t a, size_t b)
{
    return list->pair[a].row_i == list->pair[b].row_i && list->pair[a].row_j == list->pair[b].row_j;
}

static pls_status cut_blocks(pls_solid_list *list)
{
    list->block_count = 0;
    for (size_t first = 0, last; first < list->count; first = last)
    {
        last = first + PLS_SOLID_BLOCK < list->count ? first + PLS_SOLID_BLOCK : list->count;
        while (last < list->count && same_bodies(list, last - 1, last)) ++last;
        PLS_TRY(pls_reserve(&list->block, &list->block_capacity, list->block_count + 1, sizeof *list->block, "blocks of solids"));
        list->block[list->block_count++] = (pls_solid_block){(uint32_t)first, (uint32_t)last};
    }
    return PLS_OK;
}

// ---- gather rows ------------------------------------------------------------------------------------------------------------------------------------------

/// Of a body's entries, in order of the partner's number: entries of one partner are in order of parts already.
static pls_status order_row(const pls_solid_list *list, uint32_t *entry, size_t n)
{
    uint32_t *keys = NULL;
    if (n < 2) return PLS_OK;
    PLS_TRY(pls_allocate(&keys, n, sizeof *keys, "gather rows of solids"));
    for (size_t k = 0; k < n; ++k)
    {
        const pls_solid_memory *m = &list->memory[entry[k] >> 1];
        keys[k] = (entry[k] & 1) ? m->number_i : m->number_j;
    }
    pls_status status = pls_radix_sort_u32(keys, entry, n);
    pls_release(&keys);
    return status;
}

static pls_status gather_rows(pls_solid_list *list, size_t rows)
{
    PLS_TRY(pls_reserve(&list->start, &list->start_capacity, rows + 2, sizeof *list->start, "gather rows of solids"));
    PLS_TRY(pls_reserve(&list->entry, &list->entry_capacity, 2 * list->count, sizeof *list->entry, "gather rows of solids"));
    memset(list->start, 0, (rows + 2) * sizeof *list->start);
    for (size_t c = 0; c < list->count; ++c) ++list->start[list->pair[c].row_i + 2], ++list->start[list->pair[c].row_j + 2];
    for (size_t row = 2; row < rows + 2; ++row) list->start[row] += list->start[row - 1];
    for (size_t c = 0; c < list->count; ++c)
    {
        list->entry[list->start[list->pair[c].row_i + 1]++] = (uint32_t)(2 * c);
        list->entry[list->start[list->pair[c].row_j + 1]++] = (uint32_t)(2 * c + 1);
    }
    PLS_TRY(pls_reserve(&list->row, &list->row_capacity, rows, sizeof *list->row, "rows of solids"));
    list->row_count = 0;
    for (uint32_t row = 0; row < rows; ++row)
    {
        if (list->start[row + 1] == list->start[row]) continue;
        list->row[list->row_count++] = row;
        PLS_TRY(order_row(list, list->entry + list->start[row], list->start[row + 1] - list->start[row]));
    }
    return pls_reserve(&list->posed, &list->posed_capacity, rows, sizeof *list->posed, "poses of solids");
}

// ---- the whole --------------------------------------------------------------------------------------------------------------------------------------------

static pls_status build(pls_solid_list *list, const pls_solid_source *s, const pls_solid_records *records, const kept_overlaps *kept)
{
    for (size_t k = 0; k < s->near->count; ++k)
        if (pls_pair_is_solid(s->bodies, s->near->pair[k].owner, s->near->pair[k].partner)) PLS_TRY(add_parts(list, s, &s->near->pair[k]));
    PLS_TRY(add_walls(list, s));
    PLS_TRY(find_kept(list, s, records));
    PLS_TRY(order_candidates(list));
    put_back(list, records);
    put_back_overlaps(list, kept);
    PLS_TRY(cut_blocks(list));
    PLS_TRY(gather_rows(list, s->bodies->count));
    if (list->count > 0) memset(list->slot, 0, list->count * PLS_SOLID_SLOT * sizeof *list->slot);
    if (list->count > 0) memset(list->touch, 0, list->count * sizeof *list->touch);
    return PLS_OK;
}

static void empty(pls_solid_list *list) { list->count = list->block_count = list->row_count = 0; }

pls_status pls_solid_list_build(pls_solid_list *list, const pls_solid_source *source, const pls_solid_records *records)
{
    const size_t before = list->count;
    kept_overlaps kept = {0};
    empty(list);
    bool any = false;
    for (size_t row = 0; row < source->bodies->count && !any; ++row) any = (source->bodies->kind[row].flags & PLS_BODY_SOLID) != 0;
    if (!any) return PLS_OK;
    pls_status status = take_overlaps(list, before, &kept);
    if (status == PLS_OK) status = build(list, source, records, &kept);
    if (status != PLS_OK) empty(list);
    pls_release(&kept.entry);
    return status;
}

void pls_solid_list_forget(pls_solid_list *list) { empty(list); }

size_t pls_solid_list_bytes(const pls_solid_list *list)
{
    return list->capacity * (sizeof *list->pair + sizeof *list->memory + sizeof *list->touch + sizeof *list->next + sizeof *list->record +
                             PLS_SOLID_SLOT * sizeof *list->slot) +
           list->block_capacity * sizeof *list->block + list->entry_capacity * sizeof *list->entry;
}

void pls_solid_list_free(pls_solid_list *list)
{
    pls_release(&list->pair);
    pls_release(&list->memory);
    pls_release(&list->touch);
    pls_release(&list->next);
    pls_release(&list->record);
    pls_release(&list->slot);
    pls_release(&list->block);
    pls_release(&list->start);
    pls_release(&list->entry);
    pls_release(&list->posed);
    pls_release(&list->row);
    memset(list, 0, sizeof *list);
}
