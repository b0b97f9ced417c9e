// narrow_phase.h -- two shapes where two bodies have them: do they touch, how deep, where, in which direction.
//
// One answer for all treatments: an effective overlap, which the contact law is asked with, a normal, and the point where the force acts.
#ifndef PLS_CONTACT_NARROW_PHASE_H
#define PLS_CONTACT_NARROW_PHASE_H

#include "contact/posed.h"

#include <particls/contact.h>

enum { PLS_PAIR_STATE = 32 };

/// What a pair remembers between steps, in body frames; all zero: nothing.
typedef struct pls_pair_state
{
    double value[PLS_PAIR_STATE];
} pls_pair_state;

typedef struct pls_touch
{
    double delta;    ///< effective overlap, which the law is asked with; <= 0: apart [m]
    pls_vec3 normal; ///< unit, from A to B
    pls_vec3 point;  ///< where the normal force acts, in the world [m]
    pls_vec3 middle; ///< where friction acts: the same, but for areas and lines of touch their middle, at the height of `point` [m]
    double weight;   ///< d(delta)/d(approach): 1 for points; laws of faces and lines have less or more (volume: A/A0)
    double
        energy_delta; ///< overlap at which a linear spring holds the energy of the contact; `delta` but for the laws of faces and lines; INFINITY: not asked for [m]
    double depth;     ///< penetration depth; INFINITY: not asked for [m]
    double reach;     ///< the depth or more, for guards [m]
    double twist;     ///< couple about the normal that the laws of faces add, on B, by the normal force; on A the opposite; else 0 [m]
    double lever;     ///< radius at which all of an area's friction resists turning about the normal; 0 for a point and in 2D [m]
    double spread
        [6]; ///< second moments of the area (line) of touch about its middle, by the area (length): xx, yy, zz, xy, xz, yz; all 0: a point [m^2]
    bool
        stands; ///< a law of areas or lines: its force is the gradient of an energy of its own, whatever other parts of a body do. Of points at one place the deepest acts alone
} pls_touch;

/// What a pair may keep beside its state, for speed alone: no answer depends on it but for `energy_delta`, which may be left out (faces.h), and it may be lost any time. All zero: nothing (overlap_record.h).
typedef struct pls_overlap_record pls_overlap_record;

/// One contact. Returns whether there is a record of what touches. The answer depends on poses, options and state only. Half-spaces come as B.
/// With the default solver and PLS_FACES_POINT, `delta` is the penetration depth, or minus the distance, and the two points of the surfaces are
/// point +- delta/2 normal (+: of A). Pairs further apart than PLS_NARROW_FAR may get any bound of their distance beyond that.
/// `record` may be null; where the energy takes longer than all else, and the force does not need it, it is left out unless it is.
bool pls_narrow_phase_from(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_pair_state *state,
                           pls_overlap_record *record, pls_touch *out, pls_narrow_counts *counts);

/// The same answer from the record alone, but for the depth, which is not asked for. False: the record does not tell, ask `pls_narrow_phase_from`.
bool pls_narrow_phase_again(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_overlap_record *record,
                            pls_touch *out, pls_narrow_counts *counts);

static inline void pls_narrow_phase(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_pair_state *state,
                                    pls_touch *out, pls_narrow_counts *counts)
{
    pls_narrow_phase_from(a, b, options, state, NULL, out, counts);
}

#define PLS_NARROW_FAR 0.15 ///< of the smaller bounding radius: beyond this gap distances are bounds only

#endif
