// verify.h -- small helpers with which tests build worlds. A failing call of the library fails the running test.
#ifndef PLS_TESTS_SUPPORT_VERIFY_H
#define PLS_TESTS_SUPPORT_VERIFY_H

#include <particls/observe.h>
#include <particls/world.h>

/// A call that must succeed.
#define MUST(call) verify_must((call), #call, __FILE__, __LINE__)
void verify_must(pls_status status, const char *call, const char *file, int line);

/// A named parameter of a law or shape. Lists end with a null name.
typedef struct verify_value
{
    const char *name;
    double value;
} verify_value;

const pls_law_ops *verify_law(const char *name);
const pls_shape_ops *verify_shape(const char *name);

/// A world with one material, the sphere of radius 1 and the plane. The material has density 1; a law between grains and itself may be set.
typedef struct verify_scene
{
    pls_world *world;
    int dimension;
    pls_material_id grain;
    pls_shape_id ball, wall;
} verify_scene;

/// `law` null: none is set. `values` replace the law's defaults.
verify_scene verify_open(const pls_world_def *def, const char *law, const verify_value *values);
void verify_close(verify_scene *scene);
void verify_set_law(pls_world *world, pls_material_id a, pls_material_id b, const char *law, const verify_value *values);

/// A built-in shape with all of its numbers, in the order of its table.
pls_shape_id verify_add_shape(const verify_scene *scene, const char *shape, const double *values, size_t count);
/// A shape of any operations.
pls_shape_id verify_use_shape(const verify_scene *scene, const pls_shape_ops *ops, const pls_shape_input *input);
/// The convex hull of points of the x-y plane, extruded along z.
pls_shape_id verify_add_prism(const verify_scene *scene, const pls_vec3 *points, size_t count, double height);
/// A wall of triangles from a mesh file.
pls_shape_id verify_add_mesh(const verify_scene *scene, const char *path);
/// The convex hull of points.
pls_shape_id verify_add_hull(const verify_scene *scene, const pls_vec3 *points, size_t count);
/// A compound of two spheres (2D: discs) on the x axis.
pls_shape_id verify_add_dumbbell(const verify_scene *scene, double radius, double distance);
/// How contacts of faces are told to the law. `area` is of PLS_FACES_VOLUME.
void verify_set_faces(const verify_scene *scene, pls_faces faces, double area);
/// A body of the material's density 1 at rest.
pls_body_def verify_body_def(const verify_scene *scene, pls_shape_id shape, pls_vec3 position);

/// Body definition of a solid sphere (2D: disc) of this radius and mass.
pls_body_def verify_ball_def(const verify_scene *scene, double radius, double mass, pls_vec3 position, pls_vec3 velocity);
pls_body_id verify_ball(const verify_scene *scene, double radius, double mass, pls_vec3 position, pls_vec3 velocity);
pls_body_id verify_add(const verify_scene *scene, const pls_body_def *def);
/// A fixed plane through `point`, body on the side the normal points to.
pls_body_id verify_wall(const verify_scene *scene, pls_vec3 point, pls_vec3 normal);

pls_body_motion verify_motion(const pls_world *world, pls_body_id id);
pls_world_figures verify_figures(pls_world *world);
/// Kinetic + stored + potential + dissipated [J].
double verify_total_energy(pls_world *world);
uint64_t verify_hash(pls_world *world);

/// A field of force: force and torque on a body as a function of time and of its motion. `potential` may be null.
typedef struct verify_field
{
    void (*force)(double time, pls_vec3 position, pls_vec3 velocity, uint32_t body, pls_vec3 *force, pls_vec3 *torque);
    double (*potential)(pls_vec3 position, double mass);
} verify_field;
/// `field` must outlive the world.
void verify_add_field(pls_world *world, const verify_field *field);

#endif
