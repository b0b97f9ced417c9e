// cases.c -- the list of cases and the sheet they write on.
#include "verify/cases.h"

#include <particls/threads.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

const verify_entry verify_cases[] = {
    {"contact-time", "Elastic head-on collision: contact time pi sqrt(m_eff/kn)", case_contact_time},
    {"elastic-energy", "Elastic head-on collision: energy", case_elastic_energy},
    {"restitution", "Viscoelastic restitution exp(-pi z/sqrt(1 - z^2))", case_restitution},
    {"oblique-wall", "Oblique impact of a sphere on a plane against the stick-slip solution", case_oblique_wall},
    {"oblique-pair", "Oblique impact of two unequal spheres against the stick-slip solution", case_oblique_pair},
    {"oblique-disc", "Oblique impact of a disc on a line (2D) against the stick-slip solution", case_oblique_disc},
    {"order-plane", "Order in dt: sphere stuck on a plane, damping, two coupled states", case_order_sphere_on_plane},
    {"order-pair", "Order in dt: two spheres pressed together, damping, coupled state", case_order_two_spheres},
    {"order-disc", "Order in dt: disc stuck on a line (2D), damping, coupled state", case_order_disc},
    {"order-energy", "Order in dt of the energy book", case_order_energy},
    {"free-rotation", "Torque-free asymmetric body against the Jacobi-elliptic solution", case_free_rotation},
    {"free-rotation-drift", "Torque-free asymmetric body: conservation at 200 steps per turn", case_free_rotation_drift},
    {"intermediate-axis", "Torque-free asymmetric body: flips about the intermediate axis", case_intermediate_axis},
    {"book-oblique", "Energy book: oblique viscoelastic impacts with friction", case_book_oblique},
    {"book-pressed", "Energy book: grazing, rolling and spinning contacts under pressure", case_book_pressed},
    {"rolling", "Rolling down a slope: 5/7 g sin(alpha)", case_rolling},
    {"sliding-to-rolling", "Sliding turns to rolling after 2 v0/(7 mu g)", case_sliding_to_rolling},
    {"rolling-solids", "Cylinder, capsule and compound roll down a slope", case_rolling_solids},
    {"ellipsoid-settles", "An ellipsoid settles on its shortest axis", case_ellipsoid_settles},
    {"box-top", "A box thrown about its middle axis flips", case_box_top},
    {"cloud", "Conservation in a collapsing cloud of 500 spheres", case_cloud},
    {"solid-cloud", "Momenta of a free cloud of 500 grains of all shapes", case_solid_cloud},
    {"solid-book", "Energy book: impacts of all shapes with friction", case_solid_book},
    {"solid-crowd", "Energy book: grains of all shapes pressed together", case_solid_crowd},
    {"wall-edges", "Flights against edges, rims and seams of walls of triangles", case_wall_edges},
    {"free-fall", "Free fall", case_free_fall},
    {"bouncing", "Bouncing on a plane", case_bouncing},
    {"driven", "Driven bodies", case_driven},
    {"locks", "Locked axes", case_locks},
    {"motion-function", "Motion given by a function of time", case_motion_function},
    {"box-at-rest", "A box at rest on a plane", case_box_at_rest},
    {"box-comes-to-rest", "A box that is dropped comes to rest", case_box_comes_to_rest},
    {"stack", "A stack of ten boxes", case_stack},
    {"box-on-slope", "A box on a slope slides from atan(mu) on", case_box_on_slope},
    {"rocking", "A box that rocks on its face: damped oscillator", case_rocking},
    {"lying", "Capsules and cylinders that lie along a line", case_lying},
    {"values-alone", "Bodies of which only the signed distance is known", case_values_alone},
    {"pile", "A pile of grains of all kinds comes to rest", case_pile},
    {"spinning-on-face", "Spinning on a face: 2/3 mu m g R", case_spinning_on_face},
    {"column-stress", "Stress of a two-sphere column under a known force", case_column_stress},
    {"single-tangent", "Tangent operator of a single contact", case_single_contact_tangent},
    {"fcc-tangent", "Tangent operator of a face-centred cubic packing", case_fcc_tangent},
    {"hertz-force", "Hertz: static force", case_hertz_force},
    {"hertz-collision", "Hertz: collision time and overlap", case_hertz_collision},
    {"mindlin", "Mindlin: tangential stiffness", case_mindlin},
    {"dilating", "Growing radius", case_dilating},
    {"logistic", "Midpoint rule for states: logistic growth", case_logistic},
    {"periodic-collision", "Collision across a periodic boundary", case_periodic_collision},
    {"periodic-momentum", "Momentum and energy in a periodic box", case_periodic_momentum},
    {"stretching-chain", "Chain through a shrinking periodic box", case_stretching_chain},
    {"step-pair", "Estimate of the stable step: one contact", case_step_estimate_pair},
    {"step-packing", "Estimate of the stable step: hexagonal packing", case_step_estimate_packing},
    {"step-refused", "A step that is too large is refused", case_step_refused},
    {"bond-dispersion", "Waves in a linear peridynamic solid against the exact dispersion of the lattice", case_bond_dispersion},
    {"bond-shear", "Shear of a linear peridynamic solid against the lattice's own sum", case_bond_shear},
    {"bond-bar", "A bar of a linear peridynamic solid in tension", case_bond_bar},
    {"hole", "A plate with a hole against Kirsch's solution", case_hole},
    {"bond-orders", "Orders of convergence of a linear peridynamic solid", case_bond_orders},
    {"bond-energy", "Energy and momenta of peridynamic solids over many steps", case_bond_energy},
    {"kalthoff", "Cracks from two notches under an impact", case_kalthoff},
    {"branching", "A crack that branches", case_branching},
    {NULL, NULL, NULL},
};

static void put_row(verify_sheet *sheet, verify_kind kind, double measured, double reference, double tolerance, const char *claim,
                    va_list arguments)
{
    if (sheet->row_count == VERIFY_MAX_ROWS) fail_msg("more than %d rows", VERIFY_MAX_ROWS);
    verify_row *row = &sheet->rows[sheet->row_count++];
    vsnprintf(row->claim, sizeof row->claim, claim, arguments);
    row->kind = kind;
    row->measured = measured;
    row->reference = reference;
    row->tolerance = tolerance;
    double error = kind == VERIFY_BELOW ? fabs(measured) : fabs(measured - reference);
    row->passed = error <= (kind == VERIFY_RELATIVE ? tolerance * fabs(reference) : tolerance); // false for NaN
}

void sheet_relative(verify_sheet *sheet, double measured, double reference, double tolerance, const char *claim, ...)
{
    va_list arguments;
    va_start(arguments, claim);
    put_row(sheet, VERIFY_RELATIVE, measured, reference, tolerance, claim, arguments);
    va_end(arguments);
}

void sheet_absolute(verify_sheet *sheet, double measured, double reference, double tolerance, const char *claim, ...)
{
    va_list arguments;
    va_start(arguments, claim);
    put_row(sheet, VERIFY_ABSOLUTE, measured, reference, tolerance, claim, arguments);
    va_end(arguments);
}

void sheet_below(verify_sheet *sheet, double measured, double tolerance, const char *claim, ...)
{
    va_list arguments;
    va_start(arguments, claim);
    put_row(sheet, VERIFY_BELOW, measured, NAN, tolerance, claim, arguments);
    va_end(arguments);
}

void sheet_point(verify_sheet *sheet, const char *curve, double x, double measured, double reference)
{
    if (sheet->point_count == VERIFY_MAX_POINTS) fail_msg("more than %d points", VERIFY_MAX_POINTS);
    sheet->points[sheet->point_count++] = (verify_point){curve, x, measured, reference};
}

double fitted_order(int count, const double *x, const double *y)
{
    double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    for (int k = 0; k < count; ++k)
    {
        double a = log(x[k]), b = log(y[k]);
        sx += a, sy += b, sxx += a * a, sxy += a * b;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

double richardson_order(int components, const double *coarse, const double *middle, const double *fine)
{
    double first = 0.0, second = 0.0;
    for (int c = 0; c < components; ++c)
    {
        first += (coarse[c] - middle[c]) * (coarse[c] - middle[c]);
        second += (middle[c] - fine[c]) * (middle[c] - fine[c]);
    }
    return 0.5 * log2(first / second);
}

void verify_check(verify_case *run)
{
    verify_sheet *sheet = calloc(1, sizeof *sheet);
    assert_non_null(sheet);
    MUST(pls_set_threads(1)); // most worlds here hold two bodies
    run(sheet);
    int failed = 0;
    for (int k = 0; k < sheet->row_count; ++k)
    {
        const verify_row *row = &sheet->rows[k];
        if (row->passed) continue;
        ++failed;
        print_error("%s: measured %.12g, reference %.12g, tolerance %.3g%s\n", row->claim, row->measured, row->reference, row->tolerance,
                    row->kind == VERIFY_RELATIVE ? " (relative)" : "");
    }
    int rows = sheet->row_count;
    free(sheet);
    assert_true(rows > 0);
    assert_int_equal(failed, 0);
}
