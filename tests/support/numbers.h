// numbers.h -- the numbers of a shape with how many there are, as `pls_shape_input` and its like take them.
#ifndef PLS_TEST_NUMBERS_H
#define PLS_TEST_NUMBERS_H

/// An array (not a pointer) and its length: two arguments of a call.
#define COUNTED(array) (array), sizeof(array) / sizeof *(array)
/// The same of numbers written on the spot.
#define NUMBERS(...) (const double[]){__VA_ARGS__}, sizeof((const double[]){__VA_ARGS__}) / sizeof(double)
/// An array of numbers in an initialiser of a `pls_shape_input`.
#define VALUES(array) .values = (array), .value_count = sizeof(array) / sizeof *(array)

#endif
