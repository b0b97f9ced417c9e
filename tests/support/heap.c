#include "support/heap.h"

#include "base/random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static const double pi = 3.14159265358979323846;

heap_setup heap_default(int dimension, int count)
{
    return (heap_setup){.dimension = dimension, .count = count, .size_ratio = 2.5, .states = true, .reorder = true};
}

heap_setup heap_dense(int dimension, int count, double size_ratio, bool periodic)
{
    return (heap_setup){
        .dimension = dimension, .count = count, .size_ratio = size_ratio, .periodic = periodic, .dense = true, .reorder = true};
}

// Spheres start on a lattice of spacing 1. Loose: the largest radius is 0.48 and places are jittered, so that none overlap. Dense: radii alternate like the ions
// of rock salt and neighbours along the axes overlap by 0.01; at 2.5 large ones touch across the diagonals too.
static int lattice_side(const heap_setup *setup) { return (int)ceil(setup->dimension == 2 ? sqrt(setup->count) : cbrt(setup->count)); }

static pls_status growth_rate(void *context, const pls_state_point *at, const double *values, double *rate)
{
    (void)context;
    rate[0] = 0.05 * cos(5.0 * at->time) * values[0] + 0.001 * at->velocity.y;
    return PLS_OK;
}

static pls_status warmth_rate(void *context, const pls_state_point *at, const double *values, double *rate)
{
    (void)context;
    rate[0] = -values[0] + at->all[0];
    rate[1] = values[0] * sin(at->time);
    return PLS_OK;
}

static pls_status stiffness(void *context, double time, const double *states, double *value)
{
    (void)context;
    (void)time;
    *value = 4000.0 * (1.0 + 0.1 * sin(states[1]));
    return PLS_OK;
}

static double large_radius(const heap_setup *setup) { return setup->dense ? 1.01 * setup->size_ratio / (1.0 + setup->size_ratio) : 0.48; }

static double radius_of(const heap_setup *setup, pls_vec3 site, pls_random *random)
{
    double large = large_radius(setup), uniform = pls_random_uniform(random);
    if (!setup->dense) return large * pow(setup->size_ratio, -uniform);
    bool even = ((int)floor(site.x) + (int)floor(site.y) + (int)floor(site.z)) % 2 == 0;
    return even ? large : large / setup->size_ratio;
}

static pls_body_id add_sphere(const heap_setup *setup, const verify_scene *scene, uint64_t number, pls_vec3 position)
{
    pls_random random = pls_random_stream(11, number, PLS_FOR_USER);
    bool flat = setup->dimension == 2;
    double r = radius_of(setup, position, &random), mass = flat ? pi * r * r : 4.0 / 3.0 * pi * r * r * r;
    double jitter = setup->dense ? 0.002 : 0.9 * (0.5 - r);
    pls_vec3 d = pls_vec(2 * pls_random_uniform(&random) - 1, 2 * pls_random_uniform(&random) - 1, 2 * pls_random_uniform(&random) - 1);
    pls_vec3 v = pls_vec(pls_random_normal(&random), pls_random_normal(&random), pls_random_normal(&random)), w = pls_scale(v, -2.0);
    v = pls_scale(v, setup->dense ? 0.5 : 4.0); // loose: so fast that they have met after some hundred steps
    if (flat) d.z = v.z = w.x = w.y = 0.0;
    pls_body_def ball = verify_ball_def(scene, r, mass, pls_add(position, pls_scale(d, jitter)), v);
    ball.angular_velocity = w;
    return verify_add(scene, &ball);
}

static void add_states(const verify_scene *scene, pls_body_id grows)
{
    pls_state_def state = pls_default_state_def();
    pls_state_id id;
    strcpy(state.name, "size");
    state.body = grows;
    state.components = 1;
    state.initial[0] = 0.3;
    state.target = PLS_STATE_SCALE;
    state.keep_density = true;
    state.rate = growth_rate;
    MUST(pls_world_add_state(scene->world, &state, &id));
    state = pls_default_state_def();
    strcpy(state.name, "warmth");
    state.components = 2;
    state.initial[0] = 1.0;
    state.rate = warmth_rate;
    MUST(pls_world_add_state(scene->world, &state, &id));
    MUST(pls_world_bind_law_parameter(scene->world, scene->grain, scene->grain, "kn", stiffness, NULL, NULL));
}

heap heap_open(heap_setup given)
{
    const heap_setup *setup = &given;
    bool flat = setup->dimension == 2;
    int side = lattice_side(setup);
    pls_world_def def = pls_default_world_def(setup->dimension);
    def.dt = 2e-4;
    def.skin = setup->skin;
    def.reorder = setup->reorder;
    def.periodic[0] = setup->periodic;
    def.periodic[flat ? 2 : 1] = setup->periodic && !flat;
    def.upper = pls_vec(side, side, side);
    def.allow_unstable = true; // the smallest spheres may be light; what is compared are bits, not accuracy
    verify_scene scene = verify_open(
        &def, "viscoelastic", (const verify_value[]){{"kn", 4000}, {"ks", 3000}, {"cn", 0.4}, {"cs", 0.2}, {"friction", 0.4}, {NULL, 0.0}});
    pls_body_id first = {0}, middle = {0};
    for (int k = 0; k < setup->count; ++k)
    {
        pls_vec3 x =
            flat ? pls_vec(k % side + 0.5, k / side + 0.5, 0) : pls_vec(k % side + 0.5, k / side % side + 0.5, k / (side * side) + 0.5);
        pls_body_id id = add_sphere(setup, &scene, (uint64_t)k, x);
        if (k == 0) first = id;
        if (k == setup->count / 2) middle = id;
    }
    pls_vec3 up = flat ? pls_vec(0, 1, 0) : pls_vec(0, 0, 1);
    double low = setup->dense ? 0.5 - 0.99 * large_radius(setup) : 0.0, high = side - low;
    verify_wall(&scene, pls_vec(low, low, flat ? 0 : low), up);
    if (!setup->periodic)
    {
        verify_wall(&scene, pls_vec(low, 0, 0), pls_vec(1, 0, 0));
        verify_wall(&scene, pls_vec(high, 0, 0), pls_vec(-1, 0, 0));
        if (!flat) verify_wall(&scene, pls_vec(0, low, 0), pls_vec(0, 1, 0));
        if (!flat) verify_wall(&scene, pls_vec(0, high, 0), pls_vec(0, -1, 0));
    }
    MUST(pls_world_add_gravity(scene.world, pls_scale(up, setup->dense ? -30.0 : -100.0)));
    if (setup->states) add_states(&scene, first);
    return (heap){given, scene, middle};
}

void heap_close(heap *h) { verify_close(&h->scene); }

void heap_expect_contacts(heap *h)
{
    const size_t block = 128, serial_blocks = 4; // more blocks than these are shared among threads
    size_t count = (size_t)h->setup.count;
    pls_world_figures figures = verify_figures(h->scene.world);
    assert_true(figures.touching > count / 10);
    if (!h->setup.dense) return;
    assert_true(figures.touching > (h->setup.dimension == 2 ? count : 2 * count));
    assert_true(figures.touching > 2 * serial_blocks * block);
    if (h->setup.skin == 0.0) assert_true(4 * figures.touching > figures.listed); // whole vectors of the list are worked on
}

void heap_change_bodies(heap *h)
{
    double top = lattice_side(&h->setup) + 2.5;
    bool flat = h->setup.dimension == 2;
    MUST(pls_world_remove_body(h->scene.world, h->middle));
    for (int k = 0; k < 2; ++k)
        add_sphere(&h->setup, &h->scene, 900000 + (uint64_t)k, flat ? pls_vec(0.5 + 2 * k, top, 0) : pls_vec(0.5 + 2 * k, 0.5, top));
}
