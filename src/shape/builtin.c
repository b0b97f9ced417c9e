// builtin.c -- the list of built-in shapes; a new shape adds one line.

#include "shape/builtin.h"

#include <particls/world.h>

const pls_shape_ops *const *pls_builtin_shapes(void)
{
    static const pls_shape_ops *const shapes[] = {&pls_sphere_shape,
                                                  &pls_disc_shape,
                                                  &pls_plane_shape,
                                                  &pls_half_plane_shape,
                                                  &pls_box_shape,
                                                  &pls_capsule_shape,
                                                  &pls_cylinder_shape,
                                                  &pls_ellipsoid_shape,
                                                  &pls_ellipse_shape,
                                                  &pls_superquadric_shape,
                                                  &pls_polyhedron_shape,
                                                  &pls_polygon_shape,
                                                  &pls_prism_shape,
                                                  &pls_compound_shape,
                                                  &pls_mesh_shape,
                                                  &pls_polyline_shape,
                                                  NULL};
    return shapes;
}
