// forces.c -- body forces: the bodies of a block as plain arrays, handed to every force in turn.
//
// A force for one group gets the runs of rows that belong to it, as parts of the same arrays: nothing is copied, and since a force treats each body by itself
// it does not matter how the bodies lie in memory.

#include "step/world.h"

#include "base/alloc.h"

#include <stdio.h>
#include <string.h>

/// Bodies first .. last - 1 of a batch.
static pls_force_batch part_of(const pls_force_batch *all, size_t first, size_t last)
{
    pls_force_batch part = *all;
    part.count = last - first;
    part.x += first, part.y += first, part.z += first;
    part.vx += first, part.vy += first, part.vz += first;
    part.wx += first, part.wy += first, part.wz += first;
    part.mass += first, part.radius += first, part.body += first, part.group += first;
    part.force_x += first, part.force_y += first, part.force_z += first;
    part.torque_x += first, part.torque_y += first, part.torque_z += first;
    return part;
}

static pls_status add_force(const pls_force_instance *force, const pls_force_batch *all)
{
    for (size_t first = 0, last = 0; first < all->count; first = last)
    {
        bool acts = !force->group || all->group[first] == force->group;
        for (last = first + 1; last < all->count && acts == (!force->group || all->group[last] == force->group);) ++last;
        if (!acts) continue;
        pls_force_batch part = part_of(all, first, last);
        part.constants = force->constants;
        PLS_TRY(force->ops->evaluate(force->context, &part));
    }
    return PLS_OK;
}

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
    for (size_t k = 0; k < world->force_count; ++k) PLS_TRY(add_force(&world->force[k], &batch));
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

double pls_force_potential(const pls_world *world, const pls_bodies *bodies, uint32_t row)
{
    const pls_body_place *p = &bodies->place[row];
    const pls_body_kind *kind = &bodies->kind[row];
    pls_force_body body = {.time = world->time,
                           .position = {p->x, p->y, p->z},
                           .mass = bodies->mass[row].mass,
                           .radius = p->radius,
                           .body = kind->number,
                           .group = kind->group};
    double energy = 0.0;
    for (size_t k = 0; k < world->force_count; ++k)
    {
        const pls_force_instance *force = &world->force[k];
        if (!force->ops->potential || (force->group && force->group != kind->group)) continue;
        body.constants = force->constants;
        energy += force->ops->potential(force->context, &body);
    }
    return energy;
}

// ---- adding and changing ---------------------------------------------------------------------------------------------------------------------------------

static const uint32_t force_def_cookie = 0x464f5243;

pls_force_def pls_default_force_def(void) { return (pls_force_def){.cookie = force_def_cookie}; }

static pls_status check_force_def(const pls_world *world, const pls_force_def *def)
{
    const pls_force_ops *ops = def->ops;
    if (def->cookie != force_def_cookie)
        return pls_fail(PLS_INVALID_ARGUMENT, "a force's definition was not made by pls_default_force_def()");
    if (ops->api_version != PLS_API_VERSION)
        return pls_fail(PLS_VERSION, "force '%s' is made for API %u, this library has %d: compile it anew", ops->name, ops->api_version,
                        PLS_API_VERSION);
    if (!ops->evaluate) return pls_fail(PLS_INVALID_ARGUMENT, "force '%s' needs evaluate", ops->name);
    if (pls_parameter_values(ops->parameters) > PLS_MAX_VALUES)
        return pls_fail(PLS_LIMIT_EXCEEDED, "force '%s' has more than %d values", ops->name, PLS_MAX_VALUES);
    if (def->group.index1 > world->group_count) return pls_fail(PLS_INVALID_ARGUMENT, "the group of force '%s' does not exist", ops->name);
    return PLS_OK;
}

static pls_status prepare_force(const pls_world *world, pls_force_instance *force)
{
    char owner[PLS_NAME_SIZE + 16];
    snprintf(owner, sizeof owner, "force '%.63s'", force->ops->name);
    PLS_TRY(pls_parameters_check(force->ops->parameters, force->values, owner));
    double constants[PLS_MAX_VALUES] = {0.0}; // those of now stay when it refuses
    if (force->ops->prepare)
        PLS_TRY(force->ops->prepare(force->values, world->def.dimension, constants));
    else
        memcpy(constants, force->values, sizeof constants);
    memcpy(force->constants, constants, sizeof constants);
    return PLS_OK;
}

static pls_status add_force_def(pls_world *world, const pls_force_def *def)
{
    PLS_TRY(check_force_def(world, def));
    PLS_TRY(pls_reserve(&world->force, &world->force_capacity, world->force_count + 1, sizeof *world->force, "body forces"));
    pls_force_instance *force = &world->force[world->force_count];
    *force = (pls_force_instance){.ops = def->ops, .context = def->context, .group = def->group.index1};
    size_t count = (size_t)pls_parameter_values(def->ops->parameters);
    if (def->values && count > 0)
        memcpy(force->values, def->values, count * sizeof *force->values);
    else
        pls_parameters_default(def->ops->parameters, force->values);
    return prepare_force(world, force);
}

pls_status pls_world_add_force(pls_world *world, const pls_force_def *def, pls_force_id *id)
{
    *id = (pls_force_id){0};
    if (!def->ops) return pls_fail(PLS_INVALID_ARGUMENT, "a force needs its operations");
    pls_status status = add_force_def(world, def);
    if (status == PLS_OK)
        id->index1 = (uint32_t)++world->force_count;
    else if (def->ops->destroy)
        def->ops->destroy(def->context);
    return status;
}

pls_status pls_find_force_parameter(const pls_world *world, pls_force_id force, const char *name, int *place)
{
    if (force.index1 < 1 || force.index1 > world->force_count)
        return pls_fail(PLS_INVALID_ARGUMENT, "there is no such force in this world");
    const pls_force_ops *ops = world->force[force.index1 - 1].ops;
    *place = pls_parameter_find(ops->parameters, name);
    return *place >= 0 ? PLS_OK : pls_fail(PLS_NOT_FOUND, "force '%s' has no parameter '%s'", ops->name, name);
}

pls_status pls_world_set_force_parameter(pls_world *world, pls_force_id id, const char *name, double value)
{
    int place;
    PLS_TRY(pls_find_force_parameter(world, id, name, &place));
    pls_force_instance *force = &world->force[id.index1 - 1];
    double before = force->values[place];
    force->values[place] = value;
    pls_status status = prepare_force(world, force);
    if (status != PLS_OK) force->values[place] = before;
    return status;
}

// ---- uniform gravity -------------------------------------------------------------------------------------------------------------------------------------

static const pls_parameter gravity_parameters[] = {
    {.name = "acceleration",
     .unit = "m/s^2",
     .meaning = "of free fall",
     .initial = PLS_REQUIRED,
     .minimum = -INFINITY,
     .maximum = INFINITY,
     .components = 3},
    {.name = NULL},
};

static pls_status gravity_evaluate(void *context, const pls_force_batch *b)
{
    (void)context;
    const double gx = b->constants[0], gy = b->constants[1], gz = b->constants[2];
    for (size_t k = 0; k < b->count; ++k)
    {
        b->force_x[k] += b->mass[k] * gx;
        b->force_y[k] += b->mass[k] * gy;
        b->force_z[k] += b->mass[k] * gz;
    }
    return PLS_OK;
}

static double gravity_potential(void *context, const pls_force_body *body)
{
    (void)context;
    const double *g = body->constants;
    return -body->mass * pls_dot(pls_vec(g[0], g[1], g[2]), body->position);
}

static const pls_force_ops gravity_ops = {
    .api_version = PLS_API_VERSION,
    .name = "gravity",
    .meaning = "uniform gravity",
    .parameters = gravity_parameters,
    .evaluate = gravity_evaluate,
    .potential = gravity_potential,
};

pls_status pls_world_add_gravity(pls_world *world, pls_vec3 gravity)
{
    if (!isfinite(gravity.x + gravity.y + gravity.z)) return pls_fail(PLS_INVALID_ARGUMENT, "gravity is not finite");
    const double values[] = {gravity.x, gravity.y, gravity.z};
    pls_force_def def = pls_default_force_def();
    def.ops = &gravity_ops;
    def.values = values;
    pls_force_id id;
    return pls_world_add_force(world, &def, &id);
}
