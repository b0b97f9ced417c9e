// column_quadrature.h -- moments of the part of a shape that lies in a cube, by quadrature along columns.
#ifndef PLS_SHAPE_COLUMN_QUADRATURE_H
#define PLS_SHAPE_COLUMN_QUADRATURE_H

#include <particls/shape.h>

enum { PLS_MOMENTS = 10 }; ///< 1, x, y, z, xx, yy, zz, xy, xz, yz; 2D: those of z are 0

/// A place where the density is none.
typedef struct pls_density_fault
{
    bool found;
    pls_vec3 at; ///< in the frame of the shape [m]
    double value;
} pls_density_fault;

/// A turned frame, so that the faces of shapes, which like to lie along axes, are not parallel to columns.
typedef struct pls_column_frame
{
    const pls_shape *shape;
    pls_vec3 origin;  ///< in the frame of the shape [m]
    pls_vec3 axis[3]; ///< unit; 2D: the third along z
    double reach;     ///< the shape lies within this distance of the origin [m]
    pls_density_fault
        *uneven; ///< not null: the shape's density counts, and the first place where it is not positive and finite is noted here
} pls_column_frame;

/// Density relative to the material's at a point of the shape's frame. One that is none is noted, and 1 taken in its place so that the quadrature comes to an end.
double pls_column_density(const pls_column_frame *frame, pls_vec3 X);
/// SDF at a point of the frame.
double pls_column_phi(const pls_column_frame *frame, const double x[3]);
void pls_column_gradient(const pls_column_frame *frame, const double x[3], double g[3]);

/// Moments of the shape within `half` of `centre` along all axes, in the frame; and once more, with lines along the other axis (2D: columns) and
/// another rule: how far the two differ tells how far the first may err.
void pls_column_moments(const pls_column_frame *frame, const double centre[3], double half, double sum[PLS_MOMENTS],
                        double again[PLS_MOMENTS]);

#endif
