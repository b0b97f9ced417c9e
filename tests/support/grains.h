// grains.h -- one shape of each kind, all of about the same size, for worlds of mixed grains.
#ifndef PLS_TESTS_SUPPORT_GRAINS_H
#define PLS_TESTS_SUPPORT_GRAINS_H

#include "support/verify.h"

enum grain_kind {
    GRAIN_BALL,
    GRAIN_ELLIPSOID,
    GRAIN_SUPERQUADRIC,
    GRAIN_CAPSULE,
    GRAIN_SOAP, ///< a rounded box
    GRAIN_BOX,
    GRAIN_STONE, ///< a polyhedron (2D: polygon)
    GRAIN_DUMBBELL,
    GRAIN_CYLINDER, ///< 2D: a rectangle
    GRAIN_PRISM,    ///< 2D: a polygon
    GRAIN_CONE,     ///< known by its signed distance alone
    GRAIN_KINDS,
    GRAIN_QUICK_KINDS = GRAIN_CONE ///< all but the cone, whose contacts take long to find
};

/// Add the shape; its bounding radius is 0.35 to 0.5.
pls_shape_id grain_shape(const verify_scene *scene, enum grain_kind kind);
const char *grain_name(enum grain_kind kind);
/// A body of the kind `kind` at rest, turned at random; `shape` as grain_shape gave it. Different `number`s, different turns.
pls_body_def grain_def(const verify_scene *scene, pls_shape_id shape, uint64_t number, pls_vec3 position);

#endif
