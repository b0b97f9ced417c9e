#include "support/verify.h"
#include "support/numbers.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

void verify_must(pls_status status, const char *call, const char *file, int line)
{
    if (status == PLS_OK) return;
    print_error("%s\nfailed with %s: %s\n", call, pls_status_name(status), pls_last_message());
    _fail(file, line);
}

const pls_law_ops *verify_law(const char *name)
{
    for (const pls_law_ops *const *ops = pls_builtin_laws(); *ops; ++ops)
        if (strcmp((*ops)->name, name) == 0) return *ops;
    fail_msg("no built-in law '%s'", name);
    return NULL;
}

const pls_shape_ops *verify_shape(const char *name)
{
    for (const pls_shape_ops *const *ops = pls_builtin_shapes(); *ops; ++ops)
        if (strcmp((*ops)->name, name) == 0) return *ops;
    fail_msg("no built-in shape '%s'", name);
    return NULL;
}

static void fill_values(const pls_parameter *table, const verify_value *given, double *values)
{
    pls_parameters_default(table, values);
    for (; given && given->name; ++given)
    {
        int place = pls_parameter_find(table, given->name);
        if (place < 0) fail_msg("no parameter '%s'", given->name);
        values[place] = given->value;
    }
}

void verify_set_law(pls_world *world, pls_material_id a, pls_material_id b, const char *law, const verify_value *values)
{
    const pls_law_ops *ops = verify_law(law);
    double all[PLS_MAX_PARAMETERS] = {0};
    fill_values(ops->parameters, values, all);
    MUST(pls_world_set_law(world, a, b, ops, all));
}

static pls_shape_id add_shape(pls_world *world, const char *shape, const verify_value *given)
{
    const pls_shape_ops *ops = verify_shape(shape);
    double values[PLS_MAX_PARAMETERS] = {0};
    pls_shape_id id;
    fill_values(ops->parameters, given, values);
    MUST(pls_world_add_shape(world, shape, ops, COUNTED(values), &id));
    return id;
}

/// "box", "box 2", "box 3": the first that is free.
static void free_name(const verify_scene *scene, const char *shape, char name[PLS_NAME_SIZE])
{
    snprintf(name, PLS_NAME_SIZE, "%s", shape);
    for (int k = 2; pls_world_find_shape(scene->world, name).index1; ++k) snprintf(name, PLS_NAME_SIZE, "%s %d", shape, k);
}

pls_shape_id verify_add_shape(const verify_scene *scene, const char *shape, const double *values, size_t count)
{
    pls_shape_id id;
    char name[PLS_NAME_SIZE];
    free_name(scene, shape, name);
    MUST(pls_world_add_shape(scene->world, name, verify_shape(shape), values, count, &id));
    return id;
}

pls_shape_id verify_use_shape(const verify_scene *scene, const pls_shape_ops *ops, const pls_shape_input *input)
{
    pls_shape *shape;
    pls_shape_id id;
    char name[PLS_NAME_SIZE];
    free_name(scene, ops->name, name);
    MUST(pls_shape_make(ops, scene->dimension, input, name, &shape));
    MUST(pls_world_use_shape(scene->world, name, shape, &id));
    pls_shape_free(shape);
    return id;
}

static pls_shape_id use_shape(const verify_scene *scene, const char *name, const pls_shape_input *input)
{
    return verify_use_shape(scene, verify_shape(name), input);
}

pls_shape_id verify_add_prism(const verify_scene *scene, const pls_vec3 *points, size_t count, double height)
{
    const double values[] = {0.0, height};
    return use_shape(scene, "prism", &(pls_shape_input){VALUES(values), .points = points, .point_count = count});
}

pls_shape_id verify_add_mesh(const verify_scene *scene, const char *path)
{
    const double values[] = {0.0, 1.0}; // rounding, scale
    return use_shape(scene, "mesh", &(pls_shape_input){VALUES(values), .path = path});
}

pls_shape_id verify_add_hull(const verify_scene *scene, const pls_vec3 *points, size_t count)
{
    const double sharp[PLS_MAX_PARAMETERS] = {0};
    return use_shape(scene, scene->dimension == 3 ? "polyhedron" : "polygon",
                     &(pls_shape_input){VALUES(sharp), .points = points, .point_count = count});
}

pls_shape_id verify_add_dumbbell(const verify_scene *scene, double radius, double distance)
{
    pls_shape *ball;
    MUST(pls_shape_make(verify_shape("sphere"), scene->dimension, &(pls_shape_input){.values = &radius, .value_count = 1}, "ball", &ball));
    pls_shape_part parts[2];
    for (int k = 0; k < 2; ++k)
        parts[k] = (pls_shape_part){.shape = ball,
                                    .position = pls_vec(k == 0 ? -0.5 * distance : 0.5 * distance, 0.0, 0.0),
                                    .orientation = pls_quat_identity(),
                                    .scale = 1.0};
    const double none[PLS_MAX_PARAMETERS] = {0};
    pls_shape_id id = use_shape(scene, "compound", &(pls_shape_input){VALUES(none), .parts = parts, .part_count = 2});
    pls_shape_free(ball);
    return id;
}

void verify_set_faces(const verify_scene *scene, pls_faces faces, double area)
{
    pls_narrow_options options = pls_default_narrow_options();
    options.faces = faces;
    options.face_area = area;
    MUST(pls_world_set_narrow_options(scene->world, scene->grain, scene->grain, &options));
}

verify_scene verify_open(const pls_world_def *def, const char *law, const verify_value *values)
{
    verify_scene scene = {.dimension = def->dimension};
    MUST(pls_world_create(def, &scene.world));
    pls_material_def material = pls_default_material_def();
    strcpy(material.name, "grain");
    material.values.density = 1.0;
    MUST(pls_world_add_material(scene.world, &material, &scene.grain));
    scene.ball = add_shape(scene.world, "sphere", (const verify_value[]){{"radius", 1.0}, {NULL, 0.0}});
    scene.wall = add_shape(scene.world, "plane", NULL);
    if (law) verify_set_law(scene.world, scene.grain, scene.grain, law, values);
    return scene;
}

void verify_close(verify_scene *scene)
{
    pls_world_destroy(scene->world);
    scene->world = NULL;
}

pls_body_def verify_ball_def(const verify_scene *scene, double radius, double mass, pls_vec3 position, pls_vec3 velocity)
{
    pls_body_def def = pls_default_body_def();
    double inertia = (scene->dimension == 3 ? 0.4 : 0.5) * mass * radius * radius;
    def.shape = scene->ball;
    def.material = scene->grain;
    def.position = position;
    def.velocity = velocity;
    def.scale = radius;
    def.mass = mass;
    def.inertia = pls_vec(inertia, inertia, inertia);
    return def;
}

pls_body_def verify_body_def(const verify_scene *scene, pls_shape_id shape, pls_vec3 position)
{
    pls_body_def def = pls_default_body_def();
    def.shape = shape;
    def.material = scene->grain;
    def.position = position;
    return def;
}

pls_body_id verify_add(const verify_scene *scene, const pls_body_def *def)
{
    pls_body_id id;
    MUST(pls_world_add_body(scene->world, def, &id));
    return id;
}

pls_body_id verify_ball(const verify_scene *scene, double radius, double mass, pls_vec3 position, pls_vec3 velocity)
{
    pls_body_def def = verify_ball_def(scene, radius, mass, position, velocity);
    return verify_add(scene, &def);
}

// The shortest rotation that carries `from` to `to`, both of unit length.
static pls_quat shortest_rotation(pls_vec3 from, pls_vec3 to)
{
    pls_vec3 axis = pls_cross(from, to);
    double w = 1.0 + pls_dot(from, to);
    if (w < 1e-12) return (pls_quat){0.0, 1.0, 0.0, 0.0}; // opposite: half a turn about x, which is normal to y and z
    return pls_quat_unit((pls_quat){w, axis.x, axis.y, axis.z});
}

pls_body_id verify_wall(const verify_scene *scene, pls_vec3 point, pls_vec3 normal)
{
    pls_body_def def = pls_default_body_def();
    def.shape = scene->wall;
    def.material = scene->grain;
    def.position = point;
    def.orientation = shortest_rotation(scene->dimension == 3 ? pls_vec(0, 0, 1) : pls_vec(0, 1, 0), pls_unit(normal));
    if (scene->dimension == 2 && normal.y < 0.0 && normal.x == 0.0) def.orientation = (pls_quat){0.0, 0.0, 0.0, 1.0};
    def.motion.axes = PLS_AXIS_ALL;
    return verify_add(scene, &def);
}

pls_body_motion verify_motion(const pls_world *world, pls_body_id id)
{
    pls_body_motion motion;
    MUST(pls_body_get(world, id, &motion));
    return motion;
}

pls_world_figures verify_figures(pls_world *world)
{
    pls_world_figures figures;
    MUST(pls_world_get_figures(world, &figures));
    return figures;
}

double verify_total_energy(pls_world *world)
{
    pls_world_figures f = verify_figures(world);
    return f.energy_kinetic + f.energy_rotation + f.energy_normal + f.energy_shear + f.energy_potential + f.energy_damped + f.energy_slid +
           f.energy_bonds + f.energy_broken;
}

uint64_t verify_hash(pls_world *world)
{
    uint64_t hash = 0;
    MUST(pls_world_state_hash(world, &hash));
    return hash;
}

static pls_status evaluate_field(void *context, const pls_force_batch *b)
{
    const verify_field *field = context;
    for (size_t k = 0; k < b->count; ++k)
    {
        pls_vec3 force = {0}, torque = {0};
        if (isinf(b->mass[k])) continue;
        field->force(b->time, pls_vec(b->x[k], b->y[k], b->z[k]), pls_vec(b->vx[k], b->vy[k], b->vz[k]), b->body[k], &force, &torque);
        b->force_x[k] += force.x, b->force_y[k] += force.y, b->force_z[k] += force.z;
        b->torque_x[k] += torque.x, b->torque_y[k] += torque.y, b->torque_z[k] += torque.z;
    }
    return PLS_OK;
}

static double potential_of_field(void *context, const pls_force_body *body)
{
    return ((const verify_field *)context)->potential(body->position, body->mass);
}

void verify_add_field(pls_world *world, const verify_field *field)
{
    static const pls_force_ops plain = {
        .api_version = PLS_API_VERSION, .name = "test field", .meaning = "a field of force of a test", .evaluate = evaluate_field};
    static const pls_force_ops conservative = {.api_version = PLS_API_VERSION,
                                               .name = "test field",
                                               .meaning = "a field of force of a test",
                                               .evaluate = evaluate_field,
                                               .potential = potential_of_field};
    pls_force_def def = pls_default_force_def();
    def.ops = field->potential ? &conservative : &plain;
    def.context = (void *)(uintptr_t)field;
    pls_force_id id;
    MUST(pls_world_add_force(world, &def, &id));
}
