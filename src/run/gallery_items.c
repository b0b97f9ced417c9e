// gallery_items.c -- the bodies and walls of a frame as things to be drawn, with the shapes of the scene.

#include "run/gallery.h"

#include "base/registry.h"
#include "scene/scene_data.h"

#include <stdio.h>
#include <string.h>

/// The columns of bodies, or of walls, that a picture needs.
typedef struct columns
{
    const pls_frame_column *shape, *position, *orientation, *scale, *group;
} columns;

static pls_status find_column(const pls_frame *frame, const char *prefix, const char *name, int components, const pls_frame_column **column)
{
    char full[2 * PLS_NAME_SIZE];
    snprintf(full, sizeof full, "%s%s", prefix, name);
    *column = pls_frame_find(frame, full);
    if (*column && (*column)->components == components) return PLS_OK;
    return pls_fail(
        PLS_NOT_FOUND,
        "the frame does not hold '%s', without which it cannot be drawn: it was written by another version; draw a checkpoint of "
        "the run instead, or run again",
        full);
}

static pls_status find_columns(const pls_frame *frame, const char *prefix, columns *c)
{
    PLS_TRY(find_column(frame, prefix, "shape", 1, &c->shape));
    PLS_TRY(find_column(frame, prefix, "position", 3, &c->position));
    PLS_TRY(find_column(frame, prefix, "orientation", 4, &c->orientation));
    PLS_TRY(find_column(frame, prefix, "scale", 1, &c->scale));
    return find_column(frame, prefix, "group", 1, &c->group);
}

static bool is_wall(const pls_shape *shape) { return shape->ops->unbounded || shape->ops->wall; }

/// `hidden`: a flag for each entry of the scene; groups are numbered by entries, from one.
static pls_status make_item(const pls_scene *scene, const columns *c, size_t row, const pls_gallery_look *look, const bool *hidden,
                            pls_render_item *item)
{
    size_t shape = (size_t)pls_frame_value(c->shape, row, 0), group = (size_t)pls_frame_value(c->group, row, 0);
    if (shape >= scene->shape_count || !scene->shapes[shape].made)
        return pls_fail(PLS_CORRUPT, "a body of the frame has shape %zu, but scene.used.yaml has %zu shapes: they belong to different runs",
                        shape, scene->shape_count);
    *item = (pls_render_item){.shape = scene->shapes[shape].made,
                              .position = pls_frame_vector(c->position, row),
                              .scale = pls_frame_value(c->scale, row, 0),
                              .value = NAN,
                              .opacity = 1.0f};
    item->orientation = (pls_quat){pls_frame_value(c->orientation, row, 0), pls_frame_value(c->orientation, row, 1),
                                   pls_frame_value(c->orientation, row, 2), pls_frame_value(c->orientation, row, 3)};
    if (is_wall(item->shape)) item->opacity = look->wall_opacity;
    if (group >= 1 && group <= scene->body_count && hidden[group - 1]) item->opacity = 0.0f;
    return PLS_OK;
}

static pls_status mark_hidden(const pls_scene *scene, const pls_gallery_look *look, bool *hidden)
{
    for (size_t k = 0; k < look->hide_count; ++k)
    {
        int entry = pls_scene_find_body(scene, look->hide[k]);
        if (entry >= 0)
        {
            hidden[entry] = true;
            continue;
        }
        const char *names[64];
        size_t count = scene->body_count < 64 ? scene->body_count : 64;
        for (size_t b = 0; b < count; ++b) names[b] = scene->bodies[b].name;
        char hint[400];
        pls_scene_hint(hint, sizeof hint, look->hide[k], "entries", names, count);
        return pls_fail(PLS_NOT_FOUND, "there is no entry '%s' in the scene to be hidden; %s", look->hide[k], hint);
    }
    return PLS_OK;
}

static pls_status fill(const pls_gallery *gallery, const pls_frame *frame, const pls_gallery_look *look, const bool *hidden,
                       pls_render_item *items, size_t bodies, size_t walls)
{
    columns c;
    if (bodies > 0) PLS_TRY(find_columns(frame, "", &c));
    for (size_t k = 0; k < bodies; ++k) PLS_TRY(make_item(gallery->scene, &c, k, look, hidden, &items[k]));
    if (walls > 0) PLS_TRY(find_columns(frame, PLS_WALL_PREFIX, &c));
    for (size_t k = 0; k < walls; ++k) PLS_TRY(make_item(gallery->scene, &c, k, look, hidden, &items[bodies + k]));
    return PLS_OK;
}

static size_t rows_of(const pls_frame *frame, const char *name)
{
    const pls_frame_column *column = pls_frame_find(frame, name);
    return column ? column->rows : 0;
}

pls_status pls_gallery_items(const pls_gallery *gallery, const pls_frame *frame, const pls_gallery_look *look, pls_render_item **items,
                             size_t *count)
{
    size_t bodies = rows_of(frame, "position"), walls = rows_of(frame, PLS_WALL_PREFIX "position");
    bool *hidden = NULL;
    *count = bodies + walls;
    pls_status status = pls_allocate(items, *count, sizeof **items, "the bodies of a picture");
    if (status == PLS_OK) status = pls_allocate(&hidden, gallery->scene->body_count, sizeof *hidden, "the bodies of a picture");
    if (status == PLS_OK) status = mark_hidden(gallery->scene, look, hidden);
    if (status == PLS_OK) status = fill(gallery, frame, look, hidden, *items, bodies, walls);
    pls_release(&hidden);
    if (status != PLS_OK) pls_release(items);
    return status;
}
