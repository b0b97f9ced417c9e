// sweep_plan.c -- the course of a sweep, worked out once per list.

#include "contact/sweep_plan.h"

#include "base/alloc.h"
#include "base/parallel.h"

#include <string.h>

enum { STAYS_BLOCKS = 16 }; ///< blocks for which a row is taken to stay in the near caches
#define NONE UINT32_MAX

// ---- when bodies are done with ----------------------------------------------------------------------------------------------------------------------

/// When the pairs of each group of rows are done with.
static pls_status bound_groups(pls_pair_list *list, size_t rows)
{
    size_t groups = pls_block_count(rows, PLS_ROW_GROUP), capacity = list->group_capacity;
    PLS_TRY(pls_reserve(&list->group_first, &capacity, groups, sizeof *list->group_first, "groups of rows"));
    capacity = list->group_capacity;
    PLS_TRY(pls_reserve(&list->group_last, &capacity, groups, sizeof *list->group_last, "groups of rows"));
    capacity = list->group_capacity;
    PLS_TRY(pls_reserve(&list->group_waiting, &capacity, groups, sizeof *list->group_waiting, "groups of rows"));
    list->group_capacity = capacity;
    for (size_t g = 0; g < groups; ++g) list->group_first[g] = UINT32_MAX, list->group_last[g] = 0;
    for (size_t b = list->wall_blocks; b < list->block_count; ++b)
        for (size_t c = list->block[b].first; c < list->block[b].first + list->block[b].count; ++c)
        {
            const size_t two[2] = {list->row_i[c] / PLS_ROW_GROUP, list->row_j[c] / PLS_ROW_GROUP};
            for (int k = 0; k < 2; ++k)
            {
                if (list->group_first[two[k]] == UINT32_MAX) list->group_first[two[k]] = (uint32_t)b;
                list->group_last[two[k]] = (uint32_t)b;
            }
        }
    return PLS_OK;
}

// ---- what to fetch ------------------------------------------------------------------------------------------------------------------------------------

/// Note that block b uses a row; where blocks shortly before it have not, it is to be fetched.
static pls_status use_row(pls_pair_list *list, uint32_t *used, uint32_t row, size_t b, size_t *count)
{
    const bool away = used[row] == 0 || b + 1 - used[row] > STAYS_BLOCKS;
    used[row] = (uint32_t)b + 1;
    if (!away) return PLS_OK;
    if (*count == list->fetch_row_capacity)
        PLS_TRY(pls_reserve(&list->fetch_row, &list->fetch_row_capacity, *count + 1, sizeof *list->fetch_row, "rows to be fetched"));
    list->fetch_row[(*count)++] = row;
    return PLS_OK;
}

static pls_status list_fetches(pls_pair_list *list, uint32_t *used)
{
    size_t count = 0;
    for (size_t b = 0; b < list->block_count; ++b)
    {
        list->fetch_start[b] = (uint32_t)count;
        const size_t first = list->block[b].first;
        for (size_t c = first; b >= list->wall_blocks && c < first + list->block[b].count; ++c)
        {
            PLS_TRY(use_row(list, used, list->row_i[c], b, &count));
            PLS_TRY(use_row(list, used, list->row_j[c], b, &count));
        }
    }
    list->fetch_start[list->block_count] = list->fetch_start[list->block_count + 1] = (uint32_t)count;
    // Readers may take a few more than there are.
    PLS_TRY(
        pls_reserve(&list->fetch_row, &list->fetch_row_capacity, count + PLS_FETCH_REACH, sizeof *list->fetch_row, "rows to be fetched"));
    memset(list->fetch_row + count, 0, PLS_FETCH_REACH * sizeof *list->fetch_row);
    return PLS_OK;
}

/// What each block of pairs needs that will not be in the near caches: a row comes six times or so in a dense packing, mostly in blocks that follow each other.
static pls_status find_fetches(pls_pair_list *list, size_t rows)
{
    PLS_TRY(pls_reserve(&list->fetch_start, &list->fetch_start_capacity, list->block_count + 2, sizeof *list->fetch_start,
                        "rows to be fetched"));
    uint32_t *used = NULL; // per row: the last block that used it, from 1 on
    PLS_TRY(pls_allocate(&used, rows, sizeof *used, "rows to be fetched"));
    pls_status status = list_fetches(list, used);
    pls_release(&used);
    return status;
}

// ---- slots ------------------------------------------------------------------------------------------------------------------------------------------------

/// Scratch of the search for free slots; a turn is what a thread takes at a time.
typedef struct slot_search
{
    uint32_t *finished; ///< per group: the turn after which it is finished
    uint32_t *next;     ///< per eight candidates: the next that is done with in the same turn
    uint32_t *done;     ///< per turn: the first eight that are done with then
    uint32_t *place;    ///< places that are free, the last one given back on top
    size_t turns, free, used;
} slot_search;

static size_t turn_end(const pls_pair_list *list, size_t turn)
{
    const size_t end = list->wall_blocks + (turn + 1) * PLS_TAKEN_BLOCKS;
    return end < list->block_count ? end : list->block_count;
}

static void find_finished(const pls_pair_list *list, size_t groups, slot_search *s)
{
    size_t reached = 0, ready = 0;
    for (size_t turn = 0; turn < s->turns; ++turn)
    {
        ready = pls_ready_groups(list, ready, groups, turn_end(list, turn));
        if (ready - reached < PLS_READY_GROUPS) continue;
        for (; reached < ready; ++reached) s->finished[reached] = (uint32_t)turn;
    }
    for (; reached < groups; ++reached) s->finished[reached] = (uint32_t)s->turns; // the rest at the end
}

/// A place for the slots of candidates c .. c + 7, until the last of their bodies is finished.
static void take_place(pls_pair_list *list, size_t c, slot_search *s)
{
    uint32_t until = 0;
    for (size_t m = c; m < c + 8; ++m)
    {
        const uint32_t one = s->finished[list->row_i[m] / PLS_ROW_GROUP], other = s->finished[list->row_j[m] / PLS_ROW_GROUP];
        until = one > until ? one : until;
        until = other > until ? other : until;
    }
    list->place[c / 8] = s->free > 0 ? s->place[--s->free] : (uint32_t)s->used++;
    s->next[c / 8] = s->done[until];
    s->done[until] = (uint32_t)(c / 8);
}

static void take_places(pls_pair_list *list, slot_search *s)
{
    for (size_t turn = 0; turn <= s->turns; ++turn) s->done[turn] = NONE;
    for (size_t turn = 0; turn < s->turns; ++turn)
    {
        for (size_t b = list->wall_blocks + turn * PLS_TAKEN_BLOCKS; b < turn_end(list, turn); ++b)
            for (size_t c = list->block[b].first; c < list->block[b].first + list->block[b].count; c += 8) take_place(list, c, s);
        for (uint32_t e = s->done[turn]; e != NONE; e = s->next[e]) s->place[s->free++] = list->place[e];
    }
}

static pls_status share_places(pls_pair_list *list, size_t rows)
{
    const size_t eights = list->wall_first / 8, groups = pls_block_count(rows, PLS_ROW_GROUP);
    slot_search s = {.turns = pls_block_count(list->block_count - list->wall_blocks, PLS_TAKEN_BLOCKS)};
    pls_status status = pls_allocate(&s.finished, groups, sizeof *s.finished, "slots of contacts");
    if (status == PLS_OK) status = pls_allocate(&s.next, eights, sizeof *s.next, "slots of contacts");
    if (status == PLS_OK) status = pls_allocate(&s.done, s.turns + 1, sizeof *s.done, "slots of contacts");
    if (status == PLS_OK) status = pls_allocate(&s.place, eights, sizeof *s.place, "slots of contacts");
    if (status == PLS_OK)
    {
        find_finished(list, groups, &s);
        take_places(list, &s);
    }
    pls_release(&s.finished);
    pls_release(&s.next);
    pls_release(&s.done);
    pls_release(&s.place);
    PLS_TRY(status);
    list->live_count = 8 * s.used;
    return pls_reserve(&list->shared, &list->shared_capacity, (list->live_count + 1) * PLS_SLOT, sizeof *list->shared, "slots of contacts");
}

static pls_status place_slots(pls_pair_list *list, size_t rows, bool alone)
{
    const size_t eights = list->wall_first / 8;
    // Loops that fetch ahead look at places behind the last one.
    PLS_TRY(pls_reserve(&list->place, &list->place_capacity, eights + PLS_PAIR_REACH / 8, sizeof *list->place, "slots of contacts"));
    memset(list->place + eights, 0, PLS_PAIR_REACH / 8 * sizeof *list->place);
    list->live_count = list->wall_first;
    if (alone)
        PLS_TRY(share_places(list, rows));
    else
        for (size_t e = 0; e < eights; ++e) list->place[e] = (uint32_t)e;
    list->alone = alone;
    list->gone = false;
    list->live = alone ? list->shared : list->slot;
    memset(list->live + list->live_count * PLS_SLOT, 0, PLS_SLOT * sizeof *list->live);
    return PLS_OK;
}

pls_status pls_sweep_plan_make(pls_pair_list *list, size_t rows, bool alone)
{
    PLS_TRY(bound_groups(list, rows));
    PLS_TRY(find_fetches(list, rows));
    return place_slots(list, rows, alone);
}
