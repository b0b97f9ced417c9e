// compound.c -- the union of posed shapes: phi(X) = min over parts. P1's non-convex grains from convex sub-particles (P1 section 4.1).
//
// Outside that is the true distance, inside of overlapping parts it is less deep than the surface. Contact works on the parts, not on phi. A compound of compounds has the
// innermost shapes as its parts. Mass counts overlaps once: parts whose boxes or bounding spheres do not meet are added up exactly, all others are left to the quadrature.

#include "shape/builtin.h"
#include "shape/mass_quadrature.h"
#include "shape/part_tree.h"

#include "base/alloc.h"

#include <string.h>

static const pls_parameter parameters[] = {
    {.name = "parts",
     .unit = "",
     .meaning = "shapes of the scene and where they are in the frame of the compound; they may overlap",
     .initial = PLS_REQUIRED,
     .kind = PLS_PARAMETER_SHAPES},
    {.name = NULL},
};

typedef struct compound
{
    pls_shape **kept; ///< the shapes that were given
    size_t kept_count;
    pls_shape_part *part; ///< without compounds
    size_t part_count;
} compound;

// ---- making ---------------------------------------------------------------------------------------------------------------------------------------------------

static pls_status check_part(const pls_shape_part *part, size_t k, int dimension)
{
    const pls_shape *shape = part->shape;
    if (shape->dimension != dimension)
        return pls_fail(PLS_INVALID_ARGUMENT, "part %zu of a compound is made for %dD, the compound for %dD", k + 1, shape->dimension,
                        dimension);
    if (shape->ops->unbounded || shape->ops->wall)
        return pls_fail(PLS_INVALID_ARGUMENT, "part %zu of a compound is a %s, which has no mass; take shapes that grains may have", k + 1,
                        shape->ops->name);
    if (shape->uneven)
        return pls_fail(
            PLS_INVALID_ARGUMENT,
            "part %zu of a compound has a density of its own, which varies in space; the parts of a compound are all of its material",
            k + 1);
    if (!(part->scale > 0.0) || !isfinite(part->scale))
        return pls_fail(PLS_INVALID_ARGUMENT, "part %zu of a compound has scale %g; it must be positive", k + 1, part->scale);
    const pls_quat *q = &part->orientation;
    double norm = q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z;
    if (!(fabs(norm - 1.0) < 1e-6) || !isfinite(part->position.x + part->position.y + part->position.z))
        return pls_fail(PLS_INVALID_ARGUMENT, "part %zu of a compound has no finite position or no orientation of length one", k + 1);
    if (dimension == 2 && (part->position.z != 0.0 || q->x != 0.0 || q->y != 0.0))
        return pls_fail(PLS_INVALID_ARGUMENT, "part %zu of a compound must lie in the x-y plane in 2D", k + 1);
    return PLS_OK;
}

/// A part of a part, in the frame of the whole.
static pls_shape_part part_of(const pls_shape_part *outer, const pls_shape_part *inner)
{
    return (pls_shape_part){.shape = inner->shape,
                            .position = pls_part_to_whole(outer, inner->position),
                            .orientation = pls_quat_multiply(outer->orientation, inner->orientation),
                            .scale = outer->scale * inner->scale};
}

static void fill_parts(compound *c, const pls_shape_input *input)
{
    size_t next = 0;
    for (size_t k = 0; k < input->part_count; ++k)
    {
        pls_shape_part given = input->parts[k];
        given.orientation = pls_quat_unit(given.orientation);
        if (given.shape->part_count == 0) c->part[next++] = given;
        for (size_t j = 0; j < given.shape->part_count; ++j) c->part[next++] = part_of(&given, &given.shape->part[j]);
    }
}

static void release(void *data)
{
    compound *c = data;
    for (size_t k = 0; k < c->kept_count; ++k) pls_shape_free(c->kept[k]);
    pls_release(&c->kept);
    pls_release(&c->part);
    pls_release(&c);
}

static pls_status keep(compound *c, const pls_shape_input *input)
{
    PLS_TRY(pls_allocate(&c->kept, input->part_count, sizeof *c->kept, "parts of a compound"));
    for (size_t k = 0; k < input->part_count; ++k)
    {
        pls_shape *shape; // to count its users is no change of what it is
        memcpy(&shape, &input->parts[k].shape, sizeof shape);
        c->kept[c->kept_count++] = pls_shape_keep(shape);
        c->part_count += shape->part_count > 0 ? shape->part_count : 1;
    }
    PLS_TRY(pls_allocate(&c->part, c->part_count, sizeof *c->part, "parts of a compound"));
    fill_parts(c, input);
    return PLS_OK;
}

static pls_status prepare(const pls_shape_input *input, int dimension, void **data)
{
    if (input->part_count == 0) return pls_fail(PLS_INVALID_ARGUMENT, "a compound needs at least one part");
    for (size_t k = 0; k < input->part_count; ++k) PLS_TRY(check_part(&input->parts[k], k, dimension));
    compound *c = NULL;
    PLS_TRY(pls_allocate(&c, 1, sizeof *c, "a compound"));
    pls_status status = keep(c, input);
    if (status == PLS_OK)
        *data = c;
    else
        release(c);
    return status;
}

static const pls_shape_part *parts(const pls_shape *shape, size_t *count)
{
    const compound *c = shape->data;
    *count = c->part_count;
    return c->part;
}

// ---- geometry -------------------------------------------------------------------------------------------------------------------------------------------------

static bool is_convex(const pls_shape *shape)
{
    const compound *c = shape->data;
    return c->part_count == 1 && c->part[0].shape->convex;
}

/// The furthest of the parts' furthest points, to which the margin belongs already.
static pls_vec3 support(const pls_shape *shape, pls_vec3 n)
{
    pls_vec3 best = pls_vec(0.0, 0.0, 0.0);
    double most = -INFINITY;
    for (size_t k = 0; k < shape->part_count; ++k)
    {
        const pls_shape_part *part = &shape->part[k];
        pls_vec3 x = pls_part_to_whole(part, pls_shape_support(part->shape, pls_rotate_back(part->orientation, n)));
        double along = pls_dot(x, n);
        if (along > most) most = along, best = x;
    }
    return best;
}

// ---- mass -----------------------------------------------------------------------------------------------------------------------------------------------------

/// Certain that two parts have no volume in common: their bounding spheres or their boxes are apart, or touch.
static bool are_apart(const pls_shape_part *a, const pls_shape_part *b, double size)
{
    pls_vec3 middle_a = pls_part_to_whole(a, a->shape->mass.centre), middle_b = pls_part_to_whole(b, b->shape->mass.centre), low[2], up[2];
    const double touching = 1e-12 * size; // flush faces differ by round-off
    if (pls_length(pls_sub(middle_a, middle_b)) >= a->scale * a->shape->radius + b->scale * b->shape->radius - touching) return true;
    pls_part_box(a, &low[0], &up[0]);
    pls_part_box(b, &low[1], &up[1]);
    const double overlap[3] = {fmin(up[0].x, up[1].x) - fmax(low[0].x, low[1].x), fmin(up[0].y, up[1].y) - fmax(low[0].y, low[1].y),
                               fmin(up[0].z, up[1].z) - fmax(low[0].z, low[1].z)};
    for (int axis = 0; axis < a->shape->dimension; ++axis)
        if (overlap[axis] <= touching) return true;
    return false;
}

static bool all_apart(const pls_shape *shape)
{
    for (size_t j = 1; j < shape->part_count; ++j)
        for (size_t k = 0; k < j; ++k)
            if (!are_apart(&shape->part[j], &shape->part[k], shape->size)) return false;
    return true;
}

/// The tensor of a part, turned into the frame of the whole: columns R (I (R^T e)).
static void turned_inertia(const pls_shape_part *part, double factor, double out[3][3])
{
    const double *t = part->shape->mass.inertia;
    for (int axis = 0; axis < 3; ++axis)
    {
        pls_vec3 e = pls_rotate_back(part->orientation, pls_vec(axis == 0, axis == 1, axis == 2));
        pls_vec3 Ie =
            pls_vec(t[0] * e.x + t[3] * e.y + t[4] * e.z, t[3] * e.x + t[1] * e.y + t[5] * e.z, t[4] * e.x + t[5] * e.y + t[2] * e.z);
        pls_vec3 column = pls_scale(pls_rotate(part->orientation, Ie), factor);
        out[0][axis] = column.x, out[1][axis] = column.y, out[2][axis] = column.z;
    }
}

static double volume_of(const pls_shape_part *part) { return part->shape->mass.volume * pow(part->scale, part->shape->dimension); }

/// Parts side by side: sums, and Steiner's parallel axes.
static void sum_of_parts(const pls_shape *shape, pls_mass_properties *out)
{
    pls_vec3 first = {0.0, 0.0, 0.0};
    *out = (pls_mass_properties){.volume = 0.0};
    for (size_t k = 0; k < shape->part_count; ++k)
    {
        const pls_shape_part *part = &shape->part[k];
        out->volume += volume_of(part);
        first = pls_add(first, pls_scale(pls_part_to_whole(part, part->shape->mass.centre), volume_of(part)));
        out->error = fmax(out->error, part->shape->mass.error);
    }
    out->centre = pls_scale(first, 1.0 / out->volume);
    for (size_t k = 0; k < shape->part_count; ++k)
    {
        const pls_shape_part *part = &shape->part[k];
        double own[3][3], v = volume_of(part);
        pls_vec3 d = pls_sub(pls_part_to_whole(part, part->shape->mass.centre), out->centre);
        turned_inertia(part, pow(part->scale, part->shape->dimension + 2), own);
        out->inertia[2] += own[2][2] + v * (d.x * d.x + d.y * d.y);
        if (shape->dimension == 2) continue;
        out->inertia[0] += own[0][0] + v * (d.y * d.y + d.z * d.z);
        out->inertia[1] += own[1][1] + v * (d.x * d.x + d.z * d.z);
        out->inertia[3] += own[0][1] - v * d.x * d.y;
        out->inertia[4] += own[0][2] - v * d.x * d.z;
        out->inertia[5] += own[1][2] - v * d.y * d.z;
    }
}

static pls_status mass_properties(const pls_shape *shape, pls_mass_properties *out)
{
    if (all_apart(shape))
    {
        sum_of_parts(shape, out);
        return PLS_OK;
    }
    pls_vec3 middle = pls_scale(pls_add(shape->lower, shape->upper), 0.5);
    return pls_mass_by_quadrature(shape, middle, pls_shape_reach(shape, middle) * (1.0 + 1e-9), out);
}

const pls_shape_ops pls_compound_shape = {
    .api_version = PLS_API_VERSION,
    .name = "compound",
    .meaning = "the union of other shapes, each with its place; it need not be convex",
    .parameters = parameters,
    .in_2d = true,
    .in_3d = true,
    .prepare = prepare,
    .release = release,
    .sdf = pls_union_sdf,
    .gradient = pls_union_gradient,
    .is_convex = is_convex,
    .support = support,
    .mass_properties = mass_properties,
    .parts = parts,
};
