// group.h -- finding the group an observer is told to look at.
#ifndef PLS_OBSERVE_GROUP_H
#define PLS_OBSERVE_GROUP_H

#include <particls/world.h>

/// index1 of the group called `name`; 0, every body, for "" and "all". NOT_FOUND lists the groups there are.
pls_status pls_find_observed_group(const pls_world *world, const char *name, uint32_t *index1);

/// " (did you mean 'x'?); there are x, y, z", for a message about a name that is not among them. `text` holds `size` bytes; names that
/// do not fit are left out.
void pls_describe_names(char *text, size_t size, const char *wrong, const char *const *names, size_t count);

#endif
