// cases_walls.c -- grains that hit walls of triangles where these have edges: ridges, corners, free rims, valleys. Undamped and without friction they keep their energy.
#include "verify/cases.h"

#include "base/random.h"
#include "support/grains.h"
#include "support/numbers.h"
#include "support/values_alone.h"

#include <stdlib.h>

static const double stiffness = 400.0;

typedef struct target
{
    const char *name, *mesh;
    pls_vec3 from, to; ///< where it is hit: between these two
    pls_vec3 outwards; ///< from where grains come
} target;

/// The table is a block with its top in z = 0, the sheet lies in z = 0, the trough has slopes of 30 degrees, the dell of 8, and their bottoms along the y axis.
static const target targets[] = {
    {"an edge of a block", PLS_TEST_DATA "/table.obj", {1, -0.6, 0}, {1, 0.6, 0}, {0.7, 0, 0.7}},
    {"a corner of a block", PLS_TEST_DATA "/table.obj", {1, 1, 0}, {1, 1, 0}, {0.6, 0.6, 0.6}},
    {"the top of a block near its edge", PLS_TEST_DATA "/table.obj", {0.8, -0.6, 0}, {0.9, 0.6, 0}, {0, 0, 1}},
    {"the rim of a sheet, from the side", PLS_TEST_DATA "/sheet.obj", {1, -0.6, 0}, {1, 0.6, 0}, {1, 0, 0.02}},
    {"the rim of a sheet, from above", PLS_TEST_DATA "/sheet.obj", {0.9, -0.6, 0}, {1.1, 0.6, 0}, {0.2, 0, 1}},
    {"the seams of a sheet", PLS_TEST_DATA "/sheet.obj", {-0.5, -0.5, 0}, {0.5, 0.5, 0}, {0.3, 0.2, 1}},
    {"the bottom of a trough", PLS_TEST_DATA "/trough.obj", {0, -0.5, 0}, {0, 0.5, 0}, {0, 0.3, 1}},
    {"the bottom of a dell", PLS_TEST_DATA "/dell.obj", {0, -0.5, 0}, {0, 0.5, 0}, {0, 0.3, 1}},
    {"an edge of a plate", PLS_TEST_DATA "/plate.obj", {1, -0.6, 0}, {1, 0.6, 0}, {0.5, 0, 1}},
    {"an edge of an octahedron", PLS_TEST_DATA "/octahedron.obj", {0.2, 0, -0.2}, {0.8, 0, -0.8}, {1, 0.3, 1}},
    {"the corner of a floor and a fin on it", PLS_TEST_DATA "/fin.obj", {0.1, -0.6, 0.1}, {0.2, 0.6, 0.1}, {1, 0, 1}},
};

static pls_vec3 random_vector(pls_random *random)
{
    const double x = pls_random_normal(random), y = pls_random_normal(random), z = pls_random_normal(random);
    return pls_vec(x, y, z);
}

/// Beside the kinds of grains.h.
enum { RING = GRAIN_KINDS, BRACKET };

static pls_shape_id shape_of(const verify_scene *scene, int kind)
{
    const double ring[] = {0.28, 0.09}, bracket[] = {0.3, 0.2};
    if (kind == RING) return verify_use_shape(scene, &values_ring, &(pls_shape_input){VALUES(ring)});
    if (kind == BRACKET) return verify_use_shape(scene, &values_bracket, &(pls_shape_input){VALUES(bracket)});
    return grain_shape(scene, (enum grain_kind)kind);
}

/// Relative change of the energy by one flight to the wall and back; NAN: it missed.
static double flight_error(const target *t, int kind, pls_faces faces, int number)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = kind < GRAIN_KINDS ? 6e-5 : 3e-5; // of a contact of some 0.05 s an 800th; rings and brackets are lighter
    verify_scene scene =
        verify_open(&def, "elastic", (const verify_value[]){{"kn", stiffness}, {"ks", 0.0}, {"friction", 0.0}, {NULL, 0.0}});
    verify_set_faces(&scene, faces, faces == PLS_FACES_VOLUME ? 0.1 : 0.0);
    pls_random random = pls_random_stream(11, (uint64_t)number, PLS_FOR_USER);
    const double along = pls_random_uniform(&random);
    const pls_vec3 hit = pls_add(pls_scale(t->from, 1.0 - along), pls_scale(t->to, along));
    const pls_vec3 out = pls_unit(pls_add(pls_unit(t->outwards), pls_scale(random_vector(&random), 0.1)));
    pls_body_def wall = verify_body_def(&scene, verify_add_mesh(&scene, t->mesh), pls_vec(0, 0, 0));
    wall.motion.axes = PLS_AXIS_ALL;
    pls_body_def grain = grain_def(&scene, shape_of(&scene, kind), (uint64_t)number, pls_add(hit, pls_scale(out, 0.65)));
    grain.velocity = pls_scale(out, -1.0);
    grain.angular_velocity = random_vector(&random);
    verify_add(&scene, &grain), verify_add(&scene, &wall);
    MUST(pls_world_prepare(scene.world));
    const double start = verify_total_energy(scene.world);
    bool touched = false;
    int free = 0; // looks without contact, after some with
    for (int look = 0; look < 2000 && free < 20; ++look)
    {
        MUST(pls_world_run(scene.world, 50));
        const bool touches = pls_world_contact_count(scene.world) > 0;
        touched = touched || touches;
        free = touched && !touches ? free + 1 : 0;
    }
    const double error = touched ? fabs(verify_total_energy(scene.world) / start - 1.0) : NAN;
    verify_close(&scene);
    return error;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(size_t count, double *x)
{
    qsort(x, count, sizeof *x, compare);
    return count > 0 ? x[count / 2] : NAN;
}

/// Of the changes of energy by a number of flights.
typedef struct bar
{
    double median, worst;
} bar;

/// `label`: of the grains.
static void fly(verify_sheet *sheet, const target *t, const char *label, const int *kinds, int kind_count, pls_faces faces, int flights,
                bar most)
{
    enum { MOST = 240 }; // six kinds, 40 flights
    double error[MOST], worst = 0.0;
    size_t count = 0;
    for (int j = 0; j < kind_count * flights && j < MOST; ++j)
    {
        const double e = flight_error(t, kinds[j % kind_count], faces, j);
        if (isnan(e)) continue;
        error[count++] = e, worst = fmax(worst, e);
    }
    const char *law = faces == PLS_FACES_VOLUME ? "volume" : "manifold";
    sheet_below(sheet, median(count, error), most.median, "%s, %s, %s: change of energy, median of %zu flights", t->name, label, law,
                count);
    sheet_below(sheet, worst, most.worst, "%s, %s, %s: the worst", t->name, label, law);
}

void case_wall_edges(verify_sheet *sheet)
{
    static const int convex[] = {GRAIN_BOX, GRAIN_STONE, GRAIN_PRISM, GRAIN_SOAP, GRAIN_CYLINDER, GRAIN_CAPSULE};
    static const int ring = RING, bracket = BRACKET;
    // Depths below the edges of a bracket have kinks, over which forces on the points of a wall jump: an error of the first order, which few points do not average out.
    const bar smooth = {1e-5, 1e-4}, sharp[2] = {{3e-3, 2e-2}, {1e-4, 1e-3}};
    const int flights = sheet->thorough ? 40 : 2, slow = sheet->thorough ? 10 : 1;
    for (size_t k = 0; k < sizeof targets / sizeof *targets; ++k)
        for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
        {
            fly(sheet, &targets[k], "convex grains", convex, sizeof convex / sizeof *convex, faces, flights, smooth);
            if (!sheet->thorough && k % 3 != 0) continue; // these take long
            fly(sheet, &targets[k], "rings", &ring, 1, faces, slow, smooth);
            fly(sheet, &targets[k], "brackets", &bracket, 1, faces, slow, sharp[faces == PLS_FACES_VOLUME]);
        }
}
