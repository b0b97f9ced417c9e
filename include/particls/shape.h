/// @file shape.h
/// Shapes: what a grain looks like, in its own frame, centre of mass at the origin, before the body's scale.
#ifndef PARTICLS_SHAPE_H
#define PARTICLS_SHAPE_H

#include <particls/parameter.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Volume and second moments at unit density. In 2D `volume` is the area and `inertia.z` the polar moment; the world multiplies by its thickness.
typedef struct pls_mass_properties
{
    double volume;    ///< [m^3], 2D [m^2]
    pls_vec3 inertia; ///< principal moments about the centre of mass [m^5], 2D: only z [m^4]
} pls_mass_properties;

/// Operations of a shape. Fill in what is known; null where a default from `sdf` should serve.
typedef struct pls_shape_ops
{
    uint32_t api_version; ///< PLS_API_VERSION
    const char *name;     ///< the scene key
    const char *meaning;  ///< one line for the docs
    const pls_parameter *parameters;
    bool in_2d, in_3d; ///< where the shape may be used
    bool unbounded;    ///< extends to infinity (a half-space): never moves by forces, has no mass

    /// Signed distance, negative inside [m].  P1 eq. 1. Required.
    double (*sdf)(const double *values, pls_vec3 X);
    /// Radius of the smallest sphere about the origin that holds the shape [m]; not called for unbounded shapes. Required otherwise.
    double (*bounding_radius)(const double *values);
    /// Volume and inertia at unit density. Required for bounded shapes.
    pls_status (*mass_properties)(const double *values, int dimension, pls_mass_properties *out);
} pls_shape_ops;

#ifdef __cplusplus
}
#endif
#endif
