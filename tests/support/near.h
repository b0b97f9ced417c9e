// near.h -- assertions of numbers that are known to a tolerance. What is off is told with both values.
#ifndef PLS_TEST_NEAR_H
#define PLS_TEST_NEAR_H

#include <particls/types.h>

#define assert_near(value, expected, tolerance)     near_number((value), (expected), (tolerance), __FILE__, __LINE__)
#define assert_vec_near(value, expected, tolerance) near_vector((value), (expected), (tolerance), __FILE__, __LINE__)

void near_number(double value, double expected, double tolerance, const char *file, int line);
void near_vector(pls_vec3 value, pls_vec3 expected, double tolerance, const char *file, int line);

#endif
