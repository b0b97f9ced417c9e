// solid_volume.c -- the volume of a grain inside a box, by halving cells along their longest edge until the signed distance at a cell's
// centre says that it is full or empty. Cells that are still cut when they are small are filled as a flat surface at that distance
// would fill them. Works for any shape because a signed distance is all it asks; corners and edges of the box need no special case
// because the cells fill the box exactly. Balls and discs cut by faces alone, nearly all there are in a packing, lose exact caps
// instead.

#include "observe/solid_volume.h"

static const double pi = 3.14159265358979323846;

/// Edges of the smallest cells as a fraction of the bounding radius: the error of the whole falls with the square of it. A disc can
/// have finer ones.
static const double smallest_cell_3d = 1.0 / 16;
static const double smallest_cell_2d = 1.0 / 128;

typedef struct cell
{
    double centre[3]; ///< [m]
    double half[3];   ///< half the edges [m]; 2D: half[2] is zero
} cell;

static double signed_distance(const pls_solid *solid, const double centre[3])
{
    pls_vec3 x = pls_sub(pls_vec(centre[0], centre[1], centre[2]), solid->position);
    pls_vec3 own = pls_shape_from_body(solid->shape, pls_scale(pls_rotate_back(solid->orientation, x), 1 / solid->scale));
    return solid->scale * pls_shape_sdf(solid->shape, own);
}

static double cell_volume(const cell *c, int dimension)
{
    double area = 4 * c->half[0] * c->half[1];
    return dimension == 3 ? area * 2 * c->half[2] : area;
}

static int longest_edge(const cell *c)
{
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis)
    {
        if (c->half[axis] > c->half[longest]) longest = axis;
    }
    return longest;
}

/// Part of a small cell that is solid: a column along the axis that crosses the surface most directly, filled up to the mean of the
/// distance over the cell (centre value and second differences), which takes care of the surface's curvature.
static double part_filled(const pls_solid *solid, const cell *c, double distance)
{
    double most = 0; // change of the distance from the centre to the end of the column
    double mean = distance;
    for (int axis = 0; axis < solid->dimension; ++axis)
    {
        double at[3] = {c->centre[0], c->centre[1], c->centre[2]};
        at[axis] = c->centre[axis] + c->half[axis] / 2;
        double ahead = signed_distance(solid, at);
        at[axis] = c->centre[axis] - c->half[axis] / 2;
        double behind = signed_distance(solid, at);
        most = fmax(most, fabs(ahead - behind));
        mean += 2.0 / 3 * (ahead - 2 * distance + behind); // (half^2 / 6) d2/dx2
    }
    return most > 0 ? fmin(fmax(0.5 - mean / (2 * most), 0), 1) : distance < 0;
}

static double filled(const pls_solid *solid, cell c, double smallest_half)
{
    double distance = signed_distance(solid, c.centre);
    double reach = sqrt(c.half[0] * c.half[0] + c.half[1] * c.half[1] + c.half[2] * c.half[2]);
    if (distance >= reach) return 0;
    if (distance <= -reach) return cell_volume(&c, solid->dimension);
    int axis = longest_edge(&c);
    if (c.half[axis] <= smallest_half)
    {
        return cell_volume(&c, solid->dimension) * part_filled(solid, &c, distance);
    }
    c.half[axis] /= 2;
    cell other = c;
    c.centre[axis] -= c.half[axis];
    other.centre[axis] += c.half[axis];
    return filled(solid, c, smallest_half) + filled(solid, other, smallest_half);
}

/// Volume of a ball (2D: area of a disc) beyond a plane at `distance` from its centre, -radius <= distance <= radius.
static double cap_volume(double radius, double distance, int dimension)
{
    double height = radius - distance;
    if (dimension == 3) return pi * height * height * (3 * radius - height) / 3;
    return radius * radius * acos(distance / radius) - distance * sqrt(height * (radius + distance));
}

/// The faces that cut a ball, as distances from its centre, positive where the centre lies on the inner side.
typedef struct cuts
{
    double distance[6];
    int count;
} cuts;

/// True when no two of the caps that the faces cut off overlap, so that their volumes add up.
static bool caps_are_apart(const cuts *cut, double radius)
{
    if (cut->count == 1) return true;
    for (int i = 0; i < cut->count; ++i)
    {
        if (cut->distance[i] < 0) return false;
        for (int j = 0; j < i; ++j)
        {
            if (hypot(cut->distance[i], cut->distance[j]) < radius) return false; // the edge of the box passes through the ball
        }
    }
    return true;
}

/// Only a ball has the volume of its bounding sphere.
static bool is_ball(const pls_solid *solid)
{
    double r = solid->radius;
    double volume = solid->dimension == 3 ? 4.0 / 3 * pi * r * r * r : pi * r * r;
    return fabs(solid->volume - volume) <= 1e-12 * volume;
}

double pls_solid_volume_in_box(const pls_solid *solid, pls_vec3 lower, pls_vec3 upper)
{
    const double from[3] = {lower.x, lower.y, lower.z};
    const double to[3] = {upper.x, upper.y, upper.z};
    const double position[3] = {solid->position.x, solid->position.y, solid->position.z};
    const double radius = solid->radius;
    cell c = {{0, 0, position[2]}, {0, 0, 0}};
    cuts cut = {.count = 0};
    for (int axis = 0; axis < solid->dimension; ++axis)
    {
        double below = position[axis] - from[axis];
        double above = to[axis] - position[axis];
        if (!(below > -radius && above > -radius)) return 0;
        if (below < radius) cut.distance[cut.count++] = below;
        if (above < radius) cut.distance[cut.count++] = above;
        double first = position[axis] - fmin(below, radius);
        double last = position[axis] + fmin(above, radius);
        c.centre[axis] = (first + last) / 2;
        c.half[axis] = (last - first) / 2;
    }
    if (cut.count == 0) return solid->volume;
    if (is_ball(solid) && caps_are_apart(&cut, radius))
    {
        double volume = solid->volume;
        for (int k = 0; k < cut.count; ++k) volume -= cap_volume(radius, cut.distance[k], solid->dimension);
        return volume;
    }
    double smallest = solid->dimension == 3 ? smallest_cell_3d : smallest_cell_2d;
    return filled(solid, c, smallest * radius / 2);
}
