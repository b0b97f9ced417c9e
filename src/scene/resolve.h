// resolve.h -- the parts of the walk over the tree that resolve.c and resolve_scene.c share.
#ifndef PLS_SCENE_RESOLVE_H
#define PLS_SCENE_RESOLVE_H

#include "scene/node.h"
#include "scene/schema.h"

#include <particls/scene.h>

typedef struct pls_resolver
{
    pls_scene *scene;
    const char *own_name; ///< while a state is resolved: its name, if others cannot use it
} pls_resolver;

/// resolve.c. `label` names the map in messages ("shape 'ball'").
pls_status pls_resolve_map(pls_resolver *r, pls_node *node, const pls_key *keys, size_t count, const char *label);
pls_status pls_resolve_key(pls_resolver *r, const pls_key *key, pls_node *node, const char *label);
pls_status pls_resolve_paths(pls_resolver *r, const pls_key *key, pls_node *node, const char *label);
/// Whether the text may be a name; `what` it would be ("material").
pls_status pls_resolve_name(const pls_node *node, const char *what);

/// resolve_scene.c: sections whose keys depend on their contents.
pls_status pls_resolve_shapes(pls_resolver *r, const pls_key *key, pls_node *map, const char *label);
pls_status pls_resolve_contact(pls_resolver *r, pls_node *entry, const char *label);
pls_status pls_resolve_bond(pls_resolver *r, pls_node *entry, const char *label);
pls_status pls_resolve_state(pls_resolver *r, pls_node *entry, const char *label);
pls_status pls_resolve_force_of_plugin(pls_resolver *r, pls_node *entry, const char *label);
pls_status pls_resolve_observer_of_plugin(pls_resolver *r, pls_node *entry, const char *label);

#endif
