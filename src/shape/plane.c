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

static double sdf(const pls_shape *shape, pls_vec3 X) { return shape->dimension == 2 ? X.y : X.z; }

static pls_vec3 gradient(const pls_shape *shape, pls_vec3 X)
{
    (void)X;
    return shape->dimension == 2 ? pls_vec(0.0, 1.0, 0.0) : pls_vec(0.0, 0.0, 1.0);
}

static pls_vec3 proximal(const pls_shape *shape, pls_vec3 X, double step) { return pls_sub(X, pls_scale(gradient(shape, X), step)); }

#define ANSWERS                                                                                                                    \
    .api_version = PLS_API_VERSION, .parameters = parameters, .unbounded = true, .convex = true, .sdf = sdf, .gradient = gradient, \
    .proximal = proximal

const pls_shape_ops pls_plane_shape = {
    .name = "plane",
    .meaning = "a half-space (2D: half-plane); its body's position lies on the surface, `normal` points out of it",
    .in_2d = true,
    .in_3d = true,
    ANSWERS,
};

const pls_shape_ops pls_half_plane_shape = {
    .name = "half_plane",
    .meaning = "a half-plane: a plane in 2D",
    .in_2d = true,
    ANSWERS,
};
