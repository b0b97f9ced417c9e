// build.h -- from a scene to a world: what build.c, build_bodies.c and build_formulas.c share.
#ifndef PLS_SCENE_BUILD_H
#define PLS_SCENE_BUILD_H

#include "scene/generators.h"
#include "scene/schema.h"

/// While a world is built. Arrays run over the entries of the scene's lists.
typedef struct pls_builder
{
    const pls_scene *scene;
    pls_world *world;
    pls_points *points;     ///< of each body entry
    size_t *first_body;     ///< place of each entry's first body in `ids`
    pls_body_id *ids;       ///< all bodies
    size_t total;           ///< bodies
    size_t *first_state;    ///< place of each states entry in the world's array of state values
    size_t *state_counts;   ///< states of each entry: 1, or as many as bodies with `each`
    double *initial_states; ///< values at t = 0
    size_t total_states;
    pls_material_id *materials;
    pls_shape_id *shapes;
    pls_group_id *groups;
} pls_builder;

/// build_bodies.c
pls_status pls_build_bodies(pls_builder *b);
/// Density of an entry's material at the start [kg/m^3]; NaN: not given.
pls_status pls_build_density(const pls_builder *b, size_t entry, double *density);
/// Body of a state: the index within its entry, checked.
pls_status pls_build_state_body(const pls_builder *b, const pls_scene_state *state, size_t copy, size_t *index);

/// build_bonds.c
pls_status pls_build_bonds(const pls_builder *b);
/// build_forces.c
pls_status pls_build_forces(const pls_builder *b);
/// build_points.c: what an entry of bonds says of its points by expressions. The definition's user is the world's from pls_world_add_bonds on.
pls_status pls_build_points(const pls_builder *b, const pls_node *bonds, pls_bonds_def *def);

/// build_formulas.c: functions of time, place and states for the world to call, and their contexts.
/// Value of a node over t and states at t = 0 (a plain number is itself), checked against the range of `key`.
pls_status pls_build_initial_value(const pls_builder *b, const pls_key *key, const pls_node *node, double *value);
/// Bind a formula over t and states to a material's value, or to the parameter of the law between two materials.
pls_status pls_build_bind_material(const pls_builder *b, pls_material_id material, const pls_key *key, const pls_node *node);
pls_status pls_build_bind_law(const pls_builder *b, pls_material_id i, pls_material_id j, const pls_key *key, const pls_node *node);
pls_status pls_build_bind_force(const pls_builder *b, pls_force_id force, const pls_key *key, const pls_node *node);
/// Do something for each number of a table of parameters that the scene gives by a formula. `key` is named as the parameter, "wind[1]" for the component of a
/// vector, and `place` is its place among the values.
typedef pls_status pls_build_action(const pls_builder *b, const pls_key *key, const pls_node *node, size_t place, void *context);
pls_status pls_build_each_formula(const pls_builder *b, const pls_parameter *table, const pls_node *map, pls_build_action *action,
                                  void *context);
/// Values of a table of parameters at t = 0.
pls_status pls_build_initial_values(const pls_builder *b, const pls_parameter *table, const pls_node *map, double *values);
/// The motion of an entry's bodies over time. One formula serves all bodies of the entry, each body has its own context.
pls_status pls_build_motion_formula(const pls_builder *b, const pls_node *motion, pls_formula **formula);
pls_status pls_build_motion_context(const pls_builder *b, const pls_node *motion, pls_formula *formula, pls_motion_def *def);
pls_status pls_build_states(const pls_builder *b);

/// The text of the k-th component of a vector (or of a scalar, k = 0) for a formula: numbers are written into `number`, words and missing
/// ones give null.
const char *pls_build_component(const pls_node *vector, size_t k, char number[32]);

#endif
