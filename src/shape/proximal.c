// proximal.c -- the proximal map from an SDF alone.
//
// Outside, beyond `step`, it is a step back along the gradient. A step back is right inside as well if phi falls by all of `step` on the way, as no function of slope 1
// can fall more. Where it falls less a ridge was crossed, and the answer lies on it or near: there phi is replaced by the largest of planes that touch it from
// below (Kelley's cutting planes, with the quadratic term: a bundle method, Lemarechal 1975). For a polytope these are its faces, and the answer is exact once those that matter are
// found. The least value over planes is a quadratic programme of at most four weights; as in GJK only planes with a weight are kept, since each new plane
// raises the bound.

#include "shape/proximal.h"

enum { MOST_CUTS = 100, KEPT = 4 };
static const double round_off = 1e-15; // of the size

/// Weights of cuts at[0..count) with which all are equally high at Y = X - step (sum of weight slope). False: they depend on each other, or a weight is negative.
static bool balance(const pls_cut *cut, const int *at, int count, double step, double weight[KEPT])
{
    double L[KEPT][KEPT] = {{0.0}}, z[KEPT] = {0.0};
    pls_vec3 first = cut[at[0]].slope, d[KEPT];
    for (int i = 1; i < count; ++i)
    {
        d[i] = pls_sub(cut[at[i]].slope, first);
        z[i] = (cut[at[i]].value - cut[at[0]].value) / step - pls_dot(d[i], first);
    }
    for (int i = 1; i < count; ++i)
        for (int j = 1; j <= i; ++j)
        {
            double sum = pls_dot(d[i], d[j]);
            for (int k = 1; k < j; ++k) sum -= L[i][k] * L[j][k];
            if (i == j && !(sum > 1e-14 * pls_dot(d[i], d[i]))) return false;
            L[i][j] = i == j ? sqrt(sum) : sum / L[j][j];
        }
    for (int i = 1; i < count; ++i)
    {
        for (int k = 1; k < i; ++k) z[i] -= L[i][k] * z[k];
        z[i] /= L[i][i];
    }
    weight[0] = 1.0;
    for (int i = count - 1; i > 0; --i)
    {
        weight[i] = z[i];
        for (int k = i + 1; k < count; ++k) weight[i] -= L[k][i] * weight[k];
        weight[i] /= L[i][i];
        weight[0] -= weight[i];
        if (weight[i] < 0.0) return false;
    }
    return weight[0] >= 0.0;
}

bool pls_cut_model_add(pls_cut_model *model, pls_cut cut, double step)
{
    const int old = model->count;
    pls_cut all[KEPT + 1];
    pls_cut_model best = *model;
    bool better = false;
    for (int k = 0; k < old; ++k) all[k] = model->cut[k];
    all[old] = cut;
    for (int set = 0; set < 1 << old; ++set) // all sets of cuts that hold the new one
    {
        int at[KEPT + 1] = {old}, count = 1;
        double weight[KEPT], value = 0.0;
        pls_vec3 slope = {0.0, 0.0, 0.0};
        for (int k = 0; k < old; ++k)
            if (set >> k & 1) at[count++] = k;
        if (count > KEPT || !balance(all, at, count, step, weight)) continue;
        for (int k = 0; k < count; ++k)
        {
            slope = pls_add(slope, pls_scale(all[at[k]].slope, weight[k]));
            value += weight[k] * all[at[k]].value;
        }
        double square = step * pls_dot(slope, slope), least = value - 0.5 * square;
        if ((old > 0 || better) && !(least > best.least)) continue;
        best = (pls_cut_model){.count = count, .slope = slope, .value = value - square, .least = least};
        for (int k = 0; k < count; ++k) best.cut[k] = all[at[k]];
        better = true;
    }
    *model = best;
    return better;
}

pls_vec3 pls_proximal_from_sdf(const pls_shape *shape, pls_vec3 X, double step)
{
    const double size = isfinite(shape->size) ? shape->size : step;
    double phi = pls_shape_sdf(shape, X);
    pls_vec3 g = pls_shape_gradient(shape, X), Y = pls_sub(X, pls_scale(g, step));
    if (phi >= step) return Y;
    pls_cut_model model = {.count = 0};
    pls_cut_model_add(&model, (pls_cut){g, phi}, step);
    for (int k = 0; k < MOST_CUTS; ++k)
    {
        double at_Y = pls_shape_sdf(shape, Y);
        if (!(at_Y - model.value > round_off * size)) break;
        g = pls_shape_gradient(shape, Y);
        if (!pls_cut_model_add(&model, (pls_cut){g, at_Y + pls_dot(g, pls_sub(X, Y))}, step)) break;
        Y = pls_sub(X, pls_scale(model.slope, step));
    }
    return Y;
}

pls_vec3 pls_shape_proximal(const pls_shape *shape, pls_vec3 X, double step)
{
    return shape->ops->proximal ? shape->ops->proximal(shape, X, step) : pls_proximal_from_sdf(shape, X, step);
}
