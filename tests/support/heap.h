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
    bool dense;        ///< a lattice of spheres of at most two radii that touch from the start; else a loose heap of many radii
    double skin;       ///< 0: tunes itself
    bool reorder;
} heap_setup;

typedef struct heap
{
    heap_setup setup;
    verify_scene scene;
    pls_body_id middle; ///< a sphere amid the others
} heap;

/// A loose heap of radii 1 : 2.5 with states.
heap_setup heap_default(int dimension, int count);
/// A dense heap without states, of one radius (`size_ratio` 1) or two (2.5): the engine's quickest ways, whole vectors of contacts and steps that run into each
/// other, are open to such worlds only.
heap_setup heap_dense(int dimension, int count, double size_ratio, bool periodic);
heap heap_open(heap_setup setup);
void heap_close(heap *h);
/// There is enough to compare: enough contacts; in a dense heap also blocks of candidates for all threads, most of them touching.
void heap_expect_contacts(heap *h);
/// Take out the middle sphere and add two others above the rest: called between steps, the same in every run that is compared.
void heap_change_bodies(heap *h);

#endif
