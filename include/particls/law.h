/// @file law.h
/// Contact laws: from overlap, relative velocity and a tangential spring to a force. A law is one C file; see docs/extending.md.
#ifndef PARTICLS_LAW_H
#define PARTICLS_LAW_H

#include <particls/parameter.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Most constants a law may prepare from its parameters and the two materials.
#define PLS_LAW_MAX_CONSTANTS 32
/// Most extra numbers a law may keep per contact besides the tangential spring.
#define PLS_LAW_MAX_HISTORY 5

/// What a law may know of a material. Values the scene does not give are NaN.
typedef struct pls_material_values
{
    double density;       ///< [kg/m^3], 2D too: per volume, times the world's thickness
    double young_modulus; ///< E [Pa]
    double poisson_ratio; ///< nu
} pls_material_values;

/// A batch of touching contacts. All arrays hold `count` values, are 64-byte aligned and do not overlap; `count` is a multiple of 8, at most
/// PLS_LAW_BATCH, and padding lanes hold harmless values, so that one plain loop over 0..count, without branches on other lanes, is right and vectorises.
/// n points from body i to body j.
/// Where faces touch over an area, slip velocity, spring and shear force have a part along n, too: that of turning about the normal, at the radius where it slips. A law that
/// treats the three components alike, by their length, answers for sliding and turning together.
#define PLS_LAW_BATCH 128
typedef struct pls_law_batch
{
    size_t count;
    double dt;                                                         ///< [s]
    const double *constants;                                           ///< what `prepare` left
    const double *delta;                                               ///< overlap > 0 [m]
    const double *normal_velocity;                                     ///< d(delta)/dt, positive when approaching [m/s]
    const double *slip_velocity_x, *slip_velocity_y, *slip_velocity_z; ///< v_t of i relative to j at the contact point [m/s]
    const double *effective_radius;                                    ///< r_i r_j / (r_i + r_j) [m], if `needs_effective`
    const double *effective_mass;                                      ///< m_i m_j / (m_i + m_j) [kg], if `needs_effective`
    double *spring_x, *spring_y, *spring_z;                            ///< in: tangential spring had it not slid [m]; out: after sliding
    double *history[PLS_LAW_MAX_HISTORY];                              ///< in and out: the law's own numbers, zero when contact begins
    double *normal_force;                                  ///< out: repulsive positive [N]; force on i is -normal_force n + shear
    double *shear_force_x, *shear_force_y, *shear_force_z; ///< out: tangential force on i [N]
    double *damping_power;                                 ///< out: power taken by the dashpots [W]
    double *slip_work;                                     ///< out: work taken by sliding in this step [J]
} pls_law_batch;

/// Tangent stiffness and damping of one contact, for the stable step and the tangent operator D.
typedef struct pls_contact_stiffness
{
    double kn, kt; ///< [N/m]
    double cn, ct; ///< [N s/m]
} pls_contact_stiffness;

/// One contact, for the scalar questions.
typedef struct pls_contact_point
{
    double delta;                            ///< [m]
    double effective_radius, effective_mass; ///< [m], [kg]
    double spring_squared;                   ///< |spring|^2 [m^2]
    const double *history;                   ///< the law's own numbers
} pls_contact_point;

typedef struct pls_law_ops
{
    uint32_t api_version; ///< PLS_API_VERSION
    const char *name;     ///< the scene's `law:` value
    const char *meaning;  ///< one line for the docs
    const pls_parameter *parameters;
    int history;          ///< numbers kept per contact besides the spring
    bool needs_effective; ///< fill effective_radius and effective_mass

    /// Check what the table cannot and turn parameters and the two materials into constants. Called again when a parameter changes in time.
    pls_status (*prepare)(const double *values, const pls_material_values *a, const pls_material_values *b, double *constants);
    /// The law itself.
    void (*evaluate)(const pls_law_batch *batch);
    /// Tangent stiffness and damping at a contact. A law whose stiffness vanishes at delta = 0 is asked at a typical overlap before grains touch.
    void (*stiffness)(const double *constants, const pls_contact_point *contact, pls_contact_stiffness *out);
    /// Energy stored in the normal and in the tangential spring [J].
    void (*energy)(const double *constants, const pls_contact_point *contact, double *normal, double *shear);
} pls_law_ops;

#ifdef __cplusplus
}
#endif
#endif
