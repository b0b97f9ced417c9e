// test_seams.c -- what lies across the seam of two flush parts, boxes of a compound or pieces of a wall, is pushed as by one part without a seam.
#include "shape/builtin.h"
#include "support/numbers.h"
#include "support/solids.h"
#include "support/verify.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static const double depth = 0.004, area = 0.05; ///< of the overlap, of the volume law [m], [m^2]; grains are some 0.2 m large
static const double spin = 0.3;                 ///< of grains about the vertical [rad]: nothing lies along a seam or at right angles to it
static const double places[] = {0.0, 0.003, -0.02, 0.03, -0.05, 0.09}; ///< of grains beside the seam [m]

enum grain { BALL, EGG, BEAN, BRICK, SOAP, STONE, STANDING_CAN, LYING_CAN };
static const char *const grain_name[] = {"ball",        "ellipsoid",  "superquadric",      "box",
                                         "rounded box", "polyhedron", "standing cylinder", "lying cylinder"};

enum ground { ONE_BOX, TWO_BOXES, HALF_SPACE, WALL };
static const char *const ground_name[] = {"a box", "two boxes", "a half-space", "a wall of two pieces"};

static pls_vec3 up_of(int dimension) { return dimension == 3 ? pls_vec(0, 0, 1) : pls_vec(0, 1, 0); }

static pls_shape *make_grain(int dimension, enum grain kind)
{
    const bool flat = dimension == 2;
    const double radius[] = {0.2}, egg[] = {0.3, 0.2, 0.15, 0.0}, bean[] = {0.3, 0.2, 0.15, 0.7, 0.8, 0.0};
    const pls_vec3 house[] = {{0.2, 0.12, -0.1}, {-0.2, 0.12, -0.1}, {-0.2, -0.12, -0.1}, {0.2, -0.12, -0.1}, {0.03, 0.02, 0.15}};
    const pls_vec3 gable[] = {{0.2, -0.1, 0}, {0.03, 0.15, 0}, {-0.2, -0.1, 0}};
    switch (kind)
    {
        case BALL: return solids_make(flat ? &pls_disc_shape : &pls_sphere_shape, dimension, &(pls_shape_input){VALUES(radius)});
        case EGG: return solids_make(flat ? &pls_ellipse_shape : &pls_ellipsoid_shape, dimension, &(pls_shape_input){VALUES(egg)});
        case BEAN: return solids_make(&pls_superquadric_shape, dimension, &(pls_shape_input){VALUES(bean)});
        case BRICK: return solids_box(dimension, 0.2, 0.12, 0.15, 0.0);
        case SOAP: return solids_box(dimension, 0.2, 0.12, 0.15, 0.03);
        case STONE: return flat ? solids_hull(2, gable, 3, 0.0) : solids_hull(3, house, 5, 0.0);
        default: return solids_cylinder(0.1, 0.4, 0.0);
    }
}

static pls_shape *make_boxes(int dimension)
{
    const double none[PLS_MAX_PARAMETERS] = {0};
    pls_shape *box = solids_box(dimension, 1.0, dimension == 3 ? 2.0 : 0.5, 0.5, 0.0);
    pls_shape_part part[2];
    for (int k = 0; k < 2; ++k)
        part[k] = (pls_shape_part){
            .shape = box, .position = pls_vec(k == 0 ? -1.0 : 1.0, 0, 0), .orientation = pls_quat_identity(), .scale = 1.0};
    pls_shape *both = solids_make(&pls_compound_shape, dimension, &(pls_shape_input){VALUES(none), .parts = part, .part_count = 2});
    pls_shape_free(box);
    return both;
}

/// In 3D two triangles, their seam along the y axis.
static pls_shape *make_wall(int dimension)
{
    const double mesh[] = {0.0, 1.0}, line[] = {0.0, 0.0};
    const pls_vec3 point[] = {{-2, 0, 0}, {0, 0, 0}, {2, 0, 0}};
    if (dimension == 2) return solids_make(&pls_polyline_shape, 2, &(pls_shape_input){VALUES(line), .points = point, .point_count = 3});
    FILE *f = fopen("seam.obj", "w");
    assert_non_null(f);
    fputs("v -2 0 0\nv 0 -2 0\nv 2 0 0\nv 0 2 0\nf 1 2 4\nf 2 3 4\n", f);
    assert_int_equal(fclose(f), 0);
    return solids_make(&pls_mesh_shape, 3, &(pls_shape_input){VALUES(mesh), .path = "seam.obj"});
}

/// `shape` is taken over.
static pls_shape_id use(const verify_scene *scene, const char *name, pls_shape *shape)
{
    pls_shape_id id;
    MUST(pls_world_use_shape(scene->world, name, shape, &id));
    pls_shape_free(shape);
    return id;
}

static void add_ground(const verify_scene *scene, enum ground kind)
{
    const int dimension = scene->dimension;
    const pls_vec3 up = up_of(dimension);
    if (kind == HALF_SPACE)
    {
        verify_wall(scene, pls_vec(0, 0, 0), up);
        return;
    }
    pls_shape *shape = kind == ONE_BOX     ? solids_box(dimension, 2.0, dimension == 3 ? 2.0 : 0.5, 0.5, 0.0)
                       : kind == TWO_BOXES ? make_boxes(dimension)
                                           : make_wall(dimension);
    pls_body_def def = verify_body_def(scene, use(scene, "ground", shape), pls_scale(up, kind == WALL ? 0.0 : -0.5));
    def.motion.axes = PLS_AXIS_ALL;
    verify_add(scene, &def);
}

/// What pushes a grain `x` beside the seam, by the stiffness.
typedef struct push
{
    pls_vec3 force, torque; ///< about its centre [m], [m^2]
} push;

/// From the motion of a unit mass with unit moments that is let go, after one step so short that it does not matter.
static push push_on(int dimension, enum grain kind, enum ground ground, pls_faces faces, double x)
{
    const double stiffness = 1e4, dt = 1e-7;
    const verify_value elastic[] = {{"kn", stiffness}, {"ks", 0.0}, {"friction", 0.0}, {NULL, 0.0}};
    pls_world_def world = pls_default_world_def(dimension);
    world.dt = dt;
    verify_scene scene = verify_open(&world, "elastic", elastic);
    verify_set_faces(&scene, faces, faces == PLS_FACES_VOLUME ? area : 0.0);
    add_ground(&scene, ground);

    const pls_vec3 up = up_of(dimension);
    pls_shape *shape = make_grain(dimension, kind);
    pls_quat turn = kind == LYING_CAN ? solids_turn(pls_vec(0, 1, 0), M_PI_2) : pls_quat_identity();
    if (dimension == 3) turn = pls_quat_multiply(solids_turn(up, spin), turn);
    turn = pls_quat_multiply(turn, shape->principal);
    const pls_posed posed = pls_pose(shape, pls_vec(0, 0, 0), turn, 1.0);
    const double lowest = pls_dot(up, pls_posed_support(&posed, pls_scale(up, -1.0)));
    pls_body_def def = verify_body_def(&scene, use(&scene, "grain", shape), pls_add(pls_vec(x, 0, 0), pls_scale(up, -lowest - depth)));
    def.orientation = turn;
    def.mass = 1.0, def.inertia = pls_vec(1.0, 1.0, 1.0);
    const pls_body_id id = verify_add(&scene, &def);
    MUST(pls_world_run(scene.world, 1));
    const pls_body_motion m = verify_motion(scene.world, id);
    verify_close(&scene);
    const double impulse = stiffness * dt;
    return (push){pls_scale(m.velocity, 1.0 / impulse), pls_scale(m.angular_velocity, 1.0 / impulse)};
}

/// Force and torque are those of the reference but for a part `less` of the force.
static void expect(int dimension, enum grain grain, enum ground ground, double x, push p, push reference, double less, double tolerance)
{
    const double all = pls_length(reference.force), size = 0.2;
    const double off = pls_length(pls_sub(p.force, pls_scale(reference.force, 1.0 - less))) / all,
                 turned = pls_length(pls_sub(p.torque, reference.torque)) / (size * all);
    assert_true(all > 1e-4);
    if (!(off <= tolerance && turned <= fmax(tolerance, less)))
        fail_msg("%dD, %s on %s, %g m beside the seam: force off by %g, torque by %g of the force and %g m", dimension, grain_name[grain],
                 ground_name[ground], x, off, turned, size);
}

/// By the point law whatever is chosen. The seam is an edge of each part, and near to a grain that lies beside it: but an edge that is none.
static void what_is_round_is_pushed_by_one_part(void **state)
{
    (void)state;
    for (int dimension = 3; dimension >= 2; --dimension)
        for (enum grain grain = BALL; grain <= BEAN; ++grain)
            for (pls_faces faces = PLS_FACES_POINT; faces <= PLS_FACES_VOLUME; ++faces)
                for (size_t k = 0; k < sizeof places / sizeof *places; ++k)
                {
                    const push whole = push_on(dimension, grain, ONE_BOX, faces, places[k]);
                    assert_true(fabs(pls_length(whole.force) / depth - 1.0) < 1e-8);
                    for (enum ground ground = TWO_BOXES; ground <= WALL; ground += WALL - TWO_BOXES)
                        expect(dimension, grain, ground, places[k], push_on(dimension, grain, ground, faces, places[k]), whole, 0.0, 1e-9);
                }
}

/// Depth counts from the front alone: where one ends the next one goes on, and both make one contact.
static void pieces_of_a_wall_push_as_one(void **state)
{
    (void)state;
    for (int dimension = 3; dimension >= 2; --dimension)
        for (enum grain grain = BRICK; grain <= (dimension == 3 ? LYING_CAN : STONE); ++grain)
            for (pls_faces faces = PLS_FACES_MANIFOLD; faces <= PLS_FACES_VOLUME; ++faces)
                for (size_t k = 0; k < sizeof places / sizeof *places; ++k)
                    expect(dimension, grain, WALL, places[k], push_on(dimension, grain, WALL, faces, places[k]),
                           push_on(dimension, grain, HALF_SPACE, faces, places[k]), 0.0, 1e-9);
}

/// Depth counts from the nearest face, which is the seam's for points less than t under the top and beside it: per length of a seam integral d dV lacks t^3/3, that is of a force t A the
/// part t L/A, half of it where the other body's depths count too. Of a cylinder of length l on its side it is t^2 integrated along the seam, 4 t/(5 l) at right angles to it.
static void volumes_over_flush_boxes_add_up_but_for_the_seams_faces(void **state)
{
    (void)state;
    const double t = depth, along = 1.0 / cos(spin);
    for (size_t k = 0; k < 4; ++k) // where the seam runs from side to side
    {
        const double x = places[k], of_can = 2.0 * sqrt(0.01 - x * x) / (M_PI * 0.01);
        const struct
        {
            int dimension;
            enum grain grain;
            double less;
        } known[] = {{3, BRICK, 0.5 * t / 0.4 * along},     {3, STONE, 0.5 * t / 0.4 * along}, {3, STANDING_CAN, t * of_can},
                     {3, LYING_CAN, 0.8 * t / 0.4 * along}, {2, BRICK, 0.5 * t / 0.4},         {2, STONE, 0.5 * t / 0.4}};
        for (size_t j = 0; j < sizeof known / sizeof *known; ++j)
            expect(known[j].dimension, known[j].grain, TWO_BOXES, x,
                   push_on(known[j].dimension, known[j].grain, TWO_BOXES, PLS_FACES_VOLUME, x),
                   push_on(known[j].dimension, known[j].grain, ONE_BOX, PLS_FACES_VOLUME, x), known[j].less, 5e-4);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(what_is_round_is_pushed_by_one_part),
                                       cmocka_unit_test(pieces_of_a_wall_push_as_one),
                                       cmocka_unit_test(volumes_over_flush_boxes_add_up_but_for_the_seams_faces)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
