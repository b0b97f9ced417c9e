/// @file shape.h
/// Shapes: what a grain looks like, as a signed distance function in its own frame, before the body's scale.
///
/// A shape needs one function, `sdf`. Mass, centre of mass, principal frame, bounds, surface nodes, support points, contact and pictures follow from it by default
/// (slowly), and each can be had exactly or faster from a function of its own. See docs/extending.md.
#ifndef PARTICLS_SHAPE_H
#define PARTICLS_SHAPE_H

#include <particls/parameter.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pls_shape pls_shape;

/// Volume and moments at the shape's own density, 1 unless it says otherwise. In 2D `volume` is the area; the world multiplies by its thickness.
typedef struct pls_mass_properties
{
    double volume;     ///< integral of the density [m^3], 2D [m^2]; what the shape fills is `volume` of the shape
    pls_vec3 centre;   ///< centre of mass, in the shape's frame [m]
    double inertia[6]; ///< tensor about the centre of mass: xx, yy, zz, xy, xz, yz [m^5]; 2D: only zz [m^4]
    double error;      ///< estimated relative error of the quadrature; 0: closed form
} pls_mass_properties;

/// A convex polytope: what is left of many shapes when a rounding radius is taken off. Faces in the order of the right hand seen from outside.
typedef struct pls_polytope
{
    const pls_vec3 *vertex;
    uint32_t vertex_count;
    const uint32_t *face_start; ///< face_count + 1 places in `face_vertex`; null for points and segments
    const uint32_t *face_vertex;
    const pls_vec3 *face_normal; ///< outward, unit
    uint32_t face_count;
    const uint32_t *neighbour_start; ///< per vertex: vertices joined to it by an edge, for walking uphill; null: try all
    const uint32_t *neighbour;
} pls_polytope;

/// A shape as a part of another one: x_whole = position + scale * (orientation turns X), X in the part's own frame.
typedef struct pls_shape_part
{
    const pls_shape *shape; ///< lives as long as the whole
    pls_vec3 position;      ///< of its frame in the frame of the whole [m]
    pls_quat orientation;   ///< of length one
    double scale;
} pls_shape_part;

/// A tree of boxes about the parts of a shape, by which those near a point are found.
typedef struct pls_part_tree pls_part_tree;
typedef struct pls_distance_field pls_distance_field;
typedef struct pls_surface_sample pls_surface_sample;

/// A density that varies in space, relative to the material's.
typedef struct pls_density_field
{
    double (*at)(void *context, pls_vec3 X); ///< X in the shape's frame, before the body's scale; positive and finite all over the shape
    void *context;
} pls_density_field;

typedef struct pls_shape_input
{
    const double *values;   ///< as the table of parameters says; null: all defaults
    size_t value_count;     ///< of them; with fewer than the table has the shape is refused (INVALID_ARGUMENT), more are not read
    const pls_vec3 *points; ///< of the table's row of kind PLS_PARAMETER_POINTS, in 2D with z = 0
    size_t point_count;
    const char *path;            ///< of its row of kind PLS_PARAMETER_PATH; null: not given
    const pls_shape_part *parts; ///< of its row of kind PLS_PARAMETER_SHAPES
    size_t part_count;
    const pls_density_field *density; ///< times the operations' own; null: 1. Asked while the shape is made, by one thread, and not kept
} pls_shape_input;

/// Operations of a shape. Null where a default from `sdf` should serve. All but `prepare` and `release` are pure functions and are called from several threads.
/// X are points and n unit vectors in the shape's frame, in 2D with z = 0.
typedef struct pls_shape_ops
{
    uint32_t api_version; ///< PLS_API_VERSION
    const char *name;     ///< the scene key
    const char *meaning;  ///< one line for the docs
    const pls_parameter *parameters;
    bool in_2d, in_3d; ///< where the shape may be used
    bool unbounded;    ///< extends to infinity (a half-space): never moves by forces, has no mass
    bool wall;   ///< of finite size, but a surface without an inside: never moves by forces, has no mass; its SDF may be nowhere negative
    bool convex; ///< with any numbers; a shape that is so with some says it by `is_convex`
    bool smooth; ///< its surface is twice differentiable with curvature everywhere: contact by Newton's method on the sphere of normals

    /// Check what the table cannot, and make what the other functions need (null and no data where numbers do). `*data` is released by `release`.
    pls_status (*prepare)(const pls_shape_input *input, int dimension, void **data);
    void (*release)(void *data);

    /// Signed distance, negative inside [m].  P1 eq. 1. Required. Must be the true distance outside of the shape; inside it may be less negative.
    double (*sdf)(const pls_shape *shape, pls_vec3 X);
    /// Its gradient, of length one outside.
    pls_vec3 (*gradient)(const pls_shape *shape, pls_vec3 X);
    bool (*is_convex)(const pls_shape *shape);
    /// Of a convex shape, where it costs much less than the distance: a convex function of X that is 0 on the surface and less inside, and its gradient. Pictures follow
    /// rays by it; null: by the distance.
    double (*level)(const pls_shape *shape, pls_vec3 X, pls_vec3 *gradient);
    /// The point of a convex shape that lies furthest along n, a radius `margin` less.
    pls_vec3 (*support)(const pls_shape *shape, pls_vec3 n);
    /// Derivative of the support point with respect to n (symmetric: xx, yy, zz, xy, xz, yz) [m], for `smooth` shapes.
    void (*support_gradient)(const pls_shape *shape, pls_vec3 n, double derivative[6]);
    /// Radius of the ball that rounds the shape: it is the set of points within `margin` of what `support` and `polytope` tell of [m].
    double (*margin)(const pls_shape *shape);
    /// The shape less its margin, if that is a polytope; else null.
    const pls_polytope *(*polytope)(const pls_shape *shape);
    /// argmin over Y of sdf(Y) + |Y - X|^2 / (2 step): the proximal map (P1 section 3), for the ADMM solver.
    pls_vec3 (*proximal)(const pls_shape *shape, pls_vec3 X, double step);
    /// Radius of a sphere about the centre of mass that holds the shape [m].
    double (*bounding_radius)(const pls_shape *shape);
    /// A box that holds the shape, the smallest if possible [m].
    void (*bounds)(const pls_shape *shape, pls_vec3 *lower, pls_vec3 *upper);
    pls_status (*mass_properties)(const pls_shape *shape, pls_mass_properties *out);
    /// Density relative to the material's; null: 1.
    double (*density)(const pls_shape *shape, pls_vec3 X);
    /// The shapes that this one is the union of, each touched by itself; null: the shape itself is its one part. They lie in what `prepare` made. Parts of parts are
    /// no parts: whoever has parts made of parts tells of the innermost.
    const pls_shape_part *(*parts)(const pls_shape *shape, size_t *count);
} pls_shape_ops;

/// A shape with its numbers. Made by `pls_shape_make`; to be read only.
struct pls_shape
{
    const pls_shape_ops *ops;
    unsigned users; ///< who keep it
    int dimension;
    const double *values; ///< as the table of parameters says
    void *data;           ///< what `prepare` made
    double size;          ///< how far it reaches from the origin, roughly [m]
    bool convex;
    double margin;                    ///< [m]
    const pls_polytope *polytope;     ///< or null
    double inner_radius;              ///< of balls that touch the surface from inside and fit everywhere; not convex: 0 [m]
    double radius;                    ///< of the bounding sphere about the centre of mass [m]; INFINITY if unbounded
    pls_vec3 lower, upper;            ///< bounds [m]
    pls_mass_properties mass;         ///< as measured, in the shape's frame
    pls_vec3 moments;                 ///< principal moments about the centre of mass; 2D: only z
    pls_quat principal;               ///< turns principal axes into the shape's axes
    const pls_shape_part *part;       ///< what it is the union of, in an order in which neighbours lie together; null: itself
    size_t part_count;                ///< 0: the shape itself is its one part
    pls_part_tree *tree;              ///< over the parts; null without
    double volume;                    ///< that it fills, whatever its density [m^3], 2D: its area [m^2]
    bool uneven;                      ///< its density varies in space: `mass` is by that density
    const pls_density_field *density; ///< while it is made: that of its input
    pls_surface_sample *sample;       ///< pieces of its surface, where contact goes by them; else null
    pls_distance_field *field;        ///< its distance on a lattice, where contact goes by that; else null
};

/// Make a shape: checks the numbers, prepares, measures what the operations do not give, and tries whether `sdf` is what it should be.
/// INVALID_ARGUMENT tells where an SDF lies, with the point and the value: not finite, steeper than 1 or less steep, with jumps, of the wrong sign, nowhere negative, or
/// not convex though the shape is said to be. `name` begins or is in all messages but those of memory.
pls_status pls_shape_make(const pls_shape_ops *ops, int dimension, const pls_shape_input *input, const char *name,
                          pls_shape **out); // `name` starts messages: "shape 'stone'"
/// One more keeper of the shape, who frees it too.
pls_shape *pls_shape_keep(pls_shape *shape);
/// Gone with its last keeper. Null is fine.
void pls_shape_free(pls_shape *shape);

/// From the frame of bodies (centre of mass, principal axes) to the shape's own.
static inline pls_vec3 pls_shape_from_body(const pls_shape *shape, pls_vec3 X)
{
    return pls_add(pls_rotate(shape->principal, X), shape->mass.centre);
}

/// Signed distance, negative inside [m]. All these take and give points in the shape's own frame.
double pls_shape_sdf(const pls_shape *shape, pls_vec3 X);
/// By the shape's function or central differences.
pls_vec3 pls_shape_gradient(const pls_shape *shape, pls_vec3 X);
/// By the shape's function or, for convex shapes, from its SDF. Margin included.
pls_vec3 pls_shape_support(const pls_shape *shape, pls_vec3 n);
/// The point of the surface that is nearest.
pls_vec3 pls_shape_nearest(const pls_shape *shape, pls_vec3 X);
/// Radius of a sphere about X that holds the shape, the smallest or a little more [m].
double pls_shape_reach(const pls_shape *shape, pls_vec3 X);
/// `count` points of the surface, evenly spread: none of the surface is further from one of them than about the distance of neighbours. The same points each time.
/// INVALID_ARGUMENT for unbounded shapes.
pls_status pls_shape_surface_nodes(const pls_shape *shape, size_t count, pls_vec3 *nodes);

/// @name Parts
/// @{
/// The parts whose bounding boxes come within `radius` of X, in rising order. Returns how many there are; `part` takes the first `capacity` of their numbers, so a second
/// call with more room gets them all. Allocates nothing, takes O(log n + found). 0 for shapes without parts.
size_t pls_shape_parts_near(const pls_shape *shape, pls_vec3 X, double radius, uint32_t *part, size_t capacity);
/// From the frame of the whole to the part's own, lengths included, and back.
static inline pls_vec3 pls_part_from_whole(const pls_shape_part *part, pls_vec3 X)
{
    return pls_scale(pls_rotate_back(part->orientation, pls_sub(X, part->position)), 1.0 / part->scale);
}
static inline pls_vec3 pls_part_to_whole(const pls_shape_part *part, pls_vec3 X)
{
    return pls_add(part->position, pls_scale(pls_rotate(part->orientation, X), part->scale));
}
/// @}

#ifdef __cplusplus
}
#endif
#endif
