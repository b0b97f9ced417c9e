// fill_points.c -- points of a continuum: a lattice in a region.

#include "scene/generators.h"
#include "scene/schema.h"

#include <string.h>

static const double on_the_surface = 1e-9; ///< of the spacing: points right on the region's surface belong to it, whatever rounding says
static const double most_places = 4e9;     ///< of the lattice in the box around the region

/// The lattice over the region's box, in the region's own frame.
typedef struct lattice
{
    const pls_shape *shape;
    bool hexagonal;
    int dimension;
    double spacing;
    pls_vec3 first;  ///< place (0, 0, 0)
    size_t count[3]; ///< places along each axis
    pls_vec3 position;
    pls_quat turn; ///< of the frame
    pls_formula *where;
    pls_formula_copy *copy; ///< of `where`
} lattice;

/// Vectors of the hexagonal packing: rows are sqrt(3)/2 spacings apart, layers sqrt(6)/3.
static double step_along(const lattice *l, int axis)
{
    if (!l->hexagonal || axis == 0) return l->spacing;
    return l->spacing * (axis == 1 ? sqrt(3.0) / 2.0 : sqrt(6.0) / 3.0);
}

static pls_vec3 place(const lattice *l, size_t i, size_t j, size_t k)
{
    const double s = l->spacing;
    pls_vec3 at = pls_vec(s * (double)i, step_along(l, 1) * (double)j, l->dimension == 3 ? step_along(l, 2) * (double)k : 0.0);
    if (l->hexagonal) at.x += 0.5 * s * ((double)((j + k) % 2) - 0.5), at.y += s * sqrt(3.0) / 6.0 * (double)(k % 2);
    return pls_add(l->first, at);
}

/// Volume of a cell; in 2D its area.
static double cell_volume(const lattice *l)
{
    const double s = l->spacing;
    if (l->dimension == 2) return l->hexagonal ? s * s * sqrt(3.0) / 2.0 : s * s;
    return l->hexagonal ? s * s * s / sqrt(2.0) : s * s * s;
}

static pls_status lay_out(lattice *l, const pls_node *fill)
{
    const double lower[3] = {l->shape->lower.x, l->shape->lower.y, l->shape->lower.z},
                 upper[3] = {l->shape->upper.x, l->shape->upper.y, l->shape->upper.z};
    double first[3] = {0.0, 0.0, 0.0}, all = 1.0;
    for (int a = 0; a < 3; ++a)
    {
        l->count[a] = 1;
        if (a >= l->dimension) continue;
        const double step = step_along(l, a), edge = upper[a] - lower[a], cells = fmax(1.0, floor(edge / step + 0.5 + on_the_surface));
        // Whole cells lie in the middle, so that a box of whole cells has its points half a spacing inside.
        first[a] = 0.5 * (lower[a] + upper[a]) - 0.5 * step * (cells - 1.0);
        all *= cells;
        l->count[a] = cells < most_places ? (size_t)cells : 0;
    }
    if (all > most_places)
        return pls_node_fail(pls_node_get(fill, "spacing"), "take a larger spacing",
                             "a lattice of %g m over the region has %g places, more than this program can number", l->spacing, all);
    l->first = pls_vec(first[0], first[1], first[2]);
    return PLS_OK;
}

/// Whether a place of the region's frame is taken; `at` is where it lies in the world.
static pls_status is_taken(const lattice *l, pls_vec3 X, pls_vec3 *at, bool *taken)
{
    double value = 1.0;
    *taken = pls_shape_sdf(l->shape, X) <= on_the_surface * l->spacing;
    *at = pls_add(l->position, pls_rotate(l->turn, X));
    if (!*taken || !l->where) return PLS_OK;
    PLS_TRY(pls_formula_values(l->where, l->copy, (const double[3]){at->x, at->y, at->z}, &value));
    *taken = value != 0.0;
    return PLS_OK;
}

/// Points within the region; with `out` null they are counted.
static pls_status take(const lattice *l, pls_vec3 *out, size_t *found)
{
    *found = 0;
    for (size_t k = 0; k < l->count[2]; ++k)
        for (size_t j = 0; j < l->count[1]; ++j)
            for (size_t i = 0; i < l->count[0]; ++i)
            {
                pls_vec3 at;
                bool taken;
                PLS_TRY(is_taken(l, place(l, i, j, k), &at, &taken));
                if (taken && out) out[*found] = at;
                *found += taken;
            }
    return PLS_OK;
}

static pls_status take_all(const lattice *l, const pls_node *fill, pls_points *points)
{
    PLS_TRY(pls_node_context(take(l, NULL, &points->count), fill, "fill"));
    if (points->count == 0)
        return pls_node_fail(pls_node_get(fill, "spacing"),
                             l->where ? "take a smaller spacing, or another `where`" : "take a smaller spacing",
                             "no point of a lattice of %g m lies in the region '%s'%s", l->spacing, pls_scene_string(fill, "region", ""),
                             l->where ? " where `where` is true" : "");
    PLS_TRY(pls_allocate(&points->position, points->count, sizeof *points->position, "points of a continuum"));
    PLS_TRY(pls_allocate(&points->volume, points->count, sizeof *points->volume, "points of a continuum"));
    for (size_t k = 0; k < points->count; ++k) points->volume[k] = cell_volume(l);
    size_t count;
    return take(l, points->position, &count);
}

static pls_status begin_where(const pls_scene *scene, const pls_node *fill, lattice *l)
{
    const pls_node *where = pls_node_get(fill, "where");
    const char *names[PLS_EXPRESSION_VARIABLES];
    pls_symbols symbols;
    if (!where) return PLS_OK;
    PLS_TRY(pls_scene_symbols(scene, PLS_USES_PLACE, NULL, names, &symbols));
    PLS_TRY(pls_formula_make(&where->text, 1, &symbols, &l->where));
    return pls_formula_begin(l->where, &l->copy);
}

pls_status pls_points_fill(const pls_scene *scene, const pls_node *fill, pls_points *points)
{
    const pls_node *name = pls_node_get(fill, "region");
    int index;
    PLS_TRY(pls_scene_need_shape(scene, name, &index));
    PLS_TRY(pls_scene_check_turn(scene, fill));
    lattice l = {.shape = scene->shapes[index].made,
                 .hexagonal = strcmp(pls_scene_string(fill, "lattice", "cubic"), "hexagonal") == 0,
                 .dimension = scene->dimension,
                 .spacing = pls_scene_number(fill, "spacing", 0.0),
                 .position = pls_scene_vector(fill, "position"),
                 .turn = pls_scene_turn(scene, fill)};
    if (l.shape->ops->unbounded || l.shape->ops->wall)
        return pls_node_fail(name, "a region is a shape that a grain may have", "the %s '%s' has no inside that could be filled",
                             l.shape->ops->name, name->text);
    PLS_TRY(lay_out(&l, fill));
    pls_status status = begin_where(scene, fill, &l);
    if (status == PLS_OK) status = take_all(&l, fill, points);
    if (l.copy) pls_formula_end(l.where, l.copy);
    pls_formula_drop(l.where);
    return status;
}
