// test_clock.c -- the clock runs forwards, in seconds.

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/clock.h"

#include <time.h>

static void the_clock_measures_a_sleep(void **state)
{
    (void)state;
    const struct timespec pause = {0, 20000000};
    double before = pls_clock();
    nanosleep(&pause, NULL);
    double slept = pls_clock() - before;
    assert_true(slept >= 0.02 && slept < 10); // a busy machine may wake us late
}

static void the_clock_never_runs_backwards(void **state)
{
    (void)state;
    double last = pls_clock();
    for (int i = 0; i < 100000; ++i)
    {
        double now = pls_clock();
        assert_true(now >= last);
        last = now;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_clock_measures_a_sleep),
        cmocka_unit_test(the_clock_never_runs_backwards),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
