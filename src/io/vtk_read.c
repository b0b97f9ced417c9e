// vtk_read.c -- reading back the frames that vtk.c writes.
//
// Only our own files: one appended raw section, blocks compressed with zlib, sizes as UInt64. Whatever the bytes are, nothing is read or written out of bounds, and no more
// memory is asked for than compressed data of that size could fill.

#include "io/frame.h"
#include "io/vtk.h"

#include "base/atomic_file.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

static const char appended_start[] = "<AppendedData encoding=\"raw\">\n_";
static const char file_end[] = "\n  </AppendedData>\n</VTKFile>\n";
enum { MOST_EXPANSION = 1040 }; ///< deflate cannot expand by more than 1032

/// A file being read.
typedef struct reader
{
    const char *path;
    char *xml;        ///< ended where the arrays begin
    const char *data; ///< the arrays
    size_t size;      ///< bytes of `data`
} reader;

static pls_status corrupt(const reader *r, const char *why)
{
    return pls_fail(PLS_CORRUPT, "\"%s\" cannot be read as a frame: %s; only undamaged frames written by particls can be read", r->path,
                    why);
}

/// Attribute `name="..."` of the element that begins at `element`, cut to `size`.
static bool find_attribute(const char *element, const char *name, char *value, size_t size)
{
    char key[64];
    snprintf(key, sizeof key, " %s=\"", name);
    const char *end = strchr(element, '>'), *found = strstr(element, key);
    if (!end || !found || found > end) return false;
    found += strlen(key);
    snprintf(value, size, "%.*s", (int)strcspn(found, "\""), found);
    return true;
}

static bool find_type(const char *name, pls_type *type)
{
    for (int k = PLS_F64; k <= PLS_U8; ++k)
    {
        *type = (pls_type)k;
        if (strcmp(name, pls_vtk_type_name(*type)) == 0) return true;
    }
    return false;
}

/// Sizes in front of an array: vtk.c, append_array.
typedef struct array_head
{
    uint64_t blocks, block_size, last_size; ///< last_size 0: the last block is whole
} array_head;

static pls_status read_head(const reader *r, size_t offset, array_head *head, size_t *total)
{
    if (offset > r->size || r->size - offset < sizeof *head) return corrupt(r, "it is cut off");
    memcpy(head, r->data + offset, sizeof *head);
    size_t left = r->size - offset - sizeof *head;
    if (head->blocks > left / sizeof(uint64_t)) return corrupt(r, "it is cut off");
    *total = 0;
    if (head->blocks == 0) return PLS_OK;
    if (head->block_size == 0 || head->block_size > UINT32_MAX || head->last_size > head->block_size ||
        head->blocks > left * MOST_EXPANSION / head->block_size + 1)
        return corrupt(r, "the size of an array is impossible");
    *total = (head->blocks - 1) * head->block_size + (head->last_size ? head->last_size : head->block_size);
    return PLS_OK;
}

static pls_status read_blocks(const reader *r, size_t offset, const array_head *head, unsigned char *out, size_t total)
{
    size_t sizes = offset + sizeof *head, block = sizes + head->blocks * sizeof(uint64_t), done = 0;
    for (uint64_t k = 0; k < head->blocks; ++k)
    {
        uint64_t packed;
        memcpy(&packed, r->data + sizes + k * sizeof packed, sizeof packed);
        if (packed > r->size - block) return corrupt(r, "it is cut off");
        size_t wanted = total - done < head->block_size ? total - done : head->block_size;
        uLongf got = (uLongf)wanted;
        if (uncompress(out + done, &got, (const Bytef *)r->data + block, (uLong)packed) != Z_OK || got != wanted)
            return corrupt(r, "an array is damaged");
        block += packed;
        done += wanted;
    }
    return PLS_OK;
}

static pls_status read_array(const reader *r, size_t offset, pls_frame_column *column)
{
    array_head head;
    size_t total = 0, row = pls_type_size(column->type) * (size_t)column->components;
    PLS_TRY(read_head(r, offset, &head, &total));
    if (total % row != 0) return corrupt(r, "an array ends within a row");
    column->rows = total / row;
    PLS_TRY(pls_allocate(&column->data, total, 1, "a field of a frame"));
    pls_status status = read_blocks(r, offset, &head, column->data, total);
    if (status != PLS_OK) pls_release(&column->data);
    return status;
}

/// One DataArray. Cells are integers of 64 bits, which no field is: they are passed over.
static pls_status read_element(pls_frame *frame, const reader *r, const char *element)
{
    char name[PLS_NAME_SIZE], type[16], components[16], offset[32];
    pls_frame_column column = {0};
    if (!find_attribute(element, "Name", name, sizeof name) || !find_attribute(element, "type", type, sizeof type) ||
        !find_attribute(element, "NumberOfComponents", components, sizeof components) ||
        !find_attribute(element, "offset", offset, sizeof offset) || !find_type(type, &column.type))
        return PLS_OK;
    column.components = (int)strtol(components, NULL, 10);
    if (column.components < 1 || column.components > 64) return corrupt(r, "an array has an impossible number of components");
    snprintf(column.name, sizeof column.name, "%s", name);
    PLS_TRY(pls_reserve(&frame->column, &frame->capacity, frame->count + 1, sizeof *frame->column, "the fields of a frame"));
    PLS_TRY(read_array(r, strtoull(offset, NULL, 10), &column));
    frame->column[frame->count++] = column;
    return PLS_OK;
}

static pls_status read_time(pls_frame *frame, const reader *r)
{
    char number[32];
    const char *time = strstr(r->xml, "Name=\"TimeValue\"");
    time = time ? strchr(time, '>') : NULL;
    if (time) snprintf(number, sizeof number, "%.*s", (int)strcspn(time + 1, "<"), time + 1);
    return time && pls_parse_double(number, &frame->time) ? PLS_OK : corrupt(r, "it does not tell its time");
}

/// All columns of bodies, and all of walls, must have as many rows as their positions.
static pls_status check_rows(const pls_frame *frame, const reader *r)
{
    const pls_frame_column *body = pls_frame_find(frame, "position"), *wall = pls_frame_find(frame, PLS_WALL_PREFIX "position");
    if (!body) return corrupt(r, "it holds no positions");
    for (size_t k = 0; k < frame->count; ++k)
    {
        const pls_frame_column *c = &frame->column[k];
        const pls_frame_column *like = strncmp(c->name, PLS_WALL_PREFIX, strlen(PLS_WALL_PREFIX)) == 0 ? wall : body;
        if (!like || c->rows != like->rows) return corrupt(r, "its fields differ in length");
    }
    return PLS_OK;
}

static pls_status read_text(pls_frame *frame, reader *r, char *text, size_t size)
{
    char *data = strstr(text, appended_start);
    r->xml = text;
    if (!data) return corrupt(r, "there is no appended section of arrays in it");
    *data = '\0';
    r->data = data + strlen(appended_start);
    r->size = size - (size_t)(r->data - text);
    if (r->size < strlen(file_end) || memcmp(text + size - strlen(file_end), file_end, strlen(file_end)) != 0)
        return corrupt(r, "it is cut off");
    PLS_TRY(read_time(frame, r));
    for (const char *element = text; (element = strstr(element, "<DataArray ")); ++element) PLS_TRY(read_element(frame, r, element));
    return check_rows(frame, r);
}

pls_status pls_frame_read(pls_frame *frame, const char *path)
{
    *frame = (pls_frame){0};
    reader r = {.path = path};
    char *text;
    size_t size;
    PLS_TRY(pls_read_file(path, &text, &size));
    pls_status status = read_text(frame, &r, text, size);
    pls_release(&text);
    if (status != PLS_OK) pls_frame_free(frame);
    return status;
}
