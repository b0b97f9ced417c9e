// plane.c -- the half-space behind a plane: phi(X) = Z, in 2D the half-plane phi(X) = Y. The body's orientation turns the normal.

#include "shape/builtin.h"

static const pls_parameter parameters[] = {
    {.name = "lets_go",
     .unit = "",
     .meaning = "0: it pushes back at any depth (a run stops beyond guard.max_overlap); 1: it lets go of a body whose centre has crossed "
                "its surface, as LAMMPS's region walls do",
     .initial = 0.0,
     .minimum = 0.0,
     .maximum = 1.0},
    {.name = NULL},
};

// Both frames serve one function: in 2D bodies are turned about z only, so a plane's normal is its own y axis; the world gives X with
// the normal's coordinate in z in 3D and in y in 2D, where z is zero.
static double sdf(const double *values, pls_vec3 X)
{
    (void)values;
    return X.z;
}

const pls_shape_ops pls_plane_shape = {
    .api_version = PLS_API_VERSION,
    .name = "plane",
    .meaning = "a half-space (2D: half-plane); its body's position lies on the surface, `normal` points out of it",
    .parameters = parameters,
    .in_2d = true,
    .in_3d = true,
    .unbounded = true,
    .sdf = sdf,
};
