/// @file contact.h
/// How contacts of bodies that are not spheres are found and told to the law. Chosen per pair of materials.
#ifndef PARTICLS_CONTACT_H
#define PARTICLS_CONTACT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// What the overlap of two shapes is.
typedef enum pls_solver {
    PLS_SOLVER_DEPTH, ///< the penetration depth: the shortest way that parts them
    PLS_SOLVER_ADMM ///< P1 eq. 14: the deepest point of each in the other, by ADMM. Not conservative where edges and corners overlap. For convex shapes and
                    ///< compounds of such: a step in which others come close fails (INVALID_ARGUMENT)
} pls_solver;

/// What the law is asked with where faces are nearly parallel. All but the first go by the whole line too where capsules, rounded bodies and cylinders lie along one.
typedef enum pls_faces {
    PLS_FACES_POINT, ///< the depth, at the deepest point, which jumps as faces tilt
    PLS_FACES_MANIFOLD, ///< a smooth maximum of the thickness of the overlap: the depth for parallel faces, 3/4 of it at an edge, 3/5 at a corner
    PLS_FACES_VOLUME ///< the volume of the overlap over `face_area`, at its centre
} pls_faces;

/// Copy `pls_default_narrow_options()` and change what you need.
typedef struct pls_narrow_options
{
    pls_solver solver;
    pls_faces faces;
    double
        face_area; ///< of PLS_FACES_VOLUME: the law's stiffness k [N/m] acts as k / face_area [N/m^3] on the volume [m^2]; 2D: length [m]
    double tolerance; ///< of PLS_SOLVER_ADMM: change of the iterates, part of the bodies' size
} pls_narrow_options;

static inline pls_narrow_options pls_default_narrow_options(void)
{
    pls_narrow_options options = {PLS_SOLVER_DEPTH, PLS_FACES_MANIFOLD, 0.0, 1e-6};
    return options;
}

/// What finding the contacts of bodies that are not spheres has cost, and where it was hard.
typedef struct pls_narrow_counts
{
    uint64_t queries, iterations;
    uint64_t restarts;  ///< what the last step left did not serve: solved from nothing
    uint64_t fallbacks; ///< a solver did not converge: a slower, sure one was asked
    uint64_t failures;  ///< none converged: the best bound of the depth was taken
} pls_narrow_counts;

#ifdef __cplusplus
}
#endif
#endif
