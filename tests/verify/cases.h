// cases.h -- physics with known answers, each case once: the tests run them short, the campaign (tests/prove) runs them long.
//
// A case runs worlds and puts rows on a sheet: what was measured, what theory says, and how far the two may be apart. References are formulas
// or calculations of the case's own, never numbers of the library.
#ifndef PLS_TESTS_VERIFY_CASES_H
#define PLS_TESTS_VERIFY_CASES_H

#include "support/verify.h"

enum { VERIFY_MAX_ROWS = 160, VERIFY_MAX_POINTS = 4096 };

typedef enum verify_kind {
    VERIFY_RELATIVE, ///< |measured - reference| <= tolerance |reference|
    VERIFY_ABSOLUTE, ///< |measured - reference| <= tolerance
    VERIFY_BELOW     ///< |measured| <= tolerance: an error
} verify_kind;

typedef struct verify_row
{
    char claim[160];
    verify_kind kind;
    double measured, reference, tolerance;
    bool passed;
} verify_row;

/// A point of a curve for the plots of the campaign.
typedef struct verify_point
{
    const char *curve;
    double x, measured, reference;
} verify_point;

typedef struct verify_sheet
{
    bool thorough; ///< the long form
    int row_count, point_count;
    verify_row rows[VERIFY_MAX_ROWS];
    verify_point points[VERIFY_MAX_POINTS];
} verify_sheet;

typedef void verify_case(verify_sheet *sheet);

/// Put a row on the sheet. `claim` is a printf format.
void sheet_relative(verify_sheet *sheet, double measured, double reference, double tolerance, const char *claim, ...)
    __attribute__((format(printf, 5, 6)));
void sheet_absolute(verify_sheet *sheet, double measured, double reference, double tolerance, const char *claim, ...)
    __attribute__((format(printf, 5, 6)));
void sheet_below(verify_sheet *sheet, double measured, double tolerance, const char *claim, ...) __attribute__((format(printf, 4, 5)));
/// `curve` must be a literal. NaN as reference: none.
void sheet_point(verify_sheet *sheet, const char *curve, double x, double measured, double reference);

/// Least-squares slope of log y against log x: the order of an error.
double fitted_order(int count, const double *x, const double *y);
/// Order from values at step sizes h, h/2, h/4: log2(|q(h) - q(h/2)| / |q(h/2) - q(h/4)|) of vectors of `components`.
double richardson_order(int components, const double *coarse, const double *middle, const double *fine);

/// Run a case in its short form as a cmocka test: fails with every row that is out of tolerance.
void verify_check(verify_case *run);

typedef struct verify_entry
{
    const char *name;  ///< of its data files
    const char *title; ///< heading in the tables
    verify_case *run;
} verify_entry;

/// Every case, ends with a null name.
extern const verify_entry verify_cases[];

verify_case case_contact_time, case_elastic_energy, case_restitution, case_oblique_wall, case_oblique_pair, case_oblique_disc;
verify_case case_order_sphere_on_plane, case_order_two_spheres, case_order_disc, case_order_energy;
verify_case case_free_rotation, case_free_rotation_drift, case_intermediate_axis;
verify_case case_book_oblique, case_book_pressed, case_rolling, case_sliding_to_rolling, case_cloud;
verify_case case_free_fall, case_bouncing, case_driven, case_locks, case_motion_function;
verify_case case_box_at_rest, case_box_comes_to_rest, case_stack, case_box_on_slope, case_rocking, case_spinning_on_face;
verify_case case_lying, case_pile, case_values_alone;
verify_case case_rolling_solids, case_ellipsoid_settles, case_box_top;
verify_case case_solid_cloud, case_solid_book, case_solid_crowd;
verify_case case_wall_edges;
verify_case case_column_stress, case_single_contact_tangent, case_fcc_tangent;
verify_case case_hertz_force, case_hertz_collision, case_mindlin;
verify_case case_dilating, case_logistic;
verify_case case_periodic_collision, case_periodic_momentum, case_stretching_chain;
verify_case case_bond_dispersion, case_bond_shear, case_bond_bar;
verify_case case_hole, case_bond_orders, case_bond_energy, case_kalthoff, case_branching;
verify_case case_step_estimate_pair, case_step_estimate_packing, case_step_refused;

#endif
