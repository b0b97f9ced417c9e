// influence.h -- how bonds of a family count by their length, and integrals over full families of a continuum.
#ifndef PLS_BOND_INFLUENCE_H
#define PLS_BOND_INFLUENCE_H

#include <particls/bond.h>

/// w(xi) >= 0, without unit. NaN where a user's function says so.
double pls_influence_at(const pls_bonds_def *def, double xi);

/// Critical stretch at which tearing a plane apart takes `fracture_energy` [J/m^2]: the work of all bonds that cross it, each at that stretch, in a solid of bulk modulus K (in 2D that of the
/// plane) (Silling and Askari 2005; Zhang and Qiao 2018). With w = delta / xi: s^2 = 5 G / (9 K delta); in 2D pi G / (3 k2 delta).
double pls_critical_stretch(const pls_bonds_def *def, int dimension, double bulk, double fracture_energy);

/// Energy that a bond stores, by its two volumes, where it breaks, so that a plane that is torn apart takes G per area: 4 G/S, in 2D pi G/S, with S = sum beta V_j xi of a full family; in a continuum
/// 4 G/(pi delta^4) and 3 G/(2 h delta^3) (Foster et al. 2011) [J/m^6].
double pls_critical_energy(int dimension, double first_moment, double fracture_energy);

#endif
