// lab.h -- small worlds for tests of observers: balls of one size, planes, one elastic law, and a column whose forces are known.
#ifndef PLS_TESTS_OBSERVE_LAB_H
#define PLS_TESTS_OBSERVE_LAB_H

#include <particls/particls.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static inline void expect_near(double value, double expected, double error)
{
    if (!(fabs(value - expected) <= error)) print_message("%.17g, expected %.17g +- %g\n", value, expected, error);
    assert_true(fabs(value - expected) <= error);
}

static inline void done(pls_status status)
{
    if (status != PLS_OK) print_message("%s\n", pls_last_message());
    assert_int_equal(status, PLS_OK);
}

static const pls_shape_ops *shape_named(const char *name)
{
    for (const pls_shape_ops *const *ops = pls_builtin_shapes(); *ops; ++ops)
    {
        if (strcmp((*ops)->name, name) == 0) return *ops;
    }
    return NULL;
}

static const pls_law_ops *law_named(const char *name)
{
    for (const pls_law_ops *const *ops = pls_builtin_laws(); *ops; ++ops)
    {
        if (strcmp((*ops)->name, name) == 0) return *ops;
    }
    return NULL;
}

/// A world with one ball shape, planes and one elastic material.
typedef struct lab
{
    pls_world *world;
    pls_shape_id ball, plane;
    pls_material_id material;
} lab;

static const double kn = 1000;
static const double ks = 400;

static inline lab make_lab(const pls_world_def *def, double radius, double density)
{
    lab l = {0};
    done(pls_world_create(def, &l.world));
    done(pls_world_add_shape(l.world, "ball", shape_named("sphere"), &radius, 1, &l.ball));
    const double none[1] = {0};
    done(pls_world_add_shape(l.world, "plane", shape_named("plane"), none, 1, &l.plane));
    pls_material_def material = pls_default_material_def();
    strcpy(material.name, "grain");
    material.values.density = density;
    done(pls_world_add_material(l.world, &material, &l.material));
    const double law[3] = {kn, ks, 0.3};
    done(pls_world_set_law(l.world, l.material, l.material, law_named("elastic"), law));
    return l;
}

static inline pls_body_id add_ball(const lab *l, const char *group, pls_vec3 position, pls_vec3 velocity, pls_vec3 angular_velocity)
{
    pls_body_def body = pls_default_body_def();
    body.shape = l->ball;
    body.material = l->material;
    if (group[0])
    {
        body.group = pls_world_find_group(l->world, group);
        if (body.group.index1 == 0) done(pls_world_add_group(l->world, group, &body.group));
    }
    body.position = position;
    body.velocity = velocity;
    body.angular_velocity = angular_velocity;
    pls_body_id id;
    done(pls_world_add_body(l->world, &body, &id));
    return id;
}

/// A fixed wall; `normal_turn` takes z (2D: y) to its normal.
static inline void add_wall(const lab *l, const char *group, pls_vec3 position, pls_quat normal_turn)
{
    pls_body_def body = pls_default_body_def();
    body.shape = l->plane;
    body.material = l->material;
    done(pls_world_add_group(l->world, group, &body.group));
    body.position = position;
    body.orientation = normal_turn;
    body.motion.axes = PLS_AXIS_ALL;
    pls_body_id id;
    done(pls_world_add_body(l->world, &body, &id));
}

static const pls_quat half_turn_about_x = {0, 1, 0, 0};

enum { COLUMN_GAPS = 3 }; // contacts from plane to plane
static const double column_radius = 0.5;
static const double column_overlap = 0.02;

/// Two balls on each other between two planes, all three contacts pressed by the same overlap: force kn overlap everywhere.
static inline lab make_column(void)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-4;
    lab l = make_lab(&def, column_radius, 1000);
    const double height = 4 * column_radius - COLUMN_GAPS * column_overlap;
    add_wall(&l, "bottom", pls_vec(0, 0, 0), pls_quat_identity());
    add_ball(&l, "pack", pls_vec(0, 0, column_radius - column_overlap), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    add_ball(&l, "pack", pls_vec(0, 0, height - column_radius + column_overlap), pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    add_wall(&l, "top", pls_vec(0, 0, height), half_turn_about_x);
    done(pls_world_prepare(l.world));
    return l;
}

#endif
