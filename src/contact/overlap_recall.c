// overlap_recall.c -- a record and two poses make integrals: about an origin of their own, if the record has all faces in view that matter.

#include "contact/overlap_recall.h"

#include "contact/overlap_laws.h"

/// Of a body's size: the conditions of a record hold by this at least, far above what rounding does to corners.
static const double record_margin = 1e-9;

/// Of the depth: faces are in a record from this much further down than need be, so that it lasts.
static const double record_slack = 0.5;

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

/// Bodies about A's position; of the margin of the bodies.
static pls_record_bodies bodies_of(const pls_posed *a, const pls_posed *b, double size)
{
    pls_record_bodies c = {.body = {a, b}, .wall = pls_is_half_space(b), .margin = record_margin * size};
    if (c.wall) c.front = pls_posed_gradient(b, b->position);
    c.start[0] = pls_scale(c.front, -a->shape->margin * a->scale), c.start[1] = pls_sub(b->position, a->position);
    return c;
}

static posed_record pose_record(const pls_posed *a, const pls_posed *b, const pls_overlap_record *record)
{
    posed_record p = {.body = {a, b}, .record = record, .size = pls_pair_size(a, b)};
    p.about = bodies_of(a, b, p.size);
    const pls_vec3 shift = pls_record_origin(&p.about, record);
    for (int k = 0; k < 2; ++k) p.about.start[k] = pls_sub(p.about.start[k], shift);
    p.origin = pls_add(a->position, shift);
    return p;
}

static pls_slab slab_along(const posed_record *p, pls_vec3 n, double (*height)[PLS_MOST_CORNERS])
{
    const double a = pls_near_heights(p->body[0], p->about.start[0], n, height[0]);
    const double b = p->about.wall ? 0.0 : pls_near_heights(p->body[1], p->about.start[1], pls_scale(n, -1.0), height[1]);
    return pls_slab_of(p->origin, n, height[0], p->about.wall ? NULL : height[1], a, b, p->size);
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
    const pls_slab s = slab_along(p, area > 0.0 ? pls_scale(out->area, 1.0 / area) : pls_vec(1.0, 0.0, 0.0), height);
    pls_near_body near[2];
    pls_near_faces(p->body[0], p->body[1], &s, &near[0], &near[1]);
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
static bool has_in_view(const posed_record *p, const pls_slab *s)
{
    for (int k = 0; k < (p->about.wall ? 1 : 2); ++k)
        if (pls_near_high(p->body[k], s->height[k], s->lowest[k] - 4.0 * p->about.margin) & ~p->record->high[k]) return false;
    return true;
}

static bool can_have_record(const pls_posed *a, const pls_posed *b)
{
    return pls_has_record(a->shape) && (pls_is_half_space(b) || pls_has_record(b->shape));
}

bool pls_overlap_by_record(const pls_posed *a, const pls_posed *b, const pls_slab *s, bool squares, pls_overlap_record *record,
                           pls_recalled *out)
{
    if (!can_have_record(a, b)) return false;
    out->deep = s->deep;
    if (record && record->known)
    {
        const posed_record p = pose_record(a, b, record);
        out->origin = p.origin;
        if (has_in_view(&p, s) && recall(&p, squares, false, &out->P)) return true;
    }
    const pls_posed *body[2] = {a, b};
    pls_record_bodies c = bodies_of(a, b, s->size);
    uint64_t some[2] = {0, 0};
    for (int k = 0; k < (c.wall ? 1 : 2); ++k)
    {
        c.start[k] = pls_sub(c.start[k], pls_sub(s->origin, a->position));
        some[k] = pls_near_high(body[k], s->height[k], s->lowest[k] - record_slack * s->deep);
    }
    pls_overlap_record now;
    if (!pls_overlap_find(&c, some, &now)) return false;
    const posed_record p = pose_record(a, b, &now);
    out->origin = p.origin;
    if (!recall(&p, squares, !record, &out->P)) return false;
    if (record) *record = now;
    return true;
}

bool pls_overlap_again(const pls_posed *a, const pls_posed *b, bool squares, const pls_overlap_record *record, pls_recalled *out)
{
    if (!record->known) return false;
    const posed_record p = pose_record(a, b, record);
    double height[2][PLS_MOST_CORNERS];
    const pls_slab s = slab_along(&p, p.about.wall ? pls_scale(p.about.front, -1.0) : record->normal, height);
    out->origin = p.origin, out->deep = s.deep;
    return s.deep > 0.0 && has_in_view(&p, &s) && recall(&p, squares, false, &out->P);
}
