// motion.c -- bodies advanced one by one: partly or fully driven by given velocities, and bodies with three different moments of inertia.
//
// The passes of velocity_verlet_simd.c go over these bodies too (their inverse mass or inertia may be zero there); what they did is replaced here.
//
// Free rotation of a body with three different moments: the torque-free motion over dt is split into rotations about the principal axes,
// R1(dt/2) R2(dt/2) R3(dt) R2(dt/2) R1(dt/2), each exact for its part of the kinetic energy (Dullweber, Leimkuhler & McLachlan 1997). The angular momentum in
// the world frame is not touched, the map is symplectic and of second order, so |L| stays to round-off and energy has no drift. Torques kick L by halves.

#include "step/world.h"

#include "base/alloc.h"
#include "math/small_turn.h"

static pls_vec3 place_position(const pls_body_place *p) { return pls_vec(p->x, p->y, p->z); }

static pls_quat body_quat(const pls_bodies *b, uint32_t row)
{
    const pls_body_orientation *q = &b->orientation[row];
    return (pls_quat){q->w, q->x, q->y, q->z};
}

static void set_position(pls_body_place *p, pls_vec3 x) { p->x = x.x, p->y = x.y, p->z = x.z; }
static void set_velocity(pls_body_place *p, pls_vec3 v) { p->vx = v.x, p->vy = v.y, p->vz = v.z; }
static void set_spin(pls_body_spin *s, pls_vec3 w) { s->wx = w.x, s->wy = w.y, s->wz = w.z; }
static void set_quat(pls_body_orientation *o, pls_quat q) { *o = (pls_body_orientation){q.w, q.x, q.y, q.z}; }

/// Rotation by q / |q|: a quaternion is of unit length only to round-off, and over millions of steps a bias in it would add up in |L|.
static pls_vec3 turn_to_world(pls_quat q, pls_vec3 a)
{
    pls_vec3 u = pls_vec(q.x, q.y, q.z), t = pls_scale(pls_cross(u, a), 2.0 / (q.w * q.w + pls_dot(u, u)));
    return pls_add(a, pls_add(pls_scale(t, q.w), pls_cross(u, t)));
}
static pls_vec3 turn_to_body(pls_quat q, pls_vec3 a) { return turn_to_world(pls_quat_conjugate(q), a); }

/// Rotation by the vector angle `a` [rad].
static pls_quat rotation_by(pls_vec3 a)
{
    double angle = pls_length(a);
    if (angle == 0.0) return pls_quat_identity();
    double s = sin(0.5 * angle) / angle;
    return (pls_quat){cos(0.5 * angle), s * a.x, s * a.y, s * a.z};
}

pls_status pls_find_specials(pls_world *world)
{
    const pls_bodies *bodies = &world->bodies;
    world->special_count = 0;
    for (uint32_t number = 0; number < bodies->numbers; ++number)
    {
        uint32_t row = bodies->row_of[number];
        if (row == PLS_NO_ROW || !(bodies->kind[row].flags & (PLS_BODY_SPECIAL | PLS_BODY_ANISOTROPIC))) continue;
        PLS_TRY(pls_reserve(&world->special, &world->special_capacity, world->special_count + 1, sizeof *world->special,
                            "bodies advanced one by one"));
        world->special[world->special_count++] = (pls_special){.row = row, .number = number};
    }
    world->special_stale = false;
    return PLS_OK;
}

void pls_follow_specials(pls_world *world)
{
    for (size_t k = 0; k < world->special_count; ++k) world->special[k].row = world->bodies.row_of[world->special[k].number];
}

static const pls_motion_def *motion_of(const pls_world *world, uint32_t row)
{
    static const pls_motion_def none = {0};
    uint32_t k = world->bodies.kind[row].motion;
    return k ? &world->motion[k - 1] : &none;
}

static pls_status driven_velocities(const pls_world *world, uint32_t row, double time, pls_vec3 *v, pls_vec3 *w)
{
    const pls_motion_def *m = motion_of(world, row);
    *v = m->velocity;
    *w = m->angular_velocity;
    if (!m->function) return PLS_OK;
    PLS_TRY(m->function(m->context, time, v, w));
    if (!isfinite(v->x + v->y + v->z + w->x + w->y + w->z))
        return pls_fail(PLS_NOT_A_NUMBER, "the motion given for body %u is not a number at t = %g s", world->bodies.kind[row].number, time);
    return PLS_OK;
}

/// Given where the axis is prescribed, else free.
static pls_vec3 choose(unsigned axes, unsigned first, pls_vec3 given, pls_vec3 free)
{
    return pls_vec((axes & first) ? given.x : free.x, (axes & (first << 1)) ? given.y : free.y, (axes & (first << 2)) ? given.z : free.z);
}

pls_status pls_special_start(pls_world *world)
{
    PLS_TRY(pls_find_specials(world));
    for (size_t k = 0; k < world->special_count; ++k)
    {
        uint32_t row = world->special[k].row;
        const pls_motion_def *m = motion_of(world, row);
        if (m->axes == 0) continue;
        pls_body_place *p = &world->bodies.place[row];
        pls_body_spin *s = &world->bodies.spin[row];
        pls_vec3 v, w;
        PLS_TRY(driven_velocities(world, row, world->time, &v, &w));
        if (m->about) v = pls_cross(w, pls_sub(place_position(p), m->centre));
        set_velocity(p, choose(m->axes, PLS_AXIS_X, v, pls_vec(p->vx, p->vy, p->vz)));
        set_spin(s, choose(m->axes, PLS_AXIS_RX, w, pls_vec(s->wx, s->wy, s->wz)));
    }
    return PLS_OK;
}

pls_status pls_special_before(pls_world *world)
{
    if (world->special_stale) PLS_TRY(pls_find_specials(world));
    for (size_t k = 0; k < world->special_count; ++k)
    {
        pls_special *s = &world->special[k];
        const pls_body_place *p = &world->bodies.place[s->row];
        const pls_body_spin *w = &world->bodies.spin[s->row];
        s->position = place_position(p);
        s->velocity = pls_vec(p->vx, p->vy, p->vz);
        s->spin = pls_vec(w->wx, w->wy, w->wz);
        s->orientation = body_quat(&world->bodies, s->row);
        s->before = world->bodies.before[s->row];
    }
    return PLS_OK;
}

static pls_vec3 divide(pls_vec3 a, const pls_body_mass *m) { return pls_vec(a.x / m->ix, a.y / m->iy, a.z / m->iz); }
static pls_vec3 multiply(pls_vec3 a, const pls_body_mass *m) { return pls_vec(a.x * m->ix, a.y * m->iy, a.z * m->iz); }

/// One rotation of the splitting: about principal axis `i` for time h, those after it in turn being j and k. `l` is the angular momentum in the body's frame; as for `turn_to_world`
/// sine and cosine count by their ratio alone.
static inline void split_turn(double l[3], double q[4], const double moment[3], int i, int j, int k, double h)
{
    double s, c;
    pls_small_turn(0.5 * h * l[i] / moment[i], &s, &c);
    const double share = 2.0 * s / (c * c + s * s);
    const double along = share * l[k], across = -share * l[j];
    l[j] += c * along + s * across, l[k] += c * across - s * along;
    const double w = q[0], x = q[1 + i], y = q[1 + j], z = q[1 + k];
    q[0] = w * c - x * s, q[1 + i] = x * c + w * s;
    q[1 + j] = y * c + z * s, q[1 + k] = z * c - y * s;
}

static void rotate_freely(pls_vec3 momentum, pls_quat *q, const pls_body_mass *m, double dt)
{
    const pls_vec3 own = turn_to_body(*q, momentum);
    const double moment[3] = {m->ix, m->iy, m->iz};
    double l[3] = {own.x, own.y, own.z}, turn[4] = {q->w, q->x, q->y, q->z};
    split_turn(l, turn, moment, 0, 1, 2, 0.5 * dt);
    split_turn(l, turn, moment, 1, 2, 0, 0.5 * dt);
    split_turn(l, turn, moment, 2, 0, 1, dt);
    split_turn(l, turn, moment, 1, 2, 0, 0.5 * dt);
    split_turn(l, turn, moment, 0, 1, 2, 0.5 * dt);
    *q = pls_quat_unit((pls_quat){turn[0], turn[1], turn[2], turn[3]});
}

static pls_vec3 spin_of(pls_vec3 momentum, pls_quat q, const pls_body_mass *m)
{
    return turn_to_world(q, divide(turn_to_body(q, momentum), m));
}

/// What contacts see of a body within the step (velocity_verlet_simd.c): velocity of the middle and, apart, what leads to that of the end.
static void show_velocity(pls_bodies *b, uint32_t row, pls_vec3 middle, pls_vec3 end)
{
    set_velocity(&b->place[row], middle);
    b->spin[row].lead_x = end.x - middle.x;
    b->spin[row].lead_y = end.y - middle.y;
    b->place[row].lead_z = end.z - middle.z;
}

static void show_spin(pls_bodies *b, uint32_t row, pls_vec3 middle, pls_vec3 end)
{
    pls_body_spin *s = &b->spin[row];
    set_spin(s, middle);
    s->end_x = end.x, s->end_y = end.y, s->end_z = end.z;
}

/// Angle by which one orientation is turned against another, as a vector [rad].
static pls_vec3 angle_between(pls_quat from, pls_quat to)
{
    pls_quat turn = pls_quat_multiply(to, pls_quat_conjugate(from));
    pls_vec3 axis = pls_scale(pls_vec(turn.x, turn.y, turn.z), turn.w < 0.0 ? -1.0 : 1.0);
    return pls_scale(axis, 2.0 * pls_angle_by_sine(pls_length(axis), fabs(turn.w)));
}

static pls_vec3 sum_of_torques(const pls_bodies *b, const pls_special *s)
{
    const pls_body_load *now = &b->load[s->row];
    return pls_vec(now->tx + s->before.tx, now->ty + s->before.ty, now->tz + s->before.tz);
}

static void drift_anisotropic(pls_world *world, pls_special *s)
{
    pls_bodies *b = &world->bodies;
    const pls_body_mass *m = &b->mass[s->row];
    const pls_body_load *now = &b->load[s->row];
    pls_vec3 torque = pls_vec(now->tx, now->ty, now->tz);
    pls_vec3 momentum = turn_to_world(s->orientation, multiply(turn_to_body(s->orientation, s->spin), m));
    s->half_spin = pls_add(momentum, pls_scale(torque, 0.5 * world->dt));
    pls_quat q = s->orientation;
    rotate_freely(s->half_spin, &q, m, world->dt);
    set_quat(&b->orientation[s->row], q);
    pls_vec3 middle = pls_scale(angle_between(s->orientation, q), 1.0 / world->dt); // the rotation that was made
    show_spin(b, s->row, middle, spin_of(pls_add(s->half_spin, pls_scale(sum_of_torques(b, s), 0.25 * world->dt)), q, m));
}

static void drift_driven_spin(pls_world *world, pls_special *s, pls_vec3 w_mid)
{
    pls_bodies *b = &world->bodies;
    const pls_body_load *now = &b->load[s->row];
    const pls_body_mass *m = &b->mass[s->row];
    unsigned axes = motion_of(world, s->row)->axes;
    bool anisotropic = (b->kind[s->row].flags & PLS_BODY_ANISOTROPIC) != 0;
    if (anisotropic && !(axes & (PLS_AXIS_RX | PLS_AXIS_RY | PLS_AXIS_RZ)))
    {
        drift_anisotropic(world, s);
        return;
    }
    // Partly driven rotation of an anisotropic body: each free world axis answers with its own moment.
    double inv = b->load[s->row].inv_inertia, dt = world->dt;
    pls_vec3 torque = pls_vec(now->tx, now->ty, now->tz), sum = sum_of_torques(b, s);
    pls_vec3 accelerate = anisotropic ? spin_of(torque, s->orientation, m) : pls_scale(torque, inv);
    pls_vec3 accelerate_sum = anisotropic ? spin_of(sum, s->orientation, m) : pls_scale(sum, inv);
    s->half_spin = choose(axes, PLS_AXIS_RX, w_mid, pls_add(s->spin, pls_scale(accelerate, 0.5 * dt)));
    set_quat(&b->orientation[s->row], pls_quat_unit(pls_quat_multiply(rotation_by(pls_scale(s->half_spin, dt)), s->orientation)));
    show_spin(b, s->row, s->half_spin,
              choose(axes, PLS_AXIS_RX, s->driven_spin, pls_add(s->half_spin, pls_scale(accelerate_sum, 0.25 * dt))));
}

static pls_status drift_driven(pls_world *world, pls_special *s)
{
    pls_bodies *b = &world->bodies;
    const pls_motion_def *motion = motion_of(world, s->row);
    pls_body_place *p = &b->place[s->row];
    const pls_body_load *now = &b->load[s->row];
    const pls_body_before *before = &s->before;
    double dt = world->dt, inv_mass = now->inv_mass;
    pls_vec3 v_mid, w_mid;
    PLS_TRY(driven_velocities(world, s->row, world->time + 0.5 * dt, &v_mid, &w_mid));
    PLS_TRY(driven_velocities(world, s->row, world->time + dt, &s->driven_velocity, &s->driven_spin));
    drift_driven_spin(world, s, w_mid);

    pls_vec3 force = pls_vec(now->fx, now->fy, now->fz), sum = pls_add(force, pls_vec(before->fx, before->fy, before->fz));
    if (motion->about)
    {
        pls_vec3 arm = turn_to_world(rotation_by(pls_scale(w_mid, dt)), pls_sub(s->position, motion->centre)),
                 end = pls_add(motion->centre, arm);
        set_position(p, end);
        s->driven_velocity = pls_cross(s->driven_spin, arm);
        s->half_velocity = pls_scale(pls_sub(end, s->position), 1.0 / dt);
        show_velocity(b, s->row, s->half_velocity, s->driven_velocity);
        return PLS_OK;
    }
    s->half_velocity = choose(motion->axes, PLS_AXIS_X, v_mid, pls_add(s->velocity, pls_scale(force, 0.5 * dt * inv_mass)));
    set_position(p, pls_add(s->position, pls_scale(s->half_velocity, dt)));
    show_velocity(b, s->row, s->half_velocity,
                  choose(motion->axes, PLS_AXIS_X, s->driven_velocity, pls_add(s->half_velocity, pls_scale(sum, 0.25 * dt * inv_mass))));
    return PLS_OK;
}

pls_status pls_special_drift(pls_world *world)
{
    double further = 0.0; // than the pass over all bodies moved this one, and noted: a given velocity may jump
    double swept = 0.0;   // by the far points of walls of pieces that turn, whose pieces near a body are listed
    for (size_t k = 0; k < world->special_count; ++k)
    {
        pls_special *s = &world->special[k];
        const pls_body_place *p = &world->bodies.place[s->row];
        double noted = pls_length(pls_sub(place_position(p), s->position));
        if (world->bodies.kind[s->row].flags & PLS_BODY_SPECIAL)
            PLS_TRY(drift_driven(world, s));
        else
            drift_anisotropic(world, s);
        further = fmax(further, pls_length(pls_sub(place_position(p), s->position)) - noted);
        const uint32_t wall = PLS_BODY_UNBOUNDED | PLS_BODY_SOLID;
        if ((world->bodies.kind[s->row].flags & wall) == wall)
            swept = fmax(swept, pls_length(s->half_spin) * world->dt * world->shape_of[world->bodies.kind[s->row].shape]->radius *
                                    world->bodies.scale[s->row]);
    }
    pls_neighbours_carried(world, further);
    world->list.drift += swept;
    world->list.image_drift += swept;
    return PLS_OK;
}

void pls_special_finish(pls_world *world)
{
    pls_bodies *b = &world->bodies;
    double half = 0.5 * world->dt;
    for (size_t k = 0; k < world->special_count; ++k)
    {
        const pls_special *s = &world->special[k];
        const pls_body_load *load = &b->load[s->row];
        const pls_body_mass *m = &b->mass[s->row];
        pls_vec3 torque = pls_vec(load->tx, load->ty, load->tz), force = pls_vec(load->fx, load->fy, load->fz);
        uint32_t flags = b->kind[s->row].flags;
        const pls_motion_def *motion = motion_of(world, s->row);
        pls_quat q = body_quat(b, s->row);
        bool turns_driven = (motion->axes & (PLS_AXIS_RX | PLS_AXIS_RY | PLS_AXIS_RZ)) != 0;
        if ((flags & PLS_BODY_ANISOTROPIC) && !turns_driven)
            set_spin(&b->spin[s->row], spin_of(pls_add(s->half_spin, pls_scale(torque, half)), q, m));
        else
        {
            pls_vec3 accelerate = (flags & PLS_BODY_ANISOTROPIC) ? spin_of(torque, q, m) : pls_scale(torque, b->load[s->row].inv_inertia);
            set_spin(&b->spin[s->row],
                     choose(motion->axes, PLS_AXIS_RX, s->driven_spin, pls_add(s->half_spin, pls_scale(accelerate, half))));
        }
        if (!(flags & PLS_BODY_SPECIAL)) continue;
        double inv_mass = load->inv_mass;
        set_velocity(&b->place[s->row],
                     choose(motion->axes, PLS_AXIS_X, s->driven_velocity, pls_add(s->half_velocity, pls_scale(force, half * inv_mass))));
    }
}
