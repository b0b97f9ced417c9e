// Contacts of faces against an oracle that cuts the overlap out of a block, plane by plane, and the cell of every face out of that. It knows all faces of both bodies and
// nothing of what is near, of polygons, or of corners in which cells meet.

#include "contact/faces.h"
#include "shape/builtin.h"
#include "support/clipped.h"
#include "support/solids.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { MOST_PLANES = 300 };

typedef struct body
{
    int faces, planes; ///< that depth goes by; all
    pls_half_space plane[MOST_PLANES];
} body;

typedef struct push
{
    double energy;
    pls_vec3 force, torque;
} push;

static pls_half_space half_space(pls_vec3 n, pls_vec3 through) { return (pls_half_space){n, pls_dot(n, through)}; }

static bool is_facet(const pls_posed *p) { return p->shape->polytope && p->shape->polytope->face_count == 2; }

/// About `origin`; `other` tells the front of a facet.
static void take_body(const pls_posed *p, const pls_posed *other, pls_vec3 origin, pls_vec3 margin, body *out)
{
    const pls_polytope *t = p->shape->polytope;
    out->faces = out->planes = 0;
    if (p->shape->ops->unbounded)
    {
        out->plane[0] = half_space(pls_posed_gradient(p, p->position), pls_sub(p->position, origin));
        out->faces = out->planes = 1;
    }
    else if (is_facet(p)) // that has no neighbours: depth counts from all its sides
    {
        const bool flat = p->shape->dimension == 2;
        pls_vec3 x[3];
        for (int k = 0; k < (flat ? 2 : 3); ++k) x[k] = pls_sub(pls_posed_world(p, t->vertex[k]), origin);
        if (flat) x[2] = pls_add(x[0], pls_vec(0, 0, 1));
        pls_vec3 n = pls_unit(pls_cross(pls_sub(x[1], x[0]), pls_sub(x[2], x[0])));
        double turn = 1.0;
        if (pls_dot(n, pls_sub(pls_sub(pls_posed_world(other, other->shape->mass.centre), origin), x[0])) < 0.0)
            n = pls_scale(n, -1.0), turn = -1.0;
        out->plane[0] = half_space(n, x[0]);
        if (flat)
        {
            const pls_vec3 along = pls_unit(pls_sub(x[1], x[0]));
            out->plane[1] = half_space(along, x[1]), out->plane[2] = half_space(pls_scale(along, -1.0), x[0]);
        }
        else
            for (int k = 0; k < 3; ++k)
                out->plane[1 + k] = half_space(pls_scale(pls_unit(pls_cross(pls_sub(x[(k + 1) % 3], x[k]), n)), turn), x[k]);
        out->faces = out->planes = flat ? 3 : 4;
    }
    else
        for (uint32_t f = 0; f < t->face_count; ++f)
        {
            const pls_vec3 x = pls_posed_world(p, t->vertex[t->face_vertex[t->face_start[f]]]);
            out->plane[f] = half_space(pls_posed_turn(p, t->face_normal[f]), pls_add(pls_sub(x, origin), margin));
            out->faces = out->planes = (int)t->face_count;
        }
}

static pls_vec3 second_along(const double s[6], pls_vec3 n)
{
    return pls_vec(s[0] * n.x + s[3] * n.y + s[4] * n.z, s[3] * n.x + s[1] * n.y + s[5] * n.z, s[4] * n.x + s[5] * n.y + s[2] * n.z);
}

/// Integrals of d and d^2 over the cells of a body, and what pushes: the body itself if `weight` is below 0.
static void add_cells(const body *s, const pls_clipped *P, double weight, push *W, push *Q)
{
    for (int f = 0; f < s->faces; ++f)
    {
        static pls_clipped cell;
        pls_clipped_copy(&cell, P);
        const pls_half_space *h = &s->plane[f];
        for (int g = 0; g < s->faces && cell.count > 0; ++g)
        {
            if (g == f) continue;
            const pls_half_space nearer = {pls_sub(s->plane[g].normal, h->normal), s->plane[g].offset - h->offset};
            pls_clip(&cell, &nearer, 2);
        }
        if (cell.count == 0) continue;
        pls_clipped_measure m;
        pls_clipped_measure_of(&cell, &m);
        const pls_vec3 n = h->normal, across = second_along(m.second, n);
        const double d = h->offset * m.volume - pls_dot(n, m.first);
        W->energy += fabs(weight) * d;
        W->force = pls_add(W->force, pls_scale(n, weight * m.volume));
        W->torque = pls_add(W->torque, pls_scale(pls_cross(m.first, n), weight));
        Q->energy += fabs(weight) * (h->offset * d - h->offset * pls_dot(n, m.first) + pls_dot(n, across));
        Q->force = pls_add(Q->force, pls_scale(n, 2.0 * weight * d));
        Q->torque = pls_add(Q->torque, pls_scale(pls_cross(pls_sub(pls_scale(m.first, h->offset), across), n), 2.0 * weight));
    }
}

static bool across(const pls_half_space *f, const pls_half_space *g) { return fabs(pls_dot(f->normal, g->normal)) < 1e-9; }

/// Through the foot of the origin on what planes at right angles to each other have in common, and on by the margin to the middle of where they touch round edges.
static void add_bevel(body *s, const pls_half_space *const *of, int count, double by)
{
    pls_vec3 sum = {0, 0, 0}, foot = sum;
    for (int k = 0; k < count; ++k)
    {
        sum = pls_add(sum, of[k]->normal);
        foot = pls_add(foot, pls_scale(of[k]->normal, of[k]->offset));
    }
    s->plane[s->planes] = half_space(pls_unit(sum), foot);
    s->plane[s->planes++].offset += by / sqrt(count);
}

/// Faces are raised, and bevels between faces at right angles to each other cut edges and corners; of a facet only the edges of its front.
static void raise(body *s, bool facet, double by)
{
    const pls_half_space *p = s->plane;
    const int faces = s->faces;
    for (int f = 0; f < faces; ++f)
        for (int g = 0; g < f && (g == 0 || !facet); ++g)
        {
            if (!across(&p[f], &p[g])) continue;
            add_bevel(s, (const pls_half_space *const[]){&p[f], &p[g]}, 2, by);
            for (int h = 0; h < g && !facet; ++h)
                if (across(&p[f], &p[h]) && across(&p[g], &p[h])) add_bevel(s, (const pls_half_space *const[]){&p[f], &p[g], &p[h]}, 3, by);
        }
    for (int f = 0; f < faces; ++f) s->plane[f].offset += by;
    s->faces = s->planes;
}

/// What the laws say, about `origin`.
typedef struct answer
{
    push law;     ///< energy, and the wrench by kn
    double depth; ///< of the manifold law
    pls_vec3 area;
    double volume, spread[6];
} answer;

/// `wall`: depth counts from B alone.
static bool ask_oracle(const pls_posed *a, const pls_posed *b, bool wall, pls_vec3 origin, pls_faces faces, answer *out)
{
    static body A, B;
    static pls_clipped P;
    const bool flat = a->shape->dimension == 2;
    take_body(b, a, origin, pls_vec(0, 0, 0), &B);
    take_body(a, b, origin, pls_vec(0, 0, 0), &A);
    const double raised = a->shape->margin * a->scale + (is_facet(b) ? b->shape->margin * b->scale : 0.0);
    if (wall && raised > 0.0) raise(&B, is_facet(b), raised);
    const pls_vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double half[3] = {4.0, 4.0, flat ? 0.5 : 4.0};
    pls_clipped_block(&P, pls_vec(0, 0, 0), axis, half, 2);
    for (int f = 0; f < A.planes && P.count > 0; ++f) pls_clip(&P, &A.plane[f], 0);
    for (int f = 0; f < B.planes && P.count > 0; ++f) pls_clip(&P, &B.plane[f], 1);
    if (P.count == 0) return false;
    push W = {0}, Q = {0};
    add_cells(&B, &P, wall ? -1.0 : -0.5, &W, &Q);
    if (!wall) add_cells(&A, &P, 0.5, &W, &Q);
    pls_clipped_measure m;
    pls_clipped_measure_of(&P, &m);
    if (flat) W.force.z = Q.force.z = W.torque.x = W.torque.y = Q.torque.x = Q.torque.y = 0.0;
    out->law = W, out->depth = 1.5 * Q.energy / W.energy;
    if (faces == PLS_FACES_MANIFOLD)
    {
        const double by = out->depth / W.energy;
        out->law.energy = 0.5 * out->depth * out->depth;
        out->law.force = pls_scale(pls_sub(pls_scale(Q.force, 1.5), pls_scale(W.force, out->depth)), by);
        out->law.torque = pls_scale(pls_sub(pls_scale(Q.torque, 1.5), pls_scale(W.torque, out->depth)), by);
    }
    out->area = m.area[0], out->volume = m.volume;
    const pls_vec3 c = pls_scale(m.first, 1.0 / m.volume);
    const double middle[6] = {c.x * c.x, c.y * c.y, c.z * c.z, c.x * c.y, c.x * c.z, c.y * c.z};
    for (int k = 0; k < 6; ++k) out->spread[k] = flat && (k == 2 || k > 3) ? 0.0 : m.second[k] / m.volume - middle[k];
    return true;
}

/// The largest difference of what both say, by the scales of it: force, force times width, depth. NAN if one of them finds no overlap. The area of A in B, which `weight` asks for,
/// is one or the other where faces are flush.
static double apart(const pls_posed *a, const pls_posed *b, bool wall, const pls_touch *t, pls_vec3 origin, pls_faces faces, bool flush)
{
    answer o;
    if (!ask_oracle(a, b, wall, origin, faces, &o) || !(o.volume > 0.0)) return t->delta > 0.0 ? NAN : 0.0;
    if (!(t->delta > 0.0)) return NAN;
    const pls_vec3 force = pls_scale(t->normal, t->delta);
    const pls_vec3 torque = pls_add(pls_cross(pls_sub(t->point, origin), force), pls_scale(force, t->twist));
    double worst = pls_length(pls_sub(force, o.law.force)) / t->delta;
    worst = fmax(worst, pls_length(pls_sub(torque, o.law.torque)) / t->delta / a->size);
    worst = fmax(worst, fabs(0.5 * t->energy_delta * t->energy_delta / o.law.energy - 1.0));
    for (int k = 0; k < 6; ++k) worst = fmax(worst, fabs(t->spread[k] - o.spread[k]) / (a->size * a->size));
    if (faces == PLS_FACES_VOLUME && !flush) worst = fmax(worst, fabs(t->weight / fabs(pls_dot(o.area, t->normal)) - 1.0));
    return worst;
}

static double difference(const pls_posed *a, const pls_posed *b, pls_faces faces, bool flush)
{
    const pls_depth d = solids_depth(a, b, NULL);
    const pls_narrow_options options = solids_options(faces, 1.0);
    pls_touch t;
    if (is_facet(b))
        t = solids_touch(a, b, faces, 1.0);
    else
        assert_true(solids_faces_touch(a, b, &d, &options, NULL, &t));
    return apart(a, b, b->shape->ops->unbounded || is_facet(b), &t, pls_scale(pls_add(d.on_a, d.on_b), 0.5), faces, flush);
}

static const char *const flush = "flush";

static void assert_agree(const pls_posed *a, const pls_posed *b, double depth, const char *what, int round)
{
    const pls_faces laws[2] = {PLS_FACES_VOLUME, PLS_FACES_MANIFOLD};
    const double tolerance = 1e-10 + 1e-14 / (depth * depth); // the numbers of slivers are noisy
    for (int k = 0; k < 2; ++k)
    {
        const double apart = difference(a, b, laws[k], what == flush);
        if (!(apart <= tolerance)) fail_msg("%s, round %d, law %d: %g", what, round, k, apart);
    }
}

/// B is shifted along n until it overlaps A by `depth`.
static pls_posed touching(const pls_posed *a, pls_posed b, pls_vec3 n, double depth)
{
    const pls_vec3 start = b.position;
    double low = 0.0, high = 5.0;
    for (int k = 0; k < 60; ++k)
    {
        const double middle = 0.5 * (low + high);
        b.position = pls_add(start, pls_scale(n, middle));
        if (solids_depth(a, &b, NULL).delta > depth)
            low = middle;
        else
            high = middle;
    }
    return b;
}

static pls_quat random_turn(int dimension)
{
    return solids_turn(dimension == 2 ? pls_vec(0, 0, 1) : solids_direction(3), solids_uniform(0, 6));
}

static pls_shape *prism(int corners)
{
    pls_vec3 x[40];
    for (int k = 0; k < 2 * corners; ++k)
        x[k] = pls_vec(0.5 * cos(2.0 * M_PI * k / corners), 0.5 * sin(2.0 * M_PI * k / corners), k < corners ? -0.3 : 0.3);
    return solids_hull(3, x, 2 * (size_t)corners, 0.0);
}

static pls_shape *random_shape(int dimension)
{
    const double kind = solids_uniform(0, 3);
    if (kind < 1.0) return solids_box(dimension, solids_uniform(0.2, 0.6), solids_uniform(0.2, 0.6), solids_uniform(0.2, 0.6), 0.0);
    if (kind < 1.5 && dimension == 3) return prism(3 + (int)solids_uniform(0, 9));
    return solids_stone(dimension, 6 + (int)solids_uniform(0, 30), 0.0);
}

// ---- tests ----------------------------------------------------------------------------------------------------------------------------------------------------

static void random_pairs_agree(void **state)
{
    (void)state;
    solids_seed(21);
    for (int round = 0; round < 400; ++round)
    {
        const int dimension = round % 4 == 3 ? 2 : 3;
        pls_shape *s = random_shape(dimension), *t = random_shape(dimension);
        const double depth = pow(10.0, solids_uniform(-4.0, -0.8));
        const pls_posed a = pls_pose(s, pls_vec(0, 0, 0), random_turn(dimension), 1.0);
        const pls_posed b = touching(&a, pls_pose(t, pls_vec(0, 0, 0), random_turn(dimension), 1.0), solids_direction(dimension), depth);
        assert_agree(&a, &b, depth, "pair", round);
        pls_shape_free(s), pls_shape_free(t);
    }
}

static void bodies_on_planes_agree(void **state)
{
    (void)state;
    solids_seed(22);
    for (int round = 0; round < 200; ++round)
    {
        const int dimension = round % 4 == 3 ? 2 : 3;
        pls_shape *s = round & 1 ? random_shape(dimension) : solids_box(dimension, 0.5, 0.3, 0.4, 0.1), *ground = solids_plane(dimension);
        const double depth = pow(10.0, solids_uniform(-4.0, -0.8));
        pls_posed a = pls_pose(s, pls_vec(0, 0, 0), random_turn(dimension), 1.0);
        const pls_posed b = pls_pose(ground, pls_vec(0.3, 0.2, dimension == 2 ? 0.0 : 0.7), random_turn(dimension), 1.0);
        const pls_vec3 up = pls_posed_gradient(&b, b.position);
        a.position = pls_add(a.position, pls_scale(up, solids_depth(&a, &b, NULL).delta - depth));
        assert_agree(&a, &b, depth, "plane", round);
        pls_shape_free(s), pls_shape_free(ground);
    }
}

static pls_shape *mesh_of(const char *name, const char *text, double rounding)
{
    FILE *f = fopen(name, "w");
    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
    const double values[] = {rounding, 1.0};
    return solids_make(&pls_mesh_shape, 3, &(pls_shape_input){.values = values, .value_count = 2, .path = name});
}

static void bodies_on_a_facet_agree(void **state)
{
    (void)state;
    solids_seed(23);
    for (int round = 0; round < 100; ++round)
    {
        const int dimension = round % 4 == 3 ? 2 : 3;
        const double line_values[] = {0.05, 0.0};
        const pls_vec3 line[2] = {{-1.5, 0, 0}, {0.1, 0.2, 0}};
        pls_shape *floor = dimension == 3
                               ? mesh_of("facet.obj", "v -1.5 -1.5 0\nv 1.5 -1.2 0.1\nv 0.05 0.8 0.3\nf 1 2 3\n", 0.05)
                               : solids_make(&pls_polyline_shape, 2,
                                             &(pls_shape_input){.values = line_values, .value_count = 2, .points = line, .point_count = 2});
        pls_shape *s = round & 1 ? random_shape(dimension) : solids_box(dimension, 0.5, 0.3, 0.4, 0.1);
        const double depth = pow(10.0, solids_uniform(-3.0, -1.0));
        size_t count = 0;
        const pls_shape_part *one = floor->ops->parts(floor, &count);
        assert_int_equal(count, 1);
        const pls_posed piece = pls_pose(one->shape, one->position, one->orientation, 1.0);
        const pls_vec3 up = dimension == 2 ? pls_vec(0, 1, 0) : pls_vec(0, 0, 1),
                       aside =
                           pls_vec(solids_uniform(-0.8, 0.8), dimension == 3 ? solids_uniform(-0.8, 0.8) : 0.0, 0.0); // over its sides, too
        pls_posed a = pls_pose(s, pls_add(pls_posed_world(&piece, one->shape->mass.centre), aside), random_turn(dimension), 1.0);
        a = touching(&piece, a, up, depth);
        assert_agree(&a, &piece, depth, "facet", round);
        pls_shape_free(s), pls_shape_free(floor);
    }
}

/// The facets of a closed wall: depth is that below the nearest of its faces, also where the body lies over edges and corners. (Of a block
/// that is no cube diagonals do not halve the corners of faces, and there the cells of two facets may share a little.)
static void bodies_on_a_block_of_triangles_agree(void **state)
{
    (void)state;
    solids_seed(27);
    static const char *const text =
        "v -0.5 -0.5 -0.5\nv 0.5 -0.5 -0.5\nv 0.5 0.5 -0.5\nv -0.5 0.5 -0.5\nv -0.5 -0.5 0.5\nv 0.5 -0.5 0.5\nv 0.5 0.5 0.5\nv -0.5 0.5 "
        "0.5\n"
        "f 1 3 2\nf 1 3 4\nf 5 6 7\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 6 7\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";
    pls_shape *block = mesh_of("block.obj", text, 0.0), *same = solids_box(3, 0.5, 0.5, 0.5, 0.0);
    const pls_posed whole = pls_pose(same, pls_vec(0, 0, 0), same->principal, 1.0),
                    wall = pls_pose(block, pls_vec(0, 0, 0), pls_quat_identity(), 1.0);
    for (int round = 0; round < 200; ++round)
    {
        pls_shape *s = round & 1 ? random_shape(3)
                                 : solids_box(3, 0.5, 0.3, 0.4, round & 2 ? 0.05 : 0.0); // of rounded ones the core behind raised faces
        const double depth = pow(10.0, solids_uniform(-3.0, -1.0)), tolerance = 1e-10 + 1e-14 / (depth * depth);
        const pls_posed a = touching(&whole, pls_pose(s, pls_vec(0, 0, 0), random_turn(3), 1.0), solids_direction(3), depth);
        for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
        {
            const pls_touch t = solids_wall_touch(&a, &wall, faces, 1.0);
            const double off = apart(&a, &whole, true, &t, t.point, faces, false);
            if (!(off <= tolerance)) fail_msg("round %d, law %d, depth %g: %g", round, faces, depth, off);
        }
        pls_shape_free(s);
    }
    pls_shape_free(block), pls_shape_free(same);
}

/// Faces in one plane, edges and corners on each other, as in a wall of bricks; turned as a whole, so that numbers are not even.
static void flush_bricks_and_prisms_agree(void **state)
{
    (void)state;
    solids_seed(24);
    for (int round = 0; round < 300; ++round)
    {
        const int kind = round % 3;
        pls_shape *s = kind == 0 ? solids_box(3, 0.5, 0.3, 0.2, 0.0) : kind == 1 ? prism(6) : solids_box(2, 0.5, 0.2, 1.0, 0.0);
        const int dimension = kind == 2 ? 2 : 3;
        const double depth = pow(10.0, solids_uniform(-4.0, -1.5)), h = kind == 1 ? 0.3 : 0.2;
        const double steps[4] = {0.0, 0.5, 0.25, -0.5}, x = steps[(round / 3) % 4], y = kind == 0 ? 0.6 * steps[(round / 12) % 4] : 0.0;
        const pls_quat q = round < 150 ? pls_quat_identity() : random_turn(dimension), own = s->principal;
        const pls_vec3 shift = dimension == 2 ? pls_vec(x, 2.0 * h - depth, 0) : pls_vec(x, y, 2.0 * h - depth);
        const pls_posed a = pls_pose(s, pls_vec(0, 0, 0), pls_quat_multiply(q, own), 1.0);
        const pls_posed b = pls_pose(s, pls_rotate(q, shift), pls_quat_multiply(q, own), 1.0);
        assert_agree(&a, &b, depth, flush, round);
        pls_shape_free(s);
    }
}

/// Of overlaps as shallow as rounding errors nothing is asked but numbers that are numbers and a force that is not too large.
static void shallow_and_flush_overlaps_stay_finite(void **state)
{
    (void)state;
    solids_seed(25);
    for (int round = 0; round < 2000; ++round)
    {
        const int dimension = round % 4 == 3 ? 2 : 3;
        pls_shape *s = random_shape(dimension), *t = round & 1 ? s : random_shape(dimension);
        const double depth = pow(10.0, solids_uniform(-13.0, -6.0));
        const pls_quat turn = random_turn(dimension);
        const pls_posed a = pls_pose(s, pls_vec(0, 0, 0), turn, 1.0);
        const pls_posed b = touching(&a, pls_pose(t, pls_vec(0, 0, 0), round % 8 < 4 ? turn : random_turn(dimension), 1.0),
                                     solids_direction(dimension), depth);
        const pls_depth d = solids_depth(&a, &b, NULL);
        for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
        {
            const pls_narrow_options options = solids_options(faces, 1.0);
            pls_touch touch, again;
            memset(&touch, 0, sizeof touch), memset(&again, 0, sizeof again);
            assert_true(solids_faces_touch(&a, &b, &d, &options, NULL, &touch) && solids_faces_touch(&a, &b, &d, &options, NULL, &again));
            assert_memory_equal(&touch, &again, sizeof touch);
            const double all = touch.delta + touch.energy_delta + touch.weight + touch.twist + pls_length(touch.point) +
                               pls_length(touch.middle) + pls_length(touch.normal) + touch.lever + touch.spread[0] + touch.spread[1];
            assert_true(isfinite(all));
            if (!(touch.delta <= (faces == PLS_FACES_VOLUME ? 4.0 : 1.5) * fmax(d.delta, 0.0) + 1e-12))
                fail_msg("round %d: a force of %g at a depth of %g", round, touch.delta, d.delta);
        }
        if (t != s) pls_shape_free(t);
        pls_shape_free(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_pairs_agree),
        cmocka_unit_test(bodies_on_planes_agree),
        cmocka_unit_test(bodies_on_a_facet_agree),
        cmocka_unit_test(bodies_on_a_block_of_triangles_agree),
        cmocka_unit_test(flush_bricks_and_prisms_agree),
        cmocka_unit_test(shallow_and_flush_overlaps_stay_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
