// part_tree.c -- a tree of boxes about the parts of a shape.
//
// The parts are put in order along a space-filling curve (Morton 1966) through the middles of their boxes, so that neighbours in space are neighbours in memory. A node
// of the tree is a range of them, halved until few are left: a question that walks the tree from left to right meets the parts in rising order, without sorting.
// The tree is made once and only read afterwards.

#include "shape/part_tree.h"

#include "base/alloc.h"
#include "base/sort.h"

enum {
    LEAF = 4,       ///< parts that are looked at one by one
    CURVE_BITS = 21 ///< per axis of the curve
};

typedef struct box
{
    double lower[3], upper[3];
} box;

typedef struct node
{
    box box;
    uint32_t first, count; ///< parts
    uint32_t right;        ///< the second half; the first one follows the node. 0: a leaf
} node;

struct pls_part_tree
{
    const pls_shape_part *part;
    box *part_box;
    node *node;
};

// ---- boxes ------------------------------------------------------------------------------------------------------------------------------------------------------

static box empty_box(void) { return (box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}}; }

static void take_in(box *b, const box *other)
{
    for (int a = 0; a < 3; ++a) b->lower[a] = fmin(b->lower[a], other->lower[a]), b->upper[a] = fmax(b->upper[a], other->upper[a]);
}

/// Of the turned bounds' corners, and no larger than that of the bounding sphere: both hold the part.
static box box_of(const pls_shape_part *part)
{
    box b = empty_box();
    pls_vec3 low = part->shape->lower, up = part->shape->upper, middle = pls_part_to_whole(part, part->shape->mass.centre);
    const double radius = part->scale * part->shape->radius, at[3] = {middle.x, middle.y, middle.z};
    for (int k = 0; k < 8; ++k)
    {
        pls_vec3 x = pls_part_to_whole(part, pls_vec(k & 1 ? up.x : low.x, k & 2 ? up.y : low.y, k & 4 ? up.z : low.z));
        const box corner = {{x.x, x.y, x.z}, {x.x, x.y, x.z}};
        take_in(&b, &corner);
    }
    const double ease = 1e-14 * (radius + fabs(at[0]) + fabs(at[1]) + fabs(at[2])); // for round-off
    for (int a = 0; a < part->shape->dimension; ++a)
    {
        b.lower[a] = fmax(b.lower[a], at[a] - radius) - ease;
        b.upper[a] = fmin(b.upper[a], at[a] + radius) + ease;
    }
    return b;
}

static double squared_distance(const box *b, pls_vec3 X)
{
    const double x[3] = {X.x, X.y, X.z};
    double sum = 0.0;
    for (int a = 0; a < 3; ++a)
    {
        double d = fmax(fmax(b->lower[a] - x[a], x[a] - b->upper[a]), 0.0);
        sum += d * d;
    }
    return sum;
}

void pls_part_box(const pls_shape_part *part, pls_vec3 *lower, pls_vec3 *upper)
{
    const box b = box_of(part);
    *lower = pls_vec(b.lower[0], b.lower[1], b.lower[2]);
    *upper = pls_vec(b.upper[0], b.upper[1], b.upper[2]);
}

void pls_part_tree_box(const pls_part_tree *tree, pls_vec3 *lower, pls_vec3 *upper)
{
    const box *b = &tree->node[0].box;
    *lower = pls_vec(b->lower[0], b->lower[1], b->lower[2]);
    *upper = pls_vec(b->upper[0], b->upper[1], b->upper[2]);
}

// ---- making ---------------------------------------------------------------------------------------------------------------------------------------------------

/// The bits of v, two places free after each.
static uint64_t spread(uint64_t v)
{
    uint64_t out = 0;
    for (int k = 0; k < CURVE_BITS; ++k) out |= (v >> k & 1) << (3 * k);
    return out;
}

static uint64_t place_on_curve(const box *b, const box *all)
{
    uint64_t key = 0;
    for (int a = 0; a < 3; ++a)
    {
        double edge = all->upper[a] - all->lower[a], middle = 0.5 * (b->lower[a] + b->upper[a]);
        double part = edge > 0.0 ? (middle - all->lower[a]) / edge : 0.0;
        key |= spread((uint64_t)(fmin(fmax(part, 0.0), 1.0) * ((1 << CURVE_BITS) - 1))) << a;
    }
    return key;
}

static pls_status order_of_parts(const pls_shape_part *part, size_t count, uint32_t *order)
{
    uint64_t *key = NULL;
    box all = empty_box();
    PLS_TRY(pls_allocate(&key, count, sizeof *key, "an order of parts"));
    for (size_t k = 0; k < count; ++k)
    {
        box b = box_of(&part[k]);
        take_in(&all, &b);
    }
    for (size_t k = 0; k < count; ++k)
    {
        box b = box_of(&part[k]);
        key[k] = place_on_curve(&b, &all);
        order[k] = (uint32_t)k;
    }
    pls_status status = pls_radix_sort_u64(key, order, count);
    pls_release(&key);
    return status;
}

/// A few parts keep their order.
static pls_status sort_parts(pls_shape_part *part, size_t count)
{
    uint32_t *order = NULL;
    pls_shape_part *sorted = NULL;
    if (count <= LEAF) return PLS_OK;
    PLS_TRY(pls_allocate(&order, count, sizeof *order, "an order of parts"));
    pls_status status = order_of_parts(part, count, order);
    if (status == PLS_OK) status = pls_allocate(&sorted, count, sizeof *sorted, "an order of parts");
    for (size_t k = 0; status == PLS_OK && k < count; ++k) sorted[k] = part[order[k]];
    for (size_t k = 0; status == PLS_OK && k < count; ++k) part[k] = sorted[k];
    pls_release(&sorted);
    pls_release(&order);
    return status;
}

/// Nodes in the order of a walk that goes left first; `*made` counts them. As deep as the logarithm of the count.
static void make_nodes(pls_part_tree *tree, uint32_t first, uint32_t count, uint32_t *made)
{
    node *here = &tree->node[(*made)++];
    *here = (node){.box = empty_box(), .first = first, .count = count};
    for (uint32_t k = first; k < first + count; ++k) take_in(&here->box, &tree->part_box[k]);
    if (count <= LEAF) return;
    make_nodes(tree, first, count / 2, made);
    here->right = *made;
    make_nodes(tree, first + count / 2, count - count / 2, made);
}

pls_status pls_part_tree_make(pls_shape_part *part, size_t count, pls_part_tree **out)
{
    pls_part_tree *tree = NULL;
    uint32_t made = 0;
    *out = NULL;
    if (count >= UINT32_MAX / 2) return pls_fail(PLS_LIMIT_EXCEEDED, "a shape of %zu parts; at most %u", count, UINT32_MAX / 2);
    PLS_TRY(sort_parts(part, count));
    PLS_TRY(pls_allocate(&tree, 1, sizeof *tree, "a tree of parts"));
    pls_status status = pls_allocate(&tree->part_box, count, sizeof *tree->part_box, "a tree of parts");
    if (status == PLS_OK) status = pls_allocate(&tree->node, count, sizeof *tree->node, "a tree of parts"); // leaves hold two parts or more
    if (status != PLS_OK)
    {
        pls_part_tree_free(tree);
        return status;
    }
    tree->part = part;
    for (size_t k = 0; k < count; ++k) tree->part_box[k] = box_of(&part[k]);
    make_nodes(tree, 0, (uint32_t)count, &made);
    *out = tree;
    return PLS_OK;
}

void pls_part_tree_free(pls_part_tree *tree)
{
    if (!tree) return;
    pls_release(&tree->part_box);
    pls_release(&tree->node);
    pls_release(&tree);
}

// ---- asking ---------------------------------------------------------------------------------------------------------------------------------------------------

typedef struct near_search
{
    pls_vec3 X;
    double squared_radius;
    uint32_t *part;
    size_t capacity, found;
} near_search;

static void look_near(const pls_part_tree *tree, uint32_t index, near_search *s)
{
    const node *n = &tree->node[index];
    if (squared_distance(&n->box, s->X) > s->squared_radius) return;
    if (n->right)
    {
        look_near(tree, index + 1, s);
        look_near(tree, n->right, s);
        return;
    }
    for (uint32_t k = n->first; k < n->first + n->count; ++k)
    {
        if (squared_distance(&tree->part_box[k], s->X) > s->squared_radius) continue;
        if (s->found < s->capacity) s->part[s->found] = k;
        ++s->found;
    }
}

size_t pls_part_tree_near(const pls_part_tree *tree, pls_vec3 X, double radius, uint32_t *part, size_t capacity)
{
    near_search s = {.X = X, .squared_radius = radius * radius, .part = part, .capacity = capacity};
    if (radius >= 0.0) look_near(tree, 0, &s);
    return s.found;
}

typedef struct nearest_search
{
    pls_vec3 X;
    double distance;
    uint32_t part;
} nearest_search;

/// Parts about X may be of any depth, so all of those are asked; of the others only what is nearer than the best.
static void look_nearest(const pls_part_tree *tree, uint32_t index, double squared, nearest_search *s)
{
    const node *n = &tree->node[index];
    if (squared > 0.0 && (s->distance <= 0.0 || squared >= s->distance * s->distance)) return;
    if (n->right)
    {
        double left = squared_distance(&tree->node[index + 1].box, s->X), right = squared_distance(&tree->node[n->right].box, s->X);
        if (left <= right) look_nearest(tree, index + 1, left, s);
        look_nearest(tree, n->right, right, s);
        if (left > right) look_nearest(tree, index + 1, left, s);
        return;
    }
    for (uint32_t k = n->first; k < n->first + n->count; ++k)
    {
        double near = squared_distance(&tree->part_box[k], s->X);
        if (near > 0.0 && (s->distance <= 0.0 || near >= s->distance * s->distance)) continue;
        const pls_shape_part *part = &tree->part[k];
        double value = part->scale * pls_shape_sdf(part->shape, pls_part_from_whole(part, s->X));
        if (value < s->distance) s->distance = value, s->part = k;
    }
}

const pls_shape_part *pls_part_tree_nearest(const pls_part_tree *tree, pls_vec3 X, double *distance)
{
    nearest_search s = {.X = X, .distance = INFINITY};
    look_nearest(tree, 0, squared_distance(&tree->node[0].box, X), &s);
    *distance = s.distance;
    return &tree->part[s.part];
}

// ---- the union ------------------------------------------------------------------------------------------------------------------------------------------------

double pls_union_sdf(const pls_shape *shape, pls_vec3 X)
{
    double distance;
    pls_part_tree_nearest(shape->tree, X, &distance);
    return distance;
}

pls_vec3 pls_union_gradient(const pls_shape *shape, pls_vec3 X)
{
    double distance;
    const pls_shape_part *part = pls_part_tree_nearest(shape->tree, X, &distance);
    return pls_rotate(part->orientation, pls_shape_gradient(part->shape, pls_part_from_whole(part, X)));
}
