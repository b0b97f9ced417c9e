// scene_file.h -- scenes from texts, for the tests of this room. Include <cmocka.h> first.
#ifndef PLS_TESTS_SCENE_SCENE_FILE_H
#define PLS_TESTS_SCENE_SCENE_FILE_H

#include "base/atomic_file.h"

#include <particls/scene.h>
#include <string.h>

/// Write `text` to a file in the working directory and load it with up to one override (may be null).
static inline pls_status load_text(const char *text, const char *override, pls_scene **scene)
{
    PLS_TRY(pls_write_file("test_scene.yaml", text, strlen(text)));
    return pls_scene_load("test_scene.yaml", &override, override ? 1 : 0, scene);
}

static inline pls_scene *must_load(const char *text)
{
    pls_scene *scene;
    if (load_text(text, NULL, &scene) != PLS_OK) fail_msg("%s", pls_last_message());
    return scene;
}

static inline pls_world *must_build(pls_scene *scene)
{
    pls_world *world;
    if (pls_scene_build(scene, &world) != PLS_OK) fail_msg("%s", pls_last_message());
    return world;
}

/// Component `c` of a field of the body with this number.
static inline double body_value(const pls_world *world, const char *field, size_t number, int c)
{
    pls_field_view view;
    size_t count;
    assert_int_equal(pls_world_body_field(world, field, &view), PLS_OK);
    const uint32_t *rows = pls_world_rows_by_number(world, &count);
    assert_true(number < count);
    return pls_field_value(&view, rows[number], c);
}

#define SCENE_HEAD "particls: 1\nmaterials: {grain: {density: 1000}}\nshapes: {ball: {sphere: {radius: 0.1}}, wall: {plane: {}}}\n"
#define SCENE_LAW  "contact:\n  - {between: all, law: elastic, kn: 1000}\n"

#endif
