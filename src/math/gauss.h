// gauss.h -- Gauss-Legendre quadrature with eight points, exact for polynomials of degree 15 (Abramowitz & Stegun, table 25.4).
#ifndef PLS_MATH_GAUSS_H
#define PLS_MATH_GAUSS_H

/// On -1 .. 1, each with its mirror image; the four weights sum to 1.
static const double pls_gauss_node[4] = {0.18343464249564980, 0.52553240991632899, 0.79666647741362674, 0.96028985649753623};
static const double pls_gauss_weight[4] = {0.36268378337836198, 0.31370664587788729, 0.22238103445337447, 0.10122853629037626};

#endif
