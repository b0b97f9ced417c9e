/// @file observe.h
/// Observers: what a run measures, when, and of whom (P1 section 4.3).
#ifndef PARTICLS_OBSERVE_H
#define PARTICLS_OBSERVE_H

#include <particls/world.h>

#ifdef __cplusplus
extern "C" {
#endif

/// When an observer looks: every `every` seconds or every `every_steps` steps (one of the two is zero), from `start` to `end`. Time schedules fire at the
/// first step at or after k * every. The first look is at the start.
typedef struct pls_schedule
{
    double every;         ///< [s]
    uint64_t every_steps; ///< steps
    double start, end;    ///< [s]; 0 and infinity by default
} pls_schedule;

/// What a collection observer can measure.
enum {
    PLS_MEASURE_STRESS = 1,       ///< Cauchy stress, P1 eq. 24 with each pair once, tension positive [Pa]
    PLS_MEASURE_TANGENT = 2,      ///< tangent operator D, P1 eq. 29, all components [Pa]
    PLS_MEASURE_FABRIC = 4,       ///< mean of n (x) n over contacts
    PLS_MEASURE_COORDINATION = 8, ///< contacts per body, touching contacts
    PLS_MEASURE_ENERGY = 16,      ///< energies by kind [J]
    PLS_MEASURE_MOMENTUM = 32,    ///< linear and angular momentum
    PLS_MEASURE_POROSITY = 64,    ///< 1 - solid volume / volume
    PLS_MEASURE_MASS = 128,       ///< number and mass of the bodies [kg]
    PLS_MEASURE_FRAGMENTS = 256   ///< what bonds hold together
};

typedef enum pls_volume_kind {
    PLS_VOLUME_BOUNDING_BOX, ///< smallest axis-aligned box that holds the bounded bodies of the collection (P1)
    PLS_VOLUME_BOX,          ///< the box `lower`..`upper`
    PLS_VOLUME_PERIODIC,     ///< the periodic box (bounding box along other axes)
    PLS_VOLUME_VALUE         ///< `volume`
} pls_volume_kind;

/// A collection: the bodies it holds, the volume it is averaged over and what is measured.
typedef struct pls_collection_def
{
    unsigned quantities;       ///< PLS_MEASURE_ bits
    char group[PLS_NAME_SIZE]; ///< only bodies of this group; "" or "all": all
    pls_volume_kind volume_kind;
    double volume;         ///< [m^3], 2D [m^2] times thickness; for PLS_VOLUME_VALUE
    pls_vec3 lower, upper; ///< for PLS_VOLUME_BOX [m]: bodies with their centre inside, contacts with their point inside
    bool include_walls;    ///< count contacts with unbounded bodies in stress, tangent and fabric; true by default (P1)
} pls_collection_def;

/// Bodies that bonds hold together, over any number of others; bodies without families belong to none, those whose bonds are all broken are one each.
typedef struct pls_fragments
{
    uint64_t count;    ///< that have a body of the collection
    uint64_t single;   ///< of one body
    uint64_t bodies;   ///< of the largest
    double largest;    ///< its mass [kg]; the largest is that of the largest mass, of equal ones that with the lowest number
    double second;     ///< mass of the second largest, 0: there is one at most [kg]
    double mean;       ///< mass of all by their number [kg]
    pls_vec3 momentum; ///< of the largest [kg m/s]
} pls_fragments;

/// What was measured. Components that do not exist in 2D are zero.
typedef struct pls_collection
{
    double volume;              ///< [m^3]
    double stress[3][3];        ///< [Pa]
    double tangent[3][3][3][3]; ///< [Pa]
    double fabric[3][3];
    double coordination; ///< mean number of contacts of a bounded body
    uint64_t contacts;
    double energy_kinetic, energy_rotation, energy_normal, energy_shear, energy_potential, energy_damped, energy_slid; ///< [J]
    double energy_bonds, energy_broken; ///< of the bodies' families: stored in bonds; what bonds held when they broke [J]
    pls_vec3 momentum, angular_momentum;
    double porosity;
    uint64_t bodies; ///< bounded ones
    double mass;     ///< of those that have one: fixed and driven bodies have none [kg]
    pls_fragments fragments;
} pls_collection;

pls_collection_def pls_default_collection_def(void);
/// Measure now. Sums are in order of ids: the same bits for any number of threads.
pls_status pls_measure_collection(const pls_world *world, const pls_collection_def *def, pls_collection *out);

/// A tracked body or group: columns for each named quantity (any body field of the field table: "position", "velocity", "orientation",
/// "angular_velocity", "force", "torque", "scale", ...) of each body.
typedef struct pls_particle_def
{
    char group[PLS_NAME_SIZE]; ///< its entry's name, "" or "all": all; every body of the group is tracked
    int quantity_count;
    char quantities[16][PLS_NAME_SIZE];
} pls_particle_def;

typedef enum pls_observer_kind {
    PLS_OBSERVE_PARTICLE,
    PLS_OBSERVE_COLLECTION,
    PLS_OBSERVE_FRAMES,
    PLS_OBSERVE_CHECKPOINT,
    PLS_OBSERVE_USER, ///< a function that is called and may do what it likes but change the world
    PLS_OBSERVE_OWN   ///< a series of one's own: `pls_observer_ops`
} pls_observer_kind;

/// Fields written to frames: the default set of the field table plus `fields`; contacts as lines if `contacts`.
typedef struct pls_frames_def
{
    bool contacts;
    int field_count;
    char fields[16][PLS_NAME_SIZE];
} pls_frames_def;

/// Most numbers an observer of one's own may keep from look to look.
#define PLS_OBSERVER_MAX_MEMORY 64

/// What an observer of one's own is shown: the world after a step, by all functions that take a `const pls_world *`.
typedef struct pls_observer_view
{
    const pls_world *world;
    const double *constants; ///< what `prepare` made of the parameters
    pls_group_id group;      ///< the bodies to look at; null: all (see pls_world_next_body)
    int dimension;
} pls_observer_view;

/// A column of its series.
typedef struct pls_observer_column
{
    const char *name;    ///< "temperature"; letters, digits, '_', '.' and '-'
    const char *unit;    ///< "m^2/s^2"; "" for pure numbers
    const char *meaning; ///< one line for the docs
    bool only_3d;        ///< left out of series in 2D; `look` fills it all the same
} pls_observer_column;

/// Operations of an observer with a series of its own. They keep nothing: what must be remembered from look to look lies in `memory`, which the run keeps and
/// checkpoints, so that a run that is resumed writes the same rows.
typedef struct pls_observer_ops
{
    uint32_t api_version;               ///< PLS_API_VERSION
    const char *name;                   ///< the scene key
    const char *meaning;                ///< one line for the docs
    const pls_parameter *parameters;    ///< numbers and vectors; null: none
    const pls_observer_column *columns; ///< ends with a null name
    int memory;                         ///< numbers kept from look to look, all zero before the first
    /// Check what the table cannot and turn parameters into constants, at most PLS_MAX_VALUES. Null: the constants are the parameters.
    pls_status (*prepare)(const double *values, int dimension, double *constants);
    /// Take note of the world in `memory`; called once at each look that is due. Null without memory.
    pls_status (*update)(const pls_observer_view *view, double *memory);
    /// Fill `row`, a value per column. Called after `update`, and once more for summary.json at the end: it must depend on `view` and `memory` alone.
    pls_status (*look)(const pls_observer_view *view, const double *memory, double *row);
} pls_observer_ops;

/// An observer of one's own with its numbers.
typedef struct pls_own_def
{
    const pls_observer_ops *ops; ///< must outlive the run
    char group[PLS_NAME_SIZE];   ///< only bodies of this group; "" or "all": all
    bool given;                  ///< `values` are given; else all defaults
    double values[PLS_MAX_VALUES];
} pls_own_def;

/// One observer of a run.
typedef struct pls_observer_def
{
    char name[PLS_NAME_SIZE]; ///< names its file series/<name>.csv; unique in the run
    pls_observer_kind kind;
    pls_schedule schedule;
    pls_particle_def particle;
    pls_collection_def collection;
    pls_frames_def frames;
    pls_own_def own;
    /// PLS_OBSERVE_USER: called with the world after the step. Must not change the world. A failure stops the run.
    pls_status (*function)(void *context, pls_world *world);
    void *context;
} pls_observer_def;

/// True when the schedule fires at this step (time t, step length dt).
bool pls_schedule_due(const pls_schedule *schedule, uint64_t step, double time, double dt);

#ifdef __cplusplus
}
#endif
#endif
