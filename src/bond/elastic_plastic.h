// elastic_plastic.h -- the elastic-plastic solid: constants, memory, and its loops.
#ifndef PLS_BOND_ELASTIC_PLASTIC_H
#define PLS_BOND_ELASTIC_PLASTIC_H

#include "math/simd.h"

#include <particls/bond.h>

enum {
    PLS_PLASTIC_DILATION,  ///< a [Pa]
    PLS_PLASTIC_EXTENSION, ///< b [Pa]
    PLS_PLASTIC_SHEAR,     ///< mu [Pa]
    PLS_PLASTIC_YIELD,     ///< [Pa]
    PLS_PLASTIC_HARDENING  ///< [Pa]
};

/// Remembered per point: equivalent plastic strain, even part of the extensions at the last step.
enum { PLS_PLASTIC_STRAIN, PLS_PLASTIC_MEAN, PLS_PLASTIC_POINT_MEMORIES };

PLS_SIMD_DECLARE(void, pls_plastic_pull, const pls_family_batch *batch);
PLS_SIMD_DECLARE(void, pls_plastic_advance, const pls_family_batch *batch);

#endif
