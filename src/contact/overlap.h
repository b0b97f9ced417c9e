// overlap.h -- integrals over the overlap of two convex bodies of plane faces.
#ifndef PLS_CONTACT_OVERLAP_H
#define PLS_CONTACT_OVERLAP_H

#include "contact/faces.h"
#include "math/simd.h"

/// The points with normal.x <= offset.
typedef struct pls_half_space
{
    pls_vec3 normal;
    double offset; ///< [m]
} pls_half_space;

static inline pls_half_space pls_half_space_through(pls_vec3 normal, pls_vec3 point)
{
    return (pls_half_space){normal, pls_dot(normal, point)};
}

enum { PLS_MOST_CORNERS = 2 * PLS_MOST_FACES };

typedef struct pls_near_face
{
    pls_half_space plane;
    const uint32_t *
        outline; ///< places in `corner`, round the face as the right hand does about its normal, in 2D from the one end to the other; null for walls
    int corners;
    bool enters; ///< may bound the overlap, not just be the nearest to a point of it
} pls_near_face;

/// Of a body what may have to do with the overlap, about an origin in the overlap, for walls on their front.
typedef struct pls_near_body
{
    int faces;  ///< those that the depth of a point goes by, the nearest to the origin first
    int planes; ///< all: the rest are the sides of the prism behind a facet
    pls_near_face face[PLS_MOST_FACES];
    int corners;                       ///< of the outlines
    uint16_t used[PLS_MOST_CORNERS];   ///< their places in `corner`
    pls_vec3 corner[PLS_MOST_CORNERS]; ///< [m]
    double reach;                      ///< how far the body extends from the origin at the most, for walls that of the other [m]
} pls_near_body;

/// A wrench on B about the origin, and the energy of which it is minus the gradient.
typedef struct pls_push
{
    double energy;
    pls_vec3 force, torque;
} pls_push;

/// In 2D of a slab of thickness 1.
struct pls_overlap_integrals
{
    double volume;                    ///< [m^3]
    double surface;                   ///< sum of areas [m^2]
    pls_vec3 first;                   ///< integral of x [m^4]
    double second[6];                 ///< of x (x) x: xx, yy, zz, xy, xz, yz [m^5]
    pls_vec3 area;                    ///< integral of the outward normal over A's surface in B [m^2]
    pls_vec3 area_moment;             ///< of x cross normal [m^3]
    bool scattered;                   ///< `area_moment` is the integral of x over the area in its place: of pieces, and of lines
    bool line;                        ///< over a line, whose length `surface` is; powers of m are one less
    pls_push by_depth, by_its_square; ///< of d and of d^2: the mean of both bodies, or d of the wall alone
};

/// `blur` is a length that rounding does not reach: faces of A and B that lie in one plane count once [m].
PLS_SIMD_DECLARE(void, pls_overlap_integrate, const pls_near_body *a, const pls_near_body *b, int dimension, double blur,
                 pls_overlap_integrals *out);

/// Integrals of d^2 and d^3 over where the cells of two of the listed faces of `s` meet in the overlap, times the difference of their normals.
PLS_SIMD_DECLARE(void, pls_overlap_seams, const pls_near_body *s, const int *list, int count, const pls_near_body *other, int dimension,
                 double blur, double seam[2]);

#endif
