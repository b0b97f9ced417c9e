// builtin.h -- the built-in shapes, one file each.
#ifndef PLS_SHAPE_BUILTIN_H
#define PLS_SHAPE_BUILTIN_H

#include <particls/shape.h>

extern const pls_shape_ops pls_sphere_shape, pls_plane_shape, pls_box_shape, pls_capsule_shape, pls_cylinder_shape, pls_ellipsoid_shape,
    pls_superquadric_shape, pls_polyhedron_shape, pls_prism_shape, pls_compound_shape, pls_mesh_shape;
extern const pls_shape_ops pls_disc_shape, pls_half_plane_shape, pls_ellipse_shape, pls_polygon_shape, pls_polyline_shape; // 2D

/// A sphere or disc, whose contacts are found by centre and radius alone: its centre of mass is its middle.
static inline bool pls_shape_is_ball(const pls_shape *shape) { return shape->ops->sdf == pls_sphere_shape.sdf && !shape->uneven; }
/// The shape, or the first of its parts, that is not convex; null if there is none.
static inline const pls_shape *pls_shape_concave_part(const pls_shape *shape)
{
    if (shape->part_count == 0) return shape->convex ? NULL : shape;
    for (size_t k = 0; k < shape->part_count; ++k)
        if (!shape->part[k].shape->convex) return shape->part[k].shape;
    return NULL;
}
/// The lesser of the exponents of a superquadric: far below 1 it is flat at its ends or sides.
double pls_superquadric_exponent(const pls_shape *superquadric);
/// Its longest half axis by its shortest.
double pls_superquadric_aspect(const pls_shape *superquadric);
/// A half-space or half-plane.
static inline bool pls_shape_is_plane(const pls_shape *shape) { return shape->ops->sdf == pls_plane_shape.sdf; }

/// Integrals of (a + |u|)^2 over a disc and a ball of radius r [m^4, m^5]: what the ends and corners of rounded shapes add to a second moment.
static inline double pls_disc_apart(double a, double r) { return r * r * (M_PI * (a * a + 0.25 * r * r) + 8.0 / 3.0 * a * r); }
static inline double pls_ball_apart(double a, double r) { return M_PI * r * r * r * (4.0 / 3.0 * a * a + a * r + 4.0 / 15.0 * r * r); }

#endif
