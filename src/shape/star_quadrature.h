// star_quadrature.h -- moments of a shape that each ray from the origin leaves once, by quadrature over directions.
#ifndef PLS_SHAPE_STAR_QUADRATURE_H
#define PLS_SHAPE_STAR_QUADRATURE_H

#include "shape/column_quadrature.h"

/// Moments of what is seen from the frame's origin through a square of the cube with half edges 1: face 2a (2a + 1) looks down (up) axis a, the square is within
/// `half` of `centre` along the next two axes. 3D, uniform density. And once more by a coarser rule.
void pls_star_moments(const pls_column_frame *frame, int face, const double centre[2], double half, double sum[PLS_MOMENTS],
                      double again[PLS_MOMENTS]);

#endif
