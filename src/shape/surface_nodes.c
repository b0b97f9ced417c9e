// surface_nodes.c -- points evenly spread over the surface of anything given by an SDF.
//
// Points at random in a thin layer outside of the surface, brought down to it, cover it evenly but for chance; of many times more than wanted the nodes are chosen one
// after the other, each the furthest from all before (Gonzalez, Theor. Comput. Sci. 38, 1985): no two nodes are closer than the widest gap that is left. From outside,
// where the SDF is a true distance, one step leads to the surface, concave places and holes included.

#include <particls/shape.h>

#include "base/alloc.h"
#include "base/random.h"

enum {
    CHOICE = 16,       ///< points per node to choose from
    MOST_DRAWS = 20000 ///< per point
};
static const double layer = 0.02; ///< thickness, of the size

static pls_vec3 draw(const pls_shape *shape, pls_random *random, double beyond)
{
    double u[3];
    for (int a = 0; a < 3; ++a) u[a] = pls_random_uniform(random);
    const pls_vec3 low = shape->lower, edge = pls_sub(shape->upper, low);
    return pls_vec(low.x - beyond + u[0] * (edge.x + 2.0 * beyond), low.y - beyond + u[1] * (edge.y + 2.0 * beyond),
                   shape->dimension == 2 ? 0.0 : low.z - beyond + u[2] * (edge.z + 2.0 * beyond));
}

static pls_status fill_candidates(const pls_shape *shape, size_t count, pls_vec3 *candidate)
{
    pls_random random = pls_random_stream(1, 0, PLS_FOR_POSITION);
    const double beyond = layer * pls_length(pls_sub(shape->upper, shape->lower));
    for (size_t k = 0; k < count; ++k)
    {
        int tries = 0;
        for (; tries < MOST_DRAWS; ++tries)
        {
            pls_vec3 X = draw(shape, &random, beyond);
            double phi = pls_shape_sdf(shape, X);
            if (!(phi > 0.0 && phi < beyond)) continue;
            candidate[k] = pls_shape_nearest(shape, X);
            break;
        }
        if (tries == MOST_DRAWS)
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "no point of the surface of a '%s' was found in %d tries: it is too small a part of its bounds",
                            shape->ops->name, MOST_DRAWS);
    }
    return PLS_OK;
}

/// Choose `count` of the candidates; `apart` holds the squared distance of each from the nearest node so far.
static void choose(const pls_vec3 *candidate, double *apart, size_t candidates, pls_vec3 *nodes, size_t count)
{
    size_t next = 0;
    for (size_t k = 0; k < candidates; ++k) apart[k] = INFINITY;
    for (size_t n = 0; n < count; ++n)
    {
        nodes[n] = candidate[next];
        double most = -1.0;
        for (size_t k = 0; k < candidates; ++k)
        {
            pls_vec3 d = pls_sub(candidate[k], nodes[n]);
            apart[k] = fmin(apart[k], pls_dot(d, d));
            if (apart[k] > most) most = apart[k], next = k;
        }
    }
}

pls_status pls_shape_surface_nodes(const pls_shape *shape, size_t count, pls_vec3 *nodes)
{
    if (shape->ops->unbounded)
        return pls_fail(PLS_INVALID_ARGUMENT, "the surface of an unbounded '%s' has no end, so it cannot be filled with nodes",
                        shape->ops->name);
    if (count > SIZE_MAX / CHOICE) return pls_fail(PLS_LIMIT_EXCEEDED, "%zu surface nodes are too many", count);
    const size_t candidates = CHOICE * count;
    pls_vec3 *candidate = NULL;
    double *apart = NULL;
    PLS_TRY(pls_allocate(&candidate, candidates, sizeof *candidate, "surface nodes"));
    pls_status status = pls_allocate(&apart, candidates, sizeof *apart, "surface nodes");
    if (status == PLS_OK) status = fill_candidates(shape, candidates, candidate);
    if (status == PLS_OK) choose(candidate, apart, candidates, nodes, count);
    pls_release(&apart);
    pls_release(&candidate);
    return status;
}
