// heap.h -- a lively world for tests of determinism: polydisperse spheres fall, collide, slide and settle, with all the engine has.
#ifndef PLS_TESTS_SUPPORT_HEAP_H
#define PLS_TESTS_SUPPORT_HEAP_H

#include "support/verify.h"

typedef struct heap_setup
{
    int dimension;
    int count;         ///< spheres
    double size_ratio; ///< largest over smallest radius
    bool periodic;     ///< along x (and y in 3D); else walls
    bool states;       ///< one sphere grows, a state drives the law's kn
    double skin;       ///< 0: tunes itself
    bool reorder;
} heap_setup;

typedef struct heap
{
    heap_setup setup;
    verify_scene scene;
    pls_body_id middle; ///< a sphere amid the others
} heap;

heap_setup heap_default(int dimension, int count);
heap heap_open(heap_setup setup);
void heap_close(heap *h);
/// Take out the middle sphere and add two others above the rest: called between steps, the same in every run that is compared.
void heap_change_bodies(heap *h);

#endif
