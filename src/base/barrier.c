// barrier.c -- threads wait for each other: first awake, then asleep.

#include "base/barrier.h"

enum { SPIN_TURNS = 1000 }; ///< looks before a thread goes to sleep: tens of microseconds, about what waking it costs

static inline void pause_processor(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
}

void pls_barrier_init(pls_barrier *barrier)
{
    atomic_init(&barrier->arrived, 0);
    atomic_init(&barrier->opened, 0);
    atomic_init(&barrier->sleeping, 0);
    pthread_mutex_init(&barrier->lock, NULL);
    pthread_cond_init(&barrier->wake, NULL);
}

void pls_barrier_destroy(pls_barrier *barrier)
{
    pthread_cond_destroy(&barrier->wake);
    pthread_mutex_destroy(&barrier->lock);
}

bool pls_barrier_arrive(pls_barrier *barrier, int threads)
{
    return atomic_fetch_add_explicit(&barrier->arrived, 1, memory_order_acq_rel) + 1 == threads;
}

void pls_barrier_open(pls_barrier *barrier)
{
    atomic_store_explicit(&barrier->arrived, 0, memory_order_relaxed);
    // In one order with the other side: either it sees the round over, or is seen sleeping.
    atomic_fetch_add(&barrier->opened, 1);
    if (atomic_load(&barrier->sleeping) == 0) return;
    pthread_mutex_lock(&barrier->lock);
    pthread_cond_broadcast(&barrier->wake);
    pthread_mutex_unlock(&barrier->lock);
}

void pls_barrier_wait(pls_barrier *barrier, unsigned round)
{
    for (int turn = 0; turn < SPIN_TURNS; ++turn)
    {
        if (atomic_load_explicit(&barrier->opened, memory_order_acquire) != round) return;
        pause_processor();
    }
    pthread_mutex_lock(&barrier->lock);
    atomic_fetch_add(&barrier->sleeping, 1);
    while (atomic_load(&barrier->opened) == round) pthread_cond_wait(&barrier->wake, &barrier->lock);
    atomic_fetch_sub(&barrier->sleeping, 1);
    pthread_mutex_unlock(&barrier->lock);
}

void pls_barrier_pass(pls_barrier *barrier, int threads, unsigned round)
{
    if (pls_barrier_arrive(barrier, threads))
        pls_barrier_open(barrier);
    else
        pls_barrier_wait(barrier, round);
}
