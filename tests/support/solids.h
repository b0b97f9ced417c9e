// solids.h -- shapes, poses and depths for tests of contact. What cannot be made fails the test.
#ifndef PLS_TEST_SOLIDS_H
#define PLS_TEST_SOLIDS_H

#include "contact/convex.h"
#include "contact/narrow_phase.h"

/// One stream of random numbers for the whole program.
void solids_seed(uint64_t seed);
double solids_uniform(double low, double high);
pls_vec3 solids_direction(int dimension);
/// By `angle` about the unit vector `axis`.
pls_quat solids_turn(pls_vec3 axis, double angle);
/// The least rotation that takes unit a to unit b.
pls_quat solids_turn_to(pls_vec3 a, pls_vec3 b);

pls_shape *solids_make(const pls_shape_ops *ops, int dimension, const pls_shape_input *input);
pls_shape *solids_box(int dimension, double x, double y, double z, double rounding);
pls_shape *solids_plane(int dimension);
pls_shape *solids_cylinder(double radius, double length, double rounding);
pls_shape *solids_hull(int dimension, const pls_vec3 *points, size_t count, double rounding);
/// The hull of random points of an ellipsoid about the origin, of half axes 0.4 to 0.6.
pls_shape *solids_stone(int dimension, int count, double rounding);

pls_narrow_options solids_options(pls_faces faces, double area);
/// The narrow phase without memory.
pls_touch solids_touch(const pls_posed *a, const pls_posed *b, pls_faces faces, double area);
/// Of a body and all facets of a wall, touched as one and seen from outside of a closed wall about its origin.
pls_touch solids_wall_touch(const pls_posed *a, const pls_posed *wall, pls_faces faces, double area);
/// `pls_faces_touch` for those who do not ask whether there is a record.
bool solids_faces_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                        pls_overlap_record *record, pls_touch *out);
/// Of a touch of two shapes by the volume law of area 1: add force and torque about the world's origin on B, and twice the energy.
void solids_add_wrench(const pls_posed *a, const pls_posed *b, pls_vec3 *force, pls_vec3 *torque, double *energy);
/// Penetration depth; `state` may be null.
pls_depth solids_depth(const pls_posed *a, const pls_posed *b, pls_pair_state *state);

#endif
