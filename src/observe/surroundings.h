// surroundings.h -- what observers see of a world: its bodies, its space, and of each body its solid and its potential energy. The only
// place where observers reach into the world itself.
#ifndef PLS_OBSERVE_SURROUNDINGS_H
#define PLS_OBSERVE_SURROUNDINGS_H

#include "model/bodies.h"
#include "model/domain.h"
#include "observe/solid_volume.h"

#include <particls/world.h>

typedef struct pls_surroundings
{
    const pls_world *world;
    const pls_bodies *bodies;
    const pls_domain *domain; ///< edges of now
} pls_surroundings;

pls_surroundings pls_surroundings_of(const pls_world *world);
/// The bounded body in memory row `row` as a solid.
pls_solid pls_surroundings_solid(const pls_surroundings *around, uint32_t row);
/// Energies of bonds by numbers of bodies, in two arrays that the caller releases [J].
pls_status pls_surroundings_bonds(const pls_surroundings *around, double **stored, double **broken);
/// Potential energy of the body in row `row` in all body forces that have one [J].
double pls_surroundings_potential(const pls_surroundings *around, uint32_t row);

#endif
