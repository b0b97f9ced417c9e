// registry.c -- a short list of named operations, and the nearest word for "did you mean".
//
// A registry holds tens of entries and is asked while a scene is built, so a linear search is enough.

#include "base/registry.h"

#include <stdbool.h>
#include <string.h>

pls_status pls_registry_add(pls_registry *registry, const char *name, const void *ops)
{
    const char *what = registry->what ? registry->what : "entry";
    if (!name || !*name || !ops) return pls_fail(PLS_INVALID_ARGUMENT, "cannot register a %s: it needs a name and its functions", what);
    if (pls_registry_find(registry, name))
        return pls_fail(PLS_DUPLICATE, "the %s \"%s\" is already registered: use another name", what, name);
    PLS_TRY(pls_reserve(&registry->entry, &registry->capacity, registry->count + 1, sizeof *registry->entry, what));
    registry->entry[registry->count].name = name;
    registry->entry[registry->count].ops = ops;
    ++registry->count;
    return PLS_OK;
}

const void *pls_registry_find(const pls_registry *registry, const char *name)
{
    if (!name) return NULL;
    for (size_t i = 0; i < registry->count; ++i)
    {
        if (strcmp(registry->entry[i].name, name) == 0) return registry->entry[i].ops;
    }
    return NULL;
}

void pls_registry_free(pls_registry *registry)
{
    pls_release(&registry->entry);
    registry->count = 0;
    registry->capacity = 0;
}

enum { LONGEST_WORD = 63 }; // longer words are no keys of ours, and get no suggestion

static size_t least(size_t a, size_t b) { return a < b ? a : b; }

static char lower(char letter) // of ASCII, whatever the locale
{
    static const int case_bit = 'a' - 'A';
    return (char)(letter >= 'A' && letter <= 'Z' ? letter + case_bit : letter);
}

/// Edits (insertion, deletion, substitution, swap of neighbours) that turn a into b, no letter edited twice: the optimal string alignment
/// distance. Only three rows of its table are needed at a time.
static size_t edit_distance(const char *a, size_t a_size, const char *b, size_t b_size)
{
    size_t rows[3][LONGEST_WORD + 1];
    size_t *before = rows[0], *above = rows[1], *row = rows[2];
    for (size_t j = 0; j <= b_size; ++j) row[j] = j;
    for (size_t i = 1; i <= a_size; ++i)
    {
        size_t *oldest = before;
        before = above;
        above = row;
        row = oldest;
        row[0] = i;
        for (size_t j = 1; j <= b_size; ++j)
        {
            char x = lower(a[i - 1]), y = lower(b[j - 1]);
            row[j] = least(least(above[j], row[j - 1]) + 1, above[j - 1] + (x != y));
            bool swapped = i > 1 && j > 1 && x == lower(b[j - 2]) && lower(a[i - 2]) == y;
            if (swapped) row[j] = least(row[j], before[j - 2] + 1);
        }
    }
    return row[b_size];
}

const char *pls_nearest_word(const char *word, const char *const *candidates, size_t count)
{
    size_t size = strlen(word);
    if (size > LONGEST_WORD) return NULL;
    const char *nearest = NULL;
    size_t fewest = 0;
    for (size_t i = 0; i < count; ++i)
    {
        size_t candidate_size = strlen(candidates[i]);
        if (candidate_size > LONGEST_WORD) continue;
        size_t edits = edit_distance(word, size, candidates[i], candidate_size);
        size_t letters = size > candidate_size ? size : candidate_size;
        if (3 * edits > letters || (nearest && edits >= fewest)) continue;
        nearest = candidates[i];
        fewest = edits;
    }
    return nearest;
}
