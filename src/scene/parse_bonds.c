// parse_bonds.c -- bonds: names looked up, and the checks that concern several keys.

#include "scene/scene_data.h"

#include <string.h>

/// Bonds are made with the moduli of the start and keep them.
static pls_status check_moduli(const pls_scene *scene, int entry)
{
    static const char *const moduli[] = {"young_modulus", "poisson_ratio"};
    const pls_scene_material *material = &scene->materials[scene->bodies[entry].material];
    for (size_t k = 0; k < 2; ++k)
    {
        const pls_node *node = pls_node_get(material->node, moduli[k]);
        if (node && node->formula)
            return pls_node_fail(node, "give a number; `stiffness` of bonds may change in time",
                                 "'%s' of material '%s' changes in time, which bonds of its bodies do not follow", moduli[k],
                                 material->name);
    }
    return PLS_OK;
}

static pls_status check_entry(const pls_scene *scene, const pls_node *at, int entry)
{
    const pls_scene_shape *shape = pls_scene_choice_shape(scene, &scene->bodies[entry], 0);
    if (!shape->ops->unbounded && !shape->ops->wall) return PLS_OK;
    return pls_node_fail(at, "bonds join bodies that have a mass", "the body '%s' is a wall (%s) and has no bonds",
                         scene->bodies[entry].name, shape->ops->name);
}

static pls_status parse_of(pls_scene *scene, pls_scene_bonds *bonds)
{
    const pls_node *of = pls_node_get(bonds->node, "of");
    const bool all = of->kind == PLS_NODE_SCALAR;
    const size_t most = all ? scene->body_count : of->count;
    PLS_TRY(pls_arena_allocate(&scene->arena, &bonds->of, most, sizeof *bonds->of, "bonds"));
    for (size_t k = 0; k < most; ++k)
    {
        int entry = (int)k;
        const pls_shape_ops *ops = all ? pls_scene_choice_shape(scene, &scene->bodies[k], 0)->ops : NULL;
        if (ops && (ops->unbounded || ops->wall)) continue;
        if (!all) PLS_TRY(pls_scene_need_body(scene, of->child[k], &entry));
        if (!all) PLS_TRY(check_entry(scene, of->child[k], entry));
        PLS_TRY(check_moduli(scene, entry));
        for (size_t j = 0; j < bonds->of_count; ++j)
            if (bonds->of[j] == entry) return pls_node_fail(of->child[k], NULL, "'%s' is listed twice", of->child[k]->text);
        bonds->of[bonds->of_count++] = entry;
    }
    return bonds->of_count > 0 ? PLS_OK : pls_node_fail(of, NULL, "there is no body that could have bonds");
}

static pls_vec3 corner_of(const pls_node *points, size_t k)
{
    const pls_node *p = points->child[k % points->count];
    return pls_vec(p->child[0]->number, p->child[1]->number, p->child[2]->number);
}

/// Corners of a flat, convex polygon in order: every one turns the same way.
static pls_status check_polygon(const pls_node *points)
{
    pls_vec3 normal = pls_vec(0.0, 0.0, 0.0);
    double size = 0.0;
    for (size_t k = 0; k < points->count; ++k)
    {
        const pls_vec3 u = pls_sub(corner_of(points, k), corner_of(points, 0)), v = pls_sub(corner_of(points, k + 1), corner_of(points, 0));
        normal = pls_add(normal, pls_cross(u, v));
        size = fmax(size, pls_length(u));
    }
    if (points->count >= 3 && !(pls_length(normal) > 1e-9 * size * size))
        return pls_node_fail(points, NULL, "the corners of the crack lie on a line");
    normal = pls_unit(normal);
    for (size_t k = 0; points->count >= 3 && k < points->count; ++k)
    {
        const pls_vec3 a = corner_of(points, k), b = corner_of(points, k + 1), c = corner_of(points, k + 2);
        if (fabs(pls_dot(pls_sub(a, corner_of(points, 0)), normal)) > 1e-6 * size)
            return pls_node_fail(points->child[k], NULL, "the corners of the crack do not lie in a plane");
        const pls_vec3 fan = pls_cross(pls_sub(a, corner_of(points, 0)), pls_sub(b, corner_of(points, 0))); // turns back where edges cross
        if (pls_dot(pls_cross(pls_sub(b, a), pls_sub(c, b)), normal) < -1e-9 * size * size || pls_dot(fan, normal) < -1e-9 * size * size)
            return pls_node_fail(points->child[(k + 1) % points->count], "cut it into convex ones", "the crack is not convex here");
    }
    return PLS_OK;
}

static pls_status check_crack(const pls_scene *scene, const pls_node *crack)
{
    static const char *const of_disc[] = {"centre", "normal", "radius"};
    const pls_node *points = pls_node_get(crack, "points");
    const size_t least = scene->dimension == 2 ? 2 : 3;
    for (size_t k = 0; k < 3; ++k)
    {
        const pls_node *node = pls_node_get(crack, of_disc[k]);
        if (node && scene->dimension == 2)
            return pls_node_fail(pls_node_key(crack, of_disc[k]), "give `points`", "a disc is a crack of 3D");
        if (node && points) return pls_node_fail(pls_node_key(crack, of_disc[k]), NULL, "'points' and '%s' exclude each other", of_disc[k]);
        if (!node && !points)
            return pls_node_fail(
                crack, scene->dimension == 2 ? "points: [[x, y], [x, y]]" : "points: [[x, y, z], ...]  or  centre, normal and radius",
                "the crack has neither 'points' nor '%s'", of_disc[k]);
    }
    if (points && scene->dimension == 3) PLS_TRY(check_polygon(points));
    if (points && points->count < least)
        return pls_node_fail(points, NULL, "a crack has at least %zu points, not %zu", least, points->count);
    const pls_node *normal = pls_node_get(crack, "normal");
    if (normal && !(pls_length(pls_scene_vector(crack, "normal")) > 0.0)) return pls_node_fail(normal, NULL, "'normal' must not be zero");
    return PLS_OK;
}

static pls_status parse_bonds(pls_scene *scene, const pls_node *node, size_t k)
{
    pls_scene_bonds *bonds = &scene->bonds[k];
    *bonds = (pls_scene_bonds){.node = node, .name = pls_scene_string(node, "name", NULL)};
    if (!bonds->name) PLS_TRY(pls_arena_print(&scene->arena, &bonds->name, "bonds_%zu", k + 1));
    for (size_t j = 0; j < k; ++j)
        if (strcmp(scene->bonds[j].name, bonds->name) == 0)
            return pls_node_fail(node, "give one of them another name", "there are bonds '%s' already", bonds->name);
    bonds->ops = pls_registry_find(&scene->bond_ops, pls_node_get(node, "law")->text);
    PLS_TRY(parse_of(scene, bonds));
    if (pls_node_get(node, "critical_stretch") && pls_node_get(node, "fracture_energy"))
        return pls_node_fail(pls_node_key(node, "fracture_energy"), NULL, "'critical_stretch' and 'fracture_energy' exclude each other");
    if (strcmp(pls_scene_string(node, "criterion", "stretch"), "energy") == 0 && !pls_node_get(node, "fracture_energy"))
        return pls_node_fail(pls_node_key(node, "criterion"), "give fracture_energy [J/m^2]",
                             "the criterion 'energy' needs 'fracture_energy'");
    const pls_node *cracks = pls_node_get(node, "cracks");
    for (size_t c = 0; cracks && c < cracks->count; ++c) PLS_TRY(check_crack(scene, cracks->child[c]));
    ++scene->bonds_count;
    return PLS_OK;
}

pls_status pls_scene_parse_bonds(pls_scene *scene)
{
    const pls_node *list = pls_node_get(scene->root, "bonds");
    if (!list) return PLS_OK;
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->bonds, list->count, sizeof *scene->bonds, "bonds"));
    for (size_t k = 0; k < list->count; ++k) PLS_TRY(parse_bonds(scene, list->child[k], k));
    return PLS_OK;
}
