// narrow_phase.h -- one contact of two convex parts: how far they overlap, along which normal, and where the force acts.
//
// The one call a step makes for each candidate. Which solver serves a pair of shapes is a table in narrow_phase.c.
#ifndef PLS_CONTACT_NARROW_PHASE_H
#define PLS_CONTACT_NARROW_PHASE_H

#include "contact/posed.h"

typedef enum pls_solver {
    PLS_SOLVER_DEPTH, ///< penetration depth: conservative
    PLS_SOLVER_ADMM   ///< P1 eq. 14
} pls_solver;

/// What is taken of faces that lie on each other.
typedef enum pls_faces {
    PLS_FACES_POINT,    ///< the middle of the two witness points
    PLS_FACES_MANIFOLD, ///< a smooth maximum over the corners of the common polygon
    PLS_FACES_VOLUME    ///< the volume of the overlap
} pls_faces;

/// How contacts of a pair of materials are found; the same for all their bodies.
typedef struct pls_narrow_options
{
    pls_solver solver;
    pls_faces faces;
    double face_area; ///< A0 of the volume law [m^2]; 2D: length [m]
    double tolerance; ///< of ADMM: change of the iterates, part of the size
} pls_narrow_options;

enum { PLS_PAIR_STATE = 32 };

/// What a pair remembers between steps, in body frames; all zero: nothing. Laid out in narrow_phase.c.
typedef struct pls_pair_state
{
    double value[PLS_PAIR_STATE];
} pls_pair_state;

typedef struct pls_touch
{
    double delta;    ///< effective overlap, which the law is asked with; <= 0: apart [m]
    pls_vec3 normal; ///< unit, from A to B
    pls_vec3 point;  ///< where the force acts, in the world [m]
    double weight;   ///< d(delta)/d(approach): 1 but for the volume law (A/A0)
    double
        energy_delta; ///< overlap at which a linear spring holds the energy of the contact: `delta` but for the volume law (sqrt(integral t^2 dA / A0)) [m]
    double depth; ///< penetration depth, for guards [m]
} pls_touch;

/// What queries cost, for summary.json. One per thread, added up.
typedef struct pls_narrow_counts
{
    uint64_t queries;
    uint64_t iterations;
    uint64_t restarts;  ///< warm start given up, solved cold
    uint64_t fallbacks; ///< to a slower sure method
    uint64_t failures;  ///< none converged: the best bound was used
} pls_narrow_counts;

/// One contact. The answer depends on poses, options and state only. Half-spaces come as B.
/// With the default solver and PLS_FACES_POINT, `delta` is the penetration depth, or minus the distance, and the two points of the surfaces are
/// point +- delta/2 normal (+: of A). Pairs further apart than PLS_NARROW_FAR may get any bound of their distance beyond that.
void pls_narrow_phase(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_pair_state *state, pls_touch *out,
                      pls_narrow_counts *counts);

#define PLS_NARROW_FAR 0.15 ///< of the smaller bounding radius: beyond this gap distances are bounds only

#endif
