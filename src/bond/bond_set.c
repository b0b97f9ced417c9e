// bond_set.c -- making a set of bonds, and what is asked of it outside its two loops.

#include "bond/bond_set.h"

#include "base/alloc.h"
#include "bond/influence.h"

#include <string.h>

void pls_bond_set_free(pls_bond_set *set)
{
    pls_families_free(&set->family);
    pls_release(&set->weight);
    pls_release(&set->share);
    pls_release(&set->spread);
    pls_release(&set->dilation);
    pls_release(&set->broken);
    pls_release(&set->row);
    pls_release(&set->force);
    pls_release(&set->torque);
    pls_links_free(&set->links);
    pls_force_states_free(&set->states);
    pls_conditions_free(&set->conditions);
    pls_release(&set->limit);
    pls_release(&set->overlong);
    pls_release(&set->number);
    pls_release(&set->point_of);
    memset(set, 0, sizeof *set);
}

size_t pls_bond_set_bytes(const pls_bond_set *set)
{
    const pls_families *f = &set->family;
    if (f->count == 0) return 0;
    const size_t slots = (size_t)f->start[f->count] * PLS_BOND_VECTOR;
    const size_t linear = set->weight
                              ? slots * (sizeof *set->weight + sizeof *set->share) +
                                    f->count * (sizeof *set->dilation + sizeof *set->spread) + (f->count + f->ghosts) * sizeof *set->row
                              : 0;
    return linear + pls_links_bytes(&set->links, f) + pls_force_states_bytes(&set->states, f) + pls_conditions_bytes(&set->conditions, f) +
           (set->limit ? slots * sizeof *set->limit : 0) + (set->torque ? f->count * sizeof *set->torque : 0) +
           slots * (sizeof *f->partner + sizeof *f->length) +
           f->count * (sizeof *f->point + sizeof *f->start + sizeof *f->size + sizeof *set->broken + sizeof *set->force +
                       sizeof *set->overlong + sizeof *set->number) +
           f->ghosts * sizeof *f->ghost + set->numbers * sizeof *set->point_of;
}

static inline size_t first_slot(const pls_bond_set *set, size_t point) { return (size_t)set->family.start[point] * PLS_BOND_VECTOR; }

// ---- making ----------------------------------------------------------------------------------------------------------------------------------------------

/// What is summed over each family.
typedef struct family_sums
{
    double weighted; ///< m [m^5]
    double volume;   ///< of the partners [m^3]
} family_sums;

/// Unit vector of a bond, from reference positions.
static void unit_of(const pls_bond_set *set, const pls_domain *domain, size_t p, size_t slot, double n[3])
{
    const pls_families *f = &set->family;
    const uint32_t partner = f->partner[slot];
    const pls_bond_point *a = &f->point[p], *b = &f->point[pls_point_behind(f, partner)];
    for (int c = 0; c < 3; ++c)
    {
        const double shift = partner < f->count ? 0.0 : f->ghost[partner - f->count].shift[c] * domain->edge[c];
        n[c] = (b->x[c] - a->x[c] + shift) / f->length[slot];
    }
}

/// Of the partner's volume that counts.
static double part_of(const pls_bond_set *set, size_t p, size_t slot)
{
    const pls_bond_point *a = &set->family.point[p], *b = &set->family.point[pls_point_behind(&set->family, set->family.partner[slot])];
    return pls_partial_volume(set->family.length[slot], set->horizon, 0.5 * (a->spacing + b->spacing));
}

/// Weights of the bonds of all families.
static pls_status weigh(pls_bond_set *set, const pls_bond_plan *plan, family_sums *sums)
{
    const pls_families *f = &set->family;
    bool wrong = false;
#pragma omp parallel for schedule(static) reduction(|| : wrong)
    for (size_t p = 0; p < f->count; ++p)
    {
        const pls_bond_point *a = &f->point[p];
        for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + f->size[p]; ++slot)
        {
            const pls_bond_point *b = &f->point[pls_point_behind(f, f->partner[slot])];
            const double xi = f->length[slot], w = pls_influence_at(plan->def, xi), part = part_of(set, p, slot);
            if (!(w >= 0.0) || !isfinite(w)) wrong = true;
            set->weight[slot] = w * part * (a->volume * b->volume) * xi;
            sums[p].weighted += w * part * b->volume * xi * xi;
            sums[p].volume += part * b->volume;
        }
    }
    if (wrong)
        return pls_fail(PLS_INVALID_ARGUMENT, "bonds '%s': the influence function is negative or no number within the horizon of %g m",
                        set->name, set->horizon);
    for (size_t p = 0; p < f->count; ++p)
        if (!(sums[p].weighted > 0.0))
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "bonds '%s': all bonds of body %u weigh nothing, as the influence function is zero where its partners are; "
                            "take a larger horizon",
                            set->name, f->point[p].number);
    return PLS_OK;
}

/// The point whose family is the fullest.
static size_t fullest_of(const pls_bond_set *set, const family_sums *sums)
{
    size_t fullest = 0;
    for (size_t p = 1; p < set->family.count; ++p)
        if (sums[p].weighted > sums[fullest].weighted) fullest = p;
    return fullest;
}

/// 1/m of every point. Of independent springs, and where volumes of families correct, m is that of the fullest family: inside a body a lattice then has the moduli asked for. (That of a continuum
/// would leave a lattice of three spacings an eighth too soft.)
static void inverse_weights(const pls_bond_set *set, const pls_bond_plan *plan, const family_sums *sums, double *inverse)
{
    const bool common = plan->def->ops->pairwise || plan->def->correction == PLS_CORRECTION_VOLUME;
    const double fullest = sums[fullest_of(set, sums)].weighted;
    for (size_t p = 0; p < set->family.count; ++p) inverse[p] = 1.0 / (common ? fullest : sums[p].weighted);
}

/// What a family makes of a unit stretch along each axis: the dilatation, and what bonds store, both but for common factors, per volume of its point and of a material of unit stiffness: of what is
/// at fault with the family, its shape alone.
typedef struct stretches
{
    double dilated[3], stored[3];
} stretches;

static stretches stretches_of(const pls_bond_set *set, const pls_domain *domain, const family_sums *sums, size_t p)
{
    stretches sum = {{0.0}, {0.0}};
    const double per_volume = 1.0 / set->family.point[p].volume;
    for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + set->family.size[p]; ++slot)
    {
        double n[3];
        unit_of(set, domain, p, slot, n);
        const double g = set->weight[slot] * set->family.length[slot] * per_volume;
        for (int c = 0; c < 3; ++c)
        {
            sum.dilated[c] += g / sums[p].weighted * n[c] * n[c];
            sum.stored[c] += g * (double)set->share[slot] * n[c] * n[c] * n[c] * n[c];
        }
    }
    return sum;
}

/// Of a bond along n between families that make `a` and `b` of stretches along the axes, where a full one makes `full`: what makes up for it, by the ellipsoid with those axes (Madenci and Oterkus 2014,
/// section 4.2.2).
static double ellipsoid(const double n[3], const double a[3], const double b[3], const double full[3])
{
    double sum = 0.0;
    for (int c = 0; c < 3; ++c)
    {
        const double part = full[c] > 0.0 ? 0.5 * (a[c] + b[c]) / full[c] : 1.0;
        sum += n[c] * n[c] * part * part;
    }
    return sum > 0.0 ? 1.0 / sqrt(sum) : 1.0; // zero of bonds that weigh nothing
}

/// Correct each bond by what its families lack, time and again: bonds have two families, so that what helps one changes the other.
static pls_status correct_by_energy(pls_bond_set *set, const pls_domain *domain, const family_sums *sums)
{
    enum { PASSES = 12 };
    const pls_families *f = &set->family;
    stretches *now = NULL;
    PLS_TRY(pls_allocate(&now, f->count, sizeof *now, "the correction of surfaces"));
    const stretches full = stretches_of(set, domain, sums, fullest_of(set, sums));
    for (int pass = 0; pass < PASSES; ++pass)
    {
#pragma omp parallel for schedule(static)
        for (size_t p = 0; p < f->count; ++p) now[p] = stretches_of(set, domain, sums, p);
#pragma omp parallel for schedule(static)
        for (size_t p = 0; p < f->count; ++p)
            for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + f->size[p]; ++slot)
            {
                const stretches *a = &now[p], *b = &now[pls_point_behind(f, f->partner[slot])];
                double n[3];
                unit_of(set, domain, p, slot, n);
                const double dilation = set->dilates ? ellipsoid(n, a->dilated, b->dilated, full.dilated) : 1.0;
                set->weight[slot] *= dilation;
                set->share[slot] = (float)((double)set->share[slot] * (ellipsoid(n, a->stored, b->stored, full.stored) / dilation));
            }
    }
    pls_release(&now);
    return PLS_OK;
}

static double extension_of(const pls_bond_set *set, const pls_bond_plan *plan, size_t p)
{
    return plan->law[plan->material[set->family.point[p].number]].extension;
}

/// What the law makes of the families: B is extension/m. Shares are of unit stiffness until families are corrected.
static pls_status load_law(pls_bond_set *set, const pls_bond_plan *plan, const pls_domain *domain, const family_sums *sums,
                           const double *inverse)
{
    const pls_families *f = &set->family;
    const size_t fullest = fullest_of(set, sums);
    for (size_t p = 0; p < f->count; ++p)
    {
        const double m = sums[p].weighted;
        set->dilation[p] = plan->law[plan->material[f->point[p].number]].dilation * domain->dimension / (m * m * f->point[p].volume);
        set->dilates = set->dilates || set->dilation[p] != 0.0;
    }
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < f->count; ++p)
        for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + f->size[p]; ++slot)
        {
            const uint32_t q = pls_point_behind(f, f->partner[slot]);
            double both = inverse[p] + inverse[q];
            if (plan->def->correction == PLS_CORRECTION_VOLUME) both *= 2.0 * sums[fullest].volume / (sums[p].volume + sums[q].volume);
            set->share[slot] = (float)(both / (2.0 * inverse[fullest]));
        }
    if (plan->def->correction == PLS_CORRECTION_ENERGY) PLS_TRY(correct_by_energy(set, domain, sums));
    const double stiffness = extension_of(set, plan, fullest);
    set->twice = 2.0 * stiffness * inverse[fullest];
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < f->count; ++p)
        for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + f->size[p]; ++slot)
        {
            const uint32_t q = pls_point_behind(f, f->partner[slot]);
            const double a = extension_of(set, plan, p), b = extension_of(set, plan, q);
            if (a == stiffness && b == stiffness) continue;
            set->share[slot] *= (float)((a * inverse[p] + b * inverse[q]) / (stiffness * (inverse[p] + inverse[q])));
        }
    return PLS_OK;
}

static pls_bond_end other_end(const pls_bond_set *set, pls_bond_end end);

/// Of each bond d w beta V_i V_j (1/m_i + 1/m_j), times a conductivity what it conducts (condition.c).
static pls_status make_conduction(const pls_bond_set *set, const pls_domain *domain, const family_sums *sums, double **conduction)
{
    const pls_families *f = &set->family;
    PLS_TRY(pls_allocate(conduction, (size_t)f->start[f->count] * PLS_BOND_VECTOR, sizeof **conduction, "heat of bonds"));
    for (size_t p = 0; p < f->count; ++p)
        for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + f->size[p]; ++slot)
        {
            const size_t q = pls_point_behind(f, f->partner[slot]);
            (*conduction)[slot] =
                domain->dimension * set->weight[slot] / f->length[slot] * (1.0 / sums[p].weighted + 1.0 / sums[q].weighted);
        }
    return PLS_OK;
}

/// sum beta V_j xi of the family where it is largest.
static double first_moment(const pls_bond_set *set)
{
    const pls_families *f = &set->family;
    double largest = 0.0;
    for (size_t p = 0; p < f->count; ++p)
    {
        double sum = 0.0;
        for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + f->size[p]; ++slot)
            sum += part_of(set, p, slot) * f->point[pls_point_behind(f, f->partner[slot])].volume * f->length[slot];
        largest = fmax(largest, sum);
    }
    return largest;
}

/// The critical energy of each bond, as the loop of forces meets it: g pull e / (2 xi) by its two volumes.
static pls_status make_limits(pls_bond_set *set, const pls_bond_plan *plan)
{
    const pls_families *f = &set->family;
    if (!isfinite(plan->energy)) return PLS_OK;
    PLS_TRY(pls_allocate(&set->limit, (size_t)f->start[f->count] * PLS_BOND_VECTOR, sizeof *set->limit, "bonds"));
    const double critical = pls_critical_energy(set->dimension, first_moment(set), plan->energy);
    for (size_t p = 0; p < f->count; ++p)
        for (size_t slot = first_slot(set, p), end = (size_t)f->start[p + 1] * PLS_BOND_VECTOR, k = 0; slot < end; ++slot, ++k)
        {
            set->limit[slot] = INFINITY;
            if (k >= f->size[p] || !(set->weight[slot] > 0.0)) continue;
            const double volumes = f->point[p].volume * f->point[pls_point_behind(f, f->partner[slot])].volume;
            set->limit[slot] = critical * part_of(set, p, slot) * volumes * f->length[slot] / set->weight[slot];
        }
    return PLS_OK;
}

/// A family law takes its weights from those of its first, linear response: what corrects a bond's stiffness is its share, compared with that of families that lack nothing.
static pls_status make_states(pls_bond_set *set, const pls_bond_plan *plan, const family_sums *sums)
{
    const pls_families *f = &set->family;
    pls_force_states *states = &set->states;
    PLS_TRY(pls_force_states_make(states, plan->def->ops, f, plan->materials));
    memcpy(states->constants, plan->constants, plan->materials * sizeof *states->constants);
    for (size_t p = 0; p < f->count; ++p)
    {
        states->material[p] = plan->material[f->point[p].number];
        states->weighted[p] = sums[p].weighted;
    }
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < f->count; ++p)
        for (size_t slot = first_slot(set, p), end = (size_t)f->start[p + 1] * PLS_BOND_VECTOR, k = 0; slot < end; ++slot, ++k)
        {
            const bool bond = k < f->size[p];
            states->reference[slot] = bond ? f->length[slot] : set->horizon;
            states->correction[slot] = 1.0;
            if (!bond) continue;
            const pls_bond_end other = other_end(set, (pls_bond_end){(uint32_t)p, slot});
            states->back[slot] = (uint32_t)(other.slot - first_slot(set, other.point));
            const double whole =
                extension_of(set, plan, p) / sums[p].weighted + extension_of(set, plan, other.point) / sums[other.point].weighted;
            if (plan->def->correction != PLS_CORRECTION_NONE && whole > 0.0)
                states->correction[slot] = set->twice * (double)set->share[slot] / whole;
        }
    return PLS_OK;
}

static pls_status allocate(pls_bond_set *set)
{
    const pls_families *f = &set->family;
    PLS_TRY(pls_allocate(&set->broken, f->count, sizeof *set->broken, "points of bonds"));
    PLS_TRY(pls_allocate(&set->force, f->count, sizeof *set->force, "points of bonds"));
    PLS_TRY(pls_allocate(&set->overlong, f->count, sizeof *set->overlong, "points of bonds"));
    for (size_t p = 0; p < f->count; ++p)
        if (f->point[p].number >= set->numbers) set->numbers = (size_t)f->point[p].number + 1;
    PLS_TRY(pls_allocate(&set->number, f->count, sizeof *set->number, "points of bonds"));
    for (size_t p = 0; p < f->count; ++p) set->number[p] = f->point[p].number;
    PLS_TRY(pls_allocate(&set->point_of, set->numbers, sizeof *set->point_of, "points of bonds"));
    for (size_t n = 0; n < set->numbers; ++n) set->point_of[n] = PLS_NO_POINT;
    for (size_t p = 0; p < f->count; ++p) set->point_of[f->point[p].number] = (uint32_t)p;
    return PLS_OK;
}

static pls_status allocate_linear(pls_bond_set *set)
{
    const pls_families *f = &set->family;
    const size_t slots = (size_t)f->start[f->count] * PLS_BOND_VECTOR;
    PLS_TRY(pls_allocate(&set->weight, slots, sizeof *set->weight, "bonds"));
    PLS_TRY(pls_allocate(&set->share, slots, sizeof *set->share, "bonds"));
    PLS_TRY(pls_allocate(&set->spread, f->count, sizeof *set->spread, "points of bonds"));
    PLS_TRY(pls_allocate(&set->dilation, f->count, sizeof *set->dilation, "points of bonds"));
    return pls_allocate(&set->row, f->count + f->ghosts, sizeof *set->row, "points of bonds");
}

static pls_status make_linear(pls_bond_set *set, const pls_bond_plan *plan, const pls_domain *domain)
{
    family_sums *sums = NULL;
    double *inverse = NULL;
    PLS_TRY(allocate_linear(set));
    pls_status status = pls_allocate(&sums, set->family.count, sizeof *sums, "points of bonds");
    if (status == PLS_OK) status = pls_allocate(&inverse, set->family.count, sizeof *inverse, "points of bonds");
    double *conduction = NULL;
    if (status == PLS_OK) status = weigh(set, plan, sums);
    if (status == PLS_OK && !isnan(plan->def->heat.conductivity)) status = make_conduction(set, domain, sums, &conduction);
    if (status == PLS_OK)
    {
        inverse_weights(set, plan, sums, inverse);
        status = load_law(set, plan, domain, sums, inverse);
    }
    if (status == PLS_OK && plan->def->ops->pull) status = make_states(set, plan, sums);
    if (status == PLS_OK) status = make_limits(set, plan);
    if (status == PLS_OK)
        status = pls_conditions_make(&set->conditions, plan->def, &set->family, conduction, plan->heat, plan->material, plan->time);
    else
        pls_release(&conduction);
    pls_release(&sums);
    pls_release(&inverse);
    return status;
}

static pls_status make_links(pls_bond_set *set, const pls_bond_plan *plan, const pls_bodies *bodies, const pls_domain *domain)
{
    set->links.ops = plan->def->ops;
    memcpy(set->links.constants, plan->constants[plan->some_material], sizeof set->links.constants);
    PLS_TRY(pls_allocate(&set->torque, set->family.count, sizeof *set->torque, "points of bonds"));
    PLS_TRY(pls_links_make(&set->links, &set->family, bodies, domain));
    return pls_conditions_make(&set->conditions, plan->def, &set->family, NULL, plan->heat, plan->material, plan->time);
}

pls_status pls_bond_set_make(pls_bond_set *set, const pls_bond_plan *plan, pls_bond_point *point, size_t count, const pls_bodies *bodies,
                             const pls_domain *domain)
{
    *set = (pls_bond_set){.horizon = plan->def->horizon, .stretch = plan->stretch, .dimension = domain->dimension};
    memcpy(set->name, plan->def->name, sizeof set->name);
    set->conditions = (pls_conditions){.user = plan->def->user, .release = plan->def->release}; // whatever fails
    pls_status status = pls_families_make(&set->family, point, count, plan->def->horizon, domain);
    if (status == PLS_OK) status = allocate(set);
    if (status == PLS_OK) status = plan->def->ops->pair ? make_links(set, plan, bodies, domain) : make_linear(set, plan, domain);
    if (status != PLS_OK) pls_bond_set_free(set);
    return status;
}

// ---- a step ------------------------------------------------------------------------------------------------------------------------------------------------

void pls_bond_take_places(pls_bond_set *set, const pls_bodies *bodies, size_t first, size_t last)
{
    if (set->links.ops)
    {
        pls_links_take_poses(&set->links, &set->family, bodies, first, last);
        return;
    }
    for (size_t p = first; p < last; ++p)
    {
        const uint32_t number = set->number[p], row = number < bodies->numbers ? bodies->row_of[number] : PLS_NO_ROW;
        if (row == PLS_NO_ROW) continue; // taken out of the world; all its bonds are broken
        const pls_body_place *place = &bodies->place[row];
        set->row[p][0] = place->x, set->row[p][1] = place->y, set->row[p][2] = place->z;
    }
}

void pls_bond_take_spread(pls_bond_set *set)
{
    for (size_t p = 0; p < set->family.count; ++p) set->row[p][3] = set->spread[p];
}

void pls_bond_take_ghosts(pls_bond_set *set, const pls_domain *domain)
{
    if (set->links.ops)
    {
        pls_links_take_ghosts(&set->links, &set->family, domain);
        return;
    }
    for (size_t g = 0; g < set->family.ghosts; ++g)
    {
        const pls_bond_ghost *ghost = &set->family.ghost[g];
        const double *from = set->row[ghost->point];
        double *to = set->row[set->family.count + g];
        for (int a = 0; a < 3; ++a) to[a] = from[a] + ghost->shift[a] * domain->edge[a];
        to[3] = from[3];
    }
}

void pls_bond_gather(const pls_bond_set *set, const pls_bodies *bodies, size_t first, size_t last, double *force, double *torque)
{
    for (size_t row = first; row < last; ++row)
    {
        const uint32_t number = bodies->kind[row].number, p = number < set->numbers ? set->point_of[number] : PLS_NO_POINT;
        if (p == PLS_NO_POINT) continue;
        for (size_t a = 0; a < 3; ++a) force[4 * (row - first) + a] += set->force[p][a];
        for (size_t a = 0; set->torque && a < 3; ++a) torque[4 * (row - first) + a] += set->torque[p][a];
    }
}

// ---- asking, breaking --------------------------------------------------------------------------------------------------------------------------------------

/// Where a point or ghost is.
static inline const double *place_of(const pls_bond_set *set, size_t point)
{
    return set->links.ops ? set->links.pose[point] : set->row[point];
}

/// Length of a bond now, as the loops compute it.
static double length_of(const pls_bond_set *set, size_t point, size_t slot)
{
    const double *x = place_of(set, point), *y = place_of(set, set->family.partner[slot]);
    const double d[3] = {y[0] - x[0], y[1] - x[1], y[2] - x[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/// Means of a bond's two points.
static double mean_of(const pls_bond_set *set, size_t point, size_t slot, int column)
{
    const double(*row)[PLS_CONDITION_NUMBERS] = (const double(*)[PLS_CONDITION_NUMBERS])set->conditions.row;
    if (!row) return column == PLS_CONDITION_STRAIN ? 0.0 : 1.0;
    return 0.5 * (row[set->family.partner[slot]][column] + row[point][column]);
}

/// What a bond is longer by than its reference length and temperature make it.
static double extension_now(const pls_bond_set *set, size_t point, size_t slot)
{
    const double xi = fabs(set->family.length[slot]);
    return length_of(set, point, slot) - xi - xi * mean_of(set, point, slot, PLS_CONDITION_STRAIN);
}

static double own_stiffness(const pls_bond_set *set, size_t point)
{
    return set->conditions.row ? set->conditions.row[point][PLS_CONDITION_STIFFNESS] : 1.0;
}

/// What the law of a point is asked with. `memory`: of as many pointers.
static pls_family_batch batch_of(const pls_bond_set *set, size_t p, double step, double *memory[PLS_BOND_MAX_MEMORY], double *energy,
                                 double *spent)
{
    const pls_families *f = &set->family;
    const pls_force_states *states = &set->states;
    const size_t first = first_slot(set, p);
    for (int k = 0; k < states->ops->memories; ++k) memory[k] = states->memory[k] + first;
    return (pls_family_batch){.count = (size_t)(f->start[p + 1] - f->start[p]) * PLS_BOND_VECTOR,
                              .dimension = set->dimension,
                              .constants = states->constants[states->material[p]],
                              .volume = f->point[p].volume,
                              .weighted = states->weighted[p],
                              .reference = states->reference + first,
                              .extension = states->extension + first,
                              .weight = set->weight + first,
                              .correction = states->correction + first,
                              .memory = memory,
                              .point_memory = states->of_point[p],
                              .stiffness = own_stiffness(set, p),
                              .step = step,
                              .tension = states->tension + first,
                              .energy = energy,
                              .spent = spent};
}

void pls_bond_ask_states(pls_bond_set *set, size_t first, size_t last, double dt)
{
    for (size_t p = first; p < last; ++p)
    {
        double *memory[PLS_BOND_MAX_MEMORY], energy = 0.0;
        set->states.spent[p] = 0.0;
        PLS_SIMD_SELECT(pls_states_stretch)(set, p);
        const pls_family_batch batch = batch_of(set, p, dt, memory, &energy, &set->states.spent[p]);
        if (dt > 0.0 && set->states.ops->advance) set->states.ops->advance(&batch);
        set->states.ops->pull(&batch);
        if (!set->conditions.row) continue;
        const double stiffness = own_stiffness(set, p);
        set->states.spent[p] *= stiffness;
        for (size_t k = 0; k < batch.count; ++k) batch.tension[k] *= stiffness;
    }
}

/// Do something with a family of links as they are now, a batch at a time. `slot`: of the first of `count` bonds.
typedef void link_action(const pls_link_work *work, size_t slot, size_t count, void *context);

static void each_batch(const pls_bond_set *set, size_t point, link_action *action, void *context)
{
    enum { VECTORS = PLS_LAW_BATCH / PLS_BOND_VECTOR };
    const size_t end = set->family.start[point + 1];
    pls_link_work work;
    for (size_t vector = set->family.start[point]; vector < end; vector += VECTORS)
    {
        const size_t vectors = end - vector < VECTORS ? end - vector : VECTORS;
        PLS_SIMD_SELECT(pls_link_family)(set, point, vector, vectors, &work);
        action(&work, vector * PLS_BOND_VECTOR, vectors * PLS_BOND_VECTOR, context);
    }
}

/// Half of a bond's energy is either end's.
static void add_energy(const pls_link_work *work, size_t slot, size_t count, void *context)
{
    double *sum = context;
    (void)slot;
    for (size_t k = 0; k < count; ++k)
        if (work->reference[k] < PLS_NO_LENGTH) *sum += 0.5 * work->energy[k];
}

double pls_bond_energy(const pls_bond_set *set, size_t point)
{
    if (set->links.ops)
    {
        double sum = 0.0;
        each_batch(set, point, add_energy, &sum);
        return sum;
    }
    if (set->states.ops)
    {
        double *memory[PLS_BOND_MAX_MEMORY], energy = 0.0, spent = 0.0;
        PLS_SIMD_SELECT(pls_states_stretch)(set, point); // scratch of this point alone
        const pls_family_batch batch = batch_of(set, point, 0.0, memory, &energy, &spent);
        set->states.ops->pull(&batch);
        return own_stiffness(set, point) * energy;
    }
    double spread = 0.0, stretched = 0.0;
    for (size_t slot = first_slot(set, point); slot < first_slot(set, point) + set->family.size[point]; ++slot)
    {
        if (!pls_bond_is_whole(set, slot)) continue;
        const double xi = fabs(set->family.length[slot]), e = extension_now(set, point, slot);
        spread += set->weight[slot] * e;
        stretched +=
            set->weight[slot] * set->twice * (double)set->share[slot] * mean_of(set, point, slot, PLS_CONDITION_STIFFNESS) * e * e / xi;
    }
    return 0.5 * own_stiffness(set, point) * set->dilation[point] * spread * spread + 0.25 * stretched;
}

/// The first slot of a family whose partner is point q or a later one: families are in order of points.
static size_t first_bond_to(const pls_bond_set *set, size_t p, uint32_t q)
{
    size_t low = first_slot(set, p), high = low + set->family.size[p];
    while (low < high)
    {
        const size_t middle = low + (high - low) / 2;
        if (pls_point_behind(&set->family, set->family.partner[middle]) < q)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/// The same bond in the partner's family.
static pls_bond_end other_end(const pls_bond_set *set, pls_bond_end end)
{
    const pls_families *f = &set->family;
    const uint32_t partner = f->partner[end.slot], q = pls_point_behind(f, partner);
    const pls_bond_ghost *image = partner < f->count ? NULL : &f->ghost[partner - f->count];
    for (size_t slot = first_bond_to(set, q, end.point); slot < first_slot(set, q) + f->size[q]; ++slot)
    {
        const uint32_t back = f->partner[slot];
        if (pls_point_behind(f, back) != end.point) break;
        if ((back < f->count) != !image) continue;
        const pls_bond_ghost *own = image ? &f->ghost[back - f->count] : NULL;
        if (!image || (own->shift[0] == -image->shift[0] && own->shift[1] == -image->shift[1] && own->shift[2] == -image->shift[2]))
            return (pls_bond_end){q, slot};
    }
    return end; // not reached: families are symmetric
}

static void forget(pls_bond_set *set, size_t slot)
{
    set->family.length[slot] = PLS_NO_LENGTH;
    if (set->weight) set->weight[slot] = 0.0;
    if (set->conditions.conduction) set->conditions.conduction[slot] = 0.0;
}

bool pls_bond_break(pls_bond_set *set, pls_bond_end end)
{
    if (!pls_bond_is_whole(set, end.slot)) return false;
    const pls_bond_end both[2] = {end, other_end(set, end)};
    for (int k = 0; k < 2; ++k)
    {
        const size_t slot = both[k].slot, p = both[k].point;
        const double held = pls_bond_energy(set, p);
        forget(set, slot);
        set->broken[p] += held - pls_bond_energy(set, p);
        ++set->gone;
    }
    return true;
}

/// Whether a linear or family law's bond breaks, as the loops of forces see it.
static bool is_overlong(const pls_bond_set *set, size_t p, size_t slot)
{
    const double xi = set->family.length[slot], e = extension_now(set, p, slot), toughness = mean_of(set, p, slot, PLS_CONDITION_TOUGHNESS);
    if (!set->limit) return set->stretch * toughness * xi < e;
    const double share = (double)set->share[slot] * mean_of(set, p, slot, PLS_CONDITION_STIFFNESS);
    const double pull = (set->row[p][3] + set->row[set->family.partner[slot]][3]) * xi + (set->twice * e) * share;
    return toughness * set->limit[slot] < 0.5 * pull * e && e > 0.0;
}

/// Bonds that carry as much as they can.
static void mark_loaded(const pls_link_work *work, size_t slot, size_t count, void *context)
{
    pls_bond_set *set = context;
    for (size_t k = 0; k < count; ++k)
        if (work->reference[k] < PLS_NO_LENGTH && !(work->load[k] < 1.0))
            set->family.length[slot + k] = -fabs(set->family.length[slot + k]);
}

/// Mark the bonds of a point that are to break by a negative length.
static void mark_overlong(pls_bond_set *set, size_t p)
{
    if (set->links.ops) each_batch(set, p, mark_loaded, set);
    for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + set->family.size[p]; ++slot)
    {
        const double xi = set->family.length[slot];
        if (xi > 0.0 && is_overlong(set, p, slot)) set->family.length[slot] = -xi;
    }
}

void pls_bond_break_overlong(pls_bond_set *set, const pls_bodies *bodies, const pls_domain *domain, double dt, pls_bond_listener *tell,
                             void *context)
{
    const pls_families *f = &set->family;
    for (size_t p = 0; p < f->count; ++p)
        if (set->overlong[p]) mark_overlong(set, p);
    // The force of now acts for half a step more: what the bond holds then is lost, which keeps the book of energy to second order.
    if (set->links.ops) pls_links_advance(&set->links, f, bodies, 0.5 * dt);
    for (size_t p = 0; set->row && p < f->count; ++p)
    {
        const uint32_t row = bodies->row_of[f->point[p].number];
        if (row == PLS_NO_ROW) continue;
        const pls_body_place *place = &bodies->place[row];
        set->row[p][0] += 0.5 * dt * place->vx, set->row[p][1] += 0.5 * dt * place->vy, set->row[p][2] += 0.5 * dt * place->vz;
    }
    pls_bond_take_ghosts(set, domain);
    for (size_t p = 0; p < f->count; ++p)
    {
        if (!set->overlong[p]) continue;
        set->overlong[p] = 0;
        for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + f->size[p]; ++slot)
            if (f->length[slot] < 0.0 && pls_bond_break(set, (pls_bond_end){(uint32_t)p, slot}))
                tell(context, f->point[p].number, f->point[pls_point_behind(f, f->partner[slot])].number);
    }
    set->any_overlong = false;
}

size_t pls_bond_lost(const pls_bond_set *set, size_t point)
{
    size_t broken = 0;
    for (size_t slot = first_slot(set, point); slot < first_slot(set, point) + set->family.size[point]; ++slot)
        broken += !pls_bond_is_whole(set, slot);
    return broken;
}

void pls_bond_read_broken(const pls_bond_set *set, uint8_t *broken)
{
    for (size_t p = 0; p < set->family.count; ++p)
        for (size_t slot = first_slot(set, p), k = 0; k < set->family.size[p]; ++k) *broken++ = !pls_bond_is_whole(set, slot + k);
}

/// Of heat, doubles.
static size_t warm_numbers(const pls_bond_set *set) { return set->conditions.warmth ? set->family.count * PLS_HEAT_NUMBERS : 0; }

size_t pls_bond_remembered(const pls_bond_set *set) { return pls_force_states_remembered(&set->states, &set->family) + warm_numbers(set); }

void pls_bond_read_memory(const pls_bond_set *set, double *out)
{
    pls_force_states_read(&set->states, &set->family, out);
    if (warm_numbers(set) > 0)
        memcpy(out + pls_force_states_remembered(&set->states, &set->family), set->conditions.warmth, warm_numbers(set) * sizeof *out);
}

void pls_bond_write_memory(pls_bond_set *set, const double *in)
{
    pls_force_states_write(&set->states, &set->family, in);
    if (warm_numbers(set) > 0)
        memcpy(set->conditions.warmth, in + pls_force_states_remembered(&set->states, &set->family), warm_numbers(set) * sizeof *in);
}

static bool is_there(const pls_bond_point *point, const pls_bodies *bodies)
{
    return point->number < bodies->numbers && bodies->row_of[point->number] != PLS_NO_ROW &&
           bodies->generation_of[point->number] == point->generation;
}

/// Flags must be those of either end, and a body that is gone has no bonds.
static pls_status check_broken(const pls_bond_set *set, const pls_bodies *bodies)
{
    for (size_t p = 0; p < set->family.count; ++p)
        for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + set->family.size[p]; ++slot)
        {
            const uint32_t number = set->family.point[p].number;
            const pls_bond_end other = other_end(set, (pls_bond_end){(uint32_t)p, slot});
            if (pls_bond_is_whole(set, slot) != pls_bond_is_whole(set, other.slot))
                return pls_fail(PLS_CORRUPT, "a saved bond of body %u in '%s' is broken at one end only", number, set->name);
            if (pls_bond_is_whole(set, slot) && !is_there(&set->family.point[p], bodies))
                return pls_fail(PLS_CORRUPT, "a saved bond in '%s' holds body %u, which is not there", set->name, number);
        }
    return PLS_OK;
}

pls_status pls_bond_check_restored(pls_bond_set *set, const pls_bodies *bodies)
{
    PLS_TRY(check_broken(set, bodies));
    for (size_t p = 0; p < set->family.count; ++p)
    {
        const pls_bond_point *point = &set->family.point[p];
        set->point_of[point->number] = is_there(point, bodies) ? (uint32_t)p : PLS_NO_POINT;
    }
    return PLS_OK;
}

pls_status pls_bond_write_broken(pls_bond_set *set, const uint8_t *broken)
{
    for (size_t p = 0; p < set->family.count; ++p)
        for (size_t slot = first_slot(set, p), k = 0; k < set->family.size[p]; ++k, ++broken)
        {
            if (*broken && pls_bond_is_whole(set, slot + k))
            {
                forget(set, slot + k);
                ++set->gone;
            }
            else if (!*broken && !pls_bond_is_whole(set, slot + k))
                return pls_fail(PLS_CORRUPT,
                                "a bond of body %u in '%s' is broken that holds in the saved state: bonds cannot be mended; restore into a "
                                "world made anew",
                                set->family.point[p].number, set->name);
        }
    return PLS_OK;
}

/// Volume of the tetrahedron a b c d, times six, signed; in 2D twice the area of a b d.
static double side(int dimension, pls_vec3 a, pls_vec3 b, pls_vec3 c, pls_vec3 d)
{
    const pls_vec3 u = pls_sub(b, a), v = pls_sub(c, a), w = pls_sub(d, a);
    return dimension == 2 ? u.x * w.y - u.y * w.x : pls_dot(pls_cross(u, v), w);
}

/// Whether the segment p q crosses the triangle a b c, in 2D the segment a b. What lies on an edge counts as crossed, what merely ends in the plane on its positive side does not.
static bool crosses(int dimension, pls_vec3 p, pls_vec3 q, pls_vec3 a, pls_vec3 b, pls_vec3 c)
{
    if ((side(dimension, a, b, c, p) < 0.0) == (side(dimension, a, b, c, q) < 0.0)) return false;
    if (dimension == 2)
    {
        const double u = side(2, p, q, q, a), v = side(2, p, q, q, b);
        return (u >= 0.0 && v <= 0.0) || (u <= 0.0 && v >= 0.0);
    }
    const double u = side(3, p, q, a, b), v = side(3, p, q, b, c), w = side(3, p, q, c, a);
    return (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
}

void pls_bond_cut(pls_bond_set *set, int dimension, pls_vec3 a, pls_vec3 b, pls_vec3 c)
{
    const pls_families *f = &set->family;
    for (size_t p = 0; p < f->count; ++p)
        for (size_t slot = first_slot(set, p); slot < first_slot(set, p) + f->size[p]; ++slot)
        {
            const double *x = place_of(set, p), *y = place_of(set, f->partner[slot]);
            if (pls_bond_is_whole(set, slot) && crosses(dimension, pls_vec(x[0], x[1], x[2]), pls_vec(y[0], y[1], y[2]), a, b, c))
                pls_bond_break(set, (pls_bond_end){(uint32_t)p, slot});
        }
}

bool pls_bond_holds(const pls_bond_set *set, uint32_t number, uint32_t partner)
{
    const pls_families *f = &set->family;
    const uint32_t p = number < set->numbers ? set->point_of[number] : PLS_NO_POINT,
                   q = partner < set->numbers ? set->point_of[partner] : PLS_NO_POINT;
    if (p == PLS_NO_POINT || q == PLS_NO_POINT) return false;
    const size_t slot = first_bond_to(set, p, q);
    return slot < first_slot(set, p) + f->size[p] && pls_point_behind(f, f->partner[slot]) == q && pls_bond_is_whole(set, slot);
}
