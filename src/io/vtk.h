// vtk.h -- frames for ParaView: VTK XML PolyData files (.vtp) and collections of them in time (.pvd).
//
// Arrays lie behind the XML in one appended raw section, each cut into blocks compressed with zlib, sizes as UInt64: the smallest form that every
// reader of the format understands. Files are written atomically.
#ifndef PLS_IO_VTK_H
#define PLS_IO_VTK_H

#include "base/text.h"

#include <particls/observe.h>

/// Parts of a PolyData piece.
typedef enum pls_vtk_section {
    PLS_VTK_POINTS,
    PLS_VTK_POINT_DATA,
    PLS_VTK_CELL_DATA,
    PLS_VTK_VERTICES,
    PLS_VTK_LINES,
    PLS_VTK_FIELD_DATA, ///< of the whole file, of any length
    PLS_VTK_SECTION_COUNT
} pls_vtk_section;

/// A file in the making. Zero-initialise; `pls_vtk_free` releases.
typedef struct pls_vtk
{
    pls_text xml[PLS_VTK_SECTION_COUNT]; ///< the DataArray elements of each part
    pls_text appended;                   ///< compressed arrays
    size_t points, vertices, lines;
} pls_vtk;

/// "Float64"
const char *pls_vtk_type_name(pls_type type);
/// Add an array of `tuples` tuples of `components` numbers, packed.
pls_status pls_vtk_add(pls_vtk *vtk, pls_vtk_section section, const char *name, pls_type type, int components, size_t tuples,
                       const void *data);
/// Make every point a vertex.
pls_status pls_vtk_add_vertices(pls_vtk *vtk, size_t count);
/// Line k joins the points 2 k and 2 k + 1.
pls_status pls_vtk_add_lines(pls_vtk *vtk, size_t count);
pls_status pls_vtk_write(const pls_vtk *vtk, const char *path, double time);
void pls_vtk_free(pls_vtk *vtk);

/// Bodies as points in order of their numbers, with the frame fields of the field table and those `def` asks for. Unbounded bodies (walls) are no
/// points: they stand in the field data (io/frame.h).
/// NOT_FOUND names a field that does not exist.
pls_status pls_vtk_write_bodies(const char *path, pls_world *world, const pls_frames_def *def);
/// Touching contacts as lines from body to body (to the foot point on a wall), across periodic images: body_i, body_j, delta, force on i, normal force.
pls_status pls_vtk_write_contacts(const char *path, pls_world *world);
/// Frames `name`_000000.vtp ... at `times`, as DIR/name.pvd.
pls_status pls_vtk_write_collection(const char *path, const char *name, const double *times, size_t count);

#endif
