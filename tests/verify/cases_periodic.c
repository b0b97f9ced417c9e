// cases_periodic.c -- periodic boxes: a collision across the boundary is a collision, momentum is kept, a shrinking box presses a chain.
#include "verify/cases.h"

#include "base/random.h"

static const double pi = 3.14159265358979323846;
static const verify_value damped_law[] = {{"kn", 1e4}, {"ks", 7e3}, {"cn", 5.0}, {"cs", 3.0}, {"friction", 0.3}, {NULL, 0.0}};

typedef struct crossing
{
    pls_body_motion a, b;
} crossing;

/// Sphere a runs obliquely into sphere b. In the box [0, 10)^3 b is seen through the boundary and a crosses it.
static crossing cross(bool periodic, int dimension, pls_vec3 shift_b)
{
    pls_world_def def = pls_default_world_def(dimension);
    def.dt = 2e-4;
    def.upper = pls_vec(10, 10, 10);
    for (int k = 0; k < dimension; ++k) def.periodic[k] = periodic;
    verify_scene scene = verify_open(&def, "viscoelastic", damped_law);
    double flat = dimension == 2 ? 0.0 : 1.0;
    pls_body_def ball = verify_ball_def(&scene, 1.0, 1.0, pls_vec(9.25, 9.5, 9.0 * flat), pls_vec(2.0, 0.7, 0.3 * flat));
    ball.angular_velocity = pls_vec(0.5 * flat, 0.2 * flat, -1.0);
    pls_body_id a = verify_add(&scene, &ball);
    pls_body_id b = verify_ball(&scene, 1.0, 2.0, pls_add(pls_vec(11.4, 10.1, 9.4 * flat), shift_b), pls_vec(-0.3, 0, 0));
    MUST(pls_world_run(scene.world, 5000));
    crossing result = {verify_motion(scene.world, a), verify_motion(scene.world, b)};
    verify_close(&scene);
    return result;
}

/// Largest component of the difference, up to whole edges of 10.
static double difference(pls_vec3 a, pls_vec3 b, double edge)
{
    pls_vec3 d = pls_sub(a, b);
    return fmax(fabs(remainder(d.x, edge)), fmax(fabs(remainder(d.y, edge)), fabs(remainder(d.z, edge))));
}

void case_periodic_collision(verify_sheet *sheet)
{
    for (int dimension = 3; dimension >= 2; --dimension)
    {
        crossing open = cross(false, dimension, pls_vec(0, 0, 0)), box = cross(true, dimension, pls_vec(-10, -10, 0));
        sheet_below(sheet, pls_length(open.a.angular_velocity) > 0.1 && open.b.velocity.x > 0.1 ? 0.0 : 1.0, 0.5,
                    "%dD: the spheres do collide (1: they do not)", dimension);
        double speed = fmax(difference(open.a.velocity, box.a.velocity, 1e3), difference(open.b.velocity, box.b.velocity, 1e3));
        double spin = fmax(difference(open.a.angular_velocity, box.a.angular_velocity, 1e3),
                           difference(open.b.angular_velocity, box.b.angular_velocity, 1e3));
        double place = fmax(difference(open.a.position, box.a.position, 10), difference(open.b.position, box.b.position, 10));
        sheet_below(sheet, speed, 1e-11, "%dD: velocities differ from those in open space by [m/s]", dimension);
        sheet_below(sheet, spin, 1e-11, "%dD: spins differ by [rad/s]", dimension);
        sheet_below(sheet, place, 1e-11, "%dD: positions differ, up to whole edges, by [m]", dimension);
    }
}

void case_periodic_momentum(verify_sheet *sheet)
{
    enum { SIDE = 6, COUNT = SIDE * SIDE * SIDE };
    pls_world_def def = pls_default_world_def(3);
    def.dt = 1e-4;
    def.lower = pls_vec(-1, 2, 0);
    def.upper = pls_vec(SIDE - 1, SIDE + 2, SIDE);
    def.periodic[0] = def.periodic[1] = def.periodic[2] = true;
    verify_scene scene =
        verify_open(&def, "elastic", (const verify_value[]){{"kn", 2000.0}, {"ks", 1500.0}, {"friction", 0.2}, {NULL, 0.0}});
    double moved = 0.0;
    for (int k = 0; k < COUNT; ++k)
    {
        pls_random random = pls_random_stream(3, (uint64_t)k, PLS_FOR_USER);
        double radius = 0.2 + 0.28 * pls_random_uniform(&random), mass = 4.0 / 3.0 * pi * radius * radius * radius;
        pls_vec3 x = pls_vec(k % SIDE - 0.5, k / SIDE % SIDE + 2.5, k / (SIDE * SIDE) + 0.5);
        pls_vec3 v = pls_vec(pls_random_normal(&random) + 0.5, pls_random_normal(&random), pls_random_normal(&random));
        moved += mass * pls_length(v);
        verify_ball(&scene, radius, mass, x, v);
    }
    MUST(pls_world_prepare(scene.world));
    pls_world_figures start = verify_figures(scene.world);
    double energy = verify_total_energy(scene.world);
    int steps = sheet->thorough ? 50000 : 5000;
    MUST(pls_world_run(scene.world, (uint64_t)steps));
    pls_world_figures now = verify_figures(scene.world);
    sheet_below(sheet, pls_length(pls_sub(now.momentum, start.momentum)) / moved, 1e-12, "relative change of momentum in %d steps", steps);
    sheet_relative(sheet, verify_total_energy(scene.world), energy, 1e-4, "kinetic + stored + dissipated energy after %d steps [J]", steps);
    sheet_below(sheet, now.energy_slid > 0.01 * energy ? 0.0 : 1.0, 0.5, "sliding took more than 1 %% of the energy (1: it did not)");
    verify_close(&scene);
}

void case_stretching_chain(verify_sheet *sheet)
{
    // Four spheres in a row around a box whose edge L shrinks at a constant rate. Started with the mean motion v_k = k L'/4, distances stay L/4: overlap
    // 2 - L/4, force F = kn delta + cn delta' on each contact, sigma_xx V = -F L, and the box does the work -F L'.
    double edge = 7.96, rate = -0.01, change = edge * rate, kn = 1e4, cn = 5.0, volume = 3.0, dt = 1e-3, t = 1.0;
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    def.periodic[0] = true;
    def.lower = pls_vec(2, 0, 0);
    def.upper = pls_vec(2 + edge, 1, 1);
    def.stretch_rate = pls_vec(rate, 0, 0);
    verify_scene scene = verify_open(&def, "viscoelastic", damped_law);
    pls_body_id id[4];
    for (int k = 0; k < 4; ++k) id[k] = verify_ball(&scene, 1.0, 1.0, pls_vec(3 + k * edge / 4, 0, 0), pls_vec(k * change / 4, 0, 0));
    MUST(pls_world_prepare(scene.world));
    double start = verify_total_energy(scene.world);
    MUST(pls_world_run(scene.world, 1000));
    pls_collection_def collection = pls_default_collection_def();
    pls_collection c;
    collection.quantities = PLS_MEASURE_STRESS;
    collection.volume_kind = PLS_VOLUME_VALUE;
    collection.volume = volume;
    MUST(pls_measure_collection(scene.world, &collection, &c));
    pls_world_figures f = verify_figures(scene.world);
    double end = verify_total_energy(scene.world), length = edge + change * t, overlap = 2.0 - length / 4,
           force = kn * overlap - cn * change / 4;
    double distance = verify_motion(scene.world, id[1]).position.x - verify_motion(scene.world, id[0]).position.x;
    verify_close(&scene);
    // Work of -F L' over time with F = kn (2 - L/4) - cn L'/4.
    double work = -kn * (2.0 * (length - edge) - (length * length - edge * edge) / 8.0) + cn * change * change / 4.0 * t;
    sheet_relative(sheet, distance, length / 4, 1e-12, "distance of neighbours: L/4 [m]");
    sheet_relative(sheet, c.stress[0][0], -force * length / volume, 1e-10, "sigma_xx = -F L/V [Pa]");
    sheet_relative(sheet, f.energy_normal, 2.0 * kn * overlap * overlap, 1e-10, "stored energy of four contacts [J]");
    sheet_relative(sheet, f.energy_damped, 4.0 * cn * change * change / 16.0 * t, 1e-7,
                   "energy taken by the dashpots, carried per contact in single precision [J]");
    sheet_relative(sheet, end - start, work, 1e-9, "work of the shrinking box [J]");
}
