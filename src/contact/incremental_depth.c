// incremental_depth.c -- distance or depth of a pair, from scratch or from where the last step left it.
//
// Cores that are apart are GJK's, whose last simplex is mostly still the nearest in the next step. Cores that overlap are pushed apart along the
// last normal, by the last depth and a bit: GJK then gives a new normal, and the fixed point of that is a local minimum of F.
//
// Is it the least of all? A ball of radius delta about a point of B, if all in A, proves so: F is at least delta in all directions. So where the SDF of
// A is -delta at B's witness point (or the other way round) no more is asked. That is so for faces away from their edges and all that is rounder than deep. Else the
// expanding polytope decides.

#include "contact/convex.h"

#include <float.h>

enum { MOST_PUSHES = 60 };
static const double push = 0.02;    // beyond the depth, of the smaller size
static const double exact = 1e-13;  // of EPA on polytopes
static const double roughly = 1e-3; // of EPA on smooth sets, to be refined
static const double finely = 1e-9;  // of EPA on smooth sets where there is no proof: of the size,
static const double shallow = 1e-7; // or of the depth, whichever is less; and a ball that proves may be smaller than the depth by so much

static double smaller(const pls_convex *a, const pls_convex *b) { return fmin(a->size, b->size); }

static double open_of(const pls_convex *a, const pls_convex *b, double delta)
{
    const double scale = a->size + b->size;
    return fmin(finely * scale, shallow * fmax(delta, 0.0) + exact * scale);
}

/// Witness points from the weights, exactly delta apart along the normal, then the margins.
static void finish(const pls_convex *a, const pls_convex *b, const pls_simplex *s, pls_depth *d)
{
    pls_vec3 middle = pls_vec(0.0, 0.0, 0.0);
    for (int k = 0; k < s->count; ++k) middle = pls_add(middle, pls_scale(pls_add(s->point[k].a, s->point[k].b), 0.5 * s->weight[k]));
    d->on_a = pls_add(middle, pls_scale(d->normal, 0.5 * d->delta + a->margin));
    d->on_b = pls_sub(middle, pls_scale(d->normal, 0.5 * d->delta + b->margin));
    d->delta += a->margin + b->margin;
}

static void count_in(pls_depth *d, const pls_gap *gap)
{
    d->iterations += gap->iterations;
    d->support_calls += gap->support_calls;
}

/// Cores apart?
static bool gap_of(const pls_convex *a, const pls_convex *b, pls_simplex *s, pls_depth *d)
{
    pls_gap gap = pls_gjk(a, b, pls_vec(0.0, 0.0, 0.0), s);
    count_in(d, &gap);
    if (gap.overlap || gap.open >= gap.distance) return false;
    d->delta = -gap.distance;
    d->normal = pls_scale(gap.v, -1.0 / gap.distance);
    d->converged = gap.converged;
    d->local = false;
    return true;
}

static double depth_along(const pls_convex *a, const pls_convex *b, pls_vec3 n, pls_depth *d)
{
    pls_support_pair p = pls_support_of(a, b, pls_vec(0.0, 0.0, 0.0), n);
    ++d->support_calls;
    return pls_dot(p.w, n);
}

/// On a face of M, the origin above it: a local minimum of F, exactly. `s` becomes that face with weights.
static bool above_face(pls_simplex *s, pls_vec3 n, double delta, int dimension)
{
    if (s->count != dimension) return false;
    bool inside;
    pls_simplex t = *s;
    for (int k = 0; k < t.count; ++k) t.point[k].w = pls_sub(pls_sub(t.point[k].a, t.point[k].b), pls_scale(n, delta));
    pls_simplex_nearest(&t, 3, &inside);
    if (t.count != dimension) return false;
    *s = t;
    return true;
}

/// Depth along n from the witness points.
static double depth_of_witness(const pls_simplex *s, pls_vec3 n)
{
    double delta = 0.0;
    for (int k = 0; k < s->count; ++k) delta += s->weight[k] * pls_dot(n, pls_sub(s->point[k].a, s->point[k].b));
    return delta;
}

/// Fixed point of pushing B along n by the depth and `beyond`, from d->normal and d->delta.
static bool follow(const pls_convex *a, const pls_convex *b, pls_simplex *s, pls_depth *d)
{
    double L = smaller(a, b), beyond = push * L;
    bool polytopes = a->polytope && b->polytope;
    for (int k = 0; k < MOST_PUSHES; ++k)
    {
        pls_gap gap = pls_gjk(a, b, pls_scale(d->normal, d->delta + beyond), s);
        count_in(d, &gap);
        if (gap.overlap)
        {
            d->delta = depth_along(a, b, d->normal, d);
            s->count = 0;
            continue;
        }
        pls_vec3 n = pls_scale(gap.v, -1.0 / gap.distance);
        double delta = depth_of_witness(s, n), turn = pls_length(pls_sub(n, d->normal)), change = fabs(delta - d->delta);
        d->normal = n, d->delta = delta, d->local = true;
        if (!gap.converged) return false;
        if (delta < -PLS_TOUCHING * (a->size + b->size)) return gap_of(a, b, s, d) && d->converged; // F < 0: apart for certain
        if (polytopes && above_face(s, n, delta, a->dimension)) return d->converged = true;
        bool still = turn < 1e-8 || (change < 1e-12 * L && turn < 1e-6); // errors of n count squared
        if (still && (!polytopes || fabs(delta) < PLS_TOUCHING * L)) return d->converged = true;
        beyond = fmin(push * L, fmax(delta, 1e-6 * L)); // less far: further turns, and flatter seen from nearer by smooth sets
    }
    return false;
}

/// No direction has less depth: see above.
static bool is_least(const pls_convex *a, const pls_convex *b, const pls_simplex *s, const pls_depth *d)
{
    if (d->delta <= 0.0) return true;
    double enough = d->delta - open_of(a, b, d->delta);
    pls_vec3 on_a = pls_vec(0.0, 0.0, 0.0), on_b = on_a;
    for (int k = 0; k < s->count; ++k)
    {
        on_a = pls_add(on_a, pls_scale(s->point[k].a, s->weight[k]));
        on_b = pls_add(on_b, pls_scale(s->point[k].b, s->weight[k]));
    }
    return (a->sdf && -a->sdf(a->self, on_b) >= enough) || (b->sdf && -b->sdf(b->self, on_a) >= enough);
}

/// Follow the local minimum from d->normal. False: it was not found, `d` and `s` are as before.
static bool refine(const pls_convex *a, const pls_convex *b, pls_simplex *s, pls_depth *d)
{
    pls_simplex t = {.count = 0};
    pls_depth finer = *d;
    finer.converged = false;
    bool found = follow(a, b, &t, &finer) && finer.delta <= d->delta + open_of(a, b, d->delta);
    if (found)
        *d = finer, *s = t;
    else
        d->iterations = finer.iterations, d->support_calls = finer.support_calls;
    return found;
}

/// Cores that overlap. Polytopes: the expanding polytope is exact. Else it finds the neighbourhood, following goes to the bottom, and where there is no proof the polytope
/// is asked whether some other direction has less.
static void overlap_of(const pls_convex *a, const pls_convex *b, pls_simplex *s, pls_depth *d)
{
    enum { MOST_MINIMA = 12 };
    const double scale = a->size + b->size;
    const bool polytopes = a->polytope && b->polytope;
    pls_depth found = pls_epa(a, b, (polytopes ? exact : roughly) * scale, s);
    found.iterations += d->iterations, found.support_calls += d->support_calls;
    *d = found;
    if (polytopes) return;
    for (int k = 0; k < MOST_MINIMA && refine(a, b, s, d); ++k)
    {
        d->local = false;
        if (d->delta <= 0.0 || is_least(a, b, s, d)) return;
        pls_simplex kept = *s;
        if (!pls_epa_less(a, b, open_of(a, b, d->delta), NULL, d))
        {
            *s = kept;
            return;
        }
    }
    s->count = 0;
    found = pls_epa(a, b, open_of(a, b, d->delta), s);
    found.iterations += d->iterations, found.support_calls += d->support_calls;
    *d = found;
}

static void from_scratch(const pls_convex *a, const pls_convex *b, pls_simplex *s, pls_depth *d)
{
    s->count = 0;
    if (!gap_of(a, b, s, d)) overlap_of(a, b, s, d);
}

pls_depth pls_depth_cold(const pls_convex *a, const pls_convex *b)
{
    pls_depth d = {.converged = false};
    pls_simplex s;
    from_scratch(a, b, &s, &d);
    finish(a, b, &s, &d);
    return d;
}

static pls_vec3 vec_of(const double v[3]) { return pls_vec(v[0], v[1], v[2]); }

static pls_vec3 turn(const pls_convex *c, pls_vec3 v)
{
    return pls_add(pls_add(pls_scale(c->axis[0], v.x), pls_scale(c->axis[1], v.y)), pls_scale(c->axis[2], v.z));
}
static pls_vec3 turn_back(const pls_convex *c, pls_vec3 v)
{
    return pls_vec(pls_dot(c->axis[0], v), pls_dot(c->axis[1], v), pls_dot(c->axis[2], v));
}

static void put(double to[3], pls_vec3 v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }

static void recall(const pls_convex *a, const pls_convex *b, const pls_depth_state *state, pls_simplex *s)
{
    s->count = state->size[0] == a->size && state->size[1] == b->size ? (int)state->count : 0;
    for (int k = 0; k < s->count; ++k)
    {
        s->point[k].a = pls_add(a->centre, turn(a, vec_of(state->point_a[k])));
        s->point[k].b = pls_add(b->centre, turn(b, vec_of(state->point_b[k])));
        s->point[k].stored = k;
    }
}

/// Points that were stored before keep their numbers to the bit: there and back through the frames they would drift.
static void remember(const pls_convex *a, const pls_convex *b, const pls_simplex *s, const pls_depth *d, pls_depth_state *state)
{
    pls_depth_state old = *state;
    *state = (pls_depth_state){.known = 1.0, .delta = d->delta, .size = {a->size, b->size}, .count = s->count < 3 ? s->count : 3};
    put(state->normal, turn_back(a, d->normal));
    for (int k = 0; k < (int)state->count; ++k)
    {
        int from = s->point[k].stored;
        put(state->point_a[k], from >= 0 ? vec_of(old.point_a[from]) : turn_back(a, pls_sub(s->point[k].a, a->centre)));
        put(state->point_b[k], from >= 0 ? vec_of(old.point_b[from]) : turn_back(b, pls_sub(s->point[k].b, b->centre)));
    }
}

/// From the state: a gap stays one, an overlap is followed.
static bool from_state(const pls_convex *a, const pls_convex *b, const pls_depth_state *state, pls_simplex *s, pls_depth *d)
{
    recall(a, b, state, s);
    d->normal = pls_unit(turn(a, vec_of(state->normal)));
    d->delta = state->delta;
    if (d->delta < 0.0)
    {
        pls_vec3 n = d->normal;
        if (gap_of(a, b, s, d)) return d->converged;
        s->count = 0;
        d->normal = n, d->delta = depth_along(a, b, n, d);
    }
    if (!follow(a, b, s, d)) return false;
    d->local = !is_least(a, b, s, d);
    return !d->local;
}

pls_depth pls_depth_warm(const pls_convex *a, const pls_convex *b, pls_depth_state *state)
{
    pls_depth d = {.converged = false};
    pls_simplex s = {.count = 0};
    if (state->known == 0.0 || !from_state(a, b, state, &s, &d)) from_scratch(a, b, &s, &d);
    if (d.converged)
        remember(a, b, &s, &d, state);
    else
        *state = (pls_depth_state){.known = 0.0};
    finish(a, b, &s, &d);
    return d;
}
