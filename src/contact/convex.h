// convex.h -- distance and penetration depth of two convex sets known by their support functions, in 2D and 3D.
//
// Everything is told in terms of the Minkowski difference M = A - B: the sets overlap where M holds the origin, and the depth is the
// distance of the origin from M's boundary. With F(n) = max over M of n.w, the depth is the least F over unit n; less than zero: a gap.
// Gilbert, Johnson & Keerthi, IEEE J. Robotics Automation 4 (1988) 193 for gaps; van den Bergen, Game Developers Conference 2001 for
// expanding polytopes; incremental depth: GJK on sets pushed apart, so that overlaps are solved as gaps are.
//
// Sets may be rounded: each is the set of points within `margin` of its core, which `support` tells of. Cores are solved, margins added,
// so that cores apart give depths to rounding error. Nothing allocates; all loops are bounded, also with coordinates that are not finite.
#ifndef PLS_CONTACT_CONVEX_H
#define PLS_CONTACT_CONVEX_H

#include <particls/types.h>

/// A convex set, posed.
typedef struct pls_convex
{
    pls_vec3 (*support)(const void *self,
                        pls_vec3 n); ///< the core's point furthest along n (not zero, not always of length one), in the world
    double (*sdf)(
        const void *self,
        pls_vec3 X); ///< signed distance of the core, at least exact enough inside not to tell of more depth than there is; null: not known
    const void *self;
    pls_vec3 centre;  ///< a point that moves with the body, inside [m]
    pls_vec3 axis[3]; ///< the body's, in the world; also in 2D
    double size;      ///< diameter, roughly [m]: the measure of all tolerances
    double margin;    ///< of rounding [m]
    bool polytope;    ///< the core is one: depths are exact after finitely many support points
    int dimension;    ///< 2 (all z = 0) or 3
} pls_convex;

typedef struct pls_depth
{
    double delta;        ///< > 0 overlapping, < 0 apart [m]
    pls_vec3 normal;     ///< unit, from A to B
    pls_vec3 on_a, on_b; ///< points of the surfaces: on_a - on_b = delta normal [m]
    int iterations;      ///< of GJK and EPA
    int support_calls;   ///< pairs of support points asked for
    bool converged;      ///< if not, `delta` still is F(normal): an upper bound of the depth
    bool local;          ///< overlapping cores, and no proof that this is the least depth of all
} pls_depth;

/// A support point of M and the points of A and B it comes from.
typedef struct pls_support_pair
{
    pls_vec3 a, b;
    pls_vec3 w; ///< a - b less the shift of B
    int stored; ///< number in the pls_depth_state it was taken from; -1: new
} pls_support_pair;

/// Vertices of M and the weights of its point nearest to the origin.
typedef struct pls_simplex
{
    int count;
    pls_support_pair point[4];
    double weight[4];
} pls_simplex;

typedef struct pls_gap
{
    pls_vec3 v;      ///< point of M nearest to the origin [m]
    double distance; ///< its length; 0 if overlapping
    bool overlap;    ///< or closer than PLS_TOUCHING of the size, where v has no direction to speak of
    double open;     ///< by how much less it may be, as far as support points tell [m]: an overlap if that is all of it
    bool converged;
    int iterations;
    int support_calls;
} pls_gap;

/// What a pair remembers between steps; all zero: nothing. Points lie in the frames of their bodies, so that they stay members.
typedef struct pls_depth_state
{
    double known;         ///< 1: normal and delta hold
    double normal[3];     ///< in A's frame
    double delta;         ///< of the cores [m]
    double size[2];       ///< of A and B when points were stored: points of bodies that grew are forgotten [m]
    double count;         ///< of points
    double point_a[3][3]; ///< in A's frame, from its centre [m]
    double point_b[3][3]; ///< in B's frame
} pls_depth_state;

#define PLS_TOUCHING 1e-10 ///< cores closer than this part of the size count as overlapping

/// Pair of support points along n, B moved by `shift`.
pls_support_pair pls_support_of(const pls_convex *a, const pls_convex *b, pls_vec3 shift, pls_vec3 n);

/// Reduce `simplex` to the face that holds the point nearest to the origin; give that point. `*inside`: the simplex holds the origin.
pls_vec3 pls_simplex_nearest(pls_simplex *simplex, int dimension, bool *inside);

/// Distance of the cores, B moved by `shift`, from a simplex of members of M (none: count 0), which becomes the last one.
pls_gap pls_gjk(const pls_convex *a, const pls_convex *b, pls_vec3 shift, pls_simplex *simplex);

/// Depth of cores that overlap, from GJK's last simplex, to `tolerance` [m]. Cores only, no margins; `simplex` becomes the nearest face.
pls_depth pls_epa(const pls_convex *a, const pls_convex *b, double tolerance, pls_simplex *simplex);

/// A minimum of F near a normal, of cores, by exact means. False: there is none to be had.
typedef struct pls_exact_depth
{
    bool (*near)(const void *self, pls_vec3 n, pls_depth *d);
    const void *self;
} pls_exact_depth;

/// Is there a direction with less depth than at `known`, a local minimum of F? True: `known` is one that has, to be followed to its own minimum. False: `known` is the least to `tolerance`, and
/// to 5e-7 of itself among directions closer to it than 1e-3 rad; `converged` tells whether that is certain to PLS_LEFT_OPEN of the size; `local`, that faces were too thin to tell, and
/// `exact` null or of no help.
bool pls_epa_less(const pls_convex *a, const pls_convex *b, double tolerance, const pls_exact_depth *exact, pls_depth *known);

#define PLS_LEFT_OPEN 1e-7

/// Distance or depth with nothing known, margins included.
pls_depth pls_depth_cold(const pls_convex *a, const pls_convex *b);

/// The same from what the last step left in `state`, and from scratch where that does not serve.
pls_depth pls_depth_warm(const pls_convex *a, const pls_convex *b, pls_depth_state *state);

#endif
