// domain.h -- the space bodies live in: 2 or 3 dimensions, periodic along some axes, edges that may stretch in time.
#ifndef PLS_MODEL_DOMAIN_H
#define PLS_MODEL_DOMAIN_H

#include <particls/types.h>

typedef struct pls_domain
{
    int dimension;
    double thickness; ///< of 2D bodies [m]
    bool periodic[3];
    bool any_periodic;
    double lower[3];      ///< corner that stays in place [m]
    double edge_start[3]; ///< edges at t = 0 [m]
    double rate[3];       ///< d(edge)/dt = edge_start rate, relative rate [1/s]
    double edge[3];       ///< edges now [m], 0 along axes that are not periodic
    double edge_rate[3];  ///< d(edge)/dt now [m/s]
} pls_domain;

/// Set the edges for time t.
static inline void pls_domain_at(pls_domain *domain, double t)
{
    for (int a = 0; a < 3; ++a)
    {
        domain->edge[a] = domain->periodic[a] ? domain->edge_start[a] * (1.0 + domain->rate[a] * t) : 0.0;
        domain->edge_rate[a] = domain->periodic[a] ? domain->edge_start[a] * domain->rate[a] : 0.0;
    }
}

#endif
