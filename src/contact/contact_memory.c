// contact_memory.c -- what touching contacts remember, taken out of one list and put into the next.

#include "contact/contact_memory.h"

#include "base/alloc.h"
#include "base/sort.h"
#include "contact/sphere_contact.h"

#include <string.h>

pls_status pls_contact_memory_reserve(pls_contact_memory *memory, size_t count)
{
    return pls_reserve(&memory->entry, &memory->capacity, count, sizeof *memory->entry, "what contacts remember");
}

void pls_contact_memory_free(pls_contact_memory *memory)
{
    pls_release(&memory->entry);
    memset(memory, 0, sizeof *memory);
}

/// Put each entry where `from` says, along the circles that moving makes; `from` is used up.
static void permute(struct pls_remembered *entry, uint32_t *from, size_t count)
{
    for (size_t k = 0; k < count; ++k)
    {
        if (from[k] == k) continue;
        const struct pls_remembered first = entry[k];
        size_t to = k;
        for (size_t next = from[to]; next != k; to = next, next = from[to])
        {
            entry[to] = entry[next];
            from[to] = (uint32_t)to;
        }
        entry[to] = first;
        from[to] = (uint32_t)to;
    }
}

pls_status pls_contact_memory_sort(pls_contact_memory *memory)
{
    uint64_t *key = NULL;
    uint32_t *from = NULL;
    pls_status status = pls_allocate(&key, memory->count, sizeof *key, "ordering what contacts remember");
    if (status == PLS_OK) status = pls_allocate(&from, memory->count, sizeof *from, "ordering what contacts remember");
    for (size_t k = 0; status == PLS_OK && k < memory->count; ++k)
    {
        key[k] = (uint64_t)memory->entry[k].number_i << 32 | memory->entry[k].number_j;
        from[k] = (uint32_t)k;
    }
    if (status == PLS_OK) status = pls_radix_sort_u64(key, from, memory->count);
    if (status == PLS_OK) permute(memory->entry, from, memory->count);
    pls_release(&key);
    pls_release(&from);
    return status;
}

pls_status pls_pair_list_remember(const pls_pair_list *list, const pls_bodies *bodies, pls_contact_memory *memory)
{
    memory->count = 0;
    PLS_TRY(pls_contact_memory_reserve(memory, pls_pair_list_touching(list)));
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        for (size_t c = section->first; c < section->first + section->count; ++c)
        {
            if (!pls_pair_touches(list, c)) continue;
            double numbers[3 + PLS_LAW_MAX_HISTORY] = {0};
            pls_pair_history_read(list, section, c, numbers);
            struct pls_remembered *entry = &memory->entry[memory->count++];
            memset(entry, 0, sizeof *entry);
            entry->number_i = bodies->kind[list->row_i[c]].number;
            entry->number_j = bodies->kind[list->row_j[c]].number;
            memcpy(entry->spring, numbers, sizeof entry->spring);
            memcpy(entry->history, numbers + 3, sizeof entry->history);
        }
    }
    return PLS_OK;
}

// ---- pairs that touched ---------------------------------------------------------------------------------------------------------------------------------
//
// A contact may open wider than the skin in the step in which the list is made. It stays a candidate for that step, which finds that it ended and books what its
// spring held; so its end does not depend on the skin.

/// Whether the broad phase may have left out a pair of spheres; true too often does no harm, and rounding must not make it false.
static bool may_be_far(const pls_bodies *bodies, const pls_domain *domain, double skin, uint32_t i, uint32_t j)
{
    const pls_body_place *p = &bodies->place[i], *q = &bodies->place[j];
    const double d[3] = {q->x - p->x, q->y - p->y, q->z - p->z};
    double square = 0.0, rounding = fabs(p->x) + fabs(p->y) + fabs(p->z) + fabs(q->x) + fabs(q->y) + fabs(q->z);
    for (int a = 0; a < 3; ++a)
    {
        double nearest = d[a] + pls_nearest_image(d[a], domain->edge[a]) * domain->edge[a];
        square += nearest * nearest;
    }
    return !(sqrt(square) + 1e-14 * rounding < p->radius + q->radius + 0.5 * skin);
}

static pls_status keep_pair(uint64_t **keys, size_t *count, size_t *capacity, uint32_t a, uint32_t b)
{
    if (*count == *capacity) PLS_TRY(pls_reserve(keys, capacity, *count + 64, sizeof **keys, "pairs that touched"));
    (*keys)[(*count)++] = (uint64_t)a << 32 | b;
    return PLS_OK;
}

static pls_status sort_keys(uint64_t *keys, size_t count)
{
    if (count < 2) return PLS_OK;
    uint32_t *unused = NULL;
    PLS_TRY(pls_allocate(&unused, count, sizeof *unused, "pairs that touched"));
    pls_status status = pls_radix_sort_u64(keys, unused, count);
    pls_release(&unused);
    return status;
}

pls_status pls_find_kept(pls_kept_pairs *kept, const pls_bodies *bodies, const pls_domain *domain, double skin,
                         const pls_contact_memory *memory)
{
    for (size_t k = 0; k < memory->count; ++k)
    {
        uint32_t i = bodies->row_of[memory->entry[k].number_i], j = bodies->row_of[memory->entry[k].number_j];
        if (i == PLS_NO_ROW || j == PLS_NO_ROW) continue;
        if (bodies->kind[j].flags & PLS_BODY_UNBOUNDED)
        {
            const pls_body_place *p = &bodies->place[i], *w = &bodies->place[j];
            pls_vec3 n = pls_wall_normal(&bodies->orientation[j], domain->dimension);
            if (n.x * (p->x - w->x) + n.y * (p->y - w->y) + n.z * (p->z - w->z) < p->radius) continue;
            PLS_TRY(keep_pair(&kept->wall, &kept->wall_count, &kept->wall_capacity, j, i));
        }
        else if (pls_pair_matters(bodies, i, j) && may_be_far(bodies, domain, skin, i, j))
            PLS_TRY(keep_pair(&kept->sphere, &kept->sphere_count, &kept->sphere_capacity, i < j ? i : j, i < j ? j : i));
    }
    PLS_TRY(sort_keys(kept->sphere, kept->sphere_count));
    return sort_keys(kept->wall, kept->wall_count);
}

bool pls_is_kept_at_wall(const pls_kept_pairs *kept, uint32_t wall, size_t row)
{
    uint64_t key = (uint64_t)wall << 32 | row;
    size_t first = 0, last = kept->wall_count;
    while (first < last)
    {
        size_t middle = (first + last) / 2;
        if (kept->wall[middle] < key)
            first = middle + 1;
        else
            last = middle;
    }
    return first < kept->wall_count && kept->wall[first] == key;
}

static pls_near_pair near_pair_of(const pls_bodies *bodies, const pls_domain *domain, uint64_t key)
{
    uint32_t a = (uint32_t)(key >> 32), b = (uint32_t)key;
    bool swap = bodies->kind[b].number < bodies->kind[a].number;
    pls_near_pair pair = {.owner = swap ? b : a, .partner = swap ? a : b};
    const pls_body_place *p = &bodies->place[pair.owner], *q = &bodies->place[pair.partner];
    const double d[3] = {q->x - p->x, q->y - p->y, q->z - p->z};
    for (int k = 0; k < 3; ++k) pair.shift[k] = pls_nearest_image(d[k], domain->edge[k]);
    return pair;
}

static uint64_t key_of(const pls_near_pair *p)
{
    return p->owner < p->partner ? (uint64_t)p->owner << 32 | p->partner : (uint64_t)p->partner << 32 | p->owner;
}

pls_status pls_add_kept(pls_near_pairs *near, const pls_kept_pairs *kept, const pls_bodies *bodies, const pls_domain *domain)
{
    size_t missing = 0;
    for (size_t k = 0, at = 0; k < kept->sphere_count; ++k)
    {
        size_t first = at, last = near->count;
        while (first < last)
        {
            size_t middle = first + (last - first) / 2;
            if (key_of(&near->pair[middle]) < kept->sphere[k])
                first = middle + 1;
            else
                last = middle;
        }
        at = first;
        if (at < near->count && key_of(&near->pair[at]) == kept->sphere[k]) continue;
        kept->sphere[missing++] = kept->sphere[k];
    }
    if (missing == 0) return PLS_OK;
    PLS_TRY(pls_reserve(&near->pair, &near->capacity, near->count + missing, sizeof *near->pair, "near pairs"));
    size_t old = near->count;
    near->count += missing;
    for (size_t to = near->count; missing > 0;) // from behind
    {
        if (old > 0 && key_of(&near->pair[old - 1]) > kept->sphere[missing - 1])
            near->pair[--to] = near->pair[--old];
        else
            near->pair[--to] = near_pair_of(bodies, domain, kept->sphere[--missing]);
    }
    return PLS_OK;
}

void pls_kept_pairs_free(pls_kept_pairs *kept)
{
    pls_release(&kept->sphere);
    pls_release(&kept->wall);
    memset(kept, 0, sizeof *kept);
}

// ---- memory of contacts -----------------------------------------------------------------------------------------------------------------------------

/// Where what was remembered of each pair lies, in order of the first body's number, then of the other's.
typedef struct memory_index
{
    uint32_t *start;   ///< of each first number
    uint32_t *partner; ///< the other number
    uint32_t *entry;   ///< place in the memory
} memory_index;

static void free_index(memory_index *index)
{
    pls_release(&index->start);
    pls_release(&index->partner);
    pls_release(&index->entry);
}

/// Sort values by keys: most rows are short, but a body far larger than its neighbours has many.
static pls_status order_row(uint32_t *keys, uint32_t *values, size_t n)
{
    if (n > PLS_LONG_ROW) return pls_radix_sort_u32(keys, values, n);
    for (size_t k = 1; k < n; ++k)
    {
        uint32_t key = keys[k], value = values[k];
        size_t m = k;
        for (; m > 0 && keys[m - 1] > key; --m) keys[m] = keys[m - 1], values[m] = values[m - 1];
        keys[m] = key;
        values[m] = value;
    }
    return PLS_OK;
}

static pls_status make_index(memory_index *index, const pls_contact_memory *memory, size_t numbers)
{
    PLS_TRY(pls_allocate(&index->start, numbers + 2, sizeof *index->start, "recalling contacts"));
    PLS_TRY(pls_allocate(&index->partner, memory->count, sizeof *index->partner, "recalling contacts"));
    PLS_TRY(pls_allocate(&index->entry, memory->count, sizeof *index->entry, "recalling contacts"));
    uint32_t *start = index->start;
    for (size_t k = 0; k < memory->count; ++k) ++start[memory->entry[k].number_i + 2];
    for (size_t n = 2; n < numbers + 2; ++n) start[n] += start[n - 1];
    for (size_t k = 0; k < memory->count; ++k)
    {
        size_t place = start[memory->entry[k].number_i + 1]++;
        index->partner[place] = memory->entry[k].number_j;
        index->entry[place] = (uint32_t)k;
    }
    pls_status worst = PLS_OK;
#pragma omp parallel for schedule(static)
    for (size_t n = 0; n < numbers; ++n)
    {
        pls_status status = order_row(index->partner + start[n], index->entry + start[n], start[n + 1] - start[n]);
        if (status != PLS_OK)
        {
#pragma omp critical(pls_recall_failure)
            worst = status;
        }
    }
    return worst == PLS_OK ? PLS_OK : pls_fail(worst, "no memory to recall contacts");
}

/// What was remembered of a pair, or null.
static const struct pls_remembered *recall(const pls_contact_memory *memory, const memory_index *index, uint32_t i, uint32_t j)
{
    uint32_t first = index->start[i], end = index->start[i + 1], last = end;
    while (first < last)
    {
        uint32_t middle = first + (last - first) / 2;
        if (index->partner[middle] < j)
            first = middle + 1;
        else
            last = middle;
    }
    return first < end && index->partner[first] == j ? &memory->entry[index->entry[first]] : NULL;
}

pls_status pls_contact_memory_put_back(pls_pair_list *list, const pls_bodies *bodies, const pls_contact_memory *memory)
{
    if (memory->count == 0) return PLS_OK;
    memory_index index = {0};
    pls_status status = make_index(&index, memory, bodies->numbers);
    if (status != PLS_OK)
    {
        free_index(&index);
        return status;
    }
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
#pragma omp parallel for schedule(static)
        for (size_t byte = section->first / 8; byte < (section->first + section->count + 7) / 8; ++byte)
            for (size_t c = byte * 8; c < byte * 8 + 8 && c < section->first + section->count; ++c)
            {
                const struct pls_remembered *entry =
                    recall(memory, &index, bodies->kind[list->row_i[c]].number, bodies->kind[list->row_j[c]].number);
                if (!entry) continue;
                double *history = pls_pair_history(list, section, c);
                for (int h = 0; h < section->numbers; ++h) history[8 * h] = h < 3 ? entry->spring[h] : entry->history[h - 3];
                list->touch[byte] = (uint8_t)(list->touch[byte] | 1u << (c & 7));
            }
    }
    free_index(&index);
    return PLS_OK;
}
