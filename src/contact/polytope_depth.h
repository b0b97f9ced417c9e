// polytope_depth.h -- distance and depth of two convex polytopes that were near each other in the step before.
#ifndef PLS_CONTACT_POLYTOPE_DEPTH_H
#define PLS_CONTACT_POLYTOPE_DEPTH_H

#include "contact/convex.h"
#include "contact/posed.h"

enum { PLS_POLYTOPE_MEMORY = 24 };

/// Cores and margins of two shapes with `polytope`. `memory` is what the last call left, all zero: nothing. False where rounding got in the way (flat bodies,
/// cores that just touch): then `memory` is zeroed and another method has to answer. What is answered is exact to rounding.
bool pls_polytope_depth(const pls_posed *a, const pls_posed *b, double memory[PLS_POLYTOPE_MEMORY], pls_depth *out);

#endif
