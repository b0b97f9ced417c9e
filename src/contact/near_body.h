// near_body.h -- of two bodies of plane faces what may have to do with their overlap, as seen along a direction.
#ifndef PLS_CONTACT_NEAR_BODY_H
#define PLS_CONTACT_NEAR_BODY_H

#include "contact/overlap.h"
#include "contact/posed.h"

static inline bool pls_is_half_space(const pls_posed *p) { return p->shape->ops->unbounded; }

/// The larger of two bodies' sizes, of a half-space's partner that one's [m].
static inline double pls_pair_size(const pls_posed *a, const pls_posed *b)
{
    return pls_is_half_space(b) ? a->size : fmax(a->size, b->size);
}

/// The overlap along a direction n from A to B, whichever: of their vertices the heights above the origin, towards the other body, and from where on faces matter. Nothing of
/// the overlap lies under a face from which it is further than its extent.
typedef struct pls_slab
{
    pls_vec3 origin, n;
    const double *height[2]; ///< null for a wall
    double lowest[2];
    double deep; ///< extent of the overlap: the penetration depth or more [m]
    double size; ///< of the bodies [m]
} pls_slab;

/// `reach`: the largest of the heights, of walls 0.
static inline pls_slab pls_slab_of(pls_vec3 origin, pls_vec3 n, const double *height_a, const double *height_b, double reach_a,
                                   double reach_b, double size)
{
    const double deep = reach_a + reach_b;
    return (pls_slab){
        .origin = origin, .n = n, .height = {height_a, height_b}, .lowest = {-reach_b - deep, -reach_a - deep}, .deep = deep, .size = size};
}

/// Heights along `up` of a body's vertices whose frame starts at `start`; there is room for a multiple of eight. Returns the largest.
double pls_near_heights(const pls_posed *p, pls_vec3 start, pls_vec3 up, double *height);
/// Bits of the first 64 vertices as high as `lowest`.
uint64_t pls_near_high(const pls_posed *p, const double *height, double lowest);
/// The faces that matter, moved by margins along n. B of walls is known already, and left as it is.
void pls_near_faces(const pls_posed *a, const pls_posed *b, const pls_slab *s, pls_near_body *A, pls_near_body *B);

#endif
