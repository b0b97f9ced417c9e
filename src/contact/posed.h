// posed.h -- a shape where a body has it: its SDF and support points in the world.
#ifndef PLS_CONTACT_POSED_H
#define PLS_CONTACT_POSED_H

#include <particls/shape.h>

/// X_world = position + scale R X, X in the shape's own frame.
typedef struct pls_posed
{
    const pls_shape *shape;
    pls_vec3 position; ///< of the shape's origin [m]
    pls_vec3 x, y, z;  ///< the shape's axes in the world: columns of R
    double scale;
    double size; ///< bounding radius, scale included [m]; INFINITY if unbounded
} pls_posed;

/// From a body's centre of mass and orientation (of its principal axes).
static inline pls_posed pls_pose(const pls_shape *shape, pls_vec3 centre, pls_quat orientation, double scale)
{
    pls_quat own = pls_quat_multiply(orientation, pls_quat_conjugate(shape->principal));
    pls_posed p = {.shape = shape, .scale = scale, .size = shape->radius * scale};
    p.x = pls_rotate(own, pls_vec(1.0, 0.0, 0.0));
    p.y = pls_rotate(own, pls_vec(0.0, 1.0, 0.0));
    p.z = pls_rotate(own, pls_vec(0.0, 0.0, 1.0));
    p.position = pls_sub(centre, pls_scale(pls_rotate(own, shape->mass.centre), scale));
    return p;
}

static inline pls_vec3 pls_posed_turn(const pls_posed *p, pls_vec3 a)
{
    return pls_add(pls_add(pls_scale(p->x, a.x), pls_scale(p->y, a.y)), pls_scale(p->z, a.z));
}
static inline pls_vec3 pls_posed_turn_back(const pls_posed *p, pls_vec3 a)
{
    return pls_vec(pls_dot(p->x, a), pls_dot(p->y, a), pls_dot(p->z, a));
}

/// To the shape's frame, lengths included.
static inline pls_vec3 pls_posed_own(const pls_posed *p, pls_vec3 X)
{
    return pls_scale(pls_posed_turn_back(p, pls_sub(X, p->position)), 1.0 / p->scale);
}
static inline pls_vec3 pls_posed_world(const pls_posed *p, pls_vec3 own)
{
    return pls_add(p->position, pls_scale(pls_posed_turn(p, own), p->scale));
}

static inline double pls_posed_sdf(const pls_posed *p, pls_vec3 X) { return p->scale * pls_shape_sdf(p->shape, pls_posed_own(p, X)); }
static inline pls_vec3 pls_posed_gradient(const pls_posed *p, pls_vec3 X)
{
    return pls_posed_turn(p, pls_shape_gradient(p->shape, pls_posed_own(p, X)));
}
/// The point furthest along the unit vector n, margin included.
static inline pls_vec3 pls_posed_support(const pls_posed *p, pls_vec3 n)
{
    return pls_posed_world(p, pls_shape_support(p->shape, pls_posed_turn_back(p, n)));
}

#endif
