// touch_area.c -- four points that stand for an area of touch.

#include "contact/touch_area.h"

/// Two axes at right angles to the normal, and the moments of the spread along them.
static void spread_across(const pls_touch *t, pls_vec3 axis[2], double moment[3])
{
    const pls_vec3 n = t->normal;
    axis[0] = pls_unit(fabs(n.x) < fabs(n.y) ? pls_vec(0.0, n.z, -n.y) : pls_vec(-n.z, 0.0, n.x));
    axis[1] = pls_cross(n, axis[0]);
    const pls_vec3 turned[2] = {pls_second_along(t->spread, axis[0]), pls_second_along(t->spread, axis[1])};
    moment[0] = pls_dot(axis[0], turned[0]), moment[1] = pls_dot(axis[1], turned[1]), moment[2] = pls_dot(axis[0], turned[1]);
}

void pls_touch_corners(const pls_touch *touch, pls_vec3 corner[4])
{
    // Columns of the moments' Cholesky factor, times the root of two.
    pls_vec3 axis[2];
    double moment[3];
    spread_across(touch, axis, moment);
    const double first = sqrt(fmax(moment[0], 0.0)), most = sqrt(fmax(moment[1], 0.0));
    const double shared = first > 0.0 ? fmin(fmax(moment[2] / first, -most), most) : 0.0; // of a line it may be all rounding errors
    const double second = sqrt(fmax(moment[1] - shared * shared, 0.0));
    corner[0] = pls_scale(pls_add(pls_scale(axis[0], first), pls_scale(axis[1], shared)), M_SQRT2);
    corner[2] = pls_scale(axis[1], M_SQRT2 * second);
    corner[1] = pls_scale(corner[0], -1.0), corner[3] = pls_scale(corner[2], -1.0);
}
