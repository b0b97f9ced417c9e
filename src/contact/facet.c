// facet.c -- the prism that a triangle or segment of a wall stands for, and on which side of it somebody is.

#include "contact/facet.h"

// ---- sides ------------------------------------------------------------------------------------------------------------------------------------------------

/// The point of a side (from p to q) nearest to X: along it from 0 to 1.
static double nearest_along(pls_vec3 p, pls_vec3 q, pls_vec3 X)
{
    const pls_vec3 e = pls_sub(q, p);
    return fmin(fmax(pls_dot(pls_sub(X, p), e) / pls_dot(e, e), 0.0), 1.0);
}

static pls_facet_view view(pls_vec3 from, pls_vec3 normal, bool at_rim)
{
    return (pls_facet_view){pls_dot(from, from), pls_dot(from, normal) < 0.0 ? -1.0 : 1.0, at_rim};
}

static bool is_free(const pls_facet *f, int k) { return f->neighbour[k] == PLS_NO_FACET; }

static pls_facet_view of_segment(const pls_facet *f, const pls_vec3 *v, pls_vec3 X)
{
    const double s = nearest_along(v[0], v[1], X);
    if (s > 0.0 && s < 1.0) return view(pls_sub(X, pls_add(v[0], pls_scale(pls_sub(v[1], v[0]), s))), f->normal, false);
    const int k = s > 0.0;
    return view(pls_sub(X, v[k]), f->side_normal[k], is_free(f, k));
}

static pls_facet_view of_triangle(const pls_facet *f, const pls_vec3 *v, pls_vec3 X)
{
    pls_facet_view best = {INFINITY, 1.0, false};
    bool over = true;
    for (int k = 0; k < 3; ++k)
    {
        const pls_vec3 p = v[k], q = v[(k + 1) % 3];
        if (pls_dot(pls_cross(pls_sub(q, p), pls_sub(X, p)), f->normal) >= 0.0) continue; // on the inner side
        over = false;
        const double s = nearest_along(p, q, X);
        const int at = s <= 0.0 ? k : s >= 1.0 ? (k + 1) % 3 : -1; // corner
        const pls_vec3 normal = at < 0 ? f->side_normal[k] : f->corner_normal[at], x = pls_add(p, pls_scale(pls_sub(q, p), s));
        const bool rim = is_free(f, k) || (at >= 0 && is_free(f, (at + 2) % 3)) || (at >= 0 && is_free(f, at));
        const pls_facet_view now = view(pls_sub(X, x), normal, rim);
        if (now.distance < best.distance) best = now;
    }
    return over ? view(pls_scale(f->normal, pls_dot(pls_sub(X, v[0]), f->normal)), f->normal, false) : best;
}

pls_facet_view pls_facet_seen_from(const pls_posed *facet, const pls_facet *seams, pls_vec3 X)
{
    const pls_vec3 *v = facet->shape->polytope->vertex, own = pls_posed_own(facet, X);
    pls_facet_view seen = facet->shape->dimension == 2 ? of_segment(seams, v, own) : of_triangle(seams, v, own);
    seen.distance *= facet->scale * facet->scale;
    return seen;
}

// ---- joints -----------------------------------------------------------------------------------------------------------------------------------------------

static const double one_place = 1e-6; ///< of the smaller facet: corners nearer than this are one

static pls_vec3 corner_at(const pls_posed *p, int k) { return pls_posed_world(p, p->shape->polytope->vertex[k % p->shape->dimension]); }

static bool at_one_place(const pls_posed *a, int k, const pls_posed *b, int j)
{
    const double most = one_place * fmin(a->size, b->size);
    const pls_vec3 p = corner_at(a, k), q = corner_at(b, j);
    if (a->shape->dimension == 2) return pls_length(pls_sub(p, q)) < most;
    const pls_vec3 r = corner_at(a, k + 1), s = corner_at(b, j + 1);
    return fmin(pls_length(pls_sub(p, q)) + pls_length(pls_sub(r, s)), pls_length(pls_sub(p, s)) + pls_length(pls_sub(r, q))) < most;
}

int pls_facet_join_posed(const pls_posed *facet, pls_facet *seams, const pls_posed *other)
{
    const pls_facet *beyond = pls_shape_facet(other->shape);
    const int sides = facet->shape->dimension;
    for (int k = 0; k < sides; ++k)
        for (int j = 0; j < sides && seams->neighbour[k] == PLS_NO_FACET; ++j)
        {
            if (beyond->neighbour[j] != PLS_NO_FACET || !at_one_place(facet, k, other, j)) continue;
            const pls_vec3 on = pls_posed_turn_back(facet, pls_posed_turn(other, pls_scale(beyond->side[j], -1.0)));
            pls_facet_join(seams, k, beyond->number, on, pls_dot(seams->normal, beyond->normal) > PLS_LEVEL_FACETS);
            return k;
        }
    return -1;
}

// ---- the prism --------------------------------------------------------------------------------------------------------------------------------------------

static const double bevelled = 0.02;       ///< bend from which raised faces are [rad]
static const double almost_level = 0.9998; ///< its cosine

static void add_plane(pls_prism *p, pls_vec3 normal, pls_vec3 through, double raised)
{
    p->plane[p->planes++] = (pls_half_space){normal, pls_dot(normal, through) + raised};
}

/// Cuts the corner between two raised planes, from where the one touches the round edge to where the other does.
static void add_bevel(pls_prism *p, pls_vec3 one, pls_vec3 other, pls_vec3 through, double raised)
{
    const pls_vec3 middle = pls_add(one, other);
    const double length = pls_length(middle);
    if (raised > 0.0 && length > 1e-3) add_plane(p, pls_scale(middle, 1.0 / length), through, 0.5 * length * raised);
}

pls_prism pls_facet_prism(const pls_posed *facet, const pls_facet *f, pls_vec3 origin, double front, double margin)
{
    const pls_vec3 start = pls_sub(facet->position, origin);
    const int sides = facet->shape->dimension;
    const double raised = margin + facet->shape->margin * facet->scale;
    pls_vec3 corner[3], side[3];
    for (int k = 0; k < sides; ++k)
    {
        corner[k] = pls_add(start, pls_scale(pls_posed_turn(facet, facet->shape->polytope->vertex[k]), facet->scale));
        side[k] = pls_posed_turn(facet, f->side[k]);
    }
    const pls_vec3 n = pls_scale(pls_posed_turn(facet, f->normal), front);
    pls_prism p = {.planes = 0};
    add_plane(&p, n, corner[0], raised);
    for (int k = 0; k < sides; ++k)
    {
        const bool free = f->neighbour[k] == PLS_NO_FACET;
        const double bend = f->bend[k] * front;
        if (free) add_plane(&p, side[k], corner[k], raised);
        if (free) add_bevel(&p, n, side[k], corner[k], raised);
        if (free || f->leans[k] || !(bend > bevelled)) continue;
        // The other front: this one mirrored at the plane between the two.
        add_bevel(&p, n, pls_sub(n, pls_scale(side[k], 2.0 * pls_dot(n, side[k]))), corner[k], raised);
    }
    for (int k = 0; k < sides; ++k) // of corners likewise
    {
        const double level = f->corner_level[k];
        if (!(raised > 0.0) || f->corner_form[k] * front <= 0.0 || sides == 2 || !(level > 0.0) || level > almost_level) continue;
        add_plane(&p, pls_scale(pls_posed_turn(facet, f->corner_normal[k]), front), corner[k], level * raised);
    }
    p.faces = p.planes;
    for (int k = 0; k < sides; ++k)
        if (f->neighbour[k] != PLS_NO_FACET && !pls_seam_is_valley(f, k, front)) add_plane(&p, side[k], corner[k], 0.0);
    const double reach = f->reach[front < 0.0] * facet->scale;
    if (isfinite(reach)) add_plane(&p, pls_scale(n, -1.0), corner[0], reach);
    return p;
}
