// clipped.h -- what is left of a block after cutting it by half-spaces: a small convex polytope and its volume, centroid and surfaces. An oracle for contact/overlap.h.
//
// Three edges meet at every vertex, also where more planes do (several vertices then share a place). A cut looks only at the sides on which vertices lie and then
// works on edges alone, so that rounding errors may move a vertex but never break the surface. After Sugihara & Iri, J. Appl. Math. 1992, 15; moments by the
// divergence theorem.
#ifndef PLS_TEST_CLIPPED_H
#define PLS_TEST_CLIPPED_H

#include <particls/types.h>

/// Most vertices: 2 F - 4 of the 774 planes that two bodies of 256 faces, the block, and the cells of one body can give.
enum { PLS_CLIPPED_VERTICES = 1544 };

/// The points with normal.x <= offset.
typedef struct pls_half_space
{
    pls_vec3 normal;
    double offset; ///< [m]
} pls_half_space;

/// Edge h = 4 v + k is the k-th of vertex v, in counterclockwise order seen from outside.
typedef struct pls_clipped
{
    int count; ///< of vertices; 0: nothing left
    bool full; ///< there was no room for a vertex: nothing left and not to be believed
    pls_vec3 x[PLS_CLIPPED_VERTICES];
    uint16_t twin[4 * PLS_CLIPPED_VERTICES]; ///< the same edge seen from its other end
    uint8_t label[4 * PLS_CLIPPED_VERTICES]; ///< of the face on the left of the edge
} pls_clipped;

enum { PLS_CLIPPED_LABELS = 3 };

typedef struct pls_clipped_measure
{
    double volume;                            ///< [m^3]
    pls_vec3 first;                           ///< integral of x [m^4]
    double second[6];                         ///< of x (x) x: xx, yy, zz, xy, xz, yz [m^5]
    pls_vec3 area[PLS_CLIPPED_LABELS];        ///< integral of the outward normal over the faces of a label [m^2]
    pls_vec3 area_moment[PLS_CLIPPED_LABELS]; ///< of x cross normal [m^3]
} pls_clipped_measure;

/// The block |axis_k.(x - centre)| <= half_k; axes right-handed. Its faces get `label`.
void pls_clipped_block(pls_clipped *c, pls_vec3 centre, const pls_vec3 axis[3], const double half[3], uint8_t label);
/// Keep what lies in the half-space; the new face gets `label`.
void pls_clip(pls_clipped *c, const pls_half_space *h, uint8_t label);
void pls_clipped_copy(pls_clipped *to, const pls_clipped *from);
/// Best with the origin near.
void pls_clipped_measure_of(const pls_clipped *c, pls_clipped_measure *out);

#endif
