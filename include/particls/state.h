/// @file state.h
/// State objects: further ordinary differential equations s' = f(s, t) advanced with the bodies (P1 section 4.2.2).
///
/// Integrated with the midpoint rule (THEORY: P1 eq. 21 as printed is first order):  s(t+dt) = s(t) + dt f(s(t+dt/2), t+dt/2).
#ifndef PARTICLS_STATE_H
#define PARTICLS_STATE_H

#include <particls/status.h>
#include <particls/types.h>

#ifdef __cplusplus
extern "C" {
#endif

struct pls_world;

/// Most numbers in one state object.
#define PLS_STATE_MAX_COMPONENTS 16

/// Where and when a rate is asked for. Body quantities are those of the state's body at `time` (zero for a state without a body).
typedef struct pls_state_point
{
    double time;               ///< [s]
    pls_body_id body;          ///< null for a state of the world
    pls_vec3 position;         ///< [m]
    pls_vec3 velocity;         ///< [m/s]
    pls_vec3 angular_velocity; ///< [rad/s]
    double radius;             ///< bounding radius at the start of the step [m]
    const double *all;         ///< all state values at `time`, in order of creation (first stage: at t, second stage: at t + dt/2)
} pls_state_point;

typedef enum pls_state_target {
    PLS_STATE_FREE,   ///< nothing; read it through the API, expressions or `apply`
    PLS_STATE_SCALE,  ///< component 0 is the body's scale
    PLS_STATE_RADIUS, ///< component 0 is the body's bounding radius [m]: scale = s / radius of the unscaled shape
} pls_state_target;

/// Copy `pls_default_state_def()` and change what you need.
typedef struct pls_state_def
{
    char name[PLS_NAME_SIZE];                 ///< unique; used in expressions
    pls_body_id body;                         ///< its body, null: a state of the world
    int components;                           ///< 1 .. PLS_STATE_MAX_COMPONENTS
    double initial[PLS_STATE_MAX_COMPONENTS]; ///< value at the start
    pls_state_target target;
    bool keep_density; ///< when the scale changes: false keeps the mass (thermal expansion), true the density (growth)
    /// ds/dt into `rate`. A failure stops the run. Must not change the world.
    pls_status (*rate)(void *context, const pls_state_point *at, const double *values, double *rate);
    /// After each step (and once at the start): couple the new values to anything, for example `pls_world_set_law_parameter`. May be null.
    pls_status (*apply)(void *context, struct pls_world *world, const double *values);
    void (*destroy)(void *context); ///< releases `context`; may be null
    void *context;
    uint32_t cookie;
} pls_state_def;

pls_state_def pls_default_state_def(void);

#ifdef __cplusplus
}
#endif
#endif
