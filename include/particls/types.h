/// @file types.h
/// Vectors, quaternions, ids and limits.
#ifndef PARTICLS_TYPES_H
#define PARTICLS_TYPES_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PLS_VERSION_MAJOR 0
#define PLS_VERSION_MINOR 1
#define PLS_VERSION_PATCH 0
#define PLS_VERSION_TEXT  "0.1.0"
/// Raised whenever an `ops` structure or what its functions may assume changes; plugins are checked against it.
#define PLS_API_VERSION 5

/// Names (shapes, materials, groups, states) are at most this long, terminator included.
#define PLS_NAME_SIZE 64

typedef struct pls_vec3
{
    double x, y, z;
} pls_vec3;

/// Unit quaternion, grain frame to world: x_world = q x_grain q*.
typedef struct pls_quat
{
    double w, x, y, z;
} pls_quat;

/// Ids are handles by value; all zeros is null. A body's id holds its persistent number (index1 - 1), which orders all sums.
typedef struct pls_body_id
{
    uint32_t index1;
    uint32_t generation;
} pls_body_id;
typedef struct pls_shape_id
{
    uint16_t index1;
} pls_shape_id;
typedef struct pls_material_id
{
    uint16_t index1;
} pls_material_id;
typedef struct pls_group_id
{
    uint32_t index1;
} pls_group_id;
typedef struct pls_force_id
{
    uint32_t index1;
} pls_force_id;
typedef struct pls_state_id
{
    uint32_t index1;
} pls_state_id;

static inline pls_vec3 pls_vec(double x, double y, double z) { return (pls_vec3){x, y, z}; }
static inline pls_vec3 pls_add(pls_vec3 a, pls_vec3 b) { return pls_vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline pls_vec3 pls_sub(pls_vec3 a, pls_vec3 b) { return pls_vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline pls_vec3 pls_scale(pls_vec3 a, double s) { return pls_vec(a.x * s, a.y * s, a.z * s); }
static inline double pls_dot(pls_vec3 a, pls_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline pls_vec3 pls_cross(pls_vec3 a, pls_vec3 b)
{
    return pls_vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double pls_length(pls_vec3 a) { return sqrt(pls_dot(a, a)); }
static inline pls_vec3 pls_unit(pls_vec3 a) { return pls_scale(a, 1.0 / pls_length(a)); }

static inline pls_quat pls_quat_identity(void) { return (pls_quat){1.0, 0.0, 0.0, 0.0}; }
static inline pls_quat pls_quat_multiply(pls_quat a, pls_quat b)
{
    return (pls_quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
static inline pls_quat pls_quat_conjugate(pls_quat q) { return (pls_quat){q.w, -q.x, -q.y, -q.z}; }
static inline pls_quat pls_quat_unit(pls_quat q)
{
    double s = 1.0 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return (pls_quat){q.w * s, q.x * s, q.y * s, q.z * s};
}
/// Grain frame to world.
static inline pls_vec3 pls_rotate(pls_quat q, pls_vec3 a)
{
    pls_vec3 u = pls_vec(q.x, q.y, q.z), t = pls_scale(pls_cross(u, a), 2.0);
    return pls_add(a, pls_add(pls_scale(t, q.w), pls_cross(u, t)));
}
/// World to grain frame.
static inline pls_vec3 pls_rotate_back(pls_quat q, pls_vec3 a) { return pls_rotate(pls_quat_conjugate(q), a); }

#ifdef __cplusplus
}
#endif
#endif
