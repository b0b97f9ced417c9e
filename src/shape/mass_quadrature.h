// mass_quadrature.h -- mass properties of anything given by an SDF.
#ifndef PLS_SHAPE_MASS_QUADRATURE_H
#define PLS_SHAPE_MASS_QUADRATURE_H

#include <particls/shape.h>

/// By quadrature along rays from `origin` (anywhere near the shape); the shape lies within `reach` of it [m]. Relative error aimed at 2e-8, as told in `out->error`;
/// 1e-6 and better for shapes with edges. INVALID_ARGUMENT if the shape has no volume.
pls_status pls_mass_by_quadrature(const pls_shape *shape, pls_vec3 origin, double reach, pls_mass_properties *out);

#endif
