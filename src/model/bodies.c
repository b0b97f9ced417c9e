// bodies.c -- storage of bodies, generated from the lists in bodies.h.

#include "model/bodies.h"

#include "base/alloc.h"

#include <string.h>

typedef struct column_info
{
    size_t row_size;
    size_t pointer; ///< offset of the column's pointer in pls_bodies
    const char *name;
} column_info;

static const column_info columns[] = {
#define COLUMN_INFO(type, name) {sizeof(type), offsetof(pls_bodies, name), #name " of bodies"},
    PLS_BODY_COLUMNS(COLUMN_INFO)
#undef COLUMN_INFO
};
enum { COLUMN_COUNT = sizeof columns / sizeof columns[0] };

static void **pointer_to(const pls_bodies *bodies, size_t k) { return (void **)((char *)(uintptr_t)bodies + columns[k].pointer); }

void *pls_bodies_column(const pls_bodies *bodies, int column) { return *pointer_to(bodies, (size_t)column); }
size_t pls_bodies_row_size(int column) { return columns[column].row_size; }

pls_status pls_bodies_reserve(pls_bodies *bodies, size_t count)
{
    if (count > bodies->number_capacity)
    {
        size_t capacity = bodies->number_capacity;
        PLS_TRY(pls_reserve(&bodies->row_of, &capacity, count, sizeof *bodies->row_of, "the rows of body numbers"));
        capacity = bodies->number_capacity;
        PLS_TRY(pls_reserve(&bodies->generation_of, &capacity, count, sizeof *bodies->generation_of, "the generations of body numbers"));
        bodies->number_capacity = capacity;
    }
    if (count <= bodies->capacity) return PLS_OK;
    size_t capacity = 0;
    for (size_t k = 0; k < COLUMN_COUNT; ++k)
    {
        capacity = bodies->capacity;
        PLS_TRY(pls_reserve(pointer_to(bodies, k), &capacity, count, columns[k].row_size, columns[k].name));
    }
    bodies->capacity = capacity;
    return PLS_OK;
}

static uint32_t smallest_free_number(const pls_bodies *bodies)
{
    for (size_t n = 0; bodies->removed && n < bodies->numbers; ++n)
        if (bodies->row_of[n] == PLS_NO_ROW) return (uint32_t)n;
    return (uint32_t)bodies->numbers;
}

pls_status pls_bodies_add(pls_bodies *bodies, uint32_t *row)
{
    uint32_t number = smallest_free_number(bodies);
    uint32_t generation = number < bodies->numbers ? bodies->generation_of[number] + 1 : 1;
    return pls_bodies_add_numbered(bodies, number, generation, row);
}

pls_status pls_bodies_add_numbered(pls_bodies *bodies, uint32_t number, uint32_t generation, uint32_t *row)
{
    size_t needed = (size_t)number + 1 > bodies->count + 1 ? (size_t)number + 1 : bodies->count + 1;
    if (needed >= PLS_NO_ROW) return pls_fail(PLS_LIMIT_EXCEEDED, "a world holds at most %u bodies", PLS_NO_ROW - 1);
    PLS_TRY(pls_bodies_reserve(bodies, needed));
    for (; bodies->numbers <= number; ++bodies->numbers)
    {
        bodies->row_of[bodies->numbers] = PLS_NO_ROW;
        bodies->generation_of[bodies->numbers] = 0;
        ++bodies->removed;
    }
    if (bodies->row_of[number] != PLS_NO_ROW) return pls_fail(PLS_DUPLICATE, "body %u exists already", number);
    --bodies->removed;
    *row = (uint32_t)bodies->count++;
    for (size_t k = 0; k < COLUMN_COUNT; ++k) memset((char *)*pointer_to(bodies, k) + *row * columns[k].row_size, 0, columns[k].row_size);
    bodies->row_of[number] = *row;
    bodies->generation_of[number] = generation;
    bodies->kind[*row].number = number;
    bodies->kind[*row].generation = generation;
    return PLS_OK;
}

void pls_bodies_remove(pls_bodies *bodies, uint32_t row)
{
    uint32_t last = (uint32_t)--bodies->count;
    bodies->row_of[bodies->kind[row].number] = PLS_NO_ROW;
    ++bodies->removed;
    if (row == last) return;
    for (size_t k = 0; k < COLUMN_COUNT; ++k)
    {
        char *data = *pointer_to(bodies, k);
        memcpy(data + row * columns[k].row_size, data + last * columns[k].row_size, columns[k].row_size);
    }
    bodies->row_of[bodies->kind[row].number] = row;
}

pls_status pls_bodies_reorder(pls_bodies *bodies, const uint32_t *old_row)
{
    size_t largest = 0;
    for (size_t k = 0; k < COLUMN_COUNT; ++k)
        if (columns[k].row_size > largest) largest = columns[k].row_size;
    char *scratch = NULL;
    PLS_TRY(pls_allocate(&scratch, bodies->count, largest, "re-ordering bodies"));
    for (size_t k = 0; k < COLUMN_COUNT; ++k)
    {
        size_t size = columns[k].row_size;
        char *data = *pointer_to(bodies, k);
#pragma omp parallel for schedule(static)
        for (size_t row = 0; row < bodies->count; ++row) memcpy(scratch + row * size, data + old_row[row] * size, size);
        memcpy(data, scratch, bodies->count * size);
    }
    pls_release(&scratch);
    for (size_t row = 0; row < bodies->count; ++row) bodies->row_of[bodies->kind[row].number] = (uint32_t)row;
    return PLS_OK;
}

void pls_bodies_clear(pls_bodies *bodies) { bodies->count = bodies->numbers = bodies->removed = 0; }

void pls_bodies_free(pls_bodies *bodies)
{
    for (size_t k = 0; k < COLUMN_COUNT; ++k) pls_release(pointer_to(bodies, k));
    pls_release(&bodies->row_of);
    pls_release(&bodies->generation_of);
    memset(bodies, 0, sizeof *bodies);
}

size_t pls_bodies_bytes(const pls_bodies *bodies)
{
    size_t bytes = bodies->number_capacity * (sizeof *bodies->row_of + sizeof *bodies->generation_of);
    for (size_t k = 0; k < COLUMN_COUNT; ++k) bytes += bodies->capacity * columns[k].row_size;
    return bytes;
}
