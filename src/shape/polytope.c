// polytope.c -- convex hulls with faces, normals and neighbours.
//
// 3D: the quickhull algorithm (Barber, Dobkin, Huhdanpaa, ACM Trans. Math. Softw. 22, 1996) by the reentrant qhull. Points are first brought to the unit cube, as
// its tolerances go by the largest coordinate. Qhull merges coplanar triangles; what it calls a facet is a set of vertices here, put in order by their angle about
// the middle of the face, which a convex face allows. A vertex of fewer than three faces lies on an edge or in a face and is dropped. In the end the surface is
// checked: every edge has two faces, in opposite directions, and Euler's formula holds.
// 2D: the monotone chain (Andrew, Inf. Proc. Lett. 9, 1979).
// Support points: linear functions on a convex polytope have no local maxima, so walking uphill along edges ends at the best vertex. The walk begins at the best
// vertex for one of 26 directions near n; small polytopes are faster searched through.

#include "shape/polytope.h"

#include "base/alloc.h"

#include <libqhull_r/qhull_ra.h>
#include <stdlib.h>
#include <string.h>

enum { SEARCH_ALL = 30 };            ///< vertices up to which all are tried
static const double flatness = 1e-9; ///< of the size: thinner sets of points have no volume
static const double merge = 1e-10;   ///< of the size: how far a face may deviate from a plane

// ---- the points -----------------------------------------------------------------------------------------------------------------------------------------------

static pls_status check_points(const pls_vec3 *points, size_t count, int dimension)
{
    const size_t least = (size_t)dimension + 1;
    const char *what = dimension == 3 ? "polyhedron" : "polygon";
    if (!points || count < least) return pls_fail(PLS_INVALID_ARGUMENT, "a %s needs at least %zu points, not %zu", what, least, count);
    if (count > INT32_MAX / 8) return pls_fail(PLS_LIMIT_EXCEEDED, "a %s of %zu points; at most %d", what, count, INT32_MAX / 8);
    for (size_t k = 0; k < count; ++k)
    {
        if (!isfinite(points[k].x) || !isfinite(points[k].y) || !isfinite(points[k].z))
            return pls_fail(PLS_INVALID_ARGUMENT, "point %zu of a %s is (%g, %g, %g) m; coordinates must be finite numbers", k + 1, what,
                            points[k].x, points[k].y, points[k].z);
        if (dimension == 2 && points[k].z != 0.0)
            return pls_fail(PLS_INVALID_ARGUMENT, "point %zu of a polygon has z = %g m; in 2D it must be 0", k + 1, points[k].z);
    }
    return PLS_OK;
}

/// The furthest point from `o`, from the line o + t e (e not zero), or from the plane through o (n not zero); how far it is.
static double furthest(const pls_vec3 *points, size_t count, pls_vec3 o, pls_vec3 e, pls_vec3 n, pls_vec3 *best)
{
    double most = 0.0;
    for (size_t k = 0; k < count; ++k)
    {
        pls_vec3 d = pls_sub(points[k], o);
        double far = 0.0;
        if (pls_dot(n, n) > 0.0)
            far = fabs(pls_dot(d, n));
        else
            far = pls_length(pls_sub(d, pls_scale(e, pls_dot(d, e))));
        if (far > most) most = far, *best = points[k];
    }
    return most;
}

/// Do the points span a volume (2D: an area)? `size` is about their largest distance.
static pls_status check_span(const pls_vec3 *points, size_t count, int dimension, double *size)
{
    const pls_vec3 none = {0.0, 0.0, 0.0};
    pls_vec3 a = points[0], b = a, c = a, d = a;
    *size = furthest(points, count, a, none, none, &b);
    if (!(*size > 0.0)) return pls_fail(PLS_INVALID_ARGUMENT, "all %zu points are the same; give points that span a shape", count);
    pls_vec3 e = pls_unit(pls_sub(b, a));
    double wide = furthest(points, count, a, e, none, &c);
    if (!(wide > flatness * *size))
        return pls_fail(PLS_INVALID_ARGUMENT, "the %zu points lie on a line; give points that span %s", count,
                        dimension == 3 ? "a volume" : "an area");
    if (dimension == 2) return PLS_OK;
    double thick = furthest(points, count, a, e, pls_unit(pls_cross(e, pls_sub(c, a))), &d);
    if (!(thick > flatness * *size))
        return pls_fail(PLS_INVALID_ARGUMENT, "the %zu points lie in a plane; give points that span a volume", count);
    return PLS_OK;
}

// ---- faces as sets of points ----------------------------------------------------------------------------------------------------------------------------------

/// Faces of the hull as qhull tells them: indices of points.
typedef struct face_sets
{
    uint32_t *start, *member;
    size_t count, start_capacity, members, member_capacity;
} face_sets;

static pls_status add_facet(qhT *qh, const facetT *facet, face_sets *sets)
{
    vertexT *vertex, **vertexp;
    PLS_TRY(pls_reserve(&sets->start, &sets->start_capacity, sets->count + 2, sizeof *sets->start, "faces of a polyhedron"));
    FOREACHvertex_(facet->vertices)
    {
        PLS_TRY(pls_reserve(&sets->member, &sets->member_capacity, sets->members + 1, sizeof *sets->member, "faces of a polyhedron"));
        sets->member[sets->members++] = (uint32_t)((vertex->point - qh->first_point) / 3);
    }
    sets->start[++sets->count] = (uint32_t)sets->members;
    return PLS_OK;
}

/// `text` is what qhull has to say.
static pls_status run_qhull(double *coordinates, size_t count, FILE *text, char **said, face_sets *sets)
{
    qhT memory, *qh = &memory;
    char command[64];
    int long_left = 0, pieces_left = 0;
    qh_zero(qh, text);
    snprintf(command, sizeof command, "qhull Pp C-%g", merge);
    int code = qh_new_qhull(qh, 3, (int)count, coordinates, False, command, NULL, text);
    pls_status status = PLS_OK;
    if (code == qh_ERRmem)
        status = pls_fail(PLS_OUT_OF_MEMORY, "no memory for the convex hull of %zu points", count);
    else if (code != qh_ERRnone)
    {
        fflush(text);
        status = pls_fail(PLS_INVALID_ARGUMENT, "no convex hull of the %zu points can be made: %.300s", count, *said ? *said : "");
    }
    facetT *facet;
    if (status == PLS_OK)
    {
        FORALLfacets
        {
            status = add_facet(qh, facet, sets);
            if (status != PLS_OK) break;
        }
    }
    qh_freeqhull(qh, !qh_ALL);
    qh_memfreeshort(qh, &long_left, &pieces_left);
    return status;
}

static pls_status find_faces(const pls_vec3 *points, size_t count, double size, face_sets *sets)
{
    double *coordinates = NULL;
    PLS_TRY(pls_allocate(&coordinates, 3 * count, sizeof *coordinates, "points of a polyhedron"));
    for (size_t k = 0; k < count; ++k)
    {
        pls_vec3 x = pls_scale(pls_sub(points[k], points[0]), 1.0 / size);
        coordinates[3 * k] = x.x, coordinates[3 * k + 1] = x.y, coordinates[3 * k + 2] = x.z;
    }
    char *said = NULL;
    size_t length = 0;
    FILE *text = open_memstream(&said, &length);
    pls_status status = text ? run_qhull(coordinates, count, text, &said, sets)
                             : pls_fail(PLS_OUT_OF_MEMORY, "no memory for the convex hull of %zu points", count);
    if (text) fclose(text);
    free(said);
    pls_release(&coordinates);
    return status;
}

/// Leave out members that fewer than three faces share: they are within an edge or a face. `uses` has a place per point.
static void drop_loose(face_sets *sets, uint32_t *uses)
{
    for (bool again = true; again;)
    {
        again = false;
        for (size_t m = 0; m < sets->members; ++m) uses[sets->member[m]] = 0;
        for (size_t m = 0; m < sets->members; ++m) ++uses[sets->member[m]];
        uint32_t kept = 0, begin = 0;
        size_t faces = 0;
        for (size_t f = 0; f < sets->count; ++f)
        {
            uint32_t end = sets->start[f + 1], first = kept;
            for (uint32_t m = begin; m < end; ++m)
            {
                if (uses[sets->member[m]] >= 3) sets->member[kept++] = sets->member[m];
            }
            again |= kept - first != end - begin;
            begin = end;
            if (kept - first < 3)
                kept = first; // nothing is left of the face
            else
                sets->start[++faces] = kept;
        }
        sets->count = faces;
        sets->members = kept;
    }
}

// ---- the polytope ------------------------------------------------------------------------------------------------------------------------------------------------

typedef struct parts // the same arrays as in the polytope, to be written
{
    pls_vec3 *vertex, *normal;
    uint32_t *face_start, *face_vertex, *neighbour_start, *neighbour;
    uint32_t vertices, faces, members;
} parts;

static pls_status allocate_parts(pls_hull *hull, parts *p)
{
    pls_polytope *b = &hull->body;
    const char *what = "a polytope";
    PLS_TRY(pls_allocate(&p->vertex, p->vertices, sizeof *p->vertex, what));
    b->vertex = p->vertex;
    PLS_TRY(pls_allocate(&p->normal, p->faces, sizeof *p->normal, what));
    b->face_normal = p->normal;
    PLS_TRY(pls_allocate(&p->face_start, p->faces + 1, sizeof *p->face_start, what));
    b->face_start = p->face_start;
    PLS_TRY(pls_allocate(&p->face_vertex, p->members, sizeof *p->face_vertex, what));
    b->face_vertex = p->face_vertex;
    PLS_TRY(pls_allocate(&p->neighbour_start, p->vertices + 1, sizeof *p->neighbour_start, what));
    b->neighbour_start = p->neighbour_start;
    PLS_TRY(pls_allocate(&p->neighbour, p->members, sizeof *p->neighbour, what));
    b->neighbour = p->neighbour;
    b->vertex_count = p->vertices;
    b->face_count = p->faces;
    return pls_allocate(&hull->offset, p->faces, sizeof *hull->offset, what);
}

/// Vertices of a face in the order of the right hand about `normal`, by angle about their middle.
static void sort_face(const pls_vec3 *vertex, uint32_t *member, uint32_t count, pls_vec3 normal, double *angle)
{
    pls_vec3 middle = pls_vec(0.0, 0.0, 0.0);
    for (uint32_t k = 0; k < count; ++k) middle = pls_add(middle, pls_scale(vertex[member[k]], 1.0 / count));
    pls_vec3 u = pls_unit(pls_sub(vertex[member[0]], middle)), v = pls_cross(normal, u);
    for (uint32_t k = 0; k < count; ++k)
    {
        pls_vec3 d = pls_sub(vertex[member[k]], middle);
        double at = atan2(pls_dot(d, v), pls_dot(d, u));
        uint32_t moved = member[k], place = k;
        for (; place > 0 && angle[place - 1] > at; --place) angle[place] = angle[place - 1], member[place] = member[place - 1];
        angle[place] = at;
        member[place] = moved;
    }
}

/// Normal of a closed line of points: its vector area (Newell's method), exact for plane faces and their mean for others.
static pls_vec3 vector_area(const pls_vec3 *vertex, const uint32_t *member, uint32_t count)
{
    pls_vec3 area = pls_vec(0.0, 0.0, 0.0), o = vertex[member[0]];
    for (uint32_t k = 1; k + 1 < count; ++k)
        area = pls_add(area, pls_cross(pls_sub(vertex[member[k]], o), pls_sub(vertex[member[k + 1]], o)));
    return area;
}

/// A first normal of a face of unordered vertices: the largest triangle with its first vertex and the one furthest from it; away from `inside`.
static pls_vec3 rough_normal(const pls_vec3 *vertex, const uint32_t *member, uint32_t count, pls_vec3 inside)
{
    pls_vec3 o = vertex[member[0]], e = pls_vec(0.0, 0.0, 0.0), n = e;
    for (uint32_t k = 1; k < count; ++k)
    {
        pls_vec3 d = pls_sub(vertex[member[k]], o);
        if (pls_dot(d, d) > pls_dot(e, e)) e = d;
    }
    for (uint32_t k = 1; k < count; ++k)
    {
        pls_vec3 c = pls_cross(e, pls_sub(vertex[member[k]], o));
        if (pls_dot(c, c) > pls_dot(n, n)) n = c;
    }
    n = pls_unit(n);
    return pls_dot(n, pls_sub(o, inside)) < 0.0 ? pls_scale(n, -1.0) : n;
}

static pls_status order_faces(parts *p)
{
    pls_vec3 inside = pls_vec(0.0, 0.0, 0.0);
    double *angle = NULL;
    for (uint32_t k = 0; k < p->vertices; ++k) inside = pls_add(inside, pls_scale(p->vertex[k], 1.0 / p->vertices));
    PLS_TRY(pls_allocate(&angle, p->vertices, sizeof *angle, "a polytope"));
    for (uint32_t f = 0; f < p->faces; ++f)
    {
        uint32_t *member = p->face_vertex + p->face_start[f], count = p->face_start[f + 1] - p->face_start[f];
        sort_face(p->vertex, member, count, rough_normal(p->vertex, member, count, inside), angle);
        p->normal[f] = pls_unit(vector_area(p->vertex, member, count));
    }
    pls_release(&angle);
    return PLS_OK;
}

/// On a closed surface each vertex begins as many directed edges as it has neighbours: the faces' edges are the lists of neighbours.
static void find_neighbours(parts *p)
{
    for (uint32_t m = 0; m < p->members; ++m) ++p->neighbour_start[p->face_vertex[m] + 1];
    for (uint32_t v = 0; v < p->vertices; ++v) p->neighbour_start[v + 1] += p->neighbour_start[v];
    for (uint32_t f = 0; f < p->faces; ++f)
    {
        uint32_t begin = p->face_start[f], count = p->face_start[f + 1] - begin;
        for (uint32_t k = 0; k < count; ++k)
        {
            // Until all are in, the first place of a list counts those that are: neighbour_start[v] is moved on and set back below.
            uint32_t from = p->face_vertex[begin + k];
            p->neighbour[p->neighbour_start[from]++] = p->face_vertex[begin + (k + 1) % count];
        }
    }
    for (uint32_t v = p->vertices; v > 0; --v) p->neighbour_start[v] = p->neighbour_start[v - 1];
    p->neighbour_start[0] = 0;
}

static uint32_t times_listed(const parts *p, uint32_t of, uint32_t wanted)
{
    uint32_t times = 0;
    for (uint32_t k = p->neighbour_start[of]; k < p->neighbour_start[of + 1]; ++k) times += p->neighbour[k] == wanted;
    return times;
}

/// Each edge once in each direction, and V - E + F = 2.
static bool is_closed(const parts *p)
{
    for (uint32_t v = 0; v < p->vertices; ++v)
    {
        for (uint32_t k = p->neighbour_start[v]; k < p->neighbour_start[v + 1]; ++k)
        {
            uint32_t other = p->neighbour[k];
            if (times_listed(p, v, other) != 1 || times_listed(p, other, v) != 1) return false;
        }
    }
    return p->members % 2 == 0 && p->vertices + p->faces == p->members / 2 + 2;
}

/// Number the points that are vertices and copy them; `number` has a place per point.
static void take_vertices(const face_sets *sets, const pls_vec3 *points, size_t count, uint32_t *number, parts *p)
{
    uint32_t next = 0;
    for (size_t k = 0; k < count; ++k)
    {
        if (number[k] == 0) continue;
        p->vertex[next] = points[k];
        number[k] = next++;
    }
    for (size_t m = 0; m < sets->members; ++m) p->face_vertex[m] = number[sets->member[m]];
    memcpy(p->face_start, sets->start, (sets->count + 1) * sizeof *sets->start);
}

static pls_status build_3d(pls_hull *hull, const pls_vec3 *points, size_t count, face_sets *sets, uint32_t *number)
{
    parts p = {0};
    drop_loose(sets, number);
    memset(number, 0, count * sizeof *number);
    for (size_t m = 0; m < sets->members; ++m)
    {
        p.vertices += number[sets->member[m]] == 0;
        number[sets->member[m]] = 1;
    }
    p.faces = (uint32_t)sets->count;
    p.members = (uint32_t)sets->members;
    if (p.faces < 4) return pls_fail(PLS_INVALID_ARGUMENT, "the hull of %zu points is flat; give points that span a volume", count);
    PLS_TRY(allocate_parts(hull, &p));
    take_vertices(sets, points, count, number, &p);
    PLS_TRY(order_faces(&p));
    find_neighbours(&p);
    if (is_closed(&p)) return PLS_OK;
    return pls_fail(
        PLS_INVALID_ARGUMENT,
        "the hull of %zu points is not a closed surface at the precision of numbers: some points are too close to each other or to a "
        "common plane. Give fewer points, or a shape less thin",
        count);
}

static pls_status make_3d(pls_hull *hull, const pls_vec3 *points, size_t count, double size)
{
    face_sets sets = {0};
    uint32_t *number = NULL;
    pls_status status = find_faces(points, count, size, &sets);
    if (status == PLS_OK) status = pls_allocate(&number, count, sizeof *number, "points of a polyhedron");
    if (status == PLS_OK) status = build_3d(hull, points, count, &sets, number);
    pls_release(&number);
    pls_release(&sets.start);
    pls_release(&sets.member);
    return status;
}

// ---- 2D -----------------------------------------------------------------------------------------------------------------------------------------------------

static int by_place(const void *first, const void *second)
{
    const pls_vec3 *a = first, *b = second;
    if (a->x != b->x) return a->x < b->x ? -1 : 1;
    return (a->y > b->y) - (a->y < b->y);
}

/// Is b left of the way a -> c, or less than `close` right of it?
static bool is_idle(pls_vec3 a, pls_vec3 b, pls_vec3 c, double close)
{
    pls_vec3 ab = pls_sub(b, a), ac = pls_sub(c, a);
    return ab.x * ac.y - ab.y * ac.x <= close * pls_length(ac);
}

/// Corners of the hull of sorted points, counterclockwise; `chain` has room for count + 1.
static size_t monotone_chain(const pls_vec3 *sorted, size_t count, double close, pls_vec3 *chain)
{
    size_t length = 0;
    for (size_t k = 0; k < count; ++k) // the lower side
    {
        while (length >= 2 && is_idle(chain[length - 2], chain[length - 1], sorted[k], close)) --length;
        chain[length++] = sorted[k];
    }
    const size_t least = length + 1;
    for (size_t k = count - 1; k-- > 0;) // the upper side
    {
        while (length >= least && is_idle(chain[length - 2], chain[length - 1], sorted[k], close)) --length;
        chain[length++] = sorted[k];
    }
    return length - 1;
}

static pls_status build_2d(pls_hull *hull, const pls_vec3 *chain, size_t corners)
{
    parts p = {.vertices = (uint32_t)corners, .faces = (uint32_t)corners, .members = (uint32_t)(2 * corners)};
    PLS_TRY(allocate_parts(hull, &p));
    for (uint32_t k = 0; k < p.vertices; ++k)
    {
        uint32_t next = (k + 1) % p.vertices, last = (k + p.vertices - 1) % p.vertices;
        pls_vec3 along = pls_sub(chain[next], chain[k]);
        p.vertex[k] = chain[k];
        p.normal[k] = pls_unit(pls_vec(along.y, -along.x, 0.0));
        p.face_start[k + 1] = p.neighbour_start[k + 1] = 2 * k + 2;
        p.face_vertex[2 * k] = k, p.face_vertex[2 * k + 1] = next;
        p.neighbour[2 * k] = last, p.neighbour[2 * k + 1] = next;
    }
    return PLS_OK;
}

static pls_status make_2d(pls_hull *hull, const pls_vec3 *points, size_t count, double size)
{
    pls_vec3 *sorted = NULL, *chain = NULL;
    PLS_TRY(pls_allocate(&sorted, count, sizeof *sorted, "points of a polygon"));
    pls_status status = pls_allocate(&chain, 2 * count + 1, sizeof *chain, "points of a polygon");
    if (status == PLS_OK)
    {
        memcpy(sorted, points, count * sizeof *points);
        qsort(sorted, count, sizeof *sorted, by_place);
        status = build_2d(hull, chain, monotone_chain(sorted, count, merge * 1e-2 * size, chain));
    }
    pls_release(&chain);
    pls_release(&sorted);
    return status;
}

// ---- questions --------------------------------------------------------------------------------------------------------------------------------------------------

static uint32_t best_vertex(const pls_polytope *p, pls_vec3 n)
{
    uint32_t best = 0;
    double most = -INFINITY;
    for (uint32_t v = 0; v < p->vertex_count; ++v)
    {
        double along = pls_dot(p->vertex[v], n);
        if (along > most) most = along, best = v;
    }
    return best;
}

/// -1, 0 or 1: what of a unit vector's component is left on a grid of 26 directions.
static int rounded(double component) { return (component > 0.38) - (component < -0.38); }

pls_vec3 pls_hull_support(const pls_hull *hull, pls_vec3 n)
{
    const pls_polytope *p = &hull->body;
    if (p->vertex_count <= SEARCH_ALL) return p->vertex[best_vertex(p, n)];
    uint32_t at = hull->start[(rounded(n.x) + 1) + 3 * (rounded(n.y) + 1) + 9 * (rounded(n.z) + 1)];
    double most = pls_dot(p->vertex[at], n);
    for (bool higher = true; higher;)
    {
        const uint32_t from = at;
        higher = false;
        for (uint32_t k = p->neighbour_start[from]; k < p->neighbour_start[from + 1]; ++k)
        {
            double along = pls_dot(p->vertex[p->neighbour[k]], n);
            if (along > most) most = along, at = p->neighbour[k], higher = true;
        }
    }
    return p->vertex[at];
}

double pls_hull_radius(const pls_hull *hull, pls_vec3 centre)
{
    double most = 0.0;
    for (uint32_t v = 0; v < hull->body.vertex_count; ++v) most = fmax(most, pls_length(pls_sub(hull->body.vertex[v], centre)));
    return most;
}

// ---- making one -------------------------------------------------------------------------------------------------------------------------------------------------

static void find_extents(pls_hull *hull)
{
    const pls_polytope *p = &hull->body;
    for (uint32_t f = 0; f < p->face_count; ++f)
    {
        hull->offset[f] = -INFINITY;
        for (uint32_t k = p->face_start[f]; k < p->face_start[f + 1]; ++k)
            hull->offset[f] = fmax(hull->offset[f], pls_dot(p->face_normal[f], p->vertex[p->face_vertex[k]]));
    }
    for (int k = 0; k < PLS_HULL_STARTS; ++k) hull->start[k] = best_vertex(p, pls_vec(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
    hull->lower = hull->upper = p->vertex[0];
    for (uint32_t v = 1; v < p->vertex_count; ++v)
    {
        pls_vec3 x = p->vertex[v];
        hull->lower = pls_vec(fmin(hull->lower.x, x.x), fmin(hull->lower.y, x.y), fmin(hull->lower.z, x.z));
        hull->upper = pls_vec(fmax(hull->upper.x, x.x), fmax(hull->upper.y, x.y), fmax(hull->upper.z, x.z));
    }
}

pls_status pls_hull_make(const pls_vec3 *points, size_t count, int dimension, pls_hull **out)
{
    double size = 0.0;
    *out = NULL;
    PLS_TRY(check_points(points, count, dimension));
    PLS_TRY(check_span(points, count, dimension, &size));
    pls_hull *hull = NULL;
    PLS_TRY(pls_allocate(&hull, 1, sizeof *hull, "a polytope"));
    pls_status status = dimension == 2 ? make_2d(hull, points, count, size) : make_3d(hull, points, count, size);
    if (status != PLS_OK)
    {
        pls_hull_free(hull);
        return status;
    }
    find_extents(hull);
    *out = hull;
    return PLS_OK;
}

static void release_array(const void *array)
{
    void *block;
    memcpy(&block, &array, sizeof block);
    pls_release(&block);
}

void pls_hull_free(pls_hull *hull)
{
    if (!hull) return;
    release_array(hull->body.vertex);
    release_array(hull->body.face_start);
    release_array(hull->body.face_vertex);
    release_array(hull->body.face_normal);
    release_array(hull->body.neighbour_start);
    release_array(hull->body.neighbour);
    pls_release(&hull->offset);
    pls_release(&hull);
}
