// vtk.c -- the file format: XML in front, compressed arrays behind. What goes into a frame: vtk_frames.c.

#include "io/vtk.h"

#include "base/atomic_file.h"

#include <particls/field.h>
#include <string.h>
#include <zlib.h>

/// Bytes compressed at once. VTK's own default; small enough for readers that stream, large enough to compress.
enum { BLOCK_SIZE = 32768 };

const char *pls_vtk_type_name(pls_type type)
{
    switch (type)
    {
        case PLS_F64: return "Float64";
        case PLS_F32: return "Float32";
        case PLS_U32: return "UInt32";
        case PLS_U16: return "UInt16";
        case PLS_U8: return "UInt8";
    }
    return "UInt8";
}

static pls_status compress_block(pls_text *out, const unsigned char *data, size_t size, uint64_t *packed)
{
    uLongf room = compressBound((uLong)size);
    size_t needed = out->size + room + 1;
    PLS_TRY(pls_reserve(&out->data, &out->capacity, needed, 1, "a compressed frame"));
    if (compress2((Bytef *)out->data + out->size, &room, data, (uLong)size, Z_BEST_SPEED) != Z_OK)
    {
        return pls_fail(PLS_OUT_OF_MEMORY, "cannot compress a frame: zlib found no memory; close other programs or write fewer fields");
    }
    out->size += room;
    *packed = room;
    return PLS_OK;
}

/// One array in VTK's compressed form: number of blocks, block size, size of the last block if it is a partial one, packed size of each block; then the blocks.
static pls_status append_array(pls_text *out, const void *data, size_t size)
{
    uint64_t blocks = (size + BLOCK_SIZE - 1) / BLOCK_SIZE;
    uint64_t head[3] = {blocks, BLOCK_SIZE, size % BLOCK_SIZE};
    PLS_TRY(pls_text_append(out, (const char *)head, sizeof head));
    size_t sizes_at = out->size;
    PLS_TRY(pls_reserve(&out->data, &out->capacity, out->size + blocks * sizeof(uint64_t) + 1, 1, "a compressed frame"));
    out->size += blocks * sizeof(uint64_t);
    for (uint64_t block = 0; block < blocks; ++block)
    {
        size_t start = block * BLOCK_SIZE;
        size_t length = size - start < BLOCK_SIZE ? size - start : BLOCK_SIZE;
        uint64_t packed = 0;
        PLS_TRY(compress_block(out, (const unsigned char *)data + start, length, &packed));
        memcpy(out->data + sizes_at + block * sizeof packed, &packed, sizeof packed);
    }
    return PLS_OK;
}

static pls_status add_escaped(pls_text *xml, const char *text)
{
    for (const char *c = text; *c; ++c)
    {
        switch (*c)
        {
            case '&': PLS_TRY(pls_text_append(xml, "&amp;", 5)); break;
            case '<': PLS_TRY(pls_text_append(xml, "&lt;", 4)); break;
            case '"': PLS_TRY(pls_text_append(xml, "&quot;", 6)); break;
            default: PLS_TRY(pls_text_append(xml, c, 1));
        }
    }
    return PLS_OK;
}

/// Field data belong to no points or cells, so each array tells its own length.
static pls_status add_array(pls_vtk *vtk, pls_vtk_section section, const char *name, const char *type, int components, size_t tuples,
                            size_t size, const void *data)
{
    pls_text *xml = &vtk->xml[section];
    PLS_TRY(pls_text_print(xml, "        <DataArray type=\"%s\" Name=\"", type));
    PLS_TRY(add_escaped(xml, name));
    if (section == PLS_VTK_FIELD_DATA) PLS_TRY(pls_text_print(xml, "\" NumberOfTuples=\"%zu", tuples));
    PLS_TRY(pls_text_print(xml, "\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%zu\"/>\n", components, vtk->appended.size));
    return append_array(&vtk->appended, data, size);
}

pls_status pls_vtk_add(pls_vtk *vtk, pls_vtk_section section, const char *name, pls_type type, int components, size_t tuples,
                       const void *data)
{
    if (section == PLS_VTK_POINTS) vtk->points = tuples;
    return add_array(vtk, section, name, pls_vtk_type_name(type), components, tuples, tuples * (size_t)components * pls_type_size(type),
                     data);
}

/// Cells of `corners` points each, the points in order.
static pls_status add_cells(pls_vtk *vtk, pls_vtk_section section, size_t count, size_t corners)
{
    int64_t *index = NULL;
    PLS_TRY(pls_allocate(&index, count * corners, sizeof *index, "the cells of a frame"));
    for (size_t k = 0; k < count * corners; ++k) index[k] = (int64_t)k;
    pls_status status = add_array(vtk, section, "connectivity", "Int64", 1, count * corners, count * corners * sizeof *index, index);
    for (size_t k = 0; k < count; ++k) index[k] = (int64_t)((k + 1) * corners);
    if (status == PLS_OK) status = add_array(vtk, section, "offsets", "Int64", 1, count, count * sizeof *index, index);
    pls_release(&index);
    return status;
}

pls_status pls_vtk_add_vertices(pls_vtk *vtk, size_t count)
{
    vtk->vertices = count;
    return add_cells(vtk, PLS_VTK_VERTICES, count, 1);
}

pls_status pls_vtk_add_lines(pls_vtk *vtk, size_t count)
{
    vtk->lines = count;
    return add_cells(vtk, PLS_VTK_LINES, count, 2);
}

static pls_status print_file(pls_atomic_file *file, const pls_vtk *vtk, double time)
{
    static const char *const elements[PLS_VTK_SECTION_COUNT] = {"Points", "PointData", "CellData", "Verts", "Lines", "FieldData"};
    char number[32];
    PLS_TRY(pls_atomic_print(
        file,
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
        "compressor=\"vtkZLibDataCompressor\">\n"
        "  <PolyData>\n"
        "    <FieldData>\n"
        "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">%s</DataArray>\n"
        "%s"
        "    </FieldData>\n"
        "    <Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"%zu\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n",
        pls_format_double(number, time), vtk->xml[PLS_VTK_FIELD_DATA].size > 0 ? vtk->xml[PLS_VTK_FIELD_DATA].data : "", vtk->points,
        vtk->vertices, vtk->lines));
    for (int section = 0; section < PLS_VTK_SECTION_COUNT; ++section)
    {
        const pls_text *xml = &vtk->xml[section];
        if (xml->size > 0 && section != PLS_VTK_FIELD_DATA)
            PLS_TRY(pls_atomic_print(file, "      <%s>\n%s      </%s>\n", elements[section], xml->data, elements[section]));
    }
    PLS_TRY(pls_atomic_print(file, "    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_"));
    PLS_TRY(pls_atomic_write(file, vtk->appended.data, vtk->appended.size));
    return pls_atomic_print(file, "\n  </AppendedData>\n</VTKFile>\n");
}

pls_status pls_vtk_write(const pls_vtk *vtk, const char *path, double time)
{
    pls_atomic_file file = {0};
    PLS_TRY(pls_atomic_open(&file, path));
    pls_status status = print_file(&file, vtk, time);
    if (status == PLS_OK) status = pls_atomic_commit(&file);
    pls_atomic_abandon(&file);
    return status;
}

void pls_vtk_free(pls_vtk *vtk)
{
    for (int section = 0; section < PLS_VTK_SECTION_COUNT; ++section) pls_text_free(&vtk->xml[section]);
    pls_text_free(&vtk->appended);
    *vtk = (pls_vtk){0};
}

pls_status pls_vtk_write_collection(const char *path, const char *name, const double *times, size_t count)
{
    pls_text xml = {0};
    pls_status status = pls_text_print(
        &xml, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>\n");
    for (size_t k = 0; k < count && status == PLS_OK; ++k)
    {
        char number[32];
        status = pls_text_print(&xml, "    <DataSet timestep=\"%s\" part=\"0\" file=\"", pls_format_double(number, times[k]));
        if (status == PLS_OK) status = add_escaped(&xml, name);
        if (status == PLS_OK) status = pls_text_print(&xml, "_%06zu.vtp\"/>\n", k);
    }
    if (status == PLS_OK) status = pls_text_print(&xml, "  </Collection>\n</VTKFile>\n");
    if (status == PLS_OK) status = pls_write_file(path, xml.data, xml.size);
    pls_text_free(&xml);
    return status;
}
