// moving_body -- rigid bodies in free flight and under kicks. Splitting of the rotation: Dullweber, Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840.

#include "support/moving_body.h"

moving_body moving_body_of(const pls_shape *shape)
{
    return (moving_body){.shape = shape, .mass = shape->mass.volume, .moments = shape->moments, .q = pls_quat_identity()};
}

moving_body fixed_body_of(const pls_shape *shape)
{
    return (moving_body){.shape = shape, .fixed = true, .mass = INFINITY, .q = pls_quat_identity()};
}

pls_posed moving_body_pose(const moving_body *body) { return pls_pose(body->shape, body->x, body->q, 1.0); }

static double rate(double momentum, double moment) { return moment > 0.0 ? momentum / moment : 0.0; }

static pls_vec3 own_spin(const moving_body *b)
{
    return pls_vec(rate(b->momentum.x, b->moments.x), rate(b->momentum.y, b->moments.y), rate(b->momentum.z, b->moments.z));
}

pls_vec3 moving_body_spin(const moving_body *body) { return pls_rotate(body->q, own_spin(body)); }

void moving_body_set_spin(moving_body *body, pls_vec3 spin)
{
    pls_vec3 w = pls_rotate_back(body->q, spin);
    body->momentum = pls_vec(body->moments.x * w.x, body->moments.y * w.y, body->moments.z * w.z);
}

pls_vec3 moving_body_velocity_at(const moving_body *body, pls_vec3 point)
{
    return pls_add(body->v, pls_cross(moving_body_spin(body), pls_sub(point, body->x)));
}

double moving_body_energy(const moving_body *body)
{
    if (body->fixed) return 0.0;
    return 0.5 * body->mass * pls_dot(body->v, body->v) + 0.5 * pls_dot(body->momentum, own_spin(body));
}

void moving_body_kick(moving_body *body, pls_vec3 force, pls_vec3 point, double time)
{
    if (body->fixed) return;
    body->v = pls_add(body->v, pls_scale(force, time / body->mass));
    moving_body_twist(body, pls_cross(pls_sub(point, body->x), force), time);
}

void moving_body_twist(moving_body *body, pls_vec3 couple, double time)
{
    if (!body->fixed) body->momentum = pls_add(body->momentum, pls_scale(pls_rotate_back(body->q, couple), time));
}

/// About one principal axis.
static void turn(moving_body *b, pls_vec3 axis, double time)
{
    const double half = 0.5 * time * pls_dot(own_spin(b), axis), s = sin(half);
    const pls_quat r = {cos(half), axis.x * s, axis.y * s, axis.z * s};
    b->q = pls_quat_unit(pls_quat_multiply(b->q, r));
    b->momentum = pls_rotate_back(r, b->momentum);
}

void moving_body_drift(moving_body *body, double time)
{
    if (body->fixed) return;
    body->x = pls_add(body->x, pls_scale(body->v, time));
    turn(body, pls_vec(1.0, 0.0, 0.0), 0.5 * time);
    turn(body, pls_vec(0.0, 1.0, 0.0), 0.5 * time);
    turn(body, pls_vec(0.0, 0.0, 1.0), time);
    turn(body, pls_vec(0.0, 1.0, 0.0), 0.5 * time);
    turn(body, pls_vec(1.0, 0.0, 0.0), 0.5 * time);
}
