// solid_volume.h -- how much of a grain lies in a box, for any shape.
#ifndef PLS_OBSERVE_SOLID_VOLUME_H
#define PLS_OBSERVE_SOLID_VOLUME_H

#include <particls/shape.h>

/// A grain in the world.
typedef struct pls_solid
{
    const pls_shape *shape;
    int dimension;
    pls_vec3 position;    ///< [m]
    pls_quat orientation; ///< grain frame to world
    double scale;         ///< of the shape's lengths
    double radius;        ///< bounding radius, scale included [m]
    double volume;        ///< scale included [m^3], 2D: area [m^2]
} pls_solid;

/// Part of the volume (2D: area) that lies in the box `lower`..`upper`: exact when the bounding sphere lies wholly inside or wholly
/// outside and for balls and discs that no edge of the box passes through, otherwise within 1e-3 of the whole volume.
double pls_solid_volume_in_box(const pls_solid *solid, pls_vec3 lower, pls_vec3 upper);

#endif
