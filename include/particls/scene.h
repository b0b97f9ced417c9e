/// @file scene.h
/// Scene files: YAML in, a world and its observers out. Keys: docs/scene.md, made from the same table the reader uses.
#ifndef PARTICLS_SCENE_H
#define PARTICLS_SCENE_H

#include <particls/observe.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct pls_scene pls_scene;

/// Read and check a scene file. `overrides` are `path=value` texts ("vars.kn=30", "time.end=2", "bodies[0].scale=2"), may be null when `override_count` is 0.
/// SCENE errors read "file:line:column: what", then the source line with a mark under the place, then what to do.
pls_status pls_scene_load(const char *path, const char *const *overrides, size_t override_count, pls_scene **scene);
void pls_scene_free(pls_scene *scene);

/// Make the world (not yet prepared) the scene describes.
pls_status pls_scene_build(pls_scene *scene, pls_world **world);

/// Observers of the scene, owned by the scene.
const pls_observer_def *pls_scene_observers(const pls_scene *scene, size_t *count);
/// Shapes of the scene in its order, owned by the scene; `*name` (may be null) as in the scene.
size_t pls_scene_shape_count(const pls_scene *scene);
const pls_shape *pls_scene_get_shape(const pls_scene *scene, size_t k, const char **name);
/// `time: end` [s].
double pls_scene_end_time(const pls_scene *scene);
const char *pls_scene_title(const pls_scene *scene);
const char *pls_scene_path(const pls_scene *scene);
/// Hash of the scene with every value in force; the same scene gives the same hash.
uint64_t pls_scene_hash(const pls_scene *scene);
/// Files the scene reads (plugins, tables, meshes), as written in the scene, resolved against its folder.
size_t pls_scene_input_count(const pls_scene *scene);
const char *pls_scene_input(const pls_scene *scene, size_t k);

/// The whole scene with every value in force, defaults included, as YAML text that loads to the same scene from any folder (input files by absolute path).
/// Release with pls_scene_free_text.
pls_status pls_scene_used_text(const pls_scene *scene, char **text);
/// JSON Schema (draft 2020-12) of scene files.
pls_status pls_scene_json_schema(char **text);
/// The reference page docs/scene.md.
pls_status pls_scene_reference(char **text);
/// What a plugin brings, with tables of parameters and columns, as Markdown. SCENE says why it cannot be used.
pls_status pls_plugin_reference(const char *path, char **text);
void pls_scene_free_text(char *text);

#ifdef __cplusplus
}
#endif
#endif
