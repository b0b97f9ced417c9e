// links.c -- links made, and what needs no speed.

#include "bond/links.h"

#include "base/alloc.h"

#include <string.h>

void pls_links_free(pls_links *links)
{
    pls_release(&links->fixed);
    pls_release(&links->pose);
    memset(links, 0, sizeof *links);
}

size_t pls_links_bytes(const pls_links *links, const pls_families *family)
{
    if (!links->ops) return 0;
    return (size_t)family->start[family->count] * PLS_BOND_VECTOR * PLS_LINK_NUMBERS * sizeof *links->fixed +
           (family->count + family->ghosts) * sizeof *links->pose;
}

static pls_quat orientation_of(const double pose[8]) { return (pls_quat){pose[4], pose[5], pose[6], pose[7]}; }

/// A unit vector across n, the same for n and -n.
static pls_vec3 across(pls_vec3 n)
{
    const double a[3] = {fabs(n.x), fabs(n.y), fabs(n.z)};
    const int least = a[2] <= a[0] && a[2] <= a[1] ? 2 : a[1] <= a[0] ? 1 : 0;
    const pls_vec3 axis = pls_vec(least == 0, least == 1, least == 2);
    return pls_unit(pls_sub(axis, pls_scale(n, pls_dot(axis, n))));
}

static void put(double *fixed, size_t lane, int first, pls_vec3 v)
{
    fixed[8 * first + (int)lane] = v.x, fixed[8 * (first + 1) + (int)lane] = v.y, fixed[8 * (first + 2) + (int)lane] = v.z;
}

static void fix(pls_links *links, const pls_families *f, size_t p)
{
    for (size_t vector = f->start[p]; vector < f->start[p + 1]; ++vector)
        for (size_t lane = 0; lane < PLS_BOND_VECTOR; ++lane)
        {
            const double *own = links->pose[p], *other = links->pose[f->partner[vector * PLS_BOND_VECTOR + lane]];
            const pls_vec3 n = pls_unit(pls_vec(other[0] - own[0], other[1] - own[1], other[2] - own[2])), side = across(n);
            double *to = links->fixed + vector * PLS_BOND_VECTOR * PLS_LINK_NUMBERS;
            put(to, lane, 0, pls_rotate_back(orientation_of(own), n));
            put(to, lane, 3, pls_rotate_back(orientation_of(other), pls_scale(n, -1.0)));
            put(to, lane, 6, pls_rotate_back(orientation_of(own), side));
            put(to, lane, 9, pls_rotate_back(orientation_of(other), side));
        }
}

pls_status pls_links_make(pls_links *links, const pls_families *family, const pls_bodies *bodies, const pls_domain *domain)
{
    PLS_TRY(pls_allocate(&links->fixed, (size_t)family->start[family->count] * PLS_BOND_VECTOR * PLS_LINK_NUMBERS, sizeof *links->fixed,
                         "bonds"));
    PLS_TRY(pls_allocate(&links->pose, family->count + family->ghosts, sizeof *links->pose, "points of bonds"));
    pls_links_take_poses(links, family, bodies, 0, family->count);
    pls_links_take_ghosts(links, family, domain);
    for (size_t p = 0; p < family->count; ++p) fix(links, family, p);
    return PLS_OK;
}

void pls_links_take_poses(pls_links *links, const pls_families *family, const pls_bodies *bodies, size_t first, size_t last)
{
    for (size_t p = first; p < last; ++p)
    {
        const uint32_t row = bodies->row_of[family->point[p].number];
        if (row == PLS_NO_ROW) continue;
        const pls_body_place *place = &bodies->place[row];
        const pls_body_orientation *q = &bodies->orientation[row];
        const double pose[8] = {place->x, place->y, place->z, 0.0, q->w, q->x, q->y, q->z};
        memcpy(links->pose[p], pose, sizeof pose);
    }
}

void pls_links_take_ghosts(pls_links *links, const pls_families *family, const pls_domain *domain)
{
    for (size_t g = 0; g < family->ghosts; ++g)
    {
        double *to = links->pose[family->count + g];
        memcpy(to, links->pose[family->ghost[g].point], sizeof links->pose[0]);
        for (int a = 0; a < 3; ++a) to[a] += family->ghost[g].shift[a] * domain->edge[a];
    }
}

void pls_links_advance(pls_links *links, const pls_families *family, const pls_bodies *bodies, double time)
{
    for (size_t p = 0; p < family->count; ++p)
    {
        const uint32_t row = bodies->row_of[family->point[p].number];
        if (row == PLS_NO_ROW) continue;
        const pls_body_place *place = &bodies->place[row];
        const pls_body_spin *spin = &bodies->spin[row];
        double *pose = links->pose[p];
        pose[0] += time * place->vx, pose[1] += time * place->vy, pose[2] += time * place->vz;
        const pls_quat turn = {1.0, 0.5 * time * spin->wx, 0.5 * time * spin->wy, 0.5 * time * spin->wz};
        const pls_quat q = pls_quat_unit(pls_quat_multiply(turn, orientation_of(pose)));
        pose[4] = q.w, pose[5] = q.x, pose[6] = q.y, pose[7] = q.z;
    }
}

void pls_links_ask(const pls_links *links, size_t count, pls_link_work *w)
{
    pls_pair_batch batch = {.count = count,
                            .constants = links->constants,
                            .reference = w->reference,
                            .length = w->length,
                            .energy = w->energy,
                            .load = w->load};
    for (int c = 0; c < 3; ++c)
    {
        batch.unit[c] = w->unit[c];
        batch.force[c] = w->force[c];
        batch.torque[c] = w->torque[c];
        for (int end = 0; end < 2; ++end) batch.along[end][c] = w->along[end][c], batch.across[end][c] = w->across[end][c];
    }
    links->ops->pair(&batch);
}
