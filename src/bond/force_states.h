// force_states.h -- families whose law is more than linear coefficients: it says what energy a family stores and what tension each of its bonds has, from their extensions and what it remembers of them.
//
// Each family is asked alone, in the loop that finds dilatations of linear laws; the force of a bond is the sum of the tensions of its two families, found at the other end by `back`. Both ends add the
// same two numbers, so that momentum is kept to round-off.
#ifndef PLS_BOND_FORCE_STATES_H
#define PLS_BOND_FORCE_STATES_H

#include "bond/families.h"

#include <particls/bond.h>

/// Zero-initialise; `pls_force_states_free` releases.
typedef struct pls_force_states
{
    const pls_bond_ops *ops;                     ///< null: there are none
    double (*constants)[PLS_BOND_MAX_CONSTANTS]; ///< by material
    uint16_t *material;                          ///< of each point
    double *weighted;                            ///< m of each point [m^5]
    double *reference, *correction;              ///< per bond, see pls_family_batch; these stay when bonds break
    double *extension, *tension;                 ///< per bond: scratch of a step
    uint32_t *back;                              ///< per bond: its place in the partner's family
    double *memory[PLS_BOND_MAX_MEMORY];         ///< per bond
    double (*of_point)[PLS_BOND_MAX_MEMORY];     ///< memory of each point
    double *spent;                               ///< per point: what the last step took [J]
} pls_force_states;

/// Room for `materials` of law `ops`; what it holds is the caller's to fill but what it remembers.
pls_status pls_force_states_make(pls_force_states *states, const pls_bond_ops *ops, const pls_families *family, size_t materials);
void pls_force_states_free(pls_force_states *states);
size_t pls_force_states_bytes(const pls_force_states *states, const pls_families *family);
/// Numbers it remembers of all bonds and points.
size_t pls_force_states_remembered(const pls_force_states *states, const pls_families *family);
/// These numbers, out and back in: of each memory all bonds in order, then of the points.
void pls_force_states_read(const pls_force_states *states, const pls_families *family, double *out);
void pls_force_states_write(pls_force_states *states, const pls_families *family, const double *in);

#endif
