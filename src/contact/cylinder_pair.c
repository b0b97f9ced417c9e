// cylinder_pair.c -- a cylinder on a cylinder.
//
// Where rims cross, or a rim meets a side, the deepest point is a matter of all directions and moves smoothly: the penetration depth is the overlap, exact at any depth. Where one
// stands on the other's end, lies along it, or lies across its end, the deepest point jumps over an area or from end to end of a line, and pieces of the surfaces tell of these
// (sampled_touch.c), though not of how deep a rim is to less than a thousandth of the size. So both are asked, and the overlap is
//
//     delta = (1 - s) delta_point + s delta_pieces,
//
// with s a smooth function of the angle between the axes. What pushes is the gradient of that, the couple (delta_pieces - delta_point) ds/d(angle) among it, so that energy is kept
// also while cylinders turn from the one to the other.

#include "contact/cylinder_pair.h"

#include "contact/overlap_laws.h"
#include "contact/sampled_touch.h"
#include "shape/builtin.h"

/// Squared sines of the angles from which pieces count for less than all, and for nothing: 3 and 12 degrees.
static const double all_of_it = 0.0027390523158633, nothing = 0.0432272711786996;

static const double least_spread = 1e-12; ///< of the size squared

bool pls_is_cylinder_pair(const pls_shape *a, const pls_shape *b) { return a->ops == &pls_cylinder_shape && b->ops == &pls_cylinder_shape; }

/// Of the squared sine of an angle; `slope` by it.
static double nearly_none(double u, double *slope)
{
    const double range = nothing - all_of_it, x = fmin(fmax((u - all_of_it) / range, 0.0), 1.0);
    *slope = -6.0 * x * (1.0 - x) / range;
    return 1.0 - x * x * (3.0 - 2.0 * x);
}

double pls_cylinders_lie(const pls_posed *a, const pls_posed *b, double *slope)
{
    const double c = pls_dot(a->z, b->z);
    double along, across;
    const pls_vec3 sine = pls_cross(a->z, b->z);
    const double share = nearly_none(pls_dot(sine, sine), &along) + nearly_none(c * c, &across);
    if (slope) *slope = 2.0 * c * (across - along);
    return share;
}

void pls_cylinders_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options, pls_touch *out)
{
    double slope;
    const double s = pls_cylinders_lie(a, b, &slope), rest = 1.0 - s;
    const pls_vec3 point = pls_scale(pls_add(depth->on_a, depth->on_b), 0.5);
    if (!(s > 0.0)) return; // the point stands
    pls_touch t;
    pls_sampled_touch(a, b, options, &t);
    const bool any = t.delta > 0.0;
    const double by_pieces = any ? t.energy_delta : 0.0;
    // What pushes B, about the deepest point; of pieces by the overlap that has their energy.
    pls_push push = {.force = pls_scale(depth->normal, rest),
                     .torque = pls_scale(pls_cross(b->z, a->z), -(by_pieces - depth->delta) * slope)};
    if (any)
    {
        const pls_vec3 force = pls_scale(t.normal, s * t.delta / t.energy_delta);
        push.force = pls_add(push.force, force);
        push.torque = pls_add(push.torque, pls_add(pls_cross(pls_sub(t.point, point), force), pls_scale(force, t.twist)));
    }
    const double length = pls_length(push.force), delta = rest * depth->delta + s * by_pieces;
    if (!(length > 0.0) || !(delta > 0.0)) // no piece has come so far yet
    {
        out->delta = 0.0;
        return;
    }
    const pls_vec3 middle = any ? pls_scale(pls_sub(t.middle, point), s) : pls_vec(0.0, 0.0, 0.0);
    out->normal = pls_scale(push.force, 1.0 / length);
    out->delta = delta * length, out->energy_delta = delta;
    out->weight = rest + (any ? s * t.weight : 0.0);
    pls_put_on_line(&push, middle, &out->point, &out->twist);
    out->point = pls_add(point, out->point), out->middle = pls_add(point, middle);
    // Never a point, even if pieces have no area: forces do not go through the middle.
    for (int k = 0; k < 6; ++k) out->spread[k] = (any ? s * t.spread[k] : 0.0) + (k < 3 ? least_spread * a->size * a->size : 0.0);
    out->lever = any ? s * t.lever : 0.0;
    out->depth = out->reach = depth->delta;
    out->stands = true;
}
