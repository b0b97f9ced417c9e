// pair_list.c -- making the Verlet list.
//
// Steps: near pairs from the broad phase, body-wall pairs, and pairs that touched at the last step wherever they are now -> sections by law (stable, so each keeps
// the order of rows) -> memory of contacts put back by
// number -> gather rows, each in order of the partner's number.

#include "contact/pair_list.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "base/sort.h"
#include "contact/broad_phase.h"
#include "contact/contact_memory.h"
#include "contact/sphere_contact.h"
#include "contact/sweep_plan.h"

#include <string.h>

/// Room for `needed` items whose old contents may go. Lists change little from one to the next, so a sixteenth to spare is enough; what a list of a larger skin
/// needed is given back.
static pls_status renew(void *block, size_t *capacity, size_t needed, size_t size, const char *what)
{
    if (needed <= *capacity && *capacity - needed <= needed / 4 + 64) return PLS_OK;
    pls_release(block);
    *capacity = 0;
    PLS_TRY(pls_allocate(block, needed + needed / 16, size, what));
    *capacity = needed + needed / 16;
    return PLS_OK;
}

size_t pls_pair_list_touching(const pls_pair_list *list)
{
    size_t count = 0;
    for (size_t k = 0; k < list->count / 8; ++k) count += (size_t)__builtin_popcount(list->touch[k]);
    return count;
}

// ---- sections ---------------------------------------------------------------------------------------------------------------------------------------

static pls_status missing_law(const pls_bodies *bodies, const pls_law_table *laws, uint32_t i, uint32_t j)
{
    const char *a = laws->material[bodies->kind[i].material].name, *b = laws->material[bodies->kind[j].material].name;
    return pls_fail(PLS_NOT_FOUND,
                    "bodies %u and %u come close, but no contact law is given between their materials '%s' and '%s'. Add one: contact: "
                    "[{between: [%s, %s], law: ...}]",
                    bodies->kind[i].number, bodies->kind[j].number, a, b, a, b);
}

static pls_status add_section(pls_pair_list *list, const pls_law_table *laws, uint16_t law, bool wall, uint32_t wall_row, size_t count)
{
    PLS_TRY(
        pls_reserve(&list->section, &list->section_capacity, list->section_count + 1, sizeof *list->section, "sections of the pair list"));
    pls_pair_section *section = &list->section[list->section_count++];
    *section = (pls_pair_section){.wall = wall, .wall_row = wall_row, .law = law, .depth = INFINITY, .first = list->count, .count = count};
    section->numbers = 3 + laws->law[law].ops->history;
    list->count += (count + 7) / 8 * 8;
    list->listed += count;
    return PLS_OK;
}

/// Count sphere pairs per law and lay out their sections; `next` of a law becomes its first candidate.
static pls_status pair_sections(pls_pair_list *list, const pls_bodies *bodies, const pls_law_table *laws, const pls_near_pairs *near,
                                size_t *next)
{
    for (size_t k = 0; k < near->count; ++k)
    {
        uint32_t i = near->pair[k].owner, j = near->pair[k].partner;
        uint16_t law = pls_law_table_find(laws, bodies->kind[i].material, bodies->kind[j].material);
        if (law == PLS_NO_LAW) return missing_law(bodies, laws, i, j);
        ++next[law];
    }
    for (size_t law = 0; law < laws->law_count; ++law)
    {
        if (next[law] == 0) continue;
        size_t first = list->count;
        PLS_TRY(add_section(list, laws, (uint16_t)law, false, 0, next[law]));
        next[law] = first;
    }
    return PLS_OK;
}

typedef struct wall_pairs
{
    uint32_t *row; ///< bodies near walls, wall after wall
    size_t count, capacity;
} wall_pairs;

/// Bodies near one wall, one section per law.
static pls_status one_wall(pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, const pls_law_table *laws, double gap,
                           const pls_kept_pairs *kept, uint32_t wall, wall_pairs *found)
{
    pls_vec3 n = pls_wall_normal(&bodies->orientation[wall], domain->dimension);
    const pls_body_place *w = &bodies->place[wall];
    if (pls_wall_sweeps(bodies, wall)) gap = INFINITY;
    for (size_t law = 0; law < laws->law_count; ++law)
    {
        size_t first = found->count;
        for (size_t row = 0; row < bodies->count; ++row)
        {
            const pls_body_place *p = &bodies->place[row];
            double height = n.x * (p->x - w->x) + n.y * (p->y - w->y) + n.z * (p->z - w->z);
            if (bodies->kind[row].flags & (PLS_BODY_UNBOUNDED | PLS_BODY_SOLID)) continue;
            if (!(height < p->radius + gap) && !pls_is_kept_at_wall(kept, wall, row)) continue;
            if (!pls_pair_matters(bodies, (uint32_t)row, wall)) continue;
            uint16_t its = pls_law_table_find(laws, bodies->kind[row].material, bodies->kind[wall].material);
            if (its == PLS_NO_LAW) return missing_law(bodies, laws, (uint32_t)row, wall);
            if (its != law) continue;
            if (found->count == found->capacity)
                PLS_TRY(pls_reserve(&found->row, &found->capacity, found->count + 1024, sizeof *found->row, "pairs of bodies and walls"));
            found->row[found->count++] = (uint32_t)row;
        }
        if (found->count > first) PLS_TRY(add_section(list, laws, (uint16_t)law, true, wall, found->count - first));
    }
    return PLS_OK;
}

static pls_status wall_sections(pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, const pls_law_table *laws,
                                double gap, const pls_kept_pairs *kept, wall_pairs *found)
{
    list->wall_first = list->count;
    for (uint32_t number = 0; number < bodies->numbers; ++number) // in order of numbers: sections do not depend on memory order
    {
        uint32_t row = bodies->row_of[number];
        if (row != PLS_NO_ROW && (bodies->kind[row].flags & (PLS_BODY_UNBOUNDED | PLS_BODY_SOLID)) == PLS_BODY_UNBOUNDED)
            PLS_TRY(one_wall(list, bodies, domain, laws, gap, kept, row, found));
    }
    return PLS_OK;
}

static pls_status reserve_candidates(pls_pair_list *list, bool periodic)
{
    size_t history = 0, count = list->count;
    if (count >= UINT32_MAX / 2)
        return pls_fail(PLS_LIMIT_EXCEEDED, "%zu pairs are more than the %u the pair list can hold", count, UINT32_MAX / 2);
    for (size_t s = 0; s < list->section_count; ++s)
    {
        list->section[s].history = history;
        history += (list->section[s].count + 7) / 8 * 8 * (size_t)list->section[s].numbers;
    }
    size_t reach = count + PLS_PAIR_REACH;
    PLS_TRY(renew(&list->row_i, &list->row_i_capacity, reach, sizeof *list->row_i, "the pair list"));
    PLS_TRY(renew(&list->row_j, &list->row_j_capacity, reach, sizeof *list->row_j, "the pair list"));
    if (periodic) PLS_TRY(renew(&list->shift, &list->shift_capacity, count, sizeof *list->shift, "the images of pairs"));
    PLS_TRY(renew(&list->touch, &list->touch_capacity, count / 8 + 1, 1, "the touching pairs"));
    PLS_TRY(renew(&list->ended, &list->ended_capacity, count / 8 + 1, 1, "the pairs that part"));
    PLS_TRY(renew(&list->history, &list->history_capacity, history, sizeof *list->history, "the history of contacts"));
    size_t slots = (list->wall_first + 1) * PLS_SLOT + (count - list->wall_first) * PLS_WALL_SLOT;
    PLS_TRY(renew(&list->slot, &list->slot_capacity, slots, sizeof *list->slot, "the forces of contacts"));
    if (!list->equal_radii)
    {
        PLS_TRY(renew(&list->skew, &list->skew_capacity, list->wall_first + 1, sizeof *list->skew, "the forces of contacts"));
        memset(list->skew, 0, (list->wall_first + 1) * sizeof *list->skew);
    }
    if (history > 0) memset(list->history, 0, history * sizeof *list->history); // vectors of eight read what no contact has written
    memset(list->touch, 0, count / 8 + 1);
    memset(list->ended, 0, count / 8 + 1);
    memset(list->row_i, 0, reach * sizeof *list->row_i);
    memset(list->row_j, 0, reach * sizeof *list->row_j);
    if (count == 0) return PLS_OK;
    if (periodic) memset(list->shift, 0, count * sizeof *list->shift);
    return PLS_OK;
}

static pls_status cut_sections(pls_pair_list *list, bool walls)
{
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        if (section->wall != walls) continue;
        size_t blocks = pls_block_count(section->count, PLS_CONTACT_BLOCK);
        PLS_TRY(
            pls_reserve(&list->block, &list->block_capacity, list->block_count + blocks, sizeof *list->block, "blocks of the pair list"));
        for (size_t b = 0; b < blocks; ++b)
            list->block[list->block_count++] =
                (pls_pair_block){.section = (uint32_t)s,
                                 .first = section->first + b * PLS_CONTACT_BLOCK,
                                 .count = (uint32_t)(pls_block_end(b, PLS_CONTACT_BLOCK, section->count) - b * PLS_CONTACT_BLOCK)};
    }
    return PLS_OK;
}

/// Blocks of several sections of pairs, in order of their first rows.
static pls_status order_blocks(pls_pair_list *list)
{
    size_t count = list->block_count - list->wall_blocks;
    if (list->section_count < 2 || count < 2) return PLS_OK;
    pls_pair_block *mine = list->block + list->wall_blocks, *copy = NULL;
    uint32_t *keys = NULL, *order = NULL;
    pls_status status = pls_allocate(&keys, count, sizeof *keys, "blocks of the pair list");
    if (status == PLS_OK) status = pls_allocate(&order, count, sizeof *order, "blocks of the pair list");
    if (status == PLS_OK) status = pls_allocate(&copy, count, sizeof *copy, "blocks of the pair list");
    for (size_t b = 0; status == PLS_OK && b < count; ++b)
    {
        keys[b] = pls_pair_lower_row(list, mine[b].first);
        order[b] = (uint32_t)b;
        copy[b] = mine[b];
    }
    if (status == PLS_OK) status = pls_radix_sort_u32(keys, order, count);
    for (size_t b = 0; status == PLS_OK && b < count; ++b) mine[b] = copy[order[b]];
    pls_release(&keys);
    pls_release(&order);
    pls_release(&copy);
    return status;
}

static pls_status cut_blocks(pls_pair_list *list)
{
    list->block_count = 0;
    PLS_TRY(cut_sections(list, true));
    list->wall_blocks = list->block_count;
    PLS_TRY(cut_sections(list, false));
    return order_blocks(list);
}

static void fill_candidates(pls_pair_list *list, const pls_bodies *bodies, const pls_law_table *laws, const pls_near_pairs *near,
                            const wall_pairs *found, size_t *next, bool periodic)
{
    for (size_t k = 0; k < near->count; ++k)
    {
        const pls_near_pair *pair = &near->pair[k];
        size_t c = next[pls_law_table_find(laws, bodies->kind[pair->owner].material, bodies->kind[pair->partner].material)]++;
        list->row_i[c] = pair->owner;
        list->row_j[c] = pair->partner;
        if (periodic) memcpy(list->shift[c], pair->shift, sizeof pair->shift);
    }
    size_t taken = 0;
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        for (size_t k = 0; section->wall && k < section->count; ++k)
        {
            list->row_i[section->first + k] = found->row[taken++];
            list->row_j[section->first + k] = section->wall_row;
        }
        for (size_t c = section->first + section->count; c % 8 != 0; ++c)
        {
            list->row_i[c] = list->row_i[c - 1];
            list->row_j[c] = list->row_j[c - 1];
            if (periodic) memcpy(list->shift[c], list->shift[c - 1], sizeof list->shift[c]);
        }
    }
}

// ---- gather rows ------------------------------------------------------------------------------------------------------------------------------------

static uint32_t partner_number(const pls_pair_list *list, const pls_bodies *bodies, uint32_t entry)
{
    size_t c = entry >> 1;
    return bodies->kind[(entry & 1) ? list->row_i[c] : list->row_j[c]].number;
}

/// Rows of the candidates first .. last for every body, each row in order of the partner's number.
static pls_status gather_rows(pls_gather_rows *rows, const pls_pair_list *list, const pls_bodies *bodies, bool walls)
{
    size_t entries = 0;
    PLS_TRY(pls_reserve(&rows->start, &rows->start_capacity, bodies->count + 2, sizeof *rows->start, "gather rows"));
    memset(rows->start, 0, (bodies->count + 2) * sizeof *rows->start);
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        if (section->wall != walls) continue;
        entries += 2 * section->count;
        for (size_t c = section->first; c < section->first + section->count; ++c)
        {
            ++rows->start[list->row_i[c] + 2];
            ++rows->start[list->row_j[c] + 2];
        }
    }
    PLS_TRY(renew(&rows->entry, &rows->entry_capacity, entries, sizeof *rows->entry, "gather rows"));
    for (size_t row = 2; row < bodies->count + 2; ++row) rows->start[row] += rows->start[row - 1];
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        if (section->wall != walls) continue;
        for (size_t c = section->first; c < section->first + section->count; ++c)
        {
            rows->entry[rows->start[list->row_i[c] + 1]++] = (uint32_t)(2 * c);
            rows->entry[rows->start[list->row_j[c] + 1]++] = (uint32_t)(2 * c + 1);
        }
    }
    pls_status worst = PLS_OK;
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t row = 0; row < bodies->count; ++row)
    {
        uint32_t *e = rows->entry + rows->start[row];
        size_t n = rows->start[row + 1] - rows->start[row];
        if (n > PLS_LONG_ROW) // a wall or a body far larger than its neighbours
        {
            uint32_t *keys = NULL;
            pls_status status = pls_allocate(&keys, n, sizeof *keys, "ordering gather rows");
            if (status == PLS_OK)
            {
                for (size_t k = 0; k < n; ++k) keys[k] = partner_number(list, bodies, e[k]);
                status = pls_radix_sort_u32(keys, e, n);
            }
            pls_release(&keys);
            if (status != PLS_OK)
            {
#pragma omp critical(pls_gather_failure)
                worst = status;
            }
            continue;
        }
        for (size_t k = 1; k < n; ++k)
        {
            uint32_t moving = e[k], key = partner_number(list, bodies, moving);
            size_t m = k;
            for (; m > 0 && partner_number(list, bodies, e[m - 1]) > key; --m) e[m] = e[m - 1];
            e[m] = moving;
        }
    }
    if (worst != PLS_OK) return pls_fail(worst, "no memory to order the gather rows");
    return PLS_OK;
}

// ---- the whole --------------------------------------------------------------------------------------------------------------------------------------

static pls_status keep_reference(pls_pair_list *list, const pls_bodies *bodies)
{
    size_t capacity = list->reference_capacity;
    PLS_TRY(pls_reserve(&list->reference, &capacity, bodies->count, sizeof *list->reference, "positions when the pair list was made"));
    capacity = list->reference_capacity;
    PLS_TRY(pls_reserve(&list->reference_radius, &capacity, bodies->count, sizeof *list->reference_radius,
                        "radii when the pair list was made"));
    list->reference_capacity = capacity;
#pragma omp parallel for schedule(static)
    for (size_t row = 0; row < bodies->count; ++row)
    {
        list->reference[row][0] = bodies->place[row].x;
        list->reference[row][1] = bodies->place[row].y;
        list->reference[row][2] = bodies->place[row].z;
        list->reference_radius[row] = bodies->place[row].radius;
    }
    return PLS_OK;
}

/// Nothing is known of which entries touch: every row is stale.
static pls_status forget_touching_entries(pls_pair_list *list, size_t rows)
{
    size_t room = list->pairs.start[rows] + rows * PLS_NEAR_SPARE;
    PLS_TRY(renew(&list->near, &list->near_capacity, room, sizeof *list->near, "touching entries"));
    for (size_t row = 0; row < rows; ++row) pls_near_row(list, row)[0] = PLS_NEAR_STALE;
    return PLS_OK;
}

static pls_status lay_out(pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, const pls_law_table *laws, double skin,
                          const pls_near_pairs *near, const pls_kept_pairs *kept, wall_pairs *found, size_t *next)
{
    PLS_TRY(pair_sections(list, bodies, laws, near, next));
    PLS_TRY(wall_sections(list, bodies, domain, laws, skin, kept, found));
    PLS_TRY(reserve_candidates(list, domain->any_periodic));
    fill_candidates(list, bodies, laws, near, found, next, domain->any_periodic);
    return cut_blocks(list);
}

static bool have_equal_radii(const pls_bodies *bodies)
{
    double first = INFINITY;
    for (size_t row = 0; row < bodies->count; ++row)
    {
        if (bodies->kind[row].flags & PLS_BODY_UNBOUNDED) continue;
        if (first == INFINITY) first = bodies->place[row].radius;
        if (bodies->place[row].radius != first) return false;
    }
    return true;
}

pls_status pls_pair_list_build(pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, const pls_law_table *laws,
                               pls_near_pairs *near, double skin, bool growing, const pls_contact_memory *memory)
{
    list->section_count = list->block_count = list->count = list->wall_first = list->listed = 0;
    list->stale = true; // until it is whole
    list->equal_radii = !growing && have_equal_radii(bodies);
    pls_kept_pairs kept = {0};
    wall_pairs found = {0};
    size_t *next = NULL;
    pls_status status = pls_find_kept(&kept, bodies, domain, skin, memory);
    if (status == PLS_OK) status = pls_add_kept(near, &kept, bodies, domain);
    if (status == PLS_OK) status = pls_allocate(&next, laws->law_count + 1, sizeof *next, "sections of the pair list");
    if (status == PLS_OK) status = lay_out(list, bodies, domain, laws, skin, near, &kept, &found, next);
    pls_kept_pairs_free(&kept);
    pls_release(&found.row);
    pls_release(&next);
    if (status == PLS_OK) status = pls_contact_memory_put_back(list, bodies, memory);
    if (status == PLS_OK) status = gather_rows(&list->pairs, list, bodies, false);
    if (status == PLS_OK) status = gather_rows(&list->walls, list, bodies, true);
    if (status == PLS_OK) status = pls_sweep_plan_make(list, bodies->count, pls_threads() == 1);
    if (status == PLS_OK) status = forget_touching_entries(list, bodies->count);
    if (status == PLS_OK) status = keep_reference(list, bodies);
    if (status != PLS_OK)
    {
        list->section_count = list->block_count = list->count = list->wall_first = list->listed = 0;
        return status;
    }
    for (int a = 0; a < 3; ++a) list->image_reach[a] = 1.0;
    for (size_t c = 0; domain->any_periodic && c < list->wall_first; ++c)
        for (int a = 0; a < 3; ++a) list->image_reach[a] = fmax(list->image_reach[a], fabs((double)list->shift[c][a]) + 1.0);
    list->skin = skin;
    list->holds_some = false;
    list->drift = list->image_drift = 0.0;
    list->stale = false;
    ++list->builds;
    return PLS_OK;
}

pls_status pls_pair_list_hold(pls_pair_list *list, const pls_bodies *bodies, bool (*holds)(const void *context, uint32_t a, uint32_t b),
                              const void *context)
{
    PLS_TRY(renew(&list->held, &list->held_capacity, list->count / 8 + 1, 1, "the pairs that bonds hold"));
    const size_t bytes = list->wall_first / 8;
    memset(list->held, 0, list->count / 8 + 1);
    bool some = false;
#pragma omp parallel for schedule(static) reduction(|| : some)
    for (size_t k = 0; k < bytes; ++k)
        for (size_t lane = 0; lane < 8; ++lane)
        {
            const uint32_t a = bodies->kind[list->row_i[8 * k + lane]].number, b = bodies->kind[list->row_j[8 * k + lane]].number;
            if (!holds(context, a, b)) continue;
            list->held[k] = (uint8_t)(list->held[k] | 1u << lane);
            some = true;
        }
    list->holds_some = some;
    return PLS_OK;
}

void pls_pair_list_let_go(pls_pair_list *list, uint32_t row_a, uint32_t row_b)
{
    if (!list->holds_some || row_a == PLS_NO_ROW || row_b == PLS_NO_ROW) return;
    for (uint32_t k = list->pairs.start[row_a]; k < list->pairs.start[row_a + 1]; ++k)
    {
        const uint32_t c = list->pairs.entry[k] >> 1;
        if (list->row_i[c] == row_b || list->row_j[c] == row_b) list->held[c >> 3] = (uint8_t)(list->held[c >> 3] & ~(1u << (c & 7)));
    }
}

size_t pls_pair_list_bytes(const pls_pair_list *list)
{
    return (list->row_i_capacity + list->row_j_capacity) * sizeof *list->row_i + list->shift_capacity * sizeof *list->shift +
           list->touch_capacity + list->ended_capacity + list->held_capacity + list->moved_capacity * sizeof *list->moved +
           (list->history_capacity + list->slot_capacity + list->skew_capacity + list->shared_capacity) * sizeof(double) +
           (list->pairs.entry_capacity + list->walls.entry_capacity + list->near_capacity + 3 * list->group_capacity +
            list->fetch_start_capacity + list->fetch_row_capacity + list->place_capacity) *
               sizeof *list->pairs.entry;
}

void pls_pair_list_free(pls_pair_list *list)
{
    pls_release(&list->section);
    pls_release(&list->block);
    pls_release(&list->group_first);
    pls_release(&list->group_last);
    pls_release(&list->group_waiting);
    pls_release(&list->fetch_start);
    pls_release(&list->fetch_row);
    pls_release(&list->place);
    pls_release(&list->shared);
    pls_release(&list->row_i);
    pls_release(&list->row_j);
    pls_release(&list->shift);
    pls_release(&list->touch);
    pls_release(&list->ended);
    pls_release(&list->held);
    pls_release(&list->history);
    pls_release(&list->slot);
    pls_release(&list->pairs.start);
    pls_release(&list->pairs.entry);
    pls_release(&list->walls.start);
    pls_release(&list->walls.entry);
    pls_release(&list->skew);
    pls_release(&list->near);
    pls_release(&list->reference);
    pls_release(&list->reference_radius);
    pls_release(&list->moved);
    memset(list, 0, sizeof *list);
}
