// overlap_laws.c -- force, couple and area of touch from integrals over an overlap; faces.c tells why these laws.

#include "contact/overlap_laws.h"

#include "contact/touch_area.h"

void pls_put_on_line(const pls_push *p, pls_vec3 middle, pls_vec3 *point, double *twist)
{
    const double square = pls_dot(p->force, p->force);
    const pls_vec3 torque = pls_sub(p->torque, pls_cross(middle, p->force));
    *point = pls_add(middle, pls_scale(pls_cross(p->force, torque), 1.0 / square));
    *twist = pls_dot(torque, p->force) / square;
}

/// Thickness is small, so that it does not matter that the moments are those of the body, not of its shadow.
static void take_spread(const pls_overlap_integrals *P, bool flat, double spread[6])
{
    const double V = P->volume;
    const pls_vec3 c = pls_scale(P->first, 1.0 / V);
    const double middle[6] = {c.x * c.x, c.y * c.y, c.z * c.z, c.x * c.y, c.x * c.z, c.y * c.z};
    for (int k = 0; k < 6; ++k) spread[k] = flat && (k == 2 || k > 3) ? 0.0 : P->second[k] / V - middle[k];
    for (int k = 0; P->line && k < 3; ++k) spread[k] = fmax(spread[k], 0.0);
}

/// The middle of A's surface in B, in the plane of touch through the point of the normal force. That point wanders as faces tilt: at overlaps far below the size by more than
/// the size per radian. Friction that wandered along would turn bodies about the normal by what makes them roll, and take from its load what it gives: a box at rest on a
/// slope would begin to waggle and walk down. The middle of an area is a matter of its outline.
static pls_vec3 middle_of_area(const pls_overlap_integrals *P, const pls_touch *t)
{
    const pls_vec3 area = P->area;
    if (P->scattered) return pls_in_plane_of_touch(t, pls_scale(P->area_moment, 1.0 / P->surface));
    const double square = pls_dot(area, area);
    if (!(square > 0.0)) return t->point;
    return pls_in_plane_of_touch(t, pls_scale(pls_cross(area, P->area_moment), 1.0 / square));
}

/// Right for evenly pressed lines and discs, whose mean distance from the middle it is (of discs 2/3 of their radius), and to half a percent for squares.
static double lever_of(const pls_touch *t, bool line)
{
    const double *s = t->spread, all = s[0] + s[1] + s[2];
    if (line) return PLS_ARM_OF_LINE * sqrt(all);
    return PLS_ARM_OF_DISC * sqrt(fmax(all - pls_dot(t->normal, pls_second_along(s, t->normal)), 0.0));
}

/// Energy kn W / A0.
static void volume_law(const pls_overlap_integrals *P, double A0, pls_touch *out)
{
    const pls_push *w = &P->by_depth;
    const double length = pls_length(w->force);
    out->normal = pls_scale(w->force, 1.0 / length);
    out->delta = length / A0;
    out->weight = fabs(pls_dot(P->area, out->normal)) / A0;
    out->energy_delta = sqrt(2.0 * w->energy / A0);
    pls_put_on_line(w, pls_scale(P->first, 1.0 / P->volume), &out->point, &out->twist);
}

/// Energy kn delta^2 / 2, delta = 3 Q / 2 W.
static void manifold_law(const pls_overlap_integrals *P, pls_touch *out)
{
    const pls_push *W = &P->by_depth, *Q = &P->by_its_square;
    const double V = P->volume, delta = 1.5 * Q->energy / W->energy;
    pls_push slope = {.force = pls_scale(pls_sub(pls_scale(Q->force, 1.5), pls_scale(W->force, delta)), 1.0 / W->energy),
                      .torque = pls_scale(pls_sub(pls_scale(Q->torque, 1.5), pls_scale(W->torque, delta)), 1.0 / W->energy)};
    const double length = pls_length(slope.force);
    out->normal = pls_scale(slope.force, 1.0 / length);
    out->delta = delta * length;
    out->energy_delta = delta;
    // d2(delta^2/2) as the overlap grows deeper over a fixed area: by integrals of t^0, t and t^2 over it; 1 for parallel faces, 9/16 at an edge.
    const double squares = 2.0 * W->energy, area = P->line ? P->surface : fabs(pls_dot(P->area, out->normal));
    const double a = delta * V / squares, b = delta * delta * area / squares;
    out->weight = fmax(9.0 - 18.0 * a + 12.0 * a * a - 2.0 * b, 0.0);
    pls_put_on_line(&slope, pls_scale(P->first, 1.0 / V), &out->point, &out->twist);
}

/// In 2D the overlap is a slab about the plane z = 0: what cancels between its two sides leaves rounding errors, which would push bodies out of the plane.
static void flatten(pls_overlap_integrals *P)
{
    pls_push *both[2] = {&P->by_depth, &P->by_its_square};
    for (int k = 0; k < 2; ++k) both[k]->force.z = both[k]->torque.x = both[k]->torque.y = 0.0;
    P->first.z = 0.0;
}

bool pls_overlap_touch(pls_overlap_integrals *P, const pls_narrow_options *options, double blur, bool flat, pls_touch *out)
{
    // Slivers that blur makes where sides only just do not overlap.
    if (!(P->volume > 100.0 * blur * P->surface) || !(P->by_depth.energy > 0.0)) return false;
    if (options->faces == PLS_FACES_MANIFOLD && !(P->by_its_square.energy > 0.0)) return false;
    if (flat) flatten(P);
    if (options->faces == PLS_FACES_VOLUME)
        volume_law(P, options->face_area, out);
    else
        manifold_law(P, out);
    take_spread(P, flat, out->spread);
    out->lever = flat ? 0.0 : lever_of(out, P->line);
    out->middle = flat ? out->point : middle_of_area(P, out);
    return isfinite(out->delta) && out->delta > 0.0;
}

void pls_overlap_none(const pls_depth *depth, pls_touch *out)
{
    const pls_vec3 point = pls_scale(pls_add(depth->on_a, depth->on_b), 0.5);
    *out = (pls_touch){.delta = fmin(depth->delta, 0.0),
                       .normal = depth->normal,
                       .point = point,
                       .middle = point,
                       .weight = 0.0,
                       .energy_delta = 0.0,
                       .depth = depth->delta,
                       .reach = depth->delta};
}
