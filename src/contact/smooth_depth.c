// smooth_depth.c -- Newton's method on the sphere of normals.
//
// With support functions h the overlap along n is F(n) = h_A(n) + h_B(-n); the penetration depth is its least value over unit n, and in a gap minus the distance:
// one problem for both. F has the gradient g = P (s_A(n) - s_B(-n)) on the tangent plane (P projects on it) and the second derivative P (H_A + H_B) P - F P, with
// H the derivatives of support points. Two unknowns in the plane, one in 2D. Warm it takes two or three iterations.

#include "contact/smooth_depth.h"

static const double tolerance = 1e-10; ///< of the size, on |g|
static const double longest = 0.5;     ///< step [rad]
enum { MOST = 60, HALVINGS = 30 };

typedef struct trial
{
    pls_vec3 n, on_a, on_b, apart; ///< apart = on_a - on_b
    double f;
} trial;

static trial try_normal(const pls_posed *a, const pls_posed *b, pls_vec3 n)
{
    trial t = {.n = n, .on_a = pls_posed_support(a, n), .on_b = pls_posed_support(b, pls_scale(n, -1.0))};
    t.apart = pls_sub(t.on_a, t.on_b);
    t.f = pls_dot(t.apart, n);
    return t;
}

void pls_add_support_curvature(const pls_posed *p, pls_vec3 n, const pls_vec3 e[2], double h[3])
{
    double d[6];
    p->shape->ops->support_gradient(p->shape, pls_posed_turn_back(p, n), d);
    pls_vec3 u = pls_posed_turn_back(p, e[0]), v = pls_posed_turn_back(p, e[1]);
    pls_vec3 du = pls_vec(d[0] * u.x + d[3] * u.y + d[4] * u.z, d[3] * u.x + d[1] * u.y + d[5] * u.z, d[4] * u.x + d[5] * u.y + d[2] * u.z);
    pls_vec3 dv = pls_vec(d[0] * v.x + d[3] * v.y + d[4] * v.z, d[3] * v.x + d[1] * v.y + d[5] * v.z, d[4] * v.x + d[5] * v.y + d[2] * v.z);
    double margin = p->shape->margin;
    h[0] += p->scale * (pls_dot(u, du) + margin);
    h[1] += p->scale * pls_dot(u, dv);
    h[2] += p->scale * (pls_dot(v, dv) + margin);
}

void pls_tangents(pls_vec3 n, int dimension, pls_vec3 e[2])
{
    pls_vec3 off = dimension == 2 || fabs(n.z) < 0.7 ? pls_vec(0.0, 0.0, 1.0) : pls_vec(1.0, 0.0, 0.0);
    e[0] = pls_unit(pls_cross(off, n));
    e[1] = pls_cross(n, e[0]);
}

/// Newton's step in the tangent plane; where the second derivative is not positive, a step down the gradient at its scale.
static void newton_step(const double h[3], const double g[2], int dimension, double step[2])
{
    step[1] = 0.0;
    if (dimension == 2)
    {
        step[0] = -g[0] / fmax(fabs(h[0]), 1e-300);
        return;
    }
    double mean = 0.5 * (h[0] + h[2]), half = 0.5 * (h[0] - h[2]), radius = sqrt(half * half + h[1] * h[1]);
    double large = mean + radius, small = mean - radius, least = 1e-8 * (fabs(large) + fabs(small)) + 1e-300;
    if (small > least)
    {
        double determinant = large * small;
        step[0] = -(h[2] * g[0] - h[1] * g[1]) / determinant;
        step[1] = -(h[0] * g[1] - h[1] * g[0]) / determinant;
        return;
    }
    // Eigenvalues are taken by magnitude, so that the step always goes down.
    double angle = radius > 0.0 ? 0.5 * atan2(h[1], half) : 0.0, c = cos(angle), s = sin(angle); // eigenvector of `large`
    double gl = c * g[0] + s * g[1], gs = -s * g[0] + c * g[1];
    double dl = -gl / fmax(fabs(large), least), ds = -gs / fmax(fabs(small), least);
    step[0] = c * dl - s * ds;
    step[1] = s * dl + c * ds;
}

void pls_smooth_depth(const pls_posed *a, const pls_posed *b, pls_vec3 normal, pls_overlap *out)
{
    const int dimension = a->shape->dimension;
    const double enough = tolerance * fmin(a->size, b->size);
    trial now = try_normal(a, b, normal);
    *out = (pls_overlap){.converged = false};
    for (int k = 0; k < MOST; ++k)
    {
        pls_vec3 e[2];
        pls_tangents(now.n, dimension, e);
        double g[2] = {pls_dot(now.apart, e[0]), dimension == 2 ? 0.0 : pls_dot(now.apart, e[1])}, h[3] = {-now.f, 0.0, -now.f}, step[2];
        out->iterations = k;
        double slope = sqrt(g[0] * g[0] + g[1] * g[1]);
        if (slope < enough)
        {
            out->converged = true;
            break;
        }
        pls_add_support_curvature(a, now.n, e, h);
        pls_add_support_curvature(b, pls_scale(now.n, -1.0), e, h);
        newton_step(h, g, dimension, step);
        double length = sqrt(step[0] * step[0] + step[1] * step[1]), take = length > longest ? longest / length : 1.0;
        double down = g[0] * step[0] + g[1] * step[1]; // negative
        trial next = now;
        int halving = 0;
        for (; halving < HALVINGS; ++halving, take *= 0.5)
        {
            pls_vec3 d = pls_add(pls_scale(e[0], take * step[0]), pls_scale(e[1], take * step[1]));
            next = try_normal(a, b, pls_unit(pls_add(now.n, d)));
            if (next.f <= now.f + 1e-4 * take * down + 1e-15 * a->size) break;
        }
        if (halving == HALVINGS)
        {
            out->converged = slope < 1e3 * enough; // as far as round-off lets it go
            break;
        }
        now = next;
    }
    out->delta = now.f;
    out->normal = now.n;
    out->on_a = now.on_a;
    out->on_b = now.on_b;
}
