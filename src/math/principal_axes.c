// principal_axes.c -- Jacobi rotations of a 3 x 3 tensor (Golub & Van Loan, Matrix Computations, section 8.5), eigenvectors kept.

#include "math/principal_axes.h"

#include <math.h>
#include <stdbool.h>

static void rotate(double a[3][3], double v[3][3], int p, int q)
{
    if (a[p][q] == 0.0) return;
    double theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    double t = (theta >= 0.0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(theta * theta + 1.0)), c = 1.0 / sqrt(t * t + 1.0), s = t * c;
    for (int k = 0; k < 3; ++k)
    {
        double x = a[k][p], y = a[k][q];
        a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 3; ++k)
    {
        double x = a[p][k], y = a[q][k];
        a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
        x = v[k][p], y = v[k][q];
        v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
    }
}

pls_quat pls_quat_of_axes(pls_vec3 x, pls_vec3 y, pls_vec3 z)
{
    // The largest of the four components first, so that nothing is divided by little.
    double trace = x.x + y.y + z.z;
    if (trace > 0.0)
    {
        double s = 2.0 * sqrt(trace + 1.0);
        return pls_quat_unit((pls_quat){0.25 * s, (y.z - z.y) / s, (z.x - x.z) / s, (x.y - y.x) / s});
    }
    if (x.x >= y.y && x.x >= z.z)
    {
        double s = 2.0 * sqrt(1.0 + x.x - y.y - z.z);
        return pls_quat_unit((pls_quat){(y.z - z.y) / s, 0.25 * s, (y.x + x.y) / s, (z.x + x.z) / s});
    }
    if (y.y >= z.z)
    {
        double s = 2.0 * sqrt(1.0 + y.y - x.x - z.z);
        return pls_quat_unit((pls_quat){(z.x - x.z) / s, (y.x + x.y) / s, 0.25 * s, (z.y + y.z) / s});
    }
    double s = 2.0 * sqrt(1.0 + z.z - x.x - y.y);
    return pls_quat_unit((pls_quat){(x.y - y.x) / s, (z.x + x.z) / s, (z.y + y.z) / s, 0.25 * s});
}

static pls_vec3 column(double v[3][3], int c, double sign) { return pls_vec(sign * v[0][c], sign * v[1][c], sign * v[2][c]); }

void pls_principal_axes(const double tensor[6], double value[3], pls_quat *rotation)
{
    double a[3][3] = {{tensor[0], tensor[3], tensor[4]}, {tensor[3], tensor[1], tensor[5]}, {tensor[4], tensor[5], tensor[2]}};
    double v[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    for (int sweep = 0; sweep < 40; ++sweep)
    {
        if (fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]) <= 1e-17 * (fabs(a[0][0]) + fabs(a[1][1]) + fabs(a[2][2]))) break;
        rotate(a, v, 0, 1);
        rotate(a, v, 0, 2);
        rotate(a, v, 1, 2);
    }
    // Of the 24 right-handed orders and signs the one with the largest trace turns least.
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    double best = -INFINITY;
    for (int o = 0; o < 6; ++o)
        for (int signs = 0; signs < 4; ++signs)
        {
            double sx = signs & 1 ? -1.0 : 1.0, sy = signs & 2 ? -1.0 : 1.0;
            pls_vec3 x = column(v, order[o][0], sx), y = column(v, order[o][1], sy), z = pls_cross(x, y);
            double trace = x.x + y.y + z.z;
            if (!(trace > best)) continue;
            best = trace;
            for (int k = 0; k < 3; ++k) value[k] = a[order[o][k]][order[o][k]];
            *rotation = pls_quat_of_axes(x, y, z);
        }
}
