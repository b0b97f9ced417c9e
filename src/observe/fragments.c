// fragments.c -- connected components of the bonds that hold, from the lowest number up: the same sums for any order in memory.

#include "observe/fragments.h"

#include "base/alloc.h"
#include "step/bonds.h"

/// By the lowest number of its bodies.
typedef struct fragment
{
    uint64_t bodies;
    double mass;
    pls_vec3 momentum;
} fragment;

static void add_body(const pls_selection *selection, uint32_t row, fragment *f)
{
    const pls_bodies *bodies = selection->around.bodies;
    const pls_body_place *place = &bodies->place[row];
    const double mass = bodies->mass[row].mass;
    ++f->bodies;
    if (!isfinite(mass)) return; // driven
    f->mass += mass;
    f->momentum = pls_add(f->momentum, pls_scale(pls_vec(place->vx, place->vy, place->vz), mass));
}

static void compare(const fragment *f, double *all, pls_fragments *out)
{
    if (f->bodies == 0) return;
    ++out->count;
    out->single += f->bodies == 1;
    *all += f->mass;
    if (out->count > 1) out->second = fmax(out->second, fmin(f->mass, out->largest));
    if (out->count > 1 && !(f->mass > out->largest)) return;
    out->largest = f->mass, out->bodies = f->bodies, out->momentum = f->momentum;
}

pls_status pls_measure_fragments(const pls_selection *selection, pls_fragments *out)
{
    const pls_bodies *bodies = selection->around.bodies;
    uint32_t *of = NULL;
    fragment *list = NULL;
    double all = 0.0;
    *out = (pls_fragments){0};
    PLS_TRY(pls_allocate(&of, bodies->numbers, sizeof *of, "fragments"));
    pls_status status = pls_allocate(&list, bodies->numbers, sizeof *list, "fragments");
    if (status == PLS_OK)
    {
        pls_bonds_fragments(selection->around.world, of);
        for (uint32_t n = 0; n < bodies->numbers; ++n)
        {
            const uint32_t row = bodies->row_of[n];
            if (of[n] != PLS_NO_FRAGMENT && row != PLS_NO_ROW && pls_selection_has_body(selection, row))
                add_body(selection, row, &list[of[n]]);
        }
        for (uint32_t n = 0; n < bodies->numbers; ++n) compare(&list[n], &all, out);
        if (out->count > 0) out->mean = all / (double)out->count;
    }
    pls_release(&list);
    pls_release(&of);
    return status;
}
