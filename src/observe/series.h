// series.h -- a source of rows: named columns with units and the values of now. The run writes them to CSV; a source knows nothing of files.
#ifndef PLS_OBSERVE_SERIES_H
#define PLS_OBSERVE_SERIES_H

#include <particls/observe.h>

typedef struct pls_series_column
{
    char name[96]; ///< "sigma_zz", "top.force_z"
    char unit[24]; ///< "Pa", "" for pure numbers
} pls_series_column;

/// Zero-initialise; `pls_series_free` releases.
typedef struct pls_series
{
    pls_series_column *columns; ///< without the time column
    size_t column_count;
    pls_status (*values)(void *context, pls_world *world, double *values); ///< `column_count` values
    pls_status (*update)(void *context, pls_world *world); ///< before the values of a look that is due; null: nothing is remembered
    double *memory; ///< what is remembered from look to look, part of the context: kept in checkpoints
    size_t memory_count;
    void (*destroy)(void *context);
    void *context;
} pls_series;

/// Columns of a tracked group. NOT_FOUND names the group or quantity and what exists.
pls_status pls_series_particle(pls_world *world, const pls_particle_def *def, pls_series *series);
pls_status pls_series_collection(pls_world *world, const pls_collection_def *def, pls_series *series);
/// Columns of an observer of one's own. VERSION, PLUGIN or INVALID_ARGUMENT say what is wrong with its operations or numbers.
pls_status pls_series_own(pls_world *world, const pls_own_def *def, pls_series *series);
/// Whether the operations of such an observer are sound.
pls_status pls_observer_ops_check(const pls_observer_ops *ops);
void pls_series_free(pls_series *series);

#endif
