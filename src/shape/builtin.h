// builtin.h -- the built-in shapes, one file each.
#ifndef PLS_SHAPE_BUILTIN_H
#define PLS_SHAPE_BUILTIN_H

#include <particls/shape.h>

extern const pls_shape_ops pls_sphere_shape, pls_plane_shape;

#endif
