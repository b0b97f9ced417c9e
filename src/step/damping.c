// damping.c -- what takes motion out of a world that is to come to rest: local damping, and adaptive dynamic relaxation. Both work on bodies that are free, axis by axis, and book what they take
// with the dashpots.
//
// Local damping (Cundall 1987): each component of a force loses the part alpha of its size where it speeds the body up, and gains it where it slows it down,
//
//     F_d = -alpha |F| sign(u)
//
// u of the middle of the step; whatever the frequency, an oscillation keeps (1 - alpha)/(1 + alpha) of its energy from one turn to the next.
//
// Relaxation (Underwood 1983; Kilic and Madenci 2010): all velocities decay with the rate c = 2 w, critical for the frequency of the motion that there is, from Rayleigh's quotient of the change of forces,
//
//     w^2 = -sum u . (F(t) - F(t - h)) / (h sum m u^2)        (none where that is negative)
//
// The sum with the old forces is taken at the beginning of the step, where they are known to the last bit; nothing is remembered from step to step.

#include "step/world.h"

#include "base/alloc.h"
#include "base/parallel.h"

#include <string.h>

bool pls_damps(const pls_world *world) { return world->def.local_damping > 0.0 || world->def.relaxation; }

/// Axes of a row that are prescribed.
static unsigned driven_axes(const pls_world *world, uint32_t row)
{
    const uint32_t motion = world->bodies.kind[row].motion;
    return motion > 0 ? world->motion[motion - 1].axes : 0;
}

static bool is_free(const pls_world *world, uint32_t row)
{
    return !(world->bodies.kind[row].flags & PLS_BODY_UNBOUNDED) && world->bodies.load[row].inv_mass > 0.0;
}

/// One component: force, velocity of the end, inverse mass. Returns the work taken.
static double damp_component(double part, double *force, double *velocity, double inverse, double dt)
{
    const double middle = *velocity - 0.5 * dt * inverse * *force;
    const double against = middle > 0.0 ? -part * fabs(*force) : middle < 0.0 ? part * fabs(*force) : 0.0;
    *force += against;
    *velocity += 0.5 * dt * inverse * against;
    return -dt * against * *velocity;
}

static void damp_body(pls_world *world, uint32_t row)
{
    pls_bodies *b = &world->bodies;
    pls_body_load *load = &b->load[row];
    pls_body_place *place = &b->place[row];
    pls_body_spin *spin = &b->spin[row];
    double *force[6] = {&load->fx, &load->fy, &load->fz, &load->tx, &load->ty, &load->tz};
    double *velocity[6] = {&place->vx, &place->vy, &place->vz, &spin->wx, &spin->wy, &spin->wz};
    const unsigned driven = driven_axes(world, row);
    for (unsigned c = 0; c < 6; ++c)
        if (!(driven & 1u << c))
            b->damped[row] +=
                damp_component(world->def.local_damping, force[c], velocity[c], c < 3 ? load->inv_mass : load->inv_inertia, world->dt);
}

void pls_damp_locally(pls_world *world)
{
    if (!(world->def.local_damping > 0.0)) return;
#pragma omp parallel for schedule(static)
    for (size_t row = 0; row < world->bodies.count; ++row)
        if (is_free(world, (uint32_t)row)) damp_body(world, (uint32_t)row);
}

// ---- relaxation ------------------------------------------------------------------------------------------------------------------------------------------

typedef struct pls_quotient quotient;

/// `ahead`: from velocities and forces at the beginning of the step, else from those at its end.
static void add_body(const pls_world *world, uint32_t row, bool ahead, quotient *q)
{
    const pls_bodies *b = &world->bodies;
    const pls_body_load *load = &b->load[row];
    const pls_body_place *place = &b->place[row];
    const pls_body_spin *spin = &b->spin[row];
    const double force[6] = {load->fx, load->fy, load->fz, load->tx, load->ty, load->tz};
    const double velocity[6] = {place->vx, place->vy, place->vz, spin->wx, spin->wy, spin->wz};
    const unsigned driven = driven_axes(world, row);
    for (unsigned c = 0; c < 6; ++c)
    {
        const double inverse = c < 3 ? load->inv_mass : load->inv_inertia;
        if (driven & 1u << c || !(inverse > 0.0)) continue;
        const double u = velocity[c] + (ahead ? 0.5 : -0.5) * world->dt * inverse * force[c];
        q->mass += u * u / inverse;
        q->power += u * force[c];
    }
}

/// In order of numbers, by blocks.
static pls_status sum_quotient(pls_world *world, bool ahead, quotient *total)
{
    const pls_bodies *b = &world->bodies;
    const size_t blocks = pls_block_count(b->numbers, PLS_BLOCK);
    PLS_TRY(pls_reserve(&world->quotient, &world->quotient_capacity, blocks, sizeof *world->quotient, "sums over bodies"));
    quotient *part = world->quotient;
    for (size_t k = 0; k < blocks; ++k) part[k] = (quotient){0.0, 0.0};
#pragma omp parallel for schedule(static)
    for (size_t k = 0; k < blocks; ++k)
        for (size_t n = k * PLS_BLOCK; n < pls_block_end(k, PLS_BLOCK, b->numbers); ++n)
            if (b->row_of[n] != PLS_NO_ROW && is_free(world, b->row_of[n])) add_body(world, b->row_of[n], ahead, &part[k]);
    *total = (quotient){0.0, 0.0};
    for (size_t k = 0; k < blocks; ++k) total->mass += part[k].mass, total->power += part[k].power;
    return PLS_OK;
}

pls_status pls_relax_before(pls_world *world)
{
    if (!world->def.relaxation) return PLS_OK;
    quotient q;
    PLS_TRY(sum_quotient(world, true, &q));
    world->power_before = q.power;
    return PLS_OK;
}

static void slow_body(pls_world *world, uint32_t row, double kept)
{
    pls_bodies *b = &world->bodies;
    pls_body_place *place = &b->place[row];
    pls_body_spin *spin = &b->spin[row];
    const pls_body_orientation *o = &b->orientation[row];
    const pls_body_mass *m = &b->mass[row];
    const pls_vec3 own = pls_rotate_back((pls_quat){o->w, o->x, o->y, o->z}, pls_vec(spin->wx, spin->wy, spin->wz));
    const unsigned driven = driven_axes(world, row);
    double *velocity[6] = {&place->vx, &place->vy, &place->vz, &spin->wx, &spin->wy, &spin->wz};
    double taken = 0.0;
    for (unsigned c = 0; c < 6; ++c)
    {
        if (driven & 1u << c) continue;
        if (c < 3) taken += 0.5 * m->mass * *velocity[c] * *velocity[c];
        *velocity[c] *= kept;
    }
    if (!(driven & (PLS_AXIS_RX | PLS_AXIS_RY | PLS_AXIS_RZ)))
        taken += 0.5 * (m->ix * own.x * own.x + m->iy * own.y * own.y + m->iz * own.z * own.z);
    b->damped[row] += taken * (1.0 - kept * kept);
}

pls_status pls_relax(pls_world *world)
{
    if (!world->def.relaxation) return PLS_OK;
    quotient q;
    PLS_TRY(sum_quotient(world, false, &q));
    const double stiffness = (world->power_before - q.power) / world->dt;
    if (!(q.mass > 0.0) || !(stiffness > 0.0)) return PLS_OK;
    const double w = fmin(sqrt(stiffness / q.mass), 2.0 / world->dt); // no motion of a stable step is faster
    const double kept = exp(-2.0 * w * world->dt);
#pragma omp parallel for schedule(static)
    for (size_t row = 0; row < world->bodies.count; ++row)
        if (is_free(world, (uint32_t)row)) slow_body(world, (uint32_t)row, kept);
    return PLS_OK;
}
