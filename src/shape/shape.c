// shape.c -- a shape with its numbers, and what follows from its SDF alone.
//
// Support points. For a true distance, the foot of a far point p + t n is the point of the shape nearest to it; taken again from there, p <- foot(p + t n), it comes
// to the point that lies furthest along n (the proximal point algorithm on -n.x; for polytopes in finitely many steps, else the error shrinks by L/t each time).
// Bounds and the bounding sphere follow. A shape without a foot function has one: X - phi grad phi.

#include <particls/shape.h>

#include "base/alloc.h"
#include "math/principal_axes.h"
#include "shape/mass_quadrature.h"
#include "shape/part_tree.h"
#include "shape/sdf_trial.h"
#include "shape/distance_field.h"
#include "shape/surface_sample.h"
#include "shape/wall_facets.h"

#include <stdio.h>
#include <string.h>

enum {
    SUPPORT_TURNS = 40,   ///< of the search for a support point
    SUPPORT_STRIDES = 60, ///< of each turn
    CLIMBS = 30           ///< of the search for the furthest point
};
static const double difference = 1e-7; ///< step of differences, of the size and the distance
static const double far_away = 20.0;   ///< sizes from which support points are sought
static const double remote = 1e3;      ///< sizes from which shapes that are not convex are seen first
static const double horizon = 1e6;     ///< sizes from where the distance tells the extent of a shape to within size / 2e6

double pls_shape_sdf(const pls_shape *shape, pls_vec3 X) { return shape->ops->sdf(shape, X); }

pls_vec3 pls_shape_gradient(const pls_shape *shape, pls_vec3 X)
{
    if (shape->ops->gradient) return shape->ops->gradient(shape, X);
    // Central differences. Where the curvature of the surface jumps their error is of the order of the step, elsewhere round-off over the step: this one keeps both below
    // 1e-7. Far away phi is smooth over longer distances, and its round-off larger.
    double h = difference * (fabs(shape->ops->sdf(shape, X)) + shape->size);
    pls_vec3 g = pls_vec(0.0, 0.0, 0.0);
    g.x = (shape->ops->sdf(shape, pls_vec(X.x + h, X.y, X.z)) - shape->ops->sdf(shape, pls_vec(X.x - h, X.y, X.z))) / (2.0 * h);
    g.y = (shape->ops->sdf(shape, pls_vec(X.x, X.y + h, X.z)) - shape->ops->sdf(shape, pls_vec(X.x, X.y - h, X.z))) / (2.0 * h);
    if (shape->dimension == 3)
        g.z = (shape->ops->sdf(shape, pls_vec(X.x, X.y, X.z + h)) - shape->ops->sdf(shape, pls_vec(X.x, X.y, X.z - h))) / (2.0 * h);
    return g;
}

pls_vec3 pls_shape_nearest(const pls_shape *shape, pls_vec3 X)
{
    for (int k = 0; k < 4; ++k) // once for a true distance; again for the round-off of differences
    {
        double phi = pls_shape_sdf(shape, X);
        if (fabs(phi) < 1e-15 * shape->size) break;
        X = pls_sub(X, pls_scale(pls_shape_gradient(shape, X), phi));
    }
    return X;
}

/// Where to begin. Of a set that is not convex, the point nearest to one so far away that nothing else counts: from there the climb ends at the highest place or at one
/// as good as that. A little beside the axis, on which all places around it may be as near as each other (a ring's).
static pls_vec3 begin_support(const pls_shape *shape, pls_vec3 n)
{
    if (shape->convex) return pls_vec(0.0, 0.0, 0.0);
    pls_vec3 beside = pls_vec(0.013 * shape->size, 0.029 * shape->size, shape->dimension == 3 ? 0.019 * shape->size : 0.0);
    return pls_shape_nearest(shape, pls_add(beside, pls_scale(n, remote * shape->size)));
}

static pls_vec3 support_from_sdf(const pls_shape *shape, pls_vec3 n)
{
    double t = far_away * shape->size;
    pls_vec3 p = begin_support(shape, n);
    for (int k = 0; k < SUPPORT_TURNS; ++k)
    {
        const double before = pls_dot(n, p);
        pls_vec3 next = pls_shape_nearest(shape, pls_add(p, pls_scale(n, t)));
        pls_vec3 step = pls_sub(next, p);
        p = next;
        // Along a flat side it comes forward by t times the angle only: further steps the same way, longer each time, as long as they lead up.
        for (int m = 0; m < SUPPORT_STRIDES; ++m)
        {
            step = pls_scale(step, 2.0);
            pls_vec3 far = pls_shape_nearest(shape, pls_add(pls_add(p, step), pls_scale(n, t)));
            if (!(pls_dot(n, far) > pls_dot(n, p) + 1e-14 * shape->size)) break;
            p = far;
        }
        if (pls_dot(n, p) - before < 1e-15 * shape->size && k > 0) break; // errors of p across n count squared in the height
    }
    return p;
}

pls_vec3 pls_shape_support(const pls_shape *shape, pls_vec3 n)
{
    if (!shape->ops->support) return support_from_sdf(shape, n);
    pls_vec3 p = shape->ops->support(shape, n);
    return shape->margin > 0.0 ? pls_add(p, pls_scale(n, shape->margin)) : p;
}

// ---- bounds --------------------------------------------------------------------------------------------------------------------------------------------------

static const pls_vec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// How far the shape reaches along e. The distance of a far point t e is t - h(e) + s^2 / 2t or less, s < 2 size being how far beside the axis the furthest point lies.
/// For convex shapes the support point is all; others may have several places that are about as high.
static double extent(const pls_shape *shape, pls_vec3 e)
{
    double along = pls_dot(pls_shape_support(shape, e), e), t = horizon * shape->size;
    if (shape->convex || shape->ops->support) return along;
    return fmax(along, t - shape->ops->sdf(shape, pls_scale(e, t))) + 2.0 * shape->size / horizon;
}

static void find_bounds(pls_shape *shape)
{
    if (shape->ops->bounds)
    {
        shape->ops->bounds(shape, &shape->lower, &shape->upper);
        return;
    }
    double *lower[3] = {&shape->lower.x, &shape->lower.y, &shape->lower.z}, *upper[3] = {&shape->upper.x, &shape->upper.y, &shape->upper.z};
    for (int a = 0; a < shape->dimension; ++a)
    {
        *upper[a] = extent(shape, axes[2 * a]);
        *lower[a] = -extent(shape, axes[2 * a + 1]);
    }
}

/// The furthest of the parts, each sought by itself.
static double reach_of_parts(const pls_shape *shape, pls_vec3 centre)
{
    double radius = 0.0;
    for (size_t k = 0; k < shape->part_count; ++k)
    {
        const pls_shape_part *part = &shape->part[k];
        radius = fmax(radius, part->scale * pls_shape_reach(part->shape, pls_part_from_whole(part, centre)));
    }
    return radius * (1.0 + 1e-14);
}

static double reach_of_polytope(const pls_polytope *p, pls_vec3 centre)
{
    double radius = 0.0;
    for (uint32_t v = 0; v < p->vertex_count; ++v) radius = fmax(radius, pls_length(pls_sub(p->vertex[v], centre)));
    return radius;
}

double pls_shape_reach(const pls_shape *shape, pls_vec3 centre)
{
    double radius = 0.0;
    if (shape->ops->unbounded) return INFINITY;
    if (shape->part_count > 0) return reach_of_parts(shape, centre);
    if (shape->polytope) return (reach_of_polytope(shape->polytope, centre) + shape->margin) * (1.0 + 1e-15);
    // From many directions, climb from support point to support point.
    for (int k = 0; k < 27; ++k)
    {
        pls_vec3 e = pls_vec(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
        if (shape->dimension == 2) e.z = 0.0;
        if (pls_dot(e, e) == 0.0) continue;
        e = pls_unit(e);
        for (int c = 0; c < CLIMBS; ++c)
        {
            pls_vec3 d = pls_sub(pls_shape_support(shape, e), centre);
            double length = pls_length(d);
            if (!(length > radius * (1.0 + 1e-12)) && c > 0) break;
            radius = fmax(radius, length);
            e = pls_scale(d, 1.0 / length);
        }
    }
    return radius * (1.0 + 1e-9);
}

/// Lesser radius of curvature where the normal is n, from the derivative of the support point [m].
static double lesser_curvature_radius(const pls_shape *shape, pls_vec3 n)
{
    double d[6];
    shape->ops->support_gradient(shape, n, d);
    const pls_vec3 e = shape->dimension == 2 ? pls_vec(-n.y, n.x, 0.0)
                                             : pls_unit(pls_cross(n, fabs(n.z) < 0.7 ? pls_vec(0.0, 0.0, 1.0) : pls_vec(1.0, 0.0, 0.0)));
    const pls_vec3 f = pls_cross(n, e);
    const pls_vec3 He =
        pls_vec(d[0] * e.x + d[3] * e.y + d[4] * e.z, d[3] * e.x + d[1] * e.y + d[5] * e.z, d[4] * e.x + d[5] * e.y + d[2] * e.z);
    const pls_vec3 Hf =
        pls_vec(d[0] * f.x + d[3] * f.y + d[4] * f.z, d[3] * f.x + d[1] * f.y + d[5] * f.z, d[4] * f.x + d[5] * f.y + d[2] * f.z);
    const double ee = pls_dot(e, He), ef = pls_dot(e, Hf), ff = pls_dot(f, Hf);
    if (shape->dimension == 2) return ee;
    return 0.5 * (ee + ff) - hypot(0.5 * (ee - ff), ef);
}

/// By Blaschke's theorem a ball as large as the least radius of curvature rolls freely inside. That is looked for along many normals, and half of it taken; what is added
/// by a margin is certain.
static double inner_radius_of(const pls_shape *shape)
{
    enum { NORMALS = 2000 };
    static const double golden_angle = 2.3999632297286533;
    if (!shape->convex || !shape->ops->smooth || !shape->ops->support_gradient) return shape->convex ? shape->margin : 0.0;
    double least = INFINITY;
    for (int k = 0; k < NORMALS; ++k)
    {
        const double angle = golden_angle * k, z = shape->dimension == 2 ? 0.0 : (2.0 * k + 1.0) / NORMALS - 1.0, r = sqrt(1.0 - z * z);
        least = fmin(least, lesser_curvature_radius(shape, pls_vec(r * cos(angle), r * sin(angle), z)));
    }
    return shape->margin + fmax(0.0, 0.5 * least);
}

// ---- parts ----------------------------------------------------------------------------------------------------------------------------------------------------

/// The list that the shape's operations give, in the order of the tree over it.
static pls_status take_parts(pls_shape *shape)
{
    size_t count = 0;
    const pls_shape_part *given = shape->ops->parts(shape, &count);
    pls_shape_part *part = NULL;
    if (count == 0) return PLS_OK;
    PLS_TRY(pls_allocate(&part, count, sizeof *part, "parts of a shape"));
    memcpy(part, given, count * sizeof *part);
    pls_status status = pls_part_tree_make(part, count, &shape->tree);
    if (status != PLS_OK)
    {
        pls_release(&part);
        return status;
    }
    shape->part = part;
    shape->part_count = count;
    return PLS_OK;
}

static void release_parts(pls_shape *shape)
{
    void *block;
    memcpy(&block, &shape->part, sizeof block); // it is ours to free, though nobody's to change
    pls_release(&block);
    pls_part_tree_free(shape->tree);
}

size_t pls_shape_parts_near(const pls_shape *shape, pls_vec3 X, double radius, uint32_t *part, size_t capacity)
{
    return shape->tree ? pls_part_tree_near(shape->tree, X, radius, part, capacity) : 0;
}

// ---- making one -----------------------------------------------------------------------------------------------------------------------------------------

/// Put the name in front of what a shape's own functions say, who do not know it.
static pls_status named(pls_status status, const char *name)
{
    return status == PLS_OUT_OF_MEMORY ? status : pls_fail_context(status, "%s: ", name);
}

/// Principal axes and moments of the inertia tensor.
static void find_principal(pls_shape *shape)
{
    const double *t = shape->mass.inertia;
    shape->principal = pls_quat_identity();
    if (shape->dimension == 2)
    {
        shape->moments = pls_vec(0.0, 0.0, t[2]);
        return;
    }
    double size = t[0] + t[1] + t[2], beside = fmax(fabs(t[3]), fmax(fabs(t[4]), fabs(t[5])));
    if (beside <= 1e-12 * size + 2.0 * shape->mass.error * size) // its axes are principal ones
    {
        shape->moments = pls_vec(t[0], t[1], t[2]);
        return;
    }
    double value[3];
    pls_principal_axes(t, value, &shape->principal);
    shape->moments = pls_vec(value[0], value[1], value[2]);
}

/// As if the density were 1: exactly, or by quadrature.
static pls_status measure_even_mass(const pls_shape *shape, const char *name, const pls_sdf_least *least, pls_mass_properties *out)
{
    if (shape->ops->mass_properties) return named(shape->ops->mass_properties(shape, out), name);
    const pls_vec3 middle = pls_scale(pls_add(shape->lower, shape->upper), 0.5);
    const pls_status status = pls_mass_by_quadrature(shape, middle, pls_shape_reach(shape, middle), out);
    if (status == PLS_INVALID_ARGUMENT && !(least->phi < 0.0)) return pls_sdf_no_inside(name, least);
    return named(status, name);
}

/// A density that varies is for the quadrature, unless the shape's own exact mass is by it.
static pls_status measure_uneven_mass(pls_shape *shape, const char *name)
{
    const bool exact = shape->ops->mass_properties && shape->ops->density && !shape->density;
    const pls_vec3 middle = pls_scale(pls_add(shape->lower, shape->upper), 0.5);
    const double reach = pls_shape_reach(shape, middle) * (1.0 + 1e-9);
    if (exact)
    {
        pls_mass_properties even;
        PLS_TRY(named(pls_mass_by_quadrature(shape, middle, reach, &even), name));
        shape->volume = even.volume;
        return PLS_OK;
    }
    return named(pls_uneven_mass_by_quadrature(shape, middle, reach, &shape->mass), name);
}

/// Volume, centre of mass, principal frame; the bounding sphere is about that centre.
static pls_status measure_mass(pls_shape *shape, const char *name, const pls_sdf_least *least)
{
    const pls_shape_ops *ops = shape->ops;
    PLS_TRY(measure_even_mass(shape, name, least, &shape->mass));
    shape->volume = shape->mass.volume;
    if (shape->uneven) PLS_TRY(measure_uneven_mass(shape, name));
    const bool moved = shape->uneven || !ops->bounding_radius; // the shape's own sphere is about the centre of even mass
    shape->radius = moved ? pls_shape_reach(shape, shape->mass.centre) : ops->bounding_radius(shape);
    if (!(shape->radius > 0.0) || !isfinite(shape->radius) || !(shape->mass.volume > 0.0) || !isfinite(shape->mass.volume))
        return pls_fail(PLS_INVALID_ARGUMENT, "%s has radius %g m and volume %g; both must be positive and finite", name, shape->radius,
                        shape->mass.volume);
    double phi = pls_shape_sdf(shape, shape->mass.centre);
    if (shape->convex && !(phi < 0.0))
        return pls_fail(PLS_INVALID_ARGUMENT, "the SDF of %s is %g m at its centre of mass, (%g, %g, %g) m; inside it must be negative",
                        name, phi, shape->mass.centre.x, shape->mass.centre.y, shape->mass.centre.z);
    find_principal(shape);
    return PLS_OK;
}

static pls_status measure(pls_shape *shape, const char *name)
{
    const pls_shape_ops *ops = shape->ops;
    shape->convex = ops->convex || (ops->is_convex && ops->is_convex(shape));
    shape->margin = ops->margin ? ops->margin(shape) : 0.0;
    shape->polytope = ops->polytope ? ops->polytope(shape) : NULL;
    if ((ops->unbounded || ops->wall) && shape->density)
        return pls_fail(PLS_INVALID_ARGUMENT, "%s: a %s has no mass, and so no density", name, ops->name);
    if (ops->unbounded) return PLS_OK;
    if (ops->parts) PLS_TRY(take_parts(shape));
    pls_sdf_least least;
    PLS_TRY(pls_sdf_guess_size(shape, name));
    find_bounds(shape);
    PLS_TRY(pls_sdf_try(shape, name, &least));
    shape->inner_radius = inner_radius_of(shape);
    if (!ops->wall)
    {
        PLS_TRY(measure_mass(shape, name, &least));
        const bool values_alone = shape->convex && !ops->support && !shape->polytope;
        return shape->convex && !values_alone ? PLS_OK : pls_shape_need_sample(shape);
    }
    shape->moments = pls_vec(0.0, 0.0, 0.0); // the frame of a wall is that in which it is given
    shape->radius = ops->bounding_radius ? ops->bounding_radius(shape) : pls_shape_reach(shape, shape->mass.centre);
    pls_wall_find_reach(shape);
    return PLS_OK;
}

static pls_status check_ops(const pls_shape_ops *ops, int dimension, const char *name)
{
    if (!ops || !ops->name || !ops->parameters || !ops->sdf)
        return pls_fail(PLS_INVALID_ARGUMENT, "%s lacks one of name, parameters, sdf", name);
    if (ops->api_version != PLS_API_VERSION)
        return pls_fail(PLS_VERSION, "%s is made for API %u, this library has %d: compile it anew", name, ops->api_version,
                        PLS_API_VERSION);
    if (!(dimension == 2 ? ops->in_2d : ops->in_3d))
        return pls_fail(PLS_INVALID_ARGUMENT, "%s: a %s cannot be used in %dD", name, ops->name, dimension);
    if (pls_parameter_values(ops->parameters) > 3 * PLS_MAX_PARAMETERS)
        return pls_fail(PLS_LIMIT_EXCEEDED, "%s has more than %d values", name, 3 * PLS_MAX_PARAMETERS);
    return PLS_OK;
}

/// A shape and its numbers in one block.
typedef struct shape_with_values
{
    pls_shape shape;
    double values[3 * PLS_MAX_PARAMETERS];
} shape_with_values;

/// "half (3), epsilon1, epsilon2, rounding"
static void list_numbers(const pls_parameter *table, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (const pls_parameter *row = table; row->name && used < size; ++row)
    {
        if (row->kind != PLS_PARAMETER_NUMBER) continue;
        int more = snprintf(text + used, size - used, row->components > 1 ? "%s%s (%d)" : "%s%s", used > 0 ? ", " : "", row->name,
                            row->components);
        used += more > 0 ? (size_t)more : 0;
    }
}

static pls_status take_values(const pls_shape_ops *ops, const pls_shape_input *input, const char *name, double *values)
{
    const size_t count = (size_t)pls_parameter_values(ops->parameters);
    if (!input->values || count == 0)
        pls_parameters_default(ops->parameters, values);
    else if (input->value_count >= count)
        memcpy(values, input->values, count * sizeof *values);
    else
    {
        char numbers[256];
        list_numbers(ops->parameters, numbers, sizeof numbers);
        return pls_fail(PLS_INVALID_ARGUMENT, "%s: a %s takes %zu values, in this order: %s; `value_count` says that there are %zu", name,
                        ops->name, count, numbers, input->value_count);
    }
    return pls_parameters_check(ops->parameters, values, name);
}

static pls_status fill(shape_with_values *block, const pls_shape_input *input, const char *name)
{
    pls_shape *shape = &block->shape;
    const pls_shape_ops *ops = shape->ops;
    PLS_TRY(take_values(ops, input, name, block->values));
    pls_shape_input mine = *input;
    mine.values = shape->values;
    mine.value_count = (size_t)pls_parameter_values(ops->parameters);
    if (ops->prepare) PLS_TRY(named(ops->prepare(&mine, shape->dimension, &shape->data), name));
    shape->density = input->density;
    shape->uneven = ops->density || input->density;
    const pls_status status = measure(shape, name);
    shape->density = NULL;
    return status;
}

pls_status pls_shape_make(const pls_shape_ops *ops, int dimension, const pls_shape_input *input, const char *name, pls_shape **out)
{
    *out = NULL;
    PLS_TRY(check_ops(ops, dimension, name));
    shape_with_values *block = NULL;
    PLS_TRY(pls_allocate(&block, 1, sizeof *block, "a shape"));
    block->shape = (pls_shape){.ops = ops,
                               .users = 1,
                               .dimension = dimension,
                               .values = block->values,
                               .radius = INFINITY,
                               .size = INFINITY,
                               .principal = pls_quat_identity()};
    pls_status status = fill(block, input, name);
    if (status != PLS_OK)
        pls_shape_free(&block->shape);
    else
        *out = &block->shape;
    return status;
}

pls_shape *pls_shape_keep(pls_shape *shape)
{
    ++shape->users;
    return shape;
}

void pls_shape_free(pls_shape *shape)
{
    if (!shape || --shape->users > 0) return;
    release_parts(shape);
    pls_surface_sample_free(shape->sample);
    pls_distance_field_free(shape->field);
    if (shape->ops->release && shape->data) shape->ops->release(shape->data);
    pls_release(&shape);
}
