// gallery.h -- what can be drawn of a path: a scene before its first step, the frames or checkpoints of a run directory, or one of these files.
//
// Shapes and names come from the scene, which a run directory keeps as scene.used.yaml; where bodies are comes from the file.
#ifndef PLS_RUN_GALLERY_H
#define PLS_RUN_GALLERY_H

#include "io/frame.h"
#include "render/render.h"

#include <particls/scene.h>

typedef enum pls_moment_kind { PLS_MOMENT_START, PLS_MOMENT_FRAME, PLS_MOMENT_CHECKPOINT } pls_moment_kind;

typedef struct pls_moment
{
    pls_moment_kind kind;
    char *path;  ///< of the frame or checkpoint
    double time; ///< [s]; NaN where it is known only when it is read
} pls_moment;

/// What to look at. All zero: the obvious.
typedef struct pls_gallery_def
{
    const char *const *overrides; ///< of a scene's values, as for pls_scene_load
    size_t override_count;
    const char *frames; ///< the frames observer whose frames are meant; null: the only one
    bool forces;        ///< find the forces at the start of a scene (pls_world_prepare), which can fail where the scene cannot run
} pls_gallery_def;

/// Zero-initialise; `pls_gallery_free` releases.
typedef struct pls_gallery
{
    pls_gallery_def def;
    pls_scene *scene;
    pls_moment *moment; ///< in order of time
    size_t count, capacity;
} pls_gallery;

/// Never without a moment: NOT_FOUND when there is nothing to draw.
pls_status pls_gallery_open(pls_gallery *gallery, const char *path, const pls_gallery_def *def);
/// The bodies at moment k. End with pls_frame_free.
pls_status pls_gallery_load(const pls_gallery *gallery, size_t k, pls_frame *frame);
/// The moment nearest to a time.
size_t pls_gallery_nearest(const pls_gallery *gallery, double time);
void pls_gallery_free(pls_gallery *gallery);

int pls_gallery_dimension(const pls_gallery *gallery);

/// How things stand in a picture.
typedef struct pls_gallery_look
{
    float wall_opacity;      ///< 0: none
    const char *const *hide; ///< entries of the scene that are not drawn
    size_t hide_count;
} pls_gallery_look;

/// All of a frame as items without values: first its bodies, row by row, then its walls. What is hidden has no opacity. Release `*items`.
/// NOT_FOUND when a frame lacks a field that is needed, or there is no entry of a name to be hidden.
pls_status pls_gallery_items(const pls_gallery *gallery, const pls_frame *frame, const pls_gallery_look *look, pls_render_item **items,
                             size_t *count);

#endif
