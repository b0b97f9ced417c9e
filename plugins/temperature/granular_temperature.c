// granular_temperature.c -- centre of mass, its velocity, and how much the bodies move about it.
//
//     X = sum m x / M,   V = sum m v / M,   T = sum m |v - V|^2 / (D M)        M = sum m, D the dimension
//
// Of all bodies of the group that have mass, by their centres; T is a mean square velocity per direction [m^2/s^2]. In a periodic box X is that of the places as
// they are, which may lie in different images.

#include <particls/plugin.h>

enum { X, Y, Z, VX, VY, VZ, TEMPERATURE, LARGEST, COLUMNS };

static const pls_observer_column columns[COLUMNS + 1] = {
    [X] = {.name = "centre_x", .unit = "m", .meaning = "centre of mass"},
    [Y] = {.name = "centre_y", .unit = "m", .meaning = "centre of mass"},
    [Z] = {.name = "centre_z", .unit = "m", .meaning = "centre of mass", .only_3d = true},
    [VX] = {.name = "velocity_x", .unit = "m/s", .meaning = "velocity of the centre of mass"},
    [VY] = {.name = "velocity_y", .unit = "m/s", .meaning = "velocity of the centre of mass"},
    [VZ] = {.name = "velocity_z", .unit = "m/s", .meaning = "velocity of the centre of mass", .only_3d = true},
    [TEMPERATURE] = {.name = "temperature", .unit = "m^2/s^2", .meaning = "mean square velocity about it, per direction"},
    [LARGEST] = {.name = "temperature_largest", .unit = "m^2/s^2", .meaning = "largest temperature of all looks so far"},
};

/// Mass and the sums of m x and m v.
static pls_status add_up(const pls_observer_view *view, double *mass, pls_vec3 *place, pls_vec3 *momentum)
{
    *mass = 0.0;
    *place = *momentum = pls_vec(0.0, 0.0, 0.0);
    pls_body_id id = pls_world_next_body(view->world, view->group, (pls_body_id){0});
    for (; id.index1; id = pls_world_next_body(view->world, view->group, id))
    {
        pls_body_motion m;
        PLS_TRY(pls_body_get(view->world, id, &m));
        if (isinf(m.mass)) continue; // walls
        *mass += m.mass;
        *place = pls_add(*place, pls_scale(m.position, m.mass));
        *momentum = pls_add(*momentum, pls_scale(m.velocity, m.mass));
    }
    return *mass > 0.0 ? PLS_OK : pls_fail(PLS_USER, "granular_temperature: there is no body with mass");
}

/// In two passes: V first, so that a common velocity takes nothing from the digits of T.
static pls_status measure(const pls_observer_view *view, double *row)
{
    double mass, square = 0.0;
    pls_vec3 place, momentum;
    PLS_TRY(add_up(view, &mass, &place, &momentum));
    pls_vec3 centre = pls_scale(place, 1.0 / mass), velocity = pls_scale(momentum, 1.0 / mass);
    pls_body_id id = pls_world_next_body(view->world, view->group, (pls_body_id){0});
    for (; id.index1; id = pls_world_next_body(view->world, view->group, id))
    {
        pls_body_motion m;
        PLS_TRY(pls_body_get(view->world, id, &m));
        pls_vec3 c = pls_sub(m.velocity, velocity);
        if (!isinf(m.mass)) square += m.mass * pls_dot(c, c);
    }
    row[X] = centre.x, row[Y] = centre.y, row[Z] = centre.z;
    row[VX] = velocity.x, row[VY] = velocity.y, row[VZ] = velocity.z;
    row[TEMPERATURE] = square / (mass * view->dimension);
    return PLS_OK;
}

static pls_status update(const pls_observer_view *view, double *memory)
{
    double row[COLUMNS];
    PLS_TRY(measure(view, row));
    memory[0] = fmax(memory[0], row[TEMPERATURE]);
    return PLS_OK;
}

static pls_status look(const pls_observer_view *view, const double *memory, double *row)
{
    row[LARGEST] = memory[0];
    return measure(view, row);
}

static const pls_observer_ops granular_temperature = {
    .api_version = PLS_API_VERSION,
    .name = "granular_temperature",
    .meaning = "centre of mass, its velocity, and the mean square velocity about it",
    .columns = columns,
    .memory = 1,
    .update = update,
    .look = look,
};

const uint32_t particls_plugin_api = PLS_API_VERSION;
pls_status particls_plugin(pls_plugin_host *host);
pls_status particls_plugin(pls_plugin_host *host) { return host->add_observer(host, &granular_temperature); }
