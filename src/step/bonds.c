// bonds.c -- sets of bonds in a world.

#include "step/bonds.h"

#include "base/alloc.h"
#include "base/parallel.h"
#include "base/random.h"
#include "bond/bond_set.h"
#include "bond/builtin.h"
#include "bond/influence.h"
#include "math/lanczos.h"
#include "step/contact_rates.h"

#include <stdio.h>
#include <string.h>

enum { COOKIE = 0x706c7332 };

static const double margin = 1.03; ///< Lanczos values come from below

pls_bonds_def pls_default_bonds_def(void)
{
    return (pls_bonds_def){.influence = PLS_INFLUENCE_INVERSE,
                           .critical_stretch = INFINITY,
                           .fracture_energy = NAN,
                           .seed = 1,
                           .heat = {.conductivity = NAN, .capacity = NAN, .reference = NAN},
                           .cookie = COOKIE};
}

// ---- making --------------------------------------------------------------------------------------------------------------------------------------------

static pls_status check_def(const pls_world *world, const pls_bonds_def *def)
{
    if (def->cookie != COOKIE) return pls_fail(PLS_INVALID_ARGUMENT, "start from pls_default_bonds_def() and change what you need");
    if (!def->name[0]) return pls_fail(PLS_INVALID_ARGUMENT, "a set of bonds needs a name");
    if (pls_world_find_bonds(world, def->name).index1) return pls_fail(PLS_DUPLICATE, "there is a set of bonds '%s' already", def->name);
    if (!def->ops) return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s' need a law", def->name);
    if (def->ops->api_version != PLS_API_VERSION)
        return pls_fail(PLS_VERSION, "bond law '%s' is made for version %u of the interface; this is version %d: compile it anew",
                        def->ops->name ? def->ops->name : "?", def->ops->api_version, PLS_API_VERSION);
    PLS_TRY(pls_bond_ops_check(def->ops));
    if (!(def->horizon > 0.0) || !isfinite(def->horizon))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the horizon is %g m; it must be positive", def->name, def->horizon);
    if (isnan(def->spacing) || isinf(def->spacing))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the spacing is %g m", def->name, def->spacing);
    if (!(def->critical_stretch > 0.0))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the critical stretch is %g; it must be positive", def->name,
                        def->critical_stretch);
    if (!isnan(def->fracture_energy) && !(def->fracture_energy > 0.0 && isfinite(def->fracture_energy)))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the fracture energy is %g J/m^2; it must be positive", def->name,
                        def->fracture_energy);
    if (!isnan(def->fracture_energy) && isfinite(def->critical_stretch))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': give the critical stretch or the fracture energy, not both", def->name);
    if (def->ops->pair && !isnan(def->heat.conductivity))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': bonds of law '%s' do not conduct heat; those of peridynamics do", def->name,
                        def->ops->name);
    if (def->influence == PLS_INFLUENCE_FUNCTION && !def->weight)
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the influence is a function, but none is given", def->name);
    for (size_t g = 0; g < def->group_count; ++g)
        if (def->group[g].index1 < 1 || def->group[g].index1 > world->group_count)
            return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': a group of theirs does not exist", def->name);
    return PLS_OK;
}

static bool is_point(const pls_world *world, const pls_bonds_def *def, uint32_t row)
{
    const pls_body_kind *kind = &world->bodies.kind[row];
    if (kind->flags & PLS_BODY_UNBOUNDED) return false;
    for (size_t g = 0; g < def->group_count; ++g)
        if (def->group[g].index1 == kind->group) return true;
    return def->group_count == 0;
}

/// Points in order of numbers, and the material of every body.
static pls_status collect_points(const pls_world *world, const pls_bonds_def *def, pls_bond_point *point, uint16_t *material, size_t *count)
{
    const pls_bodies *b = &world->bodies;
    const double dimension = world->def.dimension;
    *count = 0;
    for (size_t n = 0; n < b->numbers; ++n)
    {
        const uint32_t row = b->row_of[n];
        if (row == PLS_NO_ROW || !is_point(world, def, row)) continue;
        const pls_body_place *p = &b->place[row];
        const pls_material *m = &world->laws.material[b->kind[row].material];
        const double volume = b->mass[row].mass / m->values.density;
        if (!def->ops->pair && (!(volume > 0.0) || !isfinite(volume)))
            return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': body %zu has no volume: material '%s' needs a density", def->name, n,
                            m->name);
        material[n] = b->kind[row].material;
        point[(*count)++] =
            (pls_bond_point){.x = {p->x, p->y, p->z},
                             .volume = volume,
                             .spacing = def->spacing != 0.0 ? def->spacing : pow(volume / world->domain.thickness, 1.0 / dimension),
                             .number = (uint32_t)n,
                             .generation = b->kind[row].generation};
    }
    return *count > 0 ? PLS_OK
                      : pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s' have no points: there are no bodies in their groups", def->name);
}

/// The law's parameters: given ones, or defaults; checked.
static pls_status take_values(const pls_bonds_def *def, double values[PLS_MAX_VALUES])
{
    char owner[PLS_NAME_SIZE + 32];
    pls_parameters_default(def->ops->parameters, values);
    if (def->values) memcpy(values, def->values, (size_t)pls_parameter_values(def->ops->parameters) * sizeof *values);
    snprintf(owner, sizeof owner, "bond law '%s'", def->ops->name);
    return pls_parameters_check(def->ops->parameters, values, owner);
}

/// What the law says of a material.
static pls_status ask_about(const pls_world *world, const pls_bonds_def *def, const double *values, size_t m, pls_bond_coefficients *law,
                            double constants[PLS_BOND_MAX_CONSTANTS])
{
    const pls_bond_setting setting = {.dimension = world->def.dimension, .plane = def->plane, .material = world->laws.material[m].values};
    pls_status status = def->ops->linear ? def->ops->linear(values, &setting, law) : PLS_OK;
    if (status == PLS_OK && def->ops->prepare) status = def->ops->prepare(values, &setting, constants);
    return status == PLS_OK ? PLS_OK : pls_fail_context(status, "bonds '%s', material '%s': ", def->name, world->laws.material[m].name);
}

/// What the law says of every material that has points; a pair law must say the same of all. `some`: one of these materials.
static pls_status ask_law(const pls_world *world, const pls_bonds_def *def, const pls_bond_point *point, size_t count,
                          const uint16_t *material, pls_bond_coefficients *law, double (*constants)[PLS_BOND_MAX_CONSTANTS], size_t *some)
{
    double values[PLS_MAX_VALUES];
    bool known = false;
    PLS_TRY(take_values(def, values));
    for (size_t m = 0; m < world->laws.material_count; ++m)
    {
        bool used = false;
        for (size_t p = 0; p < count && !used; ++p) used = material[point[p].number] == m;
        if (!used) continue;
        PLS_TRY(ask_about(world, def, values, m, &law[m], constants[m]));
        if (def->ops->pair && known && memcmp(constants[m], constants[*some], sizeof constants[m]) != 0)
            return pls_fail(
                PLS_INVALID_ARGUMENT,
                "bonds '%s': law '%s' joins bodies of one material, but '%s' has other values than those before it; give sets of their own",
                def->name, def->ops->name, world->laws.material[m].name);
        *some = m;
        known = true;
    }
    return PLS_OK;
}

/// The critical stretch that the fracture energy asks for, which must be that of all materials.
static pls_status find_stretch(const pls_world *world, const pls_bonds_def *def, const pls_bond_coefficients *law, double *stretch,
                               double *energy)
{
    const int d = world->def.dimension;
    *stretch = def->critical_stretch;
    *energy = INFINITY;
    if (isnan(def->fracture_energy) && def->fracture == PLS_FRACTURE_STRETCH) return PLS_OK;
    if (isnan(def->fracture_energy))
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s' break by energy and have no fracture energy", def->name);
    if (def->ops->pair)
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "bonds '%s': law '%s' breaks by its own strength or a critical stretch, not by a fracture energy", def->name,
                        def->ops->name);
    if (def->fracture == PLS_FRACTURE_ENERGY && def->ops->pull)
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "bonds '%s': bonds of law '%s', which is not linear, do not break by energy; let the fracture energy set a "
                        "critical stretch",
                        def->name, def->ops->name);
    if (def->fracture == PLS_FRACTURE_ENERGY)
    {
        *energy = def->fracture_energy;
        return PLS_OK;
    }
    for (size_t m = 0; m < world->laws.material_count; ++m)
    {
        if (law[m].extension == 0.0) continue;                                               // no points of it
        const double bulk = (d * law[m].dilation + law[m].extension) / (d == 3 ? 9.0 : 4.0); // what a uniform dilation meets
        const double own = pls_critical_stretch(def, d, bulk, def->fracture_energy);
        if (!isfinite(own) || !(own > 0.0))
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "bonds '%s': no critical stretch follows from a fracture energy of %g J/m^2; is the influence function "
                            "positive below the horizon?",
                            def->name, def->fracture_energy);
        if (isfinite(*stretch) && !(fabs(own - *stretch) <= 1e-9 * own))
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "bonds '%s': one fracture energy means other critical stretches in other materials (%g and %g); give "
                            "critical_stretch, or sets of their own",
                            def->name, *stretch, own);
        *stretch = own;
    }
    return PLS_OK;
}

/// What a set is made from, while it is made.
typedef struct drawing
{
    pls_bond_point *point;
    uint16_t *material;
    pls_bond_coefficients *law;
    double (*constants)[PLS_BOND_MAX_CONSTANTS];
    pls_heat_material *heat;
} drawing;

/// In plane strain the thickness that cannot grow pushes the plane apart.
static pls_heat_material heat_of(const pls_world *world, const pls_bonds_def *def, size_t m)
{
    const pls_material_values *values = &world->laws.material[m].values;
    const bool strain = world->def.dimension == 2 && def->plane == PLS_PLANE_STRAIN;
    return (pls_heat_material){.density = values->density, .expansion = strain ? 1.0 + values->poisson_ratio : 1.0};
}

static pls_status draw(const pls_world *world, const pls_bonds_def *def, drawing *d, pls_bond_plan *plan, size_t *count)
{
    PLS_TRY(pls_allocate(&d->point, world->bodies.numbers, sizeof *d->point, "points of bonds"));
    PLS_TRY(pls_allocate(&d->material, world->bodies.numbers, sizeof *d->material, "points of bonds"));
    PLS_TRY(pls_allocate(&d->law, world->laws.material_count, sizeof *d->law, "points of bonds"));
    PLS_TRY(pls_allocate(&d->constants, world->laws.material_count, sizeof *d->constants, "points of bonds"));
    PLS_TRY(pls_allocate(&d->heat, world->laws.material_count, sizeof *d->heat, "points of bonds"));
    for (size_t m = 0; m < world->laws.material_count; ++m) d->heat[m] = heat_of(world, def, m);
    PLS_TRY(collect_points(world, def, d->point, d->material, count));
    PLS_TRY(ask_law(world, def, d->point, *count, d->material, d->law, d->constants, &plan->some_material));
    plan->law = d->law;
    plan->constants = (const double(*)[PLS_BOND_MAX_CONSTANTS])d->constants;
    plan->material = d->material;
    plan->heat = d->heat;
    return find_stretch(world, def, d->law, &plan->stretch, &plan->energy);
}

/// A body has one temperature.
static pls_status check_heat(const pls_world *world, const pls_bonds_def *def, const pls_bond_point *point, size_t count)
{
    for (size_t s = 0; !isnan(def->heat.conductivity) && s < world->bond_count; ++s)
        for (size_t p = 0; world->bond[s].conditions.warmth && p < count; ++p)
            if (point[p].number < world->bond[s].numbers && world->bond[s].point_of[point[p].number] != PLS_NO_POINT)
                return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': body %u has a temperature in bonds '%s' already", def->name,
                                point[p].number, world->bond[s].name);
    return PLS_OK;
}

static pls_status make(pls_world *world, const pls_bonds_def *def, pls_bond_set *set)
{
    drawing d = {NULL};
    size_t count = 0;
    pls_bond_plan plan = {.def = def, .materials = world->laws.material_count, .time = world->time};
    pls_status status = draw(world, def, &d, &plan, &count);
    if (status == PLS_OK) status = check_heat(world, def, d.point, count);
    if (status == PLS_OK)
    {
        status = pls_bond_set_make(set, &plan, d.point, count, &world->bodies, &world->domain);
        d.point = NULL; // the set's, as the user is
    }
    else if (def->release)
        def->release(def->user);
    pls_release(&d.point);
    pls_release(&d.material);
    pls_release(&d.law);
    pls_release(&d.constants);
    pls_release(&d.heat);
    return status;
}

static pls_status find_stiffness(const pls_world *world, pls_bond_set *set);

/// Bodies that are bonded now touch no longer.
static void drop_contacts(pls_world *world, const pls_bond_set *set)
{
    size_t kept = 0;
    for (size_t k = 0; k < world->memory.count; ++k)
        if (!pls_bond_holds(set, world->memory.entry[k].number_i, world->memory.entry[k].number_j))
            world->memory.entry[kept++] = world->memory.entry[k];
    world->memory.count = kept;
    kept = 0;
    for (size_t k = 0; k < world->records.count; ++k)
        if (!pls_bond_holds(set, world->records.entry[k].number_i, world->records.entry[k].number_j))
            world->records.entry[kept++] = world->records.entry[k];
    world->records.count = kept;
}

static pls_status prepare_to_add(pls_world *world, const pls_bonds_def *def)
{
    PLS_TRY(check_def(world, def));
    if (world->bond_count >= UINT16_MAX - 1) return pls_fail(PLS_LIMIT_EXCEEDED, "a world holds at most %d sets of bonds", UINT16_MAX - 1);
    PLS_TRY(pls_reserve(&world->bond, &world->bond_capacity, world->bond_count + 1, sizeof *world->bond, "sets of bonds"));
    return pls_neighbours_detach(world);
}

pls_status pls_world_add_bonds(pls_world *world, const pls_bonds_def *def, pls_bonds_id *id)
{
    *id = (pls_bonds_id){0};
    pls_status status = prepare_to_add(world, def);
    if (status != PLS_OK && def->cookie == COOKIE && def->release) def->release(def->user);
    PLS_TRY(status);
    pls_bond_set *set = &world->bond[world->bond_count];
    PLS_TRY(make(world, def, set));
    status = find_stiffness(world, set);
    if (status == PLS_OK && !isfinite(set->stiffness))
        status =
            pls_fail(PLS_NOT_A_NUMBER, "bonds '%s': their stiffness is no number; are moduli, masses and lengths in SI units?", def->name);
    if (status != PLS_OK)
    {
        pls_bond_set_free(set);
        return status;
    }
    drop_contacts(world, set);
    id->index1 = (uint16_t)++world->bond_count;
    return PLS_OK;
}

void pls_bonds_free(pls_world *world)
{
    for (size_t s = 0; s < world->bond_count; ++s) pls_bond_set_free(&world->bond[s]);
    pls_release(&world->bond);
}

// ---- a step ----------------------------------------------------------------------------------------------------------------------------------------------

/// A thread's points of a set: whole blocks.
static void share_of(const pls_bond_set *set, int thread, int threads, size_t *first, size_t *last)
{
    const size_t blocks = pls_block_count(set->family.count, PLS_BOND_BLOCK);
    *first = blocks * (size_t)thread / (size_t)threads * PLS_BOND_BLOCK;
    *last = blocks * ((size_t)thread + 1) / (size_t)threads * PLS_BOND_BLOCK;
    if (*first > set->family.count) *first = set->family.count;
    if (*last > set->family.count) *last = set->family.count;
}

/// Time of the end of a step of length dt, or of now.
static double end_of(const pls_world *world, double dt) { return dt > 0.0 ? (double)(world->step + 1) * dt : world->time; }

pls_status pls_bonds_place(pls_world *world, double dt, int thread, int threads)
{
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        pls_bond_set *set = &world->bond[s];
        size_t first, last;
        share_of(set, thread, threads, &first, &last);
        pls_bond_take_places(set, &world->bodies, first, last);
        if (set->conditions.row) PLS_TRY(pls_conditions_take(&set->conditions, &set->family, first, last, end_of(world, dt), dt));
    }
    return PLS_OK;
}

static void take_ghosts(pls_world *world)
{
    for (size_t s = 0; s < world->bond_count; ++s) pls_bond_take_ghosts(&world->bond[s], &world->domain);
}

static void take_conditions(pls_world *world)
{
    for (size_t s = 0; s < world->bond_count; ++s)
        if (world->bond[s].conditions.row) pls_conditions_taken(&world->bond[s].conditions, &world->bond[s].family);
}

void pls_bonds_placed(pls_world *world)
{
    take_ghosts(world);
    take_conditions(world);
}

pls_status pls_bonds_restored(pls_world *world)
{
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        pls_bond_set *set = &world->bond[s];
        if (set->conditions.row) PLS_TRY(pls_conditions_take(&set->conditions, &set->family, 0, set->family.count, world->time, 0.0));
    }
    take_conditions(world);
    return PLS_OK;
}

bool pls_bonds_dilate_at_all(const pls_world *world)
{
    for (size_t s = 0; s < world->bond_count; ++s)
        if (world->bond[s].dilates || world->bond[s].states.ops || world->bond[s].conditions.warmth) return true;
    return false;
}

pls_status pls_bonds_dilate(pls_world *world, double dt, int thread, int threads)
{
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        pls_bond_set *set = &world->bond[s];
        size_t first, last;
        share_of(set, thread, threads, &first, &last);
        if (set->states.ops)
            pls_bond_ask_states(set, first, last, dt);
        else if (set->dilates && pls_bond_varies(set))
            PLS_SIMD_SELECT(pls_bond_dilate_varied)(set, first, last);
        else if (set->dilates)
            PLS_SIMD_SELECT(pls_bond_dilate)(set, first, last);
        if (set->conditions.warmth) PLS_TRY(pls_conditions_conduct(&set->conditions, &set->family, first, last, end_of(world, dt), dt));
    }
    return PLS_OK;
}

void pls_bonds_dilated(pls_world *world)
{
    for (size_t s = 0; s < world->bond_count; ++s)
        if (world->bond[s].dilates && !world->bond[s].states.ops) pls_bond_take_spread(&world->bond[s]);
    take_ghosts(world);
}

static bool act(pls_bond_set *set, size_t first, size_t last)
{
    if (set->links.ops) return PLS_SIMD_SELECT(pls_link_act)(set, first, last);
    if (set->states.ops) return PLS_SIMD_SELECT(pls_states_act)(set, first, last);
    return pls_bond_varies(set) ? PLS_SIMD_SELECT(pls_bond_act_varied)(set, first, last) : PLS_SIMD_SELECT(pls_bond_act)(set, first, last);
}

void pls_bonds_act(pls_world *world, int thread, int threads)
{
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        size_t first, last;
        share_of(&world->bond[s], thread, threads, &first, &last);
        if (first < last && act(&world->bond[s], first, last)) __atomic_store_n(&world->bond[s].any_overlong, true, __ATOMIC_RELAXED);
    }
}

/// Rows of a set as bodies are now: scratch of the step, so a world that is only looked at may fill it.
static void take_rows(const pls_world *world, pls_bond_set *set)
{
    pls_bond_take_places(set, &world->bodies, 0, set->family.count);
    pls_bond_take_ghosts(set, &world->domain);
}

bool pls_bonds_hold(const pls_world *world, uint32_t a, uint32_t b)
{
    for (size_t s = 0; s < world->bond_count; ++s)
        if (pls_bond_holds(&world->bond[s], a, b)) return true;
    return false;
}

void pls_bonds_note_damage(pls_world *world, uint32_t number)
{
    size_t lost = 0, all = 0;
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        const pls_bond_set *set = &world->bond[s];
        const uint32_t p = number < set->numbers ? set->point_of[number] : PLS_NO_POINT;
        if (p == PLS_NO_POINT) continue;
        lost += pls_bond_lost(set, p);
        all += set->family.size[p];
    }
    const uint32_t row = world->bodies.row_of[number];
    if (row != PLS_NO_ROW && all > 0) world->bodies.damage[row] = (float)((double)lost / (double)all);
}

/// The lowest number of a tree of which each body has a lower one of its fragment above it; halves the way for the next time.
static uint32_t lowest(uint32_t *above, uint32_t number)
{
    while (above[number] != number) number = above[number] = above[above[number]];
    return number;
}

static void join_families(const pls_bond_set *set, uint32_t *above)
{
    const pls_families *f = &set->family;
    for (size_t p = 0; p < f->count; ++p)
    {
        const size_t first = (size_t)f->start[p] * PLS_BOND_VECTOR;
        for (size_t slot = first; slot < first + f->size[p]; ++slot)
        {
            if (!pls_bond_is_whole(set, slot)) continue;
            const uint32_t a = lowest(above, f->point[p].number), b = lowest(above, f->point[pls_point_behind(f, f->partner[slot])].number);
            above[a > b ? a : b] = a > b ? b : a;
        }
    }
}

void pls_bonds_fragments(const pls_world *world, uint32_t *fragment)
{
    const size_t numbers = world->bodies.numbers;
    for (size_t n = 0; n < numbers; ++n) fragment[n] = PLS_NO_FRAGMENT;
    for (size_t s = 0; s < world->bond_count; ++s)
        for (size_t n = 0; n < world->bond[s].numbers; ++n)
            if (world->bond[s].point_of[n] != PLS_NO_POINT) fragment[n] = (uint32_t)n;
    for (size_t s = 0; s < world->bond_count; ++s) join_families(&world->bond[s], fragment);
    for (size_t n = 0; n < numbers; ++n)
        if (fragment[n] != PLS_NO_FRAGMENT) fragment[n] = lowest(fragment, (uint32_t)n);
}

size_t pls_bonds_count(const pls_world *world)
{
    size_t count = 0;
    for (size_t s = 0; s < world->bond_count; ++s) count += world->bond[s].family.bonds;
    return count;
}

size_t pls_bonds_points(const pls_world *world)
{
    size_t count = 0;
    for (size_t s = 0; s < world->bond_count; ++s) count += world->bond[s].family.count;
    return count;
}

/// Two bodies may touch from now on, unless another set holds them.
static void let_touch(void *context, uint32_t a, uint32_t b)
{
    pls_world *world = context;
    pls_bonds_note_damage(world, a);
    pls_bonds_note_damage(world, b);
    if (pls_bonds_hold(world, a, b)) return;
    const uint32_t row_a = world->bodies.row_of[a], row_b = world->bodies.row_of[b];
    if (row_a == PLS_NO_ROW || row_b == PLS_NO_ROW) return;
    world->overlap_due = 0.0; // they may overlap already
    if (pls_pair_is_solid(&world->bodies, row_a, row_b))
        world->list.stale = true; // lists of solids have no pairs that are held
    else
        pls_pair_list_let_go(&world->list, row_a, row_b);
}

/// What laws took in the step is booked with what dashpots take.
static void book_spent(pls_world *world, const pls_bond_set *set)
{
    for (size_t p = 0; p < set->family.count; ++p)
    {
        const uint32_t row = world->bodies.row_of[set->number[p]];
        if (row != PLS_NO_ROW) world->bodies.damped[row] += set->states.spent[p];
    }
}

void pls_bonds_acted(pls_world *world)
{
    for (size_t s = 0; s < world->bond_count; ++s)
        if (world->bond[s].states.ops && world->bond[s].states.ops->advance) book_spent(world, &world->bond[s]);
    for (size_t s = 0; s < world->bond_count; ++s)
        if (world->bond[s].any_overlong)
            pls_bond_break_overlong(&world->bond[s], &world->bodies, &world->domain, world->dt, let_touch, world);
}

void pls_bonds_leave(pls_world *world, uint32_t number)
{
    for (size_t k = 0; k < world->bond_count; ++k)
    {
        pls_bond_set *set = &world->bond[k];
        const uint32_t p = number < set->numbers ? set->point_of[number] : PLS_NO_POINT;
        if (p == PLS_NO_POINT) continue;
        take_rows(world, set);
        for (size_t slot = (size_t)set->family.start[p] * PLS_BOND_VECTOR, n = 0; n < set->family.size[p]; ++n, ++slot)
        {
            pls_bond_break(set, (pls_bond_end){p, slot});
            pls_bonds_note_damage(world, set->family.point[pls_point_behind(&set->family, set->family.partner[slot])].number);
        }
        set->point_of[number] = PLS_NO_POINT; // another body may get the number
    }
}

size_t pls_bonds_remembered(const pls_world *world)
{
    size_t count = 0;
    for (size_t s = 0; s < world->bond_count; ++s) count += pls_bond_remembered(&world->bond[s]);
    return count;
}

// ---- the stable step -----------------------------------------------------------------------------------------------------------------------------------------

/// The stiffness of a set as bodies lie now, between displacements times roots of masses.
typedef struct stiffness_operator
{
    const pls_bond_set *set;
    double *root;         ///< per point: root of its inverse mass, 0 where no force moves it
    double *root_inertia; ///< the same of its smallest moment of inertia, for pair laws
    double *spread;       ///< scratch per point: A
    int dimension;
} stiffness_operator;

/// Change of a bond's length, and its direction.
static double lengthening(const stiffness_operator *o, size_t p, size_t slot, const double *x, double y[3])
{
    const pls_families *f = &o->set->family;
    const double *a = o->set->row[p], *b = o->set->row[f->partner[slot]];
    const size_t q = pls_point_behind(f, f->partner[slot]);
    double length = 0.0, change = 0.0;
    for (int c = 0; c < 3; ++c) y[c] = b[c] - a[c], length += y[c] * y[c];
    length = sqrt(length);
    for (size_t c = 0; c < 3; ++c)
    {
        y[c] /= length;
        change += y[c] * (o->root[q] * x[3 * q + c] - o->root[p] * x[3 * p + c]);
    }
    return change;
}

static void multiply(const void *context, const double *x, double *y)
{
    const stiffness_operator *o = context;
    const pls_bond_set *set = o->set;
    const pls_families *f = &set->family;
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < f->count; ++p)
    {
        double sum = 0.0, unit[3];
        for (size_t slot = (size_t)f->start[p] * PLS_BOND_VECTOR, k = 0; k < f->size[p]; ++k, ++slot)
            sum += set->weight[slot] * lengthening(o, p, slot, x, unit);
        o->spread[p] = set->dilation[p] * sum;
    }
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < f->count; ++p)
    {
        double sum[3] = {0}, unit[3];
        for (size_t slot = (size_t)f->start[p] * PLS_BOND_VECTOR, k = 0; k < f->size[p]; ++k, ++slot)
        {
            const double change = lengthening(o, p, slot, x, unit), stiffness = set->twice * (double)set->share[slot];
            const double tension = set->weight[slot] *
                                   (o->spread[p] + o->spread[pls_point_behind(f, f->partner[slot])] + stiffness * change / f->length[slot]);
            for (int c = 0; c < o->dimension; ++c) sum[c] -= tension * unit[c];
        }
        for (size_t c = 0; c < 3; ++c) y[3 * p + c] = o->root[p] * sum[c];
    }
}

/// A bond that turns with its bodies, as an Euler-Bernoulli beam that has not yet moved: forces and torques on the own end for displacements and rotations of both.
static void add_link(const stiffness_operator *o, size_t p, size_t slot, const double *x, double f[6])
{
    const pls_families *fam = &o->set->family;
    const double *a = o->set->links.pose[p], *b = o->set->links.pose[fam->partner[slot]];
    const size_t q = pls_point_behind(fam, fam->partner[slot]);
    const pls_vec3 r = pls_vec(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    const double l = pls_length(r);
    const pls_vec3 e = pls_scale(r, 1.0 / l);
    pls_pair_stiffness k;
    o->set->links.ops->stiffness(o->set->links.constants, fam->length[slot], &k);
    pls_vec3 u = pls_vec(0, 0, 0), turn[2];
    const size_t end[2] = {p, q};
    for (int n = 0; n < 2; ++n)
    {
        const double *of = x + 6 * end[n], m = o->root[end[n]], i = o->root_inertia[end[n]];
        u = pls_add(u, pls_scale(pls_vec(of[0], of[1], of[2]), n == 0 ? -m : m));
        turn[n] = pls_scale(pls_vec(of[3], of[4], of[5]), i);
    }
    const pls_vec3 chord = pls_scale(pls_cross(e, u), 1.0 / l);
    const double along = pls_dot(u, e), twist = pls_dot(pls_sub(turn[1], turn[0]), e);
    for (int n = 0; n < 2; ++n)
    {
        turn[n] = pls_sub(turn[n], chord);
        turn[n] = pls_sub(turn[n], pls_scale(e, pls_dot(turn[n], e)));
    }
    const pls_vec3 shear = pls_scale(pls_cross(pls_add(turn[0], turn[1]), e), -6.0 * k.bending / l);
    const pls_vec3 bend = pls_scale(pls_add(pls_scale(turn[0], 2.0), turn[1]), -2.0 * k.bending);
    const pls_vec3 force = pls_add(pls_scale(e, k.axial * along), shear), torque = pls_add(pls_scale(e, k.torsion * twist), bend);
    f[0] += force.x, f[1] += force.y, f[2] += force.z, f[3] += torque.x, f[4] += torque.y, f[5] += torque.z;
}

static void multiply_links(const void *context, const double *x, double *y)
{
    const stiffness_operator *o = context;
    const pls_families *f = &o->set->family;
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < f->count; ++p)
    {
        double sum[6] = {0};
        for (size_t slot = (size_t)f->start[p] * PLS_BOND_VECTOR, k = 0; k < f->size[p]; ++k, ++slot) add_link(o, p, slot, x, sum);
        for (size_t c = 0; c < 6; ++c)
        {
            const bool free = o->dimension == 3 || c < 2 || c == 5;
            y[6 * p + c] = free ? -(c < 3 ? o->root[p] : o->root_inertia[p]) * sum[c] : 0.0;
        }
    }
}

static pls_status allocate_operator(stiffness_operator *o, size_t count, double **x)
{
    const size_t numbers = o->set->links.ops ? 6 : 3;
    PLS_TRY(pls_allocate(x, numbers * count, sizeof **x, "the stable step"));
    PLS_TRY(pls_allocate(&o->root, count, sizeof *o->root, "the stable step"));
    PLS_TRY(pls_allocate(&o->root_inertia, count, sizeof *o->root_inertia, "the stable step"));
    return pls_allocate(&o->spread, count, sizeof *o->spread, "the stable step");
}

static void fill_operator(const pls_world *world, stiffness_operator *o, double *x)
{
    const size_t numbers = o->set->links.ops ? 6 : 3;
    for (size_t p = 0; p < o->set->family.count; ++p)
    {
        const uint32_t number = o->set->family.point[p].number, row = world->bodies.row_of[number];
        pls_random random = pls_random_stream(0, number, PLS_FOR_USER);
        const bool moves = row != PLS_NO_ROW && world->bodies.load[row].inv_mass > 0.0;
        o->root[p] = moves ? sqrt(world->bodies.load[row].inv_mass) : 0.0;
        o->root_inertia[p] = moves ? 1.0 / sqrt(pls_smallest_moment(&world->bodies.mass[row], o->dimension)) : 0.0;
        for (size_t c = 0; c < numbers; ++c)
        {
            const double u = pls_random_uniform(&random) - 0.5;
            const bool free = o->dimension == 3 || c < 2 || c == 5;
            x[numbers * p + c] = moves && free ? u : 0.0;
        }
    }
}

static pls_status find_stiffness(const pls_world *world, pls_bond_set *set)
{
    stiffness_operator o = {.set = set, .dimension = world->def.dimension};
    double *x = NULL;
    const size_t count = set->family.count;
    pls_bond_take_places(set, &world->bodies, 0, count);
    pls_bond_take_ghosts(set, &world->domain);
    pls_status status = allocate_operator(&o, count, &x);
    if (status == PLS_OK) fill_operator(world, &o, x);
    if (status == PLS_OK)
        status = set->links.ops ? pls_lanczos_largest(multiply_links, &o, 6 * count, x, &set->stiffness)
                                : pls_lanczos_largest(multiply, &o, 3 * count, x, &set->stiffness);
    set->stiffness *= margin;
    pls_release(&x);
    pls_release(&o.root);
    pls_release(&o.root_inertia);
    pls_release(&o.spread);
    return status;
}

/// As it was made, times what the stiffest point is stiffer by now.
static double rate_of(const pls_bond_set *set)
{
    return set->conditions.row ? fmax(set->conditions.stiffest, 1.0) * set->stiffness : set->stiffness;
}

double pls_bonds_heat_step(const pls_world *world, const char **name)
{
    double fastest = 0.0;
    for (size_t s = 0; s < world->bond_count; ++s)
        if (world->bond[s].conditions.fastest > fastest) fastest = world->bond[s].conditions.fastest, *name = world->bond[s].name;
    return fastest > 0.0 ? 1.0 / fastest : INFINITY;
}

double pls_bonds_rate(const pls_world *world, uint32_t number, bool of_rotation)
{
    double sum = 0.0;
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        const pls_bond_set *set = &world->bond[s];
        if (number < set->numbers && set->point_of[number] != PLS_NO_POINT && (!of_rotation || set->links.ops)) sum += rate_of(set);
    }
    return sum;
}

// ---- asking ------------------------------------------------------------------------------------------------------------------------------------------------

pls_bonds_id pls_world_find_bonds(const pls_world *world, const char *name)
{
    for (size_t s = 0; s < world->bond_count; ++s)
        if (strcmp(world->bond[s].name, name) == 0) return (pls_bonds_id){(uint16_t)(s + 1)};
    return (pls_bonds_id){0};
}

bool pls_world_has_bonds(const pls_world *world) { return world->bond_count > 0; }

/// Null, with the reason, when there is none.
static pls_bond_set *find_set(const pls_world *world, pls_bonds_id id)
{
    if (id.index1 >= 1 && id.index1 <= world->bond_count) return &world->bond[id.index1 - 1];
    pls_fail(PLS_INVALID_ARGUMENT, "an id names no bonds of this world");
    return NULL;
}

void pls_bonds_energies(const pls_world *world, double *stored, double *broken)
{
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        pls_bond_set *set = &world->bond[s];
        take_rows(world, set);
#pragma omp parallel for schedule(static)
        for (size_t p = 0; p < set->family.count; ++p)
        {
            const uint32_t number = set->family.point[p].number;
            if (set->point_of[number] != p) continue; // the body left, and another may have its number
            stored[number] += pls_bond_energy(set, p);
            broken[number] += set->broken[p];
        }
    }
}

pls_status pls_world_bonds_figures(const pls_world *world, pls_bonds_id id, pls_bonds_figures *figures)
{
    pls_bond_set *set = find_set(world, id);
    if (!set) return PLS_INVALID_ARGUMENT;
    *figures =
        (pls_bonds_figures){.points = set->family.count, .bonds = set->family.bonds, .broken = set->gone, .bytes = pls_bond_set_bytes(set)};
    double *energy = NULL;
    PLS_TRY(pls_allocate(&energy, set->family.count, sizeof *energy, "energies of bonds"));
    take_rows(world, set);
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < set->family.count; ++p) energy[p] = pls_bond_energy(set, p);
    figures->energy = pls_sum(energy, set->family.count, 1);
    figures->energy_broken = pls_sum(set->broken, set->family.count, 1);
    pls_release(&energy);
    return PLS_OK;
}

pls_bonds_figures pls_world_all_bonds(const pls_world *world)
{
    pls_bonds_figures sum = {0};
    for (size_t s = 0; s < world->bond_count; ++s)
    {
        const pls_bond_set *set = &world->bond[s];
        sum.points += set->family.count, sum.bonds += set->family.bonds, sum.broken += set->gone, sum.bytes += pls_bond_set_bytes(set);
    }
    return sum;
}

double pls_world_bonds_damage(const pls_world *world, pls_bonds_id id, pls_body_id body)
{
    const uint32_t number = body.index1 - 1;
    if (id.index1 < 1 || id.index1 > world->bond_count || pls_body_row(world, body) == PLS_NO_ROW) return NAN;
    const pls_bond_set *set = &world->bond[id.index1 - 1];
    const uint32_t p = number < set->numbers ? set->point_of[number] : PLS_NO_POINT;
    return p == PLS_NO_POINT ? NAN : (double)pls_bond_lost(set, p) / (double)set->family.size[p];
}

double pls_world_bonds_temperature(const pls_world *world, pls_bonds_id id, pls_body_id body)
{
    const uint32_t number = body.index1 - 1;
    if (id.index1 < 1 || id.index1 > world->bond_count || pls_body_row(world, body) == PLS_NO_ROW) return NAN;
    const pls_bond_set *set = &world->bond[id.index1 - 1];
    const uint32_t p = number < set->numbers ? set->point_of[number] : PLS_NO_POINT;
    return p == PLS_NO_POINT || !set->conditions.warmth ? NAN : set->conditions.warmth[p][PLS_HEAT_TEMPERATURE];
}

pls_status pls_world_cut_bonds(pls_world *world, pls_bonds_id id, pls_vec3 a, pls_vec3 b, pls_vec3 c, size_t *cut)
{
    pls_bond_set *set = find_set(world, id);
    *cut = 0;
    if (!set) return PLS_INVALID_ARGUMENT;
    PLS_TRY(pls_neighbours_detach(world));
    take_rows(world, set);
    const size_t before = set->gone;
    pls_bond_cut(set, world->def.dimension, a, b, c);
    *cut = set->gone - before;
    for (size_t p = 0; p < set->family.count; ++p) pls_bonds_note_damage(world, set->family.point[p].number);
    return PLS_OK;
}
