// sphere_contact.c -- what the contact loops share that needs no speed.

#include "contact/sphere_contact.h"

pls_vec3 pls_wall_normal(const pls_body_orientation *q, int dimension)
{
    return pls_rotate((pls_quat){q->w, q->x, q->y, q->z}, dimension == 2 ? pls_vec(0.0, 1.0, 0.0) : pls_vec(0.0, 0.0, 1.0));
}
