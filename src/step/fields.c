// fields.c -- the tables of fields (DESIGN contract 2): bodies from the list in model/bodies.h, the other tables from here.

#include "contact/pair_list.h"
#include "model/bodies.h"
#include "step/derived.h"
#include "step/world.h"

#include <string.h>

double pls_field_value(const pls_field_view *view, size_t row, int component)
{
    const char *value = (const char *)view->data + row * view->stride;
    switch (view->type)
    {
        case PLS_F64: return ((const double *)value)[component];
        case PLS_F32: return (double)((const float *)value)[component];
        case PLS_U32: return (double)((const uint32_t *)value)[component];
        case PLS_U16: return (double)((const uint16_t *)value)[component];
        case PLS_U8: return (double)((const uint8_t *)value)[component];
    }
    return NAN;
}

size_t pls_type_size(pls_type type)
{
    switch (type)
    {
        case PLS_F64: return 8;
        case PLS_F32: return 4;
        case PLS_U32: return 4;
        case PLS_U16: return 2;
        case PLS_U8: return 1;
    }
    return 0;
}

enum body_columns {
#define COLUMN_NUMBER(type, name) COLUMN_##name,
    PLS_BODY_COLUMNS(COLUMN_NUMBER)
#undef COLUMN_NUMBER
};

#define PERSISTS                                  PLS_FIELD_PERSISTS
#define FRAME                                     PLS_FIELD_FRAME
#define ID                                        PLS_FIELD_ID
#define BONDED                                    PLS_FIELD_BONDED
#define OFFSET_OF(row, member)                    OFFSET_EMPTY_##row(member)
#define OFFSET_EMPTY_double(member)               0
#define OFFSET_EMPTY_float(member)                0
#define OFFSET_EMPTY_pls_body_place(member)       offsetof(pls_body_place, member)
#define OFFSET_EMPTY_pls_body_spin(member)        offsetof(pls_body_spin, member)
#define OFFSET_EMPTY_pls_body_orientation(member) offsetof(pls_body_orientation, member)
#define OFFSET_EMPTY_pls_body_load(member)        offsetof(pls_body_load, member)
#define OFFSET_EMPTY_pls_body_before(member)      offsetof(pls_body_before, member)
#define OFFSET_EMPTY_pls_body_mass(member)        offsetof(pls_body_mass, member)
#define OFFSET_EMPTY_pls_body_kind(member)        offsetof(pls_body_kind, member)

static const pls_field body_fields[] = {
#define BODY_FIELD(name, type, components, flags, unit, column, row, member, meaning) \
    {name, type, components, flags, unit, meaning, COLUMN_##column, OFFSET_OF(row, member)},
    PLS_BODY_FIELDS(BODY_FIELD)
#undef BODY_FIELD
        {"fragment", PLS_U32, 1, PLS_FIELD_DERIVED, "",
         "lowest number of the bodies that bonds hold together with it, its own where none holds it", 0, 0},
    {"temperature", PLS_F64, 1, PLS_FIELD_DERIVED, "K", "of points of bonds with heat, else no number", 0, 0},
    {"plastic_strain", PLS_F64, 1, PLS_FIELD_DERIVED, "",
     "equivalent plastic strain of points of elastic-plastic bonds (of other bond laws the first number they remember of a point), else no "
     "number",
     0, 0},
};

typedef struct pls_remembered remembered;

static const pls_field contact_fields[] = {
    {"body_i", PLS_U32, 1, PERSISTS | ID, "", "number of the body with the lower number (of the body, at a wall)", 0,
     offsetof(remembered, number_i)},
    {"body_j", PLS_U32, 1, PERSISTS | ID, "", "number of its partner (of the wall)", 0, offsetof(remembered, number_j)},
    {"spring", PLS_F64, 3, PERSISTS, "m", "tangential spring", 0, offsetof(remembered, spring)},
    {"history", PLS_F64, PLS_LAW_MAX_HISTORY, PERSISTS, "", "the law's own numbers", 0, offsetof(remembered, history)},
};

static const pls_field pair_fields[] = {
    {"body_i", PLS_U32, 1, PERSISTS | ID, "", "number of the body with the lower number (of the body, at a wall)", 0,
     offsetof(pls_solid_memory, number_i)},
    {"body_j", PLS_U32, 1, PERSISTS | ID, "", "number of its partner (of the wall)", 0, offsetof(pls_solid_memory, number_j)},
    {"part_i", PLS_U32, 1, PERSISTS | ID, "", "part of a compound or a mesh, else 0", 0, offsetof(pls_solid_memory, part_i)},
    {"part_j", PLS_U32, 1, PERSISTS | ID, "", "part of the partner", 0, offsetof(pls_solid_memory, part_j)},
    {"image", PLS_U32, 1, PERSISTS | ID, "", "which periodic image of a wall of pieces: 10 bits for each axis, x first", 0,
     offsetof(pls_solid_memory, image)},
    {"touches", PLS_U32, 1, PERSISTS, "", "0 apart, 1 touches, 2 touches where a deeper contact of the same bodies acts already", 0,
     offsetof(pls_solid_memory, touches)},
    {"spring", PLS_F64, 3, PERSISTS, "m", "tangential spring; along the normal: what turning on an area of touch has loaded", 0,
     offsetof(pls_solid_memory, spring)},
    {"history", PLS_F64, PLS_LAW_MAX_HISTORY, PERSISTS, "", "the law's own numbers", 0, offsetof(pls_solid_memory, history)},
    {"normal", PLS_F64, 3, PERSISTS, "", "at the last step, from i to j", 0, offsetof(pls_solid_memory, normal)},
    {"front", PLS_F64, 1, PERSISTS, "",
     "of a piece of a wall: 1 or -1, the side on which i was when it came, 0 where it does not touch; 2: past the middle of i, which is on "
     "no side",
     0, offsetof(pls_solid_memory, front)},
    {"arm", PLS_F64, 3, PERSISTS, "m", "from the centre of i to where friction acted at the last step", 0, offsetof(pls_solid_memory, arm)},
    {"lever", PLS_F64, 1, PERSISTS, "m", "radius at which turning about the normal slips at the last step, 0: touched at a point", 0,
     offsetof(pls_solid_memory, lever)},
    {"warm_start", PLS_F64, PLS_PAIR_STATE, PERSISTS, "", "what contact detection starts from (narrow_phase.c)", 0,
     offsetof(pls_solid_memory, state)},
};

static const pls_field state_fields[] = {
    {"value", PLS_F64, 1, PERSISTS | ID, "", "values of all states in order of creation", 0, 0},
};

static const pls_field number_fields[] = {
    {"generation", PLS_U32, 1, PERSISTS, "",
     "how often number 0, 1, ... has been given: ids given after a restart are those of an undisturbed run", 0, 0},
};

static const pls_field bond_fields[] = {
    {"broken", PLS_U8, 1, PERSISTS, "", "1 where the bond is broken", 0, 0},
};

static const pls_field point_fields[] = {
    {"energy_broken", PLS_F64, 1, PERSISTS, "J", "energy its bonds held when they broke", 0, 0},
};

static const pls_field memory_fields[] = {
    {"value", PLS_F64, 1, PERSISTS, "", "what the law remembers", 0, 0},
};

static const struct
{
    const char *name;
    const pls_field *field;
    size_t count;
} tables[PLS_TABLE_COUNT] = {
    [PLS_TABLE_BODIES] = {"bodies", body_fields, sizeof body_fields / sizeof body_fields[0]},
    [PLS_TABLE_CONTACTS] = {"contacts", contact_fields, sizeof contact_fields / sizeof contact_fields[0]},
    [PLS_TABLE_STATES] = {"states", state_fields, sizeof state_fields / sizeof state_fields[0]},
    [PLS_TABLE_PAIRS] = {"pairs", pair_fields, sizeof pair_fields / sizeof pair_fields[0]},
    [PLS_TABLE_NUMBERS] = {"numbers", number_fields, sizeof number_fields / sizeof number_fields[0]},
    [PLS_TABLE_BONDS] = {"bonds", bond_fields, sizeof bond_fields / sizeof bond_fields[0]},
    [PLS_TABLE_POINTS] = {"points", point_fields, sizeof point_fields / sizeof point_fields[0]},
    [PLS_TABLE_MEMORY] = {"memory", memory_fields, sizeof memory_fields / sizeof memory_fields[0]},
};

const pls_field *pls_fields(pls_table_kind table, size_t *count)
{
    *count = tables[table].count;
    return tables[table].field;
}

const char *pls_table_name(pls_table_kind table) { return tables[table].name; }

const pls_field *pls_field_find(pls_table_kind table, const char *name)
{
    for (size_t k = 0; k < tables[table].count; ++k)
        if (strcmp(tables[table].field[k].name, name) == 0) return &tables[table].field[k];
    return NULL;
}

pls_status pls_world_body_field(const pls_world *world, const char *name, pls_field_view *view)
{
    const pls_field *field = pls_field_find(PLS_TABLE_BODIES, name);
    if (!field) return pls_fail(PLS_NOT_FOUND, "bodies have no field '%s'", name);
    if (field->flags & PLS_FIELD_DERIVED) return pls_derive_field(world, field, view);
    *view = (pls_field_view){.data = (const char *)pls_bodies_column(&world->bodies, field->column) + field->offset,
                             .stride = pls_bodies_row_size(field->column),
                             .count = world->bodies.count,
                             .type = field->type,
                             .components = field->components};
    return PLS_OK;
}
