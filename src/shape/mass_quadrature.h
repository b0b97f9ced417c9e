// mass_quadrature.h -- mass properties of anything given by an SDF.
#ifndef PLS_SHAPE_MASS_QUADRATURE_H
#define PLS_SHAPE_MASS_QUADRATURE_H

#include <particls/shape.h>

/// By quadrature over a cube about `origin` (anywhere near the shape); the shape lies within `reach` of it [m]. `out->error`, 5e-7 or less unless the shape is very
/// rough, is meant as a bound of the relative errors of the volume, of the centre (relative to the radius of gyration) and of the inertia tensor (relative to its
/// trace): true errors mostly are some ten times smaller. INVALID_ARGUMENT if the shape has no volume.
pls_status pls_mass_by_quadrature(const pls_shape *shape, pls_vec3 origin, double reach, pls_mass_properties *out);
/// The same with the shape's density, which is 1 above. INVALID_ARGUMENT tells where it is not positive and finite.
pls_status pls_uneven_mass_by_quadrature(const pls_shape *shape, pls_vec3 origin, double reach, pls_mass_properties *out);

#endif
