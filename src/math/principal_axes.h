// principal_axes.h -- the frame in which a symmetric tensor is diagonal.
#ifndef PLS_MATH_PRINCIPAL_AXES_H
#define PLS_MATH_PRINCIPAL_AXES_H

#include <particls/types.h>

/// Eigenvalues of the symmetric tensor xx, yy, zz, xy, xz, yz and the rotation that takes the axes x, y, z to its eigenvectors, of all such rotations the one that
/// turns least: a tensor that is nearly diagonal keeps its axes in order.
void pls_principal_axes(const double tensor[6], double value[3], pls_quat *rotation);

/// The rotation that takes x, y, z to three unit vectors at right angles (a right-handed frame).
pls_quat pls_quat_of_axes(pls_vec3 x, pls_vec3 y, pls_vec3 z);

#endif
