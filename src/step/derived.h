// derived.h -- fields of bodies that nobody keeps: they are found when somebody asks.
#ifndef PLS_STEP_DERIVED_H
#define PLS_STEP_DERIVED_H

#include "step/world.h"

/// What was found last, by rows. Zero-initialise; `pls_derived_free` releases.
typedef struct pls_derived
{
    uint32_t *fragment, *by_number;
    double *temperature, *plastic_strain;
    size_t fragments, numbers, temperatures, strains; ///< room of each
} pls_derived;

void pls_derived_free(pls_derived *derived);
/// Values of a field with PLS_FIELD_DERIVED, as bodies are now; valid until it is asked for again or the world changes.
pls_status pls_derive_field(const pls_world *world, const pls_field *field, pls_field_view *view);

#endif
