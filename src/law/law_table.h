// law_table.h -- materials and the one table of laws per pair of materials.
#ifndef PLS_LAW_LAW_TABLE_H
#define PLS_LAW_LAW_TABLE_H

#include <particls/contact.h>
#include <particls/law.h>

typedef struct pls_material
{
    char name[PLS_NAME_SIZE];
    pls_material_values values;
} pls_material;

/// A law between two materials with its numbers.
typedef struct pls_law
{
    const pls_law_ops *ops;
    uint16_t material[2];
    double values[PLS_MAX_PARAMETERS];
    double constants[PLS_LAW_MAX_CONSTANTS];
    double checked[PLS_LAW_MAX_CONSTANTS]; ///< the constants when the stable step was last checked
    bool lever_at_surface;                 ///< see pls_world_set_lever_at_surface
    pls_narrow_options narrow;
} pls_law;

enum { PLS_NO_LAW = UINT16_MAX };

/// Zero-initialise; `pls_law_table_free` releases.
typedef struct pls_law_table
{
    pls_material *material;
    size_t material_count, material_capacity;
    pls_law *law;
    size_t law_count, law_capacity;
    uint16_t *of_pair; ///< material_count x material_count, index into law or PLS_NO_LAW
    size_t of_pair_capacity;
} pls_law_table;

pls_status pls_law_table_add_material(pls_law_table *table, const char *name, const pls_material_values *values, uint16_t *index);
/// Set the law of a pair; `*index` is its place in `law`.
pls_status pls_law_table_set(pls_law_table *table, uint16_t a, uint16_t b, const pls_law_ops *ops, const double *values, uint16_t *index);
/// Index of the law of a pair, PLS_NO_LAW if there is none.
static inline uint16_t pls_law_table_find(const pls_law_table *table, uint16_t a, uint16_t b)
{
    return table->of_pair[(size_t)a * table->material_count + b];
}
/// Prepare a law's constants anew, after a parameter or a material has changed.
pls_status pls_law_table_prepare(pls_law_table *table, uint16_t index);
/// Prepare all laws of a material anew.
pls_status pls_law_table_prepare_material(pls_law_table *table, uint16_t material);
void pls_law_table_free(pls_law_table *table);

#endif
