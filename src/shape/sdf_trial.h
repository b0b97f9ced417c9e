// sdf_trial.h -- is what a shape gives as its SDF a signed distance?
#ifndef PLS_SHAPE_SDF_TRIAL_H
#define PLS_SHAPE_SDF_TRIAL_H

#include <particls/shape.h>

/// The least value that was found, and where.
typedef struct pls_sdf_least
{
    double phi; ///< [m]
    pls_vec3 at;
} pls_sdf_least;

/// How far the shape reaches, roughly, into `shape->size`. INVALID_ARGUMENT, with the point and the value that show it, if no bounded set has this for its distance.
pls_status pls_sdf_guess_size(pls_shape *shape, const char *name);

/// Tries the SDF in the shape's bounds and around them: finite, no steeper than 1, a true distance outside; and, of a shape without exact mass, which has nothing but its
/// SDF, that it does not jump, and that it is convex if it is said to be. INVALID_ARGUMENT, with the point and the value that show it.
pls_status pls_sdf_try(const pls_shape *shape, const char *name, pls_sdf_least *least);

/// INVALID_ARGUMENT: the least value found is not negative, so that the shape has no inside.
pls_status pls_sdf_no_inside(const char *name, const pls_sdf_least *least);

#endif
