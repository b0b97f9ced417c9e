// feature_depth.h -- distance and depth of two convex shapes that touch with the same features as in the step before.
#ifndef PLS_CONTACT_FEATURE_DEPTH_H
#define PLS_CONTACT_FEATURE_DEPTH_H

#include "contact/convex.h"
#include "contact/posed.h"

/// Numbers that a pair keeps of its features; all zero: not known.
enum { PLS_FEATURE_MEMORY = 4 };

/// How nearly features count as one with the highest, of the size or [rad]: where shapes have turned since `normal` was found, and where it is the minimum's but for rounding.
#define PLS_FEATURES_LAST_STEP 0.02
#define PLS_FEATURES_NOW       1e-5

/// The minimum of F (convex.h) near `normal`, unit from A to B, that the features in `memory` have, or those that `normal` points at, give or take `together`. False: it is no minimum, or the shapes have no
/// features known here (polytopes, cylinders and smooth shapes with `support_gradient` have, rounded ones too); `out` is then undefined and `memory` unknown. In a gap the
/// minimum is the distance; in an overlap other minima may be less.
bool pls_feature_depth(const pls_posed *a, const pls_posed *b, pls_vec3 normal, double together, double memory[PLS_FEATURE_MEMORY],
                       pls_depth *out);

#endif
