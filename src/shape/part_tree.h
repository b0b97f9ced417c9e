// part_tree.h -- a tree of boxes about the parts of a shape: which are near a point, which is the nearest.
#ifndef PLS_SHAPE_PART_TREE_H
#define PLS_SHAPE_PART_TREE_H

#include <particls/shape.h>

/// Bring `part` into the order of the tree and make it. The tree looks at the array as long as it lives.
pls_status pls_part_tree_make(pls_shape_part *part, size_t count, pls_part_tree **out);
/// Null is fine.
void pls_part_tree_free(pls_part_tree *tree);

/// See pls_shape_parts_near.
size_t pls_part_tree_near(const pls_part_tree *tree, pls_vec3 X, double radius, uint32_t *part, size_t capacity);
/// The part whose signed distance at X, told in `*distance`, is the least of all.
const pls_shape_part *pls_part_tree_nearest(const pls_part_tree *tree, pls_vec3 X, double *distance);
/// Signed distance of a shape that is the union of its parts, and its gradient.
double pls_union_sdf(const pls_shape *shape, pls_vec3 X);
pls_vec3 pls_union_gradient(const pls_shape *shape, pls_vec3 X);
/// The box about all parts, not the smallest.
void pls_part_tree_box(const pls_part_tree *tree, pls_vec3 *lower, pls_vec3 *upper);
/// The box about one part, not the smallest if it is turned.
void pls_part_box(const pls_shape_part *part, pls_vec3 *lower, pls_vec3 *upper);

#endif
