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

/// The middle of the box around all bounded items, and how far they reach from it.
static double reach_of(const pls_render_item *items, size_t count, pls_vec3 *middle)
{
    pls_vec3 lower = pls_vec(INFINITY, INFINITY, INFINITY), upper = pls_vec(-INFINITY, -INFINITY, -INFINITY);
    for (size_t k = 0; k < count; ++k)
    {
        if (items[k].shape->ops->unbounded) continue;
        pls_vec3 p = items[k].position;
        double r = radius_of(&items[k]);
        lower = pls_vec(fmin(lower.x, p.x - r), fmin(lower.y, p.y - r), fmin(lower.z, p.z - r));
        upper = pls_vec(fmax(upper.x, p.x + r), fmax(upper.y, p.y + r), fmax(upper.z, p.z + r));
    }
    *middle = pls_vec(0.0, 0.0, 0.0);
    if (!(lower.x <= upper.x)) return 1.0;
    *middle = pls_scale(pls_add(lower, upper), 0.5);
    double reach = 0.0;
    for (size_t k = 0; k < count; ++k)
    {
        if (!items[k].shape->ops->unbounded) reach = fmax(reach, pls_length(pls_sub(items[k].position, *middle)) + radius_of(&items[k]));
    }
    return reach;
}

pls_render_camera pls_render_fit(const pls_render_item *items, size_t count, pls_vec3 direction, pls_vec3 up, double field_of_view,
                                 double aspect)
{
    const double border = 1.05;
    pls_render_camera camera = {.up = up, .field_of_view = field_of_view};
    double reach = border * reach_of(items, count, &camera.target), narrow = fmin(aspect, 1.0);
    double half = field_of_view > 0.0 ? atan(narrow * tan(0.5 * field_of_view)) : 0.0;
    camera.height = 2.0 * reach / narrow;
    camera.eye = pls_sub(camera.target, pls_scale(pls_unit(direction), half > 0.0 ? reach / sin(half) : 2.0 * reach));
    return camera;
}
