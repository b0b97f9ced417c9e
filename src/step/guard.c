// guard.c -- what stops a run: numbers that are none, bodies that flew away, overlaps that no contact law is made for.
//
// A look at all contacts also tells how much nearer bodies would have to come for the next one to find anything. Until they can have moved so far
// (world->path), it would find nothing, and is left out.

#include "contact/wall_groups.h"
#include "step/world.h"

#include "base/parallel.h"

static const double far_away = 1000.0; ///< sizes of the first arrangement; who goes further is lost
static const double surely = 0.99;     ///< of the room that is left: sums of many steps are rounded

pls_status pls_guard_finite(pls_world *world)
{
    const pls_bodies *b = &world->bodies;
    for (uint32_t number = 0; number < b->numbers; ++number)
    {
        uint32_t row = b->row_of[number];
        if (row == PLS_NO_ROW) continue;
        const pls_body_place *p = &b->place[row];
        const pls_body_spin *s = &b->spin[row];
        if (isfinite(p->x + p->y + p->z) && isfinite(p->vx + p->vy + p->vz) && isfinite(s->wx + s->wy + s->wz)) continue;
        return pls_fail(PLS_NOT_A_NUMBER,
                        "body %u of '%s' has position (%g, %g, %g) m, velocity (%g, %g, %g) m/s, spin (%g, %g, %g) rad/s at t = %g s, step "
                        "%llu. Likely causes: a time step too "
                        "large for the contacts, two bodies at the same place, or a force or law that divides by zero",
                        number, pls_world_group_name(world, (pls_group_id){b->kind[row].group}), p->x, p->y, p->z, p->vx, p->vy, p->vz,
                        s->wx, s->wy, s->wz, world->time, (unsigned long long)world->step);
    }
    return PLS_OK;
}

static pls_status overlap_failure(const pls_world *world, uint32_t i, uint32_t j, double delta, double radius)
{
    const pls_bodies *b = &world->bodies;
    return pls_fail(
        PLS_RUNAWAY_OVERLAP,
        "bodies %u of '%s' and %u of '%s' overlap by %g m at t = %g s, step %llu: that is %.3g of the smaller radius %g m, and max_overlap "
        "is %g. Likely causes: bodies "
        "placed into each other, contacts too soft for the load, or a time step too large. Mend that, or raise guard.max_overlap",
        b->kind[i].number, pls_world_group_name(world, (pls_group_id){b->kind[i].group}), b->kind[j].number,
        pls_world_group_name(world, (pls_group_id){b->kind[j].group}), delta, world->time, (unsigned long long)world->step, delta / radius,
        radius, world->def.max_overlap);
}

/// Overlap of a touching candidate and the smaller radius; n: of the section's wall.
static inline double overlap_of(const pls_world *world, const pls_pair_section *section, pls_vec3 n, size_t c, double *radius)
{
    const pls_pair_list *list = &world->list;
    const pls_body_place *p = &world->bodies.place[list->row_i[c]], *q = &world->bodies.place[list->row_j[c]];
    double d[3] = {q->x - p->x, q->y - p->y, q->z - p->z};
    *radius = section->wall || p->radius < q->radius ? p->radius : q->radius;
    if (section->wall) return p->radius + n.x * d[0] + n.y * d[1] + n.z * d[2];
    for (int a = 0; world->domain.any_periodic && a < 3; ++a) d[a] += list->shift[c][a] * world->domain.edge[a];
    return p->radius + q->radius - sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/// First candidate of a section that overlaps too much, or its end. `room`: how far the others are from that, at least.
static size_t first_runaway(const pls_world *world, const pls_pair_section *section, pls_vec3 n, double *room)
{
    const size_t end = section->first + section->count;
    const double limit = world->def.max_overlap;
    size_t runaway = end;
    double least = *room;
#pragma omp parallel for schedule(static) reduction(min : runaway, least) if (section->count > PLS_BLOCK)
    for (size_t c = section->first; c < end; ++c)
    {
        if (!pls_pair_touches(&world->list, c)) continue;
        double radius;
        const double delta = overlap_of(world, section, n, c, &radius), left = limit * radius - delta;
        if (delta > limit * radius) runaway = c < runaway ? c : runaway;
        least = left < least ? left : least;
    }
    *room = least;
    return runaway;
}

/// Whether what bodies do to each other in a section may change by more than they move: they dive up behind a wall, or it turns.
static bool surprises(const pls_world *world, const pls_pair_section *section)
{
    return section->wall && (section->depth < INFINITY || pls_wall_sweeps(&world->bodies, section->wall_row));
}

static double smallest_radius(const pls_bodies *b)
{
    double smallest = INFINITY;
    for (size_t row = 0; row < b->count; ++row) smallest = b->place[row].radius < smallest ? b->place[row].radius : smallest;
    return smallest;
}

static bool overlap_is_due(const pls_world *world)
{
    return world->path >= world->overlap_due || world->state_count > 0; // states may change radii
}

/// Walls of pieces have to fit a box that changes.
static bool walls_are_due(const pls_world *world)
{
    for (int a = 0; a < 3; ++a)
        if (world->solids.wall_length[a] > 0.0 && world->domain.edge_rate[a] != 0.0) return true;
    return false;
}

bool pls_guard_is_due(const pls_world *world)
{
    return overlap_is_due(world) || world->path >= world->lost_due || world->solids.count > 0 || walls_are_due(world);
}

static pls_status overlap_of_balls(pls_world *world)
{
    const pls_pair_list *list = &world->list;
    const pls_bodies *b = &world->bodies;
    if (!overlap_is_due(world)) return PLS_OK;
    double room = world->def.max_overlap * smallest_radius(b); // of those that do not touch
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        pls_vec3 n = {0};
        if (section->wall) n = pls_wall_normal(&b->orientation[section->wall_row], world->def.dimension);
        if (surprises(world, section)) room = 0.0;
        const size_t c = first_runaway(world, section, n, &room);
        if (c == section->first + section->count) continue;
        double radius, delta = overlap_of(world, section, n, c, &radius);
        return overlap_failure(world, list->row_i[c], list->row_j[c], delta, radius);
    }
    world->overlap_due = world->path + surely * room;
    return PLS_OK;
}

static pls_status passed_failure(const pls_world *world, uint32_t i, uint32_t j)
{
    const pls_bodies *b = &world->bodies;
    return pls_fail(PLS_RUNAWAY_OVERLAP,
                    "a wall, body %u of '%s', has come past the middle of body %u of '%s' by t = %g s, step %llu, and would push it on to "
                    "the other side. Likely causes: bodies placed into each other, contacts too soft for the load, or a time step too "
                    "large. Mend that, or raise guard.max_overlap above 1",
                    b->kind[j].number, pls_world_group_name(world, (pls_group_id){b->kind[j].group}), b->kind[i].number,
                    pls_world_group_name(world, (pls_group_id){b->kind[i].group}), world->time, (unsigned long long)world->step);
}

pls_status pls_guard_overlap(pls_world *world)
{
    const pls_bodies *b = &world->bodies;
    PLS_TRY(overlap_of_balls(world));
    for (size_t c = 0; c < world->solids.count; ++c)
    {
        const pls_solid_pair *pair = &world->solids.pair[c];
        if (world->solids.memory[c].touches == PLS_SOLID_APART) continue;
        if (world->solids.memory[c].front == PLS_WALL_PASSED && world->def.max_overlap <= 1.0)
            return passed_failure(world, pair->row_i, pair->row_j);
        const double radius = fmin(b->place[pair->row_i].radius, b->place[pair->row_j].radius), limit = world->def.max_overlap * radius;
        if (!(world->solids.touch[c].reach > limit)) continue;
        const pls_contact_input input = pls_contact_input_of(world, 0.0);
        const double depth = pls_solid_depth(&world->solids, &input, c);
        if (depth > limit) return overlap_failure(world, pair->row_i, pair->row_j, depth, radius);
    }
    return PLS_OK;
}

static pls_status lost_failure(const pls_world *world, uint32_t number)
{
    const pls_bodies *b = &world->bodies;
    const uint32_t row = b->row_of[number];
    const pls_body_place *p = &b->place[row];
    return pls_fail(PLS_LOST_BODY,
                    "body %u of '%s' is at (%g, %g, %g) m with velocity (%g, %g, %g) m/s at t = %g s, step %llu: %g times the size "
                    "of the first arrangement away from it. "
                    "Likely causes: a wall is missing, contacts too soft for its speed, or a time step too large",
                    number, pls_world_group_name(world, (pls_group_id){b->kind[row].group}), p->x, p->y, p->z, p->vx, p->vy, p->vz,
                    world->time, (unsigned long long)world->step, far_away);
}

static pls_status guard_lost(pls_world *world)
{
    const pls_bodies *b = &world->bodies;
    const double limit = far_away * world->extent;
    double furthest = 0.0;
    if (world->path < world->lost_due) return PLS_OK;
    for (uint32_t number = 0; number < b->numbers; ++number)
    {
        uint32_t row = b->row_of[number];
        if (row == PLS_NO_ROW || (b->kind[row].flags & PLS_BODY_UNBOUNDED)) continue;
        const pls_body_place *p = &b->place[row];
        pls_vec3 d = pls_sub(pls_vec(p->x, p->y, p->z), world->centre);
        if (world->domain.periodic[0]) d.x = 0.0;
        if (world->domain.periodic[1]) d.y = 0.0;
        if (world->domain.periodic[2]) d.z = 0.0;
        const double distance = pls_length(d);
        if (distance > limit) return lost_failure(world, number);
        furthest = distance > furthest ? distance : furthest;
    }
    world->lost_due = world->path + surely * (limit - furthest);
    return PLS_OK;
}

pls_status pls_guard_step(pls_world *world)
{
    PLS_TRY(pls_guard_overlap(world));
    PLS_TRY(pls_solid_walls_fit(&world->solids, &world->domain));
    return guard_lost(world);
}
