// generators.h -- where the bodies of an entry are: lattice, hexagonal packing, random packing, table, list, points that fill a region.
#ifndef PLS_SCENE_GENERATORS_H
#define PLS_SCENE_GENERATORS_H

#include "scene/scene_data.h"

/// Bodies of one entry in order. Zero-initialise; `pls_points_free` releases. Arrays may be null where every body has the entry's value.
typedef struct pls_points
{
    size_t count;
    pls_vec3 *position;         ///< [m]
    double *scale;              ///< multiplies the shape's lengths
    pls_vec3 *velocity;         ///< [m/s]
    pls_vec3 *angular_velocity; ///< [rad/s]
    pls_quat *orientation;
    uint32_t *choice; ///< which of the entry's shapes
    double *volume;   ///< of points of a continuum [m^3], in 2D their area [m^2]: their mass by the density
} pls_points;

/// The bodies of an entry: those of `place`, or the one at `position`.
pls_status pls_points_make(const pls_scene *scene, const pls_scene_body *body, pls_points *points);
void pls_points_free(pls_points *points);

/// The shape of the k-th body of an entry.
const pls_scene_shape *pls_points_shape(const pls_scene *scene, const pls_scene_body *body, const pls_points *points, size_t k);

/// What the generators below ask: the shape of a body, drawn by its number alone, and its bounding radius at scale 1.
size_t pls_points_choice(const pls_scene_body *body, size_t k);
double pls_points_radius(const pls_scene *scene, const pls_scene_body *body, size_t k);

/// random_pack.c: `section` is the resolved `random`.
pls_status pls_points_random(const pls_scene *scene, const pls_scene_body *body, const pls_node *section, pls_points *points);
/// fill_points.c
pls_status pls_points_fill(const pls_scene *scene, const pls_node *fill, pls_points *points);
/// csv_points.c
pls_status pls_points_csv(const pls_scene *scene, const pls_scene_body *body, const pls_node *csv, pls_points *points);

#endif
