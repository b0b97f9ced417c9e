// frame.h -- bodies at one instant, in columns: taken from a world, or read back from a frame file.
//
// Bodies and walls (unbounded bodies) stand apart, because a wall is no point that a viewer of frames could draw: its columns begin with "wall_", and have rows of their own.
#ifndef PLS_IO_FRAME_H
#define PLS_IO_FRAME_H

#include "base/alloc.h"

#include <particls/field.h>
#include <particls/world.h>

#define PLS_WALL_PREFIX "wall_"

typedef struct pls_frame_column
{
    char name[PLS_NAME_SIZE];
    pls_type type;
    int components;
    size_t rows;
    void *data; ///< packed
} pls_frame_column;

/// Zero-initialise; `pls_frame_free` releases.
typedef struct pls_frame
{
    double time; ///< [s]
    pls_frame_column *column;
    size_t count, capacity;
} pls_frame;

/// Memory rows of a world's bodies and walls, each in order of their numbers. Valid until the world changes; `pls_frame_rows_free` releases.
typedef struct pls_frame_rows
{
    uint32_t *body, *wall;
    size_t body_count, wall_count;
} pls_frame_rows;

pls_status pls_frame_rows_find(pls_frame_rows *rows, pls_world *world);
void pls_frame_rows_free(pls_frame_rows *rows);
/// One field at `count` rows of the world; `column->data` is to be released.
pls_status pls_frame_gather(pls_frame_column *column, const pls_world *world, const char *field, const uint32_t *row, size_t count);
/// The fields of walls that frames hold, ended by null.
extern const char *const pls_frame_wall_fields[];

/// All fields of all bodies of a world, as they are now.
pls_status pls_frame_take(pls_frame *frame, pls_world *world);
/// Read a file written by pls_vtk_write_bodies. NOT_FOUND when there is none, CORRUPT when it is cut off, changed, or another program's.
pls_status pls_frame_read(pls_frame *frame, const char *path);
void pls_frame_free(pls_frame *frame);

/// Null when there is no such column.
const pls_frame_column *pls_frame_find(const pls_frame *frame, const char *name);
/// A number of a column.
double pls_frame_value(const pls_frame_column *column, size_t row, int component);
/// The first three components.
pls_vec3 pls_frame_vector(const pls_frame_column *column, size_t row);

#endif
