// info_checkpoint.c -- particls info on a checkpoint: header, tables, each field with its range.

#include "info.h"

#include "base/alloc.h"
#include "io/checkpoint.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static double value_at(const void *data, pls_type type, size_t k)
{
    switch (type)
    {
        case PLS_F64: return ((const double *)data)[k];
        case PLS_F32: return (double)((const float *)data)[k];
        case PLS_U32: return ((const uint32_t *)data)[k];
        case PLS_U16: return ((const uint16_t *)data)[k];
        case PLS_U8: return ((const uint8_t *)data)[k];
    }
    return NAN;
}

/// Range and mean of the finite values of all components; walls have infinite radii.
static void print_range(const pls_field *field, const void *data, size_t count)
{
    double smallest = INFINITY;
    double largest = -INFINITY;
    double sum = 0;
    size_t finite = 0;
    for (size_t k = 0; k < count; ++k)
    {
        double value = value_at(data, field->type, k);
        if (!isfinite(value)) continue;
        smallest = fmin(smallest, value);
        largest = fmax(largest, value);
        sum += value;
        ++finite;
    }
    printf("  %-18s %-12s x %d  ", field->name, field->unit, field->components);
    if (finite > 0) printf("%12.5g %12.5g %12.5g", smallest, largest, sum / (double)finite);
    if (finite < count) printf("  %zu not finite", count - finite);
    printf("\n");
}

static pls_status print_field(const pls_checkpoint *checkpoint, pls_table_kind table, const pls_field *field)
{
    char *data = NULL;
    size_t count = checkpoint->header.rows[table] * (size_t)field->components;
    PLS_TRY(pls_allocate(&data, count, pls_type_size(field->type), "a field of the checkpoint"));
    pls_status status = pls_checkpoint_read_field(checkpoint, table, field, data);
    if (status == PLS_OK) print_range(field, data, count);
    pls_release(&data);
    return status;
}

static pls_status print_table(const pls_checkpoint *checkpoint, pls_table_kind table)
{
    size_t count;
    const pls_field *field = pls_fields(table, &count);
    printf("\n%s: %" PRIu64 " rows\n", pls_table_name(table), checkpoint->header.rows[table]);
    if (checkpoint->header.rows[table] == 0) return PLS_OK;
    printf("  %-18s %-16s  %12s %12s %12s\n", "field", "unit", "smallest", "largest", "mean");
    for (size_t f = 0; f < count; ++f)
    {
        if (field[f].flags & PLS_FIELD_PERSISTS) PLS_TRY(print_field(checkpoint, table, &field[f]));
    }
    return PLS_OK;
}

int info_describe_checkpoint(const char *path)
{
    pls_checkpoint checkpoint = {0};
    if (pls_checkpoint_open(&checkpoint, path) != PLS_OK) return cli_failed(CLI_FAILED);
    const pls_persist_header *header = &checkpoint.header;
    printf("checkpoint         %s\nchecksum           good\nwritten by         particls %s\n", path, checkpoint.version);
    printf("time               %.9g s\nstep               %" PRIu64 "\ntime step          %.9g s\n", header->time, header->step,
           header->dt);
    printf("scene hash         %016" PRIx64 "\nstate hash         %016" PRIx64 "\n", checkpoint.scene_hash, checkpoint.state_hash);
    pls_status status = PLS_OK;
    for (int table = 0; table < PLS_TABLE_COUNT && status == PLS_OK; ++table) status = print_table(&checkpoint, (pls_table_kind)table);
    pls_checkpoint_close(&checkpoint);
    return status == PLS_OK ? CLI_DONE : cli_failed(CLI_FAILED);
}
