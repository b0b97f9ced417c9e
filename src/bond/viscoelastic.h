// viscoelastic.h -- the viscoelastic solid: constants, memory, and its loops.
#ifndef PLS_BOND_VISCOELASTIC_H
#define PLS_BOND_VISCOELASTIC_H

#include "math/simd.h"

#include <particls/bond.h>

enum {
    PLS_VISCOUS_DILATION,  ///< a [Pa]
    PLS_VISCOUS_EXTENSION, ///< b [Pa], at first
    PLS_VISCOUS_PART,      ///< of b: relaxes
    PLS_VISCOUS_TIME       ///< in which it does [s]
};

/// Remembered per bond: extension of the dashpot, deviator at the last step.
enum { PLS_VISCOUS_DASHPOT, PLS_VISCOUS_DEVIATOR, PLS_VISCOUS_MEMORIES };

PLS_SIMD_DECLARE(void, pls_viscous_pull, const pls_family_batch *batch);
PLS_SIMD_DECLARE(void, pls_viscous_advance, const pls_family_batch *batch);

#endif
