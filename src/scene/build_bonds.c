// build_bonds.c -- sets of bonds of a scene, and the cracks they begin with.

#include "scene/build.h"

#include <string.h>

/// A user's influence function while the set is made.
typedef struct influence
{
    pls_formula *formula;
    pls_formula_copy *copy;
} influence;

/// Where the expression has no value it is NaN, which is refused.
static double weight_of(void *context, double xi)
{
    const influence *f = context;
    double value;
#pragma omp critical(pls_influence) // threads share the one compiled copy
    if (pls_formula_values(f->formula, f->copy, &xi, &value) != PLS_OK) value = NAN;
    return value;
}

static pls_status take_influence(const pls_builder *b, const pls_node *node, influence *f, pls_bonds_def *def)
{
    static const struct
    {
        const char *word;
        pls_influence influence;
    } known[] = {{"inverse", PLS_INFLUENCE_INVERSE},
                 {"one", PLS_INFLUENCE_ONE},
                 {"conical", PLS_INFLUENCE_CONICAL},
                 {"gaussian", PLS_INFLUENCE_GAUSSIAN}};
    for (size_t k = 0; node && !node->numeric && !node->formula && k < sizeof known / sizeof *known; ++k)
        if (strcmp(known[k].word, node->text) == 0)
        {
            def->influence = known[k].influence;
            return PLS_OK;
        }
    if (!node) return PLS_OK;
    char number[32];
    const char *names[PLS_EXPRESSION_VARIABLES], *text = node->numeric ? pls_format_double(number, node->number) : node->text;
    pls_symbols symbols;
    PLS_TRY(pls_scene_symbols(b->scene, PLS_USES_RADIUS, NULL, names, &symbols));
    PLS_TRY(pls_formula_make(&text, 1, &symbols, &f->formula));
    PLS_TRY(pls_formula_begin(f->formula, &f->copy));
    def->influence = PLS_INFLUENCE_FUNCTION;
    def->weight = weight_of;
    def->context = f;
    return PLS_OK;
}

static void take_spacing(const pls_node *node, pls_bonds_def *def)
{
    if (!node) return;
    if (node->numeric)
        def->spacing = node->number;
    else
        def->spacing = strcmp(node->text, "none") == 0 ? -1.0 : 0.0;
}

/// One convex polygon, as a fan of triangles; in 2D a line through the points. Adds to `total` how many bonds it cut.
static pls_status cut(const pls_builder *b, pls_bonds_id id, const pls_vec3 *point, size_t count, size_t *total)
{
    const bool flat = b->scene->dimension == 2;
    for (size_t k = flat ? 0 : 1; k + 1 < count; ++k)
    {
        size_t bonds;
        PLS_TRY(pls_world_cut_bonds(b->world, id, flat ? point[k] : point[0], flat ? point[k + 1] : point[k],
                                    flat ? point[k] : point[k + 1], &bonds));
        *total += bonds;
    }
    return PLS_OK;
}

static pls_status cut_along_points(const pls_builder *b, pls_bonds_id id, const pls_node *list, size_t *total)
{
    pls_vec3 *point = NULL;
    PLS_TRY(pls_allocate(&point, list->count, sizeof *point, "points of a crack"));
    for (size_t k = 0; k < list->count; ++k)
    {
        const pls_node *p = list->child[k];
        point[k] = pls_vec(p->child[0]->number, p->child[1]->number, p->count > 2 ? p->child[2]->number : 0.0);
    }
    const pls_status status = cut(b, id, point, list->count, total);
    pls_release(&point);
    return status;
}

/// A disc as a polygon of the same area.
static pls_status cut_disc(const pls_builder *b, pls_bonds_id id, const pls_node *crack, size_t *total)
{
    enum { CORNERS = 96 };
    const pls_vec3 n = pls_unit(pls_scene_vector(crack, "normal")), centre = pls_scene_vector(crack, "centre");
    const pls_vec3 u = pls_unit(pls_cross(n, fabs(n.x) < 0.6 ? pls_vec(1, 0, 0) : pls_vec(0, 1, 0))), v = pls_cross(n, u);
    const double turn = 2.0 * M_PI / CORNERS, radius = pls_scene_number(crack, "radius", 0.0) * sqrt(turn / sin(turn));
    pls_vec3 corner[CORNERS];
    for (int k = 0; k < CORNERS; ++k)
        corner[k] = pls_add(centre, pls_add(pls_scale(u, radius * cos(turn * k)), pls_scale(v, radius * sin(turn * k))));
    return cut(b, id, corner, CORNERS, total);
}

static pls_status cut_cracks(const pls_builder *b, pls_bonds_id id, const pls_node *cracks)
{
    for (size_t k = 0; cracks && k < cracks->count; ++k)
    {
        const pls_node *crack = cracks->child[k], *points = pls_node_get(crack, "points");
        size_t total = 0;
        pls_status status = points ? cut_along_points(b, id, points, &total) : cut_disc(b, id, crack, &total);
        PLS_TRY(pls_node_context(status, crack, "crack"));
        if (total == 0)
            return pls_node_fail(crack, "places are those of the world [m]", "the crack cuts no bond that another one has not cut");
    }
    return PLS_OK;
}

static pls_status add(const pls_builder *b, const pls_scene_bonds *bonds, pls_group_id *group, influence *f)
{
    const pls_node *node = bonds->node;
    const char *correction = pls_scene_string(node, "correction", "none");
    pls_bonds_def def = pls_default_bonds_def();
    double values[PLS_MAX_VALUES];
    memcpy(def.name, bonds->name, strlen(bonds->name) + 1);
    for (size_t k = 0; k < bonds->of_count; ++k) group[k] = b->groups[bonds->of[k]];
    pls_scene_parameters(bonds->ops->parameters, node, values);
    def.ops = bonds->ops;
    def.values = values;
    def.group = group;
    def.group_count = bonds->of_count;
    def.horizon = pls_scene_number(node, "horizon", 0.0);
    def.correction = strcmp(correction, "volume") == 0   ? PLS_CORRECTION_VOLUME
                     : strcmp(correction, "energy") == 0 ? PLS_CORRECTION_ENERGY
                                                         : PLS_CORRECTION_NONE;
    def.plane = strcmp(pls_scene_string(node, "plane", "strain"), "stress") == 0 ? PLS_PLANE_STRESS : PLS_PLANE_STRAIN;
    def.critical_stretch = pls_scene_number(node, "critical_stretch", INFINITY);
    def.fracture_energy = pls_scene_number(node, "fracture_energy", NAN);
    take_spacing(pls_node_get(node, "spacing"), &def);
    PLS_TRY(take_influence(b, pls_node_get(node, "influence"), f, &def));
    if (strcmp(pls_scene_string(node, "criterion", "stretch"), "energy") == 0) def.fracture = PLS_FRACTURE_ENERGY;
    PLS_TRY(pls_build_points(b, node, &def));
    pls_bonds_id id;
    PLS_TRY(pls_node_context(pls_world_add_bonds(b->world, &def, &id), node, "%s", "")); // the message names the bonds
    return cut_cracks(b, id, pls_node_get(node, "cracks"));
}

pls_status pls_build_bonds(const pls_builder *b)
{
    for (size_t k = 0; k < b->scene->bonds_count; ++k)
    {
        influence f = {0};
        pls_group_id *group = NULL;
        pls_status status = pls_allocate(&group, b->scene->bonds[k].of_count, sizeof *group, "bonds");
        if (status == PLS_OK) status = add(b, &b->scene->bonds[k], group, &f);
        pls_release(&group);
        if (f.copy) pls_formula_end(f.formula, f.copy);
        pls_formula_drop(f.formula);
        PLS_TRY(status);
    }
    return PLS_OK;
}
