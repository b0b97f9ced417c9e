/// @file field.h
/// Fields: every persistent number of the world, described once. Checkpoints, frames, `particls info`, the docs and re-ordering all read this table.
#ifndef PARTICLS_FIELD_H
#define PARTICLS_FIELD_H

#include <particls/status.h>
#include <particls/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct pls_world;

typedef enum pls_type { PLS_F64, PLS_F32, PLS_U32, PLS_U16, PLS_U8 } pls_type;

/// Bytes of one component.
size_t pls_type_size(pls_type type);

typedef enum pls_field_flags {
    PLS_FIELD_PERSISTS = 1, ///< lives from step to step: checkpointed and hashed
    PLS_FIELD_FRAME = 2,    ///< written to frames by default
    PLS_FIELD_ID = 4,       ///< the persistent number that orders rows
    PLS_FIELD_BONDED = 8,   ///< written to frames by default where there are bonds
    PLS_FIELD_DERIVED = 16  ///< nobody keeps it: found when it is asked for
} pls_field_flags;

/// One field of one table. A value lies at row * stride + offset of its column.
typedef struct pls_field
{
    const char *name;
    pls_type type;
    int components;
    unsigned flags;
    const char *unit;
    const char *meaning;
    int column;    ///< which column of the table
    size_t offset; ///< bytes within a row of the column
} pls_field;

typedef enum pls_table_kind {
    PLS_TABLE_BODIES,
    PLS_TABLE_CONTACTS, ///< touching contacts, in order of (lower id, higher id); made on request
    PLS_TABLE_STATES,
    PLS_TABLE_PAIRS,   ///< what pairs of parts of solid bodies remember, in order of (lower id, higher id, parts)
    PLS_TABLE_NUMBERS, ///< numbers ever given to bodies, the free ones too
    PLS_TABLE_BONDS, ///< bonds of either direction: of each set the points in order of its reference configuration, their bonds in the same order
    PLS_TABLE_POINTS, ///< points of bonds in that order
    PLS_TABLE_MEMORY, ///< what laws of bonds remember: of each set the bonds in that order, one memory after the other, then the points
    PLS_TABLE_COUNT
} pls_table_kind;

/// All fields of a table, `*count` of them.
const pls_field *pls_fields(pls_table_kind table, size_t *count);
const char *pls_table_name(pls_table_kind table);
/// Null when there is none.
const pls_field *pls_field_find(pls_table_kind table, const char *name);

/// Where a field lies: value c of row k at (const char *)data + k * stride, c-th of `components`.
typedef struct pls_field_view
{
    const void *data;
    size_t stride; ///< bytes from row to row
    size_t count;  ///< rows
    pls_type type;
    int components;
} pls_field_view;

/// Component `component` of row `row`, of whatever type.
double pls_field_value(const pls_field_view *view, size_t row, int component);

/// View of a body field, rows in memory order (see `pls_world_body_rows` for the order of ids). Valid until the next step or change of the world.
pls_status pls_world_body_field(const struct pls_world *world, const char *name, pls_field_view *view);

#ifdef __cplusplus
}
#endif
#endif
