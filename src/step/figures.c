// figures.c -- energies, momentum, memory: sums over bodies and contacts in order of numbers.

#include "step/world.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "step/contact_view.h"

#include <string.h>

enum {
    KINETIC,
    ROTATION,
    POTENTIAL,
    DAMPED,
    SLID,
    MOMENTUM, ///< three, then three of angular momentum
    SUMS = MOMENTUM + 6
};

static void add_body(const pls_world *world, uint32_t row, double *sum)
{
    const pls_bodies *b = &world->bodies;
    sum[DAMPED] += b->damped[row];
    sum[SLID] += b->slid[row];
    if (b->kind[row].flags & PLS_BODY_UNBOUNDED) return;
    const pls_body_place *p = &b->place[row];
    const pls_body_mass *m = &b->mass[row];
    const pls_body_orientation *o = &b->orientation[row];
    pls_vec3 x = pls_vec(p->x, p->y, p->z), v = pls_vec(p->vx, p->vy, p->vz),
             w = pls_vec(b->spin[row].wx, b->spin[row].wy, b->spin[row].wz);
    pls_quat q = {o->w, o->x, o->y, o->z};
    pls_vec3 own = pls_rotate_back(q, w), turn = pls_vec(m->ix * own.x, m->iy * own.y, m->iz * own.z);
    pls_vec3 momentum = pls_scale(v, m->mass), angular = pls_add(pls_cross(x, momentum), pls_rotate(q, turn));
    sum[KINETIC] += 0.5 * m->mass * pls_dot(v, v);
    sum[ROTATION] += 0.5 * pls_dot(own, turn);
    sum[MOMENTUM] += momentum.x, sum[MOMENTUM + 1] += momentum.y, sum[MOMENTUM + 2] += momentum.z;
    sum[MOMENTUM + 3] += angular.x, sum[MOMENTUM + 4] += angular.y, sum[MOMENTUM + 5] += angular.z;
    sum[POTENTIAL] += pls_force_potential(world, b, row);
}

static pls_status sum_bodies(const pls_world *world, double *total)
{
    size_t blocks = pls_block_count(world->bodies.numbers, PLS_BLOCK);
    double *partial = NULL;
    PLS_TRY(pls_allocate(&partial, blocks * SUMS, sizeof *partial, "sums over bodies"));
#pragma omp parallel for schedule(static)
    for (size_t k = 0; k < blocks; ++k)
        for (size_t n = k * PLS_BLOCK; n < pls_block_end(k, PLS_BLOCK, world->bodies.numbers); ++n)
            if (world->bodies.row_of[n] != PLS_NO_ROW) add_body(world, world->bodies.row_of[n], partial + k * SUMS);
    memset(total, 0, SUMS * sizeof *total);
    for (size_t k = 0; k < blocks; ++k)
        for (int s = 0; s < SUMS; ++s) total[s] += partial[k * SUMS + (size_t)s];
    pls_release(&partial);
    return PLS_OK;
}

pls_status pls_world_get_figures(const pls_world *world, pls_world_figures *f)
{
    double sum[SUMS];
    PLS_TRY(sum_bodies(world, sum));
    *f = (pls_world_figures){.bodies = world->bodies.count,
                             .touching = pls_world_contact_count(world),
                             .listed = world->list.listed + world->solids.count,
                             .list_builds = world->list.builds,
                             .skin = world->tuner.skin,
                             .energy_kinetic = sum[KINETIC],
                             .energy_rotation = sum[ROTATION],
                             .energy_potential = sum[POTENTIAL],
                             .energy_damped = sum[DAMPED],
                             .energy_slid = sum[SLID],
                             .momentum = {sum[MOMENTUM], sum[MOMENTUM + 1], sum[MOMENTUM + 2]},
                             .angular_momentum = {sum[MOMENTUM + 3], sum[MOMENTUM + 4], sum[MOMENTUM + 5]}};
    f->body_bytes = pls_bodies_bytes(&world->bodies) +
                    world->list.reference_capacity * (sizeof *world->list.reference + sizeof *world->list.reference_radius) +
                    (world->list.pairs.start_capacity + world->list.walls.start_capacity) * sizeof(uint32_t);
    f->contact_bytes = pls_pair_list_bytes(&world->list) + world->memory.capacity * sizeof *world->memory.entry +
                       pls_solid_list_bytes(&world->solids) + world->records.capacity * sizeof *world->records.entry;
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        pls_bonds_figures bonds;
        PLS_TRY(pls_world_bonds_figures(world, (pls_bonds_id){(uint16_t)(s + 1)}, &bonds));
        f->energy_bonds += bonds.energy, f->energy_broken += bonds.energy_broken;
        f->bonds += bonds.bonds / 2, f->bonds_broken += bonds.broken / 2, f->bond_bytes += bonds.bytes;
    }
    if (world->memory_holds || !world->prepared) return PLS_OK; // forces of contacts are known after a step only
    pls_contact_view view = {0};
    pls_status status = pls_contact_view_make(world, &view);
    for (size_t k = 0; status == PLS_OK && k < view.count; ++k)
    {
        f->energy_normal += view.entry[k].energy_normal;
        f->energy_shear += view.entry[k].energy_shear;
    }
    pls_contact_view_free(&view);
    return status;
}
