// builtin.c -- the list of built-in shapes; a new shape adds one line.

#include "shape/builtin.h"

#include <particls/world.h>

const pls_shape_ops *const *pls_builtin_shapes(void)
{
    static const pls_shape_ops *const shapes[] = {&pls_sphere_shape, &pls_plane_shape, NULL};
    return shapes;
}
