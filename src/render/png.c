// png.c -- PNG files, and animations made of them.
//
// libpng compresses each picture in memory; files are then written atomically. An animated PNG (the APNG extension, part of PNG's third edition, W3C 2023) is the first
// picture with a chunk acTL that counts the frames; the data of each further one stand in chunks fdAT, which are IDAT with a number in front. The number of frames is
// written last, in its place near the start of the file, so that a run need not know it when it begins.

#include "render/render.h"

#include <png.h>
#include <string.h>
#include <zlib.h>

enum { SIGNATURE = 8, FRAME = 12 }; ///< sizes [bytes]: of a file's signature; of a chunk without its data

void pls_render_picture_free(pls_render_picture *picture)
{
    pls_release(&picture->rgba);
    *picture = (pls_render_picture){0};
}

/// The whole file, in memory; `format` is libpng's of `pixels`.
static pls_status compress_pixels(const pls_render_picture *picture, png_uint_32 format, const uint8_t *pixels, const char *path,
                                  uint8_t **data, size_t *size)
{
    png_image image = {.version = PNG_IMAGE_VERSION, .format = format};
    image.width = (png_uint_32)picture->width;
    image.height = (png_uint_32)picture->height;
    png_alloc_size_t room = PNG_IMAGE_PNG_SIZE_MAX(image);
    PLS_TRY(pls_allocate(data, room, 1, "a PNG file"));
    if (png_image_write_to_memory(&image, *data, &room, 0, pixels, 0, NULL))
    {
        *size = room;
        return PLS_OK;
    }
    pls_release(data);
    return pls_fail(PLS_IO, "cannot compress the picture for \"%s\": %s; try a smaller one", path, image.message);
}

/// All pictures of an animation have one format, so theirs always has an opacity.
static pls_status compress_picture(const pls_render_picture *picture, const char *path, uint8_t **data, size_t *size)
{
    *data = NULL;
    if (!picture->rgba || picture->width < 1 || picture->height < 1)
        return pls_fail(PLS_INVALID_ARGUMENT, "cannot write \"%s\": the picture is empty; draw it first", path);
    return compress_pixels(picture, PNG_FORMAT_RGBA, picture->rgba, path, data, size);
}

/// Without the opacity, where there is nothing to see through: a smaller file.
static pls_status compress_opaque(const pls_render_picture *picture, const char *path, uint8_t **data, size_t *size)
{
    size_t pixels = (size_t)picture->width * (size_t)picture->height;
    uint8_t *rgb = NULL;
    PLS_TRY(pls_allocate(&rgb, pixels, 3, "a picture"));
    for (size_t k = 0; k < pixels; ++k) memcpy(&rgb[3 * k], &picture->rgba[4 * k], 3);
    pls_status status = compress_pixels(picture, PNG_FORMAT_RGB, rgb, path, data, size);
    pls_release(&rgb);
    return status;
}

static bool is_opaque(const pls_render_picture *picture)
{
    size_t pixels = picture->rgba ? (size_t)picture->width * (size_t)picture->height : 0;
    for (size_t k = 0; k < pixels; ++k)
    {
        if (picture->rgba[4 * k + 3] != 255) return false;
    }
    return pixels > 0;
}

pls_status pls_png_write(const char *path, const pls_render_picture *picture)
{
    uint8_t *data = NULL;
    size_t size = 0;
    PLS_TRY((is_opaque(picture) ? compress_opaque : compress_picture)(picture, path, &data, &size));
    pls_status status = pls_write_file(path, data, size);
    pls_release(&data);
    return status;
}

static pls_status decompress(const char *path, const void *data, size_t size, pls_render_picture *picture)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_memory(&image, data, size))
        return pls_fail(PLS_IO, "\"%s\" is no PNG file: %s; give one", path, image.message);
    image.format = PNG_FORMAT_RGBA;
    picture->width = (int)image.width;
    picture->height = (int)image.height;
    pls_status status = pls_allocate(&picture->rgba, PNG_IMAGE_SIZE(image), 1, "a picture");
    if (status == PLS_OK && !png_image_finish_read(&image, NULL, picture->rgba, 0, NULL))
        status = pls_fail(PLS_IO, "\"%s\" is a damaged PNG file: %s; make it again", path, image.message);
    png_image_free(&image);
    if (status != PLS_OK) pls_render_picture_free(picture);
    return status;
}

pls_status pls_png_read(const char *path, pls_render_picture *picture)
{
    *picture = (pls_render_picture){0};
    char *data;
    size_t size;
    PLS_TRY(pls_read_file(path, &data, &size));
    pls_status status = decompress(path, data, size, picture);
    pls_release(&data);
    return status;
}

// ---- animations -----------------------------------------------------------------------------------------------------------------------

static void put32(uint8_t *to, uint32_t value)
{
    for (int k = 0; k < 4; ++k) to[k] = (uint8_t)(value >> (24 - 8 * k));
}

static uint32_t get32(const uint8_t *from)
{
    return (uint32_t)from[0] << 24 | (uint32_t)from[1] << 16 | (uint32_t)from[2] << 8 | (uint32_t)from[3];
}

/// Length, name, head and data (one after the other), checksum of all but the length.
static pls_status write_chunk(pls_apng *apng, const char *name, const uint8_t *head, uint32_t head_size, const uint8_t *data, uint32_t size)
{
    uint8_t start[8], end[4];
    put32(start, head_size + size);
    memcpy(start + 4, name, 4);
    uLong sum = crc32(0, start + 4, 4);
    if (head_size > 0) sum = crc32(sum, head, head_size);
    if (size > 0) sum = crc32(sum, data, size);
    put32(end, (uint32_t)sum);
    PLS_TRY(pls_atomic_write(&apng->file, start, sizeof start));
    PLS_TRY(pls_atomic_write(&apng->file, head, head_size));
    PLS_TRY(pls_atomic_write(&apng->file, data, size));
    return pls_atomic_write(&apng->file, end, sizeof end);
}

/// acTL: frames, plays.
static pls_status write_counts(pls_apng *apng)
{
    uint8_t head[8];
    put32(head, apng->frames);
    put32(head + 4, apng->plays);
    return write_chunk(apng, "acTL", head, sizeof head, NULL, 0);
}

/// fcTL: number, size, place, delay as a fraction of a second, leave the picture and replace it.
static pls_status write_control(pls_apng *apng)
{
    uint8_t head[26] = {0};
    put32(head, apng->sequence++);
    put32(head + 4, (uint32_t)apng->width);
    put32(head + 8, (uint32_t)apng->height);
    head[20] = (uint8_t)(apng->delay >> 8);
    head[21] = (uint8_t)(apng->delay & 255);
    head[22] = 1000 >> 8;
    head[23] = 1000 & 255;
    return write_chunk(apng, "fcTL", head, sizeof head, NULL, 0);
}

static bool is_chunk(const uint8_t *chunk, const char *name) { return memcmp(chunk + 4, name, 4) == 0; }

/// Of the first picture all but its end, with the animation's chunks before its data.
static pls_status write_first(pls_apng *apng, const uint8_t *data, size_t size)
{
    PLS_TRY(pls_atomic_write(&apng->file, data, SIGNATURE));
    bool before = true;
    for (const uint8_t *chunk = data + SIGNATURE; chunk < data + size && !is_chunk(chunk, "IEND"); chunk += get32(chunk) + FRAME)
    {
        if (before && is_chunk(chunk, "IDAT"))
        {
            before = false;
            apng->counts_at = ftell(apng->file.stream);
            PLS_TRY(write_counts(apng));
            PLS_TRY(write_control(apng));
        }
        PLS_TRY(pls_atomic_write(&apng->file, chunk, (size_t)get32(chunk) + FRAME));
    }
    return PLS_OK;
}

/// Of a further picture the data alone.
static pls_status write_next(pls_apng *apng, const uint8_t *data, size_t size)
{
    PLS_TRY(write_control(apng));
    for (const uint8_t *chunk = data + SIGNATURE; chunk < data + size && !is_chunk(chunk, "IEND"); chunk += get32(chunk) + FRAME)
    {
        if (!is_chunk(chunk, "IDAT")) continue;
        uint8_t number[4];
        put32(number, apng->sequence++);
        PLS_TRY(write_chunk(apng, "fdAT", number, sizeof number, chunk + 8, get32(chunk)));
    }
    return PLS_OK;
}

pls_status pls_apng_open(pls_apng *apng, const char *path, uint16_t delay, uint32_t plays)
{
    *apng = (pls_apng){.delay = delay, .plays = plays};
    return pls_atomic_open(&apng->file, path);
}

pls_status pls_apng_add(pls_apng *apng, const pls_render_picture *picture)
{
    if (!apng->file.stream) return pls_fail(PLS_INVALID_ARGUMENT, "cannot add a frame to an animation that is not open");
    if (apng->frames > 0 && (picture->width != apng->width || picture->height != apng->height))
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "cannot add a frame of %d x %d pixels to \"%s\", whose first one has %d x %d: draw all frames in one size",
                        picture->width, picture->height, apng->file.path, apng->width, apng->height);
    uint8_t *data;
    size_t size = 0;
    PLS_TRY(compress_picture(picture, apng->file.path, &data, &size));
    apng->width = picture->width;
    apng->height = picture->height;
    pls_status status = apng->frames == 0 ? write_first(apng, data, size) : write_next(apng, data, size);
    if (status == PLS_OK) apng->frames++;
    pls_release(&data);
    return status;
}

pls_status pls_apng_close(pls_apng *apng)
{
    if (!apng->file.stream) return pls_fail(PLS_INVALID_ARGUMENT, "cannot close an animation that is not open");
    if (apng->frames == 0)
    {
        pls_status status =
            pls_fail(PLS_INVALID_ARGUMENT, "cannot write \"%s\": the animation has no frame; add one before closing it", apng->file.path);
        pls_apng_abandon(apng);
        return status;
    }
    PLS_TRY(write_chunk(apng, "IEND", NULL, 0, NULL, 0));
    if (fseek(apng->file.stream, apng->counts_at, SEEK_SET) != 0)
    {
        pls_status status =
            pls_fail(PLS_IO, "cannot go back in \"%s\" to write the number of frames: give a regular file", apng->file.path);
        pls_apng_abandon(apng);
        return status;
    }
    PLS_TRY(write_counts(apng));
    return pls_atomic_commit(&apng->file);
}

void pls_apng_abandon(pls_apng *apng) { pls_atomic_abandon(&apng->file); }
