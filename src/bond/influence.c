// influence.c -- influence functions and their integrals over full families.

#include "bond/influence.h"

#include "math/gauss.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double pls_influence_at(const pls_bonds_def *def, double xi)
{
    const double r = xi / def->horizon;
    switch (def->influence)
    {
        case PLS_INFLUENCE_ONE: return 1.0;
        case PLS_INFLUENCE_INVERSE: return 1.0 / r;
        case PLS_INFLUENCE_CONICAL: return r < 1.0 ? 1.0 - r : 0.0;
        case PLS_INFLUENCE_GAUSSIAN: return exp(-r * r);
        case PLS_INFLUENCE_FUNCTION: return def->weight(def->context, xi);
    }
    return NAN;
}

/// Integral of w(xi) xi^power over 0 .. horizon, in equal pieces: a user's function may have corners.
static double moment(const pls_bonds_def *def, int power)
{
    enum { PIECES = 64 };
    const double half = 0.5 * def->horizon / PIECES;
    double sum = 0.0;
    for (int k = 0; k < PIECES; ++k)
        for (int g = 0; g < 8; ++g)
        {
            const double xi = half * (2 * k + 1 + (g < 4 ? pls_gauss_node[g] : -pls_gauss_node[g - 4]));
            sum += half * pls_gauss_weight[g % 4] * pls_influence_at(def, xi) * pow(xi, power);
        }
    return sum;
}

double pls_critical_stretch(const pls_bonds_def *def, int dimension, double bulk, double fracture_energy)
{
    // 3D: 9 K s^2 / m times pi int w xi^5; 2D, per thickness: 4 k2 s^2 / m times 2 int w xi^4. Dilated by s each bond stores half of t e at either end.
    const double m = dimension == 3 ? 4.0 * pi * moment(def, 4) : 2.0 * pi * moment(def, 3); // of a full family of a continuum
    const double per_square = dimension == 3 ? 9.0 * bulk * pi * moment(def, 5) / m : 8.0 * bulk * moment(def, 4) / m;
    return sqrt(fracture_energy / per_square);
}

double pls_critical_energy(int dimension, double first_moment, double fracture_energy)
{
    // Bonds of length xi across a plane, per area: a quarter (in 2D 1/pi) of V_j xi from either side together, each with the same energy by its volumes.
    return (dimension == 3 ? 4.0 : pi) * fracture_energy / first_moment;
}
