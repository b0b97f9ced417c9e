// narrow_oracle.h -- depths found the slow way, and the campaign that compares the narrow phase with them: a short form for the tests, a long one for `make prove`.
//
// With F(n) = h_A(n) + h_B(-n) the depth is the least F. Whatever n an answer gives, F(n) is an upper bound of it; what is left to show is that no other n has less.
//   overlapping polytopes   all normals of faces and all products of edges whose normals meet (separating axes): exact
//   a gap, also of cores    two points of the bodies a distance apart along n, and F(n) = minus that distance: bounds from both sides, so a proof
//   overlaps, mostly        a ball about the point of one body that lies in the other: F is no less than its radius along any n. A proof as well, but without the oracle's own normal
//   all else                branch and bound over all directions: support points of the Minkowski difference bound F from below over cones of directions, which are halved until no
//                           cone is left where F could be less. A proof too
// Support functions here are the oracle's own: all vertices tried, or closed forms.
#ifndef PLS_TESTS_NARROW_ORACLE_H
#define PLS_TESTS_NARROW_ORACLE_H

#include "contact/narrow_phase.h"

enum { NARROW_SHAPES_3D = 15, NARROW_SHAPES_2D = 9, NARROW_MOST_SHAPES = 15 };

/// What was seen of a pair of shapes. Lengths are parts of the smaller bounding radius.
typedef struct narrow_tally
{
    uint64_t checked;
    uint64_t searched;     ///< of these, where the oracle looked for less
    double depth;          ///< worst error: |delta - F(n)|, or delta less what bounds the least F from below
    double depth_relative; ///< the same as part of the depth or distance, of those above 1e-6
    double normal;         ///< distance from one whose F is the depth, where the answer's own F is not
    double points;         ///< worst distance of a witness point from its surface
    uint64_t
        wrong; ///< errors of the depth above what is allowed as part of the depth itself, or of points above 1e-6 of it, round-off of coordinates beside
    uint64_t not_finite;
    double nanoseconds; ///< per query, along trajectories
    pls_narrow_counts counts;
} narrow_tally;

/// Shapes of the campaign in 2D or 3D by number; the last is the plane, which comes as B only. Null after the last.
const pls_shape *narrow_shape(int dimension, int number);
const char *narrow_name(int dimension, int number);
void narrow_free_shapes(void);
/// Error of depths allowed for a pair, as part of the depth: 1e-8 for polytopes, 1e-6 for others.
double narrow_allowed(int dimension, int a, int b);

/// One pair at poses whose shape and size are set here; nothing known beforehand, searched.
void narrow_once(int dimension, int a, int b, const pls_posed pose[2], narrow_tally *tally);
/// Random poses, half of them overlapping, by 1e-6 to 5 % of the size; nothing known beforehand. `searched`: of how many one is searched also where a ball proves it.
void narrow_random(int dimension, int a, int b, int pairs, int searched, uint64_t seed, narrow_tally *tally);
/// Tumbling trajectories through gaps and overlaps up to 5 %, warm; one step of `every` is compared.
void narrow_tumble(int dimension, int a, int b, int trajectories, int steps, int every, int searched, uint64_t seed, narrow_tally *tally);

#endif
