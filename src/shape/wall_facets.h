// wall_facets.h -- how the pieces of a wall lie to each other: triangles of a mesh, segments of a polyline.
//
// A body that lies across a seam touches the wall once, not once per piece, and what is behind a piece ends where what is behind its neighbour begins. For that a piece knows
// its neighbours, the planes that halve the angles of its seams, and to which patch of nearly level pieces it belongs. All vectors are in the axes of the wall.
#ifndef PLS_SHAPE_WALL_FACETS_H
#define PLS_SHAPE_WALL_FACETS_H

#include <particls/shape.h>

#define PLS_NO_FACET     UINT32_MAX
#define PLS_LEVEL_FACETS 0.96592582628906831 ///< cosine of 15 degrees: facets of one patch differ by less from its first one

/// Of a triangle side k is that from corner k to the next one, of a segment its end k.
typedef struct pls_facet
{
    uint32_t number;           ///< of the piece in its wall, as it was made
    pls_vec3 normal;           ///< on the one side, the same of all pieces that hang together
    uint32_t sheet;            ///< pieces that hang together have the same
    uint32_t patch;            ///< pieces that hang together and are level to 15 degrees have the same
    uint32_t neighbour[3];     ///< number of the piece beyond side k; PLS_NO_FACET: the side is free
    bool leans[3];             ///< the piece beyond goes on to another one there: this one ends on it, as a fin on a floor
    bool level[3];             ///< the neighbour is of the same patch
    double bend[3];            ///< by which the wall turns away from `normal` there; negative: towards it [rad]
    pls_vec3 side[3];          ///< unit, outwards: normal of the plane that halves the angle of the seam
    pls_vec3 side_normal[3];   ///< unit: mean of the normals of both pieces
    pls_vec3 corner_normal[3]; ///< unit: mean of the normals of all pieces at corner k, by their angles
    double corner_level[3];    ///< the least of their cosines with it
    double reach
        [2]; ///< how far behind it, on the side of minus its normal and on the other one, it is the nearest piece; INFINITY: for good [m]
    int corner_form[3]; ///< 1: no seam at corner k turns towards the normal, and none is free; -1: none turns away; 0: else
} pls_facet;

/// Beyond side k lies facet `neighbour`, which goes on along `beyond`, at right angles to the side.
void pls_facet_join(pls_facet *facet, int k, uint32_t neighbour, pls_vec3 beyond, bool level);

/// Leaves one of pieces between the same corners, in any order; returns how many are left.
pls_status pls_wall_unique(pls_vec3 (*corner)[3], size_t *count, int dimension);

/// Tells of `count` pieces with D (2 or 3) corners each, none without length or area, and turns those over (exchanges two corners) whose normal is not that of the pieces before
/// them that they hang together with. Corners at exactly the same place are one. OUT_OF_MEMORY.
pls_status pls_wall_facets(pls_vec3 (*corner)[3], size_t count, int dimension, pls_facet *out);

/// Finds the reach of the facets of a wall whose parts are known.
void pls_wall_find_reach(pls_shape *shape);

/// Of a piece of a mesh or a polyline; null: the shape is none.
const pls_facet *pls_shape_facet(const pls_shape *shape);

#endif
