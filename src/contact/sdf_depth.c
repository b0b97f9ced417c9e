// sdf_depth.c -- penetration depth from SDFs alone.
//
// BFGS. At the least value of phi_A + phi_B the two gradients are opposite, so the surfaces nearest to that point face each other: it lies between them, its feet are
// the contact's two points and n = grad phi_A. Along n the sum is constant (it is a valley), so the point is kept in the middle and only the two directions across
// are searched.
//
// Projections. Push B away along n by more than the overlap and take the nearest points of the two: a on A, then b on B, in turn, n turning along. Distances inside
// shapes, which have ridges, are never asked for.

#include "contact/sdf_depth.h"

static const double flat = 1e-7;    ///< of |grad phi_A + grad phi_B| at which BFGS is done
static const double pushed = 0.6;   ///< sizes that B is pushed beyond touching
static const double settled = 1e-8; ///< change of the normal at which projections are done: the depth's error is of second order

typedef struct probe
{
    pls_vec3 x, ga, gb, g, n;
    double a, b, f;
} probe;

static probe probe_at(const pls_posed *a, const pls_posed *b, pls_vec3 x)
{
    probe p = {.x = x, .a = pls_posed_sdf(a, x), .b = pls_posed_sdf(b, x), .ga = pls_posed_gradient(a, x), .gb = pls_posed_gradient(b, x)};
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

static pls_vec3 across(pls_vec3 v, pls_vec3 n) { return pls_sub(v, pls_scale(n, pls_dot(v, n))); }

static void answer(const probe *p, pls_overlap *out)
{
    out->delta = -p->f;
    out->normal = p->n;
    out->on_a = pls_sub(p->x, pls_scale(p->ga, p->a));
    out->on_b = pls_sub(p->x, pls_scale(p->gb, p->b));
}

void pls_sdf_depth_bfgs(const pls_posed *a, const pls_posed *b, pls_vec3 middle, pls_sdf_state *state, int most, pls_overlap *out)
{
    double scale = a->size * b->size / (a->size + b->size), m[6];
    bool known = state->inverse[0] + state->inverse[1] + state->inverse[2] > 0.0;
    for (int k = 0; k < 6; ++k) m[k] = known ? state->inverse[k] : k < 3 ? scale : 0.0;
    probe now = probe_at(a, b, known ? pls_posed_world(a, state->x) : middle);
    *out = (pls_overlap){.converged = false};
    for (int k = 0; k < most; ++k)
    {
        out->iterations = k;
        if (pls_length(now.g) < flat)
        {
            out->converged = true;
            break;
        }
        pls_vec3 side = across(pls_scale(times(m, now.g), -1.0), now.n), centre = pls_scale(now.n, 0.5 * (now.b - now.a));
        double down = pls_dot(now.g, side), take = 1.0;
        if (!(down < 0.0)) side = pls_scale(across(now.g, now.n), -scale), down = pls_dot(now.g, side);
        probe next = now;
        for (int halving = 0; halving < 20; ++halving, take *= 0.5)
        {
            next = probe_at(a, b, pls_add(now.x, pls_add(pls_scale(side, take), centre)));
            if (next.f <= now.f + 1e-4 * take * down) break;
        }
        update(m, pls_sub(next.x, now.x), pls_sub(next.g, now.g));
        bool still = pls_length(pls_sub(next.x, now.x)) < 1e-15 * a->size;
        now = next;
        if (still) break;
    }
    answer(&now, out);
    state->x = pls_posed_own(a, now.x);
    for (int k = 0; k < 6; ++k) state->inverse[k] = m[k];
}

/// The nearest point of a shape. False: x is inside.
static bool foot(const pls_posed *p, pls_vec3 x, pls_vec3 *out)
{
    double phi = pls_posed_sdf(p, x);
    if (!(phi > 0.0)) return false;
    *out = pls_sub(x, pls_scale(pls_posed_gradient(p, x), phi));
    return true;
}

/// The last point and step of the map b -> T(b) that the projections are, for Anderson's mixing (J. ACM 12, 1965) of two.
typedef struct mixing
{
    bool known;
    pls_vec3 image, residual;
} mixing;

/// Where to go on from b and its image: on the line through both images, where the residual would be least.
static pls_vec3 mix(mixing *m, pls_vec3 b, pls_vec3 image)
{
    static const double furthest = 50.0; // times the last step
    pls_vec3 residual = pls_sub(image, b), change = pls_sub(residual, m->residual), next = image;
    double square = pls_dot(change, change), share = m->known && square > 0.0 ? pls_dot(residual, change) / square : 0.0;
    if (fabs(share) < furthest) next = pls_sub(image, pls_scale(pls_sub(image, m->image), share));
    *m = (mixing){.known = true, .image = image, .residual = residual};
    return next;
}

void pls_sdf_depth_projections(const pls_posed *a, const pls_posed *b, pls_vec3 normal, double delta, pls_vec3 on_b, int most,
                               pls_overlap *out)
{
    const double size = fmin(a->size, b->size);
    double push = pushed * size;
    mixing memory = {.known = false};
    pls_vec3 from = on_b;
    *out = (pls_overlap){.delta = delta, .normal = normal, .on_b = on_b};
    for (int k = 0; k < most; ++k)
    {
        out->iterations = k + 1;
        pls_vec3 s = pls_scale(out->normal, fmax(out->delta, 0.0) + push), on_a;
        if (!foot(a, pls_add(from, s), &on_a) || !foot(b, pls_sub(on_a, s), &on_b)) // not yet apart
        {
            push += 0.5 * size;
            continue;
        }
        pls_vec3 n = pls_unit(pls_sub(pls_add(on_b, s), on_a));
        double turned = pls_length(pls_sub(n, out->normal)), last = out->delta;
        out->on_a = on_a, out->on_b = on_b, out->normal = n;
        out->delta = pls_dot(n, pls_sub(on_a, on_b));
        // The map stands still as well: mixed points may leave n as it is on the way.
        double moved = pls_length(pls_sub(on_b, from));
        if (turned < settled && moved < settled * push && fabs(out->delta - last) < 1e-12 * size)
        {
            out->converged = true;
            return;
        }
        from = mix(&memory, from, on_b);
    }
}
