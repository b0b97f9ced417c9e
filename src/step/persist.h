// persist.h -- the world as tables in the order of ids, out and back in: all that checkpoints and the state hash need to know of it.
//
// Restoring: build the same world from its scene (same shapes, materials, laws, forces, states, in the same order; bodies may be missing), then
//     pls_persist_restore_begin(world, &header); pls_persist_put(...) for every persistent field of every table; pls_persist_restore_end(world);
// after which the next step gives the bits it would have given in the saved run.
#ifndef PLS_STEP_PERSIST_H
#define PLS_STEP_PERSIST_H

#include <particls/field.h>
#include <particls/world.h>

/// What is not a table.
typedef struct pls_persist_header
{
    uint64_t rows[PLS_TABLE_COUNT]; ///< rows of each table
    uint64_t step;                  ///< steps done
    double time;                    ///< [s]
    double dt;                      ///< [s]
    pls_narrow_counts search;       ///< of bodies that are not spheres, so far; not in the state hash
} pls_persist_header;

/// Start reading: makes the contact table. The world must not change until all is read.
pls_status pls_persist_save_begin(pls_world *world, pls_persist_header *header);
/// Copy one field, rows in persistent order, components packed, into `out` (rows * components * type size bytes).
pls_status pls_persist_get(pls_world *world, pls_table_kind table, const pls_field *field, void *out);
void pls_persist_save_end(pls_world *world);

pls_status pls_persist_restore_begin(pls_world *world, const pls_persist_header *header);
pls_status pls_persist_put(pls_world *world, pls_table_kind table, const pls_field *field, const void *in);
/// Checks what was put (ids, finite numbers) and makes the world ready to step. CORRUPT with the reason if it does not fit.
pls_status pls_persist_restore_end(pls_world *world);

#endif
