// wall_touch.c -- the contact of a body with some facets of a wall.
//
// Behind the facets lies a field, the depth below the surface: each facet has that of its prism (facet.h). Energies and forces are integrals over what of the body is there, as in
// faces.c; they add up, and the laws act on the sums. So a box over a seam of two triangles rests on one spring, not on two; it passes the seam without a jump, as what comes to
// the one comes off the other; and the edge of a table of triangles pushes as that of a box.
//
// Bodies that are not convex have no side of the wall: there the facets are what is in the body (sampled_touch.c), and each patch is a sum of its own.
//
// Of rounded bodies the core counts, in the field behind fronts that are raised by the margin. Over level places that is the same; over a ridge the raised fronts meet in a bevel,
// not in a round edge.

#include "contact/wall_touch.h"

#include "contact/cylinder_touch.h"
#include "contact/faces.h"
#include "contact/lines.h"
#include "contact/overlap_laws.h"
#include "contact/sampled_touch.h"

enum kind { NONE, FACES, CYLINDER, LINE, PIECES, SHEET };

static enum kind kind_of(const pls_posed *a, const pls_posed *facet)
{
    if (pls_is_sheet_pair(a->shape, facet->shape)) return SHEET;
    if (a->shape->sample && pls_is_sampled_pair(a->shape, facet->shape)) return PIECES;
    if (pls_has_faces(a->shape)) return FACES;
    if (pls_is_thick_cylinder(a)) return CYLINDER;
    return pls_has_line(a->shape) ? LINE : NONE;
}

bool pls_is_wall_pair(const pls_posed *a, const pls_posed *facet, const pls_narrow_options *options)
{
    return options->faces != PLS_FACES_POINT && pls_is_facet(facet->shape) && kind_of(a, facet) != NONE;
}

bool pls_wall_needs_no_depth(const pls_posed *a, const pls_posed *facet)
{
    const enum kind kind = kind_of(a, facet);
    return kind == PIECES || kind == SHEET;
}

bool pls_wall_has_sides(const pls_posed *a, const pls_posed *facet) { return !pls_is_sheet_pair(a->shape, facet->shape); }

bool pls_wall_has_point(const pls_posed *a) { return pls_has_line(a->shape); }

// ---- sums -----------------------------------------------------------------------------------------------------------------------------------------------

static void move_push(pls_push *p, pls_vec3 by) { p->torque = pls_sub(p->torque, pls_cross(by, p->force)); }

/// Integrals about an origin that lies `by` further on.
static void move_origin(pls_overlap_integrals *P, pls_vec3 by)
{
    const pls_vec3 m = P->first, s = by;
    const double V = P->volume;
    const double change[6] = {V * s.x * s.x - 2.0 * s.x * m.x,       V * s.y * s.y - 2.0 * s.y * m.y,
                              V * s.z * s.z - 2.0 * s.z * m.z,       V * s.x * s.y - s.x * m.y - s.y * m.x,
                              V * s.x * s.z - s.x * m.z - s.z * m.x, V * s.y * s.z - s.y * m.z - s.z * m.y};
    for (int k = 0; k < 6; ++k) P->second[k] += change[k];
    P->first = pls_sub(m, pls_scale(s, V));
    P->area_moment = pls_sub(P->area_moment, P->scattered ? pls_scale(s, P->surface) : pls_cross(s, P->area));
    move_push(&P->by_depth, s), move_push(&P->by_its_square, s);
}

static void add_push(pls_push *to, const pls_push *p)
{
    to->energy += p->energy, to->force = pls_add(to->force, p->force), to->torque = pls_add(to->torque, p->torque);
}

static void add(pls_overlap_integrals *to, const pls_overlap_integrals *P)
{
    to->volume += P->volume, to->surface += P->surface;
    to->line = P->line, to->scattered = P->scattered;
    for (int k = 0; k < 6; ++k) to->second[k] += P->second[k];
    to->first = pls_add(to->first, P->first);
    to->area = pls_add(to->area, P->area), to->area_moment = pls_add(to->area_moment, P->area_moment);
    add_push(&to->by_depth, &P->by_depth), add_push(&to->by_its_square, &P->by_its_square);
}

pls_wall_sum pls_wall_sum_of(const pls_posed *a) { return (pls_wall_sum){.a = a, .size = a->size}; }

bool pls_wall_add(pls_wall_sum *sum, const pls_posed *facet, const pls_facet *seams, double front, const pls_touch *depth)
{
    const pls_posed *a = sum->a;
    const enum kind kind = kind_of(a, facet);
    pls_vec3 origin = depth->point;
    if (kind == CYLINDER) origin = pls_add(origin, pls_scale(depth->normal, 0.5 * depth->delta)); // on A
    if (kind == PIECES || kind == SHEET) origin = pls_posed_world(a, a->shape->mass.centre);
    const pls_vec3 start = origin;
    const double margin = kind == PIECES ? 0.0 : a->shape->margin * a->scale;
    pls_prism prism = {.planes = 0}; // lines go by the distance from the facet itself
    if (kind != LINE && kind != SHEET) prism = pls_facet_prism(facet, seams, origin, front, margin);
    pls_overlap_integrals P;
    double deep = depth->delta;
    bool any = false;
    switch (kind)
    {
        case FACES: any = pls_faces_behind(a, facet, &prism, &origin, &P); break;
        case CYLINDER: any = pls_cylinder_behind(a, &prism, &origin, &P); break;
        case LINE: any = pls_line_on(a, facet, origin, &P); break;
        case PIECES: any = (deep = pls_sampled_behind(a, facet, &prism, origin, &P)) > 0.0; break;
        case SHEET: any = (deep = pls_sheet_in(a, facet, origin, &P)) > 0.0; break;
        case NONE: break;
    }
    if (!any) return false;
    sum->kind = kind;
    if (sum->facets == 0)
        sum->origin = origin;
    else
        move_origin(&P, pls_sub(sum->origin, origin));
    if (sum->facets == 0 || deep > sum->depth)
    {
        const pls_half_space raised = prism.plane[0];
        sum->depth = fmax(deep, 0.0);
        sum->front = (pls_half_space){raised.normal, raised.offset - margin + pls_dot(raised.normal, pls_sub(start, sum->origin))};
    }
    sum->size = fmax(sum->size, facet->size);
    add(&sum->P, &P);
    ++sum->facets;
    return true;
}

bool pls_wall_touch(pls_wall_sum *sum, const pls_narrow_options *options, pls_touch *out)
{
    const pls_posed *a = sum->a;
    const bool flat = a->shape->dimension == 2;
    out->delta = 0.0;
    if (sum->facets == 0) return false;
    pls_touch t = {.delta = 0.0};
    if (sum->kind == LINE ? !pls_line_law(&sum->P, a->size, flat, &t)
                          : !pls_overlap_touch(&sum->P, options, PLS_OVERLAP_BLUR * sum->size, flat, &t))
        return false;
    double deeper = 0.0;       // along the normal, to where points of other contacts are
    if (sum->kind == CYLINDER) // at half the depth
    {
        pls_cylinder_area(a->z, &t);
        deeper = 0.5 * sum->depth - (sum->front.offset - pls_dot(sum->front.normal, t.point));
    }
    else if (sum->kind == FACES) // on the surface, not on that of the core
        deeper = a->shape->margin * a->scale;
    else if (sum->kind == PIECES || sum->kind == SHEET)
        pls_sampled_area(a->size, &t);
    t.point = pls_add(t.point, pls_scale(t.normal, deeper)), t.middle = pls_add(t.middle, pls_scale(t.normal, deeper));
    t.point = pls_add(t.point, sum->origin), t.middle = pls_add(t.middle, sum->origin);
    t.depth = t.reach = sum->depth;
    t.stands = true;
    *out = t;
    return true;
}
