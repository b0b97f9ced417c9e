// condition.h -- what varies from point to point of a set, and in time: how stiff points are, what they withstand, how warm they are and what that makes of their bonds.
//
// Sets where nothing varies have no rows and use loops that know nothing of this.
#ifndef PLS_BOND_CONDITION_H
#define PLS_BOND_CONDITION_H

#include "bond/families.h"

#include <particls/bond.h>

/// Columns of a row.
enum { PLS_CONDITION_STRAIN, PLS_CONDITION_STIFFNESS, PLS_CONDITION_TOUGHNESS, PLS_CONDITION_SPARE, PLS_CONDITION_NUMBERS };

/// Temperature, its rate now and one step earlier [K, K/s]: what heat remembers of a point.
enum { PLS_HEAT_TEMPERATURE, PLS_HEAT_RATE, PLS_HEAT_BEFORE, PLS_HEAT_NUMBERS };

/// Zero-initialise; `pls_conditions_free` releases.
typedef struct pls_conditions
{
    double (*row)[PLS_CONDITION_NUMBERS]; ///< per point and ghost: thermal strain, stiffness, toughness; null: 0, 1, 1
    double *chance;                       ///< per point
    pls_point_condition *function;
    bool changes;    ///< it is asked in every step
    bool known;      ///< rows of ghosts and the largest stiffness have been found once
    double stiffest; ///< largest stiffness of a point now
    pls_heat_def heat;
    double (*warmth)[PLS_HEAT_NUMBERS]; ///< per point; null: the set has no heat
    double *conduction;                 ///< per bond [W/K]
    double *capacity, *expansion;       ///< per point [J/K], [1/K]
    double *reference;                  ///< per point [K]
    double
        fastest; ///< bound of the largest rate at which differences of temperature decay, by conduction and by sources as they are at the start [1/s]
    void *user;
    void (*release)(void *user);
} pls_conditions;

/// A material as heat sees it, by index.
typedef struct pls_heat_material
{
    double density;   ///< [kg/m^3]
    double expansion; ///< of bonds: in plane strain more than that of the material [1/K]
} pls_heat_material;

/// Takes over the definition's user also when this fails. `conduction` (of sets with heat, else null) belongs to the conditions from here on: per bond, for a conductivity of 1.
pls_status pls_conditions_make(pls_conditions *c, const pls_bonds_def *def, const pls_families *family, double *conduction,
                               const pls_heat_material *material, const uint16_t *material_of, double time);
void pls_conditions_free(pls_conditions *c);
size_t pls_conditions_bytes(const pls_conditions *c, const pls_families *family);
/// Rows of points first .. last at `time`, after a step of length dt (0: none was made). What the user says wrong is an error.
pls_status pls_conditions_take(pls_conditions *c, const pls_families *family, size_t first, size_t last, double time, double dt);
/// Ghosts are as their points; how stiff the stiffest is.
void pls_conditions_taken(pls_conditions *c, const pls_families *family);
/// Rates of temperature of points first .. last, once all temperatures are known; dt as above.
pls_status pls_conditions_conduct(pls_conditions *c, const pls_families *family, size_t first, size_t last, double time, double dt);

#endif
