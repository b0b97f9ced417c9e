// approach.c -- how much nearer those may have come that are not listed.
//
// Bodies that move together do not come nearer, however far they go: only displacements of neighbours against each other count. Space is cut into cells, now, that are
// as wide as the skin and the largest diameter together. Bodies in cells that are no neighbours have gaps wider than the skin, wherever they come from.
// Two neighbouring cells lie in one of the blocks of two by two by two cells, and the box around the displacements of all bodies of a block bounds how much any
// two of them have moved against each other. Such boxes are merged along one axis after the other.
//
// A half-space is asked itself: its list holds who was near it, so the gap of those that were not is what is left.

#include "contact/approach.h"

#include "base/alloc.h"
#include "contact/cells.h"
#include "contact/sphere_contact.h"

static const double surely = 0.99; ///< of the skin: whose gap at a half-space was narrower is listed there

static const pls_moved_box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/// What all bounded bodies together tell.
typedef struct extent
{
    double lower[3], upper[3]; ///< of their centres
    double radius;             ///< the largest
    double growth;             ///< the largest
    double first, second;      ///< the largest displacements, growth included
    size_t count;
} extent;

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }

static inline void displacement(const pls_pair_list *list, const pls_bodies *bodies, size_t row, double u[3])
{
    const pls_body_place *p = &bodies->place[row];
    u[0] = p->x - list->reference[row][0], u[1] = p->y - list->reference[row][1], u[2] = p->z - list->reference[row][2];
}

static inline double growth_of(const pls_pair_list *list, const pls_bodies *bodies, size_t row)
{
    return larger(0.0, bodies->place[row].radius - list->reference_radius[row]);
}

static extent measure(const pls_pair_list *list, const pls_bodies *bodies)
{
    extent e = {.lower = {INFINITY, INFINITY, INFINITY}, .upper = {-INFINITY, -INFINITY, -INFINITY}};
    for (size_t row = 0; row < bodies->count; ++row)
    {
        if (bodies->kind[row].flags & PLS_BODY_UNBOUNDED) continue;
        const pls_body_place *p = &bodies->place[row];
        const double x[3] = {p->x, p->y, p->z}, growth = growth_of(list, bodies, row);
        double u[3];
        displacement(list, bodies, row, u);
        for (int a = 0; a < 3; ++a) e.lower[a] = smaller(e.lower[a], x[a]), e.upper[a] = larger(e.upper[a], x[a]);
        const double moved = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) + growth;
        e.radius = larger(e.radius, p->radius);
        e.growth = larger(e.growth, growth);
        e.second = larger(e.second, smaller(moved, e.first));
        e.first = larger(e.first, moved);
        ++e.count;
    }
    return e;
}

// ---- bounded bodies -------------------------------------------------------------------------------------------------------------------------------------

static size_t cell_of(const pls_cells *cells, const pls_domain *domain, const pls_body_place *p)
{
    const double x[3] = {p->x, p->y, p->z};
    size_t cell = 0;
    for (int a = 2; a >= 0; --a)
    {
        int16_t image;
        int64_t n = cells->along[a], c = pls_cell_along(cells, a, pls_wrap_position(domain, a, x[a], &image));
        c = cells->around[a] ? pls_wrap_cell(c, n) : c < 0 ? 0 : c < n ? c : n - 1;
        cell = cell * (size_t)n + (size_t)c;
    }
    return cell;
}

static inline void merge(pls_moved_box *box, const pls_moved_box *other)
{
    for (int a = 0; a < 3; ++a) box->low[a] = smaller(box->low[a], other->low[a]), box->high[a] = larger(box->high[a], other->high[a]);
}

/// Each box becomes the one around itself and the next along an axis. Cells come `stride` apart there, `n` of them.
static void merge_along(pls_moved_box *box, size_t count, size_t stride, size_t n, bool around)
{
    if (n < 2) return;
    for (size_t first = 0; first < count; first += stride * n)
        for (size_t k = 0; k < stride; ++k)
        {
            pls_moved_box *row = box + first + k, begin = row[0];
            for (size_t m = 0; m + 1 < n; ++m) merge(&row[m * stride], &row[(m + 1) * stride]);
            if (around) merge(&row[(n - 1) * stride], &begin);
        }
}

/// Largest displacement of neighbours against each other.
static double widest(const pls_moved_box *box, size_t count)
{
    double square = 0.0;
    for (size_t c = 0; c < count; ++c)
    {
        const double d[3] = {box[c].high[0] - box[c].low[0], box[c].high[1] - box[c].low[1], box[c].high[2] - box[c].low[2]};
        if (d[0] >= 0.0) square = larger(square, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
    return sqrt(square);
}

static pls_status of_neighbours(pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, const extent *e, double *out)
{
    const pls_cells cells = pls_cells_make(domain, e->lower, e->upper, 2.0 * e->radius + list->skin, e->count);
    PLS_TRY(pls_reserve(&list->moved, &list->moved_capacity, cells.count, sizeof *list->moved, "how far bodies moved"));
    pls_moved_box *box = list->moved;
    for (size_t c = 0; c < cells.count; ++c) box[c] = nothing;
    for (size_t row = 0; row < bodies->count; ++row)
    {
        if (bodies->kind[row].flags & PLS_BODY_UNBOUNDED) continue;
        double u[3];
        displacement(list, bodies, row, u);
        const pls_moved_box own = {{u[0], u[1], u[2]}, {u[0], u[1], u[2]}};
        merge(&box[cell_of(&cells, domain, &bodies->place[row])], &own);
    }
    for (size_t a = 0, stride = 1; a < 3; stride *= (size_t)cells.along[a], ++a)
        merge_along(box, cells.count, stride, (size_t)cells.along[a], cells.around[a]);
    *out = widest(box, cells.count) + 2.0 * e->growth;
    return PLS_OK;
}

// ---- walls ------------------------------------------------------------------------------------------------------------------------------------------------

/// A half-space that turns has all bodies in its list.
static double of_half_space(const pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, size_t wall)
{
    const pls_vec3 n = pls_wall_normal(&bodies->orientation[wall], domain->dimension);
    const pls_body_place *w = &bodies->place[wall];
    if (pls_wall_sweeps(bodies, wall)) return 0.0;
    double v[3], least = list->skin;
    displacement(list, bodies, wall, v);
    for (size_t row = 0; row < bodies->count; ++row)
    {
        const pls_body_place *p = &bodies->place[row];
        const double gap = n.x * (p->x - w->x) + n.y * (p->y - w->y) + n.z * (p->z - w->z) - p->radius;
        if (!(gap < least) || (bodies->kind[row].flags & PLS_BODY_UNBOUNDED)) continue;
        double u[3];
        displacement(list, bodies, row, u);
        const double then =
            gap - (n.x * (u[0] - v[0]) + n.y * (u[1] - v[1]) + n.z * (u[2] - v[2])) + p->radius - list->reference_radius[row];
        if (!(then < surely * list->skin)) least = gap;
    }
    return list->skin - least;
}

/// Pieces of a wall are listed body by body: any body may come near others.
static double of_pieces(const pls_pair_list *list, const pls_bodies *bodies, size_t wall)
{
    double most = 0.0, v[3];
    displacement(list, bodies, wall, v);
    for (size_t row = 0; row < bodies->count; ++row)
    {
        if (bodies->kind[row].flags & PLS_BODY_UNBOUNDED) continue;
        double u[3];
        displacement(list, bodies, row, u);
        const double x = u[0] - v[0], y = u[1] - v[1], z = u[2] - v[2];
        most = larger(most, sqrt(x * x + y * y + z * z) + growth_of(list, bodies, row));
    }
    return most;
}

pls_status pls_pair_list_approach(pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, double *approach)
{
    const extent e = measure(list, bodies);
    double most = 0.0;
    if (e.count > 1)
    {
        PLS_TRY(of_neighbours(list, bodies, domain, &e, &most));
        most = smaller(most, e.first + e.second);
    }
    for (size_t row = 0; row < bodies->count; ++row)
    {
        if (!(bodies->kind[row].flags & PLS_BODY_UNBOUNDED)) continue;
        const bool pieces = (bodies->kind[row].flags & PLS_BODY_SOLID) != 0;
        most = larger(most, pieces ? of_pieces(list, bodies, row) : of_half_space(list, bodies, domain, row));
    }
    *approach = most;
    return PLS_OK;
}
