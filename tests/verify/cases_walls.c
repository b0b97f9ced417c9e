// cases_walls.c -- grains that hit walls of triangles where these have edges: ridges, corners, free rims, valleys. Undamped and without friction they keep their energy.
#include "verify/cases.h"

#include "base/random.h"
#include "support/grains.h"
#include "support/numbers.h"

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

/// Relative change of the energy by one flight to the wall and back; NAN: it missed.
static double flight_error(const target *t, enum grain_kind kind, pls_faces faces, int number)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 6e-5; // of a contact of some 0.05 s an 800th
    verify_scene scene =
        verify_open(&def, "elastic", (const verify_value[]){{"kn", stiffness}, {"ks", 0.0}, {"friction", 0.0}, {NULL, 0.0}});
    verify_set_faces(&scene, faces, faces == PLS_FACES_VOLUME ? 0.1 : 0.0);
    pls_random random = pls_random_stream(11, (uint64_t)number, PLS_FOR_USER);
    const double along = pls_random_uniform(&random);
    const pls_vec3 hit = pls_add(pls_scale(t->from, 1.0 - along), pls_scale(t->to, along));
    const pls_vec3 out = pls_unit(pls_add(pls_unit(t->outwards), pls_scale(random_vector(&random), 0.1)));
    pls_body_def wall = verify_body_def(&scene, verify_add_mesh(&scene, t->mesh), pls_vec(0, 0, 0));
    wall.motion.axes = PLS_AXIS_ALL;
    pls_body_def grain = grain_def(&scene, grain_shape(&scene, kind), (uint64_t)number, pls_add(hit, pls_scale(out, 0.65)));
    grain.velocity = pls_scale(out, -1.0);
    grain.angular_velocity = random_vector(&random);
    verify_add(&scene, &grain), verify_add(&scene, &wall);
    MUST(pls_world_prepare(scene.world));
    const double start = verify_total_energy(scene.world);
    bool touched = false;
    int free = 0; // looks without contact, after some with
    for (int look = 0; look < 1000 && free < 20; ++look)
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

void case_wall_edges(verify_sheet *sheet)
{
    static const enum grain_kind kinds[] = {GRAIN_BOX, GRAIN_STONE, GRAIN_PRISM, GRAIN_SOAP, GRAIN_CYLINDER, GRAIN_CAPSULE};
    enum { KINDS = sizeof kinds / sizeof *kinds, MOST = 40 };
    const int flights = sheet->thorough ? MOST : 2;
    for (size_t k = 0; k < sizeof targets / sizeof *targets; ++k)
        for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
        {
            double error[KINDS * MOST], worst = 0.0;
            size_t count = 0;
            for (int j = 0; j < KINDS * flights; ++j)
            {
                const double e = flight_error(&targets[k], kinds[j % KINDS], faces, j);
                if (isnan(e)) continue;
                error[count++] = e, worst = fmax(worst, e);
            }
            const char *law = faces == PLS_FACES_VOLUME ? "volume" : "manifold";
            sheet_below(sheet, median(count, error), 1e-5, "%s, %s: change of energy, median of %zu flights", targets[k].name, law, count);
            sheet_below(sheet, worst, 1e-4, "%s, %s: the worst", targets[k].name, law);
        }
}
