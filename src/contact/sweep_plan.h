// sweep_plan.h -- what a sweep over the pair list in order can count on: when each body's contacts are done with, what to fetch, and which slots are free again.
//
// A thread takes a few blocks at a time and then finishes, in order, the groups of rows that have no contacts in later blocks. Where one thread has the whole list, its
// course is known when the list is made: of a million pairs some thousands wait for their second body at any time, so the slots of a sweep fit the second-level cache
// if they are used again as soon as both bodies have taken their sums.
#ifndef PLS_CONTACT_SWEEP_PLAN_H
#define PLS_CONTACT_SWEEP_PLAN_H

#include "contact/pair_list.h"

enum {
    PLS_READY_GROUPS = 32,                  ///< groups of rows that are finished at a time, if so many are ready
    PLS_TAKEN_BLOCKS = 8,                   ///< blocks of pairs that a thread takes at a time
    PLS_FETCH_REACH = PLS_CONTACT_BLOCK / 8 ///< readable entries behind the last row to be fetched
};

/// The first group from `ready` on, before `last`, that has contacts in block `done` or later ones.
static inline size_t pls_ready_groups(const pls_pair_list *list, size_t ready, size_t last, size_t done)
{
    while (ready < last && list->group_last[ready] < done) ++ready;
    return ready;
}

/// For a list whose blocks are cut. `alone`: one thread will have all of it.
pls_status pls_sweep_plan_make(pls_pair_list *list, size_t rows, bool alone);

#endif
