// wall_groups.h -- which pieces of a wall a body touches as one.
#ifndef PLS_CONTACT_WALL_GROUPS_H
#define PLS_CONTACT_WALL_GROUPS_H

#include "contact/solid_contact.h"

/// The `front` of candidates whose body may be on both sides of a wall: of any, and where the wall is past the middle of its thickness, for as long as it touches.
#define PLS_WALL_TOUCHED 1.0
#define PLS_WALL_PASSED  2.0

/// Candidates first .. last are all of one pair of bodies, and their depths are known. Of those on facets `next` gets the PLS_SOLID_ states: of each group of facets one candidate
/// touches, and its touch becomes that of all of them; the rest are in its shade. Of more than 16384 facets that a part of the body is near
/// to those that it touches count, and of these the first 16384.
void pls_wall_groups(pls_solid_list *list, const pls_contact_input *input, size_t first, size_t last, uint8_t *next);

#endif
