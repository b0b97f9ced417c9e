// camera.c -- from pixels to rays, and from bodies to the pixels they may cover.
//
// The shadow that a sphere throws from the eye onto the picture is an ellipse; its extent follows exactly from the two tangents in the plane of each axis of the picture
// (Mara & McGuire, 2D polyhedral bounds of a clipped, perspective-projected 3D sphere, JCGT 2(2), 2013).

#include "render/render.h"

pls_status pls_render_view_make(const pls_render_camera *camera, int width, int height, pls_render_view *view)
{
    pls_vec3 forward = pls_sub(camera->target, camera->eye), right = pls_cross(forward, camera->up);
    double reach = pls_length(forward), side = pls_length(right), up = pls_length(camera->up);
    bool orthographic = camera->field_of_view == 0.0;
    if (!(reach > 0.0) || !isfinite(reach) || !(side > 1e-9 * reach * up))
        return pls_fail(
            PLS_INVALID_ARGUMENT,
            "the camera at (%g, %g, %g) m looks at (%g, %g, %g) m with (%g, %g, %g) upwards: eye and target must differ, and up "
            "must not lie along the view",
            camera->eye.x, camera->eye.y, camera->eye.z, camera->target.x, camera->target.y, camera->target.z, camera->up.x, camera->up.y,
            camera->up.z);
    if (!(camera->field_of_view >= 0.0 && camera->field_of_view < 0.99 * M_PI))
        return pls_fail(PLS_INVALID_ARGUMENT, "the camera's field of view is %g rad; give 0 (orthographic) to 3.1", camera->field_of_view);
    if (orthographic && !(camera->height > 0.0 && isfinite(camera->height)))
        return pls_fail(PLS_INVALID_ARGUMENT, "an orthographic camera shows a height of %g m; give more than 0", camera->height);
    *view = (pls_render_view){.eye = camera->eye, .width = width, .height = height, .orthographic = orthographic};
    view->forward = pls_scale(forward, 1.0 / reach);
    view->right = pls_scale(right, 1.0 / side);
    view->up = pls_cross(view->right, view->forward);
    view->half_height = orthographic ? 0.5 * camera->height : tan(0.5 * camera->field_of_view);
    view->half_width = view->half_height * width / height;
    return PLS_OK;
}

pls_render_ray pls_render_view_ray(const pls_render_view *view, double x, double y)
{
    double u = (2.0 * x / view->width - 1.0) * view->half_width, v = (1.0 - 2.0 * y / view->height) * view->half_height;
    pls_vec3 across = pls_add(pls_scale(view->right, u), pls_scale(view->up, v));
    if (view->orthographic) return (pls_render_ray){pls_add(view->eye, across), view->forward};
    return (pls_render_ray){view->eye, pls_unit(pls_add(view->forward, across))};
}

/// Between which tangents a circle lies that is `along` before and `across` beside the eye; false: behind.
static bool tangents(double along, double across, double radius, double *low, double *high)
{
    double distance = hypot(along, across);
    *low = -INFINITY;
    *high = INFINITY;
    if (distance <= radius) return true;
    if (along <= -radius) return false;
    double angle = atan2(across, along), half = asin(radius / distance);
    if (angle - half > -0.4999 * M_PI) *low = tan(fmin(angle - half, 0.4999 * M_PI));
    if (angle + half < 0.4999 * M_PI) *high = tan(fmax(angle + half, -0.4999 * M_PI));
    return true;
}

/// Pixels from `low` to `high` of a picture that reaches from -half to half; a pixel is added on either side for round-off.
static bool cover(double low, double high, double half, int pixels, int *first, int *last)
{
    double a = (low / half + 1.0) * 0.5 * pixels - 1.0, b = (high / half + 1.0) * 0.5 * pixels + 1.0;
    if (!(a < pixels && b >= 0.0)) return false;
    *first = a > 0.0 ? (int)a : 0;
    *last = b < pixels - 1 ? (int)b : pixels - 1;
    return true;
}

bool pls_render_view_extent(const pls_render_view *view, pls_vec3 centre, double radius, int extent[4])
{
    pls_vec3 c = pls_sub(centre, view->eye);
    double x = pls_dot(c, view->right), y = pls_dot(c, view->up), z = pls_dot(c, view->forward);
    double left = x - radius, right = x + radius, bottom = y - radius, top = y + radius;
    if (!view->orthographic && !tangents(z, x, radius, &left, &right)) return false;
    if (!view->orthographic && !tangents(z, y, radius, &bottom, &top)) return false;
    return cover(left, right, view->half_width, view->width, &extent[0], &extent[2]) &&
           cover(-top, -bottom, view->half_height, view->height, &extent[1], &extent[3]);
}

double pls_render_view_depth(const pls_render_view *view, pls_vec3 centre, double radius)
{
    pls_vec3 c = pls_sub(centre, view->eye);
    return (view->orthographic ? pls_dot(c, view->forward) : pls_length(c)) - radius;
}

static double radius_of(const pls_render_item *item) { return item->radius > 0.0 ? item->radius : item->shape->radius * item->scale; }

/// The middle of the box around all bounded, visible items, and half its diagonal; 0: there are none.
static double reach_of(const pls_render_item *items, size_t count, pls_vec3 *middle)
{
    pls_vec3 lower = pls_vec(INFINITY, INFINITY, INFINITY), upper = pls_vec(-INFINITY, -INFINITY, -INFINITY);
    for (size_t k = 0; k < count; ++k)
    {
        if (items[k].shape->ops->unbounded || !(items[k].opacity > 0.0f)) continue;
        pls_vec3 p = items[k].position;
        double r = radius_of(&items[k]);
        lower = pls_vec(fmin(lower.x, p.x - r), fmin(lower.y, p.y - r), fmin(lower.z, p.z - r));
        upper = pls_vec(fmax(upper.x, p.x + r), fmax(upper.y, p.y + r), fmax(upper.z, p.z + r));
    }
    *middle = pls_scale(pls_add(lower, upper), 0.5);
    return lower.x <= upper.x ? 0.5 * pls_length(pls_sub(upper, lower)) : 0.0;
}

// ---- framing ----------------------------------------------------------------------------------------------------------------------------
//
// A ball of radius r at (x, y, z) along right, up and forward lies left of the plane through the eye, a way D behind the origin, at the tangent T to the right if
// z + D >= x / T + r sqrt(1 + 1/T^2): a lower bound of D, linear in the eye's own place. The largest bounds of both sides then give the eye's place between them. In an
// orthographic picture the bounds are the silhouettes' ends themselves.

static const double border = 1.05; ///< the picture is so much larger than what it must show

/// Tangents of the parts of the picture that bodies may fill; of half its height in an orthographic one.
typedef struct sides
{
    double left, right, high;
} sides;

static sides sides_of(const pls_render_framing *f)
{
    double high = f->field_of_view > 0.0 ? tan(0.5 * f->field_of_view) : 1.0;
    return (sides){high * f->aspect * f->left_part, high * f->aspect * f->right_part, high * f->height_part};
}

pls_render_framing pls_render_framing_start(pls_vec3 direction, pls_vec3 up, double field_of_view, const pls_render_options *options)
{
    pls_render_framing f = {
        .field_of_view = field_of_view, .left_part = 1.0 / border, .right_part = 1.0 / border, .height_part = 1.0 / border};
    f.forward = pls_unit(direction);
    f.right = pls_unit(pls_cross(f.forward, up));
    f.up = pls_cross(f.right, f.forward);
    f.aspect = (double)options->width / options->height;
    if (options->bar) f.right_part = fmax(1.0 - 2.0 * pls_render_bar_strip(options) / options->width, 0.1) / border;
    return f;
}

static double bound(double across, double along, double radius, double tangent, bool orthographic)
{
    return orthographic ? across + radius : across / tangent + radius * sqrt(1.0 + 1.0 / (tangent * tangent)) - along;
}

/// How far to the right, left, top, bottom and back something reaches.
typedef struct ends
{
    double value[5];
} ends;

static ends ends_of_ball(const pls_render_framing *f, const sides *t, pls_vec3 centre, double r)
{
    bool flat = f->field_of_view == 0.0;
    double x = pls_dot(centre, f->right), y = pls_dot(centre, f->up), z = pls_dot(centre, f->forward);
    return (ends){{bound(x, z, r, t->right, flat), bound(-x, z, r, t->left, flat), bound(y, z, r, t->high, flat),
                   bound(-y, z, r, t->high, flat), r - z}};
}

static void widen(pls_render_framing *f, const ends *e)
{
    double *const to[5] = {&f->right_end, &f->left_end, &f->high_end, &f->low_end, &f->near_end};
    for (int k = 0; k < 5; ++k) *to[k] = f->any ? fmax(*to[k], e->value[k]) : e->value[k];
    f->any = true;
}

/// The shape's box, corner by corner. Both it and the bounding sphere hold the body, so the lesser of their ends does.
static void narrow_to_box(const pls_render_framing *f, const sides *t, const pls_render_item *item, ends *e)
{
    const pls_shape *shape = item->shape;
    pls_quat turn = pls_quat_multiply(item->orientation, pls_quat_conjugate(shape->principal));
    ends box = {{-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY}};
    for (int k = 0; k < 8; ++k)
    {
        pls_vec3 X = pls_vec(k & 1 ? shape->upper.x : shape->lower.x, k & 2 ? shape->upper.y : shape->lower.y,
                             shape->dimension == 2 ? 0.0
                             : k & 4               ? shape->upper.z
                                                   : shape->lower.z);
        pls_vec3 p = pls_add(item->position, pls_scale(pls_rotate(turn, pls_sub(X, shape->mass.centre)), item->scale));
        ends corner = ends_of_ball(f, t, p, 0.0);
        for (int j = 0; j < 5; ++j) box.value[j] = fmax(box.value[j], corner.value[j]);
    }
    for (int j = 0; j < 5; ++j) e->value[j] = fmin(e->value[j], box.value[j]);
}

static void add_item(pls_render_framing *f, const sides *t, const pls_render_item *item)
{
    ends e = ends_of_ball(f, t, item->position, radius_of(item));
    narrow_to_box(f, t, item, &e);
    widen(f, &e);
}

enum { MOST_WALLS = 12 }; ///< of which corners are looked for

typedef struct wall
{
    pls_vec3 normal, point;
} wall;

/// Where three planes meet, if that is a corner of the space before them all and not much further from `middle` than the bodies are.
static void add_corner(pls_render_framing *f, const sides *t, const wall *walls, int count, const wall *const w[3], pls_vec3 middle,
                       double reach)
{
    pls_vec3 bc = pls_cross(w[1]->normal, w[2]->normal), ca = pls_cross(w[2]->normal, w[0]->normal),
             ab = pls_cross(w[0]->normal, w[1]->normal);
    double det = pls_dot(w[0]->normal, bc);
    if (fabs(det) < 1e-6) return;
    pls_vec3 p = pls_add(pls_scale(bc, pls_dot(w[0]->normal, w[0]->point)),
                         pls_add(pls_scale(ca, pls_dot(w[1]->normal, w[1]->point)), pls_scale(ab, pls_dot(w[2]->normal, w[2]->point))));
    p = pls_scale(p, 1.0 / det);
    if (pls_length(pls_sub(p, middle)) > 1.5 * reach) return;
    for (int k = 0; k < count; ++k)
    {
        if (pls_dot(walls[k].normal, pls_sub(p, walls[k].point)) < -1e-6 * reach) return;
    }
    ends corner = ends_of_ball(f, t, p, 0.0);
    widen(f, &corner);
}

static void add_corners(pls_render_framing *f, const sides *t, const pls_render_item *items, size_t count)
{
    wall walls[MOST_WALLS];
    int n = 0;
    for (size_t k = 0; k < count && n < MOST_WALLS; ++k)
    {
        if (items[k].shape->ops->unbounded && items[k].shape->dimension == 3 && items[k].opacity > 0.0f)
        {
            pls_render_plane_of(&items[k], &walls[n].normal, &walls[n].point);
            ++n;
        }
    }
    pls_vec3 middle;
    double reach = n >= 3 ? reach_of(items, count, &middle) : 0.0;
    for (int a = 0; a < n && reach > 0.0; ++a)
    {
        for (int b = 0; b < a; ++b)
        {
            for (int c = 0; c < b; ++c) add_corner(f, t, walls, n, (const wall *const[3]){&walls[a], &walls[b], &walls[c]}, middle, reach);
        }
    }
}

void pls_render_framing_add(pls_render_framing *f, const pls_render_item *items, size_t count)
{
    sides t = sides_of(f);
    for (size_t k = 0; k < count; ++k)
    {
        if (!items[k].shape->ops->unbounded && items[k].opacity > 0.0f) add_item(f, &t, &items[k]);
    }
    add_corners(f, &t, items, count);
}

static pls_render_camera orthographic_camera(const pls_render_framing *f)
{
    sides t = sides_of(f);
    double wide = f->left_end + f->right_end, tall = f->high_end + f->low_end, half = fmax(wide / (t.left + t.right), 0.5 * tall / t.high);
    // The middle of the bodies stands in the middle of what they may fill.
    double x = 0.5 * (f->right_end - f->left_end) - 0.5 * (t.right - t.left) * half, y = 0.5 * (f->high_end - f->low_end);
    pls_render_camera camera = {.up = f->up, .height = 2.0 * half};
    pls_vec3 across = pls_add(pls_scale(f->right, x), pls_scale(f->up, y));
    camera.eye = pls_sub(across, pls_scale(f->forward, f->near_end + half));
    camera.target = pls_add(camera.eye, pls_scale(f->forward, half));
    return camera;
}

pls_render_camera pls_render_framing_end(const pls_render_framing *framing)
{
    pls_render_framing f = *framing;
    if (!f.any) // nothing to show: a metre about the origin
    {
        sides t = sides_of(&f);
        f.right_end = bound(0.0, 0.0, 1.0, t.right, f.field_of_view == 0.0);
        f.left_end = f.right_end;
        f.high_end = f.low_end = bound(0.0, 0.0, 1.0, t.high, f.field_of_view == 0.0);
    }
    if (f.field_of_view == 0.0) return orthographic_camera(&f);
    sides t = sides_of(&f);
    double x = (f.right_end - f.left_end) / (1.0 / t.right + 1.0 / t.left), y = 0.5 * (f.high_end - f.low_end) * t.high;
    double away = fmax(f.right_end - x / t.right, f.high_end - y / t.high);
    pls_render_camera camera = {.up = f.up, .field_of_view = f.field_of_view};
    camera.eye = pls_sub(pls_add(pls_scale(f.right, x), pls_scale(f.up, y)), pls_scale(f.forward, away));
    camera.target = pls_add(camera.eye, pls_scale(f.forward, fmax(fabs(away), 1e-3)));
    return camera;
}

pls_render_camera pls_render_fit(const pls_render_item *items, size_t count, pls_vec3 direction, pls_vec3 up, double field_of_view,
                                 const pls_render_options *options)
{
    pls_render_framing framing = pls_render_framing_start(direction, up, field_of_view, options);
    pls_render_framing_add(&framing, items, count);
    return pls_render_framing_end(&framing);
}
