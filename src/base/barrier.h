// barrier.h -- where threads of a team wait for each other, many times within one parallel region.
//
// A thread that waits spins for a few tens of microseconds, which is what well-shared work takes to even out, and then sleeps. OpenMP's own barriers spin for
// milliseconds: where processors have other work besides, that time is taken from the very thread that is waited for.
//
//     if (pls_barrier_arrive(&barrier, threads))      the last one
//     {
//         ...                                         alone
//         pls_barrier_open(&barrier);
//     }
//     else
//         pls_barrier_wait(&barrier, round);          round: how often this thread has been here before
#ifndef PLS_BASE_BARRIER_H
#define PLS_BASE_BARRIER_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>

typedef struct pls_barrier
{
    _Alignas(64) atomic_int arrived;  ///< threads that have come in this round
    _Alignas(64) atomic_uint opened;  ///< rounds that are over
    _Alignas(64) atomic_int sleeping; ///< threads that spinning was too long for
    pthread_mutex_t lock;
    pthread_cond_t wake;
} pls_barrier;

void pls_barrier_init(pls_barrier *barrier);
/// Nobody may wait any more.
void pls_barrier_destroy(pls_barrier *barrier);
/// What this thread wrote is seen by those who pass. True for the last of `threads`, who must open it.
bool pls_barrier_arrive(pls_barrier *barrier, int threads);
void pls_barrier_open(pls_barrier *barrier);
void pls_barrier_wait(pls_barrier *barrier, unsigned round);
/// Arrive, and wait until all have.
void pls_barrier_pass(pls_barrier *barrier, int threads, unsigned round);

#endif
