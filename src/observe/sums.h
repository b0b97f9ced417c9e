// sums.h -- what a collection adds up over its bodies and its contacts, before any division by a volume or a number.
//
// Bodies are added in order of their numbers, contacts in the order of the contact view, both in blocks of fixed size whose sums are
// then added in order: the same bits for any number of threads and any order in memory.
#ifndef PLS_OBSERVE_SUMS_H
#define PLS_OBSERVE_SUMS_H

#include "step/contact_view.h"
#include "observe/surroundings.h"

#include <particls/observe.h>

/// Energies of bonds by numbers of bodies; both null without bonds [J].
typedef struct pls_bond_shares
{
    double *stored, *broken;
} pls_bond_shares;

/// Which bodies and contacts a collection holds.
typedef struct pls_selection
{
    pls_surroundings around;
    uint32_t group; ///< group id's index1, 0: all bodies
    bool include_walls;
    bool box; ///< only what lies in `lower`..`upper`
    pls_vec3 lower, upper;
    const pls_bond_shares *bonds; ///< null: not asked for
} pls_selection;

/// Whether `point`, or one of its periodic images, lies in the selection's box; true without a box. The lower faces belong to the box,
/// the upper ones do not.
bool pls_selection_has_point(const pls_selection *selection, pls_vec3 point);
/// Whether the body in memory row `row` belongs: by group and, with a box, by its centre. Unbounded bodies lie in no box.
bool pls_selection_has_body(const pls_selection *selection, uint32_t row);
/// Whether a contact belongs: both bodies by group (a wall of any group if walls are included) and, with a box, by its point.
bool pls_selection_has_contact(const pls_selection *selection, const pls_contact_entry *contact);

typedef struct pls_body_sums
{
    double bounded;                      ///< number of bounded bodies
    double mass;                         ///< of bounded bodies with mass [kg]
    double kinetic, rotation, potential; ///< of bodies with mass [J]
    double damped, slid;                 ///< the bodies' halves of what their contacts dissipated [J]
    double bonds, broken;                ///< stored in their bonds; what these held when they broke [J]
    double momentum[3];                  ///< [kg m/s]
    double angular_momentum[3];          ///< about the origin [kg m^2/s]
    double solid;                        ///< volume of bounded bodies, cut at the box [m^3]
    double lower[3], upper[3];           ///< of the bounded bodies' bounding spheres [m]; infinite and turned over when there are none
} pls_body_sums;

/// The bodies and contacts `def` speaks of. NOT_FOUND when there is no such group, INVALID_ARGUMENT when its volume makes no sense.
pls_status pls_select(const pls_world *world, const pls_collection_def *def, pls_selection *selection);

/// `with_solid`: also add up solid volumes, which may need cutting at the box.
pls_status pls_sum_bodies(const pls_selection *selection, bool with_solid, pls_body_sums *sums);

typedef struct pls_contact_sums
{
    double contacts;      ///< number of contacts
    double ends;          ///< contact ends at bounded bodies of the collection, whatever they touch
    double stress[9];     ///< d (x) F [J]
    double fabric[9];     ///< n (x) n
    double tangent[81];   ///< kn n (x) d (x) n (x) d + kt sum over tangents t (x) d (x) t (x) d [J]
    double normal, shear; ///< stored energies, half to each body of the collection [J]
} pls_contact_sums;

/// `with_tangent`: also add up the tangent operator, the most expensive of them.
pls_status pls_sum_contacts(const pls_selection *selection, const pls_contact_view *view, bool with_tangent, pls_contact_sums *sums);

#endif
