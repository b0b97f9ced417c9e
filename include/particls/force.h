/// @file force.h
/// Body forces: gravity, fields given by expressions, a user's own. A force is one C file; see docs/extending.md.
#ifndef PARTICLS_FORCE_H
#define PARTICLS_FORCE_H

#include <particls/parameter.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Most bodies in one batch.
#define PLS_FORCE_BATCH 1024

/// A batch of bodies. Arrays hold `count` values. Forces and torques are added to what is there. Velocities are those of the same instant as
/// positions, predicted to second order. May be called from several threads at once, for different bodies; how bodies are divided into batches has no
/// meaning, so each must be treated by itself. What is added to unbounded bodies, and in 2D along z and about x and y, is dropped.
typedef struct pls_force_batch
{
    size_t count;
    double time;                            ///< [s]
    const double *constants;                ///< what `prepare` made of the parameters
    const double *x, *y, *z;                ///< centre of mass [m]
    const double *vx, *vy, *vz;             ///< [m/s]
    const double *wx, *wy, *wz;             ///< [rad/s]
    const double *mass;                     ///< [kg], infinite for unbounded bodies
    const double *radius;                   ///< bounding radius [m]
    const uint32_t *body;                   ///< persistent number
    const uint32_t *group;                  ///< group id's index1
    double *force_x, *force_y, *force_z;    ///< [N]
    double *torque_x, *torque_y, *torque_z; ///< [N m]
} pls_force_batch;

/// One body, for the scalar question.
typedef struct pls_force_body
{
    double time; ///< [s]
    const double *constants;
    pls_vec3 position;    ///< centre of mass [m]
    double mass, radius;  ///< [kg], [m]
    uint32_t body, group; ///< persistent number, group id's index1
} pls_force_body;

/// Operations of a force. They keep nothing: numbers come from the table of parameters, and what changes in time is a state of the world that a parameter follows.
typedef struct pls_force_ops
{
    uint32_t api_version;            ///< PLS_API_VERSION
    const char *name;                ///< the scene key
    const char *meaning;             ///< one line for the docs
    const pls_parameter *parameters; ///< numbers and vectors; null: none
    /// Check what the table cannot and turn parameters into constants, at most PLS_MAX_VALUES. Called again when a parameter changes in time.
    /// Null: the constants are the parameters.
    pls_status (*prepare)(const double *values, int dimension, double *constants);
    /// Add forces. A failure stops the run with its message.
    pls_status (*evaluate)(void *context, const pls_force_batch *batch);
    /// Potential energy of one body [J], or null when there is none.
    double (*potential)(void *context, const pls_force_body *body);
    /// Release `context`; null when there is nothing to release.
    void (*destroy)(void *context);
} pls_force_ops;

/// A force in a world. Copy `pls_default_force_def()` and change what you need; `values` are copied.
typedef struct pls_force_def
{
    const pls_force_ops *ops; ///< required; must outlive the world
    const double *values;     ///< its parameters in order of its table; null: all defaults
    pls_group_id group;       ///< the bodies it acts on; null: all
    void *context;            ///< handed to the operations of a C program; null in scenes. Owned by the world
    uint32_t cookie;
} pls_force_def;

pls_force_def pls_default_force_def(void);

#ifdef __cplusplus
}
#endif
#endif
