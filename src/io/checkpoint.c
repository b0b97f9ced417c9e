// checkpoint.c -- see checkpoint.h. Writing: HDF5 makes the file in memory, the seal goes in front, and the bytes are written atomically.

#include "io/checkpoint.h"

#include "base/atomic_file.h"
#include "io/checkpoint_seal.h"
#include "io/hdf5_image.h"
#include "io/hdf5_quiet.h"

#include <stdio.h>
#include <string.h>

// The numbers of the header: X(name in the file, member of pls_persist_header, type in the file, type in memory)
#define HEADER_NUMBERS(X)                                                       \
    X("step", step, H5T_STD_U64LE, H5T_NATIVE_UINT64)                           \
    X("time", time, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE)                          \
    X("dt", dt, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE)                              \
    X("search_queries", search.queries, H5T_STD_U64LE, H5T_NATIVE_UINT64)       \
    X("search_iterations", search.iterations, H5T_STD_U64LE, H5T_NATIVE_UINT64) \
    X("search_restarts", search.restarts, H5T_STD_U64LE, H5T_NATIVE_UINT64)     \
    X("search_fallbacks", search.fallbacks, H5T_STD_U64LE, H5T_NATIVE_UINT64)   \
    X("search_failures", search.failures, H5T_STD_U64LE, H5T_NATIVE_UINT64)

static hid_t file_type(pls_type type)
{
    switch (type)
    {
        case PLS_F64: return H5T_IEEE_F64LE;
        case PLS_F32: return H5T_IEEE_F32LE;
        case PLS_U32: return H5T_STD_U32LE;
        case PLS_U16: return H5T_STD_U16LE;
        case PLS_U8: return H5T_STD_U8LE;
    }
    return H5T_STD_U8LE;
}

static hid_t memory_type(pls_type type)
{
    switch (type)
    {
        case PLS_F64: return H5T_NATIVE_DOUBLE;
        case PLS_F32: return H5T_NATIVE_FLOAT;
        case PLS_U32: return H5T_NATIVE_UINT32;
        case PLS_U16: return H5T_NATIVE_UINT16;
        case PLS_U8: return H5T_NATIVE_UINT8;
    }
    return H5T_NATIVE_UINT8;
}

// ---- writing -------------------------------------------------------------------------------------------------------

static bool write_number(hid_t at, const char *name, hid_t type, hid_t native, const void *value)
{
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    bool good = attribute >= 0 && H5Awrite(attribute, native, value) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return good;
}

static bool write_text(hid_t at, const char *name, const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    size_t length = strlen(text);
    bool good = H5Tset_size(type, length + 1) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0 && write_number(at, name, type, type, text);
    H5Tclose(type);
    return good;
}

/// A dataset of `rows` x `columns` numbers (`columns` 0: a plain list). Returns its handle.
static hid_t write_dataset(hid_t group, const char *name, hid_t type, hid_t native, uint64_t rows, int columns, const void *data)
{
    hsize_t size[2] = {rows, (hsize_t)columns};
    hid_t space = H5Screate_simple(columns > 0 ? 2 : 1, size, NULL);
    hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_obj_track_times(properties, false); // equal states give equal bytes
    hid_t dataset = H5Dcreate2(group, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    if (dataset >= 0 && rows > 0 && H5Dwrite(dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    {
        H5Dclose(dataset);
        dataset = H5I_INVALID_HID;
    }
    H5Pclose(properties);
    H5Sclose(space);
    return dataset;
}

static pls_status write_field(hid_t group, pls_world *world, pls_table_kind table, const pls_field *field, uint64_t rows, const char *path)
{
    char *data = NULL;
    PLS_TRY(pls_allocate(&data, rows, (size_t)field->components * pls_type_size(field->type), "a field of the checkpoint"));
    pls_status status = rows > 0 ? pls_persist_get(world, table, field, data) : PLS_OK;
    if (status == PLS_OK)
    {
        int columns = field->components > 1 ? field->components : 0;
        hid_t dataset = write_dataset(group, field->name, file_type(field->type), memory_type(field->type), rows, columns, data);
        bool good = dataset >= 0 && write_text(dataset, "unit", field->unit) && write_text(dataset, "meaning", field->meaning);
        if (!good) status = pls_hdf5_fail(PLS_IO, "write", path);
        if (dataset >= 0 && H5Dclose(dataset) < 0 && status == PLS_OK) status = pls_hdf5_fail(PLS_IO, "write", path);
    }
    pls_release(&data);
    return status;
}

static pls_status write_table(hid_t file, pls_world *world, pls_table_kind table, uint64_t rows, const char *path)
{
    hid_t properties = H5Pcreate(H5P_GROUP_CREATE);
    H5Pset_obj_track_times(properties, false);
    hid_t group = H5Gcreate2(file, pls_table_name(table), H5P_DEFAULT, properties, H5P_DEFAULT);
    H5Pclose(properties);
    if (group < 0) return pls_hdf5_fail(PLS_IO, "write", path);
    pls_status status = PLS_OK;
    if (!write_number(group, "rows", H5T_STD_U64LE, H5T_NATIVE_UINT64, &rows)) status = pls_hdf5_fail(PLS_IO, "write", path);
    size_t count;
    const pls_field *field = pls_fields(table, &count);
    for (size_t f = 0; f < count && status == PLS_OK; ++f)
    {
        if (field[f].flags & PLS_FIELD_PERSISTS) status = write_field(group, world, table, &field[f], rows, path);
    }
    if (H5Gclose(group) < 0 && status == PLS_OK) status = pls_hdf5_fail(PLS_IO, "write", path);
    return status;
}

static pls_status write_head(hid_t file, const pls_persist_header *header, uint64_t scene_hash, uint64_t state_hash, const char *run,
                             const char *path)
{
    bool good = write_text(file, "particls_version", PLS_VERSION_TEXT) &&
                write_number(file, "scene_hash", H5T_STD_U64LE, H5T_NATIVE_UINT64, &scene_hash) &&
                write_number(file, "state_hash", H5T_STD_U64LE, H5T_NATIVE_UINT64, &state_hash);
#define WRITE_HEADER_NUMBER(name, member, type, native) good = good && write_number(file, name, type, native, &header->member);
    HEADER_NUMBERS(WRITE_HEADER_NUMBER)
#undef WRITE_HEADER_NUMBER
    hid_t dataset = good ? write_dataset(file, "run", H5T_STD_U8LE, H5T_NATIVE_UINT8, strlen(run), 0, run) : H5I_INVALID_HID;
    good = dataset >= 0 && H5Dclose(dataset) >= 0;
    return good ? PLS_OK : pls_hdf5_fail(PLS_IO, "write", path);
}

/// Bytes the file will have, or a little more.
static size_t expected_size(const pls_persist_header *header, const char *run)
{
    static const size_t per_dataset = 2048; // head, name, attributes
    size_t size = 65536 + strlen(run);
    for (int table = 0; table < PLS_TABLE_COUNT; ++table)
    {
        size_t count;
        const pls_field *field = pls_fields((pls_table_kind)table, &count);
        for (size_t f = 0; f < count; ++f)
            size += per_dataset + header->rows[table] * (size_t)field[f].components * pls_type_size(field[f].type);
    }
    return size;
}

static pls_status write_tables(hid_t file, pls_world *world, const pls_persist_header *header, const char *path)
{
    for (int table = 0; table < PLS_TABLE_COUNT; ++table)
        PLS_TRY(write_table(file, world, (pls_table_kind)table, header->rows[table], path));
    return PLS_OK;
}

/// Between save_begin and save_end of the world.
static pls_status fill_image(pls_hdf5_image *image, pls_world *world, const pls_persist_header *header, uint64_t scene_hash,
                             uint64_t state_hash, const char *run, const char *path)
{
    hid_t file = H5I_INVALID_HID;
    pls_status status = pls_hdf5_image_create(image, expected_size(header, run), PLS_SEAL_SIZE, &file);
    if (status == PLS_OK) status = write_head(file, header, scene_hash, state_hash, run, path);
    if (status == PLS_OK) status = write_tables(file, world, header, path);
    if (status == PLS_OK && H5Fflush(file, H5F_SCOPE_GLOBAL) < 0) status = pls_hdf5_fail(PLS_IO, "make", path); // also fixes the size
    if (file >= 0 && H5Fclose(file) < 0 && status == PLS_OK) status = pls_hdf5_fail(PLS_IO, "make", path);
    return status;
}

static pls_status make_image(pls_hdf5_image *image, pls_world *world, uint64_t scene_hash, const char *run, const char *path)
{
    uint64_t state_hash;
    PLS_TRY(pls_world_state_hash(world, &state_hash));
    pls_persist_header header = {0};
    PLS_TRY(pls_persist_save_begin(world, &header));
    pls_hdf5_quiet quiet = pls_hdf5_begin();
    pls_status status = fill_image(image, world, &header, scene_hash, state_hash, run, path);
    pls_hdf5_end(&quiet);
    pls_persist_save_end(world);
    return status;
}

pls_status pls_checkpoint_write(const char *path, pls_world *world, uint64_t scene_hash, const char *run)
{
    pls_hdf5_image image = {0};
    pls_status status = make_image(&image, world, scene_hash, run, path);
    if (status == PLS_OK)
    {
        pls_seal_make(image.data + PLS_SEAL_SIZE, image.size - PLS_SEAL_SIZE, image.data);
        status = pls_write_file(path, image.data, image.size);
    }
    pls_hdf5_image_free(&image);
    return status;
}

// ---- reading -------------------------------------------------------------------------------------------------------

static bool read_number(hid_t at, const char *name, hid_t native, void *value)
{
    hid_t attribute = H5Aopen(at, name, H5P_DEFAULT);
    bool good = attribute >= 0 && H5Aread(attribute, native, value) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    return good;
}

static bool read_text(hid_t at, const char *name, char *text, size_t size)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    bool good = H5Tset_size(type, size) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0 && read_number(at, name, type, text);
    H5Tclose(type);
    text[good ? size - 1 : 0] = '\0';
    return good;
}

static pls_status read_head(pls_checkpoint *checkpoint)
{
    hid_t file = checkpoint->file;
    bool good = read_text(file, "particls_version", checkpoint->version, sizeof checkpoint->version) &&
                read_number(file, "scene_hash", H5T_NATIVE_UINT64, &checkpoint->scene_hash) &&
                read_number(file, "state_hash", H5T_NATIVE_UINT64, &checkpoint->state_hash);
#define READ_HEADER_NUMBER(name, member, type, native) good = good && read_number(file, name, native, &checkpoint->header.member);
    HEADER_NUMBERS(READ_HEADER_NUMBER)
#undef READ_HEADER_NUMBER
    for (int table = 0; table < PLS_TABLE_COUNT && good; ++table)
    {
        hid_t group = H5Gopen2(file, pls_table_name((pls_table_kind)table), H5P_DEFAULT);
        good = group >= 0 && read_number(group, "rows", H5T_NATIVE_UINT64, &checkpoint->header.rows[table]);
        if (group >= 0) H5Gclose(group);
    }
    return good ? PLS_OK : pls_hdf5_fail(PLS_VERSION, "read the header of", checkpoint->path);
}

/// Is the dataset rows x columns (columns 0: a list)?
static bool has_size(hid_t dataset, uint64_t rows, int columns)
{
    hid_t space = H5Dget_space(dataset);
    hsize_t size[2] = {0, 0};
    int dimensions = H5Sget_simple_extent_ndims(space);
    bool good = dimensions == (columns > 0 ? 2 : 1) && H5Sget_simple_extent_dims(space, size, NULL) >= 0;
    H5Sclose(space);
    return good && size[0] == rows && (columns == 0 || size[1] == (hsize_t)columns);
}

static pls_status read_run(pls_checkpoint *checkpoint)
{
    hid_t dataset = H5Dopen2(checkpoint->file, "run", H5P_DEFAULT);
    if (dataset < 0) return pls_hdf5_fail(PLS_VERSION, "read the text of the run in", checkpoint->path);
    hid_t space = H5Dget_space(dataset);
    hssize_t points = H5Sget_simple_extent_npoints(space);
    H5Sclose(space);
    size_t size = points > 0 ? (size_t)points : 0;
    pls_status status = pls_allocate(&checkpoint->run, size + 1, 1, "the text of the run");
    if (status == PLS_OK && size > 0 && H5Dread(dataset, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, checkpoint->run) < 0)
    {
        status = pls_hdf5_fail(PLS_CORRUPT, "read the text of the run in", checkpoint->path);
    }
    H5Dclose(dataset);
    return status;
}

pls_status pls_checkpoint_open(pls_checkpoint *checkpoint, const char *path)
{
    *checkpoint = (pls_checkpoint){.file = H5I_INVALID_HID};
    PLS_TRY(pls_seal_check(path));
    PLS_TRY(pls_copy_text(&checkpoint->path, path, "a file name"));
    pls_hdf5_quiet quiet = pls_hdf5_begin();
    pls_status status = PLS_OK;
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(access, false, true);
    checkpoint->file = H5Fopen(path, H5F_ACC_RDONLY, access);
    H5Pclose(access);
    if (checkpoint->file < 0) status = pls_hdf5_fail(PLS_CORRUPT, "open", path);
    if (status == PLS_OK) status = read_head(checkpoint);
    if (status == PLS_OK) status = read_run(checkpoint);
    pls_hdf5_end(&quiet);
    if (status != PLS_OK) pls_checkpoint_close(checkpoint);
    return status;
}

static pls_status read_dataset(const pls_checkpoint *checkpoint, pls_table_kind table, const pls_field *field, void *out)
{
    char name[160];
    snprintf(name, sizeof name, "%s/%s", pls_table_name(table), field->name);
    hid_t dataset = H5Dopen2(checkpoint->file, name, H5P_DEFAULT);
    if (dataset < 0)
    {
        H5Eclear2(H5E_DEFAULT);
        return pls_fail(PLS_VERSION, "\"%s\" was written by particls %s and does not hold %s, which this particls (%s) needs",
                        checkpoint->path, checkpoint->version, name, PLS_VERSION_TEXT);
    }
    uint64_t rows = checkpoint->header.rows[table];
    hid_t type = H5Dget_type(dataset);
    bool fits = has_size(dataset, rows, field->components > 1 ? field->components : 0) && H5Tequal(type, file_type(field->type)) > 0;
    H5Tclose(type);
    pls_status status = PLS_OK;
    if (!fits)
    {
        status = pls_fail(PLS_VERSION, "\"%s\" was written by particls %s and holds %s in another form than this particls (%s) needs",
                          checkpoint->path, checkpoint->version, name, PLS_VERSION_TEXT);
    }
    else if (rows > 0 && H5Dread(dataset, memory_type(field->type), H5S_ALL, H5S_ALL, H5P_DEFAULT, out) < 0)
    {
        status = pls_hdf5_fail(PLS_CORRUPT, "read", checkpoint->path);
    }
    H5Dclose(dataset);
    return status;
}

pls_status pls_checkpoint_read_field(const pls_checkpoint *checkpoint, pls_table_kind table, const pls_field *field, void *out)
{
    pls_hdf5_quiet quiet = pls_hdf5_begin();
    pls_status status = read_dataset(checkpoint, table, field, out);
    pls_hdf5_end(&quiet);
    return status;
}

static pls_status restore_table(const pls_checkpoint *checkpoint, pls_world *world, pls_table_kind table)
{
    size_t count;
    const pls_field *field = pls_fields(table, &count);
    for (size_t f = 0; f < count; ++f)
    {
        if (!(field[f].flags & PLS_FIELD_PERSISTS)) continue;
        char *data = NULL;
        size_t size = (size_t)field[f].components * pls_type_size(field[f].type);
        PLS_TRY(pls_allocate(&data, checkpoint->header.rows[table], size, "a field of the checkpoint"));
        pls_status status = pls_checkpoint_read_field(checkpoint, table, &field[f], data);
        if (status == PLS_OK) status = pls_persist_put(world, table, &field[f], data);
        pls_release(&data);
        PLS_TRY(status);
    }
    return PLS_OK;
}

pls_status pls_checkpoint_restore(const pls_checkpoint *checkpoint, pls_world *world)
{
    PLS_TRY(pls_persist_restore_begin(world, &checkpoint->header));
    for (int table = 0; table < PLS_TABLE_COUNT; ++table) PLS_TRY(restore_table(checkpoint, world, (pls_table_kind)table));
    PLS_TRY(pls_persist_restore_end(world));
    uint64_t hash;
    PLS_TRY(pls_world_state_hash(world, &hash));
    if (hash == checkpoint->state_hash) return PLS_OK;
    return pls_fail(PLS_CORRUPT,
                    "the state restored from \"%s\" has the hash %016llx, the saved one had %016llx: the scene or the program is not the "
                    "one that wrote it",
                    checkpoint->path, (unsigned long long)hash, (unsigned long long)checkpoint->state_hash);
}

void pls_checkpoint_close(pls_checkpoint *checkpoint)
{
    if (checkpoint->path && checkpoint->file >= 0) H5Fclose(checkpoint->file);
    pls_release(&checkpoint->path);
    pls_release(&checkpoint->run);
    *checkpoint = (pls_checkpoint){.file = H5I_INVALID_HID};
}
