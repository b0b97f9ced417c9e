// hertz_mindlin.h -- constants and loop of hertz_mindlin.c.
#ifndef PLS_LAW_HERTZ_MINDLIN_H
#define PLS_LAW_HERTZ_MINDLIN_H

#include "math/simd.h"

#include <particls/law.h>

enum {
    PLS_HERTZ_E,       ///< effective modulus E* [Pa]
    PLS_HERTZ_G,       ///< effective shear modulus G* [Pa]
    PLS_HERTZ_DAMPING, ///< 2 sqrt(5/6) beta
    PLS_HERTZ_MU,      ///< Coulomb friction
    PLS_HERTZ_FLOOR    ///< smallest normal force [N]
};

PLS_SIMD_DECLARE(void, pls_hertz_law, const pls_law_batch *batch);

#endif
