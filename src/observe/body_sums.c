// body_sums.c -- sums over the bodies of a collection: energies, momentum, solid volume, bounding box.

#include "observe/sums.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "observe/solid_volume.h"

static pls_body_sums nothing(void)
{
    pls_body_sums sums = {0};
    for (int axis = 0; axis < 3; ++axis)
    {
        sums.lower[axis] = INFINITY;
        sums.upper[axis] = -INFINITY;
    }
    return sums;
}

static void combine(pls_body_sums *to, const pls_body_sums *from)
{
    to->bounded += from->bounded;
    to->mass += from->mass;
    to->kinetic += from->kinetic;
    to->rotation += from->rotation;
    to->potential += from->potential;
    to->damped += from->damped;
    to->slid += from->slid;
    to->bonds += from->bonds;
    to->broken += from->broken;
    to->solid += from->solid;
    for (int axis = 0; axis < 3; ++axis)
    {
        to->momentum[axis] += from->momentum[axis];
        to->angular_momentum[axis] += from->angular_momentum[axis];
        to->lower[axis] = fmin(to->lower[axis], from->lower[axis]);
        to->upper[axis] = fmax(to->upper[axis], from->upper[axis]);
    }
}

static void add_vector(double to[3], pls_vec3 a)
{
    to[0] += a.x;
    to[1] += a.y;
    to[2] += a.z;
}

static void add_motion(const pls_selection *selection, uint32_t row, pls_body_sums *sums)
{
    const pls_bodies *bodies = selection->around.bodies;
    const pls_body_mass *mass = &bodies->mass[row];
    if (!isfinite(mass->mass)) return;
    const pls_body_place *place = &bodies->place[row];
    const pls_body_spin *spin = &bodies->spin[row];
    const pls_body_orientation *turned = &bodies->orientation[row];
    pls_quat q = {turned->w, turned->x, turned->y, turned->z};
    pls_vec3 position = pls_vec(place->x, place->y, place->z);
    pls_vec3 velocity = pls_vec(place->vx, place->vy, place->vz);
    pls_vec3 momentum = pls_scale(velocity, mass->mass);
    pls_vec3 w = pls_rotate_back(q, pls_vec(spin->wx, spin->wy, spin->wz));
    pls_vec3 spin_momentum = pls_vec(mass->ix * w.x, mass->iy * w.y, mass->iz * w.z);

    sums->mass += mass->mass;
    sums->kinetic += pls_dot(momentum, velocity) / 2;
    sums->rotation += pls_dot(spin_momentum, w) / 2;
    sums->potential += pls_surroundings_potential(&selection->around, row);
    add_vector(sums->momentum, momentum);
    add_vector(sums->angular_momentum, pls_add(pls_cross(position, momentum), pls_rotate(q, spin_momentum)));
}

static void add_bounds(const pls_body_place *place, pls_body_sums *sums)
{
    const double x[3] = {place->x, place->y, place->z};
    for (int axis = 0; axis < 3; ++axis)
    {
        sums->lower[axis] = fmin(sums->lower[axis], x[axis] - place->radius);
        sums->upper[axis] = fmax(sums->upper[axis], x[axis] + place->radius);
    }
}

/// Volume of all periodic images of the solid within the box. Images lie at most one period from the one whose centre is nearest to the
/// lower corner.
static double images_in_box(const pls_selection *selection, pls_solid solid)
{
    const pls_domain *domain = selection->around.domain;
    const double x[3] = {solid.position.x, solid.position.y, solid.position.z};
    const double corner[3] = {selection->lower.x, selection->lower.y, selection->lower.z};
    double first[3];
    int images[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        images[axis] = domain->periodic[axis] ? 3 : 1;
        first[axis] = x[axis];
        if (domain->periodic[axis]) first[axis] -= domain->edge[axis] * (floor((x[axis] - corner[axis]) / domain->edge[axis]) + 1);
    }
    double volume = 0;
    for (int k = 0; k < images[0] * images[1] * images[2]; ++k)
    {
        solid.position.x = first[0] + domain->edge[0] * (k % images[0]);
        solid.position.y = first[1] + domain->edge[1] * (k / images[0] % images[1]);
        solid.position.z = first[2] + domain->edge[2] * (k / images[0] / images[1]);
        volume += pls_solid_volume_in_box(&solid, selection->lower, selection->upper);
    }
    return volume;
}

static double solid_volume(const pls_selection *selection, uint32_t row)
{
    pls_solid solid = pls_surroundings_solid(&selection->around, row);
    double volume = selection->box ? images_in_box(selection, solid) : solid.volume;
    return solid.dimension == 2 ? volume * selection->around.domain->thickness : volume;
}

static void add_body(const pls_selection *selection, uint32_t row, bool with_solid, pls_body_sums *sums)
{
    const pls_bodies *bodies = selection->around.bodies;
    bool bounded = !(bodies->kind[row].flags & PLS_BODY_UNBOUNDED);
    bool of_group = selection->group == 0 || bodies->kind[row].group == selection->group;
    if (with_solid && bounded && of_group) sums->solid += solid_volume(selection, row); // also of bodies that only reach into the box
    if (!pls_selection_has_body(selection, row)) return;
    sums->damped += bodies->damped[row];
    sums->slid += bodies->slid[row];
    if (!bounded) return;
    sums->bounded += 1;
    if (selection->bonds)
    {
        sums->bonds += selection->bonds->stored[bodies->kind[row].number];
        sums->broken += selection->bonds->broken[bodies->kind[row].number];
    }
    add_motion(selection, row, sums);
    add_bounds(&bodies->place[row], sums);
}

pls_status pls_sum_bodies(const pls_selection *selection, bool with_solid, pls_body_sums *sums)
{
    const pls_bodies *bodies = selection->around.bodies;
    const size_t blocks = pls_block_count(bodies->numbers, PLS_BLOCK);
    pls_body_sums *part = NULL;
    *sums = nothing();
    PLS_TRY(pls_allocate(&part, blocks, sizeof *part, "sums over blocks of bodies"));
#pragma omp parallel for schedule(dynamic)
    for (size_t block = 0; block < blocks; ++block)
    {
        pls_body_sums here = nothing();
        for (size_t number = block * PLS_BLOCK; number < pls_block_end(block, PLS_BLOCK, bodies->numbers); ++number)
        {
            if (bodies->row_of[number] != PLS_NO_ROW) add_body(selection, bodies->row_of[number], with_solid, &here);
        }
        part[block] = here;
    }
    for (size_t block = 0; block < blocks; ++block) combine(sums, &part[block]);
    pls_release(&part);
    return PLS_OK;
}
