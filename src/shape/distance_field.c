// distance_field.c -- one octant (2D: quadrant) of values, the rest by symmetry, with quadratic B-splines between them: smoother than linear ones, whose gradients jump from cell to cell.

#include "shape/distance_field.h"

#include "base/alloc.h"

enum {
    CELLS = 24, ///< along the longest half axis
    LEAST = 8,  ///< along the shortest
    MORE = 3    ///< beyond what is known, to lend their values
};
static const double out = 0.15; ///< of the longest half axis: how far the field goes beyond the bounds

struct pls_distance_field
{
    float *value; ///< at (i + 1/2, j + 1/2, k + 1/2) cells from the middle; i runs fastest
    double spacing, reach;
    pls_vec3 half; ///< of the bounds [m]
    int side[3], dimension;
};

double pls_distance_field_reach(const pls_distance_field *f) { return f->reach; }

static pls_status fill(const pls_shape *shape, pls_distance_field *f)
{
    f->half = shape->upper, f->dimension = shape->dimension;
    const double half[3] = {f->half.x, f->half.y, f->half.z}, longest = fmax(half[0], fmax(half[1], half[2]));
    const double shortest = fmin(half[0], f->dimension == 2 ? half[1] : fmin(half[1], half[2]));
    f->spacing = fmin(longest / CELLS, shortest / LEAST), f->reach = out * longest;
    size_t count = 1;
    for (int a = 0; a < 3; ++a)
    {
        f->side[a] = a < f->dimension ? (int)ceil((half[a] + f->reach) / f->spacing) + MORE : 1;
        count *= (size_t)f->side[a];
    }
    PLS_TRY(pls_allocate(&f->value, count, sizeof *f->value, "distances of a shape"));
    float *next = f->value;
    for (int k = 0; k < f->side[2]; ++k)
        for (int j = 0; j < f->side[1]; ++j)
            for (int i = 0; i < f->side[0]; ++i)
            {
                const double z = f->dimension == 2 ? 0.0 : (k + 0.5) * f->spacing;
                *next++ = (float)pls_shape_sdf(shape, pls_vec((i + 0.5) * f->spacing, (j + 0.5) * f->spacing, z));
            }
    return PLS_OK;
}

pls_status pls_distance_field_make(const pls_shape *shape, pls_distance_field **result)
{
    pls_distance_field *f = NULL;
    *result = NULL;
    PLS_TRY(pls_allocate(&f, 1, sizeof *f, "distances of a shape"));
    pls_status status = fill(shape, f);
    if (status == PLS_OK)
        *result = f;
    else
        pls_distance_field_free(f);
    return status;
}

void pls_distance_field_free(pls_distance_field *f)
{
    if (!f) return;
    pls_release(&f->value);
    pls_release(&f);
}

/// The three values along one axis, their weights and the slopes of these.
typedef struct taps
{
    int at[3];
    double weight[3], slope[3];
} taps;

static inline taps taps_at(double x, double spacing)
{
    const double u = x / spacing;
    const int i = (int)u;
    const double t = u - (i + 0.5), less = 0.5 - t, more = 0.5 + t, by = 1.0 / spacing;
    return (taps){
        {i > 0 ? i - 1 : 0, i, i + 1}, {0.5 * less * less, 0.75 - t * t, 0.5 * more * more}, {-less * by, -2.0 * t * by, more * by}};
}

/// Of the nearest point of the bounds.
static double outside(const pls_distance_field *f, const double x[3])
{
    const double u = fmax(x[0] - f->half.x, 0.0), v = fmax(x[1] - f->half.y, 0.0), w = fmax(x[2] - f->half.z, 0.0);
    return sqrt(u * u + v * v + w * w);
}

double pls_distance_field_at(const pls_distance_field *f, pls_vec3 X, pls_vec3 *gradient)
{
    const double x[3] = {fabs(X.x), fabs(X.y), f->dimension == 2 ? 0.0 : fabs(X.z)};
    if (x[0] > f->half.x + f->reach || x[1] > f->half.y + f->reach || x[2] > f->half.z + f->reach)
    {
        if (gradient) *gradient = pls_vec(0.0, 0.0, 0.0);
        return outside(f, x);
    }
    const taps tx = taps_at(x[0], f->spacing), ty = taps_at(x[1], f->spacing),
               tz = f->dimension == 2 ? (taps){{0, 0, 0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}} : taps_at(x[2], f->spacing);
    const int layers = f->dimension == 2 ? 1 : 3;
    double sum = 0.0, slope[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < layers; ++k)
    {
        double plane = 0.0, plane_x = 0.0, plane_y = 0.0;
        for (int j = 0; j < 3; ++j)
        {
            const float *row = f->value + ((size_t)tz.at[k] * (size_t)f->side[1] + (size_t)ty.at[j]) * (size_t)f->side[0];
            const double a = row[tx.at[0]], b = row[tx.at[1]], c = row[tx.at[2]];
            const double line = tx.weight[0] * a + tx.weight[1] * b + tx.weight[2] * c;
            plane += ty.weight[j] * line;
            plane_x += ty.weight[j] * (tx.slope[0] * a + tx.slope[1] * b + tx.slope[2] * c);
            plane_y += ty.slope[j] * line;
        }
        sum += tz.weight[k] * plane;
        slope[0] += tz.weight[k] * plane_x, slope[1] += tz.weight[k] * plane_y, slope[2] += tz.slope[k] * plane;
    }
    if (gradient) *gradient = pls_vec(X.x < 0.0 ? -slope[0] : slope[0], X.y < 0.0 ? -slope[1] : slope[1], X.z < 0.0 ? -slope[2] : slope[2]);
    return sum;
}
