// timestep.c -- the stable time step from the contacts of each body, stiffness and damping, rotation included.
//
// Central differences with a dashpot are stable for  dt < (2/w)(sqrt(1 + z^2) - z),  w^2 the largest eigenvalue of M^-1 K and z = c/(2 w), c the largest of
// M^-1 C. The largest eigenvalues of the whole are bounded from those of single bodies: a contact's energy is 1/2 k (a - b)^2 with a, b the displacements of its two
// sides along a direction, and (a - b)^2 <= (1 + q) a^2 + (1 + 1/q) b^2 for any q > 0, so K is bounded by a matrix with one 6 x 6 block per body,
//
//     A_i = sum over contacts of (1 + q) (kn Jn^T Jn + kt sum over tangents Jt^T Jt),   J = (e, arm x e): displacement of the contact point along e,
//
// and the largest eigenvalue of M_i^-1/2 A_i M_i^-1/2 over all bodies bounds the largest of M^-1 K; the same with cn, ct. q = m_i/m_j (kept between 1/3 and 3)
// makes it exact for two spheres. A contact with a wall has b = 0 and weight 1.
//
// The bound can be half of the truth where neighbours cannot all move against a body at once. So a step that fails it is judged by the largest eigenvalues of the
// whole themselves (whole_rates.c).
//
// Before grains touch, the estimate adds contacts, evenly spread, up to the assumed coordination: a loose packing will become a dense one.

#include "step/timestep.h"

#include "base/parallel.h"
#include "math/eigen6.h"
#include "step/bonds.h"
#include "step/whole_rates.h"

#include <stdio.h>
#include <string.h>

static const double much_change = 0.02; ///< of a law's constants, after which the step is checked again
static const double near_gap = 0.05;    ///< of the radius: pairs nearer than this count as contacts before the first step

static double stable_dt(double stiffness, double damping)
{
    double c = 0.5 * damping, root = sqrt(stiffness + c * c) + c;
    return root > 0.0 ? 2.0 / root : INFINITY;
}

/// Add kn Jn^T Jn + kt sum of Jt^T Jt to the stiffness and likewise to the damping; rows of J scaled by the roots of inverse mass and inertia.
static void add_contact(pls_body_rates *rates, int dimension, pls_vec3 n, pls_vec3 arm, double root_mass, const double root_inertia[6],
                        const pls_contact_stiffness *k)
{
    double row[4][6] = {{0}}; // along x, y, z and n
    for (int e = 0; e < 4; ++e)
    {
        if (e == 2 && dimension == 2) continue;
        pls_vec3 axis = e == 3 ? n : pls_vec(e == 0, e == 1, e == 2);
        pls_vec3 turn = pls_symmetric_multiply(root_inertia, pls_cross(arm, axis));
        row[e][0] = root_mass * axis.x, row[e][1] = root_mass * axis.y, row[e][2] = root_mass * axis.z;
        row[e][3] = turn.x, row[e][4] = turn.y, row[e][5] = turn.z;
    }
    for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c)
        {
            double all = row[0][r] * row[0][c] + row[1][r] * row[1][c] + row[2][r] * row[2][c], along = row[3][r] * row[3][c];
            rates->stiffness[6 * r + c] += k->kn * along + k->kt * (all - along);
            rates->damping[6 * r + c] += k->cn * along + k->ct * (all - along);
        }
}

static void add_rate(const pls_world *world, uint32_t row, const pls_contact_rate *t, const double root_inertia[6], pls_body_rates *rates)
{
    const pls_bodies *b = &world->bodies;
    uint32_t other = row == t->i ? t->j : t->i;
    double m = b->mass[row].mass;
    double ratio = b->load[other].inv_mass > 0.0 ? fmin(fmax(m / b->mass[other].mass, 1.0 / 3.0), 3.0) : 0.0;
    double weight = 1.0 + ratio;
    const pls_contact_stiffness k = {.kn = weight * t->k.kn, .kt = weight * t->k.kt, .cn = weight * t->k.cn, .ct = weight * t->k.ct};
    add_contact(rates, world->def.dimension, t->n, row == t->i ? t->arm_i : t->arm_j, 1.0 / sqrt(m), root_inertia, &k);
}

static void add_from_list(const pls_world *world, uint32_t row, uint32_t entry, const double root_inertia[6], pls_body_rates *rates)
{
    if (!pls_pair_touches(&world->list, entry >> 1)) return;
    pls_contact_rate t = pls_contact_rate_of(world, entry >> 1);
    add_rate(world, row, &t, root_inertia, rates);
    ++rates->contacts;
}

static void add_solids(const pls_world *world, uint32_t row, const double root_inertia[6], pls_body_rates *rates)
{
    const pls_solid_list *list = &world->solids;
    for (uint32_t k = list->start[row]; k < list->start[row + 1]; ++k)
    {
        if (list->memory[list->entry[k] >> 1].touches != PLS_SOLID_TOUCHES) continue;
        pls_contact_rate t[PLS_SOLID_RATES];
        const int count = pls_solid_rates_of(world, list->entry[k] >> 1, t);
        for (int p = 0; p < count; ++p) add_rate(world, row, &t[p], root_inertia, rates);
        ++rates->contacts;
    }
}

/// As fmax, not a number `b` included, without a call.
static inline double larger(double a, double b) { return b > a ? b : a; }

/// The largest row sum of a matrix, which its eigenvalues do not exceed (Gershgorin).
static double row_bound(const double *a)
{
    double bound = 0.0;
    for (int r = 0; r < 6; ++r)
    {
        double sum = 0.0;
        for (int c = 0; c < 6; ++c) sum += fabs(a[6 * r + c]);
        bound = larger(bound, sum);
    }
    return bound;
}

/// A bound of the largest eigenvalue, at most 1.5 % too large: the 64th root of that of A^64, by six squarings, each of a matrix whose largest entry is one.
static double power_bound(const double *a)
{
    enum { SQUARINGS = 6 };
    double power[36], scale[SQUARINGS + 1];
    for (int k = 0; k < 36; ++k) power[k] = a[k];
    for (int s = 0; s <= SQUARINGS; ++s)
    {
        double next[36];
        scale[s] = 0.0;
        for (int k = 0; k < 36; ++k) scale[s] = larger(scale[s], fabs(power[k]));
        if (!(scale[s] > 0.0)) return 0.0;
        for (int k = 0; k < 36; ++k) power[k] /= scale[s];
        for (int r = 0; s < SQUARINGS && r < 6; ++r)
            for (int c = 0; c < 6; ++c)
            {
                double sum = 0.0;
                for (int k = 0; k < 6; ++k) sum += power[6 * r + k] * power[6 * c + k];
                next[6 * r + c] = sum;
            }
        if (s < SQUARINGS) memcpy(power, next, sizeof power);
    }
    double bound = scale[SQUARINGS] * row_bound(power);
    for (int s = SQUARINGS - 1; s >= 0; --s) bound = scale[s] * sqrt(bound); // of A_s = scale_s B, A_(s+1) = B^2
    return bound;
}

static pls_body_rates rates_of(const pls_world *world, uint32_t row, int coordination)
{
    const pls_pair_list *list = &world->list;
    pls_body_rates rates = {.contacts = 0};
    double root_inertia[6];
    pls_root_inverse_inertia(world, row, root_inertia);
    if (!world->memory_holds && list->count > 0)
    {
        for (uint32_t k = list->pairs.start[row]; k < list->pairs.start[row + 1]; ++k)
            add_from_list(world, row, list->pairs.entry[k], root_inertia, &rates);
        for (uint32_t k = list->walls.start[row]; k < list->walls.start[row + 1]; ++k)
            add_from_list(world, row, list->walls.entry[k], root_inertia, &rates);
    }
    if (!world->memory_holds && world->solids.count > 0) add_solids(world, row, root_inertia, &rates);
    pls_add_missing_contacts(world, row, coordination, &rates);
    for (int a = 0; world->bond_count > 0 && a < 6; ++a)
        rates.stiffness[7 * a] += pls_bonds_rate(world, world->bodies.kind[row].number, a >= 3);
    return rates;
}

/// Whether the body allows a smaller step than `dt`, judged by bounds of more and more work.
static bool is_worse(const pls_body_rates *rates, double dt)
{
    return stable_dt(row_bound(rates->stiffness), row_bound(rates->damping)) < dt &&
           stable_dt(power_bound(rates->stiffness), power_bound(rates->damping)) < dt;
}

/// Let the body take the place of the worst one if it allows a smaller step.
static void estimate_body(const pls_world *world, uint32_t number, int coordination, pls_step_estimate *worst)
{
    const uint32_t row = world->bodies.row_of[number];
    if (row == PLS_NO_ROW || world->bodies.load[row].inv_mass == 0.0) return;
    pls_body_rates rates = rates_of(world, row, coordination);
    if (!is_worse(&rates, worst->dt * (1.0 + 1e-12))) return; // bounds may be off by rounding, and threads come in any order
    double stiffness = pls_largest_eigenvalue(rates.stiffness, 6), damping = pls_largest_eigenvalue(rates.damping, 6);
    double dt = stable_dt(stiffness, damping);
    if (!(dt < worst->dt)) return;
    *worst = (pls_step_estimate){.dt = dt,
                                 .stiffness = stiffness,
                                 .damping = damping,
                                 .body = number,
                                 .contacts = rates.contacts,
                                 .damping_limits = damping > sqrt(stiffness),
                                 .bonds = world->bond_count > 0 ? pls_bonds_rate(world, number, false) : 0.0};
}

/// The bound body by body: of those that allow the smallest step, less than `below`, the first; none: a step of `below`.
static void estimate(const pls_world *world, int coordination, double below, pls_step_estimate *worst)
{
    const uint32_t numbers = (uint32_t)world->bodies.numbers;
    *worst = (pls_step_estimate){.dt = below};
#pragma omp parallel if (numbers > PLS_BLOCK)
    {
        pls_step_estimate mine = {.dt = below};
#pragma omp for schedule(static)
        for (uint32_t number = 0; number < numbers; ++number) estimate_body(world, number, coordination, &mine);
#pragma omp critical(pls_step_estimate)
        if (mine.dt < worst->dt || (mine.dt == worst->dt && mine.dt < below && mine.body < worst->body)) *worst = mine;
    }
}

/// Judge a step that fails the bound by the eigenvalues of the whole.
static pls_status refine(const pls_world *world, int coordination, pls_step_estimate *e)
{
    double stiffness, damping;
    PLS_TRY(pls_whole_rates(world, coordination, &stiffness, &damping));
    if (!isfinite(stiffness) || !isfinite(damping)) return PLS_OK; // the bound stays
    double dt = stable_dt(stiffness, damping);
    if (dt > e->dt) e->dt = dt, e->stiffness = stiffness, e->damping = damping, e->damping_limits = damping > sqrt(stiffness);
    return PLS_OK;
}

/// Which candidates touch is known after the contact loop only; before it, take those that touch or nearly do (in a regular packing round-off decides which of
/// a body's contacts exist).
static void mark_near(pls_world *world)
{
    pls_pair_list *list = &world->list;
    const pls_bodies *b = &world->bodies;
    for (size_t s = 0; s < list->section_count; ++s)
    {
        const pls_pair_section *section = &list->section[s];
        for (size_t c = section->first; c < section->first + section->count; ++c)
        {
            if (!section->wall && !(pls_pair_free_lanes(list, c) >> (c & 7) & 1)) continue; // a bond holds the two
            const pls_body_place *p = &b->place[list->row_i[c]], *q = &b->place[list->row_j[c]];
            double d[3] = {q->x - p->x, q->y - p->y, q->z - p->z}, delta;
            if (section->wall)
            {
                pls_vec3 n = pls_wall_normal(&b->orientation[section->wall_row], world->def.dimension);
                delta = p->radius + n.x * d[0] + n.y * d[1] + n.z * d[2];
            }
            else
            {
                for (int a = 0; world->domain.any_periodic && a < 3; ++a) d[a] += list->shift[c][a] * world->domain.edge[a];
                delta = p->radius + q->radius - sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
            }
            unsigned bit = 1u << (c & 7);
            list->touch[c >> 3] =
                (uint8_t)(delta > -near_gap * fmin(p->radius, q->radius) ? list->touch[c >> 3] | bit : list->touch[c >> 3] & ~bit);
        }
    }
}

/// The same for solids: their geometry of now.
static void mark_near_solids(pls_world *world)
{
    pls_solid_list *list = &world->solids;
    const pls_contact_input input = pls_contact_input_of(world, 0.0);
    pls_solid_pose(list, &input, &world->bodies, world->shape_of, 0, list->row_count);
    for (size_t c = 0; c < list->count; ++c)
    {
        const pls_solid_pair *pair = &list->pair[c];
        double radius = fmin(world->bodies.place[pair->row_i].radius, world->bodies.place[pair->row_j].radius);
        list->touch[c] = pls_solid_touch_now(list, &input, c);
        list->memory[c].touches = list->touch[c].delta > -near_gap * radius ? PLS_SOLID_TOUCHES : PLS_SOLID_APART;
    }
}

/// Contacts begin with the first forces.
static void mark_none(pls_world *world)
{
    memset(world->list.touch, 0, world->list.count / 8 + 1);
    for (size_t c = 0; c < world->solids.count; ++c) world->solids.memory[c].touches = PLS_SOLID_APART;
}

pls_status pls_world_stable_step(pls_world *world, pls_step_estimate *out)
{
    if (!world->prepared)
    {
        PLS_TRY(pls_states_apply(world));
        PLS_TRY(pls_neighbours_refresh(world));
        mark_near(world);
        mark_near_solids(world);
    }
    estimate(world, world->def.coordination, INFINITY, out);
    if (!world->prepared) mark_none(world);
    return PLS_OK;
}

/// Whether the step would be stable with the contacts there are, so that it is those still to come, as many as `coordination` says, that refuse it.
static pls_status only_assumed(const pls_world *world, bool *only)
{
    pls_step_estimate now;
    estimate(world, 0, INFINITY, &now);
    if (world->dt > now.dt) PLS_TRY(refine(world, 0, &now));
    *only = world->dt <= now.dt;
    return PLS_OK;
}

/// `coordination`: assumed by the estimate.
static pls_status refuse(const pls_world *world, int coordination, const pls_step_estimate *e)
{
    char limit[160], assumed[200] = "";
    bool only = false;
    if (coordination > 0) PLS_TRY(only_assumed(world, &only));
    if (only)
        snprintf(assumed, sizeof assumed,
                 " Contacts still to come set it, %d per body: with those there are now the step would do. Where bodies will never have so "
                 "many, "
                 "say how many by time.coordination.",
                 coordination);
    if (!e->damping_limits && e->bonds > 0.5 * e->stiffness)
        snprintf(limit, sizeof limit, "its bonds limit it: natural frequency %.4g 1/s", sqrt(e->bonds));
    else if (e->damping_limits)
        snprintf(limit, sizeof limit, "its dashpots limit it: damping rate %.4g 1/s, against a natural frequency of %.4g 1/s", e->damping,
                 sqrt(e->stiffness));
    else
        snprintf(limit, sizeof limit, "its springs limit it: natural frequency %.4g 1/s, damping rate %.4g 1/s", sqrt(e->stiffness),
                 e->damping);
    return pls_fail(
        PLS_UNSTABLE_STEP,
        "the time step %g s is larger than the stable step %.4g s at t = %g s. Body %u with %d contacts sets it; %s.%s Take dt: "
        "auto or a smaller dt "
        "(or time.allow_unstable: true)",
        world->dt, e->dt, world->time, e->body, e->contacts, limit, assumed);
}

/// Heat has a step of its own, whatever bodies do.
static pls_status check_heat(const pls_world *world)
{
    const char *name = "";
    const double longest = pls_bonds_heat_step(world, &name);
    if (world->dt <= longest || world->def.allow_unstable) return PLS_OK;
    return pls_fail(PLS_UNSTABLE_STEP,
                    "the time step %g s is larger than the stable step %.4g s of heat in bonds '%s'. Take dt: auto or a smaller dt (or "
                    "time.allow_unstable: true)",
                    world->dt, longest, name);
}

pls_status pls_choose_step(pls_world *world)
{
    const char *name = "";
    pls_step_estimate e;
    mark_near(world);
    mark_near_solids(world);
    estimate(world, world->def.coordination, INFINITY, &e);
    pls_status status = PLS_OK;
    if (world->dt > e.dt && !world->def.allow_unstable)
    {
        status = refine(world, world->def.coordination, &e);
        if (status == PLS_OK && world->dt > e.dt) status = refuse(world, world->def.coordination, &e);
    }
    mark_none(world);
    PLS_TRY(status);
    e.dt = fmin(e.dt, pls_bonds_heat_step(world, &name));
    if (world->dt == 0.0)
    {
        if (!isfinite(e.dt))
            return pls_fail(PLS_UNSTABLE_STEP, "no contact law and no bonds limit the time step, so it cannot be chosen; give dt [s]");
        world->dt = world->def.safety * e.dt;
        return PLS_OK;
    }
    return check_heat(world);
}

bool pls_stable_step_is_stale(const pls_world *world)
{
    for (size_t l = 0; world->binding_count > 0 && l < world->laws.law_count; ++l)
        for (int k = 0; k < PLS_LAW_MAX_CONSTANTS; ++k)
        {
            double now = world->laws.law[l].constants[k], then = world->laws.law[l].checked[k];
            if (now != then && !(fabs(now - then) <= much_change * fabs(then))) return true;
        }
    return false;
}

pls_status pls_check_stable_step(pls_world *world)
{
    if (world->def.allow_unstable) return PLS_OK;
    for (size_t l = 0; l < world->laws.law_count; ++l)
        memcpy(world->laws.law[l].checked, world->laws.law[l].constants, sizeof world->laws.law[l].checked);
    pls_step_estimate e;
    estimate(world, 0, world->dt, &e);
    if (world->dt <= e.dt) return PLS_OK;
    PLS_TRY(refine(world, 0, &e));
    return world->dt <= e.dt ? PLS_OK : refuse(world, 0, &e);
}
