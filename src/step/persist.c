// persist.c -- the world as tables in the order of ids, out and back in, and the state hash made from them.

#include "step/persist.h"

#include "base/alloc.h"
#include "base/hash.h"
#include "step/bonds.h"
#include "step/world.h"

#include <string.h>

/// Contacts in order of numbers: i below j for pairs, the wall second for walls.
static pls_status contact_table(pls_world *world, pls_contact_memory *memory)
{
    if (world->memory_holds)
    {
        PLS_TRY(pls_contact_memory_reserve(memory, world->memory.count));
        if (world->memory.count > 0) memcpy(memory->entry, world->memory.entry, world->memory.count * sizeof *memory->entry);
        memory->count = world->memory.count;
    }
    else if (world->list.count > 0)
        PLS_TRY(pls_pair_list_remember(&world->list, &world->bodies, memory));
    return pls_contact_memory_sort(memory);
}

/// Records of solids in order of numbers.
static pls_status pair_table(const pls_world *world, pls_solid_records *records)
{
    if (world->memory_holds)
    {
        PLS_TRY(pls_solid_records_reserve(records, world->records.count));
        if (world->records.count > 0) memcpy(records->entry, world->records.entry, world->records.count * sizeof *records->entry);
        records->count = world->records.count;
    }
    else
        PLS_TRY(pls_solid_list_remember(&world->solids, records));
    pls_solid_records_sort(records);
    return PLS_OK;
}

/// What is read between pls_persist_save_begin and _end.
typedef struct tables
{
    pls_contact_memory contacts;
    pls_solid_records pairs;
} tables;

static void tables_free(tables *t)
{
    pls_contact_memory_free(&t->contacts);
    pls_solid_records_free(&t->pairs);
}

pls_status pls_persist_save_begin(pls_world *world, pls_persist_header *header)
{
    pls_persist_save_end(world);
    tables *made = NULL;
    PLS_TRY(pls_allocate(&made, 1, sizeof *made, "the table of contacts"));
    pls_status status = contact_table(world, &made->contacts);
    if (status == PLS_OK) status = pair_table(world, &made->pairs);
    if (status != PLS_OK)
    {
        tables_free(made);
        pls_release(&made);
        return status;
    }
    world->persisting = made;
    *header = (pls_persist_header){.step = world->step, .time = world->time, .dt = world->dt, .search = world->solids.counts};
    header->rows[PLS_TABLE_BODIES] = world->bodies.count;
    header->rows[PLS_TABLE_CONTACTS] = made->contacts.count;
    header->rows[PLS_TABLE_PAIRS] = made->pairs.count;
    header->rows[PLS_TABLE_STATES] = world->value_count;
    header->rows[PLS_TABLE_NUMBERS] = world->bodies.numbers;
    header->rows[PLS_TABLE_BONDS] = pls_bonds_count(world);
    header->rows[PLS_TABLE_POINTS] = pls_bonds_points(world);
    header->rows[PLS_TABLE_MEMORY] = pls_bonds_remembered(world);
    return PLS_OK;
}

void pls_persist_save_end(pls_world *world)
{
    tables *made = world->persisting;
    if (!made) return;
    tables_free(made);
    pls_release(&made);
    world->persisting = NULL;
}

pls_status pls_persist_get(pls_world *world, pls_table_kind table, const pls_field *field, void *out)
{
    size_t size = (size_t)field->components * pls_type_size(field->type);
    char *to = out;
    if (table == PLS_TABLE_BODIES)
    {
        const char *column = (const char *)pls_bodies_column(&world->bodies, field->column) + field->offset;
        size_t stride = pls_bodies_row_size(field->column);
        for (size_t n = 0; n < world->bodies.numbers; ++n)
        {
            uint32_t row = world->bodies.row_of[n];
            if (row == PLS_NO_ROW) continue;
            memcpy(to, column + row * stride, size);
            to += size;
        }
        return PLS_OK;
    }
    if (table == PLS_TABLE_STATES)
    {
        if (world->value_count) memcpy(to, world->state_value, world->value_count * sizeof(double));
        return PLS_OK;
    }
    if (table == PLS_TABLE_NUMBERS)
    {
        if (world->bodies.numbers) memcpy(to, world->bodies.generation_of, world->bodies.numbers * size);
        return PLS_OK;
    }
    if (table == PLS_TABLE_BONDS)
    {
        for (size_t s = 0; s < world->bond_count; to += world->bond[s++].family.bonds) pls_bond_read_broken(&world->bond[s], (uint8_t *)to);
        return PLS_OK;
    }
    if (table == PLS_TABLE_POINTS)
    {
        for (size_t s = 0; s < world->bond_count; to += world->bond[s++].family.count * size)
            memcpy(to, world->bond[s].broken, world->bond[s].family.count * size);
        return PLS_OK;
    }
    if (table == PLS_TABLE_MEMORY)
    {
        for (size_t s = 0; s < world->bond_count; to += pls_bond_remembered(&world->bond[s++]) * size)
            pls_bond_read_memory(&world->bond[s], (double *)to);
        return PLS_OK;
    }
    const tables *made = world->persisting;
    if (!made) return pls_fail(PLS_INVALID_ARGUMENT, "the contact tables are read between pls_persist_save_begin and _end");
    if (table == PLS_TABLE_CONTACTS)
        for (size_t k = 0; k < made->contacts.count; ++k)
            memcpy(to + k * size, (const char *)&made->contacts.entry[k] + field->offset, size);
    else
        for (size_t k = 0; k < made->pairs.count; ++k) memcpy(to + k * size, (const char *)&made->pairs.entry[k] + field->offset, size);
    return PLS_OK;
}

// ---- restoring -----------------------------------------------------------------------------------------------------------------------------------------

pls_status pls_persist_restore_begin(pls_world *world, const pls_persist_header *header)
{
    if (header->rows[PLS_TABLE_STATES] != world->value_count)
        return pls_fail(PLS_CORRUPT, "the saved state holds %llu state values, the scene has %zu",
                        (unsigned long long)header->rows[PLS_TABLE_STATES], world->value_count);
    if (header->rows[PLS_TABLE_BONDS] != pls_bonds_count(world) || header->rows[PLS_TABLE_POINTS] != pls_bonds_points(world))
        return pls_fail(PLS_CORRUPT, "the saved state holds %llu bonds of %llu points, the scene has %zu of %zu",
                        (unsigned long long)header->rows[PLS_TABLE_BONDS], (unsigned long long)header->rows[PLS_TABLE_POINTS],
                        pls_bonds_count(world), pls_bonds_points(world));
    if (header->rows[PLS_TABLE_MEMORY] != pls_bonds_remembered(world))
        return pls_fail(PLS_CORRUPT, "the saved state holds %llu numbers that bonds remember, those of the scene remember %zu",
                        (unsigned long long)header->rows[PLS_TABLE_MEMORY], pls_bonds_remembered(world));
    if (header->rows[PLS_TABLE_NUMBERS] >= PLS_NO_ROW || header->rows[PLS_TABLE_BODIES] > header->rows[PLS_TABLE_NUMBERS] ||
        header->rows[PLS_TABLE_CONTACTS] >= PLS_NO_ROW || header->rows[PLS_TABLE_PAIRS] >= PLS_NO_ROW || !(header->dt > 0.0) ||
        !isfinite(header->time))
        return pls_fail(PLS_CORRUPT, "the saved state has an impossible header");
    for (size_t s = 0; s < world->bond_count; ++s)
        if (header->rows[PLS_TABLE_NUMBERS] < world->bond[s].numbers)
            return pls_fail(PLS_CORRUPT, "the saved state knows %llu bodies, bonds '%s' have a body %zu",
                            (unsigned long long)header->rows[PLS_TABLE_NUMBERS], world->bond[s].name, world->bond[s].numbers - 1);
    if (world->bodies.count > 0 && world->extent == 0.0) PLS_TRY(pls_measure_extent(world)); // the first arrangement, not the restored one
    pls_bodies *bodies = &world->bodies;
    pls_bodies_clear(bodies);
    size_t rows = (size_t)header->rows[PLS_TABLE_BODIES], numbers = (size_t)header->rows[PLS_TABLE_NUMBERS];
    PLS_TRY(pls_bodies_reserve(bodies, numbers));
    for (size_t k = 0; k < rows; ++k)
    {
        uint32_t row;
        PLS_TRY(pls_bodies_add_numbered(bodies, (uint32_t)k, 1, &row)); // true numbers follow with the fields
    }
    for (size_t n = rows; n < numbers; ++n) bodies->row_of[n] = PLS_NO_ROW, bodies->generation_of[n] = 0;
    bodies->numbers = numbers;
    bodies->removed = numbers - rows;
    PLS_TRY(pls_contact_memory_reserve(&world->memory, (size_t)header->rows[PLS_TABLE_CONTACTS]));
    world->memory.count = (size_t)header->rows[PLS_TABLE_CONTACTS];
    PLS_TRY(pls_solid_records_reserve(&world->records, (size_t)header->rows[PLS_TABLE_PAIRS]));
    world->records.count = (size_t)header->rows[PLS_TABLE_PAIRS];
    if (world->records.count > 0) memset(world->records.entry, 0, world->records.count * sizeof *world->records.entry);
    world->memory_holds = true;
    world->list.stale = true;
    pls_solid_list_forget(&world->solids);
    world->special_stale = true;
    world->step = header->step;
    world->time = header->time;
    world->dt = header->dt;
    world->solids.counts = header->search;
    return PLS_OK;
}

pls_status pls_persist_put(pls_world *world, pls_table_kind table, const pls_field *field, const void *in)
{
    size_t size = (size_t)field->components * pls_type_size(field->type);
    const char *from = in;
    if (table == PLS_TABLE_BODIES)
    {
        char *column = (char *)pls_bodies_column(&world->bodies, field->column) + field->offset;
        size_t stride = pls_bodies_row_size(field->column);
        for (size_t row = 0; row < world->bodies.count; ++row) memcpy(column + row * stride, from + row * size, size);
    }
    else if (table == PLS_TABLE_STATES)
    {
        if (world->value_count) memcpy(world->state_value, from, world->value_count * sizeof(double));
    }
    else if (table == PLS_TABLE_NUMBERS)
    {
        if (world->bodies.numbers) memcpy(world->bodies.generation_of, from, world->bodies.numbers * size);
    }
    else if (table == PLS_TABLE_BONDS)
    {
        const uint8_t *broken = in;
        for (size_t s = 0; s < world->bond_count; broken += world->bond[s++].family.bonds)
            PLS_TRY(pls_bond_write_broken(&world->bond[s], broken));
    }
    else if (table == PLS_TABLE_POINTS)
        for (size_t s = 0; s < world->bond_count; from += world->bond[s++].family.count * size)
            memcpy(world->bond[s].broken, from, world->bond[s].family.count * size);
    else if (table == PLS_TABLE_MEMORY)
        for (size_t s = 0; s < world->bond_count; from += pls_bond_remembered(&world->bond[s++]) * size)
            pls_bond_write_memory(&world->bond[s], (const double *)from);
    else if (table == PLS_TABLE_CONTACTS)
        for (size_t k = 0; k < world->memory.count; ++k) memcpy((char *)&world->memory.entry[k] + field->offset, from + k * size, size);
    else
        for (size_t k = 0; k < world->records.count; ++k) memcpy((char *)&world->records.entry[k] + field->offset, from + k * size, size);
    return PLS_OK;
}

static pls_status check_body(const pls_world *world, size_t row)
{
    const pls_body_kind *kind = &world->bodies.kind[row];
    const pls_body_place *p = &world->bodies.place[row];
    if (kind->number >= world->bodies.numbers || kind->generation != world->bodies.generation_of[kind->number])
        return pls_fail(PLS_CORRUPT, "saved body %u has a number or generation that was never given", kind->number);
    if (row > 0 && kind->number <= world->bodies.kind[row - 1].number)
        return pls_fail(PLS_CORRUPT, "the saved bodies are not in order of their numbers");
    if (kind->shape >= world->shape_count || kind->material >= world->laws.material_count || kind->group > world->group_count ||
        kind->motion > world->motion_count)
        return pls_fail(PLS_CORRUPT, "saved body %u refers to a shape, material, group or motion that the scene does not have",
                        kind->number);
    if (!isfinite(p->x + p->y + p->z + p->vx + p->vy + p->vz) || !(p->radius > 0.0))
        return pls_fail(PLS_CORRUPT, "saved body %u has a position, velocity or radius that is no number", kind->number);
    return PLS_OK;
}

static uint32_t parts_of(const pls_world *world, uint32_t number)
{
    const pls_bodies *b = &world->bodies;
    if (number >= b->numbers || b->row_of[number] == PLS_NO_ROW) return 0;
    return pls_part_count(world->shape_of[b->kind[b->row_of[number]].shape]);
}

static pls_status check_record(const pls_world *world, const pls_solid_memory *r)
{
    if (r->part_i < parts_of(world, r->number_i) && r->part_j < parts_of(world, r->number_j) && r->touches <= PLS_SOLID_SHADED)
        return PLS_OK;
    return pls_fail(PLS_CORRUPT, "a saved contact joins parts %u of body %u and %u of body %u, which are not there", r->part_i, r->number_i,
                    r->part_j, r->number_j);
}

/// Which row each number has; what was free stays free, with its generation.
static void restore_rows(pls_bodies *bodies)
{
    for (size_t n = 0; n < bodies->numbers; ++n) bodies->row_of[n] = PLS_NO_ROW;
    for (size_t row = 0; row < bodies->count; ++row) bodies->row_of[bodies->kind[row].number] = (uint32_t)row;
}

pls_status pls_persist_restore_end(pls_world *world)
{
    pls_bodies *bodies = &world->bodies;
    for (size_t row = 0; row < bodies->count; ++row) PLS_TRY(check_body(world, row));
    restore_rows(bodies);
    for (size_t k = 0; k < world->memory.count; ++k)
    {
        const struct pls_remembered *entry = &world->memory.entry[k];
        if (entry->number_i >= bodies->numbers || entry->number_j >= bodies->numbers || bodies->row_of[entry->number_i] == PLS_NO_ROW ||
            bodies->row_of[entry->number_j] == PLS_NO_ROW)
            return pls_fail(PLS_CORRUPT, "a saved contact joins bodies %u and %u, which are not there", entry->number_i, entry->number_j);
    }
    for (size_t k = 0; k < world->records.count; ++k) PLS_TRY(check_record(world, &world->records.entry[k]));
    for (size_t s = 0; s < world->bond_count; ++s) PLS_TRY(pls_bond_check_restored(&world->bond[s], bodies));
    for (uint32_t n = 0; world->bond_count > 0 && n < bodies->numbers; ++n) pls_bonds_note_damage(world, n);
    PLS_TRY(pls_bonds_restored(world));
    return pls_world_resume(world);
}

// ---- hash ----------------------------------------------------------------------------------------------------------------------------------------------

static pls_status hash_tables(pls_world *world, const pls_persist_header *header, uint64_t *hash)
{
    for (int table = 0; table < PLS_TABLE_COUNT; ++table)
    {
        size_t fields;
        const pls_field *field = pls_fields((pls_table_kind)table, &fields);
        for (size_t k = 0; k < fields; ++k)
        {
            if (!(field[k].flags & PLS_FIELD_PERSISTS)) continue;
            size_t bytes = (size_t)header->rows[table] * (size_t)field[k].components * pls_type_size(field[k].type);
            char *copy = NULL;
            PLS_TRY(pls_allocate(&copy, bytes, 1, "hashing the state"));
            pls_status status = bytes ? pls_persist_get(world, (pls_table_kind)table, &field[k], copy) : PLS_OK;
            if (status == PLS_OK && bytes) *hash = pls_hash(*hash, copy, bytes);
            pls_release(&copy);
            PLS_TRY(status);
        }
    }
    return PLS_OK;
}

pls_status pls_world_state_hash(pls_world *world, uint64_t *hash)
{
    pls_persist_header header;
    PLS_TRY(pls_persist_save_begin(world, &header));
    *hash = pls_hash(PLS_HASH_START, &header.step, sizeof header.step);
    *hash = pls_hash(*hash, &header.time, sizeof header.time);
    pls_status status = hash_tables(world, &header, hash);
    pls_persist_save_end(world);
    return status;
}
