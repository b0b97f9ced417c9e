// test_gallery.c -- from a scene to what is drawn: each kind of shape has the silhouette that geometry gives it, and the camera shows all bodies beside the bar.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/atomic_file.h"
#include "run/gallery.h"
#include "run/paint.h"
#include "support/failing_allocator.h"

#include <stdio.h>
#include <string.h>

static void must(pls_status status)
{
    if (status != PLS_OK) print_error("%s\n", pls_last_message());
    assert_int_equal(status, PLS_OK);
}

static const char mesh_text[] = "v 0 0 0\nv 0.4 0 0\nv 0.4 0.6 0\nv 0 0.6 0\nf 1 2 3\nf 1 3 4\n";

static const char scene_text[] =
    "particls: 1\n"
    "materials: {grain: {density: 1000}}\n"
    "shapes:\n"
    "  ball: {sphere: {radius: 0.2}}\n"
    "  brick: {box: {half: [0.3, 0.2, 0.1]}}\n"
    "  cube: {polyhedron: {points: [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [-1, -1, 1], [1, 1, -1], [-1, 1, -1], [1, -1, -1], [-1, -1, -1]]}}\n"
    "  egg: {ellipsoid: {half: [0.3, 0.2, 0.4]}}\n"
    "  rod: {capsule: {radius: 0.1, length: 0.4}}\n"
    "  pair: {compound: {parts: [{shape: ball, position: [0.7, 0, 0]}, {shape: rod, position: [0, 0, 0], orientation: {axis: [0, 0, 1], "
    "angle: 0.5}}]}}\n"
    "  sheet: {mesh: {path: sheet.obj}}\n"
    "bodies:\n"
    "  - {name: a, shape: ball, material: grain, position: [0, 0, 0], scale: 2}\n"
    "  - {name: b, shape: brick, material: grain, position: [3, 0, 0], orientation: {axis: [0, 0, 1], angle: 0.4}}\n"
    "  - {name: c, shape: cube, material: grain, position: [6, 0, 0], scale: 0.25}\n"
    "  - {name: d, shape: egg, material: grain, position: [9, 0, 0], orientation: {axis: [0, 0, 1], angle: 1}}\n"
    "  - {name: e, shape: rod, material: grain, position: [12, 0, 0]}\n"
    "  - {name: f, shape: pair, material: grain, position: [15, 0, 0]}\n"
    "  - {name: g, shape: sheet, material: grain, position: [18, 0, 0], fixed: true}\n"
    "contact: [{between: all, law: elastic, kn: 10000}]\n"
    "time: {end: 1, dt: 1.0e-5}\n";

static void write_scene(void)
{
    must(pls_write_file("sheet.obj", mesh_text, strlen(mesh_text)));
    must(pls_write_file("scene.yaml", scene_text, strlen(scene_text)));
}

typedef struct drawn
{
    pls_gallery gallery;
    pls_frame frame;
    pls_render_item *items;
    size_t count;
} drawn;

static void free_drawn(drawn *d)
{
    pls_release(&d->items);
    pls_frame_free(&d->frame);
    pls_gallery_free(&d->gallery);
}

static pls_status open_drawn(drawn *d)
{
    *d = (drawn){0};
    const pls_gallery_look look = {.wall_opacity = 1.0f};
    pls_status status = pls_gallery_open(&d->gallery, "scene.yaml", &(pls_gallery_def){0});
    if (status == PLS_OK) status = pls_gallery_load(&d->gallery, 0, &d->frame);
    if (status == PLS_OK) status = pls_gallery_items(&d->gallery, &d->frame, &look, &d->items, &d->count);
    if (status != PLS_OK) free_drawn(d);
    return status;
}

enum { PIXELS = 400 };

/// The area [m^2] that one item covers in a picture along `look`, of 2 m around `target`.
static double area_of(const pls_render_item *item, pls_vec3 target, pls_vec3 look, const pls_render_options *more)
{
    pls_render_options options = more ? *more : pls_render_defaults();
    options.width = options.height = PIXELS;
    options.bar = false;
    memset(options.background, 0, 4);
    bool along_z = look.z != 0.0;
    pls_render_camera camera = {pls_sub(target, pls_scale(look, 5.0)), target, along_z ? pls_vec(0, 1, 0) : pls_vec(0, 0, 1), 0.0, 2.0};
    pls_render_picture picture;
    must(pls_render_image(item, 1, &camera, &options, &picture));
    double area = 0.0;
    for (int k = 0; k < PIXELS * PIXELS; ++k) area += picture.rgba[4 * k + 3] / 255.0;
    pls_render_picture_free(&picture);
    return area * (2.0 / PIXELS) * (2.0 / PIXELS);
}

static void silhouettes_are_those_of_geometry(void **state)
{
    (void)state;
    write_scene();
    drawn d;
    must(open_drawn(&d));
    assert_int_equal(d.count, 7);
    const double rod = M_PI * 0.01 + 0.2 * 0.4;
    const double from_above[7] = {M_PI * 0.16, 0.24, 0.25, M_PI * 0.06, rod, rod + M_PI * 0.04, 0.24};
    for (size_t k = 0; k < d.count; ++k)
    {
        pls_vec3 middle = d.items[k].position;
        if (k == 6) middle = pls_add(middle, pls_vec(0.2, 0.3, 0.0));
        double area = area_of(&d.items[k], middle, pls_vec(0, 0, -1), NULL);
        if (!(fabs(area - from_above[k]) < 0.004 * from_above[k] + 1e-4))
            print_error("item %zu: %g m^2, expected %g\n", k, area, from_above[k]);
        assert_true(fabs(area - from_above[k]) < 0.004 * from_above[k] + 1e-4);
        double from_below = area_of(&d.items[k], middle, pls_vec(0, 0, 1), NULL); // a sheet has two sides
        assert_true(fabs(from_below - from_above[k]) < 0.004 * from_above[k] + 1e-4);
    }
    free_drawn(&d);
    assert_int_equal(pls_memory_in_use(), 0);
}

/// From the side, what is left below z = c of a ball is its disc less a segment, and of a box a rectangle. The face of the cut is seen from above and looks the same all over.
static void a_cut_leaves_what_lies_before_the_plane(void **state)
{
    (void)state;
    write_scene();
    drawn d;
    must(open_drawn(&d));
    pls_render_options options = pls_render_defaults();
    options.cut = true;
    options.cut_normal = pls_vec(0, 0, 1);
    options.cut_distance = 0.05;
    const double r = 0.4, c = 0.05, segment = r * r * acos(c / r) - c * sqrt(r * r - c * c);
    double ball = area_of(&d.items[0], d.items[0].position, pls_vec(0, 1, 0), &options);
    assert_true(fabs(ball - (M_PI * r * r - segment)) < 2e-3);
    double cube = area_of(&d.items[2], d.items[2].position, pls_vec(0, 1, 0), &options);
    assert_true(fabs(cube - 0.5 * (0.25 + c)) < 2e-3);
    options.cut_distance = -0.45; // nothing is left
    assert_true(area_of(&d.items[0], d.items[0].position, pls_vec(0, 1, 0), &options) == 0.0);
    options.cut_distance = 0.05;
    options.bar = false;
    options.width = options.height = 64;
    pls_render_camera camera = {pls_vec(0, 0, 5), pls_vec(0, 0, 0), pls_vec(0, 1, 0), 0.0, 1.0};
    pls_render_picture picture;
    must(pls_render_image(d.items, 1, &camera, &options, &picture));
    const uint8_t *middle = &picture.rgba[4 * (32 * 64 + 32)], *aside = &picture.rgba[4 * (20 * 64 + 40)];
    for (int k = 0; k < 3; ++k) assert_true(abs(middle[k] - aside[k]) <= 1);
    pls_render_picture_free(&picture);
    free_drawn(&d);
}

/// In any direction all balls lie within the picture, left of the bar, and some touch the edge of what they may fill.
static void all_bodies_are_in_the_picture(void **state)
{
    (void)state;
    write_scene();
    drawn d;
    must(open_drawn(&d));
    enum { BALLS = 40 };
    pls_render_item balls[BALLS];
    for (int k = 0; k < BALLS; ++k)
    {
        balls[k] = d.items[0];
        balls[k].position = pls_vec(100.0 + 3.0 * sin(7.1 * k), -50.0 + 2.0 * cos(3.3 * k), 4.0 * sin(1.9 * k + 1.0));
        balls[k].scale = 0.2 + 0.02 * k;
    }
    pls_render_options options = pls_render_defaults();
    options.title = "angular velocity";
    options.unit = "rad/s";
    int right = options.width - pls_render_bar_strip(&options);
    for (int n = 0; n < 24; ++n)
    {
        pls_vec3 look = pls_vec(sin(2.3 * n), cos(1.7 * n), 0.8 * sin(0.9 * n + 0.5));
        pls_render_camera camera = pls_render_fit(balls, BALLS, look, pls_vec(0, 0, 1), n % 2 ? 0.5 : 0.0, &options);
        pls_render_view view;
        must(pls_render_view_make(&camera, options.width, options.height, &view));
        int least[2] = {99999, 99999}, most[2] = {0, 0};
        for (int k = 0; k < BALLS; ++k)
        {
            int e[4]; // exact to a pixel more on either side
            assert_true(pls_render_view_extent(&view, balls[k].position, 0.2 * balls[k].scale, e));
            assert_true(pls_render_view_depth(&view, balls[k].position, 0.2 * balls[k].scale) > 0.0);
            for (int c = 0; c < 2; ++c)
            {
                least[c] = e[c] < least[c] ? e[c] : least[c];
                most[c] = e[2 + c] > most[c] ? e[2 + c] : most[c];
            }
        }
        assert_true(least[0] > 5 && least[1] > 5 && most[0] < right && most[1] < options.height - 5);
        double border = 0.5 * options.width * (1.0 - 1.0 / 1.05), top = 0.5 * options.height * (1.0 - 1.0 / 1.05);
        bool wide = least[0] < border + 3.0, tall = least[1] < top + 3.0 && most[1] > options.height - top - 3.0;
        assert_true(wide || tall);
    }
    free_drawn(&d);
}

/// From the shapes on: reading scenes has tests of its own.
static pls_status picture_job(void *context)
{
    drawn *d = context;
    pls_render_item *items = NULL;
    size_t count = 0;
    pls_frame frame = {0};
    pls_paint paint = {0};
    pls_render_picture picture = {0};
    pls_render_options options = pls_render_defaults();
    options.width = 32;
    options.height = 24;
    pls_status status = pls_gallery_load(&d->gallery, 0, &frame);
    if (status == PLS_OK) status = pls_gallery_items(&d->gallery, &frame, &(pls_gallery_look){.wall_opacity = 1.0f}, &items, &count);
    if (status == PLS_OK) status = pls_paint_choose(&paint, &d->gallery, &frame, "shape");
    if (status == PLS_OK) status = pls_paint_apply(&paint, &frame, items);
    if (status == PLS_OK)
    {
        pls_render_camera camera = pls_render_fit(items, count, pls_vec(0, 1, 0), pls_vec(0, 0, 1), 0.5, &options);
        status = pls_render_image(items, count, &camera, &options, &picture);
    }
    pls_render_picture_free(&picture);
    pls_paint_free(&paint);
    pls_release(&items);
    pls_frame_free(&frame);
    return status;
}

static void drawing_survives_allocation_failures(void **state)
{
    (void)state;
    write_scene();
    failing_allocator_install();
    drawn d;
    must(open_drawn(&d));
    assert_true(assert_survives_allocation_failures(picture_job, &d) > 20);
    free_drawn(&d);
    failing_allocator_remove();
    assert_int_equal(pls_memory_in_use(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(silhouettes_are_those_of_geometry),
        cmocka_unit_test(a_cut_leaves_what_lies_before_the_plane),
        cmocka_unit_test(all_bodies_are_in_the_picture),
        cmocka_unit_test(drawing_survives_allocation_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
