/// @file threads.h
/// How many threads the library uses. Results do not depend on it.
#ifndef PARTICLS_THREADS_H
#define PARTICLS_THREADS_H

#include <particls/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Threads used by the library in this process (OpenMP), at least 1.
int pls_threads(void);
/// Use `threads` threads; 0 means all processors. INVALID_ARGUMENT when negative or over 4096.
pls_status pls_set_threads(int threads);

#ifdef __cplusplus
}
#endif
#endif
