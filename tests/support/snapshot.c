#include "support/snapshot.h"

#include <stdlib.h>

static size_t bytes_of(const snapshot *copy, int table, const pls_field *field)
{
    return (size_t)copy->header.rows[table] * (size_t)field->components * pls_type_size(field->type);
}

static pls_status take_fields(pls_world *world, snapshot *copy)
{
    for (int table = 0; table < PLS_TABLE_COUNT; ++table)
    {
        size_t count;
        const pls_field *fields = pls_fields((pls_table_kind)table, &count);
        if (count > SNAPSHOT_MAX_FIELDS) return pls_fail(PLS_LIMIT_EXCEEDED, "more than %d fields", SNAPSHOT_MAX_FIELDS);
        for (size_t k = 0; k < count; ++k)
        {
            if (!(fields[k].flags & PLS_FIELD_PERSISTS)) continue;
            copy->data[table][k] = malloc(bytes_of(copy, table, &fields[k]) + 1);
            if (!copy->data[table][k]) return pls_fail(PLS_OUT_OF_MEMORY, "snapshot of a test");
            PLS_TRY(pls_persist_get(world, (pls_table_kind)table, &fields[k], copy->data[table][k]));
        }
    }
    return PLS_OK;
}

pls_status snapshot_take(pls_world *world, snapshot *copy)
{
    PLS_TRY(pls_persist_save_begin(world, &copy->header));
    pls_status status = take_fields(world, copy);
    pls_persist_save_end(world);
    return status;
}

pls_status snapshot_put(pls_world *world, const snapshot *copy)
{
    PLS_TRY(pls_persist_restore_begin(world, &copy->header));
    for (int table = 0; table < PLS_TABLE_COUNT; ++table)
    {
        size_t count;
        const pls_field *fields = pls_fields((pls_table_kind)table, &count);
        for (size_t k = 0; k < count; ++k)
            if (fields[k].flags & PLS_FIELD_PERSISTS)
                PLS_TRY(pls_persist_put(world, (pls_table_kind)table, &fields[k], copy->data[table][k]));
    }
    return pls_persist_restore_end(world);
}

void snapshot_free(snapshot *copy)
{
    for (int table = 0; table < PLS_TABLE_COUNT; ++table)
        for (int k = 0; k < SNAPSHOT_MAX_FIELDS; ++k)
        {
            free(copy->data[table][k]);
            copy->data[table][k] = NULL;
        }
}
