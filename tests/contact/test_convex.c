// Distance and depth of convex sets against separating axes, pairs of features and closed forms, on random poses and along trajectories.

#include "contact/convex.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { VERTICES = 16, TRIANGLES = 64, EDGES = 64 };
static const double pi = 3.14159265358979323846;

static uint64_t random_state = 1;

static double uniform(double low, double high)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

static pls_vec3 direction(int dimension)
{
    for (;;)
    {
        pls_vec3 n = pls_vec(uniform(-1, 1), uniform(-1, 1), dimension == 3 ? uniform(-1, 1) : 0.0);
        if (pls_length(n) < 1.0 && pls_length(n) > 0.1) return pls_unit(n);
    }
}

static pls_quat orientation(int dimension)
{
    pls_vec3 n = dimension == 3 ? direction(3) : pls_vec(0, 0, 1);
    double half = uniform(0, pi);
    return (pls_quat){cos(half), n.x * sin(half), n.y * sin(half), n.z * sin(half)};
}

/// A polytope or an ellipsoid (half axes > 0 and no vertices).
typedef struct body
{
    int dimension, vertices, triangles, edges;
    pls_vec3 grain[VERTICES], world[VERTICES];
    int triangle[TRIANGLES][3], edge[EDGES][2];
    pls_vec3 half, centre;
    pls_quat q;
    double size, margin;
} body;

static pls_vec3 support(const void *self, pls_vec3 n)
{
    const body *s = self;
    if (s->vertices == 0)
    {
        pls_vec3 m = pls_rotate_back(s->q, n), h = pls_vec(s->half.x * m.x, s->half.y * m.y, s->half.z * m.z);
        double length = pls_length(h);
        return pls_add(s->centre, pls_rotate(s->q, pls_vec(s->half.x * h.x / length, s->half.y * h.y / length, s->half.z * h.z / length)));
    }
    int best = 0;
    for (int k = 1; k < s->vertices; ++k)
        if (pls_dot(pls_sub(s->world[k], s->world[best]), n) > 0.0) best = k;
    return s->world[best];
}

static void pose(body *s, pls_vec3 centre, pls_quat q)
{
    s->centre = centre, s->q = q;
    for (int k = 0; k < s->vertices; ++k) s->world[k] = pls_add(centre, pls_rotate(q, s->grain[k]));
}

static pls_convex set_of(const body *s)
{
    pls_convex c = {support, NULL, s, s->centre, {{0, 0, 0}}, s->size, s->margin, s->vertices > 0, s->dimension};
    c.axis[0] = pls_rotate(s->q, pls_vec(1, 0, 0)), c.axis[1] = pls_rotate(s->q, pls_vec(0, 1, 0)),
    c.axis[2] = pls_rotate(s->q, pls_vec(0, 0, 1));
    return c;
}

static void add_edge(body *s, int i, int j)
{
    for (int k = 0; k < s->edges; ++k)
        if ((s->edge[k][0] == i && s->edge[k][1] == j) || (s->edge[k][0] == j && s->edge[k][1] == i)) return;
    assert_true(s->edges < EDGES);
    s->edge[s->edges][0] = i, s->edge[s->edges++][1] = j;
}

static bool all_on_one_side(const body *s, pls_vec3 p, pls_vec3 n)
{
    double low = 0, high = 0;
    for (int k = 0; k < s->vertices; ++k)
    {
        double d = pls_dot(n, pls_sub(s->grain[k], p));
        low = fmin(low, d), high = fmax(high, d);
    }
    return low > -1e-12 || high < 1e-12;
}

/// Faces of the hull by trying all triples of vertices (pairs in 2D). Of faces with more corners, all triples: harmless to the oracles.
static void find_faces(body *s)
{
    s->triangles = s->edges = 0;
    for (int i = 0; i < s->vertices; ++i)
        for (int j = 0; j < i; ++j)
        {
            pls_vec3 d = pls_sub(s->grain[i], s->grain[j]);
            if (s->dimension == 2)
            {
                if (all_on_one_side(s, s->grain[j], pls_vec(d.y, -d.x, 0))) add_edge(s, i, j);
                continue;
            }
            for (int k = 0; k < j; ++k)
            {
                pls_vec3 n = pls_unit(pls_cross(d, pls_sub(s->grain[k], s->grain[j])));
                if (!all_on_one_side(s, s->grain[j], n)) continue;
                assert_true(s->triangles < TRIANGLES);
                int *t = s->triangle[s->triangles++];
                t[0] = i, t[1] = j, t[2] = k;
                add_edge(s, i, j), add_edge(s, j, k), add_edge(s, i, k);
            }
        }
}

static void make_box(body *s, int dimension, pls_vec3 half)
{
    memset(s, 0, sizeof *s);
    s->dimension = dimension, s->vertices = dimension == 3 ? 8 : 4;
    for (int k = 0; k < s->vertices; ++k)
        s->grain[k] = pls_vec(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, dimension == 2 ? 0.0 : k & 4 ? half.z : -half.z);
    s->size = 2.0 * fmax(half.x, fmax(half.y, dimension == 3 ? half.z : 0.0));
    find_faces(s);
}

/// Random points of an ellipsoid about its centre: all corners of their hull.
static void make_hull(body *s, int dimension, int count)
{
    memset(s, 0, sizeof *s);
    s->dimension = dimension, s->vertices = count, s->size = 1.0;
    pls_vec3 half = pls_vec(uniform(0.3, 0.5), uniform(0.3, 0.5), uniform(0.3, 0.5));
    for (int k = 0; k < count; ++k)
    {
        pls_vec3 n = direction(dimension);
        if (dimension == 2) n = pls_vec(cos((k + uniform(0, 0.8)) * 2 * pi / count), sin((k + 0.3) * 2 * pi / count), 0), n = pls_unit(n);
        s->grain[k] = pls_vec(half.x * n.x, half.y * n.y, half.z * n.z);
    }
    find_faces(s);
}

static void make_any(body *s, int dimension)
{
    int kind = (int)uniform(0, 3);
    if (kind == 0)
        make_box(s, dimension, pls_vec(uniform(0.2, 0.5), uniform(0.2, 0.5), uniform(0.2, 0.5)));
    else
        make_hull(s, dimension, kind == 1 ? dimension + 1 : 5 + (int)uniform(0, 8));
}

static double F_of(const body *a, const body *b, pls_vec3 n)
{
    return pls_dot(n, pls_sub(support(a, n), support(b, pls_scale(n, -1.0)))) + a->margin + b->margin;
}

typedef struct oracle
{
    double delta, second; ///< least F, and the least along any normal that is another
    pls_vec3 n;
} oracle;

static void try_axis(const body *a, const body *b, pls_vec3 n, oracle *o)
{
    if (pls_length(n) < 1e-9) return;
    for (int sign = -1; sign <= 1; sign += 2)
    {
        pls_vec3 m = pls_scale(pls_unit(n), sign);
        double F = F_of(a, b, m);
        if (pls_length(pls_sub(m, o->n)) < 1e-6)
            o->delta = fmin(F, o->delta);
        else if (F < o->delta)
            o->second = o->delta, o->delta = F, o->n = m;
        else
            o->second = fmin(o->second, F);
    }
}

static pls_vec3 along(const body *s, int e) { return pls_sub(s->world[s->edge[e][1]], s->world[s->edge[e][0]]); }

/// Depth by separating axes; right where the sets overlap.
static oracle by_axes(const body *a, const body *b)
{
    oracle o = {DBL_MAX, DBL_MAX, {0, 0, 0}};
    const body *both[2] = {a, b};
    for (int k = 0; k < 2; ++k)
    {
        const body *s = both[k];
        for (int t = 0; t < s->triangles; ++t)
        {
            pls_vec3 p = s->world[s->triangle[t][0]];
            try_axis(a, b, pls_cross(pls_sub(s->world[s->triangle[t][1]], p), pls_sub(s->world[s->triangle[t][2]], p)), &o);
        }
        for (int e = 0; s->dimension == 2 && e < s->edges; ++e) try_axis(a, b, pls_cross(along(s, e), pls_vec(0, 0, 1)), &o);
    }
    for (int i = 0; a->dimension == 3 && i < a->edges; ++i)
        for (int j = 0; j < b->edges; ++j) try_axis(a, b, pls_cross(along(a, i), along(b, j)), &o);
    return o;
}

static double clamp(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

static double point_segment(pls_vec3 x, pls_vec3 p, pls_vec3 q)
{
    pls_vec3 d = pls_sub(q, p), r = pls_sub(x, p);
    return pls_length(pls_sub(r, pls_scale(d, clamp(pls_dot(r, d) / pls_dot(d, d)))));
}

static double segment_segment(pls_vec3 p, pls_vec3 q, pls_vec3 r, pls_vec3 s)
{
    double least = fmin(fmin(point_segment(p, r, s), point_segment(q, r, s)), fmin(point_segment(r, p, q), point_segment(s, p, q)));
    pls_vec3 u = pls_sub(q, p), v = pls_sub(s, r), w = pls_sub(r, p), n = pls_cross(u, v);
    double n2 = pls_dot(n, n);
    if (n2 < 1e-18) return least;
    double t = pls_dot(pls_cross(w, v), n) / n2, z = pls_dot(pls_cross(w, u), n) / n2;
    return t >= 0 && t <= 1 && z >= 0 && z <= 1 ? fmin(least, fabs(pls_dot(w, n)) / sqrt(n2)) : least;
}

/// Distance of a point from a triangle's inside, if its foot is there.
static double point_triangle(pls_vec3 x, pls_vec3 p, pls_vec3 q, pls_vec3 r)
{
    pls_vec3 n = pls_unit(pls_cross(pls_sub(q, p), pls_sub(r, p)));
    bool inside = pls_dot(n, pls_cross(pls_sub(q, p), pls_sub(x, p))) >= 0 && pls_dot(n, pls_cross(pls_sub(r, q), pls_sub(x, q))) >= 0 &&
                  pls_dot(n, pls_cross(pls_sub(p, r), pls_sub(x, r))) >= 0;
    return inside ? fabs(pls_dot(n, pls_sub(x, p))) : DBL_MAX;
}

/// Distance of sets that do not overlap: the least of all pairs of features.
static double by_features(const body *a, const body *b)
{
    double least = DBL_MAX;
    const body *both[2] = {a, b};
    for (int i = 0; i < a->edges; ++i)
        for (int j = 0; j < b->edges; ++j)
            least = fmin(
                least, segment_segment(a->world[a->edge[i][0]], a->world[a->edge[i][1]], b->world[b->edge[j][0]], b->world[b->edge[j][1]]));
    for (int k = 0; k < 2; ++k)
        for (int v = 0; v < both[k]->vertices; ++v)
            for (int t = 0; t < both[1 - k]->triangles; ++t)
            {
                const body *s = both[1 - k];
                const int *at = s->triangle[t];
                least = fmin(least, point_triangle(both[k]->world[v], s->world[at[0]], s->world[at[1]], s->world[at[2]]));
            }
    return least;
}

static oracle known(const body *a, const body *b)
{
    oracle o = by_axes(a, b);
    if (o.delta < 0) o.delta = a->margin + b->margin - by_features(a, b);
    return o;
}

/// B on the ray from A along n, `overlap` nearer than where they begin to touch (bisection by what is tested: poses only, no answer rests on it).
static void place_along(body *a, body *b, pls_vec3 n, double overlap)
{
    pose(b, pls_vec(0, 0, 0), b->q);
    double near = 0.0, far = F_of(a, b, n);
    for (int k = 0; k < 24; ++k)
    {
        pose(b, pls_scale(n, 0.5 * (near + far)), b->q);
        pls_convex A = set_of(a), B = set_of(b);
        *(pls_depth_cold(&A, &B).delta > 0 ? &near : &far) = 0.5 * (near + far);
    }
    pose(b, pls_scale(n, near - overlap), b->q);
}

/// The same in a random pose.
static void place(body *a, body *b, double overlap)
{
    pose(a, pls_vec(0, 0, 0), orientation(a->dimension));
    b->q = orientation(a->dimension);
    place_along(a, b, direction(a->dimension), overlap);
}

/// Inside a polytope's core to within `tolerance`: beyond none of its planes.
static double beyond(const body *s, pls_vec3 x)
{
    double most = -DBL_MAX;
    pls_vec3 middle = pls_vec(0, 0, 0);
    for (int k = 0; k < s->vertices; ++k) middle = pls_add(middle, pls_scale(s->world[k], 1.0 / s->vertices));
    for (int t = 0; t < (s->dimension == 3 ? s->triangles : s->edges); ++t)
    {
        pls_vec3 p = s->world[s->dimension == 3 ? s->triangle[t][0] : s->edge[t][0]];
        pls_vec3 n = s->dimension == 3 ? pls_cross(pls_sub(s->world[s->triangle[t][1]], p), pls_sub(s->world[s->triangle[t][2]], p))
                                       : pls_cross(along(s, t), pls_vec(0, 0, 1));
        n = pls_unit(n);
        if (pls_dot(n, pls_sub(p, middle)) < 0) n = pls_scale(n, -1.0);
        most = fmax(most, pls_dot(n, pls_sub(x, p)));
    }
    return most;
}

static double worst_delta, worst_normal, worst_point;

static void points_fit(const body *a, const body *b, const pls_depth *d)
{
    pls_vec3 xi = pls_sub(pls_sub(d->on_a, d->on_b), pls_scale(d->normal, d->delta));
    double off = fmax(fabs(beyond(a, d->on_a)), fabs(beyond(b, d->on_b)));
    worst_point = fmax(worst_point, off);
    assert_true(pls_length(xi) < 1e-13);
    assert_true(fabs(pls_length(d->normal) - 1) < 1e-13);
    assert_true(off < 1e-9);
}

static void random_polytopes(int dimension, int count)
{
    static body a, b;
    worst_delta = worst_normal = worst_point = 0;
    int gaps = 0, iterations = 0, calls = 0;
    for (int k = 0; k < count; ++k)
    {
        make_any(&a, dimension), make_any(&b, dimension);
        place(&a, &b, uniform(-0.05, 0.05));
        oracle o = known(&a, &b);
        pls_convex A = set_of(&a), B = set_of(&b);
        pls_depth d = pls_depth_cold(&A, &B);
        double error = fabs(d.delta - o.delta) / fmax(fabs(o.delta), 1e-6);
        if (!d.converged || error >= 1e-8)
            print_message("pair %d: %.17g, known %.17g, converged %d, %d iterations\n", k, d.delta, o.delta, d.converged, d.iterations);
        assert_true(d.converged && !d.local);
        worst_delta = fmax(worst_delta, error);
        assert_true(error < 1e-8);
        points_fit(&a, &b, &d);
        if (o.delta > 0 && o.second > o.delta + 1e-6) worst_normal = fmax(worst_normal, pls_length(pls_sub(d.normal, o.n)));
        if (o.delta < 0)
            worst_normal = fmax(worst_normal, fabs(F_of(&a, &b, d.normal) - d.delta)); // a plane with all of A before and B behind it
        gaps += o.delta < 0, iterations += d.iterations, calls += d.support_calls;
    }
    print_message("%dD: %d pairs, %d apart: relative error %.1e, normals %.1e, points %.1e; %.1f iterations, %.1f support calls\n",
                  dimension, count, gaps, worst_delta, worst_normal, worst_point, (double)iterations / count, (double)calls / count);
    assert_true(worst_normal < 1e-8);
    assert_true(gaps > count / 4 && gaps < 3 * count / 4);
}

static void polytopes_in_space(void **state) { (void)state, random_state = 1, random_polytopes(3, 10000); }
static void polytopes_in_the_plane(void **state) { (void)state, random_state = 2, random_polytopes(2, 10000); }

/// Least F near n, by ever smaller steps on the sphere, in directions at random so that valleys with sharp floors are followed too.
static double refine(const body *a, const body *b, pls_vec3 n, double step)
{
    double best = F_of(a, b, n);
    int failed = 0;
    while (step > 1e-9)
    {
        pls_vec3 u = fabs(n.x) < 0.7 ? pls_unit(pls_cross(n, pls_vec(1, 0, 0))) : pls_unit(pls_cross(n, pls_vec(0, 1, 0))),
                 v = pls_cross(n, u), m = n;
        if (a->dimension == 2) u = pls_vec(-n.y, n.x, 0), v = u;
        double turn = uniform(0, pi / 4);
        for (int k = 0; k < 8; ++k)
        {
            pls_vec3 t =
                pls_unit(pls_add(n, pls_add(pls_scale(u, step * cos(turn + k * pi / 4)), pls_scale(v, step * sin(turn + k * pi / 4)))));
            double F = F_of(a, b, t);
            if (F < best) best = F, m = t;
        }
        if (pls_length(pls_sub(m, n)) > 0)
            failed = 0;
        else if (++failed == (a->dimension == 3 ? 6 : 1))
            step *= 0.5, failed = 0;
        n = m;
    }
    return best;
}

static double by_directions(const body *a, const body *b)
{
    enum { MANY = 2000, KEPT = 8 };
    double best = DBL_MAX, F[KEPT];
    pls_vec3 n[KEPT];
    for (int k = 0; k < KEPT; ++k) F[k] = DBL_MAX, n[k] = pls_vec(1, 0, 0);
    for (int k = 0; k < MANY; ++k)
    {
        double z = a->dimension == 3 ? 1 - (2 * k + 1.0) / MANY : 0, r = sqrt(1 - z * z);
        double angle = a->dimension == 3 ? k * 2.399963229728653 : 2 * pi * k / MANY;
        pls_vec3 m = pls_vec(r * cos(angle), r * sin(angle), z);
        double value = F_of(a, b, m);
        int worst = 0;
        for (int j = 1; j < KEPT; ++j)
            if (F[j] > F[worst]) worst = j;
        if (value < F[worst]) F[worst] = value, n[worst] = m;
    }
    for (int k = 0; k < KEPT; ++k) best = fmin(best, refine(a, b, n[k], 0.05));
    return best;
}

static void make_ellipsoid(body *s, int dimension, pls_vec3 half)
{
    memset(s, 0, sizeof *s);
    s->dimension = dimension, s->half = half;
    if (dimension == 2) s->half.z = 0;
    s->size = 2 * fmax(half.x, fmax(half.y, s->half.z));
}

static void smooth_sets(int dimension)
{
    static body a, b;
    double worst = 0;
    int failed = 0, iterations = 0;
    for (int k = 0; k < 400; ++k)
    {
        make_ellipsoid(&a, dimension, pls_vec(uniform(0.2, 0.5), uniform(0.2, 0.5), uniform(0.2, 0.5)));
        if (k % 3 == 0)
            make_any(&b, dimension);
        else
            make_ellipsoid(&b, dimension, pls_vec(uniform(0.2, 0.5), uniform(0.2, 0.5), uniform(0.2, 0.5)));
        place(&a, &b, uniform(-0.05, 0.05));
        pls_convex A = set_of(&a), B = set_of(&b);
        pls_depth d = pls_depth_cold(&A, &B);
        double exact = by_directions(&a, &b);
        if (d.delta - exact >= 1e-6) print_message("smooth pair %d: %.12g, known %.12g, converged %d\n", k, d.delta, exact, d.converged);
        assert_true(d.delta - exact < 1e-6);
        assert_true(fabs(F_of(&a, &b, d.normal) - d.delta) < 1e-9);
        assert_true(pls_length(pls_sub(pls_sub(d.on_a, d.on_b), pls_scale(d.normal, d.delta))) < 1e-13);
        worst = fmax(worst, d.delta - exact), failed += !d.converged, iterations += d.iterations;
    }
    print_message("%dD smooth: error %.1e, not converged %d of 400, %.1f iterations\n", dimension, worst, failed, iterations / 400.0);
    assert_int_equal(failed, 0);
}

static void smooth_sets_in_both(void **state) { (void)state, random_state = 3, smooth_sets(3), smooth_sets(2); }

/// Spheres as points with margins and as supports: closed form.
static void spheres(void **state)
{
    (void)state;
    static body a, b;
    for (int k = 0; k < 200; ++k)
    {
        pls_vec3 n = direction(3);
        double distance = uniform(0.6, 1.1);
        make_box(&a, 3, pls_vec(0.1, 0.1, 0.1)), make_box(&b, 3, pls_vec(0.1, 0.1, 0.1));
        a.vertices = b.vertices = 1, a.grain[0] = b.grain[0] = pls_vec(0, 0, 0), a.margin = 0.5, b.margin = 0.4;
        pose(&a, pls_vec(0, 0, 0), orientation(3)), pose(&b, pls_scale(n, distance), orientation(3));
        pls_convex A = set_of(&a), B = set_of(&b);
        pls_depth d = pls_depth_cold(&A, &B);
        assert_true(d.converged && fabs(d.delta - (0.9 - distance)) < 1e-15 && pls_length(pls_sub(d.normal, n)) < 1e-15);
        assert_true(pls_length(pls_sub(d.on_a, pls_scale(n, 0.5))) < 1e-15);
        make_ellipsoid(&a, 3, pls_vec(0.5, 0.5, 0.5)), make_ellipsoid(&b, 3, pls_vec(0.4, 0.4, 0.4));
        pose(&a, pls_vec(0, 0, 0), orientation(3)), pose(&b, pls_scale(n, distance), orientation(3));
        A = set_of(&a), B = set_of(&b);
        d = pls_depth_cold(&A, &B);
        assert_true(d.converged && fabs(d.delta - (0.9 - distance)) < 1e-9 && pls_length(pls_sub(d.normal, n)) < 1e-4);
    }
}

static void special_poses(void **state)
{
    (void)state;
    static body a, b;
    const pls_quat no_turn = pls_quat_identity();
    const double offset[6] = {1.0, 0.999, 1.001, 0.5, 0.0, 1.0 - 1e-12}, depth[6] = {0.0, 1e-3, -1e-3, 0.5, 1.0, 1e-12};
    for (int dimension = 2; dimension <= 3; ++dimension)
        for (int k = 0; k < 6; ++k) // cubes face to face, from touching to one in the other
        {
            make_box(&a, dimension, pls_vec(0.5, 0.5, 0.5)), make_box(&b, dimension, pls_vec(0.5, 0.5, 0.5));
            pose(&a, pls_vec(0, 0, 0), no_turn), pose(&b, pls_vec(offset[k], 0, 0), no_turn);
            pls_convex A = set_of(&a), B = set_of(&b);
            pls_depth d = pls_depth_cold(&A, &B);
            assert_true(d.converged && fabs(d.delta - depth[k]) < 1e-12);
            points_fit(&a, &b, &d);
            if (k != 4) assert_true(d.normal.x > 1 - 1e-12);
        }
    // edge on edge, corner on corner, both exactly touching
    make_box(&a, 3, pls_vec(0.5, 0.5, 0.5)), make_box(&b, 3, pls_vec(0.5, 0.5, 0.5));
    pose(&a, pls_vec(0, 0, 0), no_turn), pose(&b, pls_vec(1, 1, 0), no_turn);
    pls_convex A = set_of(&a), B = set_of(&b);
    pls_depth d = pls_depth_cold(&A, &B);
    assert_true(d.converged && fabs(d.delta) < 1e-12), points_fit(&a, &b, &d);
    pose(&b, pls_vec(1, 1, 1), no_turn), B = set_of(&b);
    d = pls_depth_cold(&A, &B);
    assert_true(d.converged && fabs(d.delta) < 1e-12), points_fit(&a, &b, &d);
    // ellipsoids with one centre
    make_ellipsoid(&a, 3, pls_vec(0.5, 0.4, 0.3)), make_ellipsoid(&b, 3, pls_vec(0.2, 0.3, 0.25));
    pose(&a, pls_vec(0, 0, 0), no_turn), pose(&b, pls_vec(0, 0, 0), no_turn);
    A = set_of(&a), B = set_of(&b), d = pls_depth_cold(&A, &B);
    assert_true(d.converged && fabs(d.delta - 0.55) < 1e-6);
    // not finite: an end, and no claim
    b.centre.x = NAN, B = set_of(&b), d = pls_depth_cold(&A, &B);
    assert_false(d.converged);
}

/// Needles and plates; segments and rectangles with margins.
static void thin_sets(void **state)
{
    (void)state;
    random_state = 7;
    static body a, b;
    double worst = 0;
    for (int k = 0; k < 3000; ++k)
    {
        bool needle = k % 2, flat = k % 3 == 0;
        pls_vec3 thin = needle ? pls_vec(0.5, 1e-3, 1e-3) : pls_vec(0.5, 0.4, 1e-3);
        make_box(&a, 3, thin);
        if (k % 5 == 0)
            make_any(&b, 3);
        else
            make_box(&b, 3, thin);
        place(&a, &b, uniform(-0.05, flat ? 0.5 : 0.05));
        oracle o = known(&a, &b);
        pls_convex A = set_of(&a), B = set_of(&b);
        pls_depth d = pls_depth_cold(&A, &B);
        double error = fabs(d.delta - o.delta);
        if (!d.converged || error > 1e-10)
            print_message("thin pair %d: %.17g, known %.17g, converged %d\n", k, d.delta, o.delta, d.converged);
        assert_true(d.converged && error < 1e-10);
        worst = fmax(worst, error);
    }
    print_message("thin: error %.1e\n", worst);
    for (int k = 0; k < 200; ++k) // crossed capsules: cores that overlap without volume
    {
        make_box(&a, 3, pls_vec(0.5, 0, 0)), make_box(&b, 3, pls_vec(0, 0.5, 0));
        a.vertices = b.vertices = 2, b.grain[0] = pls_vec(0, -0.5, 0), b.grain[1] = pls_vec(0, 0.5, 0);
        a.margin = b.margin = 0.1;
        double height = k % 2 ? 0.0 : uniform(1e-6, 0.3);
        pose(&a, pls_vec(0, 0, 0), pls_quat_identity()),
            pose(&b, pls_vec(uniform(-0.4, 0.4), uniform(-0.4, 0.4), height), pls_quat_identity());
        pls_convex A = set_of(&a), B = set_of(&b);
        pls_depth d = pls_depth_cold(&A, &B);
        assert_true(d.converged && fabs(d.delta - (0.2 - height)) < 1e-12 && fabs(d.normal.z) > 1 - 1e-9);
    }
}

static void deep_overlap(void **state)
{
    (void)state;
    random_state = 8;
    static body a, b;
    for (int k = 0; k < 2000; ++k)
    {
        int dimension = 2 + k % 2;
        make_any(&a, dimension), make_any(&b, dimension);
        place(&a, &b, uniform(0.05, 0.8));
        oracle o = known(&a, &b);
        pls_convex A = set_of(&a), B = set_of(&b);
        pls_depth d = pls_depth_cold(&A, &B);
        assert_true(d.converged && fabs(d.delta - o.delta) < 1e-11);
        points_fit(&a, &b, &d);
    }
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct tally
{
    int steps, local_minima, gaps, iterations, calls;
    double worst, cold, warm;
} tally;

/// One step: warm must be cold, or say that it may be a local minimum and be one: F of its normal and no less than the least.
static void compare(const body *a, const body *b, pls_depth_state *state, tally *t)
{
    pls_convex A = set_of(a), B = set_of(b);
    double t0 = seconds();
    pls_depth cold = pls_depth_cold(&A, &B);
    double t1 = seconds();
    pls_depth warm = pls_depth_warm(&A, &B, state);
    t->cold += t1 - t0, t->warm += seconds() - t1;
    assert_true(cold.converged && warm.converged);
    double error = fabs(warm.delta - cold.delta);
    if (error > 1e-8 && warm.local && warm.delta > cold.delta)
    {
        ++t->local_minima;
        assert_true(fabs(F_of(a, b, warm.normal) - warm.delta) < 1e-8);
    }
    else
    {
        if (error > 1e-8) print_message("step %d: warm %.15g local %d, cold %.15g\n", t->steps, warm.delta, warm.local, cold.delta);
        t->worst = fmax(t->worst, error);
        assert_true(error < 1e-8);
    }
    ++t->steps, t->gaps += cold.delta < 0, t->iterations += warm.iterations, t->calls += warm.support_calls;
}

/// B tumbles to and fro across the touching distance while both turn by a little each step.
static void tumble(body *a, body *b, double depth, tally *t)
{
    enum { STEPS = 400 };
    int dimension = a->dimension;
    pls_depth_state state = {.known = 0.0};
    pls_vec3 n = direction(dimension), turn_a = dimension == 3 ? direction(3) : pls_vec(0, 0, 1),
             turn_b = dimension == 3 ? direction(3) : pls_vec(0, 0, 1);
    pls_quat qa = orientation(dimension), qb = orientation(dimension);
    double half = 1e-3;
    for (int k = 0; k < STEPS; ++k)
    {
        pls_quat da = {cos(half), turn_a.x * sin(half), turn_a.y * sin(half), turn_a.z * sin(half)};
        pls_quat db = {cos(half), turn_b.x * sin(half), turn_b.y * sin(half), turn_b.z * sin(half)};
        qa = pls_quat_unit(pls_quat_multiply(da, qa)), qb = pls_quat_unit(pls_quat_multiply(db, qb));
        pose(a, pls_vec(0, 0, 0), qa), pose(b, pls_vec(0, 0, 0), qb);
        place_along(a, b, n, -depth * cos(4 * pi * k / STEPS)); // starts in a gap
        compare(a, b, &state, t);
    }
}

static void report(const char *what, const tally *t)
{
    print_message(
        "%s: %d steps, %d apart, %d local minima, error %.1e; warm %.2f iterations, %.2f support calls; cold %.0f ns, warm %.0f ns\n", what,
        t->steps, t->gaps, t->local_minima, t->worst, (double)t->iterations / t->steps, (double)t->calls / t->steps,
        1e9 * t->cold / t->steps, 1e9 * t->warm / t->steps);
}

static void trajectories(void **state)
{
    (void)state;
    static body a, b;
    for (int dimension = 2; dimension <= 3; ++dimension)
        for (int deep = 0; deep < 2; ++deep)
        {
            tally t = {.steps = 0};
            random_state = 11;
            for (int k = 0; k < 50; ++k)
            {
                make_any(&a, dimension), make_any(&b, dimension);
                tumble(&a, &b, deep ? 0.05 : 0.01, &t);
            }
            char what[64];
            snprintf(what, sizeof what, "%dD polytopes, overlaps to %d %%", dimension, deep ? 5 : 1);
            report(what, &t);
            assert_true(t.local_minima <= t.steps / 50);
        }
}

static void smooth_trajectories(void **state)
{
    (void)state;
    static body a, b;
    for (int dimension = 2; dimension <= 3; ++dimension)
    {
        tally t = {.steps = 0};
        random_state = 12;
        for (int k = 0; k < 20; ++k)
        {
            make_ellipsoid(&a, dimension, pls_vec(uniform(0.3, 0.5), uniform(0.3, 0.5), uniform(0.3, 0.5)));
            make_ellipsoid(&b, dimension, pls_vec(uniform(0.3, 0.5), uniform(0.3, 0.5), uniform(0.3, 0.5)));
            tumble(&a, &b, 0.01, &t);
        }
        report(dimension == 2 ? "2D ellipses" : "3D ellipsoids", &t);
        assert_int_equal(t.local_minima, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polytopes_in_space),  cmocka_unit_test(polytopes_in_the_plane),
        cmocka_unit_test(smooth_sets_in_both), cmocka_unit_test(spheres),
        cmocka_unit_test(special_poses),       cmocka_unit_test(thin_sets),
        cmocka_unit_test(deep_overlap),        cmocka_unit_test(trajectories),
        cmocka_unit_test(smooth_trajectories),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
