// proximal.h -- the proximal map of a shape's SDF: argmin over Y of sdf(Y) + |Y - X|^2 / (2 step)  (P1 section 3).
#ifndef PLS_SHAPE_PROXIMAL_H
#define PLS_SHAPE_PROXIMAL_H

#include <particls/shape.h>

/// A plane below a convex function: value + slope . (Y - X).
typedef struct pls_cut
{
    pls_vec3 slope;
    double value; ///< at X [m]
} pls_cut;

/// The largest of a few cuts, and where it plus |Y - X|^2 / (2 step) is least. Starts with `count` 0.
typedef struct pls_cut_model
{
    int count;
    pls_cut cut[5];
    pls_vec3 slope; ///< mean of the cuts that hold there: Y = X - step slope
    double value;   ///< of the largest cut there [m]
    double least;   ///< of the sum, a lower bound of that of the convex function [m]
} pls_cut_model;

/// Take in a cut and drop those that do not matter any more. False: it is not above what is there, but for round-off.
bool pls_cut_model_add(pls_cut_model *model, pls_cut cut, double step);

/// By the shape's own function or, else, from its SDF.
pls_vec3 pls_shape_proximal(const pls_shape *shape, pls_vec3 X, double step);

/// From the SDF and its gradient alone, for convex shapes to about 1e-10 of the size; a shape that gives no gradient, to the error of differences at its ridges.
pls_vec3 pls_proximal_from_sdf(const pls_shape *shape, pls_vec3 X, double step);

#endif
