// sdf_depth.c -- penetration depth from SDFs alone.
//
// BFGS. At the least value of phi_A + phi_B the two gradients are opposite, so the surfaces nearest to that point face each other: it lies between them, its feet are
// the contact's two points and n = grad phi_A. Along n the sum is constant (it is a valley), so the point is kept in the middle and only the two directions across
// are searched.
//
// Pushed. Inside, SDFs have ridges, where that fails. So B is pushed away by s = r n, r more than the overlap, and the same is done between the two, where distances
// are smooth. With D = phi_A + phi_B at its least, the distance there, and n' its normal, the overlap along n' is F(n') = s.n' - D. Of all n the depth's own leaves the
// greatest D: r less the depth. Pushing along n' next comes nearer to that by r / (r + K), K the sum of the radii of curvature, and where an edge or a corner holds n it is
// there at once. Errors of x, of n' and of gradients, which may be differences of values, all count squared in F: so it is as good as the values themselves.

#include "contact/sdf_depth.h"

static const double flat = 1e-7;     ///< of |grad phi_A + grad phi_B| at which BFGS is done
static const double shortest = 1e-7; ///< step that tells of the second derivative, of the size: of a shorter one it is noise
static const double pushed = 0.05;   ///< sizes that B is pushed beyond touching
static const double level = 3e-8;    ///< as `flat`, of bodies pushed apart: what differences of values allow
static const double coarse = 1e-4;   ///< as `level`, of the first turn,
static const double share = 0.05;    ///< and of the turn that was made, of later ones
static const double settled = 1e-7;  ///< turn of the normal at which it is done; squared it is less than round-off
enum { MOST_TURNS = 20, MOST_DESCENTS = 12, HALVINGS = 20 };

typedef struct probe
{
    pls_vec3 x, ga, gb, g, n;
    double a, b, f;
} probe;

/// B is seen moved by s.
static probe probe_at(const pls_posed *a, const pls_posed *b, pls_vec3 s, pls_vec3 x)
{
    const pls_vec3 y = pls_sub(x, s);
    probe p = {.x = x, .a = pls_posed_sdf(a, x), .b = pls_posed_sdf(b, y), .ga = pls_posed_gradient(a, x), .gb = pls_posed_gradient(b, y)};
    p.f = p.a + p.b;
    p.g = pls_add(p.ga, p.gb);
    p.n = pls_unit(pls_sub(p.ga, p.gb));
    return p;
}

static pls_vec3 times(const double m[6], pls_vec3 v)
{
    return pls_vec(m[0] * v.x + m[3] * v.y + m[4] * v.z, m[3] * v.x + m[1] * v.y + m[5] * v.z, m[4] * v.x + m[5] * v.y + m[2] * v.z);
}

/// The inverse second derivative after a step s that changed the gradient by y (Nocedal & Wright, Numerical Optimization, eq. 6.17).
static void update(double m[6], pls_vec3 s, pls_vec3 y)
{
    double sy = pls_dot(s, y);
    if (!(sy > 1e-12 * pls_length(s) * pls_length(y))) return;
    pls_vec3 my = times(m, y);
    double c = (1.0 + pls_dot(y, my) / sy) / sy;
    const double sv[3] = {s.x, s.y, s.z}, mv[3] = {my.x, my.y, my.z};
    static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int k = 0; k < 6; ++k)
    {
        int r = row[k], q = column[k];
        m[k] += c * sv[r] * sv[q] - (mv[r] * sv[q] + sv[r] * mv[q]) / sy;
    }
}

static bool is_known(const pls_sdf_state *s) { return s->inverse[0] + s->inverse[1] + s->inverse[2] > 0.0; }

static pls_vec3 across(pls_vec3 v, pls_vec3 n) { return pls_sub(v, pls_scale(n, pls_dot(v, n))); }

/// Down the valley to where |g| < `small`, in at most `most` steps; m is the inverse second derivative. The number of steps, `most` + 1 if they do not do.
static int descend(const pls_posed *a, const pls_posed *b, pls_vec3 s, double small, int most, double m[6], probe *now)
{
    const double scale = a->size * b->size / (a->size + b->size);
    for (int k = 0; k < most; ++k)
    {
        if (pls_length(now->g) < small) return k;
        pls_vec3 side = across(pls_scale(times(m, now->g), -1.0), now->n), centre = pls_scale(now->n, 0.5 * (now->b - now->a));
        double down = pls_dot(now->g, side), take = 1.0;
        if (!(down < 0.0)) side = pls_scale(across(now->g, now->n), -scale), down = pls_dot(now->g, side);
        probe next = *now;
        for (int halving = 0; halving < HALVINGS; ++halving, take *= 0.5)
        {
            next = probe_at(a, b, s, pls_add(now->x, pls_add(pls_scale(side, take), centre)));
            if (next.f <= now->f + 1e-4 * take * down) break;
        }
        const double step = pls_length(pls_sub(next.x, now->x));
        if (step > shortest * scale) update(m, pls_sub(next.x, now->x), pls_sub(next.g, now->g));
        const bool still = step < 1e-15 * a->size;
        *now = next;
        if (still) break;
    }
    return most + 1;
}

static void begin_inverse(const pls_posed *a, const pls_posed *b, const pls_sdf_state *state, double m[6])
{
    const double scale = a->size * b->size / (a->size + b->size);
    for (int k = 0; k < 6; ++k) m[k] = is_known(state) ? state->inverse[k] : k < 3 ? scale : 0.0;
}

void pls_sdf_depth_bfgs(const pls_posed *a, const pls_posed *b, pls_vec3 middle, pls_sdf_state *state, int most, pls_overlap *out)
{
    const pls_vec3 none = pls_vec(0.0, 0.0, 0.0);
    double m[6];
    begin_inverse(a, b, state, m);
    probe now = probe_at(a, b, none, is_known(state) ? pls_posed_world(a, state->x) : middle);
    const int steps = descend(a, b, none, flat, most, m, &now);
    *out = (pls_overlap){.delta = -now.f,
                         .normal = now.n,
                         .on_a = pls_sub(now.x, pls_scale(now.ga, now.a)),
                         .on_b = pls_sub(now.x, pls_scale(now.gb, now.b)),
                         .iterations = steps < most ? steps : most - 1,
                         .converged = steps <= most};
    state->x = pls_posed_own(a, now.x);
    for (int k = 0; k < 6; ++k) state->inverse[k] = m[k];
}

/// Points that lie beside each other by an error: one of them, and what is `delta` along n from there. An error across n leaves a sharp edge in first order, a round side in second:
/// so the one whose opposite lies nearer to its surface.
static void set_opposite(const pls_posed *a, const pls_posed *b, pls_overlap *out)
{
    const pls_vec3 through = pls_scale(out->normal, out->delta), of_a = pls_sub(out->on_a, through), of_b = pls_add(out->on_b, through);
    if (fabs(pls_posed_sdf(b, of_a)) < fabs(pls_posed_sdf(a, of_b)))
        out->on_b = of_a;
    else
        out->on_a = of_b;
}

void pls_sdf_depth_pushed(const pls_posed *a, const pls_posed *b, pls_vec3 normal, double delta, pls_vec3 middle, pls_sdf_state *state,
                          pls_overlap *out)
{
    const double size = fmin(a->size, b->size);
    double m[6], further = pushed * size, small = coarse;
    pls_vec3 s = pls_scale(normal, fmax(delta, 0.0) + further);
    if (is_known(state)) middle = pls_sub(pls_posed_world(a, state->x), pls_scale(s, 0.5));
    probe now = {.x = pls_add(middle, pls_scale(s, 0.5))};
    begin_inverse(a, b, state, m);
    *out = (pls_overlap){.delta = delta, .normal = normal};
    for (int k = 0; k < MOST_TURNS && !out->converged; ++k)
    {
        now = probe_at(a, b, s, now.x);
        const int steps = descend(a, b, s, small, MOST_DESCENTS, m, &now);
        out->iterations += 1 + steps;
        if (now.a > 0.0 && now.b > 0.0)
        {
            const double length = pls_length(s), turned = pls_length(pls_sub(now.n, pls_scale(s, 1.0 / length)));
            out->delta = pls_dot(s, now.n) - now.f;
            out->normal = now.n;
            out->on_a = pls_sub(now.x, pls_scale(pls_unit(now.ga), now.a)); // differences are not quite of length 1
            out->on_b = pls_sub(pls_sub(now.x, pls_scale(pls_unit(now.gb), now.b)), s);
            out->converged = steps <= MOST_DESCENTS && turned < settled && small <= level;
            small = fmax(level, share * turned);
        }
        else // not yet apart, or between them no more
        {
            further = 2.0 * further;
            now.x = pls_add(middle, pls_scale(out->normal, 0.5 * (fmax(out->delta, 0.0) + further)));
        }
        s = pls_scale(out->normal, fmax(out->delta, 0.0) + further);
    }
    set_opposite(a, b, out);
    state->x = pls_posed_own(a, now.x);
    for (int k = 0; k < 6; ++k) state->inverse[k] = m[k];
}
