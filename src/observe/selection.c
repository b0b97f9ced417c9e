// selection.c -- who belongs to a collection.

#include "observe/sums.h"

#include "observe/group.h"

static bool is_box(pls_vec3 lower, pls_vec3 upper, int dimension)
{
    bool flat = lower.x < upper.x && lower.y < upper.y && isfinite(upper.x - lower.x) && isfinite(upper.y - lower.y);
    return flat && (dimension == 2 || (lower.z < upper.z && isfinite(upper.z - lower.z)));
}

static pls_status check_volume(const pls_collection_def *def, const pls_domain *domain)
{
    switch (def->volume_kind)
    {
        case PLS_VOLUME_BOUNDING_BOX: return PLS_OK;
        case PLS_VOLUME_BOX:
            if (is_box(def->lower, def->upper, domain->dimension)) return PLS_OK;
            return pls_fail(
                PLS_INVALID_ARGUMENT,
                "collection: the box (%g, %g, %g) .. (%g, %g, %g) has no inside: give a finite `lower` below `upper` along each axis",
                def->lower.x, def->lower.y, def->lower.z, def->upper.x, def->upper.y, def->upper.z);
        case PLS_VOLUME_PERIODIC:
            if (domain->any_periodic) return PLS_OK;
            return pls_fail(PLS_INVALID_ARGUMENT, "collection: the volume is the periodic box, but the world is periodic along no axis: "
                                                  "use the bounding box, a box or a value");
        case PLS_VOLUME_VALUE:
            if (def->volume > 0 && isfinite(def->volume)) return PLS_OK;
            return pls_fail(PLS_INVALID_ARGUMENT, "collection: the volume is %g: give a positive number [m^3]", def->volume);
    }
    return pls_fail(PLS_INVALID_ARGUMENT, "collection: %d is no kind of volume", (int)def->volume_kind);
}

pls_status pls_select(const pls_world *world, const pls_collection_def *def, pls_selection *selection)
{
    *selection = (pls_selection){
        .around = pls_surroundings_of(world),
        .include_walls = def->include_walls,
        .box = def->volume_kind == PLS_VOLUME_BOX,
        .lower = def->lower,
        .upper = def->upper,
    };
    PLS_TRY(check_volume(def, selection->around.domain));
    return pls_find_observed_group(world, def->group, &selection->group);
}

bool pls_selection_has_point(const pls_selection *selection, pls_vec3 point)
{
    if (!selection->box) return true;
    const pls_domain *domain = selection->around.domain;
    const double x[3] = {point.x, point.y, point.z};
    const double lower[3] = {selection->lower.x, selection->lower.y, selection->lower.z};
    const double upper[3] = {selection->upper.x, selection->upper.y, selection->upper.z};
    for (int axis = 0; axis < domain->dimension; ++axis)
    {
        double above = x[axis] - lower[axis];
        if (domain->periodic[axis]) above -= domain->edge[axis] * floor(above / domain->edge[axis]);
        if (!(above >= 0 && above < upper[axis] - lower[axis])) return false;
    }
    return true;
}

static bool has_group_of(const pls_selection *selection, uint32_t row)
{
    return selection->group == 0 || selection->around.bodies->kind[row].group == selection->group;
}

bool pls_selection_has_body(const pls_selection *selection, uint32_t row)
{
    if (!has_group_of(selection, row)) return false;
    if (!selection->box) return true;
    const pls_bodies *bodies = selection->around.bodies;
    if (bodies->kind[row].flags & PLS_BODY_UNBOUNDED) return false;
    const pls_body_place *place = &bodies->place[row];
    return pls_selection_has_point(selection, pls_vec(place->x, place->y, place->z));
}

bool pls_selection_has_contact(const pls_selection *selection, const pls_contact_entry *contact)
{
    if (!has_group_of(selection, contact->row_i)) return false;
    if (contact->wall ? !selection->include_walls : !has_group_of(selection, contact->row_j)) return false;
    return pls_selection_has_point(selection, contact->point);
}
