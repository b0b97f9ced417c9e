// two_bodies.c -- two rigid bodies that collide without friction or damping.
//
// Spin is kept as angular momentum, which forces change and free flight does not. Orientation moves by the angular velocity of the middle of the step: second order.

#include "support/two_bodies.h"

two_bodies_body two_bodies_make(const pls_shape *shape, pls_vec3 position, pls_quat orientation)
{
    const bool fixed = shape->ops->unbounded;
    return (two_bodies_body){.shape = shape,
                             .mass = fixed ? INFINITY : shape->mass.volume,
                             .moments = shape->moments,
                             .position = position,
                             .orientation = orientation};
}

pls_posed two_bodies_pose(const two_bodies_body *body) { return pls_pose(body->shape, body->position, body->orientation, 1.0); }

static double over(double spin, double moment) { return moment > 0.0 ? spin / moment : 0.0; }

/// Change of angular velocity by a change of spin.
static pls_vec3 turning(const two_bodies_body *body, pls_quat orientation, pls_vec3 spin)
{
    if (isinf(body->mass)) return pls_vec(0.0, 0.0, 0.0);
    pls_vec3 l = pls_rotate_back(orientation, spin);
    return pls_rotate(orientation, pls_vec(over(l.x, body->moments.x), over(l.y, body->moments.y), over(l.z, body->moments.z)));
}

static pls_vec3 angular_velocity(const two_bodies_body *body, pls_quat orientation) { return turning(body, orientation, body->spin); }

pls_vec3 two_bodies_angular_velocity(const two_bodies_body *body) { return angular_velocity(body, body->orientation); }

/// Turned by w t.
static pls_quat turned(pls_quat q, pls_vec3 w, double t)
{
    double angle = pls_length(w) * t, part = angle > 1e-8 ? sin(0.5 * angle) / pls_length(w) : 0.5 * t;
    return pls_quat_unit(pls_quat_multiply((pls_quat){cos(0.5 * angle), part * w.x, part * w.y, part * w.z}, q));
}

static void drift(two_bodies_body *body, double dt)
{
    body->position = pls_add(body->position, pls_scale(body->velocity, dt));
    pls_quat middle = turned(body->orientation, angular_velocity(body, body->orientation), 0.5 * dt);
    body->orientation = turned(body->orientation, angular_velocity(body, middle), dt);
}

static void push(two_bodies_body *body, pls_vec3 impulse, pls_vec3 point)
{
    if (isinf(body->mass)) return;
    body->velocity = pls_add(body->velocity, pls_scale(impulse, 1.0 / body->mass));
    body->spin = pls_add(body->spin, pls_cross(pls_sub(point, body->position), impulse));
}

static void kick(two_bodies *pair, double dt)
{
    const two_bodies_contact *c = &pair->contact;
    if (!(c->delta > 0.0)) return;
    pls_vec3 impulse = pls_scale(c->normal, pair->stiffness * c->delta * dt);
    push(&pair->body[0], pls_scale(impulse, -1.0), c->point);
    push(&pair->body[1], impulse, c->point);
}

void two_bodies_begin(two_bodies *pair)
{
    pls_posed a = two_bodies_pose(&pair->body[0]), b = two_bodies_pose(&pair->body[1]);
    pair->contact = pair->find(&a, &b, pair->user);
}

void two_bodies_step(two_bodies *pair, double dt)
{
    kick(pair, 0.5 * dt);
    for (int k = 0; k < 2; ++k) drift(&pair->body[k], dt);
    two_bodies_begin(pair);
    kick(pair, 0.5 * dt);
}

double two_bodies_effective_mass(const two_bodies *pair, pls_vec3 point, pls_vec3 n)
{
    double inverse = 0.0;
    for (int k = 0; k < 2; ++k)
    {
        const two_bodies_body *body = &pair->body[k];
        pls_vec3 torque = pls_cross(pls_sub(point, body->position), n);
        inverse += 1.0 / body->mass + pls_dot(torque, turning(body, body->orientation, torque));
    }
    return 1.0 / inverse;
}

double two_bodies_energy(const two_bodies *pair)
{
    double delta = fmax(pair->contact.delta, 0.0), energy = 0.5 * pair->stiffness * delta * delta;
    for (int k = 0; k < 2; ++k)
    {
        const two_bodies_body *body = &pair->body[k];
        if (isinf(body->mass)) continue;
        energy += 0.5 * body->mass * pls_dot(body->velocity, body->velocity) + 0.5 * pls_dot(body->spin, two_bodies_angular_velocity(body));
    }
    return energy;
}
