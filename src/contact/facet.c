// facet.c -- the prism that a triangle or segment of a wall stands for.

#include "contact/facet.h"

int pls_facet_prism(const pls_posed *p, pls_vec3 origin, pls_vec3 centre, pls_half_space plane[4])
{
    const pls_polytope *t = p->shape->polytope;
    const int corners = p->shape->dimension;
    pls_vec3 x[3] = {{0.0, 0.0, 0.0}}, middle = {0.0, 0.0, 0.0};
    for (int k = 0; k < corners; ++k)
    {
        x[k] = pls_sub(pls_posed_world(p, t->vertex[k]), origin);
        middle = pls_add(middle, pls_scale(x[k], 1.0 / corners));
    }
    if (corners == 2) x[2] = pls_add(x[0], pls_vec(0.0, 0.0, 1.0));
    pls_vec3 front = pls_unit(pls_cross(pls_sub(x[1], x[0]), pls_sub(x[2], x[0])));
    if (pls_dot(front, pls_sub(pls_sub(centre, origin), x[0])) < 0.0) front = pls_scale(front, -1.0);
    plane[0] = (pls_half_space){front, pls_dot(front, x[0]) + p->shape->margin * p->scale};
    for (int k = 0; k < corners; ++k)
    {
        const pls_vec3 along = corners == 2 ? pls_vec(0.0, 0.0, 1.0) : pls_sub(x[(k + 1) % 3], x[k]);
        pls_vec3 side = pls_unit(pls_cross(along, front));
        if (pls_dot(side, pls_sub(middle, x[k])) > 0.0) side = pls_scale(side, -1.0);
        plane[1 + k] = (pls_half_space){side, pls_dot(side, x[k])};
    }
    return 1 + corners;
}
