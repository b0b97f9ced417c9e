// polytope.h -- convex polytopes from points: the hull, its faces, its neighbours, and the point that lies furthest along a direction.
#ifndef PLS_SHAPE_POLYTOPE_H
#define PLS_SHAPE_POLYTOPE_H

#include <particls/shape.h>

enum { PLS_HULL_STARTS = 27 }; ///< directions from which a search for a support point begins

/// A polytope that owns its arrays, with what makes questions to it fast. In 2D the faces are the edges, of two vertices each, counterclockwise.
typedef struct pls_hull
{
    pls_polytope body;
    double *offset; ///< of each face's plane, the outermost of its vertices: n.x <= offset for all points of the polytope [m]
    uint32_t start[PLS_HULL_STARTS];
    pls_vec3 lower, upper; ///< bounds [m]
} pls_hull;

/// The convex hull of `points`, in 2D of their x and y. Coplanar triangles are merged to faces, points inside of faces and edges are left out (flat within 1e-10 of
/// the size). INVALID_ARGUMENT for too few points, points in a plane (2D: on a line) and numbers that are not finite.
pls_status pls_hull_make(const pls_vec3 *points, size_t count, int dimension, pls_hull **out);
/// Null is fine.
void pls_hull_free(pls_hull *hull);

/// The vertex that lies furthest along n.
pls_vec3 pls_hull_support(const pls_hull *hull, pls_vec3 n);
/// Largest distance of a vertex from `centre` [m].
double pls_hull_radius(const pls_hull *hull, pls_vec3 centre);

#endif
