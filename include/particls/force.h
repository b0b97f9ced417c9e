/// @file force.h
/// Body forces: gravity, fields given by expressions, a user's function.
#ifndef PARTICLS_FORCE_H
#define PARTICLS_FORCE_H

#include <particls/parameter.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Most bodies in one batch.
#define PLS_FORCE_BATCH 1024

/// A batch of bodies. Arrays hold `count` values. Forces and torques are added to what is there. Velocities are those of the same instant as
/// positions, predicted to second order. May be called from several threads at once, for different bodies.
typedef struct pls_force_batch
{
    size_t count;
    double time;                            ///< [s]
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

typedef struct pls_force_ops
{
    uint32_t api_version; ///< PLS_API_VERSION
    const char *name;
    const char *meaning;
    /// Add forces. A failure stops the run with its message.
    pls_status (*evaluate)(void *context, const pls_force_batch *batch);
    /// Potential energy of one body [J], or null when there is none.
    double (*potential)(void *context, double time, pls_vec3 position, double mass);
    /// Release `context`; null when there is nothing to release.
    void (*destroy)(void *context);
} pls_force_ops;

#ifdef __cplusplus
}
#endif
#endif
