// two_bodies.c -- two rigid bodies that collide without friction or damping.

#include "support/two_bodies.h"

moving_body two_bodies_make(const pls_shape *shape, pls_vec3 position, pls_quat orientation)
{
    moving_body body = shape->ops->unbounded ? fixed_body_of(shape) : moving_body_of(shape);
    body.x = position;
    body.q = orientation;
    return body;
}

static void kick(two_bodies *pair, double dt)
{
    const two_bodies_contact *c = &pair->contact;
    if (!(c->delta > 0.0)) return;
    const pls_vec3 force = pls_scale(c->normal, pair->stiffness * c->delta);
    moving_body_kick(&pair->body[0], pls_scale(force, -1.0), c->point, dt);
    moving_body_kick(&pair->body[1], force, c->point, dt);
    moving_body_twist(&pair->body[0], pls_scale(force, -c->twist), dt);
    moving_body_twist(&pair->body[1], pls_scale(force, c->twist), dt);
}

void two_bodies_begin(two_bodies *pair)
{
    pls_posed a = moving_body_pose(&pair->body[0]), b = moving_body_pose(&pair->body[1]);
    pair->contact = pair->find(&a, &b, pair->user);
}

void two_bodies_step(two_bodies *pair, double dt)
{
    kick(pair, 0.5 * dt);
    for (int k = 0; k < 2; ++k) moving_body_drift(&pair->body[k], dt);
    two_bodies_begin(pair);
    kick(pair, 0.5 * dt);
}

double two_bodies_effective_mass(const two_bodies *pair, pls_vec3 point, pls_vec3 n)
{
    double inverse = 0.0; // twice the energy that a push of one unit gives
    for (int k = 0; k < 2; ++k)
    {
        moving_body pushed = pair->body[k];
        pushed.v = pushed.momentum = pls_vec(0.0, 0.0, 0.0);
        moving_body_kick(&pushed, n, point, 1.0);
        inverse += 2.0 * moving_body_energy(&pushed);
    }
    return 1.0 / inverse;
}

double two_bodies_energy(const two_bodies *pair)
{
    const double delta = pair->contact.delta > 0.0 ? pair->contact.energy_delta : 0.0;
    return 0.5 * pair->stiffness * delta * delta + moving_body_energy(&pair->body[0]) + moving_body_energy(&pair->body[1]);
}
