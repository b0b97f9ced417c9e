// parse_bodies.c -- body entries and body forces: names looked up, and the checks that concern several keys.

#include "scene/scene_data.h"

#include <string.h>

static pls_status exclude(const pls_node *map, const char *a, const char *b)
{
    if (!pls_node_get(map, a) || !pls_node_get(map, b)) return PLS_OK;
    return pls_node_fail(pls_node_key(map, b), NULL, "'%s' and '%s' exclude each other", a, b);
}

static pls_status check_box(const pls_node *box)
{
    const pls_node *lower = pls_node_get(box, "lower"), *upper = pls_node_get(box, "upper");
    for (size_t k = 0; box && k < upper->count; ++k)
    {
        if (!(lower->child[k]->number < upper->child[k]->number))
            return pls_node_fail(upper->child[k], NULL, "the box's upper corner must lie above its lower corner along %c", "xyz"[k]);
    }
    return PLS_OK;
}

static pls_status check_distribution(const pls_node *radius)
{
    if (!radius || radius->kind != PLS_NODE_MAP) return PLS_OK;
    if (radius->count != 1)
        return pls_node_fail(radius, "(keys here: uniform, lognormal, power, table)", "'radius' must have exactly one key, not %zu",
                             radius->count);
    const pls_node *inner = radius->child[0];
    if (inner->kind == PLS_NODE_MAP)
    {
        double least = pls_scene_number(inner, "min", 0.0), most = pls_scene_number(inner, "max", 0.0);
        double median = pls_scene_number(inner, "median", least);
        if (!(least < most)) return pls_node_fail(pls_node_get(inner, "max"), NULL, "'max' must be greater than 'min'");
        if (median < least || median > most)
            return pls_node_fail(pls_node_get(inner, "median"), NULL, "'median' must lie between 'min' and 'max'");
    }
    double sum = 0.0;
    bool table = strcmp(radius->key[0]->text, "table") == 0;
    for (size_t k = 0; table && k < inner->count; ++k)
    {
        if (!(inner->child[k]->child[0]->number > 0.0))
            return pls_node_fail(inner->child[k]->child[0], NULL, "a radius must be greater than 0 m");
        sum += inner->child[k]->child[1]->number;
    }
    if (table && !(sum > 0.0)) return pls_node_fail(inner, NULL, "the fractions of the table add up to 0");
    return PLS_OK;
}

const pls_scene_shape *pls_scene_choice_shape(const pls_scene *scene, const pls_scene_body *body, size_t c)
{
    return &scene->shapes[body->choice[c].shape];
}

/// The name of the c-th shape of an entry, and how many shapes that are alike it stands for.
static const pls_node *choice_name(const pls_node *shape, size_t c, double *fraction)
{
    *fraction = shape->kind == PLS_NODE_MAP ? shape->child[c]->number : 1.0;
    return shape->kind == PLS_NODE_SCALAR ? shape : shape->kind == PLS_NODE_MAP ? shape->key[c] : shape->child[c];
}

static pls_status parse_choices(pls_scene *scene, pls_scene_body *body)
{
    const pls_node *node = pls_node_get(body->node, "shape");
    double sum = 0.0, fraction = 0.0;
    body->choices = node->kind == PLS_NODE_SCALAR ? 1 : node->count;
    PLS_TRY(pls_arena_allocate(&scene->arena, &body->choice, body->choices, sizeof *body->choice, "shapes of bodies"));
    for (size_t c = 0; c < body->choices; ++c)
    {
        const pls_node *name = choice_name(node, c, &fraction);
        PLS_TRY(pls_scene_need_shape(scene, name, &body->choice[c].shape));
        const pls_shape_ops *ops = pls_scene_choice_shape(scene, body, c)->ops;
        if (body->choices > 1 && (ops->unbounded || ops->wall))
            return pls_node_fail(name, "give it an entry of its own", "the %s '%s' is a wall and cannot be one of a mix of shapes",
                                 ops->name, name->text);
        sum += fraction;
        body->choice[c].up_to = sum;
    }
    for (size_t c = 0; c < body->choices; ++c) body->choice[c].up_to = c + 1 < body->choices ? body->choice[c].up_to / sum : 1.0;
    return PLS_OK;
}

/// Walls of finite size have no mass, so no force can move them.
static pls_status check_wall(const pls_scene_body *body, const pls_scene_shape *shape)
{
    const pls_node *motion = pls_node_get(body->node, "motion");
    const char *const vectors[] = {"velocity", "angular_velocity", "displacement"};
    if (!shape->ops->wall) return PLS_OK;
    if (!motion && !pls_scene_boolean(body->node, "fixed", false))
        return pls_node_fail(body->node, "write  fixed: true,  or give a `motion`",
                             "the %s '%s' has no mass, so the body '%s' must be fixed or driven", shape->ops->name, shape->name,
                             body->name);
    for (size_t k = 0; k < 3; ++k)
    {
        const pls_node *vector = pls_node_get(motion, vectors[k]);
        if (vector && vector->kind == PLS_NODE_SCALAR && strcmp(vector->text, "free") == 0)
            return pls_node_fail(vector, NULL, "the %s '%s' has no mass, so no axis of its motion can be free", shape->ops->name,
                                 shape->name);
        for (size_t c = 0; vector && c < vector->count; ++c)
        {
            if (vector->child[c]->kind == PLS_NODE_SCALAR && strcmp(vector->child[c]->text, "free") == 0)
                return pls_node_fail(vector->child[c], NULL, "the %s '%s' has no mass, so no axis of its motion can be free",
                                     shape->ops->name, shape->name);
        }
    }
    return PLS_OK;
}

static pls_status check_place(const pls_scene_body *body, const pls_scene_shape *shape)
{
    const pls_node *place = pls_node_get(body->node, "place");
    if (!place) return PLS_OK;
    if (shape->ops->unbounded)
        return pls_node_fail(place, "give `position`", "many bodies of the unbounded shape '%s' cannot be placed", shape->name);
    const pls_node *random = pls_node_get(place, "random"), *radius = pls_node_get(random, "radius");
    PLS_TRY(check_box(pls_node_get(random, "box")));
    PLS_TRY(check_distribution(radius));
    const pls_node *scale = pls_node_get(body->node, "scale");
    if (radius && scale->number != 1.0)
        return pls_node_fail(pls_node_key(body->node, "scale"), NULL, "'scale' and 'radius' exclude each other");
    return PLS_OK;
}

static pls_status check_motion(const pls_scene_body *body, bool unbounded)
{
    const pls_node *node = body->node, *motion = pls_node_get(node, "motion");
    bool fixed = pls_scene_boolean(node, "fixed", false);
    if (fixed && motion)
        return pls_node_fail(pls_node_key(node, "motion"), "remove `fixed` or `motion`", "a fixed body cannot have a motion");
    bool prescribed = fixed || motion || unbounded;
    const char *starts[] = {"velocity", "angular_velocity"};
    for (size_t k = 0; k < 2; ++k)
    {
        if (prescribed && pls_node_get(node, starts[k]))
            return pls_node_fail(pls_node_key(node, starts[k]), "give it under `motion`",
                                 "'%s' has no meaning for a body whose motion is prescribed", starts[k]);
    }
    if (!motion) return PLS_OK;
    if (motion->count == 0)
        return pls_node_fail(motion, "(keys here: velocity, angular_velocity, about, displacement)",
                             "'motion' is empty; write  fixed: true");
    PLS_TRY(exclude(motion, "velocity", "displacement"));
    PLS_TRY(exclude(motion, "displacement", "about"));
    if (pls_node_get(motion, "about") && !pls_node_get(motion, "angular_velocity"))
        return pls_node_fail(pls_node_key(motion, "about"), "give `angular_velocity`",
                             "'about' has a meaning only with 'angular_velocity'");
    return PLS_OK;
}

static pls_status check_direction(const pls_node *node, const char *key, const char *inner)
{
    const pls_node *vector = inner ? pls_node_get(pls_node_get(node, key), inner) : pls_node_get(node, key);
    if (!vector || vector->kind != PLS_NODE_LIST) return PLS_OK;
    double sum = 0.0;
    for (size_t k = 0; k < vector->count; ++k) sum += fabs(vector->child[k]->number);
    if (sum > 0.0) return PLS_OK;
    return pls_node_fail(vector, NULL, "'%s' must not be zero", inner ? inner : key);
}

pls_status pls_scene_check_turn(const pls_scene *scene, const pls_node *map)
{
    PLS_TRY(check_direction(map, "orientation", NULL));
    PLS_TRY(check_direction(map, "orientation", "axis"));
    const pls_node *turn = pls_node_get(map, "orientation");
    if (scene->dimension == 3 && turn && turn->kind == PLS_NODE_MAP && !pls_node_get(turn, "axis"))
        return pls_node_fail(turn, "for example  {axis: [0, 0, 1], angle: 0.5}", "missing key 'axis' in 'orientation'");
    return PLS_OK;
}

static pls_status check_mass(const pls_scene *scene, const pls_scene_body *body, bool massless)
{
    const pls_node *material = scene->materials[body->material].node;
    if (massless || pls_node_get(material, "density") || pls_node_get(body->node, "mass")) return PLS_OK;
    return pls_node_fail(pls_node_get(body->node, "material"), "give the material a density, or the body a mass",
                         "the material '%s' has no density, which the body '%s' needs for its mass", scene->materials[body->material].name,
                         body->name);
}

/// A half-space that would end where the periodic box repeats.
static pls_status check_periodic(const pls_scene *scene, const pls_scene_body *body)
{
    const pls_node *periodic = pls_node_get(pls_node_get(scene->root, "domain"), "periodic"), *normal = pls_node_get(body->node, "normal");
    if (!periodic || !normal || !pls_scene_choice_shape(scene, body, 0)->ops->unbounded) return PLS_OK;
    for (size_t k = 0; k < periodic->count; ++k)
    {
        if (strcmp(periodic->child[k]->text, "true") == 0 && normal->child[k]->number != 0.0)
            return pls_node_fail(normal->child[k], "walls of a periodic box stand along its periodic axes",
                                 "the normal of '%s' has a component along the periodic axis %c", body->name, "xyz"[k]);
    }
    return PLS_OK;
}

static pls_status parse_body(pls_scene *scene, const pls_node *node, size_t k)
{
    pls_scene_body *body = &scene->bodies[k];
    *body = (pls_scene_body){.node = node, .name = pls_scene_string(node, "name", NULL)};
    if (!body->name) PLS_TRY(pls_arena_print(&scene->arena, &body->name, "body_%zu", k + 1));
    const pls_node *at = pls_node_get(node, "name") ? pls_node_get(node, "name") : node;
    if (strcmp(body->name, "all") == 0 || strcmp(body->name, "world") == 0)
        return pls_node_fail(at, NULL, "'%s' has a meaning of its own and cannot name a body", body->name);
    if (pls_scene_find_body(scene, body->name) >= 0)
        return pls_node_fail(at, "give one of them another name", "there is a body entry '%s' already", body->name);
    PLS_TRY(parse_choices(scene, body));
    PLS_TRY(pls_scene_need_material(scene, pls_node_get(node, "material"), &body->material));

    const pls_scene_shape *shape = pls_scene_choice_shape(scene, body, 0);
    const bool unbounded = shape->ops->unbounded, massless = unbounded || shape->ops->wall;
    PLS_TRY(exclude(node, "place", "position"));
    PLS_TRY(exclude(node, "orientation", "normal"));
    if (!pls_node_get(node, "place") && !pls_node_get(node, "position"))
        return pls_node_fail(node, "give `position` for one body or `place` for many", "the body '%s' has neither 'position' nor 'place'",
                             body->name);
    PLS_TRY(check_wall(body, shape));
    PLS_TRY(check_place(body, shape));
    PLS_TRY(check_motion(body, unbounded));
    PLS_TRY(check_direction(node, "normal", NULL));
    PLS_TRY(check_periodic(scene, body));
    PLS_TRY(pls_scene_check_turn(scene, node));
    const char *only_bounded[] = {"mass", "inertia"};
    for (size_t j = 0; j < 2; ++j)
    {
        if (massless && pls_node_get(node, only_bounded[j]))
            return pls_node_fail(pls_node_key(node, only_bounded[j]), NULL, "the %s '%s' has no %s",
                                 unbounded ? "unbounded shape" : shape->ops->name, shape->name, only_bounded[j]);
    }
    PLS_TRY(check_mass(scene, body, massless));
    ++scene->body_count;
    return PLS_OK;
}

pls_status pls_scene_parse_bodies(pls_scene *scene)
{
    const pls_node *list = pls_node_get(scene->root, "bodies");
    PLS_TRY(pls_arena_allocate(&scene->arena, &scene->bodies, list->count, sizeof *scene->bodies, "bodies"));
    for (size_t k = 0; k < list->count; ++k) PLS_TRY(parse_body(scene, list->child[k], k));
    return PLS_OK;
}

pls_status pls_scene_parse_forces(pls_scene *scene)
{
    const pls_node *list = pls_node_get(scene->root, "forces");
    for (size_t k = 0; list && k < list->count; ++k)
    {
        const pls_node *map = pls_node_get(list->child[k], "field");
        if (map)
        {
            PLS_TRY(exclude(map, "force", "acceleration"));
            PLS_TRY(exclude(map, "force", "density"));
            PLS_TRY(exclude(map, "acceleration", "density"));
            if (!pls_node_get(map, "force") && !pls_node_get(map, "acceleration") && !pls_node_get(map, "density"))
                return pls_node_fail(map, "give one of them", "the field has neither 'force' nor 'acceleration' nor 'density'");
        }
        else if ((map = pls_node_get(list->child[k], "traction")) || (map = pls_node_get(list->child[k], "pressure")))
        {
            const pls_node *normal = pls_node_get(map, "normal");
            if (normal && !(pls_length(pls_scene_vector(map, "normal")) > 0.0))
                return pls_node_fail(normal, NULL, "'normal' must not be zero");
        }
        else if (!pls_scene_named_operations(&scene->force_ops, list->child[k], &map))
            continue;
        const pls_node *group = pls_node_get(map, "bodies");
        int index;
        if (strcmp(group->text, "all") != 0) PLS_TRY(pls_scene_need_body(scene, group, &index));
    }
    return PLS_OK;
}
