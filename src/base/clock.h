// clock.h -- monotonic wall time [s], for progress and tuning; never for results.
#ifndef PLS_BASE_CLOCK_H
#define PLS_BASE_CLOCK_H
double pls_clock(void);
#endif
