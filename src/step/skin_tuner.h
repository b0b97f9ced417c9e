// skin_tuner.h -- how far beyond touch the lists of pairs should reach.
//
// A larger skin lets a list live longer and puts more pairs into it that do not touch. Both are counted, not timed: wall time per step moves by a third on a machine that
// others use too, and a search that follows it walks away, in a lattice into the next shell and lists half as long again. The pairs within smaller skins are counted
// when a list is made, so that values are compared at the same moment and what changes in the world meanwhile is not taken for an effect of the skin. Measured is only what a
// list costs in steps (with all that is done in a step), by the shortest of both times of late.
#ifndef PLS_STEP_SKIN_TUNER_H
#define PLS_STEP_SKIN_TUNER_H

#include "contact/broad_phase.h"
#include "contact/pair_list.h"
#include "contact/solid_list.h"

/// Skins that are compared: the one in use and smaller ones.
enum { PLS_SKIN_CHOICES = 10 };

/// Zero-initialise.
typedef struct pls_skin_tuner
{
    double skin;                                              ///< in use [m]; 0: none was chosen yet
    double radius;                                            ///< mean of all bodies when all began anew [m]
    double balls[PLS_SKIN_CHOICES], solids[PLS_SKIN_CHOICES]; ///< pairs of balls, and others, within each choice
    double list_seconds, step_seconds;                        ///< the shortest of late, raised by a tenth per list; 0: not known yet
    double ready;                                             ///< clock when the list in use was ready [s]
    uint64_t ready_step;                                      ///< the step then
    int lists;                                                ///< worn out since the last choice
    uint64_t lived;                                           ///< steps that these lived
    bool enlarged;                                            ///< the last choice was a larger skin, blind
    int wait;                                                 ///< choices until a larger one may be tried again
    int patience;                                             ///< how many those are after one was too large
} pls_skin_tuner;

/// The list in use is about to be made anew: choose the next skin. `worn_out`: because bodies have moved; otherwise the world has changed, and all begins anew. `radius`: the
/// mean of all bodies [m]; `now`: clock [s].
void pls_skin_choose(pls_skin_tuner *tuner, const pls_pair_list *list, const pls_solid_list *solids, size_t bodies, double radius,
                     bool worn_out, uint64_t step, double now);

/// Pairs nearer than the skin have been found: count those within smaller ones.
void pls_skin_survey(pls_skin_tuner *tuner, const pls_bodies *bodies, const pls_domain *domain, const pls_near_pairs *near);

/// The list has been made, since `began` [s].
void pls_skin_listed(pls_skin_tuner *tuner, uint64_t step, double began, double now);

#endif
