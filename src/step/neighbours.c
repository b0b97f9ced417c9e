// neighbours.c -- when to make the pair list anew, with which skin, and when to re-order bodies in memory. None of this changes a result.

#include "step/world.h"

#include "base/alloc.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "base/sort.h"
#include "contact/approach.h"
#include "contact/broad_phase.h"
#include "step/bonds.h"

#include <string.h>

static const uint64_t builds_per_order = 24; ///< rebuilds between looks at the memory order

static double mean_radius(const pls_world *world)
{
    double sum = 0.0;
    size_t count = 0;
    for (size_t row = 0; row < world->bodies.count; ++row)
        if (!(world->bodies.kind[row].flags & PLS_BODY_UNBOUNDED))
        {
            sum += world->bodies.place[row].radius;
            ++count;
        }
    return count ? sum / (double)count : 1.0;
}

/// Keep the skin within what periodic edges leave beside two largest diameters (broad_phase.c). A given skin is shortened too, as no skin changes a result and
/// boxes may shrink: a run stops only where the bodies themselves no longer fit.
static void fit_skin(pls_world *world)
{
    double largest = 0.0;
    if (!world->domain.any_periodic) return;
    for (size_t row = 0; row < world->bodies.count; ++row)
        if (!(world->bodies.kind[row].flags & PLS_BODY_UNBOUNDED)) largest = fmax(largest, world->bodies.place[row].radius);
    for (int a = 0; a < 3; ++a)
    {
        if (!world->domain.periodic[a]) continue;
        double edge = world->domain.edge[a], room = 0.5 * edge - 2.0 * largest - 1e-9 * edge;
        world->tuner.skin = fmax(0.0, fmin(world->tuner.skin, room));
    }
}

/// Move the curve's origin so that its first cuts go through the middle of the arrangement: halves of the rows then lie on either side of a plane, and threads
/// that share them share few contacts.
static void centre_curve(double lower[3], const double upper[3], double cell)
{
    double half = cell;
    for (int a = 0; a < 3; ++a)
        while (2.0 * half < upper[a] - lower[a] + cell) half *= 2.0;
    for (int a = 0; a < 3 && isfinite(half); ++a) lower[a] = 0.5 * (lower[a] + upper[a]) - half;
}

/// Put bodies into the order of a space-filling curve. The contacts must be in `memory`.
static pls_status order_bodies(pls_world *world)
{
    pls_bodies *bodies = &world->bodies;
    double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY}, cell = 2.0 * mean_radius(world);
    for (size_t row = 0; row < bodies->count; ++row)
    {
        const double x[3] = {bodies->place[row].x, bodies->place[row].y, bodies->place[row].z};
        for (int a = 0; a < 3 && !(bodies->kind[row].flags & PLS_BODY_UNBOUNDED); ++a)
            lower[a] = fmin(lower[a], x[a]), upper[a] = fmax(upper[a], x[a]);
    }
    centre_curve(lower, upper, cell);
    uint64_t *key = NULL;
    uint32_t *old_row = NULL;
    pls_status status = pls_allocate(&key, bodies->count, sizeof *key, "ordering bodies");
    if (status == PLS_OK) status = pls_allocate(&old_row, bodies->count, sizeof *old_row, "ordering bodies");
    bool ordered = true;
    for (size_t row = 0; status == PLS_OK && row < bodies->count; ++row)
    {
        const double x[3] = {bodies->place[row].x, bodies->place[row].y, bodies->place[row].z};
        key[row] = (bodies->kind[row].flags & PLS_BODY_UNBOUNDED) ? UINT64_MAX : pls_morton_key(x, lower, cell);
        old_row[row] = (uint32_t)row;
        if (row > 0 && key[row] < key[row - 1]) ordered = false;
    }
    if (status == PLS_OK && !ordered)
    {
        status = pls_radix_sort_u64(key, old_row, bodies->count);
        if (status == PLS_OK) status = pls_bodies_reorder(bodies, old_row);
        if (status == PLS_OK) pls_follow_specials(world);
    }
    pls_release(&key);
    pls_release(&old_row);
    return status;
}

pls_status pls_neighbours_detach(pls_world *world)
{
    if (!world->memory_holds && (world->list.count > 0 || world->solids.count > 0))
    {
        PLS_TRY(pls_pair_list_remember(&world->list, &world->bodies, &world->memory));
        PLS_TRY(pls_solid_list_remember(&world->solids, &world->records));
        pls_solid_records_sort(&world->records);
        world->memory_holds = true;
    }
    world->list.stale = true;
    world->overlap_due = world->lost_due = 0.0; // whoever changes bodies begins here
    return PLS_OK;
}

/// Two bodies may have come nearer by so much.
static void note_path(pls_world *world, double length)
{
    world->list.drift += length;
    world->path += length;
}

void pls_neighbours_moved(pls_world *world, double largest_square)
{
    double images = 0.0; // a stretching box carries images away
    for (int a = 0; a < 3; ++a) images += fabs(world->domain.edge_rate[a]) * world->dt * world->list.image_reach[a];
    note_path(world, 2.0 * sqrt(largest_square) + images);
    world->list.image_drift += images;
}

void pls_neighbours_carried(pls_world *world, double further) { note_path(world, 2.0 * further); }

/// How far behind their surfaces walls hold: a parameter of their shapes.
static void set_wall_depths(pls_world *world)
{
    for (size_t k = 0; k < world->list.section_count; ++k)
    {
        pls_pair_section *section = &world->list.section[k];
        if (!section->wall) continue;
        const pls_shape *shape = world->shape[world->bodies.kind[section->wall_row].shape].shape;
        int place = pls_parameter_find(shape->ops->parameters, "lets_go");
        if (place >= 0 && shape->values[place] > 0.5) section->depth = 0.0;
    }
}

/// Leave only pairs of balls.
static void take_out_solids(pls_near_pairs *near, const pls_bodies *bodies)
{
    size_t kept = 0;
    for (size_t k = 0; k < near->count; ++k)
        if (!pls_pair_is_solid(bodies, near->pair[k].owner, near->pair[k].partner)) near->pair[kept++] = near->pair[k];
    near->count = kept;
}

/// Take pairs of solids out that bonds hold; where one lets go, the lists are made anew.
static void take_out_bonded(pls_near_pairs *near, const pls_world *world)
{
    const pls_bodies *b = &world->bodies;
    size_t kept = 0;
    for (size_t k = 0; k < near->count; ++k)
    {
        const uint32_t i = near->pair[k].owner, j = near->pair[k].partner;
        if (!pls_pair_is_solid(b, i, j) || !pls_bonds_hold(world, b->kind[i].number, b->kind[j].number)) near->pair[kept++] = near->pair[k];
    }
    near->count = kept;
}

static bool bonds_hold(const void *world, uint32_t a, uint32_t b) { return pls_bonds_hold(world, a, b); }

/// The furthest images that solids touch count too, where the box stretches and carries them away.
static void reach_of_images(pls_pair_list *list, const pls_solid_list *solids)
{
    for (size_t c = 0; c < solids->count; ++c)
        for (int a = 0; a < 3; ++a) list->image_reach[a] = fmax(list->image_reach[a], fabs((double)solids->pair[c].shift[a]) + 1.0);
}

/// Both lists anew, with what contacts remember.
static pls_status build_lists(pls_world *world)
{
    pls_near_pairs near = {0};
    const double skin = world->tuner.skin;
    pls_status status = pls_broad_phase(&world->bodies, &world->domain, skin, &near);
    if (status == PLS_OK && world->def.skin == 0.0) pls_skin_survey(&world->tuner, &world->bodies, &world->domain, &near);
    if (status == PLS_OK && world->bond_count > 0) take_out_bonded(&near, world);
    const pls_solid_source source = {
        .bodies = &world->bodies, .domain = &world->domain, .laws = &world->laws, .shape = world->shape_of, .near = &near, .gap = skin};
    if (status == PLS_OK) status = pls_solid_list_build(&world->solids, &source, &world->records);
    if (status == PLS_OK)
    {
        take_out_solids(&near, &world->bodies);
        status = pls_pair_list_build(&world->list, &world->bodies, &world->domain, &world->laws, &near, skin, world->state_count > 0,
                                     &world->memory);
    }
    if (status == PLS_OK && world->bond_count > 0) status = pls_pair_list_hold(&world->list, &world->bodies, bonds_hold, world);
    if (status != PLS_OK) world->list.stale = true;
    if (status == PLS_OK && world->domain.any_periodic) reach_of_images(&world->list, &world->solids);
    pls_near_pairs_free(&near);
    return status;
}

bool pls_neighbours_hold(const pls_world *world) { return !world->list.stale && world->list.drift < world->list.skin; }

pls_status pls_neighbours_refresh(pls_world *world)
{
    pls_pair_list *list = &world->list;
    if (list->alone && pls_threads() > 1) list->stale = true; // was made for one thread
    if (pls_neighbours_hold(world)) return PLS_OK;
    const bool worn_out = !list->stale;
    if (worn_out)
    {
        PLS_TRY(pls_pair_list_approach(list, &world->bodies, &world->domain, &list->drift));
        list->drift += list->image_drift;
        if (list->drift < 0.9 * list->skin) return PLS_OK;
    }
    const double began = pls_clock();
    PLS_TRY(pls_neighbours_detach(world));
    if (world->def.skin > 0.0)
        world->tuner.skin = world->def.skin;
    else
        pls_skin_choose(&world->tuner, list, &world->solids, world->bodies.count, mean_radius(world), worn_out, world->step, began);
    fit_skin(world);
    if (world->def.reorder && list->builds % builds_per_order == 0) PLS_TRY(order_bodies(world));
    PLS_TRY(build_lists(world));
    set_wall_depths(world);
    world->memory_holds = false;
    pls_contact_memory_free(&world->memory); // as large as the lists themselves, and idle until the next
    pls_solid_records_free(&world->records);
    pls_skin_listed(&world->tuner, world->step, began, pls_clock());
    return PLS_OK;
}
