// scene_data.h -- a scene in memory: the resolved tree, and the lists that parse_*.c make of it with all names looked up.
//
// The entries point back at their nodes. Numbers stay in the nodes (resolved by then), so a key is named where it is used and nowhere else.
#ifndef PLS_SCENE_SCENE_DATA_H
#define PLS_SCENE_SCENE_DATA_H

#include "base/registry.h"
#include "base/text.h"
#include "scene/expression.h"
#include "scene/node.h"

#include <particls/bond.h>
#include <particls/plugin.h>
#include <particls/scene.h>

enum {
    PLS_ALL_MATERIALS = -1,
    PLS_OF_WORLD = -1,
    PLS_MIDDLE_BODY = -1,
    PLS_ONLY_BODY = -2 ///< no index given: the entry must hold one body
};

typedef struct pls_scene_material
{
    const char *name;
    const pls_node *node;
} pls_scene_material;

typedef struct pls_scene_shape
{
    const char *name;
    const pls_node *node; ///< map of parameters
    const pls_shape_ops *ops;
    pls_shape *made;
    bool begun; ///< while it or its parts are made
} pls_scene_shape;

/// One of the shapes that the bodies of an entry may have.
typedef struct pls_scene_choice
{
    int shape;
    double up_to; ///< sum of the fractions of this and the shapes before; 1 at the last one
} pls_scene_choice;

typedef struct pls_scene_body
{
    const char *name;
    const pls_node *node;
    pls_scene_choice *choice; ///< more than one: drawn at random for each body
    size_t choices;
    int material;
} pls_scene_body;

typedef struct pls_scene_contact
{
    const pls_node *node;
    int a, b; ///< materials, or PLS_ALL_MATERIALS
    const pls_law_ops *ops;
} pls_scene_contact;

typedef struct pls_scene_bonds
{
    const char *name;
    const pls_node *node;
    const pls_bond_ops *ops;
    int *of; ///< body entries
    size_t of_count;
} pls_scene_bonds;

typedef struct pls_scene_state
{
    const char *name;
    const pls_node *node;
    const pls_node *rate;
    const pls_node *initial; ///< null: the body's own, or 0
    int body;                ///< entry, or PLS_OF_WORLD
    long index;              ///< body within the entry; PLS_MIDDLE_BODY, PLS_ONLY_BODY
    bool each;
    pls_state_target target;
    bool keep_density;
} pls_scene_state;

struct pls_scene
{
    pls_arena arena;
    pls_source source;
    const char *folder; ///< absolute
    pls_node *root;
    int dimension;
    double thickness;

    pls_registry shape_ops, law_ops, bond_ops; ///< built-in and plugins'
    pls_registry force_ops, observer_ops;      ///< plugins'
    void **plugins;                            ///< dlopen handles
    size_t plugin_count, plugin_capacity;

    pls_constant *vars;
    size_t var_count;
    const char **state_names; ///< of each states entry; null for `each: true`, which expressions cannot name
    size_t state_count;       ///< entries of `states`

    pls_scene_material *materials;
    pls_scene_shape *shapes;
    pls_scene_body *bodies;
    pls_scene_contact *contacts;
    pls_scene_bonds *bonds;
    pls_scene_state *states;
    size_t material_count, shape_count, body_count, contact_count, bonds_count;

    pls_observer_def *observers;
    size_t observer_count;
    const char **inputs;
    size_t input_count, input_capacity;
    double end;
    uint64_t hash;
};

/// The symbols an expression of these uses (PLS_USES_ bits) may name, in the fixed order t, x y z, vx vy vz, r, m, s, own name, states.
/// `names` holds PLS_EXPRESSION_VARIABLES pointers. `own` is a further name for s, or null. LIMIT_EXCEEDED when there are too many states.
pls_status pls_scene_symbols(const pls_scene *scene, unsigned uses, const char *own, const char **names, pls_symbols *symbols);

/// Apply one `path=value` to the tree.
pls_status pls_scene_override(pls_scene *scene, const char *text);

/// resolve.c: check the tree against the schema; expressions over `vars` become numbers, defaults are put in, keys are brought into the
/// order of the table.
pls_status pls_scene_resolve(pls_scene *scene);

/// plugin.c
pls_status pls_scene_load_builtins(pls_scene *scene);
pls_status pls_scene_load_plugin(pls_scene *scene, const pls_node *path);
void pls_scene_unload_plugins(pls_scene *scene);
/// The plugins' operations that entries of this section can name ("force_plugin", "observe_plugin"), null for other sections.
const pls_registry *pls_scene_operations_of(const pls_scene *scene, const char *section);
/// The operations of a plugin that an entry of `forces` or `observe` names, and the map of their numbers; null when it names none.
const void *pls_scene_named_operations(const pls_registry *operations, const pls_node *entry, const pls_node **map);

/// parse_*.c: the lists, and the checks that concern several keys
pls_status pls_scene_parse_materials(pls_scene *scene);
pls_status pls_scene_parse_shapes(pls_scene *scene);
pls_status pls_scene_parse_bodies(pls_scene *scene);
pls_status pls_scene_parse_contacts(pls_scene *scene);
pls_status pls_scene_parse_bonds(pls_scene *scene);
pls_status pls_scene_parse_forces(pls_scene *scene);
pls_status pls_scene_parse_states(pls_scene *scene);
pls_status pls_scene_parse_observers(pls_scene *scene);
pls_status pls_scene_parse_domain(pls_scene *scene);

/// Index of the material, shape, body entry of that name, -1 if there is none.
int pls_scene_find_material(const pls_scene *scene, const char *name);
int pls_scene_find_shape(const pls_scene *scene, const char *name);
int pls_scene_find_body(const pls_scene *scene, const char *name);
/// The same, failing at `node` (a text) with a suggestion.
pls_status pls_scene_need_material(const pls_scene *scene, const pls_node *node, int *index);
pls_status pls_scene_need_shape(const pls_scene *scene, const pls_node *node, int *index);
pls_status pls_scene_need_body(const pls_scene *scene, const pls_node *node, int *index);

/// The shape of the c-th choice of an entry.
const pls_scene_shape *pls_scene_choice_shape(const pls_scene *scene, const pls_scene_body *body, size_t c);
/// `orientation` of a body or part is a rotation: it has an axis, and neither axis nor quaternion is zero.
pls_status pls_scene_check_turn(const pls_scene *scene, const pls_node *map);

/// Note an input file (absolute path).
pls_status pls_scene_add_input(pls_scene *scene, const char *path);

/// used.c: the text of the resolved scene. With `for_hash` input files appear by name and contents instead of by path.
pls_status pls_scene_print(const pls_scene *scene, bool for_hash, pls_text *text);

/// Reading resolved nodes. A missing key gives the fallback.
double pls_scene_number(const pls_node *map, const char *key, double fallback);
bool pls_scene_boolean(const pls_node *map, const char *key, bool fallback);
const char *pls_scene_string(const pls_node *map, const char *key, const char *fallback);
/// A vector of two or three numbers; formulas and words give zero.
pls_vec3 pls_scene_vector(const pls_node *map, const char *key);
/// The same for a SPIN key: in 2D the number is the z component.
pls_vec3 pls_scene_spin(const pls_node *map, const char *key);
/// The rotation under `orientation`; none if it is missing, or a word.
pls_quat pls_scene_turn(const pls_scene *scene, const pls_node *map);
/// Values of a table of parameters from the resolved map of a shape or contact; NaN for formulas, which are bound later.
void pls_scene_parameters(const pls_parameter *table, const pls_node *map, double *values);
/// Whether the vector has components that are not plain numbers.
bool pls_scene_varies(const pls_node *vector);
/// "did you mean 'x'?  (things: a, b)" into `hint`.
void pls_scene_hint(char *hint, size_t size, const char *word, const char *what, const char *const *candidates, size_t count);

#endif
