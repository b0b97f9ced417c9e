// families.c -- families by cells as wide as the horizon: every partner lies in the cells around a point's own.

#include "bond/families.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "base/sort.h"
#include "contact/broad_phase.h"
#include "contact/cells.h"

#include <stdlib.h>
#include <string.h>

static const double on_the_horizon = 1e-9; ///< of the horizon: lattices have partners right there, and rounding must not choose among them
static const double one_place = 1e-6;      ///< of the horizon: points nearer than this are two in one place

enum {
    SEARCH_BLOCK = 64,
    MOST_BOXES = 500 ///< periodic boxes between two points, which keys of ghosts have room for; those further apart are no partners
};

/// Points sorted into cells.
typedef struct search
{
    pls_families *f;
    const pls_domain *domain;
    double horizon;
    pls_cells cells;
    uint32_t *start, *in_cell; ///< points of each cell, ascending
    double (*wrapped)[3];
    int16_t (*image)[3];
} search;

/// A partner while a family is being sorted.
typedef struct partner
{
    uint32_t point;
    int16_t shift[3];
    double length;
} partner;

void pls_families_free(pls_families *f)
{
    pls_release(&f->point);
    pls_release(&f->ghost);
    pls_release(&f->start);
    pls_release(&f->size);
    pls_release(&f->partner);
    pls_release(&f->length);
    memset(f, 0, sizeof *f);
}

// ---- order ---------------------------------------------------------------------------------------------------------------------------------------------

static void bounds(const pls_families *f, const pls_domain *domain, double lower[3], double upper[3])
{
    for (int a = 0; a < 3; ++a) lower[a] = INFINITY, upper[a] = -INFINITY;
    for (size_t p = 0; p < f->count; ++p)
        for (int a = 0; a < 3; ++a)
        {
            int16_t image;
            const double x = pls_wrap_position(domain, a, f->point[p].x[a], &image);
            lower[a] = fmin(lower[a], x), upper[a] = fmax(upper[a], x);
        }
}

/// By number first, then, stably, along the curve.
static pls_status put_in_order(pls_families *f, const pls_domain *domain, double cell)
{
    double lower[3], upper[3];
    uint64_t *key = NULL;
    uint32_t *from = NULL;
    pls_bond_point *sorted = NULL;
    bounds(f, domain, lower, upper);
    pls_status status = pls_allocate(&key, f->count, sizeof *key, "ordering points");
    if (status == PLS_OK) status = pls_allocate(&from, f->count, sizeof *from, "ordering points");
    if (status == PLS_OK) status = pls_allocate(&sorted, f->count, sizeof *sorted, "points");
    for (int pass = 0; status == PLS_OK && pass < 2; ++pass)
    {
        for (size_t p = 0; p < f->count; ++p)
        {
            double x[3];
            int16_t image;
            for (int a = 0; a < 3; ++a) x[a] = pls_wrap_position(domain, a, f->point[p].x[a], &image);
            key[p] = pass == 0 ? f->point[p].number : pls_morton_key(x, lower, cell);
            from[p] = (uint32_t)p;
        }
        status = pls_radix_sort_u64(key, from, f->count);
        for (size_t p = 0; status == PLS_OK && p < f->count; ++p) sorted[p] = f->point[from[p]];
        if (status == PLS_OK) memcpy(f->point, sorted, f->count * sizeof *sorted);
    }
    pls_release(&key);
    pls_release(&from);
    pls_release(&sorted);
    return status;
}

// ---- search --------------------------------------------------------------------------------------------------------------------------------------------

static void search_free(search *s)
{
    pls_release(&s->start);
    pls_release(&s->in_cell);
    pls_release(&s->wrapped);
    pls_release(&s->image);
}

static size_t cell_of(const search *s, const double x[3])
{
    size_t cell = 0;
    for (int a = 2; a >= 0; --a)
        cell = cell * (size_t)s->cells.along[a] + (size_t)pls_wrap_cell(pls_cell_along(&s->cells, a, x[a]), s->cells.along[a]);
    return cell;
}

static pls_status fill_cells(search *s)
{
    const size_t count = s->f->count;
    double lower[3], upper[3];
    bounds(s->f, s->domain, lower, upper);
    s->cells = pls_cells_make(s->domain, lower, upper, s->horizon * (1.0 + 2.0 * on_the_horizon), count);
    PLS_TRY(pls_allocate(&s->start, s->cells.count + 1, sizeof *s->start, "the search for bonds"));
    PLS_TRY(pls_allocate(&s->in_cell, count, sizeof *s->in_cell, "the search for bonds"));
    PLS_TRY(pls_allocate(&s->wrapped, count, sizeof *s->wrapped, "the search for bonds"));
    PLS_TRY(pls_allocate(&s->image, count, sizeof *s->image, "the search for bonds"));
    for (size_t p = 0; p < count; ++p)
    {
        for (int a = 0; a < 3; ++a) s->wrapped[p][a] = pls_wrap_position(s->domain, a, s->f->point[p].x[a], &s->image[p][a]);
        ++s->start[cell_of(s, s->wrapped[p])];
    }
    PLS_TRY(pls_prefix_sum_u32(s->start, s->cells.count));
    for (size_t p = 0; p < count; ++p) s->in_cell[s->start[cell_of(s, s->wrapped[p])]++] = (uint32_t)p;
    for (size_t c = s->cells.count; c > 0; --c) s->start[c] = s->start[c - 1];
    s->start[0] = 0;
    return PLS_OK;
}

/// The different cells within one of a position's along an axis.
static int cells_around(const search *s, int axis, double x, int64_t out[3])
{
    const int64_t n = s->cells.along[axis], own = pls_cell_along(&s->cells, axis, x);
    int count = 0;
    for (int64_t c = own - 1; c <= own + 1; ++c)
    {
        if (!s->cells.around[axis] && (c < 0 || c >= n)) continue;
        const int64_t wrapped = pls_wrap_cell(c, n);
        bool known = false;
        for (int k = 0; k < count; ++k) known = known || out[k] == wrapped;
        if (!known) out[count++] = wrapped;
    }
    return count;
}

static bool before(const partner *a, const partner *b) { return a->point < b->point; }

/// Partners of a point, in order. `out` null: count them. `nearest`: the distance to the nearest other point of the cells around, for messages.
static size_t family_of(const search *s, size_t p, partner *out, double *nearest)
{
    const double reach = s->horizon * (1.0 + on_the_horizon);
    int64_t around[3][3];
    int count[3];
    size_t found = 0;
    for (int a = 0; a < 3; ++a) count[a] = cells_around(s, a, s->wrapped[p][a], around[a]);
    for (int z = 0; z < count[2]; ++z)
        for (int y = 0; y < count[1]; ++y)
            for (int x = 0; x < count[0]; ++x)
            {
                const size_t cell = ((size_t)around[2][z] * (size_t)s->cells.along[1] + (size_t)around[1][y]) * (size_t)s->cells.along[0] +
                                    (size_t)around[0][x];
                for (uint32_t k = s->start[cell]; k < s->start[cell + 1]; ++k)
                {
                    const uint32_t q = s->in_cell[k];
                    if (q == p) continue;
                    partner one = {.point = q};
                    double square = 0.0;
                    for (int a = 0; a < 3; ++a)
                    {
                        // Differences of the positions themselves, so that both ends find the same length to the bit.
                        double d = s->f->point[q].x[a] - s->f->point[p].x[a];
                        if (s->domain->periodic[a])
                        {
                            one.shift[a] = (int16_t)-fmax(-MOST_BOXES, fmin(rint(d / s->domain->edge[a]), MOST_BOXES));
                            d += one.shift[a] * s->domain->edge[a];
                        }
                        square += d * d;
                    }
                    one.length = sqrt(square);
                    if (nearest) *nearest = fmin(*nearest, one.length);
                    if (one.length > reach) continue;
                    if (out)
                    {
                        size_t at = found;
                        for (; at > 0 && before(&one, &out[at - 1]); --at) out[at] = out[at - 1];
                        out[at] = one;
                    }
                    ++found;
                }
            }
    return found;
}

static pls_status count_partners(search *s)
{
    pls_families *f = s->f;
    const size_t blocks = pls_block_count(f->count, SEARCH_BLOCK);
#pragma omp parallel for schedule(dynamic)
    for (size_t b = 0; b < blocks; ++b)
        for (size_t p = b * SEARCH_BLOCK; p < pls_block_end(b, SEARCH_BLOCK, f->count); ++p)
            f->size[p] = (uint32_t)family_of(s, p, NULL, NULL);
    for (size_t p = 0; p < f->count; ++p)
    {
        f->bonds += f->size[p];
        f->start[p] = (f->size[p] + PLS_BOND_VECTOR - 1) / PLS_BOND_VECTOR;
        if (f->size[p] > 0) continue;
        double nearest = INFINITY;
        family_of(s, p, NULL, &nearest);
        if (isfinite(nearest))
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "body %u has no other point within the horizon of %g m: the next one is %g m away. Take a larger horizon; "
                            "three times the spacing is usual",
                            f->point[p].number, s->horizon, nearest);
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "body %u has no other point within the horizon of %g m. Take a larger horizon (three times the spacing is usual), "
                        "or leave the body out",
                        f->point[p].number, s->horizon);
    }
    return pls_prefix_sum_u32(f->start, f->count);
}

/// Partners that lie beyond a periodic face become ghosts: one per image of a point, in order of point and shift.
typedef struct ghosts
{
    uint64_t *key; ///< point, then shift
    size_t count, capacity;
} ghosts;

static uint64_t ghost_key(const partner *q)
{
    uint64_t key = q->point;
    for (int a = 0; a < 3; ++a) key = key << 10 | (uint64_t)((q->shift[a] + 512) & 1023);
    return key;
}

static bool is_shifted(const partner *q) { return q->shift[0] != 0 || q->shift[1] != 0 || q->shift[2] != 0; }

static int compare_keys(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static pls_status find_ghosts(const search *s, partner *family, ghosts *g)
{
    for (size_t p = 0; p < s->f->count; ++p)
    {
        const size_t count = family_of(s, p, family, NULL);
        for (size_t k = 0; k < count; ++k)
        {
            if (!is_shifted(&family[k])) continue;
            PLS_TRY(pls_reserve(&g->key, &g->capacity, g->count + 1, sizeof *g->key, "bonds across periodic faces"));
            g->key[g->count++] = ghost_key(&family[k]);
        }
    }
    size_t kept = 0;
    if (g->count > 0) qsort(g->key, g->count, sizeof *g->key, compare_keys);
    for (size_t k = 0; k < g->count; ++k)
        if (kept == 0 || g->key[kept - 1] != g->key[k]) g->key[kept++] = g->key[k];
    g->count = kept;
    PLS_TRY(pls_allocate(&s->f->ghost, kept, sizeof *s->f->ghost, "bonds across periodic faces"));
    s->f->ghosts = kept;
    for (size_t k = 0; k < kept; ++k)
    {
        pls_bond_ghost *ghost = &s->f->ghost[k];
        ghost->point = (uint32_t)(g->key[k] >> 30);
        for (int a = 0; a < 3; ++a) ghost->shift[a] = (int16_t)((int)(g->key[k] >> (20 - 10 * a) & 1023) - 512);
    }
    return PLS_OK;
}

static uint32_t place_of(const pls_families *f, const ghosts *g, const partner *q)
{
    if (!is_shifted(q)) return q->point;
    const uint64_t key = ghost_key(q), *at = bsearch(&key, g->key, g->count, sizeof key, compare_keys);
    return (uint32_t)(f->count + (size_t)(at - g->key));
}

/// Partners of the points of a block; the first of two points in one place, or count.
static size_t fill_block(const search *s, const ghosts *g, size_t block, partner *family)
{
    pls_families *f = s->f;
    size_t bad = f->count;
    for (size_t p = block * SEARCH_BLOCK; p < pls_block_end(block, SEARCH_BLOCK, f->count); ++p)
    {
        const size_t count = family_of(s, p, family, NULL), first = (size_t)f->start[p] * PLS_BOND_VECTOR,
                     end = (size_t)f->start[p + 1] * PLS_BOND_VECTOR;
        for (size_t k = 0; first + k < end; ++k)
        {
            f->partner[first + k] = place_of(f, g, &family[k < count ? k : count - 1]);
            f->length[first + k] = k < count ? family[k].length : PLS_NO_LENGTH;
            if (k < count && family[k].length < one_place * s->horizon && p < bad) bad = p;
        }
    }
    return bad;
}

static pls_status fill(search *s, const ghosts *g, uint32_t largest)
{
    pls_families *f = s->f;
    const size_t slots = (size_t)f->start[f->count] * PLS_BOND_VECTOR, blocks = pls_block_count(f->count, SEARCH_BLOCK);
    PLS_TRY(pls_allocate(&f->partner, slots, sizeof *f->partner, "bonds"));
    PLS_TRY(pls_allocate(&f->length, slots, sizeof *f->length, "bonds"));
    size_t bad = f->count;
    bool room = true;
#pragma omp parallel
    {
        partner *family = NULL;
        const bool mine = pls_allocate(&family, largest, sizeof *family, "the search for bonds") == PLS_OK;
        size_t worst = f->count;
#pragma omp for schedule(dynamic)
        for (size_t b = 0; b < blocks; ++b)
        {
            const size_t found = mine ? fill_block(s, g, b, family) : f->count;
            if (found < worst) worst = found;
        }
#pragma omp critical(pls_families)
        {
            room = room && mine;
            if (worst < bad) bad = worst;
        }
        pls_release(&family);
    }
    if (!room) return pls_fail(PLS_OUT_OF_MEMORY, "no memory for the search for bonds");
    if (bad == f->count) return PLS_OK;
    for (size_t k = (size_t)f->start[bad] * PLS_BOND_VECTOR;; ++k)
        if (f->length[k] < one_place * s->horizon)
        {
            const uint32_t q = f->partner[k], other = q < f->count ? q : f->ghost[q - f->count].point;
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "bodies %u and %u lie in one place (%g m apart, the horizon is %g m): points of a continuum must not overlap",
                            f->point[bad].number, f->point[other].number, f->length[k], s->horizon);
        }
}

static pls_status check_periods(const pls_domain *domain, double horizon)
{
    for (int a = 0; a < 3; ++a)
        if (domain->periodic[a] && !(domain->edge[a] > 2.0 * horizon * (1.0 + on_the_horizon)))
            return pls_fail(
                PLS_INVALID_ARGUMENT,
                "the periodic box is %g m long along %c, less than two horizons of %g m: a point would be bonded to two images of another",
                domain->edge[a], "xyz"[a], horizon);
    return PLS_OK;
}

static pls_status find_families(search *s)
{
    pls_families *f = s->f;
    PLS_TRY(put_in_order(f, s->domain, s->horizon / 3.0));
    PLS_TRY(fill_cells(s));
    PLS_TRY(pls_allocate(&f->start, f->count + 1, sizeof *f->start, "families"));
    PLS_TRY(pls_allocate(&f->size, f->count, sizeof *f->size, "families"));
    PLS_TRY(count_partners(s));
    uint32_t largest = 1;
    for (size_t p = 0; p < f->count; ++p) largest = f->size[p] > largest ? f->size[p] : largest;
    ghosts g = {0};
    partner *family = NULL;
    pls_status status = pls_allocate(&family, largest, sizeof *family, "the search for bonds");
    if (status == PLS_OK && s->domain->any_periodic) status = find_ghosts(s, family, &g);
    if (status == PLS_OK) status = fill(s, &g, largest);
    pls_release(&family);
    pls_release(&g.key);
    return status;
}

pls_status pls_families_make(pls_families *f, pls_bond_point *point, size_t count, double horizon, const pls_domain *domain)
{
    *f = (pls_families){.count = count, .point = point};
    search s = {.f = f, .domain = domain, .horizon = horizon};
    pls_status status = check_periods(domain, horizon);
    if (status == PLS_OK) status = find_families(&s);
    search_free(&s);
    if (status != PLS_OK) pls_families_free(f);
    return status;
}
