// small_turn.h -- angles by which things turn in a step, their sines and cosines.
#ifndef PLS_MATH_SMALL_TURN_H
#define PLS_MATH_SMALL_TURN_H

#include <math.h>

/// Both, to the last digit or the one before. Up to a thirtieth of a radian by their series, whose next terms are below round-off: a quarter of the time, and the same bits
/// with any C library.
static inline void pls_small_turn(double angle, double *sine, double *cosine)
{
    if (!(fabs(angle) < 1.0 / 32.0))
    {
        *sine = sin(angle), *cosine = cos(angle);
        return;
    }
    const double square = angle * angle;
    *sine = angle - angle * square * (1.0 / 6.0 - square * (1.0 / 120.0 - square * (1.0 / 5040.0)));
    *cosine = 1.0 - square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square * (1.0 / 40320.0))));
}

/// An angle of 0 or more and less than pi, divided by its sine; 1 at zero. As above up to the same sine.
static inline double pls_angle_by_sine(double sine, double cosine)
{
    if (!(sine < 1.0 / 32.0 && cosine > 0.0)) return atan2(sine, cosine) / sine;
    const double square = sine * sine;
    return 1.0 + square * (1.0 / 6.0 + square * (3.0 / 40.0 + square * (5.0 / 112.0 + square * (35.0 / 1152.0))));
}

#endif
