// near_body.c -- faces of a body that the overlap with another one may have to do with.

#include "contact/near_body.h"

#include "contact/overlap_record.h"

#include <string.h>

double pls_near_heights(const pls_posed *p, pls_vec3 start, pls_vec3 up, double *height)
{
    const pls_vec3 own = pls_scale(pls_posed_turn_back(p, up), p->scale);
    return PLS_SIMD_SELECT(pls_overlap_heights)(p->shape->polytope, own, pls_dot(start, up), height);
}

uint64_t pls_near_high(const pls_posed *p, const double *height, double lowest)
{
    return PLS_SIMD_SELECT(pls_overlap_high)(height, p->shape->polytope->vertex_count, lowest);
}

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
        const pls_near_face face = {.plane = pls_half_space_through(pls_posed_turn(p, t->face_normal[f]), out->corner[corner[0]]),
                                    .outline = corner,
                                    .corners = (int)corners,
                                    .enters = top >= bottom};
        add_face(out, &face);
    }
    out->planes = out->faces;
    out->reach = pls_length(pls_sub(pls_posed_world(p, p->shape->mass.centre), origin)) + p->size;
}

void pls_near_faces(const pls_posed *a, const pls_posed *b, const pls_slab *s, pls_near_body *A, pls_near_body *B)
{
    // What reaches as deep as the other one's `lowest` lies in it at the most.
    take_faces(a, s->origin, s->n, s->height[0], s->lowest[0] + s->deep, s->lowest[0], A);
    if (s->height[1]) take_faces(b, s->origin, pls_scale(s->n, -1.0), s->height[1], s->lowest[1] + s->deep, s->lowest[1], B);
}
