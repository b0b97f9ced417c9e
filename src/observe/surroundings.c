// surroundings.c -- see surroundings.h.

#include "observe/surroundings.h"

#include "step/world.h"

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

double pls_surroundings_potential(const pls_surroundings *around, uint32_t row)
{
    return pls_force_potential(around->world, around->bodies, row);
}
