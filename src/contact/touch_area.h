// touch_area.h -- the area (or line) over which two bodies touch: force and point alone do not tell how they rub and damp when they turn on each other.
#ifndef PLS_CONTACT_TOUCH_AREA_H
#define PLS_CONTACT_TOUCH_AREA_H

#include "contact/narrow_phase.h"

/// Mean distance from the middle over the radius of gyration, of a disc and of a line that are evenly pressed.
#define PLS_ARM_OF_DISC 0.94280904158206336
#define PLS_ARM_OF_LINE 0.86602540378443865

static inline bool pls_touch_is_point(const pls_touch *t) { return t->spread[0] == 0.0 && t->spread[1] == 0.0 && t->spread[2] == 0.0; }

/// X moved along the normal into the plane of touch, that of the normal force.
static inline pls_vec3 pls_in_plane_of_touch(const pls_touch *t, pls_vec3 X)
{
    const pls_vec3 apart = pls_sub(X, t->point);
    return pls_add(t->point, pls_sub(apart, pls_scale(t->normal, pls_dot(apart, t->normal))));
}

/// S n of a symmetric S: xx, yy, zz, xy, xz, yz.
static inline pls_vec3 pls_second_along(const double s[6], pls_vec3 n)
{
    return pls_vec(s[0] * n.x + s[3] * n.y + s[4] * n.z, s[3] * n.x + s[1] * n.y + s[5] * n.z, s[4] * n.x + s[5] * n.y + s[2] * n.z);
}

/// Four points, a quarter of the area each, that have its second moments: from `touch->point`, opposite ones in turn.
void pls_touch_corners(const pls_touch *touch, pls_vec3 corner[4]);

#endif
