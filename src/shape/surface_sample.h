// surface_sample.h -- a surface as many small pieces: where they are, how they face, how large they are, which ball lies under them; and balls about many of them.
//
// What contact integrates over where it knows nothing of a shape but its SDF. Pieces come from a lattice laid over the shape: one for each cell that the surface goes through.
#ifndef PLS_SHAPE_SURFACE_SAMPLE_H
#define PLS_SHAPE_SURFACE_SAMPLE_H

#include <particls/shape.h>

typedef struct pls_surface_piece
{
    pls_vec3 x;  ///< on the surface [m]
    pls_vec3 n;  ///< outward, unit
    double area; ///< [m^2]; 2D: length [m]
    /// A ball within the body, half as large as the largest one that touches its surface here: near edges small, on them nothing.
    pls_vec3 inner;
    double inner_radius; ///< [m]
} pls_surface_piece;

/// Pieces first .. last and their inner balls lie in it. Balls stand in the order in which a walk meets them: a ball, then those within; `next` is the one behind all of these.
typedef struct pls_surface_ball
{
    pls_vec3 centre;
    double radius; ///< [m]
    uint32_t first, last, next;
    bool leaf;
} pls_surface_ball;

struct pls_surface_sample
{
    pls_surface_piece *piece;
    pls_surface_ball *ball;
    size_t count, balls;
    double spacing;       ///< of the lattice [m]
    double largest_inner; ///< radius [m]
    double flat;          ///< share of the area that bends less, in one direction at least, than a ball ten times as large as the shape
};

/// About `count` pieces of a bounded shape, the same each time. LIMIT_EXCEEDED: the shape is so thin that no lattice of a sensible size meets its surface as often.
pls_status pls_surface_sample_make(const pls_shape *shape, size_t count, pls_surface_sample **out);
/// A shape that has none gets one, if its surface is one of a body. Not while others use the shape for the first time.
pls_status pls_shape_need_sample(const pls_shape *shape);
void pls_surface_sample_free(pls_surface_sample *sample);

#endif
