// faces.c -- contact of faces by the volume of the overlap: forces that are the gradient of an energy.
//
// The deepest point of two nearly parallel faces jumps across them from step to step. Both laws here are integrals over the overlap P of the two bodies, which change
// smoothly, and both forces are the exact gradient of an energy, whatever touches: faces, edges or corners. With d the depth of a point under the surface of a body,
//     W = integral over P of (d_A + d_B) / 2 dV,        which for parallel faces is the integral of t^2/2 dA, t their local overlap.
// d is linear in each cell of a body (the points nearest to one of its faces) and continuous, so that force and torque are integrals over the surface of P, of polygons:
// overlap_simd.c; of polyhedra, whose polygons stay the same for many steps, overlap_record.h. (Clipping only the two most parallel faces along the normal of the penetration depth forgets that the overlap changes by sliding and turning: 1e-4 to
// 2e-3 of energy lost or won at tilts of 0.01 to 0.1.)
//
// VOLUME    energy kn W/A0. Force kn V/A0 for faces, at the centroid of the overlap. Additive: parts of a compound and triangles of a wall push with what lies over them.
// MANIFOLD  energy kn delta^2/2 with delta = 3Q/2W, Q = integral over P of (d_A^2 + d_B^2)/2 dV, for parallel faces the integral of t^3/3 dA: delta = integral t^3 /
//           integral t^2, a smooth maximum of t with neither a length nor a number of corners in it: the depth for parallel faces, 3/4 of it at an edge, 3/5 at a
//           corner, where the force is 9/16 and 9/25 of the point law's. It acts where the weights d(delta)/d(t) have their middle: in the middle of parallel faces, near
//           the edge of a wedge. What is integrated vanishes towards the rims, so that delta is smooth where sides are flush, as in a pile of equal bricks; 2W/V has a kink
//           there (V does), and the pile would rattle across it. A maximum over the corners of the common polygon (logarithm of a sum of exponentials, or a p-norm)
//           jumps where one corner becomes two, and depends on a length or is no conservative force (p-norm weights do not sum to one).
//
// The wrench of an overlap that is not flat is a force on a line and a couple about it: turning one face on the other changes their common outline. `twist` is that couple
// by the force, some tenths of the depth at most. Undamped collisions keep energy to 1e-7 with it (to 1e-3 if it is left out; the point law: 1e-3, kn delta at the
// centroid: a tenth and more).
// Walls (half-spaces, triangles and segments of meshes) count by their own d alone, in place of the half sum: buoyancy. A triangle is the prism behind it.
// Rounded bodies on walls: the core, moved by its margin along the wall's normal, which is exact as well. Two bodies of which one is rounded: lines.c. Here moving the cores
// along the normal of the penetration depth is not conservative where that turns (rounded boxes in random collisions lose or gain some 1e-3 of their energy, at worst
// several percent), while the integral over rounded edges has no closed form.
// A half-space and a sphere or an ellipsoid: the cap in closed form. Other smooth pairs have no faces.
//
// All this is about the normal force. Friction and dashpots act over the same area and resist turning of one face on the other, about the normal and about axes in the
// face; what solid_contact.c needs for that is the area's second moments (`spread`).

#include "contact/faces.h"

#include "contact/facet.h"
#include "contact/overlap_laws.h"
#include "contact/overlap_record.h"
#include "shape/builtin.h"

#include <string.h>

/// Of a body's size: of shallower overlaps rounding leaves no moments, and their force is nothing.
static const double least_depth = 1e-11;

/// Of a body's size: the conditions of a record hold by this at least, far above what rounding does to corners.
static const double record_margin = 1e-9;

/// Of the depth: faces are in a record from this much further down than need be, so that it lasts.
static const double record_slack = 0.5;

// ---- bodies -------------------------------------------------------------------------------------------------------------------------------------------------

static bool has_faces(const pls_shape *s)
{
    return s->convex && s->polytope && s->polytope->face_count > 2 && s->polytope->face_count <= PLS_MOST_FACES &&
           s->polytope->vertex_count <= PLS_MOST_CORNERS;
}

static pls_vec3 centre_of(const pls_posed *p) { return pls_posed_world(p, p->shape->mass.centre); }

static pls_half_space half_space(pls_vec3 normal, pls_vec3 through) { return (pls_half_space){normal, pls_dot(normal, through)}; }

/// Keeps the faces in the order of their planes' distances from the origin.
static void add_face(pls_near_body *out, const pls_near_face *face)
{
    int place = out->faces++;
    for (; place > 0 && out->face[place - 1].plane.offset > face->plane.offset; --place) out->face[place] = out->face[place - 1];
    out->face[place] = *face;
}

/// Faces above `lowest` along n, moved by the margin along n; the overlap is above `bottom`.
static void take_faces(const pls_posed *p, pls_vec3 origin, pls_vec3 n, const double *height, double bottom, double lowest,
                       pls_near_body *out)
{
    const pls_polytope *t = p->shape->polytope;
    const pls_vec3 start = pls_add(pls_sub(p->position, origin), pls_scale(n, p->shape->margin * p->scale));
    bool known[PLS_MOST_CORNERS];
    memset(known, 0, t->vertex_count * sizeof *known);
    uint8_t high[PLS_MOST_CORNERS];
    for (uint32_t v = 0; v < t->vertex_count; ++v) high[v] = height[v] >= lowest;
    out->faces = out->corners = 0;
    for (uint32_t f = 0; f < t->face_count; ++f)
    {
        const uint32_t *corner = t->face_vertex + t->face_start[f];
        const uint32_t corners = t->face_start[f + 1] - t->face_start[f];
        unsigned near = 0;
        for (uint32_t k = 0; k < corners; ++k) near |= high[corner[k]];
        if (!near) continue;
        double top = -INFINITY;
        for (uint32_t k = 0; k < corners; ++k)
        {
            const uint32_t v = corner[k];
            top = height[v] > top ? height[v] : top;
            if (known[v]) continue;
            known[v] = true;
            out->used[out->corners++] = (uint16_t)v;
            out->corner[v] = pls_add(start, pls_scale(pls_posed_turn(p, t->vertex[v]), p->scale));
        }
        const pls_near_face face = {.plane = half_space(pls_posed_turn(p, t->face_normal[f]), out->corner[corner[0]]),
                                    .outline = corner,
                                    .corners = (int)corners,
                                    .enters = top >= bottom};
        add_face(out, &face);
    }
    out->planes = out->faces;
    out->reach = pls_length(pls_sub(centre_of(p), origin)) + p->size;
}

/// Heights of all vertices along n, margin included; the largest.
static double take_heights(const pls_posed *p, pls_vec3 origin, pls_vec3 n, double *height)
{
    const pls_vec3 own = pls_scale(pls_posed_turn_back(p, n), p->scale);
    const double start = pls_dot(pls_sub(p->position, origin), n) + p->shape->margin * p->scale;
    return PLS_SIMD_SELECT(pls_overlap_heights)(p->shape->polytope, own, start, height);
}

/// The prism behind a facet, its front towards `centre`.
static void take_facet(const pls_posed *p, pls_vec3 origin, pls_vec3 centre, pls_near_body *out)
{
    pls_half_space plane[4];
    out->faces = 1, out->planes = pls_facet_prism(p, origin, centre, plane);
    out->face[0].outline = NULL;
    for (int k = 0; k < out->planes; ++k) out->face[k].plane = plane[k];
}

/// Half-space and ellipsoid: the cap, stretched to that of a unit sphere. `front` out of the half-space.
static void cap_law(const pls_posed *a, const double half[3], pls_vec3 front, pls_vec3 on_plane, double A0, pls_touch *out)
{
    const bool flat = a->shape->dimension == 2;
    const pls_vec3 own = pls_posed_turn_back(a, front), centre = pls_posed_world(a, pls_vec(0.0, 0.0, 0.0));
    const double h[3] = {half[0] * a->scale, half[1] * a->scale, flat ? 1.0 : half[2] * a->scale};
    const pls_vec3 n = pls_vec(h[0] * own.x, h[1] * own.y, h[2] * own.z);
    const double R = pls_length(n), height = pls_dot(front, pls_sub(centre, on_plane));
    const double cap = fmin((R - height) / R, 2.0), stretch = h[0] * h[1] * h[2],
                 rim = 2.0 * cap - cap * cap; // rim: squared radius of its circle
    double volume = M_PI * cap * cap * (3.0 - cap) / 3.0, middle = 0.75 * (2.0 - cap) * (2.0 - cap) / (3.0 - cap), base = M_PI * rim;
    if (flat)
    {
        const double angle = 2.0 * asin(sqrt(0.5 * cap)), u = angle * angle;
        volume = angle < 0.02 ? angle * u * (2.0 / 3.0 + u * (-2.0 / 15.0 + u * 4.0 / 315.0)) : angle - 0.5 * sin(2.0 * angle);
        middle = 2.0 / 3.0 * rim * sqrt(rim) / volume;
        base = 2.0 * sqrt(rim);
    }
    const pls_vec3 deep = pls_vec(-h[0] * n.x / R, -h[1] * n.y / R, flat ? 0.0 : -h[2] * n.z / R);
    out->normal = pls_scale(front, -1.0);
    out->twist = 0.0;
    out->delta = volume * stretch / A0;
    out->weight = base * stretch / R / A0;
    out->energy_delta = sqrt(2.0 * out->delta * fmax(R * middle - height, 0.0));
    out->point = out->middle = pls_add(centre, pls_scale(pls_posed_turn(a, deep), middle));
}

/// Sphere, disc, ellipsoid, ellipse; their half axes.
static bool is_ellipsoid(const pls_shape *s, double half[3])
{
    for (int k = 0; k < 3; ++k) half[k] = s->ops == &pls_sphere_shape ? s->values[0] : s->values[k];
    return s->ops == &pls_sphere_shape || (s->ops == &pls_ellipsoid_shape && s->margin == 0.0);
}

// ---- the call -----------------------------------------------------------------------------------------------------------------------------------------------

/// The overlap as seen along the normal of touch: of A's and B's vertices the heights above the origin, towards the other body, and from where on faces matter.
typedef struct slab
{
    pls_vec3 origin, n;
    const double *height[2];
    double lowest[2], deep, size;
} slab;

/// Vertices as high as `lowest`.
static uint64_t high_vertices(const pls_posed *p, const double *height, double lowest)
{
    return PLS_SIMD_SELECT(pls_overlap_high)(height, p->shape->polytope->vertex_count, lowest);
}

/// What of the two bodies matters. B of walls is known already.
static void take_both(const pls_posed *a, const pls_posed *b, const slab *s, pls_near_body *A, pls_near_body *B)
{
    // What reaches as deep as the other one's `lowest` lies in it at the most.
    take_faces(a, s->origin, s->n, s->height[0], s->lowest[0] + s->deep, s->lowest[0], A);
    if (s->height[1]) take_faces(b, s->origin, pls_scale(s->n, -1.0), s->height[1], s->lowest[1] + s->deep, s->lowest[1], B);
}

static bool outline_is_listed(const pls_polytope *t, uint64_t faces, const uint32_t *outline)
{
    for (; faces; faces &= faces - 1)
        if (t->face_vertex + t->face_start[__builtin_ctzll(faces)] == outline) return true;
    return false;
}

/// A record and where the two bodies are, about an origin that follows from these alone: no answer depends on how a record was come by.
typedef struct posed_record
{
    const pls_posed *body[2];
    const pls_overlap_record *record;
    pls_record_bodies about;
    pls_vec3 origin;
    double size;
} posed_record;

static bool is_wall(const pls_posed *b) { return b->shape->ops->unbounded; }

/// Bodies about A's position; of the margin of the bodies.
static pls_record_bodies bodies_of(const pls_posed *a, const pls_posed *b, double size)
{
    pls_record_bodies c = {.body = {a, b}, .wall = is_wall(b), .margin = record_margin * size};
    if (c.wall) c.front = pls_posed_gradient(b, b->position);
    c.start[0] = pls_scale(c.front, -a->shape->margin * a->scale), c.start[1] = pls_sub(b->position, a->position);
    return c;
}

static double size_of(const pls_posed *a, const pls_posed *b) { return is_wall(b) ? a->size : fmax(a->size, b->size); }

static posed_record pose_record(const pls_posed *a, const pls_posed *b, const pls_overlap_record *record)
{
    posed_record p = {.body = {a, b}, .record = record, .size = size_of(a, b)};
    p.about = bodies_of(a, b, p.size);
    const pls_vec3 shift = pls_record_origin(&p.about, record);
    for (int k = 0; k < 2; ++k) p.about.start[k] = pls_sub(p.about.start[k], shift);
    p.origin = pls_add(a->position, shift);
    return p;
}

/// The overlap along a direction from A to B, whichever: nothing of it lies under a face from which it is further than its extent. Heights are of room for both bodies.
static slab slab_along(const posed_record *p, pls_vec3 n, double (*height)[PLS_MOST_CORNERS])
{
    double reach[2] = {0.0, 0.0};
    for (int k = 0; k < (p->about.wall ? 1 : 2); ++k)
    {
        const pls_posed *body = p->body[k];
        const pls_vec3 up = k == 0 ? n : pls_scale(n, -1.0);
        reach[k] = PLS_SIMD_SELECT(pls_overlap_heights)(body->shape->polytope, pls_scale(pls_posed_turn_back(body, up), body->scale),
                                                        pls_dot(p->about.start[k], up), height[k]);
    }
    const double deep = reach[0] + reach[1];
    return (slab){.origin = p->origin,
                  .n = n,
                  .height = {height[0], p->about.wall ? NULL : height[1]},
                  .lowest = {-reach[1] - deep, -reach[0] - deep},
                  .deep = deep,
                  .size = p->size};
}

/// The rest of energies where no point is common to all faces that depth counts from. Not `now`: when somebody looks, nobody does at each step.
static void add_seams(const posed_record *p, bool now, pls_overlap_integrals *out)
{
    const pls_overlap_record *record = p->record;
    if (record->apex[0].kind != PLS_NO_APEX && record->apex[1].kind != PLS_NO_APEX) return;
    if (!now)
    {
        out->by_depth.energy = INFINITY;
        return;
    }
    double height[2][PLS_MOST_CORNERS];
    const double area = pls_length(out->area);
    const slab s = slab_along(p, area > 0.0 ? pls_scale(out->area, 1.0 / area) : pls_vec(1.0, 0.0, 0.0), height);
    pls_near_body near[2];
    take_both(p->body[0], p->body[1], &s, &near[0], &near[1]);
    for (int k = 0; k < 2; ++k)
    {
        if (record->apex[k].kind != PLS_NO_APEX) continue;
        const pls_polytope *t = p->body[k]->shape->polytope;
        int list[PLS_MOST_FACES], count = 0;
        for (int f = 0; f < near[k].faces; ++f)
            if (outline_is_listed(t, record->seen[k], near[k].face[f].outline)) list[count++] = f;
        double seam[2];
        PLS_SIMD_SELECT(pls_overlap_seams)(&near[k], list, count, &near[1 - k], 3, PLS_OVERLAP_BLUR * s.size, seam);
        out->by_depth.energy += 0.5 * seam[0] / 2.0, out->by_its_square.energy += 0.5 * seam[1] / 3.0;
    }
}

/// False if the record does not fit. That no faces matter but those it has in view is asked elsewhere.
static bool recall(const posed_record *p, bool squares, bool energies, pls_overlap_integrals *out)
{
    if (!PLS_SIMD_SELECT(pls_overlap_recall)(&p->about, p->record, squares, out)) return false;
    add_seams(p, squares || energies, out);
    return true;
}

/// Vertices whose faces matter. A little more than can be nearest, so that no face without them comes near to being so: whoever keeps more faces sees the same.
static bool has_in_view(const posed_record *p, const slab *s)
{
    for (int k = 0; k < (p->about.wall ? 1 : 2); ++k)
        if (high_vertices(p->body[k], s->height[k], s->lowest[k] - 4.0 * p->about.margin) & ~p->record->high[k]) return false;
    return true;
}

static bool can_have_record(const pls_posed *a, const pls_posed *b)
{
    return pls_has_record(a->shape) && (is_wall(b) || pls_has_record(b->shape));
}

/// The integrals by what an earlier step found of the faces, edges and corners about, or by what is found now. False if they do not tell.
static bool by_record(const pls_posed *a, const pls_posed *b, const slab *s, bool squares, pls_overlap_record *record,
                      pls_overlap_integrals *out, pls_vec3 *origin)
{
    if (!can_have_record(a, b)) return false;
    if (record && record->known)
    {
        const posed_record p = pose_record(a, b, record);
        *origin = p.origin;
        if (has_in_view(&p, s) && recall(&p, squares, false, out)) return true;
    }
    const pls_posed *body[2] = {a, b};
    pls_record_bodies c = bodies_of(a, b, s->size);
    uint64_t some[2] = {0, 0};
    for (int k = 0; k < (c.wall ? 1 : 2); ++k)
    {
        c.start[k] = pls_sub(c.start[k], pls_sub(s->origin, a->position));
        some[k] = high_vertices(body[k], s->height[k], s->lowest[k] - record_slack * s->deep);
    }
    pls_overlap_record now;
    if (!pls_overlap_find(&c, some, &now)) return false;
    const posed_record p = pose_record(a, b, &now);
    *origin = p.origin;
    if (!recall(&p, squares, !record, out)) return false;
    if (record) *record = now;
    return true;
}

static bool finish(pls_overlap_integrals *P, pls_vec3 origin, double size, const pls_posed *a, const pls_narrow_options *options,
                   pls_touch *out)
{
    if (!pls_overlap_touch(P, options, PLS_OVERLAP_BLUR * size, a->shape->dimension == 2, out)) return false;
    out->point = pls_add(origin, out->point), out->middle = pls_add(origin, out->middle);
    return true;
}

static bool overlap_law(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                        pls_overlap_record *record, bool *recorded, pls_touch *out)
{
    const bool plane = is_wall(b), facet = pls_is_facet(b->shape);
    pls_vec3 origin = pls_scale(pls_add(depth->on_a, depth->on_b), 0.5);
    double height_a[PLS_MOST_CORNERS], height_b[PLS_MOST_CORNERS];
    pls_vec3 n = depth->normal;
    pls_near_body A, B;
    double reach_b;
    if (plane || facet)
    {
        if (facet)
            take_facet(b, origin, centre_of(a), &B);
        else
        {
            B.face[0].plane = half_space(pls_posed_gradient(b, b->position), pls_sub(b->position, origin));
            B.faces = B.planes = 1;
            B.face[0].outline = NULL;
        }
        // To the front, which has no share in moments about a point on it.
        const pls_vec3 shift = pls_scale(B.face[0].plane.normal, B.face[0].plane.offset);
        origin = pls_add(origin, shift);
        for (int f = 1; f < B.planes; ++f) B.face[f].plane.offset -= pls_dot(B.face[f].plane.normal, shift);
        B.face[0].plane.offset = reach_b = 0.0;
        B.reach = pls_length(pls_sub(centre_of(a), origin)) + a->size;
        n = pls_scale(B.face[0].plane.normal, -1.0);
    }
    else
        reach_b = take_heights(b, origin, pls_scale(n, -1.0), height_b);
    const double reach_a = take_heights(a, origin, n, height_a), deep = reach_a + reach_b;
    if (!(deep > least_depth * a->size)) return false;
    const double size = size_of(a, b);
    const slab between = {.origin = origin,
                          .n = n,
                          .height = {height_a, plane || facet ? NULL : height_b},
                          .lowest = {-reach_b - deep, -reach_a - deep},
                          .deep = deep,
                          .size = size};
    pls_overlap_integrals P;
    pls_vec3 about;
    if (!facet && by_record(a, b, &between, options->faces == PLS_FACES_MANIFOLD, record, &P, &about))
    {
        *recorded = finish(&P, about, size, a, options, out);
        if (record) record->normal = out->normal;
        return *recorded;
    }
    take_both(a, b, &between, &A, &B);
    PLS_SIMD_SELECT(pls_overlap_integrate)(&A, &B, a->shape->dimension, PLS_OVERLAP_BLUR * size, &P);
    return finish(&P, origin, size, a, options, out);
}

bool pls_faces_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                     pls_overlap_record *record, bool *recorded, pls_touch *out)
{
    double half[3];
    const bool plane = is_wall(b), wall = plane || pls_is_facet(b->shape);
    const bool faces = has_faces(a->shape) && (wall || (has_faces(b->shape) && a->shape->margin == 0.0 && b->shape->margin == 0.0));
    const bool cap = plane && options->faces == PLS_FACES_VOLUME && is_ellipsoid(a->shape, half);
    *recorded = false;
    if (options->faces == PLS_FACES_POINT || (!faces && !cap)) return false;
    if (cap)
    {
        if (depth->delta <= 0.0)
            pls_overlap_none(depth, out);
        else
            cap_law(a, half, pls_posed_gradient(b, b->position), b->position, options->face_area, out);
    }
    else if (depth->delta <= 0.0 || !overlap_law(a, b, depth, options, record, recorded, out))
        pls_overlap_none(depth, out);
    out->depth = out->reach = depth->delta;
    return true;
}

bool pls_faces_touch_again(const pls_posed *a, const pls_posed *b, const pls_narrow_options *options, pls_overlap_record *record,
                           pls_touch *out)
{
    if (!record->known) return false;
    const posed_record p = pose_record(a, b, record);
    double height[2][PLS_MOST_CORNERS];
    const slab s = slab_along(&p, p.about.wall ? pls_scale(p.about.front, -1.0) : record->normal, height);
    pls_overlap_integrals P;
    if (!(s.deep > least_depth * a->size) || !has_in_view(&p, &s)) return false;
    if (!recall(&p, options->faces == PLS_FACES_MANIFOLD, false, &P) || !finish(&P, p.origin, p.size, a, options, out)) return false;
    record->normal = out->normal;
    out->depth = INFINITY, out->reach = s.deep;
    return true;
}
