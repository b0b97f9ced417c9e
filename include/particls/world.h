/// @file world.h
/// The world: shapes, materials, bodies, laws, forces and states, and the step that advances them.
///
///     pls_world_def def = pls_default_world_def(3);
///     pls_world *world;
///     pls_world_create(&def, &world);
///     pls_world_add_shape(...); pls_world_add_material(...); pls_world_set_law(...); pls_world_add_body(...);
///     pls_world_prepare(world);
///     pls_world_run(world, 1000);
///     pls_world_destroy(world);
///
/// A world is used by one thread at a time; it uses OpenMP threads itself (<particls/threads.h>). The same sequence of calls gives the
/// same bits on any number of threads.
#ifndef PARTICLS_WORLD_H
#define PARTICLS_WORLD_H

#include <particls/bond.h>
#include <particls/contact.h>
#include <particls/field.h>
#include <particls/force.h>
#include <particls/law.h>
#include <particls/shape.h>
#include <particls/state.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pls_world pls_world;

/// What the world is. Copy `pls_default_world_def()` and change what you need.
typedef struct pls_world_def
{
    int dimension;         ///< 2 or 3; 2: the x-y plane
    double thickness;      ///< 2D: depth of bodies in z [m], 1 by default
    bool periodic[3];      ///< axes along which the box repeats
    pls_vec3 lower, upper; ///< the periodic box at t = 0 [m]; only periodic axes matter
    pls_vec3 stretch_rate; ///< relative rate of change of each periodic edge [1/s]: L(t) = L(0) (1 + rate t), about `lower`
    double dt;             ///< time step [s]; 0: chosen by the estimate of the stable step
    double safety;         ///< fraction of the stable step that `dt` = 0 takes, 0.5 by default
    bool allow_unstable;   ///< accept a step larger than the estimate
    int coordination;      ///< contacts per body assumed by the estimate before they exist, 12 (2D: 6) by default
    double skin;           ///< Verlet skin [m]; 0: tunes itself. Never changes results
    bool reorder;          ///< keep bodies in memory along a space-filling curve, true by default. Never changes results
    double local_damping;  ///< part of each force that works against the motion, 0 <= . < 1 (Cundall 1987); 0 by default
    bool relaxation; ///< adaptive dynamic relaxation: velocities decay critically (Underwood 1983; Kilic and Madenci 2010); not by default
    double max_overlap; ///< stop when an overlap exceeds this fraction of the smaller radius, 1 by default
    uint32_t cookie;
} pls_world_def;

/// A material. NaN: not given.
typedef struct pls_material_def
{
    char name[PLS_NAME_SIZE];
    pls_material_values values;
    uint32_t cookie;
} pls_material_def;

/// Degrees of freedom, for prescribed motion. World axes.
enum { PLS_AXIS_X = 1, PLS_AXIS_Y = 2, PLS_AXIS_Z = 4, PLS_AXIS_RX = 8, PLS_AXIS_RY = 16, PLS_AXIS_RZ = 32, PLS_AXIS_ALL = 63 };

/// Motion of a driven body: axes in `axes` follow the given velocities, the others obey forces. A fixed body has axes = PLS_AXIS_ALL and zero velocities.
typedef struct pls_motion_def
{
    unsigned axes;             ///< PLS_AXIS_ bits that are prescribed
    pls_vec3 velocity;         ///< [m/s]
    pls_vec3 angular_velocity; ///< [rad/s]
    bool about;                ///< the rotation also carries the body about the point `centre`
    pls_vec3 centre;           ///< [m]
    /// Velocities at `time` in place of the constants above; null if constant. Positions follow by the midpoint rule.
    pls_status (*function)(void *context, double time, pls_vec3 *velocity, pls_vec3 *angular_velocity);
    void (*destroy)(void *context);
    void *context;
} pls_motion_def;

/// A rigid body. Copy `pls_default_body_def()` and change what you need; the world copies it.
typedef struct pls_body_def
{
    pls_shape_id shape;       ///< required
    pls_material_id material; ///< required
    pls_group_id group;       ///< the entry it belongs to; null: the unnamed group
    pls_vec3 position;        ///< centre of mass [m]
    pls_quat
        orientation; ///< grain frame to world, unit. A plane's normal is its z axis (2D: y axis). Of other shapes the frame is that of the principal axes (pls_shape.principal)
    pls_vec3 velocity;         ///< [m/s]
    pls_vec3 angular_velocity; ///< [rad/s], world frame
    double scale;              ///< multiplies the shape's lengths, 1 by default
    double mass;               ///< [kg]; NaN (default): from the shape and the material's density
    pls_vec3 inertia;          ///< principal moments [kg m^2]; NaN (default): from the shape and the density
    pls_motion_def motion;     ///< free by default
    uint32_t cookie;           ///< set by pls_default_body_def()
} pls_body_def;

pls_world_def pls_default_world_def(int dimension);
pls_material_def pls_default_material_def(void);
pls_body_def pls_default_body_def(void);

pls_status pls_world_create(const pls_world_def *def, pls_world **world);
/// Null is fine.
void pls_world_destroy(pls_world *world);

/// @name Building
/// All of these may also be called between steps. `values` holds the parameters of `ops` in order of its table; null: all defaults. For a shape `value_count` says
/// how many there are; too few are refused (INVALID_ARGUMENT).
/// @{
pls_status pls_world_add_shape(pls_world *world, const char *name, const pls_shape_ops *ops, const double *values, size_t value_count,
                               pls_shape_id *id);
/// A shape that is made already; the world keeps it, the caller still frees its own hold.
pls_status pls_world_use_shape(pls_world *world, const char *name, pls_shape *shape, pls_shape_id *id);
pls_status pls_world_add_material(pls_world *world, const pls_material_def *def, pls_material_id *id);
pls_status pls_world_add_group(pls_world *world, const char *name, pls_group_id *id);
/// The law between two materials (either order). Replaces an earlier one; contacts then begin anew.
pls_status pls_world_set_law(pls_world *world, pls_material_id a, pls_material_id b, const pls_law_ops *ops, const double *values);
/// Levers of a contact's velocities. False (default): both bodies' velocities are taken at the one contact point c = (x1 + x2)/2, where the force acts, so that
/// work and torque match and energy is booked exactly. True: each at its own surface point, x1 and x2 (P1 eq. 15b), and against a wall the torque too: what
/// LAMMPS's granular styles do. The two differ by terms of the overlap over the radius.
pls_status pls_world_set_lever_at_surface(pls_world *world, pls_material_id a, pls_material_id b, bool at_surface);
/// How contacts of bodies that are not spheres are found (contact.h). INVALID_ARGUMENT for options that do not fit together.
pls_status pls_world_set_narrow_options(pls_world *world, pls_material_id a, pls_material_id b, const pls_narrow_options *options);
/// Change one parameter of the law between two materials; springs stay.
pls_status pls_world_set_law_parameter(pls_world *world, pls_material_id a, pls_material_id b, const char *name, double value);
/// Change a value of a material ("density", "young_modulus", "poisson_ratio"); laws are prepared anew. Masses of bodies do not change.
pls_status pls_world_set_material_value(pls_world *world, pls_material_id material, const char *name, double value);
/// Room for `count` more bodies, so that adding them allocates once.
pls_status pls_world_reserve_bodies(pls_world *world, size_t count);
pls_status pls_world_add_body(pls_world *world, const pls_body_def *def, pls_body_id *id);
/// Take a body out. Its number may be used again with a new generation. STALE_ID if it is gone already.
pls_status pls_world_remove_body(pls_world *world, pls_body_id id);
/// A body force. The world owns `def->context` from here on (ops->destroy), also when this fails.
pls_status pls_world_add_force(pls_world *world, const pls_force_def *def, pls_force_id *id);
/// Change one parameter of a force.
pls_status pls_world_set_force_parameter(pls_world *world, pls_force_id force, const char *name, double value);
/// Uniform gravity [m/s^2].
pls_status pls_world_add_gravity(pls_world *world, pls_vec3 gravity);
/// The world owns `def->context` from here on, also when this fails.
pls_status pls_world_add_state(pls_world *world, const pls_state_def *def, pls_state_id *id);
/// A function of time and states that gives a law parameter, evaluated before forces at each step. The world owns `context`.
typedef pls_status pls_parameter_function(void *context, double time, const double *states, double *value);
pls_status pls_world_bind_law_parameter(pls_world *world, pls_material_id a, pls_material_id b, const char *name,
                                        pls_parameter_function *function, void *context, void (*destroy)(void *));
/// The same for a parameter of a force.
pls_status pls_world_bind_force_parameter(pls_world *world, pls_force_id force, const char *name, pls_parameter_function *function,
                                          void *context, void (*destroy)(void *));
/// The same for a material's value.
pls_status pls_world_bind_material_value(pls_world *world, pls_material_id material, const char *name, pls_parameter_function *function,
                                         void *context, void (*destroy)(void *));
/// @}

/// @name Stepping
/// @{
/// Check the whole, choose or check dt, find contacts and forces at the start. Called by the first step if not before. UNSTABLE_STEP if dt is too large.
pls_status pls_world_prepare(pls_world *world);
/// One time step.
pls_status pls_step(pls_world *world);
/// `steps` steps; stops at the first failure.
pls_status pls_world_run(pls_world *world, uint64_t steps);

/// Estimate of the stable step [s] with what limits it.
typedef struct pls_step_estimate
{
    double dt;           ///< largest stable step, infinity when nothing limits it
    double stiffness;    ///< largest eigenvalue bound of M^-1 K [1/s^2] at the limiting body
    double damping;      ///< of M^-1 C [1/s] at the limiting body
    uint32_t body;       ///< persistent number of the limiting body
    int contacts;        ///< contacts counted at that body
    bool damping_limits; ///< the dashpots, not the springs, set the limit
    double bonds;        ///< of `stiffness`, that of the limiting body's bonds [1/s^2]
} pls_step_estimate;
pls_status pls_world_stable_step(pls_world *world, pls_step_estimate *estimate);
/// @}

/// @name Asking
/// @{
double pls_world_time(const pls_world *world);
uint64_t pls_world_step_number(const pls_world *world);
double pls_world_dt(const pls_world *world);
int pls_world_dimension(const pls_world *world);
size_t pls_world_body_count(const pls_world *world);
/// Touching contacts after the last step.
size_t pls_world_contact_count(const pls_world *world);
/// 64-bit hash of all persistent fields in order of ids, time and step.
pls_status pls_world_state_hash(pls_world *world, uint64_t *hash);
/// Memory row of each persistent number, UINT32_MAX where the body was removed; `*count` numbers. Valid until the next step or change of the world.
const uint32_t *pls_world_rows_by_number(const pls_world *world, size_t *count);

typedef struct pls_body_motion
{
    pls_vec3 position, velocity, angular_velocity; ///< [m], [m/s], [rad/s]
    pls_quat orientation;
    pls_vec3 force, torque; ///< of the last step, contacts and body forces [N], [N m]
    double scale, radius, mass;
} pls_body_motion;
/// STALE_ID if it is gone.
pls_status pls_body_get(const pls_world *world, pls_body_id id, pls_body_motion *motion);
/// The bodies of a group (null: all) one after the other in order of their numbers: begin with a null id; behind the last comes a null id.
///     for (id = pls_world_next_body(w, g, (pls_body_id){0}); id.index1; id = pls_world_next_body(w, g, id)) ...
pls_body_id pls_world_next_body(const pls_world *world, pls_group_id group, pls_body_id previous);
/// INVALID_ARGUMENT for what is not finite, and in 2D for velocities out of the x-y plane or rotations not about z.
pls_status pls_body_set_velocity(pls_world *world, pls_body_id id, pls_vec3 velocity, pls_vec3 angular_velocity);
pls_status pls_state_get(const pls_world *world, pls_state_id id, double *values);
/// INVALID_ARGUMENT for what is not finite.
pls_status pls_state_set(pls_world *world, pls_state_id id, const double *values);
/// Null ids when there is none of that name.
pls_group_id pls_world_find_group(const pls_world *world, const char *name);
pls_material_id pls_world_find_material(const pls_world *world, const char *name);
pls_shape_id pls_world_find_shape(const pls_world *world, const char *name);
pls_state_id pls_world_find_state(const pls_world *world, const char *name);
const char *pls_world_group_name(const pls_world *world, pls_group_id id);

/// Memory and list figures.
typedef struct pls_world_figures
{
    size_t bodies, touching, listed;                                                       ///< bodies, touching contacts, pairs in the list
    size_t body_bytes, contact_bytes;                                                      ///< held by per-body and by per-pair arrays
    uint64_t list_builds;                                                                  ///< times the pair list was made
    double skin;                                                                           ///< now [m]
    double energy_kinetic, energy_rotation, energy_normal, energy_shear, energy_potential; ///< [J]
    double energy_damped, energy_slid;   ///< dissipated since the start by dashpots and by sliding [J]
    pls_vec3 momentum, angular_momentum; ///< of bodies with mass, angular about the origin [kg m/s], [kg m^2/s]
    double energy_bonds, energy_broken;  ///< stored in bonds; what bonds held when they broke [J]
    size_t bonds, bonds_broken;          ///< pairs of bodies that a bond joins or joined; those where it is broken
    size_t bond_bytes;                   ///< held by bonds
} pls_world_figures;

/// Counts of contact detection between bodies that are not spheres, since the first step.
pls_narrow_counts pls_world_narrow_counts(const pls_world *world);
pls_status pls_world_get_figures(const pls_world *world, pls_world_figures *figures);
/// @}

/// Built-in operations by name; null when there is none. Lists end with null.
const pls_shape_ops *const *pls_builtin_shapes(void);
const pls_law_ops *const *pls_builtin_laws(void);

#ifdef __cplusplus
}
#endif
#endif
