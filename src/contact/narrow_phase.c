// narrow_phase.c -- which solver serves a pair of shapes, and what to do when it does not converge.
//
// Shapes are of seven kinds (`kind`), pairs of kinds have a solver each (`table`). All solve one problem: with support functions h the overlap along n is
// F(n) = h_A(n) + h_B(-n); the penetration depth is its least value over unit n, and in a gap minus the distance. They differ in what they need:
//
//   ball on anything     one SDF call: F is least where B's surface is nearest to the ball's centre; of many faces: as polytopes
//   anything on a plane  one support point
//   two polytopes        a surface about the origin carried from step to step (polytope_depth.c)
//   other supports       Newton on what the features that touched leave open (feature_depth.c); when others do, GJK on shapes pushed apart, warm (incremental_depth.c); the
//                        expanding polytope when cold, deep, or GJK stalls
//   smooth on smooth     Newton on the sphere of normals (smooth_depth.c); when it stalls, BFGS; then the expanding polytope
//   SDFs alone           BFGS on one point between the surfaces; its last digits, and what it cannot do, on the shapes pushed apart (sdf_depth.c); then the expanding polytope
//                        on support points that follow from the SDF. Warm on the shapes pushed apart at once
//   not convex           pieces of the surfaces (sampled_touch.c), and so are flat places that only an SDF knows of or that are those of a superquadric, and two cylinders. For PLS_FACES_POINT BFGS from the deepest of a grid of points
//                        in the overlap of the bounding boxes: a place where the two surfaces face each other, so `delta` is right for that place; that no other place is
//                        deeper is only as certain as the grid is fine
//
// A warm start that fails is tried cold (`restarts`), a solver that does not converge gives over to the next (`fallbacks`), and when none converges the least F found
// is taken, which never is less than the depth (`failures`).

#include "contact/narrow_phase.h"

#include "contact/admm.h"
#include "contact/convex.h"
#include "contact/cylinder_pair.h"
#include "contact/cylinder_touch.h"
#include "contact/faces.h"
#include "contact/feature_depth.h"
#include "contact/lines.h"
#include "contact/overlap_laws.h"
#include "contact/polytope_depth.h"
#include "contact/sampled_touch.h"
#include "contact/sdf_depth.h"
#include "contact/wall_touch.h"

#include <string.h>

/// What a pair remembers, as places in its state.
enum {
    WINNER = 0, ///< enum winner
    NORMAL = 1, ///< in A's frame, 3
    DELTA = 4,  ///< [m]
    OWN = 5,    ///< what the winner needs: `pls_depth_state` from its `size`, the memory of `pls_polytope_depth`, or `pls_sdf_state`
    FEATURES = PLS_PAIR_STATE - PLS_FEATURE_MEMORY, ///< of `pls_feature_depth`, beside what INCREMENTAL needs
    ADMM = 8                                        ///< 24, for that solver alone
};
enum winner { NOTHING, INCREMENTAL, POLYTOPES, NEWTON, BFGS, PUSHED, EXPANDING, NEWTON_ON_FEATURES };
_Static_assert(FEATURES * sizeof(double) >= sizeof(pls_depth_state), "two memories overlap");

static const double far_apart = PLS_NARROW_FAR; ///< of the smaller radius: gap from which there is no need to know it

static const double rounding = 1e-13; ///< of the smaller radius, of distances
static const double near = 1e-6;  ///< of the smaller radius: what is found from a depth that is right to some digits is no other minimum
static const double proof = 1e-7; ///< of the depth: by how much a ball that proves it may be too small

typedef struct query
{
    const pls_posed *a, *b;
    double *state; ///< PLS_PAIR_STATE
    pls_narrow_counts *counts;
} query;

typedef pls_depth solver(const query *q);

// ---- shapes as convex sets -------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 core_support(const void *self, pls_vec3 n)
{
    const pls_posed *p = self;
    return pls_posed_world(p, p->shape->ops->support(p->shape, pls_posed_turn_back(p, n)));
}

static double core_sdf(const void *self, pls_vec3 X)
{
    const pls_posed *p = self;
    return pls_posed_sdf(p, X) + p->shape->margin * p->scale;
}

static pls_vec3 support_from_sdf(const void *self, pls_vec3 n) { return pls_posed_support(self, pls_unit(n)); }

static pls_vec3 centre_of(const pls_posed *p) { return pls_posed_world(p, p->shape->mass.centre); }

static pls_convex convex_of(const pls_posed *p)
{
    const bool alone = !p->shape->ops->support;
    return (pls_convex){.support = alone ? support_from_sdf : core_support,
                        .sdf = alone ? NULL : core_sdf,
                        .self = p,
                        .centre = centre_of(p),
                        .axis = {p->x, p->y, p->z},
                        .size = 2.0 * p->size,
                        .margin = alone ? 0.0 : p->shape->margin * p->scale,
                        .polytope = p->shape->polytope != NULL,
                        .dimension = p->shape->dimension};
}

static pls_vec3 unit_or_x(pls_vec3 d)
{
    double length = pls_length(d);
    return length > 0.0 ? pls_scale(d, 1.0 / length) : pls_vec(1.0, 0.0, 0.0);
}

static pls_vec3 line_of_centres(const query *q) { return unit_or_x(pls_sub(centre_of(q->b), centre_of(q->a))); }

// ---- the state --------------------------------------------------------------------------------------------------------------------------------------------------

static enum winner last_winner(const query *q) { return (enum winner)q->state[WINNER]; }

static pls_vec3 recalled_normal(const query *q)
{
    const double *n = q->state + NORMAL;
    return pls_unit(pls_posed_turn(q->a, pls_vec(n[0], n[1], n[2])));
}

static void remember(const query *q, enum winner winner, const pls_depth *d)
{
    pls_vec3 n = pls_posed_turn_back(q->a, d->normal);
    q->state[WINNER] = winner;
    q->state[NORMAL] = n.x, q->state[NORMAL + 1] = n.y, q->state[NORMAL + 2] = n.z;
    q->state[DELTA] = d->delta;
}

static void forget(const query *q) { memset(q->state, 0, PLS_PAIR_STATE * sizeof *q->state); }

static void count(const query *q, int iterations, const pls_depth *d)
{
    q->counts->iterations += (uint64_t)iterations;
    q->counts->failures += !d->converged;
}

static pls_depth depth_of(const pls_overlap *o)
{
    return (pls_depth){
        .delta = o->delta, .normal = o->normal, .on_a = o->on_a, .on_b = o->on_b, .iterations = o->iterations, .converged = o->converged};
}

/// By far apart along the last normal: then that is all there is to know.
static bool is_far(const query *q, pls_depth *out)
{
    if (last_winner(q) == NOTHING) return false;
    pls_vec3 n = recalled_normal(q), a = pls_posed_support(q->a, n), b = pls_posed_support(q->b, pls_scale(n, -1.0));
    double F = pls_dot(n, pls_sub(a, b));
    if (!(F < -far_apart * fmin(q->a->size, q->b->size))) return false;
    *out = (pls_depth){.delta = F, .normal = n, .on_a = a, .on_b = b, .converged = true};
    return true;
}

// ---- closed forms -----------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 ball_centre(const pls_posed *p) { return pls_posed_world(p, p->shape->polytope->vertex[0]); }
static double ball_radius(const pls_posed *p) { return p->shape->margin * p->scale; }

static pls_depth ball_ball(const query *q)
{
    pls_vec3 a = ball_centre(q->a), b = ball_centre(q->b), d = pls_sub(b, a), n = unit_or_x(d);
    double ra = ball_radius(q->a), rb = ball_radius(q->b);
    return (pls_depth){.delta = ra + rb - pls_length(d),
                       .normal = n,
                       .on_a = pls_add(a, pls_scale(n, ra)),
                       .on_b = pls_sub(b, pls_scale(n, rb)),
                       .converged = true};
}

/// Exact for a centre outside of B; inside as exact as the SDF is there. On a ridge of the SDF, where its gradient may be anything up to nothing: away from B's centre.
static pls_depth ball_any(const query *q)
{
    pls_vec3 c = ball_centre(q->a), g = pls_posed_gradient(q->b, c);
    double phi = pls_posed_sdf(q->b, c), length = pls_length(g), radius = ball_radius(q->a);
    pls_vec3 n = length > 0.5 ? pls_scale(g, -1.0 / length) : unit_or_x(pls_sub(centre_of(q->b), c));
    return (pls_depth){.delta = radius - phi,
                       .normal = n,
                       .on_a = pls_add(c, pls_scale(n, radius)),
                       .on_b = pls_add(c, pls_scale(n, phi)),
                       .converged = true};
}

static pls_depth any_ball(const query *q)
{
    const query swapped = {q->b, q->a, q->state, q->counts};
    pls_depth d = ball_any(&swapped), out = d;
    out.normal = pls_scale(d.normal, -1.0);
    out.on_a = d.on_b, out.on_b = d.on_a;
    return out;
}

/// For shapes that are not convex the support point comes from the SDF at a distance, and the depth is right to 2.5 % of the size.
static pls_depth on_plane(const query *q)
{
    pls_vec3 up = q->b->shape->dimension == 2 ? q->b->y : q->b->z, n = pls_scale(up, -1.0), a = pls_posed_support(q->a, n);
    double height = pls_dot(up, pls_sub(a, q->b->position));
    return (pls_depth){.delta = -height, .normal = n, .on_a = a, .on_b = pls_sub(a, pls_scale(up, height)), .converged = true};
}

// ---- iterations -------------------------------------------------------------------------------------------------------------------------------------------------

static pls_depth expand(const query *q)
{
    const pls_convex a = convex_of(q->a), b = convex_of(q->b);
    pls_depth d = pls_depth_cold(&a, &b);
    count(q, d.iterations, &d);
    if (d.converged)
        remember(q, EXPANDING, &d);
    else
        forget(q);
    return d;
}

static pls_depth incremental(const query *q);

static pls_depth polytopes(const query *q)
{
    pls_depth d;
    if (last_winner(q) != POLYTOPES) forget(q);
    if (pls_polytope_depth(q->a, q->b, q->state + OWN, &d))
    {
        q->state[WINNER] = POLYTOPES;
        count(q, d.iterations, &d);
        return d;
    }
    ++q->counts->fallbacks;
    forget(q);
    return incremental(q);
}

/// The SDF of a polytope tries all its faces; when there are many, the corners near the ball are found faster.
static bool has_many_faces(const pls_polytope *p) { return p->face_count > 12 && p->neighbour_start; }

static pls_depth ball_polytope(const query *q) { return has_many_faces(q->b->shape->polytope) ? polytopes(q) : ball_any(q); }
static pls_depth polytope_ball(const query *q) { return has_many_faces(q->a->shape->polytope) ? polytopes(q) : any_ball(q); }

/// By incremental depth, from what the last step left.
static pls_depth warm_depth(const query *q)
{
    pls_depth d;
    const pls_convex a = convex_of(q->a), b = convex_of(q->b);
    pls_depth_state own;
    memcpy(&own, q->state, sizeof own);
    d = pls_depth_warm(&a, &b, &own);
    memcpy(q->state, &own, sizeof own);
    return d;
}

static pls_depth incremental(const query *q)
{
    pls_depth d;
    if (is_far(q, &d)) return d;
    d = warm_depth(q);
    count(q, d.iterations, &d);
    return d;
}

static bool is_least(const query *q, const pls_depth *d);

/// Of the cores.
static bool near_by_features(const void *self, pls_vec3 n, pls_depth *d)
{
    const query *q = self;
    double memory[PLS_FEATURE_MEMORY] = {0.0};
    if (!pls_feature_depth(q->a, q->b, n, PLS_FEATURES_NOW, memory, d)) return false;
    d->delta -= q->a->shape->margin * q->a->scale + q->b->shape->margin * q->b->scale;
    return true;
}

/// Minima that differ by less than GJK's last digits, or that the expanding polytope gave no certain answer about: is another one less?
static void ask_again(const query *q, pls_depth *d)
{
    enum { MOST_MINIMA = 12 };
    const pls_convex a = convex_of(q->a), b = convex_of(q->b);
    const pls_exact_depth exact = {near_by_features, q};
    for (int k = 0; k < MOST_MINIMA; ++k)
    {
        double memory[PLS_FEATURE_MEMORY] = {0.0};
        pls_depth other = *d, finer;
        other.delta -= a.margin + b.margin;
        const bool less = pls_epa_less(&a, &b, rounding * (a.size + b.size) + proof * other.delta, &exact, &other);
        d->converged = !less && other.converged;
        if (!less || !pls_feature_depth(q->a, q->b, other.normal, PLS_FEATURES_NOW, memory, &finer) || !(finer.delta < d->delta)) return;
        finer.iterations += d->iterations;
        *d = finer;
    }
}

/// Where something round is as good as flat its support point runs away under a normal that turns by round-off; distances outside are certain. Not for two polytopes, which nothing is gained for.
static bool by_values(const query *q, const pls_depth *d, pls_depth *finer)
{
    pls_sdf_state own = {.x = {0.0, 0.0, 0.0}};
    pls_overlap o;
    if (!(q->a->shape->ops->smooth || q->b->shape->ops->smooth)) return false;
    pls_sdf_depth_pushed(q->a, q->b, d->normal, d->delta, pls_scale(pls_add(d->on_a, d->on_b), 0.5), &own, &o);
    *finer = depth_of(&o);
    return o.converged;
}

/// The last digits: GJK and the expanding polytope only come near to what is round. Of cores apart any minimum is the distance; of others it has to be the one that was found.
static void polish(const query *q, pls_depth *d)
{
    pls_depth finer;
    const double size = fmin(q->a->size, q->b->size);
    if (!pls_feature_depth(q->a, q->b, d->normal, PLS_FEATURES_NOW, q->state + FEATURES, &finer) && !by_values(q, d, &finer)) return;
    const bool apart = finer.delta < q->a->shape->margin * q->a->scale + q->b->shape->margin * q->b->scale;
    if (!apart && !(fabs(finer.delta - d->delta) < near * size)) return;
    finer.iterations += d->iterations;
    finer.converged = apart || d->converged;
    if (!apart && (!d->converged || d->local || finer.delta - d->delta > proof * d->delta + rounding * size)) ask_again(q, &finer);
    *d = finer;
}

/// The same features as in the last step, mostly.
static pls_depth by_features(const query *q)
{
    pls_depth d;
    const enum winner winner = last_winner(q);
    if (winner != NOTHING && is_far(q, &d)) return d;
    if (winner == INCREMENTAL || winner == NEWTON_ON_FEATURES)
    {
        const bool found = pls_feature_depth(q->a, q->b, recalled_normal(q), PLS_FEATURES_LAST_STEP, q->state + FEATURES, &d);
        if (found && is_least(q, &d))
        {
            count(q, d.iterations, &d);
            remember(q, NEWTON_ON_FEATURES, &d);
            q->state[DELTA] -=
                q->a->shape->margin * q->a->scale + q->b->shape->margin * q->b->scale; // of the cores: what INCREMENTAL would go on from
            return d;
        }
        memset(q->state + FEATURES, 0, PLS_FEATURE_MEMORY * sizeof *q->state);
        q->state[WINNER] = found ? NOTHING : INCREMENTAL; // a minimum that may not be the least: from scratch
    }
    d = warm_depth(q);
    if (d.delta > -far_apart * fmin(q->a->size, q->b->size)) polish(q, &d);
    count(q, d.iterations, &d);
    return d;
}

/// With curvature on both sides. BFGS is right where Newton has met a flat place.
static bool bfgs(const query *q, pls_depth *d);

static pls_depth newton(const query *q)
{
    pls_depth d;
    pls_overlap o;
    if (is_far(q, &d)) return d;
    const bool known = last_winner(q) != NOTHING;
    pls_smooth_depth(q->a, q->b, known ? recalled_normal(q) : line_of_centres(q), &o);
    int iterations = o.iterations;
    if (known && !o.converged)
    {
        ++q->counts->restarts;
        pls_smooth_depth(q->a, q->b, line_of_centres(q), &o);
        iterations += o.iterations;
    }
    d = depth_of(&o);
    if (d.converged)
    {
        count(q, iterations, &d);
        remember(q, NEWTON, &d);
        return d;
    }
    ++q->counts->fallbacks;
    forget(q);
    return bfgs(q, &d) ? d : expand(q);
}

enum { BFGS_STEPS = 10, GRID_STEPS = 40 };

static void recall_bfgs(const query *q, pls_sdf_state *own)
{
    const double *s = q->state + OWN;
    *own = (pls_sdf_state){.x = {s[0], s[1], s[2]}};
    memcpy(own->inverse, s + 3, sizeof own->inverse);
}

static void remember_bfgs(const query *q, const pls_sdf_state *own, const pls_depth *d)
{
    double *s = q->state + OWN;
    remember(q, BFGS, d);
    s[0] = own->x.x, s[1] = own->x.y, s[2] = own->x.z;
    memcpy(s + 3, own->inverse, sizeof own->inverse);
}

/// Between the surfaces, on the line of centres: where both SDFs are equal.
static pls_vec3 middle_of(const query *q)
{
    pls_vec3 low = centre_of(q->a), high = centre_of(q->b);
    for (int k = 0; k < 20; ++k)
    {
        pls_vec3 x = pls_scale(pls_add(low, high), 0.5);
        if (pls_posed_sdf(q->a, x) < pls_posed_sdf(q->b, x))
            low = x;
        else
            high = x;
    }
    return pls_scale(pls_add(low, high), 0.5);
}

static bool bfgs(const query *q, pls_depth *d)
{
    pls_sdf_state own = {.x = {0.0, 0.0, 0.0}};
    pls_overlap o;
    if (last_winner(q) == BFGS) recall_bfgs(q, &own);
    pls_sdf_depth_bfgs(q->a, q->b, middle_of(q), &own, BFGS_STEPS, &o);
    q->counts->iterations += (uint64_t)o.iterations;
    *d = depth_of(&o);
    if (!o.converged) return false;
    remember_bfgs(q, &own, d);
    return true;
}

/// A ball of radius delta about a witness point lies in the other shape: no direction has less depth. In shapes that are round enough it does at any place.
static bool is_least(const query *q, const pls_depth *d)
{
    if (d->delta <= fmax(q->a->shape->inner_radius * q->a->scale, q->b->shape->inner_radius * q->b->scale)) return true;
    double enough = d->delta * (1.0 - proof) - rounding * fmin(q->a->size, q->b->size);
    return -pls_posed_sdf(q->a, d->on_b) >= enough || -pls_posed_sdf(q->b, d->on_a) >= enough;
}

/// On the shapes pushed apart, from `start`. True: a minimum of the overlap, not always the least.
static bool pushed(const query *q, const pls_depth *start, pls_sdf_state *own, pls_depth *d)
{
    pls_overlap o;
    pls_sdf_depth_pushed(q->a, q->b, start->normal, start->delta, pls_scale(pls_add(start->on_a, start->on_b), 0.5), own, &o);
    q->counts->iterations += (uint64_t)o.iterations;
    *d = depth_of(&o);
    return o.converged;
}

static pls_depth remember_pushed(const query *q, const pls_sdf_state *own, const pls_depth *d)
{
    remember_bfgs(q, own, d);
    q->state[WINNER] = PUSHED;
    return *d;
}

/// The last digits of a depth that is right to some: differences of values, and support points that follow from them, are good to fewer digits than values are.
static pls_depth finish(const query *q, const pls_depth *start)
{
    pls_sdf_state own = {.x = {0.0, 0.0, 0.0}};
    pls_depth d;
    if (pushed(q, start, &own, &d) && d.delta - start->delta < near * fmin(q->a->size, q->b->size)) return remember_pushed(q, &own, &d);
    forget(q);
    return *start;
}

static pls_depth from_sdfs(const query *q)
{
    pls_depth d, start = {.converged = false};
    pls_sdf_state own = {.x = {0.0, 0.0, 0.0}};
    if (last_winner(q) == PUSHED)
    {
        recall_bfgs(q, &own);
        start.normal = recalled_normal(q), start.delta = q->state[DELTA];
        if (pushed(q, &start, &own, &d) && is_least(q, &d)) return remember_pushed(q, &own, &d);
        ++q->counts->restarts;
        forget(q);
    }
    if (bfgs(q, &start)) return finish(q, &start);
    ++q->counts->fallbacks;
    own = (pls_sdf_state){.x = {0.0, 0.0, 0.0}};
    if (pushed(q, &start, &own, &d) && is_least(q, &d)) return remember_pushed(q, &own, &d);
    ++q->counts->fallbacks;
    start = expand(q);
    return start.converged ? finish(q, &start) : start;
}

// ---- shapes that are not convex ---------------------------------------------------------------------------------------------------------------------------------

static void bounds_of(const pls_posed *p, double lower[3], double upper[3])
{
    pls_vec3 half = pls_scale(pls_sub(p->shape->upper, p->shape->lower), 0.5 * p->scale);
    pls_vec3 middle = pls_posed_world(p, pls_scale(pls_add(p->shape->upper, p->shape->lower), 0.5));
    const double m[3] = {middle.x, middle.y, middle.z}, x[3] = {p->x.x, p->x.y, p->x.z}, y[3] = {p->y.x, p->y.y, p->y.z},
                 z[3] = {p->z.x, p->z.y, p->z.z};
    for (int k = 0; k < 3; ++k)
    {
        double reach = fabs(x[k]) * half.x + fabs(y[k]) * half.y + fabs(z[k]) * half.z;
        lower[k] = m[k] - reach, upper[k] = m[k] + reach;
    }
}

/// The point of a grid over the overlap of the bounding boxes (or the gap between them) where phi_A + phi_B is least.
static pls_vec3 deepest_of_grid(const query *q)
{
    enum { SIDE = 6 };
    double la[3], ua[3], lb[3], ub[3], best = INFINITY;
    bounds_of(q->a, la, ua);
    bounds_of(q->b, lb, ub);
    pls_vec3 deepest = centre_of(q->a);
    const int layers = q->a->shape->dimension == 2 ? 1 : SIDE;
    for (int k = 0; k < SIDE * SIDE * layers; ++k)
    {
        const int at[3] = {k % SIDE, k / SIDE % SIDE, k / (SIDE * SIDE)};
        double x[3];
        for (int c = 0; c < 3; ++c)
        {
            double low = fmax(la[c], lb[c]), high = fmin(ua[c], ub[c]);
            x[c] = layers == 1 && c == 2 ? q->a->position.z : low + (at[c] + 0.5) / SIDE * (high - low);
        }
        pls_vec3 X = pls_vec(x[0], x[1], x[2]);
        double f = pls_posed_sdf(q->a, X) + pls_posed_sdf(q->b, X);
        if (f < best) best = f, deepest = X;
    }
    return deepest;
}

static pls_depth from_grid(const query *q)
{
    pls_sdf_state own = {.x = {0.0, 0.0, 0.0}};
    pls_overlap o = {.converged = false};
    if (last_winner(q) == BFGS)
    {
        recall_bfgs(q, &own);
        pls_sdf_depth_bfgs(q->a, q->b, own.x, &own, BFGS_STEPS, &o);
        q->counts->restarts += !o.converged;
    }
    int iterations = o.iterations;
    if (!o.converged)
    {
        own = (pls_sdf_state){.x = {0.0, 0.0, 0.0}};
        pls_sdf_depth_bfgs(q->a, q->b, deepest_of_grid(q), &own, GRID_STEPS, &o);
        iterations += o.iterations;
    }
    pls_depth d = depth_of(&o);
    count(q, iterations, &d);
    if (o.converged)
        remember_bfgs(q, &own, &d);
    else
        forget(q);
    return d;
}

// ---- the table --------------------------------------------------------------------------------------------------------------------------------------------------

enum kind { BALL, POLYTOPE, SMOOTH, SUPPORT, SDF, CONCAVE, HALF_SPACE, KINDS };

static enum kind kind_of(const pls_shape *s)
{
    if (s->ops->unbounded) return HALF_SPACE;
    if (!s->convex) return CONCAVE;
    if (s->polytope) return s->polytope->vertex_count == 1 ? BALL : POLYTOPE;
    if (!s->ops->support) return SDF;
    return s->ops->smooth && s->ops->support_gradient ? SMOOTH : SUPPORT;
}

// clang-format off
static solver *const table[KINDS][KINDS] = {
//   B:           BALL           POLYTOPE       SMOOTH       SUPPORT      SDF        CONCAVE    HALF_SPACE
/* A */
[BALL]       = {ball_ball,     ball_polytope, ball_any,    ball_any,    ball_any,  ball_any,  on_plane},
[POLYTOPE]   = {polytope_ball, polytopes,     by_features, by_features, from_sdfs, from_grid, on_plane},
[SMOOTH]     = {any_ball,      by_features,   newton,      by_features, from_sdfs, from_grid, on_plane},
[SUPPORT]    = {any_ball,      by_features,   by_features, by_features, from_sdfs, from_grid, on_plane},
[SDF]        = {any_ball,      from_sdfs,     from_sdfs,   from_sdfs,   from_sdfs, from_grid, on_plane},
[CONCAVE]    = {any_ball,      from_grid,     from_grid,   from_grid,   from_grid, from_grid, on_plane},
[HALF_SPACE] = {NULL}, // as B only
};
// clang-format on

/// P1 eq. 14, of convex shapes. False: no solution; then the depth, from nothing, as the state is not the depth's.
static bool by_admm(const query *q, double tolerance, pls_depth *d)
{
    pls_overlap o;
    pls_admm_depth(q->a, q->b, tolerance, q->state + ADMM, &o);
    q->counts->iterations += (uint64_t)o.iterations;
    q->counts->fallbacks += !o.converged;
    *d = depth_of(&o);
    return o.converged;
}

static void as_touch(const pls_depth *d, pls_touch *out)
{
    const pls_vec3 point = pls_scale(pls_add(d->on_a, d->on_b), 0.5);
    *out = (pls_touch){.delta = d->delta,
                       .normal = d->normal,
                       .point = point,
                       .middle = point,
                       .weight = 1.0,
                       .energy_delta = d->delta,
                       .depth = d->delta,
                       .reach = d->delta};
}

/// A piece of a wall alone, whatever its neighbours do.
static void one_facet(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, const pls_touch *depth, pls_touch *out)
{
    pls_wall_sum sum = pls_wall_sum_of(a);
    const pls_facet *seams = pls_shape_facet(b->shape);
    pls_wall_add(&sum, b, seams, pls_facet_seen_from(b, seams, centre_of(a)).front, depth);
    if (pls_wall_touch(&sum, options, out)) return;
    const pls_depth none = {.delta = fmin(depth->delta, 0.0), .normal = depth->normal, .on_a = depth->point, .on_b = depth->point};
    pls_overlap_none(&none, out);
}

bool pls_narrow_phase_from(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_pair_state *state,
                           pls_overlap_record *record, pls_touch *out, pls_narrow_counts *counts)
{
    const bool admm = options->solver == PLS_SOLVER_ADMM && a->shape->convex && b->shape->convex;
    pls_pair_state none = {{0.0}};
    const query q = {a, b, state->value, counts}, cold = {a, b, none.value, counts};
    pls_depth d;
    ++counts->queries;
    const bool on_wall = pls_is_wall_pair(a, b, options);
    const bool in_pieces = a->shape->sample || b->shape->sample; // as they are in worlds
    const bool cylinders = in_pieces && pls_is_cylinder_pair(a->shape, b->shape);
    if (options->faces != PLS_FACES_POINT && in_pieces && !cylinders && !on_wall && pls_is_sampled_pair(a->shape, b->shape))
    {
        pls_sampled_touch(a, b, options, out);
        out->stands = true;
        return false;
    }
    if (!admm || !by_admm(&q, options->tolerance, &d)) d = table[kind_of(a->shape)][kind_of(b->shape)](admm ? &cold : &q);
    as_touch(&d, out);
    // Where the pair has neither faces nor lines to speak of the point stands.
    bool recorded = false;
    if (options->faces == PLS_FACES_POINT || d.delta <= 0.0) return false;
    if (cylinders)
    {
        pls_cylinders_touch(a, b, &d, options, out);
        return false;
    }
    if (on_wall)
    {
        pls_touch depth = *out;
        one_facet(a, b, options, &depth, out);
        return false;
    }
    out->stands = pls_faces_touch(a, b, &d, options, record, &recorded, out) || pls_cylinder_touch(a, b, &d, options, out) ||
                  pls_lines_touch(a, b, &d, out);
    return recorded;
}

bool pls_narrow_phase_again(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_overlap_record *record,
                            pls_touch *out, pls_narrow_counts *counts)
{
    if (!pls_faces_touch_again(a, b, options, record, out)) return false;
    out->stands = true;
    ++counts->queries;
    return true;
}
