// feature_depth.c -- Newton's method on what the features that touch leave open of the normal.
//
// F(n) = h_A(n) + h_B(-n) has kinks where a support point jumps. But which corner, edge or face of a polytope is the furthest changes seldom from step to step, and as long as it does not,
// it only narrows the normal down:
//
//     face    the normal is that of the face
//     edge    the normal is at right angles to the edge: one angle is open
//     corner  and all that is round: open in both
//
// On what is left F is smooth, and Newton's method finds its minimum in two or three iterations (smooth_depth.c has the derivatives). It is one of the whole F if, first, the features still are the
// furthest along the normal, and second, the points nearest to each other lie on them: the rest of (point of A - point of B - F n) must be a step along the edges or within the face.
// Two edges leave one normal. Two faces, or an edge along a face, touch in more than a point: not for here.
//
// A cylinder has faces without corners, edges that go along with the normal (its sides), and rims, which are round one way.

#include "contact/feature_depth.h"

#include "contact/smooth_depth.h"
#include "shape/builtin.h"

static const double enough = 1e-13;      ///< of the size, on what is left of the gradient
static const double rounding = 1e-14;    ///< of the size: by which other vertices may be higher
static const double longest = 0.3;       ///< step [rad]
static const double nearly_along = 1e-4; ///< sine of the angle of edges that leave no normal to speak of
static const double least_turn = 1e-8;   ///< of the normal, at which a search begins that has no other measure [rad]
static const double sloping = 1e-9;      ///< slope of the distance along an edge that leaves its least value to round-off
static const double steepest = 1e-11;    ///< as `enough`, where round-off of the normal leaves more
enum { MOST = 8, MOST_CHANGES = 6, MOST_CHORDS = 60 };

enum kind { UNKNOWN, ROUND, CORNER, EDGE, FACE };

/// What a look at the features of now gives: a minimum of F, other features to look at, or nothing.
enum answer { FOUND, CHANGED, NONE };

/// One of the two bodies.
typedef struct side
{
    const pls_posed *p;
    double sign; ///< its outward normal is sign * n
    bool cylinder;
    enum kind kind;
    uint32_t v[2];    ///< CORNER, EDGE: vertices; FACE: its number
    pls_vec3 edge;    ///< EDGE: unit, in the world
    double low, high; ///< and how far it reaches from `point` along that [m]
    double margin;    ///< to be added to `point` along the outward normal [m]
    pls_vec3 point;   ///< support point, of the core [m]
    pls_vec3 on;      ///< witness point on the surface [m]
} side;

// ---- features -----------------------------------------------------------------------------------------------------------------------------------------------------

static bool is_cylinder(const pls_shape *s) { return s->ops == &pls_cylinder_shape; }
static double cylinder_radius(const pls_shape *s) { return s->values[0] - s->margin; }
static double cylinder_half(const pls_shape *s) { return 0.5 * s->values[1] - s->margin; }

static uint32_t highest(const pls_polytope *t, pls_vec3 m)
{
    uint32_t best = 0;
    for (uint32_t v = 1; v < t->vertex_count; ++v)
        if (pls_dot(t->vertex[v], m) > pls_dot(t->vertex[best], m)) best = v;
    return best;
}

/// Of the polytope's vertices those that may be as high as v: its neighbours.
static uint32_t others(const pls_polytope *t, uint32_t v, const uint32_t **list)
{
    *list = t->neighbour_start ? t->neighbour + t->neighbour_start[v] : NULL;
    return t->neighbour_start ? t->neighbour_start[v + 1] - t->neighbour_start[v] : t->vertex_count;
}

static void classify_polytope(side *s, pls_vec3 m, double together)
{
    const pls_polytope *t = s->p->shape->polytope;
    const uint32_t v = highest(t, m), *list, count = others(t, v, &list);
    const double least = pls_dot(t->vertex[v], m) - together * s->p->shape->radius;
    double second = -INFINITY;
    uint32_t level = 0;
    s->v[0] = v;
    for (uint32_t k = 0; k < count; ++k)
    {
        const uint32_t w = list ? list[k] : k;
        const double height = pls_dot(t->vertex[w], m);
        if (w == v || height < least) continue;
        ++level;
        if (height > second) second = height, s->v[1] = w;
    }
    s->kind = level == 0 ? CORNER : EDGE;
    if (level < 2 || s->p->shape->dimension == 2 || t->face_count == 0) return;
    uint32_t face = 0;
    for (uint32_t f = 1; f < t->face_count; ++f)
        if (pls_dot(t->face_normal[f], m) > pls_dot(t->face_normal[face], m)) face = f;
    s->kind = FACE;
    s->v[0] = face;
}

/// What is nearly as high as the highest is taken for one feature with it; the first look then tells.
static void classify(side *s, pls_vec3 n, double together)
{
    const pls_vec3 m = pls_posed_turn_back(s->p, pls_scale(n, s->sign));
    if (s->p->shape->polytope)
        classify_polytope(s, m, together);
    else if (s->cylinder)
    {
        s->kind = fabs(m.z) < together ? EDGE : hypot(m.x, m.y) < together ? FACE : CORNER;
        s->v[0] = m.z < 0.0;
    }
    else
        s->kind = ROUND;
}

static void recall(side *s, const double memory[2])
{
    s->kind = (enum kind)memory[0];
    s->v[0] = (uint32_t)memory[1] >> 16, s->v[1] = (uint32_t)memory[1] & 0xffff;
}

static void remember(const side *s, double memory[2])
{
    memory[0] = s->kind;
    memory[1] = s->kind == ROUND ? 0.0 : (double)((s->v[0] << 16) + s->v[1]);
}

/// What does not depend on the normal. False: no feature of this shape's is known.
static bool take(side *s)
{
    const pls_shape *shape = s->p->shape;
    const double scale = s->p->scale;
    s->margin = s->kind == ROUND ? 0.0 : shape->margin * scale;
    if (s->kind == EDGE && s->cylinder)
    {
        s->edge = s->p->z;
        s->high = cylinder_half(shape) * scale, s->low = -s->high;
    }
    else if (s->kind == EDGE)
    {
        const pls_vec3 along = pls_sub(shape->polytope->vertex[s->v[1]], shape->polytope->vertex[s->v[0]]);
        s->high = pls_length(along) * scale, s->low = 0.0;
        s->edge = pls_posed_turn(s->p, pls_scale(along, scale / s->high));
    }
    return s->kind != UNKNOWN;
}

static bool known_shape(const pls_shape *s)
{
    if (s->polytope) return s->polytope->vertex_count > 1 && s->polytope->vertex_count < 65536;
    return is_cylinder(s) || (s->ops->smooth && s->ops->support && s->ops->support_gradient);
}

static bool begin(side *s, const pls_posed *p, double sign, pls_vec3 n, double together, const double memory[2])
{
    *s = (side){.p = p, .sign = sign, .cylinder = is_cylinder(p->shape)};
    if (!known_shape(p->shape)) return false;
    recall(s, memory);
    if (s->kind == UNKNOWN) classify(s, n, together);
    return true;
}

// ---- at a normal --------------------------------------------------------------------------------------------------------------------------------------------------

/// The cylinder's point; `CORNER` is on a rim, `EDGE` in the middle of a side, `FACE` in the middle of an end.
static pls_vec3 cylinder_point(const side *s, pls_vec3 m)
{
    const double r = s->kind == FACE ? 0.0 : cylinder_radius(s->p->shape) / hypot(m.x, m.y);
    const double h = s->kind == EDGE ? 0.0 : cylinder_half(s->p->shape);
    return pls_vec(r * m.x, r * m.y, s->v[0] ? -h : h);
}

static void look(side *s, pls_vec3 n)
{
    const pls_vec3 outward = pls_scale(n, s->sign);
    if (s->kind == ROUND)
        s->point = pls_posed_support(s->p, outward);
    else if (s->cylinder)
        s->point = pls_posed_world(s->p, cylinder_point(s, pls_posed_turn_back(s->p, outward)));
    else
    {
        const pls_polytope *t = s->p->shape->polytope;
        s->point = pls_posed_world(s->p, t->vertex[s->kind == FACE ? t->face_vertex[t->face_start[s->v[0]]] : s->v[0]]);
    }
    s->on = pls_add(s->point, pls_scale(outward, s->margin));
}

/// Add e1.(H e1), e1.(H e2), e2.(H e2), H the derivative of the support point.
static void add_curvature(const side *s, pls_vec3 n, const pls_vec3 e[2], double h[3])
{
    if (s->kind == ROUND)
    {
        pls_add_support_curvature(s->p, pls_scale(n, s->sign), e, h);
        return;
    }
    h[0] += s->margin, h[2] += s->margin;
    if (!s->cylinder || s->kind == FACE) return;
    const pls_vec3 m = pls_posed_turn_back(s->p, n);
    const double across = hypot(m.x, m.y), r = cylinder_radius(s->p->shape) * s->p->scale / across;
    const pls_vec3 round = pls_posed_turn(s->p, pls_vec(-m.y / across, m.x / across, 0.0));
    const double u = pls_dot(round, e[0]), v = pls_dot(round, e[1]);
    h[0] += r * u * u, h[1] += r * u * v, h[2] += r * v * v;
}

static void to_corner(side *s, uint32_t v) { s->kind = CORNER, s->v[0] = v; }
static void to_edge(side *s, uint32_t v, uint32_t w) { s->kind = EDGE, s->v[0] = v, s->v[1] = w; }

/// The face at an edge that looks along m most. In 2D edges are faces.
static void to_face(side *s, pls_vec3 m)
{
    const pls_polytope *t = s->p->shape->polytope;
    double most = -INFINITY;
    s->kind = UNKNOWN;
    for (uint32_t f = 0; f < t->face_count && s->p->shape->dimension == 3; ++f)
    {
        int held = 0;
        for (uint32_t k = t->face_start[f]; k < t->face_start[f + 1]; ++k)
            held += t->face_vertex[k] == s->v[0] || t->face_vertex[k] == s->v[1];
        const double along = pls_dot(t->face_normal[f], m);
        if (held < 2 || along <= most) continue;
        s->kind = FACE;
        most = along, s->v[0] = f;
    }
}

/// Is something of the body higher than the feature? Then it becomes one that holds that as well.
static bool rises(side *s, pls_vec3 n)
{
    const pls_vec3 m = pls_posed_turn_back(s->p, pls_scale(n, s->sign));
    if (s->kind == ROUND || s->kind == FACE || (s->cylinder && s->kind == EDGE)) return false;
    if (s->cylinder)
    {
        const bool good = s->v[0] ? m.z < 0.0 : m.z > 0.0;
        if (!good) s->kind = EDGE;
        return !good;
    }
    const pls_polytope *t = s->p->shape->polytope;
    double most = pls_dot(t->vertex[s->v[0]], m) + rounding * s->p->shape->radius;
    uint32_t higher = s->v[0];
    for (int k = 0; k < (s->kind == EDGE ? 2 : 1); ++k)
    {
        const uint32_t *list, count = others(t, s->v[k], &list);
        for (uint32_t l = 0; l < count; ++l)
        {
            const uint32_t w = list ? list[l] : l;
            if (w == s->v[0] || (s->kind == EDGE && w == s->v[1])) continue;
            const double height = pls_dot(t->vertex[w], m);
            if (height > most) most = height, higher = w;
        }
    }
    if (higher == s->v[0]) return false;
    if (s->kind == CORNER)
        to_edge(s, s->v[0], higher);
    else
        to_face(s, m);
    return true;
}

/// Is a point over the face, in the world, within its outline? If not, the feature becomes the edge that it is beyond.
static enum answer over_face(side *s, pls_vec3 X)
{
    const pls_vec3 x = pls_posed_own(s->p, X);
    if (s->cylinder) return hypot(x.x, x.y) <= cylinder_radius(s->p->shape) ? FOUND : NONE;
    const pls_polytope *t = s->p->shape->polytope;
    const uint32_t face = s->v[0], first = t->face_start[face], last = t->face_start[face + 1];
    double beyond = 0.0;
    for (uint32_t k = first; k < last; ++k)
    {
        const uint32_t v = t->face_vertex[k], w = t->face_vertex[k + 1 < last ? k + 1 : first];
        const pls_vec3 out = pls_cross(pls_unit(pls_sub(t->vertex[w], t->vertex[v])), t->face_normal[face]);
        const double distance = pls_dot(out, pls_sub(x, t->vertex[v]));
        if (distance > beyond) beyond = distance, to_edge(s, v, w);
    }
    return beyond > 0.0 ? CHANGED : FOUND;
}

static pls_vec3 face_normal(const side *s)
{
    const pls_vec3 own = s->cylinder ? pls_vec(0.0, 0.0, s->v[0] ? -1.0 : 1.0) : s->p->shape->polytope->face_normal[s->v[0]];
    return pls_scale(pls_posed_turn(s->p, own), s->sign);
}

// ---- the normal -----------------------------------------------------------------------------------------------------------------------------------------------------

/// Directions that the normal is at right angles to: edges, and in 2D the way out of the plane.
typedef struct limits
{
    int count;
    pls_vec3 along[3];
    side *owner[3]; ///< null: nobody's
} limits;

static void add_limit(limits *l, pls_vec3 along, side *owner) { l->along[l->count] = along, l->owner[l->count++] = owner; }

/// Newton's iteration from `n`. `gap`: difference of the points, less F n.
static bool find_normal(side *a, side *b, const limits *l, pls_vec3 *n, double *F, pls_vec3 *gap, int *iterations)
{
    const double size = fmin(a->p->size, b->p->size);
    for (int k = 0; k <= MOST; ++k)
    {
        look(a, *n), look(b, *n);
        const pls_vec3 apart = pls_sub(a->on, b->on);
        *F = pls_dot(apart, *n);
        *gap = pls_sub(apart, pls_scale(*n, *F));
        *iterations = k;
        if (l->count == 2) return true;
        pls_vec3 e[2];
        pls_tangents(*n, a->p->shape->dimension, e);
        if (l->count == 1) e[0] = pls_cross(l->along[0], *n), e[1] = l->along[0];
        double g[2] = {pls_dot(apart, e[0]), l->count == 1 ? 0.0 : pls_dot(apart, e[1])}, h[3] = {-*F, 0.0, -*F}, step[2] = {0.0, 0.0};
        if (hypot(g[0], g[1]) < enough * size) return true;
        add_curvature(a, *n, e, h), add_curvature(b, *n, e, h);
        if (l->count == 1)
        {
            if (!(h[0] > 1e-9 * size)) return false;
            step[0] = -g[0] / h[0];
        }
        else
        {
            const double determinant = h[0] * h[2] - h[1] * h[1];
            if (!(h[0] > 0.0 && determinant > 1e-9 * size * (h[0] + h[2]))) return false;
            step[0] = (h[1] * g[1] - h[2] * g[0]) / determinant;
            step[1] = (h[1] * g[0] - h[0] * g[1]) / determinant;
        }
        if (!(hypot(step[0], step[1]) < longest)) return false;
        *n = pls_unit(pls_add(*n, pls_add(pls_scale(e[0], step[0]), pls_scale(e[1], step[1]))));
    }
    return false;
}

/// What is left of the gradient with one direction open, the normal turned by `angle` about the limit from n0.
static double slope_at(side *a, side *b, pls_vec3 along, pls_vec3 n0, double angle, pls_vec3 *n, pls_vec3 *apart)
{
    const pls_vec3 e = pls_cross(along, n0);
    *n = pls_unit(pls_add(pls_scale(n0, cos(angle)), pls_scale(e, sin(angle))));
    look(a, *n), look(b, *n);
    *apart = pls_sub(a->on, b->on);
    return pls_dot(*apart, pls_cross(along, *n));
}

/// Move the point on a cylinder's rim along it by what the other side's is off across the edge, `off` along e from this one.
static void move_on_rim(side *s, pls_vec3 e, double off)
{
    if (!s->cylinder || s->kind != CORNER) return;
    const pls_vec3 own = pls_posed_own(s->p, s->point);
    const pls_vec3 tangent = pls_posed_turn(s->p, pls_unit(pls_vec(-own.y, own.x, 0.0)));
    const double across = pls_dot(tangent, e);
    if (fabs(across) > 0.1) s->on = pls_add(s->on, pls_scale(tangent, off / across));
}

/// Where a slope changes sign, between two places: by chords, of which the end that stays counts half (the Illinois algorithm).
typedef struct
{
    double low, high, slope_low, slope_high;
    int last; // the end that moved last: -1 the low one, 1 the high one
} bracket;

static double chord(const bracket *b) { return (b->low * b->slope_high - b->high * b->slope_low) / (b->slope_high - b->slope_low); }

static void narrow(bracket *b, double at, double slope)
{
    if (slope < 0.0)
    {
        b->low = at, b->slope_low = slope;
        if (b->last < 0) b->slope_high *= 0.5;
        b->last = -1;
    }
    else
    {
        b->high = at, b->slope_high = slope;
        if (b->last > 0) b->slope_low *= 0.5;
        b->last = 1;
    }
}

/// Where Newton's steps go wild: along an edge that all but lies in a cylinder's end the point on the rim runs by its radius within that small angle. Where the slope changes sign is the place.
static bool find_turn(side *a, side *b, const limits *l, pls_vec3 *n, double *F, pls_vec3 *gap, int *iterations)
{
    const double size = fmin(a->p->size, b->p->size);
    const pls_vec3 along = l->along[0], n0 = *n;
    pls_vec3 apart;
    double slope = slope_at(a, b, along, n0, 0.0, n, &apart);
    bracket turn = {.slope_low = slope, .slope_high = slope};
    for (double reach = least_turn; turn.slope_low > 0.0 && reach < longest; reach *= 4.0)
    {
        turn.high = turn.low, turn.slope_high = turn.slope_low;
        turn.low = -reach, turn.slope_low = slope_at(a, b, along, n0, turn.low, n, &apart), ++*iterations;
    }
    for (double reach = least_turn; turn.slope_high < 0.0 && reach < longest; reach *= 4.0)
    {
        turn.low = turn.high, turn.slope_low = turn.slope_high;
        turn.high = reach, turn.slope_high = slope_at(a, b, along, n0, turn.high, n, &apart), ++*iterations;
    }
    if (!(turn.slope_low <= 0.0 && turn.slope_high >= 0.0)) return false;
    for (int k = 0; k < MOST_CHORDS && fabs(slope) >= enough * size && turn.high - turn.low > 1e-16; ++k)
    {
        const double angle = chord(&turn);
        slope = slope_at(a, b, along, n0, angle, n, &apart), ++*iterations;
        narrow(&turn, angle, slope);
    }
    *F = pls_dot(apart, *n);
    if (a->cylinder)
        move_on_rim(a, pls_cross(along, *n), -slope);
    else
        move_on_rim(b, pls_cross(along, *n), slope);
    *gap = pls_sub(pls_sub(a->on, b->on), pls_scale(*n, *F));
    return fabs(slope) < steepest * size;
}

/// The normal before the first iteration, as the limits leave it. False: they leave none.
static bool start_normal(const limits *l, pls_vec3 *n)
{
    if (l->count == 2)
    {
        const pls_vec3 c = pls_cross(l->along[0], l->along[1]);
        const double sine = pls_length(c);
        if (!(sine > nearly_along)) return false;
        *n = pls_scale(c, (pls_dot(c, *n) < 0.0 ? -1.0 : 1.0) / sine);
    }
    else if (l->count == 1)
        *n = pls_unit(pls_sub(*n, pls_scale(l->along[0], pls_dot(*n, l->along[0]))));
    return l->count <= 2;
}

/// The end of an edge.
static void to_end(side *s, bool high) { to_corner(s, s->cylinder ? (uint32_t)!high : s->v[high]); }

/// Move the witness points along the edges until they lie over each other. A point that would leave its edge stays at the end.
static enum answer slide(const limits *l, pls_vec3 gap)
{
    double x[2] = {-pls_dot(gap, l->along[0]), 0.0};
    if (l->count == 2)
    {
        const double c = pls_dot(l->along[0], l->along[1]), y = -pls_dot(gap, l->along[1]), free = 1.0 - c * c;
        x[1] = (y - c * x[0]) / free;
        x[0] = (x[0] - c * y) / free;
    }
    enum answer answer = FOUND;
    for (int k = 0; k < l->count; ++k)
    {
        side *s = l->owner[k];
        if (!s) continue;
        const double t = s->sign * x[k];
        s->on = pls_add(s->on, pls_scale(l->along[k], t));
        if (t >= s->low && t <= s->high) continue;
        to_end(s, t > s->high);
        answer = CHANGED;
    }
    return answer;
}

static enum answer at_face(side *face, side *other, pls_vec3 *n, double *F)
{
    *n = face_normal(face);
    if (other->kind == FACE) return NONE;
    look(face, *n), look(other, *n);
    if (other->kind == EDGE) // not quite along the face
    {
        const bool high = other->sign * pls_dot(other->edge, *n) > 0.0;
        const pls_vec3 end = pls_add(other->point, pls_scale(other->edge, high ? other->high : other->low));
        if (face->cylinder && over_face(face, end) != FOUND)
            to_corner(face, face->v[0]); // the edge goes over the rim
        else
            to_end(other, high);
        return CHANGED;
    }
    *F = face->sign * pls_dot(pls_sub(face->on, other->on), *n);
    face->on = pls_add(other->on, pls_scale(*n, face->sign * *F));
    return over_face(face, face->on);
}

/// Of straight lines and corners alone.
static bool is_sharp(const side *s) { return s->kind == EDGE || (s->kind == CORNER && !s->cylinder); }

/// Where the round one is as good as flat its point runs away under a normal that turns by round-off. The other way about, from a point on the edge, its nearest point is certain: the distance
/// to it is convex along the edge, and where the slope changes sign is the place.
static enum answer by_distance(side *round, side *sharp, pls_vec3 *n, pls_depth *out)
{
    const double tiny = 1e-16 * (sharp->high - sharp->low);
    look(sharp, *n);
    double margin = sharp->margin;
    if (sharp->cylinder) // its axis, thickened
    {
        sharp->point = pls_posed_world(sharp->p, pls_vec(0.0, 0.0, 0.0));
        margin += cylinder_radius(sharp->p->shape) * sharp->p->scale;
    }
    pls_vec3 x = sharp->point, g = pls_posed_gradient(round->p, x);
    if (sharp->kind == EDGE)
    {
        bracket along = {.low = sharp->low, .high = sharp->high};
        along.slope_low = pls_dot(pls_posed_gradient(round->p, pls_add(sharp->point, pls_scale(sharp->edge, along.low))), sharp->edge);
        along.slope_high = pls_dot(pls_posed_gradient(round->p, pls_add(sharp->point, pls_scale(sharp->edge, along.high))), sharp->edge);
        if (along.slope_low >= 0.0 || along.slope_high <= 0.0)
        {
            to_end(sharp, along.slope_high <= 0.0);
            return CHANGED;
        }
        for (int k = 0; k < MOST_CHORDS && along.high - along.low > tiny; ++k)
        {
            const double t = chord(&along);
            x = pls_add(sharp->point, pls_scale(sharp->edge, t));
            g = pls_posed_gradient(round->p, x);
            const double slope = pls_dot(g, sharp->edge);
            out->iterations += 1;
            if (fabs(slope) < sloping) break;
            narrow(&along, t, slope);
        }
        g = pls_unit(pls_sub(g, pls_scale(sharp->edge, pls_dot(g, sharp->edge))));
    }
    const double phi = pls_posed_sdf(round->p, x);
    *n = pls_scale(g, round->sign);
    out->delta = margin - phi;
    sharp->on = pls_sub(x, pls_scale(g, margin));
    round->on = pls_sub(x, pls_scale(g, phi));
    return FOUND;
}

static enum answer solve(side *a, side *b, pls_vec3 *n, pls_depth *out)
{
    if (!take(a) || !take(b)) return NONE;
    if (a->kind == FACE) return at_face(a, b, n, &out->delta);
    if (b->kind == FACE) return at_face(b, a, n, &out->delta);
    limits l = {.count = 0};
    if (a->kind == EDGE) add_limit(&l, a->edge, a);
    if (b->kind == EDGE) add_limit(&l, b->edge, b);
    if (a->p->shape->dimension == 2) add_limit(&l, pls_vec(0.0, 0.0, 1.0), NULL);
    pls_vec3 gap;
    int iterations = 0;
    if (!start_normal(&l, n)) return NONE;
    const pls_vec3 first = *n;
    if (!find_normal(a, b, &l, n, &out->delta, &gap, &iterations))
    {
        if (is_sharp(a) && b->kind == ROUND) return by_distance(b, a, n, out);
        if (is_sharp(b) && a->kind == ROUND) return by_distance(a, b, n, out);
        *n = first;
        if (l.count != 1 || !find_turn(a, b, &l, n, &out->delta, &gap, &iterations)) return NONE;
    }
    out->iterations += iterations;
    return l.count == 0 ? FOUND : slide(&l, gap);
}

bool pls_feature_depth(const pls_posed *a, const pls_posed *b, pls_vec3 normal, double together, double memory[PLS_FEATURE_MEMORY],
                       pls_depth *out)
{
    side A, B;
    pls_vec3 n = normal;
    *out = (pls_depth){.converged = true};
    if (!begin(&A, a, 1.0, n, together, memory) || !begin(&B, b, -1.0, n, together, memory + 2)) return false;
    enum answer answer = CHANGED;
    for (int k = 0; k < MOST_CHANGES && answer == CHANGED; ++k)
    {
        answer = solve(&A, &B, &n, out);
        if (answer != FOUND) continue;
        const bool a_rises = rises(&A, n), b_rises = rises(&B, n);
        if (a_rises || b_rises) answer = CHANGED;
    }
    for (int k = 0; k < PLS_FEATURE_MEMORY; ++k) memory[k] = 0.0;
    if (answer != FOUND || !isfinite(out->delta)) return false;
    remember(&A, memory), remember(&B, memory + 2);
    out->normal = n;
    out->on_a = A.on, out->on_b = B.on;
    return true;
}
