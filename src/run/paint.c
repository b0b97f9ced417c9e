// paint.c -- from the name of a field to a value for each body. See paint.h.

#include "run/paint.h"

#include "base/registry.h"
#include "scene/scene_data.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Short names for what is asked for most.
static const char *const aliases[][2] = {{"speed", "velocity"}, {"spin", "angular_velocity"}, {"id", "number"}};
enum { ALIAS_COUNT = sizeof aliases / sizeof *aliases, MOST_NAMES = 96 };
static const char energy[] = "energy", none[] = "none";
static const double same = 1e-9; ///< relative: values that differ by less do so by round-off

// ---- which field ------------------------------------------------------------------------------------------------------------------------

static bool is_wall_column(const char *name) { return strncmp(name, PLS_WALL_PREFIX, strlen(PLS_WALL_PREFIX)) == 0; }

/// A field that bodies have but this frame does not is another mistake than one that nobody knows.
static pls_status fail_unknown(const pls_frame *frame, const char *name)
{
    if (pls_field_find(PLS_TABLE_BODIES, name))
        return pls_fail(PLS_NOT_FOUND,
                        "the frame does not hold '%s': let the scene write it (observe: [{frames: vtk, fields: [%s], ...}]), or draw a "
                        "checkpoint, which holds all fields",
                        name, name);
    const char *names[MOST_NAMES];
    size_t count = 0;
    names[count++] = none;
    names[count++] = energy;
    for (size_t k = 0; k < ALIAS_COUNT; ++k) names[count++] = aliases[k][0];
    for (size_t k = 0; k < frame->count && count < MOST_NAMES; ++k)
    {
        if (!is_wall_column(frame->column[k].name)) names[count++] = frame->column[k].name;
    }
    char hint[1200];
    pls_scene_hint(hint, sizeof hint, name, "fields", names, count);
    return pls_fail(PLS_NOT_FOUND, "bodies have no field '%s' to be coloured by; %s", name, hint);
}

/// x, y, z (of a quaternion w, x, y, z) or a number; -1: none of them.
static int component_of(const char *text, int components)
{
    const char *letters = components == 4 ? "wxyz" : components <= 3 ? "xyz" : "";
    const char *found = text[0] && !text[1] ? strchr(letters, text[0]) : NULL;
    if (found && found - letters < components) return (int)(found - letters);
    char *end;
    long number = strtol(text, &end, 10);
    return end != text && !*end && number >= 0 && number < components ? (int)number : -1;
}

static pls_status choose_component(pls_paint *paint, const pls_frame_column *column, const char *text)
{
    paint->component = -1;
    if (!text) return PLS_OK;
    paint->component = component_of(text, column->components);
    if (paint->component >= 0) return PLS_OK;
    return pls_fail(PLS_NOT_FOUND, "'%s' has no component '%s': it has %d; write %s.x, or %s alone for its magnitude", column->name, text,
                    column->components, column->name, column->name);
}

/// Kinetic energy of translation and rotation: the moments are principal ones in the body's frame.
static pls_status choose_energy(pls_paint *paint, const pls_frame *frame)
{
    static const char *const needed[] = {"mass", "inertia", "velocity", "angular_velocity", "orientation"};
    for (size_t k = 0; k < sizeof needed / sizeof *needed; ++k)
    {
        if (!pls_frame_find(frame, needed[k])) return fail_unknown(frame, needed[k]);
    }
    paint->kinetic = true;
    paint->component = -1;
    paint->unit = "J";
    snprintf(paint->field, sizeof paint->field, "%s", energy);
    snprintf(paint->title, sizeof paint->title, "kinetic energy");
    return PLS_OK;
}

// ---- names ------------------------------------------------------------------------------------------------------------------------------

/// Whether the c-th shape of an entry makes bodies with a colour of their own.
static bool has_colour(const pls_scene *scene, const pls_scene_body *body, size_t c)
{
    const pls_shape_ops *ops = pls_scene_choice_shape(scene, body, c)->ops;
    return !ops->unbounded && !ops->wall;
}

static const char *group_name(const pls_scene *scene, size_t k)
{
    return has_colour(scene, &scene->bodies[k], 0) ? scene->bodies[k].name : NULL;
}

static const char *shape_name(const pls_scene *scene, size_t k)
{
    for (size_t b = 0; b < scene->body_count; ++b)
    {
        for (size_t c = 0; c < scene->bodies[b].choices; ++c)
        {
            if (scene->bodies[b].choice[c].shape == (int)k && has_colour(scene, &scene->bodies[b], c)) return scene->shapes[k].name;
        }
    }
    return NULL;
}

static const char *material_name(const pls_scene *scene, size_t k)
{
    for (size_t b = 0; b < scene->body_count; ++b)
    {
        if (scene->bodies[b].material == (int)k && has_colour(scene, &scene->bodies[b], 0)) return scene->materials[k].name;
    }
    return NULL;
}

/// Number the names that bounded bodies can have, in order of the scene (null: walls have none); ids begin at `first`.
static pls_status name_categories(pls_paint *paint, const pls_scene *scene, size_t count, size_t first,
                                  const char *(*name)(const pls_scene *scene, size_t k))
{
    paint->categorical = true;
    paint->id_count = first + count;
    PLS_TRY(pls_allocate(&paint->label, count, sizeof *paint->label, "the names in a picture"));
    PLS_TRY(pls_allocate(&paint->category, paint->id_count, sizeof *paint->category, "the names in a picture"));
    for (size_t k = 0; k < first; ++k) paint->category[k] = NAN;
    for (size_t k = 0; k < count; ++k)
    {
        const char *text = name(scene, k);
        paint->category[first + k] = text ? (double)paint->label_count : NAN;
        if (text) paint->label[paint->label_count++] = text;
    }
    paint->low = 0.0;
    paint->high = fmax((double)paint->label_count - 1.0, 1e-3); // a bar of one name is one colour
    return PLS_OK;
}

static pls_status name_field(pls_paint *paint, const pls_scene *scene)
{
    if (strcmp(paint->field, "group") == 0) return name_categories(paint, scene, scene->body_count, 1, group_name);
    if (strcmp(paint->field, "shape") == 0) return name_categories(paint, scene, scene->shape_count, 0, shape_name);
    if (strcmp(paint->field, "material") == 0) return name_categories(paint, scene, scene->material_count, 0, material_name);
    return PLS_OK;
}

// ---- choosing ---------------------------------------------------------------------------------------------------------------------------

/// What tells most: how a run moves; of a scene at its start, which entries there are, or else how large the bodies are.
static const char *usual(const pls_gallery *gallery, const pls_frame *frame)
{
    if (gallery->moment[0].kind != PLS_MOMENT_START) return "velocity";
    size_t groups = 0;
    for (size_t k = 0; k < gallery->scene->body_count; ++k) groups += group_name(gallery->scene, k) != NULL;
    const pls_frame_column *radius = pls_frame_find(frame, "radius");
    double low = INFINITY, high = 0.0;
    for (size_t k = 0; radius && k < radius->rows; ++k)
    {
        low = fmin(low, pls_frame_value(radius, k, 0));
        high = fmax(high, pls_frame_value(radius, k, 0));
    }
    return groups > 1 ? "group" : high > low * (1.0 + same) ? "radius" : none;
}

static pls_status choose_field(pls_paint *paint, const pls_gallery *gallery, const pls_frame *frame, const char *name,
                               const char *component)
{
    for (size_t k = 0; k < ALIAS_COUNT; ++k)
    {
        if (strcmp(name, aliases[k][0]) == 0) name = aliases[k][1];
    }
    const pls_frame_column *column = is_wall_column(name) ? NULL : pls_frame_find(frame, name);
    if (!column) return fail_unknown(frame, name);
    PLS_TRY(choose_component(paint, column, component));
    const pls_field *field = pls_field_find(PLS_TABLE_BODIES, name);
    paint->unit = field ? field->unit : "";
    snprintf(paint->field, sizeof paint->field, "%s", name);
    snprintf(paint->title, sizeof paint->title, "%.*s%s%.8s", PLS_NAME_SIZE, name, component ? "." : "", component ? component : "");
    for (char *c = paint->title; *c; ++c)
    {
        if (*c == '_') *c = ' ';
    }
    return name_field(paint, gallery->scene);
}

pls_status pls_paint_choose(pls_paint *paint, const pls_gallery *gallery, const pls_frame *frame, const char *colour)
{
    *paint = (pls_paint){.component = -1, .unit = "", .low = INFINITY, .high = -INFINITY};
    if (!colour) colour = usual(gallery, frame);
    if (strcmp(colour, none) == 0) return PLS_OK;
    if (strcmp(colour, energy) == 0) return choose_energy(paint, frame);
    char name[PLS_NAME_SIZE];
    const char *dot = strchr(colour, '.');
    snprintf(name, sizeof name, "%.*s", dot ? (int)(dot - colour) : (int)strlen(colour), colour);
    pls_status status = choose_field(paint, gallery, frame, name, dot ? dot + 1 : NULL);
    if (status != PLS_OK) pls_paint_free(paint);
    return status;
}

void pls_paint_free(pls_paint *paint)
{
    pls_release(&paint->label);
    pls_release(&paint->category);
    *paint = (pls_paint){0};
}

// ---- values -----------------------------------------------------------------------------------------------------------------------------

static double value_of(const pls_paint *paint, const pls_frame_column *column, size_t row)
{
    if (paint->categorical)
    {
        size_t id = (size_t)pls_frame_value(column, row, 0);
        return id < paint->id_count ? paint->category[id] : NAN;
    }
    if (paint->component >= 0) return pls_frame_value(column, row, paint->component);
    if (column->components == 1) return pls_frame_value(column, row, 0);
    double sum = 0.0;
    for (int c = 0; c < column->components; ++c) sum += pls_frame_value(column, row, c) * pls_frame_value(column, row, c);
    return sqrt(sum);
}

/// One half of m v^2 + w I w.
static double kinetic_energy(const pls_frame_column *const of[5], const pls_render_item *item, size_t row)
{
    pls_vec3 v = pls_frame_vector(of[2], row), w = pls_rotate_back(item->orientation, pls_frame_vector(of[3], row));
    pls_vec3 moments = pls_frame_vector(of[1], row);
    return 0.5 * (pls_frame_value(of[0], row, 0) * pls_dot(v, v) + moments.x * w.x * w.x + moments.y * w.y * w.y + moments.z * w.z * w.z);
}

static pls_status need(const pls_frame *frame, const char *name, const pls_frame_column **column)
{
    *column = pls_frame_find(frame, name);
    if (*column) return PLS_OK;
    return pls_fail(PLS_CORRUPT, "the frame at t = %g s does not hold '%s', though others of the run do", frame->time, name);
}

pls_status pls_paint_apply(const pls_paint *paint, const pls_frame *frame, pls_render_item *items)
{
    if (!paint->field[0]) return PLS_OK;
    const pls_frame_column *column = NULL, *of[5] = {0};
    if (paint->kinetic)
    {
        PLS_TRY(need(frame, "mass", &of[0]));
        PLS_TRY(need(frame, "inertia", &of[1]));
        PLS_TRY(need(frame, "velocity", &of[2]));
        PLS_TRY(need(frame, "angular_velocity", &of[3]));
        column = of[0];
    }
    else
        PLS_TRY(need(frame, paint->field, &column));
    for (size_t k = 0; k < column->rows; ++k)
    {
        if (items[k].shape->ops->wall) continue;
        items[k].value = paint->kinetic ? kinetic_energy(of, &items[k], k) : value_of(paint, column, k);
    }
    return PLS_OK;
}

void pls_paint_see(pls_paint *paint, const pls_render_item *items, size_t count)
{
    for (size_t k = 0; k < count && !paint->categorical; ++k)
    {
        if (items[k].opacity <= 0.0f || !isfinite(items[k].value)) continue;
        paint->low = fmin(paint->low, items[k].value);
        paint->high = fmax(paint->high, items[k].value);
    }
}

static bool is_magnitude(const pls_paint *paint)
{
    const pls_field *field = pls_field_find(PLS_TABLE_BODIES, paint->field);
    return paint->kinetic || (paint->component < 0 && field && field->components > 1);
}

void pls_paint_settle(pls_paint *paint)
{
    if (paint->categorical) return;
    if (paint->low > paint->high) paint->low = paint->high = 0.0;
    if (is_magnitude(paint)) paint->low = 0.0;
    if (paint->low < 0.0 && paint->high > 0.0)
    {
        paint->high = fmax(paint->high, -paint->low);
        paint->low = -paint->high;
    }
    double size = fmax(fabs(paint->low), fabs(paint->high));
    if (paint->high - paint->low > same * size) return;
    paint->low = fmin(paint->low, 0.0);
    paint->high = size == 0.0 ? 1.0 : fmax(paint->high, 0.0);
}

pls_render_colours pls_paint_map(const pls_paint *paint)
{
    if (paint->categorical) return PLS_RENDER_CATEGORICAL;
    return paint->low < 0.0 && paint->high > 0.0 ? PLS_RENDER_COOLWARM : PLS_RENDER_VIRIDIS;
}
