// pair_list.h -- the Verlet list: pairs that touch or may soon touch, with what each contact remembers and where its force goes.
//
// Candidates are numbered 0 .. count, in sections of one kind of pair and one law; sphere pairs first, wall pairs behind. Within a section they are in order
// of the lower of the two memory rows, so that the loop streams and a body's candidates are done with when the loop has passed its row. A section begins at a
// multiple of 8, and so do the blocks of work cut from it; the candidates that fill it up repeat its last pair, so that a block reads no other bodies (another
// thread may be writing theirs), and are never active.
//
// Which pairs are listed, and where, depends on the skin and on the order of bodies in memory; what comes of it does not: a candidate that does not touch
// leaves no trace, and each body gathers its touching contacts in order of the partner's number.
#ifndef PLS_CONTACT_PAIR_LIST_H
#define PLS_CONTACT_PAIR_LIST_H

#include "contact/broad_phase.h"
#include "law/law_table.h"
#include "model/bodies.h"
#include "model/domain.h"

enum {
    PLS_CONTACT_BLOCK = PLS_LAW_BATCH,       ///< candidates per block of work: its arrays stay in the first-level cache
    PLS_PAIR_REACH = PLS_CONTACT_BLOCK + 64, ///< readable candidates behind the last one, pairs (0, 0), for loops that fetch ahead
    PLS_LARGE_WORLD = 4000,                  ///< bodies from which rows overflow the near caches, so that fetching ahead pays
    PLS_VAST_WORLD = 30000,                  ///< bodies from which they overflow the last cache too
    PLS_ROW_GROUP = 8,                       ///< rows that are finished together
    PLS_SLOT = 8,        ///< doubles in the slot of a sphere pair: F on i (3), power of its dashpots, torque (3), work of its slider
    PLS_WALL_SLOT = 16,  ///< doubles in the slot of a wall pair: the same for i, then for the wall
    PLS_NEAR_HEAD = 2,   ///< numbers before the near entries of a row: how many of partners with lower numbers, of higher ones
    PLS_NEAR_STRIDE = 3, ///< near entries come in multiples of this, so that the loop over them has few turns, mostly equally many
    PLS_NEAR_SPARE = PLS_NEAR_HEAD + 2 * (PLS_NEAR_STRIDE - 1) ///< room a near row needs besides its entries
};
/// In the head of a near row: contacts of the row began or ended since it was listed.
#define PLS_NEAR_STALE UINT32_MAX

typedef struct pls_pair_section
{
    bool wall; ///< body i against the half-space `wall_row`
    uint32_t wall_row;
    uint16_t law;   ///< index in the law table
    double depth;   ///< of the half-space: it lets go of bodies whose centre is further behind its surface [m]
    int numbers;    ///< of history per candidate: the spring's three and what the law keeps
    size_t first;   ///< first candidate, a multiple of 8
    size_t count;   ///< candidates
    size_t history; ///< first double of history
} pls_pair_section;

/// A block of work: candidates first .. first + count of one section.
typedef struct pls_pair_block
{
    uint32_t section;
    uint32_t count;
    size_t first;
} pls_pair_block;

/// Entries of a body's gather row: candidate * 2 + side, side 1 where the body is j.
typedef struct pls_gather_rows
{
    uint32_t *start, *entry;
    size_t start_capacity, entry_capacity;
} pls_gather_rows;

/// Around displacements of bodies [m].
typedef struct pls_moved_box
{
    double low[3], high[3];
} pls_moved_box;

/// Zero-initialise; `pls_pair_list_free` releases.
typedef struct pls_pair_list
{
    pls_pair_section *section;
    size_t section_count, section_capacity;
    pls_pair_block *block; ///< those of walls, then those of pairs in order of their first rows
    size_t block_count, block_capacity, wall_blocks;
    uint32_t *group_first, *group_last; ///< first and last block with pairs of the PLS_ROW_GROUP rows of a group; none: UINT32_MAX and 0
    uint32_t *group_waiting; ///< of the step: groups that must wait for contacts of another thread; each thread's from its first group on
    size_t group_capacity;
    uint32_t *fetch_start,
        *fetch_row; ///< per block of pairs what is to be fetched for it: rows that blocks shortly before it have not used
    size_t fetch_start_capacity, fetch_row_capacity;

    size_t count;      ///< candidates, fill included
    size_t wall_first; ///< first wall candidate
    size_t listed;     ///< true candidates
    uint32_t *row_i, *row_j;
    size_t row_i_capacity, row_j_capacity;
    int16_t (*shift)[4]; ///< periodic images: j's image lies at X_j + shift * edge; only in periodic worlds
    size_t shift_capacity;
    uint8_t *touch; ///< bit k % 8 of byte k / 8: candidate k touched at the last step
    uint8_t *ended; ///< likewise: touched at the step before the last and no more at the last; their history still holds the spring
    uint8_t *held;  ///< likewise: a bond holds the two bodies, so they do not touch; not used where no pair is held
    bool holds_some;
    size_t touch_capacity, ended_capacity, held_capacity;
    double *history; ///< of eight candidates at a time: eight values of the first number, eight of the second ...
    size_t history_capacity;
    double *
        slot; ///< PLS_SLOT per sphere pair, filled where contacts may be looked at after the step; room for one more; PLS_WALL_SLOT per wall pair
    size_t slot_capacity;
    // of the sweep (sweep_plan.h)
    bool alone; ///< one thread has the whole list, so slots are used again
    bool gone;  ///< the last sweep has left no forces in `slot`
    double *
        live; ///< slots of pairs of spheres from which bodies gather, PLS_SLOT each, and one that is always zero: `shared`, or those of `slot`
    size_t live_count;
    double *shared;
    size_t shared_capacity;
    uint32_t *place; ///< per eight candidates, which eight of `live`
    size_t place_capacity;
    double *skew; ///< (r_i - r_j) / distance of each of `live`, 0 for the zero slot; not used where all radii are equal
    size_t skew_capacity;
    bool equal_radii;
    pls_gather_rows pairs, walls;
    uint32_t *near; ///< per body: a head, then candidates that touch, first those in which it is j, then as i, filled up with the zero slot
    size_t near_capacity;

    // when it is stale
    double (*reference)[3]; ///< positions when it was made [m]
    double *reference_radius;
    size_t reference_capacity;
    pls_moved_box
        *moved; ///< scratch of looks at how far bodies have moved (approach.c): grown only where the space that bodies take up grows
    size_t moved_capacity;
    double skin;           ///< it was made with [m]
    double drift;          ///< bound on how much two bodies that are not listed can have come nearer since [m]
    double image_drift;    ///< the part of it that a stretching box and turning walls make [m]
    double image_reach[3]; ///< how many edges lie between bodies of a listed pair, at most
    bool stale;
    uint64_t builds;
} pls_pair_list;

/// The lower of a candidate's two memory rows, which orders the list.
static inline uint32_t pls_pair_lower_row(const pls_pair_list *list, size_t candidate)
{
    uint32_t i = list->row_i[candidate], j = list->row_j[candidate];
    return i < j ? i : j;
}
/// Number of the slot in `live` that is always zero.
static inline size_t pls_zero_slot(const pls_pair_list *list) { return list->live_count; }
/// Number of a candidate's slot in `live`.
static inline size_t pls_live_slot(const pls_pair_list *list, size_t candidate)
{
    return (size_t)list->place[candidate >> 3] * 8 + (candidate & 7);
}
static inline double *pls_wall_slot(const pls_pair_list *list, size_t candidate)
{
    return list->slot + (list->wall_first + 1) * PLS_SLOT + (candidate - list->wall_first) * PLS_WALL_SLOT;
}
/// Head of a body's near row.
static inline uint32_t *pls_near_row(const pls_pair_list *list, size_t row)
{
    return list->near + list->pairs.start[row] + row * PLS_NEAR_SPARE;
}
/// First number of a candidate's history; the next one lies 8 further, and so on.
static inline double *pls_pair_history(const pls_pair_list *list, const pls_pair_section *section, size_t candidate)
{
    size_t place = candidate - section->first;
    return list->history + section->history + place / 8 * 8 * (size_t)section->numbers + place % 8;
}
static inline void pls_pair_history_read(const pls_pair_list *list, const pls_pair_section *section, size_t candidate,
                                         double numbers[3 + PLS_LAW_MAX_HISTORY])
{
    const double *history = pls_pair_history(list, section, candidate);
    for (int h = 0; h < section->numbers; ++h) numbers[h] = history[8 * h];
}
/// Lanes of candidates c .. c + 7 that no bond holds.
static inline unsigned pls_pair_free_lanes(const pls_pair_list *list, size_t c)
{
    return list->holds_some ? ~(unsigned)list->held[c >> 3] & 0xffu : 0xffu;
}
static inline bool pls_pair_touches(const pls_pair_list *list, size_t candidate)
{
    return (list->touch[candidate >> 3] >> (candidate & 7)) & 1;
}

/// What touching contacts remember, keyed by body numbers: carried across rebuilds, and what a checkpoint holds.
/// Zero-initialise; `pls_contact_memory_free` releases.
typedef struct pls_contact_memory
{
    struct pls_remembered
    {
        uint32_t number_i, number_j;
        double spring[3];
        double history[PLS_LAW_MAX_HISTORY];
    } * entry;
    size_t count, capacity;
} pls_contact_memory;

pls_status pls_contact_memory_reserve(pls_contact_memory *memory, size_t count);
void pls_contact_memory_free(pls_contact_memory *memory);
/// Into the order of the first body's number, then of the other's.
pls_status pls_contact_memory_sort(pls_contact_memory *memory);
/// Everything the touching contacts of the list remember, in list order.
pls_status pls_pair_list_remember(const pls_pair_list *list, const pls_bodies *bodies, pls_contact_memory *memory);

/// Make the list: all pairs of balls in `near`, which are those nearer than `skin`, and all in `memory`, with the memory of contacts from `memory`.
/// `growing`: radii may change while it is in use.
/// NOT_FOUND names two materials without a law.
pls_status pls_pair_list_build(pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, const pls_law_table *laws,
                               pls_near_pairs *near, double skin, bool growing, const pls_contact_memory *memory);
/// Note which pairs of balls bonds hold: `holds` is asked about two numbers.
pls_status pls_pair_list_hold(pls_pair_list *list, const pls_bodies *bodies, bool (*holds)(const void *context, uint32_t a, uint32_t b),
                              const void *context);
/// The bodies in two rows are held no longer.
void pls_pair_list_let_go(pls_pair_list *list, uint32_t row_a, uint32_t row_b);
void pls_pair_list_free(pls_pair_list *list);
size_t pls_pair_list_bytes(const pls_pair_list *list);
/// Touching contacts now.
size_t pls_pair_list_touching(const pls_pair_list *list);

#endif
