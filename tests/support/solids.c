// solids.c -- shapes, poses and depths for tests of contact.

#include "support/solids.h"

#include "contact/solid_list.h"
#include "contact/wall_touch.h"
#include "contact/faces.h"
#include "shape/builtin.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static uint64_t random_state = 1;

void solids_seed(uint64_t seed) { random_state = seed; }

double solids_uniform(double low, double high)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(random_state >> 11) * 0x1p-53;
}

pls_vec3 solids_direction(int dimension)
{
    for (;;)
    {
        pls_vec3 n = pls_vec(solids_uniform(-1, 1), solids_uniform(-1, 1), dimension == 3 ? solids_uniform(-1, 1) : 0.0);
        if (pls_length(n) < 1.0 && pls_length(n) > 0.1) return pls_unit(n);
    }
}

pls_quat solids_turn(pls_vec3 axis, double angle)
{
    const double s = sin(0.5 * angle);
    return (pls_quat){cos(0.5 * angle), axis.x * s, axis.y * s, axis.z * s};
}

/// The least rotation that takes unit a to unit b.
pls_quat solids_turn_to(pls_vec3 a, pls_vec3 b)
{
    pls_vec3 c = pls_cross(a, b);
    if (1.0 + pls_dot(a, b) < 1e-9) return solids_turn(fabs(a.z) < 0.9 ? pls_unit(pls_cross(a, pls_vec(0, 0, 1))) : pls_vec(1, 0, 0), M_PI);
    return pls_quat_unit((pls_quat){1.0 + pls_dot(a, b), c.x, c.y, c.z});
}

// ---- shapes and queries -------------------------------------------------------------------------------------------------------------------------------------

pls_shape *solids_make(const pls_shape_ops *ops, int dimension, const pls_shape_input *input)
{
    pls_shape *shape = NULL;
    if (pls_shape_make(ops, dimension, input, "shape 'x'", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

pls_shape *solids_box(int dimension, double x, double y, double z, double rounding)
{
    const double values[] = {x, y, z, rounding};
    return solids_make(&pls_box_shape, dimension, &(pls_shape_input){VALUES(values)});
}

pls_shape *solids_plane(int dimension)
{
    const double values[] = {0.0};
    return solids_make(&pls_plane_shape, dimension, &(pls_shape_input){VALUES(values)});
}

pls_shape *solids_cylinder(double radius, double length, double rounding)
{
    const double values[] = {radius, length, rounding};
    return solids_make(&pls_cylinder_shape, 3, &(pls_shape_input){VALUES(values)});
}

pls_shape *solids_hull(int dimension, const pls_vec3 *points, size_t count, double rounding)
{
    const double values[] = {[0] = rounding, [1] = rounding, [2] = rounding};
    return solids_make(dimension == 3 ? &pls_polyhedron_shape : &pls_polygon_shape, dimension,
                       &(pls_shape_input){VALUES(values), .points = points, .point_count = count});
}

/// Random points of an ellipsoid about the origin.
pls_shape *solids_stone(int dimension, int count, double rounding)
{
    pls_vec3 points[200];
    assert_true(count <= 200);
    const double h[3] = {solids_uniform(0.4, 0.6), solids_uniform(0.4, 0.6), solids_uniform(0.4, 0.6)};
    for (int k = 0; k < count; ++k)
    {
        pls_vec3 n = solids_direction(dimension);
        points[k] = pls_vec(h[0] * n.x, h[1] * n.y, h[2] * n.z);
    }
    return solids_hull(dimension, points, (size_t)count, rounding);
}

pls_narrow_options solids_options(pls_faces faces, double area)
{
    pls_narrow_options options = pls_default_narrow_options();
    options.faces = faces;
    options.face_area = area;
    return options;
}

pls_touch solids_touch(const pls_posed *a, const pls_posed *b, pls_faces faces, double area)
{
    const pls_narrow_options options = solids_options(faces, area);
    pls_pair_state state = {{0.0}};
    pls_narrow_counts counts = {0};
    pls_touch t = {0};
    pls_narrow_phase(a, b, &options, &state, &t, &counts);
    return t;
}

pls_touch solids_wall_touch(const pls_posed *a, const pls_posed *wall, pls_faces faces, double area)
{
    pls_wall_sum sum = pls_wall_sum_of(a);
    double agreed = 0.0;
    for (uint32_t k = 0; k < wall->shape->part_count; ++k)
    {
        const pls_posed facet = pls_posed_part(wall, k);
        const pls_facet *seams = pls_shape_facet(facet.shape);
        const double front = pls_dot(pls_posed_turn(&facet, seams->normal), pls_sub(facet.position, wall->position)) > 0.0 ? 1.0 : -1.0;
        const pls_touch depth = {.delta = 0.0, .normal = pls_scale(pls_posed_turn(&facet, seams->normal), -front), .point = facet.position};
        if (agreed == 0.0) agreed = front;
        assert_true(front == agreed); // facets of one wall have normals on one side, whatever the file says
        pls_wall_add(&sum, &facet, seams, front, &depth);
    }
    pls_touch out = {.delta = 0.0};
    const pls_narrow_options options = solids_options(faces, area);
    pls_wall_touch(&sum, &options, &out);
    return out;
}

bool solids_faces_touch(const pls_posed *a, const pls_posed *b, const pls_depth *depth, const pls_narrow_options *options,
                        pls_overlap_record *record, pls_touch *out)
{
    bool recorded;
    return pls_faces_touch(a, b, depth, options, record, &recorded, out);
}

void solids_add_wrench(const pls_posed *a, const pls_posed *b, pls_vec3 *force, pls_vec3 *torque, double *energy)
{
    const pls_touch t = solids_touch(a, b, PLS_FACES_VOLUME, 1.0);
    if (!(t.delta > 0.0)) return;
    const pls_vec3 f = pls_scale(t.normal, t.delta);
    *force = pls_add(*force, f);
    *torque = pls_add(*torque, pls_add(pls_cross(t.point, f), pls_scale(f, t.twist)));
    *energy += t.energy_delta * t.energy_delta;
}

pls_depth solids_depth(const pls_posed *a, const pls_posed *b, pls_pair_state *state)
{
    const pls_narrow_options options = solids_options(PLS_FACES_POINT, 0.0);
    pls_pair_state none = {{0}};
    pls_narrow_counts counts = {0};
    pls_touch t;
    pls_narrow_phase(a, b, &options, state ? state : &none, &t, &counts);
    const pls_vec3 half = pls_scale(t.normal, 0.5 * t.delta);
    return (pls_depth){
        .delta = t.delta, .normal = t.normal, .on_a = pls_add(t.point, half), .on_b = pls_sub(t.point, half), .converged = true};
}
