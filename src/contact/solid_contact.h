// solid_contact.h -- contacts of solids: from the list to forces in slots.
#ifndef PLS_CONTACT_SOLID_CONTACT_H
#define PLS_CONTACT_SOLID_CONTACT_H

#include "contact/solid_list.h"
#include "contact/sphere_contact.h"

/// Where each body with candidates is now. `rows`: numbers in list->row, first .. last.
void pls_solid_pose(pls_solid_list *list, const pls_contact_input *input, const pls_bodies *bodies, const pls_shape *const *shape,
                    size_t first, size_t last);
/// The two parts of a candidate where they are; kept in `own` unless the list has them.
typedef struct pls_solid_parts
{
    const pls_posed *a, *b;
    pls_posed own[2];
} pls_solid_parts;

void pls_solid_parts_of(const pls_solid_list *list, const pls_contact_input *input, size_t candidate, pls_solid_parts *out);

/// One block: geometry, laws, forces into the candidates' slots. Counts go to `counts`.
void pls_solid_contacts(pls_solid_list *list, const pls_contact_input *input, const pls_solid_block *block, pls_contact_work *work,
                        pls_narrow_counts *counts);
/// Geometry alone, nothing remembered: the touch of a candidate now, from scratch; delta is negative or 0 where bounding volumes are apart.
pls_touch pls_solid_touch_now(const pls_solid_list *list, const pls_contact_input *input, size_t candidate);
/// The penetration depth of a candidate that touches [m].
double pls_solid_depth(const pls_solid_list *list, const pls_contact_input *input, size_t candidate);
/// Add forces and torques of contacts on bodies first .. last, in order of the partner's number, to four and four numbers per body: F and the power of dashpots, torque and
/// the work of sliders.
void pls_solid_gather(const pls_solid_list *list, size_t first, size_t last, double *force, double *torque);

/// A contact that ended in the last step: its spring, had it grown for half a step more with the velocities of now [m].
pls_vec3 pls_solid_last_spring(const pls_solid_list *list, const pls_contact_input *input, size_t candidate);

/// r_i r_j / (r_i + r_j) of spheres of equal volume, for laws that ask [m].
double pls_solid_effective_radius(const pls_solid_list *list, size_t candidate);

#endif
