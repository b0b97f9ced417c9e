// generators.c -- regular arrangements of bodies, and what is drawn at random for the bodies of any arrangement: shapes and orientations.
//
// Draws are keyed by the seed and the number of the body within its entry, so they depend on nothing else.

#include "scene/generators.h"

#include "base/random.h"

#include <string.h>

enum { MOST_BODIES = 1000000000 };

void pls_points_free(pls_points *points)
{
    pls_release(&points->position);
    pls_release(&points->scale);
    pls_release(&points->velocity);
    pls_release(&points->angular_velocity);
    pls_release(&points->orientation);
    pls_release(&points->choice);
    pls_release(&points->volume);
    points->count = 0;
}

/// Bodies along each axis (1 along z in 2D) and room for all of them.
static pls_status read_counts(const pls_node *section, size_t count[3], pls_points *points)
{
    const pls_node *list = pls_node_get(section, "count");
    double all = 1.0;
    for (size_t k = 0; k < 3; ++k)
    {
        double number = k < list->count ? list->child[k]->number : 1.0;
        count[k] = (size_t)number;
        all *= number;
    }
    if (all > MOST_BODIES) return pls_node_fail(list, NULL, "%g bodies are more than this program can number (%d)", all, MOST_BODIES);
    points->count = (size_t)all;
    return pls_allocate(&points->position, points->count, sizeof *points->position, "places of bodies");
}

static pls_status make_lattice(const pls_scene *scene, const pls_node *section, double diameter, pls_points *points)
{
    size_t count[3];
    PLS_TRY(read_counts(section, count, points));
    double a = pls_scene_number(section, "spacing", diameter);
    pls_vec3 corner = pls_scene_vector(section, "corner");
    double z = scene->dimension == 3 ? a / 2.0 : 0.0;
    size_t n = 0;
    for (size_t k = 0; k < count[2]; ++k)
    {
        for (size_t j = 0; j < count[1]; ++j)
        {
            for (size_t i = 0; i < count[0]; ++i)
            {
                pls_vec3 place = pls_vec(a / 2.0 + a * (double)i, a / 2.0 + a * (double)j, z + a * (double)k);
                points->position[n++] = pls_add(corner, place);
            }
        }
    }
    return PLS_OK;
}

/// Layers of rows; each layer lies in the hollows of the one below. In 2D one layer.
static pls_status make_hex_pack(const pls_scene *scene, const pls_node *section, double diameter, pls_points *points)
{
    size_t count[3];
    PLS_TRY(read_counts(section, count, points));
    double R = pls_scene_number(section, "spacing", diameter) / 2.0;
    pls_vec3 corner = pls_scene_vector(section, "corner");
    double row = sqrt(3.0), layer = 2.0 * sqrt(6.0) / 3.0, z = scene->dimension == 3 ? R : 0.0;
    size_t n = 0;
    for (size_t k = 0; k < count[2]; ++k)
    {
        for (size_t j = 0; j < count[1]; ++j)
        {
            for (size_t i = 0; i < count[0]; ++i)
            {
                pls_vec3 place;
                place.x = R * (double)(2 * i + (j + k) % 2);
                place.y = R * row * ((double)j + (double)(k % 2) / 3.0);
                place.z = R * layer * (double)k;
                points->position[n++] = pls_add(pls_add(corner, pls_vec(R, R, z)), place);
            }
        }
    }
    return PLS_OK;
}

static pls_status make_points(const pls_node *list, pls_points *points)
{
    points->count = list->count;
    PLS_TRY(pls_allocate(&points->position, points->count, sizeof *points->position, "places of bodies"));
    for (size_t k = 0; k < list->count; ++k)
    {
        const pls_node *point = list->child[k];
        points->position[k] = pls_vec(point->child[0]->number, point->child[1]->number, point->count > 2 ? point->child[2]->number : 0.0);
    }
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------
// drawn at random

static uint64_t seed_of(const pls_scene_body *body)
{
    const pls_node *random = pls_node_get(pls_node_get(body->node, "place"), "random");
    return (uint64_t)pls_scene_number(body->node, "seed", pls_scene_number(random, "seed", 1.0));
}

size_t pls_points_choice(const pls_scene_body *body, size_t k)
{
    if (body->choices == 1) return 0;
    pls_random random = pls_random_stream(seed_of(body), k, PLS_FOR_SHAPE);
    double u = pls_random_uniform(&random);
    size_t c = 0;
    while (c + 1 < body->choices && u >= body->choice[c].up_to) ++c;
    return c;
}

const pls_scene_shape *pls_points_shape(const pls_scene *scene, const pls_scene_body *body, const pls_points *points, size_t k)
{
    return pls_scene_choice_shape(scene, body, points->choice ? points->choice[k] : 0);
}

double pls_points_radius(const pls_scene *scene, const pls_scene_body *body, size_t k)
{
    return pls_scene_choice_shape(scene, body, pls_points_choice(body, k))->made->radius;
}

/// Bounding radius of the largest shape.
static double largest_radius(const pls_scene *scene, const pls_scene_body *body)
{
    double radius = 0.0;
    for (size_t c = 0; c < body->choices; ++c) radius = fmax(radius, pls_scene_choice_shape(scene, body, c)->made->radius);
    return radius;
}

/// Uniform over all rotations (Shoemake, Graphics Gems III, 1992), in 2D over all angles.
static pls_quat draw_orientation(uint64_t seed, size_t k, int dimension)
{
    pls_random random = pls_random_stream(seed, k, PLS_FOR_ORIENTATION);
    double first = 2.0 * M_PI * pls_random_uniform(&random);
    if (dimension == 2) return (pls_quat){cos(first / 2.0), 0.0, 0.0, sin(first / 2.0)};
    double second = 2.0 * M_PI * pls_random_uniform(&random), u = pls_random_uniform(&random);
    double a = sqrt(1.0 - u), b = sqrt(u);
    return pls_quat_unit((pls_quat){b * cos(second), a * sin(first), a * cos(first), b * sin(second)});
}

static bool turns_at_random(const pls_scene_body *body)
{
    const pls_node *turn = pls_node_get(body->node, "orientation");
    return turn && turn->kind == PLS_NODE_SCALAR && strcmp(turn->text, "random") == 0;
}

/// What the arrangement itself did not tell.
static pls_status draw_rest(const pls_scene *scene, const pls_scene_body *body, pls_points *points)
{
    if (body->choices > 1)
    {
        PLS_TRY(pls_allocate(&points->choice, points->count, sizeof *points->choice, "shapes of bodies"));
        for (size_t k = 0; k < points->count; ++k) points->choice[k] = (uint32_t)pls_points_choice(body, k);
    }
    if (!turns_at_random(body) || points->orientation) return PLS_OK;
    PLS_TRY(pls_allocate(&points->orientation, points->count, sizeof *points->orientation, "orientations of bodies"));
    for (size_t k = 0; k < points->count; ++k) points->orientation[k] = draw_orientation(seed_of(body), k, scene->dimension);
    return PLS_OK;
}

// ---------------------------------------------------------------------------------------------------------------------------------------

static pls_status make_by_kind(const pls_scene *scene, const pls_scene_body *body, pls_points *points)
{
    const pls_node *place = pls_node_get(body->node, "place");
    const double diameter = 2.0 * largest_radius(scene, body) * pls_scene_number(body->node, "scale", 1.0);
    if (!place)
    {
        points->count = 1;
        PLS_TRY(pls_allocate(&points->position, 1, sizeof *points->position, "the place of a body"));
        points->position[0] = pls_scene_vector(body->node, "position");
        return PLS_OK;
    }
    const char *kind = place->key[0]->text;
    const pls_node *section = place->child[0];
    if (strcmp(kind, "lattice") == 0) return make_lattice(scene, section, diameter, points);
    if (strcmp(kind, "hex_pack") == 0) return make_hex_pack(scene, section, diameter, points);
    if (strcmp(kind, "random") == 0) return pls_points_random(scene, body, section, points);
    if (strcmp(kind, "fill") == 0) return pls_points_fill(scene, section, points);
    if (strcmp(kind, "csv") == 0) return pls_points_csv(scene, body, section, points);
    return make_points(section, points);
}

pls_status pls_points_make(const pls_scene *scene, const pls_scene_body *body, pls_points *points)
{
    *points = (pls_points){0};
    pls_status status = make_by_kind(scene, body, points);
    if (status == PLS_OK) status = draw_rest(scene, body, points);
    if (status != PLS_OK) pls_points_free(points);
    return status;
}
