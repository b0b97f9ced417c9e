// bond_set.h -- a set of bonds and its two loops: dilatations of families, then forces of points. Both only gather, so that points can be shared by threads as they come.
//
// Per bond a partner, a reference length xi and a weight g = w beta V_i V_j xi, and for the second loop B_i + B_j as a part of twice a common B0. With e the extension:
//
//     A_i = a_i sum g e                              a_i = dilation d / (m_i^2 V_i),  B_i = extension / m_i,  m_i = sum g xi / V_i
//     F_i = sum g [(A_i + A_j) xi + (B_i + B_j) e] / (xi l) (x_j - x_i)
//
// which is THEORY 5 times V_i, the gradient of  E = 1/2 sum_i [a_i (sum g e)^2 + B_i sum g e^2 / xi].  Both ends of a bond compute the same bits (but across periodic faces), so momentum is kept to round-off.
//
// A bond that is stretched too far acts for the last time in the step that finds it (as in LAMMPS), and is then gone at both ends: weight 0, length PLS_NO_LENGTH.
#ifndef PLS_BOND_BOND_SET_H
#define PLS_BOND_BOND_SET_H

#include "bond/condition.h"
#include "bond/families.h"
#include "bond/force_states.h"
#include "bond/links.h"
#include "math/simd.h"
#include "model/bodies.h"

#include <particls/bond.h>

enum { PLS_BOND_BLOCK = 32 }; ///< points of a block of work

/// A bond, by its place in the arrays, and the point whose family it is in.
typedef struct pls_bond_end
{
    uint32_t point;
    size_t slot;
} pls_bond_end;

/// Zero-initialise; `pls_bond_set_free` releases.
typedef struct pls_bond_set
{
    char name[PLS_NAME_SIZE];
    double horizon;
    double stretch; ///< critical
    int dimension;
    bool dilates; ///< the law asks for dilatations: two loops, else one
    pls_families family;
    double *weight;            ///< g per bond
    float *share;              ///< (B_i + B_j) / (2 B0) per bond
    double twice;              ///< 2 B0
    double *dilation;          ///< a per point
    pls_links links;           ///< of a pair law, in place of the above; else empty
    pls_force_states states;   ///< of a family law, beside the above, which then say its first response; else empty
    pls_conditions conditions; ///< what varies, else empty
    double *
        limit; ///< per bond, of sets that break by energy: a bond whose 1/2 [(A_i + A_j) xi + (B_i + B_j) e] e exceeds it breaks; else null
    double *broken;      ///< per point: energy its bonds held when they broke [J]
    double *spread;      ///< per point: A, until all are known
    double (*row)[4];    ///< per point and ghost: x y z A
    double (*force)[4];  ///< per point: F and 0 [N]
    double (*torque)[4]; ///< likewise, of pair laws [N m]
    uint8_t *overlong;   ///< per point: bonds of it are stretched too far
    bool any_overlong;
    uint32_t *number;   ///< of each point's body: of what `family` has of it, all that a step asks for
    uint32_t *point_of; ///< by number: its point, or PLS_NO_POINT
    size_t numbers;
    size_t gone;      ///< broken bonds of either direction
    double stiffness; ///< bound of the largest eigenvalue of M^-1 K as it was made [1/s^2]
} pls_bond_set;

#define PLS_NO_POINT UINT32_MAX

/// What a set is made from, besides the bodies.
typedef struct pls_bond_plan
{
    const pls_bonds_def *def;
    const pls_bond_coefficients *law;                  ///< of every material; null for pair laws
    const double (*constants)[PLS_BOND_MAX_CONSTANTS]; ///< of pair and family laws, of every material
    size_t materials;
    size_t some_material;          ///< one that has points; a pair law says the same of all
    const uint16_t *material;      ///< of every body, by number
    double stretch;                ///< critical
    double energy;                 ///< per area, that sets the critical energy of bonds [J/m^2]; infinite: they break by stretch
    const pls_heat_material *heat; ///< of every material
    double time;                   ///< now [s]
} pls_bond_plan;

/// `point` belongs to the set from here on, also when this fails (pls_families_make).
pls_status pls_bond_set_make(pls_bond_set *set, const pls_bond_plan *plan, pls_bond_point *point, size_t count, const pls_bodies *bodies,
                             const pls_domain *domain);
void pls_bond_set_free(pls_bond_set *set);
size_t pls_bond_set_bytes(const pls_bond_set *set);

/// Positions of points first .. last from the bodies.
void pls_bond_take_places(pls_bond_set *set, const pls_bodies *bodies, size_t first, size_t last);
/// Once A of all points is known: into their rows.
void pls_bond_take_spread(pls_bond_set *set);
/// Rows of ghosts from those of their points.
void pls_bond_take_ghosts(pls_bond_set *set, const pls_domain *domain);
/// Ask a family law about points first .. last, after a step of length dt (0: the start).
void pls_bond_ask_states(pls_bond_set *set, size_t first, size_t last, double dt);
/// Extensions of a point's bonds, for its law.
PLS_SIMD_DECLARE(void, pls_states_stretch, const pls_bond_set *set, size_t point);
/// Forces of points first .. last of a family law, once all tensions are known; returns as pls_bond_act.
PLS_SIMD_DECLARE(bool, pls_states_act, pls_bond_set *set, size_t first, size_t last);
/// A of points first .. last.
PLS_SIMD_DECLARE(void, pls_bond_dilate, pls_bond_set *set, size_t first, size_t last);
/// The same where conditions vary or bonds break by energy.
PLS_SIMD_DECLARE(void, pls_bond_dilate_varied, pls_bond_set *set, size_t first, size_t last);
PLS_SIMD_DECLARE(bool, pls_bond_act_varied, pls_bond_set *set, size_t first, size_t last);
/// Forces of points first .. last. Returns whether some of their bonds are stretched too far; `overlong` says whose.
PLS_SIMD_DECLARE(bool, pls_bond_act, pls_bond_set *set, size_t first, size_t last);
/// Columns and what the law says of `vectors` vectors of a point's bonds, at most PLS_LAW_BATCH bonds.
PLS_SIMD_DECLARE(void, pls_link_family, const pls_bond_set *set, size_t point, size_t vector, size_t vectors, pls_link_work *work);
/// The same of a pair law, with torques.
PLS_SIMD_DECLARE(bool, pls_link_act, pls_bond_set *set, size_t first, size_t last);
/// Add forces and torques of the points among rows first .. last, four numbers per row each.
void pls_bond_gather(const pls_bond_set *set, const pls_bodies *bodies, size_t first, size_t last, double *force, double *torque);

/// Energy stored in the family of a point as rows are now [J]; A need not be known.
double pls_bond_energy(const pls_bond_set *set, size_t point);
/// Break a bond at both ends. False: it is broken already. What its two families hold less is booked.
bool pls_bond_break(pls_bond_set *set, pls_bond_end end);
/// Hears of a bond that broke, once, by the numbers of its bodies.
typedef void pls_bond_listener(void *context, uint32_t number, uint32_t partner);
/// Break what is stretched too far, in order of points; within a step of length dt, whose mid-step velocities bodies have. Rows are used up.
void pls_bond_break_overlong(pls_bond_set *set, const pls_bodies *bodies, const pls_domain *domain, double dt, pls_bond_listener *tell,
                             void *context);
/// Whether its loops are those of conditions that vary.
static inline bool pls_bond_varies(const pls_bond_set *set) { return set->conditions.row != NULL || set->limit != NULL; }
/// Whether the bond in a slot holds.
static inline bool pls_bond_is_whole(const pls_bond_set *set, size_t slot) { return set->family.length[slot] < PLS_NO_LENGTH; }
/// How many of a point's bonds are broken.
size_t pls_bond_lost(const pls_bond_set *set, size_t point);
/// Which bonds are broken, one byte each, in order; and back. CORRUPT: a bond that is to hold is broken.
void pls_bond_read_broken(const pls_bond_set *set, uint8_t *broken);
pls_status pls_bond_write_broken(pls_bond_set *set, const uint8_t *broken);
/// Numbers that its law, and heat, remember; out and back in.
size_t pls_bond_remembered(const pls_bond_set *set);
void pls_bond_read_memory(const pls_bond_set *set, double *out);
void pls_bond_write_memory(pls_bond_set *set, const double *in);
/// After bodies and bonds were restored: whose number belongs to another body now is no point any more. CORRUPT: a bond broken at one end only, or of a body that is not there.
pls_status pls_bond_check_restored(pls_bond_set *set, const pls_bodies *bodies);
/// Break the bonds that cross a triangle, in 2D the segment a b, as rows are now.
void pls_bond_cut(pls_bond_set *set, int dimension, pls_vec3 a, pls_vec3 b, pls_vec3 c);
/// The bond of a point with a partner that still holds, by their numbers.
bool pls_bond_holds(const pls_bond_set *set, uint32_t number, uint32_t partner);

#endif
