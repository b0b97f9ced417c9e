// builtin.h -- the built-in bond laws.
#ifndef PLS_BOND_BUILTIN_H
#define PLS_BOND_BUILTIN_H

#include <particls/bond.h>

extern const pls_bond_ops pls_linear_solid_bonds, pls_bond_based_bonds, pls_beam_bonds;

#endif
