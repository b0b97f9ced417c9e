// builtin.c -- the list of built-in bond laws; a new law adds one line.

#include "bond/builtin.h"

const pls_bond_ops *const *pls_builtin_bonds(void)
{
    static const pls_bond_ops *const laws[] = {&pls_linear_solid_bonds, &pls_bond_based_bonds, &pls_beam_bonds, NULL};
    return laws;
}
