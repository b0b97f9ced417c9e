// world.c -- making a world and putting things into it.

#include "step/world.h"

#include "base/alloc.h"
#include "shape/builtin.h"
#include "step/bonds.h"
#include "step/derived.h"

#include <stdio.h>
#include <string.h>

enum { COOKIE = 0x706c7331 };

pls_world_def pls_default_world_def(int dimension)
{
    return (pls_world_def){.dimension = dimension,
                           .thickness = 1.0,
                           .safety = 0.5,
                           .coordination = dimension == 2 ? 6 : 12,
                           .reorder = true,
                           .max_overlap = 1.0,
                           .cookie = COOKIE};
}

pls_material_def pls_default_material_def(void)
{
    return (pls_material_def){.values = {.density = NAN, .young_modulus = NAN, .poisson_ratio = NAN}, .cookie = COOKIE};
}

pls_body_def pls_default_body_def(void)
{
    return (pls_body_def){.orientation = {1.0, 0.0, 0.0, 0.0}, .scale = 1.0, .mass = NAN, .inertia = {NAN, NAN, NAN}, .cookie = COOKIE};
}

pls_state_def pls_default_state_def(void) { return (pls_state_def){.components = 1, .cookie = COOKIE}; }

static pls_status check_cookie(uint32_t cookie, const char *maker)
{
    return cookie == COOKIE ? PLS_OK : pls_fail(PLS_INVALID_ARGUMENT, "start from %s() and change what you need", maker);
}

static bool finite_vec(pls_vec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }

static pls_status check_world_def(const pls_world_def *def)
{
    PLS_TRY(check_cookie(def->cookie, "pls_default_world_def"));
    if (def->dimension != 2 && def->dimension != 3)
        return pls_fail(PLS_INVALID_ARGUMENT, "the dimension is %d; it must be 2 or 3", def->dimension);
    if (!(def->thickness > 0.0) || !isfinite(def->thickness))
        return pls_fail(PLS_INVALID_ARGUMENT, "the thickness is %g m; it must be positive", def->thickness);
    if (!(def->dt >= 0.0) || !isfinite(def->dt))
        return pls_fail(PLS_INVALID_ARGUMENT, "the time step is %g s; it must be positive, or 0 to have it chosen", def->dt);
    if (!(def->safety > 0.0 && def->safety <= 1.0))
        return pls_fail(PLS_INVALID_ARGUMENT, "safety is %g; it must lie in (0, 1]", def->safety);
    if (!(def->skin >= 0.0) || !isfinite(def->skin))
        return pls_fail(PLS_INVALID_ARGUMENT, "the skin is %g m; it must be positive, or 0 to have it tuned", def->skin);
    if (!(def->local_damping >= 0.0 && def->local_damping < 1.0))
        return pls_fail(PLS_INVALID_ARGUMENT, "the local damping is %g; it must lie in [0, 1)", def->local_damping);
    if (def->coordination < 0)
        return pls_fail(PLS_INVALID_ARGUMENT, "the assumed coordination is %d; it must not be negative", def->coordination);
    if (!(def->max_overlap > 0.0)) return pls_fail(PLS_INVALID_ARGUMENT, "max_overlap is %g; it must be positive", def->max_overlap);
    const double lower[3] = {def->lower.x, def->lower.y, def->lower.z}, upper[3] = {def->upper.x, def->upper.y, def->upper.z};
    for (int a = 0; a < 3; ++a)
        if (def->periodic[a] && !(upper[a] > lower[a] && isfinite(upper[a] - lower[a])))
            return pls_fail(PLS_INVALID_ARGUMENT, "the periodic box has lower %g m and upper %g m along %c; upper must be larger", lower[a],
                            upper[a], "xyz"[a]);
    if (def->dimension == 2 && def->periodic[2]) return pls_fail(PLS_INVALID_ARGUMENT, "a 2D world cannot be periodic along z");
    if (!finite_vec(def->stretch_rate)) return pls_fail(PLS_INVALID_ARGUMENT, "the stretch rate is not finite");
    return PLS_OK;
}

pls_status pls_world_create(const pls_world_def *def, pls_world **out)
{
    *out = NULL;
    PLS_TRY(check_world_def(def));
    pls_world *world = NULL;
    PLS_TRY(pls_allocate(&world, 1, sizeof *world, "the world"));
    const pls_status status = pls_allocate(&world->derived, 1, sizeof *world->derived, "the world");
    if (status != PLS_OK)
    {
        pls_release(&world);
        return status;
    }
    world->def = *def;
    world->dt = def->dt;
    pls_domain *domain = &world->domain;
    *domain = (pls_domain){.dimension = def->dimension, .thickness = def->dimension == 2 ? def->thickness : 1.0};
    const double lower[3] = {def->lower.x, def->lower.y, def->lower.z}, upper[3] = {def->upper.x, def->upper.y, def->upper.z};
    const double rate[3] = {def->stretch_rate.x, def->stretch_rate.y, def->stretch_rate.z};
    for (int a = 0; a < 3; ++a)
    {
        domain->periodic[a] = def->periodic[a];
        domain->any_periodic = domain->any_periodic || def->periodic[a];
        domain->lower[a] = lower[a];
        domain->edge_start[a] = upper[a] - lower[a];
        domain->rate[a] = rate[a];
    }
    pls_domain_at(domain, 0.0);
    world->list.stale = true;
    world->special_stale = true;
    *out = world;
    return PLS_OK;
}

void pls_world_destroy(pls_world *world)
{
    if (!world) return;
    for (size_t k = 0; k < world->motion_count; ++k)
        if (world->motion[k].destroy) world->motion[k].destroy(world->motion[k].context);
    for (size_t k = 0; k < world->force_count; ++k)
        if (world->force[k].ops->destroy) world->force[k].ops->destroy(world->force[k].context);
    for (size_t k = 0; k < world->state_count; ++k)
        if (world->state[k].def.destroy) world->state[k].def.destroy(world->state[k].def.context);
    for (size_t k = 0; k < world->binding_count; ++k)
        if (world->binding[k].destroy) world->binding[k].destroy(world->binding[k].context);
    pls_bodies_free(&world->bodies);
    pls_law_table_free(&world->laws);
    pls_pair_list_free(&world->list);
    pls_contact_memory_free(&world->memory);
    for (size_t k = 0; k < world->shape_count; ++k) pls_shape_free(world->shape[k].shape);
    pls_release(&world->shape);
    pls_release(&world->shape_of);
    pls_solid_list_free(&world->solids);
    pls_solid_records_free(&world->records);
    pls_bonds_free(world);
    pls_release(&world->group);
    pls_release(&world->motion);
    pls_release(&world->force);
    pls_release(&world->state);
    pls_release(&world->state_value);
    pls_release(&world->state_half);
    pls_release(&world->state_rate);
    pls_release(&world->binding);
    pls_parted_free(world);
    pls_release(&world->left);
    pls_release(&world->work);
    pls_release(&world->special);
    pls_release(&world->quotient);
    if (world->derived) pls_derived_free(world->derived);
    pls_release(&world->derived);
    pls_release(&world);
}

// ---- shapes, materials, laws ---------------------------------------------------------------------------------------------------------------------------

static pls_status check_name(const char *name, const char *what)
{
    if (!name || !name[0]) return pls_fail(PLS_INVALID_ARGUMENT, "%s needs a name", what);
    if (strlen(name) >= PLS_NAME_SIZE)
        return pls_fail(PLS_INVALID_ARGUMENT, "the name '%.20s...' is longer than %d letters", name, PLS_NAME_SIZE - 1);
    return PLS_OK;
}

pls_status pls_world_use_shape(pls_world *world, const char *name, pls_shape *shape, pls_shape_id *id)
{
    *id = (pls_shape_id){0};
    PLS_TRY(check_name(name, "a shape"));
    if (pls_world_find_shape(world, name).index1) return pls_fail(PLS_DUPLICATE, "there is a shape '%s' already", name);
    if (shape->dimension != world->def.dimension)
        return pls_fail(PLS_INVALID_ARGUMENT, "shape '%s' is made for %dD, this world is %dD", name, shape->dimension,
                        world->def.dimension);
    if (world->shape_count >= UINT16_MAX - 1) return pls_fail(PLS_LIMIT_EXCEEDED, "a world holds at most %d shapes", UINT16_MAX - 1);
    PLS_TRY(pls_reserve(&world->shape, &world->shape_capacity, world->shape_count + 1, sizeof *world->shape, "shapes"));
    PLS_TRY(pls_reserve(&world->shape_of, &world->shape_of_capacity, world->shape_count + 1, sizeof *world->shape_of, "shapes"));
    world->shape_of[world->shape_count] = shape;
    pls_shape_instance *instance = &world->shape[world->shape_count];
    *instance = (pls_shape_instance){.shape = pls_shape_keep(shape)};
    snprintf(instance->name, sizeof instance->name, "%s", name);
    id->index1 = (uint16_t)++world->shape_count;
    return PLS_OK;
}

pls_status pls_world_add_shape(pls_world *world, const char *name, const pls_shape_ops *ops, const double *values, size_t value_count,
                               pls_shape_id *id)
{
    *id = (pls_shape_id){0};
    PLS_TRY(check_name(name, "a shape"));
    char owner[PLS_NAME_SIZE + 16];
    snprintf(owner, sizeof owner, "shape '%s'", name);
    pls_shape *shape = NULL;
    const pls_shape_input input = {.values = values, .value_count = value_count};
    PLS_TRY(pls_shape_make(ops, world->def.dimension, &input, owner, &shape));
    pls_status status = pls_world_use_shape(world, name, shape, id);
    pls_shape_free(shape);
    return status;
}

pls_status pls_world_add_material(pls_world *world, const pls_material_def *def, pls_material_id *id)
{
    *id = (pls_material_id){0};
    PLS_TRY(check_cookie(def->cookie, "pls_default_material_def"));
    PLS_TRY(check_name(def->name, "a material"));
    if (pls_world_find_material(world, def->name).index1) return pls_fail(PLS_DUPLICATE, "there is a material '%s' already", def->name);
    if (!isnan(def->values.density) && !(def->values.density > 0.0))
        return pls_fail(PLS_INVALID_ARGUMENT, "material '%s' has density %g kg/m^3; it must be positive", def->name, def->values.density);
    PLS_TRY(pls_neighbours_detach(world));
    uint16_t index;
    PLS_TRY(pls_law_table_add_material(&world->laws, def->name, &def->values, &index));
    id->index1 = (uint16_t)(index + 1);
    return PLS_OK;
}

pls_status pls_world_add_group(pls_world *world, const char *name, pls_group_id *id)
{
    *id = (pls_group_id){0};
    PLS_TRY(check_name(name, "a group"));
    if (pls_world_find_group(world, name).index1) return pls_fail(PLS_DUPLICATE, "there is a group '%s' already", name);
    PLS_TRY(pls_reserve(&world->group, &world->group_capacity, world->group_count + 1, sizeof *world->group, "groups"));
    snprintf(world->group[world->group_count], PLS_NAME_SIZE, "%s", name);
    id->index1 = (uint32_t)++world->group_count;
    return PLS_OK;
}

static pls_status check_material(const pls_world *world, pls_material_id id)
{
    return id.index1 >= 1 && id.index1 <= world->laws.material_count
               ? PLS_OK
               : pls_fail(PLS_INVALID_ARGUMENT, "a material id names no material of this world");
}

/// Contacts between two materials begin anew.
static void forget_contacts(pls_world *world, uint16_t a, uint16_t b)
{
    size_t kept = 0;
    for (size_t k = 0; k < world->memory.count; ++k)
    {
        struct pls_remembered *entry = &world->memory.entry[k];
        uint16_t i = world->bodies.kind[world->bodies.row_of[entry->number_i]].material,
                 j = world->bodies.kind[world->bodies.row_of[entry->number_j]].material;
        if (!((i == a && j == b) || (i == b && j == a))) world->memory.entry[kept++] = *entry;
    }
    world->memory.count = kept;
    kept = 0;
    for (size_t k = 0; k < world->records.count; ++k)
    {
        pls_solid_memory *entry = &world->records.entry[k];
        uint16_t i = world->bodies.kind[world->bodies.row_of[entry->number_i]].material,
                 j = world->bodies.kind[world->bodies.row_of[entry->number_j]].material;
        if (!((i == a && j == b) || (i == b && j == a))) world->records.entry[kept++] = *entry;
    }
    world->records.count = kept;
}

pls_status pls_world_set_law(pls_world *world, pls_material_id a, pls_material_id b, const pls_law_ops *ops, const double *values)
{
    PLS_TRY(check_material(world, a));
    PLS_TRY(check_material(world, b));
    PLS_TRY(pls_neighbours_detach(world));
    uint16_t index;
    PLS_TRY(pls_law_table_set(&world->laws, (uint16_t)(a.index1 - 1), (uint16_t)(b.index1 - 1), ops, values, &index));
    forget_contacts(world, (uint16_t)(a.index1 - 1), (uint16_t)(b.index1 - 1));
    return PLS_OK;
}

static pls_status find_law(const pls_world *world, pls_material_id a, pls_material_id b, uint16_t *index)
{
    PLS_TRY(check_material(world, a));
    PLS_TRY(check_material(world, b));
    *index = pls_law_table_find(&world->laws, (uint16_t)(a.index1 - 1), (uint16_t)(b.index1 - 1));
    if (*index == PLS_NO_LAW)
        return pls_fail(PLS_NOT_FOUND, "there is no law between '%s' and '%s'", world->laws.material[a.index1 - 1].name,
                        world->laws.material[b.index1 - 1].name);
    return PLS_OK;
}

pls_status pls_world_set_lever_at_surface(pls_world *world, pls_material_id a, pls_material_id b, bool at_surface)
{
    uint16_t index;
    PLS_TRY(find_law(world, a, b, &index));
    world->laws.law[index].lever_at_surface = at_surface;
    return PLS_OK;
}

pls_status pls_world_set_narrow_options(pls_world *world, pls_material_id a, pls_material_id b, const pls_narrow_options *options)
{
    uint16_t index;
    PLS_TRY(find_law(world, a, b, &index));
    if (options->faces == PLS_FACES_VOLUME && !(options->face_area > 0.0 && isfinite(options->face_area)))
        return pls_fail(PLS_INVALID_ARGUMENT, "the volume law needs face_area, an area over which the law's stiffness acts [m^2]; it is %g",
                        options->face_area);
    if (options->solver == PLS_SOLVER_ADMM && options->faces != PLS_FACES_POINT)
        return pls_fail(PLS_INVALID_ARGUMENT,
                        "solver admm gives one point per contact: set faces to point; manifold and volume need solver depth");
    if (!(options->tolerance > 0.0 && options->tolerance < 0.1))
        return pls_fail(PLS_INVALID_ARGUMENT, "the solver's tolerance is %g; it must lie between 0 and 0.1", options->tolerance);
    PLS_TRY(pls_neighbours_detach(world));
    world->laws.law[index].narrow = *options;
    return PLS_OK;
}

pls_status pls_world_set_law_parameter(pls_world *world, pls_material_id a, pls_material_id b, const char *name, double value)
{
    uint16_t index;
    PLS_TRY(find_law(world, a, b, &index));
    pls_law *law = &world->laws.law[index];
    int place = pls_parameter_find(law->ops->parameters, name);
    if (place < 0) return pls_fail(PLS_NOT_FOUND, "law '%s' has no parameter '%s'", law->ops->name, name);
    double before = law->values[place];
    law->values[place] = value;
    pls_status status = pls_law_table_prepare(&world->laws, index);
    if (status != PLS_OK) law->values[place] = before;
    return status;
}

static double *material_value(pls_material_values *values, const char *name)
{
    if (strcmp(name, "density") == 0) return &values->density;
    if (strcmp(name, "young_modulus") == 0) return &values->young_modulus;
    if (strcmp(name, "poisson_ratio") == 0) return &values->poisson_ratio;
    return NULL;
}

pls_status pls_world_set_material_value(pls_world *world, pls_material_id material, const char *name, double value)
{
    PLS_TRY(check_material(world, material));
    double *place = material_value(&world->laws.material[material.index1 - 1].values, name);
    if (!place) return pls_fail(PLS_NOT_FOUND, "a material has no value '%s'; it has density, young_modulus and poisson_ratio", name);
    double before = *place;
    *place = value;
    pls_status status = pls_law_table_prepare_material(&world->laws, (uint16_t)(material.index1 - 1));
    if (status != PLS_OK) *place = before;
    return status;
}

// ---- bindings ------------------------------------------------------------------------------------------------------------------------------------------

static pls_status add_binding(pls_world *world, const pls_binding *binding)
{
    pls_status status =
        pls_reserve(&world->binding, &world->binding_capacity, world->binding_count + 1, sizeof *world->binding, "bound parameters");
    if (status == PLS_OK)
        world->binding[world->binding_count++] = *binding;
    else if (binding->destroy)
        binding->destroy(binding->context);
    return status;
}

pls_status pls_world_bind_law_parameter(pls_world *world, pls_material_id a, pls_material_id b, const char *name,
                                        pls_parameter_function *function, void *context, void (*destroy)(void *))
{
    pls_binding binding = {.function = function, .context = context, .destroy = destroy, .a = a.index1, .b = b.index1};
    uint16_t index;
    pls_status status = find_law(world, a, b, &index);
    if (status == PLS_OK && pls_parameter_find(world->laws.law[index].ops->parameters, name) < 0)
        status = pls_fail(PLS_NOT_FOUND, "law '%s' has no parameter '%s'", world->laws.law[index].ops->name, name);
    if (status != PLS_OK)
    {
        if (destroy) destroy(context);
        return status;
    }
    snprintf(binding.name, sizeof binding.name, "%s", name);
    return add_binding(world, &binding);
}

pls_status pls_world_bind_force_parameter(pls_world *world, pls_force_id force, const char *name, pls_parameter_function *function,
                                          void *context, void (*destroy)(void *))
{
    pls_binding binding = {.function = function, .context = context, .destroy = destroy, .force = force};
    int place;
    pls_status status = pls_find_force_parameter(world, force, name, &place);
    if (status != PLS_OK)
    {
        if (destroy) destroy(context);
        return status;
    }
    snprintf(binding.name, sizeof binding.name, "%s", name);
    return add_binding(world, &binding);
}

pls_status pls_world_bind_material_value(pls_world *world, pls_material_id material, const char *name, pls_parameter_function *function,
                                         void *context, void (*destroy)(void *))
{
    pls_binding binding = {.function = function, .context = context, .destroy = destroy, .a = material.index1, .of_material = true};
    pls_material_values probe = {0};
    pls_status status = check_material(world, material);
    if (status == PLS_OK && !material_value(&probe, name)) status = pls_fail(PLS_NOT_FOUND, "a material has no value '%s'", name);
    if (status != PLS_OK)
    {
        if (destroy) destroy(context);
        return status;
    }
    snprintf(binding.name, sizeof binding.name, "%s", name);
    return add_binding(world, &binding);
}

// ---- states --------------------------------------------------------------------------------------------------------------------------------------------

static pls_status reserve_values(pls_world *world, size_t count)
{
    size_t capacity = world->value_capacity;
    PLS_TRY(pls_reserve(&world->state_value, &capacity, count, sizeof *world->state_value, "states"));
    capacity = world->value_capacity;
    PLS_TRY(pls_reserve(&world->state_half, &capacity, count, sizeof *world->state_half, "states"));
    capacity = world->value_capacity;
    PLS_TRY(pls_reserve(&world->state_rate, &capacity, count, sizeof *world->state_rate, "states"));
    world->value_capacity = capacity;
    return PLS_OK;
}

static pls_status check_state(pls_world *world, const pls_state_def *def)
{
    PLS_TRY(check_cookie(def->cookie, "pls_default_state_def"));
    PLS_TRY(check_name(def->name, "a state"));
    if (pls_world_find_state(world, def->name).index1) return pls_fail(PLS_DUPLICATE, "there is a state '%s' already", def->name);
    if (def->components < 1 || def->components > PLS_STATE_MAX_COMPONENTS)
        return pls_fail(PLS_INVALID_ARGUMENT, "state '%s' has %d components; it must have 1 to %d", def->name, def->components,
                        PLS_STATE_MAX_COMPONENTS);
    if (!def->rate) return pls_fail(PLS_INVALID_ARGUMENT, "state '%s' has no rate", def->name);
    bool has_body = def->body.index1 != 0;
    if (has_body && pls_body_row(world, def->body) == PLS_NO_ROW)
        return pls_fail(PLS_STALE_ID, "the body of state '%s' does not exist", def->name);
    if (def->target != PLS_STATE_FREE && !has_body)
        return pls_fail(PLS_INVALID_ARGUMENT, "state '%s' drives a scale but has no body", def->name);
    for (int c = 0; c < def->components; ++c)
        if (!isfinite(def->initial[c])) return pls_fail(PLS_INVALID_ARGUMENT, "state '%s' starts from %g", def->name, def->initial[c]);
    PLS_TRY(pls_reserve(&world->state, &world->state_capacity, world->state_count + 1, sizeof *world->state, "states"));
    return reserve_values(world, world->value_count + (size_t)def->components);
}

pls_status pls_world_add_state(pls_world *world, const pls_state_def *def, pls_state_id *id)
{
    *id = (pls_state_id){0};
    pls_status status = check_state(world, def);
    if (status != PLS_OK)
    {
        if (def->destroy) def->destroy(def->context);
        return status;
    }
    pls_state_instance *state = &world->state[world->state_count];
    *state = (pls_state_instance){.def = *def, .first = world->value_count};
    memcpy(world->state_value + state->first, def->initial, (size_t)def->components * sizeof(double));
    world->value_count += (size_t)def->components;
    id->index1 = (uint32_t)++world->state_count;
    return PLS_OK;
}

// ---- bodies --------------------------------------------------------------------------------------------------------------------------------------------

uint32_t pls_body_row(const pls_world *world, pls_body_id id)
{
    uint32_t number = id.index1 - 1;
    if (id.index1 == 0 || number >= world->bodies.numbers || world->bodies.generation_of[number] != id.generation) return PLS_NO_ROW;
    return world->bodies.row_of[number];
}

static pls_status check_body_def(const pls_world *world, const pls_body_def *def)
{
    PLS_TRY(check_cookie(def->cookie, "pls_default_body_def"));
    if (def->shape.index1 < 1 || def->shape.index1 > world->shape_count)
        return pls_fail(PLS_INVALID_ARGUMENT, "a body needs a shape of this world");
    PLS_TRY(check_material(world, def->material));
    if (def->group.index1 > world->group_count) return pls_fail(PLS_INVALID_ARGUMENT, "a body's group does not exist");
    if (!finite_vec(def->position) || !finite_vec(def->velocity) || !finite_vec(def->angular_velocity))
        return pls_fail(PLS_INVALID_ARGUMENT, "a body's position or velocity is not finite");
    if (!(def->scale > 0.0) || !isfinite(def->scale))
        return pls_fail(PLS_INVALID_ARGUMENT, "a body's scale is %g; it must be positive", def->scale);
    const pls_quat *q = &def->orientation;
    double norm = q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z;
    if (!(fabs(norm - 1.0) < 1e-6))
        return pls_fail(PLS_INVALID_ARGUMENT, "a body's orientation has length %g; it must be a unit quaternion", sqrt(norm));
    if (world->def.dimension == 2)
    {
        if (def->position.z != 0.0 || def->velocity.z != 0.0 || def->angular_velocity.x != 0.0 || def->angular_velocity.y != 0.0 ||
            q->x != 0.0 || q->y != 0.0)
            return pls_fail(PLS_INVALID_ARGUMENT, "in 2D bodies lie in the x-y plane and turn about z");
    }
    const pls_motion_def *m = &def->motion;
    if (m->axes & ~(unsigned)PLS_AXIS_ALL) return pls_fail(PLS_INVALID_ARGUMENT, "a motion's axes are wrong");
    if (m->about && (m->axes != PLS_AXIS_ALL || m->velocity.x != 0.0 || m->velocity.y != 0.0 || m->velocity.z != 0.0))
        return pls_fail(PLS_INVALID_ARGUMENT, "a rotation about a point prescribes all axes and has no velocity of its own");
    return PLS_OK;
}

/// Mass and moments at unit scale from the shape, or as given.
static pls_status body_mass(const pls_world *world, const pls_body_def *def, pls_body_mass *out)
{
    const pls_shape *shape = world->shape[def->shape.index1 - 1].shape;
    if (shape->ops->unbounded || shape->ops->wall)
    {
        *out = (pls_body_mass){INFINITY, INFINITY, INFINITY, INFINITY};
        return PLS_OK;
    }
    const pls_material *material = &world->laws.material[def->material.index1 - 1];
    double density = material->values.density * world->domain.thickness, s = def->scale;
    double volume_scale = world->def.dimension == 2 ? s * s : s * s * s;
    double mass = isnan(def->mass) ? density * shape->mass.volume * volume_scale : def->mass;
    if (isnan(mass))
        return pls_fail(PLS_INVALID_ARGUMENT, "material '%s' has no density, and a body of it has no mass of its own", material->name);
    if (!(mass > 0.0) || !isfinite(mass)) return pls_fail(PLS_INVALID_ARGUMENT, "a body has mass %g kg; it must be positive", mass);
    double per_mass = s * s / shape->mass.volume; // moments of the shape as they are at this mass
    pls_vec3 from_shape = pls_scale(shape->moments, mass * per_mass);
    *out = (pls_body_mass){mass, isnan(def->inertia.x) ? from_shape.x : def->inertia.x,
                           isnan(def->inertia.y) ? from_shape.y : def->inertia.y, isnan(def->inertia.z) ? from_shape.z : def->inertia.z};
    bool wrong = !(out->iz > 0.0) || (world->def.dimension == 3 && (!(out->ix > 0.0) || !(out->iy > 0.0)));
    if (wrong)
        return pls_fail(PLS_INVALID_ARGUMENT, "a body has moments of inertia %g, %g, %g kg m^2; they must be positive", out->ix, out->iy,
                        out->iz);
    if (world->def.dimension == 3)
    {
        double largest = fmax(out->ix, fmax(out->iy, out->iz));
        if (2.0 * largest > (out->ix + out->iy + out->iz) * (1.0 + 1e-12))
            return pls_fail(PLS_INVALID_ARGUMENT,
                            "moments of inertia %g, %g, %g kg m^2 belong to no body: the largest exceeds the sum of the others", out->ix,
                            out->iy, out->iz);
    }
    return PLS_OK;
}

static uint32_t motion_flags(const pls_world *world, const pls_body_def *def, const pls_body_mass *mass)
{
    const pls_motion_def *m = &def->motion;
    unsigned axes = world->def.dimension == 2 ? m->axes | PLS_AXIS_Z | PLS_AXIS_RX | PLS_AXIS_RY : m->axes;
    const pls_shape *shape = world->shape[def->shape.index1 - 1].shape;
    bool unbounded = shape->ops->unbounded || shape->ops->wall;
    uint32_t flags = unbounded ? PLS_BODY_UNBOUNDED : 0;
    if (!pls_shape_is_ball(shape) && !pls_shape_is_plane(shape)) flags |= PLS_BODY_SOLID;
    if (unbounded && m->axes == 0) axes = PLS_AXIS_ALL; // a wall without motion stands still
    if (axes == PLS_AXIS_ALL) flags |= PLS_BODY_DRIVEN;
    bool turns = m->angular_velocity.x != 0.0 || m->angular_velocity.y != 0.0 || m->angular_velocity.z != 0.0;
    if (m->axes && (axes != PLS_AXIS_ALL || m->function || m->about || turns)) flags |= PLS_BODY_SPECIAL;
    if (world->def.dimension == 3 && !(flags & PLS_BODY_DRIVEN) && !(mass->ix == mass->iy && mass->iy == mass->iz))
        flags |= PLS_BODY_ANISOTROPIC;
    return flags;
}

static pls_status add_body(pls_world *world, const pls_body_def *def, pls_body_id *id)
{
    pls_body_mass mass = {0};
    PLS_TRY(check_body_def(world, def));
    PLS_TRY(body_mass(world, def, &mass));
    bool has_motion = def->motion.axes != 0;
    if (has_motion)
        PLS_TRY(pls_reserve(&world->motion, &world->motion_capacity, world->motion_count + 1, sizeof *world->motion, "motions"));
    PLS_TRY(pls_neighbours_detach(world));
    pls_bodies *bodies = &world->bodies;
    uint32_t row;
    PLS_TRY(pls_bodies_add(bodies, &row));
    uint32_t flags = motion_flags(world, def, &mass);
    pls_vec3 v = def->velocity, w = def->angular_velocity;
    if ((flags & PLS_BODY_DRIVEN) && !(has_motion && def->motion.function)) v = def->motion.velocity, w = def->motion.angular_velocity;
    const pls_shape *shape = world->shape[def->shape.index1 - 1].shape;
    double inv_mass = (flags & (PLS_BODY_DRIVEN | PLS_BODY_UNBOUNDED)) ? 0.0 : 1.0 / mass.mass;
    double inv_inertia = (flags & (PLS_BODY_DRIVEN | PLS_BODY_UNBOUNDED | PLS_BODY_ANISOTROPIC)) ? 0.0 : 1.0 / mass.iz;
    bodies->place[row] = (pls_body_place){def->position.x,
                                          def->position.y,
                                          def->position.z,
                                          (flags & PLS_BODY_UNBOUNDED) ? INFINITY : shape->radius * def->scale,
                                          v.x,
                                          v.y,
                                          v.z,
                                          0.0};
    bodies->load[row] = (pls_body_load){.inv_mass = inv_mass, .inv_inertia = inv_inertia};
    bodies->spin[row] = (pls_body_spin){.wx = w.x, .wy = w.y, .wz = w.z};
    pls_quat q = pls_quat_unit(def->orientation);
    bodies->orientation[row] = (pls_body_orientation){q.w, q.x, q.y, q.z};
    bodies->mass[row] = mass;
    bodies->scale[row] = def->scale;
    pls_body_kind *kind = &bodies->kind[row];
    kind->group = def->group.index1;
    kind->shape = (uint16_t)(def->shape.index1 - 1);
    kind->material = (uint16_t)(def->material.index1 - 1);
    kind->flags = flags;
    if (has_motion)
    {
        world->motion[world->motion_count] = def->motion;
        kind->motion = (uint32_t)++world->motion_count;
    }
    world->special_stale = true;
    *id = (pls_body_id){kind->number + 1, kind->generation};
    return PLS_OK;
}

pls_status pls_world_add_body(pls_world *world, const pls_body_def *def, pls_body_id *id)
{
    *id = (pls_body_id){0, 0};
    size_t motions = world->motion_count;
    pls_status status = add_body(world, def, id);
    if (status != PLS_OK && world->motion_count == motions && def->motion.destroy) def->motion.destroy(def->motion.context);
    return status;
}

pls_status pls_world_reserve_bodies(pls_world *world, size_t count)
{
    return pls_bodies_reserve(&world->bodies, world->bodies.numbers + count);
}

pls_status pls_world_remove_body(pls_world *world, pls_body_id id)
{
    uint32_t row = pls_body_row(world, id);
    if (row == PLS_NO_ROW) return pls_fail(PLS_STALE_ID, "the body to remove does not exist (any more)");
    PLS_TRY(pls_neighbours_detach(world));
    pls_solid_list_forget(&world->solids); // its number may be that of another shape next
    uint32_t number = id.index1 - 1;
    size_t kept = 0;
    for (size_t k = 0; k < world->memory.count; ++k)
    {
        struct pls_remembered entry = world->memory.entry[k];
        if (entry.number_i != number && entry.number_j != number) world->memory.entry[kept++] = entry;
    }
    world->memory.count = kept;
    kept = 0;
    for (size_t k = 0; k < world->records.count; ++k)
        if (world->records.entry[k].number_i != number && world->records.entry[k].number_j != number)
            world->records.entry[kept++] = world->records.entry[k];
    world->records.count = kept;
    pls_bonds_leave(world, number);
    pls_bodies_remove(&world->bodies, row);
    world->special_stale = true;
    return PLS_OK;
}

pls_status pls_body_rescale(pls_world *world, uint32_t row, double scale, bool keep_density)
{
    pls_bodies *bodies = &world->bodies;
    if (!(scale > 0.0) || !isfinite(scale))
        return pls_fail(PLS_INVALID_ARGUMENT, "body %u would get scale %g at t = %g s; it must stay positive", bodies->kind[row].number,
                        scale, world->time);
    double ratio = scale / bodies->scale[row];
    if (ratio == 1.0) return PLS_OK;
    bodies->scale[row] = scale;
    bodies->place[row].radius = world->shape[bodies->kind[row].shape].shape->radius * scale;
    pls_body_mass *mass = &bodies->mass[row];
    double mass_ratio = !keep_density ? 1.0 : world->def.dimension == 2 ? ratio * ratio : ratio * ratio * ratio;
    double inertia_ratio = mass_ratio * ratio * ratio;
    mass->mass *= mass_ratio;
    mass->ix *= inertia_ratio;
    mass->iy *= inertia_ratio;
    mass->iz *= inertia_ratio;
    if (bodies->load[row].inv_mass != 0.0) bodies->load[row].inv_mass = 1.0 / mass->mass;
    if (bodies->load[row].inv_inertia != 0.0) bodies->load[row].inv_inertia = 1.0 / mass->iz;
    return PLS_OK;
}

// ---- asking --------------------------------------------------------------------------------------------------------------------------------------------

double pls_world_time(const pls_world *world) { return world->time; }
uint64_t pls_world_step_number(const pls_world *world) { return world->step; }
double pls_world_dt(const pls_world *world) { return world->dt; }
int pls_world_dimension(const pls_world *world) { return world->def.dimension; }
size_t pls_world_body_count(const pls_world *world) { return world->bodies.count; }
size_t pls_world_contact_count(const pls_world *world)
{
    if (!world->memory_holds) return pls_pair_list_touching(&world->list) + pls_solid_list_touching(&world->solids);
    size_t solid = 0;
    for (size_t k = 0; k < world->records.count; ++k) solid += world->records.entry[k].touches == PLS_SOLID_TOUCHES;
    return world->memory.count + solid;
}

pls_narrow_counts pls_world_narrow_counts(const pls_world *world) { return world->solids.counts; }

const uint32_t *pls_world_rows_by_number(const pls_world *world, size_t *count)
{
    *count = world->bodies.numbers;
    return world->bodies.row_of;
}

pls_body_id pls_world_next_body(const pls_world *world, pls_group_id group, pls_body_id previous)
{
    const pls_bodies *b = &world->bodies;
    for (size_t number = previous.index1; number < b->numbers; ++number) // its number is index1 - 1
    {
        uint32_t row = b->row_of[number];
        if (row == PLS_NO_ROW || (group.index1 && b->kind[row].group != group.index1)) continue;
        return (pls_body_id){(uint32_t)number + 1, b->generation_of[number]};
    }
    return (pls_body_id){0};
}

pls_status pls_body_get(const pls_world *world, pls_body_id id, pls_body_motion *m)
{
    uint32_t row = pls_body_row(world, id);
    if (row == PLS_NO_ROW) return pls_fail(PLS_STALE_ID, "the body asked for does not exist (any more)");
    const pls_bodies *b = &world->bodies;
    const pls_body_place *p = &b->place[row];
    const pls_body_spin *s = &b->spin[row];
    const pls_body_load *l = &b->load[row];
    const pls_body_orientation *q = &b->orientation[row];
    *m = (pls_body_motion){.position = {p->x, p->y, p->z},
                           .velocity = {p->vx, p->vy, p->vz},
                           .angular_velocity = {s->wx, s->wy, s->wz},
                           .orientation = {q->w, q->x, q->y, q->z},
                           .force = {l->fx, l->fy, l->fz},
                           .torque = {l->tx, l->ty, l->tz},
                           .scale = b->scale[row],
                           .radius = p->radius,
                           .mass = b->mass[row].mass};
    return PLS_OK;
}

pls_status pls_body_set_velocity(pls_world *world, pls_body_id id, pls_vec3 v, pls_vec3 w)
{
    uint32_t row = pls_body_row(world, id);
    if (row == PLS_NO_ROW) return pls_fail(PLS_STALE_ID, "the body to set does not exist (any more)");
    if (!finite_vec(v) || !finite_vec(w)) return pls_fail(PLS_INVALID_ARGUMENT, "the velocity to set is not finite");
    if (world->def.dimension == 2 && (v.z != 0.0 || w.x != 0.0 || w.y != 0.0))
        return pls_fail(
            PLS_INVALID_ARGUMENT,
            "the velocity to set has v_z = %g m/s, w_x = %g rad/s, w_y = %g rad/s; in 2D bodies stay in the x-y plane and turn about z",
            v.z, w.x, w.y);
    // A turning wall sweeps far points quickly, so its list holds all bodies; that of a wall at rest does not.
    if (world->bodies.kind[row].flags & PLS_BODY_UNBOUNDED) PLS_TRY(pls_neighbours_detach(world));
    pls_body_place *p = &world->bodies.place[row];
    pls_body_spin *s = &world->bodies.spin[row];
    p->vx = v.x, p->vy = v.y, p->vz = v.z;
    s->wx = w.x, s->wy = w.y, s->wz = w.z;
    return PLS_OK;
}

static pls_state_instance *find_state(const pls_world *world, pls_state_id id)
{
    return id.index1 >= 1 && id.index1 <= world->state_count ? &world->state[id.index1 - 1] : NULL;
}

pls_status pls_state_get(const pls_world *world, pls_state_id id, double *values)
{
    const pls_state_instance *state = find_state(world, id);
    if (!state) return pls_fail(PLS_STALE_ID, "the state asked for does not exist");
    memcpy(values, world->state_value + state->first, (size_t)state->def.components * sizeof *values);
    return PLS_OK;
}

pls_status pls_state_set(pls_world *world, pls_state_id id, const double *values)
{
    const pls_state_instance *state = find_state(world, id);
    if (!state) return pls_fail(PLS_STALE_ID, "the state to set does not exist");
    for (int c = 0; c < state->def.components; ++c)
        if (!isfinite(values[c]))
            return pls_fail(PLS_INVALID_ARGUMENT, "component %d of state '%s' would be set to %g; it must be finite", c, state->def.name,
                            values[c]);
    memcpy(world->state_value + state->first, values, (size_t)state->def.components * sizeof *values);
    return PLS_OK;
}

pls_group_id pls_world_find_group(const pls_world *world, const char *name)
{
    for (size_t k = 0; k < world->group_count; ++k)
        if (strcmp(world->group[k], name) == 0) return (pls_group_id){(uint32_t)(k + 1)};
    return (pls_group_id){0};
}

pls_material_id pls_world_find_material(const pls_world *world, const char *name)
{
    for (size_t k = 0; k < world->laws.material_count; ++k)
        if (strcmp(world->laws.material[k].name, name) == 0) return (pls_material_id){(uint16_t)(k + 1)};
    return (pls_material_id){0};
}

pls_shape_id pls_world_find_shape(const pls_world *world, const char *name)
{
    for (size_t k = 0; k < world->shape_count; ++k)
        if (strcmp(world->shape[k].name, name) == 0) return (pls_shape_id){(uint16_t)(k + 1)};
    return (pls_shape_id){0};
}

pls_state_id pls_world_find_state(const pls_world *world, const char *name)
{
    for (size_t k = 0; k < world->state_count; ++k)
        if (strcmp(world->state[k].def.name, name) == 0) return (pls_state_id){(uint32_t)(k + 1)};
    return (pls_state_id){0};
}

const char *pls_world_group_name(const pls_world *world, pls_group_id id)
{
    return id.index1 >= 1 && id.index1 <= world->group_count ? world->group[id.index1 - 1] : "";
}
