// world.h -- the inside of a world, for the step room and those below it.
#ifndef PLS_STEP_WORLD_H
#define PLS_STEP_WORLD_H

#include "bond/bond_set.h"
#include "contact/pair_list.h"
#include "contact/solid_contact.h"
#include "contact/sphere_contact.h"
#include "law/law_table.h"
#include "model/bodies.h"
#include "model/domain.h"
#include "step/skin_tuner.h"

#include <particls/world.h>

/// A shape by its name in this world.
typedef struct pls_shape_instance
{
    char name[PLS_NAME_SIZE];
    pls_shape *shape; ///< kept
} pls_shape_instance;

typedef struct pls_force_instance
{
    const pls_force_ops *ops;
    void *context;
    uint32_t group; ///< index1 of the bodies it acts on; 0: all
    double values[PLS_MAX_VALUES], constants[PLS_MAX_VALUES];
} pls_force_instance;

typedef struct pls_state_instance
{
    pls_state_def def;
    size_t first;                      ///< its first value in `values`
    pls_vec3 position, velocity, spin; ///< of its body before the drift
} pls_state_instance;

/// A parameter of a law or force, or a material's value, that follows a function of time and states.
typedef struct pls_binding
{
    pls_parameter_function *function;
    void *context;
    void (*destroy)(void *);
    pls_force_id force; ///< the force whose parameter follows; null: of a law or material
    uint16_t a, b;      ///< materials of the law; a: the material whose value follows, if `of_material`
    bool of_material;
    char name[PLS_NAME_SIZE];
} pls_binding;

/// A body advanced one by one: partly driven, driven by a function, or with three different moments.
typedef struct pls_special
{
    uint32_t row, number;
    pls_vec3 position, velocity, spin; ///< at the start of the step
    pls_quat orientation;
    pls_body_before before;
    pls_vec3 half_velocity;                ///< u of velocity_verlet_simd.c
    pls_vec3 half_spin;                    ///< the same of rotation; for anisotropic bodies the angular momentum
    pls_vec3 driven_velocity, driven_spin; ///< at the end of the step
} pls_special;

/// A contact that ended in this step, and the energy it still held [J].
struct pls_parted
{
    uint32_t number_i, number_j, part_i, part_j, image, row_i, row_j;
    double energy;
};

typedef struct pls_parted_list
{
    struct pls_parted *entry;
    size_t count, capacity;
} pls_parted_list;

/// Scratch to order them.
typedef struct pls_parted_order
{
    uint64_t *key;
    uint32_t *place; ///< in the list
    char *scratch;   ///< of the sort
    size_t capacity;
} pls_parted_order;

/// What is left of a thread's share of a step. A cache line each.
typedef struct pls_share_left
{
    _Alignas(64) uint64_t blocks; ///< of pairs that nobody has taken yet: first << 32 | one behind the last
    size_t first_group;           ///< where its groups that wait are listed
    size_t waiting, taken;        ///< such groups; those that somebody has taken to finish
} pls_share_left;

/// What relaxation sums over bodies, u being the velocity of the middle of the step: m u^2 and u . F.
struct pls_quotient
{
    double mass, power;
};

struct pls_world
{
    pls_world_def def;
    pls_domain domain;
    pls_bodies bodies;
    pls_law_table laws;
    pls_shape_instance *shape;
    size_t shape_count, shape_capacity;
    const pls_shape **shape_of; ///< the same by index alone
    size_t shape_of_capacity;
    char (*group)[PLS_NAME_SIZE];
    size_t group_count, group_capacity;
    pls_motion_def *motion;
    size_t motion_count, motion_capacity;
    pls_force_instance *force;
    size_t force_count, force_capacity;
    pls_state_instance *state;
    size_t state_count, state_capacity;
    double *state_value, *state_half, *state_rate; ///< values of all states; scratch
    size_t value_count, value_capacity;
    pls_binding *binding;
    size_t binding_count, binding_capacity;

    pls_bond_set *bond;
    size_t bond_count, bond_capacity;

    pls_pair_list list;
    pls_contact_memory memory; ///< filled when the list is about to change
    pls_solid_list solids;
    pls_solid_records records; ///< of solids, as `memory`
    bool memory_holds;         ///< `memory` and `records`, not the lists, have the contacts (between a change of bodies and the next list)
    pls_contact_work *work;    ///< one per thread
    pls_parted_list *parted;   ///< contacts that ended in this step, one list per thread
    pls_parted_order parted_order;
    pls_share_left *left; ///< one per thread
    int work_count;
    pls_skin_tuner tuner;
    pls_special *special;
    size_t special_count, special_capacity;
    bool special_stale;

    double dt;     ///< 0 until chosen
    uint64_t step; ///< steps done
    double time;   ///< step * dt
    bool prepared;
    double power_before; ///< of relaxation, within a step: power of the forces of its beginning on the velocities of its middle [W]
    double path;         ///< bound on how much two bodies can have come nearer in all steps [m]
    double overlap_due;  ///< length of the path from which an overlap may be too large [m]
    double lost_due;     ///< likewise, from which a body may be lost [m]
    double extent;       ///< size of the first arrangement [m], for lost bodies; 0 until measured
    pls_vec3 centre;     ///< of the first arrangement [m]
    struct pls_quotient *quotient; ///< scratch of relaxation, per block of bodies
    size_t quotient_capacity;
    struct pls_derived *derived; ///< fields that nobody keeps, while somebody looks at them
    void *persisting;            ///< contact table while persist.c reads it
};

// motion.c
/// Give driven bodies their velocities of now.
pls_status pls_special_start(pls_world *world);
pls_status pls_special_before(pls_world *world);
pls_status pls_special_drift(pls_world *world);
void pls_special_finish(pls_world *world);
pls_status pls_find_specials(pls_world *world);
/// Bodies have other rows now: what the step under way keeps of special ones stays.
void pls_follow_specials(pls_world *world);

// state_rk2.c
void pls_states_before(pls_world *world);
pls_status pls_states_advance(pls_world *world);
pls_status pls_states_apply(pls_world *world);

// neighbours.c
/// Note how far bodies may have moved in this step.
void pls_neighbours_moved(pls_world *world, double largest_square);
/// Note by how much [m] a body, at most, went further in this step than was noted.
void pls_neighbours_carried(pls_world *world, double further);
/// Nobody has moved so far that the list would have to be looked at.
bool pls_neighbours_hold(const pls_world *world);
pls_status pls_neighbours_refresh(pls_world *world);
/// Move what contacts remember out of the list, before bodies, laws or rows change.
pls_status pls_neighbours_detach(pls_world *world);

// parting.c
/// Note what the springs of contacts of a block that ended in this step still hold, before their bodies are finished.
pls_status pls_find_parted(const pls_world *world, const pls_pair_block *block, pls_parted_list *found);
pls_status pls_find_parted_solids(const pls_world *world, const pls_contact_input *input, const pls_solid_block *block,
                                  pls_parted_list *found);
/// Book what was found.
pls_status pls_book_parted(pls_world *world);
void pls_parted_free(pls_world *world);

// step.c
/// What contact loops read of the world as it is.
pls_contact_input pls_contact_input_of(const pls_world *world, double dt);
/// Size and centre of the arrangement of now.
pls_status pls_measure_extent(pls_world *world);
/// Go on stepping from a restored state, without computing forces anew.
pls_status pls_world_resume(pls_world *world);

// forces.c
pls_status pls_body_forces(const pls_world *world, size_t first, size_t last, double time, double *scratch, double *force, double *torque);
/// Place of a force's parameter among its values. NOT_FOUND names what is wrong.
pls_status pls_find_force_parameter(const pls_world *world, pls_force_id force, const char *name, int *place);
/// Potential energy of the body in row `row` of `bodies` in all forces of the world that have one [J].
double pls_force_potential(const pls_world *world, const pls_bodies *bodies, uint32_t row);
enum { PLS_FORCE_SCRATCH = (11 + 6) * PLS_FORCE_BATCH }; ///< doubles: what forces read and what they give

// damping.c
/// Whether motion is damped; forces and velocities of each step's end are looked at then.
bool pls_damps(const pls_world *world);
/// Local damping of the forces that the step has found, before special bodies are finished; relaxation of the velocities of its end.
void pls_damp_locally(pls_world *world);
pls_status pls_relax(pls_world *world);
/// At the beginning of the step: what relaxation asks of the forces then.
pls_status pls_relax_before(pls_world *world);

// guard.c
pls_status pls_guard_finite(pls_world *world);
pls_status pls_guard_overlap(pls_world *world);
pls_status pls_guard_step(pls_world *world);
/// Whether a look could find anything where bodies are now.
bool pls_guard_is_due(const pls_world *world);

/// Scale a body: radius, and mass and inertia if it keeps its density. NaN or not positive: INVALID_ARGUMENT.
pls_status pls_body_rescale(pls_world *world, uint32_t row, double scale, bool keep_density);
/// Row of a body, PLS_NO_ROW if the id is stale.
uint32_t pls_body_row(const pls_world *world, pls_body_id id);

#endif
