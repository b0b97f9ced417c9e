// registry.h -- operations by name: shapes, laws, forces, observers. Built-ins and plugins come through the same door.
#ifndef PLS_BASE_REGISTRY_H
#define PLS_BASE_REGISTRY_H

#include "base/alloc.h"

/// Zero-initialise; `pls_registry_free` releases. Entries keep the order of registration. Names must outlive the registry.
typedef struct pls_registry
{
    const char *what; ///< "contact law", for messages
    struct
    {
        const char *name;
        const void *ops;
    } * entry;
    size_t count, capacity;
} pls_registry;

/// DUPLICATE when the name is taken.
pls_status pls_registry_add(pls_registry *registry, const char *name, const void *ops);
/// Null when there is none.
const void *pls_registry_find(const pls_registry *registry, const char *name);
void pls_registry_free(pls_registry *registry);

/// The candidate nearest to `word` by edit distance (with adjacent transpositions), or null when none is near (more than a third of the
/// letters differ). For "did you mean" in messages. Not case-sensitive.
const char *pls_nearest_word(const char *word, const char *const *candidates, size_t count);

#endif
