// beam.h -- the cohesive beam: constants, and its loop.
#ifndef PLS_BOND_BEAM_H
#define PLS_BOND_BEAM_H

#include "math/simd.h"

#include <particls/bond.h>

enum {
    PLS_BEAM_EA,      ///< axial stiffness [N]
    PLS_BEAM_EI,      ///< bending [N m^2]
    PLS_BEAM_GJ,      ///< torsion [N m^2]
    PLS_BEAM_TENSILE, ///< per force along the axis: 1 / (A sigma_t) [1/N]; 0: does not break by that
    PLS_BEAM_BEND,    ///< per moment: r / (I sigma_t) [1/(N m)]
    PLS_BEAM_SHEAR,   ///< per force across: 1 / (A tau) [1/N]
    PLS_BEAM_TWIST    ///< per torque about the axis: r / (J tau) [1/(N m)]
};

PLS_SIMD_DECLARE(void, pls_beam_pair, const pls_pair_batch *batch);

#endif
