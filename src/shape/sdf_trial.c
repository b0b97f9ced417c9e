// sdf_trial.c -- is what a shape gives as its SDF a signed distance?
//
// What nobody could see at a glance is tried at random: an SDF that lies gives wrong masses and wrong contacts, and tells nobody. First the size is guessed from far
// away, which succeeds for every bounded set. Where it does not, the reason is looked for among the common mistakes, in an order in which none is taken for another:
// not finite, steeper than 1, the wrong sign, nowhere negative, less steep than 1; only what is left has no end. With the size known, pairs of points, their feet, and
// chords through the bounds are tried. Every message has the point and the value.

#include "shape/sdf_trial.h"

#include "base/random.h"

enum {
    TRIALS = 2000,     ///< pairs of points
    CHORDS_2D = 60,    ///< looked along for jumps: a few percent of the calls that the mass takes, which are fewer in 2D
    CHORDS_3D = 800,   ///< the same in 3D
    PIECES = 32,       ///< of such a chord
    HALVINGS = 20,     ///< of a steep piece, until it is a millionth as long
    LAST_HALVINGS = 8, ///< over which a jump stays while a slope shrinks to 1/256
    DECADES = 12,      ///< of lengths around the origin that are tried without knowing the size
    DESCENTS = 40      ///< towards the least value
};
static const double steepness = 1e-9;     ///< by which an SDF may be steeper than 1, for round-off
static const double round_off = 1e-12;    ///< of the size: what values may differ by where they should be the same
static const double clearly_steep = 1e-6; ///< the same where the size, and so the round-off, is not known
static const double foot_error = 1e-3;    ///< of the size: how far from the surface the foot of a point outside may lie
static const double dent = 1e-4;          ///< of the size: by how much the SDF of a convex shape may fail to be convex
static const double remote = 1e6;         ///< units from where a bounded shape is a point

static const pls_vec3 axes[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// All that there is of the shape is its SDF.
static bool is_alone(const pls_shape *shape) { return !shape->ops->mass_properties && !shape->ops->wall; }

// ---- messages -------------------------------------------------------------------------------------------------------------------------------------------------

static pls_status not_finite(const char *name, double phi, pls_vec3 X)
{
    return pls_fail(PLS_INVALID_ARGUMENT, "the SDF of %s is %g at (%g, %g, %g) m; it must be finite everywhere", name, phi, X.x, X.y, X.z);
}

static pls_status no_distance(const char *name, double phi, pls_vec3 X, double left, pls_vec3 foot)
{
    return pls_fail(PLS_INVALID_ARGUMENT,
                    "the SDF of %s is no true distance outside: at (%g, %g, %g) m it says %.6g m, but so far against its gradient, at "
                    "(%g, %g, %g) m, it still says %.3g m",
                    name, X.x, X.y, X.z, phi, foot.x, foot.y, foot.z, left);
}

pls_status pls_sdf_no_inside(const char *name, const pls_sdf_least *least)
{
    return pls_fail(PLS_INVALID_ARGUMENT,
                    "the SDF of %s is nowhere negative: the least value found is %g m, at (%g, %g, %g) m; inside it must be negative", name,
                    least->phi, least->at.x, least->at.y, least->at.z);
}

/// From a to b the SDF changes by more than the way. Halved again and again, the steeper half kept: where the change stays it is a jump.
static pls_status too_steep(const pls_shape *shape, const char *name, pls_vec3 a, pls_vec3 b)
{
    const pls_vec3 first = a, last = b;
    double at_a = pls_shape_sdf(shape, a), at_b = pls_shape_sdf(shape, b), before = 0.0;
    const double at_first = at_a, at_last = at_b;
    for (int k = 0; k < HALVINGS; ++k)
    {
        if (k == HALVINGS - LAST_HALVINGS) before = fabs(at_a - at_b);
        const pls_vec3 m = pls_scale(pls_add(a, b), 0.5);
        const double at_m = pls_shape_sdf(shape, m);
        if (!isfinite(at_m)) return not_finite(name, at_m, m);
        if (fabs(at_m - at_a) > fabs(at_b - at_m))
            b = m, at_b = at_m;
        else
            a = m, at_a = at_m;
    }
    if (fabs(at_a - at_b) > 0.5 * before)
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "the SDF of %s jumps: from (%.9g, %.9g, %.9g) m to (%.9g, %.9g, %.9g) m, %.1g m apart, it changes from %.9g to "
                        "%.9g m. A distance changes by no more than the way",
                        name, a.x, a.y, a.z, b.x, b.y, b.z, pls_length(pls_sub(a, b)), at_a, at_b);
    return pls_fail(
        PLS_INVALID_ARGUMENT,
        "the SDF of %s is steeper than a distance can be: from (%g, %g, %g) m to (%g, %g, %g) m it changes from %.9g to %.9g m, "
        "by %.6g times the way. Divide it by its steepest slope, or give a true distance",
        name, first.x, first.y, first.z, last.x, last.y, last.z, at_first, at_last,
        fabs(at_first - at_last) / pls_length(pls_sub(first, last)));
}

/// The foot of a point outside, and what the SDF is there.
static pls_status foot_of(const pls_shape *shape, const char *name, pls_vec3 X, double phi, pls_vec3 *foot, double *left)
{
    const pls_vec3 g = pls_shape_gradient(shape, X);
    if (!isfinite(g.x + g.y + g.z))
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "the gradient of the SDF of %s is (%g, %g, %g) at (%g, %g, %g) m; it must be finite everywhere", name, g.x, g.y,
                        g.z, X.x, X.y, X.z);
    *foot = pls_sub(X, pls_scale(g, phi));
    *left = pls_shape_sdf(shape, *foot);
    return isfinite(*left) ? PLS_OK : not_finite(name, *left, *foot);
}

/// Down the slope by the distance, by less where that leads up: of a true distance to the surface, from anywhere outside.
static pls_sdf_least descend(const pls_shape *shape, pls_vec3 X)
{
    pls_sdf_least least = {.phi = pls_shape_sdf(shape, X), .at = X};
    double part = 1.0;
    for (int k = 0; k < DESCENTS && least.phi > 0.0; ++k)
    {
        const pls_vec3 g = pls_shape_gradient(shape, least.at);
        const double slope = pls_length(g);
        if (!(slope > 0.0)) break;
        const pls_vec3 next = pls_sub(least.at, pls_scale(g, part * least.phi / slope));
        const double phi = pls_shape_sdf(shape, next);
        if (phi < least.phi)
            least = (pls_sdf_least){.phi = phi, .at = next};
        else
            part *= 0.5;
    }
    return least;
}

// ---- the size, and why there is none ----------------------------------------------------------------------------------------------------------------------------

/// A length to begin with: how far the surface is from the origin, if the SDF is right.
static double unit_of(double at_origin) { return at_origin != 0.0 ? fabs(at_origin) : 1.0; }

/// Chords from the origin, along the axes and across, and on from their ends, of all lengths that may matter.
static pls_status try_around_origin(const pls_shape *shape, const char *name, double unit)
{
    const int directions = shape->dimension == 2 ? 9 : 27;
    for (int k = 0; k < directions * DECADES; ++k)
    {
        const int way = k / DECADES;
        const double length = unit * pow(10.0, k % DECADES - DECADES / 2);
        pls_vec3 e = pls_vec(way % 3 - 1, way / 3 % 3 - 1, directions == 27 ? way / 9 - 1 : 0);
        if (pls_dot(e, e) == 0.0) continue;
        e = pls_unit(e);
        const pls_vec3 a = pls_scale(e, length), b = pls_scale(e, 2.0 * length), from[2] = {pls_vec(0.0, 0.0, 0.0), a}, to[2] = {a, b};
        for (int j = 0; j < 2; ++j)
        {
            const double first = pls_shape_sdf(shape, from[j]), second = pls_shape_sdf(shape, to[j]);
            if (!isfinite(second)) return not_finite(name, second, to[j]);
            if (fabs(second - first) > length * (1.0 + clearly_steep) + round_off * unit) return too_steep(shape, name, from[j], to[j]);
        }
    }
    return PLS_OK;
}

/// Far away the distances along e and -e of a bounded set are 2 t less its width.
static pls_status try_far_away(pls_shape *shape, const char *name, double unit)
{
    shape->size = unit; // for steps of differences
    const int count = 2 * shape->dimension;
    const double t = remote * unit;
    double phi[6], nearest = INFINITY;
    int negative = 0, where = 0;
    for (int a = 0; a < count; ++a)
    {
        phi[a] = pls_shape_sdf(shape, pls_scale(axes[a], t));
        negative += phi[a] < 0.0;
        if (phi[a] < nearest) nearest = phi[a], where = a;
    }
    if (negative == count)
        return pls_fail(
            PLS_INVALID_ARGUMENT,
            "the SDF of %s is negative in all directions far away, where it must be positive: %g m at (%g, %g, %g) m. It is the "
            "distance from the surface outside, and less than 0 inside: is its sign the other way round?",
            name, phi[where], t * axes[where].x, t * axes[where].y, t * axes[where].z);
    const pls_sdf_least least = descend(shape, pls_vec(0.0, 0.0, 0.0));
    for (int a = 0; a < count; a += 2)
        if ((t - phi[a]) + (t - phi[a + 1]) < -foot_error * unit && least.phi >= 0.0) return pls_sdf_no_inside(name, &least);
    for (int a = 0; a < count; ++a)
    {
        if (phi[a] <= 0.0) continue;
        const pls_vec3 X = pls_scale(axes[a], t);
        pls_vec3 foot;
        double left;
        PLS_TRY(foot_of(shape, name, X, phi[a], &foot, &left));
        if (fabs(left) > foot_error * phi[a]) return no_distance(name, phi[a], X, left, foot);
    }
    return pls_fail(PLS_INVALID_ARGUMENT,
                    "%s has no end: at (%g, %g, %g) m its SDF is %g m, as near as that. Bounded shapes only, and true distances", name,
                    t * axes[where].x, t * axes[where].y, t * axes[where].z, phi[where]);
}

pls_status pls_sdf_guess_size(pls_shape *shape, const char *name)
{
    const int count = 2 * shape->dimension;
    const pls_vec3 origin = pls_vec(0.0, 0.0, 0.0);
    const double at_origin = pls_shape_sdf(shape, origin);
    if (!isfinite(at_origin)) return not_finite(name, at_origin, origin);
    const double unit = unit_of(at_origin);
    double size = 0.0;
    // t - phi(t e) tends to the extent along e.
    for (double t = unit; t <= 4e30; t *= 4.0)
    {
        double reach = 0.0;
        for (int a = 0; a < count; ++a)
        {
            const pls_vec3 X = pls_scale(axes[a], t);
            const double phi = pls_shape_sdf(shape, X);
            if (!isfinite(phi)) return not_finite(name, phi, X);
            reach = fmax(reach, t - phi);
        }
        if (reach > 0.0 && reach < 0.1 * t && fabs(reach - size) < 0.05 * reach)
        {
            shape->size = reach;
            return is_alone(shape) ? try_around_origin(shape, name, reach)
                                   : PLS_OK; // bounds are sought by the SDF, which must be none that leads away
        }
        size = reach;
    }
    PLS_TRY(try_around_origin(shape, name, unit));
    return try_far_away(shape, name, unit);
}

// ---- in the bounds ----------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 random_point(const pls_shape *shape, pls_random *random, double margin)
{
    double u[3];
    for (int a = 0; a < 3; ++a) u[a] = pls_random_uniform(random);
    pls_vec3 side = pls_sub(shape->upper, shape->lower), middle = pls_scale(pls_add(shape->upper, shape->lower), 0.5);
    double grow = 1.0 + margin;
    return pls_vec(middle.x + (u[0] - 0.5) * side.x * grow, middle.y + (u[1] - 0.5) * side.y * grow,
                   middle.z + (u[2] - 0.5) * side.z * grow);
}

static bool is_steep(const pls_shape *shape, double change, double apart)
{
    return fabs(change) > apart * (1.0 + steepness) + round_off * shape->size;
}

/// The distance from a convex set is a convex function: half way between two points it is no more than their mean. Inside, where it may be anything, it counts as 0.
static pls_status try_convex(const pls_shape *shape, const char *name, pls_vec3 a, pls_vec3 b)
{
    const pls_vec3 m = pls_scale(pls_add(a, b), 0.5);
    const double at_a = pls_shape_sdf(shape, a), at_b = pls_shape_sdf(shape, b), at_m = pls_shape_sdf(shape, m);
    if (!(at_m > 0.5 * (fmax(at_a, 0.0) + fmax(at_b, 0.0)) + dent * shape->size)) return PLS_OK;
    return pls_fail(PLS_INVALID_ARGUMENT,
                    "%s is said to be convex, but its SDF is not: at (%g, %g, %g) m half way between (%g, %g, %g) m and (%g, %g, %g) m, "
                    "where it is %.6g and %.6g m, it is %.6g m",
                    name, m.x, m.y, m.z, a.x, a.y, a.z, b.x, b.y, b.z, at_a, at_b, at_m);
}

/// Along a chord, where the change of the SDF over a piece differs most from those of its neighbours; and on into the half that differs more from them.
static pls_status try_chord(const pls_shape *shape, const char *name, pls_vec3 a, pls_vec3 b)
{
    double phi[PIECES + 1], most = 0.0;
    const pls_vec3 piece = pls_scale(pls_sub(b, a), 1.0 / PIECES);
    int worst = 1;
    for (int k = 0; k <= PIECES; ++k)
    {
        const pls_vec3 X = pls_add(a, pls_scale(piece, k));
        phi[k] = pls_shape_sdf(shape, X);
        if (!isfinite(phi[k])) return not_finite(name, phi[k], X);
        if (k > 0 && is_steep(shape, phi[k] - phi[k - 1], pls_length(piece))) return too_steep(shape, name, pls_sub(X, piece), X);
        if (k < 3) continue;
        const double differs = fabs((phi[k - 1] - phi[k - 2]) - 0.5 * ((phi[k] - phi[k - 1]) + (phi[k - 2] - phi[k - 3])));
        if (differs > most) most = differs, worst = k - 2;
    }
    pls_vec3 low = pls_add(a, pls_scale(piece, worst)), step = piece;
    double at_low = phi[worst], at_high = phi[worst + 1], usual = 0.5 * ((phi[worst] - phi[worst - 1]) + (phi[worst + 2] - phi[worst + 1]));
    for (int k = 0; k < LAST_HALVINGS; ++k)
    {
        step = pls_scale(step, 0.5), usual *= 0.5;
        const pls_vec3 m = pls_add(low, step);
        const double at_m = pls_shape_sdf(shape, m);
        if (fabs(at_m - at_low - usual) > fabs(at_high - at_m - usual))
            at_high = at_m;
        else
            low = m, at_low = at_m;
        if (is_steep(shape, at_high - at_low, pls_length(step))) return too_steep(shape, name, low, pls_add(low, step));
    }
    return PLS_OK;
}

/// What is left where the SDF is all there is to know a shape by.
static pls_status try_chords(const pls_shape *shape, const char *name, pls_random *random)
{
    const int chords = shape->dimension == 2 ? CHORDS_2D : CHORDS_3D;
    for (int k = 0; k < chords; ++k)
    {
        const pls_vec3 a = random_point(shape, random, 0.2), b = random_point(shape, random, 0.2);
        PLS_TRY(try_chord(shape, name, a, b));
        if (shape->convex) PLS_TRY(try_convex(shape, name, a, b));
    }
    return PLS_OK;
}

pls_status pls_sdf_try(const pls_shape *shape, const char *name, pls_sdf_least *least)
{
    const bool alone = is_alone(shape);
    pls_random random = pls_random_stream(1, 0, PLS_FOR_USER);
    pls_vec3 before = pls_vec(0.0, 0.0, 0.0);
    int feet = 0;
    *least = (pls_sdf_least){.phi = INFINITY};
    for (int k = 0; k < TRIALS; ++k)
    {
        pls_vec3 a = random_point(shape, &random, 1.0), b = random_point(shape, &random, 1.0);
        if (k & 1) b = pls_add(a, pls_scale(pls_sub(b, a), 1e-3)); // near by
        const double at_a = pls_shape_sdf(shape, a), at_b = pls_shape_sdf(shape, b);
        if (!isfinite(at_a)) return not_finite(name, at_a, a);
        if (is_steep(shape, at_a - at_b, pls_length(pls_sub(a, b)))) return too_steep(shape, name, a, b);
        if (at_a < least->phi) *least = (pls_sdf_least){.phi = at_a, .at = a};
        if (at_a <= 0.0) continue;
        pls_vec3 foot;
        double left;
        PLS_TRY(foot_of(shape, name, a, at_a, &foot, &left));
        if (fabs(left) > foot_error * (shape->size + at_a))
        {
            PLS_TRY(try_chord(shape, name, a, foot)); // a jump between them is the better reason
            const pls_sdf_least low = descend(shape, a);
            if (low.phi > foot_error * shape->size && least->phi > 0.0) return pls_sdf_no_inside(name, low.phi < least->phi ? &low : least);
            return no_distance(name, at_a, a, left, foot);
        }
        if (alone && shape->convex && (feet++ & 1)) PLS_TRY(try_convex(shape, name, before, foot));
        before = foot;
    }
    return alone ? try_chords(shape, name, &random) : PLS_OK;
}
