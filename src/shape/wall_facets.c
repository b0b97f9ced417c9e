// wall_facets.c -- which pieces of a wall hang together, and how.

#include "shape/wall_facets.h"

#include "base/alloc.h"

#include <stdlib.h>
#include <string.h>

static const double straight = 1e-6; ///< bend of what goes straight on [rad]

/// A side of a piece, by the numbers of its corners.
typedef struct side
{
    uint32_t low, high; ///< of a segment's end both are the same
    uint32_t piece;
    int place;
} side;

typedef struct place
{
    pls_vec3 x;
    uint32_t corner; ///< D * piece + which
} place;

typedef struct seams
{
    pls_vec3 (*corner)[3];
    size_t count;
    int dimension;
    pls_facet *facet;
    place *place;     ///< all corners in the order of their places
    uint32_t *number; ///< of each corner: those at one place have the same
    side *side;       ///< all sides in the order of their corners
    uint32_t *queue;
    bool *seen;
} seams;

/// The number of corner k of a piece, counted round.
static uint32_t number_of(const seams *s, uint32_t f, int k)
{
    const size_t d = (size_t)s->dimension;
    return s->number[d * f + (size_t)k % d];
}

static pls_status allocate(seams *s)
{
    if (s->count > UINT32_MAX / 4)
        return pls_fail(PLS_INVALID_ARGUMENT, "a wall of %zu pieces is too large; %u fit", s->count, UINT32_MAX / 4);
    const size_t all = (size_t)s->dimension * s->count;
    PLS_TRY(pls_allocate(&s->place, all, sizeof *s->place, "corners of a wall"));
    PLS_TRY(pls_allocate(&s->number, all, sizeof *s->number, "corners of a wall"));
    PLS_TRY(pls_allocate(&s->side, all, sizeof *s->side, "seams of a wall"));
    PLS_TRY(pls_allocate(&s->queue, s->count, sizeof *s->queue, "seams of a wall"));
    return pls_allocate(&s->seen, s->count, sizeof *s->seen, "seams of a wall");
}

static void release(seams *s)
{
    pls_release(&s->place), pls_release(&s->number), pls_release(&s->side), pls_release(&s->queue), pls_release(&s->seen);
}

static void swap_numbers(uint32_t *a, uint32_t *b)
{
    const uint32_t kept = *a;
    *a = *b, *b = kept;
}

// ---- geometry of a piece ----------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 normal_of(const seams *s, uint32_t f)
{
    const pls_vec3 *x = s->corner[f], along = pls_sub(x[1], x[0]);
    return pls_unit(s->dimension == 3 ? pls_cross(along, pls_sub(x[2], x[0])) : pls_vec(along.y, -along.x, 0.0));
}

/// Unit, at right angles to side k, into the piece.
static pls_vec3 inwards(const seams *s, uint32_t f, int k)
{
    const pls_vec3 *x = s->corner[f];
    if (s->dimension == 2) return pls_unit(pls_sub(x[1 - k], x[k]));
    const pls_vec3 along = pls_unit(pls_sub(x[(k + 1) % 3], x[k])), other = pls_sub(x[(k + 2) % 3], x[k]);
    return pls_unit(pls_sub(other, pls_scale(along, pls_dot(other, along))));
}

/// Angle of the piece at its corner k.
static double angle_at(const seams *s, uint32_t f, int k)
{
    if (s->dimension == 2) return 1.0;
    const pls_vec3 *x = s->corner[f], a = pls_sub(x[(k + 1) % 3], x[k]), b = pls_sub(x[(k + 2) % 3], x[k]);
    return atan2(pls_length(pls_cross(a, b)), pls_dot(a, b));
}

/// Do both pieces, seen from one side, run the other way along the seam between their sides k and j, as pieces with the same front do?
static bool same_front(const seams *s, uint32_t f, int k, uint32_t g, int j)
{
    if (s->dimension == 2) return k != j; // a way goes on from the end of a piece to the start of another
    return number_of(s, f, k) != number_of(s, g, j);
}

// ---- corners ------------------------------------------------------------------------------------------------------------------------------------------------

static int sign_of(double a, double b) { return (a > b) - (a < b); }

static int by_place(const void *a, const void *b)
{
    const place *p = a, *q = b;
    const int x = sign_of(p->x.x, q->x.x), y = sign_of(p->x.y, q->x.y), z = sign_of(p->x.z, q->x.z);
    if (x) return x;
    if (y) return y;
    return z ? z : (p->corner > q->corner) - (p->corner < q->corner);
}

static void number_corners(seams *s)
{
    const size_t d = (size_t)s->dimension, all = d * s->count;
    for (size_t c = 0; c < all; ++c) s->place[c] = (place){s->corner[c / d][c % d], (uint32_t)c};
    qsort(s->place, all, sizeof *s->place, by_place);
    uint32_t number = 0;
    for (size_t c = 0; c < all; ++c)
    {
        const pls_vec3 x = s->place[c].x, before = s->place[c ? c - 1 : 0].x;
        if (x.x != before.x || x.y != before.y || x.z != before.z) ++number;
        s->number[s->place[c].corner] = number;
    }
}

// ---- sides --------------------------------------------------------------------------------------------------------------------------------------------------

static int by_corners(const void *a, const void *b)
{
    const side *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return (p->piece > q->piece) - (p->piece < q->piece);
}

/// Of pieces: `place` is the highest corner.
static int by_all_corners(const void *a, const void *b)
{
    const side *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    if (p->place != q->place) return p->place < q->place ? -1 : 1;
    return (p->piece > q->piece) - (p->piece < q->piece);
}

static bool at_one_seam(const side *p, const side *q) { return p->low == q->low && p->high == q->high; }

static void sort_sides(seams *s)
{
    const size_t d = (size_t)s->dimension, all = d * s->count;
    for (size_t c = 0; c < all; ++c)
    {
        const size_t f = c / d, k = c % d;
        const uint32_t from = s->number[c], to = d == 3 ? s->number[d * f + (k + 1) % d] : from;
        s->side[c] = (side){from < to ? from : to, from < to ? to : from, (uint32_t)f, (int)k};
    }
    qsort(s->side, all, sizeof *s->side, by_corners);
}

/// Of several pieces that meet there the one that goes on straightest.
static const side *straightest(const seams *s, const side *own, const side *first, const side *last)
{
    const side *best = NULL;
    double least = INFINITY;
    const pls_vec3 t = inwards(s, own->piece, own->place);
    for (const side *p = first; p < last; ++p)
    {
        if (p->piece == own->piece) continue;
        const double along = pls_dot(t, inwards(s, p->piece, p->place));
        if (along < least) least = along, best = p;
    }
    return best;
}

static void find_neighbours(seams *s)
{
    const side *end = s->side + (size_t)s->dimension * s->count;
    for (const side *first = s->side, *last; first < end; first = last)
    {
        for (last = first + 1; last < end && at_one_seam(first, last);) ++last;
        for (const side *p = first; p < last; ++p)
        {
            const side *other = straightest(s, p, first, last);
            s->facet[p->piece].neighbour[p->place] = other ? other->piece : PLS_NO_FACET;
        }
    }
}

/// The side of f's neighbour beyond side k that lies there; -1: none.
static int side_beyond(const seams *s, uint32_t f, int k)
{
    const uint32_t g = s->facet[f].neighbour[k];
    const int d = s->dimension;
    if (g == PLS_NO_FACET) return -1;
    const uint32_t a = number_of(s, f, k), b = d == 3 ? number_of(s, f, k + 1) : a;
    for (int j = 0; j < d; ++j)
    {
        const uint32_t p = number_of(s, g, j), q = d == 3 ? number_of(s, g, j + 1) : p;
        if ((p == a && q == b) || (p == b && q == a)) return j;
    }
    return -1;
}

/// Is each the other's neighbour there? Where three pieces meet, two are and the third is not.
static bool hangs_together(const seams *s, uint32_t f, int k, int *j)
{
    *j = side_beyond(s, f, k);
    return *j >= 0 && s->facet[s->facet[f].neighbour[k]].neighbour[*j] == f;
}

// ---- fronts and patches -------------------------------------------------------------------------------------------------------------------------------------

static void swap_places(seams *s, uint32_t f, int i, int j)
{
    const size_t d = (size_t)s->dimension;
    const pls_vec3 x = s->corner[f][i];
    s->corner[f][i] = s->corner[f][j], s->corner[f][j] = x;
    const uint32_t number = s->number[d * f + (size_t)i];
    s->number[d * f + (size_t)i] = s->number[d * f + (size_t)j], s->number[d * f + (size_t)j] = number;
}

/// Exchange two corners; sides go along: of a triangle 0-1, 1-2, 2-0 become 1-0, 0-2, 2-1.
static void turn_over(seams *s, uint32_t f)
{
    uint32_t *n = s->facet[f].neighbour, kept = n[1];
    swap_places(s, f, 0, 1);
    if (s->dimension == 3)
        n[1] = n[2], n[2] = kept;
    else
        n[1] = n[0], n[0] = kept;
}

static void agree_on_fronts(seams *s)
{
    for (size_t c = 0; c < s->count; ++c) s->seen[c] = false;
    for (size_t first = 0; first < s->count; ++first)
    {
        if (s->seen[first]) continue;
        size_t head = 0, tail = 0;
        s->seen[first] = true, s->queue[tail++] = (uint32_t)first;
        while (head < tail)
        {
            const uint32_t f = s->queue[head++];
            s->facet[f].sheet = (uint32_t)first;
            for (int k = 0, j; k < s->dimension; ++k)
            {
                if (!hangs_together(s, f, k, &j)) continue;
                const uint32_t g = s->facet[f].neighbour[k];
                if (s->seen[g]) continue;
                if (!same_front(s, f, k, g, j)) turn_over(s, g);
                s->seen[g] = true, s->queue[tail++] = g;
            }
        }
    }
}

static void find_patches(seams *s)
{
    for (size_t c = 0; c < s->count; ++c)
        s->facet[c].number = (uint32_t)c, s->facet[c].normal = normal_of(s, (uint32_t)c), s->facet[c].patch = PLS_NO_FACET;
    for (size_t first = 0; first < s->count; ++first)
    {
        if (s->facet[first].patch != PLS_NO_FACET) continue;
        const uint32_t patch = (uint32_t)first;
        const pls_vec3 front = s->facet[first].normal;
        size_t head = 0, tail = 0;
        s->facet[first].patch = patch, s->queue[tail++] = patch;
        while (head < tail)
        {
            const uint32_t f = s->queue[head++];
            for (int k = 0, j; k < s->dimension; ++k)
            {
                if (!hangs_together(s, f, k, &j)) continue;
                pls_facet *g = &s->facet[s->facet[f].neighbour[k]];
                if (g->patch != PLS_NO_FACET || !(pls_dot(front, g->normal) > PLS_LEVEL_FACETS)) continue;
                g->patch = patch, s->queue[tail++] = s->facet[f].neighbour[k];
            }
        }
    }
}

// ---- seams --------------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 unit_or(pls_vec3 a, pls_vec3 otherwise) { return pls_length(a) > 1e-6 ? pls_unit(a) : otherwise; }

void pls_facet_join(pls_facet *facet, int k, uint32_t neighbour, pls_vec3 beyond, bool level)
{
    const pls_vec3 out = facet->side[k];
    const double cosine = pls_dot(out, beyond), sine = -pls_dot(facet->normal, beyond);
    facet->neighbour[k] = neighbour, facet->level[k] = level;
    facet->bend[k] = atan2(sine, cosine);
    facet->side[k] = unit_or(pls_add(beyond, out), out);
    facet->side_normal[k] = unit_or(pls_add(pls_scale(facet->normal, 1.0 + cosine), pls_scale(out, sine)), out);
}

static void tell_of_sides(seams *s, uint32_t f)
{
    pls_facet *facet = &s->facet[f];
    for (int k = 0; k < s->dimension; ++k)
    {
        const uint32_t beyond = facet->neighbour[k];
        const int j = side_beyond(s, f, k);
        int back;
        facet->bend[k] = 0.0, facet->level[k] = false;
        facet->leans[k] = j >= 0 && !hangs_together(s, f, k, &back);
        facet->side[k] = pls_scale(inwards(s, f, k), -1.0), facet->side_normal[k] = facet->normal;
        if (j >= 0) pls_facet_join(facet, k, beyond, inwards(s, beyond, j), s->facet[beyond].patch == facet->patch);
    }
}

/// Both sides of a piece at its corner; of a segment the one end.
static void bends_at(const seams *s, uint32_t corner, double *least, double *most, bool *free)
{
    const uint32_t d = (uint32_t)s->dimension, k = corner % d, before = (k + d - 1) % d;
    const pls_facet *facet = &s->facet[corner / d];
    const uint32_t sides[2] = {k, d == 3 ? before : k};
    for (int j = 0; j < 2; ++j)
    {
        *least = fmin(*least, facet->bend[sides[j]]), *most = fmax(*most, facet->bend[sides[j]]);
        *free = *free || facet->neighbour[sides[j]] == PLS_NO_FACET || facet->leans[sides[j]];
    }
}

/// Corners first .. last of the sorted ones are at one place.
static void tell_of_corner(seams *s, size_t first, size_t last)
{
    const uint32_t d = (uint32_t)s->dimension;
    double least = 0.0, most = 0.0, level = 1.0;
    bool free = false;
    pls_vec3 sum = {0.0, 0.0, 0.0};
    for (size_t c = first; c < last; ++c)
    {
        const uint32_t at = s->place[c].corner;
        bends_at(s, at, &least, &most, &free);
        sum = pls_add(sum, pls_scale(s->facet[at / d].normal, angle_at(s, at / d, (int)(at % d))));
    }
    const int form = free ? 0 : least > -straight ? 1 : most < straight ? -1 : 0;
    const pls_vec3 mean = unit_or(sum, s->facet[s->place[first].corner / d].normal);
    for (size_t c = first; c < last; ++c) level = fmin(level, pls_dot(mean, s->facet[s->place[c].corner / d].normal));
    for (size_t c = first; c < last; ++c)
    {
        const uint32_t at = s->place[c].corner;
        pls_facet *own = &s->facet[at / d];
        own->corner_normal[at % d] = mean, own->corner_level[at % d] = level, own->corner_form[at % d] = form;
    }
}

static void tell_of_corners(seams *s)
{
    const size_t all = (size_t)s->dimension * s->count;
    for (size_t first = 0, last; first < all; first = last)
    {
        const uint32_t number = s->number[s->place[first].corner];
        for (last = first + 1; last < all && s->number[s->place[last].corner] == number;) ++last;
        tell_of_corner(s, first, last);
    }
}

// ---- pieces twice -------------------------------------------------------------------------------------------------------------------------------------------

/// Corners of a piece in the order of their numbers.
static void sorted_corners(const seams *s, uint32_t f, uint32_t n[3])
{
    for (int k = 0; k < 3; ++k) n[k] = number_of(s, f, s->dimension == 3 ? k : k % 2);
    for (int pass = 0; pass < 2; ++pass)
        for (int k = 0; k < 2; ++k)
            if (n[k] > n[k + 1]) swap_numbers(&n[k], &n[k + 1]);
}

/// Makes the sides of pieces between the same corners follow each other: by low, high and the third one.
static void sort_pieces(seams *s)
{
    for (size_t f = 0; f < s->count; ++f)
    {
        uint32_t n[3];
        sorted_corners(s, (uint32_t)f, n);
        s->side[f] = (side){n[0], n[1], (uint32_t)f, (int)n[2]};
    }
    qsort(s->side, s->count, sizeof *s->side, by_all_corners);
}

pls_status pls_wall_unique(pls_vec3 (*corner)[3], size_t *count, int dimension)
{
    seams s = {.corner = corner, .count = *count, .dimension = dimension};
    pls_status status = allocate(&s);
    if (status == PLS_OK)
    {
        number_corners(&s);
        sort_pieces(&s);
        for (size_t f = 0; f < *count; ++f) s.seen[f] = false;
        for (size_t k = 1; k < *count; ++k) // the first one of the same stays
            s.seen[s.side[k].piece] = at_one_seam(&s.side[k - 1], &s.side[k]) && s.side[k - 1].place == s.side[k].place;
        size_t left = 0;
        for (size_t f = 0; f < *count; ++f)
            if (!s.seen[f]) memmove(corner[left++], corner[f], sizeof *corner);
        *count = left;
    }
    release(&s);
    return status;
}

// ---- the call -----------------------------------------------------------------------------------------------------------------------------------------------

pls_status pls_wall_facets(pls_vec3 (*corner)[3], size_t count, int dimension, pls_facet *out)
{
    seams s = {.corner = corner, .count = count, .dimension = dimension, .facet = out};
    const pls_status status = allocate(&s);
    if (status == PLS_OK)
    {
        number_corners(&s);
        sort_sides(&s);
        find_neighbours(&s);
        agree_on_fronts(&s);
        find_patches(&s);
        for (size_t f = 0; f < count; ++f) tell_of_sides(&s, (uint32_t)f);
        number_corners(&s); // pieces that were turned over have theirs elsewhere
        tell_of_corners(&s);
    }
    release(&s);
    return status;
}
