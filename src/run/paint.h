// paint.h -- what the colours of a picture tell: a field of the bodies, its component or magnitude, its range and its names.
#ifndef PLS_RUN_PAINT_H
#define PLS_RUN_PAINT_H

#include "run/gallery.h"

/// Zero-initialise; `pls_paint_free` releases.
typedef struct pls_paint
{
    char field[PLS_NAME_SIZE]; ///< "": all bodies in one colour
    int component;             ///< of the field; -1: the only one, or the magnitude of them all
    bool kinetic;              ///< kinetic energy, from several fields
    bool categorical;          ///< names, not numbers
    const char **label;        ///< of each category; the names live as long as the gallery
    double *category;          ///< of each id, from 0; NaN: none
    size_t label_count, id_count;
    const char *unit;
    char title[PLS_NAME_SIZE + 16];
    double low, high; ///< of the values seen so far; low > high: none yet
} pls_paint;

/// `colour` is a field ("velocity", "velocity.z", "group"), "energy" (kinetic), "none", or null for what tells most. `frame` is any moment of the gallery.
/// NOT_FOUND with a suggestion when there is no such field.
pls_status pls_paint_choose(pls_paint *paint, const pls_gallery *gallery, const pls_frame *frame, const char *colour);
void pls_paint_free(pls_paint *paint);

/// Give each body its value. CORRUPT when the frame does not hold the field.
pls_status pls_paint_apply(const pls_paint *paint, const pls_frame *frame, pls_render_item *items);
/// Widen the range by the values of what is visible.
void pls_paint_see(pls_paint *paint, const pls_render_item *items, size_t count);
/// Round off the range: magnitudes begin at zero, what has both signs is symmetric, and it is never empty.
void pls_paint_settle(pls_paint *paint);
/// The map that suits the values after settling.
pls_render_colours pls_paint_map(const pls_paint *paint);

#endif
