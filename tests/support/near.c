// near.c -- see near.h.
#include "support/near.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

void near_number(double value, double expected, double tolerance, const char *file, int line)
{
    if (fabs(value - expected) <= tolerance) return;
    print_error("%.15g is not %.15g within %g\n", value, expected, tolerance);
    _fail(file, line);
}

void near_vector(pls_vec3 value, pls_vec3 expected, double tolerance, const char *file, int line)
{
    if (pls_length(pls_sub(value, expected)) <= tolerance) return;
    print_error("(%.12g, %.12g, %.12g) is not (%.12g, %.12g, %.12g) within %g\n", value.x, value.y, value.z, expected.x, expected.y,
                expected.z, tolerance);
    _fail(file, line);
}
