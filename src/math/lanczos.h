// lanczos.h -- the largest eigenvalue of a large symmetric operator.
#ifndef PLS_MATH_LANCZOS_H
#define PLS_MATH_LANCZOS_H

#include <particls/status.h>
#include <stddef.h>

/// y = A x, both of `count` numbers.
typedef void pls_operator(const void *context, const double *x, double *y);

/// Largest eigenvalue, from below: some thousandths too small, as a rule (it stops when an iteration adds less than 5e-4 of it, or after 60). `start` (overwritten) should have a part in every direction; 0 where start or operator are 0, NaN where the operator is not finite.
pls_status pls_lanczos_largest(pls_operator *multiply, const void *context, size_t count, double *start, double *out);

#endif
