// admm.c -- the contact of two convex shapes as P1 has it: eq. 14 by ADMM.
//
// Eq. 14 falls into two problems that know nothing of each other, "the least phi_B over A" and "the least phi_A over B". Both are convex, and their solutions lie on the surfaces as
// long as neither shape holds the deepest point of the other. Each is solved by ADMM, here in the form of Douglas and Rachford's splitting: it asks one shape for nearest points
// and the other for the proximal map of its SDF,
//
//     x = nearest point of A to z,    y = argmin phi_B(y) + |y - (2 x - z)|^2 / (2 step),    z <- z + y - x
//
// and ends with x = y. The multiplier u = (z - x) / step is a normal of A at x and minus a gradient of phi_B there: from A to B, and defined also where shapes only touch.
//
// Warm. x and u are remembered in the frame of the body that x belongs to, and so is how far they were from where they had been expected: bodies that move
// evenly are met a step ahead, also where the contact travels over both.
//
// Even motion. Where nothing curves, iterates may move on evenly for long: x along nearly parallel faces, by tilt times step, 1 / tilt times; or u with x at rest, by the distance of x and y
// over step, where two points have to come together across a ridge. So while changes are equal the step is doubled every few iterations in the first case and halved in the second
// (any step has the same solution, x and u go on), and it is the first one again as soon as they are not.
//
// Parallel faces. The least phi_B is then taken all over a patch of A, and so is phi_A over B: any two points of it would do for eq. 14, with any distance between
// them. So the second problem starts from the foot of the first one's solution, unless the point remembered is lower.

#include "contact/admm.h"
#include "shape/proximal.h"

static const double step_of_size = 0.5;  // of the proximal map, in smaller bounding radii
static const double even_within = 0.02;  // by how much changes differ that count as even, of their length
static const double furthest_step = 1e4; // of changed steps, in first ones, or less than them
enum { EVEN_TURNS = 4 };                 // of these one changes the step
static const double far_expected = 0.05; // a change beyond this many sizes is no motion to go on with

/// The least SDF of `field` over `set`.
typedef struct problem
{
    const pls_posed *set, *field;
    pls_vec3 x, u; ///< where to start; then the solution
    int iterations;
    bool converged;
} problem;

static pls_vec3 nearest_in(const pls_posed *p, pls_vec3 X)
{
    // Twice for the round-off of differences.
    for (int k = 0; k < (p->shape->ops->gradient ? 1 : 2); ++k)
    {
        double phi = pls_posed_sdf(p, X);
        if (!(phi > 0.0)) break;
        X = pls_sub(X, pls_scale(pls_posed_gradient(p, X), phi));
    }
    return X;
}

static pls_vec3 foot(const pls_posed *p, pls_vec3 X) { return pls_sub(X, pls_scale(pls_posed_gradient(p, X), pls_posed_sdf(p, X))); }

static pls_vec3 proximal(const pls_posed *p, pls_vec3 X, double step)
{
    return pls_posed_world(p, pls_shape_proximal(p->shape, pls_posed_own(p, X), step / p->scale));
}

static bool is_even(pls_vec3 change, pls_vec3 last) { return pls_length(pls_sub(change, last)) < even_within * pls_length(last); }

/// What x does in even motion tells which way the step has to go; `now` in first ones.
static double longer_or_shorter(pls_vec3 change, pls_vec3 moved, double now)
{
    const double factor = pls_length(moved) > 0.5 * pls_length(change) ? 2.0 : 0.5;
    return now * factor > furthest_step || now * factor < 1.0 / furthest_step ? 1.0 : factor;
}

static void solve(problem *p, double first_step, double enough)
{
    double step = first_step;
    pls_vec3 z = pls_add(p->x, pls_scale(p->u, step)), last = pls_vec(0.0, 0.0, 0.0), last_x = p->x;
    p->converged = false;
    for (p->iterations = 1;; ++p->iterations)
    {
        p->x = nearest_in(p->set, z);
        pls_vec3 y = proximal(p->field, pls_sub(pls_scale(p->x, 2.0), z), step), change = pls_sub(y, p->x), moved = pls_sub(p->x, last_x);
        p->converged = pls_length(change) <= enough;
        if (p->converged || p->iterations == PLS_ADMM_MOST) break;
        double factor = 1.0;
        if (!is_even(change, last))
            factor = first_step / step;
        else if (p->iterations % EVEN_TURNS == 0)
            factor = longer_or_shorter(change, moved, step / first_step);
        z = pls_add(z, change);
        last = factor > 1.0 ? pls_scale(change, factor) : change;
        last_x = p->x;
        if (factor != 1.0)
        {
            pls_vec3 x = nearest_in(p->set, z); // the same for any step along the multiplier
            z = pls_add(x, pls_scale(pls_sub(z, x), factor));
            step *= factor;
        }
    }
    p->u = pls_scale(pls_sub(z, p->x), 1.0 / step);
}

// ---- where to start -----------------------------------------------------------------------------------------------------------------------------------------

/// x, u, and how far they were from where they had been expected, in the frame of x's body.
enum { POINT, MULTIPLIER, POINT_AHEAD, MULTIPLIER_AHEAD, VECTORS };

static pls_vec3 get(const double *state, int k) { return pls_vec(state[3 * k], state[3 * k + 1], state[3 * k + 2]); }
static void put(double *state, int k, pls_vec3 v) { state[3 * k] = v.x, state[3 * k + 1] = v.y, state[3 * k + 2] = v.z; }

static bool is_known(const double *state)
{
    for (int k = 0; k < PLS_ADMM_STATE; ++k)
        if (state[k] != 0.0) return true;
    return false;
}

static void recall(problem *p, const double *state)
{
    p->x = pls_posed_world(p->set, pls_add(get(state, POINT), get(state, POINT_AHEAD)));
    p->u = pls_posed_turn(p->set, pls_add(get(state, MULTIPLIER), get(state, MULTIPLIER_AHEAD)));
}

static void remember(const problem *p, bool known, double *state)
{
    pls_vec3 x = pls_posed_own(p->set, p->x), u = pls_posed_turn_back(p->set, p->u), none = pls_vec(0.0, 0.0, 0.0);
    pls_vec3 dx = pls_sub(x, get(state, POINT)), du = pls_sub(u, get(state, MULTIPLIER));
    bool even = known && pls_length(dx) < far_expected * p->set->shape->size && pls_length(du) < far_expected;
    put(state, POINT, x);
    put(state, MULTIPLIER, u);
    put(state, POINT_AHEAD, even ? dx : none);
    put(state, MULTIPLIER_AHEAD, even ? du : none);
}

/// From a point near the solution.
static void start_at(problem *p, pls_vec3 x)
{
    p->x = x;
    p->u = pls_scale(pls_posed_gradient(p->field, x), -1.0);
}

static void start_first(problem *p, const double *state, bool known)
{
    if (known)
        recall(p, state);
    else if (isfinite(p->field->size))
        start_at(p, nearest_in(p->set, pls_posed_world(p->field, p->field->shape->mass.centre)));
    else
        start_at(p, nearest_in(p->set, foot(p->field, pls_posed_world(p->set, p->set->shape->mass.centre))));
}

/// A tie, within what the tolerance cannot tell apart, goes to the foot.
static void start_second(problem *p, const problem *first, const double *state, bool known, double enough)
{
    pls_vec3 below = foot(p->set, first->x);
    if (known)
    {
        recall(p, state);
        if (pls_posed_sdf(p->field, below) > pls_posed_sdf(p->field, nearest_in(p->set, p->x)) + enough) return;
    }
    start_at(p, below);
}

// ---- the answer -----------------------------------------------------------------------------------------------------------------------------------------------

static bool is_thin(const pls_posed *p) { return p->shape->ops->wall; }

/// A piece of a wall has no inside to be deep in: the body's point is the foot of the piece's.
static void from_the_other(problem *p, const problem *other)
{
    p->x = foot(p->set, other->x);
    p->u = pls_scale(other->u, -1.0);
    p->converged = true;
}

static void answer(const problem *first, const problem *second, bool overlapping, double enough, pls_overlap *out)
{
    const pls_vec3 apart = pls_sub(first->x, second->x), middle = pls_scale(pls_add(first->x, second->x), 0.5);
    const double length = pls_length(apart);
    out->on_a = first->x;
    out->on_b = second->x;
    if (length > enough)
    {
        out->delta = overlapping ? length : -length;
        out->normal = pls_scale(apart, 1.0 / out->delta);
        return;
    }
    pls_vec3 n = pls_sub(first->u, second->u);
    out->normal = pls_unit(pls_length(n) > 0.0 ? n : pls_posed_gradient(first->set, first->x));
    out->delta = pls_dot(apart, out->normal);
    out->on_a = pls_add(middle, pls_scale(out->normal, 0.5 * out->delta));
    out->on_b = pls_sub(middle, pls_scale(out->normal, 0.5 * out->delta));
}

void pls_admm_depth(const pls_posed *a, const pls_posed *b, double tolerance, double *state, pls_overlap *out)
{
    const double size = fmin(a->size, b->size), step = step_of_size * size, enough = tolerance * size;
    const bool known = is_known(state);
    problem first = {.set = a, .field = b}, second = {.set = b, .field = a};
    start_first(&first, state, known);
    solve(&first, step, enough);
    start_second(&second, &first, state + 3 * VECTORS, known, enough);
    solve(&second, step, enough);
    remember(&first, known, state);
    remember(&second, known, state + 3 * VECTORS);
    out->iterations = first.iterations > second.iterations ? first.iterations : second.iterations;
    const double phi_b = pls_posed_sdf(b, first.x), phi_a = pls_posed_sdf(a, second.x);
    const bool overlapping = is_thin(b) ? phi_a < 0.0 : is_thin(a) ? phi_b < 0.0 : phi_a + phi_b < 0.0;
    if (overlapping && is_thin(b)) from_the_other(&first, &second);
    if (overlapping && is_thin(a)) from_the_other(&second, &first);
    // Within the set the least SDF is that of all space: the set holds the field's deepest point.
    const bool on_surfaces = fabs(pls_posed_sdf(a, first.x)) <= enough && fabs(pls_posed_sdf(b, second.x)) <= enough;
    out->converged = first.converged && second.converged && on_surfaces;
    answer(&first, &second, overlapping, enough, out);
}
