// state_rk2.c -- state objects by the midpoint rule, and what they drive.
//
//     s(t + dt/2) = s + dt/2 f(s, t),     s(t + dt) = s + dt f(s(t + dt/2), t + dt/2)
//
// States are advanced right after the drift, before forces: the half-step velocity of Verlet is the midpoint rate of positions, so both stages know their
// body to second order, and forces at t + dt see states at t + dt.

#include "step/world.h"

#include <string.h>

void pls_states_before(pls_world *world)
{
    for (size_t k = 0; k < world->state_count; ++k)
    {
        pls_state_instance *state = &world->state[k];
        uint32_t row = pls_body_row(world, state->def.body);
        if (row == PLS_NO_ROW) continue;
        const pls_body_place *p = &world->bodies.place[row];
        const pls_body_spin *s = &world->bodies.spin[row];
        state->position = pls_vec(p->x, p->y, p->z);
        state->velocity = pls_vec(p->vx, p->vy, p->vz);
        state->spin = pls_vec(s->wx, s->wy, s->wz);
    }
}

/// All rates at the start (middle = false) or the middle of the step.
static pls_status rates(pls_world *world, bool middle, const double *values)
{
    for (size_t k = 0; k < world->state_count; ++k)
    {
        const pls_state_instance *state = &world->state[k];
        pls_state_point at = {.time = world->time + (middle ? 0.5 * world->dt : 0.0), .body = state->def.body, .all = values};
        uint32_t row = pls_body_row(world, state->def.body);
        if (row != PLS_NO_ROW)
        {
            const pls_body_place *p = &world->bodies.place[row];
            const pls_body_spin *s = &world->bodies.spin[row];
            pls_vec3 end = pls_vec(p->x, p->y, p->z), spin_middle = pls_vec(s->wx, s->wy, s->wz); // rows hold velocities of the middle now
            at.position = middle ? pls_scale(pls_add(state->position, end), 0.5) : state->position;
            at.velocity = middle ? pls_scale(pls_sub(end, state->position), 1.0 / world->dt) : state->velocity;
            at.angular_velocity = middle ? spin_middle : state->spin;
            at.radius = p->radius;
        }
        double *rate = world->state_rate + state->first;
        PLS_TRY(state->def.rate(state->def.context, &at, values + state->first, rate));
        for (int c = 0; c < state->def.components; ++c)
            if (!isfinite(rate[c]))
                return pls_fail(PLS_NOT_A_NUMBER, "the rate of state '%s' is %g at t = %g s (value %g)", state->def.name, rate[c], at.time,
                                values[state->first + (size_t)c]);
    }
    return PLS_OK;
}

pls_status pls_states_advance(pls_world *world)
{
    if (world->value_count == 0) return PLS_OK;
    PLS_TRY(rates(world, false, world->state_value));
    for (size_t k = 0; k < world->value_count; ++k) world->state_half[k] = world->state_value[k] + 0.5 * world->dt * world->state_rate[k];
    PLS_TRY(rates(world, true, world->state_half));
    for (size_t k = 0; k < world->value_count; ++k) world->state_value[k] += world->dt * world->state_rate[k];
    return PLS_OK;
}

static pls_status drive_scale(pls_world *world, const pls_state_instance *state)
{
    uint32_t row = pls_body_row(world, state->def.body);
    if (row == PLS_NO_ROW || state->def.target == PLS_STATE_FREE) return PLS_OK;
    double value = world->state_value[state->first], before = world->bodies.place[row].radius;
    double unit = world->shape[world->bodies.kind[row].shape].shape->radius;
    pls_status status = pls_body_rescale(world, row, state->def.target == PLS_STATE_RADIUS ? value / unit : value, state->def.keep_density);
    if (status != PLS_OK) return pls_fail_context(status, "state '%s': ", state->def.name);
    if (world->prepared)
        world->bodies.before[row].growth = (float)(0.5 * (world->bodies.place[row].radius - before)); // springs take the levers of mid-step
    world->list.drift += 2.0 * fmax(0.0, world->bodies.place[row].radius - before);
    return PLS_OK;
}

static pls_status apply_binding(pls_world *world, const pls_binding *binding, double time)
{
    double value = NAN;
    PLS_TRY(binding->function(binding->context, time, world->state_value, &value));
    if (!isfinite(value)) return pls_fail(PLS_NOT_A_NUMBER, "the value given for '%s' is %g at t = %g s", binding->name, value, time);
    if (binding->force.index1) return pls_world_set_force_parameter(world, binding->force, binding->name, value);
    if (binding->of_material) return pls_world_set_material_value(world, (pls_material_id){binding->a}, binding->name, value);
    return pls_world_set_law_parameter(world, (pls_material_id){binding->a}, (pls_material_id){binding->b}, binding->name, value);
}

pls_status pls_states_apply(pls_world *world)
{
    double time = world->prepared ? world->time + world->dt : world->time; // at the start: the values of now
    for (size_t k = 0; k < world->state_count; ++k)
    {
        const pls_state_instance *state = &world->state[k];
        PLS_TRY(drive_scale(world, state));
        if (state->def.apply) PLS_TRY(state->def.apply(state->def.context, world, world->state_value + state->first));
    }
    for (size_t k = 0; k < world->binding_count; ++k) PLS_TRY(apply_binding(world, &world->binding[k], time));
    return PLS_OK;
}
