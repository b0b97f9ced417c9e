// eigen6.h -- eigenvalues of small symmetric matrices: the stiffness of one body (6x6: three translations, three rotations), a stress or
// fabric tensor (3x3), a pair of bodies (12x12).
#ifndef PLS_MATH_EIGEN6_H
#define PLS_MATH_EIGEN6_H

/// Largest order that these functions take.
enum { PLS_EIGEN_MAX = 12 };

/// Eigenvalues of the symmetric n x n matrix `a` (row by row; only its upper triangle is read), 1 <= n <= PLS_EIGEN_MAX, ascending, into
/// `values`. Each is right within a few round-offs of the largest by magnitude. NaN in all of them if `a` holds a number that is not
/// finite or n is out of range (then one value is written). No allocation.
void pls_symmetric_eigenvalues(const double *a, int n, double *values);

/// The largest (not the largest by magnitude) of them.
double pls_largest_eigenvalue(const double *a, int n);

#endif
