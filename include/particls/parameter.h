/// @file parameter.h
/// Named numbers of shapes, laws, forces and observers, described once: the scene reader, its checks, the docs and the program all use the description.
#ifndef PARTICLS_PARAMETER_H
#define PARTICLS_PARAMETER_H

#include <particls/status.h>
#include <particls/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/// Most parameters a shape, law, force or observer may have.
#define PLS_MAX_PARAMETERS 32
/// Most numbers they make: all of them vectors.
#define PLS_MAX_VALUES (3 * PLS_MAX_PARAMETERS)

/// `initial` for a parameter that must be given.
#define PLS_REQUIRED NAN

/// What a row of a table of parameters stands for. Only numbers take places in the array of values; the rest comes to a shape by `pls_shape_input`.
enum {
    PLS_PARAMETER_NUMBER = 0,  ///< a number or a vector
    PLS_PARAMETER_POINTS,      ///< a list of points: `points` and `point_count`
    PLS_PARAMETER_FLAT_POINTS, ///< a list of points of the x-y plane, in 3D too: the same with z = 0
    PLS_PARAMETER_PATH,        ///< the name of a file: `path`
    PLS_PARAMETER_SHAPES       ///< other shapes with their places: `parts` and `part_count`
};

/// One parameter. Tables end with a null name. A parameter is one number; vectors are three parameters in the library and one list of
/// `components` numbers in a scene (only the first of the three carries a name and `components` = 3, the other two follow unnamed: so a
/// table row with components = 3 takes three places in the array of values).
typedef struct pls_parameter
{
    const char *name;    ///< the scene key, for example "kn"
    const char *unit;    ///< "N/m"; "" for pure numbers
    const char *meaning; ///< one line for the docs
    double initial;      ///< default value, PLS_REQUIRED if it must be given
    double minimum;      ///< smallest allowed value
    double maximum;      ///< largest allowed value
    bool open_minimum;   ///< the minimum itself is not allowed
    int components;      ///< 0 or 1: a number; 3: a vector
    int kind; ///< PLS_PARAMETER_NUMBER unless it says otherwise; the other kinds take no place and have no range and no default; `initial` PLS_REQUIRED: must be given
} pls_parameter;

/// Values taken by the whole table (vectors count three).
int pls_parameter_values(const pls_parameter *table);

/// Check `values` against the table; `owner` ("contact law 'hertz'") starts the message. INVALID_ARGUMENT names the parameter, the value and the range.
pls_status pls_parameters_check(const pls_parameter *table, const double *values, const char *owner);

/// Place of `name` in the array of values, -1 when there is none or when it is no number. "wind[1]" is the second component of a vector.
int pls_parameter_find(const pls_parameter *table, const char *name);

/// Fill `values` with the defaults (NaN where required).
void pls_parameters_default(const pls_parameter *table, double *values);

#ifdef __cplusplus
}
#endif
#endif
