// render.h -- parts of particls render: its options as read, and the pictures they make.
#ifndef PLS_CLI_RENDER_H
#define PLS_CLI_RENDER_H

#include "cli.h"

#include "run/gallery.h"
#include "run/paint.h"

enum { RENDER_MOST_WORDS = 256, RENDER_PATH_SIZE = 4096 };

typedef enum render_series { RENDER_ONE, RENDER_EACH, RENDER_ANIMATION } render_series;

/// The command line. Options of the picture itself go right into `picture`.
typedef struct render_arguments
{
    const char *path, *output;
    const char *overrides[RENDER_MOST_WORDS], *hide[RENDER_MOST_WORDS];
    pls_gallery_def gallery;
    pls_gallery_look look;
    pls_render_options picture;
    const char *colour; ///< null: chosen
    bool has_range, has_map, has_frame, has_camera, orthographic, no_bar, quiet;
    double low, high, time, fps, zoom; ///< `time` NaN: not given
    long frame;                        ///< from 0; negative: from the last
    pls_vec3 direction, up;            ///< of the view; zero: the usual one
    pls_render_camera camera;          ///< if has_camera
    render_series series;
} render_arguments;

extern const cli_verb cli_render;

/// From the middle to the eye, when nothing else is asked for.
#define RENDER_ISO      \
    {                   \
        0.55, -1.0, 0.5 \
    }

/// Set direction and up for an eye on this side of the middle.
void render_look_from(render_arguments *a, pls_vec3 side);
/// Read one option; false when it was wrong, which is then told.
bool render_read_option(render_arguments *a, int option, const char *value);
extern const cli_option render_options[];

#endif
