// solid_contact.c -- contacts of solids, one block of candidates at a time.
//
//     track      do the bounding volumes of the two parts overlap? If not, nothing is remembered of them
//     touch      the narrow phase: overlap, normal, contact point
//     group      pieces of a wall that a body lies over touch it as one (wall_groups.h)
//     shade      of several contacts of two bodies that push in one direction at one place (seams of compounds, edges within a mesh) only the deepest counts, and none
//                at points that belong to a deeper part, too
//     frame      velocities at the contact point, the spring carried into the frame of now
//     law        as for spheres, in batches
//     store      force and torque into the candidate's own slot
//     rock       where bodies touch over an area, what dashpots do against rocking
//
// Time. Dashpots see the velocities of the end of the step, springs the displacement of the middle, as for spheres (sphere_contact_simd.c): s += dt u_t with u the relative velocity of
// mid-step at the mid-step contact point. Spheres know that point in closed form; here it is the mean of the points (relative to each centre) of the last step and of now,
// and the normal is the mean of the two normals, both good to second order. The spring is carried along by the smallest rotation that takes the old normal to the new one, and
// turned about it by the angle of the pair's mean spin.
//
// Areas. Bodies that lie on each other with faces touch over an area (`spread` of pls_touch), others along a line, on which each place rubs and damps by itself. Turning about the normal is
// slip at a lever (`lever`): the third component of spring, slip velocity and shear force, along the normal, is that of turning, and the law treats all three as
// one vector. So turning has the stiffness, the dashpots and the energy of the law, and shares the cone with sliding: |Fs|^2 + (couple/lever)^2 <= (mu Fn)^2, the ellipsoid by
// which Howe & Cutkosky (1996) approximate the limit surface of sliding patches. Rocking about axes in the face: the law is asked for its normal force at four
// points with the area's second moments (pls_touch_corners) as they approach each other, and the couple of what differs acts. For a dashpot cn that is the integral of
// cn over the area by the area.

#include "contact/solid_contact.h"

#include "contact/overlap_record.h"
#include "contact/touch_area.h"
#include "contact/wall_groups.h"
#include "contact/wall_touch.h"
#include "math/small_turn.h"

#include <string.h>

static const double shade_angle = 0.96592582628906831; ///< cosine of 15 degrees: normals that agree
static const double shade_reach = 0.1; ///< of the smaller part's bounding radius: contact points nearer than this push at one place
static const double shade_gap = 1e-4;  ///< of the smaller part's bounding radius: a point nearer to a part than this belongs to it

// ---- poses --------------------------------------------------------------------------------------------------------------------------------------------------

void pls_solid_pose(pls_solid_list *list, const pls_contact_input *in, const pls_bodies *bodies, const pls_shape *const *shape,
                    size_t first, size_t last)
{
    for (size_t k = first; k < last; ++k)
    {
        uint32_t row = list->row[k];
        const pls_body_place *p = &in->place[row];
        const pls_body_orientation *q = &in->orientation[row];
        list->posed[row] =
            pls_pose(shape[bodies->kind[row].shape], pls_vec(p->x, p->y, p->z), (pls_quat){q->w, q->x, q->y, q->z}, bodies->scale[row]);
    }
}

static pls_vec3 shift_of(const pls_solid_pair *pair, const double edge[3])
{
    return pls_vec(pair->shift[0] * edge[0], pair->shift[1] * edge[1], pair->shift[2] * edge[2]);
}

void pls_solid_parts_of(const pls_solid_list *list, const pls_contact_input *in, size_t c, pls_solid_parts *out)
{
    const pls_solid_pair *pair = &list->pair[c];
    out->a = &list->posed[pair->row_i], out->b = &list->posed[pair->row_j];
    if (out->a->shape->part_count)
    {
        out->own[0] = pls_posed_part(out->a, list->memory[c].part_i);
        out->a = &out->own[0];
    }
    if (!out->b->shape->part_count && !in->domain->any_periodic) return;
    out->own[1] = pls_posed_part(out->b, list->memory[c].part_j);
    out->b = &out->own[1];
    if (in->domain->any_periodic) out->own[1].position = pls_add(out->b->position, shift_of(pair, in->domain->edge));
}

// ---- bounding volumes -------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 centre_of(const pls_posed *p) { return pls_posed_world(p, p->shape->mass.centre); }

/// Distance from an interval. (The library's fmax is a call.)
static inline double outside(double x, double lower, double upper)
{
    const double below = lower - x, above = x - upper, more = below > above ? below : above;
    return more > 0.0 ? more : 0.0;
}

/// Squared distance of a point from the box that bounds a part [m^2].
static double outside_box(const pls_posed *p, pls_vec3 X)
{
    const pls_vec3 own = pls_posed_own(p, X), lower = p->shape->lower, upper = p->shape->upper;
    const double x = outside(own.x, lower.x, upper.x), y = outside(own.y, lower.y, upper.y);
    const double z = p->shape->dimension == 2 ? 0.0 : outside(own.z, lower.z, upper.z);
    return (x * x + y * y + z * z) * p->scale * p->scale;
}

/// Lowest point of a part's box above a half-space [m].
static double height_of_box(const pls_posed *p, const pls_posed *plane)
{
    const pls_vec3 n = plane->shape->dimension == 2 ? plane->y : plane->z;
    const pls_vec3 own = pls_posed_turn_back(p, n), lower = p->shape->lower, upper = p->shape->upper;
    double least = fmin(own.x * lower.x, own.x * upper.x) + fmin(own.y * lower.y, own.y * upper.y);
    if (p->shape->dimension == 3) least += fmin(own.z * lower.z, own.z * upper.z);
    return pls_dot(n, pls_sub(p->position, plane->position)) + p->scale * least;
}

/// Do they come within `gap`?
static bool bounds_near(const pls_posed *a, const pls_posed *b, double gap)
{
    if (!isfinite(b->shape->radius)) // a half-space; corners of the box may reach further than the sphere, by which pairs are listed
    {
        const pls_vec3 n = b->shape->dimension == 2 ? b->y : b->z;
        return pls_dot(n, pls_sub(centre_of(a), b->position)) < a->size && height_of_box(a, b) < 0.0;
    }
    const pls_vec3 x = centre_of(a), y = centre_of(b), d = pls_sub(y, x);
    const double reach = a->size + b->size + gap, of_a = a->size + gap, of_b = b->size + gap;
    if (!(pls_dot(d, d) < reach * reach)) return false;
    return outside_box(b, x) < of_a * of_a && outside_box(a, y) < of_b * of_b;
}

static bool bounds_overlap(const pls_posed *a, const pls_posed *b) { return bounds_near(a, b, 0.0); }

// ---- touch ----------------------------------------------------------------------------------------------------------------------------------------------------

/// Has the centre of i crossed the surface of the half-space j?
static bool behind(const pls_solid_list *list, const pls_solid_pair *pair)
{
    const pls_posed *plane = &list->posed[pair->row_j];
    const pls_vec3 n = plane->shape->dimension == 2 ? plane->y : plane->z;
    return !(pls_dot(n, pls_sub(centre_of(&list->posed[pair->row_i]), plane->position)) > 0.0);
}

/// Contacts of faces that go on are mostly what their record says, without any search. Depths are not known then: laws that act at surfaces need them.
static bool spares_search(const pls_law *law, const pls_solid_pair *pair)
{
    return !law->lever_at_surface && law->narrow.faces != PLS_FACES_POINT && law->narrow.solver == PLS_SOLVER_DEPTH && !pair->lets_go;
}

/// What grouping facets goes by: the depth, or that there is none to know.
static void find_depth_on_wall(const pls_solid_parts *p, const pls_narrow_options *options, pls_pair_state *state, pls_touch *touch,
                               pls_narrow_counts *counts)
{
    pls_narrow_options point = *options;
    point.faces = PLS_FACES_POINT;
    if (!pls_wall_needs_no_depth(p->a, p->b))
        pls_narrow_phase_from(p->a, p->b, &point, state, NULL, touch, counts);
    else
        *touch = (pls_touch){.delta = p->a->size, .normal = pls_vec(0.0, 0.0, 1.0), .point = centre_of(p->a)};
}

static void find_touch(pls_solid_list *list, const pls_contact_input *in, size_t c, pls_narrow_counts *counts)
{
    pls_solid_pair *pair = &list->pair[c];
    pls_solid_memory *memory = &list->memory[c];
    pls_touch *touch = &list->touch[c];
    const pls_law *law = &in->laws->law[pair->law];
    const bool spares = spares_search(law, pair), goes_on = spares && memory->touches == PLS_SOLID_TOUCHES;
    pls_solid_parts p;
    pls_solid_parts_of(list, in, c, &p);
    pair->ended = memory->touches == PLS_SOLID_TOUCHES; // until it is found to touch
    pair->tracked = 1;
    if (goes_on && pls_narrow_phase_again(p.a, p.b, &law->narrow, &list->record[c], touch, counts))
    {
        memset(&memory->state, 0, sizeof memory->state); // as below; the last step may have done without a record
        return;
    }
    pair->on_wall = pls_is_wall_pair(p.a, p.b, &law->narrow);
    pair->tracked = bounds_near(p.a, p.b, pair->on_wall ? PLS_NARROW_FAR * p.a->size : 0.0) && !(pair->lets_go && behind(list, pair));
    touch->delta = 0.0;
    const pls_narrow_counts before = *counts;
    bool recorded = false;
    if (pair->on_wall)
    {
        if (pair->tracked)
            find_depth_on_wall(&p, &law->narrow, &memory->state, touch, counts);
        else
        {
            memset(&memory->state, 0, sizeof memory->state);
            touch->delta = -INFINITY;
        }
        return;
    }
    if (pair->tracked) recorded = pls_narrow_phase_from(p.a, p.b, &law->narrow, &memory->state, &list->record[c], touch, counts);
    // As if the record had been at hand, wherever that comes from: restarts and lists made anew change nothing.
    if (!pair->tracked || (recorded && spares)) memset(&memory->state, 0, sizeof memory->state);
    if (!recorded || !goes_on) return;
    *counts = before;
    ++counts->queries;
    touch->depth = INFINITY;
}

/// Do the contacts of d and c push in one direction at one place?
static bool at_one_place(const pls_solid_list *list, size_t d, size_t c)
{
    const pls_touch *deeper = &list->touch[d], *t = &list->touch[c];
    if (!(pls_dot(deeper->normal, t->normal) > shade_angle)) return false;
    const pls_posed *i = &list->posed[list->pair[c].row_i], *j = &list->posed[list->pair[c].row_j];
    double reach = shade_reach * fmin(i->size, isfinite(j->size) ? j->size : i->size);
    pls_vec3 apart = pls_sub(deeper->point, t->point);
    apart = pls_sub(apart, pls_scale(t->normal, pls_dot(apart, t->normal)));
    return pls_dot(apart, apart) < reach * reach;
}

/// Do the points at which the parts of c touch belong to the parts of d, too? A ball that rolls over a floor of pieces is near to the edges of those beside it, but an edge within a
/// floor is none: it would push backwards.
static bool has_points_of(const pls_solid_list *list, const pls_contact_input *in, size_t d, size_t c)
{
    const pls_touch *t = &list->touch[c];
    if (!pls_touch_is_point(t)) return false;
    pls_solid_parts own, other;
    pls_solid_parts_of(list, in, c, &own), pls_solid_parts_of(list, in, d, &other);
    const bool same_a = list->memory[c].part_i == list->memory[d].part_i;
    const bool same_b =
        list->memory[c].part_j == list->memory[d].part_j && pls_image_key(list->pair[c].shift) == pls_image_key(list->pair[d].shift);
    const double gap = shade_gap * fmin(own.a->size, own.b->size);
    const pls_vec3 half = pls_scale(t->normal, 0.5 * t->delta);
    return (same_a || pls_posed_sdf(other.a, pls_add(t->point, half)) < gap) &&
           (same_b || pls_posed_sdf(other.b, pls_sub(t->point, half)) < gap);
}

/// Is the contact of candidate c one that the deeper contact of d stands for?
static bool shades(const pls_solid_list *list, const pls_contact_input *in, size_t d, size_t c)
{
    return at_one_place(list, d, c) || has_points_of(list, in, d, c);
}

/// Is it an area, a line, or a facet, of which others decide?
static bool stands(const pls_solid_list *list, size_t c) { return list->touch[c].stands || list->pair[c].on_wall; }

/// Which of the candidates first .. last, all of one pair of bodies, act: `next` gets their new PLS_SOLID_ state. Areas and lines neither shade nor are shaded: a contact that came and went all at once would bring energy from nowhere.
static void choose_acting(const pls_solid_list *list, const pls_contact_input *in, size_t first, size_t last, uint8_t *next)
{
    for (size_t c = first; c < last; ++c) next[c - first] = list->touch[c].delta > 0.0 ? PLS_SOLID_TOUCHES : PLS_SOLID_APART;
    if (last - first < 2) return;
    for (size_t c = first; c < last; ++c)
    {
        if (next[c - first] == PLS_SOLID_APART || stands(list, c)) continue;
        for (size_t d = first; d < last && next[c - first] == PLS_SOLID_TOUCHES; ++d)
        {
            if (d == c || !(list->touch[d].delta > 0.0) || stands(list, d)) continue;
            bool deeper = list->touch[d].delta > list->touch[c].delta || (list->touch[d].delta == list->touch[c].delta && d < c);
            if (deeper && shades(list, in, d, c)) next[c - first] = PLS_SOLID_SHADED;
        }
    }
}

// ---- frame --------------------------------------------------------------------------------------------------------------------------------------------------

static pls_vec3 of3(const double *a) { return pls_vec(a[0], a[1], a[2]); }
static void put3(double *to, pls_vec3 a) { to[0] = a.x, to[1] = a.y, to[2] = a.z; }

/// Motion of the two bodies of a candidate, j's image across the box included.
typedef struct pair_motion
{
    pls_vec3 centre_i, centre_j;
    pls_vec3 v_i, v_j, w_i, w_j;                 ///< mid-step
    pls_vec3 end_v_i, end_v_j, end_w_i, end_w_j; ///< of the end
} pair_motion;

static pair_motion motion_of(const pls_contact_input *in, const pls_solid_pair *pair)
{
    const pls_body_place *p = &in->place[pair->row_i], *q = &in->place[pair->row_j];
    const pls_body_spin *s = &in->spin[pair->row_i], *t = &in->spin[pair->row_j];
    pair_motion m = {.centre_i = pls_vec(p->x, p->y, p->z),
                     .centre_j = pls_vec(q->x, q->y, q->z),
                     .v_i = pls_vec(p->vx, p->vy, p->vz),
                     .v_j = pls_vec(q->vx, q->vy, q->vz),
                     .w_i = pls_vec(s->wx, s->wy, s->wz),
                     .w_j = pls_vec(t->wx, t->wy, t->wz),
                     .end_w_i = pls_vec(s->end_x, s->end_y, s->end_z),
                     .end_w_j = pls_vec(t->end_x, t->end_y, t->end_z)};
    if (in->domain->any_periodic)
    {
        m.centre_j = pls_add(m.centre_j, shift_of(pair, in->domain->edge));
        m.v_j = pls_add(m.v_j, shift_of(pair, in->domain->edge_rate));
    }
    m.end_v_i = pls_add(m.v_i, pls_vec(s->lead_x, s->lead_y, p->lead_z));
    m.end_v_j = pls_add(m.v_j, pls_vec(t->lead_x, t->lead_y, q->lead_z));
    return m;
}

/// The smallest rotation that takes the unit vector n to m, on a vector s at right angles to n.
static pls_vec3 tilt(pls_vec3 s, pls_vec3 n, pls_vec3 m)
{
    double along = 1.0 + pls_dot(n, m);
    if (along < 1e-6) return pls_sub(s, pls_scale(m, pls_dot(s, m))); // turned over within one step: no rotation is the smallest
    return pls_sub(s, pls_scale(pls_add(n, m), pls_dot(m, s) / along));
}

/// s turned about the unit vector n by an angle of that sine and cosine, s at right angles to n.
static pls_vec3 turn_about(pls_vec3 s, pls_vec3 n, double sine, double cosine)
{
    return pls_add(pls_scale(s, cosine), pls_scale(pls_cross(n, s), sine));
}

static pls_vec3 tangential(pls_vec3 u, pls_vec3 n) { return pls_sub(u, pls_scale(n, pls_dot(u, n))); }

/// Where pushes from several sides nearly cancel, what is left acts at a long arm, far outside of the bodies; a dashpot there would turn them at once. It has the strength of one
/// at the rim. `arm`: squared [m^2].
static double damped_share(double arm, const pls_posed *i, const pls_posed *j)
{
    const double size = isfinite(j->size) && j->size < i->size ? j->size : i->size, most = size * size;
    return arm > most ? most / arm : 1.0;
}

/// Contact `k` of the batch: what the law reads. `fresh`: it did not touch at the last step.
static void frame_contact(const pls_solid_list *list, const pls_contact_input *in, size_t c, bool fresh, pls_contact_work *work, size_t k)
{
    const pls_solid_pair *pair = &list->pair[c];
    const pls_solid_memory *memory = &list->memory[c];
    const pls_touch *t = &list->touch[c];
    const pls_law *law = &in->laws->law[pair->law];
    const pair_motion m = motion_of(in, pair);
    const pls_vec3 n = t->normal, half = pls_scale(n, law->lever_at_surface ? 0.5 * t->depth : 0.0);
    const pls_vec3 arm_i = pls_sub(pls_add(t->middle, half), m.centre_i), arm_j = pls_sub(pls_sub(t->middle, half), m.centre_j);
    const pls_vec3 v = pls_sub(pls_add(m.end_v_i, pls_cross(m.end_w_i, arm_i)), pls_add(m.end_v_j, pls_cross(m.end_w_j, arm_j)));
    const pls_vec3 end_turn = pls_sub(m.end_w_i, m.end_w_j);
    // The normal force acts as a force on a line and a couple `twist` about it; the rate at which both do work is that of the force at this approach.
    double vn = pls_dot(v, n);
    if (!pls_touch_is_point(t))
    {
        const pls_vec3 off = pls_sub(t->point, t->middle);
        vn += pls_dot(pls_cross(end_turn, off), n) + t->twist * pls_dot(end_turn, n);
        vn *= damped_share(pls_dot(off, off) + t->twist * t->twist, &list->posed[pair->row_i], &list->posed[pair->row_j]);
    }

    const double lever = t->lever;
    double old_lever = lever, turning = 0.0; // turning: the spring along the normal
    pls_vec3 old_n = n, mid_i = arm_i, mid_j = arm_j, spring = pls_vec(0.0, 0.0, 0.0);
    if (!fresh)
    {
        // Of the middle of the step: means of the last step and of now, each from the centre as it was.
        const pls_vec3 old_i = of3(memory->arm), shift = pls_scale(pls_sub(m.v_j, m.v_i), in->dt);
        const pls_vec3 old_j = pls_add(pls_sub(pls_add(old_i, m.centre_i), m.centre_j), shift);
        old_n = of3(memory->normal);
        mid_i = pls_scale(pls_add(old_i, arm_i), 0.5), mid_j = pls_scale(pls_add(old_j, arm_j), 0.5);
        spring = of3(memory->spring);
        old_lever = memory->lever;
        if (old_lever > 0.0)
        {
            turning = pls_dot(spring, old_n);
            spring = pls_sub(spring, pls_scale(old_n, turning));
        }
    }
    pls_vec3 mid_n = pls_add(n, old_n);
    const double length = pls_length(mid_n);
    mid_n = length > 1e-3 ? pls_scale(mid_n, 1.0 / length) : n;
    pls_vec3 u = pls_sub(pls_add(m.v_i, pls_cross(m.w_i, mid_i)), pls_add(m.v_j, pls_cross(m.w_j, mid_j)));
    const double turned = 0.5 * in->dt * pls_dot(pls_add(m.w_i, m.w_j), n);
    double sine, cosine;
    pls_small_turn(0.5 * turned, &sine, &cosine);
    pls_vec3 step = turn_about(tilt(tangential(u, mid_n), mid_n, n), n, sine, cosine);
    double since = in->dt; // a contact that begins within the step has had the time since touch only
    if (fresh && vn * in->dt > t->depth) since = t->depth / vn;
    spring = pls_add(turn_about(tilt(spring, old_n, n), n, 2.0 * sine * cosine, 1.0 - 2.0 * sine * sine), pls_scale(step, since));

    pls_vec3 slip = tangential(v, n);
    if (lever > 0.0)
    {
        turning += since * 0.5 * (old_lever + lever) * pls_dot(pls_sub(m.w_i, m.w_j), mid_n);
        spring = pls_add(spring, pls_scale(n, turning));
        slip = pls_add(slip, pls_scale(n, lever * pls_dot(end_turn, n)));
    }
    work->delta[k] = t->delta;
    work->normal_velocity[k] = vn;
    work->slip_velocity[0][k] = slip.x, work->slip_velocity[1][k] = slip.y, work->slip_velocity[2][k] = slip.z;
    work->spring[0][k] = spring.x, work->spring[1][k] = spring.y, work->spring[2][k] = spring.z;
    for (int h = 0; h < PLS_LAW_MAX_HISTORY; ++h) work->history[h][k] = fresh ? 0.0 : memory->history[h];
    if (law->ops->needs_effective)
    {
        work->effective_radius[k] = pls_solid_effective_radius(list, c);
        work->effective_mass[k] = 1.0 / (in->load[pair->row_i].inv_mass + in->load[pair->row_j].inv_mass);
    }
}

// ---- law and store ----------------------------------------------------------------------------------------------------------------------------------------

/// Contact k of the batch into the slot and the record of candidate c.
static void store_contact(pls_solid_list *list, const pls_contact_input *in, size_t c, const pls_contact_work *work, size_t k)
{
    const pls_solid_pair *pair = &list->pair[c];
    pls_solid_memory *memory = &list->memory[c];
    const pls_touch *t = &list->touch[c];
    const pls_body_place *p = &in->place[pair->row_i];
    const pls_vec3 n = t->normal, arm_i = pls_sub(t->middle, pls_vec(p->x, p->y, p->z));
    const pair_motion m = motion_of(in, pair);
    const pls_vec3 arm_j = pls_sub(t->middle, m.centre_j);
    const double lever = t->lever;
    pls_vec3 shear = pls_vec(work->shear_force[0][k], work->shear_force[1][k], work->shear_force[2][k]);
    double turning = 0.0;
    if (lever > 0.0)
    {
        turning = pls_dot(shear, n);
        shear = pls_sub(shear, pls_scale(n, turning));
    }
    const pls_vec3 force = pls_sub(shear, pls_scale(n, work->normal_force[k]));
    pls_vec3 twist = pls_scale(n, t->twist * work->normal_force[k] - lever * turning); // on j, and against it on i
    if (!pls_touch_is_point(t)) twist = pls_add(twist, pls_scale(pls_cross(pls_sub(t->point, t->middle), n), work->normal_force[k]));
    double *slot = list->slot + c * PLS_SOLID_SLOT;
    put3(slot, force), put3(slot + 4, pls_sub(pls_cross(arm_i, force), twist));
    put3(slot + 8, pls_scale(force, -1.0)), put3(slot + 12, pls_add(pls_cross(force, arm_j), twist));
    slot[3] = slot[11] = work->damping_power[k];
    slot[7] = slot[15] = work->slip_work[k];
    put3(memory->spring, pls_vec(work->spring[0][k], work->spring[1][k], work->spring[2][k]));
    for (int h = 0; h < PLS_LAW_MAX_HISTORY; ++h) memory->history[h] = work->history[h][k];
    put3(memory->normal, n);
    put3(memory->arm, arm_i);
    memory->lever = lever;
}

/// One that touches over an area: what resists its rocking.
typedef struct rocking
{
    uint32_t candidate;
    pls_vec3 turn;      ///< of i against j at the end of the step [rad/s]
    pls_vec3 corner[4]; ///< pls_touch_corners
} rocking;

/// Contact `to` of the batch as contact `from`, for padding.
static void repeat_contact(const pls_law *law, size_t from, size_t to, pls_contact_work *work)
{
    work->delta[to] = work->delta[from];
    work->normal_velocity[to] = work->normal_velocity[from];
    for (int a = 0; a < 3; ++a)
    {
        work->slip_velocity[a][to] = work->slip_velocity[a][from];
        work->spring[a][to] = work->spring[a][from];
    }
    for (int h = 0; h < PLS_LAW_MAX_HISTORY; ++h) work->history[h][to] = work->history[h][from];
    if (!law->ops->needs_effective) return;
    work->effective_radius[to] = work->effective_radius[from];
    work->effective_mass[to] = work->effective_mass[from];
}

/// A candidate whose rocking is damped: four contacts of the batch from `k`, of the normal alone.
static void frame_corners(const pls_solid_list *list, const pls_contact_input *in, uint32_t c, double approach, rocking *r,
                          pls_contact_work *work, size_t k)
{
    const pls_solid_pair *pair = &list->pair[c];
    const pls_touch *t = &list->touch[c];
    const pls_body_spin *i = &in->spin[pair->row_i], *j = &in->spin[pair->row_j];
    const bool needs_effective = in->laws->law[pair->law].ops->needs_effective;
    const double radius = needs_effective ? pls_solid_effective_radius(list, c) : 0.0;
    r->candidate = c;
    r->turn = pls_vec(i->end_x - j->end_x, i->end_y - j->end_y, i->end_z - j->end_z);
    pls_touch_corners(t, r->corner);
    for (size_t p = 0; p < 4; ++p)
    {
        work->delta[k + p] = t->delta;
        work->normal_velocity[k + p] = approach + pls_dot(pls_cross(r->turn, r->corner[p]), t->normal);
        for (int a = 0; a < 3; ++a) work->slip_velocity[a][k + p] = work->spring[a][k + p] = 0.0;
        for (int h = 0; h < PLS_LAW_MAX_HISTORY; ++h) work->history[h][k + p] = list->memory[c].history[h];
        if (!needs_effective) continue;
        work->effective_radius[k + p] = radius;
        work->effective_mass[k + p] = 1.0 / (in->load[pair->row_i].inv_mass + in->load[pair->row_j].inv_mass);
    }
}

/// The couple of the four normal forces into the slot, and what it takes to the dashpots' power.
static void store_rocking(pls_solid_list *list, const rocking *r, const pls_contact_work *work, size_t k)
{
    const pls_vec3 normal = list->touch[r->candidate].normal;
    pls_vec3 couple = pls_vec(0.0, 0.0, 0.0); // on j
    for (size_t p = 0; p < 4; p += 2)
    {
        const double differs = work->normal_force[k + p] - work->normal_force[k + p + 1];
        couple = pls_add(couple, pls_scale(pls_cross(r->corner[p], normal), 0.25 * differs));
    }
    double *slot = list->slot + r->candidate * PLS_SOLID_SLOT;
    const double power = pls_dot(couple, r->turn);
    put3(slot + 4, pls_sub(of3(slot + 4), couple)), put3(slot + 12, pls_add(of3(slot + 12), couple));
    slot[3] += power, slot[11] += power;
}

/// Of a batch that has been answered, those that touch over an area. `approach`: normal velocities of the batch.
static void damp_rocking(pls_solid_list *list, const pls_contact_input *in, const uint32_t *batch, size_t count, const double *approach,
                         pls_contact_work *work)
{
    enum { MOST = PLS_CONTACT_BLOCK / 4 };
    const pls_law *law = &in->laws->law[list->pair[batch[0]].law];
    rocking chosen[MOST];
    for (size_t k = 0; k < count;)
    {
        size_t taken = 0;
        for (; k < count && taken < MOST; ++k)
        {
            if (pls_touch_is_point(&list->touch[batch[k]])) continue;
            frame_corners(list, in, batch[k], approach[k], &chosen[taken], work, 4 * taken);
            ++taken;
        }
        if (taken == 0) return;
        for (size_t p = 4 * taken; p & 7; ++p) repeat_contact(law, p - 4, p, work);
        pls_contact_law(law, in->dt, (4 * taken + 7) / 8 * 8, work);
        for (size_t p = 0; p < taken; ++p) store_rocking(list, &chosen[p], work, 4 * p);
    }
}

/// Ask the law of `batch` candidates, which is the same for all of them.
static void answer(pls_solid_list *list, const pls_contact_input *in, const uint32_t *batch, size_t count, pls_contact_work *work)
{
    if (count == 0) return;
    const pls_law *law = &in->laws->law[list->pair[batch[0]].law];
    for (size_t k = 0; k < count; ++k) frame_contact(list, in, batch[k], list->memory[batch[k]].touches != PLS_SOLID_TOUCHES, work, k);
    for (size_t k = count; k & 7; ++k) repeat_contact(law, count - 1, k, work);
    pls_contact_law(law, in->dt, (count + 7) / 8 * 8, work);
    bool any_area = false;
    for (size_t k = 0; k < count; ++k)
    {
        store_contact(list, in, batch[k], work, k);
        list->memory[batch[k]].touches = PLS_SOLID_TOUCHES;
        list->pair[batch[k]].ended = 0;
        any_area = any_area || !pls_touch_is_point(&list->touch[batch[k]]);
    }
    if (!any_area) return;
    double approach[PLS_CONTACT_BLOCK];
    memcpy(approach, work->normal_velocity, count * sizeof *approach);
    damp_rocking(list, in, batch, count, approach, work);
}

static void forget(pls_solid_memory *memory)
{
    memset(memory->spring, 0, sizeof memory->spring);
    memset(memory->history, 0, sizeof memory->history);
    memset(memory->normal, 0, sizeof memory->normal);
    memset(memory->arm, 0, sizeof memory->arm);
    memory->lever = 0.0;
}

/// A contact that comes out of the shade of another goes on with that one's spring: to the two bodies it is the same contact, at another part.
static void inherit(pls_solid_list *list, size_t first, size_t last, const uint8_t *next)
{
    for (size_t c = first; c < last; ++c)
    {
        if (next[c - first] != PLS_SOLID_TOUCHES || list->memory[c].touches != PLS_SOLID_SHADED) continue;
        for (size_t d = first; d < last; ++d)
        {
            if (list->memory[d].touches != PLS_SOLID_TOUCHES || next[d - first] == PLS_SOLID_TOUCHES || !list->pair[d].ended) continue;
            if (!(pls_dot(of3(list->memory[d].normal), list->touch[c].normal) > shade_angle)) continue;
            memcpy(list->memory[c].spring, list->memory[d].spring, sizeof list->memory[c].spring);
            memcpy(list->memory[c].history, list->memory[d].history, sizeof list->memory[c].history);
            memcpy(list->memory[c].normal, list->memory[d].normal, sizeof list->memory[c].normal);
            memcpy(list->memory[c].arm, list->memory[d].arm, sizeof list->memory[c].arm);
            list->memory[c].lever = list->memory[d].lever;
            list->memory[c].touches = PLS_SOLID_TOUCHES;
            list->pair[d].ended = 0; // it did not end, it moved
            forget(&list->memory[d]);
            list->memory[d].touches = next[d - first];
            break;
        }
    }
}

void pls_solid_contacts(pls_solid_list *list, const pls_contact_input *in, const pls_solid_block *block, pls_contact_work *work,
                        pls_narrow_counts *counts)
{
    enum { MOST = PLS_CONTACT_BLOCK };
    uint32_t batch[MOST];
    size_t taken = 0;
    for (size_t c = block->first; c < block->last; ++c) find_touch(list, in, c, counts);
    for (size_t first = block->first, last; first < block->last; first = last)
    {
        uint8_t *next = list->next + first;
        for (last = first + 1;
             last < block->last && list->pair[last].row_i == list->pair[first].row_i && list->pair[last].row_j == list->pair[first].row_j;)
            ++last;
        choose_acting(list, in, first, last, next);
        pls_wall_groups(list, in, first, last, next);
        inherit(list, first, last, next);
        for (size_t c = first; c < last; ++c)
        {
            if (next[c - first] == PLS_SOLID_TOUCHES)
            {
                if (taken == MOST || (taken > 0 && list->pair[batch[0]].law != list->pair[c].law))
                {
                    answer(list, in, batch, taken, work);
                    taken = 0;
                }
                batch[taken++] = (uint32_t)c;
                continue;
            }
            if (!list->pair[c].ended) forget(&list->memory[c]); // who ended is asked once more what its spring holds
            list->memory[c].touches = next[c - first];
            memset(list->slot + c * PLS_SOLID_SLOT, 0, PLS_SOLID_SLOT * sizeof *list->slot);
        }
    }
    answer(list, in, batch, taken, work);
}

double pls_solid_depth(const pls_solid_list *list, const pls_contact_input *in, size_t c)
{
    const double depth = list->touch[c].depth;
    return isfinite(depth) ? depth : pls_solid_touch_now(list, in, c).depth;
}

pls_touch pls_solid_touch_now(const pls_solid_list *list, const pls_contact_input *in, size_t c)
{
    pls_solid_parts p;
    pls_touch touch = {.delta = -INFINITY};
    pls_pair_state state = {{0.0}};
    pls_narrow_counts counts = {0};
    pls_solid_parts_of(list, in, c, &p);
    if (bounds_overlap(p.a, p.b)) pls_narrow_phase(p.a, p.b, &in->laws->law[list->pair[c].law].narrow, &state, &touch, &counts);
    return touch;
}

void pls_solid_gather(const pls_solid_list *list, size_t first, size_t last, double *force, double *torque)
{
    for (size_t row = first; row < last; ++row)
    {
        double *f = force + 4 * (row - first), *t = torque + 4 * (row - first);
        for (uint32_t k = list->start[row]; k < list->start[row + 1]; ++k)
        {
            const size_t c = list->entry[k] >> 1;
            if (list->memory[c].touches != PLS_SOLID_TOUCHES) continue;
            const double *slot = list->slot + c * PLS_SOLID_SLOT + (list->entry[k] & 1) * 8;
            for (int a = 0; a < 4; ++a) f[a] += slot[a], t[a] += slot[4 + a];
        }
    }
}

pls_vec3 pls_solid_last_spring(const pls_solid_list *list, const pls_contact_input *in, size_t c)
{
    const pls_solid_memory *memory = &list->memory[c];
    const pair_motion m = motion_of(in, &list->pair[c]);
    const pls_vec3 n = of3(memory->normal), arm_i = of3(memory->arm), arm_j = pls_sub(pls_add(arm_i, m.centre_i), m.centre_j);
    pls_vec3 u = pls_sub(pls_add(m.v_i, pls_cross(m.w_i, arm_i)), pls_add(m.v_j, pls_cross(m.w_j, arm_j)));
    const pls_vec3 slip = pls_add(tangential(u, n), pls_scale(n, memory->lever * pls_dot(pls_sub(m.w_i, m.w_j), n)));
    return pls_add(of3(memory->spring), pls_scale(slip, 0.5 * in->dt));
}

static double equal_radius(const pls_posed *p)
{
    double volume = p->shape->volume;
    if (!(volume > 0.0) || !isfinite(volume)) return INFINITY; // walls
    return p->scale * (p->shape->dimension == 2 ? sqrt(volume / M_PI) : cbrt(0.75 * volume / M_PI));
}

double pls_solid_effective_radius(const pls_solid_list *list, size_t c)
{
    double a = equal_radius(&list->posed[list->pair[c].row_i]), b = equal_radius(&list->posed[list->pair[c].row_j]);
    if (!isfinite(b)) return a;
    return isfinite(a) ? a * b / (a + b) : b;
}
