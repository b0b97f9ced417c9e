// two_bodies.h -- two rigid bodies that collide without friction or damping: what a way of finding contacts does to energy.
//
// Velocity Verlet apart from the library's step (moving_body): any change of energy beyond its second-order error is the contact's.
#ifndef PLS_TESTS_SUPPORT_TWO_BODIES_H
#define PLS_TESTS_SUPPORT_TWO_BODIES_H

#include "support/moving_body.h"

typedef struct two_bodies_contact
{
    double delta;        ///< the force by the stiffness, > 0: overlapping [m]
    double energy_delta; ///< k times half its square is the energy [m]
    double twist;        ///< couple about the normal, by the force [m]
    pls_vec3 normal;     ///< from A to B
    pls_vec3 point;      ///< where the force acts
} two_bodies_contact;

typedef two_bodies_contact two_bodies_finder(const pls_posed *a, const pls_posed *b, void *user);

typedef struct two_bodies
{
    moving_body body[2];
    double stiffness;
    two_bodies_finder *find;
    void *user;
    two_bodies_contact contact; ///< as of now
} two_bodies;

/// Of density 1, at rest; of an unbounded shape: one that does not move.
moving_body two_bodies_make(const pls_shape *shape, pls_vec3 position, pls_quat orientation);
/// Find the contact where the bodies are; before the first step.
void two_bodies_begin(two_bodies *pair);
void two_bodies_step(two_bodies *pair, double dt);
/// Mass that a push at `point` along the unit vector n moves.
double two_bodies_effective_mass(const two_bodies *pair, pls_vec3 point, pls_vec3 n);
/// Kinetic, with that of the spring.
double two_bodies_energy(const two_bodies *pair);

#endif
