// facet.c -- the prism that a triangle or segment of a wall stands for, and on which side of it somebody is.

#include "contact/facet.h"

// ---- sides ------------------------------------------------------------------------------------------------------------------------------------------------

/// The point of a side (from p to q) nearest to X: along it from 0 to 1.
static double nearest_along(pls_vec3 p, pls_vec3 q, pls_vec3 X)
{
    const pls_vec3 e = pls_sub(q, p);
    return fmin(fmax(pls_dot(pls_sub(X, p), e) / pls_dot(e, e), 0.0), 1.0);
}

static pls_facet_view view(pls_vec3 from, pls_vec3 normal)
{
    return (pls_facet_view){pls_dot(from, from), pls_dot(from, normal) < 0.0 ? -1.0 : 1.0};
}

static pls_facet_view of_segment(const pls_facet *f, const pls_vec3 *v, pls_vec3 X)
{
    const double s = nearest_along(v[0], v[1], X);
    if (s > 0.0 && s < 1.0) return view(pls_sub(X, pls_add(v[0], pls_scale(pls_sub(v[1], v[0]), s))), f->normal);
    const int k = s > 0.0;
    return view(pls_sub(X, v[k]), f->side_normal[k]);
}

static pls_facet_view of_triangle(const pls_facet *f, const pls_vec3 *v, pls_vec3 X)
{
    pls_facet_view best = {INFINITY, 1.0};
    bool over = true;
    for (int k = 0; k < 3; ++k)
    {
        const pls_vec3 p = v[k], q = v[(k + 1) % 3];
        if (pls_dot(pls_cross(pls_sub(q, p), pls_sub(X, p)), f->normal) >= 0.0) continue; // on the inner side
        over = false;
        const double s = nearest_along(p, q, X);
        const pls_vec3 normal = s <= 0.0 ? f->corner_normal[k] : s >= 1.0 ? f->corner_normal[(k + 1) % 3] : f->side_normal[k];
        const pls_facet_view now = view(pls_sub(X, pls_add(p, pls_scale(pls_sub(q, p), s))), normal);
        if (now.distance < best.distance) best = now;
    }
    return over ? view(pls_scale(f->normal, pls_dot(pls_sub(X, v[0]), f->normal)), f->normal) : best;
}

pls_facet_view pls_facet_seen_from(const pls_posed *facet, const pls_facet *seams, pls_vec3 X)
{
    const pls_vec3 *v = facet->shape->polytope->vertex, own = pls_posed_own(facet, X);
    pls_facet_view seen = facet->shape->dimension == 2 ? of_segment(seams, v, own) : of_triangle(seams, v, own);
    seen.distance *= facet->scale * facet->scale;
    return seen;
}

// ---- joints -----------------------------------------------------------------------------------------------------------------------------------------------

static const double one_place = 1e-9; ///< of the smaller facet: corners nearer than this are one

static pls_vec3 corner_at(const pls_posed *p, int k) { return pls_posed_world(p, p->shape->polytope->vertex[k % p->shape->dimension]); }

static bool at_one_place(const pls_posed *a, int k, const pls_posed *b, int j)
{
    const double most = one_place * fmin(a->size, b->size);
    const pls_vec3 p = corner_at(a, k), q = corner_at(b, j);
    if (a->shape->dimension == 2) return pls_length(pls_sub(p, q)) < most;
    const pls_vec3 r = corner_at(a, k + 1), s = corner_at(b, j + 1);
    return fmin(pls_length(pls_sub(p, q)) + pls_length(pls_sub(r, s)), pls_length(pls_sub(p, s)) + pls_length(pls_sub(r, q))) < most;
}

int pls_facet_join_posed(const pls_posed *facet, pls_facet *seams, const pls_posed *other, uint32_t neighbour)
{
    const pls_facet *beyond = pls_shape_facet(other->shape);
    const int sides = facet->shape->dimension;
    for (int k = 0; k < sides; ++k)
        for (int j = 0; j < sides && seams->neighbour[k] == PLS_NO_FACET; ++j)
        {
            if (beyond->neighbour[j] != PLS_NO_FACET || !at_one_place(facet, k, other, j)) continue;
            const pls_vec3 on = pls_posed_turn_back(facet, pls_posed_turn(other, pls_scale(beyond->side[j], -1.0)));
            pls_facet_join(seams, k, neighbour, on, pls_dot(seams->normal, beyond->normal) > PLS_LEVEL_FACETS);
            return k;
        }
    return -1;
}

// ---- the prism --------------------------------------------------------------------------------------------------------------------------------------------

pls_prism pls_facet_prism(const pls_posed *facet, const pls_facet *f, pls_vec3 origin, double front)
{
    const pls_vec3 *v = facet->shape->polytope->vertex, start = pls_sub(facet->position, origin);
    const double margin = facet->shape->margin * facet->scale;
    pls_vec3 n = pls_scale(pls_posed_turn(facet, f->normal), front);
    pls_prism p = {.faces = 1, .planes = 1};
    p.plane[0] = (pls_half_space){n, pls_dot(n, pls_add(start, pls_scale(pls_posed_turn(facet, v[0]), facet->scale))) + margin};
    for (int joined = 0; joined < 2; ++joined)
        for (int k = 0; k < facet->shape->dimension; ++k)
        {
            const bool free = f->neighbour[k] == PLS_NO_FACET;
            if (free == joined || (joined && pls_seam_is_valley(f, k, front))) continue;
            n = pls_posed_turn(facet, f->side[k]);
            const double offset = pls_dot(n, pls_add(start, pls_scale(pls_posed_turn(facet, v[k]), facet->scale)));
            p.plane[p.planes++] = (pls_half_space){n, offset + (free ? margin : 0.0)};
            p.faces += free;
        }
    return p;
}
