// solid_list.h -- candidates in which at least one body is neither a ball nor a half-space: pairs of parts, what each remembers, and where its force goes.
//
// A simple shape is its own only part; a compound has its sub-shapes, a mesh wall its triangles. A candidate is part p of body i against part q of body j and has one
// contact: one overlap, one normal, one point, one tangential spring (narrow_phase.h). i is the body with the lower number; half-spaces and mesh walls are always j.
//
// What a candidate remembers is a record of its own, which a checkpoint holds as it is. Besides the spring it has what warm starts need, so that a restart gives the
// same bits: a record lives from the step in which the bounding volumes of the two parts begin to overlap (at pieces of walls: come near, wall_groups.c) to the one in which they no longer do. Geometry decides that, never the
// list, so lists of any skin and order in memory give the same records.
#ifndef PLS_CONTACT_SOLID_LIST_H
#define PLS_CONTACT_SOLID_LIST_H

#include "contact/broad_phase.h"
#include "contact/narrow_phase.h"
#include "law/law_table.h"

enum {
    PLS_SOLID_SLOT = 16,  ///< doubles: F on i (3), power of its dashpots, torque on i (3), work of its slider; the same for j
    PLS_SOLID_BLOCK = 32, ///< candidates per block of work, or as many as one pair of bodies has
};

/// Whether a candidate touches.
enum {
    PLS_SOLID_APART = 0,
    PLS_SOLID_TOUCHES = 1,
    PLS_SOLID_SHADED = 2 ///< it touches, but a deeper contact of the same two bodies pushes there already
};

/// What a candidate remembers, and its key.
typedef struct pls_solid_memory
{
    uint32_t number_i, number_j; ///< persistent numbers
    uint32_t part_i, part_j;
    uint32_t image; ///< which of a wall's images j is, `pls_image_key` of its shift; 0 for other pairs, of which one image at most is near
    uint32_t touches;                    ///< at the last step
    double spring[3];                    ///< tangential spring; along the normal: what turning on an area of touch has loaded [m]
    double history[PLS_LAW_MAX_HISTORY]; ///< the law's own numbers
    double normal[3];                    ///< at the last step, from i to j
    double arm[3];                       ///< from the centre of i to where friction acted at the last step [m]
    double lever;                        ///< at which turning about the normal slips, at the last step; 0: touched at a point [m]
    double
        front; ///< of a facet that touches, maybe in the shade of others: 1 or -1, the side of its normal on which i was when it came, or of what is on no side PLS_WALL_TOUCHED or PLS_WALL_PASSED; else 0
    pls_pair_state state;
} pls_solid_memory;

typedef struct pls_solid_pair
{
    uint32_t row_i, row_j;
    int16_t shift[3]; ///< j's image lies at X_j + shift * edge
    uint16_t law;
    uint8_t ended;   ///< touched at the step before the last and no more at the last
    uint8_t tracked; ///< bounding volumes overlap: the record is alive
    uint8_t lets_go; ///< j is a half-space that holds no body whose centre is behind its surface
    uint8_t on_wall; ///< j's part is a facet, and i's touches it by more than a point
} pls_solid_pair;

/// Images of a wall that are near the same body are close to each other: this many along each axis tell them apart.
enum { PLS_IMAGE_BITS = 10, PLS_IMAGES = 1 << PLS_IMAGE_BITS };

static inline uint32_t pls_image_key(const int16_t shift[3])
{
    uint32_t key = 0;
    for (int a = 0; a < 3; ++a) key = key << PLS_IMAGE_BITS | ((uint32_t)shift[a] & (PLS_IMAGES - 1));
    return key;
}

/// A block of work: candidates first .. last, all of each pair of bodies.
typedef struct pls_solid_block
{
    uint32_t first, last;
} pls_solid_block;

/// Zero-initialise; `pls_solid_list_free` releases.
typedef struct pls_solid_list
{
    pls_solid_pair *pair; ///< in order of (lower row, upper row, part of i, part of j, image)
    pls_solid_memory *memory;
    pls_touch *touch; ///< of the last step
    uint8_t *next;    ///< PLS_SOLID_ states that are being found
    double *slot;
    pls_overlap_record *record; ///< of the overlap at some step, or nothing
    size_t count, capacity;
    pls_solid_block *block;
    size_t block_count, block_capacity;
    uint32_t *start, *entry; ///< per body: candidate * 2 + side, in order of the partner's number, then of parts
    size_t start_capacity, entry_capacity;
    pls_posed *posed; ///< of every row that has candidates
    size_t posed_capacity;
    uint32_t *row; ///< rows that have candidates, ascending
    size_t row_count, row_capacity;
    pls_narrow_counts counts; ///< of all steps
    double wall_length[3];    ///< of walls of pieces that cannot turn the longest along each axis, in a periodic box [m]
    uint32_t longest_wall[3]; ///< the number of that body
} pls_solid_list;

/// Records taken out of a list, or read from a checkpoint. Zero-initialise; `pls_solid_records_free` releases.
typedef struct pls_solid_records
{
    pls_solid_memory *entry;
    size_t count, capacity;
} pls_solid_records;

/// What making a list reads.
typedef struct pls_solid_source
{
    const pls_bodies *bodies;
    const pls_domain *domain;
    const pls_law_table *laws;
    const pls_shape *const *shape; ///< by index
    const pls_near_pairs *near;    ///< pairs of bounded bodies, of which those with a solid body count
    double gap;                    ///< skin [m]
} pls_solid_source;

/// Is the pair one for this list?
static inline bool pls_pair_is_solid(const pls_bodies *bodies, uint32_t a, uint32_t b)
{
    return ((bodies->kind[a].flags | bodies->kind[b].flags) & PLS_BODY_SOLID) != 0;
}

/// Make the list anew: all pairs of parts nearer than the gap and all that touch in `records`, with what `records` holds of them.
/// NOT_FOUND names two materials without a law.
pls_status pls_solid_list_build(pls_solid_list *list, const pls_solid_source *source, const pls_solid_records *records);
/// INVALID_ARGUMENT: a wall of pieces is longer than a periodic edge, so that it and its images lie on each other. One that may turn is not asked.
pls_status pls_solid_walls_fit(const pls_solid_list *list, const pls_domain *domain);
/// No candidates, and nothing of what they knew: bodies of other shapes may have their numbers now.
void pls_solid_list_forget(pls_solid_list *list);
void pls_solid_list_free(pls_solid_list *list);
size_t pls_solid_list_bytes(const pls_solid_list *list);
/// Touching candidates now, shaded ones left out.
size_t pls_solid_list_touching(const pls_solid_list *list);
/// The records that are alive, in list order.
pls_status pls_solid_list_remember(const pls_solid_list *list, pls_solid_records *records);
pls_status pls_solid_records_reserve(pls_solid_records *records, size_t count);
void pls_solid_records_free(pls_solid_records *records);
/// In order of numbers and parts.
void pls_solid_records_sort(pls_solid_records *records);

/// The part of a posed body.
pls_posed pls_posed_part(const pls_posed *whole, uint32_t part);
static inline uint32_t pls_part_count(const pls_shape *shape) { return shape->part_count ? (uint32_t)shape->part_count : 1; }

#endif
