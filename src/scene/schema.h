// schema.h -- the one table of scene keys.
//
// The reader (resolve.c), suggestions for misspelt keys, scene.used.yaml, the JSON Schema and the reference page all come from it. Shapes,
// laws, and the forces and observers of plugins bring their own tables of parameters (<particls/parameter.h>), which are turned into the same kind of rows.
#ifndef PLS_SCENE_SCHEMA_H
#define PLS_SCENE_SCHEMA_H

#include "base/text.h"

#include <particls/parameter.h>

#include <stdbool.h>

/// What stands behind a key. A number may always be written as an expression over `vars`.
typedef enum pls_key_type {
    PLS_KEY_NUMBER,  ///< or one of `words`, or a map of section `sub`
    PLS_KEY_INTEGER, ///< or one of `words`
    PLS_KEY_BOOLEAN,
    PLS_KEY_TEXT,
    PLS_KEY_NAME,        ///< letters, digits, _ - and ., beginning with a letter
    PLS_KEY_WORD,        ///< one of `words`
    PLS_KEY_PATH,        ///< of an input file, relative to the scene's folder
    PLS_KEY_CONDITION,   ///< an expression that is true or false, always evaluated during the run
    PLS_KEY_VECTOR,      ///< a list of `dimension` numbers
    PLS_KEY_VECTOR3,     ///< a list of three numbers in 2D too
    PLS_KEY_SPIN,        ///< three numbers about the axes, in 2D the one about z
    PLS_KEY_RANGE,       ///< a list of two numbers, the first the smaller
    PLS_KEY_COUNTS,      ///< a list of `dimension` integers
    PLS_KEY_FLAGS,       ///< a list of `dimension` booleans
    PLS_KEY_ORIENTATION, ///< [w, x, y, z] or {axis, angle}; in 2D an angle; or one of `words`
    PLS_KEY_POINTS,      ///< a list of vectors
    PLS_KEY_PAIRS,       ///< a list of pairs of numbers
    PLS_KEY_NAMES,       ///< a list of names, or one of `words`
    PLS_KEY_MIX,         ///< a name, a list of names, or a map from names to their fractions
    PLS_KEY_WORDS,       ///< a list of `words`
    PLS_KEY_PATHS,       ///< a list of paths
    PLS_KEY_SECTION,     ///< a map of section `sub`
    PLS_KEY_CHOICE,      ///< a map with exactly one key of section `sub`
    PLS_KEY_NAMED,       ///< a map from the user's names to section `sub`
    PLS_KEY_LIST,        ///< a list of maps of section `sub`; "a|b|c": the one whose first key is there
    PLS_KEY_PLUGIN,      ///< stands for the name of a plugin's force or observer: a map of its parameters and of section `sub`
    PLS_KEY_VARIABLES,   ///< a map from the user's names to numbers
    PLS_KEY_SHAPES       ///< a map from the user's names to {shape: {parameters}}
} pls_key_type;

enum {
    PLS_KEY_REQUIRED = 1,
    PLS_KEY_OPEN_MINIMUM = 2, ///< the minimum itself is not allowed
    PLS_KEY_ONLY_2D = 4,
    PLS_KEY_INFINITE = 8, ///< .inf is allowed
    PLS_KEY_MAY_BE_EMPTY = 16
};

/// What an expression may use besides `vars`, pi and e.
enum {
    PLS_USES_TIME = 1,         ///< t
    PLS_USES_PLACE = 2,        ///< x y z
    PLS_USES_VELOCITY = 4,     ///< vx vy vz
    PLS_USES_RADIUS = 8,       ///< r
    PLS_USES_MASS = 16,        ///< m
    PLS_USES_OWN = 32,         ///< s: the state itself
    PLS_USES_STATES = 64,      ///< names of states
    PLS_USES_CHANCE = 128,     ///< chance: a number in (0, 1) that each body draws
    PLS_USES_TEMPERATURE = 256 ///< temperature: of the body in its bonds
};

typedef struct pls_key
{
    const char *section;
    const char *name;
    pls_key_type type;
    unsigned flags;
    unsigned uses;       ///< PLS_USES_ bits
    const char *words;   ///< "a|b|c"
    const char *sub;     ///< section or sections
    const char *unit;    ///< "" for pure numbers
    const char *initial; ///< default, null: none. Lists repeat it for each component or hold its words
    double minimum, maximum;
    const char *meaning;
} pls_key;

/// A section and what it is for, in the order of the reference page.
typedef struct pls_section
{
    const char *name;
    const char *path; ///< where it stands, for the reference page
    const char *meaning;
} pls_section;

enum { PLS_MAX_KEYS = 64 }; ///< of one map, parameters of a shape or law included

const pls_section *pls_schema_sections(size_t *count);
/// Rows of a section, `*count` of them (they lie together in the table).
const pls_key *pls_schema_keys(const char *section, size_t *count);
/// A row for a number, with three components for a vector in 2D too. `initial` holds 32 bytes for the default's text and must live as long as the row.
/// A row for a parameter of a law, force or observer, whose vectors have three components in 2D too. `initial` holds 32 bytes for the default's text and must live as long as the row.
pls_key pls_schema_parameter(const pls_parameter *parameter, unsigned uses, char initial[32]);

/// Whose table of parameters it is: shapes take what is not a number too, and the numbers of laws and forces may change in time.
typedef enum pls_table_owner { PLS_OF_SHAPE, PLS_OF_LAW, PLS_OF_BOND, PLS_OF_FORCE, PLS_OF_OBSERVER } pls_table_owner;
/// The row for a parameter of any of them: shapes take other things than numbers, laws and forces expressions over t and states, and vectors have the scene's
/// dimension but for laws.
pls_key pls_schema_parameter_of(pls_table_owner owner, const pls_parameter *parameter, char initial[32]);
/// A heading and a table of parameters on a reference page.
pls_status pls_page_parameters(pls_text *out, const char *name, const char *meaning, const pls_parameter *table, pls_table_owner owner);

/// "greater than 0 and at most 1".
void pls_schema_range(const pls_key *key, char text[128]);

/// The k-th of the words in "a|b|c" into `word`; false when there are no more.
bool pls_schema_word(const char *words, size_t k, char word[64]);
/// Whether `text` is one of the words.
bool pls_schema_has_word(const char *words, const char *text);

#endif
