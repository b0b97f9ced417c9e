// cases_rotation.c -- the free rotation of a body with three different moments of inertia, against Jacobi's solution.
//
// With I1 < I2 < I3 and |L|^2 > 2 E I2 (Landau and Lifshitz, Mechanics, section 37):
//     w1 = a cn(rate t, k)    w2 = b sn(rate t, k)    w3 = c dn(rate t, k)      in the body's frame
// The orientation has no equally short formula; its reference is a Runge-Kutta solution of fourth order with steps far below those under test.
#include "verify/cases.h"
#include "support/numbers.h"

static const pls_vec3 moments = {1.0, 2.0, 3.0};
static const double pi = 3.14159265358979323846;

/// sn, cn, dn by descending Landen transformation (arithmetic-geometric mean), Abramowitz and Stegun 16.4.
static void jacobi(double argument, double modulus, double *sn, double *cn, double *dn)
{
    double a[32], c[32], b = sqrt(1.0 - modulus * modulus);
    int n = 0;
    a[0] = 1.0, c[0] = modulus;
    while (fabs(c[n]) > 1e-17 && n < 30)
    {
        a[n + 1] = 0.5 * (a[n] + b);
        c[n + 1] = 0.5 * (a[n] - b);
        b = sqrt(a[n] * b);
        ++n;
    }
    double angle = ldexp(a[n] * argument, n);
    for (int k = n; k > 0; --k) angle = 0.5 * (angle + asin(c[k] / a[k] * sin(angle)));
    *sn = sin(angle);
    *cn = cos(angle);
    *dn = sqrt((1.0 - modulus) * (1.0 + modulus) + modulus * modulus * *cn * *cn); // no cancellation for a modulus near 1
}

/// Quarter period K(k).
static double quarter_period(double modulus)
{
    double a = 1.0, b = sqrt(1.0 - modulus * modulus);
    while (fabs(a - b) > 1e-15 * a)
    {
        double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    return pi / (2.0 * a);
}

/// The solution that starts with w = (a, 0, c) in the body's frame.
typedef struct elliptic
{
    double a, b, c, rate, modulus;
} elliptic;

static elliptic elliptic_from(pls_vec3 of, double a, double c)
{
    double i1 = of.x, i2 = of.y, i3 = of.z;
    double twice_energy = i1 * a * a + i3 * c * c, squared = i1 * i1 * a * a + i3 * i3 * c * c;
    double low = twice_energy * i3 - squared, high = squared - twice_energy * i1;
    return (elliptic){a, sqrt(low / (i2 * (i3 - i2))), c, sqrt((i3 - i2) * high / (i1 * i2 * i3)),
                      sqrt((i2 - i1) * low / ((i3 - i2) * high))};
}

static pls_vec3 elliptic_at(const elliptic *e, double t)
{
    double sn, cn, dn;
    jacobi(e->rate * t, e->modulus, &sn, &cn, &dn);
    return pls_vec(e->a * cn, e->b * sn, e->c * dn);
}

typedef struct rotation_rate
{
    pls_vec3 w;
    pls_quat q;
} rotation_rate;

static rotation_rate euler_equations(rotation_rate s)
{
    pls_quat q = pls_quat_multiply(s.q, (pls_quat){0.0, 0.5 * s.w.x, 0.5 * s.w.y, 0.5 * s.w.z});
    return (rotation_rate){pls_vec((moments.y - moments.z) * s.w.y * s.w.z / moments.x, (moments.z - moments.x) * s.w.z * s.w.x / moments.y,
                                   (moments.x - moments.y) * s.w.x * s.w.y / moments.z),
                           q};
}

static rotation_rate advanced(rotation_rate s, rotation_rate d, double h)
{
    return (rotation_rate){pls_add(s.w, pls_scale(d.w, h)), {s.q.w + h * d.q.w, s.q.x + h * d.q.x, s.q.y + h * d.q.y, s.q.z + h * d.q.z}};
}

static pls_quat reference_orientation(pls_vec3 w, pls_quat q, double t, int steps)
{
    rotation_rate s = {w, q};
    double h = t / steps;
    for (int k = 0; k < steps; ++k)
    {
        rotation_rate a = euler_equations(s), b = euler_equations(advanced(s, a, h / 2)), c = euler_equations(advanced(s, b, h / 2)),
                      d = euler_equations(advanced(s, c, h));
        s = advanced(advanced(advanced(advanced(s, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
    }
    return pls_quat_unit(s.q);
}

static const pls_quat start_orientation = {0.5, 0.5, -0.1, 0.7};

static verify_scene open_top(pls_vec3 w, double dt, pls_body_id *id)
{
    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    verify_scene scene = verify_open(&def, "elastic", (const verify_value[]){{"kn", 1.0}, {"ks", 1.0}, {"friction", 0.0}, {NULL, 0.0}});
    pls_body_def top = verify_ball_def(&scene, 1.0, 1.0, pls_vec(0, 0, 0), pls_vec(0, 0, 0));
    top.inertia = moments;
    top.orientation = pls_quat_unit(start_orientation);
    top.angular_velocity = pls_rotate(top.orientation, w);
    *id = verify_add(&scene, &top);
    return scene;
}

static pls_vec3 body_spin(const pls_body_motion *m) { return pls_rotate_back(m->orientation, m->angular_velocity); }

static pls_vec3 angular_momentum(const pls_body_motion *m)
{
    pls_vec3 w = body_spin(m);
    return pls_rotate(m->orientation, pls_vec(moments.x * w.x, moments.y * w.y, moments.z * w.z));
}

static double rotation_energy(const pls_body_motion *m)
{
    pls_vec3 w = body_spin(m);
    return 0.5 * (moments.x * w.x * w.x + moments.y * w.y * w.y + moments.z * w.z * w.z);
}

/// Angle of the rotation between two orientations [rad].
static double angle_between(pls_quat a, pls_quat b)
{
    pls_quat d = pls_quat_multiply(pls_quat_conjugate(a), b);
    return 2.0 * atan2(sqrt(d.x * d.x + d.y * d.y + d.z * d.z), fabs(d.w));
}

void case_free_rotation(verify_sheet *sheet)
{
    double a = 0.8, c = 1.0, duration = 20.0, dt[5], spin_error[5], turn_error[5];
    elliptic e = elliptic_from(moments, a, c);
    int levels = sheet->thorough ? 5 : 3;
    pls_quat exact = reference_orientation(pls_vec(a, 0, c), pls_quat_unit(start_orientation), duration, 40000);
    for (int k = 0; k < levels; ++k)
    {
        int steps = 1000 << k;
        pls_body_id id;
        dt[k] = duration / steps;
        spin_error[k] = 0.0;
        verify_scene scene = open_top(pls_vec(a, 0, c), dt[k], &id);
        for (int j = 1; j <= steps; ++j)
        {
            MUST(pls_step(scene.world));
            pls_body_motion m = verify_motion(scene.world, id);
            pls_vec3 w = body_spin(&m), w_exact = elliptic_at(&e, dt[k] * j);
            spin_error[k] = fmax(spin_error[k], pls_length(pls_sub(w, w_exact)));
            if (sheet->thorough && k == 0) sheet_point(sheet, "intermediate spin [rad/s]", dt[k] * j, w.y, w_exact.y);
        }
        turn_error[k] = angle_between(verify_motion(scene.world, id).orientation, exact);
        verify_close(&scene);
    }
    sheet_absolute(sheet, fitted_order(levels, dt, spin_error), 2.0, 0.1, "order of the spin in the body's frame");
    sheet_absolute(sheet, fitted_order(levels, dt, turn_error), 2.0, 0.1, "order of the orientation");
    sheet_below(sheet, spin_error[levels - 1], 1e-3 * pow(0.25, levels - 3), "largest error of the spin in %g s, dt = %g s [rad/s]",
                duration, dt[levels - 1]);
    sheet_below(sheet, turn_error[levels - 1], 1e-3 * pow(0.25, levels - 3), "error of the orientation after %g s, dt = %g s [rad]",
                duration, dt[levels - 1]);
}

void case_free_rotation_drift(verify_sheet *sheet)
{
    int turns = sheet->thorough ? 10000 : 300, ends = sheet->thorough ? 100 : 50;
    double a = 0.8, c = 1.0, first = 0.0, last = 0.0, length_error = 0.0, direction_error = 0.0;
    pls_body_id id;
    verify_scene scene = open_top(pls_vec(a, 0, c), 2.0 * pi / hypot(a, c) / 200.0, &id);
    pls_body_motion m = verify_motion(scene.world, id);
    pls_vec3 start = angular_momentum(&m);
    double energy = rotation_energy(&m);
    for (int turn = 0; turn < turns; ++turn)
    {
        double mean = 0.0;
        for (int k = 0; k < 200; ++k)
        {
            MUST(pls_step(scene.world));
            m = verify_motion(scene.world, id);
            mean += rotation_energy(&m) / 200.0;
        }
        pls_vec3 now = angular_momentum(&m);
        length_error = fmax(length_error, fabs(pls_length(now) / pls_length(start) - 1.0));
        direction_error = fmax(direction_error, pls_length(pls_sub(now, start)) / pls_length(start));
        if (turn < ends) first += mean / ends;
        if (turn >= turns - ends) last += mean / ends;
    }
    verify_close(&scene);
    // Round-off: half a unit in the last place per step, as if all rounding went one way.
    double round_off = turns * 200 * 0x1p-53;
    sheet_below(sheet, length_error, round_off, "relative change of the length of L in %d turns, round-off", turns);
    sheet_below(sheet, direction_error, round_off, "change of L, length and direction, in %d turns, round-off", turns);
    sheet_below(sheet, (last - first) / energy, 1e-6, "relative change of the mean energy, first to last %d of %d turns", ends, turns);
}

/// When a spin changes its sign, step after step.
typedef struct flip_clock
{
    double before, first, latest;
    int counted;
} flip_clock;

/// `now`: the spin after step k of length dt.
static void watch_flip(flip_clock *clock, long k, double dt, double now)
{
    if (k > 1 && clock->before * now < 0.0)
    {
        clock->latest = dt * ((double)k - now / (now - clock->before));
        if (clock->counted == 0) clock->first = clock->latest;
        ++clock->counted;
    }
    clock->before = now;
}

static double time_between_flips(const flip_clock *clock) { return (clock->latest - clock->first) / (clock->counted - 1); }

void case_intermediate_axis(verify_sheet *sheet)
{
    // Close to the separatrix 3 c^2 = a^2: the body spins about its intermediate axis and flips over every 2 K/rate seconds.
    double c = 1.0, a = sqrt(3.0) * c * (1.0 - 1e-3);
    elliptic e = elliptic_from(moments, a, c);
    double exact = 2.0 * quarter_period(e.modulus) / e.rate, dt = 2.0 * pi / 2.0 / 800.0;
    const int flips = sheet->thorough ? 40 : 6;
    flip_clock clock = {0};
    pls_body_id id;
    verify_scene scene = open_top(pls_vec(a, 0, c), dt, &id);
    for (long k = 1; clock.counted <= flips && k < 1000000; ++k)
    {
        MUST(pls_step(scene.world));
        pls_body_motion m = verify_motion(scene.world, id);
        watch_flip(&clock, k, dt, body_spin(&m).y);
    }
    verify_close(&scene);
    sheet_relative(sheet, time_between_flips(&clock), exact, 1e-3, "time between flips, %d flips [s]", flips);
}

/// A box of edges 1, 0.6, 0.3 with its own moments, m/12 of the squares of two edges, thrown about its middle axis; its other spin is a thousandth of that.
void case_box_top(verify_sheet *sheet)
{
    const pls_vec3 half = {0.5, 0.3, 0.15};
    const double mass = 8.0 * half.x * half.y * half.z, third = mass / 3.0, wobble = 1e-3;
    const pls_vec3 own = {third * (half.y * half.y + half.z * half.z), third * (half.x * half.x + half.z * half.z),
                          third * (half.x * half.x + half.y * half.y)};
    // The start is where the middle spin is largest: w = (0, b, c dn(K)), of which the solution from (a, 0, c) is a quarter period away.
    const double c = 0.05, a = c * sqrt((1.0 - wobble) * (own.z - own.y) * own.z / ((own.y - own.x) * own.x));
    const elliptic e = elliptic_from(own, a, c);
    const double quarter = quarter_period(e.modulus), exact = 2.0 * quarter / e.rate;
    const pls_vec3 spin = elliptic_at(&e, quarter / e.rate);
    const int flips = sheet->thorough ? 40 : 6;
    const double dt = exact / 4000.0;

    pls_world_def def = pls_default_world_def(3);
    def.dt = dt;
    def.allow_unstable = true; // there is no contact
    verify_scene scene = verify_open(&def, "elastic", (const verify_value[]){{"kn", 1.0}, {"ks", 1.0}, {"friction", 0.0}, {NULL, 0.0}});
    pls_body_def top = verify_body_def(&scene, verify_add_shape(&scene, "box", NUMBERS(half.x, half.y, half.z, 0.0)), pls_vec(0, 0, 0));
    top.orientation = pls_quat_unit(start_orientation);
    top.angular_velocity = pls_rotate(top.orientation, spin);
    pls_body_id id = verify_add(&scene, &top);
    MUST(pls_world_prepare(scene.world));
    const pls_world_figures start = verify_figures(scene.world);
    const double energy = 0.5 * (own.x * spin.x * spin.x + own.y * spin.y * spin.y + own.z * spin.z * spin.z);
    sheet_relative(sheet, start.energy_rotation, energy, 1e-13, "energy at the start, from the moments of a box [J]");
    double length_error = 0.0, energy_error = 0.0;
    flip_clock clock = {0};
    long k = 1;
    for (; clock.counted <= flips && k < 1000000; ++k)
    {
        MUST(pls_step(scene.world));
        pls_body_motion m = verify_motion(scene.world, id);
        watch_flip(&clock, k, dt, body_spin(&m).y);
        if (k % 50) continue;
        const pls_world_figures f = verify_figures(scene.world);
        length_error = fmax(length_error, fabs(pls_length(f.angular_momentum) / pls_length(start.angular_momentum) - 1.0));
        energy_error = fmax(energy_error, fabs(f.energy_rotation / start.energy_rotation - 1.0));
    }
    verify_close(&scene);
    sheet_absolute(sheet, clock.first, 0.5 * exact, 2e-3 * exact, "time to the first flip, K/rate [s]");
    sheet_relative(sheet, time_between_flips(&clock), exact, 1e-3, "time between flips, %d flips, 2 K/rate [s]", flips);
    sheet_below(sheet, length_error, (double)k * 0x1p-53, "relative change of |L| in %ld steps, round-off", k);
    sheet_below(sheet, energy_error, 1e-5, "relative change of the energy");
}
