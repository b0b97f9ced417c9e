// distance_field.h -- the signed distance of a shape on a lattice, for shapes whose own takes long and is asked thousands of times for one contact.
#ifndef PLS_SHAPE_DISTANCE_FIELD_H
#define PLS_SHAPE_DISTANCE_FIELD_H

#include <particls/shape.h>

/// No gradient of a field is longer: each component is a mean of slopes of the distance, over places that differ a little.
#define PLS_FIELD_SLOPE 1.75

/// Of a bounded shape that is its own mirror image about all planes of its frame: takes as long as some thirty thousand calls of its SDF, twice as many where its axes are as 4 to 1. OUT_OF_MEMORY.
pls_status pls_distance_field_make(const pls_shape *shape, pls_distance_field **out);
void pls_distance_field_free(pls_distance_field *field);

/// The field [m] and, unless null, its gradient: a function with a continuous gradient, which is the distance where that is linear and elsewhere as much more as its curvature by an eighth of the
/// squared spacing. Further out than `pls_distance_field_reach`: a lower bound of the distance, larger than that, and no gradient.
double pls_distance_field_at(const pls_distance_field *field, pls_vec3 X, pls_vec3 *gradient);
/// How far outside of the shape's bounds the field is known [m].
double pls_distance_field_reach(const pls_distance_field *field);

#endif
