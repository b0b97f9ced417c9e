// Pictures against geometry: outlines, order, shadows and colours that are known; and files that other readers accept.

#include "render/render.h"

#include "shape/builtin.h"
#include "support/near.h"
#include "support/numbers.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>
#include <zlib.h>

static pls_shape *make(const pls_shape_ops *ops, int dimension, double value)
{
    double values[PLS_MAX_PARAMETERS] = {value};
    pls_shape *shape = NULL;
    assert_int_equal(pls_shape_make(ops, dimension, &(pls_shape_input){VALUES(values)}, "the shape", &shape), PLS_OK);
    return shape;
}

/// A ball that gives nothing but its SDF, as a user's shape does.
static double ball_sdf(const pls_shape *shape, pls_vec3 X) { return pls_length(pls_sub(X, pls_vec(0.3, 0.0, 0.0))) - shape->values[0]; }
static const pls_parameter ball_parameters[] = {
    {.name = "radius", .unit = "m", .meaning = "radius", .initial = PLS_REQUIRED, .maximum = INFINITY}, {.name = NULL}};
static const pls_shape_ops user_ball = {.api_version = PLS_API_VERSION,
                                        .name = "user_ball",
                                        .meaning = "a ball beside the origin",
                                        .parameters = ball_parameters,
                                        .in_3d = true,
                                        .convex = true,
                                        .sdf = ball_sdf};

static pls_render_item item_at(const pls_shape *shape, pls_vec3 position, double scale, double value)
{
    return (pls_render_item){shape, position, pls_quat_identity(), scale, 0.0, value, 1.0f};
}

static pls_render_options plain(int width, int height)
{
    pls_render_options options = pls_render_defaults();
    options.width = width;
    options.height = height;
    options.bar = false;
    return options;
}

/// Looks along -z from 10 m above the origin.
static pls_render_camera from_above(double field_of_view, double height)
{
    return (pls_render_camera){pls_vec(0.0, 0.0, 10.0), pls_vec(0.0, 0.0, 0.0), pls_vec(0.0, 1.0, 0.0), field_of_view, height};
}

static pls_render_picture draw(const pls_render_item *items, size_t count, pls_render_camera camera, pls_render_options options)
{
    pls_render_picture picture;
    assert_int_equal(pls_render_image(items, count, &camera, &options, &picture), PLS_OK);
    assert_non_null(picture.rgba);
    return picture;
}

/// Covered area and centre [pixels], where the background lets all through.
typedef struct outline
{
    double area, x, y;
} outline;

static outline outline_of(const pls_render_item *items, size_t count, pls_render_camera camera, pls_render_options options)
{
    memset(options.background, 0, 4);
    pls_render_picture picture = draw(items, count, camera, options);
    outline o = {0};
    for (int k = 0; k < picture.width * picture.height; ++k)
    {
        double covered = picture.rgba[4 * k + 3] / 255.0;
        o.area += covered;
        o.x += covered * (k % picture.width + 0.5);
        o.y += covered * (k / picture.width + 0.5);
    }
    pls_render_picture_free(&picture);
    o.x /= o.area;
    o.y /= o.area;
    return o;
}

static const uint8_t *pixel(const pls_render_picture *picture, int x, int y) { return &picture->rgba[4 * (y * picture->width + x)]; }

/// In parallel a disc; from an eye at distance d an ellipse, whose tangents follow from the cone around the ball.
static void outlines(void **state)
{
    (void)state;
    pls_shape *shapes[2] = {make(&pls_sphere_shape, 3, 0.5), make(&user_ball, 3, 0.5)};
    for (int k = 0; k < 2; ++k)
    {
        pls_render_item item = item_at(shapes[k], pls_vec(1.0, 0.5, 0.0), 2.0, 0.5);
        outline o = outline_of(&item, 1, from_above(0.0, 5.0), plain(400, 300));
        double size = 300 / 5.0; // pixels per metre
        assert_near(o.area, M_PI * size * size, 0.01 * M_PI * size * size);
        assert_near(o.x, 200.0 + size, 0.01 * size);
        assert_near(o.y, 150.0 - 0.5 * size, 0.01 * size);

        const double field = 0.6, distance = 10.0, radius = 1.0;
        item.position = pls_vec(2.0, 0.0, 0.0);
        o = outline_of(&item, 1, from_above(field, 0.0), plain(400, 300));
        size = 150.0 / tan(0.5 * field);
        double angle = atan2(2.0, distance), half = asin(radius / hypot(2.0, distance));
        double low = tan(angle - half), high = tan(angle + half), long_half = 0.5 * (high - low);
        double short_half = radius / sqrt(distance * distance - radius * radius); // across the direction from the picture's middle
        double middle = 0.5 * (low + high);
        // Where the ellipse's own middle is, the cone is cut off-axis: b^2 = a^2 (1 - e^2) with e = sin(angle) / cos(half).
        double eccentricity = sin(angle) / cos(half);
        double across = long_half * sqrt(1.0 - eccentricity * eccentricity);
        assert_true(across >= short_half * 0.999);
        assert_near(o.area, M_PI * long_half * across * size * size, 0.01 * M_PI * long_half * across * size * size);
        assert_near(o.x, 200.0 + middle * size, 0.01 * long_half * size);
        assert_near(o.y, 150.0, 0.01 * long_half * size);
        pls_shape_free(shapes[k]);
    }
}

/// The nearer ball is seen, whichever comes first; a thin one lets the other through.
static void order_of_depth(void **state)
{
    (void)state;
    pls_shape *shape = make(&pls_sphere_shape, 3, 1.0);
    for (int turn = 0; turn < 2; ++turn)
    {
        pls_render_item items[2];
        items[turn] = item_at(shape, pls_vec(0.0, 0.0, 3.0), 1.0, 1.0); // yellow, above
        items[1 - turn] = item_at(shape, pls_vec(0.0, 0.0, 0.0), 1.0, 0.0);
        pls_render_picture picture = draw(items, 2, from_above(0.5, 0.0), plain(64, 64));
        const uint8_t *p = pixel(&picture, 32, 32);
        assert_true(p[0] > 150 && p[1] > 150 && p[2] < 100);
        pls_render_picture_free(&picture);
        items[turn].opacity = 0.0f;
        picture = draw(items, 2, from_above(0.5, 0.0), plain(64, 64));
        p = pixel(&picture, 32, 32);
        assert_true(p[1] < 60 && p[2] > p[1]); // violet
        uint8_t below = p[0];
        pls_render_picture_free(&picture);
        items[turn].opacity = 0.5f;
        picture = draw(items, 2, from_above(0.5, 0.0), plain(64, 64));
        p = pixel(&picture, 32, 32);
        assert_true(p[0] > below + 30 && p[0] < 250 && p[1] > 60);
        pls_render_picture_free(&picture);
    }
    pls_shape_free(shape);
}

/// Light from straight above: the shadow of a ball on a floor lies around its foot and nowhere else; a traced ball throws the same.
static void shadow_on_a_floor(void **state)
{
    (void)state;
    pls_shape *floor = make(&pls_plane_shape, 3, 0.0), *balls[2] = {make(&pls_sphere_shape, 3, 0.5), make(&user_ball, 3, 0.5)};
    pls_render_camera camera = {pls_vec(10.0, 0.0, 10.0), pls_vec(0.0, 0.0, 0.0), pls_vec(0.0, 0.0, 1.0), 0.0, 6.0};
    double dark[2];
    for (int k = 0; k < 2; ++k)
    {
        pls_render_item items[2] = {item_at(floor, pls_vec(0.0, 0.0, -2.0), 1.0, 0.0), item_at(balls[k], pls_vec(0.0, 0.0, 0.5), 1.0, 0.5)};
        pls_render_options options = plain(300, 300);
        options.light = pls_vec(0.0, 0.0, 1.0);
        pls_render_picture with = draw(items, 2, camera, options);
        options.shadows = false;
        pls_render_picture without = draw(items, 2, camera, options);
        dark[k] = 0.0;
        double x = 0.0, y = 0.0;
        for (int n = 0; n < 300 * 300; ++n)
        {
            assert_true(with.rgba[4 * n] <= without.rgba[4 * n]);
            double less = (without.rgba[4 * n] - with.rgba[4 * n]) / 255.0;
            dark[k] += less;
            x += less * (n % 300 + 0.5);
            y += less * (n / 300 + 0.5);
        }
        assert_true(dark[k] > 100.0);
        assert_near(x / dark[k], 150.0, 1.0);
        assert_near(y / dark[k], 150.0 + 2.0 * 50.0 * sqrt(0.5), 2.0); // 2 m below the middle, seen at 45 degrees, 50 pixels a metre
        pls_render_picture_free(&with);
        pls_render_picture_free(&without);
    }
    assert_near(dark[0], dark[1], 0.03 * dark[0]);
    pls_shape_free(floor);
    for (int k = 0; k < 2; ++k) pls_shape_free(balls[k]);
}

static void colours_of_the_bar(void **state)
{
    (void)state;
    pls_render_options options = plain(640, 360);
    options.bar = true;
    options.low = -3.0;
    options.high = 5.0;
    options.title = "speed";
    options.unit = "m/s";
    pls_render_picture picture = draw(NULL, 0, from_above(0.0, 1.0), options);
    int place[4];
    pls_render_bar_place(&options, place);
    static const uint8_t low[4] = {68, 1, 84, 255}, high[4] = {253, 231, 37, 255}, white[4] = {255, 255, 255, 255};
    assert_memory_equal(pixel(&picture, place[0], place[3] - 1), low, 4);
    assert_memory_equal(pixel(&picture, place[2] - 1, place[1]), high, 4);
    assert_memory_equal(pixel(&picture, 0, 0), white, 4);
    int ink = 0;
    for (int y = 0; y < place[1]; ++y)
    {
        for (int x = 0; x < 640; ++x) ink += pixel(&picture, x, y)[0] < 128;
    }
    assert_true(ink > 60); // the title
    pls_render_picture_free(&picture);

    uint8_t last[3], rgb[3];
    double brightness = -1.0;
    for (int k = 0; k <= 100; ++k) // perceptually uniform: brighter all the way
    {
        pls_render_colour(PLS_RENDER_VIRIDIS, k, 0.0, 100.0, rgb);
        double now = 0.2126 * pls_render_linear_from_srgb(rgb[0]) + 0.7152 * pls_render_linear_from_srgb(rgb[1]) +
                     0.0722 * pls_render_linear_from_srgb(rgb[2]);
        assert_true(now > brightness - 1e-3);
        brightness = now;
    }
    pls_render_colour(PLS_RENDER_CATEGORICAL, -1.0, 0.0, 1.0, last);
    pls_render_colour(PLS_RENDER_CATEGORICAL, 7.0, 0.0, 1.0, rgb);
    assert_memory_equal(last, rgb, 3);
    pls_render_colour(PLS_RENDER_CATEGORICAL, 0.0, 0.0, 1.0, rgb);
    assert_memory_not_equal(last, rgb, 3);
}

/// A 2D scene from above: a disc and a half-plane.
static void flat_shapes(void **state)
{
    (void)state;
    pls_shape *disc = make(&pls_sphere_shape, 2, 1.0), *ground = make(&pls_plane_shape, 2, 0.0);
    pls_render_item item = item_at(disc, pls_vec(0.5, 0.0, 0.0), 1.0, 0.5);
    pls_render_options square = plain(200, 200);
    pls_render_camera camera = pls_render_fit(&item, 1, pls_vec(0.0, 0.0, -1.0), pls_vec(0.0, 1.0, 0.0), 0.0, &square);
    outline o = outline_of(&item, 1, camera, square);
    double radius = 100.0 / 1.05;
    assert_near(o.area, M_PI * radius * radius, 0.01 * M_PI * radius * radius);
    assert_near(o.x, 100.0, 1.0);
    item = item_at(ground, pls_vec(0.0, 0.0, 0.0), 1.0, 0.5);
    o = outline_of(&item, 1, from_above(0.0, 4.0), plain(200, 200));
    assert_near(o.area, 20000.0, 200.0);
    assert_near(o.y, 150.0, 1.0); // the lower half
    pls_shape_free(disc);
    pls_shape_free(ground);
}

static void same_for_any_threads(void **state)
{
    (void)state;
    pls_shape *ball = make(&pls_sphere_shape, 3, 1.0), *user = make(&user_ball, 3, 1.0), *floor = make(&pls_plane_shape, 3, 0.0);
    enum { COUNT = 61 };
    pls_render_item items[COUNT];
    for (int k = 0; k < COUNT - 1; ++k)
    {
        pls_vec3 p = pls_vec(3.0 * sin(1.7 * k), 3.0 * cos(2.9 * k), 1.0 + 0.05 * k);
        items[k] = item_at(k % 3 ? ball : user, p, 0.3 + 0.01 * k, k / 60.0);
        items[k].opacity = k % 5 ? 1.0f : 0.4f;
    }
    items[COUNT - 1] = item_at(floor, pls_vec(0.0, 0.0, 0.0), 1.0, 0.0);
    pls_render_options options = plain(240, 160);
    pls_render_camera camera = pls_render_fit(items, COUNT, pls_vec(-1.0, 1.0, -0.7), pls_vec(0.0, 0.0, 1.0), 0.6, &options);
    options.threads = 1;
    pls_render_picture one = draw(items, COUNT, camera, options);
    options.threads = 2;
    pls_render_picture two = draw(items, COUNT, camera, options);
    assert_memory_equal(one.rgba, two.rgba, 4 * 240 * 160);
    pls_render_picture_free(&one);
    pls_render_picture_free(&two);
    pls_shape_free(ball);
    pls_shape_free(user);
    pls_shape_free(floor);
}

static pls_render_picture pattern(int width, int height, int seed)
{
    pls_render_picture picture = {.width = width, .height = height};
    assert_int_equal(pls_allocate(&picture.rgba, (size_t)(4 * width * height), 1, "a picture"), PLS_OK);
    for (int k = 0; k < 4 * width * height; ++k) picture.rgba[k] = (uint8_t)(k * k / 7 + seed * k);
    return picture;
}

static void png_and_back(void **state)
{
    (void)state;
    pls_render_picture out = pattern(37, 21, 3), in;
    assert_int_equal(pls_png_write("one.png", &out), PLS_OK);
    assert_int_equal(pls_png_read("one.png", &in), PLS_OK);
    assert_int_equal(in.width, 37);
    assert_int_equal(in.height, 21);
    assert_memory_equal(in.rgba, out.rgba, 4 * 37 * 21);
    pls_render_picture_free(&in);
    assert_int_equal(pls_png_write("no/such/folder/one.png", &out), PLS_IO);
    assert_false(pls_file_exists("no"));
    assert_int_equal(pls_png_read("no.png", &in), PLS_NOT_FOUND);
    assert_int_equal(pls_write_file("not.png", "text", 4), PLS_OK);
    assert_int_equal(pls_png_read("not.png", &in), PLS_IO);
    assert_null(in.rgba);
    pls_render_picture_free(&out);
    assert_int_equal(pls_png_write("one.png", &out), PLS_INVALID_ARGUMENT);
}

static uint32_t get32(const uint8_t *p) { return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3]; }

/// Unpack a frame's data and compare it with that of the same picture as a file of its own.
static void assert_frame(const uint8_t *data, size_t size, const pls_render_picture *picture)
{
    uLongf room = (uLongf)(picture->height * (4 * picture->width + 1)), got = room, known_size = room;
    uint8_t *raw = NULL, *known = NULL;
    assert_int_equal(pls_allocate(&raw, room, 1, "rows"), PLS_OK);
    assert_int_equal(pls_allocate(&known, room, 1, "rows"), PLS_OK);
    assert_int_equal(uncompress(raw, &got, data, (uLong)size), Z_OK);
    assert_int_equal(pls_png_write("alone.png", picture), PLS_OK);
    char *file;
    size_t file_size;
    assert_int_equal(pls_read_file("alone.png", &file, &file_size), PLS_OK);
    const uint8_t *chunk = (const uint8_t *)file + 8;
    while (memcmp(chunk + 4, "IDAT", 4) != 0) chunk += get32(chunk) + 12;
    assert_int_equal(uncompress(known, &known_size, chunk + 8, get32(chunk)), Z_OK);
    assert_int_equal(got, room);
    assert_memory_equal(raw, known, room);
    pls_release(&raw);
    pls_release(&known);
    pls_release(&file);
}

static void three_frames(void **state)
{
    (void)state;
    pls_apng apng;
    pls_render_picture frames[3], in, other = pattern(5, 5, 1);
    assert_int_equal(pls_apng_open(&apng, "moving.png", 40, 0), PLS_OK);
    for (int k = 0; k < 3; ++k)
    {
        frames[k] = pattern(20, 10, k);
        assert_int_equal(pls_apng_add(&apng, &frames[k]), PLS_OK);
    }
    assert_int_equal(pls_apng_add(&apng, &other), PLS_INVALID_ARGUMENT); // another size
    assert_int_equal(pls_apng_close(&apng), PLS_OK);
    assert_int_equal(pls_png_read("moving.png", &in), PLS_OK); // who knows no animations sees the first frame
    assert_memory_equal(in.rgba, frames[0].rgba, 4 * 20 * 10);
    pls_render_picture_free(&in);

    char *file, order[256] = "";
    size_t size;
    assert_int_equal(pls_read_file("moving.png", &file, &size), PLS_OK);
    uint32_t number = 0;
    int frame = 0;
    const uint8_t *chunk = (const uint8_t *)file + 8, *end = (const uint8_t *)file + size;
    for (; chunk < end; chunk += get32(chunk) + 12)
    {
        const uint8_t *data = chunk + 8;
        uint32_t length = get32(chunk);
        assert_int_equal(crc32(0, chunk + 4, length + 4), get32(data + length));
        char name[6] = {(char)chunk[4], (char)chunk[5], (char)chunk[6], (char)chunk[7], ' ', 0};
        if (strstr("IHDR acTL fcTL IDAT fdAT IEND ", name)) strncat(order, name, sizeof order - strlen(order) - 1);
        if (strcmp(name, "acTL ") == 0) assert_true(get32(data) == 3 && get32(data + 4) == 0);
        if (strcmp(name, "fcTL ") == 0)
        {
            assert_int_equal(get32(data), number++);
            assert_true(get32(data + 4) == 20 && get32(data + 8) == 10 && data[21] == 40 && data[22] * 256 + data[23] == 1000);
        }
        if (strcmp(name, "fdAT ") == 0)
        {
            assert_int_equal(get32(data), number++);
            assert_frame(data + 4, length - 4, &frames[++frame]);
        }
    }
    assert_ptr_equal(chunk, end);
    assert_string_equal(order, "IHDR acTL fcTL IDAT fcTL fdAT fcTL fdAT IEND ");
    pls_release(&file);
    for (int k = 0; k < 3; ++k) pls_render_picture_free(&frames[k]);
    pls_render_picture_free(&other);

    assert_int_equal(pls_apng_open(&apng, "empty.png", 40, 0), PLS_OK);
    assert_int_equal(pls_apng_close(&apng), PLS_INVALID_ARGUMENT);
    assert_false(pls_file_exists("empty.png") || pls_file_exists("empty.png.tmp"));
    assert_int_equal(pls_apng_open(&apng, "no/such/folder/moving.png", 40, 0), PLS_IO);
    assert_int_equal(pls_apng_add(&apng, &other), PLS_INVALID_ARGUMENT);
}

static void what_cannot_be_drawn(void **state)
{
    (void)state;
    pls_shape *ball = make(&pls_sphere_shape, 3, 1.0);
    pls_render_item item = item_at(ball, pls_vec(0.0, 0.0, 0.0), 1.0, 0.0), bad = item;
    pls_render_camera camera = from_above(0.5, 0.0), blind = camera;
    pls_render_options options = plain(16, 16), wrong = options;
    pls_render_picture picture;
    bad.position.x = NAN;
    assert_int_equal(pls_render_image(&bad, 1, &camera, &options, &picture), PLS_INVALID_ARGUMENT);
    blind.target = blind.eye;
    assert_int_equal(pls_render_image(&item, 1, &blind, &options, &picture), PLS_INVALID_ARGUMENT);
    blind = camera;
    blind.up = pls_vec(0.0, 0.0, 1.0);
    assert_int_equal(pls_render_image(&item, 1, &blind, &options, &picture), PLS_INVALID_ARGUMENT);
    wrong.width = 0;
    assert_int_equal(pls_render_image(&item, 1, &camera, &wrong, &picture), PLS_INVALID_ARGUMENT);
    wrong = options;
    wrong.high = wrong.low;
    assert_int_equal(pls_render_image(&item, 1, &camera, &wrong, &picture), PLS_INVALID_ARGUMENT);
    wrong = options;
    wrong.light = pls_vec(0.0, 0.0, 0.0);
    assert_int_equal(pls_render_image(&item, 1, &camera, &wrong, &picture), PLS_INVALID_ARGUMENT);
    assert_null(picture.rgba);
    pls_shape_free(ball);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outlines),           cmocka_unit_test(order_of_depth), cmocka_unit_test(shadow_on_a_floor),
        cmocka_unit_test(colours_of_the_bar), cmocka_unit_test(flat_shapes),    cmocka_unit_test(same_for_any_threads),
        cmocka_unit_test(png_and_back),       cmocka_unit_test(three_frames),   cmocka_unit_test(what_cannot_be_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
