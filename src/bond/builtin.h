// builtin.h -- the built-in bond laws, and what every law is looked at for.
#ifndef PLS_BOND_BUILTIN_H
#define PLS_BOND_BUILTIN_H

#include <particls/bond.h>

extern const pls_bond_ops pls_linear_solid_bonds, pls_bond_based_bonds, pls_elastic_plastic_bonds, pls_viscoelastic_bonds, pls_beam_bonds;

/// INVALID_ARGUMENT: the law lacks a function, or has some that exclude each other, or remembers too much.
pls_status pls_bond_ops_check(const pls_bond_ops *ops);

#endif
