// collection.c -- homogenised measures of a collection: P1 section 4.3, THEORY: each contact once, tension positive.

#include <particls/observe.h>

#include "base/alloc.h"
#include "observe/fragments.h"
#include "observe/sums.h"

#include <string.h>

pls_collection_def pls_default_collection_def(void)
{
    return (pls_collection_def){
        .quantities = PLS_MEASURE_STRESS | PLS_MEASURE_TANGENT | PLS_MEASURE_FABRIC | PLS_MEASURE_COORDINATION | PLS_MEASURE_ENERGY |
                      PLS_MEASURE_MOMENTUM | PLS_MEASURE_POROSITY | PLS_MEASURE_MASS,
        .volume_kind = PLS_VOLUME_BOUNDING_BOX,
        .include_walls = true,
    };
}

/// [m^3], zero when the collection is empty.
static double averaging_volume(const pls_collection_def *def, const pls_domain *domain, const pls_body_sums *bodies)
{
    if (def->volume_kind == PLS_VOLUME_VALUE) return def->volume;
    const double box[3] = {def->upper.x - def->lower.x, def->upper.y - def->lower.y, def->upper.z - def->lower.z};
    double volume = domain->dimension == 2 ? domain->thickness : 1;
    for (int axis = 0; axis < domain->dimension; ++axis)
    {
        double edge = fmax(bodies->upper[axis] - bodies->lower[axis], 0);
        if (def->volume_kind == PLS_VOLUME_BOX) edge = box[axis];
        if (def->volume_kind == PLS_VOLUME_PERIODIC && domain->periodic[axis]) edge = domain->edge[axis];
        volume *= edge;
    }
    return volume;
}

/// Zero where there is nothing to divide by.
static double ratio(double a, double b) { return b > 0 ? a / b : 0; }

static void report_contacts(const pls_contact_sums *sums, double bounded, unsigned quantities, pls_collection *out)
{
    out->contacts = (uint64_t)sums->contacts;
    if (quantities & PLS_MEASURE_COORDINATION) out->coordination = ratio(sums->ends, bounded);
    for (int k = 0; k < 9; ++k)
    {
        if (quantities & PLS_MEASURE_STRESS) out->stress[k / 3][k % 3] = ratio(sums->stress[k], out->volume);
        if (quantities & PLS_MEASURE_FABRIC) out->fabric[k / 3][k % 3] = ratio(sums->fabric[k], sums->contacts);
    }
    for (int k = 0; k < 81 && quantities & PLS_MEASURE_TANGENT; ++k)
    {
        out->tangent[k / 27][k / 9 % 3][k / 3 % 3][k % 3] = ratio(sums->tangent[k], out->volume);
    }
}

static void report_bodies(const pls_body_sums *sums, unsigned quantities, pls_collection *out)
{
    if (quantities & PLS_MEASURE_ENERGY)
    {
        out->energy_kinetic = sums->kinetic;
        out->energy_rotation = sums->rotation;
        out->energy_potential = sums->potential;
        out->energy_damped = sums->damped;
        out->energy_slid = sums->slid;
        out->energy_bonds = sums->bonds;
        out->energy_broken = sums->broken;
    }
    if (quantities & PLS_MEASURE_MOMENTUM)
    {
        out->momentum = pls_vec(sums->momentum[0], sums->momentum[1], sums->momentum[2]);
        out->angular_momentum = pls_vec(sums->angular_momentum[0], sums->angular_momentum[1], sums->angular_momentum[2]);
    }
    if (quantities & PLS_MEASURE_POROSITY) out->porosity = out->volume > 0 ? 1 - sums->solid / out->volume : 0;
    if (quantities & PLS_MEASURE_MASS)
    {
        out->bodies = (uint64_t)sums->bounded;
        out->mass = sums->mass;
    }
}

static pls_status measure_contacts(const pls_world *world, const pls_selection *selection, unsigned quantities, pls_contact_sums *sums)
{
    const unsigned of_contacts =
        PLS_MEASURE_STRESS | PLS_MEASURE_TANGENT | PLS_MEASURE_FABRIC | PLS_MEASURE_COORDINATION | PLS_MEASURE_ENERGY;
    *sums = (pls_contact_sums){0};
    if (!(quantities & of_contacts)) return PLS_OK;
    pls_contact_view view = {0};
    pls_status status = pls_contact_view_make(world, &view);
    if (status == PLS_OK) status = pls_sum_contacts(selection, &view, quantities & PLS_MEASURE_TANGENT, sums);
    pls_contact_view_free(&view);
    return status;
}

static pls_status measure_bodies(const pls_world *world, pls_selection *selection, unsigned quantities, pls_body_sums *sums)
{
    pls_bond_shares shares = {0};
    pls_status status = PLS_OK;
    if ((quantities & PLS_MEASURE_ENERGY) && pls_world_has_bonds(world))
    {
        status = pls_surroundings_bonds(&selection->around, &shares.stored, &shares.broken);
        selection->bonds = &shares;
    }
    if (status == PLS_OK) status = pls_sum_bodies(selection, quantities & PLS_MEASURE_POROSITY, sums);
    selection->bonds = NULL;
    pls_release(&shares.stored);
    pls_release(&shares.broken);
    return status;
}

pls_status pls_measure_collection(const pls_world *world, const pls_collection_def *def, pls_collection *out)
{
    pls_selection selection;
    pls_contact_sums contacts;
    pls_body_sums bodies;
    memset(out, 0, sizeof *out);
    PLS_TRY(pls_select(world, def, &selection));
    PLS_TRY(measure_contacts(world, &selection, def->quantities, &contacts));
    PLS_TRY(measure_bodies(world, &selection, def->quantities, &bodies));

    out->volume = averaging_volume(def, selection.around.domain, &bodies);
    report_contacts(&contacts, bodies.bounded, def->quantities, out);
    report_bodies(&bodies, def->quantities, out);
    if (def->quantities & PLS_MEASURE_FRAGMENTS) PLS_TRY(pls_measure_fragments(&selection, &out->fragments));
    if (def->quantities & PLS_MEASURE_ENERGY)
    {
        out->energy_normal = contacts.normal;
        out->energy_shear = contacts.shear;
    }
    return PLS_OK;
}
