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
// Walls (half-spaces, triangles and segments of meshes) count by their own d alone, in place of the half sum: buoyancy. A triangle is the prism behind it, and all triangles that
// a body lies over make one contact: wall_touch.c.
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
#include "contact/overlap_recall.h"
#include "shape/builtin.h"

#include <string.h>

/// Of a body's size: of shallower overlaps rounding leaves no moments, and their force is nothing.
static const double least_depth = 1e-11;

// ---- bodies -------------------------------------------------------------------------------------------------------------------------------------------------

bool pls_has_faces(const pls_shape *s)
{
    return s->convex && s->polytope && s->polytope->face_count > 2 && s->polytope->face_count <= PLS_MOST_FACES &&
           s->polytope->vertex_count <= PLS_MOST_CORNERS;
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

static bool finish(pls_overlap_integrals *P, pls_vec3 origin, double size, const pls_posed *a, const pls_narrow_options *options,
                   pls_touch *out)
{
    if (!pls_overlap_touch(P, options, PLS_OVERLAP_BLUR * size, a->shape->dimension == 2, out)) return false;
    out->point = pls_add(origin, out->point), out->middle = pls_add(origin, out->middle);
    return true;
}

/// Where a body's frame starts from the origin, moved by the margin along n.
static pls_vec3 start_of(const pls_posed *p, pls_vec3 origin, pls_vec3 n)
{
    return pls_add(pls_sub(p->position, origin), pls_scale(n, p->shape->margin * p->scale));
}

/// A half-space, or the prism behind a facet. The origin is moved to its front, which has no share in moments about a point on it.
static void take_wall(const pls_posed *a, const pls_prism *wall, pls_vec3 *origin, pls_near_body *B)
{
    const pls_vec3 shift = pls_scale(wall->plane[0].normal, wall->plane[0].offset);
    *origin = pls_add(*origin, shift);
    B->faces = wall->faces, B->planes = wall->planes;
    for (int f = 0; f < wall->planes; ++f)
        B->face[f] = (pls_near_face){.plane = {wall->plane[f].normal, wall->plane[f].offset - pls_dot(wall->plane[f].normal, shift)}};
    B->face[0].plane.offset = 0.0;
    B->reach = pls_length(pls_sub(pls_posed_world(a, a->shape->mass.centre), *origin)) + a->size;
}

static bool overlap_law(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                        pls_overlap_record *record, bool *recorded, pls_touch *out)
{
    const bool wall = pls_is_half_space(b);
    pls_vec3 origin = pls_scale(pls_add(depth->on_a, depth->on_b), 0.5), n = depth->normal;
    double height_a[PLS_MOST_CORNERS], height_b[PLS_MOST_CORNERS], reach_b = 0.0;
    pls_near_body A, B;
    if (wall)
    {
        const pls_vec3 front = pls_posed_gradient(b, b->position);
        const pls_prism ground = {1, 1, {pls_half_space_through(front, pls_sub(b->position, origin))}};
        take_wall(a, &ground, &origin, &B);
        n = pls_scale(front, -1.0);
    }
    else
        reach_b = pls_near_heights(b, start_of(b, origin, pls_scale(n, -1.0)), pls_scale(n, -1.0), height_b);
    const double reach_a = pls_near_heights(a, start_of(a, origin, n), n, height_a), size = pls_pair_size(a, b);
    const pls_slab between = pls_slab_of(origin, n, height_a, wall ? NULL : height_b, reach_a, reach_b, size);
    if (!(between.deep > least_depth * a->size)) return false;
    pls_recalled recalled;
    if (pls_overlap_by_record(a, b, &between, options->faces == PLS_FACES_MANIFOLD, record, &recalled))
    {
        *recorded = finish(&recalled.P, recalled.origin, size, a, options, out);
        if (record) record->normal = out->normal;
        return *recorded;
    }
    pls_near_faces(a, b, &between, &A, &B);
    pls_overlap_integrals P;
    PLS_SIMD_SELECT(pls_overlap_integrate)(&A, &B, a->shape->dimension, PLS_OVERLAP_BLUR * size, &P);
    return finish(&P, origin, size, a, options, out);
}

bool pls_faces_behind(const pls_posed *a, const pls_posed *facet, const pls_prism *prism, pls_vec3 *origin, pls_overlap_integrals *P)
{
    pls_near_body A, B;
    take_wall(a, prism, origin, &B);
    // Seen from an origin that is moved by the margin as well, corners of the core are where they are.
    const pls_vec3 n = pls_scale(B.face[0].plane.normal, -1.0), moved = pls_add(*origin, pls_scale(n, a->shape->margin * a->scale));
    double height[PLS_MOST_CORNERS];
    const double reach = pls_near_heights(a, start_of(a, moved, n), n, height), size = fmax(a->size, facet->size);
    const pls_slab between = pls_slab_of(moved, n, height, NULL, reach, 0.0, size);
    if (!(between.deep > least_depth * a->size)) return false;
    pls_near_faces(a, facet, &between, &A, &B);
    PLS_SIMD_SELECT(pls_overlap_integrate)(&A, &B, a->shape->dimension, PLS_OVERLAP_BLUR * size, P);
    return P->volume > 0.0;
}

bool pls_faces_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                     pls_overlap_record *record, bool *recorded, pls_touch *out)
{
    double half[3];
    const bool plane = pls_is_half_space(b);
    const bool faces =
        pls_has_faces(a->shape) && (plane || (pls_has_faces(b->shape) && a->shape->margin == 0.0 && b->shape->margin == 0.0));
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
    pls_recalled r;
    if (!pls_overlap_again(a, b, options->faces == PLS_FACES_MANIFOLD, record, &r) || !(r.deep > least_depth * a->size)) return false;
    if (!finish(&r.P, r.origin, pls_pair_size(a, b), a, options, out)) return false;
    record->normal = out->normal;
    out->depth = INFINITY, out->reach = r.deep;
    return true;
}
