// surroundings.c -- see surroundings.h.

#include "observe/surroundings.h"

#include "base/alloc.h"
#include "step/bonds.h"

pls_surroundings pls_surroundings_of(const pls_world *world)
{
    return (pls_surroundings){.world = world, .bodies = &world->bodies, .domain = &world->domain};
}

pls_solid pls_surroundings_solid(const pls_surroundings *around, uint32_t row)
{
    const pls_bodies *bodies = around->bodies;
    const pls_shape *shape = around->world->shape[bodies->kind[row].shape].shape;
    const pls_body_place *place = &bodies->place[row];
    const pls_body_orientation *turned = &bodies->orientation[row];
    const int dimension = around->domain->dimension;
    const double scale = bodies->scale[row];
    return (pls_solid){
        .shape = shape,
        .dimension = dimension,
        .position = pls_vec(place->x, place->y, place->z),
        .orientation = {turned->w, turned->x, turned->y, turned->z},
        .scale = scale,
        .radius = place->radius,
        .volume = shape->volume * scale * scale * (dimension == 3 ? scale : 1),
    };
}

pls_status pls_surroundings_bonds(const pls_surroundings *around, double **stored, double **broken)
{
    *stored = *broken = NULL;
    PLS_TRY(pls_allocate(stored, around->bodies->numbers, sizeof **stored, "energies of bonds"));
    PLS_TRY(pls_allocate(broken, around->bodies->numbers, sizeof **broken, "energies of bonds"));
    pls_bonds_energies(around->world, *stored, *broken);
    return PLS_OK;
}

double pls_surroundings_potential(const pls_surroundings *around, uint32_t row)
{
    return pls_force_potential(around->world, around->bodies, row);
}
