// lattice.c -- blocks of material points, and the slow oracle.
#include "support/lattice.h"

#include "bond/bond_set.h"
#include "step/bonds.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

lattice_plan lattice_default(int dimension, size_t side)
{
    return (lattice_plan){.dimension = dimension,
                          .count = {side, side, dimension == 2 ? 1 : side},
                          .spacing = 0.1,
                          .horizon = 0.3015,
                          .density = 2.0,
                          .bulk = 10.0,
                          .shear = 4.0,
                          .thickness = 1.0,
                          .influence = PLS_INFLUENCE_INVERSE,
                          .critical_stretch = INFINITY,
                          .law = "linear_solid",
                          .contact_stiffness = 1.0,
                          .heat = {.conductivity = NAN},
                          .dt = 1e-3};
}

static const pls_bond_ops *find_law(const char *name)
{
    const pls_bond_ops *const *law = pls_builtin_bonds();
    while (*law && strcmp((*law)->name, name) != 0) ++law;
    if (!*law) verify_must(pls_fail(PLS_NOT_FOUND, "there is no bond law '%s'", name), name, __FILE__, __LINE__);
    return *law;
}

static void join(lattice *b)
{
    pls_bonds_def def = pls_default_bonds_def();
    snprintf(def.name, sizeof def.name, "block");
    def.ops = find_law(b->plan.law);
    def.horizon = b->plan.horizon;
    def.influence = b->plan.influence;
    def.correction = b->plan.correction;
    def.plane = b->plan.plane;
    def.critical_stretch = b->plan.critical_stretch;
    if (b->plan.fracture_energy > 0.0) def.fracture_energy = b->plan.fracture_energy;
    def.fracture = b->plan.fracture;
    def.condition = b->plan.condition;
    def.condition_changes = b->plan.condition_changes;
    def.user = b->plan.user;
    def.heat = b->plan.heat;
    const double beam[] = {0.4 * b->plan.spacing, 0.1 * b->plan.bulk, 0.1 * b->plan.bulk}; // radius and strengths
    def.values = def.ops->pair ? beam : b->plan.values;
    MUST(pls_world_add_bonds(b->scene.world, &def, &b->bonds));
}

static pls_material_id add_solid(lattice *b, const char *name, double stiffness)
{
    const double K = b->plan.bulk, mu = b->plan.shear;
    pls_material_id id;
    pls_material_def material = pls_default_material_def();
    snprintf(material.name, sizeof material.name, "%s", name);
    material.values = (pls_material_values){.density = b->plan.density,
                                            .young_modulus = stiffness * 9.0 * K * mu / (3.0 * K + mu),
                                            .poisson_ratio = (3.0 * K - 2.0 * mu) / (2.0 * (3.0 * K + mu))};
    MUST(pls_world_add_material(b->scene.world, &material, &id));
    return id;
}

lattice lattice_make(const lattice_plan *plan)
{
    lattice b = {.plan = *plan, .points = plan->count[0] * plan->count[1] * plan->count[2]};
    pls_world_def def = pls_default_world_def(plan->dimension);
    def.thickness = plan->thickness;
    def.dt = plan->dt;
    def.coordination = 0;
    def.allow_unstable = plan->unstable;
    def.upper =
        pls_vec(plan->spacing * (double)plan->count[0], plan->spacing * (double)plan->count[1], plan->spacing * (double)plan->count[2]);
    for (int a = 0; a < plan->dimension; ++a) def.periodic[a] = plan->periodic;
    b.scene.dimension = plan->dimension;
    MUST(pls_world_create(&def, &b.scene.world));
    const double radius = 0.5 * plan->spacing;
    b.scene.grain = add_solid(&b, "solid", 1.0);
    const pls_material_id second = plan->stiffer > 0.0 ? add_solid(&b, "stiffer", plan->stiffer) : b.scene.grain;
    const verify_value values[] = {{"kn", plan->contact_stiffness}, {NULL, 0.0}};
    verify_set_law(b.scene.world, b.scene.grain, b.scene.grain, "elastic", values);
    MUST(pls_world_add_shape(b.scene.world, "point", verify_shape(plan->dimension == 2 ? "disc" : "sphere"), &radius, 1, &b.scene.ball));
    b.reference = calloc(b.points, sizeof *b.reference);
    b.body = calloc(b.points, sizeof *b.body);
    for (size_t p = 0; p < b.points; ++p)
    {
        const size_t i = p % plan->count[0], j = p / plan->count[0] % plan->count[1], k = p / plan->count[0] / plan->count[1];
        b.reference[p] = pls_vec(plan->spacing * (double)i, plan->spacing * (double)j, plan->spacing * (double)k);
        pls_body_def body = verify_body_def(&b.scene, b.scene.ball, b.reference[p]);
        body.mass = plan->density * lattice_volume(&b) * (i == 0 && plan->lighter > 0.0 ? plan->lighter : 1.0);
        if (2 * i >= plan->count[0]) body.material = second;
        if (plan->fixed) body.motion.axes = PLS_AXIS_ALL;
        MUST(pls_world_add_body(b.scene.world, &body, &b.body[p]));
    }
    join(&b);
    return b;
}

void lattice_free(lattice *b)
{
    free(b->reference);
    free(b->body);
    verify_close(&b->scene);
}

size_t lattice_at(const lattice *b, size_t i, size_t j, size_t k) { return (k * b->plan.count[1] + j) * b->plan.count[0] + i; }

double lattice_volume(const lattice *b)
{
    return b->plan.spacing * b->plan.spacing * (b->plan.dimension == 2 ? b->plan.thickness : b->plan.spacing);
}

void lattice_deform(lattice *b, pls_vec3 (*map)(pls_vec3 X, const void *context), const void *context)
{
    pls_world *w = b->scene.world;
    for (size_t p = 0; p < b->points; ++p)
    {
        const pls_vec3 x = map(b->reference[p], context);
        pls_body_place *place = &w->bodies.place[pls_body_row(w, b->body[p])];
        place->x = x.x, place->y = x.y, place->z = x.z;
    }
    MUST(pls_bonds_place(w, 0.0, 0, 1));
    pls_bonds_placed(w);
    MUST(pls_bonds_dilate(w, 0.0, 0, 1));
    pls_bonds_dilated(w);
    pls_bonds_act(w, 0, 1);
}

static size_t point_of(const lattice *b, size_t p) { return b->scene.world->bond[0].point_of[b->body[p].index1 - 1]; }

pls_vec3 lattice_force(const lattice *b, size_t p)
{
    const double *f = b->scene.world->bond[0].force[point_of(b, p)];
    return pls_vec(f[0], f[1], f[2]);
}

double lattice_energy(const lattice *b, size_t p) { return pls_bond_energy(&b->scene.world->bond[0], point_of(b, p)); }

// ---- the oracle ----------------------------------------------------------------------------------------------------------------------------------------------

static double influence(const lattice_plan *plan, double xi)
{
    const double r = xi / plan->horizon;
    switch (plan->influence)
    {
        case PLS_INFLUENCE_ONE: return 1.0;
        case PLS_INFLUENCE_INVERSE: return 1.0 / r;
        case PLS_INFLUENCE_CONICAL: return 1.0 - r;
        default: return exp(-r * r);
    }
}

/// w times the partial volume of a partner at reference length xi.
static double weight(const lattice_plan *plan, double xi, double volume)
{
    const double part = 0.5 + (plan->horizon - xi) / plan->spacing;
    return influence(plan, xi) * volume * (part > 1.0 ? 1.0 : part);
}

static bool is_partner(const lattice *b, size_t p, size_t q, double *xi)
{
    *xi = pls_length(pls_sub(b->reference[q], b->reference[p]));
    return p != q && *xi <= b->plan.horizon;
}

void lattice_oracle(const lattice *b, const pls_vec3 *x, pls_vec3 *force, double *energy)
{
    const lattice_plan *plan = &b->plan;
    const double K = plan->bulk, mu = plan->shear, V = lattice_volume(b), d = plan->dimension;
    const double k2 = plan->plane == PLS_PLANE_STRESS ? 9.0 * K * mu / (3.0 * K + 4.0 * mu) : K + mu / 3.0;
    const double dilation = plan->dimension == 3 ? 3.0 * K - 5.0 * mu : 2.0 * k2 - 4.0 * mu,
                 extension = plan->dimension == 3 ? 15.0 * mu : 8.0 * mu;
    double *m = calloc(b->points, sizeof *m), *theta = calloc(b->points, sizeof *theta), xi;
    for (size_t p = 0; p < b->points; ++p)
    {
        double square = 0.0;
        for (size_t q = 0; q < b->points; ++q)
        {
            if (!is_partner(b, p, q, &xi)) continue;
            const double e = pls_length(pls_sub(x[q], x[p])) - xi, w = weight(plan, xi, V);
            m[p] += w * xi * xi;
            theta[p] += w * xi * e;
            square += w * e * e;
        }
        theta[p] *= d / m[p];
        // W whose derivative by e is V_j t: (1/2) dilation/d theta^2 + (1/2) extension/m sum w e^2 V
        if (energy) energy[p] = 0.5 * V * (dilation / d * theta[p] * theta[p] + extension / m[p] * square);
    }
    for (size_t p = 0; force && p < b->points; ++p)
    {
        force[p] = pls_vec(0.0, 0.0, 0.0);
        for (size_t q = 0; q < b->points; ++q)
        {
            if (!is_partner(b, p, q, &xi)) continue;
            const pls_vec3 r = pls_sub(x[q], x[p]);
            const double length = pls_length(r), e = length - xi, w = weight(plan, xi, V);
            const double t = (dilation * theta[p] * xi + extension * e) / m[p] + (dilation * theta[q] * xi + extension * e) / m[q];
            force[p] = pls_add(force[p], pls_scale(r, V * w * t / length));
        }
    }
    free(m);
    free(theta);
}
