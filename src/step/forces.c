// forces.c -- body forces: the bodies of a block as plain arrays, handed to every force in turn.

#include "step/world.h"

#include "base/alloc.h"

#include <string.h>

pls_status pls_body_forces(const pls_world *world, size_t first, size_t last, double time, double *scratch, double *force, double *torque)
{
    enum { X, Y, Z, VX, VY, VZ, WX, WY, WZ, MASS, RADIUS, INPUTS };
    size_t n = last - first;
    double *in[INPUTS], *out[6];
    for (int k = 0; k < INPUTS; ++k) in[k] = scratch + k * PLS_FORCE_BATCH;
    uint32_t body[PLS_FORCE_BATCH] __attribute__((aligned(64))), group[PLS_FORCE_BATCH] __attribute__((aligned(64)));
    for (int k = 0; k < 6; ++k) out[k] = scratch + (INPUTS + k) * PLS_FORCE_BATCH;
    for (size_t m = 0; m < n; ++m)
    {
        const pls_body_place *p = &world->bodies.place[first + m];
        const pls_body_spin *s = &world->bodies.spin[first + m];
        const pls_body_kind *kind = &world->bodies.kind[first + m];
        in[X][m] = p->x, in[Y][m] = p->y, in[Z][m] = p->z;
        in[VX][m] = p->vx + s->lead_x, in[VY][m] = p->vy + s->lead_y, in[VZ][m] = p->vz + p->lead_z;
        in[WX][m] = s->end_x, in[WY][m] = s->end_y, in[WZ][m] = s->end_z, in[MASS][m] = world->bodies.mass[first + m].mass,
        in[RADIUS][m] = p->radius;
        body[m] = kind->number, group[m] = kind->group;
    }
    for (int k = 0; k < 6; ++k) memset(out[k], 0, n * sizeof(double));
    const pls_force_batch batch = {.count = n,
                                   .time = time,
                                   .x = in[X],
                                   .y = in[Y],
                                   .z = in[Z],
                                   .vx = in[VX],
                                   .vy = in[VY],
                                   .vz = in[VZ],
                                   .wx = in[WX],
                                   .wy = in[WY],
                                   .wz = in[WZ],
                                   .mass = in[MASS],
                                   .radius = in[RADIUS],
                                   .body = body,
                                   .group = group,
                                   .force_x = out[0],
                                   .force_y = out[1],
                                   .force_z = out[2],
                                   .torque_x = out[3],
                                   .torque_y = out[4],
                                   .torque_z = out[5]};
    for (size_t k = 0; k < world->force_count; ++k) PLS_TRY(world->force[k].ops->evaluate(world->force[k].context, &batch));
    bool plane = world->def.dimension == 2;
    for (size_t m = 0; m < n; ++m)
    {
        bool unbounded = (world->bodies.kind[first + m].flags & PLS_BODY_UNBOUNDED) != 0; // its mass is infinite, and so might its force be
        double *f = force + 4 * m, *t = torque + 4 * m;
        for (int a = 0; a < 3; ++a)
        {
            f[a] = unbounded || (plane && a == 2) ? 0.0 : out[a][m];
            t[a] = unbounded || (plane && a != 2) ? 0.0 : out[3 + a][m];
        }
        f[3] = t[3] = 0.0;
    }
    return PLS_OK;
}

// ---- uniform gravity -----------------------------------------------------------------------------------------------------------------------------------

static pls_status gravity_evaluate(void *context, const pls_force_batch *b)
{
    const pls_vec3 *g = context;
    for (size_t k = 0; k < b->count; ++k)
    {
        b->force_x[k] += b->mass[k] * g->x;
        b->force_y[k] += b->mass[k] * g->y;
        b->force_z[k] += b->mass[k] * g->z;
    }
    return PLS_OK;
}

static double gravity_potential(void *context, double time, pls_vec3 position, double mass)
{
    (void)time;
    return -mass * pls_dot(*(const pls_vec3 *)context, position);
}

static void gravity_destroy(void *context) { pls_release(&context); }

static const pls_force_ops gravity_ops = {
    .api_version = PLS_API_VERSION,
    .name = "gravity",
    .meaning = "uniform gravity",
    .evaluate = gravity_evaluate,
    .potential = gravity_potential,
    .destroy = gravity_destroy,
};

pls_status pls_world_add_gravity(pls_world *world, pls_vec3 gravity)
{
    if (!isfinite(gravity.x + gravity.y + gravity.z)) return pls_fail(PLS_INVALID_ARGUMENT, "gravity is not finite");
    pls_vec3 *context = NULL;
    PLS_TRY(pls_allocate(&context, 1, sizeof *context, "gravity"));
    *context = gravity;
    return pls_world_add_force(world, &gravity_ops, context);
}
