// test_barrier.c -- a barrier lets nobody go before all have come, whether they wait awake or asleep.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/barrier.h"

#include <omp.h>
#include <stdatomic.h>
#include <time.h>

enum { ROUNDS = 2000 };

/// Each thread counts itself in, passes, and finds all others counted in too.
static void count_in_rounds(int threads, long pause_ns, int rounds)
{
    pls_barrier in, out;
    pls_barrier_init(&in);
    pls_barrier_init(&out);
    atomic_int counted = 0;
    atomic_int wrong = 0;
#pragma omp parallel num_threads(threads)
    {
        const int here = omp_get_num_threads();
        for (unsigned round = 0; round < (unsigned)rounds; ++round)
        {
            if (omp_get_thread_num() == 0 && pause_ns > 0) nanosleep(&(struct timespec){0, pause_ns}, NULL);
            atomic_fetch_add(&counted, 1);
            pls_barrier_pass(&in, here, round);
            if (atomic_load(&counted) != here * (int)(round + 1)) atomic_fetch_add(&wrong, 1);
            pls_barrier_pass(&out, here, round);
        }
    }
    pls_barrier_destroy(&in);
    pls_barrier_destroy(&out);
    assert_int_equal(atomic_load(&wrong), 0);
}

static void nobody_passes_before_all_have_come(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 4; ++threads) count_in_rounds(threads, 0, ROUNDS);
}

static void sleepers_are_woken(void **state)
{
    (void)state;
    count_in_rounds(3, 2000000, 20); // 2 ms: far longer than threads wait awake
}

static void the_last_works_alone_before_it_opens(void **state)
{
    (void)state;
    pls_barrier barrier;
    pls_barrier_init(&barrier);
    int sum = 0; // not atomic: only the last thread writes, and others read after it has opened
    atomic_int wrong = 0;
#pragma omp parallel num_threads(3)
    for (unsigned round = 0; round < ROUNDS; ++round)
    {
        if (pls_barrier_arrive(&barrier, omp_get_num_threads()))
        {
            ++sum;
            pls_barrier_open(&barrier);
        }
        else
            pls_barrier_wait(&barrier, round);
        if (sum < (int)round + 1) atomic_fetch_add(&wrong, 1);
    }
    pls_barrier_destroy(&barrier);
    assert_int_equal(atomic_load(&wrong), 0);
    assert_int_equal(sum, ROUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nobody_passes_before_all_have_come),
        cmocka_unit_test(sleepers_are_woken),
        cmocka_unit_test(the_last_works_alone_before_it_opens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
