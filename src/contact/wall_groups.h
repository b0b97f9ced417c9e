// wall_groups.h -- which pieces of a wall a body touches as one.
#ifndef PLS_CONTACT_WALL_GROUPS_H
#define PLS_CONTACT_WALL_GROUPS_H

#include "contact/solid_contact.h"

enum { PLS_FEW_CANDIDATES = 4096 }; ///< of one pair of bodies that are looked at together

/// Candidates first .. last (at most PLS_FEW_CANDIDATES) are of one pair of bodies, and their depths are known. Of those on facets `next` gets the PLS_SOLID_ states: of each group
/// of facets one candidate touches, and its touch becomes that of all of them; the rest are in its shade.
void pls_wall_groups(pls_solid_list *list, const pls_contact_input *input, size_t first, size_t last, uint8_t *next);

#endif
