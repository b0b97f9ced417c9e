// moving_body -- a few rigid bodies moved by velocity Verlet, apart from the library's step: to measure what contact forces do to energy.
#ifndef PLS_TEST_MOVING_BODY_H
#define PLS_TEST_MOVING_BODY_H

#include "contact/posed.h"

typedef struct moving_body
{
    const pls_shape *shape;
    bool fixed;
    double mass;
    pls_vec3 moments;  ///< principal
    pls_vec3 x, v;     ///< centre of mass
    pls_quat q;        ///< principal axes to world
    pls_vec3 momentum; ///< angular, in principal axes
} moving_body;

/// Of density 1, at rest at the origin.
moving_body moving_body_of(const pls_shape *shape);
moving_body fixed_body_of(const pls_shape *shape);
pls_posed moving_body_pose(const moving_body *body);
/// In the world.
pls_vec3 moving_body_spin(const moving_body *body);
void moving_body_set_spin(moving_body *body, pls_vec3 spin);
pls_vec3 moving_body_velocity_at(const moving_body *body, pls_vec3 point);
double moving_body_energy(const moving_body *body);

/// A force at a point of the world acts for a time. Fixed bodies stay.
void moving_body_kick(moving_body *body, pls_vec3 force, pls_vec3 point, double time);
/// A couple, in the world.
void moving_body_twist(moving_body *body, pls_vec3 couple, double time);
/// Free flight: exact but for the rotation, which is split into turns about the principal axes (second order, symplectic, |q| = 1).
void moving_body_drift(moving_body *body, double time);

#endif
