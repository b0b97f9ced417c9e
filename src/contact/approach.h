// approach.h -- how long a pair list holds: how much nearer those may have come that are not listed.
#ifndef PLS_CONTACT_APPROACH_H
#define PLS_CONTACT_APPROACH_H

#include "contact/pair_list.h"

/// Bound on how much of the skin is used up [m], growth of radii included: no gap between two bodies that are not listed is narrower than the skin less this.
/// What list->image_drift counts comes on top.
pls_status pls_pair_list_approach(pls_pair_list *list, const pls_bodies *bodies, const pls_domain *domain, double *approach);

#endif
