// Mass properties by quadrature of the SDF alone, against closed forms: volume, centre and inertia within 1e-6, and the error as told no less than a third of the true one.

#include "shape/mass_quadrature.h"

#include "shape/builtin.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static const double bar = 1e-6;

/// Quadrature of the shape's SDF, whatever functions it has besides.
static void expect_mass(const pls_shape *shape, const pls_mass_properties *known)
{
    pls_mass_properties found;
    pls_vec3 middle = pls_scale(pls_add(shape->lower, shape->upper), 0.5);
    double reach = shape->radius + pls_length(pls_sub(middle, shape->mass.centre));
    const pls_status status =
        shape->uneven ? pls_uneven_mass_by_quadrature(shape, middle, reach, &found) : pls_mass_by_quadrature(shape, middle, reach, &found);
    if (status != PLS_OK) fail_msg("%s", pls_last_message());
    double trace = known->inertia[0] + known->inertia[1] + known->inertia[2];
    double gyration = sqrt((shape->dimension == 2 ? trace : 0.5 * trace) / known->volume);
    double worst = fmax(fabs(found.volume / known->volume - 1.0), pls_length(pls_sub(found.centre, known->centre)) / gyration);
    for (int k = 0; k < 6; ++k) worst = fmax(worst, fabs(found.inertia[k] - known->inertia[k]) / trace);
    if (!(worst <= bar) || !(found.error <= bar) || !(worst <= 3.0 * found.error + 1e-12))
        fail_msg("%s in %dD: error %.3g, told as %.3g", shape->ops->name, shape->dimension, worst, found.error);
}

static pls_shape *make(const pls_shape_ops *ops, int dimension, const pls_shape_input *input)
{
    pls_shape *shape = NULL;
    if (pls_shape_make(ops, dimension, input, "shape", &shape) != PLS_OK) fail_msg("%s", pls_last_message());
    return shape;
}

static void check(const pls_shape_ops *ops, int dimension, const double *values, size_t count, const pls_mass_properties *known)
{
    const pls_shape_input input = {.values = values, .value_count = count};
    pls_shape *shape = make(ops, dimension, &input);
    expect_mass(shape, known);
    pls_shape_free(shape);
}

// ---- built-in shapes ------------------------------------------------------------------------------------------------------------------------------------------

static void balls_and_discs(void **state)
{
    (void)state;
    const double R = 0.7, V = 4.0 / 3.0 * M_PI * R * R * R, I = 0.4 * V * R * R, A = M_PI * R * R;
    check(&pls_sphere_shape, 3, NUMBERS(R), &(pls_mass_properties){.volume = V, .inertia = {I, I, I}});
    check(&pls_sphere_shape, 2, NUMBERS(R), &(pls_mass_properties){.volume = A, .inertia = {[2] = 0.5 * A * R * R}});
}

static void boxes(void **state)
{
    (void)state;
    static const double half[2][3] = {{1.0, 0.6, 0.4}, {1.0, 1.0, 0.05}};
    for (int k = 0; k < 2; ++k)
    {
        const double a = half[k][0], b = half[k][1], c = half[k][2], V = 8.0 * a * b * c, A = 4.0 * a * b;
        const double values[4] = {a, b, c, 0.0};
        const pls_mass_properties known = {.volume = V,
                                           .inertia = {V / 3 * (b * b + c * c), V / 3 * (a * a + c * c), V / 3 * (a * a + b * b)}};
        check(&pls_box_shape, 3, COUNTED(values), &known);
        check(&pls_box_shape, 2, COUNTED(values), &(pls_mass_properties){.volume = A, .inertia = {[2] = A / 3 * (a * a + b * b)}});
    }
}

static void ellipsoids(void **state)
{
    (void)state;
    const double a = 1.0, b = 0.6, c = 0.3, V = 4.0 / 3.0 * M_PI * a * b * c, A = M_PI * a * b, values[4] = {a, b, c, 0.0};
    const pls_mass_properties known = {.volume = V, .inertia = {V / 5 * (b * b + c * c), V / 5 * (a * a + c * c), V / 5 * (a * a + b * b)}};
    check(&pls_ellipsoid_shape, 3, COUNTED(values), &known);
    check(&pls_ellipsoid_shape, 2, COUNTED(values), &(pls_mass_properties){.volume = A, .inertia = {[2] = A / 4 * (a * a + b * b)}});
}

static void cylinders_and_capsules(void **state)
{
    (void)state;
    const double r = 0.4, l = 1.0, V = M_PI * r * r * l, xx = V * (r * r / 4 + l * l / 12), B = 4.0 / 3.0 * M_PI * r * r * r;
    check(&pls_cylinder_shape, 3, NUMBERS(r, l, 0.0), &(pls_mass_properties){.volume = V, .inertia = {xx, xx, V * r * r / 2}});
    // Half balls at the ends of the straight part; their centres of mass are 3/8 r from the flat side.
    const double along = V * r * r / 2 + 0.4 * B * r * r, across = xx + B * (0.4 * r * r + l * l / 4 + 3.0 / 8.0 * l * r);
    check(&pls_capsule_shape, 3, NUMBERS(r, l), &(pls_mass_properties){.volume = V + B, .inertia = {along, across, across}});
}

/// With corners at the origin and the ends of the axes, (1, 0.8, 0.5) long.
static void simplices(void **state)
{
    (void)state;
    const double a = 1.0, b = 0.8, c = 0.5, V = a * b * c / 6.0, A = a * b / 2.0;
    const pls_vec3 corner[4] = {{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}};
    const double none[2] = {0.0, 0.0};
    pls_shape *shape = make(&pls_polyhedron_shape, 3, &(pls_shape_input){VALUES(none), .points = corner, .point_count = 4});
    // Second moments about the centre of a simplex of n dimensions: x_i^2 V n/((n+1)^2 (n+2)), -x_i x_j V/((n+1)^2 (n+2)).
    const double s = V * 3.0 / 80.0, m = V / 80.0;
    expect_mass(shape, &(pls_mass_properties){
                           .volume = V,
                           .centre = {a / 4, b / 4, c / 4},
                           .inertia = {s * (b * b + c * c), s * (a * a + c * c), s * (a * a + b * b), m * a * b, m * a * c, m * b * c}});
    pls_shape_free(shape);
    shape = make(&pls_polygon_shape, 2, &(pls_shape_input){VALUES(none), .points = corner, .point_count = 3});
    expect_mass(shape, &(pls_mass_properties){.volume = A, .centre = {a / 3, b / 3, 0.0}, .inertia = {[2] = A / 18.0 * (a * a + b * b)}});
    pls_shape_free(shape);
}

/// Shapes whose own closed forms are long and tested where they belong.
static void rounded_shapes_and_hulls(void **state)
{
    (void)state;
    pls_vec3 corner[24];
    for (int k = 0; k < 24; ++k) // on an ellipsoid, by the golden angle
    {
        double z = 1.0 - (2.0 * k + 1.0) / 24.0, r = sqrt(1.0 - z * z);
        corner[k] = pls_vec(r * cos(2.399963229728653 * k), 0.8 * r * sin(2.399963229728653 * k), 0.6 * z);
    }
    const struct
    {
        const pls_shape_ops *ops;
        pls_shape_input input;
    } shape[4] = {{&pls_box_shape, {.values = (double[]){1.0, 0.6, 0.4, 0.1}, .value_count = 4}},
                  {&pls_cylinder_shape, {.values = (double[]){0.4, 1.0, 0.1}, .value_count = 3}},
                  {&pls_polyhedron_shape, {.values = (double[]){0.0, 0.0}, .value_count = 2, .points = corner, .point_count = 24}},
                  {&pls_superquadric_shape, {.values = (double[]){0.9, 0.7, 0.5, 0.5, 0.7, 0.0}, .value_count = 6}}};
    for (int k = 0; k < 4; ++k)
    {
        pls_shape *made = make(shape[k].ops, 3, &shape[k].input);
        if (made->mass.error != 0.0) fail_msg("shape %d has no closed form", k);
        expect_mass(made, &made->mass);
        pls_shape_free(made);
    }
}

// ---- not convex -----------------------------------------------------------------------------------------------------------------------------------------------

static const pls_parameter none[] = {{.name = NULL}};

static void check_sdf(double (*sdf)(const pls_shape *, pls_vec3), const pls_mass_properties *known)
{
    const pls_shape_ops ops = {.api_version = PLS_API_VERSION, .name = "mine", .parameters = none, .in_3d = true, .sdf = sdf};
    check(&ops, 3, NULL, 0, known);
}

static double torus(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return hypot(hypot(X.x, X.y) - 1.0, X.z) - 0.25;
}

static void a_torus(void **state)
{
    (void)state;
    const double V = 2.0 * M_PI * M_PI * 0.0625, across = V * (0.5 + 0.625 * 0.0625);
    check_sdf(torus, &(pls_mass_properties){.volume = V, .inertia = {across, across, V * (1.0 + 0.75 * 0.0625)}});
}

static double box_at(pls_vec3 X, pls_vec3 centre, pls_vec3 half)
{
    pls_vec3 d = pls_vec(fabs(X.x - centre.x) - half.x, fabs(X.y - centre.y) - half.y, fabs(X.z - centre.z) - half.z);
    return pls_length(pls_vec(fmax(d.x, 0.0), fmax(d.y, 0.0), fmax(d.z, 0.0))) + fmin(fmax(d.x, fmax(d.y, d.z)), 0.0);
}

static double angle_iron(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return fmin(box_at(X, pls_vec(0.0, 0.0, 0.0), pls_vec(1.0, 0.3, 0.2)), box_at(X, pls_vec(0.8, 0.6, 0.0), pls_vec(0.2, 0.5, 0.2)));
}

/// Two boxes less what they share.
static void two_boxes(void **state)
{
    (void)state;
    const double v[3] = {0.48, 0.16, -0.032}, x[3] = {0.0, 0.8, 0.8}, y[3] = {0.0, 0.6, 0.2};
    const double a[3] = {1.0, 0.2, 0.2}, b[3] = {0.3, 0.5, 0.1};
    double V = 0.0, mx = 0.0, my = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
    for (int k = 0; k < 3; ++k)
    {
        V += v[k], mx += v[k] * x[k], my += v[k] * y[k];
        xx += v[k] * (x[k] * x[k] + a[k] * a[k] / 3), yy += v[k] * (y[k] * y[k] + b[k] * b[k] / 3), xy += v[k] * x[k] * y[k];
    }
    const double zz = V * 0.04 / 3.0;
    xx -= mx * mx / V, yy -= my * my / V, xy -= mx * my / V;
    check_sdf(angle_iron,
              &(pls_mass_properties){.volume = V, .centre = {mx / V, my / V, 0.0}, .inertia = {yy + zz, xx + zz, xx + yy, -xy}});
}

static double twin(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return fmin(pls_length(pls_sub(X, pls_vec(0.5, 0.0, 0.0))), pls_length(pls_add(X, pls_vec(0.5, 0.0, 0.0)))) - 0.7;
}

/// Discs of radius^2 R^2 - u^2 at x = d + u, u from -d to R, and their mirror image.
static void expect_twins(double R, double d, double (*sdf)(const pls_shape *, pls_vec3))
{
    double moment[5]; // of u
    for (int n = 0; n < 5; ++n) moment[n] = (pow(R, n + 1) - pow(-d, n + 1)) / (n + 1);
    double V = 2.0 * M_PI * (R * R * moment[0] - moment[2]);
    double xx =
        2.0 * M_PI * (R * R * (d * d * moment[0] + 2.0 * d * moment[1] + moment[2]) - d * d * moment[2] - 2.0 * d * moment[3] - moment[4]);
    double yy = 0.5 * M_PI * (pow(R, 4) * moment[0] - 2.0 * R * R * moment[2] + moment[4]);
    check_sdf(sdf, &(pls_mass_properties){.volume = V, .inertia = {2.0 * yy, xx + yy, xx + yy}});
}

/// Of these one ball comes into a cube of the first division by a corner that Gauss's points do not see.
static double wide_twin(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return fmin(pls_length(pls_sub(X, pls_vec(0.55, 0.0, 0.0))), pls_length(pls_add(X, pls_vec(0.55, 0.0, 0.0)))) - 1.0;
}

static void two_balls_that_overlap(void **state)
{
    (void)state;
    expect_twins(0.7, 0.5, twin);
    expect_twins(1.0, 0.55, wide_twin);
}

// ---- density ----------------------------------------------------------------------------------------------------------------------------------------------------

static double block(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return box_at(X, pls_vec(0.0, 0.0, 0.0), pls_vec(1.0, 0.6, 0.4));
}

static double growing(const pls_shape *shape, pls_vec3 X)
{
    (void)shape;
    return exp(X.x);
}

/// e^x in a box: integrals of x^n e^x from -1 to 1.
static void a_density_that_grows(void **state)
{
    (void)state;
    const pls_shape_ops ops = {.api_version = PLS_API_VERSION,
                               .name = "mine",
                               .parameters = none,
                               .in_3d = true,
                               .convex = true,
                               .sdf = block,
                               .density = growing};
    const double e = exp(1.0), area = 1.2 * 0.8, M = area * (e - 1.0 / e), first = area * 2.0 / e, second = area * (e - 5.0 / e);
    const double xx = second - first * first / M, yy = M * 0.12, zz = M * 0.16 / 3.0;
    check(&ops, 3, NULL, 0, &(pls_mass_properties){.volume = M, .centre = {first / M, 0.0, 0.0}, .inertia = {yy + zz, xx + zz, xx + yy}});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(balls_and_discs),
        cmocka_unit_test(boxes),
        cmocka_unit_test(ellipsoids),
        cmocka_unit_test(cylinders_and_capsules),
        cmocka_unit_test(simplices),
        cmocka_unit_test(rounded_shapes_and_hulls),
        cmocka_unit_test(a_torus),
        cmocka_unit_test(two_boxes),
        cmocka_unit_test(two_balls_that_overlap),
        cmocka_unit_test(a_density_that_grows),
    };
    return cmocka_run_group_tests_name("mass quadrature", tests, NULL, NULL);
}
