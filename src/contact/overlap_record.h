// overlap_record.h -- which faces, edges and corners bound the overlap of two polyhedra: a topology that holds for many steps.
//
// Let A and B overlap in P. A piece is the part of a face f of one body that lies in the other one, nearest to the other one's face g: with d the depths under the planes of the other,
//
//     piece(f, g) = outline of f, d_g >= 0, d_h >= d_g for all h.
//
// Pieces of both bodies make up the surface of P, and integrals over P follow from them (overlap_simd.c). Their corners are of four kinds: a vertex, where an edge goes through a plane
// of the other body (`cross`), where it goes on from one cell of depth to the next (`leave`), and where three cells meet on a face (`meet`).
//
// A record says which corners there are and how they join. It is found by cutting (overlap_record.c), a matter of microseconds; the numbers come from the record alone, the same way
// each time (overlap_record_simd.c), a tenth of that. Whether a record fits the poses of now can be told from its corners: each of them has to fulfil, by a margin that rounding
// does not reach, all conditions but those that make it. Then every one of its polygons is all of its piece, as going round along its sides one comes back to the start, and no piece is
// missing, as beyond each side lies another one. So a record that fits is the only one that does: it does not matter whether it was found now or long ago, and nobody need
// keep it. What fits no record (faces in one plane, cells that touch in a point) is left to overlap_simd.c.
#ifndef PLS_CONTACT_OVERLAP_RECORD_H
#define PLS_CONTACT_OVERLAP_RECORD_H

#include "contact/overlap.h"
#include "contact/narrow_phase.h"

/// Most faces and vertices of a body that has records, and what a record has room for. All but the first are matters of topology, so that it never is a matter of history whether there is one.
enum { PLS_RECORD_PLANES = 64, PLS_RECORD_VERTICES = 56, PLS_RECORD_CORNERS = 64, PLS_RECORD_TRIANGLES = 104 };

enum { PLS_CORNER_VERTEX, PLS_CORNER_CROSS, PLS_CORNER_LEAVE, PLS_CORNER_MEET, PLS_CORNER_KINDS };

/// A point that all planes of one body go through from which depth counts: a vertex, the point of an edge (two vertices) or of a plane next to the origin. If there is none, the
/// energy needs the seams, where cells meet within the overlap (`pls_overlap_seams`).
typedef struct pls_record_apex
{
    uint8_t kind, at[2];
} pls_record_apex;

enum { PLS_APEX_ON_PLANE, PLS_APEX_VERTEX, PLS_APEX_ON_EDGE, PLS_NO_APEX };

/// All zero: nothing. Planes and vertices are named by place: planes of A from 0 on, of B from PLS_RECORD_PLANES on.
struct pls_overlap_record
{
    uint64_t high[2]; ///< vertices of each body whose faces are in `plane`
    pls_vec3 normal;  ///< of touch, from A to B, at the last step or some other: a direction along which little overlaps
    uint8_t known, planes[2], vertices[2]; ///< known: 1
    uint8_t corners[PLS_CORNER_KINDS];     ///< by kind, in this order
    uint8_t triangles[2];                  ///< of A's surface, then of B's
    pls_record_apex apex[2];
    uint64_t seen[2];                          ///< faces that have pieces or are nearest to some
    uint8_t plane[2][PLS_RECORD_PLANES];       ///< faces, ascending; a half-space has one plane
    uint8_t vertex[PLS_RECORD_VERTICES];       ///< of A, then of B
    uint8_t corner[PLS_RECORD_CORNERS][4];     ///< vertex: it and g; cross: two vertices and g; leave: two vertices, g, h; meet: f, g, h, k
    uint8_t triangle[PLS_RECORD_TRIANGLES][4]; ///< corners, and the plane it lies in
    uint8_t from[PLS_RECORD_TRIANGLES];        ///< the plane nearest to it
};

/// Where the triangles of a surface begin: eight at a time are integrated, and places left over are triangles of nothing.
static inline int pls_record_first_triangle(const pls_overlap_record *r, int body) { return body ? (r->triangles[0] + 7) & ~7 : 0; }

/// The two bodies about an origin in the overlap.
typedef struct pls_record_bodies
{
    const pls_posed *body[2];
    pls_vec3 start[2]; ///< of their shapes' frames from the origin, moved by margins [m]
    bool wall;         ///< the second is a half-space, its front through the origin
    pls_vec3 front;    ///< its normal
    double margin;     ///< by which conditions hold [m]
} pls_record_bodies;

/// Those which a record can be about.
static inline bool pls_has_record(const pls_shape *s)
{
    return s->dimension == 3 && s->polytope->face_count <= PLS_RECORD_PLANES && s->polytope->vertex_count <= PLS_RECORD_PLANES;
}

/// Which, with the faces that have one of the vertices `high`, no others being near. False if there is none.
bool pls_overlap_find(const pls_record_bodies *bodies, const uint64_t high[2], pls_overlap_record *out);

/// A point of the overlap, for walls on their front: what integrals should be about. `bodies` are about any origin here, start[1] of a wall being a point of its front.
/// NaN where the record cannot fit.
pls_vec3 pls_record_origin(const pls_record_bodies *bodies, const pls_overlap_record *record);

/// The integrals, those by the depth's square if `squares`, energies without seams. False if the record does not fit.
PLS_SIMD_DECLARE(bool, pls_overlap_recall, const pls_record_bodies *bodies, const pls_overlap_record *record, bool squares,
                 pls_overlap_integrals *out);

/// Of each vertex start + own.vertex, and the largest of them; there is room for a multiple of eight, what is beyond the vertices is minus infinity.
PLS_SIMD_DECLARE(double, pls_overlap_heights, const pls_polytope *polytope, pls_vec3 own, double start, double *height);
/// Bit v: vertex v < 64 is as high as `lowest`.
PLS_SIMD_DECLARE(uint64_t, pls_overlap_high, const double *height, uint32_t vertices, double lowest);

static inline pls_vec3 pls_record_vertex(const pls_record_bodies *c, int body, int vertex)
{
    const pls_posed *p = c->body[body];
    return pls_add(c->start[body], pls_scale(pls_posed_turn(p, p->shape->polytope->vertex[vertex]), p->scale));
}

static inline pls_half_space pls_record_plane(const pls_record_bodies *c, int body, int face)
{
    if (body == 1 && c->wall) return (pls_half_space){c->front, 0.0};
    const pls_posed *p = c->body[body];
    const pls_polytope *t = p->shape->polytope;
    const pls_vec3 own = t->face_normal[face], normal = pls_posed_turn(p, own);
    return (pls_half_space){normal,
                            pls_dot(normal, c->start[body]) + p->scale * pls_dot(own, t->vertex[t->face_vertex[t->face_start[face]]])};
}

#endif
