// column_quadrature.c -- moments of the part of a shape that lies in a cube, by quadrature along columns.
//
// Columns run along the axis the surface's normals are most along; on each, the pieces where phi < 0 are found by root finding and integrated in closed form (with
// a density: by Gauss's rule). What is left is a function of two coordinates, integrated along lines and then across them by Gauss's rule. It is smooth but where the
// surface passes through the cube's bottom or top, where it has an edge, and where a column comes to cross it twice more. Each line is therefore divided at such
// places, found from roots of phi along the bottom and top and from the tangents at the columns of its ends; and the range of lines is divided where such a place
// passes through an end of a line (R. I. Saye, SIAM J. Sci. Comput. 37 (2015) A993 does so for smooth surfaces; edges are treated here in the same way). So smooth
// parts converge with the order of the rule, plane faces and straight edges are exact, and only corners and what was missed is left to smaller cubes: a place that
// is wrongly divided costs time, never correctness.

#include "shape/column_quadrature.h"

#include "math/gauss.h"

enum {
    MOST_CROSSINGS = 8,
    MOST_BREAKS = 24, ///< places at which a line is divided
    DEEP = 6,         ///< halvings in search of pairs of crossings
    NESTED = 3,       ///< halvings of lines in search of edges
    TURNS = 4         ///< of the search for one edge
};
static const double sharpness = 1e-14; ///< of crossings, of the reach
static const double inset = 1e-4;      ///< of a piece of a line: where its ends are looked at
static const double gentle = 1e-3;     ///< change of slope that is not taken for an edge

/// Rules on -1 .. 1: Gauss's for what is told; for how far it may err Lobatto's, of lesser degree and with points on the sides of the cube, so that a bit of surface
/// that comes in through a side, between the points of the first, is not overlooked.
typedef struct rule
{
    double node[5], weight[5];
} rule;
static const rule gauss = {{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640},
                           {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665, 0.2369268850561891}};
static const rule lobatto = {{-1.0, -0.6546536707079771, 0.0, 0.6546536707079771, 1.0},
                             {0.1, 0.5444444444444444, 0.7111111111111111, 0.5444444444444444, 0.1}};

/// A cube with its columns: along axis `up`, on lines along `in`, which follow each other along `out`.
typedef struct block
{
    const pls_column_frame *frame;
    const rule *rule;
    int up, in, out;
    double low[3], high[3];
} block;

double pls_column_phi(const pls_column_frame *f, const double x[3])
{
    pls_vec3 X =
        pls_add(f->origin, pls_add(pls_scale(f->axis[0], x[0]), pls_add(pls_scale(f->axis[1], x[1]), pls_scale(f->axis[2], x[2]))));
    return f->shape->ops->sdf(f->shape, X);
}

void pls_column_gradient(const pls_column_frame *f, const double x[3], double g[3])
{
    pls_vec3 X =
        pls_add(f->origin, pls_add(pls_scale(f->axis[0], x[0]), pls_add(pls_scale(f->axis[1], x[1]), pls_scale(f->axis[2], x[2]))));
    pls_vec3 own = pls_shape_gradient(f->shape, X);
    for (int a = 0; a < 3; ++a) g[a] = pls_dot(own, f->axis[a]);
}

// ---- crossings ----------------------------------------------------------------------------------------------------------------------------------------------

/// Where phi changes sign along an axis, in order.
typedef struct crossings
{
    bool inside; ///< at the beginning
    int count;
    double at[MOST_CROSSINGS];
} crossings;

/// A line through x along an axis.
typedef struct ray
{
    const pls_column_frame *frame;
    double x[3];
    int axis;
} ray;

static double phi_on(ray *r, double t)
{
    r->x[r->axis] = t;
    return pls_column_phi(r->frame, r->x);
}

/// The root between a and b: regula falsi with Anderson and Bjorck's weights, halving where that is slow.
static double root_between(ray *r, double a, double fa, double b, double fb)
{
    const double enough = sharpness * r->frame->reach;
    for (int k = 0; k < 100 && fabs(b - a) > enough; ++k)
    {
        double x = k % 8 == 7 ? 0.5 * (a + b) : (a * fb - b * fa) / (fb - fa), fx = phi_on(r, x);
        if (fabs(fx) <= enough) return x;
        if ((fx < 0.0) != (fb < 0.0))
            a = b, fa = fb;
        else
        {
            double m = 1.0 - fx / fb;
            fa *= m > 0.0 ? m : 0.5;
        }
        b = x, fb = fx;
    }
    return b;
}

/// Within |phi| of a point there is no surface. Where that leaves a gap between two points of one sign, look into the middle of the gap.
static void search(ray *r, double a, double fa, double b, double fb, int depth, crossings *out)
{
    if ((fa < 0.0) != (fb < 0.0))
    {
        if (out->count < MOST_CROSSINGS) out->at[out->count++] = root_between(r, a, fa, b, fb);
        return;
    }
    if (depth == DEEP || fabs(fa) + fabs(fb) >= b - a || (fa < 0.0 && r->frame->shape->convex)) return;
    double m = 0.5 * (a + b + fabs(fa) - fabs(fb)), fm = phi_on(r, m);
    search(r, a, fa, m, fm, depth + 1, out);
    search(r, m, fm, b, fb, depth + 1, out);
}

static crossings find_crossings(const pls_column_frame *frame, const double x[3], int axis, double a, double b)
{
    ray r = {frame, {x[0], x[1], x[2]}, axis};
    double fa = phi_on(&r, a), fb = phi_on(&r, b);
    crossings out = {.inside = fa < 0.0};
    search(&r, a, fa, b, fb, 0, &out);
    return out;
}

// ---- columns ------------------------------------------------------------------------------------------------------------------------------------------------

double pls_column_density(const pls_column_frame *f, pls_vec3 X)
{
    const pls_shape *shape = f->shape;
    const double own = shape->ops->density ? shape->ops->density(shape, X) : 1.0;
    const double value = shape->density ? own * shape->density->at(shape->density->context, X) : own;
    if (value > 0.0 && isfinite(value)) return value;
    if (!f->uneven->found) *f->uneven = (pls_density_fault){true, X, value};
    return 1.0;
}

/// Integrals of density, times z, times z^2, from a to b.
static void piece(const block *c, double x[3], double a, double b, double line[3])
{
    double middle = 0.5 * (a + b), half = 0.5 * (b - a);
    if (!c->frame->uneven)
    {
        line[0] += 2.0 * half;
        line[1] += 2.0 * half * middle;
        line[2] += 2.0 * half * (middle * middle + half * half / 3.0);
        return;
    }
    for (int k = 0; k < 8; ++k)
    {
        double z = middle + (k & 1 ? half : -half) * pls_gauss_node[k / 2];
        x[c->up] = z;
        pls_vec3 X = c->frame->origin;
        for (int a3 = 0; a3 < 3; ++a3) X = pls_add(X, pls_scale(c->frame->axis[a3], x[a3]));
        double mass = pls_column_density(c->frame, X) * pls_gauss_weight[k / 2] * half;
        line[0] += mass, line[1] += mass * z, line[2] += mass * z * z;
    }
}

/// Add the moments of a column, times `weight`.
static void add_column(const block *c, double in, double out, double weight, double sum[PLS_MOMENTS])
{
    double x[3], line[3] = {0.0, 0.0, 0.0}, begin = c->low[c->up];
    x[c->up] = begin, x[c->in] = in, x[c->out] = out;
    crossings found = find_crossings(c->frame, x, c->up, c->low[c->up], c->high[c->up]);
    bool inside = found.inside;
    for (int k = 0; k <= found.count; ++k, inside = !inside)
    {
        double end = k < found.count ? found.at[k] : c->high[c->up];
        if (inside) piece(c, x, begin, end, line);
        begin = end;
    }
    double first[3], second[3][3];
    first[c->up] = line[1], first[c->in] = line[0] * in, first[c->out] = line[0] * out;
    second[c->up][c->up] = line[2], second[c->in][c->in] = line[0] * in * in, second[c->out][c->out] = line[0] * out * out;
    second[c->up][c->in] = second[c->in][c->up] = line[1] * in;
    second[c->up][c->out] = second[c->out][c->up] = line[1] * out;
    second[c->in][c->out] = second[c->out][c->in] = line[0] * in * out;
    const double all[PLS_MOMENTS] = {line[0],      first[0],     first[1],     first[2],     second[0][0],
                                     second[1][1], second[2][2], second[0][1], second[0][2], second[1][2]};
    for (int k = 0; k < PLS_MOMENTS; ++k) sum[k] += weight * all[k];
}

// ---- where a line is to be divided ----------------------------------------------------------------------------------------------------------------------------

/// A line of columns: along `axis` (`in` or `out` of the block) from low to high, the other of the two being `fixed`.
typedef struct row
{
    const block *block;
    int axis, other;
    double fixed;
    int count;
    double at[MOST_BREAKS]; ///< places, in no order
} row;

static void add_break(row *r, double t)
{
    if (r->count < MOST_BREAKS) r->at[r->count++] = t;
}

/// A column and how its crossings move along the row.
typedef struct slice
{
    double t;
    crossings found;
    double slope[MOST_CROSSINGS];
} slice;

static slice slice_at(const row *r, double t)
{
    const block *c = r->block;
    double x[3], g[3];
    x[c->up] = 0.0, x[r->axis] = t, x[r->other] = r->fixed;
    slice s = {.t = t, .found = find_crossings(c->frame, x, c->up, c->low[c->up], c->high[c->up])};
    for (int k = 0; k < s.found.count; ++k)
    {
        x[c->up] = s.found.at[k];
        pls_column_gradient(c->frame, x, g);
        s.slope[k] = -g[r->axis] / copysign(fmax(fabs(g[c->up]), 1e-9), g[c->up]);
    }
    return s;
}

/// Both ends have the same crossings: where do the tangents meet that differ most? An edge if the surface is there too, and not far off as on an arc.
static bool find_edge(const row *r, slice a, slice b, double *place)
{
    int worst = -1;
    double most = gentle;
    for (int k = 0; k < a.found.count; ++k)
        if (fabs(a.slope[k] - b.slope[k]) > most) most = fabs(a.slope[k] - b.slope[k]), worst = k;
    if (worst < 0) return false;
    for (int turn = 0; turn < TURNS; ++turn)
    {
        double length = b.t - a.t, bend = b.slope[worst] - a.slope[worst], za = a.found.at[worst], zb = b.found.at[worst];
        double t = a.t + (za - zb + b.slope[worst] * length) / bend;
        if (!(fabs(bend) > gentle) || !(t > a.t && t < b.t)) return turn > 0;
        double z = za + a.slope[worst] * (t - a.t);
        slice m = slice_at(r, t);
        if (m.found.count != a.found.count) return turn > 0;
        double off = fabs(m.found.at[worst] - z);
        if (turn == 0 && off > 0.25 * 0.25 * fabs(bend) * length) return false; // an arc's is twice as far
        *place = t;
        if (off < 1e-10 * length) return true;
        if (fabs(m.slope[worst] - a.slope[worst]) < fabs(m.slope[worst] - b.slope[worst]))
            a = m;
        else
            b = m;
    }
    return true;
}

/// One end has two crossings more: where do they meet?
static bool find_birth(const row *r, slice many, const slice *few, double *place)
{
    const double way = few->t - many.t;
    const int count = many.found.count;
    bool found = false;
    for (int turn = 0; turn < TURNS && many.found.count == count; ++turn)
    {
        double nearest = fabs(few->t - many.t);
        bool closing = false;
        for (int k = 0; k + 1 < many.found.count; ++k)
        {
            double thick = many.found.at[k + 1] - many.found.at[k], shrink = (many.slope[k] - many.slope[k + 1]) * copysign(1.0, way);
            if (shrink > 0.0 && thick / shrink < nearest) nearest = thick / shrink, closing = true;
        }
        if (!closing) return found;
        *place = many.t + copysign(nearest, way);
        found = true;
        if (nearest < 1e-10 * fabs(way)) return true;
        many = slice_at(r, many.t + copysign((turn < 2 ? 0.9 : 0.999) * nearest, way));
    }
    return found;
}

static void break_at_edges(row *r, double low, double high, int depth)
{
    double aside = inset * (high - low), place = 0.0;
    if (!(aside > 1e-8 * r->block->frame->reach)) return;
    slice a = slice_at(r, low + aside), b = slice_at(r, high - aside);
    bool found = false;
    if (a.found.count == b.found.count)
        found = find_edge(r, a, b, &place);
    else if (a.found.count > b.found.count)
        found = find_birth(r, a, &b, &place);
    else
        found = find_birth(r, b, &a, &place);
    if (!found) return;
    add_break(r, place);
    if (depth == NESTED) return;
    break_at_edges(r, low, place, depth + 1);
    break_at_edges(r, place, high, depth + 1);
}

static void sort_breaks(row *r)
{
    for (int k = 1; k < r->count; ++k)
    {
        double moved = r->at[k];
        int place = k;
        for (; place > 0 && r->at[place - 1] > moved; --place) r->at[place] = r->at[place - 1];
        r->at[place] = moved;
    }
}

static void find_breaks(row *r)
{
    const block *c = r->block;
    double x[3];
    x[r->axis] = 0.0, x[r->other] = r->fixed;
    for (int end = 0; end < 2; ++end)
    {
        x[c->up] = end ? c->high[c->up] : c->low[c->up];
        crossings clipped = find_crossings(c->frame, x, r->axis, c->low[r->axis], c->high[r->axis]);
        for (int k = 0; k < clipped.count; ++k) add_break(r, clipped.at[k]);
    }
    sort_breaks(r);
    row pieces = *r;
    double from = c->low[r->axis];
    for (int k = 0; k <= pieces.count; ++k)
    {
        double to = k < pieces.count ? pieces.at[k] : c->high[r->axis];
        break_at_edges(r, from, to, 0);
        from = to;
    }
    sort_breaks(r);
}

// ---- the cube -------------------------------------------------------------------------------------------------------------------------------------------------

/// Moments of one line of columns, times `weight`.
static void add_row(const block *c, double out, double weight, double sum[PLS_MOMENTS])
{
    row r = {.block = c, .axis = c->in, .other = c->out, .fixed = out};
    find_breaks(&r);
    double from = c->low[c->in];
    for (int k = 0; k <= r.count; ++k)
    {
        double to = k < r.count ? r.at[k] : c->high[c->in], half = 0.5 * (to - from);
        for (int q = 0; q < 5 && half > 0.0; ++q)
            add_column(c, from + half * (1.0 + c->rule->node[q]), out, weight * half * c->rule->weight[q], sum);
        from = to;
    }
}

/// Moments of the block by the axes it has.
static void measure(const block *c, double sum[PLS_MOMENTS])
{
    for (int k = 0; k < PLS_MOMENTS; ++k) sum[k] = 0.0;
    if (c->frame->shape->dimension == 2)
    {
        add_row(c, 0.0, 1.0, sum);
        return;
    }
    row r = {.block = c, .axis = c->out, .other = c->in, .fixed = c->low[c->in]};
    row other = {.block = c, .axis = c->out, .other = c->in, .fixed = c->high[c->in]};
    find_breaks(&r);
    find_breaks(&other);
    for (int k = 0; k < other.count; ++k) add_break(&r, other.at[k]);
    sort_breaks(&r);
    double from = c->low[c->out];
    for (int k = 0; k <= r.count; ++k)
    {
        double to = k < r.count ? r.at[k] : c->high[c->out], half = 0.5 * (to - from);
        for (int q = 0; q < 5 && half > 0.0; ++q) add_row(c, from + half * (1.0 + c->rule->node[q]), half * c->rule->weight[q], sum);
        from = to;
    }
}

/// Columns along the axis that all normals seen in the cube are most along, lines along the next: then surfaces leave through the bottom or the top across the lines.
static void choose_axes(block *c, const double centre[3], double half)
{
    static const double corner[5][3] = {{0, 0, 0}, {1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    const int dimension = c->frame->shape->dimension;
    double least[3] = {1.0, 1.0, 1.0}, sum[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 5; ++k)
    {
        double x[3], g[3];
        for (int a = 0; a < 3; ++a) x[a] = centre[a] + (a < dimension ? 0.7 * half * corner[k][a] : 0.0);
        pls_column_gradient(c->frame, x, g);
        for (int a = 0; a < 3; ++a) least[a] = fmin(least[a], fabs(g[a])), sum[a] += fabs(g[a]);
    }
    c->up = least[1] > least[0] ? 1 : 0;
    if (dimension == 3 && least[2] > least[c->up]) c->up = 2;
    c->in = (c->up + 1) % 3, c->out = (c->up + 2) % 3;
    if (dimension == 2 ? c->in == 2 : sum[c->out] > sum[c->in]) c->in = c->out, c->out = 3 - c->up - c->in;
}

void pls_column_moments(const pls_column_frame *frame, const double centre[3], double half, double sum[PLS_MOMENTS],
                        double again[PLS_MOMENTS])
{
    block c = {.frame = frame, .rule = &gauss};
    choose_axes(&c, centre, half);
    for (int a = 0; a < 3; ++a) c.low[a] = centre[a] - half, c.high[a] = centre[a] + half;
    measure(&c, sum);
    int *first = frame->shape->dimension == 2 ? &c.up : &c.out, kept = *first;
    *first = c.in, c.in = kept, c.rule = &lobatto;
    measure(&c, again);
}
