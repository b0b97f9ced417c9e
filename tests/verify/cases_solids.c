// cases_solids.c -- boxes that lie on a plane and on each other: rest, stacks, slopes, and the couples of faces that rub and rock. In 3D and, as rectangles, in 2D.
//
// Gravity is tilted, not the plane. Of a flat box the laws of faces know kn delta = load on an area A for manifold and kn A delta/A0 = load for volume; A0 = A here.
#include "verify/cases.h"
#include "support/numbers.h"

static const double pi = 3.14159265358979323846;

enum { LAWS = 2 };
static const pls_faces laws[LAWS] = {PLS_FACES_MANIFOLD, PLS_FACES_VOLUME};
static const char *const law_name[LAWS] = {"manifold", "volume"};

static const double gravity = 10.0, kn = 1e5;
static const pls_vec3 half = {0.5, 0.4, 0.3}; ///< of the box; 2D: the first two
static const double size = 1.0;

/// A world in which "up" is z, in 2D y.
typedef struct ground
{
    verify_scene scene;
    int dimension;
    pls_vec3 up;
    pls_shape_id box;
    double height;   ///< half of the box's
    double area;     ///< of its bottom
    double mass, dt; ///< [kg], [s]
} ground;

static ground open_ground(int dimension, pls_faces faces, double dt, const verify_value *values)
{
    ground g = {.dimension = dimension, .dt = dt};
    pls_world_def def = pls_default_world_def(dimension);
    def.dt = dt;
    def.coordination = 2; // below and above, no more
    g.scene = verify_open(&def, "viscoelastic", values);
    g.up = dimension == 3 ? pls_vec(0, 0, 1) : pls_vec(0, 1, 0);
    g.height = dimension == 3 ? half.z : half.y;
    g.area = 2.0 * half.x * (dimension == 3 ? 2.0 * half.y : 1.0);
    g.mass = g.area * 2.0 * g.height;
    g.box = verify_add_shape(&g.scene, "box", NUMBERS(half.x, half.y, half.z, 0.0));
    verify_set_faces(&g.scene, faces, faces == PLS_FACES_VOLUME ? g.area : 0.0);
    verify_wall(&g.scene, pls_vec(0, 0, 0), g.up);
    return g;
}

/// A box whose middle is at a height above the ground, turned about the vertical.
static pls_body_id add_box(const ground *g, double height, double turn)
{
    pls_body_def def = verify_body_def(&g->scene, g->box, pls_scale(g->up, height));
    if (g->dimension == 3) def.orientation = (pls_quat){cos(0.5 * turn), 0.0, 0.0, sin(0.5 * turn)};
    return verify_add(&g->scene, &def);
}

static const verify_value damped[] = {{"kn", 1e5}, {"ks", 5e4}, {"cn", 200.0}, {"cs", 100.0}, {"friction", 0.5}, {NULL, 0.0}};

/// How far a body is from where it was [m], by which angle it has turned [rad], and how fast it turns [rad/s].
typedef struct drift
{
    double moved, turned, spin;
} drift;

static drift drift_of(const verify_scene *scene, pls_body_id id, const pls_body_motion *start)
{
    pls_body_motion m = verify_motion(scene->world, id);
    pls_quat turn = pls_quat_multiply(m.orientation, pls_quat_conjugate(start->orientation));
    return (drift){pls_length(pls_sub(m.position, start->position)), 2.0 * pls_length(pls_vec(turn.x, turn.y, turn.z)),
                   pls_length(m.angular_velocity)};
}

static drift worse(drift a, drift b) { return (drift){fmax(a.moved, b.moved), fmax(a.turned, b.turned), fmax(a.spin, b.spin)}; }

/// Largest drift of `count` bodies in `steps` steps, looked at twenty times.
static drift watch(const verify_scene *scene, const pls_body_id *id, int count, int steps)
{
    enum { MOST = 10, LOOKS = 20 };
    pls_body_motion start[MOST];
    drift worst = {0.0, 0.0, 0.0};
    for (int k = 0; k < count; ++k) start[k] = verify_motion(scene->world, id[k]);
    for (int look = 0; look < LOOKS; ++look)
    {
        MUST(pls_world_run(scene->world, (uint64_t)(steps / LOOKS)));
        for (int k = 0; k < count; ++k) worst = worse(worst, drift_of(scene, id[k], &start[k]));
    }
    return worst;
}

static void put_drift(verify_sheet *sheet, drift d, int dimension, const char *law, const char *what, int steps)
{
    sheet_below(sheet, d.moved / size, 1e-6, "%dD, %s, %s: drift in %d steps, of the size", dimension, law, what, steps);
    sheet_below(sheet, d.turned, 1e-6, "%dD, %s, %s: turned by [rad]", dimension, law, what);
    sheet_below(sheet, d.spin, 1e-9, "%dD, %s, %s: spin [rad/s]", dimension, law, what);
}

// ---- rest -----------------------------------------------------------------------------------------------------------------------------------------------

void case_box_at_rest(verify_sheet *sheet)
{
    const int steps = sheet->thorough ? 1000000 : 20000;
    for (int dimension = 3; dimension >= 2; --dimension)
        for (int law = 0; law < LAWS; ++law)
        {
            ground g = open_ground(dimension, laws[law], 2e-4, damped);
            MUST(pls_world_add_gravity(g.scene.world, pls_scale(g.up, -gravity)));
            pls_body_id id = add_box(&g, g.height - g.mass * gravity / kn, 0.3);
            put_drift(sheet, watch(&g.scene, &id, 1, steps), dimension, law_name[law], "box at rest", steps);
            verify_close(&g.scene);
        }
}

/// Dropped, leaning and spinning: it comes to rest where theory says, and stays.
void case_box_comes_to_rest(verify_sheet *sheet)
{
    const int settle = 15000, steps = sheet->thorough ? 200000 : 3000;
    for (int dimension = 3; dimension >= 2; --dimension)
        for (int law = 0; law < LAWS; ++law)
        {
            ground g = open_ground(dimension, laws[law], 2e-4, damped);
            MUST(pls_world_add_gravity(g.scene.world, pls_scale(g.up, -gravity)));
            pls_body_def def = verify_body_def(&g.scene, g.box, pls_scale(g.up, g.height + 0.05));
            def.orientation = pls_quat_unit(dimension == 3 ? (pls_quat){1.0, 0.01, 0.02, 0.1} : (pls_quat){1.0, 0.0, 0.0, 0.02});
            def.angular_velocity = dimension == 3 ? pls_vec(0.1, -0.2, 1.0) : pls_vec(0.0, 0.0, 0.2);
            pls_body_id id = verify_add(&g.scene, &def);
            MUST(pls_world_run(g.scene.world, (uint64_t)settle));
            const double rest = pls_dot(verify_motion(g.scene.world, id).position, g.up);
            sheet_absolute(sheet, rest, g.height - g.mass * gravity / kn, 1e-9,
                           "%dD, %s, dropped box: height at rest, half edge - m g/kn [m]", dimension, law_name[law]);
            put_drift(sheet, watch(&g.scene, &id, 1, steps), dimension, law_name[law], "dropped box at rest", steps);
            verify_close(&g.scene);
        }
}

void case_stack(verify_sheet *sheet)
{
    enum { COUNT = 10 };
    for (int dimension = 3; dimension >= 2; --dimension)
        for (int law = 0; law < LAWS; ++law)
            for (int turned = 0; turned < (dimension == 3 && sheet->thorough ? 2 : 1); ++turned)
            {
                const int settle = turned            ? 20000
                                   : sheet->thorough ? 4000
                                                     : 2000,
                          steps = !sheet->thorough ? 3000
                                  : turned         ? 200000
                                                   : 1000000;
                ground g = open_ground(dimension, laws[law], 2e-4, damped);
                MUST(pls_world_add_gravity(g.scene.world, pls_scale(g.up, -gravity)));
                pls_body_id id[COUNT];
                double top = 0.0;
                for (int k = 0; k < COUNT; ++k) // each contact carries what is above it
                {
                    const double overlap = (COUNT - k) * g.mass * gravity / kn;
                    id[k] = add_box(&g, top - overlap + g.height, turned ? 0.1 * k : 0.0);
                    top += 2.0 * g.height - overlap;
                }
                // Rims carry a little less, of the order of overlap over size, and where boxes are turned common areas are smaller: the stack has to settle.
                MUST(pls_world_run(g.scene.world, (uint64_t)settle));
                put_drift(sheet, watch(&g.scene, id, COUNT, steps), dimension, law_name[law],
                          turned ? "ten boxes, each turned by 0.1 rad" : "ten boxes", steps);
                verify_close(&g.scene);
            }
}

// ---- slope ----------------------------------------------------------------------------------------------------------------------------------------------

/// On a slope of tan(angle) = `ratio` mu: speed down the slope after `steps`, and after as many again.
static void run_on_slope(int dimension, pls_faces faces, double ratio, int steps, double speed[2], double place[2])
{
    const double mu = 0.5, angle = atan(ratio * mu);
    ground g = open_ground(dimension, faces, 2e-4, damped);
    MUST(pls_world_add_gravity(g.scene.world, pls_add(pls_vec(gravity * sin(angle), 0, 0), pls_scale(g.up, -gravity * cos(angle)))));
    pls_body_id id = add_box(&g, g.height - g.mass * gravity * cos(angle) / kn, 0.0);
    for (int k = 0; k < 2; ++k)
    {
        MUST(pls_world_run(g.scene.world, (uint64_t)steps));
        pls_body_motion m = verify_motion(g.scene.world, id);
        speed[k] = m.velocity.x, place[k] = m.position.x;
    }
    verify_close(&g.scene);
}

void case_box_on_slope(verify_sheet *sheet)
{
    const int steps = sheet->thorough ? 100000 : 20000;
    const double mu = 0.5, ratio[3] = {0.998, 1.002, 1.5}, dt = 2e-4;
    for (int dimension = 3; dimension >= 2; --dimension)
        for (int law = 0; law < LAWS; ++law)
            for (int k = 0; k < 3; ++k)
            {
                double speed[2], place[2];
                run_on_slope(dimension, laws[law], ratio[k], steps, speed, place);
                const double angle = atan(ratio[k] * mu), exact = gravity * (sin(angle) - mu * cos(angle));
                if (ratio[k] < 1.0)
                {
                    sheet_below(sheet, speed[1], 1e-9, "%dD, %s, tan(slope) = %g mu: it stays, speed [m/s]", dimension, law_name[law],
                                ratio[k]);
                    sheet_below(sheet, place[1] - place[0], 1e-9, "%dD, %s, tan(slope) = %g mu: it stays, moved in %d steps [m]", dimension,
                                law_name[law], ratio[k], steps);
                }
                else
                    sheet_relative(sheet, (speed[1] - speed[0]) / (steps * dt), exact, 1e-6,
                                   "%dD, %s, tan(slope) = %g mu: it slides with g (sin - mu cos) [m/s^2]", dimension, law_name[law],
                                   ratio[k]);
            }
}

// ---- couples of faces -------------------------------------------------------------------------------------------------------------------------------------

/// A frictionless rectangle rocks on its face: I phi'' + cn L^2/12 phi' + (k L^2/12 - m g h) phi = 0, k = kn for volume, 4 kn for manifold (of which delta, the
/// ratio of the integrals of t^3 and t^2, grows by 2 phi^2 L^2/12/delta).
void case_rocking(verify_sheet *sheet)
{
    const verify_value smooth[] = {{"kn", 1e5}, {"ks", 0.0}, {"cn", 20.0}, {"cs", 0.0}, {"friction", 0.0}, {NULL, 0.0}};
    const double dt = 2e-5, start = 1e-7, square = 4.0 * half.x * half.x / 12.0;
    const int steps = 4000;
    for (int dimension = 3; dimension >= 2; --dimension)
        for (int law = 0; law < LAWS; ++law)
        {
            ground g = open_ground(dimension, laws[law], dt, smooth);
            MUST(pls_world_add_gravity(g.scene.world, pls_scale(g.up, -gravity)));
            pls_body_def def = verify_body_def(&g.scene, g.box, pls_scale(g.up, g.height - g.mass * gravity / kn));
            def.orientation = dimension == 3 ? (pls_quat){1.0, 0.0, 0.5 * start, 0.0} : (pls_quat){1.0, 0.0, 0.0, 0.5 * start};
            pls_body_id id = verify_add(&g.scene, &def);
            const double inertia = g.mass * (half.x * half.x + g.height * g.height) / 3.0, stiff = (law == 0 ? 4.0 : 1.0) * kn * square;
            const double rate = 0.5 * 20.0 * square / inertia, omega = sqrt((stiff - g.mass * gravity * g.height) / inertia - rate * rate);
            double error = 0.0;
            for (int k = 1; k <= steps; ++k)
            {
                MUST(pls_step(g.scene.world));
                const pls_quat q = verify_motion(g.scene.world, id).orientation;
                const double t = k * dt, exact = start * exp(-rate * t) * (cos(omega * t) + rate / omega * sin(omega * t));
                error = fmax(error, fabs(2.0 * (dimension == 3 ? q.y : q.z) - exact));
            }
            verify_close(&g.scene);
            sheet_below(sheet, error / start, 2e-3,
                        "%dD, %s: error of the angle of a box that rocks on its face, %.1f periods, %.0f %% left, of the start", dimension,
                        law_name[law], omega * steps * dt / (2.0 * pi), 100.0 * exp(-rate * steps * dt));
        }
}

/// Spin-down of a body on its face under friction that acts at a mean distance from the middle. A disc, as a prism of many sides: 2/3 R. A square: (sqrt 2 + asinh 1)/6 of the
/// edge.
void case_spinning_on_face(verify_sheet *sheet)
{
    enum { SIDES = 60 };
    const double spin = 2.0, mu = 0.5, radius = 0.5, dt = 1e-4;
    pls_vec3 points[2 * SIDES];
    for (int k = 0; k < 2 * SIDES; ++k)
        points[k] = pls_vec(radius * cos(2.0 * pi * k / SIDES), radius * sin(2.0 * pi * k / SIDES), k < SIDES ? -0.1 : 0.1);
    for (int square = 0; square < 2; ++square)
        for (int law = 0; law < LAWS; ++law)
        {
            pls_world_def def = pls_default_world_def(3);
            def.dt = dt;
            def.coordination = 1;
            verify_scene scene = verify_open(&def, "viscoelastic", damped);
            const double area = square ? 4.0 * radius * radius : 0.5 * SIDES * radius * radius * sin(2.0 * pi / SIDES), mass = 0.2 * area;
            verify_set_faces(&scene, laws[law], law == 1 ? area : 0.0);
            pls_shape_id shape =
                square ? verify_add_shape(&scene, "box", NUMBERS(radius, radius, 0.1, 0.0)) : verify_add_hull(&scene, points, 2 * SIDES);
            verify_wall(&scene, pls_vec(0, 0, 0), pls_vec(0, 0, 1));
            MUST(pls_world_add_gravity(scene.world, pls_vec(0, 0, -gravity)));
            pls_body_def body = verify_body_def(&scene, shape, pls_vec(0, 0, 0.1 - mass * gravity / kn));
            body.angular_velocity = pls_vec(0, 0, spin);
            pls_body_id id = verify_add(&scene, &body);
            const double mean = square ? 2.0 * radius * (sqrt(2.0) + asinh(1.0)) / 6.0 : 2.0 / 3.0 * radius;
            const double inertia_by_mass = square ? radius * radius * 2.0 / 3.0 : 0.5 * radius * radius,
                         slowing = mu * gravity * mean / inertia_by_mass;
            const int steps = (int)(0.5 * spin / slowing / dt);
            MUST(pls_world_run(scene.world, (uint64_t)(steps / 2)));
            const double before = verify_motion(scene.world, id).angular_velocity.z;
            MUST(pls_world_run(scene.world, (uint64_t)steps));
            const double after = verify_motion(scene.world, id).angular_velocity.z;
            sheet_relative(sheet, (before - after) / (steps * dt), slowing, 1e-2,
                           "%s, %s: a %s spinning on its face slows down by [rad/s^2]", square ? "box" : "prism of 60 sides", law_name[law],
                           square ? "square" : "disc");
            MUST(pls_world_run(scene.world, (uint64_t)(4 * steps)));
            sheet_below(sheet, verify_motion(scene.world, id).angular_velocity.z, 1e-9, "%s, %s: and stops [rad/s]",
                        square ? "box" : "prism of 60 sides", law_name[law]);
            verify_close(&scene);
        }
}
