// lattice.h -- blocks of material points on a cubic (2D: square) lattice, bonded, and what theory says of them, computed from formulas alone: all pairs, no families, no vectors.
#ifndef PLS_TESTS_SUPPORT_LATTICE_H
#define PLS_TESTS_SUPPORT_LATTICE_H

#include "support/verify.h"

/// What a block is made of. Start from `lattice_default`.
typedef struct lattice_plan
{
    int dimension;
    size_t count[3];    ///< points along each axis
    double spacing;     ///< [m]
    double horizon;     ///< [m]
    double density;     ///< [kg/m^3]
    double bulk, shear; ///< K, mu [Pa]
    pls_plane plane;    ///< 2D
    double thickness;   ///< 2D [m]
    pls_influence influence;
    pls_correction correction;
    double critical_stretch;
    const char *law;          ///< of bonds
    double values[2];         ///< of its parameters, but for beams
    bool periodic;            ///< along all axes
    double contact_stiffness; ///< kn of points that touch [N/m]
    double dt;                ///< [s]
    double stiffer;           ///< of the half with the larger x: its moduli by those of the other. 0: all alike
    bool fixed;               ///< no point can move
    bool unstable;            ///< any step is taken
    double fracture_energy;   ///< 0: not given
    pls_fracture fracture;
    pls_point_condition *condition; ///< as in pls_bonds_def
    bool condition_changes;
    void *user;
    pls_heat_def heat;
    double lighter; ///< of the first layer along x: its points' masses by those of others. 0: all alike
} lattice_plan;

typedef struct lattice
{
    lattice_plan plan;
    verify_scene scene;
    pls_bonds_id bonds;
    size_t points;
    pls_vec3 *reference; ///< of each point, x fastest
    pls_body_id *body;
} lattice;

lattice_plan lattice_default(int dimension, size_t side);
/// The first point lies in the origin.
lattice lattice_make(const lattice_plan *plan);
void lattice_free(lattice *block);
/// Number of the point in place (i, j, k).
size_t lattice_at(const lattice *block, size_t i, size_t j, size_t k);
double lattice_volume(const lattice *block);
/// Put points where `map` sends their reference positions, and compute forces and energies there.
void lattice_deform(lattice *block, pls_vec3 (*map)(pls_vec3 X, const void *context), const void *context);
pls_vec3 lattice_force(const lattice *block, size_t point);
double lattice_energy(const lattice *block, size_t point);

/// The linear peridynamic solid (THEORY 5) at positions x of all points: force on each [N], energy of each [J]. Either may be null.
void lattice_oracle(const lattice *block, const pls_vec3 *x, pls_vec3 *force, double *energy);

#endif
