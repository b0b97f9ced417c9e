// clock.c -- monotonic wall time.

#include "base/clock.h"

#include <time.h>

double pls_clock(void)
{
    struct timespec now = {0, 0};
    clock_gettime(CLOCK_MONOTONIC, &now); // cannot fail: POSIX requires this clock, and the address is valid
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
