// star_quadrature.c -- moments of a shape that each ray from the origin leaves once, by quadrature over directions.
//
// Through a square of a cube's face pass the rays s (u e1 + v e2 + e3); each leaves the shape at one s(u, v), found as a root of phi, and the moments are integrals over
// u and v of powers of s. For smooth shapes s is smooth, and Gauss's rule converges quickly: a few thousand rays where columns need a hundred thousand.

#include "shape/star_quadrature.h"

enum { FINER = 6, COARSER = 5 };
static const double finer_node[FINER] = {-0.9324695142031521, -0.6612093864662645, -0.2386191860831969,
                                         0.2386191860831969,  0.6612093864662645,  0.9324695142031521};
static const double finer_weight[FINER] = {0.1713244923791704, 0.3607615730481386, 0.4679139345726910,
                                           0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
static const double coarser_node[COARSER] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
static const double coarser_weight[COARSER] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                               0.2369268850561891};
static const double sharpness = 1e-13; ///< of the ends of rays, of the reach

/// Where phi(s d) is 0: between the origin, inside, and the reach, from near `guess`. Regula falsi with Anderson and Bjorck's weights, halving where that is slow.
static double leave(const pls_column_frame *frame, const double d[3], double inside, double guess)
{
    const double enough = sharpness * frame->reach;
    double a = 0.0, fa = inside, b = guess, fb = 0.0;
    for (int k = 0; k < 100; ++k)
    {
        const double x[3] = {b * d[0], b * d[1], b * d[2]};
        fb = pls_column_phi(frame, x);
        if (fb >= 0.0) break;
        if (fb > -enough) return b;
        a = b, fa = fb;
        b += fmax(-1.2 * fb, 1e-9 * frame->reach); // no surface is nearer than |phi|
    }
    for (int k = 0; k < 100 && fabs(b - a) > enough && fabs(fb) > enough; ++k)
    {
        double t = k % 8 == 7 ? 0.5 * (a + b) : (a * fb - b * fa) / (fb - fa);
        const double x[3] = {t * d[0], t * d[1], t * d[2]};
        double ft = pls_column_phi(frame, x);
        if ((ft < 0.0) != (fb < 0.0))
            a = b, fa = fb;
        else
        {
            double m = 1.0 - ft / fb;
            fa *= m > 0.0 ? m : 0.5;
        }
        b = t, fb = ft;
    }
    return b;
}

static void add_ray(const double d[3], double s, double weight, double sum[PLS_MOMENTS])
{
    double third = weight * s * s * s / 3.0, fourth = weight * s * s * s * s / 4.0, fifth = weight * s * s * s * s * s / 5.0;
    sum[0] += third;
    for (int a = 0; a < 3; ++a) sum[1 + a] += fourth * d[a], sum[4 + a] += fifth * d[a] * d[a];
    sum[7] += fifth * d[0] * d[1], sum[8] += fifth * d[0] * d[2], sum[9] += fifth * d[1] * d[2];
}

static void by_rule(const pls_column_frame *frame, int face, const double centre[2], double half, int points, const double *node,
                    const double *weight, double *guess, double sum[PLS_MOMENTS])
{
    const double origin[3] = {0.0, 0.0, 0.0}, inside = pls_column_phi(frame, origin);
    const int up = face / 2;
    for (int k = 0; k < PLS_MOMENTS; ++k) sum[k] = 0.0;
    for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j)
        {
            double d[3];
            d[up] = face & 1 ? 1.0 : -1.0;
            d[(up + 1) % 3] = centre[0] + half * node[i];
            d[(up + 2) % 3] = centre[1] + half * node[i & 1 ? points - 1 - j : j]; // to and fro, so that each ray ends near the one before
            *guess = leave(frame, d, inside, *guess);
            add_ray(d, *guess, half * half * weight[i] * weight[j], sum);
        }
}

void pls_star_moments(const pls_column_frame *frame, int face, const double centre[2], double half, double sum[PLS_MOMENTS],
                      double again[PLS_MOMENTS])
{
    double guess = 0.5 * frame->reach;
    by_rule(frame, face, centre, half, FINER, finer_node, finer_weight, &guess, sum);
    by_rule(frame, face, centre, half, COARSER, coarser_node, coarser_weight, &guess, again);
}
