// moduli.h -- isotropic elastic moduli from E and nu, checked.
#ifndef PLS_BOND_MODULI_H
#define PLS_BOND_MODULI_H

#include <particls/bond.h>

typedef struct pls_moduli
{
    double bulk, shear; ///< K, mu [Pa]
    double plane;       ///< K of the plane: K + mu/3 (strain), 9 K mu / (3 K + 4 mu) (stress) [Pa] (THEORY 5)
} pls_moduli;

/// INVALID_ARGUMENT: E or nu missing or out of range; `law` names who asks.
pls_status pls_moduli_of(const pls_bond_setting *setting, const char *law, pls_moduli *out);

#endif
