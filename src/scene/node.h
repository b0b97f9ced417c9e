// node.h -- the scene file as a tree of nodes, each knowing its place in the text, and the error messages that show the place.
//
// The reader (yaml.c) makes the tree, overrides change it, resolve.c checks it against the schema and puts every value in force into it.
// What then uses the scene (parse_*.c, used.c) reads a tree in which each node has the type the schema promises.
#ifndef PLS_SCENE_NODE_H
#define PLS_SCENE_NODE_H

#include "base/arena.h"

#include <stdbool.h>

/// Where a text came from: a file, or one `--set path=value`, which has no lines.
typedef struct pls_source
{
    const char *name; ///< the path as given, or "--set path=value"
    const char *text;
    size_t size;
    bool has_lines;
} pls_source;

typedef enum pls_node_kind { PLS_NODE_SCALAR, PLS_NODE_LIST, PLS_NODE_MAP } pls_node_kind;

typedef struct pls_node pls_node;
struct pls_node
{
    pls_node_kind kind;
    bool quoted;  ///< a scalar in quotes or in a block
    bool exact;   ///< the text stands in the file as it is, so that a place within it has a column
    bool numeric; ///< set by resolve.c: `number` holds the value
    bool formula; ///< set by resolve.c: `text` is an expression that is evaluated during the run
    bool path;    ///< set by resolve.c: `text` is the absolute path of an input file
    double number;
    const char *text; ///< scalars only
    const pls_source *source;
    int line, column; ///< from 1; column in characters
    size_t count;     ///< entries of a list or map
    pls_node **child;
    pls_node **key; ///< maps only
};

/// Read YAML text. The tree lives in `arena`; `source` must live as long.
pls_status pls_yaml_read(pls_arena *arena, const pls_source *source, pls_node **root);
/// Read a scene file into a source and check that it can be text: size, UTF-8, no control characters.
pls_status pls_source_read(pls_arena *arena, const char *path, pls_source *source);

/// The value of a key, or null. Also null when `map` is null or no map.
pls_node *pls_node_get(const pls_node *map, const char *key);
/// The node of the key itself (its place), or null.
const pls_node *pls_node_key(const pls_node *map, const char *key);
/// Null, `~` or nothing written.
bool pls_node_is_null(const pls_node *node);
/// "a number", "a list", ... for messages.
const char *pls_node_describe(const pls_node *node);
/// A new node with the place of `like`.
pls_status pls_node_new(pls_arena *arena, pls_node_kind kind, const pls_node *like, pls_node **node);
/// Append to a map or list (`key` null).
pls_status pls_node_append(pls_arena *arena, pls_node *parent, pls_node *key, pls_node *child);

/// Fail with a SCENE message that shows the place of `at`. `hint` (may be null) is the last line: what to do.
pls_status pls_node_fail(const pls_node *at, const char *hint, const char *format, ...) __attribute__((format(printf, 3, 4)));
/// The same with the mark `offset` characters into the text of a scalar.
pls_status pls_node_fail_at(const pls_node *at, size_t offset, const char *hint, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/// The same for a line and column of a source.
pls_status pls_source_fail(const pls_source *source, int line, int column, const char *hint, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
/// Put "file:line:column: what: " in front of the message of something that failed while the node was carried out, and the source line below it. Nothing stands for
/// `what` where it is empty: the message says it.
pls_status pls_node_context(pls_status status, const pls_node *at, const char *format, ...) __attribute__((format(printf, 3, 4)));

#endif
